//! A load history in tables: the stages, and the way through one of them.

use std::io::{self, Write};

use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use super::{length_unit, moment_unit};
use crate::answer::record::OutcomeKind;
use crate::answer::rounding::{denoised, largest};
use crate::model::units::Units;
use crate::path::stages::{History, HistoryEnd};
use crate::text::number::{residual, short};

/// Writes a row per stage: its factors, pivots, changes, largest slip and slip increment, energy.
pub fn write(out: &mut dyn Write, history: &History, units: &Units, style: &Style) -> io::Result<()> {
    table(history, units).write(out, style)?;
    let role = match history.end {
        HistoryEnd::Complete => Role::Muted,
        HistoryEnd::Limit { .. } => Role::Warning,
        HistoryEnd::Broken(_) => Role::Bad,
    };
    style.paragraph(out, role, &history.end_sentence())?;
    if let Some(error) = history.stages.last().and_then(|stage| stage.estimated_error) {
        let right = match error {
            error if error < 1e-14 => "rounding".to_owned(),
            error => format!("about {} of the largest", residual(error)),
        };
        let text = format!(
            "followed on Coulomb's cone, where directions of slip can turn on the way: displacements are right to {right}"
        );
        style.paragraph(out, Role::Muted, &text)?;
    }
    if let Some(text) = history.rest_sentence() {
        style.paragraph(out, Role::Warning, &text)?;
    }
    for (index, stage) in history.stages.iter().enumerate() {
        for moment in stage.moments.iter().filter(|moment| moment.jump) {
            let balance = match stage.energy.is_some_and(|energy| !energy.is_balanced()) {
                true => "what its energy balance leaves over goes into motion there",
                false => "what is lost there is part of what the stage dissipates",
            };
            let text = format!("stage {}: the structure jumps at {} of it; {balance}", index + 1, short(moment.t));
            style.paragraph(out, Role::Warning, &text)?;
        }
        if let Some(failure) = stage.end.failure.as_ref().filter(|_| stage.end.outcome == OutcomeKind::CheckFailed) {
            style.paragraph(out, Role::Bad, &format!("stage {}: {failure}", index + 1))?;
        }
    }
    Ok(())
}

/// The table that is written.
pub fn table(history: &History, units: &Units) -> Table {
    let mut columns = vec![Column::count("stage")];
    columns.extend(history.cases.iter().map(|case| Column::given(case, None)));
    columns.extend([
        Column::count("pivots").droppable(4),
        Column::count("changes").droppable(3),
        Column::numbers("max slip", length_unit(units)).of(1),
        Column::numbers("max Δslip", length_unit(units)).of(1).droppable(2),
        Column::numbers("dissipated", moment_unit(units)).droppable(1),
        Column::words("balance").droppable(5),
    ]);
    let mut table = Table::new(columns);
    let slips = largest(history.stages.iter().map(|stage| stage.max_slip()));
    // Rounding beside the work of the loads is not dissipation.
    let energies = largest(history.stages.iter().flat_map(|stage| {
        let energy = stage.energy.unwrap_or_default();
        [stage.dissipated, energy.work, energy.stored]
    }));
    for (index, stage) in history.stages.iter().enumerate() {
        let Some(end) = stage.moments.last() else {
            continue;
        };
        let mut cells = vec![Cell::from((index + 1).to_string())];
        cells.extend(end.factors.iter().map(|factor| Cell::number(*factor)));
        cells.extend([
            Cell::from(stage.pivots.to_string()),
            Cell::from(stage.change_count().to_string()),
            Cell::number(stage.max_slip()),
            Cell::number(denoised(stage.max_slip_increment(), slips)),
            Cell::number(denoised(stage.dissipated, energies)),
            Cell::from(stage.energy.map_or(String::new(), |energy| residual(energy.residual))),
        ]);
        table.rows.push(Row::new(cells));
    }
    table
}

/// Writes the way through stage `index` (from 0): its moments and what changes at each, then the pairs at its end.
pub fn write_stage(
    out: &mut dyn Write,
    history: &History,
    index: usize,
    units: &Units,
    style: &Style,
) -> io::Result<()> {
    let Some(stage) = history.stages.get(index) else {
        return writeln!(out, "no stage {}", index + 1);
    };
    let mut columns = vec![Column::given("done", None).droppable(1)];
    columns.extend(history.cases.iter().map(|case| Column::given(case, None)));
    columns.push(Column::words("change"));
    let mut table = Table::new(columns);
    for moment in stage.moments.iter().filter(|moment| !moment.is_passed()) {
        let mut cells = vec![Cell::number(moment.t)];
        cells.extend(moment.factors.iter().map(|factor| Cell::number(*factor)));
        cells.push(Cell::from(style.text(&moment.sentence)));
        table.rows.push(Row::new(cells));
    }
    table.write(out, style)?;
    if let Some(energy) = stage.energy {
        let text = format!(
            "work {} = stored {} + dissipated {}, balance {}",
            short(energy.work),
            short(energy.stored),
            short(denoised(stage.dissipated, energy.work.abs().max(energy.stored.abs()))),
            residual(energy.residual)
        );
        writeln!(out, "{}", style.fit(&text, style.width))?;
    }
    writeln!(out)?;
    match stage.moments.last() {
        Some(end) => super::pairs::write(out, &end.pairs, units, style),
        None => Ok(()),
    }
}
