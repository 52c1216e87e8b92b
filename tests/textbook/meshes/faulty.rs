//! Faulty meshes of every kind: one message each, with the line, the item, what was expected and what to do.

use stickslip::model::mesh::{Members, Mesh, MeshProblem, read_abaqus, read_gmsh};

/// Two squares with their lower and upper lines, version 2.2.
const GMSH2: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 \"bottom\"
1 2 \"top\"
2 3 \"body\"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
$EndNodes
$Elements
6
1 1 2 1 1 1 2
2 1 2 1 1 2 3
3 1 2 2 2 5 4
4 1 2 2 2 6 5
5 3 2 3 1 1 2 5 4
6 3 2 3 1 2 3 6 5
$EndElements
";

/// The same in version 4.1, one curve and one surface.
const GMSH4: &str = "$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 \"bottom\"
2 3 \"body\"
$EndPhysicalNames
$Entities
0 1 1 0
1 0 0 0 2 0 0 1 1 0
1 0 0 0 2 1 0 1 3 1 1
$EndEntities
$Nodes
1 6 1 6
2 1 0 6
1
2
3
4
5
6
0 0 0
1 0 0
2 0 0
0 1 0
1 1 0
2 1 0
$EndNodes
$Elements
2 4 1 4
1 1 1 2
1 1 2
2 2 3
2 1 3 2
3 1 2 5 4
4 2 3 6 5
$EndElements
";

const ABAQUS: &str = "*NODE
1, 0, 0
2, 1, 0
3, 2, 0
4, 0, 1
5, 1, 1
6, 2, 1
*ELEMENT, TYPE=CPS4, ELSET=EALL
1, 1, 2, 5, 4
2, 2, 3, 6, 5
*NSET, NSET=BOT
1, 2, 3
";

/// A triangle of six nodes.
const QUADRATIC: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
6
1 0 0 0
2 2 0 0
3 0 2 0
4 1 0 0
5 1 1 0
6 0 1 0
$EndNodes
$Elements
1
1 9 2 1 1 1 2 3 4 5 6
$EndElements
";

/// The text with the first `from` replaced.
fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from:?} is not there");
    text.replacen(from, to, 1)
}

#[track_caller]
fn expect(text: &str, read: Result<Mesh, Vec<MeshProblem>>, line: usize, message: &str) {
    let problems = read.err().unwrap_or_else(|| panic!("read, expected: {message}\n{text}"));
    assert_eq!(problems.len(), 1, "{problems:?}");
    let problem = &problems[0];
    assert!(problem.message.contains(message), "expected {message}, found {problem:?}");
    assert_eq!(problem.line, line, "{problem:?}");
    assert!(problem.file == "a.msh" || problem.file == "a.inp");
    assert!(!problem.help.is_empty() && problem.message.len() < 250, "{problem:?}");
}

