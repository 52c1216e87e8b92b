//! Ill-conditioned is not singular: structures that f64 alone cannot solve, and mechanisms that must still be found.

use nalgebra::DVector;
use proptest::prelude::*;

use super::builder::{Model, coulomb, frictionless, point};
use crate::fem::{JointTerms, MainSystem, MainSystemError};
use crate::model::load::load_text;
use crate::model::pair::joints;
use crate::model::scenario::Source;
use crate::model::structure::Material;
use crate::watch::Quiet;

/// λ = RF and u with every joint on, balanced node by node.
fn main_answer(model: &Model) -> (MainSystem, DVector<f64>, crate::fem::Displacements) {
    let system = model.solve();
    let factors = vec![1.0; model.0.load_cases.len()];
    let mut lambda = DVector::zeros(model.joints().len());
    system.loads().iter().for_each(|rf| lambda += rf);
    let u = system.displacements(&factors, &DVector::zeros(lambda.len()));
    let residual = system.equilibrium_residual(&model.0, &u, &JointTerms::default(), &lambda, &factors);
    assert!(residual < 1e-9, "equilibrium {residual:e}");
    (system, lambda, u)
}

#[track_caller]
fn near(found: f64, expected: f64, share: f64) {
    assert!((found / expected - 1.0).abs() < share, "{found} instead of {expected}");
}

/// A clamped bar of length 1 in n elements, EA = EI = 1, at an angle: R = diag(3EI/L³, EA/L) of a pair at its tip,
/// tip under P across: PL³/3EI; moment at the clamp PL. From some 2 600 elements on its stiffness is below the
/// rounding of K.
#[test]
fn clamped_bars_of_thousands_of_elements() {
    for (elements, degrees) in [(300, 0.0), (2606, 0.0), (2606, 37.0), (6000, 90.0)] {
        let (s, c) = f64::to_radians(degrees).sin_cos();
        let mut model = Model::default();
        let nodes: Vec<usize> =
            (0..=elements).map(|i| f64::from(i) / f64::from(elements)).map(|x| model.node("n", x * c, x * s)).collect();
        for ends in nodes.windows(2) {
            model.frame(ends[0], ends[1], 1.0, 1.0);
        }
        let tip = nodes[nodes.len() - 1];
        model.support(nodes[0], "xyr");
        model.case(vec![point(tip, [-s, c])]);
        let (system, _, u) = main_answer(&model);
        near(-s * u.0[tip][0] + c * u.0[tip][1], 1.0 / 3.0, 1e-9);
        near(u.0[tip][5], 0.5, 1e-9);
        let members = system.member_forces(&model.0, &u, &[1.0]);
        near(members[0].start[2], 1.0, 1e-9);
        near(members[members.len() / 2].start[1], -1.0, 1e-9);
        model.pair(tip, None, [-s, c], coulomb());
        let r = model.solve().stiffness().clone();
        near(r[(0, 0)], 3.0, 1e-9);
        near(r[(1, 1)], 1.0, 1e-9);
        assert!(r[(0, 1)].abs() < 1e-9);
    }
}

/// A beam of two elements, EI = `stiffness`, on nodes with springs, held by pairs only; force P = 10 at its first
/// third node. As a rigid body: x_n,i = P (1/3 + (x_i − 1)(x_P − 1)/2), to the order of kL³/EI.
fn beam_on_springs(stiffness: f64, k: f64) -> Model {
    let mut model = Model::default();
    let nodes = [0.0, 0.5, 1.0, 2.0].map(|x| model.node(&format!("b{x}"), x, 0.0));
    for ends in nodes.windows(2) {
        model.frame(ends[0], ends[1], stiffness, stiffness);
    }
    model.support(nodes[0], "x");
    for node in [nodes[0], nodes[2], nodes[3]] {
        let x = model.0.nodes[node].position[0];
        let ground = model.node(&format!("g{x}"), x, 0.0);
        model.support(ground, "x");
        model.spring(ground, [0.0, 1.0], k);
        model.pair(node, Some(ground), [0.0, 1.0], frictionless());
    }
    model.case(vec![point(nodes[1], [0.0, -10.0])]);
    model
}

#[test]
fn stiffness_contrast() {
    for contrast in [1e6, 1e8, 1e10, 1e13, 1e16] {
        let model = beam_on_springs(1e3 * contrast, 1e3);
        let (_, lambda, u) = main_answer(&model);
        let tolerance = 1e-10 + 10.0 / contrast;
        for (x, n) in [0.0, 1.0, 2.0].into_iter().zip(&lambda) {
            near(*n, 10.0 * (1.0 / 3.0 - (x - 1.0) / 4.0), tolerance);
        }
        // The foundation node gives way by its own force.
        near(u.0[4][1], -lambda[0] / 1e3, tolerance);
    }
}

