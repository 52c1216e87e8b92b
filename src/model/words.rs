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

/// ": did you mean "…"?" for the nearest known name, or nothing if none is near.
pub fn did_you_mean<'n>(word: &str, known: impl IntoIterator<Item = &'n str>) -> String {
    match nearest(word, known) {
        Some(name) => format!(": did you mean \"{name}\"?"),
        None => String::new(),
    }
}

/// The known name nearest to a mistyped one.
pub fn nearest<'n>(word: &str, known: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    let length = word.chars().count();
    if length > 60 {
        return None;
    }
    let allowed = (length / 3).max(1);
    known
        .into_iter()
        .filter(|name| name.len().abs_diff(word.len()) <= 4 * allowed)
        .map(|name| {
            let distance = strsim::osa_distance(&word.to_lowercase(), &name.to_lowercase());
            (distance, name)
        })
        .filter(|(distance, name)| *distance <= allowed && *distance < length.min(name.chars().count()))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
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
