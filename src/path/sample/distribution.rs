//! How a parameter is distributed: its law, where it is cut, and its quantiles.

use std::f64::consts::{PI, SQRT_2};
use std::fmt;
use std::str::FromStr;

use crate::text::number::in_full;

/// A law of distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Between two values, all equally likely.
    Uniform { low: f64, high: f64 },
    /// Gauss's, by mean and standard deviation.
    Normal { mean: f64, deviation: f64 },
    /// That of a positive number whose logarithm is normal, by the number's own mean and standard deviation.
    Lognormal { mean: f64, deviation: f64 },
    /// Rising from the least to the likeliest value, falling to the greatest.
    Triangular { least: f64, likeliest: f64, greatest: f64 },
}

/// A law, cut off below a value and scaled up to 1 above it, where that is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distribution {
    pub law: Law,
    /// No value is less than this.
    pub least: Option<f64>,
}

/// Words that are not a distribution.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DistributionError {
    /// Not of the form expected.
    #[error(
        "`{0}` is not a distribution: expected uniform(LEAST, GREATEST), normal(MEAN, DEVIATION), lognormal(MEAN, DEVIATION) or \
         triangular(LEAST, LIKELIEST, GREATEST)"
    )]
    Form(String),
    /// Numbers that make none.
    #[error("{0}")]
    Numbers(String),
}

/// Φ, the distribution function of the standard normal law.
pub fn normal_share(x: f64) -> f64 {
    0.5 * libm::erfc(-x / SQRT_2)
}

/// The inverse of Φ: Acklam's rational function (relative error 1.2e-9), then Halley's method twice. 0 < p < 1.
pub fn normal_quantile(p: f64) -> f64 {
    const A: [f64; 6] = [
        -3.969_683_028_665_376e1,
        2.209_460_984_245_205e2,
        -2.759_285_104_469_687e2,
        1.383_577_518_672_69e2,
        -3.066_479_806_614_716e1,
        2.506_628_277_459_239,
    ];
    const B: [f64; 5] = [
        -5.447_609_879_822_406e1,
        1.615_858_368_580_409e2,
        -1.556_989_798_598_866e2,
        6.680_131_188_771_972e1,
        -1.328_068_155_288_572e1,
    ];
    const C: [f64; 6] = [
        -7.784_894_002_430_293e-3,
        -3.223_964_580_411_365e-1,
        -2.400_758_277_161_838,
        -2.549_732_539_343_734,
        4.374_664_141_464_968,
        2.938_163_982_698_783,
    ];
    const D: [f64; 4] =
        [7.784_695_709_041_462e-3, 3.224_671_290_700_398e-1, 2.445_134_137_142_996, 3.754_408_661_907_416];
    let horner = |coefficients: &[f64], x: f64| coefficients.iter().fold(0.0, |sum, c| sum * x + c);
    let tail = |p: f64| {
        let q = (-2.0 * p.ln()).sqrt();
        horner(&C, q) / (horner(&D, q) * q + 1.0)
    };
    // From the nearer end, where no digits are lost.
    if p > 0.5 {
        return -normal_quantile(1.0 - p);
    }
    let mut x = if p < 0.024_25 {
        tail(p)
    } else {
        let q = p - 0.5;
        let r = q * q;
        horner(&A, r) * q / (horner(&B, r) * r + 1.0)
    };
    for _ in 0..2 {
        let step = (normal_share(x) - p) * (2.0 * PI).sqrt() * (0.5 * x * x).exp();
        x -= step / (1.0 + 0.5 * x * step);
    }
    x
}

impl Law {
    /// (μ, σ) of the logarithm of a lognormal value.
    fn logarithm(mean: f64, deviation: f64) -> (f64, f64) {
        let variance = (deviation / mean).powi(2).ln_1p();
        (mean.ln() - 0.5 * variance, variance.sqrt())
    }

