//! Unilateral joints: from the condensed structure to the complementarity problem and back.

pub mod numbers;
pub mod scheme_word;
pub mod system;
pub mod whole;
