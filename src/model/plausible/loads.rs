//! Load cases that load nothing.

use std::collections::HashMap;

use super::{Warning, keys, texts};
use crate::model::parameter::Number;
use crate::model::scenario::{GivenContactSystem, Scenario, Stage};
use crate::model::structure::{Load, Structure};
use crate::model::tree::{Kind, Node};

/// Cases whose loads are nothing whatever the parameters are, items without the property they need, cases that never
/// act.
pub fn of_structure(scenario: &Scenario, structure: &Structure, file: Node<'_>) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let materials = Materials::of(structure, file);
    for case in &structure.load_cases {
        let path = format!("loads.{}", case.name);
        let of_case = file.get("loads").and_then(|loads| loads.get(&case.name));
        let items = of_case.and_then(|of_case| of_case.get("items"));
        let without = without_property(&materials, structure, file, &path, items);
        let mut formulas = Vec::new();
        items.into_iter().for_each(|items| texts_of_numbers(items, &mut formulas));
        let empty = items.is_none_or(|items| items.items().len() == 0);
        if case.loads.is_empty() && empty {
            let help = "give it `items`, or name it as the `case` of a settlement; or remove it";
            warnings.push(Warning::new(&path, format!("the load case `{}` acts on nothing", case.name), help));
        } else if without.is_empty()
            && formulas.is_empty()
            && !case.loads.is_empty()
            && case.loads.iter().all(is_nothing)
        {
            let message = format!("all the loads of the case `{}` are zero", case.name);
            warnings.push(Warning::new(&path, message, "give them their amount, or remove the case"));
        }
        warnings.extend(without);
        warnings.extend(counted(scenario, &case.name, &case.factor, &path));
    }
    warnings
}

/// The same for a contact system of a file.
pub fn of_contact_system(scenario: &Scenario, system: &GivenContactSystem) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for load in &system.loads {
        let path = format!("contact_system.loads.{}", load.name);
        if load.vector.iter().all(|force| *force == 0.0) {
            let message = format!("the vector of the load case `{}` is zero", load.name);
            warnings.push(Warning::new(&path, message, "give it its forces, or remove the case"));
        }
        warnings.extend(counted(scenario, &load.name, &load.factor, &path));
    }
    warnings
}

/// A case that never acts: its own factor is 0, or no stage and no combination names it.
fn counted(scenario: &Scenario, case: &str, factor: &Number, path: &str) -> Option<Warning> {
    if *factor == Number::Value(0.0) {
        return Some(Warning::new(
            format!("{path}.factor"),
            format!("the factor of the load case `{case}` is 0: it never acts, in stages and combinations neither"),
            "give it a factor or a parameter, or remove the case",
        ));
    }
    let names =
        |stage: &Stage| stage.multipliers.iter().any(|(name, number)| name == case && *number != Number::Value(0.0));
    let mut all = scenario.stages.iter().chain(scenario.combinations.iter().map(|(_, stage)| stage));
    (!scenario.stages.is_empty() && !all.any(names)).then(|| {
        Warning::new(
            path,
            format!("no stage and no combination counts the load case `{case}`: the load history leaves it out"),
            "name it in the `stages` in which it acts, or remove it",
        )
    })
}

/// Gravity on elements without density, temperature on elements without expansion.
fn without_property(
    materials: &Materials<'_>,
    structure: &Structure,
    file: Node<'_>,
    path: &str,
    items: Option<Node<'_>>,
) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for (index, item) in items.into_iter().flat_map(Node::items).enumerate() {
        for (load, property) in [("gravity", "density"), ("temperature", "expansion")] {
            let Some(of_load) = item.get(load) else { continue };
            // A name that is not an element of the file is one of a mesh: its material is not looked for.
            let Some(on) = materials.on(of_load.get("on")) else { continue };
            let has = |&material: &usize| {
                let material = &structure.materials[material];
                if load == "gravity" { material.density != 0.0 } else { material.expansion != 0.0 }
            };
            let given = |&material: &usize| {
                let of_material = file.get("materials").and_then(|all| all.get(materials.names[material]));
                of_material.and_then(|of| of.get(property)).is_some_and(|value| value.kind() == Kind::String)
            };
            if on.iter().any(|material| has(material) || given(material)) {
                continue;
            }
            let mut named: Vec<&str> = on.iter().map(|&material| materials.names[material]).collect();
            named.dedup();
            let whose = match named[..] {
                [] => "there are no elements".to_owned(),
                [one] => format!("the {property} of `{one}` is 0"),
                _ => format!("the {property} of {} is 0", named.join(", ")),
            };
            warnings.push(Warning::new(
                format!("{path}.items[{index}].{load}"),
                format!("this {load} does nothing: {whose}"),
                format!("give the material its `{property}`, or remove the load"),
            ));
        }
    }
    warnings
}

/// The materials of the file and of its elements.
struct Materials<'v> {
    names: Vec<&'v str>,
    /// Indices of the materials of all elements, in increasing order.
    used: Vec<usize>,
    /// Index of the material of each bar, plate, quad and triangle, by its id.
    of: HashMap<&'v str, usize>,
}

impl<'v> Materials<'v> {
    fn of(structure: &Structure, file: Node<'v>) -> Materials<'v> {
        let names: Vec<&str> = keys(file, "materials").collect();
        let number: HashMap<&str, usize> = names.iter().enumerate().map(|(index, name)| (*name, index)).collect();
        let lists = ["bars", "plates", "bricks", "quads", "triangles"].iter().filter_map(|key| file.get(key));
        let material =
            |entry: Node<'v>| Some((entry.get("id")?.as_str()?, *number.get(entry.get("material")?.as_str()?)?));
        let of = lists.flat_map(Node::items).filter_map(material).collect();
        let mut used: Vec<usize> = structure.elements.iter().map(|element| element.material).collect();
        used.sort_unstable();
        used.dedup();
        Materials { names, used, of }
    }

    /// Those of the elements that a load is on, by index; `None` where a name cannot be followed.
    fn on(&self, on: Option<Node<'_>>) -> Option<Vec<usize>> {
        let Some(on) = on else { return Some(self.used.clone()) };
        if on.kind() != Kind::Array {
            return None;
        }
        on.items().map(|id| self.of.get(id.as_str()?).copied()).collect()
    }
}

/// The texts of a list of loads that may be numbers: all but names.
fn texts_of_numbers<'v>(items: Node<'v>, found: &mut Vec<&'v str>) {
    const NAMES: [&str; 6] = ["at", "edge", "bar", "on", "axes", "face"];
    match items.kind() {
        Kind::Array => items.items().for_each(|value| texts_of_numbers(value, found)),
        Kind::Object => {
            let may_be = |key: Node<'_>| key.as_str().is_some_and(|key| !NAMES.contains(&key));
            let values = items.properties().filter(|(key, _)| may_be(*key));
            values.for_each(|(_, value)| texts_of_numbers(value, found));
        }
        _ => texts(items, found),
    }
}

/// Whether a load is zero.
fn is_nothing(load: &Load) -> bool {
    match load {
        // Its number may be a parameter, and stands with its support.
        Load::Settlement { .. } => false,
        Load::Nodal { .. } | Load::Element { .. } => load.is_nothing(),
    }
}
