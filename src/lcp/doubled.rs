//! Sums in doubled precision: what is left where terms cancel, and the magnitude of what was summed.

/// A sum of numbers and products, carried with an error of the order of ε² Σ |terms| (Ogita, Rump & Oishi, *Accurate sum
/// and dot product*, 2005).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sum {
    high: f64,
    low: f64,
    magnitude: f64,
}

impl Sum {
    /// Adds `term`.
    pub fn add(&mut self, term: f64) {
        let sum = self.high + term;
        let part = sum - self.high;
        self.low += (self.high - (sum - part)) + (term - part);
        self.high = sum;
        self.magnitude += term.abs();
    }

    /// Adds a · b.
    pub fn add_product(&mut self, a: f64, b: f64) {
        let product = a * b;
        self.add(product);
        self.low += a.mul_add(b, -product);
    }

    /// Its value.
    pub fn value(self) -> f64 {
        self.high + self.low
    }

    /// Σ |terms|.
    pub fn magnitude(self) -> f64 {
        self.magnitude
    }

    /// Its value as a fraction of Σ |terms|; 0 where all terms are.
    pub fn relative(self) -> f64 {
        if self.magnitude == 0.0 { 0.0 } else { self.value() / self.magnitude }
    }
}

/// Σ a_i b_i + start, rounded once.
pub fn dot<'a>(start: f64, terms: impl Iterator<Item = (&'a f64, &'a f64)>) -> f64 {
    let mut sum = Sum::default();
    sum.add(start);
    terms.filter(|(a, b)| **a != 0.0 && **b != 0.0).for_each(|(a, b)| sum.add_product(*a, *b));
    sum.value()
}

#[cfg(test)]
mod tests {
    use super::{Sum, dot};

    #[test]
    fn terms_that_cancel_leave_what_f64_loses() {
        let mut sum = Sum::default();
        let third = 1.0 / 3.0;
        // 3 · fl(1/3) − 1 = −2⁻⁵⁴ exactly, rounded away by f64 arithmetic.
        sum.add_product(3.0, third);
        sum.add(-1.0);
        assert_eq!(sum.value(), -f64::powi(2.0, -54));
        assert_eq!(3.0 * third - 1.0, 0.0);
        let mut sum = Sum::default();
        [1e17, 1.0, -1e17].into_iter().for_each(|term| sum.add(term));
        assert_eq!(sum.value(), 1.0);
    }

    #[test]
    fn what_cancels_is_kept() {
        // (1 + ε)² − 1 − 2ε = ε².
        let a = 1.0 + f64::EPSILON;
        let sum = dot(-1.0, [a, -2.0].iter().zip([a, f64::EPSILON].iter()));
        assert_eq!(sum, f64::EPSILON * f64::EPSILON);
    }
}
