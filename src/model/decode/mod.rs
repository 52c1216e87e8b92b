//! Text of a scenario → checked [`Scenario`], collecting every problem on the way.

mod bars;
mod contact_system;
mod contacts;
mod elements;
mod findings;
mod law;
mod lcp;
mod loads;
mod matrix_market;
mod numbers;
mod plates;
mod reader;
mod stages;
mod structure;
mod supports;
#[cfg(test)]
mod tests;
mod words;

use std::path::PathBuf;

use indexmap::IndexMap;

use super::locate::{Document, position};
use super::parameter::Parameter;
use super::problem::{Problem, Problems};
use super::rules::{Covering, Engine, Rules, TieBreak, UnknownChoice};
use super::scenario::{Places, Scenario, Source, Units};
use reader::{Cursor, Entry, Fields, Findings, Parameters};
use words::{ID_RULE, is_id, quoted};

pub(super) use words::did_you_mean;

const FORMAT: &str = "stickslip/1";

/// Keys of any scenario.
const COMMON: [&str; 7] = ["format", "title", "description", "units", "parameters", "stages", "solver"];

/// Keys of the source *structure*.
const STRUCTURE: [&str; 11] =
    ["materials", "sections", "nodes", "bars", "plates", "quads", "ties", "supports", "springs", "contacts", "loads"];

/// Keys of the other two sources.
const OTHER_SOURCES: [&str; 2] = ["contact_system", "lcp"];

/// Names that `set` in the program's own language already uses.
const RESERVED: [&str; 4] = ["auto", "covering", "tie-break", "engine"];

/// Checks the text of a scenario.
pub fn scenario(name: &str, text: &str, path: Option<PathBuf>) -> Result<Scenario, Problems> {
    let document = Document::parse(text).map_err(|error| {
        let (line, column) = position(text, error.offset);
        Problems {
            file: name.to_string(),
            problems: vec![Problem {
                line,
                column,
                path: String::new(),
                message: error.message,
                help: error.help.to_string(),
            }],
            more: 0,
        }
    })?;
    let findings = Findings::default();
    let decoded = read(Cursor::root(&document, &findings), name, text, path);
    match (findings.into_problems(name, &document), decoded) {
        (None, Some(scenario)) => Ok(scenario),
        (Some(problems), _) => Err(problems),
        // Whatever is left out was reported; said all the same if that is ever broken.
        (None, None) => Err(Problems::of_file(
            name,
            "the scenario could not be read, and no reason was recorded",
            "please report this as a fault of the program",
        )),
    }
}

fn read(root: Cursor<'_>, name: &str, text: &str, path: Option<PathBuf>) -> Option<Scenario> {
    let known: Vec<&'static str> = COMMON.iter().chain(&STRUCTURE).chain(&OTHER_SOURCES).copied().collect();
    let fields = root.fields(&known)?;
    format(&fields);
    let title = title(&fields);
    let description = match fields.optional("description") {
        Some(cursor) => cursor.string().map(str::to_string),
        None => None,
    };
    let units = fields.optional("units").and_then(units).unwrap_or_default();
    let parameters = fields.optional("parameters").and_then(parameters).unwrap_or_default();
    let solver = fields.optional("solver");
    let rules = solver.and_then(rules).unwrap_or_default();

    let mut places = Places::default();
    let source = match source_key(&fields)? {
        SourceKey::Structure => {
            let (structure, found) = structure::read(&fields, &parameters)?;
            places = found;
            Source::Structure(structure)
        }
        SourceKey::ContactSystem(cursor) => {
            let system = contact_system::read(cursor, &parameters, path.as_deref())?;
            places.pairs = (0..system.pairs.len()).map(|pair| format!("contact_system.pairs[{pair}]").into()).collect();
            Source::ContactSystem(system)
        }
        SourceKey::Lcp(cursor) => {
            refuse_covering(solver);
            Source::Lcp(lcp::read(cursor, &parameters)?)
        }
    };
    let stages = match (fields.entry("stages"), &source) {
        (None, _) => Some(Vec::new()),
        (Some(entry), Source::Lcp(_)) => {
            entry.key_problem("an lcp has no `stages`: it has no load cases", "remove `stages`");
            None
        }
        (Some(entry), Source::Structure(structure)) => {
            let cases: Vec<&str> = structure.load_cases.iter().map(|case| case.name.as_str()).collect();
            stages::read(entry, &cases, &parameters)
        }
        (Some(entry), Source::ContactSystem(system)) => {
            let cases: Vec<&str> = system.loads.iter().map(|load| load.name.as_str()).collect();
            stages::read(entry, &cases, &parameters)
        }
    };
    Some(Scenario {
        name: name.to_string(),
        path,
        text: text.to_string(),
        title: title?.to_string(),
        description,
        units,
        parameters: parameters
            .into_iter()
            .map(|(name, parameter)| Some((name, parameter?)))
            .collect::<Option<IndexMap<_, _>>>()?,
        source,
        stages: stages?,
        rules,
        places,
    })
}

fn format(fields: &Fields<'_>) {
    let Some(cursor) = fields.required("format") else {
        return;
    };
    if let Some(word) = cursor.string()
        && word != FORMAT
    {
        cursor.problem(
            format!("unknown format {}, expected \"{FORMAT}\"", quoted(word)),
            format!("this version of the program reads \"{FORMAT}\" only"),
        );
    }
}

