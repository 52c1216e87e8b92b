//! Paths in space over loads and friction, followed on Coulomb's cone.

use std::mem::discriminant;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::answer::record::{State, Verdict};
use stickslip::path::change::Breakpoint;
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
    report(&mut session, "set cone off").expect("a choice");
    let refused = report(&mut session, "trace pull-x").expect_err("without the cone");
    assert!(refused.contains("set cone on"), "{refused}");
}

/// A foot without stiffness, pressed by 2 at f = 0.3 and pushed at 25°: nothing slips up to 0.6, and nothing stands
/// beyond.
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

/// A block of weight 2 at f = 1/2, free along the ground, is pushed by Y across and X along: it stands up to X² + Y² =
/// 1, also where the push grows almost along the circle, and never slips on the way.
#[test]
fn a_limit_has_no_scheme_of_its_own() {
    let across = (0..12).map(|k| f64::from(k) / 12.0).chain((2..13).map(|k| 1.0 - 10f64.powi(-k)));
    for y in across {
        for normal in [0.0, 1.0] {
            let stiffness = [[normal, 0.0, 0.0], [0.0; 3], [0.0; 3]];
            let case = Case::json(json!({ "contact_system": {
                "pairs": ["c1"], "tangents": 2, "stiffness": stiffness, "friction": [0.5],
                "loads": { "weight": { "vector": [2, 0, 0] }, "across": { "vector": [0, 0, y] },
                           "along": { "factor": 0.0, "vector": [0, 1, 0] } } } }));
            let path = load(&case, "along", to(1.4));
            assert!(matches!(path.end, PathEnd::Collapse(_)), "{y}: {:?}", path.end);
            assert!(path.breakpoints.is_empty(), "{y}: {:?}", path.breakpoints);
            assert!(path.places.iter().all(|place| place.pairs[0].state == State::Stick));
            // what is left of the bound is known to the digits of a law, 4 · 256 ε
            near("limit", path.last().powi(2) + y * y, 1.0, 4e-12, 1.0);
        }
    }
}

/// The block, pushed along by P, slides at f W = 1 until it meets a spring a way g off: z_w = g − z_τ, then x_w = P − 1
/// = k (z_τ − g).
#[test]
fn a_block_slides_to_a_stop() {
    let (k, g) = (4.0, 0.5);
    let mut stiffness = vec![vec![0.0; 6]; 6];
    for (row, column) in [(1, 1), (1, 2), (2, 1), (2, 2)] {
        stiffness[row][column] = k;
    }
    let case = Case::json(json!({ "contact_system": {
        "pairs": ["floor", "wall"], "tangents": 2, "stiffness": stiffness, "friction": [0.5, 0.0], "gap": [0.0, g],
        "loads": { "weight": { "vector": [2, 0, 0, 0, 0, 0] },
                   "push": { "factor": 0.0, "vector": [0, 0, -1, 0, 0, 0] } } } }));
    let path = load(&case, "push", to(3.0));
    assert_eq!((path.end.clone(), path.last()), (PathEnd::Target, 3.0));
    let [stops] = &path.breakpoints[..] else { panic!("{:?}", path.breakpoints) };
    assert!(stops.jump);
    // a jump is looked for 1e-7 of the range beyond
    near("where", stops.value, 1.0, 4e-7, 1.0);
    for place in &path.places {
        let [floor, wall] = &place.pairs[..] else { panic!() };
        let pressed = (place.value - 1.0).max(0.0);
        let slip = if floor.state == State::Stick { 0.0 } else { g + pressed / k };
        near("slip", floor.slip()[0], slip, 1e-9, 1.0);
        near("wall", wall.x_n, pressed, 1e-9, 1.0);
    }
}

/// One pair of friction 1 under the normal load N and the pull `push` per unit of its factor.
fn one_pair(stiffness: [[f64; 3]; 3], normal: f64, push: [f64; 3]) -> Case {
    Case::json(json!({ "contact_system": {
        "pairs": ["c1"], "tangents": 2, "stiffness": stiffness, "friction": [1.0],
        "loads": { "press": { "factor": normal, "vector": [1, 0, 0] }, "push": { "factor": 0.1, "vector": push } } } }))
}

