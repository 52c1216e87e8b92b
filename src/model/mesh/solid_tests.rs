//! Meshes of solids, written out by the formats' own rules.

use super::overview::Overview;
use super::surface::{FaceFault, Surface};
use super::*;
use crate::model::shape_functions::SolidShape;
use crate::model::structure::Node;

/// Two cubes side by side along x, 0 … 2 × 0 … 1 × 0 … 1, nodes from 1 by x, y, z; the second is inside out, its upper
/// corners first.
const CUBES: [[u64; 8]; 2] = [[1, 2, 5, 4, 7, 8, 11, 10], [8, 9, 12, 11, 2, 3, 6, 5]];

fn places() -> impl Iterator<Item = (u64, [u64; 3])> {
    (0..12).map(|k| (k + 1, [k % 3, k / 3 % 2, k / 6]))
}

fn listed(numbers: &[u64], between: &str) -> String {
    numbers.iter().map(u64::to_string).collect::<Vec<_>>().join(between)
}

/// Version 2.2: the foot as quadrilaterals, the wall between the cubes, a quadrilateral across one, the left cube.
fn gmsh2() -> String {
    let mut text =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n2 1 \"foot\"\n2 2 \"wall\"\n2 3 \"across\"\n\
                    3 4 \"left one\"\n$EndPhysicalNames\n$Nodes\n12\n"
            .to_owned();
    places().for_each(|(tag, at)| text += &format!("{tag} {}\n", listed(&at, " ")));
    text += "$EndNodes\n$Elements\n6\n1 3 2 1 1 1 2 5 4\n2 3 2 1 1 2 3 6 5\n3 3 2 2 1 2 5 11 8\n4 3 2 3 1 1 5 11 7\n";
    text += &format!("5 5 2 4 1 {}\n6 5 2 0 1 {}\n$EndElements\n", listed(&CUBES[0], " "), listed(&CUBES[1], " "));
    text
}

fn near(found: &[f64], right: &[f64]) {
    assert!(
        found.len() == right.len() && std::iter::zip(found, right).all(|(a, b)| (a - b).abs() < 1e-14),
        "{found:?}"
    );
}

fn tags(mesh: &Mesh, nodes: &[usize]) -> Vec<u64> {
    nodes.iter().map(|node| mesh.nodes[*node].tag).collect()
}

fn read_or_panic(found: Result<Mesh, Vec<MeshProblem>>) -> Mesh {
    found.unwrap_or_else(|problems| panic!("{problems:?}"))
}

#[test]
fn groups_of_areas_are_faces() {
    let mesh = read_or_panic(read_gmsh(gmsh2().as_bytes(), "a.msh"));
    assert!(mesh.is_solid() && mesh.of_bodies().count() == 2);
    assert_eq!(mesh.notes, ["1 element is inside out and is turned round, the first at a.msh:33: element 6"]);
    let surface = Surface::of(&mesh);
    let group = |name: &'static str| mesh.groups_named(name).next().expect(name);
    let foot = surface.face(group("foot")).unwrap();
    assert_eq!(tags(&mesh, &foot.nodes), [1, 2, 3, 4, 5, 6]);
    // Sides run counter-clockwise as seen from outside, here from below, and know their solids.
    let places: Vec<Node> = mesh.nodes.iter().map(|n| Node { id: String::new(), position: n.position }).collect();
    near(&foot.vector_area(&places), &[0.0, 0.0, -2.0]);
    let elements: Vec<u64> = foot.sides.iter().map(|side| mesh.elements[side.element].tag).collect();
    assert_eq!(elements, [5, 6]);
    assert!(matches!(surface.face(group("wall")), Err(FaceFault::Inside(_))));
    assert!(matches!(surface.face(group("across")), Err(FaceFault::NoSide(_))));
    assert!(matches!(surface.face(group("left one")), Err(FaceFault::NoFace)));
    let (words, _) = surface.words(group("wall"), &FaceFault::Inside(vec![1, 4]));
    assert!(words.contains("lies inside a body") && words.contains("a.msh:7"), "{words}");
    let facing: Vec<(&str, usize, f64)> = surface
        .facing()
        .iter()
        .map(|facing| (facing.name.as_str(), facing.piece.nodes.len(), facing.piece.area(&places).round()))
        .collect();
    facing.iter().zip(surface.facing()).for_each(|((.., area), facing)| near(&[facing.piece.area(&places)], &[*area]));
    let right =
        [("bottom", 6, 2.0), ("top", 6, 2.0), ("left", 4, 1.0), ("right", 4, 1.0), ("front", 6, 2.0), ("back", 6, 2.0)];
    assert_eq!(facing, right);
    let overview = Overview::of(&mesh);
    near(&[overview.volume.unwrap(), overview.area], &[2.0, 10.0]);
    assert_eq!(overview.shapes, [(Shape::Quad4, 4), (Shape::Hexahedron8, 2)]);
    assert_eq!(overview.extent, [[0.0; 3], [2.0, 1.0, 1.0]]);
    let groups: Vec<(u8, Option<f64>, Option<&str>)> = overview
        .groups
        .iter()
        .map(|group| (group.dimension, group.measure.map(f64::round), group.fault.as_deref()))
        .collect();
    let none = |fault| (2, None, Some(fault));
    assert_eq!(groups, [(2, Some(2.0), None), none("inside a body"), none("no sides of solids"), (3, Some(1.0), None)]);
}

