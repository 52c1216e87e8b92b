//! Random problems, closed forms and other ways of computing the same.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::watch::Quiet;

/// A problem that owns its data: normals first, then t1 and t2 of each pair.
#[derive(Clone, Debug)]
struct Owned {
    stiffness: DMatrix<f64>,
    load: DVector<f64>,
    kernel: DMatrix<f64>,
    pairs: Vec<ConePair>,
}

impl Owned {
    fn new(stiffness: DMatrix<f64>, load: &[f64], laws: &[PairLaw]) -> Owned {
        let m = laws.len();
        let pair = |(i, law): (usize, &PairLaw)| ConePair { law: *law, tangents: m + 2 * i..m + 2 * i + 2 };
        Owned {
            kernel: DMatrix::zeros(stiffness.nrows(), 0),
            stiffness,
            load: DVector::from_row_slice(load),
            pairs: laws.iter().enumerate().map(pair).collect(),
        }
    }

    fn solve(&self, start: &DVector<f64>) -> Result<ConeAnswer, ConeFailure> {
        answer_on_cone(&self.problem(&self.load.abs()), start, &Quiet)
    }

    fn problem<'a>(&'a self, load_terms: &'a DVector<f64>) -> ConeProblem<'a> {
        ConeProblem {
            stiffness: &self.stiffness,
            load: &self.load,
            load_terms,
            rounded: self.kernel.ncols() > 0,
            kernel: &self.kernel,
            pairs: &self.pairs,
        }
    }

    fn answer_from_zero(&self) -> Result<ConeAnswer, ConeFailure> {
        self.solve(&DVector::zeros(self.load.len()))
    }

    /// The largest violation of the laws by z, in plain arithmetic: forces relative to the largest force that occurs,
    /// displacements to the largest one.
    fn violation(&self, z: &DVector<f64>) -> f64 {
        let force = &self.stiffness * z + &self.load;
        let size = self.load.amax().max(force.amax()).max(1e-300);
        let length = z.amax().max(1e-300);
        let mut worst = 0.0_f64;
        for (i, pair) in self.pairs.iter().enumerate() {
            if pair.law.is_bilateral() {
                worst = worst.max(z[i].abs() / length);
            } else {
                worst = worst.max(-force[i] / size).max(-z[i] / length).max(force[i].abs().min(z[i].abs()) / size);
            }
            let [t, u] = [pair.tangents.start, pair.tangents.start + 1];
            let pressed = if z[i] > 0.0 || pair.law.is_bilateral() { 0.0 } else { force[i] };
            let bound = pair.law.friction() * pressed + pair.law.fixed_bound();
            let slip = z[t].hypot(z[u]);
            worst = worst.max((force[t].hypot(force[u]) - bound) / size);
            if slip > 0.0 {
                worst = worst.max((force[t] + bound * z[t] / slip).abs() / size);
                worst = worst.max((force[u] + bound * z[u] / slip).abs() / size);
            }
        }
        worst
    }
}

fn positive_definite(rng: &mut ChaCha8Rng, n: usize, shift: f64) -> DMatrix<f64> {
    let a = DMatrix::from_fn(n, n, |_, _| rng.random_range(-1.0..1.0));
    let r = &a * a.transpose() / n as f64 + DMatrix::identity(n, n) * shift;
    // The same bits on both sides of the diagonal.
    DMatrix::from_fn(n, n, |i, j| r[(i.min(j), i.max(j))])
}

fn random(rng: &mut ChaCha8Rng, m: usize, f: f64) -> Owned {
    let shift = [0.5, 0.05][rng.random_range(0..2)];
    let stiffness = positive_definite(rng, 3 * m, shift);
    let kind = rng.random_range(0..5);
    let laws: Vec<PairLaw> = (0..m)
        .map(|_| match kind {
            0 => PairLaw::rubbing(f, [0.0, 0.3][rng.random_range(0..2)], 0.0),
            1 if rng.random_bool(0.3) => PairLaw::bilateral(rng.random_range(0.0..1.0)),
            _ => PairLaw::rubbing(f, 0.0, 0.0),
        })
        .collect();
    // Pressed, pulled, balanced by displacements, whole numbers.
    let load: Vec<f64> = match kind {
        2 => (0..3 * m).map(|i| if i < m { rng.random_range(0.0..2.0) } else { rng.random_range(-1.0..1.0) }).collect(),
        3 => (&stiffness * DVector::from_fn(3 * m, |_, _| rng.random_range(-1.0..1.0))).iter().copied().collect(),
        4 => (0..3 * m).map(|_| f64::from(rng.random_range(-2..=2))).collect(),
        _ => (0..3 * m).map(|_| rng.random_range(-1.0..1.0)).collect(),
    };
    Owned::new(stiffness, &load, &laws)
}

