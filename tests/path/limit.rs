//! What `limit` claims: the way it looks, the end of a path beyond which there are answers, limits of 0.

use serde_json::{Value, json};

use super::common::lines::{read, report, text};

/// Four blocks in two courses: the path of the push ends at 1.2444, yet there are answers at 1.25 and beyond, under another
/// self-stress. The end of the path is no limit then. The pushed block b has the weight 4, and N ≤ 4 of d on it; its bed holds
/// f (4 + N), d no more than f N, nor than the bed of d on a holds, f (4 − N): f (4 + N) + f min(N, 4 − N) ≤ 8 f.
#[test]
fn where_a_path_ends_with_answers_beyond_the_limit_lies_farther() {
    let mut wall = read(include_str!("wall.json"));
    let found = report(&mut wall, "limit h").unwrap();
    let limit = found["limit"].as_f64().expect("a limit");
    assert!((limit - 1.6).abs() <= 1e-7 && limit <= 1.6, "{found}");
    assert!(found["confirmed"] == true && found["collapse"]["verdict"] == "certified", "{found}");
    assert!(found["answer_beyond"].is_null(), "{found}");
    for (value, outcome) in [(1.25, "answer"), (1.59, "answer"), (1.600_001, "ray")] {
        text(&mut wall, &format!("set H {value}"));
        text(&mut wall, &format!("expect outcome {outcome}"));
    }
    text(&mut wall, "set H 1");
    // The path itself knows one self-stress, and says that it is not the only one.
    let path = report(&mut wall, "trace h").unwrap();
    assert!(path["limit"].is_null() && path["answer_beyond"].as_f64() < Some(1.6), "{path}");
    assert!(text(&mut wall, "trace h").contains("`limit h` looks further"));
    for command in ["limit h", "show limit h", "summary"] {
        let shown = text(&mut wall, command);
        assert!(shown.contains("1.6") || shown.contains("1.59999"), "{command}: {shown}");
    }
}

/// Two pairs of which the second, k, is pressed by 1 + z_n/2 where the first opens by z_n, and free to slide under the push h:
///
/// ```text
///     λ_1 = (z_n + k_n/2 − z_t + 0.6,  −z_n + 1.5 z_t − 1),      λ_k = (k_n + z_n/2 + 1,  h)
/// ```
/// With k at rest the first sticks, for 1 ≤ 2 · 0.6, or is open by z = (0.2, 0.8), or slips by 0.4. A push that starts where
/// it sticks slides k at h = f · 1 = 0.5; where it is open k holds up to 0.5 · 1.1.
#[test]
fn the_end_of_a_path_with_answers_beyond_is_no_limit() {
    let mut pairs = read(
        r#"{ "format": "stickslip/1", "title": "pairs", "parameters": { "H": 0.1 }, "contact_system": { "pairs": ["c", "k"],
             "stiffness": [[1, 0.5, -1, 0], [0.5, 1, 0, 0], [-1, 0, 1.5, 0], [0, 0, 0, 0]], "kernel": [[0, 0, 0, 1]],
             "loads": { "w": { "vector": [0.6, 1, -1, 0] }, "h": { "factor": "H", "vector": [0, 0, 0, 1] } },
             "friction": [2, 0.5] } }"#,
    );
    for command in ["limit h", "trace h"] {
        let found = report(&mut pairs, command).unwrap();
        assert!(found["limit"].is_null(), "{found}");
        let beyond = found["answer_beyond"].as_f64().expect("an answer beyond");
        assert!(beyond > 0.5 && beyond < 0.5001, "{found}");
        let end = found["end"].as_str().expect("a sentence");
        assert!(end.contains("the path ends at h = 0.5,") && end.contains("not the largest load that can be carried"));
        let shown = text(&mut pairs, command);
        assert!(shown.contains("answer exists") && !shown.contains("limit load"), "{shown}");
        // The command that the sentence names is one, and finds the rest of the answers.
        let further = end.split('`').nth(1).expect("a command").to_owned();
        assert!(text(&mut pairs, &further).contains("h = 0.55 "), "{further}");
    }
    let found = report(&mut pairs, "limit h").unwrap();
    assert!(found["confirmed"] == false && found["safety"].is_null() && found["collapse"].is_null(), "{found}");
    for command in ["show limit h", "summary"] {
        let shown = text(&mut pairs, command).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(shown.contains("answer exists") || shown.contains("with answers beyond"), "{command}: {shown}");
        assert!(!shown.contains("confirmed"), "{command}: {shown}");
    }
    for (value, outcome) in [(0.5001, "answer"), (0.5499, "answer"), (0.5501, "ray")] {
        text(&mut pairs, &format!("set H {value}"));
        text(&mut pairs, &format!("expect outcome {outcome}"));
    }
}

