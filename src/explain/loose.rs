//! Before solving: which parts only contact holds, and how they could move.

use nalgebra::DVector;
use serde::Serialize;

use super::mode::{listed_parts, pair_words, parts};
use super::rigid::{RigidMotion, direction_word};
use crate::contact::system::ContactSystem;
use crate::fem::Motion;
use crate::model::pair::joints;
use crate::model::structure::Structure;
use crate::text::words::{list, short};

/// A part and the ways in which it can move when every contact joint is off.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoosePart {
    /// Its name: `` `upper` ``; several parts that only move together are named together.
    pub name: String,
    /// "slide along x", "lift off", "turn".
    pub motions: Vec<String>,
}

impl LoosePart {
    /// "`upper` can slide along x, lift off and turn; only contact holds it".
    pub fn sentence(&self) -> String {
        const OF_A_BODY_IN_SPACE: usize = 6;
        let motions = match self.motions.len() {
            OF_A_BODY_IN_SPACE => "move along every axis and turn about every axis".to_owned(),
            _ => list(&self.motions),
        };
        format!("{} can {motions}; only contact holds it", self.name)
    }
}

/// The loose parts of a structure, from a basis of the motions that cost nothing.
pub fn loose_parts(structure: &Structure, motions: &[Motion]) -> Vec<LoosePart> {
    let joints = joints(&structure.pairs);
    let m = structure.pairs.len();
    let mut found: Vec<LoosePart> = Vec::new();
    for motion in motions {
        let opens = joints.iter().take(m).any(|joint| {
            let z: f64 = joint
                .terms
                .iter()
                .map(|(node, a)| std::iter::zip(a, &motion.u[*node]).map(|(a, u)| a * u).sum::<f64>())
                .sum();
            z.abs() > 1e-9
        });
        let rigid = parts(structure, &motion.u).unwrap_or_default();
        let (name, words) = match rigid.as_slice() {
            [one] => (
                one.name.clone(),
                match &one.motion {
                    RigidMotion::Translation(u) => {
                        let axis = direction_word(*u, one.dimension);
                        let axis = axis.trim_start_matches(['+', '-']);
                        if opens { format!("lift off along {axis}") } else { format!("slide along {axis}") }
                    }
                    RigidMotion::Rotation { point, turn, .. } => {
                        format!("turn about {}", RigidMotion::about(one.dimension, *point, *turn, short))
                    }
                },
            ),
            [] => ("the structure".to_owned(), "move as an internal mechanism".to_owned()),
            several => {
                let names: Vec<String> = several.iter().map(|part| part.name.clone()).collect();
                (listed_parts(&names, "parts"), "move against each other as a mechanism".to_owned())
            }
        };
        match found.iter_mut().find(|part| part.name == name) {
            Some(part) => {
                if !part.motions.contains(&words) {
                    part.motions.push(words);
                }
            }
            None => found.push(LoosePart { name, motions: vec![words] }),
        }
    }
    found
}

/// The motions of a contact system without a structure, pair by pair.
pub fn loose_pairs(system: &ContactSystem) -> Vec<String> {
    system
        .kernel
        .column_iter()
        .map(|column| {
            let z: DVector<f64> = column.into_owned();
            let words = pair_words(system, &z);
            format!("costs no energy: {}", words.join("; "))
        })
        .collect()
}
