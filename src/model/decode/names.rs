//! What the names of a file mean: nodes, edges, plates and elements.

use std::collections::HashMap;

use super::builder::Builder;
use super::mesh_names::MeshPart;
use super::reader::Cursor;
use super::spot::Spot;
use super::words::{did_you_mean, listed, quoted};
use crate::model::brick::{Brick, BrickSide};
use crate::model::edge::Edge;
use crate::model::face::Face;
use crate::model::plate::PlateSide;
use crate::model::structure::{Dimension, indices};

impl<'d> Builder<'d> {
    /// The node or edge that a string names.
    pub fn spot(&self, cursor: Cursor<'d>) -> Option<Spot> {
        let name = cursor.string()?;
        if let Some(node) = self.node_named(name) {
            return Some(Spot::Node(node));
        }
        if let Some(edge) = self.edges.get(name) {
            return Some(Spot::Edge(edge.clone()));
        }
        if let Some((part, rest)) = self.mesh_name(name) {
            return part.spot(cursor, rest);
        }
        if self.is_of_broken_mesh(name) {
            return None;
        }
        if self.structure.dimension == Dimension::Space {
            return self.spot_in_space(cursor, name);
        }
        if let Some((id, side)) = name.split_once('.') {
            let plate = self.plate(cursor, id, name)?;
            let Some((_, side)) = PlateSide::WORDS.iter().find(|(word, _)| *word == side) else {
                cursor.problem(
                    format!("the plate \"{id}\" has no edge {}", quoted(side)),
                    format!("expected {id}.bottom, {id}.top, {id}.left or {id}.right"),
                );
                return None;
            };
            return Some(Spot::Edge(side.edge(&self.structure.plates[plate])));
        }
        if let Some((id, within)) = name.strip_suffix(']').and_then(|rest| rest.split_once('[')) {
            let plate = self.plate(cursor, id, name)?;
            let node = self.plate_node(plate, within);
            if node.is_none() {
                let grid = &self.structure.plates[plate].nodes;
                cursor.problem(
                    format!("the plate \"{id}\" has no node {}", quoted(name)),
                    format!(
                        "its nodes are {id}[i,j] with i = 0…{} and j = 0…{}, without spaces",
                        grid[0].len() - 1,
                        grid.len() - 1
                    ),
                );
            }
            return node.map(Spot::Node);
        }
        self.unknown_spot(cursor, name);
        None
    }

    /// The face or node of a brick that a string names.
    fn spot_in_space(&self, cursor: Cursor<'d>, name: &str) -> Option<Spot> {
        if let Some((id, side)) = name.split_once('.') {
            let brick = self.brick(cursor, id, name)?;
            let Some((_, side)) = BrickSide::WORDS.iter().find(|(word, _)| *word == side) else {
                let sides = BrickSide::WORDS.map(|(word, _)| format!("{id}.{word}"));
                let sides: Vec<&str> = sides.iter().map(String::as_str).collect();
                cursor.problem(
                    format!("the brick \"{id}\" has no face {}", quoted(side)),
                    format!("expected {}", listed(&sides)),
                );
                return None;
            };
            return Some(Spot::Face(side.face(brick)));
        }
        if let Some((id, within)) = name.strip_suffix(']').and_then(|rest| rest.split_once('[')) {
            let brick = self.brick(cursor, id, name)?;
            let node = indices(within).and_then(|at| brick.node(at));
            if node.is_none() {
                let [nx, ny, nz] = brick.divisions;
                cursor.problem(
                    format!("the brick \"{id}\" has no node {}", quoted(name)),
                    format!("its nodes are {id}[i,j,k] with i = 0…{nx}, j = 0…{ny} and k = 0…{nz}, without spaces"),
                );
            }
            return node.map(Spot::Node);
        }
        self.unknown_spot(cursor, name);
        None
    }

    fn brick(&self, cursor: Cursor<'d>, id: &str, name: &str) -> Option<&Brick> {
        self.grid("brick", &self.bricks, cursor, id, name).map(|brick| &self.structure.bricks[brick])
    }

