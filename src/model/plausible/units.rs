//! Labels of units as numbers, as far as they are known; nothing else in the program converts anything.

use super::{Warning, texts};
use crate::model::scenario::Scenario;
use crate::model::tree::Node;
use crate::model::units::Units;

/// Lengths in metres, forces in newtons.
const LENGTHS: &[(&str, f64)] =
    &[("m", 1.0), ("dm", 0.1), ("cm", 1e-2), ("mm", 1e-3), ("km", 1e3), ("in", 0.0254), ("ft", 0.3048)];
const FORCES: &[(&str, f64)] = &[
    ("N", 1.0),
    ("kN", 1e3),
    ("MN", 1e6),
    ("GN", 1e9),
    ("kgf", 9.80665),
    ("kp", 9.80665),
    ("tf", 9806.65),
    ("lbf", 4.448_221_615_260_5),
    ("kip", 4_448.221_615_260_5),
];

/// A label of a force times a power of a length is a power law in both.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Dimension {
    force: i32,
    length: i32,
    /// In newtons and metres.
    size: f64,
}

/// The sizes of the units of a scenario in newtons and metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    length: f64,
    force: f64,
}

impl Sizes {
    /// Those of known labels; `None` if one of them is missing or unknown.
    pub fn of(units: &Units) -> Option<Sizes> {
        let length = units.length.as_deref().and_then(|label| known(label, LENGTHS))?;
        let force = units.force.as_deref().and_then(|label| known(label, FORCES))?;
        Some(Sizes { length, force })
    }

    /// One unit of force over one of length to a power, in newtons and metres.
    pub fn force_over_length(&self, power: i32) -> f64 {
        self.force / self.length.powi(power)
    }
}

fn known(label: &str, table: &[(&str, f64)]) -> Option<f64> {
    table.iter().find(|(word, _)| *word == label.trim()).map(|(_, size)| *size)
}

/// `kN/m²`, `N·mm`, `kN*m^2`; `None` if it is not a product of known forces and lengths.
fn dimension(label: &str) -> Option<Dimension> {
    let mut all = Dimension { force: 0, length: 0, size: 1.0 };
    for (index, part) in label.split('/').enumerate() {
        for factor in part.split(['·', '*', ' ']).filter(|factor| !factor.is_empty()) {
            if factor == "1" {
                continue;
            }
            let (word, power) = match factor.trim_end_matches(|c: char| c == '²' || c == '³' || c.is_ascii_digit()) {
                word if word.len() == factor.len() => (factor, 1),
                word => {
                    let power = match &factor[word.len()..] {
                        "²" => 2,
                        "³" => 3,
                        digits => digits.parse().ok()?,
                    };
                    (word.trim_end_matches('^'), power)
                }
            };
            let power = if index == 0 { power } else { -power };
            let size = if let Some(size) = known(word, FORCES) {
                all.force += power;
                size
            } else {
                all.length += power;
                known(word, LENGTHS)?
            };
            all.size *= size.powi(power);
        }
    }
    Some(all)
}

/// Parameters whose unit differs by 10³ or more from the one that their number counts in, where it stands as it is.
pub fn of_parameters(scenario: &Scenario, file: Node<'_>) -> Vec<Warning> {
    let Some(sizes) = Sizes::of(&scenario.units) else { return Vec::new() };
    let mut standing = Vec::new();
    let parts = file.properties().filter(|(key, _)| key.as_str() != Some("parameters"));
    parts.for_each(|(_, value)| texts(value, &mut standing));
    let mut warnings = Vec::new();
    for (name, parameter) in scenario.parameters.iter().filter(|(_, parameter)| parameter.formula.is_none()) {
        let Some(label) = parameter.unit.as_deref() else { continue };
        let Some(unit) = dimension(label) else { continue };
        let expected = sizes.force.powi(unit.force) * sizes.length.powi(unit.length);
        let off = (unit.size / expected).log10().abs();
        // 10³ but for the rounding of powers
        if off < 2.999 || !standing.contains(&name.as_str()) {
            continue;
        }
        let (length, force) = (scenario.units.length.as_deref(), scenario.units.force.as_deref());
        let (length, force) = (length.unwrap_or_default(), force.unwrap_or_default());
        warnings.push(Warning::new(
            format!("parameters.{name}.unit"),
            format!("`{name}` is said to be in {label}, but the scenario counts in {force} and {length}"),
            "nothing is converted: give its number in the units of the scenario, or write the factor where it stands, \
             like \"F/1000\"",
        ));
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_products_of_powers() {
        let size = |label: &str| dimension(label).map(|d| (d.force, d.length, d.size));
        assert_eq!(size("kN"), Some((1, 0, 1e3)));
        assert_eq!(size("kN·m"), Some((1, 1, 1e3)));
        assert_eq!(size("kN/m²"), Some((1, -2, 1e3)));
        assert_eq!(size("kN/m^3"), Some((1, -3, 1e3)));
        assert_eq!(size("1/m"), Some((0, -1, 1.0)));
        let (force, length, pressure) = size("N/mm²").unwrap();
        assert_eq!((force, length), (1, -2));
        assert!((pressure - 1e6).abs() < 1.0);
        for unknown in ["K", "°", "kN/K", "m^x", "µm"] {
            assert_eq!(size(unknown), None, "{unknown}");
        }
    }
}
