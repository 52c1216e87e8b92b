//! The numbers that a proof is about: a contact system or a bare LCP in f64, each number taken as the rational it is.
//!
//! ```text
//!   contact   λ = R (z − (g, 0)) + load over all joints, 2m, in space 3m; where motions Z are given, R means Πᵀ R Π with Π Z = 0
//!   LCP       w = M z + q
//! ```
//! A frictionless pair has λ_τ = 0, and z_τ = 0 where its row of R is zero, as one of known bound 0 has.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use num_rational::BigRational;
use num_traits::{Signed, Zero};

use super::MOST_PAIRS_OF_MOTION;
use crate::contact::law::PairLaw;
use crate::contact::polygon::Polygon;
use crate::contact::problem::ContactProblem;
use crate::contact::schemes::exact_system::give_kernel;
use crate::contact::schemes::telling::telling_joints;
use crate::explain::motions::FreeMotions;
use crate::explain::ray::Built;
use crate::fem::MainSystem;
use crate::lcp::exact::dyadic::{WholeRows, rational, rational_rows};
use crate::lcp::exact::rational_solve::rank_modulo_prime;
use crate::lcp::mirrored::MirroredLcp;

/// A contact system under one set of values.
#[derive(Clone, Debug, PartialEq)]
pub struct ProvedContact {
    /// Ids of the m pairs.
    pub ids: Vec<String>,
    /// Their laws.
    pub laws: Vec<PairLaw>,
    /// Tangential joints of each pair: 1 in the plane, 2 in space.
    pub tangents: usize,
    /// The directions of friction, in space those that the proof is about.
    pub polygon: Polygon,
    /// Whether friction in space is Coulomb's cone, of which a collapse is proved where it can be.
    pub cone: bool,
    /// R: all normals, then the tangentials of each pair.
    pub stiffness: DMatrix<f64>,
    /// Motions Z with R Z = 0; none where R is meant as it stands.
    pub kernel: Vec<DVector<f64>>,
    /// Σ factor·RF.
    pub load: DVector<f64>,
}

/// What a proof is about.
#[derive(Clone, Debug, PartialEq)]
pub enum ProvedSystem {
    /// A contact system.
    Contact(ProvedContact),
    /// A bare LCP.
    Plain {
        /// M.
        matrix: DMatrix<f64>,
        /// q.
        q: DVector<f64>,
        /// Names of the rows.
        names: Vec<String>,
    },
}

impl ProvedSystem {
    /// Of a bare LCP.
    pub fn of_plain(lcp: &MirroredLcp, names: &[String]) -> ProvedSystem {
        ProvedSystem::Plain { matrix: lcp.matrix(), q: lcp.q.clone(), names: names.to_vec() }
    }
}

impl ProvedContact {
    /// Of a contact problem whose joints are independent; for a file with frictionless pairs, with the file's own
    /// matrix.
    pub fn of(problem: &ContactProblem, built: Built<'_>) -> ProvedContact {
        let system = &*problem.system;
        let m = system.pair_count();
        let ids = system.pairs.iter().map(|pair| pair.id.clone()).collect();
        // A roller has the law of its file, with nothing in its tangential rows.
        let law = |law: &PairLaw| if law.is_roller() { PairLaw::bilateral(0.0) } else { *law };
        let laws = problem.laws.iter().map(law).collect();
        let (tangents, polygon, cone) = (system.tangents, problem.polygon, problem.cone);
        if let (Some(file), Some(load), 0) = (&system.file, &problem.file_load, system.kernel.ncols())
            && !file.compliance
        {
            let (stiffness, load) = (file.matrix.clone(), load.vector.clone());
            return ProvedContact { ids, laws, tangents, polygon, cone, stiffness, kernel: Vec::new(), load };
        }
        let mut places: Vec<usize> = (0..system.joint_count()).collect();
        for (i, pair) in system.pairs.iter().enumerate() {
            pair.tangential.clone().enumerate().for_each(|(t, joint)| places[joint] = m + tangents * i + t);
        }
        let spread = |of: &dyn Fn(usize) -> f64| {
            let mut all = DVector::zeros((1 + tangents) * m);
            places.iter().enumerate().for_each(|(joint, &at)| all[at] = of(joint));
            all
        };
        let mut stiffness = DMatrix::zeros((1 + tangents) * m, (1 + tangents) * m);
        let own = system.stiffness_without_noise();
        for (i, &at) in places.iter().enumerate() {
            places.iter().enumerate().for_each(|(j, &column)| stiffness[(at, column)] = own[(i, j)]);
        }
        let kernel = kernel(problem, built).iter().map(|motion| spread(&|joint| motion[joint])).collect();
        let load = spread(&|joint| problem.load[joint]);
        ProvedContact { ids, laws, tangents, polygon, cone, stiffness, kernel, load }
    }

