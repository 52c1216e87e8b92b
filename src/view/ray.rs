//! A ray: what it is, what moves, what it means.

use std::io::{self, Write};

use super::force_unit;
use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use crate::answer::record::{PairDirection, Ray, RayClass, Slip, VariableRate, Verdict};
use crate::contact::polygon::{angle, degrees};
use crate::contact::system::ContactSystem;
use crate::explain::mode::{PartMotion, pair_words};
use crate::explain::proof::Certificate;
use crate::explain::ray::RayReport;
use crate::explain::remedy::Remedies;
use crate::model::units::Units;
use crate::solve::explain::REMEDY_TIME;
use crate::text::number::{short, with_unit};

/// Parts of a motion that are named one by one.
const MOST_PARTS: usize = 6;

/// What the class of a ray means, in a few words.
fn class_meaning(ray: &Ray) -> &'static str {
    let is_in_space = |pair: &PairDirection| matches!(pair.z_t, Slip::Space(_));
    match ray.class {
        RayClass::Mechanism => "the loads do work on a motion that costs no energy",
        RayClass::Artefact if ray.direction.pairs().iter().any(is_in_space) => {
            "slips of a pair along several facets grow together and cancel; says nothing about the structure"
        }
        RayClass::Artefact => "z+ and z- of a pair grow together; says nothing about the structure",
        RayClass::Fault => "the structure stands without its contacts: an answer exists, the run failed",
        RayClass::NoEquilibrium => "the run found no equilibrium",
    }
}

/// What a verdict means, in a few words.
fn verdict_meaning(verdict: Option<Verdict>) -> &'static str {
    match verdict {
        Some(Verdict::Certified) => "no contact forces within friction balance the loads",
        Some(Verdict::Proved) => "enumeration of all working schemes found no answer",
        Some(Verdict::Undecided) => "neither an answer nor a proof that there is none was found",
        None => "not examined",
    }
}

/// What a pair does in a ray, in space with the direction of its slip from t1 towards t2; `None` where it does not move.
pub fn motion_words(direction: &PairDirection) -> Option<String> {
    let words = match (direction.parts(), direction.slips()) {
        (false, false) => return None,
        (true, true) => "parts and slips",
        (true, false) => "parts",
        _ if matches!(direction.z_t, Slip::Space(_)) => "slips",
        _ if direction.z_t.scalar() > 0.0 => "slips +",
        _ => "slips -",
    };
    Some(match direction.z_t {
        Slip::Space(slip) if direction.slips() => format!("{words} towards {}", degrees(angle(slip))),
        _ => words.to_owned(),
    })
}

/// Writes class, verdict, p, mode, explanation and the direction pair by pair (pairs that do not move are counted).
pub fn write(out: &mut dyn Write, ray: &Ray, units: &Units, style: &Style) -> io::Result<()> {
    let role = match ray.class {
        RayClass::Mechanism | RayClass::NoEquilibrium => Role::Warning,
        RayClass::Artefact | RayClass::Fault => Role::Bad,
    };
    let head = style.fit(&format!("ray: {}", ray.class.word()), style.width);
    writeln!(out, "{}", style.paint(role, &head))?;
    let verdict = match ray.verdict {
        Some(verdict) if ray.misfit => format!("{}: the parts do not fit together", verdict.word()),
        Some(verdict) => format!("{}: {}", verdict.word(), verdict_meaning(ray.verdict)),
        None if matches!(ray.class, RayClass::Mechanism | RayClass::NoEquilibrium) => verdict_meaning(None).into(),
        // An artefact or a fault claims nothing about the structure.
        None => String::new(),
    };
    let p = with_unit(&short(ray.p), force_unit(units).as_deref());
    let driver = match ray.driver.as_str() {
        "" => String::new(),
        driver => format!("{driver} enters and nothing blocks it"),
    };
    let rows = [
        ("class", class_meaning(ray)),
        ("verdict", verdict.as_str()),
        ("p", p.as_str()),
        ("driver", driver.as_str()),
        ("mode", ray.mode.as_str()),
        ("meaning", ray.explanation.as_str()),
    ];
    for (label, text) in rows {
        if text.is_empty() {
            continue;
        }
        for line in style.hanging(&format!("{label:<9}"), text) {
            writeln!(out, "{line}")?;
        }
    }
    if !ray.direction.variables().is_empty() {
        return write_variables(out, ray.direction.variables(), style);
    }
    let moving: Vec<_> =
        ray.direction.pairs().iter().filter_map(|direction| Some((direction, motion_words(direction)?))).collect();
    if moving.is_empty() {
        return Ok(());
    }
    writeln!(out)?;
    let mut table = Table::new(vec![
        Column::words("pair"),
        Column::numbers("z̄_n", None).of(1),
        Column::numbers("z̄_τ", None).of(1),
        Column::words("motion").droppable(1),
    ]);
    for (direction, motion) in &moving {
        table.rows.push(Row::new(vec![
            Cell::from(direction.pair.as_str()),
            Cell::number(direction.z_n),
            Cell::number(direction.z_t.scalar()),
            Cell::from(motion.as_str()),
        ]));
    }
    table.write(out, style)?;
    let still = ray.direction.pairs().len() - moving.len();
    if still > 0 {
        let pairs = if still == 1 { "pair does" } else { "pairs do" };
        let text = style.fit(&format!("{still} {pairs} not move"), style.width);
        writeln!(out, "{}", style.paint(Role::Muted, &text))?;
    }
    Ok(())
}

