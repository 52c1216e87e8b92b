//! The checked, resolved structure: names have become indices, lists are complete, every number is finite.
//!
//! Node indices point into [`Structure::nodes`]; that list holds the author's nodes first (file order), then
//! the generated ones (plate nodes `lower[i,j]`, mesh nodes `dam/17`, bar divisions `AB/1`), so that results keep the
//! author's order.

pub use super::brick::Brick;
pub use super::dimension::Dimension;
use super::edge::EdgeSide;
pub use super::element::{Element, ElementKind, Material, Plane};
pub use super::load_case::{ElementLoad, Load, LoadCase};
pub use super::node::{Component, Node};
use super::pair::Pair;
pub use super::plate::Plate;
use super::superelement::Superelement;
pub use super::support::{RigidBody, Spring, SpringTerm, Support, Tie};

/// A bar of the file: a chain of equal elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// Name in the file.
    pub id: String,
    /// Its elements, from start to end: a range of [`Structure::elements`].
    pub elements: std::ops::Range<usize>,
}

/// The elements of a mesh file that are areas or solids.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshElements {
    /// Name in the file.
    pub id: String,
    /// A range of [`Structure::elements`].
    pub elements: std::ops::Range<usize>,
    /// Their numbers in the mesh file.
    pub tags: Vec<u64>,
    /// Its connected parts.
    pub bodies: Vec<Body>,
    /// The sides of its elements, each once, with whether two elements share it.
    pub sides: Vec<(EdgeSide, bool)>,
}

/// Connected elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// `m`, `m.GROUP` or `m#TAG`.
    pub name: String,
    /// Indices into [`Structure::elements`].
    pub elements: Vec<usize>,
}

/// The edge or face behind the pairs `joint[0]`, `joint[1]` …
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeContact {
    /// `joint`.
    pub id: String,
    /// Nodes of the edge or face in order, those of skipped pairs included: pair k is at node k, or beside it (see
    /// [`Pair::place`](super::pair::Pair::place)).
    pub nodes: Vec<usize>,
    /// The part of the area of a face, or of the common length of edges whose nodes do not match, that stands for each
    /// node; none of other edges, whose nodes lie one after the other.
    pub shares: Vec<f64>,
}