    /// Index of z_τ of a pair among the unknowns.
    pub fn slips(&self, pair: usize) -> Range<usize> {
        let first = self.ids.len() + self.tangents * pair;
        first..first + self.tangents
    }

    /// R with its kernel exact.
    pub fn exact_stiffness(&self) -> Vec<Vec<BigRational>> {
        let mut exact = rational_rows(&self.stiffness);
        let (telling, motions) = reduced(&self.kernel);
        give_kernel(&mut exact, &telling, &motions);
        exact
    }
}

/// Whether springs or pins leave parts several motions: those that are at rest somewhere are sums of them, to rounding.
fn holds_loosely(main: &MainSystem) -> bool {
    main.traces().is_some_and(|parts| parts.iter().any(|part| !part.rows.is_empty() && part.near.ncols() > 1))
}

/// The motions that cost nothing, over the joints: those of the parts of a structure, else a basis in which each has a
/// joint of its own.
fn kernel(problem: &ContactProblem, built: Built<'_>) -> Vec<DVector<f64>> {
    let system = &*problem.system;
    let k = system.joint_count();
    let by_parts = |main| !holds_loosely(main) || system.pair_count() > MOST_PAIRS_OF_MOTION;
    if built.is_some_and(|(_, main)| by_parts(main)) && system.kernel.ncols() > 0 {
        let motions = FreeMotions::new(system, built);
        let part = |motion: usize, joint: usize| {
            motions.row(joint).iter().find(|entry| entry.motion == motion).map_or(0.0, |entry| entry.part.value)
        };
        let column = |motion| DVector::from_fn(k, |joint, _| part(motion, joint));
        return (0..motions.count()).map(column).collect();
    }
    // The digits of a file may have the kernel already.
    let mut whole = WholeRows::default();
    system.stiffness.row_iter().for_each(|row| whole.push(&row.iter().copied().collect::<Vec<_>>()));
    if rank_modulo_prime(&whole.rows) + system.kernel.ncols() <= k {
        return Vec::new();
    }
    let basis = telling_joints(&system.kernel).map(|(_, basis)| basis);
    basis.iter().flat_map(|basis| basis.column_iter().map(|column| column.into_owned())).collect()
}

/// Joints that tell the motions apart, and a basis in which each motion moves one of these joints by 1 and none of the
/// others. The joint of a motion is the first at which it is largest.
fn reduced(kernel: &[DVector<f64>]) -> (Vec<usize>, Vec<Vec<BigRational>>) {
    let mut telling: Vec<usize> = Vec::new();
    let mut motions: Vec<Vec<BigRational>> = Vec::new();
    for column in kernel {
        let mut motion: Vec<BigRational> = column.iter().map(|entry| rational(*entry)).collect();
        for (known, &p) in motions.iter().zip(&telling) {
            subtract(&mut motion, known, p);
        }
        let free = (0..motion.len()).filter(|joint| !telling.contains(joint));
        // `max_by` takes the last of equal ones.
        let Some(p) = free.rev().max_by(|&a, &b| motion[a].abs().cmp(&motion[b].abs())) else { break };
        if motion[p].is_zero() {
            continue;
        }
        let pivot = motion[p].clone();
        motion.iter_mut().filter(|entry| !entry.is_zero()).for_each(|entry| *entry /= &pivot);
        motions.iter_mut().for_each(|known| subtract(known, &motion, p));
        telling.push(p);
        motions.push(motion);
    }
    (telling, motions)
}

/// Subtracts the multiple of `other`, whose entry at `p` is 1, that leaves `motion` zero there.
fn subtract(motion: &mut [BigRational], other: &[BigRational], p: usize) {
    let factor = motion[p].clone();
    if factor.is_zero() {
        return;
    }
    for (entry, other) in motion.iter_mut().zip(other).filter(|(_, other)| !other.is_zero()) {
        *entry -= &factor * other;
    }
}
