//! The checked, resolved structure: names have become indices, lists are complete, every number is finite.
//!
//! Node indices point into [`Structure::nodes`]; that list holds the author's nodes first (file order), then
//! the generated ones (plate nodes `lower[i,j]`, mesh nodes `dam/17`, bar divisions `AB/1`), so that results keep the
//! author's order.

use super::edge::EdgeSide;
use super::pair::Pair;
use super::parameter::Number;
use super::superelement::Superelement;

/// A node: its name and its place in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// `A`, `AB/1`, `lower[0,8]`.
    pub id: String,
    /// Coordinates (x, y), in the author's unit of length.
    pub position: [f64; 2],
}

/// One of the three displacement components of a node, in the global axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Component {
    /// Displacement along x.
    X,
    /// Displacement along y.
    Y,
    /// Rotation, counter-clockwise. Exists only at nodes of frame bars and of rigid bodies.
    R,
}

/// Linear elastic material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus, > 0.
    pub youngs_modulus: f64,
    /// Poisson's ratio in (−1, 0.5].
    pub poisson_ratio: f64,
    /// Mass per volume.
    pub density: f64,
    /// Coefficient of thermal expansion.
    pub expansion: f64,
}

/// Stress state of a plate or quad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// ε_zz = 0.
    Strain,
    /// σ_zz = 0.
    Stress,
}

/// What an element is made of and how it carries force.
#[derive(Clone, Debug, PartialEq)]
pub enum ElementKind {
    /// Two-node frame element, `nodes` = [start, end].
    Frame {
        /// Cross-section area.
        area: f64,
        /// Second moment of area.
        inertia: f64,
        /// Shear area; `None` for a bar that does not yield to shear.
        shear_area: Option<f64>,
        /// Moment hinge at start, at end.
        hinges: [bool; 2],
    },
    /// Two-node bar that carries axial force only, `nodes` = [start, end].
    Truss {
        /// Cross-section area.
        area: f64,
    },
    /// Membrane of 3, 4, 6 or 8 nodes, counter-clockwise: corners, then the middles of the sides 1-2, 2-3, ….
    Membrane {
        /// Thickness out of the plane.
        thickness: f64,
        /// Stress state.
        plane: Plane,
        /// Whether a membrane of four nodes has modes of its own beside those of its nodes, so that it bends freely.
        incompatible: bool,
    },
}

impl ElementKind {
    /// What a length (bars) or an area (membranes) of it is multiplied with to give its volume.
    pub fn area(&self) -> f64 {
        match self {
            ElementKind::Frame { area, .. } | ElementKind::Truss { area } => *area,
            ElementKind::Membrane { thickness, .. } => *thickness,
        }
    }
}

/// One finite element.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// 2 nodes (frame, truss), or 3, 4, 6, 8 (membrane).
    pub nodes: Vec<usize>,
    /// Index into [`Structure::materials`].
    pub material: usize,
    /// Kind and its data.
    pub kind: ElementKind,
}

impl Element {
    /// How many of its nodes are corners (the ends of a bar): they come first.
    pub fn corners(&self) -> usize {
        match self.nodes.len() {
            6 => 3,
            8 => 4,
            count => count,
        }
    }

    /// Its nodes as they lie round it, middle nodes between their corners; the two of a bar.
    pub fn ring(&self) -> impl Iterator<Item = usize> {
        let corners = self.corners();
        (0..corners).flat_map(move |k| [Some(self.nodes[k]), self.nodes.get(corners + k).copied()]).flatten()
    }
}

/// A bar of the file: a chain of equal elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// Name in the file.
    pub id: String,
    /// Its elements, from start to end: a range of [`Structure::elements`].
    pub elements: std::ops::Range<usize>,
}

/// A rectangular plate of the file: a grid of quads.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    /// Name in the file.
    pub id: String,
    /// Its elements, row by row from the bottom: a range of [`Structure::elements`].
    pub elements: std::ops::Range<usize>,
    /// Node grid: `nodes[j][i]` is `id[i,j]`.
    pub nodes: Vec<Vec<usize>>,
}

/// The elements of a mesh file that are areas.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshElements {
    /// Name in the file.
    pub id: String,
    /// A range of [`Structure::elements`].
    pub elements: std::ops::Range<usize>,
    /// Their numbers in the mesh file.
    pub tags: Vec<u64>,
    /// The parts that hang together.
    pub bodies: Vec<Body>,
    /// The sides of its elements, each once, with whether two elements share it.
    pub sides: Vec<(EdgeSide, bool)>,
}

/// Elements that hang together.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// `m`, `m.GROUP` or `m#TAG`.
    pub name: String,
    /// Indices into [`Structure::elements`].
    pub elements: Vec<usize>,
}

/// A displacement component held by a support.
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    /// The node.
    pub node: usize,
    /// The component that is held.
    pub component: Component,
}

/// Nodes that share displacement components.
#[derive(Clone, Debug, PartialEq)]
pub struct Tie {
    /// Two or more nodes.
    pub nodes: Vec<usize>,
    /// The shared components.
    pub components: Vec<Component>,
}