/// A slip σ along d takes away from the normal force: λ_n = N + R_nn z_n − ρ σ, λ_τ = σ − α − ρ z_n along d, with ρ f >
/// k = 1. It sticks up to α = N; slipping α = N − (ρ − 1) σ falls until λ_n = 0 at α = N/ρ; open z_n = (ρ α − N)/(R_nn
/// − ρ²).
#[test]
fn a_path_goes_through_corners_at_which_the_load_turns_back() {
    let (n, rho, normal) = (3.0, 2.0, 10.0);
    for degrees in [0.0_f64, 25.0, 160.0, -72.0] {
        let d = [degrees.to_radians().cos(), degrees.to_radians().sin()];
        let [a, b] = d.map(|part| -rho * part);
        let stiffness = [[normal, a, b], [a, 1.0, 0.0], [b, 0.0, 1.0]];
        let case = one_pair(stiffness, n, [0.0, -d[0], -d[1]]);
        let path = load(&case, "push", LoadReach { through: true, ..to(5.0) });
        assert_eq!((path.end.clone(), path.last()), (PathEnd::Target, 5.0));
        let [slips, opens] = &path.breakpoints[..] else { panic!("{:?}", path.breakpoints) };
        near("slips", slips.value, n, 1e-8, n);
        near("opens", opens.value, n / rho, 1e-8, n);
        assert!(
            slips.sentence.starts_with("pair c1 slips towards ") && slips.sentence.ends_with("; the load turns back")
        );
        assert_eq!(opens.sentence, "pair c1 opens; the load turns back");
        for place in &path.places {
            let (pair, alpha) = (&place.pairs[0], place.value);
            let (slip, opening) = match pair.state {
                State::Stick => (0.0, 0.0),
                State::Slip => ((n - alpha) / (rho - 1.0), 0.0),
                _ => {
                    let opening = (rho * alpha - n) / (normal - rho * rho);
                    (alpha + rho * opening, opening)
                }
            };
            near_all("slip", &pair.slip(), &[slip * d[0], slip * d[1]], 1e-7);
            near("opening", pair.z_n, opening, 1e-7, 1.0);
        }
        // Without it the path jumps to where it is open.
        let path = load(&case, "push", to(5.0));
        let [jump] = &path.breakpoints[..] else { panic!("{:?}", path.breakpoints) };
        assert!(jump.jump && jump.sentence == "pair c1 opens", "{jump:?}");
    }
}