#[test]
fn gmsh_2() {
    for (from, to, line, message) in [
        ("$Nodes\n6\n", "$Nodes\n5\n", 17, "expected $EndNodes after the nodes, found \"6 2 1 0\""),
        ("$Nodes\n6\n", "$Nodes\n7\n", 18, "\"$EndNodes\" comes in the nodes"),
        ("$Nodes\n6\n", "$Nodes\n-3\n", 11, "how many nodes follow, found \"-3\""),
        ("$Nodes\n6\n", "$Nodes\n6.0\n", 11, "how many nodes follow, found \"6.0\""),
        ("$Elements\n6\n", "$Elements\n5\n", 26, "expected $EndElements after the elements"),
        ("$Elements\n6\n", "$Elements\n9\n", 27, "\"$EndElements\" comes in the elements"),
        ("3 2 0 0\n4", "2 2 0 0\n4", 14, "duplicate node 2, first at a.msh:13"),
        ("3 2 0 0\n", "-3 2 0 0\n", 14, "the number of a node is -3"),
        ("3 2 0 0\n", "3 nan 0 0\n", 14, "node 3: x is NaN"),
        ("3 2 0 0\n", "3 1e999 0 0\n", 14, "node 3: x is inf"),
        ("3 2 0 0\n", "3 1e200 0 0\n", 14, "node 3: x is 1e200"),
        ("3 2 0 0\n", "3 2,0 0 0\n", 14, "x of node 3: expected a number, found \"2,0\""),
        ("3 2 0 0\n", "3 2 0\n", 14, "the line ends before z of node 3"),
        ("6 2 1 0\n", "6 2 1 0.5\n", 26, "element 6 lies outside the plane of the mesh: its node 6 has z = 0.5"),
        ("5 1 1 0\n", "5 0.2 0.2 0\n", 25, "element 5 is not convex"),
        ("6 3 2 3 1 2 3 6 5", "5 3 2 3 1 2 3 6 5", 26, "duplicate element 5, first at a.msh:25"),
        ("6 3 2 3 1 2 3 6 5", "6 3 2 3 1 2 3 5 6", 26, "element 6 is a bow tie"),
        ("6 3 2 3 1 2 3 6 5", "6 3 2 3 1 2 3 3 5", 26, "element 6 has node 3 twice"),
        ("6 3 2 3 1 2 3 6 5", "6 3 2 3 1 2 3 6 50", 26, "element 6 names node 50"),
        ("6 3 2 3 1 2 3 6 5", "6 3 2 3 1 2 3 6", 26, "the line ends before the number of a node of element 6"),
        ("6 3 2 3 1 2 3 6 5", "6 3 2 3 1 2 3 6 5 7", 26, "element 6 has one number too many: found \"7\""),
        ("6 3 2 3 1 2 3 6 5", "6 3 -2 3 1 2 3 6 5", 26, "element 6 is said to have -2 tags"),
        ("6 3 2 3 1 2 3 6 5", "6 3 2000000000 3 1 2 3 6 5", 26, "the line ends before a tag of element 6"),
        ("6 3 2 3 1 2 3 6 5", "6 10 2 3 1 2 3 6 5 1 4 1 4 1", 26, "element 6 is a quadrilateral of nine nodes"),
        ("6 3 2 3 1 2 3 6 5", "6 4 2 3 1 2 3 6 5", 26, "element 6 is a tetrahedron"),
        ("6 3 2 3 1 2 3 6 5", "6 26 2 3 1 2 3 6 5", 26, "element 6 is of higher order (type 26)"),
        ("6 3 2 3 1 2 3 6 5", "6 99 2 3 1 2 3 6 5", 26, "element 6 is of an unknown type (type 99)"),
        ("2.2 0 8", "2.1 0 8", 2, "version 2.1 of the mesh format is not read"),
        ("2.2 0 8", "2.2 2 8", 2, "the kind of numbers is 2"),
        ("2.2 0 8", "2.2 0 4", 2, "numbers of 4 bytes"),
        ("1 1 \"bottom\"", "1 1 bottom", 6, "expected dimension, number and \"name\" of a group"),
        ("1 1 \"bottom\"", "7 1 \"bottom\"", 6, "expected dimension, number and \"name\" of a group"),
        ("1 2 \"", "1 1 \"", 7, "group 1 of dimension 1 has two names, \"bottom\" and \""),
        ("$Nodes\n", "$Entities\n0 0 0 0\n$EndEntities\n$Nodes\n", 10, "$Entities belongs to version 4.1"),
        ("$PhysicalNames\n3", "$PhysicalNames\n4", 9, "found \"$EndPhysicalNames\""),
        ("$Nodes\n", "$nodes\n", 10, "$nodes is not a section (did you mean \"$Nodes\"?)"),
        ("$EndElements\n", "", 27, "the file ends in the elements, before $EndElements"),
        ("$EndElements\n", "$EndElements\n$Nodes\n0\n$EndNodes\n", 28, "a second section $Nodes"),
        ("$EndElements\n", "$EndElements\n$NodeData\n0\n", 30, "the section $NodeData has no $EndNodeData"),
        ("$MeshFormat", "hello", 1, "expected $MeshFormat, found \"hello\""),
    ] {
        let text = changed(GMSH2, from, to);
        expect(&text, read_gmsh(text.as_bytes(), "a.msh"), line, message);
    }
    let mut bytes = GMSH2.as_bytes().to_vec();
    let at = GMSH2.find("bottom").expect("a name");
    bytes[at] = 0xf6;
    expect("Latin-1", read_gmsh(&bytes, "a.msh"), 6, "found a line that is not UTF-8");
    let tiny =
        GMSH2.replace(" 1 0\n", " 1e-200 0\n").replace("2 1 0 0", "2 1e-200 0 0").replace("3 2 0 0", "3 2e-200 0 0");
    let tiny = tiny.replace("5 1 1e-200", "5 1e-200 1e-200").replace("6 2 1e-200", "6 2e-200 1e-200");
    expect(&tiny, read_gmsh(tiny.as_bytes(), "a.msh"), 0, "too small to compute with");
    expect("", read_gmsh(b"", "a.msh"), 1, "the file is empty");
    for (from, to) in [("4 1 0 0", "4 1.9 0 0"), ("5 1 1 0", "5 0.1 0.1 0"), ("1 2 3 4 5 6", "1 2 3 5 6 4")] {
        let text = changed(QUADRATIC, from, to);
        expect(&text, read_gmsh(text.as_bytes(), "a.msh"), 15, "element 1 has middle nodes so far from the middle");
    }
}

