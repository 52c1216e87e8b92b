//! Meshes that other programs wrote: files of Gmsh (`gmsh`) and of Abaqus and CalculiX (`abaqus`) → one [`Mesh`]
//! whatever the format (`raw`), every number of it checked (`assemble`). `chain` and `boundary` find edges in it,
//! `surface` faces, `overview` lists what there is.
//!
//! Nothing a file claims is trusted: counts only say when to stop.

mod abaqus;
mod assemble;
pub mod boundary;
pub mod chain;
pub mod facing;
mod file;
mod gmsh;
pub mod overview;
mod raw;
#[cfg(test)]
mod solid_tests;
mod source;
pub mod surface;
#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use super::problem::{Problem, Problems};
pub use super::shape::Shape;
use crate::text::file::reason;
use crate::text::hash::Hash;

/// What is wrong with a mesh, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshProblem {
    /// The file as it was named; one that it includes has a name of its own.
    pub file: String,
    /// Line, from 1; 0 where there is none (binary files, files that cannot be read).
    pub line: usize,
    /// What was found and what was expected.
    pub message: String,
    /// What to do.
    pub help: String,
}

impl MeshProblem {
    /// `dam.msh:17`, or `dam.msh` without a line.
    pub fn place(&self) -> String {
        match self.line {
            0 => self.file.clone(),
            line => format!("{}:{line}", self.file),
        }
    }
}

/// The problems of a mesh that is examined on its own.
pub fn as_problems(name: &str, found: Vec<MeshProblem>) -> Problems {
    let problem = |found: MeshProblem| {
        let place = found.place();
        // A problem in an included file is reported with the name of that file.
        let (line, message) = match found.file == name {
            true => (found.line, found.message),
            false => (0, format!("{place}: {}", found.message)),
        };
        Problem { line, column: usize::from(line > 0), path: String::new(), message, help: found.help }
    };
    Problems { file: name.to_owned(), problems: found.into_iter().map(problem).collect(), more: 0 }
}

/// Where something stands: the file (an index into [`Mesh::files`]) and the line, from 1; 0 in a binary file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Index of the file.
    pub file: u32,
    /// Line.
    pub line: u32,
}

/// A node of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshNode {
    /// Its number in the file.
    pub tag: u64,
    /// Coordinates; in a mesh without solids the third is the same for all nodes of the areas.
    pub position: [f64; 3],
    /// Where it stands.
    pub place: Place,
}

/// What a bar element of an .inp file is by its type; Gmsh does not say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineType {
    /// T2D2 and its like.
    Truss,
    /// B21 and its like, and the lines of Gmsh.
    Beam,
}

/// A line, an area or a solid of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshElement {
    /// Its number in the file.
    pub tag: u64,
    /// What it is.
    pub shape: Shape,
    /// Indices of its nodes in the order of its shape; areas that are elements run counter-clockwise.
    pub nodes: Vec<u32>,
    /// What a line is as a bar.
    pub line_type: LineType,
    /// Where it stands.
    pub place: Place,
}

/// What a group consists of, as indices of nodes or elements, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub enum Members {
    /// Single nodes: a group of points.
    Points(Vec<u32>),
    /// A node set of an .inp file: its nodes, and the boundary between them as an edge.
    NodeSet(Vec<u32>),
    /// Lines: an edge, or bars.
    Lines(Vec<u32>),
    /// Sides of areas: the element, and the corner at which the side begins; of solids, and the number of the face;
    /// `None`: all sides on the boundary.
    Sides(Vec<(u32, Option<u8>)>),
    /// Areas: elements, or parts of the surface of solids.
    Areas(Vec<u32>),
    /// Solids.
    Solids(Vec<u32>),
}

impl Members {
    /// What its members are, in words.
    pub fn what(&self) -> &'static str {
        match self {
            Members::Points(_) => "points",
            Members::NodeSet(_) => "nodes",
            Members::Lines(_) => "lines",
            Members::Sides(_) => "element sides",
            Members::Areas(_) | Members::Solids(_) => "elements",
        }
    }

    /// How many.
    pub fn count(&self) -> usize {
        match self {
            Members::Points(all)
            | Members::NodeSet(all)
            | Members::Lines(all)
            | Members::Areas(all)
            | Members::Solids(all) => all.len(),
            Members::Sides(all) => all.len(),
        }
    }
}

/// A physical group or a set.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Its name, or its number where it has none.
    pub name: String,
    /// Whether it has a name.
    pub is_named: bool,
    /// What it consists of.
    pub members: Members,
    /// Where it is named, or its first member stands.
    pub place: Place,
}

/// A mesh as its file describes it, checked: elements have no folds and are right side out, all numbers are finite. Its
/// bodies consist of areas in one plane, or of solids; areas beside solids are parts of their surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Names of the file and of those it includes.
    pub files: Vec<String>,
    /// `Gmsh 4.1, ASCII`.
    pub format: String,
    /// All nodes of the file.
    pub nodes: Vec<MeshNode>,
    /// Lines, areas and solids, each once.
    pub elements: Vec<MeshElement>,
    /// The largest dimension of an element; 0 without elements.
    pub dimension: u8,
    /// Groups that have members, in the order of the file.
    pub groups: Vec<Group>,
    /// Names of groups that have none, and where they stand.
    pub empty_groups: Vec<(String, Place)>,
    /// Whether names of groups are the same in large and small letters.
    pub ignores_case: bool,
    /// What was put right, in words.
    pub notes: Vec<String>,
    /// What the file holds besides the mesh and was left alone: keywords or sections.
    pub skipped: Vec<String>,
    node_of: HashMap<u64, u32>,
    element_of: HashMap<u64, u32>,
}

