//! Tractions: what the pairs of an edge or of a face carry, per length or area of it.

use std::collections::HashSet;

use serde::Serialize;

use super::plot_zone::{Labelled, ZonePicture, borrowed, labelled};
use crate::answer::record::PairState;
use crate::model::tributary::tributary_lengths;
use crate::session::{CommandError, Session};
use crate::view::plot::face_map::tractions;
use crate::view::plot::zone;

/// Forces per length of edge, or per area of face.
#[derive(Serialize)]
pub(super) struct Tractions {
    at: String,
    pairs: Vec<Traction>,
}

#[derive(Serialize)]
struct Traction {
    id: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    length: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    area: Option<f64>,
    normal: f64,
    tangential: f64,
}

impl Traction {
    fn of(pair: &PairState, size: f64, is_area: bool) -> Traction {
        let (length, area) = if is_area { (None, Some(size)) } else { (Some(size), None) };
        Traction { id: pair.id.clone(), length, area, normal: pair.x_n / size, tangential: pair.x_t / size }
    }
}

impl Session {
    /// The tractions of each of these states, and their picture: maps of the faces, a chart of the pairs on edges.
    pub(super) fn tractions(&self, all: &[Labelled]) -> Result<(Vec<Tractions>, ZonePicture), CommandError> {
        let mut states = all.to_vec();
        let units = &self.now.scenario.units;
        let sizes = self.structure().map(tributary_lengths).unwrap_or_default();
        let mut maps = Vec::new();
        if let Some(structure) = self.structure() {
            for (label, pairs) in &mut states {
                let (found, rest) = tractions(structure, pairs, &sizes, units);
                maps.extend(labelled(found, label));
                *pairs = rest;
            }
        }
        let on_no_face: HashSet<String> =
            states.iter().flat_map(|(_, pairs)| pairs).map(|pair| pair.id.clone()).collect();
        let sized = |pairs: &[PairState]| -> Vec<(PairState, f64)> {
            pairs.iter().cloned().zip(&sizes).filter_map(|(pair, size)| Some((pair, (*size)?))).collect()
        };
        let (mut figures, mut lengths) = (Vec::new(), Vec::new());
        for ((at, pairs), (_, on_edges)) in all.iter().zip(&mut states) {
            let pairs = sized(pairs);
            let is_area = |pair: &PairState| !on_no_face.contains(&pair.id);
            let of = |(pair, size): &(PairState, f64)| Traction::of(pair, *size, is_area(pair));
            figures.push(Tractions { at: at.clone(), pairs: pairs.iter().map(of).collect() });
            (*on_edges, lengths) = pairs.into_iter().filter(|(pair, _)| !is_area(pair)).unzip();
        }
        if lengths.is_empty() && maps.is_empty() {
            return Err(CommandError::Refused(
                "plot: no pairs lie on an edge with two ends, so that no length belongs to them; `plot pressure` and `plot \
                 force` show the nodal forces"
                    .into(),
            ));
        }
        let chart = (!lengths.is_empty()).then(|| zone::traction(&borrowed(&states), &lengths, units));
        Ok((figures, ZonePicture { maps, chart }))
    }
}
