//! The kernel of R: loose parts, pins, ties, hinges, and mechanisms inside the structure.

use nalgebra::DVector;

use super::builder::{Model, coulomb, frictionless, point, two_plates};
use crate::fem::MainSystem;
use crate::fem::kernel::mutual_displacements;
use crate::fem::loose::EFFORT;

/// R Z = 0, Z orthonormal, the motions have the same span on the joints, and K agrees that they are free.
#[track_caller]
fn check(model: &Model, expected: usize) -> MainSystem {
    let system = model.solve();
    let (r, z) = (system.stiffness(), system.kernel());
    assert_eq!(z.ncols(), expected, "dimension of the kernel");
    assert!((r * z).amax() <= 1e-15 * r.amax().max(1e-300));
    assert!(*r == r.transpose());
    let identity = nalgebra::DMatrix::identity(expected, expected);
    assert!((z.transpose() * z - identity).amax() < 1e-13);
    assert_eq!(system.kernel_motions().len(), expected);
    let factors = vec![0.0; model.0.load_cases.len()];
    for motion in system.kernel_motions() {
        let trace = mutual_displacements(&model.joints(), &motion.u);
        let outside = &trace - z * (z.transpose() * &trace);
        assert!(outside.amax() < 1e-10 * trace.amax());
        // The displacements that belong to z are the motion itself.
        let u = system.displacements(&factors, &trace);
        for (u, expected) in std::iter::zip(&u.0, &motion.u) {
            for c in 0..3 {
                assert!((u[c] - expected[c]).abs() < 1e-8);
            }
        }
    }
    system
}

