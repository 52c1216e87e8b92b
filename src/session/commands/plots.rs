//! `plot`: what is drawn of the state shown, and at which pivots.

use std::path::Path;

use clap::{Args, ValueEnum};
use serde::Serialize;

use crate::answer::diagram::Internal;
use crate::answer::record::{MemberForces, NodeDisplacement, PairState, PivotRecord};
use crate::model::structure::{Dimension, Structure};
use crate::model::words::no_such;
use crate::view::plot::chart::Chart;
use crate::view::plot::diagram;
use crate::view::plot::face_map::{self, FaceMap};
use crate::view::plot::scene::{self, Magnification};
use crate::view::plot::zone::{self, Quantity};
use crate::view::plot::{structure, trace};
use crate::view::projection::Viewpoint;
use crate::view::status::weight;

use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};

/// Lines of a plot if the user names none.
pub(super) const HEIGHT: usize = 14;
/// Lines of the picture of a structure if the user names none.
const STRUCTURE_HEIGHT: usize = 20;

/// What `plot` draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Picture {
    /// Slip z_τ along the contact zone
    Slip,
    /// Friction force x_τ within its bound ±(f x_n + c)
    Force,
    /// Distance open z_n
    Gap,
    /// Compressive force x_n
    Pressure,
    /// x_n and x_τ of edges per length
    Traction,
    /// p over the pivots
    P,
    /// The structure with the states of its pairs, and its deformed shape
    Structure,
    /// The collapse mode of a ray
    Mode,
    /// Bending moment along a bar, or along all bars where they lie
    Moment,
    /// Shear force likewise
    Shear,
    /// Normal force likewise
    Axial,
    /// Slip or force over the load, friction or history that was followed last
    Path,
}

/// Draw a picture of the present state, or of the last path
///
/// `plot path [slip|force|gap|pressure] [PAIRS]`, or `plot path QUANTITY`, draws what the last `trace` or `stages`
/// followed. A history is drawn over the load that goes to and fro most, or with `over CASE` at the end over another one.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  plot slip\n  plot force\n  plot structure\n  trace F2; plot path force c6 c5\n  \
                        stages; plot path slip c6 over pull")]
pub struct Plot {
    /// What to draw
    #[arg(value_name = "PICTURE")]
    picture: Picture,
    /// Pivots to draw on one axis: numbers, `first`, `last`, separated by commas
    #[arg(long, value_name = "PIVOTS", value_delimiter = ',')]
    at: Vec<String>,
    /// Columns of the picture
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(20..=1000))]
    width: Option<u16>,
    /// Lines of the picture
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(5..=500))]
    height: Option<u16>,
    /// Bar, for moment, shear and axial (all of them without one); quantity, pairs and `over CASE`, for path;
    /// `loads on|off` and `scale FACTOR|auto`, for structure and mode
    #[arg(value_name = "OF")]
    of: Vec<String>,
}

pub const PLOT: Command = Command { complete: words, ..Command::of::<Plot>("plot") };

impl Action for Plot {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.plot(self.picture, &self.at, self.width, self.height, &self.of, io)?;
        Ok(Next::Continue)
    }

    fn needs_pivots(&self) -> bool {
        matches!(self.picture, Picture::P | Picture::Path | Picture::Mode) || !self.at.is_empty()
    }
}

/// Pivots for `--at`; a bar, or what of a path.
fn words(asked: &Asked<'_>) -> Vec<Candidate> {
    match (asked.option, asked.given) {
        (Some("at"), _) => Candidate::plain(["first", "last", "first,last"]),
        (None, [path, of @ ..]) if path == "path" => of_path(asked, of),
        (None, [bars, ..]) if ["moment", "shear", "axial"].contains(&bars.as_str()) => {
            Candidate::plain(&asked.names.bars)
        }
        (None, [shape, .., last]) if ["structure", "mode"].contains(&shape.as_str()) && last == "loads" => {
            Candidate::plain(["on", "off"])
        }
        (None, [shape, .., last]) if ["structure", "mode"].contains(&shape.as_str()) && last == "scale" => {
            Candidate::plain(["auto"])
        }
        (None, [shape, ..]) if ["structure", "mode"].contains(&shape.as_str()) => Candidate::plain(["loads", "scale"]),
        _ => Vec::new(),
    }
}

