//! The plane of two parameters cut into its regions of equal working scheme.
//!
//! Across the plane run *lines*: one parameter followed on its path, the other standing still. Lines that pass the
//! same schemes in the same order make a *panel*; where the order changes is found by halving, to the last digits. The
//! bounds of the parts of a panel are smooth curves (straight for two loads), whose areas Gauss's rule gives. Parts of
//! neighbouring panels that touch and have one scheme make a *region*.

mod line;
mod panel;
mod regions;

use serde::Serialize;

pub use line::{Lines, Others, Part, Scheme};
pub use panel::{LeftOut, Panel};

use self::panel::Cutter;
use self::regions::regions;
use super::envelope::Axis;
use super::quantity::{Facts, Value};
use super::route::{IN_STEPS, Known, Route};
use super::start::PathError;
use crate::answer::record::{RayClass, State, Verdict};
use crate::model::jet::Dependence;
use crate::model::quantity::Quantity;
use crate::model::rules::Rules;
use crate::model::uses::Redone;
use crate::solve::Case;
use crate::solve::error::QuestionError;
use crate::watch::StopOnly;

/// Other answers are looked for in maps of at most this many pairs …
const ENUMERATED_PAIRS: usize = 8;
/// … and this many regions.
const ENUMERATED_REGIONS: usize = 64;
/// All answers at the upper end of each line are looked for in maps of at most this many pairs.
const ENUMERATED_ENDS: usize = 4;

/// A region: one scheme, connected.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Region {
    /// Its letter in the picture.
    pub letter: String,
    /// State of each pair by its id; `None` where there is no answer.
    pub states: Option<Vec<(String, State)>>,
    /// Where the answer that is followed from the upper end is another one: its states.
    pub other: Option<Vec<(String, State)>>,
    /// Area, in the units of the two parameters.
    pub area: f64,
    /// A place well inside, in the order of the axes.
    pub at: [f64; 2],
    /// Without an answer: the class of the ray at that place.
    pub class: Option<RayClass>,
    /// What is proved of it there.
    pub verdict: Option<Verdict>,
    /// The motion there, in words.
    pub mode: Option<String>,
    /// How many answers there are at that place, proved; `None` where that was not looked for.
    pub answers: Option<usize>,
    /// The quantity asked for, at that place.
    pub value: Option<serde_json::Value>,
}

impl Region {
    /// Whether more than one answer was found.
    pub fn has_several(&self) -> bool {
        self.other.is_some() || self.answers.is_some_and(|answers| answers > 1)
    }
}

/// The map.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Horizontal and vertical axis.
    pub axes: [Axis; 2],
    /// The regions, from the left below.
    pub regions: Vec<Region>,
    /// The strips, in the order of the parameter across them.
    pub panels: Vec<Panel>,
    /// For every panel the region of each of its parts.
    pub region_of: Vec<Vec<usize>>,
    /// Index of the axis along the lines.
    pub along: usize,
    /// How well its bounds are known.
    pub known: Known,
    /// How other answers were looked for.
    pub others: Others,
    /// Whether all places where the order of the schemes changes were found; otherwise why not, and the number of lines by
    /// which it is drawn.
    pub left_out: Option<(LeftOut, usize)>,
    /// What limits it, in sentences.
    pub notes: Vec<String>,
}

impl Map {
    /// The region at a place, in the order of the axes; `None` outside.
    pub fn region_at(&self, place: [f64; 2]) -> Option<usize> {
        let (along, across) = (place[self.along], place[1 - self.along]);
        let panel = self.panels.iter().position(|panel| across <= panel.ends()[1]).unwrap_or(self.panels.len() - 1);
        let bounds = self.panels[panel].bounds(across);
        let part = bounds[1..].iter().position(|bound| along <= *bound).unwrap_or(bounds.len().checked_sub(2)?);
        self.region_of[panel].get(part).copied()
    }