#[test]
fn positive_definite_problems_are_answered_from_zero_and_from_anywhere() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let (mut tried, mut failed, mut first, mut worst) = (0, 0, 0, 0.0_f64);
    for k in 0..160 {
        let m = 1 + k % 20;
        let f = [0.0, 0.3, 1.0, rng.random_range(0.0..5.0)][k / 20 % 4];
        let problem = random(&mut rng, m, f);
        let anywhere = DVector::from_fn(3 * m, |_, _| rng.random_range(-1.0..1.0));
        for start in [DVector::zeros(3 * m), anywhere] {
            tried += 1;
            match problem.solve(&start) {
                Ok(answer) => {
                    let violation = problem.violation(&answer.z);
                    worst = worst.max(violation);
                    assert!(violation < 1e-11, "problem {k}, m = {m}, f = {f}: {violation:e} {:?}", answer.check);
                    first += usize::from(answer.steps < 12);
                }
                Err(failure) => {
                    failed += 1;
                    println!("problem {k}, m = {m}, f = {f}: {failure}");
                }
            }
        }
    }
    println!("{tried} tried, {failed} without an answer, {first} within 12 steps; worst {worst:e}");
    assert!(failed * 20 <= tried, "{failed} of {tried}");
}

/// z = (0; u) in the one pair of a node on two springs k with the bound r: it slips by (|F| − r)/k along F.
#[test]
fn one_node_on_two_springs_slips_along_the_force() {
    let stiffness = DMatrix::identity(3, 3);
    let load = [10.0, -3.0, -4.0];
    for law in [PairLaw::bilateral(2.0), PairLaw::rubbing(0.2, 0.0, 0.0), PairLaw::rubbing(0.1, 1.0, 0.0)] {
        let answer = Owned::new(stiffness.clone(), &load, &[law]).answer_from_zero().expect("an answer");
        assert_eq!(answer.states, [ConeState::Slip]);
        for (found, expected) in answer.z.iter().zip([0.0, 1.8, 2.4]) {
            assert!((found - expected).abs() <= 4.0 * f64::EPSILON, "{found} for {expected}");
        }
        let force = |joint: usize| answer.forces[joint].value;
        assert!((force(1) + 1.2).abs() < 1e-15 && (force(2) + 1.6).abs() < 1e-15);
        assert_eq!(answer.distance, 1.0);
    }
}

#[test]
fn states_at_their_limits() {
    let solve = |load: [f64; 3], law: PairLaw| Owned::new(DMatrix::identity(3, 3), &load, &[law]).answer_from_zero();
    // Friction just used up, no slip; a hair more, and it slips by that hair.
    let answer = solve([4.0, 0.3, 0.4], PairLaw::rubbing(0.125, 0.0, 0.0)).expect("held");
    assert_eq!((answer.states[0], answer.z.amax()), (ConeState::Stick, 0.0));
    let answer = solve([4.0, 0.0, 0.5 + 1e-9], PairLaw::rubbing(0.125, 0.0, 0.0)).expect("slips");
    assert_eq!(answer.states[0], ConeState::Slip);
    assert!((answer.z[2] + 1e-9).abs() < 1e-15 && answer.z[1] == 0.0, "{}", answer.z);
    // Pulled off: what is open slips freely, or is held by its cohesion.
    let answer = solve([-2.0, 0.3, 0.4], PairLaw::rubbing(0.5, 0.0, 0.0)).expect("open");
    assert_eq!(answer.states[0], ConeState::Open);
    assert_eq!(answer.z.as_slice(), [2.0, -0.3, -0.4]);
    let answer = solve([-2.0, 0.3, 0.4], PairLaw::rubbing(0.5, 0.5, 0.0)).expect("open and held");
    assert_eq!((answer.states[0], answer.z[1], answer.z[2]), (ConeState::Open, 0.0, 0.0));
    // Nothing at all.
    let answer = solve([0.0; 3], PairLaw::rubbing(0.5, 0.0, 0.0)).expect("at rest");
    assert_eq!((answer.z.amax(), answer.steps, answer.distance), (0.0, 0, 0.0));
}

