//! No function is longer than 100 lines and no file longer than 500, tests included: what is longer holds two ideas.

use std::fs;
use std::path::Path;

use crate::{code, sources};

const MOST_OF_A_FILE: usize = 500;
const MOST_OF_A_FUNCTION: usize = 100;

/// The functions of a code without comments and strings that have a body: (name, first line, lines).
fn functions(code: &str) -> Vec<(String, usize, usize)> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices("fn ") {
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        let rest = &code[at..];
        let name: String = rest[3..].chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        // The body is the first block outside all brackets; a semicolon there ends a function without one.
        let (mut brackets, mut braces) = (0, 0);
        let end = rest.char_indices().find(|(_, c)| {
            match c {
                '(' | '[' => brackets += 1,
                ')' | ']' => brackets -= 1,
                '{' => braces += 1,
                '}' => braces -= 1,
                _ => {}
            }
            brackets == 0 && braces == 0 && matches!(c, ';' | '}')
        });
        if let Some((end, '}')) = end {
            let line = code[..at].matches('\n').count() + 1;
            found.push((name, line, rest[..end].matches('\n').count() + 1));
        }
    }
    found
}

/// What of a file is too long.
fn too_long(path: &str, text: &str) -> Vec<String> {
    let lines = text.lines().count();
    let file = (lines > MOST_OF_A_FILE).then(|| format!("{path}: {lines} lines, at most {MOST_OF_A_FILE}"));
    let long = functions(&code(text)).into_iter().filter(|(_, _, lines)| *lines > MOST_OF_A_FUNCTION);
    let long = long.map(|(name, line, lines)| {
        format!(
            "{path}:{line}: `{name}` has {lines} lines, at most {MOST_OF_A_FUNCTION}: split it where its ideas part"
        )
    });
    file.into_iter().chain(long).collect()
}

#[test]
fn no_file_and_no_function_is_too_long() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    for folder in ["src", "numerics", "tests", "examples", "benches", "fuzz"] {
        sources(&root.join(folder), &mut files);
    }
    assert!(files.len() > 20, "the sources were not found");
    let judge =
        |file: &Path| too_long(&file.strip_prefix(root).unwrap().to_string_lossy(), &fs::read_to_string(file).unwrap());
    let wrong: Vec<String> = files.iter().flat_map(|file| judge(file)).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn what_is_too_long_is_found() {
    let body = |lines: usize| format!("    f(\"}}\"); // }}\n{}", "    g();\n".repeat(lines - 3));
    let function = |head: &str, lines: usize| format!("{head} {{\n{}}}\n", body(lines));
    for head in ["fn a()", "pub(super) fn a(x: [f64; 2]) -> Vec<[f64; 2]>", "fn a<'a, T>(x: &'a T) where T: Clone"] {
        assert_eq!(too_long("a.rs", &function(head, 100)), Vec::<String>::new(), "{head}");
        let long = too_long("a.rs", &format!("trait B {{ fn b(&self); }}\n{}", function(head, 101)));
        assert_eq!(long.len(), 1, "{head}: {long:?}");
        assert!(long[0].starts_with("a.rs:2: `a` has 101 lines"), "{long:?}");
    }
    assert_eq!(functions("type F = fn (f64) -> f64; fn a() { }").len(), 1);
    assert_eq!(too_long("a.rs", &"// x\n".repeat(500)).len(), 0);
    assert_eq!(too_long("a.rs", &"// x\n".repeat(501)).len(), 1);
}
