//! Hand-made answers for the tests of the reports: the beam on six frictional supports in its closed form.

use indexmap::IndexMap;

use crate::answer::record::*;
use crate::fem::Piece;
use crate::model::mesh::MeshFiles;
use crate::model::pair::{Law, LawKind, Pair};
use crate::model::parameter::{Number, Parameter};
use crate::model::rules::Rules;
use crate::model::scenario::{Places, Scenario, Source};
use crate::model::space_section::{EndJoint, SpaceSection};
use crate::model::structure::*;
use crate::model::units::Units;

/// Metres and kilonewtons.
pub fn units() -> Units {
    Units { length: Some("m".into()), force: Some("kN".into()) }
}

/// Supports of the beam.
const SUPPORTS: usize = 6;
/// Weight on each.
const WEIGHT: f64 = 100.0;
/// L/EA in m/kN.
const FLEXIBILITY: f64 = 1e-5;

/// The beam under the pull F2 < 6 f F: n = ⌊F2/r⌋, ρ = F2 − n r,
/// z_j = (L/EA)·[(n−j+1) ρ + r (n−j)(n−j+1)/2] for j ≤ n counted from the pulled end c6.
pub fn beam(friction: f64, pull: f64) -> Answer {
    let r = friction * WEIGHT;
    let n = (pull / r).floor();
    let rho = pull - n * r;
    let mut pairs = Vec::new();
    for i in 0..SUPPORTS {
        let j = (SUPPORTS - i) as f64;
        let slips = j <= n;
        let z_t = if slips { FLEXIBILITY * ((n - j + 1.0) * rho + r * (n - j) * (n - j + 1.0) / 2.0) } else { 0.0 };
        let x_t = match j - n {
            k if k <= 0.0 => -r,
            1.0 => -rho,
            _ => 0.0,
        };
        pairs.push(PairState {
            id: format!("c{}", i + 1),
            law: LawKind::Coulomb,
            state: if slips { State::SlipPlus } else { State::Stick },
            held: None,
            x_n: WEIGHT,
            x_t,
            z_n: 0.0,
            z_t,
            bound: r,
            reserve_plus: r + x_t,
            reserve_minus: r - x_t,
            position: Some([i as f64, 0.0, 0.0]),
            joint: 0,
            space: None,
        });
    }
    let pivots = pivots(friction, pull, n as usize);
    Answer {
        outcome: OutcomeKind::Normal,
        marginal: false,
        ray: None,
        p: 0.0,
        rules: Rules::default().into(),
        polygon: None,
        attempts: vec![Attempt {
            facets: None,
            turn: None,
            rules: Rules::default().into(),
            outcome: OutcomeKind::Normal,
            pivots: Some(pivots.len()),
            why: None,
        }],
        pivot_count: pivots.len(),
        pivots,
        check: Check {
            min_w: 0.0,
            min_z: 0.0,
            complementarity: 3.1e-17,
            equilibrium: Some(2.2e-16),
            hidden: 0.0,
            joints_only: false,
            passed: true,
        },
        displacements: Some(
            pairs
                .iter()
                .zip(["A", "B", "C", "D", "E", "F"])
                .map(|(pair, node)| NodeDisplacement {
                    node: node.into(),
                    ux: pair.z_t,
                    uy: -1e-21,
                    rz: -0.0,
                    ..NodeDisplacement::default()
                })
                .collect(),
        ),
        members: Some(
            (0..SUPPORTS - 1)
                .map(|element| {
                    let n: f64 = pull + pairs[element + 1..].iter().map(|p| p.x_t).sum::<f64>();
                    let end = EndForces { n, ..EndForces::default() };
                    let along = element as f64;
                    let pieces = vec![Piece {
                        range: [along, along + 1.0],
                        start: [n, 0.0, 0.0, 0.0, 0.0, 0.0],
                        q: [[0.0; 3]; 2],
                    }];
                    MemberForces { bar: "AF".into(), element, start: end, end, pieces }
                })
                .collect(),
        ),
        reactions: Some(Vec::new()),
        solution: None,
        size: Size { unknowns: Some(18), free: Some(18), pairs: SUPPORTS, lcp: 3 * SUPPORTS },
        pairs,
        timings: Timings::default(),
        start: crate::answer::record::Start::Cold,
        redone: Default::default(),
        notes: Vec::new(),
        failure: None,
    }
}

