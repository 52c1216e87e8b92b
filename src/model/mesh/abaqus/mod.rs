//! The mesh of an .inp file of Abaqus or CalculiX: nodes, elements, sets and surfaces. What else the file says to a
//! solver is left alone.
//!
//! Abaqus Keywords Reference Guide; CalculiX CrunchiX User's Manual, ch. 7.

mod cards;
mod sets;
mod surfaces;
mod types;

use std::collections::HashMap;
use std::path::Path;

use super::raw::{RawGroup, RawMembers, RawMesh};
use super::{MeshProblem, Place, Shape};
use crate::model::words::quoted;
use cards::{Card, Cards, Keyword, number, whole};
use sets::Sets;
use surfaces::Surface;
use types::ElementType;

/// Keywords that make a mesh; one that differs in a letter is taken for a slip of the pen.
const KEYWORDS: [&str; 8] = ["NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "INCLUDE", "PART", "INSTANCE"];

/// Keywords that join nodes to one another. A structure without them is another one, unless the scenario joins them.
const JOINS: [&str; 10] = [
    "TIE",
    "EQUATION",
    "MPC",
    "RIGID BODY",
    "COUPLING",
    "KINEMATIC COUPLING",
    "DISTRIBUTING COUPLING",
    "SHELL TO SOLID COUPLING",
    "EMBEDDED ELEMENT",
    "CYCLIC SYMMETRY MODEL",
];

/// What the data lines that come next belong to.
enum Mode {
    Skip,
    Nodes { set: Option<usize> },
    Elements { kind: ElementType, set: Option<usize> },
    NodeSet { set: usize, generate: bool },
    ElementSet { set: usize, generate: bool },
    Surface { surface: usize },
    Instance,
}

struct Reader<'a> {
    cards: Cards<'a>,
    mesh: RawMesh,
    node_sets: Sets,
    element_sets: Sets,
    surfaces: Vec<Surface>,
    mode: Mode,
    /// An element whose nodes go on in the next line: number, nodes so far, place.
    begun: Option<(u64, Vec<u64>, Place)>,
    parts: usize,
    instances: usize,
    /// Each keyword of [`JOINS`] once, and where it stands first.
    joins: Vec<(&'static str, Place)>,
}

/// Reads a file.
pub fn read(bytes: &[u8], name: &str, folder: Option<&Path>) -> Result<RawMesh, MeshProblem> {
    let mut mesh = RawMesh::new(name, "Abaqus/CalculiX".into());
    mesh.ignores_case = true;
    let mut reader = Reader {
        cards: Cards::new(bytes, name, folder),
        mesh,
        node_sets: Sets::new("the node set"),
        element_sets: Sets::new("the element set"),
        surfaces: Vec::new(),
        mode: Mode::Skip,
        begun: None,
        parts: 0,
        instances: 0,
        joins: Vec::new(),
    };
    let mut has_keyword = false;
    while let Some(card) = reader.cards.next()? {
        match card {
            Card::Keyword(keyword) => {
                has_keyword = true;
                reader.end_of_data()?;
                reader.keyword(&keyword)?;
                reader.mesh.files.clone_from(&reader.cards.files);
            }
            Card::Data { place, .. } if !has_keyword => {
                return Err(reader.cards.problem(
                    place,
                    "expected a keyword like *NODE",
                    "this is not an input file of Abaqus or CalculiX, or its beginning is missing",
                ));
            }
            Card::Data { fields, goes_on, place } => reader.data(&fields, goes_on, place)?,
        }
    }
    if !has_keyword {
        let message = "the file is empty";
        return Err(reader.cards.problem(reader.cards.place, message, "expected a mesh with *NODE and *ELEMENT"));
    }
    reader.end_of_data()?;
    reader.mesh.files.clone_from(&reader.cards.files);
    reader.note_merged();
    reader.note_joins();
    reader.groups()?;
    Ok(reader.mesh)
}

impl Reader<'_> {
    fn end_of_data(&mut self) -> Result<(), MeshProblem> {
        let Some((tag, nodes, place)) = self.begun.take() else { return Ok(()) };
        Err(self.short_element(tag, nodes.len(), place))
    }

    fn short_element(&self, tag: u64, found: usize, place: Place) -> MeshProblem {
        let expected = match &self.mode {
            Mode::Elements { kind, .. } => kind.shape.nodes(),
            _ => 0,
        };
        self.cards.problem(
            place,
            format!("element {tag} has {found} nodes, expected {expected}"),
            "the line is cut off, or the type of the elements is another one",
        )
    }

    /// Notes what is not read, once.
    fn leave_alone(&mut self, what: String) {
        if !self.mesh.skipped.contains(&what) && self.mesh.skipped.len() < 100 {
            self.mesh.skipped.push(what);
        }
    }

    /// Refuses parameters that are misspelled, and notes those that are not known.
    fn parameters(&mut self, keyword: &Keyword) -> Result<(), MeshProblem> {
        let known: &[&str] = match keyword.name.as_str() {
            "NODE" => &["NSET", "INPUT", "SYSTEM"],
            "ELEMENT" => &["TYPE", "ELSET", "INPUT", "FILE", "OFFSET"],
            "NSET" => &["NSET", "GENERATE", "ELSET", "INSTANCE", "INTERNAL", "UNSORTED", "INPUT"],
            "ELSET" => &["ELSET", "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED", "INPUT"],
            "SURFACE" => &["NAME", "TYPE", "COMBINE", "INTERNAL", "DEFINITION"],
            _ => return Ok(()),
        };
        for name in keyword.names().filter(|name| !known.contains(name)) {
            let shown = quoted(name);
            if let Some(meant) = known.iter().find(|known| strsim::osa_distance(known, name) == 1) {
                return Err(self.cards.problem(
                    keyword.place,
                    format!("*{} has no parameter {shown} (did you mean \"{meant}\"?)", keyword.name),
                    "correct the parameter",
                ));
            }
            self.leave_alone(format!("{} of *{}", shown.trim_matches('"'), keyword.name));
        }
        Ok(())
    }

    fn keyword(&mut self, keyword: &Keyword) -> Result<(), MeshProblem> {
        let place = keyword.place;
        self.parameters(keyword)?;
        let refused = |message: &str, help: &str| Err(self.cards.problem(place, message, help));
        let named = |key: &str| {
            keyword.value(key).ok_or_else(|| {
                self.cards.problem(place, format!("*{} without {key}=", keyword.name), format!("add {key}=…"))
            })
        };
        self.mode = match keyword.name.as_str() {
            "NODE" => {
                if keyword.value("SYSTEM").is_some_and(|system| !system.eq_ignore_ascii_case("R")) {
                    return refused(
                        "coordinates that are not rectangular (SYSTEM=) are not read",
                        "write x and y of every node",
                    );
                }
                Mode::Nodes { set: keyword.value("NSET").map(|name| self.node_sets.open(name, place)) }
            }
            "ELEMENT" => {
                let name = named("TYPE")?;
                let kind =
                    ElementType::named(name).map_err(|(message, help)| self.cards.problem(place, message, help))?;
                Mode::Elements { kind, set: keyword.value("ELSET").map(|name| self.element_sets.open(name, place)) }
            }
            "NSET" => {
                let set = self.node_sets.begin(named("NSET")?, place);
                if let Some(elements) = keyword.value("ELSET") {
                    self.node_sets.push_elements(set, elements, place);
                }
                Mode::NodeSet { set, generate: keyword.has("GENERATE") }
            }
            "ELSET" => {
                let set = self.element_sets.begin(named("ELSET")?, place);
                Mode::ElementSet { set, generate: keyword.has("GENERATE") }
            }
            "SURFACE" => self.begin_surface(keyword)?,
            "INCLUDE" => {
                let file = named("INPUT")?.to_owned();
                // Data lines before and after it belong together only within what it includes.
                self.cards.include(&file, place)?;
                return Ok(());
            }
            "PART" => {
                self.parts += 1;
                if self.parts > 1 {
                    return refused(
                        "a second *PART: their numbers repeat one another",
                        "write a file of its own for each part, or an input file without parts and assemblies",
                    );
                }
                Mode::Skip
            }
            "INSTANCE" => {
                self.instances += 1;
                if self.instances > 1 {
                    return refused(
                        "a second *INSTANCE: its numbers are those of the first one",
                        "write a file of its own for each body, or an input file without parts and assemblies",
                    );
                }
                Mode::Instance
            }
            "NGEN" | "NFILL" | "NCOPY" | "NMAP" | "ELGEN" | "ELCOPY" | "SYSTEM" => {
                return refused(
                    &format!("*{} makes or moves nodes or elements and is not read", keyword.name),
                    "write out all nodes and elements, in the coordinates of the model",
                );
            }
            other => {
                if let Some(meant) = KEYWORDS.iter().find(|known| strsim::osa_distance(known, other) == 1) {
                    return refused(
                        &format!("*{} is unknown (did you mean \"*{meant}\"?)", quoted(other).trim_matches('"')),
                        "correct the keyword",
                    );
                }
                let structural = ["HEADING", "END PART", "ASSEMBLY", "END ASSEMBLY", "END INSTANCE", "PREPRINT"];
                if let Some(join) = JOINS.iter().find(|join| **join == other)
                    && self.joins.iter().all(|(known, _)| known != join)
                {
                    self.joins.push((join, place));
                }
                if !structural.contains(&other) {
                    self.leave_alone(format!("*{}", quoted(other).trim_matches('"')));
                }
                Mode::Skip
            }
        };
        if matches!(self.mode, Mode::Skip | Mode::Surface { .. } | Mode::Instance) {
            return Ok(());
        }
        match keyword.value("INPUT") {
            Some(file) => self.cards.include(file, place),
            None => Ok(()),
        }
    }

    fn begin_surface(&mut self, keyword: &Keyword) -> Result<Mode, MeshProblem> {
        let surface = match Surface::begin(keyword, &self.cards)? {
            Ok(surface) => surface,
            Err(other) => {
                self.leave_alone(other);
                return Ok(Mode::Skip);
            }
        };
        if let Some(first) = self.surfaces.iter().find(|known| known.name.eq_ignore_ascii_case(&surface.name)) {
            return Err(self.cards.problem(
                surface.place,
                format!("duplicate surface {}{}", quoted(&surface.name), self.mesh.first_at(first.place)),
                "give each a name of its own; COMBINE=UNION puts surfaces together",
            ));
        }
        self.surfaces.push(surface);
        Ok(Mode::Surface { surface: self.surfaces.len() - 1 })
    }

    fn data(&mut self, fields: &[String], goes_on: bool, place: Place) -> Result<(), MeshProblem> {
        match self.mode {
            Mode::Skip => Ok(()),
            Mode::Nodes { set } => self.node(fields, set, place),
            Mode::Elements { set, .. } => self.element(fields, goes_on, set, place),
            Mode::NodeSet { set, generate } => self.node_sets.read(set, generate, fields, place, &self.cards),
            Mode::ElementSet { set, generate } => self.element_sets.read(set, generate, fields, place, &self.cards),
            Mode::Surface { surface } => {
                self.surfaces[surface].read(fields, place);
                Ok(())
            }
            Mode::Instance if fields.iter().all(|field| number(field) == Some(0.0)) => Ok(()),
            Mode::Instance => Err(self.cards.problem(
                place,
                "an *INSTANCE that is moved or turned is not read",
                "write an input file without parts and assemblies, or give the part its place",
            )),
        }
    }

    fn node(&mut self, fields: &[String], set: Option<usize>, place: Place) -> Result<(), MeshProblem> {
        let wrong = |what: &str, found: &str| {
            self.cards.problem(
                place,
                format!("{what}, found {}", quoted(found)),
                "a node is its number, x and y (and z), with commas between them",
            )
        };
        let Some(tag) = fields.first().and_then(|field| whole(field)) else {
            return Err(wrong("expected the number of a node", fields.first().map_or("", String::as_str)));
        };
        if fields.len() < 3 {
            return Err(wrong(&format!("node {tag} has no x and y"), &fields.join(", ")));
        }
        let mut position = [0.0; 3];
        for ((x, field), axis) in position.iter_mut().zip(&fields[1..]).zip(["x", "y", "z"]) {
            *x = number(field).ok_or_else(|| wrong(&format!("node {tag}: {axis} is not a number"), field))?;
        }
        self.mesh.add_node(tag, position, place)?;
        if let Some(set) = set {
            self.node_sets.push(set, tag, place);
        }
        Ok(())
    }

    fn element(
        &mut self,
        fields: &[String],
        goes_on: bool,
        set: Option<usize>,
        place: Place,
    ) -> Result<(), MeshProblem> {
        let Mode::Elements { kind, .. } = self.mode else { return Ok(()) };
        let mut numbers = Vec::with_capacity(fields.len());
        for field in fields {
            numbers.push(whole(field).ok_or_else(|| {
                self.cards.problem(
                    place,
                    format!("expected the number of an element and those of its nodes, found {}", quoted(field)),
                    "write whole numbers with commas between them",
                )
            })?);
        }
        let (tag, mut nodes, place) = match self.begun.take() {
            Some((tag, mut nodes, first)) => {
                nodes.extend(numbers);
                (tag, nodes, first)
            }
            None => {
                let Some((tag, nodes)) = numbers.split_first() else { return Ok(()) };
                (*tag, nodes.to_vec(), place)
            }
        };
        let expected = kind.shape.nodes();
        if nodes.len() < expected && goes_on {
            self.begun = Some((tag, nodes, place));
            return Ok(());
        }
        if nodes.len() != expected {
            return Err(self.short_element(tag, nodes.len(), place));
        }
        if kind.shape == Shape::Line3 {
            // End, middle, end.
            nodes.swap(1, 2);
        }
        self.mesh.add_element(tag, kind.shape, &nodes, place);
        if kind.is_truss {
            self.mesh.last_is_truss();
        }
        if let Some(set) = set {
            self.element_sets.push(set, tag, place);
        }
        Ok(())
    }

    /// Notes the sets that are written in parts.
    fn note_merged(&mut self) {
        for (sets, what) in [(&self.node_sets, "node set"), (&self.element_sets, "element set")] {
            let Some((name, place, count)) = sets.merged() else { continue };
            let what = match count {
                1 => format!("1 {what} is written in parts, which are put together"),
                _ => format!("{count} {what}s are written in parts, which are put together"),
            };
            self.mesh.notes.push(format!("{what}, the first at {}: {}", self.mesh.line_of(place), quoted(name)));
        }
    }

    /// Notes what joins nodes and was left alone.
    fn note_joins(&mut self) {
        let Some((_, first)) = self.joins.first() else { return };
        let words: Vec<String> = self.joins.iter().map(|(join, _)| format!("*{join}")).collect();
        let (join, is) = if words.len() == 1 { ("joins", "is") } else { ("join", "are") };
        self.mesh.notes.push(format!(
            "{} {join} nodes and {is} not read, the first at {}: where they belong together, say so in the scenario (`ties`, `rigid`)",
            words.join(", "),
            self.mesh.line_of(*first)
        ));
    }

    /// Sets and surfaces as groups.
    fn groups(&mut self) -> Result<(), MeshProblem> {
        let mut element_of: HashMap<u64, u32> = HashMap::new();
        for index in 0..self.mesh.element_count() {
            // Reported here, before sets miss the number that the second one should have had.
            if let Some(first) = element_of.insert(self.mesh.element(index).0, index) {
                return Err(self.mesh.duplicate_element(index, first));
            }
        }
        let mut tags: Vec<u64> = element_of.keys().copied().collect();
        tags.sort_unstable();
        let none = |_: &str, _: Place| Ok(Vec::new());
        let members = sets::Members { sorted: &tags, of_elements: &none };
        let element_sets = self.element_sets.resolved(&members, &self.cards)?;
        let of_elements = |name: &str, place: Place| {
            let Some(set) = self.element_sets.find(name) else {
                let message = format!("the element set {} is not there", quoted(name));
                return Err(self.cards.problem(place, message, "define it, or correct the name"));
            };
            Ok(element_sets[set].iter().flat_map(|tag| self.mesh.element(element_of[tag]).2.to_vec()).collect())
        };
        let mut tags: Vec<u64> = self.mesh.nodes.iter().map(|node| node.tag).collect();
        tags.sort_unstable();
        let members = sets::Members { sorted: &tags, of_elements: &of_elements };
        let node_sets = self.node_sets.resolved(&members, &self.cards)?;
        let mut groups: Vec<RawGroup> = Vec::new();
        let mut push = |name: &str, place: Place, members: RawMembers| {
            groups.push(RawGroup { dimension: 0, number: 0, name: Some(name.to_owned()), members, place });
        };
        for ((name, place), tags) in self.element_sets.names().zip(&element_sets) {
            push(name, place, RawMembers::Elements(tags.iter().map(|tag| element_of[tag]).collect()));
        }
        let found = surfaces::Found {
            mesh: &self.mesh,
            cards: &self.cards,
            element_of: &element_of,
            element_sets: (&self.element_sets, &element_sets),
            node_sets: (&self.node_sets, &node_sets),
        };
        for (surface, members) in self.surfaces.iter().zip(found.members(&self.surfaces)?) {
            push(&surface.name, surface.place, members);
        }
        for ((name, place), tags) in self.node_sets.names().zip(node_sets) {
            push(name, place, RawMembers::NodeSet(tags));
        }
        self.mesh.groups = groups;
        Ok(())
    }
}
