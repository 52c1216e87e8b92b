//! `plot structure`, `plot mode` and the internal forces of bars: what is drawn of a structure.

use std::path::Path;

use serde::Serialize;

use super::plots::{HEIGHT, STRUCTURE_HEIGHT};
use crate::answer::diagram::Internal;
use crate::answer::record::{MemberForces, NodeDisplacement, PairState};
use crate::model::structure::Structure;
use crate::model::words::no_such;
use crate::session::{CommandError, Output, Session};
use crate::view::plot::scene::{self, Magnification};
use crate::view::plot::{diagram, structure};
use crate::view::projection::Viewpoint;
use crate::view::status::weight;

/// What the user asks of the picture of a structure.
#[derive(Default)]
struct Look {
    loads: Option<bool>,
    scale: Magnification,
}

impl Look {
    /// `loads on|off` and `scale FACTOR|auto`, in any order.
    fn read(words: &[String]) -> Result<Look, CommandError> {
        let mut look = Look::default();
        let mut words = words.iter().map(String::as_str);
        while let Some(word) = words.next() {
            match (word, words.next()) {
                ("loads", Some("on")) => look.loads = Some(true),
                ("loads", Some("off")) => look.loads = Some(false),
                ("scale", Some("auto")) => look.scale = Magnification::Auto,
                ("scale", Some(factor)) => {
                    let factor = factor.parse().ok().filter(|factor: &f64| factor.is_finite() && *factor >= 0.0);
                    look.scale = Magnification::Factor(factor.ok_or_else(|| {
                        CommandError::Refused("plot: `scale` takes a number from 0 on, or `auto`".to_owned())
                    })?);
                }
                ("loads", _) => return Err(CommandError::Refused("plot: `loads` takes on or off".to_owned())),
                ("scale", None) => {
                    return Err(CommandError::Refused("plot: `scale` takes a number from 0 on, or `auto`".to_owned()));
                }
                _ => {
                    return Err(CommandError::Refused(format!(
                        "plot: `{word}` makes no sense here: expected `loads on`, `loads off`, `scale FACTOR` or `scale auto`"
                    )));
                }
            }
        }
        Ok(look)
    }
}

/// An internal force along a bar: distances from its start and values.
#[derive(Serialize)]
struct Curve<'a> {
    bar: &'a str,
    points: Option<Vec<(f64, f64)>>,
}

impl<'a> Curve<'a> {
    fn of(members: &[MemberForces], bar: &'a str, force: Internal) -> Self {
        Curve { bar, points: diagram::series(members, bar, force).map(|series| series.points) }
    }
}

/// A structure with what is shown on it.
#[derive(Serialize)]
pub(in crate::session) struct Shape<'a> {
    #[serde(skip)]
    pub(in crate::session) title: String,
    #[serde(skip)]
    pub(in crate::session) structure: &'a Structure,
    pub(in crate::session) displacements: Option<Vec<NodeDisplacement>>,
    /// Of the load cases; none of a motion.
    #[serde(skip)]
    pub(in crate::session) factors: &'a [f64],
    /// From where it is seen, in space.
    #[serde(skip)]
    pub(in crate::session) viewpoint: Viewpoint,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::session) pairs: Option<Vec<PairState>>,
}

impl Shape<'_> {
    /// Its picture, `height` rows high.
    pub(in crate::session) fn picture(&self, height: usize) -> scene::Picture<'_> {
        scene::Picture {
            title: &self.title,
            structure: self.structure,
            displacements: self.displacements.as_deref(),
            factors: self.factors,
            pairs: self.pairs.as_deref(),
            magnification: Magnification::Auto,
            viewpoint: self.viewpoint,
            height,
        }
    }
}

impl Session {
    /// `plot structure` or `plot mode`: the words `of` say how, and `loads` whether loads are drawn where they do not.
    pub(super) fn plot_shape(
        &self,
        shown: &Shape<'_>,
        of: &[String],
        loads: bool,
        height: Option<usize>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let look = Look::read(of)?;
        let loads = look.loads.unwrap_or(loads).then_some((self.quantity_factors(), &self.now.scenario.units));
        io.show(shown, |out, style| {
            let picture = shown.picture(height.unwrap_or(STRUCTURE_HEIGHT));
            structure::write(out, &scene::Picture { magnification: look.scale, ..picture }, loads, style)
        })?;
        Ok(())
    }

