//! Paths: how the answer changes with the load, with friction and with history, breakpoint by breakpoint.

pub mod change;
pub mod limit;
pub mod load;
pub mod stages;
pub mod start;