    /// The place at these values along the lines and across them, in the order of the axes.
    pub fn place(&self, along: f64, across: f64) -> [f64; 2] {
        if self.along == 0 { [along, across] } else { [across, along] }
    }

    /// The outlines of a region's parts, in the order of the axes, panel by panel.
    pub fn outlines(&self, region: usize) -> Vec<Vec<[f64; 2]>> {
        let mut outlines = Vec::new();
        for (panel, regions) in self.panels.iter().zip(&self.region_of) {
            for part in (0..regions.len()).filter(|part| regions[*part] == region) {
                let lower = panel.lines.iter().map(|line| self.place(line.parts[part].from, line.at));
                let upper = panel.lines.iter().rev().map(|line| self.place(line.parts[part].to, line.at));
                outlines.push(lower.chain(upper).collect());
            }
        }
        outlines
    }
}

/// The map of two parameters (or factors of load cases); `quantity` is read at a place of every region.
///
/// # Errors
/// Axes that cannot be varied, an interruption before there is anything to show; see [`PathError`].
pub fn map(case: Case<'_>, axes: [Axis; 2], quantity: Option<&Quantity>) -> Result<Map, PathError> {
    if case.prepared.system().is_none() {
        return Err(PathError::Plain("map"));
    }
    let along = along(case, &axes)?;
    let across = &axes[1 - along];
    let others = others(case, &axes)?;
    let lines = Lines::new(case, (&axes[along].name, axes[along].range), &across.name, others);
    let mut cutter = Cutter::new(&lines, across.range);
    let panels = cutter.panels()?;
    let (known, left_out) = (cutter.known, cutter.left_out);
    let region_of = regions(&panels, axes.each_ref().map(|axis| axis.range), along);
    let mut map =
        Map { axes, regions: Vec::new(), panels, region_of, along, known, others, left_out, notes: Vec::new() };
    map.describe(case, quantity)?;
    map.say(case);
    Ok(map)
}

/// The axis along which the lines run: a load if one of the two is one (its paths are straight), else a friction.
fn along(case: Case<'_>, axes: &[Axis; 2]) -> Result<usize, PathError> {
    let mut best = (0, 0);
    for (index, axis) in axes.iter().enumerate() {
        let exact = match Route::new(case, &axis.name, axis.range) {
            Ok(Some(route)) if route.is_straight() => 2,
            Ok(Some(_)) => 1,
            Ok(None) => 0,
            Err(PathError::NoStart { .. }) => 1,
            Err(error) => return Err(error),
        };
        if exact > best.1 {
            best = (index, exact);
        }
    }
    Ok(best.0)
}

/// How other answers are to be looked for.
fn others(case: Case<'_>, axes: &[Axis; 2]) -> Result<Others, PathError> {
    // In space all answers could be found for a polygon only.
    if case.prepared.is_in_space() {
        return Ok(Others::FromAbove);
    }
    let pairs = case.prepared.system().map_or(0, |system| system.pairs.len());
    let otherwise = if pairs <= ENUMERATED_ENDS { Others::FromAllAbove } else { Others::FromAbove };
    let corner =
        |k: usize| case.at_all(&[(&axes[0].name, axes[0].range[k % 2]), (&axes[1].name, axes[1].range[k / 2])]);
    let corners = match (0..4).map(corner).collect::<Result<Vec<_>, _>>() {
        Ok(corners) => corners,
        // What a corner cannot take, the lines beside it may.
        Err(QuestionError::Refused(_)) => return Ok(otherwise),
        Err(error) => return Err(error.into()),
    };
    let is_stiff = corners[1..]
        .iter()
        .all(|there| case.scenario.uses.between(&corners[0].values, &there.values) != Redone::Stiffness);
    let bends = axes.iter().any(|axis| friction_bends(case, &axis.name));
    // Friction is largest in a corner, if it neither bends nor is larger for some pairs in one and for others in another.
    let frictions: Vec<Vec<f64>> = corners.iter().map(|there| there.case(case).frictions()).collect();
    let exceeds = |one: &[f64], other: &[f64]| one.iter().zip(other).all(|(one, other)| one >= other);
    let most = (0..4).find(|k| frictions.iter().all(|other| exceeds(&frictions[*k], other)));
    let Some(most) = most.filter(|_| is_stiff && !bends) else { return Ok(otherwise) };
    let there = &corners[most];
    Ok(if there.case(case).is_unique() { Others::None } else { otherwise })
}

