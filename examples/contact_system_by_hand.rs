//! A contact system made in Rust, without a file: one node on the ground that wedges itself.
//!
//! `cargo run --example contact_system_by_hand`
//!
//! R = [[2, 1.5], [1.5, 2]] couples the normal and the tangential joint. Beyond f = R_ττ / |R_nτ| = 4/3 a load may have
//! more than one answer; f = 0.5 is below that.

use std::error::Error;
use std::ops::ControlFlow;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use stickslip::contact::law::PairLaw;
use stickslip::contact::lcp::contact_lcp;
use stickslip::contact::problem::ContactProblem;
use stickslip::contact::system::{ContactPair, ContactSystem, JointLoad};
use stickslip::lcp::driver::run;
use stickslip::lcp::lemke::SchemeEngine;
use stickslip::model::pair::Law;
use stickslip::model::parameter::Number;
use stickslip::model::rules::{Covering, TieBreak};

fn main() -> Result<(), Box<dyn Error>> {
    let friction = 0.5;
    let system = ContactSystem {
        tangents: 1,
        pairs: vec![ContactPair {
            id: "c1".to_owned(),
            law: Law::Coulomb {
                friction: Number::Value(friction),
                cohesion: Number::Value(0.0),
                gap: Number::Value(0.0),
            },
            position: None,
            frame: None,
            joint: 0,
            tangential: 1..2,
        }],
        stiffness: DMatrix::from_row_slice(2, 2, &[2.0, 1.5, 1.5, 2.0]),
        loads: vec![JointLoad::exactly("load".to_owned(), DVector::from_row_slice(&[1.0, -2.0]))],
        rounded: false,
        groups: Vec::new(),
        kernel: DMatrix::zeros(2, 0),
        corrected: None,
        force_form: None,
        yielding: None,
        file: None,
    };
    let problem = ContactProblem::new(&Arc::new(system), vec![PairLaw::rubbing(friction, 0.0, 0.0)], &[1.0]);
    let lcp = contact_lcp(&problem, Covering::Cohesive)?;
    let mut engine = SchemeEngine::new(Arc::clone(&lcp.lcp), lcp.tie_rule(TieBreak::Lexicographic));
    let run = run(&mut engine, 100, &mut |pivot| {
        println!(
            "{} enters, {} leaves",
            lcp.name(pivot.entering, &problem.system),
            lcp.name(pivot.leaving, &problem.system)
        );
        ControlFlow::Continue(())
    });
    let point = lcp.in_units(&run.point);
    println!(
        "{:?}: z = {:?}, joints displaced by {}",
        run.outcome,
        point.z,
        lcp.joint_displacements(&problem.system, &point.z)
    );
    Ok(())
}
