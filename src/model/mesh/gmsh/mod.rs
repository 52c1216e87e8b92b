//! Files of Gmsh, versions 2.2 and 4.1, text and binary.
//!
//! Gmsh reference manual, "MSH file format" (4.1) and "MSH file format version 2 (Legacy)".

mod version2;
mod version4;

use std::collections::HashMap;

use super::raw::RawMesh;
use super::source::{Form, Item, Source, shown};
use super::{MeshProblem, Place, Shape};

/// Physical groups and the entities of 4.1 that refer to them.
#[derive(Default)]
struct Groups {
    /// Name and place by dimension and number.
    names: HashMap<(u8, i64), (String, Place)>,
    /// Groups of each entity, by dimension and number of the entity.
    of_entity: HashMap<(u8, i64), Vec<i64>>,
}

/// Reads a file.
pub fn read(bytes: &[u8], name: &str) -> Result<RawMesh, MeshProblem> {
    let mut source = Source::new(bytes, name);
    let version = header(&mut source)?;
    let mut mesh = RawMesh::new(name, format!("Gmsh {version}, {}", form_word(source.form)));
    mesh.repeats_elements = true;
    let mut groups = Groups::default();
    let (mut has_nodes, mut has_elements) = (false, false);
    while let Some(line) = source.text_line() {
        let Some(section) = line.strip_prefix('$') else {
            return Err(source.line_problem(
                "a section like $Nodes",
                line,
                "the section before it has more entries than its count says, or the file is damaged",
            ));
        };
        let twice = match section {
            "Nodes" => std::mem::replace(&mut has_nodes, true),
            "Elements" => std::mem::replace(&mut has_elements, true),
            _ => false,
        };
        if twice {
            return Err(source.problem(format!("a second section ${section}"), "a mesh has one of each: remove one"));
        }
        match (section, version) {
            ("PhysicalNames", _) => physical_names(&mut source, &mut groups)?,
            ("Entities", Version::V4) => version4::entities(&mut source, &mut groups)?,
            ("Nodes", Version::V4) => version4::nodes(&mut source, &mut mesh)?,
            ("Elements", Version::V4) => version4::elements(&mut source, &mut mesh, &groups)?,
            ("Nodes", Version::V2) => version2::nodes(&mut source, &mut mesh)?,
            ("Elements", Version::V2) => version2::elements(&mut source, &mut mesh)?,
            ("Entities", Version::V2) => {
                return Err(source.problem(
                    "the section $Entities belongs to version 4.1 of the mesh format, and $MeshFormat says 2.2"
                        .to_owned(),
                    "save the mesh again, in one of the two versions",
                ));
            }
            ("PartitionedEntities" | "ParametricNodes" | "NOD" | "ELM", _) => {
                return Err(source.problem(
                    format!("the section ${section} is not read"),
                    "save the mesh without partitions and without parametric coordinates",
                ));
            }
            (other, _) => {
                let known = ["Nodes", "Elements", "PhysicalNames", "Entities"];
                if let Some(meant) = known.iter().find(|known| known.eq_ignore_ascii_case(other)) {
                    return Err(source.problem(
                        format!("${} is not a section (did you mean \"${meant}\"?)", printable(other)),
                        "names of sections are spelled with capitals",
                    ));
                }
                source.item = Item::Section("a section that is not read");
                let end = format!("$End{other}");
                if other.starts_with("End") || !source.skip_behind(&end) {
                    return Err(source.problem(
                        format!("the section ${} has no {}", printable(other), printable(&end)),
                        "the file is cut off or damaged: save or copy the mesh again",
                    ));
                }
                mesh.skipped.push(format!("${}", printable(other)));
                continue;
            }
        }
        source.expect_line(&format!("$End{section}"))?;
    }
    for (has, section) in [(has_nodes, "$Nodes"), (has_elements, "$Elements")] {
        if !has {
            return Err(source.problem(
                format!("the file ends without a section {section}"),
                "it is cut off, or holds no mesh: mesh the geometry and save it again",
            ));
        }
    }
    mesh.name_groups(groups.names);
    Ok(mesh)
}

