//! Unilateral joints: from the condensed structure to the complementarity problem and back.

pub mod complementarity;
pub mod given;
pub mod numbers;
pub mod system;
