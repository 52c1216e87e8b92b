//! The way of the data is the order of the folders: a module may import only what stands before it. And only faces
//! print, and nothing grows too long. Only a test keeps such a promise. (Test code inside `src` is left alone.)

mod circles;
mod sizes;

use std::fs;
use std::path::{Path, PathBuf};

/// What every module may import: they know nothing of ours.
const GROUND: &[&str] = &["text", "watch", "doubled"];

/// Every top module with what it may import besides itself and the ground.
const ARROWS: &[(&str, &[&str])] = &[
    ("text", &[]),
    ("watch", &[]),
    ("doubled", &[]),
    ("signals", &[]),
    ("model", &[]),
    ("lcp", &[]),
    ("fem", &["model"]),
    ("contact", &["model", "fem", "lcp"]),
    ("answer", &["model", "fem", "contact", "lcp"]),
    ("explain", &["model", "fem", "contact", "lcp", "answer"]),
    ("solve", &["model", "fem", "contact", "lcp", "answer", "explain"]),
    ("path", &["model", "fem", "contact", "lcp", "answer", "explain", "solve"]),
    ("view", &["model", "fem", "contact", "lcp", "answer", "explain", "solve", "path"]),
    ("export", &["model", "fem", "contact", "lcp", "answer", "explain", "solve", "path"]),
    ("session", &["model", "fem", "contact", "lcp", "answer", "explain", "solve", "path", "view", "export"]),
    ("repl", &["session", "view", "export", "model", "signals"]),
    ("tui", &["session", "view", "export", "model", "signals"]),
    ("cli", &["session", "view", "export", "model", "signals"]),
];

/// These put results before the user; nothing else writes to the terminal.
const FACES: &[&str] = &["main", "cli", "repl", "tui"];

const PRINTS: &[&str] = &["println!", "print!", "eprintln!", "eprint!", "dbg!"];

/// The code of a file: comments, and the insides of strings and chars, turned to blanks (line breaks stay).
fn code(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let mut out = String::with_capacity(text.len());
    let mut i = 0;
    let blank = |c: char| if c == '\n' { '\n' } else { ' ' };
    while i < chars.len() {
        let next = chars.get(i + 1).copied().unwrap_or(' ');
        match chars[i] {
            '/' if next == '/' => {
                while i < chars.len() && chars[i] != '\n' {
                    out.push(' ');
                    i += 1;
                }
            }
            '/' if next == '*' => {
                let mut depth = 0;
                while i < chars.len() {
                    let pair = (chars[i], chars.get(i + 1).copied().unwrap_or(' '));
                    let step = match pair {
                        ('/', '*') => {
                            depth += 1;
                            2
                        }
                        ('*', '/') => {
                            depth -= 1;
                            2
                        }
                        _ => 1,
                    };
                    for c in &chars[i..(i + step).min(chars.len())] {
                        out.push(blank(*c));
                    }
                    i += step;
                    if depth == 0 {
                        break;
                    }
                }
            }
            'r' if (next == '"' || next == '#') && !out.ends_with(|c: char| c.is_alphanumeric() || c == '_') => {
                let hashes = chars[i + 1..].iter().take_while(|c| **c == '#').count();
                if chars.get(i + 1 + hashes) != Some(&'"') {
                    out.push('r'); // r#name
                    i += 1;
                    continue;
                }
                let close: String = format!("\"{}", "#".repeat(hashes));
                let rest: String = chars[i + 2 + hashes..].iter().collect();
                let inside = rest.find(&close).map_or(rest.len(), |at| at + close.len());
                let length = 2 + hashes + rest[..inside].chars().count();
                for c in &chars[i..i + length] {
                    out.push(blank(*c));
                }
                i += length;
            }
            '"' => {
                out.push(' ');
                i += 1;
                while i < chars.len() && chars[i] != '"' {
                    if chars[i] == '\\' {
                        out.push(' ');
                        i += 1;
                    }
                    out.push(blank(chars.get(i).copied().unwrap_or(' ')));
                    i += 1;
                }
                out.push(' ');
                i += 1;
            }
            '\'' if next == '\\' || chars.get(i + 2) == Some(&'\'') => {
                // A char literal, not a lifetime.
                let from = if next == '\\' { i + 3 } else { i + 2 };
                let end = (from..chars.len()).find(|k| chars[*k] == '\'').unwrap_or(chars.len() - 1);
                out.push_str(&" ".repeat(end + 1 - i));
                i = end + 1;
            }
            c => {
                out.push(c);
                i += 1;
            }
        }
    }
    out
}

