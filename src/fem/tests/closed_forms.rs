//! Displacements, forces, R and RF against closed forms worked out beside each test.

use nalgebra::{DMatrix, DVector};

use super::builder::{Model, coulomb, frictionless, main_answer, near, point, two_plates};
use crate::fem::JointTerms;
use crate::model::structure::{ElementLoad, Load, Plane};

#[track_caller]
fn near_forces(found: [f64; 6], expected: [f64; 3]) {
    std::iter::zip(found, expected).for_each(|(found, expected)| near(found, expected));
}

/// Cantilever, L = 4 in two elements, EI = 3, EA = 7, at 30° to x: P across its axis at the tip.
/// v = PL³/3EI, θ = PL²/2EI; M at the clamp: P > 0 along local +y pulls the −y side, M = +PL, Q = −P.
#[test]
fn cantilever() {
    let (s, c) = 30.0_f64.to_radians().sin_cos();
    let mut model = Model::default();
    let nodes = [0.0, 2.0, 4.0].map(|x| model.node("n", x * c, x * s));
    model.frame(nodes[0], nodes[1], 7.0, 3.0);
    model.frame(nodes[1], nodes[2], 7.0, 3.0);
    model.support(nodes[0], "xyr");
    let (p, n) = (0.5, 2.0);
    model.case(vec![point(nodes[2], [n * c - p * s, n * s + p * c])]);
    let (system, u, lambda, factors) = main_answer(&model);
    let [ux, uy, .., theta] = u.0[2];
    near(-s * ux + c * uy, p * 64.0 / 9.0);
    near(c * ux + s * uy, n * 4.0 / 7.0);
    near(theta, p * 16.0 / 6.0);
    let members = system.member_forces(&model.0, &u, &factors);
    near_forces(members[0].start, [n, -p, p * 4.0]);
    near_forces(members[0].end, [n, -p, p * 2.0]);
    near_forces(members[1].end, [n, -p, 0.0]);
    let reactions = system.reactions(&model.0, &u, &lambda, &factors);
    assert_eq!(reactions.len(), 1);
    near(reactions[0].force[0], -(n * c - p * s));
    near(reactions[0].force[1], -(n * s + p * c));
    near(reactions[0].moment[2], -p * 4.0);
    assert_eq!((system.size().all, system.size().free), (9, 6));
    assert_eq!(system.kernel().shape(), (0, 0));
}

/// Propped cantilever under q: prop 3qL/8, clamp 5qL/8 and qL²/8 (Q = dM/dx: 5qL/8 at the clamp, −3qL/8 at the prop).
#[test]
fn propped_cantilever() {
    let mut model = Model::default();
    let (a, b) = (model.node("a", 0.0, 0.0), model.node("b", 5.0, 0.0));
    let bar = model.frame(a, b, 1.0, 2.0);
    model.support(a, "xyr");
    model.support(b, "y");
    let q = 3.0;
    model.case(vec![Load::Element {
        element: bar,
        load: ElementLoad::Line { range: [0.0, 5.0], value: [[0.0, -q, 0.0]; 2] },
    }]);
    let (system, u, lambda, factors) = main_answer(&model);
    let reactions = system.reactions(&model.0, &u, &lambda, &factors);
    near(reactions[0].force[1], 5.0 * q * 5.0 / 8.0);
    near(reactions[0].moment[2], q * 25.0 / 8.0);
    near(reactions[1].force[1], 3.0 * q * 5.0 / 8.0);
    let member = &system.member_forces(&model.0, &u, &factors)[0];
    near_forces(member.start, [0.0, 5.0 * q * 5.0 / 8.0, -q * 25.0 / 8.0]);
    near_forces(member.end, [0.0, -3.0 * q * 5.0 / 8.0, 0.0]);
    // The same with the clamp's rotation held by a hinge at the far end: nothing changes but θ_b, which is gone.
    model.0.elements[bar].kind = crate::model::structure::ElementKind::Frame {
        area: 1.0,
        inertia: 2.0,
        shear_area: None,
        hinges: [false, true],
    };
    let (system, u, ..) = main_answer(&model);
    let hinged = &system.member_forces(&model.0, &u, &factors)[0];
    near_forces(hinged.start, [0.0, 5.0 * q * 5.0 / 8.0, -q * 25.0 / 8.0]);
    // Reported unknowns count three per frame node.
    assert_eq!(system.size().all, 6);
}