/// Joint forces wrong by 0.05 % do not pass beside a nearly rigid beam: the foundation node shows it.
#[test]
fn soft_nodes_are_balanced_by_their_own_measure() {
    for stiffness in [1e5, 1e11, 1e16] {
        let model = beam_on_springs(stiffness, 1e3);
        let (system, mut lambda, u) = main_answer(&model);
        lambda[1] *= 1.0005;
        let residual = system.equilibrium_residual(&model.0, &u, &JointTerms::default(), &lambda, &[1.0]);
        assert!(residual > 1e-5, "EI = {stiffness:e}: {residual:e}");
    }
}

/// Beyond what doubled precision can do: refused with the two elements, no claim of a mechanism.
#[test]
fn contrast_beyond_all_precision() {
    let mut model = beam_on_springs(1e20, 1e-10);
    // Without this pair the soft springs alone hold the beam in its main system.
    model.0.pairs.clear();
    model.spring(0, [0.0, 1.0], 1e-10);
    model.spring(3, [0.0, 1.0], 1e-10);
    let error = model.try_solve().unwrap_err();
    let MainSystemError::Contrast { contrast, .. } = &error else {
        panic!("a refusal for the contrast expected, not: {error}");
    };
    // 12 EI/L³ with L = ½ beside the spring.
    near(*contrast, 12.0 * 1e20 * 8.0 / 1e-10, 1e-12);
    let text = error.to_string();
    assert!(text.contains("bar b") && text.contains("the spring at g"), "{text}");
}

/// The refusal of a plate of this size under these contacts.
fn plate_refused(size: &str, contacts: &str) -> MainSystemError {
    let text = r#"{"format":"stickslip/1","title":"t","materials":{"s":{"E":1,"nu":0.2}},
"plates":[{"id":"u","origin":[0,0],"size":SIZE,"divisions":[2,2],"thickness":1,"material":"s","plane":"stress"}],
"contacts":[CONTACTS],"loads":{"w":{"items":[{"point":{"at":"u.top","force":[0.2,-1]}}]}}}"#;
    let scenario = load_text("plate", &text.replace("SIZE", size).replace("CONTACTS", contacts), None).unwrap();
    let Source::Structure(structure) = scenario.source else { panic!("a structure") };
    MainSystem::new(&structure, &joints(&structure.pairs), &Quiet).err().unwrap()
}

/// A plate a million long and a millionth wide bends by (10¹²)³ times what its elements give: no contrast between parts, and
/// told as what it is. At 10⁸ and 10⁻⁸ its foot does not feel that it turns, in 16 digits: no mechanism all the same.
#[test]
fn elements_without_measure_are_told() {
    let foot = r#"{"id":"j","edge":"u.bottom","against":"ground","friction":0.5}"#;
    let error = plate_refused("[1e-6,1e6]", foot);
    assert!(matches!(error, MainSystemError::Slender { .. }), "{error}");
    assert!(error.to_string().contains("too long and thin"), "{error}");
    let error = plate_refused("[1e-8,1e8]", foot);
    assert!(matches!(error, MainSystemError::Lost { share: 5e-17, .. }), "{error:?}");
    assert!(error.to_string().contains("the shortest side of its elements is 5e-17 of"), "{error}");
}

