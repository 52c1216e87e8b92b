//! Structures in space against closed forms worked out beside each test.

use super::builder::{Model, coulomb, main_answer, near};
use crate::model::pair::{JointDirection, Pair};
use crate::model::space_section::{EndJoint, SpaceSection};
use crate::model::structure::{Bar, Component, Dimension, Element, ElementKind, ElementLoad, Load, Node, Support};

const SECTION: SpaceSection = SpaceSection {
    area: 7.0,
    inertia_y: 2.0,
    inertia_z: 5.0,
    torsion: 3.0,
    shear_area_y: None,
    shear_area_z: Some(4.0),
};

/// In space, with nodes at places.
fn space() -> Model {
    let mut model = Model::default();
    model.0.dimension = Dimension::Space;
    model
}

fn node(model: &mut Model, position: [f64; 3]) -> usize {
    model.0.nodes.push(Node { id: format!("n{}", model.0.nodes.len()), position });
    model.0.nodes.len() - 1
}

/// A bar with E = 1, G = 0.5.
fn bar(model: &mut Model, nodes: [usize; 2], kind: ElementKind) -> usize {
    let (material, index) = (model.material(1.0, 0.0), model.0.elements.len());
    model.0.elements.push(Element { nodes: nodes.to_vec(), material, kind });
    model.0.bars.push(Bar { id: format!("b{index}"), elements: index..index + 1 });
    index
}

fn frame(joints: [EndJoint; 2], orientation: Option<[f64; 3]>) -> ElementKind {
    ElementKind::SpaceFrame { section: SECTION, orientation, joints }
}

fn hold(model: &mut Model, node: usize, components: &[Component]) {
    model.0.supports.extend(components.iter().map(|&component| Support { node, component }));
}

/// Axes of a bar along (1, 2, 2)/3 with local y in the plane of (2, 1, −2): both orthogonal, z = x × y = (−2, 2, −1)/3.
const AXES: [[f64; 3]; 3] =
    [[1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0], [2.0 / 3.0, 1.0 / 3.0, -2.0 / 3.0], [-2.0 / 3.0, 2.0 / 3.0, -1.0 / 3.0]];

fn global(local: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|c| (0..3).map(|axis| local[axis] * AXES[axis][c]).sum())
}

fn local(global: &[f64]) -> [f64; 3] {
    AXES.map(|axis| (0..3).map(|c| axis[c] * global[c]).sum())
}

/// Cantilever of three elements, L = 6, under forces and moments at its tip: FL/EA, FL³/3EI + FL/GA_s ± ML²/2EI, TL/GJ,
/// ± FL²/2EI + ML/EI; internal forces by statics, the reaction is the load turned round.
#[test]
fn cantilever() {
    let mut model = space();
    let nodes = [0.0, 2.0, 4.0, 6.0].map(|s| node(&mut model, global([s, 0.0, 0.0])));
    for ends in nodes.windows(2) {
        bar(&mut model, [ends[0], ends[1]], frame([EndJoint::Rigid; 2], Some(AXES[1])));
    }
    hold(&mut model, nodes[0], &Component::ALL);
    let ([n, y, z], [t, my, mz]) = ([0.7, -1.2, 0.5], [0.4, 0.9, -0.3]);
    model.case(vec![Load::Nodal { node: nodes[3], force: global([n, y, z]), moment: global([t, my, mz]) }]);
    let (system, u, lambda, factors) = main_answer(&model);
    let (shift, turn) = (local(&u.0[nodes[3]][..3]), local(&u.0[nodes[3]][3..]));
    let (l, iy, iz) = (6.0, 2.0, 5.0);
    near(shift[0], n * l / 7.0);
    near(shift[1], y * l * l * l / (3.0 * iz) + mz * l * l / (2.0 * iz));
    near(shift[2], z * l * l * l / (3.0 * iy) + z * l / (0.5 * 4.0) - my * l * l / (2.0 * iy));
    near(turn[0], t * l / (0.5 * 3.0));
    near(turn[1], -z * l * l / (2.0 * iy) + my * l / iy);
    near(turn[2], y * l * l / (2.0 * iz) + mz * l / iz);
    // N, V_y, M_z, V_z, M_y, T at the start of each element: what lies beyond.
    for (k, member) in system.member_forces(&model.0, &u, &factors).iter().enumerate() {
        let arm = l - 2.0 * k as f64;
        let right = [n, -y, y * arm + mz, -z, z * arm - my, t];
        for (found, right) in member.pieces[0].start.iter().zip(right) {
            near(*found, right);
        }
    }
    let reaction = system.reactions(&model.0, &u, &lambda, &factors).remove(0);
    let right = [-n, -y, -z, -t, -my + z * l, -mz - y * l];
    for (found, right) in local(&reaction.force).into_iter().chain(local(&reaction.moment)).zip(right) {
        near(found, right);
    }
}

