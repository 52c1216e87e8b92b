//! stickslip: what a structure with frictional contact really does.

pub mod answer;
pub mod cli;
pub mod contact;
pub mod explain;
pub mod export;
pub mod fem;
pub mod lcp;
pub mod model;
pub mod path;
pub mod repl;
pub mod session;
pub mod signals;
pub mod solve;
pub mod tui;
pub mod view;
pub mod watch;
