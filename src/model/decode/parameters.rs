//! `parameters`: values with their sliders, and formulas of other parameters.

use std::collections::HashMap;
use std::sync::Arc;

use indexmap::IndexMap;

use super::Under;
use super::declared::Parameters;
use super::reader::{Cursor, Entry, Fields};
use super::words::{ID_RULE, is_id, quoted};
use crate::model::expression::Expression;
use crate::model::parameter::{Formulas, Parameter, ParameterValues};

/// Names that other words of the program's language already are.
const RESERVED: [&str; 8] = ["auto", "covering", "tie-break", "engine", "facets", "cone", "geometry", "pi"];

/// A formula before it is known whether it depends on itself.
struct Draft<'d> {
    name: &'d str,
    cursor: Cursor<'d>,
    expression: Expression,
}

/// Reads `parameters`.
pub fn read(cursor: Cursor<'_>, under: &Under<'_>) -> Parameters {
    let mut parameters = Parameters::default();
    let Some(entries) = cursor.entries() else {
        return parameters;
    };
    let names: Vec<&str> = entries.iter().map(|entry| entry.name()).collect();
    let mut drafts = Vec::new();
    for entry in &entries {
        let name = entry.name();
        if !is_id(name) {
            entry.key_problem(format!("{} cannot be the name of a parameter", quoted(name)), ID_RULE);
        } else if RESERVED.contains(&name) {
            let help = match name {
                "pi" => "it is the constant of expressions: choose another name".to_owned(),
                _ => format!("`{name}` is a word of the program's language: choose another name"),
            };
            entry.key_problem(format!("the parameter name \"{name}\" is reserved"), help);
        }
        // Registered even if wrong, so that its uses are not reported as well.
        let parameter = match formula(*entry) {
            Some(fields) => formula_parameter(*entry, &fields, &names, &mut drafts),
            None => parameter(*entry),
        };
        parameters.known.insert(name.to_string(), parameter);
    }
    let values = parameters.known.iter().filter_map(|(name, parameter)| {
        let file = parameter.as_ref()?.value;
        Some((name.clone(), under.values.and_then(|given| given.get(name)).copied().unwrap_or(file)))
    });
    let values: IndexMap<String, f64> = values.collect();
    let formulas = in_order(&drafts, &mut parameters.known);
    parameters.values = ParameterValues::with_formulas(values, Arc::new(formulas));
    parameters.along = under.along.map(|name| (name.to_owned(), parameters.values.along(name)));
    for draft in &drafts {
        let Some(parameter) = parameters.known.get_mut(draft.name) else { continue };
        let value = parameters.values.get(draft.name).copied();
        if let (Some(known), Some(value)) = (parameter.as_mut(), value) {
            known.value = value;
            if !value.is_finite() {
                let of: Vec<String> = draft
                    .expression
                    .parameters()
                    .map(|name| format!("{name} = {}", parameters.values.get(name).copied().unwrap_or(f64::NAN)))
                    .collect();
                let at = if of.is_empty() { String::new() } else { format!(" at {}", of.join(", ")) };
                draft.cursor.problem(
                    format!("the formula {} is not a finite number{at}", draft.cursor.quoted()),
                    "change the formula or the values of its parameters",
                );
                *parameter = None;
            }
        }
    }
    parameters
}

/// The fields of an entry that has a formula.
fn formula(entry: Entry<'_>) -> Option<Fields<'_>> {
    let cursor = entry.value();
    if !cursor.has_key("formula") {
        return None;
    }
    cursor.fields(&["formula", "unit", "about", "value", "min", "max", "step"])
}

fn formula_parameter<'d>(
    entry: Entry<'d>,
    fields: &Fields<'d>,
    names: &[&str],
    drafts: &mut Vec<Draft<'d>>,
) -> Option<Parameter> {
    fields.refuse(
        &["value", "min", "max", "step"],
        |key| format!("`{key}` cannot stand beside `formula`: a formula is computed, not set"),
        "remove it, or the formula",
    );
    let label = |key| fields.optional(key).and_then(Cursor::string).map(str::to_string);
    let (unit, about) = (label("unit"), label("about"));
    let cursor = fields.required("formula")?;
    let expression = cursor.expression(cursor.string()?, names)?;
    drafts.push(Draft { name: entry.name(), cursor, expression: expression.clone() });
    Some(Parameter { value: f64::NAN, formula: Some(expression), min: None, max: None, step: None, unit, about })
}

