//! Judges a history from R and RF alone: the laws segment by segment, and where small steps lead, each solved on its own by
//! a search over the states of the pairs.

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use stickslip::answer::record::PairState;
use stickslip::path::stages::{History, Moment, StageResult};
use stickslip::solve::Prepared;
use stickslip::solve::problem::contact_problem;

/// One pair as the tests see it: rows of R, f, what else the bound has, gap, whether it may open.
struct Pair {
    normal: usize,
    tangential: Option<usize>,
    friction: f64,
    constant: f64,
    gap: f64,
    opens: bool,
}

pub(super) struct Data {
    r: DMatrix<f64>,
    cases: Vec<DVector<f64>>,
    pairs: Vec<Pair>,
}

impl Data {
    pub(super) fn of(prepared: &Prepared, values: &stickslip::model::parameter::ParameterValues) -> Data {
        let system = prepared.system().expect("pairs");
        let problem = contact_problem(system, &vec![0.0; system.loads.len()], values);
        let pairs = system.pairs.iter().enumerate().map(|(i, pair)| Pair {
            normal: i,
            tangential: pair.plane_tangential(),
            friction: problem.laws[i].friction(),
            constant: problem.laws[i].fixed_bound(),
            gap: problem.laws[i].gap(),
            opens: !pair.law.is_bilateral(),
        });
        Data {
            r: system.stiffness.clone(),
            cases: system.loads.iter().map(|load| load.vector.clone()).collect(),
            pairs: pairs.collect(),
        }
    }

    pub(super) fn displacements(&self, pairs: &[PairState]) -> DVector<f64> {
        let mut z = DVector::zeros(self.r.nrows());
        for (pair, state) in self.pairs.iter().zip(pairs) {
            z[pair.normal] = state.z_n;
            if let Some(joint) = pair.tangential {
                z[joint] = state.z_t;
            }
        }
        z
    }

    /// Σ |terms| of the load.
    fn sizes(&self, factors: &[f64]) -> DVector<f64> {
        let mut sizes = DVector::zeros(self.r.nrows());
        for (case, factor) in self.cases.iter().zip(factors) {
            sizes += factor.abs() * case.map(f64::abs);
        }
        for pair in &self.pairs {
            sizes += pair.gap.abs() * self.r.column(pair.normal).map(f64::abs);
        }
        sizes
    }

    fn load(&self, factors: &[f64]) -> DVector<f64> {
        let mut load = DVector::zeros(self.r.nrows());
        for (case, factor) in self.cases.iter().zip(factors) {
            load += *factor * case;
        }
        for pair in &self.pairs {
            load -= pair.gap * self.r.column(pair.normal);
        }
        load
    }
}

/// The laws in rates along a history, from R and RF: the first breach.
pub(super) fn breach(data: &Data, history: &History) -> Option<String> {
    let mut before: Option<(DVector<f64>, Vec<f64>)> = None;
    for (index, stage) in history.stages.iter().enumerate() {
        for (k, ends) in stage.moments.windows(2).enumerate() {
            let z = [data.displacements(&ends[0].pairs), data.displacements(&ends[1].pairs)];
            let force = [0, 1].map(|end| &data.r * &z[end] + data.load(&ends[end].factors));
            // Rounding goes with the terms that a force sums, or summed: a load that is let off leaves the rounding of what it was.
            let sizes = [0, 1].map(|end| {
                let terms = data.r.map(f64::abs) * z[end].map(f64::abs) + data.sizes(&ends[end].factors);
                1e-11 * terms
            });
            let both = sizes[0].zip_map(&sizes[1], f64::max);
            let tiny = [&both, &both];
            let short = 1e-9 * z[0].amax().max(z[1].amax());
            let place = |what: &str, pair: usize| {
                let [a, b] = [&ends[0], &ends[1]];
                Some(format!(
                    "stage {index}, segment {k} of {}, pair {pair}: {what}; {} {:?} to {} {:?}, tolerance {short}",
                    stage.moments.len() - 1,
                    a.t,
                    a.pairs.get(pair),
                    b.t,
                    b.pairs.get(pair)
                ))
            };
            if let Some((old, factors)) = &before
                && ((old - &z[0]).amax() > short || *factors != ends[0].factors)
            {
                return place("the way has a hole", 0);
            }
            for (i, pair) in data.pairs.iter().enumerate() {
                for end in 0..2 {
                    let shown = &ends[end].pairs[i];
                    let (x_n, noise) = (force[end][pair.normal], tiny[end][pair.normal]);
                    if pair.opens && (x_n < -noise || z[end][pair.normal] < 0.0) {
                        return place(&format!("x_n {x_n:e} (noise {noise:e}) or z_n below 0"), i);
                    }
                    if pair.opens && z[end][pair.normal].max(z[1 - end][pair.normal]) > short && x_n.abs() > noise {
                        return place(&format!("open with x_n {x_n:e} (noise {noise:e})"), i);
                    }
                    if (shown.x_n - x_n).abs() > noise {
                        return place(&format!("x_n is not that of R, {x_n:e} (noise {noise:e})"), i);
                    }
                    let Some(joint) = pair.tangential else { continue };
                    let (x_t, noise) = (force[end][joint], tiny[end][joint] + pair.friction * noise);
                    let bound = pair.friction * x_n.max(0.0) + pair.constant;
                    if x_t.abs() > bound + noise {
                        return place(&format!("{x_t} beyond the bound {bound}"), i);
                    }
                    let slip = z[1][joint] - z[0][joint];
                    if slip.abs() > short && (x_t + slip.signum() * bound).abs() > noise {
                        return place("slips away from its limit", i);
                    }
                    if (shown.x_t - x_t).abs() > noise {
                        return place("x_t is not that of R", i);
                    }
                }
            }
            before = Some((z[1].clone(), ends[1].factors.clone()));
        }
    }
    None
}

