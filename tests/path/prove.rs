//! `prove`: what it writes passes the independent checker.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use num_rational::BigRational;
use num_traits::Zero;
use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::lcp::exact::dyadic::rational;
use stickslip::model::embedded;
use stickslip::model::load::load_text;
use stickslip::session::Session;
use stickslip::watch::Quiet;

use super::find::{report, session};

/// The texts of a proof and of its system.
pub(super) type Texts = (String, String);

/// What `examples/check_proof.py` says of each, in one run of Python.
pub(super) fn checked(cases: &[Texts]) -> Vec<Result<String, String>> {
    const DRIVER: &str = "
import json, sys
import check_proof
for line in sys.stdin:
    proof, system = json.loads(line)
    try:
        print('+' + check_proof.of_text(proof.encode(), system.encode()))
    except (ValueError, KeyError, TypeError, AttributeError, IndexError, ArithmeticError, RecursionError) as error:
        print('-' + repr(error).replace('\\n', ' '))
";
    let mut python = Command::new("python3")
        .args(["-B", "-c", DRIVER])
        .env("PYTHONPATH", concat!(env!("CARGO_MANIFEST_DIR"), "/examples"))
        .env("PYTHONIOENCODING", "utf-8")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("python3, which checks the proofs");
    let mut stdin = python.stdin.take().unwrap();
    let lines: Vec<String> = cases.iter().map(|(proof, system)| json!([proof, system]).to_string()).collect();
    let feed = std::thread::spawn(move || lines.iter().try_for_each(|line| writeln!(stdin, "{line}")));
    let output = python.wait_with_output().unwrap();
    feed.join().unwrap().unwrap();
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    let said: Vec<_> = text
        .lines()
        .map(|line| match line.split_at(1) {
            ("+", proved) => Ok(proved.to_owned()),
            (_, why) => Err(why.to_owned()),
        })
        .collect();
    assert_eq!(said.len(), cases.len(), "{text}");
    said
}

/// Runs `prove` with these words before the file.
pub(super) fn proved(session: &mut Session, words: &str, folder: &Path) -> Result<(Value, Texts), String> {
    let path = folder.join("proof.json");
    let said = report(session, &format!("prove {words} {}", path.display()))?;
    let system = fs::read_to_string(folder.join("proof.system.json")).unwrap();
    Ok((said, (fs::read_to_string(path).unwrap(), system)))
}

/// A contact system of `m` pairs with short numbers: pairs of every law, `loose` motions without energy.
pub(super) fn contact(random: &mut ChaCha8Rng, (m, tangents): (usize, usize), loose: usize) -> Value {
    let k = (1 + tangents) * m;
    let rank = k - loose.min(k - 1);
    let factor: Vec<Vec<i32>> = (0..k).map(|_| (0..rank).map(|_| random.random_range(-3..=3)).collect()).collect();
    let entry = |i: usize, j: usize| factor[i].iter().zip(&factor[j]).map(|(a, b)| a * b).sum::<i32>();
    let stiffness: Vec<Vec<f64>> = (0..k).map(|i| (0..k).map(|j| f64::from(entry(i, j)) / 4.0).collect()).collect();
    let load: Vec<f64> = (0..k).map(|_| f64::from(random.random_range(-40..=40)) / 8.0).collect();
    let mut system = json!({
        "pairs": (0..m).map(|i| format!("c{i}")).collect::<Vec<_>>(),
        "stiffness": stiffness, "loads": {"all": {"vector": load}},
        "law": [], "friction": [], "cohesion": [], "bound": [], "gap": [],
    });
    for _ in 0..m {
        let law = *["coulomb", "coulomb", "coulomb", "frictionless", "bound"].choose(random).unwrap();
        let mut number = |wanted: bool, of: &[f64]| if wanted { *of.choose(random).unwrap() } else { 0.0 };
        let entries = [
            ("friction", number(law == "coulomb", &[0.0, 0.3, 0.5, 2.0])),
            ("cohesion", number(law == "coulomb", &[0.0, 0.0, 0.7])),
            ("bound", number(law == "bound", &[0.1, 1.0])),
            ("gap", number(law != "bound", &[0.0, 0.0, 0.25, -0.1])),
        ];
        system["law"].as_array_mut().unwrap().push(law.into());
        entries.into_iter().for_each(|(key, number)| system[key].as_array_mut().unwrap().push(number.into()));
    }
    if tangents == 2 {
        system["tangents"] = 2.into();
    }
    json!({"format": "stickslip/1", "title": "t", "contact_system": system})
}

