//! Contact in space, from the file to the report: every answer judged from the file against Coulomb's cone, or against the
//! polygon where it says that it is the polygon's; every claim that there is none contradicted where an answer is found.

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::answer::record::{Answer, Verdict};
use stickslip::contact::cone::{ConePair, ConeProblem, answer_on_cone};
use stickslip::contact::law::PairLaw;
use stickslip::export::json;
use stickslip::model::parameter::ParameterValues;
use stickslip::watch::Quiet;

use crate::{common, pick, power_of_ten};

/// Residuals above this share of the terms of their own row are violations.
const ROUNDING: f64 = 1e-12;

const FAMILIES: [&str; 7] = ["plain", "ties", "kernel", "frictionless", "gaps", "scales", "bounds"];

/// A contact system in space as its file states it: normals, then t1 and t2 of each pair.
#[derive(Clone, Debug)]
struct Problem {
    r: Vec<Vec<f64>>,
    load: Vec<f64>,
    law: Vec<&'static str>,
    friction: Vec<f64>,
    cohesion: Vec<f64>,
    gap: Vec<f64>,
    bound: Vec<f64>,
    regular: bool,
}

/// A value and the sum of the magnitudes of its terms.
#[derive(Clone, Copy)]
struct Sized(f64, f64);

impl Sized {
    /// Whether the value lies below zero, or (`zero`) away from it, by more than rounding.
    fn violates(self, zero: bool) -> bool {
        let allowed = ROUNDING * self.1;
        !(self.0 >= -allowed && (!zero || self.0 <= allowed))
    }
}

fn problem(rng: &mut ChaCha8Rng, family: &str) -> Problem {
    let m = pick(rng, &[1, 1, 2, 2, 3, 4, 6, 9, 14, 20]);
    let n = 3 * m;
    let whole = matches!(family, "ties" | "kernel");
    let number = |rng: &mut ChaCha8Rng| {
        if whole { f64::from(rng.random_range(-2..=2)) } else { rng.random_range(-1.0..1.0) }
    };
    let rank = if family == "kernel" { rng.random_range(0..n) } else { n };
    let a: Vec<Vec<f64>> = (0..n).map(|_| (0..rank).map(|_| number(rng)).collect()).collect();
    let diagonal = if family == "kernel" { 0.0 } else { pick(rng, &[1.0, 0.25]) };
    let scale: Vec<f64> = (0..m).map(|_| if family == "scales" { power_of_ten(rng, -3.0, 3.0) } else { 1.0 }).collect();
    let of = |joint: usize| scale[if joint < m { joint } else { (joint - m) / 2 }];
    let entry = |i: usize, j: usize| {
        let (i, j) = (i.min(j), i.max(j));
        let product: f64 = a[i].iter().zip(&a[j]).map(|(x, y)| x * y).sum();
        (product + if i == j { diagonal } else { 0.0 }) * of(i) * of(j)
    };
    let r: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
    let pressed = rng.random_bool(0.5);
    let load = (0..n)
        .map(|i| {
            let own = number(rng);
            of(i) * if pressed && i < m { own.abs() * 2.0 } else { own }
        })
        .collect();
    let laws: &[&'static str] = match family {
        "frictionless" => &["frictionless", "coulomb"],
        "bounds" => &["bound", "coulomb"],
        _ => &["coulomb"],
    };
    let law: Vec<&'static str> = (0..m).map(|_| pick(rng, laws)).collect();
    let f = if whole { pick(rng, &[0.0, 0.5, 1.0, 2.0]) } else { rng.random_range(0.0..5.0) };
    let mut with = |takers: &[&str], value: &mut dyn FnMut(&mut ChaCha8Rng) -> f64| -> Vec<f64> {
        law.iter().map(|law| if takers.contains(law) { value(rng) } else { 0.0 }).collect()
    };
    let friction = with(&["coulomb"], &mut |_| f);
    let cohesive = family == "gaps";
    let cohesion = with(&["coulomb"], &mut |rng| if cohesive { pick(rng, &[0.0, 0.5, 1.0]) } else { 0.0 });
    let gap = with(&["coulomb", "frictionless"], &mut |rng| if cohesive { pick(rng, &[0.0, 0.1, 1.0]) } else { 0.0 });
    let bound = with(&["bound"], &mut |rng| pick(rng, &[0.0, 0.5, 1.0, 1e9]));
    Problem { r, load, law, friction, cohesion, gap, bound, regular: family != "kernel" }
}

