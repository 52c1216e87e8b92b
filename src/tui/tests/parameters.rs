//! Sliders and typed values.

use super::*;

/// A bar of length L pulled by F: the slider of L moves the geometry, the one of the formula does not move.
#[test]
fn a_slider_moves_the_geometry() {
    let text = r#"{ "format": "stickslip/1", "title": "bar",
      "parameters": { "L": { "value": 2, "min": 1, "max": 4, "step": 0.5 }, "W": { "formula": "10*L" } },
      "materials": { "m": { "E": 1000, "nu": 0 } }, "sections": { "s": { "area": 0.1 } },
      "nodes": { "A": [0, 0], "B": ["L", 0] },
      "bars": [ { "id": "AB", "nodes": ["A", "B"], "kind": "truss", "material": "m", "section": "s" } ],
      "supports": [ { "at": "A", "fixed": ["x", "y"] } ],
      "contacts": [ { "id": "c", "node": "B", "against": "ground", "normal": [0, 1], "friction": 0.1 } ],
      "loads": { "weight": { "factor": "W", "items": [ { "point": { "at": "B", "force": [5, -1] } } ] } } }"#;
    let mut rig = Rig::of(load_text("bar", text, None).unwrap(), 140, 45);
    rig.press(&["2", "+"]);
    assert_eq!((rig.state.value("L"), rig.state.value("W")), (2.5, 25.0));
    assert_eq!(rig.state.shown.structure().unwrap().nodes[1].position, [2.5, 0.0, 0.0]);
    // N = 5 W − 0.1 W = 122.5, u = N L / (E A) = 3.0625.
    let slip = rig.state.shown.pairs()[0].z_t;
    assert!((slip - 3.0625).abs() < 1e-12, "{slip}");
    assert!(rig.screen().contains("= 10*L"), "{}", rig.screen());
    rig.press(&["down", "+"]);
    assert_eq!(rig.state.value("W"), 25.0);
    assert!(rig.screen().contains("W is a formula, 10*L"), "{}", rig.screen());
}

#[test]
fn a_slider_solves_at_once_and_says_what_changed() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.press(&["+", "+"]);
    assert_eq!(rig.state.value("f"), 0.6);
    assert_eq!(rig.session.values()["f"], 0.6);
    rig.press(&["down", "down", "-"]);
    assert_eq!(rig.state.shown.values["F2"], 240.0);
    rig.press(&[".", ","]);
    assert_eq!(rig.state.shown.values["F2"], 240.0);
    rig.press(&["["]);
    assert_eq!(rig.state.shown.values["F2"], 140.0);
    assert!(rig.screen().contains("1 pair changed"), "{}", rig.screen());
    rig.press(&["u", "u", "u", "u"]);
    assert_eq!(rig.state.shown.values["F2"], 250.0);
    rig.press(&["U"]);
    assert_eq!(rig.state.shown.values["F2"], 240.0);
    rig.press(&["r"]);
    assert_eq!(rig.state.shown.values["F2"], 250.0);
    assert!(rig.state.wanted.is_empty());
}

#[test]
fn a_typed_value_understands_what_set_understands() {
    let mut rig = Rig::new("beam", 80, 24);
    for (typed, value) in [("0.3", 0.3), ("+10%", 0.33), ("+= 0.07", 0.4), ("3", 3.0)] {
        rig.press(&["v"]);
        assert!(matches!(&rig.state.input, Input::Value { name, .. } if name == "f"));
        for c in typed.chars() {
            rig.act(Action::Type(c));
        }
        rig.press(&["enter"]);
        assert!((rig.state.value("f") - value).abs() < 1e-12, "{typed}");
    }
    // outside its range: said, and taken
    let message = rig.state.message.clone().unwrap();
    assert!(message.text.contains("range"), "{message:?}");
    rig.press(&["v"]);
    rig.act(Action::Paste("-1".into()));
    rig.press(&["enter"]);
    assert_eq!(rig.state.value("f"), 3.0);
    assert!(rig.screen().contains("must not be negative"), "{}", rig.screen());
}

