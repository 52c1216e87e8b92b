//! Exact probabilities: of one parameter from the answer followed over its range, of two from the areas of the map.

use serde_json::Value as Json;

use super::draw::Variable;
use super::statistics::{Found, QUANTILES, Share, Spread, Words, bars};
use crate::answer::record::Verdict;
use crate::model::quantity::Quantity;
use crate::path::envelope::Axis;
use crate::path::map::{LeftOut, Lines, Others, Scheme, map};
use crate::path::profile::{Piece, Shape, number, profile, zero};
use crate::path::quantity::Value;
use crate::path::route::{Known, Route};
use crate::path::start::PathError;
use crate::solve::Case;
use crate::text::number::short;

/// A law without an end is followed until this share of it is left on each side.
const TAIL: f64 = 1e-9;
/// Places of a part without an answer at which that is proved, as shares of its length.
const PROVED_AT: [f64; 3] = [0.01, 0.5, 0.99];
/// Halvings by which a quantile is found.
const HALVINGS: usize = 60;
/// Two lengths are the same up to this share of the range.
const SAME: f64 = 1e-9;

/// Gauss's rule of 5 places on [−1, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// What is known exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct Exact {
    pub collapse: f64,
    pub undecided: f64,
    /// Of each quantity; empty where they have to be drawn.
    pub spreads: Vec<Spread>,
    /// How it is known, in sentences.
    pub notes: Vec<String>,
}

/// Whether a ray is proved to have no answer.
pub fn judged(verdict: Option<Verdict>) -> Found {
    if verdict.is_some_and(Verdict::is_proof) { Found::Collapse } else { Found::Undecided }
}

/// Of one parameter; `None` where no exact path leads over it.
///
/// # Errors
/// See [`PathError`].
pub fn of_one(case: Case<'_>, variable: &Variable, quantities: &[Quantity]) -> Result<Option<Exact>, PathError> {
    let Variable { name, of } = variable;
    let range = of.ends().unwrap_or_else(|| [of.quantile(TAIL), of.quantile(1.0 - TAIL)]);
    if !is_followed(case, name, range)? {
        return Ok(None);
    }
    let lines = Lines::new(case, (name, range), name, Others::FromAbove);
    let (parts, known) = lines.over(case, &[])?;
    if known != Known::Exactly {
        return Ok(None);
    }
    let length = range[1] - range[0];
    let (mut collapse, mut answers, mut one_way) = (0.0, 0.0, true);
    let mut decided = 0.0;
    for part in &parts {
        let share = of.share(part.to) - of.share(part.from);
        match part.scheme {
            Scheme::NoAnswer => match beyond(case, name, [part.from, part.to])? {
                Found::Collapse => (collapse, decided) = (collapse + share, decided + share),
                Found::Answer | Found::Undecided => {}
            },
            Scheme::Pairs(_) => (answers, decided) = (answers + part.to - part.from, decided + share),
            Scheme::Several(..) => {
                (answers, decided, one_way) = (answers + part.to - part.from, decided + share, false);
            }
        }
    }
    let followed = format!("the answer was followed over {name} from {} to {}", short(range[0]), short(range[1]));
    let tails = of.share(range[0]) + 1.0 - of.share(range[1]);
    let mut notes = vec![match of.ends() {
        Some(_) => format!("exact: {followed}"),
        None => format!("exact but for a share of {tails:.0e} beyond the ends: {followed}"),
    }];
    if collapse > 0.0 {
        notes.push("that there is no answer is proved at three places of each part without one".to_owned());
    }
    let undecided = (1.0 - decided - if of.ends().is_none() { tails } else { 0.0 }).max(0.0);
    let undecided = if undecided < 8.0 * f64::EPSILON { 0.0 } else { undecided };
    let mut spreads = Vec::new();
    if !quantities.is_empty() && answers > 0.0 && one_way {
        let route = Route::new(case, name, range)?;
        let followed = |route: &Route<'_>| route.stretches.iter().map(|stretch| stretch.to - stretch.from).sum::<f64>();
        if let Some(route) = route.filter(|route| (followed(route) - answers).abs() <= SAME * length) {
            notes.extend(quantities.iter().filter_map(|quantity| route.doubt(quantity)));
            let of = |quantity| spread(&route, variable, quantity);
            spreads = quantities.iter().map(of).collect::<Result<_, _>>()?;
        }
    }
    Ok(Some(Exact { collapse, undecided, spreads, notes }))
}

