//! Critical friction: how rough a structure may be before more than one answer is possible (method §6).
//!
//! For every choice of states (open O, slip S with its sign σ, else stick) the block with rows R_n (O), R_τ (O), R_τ +
//! σ f R_n (S) and columns z_n (O), z_τ (O ∪ S) must keep a positive determinant. It is a polynomial in the parameter;
//! its roots are eigenvalues. Exact search over all choices up to [`SEARCHED`] of them, those of 8 pairs in the plane,
//! sampled beyond. One pair: f = R_ττ / |R_nτ| (Klarbring 1990). In space a pair slips along a facet d_k of the
//! friction polygon, with the row d_k·R_τ + f R_n and the column d_k, or between two, with both.

use std::ops::ControlFlow;

use nalgebra::DMatrix;
use rand::seq::{IndexedRandom, SliceRandom};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::contact::polygon::Polygon;
use crate::contact::schemes::scheme::{PairScheme, Tangential};
use crate::contact::system::{ContactPair, ContactSystem};

/// Most choices of states that are all examined: those of 8 pairs in the plane.
pub const SEARCHED: u64 = 1 << 16;
/// Smallest over largest pivot (R scaled to unit diagonal) below which a block counts as singular.
const SINGULAR: f64 = 1e-10;
/// Entries of R, scaled to unit diagonal, up to which a coupling of two joints is rounding of the condensation: as a
/// coupling it would mean a critical friction of 1e13 and more.
const NO_COUPLING: f64 = 256.0 * f64::EPSILON;
/// Imaginary part, relative, up to which an eigenvalue counts as real before its root is looked for.
const REAL: f64 = 1e-5;

/// How the choices of states were searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coverage {
    /// All of them.
    Exact,
    /// Random ones, each improved pair by pair as long as that lowers the value.
    Sampled {
        /// Seed of the generator.
        seed: u64,
        /// Number of blocks examined.
        count: u64,
    },
}

/// The friction at which uniqueness may end.
#[derive(Clone, Debug, PartialEq)]
pub struct CriticalFriction {
    /// Smallest parameter at which a block's determinant changes sign; `None`: no such block was found (with
    /// [`Coverage::Sampled`]: no counter-example found). When sampled, a value is an upper bound.
    pub value: Option<f64>,
    /// The directions of friction that it was looked for with.
    pub polygon: Polygon,
    /// The responsible working scheme.
    pub scheme: Option<Vec<PairScheme>>,
    /// See [`Coverage`].
    pub coverage: Coverage,
    /// Number of blocks examined.
    pub examined: u64,
    /// Blocks that are singular without friction already (parts held by contact only): nothing is said of them.
    pub singular: u64,
    /// Whether the search came to its end.
    pub complete: bool,
}

/// What one block says.
enum Root {
    At(f64),
    None,
    Singular,
}

/// Smallest parameter s ≥ 0 at which uniqueness may end. `friction` gives f of every pair for a parameter value; it
/// must be affine in it (each f is the parameter, a multiple of it, or a constant). Only the f of pairs that open are
/// read. Up to [`SEARCHED`] all choices are examined, beyond that this many blocks are drawn at random, from a fixed
/// seed. `observer` hears the number of blocks examined and may stop the search.
pub fn critical_friction(
    system: &ContactSystem,
    polygon: Polygon,
    friction: &dyn Fn(f64) -> Vec<f64>,
    (samples, seed): (u64, u64),
    observer: &mut dyn FnMut(u64) -> ControlFlow<()>,
) -> CriticalFriction {
    let m = system.pair_count();
    let mut search = Search::new(system, polygon, friction, observer);
    let exact = search.choices.iter().fold(1, |all: u64, of| all.saturating_mul(of.len() as u64)) <= SEARCHED;
    let ended = if exact { search.all(&mut Vec::with_capacity(m)) } else { search.sample(samples, seed) };
    let complete = ended.is_continue();
    let examined = search.examined;
    CriticalFriction {
        value: search.best.as_ref().map(|best| best.0),
        polygon,
        scheme: search.best.map(|best| best.1),
        coverage: if exact { Coverage::Exact } else { Coverage::Sampled { seed, count: examined } },
        examined,
        singular: search.singular,
        complete,
    }
}

/// The states of a pair. The sign of a slip without friction, or under a known bound, does not matter.
fn choices(pair: &ContactPair, polygon: Polygon, is_smooth: bool) -> Vec<PairScheme> {
    let half = if is_smooth || pair.law.is_bilateral() { polygon.half() } else { polygon.facets() };
    let slips = Tangential::all(polygon).into_iter().filter(|state| match state {
        Tangential::Stick => false,
        Tangential::Slip(facet) | Tangential::Between(facet) => usize::from(*facet) < half,
    });
    let slips = slips.map(|tangential| PairScheme { open: false, tangential });
    match pair.rubs() {
        false if pair.law.is_bilateral() => vec![PairScheme::STICK],
        false => vec![PairScheme::STICK, PairScheme::OPEN_STICK],
        true if pair.law.is_bilateral() => [PairScheme::STICK].into_iter().chain(slips).collect(),
        true => [PairScheme::STICK, PairScheme::OPEN].into_iter().chain(slips).collect(),
    }
}

