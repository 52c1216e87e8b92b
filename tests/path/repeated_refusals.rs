//! What is not answered of joints that repeat one another, and what is done instead.

use serde_json::json;
use stickslip::session::Session;

use crate::common::lines::{read, report};
use crate::common::scenario_text;

/// A tip between two sides, pressed on one of them: in space, or in the plane.
fn guide(in_space: bool) -> Session {
    let side = |id: &str, y: f64| {
        let (normal, tangent) =
            if in_space { (json!([0, y, 0]), json!([1, 0, 0])) } else { (json!([0, y]), json!(null)) };
        let mut side =
            json!({ "id": id, "node": "B", "against": "ground", "normal": normal, "friction": "f", "gap": 0.01 });
        if in_space {
            side["tangent"] = tangent;
        }
        side
    };
    let place = |x: f64| if in_space { json!([x, 0, 0]) } else { json!([x, 0]) };
    let force = |x: f64, y: f64| if in_space { json!([x, y, 0]) } else { json!([x, y]) };
    let mut text = json!({
        "parameters": { "P": 1, "T": 0.2, "f": 0.3 },
        "materials": { "m": { "E": 1, "nu": 0 } },
        "sections": { "s": { "area": 500, "inertia": 1000 } },
        "nodes": { "A": place(0.0), "B": place(10.0) },
        "bars": [{ "id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s" }],
        "supports": [{ "at": "A", "fixed": ["x", "y", "r"] }],
        "contacts": [side("low", 1.0), side("up", -1.0)],
        "loads": {
            "push": { "factor": "P", "items": [{ "point": { "at": "B", "force": force(0.0, -1.0) } }] },
            "pull": { "factor": "T", "items": [{ "point": { "at": "B", "force": force(1.0, 0.0) } }] }
        }
    });
    if in_space {
        text["dimension"] = json!(3);
        text["sections"] = json!({ "s": { "area": 500, "inertia_y": 1000, "inertia_z": 1000, "torsion": 1000 } });
        text["bars"][0]["orientation"] = json!([0, 1, 0]);
        text["supports"][0]["fixed"] = json!(["x", "y", "z", "rx", "ry", "rz"]);
    }
    read(&scenario_text(text))
}

/// Every question that needs R names itself, the pairs and what to do instead, and that is done.
#[test]
fn what_is_refused_says_what_goes_instead() {
    let file = |name: &str| format!("{}/repeated-{name}.json", env!("CARGO_TARGET_TMPDIR"));
    let (lcp, system) = (file("lcp"), file("system"));
    for in_space in [false, true] {
        let written = format!("export lcp {lcp}");
        let slips = if in_space { "0.001,0" } else { "0.001" };
        let from = format!("cycle P 0..1 from low={slips}");
        for (question, command, told, instead) in [
            ("check exact", "check exact", "`check`", "check"),
            ("enumerate", "enumerate", "`export lcp FILE.json`", &written),
            (&format!("export system {system}"), "export system", "`export lcp FILE.json`", &written),
            ("critical f", "critical", "`find f A..B where outcome answer`", "find f 0.2..0.5 where outcome answer"),
            ("cycle P 0..1 from all", "cycle … from all", "`from PAIR=SLIP …`", &from),
        ] {
            let mut session = guide(in_space);
            let refusal = report(&mut session, question).expect_err(question);
            let why = format!("`{command}` needs joints that are independent of one another; those of low, up repeat");
            assert!(refusal.contains(&why) && refusal.contains(told), "{refusal}");
            if let Err(error) = report(&mut session, instead) {
                panic!("{instead}, in space {in_space}: {error}");
            }
        }
        let mut session = guide(in_space);
        let refusal = report(&mut session, "set engine exact").expect_err("no rationals");
        assert!(refusal.contains("`engine exact`") && refusal.contains("`set engine scheme`"), "{refusal}");
        report(&mut session, "set engine scheme").expect("the default");
    }
}
