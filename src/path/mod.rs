//! Paths: how the answer changes with the load, with friction and with history, breakpoint by breakpoint.

pub mod change;
pub mod cycle;
pub mod cycle_starts;
pub mod edge;
pub mod end;
pub mod envelope;
pub mod find;
pub mod friction;
mod friction_zero;
pub mod grid;
pub mod limit;
pub mod load;
pub mod load_parameter;
pub mod map;
pub mod merge;
pub mod profile;
pub mod quantity;
pub(crate) mod rate;
pub mod record;
pub mod route;
pub mod sensitivity;
pub mod stages;
pub mod start;
pub mod static_shakedown;
pub mod sweep;
pub mod sweep_file;
pub mod way;
