//! Pages of `docs/` that are made from the tables of the program: the scenario format from its schema, commands from the
//! grammar, quantities from their words. `UPDATE_README=1` writes them anew.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use jsonc_parser::ParseOptions;
use jsonc_parser::cst::CstRootNode;
use serde_json::{Map, Value};
use stickslip::model::embedded;
use stickslip::model::quantity::{Dimension, WORDS};
use stickslip::model::schema::SCHEMA;
use stickslip::session::commands::GROUPS;
use stickslip::session::language::help::help;

/// The page must be what the tables say; with `UPDATE_README` it is written anew.
fn compare(name: &str, text: &str) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(name);
    if std::env::var_os("UPDATE_README").is_some() {
        fs::write(&file, text).unwrap();
    }
    let written = fs::read_to_string(&file).unwrap_or_default();
    assert!(written == text, "docs/{name} is not up to date: UPDATE_README=1 cargo test --test transcripts generated");
}

#[test]
fn commands_page() {
    let mut page = String::from(
        "# Commands\n\nMade from the grammar of the prompt (`help`, `help COMMAND` show the same). Unique prefixes work, `;` \
         separates commands, `#` begins a comment. The same lines stand in scripts (`stickslip replay FILE`), behind `:` in the \
         full screen and in requests to `stickslip serve`. What quantities there are: [quantities.md](quantities.md).\n",
    );
    for (group, commands) in GROUPS {
        write!(page, "\n## {}{}\n", group[..1].to_uppercase(), &group[1..]).unwrap();
        for command in *commands {
            let text = help(command.name, 100).unwrap();
            write!(page, "\n### {}\n\n```text\n{}```\n", command.name, text).unwrap();
        }
    }
    compare("commands.md", &page);
}

#[test]
fn quantities_page() {
    let mut page = String::from(
        "# Quantities\n\nMade from the words of the program. One language for everything that can be asked: `show Q`, `expect Q < 3`, \
         probes in the file, `find P where Q = 0`, `envelope Q over P`, `trace … of Q`, `map … of Q`, `sweep --columns`, `sample … of \
         Q`, `plot path Q`. A probe's name is a quantity as well; names with blanks are quoted. A PATTERN is a pair, an edge \
         contact, or has `*` for any letters; left out it means all; so does a BODY (a plate, a brick, a mesh or a part of one). Signs: [signs.md](signs.md).\n\n\
         | quantity | dimension | what it is |\n| --- | --- | --- |\n",
    );
    for word in WORDS {
        let dimension = match word.dimension {
            Dimension::None if word.choices.is_empty() => "number",
            Dimension::None => "word",
            Dimension::Length => "length",
            Dimension::Force => "force",
            Dimension::Moment => "force × length",
            Dimension::Stress => "force / length²",
            Dimension::Inner => "that of the quantity inside",
        };
        let arguments = word.meaning.arguments().replace('|', "\\|");
        let choices = match word.choices {
            [] => String::new(),
            choices if word.about.contains(choices[0]) => String::new(),
            choices => format!(": {}", choices.join(", ")),
        };
        writeln!(page, "| `{} {}` | {dimension} | {}{choices} |", word.word, arguments, word.about).unwrap();
    }
    let page = page.replace(" ` |", "` |").replace("\\|", "&#124;");
    let page = page.lines().map(plain_bars).collect::<Vec<_>>().join("\n") + "\n";
    compare("quantities.md", &page);
}

/// In code, an escaped bar is written as Markdown's tables want it.
fn plain_bars(line: &str) -> String {
    line.replace("&#124;", "\\|")
}

