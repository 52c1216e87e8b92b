//! Numbers as an engineer reads them.

pub use crate::answer::rounding::{balance, denoised, largest};

/// Five significant digits; exponents are multiples of three and appear below 0.1 and from 1e5 on:
/// `36.442`, `0.50000`, `13.544e-3`, `210.00e6`. Zero is `0`; what is not finite is `n/a`.
pub fn engineering(value: f64) -> String {
    digits(value, -1..=4).unwrap_or_else(|| simple(value))
}

/// The same number for running text, without trailing zeros and with an exponent only below 1e-4 and from 1e6 on:
/// `0.005`, `133.33`, `42.61e-6`.
pub fn short(value: f64) -> String {
    match digits(value, -4..=5) {
        None => simple(value),
        Some(text) => {
            let (mantissa, exponent) = match text.split_once('e') {
                Some((mantissa, exponent)) => (mantissa, Some(exponent)),
                None => (text.as_str(), None),
            };
            let mantissa =
                if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
            match exponent {
                Some(exponent) => format!("{mantissa}e{exponent}"),
                None => mantissa.to_owned(),
            }
        }
    }
}

/// A number as it was given: the shortest decimal that reads back as the same number, with an exponent where it would
/// be long.
pub fn in_full(value: f64) -> String {
    if value == 0.0 || (1e-5..1e15).contains(&value.abs()) {
        (value + 0.0).to_string()
    } else if value.is_finite() {
        format!("{value:e}")
    } else {
        simple(value)
    }
}

/// A check figure: two significant digits with an exponent, `2.2e-16`.
pub fn residual(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return simple(value);
    }
    format!("{value:.1e}")
}

/// A number and its unit.
pub fn with_unit(number: &str, unit: Option<&str>) -> String {
    match unit {
        Some(unit) if !unit.is_empty() => format!("{number} {unit}"),
        _ => number.to_owned(),
    }
}

/// A number of a table whose quantity has the largest value `scale`: noise is `0`, and all numbers not much smaller
/// than the largest one have its power of ten, so that a glance tells large from small.
pub fn in_column(value: f64, scale: f64) -> String {
    aligned(denoised(value, scale), scale)
}

/// The same of a value that has been freed of its rounding already: beside a bound of 1e15 a force of 1 is no noise.
pub fn aligned(value: f64, scale: f64) -> String {
    let (Some((figures, exponent)), Some((_, largest))) = (figures(value), figures(scale)) else {
        return engineering(value);
    };
    let shared = power(largest, -1..=4);
    let least = if shared == 0 { -3 } else { -1 };
    if (least..=4).contains(&(exponent - shared)) {
        written(value, &figures, exponent, shared)
    } else {
        engineering(value)
    }
}

fn simple(value: f64) -> String {
    if value == 0.0 { "0" } else { "n/a" }.to_owned()
}

/// Five digits, plain while the exponent of ten lies in `plain`; `None` for zero and what is not finite.
fn digits(value: f64, plain: std::ops::RangeInclusive<i32>) -> Option<String> {
    let (figures, exponent) = figures(value)?;
    Some(written(value, &figures, exponent, power(exponent, plain)))
}

/// The power of ten that is written behind a number with this exponent: none, or a multiple of three.
fn power(exponent: i32, plain: std::ops::RangeInclusive<i32>) -> i32 {
    if plain.contains(&exponent) { 0 } else { exponent.div_euclid(3) * 3 }
}

/// Five figures and the exponent of the first one.
fn figures(value: f64) -> Option<(String, i32)> {
    if value == 0.0 || !value.is_finite() {
        return None;
    }
    // Rounding first: 99999.6 is 1.0000e5 and belongs to the next power.
    let scientific = format!("{:.4e}", value.abs());
    let (mantissa, exponent) = scientific.split_once('e')?;
    let figures = mantissa.chars().filter(char::is_ascii_digit).collect();
    Some((figures, exponent.parse().ok()?))
}

/// The figures with their point, sign and power.
fn written(value: f64, figures: &str, exponent: i32, power: i32) -> String {
    let before = exponent - power + 1;
    let mut text = String::new();
    if value < 0.0 {
        text.push('-');
    }
    if before <= 0 {
        text.push_str("0.");
        text.push_str(&"0".repeat(before.unsigned_abs() as usize));
        text.push_str(figures);
    } else {
        let before = before as usize;
        text.push_str(&figures[..before.min(figures.len())]);
        if before < figures.len() {
            text.push('.');
            text.push_str(&figures[before..]);
        } else {
            text.push_str(&"0".repeat(before - figures.len()));
        }
    }
    if power != 0 {
        text.push_str(&format!("e{power}"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn engineering_has_five_digits_and_exponents_of_three() {
        let cases = [
            (36.44231, "36.442"),
            (0.013544, "13.544e-3"),
            (0.5, "0.50000"),
            (100.0, "100.00"),
            (-1234.56, "-1234.6"),
            (12345.6, "12346"),
            (99999.6, "100.00e3"),
            (2.1e8, "210.00e6"),
            (9.99996, "10.000"),
            (0.0999999, "0.10000"),
            (1e-300, "1.0000e-300"),
            (0.0, "0"),
            (-0.0, "0"),
            (f64::NAN, "n/a"),
        ];
        for (value, text) in cases {
            assert_eq!(engineering(value), text, "{value:e}");
        }
    }

    #[test]
    fn a_given_number_keeps_its_digits() {
        let cases = [
            (60.00006, "60.00006"),
            (0.123456789012, "0.123456789012"),
            (2.1e8, "210000000"),
            (1e-7, "1e-7"),
            (1e21, "1e21"),
            (-0.0, "0"),
            (f64::INFINITY, "n/a"),
        ];
        for (value, text) in cases {
            assert_eq!(in_full(value), text, "{value:e}");
        }
    }

    #[test]
    fn a_column_shares_the_power_of_its_largest() {
        let cases = [
            (2.0599e-3, 2.0599e-3, "2.0599e-3"),
            (550.09e-6, 2.0599e-3, "0.55009e-3"),
            (55.009e-6, 2.0599e-3, "55.009e-6"),
            (48.114e-3, 0.6, "0.048114"),
            (4.8114e-3, 0.6, "0.0048114"),
            (0.48114e-3, 0.6, "481.14e-6"),
            (50.0, 1.5e5, "50.000"),
            (512.0, 1.5e5, "0.51200e3"),
            (1e-15, 1.5e5, "0"),
            (5.0, f64::NAN, "5.0000"),
        ];
        for (value, scale, text) in cases {
            assert_eq!(in_column(value, scale), text, "{value:e} of {scale:e}");
        }
    }

    #[test]
    fn short_drops_zeros() {
        let cases = [
            (0.005, "0.005"),
            (0.0005, "0.0005"),
            (133.3333, "133.33"),
            (100.0, "100"),
            (100000.0, "100000"),
            (4.261e-5, "42.61e-6"),
            (2.5e7, "25e6"),
            (0.0, "0"),
        ];
        for (value, text) in cases {
            assert_eq!(short(value), text, "{value:e}");
        }
    }
}