#[test]
fn gmsh_4() {
    for (from, to, line, message) in [
        ("2 4 1 4\n", "2 -4 1 4\n", 31, "expected a whole number from 0, found \"-4\""),
        ("2 4 1 4\n", "2 9 1 4\n", 37, "5 elements fewer are in the blocks than are said to be in all of them"),
        ("2 4 1 4\n", "2 4000000000 1 4\n", 31, "is said to be 4000000000, but the file has only"),
        ("2 1 3 2\n", "1 1 3 2\n", 35, "element 3 is a quadrilateral of 4 nodes on an entity of dimension 1"),
        ("2 1 3 2\n", "3 1 4 2\n", 36, "element 3 is a tetrahedron"),
        ("1 1 1 2\n1", "1 1 1 1\n1", 34, "the line ends before the number of elements of a block"),
        ("5\n6\n0", "5\n5\n0", 28, "duplicate node 5, first at a.msh:27"),
        ("0 1 0\n", "0 NaN 0\n", 26, "node 4: y is NaN"),
        ("4 2 3 6 5", "4 2 3 6 7", 37, "element 4 names node 7"),
    ] {
        let text = changed(GMSH4, from, to);
        expect(&text, read_gmsh(text.as_bytes(), "a.msh"), line, message);
    }
}

