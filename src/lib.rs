//! stickslip: what a structure with frictional contact really does.

pub mod answer;
pub mod contact;
pub mod explain;
pub mod lcp;
pub mod model;
pub mod watch;