/// The code without what stands under `#[cfg(test)]`.
fn without_tests(code: &str) -> String {
    let mut out = code.to_owned();
    while let Some(start) = out.find("#[cfg(test)]") {
        let rest = &out[start..];
        let brace = rest.find('{');
        let semicolon = rest.find(';').unwrap_or(rest.len() - 1);
        let end = match brace {
            Some(brace) if brace < semicolon => {
                let mut depth = 0;
                let close = rest[brace..].char_indices().find(|(_, c)| {
                    match c {
                        '{' => depth += 1,
                        '}' => depth -= 1,
                        _ => {}
                    }
                    depth == 0
                });
                brace + close.map_or(rest.len() - brace - 1, |(at, _)| at)
            }
            _ => semicolon,
        };
        let blanks: String = rest[..=end].chars().map(|c| if c == '\n' { '\n' } else { ' ' }).collect();
        out.replace_range(start..=start + end, &blanks);
    }
    out
}

/// The top module of a file of `src`, and how many modules deep it is (`src/model/pair.rs`: model, 2).
fn module(path: &Path) -> (String, usize) {
    let mut parts: Vec<String> =
        path.with_extension("").components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    if parts.len() > 1 && parts.last().is_some_and(|last| last == "mod") {
        parts.pop();
    }
    if parts == ["lib"] {
        return ("lib".into(), 0);
    }
    (parts[0].clone(), parts.len())
}

/// Top modules named from `at` on: `model::pair` gives model, `{model::pair, fem}` gives both.
fn named(code: &str, at: usize) -> Vec<String> {
    let rest = code[at..].trim_start();
    if !rest.starts_with('{') {
        let name: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        return vec![name];
    }
    let (mut names, mut depth, mut name, mut take) = (Vec::new(), 0, String::new(), true);
    for c in rest.chars() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 1 && (c.is_alphanumeric() || c == '_') {
            if take {
                name.push(c);
            }
        } else if depth == 1 && c == ':' || depth == 1 && c.is_whitespace() && !name.is_empty() {
            take = false;
        } else if depth == 0 || depth == 1 && c == ',' {
            if !name.is_empty() {
                names.push(std::mem::take(&mut name));
            }
            take = true;
            if depth == 0 {
                break;
            }
        }
    }
    names
}

/// Everything of ours that the code imports: (line, top module).
fn imports(code: &str, depth: usize) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let line = |at: usize| code[..at].matches('\n').count() + 1;
    let boundary = |at: usize| !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':' || c == '$');
    for root in ["crate::", "stickslip::"] {
        for (at, _) in code.match_indices(root) {
            if boundary(at) {
                for name in named(code, at + root.len()) {
                    found.push((line(at), name));
                }
            }
        }
    }
    // A chain of `super::` that climbs to the root: in a module `depth` deep, `depth` times (inside nested inline
    // modules one more each; those do not reach the root with fewer).
    for (at, _) in code.match_indices("super::") {
        if !boundary(at) {
            continue;
        }
        let mut climbs = 0;
        let mut rest = &code[at..];
        while let Some(after) = rest.strip_prefix("super::") {
            climbs += 1;
            rest = after;
        }
        if climbs == depth && depth > 0 {
            let names = named(code, code.len() - rest.len());
            // From an inline `mod tests` of a top file, `super::` is that file itself: only module names count.
            found.extend(
                names
                    .into_iter()
                    .filter(|name| ARROWS.iter().any(|(known, _)| known == name))
                    .map(|name| (line(at), name)),
            );
        }
    }
    found
}

/// Whether a file of `src` holds tests.
fn is_of_tests(path: &Path) -> bool {
    path.components().any(|part| part.as_os_str() == "tests" || part.as_os_str() == "tests.rs")
        || path.to_string_lossy().ends_with("_tests.rs")
}

/// Everything wrong with a file: `path` is relative to `src`.
fn complaints(path: &Path, text: &str) -> Vec<String> {
    let (top, depth) = module(path);
    // What tests import and print is their own affair.
    if is_of_tests(path) {
        return Vec::new();
    }
    let code = without_tests(&code(text));
    let mut wrong = Vec::new();
    let shown = path.display();
    if top != "lib" && top != "main" {
        match ARROWS.iter().find(|(name, _)| *name == top) {
            None => wrong.push(format!("src/{shown}: `{top}` has no place in the order of the modules")),
            Some((_, allowed)) => {
                for (line, name) in imports(&code, depth) {
                    let ours = name == top || GROUND.contains(&name.as_str()) || allowed.contains(&name.as_str());
                    if !ours {
                        wrong.push(format!("src/{shown}:{line}: `{top}` must not import `{name}`"));
                    }
                }
            }
        }
    }
    if !FACES.contains(&top.as_str()) {
        for print in PRINTS {
            for (at, _) in code.match_indices(print) {
                if !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
                    let line = code[..at].matches('\n').count() + 1;
                    wrong.push(format!("src/{shown}:{line}: only faces print, but here is `{print}`"));
                }
            }
        }
    }
    wrong
}

fn sources(folder: &Path, all: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, all);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            all.push(path);
        }
    }
}

