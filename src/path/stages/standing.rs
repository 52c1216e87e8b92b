//! Where a history stands: total displacements and forces of the joints, and which limits each pair has reached.

use nalgebra::DVector;

use crate::answer::record::{PairState, State};
use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::lcp::problem::NOISE;
use stickslip_numerics::products::add_sparse_response;

/// A direction of slip; x^σ = bound + σ x_τ is the reserve that it uses up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sense {
    Plus,
    Minus,
}

impl Sense {
    pub(super) const BOTH: [Sense; 2] = [Sense::Plus, Sense::Minus];

    /// σ.
    pub(super) fn sign(self) -> f64 {
        match self {
            Sense::Plus => 1.0,
            Sense::Minus => -1.0,
        }
    }

    fn state(self) -> State {
        match self {
            Sense::Plus => State::SlipPlus,
            Sense::Minus => State::SlipMinus,
        }
    }
}

/// Normal part of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Normal {
    /// Its joint stays on whatever happens (law `bound`).
    Bilateral,
    /// z_n > 0.
    Open,
    /// x_n > 0.
    Closed,
    /// z_n = 0 and x_n = 0.
    Grazing,
}

/// Tangential part of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tangential {
    /// The pair has no tangential joint (frictionless).
    Absent,
    /// Open and without cohesion: nothing holds it.
    Free,
    /// Both reserves > 0.
    Held,
    /// The reserve of this sense is used up.
    Limit(Sense),
    /// The bound itself is 0.
    Both,
}

/// A limit that a pair reaches on its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reached {
    /// x_n = 0.
    Opening(usize),
    /// z_n = 0.
    Closing(usize),
    /// A reserve is used up.
    Slipping(usize, Sense),
}

/// The laws of the pairs with their numbers.
#[derive(Clone, Copy)]
pub(super) struct Laws<'a> {
    pub(super) problem: &'a ContactProblem,
}

impl Laws<'_> {
    pub(super) fn friction(&self, pair: usize) -> f64 {
        self.problem.laws[pair].friction()
    }

    /// What the bound has besides f x_n.
    pub(super) fn constant(&self, pair: usize) -> f64 {
        self.problem.laws[pair].fixed_bound()
    }

    /// λ = R z + load, afresh.
    pub(super) fn force(&self, z: &DVector<f64>, load: &DVector<f64>) -> DVector<f64> {
        let mut force = DVector::zeros(z.len());
        // Most joints of a large structure stand still.
        add_sparse_response(force.as_mut_slice(), self.problem.system.stiffness.as_slice(), z.as_slice());
        force + load
    }

    /// Σ_k |R_ik| |z_k| + `load`: what the rounding of the forces is judged against, joint by joint.
    pub(super) fn force_sizes(&self, z: &DVector<f64>, load: &DVector<f64>) -> DVector<f64> {
        let mut sizes = load.clone();
        for (k, column) in self.problem.system.stiffness.column_iter().enumerate() {
            if z[k] != 0.0 {
                sizes.zip_apply(&column, |size, entry| *size += (entry * z[k]).abs());
            }
        }
        sizes
    }

    /// Likewise for the displacements: Σ_k √R_kk |z_k| / √R_ii, that is in a system scaled to a unit diagonal.
    pub(super) fn length_sizes(&self, scale: &DVector<f64>, z: &DVector<f64>) -> DVector<f64> {
        let sum: f64 = scale.iter().zip(z.iter()).map(|(scale, z)| scale * z.abs()).sum();
        scale.map(|scale| sum / scale)
    }
}

/// √R_ii of every joint; of a joint without stiffness a size far below all others, not zero.
pub(super) fn joint_scales(system: &ContactSystem) -> DVector<f64> {
    let scales = system.stiffness.diagonal().map(|entry| entry.max(0.0).sqrt());
    let floor = scales.amax().max(f64::MIN_POSITIVE) * 1e-9;
    scales.map(|scale| scale.max(floor))
}

/// See the module. Forces and displacements are in the user's units.
#[derive(Clone, Debug)]
pub(super) struct Standing {
    /// Total z over the joints; z_n is the distance open.
    pub(super) z: DVector<f64>,
    /// λ.
    pub(super) force: DVector<f64>,
    pub(super) normal: Vec<Normal>,
    pub(super) tangential: Vec<Tangential>,
    /// In which sense each pair slipped last.
    pub(super) last_slip: Vec<Option<Sense>>,
    /// Largest sizes met so far of the terms that the forces sum: slips carry the rounding of all that went before.
    force_sizes: DVector<f64>,
    length_sizes: DVector<f64>,
    scale: DVector<f64>,
}

impl Standing {
    /// The structure without loads, each pair as far open as its gap.
    pub(super) fn unloaded(laws: Laws<'_>) -> Standing {
        let joints = laws.problem.system.joint_count();
        let mut z = DVector::zeros(joints);
        for (i, gap) in laws.problem.gaps().enumerate() {
            z[i] = gap.max(0.0);
        }
        let pairs = laws.problem.system.pair_count();
        let mut standing = Standing {
            z,
            force: DVector::zeros(joints),
            normal: vec![Normal::Grazing; pairs],
            tangential: vec![Tangential::Absent; pairs],
            last_slip: vec![None; pairs],
            force_sizes: DVector::zeros(joints),
            length_sizes: DVector::zeros(joints),
            scale: joint_scales(&laws.problem.system),
        };
        let sizes = laws.force_sizes(&standing.z, &DVector::zeros(joints));
        standing.classify(laws, &sizes, &[]);
        standing
    }

