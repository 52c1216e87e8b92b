//! Small structures in a few lines.

use nalgebra::DVector;

use crate::fem::{Displacements, JointTerms, MainSystem, MainSystemError};
use crate::model::pair::{Joint, Law, Pair, joints};
use crate::model::parameter::Number;
use crate::model::structure::{
    Bar, Component, Element, ElementKind, Load, LoadCase, Material, Node, Plane, Plate, RigidBody, Spring, Structure,
    Support, Tie,
};
use crate::model::vector::flat;

/// A structure being built; materials are made as they are used.
#[derive(Default)]
pub struct Model(pub Structure);

pub fn coulomb() -> Law {
    Law::Coulomb { friction: Number::Value(0.5), cohesion: Number::Value(0.0), gap: Number::Value(0.0) }
}

pub fn frictionless() -> Law {
    Law::Frictionless { gap: Number::Value(0.0) }
}

/// Letters to components.
pub fn components(letters: &str) -> Vec<Component> {
    letters
        .chars()
        .map(|letter| match letter {
            'x' => Component::X,
            'y' => Component::Y,
            'r' => Component::Rz,
            _ => panic!("{letter}"),
        })
        .collect()
}

impl Model {
    pub fn node(&mut self, id: &str, x: f64, y: f64) -> usize {
        self.0.nodes.push(Node { id: id.into(), position: [x, y, 0.0] });
        self.0.nodes.len() - 1
    }

    pub fn material(&mut self, e: f64, nu: f64) -> usize {
        self.0.materials.push(Material { youngs_modulus: e, poisson_ratio: nu, density: 0.0, expansion: 0.0 });
        self.0.materials.len() - 1
    }

    fn bar(&mut self, nodes: [usize; 2], material: usize, kind: ElementKind) -> usize {
        let index = self.0.elements.len();
        self.0.elements.push(Element { nodes: nodes.to_vec(), material, kind });
        self.0.bars.push(Bar { id: format!("b{}", self.0.bars.len()), elements: index..index + 1 });
        index
    }

    /// A frame bar with E = 1: EA = `area`, EI = `inertia`.
    pub fn frame(&mut self, a: usize, b: usize, area: f64, inertia: f64) -> usize {
        self.hinged(a, b, area, inertia, [false; 2])
    }

    pub fn hinged(&mut self, a: usize, b: usize, area: f64, inertia: f64, h: [bool; 2]) -> usize {
        let material = self.material(1.0, 0.0);
        let kind = ElementKind::Frame { area, inertia, shear_area: None, hinges: h };
        self.bar([a, b], material, kind)
    }

    pub fn truss(&mut self, a: usize, b: usize, area: f64) -> usize {
        let material = self.material(1.0, 0.0);
        self.bar([a, b], material, ElementKind::Truss { area })
    }

    pub fn quad(&mut self, nodes: [usize; 4], material: usize, thickness: f64, plane: Plane) {
        self.0.elements.push(Element {
            nodes: nodes.to_vec(),
            material,
            kind: ElementKind::Membrane { thickness, plane, incompatible: false },
        });
    }

    /// A plate with its lower left corner at `origin`; returns its node grid `[j][i]`.
    pub fn plate(
        &mut self,
        id: &str,
        origin: [f64; 2],
        size: [f64; 2],
        divisions: [usize; 2],
        (material, thickness): (usize, f64),
    ) -> Vec<Vec<usize>> {
        let mut grid = Vec::new();
        for j in 0..=divisions[1] {
            let y = origin[1] + size[1] * j as f64 / divisions[1] as f64;
            let row: Vec<usize> = (0..=divisions[0])
                .map(|i| {
                    let x = origin[0] + size[0] * i as f64 / divisions[0] as f64;
                    self.node(&format!("{id}[{i},{j}]"), x, y)
                })
                .collect();
            grid.push(row);
        }
        let first = self.0.elements.len();
        for j in 0..divisions[1] {
            for i in 0..divisions[0] {
                let nodes = [grid[j][i], grid[j][i + 1], grid[j + 1][i + 1], grid[j + 1][i]];
                self.quad(nodes, material, thickness, Plane::Strain);
            }
        }
        self.0.plates.push(Plate { id: id.into(), elements: first..self.0.elements.len(), nodes: grid.clone() });
        grid
    }

    pub fn support(&mut self, node: usize, letters: &str) {
        for component in components(letters) {
            self.0.supports.push(Support { node, component });
        }
    }