/// Whether the friction of a pair depends on a parameter in another way than a + b θ.
fn friction_bends(Case { prepared, values, .. }: Case<'_>, name: &str) -> bool {
    let along = values.along(name);
    prepared.system().is_some_and(|system| {
        let mut frictions = system.pairs.iter().filter_map(|pair| pair.law.friction());
        frictions.any(|friction| along.dependence(friction) == Dependence::Nonlinear)
    })
}

/// The letters of the first regions, one each.
const LETTERS: &[u8; 52] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";

/// A, B, …, Z, a, …, z, AA, AB, …
fn letters(mut index: usize) -> String {
    let mut word = String::new();
    loop {
        word.insert(0, char::from(LETTERS[index % LETTERS.len()]));
        if index < LETTERS.len() {
            return word;
        }
        index = index / LETTERS.len() - 1;
    }
}

impl Map {
    /// The regions from the panels, each with what an answer at a place inside shows.
    fn describe(&mut self, case: Case<'_>, quantity: Option<&Quantity>) -> Result<(), PathError> {
        let count = self.region_of.iter().flatten().max().map_or(0, |last| last + 1);
        let ids: Vec<String> = case
            .prepared
            .system()
            .map(|system| system.pairs.iter().map(|pair| pair.id.clone()).collect())
            .unwrap_or_default();
        let enumerated = ids.len() <= ENUMERATED_PAIRS && count <= ENUMERATED_REGIONS && !case.prepared.is_in_space();
        for region in 0..count {
            case.watch.progress(&format!("region {} of {count}", region + 1), region as f64 / count as f64);
            let mut area = 0.0;
            let mut largest = (f64::NEG_INFINITY, 0, 0);
            for (number, (panel, regions)) in self.panels.iter().zip(&self.region_of).enumerate() {
                for part in (0..regions.len()).filter(|part| regions[*part] == region) {
                    area += panel.areas[part];
                    if panel.areas[part] > largest.0 {
                        largest = (panel.areas[part], number, part);
                    }
                }
            }
            let (_, panel, part) = largest;
            let [low, high] = self.panels[panel].ends();
            let across = 0.5 * (low + high);
            let bounds = self.panels[panel].bounds(across);
            let inside = 0.5 * (bounds[part] + bounds[part + 1]);
            let at = self.place(inside, across);
            let named = |states: &[State]| Some(ids.iter().cloned().zip(states.iter().copied()).collect());
            let (states, other) = match &self.panels[panel].lines[0].parts[part].scheme {
                Scheme::Pairs(states) => (named(states), None),
                Scheme::Several(states, other) => (named(states), named(other)),
                Scheme::NoAnswer => (None, None),
            };
            let mut found = Region {
                letter: letters(region),
                states,
                other,
                area,
                at,
                class: None,
                verdict: None,
                mode: None,
                answers: None,
                value: None,
            };
            if self.left_out.is_none_or(|(why, _)| why != LeftOut::Stopped) {
                self.look(case, &mut found, enumerated, quantity)?;
            }
            self.regions.push(found);
        }
        Ok(())
    }