/// A row of a block, scaled to unit length over joints scaled to R_ii = 1, and the column beside it.
struct BlockRow {
    /// Components over the joints.
    parts: Vec<(usize, f64)>,
    /// The pair whose friction acts in the row, and 1 over the length of the row before it was scaled.
    friction: Option<(usize, f64)>,
}

struct Search<'a> {
    system: &'a ContactSystem,
    polygon: Polygon,
    /// √R_ii, and R scaled to unit diagonal.
    root: Vec<f64>,
    scaled: DMatrix<f64>,
    /// f_i √R_nn at parameter 0, and its growth per unit of the parameter.
    base: Vec<f64>,
    growth: Vec<f64>,
    choices: Vec<Vec<PairScheme>>,
    observer: &'a mut dyn FnMut(u64) -> ControlFlow<()>,
    best: Option<(f64, Vec<PairScheme>)>,
    examined: u64,
    singular: u64,
}

impl<'a> Search<'a> {
    fn new(
        system: &'a ContactSystem,
        polygon: Polygon,
        friction: &dyn Fn(f64) -> Vec<f64>,
        observer: &'a mut dyn FnMut(u64) -> ControlFlow<()>,
    ) -> Self {
        let k = system.joint_count();
        let root: Vec<f64> = (0..k)
            .map(|j| {
                let root = system.stiffness[(j, j)].max(0.0).sqrt();
                if root > 0.0 { root } else { 1.0 }
            })
            .collect();
        let scaled = DMatrix::from_fn(k, k, |i, j| {
            let entry = system.stiffness[(i, j)] / root[i] / root[j];
            if entry.abs() <= NO_COUPLING { 0.0 } else { entry }
        });
        let (at_0, at_1) = (friction(0.0), friction(1.0));
        let m = system.pair_count();
        // The friction of a pair that never opens does not depend on x_n.
        let ratio = |pair: usize| if system.pairs[pair].law.is_bilateral() { 0.0 } else { root[pair] };
        let is_smooth = |pair: usize| at_0[pair] == 0.0 && at_1[pair] == 0.0;
        Self {
            system,
            scaled,
            base: (0..m).map(|i| at_0[i] * ratio(i)).collect(),
            growth: (0..m).map(|i| (at_1[i] - at_0[i]) * ratio(i)).collect(),
            choices: (0..m).map(|pair| choices(&system.pairs[pair], polygon, is_smooth(pair))).collect(),
            polygon,
            root,
            observer,
            best: None,
            examined: 0,
            singular: 0,
        }
    }

    fn all(&mut self, scheme: &mut Vec<PairScheme>) -> ControlFlow<()> {
        let pair = scheme.len();
        if pair == self.choices.len() {
            self.examine(scheme);
            if self.examined.is_multiple_of(64) {
                (self.observer)(self.examined)?;
            }
            return ControlFlow::Continue(());
        }
        for choice in self.choices[pair].clone() {
            scheme.push(choice);
            let result = self.all(scheme);
            scheme.pop();
            result?;
        }
        ControlFlow::Continue(())
    }