/// All answers of one pair with one friction coefficient: open, held, or slipping in a direction e where
/// s (R_ττ e + f (R_nτ·e) e) = −(q_τ + (f q_n) e) for some s > 0: found by a walk round the circle.
fn answers_of_one_pair(problem: &Owned) -> Vec<[f64; 3]> {
    let (r, q, f) = (&problem.stiffness, &problem.load, problem.pairs[0].law.friction());
    let mut found = Vec::new();
    let open = -r.clone().lu().solve(q).expect("regular");
    if open[0] > 0.0 {
        found.push([open[0], open[1], open[2]]);
    }
    if q[0] >= 0.0 && q[1].hypot(q[2]) <= f * q[0] {
        found.push([0.0; 3]);
    }
    let sides = |angle: f64| {
        let e = [angle.cos(), angle.sin()];
        let coupled = f * (r[(0, 1)] * e[0] + r[(0, 2)] * e[1]);
        let v = [0, 1].map(|t| r[(t + 1, 1)] * e[0] + r[(t + 1, 2)] * e[1] + coupled * e[t]);
        let w = [0, 1].map(|t| q[t + 1] + f * q[0] * e[t]);
        (e, v, w, v[0] * w[1] - v[1] * w[0])
    };
    let angle = |k: u32| f64::from(k) / 7200.0 * std::f64::consts::TAU;
    for k in 0..7200 {
        let (mut low, mut high) = (angle(k), angle(k + 1));
        if sides(low).3 * sides(high).3 > 0.0 {
            continue;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if sides(low).3 * sides(middle).3 > 0.0 { low = middle } else { high = middle }
        }
        let (e, v, w, _) = sides(low);
        let s = -(v[0] * w[0] + v[1] * w[1]) / (v[0] * v[0] + v[1] * v[1]);
        let x_n = q[0] + s * (r[(0, 1)] * e[0] + r[(0, 2)] * e[1]);
        if s > 0.0 && x_n > 0.0 {
            found.push([0.0, s * e[0], s * e[1]]);
        }
    }
    found
}

#[test]
fn of_one_pair_the_answer_is_one_of_all_that_there_are() {
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let mut slipping = 0;
    for k in 0..200 {
        let f = [0.2, 0.7, 2.0, 4.0][k % 4];
        let stiffness = positive_definite(&mut rng, 3, 0.1);
        let load: Vec<f64> = (0..3).map(|_| rng.random_range(-1.0..1.0)).collect();
        let problem = Owned::new(stiffness, &load, &[PairLaw::rubbing(f, 0.0, 0.0)]);
        let answers = answers_of_one_pair(&problem);
        let answer = problem.answer_from_zero().unwrap_or_else(|failure| panic!("problem {k}: {failure}; {answers:?}"));
        slipping += usize::from(answer.states[0] == ConeState::Slip);
        let size = answer.z.amax().max(1e-3);
        let near = |other: &&[f64; 3]| (0..3).all(|i| (other[i] - answer.z[i]).abs() <= 1e-9 * size);
        assert!(answers.iter().any(|other| near(&other)), "problem {k}: {} of {answers:?}", answer.z);
    }
    assert!(slipping > 40, "{slipping}");
}

