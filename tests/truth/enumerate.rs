//! All answers and proofs of none, through the program: games with a known number of equilibria, continua, more than
//! ten pairs, infeasible programmes of thirty rows, matrices from files.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};

fn program(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_stickslip")).current_dir(folder).args(arguments).output().expect("the program")
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Writes an LCP and returns what `commands` print in JSON or text.
fn replay(folder: &Path, scenario: &Value, commands: &str, format: &str) -> String {
    fs::write(folder.join("case.json"), scenario.to_string()).expect("a file");
    fs::write(folder.join("case.stick"), format!("load case.json\n{commands}\n")).expect("a file");
    text(&program(folder, &["replay", "case.stick", "--format", format, "--width", "200"]))
}

fn lcp(matrix: &[Vec<f64>], q: &[f64]) -> Value {
    json!({ "format": "stickslip/1", "title": "t", "lcp": { "M": matrix, "q": q } })
}

#[test]
fn a_coordination_game_of_twelve_rows_has_63_equilibria() {
    // Costs 10 where both choose the same of six, 30 elsewhere: one equilibrium for each set of choices, 2⁶ − 1.
    let n = 6;
    let cost = |i: usize, j: usize| match ((i < n) == (j < n), i % n == j % n) {
        (true, _) => 0.0,
        (_, true) => 10.0,
        _ => 30.0,
    };
    let matrix: Vec<Vec<f64>> = (0..2 * n).map(|i| (0..2 * n).map(|j| cost(i, j)).collect()).collect();
    let folder = tempfile::tempdir().expect("a folder");
    let said = replay(folder.path(), &lcp(&matrix, &[-1.0; 12]), "enumerate", "text");
    assert!(said.contains("63 answers; 63 of 4096"), "{said}");
}

#[test]
fn a_half_line_of_answers_is_no_count() {
    // w1 = z1 − z2 + 1, w2 = −w1: (0, 1) + t (1, 1).
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = lcp(&[vec![1.0, -1.0], vec![-1.0, 1.0]], &[1.0, -1.0]);
    let said = replay(folder.path(), &scenario, "enumerate", "text");
    assert!(said.contains("infinitely many answers: one continuum with one corner"), "{said}");
    assert!(said.contains("z = (0, 1) + t (1, 1), t ≥ 0"), "{said}");
    let said = replay(folder.path(), &scenario, "enumerate", "json");
    let line = said.lines().find(|line| line.contains("continua")).expect("a report");
    let report: Value = serde_json::from_str(line).expect("JSON");
    let found = report.get("report").unwrap_or(&report);
    assert_eq!(found["undecided"], 0, "{found}");
    assert_eq!(found["continua"][0]["corners"], json!([[0.0, 1.0]]));
    assert_eq!(found["continua"][0]["directions"], json!([[1.0, 1.0]]));
}

#[test]
fn thirty_rows_that_no_z_satisfies_are_certified() {
    // Integers with eᵀM = 0 and eᵀq = −1: the sum of all w is −1.
    let n = 30usize;
    let entry = |i: usize, j: usize| ((7 * i * i + 13 * j + 5 * i * j) % 19) as f64 - 9.0;
    let mut matrix: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
    let mut q: Vec<f64> = (0..n).map(|i| (i % 5) as f64 - 2.0).collect();
    matrix[n - 1] = (0..n).map(|j| -matrix[..n - 1].iter().map(|row| row[j]).sum::<f64>()).collect();
    q[n - 1] = -1.0 - q[..n - 1].iter().sum::<f64>();
    let folder = tempfile::tempdir().expect("a folder");
    let said = replay(folder.path(), &lcp(&matrix, &q), "expect outcome ray\nexpect verdict certified\nray", "text");
    assert!(said.contains("is at most -"), "{said}");
    // One more on the right, and the sum may be 0: nothing is certified.
    q[n - 1] += 1.0;
    let said = replay(folder.path(), &lcp(&matrix, &q), "expect verdict certified", "text");
    assert!(said.contains("expected") && said.contains("certified"), "{said}");
}

#[test]
fn eleven_pairs_one_of_which_has_three_answers() {
    // R = 1 for ten pairs pressed together; Klarbring's pair: R = [[1, −1], [−1, 1.5]], f = 2, RF = (0.6, −1).
    let m = 11;
    let mut r = vec![vec![0.0; 2 * m]; 2 * m];
    for (j, row) in r.iter_mut().enumerate() {
        row[j] = 1.0;
    }
    (r[0][m], r[m][0], r[m][m]) = (-1.0, -1.0, 1.5);
    let mut load = vec![1.0; m];
    load.extend(vec![0.0; m]);
    (load[0], load[m]) = (0.6, -1.0);
    let ids: Vec<String> = (1..=m).map(|i| format!("c{i}")).collect();
    let scenario = json!({ "format": "stickslip/1", "title": "t", "contact_system": {
        "pairs": ids, "stiffness": r, "loads": { "w": { "vector": load } }, "friction": vec![2.0; m] } });
    let folder = tempfile::tempdir().expect("a folder");
    let said = replay(folder.path(), &scenario, "enumerate", "text");
    assert!(said.contains("3 answers;"), "{said}");
    assert_eq!(said.matches("proved in exact").count(), 3, "{said}");
}

#[test]
fn a_siconos_file_becomes_a_scenario_once() {
    let folder = tempfile::tempdir().expect("a folder");
    // Column by column: M = [[2, 1], [0, 3]], q = (−5, −6): z = (1.5, 2).
    fs::write(folder.path().join("small.dat"), "2\n0\n2\n2\n2\t2\n2 0\n1 3\n-5 -6\n").expect("a file");
    let first = program(folder.path(), &["import", "small.dat"]);
    assert_eq!(first.status.code(), Some(0), "{}", text(&first));
    let solved = program(folder.path(), &["solve", "small.json", "--format", "json"]);
    let answer: Value = serde_json::from_slice(&solved.stdout).expect("JSON");
    assert_eq!(answer["solution"]["z"], json!([1.5, 2.0]));
    let before = fs::read(folder.path().join("small.json")).expect("the scenario");
    let again = program(folder.path(), &["import", "small.dat"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(text(&again).contains("small.json exists already"), "{}", text(&again));
    assert_eq!(fs::read(folder.path().join("small.json")).expect("the scenario"), before);
    fs::write(folder.path().join("bad.dat"), "2\n0\n2\n2\n2\t2\n2 0\n1 x\n-5 -6\n").expect("a file");
    let bad = program(folder.path(), &["import", "bad.dat"]);
    assert_eq!(bad.status.code(), Some(2));
    assert!(text(&bad).contains("bad.dat:7:") && !folder.path().join("bad.json").exists(), "{}", text(&bad));
}

#[test]
fn an_exported_matrix_reads_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let matrix = [vec![2.0, 0.1], vec![1.0 / 3.0, 1e-3]];
    let said = replay(folder.path(), &lcp(&matrix, &[-1.0, -2.0]), "export lcp out.mtx", "text");
    assert!(said.contains("wrote out.mtx"), "{said}");
    let mut scenario = String::from(r#"{ "format": "stickslip/1", "title": "t", "#);
    write!(scenario, r#""lcp": {{ "M": {{ "file": "out.mtx" }}, "q": [-1, -2] }} }}"#).expect("a string");
    fs::write(folder.path().join("back.json"), scenario).expect("a file");
    let z = |name: &str| {
        let solved = program(folder.path(), &["solve", name, "--format", "json"]);
        let answer: Value = serde_json::from_slice(&solved.stdout).unwrap_or_else(|_| panic!("{}", text(&solved)));
        answer["solution"].clone()
    };
    assert_eq!(z("back.json"), z("case.json"));
    // Not square, and not there.
    fs::write(folder.path().join("out.mtx"), "%%MatrixMarket matrix array real general\n2 1\n1\n2\n").expect("a file");
    let bad = text(&program(folder.path(), &["check", "back.json"]));
    assert!(bad.contains("out.mtx:2: the matrix is 2 × 1"), "{bad}");
    fs::remove_file(folder.path().join("out.mtx")).expect("a file");
    let bad = text(&program(folder.path(), &["check", "back.json"]));
    assert!(bad.contains("cannot read the matrix \"out.mtx\""), "{bad}");
}