impl Problem {
    fn pairs(&self) -> usize {
        self.law.len()
    }

    fn scenario(&self, facets: usize) -> String {
        let m = self.pairs();
        common::scenario_text(json!({ "solver": { "facets": facets }, "contact_system": {
            "pairs": (1..=m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "tangents": 2,
            "stiffness": self.r, "loads": { "load": { "vector": self.load } },
            "law": self.law, "friction": self.friction, "cohesion": self.cohesion, "gap": self.gap,
            "bound": self.bound
        } }))
    }

    /// What is wrong with an answer; `None` if nothing is.
    fn fault_of(&self, answer: &Answer) -> Option<String> {
        let report = json::result(answer, "test", &ParameterValues::default(), false);
        let polygon = &report["polygon"];
        let facets = (polygon["cone"] != Value::Bool(true)).then(|| polygon["facets"].as_u64().expect("K"));
        if facets.is_some() && report["notes"].as_array().is_none_or(Vec::is_empty) {
            return Some("the polygon's answer says nothing of the cone".to_owned());
        }
        let turn = polygon["turn"].as_f64().unwrap_or(0.0).to_radians();
        let m = self.pairs();
        let pair = |i: usize| &report["pairs"][i];
        let read = |i: usize, key: &str| pair(i)[key].as_f64().unwrap_or_else(|| panic!("{key} of {}", pair(i)));
        let vector = |i: usize, key: &str| {
            [0, 1].map(|t| pair(i)[key][t].as_f64().unwrap_or_else(|| panic!("{key} of {}", pair(i))))
        };
        let z: Vec<f64> = (0..m).map(|i| read(i, "z_n")).chain((0..m).flat_map(|i| vector(i, "z_t"))).collect();
        let force: Vec<Sized> = (0..3 * m)
            .map(|i| {
                let term = |k: usize| {
                    let gap = if k < m { self.gap[k] } else { 0.0 };
                    (self.r[i][k] * (z[k] - gap), (self.r[i][k] * z[k]).abs() + (self.r[i][k] * gap).abs())
                };
                let (value, size) = (0..3 * m).map(term).fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
                Sized(value + self.load[i], size + self.load[i].abs())
            })
            .collect();
        for i in 0..m {
            let wrong = |what: &str| Some(format!("pair {}: {what}: {}", i + 1, pair(i)));
            let reported = |value: f64, force: Sized| Sized(force.0 - value, force.1 + value.abs());
            let (normal, tangential) = (force[i], [force[m + 2 * i], force[m + 2 * i + 1]]);
            let x_t = vector(i, "x_t");
            if reported(read(i, "x_n"), normal).violates(true) {
                return wrong("x_n is not R z + RF");
            }
            let size = tangential[0].1 + tangential[1].1;
            let open = z[i] > 0.0;
            if self.law[i] == "bound" {
                if z[i] != 0.0 {
                    return wrong("a bilateral joint moves");
                }
            } else if z[i] < 0.0 || normal.violates(open) {
                return wrong("x_n and z_n");
            }
            if self.law[i] == "frictionless" {
                if x_t != [0.0; 2] || tangential.iter().any(|force| force.violates(true)) {
                    return wrong("a frictionless pair carries x_t");
                }
                continue;
            }
            let pressed = if open || self.law[i] == "bound" { Sized(0.0, 0.0) } else { normal };
            let bound = Sized(
                self.friction[i] * pressed.0 + self.cohesion[i] + self.bound[i],
                self.friction[i] * pressed.1 + self.cohesion[i] + self.bound[i] + size,
            );
            if reported(read(i, "bound"), bound).violates(true) {
                return wrong("bound");
            }
            if (0..2).any(|t| reported(x_t[t], Sized(tangential[t].0, bound.1)).violates(true)) {
                return wrong("x_t is not R z + RF");
            }
            let slip = [z[m + 2 * i], z[m + 2 * i + 1]];
            let slipped = slip[0].hypot(slip[1]);
            let state = pair(i)["state"].as_str().expect("a state");
            if !open && (state == "slip") != (slipped > 0.0) {
                return wrong("state and slip");
            }
            if let Some(degrees) = pair(i)["direction"].as_f64() {
                let told = degrees.to_radians();
                if (slip[0] - slipped * told.cos()).hypot(slip[1] - slipped * told.sin()) > 1e-9 * slipped {
                    return wrong("direction and slip");
                }
            }
            let fault = match facets {
                None => cone_fault(bound, tangential, slip),
                Some(facets) => polygon_fault(bound, tangential, slip, facets, turn),
            };
            if let Some(fault) = fault {
                return wrong(fault);
            }
        }
        None
    }

    /// Whether Newton's method on the cone finds an answer from anywhere.
    fn has_answer(&self, rng: &mut ChaCha8Rng) -> bool {
        let (m, n) = (self.pairs(), self.load.len());
        let stiffness = DMatrix::from_fn(n, n, |i, j| self.r[i][j]);
        let gaps = DVector::from_fn(n, |i, _| if i < m { self.gap[i] } else { 0.0 });
        let load = DVector::from_row_slice(&self.load) - &stiffness * gaps;
        let pairs: Vec<ConePair> = (0..m)
            .map(|i| ConePair {
                law: match self.law[i] {
                    "bound" => PairLaw::bilateral(self.bound[i]),
                    // Without friction: a bound of nothing.
                    _ => PairLaw::rubbing(self.friction[i], self.cohesion[i], 0.0),
                },
                tangents: m + 2 * i..m + 2 * i + 2,
            })
            .collect();
        (0..5).any(|_| {
            let problem = ConeProblem {
                stiffness: &stiffness,
                load: &load,
                load_terms: &load.abs(),
                rounded: false,
                kernel: &DMatrix::zeros(n, 0),
                pairs: &pairs,
            };
            let start = DVector::from_fn(n, |_, _| rng.random_range(-1.0..1.0));
            answer_on_cone(&problem, &start, &Quiet).is_ok_and(|answer| answer.check.hidden < 1e-8)
        })
    }
}

/// |x_τ| ≤ bound, and against the slip where there is one.
fn cone_fault(bound: Sized, force: [Sized; 2], slip: [f64; 2]) -> Option<&'static str> {
    let size = force[0].0.hypot(force[1].0);
    if Sized(bound.0 - size, bound.1).violates(false) {
        return Some("friction beyond its bound");
    }
    let slipped = slip[0].hypot(slip[1]);
    let opposed = |t: usize| Sized(force[t].0 + bound.0 * slip[t] / slipped, bound.1);
    (slipped > 0.0 && (0..2).any(|t| opposed(t).violates(true))).then_some("friction is not against the slip")
}

