//! Loads that go to and fro in space: starts with slips, and the largest amplitude that shakes down.

use serde_json::{Value, json};
use stickslip::path::static_shakedown::{Static, static_limit};
use stickslip::session::Session;

use super::find::{near, number};
use crate::common::lines::{embedded, read, report};
use crate::common::{Case, near as is_near, scenario_text};

/// The slider of weight 20 with f = 0.1 on springs of 1 each way, pulled by `fy` along y.
fn bearing(fy: f64) -> Session {
    let mut session = embedded("bearing-two-way");
    report(&mut session, &format!("set Fy {fy}")).expect("set");
    session
}

fn parts(found: &Value) -> [f64; 2] {
    [number(&found[0]), number(&found[1])]
}

/// From (0, 4), where the springs are at rest under Fy = 4, it moves along x only: the pull goes to 6 and leaves it at 4, back
/// at 2. It loses 2 · 2 each way from then on.
#[test]
fn a_cycle_begins_with_given_slips() {
    let mut session = bearing(4.0);
    for (line, start) in [
        ("cycle pull-x 0..6 from slider=0,4", [0.0, 4.0]),
        ("cycle pull-x 0..6 from (0.5, 4)", [0.5, 4.0]),
        // Too far to stand: it slips back straight towards where the springs are at rest, up to f W / k = 2 from there.
        ("cycle pull-x 0..6 from slider=3,4", [2.0, 4.0]),
        ("cycle pull-x 0..6 from *=(1.8, 6.4)", [1.2, 5.6]),
    ] {
        let found = report(&mut session, line).expect(line);
        for (found, expected) in parts(&found["start"][0]["z_t"]).into_iter().zip(start) {
            is_near(line, found, expected, 1e-9, 4.0);
        }
        assert_eq!(found["kind"], "alternates", "{line}");
        let last = found["cycles"].as_array().and_then(|cycles| cycles.last()).expect("cycles").clone();
        for way in 0..2 {
            near(&last["dissipated"][way], 4.0, 1e-6);
        }
    }
    for (line, part) in [
        ("cycle pull-x 0..6 from slider=1", "how far has slider slipped along t1 and along t2"),
        ("cycle pull-x 0..6 from 1", "expected 2 slips behind `from`, two for each pair"),
        ("cycle pull-x 0..6 from slider=1,2,3", "`3` is not a slip"),
    ] {
        let refusal = report(&mut session, line).expect_err(line);
        assert!(refusal.contains(part), "{line}: {refusal}");
    }
}

/// Whatever slips it begins with, it slips to and fro by 2 in the end.
#[test]
fn all_starts_come_to_the_same_cycle() {
    let mut session = bearing(0.0);
    let found = report(&mut session, "cycle pull-x 0..6 from all").expect("followed");
    assert_eq!(found["decides"], false, "{found}");
    let starts = found["starts"].as_array().expect("starts");
    let names: Vec<&str> = starts.iter().filter_map(|start| start["start"].as_str()).collect();
    assert_eq!(
        names,
        ["no slips", "most slider along t1", "least slider along t1", "most slider along t2", "least slider along t2"]
    );
    starts.iter().for_each(|start| near(&start["dissipated"], 8.0, 1e-5));
    // The farthest it may stand from where the springs are at rest is 2, inside a polygon of 16 facets.
    for start in &starts[1..] {
        let far = parts(&start["slips"][0]["z_t"]);
        let far = far[0].hypot(far[1]);
        assert!(far <= 2.0 + 1e-9 && far >= 2.0 * (std::f64::consts::PI / 16.0).cos() - 1e-9, "{far}");
    }
}

/// It stands under both ends of the pull where it stands within 2 of both: up to 4 between them, from every start, whatever
/// pulls across.
#[test]
fn the_largest_amplitude_that_shakes_down() {
    let found = report(&mut bearing(0.0), "limit cycle pull-x 0..3").expect("a bracket");
    let (below, above) = (number(&found["shakes_down"]), number(&found["beyond"]));
    assert!((4.0 - 1e-6..=4.0).contains(&below) && (4.0..4.0 + 1e-4).contains(&above), "{found}");
    assert_eq!(found["kind_beyond"], "alternates");
    near(&found["from_every_start"], 4.0, 1e-6);
    let case = Case::embedded("bearing-two-way");
    let values = case.scenario.parameter_values();
    let (limit, proof) =
        static_limit(case.prepared.case(&case.scenario, &values), "pull-x", [0.0, 6.0]).expect("asked");
    let limit = limit.expect("proved");
    assert!(limit <= 4.0 && limit > 4.0 - 1e-3, "{limit}");
    assert!(matches!(proof, Static::Proved(reserve) if reserve > 0.0));
}

/// A slider of weight 1 on a spring of 1 each way, f = 0.1, is pushed by ±0.3: it slips to and fro by 2 · 0.3 − 2 · 0.1 and
/// loses 0.1 of that each way. What stands beside it, a pair that a force of 1e6 keeps open by 1, decides nothing of that:
/// neither its forces nor the way they would move the slider.
#[test]
fn what_is_open_beside_a_slider_does_not_hide_its_loss() {
    for tangents in [1, 2] {
        let rows = 2 * (1 + tangents);
        let row = |entries: &[(usize, f64)]| {
            let mut row = vec![0.0; rows];
            entries.iter().for_each(|(at, value)| row[*at] = *value);
            row
        };
        // The normals of the slider and of the open pair, then their tangents.
        let of_slider = |at: usize| at == 0 || (2..2 + tangents).contains(&at);
        let stiffness: Vec<Vec<f64>> =
            (0..rows).map(|at| row(&[(at, if of_slider(at) { 1.0 } else { 1e6 })])).collect();
        let mut session = read(&scenario_text(json!({ "contact_system": {
            "pairs": ["slider", "open"], "tangents": tangents, "stiffness": stiffness, "friction": [0.1, 0.1],
            "loads": {
                "weight": { "vector": row(&[(0, 1.0)]) }, "lift": { "vector": row(&[(1, -1e6)]) },
                "push": { "vector": row(&[(2, -1.0)]) }
            } } })));
        let found = report(&mut session, "cycle push -0.3..0.3").expect("followed");
        assert_eq!(found["kind"], "alternates", "{tangents}: {found}");
        let last = found["cycles"].as_array().and_then(|cycles| cycles.last()).expect("cycles").clone();
        for way in 0..2 {
            is_near("the loss", number(&last["dissipated"][way]), 0.1 * 0.4, 1e-9, 1.0);
        }
    }
}
