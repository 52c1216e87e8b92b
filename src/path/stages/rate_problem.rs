//! The rate problem (method §6): where the loads go on at a rate, the rates of all joints.
//!
//! ```text
//!   λ̇ = R ż + Ḟ
//!   open pair       ẋ_n = 0, and without cohesion λ̇_τ = 0: condensed out
//!   grazing pair    ẋ_n ≥ 0 ⟂ ż_n ≥ 0
//!   reserve used up ẋ^σ = σ λ̇_τ + f ẋ_n ≥ 0 ⟂ ż^σ ≥ 0
//!   all others      ż = 0
//! ```
//! Lemke's algorithm solves it under the covering `cohesive` on its rows.

use std::cell::RefCell;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::condensed::Condensed;
use super::released::{Released, part_along};
use super::standing::{Laws, Normal, Sense, Standing, Tangential, joint_scales};
use crate::contact::polygon::Polygon;
use crate::contact::rows::{RowId, RowKind};
use crate::contact::written::{ContactLcp, power_of_two};
use crate::lcp::basis::Basis;
use crate::lcp::basis_solution::vertex;
use crate::lcp::mirrored::{Mirror, MirroredLcp};
use crate::lcp::outcome::{Outcome, Run};
use crate::lcp::problem::{NOISE, Scale};
use crate::solve::engines::{run_past_cycles, under_other_coverings};
use crate::watch::Watch;
use stickslip_numerics::decompositions::Factor;

/// Rate problems with at most this many rows are searched basis by basis where Lemke's algorithm ends in a ray, others under
/// other covering vectors.
const SEARCHED_ROWS: usize = 14;

/// The rounding of a basis found by search stays below this part of the load's rate.
const HIDDEN: f64 = 1e-6;

/// A primary row: whose it is, and whether the couple of both senses of slip is meant.
#[derive(Clone, Copy)]
struct Row {
    pair: usize,
    joint: usize,
    couple: RowKind,
    mirrored: bool,
}

/// The LCP of one moment, with the way back to the joints.
pub(super) struct RateProblem<'a> {
    pub(super) laws: Laws<'a>,
    pub(super) contact: ContactLcp,
    pub(super) released: Released,
    pub(super) rate: &'a DVector<f64>,
    /// Σ |terms| of the load's rate.
    pub(super) sizes: &'a DVector<f64>,
}

/// How the rate problem ends.
pub(super) enum Ended {
    /// Rates: constant until the next event.
    Rates(Rates),
    /// No rates that a clear stiffness resists: the motion in which the run ended, over the joints, and its p. `little`: rates that
    /// little resists, where there are such.
    Ray { motion: DVector<f64>, p: f64, little: Option<Rates> },
    /// Stopped from outside.
    Interrupted,
    /// A limit, or numbers that no longer belong together; says which.
    Breakdown(String),
}

/// Rates per unit of the stage's place.
pub(super) struct Rates {
    pub(super) z: DVector<f64>,
    pub(super) force: DVector<f64>,
    /// The couples whose z may grow: their x stays 0.
    pub(super) moving: Vec<RowId>,
}

/// What resists the motion of rates.
pub(super) enum Resistance {
    /// A stiffness that is large beside its rounding, wherever they lead to.
    Clear,
    /// One that is small but no rounding.
    Little,
    /// None, or one that may be rounding: the motion.
    None(DVector<f64>),
}

/// The combination of joint forces that is the x of a couple, without its constant.
pub(super) fn terms(laws: Laws<'_>, meaning: RowId, open: bool) -> Vec<(usize, f64)> {
    let RowId { pair, couple } = meaning;
    let sign = match couple {
        RowKind::Normal => return vec![(pair, 1.0)],
        RowKind::PLUS => 1.0,
        RowKind::Facet(_) => -1.0,
    };
    let mut terms: Vec<(usize, f64)> =
        laws.problem.system.pairs[pair].plane_tangential().map(|joint| (joint, sign)).into_iter().collect();
    if !open && laws.friction(pair) > 0.0 {
        terms.push((pair, laws.friction(pair)));
    }
    terms
}