#[test]
fn abaqus() {
    for (from, to, line, message) in [
        ("2, 1, 0", "1, 1, 0", 3, "duplicate node 1, first at a.inp:2"),
        ("2, 1, 0", "-2, 1, 0", 3, "expected the number of a node, found \"-2\""),
        ("2, 1, 0", "2, abc, 0", 3, "node 2: x is not a number, found \"abc\""),
        ("2, 1, 0", "2, nan, 0", 3, "node 2: x is NaN"),
        ("2, 1, 0", "2, 1", 3, "node 2 has no x and y"),
        ("2, 1, 0", "2 1 0", 3, "expected the number of a node, found \"2 1 0\""),
        ("3, 2, 0", "3, 2, 0, 0.5", 10, "element 2 lies outside the plane of the mesh"),
        ("2, 2, 3, 6, 5", "1, 2, 3, 6, 5", 10, "duplicate element 1, first at a.inp:9"),
        ("2, 2, 3, 6, 5", "2, 2, 3, 6", 10, "element 2 has 3 nodes, expected 4"),
        ("2, 2, 3, 6, 5", "2, 2, 3, 6, 5, 1", 10, "element 2 has 5 nodes, expected 4"),
        ("2, 2, 3, 6, 5", "2, 2, 3, 6, 55", 10, "element 2 names node 55"),
        ("2, 2, 3, 6, 5", "2, 2, 3, 5, 6", 10, "element 2 is a bow tie"),
        ("2, 2, 3, 6, 5", "2, 1, 2, 5, 4", 10, "element 2 has the same nodes as element 1"),
        ("TYPE=CPS4", "TYPE=CAX4", 8, "elements of type CAX4 are axisymmetric"),
        ("TYPE=CPS4", "TYPE=C3D6", 8, "elements of type C3D6 are solids of another shape"),
        ("TYPE=CPS4", "TYPE=C3D4", 9, "element 1 is a tetrahedron of 4 nodes without volume"),
        ("TYPE=CPS4", "TYPE=S4R", 8, "elements of type S4R are shells"),
        ("TYPE=CPS4", "TYPE=CPS7", 8, "elements of type CPS7 are unknown"),
        (" TYPE=CPS4,", "", 8, "*ELEMENT without TYPE="),
        ("*ELEMENT", "*ELEMNT", 8, "*ELEMNT is unknown (did you mean \"*ELEMENT\"?)"),
        ("*NODE\n", "*nodes\n", 1, "*NODES is unknown (did you mean \"*NODE\"?)"),
        ("ELSET=EALL", "ELST=EALL", 8, "*ELEMENT has no parameter \"ELST\" (did you mean \"ELSET\"?)"),
        (", ELSET=EALL", ",", 8, "goes on in line 9, which holds no parameter: \"1, 1, 2, 5, 4\""),
        ("1, 2, 3\n", "1, 2, 77\n", 12, "the node set \"BOT\" names 77"),
        ("1, 2, 3\n", "1, 2, TPO\n", 12, "names the set \"TPO\", which is not there"),
        ("1, 2, 3\n", "BOT\n", 12, "the node set \"BOT\" contains itself"),
        ("NSET=BOT\n1, 2, 3", "NSET=BOT, GENERATE\n1, 3, 0", 12, "is generated from \"1, 3, 0\", expected first, last"),
        ("NSET=BOT\n1, 2, 3", "NSET=BOT, GENERATE\n3, 1", 12, "is generated from \"3, 1\""),
        ("NSET=BOT\n1, 2, 3", "NSET=BOT, GENERATE\na, 3", 12, "is generated from \"a, 3\""),
        ("*NSET, NSET=BOT", "*NSET", 11, "*NSET without NSET="),
        ("*NSET, NSET=BOT\n1, 2, 3", "*SURFACE, NAME=S\n1, S5", 12, "the face \"S5\" of element 1"),
        ("*NSET, NSET=BOT\n1, 2, 3", "*SURFACE, NAME=S\nFOO, S1", 12, "the element or element set \"FOO\""),
        ("*NSET, NSET=BOT\n1, 2, 3", "*SURFACE\n1, S1", 11, "*SURFACE without NAME="),
        (
            "*NSET, NSET=BOT\n1, 2, 3",
            "*SURFACE, NAME=S, COMBINE=DIFFERENCE\nA, B",
            11,
            "the surface \"S\" is a \"DIFFERENCE\" of others",
        ),
        ("*NSET, NSET=BOT\n1, 2, 3", "*SURFACE, NAME=S, COMBINE=UNION\nA", 12, "names the surface \"A\""),
        ("*NSET, NSET=BOT\n1, 2, 3", "*NGEN\n1, 3", 11, "*NGEN makes or moves nodes"),
        ("*NSET, NSET=BOT\n1, 2, 3", "*INCLUDE, INPUT=b.inp", 11, "this file cannot include others"),
        ("*NODE\n", "*NODE, SYSTEM=C\n", 1, "coordinates that are not rectangular"),
        ("*NSET, NSET=BOT\n1, 2, 3", "*INSTANCE, NAME=I, PART=A\n1, 0, 0", 12, "*INSTANCE that is moved"),
        ("*NSET, NSET=BOT", "*INSTANCE, NAME=I\n*INSTANCE, NAME=J", 12, "a second *INSTANCE"),
    ] {
        let text = changed(ABAQUS, from, to);
        expect(&text, read_abaqus(text.as_bytes(), "a.inp", None), line, message);
    }
    expect("", read_abaqus(b"", "a.inp", None), 1, "the file is empty");
    expect("hello", read_abaqus(b"hello\n", "a.inp", None), 1, "expected a keyword like *NODE");
}

/// A file that includes itself, also where that is the one that is read.
#[test]
fn a_file_that_includes_itself() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.inp");
    std::fs::write(&file, format!("{ABAQUS}*INCLUDE, INPUT=a.inp\n")).expect("a file");
    let read = stickslip::model::mesh::read(&file, "a.inp");
    expect("a.inp", read, 13, "the file \"a.inp\" includes itself");
}

