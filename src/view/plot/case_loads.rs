//! The loads of each case where a structure has them, before they are multiplied and seen.

use std::cell::OnceCell;
use std::collections::{BTreeMap, HashMap};

use super::loads::{Cases, LineLoad, LoadKind, Loads, Point, Weight};
use crate::model::groups::Groups;
use crate::model::structure::{ElementLoad, Load, LoadCase, Structure};
use crate::model::vector::distance;
use crate::view::projection::Projection;

/// A place in the model, and how it is displaced there.
type Place = [[f64; 3]; 2];

/// The loads of each case as they are under a factor of 1, where a structure has them: what takes a walk over all of them is
/// done once, however they are multiplied, displaced and seen.
#[derive(Clone, Debug, Default)]
pub struct CaseLoads {
    cases: Vec<CaseParts>,
}

/// An element and a range on it.
type Stretch = (usize, [u64; 2]);

/// A line load: where it acts, both ends of that and its values there.
type CaseLine = (Stretch, [Place; 2], [[f64; 3]; 2]);

/// The loads of a case.
#[derive(Clone, Debug, Default)]
struct CaseParts {
    name: String,
    points: Vec<(Place, [f64; 3])>,
    lines: Vec<CaseLine>,
    /// Owner, and what it weighs.
    weights: Vec<((usize, usize), Weight<2>)>,
}

impl CaseLoads {
    /// Those of a structure whose nodes are displaced by u.
    pub fn of(structure: &Structure, u: &[[f64; 6]]) -> CaseLoads {
        let at = |node: usize| -> Place {
            let moved = u.get(node).copied().unwrap_or_default();
            [structure.nodes[node].position, [moved[0], moved[1], moved[2]]]
        };
        let on_bar = |element: usize, distance: f64| -> Place {
            let [a, b] = [0, 1].map(|end| at(structure.elements[element].nodes[end]));
            let share = distance / length(structure, element);
            std::array::from_fn(|k| std::array::from_fn(|c| a[k][c] + share * (b[k][c] - a[k][c])))
        };
        let owner = OnceCell::new();
        let parts = |case: &LoadCase| {
            let mut parts = CaseParts { name: case.name.clone(), ..CaseParts::default() };
            let mut lines: HashMap<Stretch, usize> = HashMap::new();
            let mut weights: BTreeMap<(usize, usize), Weight<2>> = BTreeMap::new();
            for load in &case.loads {
                match *load {
                    Load::Nodal { node, force, .. } => parts.points.push((at(node), force)),
                    Load::Element { element, load: ElementLoad::Point { distance, force, .. } } => {
                        parts.points.push((on_bar(element, distance), force));
                    }
                    Load::Element { element, load: ElementLoad::Line { range, value } } => {
                        let key = (element, range.map(f64::to_bits));
                        let index = *lines.entry(key).or_insert_with(|| {
                            parts.lines.push((key, range.map(|distance| on_bar(element, distance)), [[0.0; 3]; 2]));
                            parts.lines.len() - 1
                        });
                        add(&mut parts.lines[index].2, 1.0, &value);
                    }
                    Load::Element { element, load: ElementLoad::Body(value) } => {
                        let volume = volume(structure, element);
                        let nodes = &structure.elements[element].nodes;
                        let count = nodes.len().max(1) as f64;
                        let mut middle = [[0.0; 3]; 2];
                        nodes.iter().for_each(|&node| add(&mut middle, 1.0 / count, &at(node)));
                        let owner = owner.get_or_init(|| owners(structure));
                        weights.entry(owner[element]).or_default().add(middle, value.map(|b| b * volume));
                    }
                    // They have no direction, or are not forces.
                    Load::Element { load: ElementLoad::FreeStrain { .. }, .. } | Load::Settlement { .. } => {}
                }
            }
            parts.weights = weights.into_iter().collect();
            parts
        };
        CaseLoads { cases: structure.load_cases.iter().map(parts).collect() }
    }

    /// Those in a picture: each case times its factor, displacements times `by`.
    pub fn seen(&self, factors: &[f64], by: f64, projection: &Projection) -> Loads {
        let place = |[at, u]: &Place| -> [f64; 3] { std::array::from_fn(|c| at[c] + by * u[c]) };
        let seen = |at: &Place| projection.seen(place(at));
        let names = self.cases.iter().map(|case| case.name.clone()).collect();
        let mut line_loads: Vec<LineLoad> = Vec::new();
        let mut points: Vec<Point> = Vec::new();
        let mut lines: HashMap<Stretch, usize> = HashMap::new();
        let mut weights: BTreeMap<(usize, usize), (Weight<2>, Cases)> = BTreeMap::new();
        let acting = self.cases.iter().zip(factors).enumerate().filter(|(_, (_, factor))| **factor != 0.0);
        for (number, (case, &factor)) in acting {
            let cases = 1 << number.min(127);
            let times = |force: &[f64; 3]| force.map(|f| factor * f);
            points.extend(case.points.iter().map(|(at, force)| (LoadKind::Force, seen(at), times(force), cases)));
            for (key, ends, value) in &case.lines {
                let index = *lines.entry(*key).or_insert_with(|| {
                    line_loads.push((ends.each_ref().map(seen), [[0.0; 3]; 2], 0));
                    line_loads.len() - 1
                });
                let (_, sums, of) = &mut line_loads[index];
                *of |= cases;
                add(sums, factor, value);
            }
            for (owner, weight) in &case.weights {
                let (sum, of) = weights.entry(*owner).or_default();
                *of |= cases;
                sum.join(factor, weight);
            }
        }
        let weights = weights.into_values();
        points.extend(weights.map(|(sum, cases)| (LoadKind::Weight, seen(&sum.centre()), sum.force, cases)));
        Loads::new(names, projection, points, line_loads)
    }
}