/// A pair with tangential stiffnesses k_i under pulls t_i whose slips change its normal force by r_i. With β = b/|z_τ|,
/// b = λ_n the bound:
///
/// ```text
///     z_i = t_i/(k_i + β),     λ_n = N + Σ r_i z_i = β |z_τ|,     so that N is a function of β, from ∞ where it sticks
/// to 0
/// ```
/// with turning points within the slip, where no pair changes its state.
#[test]
fn a_path_goes_through_smooth_turning_points() {
    // Turns of N on the way: one at a corner, where the slip begins, or both within the slip.
    for (k, t, r) in [
        ([1.0, 10.0], [2.0, 3.0], [6.0, -19.0]),
        ([1.0, 20.0], [3.0, 4.0], [1.0, -17.0]),
        ([1.0, 20.0], [2.0, -4.0], [0.0, 18.0]),
    ] {
        let z = |beta: f64| [0, 1].map(|i| t[i] / (k[i] + beta));
        let normal = |beta: f64| {
            let [a, b] = z(beta);
            beta * a.hypot(b) - r[0] * a - r[1] * b
        };
        // Places where N turns, from a fine grid and golden sections around each.
        let grid: Vec<f64> = (0..40_000).map(|i| 10f64.powf(6.0 - f64::from(i) * 10.0 / 40_000.0)).collect();
        let mut turns = Vec::new();
        for three in grid.windows(3) {
            let [a, b, c] = [three[0], three[1], three[2]].map(normal);
            if (b - a) * (c - b) < 0.0 {
                let sign = (b - a).signum();
                let (mut low, mut high) = (three[2], three[0]);
                for _ in 0..100 {
                    let [left, right] = [low + 0.382 * (high - low), high - 0.382 * (high - low)];
                    if sign * normal(left) < sign * normal(right) { low = left } else { high = right }
                }
                turns.push(normal(0.5 * (low + high)));
            }
        }
        let case = one_pair(
            [[100.0, r[0], r[1]], [r[0], k[0], 0.0], [r[1], 0.0, k[1]]],
            8.0,
            [0.0, -10.0 * t[0], -10.0 * t[1]],
        );
        let path = load(&case, "press", LoadReach { through: true, ..to(-7.0) });
        assert_eq!(path.end, PathEnd::Target, "{:?}", path.breakpoints);
        let mut expected = vec![f64::hypot(t[0], t[1])];
        expected.extend(&turns);
        expected.push(normal(0.0));
        let found: Vec<f64> = path.breakpoints.iter().map(|at| at.value).collect();
        near_all("breakpoints", &found, &expected, 1e-7);
        assert_eq!(path.breakpoints.iter().filter(|at| at.sentence.contains("turns back")).count(), 2, "{found:?}");
        assert!(path.breakpoints.iter().all(|at| !at.jump));
        let mut slipping = 0;
        for place in path.places.iter().filter(|place| place.pairs[0].state == State::Slip) {
            let pair = &place.pairs[0];
            let beta = pair.bound / pair.z_t;
            near("N", place.value, normal(beta), 1e-9, 8.0);
            // A slip that has just begun is known to the digits of the place.
            for ((slip, expected), whole) in pair.slip().into_iter().zip(z(beta)).zip(z(0.0)) {
                near("slip", slip, expected, 1e-9, whole);
            }
            slipping += 1;
        }
        assert!(slipping > 20, "{slipping}");
    }
}

/// Systems of the plane with a second tangent that nothing moves: breakpoints and ends are those of the exact path, also
/// where strong friction turns it back.
#[test]
fn a_path_of_the_plane_written_in_space() {
    let [mut seen, mut turned] = [0; 2];
    for (friction, own, through, count, seed) in
        [(0.3, 1.0, false, 12, 194), (2.0, 0.1, true, 24, 195), (4.0, 0.1, true, 24, 195)]
    {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        for k in 0..count {
            let [plane, space] = plane_and_space(&mut rng, 1 + k % 4, [own, friction]);
            let values = plane.scenario.parameter_values();
            let here = plane.prepared.case(&plane.scenario, &values);
            let reach = LoadReach { through, ..to(3.0) };
            let exact = trace(here, Some(&here.solve().expect("solved")), "h", reach).expect("a path");
            let path = load(&space, "h", reach);
            let values = |all: &[Breakpoint]| all.iter().map(|at| at.value).collect::<Vec<_>>();
            near_all(&format!("{k}"), &values(&path.breakpoints), &values(&exact.breakpoints), 1e-9);
            assert_eq!(discriminant(&path.end), discriminant(&exact.end), "{k}");
            seen += path.breakpoints.len();
            turned += path.breakpoints.iter().filter(|at| at.sentence.contains("turns back")).count();
        }
    }
    assert!(seen > 20 && turned > 10, "{seen} {turned}");
}

