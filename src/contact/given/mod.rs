//! A contact system read from a file → joints: tangential joints of frictionless pairs released, kernel exact.

mod definite;
mod error;
mod rows;
mod singular;

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use self::definite::{judge_entries, set_entries, size, take_rounding};
pub use self::error::GivenError;
use self::rows::{Rows, cleaned, joint_name, joints_in_words, pairs};
use self::singular::{repeated_in_space, singular_compliance};
use super::file_data::FileData;
use super::pivoted::{DIGITS, NEARLY, NullSpace, PivotedCholesky, is_null, orthonormal, scales};
use super::system::{ContactSystem, JointLoad};
use crate::lcp::problem::NOISE;
use crate::model::scenario::{GivenContactSystem, GivenLoad, GivenMatrix};
use stickslip_numerics::decompositions::smallest_eigenvalue;

/// An eigenvalue below −this makes a matrix unusable, after scaling to unit diagonal.
const NEGATIVE: f64 = 1e-9;
/// A pivot this many times what was taken out of a matrix is there with it, too: elimination magnifies what was taken by the
/// squares of the motions that it leads to, which are of order one after scaling.
const FAR: f64 = 1e4;

/// Rows and columns of a matrix that are looked at together.
const SQUARE: usize = 64;

/// Builds the contact system of a file; the remarks are for the user.
///
/// # Errors
/// See [`GivenError`].
pub fn given_system(given: &GivenContactSystem) -> Result<(ContactSystem, Vec<String>), GivenError> {
    match &given.matrix {
        GivenMatrix::Stiffness(rows) => {
            let matrix = symmetric(rows);
            judge_entries(("stiffness", &matrix), given.kernel.is_none(), &|row| joint_name(given, row))?;
            from_stiffness(given, matrix)
        }
        GivenMatrix::Compliance(rows) => {
            let matrix = symmetric(rows);
            judge_entries(("compliance", &matrix), true, &|row| joint_name(given, row))?;
            from_compliance(given, matrix)
        }
    }
}

/// The mean of a matrix and its transpose.
fn symmetric(rows: &[Vec<f64>]) -> DMatrix<f64> {
    let n = rows.len();
    let mut matrix = DMatrix::from_vec(n, n, rows.concat());
    // Square by square: of a whole row each entry lies on another page.
    for first in (0..n).step_by(SQUARE) {
        for below in (first..n).step_by(SQUARE) {
            for j in first..n.min(first + SQUARE) {
                for i in below.max(j + 1)..n.min(below + SQUARE) {
                    let mean = 0.5 * (matrix[(i, j)] + matrix[(j, i)]);
                    matrix[(i, j)] = mean;
                    matrix[(j, i)] = mean;
                }
            }
        }
    }
    matrix
}

/// The null space of a matrix, refused where it is indefinite.
fn null_space(key: &'static str, matrix: &DMatrix<f64>) -> Result<(NullSpace, PivotedCholesky), GivenError> {
    let factor = PivotedCholesky::new(matrix);
    let null = factor.null_space(matrix);
    if null.least < -NEGATIVE {
        let scale = factor.scale;
        let scaled = DMatrix::from_fn(scale.len(), scale.len(), |i, j| matrix[(i, j)] / scale[i] / scale[j]);
        // What the null space shows bounds it from above.
        return Err(GivenError::Indefinite { key, smallest: smallest_eigenvalue(&scaled).unwrap_or(null.least) });
    }
    Ok((null, factor))
}

