//! Balance of every part of a structure by hand: loads + contact forces + reactions (of supports and springs) = 0, in
//! x, in y and about a point, each part (what elements and ties join) by itself. Uses nothing of the finite elements but the
//! answer they gave.

use stickslip::answer::record::Answer;
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
    let moved = moved.iter().fold(0f64, |a, d| a.max(d.ux.abs()).max(d.uy.abs()));
    let stiffest = structure.elements.iter().fold(0f64, |a, element| {
        let at = |k: usize| structure.nodes[element.nodes[k]].position;
        let length = (at(1)[0] - at(0)[0]).hypot(at(1)[1] - at(0)[1]);
        let across = if element.nodes.len() == 2 { 1.0 } else { length };
        a.max(structure.materials[element.material].youngs_modulus * element.area() * across / length)
    });
    1e-6 * stiffest * moved
}

/// Length and middle of a bar, area and centroid of a polygon.
fn measure_and_middle(corners: Vec<[f64; 2]>) -> (f64, [f64; 2]) {
    if let [a, b] = corners[..] {
        return ((b[0] - a[0]).hypot(b[1] - a[1]), [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
    }
    let next = corners.iter().cycle().skip(1);
    let mut sum = [0.0; 3];
    for (a, b) in corners.iter().zip(next) {
        let twice = a[0] * b[1] - b[0] * a[1];
        let parts = [0.5 * twice, twice * (a[0] + b[0]) / 6.0, twice * (a[1] + b[1]) / 6.0];
        sum.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
    }
    (sum[0], [sum[1] / sum[0], sum[2] / sum[0]])
}

/// Worst imbalance of any part, relative to the sum of the forces (times lever arms) on the part that carries
/// most.
pub fn imbalance(scenario: &Scenario, values: &ParameterValues, answer: &Answer) -> f64 {
    let Source::Structure(structure) = &scenario.source else {
        return 0.0;
    };
    let label = parts(structure);
    let n = structure.nodes.len();
    let at = |node: usize| structure.nodes[node].in_plane();
    // [F_x, F_y, M about the origin of the axes shifted to the part's first node], and sums of magnitudes.
    let mut sum = vec![[0.0; 3]; n];
    let mut size = vec![[0.0f64; 2]; n];
    let mut add = |node: usize, place: [f64; 2], force: [f64; 2], moment: f64| {
        let part = label[node];
        let origin = at(part);
        let arm = [place[0] - origin[0], place[1] - origin[1]];
        sum[part][0] += force[0];
        sum[part][1] += force[1];
        sum[part][2] += arm[0] * force[1] - arm[1] * force[0] + moment;
        size[part][0] += force[0].hypot(force[1]);
        size[part][1] += arm[0].hypot(arm[1]) * force[0].hypot(force[1]) + moment.abs();
    };
    for case in &structure.load_cases {
        let factor = case.factor.value(values);
        for load in &case.loads {
            match load {
                Load::Nodal { node, force, moment } => {
                    add(*node, at(*node), [force[0], force[1]].map(|f| factor * f), factor * moment[2])
                }
                Load::Element { element, load: ElementLoad::Line { range: [from, to], value: [first, last] } } => {
                    let [a, b] = [0, 1].map(|end| structure.elements[*element].nodes[end]);
                    let ([xa, ya], [xb, yb]) = (at(a), at(b));
                    let length = (xb - xa).hypot(yb - ya);
                    // Simpson's rule is exact for the force and its moment.
                    for (s, weight) in [(*from, 1.0), (0.5 * (from + to), 4.0), (*to, 1.0)] {
                        let t = s / length;
                        let place = [xa + t * (xb - xa), ya + t * (yb - ya)];
                        let share = if to > from { (s - from) / (to - from) } else { 0.0 };
                        let q = [0, 1].map(|i| first[i] + share * (last[i] - first[i]));
                        add(a, place, q.map(|q| factor * q * weight * (to - from) / 6.0), 0.0);
                    }
                }
                Load::Element { element, load: ElementLoad::Point { distance, force, moment } } => {
                    let [a, b] = [0, 1].map(|end| at(structure.elements[*element].nodes[end]));
                    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
                    let place = [0, 1].map(|i| a[i] + distance / length * (b[i] - a[i]));
                    let node = structure.elements[*element].nodes[0];
                    add(node, place, [force[0], force[1]].map(|f| factor * f), factor * moment[2]);
                }
                Load::Element { element, load: ElementLoad::Body(value) } => {
                    let element = &structure.elements[*element];
                    let (measure, middle) = measure_and_middle(element.nodes.iter().map(|&node| at(node)).collect());
                    let volume = measure * element.area();
                    add(element.nodes[0], middle, [value[0], value[1]].map(|b| factor * b * volume), 0.0);
                }
                // They pull one part of a structure against another, and against what holds it.
                Load::Element { load: ElementLoad::FreeStrain { .. }, .. } | Load::Settlement { .. } => {}
            }
        }
    }
    for (pair, state) in structure.pairs.iter().zip(&answer.pairs) {
        let (n, t) = (pair.normal, pair.tangents[0]);
        let force = [0, 1].map(|i| state.x_n * n[i] + state.x_t * t[i]);
        for &(node, weight) in &pair.weights {
            add(node, at(node), force.map(|f| weight * f), 0.0);
        }
    }
    let find = |id: &str| structure.nodes.iter().position(|node| node.id == id);
    for reaction in answer.reactions.as_ref().expect("reactions") {
        let node = find(&reaction.node).expect("a node");
        add(node, at(node), [reaction.fx, reaction.fy], reaction.m);
    }
    // A tie that joins nodes at different places hands over force without its moment: no balance of moments there.
    let mut moments = vec![true; n];
    for tie in &structure.ties {
        let first = at(tie.nodes[0]);
        let apart = tie.nodes.iter().any(|&node| at(node) != first);
        let whole = [Component::X, Component::Y];
        if apart && whole.iter().any(|c| tie.components.contains(c)) {
            moments[label[tie.nodes[0]]] = false;
        }
    }
    // Relative to the part that carries most: one that carries nothing has only rounding.
    let largest = |k: usize| size.iter().fold(0f64, |a, size| a.max(size[k]));
    let floor = floor(structure, answer);
    let (force, moment) = (largest(0).max(floor), largest(1).max(floor));
    // The springs of yielding ground are no reactions: it is held by what the pairs press on it.
    let is_structure = |part: &usize| !structure.yielding_ground.contains(part);
    let mut worst = 0f64;
    for part in (0..n).filter(is_structure) {
        if force > 0.0 {
            worst = worst.max(sum[part][0].abs() / force).max(sum[part][1].abs() / force);
        }
        if moment > 0.0 && moments[part] {
            worst = worst.max(sum[part][2].abs() / moment);
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
    let u = |node: usize| [all[node].ux, all[node].uy, all[node].rz];
    let mut largest = all.iter().fold(0f64, |a, d| a.max(d.ux.abs()).max(d.uy.abs()));
    let mut off = 0f64;
    for (pair, state) in structure.pairs.iter().zip(&answer.pairs) {
        let gap = pair.law.numbers().into_iter().find(|(key, _)| *key == "gap");
        let gap = gap.map_or(0.0, |(_, gap)| gap.value(values));
        let along = |a: [f64; 3]| -> f64 {
            pair.weights.iter().map(|&(node, weight)| weight * (a[0] * u(node)[0] + a[1] * u(node)[1])).sum()
        };
        largest = largest.max(gap).max(state.z_n);
        off = off.max((along(pair.normal) + gap - state.z_n).abs());
        off = off.max((along(pair.tangents[0]) - state.z_t).abs());
    }
    let part = |component: Component| match component {
        Component::X => 0,
        Component::Y => 1,
        Component::Rz => 2,
        other => panic!("{other:?} in the plane"),
    };
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
