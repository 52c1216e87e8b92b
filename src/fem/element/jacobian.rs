//! The Jacobian of the map from (ξ, η) to the plane: J = (∂x/∂ξ, ∂y/∂ξ), (∂x/∂η, ∂y/∂η).

use crate::doubled::Real;

/// det J.
pub fn determinant<T: Real>(j: &[[T; 2]; 2]) -> T {
    j[0][0] * j[1][1] - j[0][1] * j[1][0]
}

/// J⁻¹ applied to (∂/∂ξ, ∂/∂η): (∂/∂x, ∂/∂y).
pub fn in_plane<T: Real>(j: &[[T; 2]; 2], det: T, [xi, eta]: [T; 2]) -> [T; 2] {
    let inverse = T::one() / det;
    [(j[1][1] * xi - j[0][1] * eta) * inverse, (j[0][0] * eta - j[1][0] * xi) * inverse]
}