/// The joint that the z of a couple moves, and in which sense.
pub(super) fn moved(laws: Laws<'_>, meaning: RowId) -> (usize, f64) {
    let tangential = laws.problem.system.pairs[meaning.pair].plane_tangential().unwrap_or(meaning.pair);
    match meaning.couple {
        RowKind::Normal => (meaning.pair, 1.0),
        RowKind::PLUS => (tangential, 1.0),
        RowKind::Facet(_) => (tangential, -1.0),
    }
}

impl<'a> RateProblem<'a> {
    /// Writes the rate problem of a standing under the load's rate, `sizes` being its Σ |terms|; `None` where the released
    /// joints have no stiffness matrix that can be factorized.
    pub(super) fn new(
        laws: Laws<'a>,
        standing: &Standing,
        (rate, sizes): (&'a DVector<f64>, &'a DVector<f64>),
    ) -> Option<RateProblem<'a>> {
        let pairs = &laws.problem.system.pairs;
        let mut joints: Vec<usize> = (0..pairs.len()).filter(|&i| standing.is_open(i)).collect();
        let free = (0..pairs.len()).filter(|&i| standing.tangential[i] == Tangential::Free);
        joints.extend(free.filter_map(|i| pairs[i].plane_tangential()));
        let released = Released::new(&laws.problem.system, joints)?;
        let contact = write(laws, standing, &released, (rate, sizes), false)?;
        Some(RateProblem { laws, contact, released, rate, sizes })
    }

    /// The same with nothing at all that resists the motions that cost no energy, where the load does next to no work on them
    /// ([`Condensed::release_loose`]); `None` where there is no such motion.
    pub(super) fn neutral(&self, standing: &Standing) -> Option<RateProblem<'a>> {
        let contact = write(self.laws, standing, &self.released, (self.rate, self.sizes), true)?;
        Some(RateProblem { contact, released: self.released.clone(), ..*self })
    }

    /// Solves it.
    pub(super) fn solve(&self, standing: &Standing, watch: &dyn Watch) -> (Ended, Run) {
        let run = run_past_cycles(&self.contact, watch);
        let joints = self.released.pick(self.rate);
        if let Some(loose) = self.released.driven_motion(&joints, &self.released.pick(self.sizes)) {
            let mut motion = DVector::zeros(self.rate.len());
            self.released.joints.iter().zip(loose.iter()).for_each(|(&joint, v)| motion[joint] = *v);
            return (Ended::Ray { motion, p: 0.0, little: None }, run);
        }
        let soft = RefCell::new(None);
        let found = |z: &[f64], basic: &[usize]| {
            let z: Vec<f64> = z.iter().map(|z| z.max(0.0) * self.contact.length_unit).collect();
            let rates = self.rates(standing, &z, basic);
            match self.resistance(standing, &rates) {
                Resistance::Clear => Ok(rates),
                Resistance::Little => Err(soft.borrow_mut().get_or_insert(rates).z.clone()),
                Resistance::None(motion) => Err(motion),
            }
        };
        let of_run = |run: &Run| found(&run.point.z, &run.pivots.basis().z);
        let another = || match self.contact.lcp.full_size <= SEARCHED_ROWS {
            true => search(&self.contact.lcp, |z, basic| found(z, basic).ok()),
            false => under_other_coverings(&self.contact, watch, |run| of_run(run).ok()),
        };
        let ray = |motion, p| Ended::Ray { motion, p, little: soft.take() };
        let ended = match &run.outcome {
            Outcome::Trivial | Outcome::Normal { .. } => match of_run(&run) {
                Ok(rates) => Ended::Rates(rates),
                Err(motion) => another().map_or_else(|| ray(motion, 0.0), Ended::Rates),
            },
            Outcome::Ray(direction) => another().map_or_else(
                || {
                    let motion = self.with_released(&direction.z, &DVector::zeros(self.rate.len()));
                    ray(motion, run.point.p * self.contact.force_unit)
                },
                Ended::Rates,
            ),
            Outcome::Interrupted => Ended::Interrupted,
            Outcome::PivotLimit => Ended::Breakdown("the rate problem came to the limit of pivots".to_owned()),
            Outcome::Cycle(_) => Ended::Breakdown("the rate problem cycles".to_owned()),
            Outcome::Breakdown(why) => Ended::Breakdown(why.clone()),
        };
        (ended, run)
    }

    /// ż over the joints from that of the rows: the released joints follow, with the load's rate `load` on them.
    fn with_released(&self, rows: &[f64], load: &DVector<f64>) -> DVector<f64> {
        let mut z = DVector::zeros(load.len());
        for (meaning, value) in self.contact.rows.iter().zip(rows) {
            let (joint, sign) = moved(self.laws, *meaning);
            z[joint] += sign * value;
        }
        let force = self.laws.force(&z, load);
        let follow = self.released.solve(&self.released.pick(&force));
        self.released.joints.iter().zip(follow.iter()).for_each(|(&joint, v)| z[joint] = -v);
        z
    }

    fn rates(&self, standing: &Standing, rows: &[f64], basic: &[usize]) -> Rates {
        let moving: Vec<RowId> = basic.iter().map(|&row| self.contact.rows[row]).collect();
        let mut z = self.with_released(rows, self.rate);
        let found = z.clone();
        self.correct(standing, &moving, &[], &mut z, self.rate, |_| 0.0);
        if (&z - &found).amax() > HIDDEN * z.amax()
            && let Some(determined) = self.determined(&moving, &z)
        {
            z = determined;
        }
        let mut force = self.laws.force(&z, self.rate);
        self.settle(standing, &moving, &mut force, |_| 0.0);
        Rates { z, force, moving }
    }

    /// Rates without their part along the motions that cost no energy and that these couples leave to themselves: nothing tells how
    /// large that is, and what the numbers make of it is a division by rounding. `None` where there are no such motions, or where
    /// couples would move backwards without.
    fn determined(&self, moving: &[RowId], z: &DVector<f64>) -> Option<DVector<f64>> {
        let (joints, loose) = self.loose_of(&self.released, moving)?;
        let rest = z - part_along(&loose, &joints, z);
        let noise = self.laws.length_sizes(&joint_scales(&self.laws.problem.system), &rest) * NOISE;
        let mut couples = moving.iter().map(|meaning| moved(self.laws, *meaning));
        couples.all(|(joint, sign)| sign * rest[joint] >= -noise[joint]).then_some(rest)
    }

    /// The motions that cost no energy of the released joints and those that these couples move, and these joints; `None` where the
    /// couples add none to those of the released ones.
    pub(super) fn loose_of(&self, released: &Released, moving: &[RowId]) -> Option<(Vec<usize>, DMatrix<f64>)> {
        released.loose_with(&self.laws.problem.system, moving.iter().map(|meaning| moved(self.laws, *meaning).0))
    }

    /// Sets to their exact values the forces that the laws give: 0 in released joints, ∓ bound where a pair slips;
    /// `constant` is that of the bound.
    pub(super) fn settle(
        &self,
        standing: &Standing,
        moving: &[RowId],
        force: &mut DVector<f64>,
        constant: impl Fn(usize) -> f64,
    ) {
        self.released.joints.iter().for_each(|&joint| force[joint] = 0.0);
        for meaning in moving.iter().filter(|meaning| meaning.couple == RowKind::Normal) {
            force[meaning.pair] = 0.0;
        }
        for meaning in moving.iter().filter(|meaning| meaning.couple != RowKind::Normal) {
            let (joint, sign) = moved(self.laws, *meaning);
            let normal = if standing.is_open(meaning.pair) { 0.0 } else { force[meaning.pair] };
            force[joint] = 0.0 - sign * (self.laws.friction(meaning.pair) * normal + constant(meaning.pair));
        }
    }

    /// One step of Newton's method on the equations that hold while `moving` moves: what the rounding of the steps
    /// before has left of them is taken out, so that it does not add up over a history. Pairs that `close` here are held
    /// at z_n = 0. `constant` is that of the bound (0 for rates), `load` that of λ = R z + load.
    pub(super) fn correct(
        &self,
        standing: &Standing,
        moving: &[RowId],
        close: &[usize],
        z: &mut DVector<f64>,
        load: &DVector<f64>,
        constant: impl Fn(usize) -> f64,
    ) {
        close.iter().for_each(|&pair| z[pair] = 0.0);
        let narrower = if close.is_empty() {
            None
        } else {
            let joints = self.released.joints.iter().copied().filter(|joint| !close.contains(joint)).collect();
            Released::new(&self.laws.problem.system, joints)
        };
        let released = narrower.as_ref().unwrap_or(&self.released);
        let force = self.laws.force(z, load);
        // What the released joints will do first: −R_FF⁻¹ r_F.
        let left = released.solve(&released.pick(&force));
        let mut after = force.clone();
        for (&joint, v) in released.joints.iter().zip(left.iter()) {
            after.axpy(-v, &self.laws.problem.system.stiffness.column(joint), 1.0);
        }
        let residual = DVector::from_fn(moving.len(), |a, _| {
            let own = if moving[a].couple == RowKind::Normal { 0.0 } else { constant(moving[a].pair) };
            let terms = terms(self.laws, moving[a], standing.is_open(moving[a].pair));
            own + terms.iter().map(|(joint, by)| by * after[*joint]).sum::<f64>()
        });
        let steps = self.matrix_of(standing, released, moving).and_then(|matrix| matrix.solve(&residual));
        let mut own = DVector::zeros(z.len());
        if let Some(steps) = steps {
            for (meaning, step) in moving.iter().zip(steps.iter()) {
                let (joint, sign) = moved(self.laws, *meaning);
                own[joint] -= sign * step;
            }
        }
        let follow = released.solve(&released.pick(&self.laws.force(&own, &force)));
        released.joints.iter().zip(follow.iter()).for_each(|(&joint, v)| own[joint] = -v);
        // Along motions that cost no energy the equations say nothing: what is no rounding there was divided by rounding.
        if own.amax() > HIDDEN * z.amax()
            && let Some((joints, loose)) = self.loose_of(released, moving)
        {
            own -= part_along(&loose, &joints, &own);
        }
        *z += own;
    }

    /// The condensed stiffness of the moving couples, factorized.
    fn matrix_of(&self, standing: &Standing, released: &Released, moving: &[RowId]) -> Option<Factor> {
        if moving.is_empty() {
            return None;
        }
        let joints = moving.iter().flat_map(|meaning| [moved(self.laws, *meaning).0, meaning.pair]).collect();
        let stiffness = Condensed::new(self.laws, released, joints);
        let rows: Vec<Vec<(usize, f64)>> =
            moving.iter().map(|row| terms(self.laws, *row, standing.is_open(row.pair))).collect();
        let matrix = DMatrix::from_fn(moving.len(), moving.len(), |a, b| {
            let (joint, sign) = moved(self.laws, moving[b]);
            let entry = |(row, by): &(usize, f64)| by * stiffness.entry(*row, joint);
            sign * rows[a].iter().map(entry).sum::<f64>()
        });
        Some(Factor::new(matrix))
    }
}

