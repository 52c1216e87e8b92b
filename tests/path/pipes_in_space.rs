//! Load histories of pipes on rests, in guides and at stops, which heat up and cool down.

use serde_json::{Value, json};
use stickslip::path::stages::{History, HistoryEnd, StageResult, follow};

use crate::common::{Case, near, near_all};

fn followed(case: &Case) -> History {
    let values = case.scenario.parameter_values();
    let history = follow(case.prepared.case(&case.scenario, &values).under(case.scenario.rules));
    let history = history.unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(history.end, HistoryEnd::Complete, "{}", history.end_sentence());
    for stage in &history.stages {
        assert!(stage.end.is_answer() && stage.end.check.passed, "{:?}", stage.end.failure);
        assert!(stage.energy.expect("a structure").residual <= 1e-9, "{:?}", stage.energy);
    }
    history
}

fn jumps(stage: &StageResult) -> usize {
    stage.moments.iter().filter(|moment| moment.jump).count()
}

/// A hot line from a nozzle along x, up a riser and along y, on those of its supports that are named.
fn line(friction: f64, at_guide: f64, supports: &[&str]) -> History {
    let all = [
        json!({ "id": "t1", "node": "q1", "against": "ground", "normal": [0, 0, 1], "friction": friction }),
        json!({ "id": "t2", "node": "q2", "against": "ground", "normal": [0, 0, 1], "friction": friction }),
        json!({ "id": "t3", "node": "q3", "against": "ground", "normal": [0, 0, 1], "friction": friction }),
        json!({ "id": "guide", "node": "q2", "against": "ground", "normal": [-1, 0, 0], "friction": at_guide, "gap": 0.002 }),
        json!({ "id": "stop", "node": "end", "against": "ground", "normal": [0, -1, 0], "friction": friction, "gap": 0.01 }),
    ];
    let contacts: Vec<&Value> = all.iter().filter(|one| supports.iter().any(|id| one["id"] == *id)).collect();
    let weights: Vec<Value> =
        ["run1", "riser", "run2"].map(|bar| json!({ "line": { "bar": bar, "value": [0, 0, -0.9] } })).to_vec();
    followed(&Case::json(json!({
        "dimension": 3,
        "materials": { "steel": { "E": 2.0e8, "nu": 0.3, "expansion": 1.2e-5 } },
        "sections": {
            "pipe": { "area": 5.433e-3, "inertia_y": 3.025e-5, "inertia_z": 3.025e-5, "torsion": 6.05e-5 } },
        "nodes": {
            "noz": [0, 0, 0], "p1": [3, 0, 0], "p2": [6, 0, 0], "p3": [9, 0, 0], "e1": [11, 0, 0],
            "e2": [11, 0, 4], "q1": [11, 4, 4], "q2": [11, 8, 4], "q3": [11, 12, 4], "end": [11, 14, 4] },
        "bars": [
            { "id": "run1", "polyline": ["noz", "p1", "p2", "p3", "e1"], "material": "steel", "section": "pipe" },
            { "id": "riser", "nodes": ["e1", "e2"], "material": "steel", "section": "pipe" },
            { "id": "run2", "polyline": ["e2", "q1", "q2", "q3", "end"], "material": "steel", "section": "pipe" } ],
        "supports": [{ "at": "noz", "fixed": ["x", "y", "z", "rx", "ry", "rz"] }],
        "contacts": contacts,
        "loads": {
            "weight": { "items": weights },
            "heat": { "items": [{ "temperature": { "change": 150, "on": ["run1", "riser", "run2"] } }] } },
        "stages": [{ "weight": 1 }, { "weight": 1, "heat": 1 }, { "weight": 1 }]
    })))
}

/// z_τ and x_n of the pairs against figures of an independent march, both to `tolerance` of its largest figure.
fn agrees(stage: &StageResult, slips: &[[f64; 2]], pressed: &[f64], tolerance: f64) {
    let found: Vec<f64> = stage.end.pairs.iter().flat_map(|pair| pair.slip()).collect();
    near_all("z_τ", &found, slips.as_flattened(), tolerance);
    let found: Vec<f64> = stage.end.pairs.iter().map(|pair| pair.x_n).collect();
    near_all("x_n", &found, pressed, tolerance);
}

