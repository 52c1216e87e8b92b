//! Measurements as JSON lines, for `benches/against.py` and by hand; see `benches/README.md`.
//!
//! ```text
//! measure engine PAIRS F T one-sided|symmetric [FOLDER]   exports M, q, d to FOLDER; a run per line read from stdin
//! measure warm PAIRS F T REPETITIONS                      cold, load changed, friction changed
//! measure resolve NX NY REPETITIONS                       a load inside the model moved, a size moved
//! measure trace PAIRS F T                                 the pull from 0 to T: cost of a breakpoint, of a pivot
//! measure sweep PAIRS F T POINTS THREADS [stands]         pulls up to T; `stands`: springs hold the upper plate
//! measure condense NX NY WIDTH HEIGHT CASES [plain]       two plates; `plain`: also faer's own factorization
//! measure schur NX NY WIDTH HEIGHT FOLDER                 exports K_m and C of the same to FOLDER, and condenses it
//! measure space NX NY NZ FACETS [FOLDER]                  bricks on a plane: condensed (K_m and C to FOLDER),
//!                                                         solved on the polygon and on Coulomb's cone
//! measure given PAIRS                                     the check of a given matrix, and a Cholesky factorization
//! measure exact PAIRS F                                   the exact check of an answer
//! ```

use std::fs::File;
use std::io::{BufRead, BufWriter, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use faer::Side;
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use serde_json::{Value, json};

use plates::{Plates, Pull, Ready, brick_block};
use stickslip::answer::same::same_answer;
use stickslip::contact::full_lcp::full_lcp;
use stickslip::contact::lcp::contact_lcp;
use stickslip::export::lcp::matrix_market;
use stickslip::fem::MainSystem;
use stickslip::lcp::basis_solution::vertex;
use stickslip::lcp::driver::run;
use stickslip::lcp::lemke::SchemeEngine;
use stickslip::model::pair::{Joint, joints};
use stickslip::model::rules::TieBreak;
use stickslip::model::scenario::{Scenario, Source};
use stickslip::model::structure::Structure;
use stickslip::path::grid::{Axis, Grid, Shard};
use stickslip::path::load::{self, LoadReach};
use stickslip::path::sweep::{Format, Sweep};
use stickslip::solve::engines::run_scheme;
use stickslip::solve::prepare;
use stickslip::watch::Quiet;

/// Seconds that `work` takes.
fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let clock = Instant::now();
    let result = work();
    (clock.elapsed().as_secs_f64(), result)
}

fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}

/// Largest resident memory of this process so far.
fn peak_megabytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1024.0)
}

type Failure = Box<dyn std::error::Error>;

fn number<T: std::str::FromStr>(arguments: &[String], at: usize, name: &str) -> Result<T, Failure> {
    let word = arguments.get(at).ok_or_else(|| format!("{name} is missing"))?;
    word.parse().map_err(|_| format!("{name}: `{word}` is no such number").into())
}