/// Reserves x^k = bound + d_k·x_τ ≥ 0 of K facets, 0 where the slip needs its facet: those next to its direction.
fn polygon_fault(bound: Sized, force: [Sized; 2], slip: [f64; 2], facets: u64, turn: f64) -> Option<&'static str> {
    let step = std::f64::consts::TAU / facets as f64;
    let direction = |k: u64| (turn + k as f64 * step).sin_cos();
    let reserve = |k: u64| {
        let (sin, cos) = direction(k);
        Sized(bound.0 + cos * force[0].0 + sin * force[1].0, bound.1)
    };
    if (0..facets).any(|k| reserve(k).violates(false)) {
        return Some("friction beyond its polygon");
    }
    let slipped = slip[0].hypot(slip[1]);
    if slipped == 0.0 {
        return None;
    }
    let needed = |k: &u64| {
        let (sin, cos) = direction(*k);
        (slip[0] * cos + slip[1] * sin) / slipped > (step * (1.0 - 1e-9)).cos()
    };
    (0..facets).filter(needed).any(|k| reserve(k).violates(true)).then_some("a facet slips with a reserve")
}

#[test]
fn in_space_no_answer_is_wrong_and_no_claim_false() {
    let mut rng = ChaCha8Rng::seed_from_u64(21);
    let (mut on_cone, mut on_polygon, mut claims, mut undecided, mut refused) = (0, 0, 0, 0, 0);
    let mut faults = Vec::new();
    for k in 0..112 {
        let family = FAMILIES[k % FAMILIES.len()];
        let problem = problem(&mut rng, family);
        let facets = pick(&mut rng, &[4, 6, 8, 8, 16]);
        let text = problem.scenario(facets);
        let loaded = stickslip::model::load::load_text("test", &text, None).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let Ok(prepared) = stickslip::solve::prepare(&loaded, &Quiet) else {
            // A load on a free tangential motion of frictionless pairs is refused in words.
            refused += 1;
            continue;
        };
        let solved = prepared.case(&loaded, &loaded.parameter_values()).under(loaded.rules).solve().expect("solved");
        let answer = &solved.answer;
        if answer.is_answer() {
            if let Some(fault) = problem.fault_of(answer) {
                faults.push(format!("{family}: {fault}\n{text}"));
            }
            let polygon = json::result(answer, "test", &loaded.parameter_values(), false)["polygon"].clone();
            if polygon["cone"] == Value::Bool(true) {
                on_cone += 1
            } else {
                on_polygon += 1
            }
            continue;
        }
        match answer.ray.as_ref().and_then(|ray| ray.verdict) {
            Some(Verdict::Certified | Verdict::Proved) => {
                claims += 1;
                if problem.regular || problem.has_answer(&mut rng) {
                    faults.push(format!("{family}: a false claim\n{text}"));
                }
            }
            _ => {
                undecided += 1;
                if problem.regular {
                    faults.push(format!("{family}: none found where there is one\n{text}"));
                }
            }
        }
    }
    println!(
        "{on_cone} on the cone, {on_polygon} on the polygon, {claims} claims, {undecided} undecided, {refused} refused"
    );
    faults.sort_by_key(String::len);
    faults.iter().take(4).for_each(|fault| println!("{fault}\n"));
    assert!(faults.is_empty(), "{} faults", faults.len());
    assert!(on_cone > 80 && on_polygon < 4 && claims > 2, "{on_cone} {on_polygon} {claims}");
}

