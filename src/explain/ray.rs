//! Rays: class by the signs of theory §4, direction, and what it means.

use nalgebra::{DMatrix, DVector};

use super::words::{list, short};
use crate::answer::record::{PairDirection, Ray, RayClass};
use crate::contact::complementarity::{ContactLcp, load_with_gaps};
use crate::contact::numbers::ContactNumbers;
use crate::contact::system::ContactSystem;
use crate::lcp::outcome::RayDirection;
use crate::model::pair::Law;

/// Relative size below which a force or a displacement counts as none.
const NOTHING: f64 = 1e-9;

/// A power below this multiple of the terms it sums is rounding.
const NO_POWER: f64 = 256.0 * f64::EPSILON;

/// Motions of the releasable joints that cost no energy: the kernel of R without what bound pairs hold.
pub fn releasable_kernel(system: &ContactSystem) -> DMatrix<f64> {
    let held: Vec<usize> = (0..system.pairs.len())
        .filter(|&i| matches!(system.pairs[i].law, Law::Bound { .. }))
        .collect();
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
    if free.is_empty() {
        DMatrix::zeros(kernel.nrows(), 0)
    } else {
        DMatrix::from_columns(&free)
    }
}

/// z̄ over the joints, scaled to largest 1, and the class of the ray.
pub fn classify(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    contact: &ContactLcp,
    ray: &RayDirection,
) -> (DVector<f64>, RayClass) {
    let joints = contact.joint_displacements(system, &ray.z);
    let largest_z = ray.z.iter().fold(0.0, |a: f64, b| a.max(*b));
    let largest_w = ray.w.iter().fold(0.0, |a: f64, b| a.max(*b));
    if largest_z > 0.0 && largest_w == 0.0 && ray.p == 0.0 && joints.amax() <= NOTHING * largest_z {
        return (joints, RayClass::Artefact);
    }
    let largest = joints.amax();
    let direction = if largest > 0.0 {
        joints / largest
    } else {
        joints
    };
    if releasable_kernel(system).ncols() == 0 {
        return (direction, RayClass::Fault);
    }
    let load = load_with_gaps(system, numbers);
    let force = (&system.stiffness * &direction).amax();
    // The motion without its rounding: 1e-9 beyond a limit the power is 1e-9 of the terms it sums.
    let motion = &system.kernel * (system.kernel.transpose() * &direction);
    let power = load.dot(&motion);
    let terms = load.abs().dot(&motion.abs());
    let costs_nothing = force <= NOTHING * system.stiffness.amax();
    let class = if largest > 0.0 && costs_nothing && power < -NO_POWER * terms {
        RayClass::Mechanism
    } else {
        RayClass::NoEquilibrium
    };
    (direction, class)
}

/// The ray as the user reads it; p in the user's units.
pub fn report(
    system: &ContactSystem,
    numbers: &ContactNumbers,
    contact: &ContactLcp,
    ray: &RayDirection,
    p: f64,
) -> Ray {
    let (direction, class) = classify(system, numbers, contact, ray);
    let at = |i: usize| {
        (
            direction[i],
            system.pairs[i]
                .tangential
                .map_or(0.0, |joint| direction[joint]),
        )
    };
    let named = |keep: &dyn Fn(f64, f64) -> bool| -> Vec<String> {
        (0..system.pairs.len())
            .filter(|&i| keep(at(i).0, at(i).1))
            .map(|i| system.pairs[i].id.clone())
            .collect()
    };
    let opening = named(&|z_n, _| z_n > NOTHING);
    let plus = named(&|z_n, z_t| z_n <= NOTHING && z_t > NOTHING);
    let minus = named(&|z_n, z_t| z_n <= NOTHING && z_t < -NOTHING);
    let mut parts = Vec::new();
    for (verb, pairs) in [("open", opening), ("slip +", plus), ("slip -", minus)] {
        if !pairs.is_empty() {
            let all = if pairs.len() == system.pairs.len() && pairs.len() > 2 {
                "all pairs".to_owned()
            } else {
                list(&pairs)
            };
            parts.push(format!("{all} {verb}"));
        }
    }
    let mode = match class {
        RayClass::Artefact => "no motion: z+ and z- of one pair grow together".to_owned(),
        _ if parts.is_empty() => "no relative motion of the pairs".to_owned(),
        _ => parts.join("; "),
    };
    let explanation = match class {
        RayClass::Mechanism => format!(
            "The loads do work on this motion and nothing resists it: what is missing is an extra tightening p = {} in \
             every pair.",
            short(p)
        ),
        RayClass::Artefact => "The pivoting rule left x- instead of x_n at an opening pair; this says nothing about \
                               the structure. Use covering cohesive."
            .to_owned(),
        RayClass::Fault => "The structure stands without its contacts, so an answer exists: this ray is a failure of \
                            the chosen rules, not a collapse."
            .to_owned(),
        RayClass::NoEquilibrium => format!(
            "No state that obeys the laws of contact was found below p = {}; the motion is no pure mechanism.",
            short(p)
        ),
    };
    Ray {
        class,
        verdict: None,
        p,
        direction: (0..system.pairs.len())
            .map(|i| {
                let (z_n, z_t) = at(i);
                PairDirection {
                    pair: system.pairs[i].id.clone(),
                    z_n,
                    z_t,
                }
            })
            .collect(),
        mode,
        explanation,
    }
}

/// The ray of a bare LCP.
pub fn plain_report(p: f64) -> Ray {
    Ray {
        class: RayClass::NoEquilibrium,
        verdict: None,
        p,
        direction: Vec::new(),
        mode: "the entering variable grows without bound".to_owned(),
        explanation: format!(
            "No row blocks the entering variable at p = {}: Lemke's algorithm found no answer. For a general M this \
             proves nothing about whether one exists.",
            short(p)
        ),
    }
}
