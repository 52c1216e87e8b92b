//! Questions that have no answer, or have one in another place: what is said of them.

use super::lines::{read, report, text, told};
use super::quantities::TWO;

/// What a line is refused with.
fn refused(session: &mut stickslip::session::Session, line: &str) -> String {
    told(session, line).expect_err(line)
}

/// Nothing turns at a node of plates, so that it has no rotation, nowhere 0; nodes of bars and of rigid bodies have one.
#[test]
fn nodes_without_a_rotation_show_none() {
    let folder = tempfile::tempdir().expect("a place");
    let stiff = TWO.replace(r#""supports""#, r#""rigid": [ { "id": "cap", "at": "b.top" } ], "supports""#);
    for (scenario, corner_turns) in [(TWO, false), (&stiff, true)] {
        let mut session = read(scenario);
        for (node, turns) in [("B", true), ("b[0,0]", false), ("b[0,2]", corner_turns)] {
            let shown = report(&mut session, &format!("show rz {node}")).expect("a row");
            assert_eq!(shown[0]["value"].is_number(), turns, "{shown}");
            assert_eq!(
                shown[0]["reason"].as_str().is_some_and(|why| why.contains("has no rotation")),
                !turns,
                "{shown}"
            );
            let result = session.result(false).expect("an answer");
            let nodes = result["displacements"].as_array().expect("nodes").clone();
            let of_node = nodes.iter().find(|one| one["node"] == node).expect("the node");
            assert!(of_node["ux"].is_number() && of_node["rz"].is_number() == turns, "{of_node}");
            let file = folder.path().join("u.csv");
            text(&mut session, &format!("export displacements {}", file.display()));
            let written = std::fs::read_to_string(&file).expect("written");
            let id = if node.contains(',') { format!("\"{node}\",") } else { format!("{node},") };
            let row = written.lines().find_map(|row| row.strip_prefix(&id)).expect("the node");
            let row: Vec<&str> = row.split(',').collect();
            assert!(row[0].parse::<f64>().is_ok() && row[2].parse::<f64>().is_ok() == turns, "{row:?}");
            assert!(turns || row[2].is_empty(), "{row:?}");
        }
        assert!(refused(&mut session, "expect rz b[0,0] = 0").contains("has no rotation"));
    }
}
