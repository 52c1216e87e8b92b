//! A contact system read from a file → joints: tangential joints of frictionless pairs released, kernel exact.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::file_data::FileData;
use super::pivoted::{NullSpace, PivotedCholesky, is_null, orthonormal};
use super::system::{ContactPair, ContactSystem, ForceForm, JointLoad};
use crate::lcp::problem::NOISE;
use crate::model::scenario::{GivenContactSystem, GivenLoad, GivenMatrix};
use stickslip_numerics::decompositions::smallest_eigenvalue;

/// An eigenvalue below −this makes a matrix unusable, after scaling to unit diagonal.
const NEGATIVE: f64 = 1e-9;

/// Why a given contact system cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GivenError {
    /// A matrix with a negative eigenvalue.
    #[error(
        "the {} matrix is not positive semidefinite: scaled to unit diagonal, its smallest eigenvalue is \
         {smallest:.3e}", if *key == "stiffness" { "contact stiffness" } else { "compliance" }
    )]
    Indefinite {
        /// Key of the file.
        key: &'static str,
        /// Smallest eigenvalue.
        smallest: f64,
    },
    /// W in which a normal joint that holds both ways does not move under its own force, the other such joints held.
    #[error(
        "pair {pair} is held along n both ways (law bound), and the compliance matrix says that no force moves it along n \
         where the other such pairs hold: leave it out, or give it another law"
    )]
    Held {
        /// Id of the pair.
        pair: String,
    },
    /// Singular W in space.
    #[error(
        "the compliance matrix is singular: some joints repeat others, which is solved in the plane only so far; give \
         `stiffness`, or a compliance in which no joint repeats others"
    )]
    SingularInSpace,
    /// A load acts on a tangential motion of frictionless pairs that nothing resists.
    #[error("load case {case} pushes frictionless pair {pair} along a tangential motion that nothing resists")]
    Unheld {
        /// Load case.
        case: String,
        /// A pair that moves.
        pair: String,
    },
}

/// Builds the contact system of a file; the remarks are for the user.
///
/// # Errors
/// See [`GivenError`].
pub fn given_system(given: &GivenContactSystem) -> Result<(ContactSystem, Vec<String>), GivenError> {
    match &given.matrix {
        GivenMatrix::Stiffness(rows) => from_stiffness(given, &symmetric(rows)),
        GivenMatrix::Compliance(rows) => from_compliance(given, symmetric(rows)),
    }
}

fn symmetric(rows: &[Vec<f64>]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), rows.len(), |i, j| 0.5 * (rows[i][j] + rows[j][i]))
}

/// The null space of a matrix, refused where it is indefinite.
fn null_space(key: &'static str, matrix: &DMatrix<f64>) -> Result<(PivotedCholesky, NullSpace), GivenError> {
    let factor = PivotedCholesky::new(matrix);
    let null = factor.null_space(matrix);
    if null.least < -NEGATIVE {
        let scale = &factor.scale;
        let scaled = DMatrix::from_fn(scale.len(), scale.len(), |i, j| matrix[(i, j)] / scale[i] / scale[j]);
        // What the null space shows bounds it from above.
        return Err(GivenError::Indefinite { key, smallest: smallest_eigenvalue(&scaled).unwrap_or(null.least) });
    }
    Ok((factor, null))
}

/// Which rows are kept as joints and which are released, and the frictionless pairs of the released ones.
struct Rows {
    kept: Vec<usize>,
    released: Vec<usize>,
    pairs: Vec<usize>,
}

impl Rows {
    fn of(given: &GivenContactSystem) -> Rows {
        let (m, tangents) = (given.pairs.len(), given.tangents);
        let tangential = |i: usize| (0..tangents).map(move |t| m + tangents * i + t);
        let rubs = |i: &usize| given.laws[*i].has_tangential_joint();
        let smooth = || (0..m).filter(|i| !rubs(i));
        Rows {
            kept: (0..m).chain((0..m).filter(rubs).flat_map(tangential)).collect(),
            released: smooth().flat_map(tangential).collect(),
            pairs: smooth().flat_map(|i| (0..tangents).map(move |_| i)).collect(),
        }
    }

    fn block(matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), columns.len(), |a, b| matrix[(rows[a], columns[b])])
    }

    fn data(
        self,
        matrix: DMatrix<f64>,
        compliance: bool,
        given: &GivenContactSystem,
        factor: PivotedCholesky,
    ) -> FileData {
        FileData {
            matrix,
            compliance,
            loads: given.loads.iter().map(|load| DVector::from_column_slice(&load.vector)).collect(),
            kept: self.kept,
            released: self.released,
            released_pairs: self.pairs,
            factor,
        }
    }
}

