//! Contact systems in space: the laws of Coulomb's cone evaluated here from the user's R, RF and f, not by the program.

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::json;
use stickslip::answer::record::{Answer, OutcomeKind, PairState, State, Verdict};
use stickslip::model::load::load_text;
use stickslip::model::rules::{Covering, Engine, Rules};
use stickslip::solve::prepare;
use stickslip::watch::Quiet;

struct System {
    m: usize,
    /// Normals, then t1 and t2 of each pair.
    stiffness: DMatrix<f64>,
    load: DVector<f64>,
    friction: Vec<f64>,
    cohesion: Vec<f64>,
}

impl System {
    fn text(&self) -> String {
        let rows: Vec<Vec<f64>> = self.stiffness.row_iter().map(|row| row.iter().copied().collect()).collect();
        json!({
            "format": "stickslip/1", "title": "in space",
            "contact_system": {
                "pairs": (0..self.m).map(|i| format!("c{i}")).collect::<Vec<_>>(),
                "tangents": 2,
                "stiffness": rows,
                "loads": { "all": { "vector": self.load.as_slice() } },
                "friction": self.friction, "cohesion": self.cohesion,
            }
        })
        .to_string()
    }

    fn solve(&self, rules: Rules) -> Answer {
        let scenario = load_text("space", &self.text(), None).expect("read");
        let prepared = prepare(&scenario, &Quiet).expect("sound");
        let values = scenario.parameter_values();
        prepared.case(&scenario, &values).under(rules).solve().expect("solved").answer
    }

    /// Largest violation of the laws, as a share of the largest force, and whether the words belong to the numbers.
    fn violation(&self, pairs: &[PairState]) -> f64 {
        let m = self.m;
        let mut z = DVector::zeros(3 * m);
        for (i, pair) in pairs.iter().enumerate() {
            let [along, across] = pair.space.expect("in space").z_t;
            (z[i], z[m + 2 * i], z[m + 2 * i + 1]) = (pair.z_n, along, across);
        }
        let force = &self.stiffness * &z + &self.load;
        let size = self.load.amax();
        let mut worst = 0.0_f64;
        let mut at_most = |value: f64| worst = worst.max(value / size);
        for (i, pair) in pairs.iter().enumerate() {
            let (x_n, x_t) = (force[i], [force[m + 2 * i], force[m + 2 * i + 1]]);
            let told = pair.space.expect("in space").x_t;
            at_most((x_n - pair.x_n).abs());
            at_most((x_t[0] - told[0]).hypot(x_t[1] - told[1]));
            at_most(-x_n);
            assert!(pair.z_n >= 0.0);
            if pair.z_n > 0.0 {
                at_most(x_n.abs());
                assert_eq!(pair.state, State::Open);
            }
            let bound = self.friction[i] * x_n.max(0.0) + self.cohesion[i];
            at_most(x_t[0].hypot(x_t[1]) - bound);
            let slip = [z[m + 2 * i], z[m + 2 * i + 1]];
            let length = slip[0].hypot(slip[1]);
            if length > 0.0 {
                at_most((x_t[0] + bound * slip[0] / length).hypot(x_t[1] + bound * slip[1] / length));
            }
            if pair.state == State::Slip {
                assert!(length > 0.0);
                let turned = slip[1].atan2(slip[0]).to_degrees() - pair.direction().expect("it slips");
                assert!(turned.abs() < 1e-9, "{turned}");
            } else if pair.state == State::Stick {
                assert_eq!(length, 0.0);
            }
        }
        worst
    }

    fn random(rng: &mut ChaCha8Rng, m: usize, friction: f64) -> System {
        let k = 3 * m;
        let a = DMatrix::from_fn(k, k + 2, |_, _| rng.random_range(-1.0..1.0));
        let stiffness = &a * a.transpose() + DMatrix::identity(k, k) * 0.05;
        let stiffness: DMatrix<f64> = 0.5 * (&stiffness + stiffness.transpose());
        let load = DVector::from_fn(k, |_, _| rng.random_range(-1.0..1.0));
        System { m, stiffness, load, friction: vec![friction; m], cohesion: vec![0.0; m] }
    }
}

