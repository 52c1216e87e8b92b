//! `plot traction`: what the pairs of an edge or of a face carry, per length or area of it.

use std::collections::HashSet;

use serde::Serialize;

use super::plots::{HEIGHT, STRUCTURE_HEIGHT, borrowed};
use crate::answer::record::PairState;
use crate::model::structure::Dimension;
use crate::model::tributary::tributary_lengths;
use crate::session::{CommandError, Output, Session};
use crate::view::plot::chart::Chart;
use crate::view::plot::face_map::{FaceMap, tractions};
use crate::view::plot::zone;

/// Maps of the faces; states of the pairs that lie on edges, each with its title, and the length of edge of each of those
/// pairs.
pub(super) struct OnEdges {
    figures: Vec<Tractions>,
    pub(super) maps: Vec<FaceMap>,
    pub(super) states: Vec<(String, Vec<PairState>)>,
    pub(super) lengths: Vec<f64>,
}

/// Forces per length of edge, or per area of face.
#[derive(Serialize)]
struct Tractions {
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
    /// `plot traction`.
    pub(super) fn plot_traction(
        &self,
        at: &[String],
        height: Option<usize>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let OnEdges { figures, maps, states, lengths } = self.traction_states(at)?;
        io.show(&figures, |out, style| {
            maps.iter().try_for_each(|map| map.write(out, height.unwrap_or(STRUCTURE_HEIGHT), style))?;
            if lengths.is_empty() {
                return Ok(());
            }
            let chart = zone::traction(&borrowed(&states), &lengths, &self.now.scenario.units);
            Chart { height: height.unwrap_or(HEIGHT), ..chart }.write(out, style)
        })?;
        Ok(())
    }

    /// The pairs on edges, as [`Session::zone_states`], and the length of edge of each of them.
    pub(super) fn traction_states(&self, at: &[String]) -> Result<OnEdges, CommandError> {
        let all = self.zone_states(at)?;
        let mut states = all.clone();
        let sizes = self.structure().map(tributary_lengths).unwrap_or_default();
        let mut maps = Vec::new();
        if let Some(structure) = self.structure().filter(|structure| structure.dimension == Dimension::Space) {
            for (label, pairs) in &mut states {
                let (mut found, rest) = tractions(structure, pairs, &sizes, &self.now.scenario.units);
                for map in found.iter_mut().filter(|_| !label.is_empty()) {
                    map.title.push_str(&format!(" · {label}"));
                }
                maps.extend(found);
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
        Ok(OnEdges { figures, maps, states, lengths })
    }
}
