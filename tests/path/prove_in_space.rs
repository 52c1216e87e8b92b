//! `prove` in space: what it writes of the polygon and of the cone passes the independent checker; what is altered does not,
//! unless it still is a proof by the laws as they are written down here.

use std::collections::BTreeMap;

use num_rational::BigRational;
use num_traits::{Signed, Zero};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::lcp::exact::dyadic::rational;
use stickslip::model::embedded;

use super::find::{report, session};
use super::prove::{Texts, checked, contact, forces, of, proved};
use super::prove_altered::altered;

fn random_proofs(seed: u64, count: usize) -> Vec<(Value, Texts)> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let folder = tempfile::tempdir().unwrap();
    let mut proofs = Vec::new();
    for case in 0..count {
        let m = 1 + usize::from(case % 4 == 3);
        let mut scenario = contact(&mut random, (m, 2), [0, 1, 2][case % 3]);
        // The tree of two pairs grows with the square of the facets.
        let facets = if m == 2 { 4 } else { [4, 6, 8][random.random_range(0..3)] };
        scenario["solver"] = json!({"facets": facets, "cone": case % 5 != 0});
        let Some(mut session) = of(&scenario) else { continue };
        for words in ["", "all"] {
            match proved(&mut session, words, folder.path()) {
                Ok(proof) => proofs.push(proof),
                Err(why) => assert!(why.starts_with("prove: "), "{why}\n{scenario}"),
            }
        }
    }
    proofs
}

#[test]
fn every_proof_in_space_passes() {
    let proofs = random_proofs(5, 48);
    let texts: Vec<Texts> = proofs.iter().map(|(_, texts)| texts.clone()).collect();
    let mut kinds = BTreeMap::new();
    for ((report, (proof, system)), said) in proofs.iter().zip(checked(&texts)) {
        let said = said.unwrap_or_else(|why| panic!("{why}\n{proof}\n{system}"));
        let value: Value = serde_json::from_str(proof).unwrap();
        let kind = match report["claim"].as_str().unwrap() {
            "collapse" if value.get("directions").is_none() => "collapse on the cone",
            "answers" if report["answers"] == 0 => "none",
            claim => claim,
        };
        let cone = kind == "collapse on the cone";
        assert_eq!(report["sentence"].as_str().unwrap().contains("about the polygon of"), !cone, "{report} {said}");
        *kinds.entry(kind.to_owned()).or_insert(0) += 1;
        // The judge has no kernel to make exact.
        let judged = kind == "answer" && !system.contains("kernel");
        assert!(!judged || is_answer(&system_of(system), &value), "{proof}");
    }
    for kind in ["answer", "collapse on the cone", "answers"] {
        assert!(kinds.get(kind).is_some_and(|count| *count >= 3), "{kind}: {kinds:?}");
    }
}

fn system_of(text: &str) -> Value {
    serde_json::from_str::<Value>(text).unwrap()["contact_system"].clone()
}

/// z over the joints: all normals, then t1 and t2 of each pair.
fn unknowns(system: &Value, values: &Value) -> Option<Vec<BigRational>> {
    let ids: Vec<&str> = system["pairs"].as_array()?.iter().map(|id| id.as_str()).collect::<Option<_>>()?;
    let normals = ids.iter().map(|id| format!("z_n {id}"));
    let slips = ids.iter().flat_map(|id| [format!("z_t1 {id}"), format!("z_t2 {id}")]);
    normals.chain(slips).map(|name| values[name.as_str()].as_str()?.parse().ok()).collect()
}

type Vector = [BigRational; 2];

fn cross(a: &Vector, b: &Vector) -> BigRational {
    &a[0] * &b[1] - &a[1] * &b[0]
}

/// The law of the polygon: friction reaches no facet's bound from outside, and a slip is made of directions whose
/// bounds are used up.
fn is_answer(system: &Value, proof: &Value) -> bool {
    let Some(z) = unknowns(system, &proof["values"]) else { return false };
    let Some(half) = proof["directions"].as_array() else { return false };
    let part = |value: &Value| value.as_str().and_then(|text| text.parse::<BigRational>().ok()).unwrap_or_default();
    let mut directions: Vec<Vector> = half.iter().map(|d| [part(&d[0]), part(&d[1])]).collect();
    directions.extend(directions.clone().into_iter().map(|[a, b]| [-a, -b]));
    let x = forces(system, &z);
    let m = z.len() / 3;
    (0..m).all(|i| {
        let number = |key: &str| rational(system[key][i].as_f64().unwrap());
        let (x_n, z_n) = (&x[i], &z[i]);
        let at = m + 2 * i;
        let (force, slip) = ([x[at].clone(), x[at + 1].clone()], [z[at].clone(), z[at + 1].clone()]);
        let contact = !x_n.is_negative() && !z_n.is_negative() && (x_n * z_n).is_zero();
        let bound = number("friction") * x_n + number("cohesion") + number("bound");
        let reserve = |d: &Vector| &bound + &d[0] * &force[0] + &d[1] * &force[1];
        let made = (0..directions.len()).any(|k| {
            let (d, e) = (&directions[k], &directions[(k + 1) % directions.len()]);
            let (a, b) = (cross(&slip, e) / cross(d, e), cross(d, &slip) / cross(d, e));
            !a.is_negative() && !b.is_negative() && (a * reserve(d)).is_zero() && (b * reserve(e)).is_zero()
        });
        let rubs = directions.iter().all(|d| !reserve(d).is_negative()) && made;
        match system["law"][i].as_str().unwrap() {
            "frictionless" => contact && force.iter().all(Zero::is_zero),
            "bound" => z_n.is_zero() && rubs,
            _ => contact && rubs,
        }
    })
}