/// A stiffness matrix with its null space. Where it is singular, or nearly so, entries that may be rounding are taken as that
/// unless the motions are then fewer.
fn with_null_space(
    mut matrix: DMatrix<f64>,
    remarks: &mut Vec<String>,
) -> Result<(DMatrix<f64>, NullSpace), GivenError> {
    let taken = take_rounding(&mut matrix);
    let (of_rest, factor) = null_space("stiffness", &matrix)?;
    if taken.is_empty() {
        return Ok((matrix, of_rest));
    }
    // Both have the same motions where the rest resists all others by far more than what was taken can: then the whole needs no
    // look of its own.
    let is_clear = of_rest.near.is_empty() && factor.least_pivot() > FAR * size(&taken, &factor.scale).max(NEARLY);
    if !is_clear {
        set_entries(&mut matrix, &taken, |entry| entry);
        let (null, _) = null_space("stiffness", &matrix)?;
        let is_regular = null.exact.is_empty() && null.near.is_empty();
        if is_regular || of_rest.exact.len() < null.exact.len() || of_rest.near.len() > null.near.len() {
            return Ok((matrix, null));
        }
        set_entries(&mut matrix, &taken, |_| 0.0);
    } else if of_rest.exact.is_empty() {
        set_entries(&mut matrix, &taken, |entry| entry);
        return Ok((matrix, of_rest));
    }
    let entries = match taken.len() {
        1 => "1 entry of the contact stiffness matrix is".to_owned(),
        count => format!("{count} entries of the contact stiffness matrix are"),
    };
    remarks.push(format!("{entries} what rounding leaves of zero: taken as 0, no free motion is held by that"));
    Ok((matrix, of_rest))
}

fn from_stiffness(
    given: &GivenContactSystem,
    matrix: DMatrix<f64>,
) -> Result<(ContactSystem, Vec<String>), GivenError> {
    let mut remarks = Vec::new();
    // What the author knows to be a kernel is one, to the last digit, whatever the digits of the matrix.
    let (motions, data) = match &given.kernel {
        Some(kernel) => {
            let motions: Vec<DVector<f64>> = kernel.iter().map(|z| DVector::from_column_slice(z)).collect();
            let exact = motions.iter().all(|z| is_null(&matrix, z));
            let data = if exact { matrix } else { without_kernel(&matrix, &motions) };
            null_space("stiffness", &data)?;
            (motions, data)
        }
        None => {
            let (matrix, null) = with_null_space(matrix, &mut remarks)?;
            remarks.extend(null.near.iter().map(|z| nearly_singular(given, z, &scales(&matrix))));
            if null.least < -DIGITS * matrix.nrows() as f64 {
                remarks.push(format!(
                    "the contact stiffness matrix is not quite positive semidefinite: scaled to unit diagonal it has an eigenvalue of \
                     {:.1e} or less, which counts as rounding of its entries up to {NEGATIVE:e}",
                    null.least
                ));
            }
            (null.exact, matrix)
        }
    };
    let rows = Rows::of(given);
    let (stiffness, file) = if rows.released.is_empty() {
        (data, None)
    } else {
        let factor = PivotedCholesky::new(&Rows::block(&data, &rows.released, &rows.released));
        (condensed(&data, &rows, &factor), Some((data, factor)))
    };
    // Motions of the kept joints alone that cost nothing: those of the whole, restricted.
    let restricted: Vec<DVector<f64>> = motions.iter().map(|z| rows.over_kept(z.as_slice())).collect();
    let kernel = orthonormal(&restricted, rows.kept.len());
    let corrected = (kernel.ncols() > 0).then(|| without_kernel(&stiffness, &restricted));
    let file = file.map(|(data, factor)| Arc::new(rows.data(data, false, given, factor)));
    let loads = joint_loads(given, &stiffness, file.as_deref())?;
    let rounded = file.is_some();
    let system = ContactSystem {
        pairs: pairs(given),
        tangents: given.tangents,
        stiffness,
        loads,
        rounded,
        groups: Vec::new(),
        kernel,
        corrected,
        force_form: None,
        yielding: None,
        file,
    };
    Ok((system, remarks))
}

