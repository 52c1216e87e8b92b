//! The mouse.

use super::*;

#[test]
fn the_mouse_finds_panes_sliders_and_rows() {
    let mut rig = Rig::new("beam", 140, 45);
    let area = rig.pane(Pane::Parameters);
    let (start, end) = crate::tui::panes::parameters::slider(&rig.state, area).unwrap();
    let y = area.y + 3;
    rig.act(Action::Mouse(Mouse::Press(end, y)));
    assert_eq!((rig.state.parameter, rig.state.value("F2")), (2, 400.0));
    rig.act(Action::Mouse(Mouse::Drag(start, y + 9)));
    assert_eq!(rig.state.value("F2"), 0.0);
    let middle = (start + end) / 2;
    rig.act(Action::Mouse(Mouse::Drag(middle, y)));
    assert!((rig.state.value("F2") - 200.0).abs() <= 10.0);
    let area = rig.pane(Pane::Pivots);
    rig.act(Action::Mouse(Mouse::Press(area.x + 3, area.y + 2)));
    assert_eq!((rig.state.focus, rig.state.step()), (Pane::Pivots, Some(0)));
    let area = rig.pane(Pane::Pairs);
    rig.act(Action::Mouse(Mouse::Press(area.x + 3, area.y + 5)));
    assert_eq!((rig.state.focus, rig.state.pair), (Pane::Pairs, 2));
    rig.act(Action::Mouse(Mouse::WheelDown(area.x + 3, area.y + 5)));
    assert_eq!(rig.state.pair, 3);
    let area = rig.pane(Pane::Structure);
    rig.act(Action::Mouse(Mouse::WheelUp(area.x + 3, area.y + 3)));
    assert!(rig.state.view.zoom > 1.0);
    rig.act(Action::Mouse(Mouse::Press(0, 0)));
    rig.act(Action::Mouse(Mouse::Press(139, 44)));
    // tabs
    let mut rig = Rig::new("plates-free", 80, 24);
    let (area, panes) = layout::places(&rig.state).unwrap().tabs.unwrap();
    let tabs = layout::tab_names(area, &panes, Pane::Structure);
    for (x, pane, _) in tabs {
        rig.act(Action::Mouse(Mouse::Press(x + 1, area.y)));
        assert_eq!((rig.state.focus, rig.state.tab), (pane, pane));
    }
}