/// Random R, of which an answer always exists: every one is found, and is on the cone or said not to be.
#[test]
fn random_systems_are_answered_on_the_cone() {
    let mut rng = ChaCha8Rng::seed_from_u64(19);
    let (mut on_cone, mut all, mut pivots) = (0, 0, 0.0);
    for round in 0..60 {
        let m = [1, 2, 3, 5][round % 4];
        let facets = [4, 6, 8, 12, 16][round % 5];
        let friction = [0.0, 0.2, 0.5, 1.0, 2.0, 5.0][round % 6];
        let system = System::random(&mut rng, m, friction);
        let answer = system.solve(Rules { facets, ..Rules::default() });
        assert!(answer.is_answer(), "{round}: {:?}", answer.outcome);
        assert!(answer.check.passed);
        let polygon = answer.polygon.expect("in space");
        all += 1;
        pivots += answer.pivot_count as f64 / m as f64;
        if polygon.cone {
            on_cone += 1;
            let worst = system.violation(&answer.pairs);
            assert!(worst < 1e-11, "{round}: {worst}");
        } else {
            assert!(answer.notes.iter().any(|note| note.contains("polygon")), "{:?}", answer.notes);
        }
    }
    assert_eq!(on_cone, all);
    assert!(pivots / f64::from(all) < 6.0, "{pivots}");
}

/// Integers make ties.
#[test]
fn systems_with_ties_are_answered_on_the_cone() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    for round in 0..40 {
        let m = 1 + round % 3;
        let k = 3 * m;
        let a = DMatrix::from_fn(k, k, |_, _| f64::from(rng.random_range(-1..=1)));
        let stiffness = &a * a.transpose() + DMatrix::identity(k, k);
        let load = DVector::from_fn(k, |_, _| f64::from(rng.random_range(-2..=2)));
        let system =
            System { m, stiffness, load, friction: vec![[0.5, 1.0, 2.0][round % 3]; m], cohesion: vec![0.0; m] };
        let answer = system.solve(Rules { facets: [4, 8][round % 2], ..Rules::default() });
        assert!(answer.is_answer(), "{round}: {:?}", answer.outcome);
        assert!(answer.polygon.expect("in space").cone, "{round}: {:?}", answer.notes);
        if system.load.amax() > 0.0 {
            assert!(system.violation(&answer.pairs) < 1e-11, "{round}");
        }
    }
}

/// The dense tableau, also in rationals, makes of the written polygon what the dictionary makes of its half.
#[test]
fn the_engines_agree_on_the_polygon() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for round in 0..12 {
        let m = 1 + round % 2;
        let system = System::random(&mut rng, m, [0.3, 0.8, 1.5][round % 3]);
        let rules = Rules { facets: [4, 6, 8][round % 3], cone: false, ..Rules::default() };
        let own = system.solve(rules);
        assert!(own.is_answer() && own.check.passed && !own.polygon.expect("in space").cone);
        for engine in [Engine::Tableau, Engine::Exact] {
            let other = system.solve(Rules { engine, ..rules });
            assert_eq!(other.outcome, own.outcome);
            assert_eq!(other.pivot_count, own.pivot_count, "{round} {engine}");
            for (a, b) in own.pairs.iter().zip(&other.pairs) {
                let numbers = |pair: &PairState| {
                    let space = pair.space.expect("in space");
                    [pair.x_n, space.x_t[0], space.x_t[1], pair.z_n, space.z_t[0], space.z_t[1]]
                };
                for (a, b) in numbers(a).into_iter().zip(numbers(b)) {
                    assert!((a - b).abs() < 1e-10, "{round} {engine}: {a} {b}");
                }
            }
        }
    }
}

