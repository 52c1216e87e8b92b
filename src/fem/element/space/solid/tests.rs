use std::collections::HashMap;

use nalgebra::{DMatrix, Matrix3, Vector3};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::model::face::Face;
use crate::model::faces::Faces;
use crate::model::node::Node;
use crate::model::shape::Shape;

const EPS: f64 = f64::EPSILON;

/// The shapes, the brick with incompatible modes among them.
const KINDS: [(usize, bool); 5] = [(4, false), (10, false), (8, false), (8, true), (20, false)];

fn material() -> Material {
    Material { youngs_modulus: 3.0, poisson_ratio: 0.3, density: 0.0, expansion: 0.0 }
}

/// Solids on a block of n × n × n hexahedra, or of six tetrahedra in each; nodes, and those of each element.
struct Mesh {
    nodes: Vec<[f64; 3]>,
    elements: Vec<Vec<usize>>,
    incompatible: bool,
}

impl Mesh {
    /// A mesh of the given sizes; every node moved at random by up to `shift` of a division, middle nodes again by a
    /// third of it so that sides bulge.
    fn new(
        (count, incompatible): (usize, bool),
        n: usize,
        size: [f64; 3],
        shift: f64,
        random: &mut ChaCha8Rng,
    ) -> Mesh {
        let mut moved = |at: [f64; 3], by: f64| -> [f64; 3] {
            std::array::from_fn(|c| at[c] + size[c] / n as f64 * by * random.random_range(-1.0..=1.0))
        };
        let index = |i: usize, j: usize, k: usize| i + (n + 1) * (j + (n + 1) * k);
        let mut nodes = Vec::new();
        let side = 0..=n;
        for k in side.clone() {
            for j in side.clone() {
                for i in side.clone() {
                    let at = [i, j, k].map(|i| i as f64 / n as f64);
                    nodes.push(moved([0, 1, 2].map(|c| at[c] * size[c]), shift));
                }
            }
        }
        let mut elements = Vec::new();
        for (i, j, k) in (0..n).flat_map(|k| (0..n).flat_map(move |j| (0..n).map(move |i| (i, j, k)))) {
            let corner = |a: usize, b: usize, c: usize| index(i + a, j + b, k + c);
            let below = [corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0)];
            let above = [corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)];
            let hexahedron = [below, above].concat();
            if count == 8 || count == 20 {
                elements.push(hexahedron);
            } else {
                let round = [1, 2, 3, 7, 4, 5, 1];
                elements.extend(round.windows(2).map(|pair| [0, pair[0], pair[1], 6].map(|c| hexahedron[c]).to_vec()));
            }
        }
        let sides: &[[usize; 2]] = match count {
            10 => &TETRAHEDRON_SIDES,
            20 => Shape::Hexahedron20.sides_of_solid(),
            _ => &[],
        };
        let mut middles = HashMap::new();
        for element in &mut elements {
            for [a, b] in sides {
                let ends = [element[*a], element[*b]];
                let middle = *middles.entry((ends[0].min(ends[1]), ends[0].max(ends[1]))).or_insert_with(|| {
                    let [p, q] = ends.map(|end| nodes[end]);
                    let at = [0, 1, 2].map(|c| 0.5 * (p[c] + q[c]));
                    nodes.push(if shift == 0.0 { at } else { moved(at, shift / 3.0) });
                    nodes.len() - 1
                });
                element.push(middle);
            }
        }
        Mesh { nodes, elements, incompatible }
    }

    fn solid<'a>(&self, element: usize, material: &'a Material) -> Solid<'a> {
        let nodes = self.elements[element].iter().map(|&node| self.nodes[node]).collect();
        Solid { nodes, material, incompatible: self.incompatible }
    }

    /// Σ k u and Σ |k| |u| of all elements at every node.
    fn forces(&self, field: &dyn Fn([f64; 3]) -> [f64; 3]) -> Vec<([f64; 3], [f64; 3])> {
        let material = material();
        let mut all = vec![([0.0; 3], [0.0; 3]); self.nodes.len()];
        for (index, nodes) in self.elements.iter().enumerate() {
            let solid = self.solid(index, &material);
            let u: Vec<f64> = solid.nodes.iter().flat_map(|&at| field(at)).collect();
            let k = solid.stiffness().unwrap();
            for (i, &node) in nodes.iter().enumerate() {
                for c in 0..3 {
                    for (j, u) in u.iter().enumerate() {
                        let term = k[(3 * i + c, j)] * u;
                        all[node].0[c] += term;
                        all[node].1[c] += term.abs();
                    }
                }
            }
        }
        all
    }

    fn shape(&self) -> Shape {
        match self.elements[0].len() {
            4 => Shape::Tetrahedron4,
            8 => Shape::Hexahedron8,
            10 => Shape::Tetrahedron10,
            _ => Shape::Hexahedron20,
        }
    }

    /// The faces that one element alone has.
    fn boundary(&self) -> Face {
        let mut faces = Faces::default();
        for (element, nodes) in self.elements.iter().enumerate() {
            faces.add(element, self.shape(), nodes);
        }
        Face::of(faces.surface().into_iter().cloned().collect())
    }

    fn inner(&self) -> Vec<bool> {
        let mut inner = vec![true; self.nodes.len()];
        self.boundary().nodes.iter().for_each(|&node| inner[node] = false);
        inner
    }
}

