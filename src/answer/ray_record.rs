//! A run that ended in a ray: its class, what is proved, and what moves along it.

use nalgebra::DVector;
use serde::Serialize;

use crate::contact::system::ContactSystem;

/// Class of a ray (method §4).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RayClass {
    /// The loads do work on a motion that costs no energy.
    Mechanism,
    /// Slips of a pair that cancel (z⁺ = z⁻) grow together; says nothing about the structure.
    Artefact,
    /// The structure stands without its contacts, so an answer exists: the run failed.
    Fault,
    /// None of these.
    NoEquilibrium,
}

impl RayClass {
    /// The word used everywhere.
    pub fn word(self) -> &'static str {
        match self {
            RayClass::Mechanism => "mechanism",
            RayClass::Artefact => "artefact",
            RayClass::Fault => "fault",
            RayClass::NoEquilibrium => "no-equilibrium",
        }
    }

    /// Whether it says something about the structure, not about the run alone.
    pub fn is_of_structure(self) -> bool {
        match self {
            RayClass::Mechanism | RayClass::NoEquilibrium => true,
            RayClass::Artefact | RayClass::Fault => false,
        }
    }
}

/// What has been proved of a mechanism or no equilibrium.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The equilibrium LP is infeasible.
    Certified,
    /// Enumeration found no answer.
    Proved,
    /// Statically admissible forces exist, but none that obeys the law of slip was found.
    Undecided,
}

impl Verdict {
    /// The word used everywhere.
    pub fn word(self) -> &'static str {
        match self {
            Verdict::Certified => "certified",
            Verdict::Proved => "proved",
            Verdict::Undecided => "undecided",
        }
    }

    /// Whether it is proved that there is no answer.
    pub fn is_proof(self) -> bool {
        self != Verdict::Undecided
    }
}

/// Direction of a ray at one pair.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PairDirection {
    /// Pair id.
    pub pair: String,
    /// z̄_n.
    pub z_n: f64,
    /// z̄_τ.
    pub z_t: Slip,
}

/// Slip of a pair: along t in the plane, along t1 and t2 in space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Slip {
    /// z_τ.
    Plane(f64),
    /// Its two components.
    Space([f64; 2]),
}

impl Slip {
    /// z_τ; in space its magnitude, ≥ 0.
    pub fn scalar(self) -> f64 {
        match self {
            Slip::Plane(slip) => slip,
            Slip::Space([along, across]) => along.hypot(across),
        }
    }
}

impl PairDirection {
    /// z̄ over the joints of a pair in a direction.
    pub fn of(system: &ContactSystem, pair: usize, direction: &DVector<f64>) -> PairDirection {
        let of = &system.pairs[pair];
        let slip = of.slip(direction);
        let z_t = if system.is_in_space() { Slip::Space(slip) } else { Slip::Plane(slip[0]) };
        PairDirection { pair: of.id.clone(), z_n: direction[pair], z_t }
    }

    /// Whether it parts. A direction holds no rounding: that was set to 0 when it was scaled.
    pub fn parts(&self) -> bool {
        self.z_n > 0.0
    }

    /// Whether it slips.
    pub fn slips(&self) -> bool {
        self.z_t.scalar() != 0.0
    }

    /// z̄_τ along its tangents; a direction has the scale of its largest component, 1.
    pub fn slip(&self) -> Vec<f64> {
        match self.z_t {
            Slip::Plane(slip) => vec![slip],
            Slip::Space(slip) => slip.to_vec(),
        }
    }
}

/// Rate of a variable of a bare LCP along a ray.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VariableRate {
    /// `z[1]`, `w[rod]`, `p`.
    pub variable: String,
    /// > 0.
    pub rate: f64,
}

/// Direction of a ray, scaled to largest 1.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Direction {
    /// Of a contact problem: every pair.
    Pairs(Vec<PairDirection>),
    /// Of a bare LCP: the variables that grow, the entering one first.
    Variables(Vec<VariableRate>),
}

impl Direction {
    /// Pair by pair; empty for a bare LCP.
    pub fn pairs(&self) -> &[PairDirection] {
        match self {
            Direction::Pairs(pairs) => pairs,
            Direction::Variables(_) => &[],
        }
    }

    /// Variable by variable; empty for a contact problem.
    pub fn variables(&self) -> &[VariableRate] {
        match self {
            Direction::Pairs(_) => &[],
            Direction::Variables(variables) => variables,
        }
    }
}

/// A run that ended in a ray.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ray {
    /// Class.
    pub class: RayClass,
    /// Verdict; `None` where it is not examined or does not apply.
    pub verdict: Option<Verdict>,
    /// p at the last vertex.
    pub p: f64,
    /// The variable that grows without bound: the one that was to enter.
    pub driver: String,
    /// What moves along it.
    pub direction: Direction,
    /// The motion in words.
    pub mode: String,
    /// What it means and what would help, in words.
    pub explanation: String,
    /// Whether what is certified is that the parts do not fit together.
    #[serde(skip)]
    pub misfit: bool,
    /// Whether what is certified is certified of this load only, not of every larger one.
    #[serde(skip)]
    pub of_this_load: bool,
}
