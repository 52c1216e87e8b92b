//! Before solving: contacts that no load case presses, which is what a normal that points the wrong way looks like.
//!
//! What is looked at is the main system, every joint on: a case presses pair i if its RF_n,i > 0 under the sign of its
//! factor, or −R g does where gaps are interferences. An edge contact is pressed where one of its pairs is; so is a
//! joint of single pairs between two bodies of plates, quads or triangles. What presses a pair only after others slip
//! or open is not seen; where the loads do not reach the pair itself, but joints that it is coupled to, that may
//! happen, and nothing is said.
//!
//! That a contact is pressed can be certain without R and RF: where a motion that costs nothing opens it and moves no
//! other joint, B u = z and uᵀ (Bᵀ RF + F) = 0 give Σ z_n RF_n = −F·u over its pairs, and at least one of them is > 0
//! where the loads work against the motion.

use std::collections::HashSet;
use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use crate::contact::system::ContactSystem;
use crate::fem::{HeldForces, Kinematics, mutual_displacements};
use crate::model::pair::{Pair, joints};
use crate::model::parameter::{Number, ParameterValues};
use crate::model::plausible::Warning;
use crate::model::plausible::normals::{is_down, is_guided, parts};
use crate::model::scenario::{Scenario, Source};
use crate::model::structure::Structure;
use crate::model::vector::dot;
use crate::text::words::list;

/// RF is zero below this many ε of the magnitude of its terms: it went through a factorization.
const ROUNDING: f64 = 1e4 * f64::EPSILON;
/// R_ij is zero below this part of √(R_ii R_jj).
const UNCOUPLED: f64 = 1e-9;
/// Loads work against a motion, or press a pair, where no rounding can have made it so: by this share of the terms of
/// their work, of the largest of their forces.
const CLEARLY: f64 = 1e-6;
/// A joint is at rest in a motion that moves it by less than this share of the largest: rounding of the coordinates.
const STILL: f64 = 1e-12;
/// More motions or contacts than this are left to R and RF.
const MANY: usize = 100;

/// What the load cases do to a pair in the main system.
#[derive(Clone, Copy, PartialEq)]
enum Effect {
    Pressed,
    /// Pulled open by the case of this index, or by interference elsewhere, pressed by none.
    Pulled(Option<usize>),
    /// Not reached, but coupled to joints that are.
    Perhaps,
    Untouched,
}

impl Effect {
    fn may_press(&self) -> bool {
        matches!(self, Effect::Pressed | Effect::Perhaps)
    }
}

/// A warning for the contacts none of whose pairs is pressed.
pub fn unpressed(scenario: &Scenario, system: &ContactSystem) -> Vec<Warning> {
    let signs = signs_of_cases(scenario);
    let gaps = interference(system, &scenario.parameter_values());
    let coupled = coupled(system);
    let effects: Vec<Effect> =
        (0..system.pair_count()).map(|pair| effect(system, &signs, &gaps, &coupled, pair)).collect();
    let joints = Joints::of(scenario, &effects);
    let places = &scenario.places.pairs;
    let mut found: Vec<Unpressed> = Vec::new();
    for Range { start: first, end } in contacts(scenario) {
        if !effects[first..end].iter().any(Effect::may_press) && !joints.carry(first) {
            let id = &system.pairs[first].id;
            let id = if end > first + 1 { id.split('[').next().unwrap_or(id) } else { id };
            let why = why(system, &effects[first..end]) + &joints.turned(first);
            match found.last_mut() {
                Some(last) if last.next == first && last.why == why => {
                    last.ids.push(id.to_owned());
                    last.next = end;
                }
                _ => found.push(Unpressed { place: first, ids: vec![id.to_owned()], why, next: end }),
            }
        }
    }
    let later = closes_later(scenario, system);
    found.into_iter().map(|of| of.warning(&places[of.place], later)).collect()
}