    pub(super) fn is_open(&self, pair: usize) -> bool {
        self.normal[pair] == Normal::Open
    }

    /// Largest Σ |terms| met so far of every λ.
    pub(super) fn force_sizes(&self) -> &DVector<f64> {
        &self.force_sizes
    }

    /// What may be rounding of a force.
    pub(super) fn force_noise(&self, joint: usize) -> f64 {
        NOISE * self.force_sizes[joint]
    }

    /// What may be rounding of a displacement.
    pub(super) fn length_noise(&self, joint: usize) -> f64 {
        NOISE * self.length_sizes[joint]
    }

    /// Bound of a pair under its present x_n.
    pub(super) fn bound(&self, laws: Laws<'_>, pair: usize) -> f64 {
        let x_n = if self.normal[pair] == Normal::Closed { self.force[pair] } else { 0.0 };
        laws.friction(pair) * x_n + laws.constant(pair)
    }

    /// Reads from the values which limits every pair stands at. `sizes`: Σ |terms| of the forces; `reached`:
    /// limits that are known to be reached, whatever rounding makes of their values.
    pub(super) fn classify(&mut self, laws: Laws<'_>, sizes: &DVector<f64>, reached: &[Reached]) {
        let system = &*laws.problem.system;
        self.force_sizes.zip_apply(sizes, |most, now| *most = f64::max(*most, now));
        let lengths = laws.length_sizes(&self.scale, &self.z);
        self.length_sizes.zip_apply(&lengths, |most, now| *most = f64::max(*most, now));
        for (i, pair) in system.pairs.iter().enumerate() {
            self.normal[i] = if pair.law.is_bilateral() {
                Normal::Bilateral
            } else if self.z[i] > self.length_noise(i) && !reached.contains(&Reached::Closing(i)) {
                Normal::Open
            } else {
                self.z[i] = 0.0;
                let opening = reached.contains(&Reached::Opening(i));
                if self.force[i] > self.force_noise(i) && !opening { Normal::Closed } else { Normal::Grazing }
            };
            self.tangential[i] = match pair.plane_tangential() {
                None => Tangential::Absent,
                Some(joint) => self.tangential_of(laws, i, joint, reached),
            };
            if self.tangential[i] == Tangential::Both && laws.friction(i) > 0.0 && self.normal[i] == Normal::Closed {
                // A bound that is rounding has a contact force that is rounding.
                self.normal[i] = Normal::Grazing;
            }
        }
    }

    fn tangential_of(&self, laws: Laws<'_>, pair: usize, joint: usize, reached: &[Reached]) -> Tangential {
        let bound = self.bound(laws, pair);
        let noise = self.force_noise(joint) + laws.friction(pair) * self.force_noise(pair);
        let [plus, minus] = Sense::BOTH.map(|sense| {
            bound + sense.sign() * self.force[joint] <= noise || reached.contains(&Reached::Slipping(pair, sense))
        });
        match (plus, minus) {
            (true, true) if self.is_open(pair) => Tangential::Free,
            (true, true) => Tangential::Both,
            (true, false) => Tangential::Limit(Sense::Plus),
            (false, true) => Tangential::Limit(Sense::Minus),
            (false, false) => Tangential::Held,
        }
    }

    /// Whether the reserve of this sense is used up.
    pub(super) fn at_limit(&self, pair: usize, sense: Sense) -> bool {
        match self.tangential[pair] {
            Tangential::Free | Tangential::Both => true,
            Tangential::Limit(which) => which == sense,
            Tangential::Absent | Tangential::Held => false,
        }
    }

    /// The pairs as they stand: one that is on the limit at which it slipped last is shown as slipping.
    pub(super) fn pair_states(&self, laws: Laws<'_>) -> Vec<PairState> {
        let (system, drop) =
            (&*laws.problem.system, |value: f64, noise: f64| if value.abs() <= noise { 0.0 } else { value });
        system
            .pairs
            .iter()
            .enumerate()
            .map(|(i, pair)| {
                let x_n = match self.normal[i] {
                    Normal::Open | Normal::Grazing => 0.0,
                    Normal::Closed | Normal::Bilateral => drop(self.force[i], self.force_noise(i)),
                };
                let bound = if pair.rubs() { self.bound(laws, i) } else { 0.0 };
                let x_t = match (self.tangential[i], pair.plane_tangential()) {
                    (Tangential::Held, Some(joint)) => drop(self.force[joint], self.force_noise(joint)),
                    (Tangential::Limit(sense), _) => 0.0 - sense.sign() * bound,
                    _ => 0.0,
                };
                let slips = self.last_slip[i].filter(|&sense| self.at_limit(i, sense));
                let slips = slips.map_or(State::Stick, Sense::state);
                let (state, held) = State::of(self.is_open(i), pair.rubs().then_some(slips), bound);
                PairState {
                    id: pair.id.clone(),
                    law: pair.law.kind(),
                    state,
                    held,
                    x_n,
                    x_t,
                    z_n: if self.is_open(i) { self.z[i] } else { 0.0 },
                    z_t: pair.plane_tangential().map_or(0.0, |joint| self.z[joint]),
                    bound,
                    reserve_plus: bound + x_t,
                    reserve_minus: bound - x_t,
                    position: pair.position,
                    joint: pair.joint,
                    space: None,
                }
            })
            .collect()
    }
}
