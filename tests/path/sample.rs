//! `sample`: probabilities against closed forms, the same points on any number of threads and shards.

use std::fs;
use std::sync::Mutex;

use serde_json::{Value, json};
use stickslip::model::embedded;
use stickslip::model::load::load_text;
use stickslip::session::commands::sweep::merge;
use stickslip::session::{Output, Session};
use stickslip::view::style::Style;
use stickslip::watch::{Quiet, Watch};

use super::find::{near, number, report};

fn of(scenario: &Value) -> Session {
    Session::new(load_text("case", &scenario.to_string(), None).unwrap(), &Quiet).unwrap()
}

/// Example 1 pulled with 150: it holds where Σ 100 f ≥ 150.
fn beam(set: &str) -> Session {
    let mut session = Session::new(embedded::load("beam").unwrap(), &Quiet).unwrap();
    report(&mut session, "set F2 150").unwrap();
    if !set.is_empty() {
        report(&mut session, set).unwrap();
    }
    session
}

fn value(found: &Value, key: &str) -> f64 {
    found[key].as_f64().unwrap_or_else(|| panic!("{key}: {found}"))
}

/// A collapse for f < 0.25: (0.25 − 0.2) / 0.4. In every answer c6 slips, x_t = −100 f with f uniform over 0.25 … 0.6.
#[test]
fn one_parameter_is_exact() {
    for present in ["", "set f 0.9", "set f 0.1"] {
        let found = report(&mut beam(present), "sample f=uniform(0.2,0.6) of x_t c6, state c3").unwrap();
        near(&found["collapse"], 0.125, 1e-12);
        assert_eq!(
            (&found["exact"], &found["standard_error"], &found["draws"]),
            (&true.into(), &0.0.into(), &0.into())
        );
        assert_eq!(found["undecided"], 0.0);
        let force = &found["quantities"][0];
        near(&force["known"], 0.875, 1e-12);
        near(&force["mean"], -100.0 * 0.425, 1e-9);
        near(&force["deviation"], 35.0 / 12f64.sqrt(), 1e-9);
        for quantile in force["quantiles"].as_array().unwrap() {
            near(&quantile[1], -100.0 * (0.6 - 0.35 * number(&quantile[0])), 1e-7);
        }
        for bar in force["histogram"].as_array().unwrap() {
            near(&bar["probability"], 1.0 / 12.0, 1e-9);
        }
        // c3, the fourth from the pulled end, slips where 400 f < 150.
        let words = &found["quantities"][1]["words"];
        assert_eq!((&words[0][0], &words[1][0]), (&"stick".into(), &"slip+".into()));
        near(&words[0][1], (0.6 - 0.375) / 0.35, 1e-9);
    }
}

/// triangular(0.2, 0.2, 0.6): the share below 0.25 is 1 − (0.35 / 0.4)². Cut off below 0, normal(0.3, 0.1) has the share
/// (Φ(−0.5) − Φ(−3)) / (1 − Φ(−3)) there.
#[test]
fn other_laws_of_one_parameter_are_exact_too() {
    let found = report(&mut beam(""), "sample f=triangular(0.2, 0.2, 0.6)").unwrap();
    near(&found["collapse"], 1.0 - (0.35f64 / 0.4).powi(2), 1e-12);
    let found = report(&mut beam(""), "sample f=normal(0.3,0.1)").unwrap();
    let (half, three) = (0.308_537_538_725_986_9, 1.349_898_031_630_094_6e-3);
    near(&found["collapse"], (half - three) / (1.0 - three), 1e-8);
    assert!(found["notes"][0].as_str().unwrap().contains("cut off below 0"), "{found}");
}

/// A collapse for F2 > 600 f: ∫ (F2/600 − 0.2) dF2 over 120 … 200, over 0.4 · 100. With a normal friction a share
/// Φ((1/4 − 0.4)/0.05) = Φ(−3) does not hold 150 = 6 f F. The normal law has no ends: what lies beyond those that were
/// followed is reported, and is not undecided.
#[test]
fn tails_that_were_not_followed_are_told_apart() {
    let found = report(&mut beam("set F2 150"), "sample f = normal(0.4, 0.05)").unwrap();
    assert!((value(&found, "collapse") - 0.001_349_898_031_630_094_6).abs() < 2e-9, "{found}");
    assert_eq!(value(&found, "undecided"), 0.0, "{found}");
    let mut notes = found["notes"].as_array().unwrap().iter().filter_map(Value::as_str);
    assert!(notes.any(|note| note.contains("exact but for a share of 2e-9 beyond the ends")), "{found}");
}

/// No exact path leads over a length: points are drawn, and progress shows how many are ready.
#[test]
fn points_over_a_geometry_are_counted_as_they_are_solved() {
    #[derive(Default)]
    struct Heard(Mutex<Vec<String>>);
    impl Watch for Heard {
        fn progress(&self, what: &str, _: f64) {
            self.0.lock().unwrap().push(what.to_owned());
        }
    }
    let mut session = Session::new(embedded::load("arch").unwrap(), &Quiet).unwrap();
    let (watch, mut out) = (Heard::default(), Vec::new());
    let mut io = Output::text(&mut out, Style::default(), &watch);
    session.execute("sample eta=uniform(0.12,0.2) 120 --crude", &mut io).unwrap();
    let heard = watch.0.lock().unwrap().clone();
    // how often it is asked depends on the machine
    assert!(heard.iter().any(|what| what.contains(" of 120")), "{heard:?}");
}

