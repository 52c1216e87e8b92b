//! A quantity over an exact path, piece by piece, so closely that its zeros and extremes show.

use super::quantity::Value;
use super::route::{Route, Stretch};
use super::start::{PathError, ROUNDING};
use crate::model::quantity::Quantity;

/// A parabola stands for the function where it meets it at the quarters to this share of the largest value.
const FAITHFUL: f64 = 1e-4;
/// A straight line likewise: rounding of its values only.
const STRAIGHT: f64 = 1e-10;
/// A stretch is halved this often at most.
const HALVINGS: usize = 12;
/// How far from an end, as a share of the way to the next point, a turn close to it shows. What falls and rises again
/// within half of the least differs from the end by its square in a smooth function: by rounding.
const BESIDE: [f64; 4] = [0.25, 1e-2, 1e-4, 1e-6];

/// How far from a corner, as a share of the way, the straight lines that meet there are looked at.
const CORNER: [f64; 3] = [1e-3, 1e-5, 1e-7];

/// A quantity over one stretch.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The stretch.
    pub stretch: Stretch,
    /// What it does there.
    pub shape: Shape,
}

/// What a quantity does over a stretch.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// It has no value.
    Nothing,
    /// It is the same everywhere inside.
    Steady(Value),
    /// Places and values from the lower to the upper end: between neighbours it rises or falls.
    Curve(Vec<(f64, f64)>),
}

/// Whether a quantity is the same all over a working scheme.
fn is_steady(quantity: &Quantity) -> bool {
    match quantity {
        Quantity::Count(..) => true,
        Quantity::Probe(_, inner) | Quantity::Stage(_, inner) => is_steady(inner),
        quantity => quantity.is_word(),
    }
}

/// The quantity over all stretches of a path.
///
/// # Errors
/// Stopped from outside.
pub fn profile(route: &Route<'_>, quantity: &Quantity) -> Result<Vec<Piece>, PathError> {
    let piece = |stretch: &Stretch| {
        if route.watch().stop() {
            return Err(PathError::Interrupted);
        }
        let shape = if is_steady(quantity) {
            let middle = 0.5 * (stretch.from + stretch.to);
            route.value(stretch, middle, quantity).map_or(Shape::Nothing, Shape::Steady)
        } else {
            curve(route, stretch, quantity).map_or(Shape::Nothing, Shape::Curve)
        };
        Ok(Piece { stretch: *stretch, shape })
    };
    let parts: Vec<Stretch> = route.stretches.iter().flat_map(|stretch| route.parts(stretch, quantity)).collect();
    parts.iter().map(piece).collect()
}

/// The value as a number.
pub fn number(route: &Route<'_>, stretch: &Stretch, at: f64, quantity: &Quantity) -> Option<f64> {
    route.value(stretch, at, quantity).ok()?.number()
}

fn curve(route: &Route<'_>, stretch: &Stretch, quantity: &Quantity) -> Option<Vec<(f64, f64)>> {
    curve_of(&|at: f64| number(route, stretch, at, quantity), stretch)
}

/// Places and values of a smooth function over a stretch, so closely that between neighbours it rises or falls.
pub fn curve_of(value: &dyn Fn(f64) -> Option<f64>, stretch: &Stretch) -> Option<Vec<(f64, f64)>> {
    // At an end the value may be missing where it is there on the way: a resultant without force has no place.
    let inside = 1e-9 * (stretch.to - stretch.from);
    let end = |at: f64, beside: f64| Some((at, value(at).or_else(|| value(beside))?));
    let a = end(stretch.from, stretch.from + inside)?;
    let b = end(stretch.to, stretch.to - inside)?;
    let mut points = vec![a];
    refine(value, a, b, 0, &mut points)?;
    with_extremes(value, &mut points);
    Some(points)
}

/// Appends the points after `a` up to `b`.
fn refine(
    value: &dyn Fn(f64) -> Option<f64>,
    a: (f64, f64),
    b: (f64, f64),
    depth: usize,
    points: &mut Vec<(f64, f64)>,
) -> Option<()> {
    let place = |share: f64| a.0 + share * (b.0 - a.0);
    let at = |share: f64| Some((place(share), value(place(share))?));
    let (first, middle, last) = (at(0.25)?, at(0.5)?, at(0.75)?);
    let size = [a, first, middle, last, b].iter().fold(0.0, |size: f64, (_, f)| size.max(f.abs()));
    let line = |share: f64| a.1 + share * (b.1 - a.1);
    let off = |found: (f64, f64), expected: f64, share: f64| (found.1 - expected).abs() <= share * size;
    if [(first, 0.25), (middle, 0.5), (last, 0.75)].iter().all(|(p, share)| off(*p, line(*share), STRAIGHT)) {
        points.push(b);
        return Some(());
    }
    let parabola = [(3.0 * a.1 + 6.0 * middle.1 - b.1) / 8.0, (3.0 * b.1 + 6.0 * middle.1 - a.1) / 8.0];
    if depth == HALVINGS || (off(first, parabola[0], FAITHFUL) && off(last, parabola[1], FAITHFUL)) {
        points.extend([first, middle, last, b]);
        return Some(());
    }
    refine(value, a, middle, depth + 1, points)?;
    refine(value, middle, b, depth + 1, points)
}

