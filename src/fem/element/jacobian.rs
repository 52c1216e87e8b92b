//! The Jacobian of the map from the parent element to its place: its rows are ∂(x, y)/∂ξ, ∂(x, y)/∂η in the plane,
//! ∂(x, y, z)/∂ξ, ∂/∂η, ∂/∂ζ in space.

use crate::doubled::Real;

/// Components along three axes.
pub type Triple<T> = [T; 3];

/// det J in the plane.
pub fn determinant<T: Real>(j: &[[T; 2]; 2]) -> T {
    j[0][0] * j[1][1] - j[0][1] * j[1][0]
}

/// J⁻¹ applied to (∂/∂ξ, ∂/∂η): (∂/∂x, ∂/∂y); `inverse` is 1 / det J.
pub fn in_plane<T: Real>(j: &[[T; 2]; 2], inverse: T, [xi, eta]: [T; 2]) -> [T; 2] {
    [(j[1][1] * xi - j[0][1] * eta) * inverse, (j[0][0] * eta - j[1][0] * xi) * inverse]
}

/// A Jacobian in space, ready to turn gradients.
pub struct SpaceJacobian<T> {
    /// det J.
    pub determinant: T,
    /// Columns of det J · J⁻¹: products of two rows of J.
    adjugate: [Triple<T>; 3],
}

impl<T: Real> SpaceJacobian<T> {
    /// From the rows of J.
    pub fn of([a, b, c]: [Triple<T>; 3]) -> SpaceJacobian<T> {
        let adjugate = [cross(b, c), cross(c, a), cross(a, b)];
        let determinant = a[0] * adjugate[0][0] + a[1] * adjugate[0][1] + a[2] * adjugate[0][2];
        SpaceJacobian { determinant, adjugate }
    }

    /// J⁻¹ applied to (∂/∂ξ, ∂/∂η, ∂/∂ζ): (∂/∂x, ∂/∂y, ∂/∂z).
    pub fn turn(&self, [xi, eta, zeta]: Triple<T>) -> Triple<T> {
        let [a, b, c] = &self.adjugate;
        let inverse = T::one() / self.determinant;
        [0, 1, 2].map(|i| (a[i] * xi + b[i] * eta + c[i] * zeta) * inverse)
    }
}

fn cross<T: Real>(a: Triple<T>, b: Triple<T>) -> Triple<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
