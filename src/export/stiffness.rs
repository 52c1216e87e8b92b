//! K and F of a structure in Matrix Market files, and the scenario that reads them back as a superelement.

use std::collections::{HashMap, HashSet};
use std::io::{self, Write};

use serde_json::{Map, Value, json};

use crate::fem::matrices::Matrices;
use crate::model::pair::Pair;
use crate::model::parameter::ParameterValues;
use crate::model::scenario::FORMAT;
use crate::model::structure::{Component, Dimension, Load, Spring, Structure};
use crate::model::units::Units;

/// A structure with its matrices and its values.
pub struct Stiffness<'a> {
    /// The structure at these values.
    pub structure: &'a Structure,
    /// The values.
    pub values: &'a ParameterValues,
    /// Its K and F.
    pub matrices: &'a Matrices,
}

/// Ids of the format for names of every kind, none twice: `lower[0,8]` becomes `lower_0_8`.
#[derive(Default)]
struct Ids(HashSet<String>);

impl Ids {
    fn of(&mut self, name: &str) -> String {
        let plain: String =
            name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '_' }).collect();
        let plain = plain.trim_end_matches('_');
        let base =
            if plain.starts_with(|c: char| c.is_ascii_alphabetic()) { plain.to_owned() } else { format!("n_{plain}") };
        let mut id = base.clone();
        let mut number = 1;
        while !self.0.insert(id.clone()) {
            number += 1;
            id = format!("{base}-{number}");
        }
        id
    }
}