/// Engine runs on request, so that another program can time its own runs in between.
fn engine(arguments: &[String]) -> Result<(), Failure> {
    let symmetric = arguments.get(3).is_some_and(|word| word == "symmetric");
    let ready = Ready::new(&Plates {
        traction: number(arguments, 2, "T")?,
        pull: if symmetric { Pull::Symmetric } else { Pull::OneSided },
        ..Plates::with_pairs(number(arguments, 0, "PAIRS")?, number(arguments, 1, "F")?)
    });
    let system = ready.prepared.system().ok_or("no contact system")?;
    let covering = ready.scenario.rules.covering;
    let problem = ready.problem(&ready.values(&[]));
    if let Some(folder) = arguments.get(4) {
        let whole = full_lcp::<f64>(&problem, covering);
        let column = |entries: &[f64]| entries.iter().map(|entry| vec![*entry]).collect::<Vec<_>>();
        let folder = Path::new(folder);
        for (name, rows) in [("M", &whole.matrix), ("q", &column(&whole.q)), ("d", &column(&whole.covering))] {
            let mut out = BufWriter::new(File::create(folder.join(format!("{name}.mtx")))?);
            matrix_market(&mut out, rows, name)?;
            out.flush()?;
        }
    }
    let mut out = std::io::stdout();
    writeln!(out, "{}", json!({ "pairs": system.pairs.len() }))?;
    for line in std::io::stdin().lock().lines() {
        line?;
        let (form, contact) = timed(|| contact_lcp(&problem, covering));
        let contact = contact?;
        let rule = contact.tie_rule(TieBreak::Lexicographic);
        let (pivoting, (engine, mut result)) = timed(|| {
            let mut engine = SchemeEngine::new(Arc::clone(&contact.lcp), rule);
            let result = run(&mut engine, 1_000_000, &mut |_| ControlFlow::Continue(()));
            (engine, result)
        });
        let (last, fresh) = timed(|| vertex(&contact.lcp, &result.pivots.basis()));
        if let Some(point) = fresh {
            result.point = point;
        }
        let refreshes = engine.refreshes();
        let outcome = format!("{:?}", result.outcome);
        let outcome = outcome.split([' ', '(']).next().unwrap_or_default();
        writeln!(
            out,
            "{}",
            json!({
                "seconds": form + pivoting + last,
                "form": form,
                "pivoting": pivoting,
                "vertex": last,
                "outcome": outcome,
                "pivots": result.pivots.count(),
                "refreshes": refreshes,
                "z": contact.in_units(&result.point).z,
            })
        )?;
    }
    Ok(())
}

/// Whole answers, check included: cold, and followed from the last one there and back again, `REPETITIONS` times.
fn warm(arguments: &[String]) -> Result<Value, Failure> {
    let (pairs, friction): (usize, f64) = (number(arguments, 0, "PAIRS")?, number(arguments, 1, "F")?);
    let traction: f64 = number(arguments, 2, "T")?;
    let repetitions: usize = number(arguments, 3, "REPETITIONS")?;
    let ready = Ready::new(&Plates { traction, ..Plates::with_pairs(pairs, friction) });
    let rules = ready.scenario.rules;
    let cold = |changes: &[(&str, f64)]| {
        timed(|| ready.prepared.case(&ready.scenario, &ready.values(changes)).under(rules).solve())
    };
    let mut colds = (Vec::new(), Vec::new());
    let mut changed = serde_json::Map::new();
    for (name, parameter, value) in [
        ("load +2 %", "T", 1.02 * traction),
        ("load -2 %", "T", 0.98 * traction),
        ("load +20 %", "T", 1.2 * traction),
        ("f +1 %", "f", 1.01 * friction),
        ("f +2 %", "f", 1.02 * friction),
        ("f -2 %", "f", 0.98 * friction),
    ] {
        let there = ready.values(&[(parameter, value)]);
        let back = ready.values(&[]);
        let expected = cold(&[(parameter, value)]).1?;
        let (mut whole, mut path) = (Vec::new(), Vec::new());
        let (mut changes, mut same, mut failed) = (0, true, 0);
        for _ in 0..repetitions {
            let (seconds, last) = cold(&[]);
            let mut last = last?;
            colds.0.push(seconds);
            colds.1.push(last.answer.timings.lemke);
            for round in 0..6 {
                let values = if round % 2 == 0 { &there } else { &back };
                let (seconds, followed) =
                    timed(|| ready.prepared.case(&ready.scenario, values).under(rules).follow(&last));
                let Some(followed) = followed else {
                    failed += 1;
                    break;
                };
                whole.push(seconds);
                path.push(followed.answer.timings.lemke);
                if let stickslip::answer::record::Start::Warm { changes: made } = followed.answer.start {
                    changes = made;
                }
                if round % 2 == 0 {
                    same &= same_answer(&followed.answer, &expected.answer);
                }
                last = followed;
            }
        }
        let found = (!whole.is_empty()).then(|| {
            json!({
                "whole": median(whole), "path": median(path), "changes": changes, "same": same,
            })
        });
        changed.insert(name.to_owned(), json!({ "failed": failed, "found": found }));
    }
    Ok(json!({
        "pairs": pairs, "f": friction,
        "cold_whole": median(colds.0), "cold_lemke": median(colds.1), "changed": changed,
    }))
}

