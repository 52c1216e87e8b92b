//! What the user describes: scenario file → checked scenario. No linear algebra.

pub mod pair;
pub mod parameter;
pub mod rules;
pub mod scenario;
pub mod structure;