/// Propped at the far end by a ball joint, q across in both planes: 3qL/8 there (EI alone, without shear), M = −qL²/8
/// at the clamp; and no rotation at the node of the joint.
#[test]
fn propped_by_a_ball_joint() {
    let mut model = space();
    let ends = [0.0, 5.0].map(|s| node(&mut model, global([s, 0.0, 0.0])));
    let section = SpaceSection { shear_area_z: None, ..SECTION };
    let kind =
        ElementKind::SpaceFrame { section, orientation: Some(AXES[1]), joints: [EndJoint::Rigid, EndJoint::Ball] };
    let element = bar(&mut model, ends, kind);
    hold(&mut model, ends[0], &Component::ALL);
    hold(&mut model, ends[1], &Component::TRANSLATIONS);
    let q = global([0.0, -3.0, 2.0]);
    model.case(vec![Load::Element { element, load: ElementLoad::Line { range: [0.0, 5.0], value: [q; 2] } }]);
    let (system, u, lambda, factors) = main_answer(&model);
    let reactions = system.reactions(&model.0, &u, &lambda, &factors);
    let [x, y, z] = local(&reactions[1].force);
    near(x, 0.0);
    near(y, 3.0 * 3.0 * 5.0 / 8.0);
    near(z, -2.0 * 3.0 * 5.0 / 8.0);
    assert_eq!(reactions[1].moment, [0.0; 3]);
    let start = system.member_forces(&model.0, &u, &factors)[0].pieces[0].start;
    for (found, right) in start.into_iter().zip([0.0, 75.0 / 8.0, -75.0 / 8.0, -50.0 / 8.0, 50.0 / 8.0, 0.0]) {
        near(found, right);
    }
}

/// Between ball joints a bar of two elements may spin unfelt: that is held, and loads that come later may not drive it.
#[test]
fn a_held_spin_carries_no_later_torque() {
    let mut model = space();
    let nodes = [0.0, 2.0, 5.0].map(|s| node(&mut model, global([s, 0.0, 0.0])));
    bar(&mut model, [nodes[0], nodes[1]], frame([EndJoint::Ball, EndJoint::Rigid], Some(AXES[1])));
    bar(&mut model, [nodes[1], nodes[2]], frame([EndJoint::Rigid, EndJoint::Ball], Some(AXES[1])));
    [nodes[0], nodes[2]].iter().for_each(|&end| hold(&mut model, end, &Component::TRANSLATIONS));
    let moment = |moment: [f64; 3]| vec![Load::Nodal { node: nodes[1], force: [0.0; 3], moment: global(moment) }];
    model.case(moment([0.0, 0.4, -0.7]));
    let (system, ..) = main_answer(&model);
    model.0.load_cases[0].loads = moment([0.1, 0.4, -0.7]);
    let along = "n1 is free to move by turning about (0.333, 0.667, 0.667)";
    let refused = system.with_loads(&model.0).unwrap_err().to_string();
    assert!(refused.contains(along), "{refused}");
    assert_eq!(model.try_solve().unwrap_err().to_string(), refused);
}

/// A tripod of trusses over the corners of a triangle, height 4: each leg carries its share of a vertical load,
/// N = −(F/3)(l/4), and the tip sinks by F l³/(3 EA 4²).
#[test]
fn tripod() {
    let mut model = space();
    let feet = [0.0, 120.0, 240.0_f64].map(|angle| {
        let (sin, cos) = angle.to_radians().sin_cos();
        node(&mut model, [3.0 * cos, 3.0 * sin, 0.0])
    });
    let tip = node(&mut model, [0.0, 0.0, 4.0]);
    for foot in feet {
        bar(&mut model, [foot, tip], ElementKind::SpaceTruss { area: 2.0, orientation: None });
        hold(&mut model, foot, &Component::TRANSLATIONS);
    }
    model.case(vec![Load::Nodal { node: tip, force: [0.0, 0.0, -6.0], moment: [0.0; 3] }]);
    let (system, u, _, factors) = main_answer(&model);
    for member in system.member_forces(&model.0, &u, &factors) {
        near(member.start[0], -2.0 * 5.0 / 4.0);
    }
    near(u.0[tip][2], -6.0 * 125.0 / (3.0 * 2.0 * 16.0));
    near(u.0[tip][0], 0.0);
}

/// A box of bricks; nodes by x, then y, then z.
fn bricks(
    model: &mut Model,
    origin: [f64; 3],
    size: [f64; 3],
    divisions: [usize; 3],
    material: usize,
    incompatible: bool,
) -> Vec<usize> {
    let [nx, ny, nz] = divisions;
    let mut nodes = Vec::new();
    for (k, j) in (0..=nz).flat_map(|k| (0..=ny).map(move |j| (k, j))) {
        for i in 0..=nx {
            let share = [i as f64 / nx as f64, j as f64 / ny as f64, k as f64 / nz as f64];
            nodes.push(node(model, [0, 1, 2].map(|c| origin[c] + share[c] * size[c])));
        }
    }
    for (k, j) in (0..nz).flat_map(|k| (0..ny).map(move |j| (k, j))) {
        for i in 0..nx {
            let at = |a: usize, b: usize, c: usize| nodes[i + a + (nx + 1) * (j + b + (ny + 1) * (k + c))];
            let of = [at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0)];
            let above = [at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)];
            let kind = ElementKind::Solid { incompatible };
            model.0.elements.push(Element { nodes: [of, above].concat(), material, kind });
        }
    }
    nodes
}