fn lcp(random: &mut ChaCha8Rng, n: usize) -> Value {
    let mut entry = |most: i32| f64::from(random.random_range(-most..=most)) / 2.0;
    let matrix: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| entry(6)).collect()).collect();
    let q: Vec<f64> = (0..n).map(|_| entry(8)).collect();
    json!({"format": "stickslip/1", "title": "t", "lcp": {"M": matrix, "q": q}})
}

pub(super) fn of(scenario: &Value) -> Option<Session> {
    Session::new(load_text("case", &scenario.to_string(), None).ok()?, &Quiet).ok()
}

/// Proofs of random problems, of what stands and of all answers, with the reports.
pub(super) fn random_proofs(seed: u64, count: usize) -> Vec<(Value, Texts)> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let folder = tempfile::tempdir().unwrap();
    let mut proofs = Vec::new();
    for case in 0..count {
        let scenario = match case % 5 {
            0 | 1 => lcp(&mut random, 1 + case % 4),
            other => contact(&mut random, (1 + case % 3, 1), other - 2),
        };
        let Some(mut session) = of(&scenario) else { continue };
        for words in ["", "all"] {
            match proved(&mut session, words, folder.path()) {
                Ok(proof) => proofs.push(proof),
                // Every refusal says why; of problems as small as these all answers are always proved.
                Err(why) => assert!(words.is_empty() && why.starts_with("prove: "), "{why}\n{scenario}"),
            }
        }
    }
    proofs
}

#[test]
fn every_proof_of_a_random_problem_passes() {
    let proofs = random_proofs(1, 200);
    let texts: Vec<Texts> = proofs.iter().map(|(_, texts)| texts.clone()).collect();
    let mut kinds = BTreeMap::new();
    for ((report, (proof, system)), said) in proofs.iter().zip(checked(&texts)) {
        let said = said.unwrap_or_else(|why| panic!("{why}\n{proof}\n{system}"));
        let claim = report["claim"].as_str().unwrap();
        let begins = match (claim, report["answers"].as_u64()) {
            ("answer", _) => "an answer".to_owned(),
            ("collapse", _) => "collapse".to_owned(),
            (_, Some(0)) => "there is no answer".to_owned(),
            (_, count) if said.starts_with("every") => format!("every answer is one of {} ", count.unwrap()),
            (_, count) => format!("the number of answers is {}, and", count.unwrap()),
        };
        assert!(said.starts_with(&begins), "{said}: {report}");
        *kinds.entry(begins.chars().take(24).collect::<String>()).or_insert(0) += 1;
    }
    for kind in ["an answer", "collapse", "there is no answer", "the number of answers is"] {
        assert!(kinds.get(kind).is_some_and(|count| *count >= 4), "{kind}: {kinds:?}");
    }
}

/// λ = R (z − (g, 0)) + load in rationals, straight from the system file.
pub(super) fn forces(system: &Value, z: &[BigRational]) -> Vec<BigRational> {
    let number = |value: &Value| rational(value.as_f64().unwrap());
    let gaps = system["gap"].as_array().unwrap();
    let moved: Vec<BigRational> =
        z.iter().enumerate().map(|(i, z)| z - gaps.get(i).map_or(BigRational::zero(), number)).collect();
    let row = |(row, load): (&Value, &Value)| {
        let terms = row.as_array().unwrap().iter().zip(&moved).map(|(r, z)| number(r) * z);
        terms.sum::<BigRational>() + number(load)
    };
    system["stiffness"]
        .as_array()
        .unwrap()
        .iter()
        .zip(system["loads"]["all"]["vector"].as_array().unwrap())
        .map(row)
        .collect()
}

#[test]
fn what_the_commands_prove_of_the_embedded_scenarios() {
    let folder = tempfile::tempdir().unwrap();
    for (scenario, set, words, begins) in [
        ("beam", "", "", "an answer: the values of 30 quantities"),
        ("beam", "", "all", "the number of answers is 1, and these are all"),
        ("beam-ray", "", "", "collapse: on this motion the loads do "),
        ("dam", "set f 0.2", "", "collapse: on this motion the loads do "),
        ("klarbring", "", "all", "the number of answers is 3, and these are all"),
        ("painleve", "", "", "there is no answer"),
        ("plates-hinged", "", "", "an answer: the values of 80 quantities"),
        ("arch", "set f 0.2", "", "collapse: on this motion the loads do "),
    ] {
        let mut session = session(embedded::load(scenario).unwrap());
        if !set.is_empty() {
            report(&mut session, set).unwrap();
        }
        let (_, texts) = proved(&mut session, words, folder.path()).unwrap();
        let said = checked(&[texts]).remove(0).unwrap();
        assert!(said.starts_with(begins), "{scenario}: {said}");
        // The system is a scenario in which the same stands.
        let again = load_text("again", &fs::read_to_string(folder.path().join("proof.system.json")).unwrap(), None);
        let again = Session::new(again.unwrap(), &Quiet).unwrap();
        assert_eq!(again.answer().unwrap().outcome, session.answer().unwrap().outcome, "{scenario}");
    }
}