fn title<'d>(fields: &Fields<'d>) -> Option<&'d str> {
    let cursor = fields.required("title")?;
    let title = cursor.string()?;
    if title.trim().is_empty() {
        cursor.problem("the title is empty", "say in a few words what this is");
        return None;
    }
    Some(title)
}

fn units(cursor: Cursor<'_>) -> Option<Units> {
    let fields = cursor.fields(&["length", "force"])?;
    let label = |key| fields.optional(key).and_then(Cursor::string).map(str::to_string);
    Some(Units { length: label("length"), force: label("force") })
}

fn parameters(cursor: Cursor<'_>) -> Option<Parameters> {
    let mut parameters = Parameters::new();
    for entry in cursor.entries()? {
        let name = entry.name();
        if !is_id(name) {
            entry.key_problem(format!("{} cannot be the name of a parameter", quoted(name)), ID_RULE);
        } else if RESERVED.contains(&name) {
            entry.key_problem(
                format!("the parameter name \"{name}\" is reserved"),
                format!("`set {name} …` is a command: choose another name"),
            );
        }
        // Registered even if wrong, so that its uses are not reported as well.
        parameters.insert(name.to_string(), parameter(entry));
    }
    Some(parameters)
}

fn parameter(entry: Entry<'_>) -> Option<Parameter> {
    let cursor = entry.value();
    if !cursor.is_object() {
        if cursor.is_string() || cursor.is_list() {
            cursor.problem(
                format!("expected a number or an object with `value`, found {}", cursor.found()),
                "write e.g. 0.3 or { \"value\": 0.3, \"min\": 0, \"max\": 1 }",
            );
            return None;
        }
        return Some(Parameter { value: cursor.number()?, min: None, max: None, step: None, unit: None, about: None });
    }
    let fields = cursor.fields(&["value", "min", "max", "step", "unit", "about"])?;
    let value = fields.required("value");
    let number = value.and_then(Cursor::number);
    let optional = |key| fields.optional(key).and_then(Cursor::number);
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
    let step = fields.optional("step").and_then(|cursor| cursor.positive("step"));
    let label = |key| fields.optional(key).and_then(Cursor::string).map(str::to_string);
    Some(Parameter { value: number?, min, max, step, unit: label("unit"), about: label("about") })
}

fn rules(cursor: Cursor<'_>) -> Option<Rules> {
    let fields = cursor.fields(&["covering", "tie_break", "engine"])?;
    Some(Rules {
        covering: rule::<Covering>(&fields, "covering"),
        tie_break: rule::<TieBreak>(&fields, "tie_break"),
        engine: rule::<Engine>(&fields, "engine"),
    })
}

fn rule<T: Default + std::str::FromStr<Err = UnknownChoice>>(fields: &Fields<'_>, key: &str) -> T {
    let Some(cursor) = fields.optional(key) else {
        return T::default();
    };
    let Some(word) = cursor.string() else {
        return T::default();
    };
    word.parse().unwrap_or_else(|error: UnknownChoice| {
        cursor.problem(format!("unknown {} {}", error.what, quoted(word)), format!("expected {}", error.expected));
        T::default()
    })
}

fn refuse_covering(solver: Option<Cursor<'_>>) {
    let Some(fields) = solver
        .filter(|cursor| cursor.is_object())
        .and_then(|cursor| cursor.fields(&["covering", "tie_break", "engine"]))
    else {
        return;
    };
    fields.refuse(
        &["covering"],
        |_| "an lcp has no `solver.covering`: it has no contact pairs".into(),
        "remove it; the vector d itself can be given as `lcp.covering`",
    );
}

enum SourceKey<'d> {
    Structure,
    ContactSystem(Cursor<'d>),
    Lcp(Cursor<'d>),
}

/// Which of the three sources the file describes; a mixture and nothing at all are reported.
fn source_key<'d>(fields: &Fields<'d>) -> Option<SourceKey<'d>> {
    let structure = STRUCTURE.iter().find_map(|key| fields.entry(key));
    let system = fields.entry("contact_system");
    let lcp = fields.entry("lcp");
    let mut present: Vec<Entry<'d>> = [structure, system, lcp].into_iter().flatten().collect();
    present.sort_by_key(|entry| entry.key_offset());
    if let [first, second, ..] = present[..] {
        second.key_problem(
            format!(
                "`{}` cannot stand beside `{}`: a scenario describes a structure, a contact system or an lcp, not a mixture",
                second.name(),
                first.name()
            ),
            "keep one of them; put the other into a file of its own",
        );
        return None;
    }
    match (structure, system, lcp) {
        (Some(_), _, _) => Some(SourceKey::Structure),
        (_, Some(system), _) => Some(SourceKey::ContactSystem(system.value())),
        (_, _, Some(lcp)) => Some(SourceKey::Lcp(lcp.value())),
        (None, None, None) => {
            fields.cursor().problem(
                "the scenario describes nothing: expected a structure (`nodes`, `bars`, `plates` …), a `contact_system` or an `lcp`",
                "add one of them",
            );
            None
        }
    }
}
