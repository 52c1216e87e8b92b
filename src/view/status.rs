//! The line after every change, and the longer `status`.

use std::io::{self, Write};

use unicode_width::UnicodeWidthStr;

use super::scale::Scale;
use super::style::{Role, Style};
use super::{force_unit, length_unit};
use crate::answer::attempt::Attempt;
use crate::answer::record::{Answer, OutcomeKind, PairState, PolygonRecord, Start, State};
use crate::contact::polygon::degrees;
use crate::model::parameter::ParameterValues;
use crate::model::plausible;
use crate::model::scenario::{Scenario, Source};
use crate::model::units::Units;
use crate::model::uses::Redone;
use crate::text::number::{in_full, measured_alike, residual, short, with_unit};

/// `5 pivots`, `1 pivot`, `no pivot`; `warm start, 2 changes` where the last answer was followed.
pub fn pivot_count(answer: &Answer) -> String {
    if let Start::Warm { changes } = answer.start {
        return match changes {
            1 => "warm start, 1 change".into(),
            changes => format!("warm start, {changes} changes"),
        };
    }
    pivots_word(answer.pivot_count)
}

fn pivots_word(count: usize) -> String {
    match count {
        0 => "no pivot".into(),
        1 => "1 pivot".into(),
        n => format!("{n} pivots"),
    }
}

/// `2 stick 4 slip+ 0 open`: stick, slip and open always where there is friction, the others where they occur.
pub fn state_counts(pairs: &[PairState]) -> String {
    let count = |state: State| pairs.iter().filter(|pair| pair.state == state).count();
    // A roller has the law of a known bound and is closed.
    let friction = pairs.iter().any(|pair| pair.law.has_tangential_joint() && pair.state != State::Closed);
    let unilateral = pairs.iter().any(|pair| !pair.law.is_bilateral());
    let (plus, minus, closed) = (count(State::SlipPlus), count(State::SlipMinus), count(State::Closed));
    let mut parts = Vec::new();
    if friction {
        parts.push(format!("{} stick", count(State::Stick)));
    }
    let in_space = pairs.iter().any(|pair| pair.space.is_some());
    if friction && in_space {
        parts.push(format!("{} slip", count(State::Slip)));
    } else if friction && (plus > 0 || minus == 0) {
        parts.push(format!("{plus} slip+"));
    }
    if minus > 0 {
        parts.push(format!("{minus} slip-"));
    }
    if closed > 0 || !friction {
        parts.push(format!("{closed} closed"));
    }
    if unilateral {
        parts.push(format!("{} open", count(State::Open)));
    }
    parts.join(" ")
}

/// The largest slip of a pair in contact, a length ≥ 0: (|z_τ|, pair).
pub fn max_slip(pairs: &[PairState]) -> Option<(f64, &PairState)> {
    pairs
        .iter()
        .filter(|pair| matches!(pair.state, State::SlipPlus | State::SlipMinus | State::Slip))
        .map(|pair| (pair.z_t.abs(), pair))
        .filter(|(slip, _)| slip.is_finite())
        // The first of equals, so that the line does not depend on the order of evaluation.
        .fold(None, |best: Option<(f64, &PairState)>, next| match best {
            Some(best) if best.0 >= next.0 => Some(best),
            _ => Some(next),
        })
}

/// The largest opening, a length > 0: (z_n, pair).
pub fn max_opening(pairs: &[PairState]) -> Option<(f64, &PairState)> {
    pairs.iter().filter(|pair| pair.state == State::Open && pair.z_n.is_finite()).map(|pair| (pair.z_n, pair)).fold(
        None,
        |best: Option<(f64, &PairState)>, next| match best {
            Some(best) if best.0 >= next.0 => Some(best),
            _ => Some(next),
        },
    )
}

