//! Resultants of the contacts of edges and faces.

use std::collections::HashMap;

use super::facts::Facts;
use super::value::NoValue;
use crate::answer::record::PairState;
use crate::answer::rounding::balance;
use crate::model::quantity::ResultantPart;
use crate::model::vector::{cross, length};

/// Resultant of the forces of the contact of an edge or a face.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Resultant {
    /// Id of the contact.
    pub joint: String,
    /// Σ x_n.
    #[serde(rename = "N")]
    pub normal: f64,
    /// Σ x_t; in space the length of the sum of the vectors.
    #[serde(rename = "T")]
    pub tangential: f64,
    /// Distance of N from the middle, > 0 towards later nodes; `None` where N = 0, and in space.
    #[serde(rename = "e")]
    pub eccentricity: Option<f64>,
    /// Whether it is one of a face, along which there is no single direction to measure e in.
    #[serde(skip)]
    pub over_face: bool,
}

/// Friction of a pair in space: in global axes, or along t1 and t2 where those are not known.
fn friction(pair: &PairState) -> [f64; 3] {
    let Some(space) = &pair.space else { return [0.0; 3] };
    let [along, across] = space.x_t;
    let [t1, t2] = match space.frame {
        Some([normal, t1]) => [t1, cross(normal, t1)],
        None => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    };
    std::array::from_fn(|c| along * t1[c] + across * t2[c])
}

impl Facts<'_> {
    pub(super) fn of_joint(&self, joint: &str, part: ResultantPart) -> Result<f64, NoValue> {
        let found = self.resultant(joint).ok_or_else(|| self.missing())?;
        match part {
            ResultantPart::Normal => Ok(found.normal),
            ResultantPart::Tangential => Ok(found.tangential),
            ResultantPart::Eccentricity => {
                let why = match self.pairs.iter().any(|pair| pair.space.is_some()) {
                    true => "no eccentricity over a face: e is measured along the nodes of an edge",
                    false => "no eccentricity where N = 0",
                };
                found.eccentricity.ok_or_else(|| NoValue(why.to_owned()))
            }
        }
    }

    /// Of an edge contact.
    pub fn resultant(&self, joint: &str) -> Option<Resultant> {
        let head = format!("{joint}[");
        let pairs: Vec<&PairState> = self.pairs.iter().filter(|pair| pair.id.starts_with(&head)).collect();
        let normal = balance(pairs.iter().map(|pair| pair.x_n));
        if pairs.iter().any(|pair| pair.space.is_some()) {
            let friction: Vec<[f64; 3]> = pairs.iter().map(|pair| friction(pair)).collect();
            let tangential = length([0, 1, 2].map(|c| balance(friction.iter().map(|force| force[c]))));
            return Some(Resultant {
                joint: joint.to_owned(),
                normal,
                tangential,
                eccentricity: None,
                over_face: true,
            });
        }
        let tangential = balance(pairs.iter().map(|pair| pair.x_t));
        let places = self.places(joint, &pairs);
        let moments: Option<Vec<f64>> = pairs.iter().zip(&places).map(|(pair, s)| Some(pair.x_n * (*s)?)).collect();
        let moment = moments.map(|moments| balance(moments.into_iter()));
        let eccentricity = moment.map(|moment| moment / normal).filter(|e| normal != 0.0 && e.is_finite());
        (!pairs.is_empty()).then(|| Resultant {
            joint: joint.to_owned(),
            normal,
            tangential,
            eccentricity,
            over_face: false,
        })
    }

    /// Places of pairs of a joint along it, from its middle: along the nodes of its edge, or by the positions of a given
    /// contact system.
    fn places(&self, joint: &str, pairs: &[&PairState]) -> Vec<Option<f64>> {
        if let Ok((structure, _)) = self.structure()
            && let Some(edge) = structure.edge_contacts.iter().find(|edge| edge.id == joint)
        {
            let at = |node: usize| structure.nodes[node].position;
            let mut lengths = vec![0.0];
            for ends in edge.nodes.windows(2) {
                let (a, b) = (at(ends[0]), at(ends[1]));
                lengths.push(lengths[lengths.len() - 1] + (b[0] - a[0]).hypot(b[1] - a[1]));
            }
            let middle = 0.5 * lengths[lengths.len() - 1];
            let index = |id: &str| id.strip_prefix(joint)?.strip_prefix('[')?.strip_suffix(']')?.parse::<usize>().ok();
            // at its node, or between two
            let of_node =
                |node: usize| [edge.nodes.iter().position(|&own| own == node).map_or(f64::NAN, |k| lengths[k])];
            let between: HashMap<&str, f64> = (structure.pairs.iter())
                .filter(|pair| pair.contact() == joint && pair.place.len() > 1)
                .map(|pair| (pair.id.as_str(), pair.at_place(of_node)[0]))
                .collect();
            let along = |id: &str| between.get(id).copied().or_else(|| lengths.get(index(id)?).copied());
            return pairs.iter().map(|pair| Some(along(&pair.id)? - middle)).collect();
        }
        let place = |pair: &&PairState| pair.position.map(|at| at[0]);
        let ends = pairs.first().and_then(place).zip(pairs.last().and_then(place));
        pairs.iter().map(|pair| Some(place(pair)? - ends.map(|(a, b)| 0.5 * (a + b))?)).collect()
    }
}
