//! Rigid bodies against the saddle-point problem with every constraint written out, and what holds them too often.

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::builder::{Model, coulomb, frictionless, point, turning};
use crate::fem::dof::Dofs;
use crate::fem::{JointTerms, MainSystemError};
use crate::model::structure::{Component, Load};

/// (base dof, coefficient).
type Terms = Vec<(usize, f64)>;

/// An elastic plate on springs with its top edge rigid and a free node above it in the body; a bar from there to a
/// body of free nodes that is held by a support that settles, a spring and a contact with the ground; a tie to a truss;
/// a body of free nodes held by contacts with the second one only.
fn random_model(seed: u64) -> Model {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut number = |low: f64, high: f64| rng.random_range(low..high);
    let mut model = Model::default();
    let material = model.material(number(50.0, 200.0), 0.2);
    let plate = model.plate("p", [0.0, 0.0], [3.0, 1.0], [3, 2], (material, 1.0));
    for &node in &plate[0] {
        model.spring(node, [0.0, 1.0], number(5.0, 20.0));
        model.spring(node, [1.0, 0.0], number(1.0, 5.0));
    }
    let above = model.node("above", number(1.0, 2.0), number(1.5, 2.5));
    let first = if seed.is_multiple_of(2) { vec![above] } else { Vec::new() };
    let last = if seed.is_multiple_of(2) { Vec::new() } else { vec![above] };
    model.rigid(&[first, plate[2].clone(), last].concat());
    let places = [[4.0, 0.1], [6.0, 0.0], [6.1, 1.9], [3.9, 2.1]];
    let box_nodes: Vec<usize> = places
        .iter()
        .enumerate()
        .map(|(i, p)| model.node(&format!("b{i}"), p[0] + number(-0.1, 0.1), p[1] + number(-0.1, 0.1)))
        .collect();
    model.rigid(&box_nodes);
    model.hinged(
        above,
        box_nodes[3],
        number(20.0, 60.0),
        number(5.0, 20.0),
        [seed.is_multiple_of(3), seed.is_multiple_of(5)],
    );
    model.frame(plate[2][1], box_nodes[0], number(20.0, 60.0), number(5.0, 20.0));
    model.support(box_nodes[1], "x");
    let angle = number(-1.0, 1.0);
    model.spring(box_nodes[2], [angle.sin(), angle.cos()], number(2.0, 9.0));
    model.pair(box_nodes[0], None, [number(-0.2, 0.2), 1.0], coulomb());
    // A truss to a support, pinned to the body by a tie.
    let (a, b) = (model.node("a", 7.5, 1.0), model.node("b", 6.0, 2.0));
    model.truss(a, b, number(10.0, 30.0));
    model.support(a, "xy");
    model.tie(&[b, box_nodes[2]], "xy");
    // On the top of the box.
    let top: Vec<usize> =
        [[4.0, 2.1], [6.1, 1.9], [5.0, 3.5]].map(|p| model.node(&format!("t{}", p[0]), p[0], p[1])).to_vec();
    model.rigid(&top);
    model.pair(top[0], Some(box_nodes[3]), [0.1, 1.0], coulomb());
    model.pair(top[1], Some(box_nodes[2]), [0.1, 1.0], frictionless());
    model.case(vec![
        point(top[2], [number(-1.0, 1.0), -2.0]),
        turning(box_nodes[2], [0.5, 0.0], number(-1.0, 1.0)),
        turning(plate[2][3], [0.0, number(-1.0, 1.0)], 0.7),
        point(plate[1][2], [number(-1.0, 1.0), 0.3]),
    ]);
    model.case(vec![
        Load::Settlement { node: box_nodes[1], component: Component::X, value: number(0.1, 0.3) },
        Load::Settlement { node: a, component: Component::Y, value: number(-0.3, -0.1) },
        turning(above, [0.0; 2], 1.0),
    ]);
    model
}