/// Seconds that the present threads of this process have computed; no number (`null` in JSON) where the system does not
/// tell.
fn cpu_seconds() -> f64 {
    let Ok(tasks) = std::fs::read_dir("/proc/self/task") else { return f64::NAN };
    let nanoseconds = |task: std::fs::DirEntry| -> Option<f64> {
        std::fs::read_to_string(task.path().join("schedstat")).ok()?.split(' ').next()?.parse().ok()
    };
    1e-9 * tasks.flatten().filter_map(nanoseconds).sum::<f64>()
}

/// The work, its seconds by the clock and those that all threads computed.
fn computed<T>(work: impl FnOnce() -> T) -> (f64, f64, T) {
    let (clock, before) = (Instant::now(), cpu_seconds());
    let result = work();
    (clock.elapsed().as_secs_f64(), cpu_seconds() - before, result)
}

/// The path of a load: what a breakpoint costs, compared with a pivot of a cold run at its end.
fn trace(arguments: &[String]) -> Result<Value, Failure> {
    let pairs: usize = number(arguments, 0, "PAIRS")?;
    let (friction, traction): (f64, f64) = (number(arguments, 1, "F")?, number(arguments, 2, "T")?);
    let ready = Ready::new(&Plates { traction, ..Plates::with_pairs(pairs, friction) });
    let none = ready.values(&[("T", 0.0)]);
    let start = ready.prepared.case(&ready.scenario, &none).solve()?;
    let reach = LoadReach { to: Some(traction), through: false };
    let mut seconds = Vec::new();
    let mut knots = 0;
    for _ in 0..5 {
        let (_, cpu, path) =
            computed(|| load::trace(ready.prepared.case(&ready.scenario, &none), Some(&start), "T", reach));
        knots = path?.factors.len() - 1;
        seconds.push(cpu);
    }
    let end = ready.values(&[]);
    let contact = contact_lcp(&ready.problem(&end), ready.scenario.rules.covering)?;
    let rule = contact.tie_rule(ready.scenario.rules.tie_break);
    let (_, lemke, run) = computed(|| run_scheme(&contact.lcp, rule, &Quiet));
    let a_knot = median(seconds.clone()) / knots as f64;
    Ok(json!({
        "pairs": pairs, "f": friction, "knots": knots, "seconds": median(seconds), "a_knot": a_knot,
        "a_pivot": lemke / run.pivots.count() as f64,
    }))
}

/// A sweep over the pull.
fn sweep(arguments: &[String]) -> Result<Value, Failure> {
    let pairs: usize = number(arguments, 0, "PAIRS")?;
    let (friction, traction): (f64, f64) = (number(arguments, 1, "F")?, number(arguments, 2, "T")?);
    let (points, threads): (usize, usize) = (number(arguments, 3, "POINTS")?, number(arguments, 4, "THREADS")?);
    let plates = Plates { traction, ..Plates::with_pairs(pairs, friction) };
    let scenario = match arguments.get(5).map(String::as_str) {
        Some("stands") => plates.standing_scenario(),
        _ => plates.scenario(),
    };
    let (prepared, values) = (prepare(&scenario, &Quiet)?, scenario.parameter_values());
    let grid = Grid::new(&scenario, vec![Axis::counted("T", 0.5 * traction, traction, points)?])?;
    let case = prepared.case(&scenario, &values);
    let sweep = Sweep { case, grid: &grid, shard: Shard::WHOLE, format: Format::Csv, quantities: &[] };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let (mut clocks, mut cpus) = (Vec::new(), Vec::new());
    for _ in 0..3 {
        let (clock, cpu, done) = computed(|| pool.install(|| sweep.run(0, &mut std::io::sink(), &Quiet)));
        done?;
        clocks.push(clock / points as f64);
        cpus.push(cpu / points as f64);
    }
    let (clock, processor) = (median(clocks), median(cpus));
    Ok(json!({
        "pairs": pairs, "f": friction, "points": points, "threads": threads, "clock": clock, "processor": processor,
    }))
}

