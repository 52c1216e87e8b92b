//! What must be refused, and what must not.

use super::builder::{Model, coulomb, frictionless, turning, two_plates};
use crate::fem::MainSystemError;
use crate::watch::Watch;

fn message(model: &Model) -> String {
    model.try_solve().unwrap_err().to_string()
}

/// A clamped bar with a pair at its end.
fn bar() -> (Model, [usize; 2]) {
    let mut model = Model::default();
    let (a, b) = (model.node("A", 0.0, 0.0), model.node("B", 2.0, 0.0));
    model.frame(a, b, 10.0, 1.0);
    model.support(a, "xyr");
    (model, [a, b])
}

#[test]
fn joint_held_by_a_support() {
    let (mut model, [_, b]) = bar();
    model.support(b, "x");
    model.pair(b, None, [0.0, 1.0], coulomb());
    assert_eq!(
        message(&model),
        "the tangential joint of c1 is already held by the support at B in x: \
         use `skip`, a `frictionless` pair, or split the node"
    );
    model.0.pairs[0].law = frictionless();
    assert!(model.try_solve().is_ok());
}

#[test]
fn joint_held_by_a_tie() {
    let (mut model, [_, b]) = bar();
    let c = model.node("C", 2.0, 0.0);
    model.tie(&[b, c], "y");
    model.pair(c, Some(b), [0.0, 1.0], coulomb());
    let MainSystemError::DependentJoints(joints) = model.try_solve().unwrap_err() else {
        panic!("dependent joints expected");
    };
    assert_eq!(joints.len(), 1);
    assert_eq!(
        joints[0].to_string(),
        "the normal joint of c1 is already held by the tie of C and B in y: \
         use `skip` or split the node"
    );
}

#[test]
fn joint_repeated_by_another_pair() {
    let (mut model, [_, b]) = bar();
    model.pair(b, None, [0.0, 1.0], coulomb());
    model.pair(b, None, [1.0, 1.0], frictionless());
    let system = model.try_solve().unwrap();
    // Tangentials first, then normals: z_n of c2 = (u_x + u_y)/√2 follows from u_x = z_τ and u_y = z_n of c1.
    let [repeated] = system.repeated() else { panic!("one joint repeats the others") };
    assert_eq!(repeated.joint, 1);
    assert_eq!(system.independent(), [0, 2]);
    let of = |joint: usize| repeated.terms.iter().find(|term| term.0 == joint).unwrap().1;
    assert!((of(0) - 0.5f64.sqrt()).abs() < 1e-15 && (of(2) - 0.5f64.sqrt()).abs() < 1e-15);
}

#[test]
fn joints_round_a_ring_of_pairs() {
    // c1: B on A, c2: C on B, c3: C on A; the third repeats the first two.
    let (mut model, [_, b]) = bar();
    let c = model.node("C", 2.0, 0.0);
    let d = model.node("D", 2.0, 0.0);
    model.support(c, "x");
    model.support(d, "x");
    for (node, against) in [(c, b), (d, c), (d, b)] {
        model.pair(node, Some(against), [0.0, 1.0], frictionless());
    }
    let system = model.try_solve().unwrap();
    let [repeated] = system.repeated() else { panic!("one joint repeats the others") };
    assert_eq!((repeated.joint, &repeated.terms[..]), (2, &[(0, 1.0), (1, 1.0)][..]));
}

#[test]
fn all_dependent_joints_are_told() {
    let mut model = two_plates([2.0, 1.0], [4, 2], 0);
    for i in 1..4 {
        for node in [model.0.plates[1].nodes[0][i], model.0.plates[0].nodes[2][i]] {
            model.support(node, "y");
        }
    }
    let MainSystemError::DependentJoints(joints) = model.try_solve().unwrap_err() else {
        panic!("dependent joints expected");
    };
    let pairs: Vec<usize> = joints.iter().map(|joint| joint.pair).collect();
    assert_eq!(pairs, [1, 2, 3]);
    assert_eq!(
        joints[0].to_string(),
        "the normal joint of c2 is already held by the support at upper[1,0] in y \
         and the support at lower[1,2] in y: use `skip` or split the node"
    );
}

#[test]
fn supported_upper_side_gives_its_joint_to_the_lower() {
    // node held in y, against free: the joint is eliminated on the other side.
    let (mut model, [_, b]) = bar();
    let c = model.node("C", 2.0, 0.0);
    model.support(c, "xy");
    model.pair(c, Some(b), [0.0, -1.0], coulomb());
    let system = model.try_solve().unwrap();
    // R = diag(3EI/L³, EA/L).
    let r = system.stiffness();
    assert!((r[(0, 0)] - 3.0 / 8.0).abs() < 1e-14);
    assert!((r[(1, 1)] - 5.0).abs() < 1e-14);
    assert!(r[(0, 1)].abs() < 1e-15);
}

#[test]
fn mechanisms_name_node_and_direction() {
    // A bar on two frictionless supports slides.
    let mut model = Model::default();
    let (a, b) = (model.node("A", 0.0, 0.0), model.node("B", 2.0, 0.0));
    model.frame(a, b, 10.0, 1.0);
    model.pair(a, None, [0.0, 1.0], frictionless());
    model.pair(b, None, [0.0, 1.0], frictionless());
    assert_eq!(
        message(&model),
        "the structure is a mechanism whatever its contacts do: node A is free to move in x; \
         add a support, a tie, a bar or a spring that holds it"
    );
    // Held in x, it stands.
    model.support(a, "x");
    assert!(model.try_solve().is_ok());

    // A bar hinged at its clamp turns: its end moves along y.
    let (mut model, [_, b]) = bar();
    let c = model.node("C", 5.0, 0.0);
    model.hinged(b, c, 10.0, 1.0, [true, false]);
    let MainSystemError::Mechanism { node, direction, .. } = model.try_solve().unwrap_err() else {
        panic!("a mechanism expected");
    };
    assert_eq!((node, direction.to_string()), (c, "in y".to_owned()));

    // A node that nothing holds.
    let (mut model, _) = bar();
    let lone = model.node("lone", 7.0, 7.0);
    model.support(lone, "x");
    assert!(message(&model).contains("node lone is free to move in y"));
}