/// What is made of the first basis that is an answer and of which something is made: R alone does not make the rate problem
/// one that Lemke's algorithm must solve. A basis whose rounding hides the load's rate decides nothing.
fn search<T>(lcp: &MirroredLcp, made: impl Fn(&[f64], &[usize]) -> Option<T>) -> Option<T> {
    let n = lcp.full_size;
    // Primary row of each whole row; the two rows of a couple never move together.
    let mut primary: Vec<usize> = (0..n).collect();
    let couples = lcp.mirrors.iter().enumerate().filter_map(|(row, mirror)| Some((row, mirror.as_ref()?.whole)));
    let couples: Vec<(usize, usize)> = couples.collect();
    couples.iter().for_each(|&(row, mirror)| primary[mirror] = row);
    let column = |row: usize| lcp.scale.column[primary[row]];
    (1_u32..1 << n).find_map(|bits| {
        let moves = |row: usize| bits & (1 << row) != 0;
        if couples.iter().any(|&(row, mirror)| moves(row) && moves(mirror)) {
            return None;
        }
        let z: Vec<usize> = (0..n).filter(|&row| moves(row)).collect();
        let point = vertex(lcp, &Basis { active: z.clone(), z: z.clone(), p: false })?;
        let size: f64 = point.z.iter().enumerate().map(|(row, z)| column(row) * z.abs()).sum();
        let stands = (0..n).all(|row| {
            let noise = NOISE * (lcp.q.amax() + lcp.scale.row[primary[row]] * size);
            noise <= HIDDEN * lcp.q.amax() && column(row) * point.z[row] >= -NOISE * size && point.w[row] >= -noise
        });
        if stands { made(&point.z, &z) } else { None }
    })
}

