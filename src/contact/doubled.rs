//! Sums in twice the precision of f64, for residuals that cancel (Ogita, Rump, Oishi 2005, "Dot2").

/// A sum whose rounding errors are summed beside it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Doubled {
    high: f64,
    low: f64,
}

impl Doubled {
    /// Adds a number.
    pub(crate) fn add(&mut self, term: f64) {
        let sum = self.high + term;
        let part = sum - self.high;
        self.low += (self.high - (sum - part)) + (term - part);
        self.high = sum;
    }

    /// Adds a product, its own rounding included.
    pub(crate) fn add_product(&mut self, a: f64, b: f64) {
        let product = a * b;
        self.low += a.mul_add(b, -product);
        self.add(product);
    }

    /// The sum, rounded once.
    pub(crate) fn value(self) -> f64 {
        self.high + self.low
    }
}

/// Σ a_i b_i + start, rounded once.
pub(crate) fn dot<'a>(start: f64, terms: impl Iterator<Item = (&'a f64, &'a f64)>) -> f64 {
    let mut sum = Doubled::default();
    sum.add(start);
    terms.filter(|(a, b)| **a != 0.0 && **b != 0.0).for_each(|(a, b)| sum.add_product(*a, *b));
    sum.value()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cancels_is_kept() {
        // (1 + ε)² − 1 − 2ε = ε².
        let a = 1.0 + f64::EPSILON;
        let sum = dot(-1.0, [a, -2.0].iter().zip([a, f64::EPSILON].iter()));
        assert_eq!(sum, f64::EPSILON * f64::EPSILON);
    }
}
