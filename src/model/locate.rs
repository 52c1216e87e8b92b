//! A JSON text as a tree with places: offset ↔ line and column, offset ↔ JSON path.

use jsonc_parser::errors::ParseErrorKind;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};

use super::tree::{Kind, Node, Tree};

/// JSON with comments and trailing commas, nothing else.
const OPTIONS: ParseOptions = ParseOptions {
    allow_comments: true,
    allow_loose_object_property_names: false,
    allow_trailing_commas: true,
    allow_missing_commas: false,
    allow_single_quoted_strings: false,
    allow_hexadecimal_numbers: false,
    allow_unary_plus_numbers: false,
    allow_bare_decimal_point_numbers: false,
    allow_non_finite_numbers: false,
    allow_extended_string_escapes: false,
};

/// A parsed JSON text.
pub struct Document<'t> {
    text: &'t str,
    tree: Tree<'t>,
}

/// A text that is not JSON: where and why.
pub struct SyntaxError {
    /// Byte offset.
    pub offset: usize,
    /// What was found.
    pub message: String,
    /// What to do.
    pub help: &'static str,
}

impl<'t> Document<'t> {
    /// Parses JSON in which comments and trailing commas may stand.
    pub fn parse(text: &'t str) -> Result<Self, SyntaxError> {
        if text.starts_with('\u{feff}') {
            return Err(SyntaxError {
                offset: 0,
                message: "not JSON: the file starts with a byte order mark".into(),
                help: "save the file as UTF-8 without BOM",
            });
        }
        match Tree::read(text) {
            Some(tree) => Ok(Document { text, tree }),
            None => Err(syntax_error(text)),
        }
    }

    /// The outermost value.
    pub fn root(&self) -> Node<'_> {
        self.tree.root()
    }

    /// The values without their places.
    pub fn value(&self) -> serde_json::Value {
        // It was parsed before; what overflows f64 was refused.
        serde_json::from_str(&strict(self.text)).unwrap_or_default()
    }

    /// JSON path of the value, or of the key, that starts at this byte offset.
    pub fn path_at(&self, offset: usize) -> String {
        let mut path = String::new();
        let mut value = self.root();
        while value.start() != offset {
            match value.kind() {
                Kind::Object => {
                    let Some((key, inner)) = value.properties().take_while(|(key, _)| key.start() <= offset).last()
                    else {
                        break;
                    };
                    push_key(&mut path, key.as_str().unwrap_or_default());
                    if key.start() == offset {
                        break;
                    }
                    value = inner;
                }
                Kind::Array => {
                    let before = value.items().enumerate().take_while(|(_, item)| item.start() <= offset);
                    let Some((index, item)) = before.last() else {
                        break;
                    };
                    path.push_str(&format!("[{index}]"));
                    value = item;
                }
                _ => break,
            }
        }
        path
    }

    /// Byte offset of the value at a JSON path as [`Document::path_at`] writes it; of the nearest value around it
    /// where the path leads nowhere.
    pub fn offset_of(&self, path: &str) -> usize {
        let mut here = String::new();
        let mut value = self.root();
        while here != path {
            let next = match value.kind() {
                Kind::Object => value.properties().find_map(|(key, inner)| {
                    let mut child = here.clone();
                    push_key(&mut child, key.as_str().unwrap_or_default());
                    leads_to(&child, path).then_some((child, inner))
                }),
                Kind::Array => path
                    .strip_prefix(here.as_str())
                    .and_then(|rest| rest.strip_prefix('['))
                    .and_then(|rest| rest.split_once(']'))
                    .and_then(|(digits, _)| digits.parse::<usize>().ok())
                    .and_then(|index| Some((format!("{here}[{index}]"), value.items().nth(index)?))),
                _ => None,
            };
            let Some((child, inner)) = next else { break };
            here = child;
            value = inner;
        }
        value.start()
    }

    /// Line and column of a byte offset.
    pub fn position(&self, offset: usize) -> (usize, usize) {
        position(self.text, offset)
    }
}

/// What is wrong with a text that is not JSON, in the words of a parser that says more; what that one forgives, in those
/// of another.
fn syntax_error(text: &str) -> SyntaxError {
    match parse_to_ast(text, &CollectOptions::default(), &OPTIONS) {
        Err(error) => SyntaxError {
            offset: error.range().start.min(text.len()),
            message: format!("not JSON: {}", lower_first(&error.kind().to_string())),
            help: advice(error.kind(), &text[error.range().start.min(text.len())..]),
        },
        Ok(result) if result.value.is_none() => SyntaxError {
            offset: 0,
            message: "not JSON: the file is empty".into(),
            help: "a scenario is a JSON object: { \"format\": \"stickslip/1\", … }",
        },
        Ok(_) => match serde_json::from_str::<serde::de::IgnoredAny>(&strict(text)) {
            Err(error) => {
                let (line, column) = (error.line(), error.column());
                let message = error.to_string();
                let message = message.strip_suffix(&format!(" at line {line} column {column}")).unwrap_or(&message);
                SyntaxError {
                    offset: offset_of_line(text, line, column),
                    message: format!("not JSON: {message}"),
                    help: SYNTAX,
                }
            }
            // Half of a character that is written in two (\u), values in one another too deep, or 4 GiB.
            Ok(_) => SyntaxError { offset: 0, message: "not JSON that can be read here".into(), help: SYNTAX },
        },
    }
}

