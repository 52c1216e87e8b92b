//! The readers against small meshes written by hand.

use super::boundary::{Boundary, EdgeFault};
use super::overview::Overview;
use super::*;

/// Two squares side by side, 0 … 2 × 0 … 1: the left one with a name, the lower lines as an edge in the wrong order.
const MSH2: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 7 \"the base\"
2 9 \"left half\"
$EndPhysicalNames
$Nodes
7
10 0 0 0
20 1 0 0
30 2 0 0
40 0 1 0
50 1 1 0
60 2 1 0
99 5 5 3
$EndNodes
$Elements
6
1 15 2 7 1 10
2 1 2 7 1 30 20
3 1 2 7 1 10 20
4 3 2 9 1 10 20 50 40
5 3 2 9 1 10 20 50 40
8 3 2 0 2 20 50 60 30
$EndElements
";

fn ids(mesh: &Mesh, nodes: &[usize]) -> Vec<u64> {
    nodes.iter().map(|node| mesh.nodes[*node].tag).collect()
}

fn one(problems: Result<Mesh, Vec<MeshProblem>>) -> MeshProblem {
    let mut problems = problems.expect_err("a fault");
    assert_eq!(problems.len(), 1, "{problems:?}");
    problems.remove(0)
}

#[test]
fn gmsh_2() {
    let mesh = read_gmsh(MSH2.as_bytes(), "a.msh").unwrap();
    assert_eq!(mesh.format, "Gmsh 2.2, ASCII");
    // Element 5 is 4 again, 8 was clockwise.
    assert_eq!(mesh.elements.len(), 4);
    assert_eq!(mesh.element(5), mesh.element(4));
    let second = &mesh.elements[mesh.element(8).unwrap() as usize];
    assert_eq!(ids(&mesh, &second.nodes.iter().map(|n| *n as usize).collect::<Vec<_>>()), [20, 30, 60, 50]);
    assert_eq!(mesh.notes, ["1 element runs clockwise and is turned round, the first at a.msh:26: element 8"]);
    let names: Vec<(&str, &str, usize)> =
        mesh.groups.iter().map(|g| (g.name.as_str(), g.members.what(), g.members.count())).collect();
    assert_eq!(names, [("7", "points", 1), ("the base", "lines", 2), ("left half", "elements", 1)]);
    let boundary = Boundary::of(&mesh);
    let edge = boundary.edge(&mesh.groups[1]).unwrap();
    assert_eq!(ids(&mesh, &edge.nodes), [10, 20, 30]);
    assert!(edge.sides.iter().all(|side| !side.reversed));
    let facing: Vec<(&str, Vec<u64>)> =
        boundary.facing().iter().map(|f| (f.name.as_str(), ids(&mesh, &f.piece.nodes))).collect();
    assert_eq!(
        facing,
        [("bottom", vec![10, 20, 30]), ("top", vec![40, 50, 60]), ("left", vec![10, 40]), ("right", vec![30, 60])]
    );
    let overview = Overview::of(&mesh);
    assert_eq!(overview.shapes, [(Shape::Line2, 2), (Shape::Quad4, 2)]);
    assert_eq!((overview.area, overview.unused_nodes), (2.0, 1));
    assert_eq!(overview.groups[1].measure, Some(2.0));
    assert_eq!(overview.extent, [[0.0; 3], [2.0, 1.0, 0.0]]);
}

