//! The restricted condensation against plain block solves.

use nalgebra::{DMatrix, DVector};

use super::builder::{Model, coulomb, two_plates};
use crate::fem::assembly::{assemble, main_matrices};
use crate::fem::dof::Dofs;
use crate::fem::elimination::Elimination;

/// R = D − Cᵀ K_m⁻¹ C by dense Cholesky.
fn plain(model: &Model) -> DMatrix<f64> {
    let dofs = Dofs::new(&model.0);
    let elimination = Elimination::new(&model.0, &dofs, &model.joints()).unwrap();
    let k = assemble(&model.0, &dofs, &|| false).unwrap();
    let main = main_matrices(&k, &elimination);
    let mut c = DMatrix::zeros(elimination.masters(), elimination.joints());
    for (row, joint, value) in main.c {
        c[(row as usize, joint as usize)] += value;
    }
    let solved = main.k_m.to_dense().cholesky().unwrap().solve(&c);
    main.d - c.transpose() * solved
}

#[test]
fn restricted_condensation_equals_block_solve() {
    let mut models = vec![
        two_plates([8.0, 4.0], [16, 8], 0),
        two_plates([8.0, 4.0], [16, 8], 1),
        two_plates([3.0, 5.0], [7, 11], 2),
    ];
    // Pairs with the ground below, and a turned one between the plates.
    let mut ground = two_plates([4.0, 2.0], [8, 4], 0);
    ground.0.supports.clear();
    for i in 0..=8 {
        let node = ground.0.plates[0].nodes[0][i];
        ground.pair(node, None, [0.3, 1.0], coulomb());
    }
    models.push(ground);
    for model in models {
        let plain = plain(&model);
        let system = model.solve();
        let difference = (system.stiffness() - &plain).amax();
        assert!(difference < 1e-12 * plain.amax(), "{difference:e}");
    }
}

/// R to the last bit on one thread and on several. The long low plates have their interface among the other unknowns,
/// the high ones after them; both have branches and a crown.
#[test]
fn the_factor_does_not_depend_on_the_number_of_threads() {
    for (size, divisions) in [([30.0, 0.4], [300, 4]), ([4.0, 4.0], [40, 40])] {
        let model = two_plates(size, divisions, 0);
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| model.solve().stiffness().clone())
        };
        assert!(with(1) == with(3), "{divisions:?}");
    }
}

/// Interface unknowns among the rest, as their dense block would cost more: R is that of the block solve.
#[test]
fn the_interface_among_the_rest_gives_the_same_stiffness() {
    let model = two_plates([24.0, 0.2], [120, 1], 0);
    let plain = plain(&model);
    let system = model.solve();
    assert!((system.stiffness() - &plain).amax() < 1e-12 * plain.amax());
}

/// B T = 0 and B G = I, whatever holds what.
#[test]
fn elimination_satisfies_the_joints() {
    let mut model = two_plates([4.0, 2.0], [8, 4], 1);
    for (i, normal) in [(2, [0.2, 1.0]), (5, [-1.0, 0.1])] {
        let node = model.0.plates[1].nodes[2][i];
        model.pair(node, None, normal, coulomb());
    }
    let dofs = Dofs::new(&model.0);
    let joints = model.joints();
    let elimination = Elimination::new(&model.0, &dofs, &joints).unwrap();
    let v: Vec<f64> = (0..elimination.masters()).map(|i| (i as f64).sin()).collect();
    let z = DVector::from_fn(joints.len(), |i, _| (i as f64).cos());
    let u = dofs.scatter(&elimination.expand(&v, z.as_slice()));
    let found = crate::fem::kernel::mutual_displacements(&joints, &u);
    assert!((found - z).amax() < 1e-15);
}
