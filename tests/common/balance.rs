//! Balance of every part of a structure by hand: loads + contact forces + reactions (of supports and springs) = 0, in
//! every direction and about every axis through a point (in the plane in x, in y and about a point), each part (what
//! elements and ties join) by itself. Uses nothing of the finite elements but the answer they gave.

use stickslip::answer::record::{Answer, PairState};
use stickslip::model::pair::Pair;
use stickslip::model::parameter::ParameterValues;
use stickslip::model::scenario::{Scenario, Source};
use stickslip::model::structure::{Component, ElementLoad, Load, LoadCase, Structure};

/// Parts of the structure as a label per node: nodes joined by elements, ties or rigid bodies.
fn parts(structure: &Structure) -> Vec<usize> {
    let mut label: Vec<usize> = (0..structure.nodes.len()).collect();
    let mut join = |nodes: &[usize]| {
        let to = nodes.iter().map(|&node| label[node]).min().unwrap();
        let from: Vec<usize> = nodes.iter().map(|&node| label[node]).collect();
        for entry in &mut label {
            if from.contains(entry) {
                *entry = to;
            }
        }
    };
    for element in &structure.elements {
        join(&element.nodes);
    }
    for tie in &structure.ties {
        join(&tie.nodes);
    }
    for body in &structure.rigid {
        join(&body.nodes);
    }
    label
}

/// A force that rounding may leave where nothing is loaded: a millionth of what the largest displacement would cost if it
/// were all strain of one element. (The check asks for 1e-9 of a force that is there.)
fn floor(structure: &Structure, answer: &Answer) -> f64 {
    let moved = answer.displacements.as_ref().expect("displacements");
    let moved = moved.iter().fold(0f64, |a, d| d.all()[..3].iter().fold(a, |a, u| a.max(u.abs())));
    let stiffest = structure.elements.iter().fold(0f64, |a, element| {
        let at = |k: usize| structure.nodes[element.nodes[k]].position;
        let length = length(minus(at(1), at(0)));
        let across = length.powi(i32::from(element.shape().dimension()) - 1);
        a.max(structure.materials[element.material].youngs_modulus * element.area() * across / length)
    });
    1e-6 * stiffest * moved
}

type Vector = [f64; 3];

fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// Length and middle of a bar, area and centroid of a polygon in the plane, volume and centroid of a tetrahedron or hexahedron
/// with straight sides.
fn measure_and_middle(solid: bool, corners: &[Vector]) -> (f64, Vector) {
    if let [a, b] = corners[..] {
        return (length(minus(b, a)), [0, 1, 2].map(|i| 0.5 * (a[i] + b[i])));
    }
    // Pieces of known measure and centroid: tetrahedra round the diagonal 0–6, triangles round corner 0.
    let pieces: Vec<Vec<usize>> = match (solid, corners.len()) {
        (true, 8 | 20) => {
            let ring = [1, 2, 3, 7, 4, 5, 1];
            ring.windows(2).map(|edge| vec![0, edge[0], edge[1], 6]).collect()
        }
        (true, _) => vec![vec![0, 1, 2, 3]],
        (false, _) => (1..corners.len() - 1).map(|k| vec![0, k, k + 1]).collect(),
    };
    let mut sum = [0.0; 4];
    for piece in pieces {
        let sides: Vec<Vector> = piece[1..].iter().map(|&k| minus(corners[k], corners[piece[0]])).collect();
        let measure = match sides[..] {
            [a, b] => 0.5 * cross(a, b)[2],
            [a, b, c] => dot(cross(a, b), c) / 6.0,
            _ => unreachable!("triangles and tetrahedra"),
        };
        sum[3] += measure;
        for i in 0..3 {
            sum[i] += measure * piece.iter().map(|&k| corners[k][i]).sum::<f64>() / piece.len() as f64;
        }
    }
    (sum[3], [0, 1, 2].map(|i| sum[i] / sum[3]))
}

/// The force of a pair on its second side.
fn force_of(pair: &Pair, state: &PairState) -> Vector {
    let friction = state.friction();
    [0, 1, 2].map(|i| {
        let along: f64 = pair.tangents.iter().zip(&friction).map(|(t, x_t)| x_t * t[i]).sum();
        state.x_n * pair.normal[i] + along
    })
}

