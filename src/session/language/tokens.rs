//! A line → its commands → their words: `;` separates commands, `#` begins a comment, quotes keep both.

use thiserror::Error;

/// A line that cannot be split into words.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("a quotation mark or a backslash at the end of `{0}` is left open: close it, or quote the mark itself")]
pub struct OpenQuote(pub String);

/// Where a word of the language stands in what follows a command. The first word is a name, whatever it is.
pub fn place_of<T: AsRef<str>>(words: &[T], word: &str) -> Option<usize> {
    (1..words.len()).find(|&at| words[at].as_ref() == word)
}

/// Where a character stands while a line is read from the left.
#[derive(Clone, Copy, PartialEq)]
enum Quote {
    None,
    Single,
    Double,
}

/// The commands of a line, each with its comment cut off and without surrounding blanks; blank ones are left out.
///
/// `#` begins a comment only at the start of a word, as in a shell. A byte order mark, which some editors put before the first
/// line of a file, is none of its characters.
pub fn commands(line: &str) -> Vec<&str> {
    let line = line.strip_prefix('\u{feff}').unwrap_or(line);
    spans(line).into_iter().map(|(start, end)| line[start..end].trim()).filter(|command| !command.is_empty()).collect()
}

/// Byte ranges of the commands of a line, comments excluded, blanks included. Always at least one.
pub fn spans(line: &str) -> Vec<(usize, usize)> {
    let mut spans = Vec::new();
    let mut start = 0;
    let mut quote = Quote::None;
    let mut escaped = false;
    let mut word_start = true;
    for (at, c) in line.char_indices() {
        let new_word = word_start;
        word_start = false;
        if escaped {
            escaped = false;
            continue;
        }
        match (quote, c) {
            (Quote::Single, '\'') | (Quote::Double, '"') => quote = Quote::None,
            (Quote::Single, _) => {}
            (_, '\\') => escaped = true,
            (Quote::Double, _) => {}
            (Quote::None, '\'') => quote = Quote::Single,
            (Quote::None, '"') => quote = Quote::Double,
            (Quote::None, ';') => {
                spans.push((start, at));
                start = at + 1;
                word_start = true;
            }
            (Quote::None, '#') if new_word => {
                spans.push((start, at));
                return spans;
            }
            (Quote::None, c) => word_start = c.is_whitespace(),
        }
    }
    spans.push((start, line.len()));
    spans
}

/// The words of one command, quotes removed.
///
/// # Errors
/// [`OpenQuote`] where a quotation is not closed.
pub fn split(command: &str) -> Result<Vec<String>, OpenQuote> {
    // Any blank separates words here, not only the ASCII ones that a shell knows.
    let plain: String = command.chars().map(|c| if c.is_whitespace() || c == '\0' { ' ' } else { c }).collect();
    shlex::split(&plain).ok_or_else(|| OpenQuote(command.to_owned()))
}

/// A word written so that [`split`] gives it back.
pub fn quote(word: &str) -> String {
    let clean: String = word.chars().filter(|c| *c != '\0').collect();
    if clean.is_empty() {
        return "\"\"".to_owned();
    }
    let plain = |c: char| c.is_alphanumeric() || "_-./,:+=*<>%[]±^~@".contains(c);
    if clean.chars().all(plain) {
        return clean;
    }
    let mut quoted = String::with_capacity(clean.len() + 2);
    quoted.push('"');
    for c in clean.chars() {
        if matches!(c, '"' | '\\' | '$' | '`') {
            quoted.push('\\');
        }
        quoted.push(c);
    }
    quoted.push('"');
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn semicolons_separate_and_comments_end() {
        assert_eq!(commands("set f 0.3 ; pairs;;  # all; of them"), ["set f 0.3", "pairs"]);
        assert!(commands("   # nothing").is_empty());
        assert_eq!(commands("echo a#b"), ["echo a#b"]);
    }

    #[test]
    fn quotes_keep_both() {
        assert_eq!(commands(r#"echo "a;b # c" ; echo 'd;e'"#), [r#"echo "a;b # c""#, "echo 'd;e'"]);
        assert_eq!(split(r#"echo "a;b # c""#).unwrap(), ["echo", "a;b # c"]);
        assert_eq!(commands(r"echo \;x"), [r"echo \;x"]);
    }

    #[test]
    fn an_open_quote_is_told() {
        assert!(split("echo \"a").is_err());
        assert!(split("echo a\\").is_err());
    }

    #[test]
    fn quoted_words_come_back() {
        for word in ["a", "", "a b", "a\"b", "it's; # `$x\\", "ü[0,8]", "a\tb"] {
            let line = format!("echo {}", quote(word));
            let one = commands(&line);
            assert_eq!(one.len(), 1, "{line}");
            assert_eq!(split(one[0]).unwrap(), ["echo", &word.replace('\t', " ")], "{line}");
        }
    }
}
