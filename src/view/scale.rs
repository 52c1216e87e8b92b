//! One power of ten for the numbers of a column or of an axis.
//!
//! The largest number decides: from 0.1 up to 99999 it is written as it is, else all are divided by that multiple of
//! three which leaves it between 1 and 999. The power is said once, with the unit: `10⁻⁶ kN`; thousandths and millionths
//! of a metre are mm and µm. Each number has five significant digits but no more than three decimals beyond those of the
//! largest one. What would keep less than two digits there, under a millionth of the largest, is written with an exponent
//! of its own, in the unit of the column: `2.1e-9` is told apart from `0`, which is nothing or rounding.

use crate::answer::rounding::{denoised, largest};
use crate::text::number::{DIGITS, figures, placed, simple, third, trimmed};

/// What is smaller than this share of the largest has a power of ten of its own.
pub const APART: f64 = 1e-3;
/// Decimals of small numbers beyond those of the largest.
const MORE: i32 = 3;
/// Digits of numbers that a user gives or reads back: parameters, breakpoints.
const GIVEN: usize = 10;

/// The power of ten that numbers share, and their digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    largest: f64,
    power: i32,
    digits: usize,
    /// Most decimals of a number.
    decimals: i32,
    /// Whether zeros at the end are left out.
    is_short: bool,
}

impl Scale {
    /// Of measured values.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Scale {
        Scale::new(largest(values), DIGITS, -1..=4)
    }

    /// Of a column with this many digits.
    pub fn with_digits(values: impl IntoIterator<Item = f64>, digits: usize) -> Scale {
        Scale::new(largest(values), digits, -1..=4)
    }

    /// Of the ticks of an axis: no more digits than they have.
    pub fn of_axis(values: impl IntoIterator<Item = f64>) -> Scale {
        Scale { is_short: true, ..Scale::of(values) }
    }

    /// Of an axis of parameters or factors: without a power where they are typed without one.
    pub fn of_typed_axis(values: impl IntoIterator<Item = f64>) -> Scale {
        Scale { is_short: true, ..Scale::new(largest(values), DIGITS, -4..=5) }
    }

    /// Of parameters, factors and breakpoints, which are typed as they are read: ten digits, the zeros at their end left
    /// out, without a power from 1e-4 to 1e10.
    pub fn given(values: impl IntoIterator<Item = f64>) -> Scale {
        Scale { is_short: true, ..Scale::new(largest(values), GIVEN, -4..=9) }
    }

    fn new(largest: f64, digits: usize, plain: std::ops::RangeInclusive<i32>) -> Scale {
        let exponent = figures(largest, digits).map_or(0, |(_, exponent)| exponent);
        let power = if plain.contains(&exponent) { 0 } else { third(exponent) };
        let decimals = (digits as i32 - 1 - (exponent - power)).max(0) + MORE;
        Scale { largest, power, digits, decimals, is_short: false }
    }

    /// A number without its power.
    pub fn number(&self, value: f64) -> String {
        let Some((_, exponent)) = figures(value, self.digits) else { return simple(value) };
        let room = exponent - self.power + self.decimals + 1;
        if room < 2 {
            return self.tiny(value);
        }
        let digits = self.digits.min(room as usize);
        // there are figures: the value is finite and not 0
        let (figures, exponent) = figures(value, digits).unwrap_or_default();
        let text = placed(value, &figures, exponent - self.power);
        if self.is_short { trimmed(text) } else { text }
    }

    /// A number with its power, for running text: `3.80952381`, `2.5e-6`.
    pub fn in_line(&self, value: f64) -> String {
        let number = self.number(value);
        if self.power == 0 { number } else { format!("{number}e{}", self.power) }
    }

    /// A number without its power, 0 where it is rounding beside the largest.
    pub fn measured(&self, value: f64) -> String {
        self.number(denoised(value, self.largest))
    }

    /// Two digits and an exponent of its own.
    fn tiny(&self, value: f64) -> String {
        let (figures, exponent) = figures(value, 2).unwrap_or_default();
        format!("{}e{}", placed(value, &figures, 0), exponent - self.power)
    }

    /// The unit with the power before it: `10⁻⁶ kN`, `µm`, `1e-6 kN` and `um` in ASCII; `None` where there is nothing to say.
    pub fn unit(&self, unit: Option<&str>, ascii: bool) -> Option<String> {
        let unit = unit.filter(|unit| !unit.is_empty());
        let power = match (self.power, unit, ascii) {
            (0, ..) => return unit.map(str::to_owned),
            (-3, Some("m"), _) => return Some("mm".to_owned()),
            (-6, Some("m"), _) => return Some(if ascii { "um" } else { "µm" }.to_owned()),
            (power, _, true) => format!("1e{power}"),
            (power, _, false) => format!("10{}", superscript(power)),
        };
        Some(match unit {
            Some(unit) => format!("{power} {unit}"),
            None => power,
        })
    }
}