/// Whether an exact path leads over a parameter.
fn is_followed(case: Case<'_>, name: &str, range: [f64; 2]) -> Result<bool, PathError> {
    match Route::new(case, name, range) {
        Ok(route) => Ok(route.is_some()),
        Err(PathError::NoStart { .. }) => Ok(true),
        Err(error) => Err(error),
    }
}

/// What is proved of a part without an answer.
fn beyond(case: Case<'_>, name: &str, [from, to]: [f64; 2]) -> Result<Found, PathError> {
    for share in PROVED_AT {
        let there = case.at(name, from + share * (to - from))?;
        let solved = there.case(case).solve_briefly()?;
        let verdict = solved.answer.ray.as_ref().and_then(|ray| ray.verdict);
        if solved.answer.is_answer() || judged(verdict) != Found::Collapse {
            return Ok(Found::Undecided);
        }
    }
    Ok(Found::Collapse)
}

/// Of two uniform parameters; `None` where the map does not lie on exact paths.
///
/// # Errors
/// As [`of_one`].
pub fn of_two(case: Case<'_>, variables: [&Variable; 2]) -> Result<Option<Exact>, PathError> {
    let mut axes = Vec::new();
    for variable in variables {
        let Some(range) = variable.of.ends().filter(|_| variable.of.is_uniform()) else { return Ok(None) };
        if !is_followed(case, &variable.name, range)? {
            return Ok(None);
        }
        axes.push(Axis { name: variable.name.clone(), range });
    }
    let Ok(axes) = <[Axis; 2]>::try_from(axes) else { return Ok(None) };
    let whole: f64 = axes.iter().map(|axis| axis.range[1] - axis.range[0]).product();
    let found = map(case, axes, None)?;
    match found.left_out {
        Some((LeftOut::Stopped, _)) => return Err(PathError::Interrupted),
        Some((LeftOut::Intricate, _)) => return Ok(None),
        None if found.known != Known::Exactly => return Ok(None),
        None => {}
    }
    let (mut collapse, mut undecided) = (0.0, 0.0);
    for region in found.regions.iter().filter(|region| region.states.is_none()) {
        match judged(region.verdict) {
            Found::Collapse => collapse += region.area / whole,
            _ => undecided += region.area / whole,
        }
    }
    let mut notes = vec![format!("exact: areas of the map of {} and {}", variables[0].name, variables[1].name)];
    if collapse > 0.0 {
        notes.push("that there is no answer is proved at one place of each region without one".to_owned());
    }
    Ok(Some(Exact { collapse, undecided, spreads: Vec::new(), notes }))
}

/// A part of the range in which a quantity rises or falls, from one value to another.
struct Slope<'a> {
    piece: &'a Piece,
    ends: [(f64, f64); 2],
    /// Whether it is a straight line.
    straight: bool,
}

/// A quantity over an exact path.
struct Profile<'a> {
    route: &'a Route<'a>,
    variable: &'a Variable,
    quantity: &'a Quantity,
    slopes: Vec<Slope<'a>>,
    /// Values that are the same over a part, with the share of it.
    steady: Vec<(f64, f64)>,
    /// Share in which it has a number.
    known: f64,
}

fn spread(route: &Route<'_>, variable: &Variable, quantity: &Quantity) -> Result<Spread, PathError> {
    let pieces = profile(route, quantity)?;
    let share = |piece: &Piece| variable.of.share(piece.stretch.to) - variable.of.share(piece.stretch.from);
    let (mut slopes, mut steady) = (Vec::new(), Vec::new());
    let mut words = Words::default();
    for piece in &pieces {
        match &piece.shape {
            Shape::Nothing => {}
            Shape::Steady(Value::Number(value)) => steady.push((*value, share(piece))),
            Shape::Steady(word) => {
                if let Json::String(word) = word.json() {
                    words.add(&word, share(piece));
                }
            }
            Shape::Curve(points) => {
                // Only of a straight line no point is noted between the ends.
                let straight = points.len() == 2;
                slopes.extend(points.windows(2).map(|two| Slope { piece, ends: [two[0], two[1]], straight }));
            }
        }
    }
    let of_words = words.total();
    let mut found = Profile { route, variable, quantity, slopes, steady, known: 0.0 };
    found.known = found.steady.iter().map(|(_, share)| share).sum::<f64>()
        + found.slopes.iter().map(|slope| found.share(slope.ends[0].0, slope.ends[1].0)).sum::<f64>();
    let (known, words) = (found.known + of_words, words.shares(of_words));
    let mut spread = Spread { quantity: quantity.to_string(), known, words, ..Spread::default() };
    found.tell(&mut spread);
    Ok(spread)
}

