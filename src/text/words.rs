//! Numbers and lists in running text.

/// A number with four significant digits, no more zeros than needed: `133.3`, `50.0`, `8.333`, `1.234e-7`.
pub fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let exponent = value.abs().log10().floor();
    if !(-4.0..6.0).contains(&exponent) {
        return format!("{value:.3e}");
    }
    let decimals = (3.0 - exponent).clamp(0.0, 8.0) as usize;
    let text = format!("{value:.decimals$}");
    if !text.contains('.') {
        return text;
    }
    let trimmed = text.trim_end_matches('0');
    if trimmed.ends_with('.') { format!("{trimmed}0") } else { trimmed.to_owned() }
}

/// `a`, `a and b`, `a, b and c`.
pub fn list(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [head @ .., last] => format!("{} and {last}", head.join(", ")),
    }
}

/// So many ids a sentence names.
const NAMED: usize = 6;

/// `a, b and c`; of more than six the first, and how many more: `a, b, c, d, e, f and 3 more`.
pub fn some(ids: &[&str]) -> String {
    let (named, more) = ids.split_at(ids.len().min(NAMED));
    let more = (!more.is_empty()).then(|| format!("{} more", more.len()));
    list(&named.iter().map(|id| (*id).to_owned()).chain(more).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::{list, short, some};

    #[test]
    fn four_digits_and_no_more_zeros_than_needed() {
        for (value, text) in [
            (133.333_333, "133.3"),
            (50.0, "50.0"),
            (22.222_2, "22.22"),
            (8.333_333, "8.333"),
            (0.0, "0"),
            (1.0, "1.0"),
            (123_456.7, "123457"),
            (1.2346e-7, "1.235e-7"),
            (-0.5, "-0.5"),
        ] {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn lists_read_as_a_person_writes_them() {
        let words = ["a", "b", "c"].map(str::to_owned);
        assert_eq!(list(&words), "a, b and c");
        assert_eq!(list(&words[..2]), "a and b");
        assert_eq!(list(&words[..1]), "a");
        assert_eq!(some(&["a", "b", "c", "d", "e", "f"]), "a, b, c, d, e and f");
        assert_eq!(some(&["a", "b", "c", "d", "e", "f", "g", "h"]), "a, b, c, d, e, f and 2 more");
    }
}