/// R with the released joints condensed out: R_kk − R_kr R_rr⁻¹ R_rk. What cancels to rounding is zero.
fn condensed(data: &DMatrix<f64>, rows: &Rows, factor: &PivotedCholesky) -> DMatrix<f64> {
    let coupling = Rows::block(data, &rows.released, &rows.kept);
    let mut response = coupling.clone();
    for (mut column, right) in response.column_iter_mut().zip(coupling.column_iter()) {
        column.copy_from(&factor.solve(&right.into_owned()));
    }
    let mut stiffness = Rows::block(data, &rows.kept, &rows.kept);
    for i in 0..stiffness.nrows() {
        for j in 0..=i {
            let entry = cleaned(stiffness[(i, j)], &coupling.column(i).component_mul(&response.column(j))).0;
            stiffness[(i, j)] = entry;
            stiffness[(j, i)] = entry;
        }
    }
    // A joint without stiffness of its own has none towards others.
    for i in 0..stiffness.nrows() {
        if stiffness[(i, i)] <= 0.0 {
            stiffness.row_mut(i).fill(0.0);
            stiffness.column_mut(i).fill(0.0);
        }
    }
    stiffness
}

/// RF of every load case over the joints that are kept; `file` where some are released or the matrix is a compliance.
fn joint_loads(
    given: &GivenContactSystem,
    stiffness: &DMatrix<f64>,
    file: Option<&FileData>,
) -> Result<Vec<JointLoad>, GivenError> {
    let Some(file) = file else {
        let exact = |load: &GivenLoad| JointLoad::exactly(load.name.clone(), DVector::from_column_slice(&load.vector));
        return Ok(given.loads.iter().map(exact).collect());
    };
    let own = Rows::block(&file.matrix, &file.released, &file.released);
    let free = if file.compliance { Vec::new() } else { file.factor.null_space(&own).exact };
    (given.loads.iter())
        .map(|load| {
            let of = |rows: &[usize]| DVector::from_iterator(rows.len(), rows.iter().map(|&row| load.vector[row]));
            let (kept, released) = (of(&file.kept), of(&file.released));
            for z in &free {
                let work = z.component_mul(&released);
                if work.sum().abs() > NOISE * work.abs().sum() {
                    let pair = given.pairs[file.released_pairs[work.iamax()]].clone();
                    return Err(GivenError::Unheld { case: load.name.clone(), pair });
                }
            }
            let response = if file.compliance { released } else { file.factor.solve(&released) };
            let entry = |i: usize| -> (f64, f64) {
                if file.compliance {
                    return cleaned(0.0, &stiffness.column(i).component_mul(&kept));
                }
                let coupling = file.released.iter().map(|&row| file.matrix[(row, file.kept[i])]);
                cleaned(kept[i], &DVector::from_iterator(response.len(), coupling).component_mul(&response))
            };
            let entries: Vec<(f64, f64)> = (0..kept.len()).map(entry).collect();
            let read = |pick: fn(&(f64, f64)) -> f64| DVector::from_iterator(entries.len(), entries.iter().map(pick));
            Ok(JointLoad { name: load.name.clone(), vector: read(|entry| entry.0), terms: read(|entry| entry.1) })
        })
        .collect()
}

/// The same system under the load vectors of `given`, which has the same matrix and laws.
///
/// # Errors
/// A load along a motion that nothing resists.
pub fn with_loads(system: &ContactSystem, given: &GivenContactSystem) -> Result<ContactSystem, GivenError> {
    if system.repeats_joints() {
        return given_system(given).map(|(system, _)| system);
    }
    let file = system.file.as_ref().map(|file| {
        let loads = given.loads.iter().map(|load| DVector::from_column_slice(&load.vector)).collect();
        Arc::new(FileData { loads, ..FileData::clone(file) })
    });
    let loads = joint_loads(given, &system.stiffness, file.as_deref())?;
    Ok(ContactSystem { loads, file, ..system.clone() })
}