/// What a parameter inside the loads and one of the geometry cost when they move: making ready, and the whole answer.
fn resolve(arguments: &[String]) -> Result<Value, Failure> {
    let divisions = [number(arguments, 0, "NX")?, number(arguments, 1, "NY")?];
    let repetitions: usize = number(arguments, 2, "REPETITIONS")?;
    let scenario = Plates { divisions, ..Plates::with_pairs(2, 0.4) }.inner_scenario();
    let mut prepared = prepare(&scenario, &Quiet)?;
    let mut medians = serde_json::Map::new();
    let mut size = None;
    for (what, parameter, here, there) in [("load", "T", 60.0, 61.0), ("geometry", "b", 8.0, 8.1)] {
        let (mut ready, mut whole) = (Vec::new(), Vec::new());
        for round in 0..2 * repetitions {
            let mut values = scenario.parameter_values();
            values.insert(parameter.to_owned(), if round % 2 == 0 { there } else { here });
            let (making, renewed) = timed(|| prepared.renewed(&scenario, &values, &Quiet));
            prepared = renewed?.ok_or("nothing moved")?.0;
            let (solving, solved) = timed(|| prepared.case(&scenario, &values).solve());
            size = solved?.answer.size.unknowns;
            ready.push(making);
            whole.push(making + solving);
        }
        medians.insert(what.to_owned(), json!({ "ready": median(ready), "whole": median(whole) }));
    }
    Ok(json!({ "unknowns": size, "medians": medians }))
}

/// Seconds on the clock and of the processor.
fn spent<T>(work: impl FnOnce() -> T) -> (Value, T) {
    let (seconds, processor, result) = computed(work);
    (json!({ "seconds": seconds, "processor": processor }), result)
}

/// K_m (lower triangle) and C as terms `row column value` from 1 on.
fn export_matrices(structure: &Structure, joints: &[Joint], folder: &Path) -> Result<(), Failure> {
    let (k_m, c) = MainSystem::matrices_of(structure, joints, &Quiet)?;
    let mut out = BufWriter::new(File::create(folder.join("K.txt"))?);
    for column in 0..k_m.order() {
        for (row, value) in k_m.column(column) {
            writeln!(out, "{} {} {value:e}", row + 1, column + 1)?;
        }
    }
    out.flush()?;
    let mut out = BufWriter::new(File::create(folder.join("C.txt"))?);
    for (row, joint, value) in c {
        writeln!(out, "{} {} {value:e}", row + 1, joint + 1)?;
    }
    out.flush()?;
    Ok(())
}

/// Two plates for a Schur complement.
fn schur(arguments: &[String]) -> Result<Value, Failure> {
    let scenario = Plates {
        divisions: [number(arguments, 0, "NX")?, number(arguments, 1, "NY")?],
        size: [number(arguments, 2, "WIDTH")?, number(arguments, 3, "HEIGHT")?],
        ..Plates::with_pairs(2, 0.4)
    }
    .scenario();
    let folder = Path::new(arguments.get(4).ok_or("FOLDER is missing")?);
    let Source::Structure(structure) = &scenario.source else {
        return Err("no structure".into());
    };
    let joints = joints(&structure.pairs);
    export_matrices(structure, &joints, folder)?;
    let (whole, main) = spent(|| MainSystem::new(structure, &joints, &Quiet));
    let main = main?;
    let seconds = main.timings();
    Ok(json!({
        "unknowns": main.size().all, "pairs": structure.pairs.len(), "whole": whole,
        "assemble": seconds.assemble, "factor": seconds.factor, "condense": seconds.condense,
        "entries": main.factor_entries(), "peak_megabytes": peak_megabytes(),
    }))
}

