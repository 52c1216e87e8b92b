//! Slip, friction force, opening and pressure along the contact zone: joint by joint where there are several.

use std::io::{self, Write};

use super::Series;
use super::chart::{Chart, Curve, Line, Values};
use crate::answer::record::{PairState, Ray};
use crate::answer::rounding::{denoised, largest};
use crate::model::units::Units;
use crate::model::vector::distance;
use crate::view::style::Style;
use crate::view::{force_unit, length_unit, line_load_unit};

/// What is drawn over the contact zone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Slip z_τ.
    Slip,
    /// Friction force x_τ between its bounds ±(f x_n + c).
    Force,
    /// Opening z_n.
    Gap,
    /// Pressing force x_n.
    Pressure,
}

impl Quantity {
    /// What it is called; in space slip and friction are magnitudes.
    pub fn name(self, in_space: bool) -> &'static str {
        match (self, in_space) {
            (Quantity::Slip, false) => "Slip z_τ",
            (Quantity::Slip, true) => "Slip |z_τ|",
            (Quantity::Force, false) => "Friction force x_τ",
            (Quantity::Force, true) => "Friction force |x_τ|",
            (Quantity::Gap, _) => "Opening z_n",
            (Quantity::Pressure, _) => "Pressing force x_n",
        }
    }

    /// Its unit.
    pub fn unit(self, units: &Units) -> Option<String> {
        match self {
            Quantity::Slip | Quantity::Gap => length_unit(units),
            Quantity::Force | Quantity::Pressure => force_unit(units),
        }
    }
}

/// Largest share of the width that the spaces between the joints take.
const BETWEEN: f64 = 0.4;
/// The space between two joints where they are few, as a share of the length of all of them.
const GAP: f64 = 0.1;

/// Abscissas of the pairs.
#[derive(Clone, Debug, PartialEq)]
pub struct Zone {
    /// One per pair: the length along the pairs' positions from joint to joint, or the number of the pair.
    pub abscissas: Vec<f64>,
    /// Whether the abscissas are lengths.
    pub is_length: bool,
    /// The pairs of each joint.
    pub joints: Vec<Vec<usize>>,
    /// Abscissas in the middle between two joints.
    pub breaks: Vec<f64>,
}

/// Abscissas along the contact zone: in each joint the length of the way from pair to pair, in their order; the joints
/// stand one after the other, apart. Where a pair has no position, or all have the same, the numbers 1, 2 … serve.
pub fn zone(pairs: &[PairState]) -> Zone {
    let joints = joints(pairs);
    let place = |pair: usize| pairs[pair].position.unwrap_or_default();
    let lengths = |joint: &[usize]| {
        let mut at = 0.0;
        let steps = joint.windows(2).map(|ends| {
            let [a, b] = [place(ends[0]), place(ends[1])];
            at += distance(a, b);
            at
        });
        [0.0].into_iter().chain(steps.collect::<Vec<_>>()).collect::<Vec<f64>>()
    };
    let along: Vec<Vec<f64>> = joints.iter().map(|joint| lengths(joint)).collect();
    let total: f64 = along.iter().filter_map(|lengths| lengths.last()).sum();
    let is_length = pairs.iter().all(|pair| pair.position.is_some())
        && total.is_finite()
        && (total > 0.0 || pairs.len() == 1 || joints.len() > 1);
    if !is_length {
        let abscissas = (1..=pairs.len()).map(|number| number as f64).collect();
        return Zone { abscissas, is_length, joints: vec![(0..pairs.len()).collect()], breaks: Vec::new() };
    }
    let size = if total > 0.0 { total } else { 1.0 };
    let between = joints.len().saturating_sub(1).max(1) as f64;
    let gap = size * f64::min(GAP, BETWEEN / (1.0 - BETWEEN) / between);
    let (mut abscissas, mut breaks) = (vec![0.0; pairs.len()], Vec::new());
    let mut from = 0.0;
    for (number, (joint, lengths)) in joints.iter().zip(&along).enumerate() {
        if number > 0 {
            breaks.push(from + 0.5 * gap);
            from += gap;
        }
        for (&pair, length) in joint.iter().zip(lengths) {
            abscissas[pair] = from + length;
        }
        from += lengths.last().copied().unwrap_or_default();
    }
    Zone { abscissas, is_length, joints, breaks }
}

