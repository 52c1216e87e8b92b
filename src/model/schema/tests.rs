//! The schema against the decoder: every shipped scenario fits, and both know the same keys and words everywhere.

use std::collections::BTreeSet;

use jsonc_parser::ParseOptions;
use jsonc_parser::cst::CstRootNode;
use serde_json::{Map, Value, json};

use super::SCHEMA;
use crate::model::embedded;
use crate::model::load::load_text;

fn schema() -> Value {
    serde_json::from_str(SCHEMA).expect("JSON")
}

/// Follows `$ref`.
fn resolved<'s>(root: &'s Value, schema: &'s Value) -> &'s Value {
    match schema.get("$ref").and_then(Value::as_str) {
        Some(place) => {
            let target = root.pointer(place.trim_start_matches('#'));
            resolved(root, target.expect("a definition"))
        }
        None => schema,
    }
}

fn is_of_type(kind: &str, value: &Value) -> bool {
    match kind {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        "boolean" => value.is_boolean(),
        other => panic!("the schema speaks of `{other}`"),
    }
}

/// Whether a value fits; as much of JSON Schema as our schema uses for the shape of things.
fn fits(root: &Value, schema: &Value, value: &Value) -> bool {
    if let Some(place) = schema.get("$ref").and_then(Value::as_str) {
        let target = root.pointer(place.trim_start_matches('#'));
        if !fits(root, target.expect("a definition"), value) {
            return false;
        }
    }
    schema.as_object().is_none_or(|rules| rules.iter().all(|(rule, with)| obeys(root, rules, (rule, with), value)))
}

fn obeys(root: &Value, rules: &Map<String, Value>, (rule, with): (&str, &Value), value: &Value) -> bool {
    let ways = || with.as_array().expect("a list of schemas").iter();
    let number = value.as_f64();
    match rule {
        "type" => is_of_type(with.as_str().expect("one type"), value),
        "const" => value == with,
        "enum" => ways().any(|allowed| allowed == value),
        "oneOf" => ways().filter(|way| fits(root, way, value)).count() == 1,
        "anyOf" => ways().any(|way| fits(root, way, value)),
        "not" => !fits(root, with, value),
        "required" => ways().all(|key| value.get(key.as_str().expect("a key")).is_some()),
        "properties" => with
            .as_object()
            .expect("properties")
            .iter()
            .all(|(key, of)| value.get(key).is_none_or(|value| fits(root, of, value))),
        "additionalProperties" => value.as_object().is_none_or(|object| {
            let known = rules.get("properties").and_then(Value::as_object);
            object
                .iter()
                .filter(|(key, _)| !known.is_some_and(|known| known.contains_key(*key)))
                .all(|(_, value)| with.as_bool().unwrap_or_else(|| fits(root, with, value)))
        }),
        "items" => value.as_array().is_none_or(|list| list.iter().all(|value| fits(root, with, value))),
        "minItems" => value.as_array().is_none_or(|list| list.len() as u64 >= with.as_u64().expect("a count")),
        "maxItems" => value.as_array().is_none_or(|list| list.len() as u64 <= with.as_u64().expect("a count")),
        "exclusiveMinimum" => number.is_none_or(|number| number > with.as_f64().expect("a number")),
        "minimum" => number.is_none_or(|number| number >= with.as_f64().expect("a number")),
        "maximum" => number.is_none_or(|number| number <= with.as_f64().expect("a number")),
        "minLength" => value.as_str().is_none_or(|text| !text.is_empty()),
        "$ref" | "$schema" | "$defs" | "title" | "description" | "format" | "pattern" => true,
        other => panic!("the test does not know the rule `{other}`"),
    }
}

#[test]
fn every_embedded_scenario_fits() {
    let schema = schema();
    for name in embedded::names() {
        let text = embedded::text(name).expect("its text");
        let root = CstRootNode::parse(text, &ParseOptions::default()).expect("JSON with comments");
        let value = root.value().and_then(|value| value.to_serde_value()).expect("a value");
        assert!(fits(&schema, &schema, &value), "{name}");
    }
}

