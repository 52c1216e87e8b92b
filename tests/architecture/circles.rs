//! No circle of files: a file takes nothing, on however long a way, from a file that takes something from it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use crate::{code, is_of_tests, sources, without_tests};

/// A module, as the names on the way to it.
type Module = Vec<String>;

/// The module that a file is.
fn module_of(path: &Path) -> Module {
    let mut names: Module =
        path.with_extension("").components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    if names.last().is_some_and(|last| last == "mod" || last == "lib") {
        names.pop();
    }
    names
}

/// The paths that `text` stands for: `a::{b, c::{d}}` is `a::b` and `a::c::d`.
fn spread(text: &str) -> Vec<String> {
    let Some((before, rest)) = text.split_once('{') else { return vec![text.trim().to_owned()] };
    let inside = rest.rsplit_once('}').map_or(rest, |(inside, _)| inside);
    let (mut parts, mut depth) = (vec![String::new()], 0);
    for c in inside.chars() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if c == ',' && depth == 0 {
            parts.push(String::new());
        } else if let Some(part) = parts.last_mut() {
            part.push(c);
        }
    }
    let before = before.trim();
    parts.iter().filter(|part| !part.trim().is_empty()).flat_map(|part| spread(&format!("{before}{part}"))).collect()
}

/// The innermost of the modules that are files in which the last name of a path stands.
fn taken_from(path: &str, own: &Module, files: &BTreeMap<Module, String>) -> Option<Module> {
    let mut names: Vec<&str> =
        path.split("::").map(|name| name.split_whitespace().next().unwrap_or_default()).collect();
    let mut way = match names[0] {
        "crate" => Module::new(),
        "self" | "super" => own.clone(),
        _ => return None,
    };
    let climbs = names.iter().take_while(|name| **name == "super").count();
    way.truncate(way.len().saturating_sub(climbs));
    names.drain(..climbs.max(1));
    (0..=names.len()).rev().find_map(|count| {
        let reached: Module = way.iter().cloned().chain(names[..count].iter().map(|name| (*name).to_owned())).collect();
        files.contains_key(&reached).then_some(reached)
    })
}

/// What the code of a module takes from other files.
fn taken(own: &Module, code: &str, files: &BTreeMap<Module, String>) -> BTreeSet<Module> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let mut paths = Vec::new();
    for root in ["crate::", "self::", "super::"] {
        for (at, _) in code.match_indices(root) {
            if code[..at].ends_with(is_name) {
                continue;
            }
            let rest = &code[at..];
            let end = rest.find(|c| !is_name(c)).unwrap_or(rest.len());
            let grouped = rest[..end].ends_with("::") && rest[end..].starts_with('{');
            let end = if grouped { rest.find(';').unwrap_or(rest.len()) } else { end };
            paths.extend(spread(&rest[..end]));
        }
    }
    paths.iter().filter_map(|path| taken_from(path, own, files)).filter(|other| other != own).collect()
}

/// Files that take from one another: each such group, sorted.
fn circles(files: &BTreeMap<Module, String>) -> Vec<Vec<String>> {
    let taken: BTreeMap<&Module, BTreeSet<Module>> =
        files.iter().map(|(module, code)| (module, taken(module, code, files))).collect();
    let reached = |from: &Module| {
        let (mut seen, mut next): (BTreeSet<&Module>, Vec<&Module>) = (BTreeSet::new(), vec![from]);
        while let Some(module) = next.pop() {
            for (other, _) in taken[module].iter().filter_map(|other| taken.get_key_value(other)) {
                if seen.insert(*other) {
                    next.push(*other);
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&Module, BTreeSet<&Module>> = taken.keys().map(|module| (*module, reached(module))).collect();
    let groups: BTreeSet<Vec<String>> = reached
        .iter()
        .filter(|(module, there)| there.contains(*module))
        .map(|(module, there)| {
            there.iter().filter(|other| reached[**other].contains(module)).map(|other| other.join("::")).collect()
        })
        .collect();
    groups.into_iter().collect()
}

#[test]
fn no_files_take_from_one_another() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut paths = Vec::new();
    sources(&root, &mut paths);
    let files: BTreeMap<Module, String> = paths
        .iter()
        .map(|path| (path.strip_prefix(&root).unwrap(), path))
        .filter(|(inside, _)| !is_of_tests(inside))
        .map(|(inside, path)| (module_of(inside), without_tests(&code(&fs::read_to_string(path).unwrap()))))
        .collect();
    assert!(files.len() > 20, "the sources were not found");
    let wrong: Vec<String> = circles(&files).iter().map(|circle| circle.join(", ")).collect();
    assert!(wrong.is_empty(), "files that take from one another:\n{}", wrong.join("\n"));
}

#[test]
fn a_circle_is_found_in_every_spelling() {
    let judge = |texts: &[(&str, &str)]| {
        let files = texts.iter().map(|(path, text)| (module_of(Path::new(path)), without_tests(&code(text)))).collect();
        circles(&files)
    };
    let names = |circle: &[&str]| vec![circle.iter().map(|name| (*name).to_owned()).collect::<Vec<String>>()];
    assert_eq!(
        judge(&[("a/b.rs", "use super::c::C;"), ("a/c.rs", "fn f() -> crate::a::b::B {}")]),
        names(&["a::b", "a::c"])
    );
    assert_eq!(
        judge(&[
            ("a.rs", "use crate::{x::Y, b::{C, d::E}};"),
            ("b/d.rs", "use crate::c::f;"),
            ("c.rs", "use self::g;\nuse super::a::h;")
        ]),
        names(&["a", "b::d", "c"])
    );
    assert_eq!(judge(&[("a/mod.rs", "pub use self::b::B;"), ("a/b.rs", "use super::Part;")]), names(&["a", "a::b"]));
    let straight =
        [("a/mod.rs", "pub use self::b::B;"), ("a/b.rs", "use super::c::C;"), ("a/c.rs", "fn f() {} // crate::a::b")];
    assert_eq!(judge(&straight), Vec::<Vec<String>>::new());
    let tested = [("a.rs", "use crate::b::B;"), ("b.rs", "#[cfg(test)]\nmod tests { use crate::a::A; }")];
    assert_eq!(judge(&tested), Vec::<Vec<String>>::new());
}