/// The line after a change:
/// `normal · 5 pivots · 2 stick 4 slip+ 0 open · max slip 0.005 m at c6 (was 0.0005)`;
/// `ray: mechanism · p 3.33 kN · 12 pivots · …`; `breakdown · …` with the reason.
///
/// Where `style.width` is too narrow, counts of 0 are left out, then the number of pivots, then what was before;
/// the line is never wrapped.
pub fn line(answer: &Answer, previous: Option<&Answer>, units: &Units, style: &Style) -> String {
    let (head, role) = headline(answer);
    match answer.outcome {
        OutcomeKind::Trivial | OutcomeKind::Normal if !answer.pairs.is_empty() => {
            let count = counted(answer, previous);
            let states = state_counts(&answer.pairs);
            let (extreme, before) = extreme(answer, previous, units);
            let with_before = match before {
                Some(before) => format!("{extreme} (was {before})"),
                None => extreme.clone(),
            };
            // What gives way in turn where the line is too narrow: counts of 0, the pivots, what was before.
            let occurring = occurring(&states);
            let ways = [
                vec![count.clone(), states, with_before.clone()],
                vec![count, occurring.clone(), with_before.clone()],
                vec![occurring.clone(), with_before],
                vec![occurring.clone(), extreme],
                vec![occurring],
            ];
            let mut ways = ways.into_iter().map(|parts| joined(&head, &parts, style));
            let fitting = ways.find(|(text, _)| text.width() <= style.width);
            finished(fitting.unwrap_or_else(|| joined(&head, &[], style)), role, style)
        }
        OutcomeKind::Trivial | OutcomeKind::Normal => {
            finished(joined(&head, &[counted(answer, previous)], style), role, style)
        }
        OutcomeKind::Ray => {
            let mut parts = Vec::new();
            if let Some(ray) = &answer.ray {
                parts.push(format!("p {}", weight(ray.p, answer, units)));
                parts.push(counted(answer, previous));
                if let Some(verdict) = ray.verdict {
                    parts.push(verdict.word().into());
                }
                if !ray.mode.is_empty() {
                    parts.push(ray.mode.clone());
                }
            }
            finished(joined(&head, &parts, style), role, style)
        }
        OutcomeKind::PivotLimit | OutcomeKind::Breakdown | OutcomeKind::CheckFailed => {
            let mut parts = vec![counted(answer, previous)];
            parts.extend(answer.failure.clone());
            finished(joined(&head, &parts, style), role, style)
        }
    }
}

/// The pivots, and before them what was computed anew for a change, if that was more than the LCP.
fn counted(answer: &Answer, previous: Option<&Answer>) -> String {
    let pivots = pivot_count(answer);
    match answer.redone {
        Redone::Loads | Redone::Stiffness if previous.is_some() => format!("new {}, {pivots}", answer.redone.symbol()),
        _ => pivots,
    }
}

/// The states of a count that occur: `2 stick 4 slip+` of `2 stick 4 slip+ 0 open`.
fn occurring(states: &str) -> String {
    let words: Vec<&str> = states.split(' ').collect();
    let some: Vec<String> =
        words.chunks(2).filter(|count| count.first() != Some(&"0")).map(|count| count.join(" ")).collect();
    some.join(" ")
}

/// The parts of a line and the length of its first one in bytes.
fn joined(head: &str, parts: &[String], style: &Style) -> (String, usize) {
    let dot = format!(" {} ", style.dot());
    let mut text = style.text(head);
    let length = text.len();
    for part in parts {
        text.push_str(&dot);
        text.push_str(&style.text(part));
    }
    (text, length)
}

/// The line cut to the width, its first part in colour.
fn finished((text, head): (String, usize), role: Role, style: &Style) -> String {
    let text = style.fit(&text, style.width);
    match text.split_at_checked(head) {
        Some((head, rest)) => format!("{}{rest}", style.paint(role, head)),
        None => style.paint(role, &text),
    }
}

/// First words of the line and their colour.
fn headline(answer: &Answer) -> (String, Role) {
    let word = answer.outcome.word();
    let role = Role::of_outcome(answer.outcome);
    match &answer.ray {
        Some(ray) if answer.outcome == OutcomeKind::Ray => (format!("ray: {}", ray.class.word()), role),
        _ if answer.marginal => (format!("{word} (marginal)"), Role::Warning),
        // Another answer than one on Coulomb's cone, which commands that look for that do not count.
        _ if answer.is_answer() && answer.polygon.is_some_and(|polygon| !polygon.cone) => {
            (format!("{word} (on the polygon)"), role)
        }
        _ => (word.to_owned(), role),
    }
}

