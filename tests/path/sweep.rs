//! Sweeps: cut and continued, on one thread and on many, in one run and in shards: always the same bytes.

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use stickslip::model::embedded;
use stickslip::model::parameter::ParameterValues;
use stickslip::model::scenario::Scenario;
use stickslip::path::grid::{Axis, Grid, Shard};
use stickslip::path::merge::Shards;
use stickslip::path::sweep::{Format, Sweep};
use stickslip::path::sweep_file::{SweepFileError, run_to_file};
use stickslip::solve::{Prepared, prepare};
use stickslip::watch::{Quiet, Watch};

pub(crate) struct Case {
    pub(crate) scenario: Scenario,
    pub(crate) prepared: Prepared,
    pub(crate) values: ParameterValues,
    pub(crate) grid: Grid,
}

impl Case {
    fn new(name: &str, axes: &[&str]) -> Case {
        Case::of(embedded::load(name).expect("embedded"), axes)
    }

    pub(crate) fn of(scenario: Scenario, axes: &[&str]) -> Case {
        let axes = axes.iter().map(|axis| Axis::parse(axis).expect("an axis")).collect();
        Case {
            prepared: prepare(&scenario, &Quiet).expect("sound"),
            values: scenario.parameter_values(),
            grid: Grid::new(&scenario, axes).expect("a grid"),
            scenario,
        }
    }

    pub(crate) fn sweep(&self, shard: &str, format: Format) -> Sweep<'_> {
        Sweep {
            case: self.prepared.case(&self.scenario, &self.values),
            grid: &self.grid,
            shard: shard.parse::<Shard>().expect("a shard"),
            format,
            quantities: &[],
        }
    }

    fn bytes(&self, shard: &str, format: Format) -> Vec<u8> {
        let sweep = self.sweep(shard, format);
        let mut out = sweep.preamble().into_bytes();
        let done = sweep.run(0, &mut out, &Quiet).expect("a vector takes all");
        assert!(done.is_complete());
        out
    }
}

/// What the files make together.
fn merged(files: &[PathBuf]) -> Result<(usize, Vec<u8>), SweepFileError> {
    let shards = Shards::open(files, &Quiet)?;
    let mut out = Vec::new();
    shards.write(&mut out, &Quiet)?;
    Ok((shards.rows(), out))
}

/// Stops after this many questions, as Ctrl-C at some moment does.
struct Stop(AtomicUsize);

impl Watch for Stop {
    fn stop(&self) -> bool {
        let left = |left: usize| Some(left.saturating_sub(1));
        self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, left) <= Ok(1)
    }
}

fn cut_and_continue(case: &Case, patience: usize) {
    let folder = tempfile::tempdir().expect("a place");
    let path = folder.path().join("sweep.csv");
    let whole = case.bytes("1/1", Format::Csv);
    let sweep = case.sweep("1/1", Format::Csv);
    let mut rounds = 0;
    loop {
        let watch = Stop(AtomicUsize::new(patience));
        let done = run_to_file(&sweep, &path, rounds > 0, &watch).expect("written");
        rounds += 1;
        let now = fs::read(&path).expect("there");
        assert!(whole.starts_with(&now), "what is kept is the beginning of the whole");
        if done.is_complete() {
            break;
        }
        // As after a crash: the last row only half there.
        if rounds == 2 && now.len() > 2000 {
            fs::write(&path, &now[..now.len() - 7]).expect("written");
        }
    }
    assert!(rounds > 2, "{rounds}");
    assert_eq!(fs::read(&path).expect("there"), whole);
    // Nothing left to do; and without --resume nothing is overwritten.
    let again = run_to_file(&sweep, &path, true, &Quiet).expect("complete");
    assert_eq!((again.written, again.found), (0, case.grid.len()));
    assert!(matches!(run_to_file(&sweep, &path, false, &Quiet), Err(SweepFileError::Exists(_))));
    let other = case.sweep("1/2", Format::Csv);
    assert!(matches!(run_to_file(&other, &path, true, &Quiet), Err(SweepFileError::Another { what: "shard", .. })));
}

#[test]
fn a_sweep_that_was_cut_is_continued_to_the_same_bytes() {
    cut_and_continue(&Case::new("beam", &["f=0:1:0.05", "F2=0:400:5"]), 700);
}

#[test]
#[ignore = "100 000 answers: a minute in debug"]
fn a_hundred_thousand_answers_are_cut_and_continued() {
    let case = Case::new("beam", &["f=0..1/50", "F2=0..400/100", "F=50..150/20"]);
    assert_eq!(case.grid.len(), 100_000);
    cut_and_continue(&case, 40_000);
}

