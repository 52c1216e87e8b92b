//! Rows of tables: ranges, patterns, sorting, the first of them; scripts that say their commands.

use stickslip::session::{Output, Session, script};
use stickslip::view::style::Style;
use stickslip::watch::Quiet;

use super::lines::{embedded, report};

fn rows(session: &mut Session, command: &str, key: &str) -> Result<Vec<String>, String> {
    let report = report(session, command)?;
    let rows = report.as_array().unwrap_or_else(|| panic!("{report}"));
    Ok(rows.iter().map(|row| row[key].as_str().expect("a name").to_owned()).collect())
}

/// Example 1: the slips grow towards c6 (c3 … c6 slip), c1 and c2 hold; the normal forces in the bars grow likewise.
#[test]
fn rows_are_chosen_sorted_and_cut() {
    let mut beam = embedded("beam");
    for (command, key, expected) in [
        ("pairs c2..c4", "id", &["c2", "c3", "c4"][..]),
        ("pairs c4..c2", "id", &["c4", "c3", "c2"]),
        ("pairs c1,c6", "id", &["c1", "c6"]),
        ("pairs * top 2", "id", &["c6", "c5"]),
        ("pairs sort z_t top 3", "id", &["c6", "c5", "c4"]),
        ("pairs c3..c6 top 1 sort reserve", "id", &["c3"]),
        ("displacements s2..s3", "node", &["s2", "s3"]),
        ("displacements s* sort ux top 2", "node", &["s6", "s5"]),
        ("displacements top 1", "node", &["s6"]),
        ("members b2..b3 b5", "bar", &["b2", "b3", "b5"]),
        ("members sort N top 2", "bar", &["b5", "b4"]),
        ("members b* top 9", "bar", &["b1", "b2", "b3", "b4", "b5"]),
    ] {
        let found = rows(&mut beam, command, key).unwrap_or_else(|error| panic!("{command}: {error}"));
        assert_eq!(found, expected, "{command}");
    }
    // Names with commas in brackets, and what stands before a bracket.
    let mut plates = embedded("plates-free");
    assert_eq!(rows(&mut plates, "displacements upper[0,0]..upper[2,0]", "node").unwrap().len(), 3);
    assert_eq!(rows(&mut plates, "displacements upper[0,0],lower[1,1]", "node").unwrap(), ["upper[0,0]", "lower[1,1]"]);
    for command in ["pairs joint[1..3]", "pairs joint[1]..joint[3]"] {
        assert_eq!(rows(&mut plates, command, "id").unwrap(), ["joint[1]", "joint[2]", "joint[3]"], "{command}");
    }
    let upper = rows(&mut plates, "displacements upper", "node").unwrap();
    assert!(upper.len() > 9 && upper.iter().all(|node| node.starts_with("upper[")), "{upper:?}");
}

#[test]
fn wrong_rows_are_refused() {
    let mut beam = embedded("beam");
    for (command, part) in [
        ("pairs c9", "no pair `c9`"),
        ("pairs d*", "no pair `d*`"),
        ("pairs c[1..3]", "no pair `c[1]`"),
        ("pairs sort slip", "no sort key `slip`"),
        ("pairs sort", "`sort` takes one of id, state"),
        ("displacements s1..s9", "no node `s9`"),
        ("displacements sort uz", "no sort key `uz`"),
        ("members top", "`top` takes a number of rows"),
        ("members top 0", "`top` takes a number of rows"),
        ("members sort M b1", "`b1` makes no sense behind `sort` or `top`"),
        ("members b7", "no bar `b7`"),
    ] {
        let error = rows(&mut beam, command, "bar").expect_err(command);
        assert!(error.contains(part), "{command}: {error}");
    }
}

#[test]
fn a_script_says_its_commands_where_that_is_asked_for() {
    let replay = |echo: bool| {
        let mut text = Vec::new();
        let mut io = Output::text(&mut text, Style::default(), &Quiet);
        io.echo = echo;
        let script = "set F2 40; expect outcome answer\n\n# a comment\necho done\n";
        script::run(&mut embedded("beam"), "s", script, false, &mut io, &mut |error| panic!("{error}")).expect("runs");
        String::from_utf8(text).expect("text")
    };
    let said = replay(true);
    let echoed: Vec<&str> = said.lines().filter(|line| line.starts_with("> ")).collect();
    assert_eq!(echoed, ["> set F2 40", "> expect outcome answer", "> echo done"]);
    let without: String = said.lines().filter(|line| !line.starts_with("> ")).map(|line| format!("{line}\n")).collect();
    assert_eq!(without, replay(false));
}
