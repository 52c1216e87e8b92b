//! Quantities, and loadings shown one by one.

use crate::model::quantity::Quantity;
use crate::tui::action::Loading;

use super::*;

const LISTS: &str = r#",
  "probes": { "press": "x_n c" },
  "combinations": { "ULS": { "weight": 1, "pull": 3 }, "SLS": { "weight": 1, "pull": 1 } },
  "stages": [ { "weight": 1, "pull": 0 }, { "weight": 1, "pull": 3 }, { "weight": 1, "pull": 0 } ]"#;

fn block(width: u16, height: u16) -> Rig {
    Rig::of(block_on_a_spring("", "2", LISTS), width, height)
}

fn slip(rig: &Rig) -> f64 {
    rig.state.shown.pairs()[0].z_t
}

fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-12, "{a} instead of {b}");
}

#[test]
fn combinations_and_stages_are_shown_one_by_one() {
    let mut rig = block(140, 45);
    near(slip(&rig), 0.0);
    rig.press(&["8", "down"]);
    assert_eq!(rig.state.loading(), Loading::Combination("ULS".into()));
    // 3 · 2 − 0.4 · 10 = 2
    near(slip(&rig), 2.0 / 1000.0);
    assert!(rig.screen().contains("1 weight + 3 pull"), "{}", rig.screen());
    insta::assert_snapshot!("loading", rig.screen());
    // the combination stays while a slider moves: 6 − 0.5 · 10 = 1
    rig.press(&["2", "+"]);
    assert_eq!(rig.state.loading(), Loading::Combination("ULS".into()));
    near(slip(&rig), 1.0 / 1000.0);
    rig.press(&["-", "8", "down"]);
    near(slip(&rig), 0.0);
    // stages remember: pulled by 6 it slips by 2/1000, and the spring cannot push it back against f W = 4
    rig.press(&["down"]);
    assert_eq!(rig.state.loading(), Loading::Stage(0));
    near(slip(&rig), 0.0);
    rig.press(&["down"]);
    near(slip(&rig), 2.0 / 1000.0);
    assert!(rig.screen().contains("Stage 2 of 3"), "{}", rig.screen());
    rig.press(&["down"]);
    near(slip(&rig), 2.0 / 1000.0);
    insta::assert_snapshot!("stage", rig.screen());
    rig.press(&["left"]);
    assert!(rig.state.message.as_ref().unwrap().text.contains("a stage is shown"));
    // the pivots of the answer explain no stage
    rig.press(&["3", "enter"]);
    assert_eq!(rig.state.overlay, Overlay::None);
    assert!(rig.state.message.as_ref().unwrap().text.contains("why and ties ask the answer"));
    rig.press(&["8", "pageup"]);
    assert_eq!(rig.state.loading(), Loading::Own);
    near(slip(&rig), 0.0);
    // what is typed stands, too
    rig.command("combine ULS");
    assert_eq!(rig.state.loading(), Loading::Combination("ULS".into()));
    rig.command("stages");
    assert_eq!(rig.state.loading(), Loading::Stage(2));
    let mut rig = Rig::new("gap", 80, 24);
    rig.press(&["8", "down", "up"]);
    assert!(rig.screen().contains("neither"), "{}", rig.screen());
}

/// Events of a stage stand apart from when they happen, however long that number is.
#[test]
fn events_of_a_stage_stand_beside_their_times() {
    let text = embedded::text("bearing-two-way").unwrap();
    // It slips from t = f W / Fx = 2/3 on.
    let stages = r#", "stages": [{ "weight": 1 }, { "weight": 1, "pull-x": 1 }] }"#;
    let text = text.trim_end().strip_suffix('}').unwrap().trim_end().to_owned() + stages;
    let scenario =
        crate::model::load::load_text("stages.json", &text, None).unwrap_or_else(|problems| panic!("{problems}"));
    let mut rig = Rig::of(scenario, 80, 24);
    rig.command("stages");
    rig.press(&["esc"]);
    let screen = rig.screen();
    let events = screen.lines().filter(|line| line.contains("pair slider "));
    assert!(events.clone().count() > 0 && events.clone().all(|line| line.contains("  pair slider ")), "{screen}");
    assert!(screen.contains("what happens on the way"), "{screen}");
}

#[test]
fn quantities_follow_the_sliders() {
    let mut rig = block(80, 24);
    rig.press(&["7"]);
    assert_eq!(rig.state.gauges.len(), 1);
    assert!(rig.state.gauges[0].value.starts_with("10"), "{:?}", rig.state.gauges);
    rig.command("show bound c, ux B");
    rig.press(&["esc"]);
    let value =
        |rig: &Rig, row: usize| -> f64 { rig.state.gauges[row].value.split(' ').next().unwrap().parse().unwrap() };
    assert_eq!(rig.state.gauges.len(), 3);
    near(value(&rig, 1), 4.0);
    rig.press(&["+"]);
    near(value(&rig, 1), 5.0);
    insta::assert_snapshot!("quantities", rig.screen());
    // at the end of a stage: u = 2/1000
    rig.press(&["-", "8", "down", "down", "down", "down", "7"]);
    near(value(&rig, 2), 0.002);
    rig.press(&["x"]);
    assert!(rig.state.message.as_ref().unwrap().text.contains("probe"));
    rig.press(&["down", "x"]);
    assert_eq!(rig.state.gauges.len(), 2);
    assert!(!matches!(rig.state.asked[0], Quantity::Probe(..)));
    // without probes what is usually looked at
    let mut rig = Rig::new("beam", 140, 45);
    rig.press(&["7"]);
    assert!(rig.screen().contains("sum x_n *"), "{}", rig.screen());
    near(value(&rig, 0), 600.0);
}

/// Twenty pairs in space have more columns and rows than the pane has room for: the selected one stays in view, the pane says
/// that there is more, and the command shows it.
#[test]
fn the_selected_pair_stays_in_view_where_columns_find_no_room() {
    let mut rig = Rig::new("block-3d", 80, 24);
    rig.press(&["3"]);
    for id in 0..20 {
        let screen = rig.screen();
        assert!(screen.contains(&format!("▸ base[{id}] ")), "{screen}");
        assert!(screen.contains("`:pairs` shows all columns"), "{screen}");
        assert!(screen.contains("z_t1") && !screen.contains("x_t1"), "{screen}");
        rig.press(&["down"]);
    }
}