/// The largest slip, else the largest opening, and what it was before if that was something else.
fn extreme(answer: &Answer, previous: Option<&Answer>, units: &Units) -> (String, Option<String>) {
    let unit = length_unit(units);
    let previous = previous.filter(|previous| previous.is_answer());
    let slip_before = previous.map(|p| max_slip(&p.pairs).map_or(0.0, |(slip, _)| slip));
    let (what, value, at, before) = if let Some((slip, pair)) = max_slip(&answer.pairs) {
        ("max slip", slip, &pair.id, slip_before)
    } else if let Some((opening, pair)) = max_opening(&answer.pairs) {
        let before = previous.map(|p| max_opening(&p.pairs).map_or(0.0, |(gap, _)| gap));
        ("max opening", opening, &pair.id, before)
    } else {
        let before = slip_before.filter(|slip| *slip > 0.0).map(|slip| {
            let (numbers, said) = measured_alike(&[slip], unit.as_deref());
            with_unit(&numbers.concat(), said.filter(|_| said != unit.as_deref()))
        });
        return ("no slip".into(), before);
    };
    let values: Vec<f64> = [value].into_iter().chain(before).collect();
    let (numbers, unit) = measured_alike(&values, unit.as_deref());
    let text = format!("{what} {} at {at}", with_unit(&numbers[0], unit));
    let before = numbers.get(1).filter(|before| **before != numbers[0]).cloned();
    (text, before)
}

/// p with its unit.
pub fn weight(p: f64, answer: &Answer, units: &Units) -> String {
    with_unit(&short(p), p_unit(answer, units).as_deref())
}

/// At a ray: that the forces and slips shown are those under p. `None` elsewhere, and for a bare LCP.
pub fn ray_note(answer: &Answer, units: &Units) -> Option<String> {
    let ray = answer.ray.as_ref().filter(|_| !answer.pairs.is_empty())?;
    let p = weight(ray.p, answer, units);
    Some(format!("no answer: forces and slips are those at the ray, with the tightening weight p = {p} in them"))
}

/// p is a force in contact problems and has no unit in a bare LCP.
fn p_unit(answer: &Answer, units: &Units) -> Option<String> {
    if answer.solution.is_some() || answer.pairs.is_empty() { None } else { force_unit(units) }
}

/// The longer `status`: what is solved, outcome, size, rules, check figures, attempts, notes, parameters, description.
pub fn write(
    out: &mut dyn Write,
    answer: &Answer,
    scenario: &Scenario,
    parameters: &ParameterValues,
    style: &Style,
) -> io::Result<()> {
    let units = &scenario.units;
    let title = format!("{} · {}", scenario.name, scenario.title);
    let title = style.fit(&style.text(&title), style.width);
    writeln!(out, "{}", style.paint(Role::Title, &title))?;
    writeln!(out, "{}", line(answer, None, units, style))?;

    let mut rows: Vec<(&str, String)> = Vec::new();
    if let Some(failure) = &answer.failure {
        rows.push(("no answer", failure.clone()));
    }
    if let Some(ray) = &answer.ray {
        rows.push(("mode", ray.mode.clone()));
        rows.push(("meaning", ray.explanation.clone()));
    }
    if answer.marginal {
        let p = weight(answer.p, answer, units);
        let stopped = match answer.p {
            0.0 => "the pivots bring p down to 0, but none takes it out".to_owned(),
            _ => format!("p stopped at {p} instead of 0"),
        };
        rows.push(("marginal", format!("exactly on a limit: {stopped}")));
    }
    rows.push(("size", sizes(answer, scenario)));
    rows.push((
        "rules",
        format!(
            "covering {} · tie-break {} · engine {}",
            answer.rules.covering, answer.rules.tie_break, answer.rules.engine
        ),
    ));
    if let Some(polygon) = &answer.polygon {
        rows.push(("friction", friction_polygon(polygon)));
    }
    if let Start::Warm { changes } = answer.start {
        let times = if changes == 1 { "change" } else { "changes" };
        rows.push(("start", format!("warm: followed from the last answer, {changes} {times} of the working scheme")));
    }
    if answer.is_answer() || answer.outcome == OutcomeKind::CheckFailed {
        rows.push(("check", check(answer)));
    }
    if answer.attempts.len() > 1 {
        rows.extend(labelled("attempts", answer.attempts.iter().map(attempt)));
    }
    rows.extend(labelled("notes", answer.notes.iter().cloned()));
    rows.extend(labelled("warnings", plausible::said_at_load(scenario).into_iter()));
    if !parameters.is_empty() {
        let value = |(name, value): (&String, &f64)| {
            // what is computed has no digits that a user gave
            let computed = parameters.formula(name).is_some();
            let text = if computed { Scale::given([*value]).in_line(*value) } else { in_full(*value) };
            format!("{name} = {}", with_unit(&text, scenario.unit_of(name)))
        };
        rows.push(("parameters", parameters.iter().map(value).collect::<Vec<_>>().join(", ")));
    }
    if let Some(description) = &scenario.description {
        rows.push(("description", description.clone()));
    }
    for (label, text) in rows {
        let label = format!("{label:<12}");
        for (i, line) in style.hanging(&label, &text).iter().enumerate() {
            match line.strip_prefix(label.as_str()) {
                Some(rest) if i == 0 => writeln!(out, "{}{rest}", style.paint(Role::Muted, &label))?,
                _ => writeln!(out, "{line}")?,
            }
        }
    }
    Ok(())
}