fn from_compliance(
    given: &GivenContactSystem,
    matrix: DMatrix<f64>,
) -> Result<(ContactSystem, Vec<String>), GivenError> {
    null_space("compliance", &matrix)?;
    // Joints that carry no force are simply left out of W: their motion follows.
    let rows = Rows::of(given);
    let own = Rows::block(&matrix, &rows.kept, &rows.kept);
    let factor = PivotedCholesky::new(&own);
    if factor.rank < rows.kept.len() && given.tangents == 2 {
        return repeated_in_space(given, matrix, rows, &own, factor).map(|system| (system, Vec::new()));
    }
    if factor.rank < rows.kept.len() {
        return singular_compliance(given, matrix, rows, own, factor).map(|system| (system, Vec::new()));
    }
    let k = rows.kept.len();
    let inverse = DMatrix::from_columns(
        &(0..k).map(|j| factor.solve(&DVector::from_fn(k, |i, _| f64::from(i == j)))).collect::<Vec<_>>(),
    );
    let stiffness = 0.5 * (&inverse + inverse.transpose());
    let file = rows.data(matrix, true, given, factor);
    let loads = joint_loads(given, &stiffness, Some(&file))?;
    let system = ContactSystem {
        pairs: pairs(given),
        tangents: given.tangents,
        stiffness,
        loads,
        rounded: true,
        groups: Vec::new(),
        kernel: DMatrix::zeros(k, 0),
        corrected: None,
        force_form: None,
        yielding: None,
        file: Some(Arc::new(file)),
    };
    Ok((system, Vec::new()))
}

fn nearly_singular(given: &GivenContactSystem, z: &DVector<f64>, scale: &[f64]) -> String {
    format!(
        "the contact stiffness matrix is nearly singular: it resists the motion {} with less than 1e-10 of what its \
         entries would let expect, and yet its digits say that it does; if that motion costs nothing, say so: `kernel`",
        joints_in_words(given, z, scale)
    )
}

/// R with the motions exactly in its kernel: (I − Q Qᵀ) S (I − Q Qᵀ) scaled back, where S is R scaled to unit diagonal
/// (by powers of two) and Q spans the scaled motions. Without the scaling the rounding of the stiffest joint would
/// swamp the softest ones.
///
/// ```text
///   = S − T Qᵀ − Q Tᵀ,   T = S Q − ½ Q (Qᵀ S Q)
/// ```
fn without_kernel(stiffness: &DMatrix<f64>, motions: &[DVector<f64>]) -> DMatrix<f64> {
    let n = stiffness.nrows();
    let scale = DVector::from_vec(scales(stiffness));
    let motions: Vec<DVector<f64>> = motions.iter().map(|z| z.component_mul(&scale)).collect();
    let q = orthonormal(&motions, n);
    if q.ncols() == n {
        return DMatrix::zeros(n, n);
    }
    let rows_times = |mut matrix: DMatrix<f64>, factors: &DVector<f64>| {
        matrix.column_iter_mut().for_each(|mut column| column.component_mul_assign(factors));
        matrix
    };
    let inverse = scale.map(f64::recip);
    let s_q = rows_times(stiffness * rows_times(q.clone(), &inverse), &inverse);
    let t = &s_q - (&q * (q.transpose() * &s_q)) * 0.5;
    // Scaled back before they are multiplied: what is subtracted has the scale of R.
    let (q, t) = (rows_times(q, &scale), rows_times(t, &scale));
    let mut rest = stiffness.clone();
    for (j, mut column) in rest.column_iter_mut().enumerate() {
        for (q, t) in q.column_iter().zip(t.column_iter()) {
            let (q_j, t_j) = (q[j], t[j]);
            let terms = q.as_slice().iter().zip(t.as_slice());
            // The same sum for (i, j) and (j, i), to the last bit.
            column.as_mut_slice().iter_mut().zip(terms).for_each(|(entry, (q, t))| *entry -= q * t_j + t * q_j);
        }
    }
    // A joint of which only rounding is left moves at no cost; no zero could be told from noise of its size.
    let free: Vec<usize> = (0..n).filter(|&i| rest[(i, i)] * inverse[i] * inverse[i] <= NOISE).collect();
    for i in free {
        rest.row_mut(i).fill(0.0);
        rest.column_mut(i).fill(0.0);
    }
    rest
}