/// Whether there are stages or gaps > 0: what presses a contact later does not show while every joint is held.
fn closes_later(scenario: &Scenario, system: &ContactSystem) -> bool {
    let values = scenario.parameter_values();
    let is_gap = |(key, number): (&'static str, &Number)| key == "gap" && number.value(&values) > 0.0;
    !scenario.stages.is_empty() || system.pairs.iter().any(|pair| pair.law.numbers().into_iter().any(is_gap))
}

/// The pairs of each contact of the file.
fn contacts(scenario: &Scenario) -> Vec<Range<usize>> {
    let mut first = 0;
    let groups = scenario.places.pairs.chunk_by(|a, b| a == b).map(|pairs| {
        let group = first..first + pairs.len();
        first = group.end;
        group
    });
    groups.collect()
}

/// Whether every contact is certain to be pressed, judged by the motions of the parts alone; `false` may mean anything.
pub fn surely_pressed(scenario: &Scenario, structure: &Structure, kinematics: &Kinematics) -> bool {
    let motions = kinematics.motions();
    let contacts = contacts(scenario);
    if motions.len() > MANY || contacts.len() > MANY || motions.is_empty() {
        return contacts.is_empty();
    }
    let signs = signs_of_cases(scenario);
    let joints = joints(&structure.pairs);
    let traces: Vec<DVector<f64>> = motions.iter().map(|motion| mutual_displacements(&joints, &motion.u)).collect();
    let traces = DMatrix::from_columns(&traces);
    let all = traces.transpose() * &traces;
    let works = kinematics.works();
    contacts.into_iter().all(|pairs| {
        if pairs.clone().all(|pair| structure.pairs[pair].law.is_bilateral()) {
            return true;
        }
        let Some(amounts) = opening(&traces, &all, pairs) else { return false };
        // The other way round where the factor of the case is negative.
        let against = |works: &Vec<[f64; 2]>, [plus, minus]: [bool; 2]| {
            let parts = works.iter().zip(&amounts);
            let [work, terms] =
                parts.fold([0.0, 0.0], |[work, terms], ([w, t], amount)| [work + amount * w, terms + amount.abs() * t]);
            plus && work < -CLEARLY * terms || minus && work > CLEARLY * terms
        };
        works.iter().zip(&signs).any(|(works, signs)| against(works, *signs))
    })
}

/// Whether every contact is clearly pressed by a load case while all joints hold, by forces without R; `false` may mean
/// anything.
pub fn clearly_pressed(scenario: &Scenario, structure: &Structure, held: &[HeldForces]) -> bool {
    let signs = signs_of_cases(scenario);
    let is_pressed = |pair: usize| {
        let by_case = |(case, [plus, minus]): (&HeldForces, &[bool; 2])| {
            let (force, clear) = (case.forces[pair], CLEARLY * case.size);
            *plus && force > clear || *minus && force < -clear
        };
        structure.pairs[pair].law.is_bilateral() || held.iter().zip(&signs).any(by_case)
    };
    contacts(scenario).into_iter().all(|mut pairs| pairs.any(is_pressed))
}

/// Amounts of the motions that together open a contact and move no other joint, nor this one along itself; normal joints
/// come first, in the order of the pairs. `all`: tracesᵀ traces.
fn opening(traces: &DMatrix<f64>, all: &DMatrix<f64>, pairs: Range<usize>) -> Option<DVector<f64>> {
    let own = traces.rows(pairs.start, pairs.len());
    let others = all - own.transpose() * own;
    // What the other joints hardly feel; that they feel nothing of it is checked below.
    let unfelt = 1e-12 * all.trace();
    let eigen = others.symmetric_eigen();
    let free: Vec<_> =
        (0..all.ncols()).filter(|&i| eigen.eigenvalues[i] <= unfelt).map(|i| eigen.eigenvectors.column(i)).collect();
    if free.is_empty() {
        return None;
    }
    let free = DMatrix::from_columns(&free);
    // The one of them that is nearest to opening all pairs alike.
    let even = (own * &free).transpose() * DVector::repeat(pairs.len(), 1.0);
    let amounts = free * even;
    let moved = traces * &amounts;
    let largest = moved.rows(pairs.start, pairs.len()).max();
    let is_own = |joint: &usize| pairs.contains(joint);
    let still = (0..moved.len()).filter(|joint| !is_own(joint)).all(|joint| moved[joint].abs() <= STILL * largest);
    let opens = pairs.clone().all(|pair| moved[pair] >= -STILL * largest);
    (largest > 0.0 && still && opens).then_some(amounts)
}

/// Contacts that stand one after the other in the file and are not pressed for the same reason.
struct Unpressed {
    /// The first pair of the first of them.
    place: usize,
    ids: Vec<String>,
    why: String,
    /// The pair after them.
    next: usize,
}

impl Unpressed {
    /// `later`: whether gaps or stages may press what nothing presses at first.
    fn warning(&self, place: &str, later: bool) -> Warning {
        let ids: Vec<String> = self.ids.iter().map(|id| format!("`{id}`")).collect();
        let ids = match &ids[..] {
            [first, .., last] if ids.len() > 3 => format!("{first} … {last} ({} contacts)", ids.len()),
            ids => list(ids),
        };
        let (it, its, carries) =
            if self.ids.len() == 1 { ("it", "its", "it carries") } else { ("them", "their", "they carry") };
        let help = if later {
            format!(
                "{carries} only after gaps close, or others slip or open: see by `stages` or `trace` whether that happens"
            )
        } else {
            format!(
                "turn {its} normal round if it does not point from `against` to the node; otherwise {carries} only after \
                 others slip or open"
            )
        };
        Warning::new(
            place,
            format!("no load case presses {ids}: while every joint is held {}", self.why.replace("{it}", it)),
            help,
        )
    }
}

/// The pairs that hold two bodies, or one and the ground, apart in one direction.
struct Joints<'s> {
    structure: Option<&'s Structure>,
    /// Body of each node.
    part: Vec<usize>,
    /// Nodes of plates, quads, triangles: bodies that touch along faces. (Each support of a bar is looked at by itself.)
    solid: HashSet<usize>,
    /// Bodies and normal of the pairs that are pressed, or may be.
    carrying: Vec<([Option<usize>; 2], [f64; 3])>,
}

