//! How reports look, and that none breaks, whatever it is given.

mod random;
pub(crate) mod sample;
mod snapshots;
mod space;
