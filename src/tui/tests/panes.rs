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

/// A block on its face beside a post on a node: the map of the face, and below it the curve over the post.
#[test]
fn plots_show_faces_and_the_pairs_beside_them() {
    let text = include_str!("../../../tests/common/block-and-post.json");
    let scenario =
        crate::model::load::load_text("both.json", text, None).unwrap_or_else(|problems| panic!("{problems}"));
    for (width, height) in [(80, 24), (140, 45)] {
        let mut rig = Rig::of(scenario.clone(), width, height);
        rig.press(&["5"]);
        let screen = rig.screen();
        assert!(screen.contains("Slip |z_τ| over base"), "{screen}");
        // the post slips by (3 − 0.1 · 10)/10
        let curve = screen.lines().skip_while(|line| !line.contains("over base")).skip(1);
        assert!(curve.filter(|line| line.contains("Slip |z_τ|")).count() == 1, "{screen}");
        assert!(screen.contains("foot"), "{screen}");
    }
}

/// A structure of one node has no size, and is seen all the same.
#[test]
fn a_single_point_is_in_view() {
    let mut rig = Rig::new("bearing-two-way", 80, 24);
    rig.press(&["1"]);
    let screen = rig.screen();
    assert!(screen.contains("slip ") && screen.contains("slider"), "{screen}");
    rig.press(&["9"]);
    assert!(rig.screen().contains(":map f W"), "{}", rig.screen());
}