/// A structure with its contact pairs and load cases, ready for the finite elements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Structure {
    /// Where it lies.
    pub dimension: Dimension,
    /// All nodes, the author's first.
    pub nodes: Vec<Node>,
    /// Materials by index.
    pub materials: Vec<Material>,
    /// All elements: of bars, of plates, of bricks, of meshes, then single ones, in file order.
    pub elements: Vec<Element>,
    /// The bars, in the order of their elements.
    pub bars: Vec<Bar>,
    /// The plates.
    pub plates: Vec<Plate>,
    /// The bricks.
    pub bricks: Vec<Brick>,
    /// The meshes.
    pub meshes: Vec<MeshElements>,
    /// Id and index of every element that the author named individually: triangles and quads, in increasing order.
    pub named_elements: Vec<(String, usize)>,
    /// Held components, without repetition.
    pub supports: Vec<Support>,
    /// Ties.
    pub ties: Vec<Tie>,
    /// K and F of another program in place of elements.
    pub superelement: Option<Superelement>,
    /// Rigid bodies; no node is in two of them.
    pub rigid: Vec<RigidBody>,
    /// Springs, to the ground or between two nodes.
    pub springs: Vec<Spring>,
    /// Nodes that stand for the yielding ground of tensionless foundations, in increasing order: what their springs
    /// carry is contact with the ground and stands under the pairs.
    pub yielding_ground: Vec<usize>,
    /// Contact pairs in the order of the file.
    pub pairs: Vec<Pair>,
    /// The contacts of edges and faces among them.
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

    /// The largest difference between the nodes along each axis.
    pub fn extent(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            let all = self.nodes.iter().map(|node| node.position[axis]);
            let [least, largest] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
            largest - least
        })
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

    /// The bar to which an element belongs.
    pub fn bar_of(&self, element: usize) -> Option<usize> {
        let bar = self.bars.partition_point(|bar| bar.elements.end <= element);
        self.bars.get(bar).is_some_and(|bar| bar.elements.contains(&element)).then_some(bar)
    }

    /// The element `ID#TAG` of a mesh.
    fn mesh_element(&self, name: &str) -> Option<usize> {
        let (id, tag) = name.split_once('#')?;
        let mesh = self.meshes.iter().find(|mesh| mesh.id == id)?;
        let tag: u64 = tag.parse().ok()?;
        let index = mesh.tags.iter().position(|known| *known == tag)?;
        Some(mesh.elements.start + index)
    }

    /// Ids of plates, bricks and meshes, then the names of the parts of meshes.
    pub fn bodies(&self) -> Vec<&str> {
        let plates = self.plates.iter().map(|plate| plate.id.as_str());
        let bricks = self.bricks.iter().map(|brick| brick.id.as_str());
        let meshes = self.meshes.iter().map(|mesh| mesh.id.as_str());
        let parts = self.meshes.iter().flat_map(|mesh| &mesh.bodies).map(|body| body.name.as_str());
        let mut names: Vec<&str> = plates.chain(bricks).chain(meshes).collect();
        // A mesh of one part bears its name.
        parts.for_each(|part| {
            if !names.contains(&part) {
                names.push(part)
            }
        });
        names
    }

    /// The elements of one of the [`bodies`](Self::bodies).
    pub fn elements_of_body(&self, name: &str) -> Option<Vec<usize>> {
        let plates = self.plates.iter().map(|plate| (&plate.id, &plate.elements));
        let bricks = self.bricks.iter().map(|brick| (&brick.id, &brick.elements));
        let meshes = self.meshes.iter().map(|mesh| (&mesh.id, &mesh.elements));
        let whole = plates.chain(bricks).chain(meshes).find(|(id, _)| *id == name);
        let parts = || self.meshes.iter().flat_map(|mesh| &mesh.bodies).find(|body| body.name == name);
        whole.map(|(_, elements)| elements.clone().collect()).or_else(|| parts().map(|body| body.elements.clone()))
    }

    /// The element that a name means: `lower{i,j}` of a plate, `ID#TAG` of a mesh, or the id of an element of its own.
    pub fn element_named(&self, name: &str) -> Option<usize> {
        if let Some((_, element)) = self.named_elements.iter().find(|(id, _)| id == name) {
            return Some(*element);
        }
        if let Some(element) = self.mesh_element(name) {
            return Some(element);
        }
        let (id, within) = name.strip_suffix('}')?.split_once('{')?;
        if let Some(brick) = self.bricks.iter().find(|brick| brick.id == id) {
            return brick.element(indices(within)?);
        }
        let [i, j] = indices(within)?;
        let plate = self.plates.iter().find(|plate| plate.id == id)?;
        let columns = plate.columns();
        let index = plate.elements.start + j.checked_mul(columns)?.checked_add(i)?;
        (i < columns && plate.elements.contains(&index)).then_some(index)
    }

    /// The name of an area or a solid as [`Structure::element_named`] takes it.
    pub fn element_name(&self, element: usize) -> Option<String> {
        if let Ok(at) = self.named_elements.binary_search_by_key(&element, |(_, index)| *index) {
            return Some(self.named_elements[at].0.clone());
        }
        if let Some(mesh) = self.meshes.iter().find(|mesh| mesh.elements.contains(&element)) {
            return Some(format!("{}#{}", mesh.id, mesh.tags[element - mesh.elements.start]));
        }
        if let Some(brick) = self.bricks.iter().find(|brick| brick.elements.contains(&element)) {
            let [i, j, k] = brick.indices(element);
            return Some(format!("{}{{{i},{j},{k}}}", brick.id));
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

/// `i,j` or `i,j,k`.
pub fn indices<const COUNT: usize>(text: &str) -> Option<[usize; COUNT]> {
    let index = |digits: &str| {
        let plain = digits.bytes().all(|byte| byte.is_ascii_digit());
        digits.parse::<usize>().ok().filter(|_| plain)
    };
    let indices: Vec<usize> = text.split(',').map(index).collect::<Option<_>>()?;
    indices.try_into().ok()
}