/// A point under the weight 10 on ground of friction 0.3, pushed by 2 + h: |2 + h| ≤ 3.
#[test]
fn a_negative_load_grows_downwards() {
    let mut point = read(
        r#"{ "format": "stickslip/1", "title": "point", "nodes": { "A": [0, 0] },
             "springs": [ { "at": "A", "direction": [0, 1], "stiffness": 1e-9 } ],
             "contacts": [ { "id": "c", "node": "A", "against": "ground", "normal": [0, 1], "friction": 0.3 } ],
             "parameters": { "H": { "value": -1 } },
             "loads": { "w": { "items": [ { "point": { "at": "A", "force": [2, -10] } } ] },
                        "h": { "factor": "H", "items": [ { "point": { "at": "A", "force": [1, 0] } } ] } } }"#,
    );
    // Beyond the limit there is no answer to start from: from 0 then.
    for (present, limit) in [(-1.0, -5.0), (-8.0, -5.0), (0.0, 1.0), (0.5, 1.0), (2.0, 1.0)] {
        text(&mut point, &format!("set H {present}"));
        for name in ["h", "H"] {
            let found = report(&mut point, &format!("limit {name}")).unwrap();
            let near = |value: &serde_json::Value, expected: f64| {
                value.as_f64().is_some_and(|value| (value - expected).abs() <= 1e-9 * expected.abs())
            };
            assert!(near(&found["limit"], limit), "{present}: {found}");
            assert_eq!(found["confirmed"], true, "{present}: {found}");
            if present == 0.0 {
                assert!(found["safety"].is_null(), "{found}");
            } else {
                assert!(near(&found["safety"], limit / present), "{present}: {found}");
            }
        }
    }
}

/// A point between two faces that press with nothing carries no push at all; 0.999999 of that is no other load.
#[test]
fn a_limit_of_zero_has_nothing_beside_it() {
    let mut point = read(
        r#"{ "format": "stickslip/1", "title": "point", "nodes": { "a": [0, 0] },
             "springs": [ { "at": "a", "direction": [0, 1], "stiffness": 5 } ],
             "contacts": [ { "id": "d", "node": "a", "against": "ground", "normal": [0, 1], "friction": 0.3 },
                           { "id": "u", "node": "a", "against": "ground", "normal": [0, -1], "friction": 0.3 } ],
             "loads": { "p": { "items": [ { "point": { "at": "a", "force": [1, 0] } } ] } } }"#,
    );
    let found = report(&mut point, "limit p").unwrap();
    assert_eq!((found["limit"].as_f64(), found["safety"].as_f64()), (Some(0.0), Some(0.0)), "{found}");
    for command in ["limit p", "show limit p", "summary"] {
        assert!(!text(&mut point, command).contains("confirmed"), "{command}");
    }
}

/// A portal that no bolt holds slides at the wind f q L or turns over about its far heel at q L (L + b)/(2 h), whichever
/// comes first; how stiff it is makes no difference. Its limit is a motion that no force resists: rounding of the compliance
/// matrix must not be taken for a row that blocks it, nor the weight of a path for something that blocks at all.
#[test]
fn a_free_portal_slides_or_turns_over_however_stiff_it_is() {
    let scenario = include_str!("../../scenarios/portal.json");
    for (span, height, load, friction, width, inertia) in [
        (12.0, 5.0, 20.0, 0.5, 0.4, 4.507e-4),
        (22.0, 8.0, 20.0, 0.1, 0.2, 1e-5),
        (14.0, 4.0, 40.0, 0.5, 0.2, 1e-5),
        (8.0, 4.0, 40.0, 0.2, 0.2, 1e-5),
        (22.0, 8.0, 30.0, 0.2, 0.2, 4.5e-4),
        (18.0, 3.0, 2.0, 0.5, 0.2, 1e-5),
        (18.0, 8.0, 20.0, 0.5, 0.2, 5e-3),
        (10.0, 8.0, 30.0, 0.7, 0.4, 4.5e-4),
        (14.0, 6.5, 40.0, 0.2, 0.2, 5e-3),
    ] {
        let mut portal = read(scenario);
        let values = [("L", span), ("h", height), ("q", load), ("f", friction), ("b", width), ("I", inertia)];
        for (name, value) in values {
            text(&mut portal, &format!("set {name} {value}"));
        }
        let weight = load * span;
        let limit = f64::min(friction * weight, weight * (span + width) / (2.0 * height));
        for start in [1.0, limit / 4.0] {
            text(&mut portal, &format!("set W {start}"));
            let found = report(&mut portal, "limit wind").unwrap();
            let near = found["limit"].as_f64().is_some_and(|found| (found - limit).abs() <= 1e-6 * limit);
            assert!(near && found["confirmed"] == true, "{values:?} from {start}, {limit} expected: {found}");
        }
    }
}