    /// What an answer of its own at the region's place shows.
    fn look(
        &self,
        case: Case<'_>,
        region: &mut Region,
        enumerated: bool,
        quantity: Option<&Quantity>,
    ) -> Result<(), PathError> {
        let step = StopOnly(case.watch);
        let case = case.watched(&step);
        let settings = [(self.axes[0].name.as_str(), region.at[0]), (self.axes[1].name.as_str(), region.at[1])];
        let there = case.at_all(&settings)?;
        if region.states.is_none() {
            let solved = there.case(case).solve()?;
            if let Some(ray) = &solved.answer.ray {
                region.class = Some(ray.class);
                region.verdict = ray.verdict;
                region.mode = Some(ray.mode.clone()).filter(|mode| !mode.is_empty());
            }
            return Ok(());
        }
        if enumerated && let Ok(all) = there.prepared.all_answers(&there.values, Rules::default(), case.watch) {
            let is_whole = all.complete && all.undecided == 0 && !all.within_rounding && all.continua.is_empty();
            let proved = is_whole && all.exact.iter().all(|exact| *exact);
            region.answers = proved.then_some(all.answers.len());
        }
        if let Some(quantity) = quantity {
            let there = there.case(case);
            let solved = there.solve_briefly()?;
            let facts = Facts::of_answer(there, &solved);
            region.value = facts.value(quantity).ok().map(|value: Value| value.json());
        }
        Ok(())
    }

    /// What the map does not show.
    fn say(&mut self, case: Case<'_>) {
        let pairs = case.prepared.system().map_or(0, |system| system.pairs.len());
        if let Some((why, lines)) = self.left_out {
            let [why, look] = match why {
                LeftOut::Stopped => ["stopped before its end", "; its regions were not looked at one by one"],
                LeftOut::Intricate => ["too intricate to be cut exactly (smaller ranges may be)", ""],
            };
            self.notes.push(format!(
                "{why}: drawn by the {lines} lines along {} that were looked at; between them bounds and areas are \
                 approximate, and small regions may be missing{look}",
                self.axes[self.along].name
            ));
        }
        if self.known == Known::InSteps {
            self.notes.push(format!("lines along {} are {IN_STEPS}", self.axes[self.along].name));
        }
        if self.known == Known::AtPlaces {
            self.notes.push(format!(
                "no exact path leads over {}: the places on its lines were solved one by one, and each change between \
                 two of them was narrowed by halving; what comes and goes between two of them is not seen",
                self.axes[self.along].name
            ));
        }
        let counted = match pairs > ENUMERATED_PAIRS || self.regions.len() > ENUMERATED_REGIONS {
            _ if case.prepared.is_in_space() => "; in space they are not counted".to_owned(),
            true => format!(
                "; at the marked places all of them are counted for up to {ENUMERATED_PAIRS} pairs and {ENUMERATED_REGIONS} \
                 regions only"
            ),
            false => "; at the marked places all of them are counted".to_owned(),
        };
        self.notes.push(match self.others {
            Others::None => {
                "nowhere is there more than one state of forces: that is proved for all of this friction, whatever the loads"
                    .to_owned()
            }
            Others::FromAllAbove if self.known == Known::Exactly => format!(
                "other answers were looked for by following each line from its lower end and from all answers at its upper \
                 one: of those that reach neither end some may be missing{counted}"
            ),
            _ if self.known != Known::AtPlaces => format!(
                "other answers were looked for only by following each line from both ends: others may be there{counted}"
            ),
            _ => format!("other answers were not looked for along the lines{counted}"),
        });
        if self.regions.len() > LETTERS.len() {
            self.notes.push("where a letter is two, the picture shows its last".to_owned());
        }
        if self.regions.iter().any(Region::has_several) {
            self.notes.push(
                "hatched: more than one answer is possible; the map shows the one that is followed from the lower end \
                 of a line"
                    .to_owned(),
            );
        }
        if self.regions.iter().any(|region| region.states.is_none()) {
            self.notes.push(
                "without an answer: examined at the marked place; beyond the end of a path other answers were looked \
                 for at four places of each line"
                    .to_owned(),
            );
        }
    }
}