    pub fn tie(&mut self, nodes: &[usize], letters: &str) {
        self.0.ties.push(Tie { nodes: nodes.to_vec(), components: components(letters) });
    }

    pub fn rigid(&mut self, nodes: &[usize]) {
        let id = format!("body{}", self.0.rigid.len() + 1);
        self.0.rigid.push(RigidBody { id, nodes: nodes.to_vec() });
    }

    pub fn spring(&mut self, node: usize, direction: [f64; 2], stiffness: f64) {
        self.0.springs.push(Spring::along(node, None, flat(direction), stiffness));
    }

    pub fn pair(&mut self, node: usize, against: Option<usize>, normal: [f64; 2], law: Law) {
        let id = format!("c{}", self.0.pairs.len() + 1);
        let length = normal[0].hypot(normal[1]);
        let normal = flat(normal.map(|n| n / length));
        self.0.pairs.push(Pair::at_node(id, node, against, normal, self.0.dimension, law));
    }

    pub fn case(&mut self, loads: Vec<Load>) {
        self.0.load_cases.push(LoadCase {
            name: format!("case{}", self.0.load_cases.len() + 1),
            factor: Number::Value(1.0),
            loads,
        });
    }

    pub fn joints(&self) -> Vec<Joint> {
        joints(&self.0.pairs)
    }

    pub fn solve(&self) -> MainSystem {
        self.try_solve().unwrap()
    }

    pub fn try_solve(&self) -> Result<MainSystem, MainSystemError> {
        MainSystem::new(&self.0, &self.joints(), &crate::watch::Quiet)
    }
}

pub fn point(node: usize, force: [f64; 2]) -> Load {
    turning(node, force, 0.0)
}

pub fn turning(node: usize, force: [f64; 2], moment: f64) -> Load {
    Load::Nodal { node, force: flat(force), moment: [0.0, 0.0, moment] }
}

/// Two plates `length` × `height` × 0.1, one upon the other with `divisions` elements each, the lower one fixed
/// along its base; pairs along the joint from `first` on, those before it tied. Cases: weight −100 per length on
/// top, unit traction to the right on the upper plate's left edge.
pub fn two_plates(size: [f64; 2], divisions: [usize; 2], first: usize) -> Model {
    let mut model = Model::default();
    let steel = model.material(2.1e8, 0.3);
    let lower = model.plate("lower", [0.0, 0.0], size, divisions, (steel, 0.1));
    let upper = model.plate("upper", [0.0, size[1]], size, divisions, (steel, 0.1));
    for &node in &lower[0] {
        model.support(node, "xy");
    }
    for i in 0..=divisions[0] {
        let (node, against) = (upper[0][i], lower[divisions[1]][i]);
        if i < first {
            model.tie(&[against, node], "xy");
        } else {
            model.pair(node, Some(against), [0.0, 1.0], coulomb());
        }
    }
    let edge = |nodes: Vec<usize>, length: f64, traction: [f64; 2]| -> Vec<Load> {
        let step = length / (nodes.len() - 1) as f64;
        let last = nodes.len() - 1;
        nodes
            .into_iter()
            .enumerate()
            .map(|(i, node)| {
                let share = if i == 0 || i == last { 0.5 * step } else { step };
                point(node, traction.map(|t| t * share))
            })
            .collect()
    };
    let top = upper[divisions[1]].clone();
    model.case(edge(top, size[0], [0.0, -100.0]));
    let left = upper.iter().map(|row| row[0]).collect();
    model.case(edge(left, size[1], [1.0, 0.0]));
    model
}

#[track_caller]
pub fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-10 * expected.abs().max(1e-2), "{found} instead of {expected}");
}

/// The answer with every joint on: z = 0, λ = RF.
pub fn main_answer(model: &Model) -> (MainSystem, Displacements, DVector<f64>, Vec<f64>) {
    let system = model.solve();
    let factors = vec![1.0; model.0.load_cases.len()];
    let mut lambda = DVector::zeros(system.stiffness().nrows());
    system.loads().iter().for_each(|rf| lambda += rf);
    let u = system.displacements(&factors, &DVector::zeros(lambda.len()));
    let residual = system.equilibrium_residual(&model.0, &u, &JointTerms::default(), &lambda, &factors);
    assert!(residual < 1e-12, "equilibrium {residual:e}");
    (system, u, lambda, factors)
}