fn printable(word: &str) -> String {
    shown(word.as_bytes()).trim_matches('"').to_owned()
}

#[derive(Clone, Copy, PartialEq)]
enum Version {
    V2,
    V4,
}

impl std::fmt::Display for Version {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Version::V2 => "2.2",
            Version::V4 => "4.1",
        })
    }
}

fn form_word(form: Form) -> &'static str {
    match form {
        Form::Text => "ASCII",
        Form::Binary { .. } => "binary",
    }
}

/// `$MeshFormat`: the version, and whether numbers are binary and in which order of bytes.
fn header(source: &mut Source<'_>) -> Result<Version, MeshProblem> {
    loop {
        match source.text_line() {
            Some("$MeshFormat") => break,
            Some("$Comments") if source.skip_behind("$EndComments") => {}
            Some("$NOD") => return Err(unknown_version(source, "1")),
            Some(line) => {
                return Err(source.line_problem(
                    "$MeshFormat",
                    line,
                    "this is not a mesh of Gmsh, or its beginning is missing",
                ));
            }
            None => {
                return Err(source.problem("the file is empty", "expected a mesh of Gmsh that begins with $MeshFormat"));
            }
        }
    }
    source.item = Item::Section("the mesh format");
    let line = source.text_line().unwrap_or_default();
    let words: Vec<&str> = line.split_whitespace().collect();
    let [version, kind, size] = words[..] else {
        return Err(source.line_problem(
            "version, kind and size of numbers, like `4.1 0 8`",
            line,
            "the file is damaged: save the mesh again",
        ));
    };
    let version = match version.parse::<f64>() {
        Ok(2.2) => Version::V2,
        Ok(4.1) => Version::V4,
        _ => return Err(unknown_version(source, version)),
    };
    if size != "8" {
        return Err(source.problem(
            format!("numbers of {} bytes are not read", printable(size)),
            "save the mesh on a machine of 64 bits, or as ASCII",
        ));
    }
    match kind {
        "0" => {}
        "1" => {
            source.end_text_line();
            source.form = Form::Binary { big_endian: false };
            match source.integer("the number that shows the order of bytes")? {
                1 => {}
                0x0100_0000 => source.form = Form::Binary { big_endian: true },
                other => {
                    return Err(source.problem(
                        format!("the number that shows the order of bytes is {other}, expected 1"),
                        "the file was changed on its way, perhaps by a transfer as text: copy it again",
                    ));
                }
            }
        }
        other => {
            return Err(source.problem(
                format!("the kind of numbers is {}, expected 0 (ASCII) or 1 (binary)", printable(other)),
                "the file is damaged: save the mesh again",
            ));
        }
    }
    source.expect_line("$EndMeshFormat")?;
    Ok(version)
}

fn unknown_version(source: &Source<'_>, found: &str) -> MeshProblem {
    source.problem(
        format!("version {} of the mesh format is not read, but 2.2 and 4.1", printable(found)),
        "save it as one of these: in Gmsh `-format msh41` or `Mesh.MshFileVersion = 2.2`",
    )
}