/// A second block apart from the first: pieces of one direction are numbered from left to right.
#[test]
fn pieces_by_direction() {
    let mut text = gmsh2().replace("$Nodes\n12\n", "$Nodes\n20\n").replace("$Elements\n6\n", "$Elements\n7\n");
    let mut more = String::new();
    for (k, [x, y, z]) in
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]].iter().enumerate()
    {
        more += &format!("{} {} {y} {z}\n", 21 + k, x - 9);
    }
    text = text.replace("$EndNodes", &(more + "$EndNodes"));
    text = text.replace("$EndElements", "7 5 2 0 1 21 22 23 24 25 26 27 28\n$EndElements");
    let mesh = read_or_panic(read_gmsh(text.as_bytes(), "a.msh"));
    let surface = Surface::of(&mesh);
    let names: Vec<&str> = surface.facing().iter().map(|facing| facing.name.as_str()).collect();
    assert_eq!(names[..4], ["bottom1", "bottom2", "top1", "top2"]);
    assert_eq!(tags(&mesh, &surface.facing()[0].piece.nodes), [21, 22, 23, 24]);
}

/// Surfaces and node sets of .inp files; faces of the element that was turned keep what they are.
#[test]
fn surfaces_of_abaqus() {
    let mut text = "*NODE\n".to_owned();
    places().for_each(|(tag, at)| text += &format!("{tag}, {}\n", listed(&at, ", ")));
    text += "*ELEMENT, TYPE=C3D8R, ELSET=EALL\n";
    for (tag, cube) in CUBES.iter().enumerate() {
        text += &format!("{}, {}\n", tag + 1, listed(cube, ", "));
    }
    text += "*NSET, NSET=BASE, GENERATE\n1, 6\n*SURFACE, NAME=ROOF\n1, S2\n2, S1\n*SURFACE, NAME=FRONT\n1, S3\n2, S3\n\
             *SURFACE, NAME=SKIN\nEALL\n*SURFACE, NAME=CUT\n1, S4\n";
    let mesh = read_or_panic(read_abaqus(text.as_bytes(), "a.inp", None));
    let surface = Surface::of(&mesh);
    let places: Vec<Node> = mesh.nodes.iter().map(|n| Node { id: String::new(), position: n.position }).collect();
    let face = |name: &str| {
        surface.face(mesh.groups_named(name).find(|g| !matches!(g.members, Members::Solids(_))).expect(name))
    };
    near(&face("base").unwrap().vector_area(&places), &[0.0, 0.0, -2.0]);
    near(&face("ROOF").unwrap().vector_area(&places), &[0.0, 0.0, 2.0]);
    near(&face("FRONT").unwrap().vector_area(&places), &[0.0, -2.0, 0.0]);
    near(&[face("SKIN").unwrap().area(&places)], &[10.0]);
    assert!(matches!(face("CUT"), Err(FaceFault::Inside(_))));
    let wrong = text.replace("1, S4", "1, S7");
    let problem = &read_abaqus(wrong.as_bytes(), "a.inp", None).unwrap_err()[0];
    assert!(
        problem.message.contains("names the face \"S7\" of element 1, which is a hexahedron of 8 nodes"),
        "{problem:?}"
    );
    assert_eq!(problem.help, "its faces are S1 to S6");
}