/// Every constraint as a row over the components with what it equals in both load cases: joints, supports, ties, then
/// bodies, each node against the first.
fn constraints(model: &Model, dofs: &Dofs) -> Vec<(Terms, [f64; 2])> {
    let (structure, joints) = (&model.0, model.joints());
    let at = |node: usize, component: Component| dofs.of(node, component).unwrap();
    let mut rows: Vec<(Terms, [f64; 2])> = Vec::new();
    for joint in &joints {
        let terms = joint.terms.iter();
        let terms = terms.flat_map(|(node, a)| [(at(*node, Component::X), a[0]), (at(*node, Component::Y), a[1])]);
        rows.push((terms.collect(), [0.0; 2]));
    }
    for support in &structure.supports {
        let moved = |load: &Load| match *load {
            Load::Settlement { node, component, value } if node == support.node && component == support.component => {
                value
            }
            _ => 0.0,
        };
        let amounts = [0, 1].map(|case: usize| structure.load_cases[case].loads.iter().map(moved).sum());
        rows.push((vec![(at(support.node, support.component), 1.0)], amounts));
    }
    for tie in &structure.ties {
        for &c in &tie.components {
            rows.push((vec![(at(tie.nodes[0], c), 1.0), (at(tie.nodes[1], c), -1.0)], [0.0; 2]));
        }
    }
    for body in &structure.rigid {
        let first = body.nodes[0];
        let [x0, y0] = structure.nodes[first].in_plane();
        let turn = at(first, Component::Rz);
        for &node in &body.nodes[1..] {
            let [x, y] = structure.nodes[node].in_plane();
            rows.push((vec![(at(node, Component::X), 1.0), (at(first, Component::X), -1.0), (turn, y - y0)], [0.0; 2]));
            rows.push((vec![(at(node, Component::Y), 1.0), (at(first, Component::Y), -1.0), (turn, x0 - x)], [0.0; 2]));
            rows.push((vec![(at(node, Component::Rz), 1.0), (turn, -1.0)], [0.0; 2]));
        }
    }
    rows
}

/// K u − F − Σ (row)ᵀ·multiplier = 0 with all rows: supports, ties, bodies (every node against its first), joints.
#[test]
fn as_with_every_constraint_written_out() {
    for seed in 0..30 {
        let model = random_model(seed);
        let (structure, joints) = (&model.0, model.joints());
        let system = model.solve();
        let dofs = &system.dofs;
        let n = dofs.count();
        let rows = constraints(&model, dofs);
        let size = n + rows.len();
        let mut matrix = DMatrix::zeros(size, size);
        for column in 0..n {
            for (row, value) in system.k.column(column) {
                matrix[(row, column)] = value;
                matrix[(column, row)] = value;
            }
        }
        for (i, (terms, _)) in rows.iter().enumerate() {
            for &(dof, a) in terms {
                matrix[(n + i, dof)] += a;
                matrix[(dof, n + i)] -= a;
            }
        }
        let lu = matrix.lu();
        let solve = |rhs: DVector<f64>| lu.solve(&rhs).expect("regular");
        let k = joints.len();
        let close = |what: &str, found: f64, right: f64, scale: f64| {
            assert!((found - right).abs() <= 1e-10 * scale, "seed {seed}, {what}: {found} {right}");
        };
        let largest = system.stiffness().amax();
        for j in 0..k {
            let mut rhs = DVector::zeros(size);
            rhs[n + j] = 1.0;
            let x = solve(rhs);
            for i in 0..k {
                close("R", system.stiffness()[(i, j)], x[n + i], largest);
            }
        }
        for case in 0..2 {
            let mut factors = [0.0; 2];
            factors[case] = 1.0;
            let mut rhs = DVector::zeros(size);
            rhs.rows_mut(0, n).copy_from(&DVector::from_vec(system.f[case].clone()));
            for (i, (_, amounts)) in rows.iter().enumerate() {
                rhs[n + i] = amounts[case];
            }
            let x = solve(rhs);
            let scale = x.rows(n, rows.len()).amax();
            for i in 0..k {
                close("RF", system.loads()[case][i], x[n + i], scale);
            }
            let u = system.displacements(&factors, &DVector::zeros(k));
            for (found, right) in dofs.gather(&u.0).iter().zip(x.iter()) {
                close("u", *found, *right, x.rows(0, n).amax());
            }
            let lambda = &system.loads()[case];
            let residual = system.equilibrium_residual(structure, &u, &JointTerms::default(), lambda, &factors);
            assert!(residual < 1e-12, "seed {seed}: {residual}");
            // A wrong joint force is out of balance.
            let residual =
                system.equilibrium_residual(structure, &u, &JointTerms::default(), &(lambda * 1.001), &factors);
            assert!(residual > 1e-6, "seed {seed}: {residual}");
            let reactions = system.reactions(structure, &u, lambda, &factors);
            let springs = system.spring_forces(structure, &u);
            for (i, support) in structure.supports.iter().enumerate() {
                let reaction = reactions.iter().find(|reaction| reaction.node == support.node).unwrap();
                close("reaction", reaction.force[support.component as usize], x[n + k + i], scale);
            }
            for (spring, force) in structure.springs.iter().zip(springs) {
                let node = spring.terms[0].node;
                let reaction = reactions.iter().find(|reaction| reaction.node == node).unwrap();
                let of_node = structure.springs.iter().filter(|other| other.terms[0].node == node).count();
                if of_node == 1 {
                    let along = spring.terms.iter().map(|term| term.factor * reaction.force[term.component as usize]);
                    close("spring", along.sum(), -force, scale);
                }
            }
        }
    }
}