    fn quantile(&self, p: f64) -> f64 {
        match *self {
            Law::Uniform { low, high } => low + p * (high - low),
            Law::Normal { mean, deviation } => mean + deviation * normal_quantile(p),
            Law::Lognormal { mean, deviation } => {
                let (mu, sigma) = Law::logarithm(mean, deviation);
                (mu + sigma * normal_quantile(p)).exp()
            }
            Law::Triangular { least, likeliest, greatest } => {
                let (width, rise) = (greatest - least, likeliest - least);
                if p * width < rise {
                    least + (p * width * rise).sqrt()
                } else {
                    greatest - ((1.0 - p) * width * (greatest - likeliest)).sqrt()
                }
            }
        }
    }

    fn share(&self, x: f64) -> f64 {
        match *self {
            Law::Uniform { low, high } => ((x - low) / (high - low)).clamp(0.0, 1.0),
            Law::Normal { mean, deviation } => normal_share((x - mean) / deviation),
            Law::Lognormal { .. } if x <= 0.0 => 0.0,
            Law::Lognormal { mean, deviation } => {
                let (mu, sigma) = Law::logarithm(mean, deviation);
                normal_share((x.ln() - mu) / sigma)
            }
            Law::Triangular { least, likeliest, greatest } => {
                let width = greatest - least;
                if x <= least {
                    0.0
                } else if x < likeliest {
                    (x - least).powi(2) / (width * (likeliest - least))
                } else if x < greatest {
                    1.0 - (greatest - x).powi(2) / (width * (greatest - likeliest))
                } else {
                    1.0
                }
            }
        }
    }
}

impl Distribution {
    /// The value, in the unit of the parameter, below which a share of 0 < p < 1 lies.
    pub fn quantile(&self, p: f64) -> f64 {
        let Some(least) = self.least else { return self.law.quantile(p) };
        let cut = self.law.share(least);
        let inside = self.law.quantile((cut + p * (1.0 - cut)).clamp(f64::MIN_POSITIVE, 1.0 - f64::EPSILON / 2.0));
        inside.max(least)
    }

    /// The share below a value.
    pub fn share(&self, x: f64) -> f64 {
        let Some(least) = self.least else { return self.law.share(x) };
        let cut = self.law.share(least);
        ((self.law.share(x) - cut) / (1.0 - cut)).clamp(0.0, 1.0)
    }

    /// The share of the law that is cut off.
    pub fn cut(&self) -> f64 {
        self.least.map_or(0.0, |least| self.law.share(least))
    }

    /// Where it ends, if it ends on both sides.
    pub fn ends(&self) -> Option<[f64; 2]> {
        let [low, high] = match self.law {
            Law::Uniform { low, high } => [low, high],
            Law::Triangular { least, greatest, .. } => [least, greatest],
            Law::Normal { .. } | Law::Lognormal { .. } => return None,
        };
        Some([self.least.map_or(low, |least| low.max(least)), high])
    }

    /// Whether all values between its ends are equally likely.
    pub fn is_uniform(&self) -> bool {
        matches!(self.law, Law::Uniform { .. })
    }
}

impl FromStr for Distribution {
    type Err = DistributionError;

    /// `uniform(0.2,0.6)`; with `>=0` after it, cut off below 0.
    fn from_str(text: &str) -> Result<Distribution, DistributionError> {
        let form = || DistributionError::Form(text.to_owned());
        let (whole, least) = match text.split_once(">=") {
            Some((whole, least)) => (whole, Some(least.trim().parse::<f64>().map_err(|_| form())?)),
            None => (text, None),
        };
        let (name, rest) = whole.trim().split_once('(').ok_or_else(form)?;
        let inside = rest.strip_suffix(')').ok_or_else(form)?;
        let numbers: Result<Vec<f64>, _> = inside.split(',').map(|number| number.trim().parse::<f64>()).collect();
        let numbers = numbers.map_err(|_| form())?;
        let wrong = |why: &str| DistributionError::Numbers(format!("{text}: {why}"));
        if numbers.iter().chain(&least).any(|number| !number.is_finite()) {
            return Err(wrong("its numbers must be finite"));
        }
        let law = match (name.trim(), &numbers[..]) {
            ("uniform", &[low, high]) if low < high => Law::Uniform { low, high },
            ("uniform", [_, _]) => return Err(wrong("the smaller number comes first")),
            ("normal" | "lognormal", &[_, deviation]) if deviation <= 0.0 => {
                return Err(wrong("the standard deviation must be greater than 0"));
            }
            ("normal", &[mean, deviation]) => Law::Normal { mean, deviation },
            ("lognormal", &[mean, deviation]) if mean > 0.0 => Law::Lognormal { mean, deviation },
            ("lognormal", [_, _]) => return Err(wrong("its mean must be greater than 0")),
            ("triangular", &[least, likeliest, greatest]) if least <= likeliest && likeliest <= greatest => {
                if least == greatest {
                    return Err(wrong("it is one value"));
                }
                Law::Triangular { least, likeliest, greatest }
            }
            ("triangular", [_, _, _]) => return Err(wrong("expected the least, the likeliest and the greatest value")),
            _ => return Err(form()),
        };
        let made = Distribution { law, least };
        if made.cut() >= 1.0 - f64::EPSILON {
            return Err(wrong("nothing of it is left"));
        }
        Ok(made)
    }
}

