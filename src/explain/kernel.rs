//! Motions of the joints that cost no energy, as the laws leave them free.

use nalgebra::{DMatrix, DVector};

use crate::contact::system::ContactSystem;

/// Motions of the releasable joints that cost no energy: the kernel of R without what bound pairs hold, an orthonormal
/// column for each, over all joints.
pub fn releasable_kernel(system: &ContactSystem) -> DMatrix<f64> {
    let held: Vec<usize> = (0..system.pairs.len()).filter(|&i| system.pairs[i].law.is_bilateral()).collect();
    let kernel = &system.kernel;
    if held.is_empty() || kernel.ncols() == 0 {
        return kernel.clone();
    }
    let normal = DMatrix::from_fn(held.len().max(kernel.ncols()), kernel.ncols(), |a, b| {
        held.get(a).map_or(0.0, |&joint| kernel[(joint, b)])
    });
    let svd = normal.svd(false, true);
    let Some(v_t) = svd.v_t else {
        return DMatrix::zeros(kernel.nrows(), 0);
    };
    let free: Vec<DVector<f64>> = (0..kernel.ncols())
        .filter(|&k| svd.singular_values[k] <= 1e-8)
        .map(|k| kernel * v_t.row(k).transpose())
        .collect();
    if free.is_empty() { DMatrix::zeros(kernel.nrows(), 0) } else { DMatrix::from_columns(&free) }
}

/// The kernel without entries that are rounding noise beside the largest of their column: they would only blur motions
/// that are exactly simple.
pub fn clean(kernel: &DMatrix<f64>) -> DMatrix<f64> {
    let mut clean = kernel.clone();
    for mut column in clean.column_iter_mut() {
        let noise = 1e-13 * column.amax();
        column.iter_mut().filter(|v| v.abs() <= noise).for_each(|v| *v = 0.0);
    }
    clean
}