    fn sample(&mut self, samples: u64, seed: u64) -> ControlFlow<()> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let m = self.choices.len();
        let mut order: Vec<usize> = (0..m).collect();
        while self.examined < samples {
            // From few released pairs to all of them.
            let share = random.random::<f64>();
            let mut scheme: Vec<PairScheme> = (0..m)
                .map(|pair| {
                    if random.random::<f64>() < share {
                        // Every pair has choices.
                        self.choices[pair].choose(&mut random).copied().unwrap_or(PairScheme::STICK)
                    } else {
                        PairScheme::STICK
                    }
                })
                .collect();
            let mut value = self.examine(&scheme);
            let mut improved = value.is_some();
            while improved && self.examined < samples {
                improved = false;
                order.shuffle(&mut random);
                for &pair in &order {
                    for choice in self.choices[pair].clone() {
                        let before = std::mem::replace(&mut scheme[pair], choice);
                        if choice == before {
                            continue;
                        }
                        let new = self.examine(&scheme);
                        (self.observer)(self.examined)?;
                        if new.is_some_and(|new| value.is_none_or(|value| new < value)) {
                            value = new;
                            improved = true;
                        } else {
                            scheme[pair] = before;
                        }
                    }
                }
            }
            (self.observer)(self.examined)?;
        }
        ControlFlow::Continue(())
    }

    /// Value of a scheme where it is below the best so far (and then the new best).
    fn examine(&mut self, scheme: &[PairScheme]) -> Option<f64> {
        self.examined += 1;
        let limit = self.best.as_ref().map_or(f64::INFINITY, |best| best.0);
        match self.root(scheme, limit) {
            Root::At(value) if value < limit => {
                self.best = Some((value, scheme.to_vec()));
                Some(value)
            }
            Root::At(_) | Root::None => None,
            Root::Singular => {
                self.singular += 1;
                None
            }
        }
    }

    /// The rows of the block of a scheme: of an open pair all its joints, of a slipping one those of its facets.
    fn rows(&self, scheme: &[PairScheme]) -> Vec<BlockRow> {
        let mut rows: Vec<BlockRow> = Vec::new();
        for (pair, state) in scheme.iter().enumerate() {
            let joints = self.system.pairs[pair].tangential.clone();
            if state.open {
                let alone = |joint| BlockRow { parts: vec![(joint, 1.0)], friction: None };
                rows.extend([pair].into_iter().chain(joints).map(alone));
                continue;
            }
            let facets = if joints.is_empty() { Vec::new() } else { state.tangential.facets(self.polygon) };
            for facet in facets {
                let direction = self.polygon.direction(facet);
                let parts = || joints.clone().zip(direction).map(|(joint, part)| (joint, part * self.root[joint]));
                let length = parts().map(|(_, part)| part * part).sum::<f64>().sqrt();
                let parts = parts().map(|(joint, part)| (joint, part / length)).collect();
                rows.push(BlockRow { parts, friction: Some((pair, length.recip())) });
            }
        }
        rows
    }

    /// First sign change of the block's determinant below `limit`.
    fn root(&self, scheme: &[PairScheme], limit: f64) -> Root {
        let rows = self.rows(scheme);
        let k = rows.len();
        if k == 0 {
            return Root::None;
        }
        // Σ parts of the row · R · parts of the column.
        let entry = |parts: &[(usize, f64)], column: &BlockRow| -> f64 {
            let terms = parts.iter().flat_map(|a| column.parts.iter().map(move |b| (a, b)));
            terms.map(|(&(i, a), &(j, b))| a * self.scaled[(i, j)] * b).sum()
        };
        let growing_part = |row: &BlockRow, column: &BlockRow, factor: &dyn Fn(usize) -> f64| {
            row.friction.map_or(0.0, |(pair, scale)| {
                let f = factor(pair);
                if f == 0.0 { 0.0 } else { scale * f * entry(&[(pair, 1.0)], column) }
            })
        };
        let block = |factor: &dyn Fn(usize) -> f64| {
            DMatrix::from_fn(k, k, |i, j| entry(&rows[i].parts, &rows[j]) + growing_part(&rows[i], &rows[j], factor))
        };
        let start = block(&|pair| self.base[pair]);
        let lu = start.lu();
        let pivots = lu.u().diagonal().map(f64::abs);
        if pivots.min() <= SINGULAR * pivots.max() {
            return Root::Singular;
        }
        if lu.determinant() < 0.0 {
            return Root::At(0.0);
        }
        let growing: Vec<usize> =
            (0..k).filter(|i| rows[*i].friction.is_some_and(|(pair, _)| self.growth[pair] != 0.0)).collect();
        if growing.is_empty() {
            return Root::None;
        }
        let Some(inverse) = lu.try_inverse() else {
            return Root::Singular;
        };
        // det(A + s B) = det A · det(1 + s C), C = B A⁻¹ on the growing rows.
        let growth = DMatrix::from_fn(growing.len(), k, |i, j| {
            growing_part(&rows[growing[i]], &rows[j], &|pair| self.growth[pair])
        });
        let c = growth * DMatrix::from_fn(k, growing.len(), |i, j| inverse[(i, growing[j])]);
        // 1/s is at most the spectral radius.
        if c.norm() * limit <= 1.0 {
            return Root::None;
        }
        let mut candidates: Vec<f64> = c
            .complex_eigenvalues()
            .iter()
            .filter(|value| value.re < 0.0 && value.im.abs() <= REAL * value.re.abs())
            .map(|value| -1.0 / value.re)
            .filter(|s| s.is_finite() && *s < limit * (1.0 + REAL))
            .collect();
        candidates.sort_by(f64::total_cmp);
        let determinant = |s: f64| {
            let identity = DMatrix::<f64>::identity(growing.len(), growing.len());
            (identity + &c * s).lu().determinant()
        };
        for s in candidates {
            let (mut low, mut high) = (s * (1.0 - 10.0 * REAL), s * (1.0 + 10.0 * REAL));
            if determinant(low) <= 0.0 || determinant(high) > 0.0 {
                continue;
            }
            while high - low > 2.0 * f64::EPSILON * high {
                let middle = 0.5 * (low + high);
                if middle <= low || middle >= high {
                    break;
                }
                if determinant(middle) > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            return Root::At(0.5 * (low + high));
        }
        Root::None
    }
}

#[cfg(test)]
#[path = "critical_tests.rs"]
pub(crate) mod tests;
