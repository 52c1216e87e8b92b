//! `plot traction`: what the pairs of an edge or of a face carry, per length or area of it.

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
    pub(super) maps: Vec<FaceMap>,
    pub(super) states: Vec<(String, Vec<PairState>)>,
    pub(super) lengths: Vec<f64>,
}

/// Forces per length of edge, or per area of face.
#[derive(Serialize)]
struct Tractions<'a> {
    at: &'a str,
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
        let OnEdges { maps, states, lengths } = self.traction_states(at)?;
        let all = self.zone_states(at)?;
        let sizes = self.structure().map(tributary_lengths).unwrap_or_default();
        let on_edges = |id: &str| states.iter().flat_map(|(_, pairs)| pairs).any(|pair| pair.id == id);
        let traction =
            |(pair, size): (&PairState, &Option<f64>)| Some(Traction::of(pair, (*size)?, !on_edges(&pair.id)));
        let shown: Vec<Tractions<'_>> = all
            .iter()
            .map(|(at, pairs)| Tractions { at, pairs: pairs.iter().zip(&sizes).filter_map(traction).collect() })
            .collect();
        io.show(&shown, |out, style| {
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
        let mut states = self.zone_states(at)?;
        let mut lengths = self.structure().map(tributary_lengths).unwrap_or_default();
        let mut maps = Vec::new();
        let in_space = self.structure().filter(|structure| structure.dimension == Dimension::Space);
        if let Some(structure) = in_space {
            let ids: Vec<String> = structure.pairs.iter().map(|pair| pair.id.clone()).collect();
            for (label, pairs) in &mut states {
                let (mut found, rest) = tractions(structure, pairs, &lengths, &self.now.scenario.units);
                for map in found.iter_mut().filter(|_| !label.is_empty()) {
                    map.title.push_str(&format!(" · {label}"));
                }
                maps.extend(found);
                *pairs = rest;
            }
            let left: Vec<&str> = states.iter().flat_map(|(_, pairs)| pairs).map(|pair| pair.id.as_str()).collect();
            lengths = ids.iter().zip(lengths).filter(|(id, _)| left.contains(&id.as_str())).map(|(_, at)| at).collect();
        }
        for (_, pairs) in &mut states {
            let kept = std::mem::take(pairs).into_iter().zip(&lengths).filter(|(_, length)| length.is_some());
            *pairs = kept.map(|(pair, _)| pair).collect();
        }
        let lengths: Vec<f64> = lengths.into_iter().flatten().collect();
        if lengths.is_empty() && maps.is_empty() {
            return Err(CommandError::Refused(
                "plot: no pairs lie on an edge with two ends, so that no length belongs to them; `plot pressure` and `plot \
                 force` show the nodal forces"
                    .into(),
            ));
        }
        Ok(OnEdges { maps, states, lengths })
    }
}
