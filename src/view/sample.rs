//! The probability of collapse, and how quantities are spread.

use std::io::{self, Write};

use super::style::{Role, Style, pad_left, pad_right};
use super::table::{Cell, Column, Row, Table};
use crate::path::sample::Sampled;
use crate::path::sample::statistics::Spread;
use crate::text::number::short;

/// Longest bar of a histogram.
const LONGEST: usize = 40;
/// Share of the largest value of a quantity below which a value is the rounding of its terms.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Probabilities, a table of the quantities, their histograms.
///
/// # Errors
/// Those of `out`.
pub fn write(out: &mut dyn Write, found: &Sampled, style: &Style) -> io::Result<()> {
    let collapse = share(found.collapse, found.standard_error, found.exact, style);
    style.paragraph(out, Role::Accent, &format!("probability of collapse {collapse}"))?;
    if let Some(below) = found.below {
        style.paragraph(
            out,
            Role::Plain,
            &format!("none was drawn: less than {} with 95 % confidence", short(below)),
        )?;
    }
    if found.undecided > 0.0 {
        let undecided = share(found.undecided, found.undecided_error, found.exact, style);
        let line = format!("undecided {undecided}: neither an answer nor a proof that there is none");
        style.paragraph(out, Role::Warning, &line)?;
    }
    style.paragraph(out, Role::Plain, &found.parameters.join("  "))?;
    if found.draws > 0 {
        let counted = found.collapses.map_or(String::new(), |count| format!(", {count} of them collapses"));
        let drawn = format!("{} points drawn{counted}; seed {}", found.draws, found.seed);
        style.paragraph(out, Role::Plain, &drawn)?;
    }
    for note in &found.notes {
        style.paragraph(out, Role::Muted, note)?;
    }
    quantiles(out, &found.quantities, style)?;
    found.quantities.iter().try_for_each(|spread| histogram(out, spread, style))
}

fn share(probability: f64, error: f64, exact: bool, style: &Style) -> String {
    if exact {
        return format!("{} (exact)", short(probability));
    }
    let sign = if style.ascii { "+-" } else { "±" };
    format!("{} {sign} {} (standard error)", short(probability), short(error))
}

/// A row for each quantity that is a number.
fn quantiles(out: &mut dyn Write, spreads: &[Spread], style: &Style) -> io::Result<()> {
    let numbers: Vec<&Spread> = spreads.iter().filter(|spread| spread.mean.is_some()).collect();
    let Some(first) = numbers.first() else { return Ok(()) };
    let mut columns = vec![Column::words("quantity"), Column::words("unit")];
    columns.extend(["mean", "deviation", "least"].map(|head| Column::plain(head, None)));
    columns.extend(first.quantiles.iter().map(|(p, _)| Column::plain(&format!("{} %", short(100.0 * p)), None)));
    columns.push(Column::plain("most", None));
    let mut table = Table::new(columns);
    for spread in numbers {
        let mut cells = vec![Cell::from(spread.quantity.as_str()), Cell::from(spread.unit.as_deref().unwrap_or(""))];
        // What is left of a sum of values of this size is its rounding.
        let size = spread.least.into_iter().chain(spread.most).fold(0.0, |size: f64, end| size.max(end.abs()));
        let number = |value: f64| short(if value.abs() > ROUNDING * size { value } else { 0.0 });
        let some = |value: Option<f64>| Cell::new(value.map(number).unwrap_or_default(), Role::Plain);
        cells.extend([spread.mean, spread.deviation, spread.least].map(some));
        cells.extend(spread.quantiles.iter().map(|(_, value)| some(Some(*value))));
        cells.push(some(spread.most));
        table.rows.push(Row::new(cells));
    }
    writeln!(out)?;
    table.write(out, style)
}

fn histogram(out: &mut dyn Write, spread: &Spread, style: &Style) -> io::Result<()> {
    let bars = spread.histogram.iter().map(|bar| (format!("{} … {}", short(bar.from), short(bar.to)), bar.probability));
    let words = spread.words.iter().map(|(word, share)| (word.clone(), *share));
    let rows: Vec<(String, f64)> = bars.chain(words).collect();
    if rows.is_empty() {
        return Ok(());
    }
    let unit = spread.unit.as_ref().map_or(String::new(), |unit| format!(", {unit}"));
    let known =
        if spread.known < 1.0 { format!(" (known with probability {})", short(spread.known)) } else { String::new() };
    writeln!(out)?;
    writeln!(out, "{}", style.text(&format!("{}{unit}{known}", spread.quantity)))?;
    let label = |text: &str| if style.ascii { text.replace('…', "..") } else { text.to_owned() };
    let width = rows.iter().map(|(text, _)| label(text).chars().count()).max().unwrap_or(0);
    let most = rows.iter().map(|(_, share)| *share).fold(0.0, f64::max);
    let length = LONGEST.min(style.width.saturating_sub(width + 14)).max(1);
    let full = if style.ascii { "#" } else { "█" };
    for (text, share) in &rows {
        let bar = full.repeat((share / most * length as f64).round() as usize);
        let line = format!("  {}  {}  {bar}", pad_right(&label(text), width), pad_left(&short(*share), 8));
        writeln!(out, "{}", line.trim_end())?;
    }
    Ok(())
}
