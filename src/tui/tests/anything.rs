//! Any actions in any order.

use super::*;

fn any_action() -> impl Strategy<Value = Action> {
    let bound = (0..BINDINGS.len()).prop_map(|row| Action::Do(BINDINGS[row].action));
    let place = || (0u16..150, 0u16..50);
    // no letters that could make up a command that writes files
    let typed = prop::sample::select("setf F20.;+-cwhy pi?ü漢 ".chars().collect::<Vec<_>>());
    prop_oneof![
        8 => bound,
        3 => typed.prop_map(Action::Type),
        1 => place().prop_map(|(x, y)| Action::Mouse(Mouse::Press(x, y))),
        1 => place().prop_map(|(x, y)| Action::Mouse(Mouse::Drag(x, y))),
        1 => place().prop_map(|(x, y)| Action::Mouse(Mouse::WheelUp(x, y))),
        1 => place().prop_map(|(x, y)| Action::Mouse(Mouse::WheelDown(x, y))),
        2 => (0u16..160, 0u16..60).prop_map(|(x, y)| Action::Resize(x, y)),
        1 => Just(Action::Tick),
        1 => prop::sample::select(vec!["load gap", "load murty6", "load klarbring", "load beam-ray", "load block", "load ratchet", "stages", "show max u", "tour", "set auto off"])
            .prop_map(|line| Action::Paste(line.to_owned())),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_sequence_of_actions_breaks_the_screen(
        size in (1u16..160, 1u16..60),
        ascii in any::<bool>(),
        actions in prop::collection::vec(any_action(), 1..60),
    ) {
        let mut rig = Rig::new("beam", size.0, size.1);
        rig.state.look.ascii = ascii;
        for action in actions {
            rig.act(action);
            if rig.state.size.0 > 0 && rig.state.size.1 > 0 {
                let kept = rig.buffer();
                rig.state.pictures.clear();
                prop_assert_eq!(kept, rig.buffer(), "a kept picture is not what is shown");
            }
            let state = &rig.state;
            // all jobs are done: what is shown is the session
            prop_assert!(state.running.is_none() && state.waiting.is_empty());
            prop_assert!(state.wanted.is_empty() && state.wanted_step.is_none());
            prop_assert_eq!(&state.shown.values, rig.session.values());
            if state.shown.stage.is_none() {
                prop_assert_eq!(state.shown.position, rig.session.position());
            }
            prop_assert!(state.wanted_loading.is_none());
            prop_assert!(state.parameter < state.shown.values.len().max(1));
            prop_assert!(state.pair < state.shown.pairs().len().max(1));
            prop_assert!(state.plots().contains(&state.plot));
            prop_assert!(!state.moving || state.shown.at_ray());
        }
    }

    #[test]
    fn no_number_breaks_a_slider(
        value in any::<f64>().prop_filter("finite", |v| v.is_finite()),
        min in proptest::option::of(-1e300f64..1e300),
        max in proptest::option::of(-1e300f64..1e300),
        step in proptest::option::of(-1e9f64..1e9),
        tenths in any::<i8>(),
        share in any::<f64>(),
    ) {
        let parameter = crate::model::parameter::Parameter { value, formula: None, min, max, step, unit: None, about: None };
        let _ = vary::varied(value, &parameter, tenths);
        if let Some(place) = vary::share(value, &parameter) {
            prop_assert!((0.0..=1.0).contains(&place));
        }
        let _ = vary::at(share, &parameter);
    }
}