/// A square of trusses, and a large one beyond what is examined part by part.
#[test]
fn truss_mechanisms() {
    for bays in [1, 60] {
        let mut model = Model::default();
        let mut last = None;
        for i in 0..=bays {
            let below = model.node(&format!("b{i}"), i as f64, 0.0);
            let above = model.node(&format!("a{i}"), i as f64, 1.0);
            model.truss(below, above, 1.0);
            if let Some((below_last, above_last)) = last {
                model.truss(below_last, below, 1.0);
                model.truss(above_last, above, 1.0);
                if i != 1 {
                    model.truss(below_last, above, 1.0);
                }
            }
            last = Some((below, above));
        }
        model.support(0, "xy");
        model.support(2, "y");
        let error = model.try_solve().unwrap_err();
        assert!(matches!(error, MainSystemError::Mechanism { .. }), "{bays}: {error}");
        // The missing diagonal makes it sound.
        model.truss(0, 3, 1.0);
        assert!(model.try_solve().is_ok(), "{bays}");
    }
}

/// Long slender beams and strong contrasts are ill-conditioned, and sound.
#[test]
fn ill_conditioned_structures_are_not_refused() {
    let mut model = Model::default();
    let n: Vec<usize> = (0..=1000).map(|i| model.node("n", 0.01 * i as f64, 0.0)).collect();
    for nodes in n.windows(2) {
        model.frame(nodes[0], nodes[1], 1.0, 1e-6);
    }
    model.support(n[0], "xyr");
    model.pair(n[1000], None, [0.0, 1.0], coulomb());
    let system = model.try_solve().unwrap();
    let exact = 3.0 * 1e-6 / 1e3;
    assert!((system.stiffness()[(0, 0)] / exact - 1.0).abs() < 1e-3);

    let mut model = Model::default();
    let n = [0.0, 1.0, 2.0].map(|x| model.node("n", x, 0.0));
    model.frame(n[0], n[1], 1e12, 1e12);
    model.frame(n[1], n[2], 1.0, 1.0);
    model.support(n[0], "xyr");
    assert!(model.try_solve().is_ok());
}

#[test]
fn moment_at_a_pin() {
    let mut model = Model::default();
    let (a, b) = (model.node("A", 0.0, 0.0), model.node("B", 2.0, 0.0));
    model.truss(a, b, 10.0);
    model.support(a, "xy");
    model.support(b, "y");
    model.case(vec![turning(b, [0.0, 0.0], 1.0)]);
    assert!(message(&model).starts_with("load case case1 has a moment at node B"));
}

#[test]
fn shapeless_elements() {
    let mut model = Model::default();
    let (a, b) = (model.node("A", 1.0, 0.0), model.node("B", 1.0, 0.0));
    model.truss(a, b, 10.0);
    model.support(a, "xy");
    model.support(b, "xy");
    assert_eq!(message(&model), "the element with the nodes A, B cannot be used: its two nodes are at the same place");
}

#[test]
fn stops_when_told() {
    struct Stop;
    impl Watch for Stop {
        fn stop(&self) -> bool {
            true
        }
    }
    let model = two_plates([2.0, 1.0], [4, 2], 0);
    let result = crate::fem::MainSystem::new(&model.0, &model.joints(), &Stop);
    assert_eq!(result.unwrap_err(), MainSystemError::Interrupted);
}

/// Stops at the first look after a fifth of the factorization.
#[test]
fn stops_within_the_factorization() {
    #[derive(Default)]
    struct Impatient(std::sync::atomic::AtomicBool);
    impl Watch for Impatient {
        fn progress(&self, what: &str, fraction: f64) {
            assert!(!self.stop(), "{what} went on to {fraction}");
            if what.starts_with("factorizing") && fraction > 0.2 {
                self.0.store(true, std::sync::atomic::Ordering::Relaxed);
            }
        }
        fn stop(&self) -> bool {
            self.0.load(std::sync::atomic::Ordering::Relaxed)
        }
    }
    let model = two_plates([8.0, 4.0], [48, 24], 0);
    let watch = Impatient::default();
    let result = crate::fem::MainSystem::new(&model.0, &model.joints(), &watch);
    assert_eq!(result.unwrap_err(), MainSystemError::Interrupted);
    assert!(watch.stop());
}

#[test]
fn everything_held() {
    let mut model = Model::default();
    let (a, b) = (model.node("A", 0.0, 0.0), model.node("B", 2.0, 0.0));
    model.truss(a, b, 10.0);
    model.support(a, "xy");
    model.pair(b, None, [0.0, 1.0], coulomb());
    let system = model.try_solve().unwrap();
    let r = system.stiffness();
    assert!((r[(1, 1)] - 5.0).abs() < 1e-15 && r[(0, 0)] == 0.0);
    assert_eq!(system.kernel().ncols(), 1);
}

#[test]
fn too_large_says_how_large() {
    let error = MainSystemError::TooLarge {
        unknowns: 50_000_000,
        joints: 800,
        needed: 123_400_000_000,
        available: 900_000_000,
    };
    assert_eq!(
        error.to_string(),
        "the model is too large: 50000000 unknowns and 800 joints need 123.4 GB of memory, 900 MB is available; \
         use fewer divisions"
    );
}