/// Nodes that move as one body: u_i = u_0 + θ × (x_i − x_0), small displacements.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody {
    /// Name in the file.
    pub id: String,
    /// Its nodes, two or more; the first is the one whose displacement and rotation are the body's unknowns.
    pub nodes: Vec<usize>,
}

/// Linear spring: it resists the stretch Σ factor·u of its terms.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// Components that stretch it: those of one node, to the ground, or of two nodes with opposite factors.
    pub terms: Vec<SpringTerm>,
    /// Force per stretch, or moment per rotation, ≥ 0.
    pub stiffness: f64,
}

/// What one component of a node does to a spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpringTerm {
    /// The node.
    pub node: usize,
    /// The component.
    pub component: Component,
    /// Stretch per displacement.
    pub factor: f64,
}

impl Spring {
    /// From a node to the ground, or to another node, along a unit vector.
    pub fn along(node: usize, other: Option<usize>, direction: [f64; 2], stiffness: f64) -> Spring {
        let ends = [Some((node, 1.0)), other.map(|other| (other, -1.0))];
        let components = [Component::X, Component::Y].into_iter().zip(direction);
        let terms = ends.into_iter().flatten().flat_map(|(node, sign)| {
            let term = move |(component, a): (Component, f64)| SpringTerm { node, component, factor: sign * a };
            components.clone().map(term)
        });
        Spring { terms: terms.collect(), stiffness }
    }

    /// Against the rotation of a node, or between those of two nodes.
    pub fn rotational(node: usize, other: Option<usize>, stiffness: f64) -> Spring {
        let ends = [Some((node, 1.0)), other.map(|other| (other, -1.0))];
        let term = |(node, factor)| SpringTerm { node, component: Component::R, factor };
        Spring { terms: ends.into_iter().flatten().map(term).collect(), stiffness }
    }

    /// Its nodes, each once.
    pub fn nodes(&self) -> Vec<usize> {
        let mut nodes: Vec<usize> = self.terms.iter().map(|term| term.node).collect();
        nodes.dedup();
        nodes
    }

    /// Whether its other end is the ground.
    pub fn is_to_ground(&self) -> bool {
        self.nodes().len() == 1
    }
}

/// One resolved part of a load case, per unit factor.
#[derive(Clone, Debug, PartialEq)]
pub enum Load {
    /// Force (and moment, counter-clockwise) at a node. Edge loads (`point` on an edge, `traction`) arrive here
    /// already made consistent, one per edge node.
    Nodal {
        /// The node.
        node: usize,
        /// (F_x, F_y).
        force: [f64; 2],
        /// Moment; not zero only at nodes with a rotation.
        moment: f64,
    },
    /// Force per unit length of one frame or truss element, linear along it, global axes.
    Line {
        /// Index into [`Structure::elements`].
        element: usize,
        /// Distances from the start of the element between which it acts.
        range: [f64; 2],
        /// (q_x, q_y) at both of them.
        value: [[f64; 2]; 2],
    },
    /// Force and moment between the nodes of one frame or truss element.
    BarPoint {
        /// Index into [`Structure::elements`].
        element: usize,
        /// Distance from the start of the element.
        distance: f64,
        /// (F_x, F_y), global axes.
        force: [f64; 2],
        /// Moment, counter-clockwise.
        moment: f64,
    },
    /// Uniform force per volume on any element, global axes.
    Body {
        /// Index into [`Structure::elements`].
        element: usize,
        /// (b_x, b_y).
        value: [f64; 2],
    },
    /// Displacement imposed on a component that a support holds.
    Settlement {
        /// The node.
        node: usize,
        /// The component.
        component: Component,
        /// Displacement, or rotation.
        value: f64,
    },
    /// What an element would do if nothing held it: temperature, lack of fit, prestress.
    FreeStrain {
        /// Index into [`Structure::elements`].
        element: usize,
        /// Along a bar; in all directions of a membrane.
        strain: f64,
        /// Of a frame bar, > 0 when the −y side is the longer one.
        curvature: f64,
    },
}

impl Load {
    /// Whether it is no load at all.
    pub fn is_nothing(&self) -> bool {
        match self {
            Load::Nodal { force, moment, .. } | Load::BarPoint { force, moment, .. } => {
                *force == [0.0; 2] && *moment == 0.0
            }
            Load::Line { value, .. } => *value == [[0.0; 2]; 2],
            Load::Body { value, .. } => *value == [0.0; 2],
            Load::Settlement { value, .. } => *value == 0.0,
            Load::FreeStrain { strain, curvature, .. } => *strain == 0.0 && *curvature == 0.0,
        }
    }
}

/// A named load case: `factor` × the sum of its loads.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadCase {
    /// Name in the file.
    pub name: String,
    /// Factor, may be a parameter.
    pub factor: Number,
    /// The loads per unit factor.
    pub loads: Vec<Load>,
}

/// The edge behind the pairs `joint[0]`, `joint[1]` …
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeContact {
    /// `joint`.
    pub id: String,
    /// Nodes of the edge in order, those of skipped pairs included: pair k is at node k.
    pub nodes: Vec<usize>,
}

