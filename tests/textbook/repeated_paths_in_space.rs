//! Paths in space over joints that repeat one another: breakpoints and the places between them.

use stickslip::answer::record::{State, Verdict};
use stickslip::path::end::PathEnd;
use stickslip::path::load::LoadReach;
use stickslip::path::on_cone::{ConePath, trace_friction, trace_load};

use super::guides::{CLEARANCES, EA, EI, L, with_clearances};
use super::repeated_in_space::{SIDES, guided, row, turned};
use crate::common::*;

/// A breakpoint is located to 1e-12 of its load, and what the answers beside it differ by is known to as much of the loads.
const LOCATED: f64 = 1e-11;

/// So near to a limit slips grow like 1/√ of what is left of the load, and their rounding hides it.
const LIMIT: f64 = 1e-6;

/// Follows the parameter `name`, from where the parameters are these to a value.
fn path(case: &Case, set: &[(&str, f64)], name: &str, to: f64) -> ConePath {
    let solved = case.solved(set, case.scenario.rules);
    let mut values = case.scenario.parameter_values();
    for (name, value) in set {
        values.insert((*name).to_owned(), *value).expect("a parameter");
    }
    let here = case.prepared.case(&case.scenario, &values);
    let reach = LoadReach { to: Some(to), through: false };
    let found = match name {
        "f" => trace_friction(here, Some(&solved), name, to),
        _ => trace_load(here, Some(&solved), name, reach),
    };
    found.unwrap_or_else(|error| panic!("{error}"))
}

fn breakpoints(path: &ConePath) -> Vec<(f64, &str)> {
    path.breakpoints.iter().map(|at| (at.value, at.sentence.as_str())).collect()
}

/// A tip pulled by T = 1/5 between guides with clearances, pushed from one to the other: it sticks while f (|P| − k g)
/// ≥ T, slips along, is free between them. In between every place is that of [`with_clearances`].
#[test]
fn a_push_from_one_guide_to_the_other() {
    let (k, f, t) = (3.0 * EI / L.powi(3), 0.3, 0.2);
    let [low, up] = CLEARANCES;
    for rotation in turned() {
        let case = guided(&rotation, &SIDES);
        let path = path(&case, &[("T", t)], "P", -1.5);
        assert_eq!(path.end, PathEnd::Target);
        let found = breakpoints(&path);
        let [(slips, _), (opens, opened), (closes, _), (sticks, stuck)] = found[..] else { panic!("{found:?}") };
        near_all("P", &[slips, opens, closes, sticks], &[k * low + t / f, k * low, -k * up, -k * up - t / f], LOCATED);
        assert_eq!((opened, stuck), ("pair low opens", "pair up sticks"));
        for place in &path.places {
            let right = with_clearances(place.value, t, CLEARANCES, f);
            let [low, up] = &place.pairs[..] else { panic!() };
            let what = format!("P = {}", place.value);
            near(&what, low.x_n, right.x[0], LOCATED, 1.0);
            near(&what, up.x_n, right.x[1], LOCATED, 1.0);
            near(&what, low.slip()[0], right.slip, LOCATED, t * L / EA);
            near(&what, low.friction()[0] + up.friction()[0], right.friction, LOCATED, 1.0);
        }
    }
}

/// The tip under P = 1 and T = 1/5 over friction: it sticks from f = T/(P − k g₁) on.
#[test]
fn friction_of_a_guide() {
    let k = 3.0 * EI / L.powi(3);
    let case = guided(&turned()[1], &SIDES);
    let path = path(&case, &[("T", 0.2), ("f", 0.05)], "f", 0.5);
    let found = breakpoints(&path);
    let [(value, sentence)] = found[..] else { panic!("{found:?}") };
    near("f", value, 0.2 / (1.0 - k * CLEARANCES[0]), LOCATED, 1.0);
    assert_eq!(sentence, "pair low sticks");
}

/// A shoe under N beside a guide that P presses it against, pulled by T: with the tip aside by g₁ and along by u
///
/// ```text
///     T = k_a u + s N u/√(u² + g₁²) + f x,     x = P − k g₁ − s N g₁/√(u² + g₁²)   (the guide's force)
/// ```
#[test]
fn a_shoe_pulled_along_a_guide() {
    let (k, k_a) = (3.0 * EI / L.powi(3), EA / L);
    let (f, s, n, p, g1) = (0.2, 0.4, 1.5, 2.0, 0.01);
    let [low, up] = SIDES;
    let set = [("f", f), ("s", s), ("N", n), ("P", p), ("T", 0.4)];
    for rotation in turned() {
        let case = guided(&rotation, &[("shoe", [0.0, 0.0, 1.0], "s", "zero"), low, up]);
        let path = path(&case, &set, "T", 1.5);
        assert_eq!((path.end.clone(), breakpoints(&path).len()), (PathEnd::Target, 0));
        assert!(path.places.len() > 40);
        for place in &path.places {
            let [shoe, low, up] = &place.pairs[..] else { panic!() };
            assert_eq!((low.state, up.state), (State::Slip, State::Open));
            let u = low.slip()[0];
            let guide = p - k * g1 - s * n * g1 / u.hypot(g1);
            near("guide", low.x_n, guide, LOCATED, p);
            near("T", place.value, k_a * u + s * n * u / u.hypot(g1) + f * guide, LOCATED, 1.0);
            near("along", shoe.slip()[0], u, LOCATED, 0.01);
        }
    }
}

/// Two blocks in a row, whose corners share their joints: a push meets the friction of all floors, and ends at f W.
#[test]
fn a_row_of_blocks_is_pushed_to_its_limit() {
    let path = path(&row(2), &[("H", 0.5)], "H", 1.5);
    let PathEnd::Collapse(collapse) = &path.end else { panic!("{:?}", path.end) };
    assert_eq!(collapse.verdict, Some(Verdict::Certified));
    near("limit", path.last(), 1.0, LIMIT, 1.0);
    for place in &path.places {
        let known = if 1.0 - place.value > LIMIT { LOCATED } else { LIMIT };
        let floor = || place.pairs.iter().filter(|pair| pair.id.starts_with("floor"));
        near("weight", floor().map(|pair| pair.x_n).sum(), 2.0, known, 2.0);
        near("push", floor().map(|pair| pair.friction()[0]).sum(), -place.value, known, 1.0);
    }
}