/// The primary rows: all normal ones, then the tangential ones.
fn primary_rows(laws: Laws<'_>, standing: &Standing) -> Vec<Row> {
    let pairs = &laws.problem.system.pairs;
    let grazing = (0..pairs.len()).filter(|&i| standing.normal[i] == Normal::Grazing);
    let normals = grazing.map(|pair| Row { pair, joint: pair, couple: RowKind::Normal, mirrored: false });
    let tangentials = (0..pairs.len()).filter_map(|pair| {
        let joint = pairs[pair].plane_tangential()?;
        let (couple, mirrored) = match standing.tangential[pair] {
            Tangential::Limit(Sense::Plus) => (RowKind::PLUS, false),
            Tangential::Limit(Sense::Minus) => (RowKind::MINUS, false),
            Tangential::Both => (RowKind::PLUS, true),
            Tangential::Absent | Tangential::Free | Tangential::Held => return None,
        };
        Some(Row { pair, joint, couple, mirrored })
    });
    normals.chain(tangentials).collect()
}

/// The rows of the whole LCP, primary ones first, and the mirror of each of these.
fn whole_rows(laws: Laws<'_>, primary: &[Row]) -> (Vec<RowId>, Vec<Option<Mirror>>) {
    let mut rows: Vec<RowId> = primary.iter().map(|row| RowId { pair: row.pair, couple: row.couple }).collect();
    let mut mirrors = vec![None; primary.len()];
    for (i, row) in primary.iter().enumerate().filter(|(_, row)| row.mirrored) {
        mirrors[i] = Some(Mirror {
            whole: rows.len(),
            normal: primary.iter().position(|normal| normal.pair == row.pair && normal.couple == RowKind::Normal),
            friction: laws.friction(row.pair),
            constant: 0.0,
            covering: 2.0,
        });
        rows.push(RowId { pair: row.pair, couple: RowKind::MINUS });
    }
    (rows, mirrors)
}