/// A block of bricks on a rough plane: its condensation, Lemke's algorithm on the polygon, the way to Coulomb's cone.
fn space(arguments: &[String]) -> Result<Value, Failure> {
    let divisions = [number(arguments, 0, "NX")?, number(arguments, 1, "NY")?, number(arguments, 2, "NZ")?];
    let facets = number(arguments, 3, "FACETS")?;
    let scenario = brick_block(divisions, facets, "true");
    let Source::Structure(structure) = &scenario.source else {
        return Err("no structure".into());
    };
    let joints = joints(&structure.pairs);
    if let Some(folder) = arguments.get(4) {
        export_matrices(structure, &joints, Path::new(folder))?;
    }
    let (condensed, main) = spent(|| MainSystem::new(structure, &joints, &Quiet));
    let main = main?;
    let (seconds, size, entries) = (main.timings(), main.size().all, main.factor_entries());
    let after_condensation = peak_megabytes();
    drop(main);
    let prepared = prepare(&scenario, &Quiet)?;
    let values = scenario.parameter_values();
    let on = |scenario: &Scenario| spent(|| prepared.case(scenario, &values).under(scenario.rules).solve());
    let (polygon, solved) = on(&brick_block(divisions, facets, "false"));
    let (lemke, pivots) = solved.map(|solved| (solved.answer.timings.lemke, solved.answer.pivot_count))?;
    let (cone, solved) = on(&scenario);
    let steps = solved?.answer.polygon.and_then(|polygon| polygon.newton);
    Ok(json!({
        "unknowns": size, "pairs": structure.pairs.len(), "facets": facets, "condensed": condensed,
        "assemble": seconds.assemble, "factor": seconds.factor, "condense": seconds.condense, "entries": entries,
        "condensed_megabytes": after_condensation, "pivots": pivots, "lemke": lemke,
        "polygon": polygon, "cone": cone, "steps": steps, "peak_megabytes": peak_megabytes(),
    }))
}

/// A contact stiffness matrix given as one: its check, and faer's Cholesky factorization of the same matrix.
fn given(arguments: &[String]) -> Result<Value, Failure> {
    let pairs: usize = number(arguments, 0, "PAIRS")?;
    let ready = Ready::new(&Plates::with_pairs(pairs, 0.4));
    let system = ready.prepared.system().ok_or("no contact system")?;
    let n = system.joint_count();
    let matrix = &system.stiffness;
    let rows: Vec<String> = (0..n)
        .map(|i| {
            let entries: Vec<String> = (0..n).map(|j| format!("{:e}", matrix[(i, j)])).collect();
            format!("[{}]", entries.join(","))
        })
        .collect();
    let ids: Vec<String> = system.pairs.iter().enumerate().map(|(i, _)| format!("\"c{i}\"")).collect();
    let load = vec!["-1"; n].join(",");
    let friction = vec!["0.4"; pairs].join(",");
    let text = format!(
        r#"{{"format":"stickslip/1","title":"A matrix","contact_system":{{"pairs":[{}],"friction":[{friction}],
"loads":{{"weight":{{"vector":[{load}]}}}},"stiffness":[{}]}}}}"#,
        ids.join(","),
        rows.join(",")
    );
    let scenario = stickslip::model::load::load_text("matrix", &text, None).map_err(|problems| problems.to_string())?;
    let (check, prepared) = spent(|| prepare(&scenario, &Quiet));
    prepared?;
    let view = faer::MatRef::from_column_major_slice(matrix.as_slice(), n, n);
    faer::set_global_parallelism(faer::Par::Seq);
    let (cholesky, factor) = spent(|| view.llt(Side::Lower));
    let cholesky_fails = factor.is_err();
    Ok(
        json!({ "pairs": pairs, "bytes": text.len(), "check": check, "cholesky": cholesky, "cholesky_fails": cholesky_fails }),
    )
}