fn from_stiffness(
    given: &GivenContactSystem,
    matrix: &DMatrix<f64>,
) -> Result<(ContactSystem, Vec<String>), GivenError> {
    let mut remarks = Vec::new();
    // What the author knows to be a kernel is one, to the last digit, whatever the digits of the matrix.
    let (motions, data) = match &given.kernel {
        Some(kernel) => {
            let motions: Vec<DVector<f64>> = kernel.iter().map(|z| DVector::from_column_slice(z)).collect();
            let exact = motions.iter().all(|z| is_null(matrix, z));
            let data = if exact { matrix.clone() } else { without_kernel(matrix, &motions) };
            null_space("stiffness", &data)?;
            (motions, data)
        }
        None => {
            let (whole, null) = null_space("stiffness", matrix)?;
            remarks.extend(null.near.iter().map(|z| nearly_singular(given, z, &whole.scale)));
            (null.exact, matrix.clone())
        }
    };
    let rows = Rows::of(given);
    let factor = PivotedCholesky::new(&Rows::block(&data, &rows.released, &rows.released));
    let stiffness = condensed(&data, &rows, &factor);
    // Motions of the kept joints alone that cost nothing: those of the whole, restricted.
    let restricted: Vec<DVector<f64>> =
        motions.iter().map(|z| DVector::from_fn(rows.kept.len(), |a, _| z[rows.kept[a]])).collect();
    let kernel = orthonormal(&restricted, rows.kept.len());
    let corrected = (kernel.ncols() > 0).then(|| without_kernel(&stiffness, &restricted));
    let file = (!rows.released.is_empty()).then(|| Arc::new(rows.data(data, false, given, factor)));
    let loads = joint_loads(given, &stiffness, file.as_deref())?;
    let rounded = file.is_some();
    let system = ContactSystem {
        pairs: pairs(given),
        tangents: given.tangents,
        stiffness,
        loads,
        rounded,
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
    if rows.released.is_empty() {
        return stiffness;
    }
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
    if system.force_form.is_some() {
        return given_system(given).map(|(system, _)| system);
    }
    let file = system.file.as_ref().map(|file| {
        let loads = given.loads.iter().map(|load| DVector::from_column_slice(&load.vector)).collect();
        Arc::new(FileData { loads, ..FileData::clone(file) })
    });
    let loads = joint_loads(given, &system.stiffness, file.as_deref())?;
    Ok(ContactSystem { loads, file, ..system.clone() })
}

/// start − Σ terms, 0 where rounding alone can have made it, and the sum of all magnitudes.
fn cleaned(start: f64, terms: &DVector<f64>) -> (f64, f64) {
    let (value, size) =
        terms.iter().fold((start, start.abs()), |(value, size), term| (value - term, size + term.abs()));
    (if value.abs() <= NOISE * size { 0.0 } else { value }, size)
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
        return Err(GivenError::SingularInSpace);
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
        kernel: DMatrix::zeros(k, 0),
        corrected: None,
        force_form: None,
        yielding: None,
        file: Some(Arc::new(file)),
    };
    Ok((system, Vec::new()))
}

/// The system of a singular W: all joints in force form except the normals of bound pairs, which are exchanged for
/// their displacements one by one.
fn singular_compliance(
    given: &GivenContactSystem,
    matrix: DMatrix<f64>,
    rows: Rows,
    own: DMatrix<f64>,
    factor: PivotedCholesky,
) -> Result<ContactSystem, GivenError> {
    let k = rows.kept.len();
    let of_load = |load: &GivenLoad| DVector::from_iterator(k, rows.kept.iter().map(|&row| load.vector[row]));
    let mut mixed = Mixed { matrix: own.clone(), loads: given.loads.iter().map(of_load).collect() };
    let mut forced = vec![true; k];
    for (pair, _) in given.laws.iter().enumerate().filter(|(_, law)| law.is_bilateral()) {
        if mixed.matrix[(pair, pair)] <= NOISE * own[(pair, pair)].abs() {
            return Err(GivenError::Held { pair: given.pairs[pair].clone() });
        }
        mixed.exchange(pair);
        forced[pair] = false;
    }
    let mut self_stress = factor.null_space(&own).exact;
    for stress in &mut self_stress {
        let sizes: Vec<f64> = stress.iter().zip(&factor.scale).map(|(force, scale)| (force * scale).abs()).collect();
        let noise = NOISE * sizes.iter().fold(0.0, |a: f64, b| a.max(*b));
        stress.iter_mut().zip(sizes).filter(|(_, size)| *size <= noise).for_each(|(force, _)| *force = 0.0);
    }
    let self_stress = if self_stress.is_empty() { DMatrix::zeros(k, 0) } else { DMatrix::from_columns(&self_stress) };
    let loads = given.loads.iter().zip(mixed.loads);
    let loads = loads.map(|(load, vector)| JointLoad::exactly(load.name.clone(), vector)).collect();
    Ok(ContactSystem {
        pairs: pairs(given),
        tangents: given.tangents,
        stiffness: mixed.matrix,
        loads,
        rounded: false,
        kernel: DMatrix::zeros(k, 0),
        corrected: None,
        force_form: Some(ForceForm { joints: forced, self_stress }),
        yielding: None,
        file: Some(Arc::new(rows.data(matrix, true, given, factor))),
    })
}

/// η = H y + h, with one vector h for each load case.
struct Mixed {
    matrix: DMatrix<f64>,
    loads: Vec<DVector<f64>>,
}