/// The same bytes as text and as numbers in both orders say the same.
#[test]
fn binary_files_are_read_in_both_orders() {
    for swap in [false, true] {
        let int = |x: i32| if swap { x.to_be_bytes() } else { x.to_le_bytes() };
        let double = |x: f64| if swap { x.to_be_bytes() } else { x.to_le_bytes() };
        let size = |x: u64| if swap { x.to_be_bytes() } else { x.to_le_bytes() };
        let nodes = [(1, 0.0, 0.0), (2, 3.0, 0.0), (3, 0.0, 2.0)];
        let head = |version: &str| {
            let mut bytes = format!("$MeshFormat\n{version} 1 8\n").into_bytes();
            bytes.extend(int(1));
            bytes.extend(b"\n$EndMeshFormat\n$PhysicalNames\n1\n2 4 \"T\"\n$EndPhysicalNames\n");
            bytes
        };
        let mut old = head("2.2");
        old.extend(b"$Nodes\n3\n");
        for (tag, x, y) in nodes {
            old.extend(int(tag));
            [x, y, 0.0].into_iter().for_each(|x| old.extend(double(x)));
        }
        old.extend(b"\n$EndNodes\n$Elements\n1\n");
        [2, 1, 2, 17, 4, 1, 1, 2, 3].into_iter().for_each(|x| old.extend(int(x)));
        old.extend(b"\n$EndElements\n");
        let mut new = head("4.1");
        new.extend(b"$Entities\n");
        [0, 0, 1, 0].into_iter().for_each(|x| new.extend(size(x)));
        new.extend(int(5));
        [0.0; 6].into_iter().for_each(|x| new.extend(double(x)));
        new.extend(size(1));
        new.extend(int(4));
        new.extend(size(0));
        new.extend(b"\n$EndEntities\n$Nodes\n");
        [1, 3, 1, 3].into_iter().for_each(|x| new.extend(size(x)));
        [2, 5, 0].into_iter().for_each(|x| new.extend(int(x)));
        new.extend(size(3));
        [1, 2, 3].into_iter().for_each(|x| new.extend(size(x)));
        for (_, x, y) in nodes {
            [x, y, 0.0].into_iter().for_each(|x| new.extend(double(x)));
        }
        new.extend(b"\n$EndNodes\n$Elements\n");
        [1, 1, 17, 17].into_iter().for_each(|x| new.extend(size(x)));
        [2, 5, 2].into_iter().for_each(|x| new.extend(int(x)));
        [1, 17, 1, 2, 3].into_iter().for_each(|x| new.extend(size(x)));
        new.extend(b"\n$EndElements\n");
        for bytes in [old, new] {
            let mesh = read_gmsh(&bytes, "b.msh").unwrap_or_else(|problems| panic!("{problems:?}"));
            assert!(mesh.format.ends_with("binary"));
            assert_eq!(mesh.groups.len(), 1);
            assert_eq!((mesh.groups[0].name.as_str(), mesh.elements[0].tag), ("T", 17));
            assert_eq!(Overview::of(&mesh).area, 3.0);
            // Wherever it is cut off there is one message and nothing else.
            for end in 0..bytes.len() - 1 {
                one(read_gmsh(&bytes[..end], "b.msh"));
            }
        }
    }
}

const INP: &str = "*HEADING
a mesh
** with a comment
*NODE, NSET=All
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 0., 1.
5, 1., 1.
6, 2.d0, 1.E0, 0.
*ELEMENT, TYPE=CPS4R, ELSET=Both
1, 1, 2,
5, 4
2, 2, 3, 6, 5
*ELEMENT, TYPE=T2D2, ELSET=Cable
7, 4, 5
8, 5, 6
*ELSET, ELSET=Right
2
*ELSET, ELSET=Again
RIGHT, 1
*NSET, NSET=Base, GENERATE
1, 3, 1
*NSET, NSET=Foot
base
*SURFACE, NAME=Roof, TYPE=ELEMENT
Both, S3
*SURFACE, NAME=Skin
Both
*SURFACE, NAME=Under, TYPE=NODE
foot
*SURFACE, NAME=One
2, S2
*SOLID SECTION, ELSET=Both, MATERIAL=Steel
*MATERIAL, NAME=Steel
*ELASTIC
210000., 0.3
*STEP
*STATIC
*NODE PRINT, NSET=All
U
*END STEP
";