#[test]
fn two_uniform_parameters_are_an_area() {
    let found = report(&mut beam(""), "sample f=uniform(0.2,0.6) F2=uniform(100,200)").unwrap();
    let over = |pull: f64| pull * pull / 1200.0 - 0.2 * pull;
    near(&found["collapse"], (over(200.0) - over(120.0)) / 40.0, 1e-9);
    assert_eq!(found["exact"], true);
}

/// A friction of its own in every support: Σ f < 1.5 with f = 0.2 + 0.4 u is Σ u < 0.75, whose share is 0.75⁶ / 6!.
#[test]
fn rare_collapse_is_met_near_the_limit() {
    let mut scenario: Value = serde_json::from_str(&embedded::load("beam").unwrap().text).unwrap();
    for k in 1..=6 {
        scenario["parameters"][format!("f{k}")] = json!(0.4);
        scenario["contacts"][k - 1]["friction"] = json!(format!("f{k}"));
    }
    scenario["parameters"].as_object_mut().unwrap().shift_remove("f");
    scenario["parameters"]["F2"]["value"] = json!(150);
    let mut session = of(&scenario);
    let names: String = (1..=6).map(|k| format!("f{k}=uniform(0.2,0.6) ")).collect();
    let found = report(&mut session, &format!("sample {names} 400 --seed 3")).unwrap();
    let (share, error) = (value(&found, "collapse"), value(&found, "standard_error"));
    assert!((share - 0.75f64.powi(6) / 720.0).abs() < 3.0 * error, "{found}");
    assert!(error < 0.3 * share && found["near"] == "pull" && found["exact"] == false, "{found}");
}

/// One pair, pressed by 1 and pushed by T: it holds where f ≥ T.
fn one_pair() -> Value {
    json!({
        "format": "stickslip/1", "title": "t", "parameters": {"f": 0.5, "T": 0.2, "a": 0.1},
        "contact_system": {
            "pairs": ["c1"], "stiffness": [[1, 0], [0, 0]], "kernel": [[0, 1]], "friction": ["f"],
            "loads": {"press": {"vector": [1, 0]}, "push": {"factor": "T", "vector": [0, 1]}},
        },
    })
}

/// f − T is normal with mean 0.3 and deviation 0.05 √2: the share below 0 is Φ(−0.3 / 0.05 / √2) = Φ(−4.2426407).
#[test]
fn the_estimate_is_the_share_within_its_error() {
    let exact = 1.104_524_849_929_275_4e-5;
    let mut off = Vec::new();
    for seed in 1..=8 {
        let command = format!("sample f=normal(0.5,0.05) T=normal(0.2,0.05) 500 --seed {seed}");
        let found = report(&mut of(&one_pair()), &command).unwrap();
        let (share, error) = (value(&found, "collapse"), value(&found, "standard_error"));
        assert!(error < 0.2 * exact && found["near"] == "push", "{found}");
        off.push((share - exact) / error);
    }
    // Eight deviations of a standard normal law: none beyond 4, their squares sum up to less than 26 with 99.9 %.
    assert!(off.iter().all(|off| off.abs() < 4.0) && off.iter().map(|off| off * off).sum::<f64>() < 26.0, "{off:?}");
    let crude = report(&mut of(&one_pair()), "sample f=normal(0.5,0.05) T=normal(0.2,0.05) 300 --crude").unwrap();
    assert_eq!((&crude["collapse"], &crude["near"]), (&0.0.into(), &Value::Null));
    near(&crude["below"], 1.0 - 0.05f64.powf(1.0 / 300.0), 1e-12);
}

/// Plain draws, their share and error against the exact one; words and quantiles of what is drawn.
#[test]
fn drawn_points_agree_with_the_exact_share() {
    let mut session = beam("");
    let found = report(&mut session, "sample f=uniform(0.2,0.6) 1500 of x_t c6 --crude").unwrap();
    let (share, error) = (value(&found, "collapse"), value(&found, "standard_error"));
    near(&found["standard_error"], (share * (1.0 - share) / 1499.0).sqrt(), 1e-12);
    assert!((share - 0.125).abs() < 3.0 * error, "{found}");
    let force = &found["quantities"][0];
    assert!((value(force, "mean") + 42.5).abs() < 3.0 * value(force, "mean_error"), "{found}");
    let median = force["quantiles"][3][1].as_f64().unwrap();
    assert!((median + 42.5).abs() < 2.0, "{found}");
}

