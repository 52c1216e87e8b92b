//! Load paths, friction paths and limits in words.

use std::io::{self, Write};

use super::length_unit;
use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use crate::answer::record::{PairState, Verdict};
use crate::answer::rounding::largest;
use crate::model::units::Units;
use crate::path::change::Breakpoint;
use crate::path::end::PathEnd;
use crate::path::friction::FrictionPath;
use crate::path::limit::Limit;
use crate::path::load::LoadPath;
use crate::path::on_cone::ConePath;
use crate::text::number::{short, with_unit};

/// A breakpoint with the digits it has been found to: ten, without trailing zeros.
pub fn exact(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return short(value);
    }
    let exponent = value.abs().log10().floor();
    if !(-5.0..10.0).contains(&exponent) {
        return format!("{value:.9e}");
    }
    // Between 0 and 14 by the range above.
    let decimals = (9.0 - exponent) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn max_slip(pairs: &[PairState]) -> f64 {
    largest(pairs.iter().map(PairState::slip_size))
}

fn breakpoints(
    out: &mut dyn Write,
    name: &str,
    rows: &[(f64, String, Option<f64>)],
    units: &Units,
    style: &Style,
) -> io::Result<()> {
    let mut table = Table::new(vec![
        Column::given(name, None),
        Column::numbers("max slip", length_unit(units)).droppable(1),
        Column::words("change"),
    ]);
    for (value, sentence, slip) in rows {
        table.rows.push(Row::new(vec![Cell::number(*value), Cell::maybe(*slip), Cell::from(style.text(sentence))]));
    }
    table.write(out, style)
}

fn role_of(end: &PathEnd) -> Role {
    match end {
        PathEnd::Target | PathEnd::Unbounded => Role::Muted,
        PathEnd::Turning
        | PathEnd::Limit(_)
        | PathEnd::AnswerBeyond(_)
        | PathEnd::Collapse(_)
        | PathEnd::Returned
        | PathEnd::NoAnswer => Role::Warning,
    }
}

/// A path from its start: where that is, its breakpoints with the pairs there and what is said of a jump, and its end.
struct FromStart<'a> {
    name: &'a str,
    start: f64,
    /// Why it starts from 0, where it does.
    from_zero: Option<&'static str>,
    breakpoints: &'a [Breakpoint],
    pairs_at: &'a dyn Fn(usize) -> &'a [PairState],
    jump: &'static str,
    end: (&'a PathEnd, String),
}

impl FromStart<'_> {
    fn write(&self, out: &mut dyn Write, units: &Units, style: &Style) -> io::Result<()> {
        let name = self.name;
        if let Some(why) = self.from_zero {
            let text = format!("{why}: the path starts from {name} = 0");
            style.paragraph(out, Role::Muted, &text)?;
        }
        if self.breakpoints.is_empty() {
            let text = format!("no breakpoints from {name} = {}", exact(self.start));
            style.paragraph(out, Role::Plain, &text)?;
        } else {
            let row = |at: &Breakpoint| {
                let jump = if at.jump { self.jump } else { "" };
                (at.value, format!("{}{jump}", at.sentence), Some(max_slip((self.pairs_at)(at.place))))
            };
            let rows: Vec<_> = self.breakpoints.iter().map(row).collect();
            breakpoints(out, name, &rows, units, style)?;
        }
        let (end, sentence) = &self.end;
        style.paragraph(out, role_of(end), sentence)
    }
}

/// Writes the breakpoints of a load path and how it ended.
pub fn write_load(out: &mut dyn Write, path: &LoadPath, units: &Units, style: &Style) -> io::Result<()> {
    let way = FromStart {
        name: &path.parameter.name,
        start: path.start,
        from_zero: path.from_zero.then_some(match path.is_present_off_paths {
            true => "no pivots lead on from the answer at the present load",
            false => "no answer was found at the present load",
        }),
        breakpoints: &path.breakpoints,
        pairs_at: &|place| &path.pairs[place],
        jump: " (after moving at constant load)",
        end: (&path.end, path.end_sentence()),
    };
    way.write(out, units, style)
}