/// A beam of one layer of bricks with incompatible modes, ten times as long as high, bent by a moment M at its end:
/// every node where u = −κxy, v = κ(x² + ν(y² − z²))/2, w = νκyz says, κ = M/EI, and σ_xx = −Eκy.
#[test]
fn a_beam_of_bricks_bends_exactly() {
    let (length, height, width) = (10.0, 1.0, 0.7);
    let (e, nu, kappa) = (30.0, 0.3, 0.01);
    let mut model = space();
    let material = model.material(e, nu);
    let origin = [0.0, -height / 2.0, -width / 2.0];
    let nodes = bricks(&mut model, origin, [length, height, width], [5, 1, 1], material, true);
    for &node in nodes.iter().step_by(6) {
        hold(&mut model, node, &[Component::X]);
    }
    hold(&mut model, nodes[0], &[Component::Y, Component::Z]);
    hold(&mut model, nodes[12], &[Component::Y]);
    // ∫ N σ_xx dA at each corner of the end.
    let corner = e * kappa * height * height * width / 24.0;
    let force = |node: usize, sign: f64| Load::Nodal { node, force: [sign * corner, 0.0, 0.0], moment: [0.0; 3] };
    model.case(vec![force(nodes[5], 1.0), force(nodes[17], 1.0), force(nodes[11], -1.0), force(nodes[23], -1.0)]);
    let (system, u, _, factors) = main_answer(&model);
    let field =
        |[x, y, z]: [f64; 3]| [-kappa * x * y, 0.5 * kappa * (x * x + nu * (y * y - z * z)), nu * kappa * y * z];
    let still = field(model.0.nodes[nodes[0]].position);
    for &node in &nodes {
        let right = field(model.0.nodes[node].position);
        for c in 0..3 {
            near(u.0[node][c], right[c] - still[c]);
        }
    }
    for stress in system.node_stresses(&model.0, &u, &factors) {
        near(stress.stress[0], -e * kappa * model.0.nodes[stress.node].position[1]);
        stress.stress[1..].iter().for_each(|rest| near(*rest, 0.0));
    }
}

/// A block of bricks on the ground, pressed by its weight, pushed and twisted: six rigid motions are the kernel of R,
/// and the joints together hold what acts, force and moment.
#[test]
fn a_block_on_the_ground() {
    let mut model = space();
    let material = model.material(50.0, 0.2);
    let nodes = bricks(&mut model, [1.0, -0.5, 0.0], [3.0, 2.0, 1.0], [3, 2, 2], material, true);
    for &node in &nodes[..12] {
        let (id, normal) = (format!("c{node}"), [0.0, 0.0, 1.0]);
        model.0.pairs.push(Pair::at_node(id, node, None, normal, Dimension::Space, coulomb()));
    }
    let weight = |element: usize| Load::Element { element, load: ElementLoad::Body([0.0, 0.0, -2.0]) };
    model.case((0..model.0.elements.len()).map(weight).collect());
    let push = Load::Nodal { node: nodes[35], force: [0.3, -0.4, 0.1], moment: [0.0; 3] };
    model.case(vec![push]);
    let (system, _, lambda, _) = main_answer(&model);
    assert_eq!(system.stiffness().nrows(), 36);
    assert_eq!(system.kernel().ncols(), 6);
    let r = system.stiffness();
    assert!((r * system.kernel()).amax() < 1e-12 * r.amax());
    let joints = model.joints();
    assert_eq!(joints[12].direction, JointDirection::Tangential(0));
    assert_eq!(joints[13].direction, JointDirection::Tangential(1));
    // Weight 2 · 6 at the middle (2.5, 0.5, 0.5), the push at (4, 1.5, 1).
    let ([mut force, mut moment], cross) = ([[0.0; 3]; 2], crate::model::vector::cross);
    for (joint, lambda) in joints.iter().zip(&lambda) {
        for &(node, a) in &joint.terms {
            let f = a.map(|a| a * lambda);
            let m = cross(model.0.nodes[node].position, f);
            (0..3).for_each(|c| (force[c], moment[c]) = (force[c] + f[c], moment[c] + m[c]));
        }
    }
    let (w, p) = ([0.0, 0.0, -12.0], [0.3, -0.4, 0.1]);
    let (mw, mp) = (cross([2.5, 0.5, 0.5], w), cross([4.0, 1.5, 1.0], p));
    for c in 0..3 {
        near(force[c], -(w[c] + p[c]));
        near(moment[c], -(mw[c] + mp[c]));
    }
}
