//! Where a quantity fulfils a condition over a parameter: on an exact path every place, elsewhere brackets between
//! runs of their own.

use std::cell::Cell;

use super::profile::{Shape, number, profile, zero};
use super::quantity::{Facts, Value, history_for};
use super::route::Route;
use super::start::{PathError, ROUNDING};
use crate::model::quantity::{OfAnswer, Quantity};
use crate::solve::case::There;
use crate::solve::error::QuestionError;
use crate::solve::known_collapses::KnownCollapses;
use crate::solve::{Case, Solved};
use crate::text::number::short;

/// Intervals into which a range is cut where there is no exact path.
pub const CELLS: usize = 40;
/// Changes that are narrowed within one of them at most: more are rounding around the wanted number.
const CHANGES: usize = 8;
/// A bracket between answers is narrowed to this share of its place.
const NARROW: f64 = 1e-10;

/// In so many parts of a path a run of its own is made to find out whether there are other answers.
const LOOKED_AT: usize = 8;

/// How a quantity is to compare with a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// `<`
    Less,
    /// `<=`
    AtMost,
    /// `=`
    Equal,
    /// `>=`
    AtLeast,
    /// `>`
    Greater,
}

/// What is asked of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// It compares so with a number.
    Compared(Order, f64),
    /// It is this word; `answer` stands for trivial and normal.
    Word(String),
}

/// A value at which the condition begins or ceases to hold, or at which the quantity meets the number.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Place {
    /// The value of the parameter; in a bracket its middle.
    pub value: f64,
    /// Where no path leads: values with answers, or proofs of none, between which it lies.
    pub bracket: Option<[f64; 2]>,
    /// The quantity just below; null where it has no value.
    pub below: Option<serde_json::Value>,
    /// The quantity just above.
    pub above: Option<serde_json::Value>,
    /// What changes there, in words.
    pub change: Option<String>,
}

/// What was found.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Found {
    /// Whether every value was found on an exact path.
    pub exact: bool,
    /// Where the condition holds: values of the parameter from … to.
    pub holds: Vec<[f64; 2]>,
    /// The places, upwards.
    pub places: Vec<Place>,
    /// The values between which there was an answer to look at.
    pub covered: [f64; 2],
    /// What limits the search, in sentences.
    pub notes: Vec<String>,
}

/// Which side of the wanted number: −1, 0, 1; for a word 1 where it is the wanted one, −1 where not; `None` without a
/// value.
fn side(wanted: &Wanted, value: Option<&Value>, size: f64) -> Option<i8> {
    match (wanted, value?) {
        (Wanted::Compared(_, wanted), Value::Number(found)) => {
            let off = found - wanted;
            let rounding = ROUNDING * size.max(found.abs()).max(wanted.abs());
            Some(if off.abs() <= rounding { 0 } else { off.signum() as i8 })
        }
        (Wanted::Word(wanted), Value::Word(found)) => {
            let holds = found == wanted || wanted == "answer" && (found == "trivial" || found == "normal");
            Some(if holds { 1 } else { -1 })
        }
        _ => None,
    }
}

impl Wanted {
    fn holds(&self, side: Option<i8>) -> bool {
        let Some(side) = side else { return false };
        match self {
            Wanted::Word(_) | Wanted::Compared(Order::Greater, _) => side > 0,
            Wanted::Compared(Order::Less, _) => side < 0,
            Wanted::Compared(Order::Equal, _) => side == 0,
            Wanted::Compared(Order::AtMost, _) => side <= 0,
            Wanted::Compared(Order::AtLeast, _) => side >= 0,
        }
    }

    fn is_equality(&self) -> bool {
        matches!(self, Wanted::Compared(Order::Equal, _))
    }

    /// Whether it may hold at a single value, where the quantity only just meets the number.
    fn holds_where_met(&self) -> bool {
        matches!(self, Wanted::Compared(Order::AtMost | Order::AtLeast, _))
    }
}

/// A part of the range on one side of the wanted value, with the values at its ends.
#[derive(Clone, Debug)]
struct Part {
    from: f64,
    to: f64,
    side: Option<i8>,
    ends: [Option<Value>; 2],
}