impl Profile<'_> {
    fn share(&self, from: f64, to: f64) -> f64 {
        self.variable.of.share(to) - self.variable.of.share(from)
    }

    fn value(&self, slope: &Slope<'_>, at: f64) -> f64 {
        let [(a, f), (b, g)] = slope.ends;
        let straight = f + (at - a) / (b - a) * (g - f);
        if slope.straight {
            return straight;
        }
        number(self.route, &slope.piece.stretch, at, self.quantity).unwrap_or(straight)
    }

    /// Share of the values below `value`, of those that are known; at a steady value itself not counted.
    fn below(&self, value: f64) -> f64 {
        let steady = self.steady.iter().filter(|(own, _)| *own < value).map(|(_, share)| share).sum::<f64>();
        let rising = self.slopes.iter().map(|slope| {
            let [(a, f), (b, g)] = slope.ends;
            if f.max(g) <= value {
                return self.share(a, b);
            }
            if f.min(g) >= value {
                return 0.0;
            }
            let off = |at: f64| Some(self.value(slope, at) - value);
            let at = if slope.straight {
                a + (value - f) / (g - f) * (b - a)
            } else {
                zero(&off, (a, f - value), (b, g - value))
            };
            if f < g { self.share(a, at) } else { self.share(at, b) }
        });
        (steady + rising.sum::<f64>()) / self.known
    }

    /// Σ over the values of their powers.
    fn moment(&self, power: i32, about: f64) -> f64 {
        let of = |value: f64| (value - about).powi(power);
        let steady = self.steady.iter().map(|(value, share)| share * of(*value)).sum::<f64>();
        let rising = self.slopes.iter().map(|slope| {
            let [(a, _), (b, _)] = slope.ends;
            let (low, high) = (self.variable.of.share(a), self.variable.of.share(b));
            let at = |x: f64| self.variable.of.quantile(0.5 * (low + high) + 0.5 * x * (high - low)).clamp(a, b);
            GAUSS.iter().map(|(x, weight)| 0.5 * (high - low) * weight * of(self.value(slope, at(*x)))).sum::<f64>()
        });
        (steady + rising.sum::<f64>()) / self.known
    }

    fn tell(&self, spread: &mut Spread) {
        let values = || self.slopes.iter().flat_map(|slope| slope.ends.map(|(_, value)| value));
        let all = || values().chain(self.steady.iter().map(|(value, _)| *value));
        let (least, most) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
        if self.known <= 0.0 || least > most {
            return;
        }
        (spread.least, spread.most) = (Some(least), Some(most));
        let mean = self.moment(1, 0.0);
        (spread.mean, spread.mean_error) = (Some(mean), Some(0.0));
        spread.deviation = Some(self.moment(2, mean).max(0.0).sqrt());
        for p in QUANTILES {
            let (mut a, mut b) = (least, most);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (a + b);
                if self.below(middle) < p { a = middle } else { b = middle }
            }
            spread.quantiles.push((p, 0.5 * (a + b)));
        }
        if least < most {
            spread.histogram = bars(least, most);
            let mut before = 0.0;
            let last = spread.histogram.len() - 1;
            for (k, bar) in spread.histogram.iter_mut().enumerate() {
                let below = if k == last { 1.0 } else { self.below(bar.to) };
                (bar.probability, before) = (below - before, below);
            }
        }
    }
}

/// Shares of an exact result.
pub fn shares(exact: &Exact) -> [Share; 2] {
    [Share::exactly(exact.collapse), Share::exactly(exact.undecided)]
}