/// What a value may be, in words, from its schema.
fn kind(schema: &Value) -> String {
    if let Some(name) = schema["$ref"].as_str().and_then(|target| target.rsplit('/').next()) {
        return match name {
            "Number" => "number*".to_owned(),
            name => format!("[{name}](#{})", name.to_lowercase()),
        };
    }
    if let Some(words) = schema["enum"].as_array() {
        let words: Vec<_> = words.iter().map(|word| format!("`{}`", word.as_str().unwrap())).collect();
        return words.join(", ");
    }
    if let Some(ways) = schema["anyOf"].as_array() {
        return ways.iter().map(kind).collect::<Vec<_>>().join(", or ");
    }
    match schema["type"].as_str() {
        Some("array") => {
            let inner = kind(&schema["items"]);
            match (schema["minItems"].as_u64(), schema["maxItems"].as_u64()) {
                (Some(least), Some(most)) if least == most => format!("list of {least}: {inner}"),
                _ => format!("list: {inner}"),
            }
        }
        Some("object") => match schema.get("additionalProperties") {
            Some(inner @ Value::Object(_)) => format!("object, name → {}", kind(inner)),
            _ => "object".to_owned(),
        },
        Some("string") => "text".to_owned(),
        Some("integer") => "whole number".to_owned(),
        Some(other) => other.to_owned(),
        None => "anything".to_owned(),
    }
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

/// The table of the keys of an object.
fn keys(page: &mut String, schema: &Value) {
    let required: Vec<&str> =
        schema["required"].as_array().map(|keys| keys.iter().filter_map(Value::as_str).collect()).unwrap_or_default();
    page.push_str("\n| key | value | what it is |\n| --- | --- | --- |\n");
    for (key, value) in schema["properties"].as_object().unwrap() {
        let mark = if required.contains(&key.as_str()) { " (required)" } else { "" };
        let constant = value["const"].as_str().map(|word| format!("`\"{word}\"`"));
        let what = constant.unwrap_or_else(|| cell(&kind(value)));
        let about = cell(value["description"].as_str().unwrap_or(""));
        writeln!(page, "| `{key}`{mark} | {what} | {about} |").unwrap();
    }
}

/// The first value of a key at the top of an embedded scenario, cut down to one entry, on one line.
fn example(key: &str) -> Option<(String, String)> {
    embedded::names().find_map(|name| {
        let tree = jsonc(embedded::text(name)?);
        let value = match tree.get(key)? {
            Value::Array(list) => Value::Array(vec![list.first()?.clone()]),
            Value::Object(map) if !matches!(key, "lcp" | "contact_system" | "units") => {
                let (name, inner) = map.iter().next()?;
                Value::Object(Map::from_iter([(name.clone(), inner.clone())]))
            }
            value => value.clone(),
        };
        let text = serde_json::to_string(&value).unwrap();
        (text.chars().count() < 400).then(|| (name.to_owned(), format!("\"{key}\": {}", spaced(&text))))
    })
}

/// A scenario without its remarks.
fn jsonc(text: &str) -> Value {
    CstRootNode::parse(text, &ParseOptions::default()).unwrap().to_serde_value().unwrap()
}

/// Blanks after commas and colons outside strings.
fn spaced(json: &str) -> String {
    let mut inside = false;
    let mut out = String::new();
    for letter in json.chars() {
        inside ^= letter == '"';
        out.push(letter);
        if !inside && matches!(letter, ',' | ':') {
            out.push(' ');
        }
    }
    out
}

#[test]
fn scenario_format_page() {
    let schema: Value = serde_json::from_str(SCHEMA).unwrap();
    let definitions = schema["$defs"].as_object().unwrap();
    let mut page = String::from(
        "# The scenario format, `stickslip/1`\n\nMade from the schema (`stickslip schema` prints it) and the embedded scenarios. One \
         JSON file (UTF-8); `//`, `/* */` and trailing commas may stand in it; unknown keys are errors. Exactly one source: a \
         structure (all keys from `materials` on, or `superelement` in the place of elements), a `contact_system`, or an `lcp`.\n\n\
         *number\\** is a number, the name of a parameter, or an expression of parameters in a string: `\"2*F + 1\"`, \
         `\"L*sin(alpha)\"` (+ − * / ^, parentheses, sqrt, abs, min, max, sin, cos, tan, atan, pi; radians). Ids are letters, \
         digits, `_` and `-`, beginning with a letter.\n\n## The file\n",
    );
    keys(&mut page, &schema);
    for (name, definition) in definitions.iter().filter(|(name, _)| *name != "Number") {
        write!(page, "\n## {name}\n").unwrap();
        if let Some(about) = definition["description"].as_str() {
            write!(page, "\n{about}.\n").unwrap();
        }
        if definition["properties"].is_object() {
            keys(&mut page, definition);
            continue;
        }
        page.push('\n');
        match definition["oneOf"].as_array().or(definition["anyOf"].as_array()) {
            Some(ways) => {
                for way in ways {
                    let about = way["description"].as_str().unwrap_or("");
                    match way["properties"].as_object().and_then(|keys| keys.iter().next()) {
                        Some((key, inner)) => writeln!(page, "* `{key}`: {}; {about}", kind(inner)).unwrap(),
                        None => writeln!(page, "* {}; {about}", kind(way)).unwrap(),
                    }
                }
            }
            None => writeln!(page, "{}", kind(definition)).unwrap(),
        }
    }
    page.push_str("\n## Examples\n\nFrom the embedded scenarios (`load NAME; save FILE` makes a copy):\n");
    for key in schema["properties"].as_object().unwrap().keys() {
        if let Some((name, text)) = example(key) {
            write!(page, "\n`{key}`, from `{name}`:\n\n```jsonc\n{text}\n```\n").unwrap();
        }
    }
    compare("scenario-format.md", &page);
}