impl Mesh {
    /// The node with this number.
    pub fn node(&self, tag: u64) -> Option<u32> {
        self.node_of.get(&tag).copied()
    }

    /// The element with this number.
    pub fn element(&self, tag: u64) -> Option<u32> {
        self.element_of.get(&tag).copied()
    }

    /// `dam.msh:17`.
    pub fn at(&self, place: Place) -> String {
        let file = &self.files[place.file as usize];
        match place.line {
            0 => file.clone(),
            line => format!("{file}:{line}"),
        }
    }

    /// The groups of this name.
    pub fn groups_named<'m>(&'m self, name: &'m str) -> impl Iterator<Item = &'m Group> {
        self.groups.iter().filter(move |group| self.same_name(&group.name, name))
    }

    /// Whether its bodies consist of what a group has.
    pub fn is_body(&self, group: &Group) -> bool {
        match group.members {
            Members::Areas(_) => !self.is_solid(),
            Members::Solids(_) => true,
            _ => false,
        }
    }

    /// Where an empty group of this name stands.
    pub fn empty_group(&self, name: &str) -> Option<Place> {
        self.empty_groups.iter().find(|(empty, _)| self.same_name(empty, name)).map(|(_, place)| *place)
    }

    /// Whether two names mean the same group.
    pub fn same_name(&self, one: &str, other: &str) -> bool {
        one == other || self.ignores_case && one.eq_ignore_ascii_case(other)
    }

    /// The hash with nodes, elements and groups appended.
    pub fn hash(&self, mut hash: Hash) -> Hash {
        let mut put = |number: u64| hash = hash.and(&number.to_le_bytes());
        for node in &self.nodes {
            put(node.tag);
            node.position.iter().for_each(|x| put(x.to_bits()));
        }
        for element in &self.elements {
            put(element.tag);
            element.nodes.iter().for_each(|node| put(u64::from(*node)));
        }
        for group in &self.groups {
            group.name.bytes().for_each(|byte| put(u64::from(byte)));
            match &group.members {
                Members::Points(all)
                | Members::NodeSet(all)
                | Members::Lines(all)
                | Members::Areas(all)
                | Members::Solids(all) => {
                    all.iter().for_each(|index| put(u64::from(*index)));
                }
                Members::Sides(all) => all.iter().for_each(|(element, side)| {
                    put(u64::from(*element));
                    put(side.map_or(u64::MAX, u64::from));
                }),
            }
        }
        hash
    }

    /// Whether its bodies are solids.
    pub fn is_solid(&self) -> bool {
        self.dimension == 3
    }

    /// Indices of the elements that its bodies consist of: its solids, or its areas.
    pub fn of_bodies(&self) -> impl Iterator<Item = u32> {
        let of = self.dimension.max(2);
        self.elements
            .iter()
            .zip(0..)
            .filter(move |(element, _)| element.shape.dimension() == of)
            .map(|(_, index)| index)
    }

    /// Coordinates of a node in the plane.
    pub fn position(&self, node: u32) -> [f64; 2] {
        let [x, y, _] = self.nodes[node as usize].position;
        [x, y]
    }
}

/// Whether a file name has the ending of a mesh.
pub fn is_mesh_name(path: &Path) -> bool {
    format_of(path).is_some()
}

#[derive(Clone, Copy)]
enum Format {
    Gmsh,
    Abaqus,
}

fn format_of(path: &Path) -> Option<Format> {
    let ending = path.extension()?;
    if ending.eq_ignore_ascii_case("msh") {
        Some(Format::Gmsh)
    } else if ending.eq_ignore_ascii_case("inp") {
        Some(Format::Abaqus)
    } else {
        None
    }
}

/// Reads a mesh file. `name` is how messages call it; `path` is where it is.
///
/// # Errors
/// What is wrong with it: one problem of each kind.
pub fn read(path: &Path, name: &str) -> Result<Mesh, Vec<MeshProblem>> {
    let problem = |message: String, help: &str| {
        vec![MeshProblem { file: name.to_owned(), line: 0, message, help: help.to_owned() }]
    };
    let Some(format) = format_of(path) else {
        return Err(problem(
            "the name of a mesh file ends in .msh (Gmsh) or .inp (Abaqus, CalculiX)".into(),
            "save the mesh in one of these formats",
        ));
    };
    let bytes = file::read(path)
        .map_err(|error| problem(format!("cannot read the mesh: {}", reason(&error)), "check name and folder"))?;
    match format {
        Format::Gmsh => read_gmsh(&bytes, name),
        Format::Abaqus => read_abaqus(&bytes, name, path.parent()),
    }
}

/// The bytes after the mark that some editors put in front of UTF-8.
fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// Reads the bytes of a .msh file.
///
/// # Errors
/// See [`read`].
pub fn read_gmsh(bytes: &[u8], name: &str) -> Result<Mesh, Vec<MeshProblem>> {
    assemble::mesh(gmsh::read(without_mark(bytes), name).map_err(|problem| vec![problem])?)
}

/// Reads the bytes of an .inp file; without a folder it cannot include others.
///
/// # Errors
/// See [`read`].
pub fn read_abaqus(bytes: &[u8], name: &str, folder: Option<&Path>) -> Result<Mesh, Vec<MeshProblem>> {
    assemble::mesh(abaqus::read(without_mark(bytes), name, folder).map_err(|problem| vec![problem])?)
}

/// Meshes by the names that a scenario gives them, read once: a value set later means the mesh that was loaded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshFiles(pub HashMap<String, Arc<Mesh>>);