#[test]
fn a_newer_value_stops_the_older_solve() {
    let mut rig = Rig::new("beam", 80, 24);
    let set = |value: f64| Job::Set { name: "f".into(), value };
    let more = || Action::Do(Do::Vary(10));
    assert_eq!(update(&mut rig.state, more()), [Effect::Run(set(0.55))]);
    assert_eq!(update(&mut rig.state, more()), [Effect::Stop]);
    assert_eq!(update(&mut rig.state, more()), [Effect::Stop]);
    // the slider stands where it was moved to, the answer is still the old one
    assert_eq!(rig.state.value("f"), 0.65);
    assert_eq!(rig.state.shown.values["f"], 0.5);
    assert_eq!(rig.state.waiting.len(), 1);
    // another slider waits, and stops nothing
    rig.state.parameter = 2;
    assert_eq!(update(&mut rig.state, more()), []);
    rig.state.parameter = 0;
    let mut stopped = rig.perform(Job::Motion);
    stopped.job = set(0.55);
    stopped.error = Some("interrupted".into());
    stopped.interrupted = true;
    let effects = update(&mut rig.state, Action::Done(Box::new(stopped)));
    assert_eq!(effects, [Effect::Run(set(0.65))]);
    assert_eq!(rig.state.message, None);
    assert_eq!(rig.state.value("f"), 0.65);
    let done = rig.perform(set(0.65));
    let effects = update(&mut rig.state, Action::Done(Box::new(done)));
    assert_eq!(effects, [Effect::Run(Job::Set { name: "F2".into(), value: 260.0 })]);
    assert_eq!(rig.state.shown.values["f"], 0.65);
    assert_eq!(rig.state.value("F2"), 260.0);
}

#[test]
fn progress_is_shown_and_can_be_stopped() {
    let mut rig = Rig::new("beam", 80, 24);
    update(&mut rig.state, Action::Do(Do::Vary(10)));
    let progress = || Action::Progress { what: "Lemke, pivot 64".into(), fraction: 0.42 };
    update(&mut rig.state, progress());
    assert!(rig.screen().contains("Lemke, pivot 64 42 %"), "{}", rig.screen());
    assert_eq!(update(&mut rig.state, Action::Do(Do::Stop)), [Effect::Stop]);
    let mut stopped = rig.perform(Job::Motion);
    stopped.job = Job::Set { name: "f".into(), value: 0.55 };
    stopped.error = Some("interrupted".into());
    stopped.interrupted = true;
    update(&mut rig.state, Action::Done(Box::new(stopped)));
    assert_eq!(rig.state.value("f"), 0.5);
    assert!(rig.screen().contains("as it was"));
    // late news of a job that is over
    update(&mut rig.state, progress());
    assert_eq!(rig.state.progress, None);
}

/// 250 is the value of the file, 10 a step: the keys come before the command is carried out.
#[test]
fn keys_typed_ahead_go_from_where_the_command_leads() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.press(&["2", "down", "down", ":"]);
    rig.act(Action::Paste("set F2 120".into()));
    let [Effect::Run(line)] = &update(&mut rig.state, Action::Do(Do::Accept))[..] else { panic!("one job") };
    for tenths in [10, 10, -1] {
        assert_eq!(update(&mut rig.state, Action::Do(Do::Vary(tenths))), []);
    }
    let done = rig.perform(line.clone());
    let [Effect::Run(vary)] = &update(&mut rig.state, Action::Done(Box::new(done)))[..] else { panic!("one job") };
    let done = rig.perform(vary.clone());
    update(&mut rig.state, Action::Done(Box::new(done)));
    assert_eq!(rig.session.values()["F2"], 139.0);
    assert_eq!(rig.state.value("F2"), 139.0);
}
