//! The points of a sweep: a grid of up to three parameters, each over a range, or points drawn at random.

use super::sample::draw::Draw;
use crate::model::scenario::Scenario;
use crate::text::number::rounded;

/// No axis has more points than this.
const MOST: f64 = 1e7;
/// Most parameters of a sweep.
pub const AXES: usize = 3;
/// Points of a range without a count.
pub const POINTS: usize = 11;

/// Why a grid cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GridError {
    /// Not of the form expected.
    #[error("cannot read `{0}`: expected NAME=FROM:TO:STEP, e.g. f=0:1:0.05, or NAME=VALUE")]
    Form(String),
    /// A word that is not a number.
    #[error("`{word}` in `{whole}` is not a finite number")]
    Number {
        /// The word.
        word: String,
        /// Where it stood.
        whole: String,
    },
    /// A range that leads nowhere.
    #[error("{0}")]
    Range(String),
    /// An unknown parameter.
    #[error("unknown parameter {name}: the scenario has {known}")]
    Unknown {
        /// As given.
        name: String,
        /// The parameters of the scenario.
        known: String,
    },
    /// A parameter twice, or too many.
    #[error("{0}")]
    Axes(String),
}

/// One parameter and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The parameter.
    pub name: String,
    /// Its values, in the order of the sweep; none where they are drawn.
    pub values: Vec<f64>,
    /// The range in words, the same for the same values: `f=0:1:0.05`, `f=uniform(0.2,0.6)`.
    pub range: String,
}

/// Twelve digits are kept, so that 3 × 0.05 reads 0.15.
fn tidy(value: f64, step: f64) -> f64 {
    if value.abs() <= 1e-9 * step.abs() {
        return 0.0;
    }
    rounded(value, 13)
}

impl Axis {
    /// `from`, `from + step` … up to `to`, which is included where the steps reach it up to rounding.
    ///
    /// # Errors
    /// A step that is zero or leads away; too many points.
    pub fn stepped(name: &str, from: f64, to: f64, step: f64) -> Result<Axis, GridError> {
        let range = format!("{name}={from}:{to}:{step}");
        if step == 0.0 || (to - from) * step < 0.0 || !(from.is_finite() && to.is_finite() && step.is_finite()) {
            return Err(GridError::Range(format!("{range}: a step of {step} does not lead from {from} to {to}")));
        }
        let steps = ((to - from) / step + 1e-9).floor();
        if steps >= MOST {
            return Err(GridError::Range(format!("{range} has more than {MOST} points")));
        }
        let count = steps as usize;
        let values = (0..=count)
            .map(|k| {
                let value = from + k as f64 * step;
                if (value - to).abs() <= 1e-9 * step.abs() {
                    to
                } else if k == 0 {
                    from
                } else {
                    tidy(value, step)
                }
            })
            .collect();
        Ok(Axis { name: name.to_owned(), values, range })
    }

    /// `count` values from `from` to `to`, both included.
    ///
    /// # Errors
    /// No points, or too many.
    pub fn counted(name: &str, from: f64, to: f64, count: usize) -> Result<Axis, GridError> {
        let range = format!("{name}={from}..{to}/{count}");
        if count == 0 || count as f64 > MOST || !(from.is_finite() && to.is_finite()) {
            return Err(GridError::Range(format!("{range}: expected 1 to {MOST} points")));
        }
        let last = (count - 1).max(1) as f64;
        let values = (0..count)
            .map(|k| match k {
                0 => from,
                k if k + 1 == count => to,
                k => tidy(from + (to - from) * (k as f64 / last), (to - from) / last),
            })
            .collect();
        Ok(Axis { name: name.to_owned(), values, range })
    }

    /// Reads `f=0:1:0.05`, `f=0..1/21` or `f=0.3`.
    ///
    /// # Errors
    /// See [`GridError`].
    pub fn parse(text: &str) -> Result<Axis, GridError> {
        let (name, range) = text.split_once('=').ok_or_else(|| GridError::Form(text.to_owned()))?;
        let name = name.trim();
        let number = |word: &str| -> Result<f64, GridError> {
            word.trim()
                .parse()
                .ok()
                .filter(|value: &f64| value.is_finite())
                .ok_or_else(|| GridError::Number { word: word.trim().to_owned(), whole: text.to_owned() })
        };
        if let Some((from, rest)) = range.split_once("..") {
            let (to, count) = match rest.split_once('/') {
                Some((to, count)) => (
                    to,
                    count
                        .trim()
                        .parse()
                        .map_err(|_| GridError::Number { word: count.trim().to_owned(), whole: text.to_owned() })?,
                ),
                None => (rest, POINTS),
            };
            return Axis::counted(name, number(from)?, number(to)?, count);
        }
        let parts: Vec<&str> = range.split(':').collect();
        match parts[..] {
            [value] => {
                let value = number(value)?;
                Axis::counted(name, value, value, 1)
            }
            [from, to, step] => Axis::stepped(name, number(from)?, number(to)?, number(step)?),
            _ => Err(GridError::Form(text.to_owned())),
        }
    }
}

/// The points of all axes, the last axis running fastest, or points drawn at random.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The axes.
    pub axes: Vec<Axis>,
    /// How its points are drawn, where they are.
    pub drawn: Option<Draw>,
}

