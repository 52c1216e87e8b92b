//! Unilateral joints: from the condensed structure to the complementarity problem and back.

pub(crate) mod answer_box;
mod ball;
pub mod complementarity;
pub mod critical;
pub(crate) mod doubled;
pub mod enumerate;
pub mod exact_check;
mod exact_system;
pub mod file_data;
pub mod given;
pub mod load_path;
pub mod numbers;
pub mod pivoted;
pub mod refine;
pub mod scheme_word;
pub mod sharpen;
pub mod sums;
pub mod system;
pub mod whole;