#[test]
fn abaqus() {
    let mesh = read_abaqus(INP.as_bytes(), "a.inp", None).unwrap_or_else(|problems| panic!("{problems:?}"));
    assert_eq!((mesh.nodes.len(), mesh.elements.len()), (6, 4));
    assert_eq!(mesh.elements[mesh.element(7).unwrap() as usize].line_type, LineType::Truss);
    let boundary = Boundary::of(&mesh);
    let edge = |name: &str| {
        let group = mesh.groups_named(name).find(|group| !matches!(group.members, Members::Areas(_))).expect(name);
        boundary.edge(group).map(|edge| ids(&mesh, &edge.nodes))
    };
    assert_eq!(edge("BASE"), Ok(vec![1, 2, 3]));
    assert_eq!(edge("Foot"), Ok(vec![1, 2, 3]));
    assert_eq!(edge("under"), Ok(vec![1, 2, 3]));
    assert_eq!(edge("roof"), Ok(vec![4, 5, 6]));
    assert_eq!(edge("cable"), Ok(vec![4, 5, 6]));
    assert_eq!(edge("one"), Ok(vec![3, 6]));
    // Closed rings begin and end leftmost, then lowest.
    assert_eq!(edge("skin"), Ok(vec![1, 2, 3, 6, 5, 4, 1]));
    assert_eq!(edge("all"), Ok(vec![1, 2, 3, 6, 5, 4, 1]));
    let areas = |name: &str| mesh.groups_named(name).map(|group| group.members.count()).sum::<usize>();
    assert_eq!((areas("both"), areas("again"), areas("right")), (2, 2, 1));
    assert!(mesh.skipped.contains(&"*ELASTIC".to_owned()) && !mesh.skipped.contains(&"*HEADING".to_owned()));
}

/// A set that is begun once more goes on; a surface has its name alone.
#[test]
fn sets_in_parts_are_one_set_and_surfaces_are_not() {
    let inp = "*NODE, NSET=N\n1, 0, 0\n2, 1, 0\n*NODE, NSET=N\n3, 1, 1\n4, 0, 1\n\
        *ELEMENT, TYPE=CPS4\n1, 1, 2, 3, 4\n*NSET, NSET=foot\n1\n*NSET, NSET=other\n4\n*NSET, NSET=Foot\n2\n";
    let mesh = read_abaqus(inp.as_bytes(), "a.inp", None).unwrap_or_else(|problems| panic!("{problems:?}"));
    let foot = mesh.groups_named("foot").next().unwrap();
    let edge = Boundary::of(&mesh).edge(foot).unwrap();
    assert_eq!(ids(&mesh, &edge.nodes), [1, 2]);
    assert_eq!(mesh.notes, ["1 node set is written in parts, which are put together, the first at a.inp:13: \"foot\""]);
    let twice = format!("{inp}*SURFACE, NAME=top\n1, S3\n*SURFACE, NAME=TOP\n1, S2\n");
    let problems = read_abaqus(twice.as_bytes(), "a.inp", None).unwrap_err();
    assert!(problems[0].message.contains("duplicate surface \"TOP\", first at a.inp:15"), "{problems:?}");
    assert_eq!(problems[0].line, 17);
}

/// What joins nodes is not read, and told, for without it the structure is another one; what is of the material is not.
#[test]
fn keywords_that_join_nodes_are_told() {
    let inp = "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n*ELEMENT, TYPE=CPS4, ELSET=E\n1, 1, 2, 3, 4\n\
        *ELASTIC\n1, 0\n*Equation\n2\n1, 1, 1, 2, 1, -1\n*RIGID BODY, NSET=E, REF NODE=1\n*EQUATION\n2\n3, 1, 1, 4, 1, -1\n";
    let mesh = read_abaqus(inp.as_bytes(), "a.inp", None).unwrap_or_else(|problems| panic!("{problems:?}"));
    let [note] = mesh.notes.as_slice() else { panic!("{:?}", mesh.notes) };
    assert!(note.starts_with("*EQUATION, *RIGID BODY join nodes and are not read, the first at a.inp:10: "), "{note}");
}

#[test]
fn lines_in_pieces_and_inside_are_no_edge() {
    let apart = MSH2.replace("3 1 2 7 1 10 20", "3 1 2 7 1 40 50");
    let mesh = read_gmsh(apart.as_bytes(), "a.msh").unwrap();
    let boundary = Boundary::of(&mesh);
    let fault = boundary.edge(&mesh.groups[1]).unwrap_err();
    assert!(matches!(fault, EdgeFault::Pieces(2, _)), "{fault:?}");
    let inside = MSH2.replace("3 1 2 7 1 10 20", "3 1 2 7 1 50 20");
    let mesh = read_gmsh(inside.as_bytes(), "a.msh").unwrap();
    let boundary = Boundary::of(&mesh);
    let fault = boundary.edge(&mesh.groups[1]).unwrap_err();
    assert_eq!(
        boundary.words(&mesh.groups[1], &fault).0,
        "the group \"the base\" (a.msh:6) lies inside a body: its line 3 (a.msh:23) has elements on both sides"
    );
}