#[test]
fn threads_and_shards_change_no_byte() {
    let case = Case::new("beam", &["f=0:1:0.1", "F2=0..400/41"]);
    for format in [Format::Csv, Format::Json] {
        let whole = case.bytes("1/1", format);
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            assert_eq!(pool.install(|| case.bytes("1/1", format)), whole);
        }
        let folder = tempfile::tempdir().expect("a place");
        let mut files: Vec<PathBuf> = Vec::new();
        // Any order of the files does.
        for k in [3, 1, 2] {
            let path = folder.path().join(format!("part-{k}"));
            let sweep = case.sweep(&format!("{k}/3"), format);
            run_to_file(&sweep, &path, true, &Quiet).expect("written");
            files.push(path);
        }
        assert_eq!(merged(&files).expect("complete"), (case.grid.len(), whole));
        let missing = merged(&files[..2]).expect_err("shard 2 is missing");
        assert_eq!(missing.to_string(), "shard 2 of 3 is missing");
        let twice = [files.clone(), vec![files[0].clone()]].concat();
        assert!(merged(&twice).expect_err("twice").to_string().contains("twice"));
        let text = fs::read(&files[1]).expect("there");
        fs::write(&files[1], &text[..text.len() - 5]).expect("written");
        let short = merged(&files).expect_err("cut").to_string();
        assert!(short.contains("is not complete"), "{short}");
    }
}

#[test]
fn altered_rows_are_refused() {
    let case = Case::new("beam", &["F2=0:400:50"]);
    for format in [Format::Csv, Format::Json] {
        let folder = tempfile::tempdir().expect("a place");
        let path = folder.path().join("rows");
        let sweep = case.sweep("1/1", format);
        run_to_file(&sweep, &path, false, &Quiet).expect("written");
        let whole = fs::read_to_string(&path).expect("there");
        let lines: Vec<&str> = whole.split_inclusive('\n').collect();
        let first = lines.len() - case.grid.len();
        let joined = |lines: &[&str]| lines.concat();
        let mut exchanged = lines.clone();
        exchanged.swap(first + 2, first + 3);
        let mut repeated = lines.clone();
        repeated[first + 4] = lines[first + 3];
        let mut without = lines.clone();
        without.remove(first + 1);
        // every character of a row counts: one digit, one word, the checksum itself
        let row = lines[first + 3];
        let mut altered: Vec<String> = [joined(&exchanged), joined(&repeated), joined(&without)].into();
        for (at, c) in row.char_indices().filter(|(_, c)| c.is_ascii_alphanumeric()) {
            let other = if c == '7' { '3' } else { '7' };
            let row = format!("{}{other}{}", &row[..at], &row[at + 1..]);
            altered.push(whole.replacen(lines[first + 3], &row, 1));
        }
        for text in altered {
            fs::write(&path, &text).expect("written");
            let resumed = run_to_file(&sweep, &path, true, &Quiet).expect_err("altered");
            assert!(matches!(resumed, SweepFileError::Row { .. }), "{resumed}");
            assert_eq!(fs::read_to_string(&path).expect("there"), text, "nothing was written");
            let mut out = Vec::new();
            let refused =
                Shards::open(std::slice::from_ref(&path), &Quiet).map(|shards| shards.write(&mut out, &Quiet));
            assert!(matches!(refused, Err(SweepFileError::Row { .. })));
        }
        // rows of another sweep with the same points
        let other = Case::new("beam-limit", &["F2=0:400:50"]);
        let foreign = String::from_utf8(other.bytes("1/1", format)).expect("text");
        let body: Vec<&str> = foreign.split_inclusive('\n').skip(first).collect();
        fs::write(&path, format!("{}{}", lines[..first].concat(), body.concat())).expect("written");
        assert!(matches!(run_to_file(&sweep, &path, true, &Quiet), Err(SweepFileError::Row { row: 1, .. })));
        // a header that states other points
        for (from, to, part) in [
            ("F2=0:400:50", "F2=0:200:25", "row 2 is not"),
            ("F2=0:400:50", "F2=0:200:50", "tells 9 points"),
            ("\"points\":9", "\"points\":5", "tells 5 points"),
            ("F2=0:400:50", "F2=0:400", "cannot read"),
        ] {
            assert!(lines[0].contains(from), "{}", lines[0]);
            fs::write(&path, whole.replacen(from, to, 1)).expect("written");
            let error = merged(std::slice::from_ref(&path)).expect_err(to).to_string();
            assert!(error.contains(part), "{error}");
        }
        // an earlier version
        fs::write(&path, whole.replacen("stickslip-sweep/2", "stickslip-sweep/1", 1)).expect("written");
        for error in [
            run_to_file(&sweep, &path, true, &Quiet).expect_err("version 1").to_string(),
            merged(std::slice::from_ref(&path)).expect_err("version 1").to_string(),
        ] {
            assert!(error.contains("earlier version") && error.contains("run the sweep again"), "{error}");
        }
    }
}