#[test]
fn what_the_decoder_refuses_does_not_fit() {
    let schema = schema();
    let base = json!({ "format": "stickslip/1", "title": "t", "nodes": { "A": [0, 0] } });
    assert!(fits(&schema, &schema, &base));
    let wrong = [
        json!({ "format": "stickslip/2" }),
        json!({ "title": "" }),
        json!({ "description": null }),
        json!({ "colour": "red" }),
        json!({ "nodes": { "A": [0] } }),
        json!({ "lcp": { "M": [[1]], "q": [1] } }),
        json!({ "materials": { "s": { "E": 0, "nu": 0.3 } } }),
        json!({ "sections": { "s": {} } }),
        json!({ "loads": { "w": { "items": [{ "point": { "at": "A", "force": [1, 0] }, "line": {} }] } } }),
        json!({ "contacts": [{ "id": "c", "node": "A", "edge": "p.top", "against": "ground", "normal": [0, 1] }] }),
        json!({ "plates": [{ "id": "p", "origin": [0, 0], "thickness": 1, "material": "s", "plane": "strain" }] }),
    ];
    for change in wrong {
        let mut value = base.clone();
        for (key, with) in change.as_object().expect("keys") {
            value[key] = with.clone();
        }
        assert!(!fits(&schema, &schema, &value), "{change}");
        assert!(load_text("t", &value.to_string(), None).is_err(), "{change}");
    }
}

/// The keys the decoder names when it meets one it does not know, in the plane or in space.
fn decoder_keys(source: &Value) -> BTreeSet<String> {
    let mut text = json!({ "format": "stickslip/1", "title": "t" });
    for (key, value) in source.as_object().expect("keys") {
        text[key] = value.clone();
    }
    let in_plane = keys_where_unknown(&text);
    if text.get("contact_system").or(text.get("lcp")).is_some() {
        return in_plane;
    }
    text["dimension"] = json!(3);
    in_plane.union(&keys_where_unknown(&text)).cloned().collect()
}

fn keys_where_unknown(text: &Value) -> BTreeSet<String> {
    let problems = load_text("t", &text.to_string(), None).expect_err("an unknown key");
    let help = problems
        .problems
        .iter()
        .find(|problem| problem.message.starts_with("unknown key \"zzz\""))
        .unwrap_or_else(|| panic!("{problems}"));
    let (_, keys) = help.help.split_once("known keys here: ").expect("the list");
    keys.split(", ").map(str::to_owned).collect()
}

/// The keys of the schema on the way that the source goes to `zzz`.
fn schema_keys(root: &Value, schema: &Value, value: &Value) -> Option<BTreeSet<String>> {
    let schema = resolved(root, schema);
    let properties = schema.get("properties").and_then(Value::as_object);
    if value.get("zzz").is_some()
        && let Some(properties) = properties
    {
        return Some(properties.keys().cloned().collect());
    }
    let deeper = match value {
        Value::Object(object) => object.iter().find_map(|(key, value)| {
            let next = properties.and_then(|known| known.get(key)).or_else(|| schema.get("additionalProperties"))?;
            schema_keys(root, next, value)
        }),
        Value::Array(list) => list.iter().find_map(|value| schema_keys(root, schema.get("items")?, value)),
        _ => None,
    };
    deeper.or_else(|| {
        ["oneOf", "anyOf"]
            .iter()
            .find_map(|way| schema.get(*way)?.as_array()?.iter().find_map(|way| schema_keys(root, way, value)))
    })
}

#[test]
fn schema_and_decoder_know_the_same_keys() {
    let schema = schema();
    let unknown = json!({ "zzz": 0 });
    let load = |kind: &str| json!({ "loads": { "w": { "items": [{ kind: { "zzz": 0 } }] } } });
    let system =
        |stiffness: Value| json!({ "contact_system": { "pairs": ["c"], "loads": {}, "stiffness": stiffness } });
    let mut places = vec![
        json!({ "zzz": 0, "nodes": {} }),
        json!({ "units": unknown, "nodes": {} }),
        json!({ "parameters": { "p": unknown }, "nodes": {} }),
        json!({ "solver": unknown, "nodes": {} }),
        json!({ "materials": { "m": unknown } }),
        json!({ "sections": { "s": unknown } }),
        json!({ "loads": { "w": unknown } }),
        json!({ "superelement": unknown }),
        json!({ "contact_system": unknown }),
        json!({ "contact_system": { "pairs": ["c"], "stiffness": [[1, 0], [0, 1]], "loads": { "w": unknown } } }),
        system(unknown.clone()),
        json!({ "lcp": unknown }),
    ];
    for list in [
        "bars",
        "plates",
        "bricks",
        "meshes",
        "triangles",
        "quads",
        "rigid",
        "ties",
        "supports",
        "springs",
        "foundations",
        "contacts",
    ] {
        places.push(json!({ list: [unknown] }));
    }
    for kind in ["point", "traction", "line", "gravity", "temperature", "strain", "pressure", "fluid"] {
        places.push(load(kind));
    }
    for place in places {
        let found = schema_keys(&schema, &schema, &place).unwrap_or_else(|| panic!("{place}"));
        assert_eq!(found, decoder_keys(&place), "{place}");
    }
    let kinds = decoder_keys(&json!({ "loads": { "w": { "items": [unknown] } } }));
    for kind in kinds {
        assert!(schema_keys(&schema, &schema, &load(&kind)).is_some(), "{kind}");
    }
}