/// A random system of m pairs in the plane, and the same in space.
fn plane_and_space(rng: &mut ChaCha8Rng, m: usize, [own, friction]: [f64; 2]) -> [Case; 2] {
    let n = 2 * m;
    let a: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| rng.random_range(-1.0..1.0)).collect()).collect();
    let r = |i: usize, j: usize| (0..n).map(|k| a[i][k] * a[j][k]).sum::<f64>() / n as f64 + own * f64::from(i == j);
    let p: Vec<f64> = (0..n).map(|row| if row < m { rng.random_range(0.5..1.5) } else { 0.0 }).collect();
    let h: Vec<f64> = (0..n).map(|_| rng.random_range(-1.0..1.0)).collect();
    [false, true].map(|space| {
        let count = if space { 3 * m } else { n };
        let place = |row: usize| if space && row >= m { m + 2 * (row - m) } else { row };
        let mut matrix = vec![vec![0.0; count]; count];
        (0..count).for_each(|row| matrix[row][row] = 1.0);
        let mut loads = vec![vec![0.0; count]; 2];
        for i in 0..n {
            (0..n).for_each(|j| matrix[place(i)][place(j)] = r(i, j));
            (loads[0][place(i)], loads[1][place(i)]) = (p[i], h[i]);
        }
        let mut of = json!({
            "pairs": (1..=m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "stiffness": matrix,
            "friction": vec![friction; m],
            "loads": { "p": { "vector": loads[0] }, "h": { "factor": 0.01, "vector": loads[1] } } });
        if space {
            of["tangents"] = Value::from(2);
        }
        Case::json(json!({ "contact_system": of }))
    })
}

/// A rigid body on four feet of one friction, pushed and turned: a path knows one self-stress of its feet and ends before the
/// answers do. What it names beyond its end is an answer: forces on the cone that balance weight, push and moment, at rest.
#[test]
fn a_path_that_ends_with_answers_beyond_says_so() {
    let (friction, feet) = (0.25, [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]);
    let mut nodes = json!({ "G": [1.6, 1.2, 1.0], "H": [3.5, 2.9, 0.5] });
    let mut contacts = Vec::new();
    for (i, [x, y]) in feet.iter().enumerate() {
        nodes[format!("f{i}")] = json!([x, y, 0.0]);
        contacts
            .push(json!({ "id": format!("c{i}"), "node": format!("f{i}"), "against": "ground", "normal": [0, 0, 1],
            "friction": friction }));
    }
    let case = Case::json(json!({
        "dimension": 3, "parameters": { "P": 2.7 }, "nodes": nodes, "contacts": contacts,
        "rigid": [{ "id": "b", "nodes": ["f0", "f1", "f2", "f3", "G", "H"], "about": "G" }],
        "loads": {
            "w": { "items": [{ "point": { "at": "G", "force": [0, 0, -12] } }] },
            "push": { "factor": "P", "items": [{ "point": { "at": "H", "force": [1, 0.5, -0.2], "moment": [0, 0, 0.4] } }] }
        }
    }));
    let path = load(&case, "push", UP);
    let beyond = path.end.answer_beyond().unwrap_or_else(|| panic!("{:?}", path.end));
    assert!(path.limit().is_none() && path.end_sentence().contains("not the largest load that can be carried"));
    assert!(beyond > path.last() && beyond < path.last() * (1.0 + 1e-6), "{beyond}");
    for push in [beyond, 2.78] {
        let answer = case.solve(&[("P", push)]);
        assert!(answer.is_answer() && answer.polygon.is_some_and(|polygon| polygon.cone), "{answer:?}");
        // Forces along x, y, z and moments about the axes through f0.
        let mut left = [push, 0.5 * push, -12.0 - 0.2 * push, 0.0, 0.0, 0.4 * push];
        left[3] += -12.0 * 1.2 + push * (2.9 * -0.2 - 0.5 * 0.5);
        left[4] += 12.0 * 1.6 + push * (0.5 + 3.5 * 0.2);
        left[5] += push * (3.5 * 0.5 - 2.9);
        for (pair, [x, y]) in answer.pairs.iter().zip(feet) {
            let (along, n) = (pair.friction(), pair.x_n);
            let [f_x, f_y] = [along[0], along[1]];
            for (sum, part) in left.iter_mut().zip([f_x, f_y, n, y * n, -x * n, x * f_y - y * f_x]) {
                *sum += part;
            }
            assert!(n >= 0.0 && f_x.hypot(f_y) <= friction * n * (1.0 + 1e-12) && pair.slip() == [0.0; 2], "{pair:?}");
        }
        left.iter().for_each(|sum| near("in balance", *sum, 0.0, 1e-10, 12.0));
    }
}
