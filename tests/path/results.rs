//! `expect result`: what the commands with a result of their own found, in a script.

use stickslip::model::embedded;
use stickslip::session::Session;

use super::find::{beam, report, session};

fn all(session: &mut Session, lines: &str) {
    for line in lines.lines().map(str::trim).filter(|line| !line.is_empty()) {
        report(session, line).unwrap_or_else(|why| panic!("{line}: {why}"));
    }
}

/// The beam slides at F2 = 6 f F = 600 f; supports from the end on slip at every hundred f before. Areas of f 0…1, F2
/// 0…400: the triangles under 100 f are 50 each, cut off by F2 = 400 from 400 f on.
#[test]
fn every_result_can_be_expected() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("proof.json");
    let mut session = beam();
    all(
        &mut session,
        "map f 0..1 F2 0..400
        expect result regions[0].area = 50 ± 1e-9
        expect result regions[3].area = 50 ± 1e-9
        expect result regions[4].area = 40 ± 1e-9
        expect result regions[5].area = 80/3 ± 1e-9
        expect result regions[-1].area = 400/3 ± 1e-9
        expect result regions[-1].outcome = ray
        set F2 150
        sample f=uniform(0.2,0.6)
        expect result collapse = 0.125 ± 1e-12
        expect result exact = true
        find least f where outcome answer
        expect result value = 0.25 ± 1e-9
        set f 0.3
        cycle F2 0..60
        expect result kind = shakes-down
        expect result cycles[-1].dissipated[0] = 0
        cycle F2 0..61
        expect result kind != shakes-down
        expect result cycles[-1].dissipated[0] = 3e-4 ± 1e-12
        limit cycle F2
        expect result shakes_down = 60 ± 1e-6",
    );
    all(&mut session, &format!("prove {}\nexpect result claim = answer", file.display()));
    for (words, part) in [
        ("kind = answer", "no key `kind`; there are claim, sentence, answers, file, system"),
        ("claim = collapse", "expected claim = collapse, found answer"),
        ("claim", "claim is answer: expected `= WORD` or `!= WORD`"),
        ("claim[0] = 1", "nothing has a key `0` there"),
        ("", "expected `expect result KEY OP VALUE`"),
    ] {
        let why = report(&mut session, &format!("expect result {words}")).unwrap_err();
        assert!(why.contains(part), "{words}: {why}");
    }
    let why = report(&mut beam(), "expect result kind = x").unwrap_err();
    assert!(why.contains("no result yet"), "{why}");
}

#[test]
fn the_friction_found_by_calibrate_can_be_expected() {
    let mut session = session(embedded::load("pipeline").expect("embedded"));
    report(&mut session, "set f 0.3").unwrap();
    let slips = report(&mut session, "show z_t c1, z_t c6").unwrap();
    let slip = |k: usize| slips[k]["value"].as_f64().unwrap();
    let lines = format!(
        "set f 0.5
        calibrate f where z_t c1 = {:e}, z_t c6 = {:e}
        expect result groups[0].value = 0.3 ± 1e-6
        expect result groups[0].identifiable = true",
        slip(0),
        slip(1)
    );
    all(&mut session, &lines);
}