    fn plate(&self, cursor: Cursor<'d>, id: &str, name: &str) -> Option<usize> {
        self.grid("plate", &self.plates, cursor, id, name)
    }

    /// The plate or brick `id` with which `name` begins.
    fn grid(&self, what: &str, all: &HashMap<&str, usize>, cursor: Cursor<'d>, id: &str, name: &str) -> Option<usize> {
        let found = all.get(id).copied();
        if found.is_none() && !self.broken.contains(id) {
            let hint = did_you_mean(id, all.keys().copied());
            let mut known: Vec<&str> = all.keys().copied().collect();
            known.sort_unstable();
            let help = match &known[..] {
                [] => format!("the structure has no {what}s"),
                known => format!("expected {}", listed(known)),
            };
            cursor.problem(format!("unknown {what} {} in {}{hint}", quoted(id), quoted(name)), help);
        }
        found
    }

    /// The mesh that a name begins with, and what follows its id.
    fn mesh_name<'n>(&self, name: &'n str) -> Option<(&MeshPart, &'n str)> {
        let at = name.find(['/', '.', '#'])?;
        Some((self.meshes.get(&name[..at])?, &name[at..]))
    }

    fn is_of_broken_mesh(&self, name: &str) -> bool {
        name.find(['/', '.', '#']).is_some_and(|at| self.broken.contains(&name[..at]))
    }

    /// All nodes that `at` names, where their order does not matter: one, those of an edge, or those of a set.
    pub fn nodes_at(&self, cursor: Cursor<'d>) -> Option<Vec<usize>> {
        let name = cursor.string()?;
        let set = self.mesh_name(name).and_then(|(part, rest)| part.node_set(rest));
        set.or_else(|| match self.spot(cursor)? {
            Spot::Node(node) => Some(vec![node]),
            Spot::Edge(edge) => Some(edge.distinct_nodes().to_vec()),
            Spot::Face(face) => Some(face.nodes),
        })
    }

    /// All nodes of an edge, a face or a set; a single node is reported.
    pub fn edge_nodes_at(&self, cursor: Cursor<'d>) -> Option<Vec<usize>> {
        match self.nodes_at(cursor)? {
            nodes if nodes.len() > 1 => Some(nodes),
            _ if self.structure.dimension == Dimension::Space => self.face(cursor).map(|face| face.nodes),
            _ => self.edge(cursor).map(|edge| edge.nodes),
        }
    }

    fn plate_node(&self, plate: usize, within: &str) -> Option<usize> {
        let [i, j] = indices(within)?;
        self.structure.plates[plate].nodes.get(j)?.get(i).copied()
    }

    fn unknown_spot(&self, cursor: Cursor<'d>, name: &str) {
        let bar = name.split_once('/').map(|(bar, _)| bar);
        if self.nodes_are_unknown || self.broken.contains(name) || bar.is_some_and(|bar| self.broken.contains(bar)) {
            return;
        }
        if self.meshes.contains_key(name) {
            let (border, of) = match self.structure.dimension {
                Dimension::Plane => ("an edge", "lines"),
                Dimension::Space => ("a face", "areas"),
            };
            cursor.problem(
                format!("\"{name}\" is a mesh, expected a node or {border}"),
                format!("name one of its nodes, \"{name}/17\", or groups of {of}, \"{name}.GROUP\""),
            );
            return;
        }
        if self.bricks.contains_key(name) {
            cursor.problem(
                format!("\"{name}\" is a brick, expected a node or a face"),
                format!("name one of its nodes, \"{name}[i,j,k]\", or faces, \"{name}.top\""),
            );
            return;
        }
        if self.plates.contains_key(name) {
            cursor.problem(
                format!("\"{name}\" is a plate, expected a node or an edge"),
                format!("name one of its nodes, \"{name}[i,j]\", or edges, \"{name}.top\""),
            );
            return;
        }
        if let Some((id, bar)) = bar.and_then(|id| Some((id, *self.bars.get(id)?))) {
            let divisions = self.structure.bars[bar].elements.len();
            let help = match divisions {
                1 => format!("the bar \"{id}\" is not divided: give it `divisions`"),
                2 => format!("its one inner node is \"{id}/1\""),
                _ => format!("its inner nodes are \"{id}/1\" to \"{id}/{}\"", divisions - 1),
            };
            cursor.problem(format!("the bar \"{id}\" has no node {}", quoted(name)), help);
            return;
        }
        let hint = did_you_mean(name, self.node_names());
        let help = if hint.is_empty() {
            match self.structure.dimension {
                Dimension::Plane => {
                    "expected the id of a node, a plate node like \"lower[0,8]\" or an edge like \"lower.top\""
                }
                Dimension::Space => {
                    "expected the id of a node, a node of a brick like \"lower[0,8,2]\" or a face like \"lower.top\""
                }
            }
        } else {
            "nodes are named by their id"
        };
        cursor.problem(format!("unknown node {}{hint}", quoted(name)), help);
    }

    /// The node that a string names; an edge is reported.
    pub fn node(&self, cursor: Cursor<'d>) -> Option<usize> {
        match self.spot(cursor)? {
            Spot::Node(node) => Some(node),
            other => {
                cursor.problem(
                    format!("expected a node, found the {} {}", other.word(), cursor.quoted()),
                    match self.structure.dimension {
                        Dimension::Plane => "name one node, e.g. a plate node \"lower[0,8]\"",
                        Dimension::Space => "name one node, e.g. a node of a brick \"lower[0,8,2]\"",
                    },
                );
                None
            }
        }
    }

    /// The edge that a string names; a node is reported.
    pub fn edge(&self, cursor: Cursor<'d>) -> Option<Edge> {
        match self.spot(cursor)? {
            Spot::Edge(edge) => Some(edge),
            other => {
                cursor.problem(
                    format!("expected an edge, found the {} {}", other.word(), cursor.quoted()),
                    "edges belong to plates, \"lower.top\", or are named under `edges`",
                );
                None
            }
        }
    }

    /// The face that a string names; a node is reported.
    pub fn face(&self, cursor: Cursor<'d>) -> Option<Face> {
        let other = match self.spot(cursor)? {
            Spot::Face(face) => return Some(face),
            other => other.word(),
        };
        cursor.problem(
            format!("expected a face, found the {other} {}", cursor.quoted()),
            "faces belong to bricks, \"block.top\", or to meshes of solids, \"mesh.GROUP\"",
        );
        None
    }

    /// The elements of a bar, plate, mesh, group of a mesh, triangle or quad that a string names.
    pub fn elements_of(&self, cursor: Cursor<'d>) -> Option<Vec<usize>> {
        let name = cursor.string()?;
        if let Some(&bar) = self.bars.get(name) {
            return Some(self.structure.bars[bar].elements.clone().collect());
        }
        if let Some(&plate) = self.plates.get(name) {
            return Some(self.structure.plates[plate].elements.clone().collect());
        }
        if let Some(&brick) = self.bricks.get(name) {
            return Some(self.structure.bricks[brick].elements.clone().collect());
        }
        if let Some(&element) = self.single_elements.get(name) {
            return Some(vec![element]);
        }
        let mesh = self.meshes.get(name).map(|part| (part, ""));
        if let Some((part, rest)) = mesh.or_else(|| self.mesh_name(name)) {
            return part.elements(cursor, rest);
        }
        if !self.broken.contains(name) && !self.is_of_broken_mesh(name) {
            let own = self
                .plates
                .keys()
                .chain(self.bricks.keys())
                .chain(self.single_elements.keys())
                .chain(self.meshes.keys())
                .copied();
            let mut known: Vec<&str> = self.bars.keys().map(|id| &**id).chain(own).collect();
            known.sort_unstable();
            cursor.unknown("element", name, &known);
        }
        None
    }
}