impl Grid {
    /// A grid over parameters of the scenario.
    ///
    /// # Errors
    /// Unknown parameters, the same twice, none or more than [`AXES`], values that a parameter cannot take.
    pub fn new(scenario: &Scenario, axes: Vec<Axis>) -> Result<Grid, GridError> {
        if axes.is_empty() || axes.len() > AXES {
            return Err(GridError::Axes(format!("a sweep varies one to {AXES} parameters, found {}", axes.len())));
        }
        for (k, axis) in axes.iter().enumerate() {
            if !scenario.parameters.contains_key(&axis.name) {
                let known: Vec<&str> = scenario.parameters.keys().map(String::as_str).collect();
                return Err(GridError::Unknown {
                    name: axis.name.clone(),
                    known: if known.is_empty() { "no parameters".to_owned() } else { known.join(", ") },
                });
            }
            if axes[..k].iter().any(|other| other.name == axis.name) {
                return Err(GridError::Axes(format!("{} is varied twice", axis.name)));
            }
            if let Some(refusal) = axis.values.iter().find_map(|value| scenario.refusal(&axis.name, *value)) {
                return Err(GridError::Range(refusal));
            }
        }
        let points = axes.iter().map(|axis| axis.values.len() as f64).product::<f64>();
        if points > 1e12 {
            return Err(GridError::Axes(format!("{points:e} points are too many")));
        }
        Ok(Grid { axes, drawn: None })
    }

    /// Points drawn at random.
    pub fn of_draw(draw: Draw) -> Grid {
        let axis = |(name, range)| Axis { name, values: Vec::new(), range };
        let axes = draw
            .variables
            .iter()
            .map(|variable| axis((variable.name.clone(), format!("{}={}", variable.name, variable.of))));
        Grid { axes: axes.collect(), drawn: Some(draw) }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        match &self.drawn {
            Some(draw) => draw.count,
            None => self.axes.iter().map(|axis| axis.values.len()).product(),
        }
    }

    /// Points of a line, along which the last parameter runs alone; points drawn at random make one line.
    pub fn line_length(&self) -> usize {
        match (&self.drawn, self.axes.last()) {
            (None, Some(axis)) => axis.values.len().max(1),
            _ => self.len().max(1),
        }
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The values at point `index`, one per axis, each in the unit of its parameter.
    pub fn point(&self, mut index: usize) -> Vec<f64> {
        if let Some(draw) = &self.drawn {
            return draw.point(index).0;
        }
        let mut values = vec![0.0; self.axes.len()];
        for (value, axis) in values.iter_mut().zip(&self.axes).rev() {
            *value = axis.values[index % axis.values.len()];
            index /= axis.values.len();
        }
        values
    }
}

/// Part K of N of a sweep: a run of points in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Shard {
    /// K, from 1.
    pub number: usize,
    /// N.
    pub of: usize,
}

impl Shard {
    /// The whole sweep.
    pub const WHOLE: Shard = Shard { number: 1, of: 1 };

    /// Its points among `total`.
    pub fn points(self, total: usize) -> std::ops::Range<usize> {
        let at = |k: usize| (total as u128 * k as u128 / self.of as u128) as usize;
        at(self.number - 1)..at(self.number)
    }
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Shard, String> {
        let wrong = || format!("`{text}` is not a shard: expected K/N with 1 ≤ K ≤ N, e.g. 3/16");
        let (number, of) = text.split_once('/').ok_or_else(wrong)?;
        let shard =
            Shard { number: number.trim().parse().map_err(|_| wrong())?, of: of.trim().parse().map_err(|_| wrong())? };
        if shard.number == 0 || shard.number > shard.of {
            return Err(wrong());
        }
        Ok(shard)
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::{Axis, Shard};

    #[test]
    fn a_range_includes_its_end_within_rounding() {
        let axis = Axis::parse("f=0:1:0.05").expect("a range");
        assert_eq!(axis.values.len(), 21);
        assert_eq!(axis.values[3], 0.15);
        assert_eq!(axis.values[20], 1.0);
        let axis = Axis::parse("f=-0.2:0.25:0.1").expect("a range");
        assert_eq!(axis.values, [-0.2, -0.1, 0.0, 0.1, 0.2]);
        let axis = Axis::parse("f=1:0:-0.25").expect("a range");
        assert_eq!(axis.values, [1.0, 0.75, 0.5, 0.25, 0.0]);
        assert_eq!(Axis::parse("f=0..1/3").expect("a range").values, [0.0, 0.5, 1.0]);
        assert_eq!(Axis::parse("f=2").expect("a value").values, [2.0]);
        for wrong in ["f", "f=", "f=1:2", "f=1:2:-1", "f=0:1:0", "f=0:1e9:1e-9", "f=a..b", "f=0..1/0", "f=nan"] {
            assert!(Axis::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn shards_share_all_points() {
        for total in [0, 1, 7, 100] {
            for of in 1..9 {
                let mut next = 0;
                for number in 1..=of {
                    let points = Shard { number, of }.points(total);
                    assert_eq!(points.start, next);
                    next = points.end;
                }
                assert_eq!(next, total);
            }
        }
        assert!("0/3".parse::<Shard>().is_err() && "4/3".parse::<Shard>().is_err());
        assert_eq!("2/3".parse(), Ok(Shard { number: 2, of: 3 }));
    }
}
