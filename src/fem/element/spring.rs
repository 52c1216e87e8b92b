//! Linear spring from a node to the ground: k = s d dᵀ, d its unit direction.

use nalgebra::Matrix2;

use crate::fem::doubled::Real;
use crate::model::structure::Spring;

/// Stiffness on (u_x, u_y) of the node.
pub fn stiffness<T: Real>(spring: &Spring) -> Matrix2<T> {
    let [x, y] = spring.direction.map(T::from);
    Matrix2::new(x * x, x * y, x * y, y * y) * T::from(spring.stiffness)
}

/// Force of the spring on its node for the node's displacement `u`.
pub fn force(spring: &Spring, u: [f64; 2]) -> [f64; 2] {
    let [x, y] = spring.direction;
    let f = -spring.stiffness * (x * u[0] + y * u[1]);
    [f * x, f * y]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_is_minus_stiffness_times_displacement() {
        let spring = Spring { node: 0, direction: [0.6, 0.8], stiffness: 50.0 };
        let u = [0.3, -0.1];
        let f = -stiffness::<f64>(&spring) * nalgebra::Vector2::from(u);
        let force = force(&spring, u);
        assert!((f[0] - force[0]).abs() < 1e-14 && (f[1] - force[1]).abs() < 1e-14);
    }
}