/// A structure with its contact pairs and load cases, ready for the finite elements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Structure {
    /// All nodes, the author's first.
    pub nodes: Vec<Node>,
    /// Materials by index.
    pub materials: Vec<Material>,
    /// All elements: of bars, of plates, of meshes, then single ones, in file order.
    pub elements: Vec<Element>,
    /// The bars.
    pub bars: Vec<Bar>,
    /// The plates.
    pub plates: Vec<Plate>,
    /// The meshes.
    pub meshes: Vec<MeshElements>,
    /// Id and index of every element that the author named by itself: triangles and quads, in increasing order.
    pub named_elements: Vec<(String, usize)>,
    /// Held components, without repetition.
    pub supports: Vec<Support>,
    /// Ties.
    pub ties: Vec<Tie>,
    /// K and F of another program in the place of elements.
    pub superelement: Option<Superelement>,
    /// Rigid bodies; no node is in two of them.
    pub rigid: Vec<RigidBody>,
    /// Springs to the ground.
    pub springs: Vec<Spring>,
    /// Nodes that stand for the yielding ground of tensionless foundations, in increasing order: what their springs
    /// carry is contact with the ground and stands under the pairs.
    pub yielding_ground: Vec<usize>,
    /// Contact pairs in the order of the file.
    pub pairs: Vec<Pair>,
    /// The contacts of edges among them.
    pub edge_contacts: Vec<EdgeContact>,
    /// Load cases in the order of the file.
    pub load_cases: Vec<LoadCase>,
}

impl Structure {
    /// The rigid body of every node.
    pub fn body_of_nodes(&self) -> Vec<Option<usize>> {
        let mut body_of = vec![None; self.nodes.len()];
        for (body, rigid) in self.rigid.iter().enumerate() {
            rigid.nodes.iter().for_each(|&node| body_of[node] = Some(body));
        }
        body_of
    }

    /// Whether each element lies inside a rigid body, so that nothing strains it.
    pub fn rigid_elements(&self) -> Vec<bool> {
        let body_of = self.body_of_nodes();
        let is_rigid = |element: &Element| {
            let first = body_of[element.nodes[0]];
            first.is_some() && element.nodes.iter().all(|&node| body_of[node] == first)
        };
        self.elements.iter().map(is_rigid).collect()
    }

    /// The element `ID#TAG` of a mesh.
    fn mesh_element(&self, name: &str) -> Option<usize> {
        let (id, tag) = name.split_once('#')?;
        let mesh = self.meshes.iter().find(|mesh| mesh.id == id)?;
        let tag: u64 = tag.parse().ok()?;
        let index = mesh.tags.iter().position(|known| *known == tag)?;
        Some(mesh.elements.start + index)
    }

    /// The element that a name means: `lower{i,j}` of a plate, `ID#TAG` of a mesh, or the id of an element of its own.
    pub fn element_named(&self, name: &str) -> Option<usize> {
        if let Some((_, element)) = self.named_elements.iter().find(|(id, _)| id == name) {
            return Some(*element);
        }
        if let Some(element) = self.mesh_element(name) {
            return Some(element);
        }
        let (id, indices) = name.strip_suffix('}')?.split_once('{')?;
        let (i, j) = indices.split_once(',')?;
        let (i, j): (usize, usize) = (i.parse().ok()?, j.parse().ok()?);
        let plate = self.plates.iter().find(|plate| plate.id == id)?;
        let columns = plate.columns();
        let index = plate.elements.start + j.checked_mul(columns)?.checked_add(i)?;
        (i < columns && plate.elements.contains(&index)).then_some(index)
    }

    /// The name of a membrane element as [`Structure::element_named`] takes it.
    pub fn element_name(&self, element: usize) -> Option<String> {
        if let Ok(at) = self.named_elements.binary_search_by_key(&element, |(_, index)| *index) {
            return Some(self.named_elements[at].0.clone());
        }
        if let Some(mesh) = self.meshes.iter().find(|mesh| mesh.elements.contains(&element)) {
            return Some(format!("{}#{}", mesh.id, mesh.tags[element - mesh.elements.start]));
        }
        let plate = self.plates.iter().find(|plate| plate.elements.contains(&element))?;
        let k = element - plate.elements.start;
        Some(format!("{}{{{},{}}}", plate.id, k % plate.columns(), k / plate.columns()))
    }

    /// An element in words: `the element q1`; by its nodes where it has no name.
    pub fn element_in_words(&self, element: usize) -> String {
        if let Some(name) = self.element_name(element) {
            return format!("the element {name}");
        }
        let nodes: Vec<&str> = self.elements[element].nodes.iter().map(|&node| self.nodes[node].id.as_str()).collect();
        format!("the element with the nodes {}", nodes.join(", "))
    }
}

impl Plate {
    /// How many elements lie side by side along its length.
    pub fn columns(&self) -> usize {
        self.nodes.first().map_or(0, |row| row.len().saturating_sub(1))
    }
}