/// `dimension number "name"`, written out in every file.
fn physical_names(source: &mut Source<'_>, groups: &mut Groups) -> Result<(), MeshProblem> {
    source.item = Item::Section("the names of groups");
    let wrong = |source: &Source<'_>, line: &str| {
        source.line_problem(
            "dimension, number and \"name\" of a group",
            line,
            "correct the line, or save the mesh again",
        )
    };
    let line = source.text_line().unwrap_or_default();
    let Ok(count) = line.parse::<u64>() else {
        return Err(source.line_problem("how many names of groups follow", line, "save the mesh again"));
    };
    let count = source.fits(count, "the number of entries", 6)?;
    for _ in 0..count {
        let line = source.text_line().unwrap_or("the end of the file");
        let (numbers, name) = line.split_once('"').ok_or_else(|| wrong(source, line))?;
        let name = name.strip_suffix('"').ok_or_else(|| wrong(source, line))?;
        let mut numbers = numbers.split_whitespace();
        let dimension = numbers.next().and_then(|word| word.parse::<u8>().ok()).filter(|d| *d <= 3);
        let number = numbers.next().and_then(|word| word.parse::<i64>().ok());
        let (Some(dimension), Some(number), None) = (dimension, number, numbers.next()) else {
            return Err(wrong(source, line));
        };
        // Gmsh writes a name again for a group of partitions.
        let (known, _) =
            groups.names.entry((dimension, number)).or_insert_with(|| (name.to_owned(), source.place())).clone();
        if known != name {
            return Err(source.problem(
                format!("group {number} of dimension {dimension} has two names, \"{known}\" and \"{name}\""),
                "give each group a number of its own, or remove one of the names",
            ));
        }
    }
    Ok(())
}

/// What a type of element is.
enum Kind {
    Point,
    Element(Shape),
}

/// The type of an element by its number in the file.
fn kind_of(source: &Source<'_>, number: i64) -> Result<Kind, MeshProblem> {
    let refused = |what: &str, help: &str| {
        Err(source.problem(format!("{} is {what} (type {number}), which is not read", source.item), help))
    };
    let solids = "solids are meshed with tetrahedra or hexahedra: split it, or mesh again";
    match number {
        15 => Ok(Kind::Point),
        1 => Ok(Kind::Element(Shape::Line2)),
        2 => Ok(Kind::Element(Shape::Triangle3)),
        3 => Ok(Kind::Element(Shape::Quad4)),
        8 => Ok(Kind::Element(Shape::Line3)),
        9 => Ok(Kind::Element(Shape::Triangle6)),
        16 => Ok(Kind::Element(Shape::Quad8)),
        4 => Ok(Kind::Element(Shape::Tetrahedron4)),
        5 => Ok(Kind::Element(Shape::Hexahedron8)),
        11 => Ok(Kind::Element(Shape::Tetrahedron10)),
        17 => Ok(Kind::Element(Shape::Hexahedron20)),
        10 => refused(
            "a quadrilateral of nine nodes",
            "quadrilaterals have 4 or 8 nodes: set `Mesh.SecondOrderIncomplete = 1` in Gmsh",
        ),
        12 => refused(
            "a hexahedron of 27 nodes",
            "hexahedra have 8 or 20 nodes: set `Mesh.SecondOrderIncomplete = 1` in Gmsh",
        ),
        6 | 13 | 18 => refused("a prism", solids),
        7 | 14 | 19 => refused("a pyramid", solids),
        20..=28 | 36 | 37 => {
            refused("of higher order", "elements are linear or quadratic: set `Mesh.ElementOrder = 1` or `2` in Gmsh")
        }
        _ => refused("of an unknown type", "expected lines, areas and solids, linear or quadratic"),
    }
}

/// The nodes of an element as Gmsh lists them, in the order of [`Shape`]: it counts the middles of solids otherwise
/// (reference manual, "Node ordering").
fn in_order(shape: Shape, nodes: &mut [u64]) {
    match shape {
        Shape::Tetrahedron10 => nodes.swap(8, 9),
        Shape::Hexahedron20 => {
            const MIDDLES: [usize; 12] = [8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15];
            let middles = MIDDLES.map(|at| nodes[at]);
            nodes[8..].copy_from_slice(&middles);
        }
        _ => {}
    }
}

/// Dimension of an entity.
fn dimension(source: &Source<'_>, found: i64) -> Result<u8, MeshProblem> {
    u8::try_from(found).ok().filter(|d| *d <= 3).ok_or_else(|| {
        source.problem(
            format!("the dimension of {} is {found}, expected 0 to 3", source.item),
            "correct the file, or save the mesh again",
        )
    })
}