/// Writes the direction variable by variable; those that stand still are left out.
fn write_variables(out: &mut dyn Write, rates: &[VariableRate], style: &Style) -> io::Result<()> {
    writeln!(out)?;
    let mut table = Table::new(vec![Column::words("variable"), Column::numbers("rate", None)]);
    for rate in rates {
        table.rows.push(Row::new(vec![Cell::from(rate.variable.as_str()), Cell::number(rate.rate)]));
    }
    table.write(out, style)
}

/// Writes the work of each load case on the mode and the motion that certifies it.
pub fn write_details(out: &mut dyn Write, report: &RayReport, system: &ContactSystem, style: &Style) -> io::Result<()> {
    if !report.powers.is_empty() && report.class == RayClass::Mechanism {
        writeln!(out)?;
        let mut table = Table::new(vec![
            Column::words("load case"),
            Column::given("factor", None),
            Column::numbers("work on the mode", None),
            Column::words("").droppable(1),
        ]);
        for power in &report.powers {
            let word = match power.power.total_cmp(&0.0) {
                _ if power.power == 0.0 => "idle",
                std::cmp::Ordering::Greater => "drives",
                _ => "resists",
            };
            table.rows.push(Row::new(vec![
                Cell::from(power.case.as_str()),
                Cell::number(power.factor),
                Cell::number(power.power),
                Cell::from(word),
            ]));
        }
        table.write(out, style)?;
    }
    if let Some(certificate) = &report.certificate {
        writeln!(out)?;
        let text = proof_words(report, certificate, system);
        for line in style.hanging("proof    ", &style.text(&text)) {
            writeln!(out, "{line}")?;
        }
    }
    Ok(())
}

/// The motion of a certificate, why it proves, and how that was verified.
fn proof_words(report: &RayReport, certificate: &Certificate, system: &ContactSystem) -> String {
    let parts = match &report.certificate_mode {
        Some(mode) => mode.parts.as_slice(),
        None => &[],
    };
    let motion = match parts {
        [] => pair_words(system, &certificate.direction).join("; "),
        few if few.len() <= MOST_PARTS => few.iter().map(PartMotion::words).collect::<Vec<_>>().join("; "),
        many => format!("{} parts move against one another", many.len()),
    };
    let signs = if certificate.exact {
        "Every sign was verified from the data, by more than its rounding or in exact arithmetic."
    } else {
        "Every sign was verified from the data by more than its rounding."
    };
    let (work, taken) = (short(certificate.power), short(certificate.dissipation));
    if certificate.of_this_load {
        return format!(
            "motion: {motion}. Per unit of its largest entry the loads do the work {work} on it; friction under the normal \
             forces that the load alone decides, cohesion and known bounds take at most {taken}. {signs}"
        );
    }
    format!(
        "motion: {motion}. Per unit of its largest entry the loads do the work {work} on it; cohesion and known bounds take \
         at most {taken}, pressed contact nothing: every pair parts by at least f times its slip. The real motion need not part \
         (friction is not associated); that of the proof may, for it only asks whether any forces within friction could \
         balance the loads. {signs}"
    )
}

/// Writes what would stop a collapse: remedy, threshold, present value.
pub fn write_remedies(out: &mut dyn Write, found: &Remedies, style: &Style) -> io::Result<()> {
    if !found.remedies.is_empty() {
        writeln!(out)?;
        let mut table = Table::new(vec![
            Column::words("what would stop it"),
            Column::words("threshold"),
            Column::words("now"),
            Column::words("shown").droppable(1),
        ]);
        for remedy in &found.remedies {
            let words = remedy.words();
            table.rows.push(Row::new(vec![
                Cell::from(words.remedy),
                Cell::from(words.threshold),
                Cell::from(words.now),
                Cell::from(words.shown),
            ]));
        }
        table.write(out, style)?;
    }
    if !found.complete {
        let text = format!("not every remedy could be decided (at most {} s are spent on them)", REMEDY_TIME.as_secs());
        style.paragraph(out, Role::Muted, &text)?;
    }
    Ok(())
}
