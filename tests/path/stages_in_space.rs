//! Load histories in space, on Coulomb's cone: the tractrix, the plane written in space, random contact systems against an
//! independent march in very short steps.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::answer::record::{OutcomeKind, State, Verdict};
use stickslip::path::cycle::{Kind, cycle};
use stickslip::path::stages::{Begin, History, HistoryEnd, StageResult, follow};
use stickslip::path::static_shakedown::Static;

use crate::common::{Case, near, near_all};

fn followed(case: &Case) -> History {
    let values = case.scenario.parameter_values();
    follow(case.prepared.case(&case.scenario, &values).under(case.scenario.rules)).unwrap_or_else(|e| panic!("{e}"))
}

/// The embedded scenario under other stages.
fn bearing(stages: &str) -> Case {
    let text = stickslip::model::embedded::text("bearing-two-way").expect("embedded");
    let end = text.rfind("\"stages\"").unwrap_or_else(|| text.rfind('}').expect("an object"));
    let start = text[..end].trim_end().trim_end_matches(',');
    Case::text(&format!("{start},\n \"stages\": {stages} }}"))
}

fn slip(stage: &StageResult, pair: usize) -> Vec<f64> {
    stage.end.pairs[pair].slip()
}

/// x then y: dragged by the end of a rope of length ℓ = f W/k = 2 that begins at (1, 0), stretched to (3, 0), and whose other
/// end goes to (3, 4), the slider draws a tractrix: u = (3 − ℓ sech τ, 4 − ℓ tanh τ), τ = 4/ℓ, on a way ℓ ln cosh τ. (The
/// spring force beyond what the pull balances is the tension of the rope: k |P − u| = f W, and u moves along P − u.)
#[test]
fn a_slider_pulled_along_x_and_then_along_y_draws_a_tractrix() {
    let history = followed(&bearing(
        r#"[{ "weight": 1 }, { "weight": 1, "pull-x": 1 }, { "weight": 1, "pull-x": 1, "pull-y": 1 }]"#,
    ));
    assert_eq!(history.end, HistoryEnd::Complete);
    let [length, turns] = [2.0, 2.0_f64];
    let expected = [3.0 - length / turns.cosh(), 4.0 - length * turns.tanh()];
    near_all("along x", &slip(&history.stages[1], 0), &[1.0, 0.0], 1e-12);
    near_all("u", &slip(&history.stages[2], 0), &expected, 1e-9);
    // The same by a march of its own: u' = (e·P') e, e = (P − u)/|P − u|, fourth order.
    let rate = |y: f64, u: [f64; 2]| {
        let e = [3.0 - u[0], y - u[1]];
        let along = e[1] / e[0].hypot(e[1]).powi(2);
        [along * e[0], along * e[1]]
    };
    let (mut u, steps) = ([1.0, 0.0], 4000);
    let h = 4.0 / f64::from(steps);
    let go = |u: [f64; 2], k: [f64; 2], by: f64| [u[0] + by * k[0], u[1] + by * k[1]];
    for step in 0..steps {
        let y = h * f64::from(step);
        let a = rate(y, u);
        let b = rate(y + 0.5 * h, go(u, a, 0.5 * h));
        let c = rate(y + 0.5 * h, go(u, b, 0.5 * h));
        let d = rate(y + h, go(u, c, h));
        u = [0, 1].map(|i| u[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    near_all("march", &u, &expected, 1e-10);
    let [first, last] = [&history.stages[1], &history.stages[2]];
    near("lost along x", first.dissipated, 2.0 * 1.0, 1e-9, 2.0);
    near("lost along y", last.dissipated, 2.0 * length * turns.cosh().ln(), 1e-8, 5.0);
    assert!(last.energy.expect("a structure").residual <= 1e-8, "{:?}", last.energy);
    let end = &last.end.pairs[0];
    assert_eq!((end.state, last.end.outcome), (State::Slip, OutcomeKind::Normal));
    near_all("friction", &end.friction(), &[expected[0] - 3.0, expected[1] - 4.0], 1e-9);
    let polygon = last.end.polygon.expect("in space");
    assert!(last.end.check.passed && polygon.cone && polygon.facets == 16, "{:?}", last.end.check);
    assert!(last.estimated_error.expect("curved") <= 1e-8);
}

/// A slider on springs of 1 each way, f = 1/10, is held by the springs' pull of r₀ = 1/10 along y, at its limit; then that pull
/// goes on by r₀ along x while the weight of 1 is taken off, q = 1 − t. It follows c = r₀ (t, 1) at the distance r₀ q; of the
/// angle φ between the two, from 90°, dφ/dt = −sin φ / q makes tan(φ/2) = q, and friction r₀ q takes
///
/// ```text
/// ∫ r₀ q · r₀ (cos φ + 1) dt = 2 r₀² ∫ q / (1 + q²) dq = r₀² ln 2
/// ```
///
/// It opens where the springs rest, at c, whatever way it came: what is lost on the way has to be followed for itself.
#[test]
fn what_is_lost_on_the_way_to_an_opening() {
    let case = Case::json(json!({
        "contact_system": {
            "pairs": ["slider"], "tangents": 2, "friction": [0.1],
            "stiffness": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
            "loads": {
                "weight": { "vector": [1, 0, 0] }, "x": { "vector": [0, -0.1, 0] }, "y": { "vector": [0, 0, -0.1] }
            }
        },
        "stages": [{ "weight": 1, "y": 1 }, { "y": 1, "x": 1 }]
    }));
    let history = followed(&case);
    assert_eq!(history.end, HistoryEnd::Complete);
    near_all("c", &slip(&history.stages[1], 0), &[0.1, 0.1], 1e-9);
    near("lost", history.stages[1].dissipated, 0.01 * 2.0_f64.ln(), 1e-9, 0.01);
}

/// Straight there and back: held until friction has turned round, 2 f W = 4 of the pull of 5, then it follows.
#[test]
fn what_is_unloaded_sticks() {
    let history = followed(&bearing(
        r#"[{ "weight": 1 }, { "weight": 1, "pull-x": 1, "pull-y": 1 }, { "weight": 1, "pull-x": 0.21, "pull-y": 0.21 },
            { "weight": 1 }, { "weight": 1, "pull-x": -1, "pull-y": -1 }]"#,
    ));
    // To (|F| − f W)/k = 3 along (3, 4)/5. Unloaded it is held down to |F| = 1; at F = 0 it stands at f W/k = 2, and at
    // the opposite pull at −3.
    for (stage, (along, state)) in history.stages.iter().zip([
        (0.0, State::Stick),
        (3.0, State::Slip),
        (3.0, State::Stick),
        (2.0, State::Slip),
        (-3.0, State::Slip),
    ]) {
        near_all("u", &slip(stage, 0), &[0.6 * along, 0.8 * along], 1e-9);
        assert_eq!(stage.end.pairs[0].state, state, "{along}");
        assert!(stage.energy.expect("a structure").residual <= 1e-10, "{:?}", stage.energy);
    }
    // The change is reported where it is: at |F| = 1, which is 0.2 of the pulls.
    let turn = history.stages[3].moments.iter().find(|moment| !moment.changes.is_empty()).expect("a change");
    near("where it slips back", turn.factors[1], 3.0 * 0.2, 1e-5, 3.0);
    assert!(turn.sentence.contains("slips"), "{}", turn.sentence);
}

fn positive_definite(rng: &mut ChaCha8Rng, n: usize) -> Vec<Vec<f64>> {
    let a: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| rng.random_range(-1.0..1.0)).collect()).collect();
    let entry = |i: usize, j: usize| (0..n).map(|k| a[i][k] * a[j][k]).sum::<f64>() / n as f64 + f64::from(i == j);
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
}

