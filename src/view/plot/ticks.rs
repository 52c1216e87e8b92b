//! Ranges of axes and round places on them.

/// Values beyond this are cut: sums and differences of them stay finite.
pub const HUGE: f64 = 1e300;
/// Ranges below this cannot be divided into ticks any more.
const TINY: f64 = 1e-290;

/// Smallest and largest, cut to what can be computed with.
pub fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    (low.clamp(-HUGE, HUGE), high.clamp(-HUGE, HUGE))
}

/// A scale that holds 0 and all values and ends at ticks 1, 2 or 5 × 10^k apart.
#[derive(Clone, Debug, PartialEq)]
pub struct Ticks {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// The ticks, both ends among them.
    pub values: Vec<f64>,
}

impl Ticks {
    /// At most about `count` + 1 ticks.
    pub fn new(values: impl Iterator<Item = f64>, count: usize) -> Ticks {
        let (low, high) = range(values.filter(|value| value.is_finite()).chain([0.0]));
        if high - low < TINY {
            // All zero: a scale of no size would divide by zero; only its 0 is named.
            return Ticks { low: -1.0, high: 1.0, values: vec![0.0] };
        }
        let step = round_step((high - low) / count.max(1) as f64);
        let first = (low / step + 1e-9).floor() as i64;
        let last = (high / step - 1e-9).ceil() as i64;
        Ticks {
            low: first as f64 * step,
            high: last as f64 * step,
            values: (first..=last).map(|i| i as f64 * step).collect(),
        }
    }
}

/// The least of 1, 2 or 5 × 10^k that is not less than `rough`.
fn round_step(rough: f64) -> f64 {
    let power = 10f64.powi(rough.log10().floor() as i32);
    let steps = [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * power);
    steps.into_iter().find(|step| *step >= rough * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

/// Round places between two values, at most about `count`; none where they are too close to tell apart.
pub fn round_places(low: f64, high: f64, count: usize) -> Vec<f64> {
    if high - low < TINY {
        return Vec::new();
    }
    let step = round_step((high - low) / count.max(1) as f64);
    let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
    (first..=last).map(|i| i as f64 * step).collect()
}
