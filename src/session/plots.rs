//! `plot`: what is drawn of the state shown, and at which pivots.

use serde_json::{Value, json};

use crate::answer::diagram::Internal;
use crate::answer::record::{NodeDisplacement, PairState};
use crate::view::plot::diagram;
use crate::view::plot::zone::{self, Quantity};
use crate::view::plot::{structure, trace};
use crate::view::style::Style;

use super::command::Picture;
use super::{CommandError, Output, Session};

/// Lines of a plot if the user names none.
const HEIGHT: usize = 14;
/// Lines of the picture of a structure if the user names none.
const STRUCTURE_HEIGHT: usize = 20;

impl Session {
    /// `plot PICTURE [OF] [--at PIVOTS] [--width N] [--height N]`.
    pub(super) fn plot(
        &self,
        picture: Picture,
        at: &[String],
        width: Option<u16>,
        height: Option<u16>,
        of: &[String],
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let saved = io.style;
        if let Some(width) = width {
            io.style.width = usize::from(width);
        }
        let height = height.map(usize::from);
        let most = match picture {
            Picture::Moment | Picture::Shear | Picture::Axial => 1,
            Picture::Path => usize::MAX,
            _ => 0,
        };
        let bar = of.first().map(String::as_str);
        let result = if let Some(word) = of.get(most) {
            Err(CommandError::Refused(format!(
                "plot: `{word}` makes no sense here; a bar belongs to moment, shear and axial, pairs to path"
            )))
        } else {
            match picture {
                Picture::Slip => self.plot_zone(Quantity::Slip, at, height, io),
                Picture::Force => self.plot_zone(Quantity::Force, at, height, io),
                Picture::Gap => self.plot_zone(Quantity::Gap, at, height, io),
                Picture::Pressure => self.plot_zone(Quantity::Pressure, at, height, io),
                _ if !at.is_empty() => Err(CommandError::Refused(
                    "plot: `--at` belongs to slip, force, gap and pressure; use `step` for the others".into(),
                )),
                Picture::P => self.plot_p(height, io),
                Picture::Path => self.plot_path(of, height.unwrap_or(HEIGHT), io),
                Picture::Structure => self.plot_structure(height, io),
                Picture::Mode => self.plot_mode(height, io),
                Picture::Moment => self.plot_diagram(Internal::Moment, bar, height, io),
                Picture::Shear => self.plot_diagram(Internal::Shear, bar, height, io),
                Picture::Axial => self.plot_diagram(Internal::Axial, bar, height, io),
            }
        };
        io.style = saved;
        result
    }

    fn plot_zone(
        &self,
        quantity: Quantity,
        at: &[String],
        height: Option<usize>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let answer = self.need_answer()?;
        if answer.pairs.is_empty() {
            return Err(CommandError::Refused("nothing to plot: there are no contact pairs in this answer".into()));
        }
        let mut states: Vec<(String, Vec<PairState>)> = Vec::new();
        if at.is_empty() {
            let label = self.position.map_or(String::new(), crate::view::pivots::title);
            states.push((label, self.pairs()));
        } else {
            let last = answer.pivot_count.checked_sub(1);
            for word in at {
                states.push(self.pairs_named(word, last)?);
            }
        }
        let borrowed: Vec<(&str, &[PairState])> =
            states.iter().map(|(label, pairs)| (label.as_str(), pairs.as_slice())).collect();
        io.report(
            || states.iter().map(|(label, pairs)| json!({"at": label, "pairs": pairs})).collect(),
            |out, style| {
                zone::write(out, quantity, &borrowed, &self.now.scenario.units, height.unwrap_or(HEIGHT), style)
            },
        )?;
        Ok(())
    }

