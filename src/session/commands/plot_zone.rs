//! `plot slip`, `force`, `gap`, `pressure` and `traction`: what is drawn over the contact zone, and at which pivots.

use std::io::{self, Write};

use serde::Serialize;

use super::plots::{HEIGHT, STRUCTURE_HEIGHT};
use crate::answer::record::PairState;
use crate::session::{CommandError, Output, Session};
use crate::view::plot::chart::Chart;
use crate::view::plot::face_map::{self, FaceMap};
use crate::view::plot::zone::{self, Quantity};
use crate::view::style::Style;

/// Pairs, under the title of their state.
pub(super) type Labelled = (String, Vec<PairState>);

/// Maps of the faces, state by state, and a chart of the pairs that lie on none.
pub(super) struct ZonePicture {
    pub(super) maps: Vec<FaceMap>,
    pub(super) chart: Option<Chart>,
}

impl ZonePicture {
    fn write(&self, out: &mut dyn Write, height: Option<usize>, style: &Style) -> io::Result<()> {
        self.maps.iter().try_for_each(|map| map.write(out, height.unwrap_or(STRUCTURE_HEIGHT), style))?;
        let Some(chart) = &self.chart else { return Ok(()) };
        Chart { height: height.unwrap_or(HEIGHT), ..chart.clone() }.write(out, style)
    }
}

/// The pairs of a state.
#[derive(Serialize)]
struct AtPivot<'a> {
    at: &'a str,
    pairs: &'a [PairState],
}

impl Session {
    /// Draws a quantity of the pairs, `None`: their tractions.
    pub(super) fn plot_zone(
        &self,
        quantity: Option<Quantity>,
        at: &[String],
        height: Option<usize>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let states = self.zone_states(at)?;
        let Some(quantity) = quantity else {
            let (figures, picture) = self.tractions(&states)?;
            io.show(&figures, |out, style| picture.write(out, height, style))?;
            return Ok(());
        };
        let shown: Vec<AtPivot<'_>> = states.iter().map(|(at, pairs)| AtPivot { at, pairs }).collect();
        io.show(&shown, |out, style| self.zone_picture(quantity, &states).write(out, height, style))?;
        Ok(())
    }

    /// The picture of a quantity of the pairs.
    pub(super) fn zone_picture(&self, quantity: Quantity, states: &[Labelled]) -> ZonePicture {
        let units = &self.now.scenario.units;
        let (mut maps, mut rest) = (Vec::new(), Vec::new());
        match self.structure() {
            None => rest = states.to_vec(),
            Some(structure) => {
                for (label, pairs) in states {
                    let (found, others) = face_map::faces(structure, pairs, quantity, units);
                    maps.extend(labelled(found, label));
                    rest.extend(Some((label.clone(), others)).filter(|(_, others)| !others.is_empty()));
                }
            }
        }
        let chart = (!rest.is_empty()).then(|| zone::drawing(quantity, &borrowed(&rest), units));
        ZonePicture { maps, chart }
    }

    /// The pairs that a plot over the contact zone shows, each with its title: those shown, or those at some pivots.
    pub(in crate::session) fn zone_states(&self, at: &[String]) -> Result<Vec<(String, Vec<PairState>)>, CommandError> {
        let answer = self.need_quantities()?;
        if answer.pairs.is_empty() {
            return Err(CommandError::Refused("nothing to plot: there are no contact pairs in this answer".into()));
        }
        if at.is_empty() {
            return Ok(vec![(self.shown_place().unwrap_or_default(), self.quantity_pairs())]);
        }
        let answer = self.need_answer()?;
        let last = answer.pivot_count.checked_sub(1);
        at.iter().map(|word| self.pairs_named(word, last)).collect()
    }

    /// The pairs at a pivot named `first`, `last` or by its number.
    fn pairs_named(&self, word: &str, last: Option<usize>) -> Result<(String, Vec<PairState>), CommandError> {
        let (Some(solved), Some(prepared), Some(last)) = (&self.solved, &self.now.prepared, last) else {
            let why = self.need_answer()?.rules.why_no_pivots();
            return Err(CommandError::Refused(format!("plot: nothing to choose with `--at`: {why}")));
        };
        let step = match word {
            "first" => 0,
            "last" => last,
            _ => word.parse().ok().filter(|step| *step <= last).ok_or_else(|| {
                CommandError::Refused(format!("plot: no pivot `{word}`; expected first, last or 0 … {last}"))
            })?,
        };
        let pairs = if step == last {
            solved.answer.pairs.clone()
        } else {
            solved
                .pairs_at(prepared, step)
                .ok_or_else(|| CommandError::Refused(format!("plot: pivot {step} cannot be shown")))?
        };
        Ok((format!("pivot {step}"), pairs))
    }
}

/// Maps with the title of their state after their own.
pub(super) fn labelled<'a>(maps: Vec<FaceMap>, label: &'a str) -> impl Iterator<Item = FaceMap> + use<'a> {
    maps.into_iter().map(move |mut map| {
        if !label.is_empty() {
            map.title.push_str(&format!(" · {label}"));
        }
        map
    })
}

pub(super) fn borrowed(states: &[Labelled]) -> Vec<(&str, &[PairState])> {
    states.iter().map(|(label, pairs)| (label.as_str(), pairs.as_slice())).collect()
}