/// Two points on a common track, pressed elastically by 1 each: they slide at h = 0.1 + 0.3. No motion certifies it (sliding does
/// not open the springs), but the run just beyond tries every basis.
#[test]
fn what_a_run_beside_the_limit_proves_is_said_of_the_limit() {
    let mut track = read(
        r#"{ "format": "stickslip/1", "title": "track", "contact_system": { "pairs": ["c1", "c2"],
             "stiffness": [[2, 0, 0, 0], [0, 2, 0, 0], [0, 0, 1, -1], [0, 0, -1, 1]], "kernel": [[0, 0, 1, 1]],
             "loads": { "w": { "vector": [1, 1, 0, 0] }, "h": { "vector": [0, 0, 0, 1] } }, "friction": [0.1, 0.3] } }"#,
    );
    let found = report(&mut track, "limit h").unwrap();
    let limit = found["limit"].as_f64().expect("a limit");
    assert!((limit - 0.4).abs() <= 1e-12, "{found}");
    assert_eq!(found["collapse"]["verdict"], "proved", "{found}");
    // At one load, not at all beyond.
    assert!(text(&mut track, "limit h").contains("whether loads beyond it can be carried is not proved"));
}

/// Bricks of one course after another, each half a brick over from the course below, as plates: (id, x, length).
fn courses(count: usize, bricks: usize, [length, height]: [f64; 2]) -> (Vec<Value>, Vec<Value>) {
    let (mut plates, mut contacts) = (Vec::new(), Vec::new());
    let mut below: Vec<(String, f64, f64)> = Vec::new();
    for course in 0..count {
        let end = bricks as f64 * length;
        let shift = if course % 2 == 0 { 0.0 } else { 0.5 * length };
        let cuts = (0..=bricks + 1).map(|k| (k as f64 * length - shift).clamp(0.0, end)).collect::<Vec<_>>();
        let own = cuts.windows(2).filter(|cut| cut[1] > cut[0]).enumerate();
        let own: Vec<(String, f64, f64)> =
            own.map(|(k, cut)| (format!("b{course}-{k}"), cut[0], cut[1] - cut[0])).collect();
        for (id, x, wide) in &own {
            let halves = (2.0 * wide / length).round() as usize;
            plates.push(json!({
                "id": id, "origin": [x, course as f64 * height], "size": [wide, height], "divisions": [halves, 1],
                "thickness": 1, "material": "stone", "plane": "stress"
            }));
            if course == 0 {
                contacts.push(json!({ "id": format!("g{id}"), "edge": format!("{id}.bottom"), "against": "ground", "friction": 1.2 }));
            }
            for half in 0..halves {
                let from = x + 0.5 * half as f64 * length;
                let Some((under, left, _)) = below
                    .iter()
                    .find(|(_, left, wide)| *left <= from + 1e-9 && from + 0.5 * length <= left + wide + 1e-9)
                else {
                    continue;
                };
                let over = (2.0 * (from - left) / length).round() as usize;
                contacts.extend([0, 1].map(|end| {
                    json!({
                        "id": format!("{id}-{half}{end}"), "node": format!("{id}[{},0]", half + end),
                        "against": format!("{under}[{},1]", over + end), "normal": [0, 1], "friction": 1.2
                    })
                }));
            }
        }
        below = own;
    }
    (plates, contacts)
}