/// Gerber beam: clamp at 0, hinge at 2, roller at 5, q on all: M = 0 at the hinge, roller 3q/2 · … by statics.
#[test]
fn gerber_beam() {
    let mut model = Model::default();
    let nodes = [0.0, 2.0, 5.0].map(|x| model.node("n", x, 0.0));
    let first = model.frame(nodes[0], nodes[1], 1.0, 2.0);
    let second = model.hinged(nodes[1], nodes[2], 1.0, 2.0, [true, false]);
    model.support(nodes[0], "xyr");
    model.support(nodes[2], "y");
    let q = 4.0;
    model.case(
        [(first, 2.0), (second, 3.0)]
            .map(|(element, length)| Load::Element {
                element,
                load: ElementLoad::Line { range: [0.0, length], value: [[0.0, -q, 0.0]; 2] },
            })
            .to_vec(),
    );
    let (system, u, lambda, factors) = main_answer(&model);
    let reactions = system.reactions(&model.0, &u, &lambda, &factors);
    // The hung span is simple: q·3/2 at each end; the clamp carries q·2 + q·3/2 and q·2²/2 + (q·3/2)·2.
    near(reactions[1].force[1], 1.5 * q);
    near(reactions[0].force[1], 3.5 * q);
    near(reactions[0].moment[2], 2.0 * q + 3.0 * q);
    let members = system.member_forces(&model.0, &u, &factors);
    near_forces(members[0].end, [0.0, 1.5 * q, 0.0]);
    near_forces(members[1].start, [0.0, 1.5 * q, 0.0]);
}

/// Two trusses from (±3, 4) to the origin, F down: N = F·5/8, v = F L/(2 EA (4/5)²).
#[test]
fn two_bar_truss() {
    let mut model = Model::default();
    let nodes = [[-3.0, 4.0], [3.0, 4.0], [0.0, 0.0]].map(|[x, y]| model.node("n", x, y));
    model.truss(nodes[0], nodes[2], 10.0);
    model.truss(nodes[2], nodes[1], 10.0);
    model.support(nodes[0], "xy");
    model.support(nodes[1], "xy");
    model.case(vec![point(nodes[2], [0.0, -8.0])]);
    let (system, u, _, factors) = main_answer(&model);
    near(u.0[2][1], -8.0 * 5.0 / (2.0 * 10.0 * 0.64));
    for member in system.member_forces(&model.0, &u, &factors) {
        near_forces(member.start, [5.0, 0.0, 0.0]);
        near_forces(member.end, [5.0, 0.0, 0.0]);
    }
}

/// A spring at 45° and a support: hand solution of one equation. Reaction of the tie partner's support.
#[test]
fn springs_and_tied_supports() {
    let mut model = Model::default();
    let nodes = [0.0, 1.0, 1.0].map(|x| model.node("n", x, 0.0));
    model.truss(nodes[0], nodes[1], 5.0);
    model.support(nodes[0], "xy");
    model.tie(&[nodes[1], nodes[2]], "xy");
    model.support(nodes[2], "y");
    let half = 0.5_f64.sqrt();
    model.spring(nodes[2], [half, half], 6.0);
    model.case(vec![point(nodes[1], [8.0, -2.0])]);
    let (system, u, lambda, factors) = main_answer(&model);
    // (5 + 6/2) u = 8.
    near(u.0[1][0], 1.0);
    near(u.0[2][0], 1.0);
    let spring = system.spring_forces(&model.0, &u)[0];
    near(spring, 3.0 * 2.0_f64.sqrt());
    let reactions = system.reactions(&model.0, &u, &lambda, &factors);
    near(reactions[0].force[0], -5.0);
    // The support holds 2 of the load and 3 of the spring, the spring gives its own (−3, −3).
    near(reactions[1].force[0], -3.0);
    near(reactions[1].force[1], 5.0 - 3.0);
}

/// Patch of five distorted quads: a linear displacement of the boundary gives constant stress everywhere.
#[test]
fn patch_of_distorted_quads() {
    let mut model = Model::default();
    let places =
        [[0.0, 0.0], [0.24, 0.0], [0.24, 0.12], [0.0, 0.12], [0.04, 0.02], [0.18, 0.03], [0.16, 0.08], [0.08, 0.08]];
    let n = places.map(|[x, y]| model.node("n", x, y));
    let material = model.material(1e6, 0.25);
    for quad in [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]] {
        model.quad(quad.map(|i| n[i]), material, 0.001, Plane::Stress);
    }
    // Two supports, and pairs that impose the field on the rest of the boundary.
    model.support(n[0], "xy");
    for &node in &n[1..4] {
        model.pair(node, None, [0.0, 1.0], coulomb());
    }
    let system = model.solve();
    let field = |[x, y]: [f64; 2]| [1e-3 * (x + y / 2.0), 1e-3 * (y + x / 2.0)];
    let mut z = DVector::zeros(6);
    for i in 0..3 {
        let [ux, uy] = field(places[i + 1]);
        z[i] = uy;
        z[3 + i] = ux;
    }
    let u = system.displacements(&[], &z);
    for (i, place) in places.into_iter().enumerate() {
        let exact = field(place);
        for (u, exact) in std::iter::zip(u.0[n[i]], exact) {
            assert!((u - exact).abs() < 1e-15);
        }
    }
    // MacNeal & Harder 1985: σ_x = σ_y = 1333, τ = 400.
    for stress in system.element_stresses(&model.0, &u, &[]) {
        near(stress.stress[0], 4000.0 / 3.0);
        near(stress.stress[1], 4000.0 / 3.0);
        near(stress.stress[2], 400.0);
    }
    let lambda = system.stiffness() * &z;
    assert!(system.equilibrium_residual(&model.0, &u, &JointTerms::default(), &lambda, &[]) < 1e-12);
}