/// A motion that costs nothing on which the loads do more than Coulomb's cone can take; c |ζ_t| by its square, so only for
/// problems in which at most one pair has a cohesion or bound and slips.
fn is_collapse(system: &Value, proof: &Value) -> bool {
    let Some(z) = unknowns(system, &proof["motion"]) else { return false };
    let m = z.len() / 3;
    let number = |key: &str, i: usize| rational(system[key][i].as_f64().unwrap());
    let square = |i: usize| &z[m + 2 * i] * &z[m + 2 * i] + &z[m + 2 * i + 1] * &z[m + 2 * i + 1];
    let free = system["kernel"].is_array() || forces(system, &z) == forces(system, &vec![BigRational::zero(); z.len()]);
    let fits = (0..m).all(|i| match system["law"][i].as_str().unwrap() {
        "bound" => z[i].is_zero(),
        _ => !z[i].is_negative() && &z[i] * &z[i] >= number("friction", i) * number("friction", i) * square(i),
    });
    let load = &system["loads"]["all"]["vector"];
    let work: BigRational = (0..z.len()).map(|i| -rational(load[i].as_f64().unwrap()) * &z[i]).sum();
    let fixed = |i: usize| number("cohesion", i) + number("bound", i);
    let taken =
        (0..m).map(|i| fixed(i) * fixed(i) * square(i)).fold(BigRational::zero(), |a, b| if a > b { a } else { b });
    free && fits && work.is_positive() && &work * &work > taken
}

#[test]
fn what_is_altered_in_space_is_rejected_or_still_true() {
    let mut random = ChaCha8Rng::seed_from_u64(8);
    let mut cases = Vec::new();
    let mut originals = Vec::new();
    for (_, (proof, system)) in random_proofs(6, 24).into_iter().filter(|(_, (_, system))| !system.contains("kernel")) {
        for _ in 0..12 {
            let text = altered(&proof, &mut random);
            if text != proof {
                cases.push((text, system.clone()));
                originals.push(serde_json::from_str::<Value>(&proof).unwrap());
            }
        }
    }
    let mut accepted = 0;
    for (((proof, system), original), said) in cases.iter().zip(&originals).zip(checked(&cases)) {
        let Ok(words) = said else { continue };
        accepted += 1;
        let (proof, system): (Value, Value) = (serde_json::from_str(proof).unwrap(), system_of(system));
        let holds = match proof["claim"].as_str().unwrap() {
            "answer" => is_answer(&system, &proof),
            "collapse" if proof.get("directions").is_none() => is_collapse(&system, &proof),
            "collapse" => original["claim"] == "collapse",
            // A system that has no answer within one polygon may have none within another.
            _ => sorted(&system, &proof) == sorted(&system, original),
        };
        assert!(holds, "{words}\n{proof}\n{system}");
    }
    assert!(cases.len() > 250 && accepted * 5 < cases.len(), "{accepted} of {}", cases.len());
}

fn sorted(system: &Value, proof: &Value) -> Vec<Option<Vec<BigRational>>> {
    let mut all: Vec<_> = proof["answers"].as_array().unwrap().iter().map(|values| unknowns(system, values)).collect();
    all.sort();
    all
}

/// A block pushed beyond f W collapses on the cone itself: the proof has no directions, and per unit of slip the push does more
/// than friction takes.
#[test]
fn what_the_commands_prove_of_the_scenarios_in_space() {
    let folder = tempfile::tempdir().unwrap();
    for (scenario, set, words, begins) in [
        ("bearing-two-way", "", "", "an answer: "),
        ("bearing-two-way", "", "all", "the number of answers is 1, and these are all"),
        ("bearing-two-way", "set facets 4", "all", "the number of answers is 1, and these are all"),
        ("pipe-loop", "", "", "an answer: "),
        ("tower", "", "", "an answer: "),
        ("tower", "set H 30", "", "collapse: on this motion the loads do "),
        ("block-3d", "set P 5", "", "collapse: on this motion the loads do "),
    ] {
        let mut session = session(embedded::load(scenario).unwrap());
        if !set.is_empty() {
            report(&mut session, set).unwrap();
        }
        let (said, texts) =
            proved(&mut session, words, folder.path()).unwrap_or_else(|why| panic!("{scenario}: {why}"));
        let proof: Value = serde_json::from_str(&texts.0).unwrap();
        assert_eq!(proof.get("directions").is_none(), begins.starts_with("collapse"), "{scenario}: {said}");
        let words = checked(&[texts]).remove(0).unwrap();
        assert!(words.starts_with(begins), "{scenario}: {words}");
    }
}

/// One is not many.
#[test]
fn what_is_proved_of_a_single_pair() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = session(embedded::load("bearing-two-way").unwrap());
    let (said, _) = proved(&mut session, "", folder.path()).unwrap();
    let sentence = said["sentence"].as_str().unwrap();
    assert!(sentence.contains(" signs of 1 pair in rationals."), "{sentence}");
}
