//! Lines of random words: nothing panics, and a command that fails leaves the session as it was.

use rand::{Rng, SeedableRng};

use super::{line, session, shown, state};

/// Words of the language, of the scenarios, and of none.
const WORDS: &[&str] = &[
    "load",
    "scenarios",
    "params",
    "set",
    "reset",
    "undo",
    "redo",
    "diff",
    "solve",
    "status",
    "pairs",
    "displacements",
    "members",
    "reactions",
    "check",
    "pivots",
    "step",
    "why",
    "ray",
    "plot",
    "view",
    "XZ",
    "expect",
    "echo",
    "help",
    "history",
    "export",
    "save",
    "source",
    "record",
    "restore",
    "beam",
    "beam-ray",
    "frame",
    "klarbring",
    "gap",
    "murty6",
    "painleve",
    "f",
    "F2",
    "F",
    "q",
    "H",
    "auto",
    "on",
    "off",
    "covering",
    "weight",
    "ones",
    "cohesive",
    "tie-break",
    "natural",
    "random:3",
    "lexicographic",
    "engine",
    "scheme",
    "0.3",
    "120",
    "-5",
    "+10%",
    "110%",
    "+=",
    "-=",
    "*=",
    "/=",
    "=",
    "1e308",
    "1e-308",
    "nan",
    "inf",
    "0",
    "c1",
    "c6",
    "c1..c6",
    "sort",
    "z_t",
    "first",
    "last",
    "back",
    "to",
    "2",
    "99999999999999999999",
    "..",
    "1..",
    "slip",
    "force",
    "structure",
    "p",
    "moment",
    "--at",
    "--width",
    "40",
    "--height",
    "first,last",
    "--help",
    "-h",
    "--",
    "AB",
    "A",
    "outcome",
    "normal",
    "ray",
    "state",
    "stick",
    "x_n",
    "±",
    "+-",
    "<",
    ">=",
    "error",
    "\"a b\"",
    "'",
    "\"",
    "\\",
    "#",
    ";",
    "ü",
    "€",
    "\u{0}",
    "\u{1b}[31m",
    "\u{200b}",
    "out.csv",
    "out.json",
    "discard",
    "tui",
    "tour",
    "set f",
    "pairs c1 sort",
    "expect p",
];

#[test]
fn ten_thousand_random_lines_neither_panic_nor_change_the_session_wrongly() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(2020);
    let mut session = session("beam");
    let mut failed = 0;
    for _ in 0..10_000 {
        let text: String = if random.random_bool(0.1) {
            let length = random.random_range(0..60);
            let bytes: Vec<u8> = (0..length).map(|_| random.random()).collect();
            String::from_utf8_lossy(&bytes).into_owned()
        } else {
            let count = random.random_range(0..6);
            let words: Vec<&str> = (0..count).map(|_| WORDS[random.random_range(0..WORDS.len())]).collect();
            words.join(if random.random_bool(0.05) { "" } else { " " })
        };
        for command in stickslip::session::language::tokens::commands(&text) {
            // nothing outside the folder of this test is written
            let writes = stickslip::session::language::tokens::split(command).is_ok_and(|words| {
                words.first().is_some_and(|word| {
                    ["save", "sa", "sav", "export", "exp", "expo", "expor", "record", "rec", "reco", "recor"]
                        .contains(&word.as_str())
                })
            });
            let command = if writes {
                let file = folder.path().join("x.csv");
                format!("export pairs {}", file.display())
            } else {
                command.to_owned()
            };
            let before = state(&session);
            let (_, result) = line(&mut session, &command);
            if result.is_err() {
                failed += 1;
                assert_eq!(state(&session), before, "{command:?}");
            }
        }
        assert!(session.values().values().all(|value| value.is_finite()));
    }
    assert!(failed > 1000, "{failed}");
    // the session still works
    shown(&mut session, "set auto on; load beam; set f 0.3; set F2 150; expect z_t c6 = 0.003 ± 1e-12");
}