impl<'s> Joints<'s> {
    fn of(scenario: &'s Scenario, effects: &[Effect]) -> Joints<'s> {
        let mut joints = Joints { structure: None, part: Vec::new(), solid: HashSet::new(), carrying: Vec::new() };
        let Source::Structure(structure) = &scenario.source else { return joints };
        joints.structure = Some(structure);
        joints.part = parts(structure);
        let membranes = structure.elements.iter().filter(|element| element.nodes.len() > 2);
        joints.solid = membranes.flat_map(|element| element.nodes.iter().copied()).collect();
        let pressed = structure.pairs.iter().zip(effects).filter(|(_, effect)| effect.may_press());
        joints.carrying = pressed.map(|(pair, _)| (joints.bodies(pair), pair.normal)).collect();
        joints
    }

    fn bodies(&self, pair: &Pair) -> [Option<usize>; 2] {
        [Some(self.part[pair.node]), pair.against().map(|node| self.part[node])]
    }

    /// Whether another pair of the same joint carries, or the other side of a guide.
    fn carry(&self, pair: usize) -> bool {
        let Some(structure) = self.structure else { return false };
        let pair = &structure.pairs[pair];
        if is_guided(structure, pair.node, pair.normal) {
            return true;
        }
        let bodies = self.bodies(pair);
        let alike = |n: &[f64; 3]| dot(*n, pair.normal) > 0.5;
        self.solid.contains(&pair.node) && self.carrying.iter().any(|(other, n)| *other == bodies && alike(n))
    }

    /// That the ground lies on the other side of the loads.
    fn turned(&self, pair: usize) -> String {
        let Some(structure) = self.structure else { return String::new() };
        let pair = &structure.pairs[pair];
        if pair.weights.len() > 1 || !is_down(structure, pair.normal) {
            return String::new();
        }
        format!("; the normal {} points down, the way of the loads", structure.dimension.in_words(pair.normal))
    }
}

/// Which cases pull pairs open.
fn why(system: &ContactSystem, effects: &[Effect]) -> String {
    let mut cases: Vec<String> = Vec::new();
    for effect in effects {
        if let Effect::Pulled(Some(case)) = effect {
            let name = format!("`{}`", system.loads[*case].name);
            if !cases.contains(&name) {
                cases.push(name);
            }
        }
    }
    match cases.len() {
        0 => "nothing reaches {it}".to_owned(),
        1 => format!("{} pulls {{it}} open", cases[0]),
        _ => format!("{} pull {{it}} open", list(&cases)),
    }
}

/// Name and factor of every load case.
fn factors(scenario: &Scenario) -> Box<dyn Iterator<Item = (&str, &Number)> + '_> {
    match &scenario.source {
        Source::Structure(structure) => {
            Box::new(structure.load_cases.iter().map(|case| (case.name.as_str(), &case.factor)))
        }
        Source::ContactSystem(system) => Box::new(system.loads.iter().map(|case| (case.name.as_str(), &case.factor))),
        Source::Lcp(_) => Box::new(std::iter::empty()),
    }
}

