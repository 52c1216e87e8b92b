//! stickslip: what a structure with frictional contact really does.

pub mod answer;
pub mod contact;
pub mod explain;
pub mod fem;
pub mod lcp;
pub mod model;
pub mod path;
pub mod solve;
pub mod watch;