/// What the decoder expects in place of the word `zzz`.
fn decoder_words(source: &Value) -> String {
    let mut text = json!({ "format": "stickslip/1", "title": "t" });
    for (key, value) in source.as_object().expect("keys") {
        text[key] = value.clone();
    }
    let problems = load_text("t", &text.to_string(), None).expect_err("an unknown word").problems;
    let unknown = |message: &str| message.starts_with("unknown") && message.contains("\"zzz\"");
    problems.into_iter().find(|problem| unknown(&problem.message)).expect("the word").help
}

/// The words of the schema on the way that the source goes to `zzz`.
fn schema_words(root: &Value, schema: &Value, value: &Value) -> Option<Vec<String>> {
    let schema = resolved(root, schema);
    if value == "zzz"
        && let Some(words) = schema.get("enum").and_then(Value::as_array)
    {
        return Some(words.iter().map(|word| word.as_str().expect("a word").to_owned()).collect());
    }
    let deeper = match value {
        Value::Object(object) => object.iter().find_map(|(key, value)| {
            let properties = schema.get("properties").and_then(|known| known.get(key));
            schema_words(root, properties.or_else(|| schema.get("additionalProperties"))?, value)
        }),
        Value::Array(list) => list.iter().find_map(|value| schema_words(root, schema.get("items")?, value)),
        _ => None,
    };
    let ways = ["oneOf", "anyOf"].iter().filter_map(|way| schema.get(*way)?.as_array()).flatten();
    deeper.or_else(|| ways.into_iter().find_map(|way| schema_words(root, way, value)))
}

#[test]
fn schema_and_decoder_know_the_same_words() {
    let schema = schema();
    let nodes = json!({ "A": [0, 0], "B": [1, 0] });
    let bar = |key: &str, word: Value| {
        let mut bar = json!({ "id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s" });
        bar[key] = word;
        json!({ "nodes": nodes, "bars": [bar] })
    };
    let plate = |key: &str| json!({ "plates": [{ "id": "p", key: "zzz" }] });
    let contact = |key: &str| json!({ "nodes": nodes, "contacts": [{ "id": "c", "node": "A", key: "zzz" }] });
    for place in [
        bar("kind", json!("zzz")),
        bar("hinges", json!(["zzz"])),
        plate("plane"),
        plate("element"),
        contact("law"),
        json!({ "nodes": nodes, "supports": [{ "at": "A", "fixed": ["zzz"] }] }),
        json!({ "nodes": nodes, "loads": { "w": { "items": [{ "line": { "bar": "AB", "axes": "zzz" } }] } } }),
        json!({ "nodes": nodes, "solver": { "covering": "zzz" } }),
        json!({ "nodes": nodes, "solver": { "engine": "zzz" } }),
    ] {
        let words = schema_words(&schema, &schema, &place).unwrap_or_else(|| panic!("{place}"));
        let expected = decoder_words(&place);
        let listed = expected.split([',', ' ']).filter(|word| words.iter().any(|known| known == word)).count();
        assert_eq!(listed, words.len(), "{place}: {words:?}, {expected}");
        assert_eq!(expected, format!("expected {}", crate::model::words::listed(&refs(&words))), "{place}");
    }
}

fn refs(words: &[String]) -> Vec<&str> {
    words.iter().map(String::as_str).collect()
}
