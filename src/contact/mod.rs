//! Unilateral joints: from the condensed structure to the complementarity problem and back.
//!
//! ```
//! use stickslip::contact::complementarity::contact_lcp;
//! use stickslip::model::{embedded, rules::Covering};
//! use stickslip::{solve::{numbers::{contact_numbers, factors}, prepare}, watch::Quiet};
//!
//! let scenario = embedded::load("klarbring")?;
//! let prepared = prepare(&scenario, &Quiet)?;
//! let system = prepared.system().expect("it has contact pairs");
//! let values = scenario.parameter_values();
//! let numbers = contact_numbers(system, &factors(&prepared, &values), &values);
//! let lcp = contact_lcp(system, &numbers, Covering::Cohesive)?;
//! // One Coulomb pair: x_n, x⁺ and x⁻, of which two rows carry the third.
//! assert_eq!((lcp.lcp.whole_size, lcp.lcp.size()), (3, 2));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(crate) mod answer_box;
mod ball;
pub mod complementarity;
pub mod critical;
pub mod enumerate;
pub mod exact_check;
pub(crate) mod exact_system;
pub mod file_data;
pub mod force_form;
pub mod given;
pub mod load_path;
pub mod numbers;
pub mod pivoted;
pub mod refine;
pub mod scheme_word;
pub mod self_stress;
pub mod sharpen;
pub mod sums;
pub mod system;
pub mod whole;