impl fmt::Display for Distribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.law {
            Law::Uniform { low, high } => write!(f, "uniform({},{})", in_full(low), in_full(high)),
            Law::Normal { mean, deviation } => write!(f, "normal({},{})", in_full(mean), in_full(deviation)),
            Law::Lognormal { mean, deviation } => write!(f, "lognormal({},{})", in_full(mean), in_full(deviation)),
            Law::Triangular { least, likeliest, greatest } => {
                write!(f, "triangular({},{},{})", in_full(least), in_full(likeliest), in_full(greatest))
            }
        }?;
        self.least.map_or(Ok(()), |least| write!(f, ">={}", in_full(least)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_and_shares_undo_one_another() {
        for text in [
            "uniform(0.2,0.6)",
            "normal(0.3,0.1)",
            "normal(0.3,0.1)>=0",
            "lognormal(2,3)",
            "triangular(1,2,5)",
            "triangular(1,1,5)",
            "triangular(1,5,5)>=2",
        ] {
            let of: Distribution = text.parse().unwrap();
            assert_eq!(of.to_string(), text);
            for k in 1..400 {
                let p = f64::from(k) / 400.0;
                assert!((of.share(of.quantile(p)) - p).abs() < 1e-12, "{text} at {p}");
            }
        }
    }

    /// Φ(1) = 0.841344746068542948…, Φ⁻¹(0.975) = 1.959963984540054235…, Φ(−6) = 9.865876450376981e-10 (tables).
    #[test]
    fn the_normal_law_is_that_of_the_tables() {
        assert!((normal_share(1.0) - 0.841_344_746_068_542_9).abs() < 1e-15);
        assert!((normal_share(-6.0) / 9.865_876_450_376_98e-10 - 1.0).abs() < 1e-12);
        assert!((normal_quantile(0.975) - 1.959_963_984_540_054).abs() < 1e-14);
        assert!((normal_quantile(9.865_876_450_376_98e-10) + 6.0).abs() < 1e-12);
        assert_eq!(normal_quantile(0.5), 0.0);
    }

    /// A lognormal value by its own mean and deviation: its moments, by the midpoint rule over 1e5 quantiles.
    #[test]
    fn lognormal_takes_the_moments_of_the_value() {
        let of: Distribution = "lognormal(2,0.5)".parse().unwrap();
        let n = 100_000;
        let values: Vec<f64> = (0..n).map(|k| of.quantile((f64::from(k) + 0.5) / f64::from(n))).collect();
        let mean = values.iter().sum::<f64>() / f64::from(n);
        let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / f64::from(n);
        assert!((mean - 2.0).abs() < 1e-4 && (variance.sqrt() - 0.5).abs() < 1e-3, "{mean} {variance}");
    }

    #[test]
    fn what_is_none_says_what_was_expected() {
        for (text, part) in [
            ("uniform(1)", "not a distribution"),
            ("uniform(2,1)", "smaller number"),
            ("normal(0,0)", "deviation"),
            ("lognormal(-1,1)", "mean"),
            ("triangular(3,2,1)", "likeliest"),
            ("gumbel(1,2)", "not a distribution"),
            ("uniform(0,inf)", "finite"),
            ("uniform(-2,-1)>=0", "nothing of it"),
        ] {
            let error = text.parse::<Distribution>().unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
    }
}