/// Finds where a quantity is as wanted within a range of a parameter or of the factor of a load case.
///
/// # Errors
/// No answer to start from; see [`PathError`].
pub fn find(
    case: Case<'_>,
    name: &str,
    range: [f64; 2],
    quantity: &Quantity,
    wanted: &Wanted,
) -> Result<Found, PathError> {
    let route = if quantity.is_of_state() { Route::over_all(case, name, range)? } else { None };
    match route {
        Some(route) => on_route(&route, range, quantity, wanted),
        None => on_grid(case, name, range, quantity, wanted),
    }
}

fn on_route(route: &Route<'_>, range: [f64; 2], quantity: &Quantity, wanted: &Wanted) -> Result<Found, PathError> {
    let mut parts: Vec<Part> = Vec::new();
    for piece in profile(route, quantity)? {
        let (from, to) = (piece.stretch.from, piece.stretch.to);
        if let Some(end) = parts.last().map(|part| part.to).filter(|end| *end < from) {
            parts.push(Part { from: end, to: from, side: None, ends: [None, None] });
        }
        match piece.shape {
            Shape::Nothing => parts.push(Part { from, to, side: None, ends: [None, None] }),
            Shape::Steady(value) => {
                let side = side(wanted, Some(&value), 0.0);
                parts.push(Part { from, to, side, ends: [Some(value.clone()), Some(value)] });
            }
            Shape::Curve(points) => {
                let size = points.iter().fold(0.0, |size: f64, (_, f)| size.max(f.abs()));
                let of = |f: f64| side(wanted, Some(&Value::Number(f)), size);
                // A value that differs from the number by rounding is equal to it.
                let snapped = |f: f64| match wanted {
                    Wanted::Compared(_, level) if of(f) == Some(0) => Some(Value::Number(*level)),
                    _ => Some(Value::Number(f)),
                };
                let mut part = |from: f64, to: f64, side: Option<i8>, f: f64, g: f64| {
                    parts.push(Part { from, to, side, ends: [snapped(f), snapped(g)] });
                };
                for two in points.windows(2) {
                    let ((a, f), (b, g)) = (two[0], two[1]);
                    match (of(f), of(g)) {
                        (x, y) if x == y => part(a, b, x, f, g),
                        (Some(0), y) => part(a, b, y, f, g),
                        (x, Some(0)) => part(a, b, x, f, g),
                        (x, y) => {
                            let Wanted::Compared(_, level) = wanted else { continue };
                            let off = |at: f64| Some(number(route, &piece.stretch, at, quantity)? - level);
                            let root = zero(&off, (a, f - level), (b, g - level));
                            part(a, root, x, f, *level);
                            part(root, b, y, *level, g);
                        }
                    }
                }
            }
        }
    }
    let mut found = gather(&parts, wanted, |value| Place {
        value,
        bracket: None,
        below: None,
        above: None,
        change: route.change(value),
    });
    found.exact = route.is_exact(quantity);
    found.covered = route.covered();
    found.notes = route.notes();
    let [low, high] = found.covered;
    if (low > range[0] || high < range[1]) && found.notes.is_empty() {
        found.notes.push("the path does not lead through the whole range".to_owned());
    }
    found.notes.extend(route.doubt(quantity));
    found.notes.extend(route.other_answer(middles(&found))?);
    Ok(found)
}

/// The middles of the first parts between the places.
fn middles(found: &Found) -> Vec<f64> {
    let [low, high] = found.covered;
    let ends: Vec<f64> =
        std::iter::once(low).chain(found.places.iter().map(|place| place.value)).chain([high]).collect();
    ends.windows(2).filter(|two| two[0] < two[1]).map(|two| 0.5 * (two[0] + two[1])).take(LOOKED_AT).collect()
}