/// A dry wall of three courses, tilted until the half brick at its lower end, and the brick that half of it carries, turn over its
/// lower edge: of half a brick at 1/4 and a brick at 1/2 of the length before the edge, tan α = (½·¼ + ½) l / ((½·½ + 3/2) h). What is
/// proved to fall begins farther out, since friction of 1.2 might hold a joint that opens, if opening pressed it.
#[test]
fn the_most_of_a_tilt_lies_where_answers_end_before_what_is_proved() {
    let [length, height] = [0.6, 0.3];
    let (plates, contacts) = courses(3, 2, [length, height]);
    let mut wall = super::common::lines::session(
        stickslip::model::load::load_text(
            "wall",
            &super::common::scenario_text(json!({
                "parameters": { "alpha": { "value": 0, "min": 0, "max": 60 }, "a": { "formula": "alpha*pi/180" } },
                "materials": { "stone": { "E": 1e7, "nu": 0.2, "density": 2 } },
                "plates": plates, "contacts": contacts,
                "loads": { "w": { "items": [{ "gravity": { "acceleration": ["10*sin(a)", "-10*cos(a)"] } }] } }
            })),
            None,
        )
        .expect("a wall"),
    );
    let found = report(&mut wall, "find most alpha where outcome answer").unwrap();
    let slope = (0.5 * 0.25 + 0.5) * length / ((0.5 * 0.5 + 1.5) * height);
    let most = found["value"].as_f64().expect("a tilt");
    assert!((most - slope.atan().to_degrees()).abs() <= 1e-6, "{found}");
    assert!(found["undecided"]["value"].as_f64().expect("a run") < most + 1e-5, "{found}");
    assert!(found["collapse"]["value"].as_f64().expect("a run") > most + 1.0, "{found}");
}

/// A frame on three feet under its own weight, tipped about the left one, turned by thirty degrees after thirty: there the
/// moment of the push about that foot is that of the weights. The other feet open within rounding of one another; what falls
/// by rounding on the way does not turn the look beyond the end around.
#[test]
fn the_look_beyond_a_limit_goes_the_way_of_the_load() {
    let feet = [[-0.1233, 0.0], [2.743, 0.0], [6.29, 0.0]];
    let heads = [[-0.1233, 3.105], [2.743, 2.902], [6.29, 2.864]];
    let bars =
        [[feet[0], heads[0]], [feet[1], heads[1]], [feet[2], heads[2]], [heads[0], heads[1]], [heads[1], heads[2]]];
    let push = [-3.296, -4.853];
    let weight = |[[x, y], [x_end, y_end]]: [[f64; 2]; 2]| 2.5 * 0.01 * 10.0 * (x_end - x).hypot(y_end - y);
    let lever = |[[x, _], [x_end, _]]: [[f64; 2]; 2]| 0.5 * (x + x_end) - feet[0][0];
    let expected = bars.map(|bar| weight(bar) * lever(bar)).iter().sum::<f64>() / (-push[0] * heads[0][1]);
    for degrees in (0..360).step_by(30) {
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        let turned = |[x, y]: [f64; 2]| json!([cos * x - sin * y, sin * x + cos * y]);
        let bar = |id: &str, material: &str, from: &str, to: &str, divisions: usize| json!({ "id": id, "nodes": [from, to], "material": material, "section": "s", "divisions": divisions });
        let foot = |i: usize, lean: f64, friction: f64| {
            json!({ "id": format!("p{i}"), "node": format!("a{i}"), "against": "ground", "normal": turned([lean, 1.0]),
                    "friction": friction })
        };
        let material = |modulus: f64| json!({ "E": modulus, "nu": 0.2, "density": 2.5 });
        let mut frame = read(
            &json!({
                "format": "stickslip/1", "title": "frame",
                "materials": { "m": material(2e3), "g": material(2e5) }, "sections": { "s": { "area": 0.01, "inertia": 1e-4 } },
                "nodes": { "a0": turned(feet[0]), "b0": turned(heads[0]), "a1": turned(feet[1]), "b1": turned(heads[1]),
                           "a2": turned(feet[2]), "b2": turned(heads[2]) },
                "bars": [bar("c0", "m", "a0", "b0", 1), bar("c1", "m", "a1", "b1", 1), bar("c2", "m", "a2", "b2", 1),
                         bar("g0", "g", "b0", "b1", 2), bar("g1", "g", "b1", "b2", 1)],
                "contacts": [foot(0, 0.0, 0.7), foot(1, -0.519, 1.0), foot(2, 0.0, 0.3)],
                "loads": {
                    "w": { "factor": 1, "items": [{ "gravity": { "acceleration": turned([0.0, -10.0]) } }] },
                    "p": { "factor": 1, "items": [{ "point": { "at": "b0", "force": turned(push) } }] }
                }
            })
            .to_string(),
        );
        let found = report(&mut frame, "limit p").unwrap();
        let limit = found["limit"].as_f64().unwrap_or_else(|| panic!("{degrees}: {found}"));
        assert!((limit / expected - 1.0).abs() <= 1e-8, "{degrees}: {limit} is not {expected}");
        assert!(found["confirmed"] == true, "{degrees}: {found}");
    }
}