/// Writes the LCP, dimensionless as that of eq. (8).
///
/// What of q may be rounding is 0. Where a reversal finds a part in neutral equilibrium, such rows may be all there are: read
/// as rates they would have no answer, for nothing resists the motion that is free. `neutral`: see [`RateProblem::neutral`].
fn write(
    laws: Laws<'_>,
    standing: &Standing,
    released: &Released,
    rate: (&DVector<f64>, &DVector<f64>),
    neutral: bool,
) -> Option<ContactLcp> {
    let system = &*laws.problem.system;
    let primary = primary_rows(laws, standing);
    let count = primary.len();
    let mut stiffness = Condensed::new(laws, released, primary.iter().flat_map(|row| [row.joint, row.pair]).collect());
    let (mut load, noise) = stiffness.load(laws, released, rate);
    let moving: Vec<usize> = primary.iter().map(|row| row.joint).collect();
    if neutral && !stiffness.release_loose(laws, (released, &moving), &mut load) {
        return None;
    }
    let normal_of = |pair: usize| primary.iter().position(|row| row.pair == pair && row.couple == RowKind::Normal);
    let meaning_of = |row: &Row| RowId { pair: row.pair, couple: row.couple };
    // Of a couple of both senses S holds λ_τ alone: the LCP adds f λ_n and makes the mirror.
    let stored = |row: &Row| match row.mirrored {
        true => vec![(row.joint, 1.0)],
        false => terms(laws, meaning_of(row), standing.is_open(row.pair)),
    };
    let sum =
        |terms: &[(usize, f64)], value: &dyn Fn(usize) -> f64| terms.iter().map(|(j, by)| by * value(*j)).sum::<f64>();

    let mut q: DVector<f64> = DVector::from_fn(count, |i, _| {
        let row = &primary[i];
        let terms = terms(laws, meaning_of(row), standing.is_open(row.pair));
        let noise: f64 = terms.iter().map(|(joint, by)| by.abs() * noise[*joint]).sum();
        Some(sum(&terms, &|joint| load[joint])).filter(|q| q.abs() > noise).unwrap_or_default()
    });
    let pressed = |pair: usize| normal_of(pair).map_or(0.0, |normal| q[normal]);
    let mirrors_q = primary
        .iter()
        .enumerate()
        .filter(|(_, row)| row.mirrored)
        .map(|(i, row)| 2.0 * laws.friction(row.pair) * pressed(row.pair) - q[i]);
    let largest = mirrors_q.fold(q.amax(), |most: f64, q| most.max(q.abs()));
    let stiffness_unit = power_of_two(system.stiffness.diagonal().amax());
    let force_unit = power_of_two(largest);
    q /= force_unit;
    let rows: Vec<Vec<(usize, f64)>> = primary.iter().map(stored).collect();
    let base = DMatrix::from_fn(count, count, |i, j| {
        let (joint, sign) = moved(laws, meaning_of(&primary[j]));
        sign * sum(&rows[i], &|row| stiffness.entry(row, joint)) / stiffness_unit
    });
    let scales = joint_scales(system) / stiffness_unit.sqrt();
    let (rows, mirrors) = whole_rows(laws, &primary);
    let find = |pair: usize, couple: RowKind| rows.iter().position(|row| *row == RowId { pair, couple });
    let rows_of = |couple: RowKind| (0..system.pairs.len()).map(|pair| find(pair, couple)).collect();
    let normal_row = rows_of(RowKind::Normal);
    let facet_rows = vec![rows_of(RowKind::PLUS), rows_of(RowKind::MINUS)];
    let lcp = MirroredLcp {
        base: Arc::new(base),
        q,
        covering: DVector::from_iterator(
            count,
            primary.iter().map(|row| match row.couple {
                RowKind::Normal => 1.0,
                _ => 1.0 + laws.friction(row.pair),
            }),
        ),
        whole: (0..count).collect(),
        mirrors,
        scale: Scale {
            row: primary
                .iter()
                .map(|row| match row.couple {
                    RowKind::Normal => scales[row.joint],
                    _ => scales[row.joint] + laws.friction(row.pair) * scales[row.pair],
                })
                .collect(),
            column: primary.iter().map(|row| scales[row.joint]).collect(),
            // Dimensionless: the largest |q| is about 1.
            load: Some(1.0),
        },
        full_size: rows.len(),
    };
    Some(ContactLcp {
        swapped: vec![false; rows.len()],
        lcp: Arc::new(lcp),
        friction: laws.problem.frictions(),
        rows,
        force_unit,
        length_unit: force_unit / stiffness_unit,
        normal_row,
        facet_rows,
        polygon: Polygon::PLANE,
    })
}
