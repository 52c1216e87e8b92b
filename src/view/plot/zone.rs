//! Slip, friction force, opening and pressure along the contact zone.

use std::io::{self, Write};

use super::Series;
use super::chart::{Chart, Curve, Line};
use crate::answer::record::{PairState, Ray};
use crate::model::scenario::Units;
use crate::view::number::{denoised, largest};
use crate::view::style::Style;
use crate::view::{force_unit, length_unit};

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

/// Abscissas of the pairs.
#[derive(Clone, Debug, PartialEq)]
pub struct Zone {
    /// One per pair: the length along the pairs' positions, or the number of the pair.
    pub abscissas: Vec<f64>,
    /// Whether the abscissas are lengths.
    pub is_length: bool,
}

/// Abscissas along the contact zone: the length of the way from pair to pair, in their order. Where a pair has no
/// position, or all have the same, the numbers 1, 2 … serve.
pub fn zone(pairs: &[PairState]) -> Zone {
    let mut at = 0.0;
    let mut abscissas = Vec::with_capacity(pairs.len());
    let mut before: Option<[f64; 2]> = None;
    for pair in pairs {
        let Some(position) = pair.position else {
            break;
        };
        if let Some(before) = before {
            at += (position[0] - before[0]).hypot(position[1] - before[1]);
        }
        abscissas.push(at);
        before = Some(position);
    }
    let usable = abscissas.len() == pairs.len() && at.is_finite() && (at > 0.0 || pairs.len() == 1);
    if usable {
        Zone { abscissas, is_length: true }
    } else {
        Zone { abscissas: (1..=pairs.len()).map(|number| number as f64).collect(), is_length: false }
    }
}

fn over_zone(label: &str, pairs: &[PairState], value: impl Fn(&PairState) -> f64) -> Series {
    Series { label: label.to_owned(), points: zone(pairs).abscissas.into_iter().zip(pairs.iter().map(value)).collect() }
}

/// Slip z_τ over the zone.
pub fn slip_series(label: &str, pairs: &[PairState]) -> Series {
    let scale = largest(pairs.iter().flat_map(|pair| [pair.z_t, pair.z_n]));
    over_zone(label, pairs, |pair| denoised(pair.z_t, scale))
}

/// Opening z_n over the zone.
pub fn gap_series(label: &str, pairs: &[PairState]) -> Series {
    let scale = largest(pairs.iter().flat_map(|pair| [pair.z_t, pair.z_n]));
    over_zone(label, pairs, |pair| denoised(pair.z_n, scale))
}

/// Pressing force x_n over the zone.
pub fn pressure_series(label: &str, pairs: &[PairState]) -> Series {
    let scale = largest(pairs.iter().flat_map(|pair| [pair.x_t, pair.x_n]));
    over_zone(label, pairs, |pair| denoised(pair.x_n, scale))
}

/// Friction force x_τ, upper bound + r_f and lower bound − r_f over the zone.
pub fn force_series(label: &str, pairs: &[PairState]) -> [Series; 3] {
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
    let (name, unit) = match quantity {
        Quantity::Slip => ("Slip z_τ", length_unit(units)),
        Quantity::Force => ("Friction force x_τ and its bound ±(f x_n + c)", force_unit(units)),
        Quantity::Gap => ("Opening z_n", length_unit(units)),
        Quantity::Pressure => ("Pressing force x_n", force_unit(units)),
    };
    let mut curves = Vec::new();
    let several = states.len() > 1;
    for (number, (label, pairs)) in states.iter().enumerate() {
        let mut push = |series: Series, line: Line| {
            curves.push(Curve { series, number, line });
        };
        let named = |single: &str| {
            if several { (*label).to_owned() } else { single.to_owned() }
        };
        match quantity {
            Quantity::Slip => push(slip_series(&named(""), pairs), Line::Marked),
            Quantity::Gap => push(gap_series(&named(""), pairs), Line::Marked),
            Quantity::Pressure => push(pressure_series(&named(""), pairs), Line::Marked),
            Quantity::Force => {
                let [force, mut plus, minus] = force_series(&named("x_τ"), pairs);
                plus.label = if several { format!("{label}: bound") } else { "±(f x_n + c)".into() };
                push(plus, Line::Dotted);
                push(minus, Line::Dotted);
                push(force, Line::Marked);
            }
        }
    }
    let pairs = states.first().map_or(&[][..], |(_, pairs)| pairs);
    let mut chart = chart(name, unit, curves, pairs, units);
    // A single state is named in the title, several in the legend.
    if let [(label, _)] = states
        && !label.is_empty()
    {
        chart.title.push_str(&format!(" · {label}"));
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
    let curves = [along("z̄_n", |d| d.z_n), along("z̄_τ", |d| d.z_t)]
        .into_iter()
        .enumerate()
        .map(|(number, series)| Curve { series, number, line: Line::Marked })
        .collect();
    let title = format!("Direction of the ray: {}", ray.mode);
    Chart { height, ..chart(&title, None, curves, pairs, units) }.write(out, style)
}

fn chart(name: &str, unit: Option<String>, curves: Vec<Curve>, pairs: &[PairState], units: &Units) -> Chart {
    let title = match unit {
        Some(unit) => format!("{name} [{unit}]"),
        None => name.to_owned(),
    };
    let zone = zone(pairs);
    let ids = pairs.iter().map(|pair| pair.id.clone());
    Chart {
        title,
        curves,
        names: zone.abscissas.iter().copied().zip(ids).collect(),
        values: zone.is_length,
        abscissa: "along the contact zone".into(),
        unit: length_unit(units),
        ..Chart::default()
    }
}
