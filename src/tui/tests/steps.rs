//! Along the pivots, and the mode of a ray.

use super::*;

#[test]
fn stepping_moves_every_pane() {
    let mut rig = Rig::new("beam", 140, 45);
    let slipping = |rig: &Rig| rig.state.shown.pairs().iter().filter(|pair| pair.state == PairMotion::SlipPlus).count();
    assert_eq!(slipping(&rig), 4);
    rig.press(&["home"]);
    assert_eq!((rig.state.step(), slipping(&rig)), (Some(0), 0));
    rig.press(&["right", "right"]);
    assert_eq!((rig.state.step(), slipping(&rig)), (Some(2), 2));
    let screen = rig.screen();
    for part in ["Pivot 2 (p enters at 0)", "p = 22.222 kN", "pivot 2 (p enters at 0) · displacements"] {
        assert!(screen.contains(part), "{part}\n{screen}");
    }
    rig.press(&["end"]);
    assert_eq!(rig.state.shown.position, None);
    rig.press(&["right"]);
    assert_eq!(rig.state.shown.position, None);
    rig.press(&["4", "up", "up"]);
    assert_eq!(rig.state.step(), Some(2));
    // steps that come faster than they are shown add up
    let back = || Action::Do(Do::StepBack);
    assert_eq!(update(&mut rig.state, back()), [Effect::Run(Job::Step(1))]);
    assert_eq!(update(&mut rig.state, back()), []);
    assert_eq!(rig.state.step(), Some(0));
    let done = rig.perform(Job::Step(1));
    let effects = update(&mut rig.state, Action::Done(Box::new(done)));
    assert_eq!(effects, [Effect::Run(Job::Step(0))]);
}

#[test]
fn pivots_play_to_the_end() {
    let mut rig = Rig::new("beam", 80, 24);
    assert_eq!(rig.state.tick(), None);
    rig.press(&["space"]);
    assert!(rig.state.tick().is_some());
    assert_eq!(rig.state.step(), Some(0));
    for step in 1..=4 {
        rig.act(Action::Tick);
        assert_eq!(rig.state.step(), Some(step));
    }
    rig.act(Action::Tick);
    assert_eq!(rig.state.tick(), None);
    rig.press(&["space", "space"]);
    assert!(!rig.state.playing);
    // nothing to play
    let mut rig = Rig::new("gap", 80, 24);
    rig.press(&["space"]);
    assert_eq!(rig.state.tick(), None);
    assert!(rig.state.message.is_some());
}

#[test]
fn the_mode_moves_only_at_a_ray() {
    let mut rig = Rig::new("beam", 80, 24);
    rig.press(&["m"]);
    assert_eq!(rig.state.tick(), None);
    rig.press(&["2", "down", "down", "v"]);
    rig.act(Action::Paste("330".into()));
    rig.press(&["enter"]);
    assert!(rig.state.shown.at_ray());
    assert!(rig.state.shown.has_mode());
    let mode = rig.state.shown.motion.u.clone().unwrap();
    // the beam slides as a whole
    assert!(mode.iter().all(|u| (u[0] - 1.0).abs() < 1e-9 && u[1].abs() < 1e-9));
    rig.press(&["m"]);
    assert!(rig.state.tick().is_some());
    let first = rig.screen();
    rig.act(Action::Tick);
    rig.act(Action::Tick);
    rig.act(Action::Tick);
    assert_ne!(rig.screen(), first);
    rig.press(&["esc"]);
    assert_eq!(rig.state.tick(), None);
    rig.press(&["m", "home"]);
    assert_eq!(rig.state.tick(), None, "a pivot on the way has no mode");
}
