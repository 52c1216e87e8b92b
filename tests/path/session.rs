//! The commands of the language that follow paths, through a session.

use stickslip::model::embedded;
use stickslip::session::{Output, Session};
use stickslip::view::style::Style;
use stickslip::watch::Quiet;

fn run(scenario: &str, commands: &[&str]) -> Vec<Result<String, String>> {
    let mut session = Session::new(embedded::load(scenario).expect("embedded"), &Quiet).expect("sound");
    let style = Style { width: 100, color: false, ascii: false };
    commands
        .iter()
        .map(|command| {
            let mut text = Vec::new();
            let mut io = Output::text(&mut text, style, &Quiet);
            let result = session.execute(command, &mut io);
            match result {
                Ok(_) => Ok(String::from_utf8(text).expect("text")),
                Err(error) => Err(error.to_string()),
            }
        })
        .collect()
}

fn text(result: &Result<String, String>) -> &str {
    result.as_deref().unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_beam_is_traced_and_its_limit_found() {
    let folder = tempfile::tempdir().expect("a place");
    let csv = folder.path().join("path.csv");
    let export = format!("export path {}", csv.display());
    let results = run(
        "beam",
        &[
            "plot path",
            "set F2 0",
            "trace pull to 260",
            "plot path force c6 c5",
            &export,
            "limit F2",
            "trace f to 0.2",
            "sensitivity f",
            "stages",
            "trace nothing",
            "trace pull 5",
        ],
    );
    assert!(results[0].as_ref().is_err_and(|error| error.contains("no path")));
    let trace = text(&results[2]);
    for word in ["50", "100", "150", "200", "250", "pair c2 slips +", "the target pull = 260"] {
        assert!(trace.contains(word), "{trace}");
    }
    assert!(text(&results[3]).contains("force x_τ over pull"), "{}", text(&results[3]));
    let written = std::fs::read_to_string(&csv).expect("written");
    assert!(written.starts_with("stage,value,factor weight,factor pull,pair,state,"));
    // Start, five breakpoints and the target, six pairs each.
    assert_eq!(written.lines().count(), 1 + 7 * 6);
    let limit = text(&results[5]);
    assert!(limit.contains("limit load: F2 = 300 kN"), "{limit}");
    assert!(limit.contains("mechanism") && limit.contains("confirmed"), "{limit}");
    assert!(text(&results[6]).contains("one scheme"), "{}", text(&results[6]));
    assert!(results[7].is_ok(), "{:?}", results[7]);
    assert!(results[8].as_ref().is_err_and(|error| error.contains("stages")));
    assert!(results[9].as_ref().is_err_and(|error| error.contains("load cases weight, pull")));
    assert!(results[10].is_err());
}

#[test]
fn sweeps_are_tables_or_files() {
    let folder = tempfile::tempdir().expect("a place");
    let csv = folder.path().join("sweep.csv");
    let to_file = format!("sweep f 0..1 F2 0..400 5 --out {}", csv.display());
    let results = run(
        "beam",
        &[
            "sweep F2 100..400 4",
            &to_file,
            &to_file,
            &format!("{to_file} --resume"),
            "sweep g 0..1",
            "sweep f 0..1 100 F2 0..1 100",
        ],
    );
    let table = text(&results[0]);
    assert!(table.contains("normal") && table.contains("mechanism"), "{table}");
    assert!(text(&results[1]).contains("55 rows written"), "{:?}", results[1]);
    assert!(results[2].as_ref().is_err_and(|error| error.contains("--resume")));
    assert!(text(&results[3]).contains("55 were there already; complete"), "{:?}", results[3]);
    assert!(results[4].as_ref().is_err_and(|error| error.contains("unknown parameter g")));
    assert!(results[5].as_ref().is_err_and(|error| error.contains("too many to show")));
}

/// After `stages` quantities and tables mean the history, until the next change or `solve`. r = 30: the end slips
/// 300e-5 under 150 and −300e-5 under −150.
#[test]
fn after_stages_quantities_mean_the_history() {
    let folder = tempfile::tempdir().expect("a place");
    let beam = embedded::text("beam").expect("embedded");
    let end = beam.rfind('}').expect("an object");
    let file = folder.path().join("history.json");
    let stages = r#"[{"weight": 1}, {"weight": 1, "pull": 1}, {"weight": 1, "pull": -1}]"#;
    std::fs::write(&file, format!("{}, \"stages\": {stages} }}", beam[..end].trim_end())).expect("written");
    let load = format!("load {}", file.display());
    let results = run(
        "beam",
        &[
            "stages",
            &load,
            "set f 0.3",
            "set F2 150",
            "expect stage 1 z_t c6 = 0",
            "expect z_t c6 = 0.003 ± 1e-12",
            "stages",
            "expect outcome normal",
            "expect z_t c6 = -0.003 ± 1e-12",
            "expect ux s6 = -0.003 ± 1e-12",
            "expect state c6 slip-",
            "expect stage 2 z_t c6 = 0.003 ± 1e-12",
            "expect stage 2 state c6 slip+",
            "expect stage 1 state c6 stick",
            "expect stage 4 z_t c6 = 0",
            "expect stage x z_t c6 = 0",
            "pairs c6",
            "displacements s6",
            "plot path slip c6",
            "stages 2",
            "solve",
            "expect z_t c6 = 0.003 ± 1e-12",
            "stages",
            "set F2 500",
            "expect stage 2 z_t c6 = 0.003 ± 1e-12",
            "stages",
            "expect outcome ray",
            "expect ray mechanism",
            "expect verdict certified",
            "expect stage 1 outcome normal",
            "expect stage 3 outcome normal",
        ],
    );
    let refused = [0, 4, 14, 15, 24, 30];
    for (index, result) in results.iter().enumerate() {
        assert_eq!(result.is_err(), refused.contains(&index), "{index}: {result:?}");
    }
    let error = |index: usize| results[index].as_ref().expect_err("refused").as_str();
    assert!(error(4).contains("`stages` follows"), "{}", error(4));
    assert!(error(14).contains("stages 1 to 3"), "{}", error(14));
    assert!(error(30).contains("was not reached"), "{}", error(30));
    assert!(text(&results[6]).contains("until the next"), "{}", text(&results[6]));
    assert!(text(&results[16]).contains("at the end of stage 3 of the load history"), "{}", text(&results[16]));
    let displacements = text(&results[17]);
    assert!(displacements.contains("mm") && displacements.contains(" -3"), "{displacements}");
    assert!(text(&results[25]).contains("where the load history ended"), "{}", text(&results[25]));
}

/// In the isolator the pull goes 0, H, 0, −H, 0, four times its largest value; the weight of 0 … 4000 kN goes 10 200 kN
/// or less, not three times as far. A load that only grows is told apart from one that grew before.
#[test]
fn a_history_is_drawn_over_the_load_that_goes_to_and_fro() {
    let commands = [
        "plot path over pull",
        "stages",
        "plot path offset",
        "plot path offset over weight",
        "plot path slip s1 over weight",
        "plot path over pull",
        "plot path over pul",
        "trace pull",
        "plot path over weight",
    ];
    let results = run("isolator", &commands);
    assert!(results[0].is_err());
    assert!(text(&results[2]).contains("offset over the factor of pull"), "{}", text(&results[2]));
    assert!(text(&results[3]).contains("offset over the factor of weight"), "{}", text(&results[3]));
    assert!(text(&results[4]).contains("slip z_τ over the factor of weight"), "{}", text(&results[4]));
    assert!(text(&results[5]).contains("slip z_τ over the factor of pull"), "{}", text(&results[5]));
    assert!(results[6].as_ref().is_err_and(|error| error.contains("no load case `pul`")), "{:?}", results[6]);
    assert!(results[8].as_ref().is_err_and(|error| error.contains("goes over pull")), "{:?}", results[8]);
    let results = run("pipeline", &["stages 2", "plot path slip c6"]);
    assert!(text(&results[1]).contains("over the factor of hot"), "{}", text(&results[1]));
}

/// A path that was followed before a change is not shown as one of the present values.
#[test]
fn a_path_tells_the_values_it_was_followed_under() {
    let folder = tempfile::tempdir().expect("a place");
    let svg = folder.path().join("path.svg");
    let report = folder.path().join("report.md");
    let export = [format!("export path {}", svg.display()), format!("export report {}", report.display())];
    let commands =
        ["limit pull", "plot path", "set f 0.3", "plot path", &export[0], &export[1], "set f 0.5", "plot path"];
    let results = run("beam", &commands);
    assert!(results.iter().all(Result::is_ok), "{results:?}");
    let stale = "followed under f = 0.5; the present values are others";
    assert!(text(&results[3]).contains(stale), "{}", text(&results[3]));
    for index in [1, 7] {
        assert!(!text(&results[index]).contains("followed under"), "{}", text(&results[index]));
    }
    assert!(std::fs::read_to_string(&svg).unwrap().contains("followed under f = 0.5"));
    // 6 f F = 300 was the limit then, 180 is it now
    assert!(!std::fs::read_to_string(&report).unwrap().contains("= 300"));
}

/// A block of weight 8 that is pushed by up to 4: it slides off at f G = 2.4, at 0.6 of the second stage. That stage has no
/// end; what the tables and the result show is of the place where it was left.
#[test]
fn a_stage_that_ends_in_a_limit_has_no_end() {
    let folder = tempfile::tempdir().expect("a place");
    let block = r#"{"format": "stickslip/1", "title": "block", "materials": {"m": {"E": 3e4, "nu": 0.2}},
     "plates": [{"id": "a", "origin": [0, 0], "size": [4, 1], "divisions": [4, 2], "thickness": 1, "material": "m", "plane": "stress"}],
     "contacts": [{"id": "bed", "edge": "a.bottom", "against": "ground", "friction": 0.3}],
     "loads": {"weight": {"items": [{"traction": {"edge": "a.top", "value": [0, -2]}}]},
               "push": {"items": [{"traction": {"edge": "a.top", "value": [1, 0]}}]}},
     "stages": [{"weight": 1}, {"weight": 1, "push": 1}]}"#;
    let file = folder.path().join("block.json");
    std::fs::write(&file, block).expect("written");
    let out = |name: &str| folder.path().join(name).display().to_string();
    let results = run(
        "beam",
        &[
            &format!("load {}", file.display()),
            "stages",
            "expect stage 1 resultant bed N = 8 +- 1e-9",
            "expect stage 2 outcome ray",
            "show stage 2 resultant bed T",
            "expect resultant bed T = -2.4 +- 1e-9",
            &format!("export stresses {}", out("stresses.csv")),
            &format!("export resultants {}", out("resultants.json")),
            "ray",
        ],
    );
    // All of it slides, and no forces within the bounds balance more.
    let ray = text(&results[8]);
    for part in [
        "certified",
        "rigid translation of `a` along +x: all pairs slip +",
        "where the load history ended, at 0.6 of stage 2",
    ] {
        assert!(ray.contains(part), "{part}: {ray}");
    }
    let refused = text(&results[4]).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        refused.contains("`stage 2` is its end, which was not reached: stage 2 cannot be completed: at 0.6"),
        "{refused}"
    );
    for index in [1, 2, 3, 5, 6, 7] {
        text(&results[index]);
    }
    let session =
        Session::new(stickslip::model::load::load_file(&file).unwrap_or_else(|error| panic!("{error}")), &Quiet);
    let mut session = session.expect("sound");
    session.follow_stages(&Quiet).expect("a history");
    let result = session.result(false).expect("a result");
    for stage in result["stages"].as_array().expect("stages") {
        assert!(stage["stresses"].is_array() && stage["resultants"].is_array(), "{stage}");
    }
}