/// A rest and a guide without friction at one node of a line along x, from which a leg of 8 m goes off along y. Heat drives the
/// node α ΔT L less f N of the rest over E A/L; cold it stays by as much on the other side of 0, and a wind of p along x on leg
/// and line drives it by what (8 + 4/2) p has more than f N. (The leg does not pull back: its end moves off from the
/// wall behind it and reaches no stop.)
#[test]
fn a_rest_in_a_guide_slips_to_and_fro_as_a_bar_does() {
    let (area, friction, expansion, wind) = (0.0035601165379086047, 0.093, 1.2e-5 * 73.0, 0.2296);
    let inertia = 1.5874512985581918e-5;
    let history = followed(&Case::json(json!({
        "dimension": 3,
        "materials": { "steel": { "E": 2.0e8, "nu": 0.3, "expansion": 1.2e-5 } },
        "sections": {
            "pipe": { "area": area, "inertia_y": inertia, "inertia_z": inertia, "torsion": 2.0 * inertia } },
        "nodes": { "n0": [0, 0, 0], "n1": [4, 0, 0], "n2": [4, 4, 0], "n3": [4, 8, 0] },
        "bars": [{ "id": "run", "polyline": ["n0", "n1", "n2", "n3"], "material": "steel", "section": "pipe" }],
        "supports": [{ "at": "n0", "fixed": ["x", "y", "z", "rx", "ry", "rz"] }],
        "contacts": [
            { "id": "rest", "node": "n1", "against": "ground", "normal": [0, 0, 1], "friction": friction },
            { "id": "guide", "node": "n1", "against": "ground", "normal": [0, 1, 0], "friction": 0 },
            { "id": "wall", "node": "n3", "against": "ground", "normal": [1, 0, 0], "friction": friction },
            { "id": "stop", "node": "n3", "against": "ground", "normal": [0, -1, 0], "friction": friction, "gap": 0.0133 } ],
        "loads": {
            "weight": { "items": [{ "line": { "bar": "run", "value": [0, 0, -0.732] } }] },
            "heat": { "items": [{ "temperature": { "change": 73, "on": ["run"] } }] },
            "wind": { "items": [{ "line": { "bar": "run", "value": [wind, -0.1045, 0] } }] } },
        "stages": [{ "weight": 1 }, { "weight": 1, "heat": 1 }, { "weight": 1 }, { "weight": 1, "wind": 1 }]
    })));
    let stiffness = 2.0e8 * area / 4.0;
    for (stage, driven) in [(1, 4.0 * expansion * stiffness), (2, 0.0), (3, 10.0 * wind)] {
        let rest = &history.stages[stage].end.pairs[0];
        let bound = friction * rest.x_n;
        let stays = if driven > bound { -bound } else { bound };
        near("slip", rest.slip()[0], (driven + stays) / stiffness, 1e-9, 4.0 * expansion);
        assert_eq!(jumps(&history.stages[stage]), 0, "stage {}", stage + 1);
    }
}

/// Cooling down, the end of the line lets go where the friction of its last rest has turned across it, and jumps: no rates and
/// no polygon lead on. An independent march (frames of its own, projections pair by pair until nothing moves, in 400 and 800
/// steps a stage, extrapolated to none) ends where this does; its own steps differ by 1e-4 m and 2e-3 kN there.
#[test]
fn a_pipe_that_cools_lets_go_with_a_jump() {
    let history = line(0.15, 0.15, &["t1", "t3", "stop"]);
    assert_eq!(history.stages.iter().map(jumps).collect::<Vec<_>>(), [0, 0, 1]);
    agrees(
        &history.stages[2],
        &[[3.73325e-3, -7.98341e-3], [-3.13346e-2, -7.98106e-3], [-4.04854e-2, -7.44991e-3]],
        &[17.20044, 2.24663, 0.0],
        2e-3,
    );
}