/// The same answers from the forces as unknowns: λ ← P(λ − ρ z), z = R⁻¹ (λ − q), P pair by pair. Small friction: there
/// is one answer.
#[test]
fn the_iteration_on_the_forces_ends_in_the_same_answer() {
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let mut compared = 0;
    for k in 0..60 {
        let m = 1 + k % 6;
        let problem = Owned::new(
            positive_definite(&mut rng, 3 * m, 0.5),
            &(0..3 * m).map(|_| rng.random_range(-1.0..1.0)).collect::<Vec<f64>>(),
            &vec![PairLaw::rubbing(0.25, 0.0, 0.0); m],
        );
        let compliance = problem.stiffness.clone().try_inverse().expect("regular");
        let step = 1.0 / compliance.diagonal().sum();
        let mut force = DVector::zeros(3 * m);
        let mut z = &compliance * (&force - &problem.load);
        let mut change = 1.0;
        for _ in 0..20_000 {
            let before = force.clone();
            for i in 0..m {
                force[i] = f64::max(before[i] - step * z[i], 0.0);
                let (t, u) = (m + 2 * i, m + 2 * i + 1);
                let a = [before[t] - step * z[t], before[u] - step * z[u]];
                let (size, bound) = (a[0].hypot(a[1]), 0.25 * force[i]);
                let share = if size > bound { bound / size } else { 1.0 };
                (force[t], force[u]) = (share * a[0], share * a[1]);
            }
            z = &compliance * (&force - &problem.load);
            change = (&force - before).amax();
            if change <= 1e-16 {
                break;
            }
        }
        if change > 1e-13 {
            continue;
        }
        compared += 1;
        let answer = problem.answer_from_zero().expect("an answer");
        assert!((&answer.z - &z).amax() <= 1e-9 * z.amax().max(1e-3), "problem {k}: {} for {z}", answer.z);
    }
    assert!(compared > 40, "{compared}");
}

/// A rigid body on springs under its contact points, stiff along n and along t: R and RF of the points, the resultant
/// force and moment about the origin given.
fn body_on_springs(points: &[[f64; 2]], [along, across]: [f64; 2], resultant: [f64; 6], law: PairLaw) -> Owned {
    let m = points.len();
    let mut motions = DMatrix::zeros(3 * m, 6);
    for (i, [x, y]) in points.iter().enumerate() {
        // u + ω × r at z = 0; t1 = x, t2 = n × t1 = y.
        let (n, t, u) = (i, m + 2 * i, m + 2 * i + 1);
        (motions[(n, 2)], motions[(n, 3)], motions[(n, 4)]) = (1.0, *y, -x);
        (motions[(t, 0)], motions[(t, 5)]) = (1.0, -y);
        (motions[(u, 1)], motions[(u, 5)]) = (1.0, *x);
    }
    let springs = DMatrix::from_diagonal(&DVector::from_fn(3 * m, |i, _| if i < m { along } else { across }));
    let forced = &springs * &motions;
    let inverse = motions.tr_mul(&forced).try_inverse().expect("six motions");
    let r = &springs - &forced * &inverse * forced.transpose();
    let load = -(&forced * inverse * DVector::from_row_slice(&resultant));
    let r = DMatrix::from_fn(3 * m, 3 * m, |i, j| r[(i.min(j), i.max(j))]);
    Owned { kernel: motions.qr().q(), ..Owned::new(r, load.as_slice(), &vec![law; m]) }
}

/// A block of weight 4, its centre off the middle, pushed at 17 degrees through the centre of its friction: it is held
/// up to f W, its corners slipping one after the other, and nothing is claimed beyond.
#[test]
fn a_block_on_springs_is_held_to_its_limit() {
    let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
    let (f, weight, at) = (0.3, 4.0, [0.15, 0.1]);
    let (sin, cos) = 17.0_f64.to_radians().sin_cos();
    let pushed = |share: f64| {
        let push = share * f * weight;
        let turn = (at[0] * sin - at[1] * cos) * push;
        let resultant = [push * cos, push * sin, -weight, -weight * at[1], weight * at[0], turn];
        body_on_springs(&corners, [3.0, 1.0], resultant, PairLaw::rubbing(f, 0.0, 0.0)).answer_from_zero()
    };
    let mut slipping = 0;
    for share in [0.5, 0.9, 0.99, 0.999, 1.0 - 1e-4, 1.0 - 1e-6] {
        let answer = pushed(share).unwrap_or_else(|failure| panic!("{share}: {failure}"));
        slipping = slipping.max(answer.states.iter().filter(|state| **state == ConeState::Slip).count());
    }
    assert!((1..4).contains(&slipping), "{slipping}");
    for share in [1.0 + 1e-6, 1.0 + 1e-4, 1.01, 2.0] {
        assert!(matches!(pushed(share), Err(ConeFailure::NotConverged { .. })), "{share}");
    }
}