    /// The name of the scenario without folders, for titles.
    pub(in crate::session) fn short_name(&self) -> &str {
        let name = self.now.scenario.name.as_str();
        Path::new(name).file_name().and_then(|name| name.to_str()).unwrap_or(name)
    }

    /// The structure as it is shown.
    pub(in crate::session) fn shape(&self) -> Result<Shape<'_>, CommandError> {
        self.need_quantities()?;
        let title = match self.shown_place() {
            Some(place) => format!("{} · {place}", self.short_name()),
            None => self.short_name().to_owned(),
        };
        Ok(Shape {
            title,
            structure: self.structure().ok_or_else(not_a_structure)?,
            displacements: self.quantity_displacements(),
            factors: self.quantity_factors(),
            viewpoint: self.viewpoint,
            pairs: Some(self.quantity_pairs()),
        })
    }

    /// Where the state shown stands, if it is not the answer itself.
    pub(super) fn shown_place(&self) -> Option<String> {
        if let Some(place) = self.history_place() {
            return Some(place);
        }
        let answer = self.answer()?;
        match self.position {
            Some(step) => Some(crate::view::pivots::title(step)),
            None => answer
                .ray
                .as_ref()
                .map(|ray| format!("no answer, p = {}", weight(ray.p, answer, &self.now.scenario.units))),
        }
    }

    /// The motion along the ray.
    pub(in crate::session) fn mode_shape(&self) -> Result<Shape<'_>, CommandError> {
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
        let displacements = NodeDisplacement::of_nodes(structure, &mode.displacements);
        let title = format!("{}: collapse mode", self.short_name());
        let viewpoint = self.viewpoint;
        Ok(Shape { title, structure, displacements: Some(displacements), factors: &[], viewpoint, pairs: None })
    }

    /// What the picture of a force shows here, the forces of the bars, and the bars that are meant: the one named, or all.
    pub(in crate::session) fn bars(
        &self,
        force: Internal,
        bar: Option<&str>,
    ) -> Result<(Internal, &[MemberForces], Vec<&str>), CommandError> {
        let answer = self.need_quantities()?;
        let structure = self.structure().ok_or_else(not_a_structure)?;
        let force = force.drawn_in(structure.dimension);
        if !force.is_of(structure.dimension) {
            return Err(CommandError::Refused(format!(
                "{} is a force of bars in space; those of bars in the plane are axial, shear and moment",
                force.symbol()
            )));
        }
        let Some(members) = &answer.members else {
            return Err(CommandError::Refused("no member forces: there is no answer".into()));
        };
        let names = || structure.bars.iter().map(|bar| bar.id.as_str());
        match bar {
            Some(bar) => match names().find(|name| *name == bar) {
                Some(name) => Ok((force, members, vec![name])),
                None => Err(CommandError::Refused(no_such("bar", bar, names()))),
            },
            None if structure.bars.is_empty() => Err(CommandError::Refused("the structure has no bars".into())),
            None => Ok((force, members, names().collect())),
        }
    }

    pub(super) fn plot_diagram(
        &self,
        force: Internal,
        bar: Option<&str>,
        height: Option<usize>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let (force, members, bars) = self.bars(force, bar)?;
        let &[bar] = &bars[..] else {
            let shown = Shape { displacements: None, factors: &[], ..self.shape()? };
            let curves: Vec<Curve<'_>> = bars.iter().map(|bar| Curve::of(members, bar, force)).collect();
            io.show(&curves, |out, style| {
                let picture = shown.picture(height.unwrap_or(STRUCTURE_HEIGHT));
                structure::write_with_diagrams(out, &picture, (members, force), &self.now.scenario.units, style)
            })?;
            return Ok(());
        };
        io.show(&Curve::of(members, bar, force), |out, style| {
            let diagram = diagram::Drawing { members, bar, force, height: height.unwrap_or(HEIGHT) };
            diagram::write(out, &diagram, &self.now.scenario.units, style)
        })?;
        Ok(())
    }
}

fn not_a_structure() -> CommandError {
    CommandError::Refused("the scenario has no structure: there is nothing to draw".into())
}
