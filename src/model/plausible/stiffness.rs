//! Stiffness, weight and sections against what structures are made of, where both units are named and known.

use super::units::Sizes;
use super::{Warning, keys};
use crate::model::scenario::Scenario;
use crate::model::structure::{ElementLoad, Load, Structure};
use crate::model::tree::Node;
use crate::model::vector;

/// Word in a material's name, Young's modulus in N/m², weight in N/m³: what such materials commonly have.
const KNOWN: &[(&str, f64, f64)] = &[
    ("steel", 2.1e11, 7.7e4),
    ("iron", 1.5e11, 7.2e4),
    ("alumin", 7e10, 2.7e4),
    ("concrete", 3e10, 2.4e4),
    ("timber", 1e10, 5e3),
    ("wood", 1e10, 5e3),
    ("glass", 7e10, 2.5e4),
    ("granite", 5e10, 2.7e4),
    ("stone", 3e10, 2.5e4),
    ("brick", 8e9, 1.8e4),
    ("masonry", 5e9, 2e4),
];

/// What else structures are made of, from soft timber to steel, and its weight, from timber to steel.
const STIFFNESS: [f64; 2] = [1e9, 2.1e11];
const WEIGHT: [f64; 2] = [5e3, 8e4];

/// A unit taken for another is off by 10³ or more; the numbers of one material differ by a factor of three at most.
const OFF: f64 = 300.0;

/// How many times a value is off a range, > 1 above it and < 1 below it.
fn off(value: f64, [least, largest]: [f64; 2]) -> f64 {
    if value > largest { value / largest } else { (value / least).min(1.0) }
}

fn is_off(ratio: f64) -> bool {
    !(1.0 / OFF..=OFF).contains(&ratio)
}

/// "about 1000 times as much", "about 1e6 times less".
fn times(ratio: f64) -> String {
    let power = |ratio: f64| match ratio.log10().round() {
        exponent if exponent <= 4.0 => format!("{}", 10f64.powf(exponent)),
        exponent => format!("1e{exponent}"),
    };
    if ratio > 1.0 {
        format!("about {} times less", power(ratio))
    } else {
        format!("about {} times as much", power(1.0 / ratio))
    }
}

/// What a material of this name has: what it is called, and the range.
fn expected(name: &str, column: impl Fn(&(&str, f64, f64)) -> f64, range: [f64; 2]) -> (&'static str, [f64; 2]) {
    let lower = name.to_ascii_lowercase();
    match KNOWN.iter().find(|(word, ..)| lower.contains(word)) {
        Some(entry) => (if entry.0 == "alumin" { "aluminium" } else { entry.0 }, [column(entry); 2]),
        None => ("what structures are made of", range),
    }
}

fn of_range([least, largest]: [f64; 2], unit: &str) -> String {
    if least == largest { format!("{least:e} {unit}") } else { format!("{least:e} to {largest:e} {unit}") }
}

/// Materials that are stiffer or softer than anything of their name by 10³.
pub fn materials(scenario: &Scenario, structure: &Structure, file: Node<'_>) -> Vec<Warning> {
    let Some(sizes) = Sizes::of(&scenario.units) else { return Vec::new() };
    let label = label(scenario, "²");
    let mut warnings = Vec::new();
    for (name, material) in keys(file, "materials").zip(&structure.materials) {
        let unit = sizes.force_over_length(2);
        let stiffness = material.youngs_modulus * unit;
        let (of, range) = expected(name, |entry| entry.1, STIFFNESS);
        let ratio = off(stiffness, range);
        // A body may be called rigid, and be as stiff as one likes.
        let rigid = ["rigid", "stiff"].iter().any(|word| name.to_ascii_lowercase().contains(word));
        if !is_off(ratio) || rigid && ratio > 1.0 {
            continue;
        }
        warnings.push(Warning::new(
            format!("materials.{name}.E"),
            format!(
                "`{name}` has E = {} {label} = {stiffness:.3e} N/m²; {of} has {}, {}",
                material.youngs_modulus,
                of_range(range, "N/m²"),
                times(ratio),
            ),
            format!("in {label} that is {}; or correct `units`", of_range(range.map(|end| end / unit), "").trim_end()),
        ));
    }
    warnings
}