impl Stiffness<'_> {
    /// The scenario beside the matrices, and how many pairs it cannot express: those of edges whose nodes do not match.
    /// `file` gives the name of the file of K (`None`) or of a load case.
    pub fn scenario(&self, title: &str, units: &Units, file: &dyn Fn(Option<&str>) -> String) -> (Value, usize) {
        let mut ids = Ids::default();
        let dimension = self.structure.dimension;
        let word = |component: Component| dimension.word(component);
        let nodes: Vec<String> = self.structure.nodes.iter().map(|node| ids.of(&node.id)).collect();
        let cases = self.structure.load_cases.iter().map(|case| {
            let factor = case.factor.value(self.values);
            (case.name.clone(), json!({"file": file(Some(&case.name)), "factor": factor}))
        });
        let places = self
            .structure
            .nodes
            .iter()
            .zip(&nodes)
            .map(|(node, id)| (id.clone(), json!(dimension.shown(node.position))));
        let dofs = self.matrices.dofs.iter().map(|(node, component)| json!([nodes[*node], word(*component)]));
        let named = |list: &[usize]| list.iter().map(|&node| nodes[node].clone()).collect::<Vec<_>>();
        let ties = self.structure.ties.iter().filter_map(|tie| {
            let exists = |component: &&Component| tie.nodes.iter().all(|&node| self.has(node, **component));
            let fixed: Vec<&str> = tie.components.iter().filter(exists).map(|component| word(*component)).collect();
            (!fixed.is_empty()).then(|| json!({"nodes": named(&tie.nodes), "fixed": fixed}))
        });
        let rigid =
            self.structure.rigid.iter().map(|body| json!({"id": ids.of(&body.id), "nodes": named(&body.nodes)}));
        let rigid: Vec<Value> = rigid.collect();
        let (told, untold): (Vec<&Pair>, Vec<&Pair>) =
            self.structure.pairs.iter().partition(|pair| Pair::is_of_nodes(pair));
        let contacts = told.into_iter().map(|pair| self.contact(pair, &nodes, ids.of(&pair.id)));
        let contacts: Vec<Value> = contacts.collect();
        let acts = |spring: &&Spring| {
            let mut felt = spring.terms.iter().filter(|term| term.factor != 0.0);
            felt.all(|term| self.has(term.node, term.component))
        };
        let springs = self.structure.springs.iter().filter(acts);
        let mut scenario = json!({
            "format": FORMAT,
            "title": title,
            "superelement": {
                "stiffness": {"file": file(None)},
                "loads": cases.collect::<Map<String, Value>>(),
                "nodes": places.collect::<Map<String, Value>>(),
                "dofs": dofs.collect::<Vec<Value>>(),
            },
            "supports": self.supports(&nodes),
            "ties": ties.collect::<Vec<Value>>(),
            "rigid": rigid,
            "springs": springs.map(|one| self.spring(one, &nodes)).collect::<Vec<Value>>(),
            "contacts": contacts,
        });
        if let Some(labels) = units.json() {
            scenario["units"] = labels;
        }
        if dimension == Dimension::Space {
            scenario["dimension"] = json!(3);
        }
        (scenario, untold.len())
    }

    /// Whether the displacement is a row of K. A rotation that no bar feels and nothing resists is none: what holds it
    /// does nothing, and is refused beside a superelement.
    fn has(&self, node: usize, component: Component) -> bool {
        self.matrices.dofs.binary_search(&(node, component)).is_ok()
    }

    /// One entry for each node, and one more for each further case that moves it.
    fn supports(&self, nodes: &[String]) -> Vec<Value> {
        let mut settlements: HashMap<usize, Vec<(&str, [f64; 6])>> = HashMap::new();
        for case in &self.structure.load_cases {
            for load in &case.loads {
                let Load::Settlement { node, component, value } = *load else { continue };
                let of = settlements.entry(node).or_default();
                if of.last().is_none_or(|(name, _)| *name != case.name) {
                    of.push((&case.name, [0.0; 6]));
                }
                if let Some((_, amounts)) = of.last_mut() {
                    amounts[component as usize] += value;
                }
            }
        }
        let mut fixed: Vec<(usize, Vec<&str>)> = Vec::new();
        let mut place_of = HashMap::new();
        for support in self.structure.supports.iter().filter(|support| self.has(support.node, support.component)) {
            let place = *place_of.entry(support.node).or_insert_with(|| {
                fixed.push((support.node, Vec::new()));
                fixed.len() - 1
            });
            fixed[place].1.push(self.structure.dimension.word(support.component));
        }
        let components = self.structure.dimension.components();
        let entry = |(node, fixed): (usize, Vec<&str>)| match settlements.get(&node) {
            None => vec![json!({"at": nodes[node], "fixed": fixed})],
            Some(of) => of
                .iter()
                .map(|(case, amounts)| {
                    let amounts: Vec<f64> = components.iter().map(|&component| amounts[component as usize]).collect();
                    json!({"at": nodes[node], "fixed": fixed, "settlement": amounts, "case": case})
                })
                .collect(),
        };
        fixed.into_iter().flat_map(entry).collect()
    }

    fn contact(&self, pair: &Pair, nodes: &[String], id: String) -> Value {
        let against = pair.weights.get(1).map_or("ground", |(node, _)| nodes[*node].as_str());
        let mut contact = json!({
            "id": id, "node": nodes[pair.node], "against": against, "normal": self.structure.dimension.shown(pair.normal), "law": pair.law.kind(),
        });
        if self.structure.dimension == Dimension::Space {
            contact["tangent"] = json!(pair.tangents[0]);
        }
        for (key, number) in pair.law.numbers() {
            contact[key] = json!(number.value(self.values));
        }
        contact
    }

    fn spring(&self, spring: &Spring, nodes: &[String]) -> Value {
        let ends = spring.nodes();
        let factor = |wanted: Component| {
            let own = spring.terms.iter().find(|term| term.node == ends[0] && term.component == wanted);
            own.map_or(0.0, |term| term.factor)
        };
        let dimension = self.structure.dimension;
        let axis = Component::ROTATIONS.map(factor);
        let mut value = if axis == [0.0; 3] {
            let direction = dimension.shown(Component::TRANSLATIONS.map(factor));
            json!({"direction": direction, "stiffness": spring.stiffness})
        } else if dimension.rotations().len() == 1 {
            json!({"rotation": spring.stiffness})
        } else {
            json!({"direction": axis, "rotation": spring.stiffness})
        };
        match ends[..] {
            [a, b, ..] => value["between"] = json!([nodes[a], nodes[b]]),
            _ => value["at"] = json!(nodes[ends[0]]),
        }
        value
    }
}

/// Writes K as the lower triangle of a symmetric matrix in coordinate format.
///
/// # Errors
/// Those of `out`.
pub fn matrix(out: &mut dyn Write, matrices: &Matrices) -> io::Result<()> {
    let order = matrices.dofs.len();
    writeln!(out, "%%MatrixMarket matrix coordinate real symmetric")?;
    writeln!(out, "% K without supports and springs; the rows are the dofs of the scenario beside it")?;
    writeln!(out, "{order} {order} {}", matrices.stiffness.len())?;
    matrices.stiffness.iter().try_for_each(|(i, j, value)| writeln!(out, "{} {} {value:e}", i + 1, j + 1))
}