/// Adds a multiple of two vectors to two others.
fn add(sums: &mut [[f64; 3]; 2], factor: f64, values: &[[f64; 3]; 2]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum = std::array::from_fn(|c| sum[c] + factor * value[c]);
    }
}

/// What an element belongs to, for its weight: (0, a node of the membranes or solids that are connected), or (1, a
/// bar).
fn owners(structure: &Structure) -> Vec<(usize, usize)> {
    let mut bodies = Groups::new(structure.nodes.len());
    for element in structure.elements.iter().filter(|element| element.shape().dimension() > 1) {
        bodies.join_all(element.nodes.iter().copied());
    }
    let mut owner: Vec<(usize, usize)> =
        structure.elements.iter().map(|element| (0, bodies.of(element.nodes[0]))).collect();
    for (number, bar) in structure.bars.iter().enumerate() {
        owner[bar.elements.clone()].fill((1, number));
    }
    owner
}

fn length(structure: &Structure, element: usize) -> f64 {
    let [a, b] = [0, 1].map(|end| structure.nodes[structure.elements[element].nodes[end]].position);
    distance(a, b)
}

/// Volume of an element.
fn volume(structure: &Structure, index: usize) -> f64 {
    let element = &structure.elements[index];
    let extent = match element.shape().dimension() {
        3 => {
            let nodes: Vec<[f64; 3]> = element.nodes.iter().map(|&node| structure.nodes[node].position).collect();
            element.shape().volume(&nodes)
        }
        2 => {
            let nodes: Vec<[f64; 2]> = element.nodes.iter().map(|&node| structure.nodes[node].in_plane()).collect();
            element.shape().area(&nodes)
        }
        _ => length(structure, index),
    };
    extent * element.area()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::plot::depth::Seen;
    use crate::view::tests::sample::cantilever;

    /// A cantilever of two elements of 2 under a line load of −10, pulled at its tip by 3 in a case of its own; the tip
    /// moves by (0.1, 0.2), drawn ten times as far, and the cases act twice and minus once.
    #[test]
    fn loads_of_cases_are_multiplied_and_go_along_with_their_nodes() {
        let (mut structure, ..) = cantilever();
        structure.load_cases[0].loads.push(Load::Element { element: 1, load: ElementLoad::Body([0.0, -1.0, 0.0]) });
        let pull = Load::Nodal { node: 2, force: [3.0, 0.0, 0.0], moment: [0.0; 3] };
        structure.load_cases.push(LoadCase {
            name: "pull".into(),
            loads: vec![pull],
            ..structure.load_cases[0].clone()
        });
        let u = [[0.0; 6], [0.0; 6], [0.1, 0.2, 0.0, 0.0, 0.0, 0.0]];
        let loads = CaseLoads::of(&structure, &u).seen(&[2.0, -1.0], 10.0, &Projection::PLANE);
        let near = |a: Seen, b: Seen| (0..3).all(|c| (a[c] - b[c]).abs() < 1e-12);
        let [pull, weight] = &loads.points[..] else { panic!("{:?}", loads.points) };
        assert!(
            pull.0 == LoadKind::Force && near(pull.1, [5.0, 2.0, 0.0]) && pull.2 == [-3.0, 0.0, 0.0] && pull.3 == 0b10
        );
        // in the middle of its element, whose one end moves; its volume is 2 A
        let area = structure.elements[1].area();
        assert!(
            weight.0 == LoadKind::Weight && near(weight.1, [3.5, 1.0, 0.0]) && near(weight.2, [0.0, -4.0 * area, 0.0])
        );
        let [first, second] = &loads.lines[..] else { panic!("{:?}", loads.lines) };
        assert!(near(first.0[0], [0.0; 3]) && near(first.0[1], [2.0, 0.0, 0.0]) && first.1 == [[0.0, -20.0, 0.0]; 2]);
        assert!(near(second.0[1], [5.0, 2.0, 0.0]) && second.2 == 0b1);
        // a case that does not act is not there
        let loads = CaseLoads::of(&structure, &[]).seen(&[0.0, 1.0], 10.0, &Projection::PLANE);
        assert!(loads.lines.is_empty() && loads.points.len() == 1 && near(loads.points[0].1, [4.0, 0.0, 0.0]));
    }
}