/// Shards of scenarios of other names, other texts, or other meshes and matrices behind the same text.
#[test]
fn shards_of_other_scenarios_are_refused() {
    let folder = tempfile::tempdir().expect("a place");
    let at = |name: &str| folder.path().join(name);
    let mesh = |height: f64| {
        format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 {height} 0\n4 0 {height} 0\n\
             $EndNodes\n$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n"
        )
    };
    let chain = |k: f64| format!("%%MatrixMarket matrix array real general\n2 2\n{k}\n0\n0\n{k}\n");
    let by_mesh = r#"{"format": "stickslip/1", "title": "t", "parameters": {"f": 0.5}, "materials": {"m": {"E": 1e3, "nu": 0, "density": 1}},
        "meshes": [{"id": "m", "file": "a.msh", "materials": {"*": {"material": "m", "thickness": 1, "plane": "stress"}}}],
        "contacts": [{"id": "c", "edge": "m.bottom", "against": "ground", "friction": "f"}],
        "loads": {"w": {"items": [{"gravity": {"acceleration": [0, -1]}}]}}}"#;
    let by_matrix = r#"{"format": "stickslip/1", "title": "t", "parameters": {"f": 0.5},
        "superelement": {"stiffness": {"file": "k.mtx"}, "nodes": {"a": [0, 0]}, "dofs": [["a", "x"], ["a", "y"]]},
        "contacts": [{"id": "c", "node": "a", "against": "ground", "normal": [0, 1], "friction": "f"}],
        "loads": {"w": {"items": [{"point": {"at": "a", "force": [1, -1]}}]}}}"#;
    let shard = |text: &str, file: &str, [height, stiffness]: [f64; 2], number: &str| -> PathBuf {
        fs::write(at("a.msh"), mesh(height)).expect("written");
        fs::write(at("k.mtx"), chain(stiffness)).expect("written");
        fs::write(at(file), text).expect("written");
        let scenario = stickslip::model::load::load_file(&at(file)).unwrap_or_else(|error| panic!("{error}"));
        let rows = Case::of(scenario, &["f=0.2:0.8:0.2"]).bytes(number, Format::Csv);
        let path = at(&format!("{}.csv", number.replace('/', "-")));
        fs::write(&path, rows).expect("written");
        path
    };
    for (text, changed) in [(by_mesh, [2.0, 1.0]), (by_matrix, [1.0, 2.0])] {
        let first = shard(text, "s.json", [1.0, 1.0], "1/2");
        let second = |file: &str, values: [f64; 2]| merged(&[first.clone(), shard(text, file, values, "2/2")]);
        assert_eq!(second("s.json", [1.0, 1.0]).expect("one sweep").0, 4);
        let error = second("other.json", [1.0, 1.0]).expect_err("another name").to_string();
        assert!(error.contains("its scenario is other.json, here it is s.json"), "{error}");
        let error = second("s.json", changed).expect_err("another file").to_string();
        assert!(error.contains("its hash of the scenario"), "{error}");
    }
}

#[test]
fn rows_say_what_was_found() {
    let case = Case::new("beam", &["F2=100:400:150"]);
    let text = String::from_utf8(case.bytes("1/1", Format::Csv)).expect("text");
    let rows: Vec<&str> = text.lines().skip(1).collect();
    assert_eq!(
        rows[0],
        "F2,outcome,class,p,pivots,open,stick,slip+,slip-,closed,max_slip,max_slip_pair,max_gap,max_gap_pair,\
         max_x_n,max_x_n_pair,failure,checksum"
    );
    assert!(rows[1].starts_with("100.0,normal,,0.0,"), "{}", rows[1]);
    assert!(rows[3].starts_with("400.0,ray,mechanism,11.11"), "{}", rows[3]);
    // z_1 = (L/EA) r n (n+1)/2 at F2 = n r, here n = 5, r = 50.
    let cells: Vec<&str> = rows[2].split(',').collect();
    let slip: f64 = cells[10].parse().expect("a number");
    assert!((slip - 1e-5 * 50.0 * 10.0).abs() < 1e-12, "{slip}");
    assert_eq!(cells[11], "c6");
}

/// The largest slip is a size: pulled or pushed by the same force the beam slips as far.
#[test]
fn the_largest_slip_of_a_row_is_its_size() {
    let case = Case::new("beam", &["F2=-250:250:500"]);
    let text = String::from_utf8(case.bytes("1/1", Format::Csv)).expect("text");
    let rows: Vec<Vec<&str>> = text.lines().skip(2).map(|row| row.split(',').collect()).collect();
    assert_eq!(rows.iter().map(|cells| cells[0]).collect::<Vec<_>>(), ["-250.0", "250.0"]);
    for (cells, senses) in rows.iter().zip([["0", "4"], ["4", "0"]]) {
        // Five pairs reach their bound of 50, the last of them just: four slip, z as in `rows_say_what_was_found`.
        let slip: f64 = cells[10].parse().expect("a number");
        assert!((slip - 1e-5 * 50.0 * 10.0).abs() < 1e-12, "{cells:?}");
        assert_eq!((&cells[7..9], cells[11]), (&senses[..], "c6"));
    }
}