/// [`signs`] of every load case.
fn signs_of_cases(scenario: &Scenario) -> Vec<[bool; 2]> {
    let values = scenario.parameter_values();
    factors(scenario).map(|(name, factor)| signs(scenario, name, factor, &values)).collect()
}

/// Whether a case may act with a positive and with a negative factor: under the values of the file, its multipliers in
/// stages and combinations, and the ranges of the sliders in its factor.
fn signs(scenario: &Scenario, case: &str, factor: &Number, values: &ParameterValues) -> [bool; 2] {
    let stages = scenario.stages.iter().chain(scenario.combinations.iter().map(|(_, stage)| stage));
    let multipliers = stages.flat_map(|stage| &stage.multipliers).filter(|(name, _)| name == case);
    let multipliers: Vec<f64> =
        std::iter::once(1.0).chain(multipliers.map(|(_, number)| number.value(values))).collect();
    let mut factors = vec![factor.value(values)];
    if !matches!(factor, Number::Value(_)) {
        for name in values.formulas().free(factor.names()) {
            let Some(parameter) = scenario.parameters.get(&name) else { continue };
            for end in [parameter.min, parameter.max].into_iter().flatten() {
                let mut moved = values.clone();
                moved.insert(name.clone(), end);
                factors.push(factor.value(&moved));
            }
        }
    }
    let any = |sign: f64| factors.iter().any(|factor| multipliers.iter().any(|by| factor * by * sign > 0.0));
    let nothing = factors.iter().all(|factor| *factor == 0.0);
    [any(1.0) || nothing, any(-1.0)]
}

/// −R g⁻: what interference does to the joints, and the magnitude of its terms.
fn interference(system: &ContactSystem, values: &ParameterValues) -> [DVector<f64>; 2] {
    let k = system.joint_count();
    let mut gaps = DVector::zeros(k);
    for (pair, of) in system.pairs.iter().enumerate() {
        gaps[pair] = of.law.gap().map_or(0.0, |gap| gap.value(values).min(0.0));
    }
    if gaps.iter().all(|gap| *gap == 0.0) {
        return [gaps.clone(), gaps];
    }
    [-(&system.stiffness * &gaps), system.stiffness.abs() * gaps.abs()]
}

fn effect(
    system: &ContactSystem,
    signs: &[[bool; 2]],
    gaps: &[DVector<f64>; 2],
    coupled: &[bool],
    pair: usize,
) -> Effect {
    if system.pairs[pair].law.is_bilateral() {
        // It holds both ways.
        return Effect::Pressed;
    }
    let mut pulled = (gaps[0][pair] < -ROUNDING * gaps[1][pair]).then_some(None);
    if gaps[0][pair] > ROUNDING * gaps[1][pair] {
        return Effect::Pressed;
    }
    for (index, (case, [plus, minus])) in system.loads.iter().zip(signs).enumerate() {
        let (force, rounding) = (case.vector[pair], ROUNDING * case.terms[pair]);
        if *plus && force > rounding || *minus && force < -rounding {
            return Effect::Pressed;
        }
        if *plus && force < -rounding || *minus && force > rounding {
            pulled = pulled.or(Some(Some(index)));
        }
    }
    if let Some(case) = pulled {
        return Effect::Pulled(case);
    }
    if coupled[pair] { Effect::Perhaps } else { Effect::Untouched }
}

/// For each joint: whether it is connected, through entries of R, with one that a case loads.
fn coupled(system: &ContactSystem) -> Vec<bool> {
    let (r, k) = (&system.stiffness, system.joint_count());
    let is_loaded =
        |joint: usize| system.loads.iter().any(|case| case.vector[joint].abs() > ROUNDING * case.terms[joint]);
    let mut reached: Vec<bool> = (0..k).map(is_loaded).collect();
    let mut next: Vec<usize> = (0..k).filter(|&joint| reached[joint]).collect();
    while let Some(joint) = next.pop() {
        for other in 0..k {
            let size = (r[(joint, joint)] * r[(other, other)]).sqrt();
            if !reached[other] && r[(joint, other)].abs() > UNCOUPLED * size {
                reached[other] = true;
                next.push(other);
            }
        }
    }
    reached
}
