//! What drawn points say: shares with their standard errors, and how a quantity is spread.

use serde::Serialize;
use serde_json::Value;

/// Quantiles that are reported.
pub const QUANTILES: [f64; 7] = [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99];
/// Bars of a histogram.
pub const BARS: usize = 12;

/// What was found at a drawn point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// An answer.
    Answer,
    /// No answer, certified or proved.
    Collapse,
    /// Neither.
    Undecided,
}

/// A drawn point that was solved.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// The weight with which it counts; the mean of all weights is near 1.
    pub weight: f64,
    pub found: Found,
    /// The quantities, null where they have no value.
    pub values: Vec<Value>,
}

/// A probability.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Share {
    pub probability: f64,
    /// Of an estimate; 0 where the probability is exact.
    pub standard_error: f64,
    /// Draws that it was counted from.
    pub count: Option<usize>,
}

/// A bar of a histogram: the probability of a value between its ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bar {
    pub from: f64,
    pub to: f64,
    pub probability: f64,
}

/// How a quantity is spread over the answers: everything here is under the condition that it has a value.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    pub quantity: String,
    pub unit: Option<String>,
    /// Probability that it has a value.
    pub known: f64,
    /// `None` of words.
    pub mean: Option<f64>,
    /// Standard error of the mean; 0 where it is exact.
    pub mean_error: Option<f64>,
    pub deviation: Option<f64>,
    pub least: Option<f64>,
    pub most: Option<f64>,
    /// (p, value).
    pub quantiles: Vec<(f64, f64)>,
    pub histogram: Vec<Bar>,
    /// Of a quantity that is a word: each with its probability.
    pub words: Vec<(String, f64)>,
}

impl Share {
    /// Known exactly.
    pub fn exactly(probability: f64) -> Share {
        Share { probability, standard_error: 0.0, count: None }
    }

    /// Estimated from draws.
    pub fn of(draws: &[Drawn], wanted: Found) -> Share {
        let n = draws.len().max(1) as f64;
        let counted = draws.iter().filter(|draw| draw.found == wanted);
        let (sum, squares, count) = counted.fold((0.0, 0.0, 0), |(sum, squares, count), draw| {
            (sum + draw.weight, squares + draw.weight * draw.weight, count + 1)
        });
        let probability: f64 = sum / n;
        let variance = (squares / n - probability * probability).max(0.0) / (n - 1.0).max(1.0);
        Share { probability, standard_error: variance.sqrt(), count: Some(count) }
    }

    /// Where nothing was met in plain draws: the probability below which it lies with 95 %.
    pub fn below(&self, draws: usize) -> Option<f64> {
        (self.count == Some(0)).then(|| 1.0 - 0.05f64.powf(1.0 / draws.max(1) as f64))
    }
}

/// The words that a quantity was found to be, with what they count.
#[derive(Debug, Default)]
pub struct Words(Vec<(String, f64)>);

impl Words {
    pub fn add(&mut self, word: &str, weight: f64) {
        match self.0.iter_mut().find(|(known, _)| known == word) {
            Some((_, sum)) => *sum += weight,
            None => self.0.push((word.to_owned(), weight)),
        }
    }

    pub fn total(&self) -> f64 {
        self.0.iter().map(|(_, weight)| weight).sum()
    }

    /// Each as a share of `whole`, the likeliest first.
    pub fn shares(mut self, whole: f64) -> Vec<(String, f64)> {
        self.0.iter_mut().for_each(|(_, weight)| *weight /= whole);
        self.0.sort_by(|a, b| b.1.total_cmp(&a.1));
        self.0
    }
}

impl Spread {
    /// From drawn points; `column` is that of the quantity.
    pub fn of(draws: &[Drawn], column: usize, quantity: String) -> Spread {
        let all: f64 = draws.iter().map(|draw| draw.weight).sum();
        let mut values: Vec<(f64, f64)> = Vec::new();
        let mut words = Words::default();
        for draw in draws.iter().filter(|draw| draw.found == Found::Answer) {
            match &draw.values[column] {
                Value::String(word) => words.add(word, draw.weight),
                value => values.extend(value.as_f64().map(|value| (value, draw.weight))),
            }
        }
        let told = values.iter().map(|(_, weight)| weight).sum::<f64>() + words.total();
        let known = if all > 0.0 { told / all } else { 0.0 };
        let mut spread = Spread { quantity, known, words: words.shares(told), ..Spread::default() };
        spread.take(values);
        spread
    }

    fn take(&mut self, mut values: Vec<(f64, f64)>) {
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (Some(&(least, _)), Some(&(most, _))) = (values.first(), values.last()) else { return };
        let total: f64 = values.iter().map(|(_, weight)| weight).sum();
        let mean = values.iter().map(|(value, weight)| value * weight).sum::<f64>() / total;
        let variance = values.iter().map(|(value, weight)| weight * (value - mean).powi(2)).sum::<f64>() / total;
        // Of a ratio of weighted sums.
        let error = values.iter().map(|(value, weight)| (weight * (value - mean)).powi(2)).sum::<f64>().sqrt() / total;
        (self.least, self.most) = (Some(least), Some(most));
        (self.mean, self.mean_error, self.deviation) = (Some(mean), Some(error), Some(variance.sqrt()));
        let mut below = 0.0;
        let mut next = QUANTILES.iter().copied().peekable();
        for (value, weight) in &values {
            below += weight;
            while let Some(p) = next.next_if(|p| *p * total <= below) {
                self.quantiles.push((p, *value));
            }
        }
        // What rounding left over.
        self.quantiles.extend(next.map(|p| (p, most)));
        if least < most {
            let mut bars = bars(least, most);
            for (value, weight) in &values {
                let at = ((value - least) / (most - least) * BARS as f64) as usize;
                bars[at.min(BARS - 1)].probability += weight / total;
            }
            self.histogram = bars;
        }
    }
}

/// Empty bars between two values.
pub fn bars(least: f64, most: f64) -> Vec<Bar> {
    let at = |k: usize| if k == BARS { most } else { least + (most - least) * k as f64 / BARS as f64 };
    (0..BARS).map(|k| Bar { from: at(k), to: at(k + 1), probability: 0.0 }).collect()
}
