//! The map, its cursor, and what the other panes show there.

use super::*;

/// The block pulled by a parameter P: it slips where P > 10 f.
fn block() -> Scenario {
    block_on_a_spring(r#", "P": { "value": 2, "min": 0, "max": 10 }"#, r#""P""#, "")
}

fn mapped(width: u16, height: u16) -> Rig {
    let mut rig = Rig::of(block(), width, height);
    rig.press(&["9"]);
    assert!(rig.screen().contains("no map yet"), "{}", rig.screen());
    rig.command("map f P");
    rig
}

fn slip(rig: &Rig) -> f64 {
    rig.state.shown.pairs()[0].z_t
}

/// The slip of the closed form at the cursor.
fn expected(rig: &Rig) -> f64 {
    let [f, p] = crate::tui::panes::map::cursor(&rig.state).unwrap();
    (p - 10.0 * f).max(0.0) / 1000.0
}

fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-12, "{a} instead of {b}");
}

#[test]
fn the_panes_follow_the_cursor_and_enter_sets_its_place() {
    let mut rig = mapped(140, 45);
    assert_eq!((rig.state.focus, rig.state.overlay == Overlay::None), (Pane::Map, true));
    insta::assert_snapshot!("map", rig.screen());
    // the cursor begins at the present values, and the session stays as it is
    for _ in 0..12 {
        rig.press(&["up"]);
        near(slip(&rig), expected(&rig));
    }
    assert!(slip(&rig) > 0.0 && rig.state.below.is_some());
    assert_eq!(rig.session.values()["P"], 2.0);
    let screen = rig.screen();
    assert!(screen.contains("at the cursor of the map") && screen.contains("all slip+"), "{screen}");
    insta::assert_snapshot!("map-cursor", rig.screen());
    rig.press(&["right", "right", "left", "pagedown", "left"]);
    near(slip(&rig), expected(&rig));
    // another pane shows the session again; the cursor stays where it was
    let at = crate::tui::panes::map::cursor(&rig.state);
    rig.press(&["3"]);
    assert!(rig.state.below.is_none() && rig.state.shown.glance.is_none());
    near(slip(&rig), 0.0);
    rig.press(&["9"]);
    assert_eq!(crate::tui::panes::map::cursor(&rig.state), at);
    rig.press(&["up", "up", "up", "up", "up", "up"]);
    let [f, p] = crate::tui::panes::map::cursor(&rig.state).unwrap();
    rig.press(&["enter"]);
    assert_eq!([rig.session.values()["f"], rig.session.values()["P"]], [f, p]);
    near(slip(&rig), (p - 10.0 * f).max(0.0) / 1000.0);
    assert!(rig.state.below.is_none());
    // there and back
    rig.press(&["up", "home"]);
    assert_eq!(crate::tui::panes::map::cursor(&rig.state), Some([f, p]));
    assert!(rig.state.below.is_none());
}

#[test]
fn regions_are_stepped_through_searched_and_copied() {
    let mut rig = mapped(80, 24);
    let region = |rig: &Rig| {
        let drawn = crate::tui::panes::map::drawn(&rig.state).unwrap();
        drawn.map.regions[drawn.map.region_at(crate::tui::panes::map::cursor(&rig.state).unwrap()).unwrap()].clone()
    };
    let first = region(&rig).letter;
    rig.press(&["space"]);
    assert_ne!(region(&rig).letter, first);
    rig.press(&["space"]);
    assert_eq!(region(&rig).letter, first);
    // whatever is typed into a line leaves the cursor where it is
    rig.press(&["/", "tab", "up", "down"]);
    assert!(rig.state.below.is_some());
    rig.act(Action::Paste("slip+".into()));
    rig.press(&["enter"]);
    assert_eq!(region(&rig).states, Some(vec![("c".to_owned(), PairMotion::SlipPlus)]));
    near(slip(&rig), expected(&rig));
    let [f, p] = crate::tui::panes::map::cursor(&rig.state).unwrap();
    let copied = rig.press(&["Y"]);
    assert_eq!(copied, [Effect::Copy(format!("set f {f}; set P {p}"))]);
    // other values of a third thing: the map says under which it was drawn
    insta::assert_snapshot!("map-80x24", rig.screen());
    // without colour and Unicode the letters and the reversed cell are left
    rig.state.look = Look { color: false, ascii: true };
    let screen = rig.screen();
    assert!(screen.is_ascii(), "{screen}");
    let buffer = rig.buffer();
    let place = rig.pane(Pane::Map);
    let reversed = |x: u16, y: u16| buffer[(x, y)].modifier.contains(Modifier::REVERSED);
    let inner = crate::tui::paint::inside(place);
    let count = (inner.top()..inner.bottom()).flat_map(|y| (inner.left()..inner.right()).map(move |x| (x, y)));
    assert_eq!(count.filter(|(x, y)| reversed(*x, *y)).count(), 1, "one cursor");
}

#[test]
fn a_load_case_is_looked_at_and_not_set() {
    let mut rig = Rig::of(block(), 100, 30);
    rig.command("map f 0..1 pull 0..10");
    rig.press(&["up", "up", "up"]);
    near(slip(&rig), expected(&rig));
    rig.press(&["enter"]);
    assert!(rig.state.message.as_ref().unwrap().text.contains("pull is a load case"));
    assert_eq!(rig.session.values()["f"], 0.4);
}

#[test]
fn the_mouse_moves_the_cursor() {
    let mut rig = mapped(140, 45);
    let place = crate::tui::paint::inside(rig.pane(Pane::Map));
    rig.act(Action::Mouse(Mouse::Press(place.x + place.width / 2, place.y + 3)));
    near(slip(&rig), expected(&rig));
    assert!(rig.state.below.is_some());
}

#[test]
fn only_the_newest_place_counts() {
    let mut rig = mapped(140, 45);
    let up = || Action::Do(Do::Up);
    assert!(matches!(update(&mut rig.state, up())[..], [Effect::Run(Job::Glance { .. })]));
    assert_eq!(update(&mut rig.state, up()), [Effect::Stop]);
    assert_eq!(update(&mut rig.state, up()), [Effect::Stop]);
    assert_eq!(rig.state.waiting.len(), 1);
}