/// A system of `m` pairs, its stages those of `targets` of the cases p and h.
fn system(
    r: &[Vec<f64>],
    loads: [&[f64]; 2],
    friction: &[f64],
    gap: &[f64],
    targets: &[[f64; 2]],
    space: bool,
) -> Value {
    let m = friction.len();
    let stages: Vec<Value> = targets.iter().map(|[p, h]| json!({ "p": p, "h": h })).collect();
    let mut of = json!({
        "pairs": (1..=m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "stiffness": r, "friction": friction, "gap": gap,
        "loads": { "p": { "vector": loads[0] }, "h": { "vector": loads[1] } } });
    if space {
        of["tangents"] = json!(2);
    }
    json!({ "contact_system": of, "stages": stages })
}

/// Everything grows in proportion from nothing: forces and slips do, and their directions stay. At once is the same.
#[test]
fn one_proportional_loading_is_the_answer_at_once() {
    let mut rng = ChaCha8Rng::seed_from_u64(191);
    for k in 0..12 {
        let m = 1 + k % 5;
        let r = positive_definite(&mut rng, 3 * m);
        let load: Vec<f64> = (0..3 * m)
            .map(|row| if row < m { rng.random_range(-0.2..1.0) } else { rng.random_range(-0.6..0.6) })
            .collect();
        let case = Case::json(system(&r, [&load, &load], &vec![0.4; m], &vec![0.0; m], &[[1.0, 0.0]], true));
        let history = followed(&case);
        let end = &history.stages[0].end;
        let at_once = Case::json(json!({ "contact_system": {
            "pairs": (1..=m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "tangents": 2, "stiffness": r,
            "friction": vec![0.4; m], "loads": { "p": { "vector": load } } } }))
        .solve(&[]);
        for (one, other) in end.pairs.iter().zip(&at_once.pairs) {
            assert_eq!(one.state, other.state, "{k}: {} of {m}", one.id);
            near("x_n", one.x_n, other.x_n, 1e-9, 1.0);
            near("z_n", one.z_n, other.z_n, 1e-9, 1.0);
            near_all("x_t", &one.friction(), &other.friction(), 1e-9);
            near_all("z_t", &one.slip(), &other.slip(), 1e-9);
        }
    }
}

/// A system of the plane with a second tangent that nothing moves: its history is that of the plane, event by event.
#[test]
fn a_history_of_the_plane_written_in_space() {
    let mut rng = ChaCha8Rng::seed_from_u64(192);
    let (mut slips, mut opens) = (0, 0);
    for k in 0..16 {
        let m = 1 + k % 4;
        let r = positive_definite(&mut rng, 2 * m);
        let p: Vec<f64> = (0..2 * m).map(|row| if row < m { rng.random_range(0.5..1.5) } else { 0.0 }).collect();
        let h: Vec<f64> = (0..2 * m).map(|_| rng.random_range(-1.0..1.0)).collect();
        let friction: Vec<f64> = (0..m).map(|_| rng.random_range(0.1..0.7)).collect();
        let gap: Vec<f64> = (0..m).map(|_| if rng.random_range(0..4) == 0 { 0.1 } else { 0.0 }).collect();
        let targets = [[1.0, 0.0], [1.0, 1.2], [1.0, -1.0], [0.6, 0.5]];
        // Row of the plane → row in space: t becomes t1.
        let to = |row: usize| if row < m { row } else { m + 2 * (row - m) };
        let mut wide = vec![vec![0.0; 3 * m]; 3 * m];
        (0..3 * m).for_each(|row| wide[row][row] = 1.0);
        let mut loads = [vec![0.0; 3 * m], vec![0.0; 3 * m]];
        for i in 0..2 * m {
            (0..2 * m).for_each(|j| wide[to(i)][to(j)] = r[i][j]);
            (loads[0][to(i)], loads[1][to(i)]) = (p[i], h[i]);
        }
        let plane = followed(&Case::json(system(&r, [&p, &h], &friction, &gap, &targets, false)));
        let space = followed(&Case::json(system(&wide, [&loads[0], &loads[1]], &friction, &gap, &targets, true)));
        assert_eq!(plane.stages.len(), space.stages.len(), "{k}");
        for (one, other) in plane.stages.iter().zip(&space.stages) {
            for (a, b) in one.end.pairs.iter().zip(&other.end.pairs) {
                let word = match a.state {
                    State::SlipPlus | State::SlipMinus => State::Slip,
                    state => state,
                };
                assert_eq!(word, b.state, "{k}: {}", a.id);
                near("x_n", b.x_n, a.x_n, 1e-8, 1.0);
                near("z_n", b.z_n, a.z_n, 1e-8, 1.0);
                near_all("x_t", &b.friction(), &[a.x_t, 0.0], 1e-8);
                near_all("z_t", &b.slip(), &[a.z_t, 0.0], 1e-8);
                slips += usize::from(word == State::Slip);
                opens += usize::from(word == State::Open);
            }
            near("dissipated", other.dissipated, one.dissipated, 1e-7, 1.0);
            let told = |stage: &StageResult| stage.moments.iter().filter(|moment| !moment.changes.is_empty()).count();
            assert!(told(other) <= told(one) + 1 && told(other) + 1 >= told(one), "{k}: {} {}", told(one), told(other));
        }
    }
    assert!(slips > 40 && opens > 10, "{slips} {opens}");
}

/// The march of an independent judge: in each of many short steps projections pair by pair, until nothing moves.
fn marched(
    r: &[Vec<f64>],
    loads: [&[f64]; 2],
    friction: &[f64],
    gap: &[f64],
    targets: &[[f64; 2]],
    steps: usize,
) -> Vec<f64> {
    let (m, n) = (friction.len(), r.len());
    let mut z: Vec<f64> = (0..n).map(|row| if row < m { gap[row] } else { 0.0 }).collect();
    let mut from = [0.0; 2];
    for target in targets {
        for step in 1..=steps {
            let share = step as f64 / steps as f64;
            let factors = [0, 1].map(|case| from[case] + share * (target[case] - from[case]));
            let committed = z.clone();
            let force = |z: &[f64], row: usize| -> f64 {
                let moved = |j: usize| if j < m { z[j] - gap[j] } else { z[j] };
                (0..n).map(|j| r[row][j] * moved(j)).sum::<f64>()
                    + factors[0] * loads[0][row]
                    + factors[1] * loads[1][row]
            };
            for _ in 0..2000 {
                let mut change = 0.0_f64;
                for i in 0..m {
                    let to = (z[i] - force(&z, i) / r[i][i]).max(0.0);
                    change = change.max((to - z[i]).abs());
                    z[i] = to;
                    let bound = friction[i] * force(&z, i).max(0.0) * f64::from(u8::from(z[i] == 0.0));
                    let joints = [m + 2 * i, m + 2 * i + 1];
                    let stiff = 1.5 * r[joints[0]][joints[0]].max(r[joints[1]][joints[1]]);
                    let a = joints.map(|joint| force(&z, joint) - stiff * (z[joint] - committed[joint]));
                    let size = a[0].hypot(a[1]);
                    for (t, joint) in joints.into_iter().enumerate() {
                        let to = match size > bound {
                            true => committed[joint] - (a[t] - bound * a[t] / size) / stiff,
                            false => committed[joint],
                        };
                        change = change.max((to - z[joint]).abs());
                        z[joint] = to;
                    }
                }
                if change < 1e-14 {
                    break;
                }
            }
        }
        from = *target;
    }
    z
}

#[test]
fn random_systems_end_where_a_march_in_short_steps_does() {
    let mut rng = ChaCha8Rng::seed_from_u64(193);
    let (mut turned, mut slips) = (0.0_f64, 0);
    for k in 0..10 {
        let m = 1 + k % 4;
        let r = positive_definite(&mut rng, 3 * m);
        let p: Vec<f64> = (0..3 * m).map(|row| if row < m { rng.random_range(0.5..1.5) } else { 0.0 }).collect();
        let h: Vec<f64> = (0..3 * m).map(|_| rng.random_range(-1.0..1.0)).collect();
        let friction: Vec<f64> = (0..m).map(|_| rng.random_range(0.1..0.6)).collect();
        let gap: Vec<f64> = (0..m).map(|_| if rng.random_range(0..5) == 0 { 0.1 } else { 0.0 }).collect();
        let targets = [[1.0, 0.0], [0.8, 1.2], [1.2, -0.7]];
        let history = followed(&Case::json(system(&r, [&p, &h], &friction, &gap, &targets, true)));
        assert_eq!(history.end, HistoryEnd::Complete, "{k}");
        // Its error falls with its step: with a quarter of it to a quarter.
        let [coarse, fine] = [400, 1600].map(|steps| marched(&r, [&p, &h], &friction, &gap, &targets, steps));
        let end = &history.stages[2].end;
        assert!(end.check.passed, "{k}: {:?}", end.check);
        for (i, pair) in end.pairs.iter().enumerate() {
            let joints = [i, m + 2 * i, m + 2 * i + 1];
            let expected = joints.map(|joint| fine[joint]);
            let error = joints.map(|joint| (fine[joint] - coarse[joint]).abs()).into_iter().fold(0.0, f64::max);
            turned = turned.max(error);
            let found = [pair.z_n, pair.slip()[0], pair.slip()[1]];
            for (found, expected) in found.into_iter().zip(expected) {
                // Of first order, and not even: events lie somewhere within its steps.
                assert!((found - expected).abs() <= error + 1e-7, "{k}, {}: {found} {expected} {error}", pair.id);
            }
            slips += usize::from(pair.state == State::Slip);
        }
    }
    assert!(turned > 1e-5 && slips > 5, "{turned} {slips}");
}

/// A foot without stiffness, pressed by 2 at f = 0.3, cannot be pushed by more than 0.6 whatever the polygon would allow.
#[test]
fn a_stage_ends_at_the_limit_of_the_cone() {
    let case = Case::json(json!({ "contact_system": {
        "pairs": ["c1"], "tangents": 2, "stiffness": vec![vec![0.0; 3]; 3], "friction": [0.3],
        "loads": { "weight": { "vector": [2, 0, 0] },
                   "push": { "vector": [0, -10f64.to_radians().cos(), -10f64.to_radians().sin()] } } },
        "stages": [{ "weight": 1 }, { "weight": 1, "push": 1 }] }));
    let history = followed(&case);
    let HistoryEnd::Limit { stage: 1, t, collapse } = &history.end else { panic!("{:?}", history.end) };
    near("where", *t, 0.6, 1e-6, 1.0);
    assert_eq!(collapse.verdict, Some(Verdict::Certified), "{collapse:?}");
    assert_eq!(history.stages[1].end.outcome, OutcomeKind::Ray);
}

/// Pulled to and fro between 0 and F against the spring: held on the way back up to 2 f W = 4 less, it comes to rest where
/// F ≤ 4, and slips F − 4 to and fro beyond. With a pull of 4 along y as well the cycles shake it free towards y = 4, the place
/// without friction.
#[test]
fn cycles_in_space_come_to_rest_or_alternate() {
    let case = Case::embedded("bearing-two-way");
    let found = |along_y: f64, to: f64| {
        let mut values = case.scenario.parameter_values();
        values.insert("Fy".to_owned(), along_y);
        let here = case.prepared.case(&case.scenario, &values).under(case.scenario.rules);
        cycle(here, "pull-x", [0.0, to], 64, &Begin::Unloaded).unwrap_or_else(|error| panic!("{error}"))
    };
    let rest = found(0.0, 3.9);
    assert_eq!(rest.kind, Kind::ShakesDown, "{}", rest.sentence);
    let alternates = found(0.0, 6.0);
    assert_eq!(alternates.kind, Kind::Alternates, "{}", alternates.sentence);
    let turn = alternates.turns.last().expect("a cycle");
    near_all("lost", &turn.dissipated, &[4.0, 4.0], 1e-8);
    near_all("slips", &[turn.pairs[0].there, turn.pairs[0].back, turn.pairs[0].net], &[2.0, 2.0, 0.0], 1e-8);
    let both = found(4.0, 6.0);
    assert_eq!(both.kind, Kind::Alternates, "{}", both.sentence);
    let end = both.history.stages.last().expect("stages").end.pairs[0].slip();
    near("along y", end[1], 4.0, 1e-6, 4.0);
    // 0.05 of the bound are left at both ends under a slip to the middle.
    let Static::Proved(reserve) = rest.every_start else { panic!("{:?}", rest.every_start) };
    near("reserve", reserve, 0.05, 1e-4, 2.0);
}

#[test]
fn the_polygon_s_own_history_is_refused() {
    let mut case = bearing(r#"[{ "weight": 1 }]"#);
    case.scenario.rules.cone = false;
    let values = case.scenario.parameter_values();
    let refusal = follow(case.prepared.case(&case.scenario, &values)).unwrap_err().to_string();
    assert!(refusal.contains("set cone on"), "{refusal}");
}

/// Pulled on across its slip the slider begins to move at a rate of 0, along the tractrix: it has not come to rest between.
#[test]
fn a_slip_that_turns_is_no_event() {
    let stages = r#"[{ "weight": 1 }, { "weight": 1, "pull-x": 1 }, { "weight": 1, "pull-x": 1, "pull-y": 1 }, { "weight": 1 }]"#;
    let history = followed(&bearing(stages));
    let told = |stage: usize| -> Vec<&str> {
        let moments = history.stages[stage].moments.iter().filter(|moment| !moment.changes.is_empty());
        moments.map(|moment| moment.sentence.as_str()).collect()
    };
    assert_eq!(told(1), ["pair slider slips towards 0°"]);
    assert!(told(2).is_empty(), "{:?}", told(2));
    assert_eq!(told(3).len(), 2, "{:?}", told(3));
    assert_eq!(told(3)[0], "pair slider sticks");
}