/// Rows of which the first one has the label.
fn labelled<'l>(
    label: &'l str,
    texts: impl Iterator<Item = String> + 'l,
) -> impl Iterator<Item = (&'l str, String)> + 'l {
    texts.enumerate().map(move |(i, text)| (if i == 0 { label } else { "" }, text))
}

/// `612 unknowns (576 free) · 16 contact pairs · LCP of 48`.
fn sizes(answer: &Answer, scenario: &Scenario) -> String {
    let size = &answer.size;
    let mut sizes = Vec::new();
    if let Some(unknowns) = size.unknowns {
        sizes.push(match size.free {
            Some(free) => format!("{unknowns} unknowns ({free} free)"),
            None => format!("{unknowns} unknowns"),
        });
    }
    if !matches!(scenario.source, Source::Lcp(_)) {
        sizes.push(format!("{} contact {}", size.pairs, if size.pairs == 1 { "pair" } else { "pairs" }));
    }
    sizes.push(format!("LCP of {}", size.lcp));
    sizes.join(" · ")
}

/// The figures of the check and whether they passed.
fn check(answer: &Answer) -> String {
    let check = &answer.check;
    let mut figures = vec![
        format!("min w {}", residual(check.min_w)),
        format!("min z {}", residual(check.min_z)),
        format!("w·z {}", residual(check.complementarity)),
    ];
    figures.extend(check.equilibrium.map(|equilibrium| format!("equilibrium {}", residual(equilibrium))));
    let word = match (check.passed, check.joints_only) {
        (false, _) => "FAILED",
        (true, true) => "joints passed, equilibrium follows",
        (true, false) => "passed",
    };
    format!("{word}: {}", figures.join(" · "))
}

/// A try of the solver and how it ended.
fn attempt(attempt: &Attempt) -> String {
    format!(
        "{} · {} · {}: {}{}{}",
        attempt.rules.covering,
        attempt.rules.tie_break,
        attempt.rules.engine,
        attempt.outcome.word(),
        attempt.pivots.map_or(String::new(), |pivots| format!(" · {}", pivots_word(pivots))),
        attempt.why.as_ref().map_or(String::new(), |why| format!(" ({})", why.trim_end_matches('.')))
    )
}

/// At most this many parts that only contact holds are listed one by one.
const LOOSE: usize = 3;

/// Writes a line for every part that only contact holds; nothing where there are none.
pub fn write_loose(out: &mut dyn Write, sentences: &[String], style: &Style) -> io::Result<()> {
    let shown = if sentences.len() > LOOSE + 1 { LOOSE } else { sentences.len() };
    let more = sentences.len() - shown;
    let rest = (more > 0)
        .then(|| format!("{more} more parts that only contact holds: `stickslip check FILE --format json` lists them"));
    for sentence in sentences[..shown].iter().chain(&rest) {
        for line in style.hanging("loose: ", &style.text(sentence)) {
            writeln!(out, "{}", style.paint(Role::Muted, &line))?;
        }
    }
    Ok(())
}
/// `polygon of 8 facets · on Coulomb's cone after 2 Newton steps, which moved slips by up to 3.4 %`.
fn friction_polygon(polygon: &PolygonRecord) -> String {
    let mut text = format!("polygon of {} facets", polygon.facets);
    if polygon.turn != 0.0 {
        text += &format!(" turned by {}", degrees(polygon.turn));
    }
    if polygon.newton == Some(0) {
        text += ": its answer stands on Coulomb's cone";
    } else if let Some(steps) = polygon.newton {
        let word = if steps == 1 { "step" } else { "steps" };
        text += &format!(" · on Coulomb's cone after {steps} Newton {word}");
        if let Some(distance) = polygon.distance {
            text += &format!(", which moved slips by up to {} % of the largest", short(100.0 * distance));
        }
    } else if polygon.cone {
        text += " where steps began anew · followed on Coulomb's cone";
    }
    text
}