    /// The pairs at a pivot named `first`, `last` or by its number.
    fn pairs_named(&self, word: &str, last: Option<usize>) -> Result<(String, Vec<PairState>), CommandError> {
        let (Some(solved), Some(prepared), Some(last)) = (&self.solved, &self.now.prepared, last) else {
            return Err(CommandError::Refused(
                "plot: no pivots to choose with `--at`: the main system is the answer".into(),
            ));
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

    fn plot_p(&self, height: Option<usize>, io: &mut Output<'_>) -> Result<(), CommandError> {
        let answer = self.need_answer()?;
        if answer.pivots.is_empty() {
            return Err(CommandError::Refused("no pivots: the main system is the answer".into()));
        }
        io.report(
            || answer.pivots.iter().map(|pivot| json!([pivot.step, pivot.p])).collect(),
            |out, style| {
                trace::write(
                    out,
                    &answer.pivots,
                    self.position,
                    &self.now.scenario.units,
                    height.unwrap_or(HEIGHT),
                    style,
                )
            },
        )?;
        Ok(())
    }

    fn plot_structure(&self, height: Option<usize>, io: &mut Output<'_>) -> Result<(), CommandError> {
        self.need_answer()?;
        let structure = self.structure().ok_or_else(not_a_structure)?;
        let displacements = self.displacements();
        let pairs = self.pairs();
        let title = match self.position {
            Some(step) => format!("{} at {}", self.now.scenario.name, crate::view::pivots::title(step)),
            None => self.now.scenario.name.clone(),
        };
        let drawn = |out: &mut dyn std::io::Write, style: &Style| {
            structure::write(
                out,
                &structure::Picture {
                    title: &title,
                    structure,
                    displacements: displacements.as_deref(),
                    pairs: Some(&pairs),
                    magnification: structure::Magnification::Auto,
                    height: height.unwrap_or(STRUCTURE_HEIGHT),
                },
                style,
            )
        };
        io.report(|| json!({"displacements": displacements, "pairs": pairs}), drawn)?;
        Ok(())
    }

    /// The motion of the structure along the ray.
    fn plot_mode(&self, height: Option<usize>, io: &mut Output<'_>) -> Result<(), CommandError> {
        self.need_answer()?;
        let structure = self.structure().ok_or_else(not_a_structure)?;
        let mode = self
            .solved
            .as_ref()
            .and_then(|solved| solved.ray.as_ref())
            .and_then(|ray| ray.mode.as_ref())
            .ok_or_else(|| {
                CommandError::Refused("no mode to draw: the run did not end in a motion that costs no energy".into())
            })?;
        let displacements: Vec<NodeDisplacement> = structure
            .nodes
            .iter()
            .zip(&mode.displacements)
            .map(|(node, u)| NodeDisplacement { node: node.id.clone(), ux: u[0], uy: u[1], rz: u[2] })
            .collect();
        let title = format!("{}: collapse mode", self.now.scenario.name);
        let drawn = |out: &mut dyn std::io::Write, style: &Style| {
            structure::write(
                out,
                &structure::Picture {
                    title: &title,
                    structure,
                    displacements: Some(&displacements),
                    pairs: None,
                    magnification: structure::Magnification::Auto,
                    height: height.unwrap_or(STRUCTURE_HEIGHT),
                },
                style,
            )
        };
        io.report(|| json!({"displacements": displacements}), drawn)?;
        Ok(())
    }

    fn plot_diagram(
        &self,
        force: Internal,
        bar: Option<&str>,
        height: Option<usize>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let answer = self.need_answer()?;
        let structure = self.structure().ok_or_else(not_a_structure)?;
        let Some(members) = &answer.members else {
            return Err(CommandError::Refused("no member forces: there is no answer".into()));
        };
        let names = || structure.bars.iter().map(|bar| bar.id.as_str());
        let bars: Vec<&str> = match bar {
            Some(bar) if names().any(|name| name == bar) => vec![bar],
            Some(bar) => {
                return Err(CommandError::Refused(super::selection::no_such("bar", bar, names())));
            }
            None => names().collect(),
        };
        let Some(bar) = bars.first().copied() else {
            return Err(CommandError::Refused("the structure has no bars".into()));
        };
        if bars.len() > 1 {
            return Err(CommandError::Refused(format!("plot: of which bar? One of {}", bars.join(", "))));
        }
        io.report(
            || {
                let points = diagram::series(members, bar, force).map(|series| series.points);
                json!({"bar": bar, "points": points.map_or(Value::Null, |points| json!(points))})
            },
            |out, style| {
                let diagram = diagram::Drawing { members, bar, force, height: height.unwrap_or(HEIGHT) };
                diagram::write(out, &diagram, &self.now.scenario.units, style)
            },
        )?;
        Ok(())
    }
}

fn not_a_structure() -> CommandError {
    CommandError::Refused("the scenario is no structure: there is nothing to draw".into())
}