/// The pivots of that run, in which `slipping` pairs slip.
fn pivots(friction: f64, pull: f64, slipping: usize) -> Vec<PivotRecord> {
    let r = friction * WEIGHT;
    let p = |k: usize| (pull - k as f64 * r) / (1.0 + friction) / k.max(1) as f64;
    let mut pivots = vec![PivotRecord {
        step: 0,
        entering: "p".into(),
        leaving: "x+[c6]".into(),
        p: (pull - r) / (1.0 + friction),
        ties: vec!["x+[c6]".into()],
        turned: None,
        sentence: "p enters: at p = 53.846 no reserve is negative; pair c6 has used up its reserve x⁺".into(),
    }];
    for k in 1..=slipping {
        let (now, next) = (SUPPORTS + 1 - k, SUPPORTS - k);
        let last = k == slipping;
        pivots.push(PivotRecord {
            step: k,
            entering: format!("z+[c{now}]"),
            leaving: if last { "p".into() } else { format!("x+[c{next}]") },
            p: if last { 0.0 } else { p(k + 1) },
            ties: if last { vec!["p".into(), format!("x+[c{next}]")] } else { vec![format!("x+[c{next}]")] },
            turned: Some(Turned {
                pair: format!("c{now}"),
                joint: TurnedJoint::Tangential,
                from: "stick".into(),
                to: "slip+".into(),
            }),
            sentence: if last {
                format!("pair c{now} slips +; p falls to 0: this is the answer")
            } else {
                format!("pair c{now} slips +; p falls, until pair c{next} uses up its reserve x⁺ (friction bound)")
            },
        });
    }
    pivots
}

/// The beam beyond its limit: F2 = 6 f F + 6 · 3.33 · (1 + f).
pub fn beam_ray() -> Answer {
    let mut answer = beam(0.5, 290.0);
    answer.outcome = OutcomeKind::Ray;
    answer.p = 10.0 / 3.0;
    answer.ray = Some(Ray {
        class: RayClass::Mechanism,
        verdict: Some(Verdict::Certified),
        p: 10.0 / 3.0,
        driver: "z+[c1]".into(),
        direction: Direction::Pairs(
            (1..=SUPPORTS).map(|i| PairDirection { pair: format!("c{i}"), z_n: 0.0, z_t: Slip::Plane(1.0) }).collect(),
        ),
        mode: "the whole structure slides towards +t on all six pairs".into(),
        explanation: "the loads pull with 20 kN more than friction can hold; more weight, more friction \
                      or a smaller F2 would stop it"
            .into(),
        misfit: false,
        of_this_load: false,
    });
    answer.displacements = None;
    answer.members = None;
    answer.reactions = None;
    answer
}

/// The structure of the beam, one bar in five elements, bent enough to see it; clamped at A when asked.
pub fn beam_structure() -> Structure {
    let names = ["A", "B", "C", "D", "E", "F"];
    Structure {
        nodes: (0..SUPPORTS).map(|i| Node { id: names[i].into(), position: [i as f64, 0.0, 0.0] }).collect(),
        materials: vec![steel()],
        elements: (0..SUPPORTS - 1)
            .map(|i| Element {
                nodes: vec![i, i + 1],
                material: 0,
                kind: ElementKind::Frame { area: 0.01, inertia: 1e-4, shear_area: None, hinges: [false; 2] },
            })
            .collect(),
        bars: vec![Bar { id: "AF".into(), elements: 0..SUPPORTS - 1 }],
        edge_contacts: Vec::new(),
        pairs: (0..SUPPORTS).map(|i| ground_pair(&format!("c{}", i + 1), i)).collect(),
        load_cases: vec![
            LoadCase {
                name: "weight".into(),
                factor: Number::Value(1.0),
                loads: (0..SUPPORTS).map(|i| point(i, [0.0, -WEIGHT])).collect(),
            },
            LoadCase {
                name: "pull".into(),
                factor: Number::Parameter("F2".into()),
                loads: vec![point(SUPPORTS - 1, [1.0, 0.0])],
            },
        ],
        ..Structure::default()
    }
}

/// Two plates, the lower one held along its base, contact between them.
pub fn plates() -> Structure {
    let (nx, ny) = (8, 4);
    let mut structure = Structure { materials: vec![steel()], ..Structure::default() };
    for (name, y0) in [("lower", 0.0), ("upper", 4.0)] {
        let first = structure.nodes.len();
        let from = structure.elements.len();
        let index = |i: usize, j: usize| first + j * (nx + 1) + i;
        for j in 0..=ny {
            for i in 0..=nx {
                structure.nodes.push(Node { id: format!("{name}[{i},{j}]"), position: [i as f64, y0 + j as f64, 0.0] });
            }
        }
        for j in 0..ny {
            for i in 0..nx {
                structure.elements.push(Element {
                    nodes: vec![index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)],
                    material: 0,
                    kind: ElementKind::Membrane { thickness: 0.1, plane: Plane::Strain, incompatible: false },
                });
            }
        }
        structure.plates.push(Plate {
            id: name.into(),
            elements: from..structure.elements.len(),
            nodes: (0..=ny).map(|j| (0..=nx).map(|i| index(i, j)).collect()).collect(),
        });
    }
    let (lower, upper) = (structure.plates[0].nodes.clone(), structure.plates[1].nodes.clone());
    for i in 0..=nx {
        for component in [Component::X, Component::Y] {
            structure.supports.push(Support { node: lower[0][i], component });
        }
        let weights = Pair::of_nodes(upper[0][i], Some(lower[ny][i]));
        structure.pairs.push(Pair { weights, ..ground_pair(&format!("joint[{i}]"), upper[0][i]) });
    }
    structure
}

