//! `plot traction`: what the pairs of an edge carry, per length of it.

use serde::Serialize;

use super::plots::{HEIGHT, borrowed};
use crate::answer::record::PairState;
use crate::model::tributary::tributary_lengths;
use crate::session::{CommandError, Output, Session};
use crate::view::plot::chart::Chart;
use crate::view::plot::zone;

/// States of the pairs that lie on edges, each with its title, and the length of edge of each of those pairs.
pub(super) struct OnEdges {
    pub(super) states: Vec<(String, Vec<PairState>)>,
    pub(super) lengths: Vec<f64>,
}

/// Forces per length of edge.
#[derive(Serialize)]
struct Tractions<'a> {
    at: &'a str,
    pairs: Vec<Traction<'a>>,
}

#[derive(Serialize)]
struct Traction<'a> {
    id: &'a str,
    length: f64,
    normal: f64,
    tangential: f64,
}

impl<'a> Tractions<'a> {
    fn of(at: &'a str, pairs: &'a [PairState], lengths: &[f64]) -> Tractions<'a> {
        let of = |(pair, &length): (&'a PairState, &f64)| {
            let (normal, tangential) = (pair.x_n / length, pair.x_t / length);
            Traction { id: &pair.id, length, normal, tangential }
        };
        Tractions { at, pairs: pairs.iter().zip(lengths).map(of).collect() }
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
        let OnEdges { states, lengths } = self.traction_states(at)?;
        let shown: Vec<Tractions<'_>> = states.iter().map(|(at, pairs)| Tractions::of(at, pairs, &lengths)).collect();
        io.show(&shown, |out, style| {
            let chart = zone::traction(&borrowed(&states), &lengths, &self.now.scenario.units);
            Chart { height: height.unwrap_or(HEIGHT), ..chart }.write(out, style)
        })?;
        Ok(())
    }

    /// The pairs on edges, as [`Session::zone_states`], and the length of edge of each of them.
    pub(super) fn traction_states(&self, at: &[String]) -> Result<OnEdges, CommandError> {
        let mut states = self.zone_states(at)?;
        let lengths = self.structure().map(tributary_lengths).unwrap_or_default();
        for (_, pairs) in &mut states {
            let kept = std::mem::take(pairs).into_iter().zip(&lengths).filter(|(_, length)| length.is_some());
            *pairs = kept.map(|(pair, _)| pair).collect();
        }
        let lengths: Vec<f64> = lengths.into_iter().flatten().collect();
        if lengths.is_empty() {
            return Err(CommandError::Refused(
                "plot: no pairs lie on an edge with two ends, so that no length belongs to them; `plot pressure` and `plot \
                 force` show the nodal forces"
                    .into(),
            ));
        }
        Ok(OnEdges { states, lengths })
    }
}