/// A friction of 2 a − 0.5 is negative for a < 0.25: what is refused is neither an answer nor a collapse.
#[test]
fn what_is_undecided_is_no_collapse() {
    let mut scenario = one_pair();
    scenario["contact_system"]["friction"] = json!(["2*a - 0.5"]);
    scenario["parameters"]["a"] = json!(0.6);
    scenario["parameters"].as_object_mut().unwrap().shift_remove("f");
    // f ≥ T = 0.2 for a ≥ 0.35: a collapse for 0.25 … 0.35, nothing for 0 … 0.25.
    let found = report(&mut of(&scenario), "sample a=uniform(0,1) 600").unwrap();
    for (key, error, expected) in [("collapse", "standard_error", 0.1), ("undecided", "undecided_error", 0.25)] {
        assert!((value(&found, key) - expected).abs() < 3.0 * value(&found, error), "{key}: {found}");
    }
}

#[test]
fn shards_and_threads_make_the_same_bytes_and_the_same_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    for (ending, how) in [("csv", "--crude"), ("json", "")] {
        let names = format!("f=normal(0.5,0.05) T=normal(0.2,0.05) 90 of x_t c1, state c1 --seed 5 {how}");
        let mut session = of(&one_pair());
        let whole = file(&format!("whole.{ending}"));
        let found = report(&mut session, &format!("sample {names} --out {}", whole.display())).unwrap();
        let parts: Vec<_> = (1..=3).map(|k| file(&format!("part-{k}.{ending}"))).collect();
        for (k, part) in parts.iter().enumerate() {
            let command = format!("sample {names} --shard {}/3 --out {}", k + 1, part.display());
            let pool = rayon::ThreadPoolBuilder::new().num_threads(k + 1).build().unwrap();
            pool.install(|| report(&mut of(&one_pair()), &command)).unwrap();
        }
        let joined = file(&format!("joined.{ending}"));
        assert_eq!(merge(&parts, Some(&joined), &mut Vec::new(), &Quiet).unwrap(), 90);
        assert_eq!(fs::read(&joined).unwrap(), fs::read(&whole).unwrap());
        // What is there is read, and says what the run in memory says.
        let again = report(&mut session, &format!("sample {names} --resume --out {}", joined.display())).unwrap();
        let memory = report(&mut session, &format!("sample {names}")).unwrap();
        for key in ["collapse", "standard_error", "undecided", "draws", "collapses", "near", "quantities"] {
            assert_eq!(found[key], again[key], "{key}");
            assert_eq!(found[key], memory[key], "{key}");
        }
        // Another seed, another number, a changed row.
        for other in [names.replace("seed 5", "seed 6"), names.replace("90", "91"), names.replace("0.05", "0.06")] {
            let refused = report(&mut session, &format!("sample {other} --resume --out {}", joined.display()));
            assert!(refused.unwrap_err().contains("belongs to another sweep"), "{other}");
        }
        let text = fs::read_to_string(&joined).unwrap();
        let last = text.trim_end().rfind('\n').unwrap() + 1;
        let digit = last + text[last..].find(|c: char| c.is_ascii_digit()).unwrap();
        let other = if &text[digit..=digit] == "1" { "2" } else { "1" };
        let altered = format!("{}{other}{}", &text[..digit], &text[digit + 1..]);
        fs::write(&joined, altered).unwrap();
        let refused = report(&mut session, &format!("sample {names} --resume --out {}", joined.display()));
        assert!(refused.is_err());
    }
}

#[test]
fn refusals_say_what_is_expected() {
    let mut session = beam("");
    for (words, part) in [
        ("f", "expected PARAMETER=DISTRIBUTION"),
        ("f=uniform(0.2)", "expected uniform(LEAST, GREATEST)"),
        ("g=uniform(0,1)", "sample: no parameter `g`: the"),
        ("f=uniform(0,1) f=uniform(0,1)", "f is given twice"),
        ("f=uniform(-2,-1)", "must not be negative"),
        ("f=uniform(0,1) 1.5", "not a number of points"),
        ("f=uniform(0,1) 100 200", "one number of points"),
        ("f=uniform(0,1) 1e6 --crude", "belong in a file"),
        ("f=uniform(0,1) of outcome", "leave `outcome` out"),
        ("f = uniform", "`uniform` is not a distribution: expected uniform(LEAST, GREATEST)"),
        ("f=uniform(0,1) of", "expected a quantity after `of`"),
        ("f=uniform(0,1) of \"\"", "expected a quantity after `of`"),
        ("f=uniform(0,1) 0", "`0` is not a number of points; expected a whole number from 2 to 1e9"),
        ("f=uniform(0,1) --shard 1/2", "--out"),
    ] {
        let why = report(&mut session, &format!("sample {words}")).unwrap_err();
        assert!(why.contains(part), "{words}: {why}");
    }
    assert!(report(&mut session, "expect collapse = 0").unwrap_err().contains("nothing was sampled yet"));
    report(&mut session, "sample f=uniform(0.2,0.6)").unwrap();
    report(&mut session, "expect collapse = 0.125 ± 1e-12").unwrap();
    assert!(report(&mut session, "expect collapse < 0.1").unwrap_err().contains("found 0.12"));
}