/// A plate that nothing holds is told by its name, not as one of its nodes alone.
#[test]
fn a_plate_that_is_free_is_named() {
    let error =
        plate_refused("[2,1]", r#"{"id":"j","node":"u[1,0]","against":"ground","normal":[0,1],"friction":0.5}"#);
    assert!(error.to_string().contains(": u is free to move, its node u["), "{error}");
}

/// Mechanisms whose coordinates are rounded: a chain of bars hinged end to end along a line at any angle, far from
/// the origin, its ends held.
#[test]
fn rounded_mechanisms_are_mechanisms() {
    for (degrees, offset) in [(0.0, 0.0), (31.0, 0.0), (77.7, 3.3), (123.4, 100.1)] {
        let (s, c) = f64::to_radians(degrees).sin_cos();
        let mut model = Model::default();
        let nodes: Vec<usize> =
            (0..=7).map(|i| f64::from(i) * 0.7).map(|x| model.node("n", offset + x * c, -offset + x * s)).collect();
        for (i, ends) in nodes.windows(2).enumerate() {
            model.truss(ends[0], ends[1], 1.0 + i as f64);
        }
        model.support(nodes[0], "xy");
        model.support(nodes[7], "xy");
        let error = model.try_solve().unwrap_err();
        assert!(matches!(error, MainSystemError::Mechanism { .. }), "{degrees} {offset}: {error}");
    }
}

/// Numbers that stiffnesses cannot be computed with are refused with the element, in one message.
#[test]
fn beyond_numbers() {
    let bar = |e: f64, length: f64| {
        let mut model = Model::default();
        let nodes = [0.0, 1.0, 2.0].map(|x| model.node(&format!("n{x}"), x * length, 0.0));
        for ends in nodes.windows(2) {
            model.frame(ends[0], ends[1], 1.0, 1.0);
        }
        for material in &mut model.0.materials {
            *material = Material { youngs_modulus: e, poisson_ratio: 0.0, density: 0.0, expansion: 0.0 };
        }
        model.support(nodes[0], "xyr");
        model.pair(nodes[2], None, [0.0, 1.0], coulomb());
        model
    };
    for (e, length, what) in [
        (1e-320, 1.0, "stiffness is 1.0e-320"),
        (1e-322, 1000.0, "stiffness is 0.0e0"),
        (1e-210, 1.0, "stiffness is 1.0e-210"),
        (1e300, 1.0, "stiffness is 1.0e300"),
        (1.0, 1e-110, "size is 1.0e-110"),
        (1.0, 1e-320, "size is 1.0e-320"),
        (1.0, 1e100, "size is 1.0e100"),
    ] {
        let text = bar(e, length).try_solve().unwrap_err().to_string();
        assert!(text.contains("nodes n0, n1") && text.contains(what), "{text}");
    }
    assert!(bar(1e-150, 1.0).try_solve().is_ok());
    assert!(bar(1e150, 1.0).try_solve().is_ok());

    let mut model = Model::default();
    let steel = model.material(1e-320, 0.2);
    let grid = model.plate("p", [0.0, 0.0], [1.0, 1.0], [2, 2], (steel, 1.0));
    grid[0].iter().for_each(|&node| model.support(node, "xy"));
    assert!(model.try_solve().unwrap_err().to_string().contains("numbers from 1e-200 to 1e200"));

    let mut model = bar(1.0, 1.0);
    model.spring(1, [0.0, 1.0], 1e-310);
    assert!(model.try_solve().unwrap_err().to_string().contains("its stiffness is 1.0e-310"));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    /// Random bars of random stiffness over sixteen decades, each held at its base or pinned to another: never called
    /// a mechanism, and balanced; with the clamp of one of them released: always a mechanism.
    #[test]
    fn random_contrasts(
        bars in prop::collection::vec((-8.0_f64..8.0, 0.1_f64..3.0, 0.0_f64..6.0), 1..6),
        released in any::<bool>(),
    ) {
        let mut model = Model::default();
        let mut at = [0.3, -0.7];
        let mut node = model.node("base", at[0], at[1]);
        if released {
            model.support(node, "xy");
        } else {
            model.support(node, "xyr");
        }
        for (i, (stiffness, length, angle)) in bars.iter().enumerate() {
            at = [at[0] + length * angle.cos(), at[1] + length * angle.sin()];
            let next = model.node(&format!("n{i}"), at[0], at[1]);
            let k = 10_f64.powf(*stiffness);
            model.frame(node, next, k, k);
            node = next;
        }
        model.case(vec![point(node, [1.0, 2.0])]);
        if released {
            let error = model.try_solve().unwrap_err();
            prop_assert!(matches!(error, MainSystemError::Mechanism { .. }), "{}", error);
        } else {
            let (system, _, u) = main_answer(&model);
            // Statics at the clamp: M = −(r × F).
            let arm = [at[0] - 0.3, at[1] + 0.7];
            let reactions = system.reactions(&model.0, &u, &DVector::zeros(0), &[1.0]);
            let moment = -(arm[0] * 2.0 - arm[1]);
            // Displacements rounded to f64 move the end forces of a bar by as much, and the clamp bears it.
            let reach: f64 = bars.iter().map(|(_, length, _)| length).sum();
            let rounding: f64 = bars
                .iter()
                .zip(u.0.windows(2))
                .map(|(&(stiffness, length, _), ends)| {
                    let most = |part: usize| ends.iter().fold(0.0, |most: f64, end| most.max(end[part].abs()));
                    let (shift, turn) = (most(0) + most(1), most(2));
                    let force = 12.0 * shift / length.powi(3) + 6.0 * turn / length.powi(2) + shift / length;
                    let moment = 6.0 * shift / length.powi(2) + 4.0 * turn / length;
                    4.0 * f64::EPSILON * 10_f64.powf(stiffness) * (force * reach + moment)
                })
                .sum();
            let bound = 1e-9 * (arm[0].abs() + arm[1].abs()) * 3.0 + rounding;
            prop_assert!((reactions[0].moment[2] - moment).abs() < bound, "{} for {moment}", reactions[0].moment[2]);
        }
    }
}

/// A slender wall of plates held by one soft spring sideways: sound, whatever its pivots.
#[test]
fn plate_on_a_soft_spring() {
    let mut model = Model::default();
    let stone = model.material(1e9, 0.2);
    let grid = model.plate("p", [0.0, 0.0], [0.5, 4.0], [2, 16], (stone, 1.0));
    model.support(grid[0][0], "y");
    model.support(grid[0][2], "y");
    let spring = 1e-5;
    model.spring(grid[0][1], [1.0, 0.0], spring);
    let top = grid[16][1];
    model.case(vec![point(top, [1e-6, 0.0])]);
    let (_, _, u) = main_answer(&model);
    near(u.0[grid[0][1]][0], 1e-6 / spring, 1e-9);
}