/// Intervals and places from the parts, in order.
fn gather(parts: &[Part], wanted: &Wanted, place: impl Fn(f64) -> Place) -> Found {
    let mut intervals: Vec<[f64; 2]> = Vec::new();
    for part in parts.iter().filter(|part| wanted.holds(part.side)) {
        match intervals.last_mut() {
            Some(last) if last[1] == part.from => last[1] = part.to,
            _ => intervals.push([part.from, part.to]),
        }
    }
    let mut places: Vec<Place> = Vec::new();
    let touches = |part: &Part, end: usize| side(wanted, part.ends[end].as_ref(), 0.0) == Some(0);
    if wanted.holds_where_met() {
        // Between two parts, or at the very ends, outside of which it does not hold.
        let holds = |part: Option<&Part>| part.is_some_and(|part| wanted.holds(part.side));
        for k in 0..=parts.len() {
            let (before, after) = (k.checked_sub(1).map(|k| &parts[k]), parts.get(k));
            let met = before.is_some_and(|part| touches(part, 1)) || after.is_some_and(|part| touches(part, 0));
            if met && !holds(before) && !holds(after) {
                let at = before.map_or_else(|| parts[k].from, |part| part.to);
                intervals.push([at, at]);
            }
        }
        intervals.sort_by(|a, b| a[0].total_cmp(&b[0]));
    }
    let ends = parts.windows(2).filter(|two| {
        let (a, b) = (two[0].side, two[1].side);
        if wanted.is_equality() {
            // From one side to the other, or touching: through the number or across it in a jump.
            a.is_some() && b.is_some() && (a != b || (a != Some(0) && touches(&two[0], 1) && touches(&two[1], 0)))
        } else {
            wanted.holds(a) != wanted.holds(b)
        }
    });
    for two in ends {
        let json = |value: &Option<Value>| value.as_ref().map(Value::json);
        let next = Place { below: json(&two[0].ends[1]), above: json(&two[1].ends[0]), ..place(two[0].to) };
        places.push(next);
    }
    // The quantity may meet the number at the very ends.
    if wanted.is_equality() {
        let meets =
            |part: &Part, end: usize| part.side != Some(0) && side(wanted, part.ends[end].as_ref(), 0.0) == Some(0);
        let json = |value: &Option<Value>| value.as_ref().map(Value::json);
        if let Some(first) = parts.first().filter(|part| meets(part, 0)) {
            places.insert(0, Place { above: json(&first.ends[0]), ..place(first.from) });
        }
        if let Some(last) = parts.last().filter(|part| meets(part, 1)) {
            places.push(Place { below: json(&last.ends[1]), ..place(last.to) });
        }
    }
    let covered = [parts.first().map_or(f64::NAN, |part| part.from), parts.last().map_or(f64::NAN, |part| part.to)];
    Found { exact: false, holds: intervals, places, covered, notes: Vec::new() }
}

/// The quantity at a value of the parameter.
#[derive(Clone)]
struct Look {
    at: f64,
    value: Option<Value>,
    side: Option<i8>,
    /// Whether no answer was found in f64, and no proof was looked for.
    quick: bool,
}

/// Answers of their own at values of a parameter.
struct Looks<'a> {
    case: Case<'a>,
    name: &'a str,
    quantity: &'a Quantity,
    wanted: &'a Wanted,
    /// Between these values the polygon alone has an answer somewhere.
    polygon_only: Cell<Option<[f64; 2]>>,
    known: KnownCollapses,
}

impl Looks<'_> {
    fn value(&self, there: &There, solved: &Solved) -> Result<Option<Value>, PathError> {
        let Looks { case, quantity, .. } = *self;
        if !solved.answer.is_answer() && quantity.is_of_state() {
            return Ok(None);
        }
        let there = there.case(case);
        let history = history_for(there, std::slice::from_ref(quantity))?;
        Ok(Facts::of_answer(there, solved).beside(history.as_ref()).value(quantity).ok())
    }

    fn whole(&self, at: f64) -> Result<Look, PathError> {
        let mut value = None;
        if let Some((there, solved)) = self.case.solved_at(&[(self.name, at)])? {
            if solved.answer.is_answer() && !solved.stands(self.case.rules.cone) {
                let [from, to] = self.polygon_only.get().unwrap_or([at, at]);
                self.polygon_only.set(Some([from.min(at), to.max(at)]));
            }
            value = self.value(&there, &solved)?;
        }
        Ok(self.look(at, value, false))
    }

    fn look(&self, at: f64, value: Option<Value>, quick: bool) -> Look {
        let side = side(self.wanted, value.as_ref(), 0.0);
        Look { at, value, side, quick }
    }

    /// The same, but where no answer is found in f64 none is looked for in other ways, and no proof that there is none.
    fn quick(&self, at: f64) -> Result<Look, PathError> {
        let outcome = matches!(self.quantity, Quantity::Answer(OfAnswer::Outcome));
        let asks_for_answer =
            matches!(self.wanted, Wanted::Word(word) if ["answer", "trivial", "normal"].contains(&word.as_str()));
        let is_told = self.quantity.is_of_state() || (outcome && asks_for_answer);
        if !is_told || self.case.prepared.is_in_space() {
            return self.whole(at);
        }
        let there = match self.case.at(self.name, at) {
            Err(QuestionError::Refused(_)) => return Ok(self.look(at, None, false)),
            there => there?,
        };
        Ok(match there.case(self.case).look_for_pairs(&self.known)? {
            Ok(solved) => self.look(at, self.value(&there, &solved.completed())?, false),
            Err(word) => self.look(at, outcome.then(|| Value::Word(word.to_owned())), true),
        })
    }

    /// The bracket of a change between two values, narrowed until the middle tells its ends no longer apart. Where an end is one
    /// without an answer that only looking for proofs finds, proofs are looked for on the way.
    fn narrowed(&self, from: &Look, to: &Look, least: impl Fn(&Look, &Look) -> f64) -> Result<[Look; 2], PathError> {
        let halved = |look: &dyn Fn(f64) -> Result<Look, PathError>| -> Result<[Look; 2], PathError> {
            let (mut a, mut b) = (from.clone(), to.clone());
            while (b.at - a.at).abs() > least(&a, &b) {
                let middle = look(0.5 * (a.at + b.at))?;
                if middle.side == a.side { a = middle } else { b = middle }
            }
            Ok([a, b])
        };
        let mut found = halved(&|at| self.quick(at))?;
        let mut same = true;
        for end in found.iter_mut().filter(|end| end.quick) {
            let whole = self.whole(end.at)?;
            same &= whole.side == end.side;
            *end = whole;
        }
        if same { Ok(found) } else { halved(&|at| self.whole(at)) }
    }
}