/// A problem of the plane written in space, t1 = t and t2 on its own spring without a load: the same numbers.
#[test]
fn the_plane_in_space_gives_the_same_numbers() {
    let mut rng = ChaCha8Rng::seed_from_u64(22);
    for k in 0..30 {
        let m = 1 + k % 5;
        let a = DMatrix::from_fn(2 * m, 2 * m, |_, _| rng.random_range(-1.0..1.0));
        let r = &a * a.transpose() + DMatrix::identity(2 * m, 2 * m) * 0.5;
        let r = DMatrix::from_fn(2 * m, 2 * m, |i, j| r[(i.min(j), i.max(j))]);
        let load: Vec<f64> = (0..2 * m).map(|i| rng.random_range(-1.0..1.0) + f64::from(i < m)).collect();
        let f = 0.2 + 0.1 * (k % 3) as f64;
        let flat = |i: usize| if i < m { Some(i) } else { (i - m).is_multiple_of(2).then(|| m + (i - m) / 2) };
        let entry = |i: usize, j: usize| match (flat(i), flat(j)) {
            (Some(i), Some(j)) => r[(i, j)],
            (None, None) if i == j => 1.0,
            _ => 0.0,
        };
        let solve = |tangents: usize, r: Vec<Vec<f64>>, load: Vec<f64>| {
            let case = common::Case::json(json!({ "contact_system": {
                "pairs": (1..=m).map(|i| format!("c{i}")).collect::<Vec<_>>(), "tangents": tangents,
                "stiffness": r, "friction": vec![f; m], "loads": { "load": { "vector": load } } } }));
            let values = case.scenario.parameter_values();
            let solved =
                case.prepared.case(&case.scenario, &values).under(case.scenario.rules).solve().expect("solved");
            json::result(&solved.answer, "test", &values, false)["pairs"].clone()
        };
        let plane = solve(1, (0..2 * m).map(|i| (0..2 * m).map(|j| r[(i, j)]).collect()).collect(), load.clone());
        let space = solve(
            2,
            (0..3 * m).map(|i| (0..3 * m).map(|j| entry(i, j)).collect()).collect(),
            (0..3 * m).map(|i| flat(i).map_or(0.0, |i| load[i])).collect(),
        );
        let number = |value: &Value| value.as_f64().expect("a number");
        for i in 0..m {
            let (one, other) = (&plane[i], &space[i]);
            for key in ["x_n", "z_n", "bound"] {
                assert!((number(&one[key]) - number(&other[key])).abs() < 1e-11, "problem {k}: {one} {other}");
            }
            for key in ["x_t", "z_t"] {
                assert!((number(&one[key]) - number(&other[key][0])).abs() < 1e-11, "problem {k}: {one} {other}");
                assert!(number(&other[key][1]).abs() < 1e-11, "problem {k}: {other}");
            }
        }
    }
}
