//! `view`: from where a structure in space is seen in pictures.

use clap::Args;
use serde::Serialize;

use crate::model::structure::Dimension;
use crate::view::projection::Viewpoint;

use crate::session::language::candidates::Candidate;
use crate::session::language::command::{Action, Command};
use crate::session::{CommandError, Next, Output, Session};

/// Choose from where a structure in space is seen in pictures, or say it
///
/// ISO is isometric with z upwards; XY looks down along z, XZ along y, YZ along x from its far end. Two numbers are the
/// azimuth of the viewer, in degrees from x towards y, and the elevation above the plane of x and y.
#[derive(Debug, Args)]
#[command(
    override_usage = "view [ISO|XY|XZ|YZ | AZIMUTH ELEVATION]",
    after_help = "Example:\n  view XZ; plot structure\n  view -30 20\n  view"
)]
pub struct View {
    /// ISO, XY, XZ or YZ; or azimuth and elevation in degrees
    #[arg(value_name = "VIEW", num_args = 0..=2, allow_negative_numbers = true)]
    from: Vec<String>,
}

pub const VIEW: Command = Command {
    in_0_1: false,
    complete: |asked| if asked.given.is_empty() { Candidate::plain(NAMES) } else { Vec::new() },
    ..Command::of::<View>("view")
};

const NAMES: [&str; 4] = ["ISO", "XY", "XZ", "YZ"];

/// The view, for JSON.
#[derive(Serialize)]
struct Shown {
    view: String,
    azimuth: f64,
    elevation: f64,
}

impl Action for View {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        let structure = session.structure();
        if structure.is_none_or(|structure| structure.dimension == Dimension::Plane) {
            let what = if structure.is_some() { "this structure lies in the plane" } else { "there is no structure" };
            return Err(CommandError::Refused(format!("view: {what}; views belong to structures in space")));
        }
        if !self.from.is_empty() {
            session.viewpoint = read(&self.from)?;
        }
        let viewpoint = session.viewpoint;
        let [azimuth, elevation] = viewpoint.angles();
        io.show(&Shown { view: viewpoint.words(), azimuth, elevation }, |out, style| {
            writeln!(out, "{}", style.text(&format!("view {}", viewpoint.words())))
        })?;
        Ok(Next::Continue)
    }
}

/// A name, or two angles.
fn read(words: &[String]) -> Result<Viewpoint, CommandError> {
    let expected = "expected ISO, XY, XZ, YZ, or azimuth and elevation in degrees (elevation from -90 to 90)";
    let refused = || CommandError::Refused(format!("view: `{}` is not a view; {expected}", words.join(" ")));
    match words {
        [name] => Viewpoint::named(name).ok_or_else(refused),
        [azimuth, elevation] => {
            let angle = |word: &String| word.parse::<f64>().ok();
            let angles = angle(azimuth).zip(angle(elevation));
            angles.and_then(|(azimuth, elevation)| Viewpoint::new(azimuth, elevation)).ok_or_else(refused)
        }
        _ => Err(refused()),
    }
}

impl Session {
    /// From where structures in space are seen.
    pub fn viewpoint(&self) -> Viewpoint {
        self.viewpoint
    }
}
