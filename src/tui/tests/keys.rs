//! The table of the keys.

use super::*;

#[test]
fn the_manual_names_every_key() {
    let manual = keymap::manual();
    for binding in BINDINGS {
        assert!(manual.contains(&format!("`{}`", binding.name)));
    }
    insta::assert_snapshot!("keys-of-the-manual", manual);
}

/// The help begins with the keys of the pane, in two columns where there is room for them.
#[test]
fn help_begins_with_the_pane() {
    for (key, heading) in [("2", "Parameters"), ("3", "Pairs"), ("4", "Pivots"), ("1", "Structure")] {
        let mut rig = Rig::new("beam", 100, 30);
        rig.press(&[key, "?"]);
        let lines = crate::tui::help::lines(&rig.state, 94);
        assert!(lines[0].to_string().starts_with(heading), "{}", lines[0]);
        let all: String = lines.iter().map(|line| format!("{line}\n")).collect();
        assert!(lines.iter().all(|line| line.width() <= 94), "{all}");
        // every row of the table is there, and more than one stands beside another
        for binding in BINDINGS {
            let word = binding.help.split(' ').next().unwrap();
            assert!(all.contains(word), "{word}");
        }
        assert!(lines.len() < BINDINGS.len(), "{all}");
        let narrow = crate::tui::help::lines(&rig.state, 60);
        assert!(narrow.len() > BINDINGS.len());
    }
}

#[test]
fn a_search_that_ends_in_another_pane_stays_within_its_rows() {
    let mut rig = Rig::new("beam", 100, 30);
    let (pairs, parameters) = (rig.state.shown.pairs().len(), rig.state.shown.values.len());
    assert!(parameters < pairs, "{parameters} {pairs}");
    rig.press(&["3"]);
    rig.state.pair = pairs - 1;
    rig.press(&["/"]);
    while rig.state.focus != Pane::Parameters {
        rig.act(Action::Do(Do::PreviousPane));
    }
    rig.press(&["enter"]);
    assert!(rig.state.parameter < parameters, "{}", rig.state.parameter);
}

#[test]
fn search_finds_rows_in_every_list() {
    let mut rig = Rig::new("plates-free", 100, 30);
    let pairs = rig.state.shown.pairs().len();
    let id = |rig: &Rig| rig.state.shown.pairs()[rig.state.pair].id.clone();
    let wanted = rig.state.shown.pairs()[pairs - 1].id.clone();
    rig.press(&["3", "/"]);
    rig.act(Action::Paste(wanted.clone()));
    assert_eq!(id(&rig), wanted, "it goes there while one types");
    rig.press(&["enter"]);
    assert_eq!(id(&rig), wanted);
    rig.press(&["pageup", "n"]);
    assert_eq!(id(&rig), wanted);
    // states are found too; Esc goes back to where it began
    let from = rig.state.pair;
    rig.press(&["/"]);
    rig.act(Action::Paste("slip".into()));
    assert!(rig.state.shown.pairs()[rig.state.pair].state.word().starts_with("slip"));
    rig.press(&["esc"]);
    assert_eq!(rig.state.pair, from);
    rig.press(&["/"]);
    rig.act(Action::Paste("no such pair".into()));
    rig.press(&["enter"]);
    assert_eq!(rig.state.pair, from);
    assert!(rig.state.message.as_ref().unwrap().text.contains("no `no such pair` in Pairs"));
    // a parameter, a pivot, a plot
    let mut rig = Rig::new("beam", 100, 30);
    rig.press(&["2", "/"]);
    rig.act(Action::Paste("f2".into()));
    rig.press(&["enter"]);
    assert_eq!(rig.state.parameter, 2);
    rig.press(&["4", "/"]);
    rig.act(Action::Paste("c5".into()));
    rig.press(&["enter"]);
    assert_eq!(rig.state.step(), Some(1), "x+[c5] stopped the first pivot");
    rig.press(&["n"]);
    assert_eq!(rig.state.step(), Some(2), "c5 turned at the second");
    rig.press(&["N"]);
    assert_eq!(rig.state.step(), Some(1));
    rig.press(&["5", "/"]);
    rig.act(Action::Paste("moment".into()));
    rig.press(&["enter"]);
    assert_eq!(rig.state.plot, Plot::Moment);
    // and in the help
    rig.press(&["?", "/"]);
    rig.act(Action::Paste("redraw".into()));
    rig.act(Action::Paste("x".into()));
    rig.press(&["backspace"]);
    rig.act(Action::Do(Do::Cancel));
    rig.press(&["/"]);
    rig.act(Action::Paste("anew".into()));
    rig.press(&["enter"]);
    let found = rig.state.found.unwrap();
    assert!(crate::tui::overlay::lines(&rig.state)[found].to_string().contains("anew"));
    assert!(rig.screen().contains("anew"), "{}", rig.screen());
}

#[test]
fn what_is_under_the_cursor_is_copied() {
    let copied = |rig: &mut Rig, key: &str| match rig.press(&[key]).as_slice() {
        [Effect::Copy(text)] => {
            let said = &rig.state.message.as_ref().unwrap().text;
            assert!(said.starts_with("copied: "), "{said}");
            text.clone()
        }
        other => panic!("{other:?}"),
    };
    let mut rig = Rig::new("beam", 100, 30);
    assert_eq!(copied(&mut rig, "y"), "0.5");
    assert_eq!(copied(&mut rig, "Y"), "set f 0.5");
    rig.press(&["3", "down"]);
    // F = 100 presses
    let text = copied(&mut rig, "y");
    let x_n: f64 = text.strip_prefix("c2 stick x_n ").unwrap().split(' ').next().unwrap().parse().unwrap();
    assert!((x_n - 100.0).abs() < 1e-9, "{text}");
    assert_eq!(copied(&mut rig, "Y"), "why c2");
    rig.press(&["4", "home"]);
    assert_eq!(copied(&mut rig, "Y"), "step to 0");
    rig.press(&["5"]);
    assert_eq!(copied(&mut rig, "Y"), "plot slip");
    rig.press(&["y"]);
    assert!(rig.state.message.as_ref().unwrap().text.contains("nothing to copy"));
    rig.command("params");
    assert_eq!(copied(&mut rig, "Y"), "params");
    assert!(copied(&mut rig, "y").contains("F2"));
    let mut rig = Rig::new("murty6", 100, 30);
    rig.press(&["3", "down"]);
    assert!(copied(&mut rig, "y").starts_with("2 z "));
    assert_eq!(copied(&mut rig, "Y"), "why z[2]");
}

#[test]
fn enter_explains_what_is_selected() {
    let mut rig = Rig::new("beam", 100, 30);
    rig.press(&["3", "end", "down", "down", "enter"]);
    assert!(matches!(&rig.state.overlay, Overlay::Output { title, .. } if title == "why c3"));
    rig.press(&["esc", "4", "enter"]);
    assert!(matches!(&rig.state.overlay, Overlay::Output { title, .. } if title == "ties"));
    assert!(rig.screen().contains("x+[c2]"), "{}", rig.screen());
    rig.press(&["esc", "O"]);
    assert!(matches!(&rig.state.overlay, Overlay::Output { title, .. } if title == "ties"));
}