/// Middle nodes in the orders of the formats stand between the right corners: Gmsh's own, and Abaqus's, which is that
/// of the shapes here.
#[test]
fn orders_of_middle_nodes() {
    let gmsh_tetrahedron = [[0, 1], [1, 2], [2, 0], [3, 0], [2, 3], [1, 3]].as_slice();
    let gmsh_hexahedron =
        [[0, 1], [0, 3], [0, 4], [1, 2], [1, 5], [2, 3], [2, 6], [3, 7], [4, 5], [4, 7], [5, 6], [6, 7]].as_slice();
    for (shape, kind, name, gmsh) in
        [(Shape::Tetrahedron10, 11, "C3D10", gmsh_tetrahedron), (Shape::Hexahedron20, 17, "C3D20", gmsh_hexahedron)]
    {
        let parent = SolidShape::of(shape.nodes()).nodes();
        let corners = &parent[..shape.corners()];
        let file = |sides: &[[usize; 2]], in_gmsh: bool| {
            let between = |[a, b]: &[usize; 2]| [0, 1, 2].map(|c| 0.5 * (corners[*a][c] + corners[*b][c]));
            let all: Vec<[f64; 3]> = corners.iter().copied().chain(sides.iter().map(between)).collect();
            let tags: Vec<u64> = (1..=all.len() as u64).collect();
            if in_gmsh {
                let nodes = all.iter().zip(&tags).map(|([x, y, z], tag)| format!("{tag} {x} {y} {z}\n"));
                let (count, nodes) = (all.len(), nodes.collect::<String>());
                let element = format!("1 {kind} 2 0 1 {}", listed(&tags, " "));
                format!(
                    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{count}\n{nodes}$EndNodes\n$Elements\n1\n{element}\n$EndElements\n"
                )
            } else {
                let nodes = all.iter().zip(&tags).map(|([x, y, z], tag)| format!("{tag}, {x}, {y}, {z}\n"));
                // No more than sixteen numbers a line.
                let (first, rest) = tags.split_at(10.min(tags.len()));
                let rest = if rest.is_empty() { String::new() } else { format!(",\n{}", listed(rest, ", ")) };
                format!("*NODE\n{}*ELEMENT, TYPE={name}\n1, {}{rest}\n", nodes.collect::<String>(), listed(first, ", "))
            }
        };
        let meshes = [
            read_gmsh(file(gmsh, true).as_bytes(), "a.msh"),
            read_abaqus(file(shape.sides_of_solid(), false).as_bytes(), "a.inp", None),
        ];
        for mesh in meshes.map(read_or_panic) {
            assert!(mesh.notes.is_empty(), "{:?}", mesh.notes);
            let nodes: Vec<[f64; 3]> =
                mesh.elements[0].nodes.iter().map(|node| mesh.nodes[*node as usize].position).collect();
            assert_eq!(nodes, parent, "{shape:?} {}", mesh.format);
        }
    }
}

#[test]
fn solids_without_volume_and_twice_are_refused() {
    let message = |text: String| read_gmsh(text.as_bytes(), "a.msh").unwrap_err().remove(0).message;
    let flat = gmsh2().replace("5 5 2 4 1 1 2 5 4 7 8 11 10", "5 4 2 4 1 1 2 5 4");
    assert_eq!(message(flat), "element 5 is a tetrahedron of 4 nodes without volume: its corners lie in one plane");
    let folded = gmsh2().replace("1 2 5 4 7 8 11 10", "1 2 4 5 7 8 11 10");
    assert!(message(folded).starts_with("element 5 is folded"), "folded");
    let twice = gmsh2().replace("6 5 2 0 1 8 9 12 11 2 3 6 5", "6 5 2 0 1 2 1 4 5 8 7 10 11");
    let mesh = read_or_panic(read_gmsh(twice.as_bytes(), "a.msh"));
    // Gmsh writes an element again for every group it is in.
    assert_eq!(mesh.of_bodies().count(), 1);
    let prism = gmsh2().replace("5 5 2 4 1 1 2 5 4 7 8 11 10", "5 6 2 4 1 1 2 5 7 8 11");
    assert_eq!(message(prism), "element 5 is a prism (type 6), which is not read");
}