fn on_grid(
    case: Case<'_>,
    name: &str,
    range: [f64; 2],
    quantity: &Quantity,
    wanted: &Wanted,
) -> Result<Found, PathError> {
    let [low, high] = range;
    let looks = Looks { case, name, quantity, wanted, polygon_only: Cell::new(None), known: KnownCollapses::default() };
    let least = |a: &Look, b: &Look| NARROW * a.at.abs().max(b.at.abs()).max(1e-3 * (high - low));
    let mut last = looks.whole(low)?;
    let mut parts: Vec<Part> = Vec::new();
    let mut brackets: Vec<[f64; 2]> = Vec::new();
    let mut unclear: Vec<String> = Vec::new();
    for k in 1..=CELLS {
        case.watch.progress(&format!("{name} = {}", last.at), k as f64 / CELLS as f64);
        let next = looks.whole(if k == CELLS { high } else { low + (high - low) * k as f64 / CELLS as f64 })?;
        let mut start = last.at;
        // Each change of the side: behind it may be a side that neither end has.
        let mut changes = 0;
        while last.side != next.side && changes < CHANGES {
            changes += 1;
            let [a, mut b] = looks.narrowed(&last, &next, least)?;
            // A number that is met within the width of a bracket only is passed.
            if b.side == Some(0) && b.at < next.at {
                let beyond = looks.whole((b.at + least(&a, &b)).min(next.at))?;
                if beyond.side != b.side {
                    b = beyond;
                }
            }
            let middle = 0.5 * (a.at + b.at);
            brackets.push([a.at, b.at]);
            parts.push(Part { from: start, to: middle, side: a.side, ends: [last.value.clone(), a.value] });
            (start, last) = (middle, b);
        }
        if last.side != next.side {
            let [from, to] = [start, next.at].map(short);
            unclear.push(format!("between {name} = {from} and {to} there are more changes than were narrowed"));
        }
        parts.push(Part { from: start, to: next.at, side: next.side, ends: [last.value, next.value.clone()] });
        last = next;
    }
    let bracket = |value: f64| brackets.iter().copied().find(|[a, b]| (*a..=*b).contains(&value));
    let place = |value: f64| Place { value, bracket: bracket(value), below: None, above: None, change: None };
    let mut found = gather(&parts, wanted, place);
    found.notes.push(format!(
        "no exact path leads over {name} here: {} values were solved one by one, and each change between two of them \
         was narrowed to a bracket between two more; what comes and goes between two of them is not seen",
        CELLS + 1
    ));
    found.notes.extend(unclear);
    if let Some([from, to]) = looks.polygon_only.get() {
        found.notes.push(format!(
            "at values between {name} = {from} and {to} the answer is one of the friction polygon, and none on Coulomb's cone was \
             found: `find least|most {name} A..B where outcome answer` counts those on the cone only"
        ));
    }
    if parts.iter().any(|part| part.side.is_none()) {
        found.notes.push(format!("{quantity} has no value in parts of the range"));
    }
    Ok(found)
}