/// The pairs of each joint, in the order of their first ones.
fn joints(pairs: &[PairState]) -> Vec<Vec<usize>> {
    let mut joints: Vec<(usize, Vec<usize>)> = Vec::new();
    for (index, pair) in pairs.iter().enumerate() {
        match joints.iter_mut().find(|(joint, _)| *joint == pair.joint) {
            Some((_, pairs)) => pairs.push(index),
            None => joints.push((pair.joint, vec![index])),
        }
    }
    joints.into_iter().map(|(_, pairs)| pairs).collect()
}

/// A series for each joint, the first one named.
fn over_zone(label: &str, pairs: &[PairState], value: impl Fn(&PairState) -> f64) -> Vec<Series> {
    let zone = zone(pairs);
    let points = |joint: &Vec<usize>| joint.iter().map(|&pair| (zone.abscissas[pair], value(&pairs[pair]))).collect();
    let name = |number: usize| if number == 0 { label.to_owned() } else { String::new() };
    zone.joints.iter().enumerate().map(|(k, joint)| Series { label: name(k), points: points(joint) }).collect()
}

/// Slip z_τ over the zone.
pub fn slip_series(label: &str, pairs: &[PairState]) -> Vec<Series> {
    let scale = largest(pairs.iter().flat_map(|pair| [pair.z_t, pair.z_n]));
    over_zone(label, pairs, |pair| denoised(pair.z_t, scale))
}

/// Opening z_n over the zone.
pub fn gap_series(label: &str, pairs: &[PairState]) -> Vec<Series> {
    let scale = largest(pairs.iter().flat_map(|pair| [pair.z_t, pair.z_n]));
    over_zone(label, pairs, |pair| denoised(pair.z_n, scale))
}

/// Pressing force x_n over the zone.
pub fn pressure_series(label: &str, pairs: &[PairState]) -> Vec<Series> {
    let scale = largest(pairs.iter().flat_map(|pair| [pair.x_t, pair.x_n]));
    over_zone(label, pairs, |pair| denoised(pair.x_n, scale))
}

/// Friction force x_τ, upper bound + r_f and lower bound − r_f over the zone.
pub fn force_series(label: &str, pairs: &[PairState]) -> [Vec<Series>; 3] {
    let scale = largest(pairs.iter().flat_map(|pair| [pair.x_t, pair.x_n]));
    [
        over_zone(label, pairs, |pair| denoised(pair.x_t, scale)),
        over_zone("", pairs, |pair| denoised(pair.bound, scale)),
        over_zone("", pairs, |pair| denoised(-pair.bound, scale)),
    ]
}

/// Draws `quantity` for one or several states of the same pairs, `height` rows high.
pub fn write(
    out: &mut dyn Write,
    quantity: Quantity,
    states: &[(&str, &[PairState])],
    units: &Units,
    height: usize,
    style: &Style,
) -> io::Result<()> {
    Chart { height, ..drawing(quantity, states, units) }.write(out, style)
}

/// The chart of `quantity` for one or several states of the same pairs.
pub fn drawing(quantity: Quantity, states: &[(&str, &[PairState])], units: &Units) -> Chart {
    let in_space = states.iter().any(|(_, pairs)| pairs.iter().any(|pair| pair.space.is_some()));
    // a magnitude has one bound
    let [force_word, bound] = if in_space { ["|x_τ|", "f x_n + c"] } else { ["x_τ", "±(f x_n + c)"] };
    let name = match quantity {
        Quantity::Force => format!("{} and its bound {bound}", quantity.name(in_space)),
        _ => quantity.name(in_space).to_owned(),
    };
    let mut curves = Vec::new();
    let several = states.len() > 1;
    for (number, (label, pairs)) in states.iter().enumerate() {
        let mut push = |series: Vec<Series>, line: Line| {
            curves.extend(series.into_iter().map(|series| Curve { series, number, line }));
        };
        let named = |single: &str| {
            if several { (*label).to_owned() } else { single.to_owned() }
        };
        match quantity {
            Quantity::Slip => push(slip_series(&named(""), pairs), Line::Marked),
            Quantity::Gap => push(gap_series(&named(""), pairs), Line::Marked),
            Quantity::Pressure => push(pressure_series(&named(""), pairs), Line::Marked),
            Quantity::Force => {
                let [force, mut plus, minus] = force_series(&named(force_word), pairs);
                if let Some(first) = plus.first_mut() {
                    first.label = if several { format!("{label}: bound") } else { bound.to_owned() };
                }
                push(plus, Line::Dotted);
                if !in_space {
                    push(minus, Line::Dotted);
                }
                push(force, Line::Marked);
            }
        }
    }
    over_states(&name, quantity.unit(units), curves, states, units)
}