/// Worst imbalance of any part, relative to the sum of the forces (times lever arms) on the part that carries
/// most.
pub fn imbalance(scenario: &Scenario, values: &ParameterValues, answer: &Answer) -> f64 {
    let Source::Structure(structure) = &scenario.source else {
        return 0.0;
    };
    let label = parts(structure);
    let n = structure.nodes.len();
    let at = |node: usize| structure.nodes[node].position;
    // Force, moment about the part's first node, and sums of magnitudes.
    let mut sum = vec![[[0.0; 3]; 2]; n];
    let mut size = vec![[0.0f64; 2]; n];
    let mut add = |node: usize, place: Vector, force: Vector, moment: Vector| {
        let part = label[node];
        let arm = minus(place, at(part));
        let about = cross(arm, force);
        for i in 0..3 {
            sum[part][0][i] += force[i];
            sum[part][1][i] += about[i] + moment[i];
        }
        size[part][0] += length(force);
        size[part][1] += length(arm) * length(force) + length(moment);
    };
    for case in &structure.load_cases {
        let factor = case.factor.value(values);
        let scaled = |vector: &Vector| vector.map(|part| factor * part);
        for load in &case.loads {
            match load {
                Load::Nodal { node, force, moment } => add(*node, at(*node), scaled(force), scaled(moment)),
                Load::Element { element, load: ElementLoad::Line { range: [from, to], value: [first, last] } } => {
                    let [a, b] = [0, 1].map(|end| structure.elements[*element].nodes[end]);
                    let (start, along) = (at(a), minus(at(b), at(a)));
                    // Simpson's rule is exact for the force and its moment.
                    for (s, weight) in [(*from, 1.0), (0.5 * (from + to), 4.0), (*to, 1.0)] {
                        let t = s / length(along);
                        let place = [0, 1, 2].map(|i| start[i] + t * along[i]);
                        let share = if to > from { (s - from) / (to - from) } else { 0.0 };
                        let q = [0, 1, 2].map(|i| first[i] + share * (last[i] - first[i]));
                        add(a, place, q.map(|q| factor * q * weight * (to - from) / 6.0), [0.0; 3]);
                    }
                }
                Load::Element { element, load: ElementLoad::Point { distance, force, moment } } => {
                    let [a, b] = [0, 1].map(|end| at(structure.elements[*element].nodes[end]));
                    let along = minus(b, a);
                    let place = [0, 1, 2].map(|i| a[i] + distance / length(along) * along[i]);
                    add(structure.elements[*element].nodes[0], place, scaled(force), scaled(moment));
                }
                Load::Element { element, load: ElementLoad::Body(value) } => {
                    let element = &structure.elements[*element];
                    let corners: Vec<Vector> = element.nodes.iter().map(|&node| at(node)).collect();
                    let (measure, middle) = measure_and_middle(element.shape().is_solid(), &corners);
                    let volume = measure * element.area();
                    add(element.nodes[0], middle, value.map(|b| factor * b * volume), [0.0; 3]);
                }
                // They pull one part of a structure against another, and against what holds it.
                Load::Element { load: ElementLoad::FreeStrain { .. }, .. } | Load::Settlement { .. } => {}
            }
        }
    }
    for (pair, state) in structure.pairs.iter().zip(&answer.pairs) {
        let force = force_of(pair, state);
        for &(node, weight) in &pair.weights {
            add(node, at(node), force.map(|f| weight * f), [0.0; 3]);
        }
    }
    let find = |id: &str| structure.nodes.iter().position(|node| node.id == id);
    for reaction in answer.reactions.as_ref().expect("reactions") {
        let node = find(&reaction.node).expect("a node");
        let [fz, mx, my] = reaction.space.unwrap_or_default();
        add(node, at(node), [reaction.fx, reaction.fy, fz], [mx, my, reaction.m]);
    }
    // A tie that joins nodes at different places hands over force without its moment: no balance of moments there.
    let mut moments = vec![true; n];
    for tie in &structure.ties {
        let first = at(tie.nodes[0]);
        let apart = tie.nodes.iter().any(|&node| at(node) != first);
        let whole = [Component::X, Component::Y, Component::Z];
        if apart && whole.iter().any(|c| tie.components.contains(c)) {
            moments[label[tie.nodes[0]]] = false;
        }
    }
    // Relative to the part that carries most: one that carries nothing has only rounding.
    let largest = |k: usize| size.iter().fold(0f64, |a, size| a.max(size[k]));
    let floor = floor(structure, answer);
    let (force, moment) = (largest(0).max(floor), largest(1).max(floor));
    // The springs of yielding ground are not reactions: it is held by what the pairs press on it.
    let is_structure = |part: &usize| !structure.yielding_ground.contains(part);
    let mut worst = 0f64;
    for part in (0..n).filter(is_structure) {
        let most = |of: Vector| of.iter().fold(0f64, |most, part| most.max(part.abs()));
        if force > 0.0 {
            worst = worst.max(most(sum[part][0]) / force);
        }
        if moment > 0.0 && moments[part] {
            worst = worst.max(most(sum[part][1]) / moment);
        }
    }
    worst
}

