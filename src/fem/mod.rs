//! Structure → linear algebra.
//!
//! The assembled structure K u = F, its contact joints on (B u = z given), condensed to the joints:
//!
//! ```text
//!     K u − Bᵀ λ = F,  B u = z     ⇒     λ = R z + RF
//!     R   k × k   contact stiffness matrix (CSM), symmetric, positive semidefinite
//!     RF  k       contact load vector (CLV) of each load case
//!     Z   k × r   kernel of R: motions that cost no energy once the joints are off
//! ```
//!
//! ```
//! use stickslip::fem::MainSystem;
//! use stickslip::model::{embedded, pair::joints, scenario::Source};
//! use stickslip::watch::Quiet;
//!
//! let scenario = embedded::load("beam")?;
//! let Source::Structure(structure) = &scenario.source else { panic!("beam is a structure") };
//! let main = MainSystem::new(structure, &joints(&structure.pairs), &Quiet)?;
//! // Six pairs, each with a normal and a tangential joint; without them the beam moves as a rigid body.
//! assert_eq!((main.stiffness().nrows(), main.kernel().ncols()), (12, 3));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The joints reach this module as rows of B ([`crate::model::pair::Joint`]); it knows no contact law.
//!
//! Order of reading: `dof`, `elimination` (u = T v + G z), `element`, `assembly` (K, F, and K_m = TᵀKT, C, D), `factor`
//! (sparse Cholesky with the joints), `loose` (rigid motions of parts), [`main_system`] and `condense`
//! (R, RF, Z), `expand` (displacements), [`recovery`] (member forces, stresses, reactions).

pub mod main_system;
pub mod matrices;
pub mod recovery;

mod assembly;
mod body_rows;
mod classes;
mod condense;
mod contrast;
mod descent;
mod displacements;
mod dof;
mod elastic_curves;
mod element;
mod elimination;
mod energy;
mod equilibrium;
mod error;
mod expand;
mod factor;
mod fill;
mod held;
mod held_hinges;
mod idle_spins;
mod joint_rows;
mod kernel;
mod kinematics;
mod links;
mod loads;
mod loose;
mod measured_loss;
mod null_space;
mod order;
mod outline;
mod parts;
mod refinement;
mod repeated;
mod sparse;
mod superelement;
mod threads;
mod traces;
mod watch;

#[cfg(test)]
mod tests;

pub use displacements::Displacements;
pub use elastic_curves::ElasticCurves;
pub use element::bar_load::Piece;
pub use energy::Loaded;
pub use equilibrium::{BalancedState, JointTerms};
pub use error::{DependentJoint, FreeDirection, Holder, MainSystemError};
pub use held::HeldForces;
pub(crate) use kernel::mutual_displacements;
pub use kinematics::Kinematics;
pub use loose::Motion;
pub use main_system::{MainSystem, Seconds, Unknowns};
pub use recovery::{ElementStress, MemberForces, NodeStress, Reaction};
pub use repeated::Repeated;
pub use sparse::SymmetricSparse;
pub use traces::Traces;