/// A plane problem written in space: forces along t1 only, t2 as stiff and without load or coupling.
#[test]
fn a_plane_problem_in_space_has_the_same_answer() {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    for round in 0..10 {
        let m = 1 + round % 4;
        let a = DMatrix::from_fn(2 * m, 2 * m, |_, _| rng.random_range(-1.0..1.0));
        let plane = &a * a.transpose() + DMatrix::identity(2 * m, 2 * m) * 0.1;
        let plane: DMatrix<f64> = 0.5 * (&plane + plane.transpose());
        let load = DVector::from_fn(2 * m, |_, _| rng.random_range(-1.0..1.0));
        let mut stiffness = DMatrix::identity(3 * m, 3 * m);
        let row = |i: usize| if i < m { i } else { m + 2 * (i - m) };
        let mut lifted = DVector::zeros(3 * m);
        for i in 0..2 * m {
            lifted[row(i)] = load[i];
            for j in 0..2 * m {
                stiffness[(row(i), row(j))] = plane[(i, j)];
            }
        }
        let friction = [0.2, 0.6, 1.2][round % 3];
        let system = System { m, stiffness, load: lifted, friction: vec![friction; m], cohesion: vec![0.0; m] };
        let in_space = system.solve(Rules::default());
        assert!(in_space.is_answer() && system.violation(&in_space.pairs) < 1e-11, "{round}");
        let rows: Vec<Vec<f64>> = plane.row_iter().map(|row| row.iter().copied().collect()).collect();
        let text = json!({
            "format": "stickslip/1", "title": "in the plane",
            "contact_system": {
                "pairs": (0..m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "stiffness": rows,
                "loads": { "all": { "vector": load.as_slice() } }, "friction": vec![friction; m],
            }
        })
        .to_string();
        let scenario = load_text("plane", &text, None).expect("read");
        let prepared = prepare(&scenario, &Quiet).expect("sound");
        let in_plane = prepared.case(&scenario, &scenario.parameter_values()).solve().expect("solved").answer;
        // Small friction: one answer.
        if friction > 0.5 {
            continue;
        }
        for (a, b) in in_space.pairs.iter().zip(&in_plane.pairs) {
            let space = a.space.expect("in space");
            assert!(space.x_t[1].abs() < 1e-12 && space.z_t[1].abs() < 1e-12, "{round}");
            for (a, b) in [(a.x_n, b.x_n), (space.x_t[0], b.x_t), (a.z_n, b.z_n), (space.z_t[0], b.z_t)] {
                assert!((a - b).abs() < 1e-10, "{round}: {a} {b}");
            }
        }
    }
}

/// A node on two springs k = 1 under F = (3, 4) slips against r = 2: u = (F/|F|) (|F| − r) / k = (1.8, 2.4).
#[test]
fn one_node_on_two_springs() {
    let text = r#"{ "format": "stickslip/1", "title": "two springs", "contact_system": {
        "pairs": ["c1"], "tangents": 2, "law": ["bound"], "bound": [2],
        "stiffness": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "loads": { "pull": { "vector": [0, -3, -4] } } } }"#;
    let scenario = load_text("springs", text, None).expect("read");
    let prepared = prepare(&scenario, &Quiet).expect("sound");
    for facets in [4, 6, 8, 10] {
        let rules = Rules { facets, ..Rules::default() };
        let solved = prepared.case(&scenario, &scenario.parameter_values()).under(rules).solve().expect("solved");
        let pair = &solved.answer.pairs[0];
        let space = pair.space.expect("in space");
        for (found, expected) in [(space.z_t, [1.8, 2.4]), (space.x_t, [-1.2, -1.6])] {
            assert!((found[0] - expected[0]).abs() < 1e-14 && (found[1] - expected[1]).abs() < 1e-14, "{found:?}");
        }
        assert!((pair.direction().expect("it slips") - (4f64 / 3.0).atan().to_degrees()).abs() < 1e-12);
        assert_eq!((pair.state, pair.reserve()), (State::Slip, 0.0));
    }
}

/// A rigid block, R = 0, pushed at 17°: it stands below f W and is certified to slide above, at every fineness.
#[test]
fn a_block_slides_at_its_limit_at_every_angle() {
    for (degrees, facets) in [(0.0_f64, 8), (17.0, 8), (17.0, 4), (45.0, 6), (100.0, 16), (24.3, 8), (-131.7, 12)] {
        let (along, across) = (degrees.to_radians().cos(), degrees.to_radians().sin());
        let solve = |factor: f64| {
            let push = 0.3 * factor;
            let mut load = DVector::from_element(12, 1.0);
            for pair in 0..4 {
                (load[4 + 2 * pair], load[5 + 2 * pair]) = (-push * along, -push * across);
            }
            // A rigid block shares the push between its feet as it likes; here alike.
            let system = System {
                m: 4,
                stiffness: DMatrix::zeros(12, 12),
                load,
                friction: vec![0.3; 4],
                cohesion: vec![0.0; 4],
            };
            system.solve(Rules { facets, ..Rules::default() })
        };
        let below = solve(1.0 - 1e-6);
        assert!(below.is_answer() && below.polygon.expect("in space").cone, "{degrees} {facets}: {:?}", below.notes);
        let above = solve(1.0 + 1e-5);
        assert_eq!(above.outcome, OutcomeKind::Ray, "{degrees} {facets}: {:?}", above.polygon);
        let ray = above.ray.expect("a ray");
        assert_eq!(ray.verdict, Some(Verdict::Certified), "{degrees} {facets}: {}", ray.explanation);
    }
}

/// Other coverings are run as chosen and none of them answers wrongly.
#[test]
fn chosen_coverings_never_answer_wrongly() {
    let mut rng = ChaCha8Rng::seed_from_u64(23);
    for round in 0..12 {
        let system = System::random(&mut rng, 2, 0.4 + 0.3 * f64::from(round % 3));
        for covering in [Covering::Ones, Covering::Weight] {
            let answer = system.solve(Rules { covering, ..Rules::default() });
            if answer.is_answer() {
                assert!(system.violation(&answer.pairs) < 1e-11, "{round} {covering}");
            }
        }
    }
}
