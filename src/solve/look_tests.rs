//! The look at the parts against the look at the numbers, on slabs on one another.

use super::*;
use crate::model::load::load_text;
use crate::watch::Quiet;

/// `slabs` of 40 × `rows` elements on one another, the lowest fixed along its base and the one that `held` names along its
/// left side, a traction (x, y) on top.
fn stack(slabs: usize, rows: usize, held: usize, traction: [f64; 2], factor: f64) -> Scenario {
    let plate = |i: usize| {
        format!(
            r#"{{"id":"s{i}","origin":[0,{i}],"size":[4,1],"divisions":[40,{rows}],"thickness":0.1,"material":"m","plane":"strain"}}"#
        )
    };
    let contact =
        |i: usize| format!(r#"{{"id":"j{i}","edge":"s{i}.bottom","against":"s{}.top","friction":0.3}}"#, i - 1);
    let plates: Vec<String> = (0..slabs).map(plate).collect();
    let contacts: Vec<String> = (1..slabs).map(contact).collect();
    let text = format!(
        r#"{{"format":"stickslip/1","title":"Slabs","materials":{{"m":{{"E":1e5,"nu":0.3}},"idle":{{"E":1,"nu":0}}}},
"plates":[{}],"supports":[{{"at":"s0.bottom","fixed":["x","y"]}},{{"at":"s{held}.left","fixed":["x"]}}],"contacts":[{}],
"loads":{{"w":{{"factor":{factor},"items":[{{"traction":{{"edge":"s{}.top","value":[{},{}]}}}}]}}}}}}"#,
        plates.join(","),
        contacts.join(","),
        slabs - 1,
        traction[0],
        traction[1]
    );
    load_text("slabs", &text, None).unwrap_or_else(|problems| panic!("{problems}"))
}

/// However busy the machine is.
const LONG: Duration = Duration::from_secs(3600);

fn is_decided_by_parts(scenario: &Scenario) -> bool {
    let Source::Structure(structure) = &scenario.source else { panic!("a structure") };
    let kinematics = Kinematics::new(structure, &joints(&structure.pairs), &Quiet).unwrap();
    surely_pressed(scenario, structure, &kinematics) && kinematics.is_complete(structure, &Quiet).unwrap()
}

#[test]
fn parts_tell_what_the_numbers_tell() {
    for (slabs, rows, held, traction, factor, decided) in [
        (2, 26, 0, [0.0, -1.0], 1.0, true),
        // Lifted: the motions leave that open.
        (2, 26, 0, [0.0, -1.0], -1.0, false),
        // The middle slab has two contacts, and rises with the upper one.
        (3, 17, 0, [0.5, -1.0], 1.0, true),
        // Nothing but the upper slab's way up and down is free.
        (2, 26, 1, [0.5, -1.0], 1.0, true),
    ] {
        let scenario = stack(slabs, rows, held, traction, factor);
        let Source::Structure(structure) = &scenario.source else { panic!("a structure") };
        assert!(structure.nodes.len() > FEW_NODES);
        assert_eq!(is_decided_by_parts(&scenario), decided, "{slabs} {traction:?} {factor}");
        let (seen, expected) = (look_within(LONG, &scenario, &Quiet).unwrap(), by_numbers(&scenario, &Quiet).unwrap());
        assert_eq!(
            (&seen.loose, &seen.warnings),
            (&expected.loose, &expected.warnings),
            "{slabs} {traction:?} {factor}"
        );
        assert!(!seen.loose.is_empty() && seen.left_out.is_none());
        // The material that nothing has, and the contact that is lifted.
        let lifted = traction[1] * factor > 0.0;
        assert_eq!(seen.warnings.len(), 1 + usize::from(lifted), "{:?}", seen.warnings);
    }
}

/// The upper slab is held along its left side both ways: nothing is free, so that no motion tells whether the contact is
/// pressed. RF of the factor without R against RF as it is condensed, and what follows from both.
#[test]
fn forces_of_the_held_joints_are_those_of_the_condensed_system() {
    for factor in [1.0, -1.0] {
        let text = stack(2, 26, 1, [0.5, -1.0], factor).text.replace(r#""fixed":["x"]"#, r#""fixed":["x","y"]"#);
        let scenario = load_text("slabs", &text, None).unwrap_or_else(|problems| panic!("{problems}"));
        assert!(!is_decided_by_parts(&scenario));
        let Source::Structure(structure) = &scenario.source else { panic!("a structure") };
        let kinematics = Kinematics::new(structure, &joints(&structure.pairs), &Quiet).unwrap();
        let held = kinematics.held_forces(structure, &Quiet).unwrap().expect("no joint repeats another");
        let prepared = prepare(&scenario, &Quiet).unwrap();
        let case = &prepared.system().unwrap().loads[0];
        // Two ways through two factors.
        let rounding = 1e-11 * held[0].size;
        assert!(held[0].size >= case.vector.amax() - rounding && (&held[0].forces - &case.vector).amax() <= rounding);
        let (seen, expected) = (look_within(LONG, &scenario, &Quiet).unwrap(), by_numbers(&scenario, &Quiet).unwrap());
        assert_eq!((&seen.loose, &seen.warnings), (&expected.loose, &expected.warnings), "{text}");
        let pressed = !expected.warnings.iter().any(|warning| warning.message.contains("no load case presses"));
        assert_eq!(clearly_pressed(&scenario, structure, &held), pressed, "{text}");
    }
}

#[test]
fn a_structure_that_cannot_stand_is_refused_without_numbers() {
    let mut scenario = stack(2, 26, 0, [0.0, -1.0], 1.0);
    let Source::Structure(structure) = &mut scenario.source else { panic!("a structure") };
    // Without its contact the upper slab is held by nothing.
    structure.pairs.clear();
    let error = look(&scenario, &Quiet).unwrap_err().to_string();
    assert!(error.contains("mechanism"), "{error}");
}

#[test]
fn a_structure_that_stands_without_its_contacts_is_looked_into_by_its_numbers() {
    let mut scenario = stack(1, 50, 0, [0.0, -1.0], 1.0);
    assert!(is_decided_by_parts(&scenario), "no contact, nothing to decide");
    let text = scenario.text.replace(
        r#""contacts":[]"#,
        r#""contacts":[{"id":"j","edge":"s0.top","against":"ground","law":"frictionless"}]"#,
    );
    scenario = load_text("slabs", &text, None).unwrap_or_else(|problems| panic!("{problems}"));
    assert!(!is_decided_by_parts(&scenario));
    let (seen, expected) = (look_within(LONG, &scenario, &Quiet).unwrap(), by_numbers(&scenario, &Quiet).unwrap());
    assert_eq!((&seen.warnings, &seen.left_out), (&expected.warnings, &None));
    // Without time, it says what was not looked into.
    let hasty = look_within(Duration::ZERO, &scenario, &Quiet).unwrap();
    assert!(hasty.left_out.is_some_and(|sentence| sentence.contains("`solve` decides it")));
}