/// The formulas, each after those it needs. Those in a circle are reported, with all names of it, and left out, and so
/// are those that need something wrong.
fn in_order(drafts: &[Draft<'_>], known: &mut IndexMap<String, Option<Parameter>>) -> Formulas {
    let index: HashMap<&str, usize> = drafts.iter().enumerate().map(|(k, draft)| (draft.name, k)).collect();
    let needs: Vec<Vec<usize>> = drafts
        .iter()
        .map(|draft| draft.expression.parameters().filter_map(|name| index.get(name).copied()).collect())
        .collect();
    let mut missing: Vec<usize> = needs.iter().map(Vec::len).collect();
    let mut needed_by: Vec<Vec<usize>> = vec![Vec::new(); drafts.len()];
    for (k, needs) in needs.iter().enumerate() {
        needs.iter().for_each(|&need| needed_by[need].push(k));
    }
    let mut order: Vec<usize> = (0..drafts.len()).filter(|&k| missing[k] == 0).collect();
    let mut next = 0;
    while let Some(&ready) = order.get(next) {
        next += 1;
        for &k in &needed_by[ready] {
            missing[k] -= 1;
            if missing[k] == 0 {
                order.push(k);
            }
        }
    }
    let ordered: Vec<bool> = missing.iter().map(|&missing| missing == 0).collect();
    report_circles(drafts, &needs, &ordered);
    for draft in drafts.iter().zip(&ordered).filter(|(_, ordered)| !**ordered).map(|(draft, _)| draft) {
        known.insert(draft.name.to_owned(), None);
    }
    let mut formulas = Vec::new();
    for draft in order.into_iter().map(|k| &drafts[k]) {
        if draft.expression.parameters().all(|name| known.get(name).is_some_and(Option::is_some)) {
            formulas.push((draft.name.to_owned(), draft.expression.clone()));
        } else {
            known.insert(draft.name.to_owned(), None);
        }
    }
    Formulas::new(formulas)
}

/// Reports each circle among the formulas that could not be brought into an order, once.
fn report_circles(drafts: &[Draft<'_>], needs: &[Vec<usize>], ordered: &[bool]) {
    // The walk on which each formula was met.
    let mut met = vec![None; drafts.len()];
    for start in (0..drafts.len()).filter(|&k| !ordered[k]) {
        let mut way = Vec::new();
        let mut here = start;
        while met[here].is_none() {
            met[here] = Some(start);
            way.push(here);
            // Every formula that is left needs another one that is left: following those ends in a circle.
            let Some(next) = needs[here].iter().copied().find(|&need| !ordered[need]) else { break };
            here = next;
        }
        let Some(first) = way.iter().position(|&k| k == here).filter(|_| met[here] == Some(start)) else { continue };
        let mut circle = way.split_off(first);
        let least = circle.iter().position(|k| circle.iter().min() == Some(k)).unwrap_or(0);
        circle.rotate_left(least);
        let names: Vec<&str> = circle.iter().chain(&circle[..1]).map(|&k| drafts[k].name).collect();
        drafts[circle[0]]
            .cursor
            .problem(format!("the formulas go in a circle: {}", names.join(" → ")), "give one of them a value instead");
    }
}

fn parameter(entry: Entry<'_>) -> Option<Parameter> {
    let cursor = entry.value();
    if !cursor.is_object() {
        if cursor.is_string() || cursor.is_list() {
            cursor.problem(
                format!("expected a number or an object with `value` or `formula`, found {}", cursor.found()),
                "write e.g. 0.3, { \"value\": 0.3, \"min\": 0, \"max\": 1 } or { \"formula\": \"F*h/2\" }",
            );
            return None;
        }
        let value = cursor.literal()?;
        return Some(Parameter { value, formula: None, min: None, max: None, step: None, unit: None, about: None });
    }
    let fields = cursor.fields(&["value", "formula", "min", "max", "step", "unit", "about"])?;
    let value = fields.required("value");
    let number = value.and_then(Cursor::literal);
    let optional = |key| fields.optional(key).and_then(Cursor::literal);
    let (min, max) = (optional("min"), optional("max"));
    if let (Some(min), Some(max), Some(at)) = (min, max, fields.optional("max"))
        && min > max
    {
        at.problem(format!("max {max} is less than min {min}"), "exchange them, or leave one out");
    } else if let (Some(value), Some(number)) = (value, number) {
        let below = min.is_some_and(|min| number < min);
        let above = max.is_some_and(|max| number > max);
        if below || above {
            let (end, limit) = if below { ("min", min) } else { ("max", max) };
            // One of the two is there, or neither test could hold.
            let limit = limit.unwrap_or(number);
            value
                .problem(format!("the value {number} lies beyond {end} {limit}"), format!("change the value or {end}"));
        }
    }
    let step = optional("step");
    if let (Some(number), Some(at)) = (step, fields.optional("step"))
        && number <= 0.0
    {
        at.problem(
            format!("step must be greater than 0, found {}", at.found()),
            "give step a value that is greater than 0",
        );
    }
    let label = |key| fields.optional(key).and_then(Cursor::string).map(str::to_string);
    Some(Parameter { value: number?, formula: None, min, max, step, unit: label("unit"), about: label("about") })
}