/// Worst imbalance of a node that carries bars only, from the end forces of the members alone: what they hand to the
/// node + loads + contact + reaction (of supports and springs) = 0, in x, in y and in moment. Structures without
/// ties and rigid bodies.
pub fn nodal_imbalance(scenario: &Scenario, values: &ParameterValues, answer: &Answer) -> f64 {
    let Source::Structure(structure) = &scenario.source else {
        return 0.0;
    };
    if !structure.ties.is_empty() || !structure.rigid.is_empty() {
        return 0.0;
    }
    let n = structure.nodes.len();
    let mut sum = vec![[0.0f64; 3]; n];
    let mut largest = [0f64; 2];
    let mut bars_only = vec![true; n];
    let mut add = |node: usize, force: [f64; 3]| {
        for (sum, force) in sum[node].iter_mut().zip(force) {
            *sum += force;
        }
        largest[0] = largest[0].max(force[0].abs()).max(force[1].abs());
        largest[1] = largest[1].max(force[2].abs());
    };
    for element in &structure.elements {
        if element.shape().is_area() {
            element.nodes.iter().for_each(|&node| bars_only[node] = false);
        }
    }
    for member in answer.members.as_ref().expect("members") {
        let bar = structure.bars.iter().find(|bar| bar.id == member.bar).unwrap();
        let nodes = &structure.elements[bar.elements.start + member.element].nodes;
        let [a, b] = [0, 1].map(|end| structure.nodes[nodes[end]].position);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let x = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
        let y = [-x[1], x[0]];
        for (node, sign, end) in [(nodes[0], 1.0, &member.start), (nodes[1], -1.0, &member.end)] {
            let force = [0, 1].map(|i| sign * (end.n * x[i] - end.q * y[i]));
            add(node, [force[0], force[1], sign * end.m]);
        }
    }
    for case in &structure.load_cases {
        let factor = case.factor.value(values);
        for load in &case.loads {
            if let Load::Nodal { node, force, moment } = load {
                add(*node, [factor * force[0], factor * force[1], factor * moment[2]]);
            }
        }
    }
    for (pair, state) in structure.pairs.iter().zip(&answer.pairs) {
        let (n, t) = (pair.normal, pair.tangents[0]);
        let force = [0, 1].map(|i| state.x_n * n[i] + state.x_t * t[i]);
        for &(node, weight) in &pair.weights {
            add(node, [weight * force[0], weight * force[1], 0.0]);
        }
    }
    for reaction in answer.reactions.as_ref().expect("reactions") {
        let node = structure.nodes.iter().position(|node| node.id == reaction.node);
        add(node.unwrap(), [reaction.fx, reaction.fy, reaction.m]);
    }
    largest[0] = largest[0].max(floor(structure, answer));
    let moment = largest[1].max(largest[0]);
    let mut worst = 0f64;
    for node in (0..n).filter(|&node| bars_only[node] && !structure.yielding_ground.contains(&node)) {
        let [x, y, m] = sum[node].map(f64::abs);
        if largest[0] > 0.0 {
            worst = worst.max(x / largest[0]).max(y / largest[0]).max(m / moment);
        }
    }
    worst
}

/// Worst difference between the pairs' z and what the displacements of their nodes give, held and tied components
/// included; relative to the largest displacement.
pub fn incompatibility(scenario: &Scenario, values: &ParameterValues, answer: &Answer) -> f64 {
    let Source::Structure(structure) = &scenario.source else {
        return 0.0;
    };
    let all = answer.displacements.as_ref().expect("displacements");
    // In the order of `Component`: x, y, z, rx, ry, rz.
    let u = |node: usize| all[node].all();
    let mut largest = (0..all.len()).flat_map(|node| u(node)[..3].to_vec()).fold(0f64, |a, u| a.max(u.abs()));
    let mut off = 0f64;
    for (pair, state) in structure.pairs.iter().zip(&answer.pairs) {
        let gap = pair.law.numbers().into_iter().find(|(key, _)| *key == "gap");
        let gap = gap.map_or(0.0, |(_, gap)| gap.value(values));
        let along = |a: Vector| -> f64 {
            pair.weights.iter().map(|&(node, weight)| weight * (0..3).map(|i| a[i] * u(node)[i]).sum::<f64>()).sum()
        };
        largest = largest.max(gap).max(state.z_n);
        off = off.max((along(pair.normal) + gap - state.z_n).abs());
        for (tangent, slip) in pair.tangents.iter().zip(state.slip()) {
            off = off.max((along(*tangent) - slip).abs());
        }
    }
    let part = |component: Component| Component::ALL.iter().position(|own| *own == component).expect("a component");
    for support in &structure.supports {
        let settles = |case: &LoadCase| -> f64 {
            let own = case.loads.iter().map(|load| match load {
                Load::Settlement { node, component, value }
                    if (*node, *component) == (support.node, support.component) =>
                {
                    *value
                }
                _ => 0.0,
            });
            case.factor.value(values) * own.sum::<f64>()
        };
        let settlement: f64 = structure.load_cases.iter().map(settles).sum();
        assert_eq!(u(support.node)[part(support.component)], settlement);
    }
    for tie in &structure.ties {
        for component in &tie.components {
            let first = u(tie.nodes[0])[part(*component)];
            for &node in &tie.nodes {
                assert_eq!(u(node)[part(*component)], first);
            }
        }
    }
    if largest > 0.0 { off / largest } else { off }
}
