//! What every target does with its bytes; `tests/bad_input/fuzz_seeds.rs` does the same with changed seeds.

use std::fs;
use std::io;
use std::time::Duration;

use stickslip::model::embedded;
use stickslip::model::load::load_text;
use stickslip::model::scenario::{Scenario, Source};
use stickslip::session::commands::sweep;
use stickslip::session::language::{complete, grammar, tokens};
use stickslip::session::{Output, Session};
use stickslip::solve::prepare;
use stickslip::view::style::Style;
use stickslip::watch::{Budget, Quiet};

/// Larger models are read, but not solved.
const NODES: usize = 60;
/// Time for one computation.
const TIME: Duration = Duration::from_millis(300);

/// A scenario: read, and solved where it is small. Whether it was read.
pub fn scenario(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    match load_text("a.json", &text, None) {
        Ok(scenario) => {
            solve(&scenario);
            true
        }
        Err(problems) => {
            assert!(
                !problems.problems.is_empty() && problems.problems.iter().all(|problem| !problem.message.is_empty())
            );
            assert!(!problems.to_string().is_empty());
            false
        }
    }
}

fn solve(scenario: &Scenario) {
    let is_small = match &scenario.source {
        Source::Structure(structure) => structure.nodes.len() <= NODES && structure.pairs.len() <= 12,
        Source::ContactSystem(system) => system.pairs.len() <= 8,
        Source::Lcp(lcp) => lcp.q.len() <= 12,
    };
    if !is_small {
        return;
    }
    let watch = Budget::new(&Quiet, TIME);
    if let Ok(prepared) = prepare(scenario, &watch)
        && let Ok(solved) = prepared.case(scenario, &scenario.parameter_values()).watched(&watch).solve()
    {
        // an answer has passed its check, or is none
        assert!(!solved.answer.is_answer() || solved.answer.check.passed);
    }
}

/// A matrix of a bare LCP in a Matrix Market file.
pub fn matrix_market(bytes: &[u8]) -> bool {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("m.mtx"), bytes).expect("a file");
    let text = r#"{ "format": "stickslip/1", "title": "t", "lcp": { "M": { "file": "m.mtx" }, "q": [1, -1] } }"#;
    match load_text("a.json", text, Some(&folder.path().join("a.json"))) {
        Ok(scenario) => {
            solve(&scenario);
            true
        }
        Err(problems) => {
            assert!(!problems.problems.is_empty());
            false
        }
    }
}

/// A line: its commands, what completes it and the hint at its end. Whether all of it are commands.
pub fn line(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let line = text.lines().next().unwrap_or_default();
    let vocabulary = Session::new(embedded::load("beam").expect("embedded"), &Quiet).expect("solved").vocabulary();
    for (at, _) in line.char_indices().chain([(line.len(), ' ')]).step_by(7) {
        let found = complete::completions(line, at, &vocabulary);
        assert!(found.start <= at && line.is_char_boundary(found.start));
    }
    complete::hint(line, &vocabulary);
    tokens::commands(line).into_iter().all(|command| match grammar::parse(command) {
        Ok(_) => true,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    })
}

/// Commands that look at nothing but the session and are quick.
const HARMLESS: &[&str] = &[
    "set",
    "reset",
    "undo",
    "redo",
    "diff",
    "params",
    "status",
    "pairs",
    "displacements",
    "members",
    "reactions",
    "show",
    "pivots",
    "step",
    "why",
    "ties",
    "ray",
    "expect",
    "echo",
    "help",
];

/// A script: the commands in it that look at nothing but the session, one after the other; the others are read only.
pub fn script(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let mut session = Session::new(embedded::load("beam").expect("embedded"), &Quiet).expect("solved");
    let mut all = true;
    for command in text.lines().flat_map(tokens::commands).take(20) {
        let Ok(Some(parsed)) = grammar::parse(command) else {
            all = false;
            continue;
        };
        let argument = tokens::split(command).ok().and_then(|words| words.get(1).cloned());
        let harmless = match parsed.command.name {
            "load" => argument.is_some_and(|name| embedded::text(&name).is_some()),
            "check" => argument.is_none(),
            name => HARMLESS.contains(&name),
        };
        if harmless {
            let watch = Budget::new(&Quiet, TIME);
            let mut nowhere = io::sink();
            let before = session.as_commands();
            let result = session.execute(command, &mut Output::text(&mut nowhere, Style::default(), &watch));
            // a command that failed has left the session as it was
            assert!(result.is_ok() || session.as_commands() == before, "{command}");
            all &= result.is_ok();
        }
    }
    all
}

/// A file of a sweep, as `merge` reads it.
pub fn sweep(bytes: &[u8]) -> bool {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("part.csv");
    fs::write(&file, bytes).expect("a file");
    match sweep::merge(&[file], None, &mut io::sink(), &Quiet) {
        Ok(_) => true,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}