/// The exact check of an answer.
fn exact(arguments: &[String]) -> Result<Value, Failure> {
    let ready = Ready::new(&Plates::with_pairs(number(arguments, 0, "PAIRS")?, number(arguments, 1, "F")?));
    let values = ready.values(&[]);
    let solved = ready.prepared.case(&ready.scenario, &values).under(ready.scenario.rules).solve()?;
    let (check, found) = spent(|| ready.prepared.check_exactly(&solved, &Quiet));
    let found = format!("{:?}", found.map_err(|error| format!("{error:?}"))?);
    Ok(json!({ "check": check, "found": found.get(..80) }))
}

/// The main system of two plates: seconds of its parts, memory.
fn condense(arguments: &[String]) -> Result<Value, Failure> {
    let scenario = Plates {
        divisions: [number(arguments, 0, "NX")?, number(arguments, 1, "NY")?],
        size: [number(arguments, 2, "WIDTH")?, number(arguments, 3, "HEIGHT")?],
        cases: number(arguments, 4, "CASES")?,
        ..Plates::with_pairs(2, 0.4)
    }
    .scenario();
    let Source::Structure(structure) = &scenario.source else {
        return Err("no structure".into());
    };
    let joints = joints(&structure.pairs);
    let before = peak_megabytes();
    let (total, main) = spent(|| MainSystem::new(structure, &joints, &Quiet));
    let main = main?;
    let seconds = main.timings();
    let peak = peak_megabytes();
    let mut result = json!({
        "unknowns": main.size().all,
        "pairs": structure.pairs.len(),
        "cases": structure.load_cases.len(),
        "assemble": seconds.assemble,
        "factor": seconds.factor,
        "condense": seconds.condense,
        "total": total["seconds"],
        "processor": total["processor"],
        "entries": main.factor_entries(),
        "model_megabytes": before,
        "peak_megabytes": peak,
    });
    drop(main);
    if arguments.get(5).is_some_and(|word| word == "plain") {
        let (k_m, _) = MainSystem::matrices_of(structure, &joints, &Quiet)?;
        let n = k_m.order();
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &k_m.column_start, None, &k_m.rows);
        let matrix = SparseColMatRef::new(pattern, &k_m.values);
        faer::set_global_parallelism(faer::Par::Seq);
        let (plain, factor) = timed(|| matrix.sp_cholesky(Side::Lower));
        factor.map_err(|error| format!("{error:?}"))?;
        result["plain"] = json!(plain);
        result["ratio"] = json!((seconds.factor + seconds.condense) / plain);
    }
    Ok(result)
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let rest = arguments.get(1..).unwrap_or_default();
    let done = match arguments.first().map(String::as_str) {
        Some("engine") => engine(rest),
        Some("warm") => warm(rest).map(|result| println!("{result}")),
        Some("resolve") => resolve(rest).map(|result| println!("{result}")),
        Some("trace") => trace(rest).map(|result| println!("{result}")),
        Some("sweep") => sweep(rest).map(|result| println!("{result}")),
        Some("condense") => condense(rest).map(|result| println!("{result}")),
        Some("schur") => schur(rest).map(|result| println!("{result}")),
        Some("space") => space(rest).map(|result| println!("{result}")),
        Some("given") => given(rest).map(|result| println!("{result}")),
        Some("exact") => exact(rest).map(|result| println!("{result}")),
        _ => {
            let known = "engine, warm, resolve, trace, sweep, condense, schur, space, given or exact";
            Err(format!("expected {known}; see the head of benches/examples/measure.rs").into())
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}