/// Scales of values of several quantities, one for each unit.
#[derive(Debug, Default)]
pub struct ByUnit(Vec<(Option<String>, Scale)>);

impl ByUnit {
    /// Of values with their units.
    pub fn of(values: &[(Option<String>, f64)]) -> ByUnit {
        let mut scales = ByUnit::default();
        for (unit, _) in values {
            if !scales.0.iter().any(|(known, _)| known == unit) {
                let alike = values.iter().filter(|(other, _)| other == unit);
                scales.0.push((unit.clone(), Scale::of(alike.map(|(_, value)| *value))));
            }
        }
        scales
    }

    /// The scale of a row of values: that of all values of their unit, or one of its own where they are all small beside
    /// those, or have no unit.
    pub fn of_row(&self, values: &[f64], unit: Option<&str>) -> Scale {
        let of = if unit.is_some() { Scale::of } else { Scale::of_axis };
        let own = of(values.to_vec());
        let known = self.0.iter().find(|(known, _)| known.as_deref() == unit && unit.is_some());
        known
            .map(|(_, scale)| *scale)
            .filter(|all| own.largest == 0.0 || own.largest >= APART * all.largest)
            .unwrap_or(own)
    }
}

/// An exponent above the line: `⁻⁶`.
fn superscript(power: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digit = |c: char| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    power.to_string().chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(values: &[f64]) -> (Vec<String>, Option<String>) {
        let scale = Scale::of(values.iter().copied());
        (values.iter().map(|value| scale.number(*value)).collect(), scale.unit(Some("m"), false))
    }

    #[test]
    fn all_numbers_have_the_power_of_the_largest() {
        for (values, texts, unit) in [
            (&[0.000129, 85.883e-6, 0.0][..], &["129.00", "85.883", "0"][..], "µm"),
            (&[-0.0013375, 54.029e-6, 117.54e-9], &["-1.3375", "0.054029", "0.0001175"], "mm"),
            (&[0.6, 4.8114e-3, 0.48114e-3], &["0.60000", "0.0048114", "0.00048114"], "m"),
            (&[99999.6, 50.0], &["100.00", "0.05000"], "10³ m"),
            (&[12345.6, 0.5, 0.012], &["12346", "0.500", "0.012"], "m"),
            (&[9.99996, 1.0], &["10.000", "1.0000"], "m"),
            (&[2e-9, f64::NAN], &["2.0000", "n/a"], "10⁻⁹ m"),
            (&[3e-300, 1e-300], &["3.0000", "1.0000"], "10⁻³⁰⁰ m"),
        ] {
            assert_eq!(written(values), (texts.iter().map(|text| (*text).to_owned()).collect(), Some(unit.to_owned())));
        }
    }

    /// A millionth of the largest keeps two digits, less than that an exponent: never a row of zeros.
    #[test]
    fn what_is_small_is_told_apart_from_nothing() {
        let (texts, _) = written(&[1.0, 0.99e-6, 1.0e-6, 1.04e-6, -2.14e-9, 9.96e-8, 0.0]);
        assert_eq!(texts, ["1.0000", "9.9e-7", "0.0000010", "0.0000010", "-2.1e-9", "1.0e-7", "0"]);
        let (texts, _) = written(&[2e-3, 2e-12]);
        assert_eq!(texts, ["2.0000", "2.0e-9"]);
    }

    #[test]
    fn what_is_given_keeps_its_digits() {
        let scale = Scale::given([214.285_714_285_7, 0.05, 1e-3]);
        assert_eq!([214.285_714_285_7, 0.05, 1e-3].map(|v| scale.number(v)), ["214.2857143", "0.05", "0.001"]);
        let scale = Scale::given([2.5e-6]);
        assert_eq!((scale.number(2.5e-6), scale.unit(None, true)), ("2.5".to_owned(), Some("1e-6".to_owned())));
    }

    #[test]
    fn a_power_stands_with_its_unit() {
        let unit = |value: f64, unit: Option<&str>, ascii: bool| Scale::of([value]).unit(unit, ascii);
        assert_eq!(unit(1e-6, Some("m"), true).as_deref(), Some("um"));
        assert_eq!(unit(1e-6, Some("kN"), true).as_deref(), Some("1e-6 kN"));
        assert_eq!(unit(1e-3, Some("m"), true).as_deref(), Some("mm"));
        assert_eq!(unit(1e6, Some("kN"), false).as_deref(), Some("10⁶ kN"));
        assert_eq!(unit(1e-6, None, false).as_deref(), Some("10⁻⁶"));
        assert_eq!(unit(1.0, None, false), None);
        assert_eq!(unit(1.0, Some("kN"), false).as_deref(), Some("kN"));
    }
}