fn words(model: &Model) -> String {
    match model.try_solve() {
        Err(error @ (MainSystemError::OverConstrained(_) | MainSystemError::DependentJoints(_))) => error.to_string(),
        other => panic!("{other:?}"),
    }
}

/// A level bar of free nodes: at most three displacements can be held, of them one along it.
#[test]
fn what_holds_a_body_too_often_is_named() {
    let bar = || {
        let mut model = Model::default();
        let nodes = [0.0, 1.0, 3.0].map(|x| model.node(&format!("n{x}"), x, 0.0));
        model.rigid(&nodes);
        (model, nodes)
    };
    let (mut model, [a, b, _]) = bar();
    model.support(a, "xy");
    model.support(b, "x");
    assert_eq!(
        words(&model),
        "the rigid body body1 moves as one, and the support at n0 in x and the support at n1 in x hold more \
         displacements than it has: remove one of them, or hold fewer displacements"
    );
    let (mut model, nodes) = bar();
    for node in nodes {
        model.support(node, "y");
    }
    let text = words(&model);
    for word in ["n0 in y", "n1 in y", "n3 in y"] {
        assert!(text.contains(word), "{text}");
    }
    // Two bodies tied at two places that lie on one level line: the second tie in x is one too many.
    let (mut model, [a, b, _]) = bar();
    let others = [0.0, 1.0].map(|x| model.node(&format!("m{x}"), x, 0.0));
    model.rigid(&others);
    model.tie(&[a, others[0]], "xy");
    model.tie(&[b, others[1]], "x");
    let text = words(&model);
    assert!(text.contains("the rigid body body2 moves as one"), "{text}");
    for word in ["the tie of n0 and m0 in x", "the tie of n1 and m1 in x", "the rigid body body1"] {
        assert!(text.contains(word), "{text}");
    }
}

/// Three normal joints under one body: the third repeats the others, u₃ = u₁ + 3 (u₂ − u₁).
#[test]
fn joints_under_a_body_repeat_one_another() {
    let mut model = Model::default();
    let nodes = [0.0, 1.0, 3.0].map(|x| model.node(&format!("n{x}"), x, 0.0));
    model.rigid(&nodes);
    model.support(nodes[0], "x");
    for node in nodes {
        model.pair(node, None, [0.0, 1.0], frictionless());
    }
    let system = model.try_solve().unwrap();
    let [repeated] = system.repeated() else { panic!("one joint repeats the others") };
    assert_eq!((repeated.joint, &repeated.terms[..]), (2, &[(0, -2.0), (1, 3.0)][..]));
}

/// A block of stiff elements with all its nodes in a body, on soft springs: what the elements are made of does not
/// change the answer, to the last digits, and a load that turns it finds the springs' k a²/2 only.
#[test]
fn elements_inside_a_body_do_not_matter() {
    let answer = |e: f64| {
        let mut model = Model::default();
        let material = model.material(e, 0.3);
        let plate = model.plate("p", [100.0, 50.0], [2.0, 1.0], [4, 2], (material, 1.0));
        model.rigid(&plate.concat());
        for (node, direction) in [(plate[0][0], [0.0, 1.0]), (plate[0][4], [0.0, 1.0]), (plate[0][4], [1.0, 0.0])] {
            model.spring(node, direction, 1e-3);
        }
        model.case(vec![turning(plate[1][2], [0.0; 2], 3e-3)]);
        let system = model.solve();
        let u = system.displacements(&[1.0], &DVector::zeros(0));
        let residual = system.equilibrium_residual(&model.0, &u, &JointTerms::default(), &DVector::zeros(0), &[1.0]);
        assert!(residual < 1e-12, "{residual}");
        u.0
    };
    let [soft, stiff] = [1.0, 1e14].map(answer);
    assert_eq!(soft, stiff);
    // 3e-3 / (2 · 1e-3 · 1²) at every node.
    assert!(soft.iter().all(|u| (u[5] - 1.5).abs() < 1e-13), "{soft:?}");
}