#[test]
fn no_arrow_points_back_and_only_faces_print() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    files.sort();
    assert!(files.len() > 20, "the sources were not found");
    let wrong: Vec<String> = files
        .iter()
        .flat_map(|file| complaints(file.strip_prefix(&root).unwrap(), &fs::read_to_string(file).unwrap()))
        .collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn the_order_itself_has_no_cycle() {
    for (index, (name, allowed)) in ARROWS.iter().enumerate() {
        for import in *allowed {
            let place = ARROWS.iter().position(|(known, _)| known == import);
            assert!(place.is_some_and(|place| place < index), "{name} ← {import}");
        }
    }
}

#[test]
fn a_wrong_arrow_is_found_in_every_spelling() {
    let judge = |path: &str, text: &str| complaints(Path::new(path), text).len();
    for (path, line) in [
        ("lcp/lemke.rs", "use crate::model::pair::Law;"),
        ("model/pair.rs", "fn f() -> crate::fem::MainSystem { todo() }"),
        ("fem/dof.rs", "use crate::{model::pair::Joint, contact::system::ContactSystem};"),
        ("fem/dof.rs", "use crate::{\n    contact::{a, b},\n    model,\n};"),
        ("lcp/mod.rs", "use super::model::pair;"),
        ("lcp/lemke.rs", "use super::super::contact;"),
        ("lcp/deep/file.rs", "use super::super::super::contact::system;"),
        ("tui/panes/pairs.rs", "use crate::repl::Next;"),
        ("repl/mod.rs", "use crate::cli;"),
        ("cli.rs", "use crate::tui;"),
        ("cli.rs", "use crate::solve::prepare;"),
        ("contact/law.rs", "pub(crate) use crate::answer;"),
        ("answer/mod.rs", "use stickslip::view;"),
        ("newcomer/mod.rs", "fn f() {}"),
    ] {
        assert_eq!(judge(path, line), 1, "{path}: {line}");
    }
    for (path, line) in [
        ("lcp/lemke.rs", "use super::variable::Variable; // not crate::model"),
        ("lcp/lemke.rs", "/* crate::fem */ const A: &str = \"use crate::fem\";"),
        ("lcp/lemke.rs", "const A: &str = r#\"use crate::fem \" println!\"#; const B: char = '\"';"),
        ("fem/dof.rs", "use crate::{model::{pair::contact, structure}, watch::Watch};"),
        ("fem/dof.rs", "use super::contact_like::X; use crate::fem::error;"),
        ("model/pair.rs", "fn f<'a>(x: &'a str) -> char { '\\'' }"),
        ("main.rs", "use stickslip::cli; fn main() { println!(\"x\"); }"),
        ("lib.rs", "pub mod model; pub mod lcp;"),
        ("session/mod.rs", "use crate::{view, export, path, solve};"),
    ] {
        assert_eq!(judge(path, line), 0, "{path}: {line}: {:?}", complaints(Path::new(path), line));
    }
}

/// Where the word of a law is known: its definition, the decoder, and what it resolves to.
const KNOW_LAWS: &[&str] = &["model/pair.rs", "model/decode/", "contact/law.rs"];

/// Everywhere else a pair is what its two joints can do (`PairLaw`).
#[test]
fn the_words_of_laws_are_asked_for_in_few_places() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    let asks = |text: &str| {
        let code = without_tests(&code(text));
        let words = ["Coulomb", "Frictionless", "Bound"];
        words.iter().any(|word| code.contains(&format!("LawKind::{word}")) || code.contains(&format!("Law::{word}")))
    };
    assert!(asks("match law { Law::Bound { bound } => bound }") && !asks("// LawKind::Bound"));
    let mut known = 0;
    for file in files {
        let path = file.strip_prefix(&root).unwrap();
        if is_of_tests(path) {
            continue;
        }
        let path = path.to_string_lossy().replace('\\', "/");
        if asks(&fs::read_to_string(&file).unwrap()) {
            assert!(KNOW_LAWS.iter().any(|place| path.starts_with(place)), "src/{path} asks for the word of a law");
            known += 1;
        }
    }
    assert!(known >= 3, "the sources were not found");
}

#[test]
fn a_print_is_found_outside_the_faces() {
    let judge = |path: &str, text: &str| complaints(Path::new(path), text).len();
    assert_eq!(judge("fem/dof.rs", "fn f() { println!(\"{}\", 1); }"), 1);
    assert_eq!(judge("view/table.rs", "fn f() { eprint!(\"x\") }"), 1);
    assert_eq!(judge("lib.rs", "fn f() { dbg!(1); }"), 1);
    assert_eq!(judge("repl/mod.rs", "fn f() { println!(); }"), 0);
    assert_eq!(judge("fem/dof.rs", "#[cfg(test)]\nmod tests { fn f() { println!(); } }"), 0);
    assert_eq!(judge("fem/dof.rs", "#[cfg(test)]\nmod tests { fn f() { } }\nfn g() { println!(); }"), 1);
    assert_eq!(judge("fem/tests/large.rs", "fn f() { println!(); }"), 0);
    assert_eq!(judge("fem/dof.rs", "fn f() { writeln!(out, \"println!\"); }"), 0);
}
