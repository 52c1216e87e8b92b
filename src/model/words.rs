//! Names in messages and names as ids.

/// A text of the user in quotation marks, shortened, control characters made visible.
pub fn quoted(text: &str) -> String {
    const LONGEST: usize = 40;
    let short: String = text.chars().take(LONGEST).collect();
    let dots = if short.len() < text.len() { "…" } else { "" };
    format!("\"{}{dots}\"", short.escape_debug().to_string().replace("\\'", "'").replace("\\\"", "\""))
}

/// `a, b or c`; at most ten, then how many more.
pub fn listed(names: &[&str]) -> String {
    const MOST: usize = 10;
    if names.len() > MOST {
        return format!("one of {} and {} more", names[..MOST].join(", "), names.len() - MOST);
    }
    match names {
        [] => "nothing".into(),
        [one] => one.to_string(),
        [all @ .., last] => format!("{} or {last}", all.join(", ")),
    }
}

/// ` (did you mean "a" or "b"?)` for the known names nearest to a word of a file, or nothing if none is near.
pub fn did_you_mean<'n>(word: &str, known: impl IntoIterator<Item = &'n str>) -> String {
    suggestion(&near(word, known), '"')
}

/// The same of a word of a command, in the marks in which such words stand.
pub fn did_you_mean_typed<'n>(word: &str, known: impl IntoIterator<Item = &'n str>) -> String {
    suggestion(&near(word, known), '`')
}

/// "no pair `jiont[0]` (did you mean `joint[0]`?): the pairs are c1, c2".
pub fn no_such<'n>(what: &str, id: &str, known: impl IntoIterator<Item = &'n str>) -> String {
    let names: Vec<&str> = known.into_iter().collect();
    // Any two names of two letters are near each other.
    let near = if id.chars().count() > 2 { did_you_mean_typed(id, names.iter().copied()) } else { String::new() };
    match names.as_slice() {
        [] => format!("no {what} `{id}`: there is none"),
        [only] => format!("no {what} `{id}`{near}: the only {what} is {only}"),
        names => {
            let shown = match names {
                [first, .., last] if names.len() > most_listed(names) => format!("{first} … {last}"),
                names => names.join(", "),
            };
            // of two kinds of things the last word alone would have its plural
            let are = if what.contains(" or ") { "there are".to_owned() } else { format!("the {what}s are") };
            format!("no {what} `{id}`{near}: {are} {shown}")
        }
    }
}

/// How many names are all listed: of pairs and nodes with an index the ends tell the rest.
fn most_listed(names: &[&str]) -> usize {
    if names.iter().any(|name| name.contains('[')) { 8 } else { 24 }
}

fn suggestion(near: &[&str], mark: char) -> String {
    let names: Vec<String> = near.iter().map(|name| format!("{mark}{name}{mark}")).collect();
    if names.is_empty() { String::new() } else { format!(" (did you mean {}?)", names.join(" or ")) }
}

/// The known names that a mistyped one may stand for, all as near to it; else those that it begins. In alphabetical
/// order; none where there are more than three, which would tell nothing.
pub fn near<'n>(word: &str, known: impl IntoIterator<Item = &'n str>) -> Vec<&'n str> {
    const MOST: usize = 3;
    let length = word.chars().count();
    if length > 60 {
        return Vec::new();
    }
    let word = word.to_lowercase();
    let allowed = ((length + 1) / 3).max(1);
    let mut best = allowed;
    let (mut nearest, mut begun) = (Vec::new(), Vec::new());
    for name in known {
        let lower = name.to_lowercase();
        if length > 1 && lower.starts_with(&word) {
            begun.push(name);
        }
        if lower.len().abs_diff(word.len()) > 4 * best {
            continue;
        }
        let distance = strsim::osa_distance(&word, &lower);
        if distance > best || distance >= length.min(name.chars().count()) {
            continue;
        }
        if distance < best {
            best = distance;
            nearest.clear();
        }
        nearest.push(name);
    }
    let mut found = if nearest.is_empty() { begun } else { nearest };
    found.sort_unstable();
    found.dedup();
    if found.len() > MOST { Vec::new() } else { found }
}

/// `1 entry`, `2 entries`.
pub fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// Whether this can be an id: letters, digits, `_`, `-`, starting with a letter.
pub fn is_id(text: &str) -> bool {
    text.starts_with(char::is_alphabetic) && text.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-')
}

/// What [`is_id`] asks for.
pub const ID_RULE: &str = "ids and names are letters, digits, `_` and `-`, starting with a letter";

/// A number as written, cut where it is very long.
pub fn shortened(literal: &str) -> String {
    if literal.len() <= 30 {
        literal.to_string()
    } else {
        // JSON numbers are ASCII, so any byte is a boundary.
        format!("{}…", &literal[..27])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_are_as_near_are_named() {
        assert_eq!(did_you_mean("lode", ["load", "bar", "node", "mode"]), r#" (did you mean "mode" or "node"?)"#);
        assert_eq!(did_you_mean_typed("piars", ["pairs", "params"]), " (did you mean `pairs`?)");
        assert_eq!(did_you_mean("F3", ["F2", "f", "F1"]), r#" (did you mean "F1" or "F2"?)"#);
        assert_eq!(did_you_mean("F3", ["F2", "F1", "F4", "F5"]), "");
        assert_eq!(near("fric", ["friction", "free"]), ["friction"]);
        assert!(near("x", ["y", "xyz"]).is_empty());
        assert!(near("", ["", "a"]).is_empty());
    }
}
