//! `prove`: what it writes passes the independent checker, what is altered does not, unless it is a proof of the same.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use num_rational::BigRational;
use num_traits::{Signed, Zero};
use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::lcp::exact::dyadic::rational;
use stickslip::model::embedded;
use stickslip::model::load::load_text;
use stickslip::session::Session;
use stickslip::text::hash::Hash;
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
fn random_proofs(seed: u64, count: usize) -> Vec<(Value, Texts)> {
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

/// Coulomb's law and its kin, read off the numbers: no program's notion of a scheme.
fn obeys(system: &Value, z: &[BigRational]) -> bool {
    let x = forces(system, z);
    let m = z.len() / 2;
    (0..m).all(|i| {
        let number = |key: &str| rational(system[key][i].as_f64().unwrap());
        let (x_n, x_t, z_n, z_t) = (&x[i], &x[m + i], &z[i], &z[m + i]);
        let contact = !x_n.is_negative() && !z_n.is_negative() && (x_n * z_n).is_zero();
        let bound = number("friction") * x_n + number("cohesion") + number("bound");
        // Friction is at its bound and opposes the slip, or there is none.
        let rubs = x_t.abs() <= bound && (z_t.is_zero() || (x_t * z_t.signum() + &bound).is_zero());
        match system["law"][i].as_str().unwrap() {
            "frictionless" => contact && x_t.is_zero(),
            "bound" => z_n.is_zero() && rubs,
            _ => contact && rubs,
        }
    })
}

fn solves(lcp: &Value, z: &[BigRational]) -> bool {
    let number = |value: &Value| rational(value.as_f64().unwrap());
    lcp["M"].as_array().unwrap().iter().zip(lcp["q"].as_array().unwrap()).zip(z).all(|((row, q), z_i)| {
        let w = row.as_array().unwrap().iter().zip(z).map(|(a, z)| number(a) * z).sum::<BigRational>() + number(q);
        !w.is_negative() && !z_i.is_negative() && (w * z_i).is_zero()
    })
}

fn unknowns(system: &Value, values: &Value) -> Option<Vec<BigRational>> {
    let names: Vec<String> = match system.get("lcp") {
        Some(lcp) => lcp["names"].as_array()?.iter().map(|name| format!("z {}", name.as_str().unwrap())).collect(),
        None => {
            let ids = system["contact_system"]["pairs"].as_array()?;
            let of = |word: &'static str| ids.iter().map(move |id| format!("{word} {}", id.as_str().unwrap()));
            of("z_n").chain(of("z_t")).collect()
        }
    };
    names.iter().map(|name| values[name.as_str()].as_str()?.parse().ok()).collect()
}

fn is_answer(system: &Value, values: &Value) -> bool {
    let Some(z) = unknowns(system, values) else { return false };
    match system.get("lcp") {
        Some(lcp) => solves(lcp, &z),
        None => obeys(&system["contact_system"], &z),
    }
}

/// The motion of a collapse: costs nothing, presses no pair, and the loads do more on it than contact can take.
fn is_collapse(system: &Value, proof: &Value) -> bool {
    let Some(z) = unknowns(system, &proof["motion"]) else { return false };
    let system = &system["contact_system"];
    let m = z.len() / 2;
    let zero = vec![BigRational::zero(); 2 * m];
    let amounts: Option<Vec<BigRational>> =
        proof["amounts"].as_array().unwrap().iter().map(|amount| amount.as_str()?.parse().ok()).collect();
    let free = match (amounts, system["kernel"].as_array()) {
        (Some(amounts), Some(kernel)) if !amounts.is_empty() => (0..2 * m).all(|joint| {
            let part = |(motion, y): (&Value, &BigRational)| rational(motion[joint].as_f64().unwrap()) * y;
            z[joint] == kernel.iter().zip(&amounts).map(part).sum::<BigRational>()
        }),
        // R ζ as a difference: gaps and load cancel.
        _ => forces(system, &z) == forces(system, &zero),
    };
    let number = |key: &str, i: usize| rational(system[key][i].as_f64().unwrap());
    let fits = |i: usize| match system["law"][i].as_str().unwrap() {
        "bound" => z[i].is_zero(),
        _ => z[i] >= number("friction", i) * z[m + i].abs(),
    };
    let taken: BigRational = (0..m).map(|i| (number("cohesion", i) + number("bound", i)) * z[m + i].abs()).sum();
    let load = &system["loads"]["all"]["vector"];
    let work: BigRational = (0..2 * m).map(|i| -rational(load[i].as_f64().unwrap()) * &z[i]).sum();
    free && (0..m).all(fits) && work > taken
}

/// Whether an altered proof still is one of the same claim, judged without the checker: answers by the laws, all
/// answers by those that the unaltered proof has.
fn still_true(original: &Value, altered: &str, system: &str) -> bool {
    let (Ok(altered), Ok(system)) = (serde_json::from_str::<Value>(altered), serde_json::from_str::<Value>(system))
    else {
        return false;
    };
    if altered["claim"] != original["claim"] {
        return false;
    }
    match altered["claim"].as_str() {
        Some("answer") => is_answer(&system, &altered["values"]),
        Some("collapse") => is_collapse(&system, &altered),
        Some("answers") => {
            let all = |proof: &Value| -> Option<Vec<Vec<BigRational>>> {
                let mut all: Vec<_> = proof["answers"]
                    .as_array()?
                    .iter()
                    .map(|values| unknowns(&system, values))
                    .collect::<Option<_>>()?;
                all.sort();
                Some(all)
            };
            all(&altered).is_some() && all(&altered) == all(original)
        }
        _ => false,
    }
}

/// The text with one character of a number, a sign or a word changed, or two entries exchanged.
pub(super) fn altered(text: &str, random: &mut ChaCha8Rng) -> String {
    let mut value: Value = serde_json::from_str(text).unwrap();
    if random.random_bool(0.2) {
        let mut places = Vec::new();
        leaves(&value, String::new(), &mut places);
        let (one, other) = (places.choose(random).unwrap().clone(), places.choose(random).unwrap().clone());
        let kept = value.pointer(&one).unwrap().clone();
        *value.pointer_mut(&one).unwrap() = value.pointer(&other).unwrap().clone();
        *value.pointer_mut(&other).unwrap() = kept;
        return serde_json::to_string_pretty(&value).unwrap();
    }
    let mut bytes = text.as_bytes().to_vec();
    let digits: Vec<usize> = (0..bytes.len()).filter(|&at| bytes[at].is_ascii_digit()).collect();
    let at = *digits.choose(random).unwrap();
    match random.random_range(0..4) {
        0 => bytes.insert(at, b'-'),
        1 => bytes.insert(at, b'1' + random.random_range(0..9)),
        2 => bytes[at] = b'0' + (bytes[at] - b'0' + random.random_range(1..10)) % 10,
        _ => {
            let at = random.random_range(0..bytes.len());
            bytes[at] ^= 1 << random.random_range(0..7);
        }
    }
    String::from_utf8(bytes).unwrap()
}

fn leaves(value: &Value, place: String, all: &mut Vec<String>) {
    let key = |key: &str| key.replace('~', "~0").replace('/', "~1");
    match value {
        Value::Object(entries) => {
            entries.iter().for_each(|(name, child)| leaves(child, format!("{place}/{}", key(name)), all));
        }
        Value::Array(entries) => {
            entries.iter().enumerate().for_each(|(i, child)| leaves(child, format!("{place}/{i}"), all));
        }
        _ => all.push(place),
    }
}

#[test]
fn what_is_altered_is_rejected_or_still_a_proof_of_the_same() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    // The judge has no kernel to make exact.
    let mut proofs: Vec<_> =
        random_proofs(2, 70).into_iter().filter(|(_, (_, system))| !system.contains("kernel")).collect();
    let folder = tempfile::tempdir().unwrap();
    for scenario in ["beam-ray", "plates-slide"] {
        proofs.push(proved(&mut session(embedded::load(scenario).unwrap()), "", folder.path()).unwrap());
    }
    let mut cases = Vec::new();
    let mut originals = Vec::new();
    for (_, (proof, system)) in &proofs {
        let original: Value = serde_json::from_str(proof).unwrap();
        for _ in 0..12 {
            let text = altered(proof, &mut random);
            if text != *proof {
                cases.push((text, system.clone()));
                originals.push(original.clone());
            }
            // Another system under the old name, and under its own.
            let other = altered(system, &mut random);
            if other != *system {
                let renamed = proof.replace(&Hash::of(system).long(), &Hash::of(&other).long());
                cases.extend([(proof.clone(), other.clone()), (renamed, other)]);
                originals.extend([Value::Null, original.clone()]);
            }
        }
    }
    let said = checked(&cases);
    let mut accepted = 0;
    let mut kinds: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    for (((proof, system), original), said) in cases.iter().zip(&originals).zip(&said) {
        let claim = original["claim"].as_str().unwrap_or("another system");
        let none = original["answers"].as_array().is_some_and(Vec::is_empty);
        let of = if system.contains("contact_system") { "contact" } else { "lcp" };
        let kind = format!("{of}: {}", if none { "no answer" } else { claim });
        kinds.entry(kind).or_default()[usize::from(said.is_ok())] += 1;
        let Ok(words) = said else { continue };
        accepted += 1;
        let about_other = original["claim"] == "answers" && original["system"] != Hash::of(system).long();
        // Only enumeration tells what all answers of another system are.
        let holds = match about_other {
            true => same_answers(system, proof),
            false => still_true(original, proof, system),
        };
        assert!(holds, "{words}\n{proof}\n{system}");
    }
    assert!(cases.len() > 1500 && accepted * 5 < cases.len(), "{accepted} of {}", cases.len());
    // Every kind of proof is among them, and most of what is altered of it is rejected.
    for kind in [
        "contact: answer",
        "contact: collapse",
        "contact: answers",
        "contact: no answer",
        "lcp: answer",
        "lcp: answers",
        "lcp: no answer",
        "contact: another system",
        "lcp: another system",
    ] {
        let [rejected, accepted] = kinds.get(kind).copied().unwrap_or_default();
        assert!(rejected >= 20 && accepted < rejected, "{kind}: {kinds:?}");
    }
    assert_eq!((kinds["contact: another system"][1], kinds["lcp: another system"][1]), (0, 0), "{kinds:?}");
}

/// Whether the answers of a proof are those that `enumerate` finds of its system, to rounding.
fn same_answers(system: &str, proof: &str) -> bool {
    let (scenario, proof): (Value, Value) =
        (serde_json::from_str(system).unwrap(), serde_json::from_str(proof).unwrap());
    let listed = proof["answers"].as_array().unwrap();
    if !listed.iter().all(|values| is_answer(&scenario, values)) {
        return false;
    }
    // A changed id or word may make it no scenario of this program; the laws above have judged its answers.
    let Some(mut session) = of(&scenario) else { return true };
    let found = report(&mut session, "enumerate").unwrap();
    found["answers"].as_array().unwrap().len() == listed.len()
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
