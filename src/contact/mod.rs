//! Unilateral joints: from the condensed structure to the complementarity problem and back.
//!
//! ```
//! use stickslip::contact::lcp::contact_lcp;
//! use stickslip::model::{embedded, rules::Covering};
//! use stickslip::{solve::{prepare, problem::{contact_problem, factors}}, watch::Quiet};
//!
//! let scenario = embedded::load("klarbring")?;
//! let prepared = prepare(&scenario, &Quiet)?;
//! let system = prepared.system().expect("it has contact pairs");
//! let values = scenario.parameter_values();
//! let problem = contact_problem(system, &factors(&prepared, &values), &values);
//! let lcp = contact_lcp(&problem, Covering::Cohesive)?;
//! // One Coulomb pair: x_n, x⁺ and x⁻, of which two rows carry the third.
//! assert_eq!((lcp.lcp.full_size, lcp.lcp.size()), (3, 2));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod at_rest;
pub mod cone;
pub mod cone_rates;
pub mod felt_part;
pub mod file_data;
pub mod force_form;
pub mod full_lcp;
pub mod given;
pub mod kernel_correction;
pub mod law;
pub mod lcp;
pub mod load_path;
pub mod on_cone;
pub mod pivoted;
pub mod polygon;
pub mod problem;
pub mod refine;
pub mod rows;
pub mod schemes;
pub mod self_stress;
pub mod sum;
pub mod sums;
pub mod system;
pub mod unique;
pub mod written;
pub mod yielding;