/// Example 1 collapses where F2 > 6 f F. Sliding by s the pull does F2 s, and each of the six weights F takes F times
/// what the motion lifts it, which is at least f s.
#[test]
fn the_work_of_the_beam_is_that_of_the_closed_form() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = session(embedded::load("beam").unwrap());
    report(&mut session, "set F2 320").unwrap();
    let (_, (proof, _)) = proved(&mut session, "", folder.path()).unwrap();
    let proof: Value = serde_json::from_str(&proof).unwrap();
    let number = |value: &Value| value.as_str().unwrap().parse::<BigRational>().unwrap();
    let slip = number(&proof["motion"]["z_t c1"]);
    let lifted = (1..=6).map(|pair| {
        let lift = number(&proof["motion"][format!("z_n c{pair}")]);
        assert!(lift >= rational(0.5) * &slip);
        lift
    });
    let expected = rational(320.0) * &slip - rational(100.0) * lifted.sum::<BigRational>();
    let error = (number(&proof["work"]) - &expected) / &expected;
    assert!(stickslip::lcp::exact::dyadic::nearest(&error).abs() < 1e-9, "{error}");
    assert_eq!(proof["bound"], "0");
}

/// w = M z + q with M = 0 and q = 0 in the first row: every z_1 ≥ 0 is an answer, and one set holds them all.
#[test]
fn a_set_of_answers_is_told_as_one() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = json!({"format": "stickslip/1", "title": "t", "lcp": {"M": [[0, 0], [0, 1]], "q": [0, -1]}});
    let (report, texts) = proved(&mut of(&scenario).unwrap(), "all", folder.path()).unwrap();
    let expected = "every answer is one of 1 or lies in one of 1 sets";
    assert!(report["sentence"].as_str().unwrap().contains(expected), "{report}");
    let said = checked(std::slice::from_ref(&texts)).remove(0).unwrap();
    assert!(said.starts_with("every answer is one of 1 or lies in one of "), "{said}");
    // As the only answer it is no longer proved.
    let alone = texts.0.replace("\"set\": [\n", "\"tight\": {}, \"answer\": [\n").replace("[\n        1\n      ]", "1");
    assert!(alone.contains("\"answer\": "), "{alone}");
    assert!(checked(&[(alone, texts.1)]).remove(0).is_err());
}

/// A roller has no tangential joint: that the file leaves its slip free makes no further answers.
#[test]
fn the_answer_of_a_structure_on_rollers_is_the_only_one() {
    let folder = tempfile::tempdir().unwrap();
    let spring = |node: &str, direction: [f64; 2]| json!({"at": node, "direction": direction, "stiffness": 8});
    let scenario = json!({
        "format": "stickslip/1", "title": "t", "nodes": {"A": [0, 0], "B": [1, 0]},
        "springs": [spring("A", [1.0, 0.0]), spring("A", [0.0, 1.0]), spring("B", [1.0, 0.0]), spring("B", [0.0, 1.0])],
        "contacts": [{"id": "r", "node": "A", "against": "ground", "normal": [3, 4], "law": "bound", "bound": 0},
                     {"id": "c", "node": "A", "against": "B", "normal": [0, 1], "friction": 0.5}],
        "loads": {"p": {"items": [{"point": {"at": "A", "force": [1, -2]}}]}}
    });
    let (_, texts) = proved(&mut of(&scenario).unwrap(), "all", folder.path()).unwrap();
    let said = checked(std::slice::from_ref(&texts)).remove(0).unwrap();
    assert!(said.contains("the number of answers is 1, and these are all"), "{said}");
}

