//! Slip or force of chosen pairs over the load or friction, breakpoints marked; hysteresis loops of a history.

use super::Series;
use super::chart::{Chart, Curve, Line, Values};
use super::zone::Quantity;
use crate::answer::record::PairState;
use crate::answer::rounding::{denoised, largest};
use crate::model::units::Units;
use crate::path::quantity::OnPath;
use crate::path::record::{Followed, PathRecord};
use crate::view::{force_unit, length_unit};

fn read(quantity: Quantity, pair: &PairState) -> f64 {
    match quantity {
        Quantity::Slip => pair.z_t,
        Quantity::Gap => pair.z_n,
        Quantity::Force => pair.x_t,
        Quantity::Pressure => pair.x_n,
    }
}

/// The curve of one pair and its breakpoints; `case` is the load case of the abscissa of a history.
pub fn series(path: &PathRecord, quantity: Quantity, pair: usize, case: Option<usize>) -> [Series; 2] {
    let abscissas = path.abscissas(case);
    let scale = largest(path.places.iter().flat_map(|place| place.pairs.iter().map(|pair| read(quantity, pair))));
    let points: Vec<(f64, f64)> = abscissas
        .iter()
        .zip(&path.places)
        .filter_map(|(x, place)| {
            let state = place.pairs.get(pair)?;
            Some((*x, denoised(read(quantity, state), scale)))
        })
        .collect();
    let marked = points
        .iter()
        .zip(&path.places)
        .filter(|(_, place)| !place.change.is_empty())
        .map(|(point, _)| *point)
        .collect();
    let label =
        path.places.first().and_then(|place| place.pairs.get(pair)).map_or(String::new(), |pair| pair.id.clone());
    [Series { label: label.clone(), points }, Series { label, points: marked }]
}

/// What a picture of the path goes over: of a history the factor of the case that is chosen, else of the one that goes to
/// and fro most; otherwise what was followed. And its name.
fn abscissa(path: &PathRecord, chosen: Option<usize>) -> (Option<usize>, String) {
    let case = match path.followed {
        Followed::Stages => chosen.or_else(|| path.busiest_case()),
        _ => None,
    };
    let over = match case {
        Some(case) => format!("the factor of {}", path.cases[case]),
        None => path.name.clone(),
    };
    (case, over)
}

/// The chart of a quantity of the pairs (indices) over what was followed; of a history over the factor of a case.
pub fn drawing(path: &PathRecord, quantity: Quantity, pairs: &[usize], over: Option<usize>, units: &Units) -> Chart {
    let (case, over) = abscissa(path, over);
    let (what, unit) = match quantity {
        Quantity::Slip => ("slip z_τ", length_unit(units)),
        Quantity::Gap => ("gap z_n", length_unit(units)),
        Quantity::Force => ("force x_τ", force_unit(units)),
        Quantity::Pressure => ("force x_n", force_unit(units)),
    };
    let mut curves = Vec::new();
    for (number, &pair) in pairs.iter().enumerate() {
        let [mut curve, marked] = series(path, quantity, pair, case);
        // One entry of the legend for both.
        curve.label.clear();
        curves.push(Curve { series: curve, number, line: Line::Plain });
        curves.push(Curve { series: marked, number, line: Line::Points });
    }
    Chart {
        title: format!("{what} over {over}, breakpoints marked"),
        ordinate: unit,
        curves,
        values: Values::Typed,
        abscissa: over,
        ..Chart::default()
    }
}

/// The chart of quantities, likewise.
pub fn drawing_along(path: &PathRecord, along: &[OnPath], over: Option<usize>, units: &Units) -> Chart {
    let (case, over) = abscissa(path, over);
    let abscissas = path.abscissas(case);
    let mut curves = Vec::new();
    for (number, (quantity, values)) in along.iter().enumerate() {
        let points = || abscissas.iter().zip(values).zip(&path.places).filter_map(|((x, y), at)| Some((*x, (*y)?, at)));
        let label = quantity.to_string();
        let curve = Series { label: String::new(), points: points().map(|(x, y, _)| (x, y)).collect() };
        let marked = points().filter(|(_, _, at)| !at.change.is_empty()).map(|(x, y, _)| (x, y)).collect();
        curves.push(Curve { series: curve, number, line: Line::Plain });
        curves.push(Curve { series: Series { label, points: marked }, number, line: Line::Points });
    }
    let unit = along.first().and_then(|(quantity, _)| quantity.unit(units));
    let unit = unit.filter(|unit| along.iter().all(|(quantity, _)| quantity.unit(units).as_ref() == Some(unit)));
    let names: Vec<String> = along.iter().map(|(quantity, _)| quantity.to_string()).collect();
    Chart {
        title: format!("{} over {over}, breakpoints marked", names.join(", ")),
        ordinate: unit,
        curves,
        values: Values::Typed,
        abscissa: over,
        ..Chart::default()
    }
}