/// Writes the breakpoints of a path in space and how it ended.
pub fn write_on_cone(out: &mut dyn Write, path: &ConePath, units: &Units, style: &Style) -> io::Result<()> {
    let way = FromStart {
        name: &path.name,
        start: path.start,
        from_zero: path.from_zero.then_some(match path.is_present_off_paths {
            true => "no steps lead on from the answer at the present load",
            false => "no answer on Coulomb's cone was found at the present load",
        }),
        breakpoints: &path.breakpoints,
        pairs_at: &|place| &path.places[place].pairs,
        jump: " (a jump to another answer)",
        end: (&path.end, path.end_sentence()),
    };
    way.write(out, units, style)?;
    let steps = format!(
        "followed on Coulomb's cone in {} steps, each an answer that passed its check; that nothing else happens within a \
         step is not proved",
        path.places.len()
    );
    style.paragraph(out, Role::Muted, &steps)
}

/// Writes the breakpoints of a friction path, its intervals and how it ended.
pub fn write_friction(out: &mut dyn Write, path: &FrictionPath, units: &Units, style: &Style) -> io::Result<()> {
    if path.breakpoints.is_empty()
        && let Some(only) = path.intervals.first()
    {
        let text =
            format!("one scheme from {} = {} to {}: nothing changes", path.name, exact(only.from), exact(only.to));
        style.paragraph(out, Role::Plain, &text)?;
    } else {
        let rows: Vec<_> = path
            .breakpoints
            .iter()
            .map(|breakpoint| {
                let jump = if breakpoint.jump {
                    " - a jump: there are several answers here, and the one followed ends"
                } else {
                    ""
                };
                let slip = max_slip(&path.samples[breakpoint.place].1);
                (breakpoint.value, format!("{}{jump}", breakpoint.sentence), Some(slip))
            })
            .collect();
        breakpoints(out, &path.name, &rows, units, style)?;
    }
    style.paragraph(out, role_of(&path.end), &path.end_sentence())
}

/// Writes the limit load, the safety and the collapse.
pub fn write_limit(out: &mut dyn Write, limit: &Limit, unit: Option<&str>, style: &Style) -> io::Result<()> {
    let name = &limit.name;
    let Some(factor) = limit.factor else {
        let text = match limit.bracket {
            Some([answer, none]) if limit.is_bracketed() => {
                let (low, high) = (exact(answer.min(none)), exact(answer.max(none)));
                format!("the limit lies between {name} = {low} and {high}: {}", limit.end_sentence())
            }
            _ => format!("no limit was found: {}", limit.end_sentence()),
        };
        return style.paragraph(out, Role::Plain, &text);
    };
    let safety = match limit.safety {
        Some(safety) => format!(", {} times the present {}", exact(safety), with_unit(&short(limit.present), unit)),
        None => format!(" (present {})", with_unit(&short(limit.present), unit)),
    };
    let text = format!("limit load: {name} = {}{safety}", with_unit(&exact(factor), unit));
    style.paragraph(out, Role::Title, &text)?;
    if let Some(collapse) = limit.collapse() {
        let class = collapse.class.word();
        let verdict = collapse.verdict.map_or(String::new(), |verdict| format!(", {}", verdict.word()));
        style.paragraph(out, Role::Warning, &format!("collapse ({class}{verdict}): {}", collapse.mode))?;
        if let Some(beyond) =
            limit.beyond_sentence().filter(|_| collapse.verdict != Some(Verdict::Certified) || collapse.of_this_load)
        {
            style.paragraph(out, Role::Muted, &beyond)?;
        }
    }
    if factor == 0.0 {
        return Ok(());
    }
    style.paragraph(out, Role::Muted, &limit.confirmation())
}
