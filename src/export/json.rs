//! Results as JSON: `stickslip-result/1`, and plain arrays of one kind of record.
//!
//! Keys are stable. Numbers are in the scenario's units and in full precision.

use std::io;

use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::answer::diagram::{Diagram, Internal};
use crate::answer::record::{Answer, MemberForces, OutcomeKind};
use crate::model::parameter::ParameterValues;
use crate::model::problem::{Problem, Problems};
use crate::text::printable;

/// A value as text on lines of its own, without the characters that a terminal must not get.
///
/// # Errors
/// A value that is not JSON.
pub fn pretty(value: &impl Serialize) -> io::Result<String> {
    Ok(printable::json(serde_json::to_string_pretty(value).map_err(io::Error::other)?))
}

/// What is wrong with an input: `{"error": [{file, line, column, path, message, help}]}`, line and column null where
/// there is no place in the text; `more` counts the problems that are not listed.
pub fn problems(problems: &[Problems]) -> Value {
    let errors: Vec<Value> =
        problems.iter().flat_map(|of_file| of_file.problems.iter().map(move |of| problem(&of_file.file, of))).collect();
    let more: usize = problems.iter().map(|of_file| of_file.more).sum();
    if more == 0 { json!({"error": errors}) } else { json!({"error": errors, "more": more}) }
}

/// One problem, or warning, of a file.
pub fn problem(file: &str, problem: &Problem) -> Value {
    let place = |number: usize| if number == 0 { Value::Null } else { number.into() };
    json!({
        "file": file, "line": place(problem.line), "column": place(problem.column), "path": problem.path,
        "message": problem.message, "help": problem.help,
    })
}

/// [`problems`] where a result was due: `outcome` is null, for programs that look at it first.
pub fn no_result(of_files: &[Problems]) -> Value {
    let mut value = problems(of_files);
    value["outcome"] = Value::Null;
    value
}

/// The result of one solve.
///
/// `notes` are remarks on the answer, where there are any. A very long run keeps the records of its first pivots only;
/// `pivot_count` then says how many there were. After a pivot limit, a breakdown or a failed check, `failure` says why,
/// `pairs`, `displacements`, `members`, `reactions` and `solution` are absent and `ray` is null; at a ray the
/// displacements, members and reactions are absent; for a contact system or a bare LCP they always are. `timings` only
/// on request: two runs of one scenario are then the same to the byte.
pub fn result(answer: &Answer, scenario_name: &str, parameters: &ParameterValues, timings: bool) -> Value {
    let failed = answer.outcome.is_failure();
    let mut object = Map::new();
    let mut put = |key: &str, value: Value| {
        object.insert(key.to_owned(), value);
    };
    put("format", "stickslip-result/1".into());
    put("scenario", scenario_name.into());
    put("parameters", value(parameters));
    put("outcome", value(&answer.outcome));
    put("marginal", answer.marginal.into());
    let ray = answer.ray.as_ref().filter(|_| answer.outcome == OutcomeKind::Ray);
    put("ray", value(&ray));
    put("p", value(&answer.p));
    put("covering", value(&answer.rules.covering));
    put("tie_break", value(&answer.rules.tie_break));
    put("engine", value(&answer.rules.engine));
    if let Some(polygon) = &answer.polygon {
        put("polygon", value(polygon));
    }
    put("attempts", value(&answer.attempts));
    put("pivots", pivots(answer));
    if answer.unrecorded() > 0 {
        put("pivot_count", answer.pivot_count.into());
    }
    if !failed {
        put("pairs", pairs(answer));
        if let Some(solution) = &answer.solution {
            put("solution", value(solution));
        }
    }
    if let Some(failure) = answer.failure.as_ref().filter(|_| failed) {
        put("failure", failure.as_str().into());
    }
    put("check", value(&answer.check));
    if answer.is_answer() {
        if answer.displacements.is_some() {
            put("displacements", displacements(answer));
        }
        if answer.members.is_some() {
            put("members", members(answer));
        }
        if answer.reactions.is_some() {
            put("reactions", reactions(answer));
        }
    }
    if !answer.notes.is_empty() {
        put("notes", value(&answer.notes));
    }
    put("size", value(&answer.size));
    if timings {
        put("timings", value(&answer.timings));
    }
    Value::Object(object)
}

/// The pairs as an array.
pub fn pairs(answer: &Answer) -> Value {
    value(&answer.pairs)
}

/// The pivots as an array.
pub fn pivots(answer: &Answer) -> Value {
    value(&answer.pivots)
}

/// The displacements as an array; empty where there are none.
pub fn displacements(answer: &Answer) -> Value {
    value(&answer.displacements.as_deref().unwrap_or_default())
}

/// The member forces as an array; empty where there are none.
pub fn members(answer: &Answer) -> Value {
    answer.members.iter().flatten().map(member).collect()
}

/// The forces of one element of a bar: at its ends, along it (`diagram`: polynomials in the distance from the start of
/// each range, constant first), and the least and the largest, between the ends too. Distances are from the start of
/// the bar.
pub fn member(member: &MemberForces) -> Value {
    let mut object = value(member);
    let (Some(diagram), Value::Object(map)) = (Diagram::of_element(member), &mut object) else { return object };
    let named = |of: &dyn Fn(Internal) -> Value| -> Map<String, Value> {
        Internal::of(member.start.space.is_some()).iter().map(|&which| (which.symbol().to_owned(), of(which))).collect()
    };
    let extremes = named(&|which| {
        let [least, largest] = diagram.extremes(which).map(|place| json!({"value": place.value, "at": place.distance}));
        json!({"least": least, "largest": largest})
    });
    let pieces = diagram.pieces().iter().map(|piece| {
        let polynomials = piece.polynomials();
        let mut map = named(&|which| json!(polynomials[which.index()]));
        map.insert("range".to_owned(), json!(piece.range));
        Value::Object(map)
    });
    map.insert("diagram".to_owned(), pieces.collect());
    map.insert("extremes".to_owned(), Value::Object(extremes));
    unsign_zeros(&mut object);
    object
}

/// The reactions as an array; empty where there are none.
pub fn reactions(answer: &Answer) -> Value {
    value(&answer.reactions.as_deref().unwrap_or_default())
}

/// A record as a value, −0 written as 0. The records hold strings, numbers and lists only, with string keys:
/// serde_json has no way to fail on them.
pub(super) fn value(record: &impl Serialize) -> Value {
    without_signed_zeros(serde_json::to_value(record).unwrap_or(Value::Null))
}

/// A value with −0 as 0.
pub fn without_signed_zeros(mut value: Value) -> Value {
    unsign_zeros(&mut value);
    value
}

fn unsign_zeros(value: &mut Value) {
    match value {
        Value::Number(number) if number.as_f64() == Some(0.0) && number.is_f64() => {
            *value = Value::from(0.0);
        }
        Value::Array(list) => list.iter_mut().for_each(unsign_zeros),
        Value::Object(map) => map.values_mut().for_each(unsign_zeros),
        _ => {}
    }
}