/// A ring of supports turned about its axis slips nowhere below Σ f N r, and cannot stand beyond.
#[test]
fn a_ring_stands_to_its_friction_torque() {
    let ring: Vec<[f64; 2]> =
        (0..8).map(|i| f64::from(i) * std::f64::consts::FRAC_PI_4).map(|a| [a.cos(), a.sin()]).collect();
    let turned = |share: f64| {
        let resultant = [0.0, 0.0, -8.0, 0.0, 0.0, share * 0.4 * 8.0];
        body_on_springs(&ring, [5.0, 2.0], resultant, PairLaw::rubbing(0.4, 0.0, 0.0)).answer_from_zero()
    };
    for share in [0.5, 1.0 - 1e-6, 1.0 - 1e-9] {
        assert!(turned(share).expect("it stands").states.iter().all(|state| *state == ConeState::Stick), "{share}");
    }
    assert!(turned(1.0 + 1e-9).is_err() && turned(1.1).is_err());
}

/// Joints a million times as stiff as others, and other units.
#[test]
fn scales_of_joints_and_units_change_nothing() {
    let mut rng = ChaCha8Rng::seed_from_u64(10);
    for k in 0..60 {
        let m = 1 + k % 8;
        let plain = random(&mut rng, m, 0.6);
        let scales: Vec<f64> = (0..m).map(|_| 10f64.powf(rng.random_range(-3.0..3.0))).collect();
        let of = |joint: usize| scales[if joint < m { joint } else { (joint - m) / 2 }];
        let scaled = Owned {
            stiffness: DMatrix::from_fn(3 * m, 3 * m, |i, j| of(i) * plain.stiffness[(i, j)] * of(j)),
            load: DVector::from_fn(3 * m, |i, _| of(i) * plain.load[i]),
            ..plain.clone()
        };
        let answer = scaled.answer_from_zero().unwrap_or_else(|failure| panic!("problem {k}: {failure}"));
        assert!(answer.check.violation() <= 4.0 * NOISE);
        // Forces in MN for N, lengths in m for mm, as powers of two: the same numbers.
        let units = Owned {
            stiffness: &plain.stiffness * 4f64.powi(5),
            load: &plain.load * 4f64.powi(-3),
            pairs: plain.pairs.iter().map(|pair| in_units(pair, 4f64.powi(-3))).collect(),
            kernel: plain.kernel.clone(),
        };
        let (one, other) = (plain.answer_from_zero().expect("an answer"), units.answer_from_zero().expect("an answer"));
        assert_eq!(one.z * 4f64.powi(-8), other.z, "problem {k}");
        assert_eq!((one.states, one.steps), (other.states, other.steps));
    }
}

fn in_units(pair: &ConePair, force: f64) -> ConePair {
    ConePair { law: pair.law.with_fixed_bound(pair.law.fixed_bound() * force), tangents: pair.tangents.clone() }
}

struct Stopped;

impl Watch for Stopped {
    fn stop(&self) -> bool {
        true
    }
}

#[test]
fn what_cannot_be_solved_says_why() {
    let mut problem = Owned::new(DMatrix::identity(3, 3), &[1.0, 2.0, 0.0], &[PairLaw::rubbing(0.5, 0.0, 0.0)]);
    let stopped = answer_on_cone(&problem.problem(&problem.load.abs()), &DVector::zeros(3), &Stopped);
    assert_eq!(stopped, Err(ConeFailure::Stopped));
    problem.load[1] = f64::NAN;
    assert_eq!(problem.answer_from_zero(), Err(ConeFailure::NotFinite));
}
