//! Points drawn at random, each from a stream of its own, so that a point is the same whatever was drawn before it.

use std::fmt;

use rand::{RngCore, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::distribution::{Distribution, normal_quantile, normal_share};

/// Share of the draws that still follow the distributions of the parameters where the others are moved: no weight is
/// greater than 1 over this.
const UNMOVED: f64 = 0.1;

/// A parameter with its distribution.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// The parameter.
    pub name: String,
    /// How it is distributed.
    pub of: Distribution,
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.name, self.of)
    }
}

/// How points are drawn, as the header of a file states it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rule {
    /// Two draws of one seed are the same.
    pub seed: u64,
    /// Where most of the draws are moved to: a place of as many standard normal numbers as there are parameters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub centre: Option<Vec<f64>>,
}

/// Points drawn at random.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    pub variables: Vec<Variable>,
    pub rule: Rule,
    /// How many.
    pub count: usize,
}

/// A number in 0 < p < 1.
fn share(random: &mut ChaCha8Rng) -> f64 {
    ((random.next_u64() >> 11) as f64 + 0.5) * (0.5f64).powi(53)
}

impl Draw {
    /// The values of point `index`, and the weight with which it counts.
    pub fn point(&self, index: usize) -> (Vec<f64>, f64) {
        let mut random = ChaCha8Rng::seed_from_u64(self.rule.seed);
        random.set_stream(index as u64);
        let value = |(variable, p): (&Variable, f64)| variable.of.quantile(p);
        let Some(centre) = &self.rule.centre else {
            let values = self.variables.iter().map(|variable| value((variable, share(&mut random)))).collect();
            return (values, 1.0);
        };
        let moved = share(&mut random) >= UNMOVED;
        let normals: Vec<f64> =
            centre.iter().map(|c| normal_quantile(share(&mut random)) + if moved { *c } else { 0.0 }).collect();
        // φ(u) / φ(u − c) = exp(c·c/2 − c·u)
        let exponent: f64 = centre.iter().zip(&normals).map(|(c, u)| c * (0.5 * c - u)).sum();
        let weight = 1.0 / (UNMOVED + (1.0 - UNMOVED) * (-exponent).exp());
        (self.at(&normals), weight)
    }

    /// The values at a place of standard normal numbers.
    pub fn at(&self, normals: &[f64]) -> Vec<f64> {
        let inside = |u: f64| normal_share(u).clamp(f64::MIN_POSITIVE, 1.0 - f64::EPSILON / 2.0);
        self.variables.iter().zip(normals).map(|(variable, u)| variable.of.quantile(inside(*u))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draw(centre: Option<Vec<f64>>) -> Draw {
        let variable = |name: &str| Variable { name: name.to_owned(), of: "uniform(0,1)".parse().unwrap() };
        Draw { variables: vec![variable("a"), variable("b")], rule: Rule { seed: 3, centre }, count: 1 }
    }

    #[test]
    fn weights_give_back_the_law_that_draws_were_moved_from() {
        // The share of a < 0.01 and b < 0.05: 5e-4, wherever the draws are centred.
        let moved = draw(Some(vec![-2.3, -1.6]));
        let n = 20_000;
        let (mut sum, mut squares, mut total, mut largest) = (0.0, 0.0, 0.0, 0.0_f64);
        for index in 0..n {
            let (point, weight) = moved.point(index);
            assert!(point.iter().all(|x| (0.0..=1.0).contains(x)));
            let counted = if point[0] < 0.01 && point[1] < 0.05 { weight } else { 0.0 };
            (sum, squares, total) = (sum + counted, squares + counted * counted, total + weight);
            largest = largest.max(weight);
        }
        let n = n as f64;
        let error = ((squares / n - (sum / n).powi(2)) / n).sqrt();
        assert!((sum / n - 5e-4).abs() < 3.0 * error && error < 2e-5, "{} ± {error}", sum / n);
        assert!((total / n - 1.0).abs() < 0.1 && largest <= 1.0 / UNMOVED);
    }

    #[test]
    fn a_point_is_the_same_whatever_was_drawn_before() {
        let one = draw(None);
        assert_eq!(one.point(7), one.point(7));
        assert_ne!(one.point(7), one.point(8));
        assert_ne!(one.point(7), Draw { rule: Rule { seed: 4, centre: None }, ..one.clone() }.point(7));
    }
}
