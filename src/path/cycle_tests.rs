use super::*;

fn turn(difference: f64, net: f64) -> Turn {
    let pairs = vec![PairCycle { pair: "a".to_owned(), there: net, back: 0.0, net, total: net }];
    let difference = Some(difference);
    Turn { dissipated: [1.0; 2], pairs, difference, gap_growth: 0.0, gaps_close: false, schemes: 1, repeated: None }
}

/// Forces that come back do not make a cycle that repeats: where what it leaves behind does not, that is what is said.
#[test]
fn forces_that_repeat_without_the_slips_are_told() {
    let words = unrepeated(&[turn(0.0, 2.0), turn(0.0, 2.5)], SAME);
    assert!(words.contains("forces and gaps of cycle 2 are those of the one before to 1e-12, but not"), "{words}");
    assert!(words.contains("a slips on by 2.5 after 2 in that one"), "{words}");
    // What only comes nearer is told as before: 1e-13 · 1e-13 / 5e-15 = 2e-12 are left to come.
    let words = unrepeated(&[turn(1.05e-13, 2.0), turn(1e-13, 2.0)], SAME);
    assert!(words.contains("all later cycles together move it by 2.0e-12 more"), "{words}");
}