/// Materials whose weight, density times acceleration, is off by 10³: mass in kg where forces are in kN, say.
pub fn weights(scenario: &Scenario, structure: &Structure, file: Node<'_>) -> Vec<Warning> {
    let Some(sizes) = Sizes::of(&scenario.units) else { return Vec::new() };
    let label = label(scenario, "³");
    let values = scenario.parameter_values();
    let mut heaviest = vec![0f64; structure.materials.len()];
    for case in &structure.load_cases {
        let factor = case.factor.value(&values).abs();
        for load in &case.loads {
            if let Load::Element { element, load: ElementLoad::Body(value) } = load {
                let of = &mut heaviest[structure.elements[*element].material];
                *of = of.max(factor * value[0].hypot(value[1]));
            }
        }
    }
    let mut warnings = Vec::new();
    for (name, heaviest) in keys(file, "materials").zip(heaviest).filter(|(_, heaviest)| *heaviest > 0.0) {
        let weight = heaviest * sizes.force_over_length(3);
        let (of, range) = expected(name, |entry| entry.2, WEIGHT);
        let ratio = off(weight, range);
        if is_off(ratio) {
            warnings.push(Warning::new(
                format!("materials.{name}.density"),
                format!(
                    "`{name}` weighs {heaviest} {label} = {weight:.3e} N/m³ (density times acceleration); {of} weighs {}, {}",
                    of_range(range, "N/m³"),
                    times(ratio),
                ),
                format!(
                    "density times acceleration must be in {label}: with forces in kN and lengths in m give tonnes per m³"
                ),
            ));
        }
    }
    warnings
}

/// Sections whose numbers do not fit each other, or not the structure: areas in cm² beside lengths in m, say.
pub fn sections(scenario: &Scenario, structure: &Structure, file: Node<'_>) -> Vec<Warning> {
    if Sizes::of(&scenario.units).is_none() {
        return Vec::new();
    }
    let extent = vector::length(structure.extent());
    let length = scenario.units.length.as_deref().unwrap_or_default();
    let bars: Vec<Node<'_>> = file.get("bars").into_iter().flat_map(Node::items).collect();
    let mut seen: Vec<String> = Vec::new();
    let mut warnings = Vec::new();
    for (element, place) in structure.elements.iter().zip(&scenario.places.elements) {
        let Some((area, inertias)) = element.section() else { continue };
        let Some(name) = section_at(&bars, place) else { continue };
        let path = format!("sections.{name}");
        if seen.contains(&path) {
            continue;
        }
        let Some(message) = inertias.into_iter().find_map(|inertia| {
            let (shape, gyration) = (inertia / (area * area), (inertia / area).sqrt());
            if !(1e-7..=1e6).contains(&shape) {
                Some(format!(
                    "the area {area} and the inertia {inertia} of `{name}` are not of one section: inertia/area² is \
                     {shape:.1e}, of real sections 1e-4 to 1e2"
                ))
            } else if gyration > extent {
                Some(format!(
                    "`{name}` is deeper than the structure is large: its radius of gyration is {gyration:.3} {length}, \
                     the whole structure {extent:.3} {length}"
                ))
            } else {
                None
            }
        }) else {
            continue;
        };
        let help = format!("give the area in {length}² and the inertia in {length}⁴");
        warnings.push(Warning::new(path.clone(), message, help));
        seen.push(path);
    }
    warnings
}

/// The section of the bar that stands at a place of the file.
fn section_at<'v>(bars: &[Node<'v>], place: &str) -> Option<&'v str> {
    let index: usize = place.strip_prefix("bars[")?.strip_suffix(']')?.parse().ok()?;
    bars.get(index)?.get("section")?.as_str()
}

/// `kN/m²` in the units of the scenario.
fn label(scenario: &Scenario, power: &str) -> String {
    let (force, length) = (scenario.units.force.as_deref(), scenario.units.length.as_deref());
    format!("{}/{}{power}", force.unwrap_or_default(), length.unwrap_or_default())
}