/// A block of bricks on frictional ground, with a corner at the origin: nodes `b[i,j,k]`, pairs below in the order of x.
pub fn block([nx, ny, nz]: [usize; 3], size: [f64; 3]) -> Structure {
    let counts = [nx, ny, nz];
    let index = |i: usize, j: usize, k: usize| (k * (ny + 1) + j) * (nx + 1) + i;
    let mut structure = Structure { dimension: Dimension::Space, materials: vec![steel()], ..Structure::default() };
    for k in 0..=nz {
        for j in 0..=ny {
            for i in 0..=nx {
                let at = [i, j, k];
                let position = std::array::from_fn(|c| size[c] * at[c] as f64 / counts[c] as f64);
                structure.nodes.push(Node { id: format!("b[{i},{j},{k}]"), position });
            }
        }
    }
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let ring = |k: usize| [index(i, j, k), index(i + 1, j, k), index(i + 1, j + 1, k), index(i, j + 1, k)];
                let nodes = [ring(k), ring(k + 1)].concat();
                structure.elements.push(Element {
                    nodes,
                    material: 0,
                    kind: ElementKind::Solid { incompatible: false },
                });
            }
        }
    }
    for node in 0..(nx + 1) * (ny + 1) {
        let normal = [0.0, 0.0, 1.0];
        let tangents = Dimension::Space.tangents(normal);
        structure.pairs.push(Pair { normal, tangents, ..ground_pair(&format!("g[{node}]"), node) });
    }
    structure
}

/// Four columns of two storeys, braced by beams, on frictional ground, pushed at the top.
pub fn tower() -> Structure {
    let mut structure = Structure { dimension: Dimension::Space, materials: vec![steel()], ..Structure::default() };
    for k in 0..3 {
        for (i, j) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            let position = [4.0 * f64::from(i), 3.0 * f64::from(j), 3.0 * f64::from(k)];
            structure.nodes.push(Node { id: format!("n{i}{j}{k}"), position });
        }
    }
    let mut bar = |nodes: Vec<usize>| {
        let section = SpaceSection {
            area: 0.01,
            inertia_y: 1e-4,
            inertia_z: 1e-4,
            torsion: 1e-4,
            shear_area_y: None,
            shear_area_z: None,
        };
        let joints = [EndJoint::Rigid; 2];
        structure.elements.push(Element {
            nodes,
            material: 0,
            kind: ElementKind::SpaceFrame { section, orientation: None, joints },
        });
        let element = structure.elements.len();
        structure.bars.push(Bar { id: format!("b{element}"), elements: element - 1..element });
    };
    for k in 0..2 {
        (0..4).for_each(|corner| bar(vec![4 * k + corner, 4 * k + 4 + corner]));
        (0..4).for_each(|corner| bar(vec![4 * k + 4 + corner, 4 * k + 4 + (corner + 1) % 4]));
    }
    for node in 0..4 {
        let normal = [0.0, 0.0, 1.0];
        let tangents = Dimension::Space.tangents(normal);
        structure.pairs.push(Pair { normal, tangents, ..ground_pair(&format!("g{node}"), node) });
    }
    let push = |node: usize, force: [f64; 3]| Load::Nodal { node, force, moment: [0.0; 3] };
    structure.load_cases = vec![LoadCase {
        name: "wind".into(),
        factor: Number::Value(1.0),
        loads: vec![push(8, [0.0, 20.0, 0.0]), push(9, [0.0, 20.0, 0.0]), push(10, [0.0, 0.0, -50.0])],
    }];
    structure
}

/// States of the pairs of a [`block`]: at x they slip by x mm towards 30° from t1, at x = 0 they stick.
pub fn block_states(structure: &Structure) -> Vec<PairState> {
    let (s, c) = 30.0_f64.to_radians().sin_cos();
    let state = |pair: &Pair| {
        let slip = 1e-3 * structure.nodes[pair.node].position[0];
        let (x_n, bound) = (100.0, 50.0);
        PairState {
            id: pair.id.clone(),
            law: LawKind::Coulomb,
            state: if slip > 0.0 { State::Slip } else { State::Stick },
            held: None,
            x_n,
            x_t: bound,
            z_n: 0.0,
            z_t: slip,
            bound,
            reserve_plus: 0.0,
            reserve_minus: 0.0,
            position: None,
            joint: 0,
            space: Some(InSpace { x_t: [-bound * c, -bound * s], z_t: [slip * c, slip * s], frame: None }),
        }
    };
    structure.pairs.iter().map(state).collect()
}