/// The text with blanks in place of comments and trailing commas, so that every byte keeps its place.
fn strict(text: &str) -> std::borrow::Cow<'_, str> {
    let bytes = text.as_bytes();
    let mut blank: Vec<std::ops::Range<usize>> = Vec::new();
    let mut comma = None;
    let mut at = 0;
    while at < bytes.len() {
        let rest = &bytes[at..];
        let length = match rest {
            [b'"', ..] => {
                let mut end = 1;
                while end < rest.len() && rest[end] != b'"' {
                    end += if rest[end] == b'\\' { 2 } else { 1 };
                }
                end + 1
            }
            [b'/', b'/', ..] => rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(rest.len()),
            [b'/', b'*', ..] => text[at + 2..].find("*/").map_or(rest.len(), |end| end + 4),
            _ => 1,
        };
        match rest[0] {
            b'/' => blank.push(at..at + length),
            b',' => comma = Some(at),
            b'}' | b']' => blank.extend(comma.take().map(|at| at..at + 1)),
            byte if !byte.is_ascii_whitespace() => comma = None,
            _ => {}
        }
        at += length;
    }
    if blank.is_empty() {
        return text.into();
    }
    let mut strict = bytes.to_vec();
    for range in blank {
        // Line ends stay: the place of what is wrong is counted in lines.
        strict[range].iter_mut().filter(|byte| !matches!(byte, b'\n' | b'\r')).for_each(|byte| *byte = b' ');
    }
    // Whole characters were replaced, so it still is UTF-8.
    String::from_utf8(strict).unwrap_or_default().into()
}

/// Line and column, in characters and from 1, of a byte offset.
pub fn position(text: &str, offset: usize) -> (usize, usize) {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    let before = &text[..offset];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = before.bytes().filter(|&byte| byte == b'\n').count() + 1;
    (line, before[line_start..].chars().count() + 1)
}

/// Appends a key to a JSON path: `.key`, or `["key"]` where the key is not a plain word.
fn push_key(path: &mut String, key: &str) {
    let plain = !key.is_empty() && key.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-');
    if !plain {
        path.push_str(&format!("[{key:?}]"));
    } else {
        if !path.is_empty() {
            path.push('.');
        }
        path.push_str(key);
    }
}

fn leads_to(child: &str, path: &str) -> bool {
    path.strip_prefix(child).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

fn offset_of_line(text: &str, line: usize, column: usize) -> usize {
    let start: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    (start + column.saturating_sub(1)).min(text.len())
}

fn lower_first(message: &str) -> String {
    let mut characters = message.chars();
    match characters.next() {
        Some(first) if message != "Infinity and NaN are not allowed" => {
            first.to_lowercase().chain(characters).collect()
        }
        _ => message.to_string(),
    }
}

const SYNTAX: &str = "correct the JSON here, or just before this place";

fn advice(kind: &ParseErrorKind, rest: &str) -> &'static str {
    match kind {
        _ if ["NaN", "Infinity", "-Infinity", "nan", "inf", "-inf"].iter().any(|word| rest.starts_with(word)) => {
            "every number of a scenario is finite"
        }
        ParseErrorKind::ExpectedComma => "put a comma between the entries",
        ParseErrorKind::NonFiniteNumbersNotAllowed => "every number of a scenario is finite",
        ParseErrorKind::SingleQuotedStringsNotAllowed | ParseErrorKind::ExpectedStringObjectProperty => {
            "write keys and words in \"…\""
        }
        ParseErrorKind::MultipleRootJsonValues => "a scenario is one JSON object and nothing after it",
        ParseErrorKind::UnterminatedArray => "close the list with `]`",
        ParseErrorKind::UnterminatedObject => "close the object with `}`",
        _ => SYNTAX,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A text of JSON by two other parsers, which both know more than one of its rules.
    fn is_json(text: &str) -> bool {
        let is_parsed =
            parse_to_ast(text, &CollectOptions::default(), &OPTIONS).is_ok_and(|found| found.value.is_some());
        is_parsed && serde_json::from_str::<serde::de::IgnoredAny>(&strict(text)).is_ok()
    }

    const PIECES: [&str; 40] = [
        "{",
        "}",
        "[",
        "]",
        ",",
        ":",
        "\"",
        "\\",
        "\"a\"",
        "\"\\n\"",
        "\"\\x\"",
        "\"\\u00e9\"",
        "\"\\u00\"",
        "\"é\"",
        "\"\t\"",
        "\"a\":",
        "0",
        "-",
        "1",
        "12",
        "01",
        ".",
        ".5",
        "e3",
        "E+2",
        "-0.5e-7",
        "true",
        "nul",
        "null",
        "falsey",
        " ",
        "\n",
        "\u{b}",
        "\u{a0}",
        "// c\n",
        "/* c */",
        "/*/",
        "*/",
        "'a'",
        "+1",
    ];

    const TEXTS: [&str; 4] = [
        r#"{"a":[1,-2.5e3,[],{}],"b":{"c":null,"d":[true,false]},"":"x\n\"y\"" }"#,
        "{ /* first */ \"a\": [1, \"b\\n\",],\n // x\n \"c\": { \"d\": 4 } , }",
        "[[0,1.25],[1E5,-0.0e+1]]",
        "7",
    ];

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn a_text_is_read_where_others_read_it(
            text in prop::sample::select(TEXTS.to_vec()),
            changes in prop::collection::vec((any::<prop::sample::Index>(), 0..3_usize, prop::sample::select(PIECES.to_vec())), 0..4),
        ) {
            let mut text = text.to_owned();
            for (at, length, piece) in changes {
                let from = at.index(text.len() + 1);
                let to = (from + length).min(text.len());
                if text.is_char_boundary(from) && text.is_char_boundary(to) {
                    text.replace_range(from..to, piece);
                }
            }
            prop_assert_eq!(Tree::read(&text).is_some(), is_json(&text), "{}", text);
        }
    }

    #[test]
    fn a_comment_begins_anew_behind_its_first_two_characters() {
        assert_eq!(strict("[1 /*/ , */]"), "[1         ]");
    }
}
