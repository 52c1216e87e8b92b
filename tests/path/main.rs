//! Paths: loads, friction, history, sweeps, and the commands that follow them.

mod calibrate;
#[path = "../common/mod.rs"]
mod common;
mod cycle;
mod cycle_in_space;
mod find;
mod friction;
mod hertz;
mod history;
mod limit;
mod limit_in_space;
mod load;
mod load_amounts;
mod loose_in_space;
mod map;
mod map_in_space;
mod pipes_in_space;
mod prove;
mod prove_altered;
mod prove_in_space;
mod random;
mod repeated_refusals;
mod results;
mod rope;
mod rules_in_space;
mod sample;
mod sensitivity_in_space;
mod session;
mod stages;
mod stages_at_a_stop;
mod stages_in_space;
mod sweep;
mod sweep_points;
mod trace_in_space;
mod turning_back;
mod two_nodes;
