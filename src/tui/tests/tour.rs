//! The tour.

use super::*;

#[test]
fn the_tour_tells_what_is_true() {
    let mut rig = Rig::new("gap", 80, 24);
    rig.command("tour");
    let mut outcomes = Vec::new();
    for step in 1..=6 {
        assert_eq!(rig.state.tour, Some(step - 1));
        insta::assert_snapshot!(format!("tour-{step}"), rig.screen());
        let answer = rig.state.shown.answer().unwrap();
        outcomes.push((answer.outcome, rig.state.shown.step(), rig.state.shown.moment.p));
        rig.press(&["enter"]);
    }
    assert_eq!(rig.state.tour, None);
    let near = |p: Option<f64>, value: f64| assert!((p.unwrap() - value).abs() < 1e-3, "{p:?}");
    assert_eq!(outcomes[0].0, OutcomeKind::Trivial);
    assert_eq!(outcomes[1].0, OutcomeKind::Normal);
    near(outcomes[2].2, 133.3333);
    assert_eq!(outcomes[2].1, Some(0));
    near(outcomes[3].2, 22.2222);
    assert!(matches!(outcomes[4].0, OutcomeKind::Normal));
    assert_eq!(outcomes[5].0, OutcomeKind::Ray);
    near(outcomes[5].2, 3.3333);
    rig.command("tour");
    rig.press(&["enter", "backspace"]);
    assert_eq!(rig.state.tour, Some(0));
    rig.press(&["esc"]);
    assert_eq!(rig.state.tour, None);
}