/// What is unusual, but right.
#[test]
fn what_is_read() {
    let gmsh =
        |text: &str| read_gmsh(text.as_bytes(), "a.msh").unwrap_or_else(|problems| panic!("{problems:?}\n{text}"));
    let abaqus = |text: &str| {
        read_abaqus(text.as_bytes(), "a.inp", None).unwrap_or_else(|problems| panic!("{problems:?}\n{text}"))
    };
    let lines = |mesh: &Mesh, name: &str| {
        let groups: Vec<_> =
            mesh.groups_named(name).map(|group| (group.members.what(), group.members.count())).collect();
        groups
    };
    // Ends of lines of other systems, a mark of UTF-8, unused nodes, names with blanks and of other scripts.
    let windows = GMSH2.replace('\n', "\r\n");
    assert_eq!(lines(&gmsh(&format!("\u{feff}{windows}")), "bottom"), [("lines", 2)]);
    assert_eq!(
        lines(&gmsh(&changed(GMSH2, "\"bottom\"", "\"Böden der Mauer 上\"")), "Böden der Mauer 上"),
        [("lines", 2)]
    );
    // Two numbers of one name and dimension are one group; of two dimensions they are two.
    assert_eq!(lines(&gmsh(&changed(GMSH2, "\"top\"", "\"bottom\"")), "bottom"), [("lines", 4)]);
    assert_eq!(lines(&gmsh(&changed(GMSH2, "\"body\"", "\"bottom\"")), "bottom"), [("lines", 2), ("elements", 2)]);
    // A name without members is not a group, and is remembered.
    let empty = gmsh(&GMSH2.replacen("1 2 \"top\"", "1 9 \"top\"", 1));
    assert!(lines(&empty, "top").is_empty());
    assert_eq!(empty.empty_group("top").map(|place| place.line), Some(7));
    // An element again for every group it is in.
    let twice =
        GMSH2.replace("$Elements\n6", "$Elements\n7").replace("$EndElements", "7 3 2 9 1 1 2 5 4\n$EndElements");
    let twice = gmsh(&twice);
    assert_eq!(twice.elements.len(), 6);
    assert_eq!(lines(&twice, "9"), [("elements", 1)]);
    // Clockwise elements are turned, and it is said.
    let turned = gmsh(&changed(GMSH2, "6 3 2 3 1 2 3 6 5", "6 3 2 3 1 5 6 3 2"));
    assert!(turned.notes[0].contains("turned round, the first at a.msh:26: element 6"), "{:?}", turned.notes);
    // Small letters, exponents of Fortran, comments, keywords over two lines, surfaces put together.
    let small = abaqus(&ABAQUS.to_lowercase());
    assert_eq!(lines(&small, "BOT"), [("nodes", 3)]);
    abaqus(&changed(ABAQUS, "2, 1, 0", "2, 1.D0, 0"));
    abaqus(&ABAQUS.replace("*NSET", "** a comment\n*NSET").replace("CPS4, ELSET", "CPS4,\nELSET"));
    let surfaces = "*SURFACE, NAME=A\n1, S1\n*SURFACE, NAME=B\n2, S1\n*SURFACE, NAME=C, COMBINE=UNION\nA, B\n";
    assert_eq!(lines(&abaqus(&format!("{ABAQUS}{surfaces}")), "c"), [("element sides", 2)]);
    let foreign = abaqus(&format!("{ABAQUS}*SURFACE, NAME=R, TYPE=SEGMENTS\nSTART, 0, 0\n*BOUNDARY\nBOT, 1, 2\n"));
    assert_eq!(foreign.skipped, ["*SURFACE, TYPE=SEGMENTS", "*BOUNDARY"]);
    let empty = abaqus(&format!("{ABAQUS}*NSET, NSET=FAR, GENERATE\n100, 200\n"));
    assert!(empty.empty_group("far").is_some());
    let same = abaqus(&format!("{ABAQUS}*NSET, NSET=EALL\n1\n"));
    assert!(same.groups_named("EALL").any(|group| matches!(group.members, Members::NodeSet(_))));
}
