//! Paths: how the answer changes with the load, with friction and with history, breakpoint by breakpoint.

pub mod change;
pub mod friction;
pub mod grid;
pub mod limit;
pub mod load;
pub mod merge;
pub mod quantity;
pub(crate) mod rate;
pub mod record;
pub mod sensitivity;
pub mod stages;
pub mod start;
pub mod sweep;
pub mod sweep_file;