/// Pairs whose tangential joints carry no force at all, or only one against another: with no load along them every slip
/// is an answer, a whole line of them.
#[test]
fn sets_that_hold_a_whole_line_have_an_end() {
    let folder = tempfile::tempdir().unwrap();
    for (pairs, stiffness, load, kernel) in [
        (json!(["a"]), json!([[1, 0], [0, 0]]), json!([0, 0]), json!([[0, 1]])),
        (
            json!(["a", "b"]),
            json!([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -1], [0, 0, -1, 1]]),
            json!([-1, 0, 0, 0]),
            json!([[0, 0, 1, 1]]),
        ),
        (
            json!(["a", "b"]),
            json!([[3, 3, 3, -3], [3, 5, 4, -4], [3, 4, 5, -5], [-3, -4, -5, 5]]),
            json!([0, 0, 0, 0]),
            json!([[0, 0, 1, 1]]),
        ),
    ] {
        let scenario = json!({"format": "stickslip/1", "title": "t", "contact_system": {"pairs": pairs,
            "stiffness": stiffness, "loads": {"all": {"vector": load}}, "friction": vec![0.5; pairs.as_array().unwrap().len()],
            "kernel": kernel}});
        let (report, texts) = proved(&mut of(&scenario).unwrap(), "all", folder.path()).unwrap();
        assert!(report["sentence"].as_str().unwrap().contains("every answer is one of "), "{report}");
        let said = checked(std::slice::from_ref(&texts)).remove(0).unwrap();
        assert!(said.starts_with("every answer is one of "), "{said}");
    }
}

/// With M = 0 and q = 0 every choice of rows is a branch: 2^14 − 1 of 13 rows, more than 5000; those of 11 rows are 4095.
#[test]
fn a_tree_that_is_too_large_is_given_up_and_the_size_that_is_not_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let empty = |n: usize| {
        let scenario =
            json!({"format": "stickslip/1", "title": "t", "lcp": {"M": vec![vec![0; n]; n], "q": vec![0; n]}});
        of(&scenario).unwrap()
    };
    let why = proved(&mut empty(13), "all", folder.path()).unwrap_err();
    for part in ["13 rows is too large", "11 such rows always have few enough", "`prove FILE.json` proves what stands"]
    {
        assert!(why.contains(part), "{why}");
    }
    proved(&mut empty(6), "all", folder.path()).unwrap();
}

/// The bar of the ratchet runs along the x axis: no normal joint of R feels a tangential one, and what the condensation
/// stores there is rounding.
#[test]
fn rounding_of_zeros_is_no_part_of_what_is_proved() {
    let folder = tempfile::tempdir().unwrap();
    let (_, (_, system)) = proved(&mut session(embedded::load("ratchet").unwrap()), "", folder.path()).unwrap();
    let system: Value = serde_json::from_str(&system).unwrap();
    let entries = system["contact_system"]["stiffness"].as_array().unwrap();
    let m = entries.len() / 2;
    let at = |i: usize, j: usize| entries[i][j].as_f64().unwrap();
    assert!((0..m).all(|i| (m..2 * m).all(|j| at(i, j) == 0.0 && at(j, i) == 0.0)));
    assert!((0..m).all(|i| at(i, i) > 0.0));
}

#[test]
fn refusals_say_what_is_possible_instead() {
    let folder = tempfile::tempdir().unwrap();
    for (scenario, set, words, part) in [
        ("arch", "", "", "63 motions that only contact holds are too many, at most 48; `check exact`"),
        ("wall", "", "all", "45 contact pairs for a proof of all answers are too many, at most 12; `prove FILE.json`"),
        ("beam-limit", "", "", "holds to rounding only"),
        ("klarbring", "set covering weight; set f 0.9; set N 0.1", "some", "expected a file, `prove FILE.json`"),
    ] {
        let mut session = session(embedded::load(scenario).unwrap());
        for command in set.split("; ").filter(|command| !command.is_empty()) {
            let _ = report(&mut session, command);
        }
        let before = fs::read_dir(folder.path()).unwrap().count();
        let why = proved(&mut session, words, folder.path()).unwrap_err();
        assert!(why.contains(part), "{why}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), before);
    }
    let mut session = session(embedded::load("beam").unwrap());
    for (command, part) in [("prove all", "expected a file"), ("prove .json", "ends in .json, found `.json`")] {
        let why = report(&mut session, command).unwrap_err();
        assert!(why.contains(part), "{why}");
    }
    let why = report(&mut session, "prove proof.txt").unwrap_err();
    assert!(why.contains("expected the name of a file that ends in .json, found `proof.txt`"), "{why}");
}