/// Unit square, E = 1, ν = 0, t = 1, its top fixed, its two bottom nodes the pairs: R is the block of its
/// stiffness, with D = diag(1, 1, ½). By hand: ∫N1x² = ∫N1y² = 1/3, ∫N1x N2x = −1/3, ∫N1y N2y = 1/6,
/// ∫N1y N1x = ∫N1x N2y = 1/4, ∫N2y N2x = ∫N2x N1y = −1/4.
#[test]
fn unit_square_element() {
    let mut model = Model::default();
    let n = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| model.node("n", x, y));
    let material = model.material(1.0, 0.0);
    model.quad(n, material, 1.0, Plane::Strain);
    model.support(n[2], "xy");
    model.support(n[3], "xy");
    model.pair(n[0], None, [0.0, 1.0], coulomb());
    model.pair(n[1], None, [0.0, 1.0], coulomb());
    let system = model.solve();
    // Rows n1, n2 = u_y; τ1, τ2 = u_x. n1–n2: 1/6 − ½·1/3; τ1–τ2: −1/3 + ½·1/6.
    #[rustfmt::skip]
    let exact = DMatrix::from_row_slice(4, 4, &[
         0.5,    0.0,    0.125,  0.125,
         0.0,    0.5,   -0.125, -0.125,
         0.125, -0.125,  0.5,   -0.25,
         0.125, -0.125, -0.25,   0.5,
    ]);
    assert!((system.stiffness() - exact).amax() < 1e-14);
    assert_eq!(system.kernel().ncols(), 0);
}

/// A bar on m frictional supports every L: R_ττ = EA/L·tridiag(−1, 2, −1) with 1 at both ends, R_nτ = 0, kernel 1 (it
/// slides); RF of a vertical load at each node is the load, of a pull at the end zero but there.
#[test]
fn bar_on_frictional_supports() {
    let (m, length, ea) = (6, 3.0, 500.0);
    let mut model = Model::default();
    let n: Vec<usize> = (0..m).map(|i| model.node("n", length * i as f64, 0.0)).collect();
    for pair in n.windows(2) {
        model.frame(pair[0], pair[1], ea, 20.0);
    }
    for &node in &n {
        model.pair(node, None, [0.0, 1.0], coulomb());
    }
    model.case(n.iter().map(|&node| point(node, [0.0, -60.0])).collect());
    model.case(vec![point(n[m - 1], [1.0, 0.0])]);
    let (system, ..) = main_answer(&model);
    let r = system.stiffness();
    let k = ea / length;
    for i in 0..m {
        for j in 0..m {
            let expected = match i.abs_diff(j) {
                0 if i == 0 || i == m - 1 => k,
                0 => 2.0 * k,
                1 => -k,
                _ => 0.0,
            };
            assert!((r[(m + i, m + j)] - expected).abs() < 1e-12 * k);
            assert!(r[(i, m + j)].abs() < 1e-12 * k);
        }
    }
    // It slides, rises and turns: the three rigid motions.
    assert_eq!(system.kernel().ncols(), 3);
    for i in 0..m {
        near(system.loads()[0][i], 60.0);
        assert!(system.loads()[0][m + i].abs() < 1e-12);
        let pull = if i == m - 1 { -1.0 } else { 0.0 };
        assert!((system.loads()[1][m + i] - pull).abs() < 1e-14);
    }
}

/// Cantilever over a stop: one frictionless pair, R = 3EI/L³, RF = P.
#[test]
fn cantilever_on_a_stop() {
    let mut model = Model::default();
    let (a, b) = (model.node("a", 0.0, 0.0), model.node("b", 4.0, 0.0));
    model.frame(a, b, 1e3, 2.1e4);
    model.support(a, "xyr");
    model.pair(b, None, [0.0, 1.0], frictionless());
    model.case(vec![point(b, [0.0, -50.0])]);
    let system = model.solve();
    assert_eq!(system.stiffness().nrows(), 1);
    near(system.stiffness()[(0, 0)], 3.0 * 2.1e4 / 64.0);
    near(system.loads()[0][0], 50.0);
    // z_n = B u = −0.02 at the stop: reaction P − 3EI g / L³.
    let z = DVector::from_element(1, -0.02);
    let lambda = system.stiffness() * &z + &system.loads()[0];
    near(lambda[0], 30.3125);
    let u = system.displacements(&[1.0], &z);
    near(u.0[1][1], -0.02);
    assert!(system.equilibrium_residual(&model.0, &u, &JointTerms::default(), &lambda, &[1.0]) < 1e-14);
}

