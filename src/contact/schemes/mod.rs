//! Working schemes taken one by one: all that answer a problem, the friction from which there may be several, and one
//! scheme proved or refuted without rounding.

mod ball;
pub(crate) mod bounding_box;
pub mod critical;
pub mod enumerate;
pub mod exact_check;
pub(crate) mod exact_system;
pub mod near;
mod pruning;
pub mod scheme;
pub(crate) mod telling;

#[cfg(test)]
mod space_tests;
