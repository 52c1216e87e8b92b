//! Shape functions and integration points of areas and solids, in the coordinates of their parent elements.

mod areas;
mod solids;

pub use areas::{AreaShape, MOST};
pub use solids::{MOST as MOST_OF_SOLID, SolidShape, TETRAHEDRON_SIDES, VolumePoint};

/// Gradients against central differences, exact for quadratics up to rounding; the serendipity functions have third
/// derivatives below 1 along an axis, so that the error is below h²/6. Returns the largest magnitude of their sums,
/// which are zero up to rounding.
#[cfg(test)]
fn assert_derivatives<const AXES: usize, const MOST: usize>(
    at: [f64; AXES],
    gradients: &[[f64; AXES]],
    values: impl Fn([f64; AXES]) -> [f64; MOST],
) -> f64 {
    const H: f64 = 1e-4;
    let mut largest = 0.0_f64;
    for a in 0..AXES {
        let shifted = |by: f64| {
            let mut at = at;
            at[a] += by;
            values(at)
        };
        let (up, down) = (shifted(H), shifted(-H));
        for (i, gradient) in gradients.iter().enumerate() {
            assert!(((up[i] - down[i]) / (2.0 * H) - gradient[a]).abs() < 1e-8, "{i}: {gradient:?}");
        }
        largest = largest.max(gradients.iter().map(|gradient| gradient[a]).sum::<f64>().abs());
    }
    largest
}
