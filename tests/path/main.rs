//! Paths: loads, friction, history, sweeps, and the commands that follow them.

mod friction;
mod hertz;
mod load;
mod random;
mod session;
mod stages;
mod sweep;
