//! Rewrites numbers in the text of a scenario: everything else keeps its place and its characters.

use jsonc_parser::cst::{CstInputValue, CstObject};

/// Which number of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Amended {
    /// Its value, also where it stands without an object around it.
    Value,
    /// Lower end of its slider.
    Min,
    /// Upper end.
    Max,
}

impl Amended {
    fn key(self) -> &'static str {
        match self {
            Amended::Value => "value",
            Amended::Min => "min",
            Amended::Max => "max",
        }
    }
}

/// Writes a number of a parameter that stands in the text of a scenario.
///
/// # Errors
/// A path that does not exist.
pub fn set_parameter(scenario: &CstObject, name: &str, what: Amended, value: f64) -> Result<(), String> {
    let parameter = scenario
        .object_value("parameters")
        .and_then(|parameters| parameters.get(name))
        .ok_or_else(|| format!("parameters.{name}"))?;
    let number = CstInputValue::Number(literal(value));
    match parameter.object_value() {
        Some(parameter) => {
            let key = what.key();
            parameter.get(key).ok_or_else(|| format!("parameters.{name}.{key}"))?.set_value(number);
        }
        None if what == Amended::Value => parameter.set_value(number),
        None => return Err(format!("parameters.{name}.{}", what.key())),
    }
    Ok(())
}

/// The shortest decimal that reads back as the same number, with an exponent where it would be long.
pub fn literal(value: f64) -> String {
    if value == 0.0 && value.is_sign_negative() {
        "-0.0".to_owned()
    } else if value == 0.0 || (1e-5..1e16).contains(&value.abs()) {
        let text = format!("{value:?}");
        // an integer is written as one
        text.strip_suffix(".0").map_or(text.clone(), ToOwned::to_owned)
    } else {
        format!("{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_read_back() {
        for value in [0.0, -0.0, 1.0, 1e-7, -2.5e300, 5e-324, 0.1 + 0.2, 1e15, 123456789012345680.0] {
            let text = literal(value);
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits(), "{text}");
            assert!(serde_json::from_str::<f64>(&text).is_ok(), "{text}");
        }
    }
}
