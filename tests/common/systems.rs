//! Contact systems made from R and a load.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use stickslip::contact::law::PairLaw;
use stickslip::contact::problem::ContactProblem;
use stickslip::contact::system::{ContactPair, ContactSystem, JointLoad};
use stickslip::model::pair::Law;
use stickslip::model::parameter::Number;

/// Coulomb pairs c1, c2, … with one friction, no cohesion and no gaps; joints: all normal ones, then all tangential ones.
pub fn coulomb(stiffness: DMatrix<f64>, load: DVector<f64>, friction: f64) -> ContactProblem {
    let m = load.len() / 2;
    let law = Law::Coulomb { friction: Number::Value(friction), cohesion: Number::Value(0.0), gap: Number::Value(0.0) };
    let pairs = (0..m)
        .map(|i| ContactPair {
            id: format!("c{}", i + 1),
            law: law.clone(),
            position: None,
            frame: None,
            joint: 0,
            tangential: m + i..m + i + 1,
        })
        .collect();
    let system = ContactSystem {
        tangents: 1,
        pairs,
        stiffness,
        loads: vec![JointLoad::exactly("load".into(), load)],
        rounded: false,
        groups: Vec::new(),
        corrected: None,
        force_form: None,
        yielding: None,
        file: None,
        kernel: DMatrix::zeros(2 * m, 0),
    };
    ContactProblem::new(&Arc::new(system), vec![PairLaw::rubbing(friction, 0.0, 0.0); m], &[1.0])
}