#[derive(Clone, Copy, PartialEq, Debug)]
struct Scheme {
    open: bool,
    /// −1, 0, 1.
    slip: i8,
}

impl Data {
    /// z and λ with every pair in its scheme, the slips of those that stick as they were.
    fn in_scheme(&self, load: &DVector<f64>, old: &DVector<f64>, schemes: &[Scheme]) -> Option<[DVector<f64>; 2]> {
        let n = self.r.nrows();
        let (mut matrix, mut right) = (DMatrix::zeros(n, n), DVector::zeros(n));
        for (pair, scheme) in self.pairs.iter().zip(schemes) {
            if scheme.open {
                matrix.row_mut(pair.normal).copy_from(&self.r.row(pair.normal));
                right[pair.normal] = -load[pair.normal];
            } else {
                matrix[(pair.normal, pair.normal)] = 1.0;
            }
            let Some(joint) = pair.tangential else { continue };
            if scheme.slip == 0 {
                matrix[(joint, joint)] = 1.0;
                right[joint] = old[joint];
            } else {
                let (sign, f) = (f64::from(scheme.slip), if scheme.open { 0.0 } else { pair.friction });
                let row = self.r.row(joint) * sign + self.r.row(pair.normal) * f;
                matrix.row_mut(joint).copy_from(&row);
                right[joint] = -(sign * load[joint] + f * load[pair.normal] + pair.constant);
            }
        }
        let z = matrix.lu().solve(&right)?;
        let force = &self.r * &z + load;
        Some([z, force])
    }

    /// The schemes that would mend what is broken in this state; empty: it is the answer.
    fn mended(&self, old: &DVector<f64>, [z, force]: &[DVector<f64>; 2], schemes: &[Scheme]) -> Vec<(usize, Scheme)> {
        let (tiny, short) = (1e-9 * force.amax().max(1e-6), 1e-9 * z.amax().max(old.amax()).max(1e-9));
        let mut mends = Vec::new();
        for (i, (pair, scheme)) in self.pairs.iter().zip(schemes).enumerate() {
            let mut next = *scheme;
            if pair.opens && scheme.open && z[pair.normal] < -short {
                next.open = false;
            }
            if pair.opens && !scheme.open && force[pair.normal] < -tiny {
                next.open = true;
            }
            if let Some(joint) = pair.tangential {
                let f = if scheme.open { 0.0 } else { pair.friction };
                let bound = f * force[pair.normal] + pair.constant;
                let nothing_holds = scheme.open && pair.constant == 0.0;
                let slip = z[joint] - old[joint];
                if scheme.slip != 0 && f64::from(scheme.slip) * slip < -short && !nothing_holds {
                    next.slip = 0;
                } else if scheme.slip == 0 && force[joint].abs() > bound + tiny {
                    next.slip = if force[joint] > 0.0 { -1 } else { 1 };
                }
            }
            if next != *scheme {
                mends.push((i, next));
            }
        }
        mends
    }

    /// The state after a small step, from the schemes of the step before.
    fn step(&self, load: &DVector<f64>, old: &DVector<f64>, schemes: &mut [Scheme]) -> Option<[DVector<f64>; 2]> {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        for round in 0..400 {
            let state = self.in_scheme(load, old, schemes)?;
            let mends = self.mended(old, &state, schemes);
            if mends.is_empty() {
                return Some(state);
            }
            // All at once, then one after the other, drawn at random.
            let one = random.random_range(0..mends.len());
            for &(i, next) in if round < 20 { &mends[..] } else { &mends[one..=one] } {
                schemes[i] = next;
            }
        }
        None
    }

    /// Every state that a step leads to, by every scheme of every pair; `None` where there are too many to go through.
    fn search(&self, load: &DVector<f64>, old: &DVector<f64>) -> Option<Vec<[DVector<f64>; 2]>> {
        let choices: Vec<Vec<Scheme>> = self
            .pairs
            .iter()
            .map(|pair| {
                let slips: &[i8] = if pair.tangential.is_some() { &[0, 1, -1] } else { &[0] };
                let opens: &[bool] = if pair.opens { &[false, true] } else { &[false] };
                opens.iter().flat_map(|&open| slips.iter().map(move |&slip| Scheme { open, slip })).collect()
            })
            .collect();
        let count: usize = choices.iter().map(Vec::len).product();
        let scheme = |mut number: usize| {
            let pick = |choices: &Vec<Scheme>| {
                let chosen = choices[number % choices.len()];
                number /= choices.len();
                chosen
            };
            choices.iter().map(pick).collect::<Vec<_>>()
        };
        let answers = (0..count).map(scheme).filter_map(|schemes| {
            let state = self.in_scheme(load, old, &schemes)?;
            self.mended(old, &state, &schemes).is_empty().then_some(state)
        });
        (count <= 8_000).then(|| answers.collect())
    }

