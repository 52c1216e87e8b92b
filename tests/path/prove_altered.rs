//! A proof that is altered is rejected by the independent checker, or still proves the same: judged here by the laws.

use std::collections::BTreeMap;

use num_rational::BigRational;
use num_traits::{Signed, Zero};
use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::Value;
use stickslip::lcp::exact::dyadic::rational;
use stickslip::model::embedded;
use stickslip::text::hash::Hash;

use super::find::{report, session};
use super::prove::{checked, forces, of, proved, random_proofs};

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
