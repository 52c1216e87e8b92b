//! What a proof that there is no answer consists of, and the time that is given to look for one.

use std::time::Duration;

use nalgebra::DVector;
use num_rational::BigRational;

/// Time for all that is tried.
pub const BUDGET: Duration = Duration::from_secs(5);

/// A motion that proves that no contact forces within the laws' bounds balance the loads.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// ζ over the joints, largest entry 1. It may part pairs that slip: ζ_n ≥ f |ζ_τ|.
    pub direction: DVector<f64>,
    /// Power −RF·ζ of the loads on it, > `dissipation`.
    pub power: f64,
    /// Σ c |ζ_τ|: the most that cohesion and known bounds can take.
    pub dissipation: f64,
    /// Whether some sign had no room and was proved in exact arithmetic.
    pub exact: bool,
    /// Whether it is a proof for the forces along the normals that this load gives, and not for every larger load.
    pub of_this_load: bool,
    /// The amounts of the given motions that ζ is made of, at some scale; empty where it was not made of them.
    pub amounts: Vec<BigRational>,
}

/// What a search for a certificate found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CertificateSearch {
    /// The proof, if there is one.
    pub certificate: Option<Certificate>,
    /// Whether the time was up before everything was tried.
    pub out_of_time: bool,
}
