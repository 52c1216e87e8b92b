//! Critical friction: how rough a structure may be before more than one answer is possible (method §6).
//!
//! For every choice of states (open O, slip S with its sign σ, else stick) the block with rows R_n (O), R_τ (O), R_τ +
//! σ f R_n (S) and columns z_n (O), z_τ (O ∪ S) must keep a positive determinant. It is a polynomial in the parameter;
//! its roots are eigenvalues. Exact search over all choices up to [`SEARCHED_PAIRS`] pairs, sampled beyond. One pair:
//! f = R_ττ / |R_nτ| (Klarbring 1990).

use std::ops::ControlFlow;

use nalgebra::DMatrix;
use rand::seq::{IndexedRandom, SliceRandom};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::contact::schemes::scheme::{PairScheme, Tangential};
use crate::contact::system::{ContactPair, ContactSystem};

/// Most pairs for which all choices of states are examined.
pub const SEARCHED_PAIRS: usize = 8;
/// Smallest over largest pivot (R scaled to unit diagonal) below which a block counts as singular.
const SINGULAR: f64 = 1e-10;
/// Entries of R, scaled to unit diagonal, up to which a coupling of two joints is rounding of the condensation: as a
/// coupling it would mean a critical friction of 1e13 and more.
const NO_COUPLING: f64 = 256.0 * f64::EPSILON;
/// Imaginary part, relative, up to which an eigenvalue counts as real before its root is looked for.
const REAL: f64 = 1e-5;

/// How the choices of states were gone through.
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

/// Smallest parameter s ≥ 0 at which uniqueness may end. `friction` gives f of every pair for a parameter value; it must
/// be affine in it (each f is the parameter, a multiple of it, or a constant). Only the f of pairs that open are read.
/// Up to [`SEARCHED_PAIRS`] pairs all choices are examined, beyond `samples` blocks drawn with `seed`. `observer` hears the
/// number of blocks examined and may stop the search.
pub fn critical_friction(
    system: &ContactSystem,
    friction: &dyn Fn(f64) -> Vec<f64>,
    samples: u64,
    seed: u64,
    observer: &mut dyn FnMut(u64) -> ControlFlow<()>,
) -> CriticalFriction {
    let m = system.pair_count();
    let exact = m <= SEARCHED_PAIRS;
    let mut search = Search::new(system, friction, observer);
    let ended = if exact { search.all(&mut Vec::with_capacity(m)) } else { search.sample(samples, seed) };
    let complete = ended.is_continue();
    let examined = search.examined;
    CriticalFriction {
        value: search.best.as_ref().map(|best| best.0),
        scheme: search.best.map(|best| best.1),
        coverage: if exact { Coverage::Exact } else { Coverage::Sampled { seed, count: examined } },
        examined,
        singular: search.singular,
        complete,
    }
}

/// The states of a pair. The sign of a slip without friction, or under a known bound, does not matter.
fn choices(pair: &ContactPair, is_smooth: bool) -> Vec<PairScheme> {
    let slip = PairScheme::SLIP_PLUS;
    match pair.plane_tangential() {
        None => vec![PairScheme::STICK, PairScheme::OPEN_STICK],
        Some(_) if pair.law.is_bilateral() => vec![PairScheme::STICK, slip],
        Some(_) if is_smooth => vec![PairScheme::STICK, slip, PairScheme::OPEN],
        Some(_) => vec![PairScheme::STICK, PairScheme::OPEN, slip, PairScheme::SLIP_MINUS],
    }
}

struct Search<'a> {
    system: &'a ContactSystem,
    /// R scaled to unit diagonal.
    scaled: DMatrix<f64>,
    /// f_i √R_nn / √R_ττ at parameter 0, and its growth per unit of the parameter.
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
        // The friction of a pair that never opens does not hang on x_n.
        let ratio = |pair: usize| match system.pairs[pair].plane_tangential() {
            Some(joint) if !system.pairs[pair].law.is_bilateral() => root[pair] / root[joint],
            _ => 0.0,
        };
        let is_smooth = |pair: usize| at_0[pair] == 0.0 && at_1[pair] == 0.0;
        Self {
            system,
            scaled,
            base: (0..m).map(|i| at_0[i] * ratio(i)).collect(),
            growth: (0..m).map(|i| (at_1[i] - at_0[i]) * ratio(i)).collect(),
            choices: (0..m).map(|pair| choices(&system.pairs[pair], is_smooth(pair))).collect(),
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

    /// First sign change of the block's determinant below `limit`.
    fn root(&self, scheme: &[PairScheme], limit: f64) -> Root {
        let m = scheme.len();
        let tangential = |pair: usize| self.system.pairs[pair].plane_tangential();
        // (joint, pair whose friction acts in this row, sign of the slip)
        let mut rows: Vec<(usize, Option<usize>, f64)> = Vec::new();
        for (pair, state) in scheme.iter().enumerate().take(m) {
            if state.open {
                rows.push((pair, None, 0.0));
                rows.extend(tangential(pair).map(|joint| (joint, None, 0.0)));
            } else if state.tangential != Tangential::Stick {
                let joint = tangential(pair);
                rows.extend(joint.map(|joint| (joint, Some(pair), state.tangential.sign())));
            }
        }
        let k = rows.len();
        if k == 0 {
            return Root::None;
        }
        let block = |factor: &dyn Fn(usize) -> f64| {
            DMatrix::from_fn(k, k, |i, j| {
                let (joint, pair, sign) = rows[i];
                let column = rows[j].0;
                let friction = pair.map_or(0.0, |pair| {
                    let f = factor(pair);
                    if f == 0.0 { 0.0 } else { sign * f * self.scaled[(pair, column)] }
                });
                self.scaled[(joint, column)] + friction
            })
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
        let growing: Vec<usize> = (0..k).filter(|i| rows[*i].1.is_some_and(|pair| self.growth[pair] != 0.0)).collect();
        if growing.is_empty() {
            return Root::None;
        }
        let Some(inverse) = lu.try_inverse() else {
            return Root::Singular;
        };
        // det(A + s B) = det A · det(1 + s C), C = B A⁻¹ on the growing rows.
        let growth = DMatrix::from_fn(growing.len(), k, |i, j| {
            let (_, pair, sign) = rows[growing[i]];
            pair.map_or(0.0, |pair| sign * self.growth[pair] * self.scaled[(pair, rows[j].0)])
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
