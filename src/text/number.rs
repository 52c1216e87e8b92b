//! Numbers as an engineer reads them.

/// Significant digits of a number in a report.
pub const DIGITS: usize = 5;

/// Five significant digits without trailing zeros, for running text; exponents are multiples of three and appear below
/// 1e-4 and from 1e6 on: `0.005`, `133.33`, `42.61e-6`. Zero is `0`; what is not finite is `n/a`.
pub fn short(value: f64) -> String {
    let Some((figures, exponent)) = figures(value, DIGITS) else { return simple(value) };
    let power = if (-4..=5).contains(&exponent) { 0 } else { third(exponent) };
    let text = trimmed(placed(value, &figures, exponent - power));
    if power == 0 { text } else { format!("{text}e{power}") }
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

/// The number that a value is with so many significant digits, one at least: without the dust of binary fractions.
pub fn rounded(value: f64, digits: usize) -> f64 {
    let after_the_first = digits.saturating_sub(1);
    // A finite number printed this way is always read back.
    format!("{value:.after_the_first$e}").parse().unwrap_or(value)
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

/// A measured value with its unit, for sentences: `53.88 µm` where tables say µm, not `53.88e-6 m`.
pub fn measured(value: f64, unit: Option<&str>) -> String {
    let (numbers, unit) = measured_alike(&[value], unit);
    with_unit(&numbers.concat(), unit)
}

/// Measured values for a sentence, in a unit they share: metres where all of them read well in it, else mm or µm.
pub fn measured_alike<'u>(values: &[f64], unit: Option<&'u str>) -> (Vec<String>, Option<&'u str>) {
    let is_small = |value: &f64| figures(*value, DIGITS).is_some_and(|(_, exponent)| exponent < -4);
    let (times, unit) = match values.iter().fold(0.0, |most: f64, value| most.max(value.abs())) {
        _ if unit != Some("m") || !values.iter().any(is_small) => (1.0, unit),
        most if most < 1e-3 => (1e6, Some("µm")),
        _ => (1e3, Some("mm")),
    };
    (values.iter().map(|value| short(times * value)).collect(), unit)
}

/// A name and its unit as they stand over a column or beside an axis: `x_n [kN]`.
pub fn heading(name: &str, unit: Option<&str>) -> String {
    match unit {
        Some(unit) if !unit.is_empty() => format!("{name} [{unit}]"),
        _ => name.to_owned(),
    }
}

/// Zero, and what is not finite.
pub fn simple(value: f64) -> String {
    if value == 0.0 { "0" } else { "n/a" }.to_owned()
}

/// The next lower multiple of three.
pub fn third(exponent: i32) -> i32 {
    exponent.div_euclid(3) * 3
}

/// The first `digits` figures of |value|, rounded, and the exponent of ten of the first one; `None` for zero and what
/// is not finite. Rounding first: 99999.6 is 1.0000e5 and belongs to the next power.
pub fn figures(value: f64, digits: usize) -> Option<(String, i32)> {
    if value == 0.0 || !value.is_finite() {
        return None;
    }
    let scientific = format!("{:.*e}", digits.saturating_sub(1), value.abs());
    let (mantissa, exponent) = scientific.split_once('e')?;
    Some((mantissa.chars().filter(char::is_ascii_digit).collect(), exponent.parse().ok()?))
}

/// Figures with the sign of `value` and a decimal point, the first of them standing for 10^exponent.
pub fn placed(value: f64, figures: &str, exponent: i32) -> String {
    let sign = if value < 0.0 { "-" } else { "" };
    let before = exponent + 1;
    if before <= 0 {
        return format!("{sign}0.{}{figures}", "0".repeat(before.unsigned_abs() as usize));
    }
    let before = before as usize;
    if before < figures.len() {
        format!("{sign}{}.{}", &figures[..before], &figures[before..])
    } else {
        format!("{sign}{figures}{}", "0".repeat(before - figures.len()))
    }
}

/// Without zeros at the end of a fraction.
pub fn trimmed(text: String) -> String {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn measured_lengths_share_a_unit_that_can_be_read() {
        let said = |values: &[f64], unit: &str| {
            let (numbers, unit) = measured_alike(values, Some(unit));
            format!("{} {}", numbers.join(", "), unit.unwrap_or_default())
        };
        assert_eq!(said(&[0.005, 0.0005], "m"), "0.005, 0.0005 m");
        assert_eq!(said(&[33.097e-6], "m"), "33.097 µm");
        assert_eq!(said(&[0.005, -33.097e-6], "m"), "5, -0.033097 mm");
        assert_eq!(said(&[2.5e-5, 0.0], "m"), "25, 0 µm");
        assert_eq!(said(&[33.097e-6], "mm"), "33.097e-6 mm");
        assert_eq!(said(&[3.5e-10], "m"), "0.00035 µm");
        assert_eq!(measured(-5.388e-5, Some("m")), "-53.88 µm");
        assert_eq!(measured(-5.388e-5, None), "-53.88e-6");
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
            (-9.99996, "-10"),
            (0.0, "0"),
            (f64::NAN, "n/a"),
        ];
        for (value, text) in cases {
            assert_eq!(short(value), text, "{value:e}");
        }
    }
}
