//! A mesh as data, and the same mesh in every format.

use std::fmt::Write;

/// Lines of 2 or 3 nodes (ends, middle), areas of 3, 4, 6 or 8; numbers of nodes are indices + 1.
pub struct Drawn {
    pub nodes: Vec<[f64; 2]>,
    /// Groups of lines with their names.
    pub edges: Vec<(&'static str, Vec<Vec<usize>>)>,
    /// Groups of areas with their names.
    pub areas: Vec<(&'static str, Vec<Vec<usize>>)>,
}

impl Drawn {
    /// Dimension, name, elements of all groups.
    fn groups(&self) -> impl Iterator<Item = (u8, &'static str, &Vec<Vec<usize>>)> {
        let edges = self.edges.iter().map(|(name, all)| (1, *name, all));
        edges.chain(self.areas.iter().map(|(name, all)| (2, *name, all)))
    }

    /// Gmsh 2.2.
    pub fn msh2(&self) -> String {
        let mut text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n".to_owned();
        self.names(&mut text);
        let _ = writeln!(text, "$Nodes\n{}", self.nodes.len());
        for (k, [x, y]) in self.nodes.iter().enumerate() {
            let _ = writeln!(text, "{} {x:?} {y:?} 0", k + 1);
        }
        let count: usize = self.groups().map(|(.., all)| all.len()).sum();
        let _ = writeln!(text, "$EndNodes\n$Elements\n{count}");
        let mut tag = 0;
        for (number, (dimension, _, all)) in self.groups().enumerate() {
            for nodes in all {
                tag += 1;
                let kind = kind(dimension, nodes.len());
                let _ = writeln!(text, "{tag} {kind} 2 {} 1 {}", number + 1, listed(nodes, " "));
            }
        }
        text + "$EndElements\n"
    }

    /// Gmsh 4.1: an entity for each group.
    pub fn msh4(&self) -> String {
        let mut text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n".to_owned();
        self.names(&mut text);
        let _ = writeln!(text, "$Entities\n0 {} {} 0", self.edges.len(), self.areas.len());
        for (number, (dimension, ..)) in self.groups().enumerate() {
            let entity = if dimension == 1 { number } else { number - self.edges.len() };
            let _ = writeln!(text, "{} 0 0 0 1 1 0 1 {} 0 ", entity + 1, number + 1);
        }
        let n = self.nodes.len();
        let _ = writeln!(text, "$EndEntities\n$Nodes\n1 {n} 1 {n}\n2 1 0 {n}");
        (0..n).for_each(|k| text += &format!("{}\n", k + 1));
        for [x, y] in &self.nodes {
            let _ = writeln!(text, "{x:?} {y:?} 0");
        }
        // A block for each group and type.
        let mut blocks = Vec::new();
        for (number, (dimension, _, all)) in self.groups().enumerate() {
            let entity = if dimension == 1 { number } else { number - self.edges.len() };
            for size in [2, 3, 4, 6, 8] {
                let of: Vec<&Vec<usize>> = all.iter().filter(|nodes| nodes.len() == size).collect();
                if !of.is_empty() {
                    blocks.push((dimension, entity + 1, kind(dimension, size), of));
                }
            }
        }
        let count: usize = blocks.iter().map(|(.., of)| of.len()).sum();
        let _ = writeln!(text, "$EndNodes\n$Elements\n{} {count} 1 {count}", blocks.len());
        let mut tag = 0;
        for (dimension, entity, kind, of) in blocks {
            let _ = writeln!(text, "{dimension} {entity} {kind} {}", of.len());
            for nodes in of {
                tag += 1;
                let _ = writeln!(text, "{tag} {} ", listed(nodes, " "));
            }
        }
        text + "$EndElements\n"
    }

    fn names(&self, text: &mut String) {
        let _ = writeln!(text, "$PhysicalNames\n{}", self.edges.len() + self.areas.len());
        for (number, (dimension, name, _)) in self.groups().enumerate() {
            let _ = writeln!(text, "{dimension} {} \"{name}\"", number + 1);
        }
        text.push_str("$EndPhysicalNames\n");
    }

    /// Abaqus: areas by type and set, edges as node sets.
    pub fn inp(&self) -> String {
        let mut text = "*HEADING\n** written by a test\n*NODE\n".to_owned();
        for (k, [x, y]) in self.nodes.iter().enumerate() {
            let _ = writeln!(text, "{}, {x:?}, {y:?}", k + 1);
        }
        let mut tag = 0;
        for (name, all) in &self.areas {
            for nodes in all {
                tag += 1;
                let _ =
                    writeln!(text, "*ELEMENT, TYPE=CPS{}, ELSET={name}\n{tag}, {}", nodes.len(), listed(nodes, ", "));
            }
        }
        for (name, all) in &self.edges {
            let nodes: Vec<usize> = all.iter().flatten().copied().collect();
            let _ = writeln!(text, "*NSET, NSET={name}\n{}", listed(&nodes, ",\n"));
        }
        text
    }
}

fn listed(nodes: &[usize], between: &str) -> String {
    nodes.iter().map(|node| (node + 1).to_string()).collect::<Vec<_>>().join(between)
}

/// Types of Gmsh.
fn kind(dimension: u8, nodes: usize) -> u8 {
    match (dimension, nodes) {
        (1, 2) => 1,
        (1, 3) => 8,
        (_, 3) => 2,
        (_, 4) => 3,
        (_, 6) => 9,
        _ => 16,
    }
}