const SLOPES: Matrix3<f64> = Matrix3::new(0.02, -0.05, 0.01, 0.07, 0.03, -0.04, -0.02, 0.06, -0.01);

fn linear(at: [f64; 3]) -> [f64; 3] {
    (Vector3::new(0.1, -0.3, 0.2) + SLOPES * Vector3::from(at)).into()
}

/// Stress of a matrix of slopes ∂u_a/∂x_b, by Hooke's law with E and ν.
fn hooke(slopes: Matrix3<f64>) -> Matrix3<f64> {
    let (e, nu) = (3.0, 0.3);
    let strain = (slopes + slopes.transpose()) * 0.5;
    (strain + Matrix3::identity() * (nu / (1.0 - 2.0 * nu) * strain.trace())) * (e / (1.0 + nu))
}

fn components(s: Matrix3<f64>) -> Stress {
    [s[(0, 0)], s[(1, 1)], s[(0, 1)], s[(2, 2)], s[(1, 2)], s[(2, 0)]]
}

/// Volume of elements with straight sides: over faces with their corners outwards, half of both triangulations (a
/// bilinear face halves the tetrahedron between them).
fn volume(nodes: &[[f64; 3]], count: usize) -> f64 {
    let p = |i: usize| Vector3::from(nodes[i]) - Vector3::from(nodes[0]);
    let tetrahedron = |[a, b, c]: [usize; 3]| p(a).dot(&p(b).cross(&p(c))) / 6.0;
    if count == 4 || count == 10 {
        return tetrahedron([1, 2, 3]);
    }
    let faces = [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
    let of_face = |[a, b, c, d]: [usize; 4]| {
        0.5 * [[a, b, c], [a, c, d], [a, b, d], [b, c, d]].map(tetrahedron).iter().sum::<f64>()
    };
    faces.into_iter().map(of_face).sum()
}

/// A linear field on distorted elements, sides and faces bulging: its constant stress everywhere, the consistent forces
/// of its tractions on the surface, and nothing left over at any inner node.
#[test]
fn patch_test() {
    let random = &mut ChaCha8Rng::seed_from_u64(1);
    let right = components(hooke(SLOPES));
    for kind in KINDS {
        let mesh = Mesh::new(kind, 2, [1.0, 1.2, 0.9], 0.12, random);
        let material = material();
        for (index, nodes) in mesh.elements.iter().enumerate() {
            let solid = mesh.solid(index, &material);
            let u: Vec<f64> = nodes.iter().flat_map(|&node| linear(mesh.nodes[node])).collect();
            let centre = solid.stress(&u, &[]).unwrap();
            for found in solid.node_stresses(&u, &[]).unwrap().into_iter().chain([centre]) {
                assert!((0..6).all(|c| (found[c] - right[c]).abs() < 1e-13), "{kind:?}: {found:?} {right:?}");
            }
        }
        // On the surface the forces of σ n, nothing inside.
        let boundary = mesh.boundary();
        assert!(boundary.nodes.len() < mesh.nodes.len(), "{kind:?}");
        let nodes: Vec<Node> = mesh.nodes.iter().map(|&position| Node { id: "n".into(), position }).collect();
        let stress = hooke(SLOPES);
        let tractions = boundary.consistent_forces(&nodes, None, &|spot| (stress * Vector3::from(spot.outward)).into());
        let tractions: HashMap<usize, [f64; 3]> = tractions.into_iter().collect();
        for (node, (force, terms)) in mesh.forces(&linear).into_iter().enumerate() {
            let right = tractions.get(&node).copied().unwrap_or_default();
            // Each entry of k is a sum over up to 27 points of products that some 30 roundings made.
            assert!(
                (0..3).all(|c| (force[c] - right[c]).abs() < 256.0 * EPS * terms[c]),
                "{kind:?}: {force:?} {right:?}"
            );
        }
    }
}

/// ½ uᵀ k u of a linear field is ½ V ε : σ.
#[test]
fn energy_of_a_linear_field() {
    let random = &mut ChaCha8Rng::seed_from_u64(2);
    for kind in [(4, false), (8, false), (8, true)] {
        let mesh = Mesh::new(kind, 1, [1.0, 1.2, 0.9], 0.2, random);
        let material = material();
        for index in 0..mesh.elements.len() {
            let solid = mesh.solid(index, &material);
            let u: Vec<f64> = solid.nodes.iter().flat_map(|&at| linear(at)).collect();
            let k = solid.stiffness().unwrap();
            let energy: f64 = (0..u.len()).map(|i| (0..u.len()).map(|j| u[i] * k[(i, j)] * u[j]).sum::<f64>()).sum();
            let right = volume(&solid.nodes, kind.0) * SLOPES.component_mul(&hooke(SLOPES)).sum();
            assert!((energy - right).abs() < 1e-14, "{kind:?}");
        }
    }
}

/// Without loads the energy of the stresses is ½ uᵀ k u, whatever the shape and the displacements.
#[test]
fn stresses_store_what_the_stiffness_does() {
    let random = &mut ChaCha8Rng::seed_from_u64(8);
    for kind in [(4, false), (8, false), (8, true), (10, false), (20, false)] {
        let mesh = Mesh::new(kind, 1, [1.0, 1.2, 0.9], 0.1, random);
        let material = material();
        let solid = mesh.solid(0, &material);
        let u = nalgebra::DVector::from_fn(3 * solid.nodes.len(), |i, _| (1.7 * i as f64 + 0.3).sin());
        let right = 0.5 * u.dot(&(solid.stiffness().unwrap() * &u));
        assert!((solid.strain_energy(u.as_slice(), &[]) - right).abs() < 1e-13 * right, "{kind:?}");
    }
}

/// Six rigid motions cost nothing, and nothing else does.
#[test]
fn six_rigid_motions() {
    let random = &mut ChaCha8Rng::seed_from_u64(3);
    for kind in KINDS {
        let mesh = Mesh::new(kind, 1, [1.0, 1.2, 0.9], 0.2, random);
        let material = material();
        let solid = mesh.solid(0, &material);
        let k = solid.stiffness().unwrap();
        for c in 0..6 {
            let motion = |at: [f64; 3]| -> [f64; 3] {
                let axis = Vector3::from_fn(|i, _| f64::from(i == c % 3));
                (if c < 3 { axis } else { axis.cross(&Vector3::from(at)) }).into()
            };
            let u = nalgebra::DVector::from_iterator(k.nrows(), solid.nodes.iter().flat_map(|&at| motion(at)));
            let (force, terms) = (&k * &u, k.map(f64::abs) * u.map(f64::abs));
            assert!((0..u.len()).all(|i| force[i].abs() < 256.0 * EPS * terms[i]), "{kind:?} {c}");
        }
        let mut values: Vec<f64> = DMatrix::clone(&k).symmetric_eigenvalues().iter().copied().collect();
        values.sort_by(f64::total_cmp);
        assert!(values[..6].iter().all(|value| value.abs() < 1e-13), "{kind:?}: {values:?}");
        assert!(values[6] > 1e-4, "{kind:?}: {values:?}");
        let exact = solid.doubled_stiffness().unwrap().map(|value| value.to_f64());
        assert!((exact - &k).amax() < 256.0 * EPS * k.amax(), "{kind:?}");
    }
}

/// Free expansion is met by u = α ΔT x: no stress, and k u = f.
#[test]
fn free_expansion_makes_no_stress() {
    let random = &mut ChaCha8Rng::seed_from_u64(4);
    let heat = ElementLoad::FreeStrain { strain: 0.01, curvature: [0.0; 2] };
    for kind in KINDS {
        let mesh = Mesh::new(kind, 1, [1.0, 1.2, 0.9], 0.2, random);
        let material = material();
        let solid = mesh.solid(0, &material);
        let u: Vec<f64> = solid.nodes.iter().flatten().map(|x| 0.02 * x).collect();
        let acting = [(2.0, &heat)];
        for stress in solid.node_stresses(&u, &acting).unwrap() {
            assert!(stress.iter().all(|value| value.abs() < 1e-14), "{kind:?}: {stress:?}");
        }
        let (k, f) = (solid.stiffness().unwrap(), solid.nodal_forces(&acting));
        for i in 0..u.len() {
            let force: f64 = (0..u.len()).map(|j| k[(i, j)] * u[j]).sum();
            assert!((force - f[i]).abs() < 1e-14, "{kind:?}");
        }
        // Held: −Eα ΔT/(1 − 2ν) in all directions.
        let held = solid.stress(&vec![0.0; u.len()], &acting).unwrap();
        let right = -3.0 * 0.02 / 0.4;
        for (value, right) in held.into_iter().zip([right, right, 0.0, right, 0.0, 0.0]) {
            assert!((value - right).abs() < 1e-14, "{held:?}");
        }
    }
}

/// Resultant of a body force is b V, and its moment about the origin that of the centroid of a tetrahedron; with
/// straight sides.
#[test]
fn body_forces_keep_resultant_and_moment() {
    let random = &mut ChaCha8Rng::seed_from_u64(5);
    for kind in KINDS {
        let shift = if kind.0 > 8 { 0.0 } else { 0.2 };
        let mesh = Mesh::new(kind, 1, [1.0, 1.2, 0.9], shift, random);
        let material = material();
        for index in 0..mesh.elements.len() {
            let solid = mesh.solid(index, &material);
            let b = [0.3, -2.0, 0.7];
            let f = solid.body_force(b);
            let volume = volume(&solid.nodes, kind.0);
            let sum = |c: usize| f.iter().skip(c).step_by(3).sum::<f64>();
            assert!((0..3).all(|c| (sum(c) - b[c] * volume).abs() < 1e-14), "{kind:?}");
            if kind.0 == 4 || kind.0 == 10 {
                let centroid = solid.nodes[..4].iter().map(|&at| Vector3::from(at)).sum::<Vector3<f64>>() / 4.0;
                let forces = f.chunks(3).map(|f| Vector3::new(f[0], f[1], f[2]));
                let moment: Vector3<f64> =
                    solid.nodes.iter().zip(forces).map(|(&at, force)| Vector3::from(at).cross(&force)).sum();
                assert!((moment - centroid.cross(&(Vector3::from(b) * volume))).amax() < 1e-14, "{kind:?}");
            }
        }
    }
}

const CURVATURE: f64 = 0.01;

/// Pure bending about z with curvature κ: σ_xx = −E κ y and nothing else, any prism.
fn bending([x, y, z]: [f64; 3]) -> [f64; 3] {
    let nu = 0.3;
    [-CURVATURE * x * y, 0.5 * CURVATURE * (x * x + nu * (y * y - z * z)), nu * CURVATURE * y * z]
}

/// A rectangular beam of one layer in bricks ten times as long as high, bent by a moment: with incompatible modes exact
/// (energy E I κ² L, σ_xx = −E κ y, nothing left over between the bricks), the plain brick far too stiff.
#[test]
fn a_brick_bends_as_a_beam() {
    let (length, height, width) = (10.0, 1.0, 0.7);
    let material = material();
    let energy = |incompatible: bool| {
        let nodes: Vec<[f64; 3]> = SolidShape::Hexahedron8
            .nodes()
            .iter()
            .map(|[x, y, z]| [0.5 * length * (x + 1.0), 0.5 * height * y, 0.5 * width * z])
            .collect();
        let solid = Solid { nodes, material: &material, incompatible };
        let u: Vec<f64> = solid.nodes.iter().flat_map(|&at| bending(at)).collect();
        let k = solid.stiffness().unwrap();
        let f: Vec<f64> = (0..24).map(|i| (0..24).map(|j| k[(i, j)] * u[j]).sum()).collect();
        if incompatible {
            for (stress, at) in solid.node_stresses(&u, &[]).unwrap().into_iter().zip(&solid.nodes) {
                assert!((stress[0] + 3.0 * CURVATURE * at[1]).abs() < 1e-14, "{stress:?}");
                assert!(stress[1..].iter().all(|value| value.abs() < 1e-14), "{stress:?}");
            }
            for (force, at) in f.chunks(3).zip(&solid.nodes) {
                // ∫ N σ_xx dA on the ends: −E κ h² b/24 at the corners, the sign of y, outwards at x = L.
                let corner = 3.0 * CURVATURE * height * height * width / 24.0 * at[1].signum();
                let right = if at[0] == 0.0 { corner } else { -corner };
                assert!((force[0] - right).abs() < 1e-14 && force[1].abs() < 1e-13 && force[2].abs() < 1e-13, "{f:?}");
            }
        }
        f.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>()
    };
    let exact = 3.0 * width * height * height * height / 12.0 * CURVATURE * CURVATURE * length;
    assert!((energy(true) / exact - 1.0).abs() < 1e-12, "{} {exact}", energy(true));
    // Shear that does not vanish: G κ² x²/12-like terms make it some (L/h)²/2(1 + ν) times as stiff.
    assert!(energy(false) / exact > 30.0);
}

/// Quadratic elements with straight sides hold the field of bending exactly, linear stress and nothing left over
/// inside: tetrahedra in any shape, hexahedra as parallelepipeds.
#[test]
fn quadratic_fields_are_exact() {
    let random = &mut ChaCha8Rng::seed_from_u64(6);
    for kind in [(10, false), (20, false)] {
        // Straight sides: corners moved at random for tetrahedra, middles put back; sheared hexahedra.
        let mut mesh = Mesh::new(kind, 2, [1.0, 1.2, 0.9], 0.0, random);
        let corners = if kind.0 == 10 { 4 } else { 8 };
        if kind.0 == 10 {
            let mut moved = mesh.nodes.clone();
            for at in &mut moved[..27] {
                *at = at.map(|x| x + 0.1 * random.random_range(-1.0..1.0));
            }
            for element in &mesh.elements {
                for (m, [a, b]) in TETRAHEDRON_SIDES.into_iter().enumerate() {
                    let [p, q] = [a, b].map(|end| moved[element[end]]);
                    moved[element[corners + m]] = [0, 1, 2].map(|c| 0.5 * (p[c] + q[c]));
                }
            }
            mesh.nodes = moved;
        } else {
            let shear = Matrix3::new(1.0, 0.3, -0.2, 0.1, 1.0, 0.25, 0.0, -0.15, 1.0);
            mesh.nodes.iter_mut().for_each(|at| *at = (shear * Vector3::from(*at)).into());
        }
        let material = material();
        for (index, nodes) in mesh.elements.iter().enumerate() {
            let solid = mesh.solid(index, &material);
            let u: Vec<f64> = nodes.iter().flat_map(|&node| bending(mesh.nodes[node])).collect();
            for (stress, at) in solid.node_stresses(&u, &[]).unwrap().into_iter().zip(&solid.nodes) {
                assert!((stress[0] + 3.0 * CURVATURE * at[1]).abs() < 1e-14, "{kind:?}: {stress:?}");
                assert!(stress[1..].iter().all(|value| value.abs() < 1e-14), "{kind:?}: {stress:?}");
            }
        }
        for ((force, terms), _) in mesh.forces(&bending).into_iter().zip(mesh.inner()).filter(|(_, inner)| *inner) {
            assert!((0..3).all(|c| force[c].abs() < 256.0 * EPS * terms[c]), "{kind:?}: {force:?} {terms:?}");
        }
    }
}

/// Nodes in the wrong order, flat or folded: refused, in both precisions.
#[test]
fn elements_turned_inside_out_are_refused() {
    let material = material();
    for kind in KINDS {
        let good = SolidShape::of(kind.0).nodes().to_vec();
        let refused = |nodes: Vec<[f64; 3]>| {
            let solid = Solid { nodes, material: &material, incompatible: kind.1 };
            solid.stiffness().is_err() && solid.doubled_stiffness().is_err()
        };
        assert!(!refused(good.clone()));
        assert!(refused(good.iter().map(|[x, y, z]| [*x, *y, -z]).collect()), "{kind:?}");
        assert!(refused(good.iter().map(|[x, y, _]| [*x, *y, 0.0]).collect()), "{kind:?}");
        if kind.0 > 8 {
            // A middle node of the first side beyond a quarter of it.
            let mut folded = good.clone();
            let corners = if kind.0 == 10 { 4 } else { 8 };
            folded[corners][0] = good[0][0] + 0.8 * (good[1][0] - good[0][0]);
            assert!(refused(folded), "{kind:?}");
        }
    }
}
