//! `plot`: what is drawn of the state shown, and at which pivots.

use clap::{Args, ValueEnum};

use crate::answer::diagram::Internal;
use crate::answer::record::PivotRecord;
use crate::view::plot::trace;
use crate::view::plot::zone::Quantity;

use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};

/// Lines of a plot if the user names none.
pub(super) const HEIGHT: usize = 14;
/// Lines of the picture of a structure if the user names none.
pub(super) const STRUCTURE_HEIGHT: usize = 20;

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
    /// x_n and x_τ of edges per length, of faces per area
    Traction,
    /// p over the pivots
    P,
    /// The structure with the states of its pairs, and its deformed shape
    Structure,
    /// The collapse mode of a ray
    Mode,
    /// Bending moment along a bar, or along all bars where they lie; in space M_z
    Moment,
    /// Shear force likewise; in space V_y
    Shear,
    /// Normal force likewise
    Axial,
    /// Shear force V_z of bars in space
    #[value(name = "Vz")]
    ShearZ,
    /// Torque of bars in space
    #[value(name = "T")]
    Torsion,
    /// Bending moment M_y of bars in space
    #[value(name = "My")]
    MomentY,
    /// Slip or force over the load, friction or history that was followed last
    Path,
}

impl Picture {
    /// Whether it shows a force along bars.
    fn is_of_bars(self) -> bool {
        use Picture::{Axial, Moment, MomentY, Shear, ShearZ, Torsion};
        matches!(self, Moment | Shear | Axial | ShearZ | Torsion | MomentY)
    }
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
    /// Bar, for moment, shear, axial, Vz, T and My (all of them without one); quantity, pairs and `over CASE`, for path;
    /// `loads on|off` and `scale FACTOR|auto`, for structure and mode
    #[arg(value_name = "OF", allow_negative_numbers = true)]
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
        (None, [bars, ..]) if Picture::from_str(bars, false).is_ok_and(Picture::is_of_bars) => {
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
            _ if picture.is_of_bars() => 1,
            Picture::Path | Picture::Structure | Picture::Mode => usize::MAX,
            _ => 0,
        };
        let bar = of.first().map(String::as_str);
        let result = if let Some(word) = of.get(most) {
            Err(CommandError::Refused(format!(
                "plot: `{word}` makes no sense here; a bar belongs to moment, shear, axial, Vz, T and My, pairs to path, \
                 `loads` and `scale` to structure and mode"
            )))
        } else {
            match picture {
                Picture::Slip => self.plot_zone(Some(Quantity::Slip), at, height, io),
                Picture::Force => self.plot_zone(Some(Quantity::Force), at, height, io),
                Picture::Gap => self.plot_zone(Some(Quantity::Gap), at, height, io),
                Picture::Pressure => self.plot_zone(Some(Quantity::Pressure), at, height, io),
                Picture::Traction => self.plot_zone(None, at, height, io),
                _ if !at.is_empty() => Err(CommandError::Refused(
                    "plot: `--at` belongs to slip, force, gap, pressure and traction; use `step` for the others".into(),
                )),
                Picture::P => self.plot_p(height, io),
                Picture::Path => self.plot_path(of, height.unwrap_or(HEIGHT), io),
                Picture::Structure => self.shape().and_then(|shape| self.plot_shape(&shape, of, true, height, io)),
                Picture::Mode => self.mode_shape().and_then(|shape| self.plot_shape(&shape, of, false, height, io)),
                Picture::Moment => self.plot_diagram(Internal::Moment, bar, height, io),
                Picture::Shear => self.plot_diagram(Internal::Shear, bar, height, io),
                Picture::Axial => self.plot_diagram(Internal::Axial, bar, height, io),
                Picture::ShearZ => self.plot_diagram(Internal::ShearZ, bar, height, io),
                Picture::Torsion => self.plot_diagram(Internal::Torsion, bar, height, io),
                Picture::MomentY => self.plot_diagram(Internal::MomentY, bar, height, io),
            }
        };
        io.style = saved;
        result
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
        let answer = self.need_answer()?;
        if answer.pivots.is_empty() {
            return Err(CommandError::Refused(answer.rules.why_no_pivots()));
        }
        Ok(&answer.pivots)
    }
}