/// What may follow `plot path` and the words after it.
pub(in crate::session) fn of_path(asked: &Asked<'_>, given: &[String]) -> Vec<Candidate> {
    if given.last().is_some_and(|word| word == "over") {
        return asked.cases();
    }
    let words = ["slip", "force", "gap", "pressure", "over"];
    Candidate::plain(asked.names.pairs.iter().map(String::as_str).chain(words))
}

impl Session {
    /// `plot PICTURE [OF] [--at PIVOTS] [--width N] [--height N]`.
    pub(in crate::session) fn plot(
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
            Picture::Path | Picture::Structure | Picture::Mode => usize::MAX,
            _ => 0,
        };
        let bar = of.first().map(String::as_str);
        let result = if let Some(word) = of.get(most) {
            Err(CommandError::Refused(format!(
                "plot: `{word}` makes no sense here; a bar belongs to moment, shear and axial, pairs to path, `loads` and `scale` \
                 to structure and mode"
            )))
        } else {
            match picture {
                Picture::Slip => self.plot_zone(Quantity::Slip, at, height, io),
                Picture::Force => self.plot_zone(Quantity::Force, at, height, io),
                Picture::Gap => self.plot_zone(Quantity::Gap, at, height, io),
                Picture::Pressure => self.plot_zone(Quantity::Pressure, at, height, io),
                Picture::Traction => self.plot_traction(at, height, io),
                _ if !at.is_empty() => Err(CommandError::Refused(
                    "plot: `--at` belongs to slip, force, gap, pressure and traction; use `step` for the others".into(),
                )),
                Picture::P => self.plot_p(height, io),
                Picture::Path => self.plot_path(of, height.unwrap_or(HEIGHT), io),
                Picture::Structure => self.plot_structure(of, height, io),
                Picture::Mode => self.plot_mode(of, height, io),
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
        let states = self.zone_states(at)?;
        let shown: Vec<AtPivot<'_>> = states.iter().map(|(at, pairs)| AtPivot { at, pairs }).collect();
        io.show(&shown, |out, style| {
            let (maps, states) = self.faces(quantity, &states);
            for map in &maps {
                map.write(out, height.unwrap_or(STRUCTURE_HEIGHT), style)?;
            }
            if !states.is_empty() {
                let chart = zone::drawing(quantity, &borrowed(&states), &self.now.scenario.units);
                Chart { height: height.unwrap_or(HEIGHT), ..chart }.write(out, style)?;
            }
            Ok(())
        })?;
        Ok(())
    }

    /// The maps of faces, state by state, and the states of the pairs that lie on none.
    pub(in crate::session) fn faces(
        &self,
        quantity: Quantity,
        states: &[(String, Vec<PairState>)],
    ) -> (Vec<FaceMap>, Vec<(String, Vec<PairState>)>) {
        let Some(structure) = self.structure().filter(|structure| structure.dimension == Dimension::Space) else {
            return (Vec::new(), states.to_vec());
        };
        let (mut maps, mut rest) = (Vec::new(), Vec::new());
        for (label, pairs) in states {
            let (mut found, others) = face_map::faces(structure, pairs, quantity, &self.now.scenario.units);
            for map in found.iter_mut().filter(|_| !label.is_empty()) {
                map.title.push_str(&format!(" · {label}"));
            }
            maps.extend(found);
            rest.extend(Some((label.clone(), others)).filter(|(_, others)| !others.is_empty()));
        }
        (maps, rest)
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
        let pivots = self.some_pivots()?;
        let points: Vec<(usize, f64)> = pivots.iter().map(|pivot| (pivot.step, pivot.p)).collect();
        io.show(&points, |out, style| {
            let units = &self.now.scenario.units;
            trace::write(out, pivots, self.position, units, height.unwrap_or(HEIGHT), style)
        })?;
        Ok(())
    }

    pub(in crate::session) fn some_pivots(&self) -> Result<&[PivotRecord], CommandError> {
        let pivots = &self.need_answer()?.pivots;
        if pivots.is_empty() {
            return Err(CommandError::Refused("no pivots: the main system is the answer".into()));
        }
        Ok(pivots)
    }

    fn plot_structure(&self, of: &[String], height: Option<usize>, io: &mut Output<'_>) -> Result<(), CommandError> {
        let look = Look::read(of)?;
        let shown = self.shape()?;
        let loads = look.loads.unwrap_or(true).then_some((&self.now.values, &self.now.scenario.units));
        io.show(&shown, |out, style| {
            let picture = shown.picture(height.unwrap_or(STRUCTURE_HEIGHT));
            structure::write(out, &scene::Picture { magnification: look.scale, ..picture }, loads, style)
        })?;
        Ok(())
    }

    /// The motion of the structure along the ray.
    fn plot_mode(&self, of: &[String], height: Option<usize>, io: &mut Output<'_>) -> Result<(), CommandError> {
        let look = Look::read(of)?;
        let shown = self.mode_shape()?;
        let loads = look.loads.unwrap_or(false).then_some((&self.now.values, &self.now.scenario.units));
        io.show(&shown, |out, style| {
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
    fn shown_place(&self) -> Option<String> {
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
        let displacements = structure
            .nodes
            .iter()
            .zip(&mode.displacements)
            .map(|(node, u)| NodeDisplacement::of(structure.dimension, &node.id, *u))
            .collect();
        let title = format!("{}: collapse mode", self.short_name());
        let viewpoint = self.viewpoint;
        Ok(Shape { title, structure, displacements: Some(displacements), factors: &[], viewpoint, pairs: None })
    }

    /// The forces of the bars and the bars that are meant: the one named, or all.
    pub(in crate::session) fn bars(&self, bar: Option<&str>) -> Result<(&[MemberForces], Vec<&str>), CommandError> {
        let answer = self.need_quantities()?;
        let structure = self.structure().ok_or_else(not_a_structure)?;
        let Some(members) = &answer.members else {
            return Err(CommandError::Refused("no member forces: there is no answer".into()));
        };
        let names = || structure.bars.iter().map(|bar| bar.id.as_str());
        match bar {
            Some(bar) => match names().find(|name| *name == bar) {
                Some(name) => Ok((members, vec![name])),
                None => Err(CommandError::Refused(no_such("bar", bar, names()))),
            },
            None if structure.bars.is_empty() => Err(CommandError::Refused("the structure has no bars".into())),
            None => Ok((members, names().collect())),
        }
    }

    fn plot_diagram(
        &self,
        force: Internal,
        bar: Option<&str>,
        height: Option<usize>,
        io: &mut Output<'_>,
    ) -> Result<(), CommandError> {
        let (members, bars) = self.bars(bar)?;
        let &[bar] = &bars[..] else {
            let structure = self.structure().ok_or_else(not_a_structure)?;
            let title = self.shape()?.title;
            let shown = Shape {
                title,
                structure,
                displacements: None,
                factors: &[],
                viewpoint: self.viewpoint,
                pairs: Some(self.quantity_pairs()),
            };
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

/// The pairs at a pivot.
#[derive(Serialize)]
struct AtPivot<'a> {
    at: &'a str,
    pairs: &'a [PairState],
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
    /// Its picture, so many rows high.
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

pub(super) fn borrowed(states: &[(String, Vec<PairState>)]) -> Vec<(&str, &[PairState])> {
    states.iter().map(|(label, pairs)| (label.as_str(), pairs.as_slice())).collect()
}

fn not_a_structure() -> CommandError {
    CommandError::Refused("the scenario is no structure: there is nothing to draw".into())
}