impl Mixed {
    /// Solves row j for y_j: η_j and y_j change places.
    fn exchange(&mut self, j: usize) {
        let a = &mut self.matrix;
        let (k, pivot) = (a.nrows(), a[(j, j)]);
        let (row, column) = (a.row(j).into_owned(), a.column(j).into_owned());
        // What cancels to rounding is not a compliance, nor a displacement.
        let minus = |value: f64, term: f64| {
            let rest = value - term;
            if rest.abs() <= NOISE * (value.abs() + term.abs()) { 0.0 } else { rest }
        };
        for i in (0..k).filter(|&i| i != j) {
            let factor = column[i] / pivot;
            for l in (0..k).filter(|&l| l != j) {
                a[(i, l)] = minus(a[(i, l)], factor * row[l]);
            }
            a[(i, j)] = factor;
            self.loads.iter_mut().for_each(|load| load[i] = minus(load[i], factor * load[j]));
        }
        (0..k).filter(|&l| l != j).for_each(|l| a[(j, l)] = -row[l] / pivot);
        a[(j, j)] = 1.0 / pivot;
        self.loads.iter_mut().for_each(|load| load[j] = -load[j] / pivot);
    }
}

fn pairs(given: &GivenContactSystem) -> Vec<ContactPair> {
    let mut next = given.pairs.len();
    (given.pairs.iter().enumerate())
        .map(|(i, id)| {
            let first = next;
            next += if given.laws[i].has_tangential_joint() { given.tangents } else { 0 };
            ContactPair {
                id: id.clone(),
                law: given.laws[i].clone(),
                position: given.positions.as_ref().map(|s| [s[i], 0.0, 0.0]),
                frame: None,
                joint: 0,
                tangential: first..next,
            }
        })
        .collect()
}

fn nearly_singular(given: &GivenContactSystem, z: &DVector<f64>, scale: &[f64]) -> String {
    format!(
        "the contact stiffness matrix is nearly singular: it resists the motion {} with less than 1e-10 of what its \
         entries would let expect, and yet its digits say that it does; if that motion costs nothing, say so: `kernel`",
        joints_in_words(given, z, scale)
    )
}

/// `1 z_n of c1, -0.5 z_t of c2`, in space z_t1 and z_t2: the entries of a vector over all joints, largest 1; what is
/// small after scaling to unit diagonal is left out.
fn joints_in_words(given: &GivenContactSystem, z: &DVector<f64>, scale: &[f64]) -> String {
    let (m, tangents) = (given.pairs.len(), given.tangents);
    let joint = |i: usize| match i.checked_sub(m) {
        None => ("z_n", i),
        Some(along) if tangents == 1 => ("z_t", along),
        Some(along) => (["z_t1", "z_t2"][along % 2], along / 2),
    };
    let sizes: Vec<f64> = z.iter().zip(scale).map(|(z, scale)| (z * scale).abs()).collect();
    let largest = sizes.iter().fold(0.0, |a: f64, b| a.max(*b));
    let named: Vec<usize> = (0..z.len()).filter(|&i| sizes[i] > 1e-6 * largest).collect();
    let one = |&i: &usize| {
        let share = z[i] / z.amax();
        let share = if share.abs() < 1e-3 {
            format!("{share:.3e}")
        } else {
            format!("{share:.4}").trim_end_matches('0').trim_end_matches('.').to_owned()
        };
        let (word, pair) = joint(i);
        format!("{share} {word} of {}", given.pairs[pair])
    };
    match named.len() {
        0..=6 => named.iter().map(one).collect::<Vec<_>>().join(", "),
        more => format!("{}, … ({more} joints)", named[..5].iter().map(one).collect::<Vec<_>>().join(", ")),
    }
}

/// R with the motions exactly in its kernel: (I − Q Qᵀ) S (I − Q Qᵀ) scaled back, where S is R scaled to unit diagonal
/// (by powers of two) and Q spans the scaled motions. Without the scaling the rounding of the stiffest joint would
/// swamp the softest ones.
fn without_kernel(stiffness: &DMatrix<f64>, motions: &[DVector<f64>]) -> DMatrix<f64> {
    let n = stiffness.nrows();
    let scale = super::pivoted::scales(stiffness);
    let scaled = DMatrix::from_fn(n, n, |i, j| stiffness[(i, j)] / scale[i] / scale[j]);
    let motions: Vec<DVector<f64>> = motions.iter().map(|z| DVector::from_fn(n, |i, _| z[i] * scale[i])).collect();
    let q = orthonormal(&motions, n);
    if q.ncols() == n {
        return DMatrix::zeros(n, n);
    }
    let left = &scaled - &q * (q.transpose() * &scaled);
    let both = &left - (&left * &q) * q.transpose();
    // A joint of which only rounding is left moves at no cost; no zero could be told from noise of its size.
    let is_free = |i: usize| both[(i, i)] <= NOISE;
    DMatrix::from_fn(n, n, |i, j| {
        let entry = 0.5 * (both[(i, j)] + both[(j, i)]) * scale[i] * scale[j];
        if is_free(i) || is_free(j) { 0.0 } else { entry }
    })
}
