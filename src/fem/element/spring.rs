//! Linear spring: k = s a aᵀ, with a the factors of the terms that stretch it.

use crate::doubled::Real;
use crate::model::structure::Spring;

/// Stiffness between two of its terms: force per length, of rotations moment per radian.
pub fn stiffness<T: Real>(spring: &Spring, i: usize, j: usize) -> T {
    T::from(spring.terms[i].factor) * T::from(spring.terms[j].factor) * T::from(spring.stiffness)
}

/// Force, or moment, with which it resists: s Σ a u for displacements per node, > 0 where it is stretched. It pulls
/// back: on the component of a term it acts with −a times that.
pub fn force(spring: &Spring, u: &[[f64; 6]]) -> f64 {
    spring.stiffness * stretch(spring, u)
}

/// Σ a u.
fn stretch(spring: &Spring, u: &[[f64; 6]]) -> f64 {
    spring.terms.iter().map(|term| term.factor * u[term.node][term.component as usize]).sum()
}

/// ½ s (Σ a u)² for displacements per node.
pub fn energy(spring: &Spring, u: &[[f64; 6]]) -> f64 {
    0.5 * force(spring, u) * stretch(spring, u)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Force on the terms by k u against s (Σ a u) a.
    #[test]
    fn force_is_stiffness_times_displacement() {
        let u = [[0.3, -0.1, 0.0, 0.0, 0.0, 0.02], [0.05, 0.4, 0.0, 0.0, 0.0, -0.01]];
        let springs = [
            Spring::along(0, None, [0.6, 0.8, 0.0], 50.0),
            Spring::along(0, Some(1), [-0.8, 0.6, 0.0], 50.0),
            Spring::about(1, None, [0.0, 0.0, 1.0], 7.0),
            Spring::about(0, Some(1), [0.0, 0.0, 1.0], 7.0),
        ];
        for spring in springs {
            let force = force(&spring, &u);
            for i in 0..spring.terms.len() {
                let terms = spring.terms.iter().enumerate();
                let row: f64 = terms
                    .map(|(j, term)| stiffness::<f64>(&spring, i, j) * u[term.node][term.component as usize])
                    .sum();
                assert!((row - spring.terms[i].factor * force).abs() < 1e-14);
            }
        }
    }
}
