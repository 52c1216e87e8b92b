//! `map`: the plane of two parameters cut into its regions of equal working scheme.

use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use serde_json::{Value as Json, json};

use crate::model::parameter::ParameterValues;
use crate::model::quantity::Quantity;
use crate::model::scenario::Scenario;
use crate::path::envelope::Axis;
use crate::path::map::{self, map};
use crate::path::route::Known;
use crate::session::error::refused;
use crate::session::language::candidates::{Asked, Candidate};
use crate::session::language::command::{Action, Command};
use crate::session::language::tokens;
use crate::session::{CommandError, Next, Output, Session, worker};
use crate::view;

/// How long a stopped map is waited for: a line and the drawing.
const PATIENCE: Duration = Duration::from_secs(5);

/// Cut the plane of two parameters into its regions of equal working scheme
///
/// `map P [A..B] Q [C..D] [of QUANTITY]`: parameters or load cases, horizontal and vertical; the ranges are those of
/// the sliders where they are left out. One of the two is followed on its path, exact in the plane, while the other
/// stands still; where the order of the schemes changes is found to the last digits. Each region gets its area, and at
/// a place inside its states, or the collapse with its motion and what is proved of it, and the quantity. In small
/// problems other answers are looked for there; their regions are hatched. Ctrl-C draws what is known by then. `export
/// map FILE.svg|.json` writes the last map; in the full screen a cursor in it shows the answer at any place.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  map f 0..1 F2 0..400\n  map f 0..1 F2 0..400 of z_t c6")]
pub struct Map {
    /// The two parameters or load cases with their ranges, `of` and a quantity
    #[arg(value_name = "MAPPED", required = true, trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<String>,
}

pub const MAP: Command = Command { in_0_1: false, complete: candidates, ..Command::of::<Map>("map") };

impl Action for Map {
    fn run(&self, session: &mut Session, _: &str, io: &mut Output<'_>) -> Result<Next, CommandError> {
        session.draw_map(&self.words, io)?;
        Ok(Next::Continue)
    }

    fn is_of_own_factors(&self, _: &Session) -> bool {
        true
    }
}

/// Two parameters or load cases with their ranges; after `of` a quantity.
fn candidates(asked: &Asked<'_>) -> Vec<Candidate> {
    if let Some(at) = tokens::place_of(asked.given, "of") {
        return asked.quantities(&asked.given[at + 1..]);
    }
    let mut all = asked.varied();
    if !asked.given.is_empty() {
        all.extend(Candidate::plain(["of"]));
    }
    all
}

/// The last map that was drawn, and of what.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The map.
    pub map: map::Map,
    /// What was read at the marked places.
    pub quantity: Option<Quantity>,
    /// The values under which it was drawn.
    values: ParameterValues,
}

impl Drawn {
    /// Units of the axes and of the quantity.
    pub fn labels<'a>(&self, scenario: &'a Scenario) -> view::map::Labels<'a> {
        let unit = |axis: &Axis| scenario.unit_of(&axis.name);
        let quantity = self.quantity.as_ref().map(|quantity| (quantity.to_string(), quantity.unit(&scenario.units)));
        view::map::Labels { units: [unit(&self.map.axes[0]), unit(&self.map.axes[1])], quantity }
    }
}

impl Session {
    /// `map P [A..B] Q [C..D] [of QUANTITY]`.
    pub(in crate::session) fn draw_map(&mut self, words: &[String], io: &mut Output<'_>) -> Result<(), CommandError> {
        let (words, quantity) = match tokens::place_of(words, "of") {
            None => (words, None),
            Some(at) => {
                let quantities = self.quantities(&words[at + 1..])?;
                let [quantity] = &quantities[..] else {
                    return refused("map: one quantity after `of`");
                };
                if !quantity.is_of_state() {
                    return refused(format!(
                        "map: `{quantity}` is not read from one state: it takes a history or a search of its own at each place; \
                         `sweep P A..B Q C..D --columns '{quantity}'` has it on a grid"
                    ));
                }
                (&words[..at], Some(quantity.clone()))
            }
        };
        let axes = self.axes(words, "map")?;
        let Ok(axes) = <[Axis; 2]>::try_from(axes) else {
            return refused("map: expected two parameters or load cases: `map P A..B Q C..D [of QUANTITY]`");
        };
        let ground = self.ground(io.watch)?;
        let asked = quantity.clone();
        let found =
            worker::run_patiently(io.watch, PATIENCE, move |watch| map(ground.case(watch), axes, asked.as_ref()))??;
        let drawn = Arc::new(Drawn { map: found, quantity, values: self.now.values.clone() });
        let report = self.map_json(&drawn);
        io.show(&report, |out, style| view::map::write(out, &drawn.map, &drawn.labels(&self.now.scenario), style))?;
        self.keep_result(&report);
        self.map = Some(drawn);
        Ok(())
    }

    /// The last map; where it was drawn under other values than the present ones, its axes aside, a note says so.
    ///
    /// # Errors
    /// None was drawn.
    pub(in crate::session) fn need_map(&self) -> Result<Drawn, CommandError> {
        let Some((drawn, stale)) = self.last_map() else {
            return refused("no map yet: `map P A..B Q C..D` draws one");
        };
        let mut drawn = Drawn::clone(&drawn);
        drawn.map.notes.extend(stale.map(|stale| format!("The map was drawn {stale}.")));
        Ok(drawn)
    }

    /// The last map, and under which other values than the present ones it was drawn, if it was.
    pub fn last_map(&self) -> Option<(Arc<Drawn>, Option<String>)> {
        let drawn = self.map.clone()?;
        let axes: Vec<&str> = drawn.map.axes.iter().map(|axis| axis.name.as_str()).collect();
        let stale = self.other_values(&drawn.values, &axes);
        Some((drawn, stale))
    }

    pub(in crate::session) fn map_json(&self, drawn: &Drawn) -> Json {
        let Drawn { map, quantity, .. } = drawn;
        let axis = |axis: &Axis| json!({"parameter": axis.name, "from": axis.range[0], "to": axis.range[1]});
        let regions = map.regions.iter().enumerate().map(|(index, region)| {
            let mut entry = json!(region);
            for (key, states) in [("states", &region.states), ("other", &region.other)] {
                let states = states.as_ref().map(|states| {
                    states.iter().map(|(id, state)| (id.clone(), json!(state))).collect::<serde_json::Map<_, _>>()
                });
                entry[key] = json!(states);
            }
            entry["outcome"] = json!(if region.states.is_some() { "answer" } else { "ray" });
            entry["outlines"] = json!(map.outlines(index));
            entry
        });
        json!({
            "axes": map.axes.iter().map(axis).collect::<Vec<_>>(),
            "quantity": quantity.as_ref().map(ToString::to_string),
            "regions": regions.collect::<Vec<_>>(),
            "exact": map.known == Known::Exactly,
            "complete": map.left_out.is_none(),
            "notes": map.notes,
        })
    }
}