/// The chart of x_n and x_τ per length of edge, for states of pairs that all lie on edges; `lengths` are those of the
/// pairs.
pub fn traction(states: &[(&str, &[PairState])], lengths: &[f64], units: &Units) -> Chart {
    let spread = |pairs: &[PairState]| -> Vec<PairState> {
        let over = |(pair, length): (&PairState, &f64)| {
            let (x_n, x_t, bound) = (pair.x_n / length, pair.x_t / length, pair.bound / length);
            PairState { x_n, x_t, bound, ..pair.clone() }
        };
        pairs.iter().zip(lengths).map(over).collect()
    };
    let friction = states.iter().any(|(_, pairs)| pairs.iter().any(|pair| pair.law.has_tangential_joint()));
    let mut curves = Vec::new();
    let mut push = |series: Vec<Series>| {
        let number = curves.last().map_or(0, |curve: &Curve| curve.number + 1);
        curves.extend(series.into_iter().map(|series| Curve { series, number, line: Line::Marked }));
    };
    for (label, pairs) in states {
        let pairs = spread(pairs);
        let named = |word: &str| if states.len() > 1 { format!("{label}: {word}") } else { word.to_owned() };
        push(pressure_series(&named("normal, x_n/a"), &pairs));
        if friction {
            let [force, ..] = force_series(&named("tangential, x_τ/a"), &pairs);
            push(force);
        }
    }
    over_states("Contact traction, force per length a of the edge", line_load_unit(units), curves, states, units)
}

/// The chart of `curves`, those of `states`; a single state is named in its title, several in the legend.
fn over_states(
    name: &str,
    ordinate: Option<String>,
    curves: Vec<Curve>,
    states: &[(&str, &[PairState])],
    units: &Units,
) -> Chart {
    let pairs = states.first().map_or(&[][..], |(_, pairs)| pairs);
    let mut chart = Chart { ordinate, ..chart(name, curves, pairs, units) };
    if let [(label, _)] = states
        && !label.is_empty()
    {
        chart.about = format!(" · {label}");
    }
    chart
}

/// Draws the direction of a ray, z̄_n and z̄_τ (largest 1), over the zone of `pairs`.
pub fn mode(
    out: &mut dyn Write,
    ray: &Ray,
    pairs: &[PairState],
    units: &Units,
    height: usize,
    style: &Style,
) -> io::Result<()> {
    let along = |label: &str, value: fn(&crate::answer::record::PairDirection) -> f64| {
        over_zone(label, pairs, |pair| {
            let direction = ray.direction.pairs().iter().find(|d| d.pair == pair.id);
            direction.map_or(0.0, |d| denoised(value(d), 1.0))
        })
    };
    let curves = [along("z̄_n", |d| d.z_n), along("z̄_τ", |d| d.z_t.scalar())]
        .into_iter()
        .enumerate()
        .flat_map(|(number, series)| series.into_iter().map(move |series| (number, series)))
        .map(|(number, series)| Curve { series, number, line: Line::Marked })
        .collect();
    let title = format!("Direction of the ray: {}", ray.mode);
    Chart { height, ..chart(&title, curves, pairs, units) }.write(out, style)
}

fn chart(name: &str, curves: Vec<Curve>, pairs: &[PairState], units: &Units) -> Chart {
    let zone = zone(pairs);
    let mut names: Vec<(f64, String)> =
        zone.abscissas.iter().copied().zip(pairs.iter().map(|pair| pair.id.clone())).collect();
    names.sort_by(|a, b| a.0.total_cmp(&b.0));
    let several = zone.joints.len() > 1;
    let ends = zone.joints.iter().filter(|joint| joint.len() > 1).flat_map(|joint| {
        let [from, to] = [joint[0], joint[joint.len() - 1]].map(|pair| zone.abscissas[pair]);
        [(from, 0.0), (to, to - from)]
    });
    Chart {
        title: name.to_owned(),
        curves,
        names,
        values: match (zone.is_length, several) {
            (false, _) => Values::None,
            (true, false) => Values::Lengths,
            (true, true) => Values::Pieces(ends.collect()),
        },
        breaks: zone.breaks,
        abscissa: if several {
            format!("along each of {} joints", zone.joints.len())
        } else {
            "along the contact zone".into()
        },
        unit: length_unit(units),
        ..Chart::default()
    }
}