/// A rest that rubs in a guide that rubs: once the rest is in the guide both hold the node whatever they share, so that the
/// slips of the first stage stay and nothing more is lost. The slips are those of an independent march in 200 and 400 steps,
/// extrapolated: its steps differ by 1e-8 m.
#[test]
fn a_rest_wedged_in_a_guide_holds_while_the_pipe_heats_and_cools() {
    let history = line(0.08, 0.08, &["t2", "t3", "guide", "stop"]);
    let [rest, far, end] = [[2e-3, -3.1713138e-2], [-1.1133791e-1, -3.1713138e-2], [-1.6800687e-1, 3.1238133e-1]];
    let guided = [-3.1713138e-2, 0.0];
    agrees(&history.stages[0], &[rest, far, guided, end], &[13.48780, 0.0, 0.637717, 0.0], 3e-6);
    // Hot: the far rest and the end are in the air.
    let hot = [[-1.2264275e-1, -2.4513139e-2], [-1.8496412e-1, 3.0742764e-1]];
    for (stage, [far, end]) in history.stages[1..].iter().zip([hot, [far, end]]) {
        let found: Vec<f64> = stage.end.pairs.iter().flat_map(|pair| pair.slip()).collect();
        near_all("z_τ", &found, [rest, far, guided, end].as_flattened(), 3e-6);
        near("lost", stage.dissipated, 0.0, 1e-9, history.stages[0].dissipated);
    }
}

/// A pipe that is heated between smooth stops, cooled and brought back: a history leaves z at the rounding of what it went
/// through, 1e-2 m, and no load is left to compare that with. Without friction nothing holds it back: the end is the beginning.
#[test]
fn a_history_whose_load_is_taken_off_again_ends_unloaded_and_passes_its_check() {
    for (gap, rests) in [(0.0, "c"), (0.005, "c"), (0.0, "b")] {
        let history = followed(&Case::json(json!({
            "dimension": 3,
            "materials": { "steel": { "E": 2.0e8, "nu": 0.3, "expansion": 1.2e-5 } },
            "sections": { "pipe": { "area": 5e-3, "inertia_y": 3e-5, "inertia_z": 3e-5, "torsion": 6e-5 } },
            "nodes": { "a": [0, 0, 0], "b": [7, 0, 0], "c": [11, 0, 0], "d": [11, 0, 4], "e": [11, 8, 4], "f": [11, 14, 4] },
            "bars": [{ "id": "p", "polyline": ["a", "b", "c", "d", "e", "f"], "material": "steel", "section": "pipe" }],
            "supports": [{ "at": "a", "fixed": ["x", "y", "z", "rx", "ry", "rz"] }],
            "contacts": [
                { "id": "shoe", "node": rests, "against": "ground", "normal": [0, 0, 1], "friction": 0 },
                { "id": "rest", "node": "e", "against": "ground", "normal": [0, 0, 1], "friction": 0 },
                { "id": "guide", "node": "e", "against": "ground", "normal": [-1, 0, 0], "friction": 0 },
                { "id": "stop", "node": "f", "against": "ground", "normal": [0, -1, 0], "friction": 0, "gap": gap } ],
            "loads": { "heat": { "items": [{ "temperature": { "change": 150, "on": ["p"] } }] } },
            "stages": [{ "heat": 1 }, { "heat": -1 }, { "heat": 0 }]
        })));
        let largest = |stage: &StageResult| {
            let nodes = stage.end.displacements.as_ref().expect("a structure");
            nodes.iter().map(|node| node.length()).fold(0.0, f64::max)
        };
        let [hot, _, cold] = [0, 1, 2].map(|stage| largest(&history.stages[stage]));
        // Free expansion of the straight run alone: α ΔT · 11 m.
        assert!(hot > 1.2e-5 * 150.0 * 11.0 * 0.5, "{hot}");
        assert!(cold < 1e-9 * hot, "gap {gap}: {cold:e}");
    }
}