#[test]
fn free_plate_has_three_motions() {
    let model = two_plates([8.0, 4.0], [16, 8], 0);
    let system = check(&model, 3);
    assert_eq!((system.size().all, system.size().free), (612, 578));
    // A convenient basis: along x, along y, about the centre.
    let motions = system.kernel_motions();
    let last = model.0.nodes.len() - 1;
    assert_eq!(motions[0].u[last], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(motions[1].u[last], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    assert!(motions.iter().all(|motion| !motion.internal));
    // The traction slides it: Zᵀ RF ≠ 0 exactly by the force, for the unit translation.
    let m = 17;
    let push: f64 = (0..m).map(|i| system.loads()[1][m + i]).sum();
    assert!((push + 4.0).abs() < 1e-14, "{push}");
}

#[test]
fn plate_hinged_by_a_tie_turns_about_it() {
    let model = two_plates([8.0, 4.0], [16, 8], 1);
    let system = check(&model, 1);
    assert_eq!((system.size().all, system.size().free), (612, 576));
    let u = &system.kernel_motions()[0].u;
    let pin = model.0.plates[1].nodes[0][0];
    assert!(u[pin][0].abs() < 1e-12 && u[pin][1].abs() < 1e-12);
}

#[test]
fn plate_tied_twice_is_held() {
    check(&two_plates([8.0, 4.0], [16, 8], 2), 0);
}

#[test]
fn spring_holds_a_sliding_plate() {
    let mut model = two_plates([2.0, 1.0], [4, 2], 0);
    let corner = model.0.plates[1].nodes[2][0];
    model.spring(corner, [1.0, 0.0], 1e-3);
    // Two motions are left: along y and about the corner.
    check(&model, 2);
}

/// Two halves of an arch, hinged at the crown, feet on the ground by friction: as a whole it moves and turns, and
/// the feet spread.
#[test]
fn hinged_halves_spread() {
    for hinge in [false, true] {
        let mut model = Model::default();
        let n = [[-3.0, 0.0], [0.0, 2.0], [3.0, 0.0]].map(|[x, y]| model.node("n", x, y));
        model.hinged(n[0], n[1], 1e4, 1e2, [false, hinge]);
        model.frame(n[1], n[2], 1e4, 1e2);
        model.pair(n[0], None, [0.0, 1.0], coulomb());
        model.pair(n[2], None, [0.0, 1.0], coulomb());
        model.case(vec![point(n[1], [0.0, -10.0])]);
        let system = check(&model, if hinge { 4 } else { 3 });
        if hinge {
            // Statically determinate: thrust F·3/(2·2), pressing the feet inwards; the joints push towards +t = +x
            // on the left, −x on the right.
            let rf = &system.loads()[0];
            let thrust = 10.0 * 3.0 / 4.0;
            assert!((rf[0] - 5.0).abs() < 1e-12 && (rf[1] - 5.0).abs() < 1e-12);
            assert!((rf[2] - thrust).abs() < 1e-12 && (rf[3] + thrust).abs() < 1e-12);
        }
    }
}

/// A truss of so many bars that its parts are looked at by an elimination, with a loose quadrilateral inside: the
/// mechanism is found from them, and from R where they are not looked at one by one. Both span the same space.
#[test]
fn internal_mechanism_of_a_large_truss() {
    let mut model = Model::default();
    let bays = 30;
    let mut below = Vec::new();
    let mut above = Vec::new();
    for i in 0..=bays {
        below.push(model.node("b", i as f64, 0.0));
        above.push(model.node("a", i as f64, 1.0));
    }
    for i in 0..bays {
        model.truss(below[i], below[i + 1], 1e3);
        model.truss(above[i], above[i + 1], 1e3);
        model.truss(below[i], above[i], 1e3);
        if i != 14 {
            model.truss(below[i], above[i + 1], 1e3);
        }
    }
    model.truss(below[bays], above[bays], 1e3);
    for i in [0, 7, 22, bays] {
        model.pair(below[i], None, [0.0, 1.0], coulomb());
    }
    let systems = [EFFORT, 0].map(|effort| {
        MainSystem::with_effort(&model.0, &model.joints(), &crate::watch::Quiet, effort).expect("no mechanism unfelt")
    });
    for (system, from_r) in std::iter::zip(&systems, [0, 1]) {
        assert_eq!(system.kernel().ncols(), 4);
        let internal = system.kernel_motions().iter().filter(|m| m.internal).count();
        assert_eq!(internal, from_r);
        assert!((system.stiffness() * system.kernel()).amax() < 1e-15 * system.stiffness().amax());
    }
    let [one, other] = systems.map(|system| system.kernel() * system.kernel().transpose());
    assert!((one - other).amax() < 1e-9);
}

/// A rope of n straight pieces between two springs: each of the 2 (n + 1) displacements of its nodes is free, but for one
/// condition a piece and one a spring. The motions stretch neither.
#[test]
fn motions_of_a_rope_of_many_pieces() {
    let pieces = 101;
    let turn = 4.0 * std::f64::consts::PI / f64::from(pieces - 1);
    let mut model = Model::default();
    let nodes: Vec<usize> = (0..=pieces)
        .map(|k| {
            let (sin, cos) = ((f64::from(k) - 0.5) * turn).sin_cos();
            model.node("d", cos, sin)
        })
        .collect();
    for ends in nodes.windows(2) {
        model.truss(ends[0], ends[1], 1.0);
    }
    let last = nodes[nodes.len() - 1];
    [nodes[0], last].into_iter().for_each(|end| model.spring(end, [1.0, 0.0], 1e5));
    for &node in &nodes[1..nodes.len() - 1] {
        let [x, y, _] = model.0.nodes[node].position;
        model.pair(node, None, [x, y], coulomb());
    }
    let system = model.solve();
    assert_eq!(system.kernel().ncols(), 2 * nodes.len() - pieces as usize - 2);
    for motion in system.kernel_motions() {
        assert!(!motion.internal);
        let u = |node: usize| [motion.u[node][0], motion.u[node][1]];
        let largest = motion.u.iter().map(|u| u[0].hypot(u[1])).fold(0.0, f64::max);
        let place = |node: usize| model.0.nodes[node].position;
        let stretch =
            |a: usize, b: usize| -> f64 { (0..2).map(|c| (place(b)[c] - place(a)[c]) * (u(b)[c] - u(a)[c])).sum() };
        assert!(nodes.windows(2).all(|ends| f64::abs(stretch(ends[0], ends[1])) < 1e-12 * largest));
        assert!([nodes[0], last].iter().all(|end| u(*end)[0].abs() < 1e-12 * largest));
    }
}

/// A soft part beside a stiff one is not a mechanism.
#[test]
fn stiffness_contrast_is_no_mechanism() {
    for contrast in [1e6, 1e9] {
        let mut model = Model::default();
        let n = [0.0, 1.0, 2.0].map(|x| model.node("n", x, 0.0));
        model.truss(n[0], n[1], contrast);
        model.truss(n[1], n[2], 1.0);
        model.support(n[0], "xy");
        model.pair(n[1], None, [1.0, 0.0], coulomb());
        model.pair(n[2], None, [1.0, 0.0], coulomb());
        model.spring(n[1], [0.0, 1.0], 1.0);
        model.spring(n[2], [0.0, 1.0], 1.0);
        check(&model, 0);
    }
}

/// Nodes on springs of their own under a beam (tensionless foundation): nothing is loose but the beam.
#[test]
fn nodes_on_springs() {
    let mut model = Model::default();
    let mut beam = Vec::new();
    for i in 0..5 {
        let top = model.node("b", i as f64, 0.0);
        let foot = model.node("f", i as f64, 0.0);
        model.spring(foot, [0.0, 1.0], 10.0);
        model.support(foot, "x");
        model.pair(top, Some(foot), [0.0, 1.0], frictionless());
        beam.push(top);
    }
    for nodes in beam.windows(2) {
        model.frame(nodes[0], nodes[1], 1e3, 1e2);
    }
    model.support(beam[0], "x");
    check(&model, 2);
}

/// A motion of the kernel does exactly the work of the loads: RF answers it to the last digits.
#[test]
fn loads_balance_on_the_kernel() {
    let model = two_plates([8.0, 4.0], [16, 8], 0);
    let system = model.solve();
    for (case, rf) in std::iter::zip(&model.0.load_cases, system.loads()) {
        for motion in system.kernel_motions() {
            let trace: DVector<f64> = mutual_displacements(&model.joints(), &motion.u);
            let work: f64 = case
                .loads
                .iter()
                .map(|load| match load {
                    crate::model::structure::Load::Nodal { node, force, .. } => {
                        force[0] * motion.u[*node][0] + force[1] * motion.u[*node][1]
                    }
                    other => panic!("only nodal loads here: {other:?}"),
                })
                .sum();
            assert!((trace.dot(rf) + work).abs() < 1e-13 * rf.amax() * trace.amax() * 17.0);
        }
    }
}