    /// z at the end of each stage by `steps` small steps a stage; `None` where a step has no answer.
    fn by_steps(&self, stages: &[Vec<f64>], steps: usize) -> Option<Vec<[DVector<f64>; 2]>> {
        let mut z: DVector<f64> = DVector::zeros(self.r.nrows());
        for pair in &self.pairs {
            z[pair.normal] = pair.gap.max(0.0);
        }
        let mut schemes: Vec<Scheme> = self.pairs.iter().map(|pair| Scheme { open: pair.gap > 0.0, slip: 0 }).collect();
        let mut from = vec![0.0; self.cases.len()];
        let mut ends = Vec::new();
        for target in stages {
            let mut state = None;
            for step in 1..=steps {
                let s = step as f64 / steps as f64;
                let factors: Vec<f64> = from.iter().zip(target).map(|(a, b)| a + s * (b - a)).collect();
                let load = self.load(&factors);
                let found = self.step(&load, &z, &mut schemes).or_else(|| {
                    let apart = |state: &[DVector<f64>; 2]| (&state[0] - &z).amax();
                    let states = self.search(&load, &z)?;
                    states.into_iter().min_by(|a, b| apart(a).total_cmp(&apart(b)))
                })?;
                z = found[0].clone();
                state = Some(found);
            }
            ends.push(state?);
            from.clone_from(target);
        }
        Some(ends)
    }
}

/// How far each stage's end is from where `steps` small steps a stage lead, relative to the largest force and
/// displacement; `None` where a small step has no answer.
pub(super) fn apart(data: &Data, history: &History, steps: usize) -> Option<Vec<f64>> {
    let end = |stage: &StageResult| stage.moments.last().expect("an end").clone();
    let targets: Vec<Vec<f64>> = history.stages.iter().map(|stage| end(stage).factors).collect();
    let ends = data.by_steps(&targets, steps)?;
    let length = ends.iter().map(|[z, _]| z.amax()).fold(0.0, f64::max);
    let size = ends.iter().map(|[_, force]| force.amax()).fold(0.0, f64::max);
    let stages = history.stages.iter().zip(&ends);
    let differences = stages.map(|(stage, [z, force])| {
        let pairs = data.pairs.iter().zip(end(stage).pairs);
        pairs.fold(0.0, |worst: f64, (pair, shown)| {
            let normal =
                ((shown.z_n - z[pair.normal]) / length).abs().max(((shown.x_n - force[pair.normal]) / size).abs());
            let tangential = pair.tangential.map_or(0.0, |joint| {
                ((shown.x_t - force[joint]) / size).abs().max(((shown.z_t - z[joint]) / length).abs())
            });
            worst.max(normal).max(tangential)
        })
    });
    Some(differences.collect())
}

/// The largest distance of any stage end by `steps` small steps, and, where that is more than 4 / `steps`, by 4 and 16
/// times as many; `None` where a small step has no answer.
pub(super) fn distances(data: &Data, history: &History, steps: usize) -> Option<Vec<f64>> {
    let distance = |steps: usize| Some(apart(data, history, steps)?.into_iter().fold(0.0, f64::max));
    let first = distance(steps)?;
    if first <= 4.0 / steps as f64 {
        return Some(vec![first]);
    }
    Some(vec![first, distance(4 * steps)?, distance(16 * steps)?])
}

/// A step that contains an event is right to the order of what one step moves: small steps lead to the same ends if
/// their distance falls with the step. How far they are apart at one number of steps is no measure: a frame that gives
/// way moves far in one step. First order is a factor of 16; where in a step an event lies may take up to 4 of it.
pub(super) fn converges(distances: &[f64], steps: usize) -> bool {
    match distances {
        [first] => *first <= 4.0 / steps as f64,
        [first, .., last] => 4.0 * last <= *first,
        [] => false,
    }
}

/// Whether a step of 1e-6 of the way to `target` leads from a moment to a state within `near` of it: the step is far
/// beyond what the search takes for rounding. `None` where there are too many schemes to go through.
pub(super) fn goes_on(data: &Data, moment: &Moment, target: &[f64], near: f64) -> Option<bool> {
    let old = data.displacements(&moment.pairs);
    let factors: Vec<f64> = moment.factors.iter().zip(target).map(|(now, to)| now + 1e-6 * (to - now)).collect();
    let states = data.search(&data.load(&factors), &old)?;
    Some(states.iter().any(|[z, _]| (z - &old).amax() <= near))
}
