//! What single panes do.

use super::*;

#[test]
fn all_answers_stand_side_by_side() {
    let mut rig = Rig::new("klarbring", 140, 45);
    rig.press(&["a"]);
    let Overlay::Answers { answers, .. } = &rig.state.overlay else {
        panic!("no answers");
    };
    assert!(answers.complete);
    let mut states: Vec<_> = answers.answers.iter().map(|a| a.pairs[0].state.word()).collect();
    states.sort_unstable();
    assert_eq!(states, ["open", "slip+", "stick"]);
    assert_eq!(answers.answers.iter().filter(|answer| answer.shown).count(), 1);
    let mut rig = Rig::new("greco", 80, 24);
    rig.press(&["a"]);
    // Too long for the status line, it stands in a box.
    let screen = rig.screen();
    assert!(screen.contains("at most 10"), "{screen}");
}

#[test]
fn pairs_are_sorted_and_selected() {
    let mut rig = Rig::new("plates-free", 80, 24);
    rig.press(&["3", "down", "down"]);
    assert_eq!(rig.state.pair, 2);
    rig.press(&["s", "s"]);
    let order = rig.state.order().pairs.clone();
    let slip = |i: usize| rig.state.shown.pairs()[i].z_t.abs();
    assert!(order.windows(2).all(|two| slip(two[0]) >= slip(two[1])));
    rig.press(&["pageup", "pageup"]);
    assert_eq!(rig.state.pair, order[0]);
    rig.press(&["S"]);
    assert_eq!(rig.state.order().pairs[0], *order.last().unwrap());
}

#[test]
fn the_structure_zooms_and_pans() {
    let mut rig = Rig::new("plates-free", 80, 24);
    rig.press(&["1"]);
    let all = rig.screen();
    rig.press(&["i", "i", "i"]);
    assert_ne!(rig.screen(), all);
    rig.press(&["h", "j", "l", "k", "o", "o", "o"]);
    assert_eq!(rig.screen(), all);
    rig.press(&["d"]);
    assert!(rig.screen().contains("× 2000"), "{}", rig.screen());
    rig.press(&["D", "D"]);
    assert!(rig.screen().contains("× 500"));
    rig.press(&["A"]);
    assert_eq!(rig.screen(), all);
}

/// A structure in the plane has nothing to turn; the keys say so.
#[test]
fn the_plane_is_not_turned() {
    let mut rig = Rig::new("beam", 100, 30);
    rig.press(&["1"]);
    let before = rig.screen();
    for key in ["t", "T", "w", "W", "V"] {
        rig.press(&[key]);
        let said = rig.state.message.as_ref().map(|message| message.text.clone());
        assert_eq!(said.as_deref(), Some("this structure lies in the plane: there is nothing to turn"));
    }
    assert_eq!(rig.state.turned, None);
    rig.state.message = None;
    assert_eq!(rig.screen(), before);
}