fn point(node: usize, [x, y]: [f64; 2]) -> Load {
    Load::Nodal { node, force: [x, y, 0.0], moment: [0.0; 3] }
}

/// A cantilever, clamped at A, 4 m in two elements, under q = 10 kN/m downwards: Q = q (L − x), M = −q (L − x)²/2.
pub fn cantilever() -> (Structure, Vec<MemberForces>, Vec<NodeDisplacement>) {
    let mut structure = beam_structure();
    structure.nodes.truncate(3);
    for (node, x) in structure.nodes.iter_mut().zip([0.0, 2.0, 4.0]) {
        node.position[0] = x;
    }
    structure.elements.truncate(2);
    structure.bars[0].elements = 0..2;
    structure.pairs.clear();
    structure.supports =
        [Component::X, Component::Y, Component::Rz].map(|component| Support { node: 0, component }).to_vec();
    let (q, l, ei) = (10.0, 4.0, 2.1e4);
    structure.load_cases = vec![LoadCase {
        name: "line".into(),
        factor: Number::Value(1.0),
        loads: (0..2)
            .map(|element| Load::Element {
                element,
                load: ElementLoad::Line { range: [0.0, 2.0], value: [[0.0, -q, 0.0]; 2] },
            })
            .collect(),
    }];
    let at = |x: f64| EndForces { q: q * (l - x), m: -q * (l - x) * (l - x) / 2.0, ..EndForces::default() };
    let members = [(0, 0.0, 2.0), (1, 2.0, 4.0)]
        .map(|(element, start, end)| {
            let EndForces { n, q: shear, m, .. } = at(start);
            let pieces =
                vec![Piece { range: [start, end], start: [n, shear, m, 0.0, 0.0, 0.0], q: [[0.0, -q, 0.0]; 2] }];
            MemberForces { bar: "AF".into(), element, start: at(start), end: at(end), pieces }
        })
        .to_vec();
    // v = −q x² (6 L² − 4 L x + x²)/24 EI and its derivative.
    let displacements = structure
        .nodes
        .iter()
        .map(|node| {
            let x = node.position[0];
            NodeDisplacement {
                node: node.id.clone(),
                ux: 0.0,
                uy: -q * x * x * (6.0 * l * l - 4.0 * l * x + x * x) / (24.0 * ei),
                rz: -q * x * (12.0 * l * l - 12.0 * l * x + 4.0 * x * x) / (24.0 * ei),
                ..NodeDisplacement::default()
            }
        })
        .collect();
    (structure, members, displacements)
}

fn steel() -> Material {
    Material { youngs_modulus: 2.1e8, poisson_ratio: 0.3, density: 0.0, expansion: 0.0 }
}

fn ground_pair(id: &str, node: usize) -> Pair {
    let law =
        Law::Coulomb { friction: Number::Parameter("f".into()), cohesion: Number::Value(0.0), gap: Number::Value(0.0) };
    Pair::at_node(id.into(), node, None, [0.0, 1.0, 0.0], Dimension::Plane, law)
}

/// The factors of the load cases of a structure under a pull F2.
pub(super) fn factors_under(structure: &Structure, f2: f64) -> Vec<f64> {
    let values = [("F2".to_owned(), f2)].into();
    structure.load_cases.iter().map(|case| case.factor.value(&values)).collect()
}

/// The scenario of the beam, F2 changed from 100 to 130.
pub fn scenario() -> Scenario {
    let parameter = |value: f64, max: f64, step: f64, unit: Option<&str>, about: &str| Parameter {
        value,
        formula: None,
        min: Some(0.0),
        max: Some(max),
        step: Some(step),
        unit: unit.map(String::from),
        about: Some(about.into()),
    };
    let parameters = IndexMap::from([
        ("f".to_owned(), parameter(0.5, 1.0, 0.05, None, "friction coefficient")),
        ("F2".to_owned(), parameter(100.0, 400.0, 10.0, Some("kN"), "horizontal pull at the right end")),
    ]);
    Scenario {
        name: "beam".into(),
        path: None,
        text: String::new(),
        title: "Multi-span beam on six frictional supports".into(),
        description: None,
        units: units(),
        parameters,
        formulas: std::sync::Arc::default(),
        uses: crate::model::uses::Uses::default(),
        source: Source::Structure(beam_structure()),
        stages: Vec::new(),
        combinations: Vec::new(),
        probes: Vec::new(),
        measured: Vec::new(),
        places: Places::default(),
        meshes: MeshFiles::default(),
        notes: Vec::new(),
        rules: Rules::default(),
    }
}
