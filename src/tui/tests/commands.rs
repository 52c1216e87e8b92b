//! The line of commands.

use super::*;

#[test]
fn commands_run_in_the_same_session() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.command("set F2 120; set covering weight");
    assert_eq!(rig.state.shown.values["F2"], 120.0);
    assert_eq!(rig.state.shown.rules.covering.to_string(), "weight");
    rig.command("pairs");
    assert!(matches!(&rig.state.overlay, Overlay::Output { title, .. } if title == "pairs"));
    rig.press(&["esc"]);
    rig.command("echo one line");
    assert_eq!(rig.state.message.as_ref().unwrap().text, "one line");
    rig.command("pears");
    assert!(rig.screen().contains("did you mean"), "{}", rig.screen());
    rig.press(&["esc"]);
    rig.command("load greco");
    assert_eq!(rig.state.shown.scenario.name, "greco");
    assert_eq!(rig.state.parameter, 0);
    rig.command("load no/such/file.json");
    assert_eq!(rig.state.shown.scenario.name, "greco");
    rig.press(&["esc", ":", "up", "up"]);
    assert!(matches!(&rig.state.input, Input::Command(entry) if entry.text == "load greco"));
    rig.press(&["esc"]);
    assert_eq!(rig.command("quit"), [Effect::Leave(Leave::Quit)]);
    assert_eq!(rig.press(&["q"]), [Effect::Leave(Leave::Quit)]);
    assert_eq!(rig.press(&["R"]), [Effect::Leave(Leave::Repl)]);
    assert_eq!(rig.press(&["ctrl-z"]), [Effect::Suspend]);
    assert_eq!(rig.press(&["M"]), [Effect::Mouse(false)]);
}

/// What was printed for a wider terminal is there to the last word when that gets narrower.
#[test]
fn a_text_is_broken_anew_when_the_terminal_gets_narrower() {
    for line in ["why c3", "set F2 to something that is no number at all, neither now nor at any later time of the day"]
    {
        let mut rig = Rig::new("beam", 120, 45);
        rig.command(line);
        let Overlay::Output { lines, .. } = &rig.state.overlay else { panic!("{line}") };
        let widest = lines.iter().map(ratatui::text::Line::width).max().unwrap();
        let words: Vec<String> =
            lines.iter().flat_map(|line| line.to_string().split(' ').map(str::to_owned).collect::<Vec<_>>()).collect();
        let narrow = 48;
        assert!(widest > usize::from(narrow), "{line}: {widest}");
        rig.act(Action::Resize(narrow, 45));
        let screen = rig.screen();
        for word in words {
            assert!(screen.contains(&word), "{line}: {word} is not in\n{screen}");
        }
    }
}

#[test]
fn auto_off_leaves_the_panes_empty_and_alive() {
    let mut rig = Rig::new("beam", 140, 45);
    rig.command("set auto off");
    rig.press(&["+"]);
    assert!(rig.state.shown.solved.is_none());
    assert!(rig.screen().contains("not solved yet"));
    rig.press(&["left", "space", "m", "a", "3", "down", "5", "p", "6", "down"]);
    rig.screen();
    rig.press(&["esc"]);
    rig.command("solve");
    assert!(rig.state.shown.solved.is_some());
}

#[test]
fn everything_typed_is_shown_as_typed() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.press(&[":"]);
    for c in "echo ü漢\u{301}".chars() {
        rig.act(Action::Type(c));
    }
    assert!(rig.screen().contains("echo ü漢"), "{}", rig.screen());
    rig.act(Action::Paste("x".repeat(300)));
    rig.screen();
    rig.press(&["enter"]);
    assert!(rig.screen().contains("漢"));
}

#[test]
fn a_load_answers_in_the_last_line() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.command("load greco");
    assert_eq!(rig.state.overlay, Overlay::None);
    let said = rig.state.message.clone().unwrap().text;
    assert!(said.contains("greco") && said.contains("normal"), "{said}");
    // what is wrong is said there too, and the next key acts
    rig.command("load no/such/file.json");
    assert_eq!(rig.state.overlay, Overlay::None);
    assert!(rig.state.message.clone().unwrap().text.contains("no/such/file.json"));
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("wrong.json");
    std::fs::write(&file, r#"{ "format": "stickslip/1", "nodes": { "A": [0, 0] }, "sources": 1, "barz": [] }"#)
        .unwrap();
    rig.command(&format!("load {}", file.display()));
    assert_eq!(rig.state.overlay, Overlay::None);
    let said = rig.state.message.clone().unwrap().text;
    assert!(said.ends_with("(O shows all)"), "{said}");
    assert!(said.chars().count() <= 80, "{said}");
    rig.press(&["O"]);
    assert!(rig.screen().contains("barz") && rig.screen().contains("sources"), "{}", rig.screen());
    rig.press(&["esc", "+"]);
    assert_eq!(rig.state.shown.scenario.name, "greco");
}

/// Whatever the word is cut to: what a scenario says of itself stands at the bottom, and the next key means the panes.
#[test]
fn a_scenario_that_is_loaded_says_so_in_a_line() {
    for line in ["load dam", "lo dam", "load dam; load portal"] {
        let mut rig = Rig::new("beam", 80, 24);
        rig.command(line);
        assert_eq!(rig.state.overlay, Overlay::None, "{line}");
        let said = rig.state.message.as_ref().unwrap().text.clone();
        assert!(said.starts_with("dam: Gravity dam") && said.contains("shows all"), "{line}: {said}");
        rig.press(&["3"]);
        assert_eq!(rig.state.focus, Pane::Pairs, "{line}");
    }
    let mut rig = Rig::new("beam", 80, 24);
    rig.command("load dam; pairs");
    assert!(matches!(&rig.state.overlay, Overlay::Output { .. }), "a table was asked for");
}
