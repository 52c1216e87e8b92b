//! Facets and cone, as the rules choose them, wherever a problem in space is written, compared or swept.

use serde_json::json;
use stickslip::answer::record::OutcomeKind;
use stickslip::model::rules::Rules;
use stickslip::path::grid::{Axis, Grid};
use stickslip::path::sweep::{Format, Sweep};
use stickslip::watch::Quiet;

use crate::common::Case;

/// A foot without stiffness, pressed by 2 at f = 0.3 and pushed by F along t1 + t2: it holds up to 0.6 on Coulomb's cone, up
/// to 0.6 √2 on the polygon of four facets, a corner of which lies there.
fn foot() -> Case {
    Case::json(json!({
        "parameters": { "F": { "value": 0.7, "min": 0, "max": 2 } },
        "contact_system": {
            "pairs": ["c1"], "tangents": 2, "stiffness": vec![vec![0.0; 3]; 3], "friction": [0.3],
            "loads": {
                "weight": { "vector": [2, 0, 0] },
                "push": { "factor": "F", "vector": [0, -0.5_f64.sqrt(), -0.5_f64.sqrt()] } } } }))
}

fn square() -> Rules {
    Rules { facets: 4, cone: false, ..Rules::default() }
}

/// All rules find the answer of the polygon that is asked for, and none on the cone.
#[test]
fn compare_runs_on_the_polygon_that_is_chosen() {
    let case = foot();
    let values = case.scenario.parameter_values();
    for (rules, expected) in [(square(), true), (Rules::default(), false)] {
        let compared = case.prepared.compare(&values, rules, &Quiet).expect("compared");
        let outcomes: Vec<OutcomeKind> = compared.rows.iter().filter_map(|row| row.outcome).collect();
        assert!(!outcomes.is_empty() && outcomes.iter().all(|outcome| outcome.is_answer() == expected), "{outcomes:?}");
    }
}

/// A row for x_n and one for each facet.
#[test]
fn the_exported_lcp_has_the_facets_that_are_chosen() {
    let case = foot();
    for facets in [4, 8, 16] {
        let rules = Rules { facets, ..Rules::default() };
        let (lcp, names) = case.prepared.written_lcp(&case.scenario.parameter_values(), rules);
        assert_eq!((lcp.q.len(), names.len()), (1 + usize::from(facets), 1 + usize::from(facets)));
    }
}

/// A file is not continued under another polygon, or with the cone switched.
#[test]
fn sweeps_under_other_facets_or_another_cone_are_other_sweeps() {
    let case = foot();
    let values = case.scenario.parameter_values();
    let grid = Grid::new(&case.scenario, vec![Axis::parse("F=0:1:0.5").expect("an axis")]).expect("a grid");
    let hash = |rules: Rules| {
        let case = case.prepared.case(&case.scenario, &values).under(rules);
        let shard = "1/1".parse().expect("a shard");
        Sweep { case, grid: &grid, shard, format: Format::Csv, quantities: &[] }.header().hash
    };
    let hashes = [
        hash(Rules::default()),
        hash(Rules { facets: 16, ..Rules::default() }),
        hash(Rules { cone: false, ..Rules::default() }),
    ];
    assert_eq!(hashes[0], hash(Rules::default()));
    assert!(hashes[0] != hashes[1] && hashes[0] != hashes[2] && hashes[1] != hashes[2], "{hashes:?}");
}

/// Where chosen rules end in a ray the default ones are run to say whether they do better: on a foot that Coulomb's cone
/// cannot hold they do not, on one held by springs (R = 1) they do. `ones` takes more friction than there is for f > 1.
#[test]
fn chosen_rules_are_compared_with_the_default_ones() {
    let mut stiffness = vec![vec![0.0; 3]; 3];
    (0..3).for_each(|row| stiffness[row][row] = 1.0);
    let case = Case::json(json!({
        "solver": { "covering": "ones" },
        "contact_system": {
            "pairs": ["c1"], "tangents": 2, "stiffness": stiffness, "friction": [3],
            "loads": { "lift": { "vector": [-1, -2, 0.5] } } } }));
    let answer = case.solve(&[]);
    let ray = answer.ray.as_ref().expect("a ray of `ones`");
    let said = "The default rules (covering cohesive, tie-break lexicographic) find an answer in";
    assert!(ray.explanation.contains(said), "{}", ray.explanation);
}
