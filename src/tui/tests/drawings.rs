//! Screens at several sizes, as text and as styles.

use super::*;

macro_rules! snapshot {
    ($name:literal, $rig:expr) => {
        insta::assert_snapshot!($name, $rig.screen())
    };
}

#[test]
fn first_screens() {
    for scenario in ["beam", "beam-ray", "plates-free", "frame-rotated", "greco", "murty6", "klarbring", "gap"] {
        for (width, height) in [(80, 24), (140, 45)] {
            let rig = Rig::new(scenario, width, height);
            insta::assert_snapshot!(format!("{scenario}-{width}x{height}"), rig.screen());
        }
    }
}

/// However low the picture is, the loads are in it: an arrow loses its tail, not itself.
#[test]
fn loads_are_seen_on_a_flat_beam() {
    for (width, height) in [(80, 24), (100, 30), (140, 45), (200, 60)] {
        let rig = Rig::new("beam", width, height);
        let area = rig.pane(Pane::Structure);
        let picture: Vec<String> = rig
            .screen()
            .lines()
            .skip(usize::from(area.y))
            .take(usize::from(area.height))
            .map(|line| line.chars().take(usize::from(area.width)).collect())
            .collect();
        // five supports and the legend; at the pulled end the two loads are one arrow
        assert_eq!(picture.concat().matches('↓').count(), 6, "{}", rig.screen());
        assert!(picture.concat().contains('→') || picture.concat().contains('↘'), "{}", rig.screen());
    }
}

#[test]
fn every_pane_at_both_sizes() {
    for (width, height) in [(80, 24), (140, 45)] {
        for (key, pane) in ["1", "2", "3", "4", "5", "6"].iter().zip(Pane::ALL) {
            let mut rig = Rig::new("plates-free", width, height);
            rig.press(&[key]);
            assert_eq!(rig.state.focus, pane);
            let name = format!("pane-{}-{width}x{height}", pane.title().to_lowercase());
            insta::assert_snapshot!(name, rig.screen());
            rig.press(&["z"]);
            let name = format!("large-{}-{width}x{height}", pane.title().to_lowercase());
            insta::assert_snapshot!(name, rig.screen());
        }
    }
}

#[test]
fn every_plot() {
    let mut rig = Rig::new("beam-ray", 80, 24);
    rig.press(&["5", "z"]);
    for _ in 0..6 {
        let name = format!("plot-{:?}", rig.state.plot).to_lowercase();
        insta::assert_snapshot!(name, rig.screen());
        rig.press(&["p"]);
    }
    assert_eq!(rig.state.plot, Plot::Ray);
}

#[test]
fn without_friction_pressures_are_plotted_first() {
    let mut rig = Rig::new("footing", 80, 24);
    rig.press(&["5", "z"]);
    assert!(rig.screen().contains("Pressing force x_n"), "{}", rig.screen());
    rig.press(&["p", "p"]);
    assert_eq!(rig.state.plot, Plot::P);
}

#[test]
fn before_and_after() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.press(&["down", "down", "[", "5"]);
    assert_eq!(rig.state.value("F2"), 150.0);
    snapshot!("before-and-after", rig);
    insta::assert_snapshot!("before-and-after-styles", styles(&rig.buffer()));
    rig.press(&["b", "3"]);
    snapshot!("changed-pairs", rig);
    insta::assert_snapshot!("changed-pairs-styles", styles(&rig.buffer()));
}

#[test]
fn overlays() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.press(&["?"]);
    snapshot!("help", rig);
    rig.press(&["esc"]);
    rig.command("pivots");
    snapshot!("output", rig);
    rig.press(&["q", ":"]);
    rig.act(Action::Paste("expect ou".into()));
    snapshot!("hint", rig);
    rig.press(&["ctrl-c", ":"]);
    rig.act(Action::Paste("set covering ".into()));
    rig.press(&["tab", "tab"]);
    snapshot!("candidates", rig);
    rig.press(&["esc", "v"]);
    snapshot!("value", rig);
    let mut rig = Rig::new("klarbring", 140, 45);
    rig.press(&["a"]);
    snapshot!("answers", rig);
}

#[test]
fn small_and_plain_terminals() {
    for (width, height) in [(40, 12), (39, 12), (60, 20), (76, 20), (119, 40), (10, 3)] {
        let mut rig = Rig::new("beam", 140, 45);
        rig.act(Action::Resize(width, height));
        insta::assert_snapshot!(format!("beam-{width}x{height}"), rig.screen());
    }
    let mut rig = Rig::new("plates-free", 80, 24);
    rig.state.look = Look::default();
    rig.press(&["1"]);
    let buffer = rig.buffer();
    assert!(buffer.content.iter().all(|cell| cell.fg == ratatui::style::Color::Reset));
    rig.state.look.ascii = true;
    snapshot!("plates-free-ascii", rig);
    for key in ["2", "3", "4", "5", "6", "?"] {
        rig.press(&[key]);
        assert!(rig.screen().is_ascii(), "{}", rig.screen());
    }
}
