//! A given compliance that is singular: its joints repeat one another.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::error::GivenError;
use super::rows::{Rows, cleaned, joints_in_words, pairs};
use crate::contact::force_form::{Dependence, Repeats, with_repeated};
use crate::contact::pivoted::{PivotedCholesky, scales};
use crate::contact::system::{ContactSystem, ForceForm, JointLoad};
use crate::contact::yielding::yielding;
use crate::lcp::problem::NOISE;
use crate::model::scenario::GivenContactSystem;

/// The system of a singular W: all joints in force form except the normals of bound pairs, which are exchanged for
/// their displacements one by one.
pub(super) fn singular_compliance(
    given: &GivenContactSystem,
    matrix: DMatrix<f64>,
    rows: Rows,
    own: DMatrix<f64>,
    factor: PivotedCholesky,
) -> Result<ContactSystem, GivenError> {
    let k = rows.kept.len();
    let loads = given.loads.iter().map(|load| rows.over_kept(&load.vector));
    let mut mixed = Mixed { matrix: own.clone(), loads: loads.collect() };
    let mut forced = vec![true; k];
    for (pair, _) in given.laws.iter().enumerate().filter(|(_, law)| law.is_bilateral()) {
        if mixed.matrix[(pair, pair)] <= NOISE * own[(pair, pair)].abs() {
            return Err(GivenError::Held { pair: given.pairs[pair].clone() });
        }
        mixed.exchange(pair);
        forced[pair] = false;
    }
    let self_stress = without_noise(factor.null_space(&own).exact, &factor.scale, k);
    let loads = given.loads.iter().zip(mixed.loads);
    let loads = loads.map(|(load, vector)| JointLoad::exactly(load.name.clone(), vector)).collect();
    Ok(ContactSystem {
        pairs: pairs(given),
        tangents: given.tangents,
        stiffness: mixed.matrix,
        loads,
        rounded: false,
        groups: Vec::new(),
        kernel: DMatrix::zeros(k, 0),
        corrected: None,
        force_form: Some(ForceForm { joints: forced, self_stress }),
        yielding: None,
        file: Some(Arc::new(rows.data(matrix, true, given, factor))),
    })
}

/// The system of a singular W in space: with the self-stress N, W N = 0, the displacements of the joints D that repeat
/// others follow from those of the others, I.
///
/// ```text
///     Nᵀ (z − v) = 0   ⇒   z_D = −N_D⁻ᵀ N_Iᵀ z_I + N_D⁻ᵀ Nᵀ v,      R = W_II⁻¹,   RF = −R v_I
/// ```
pub(super) fn repeated_in_space(
    given: &GivenContactSystem,
    matrix: DMatrix<f64>,
    rows: Rows,
    own: &DMatrix<f64>,
    factor: PivotedCholesky,
) -> Result<ContactSystem, GivenError> {
    let bilateral: Vec<usize> = (0..given.laws.len()).filter(|&pair| given.laws[pair].is_bilateral()).collect();
    let held = PivotedCholesky::new(&Rows::block(own, &bilateral, &bilateral));
    if held.rank < bilateral.len() {
        return Err(GivenError::Held { pair: given.pairs[bilateral[held.order[held.rank]]].clone() });
    }
    let (k, null) = (rows.kept.len(), factor.null_space(own));
    let nearly_singular = |forces: &DVector<f64>| {
        let mut all = DVector::zeros(matrix.nrows());
        rows.kept.iter().zip(forces.iter()).for_each(|(&row, force)| all[row] = *force);
        GivenError::NearlySingular { motion: joints_in_words(given, &all, &scales(&matrix)) }
    };
    if let Some(near) = null.near.first() {
        return Err(nearly_singular(near));
    }
    let self_stress = without_noise(null.exact, &factor.scale, k);
    let mut independent = factor.independent().to_vec();
    independent.sort_unstable();
    let repeating = |joint: &usize| independent.binary_search(joint).is_err();
    let repeated: Vec<usize> = (0..k).filter(repeating).collect();
    let across = Rows::block(&self_stress, &repeated, &(0..repeated.len()).collect::<Vec<_>>());
    // Null vectors with a leading entry of their own: as good as diagonal.
    let back = across.transpose().try_inverse().ok_or_else(|| nearly_singular(&self_stress.column(0).into_owned()))?;
    let follows = |one: usize, of: &dyn Fn(usize) -> f64| -> f64 {
        cleaned(0.0, &DVector::from_fn(repeated.len(), |column, _| -back[(one, column)] * of(column))).0
    };
    let terms: Vec<Vec<(usize, f64)>> = (0..repeated.len())
        .map(|one| {
            let term = |&joint: &usize| (joint, -follows(one, &|column| self_stress[(joint, column)]));
            independent.iter().map(term).filter(|(_, factor)| *factor != 0.0).collect()
        })
        .collect();
    let moved: Vec<DVector<f64>> = given.loads.iter().map(|load| rows.over_kept(&load.vector)).collect();
    let offsets = moved.iter().map(|moved| {
        let sum = |column: usize| -cleaned(0.0, &self_stress.column(column).component_mul(moved)).0;
        (0..repeated.len()).map(|one| follows(one, &sum)).collect()
    });
    let offsets: Vec<Vec<f64>> = offsets.collect();
    let at = |joint: usize| factor.solve(&DVector::from_fn(k, |i, _| f64::from(i == joint)));
    let inverse = DMatrix::from_columns(&independent.iter().map(|&joint| at(joint)).collect::<Vec<_>>());
    let inverse = inverse.select_rows(&independent);
    let stiffness = 0.5 * (&inverse + inverse.transpose());
    let loads = given.loads.iter().zip(&moved).map(|(load, moved)| {
        let moved = moved.select_rows(&independent);
        JointLoad { name: load.name.clone(), vector: -(&stiffness * &moved), terms: stiffness.abs() * moved.abs() }
    });
    let system = ContactSystem {
        pairs: pairs(given),
        tangents: given.tangents,
        loads: loads.collect(),
        rounded: true,
        groups: Vec::new(),
        kernel: DMatrix::zeros(independent.len(), 0),
        corrected: None,
        force_form: None,
        yielding: None,
        file: Some(Arc::new(rows.data(matrix, true, given, factor))),
        stiffness,
    };
    let repeats = repeated.iter().zip(&terms).map(|(&joint, terms)| Repeats { joint, terms });
    let dependence = Dependence { independent: &independent, repeated: repeats.collect(), offsets };
    Ok(yielding(with_repeated(system, &dependence)))
}

/// Null vectors of a compliance as columns, without entries that are rounding.
fn without_noise(mut vectors: Vec<DVector<f64>>, scale: &[f64], k: usize) -> DMatrix<f64> {
    for stress in &mut vectors {
        let sizes: Vec<f64> = stress.iter().zip(scale).map(|(force, scale)| (force * scale).abs()).collect();
        let noise = NOISE * sizes.iter().fold(0.0, |a: f64, b| a.max(*b));
        stress.iter_mut().zip(sizes).filter(|(_, size)| *size <= noise).for_each(|(force, _)| *force = 0.0);
    }
    if vectors.is_empty() { DMatrix::zeros(k, 0) } else { DMatrix::from_columns(&vectors) }
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