/// Puts the places between where the function turns among the points.
fn with_extremes(value: &dyn Fn(f64) -> Option<f64>, points: &mut Vec<(f64, f64)>) {
    let size = points.iter().fold(0.0, |size: f64, (_, f)| size.max(f.abs()));
    let mut turns = Vec::new();
    let mut turn = |sign: f64, three: [(f64, f64); 3]| {
        let from_above = |x: f64| Some(sign * value(x)?);
        let x = vertex(value, three, size).or_else(|| peak(&from_above, [three[0].0, three[2].0]));
        turns.extend(x.and_then(|x| Some((x, value(x)?))));
    };
    for three in points.windows(3) {
        let [a, b, c] = [three[0], three[1], three[2]];
        if b.1 > a.1 && b.1 >= c.1 {
            turn(1.0, [a, b, c]);
        } else if b.1 < a.1 && b.1 <= c.1 {
            turn(-1.0, [a, b, c]);
        }
    }
    // No three points show a turn between an end and its neighbour: there it leaves the end away from the neighbour.
    if let [first, second, .., last_but_one, last] = points[..] {
        for [end, inner] in [[first, second], [last, last_but_one]] {
            let sign = if inner.1 >= end.1 { -1.0 } else { 1.0 };
            let beyond = |share: &f64| {
                let at = end.0 + share * (inner.0 - end.0);
                value(at).map(|f| (at, f)).filter(|(_, f)| sign * (f - end.1) > ROUNDING * size)
            };
            if let Some(beside) = BESIDE.iter().find_map(beyond) {
                let mut three = [end, beside, inner];
                three.sort_by(|a, b| a.0.total_cmp(&b.0));
                turn(sign, three);
            }
        }
    }
    points.extend(turns);
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.dedup_by(|a, b| a.0 == b.0);
}

/// Where the parabola through three points turns between the outer two, if it is the function: it tells the values at
/// the turn and at a place elsewhere to rounding.
fn vertex(value: &dyn Fn(f64) -> Option<f64>, [a, b, c]: [(f64, f64); 3], size: f64) -> Option<f64> {
    let first = (b.1 - a.1) / (b.0 - a.0);
    let second = ((c.1 - b.1) / (c.0 - b.0) - first) / (c.0 - a.0);
    let parabola = |x: f64| a.1 + (x - a.0) * (first + (x - b.0) * second);
    let at = 0.5 * (a.0 + b.0 - first / second);
    let inside = a.0 < at && at < c.0;
    let elsewhere = 0.5 * (at + if at - a.0 > c.0 - at { a.0 } else { c.0 });
    let meets = |x: f64| value(x).is_some_and(|f| (f - parabola(x)).abs() <= ROUNDING * size);
    (inside && meets(at) && meets(elsewhere)).then_some(at)
}

/// The place of the largest value between two: of a corner, where two straight lines meet, to rounding, and of what is round
/// as near as its values tell.
fn peak(value: &dyn Fn(f64) -> Option<f64>, [a, b]: [f64; 2]) -> Option<f64> {
    let mut best = summit(value, a, b)?;
    let mut height = value(best)?;
    for share in CORNER {
        let h = share * (b - a);
        let line = |side: f64| {
            let places = [best + side * h, best + 2.0 * side * h];
            let inside = places.iter().all(|x| (a..=b).contains(x));
            let [f, g] = if inside { [value(places[0])?, value(places[1])?] } else { return None };
            Some((places[0], f, (g - f) / (places[1] - places[0])))
        };
        let (Some((x, f, rise)), Some((y, g, fall))) = (line(-1.0), line(1.0)) else { continue };
        let at = x + (g - f - fall * (y - x)) / (rise - fall);
        if let Some(there) = Some(at).filter(|at| (x..=y).contains(at)).and_then(value)
            && there >= height
        {
            (best, height) = (at, there);
        }
    }
    Some(best)
}

/// The place of the largest value between two, by the golden section.
pub fn summit(value: &dyn Fn(f64) -> Option<f64>, mut a: f64, mut b: f64) -> Option<f64> {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut x, mut y) = (b - golden * (b - a), a + golden * (b - a));
    let (mut f, mut g) = (value(x)?, value(y)?);
    // Beyond √ε the values tell no difference.
    for _ in 0..40 {
        if f >= g {
            (b, y, g) = (y, x, f);
            x = b - golden * (b - a);
            f = value(x)?;
        } else {
            (a, x, f) = (x, y, g);
            y = a + golden * (b - a);
            g = value(y)?;
        }
    }
    Some(if f >= g { x } else { y })
}

/// The place between `a` and `b` where the function, of different signs there, is zero: by halving and secants, to the
/// last digits.
pub fn zero(value: &dyn Fn(f64) -> Option<f64>, mut a: (f64, f64), mut b: (f64, f64)) -> f64 {
    for round in 0..200 {
        if (b.0 - a.0).abs() <= 2.0 * f64::EPSILON * a.0.abs().max(b.0.abs()) {
            break;
        }
        let secant = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
        let inside = (secant - a.0) * (secant - b.0) < 0.0;
        let x = if round % 3 == 2 || !inside { 0.5 * (a.0 + b.0) } else { secant };
        if x == a.0 || x == b.0 {
            break;
        }
        let Some(f) = value(x) else { break };
        if f == 0.0 {
            return x;
        }
        if (f > 0.0) == (a.1 > 0.0) { a = (x, f) } else { b = (x, f) }
    }
    if a.1.abs() <= b.1.abs() { a.0 } else { b.0 }
}
