//! Paths in space over loads and friction, followed on Coulomb's cone.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::answer::record::{State, Verdict};
use stickslip::path::end::PathEnd;
use stickslip::path::load::{LoadReach, trace};
use stickslip::path::on_cone::{ConePath, trace_friction, trace_load};

use crate::common::lines::{embedded, report};
use crate::common::{Case, near, near_all};

const UP: LoadReach = LoadReach { to: None, through: false };

fn to(value: f64) -> LoadReach {
    LoadReach { to: Some(value), ..UP }
}

fn load(case: &Case, name: &str, reach: LoadReach) -> ConePath {
    let values = case.scenario.parameter_values();
    let here = case.prepared.case(&case.scenario, &values);
    let solved = here.solve().expect("solved");
    trace_load(here, Some(&solved), name, reach).unwrap_or_else(|error| panic!("{error}"))
}

/// u = F (1 − f W/|F|)/k, wherever |F| > f W = 2.
#[test]
fn a_slider_on_two_springs_over_a_pull_and_over_friction() {
    let case = Case::embedded("bearing-two-way");
    let path = load(&case, "Fx", to(-6.0));
    assert_eq!((path.end.clone(), path.breakpoints.len(), path.last()), (PathEnd::Target, 0, -6.0));
    assert!(path.places.len() > 40);
    for place in &path.places {
        let [x, y] = [place.value, 4.0];
        let share = 1.0 - 2.0 / f64::hypot(x, y);
        near_all("u", &place.pairs[0].slip(), &[share * x, share * y], 1e-10);
    }
    // At rest from f W = 5 on.
    let values = case.scenario.parameter_values();
    let here = case.prepared.case(&case.scenario, &values);
    let solved = here.solve().expect("solved");
    let path = trace_friction(here, Some(&solved), "f", 0.5).expect("a path");
    let [stop] = &path.breakpoints[..] else { panic!("{:?}", path.breakpoints) };
    near("f", stop.value, 0.25, 1e-11, 0.25);
    assert_eq!(stop.sentence, "pair slider sticks");
    // what comes to rest has no slip left at the breakpoint, to the last digit
    assert_eq!((path.places[stop.place].pairs[0].z_t, path.places[stop.place].pairs[0].slip()), (0.0, vec![0.0; 2]));
    for place in &path.places {
        let moved = (5.0 - 20.0 * place.value).max(0.0);
        for (found, share) in place.pairs[0].slip().into_iter().zip([0.6, 0.8]) {
            near("u", found, share * moved, 1e-10, 5.0);
        }
    }
}

/// Unloaded, the slider holds up to f W = 2, and begins to slip towards the pull.
#[test]
fn a_slip_begins_towards_its_load() {
    let mut session = embedded("bearing-two-way");
    for line in ["set Fx 0.3", "set Fy 0"] {
        report(&mut session, line).expect(line);
    }
    let told = report(&mut session, "trace pull-x to 5 of ux deck").expect("a path");
    let place = &told["breakpoints"][0];
    near("where", place["factor"].as_f64().expect("a factor"), 2.0, 1e-11, 2.0);
    assert_eq!(place["sentence"], "pair slider slips towards 0°");
    let along = &told["along"]["quantities"][0]["values"];
    let last = along.as_array().and_then(|values| values.last()?.as_f64()).expect("a value");
    near("ux", last, 3.0, 1e-10, 3.0);
    for (line, expected) in [("trace pull-x --through", "in the plane only"), ("set cone off", "")] {
        let refused = report(&mut session, line).err().unwrap_or_default();
        assert!(refused.contains(expected), "{line}: {refused}");
    }
    let refused = report(&mut session, "trace pull-x").expect_err("without the cone");
    assert!(refused.contains("set cone on"), "{refused}");
}

/// A foot without stiffness, pressed by 2 at f = 0.3 and pushed at 25°: nothing slips up to 0.6, and nothing stands beyond.
#[test]
fn a_path_ends_at_the_limit_of_the_cone() {
    let push = [-25f64.to_radians().cos(), -25f64.to_radians().sin()];
    let case = Case::json(json!({ "contact_system": {
        "pairs": ["c1"], "tangents": 2, "stiffness": vec![vec![0.0; 3]; 3], "friction": [0.3],
        "loads": { "weight": { "vector": [2, 0, 0] }, "push": { "factor": 0.1, "vector": [0, push[0], push[1]] } } } }));
    for reach in [UP, to(1.0)] {
        let path = load(&case, "push", reach);
        let PathEnd::Collapse(collapse) = &path.end else { panic!("{:?}", path.end) };
        assert_eq!(collapse.verdict, Some(Verdict::Certified));
        near("limit", path.limit().expect("a limit"), 0.6, 1e-7, 0.6);
        assert!(path.places.iter().all(|place| place.pairs[0].state == State::Stick));
    }
}

/// Systems of the plane with a second tangent that nothing moves: the breakpoints are those of the exact path.
#[test]
fn a_path_of_the_plane_written_in_space() {
    let mut rng = ChaCha8Rng::seed_from_u64(194);
    let mut seen = 0;
    for k in 0..12 {
        let m = 1 + k % 4;
        let n = 2 * m;
        let a: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| rng.random_range(-1.0..1.0)).collect()).collect();
        let r = |i: usize, j: usize| (0..n).map(|k| a[i][k] * a[j][k]).sum::<f64>() / n as f64 + f64::from(i == j);
        let p: Vec<f64> = (0..n).map(|row| if row < m { rng.random_range(0.5..1.5) } else { 0.0 }).collect();
        let h: Vec<f64> = (0..n).map(|_| rng.random_range(-1.0..1.0)).collect();
        let to_space = |row: usize| if row < m { row } else { m + 2 * (row - m) };
        let case = |space: bool| {
            let count = if space { 3 * m } else { n };
            let place = |row: usize| if space { to_space(row) } else { row };
            let mut matrix = vec![vec![0.0; count]; count];
            (0..count).for_each(|row| matrix[row][row] = 1.0);
            let mut loads = vec![vec![0.0; count]; 2];
            for i in 0..n {
                (0..n).for_each(|j| matrix[place(i)][place(j)] = r(i, j));
                (loads[0][place(i)], loads[1][place(i)]) = (p[i], h[i]);
            }
            let mut of = json!({
                "pairs": (1..=m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "stiffness": matrix,
                "friction": vec![0.3; m],
                "loads": { "p": { "vector": loads[0] }, "h": { "factor": 0.01, "vector": loads[1] } } });
            if space {
                of["tangents"] = Value::from(2);
            }
            Case::json(json!({ "contact_system": of }))
        };
        let plane = case(false);
        let values = plane.scenario.parameter_values();
        let here = plane.prepared.case(&plane.scenario, &values);
        let exact = trace(here, Some(&here.solve().expect("solved")), "h", to(3.0)).expect("a path");
        let path = load(&case(true), "h", to(3.0));
        let values = |all: &[stickslip::path::change::Breakpoint]| all.iter().map(|at| at.value).collect::<Vec<_>>();
        near_all(&format!("{k}"), &values(&path.breakpoints), &values(&exact.breakpoints), 1e-9);
        seen += path.breakpoints.len();
    }
    assert!(seen > 20, "{seen}");
}