/// Two bars end to end, a pair between their nodes, both on supports: the joint force goes through both.
#[test]
fn pair_between_two_bars() {
    let mut model = Model::default();
    let n = [0.0, 2.0, 2.0, 5.0].map(|x| model.node("n", x, 0.0));
    model.truss(n[0], n[1], 4.0);
    model.truss(n[2], n[3], 6.0);
    for (node, fixed) in [(n[0], "xy"), (n[1], "y"), (n[2], "y"), (n[3], "xy")] {
        model.support(node, fixed);
    }
    model.pair(n[2], Some(n[1]), [1.0, 0.0], frictionless());
    model.case(vec![point(n[1], [3.0, 0.0])]);
    let (system, _, lambda, _) = main_answer(&model);
    // Springs 2 and 2 in parallel for the main system; in series for the dislocation: R = 1.
    near(system.stiffness()[(0, 0)], 1.0);
    // Half of the load goes on to the right through the pair, compressed.
    near(lambda[0], 1.5);
}

/// A frame clamped at one end, on three supports, and the same with the third one turned by 45°: x_n of the main system
/// and equilibrium under dislocations, checked against K.
#[test]
fn frame_on_turned_supports() {
    for normal in [[0.0, 1.0], [-1.0, 1.0]] {
        let mut model = Model::default();
        let n: Vec<usize> = (0..7).map(|i| model.node("n", 2.0 * i as f64, 0.0)).collect();
        for pair in n.windows(2) {
            model.frame(pair[0], pair[1], 2.1e6, 2.1e4);
        }
        model.support(n[0], "xyr");
        model.pair(n[2], None, [0.0, 1.0], coulomb());
        model.pair(n[4], None, [0.0, 1.0], coulomb());
        model.pair(n[6], None, normal, coulomb());
        model.case(vec![
            point(n[1], [0.0, -30.0]),
            point(n[3], [0.0, -40.0]),
            point(n[5], [0.0, -20.0]),
            point(n[6], [30.0, 0.0]),
        ]);
        let (system, _, lambda, _) = main_answer(&model);
        if normal[0] == 0.0 {
            for (i, x) in [36.44231, 34.32692, 5.52885].into_iter().enumerate() {
                assert!((lambda[i] - x).abs() < 5e-6);
            }
        }
        let z = DVector::from_iterator(6, (1..7).map(|i| 1e-4 * i as f64));
        let lambda = system.stiffness() * &z + &system.loads()[0];
        let u = system.displacements(&[1.0], &z);
        assert!(system.equilibrium_residual(&model.0, &u, &JointTerms::default(), &lambda, &[1.0]) < 1e-12);
        // A joint force that is off by a millionth is seen.
        let wrong = &lambda * (1.0 + 1e-6);
        assert!(system.equilibrium_residual(&model.0, &u, &JointTerms::default(), &wrong, &[1.0]) > 1e-7);
        let turned = model.joints();
        let found = crate::fem::kernel::mutual_displacements(&turned, &u.0);
        assert!((found - z).amax() < 1e-16);
    }
}

/// The same structure in kN, m and in MN, km.
#[test]
fn units_do_not_matter() {
    let build = |force: f64, length: f64| {
        let mut model = two_plates([8.0, 4.0], [16, 8], 1);
        for node in &mut model.0.nodes {
            node.position = node.position.map(|x| x * length);
        }
        for material in &mut model.0.materials {
            material.youngs_modulus *= force / length.powi(2);
        }
        for element in &mut model.0.elements {
            if let crate::model::structure::ElementKind::Membrane { thickness, .. } = &mut element.kind {
                *thickness *= length;
            }
        }
        for load in model.0.load_cases.iter_mut().flat_map(|case| &mut case.loads) {
            if let Load::Nodal { force: f, .. } = load {
                *f = f.map(|f| f * force);
            }
        }
        model.solve()
    };
    let (a, b) = (build(1.0, 1.0), build(1e-3, 1e-3));
    // R is force per length: its numbers stay.
    let scale = a.stiffness().amax();
    assert!((a.stiffness() - b.stiffness()).amax() < 1e-12 * scale);
    for (a, b) in std::iter::zip(a.loads(), b.loads()) {
        assert!((a * 1e-3 - b).amax() < 1e-12 * b.amax());
    }
    assert_eq!(a.kernel().ncols(), b.kernel().ncols());
}
