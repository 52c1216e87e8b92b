//! Types of elements by their names in .inp files.

use super::super::Shape;
use crate::model::words::quoted;

/// What a type means here: CPS, CPE and the endings say nothing of the material, which the scenario gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ElementType {
    pub shape: Shape,
    pub is_truss: bool,
}

impl ElementType {
    /// The type of this name.
    ///
    /// # Errors
    /// What it is instead, and what to do.
    pub fn named(name: &str) -> Result<ElementType, (String, &'static str)> {
        let word = name.to_ascii_uppercase();
        let ending_of = |letters: &'static str, ending: &str| ending.chars().all(|c| letters.contains(c));
        let area = word.strip_prefix("CPS").or_else(|| word.strip_prefix("CPE"));
        for (count, shape) in
            [('3', Shape::Triangle3), ('4', Shape::Quad4), ('6', Shape::Triangle6), ('8', Shape::Quad8)]
        {
            if area.and_then(|rest| rest.strip_prefix(count)).is_some_and(|ending| ending_of("RHIM", ending)) {
                return Ok(ElementType { shape, is_truss: false });
            }
        }
        for (count, shape) in [
            ("10", Shape::Tetrahedron10),
            ("20", Shape::Hexahedron20),
            ("4", Shape::Tetrahedron4),
            ("8", Shape::Hexahedron8),
        ] {
            let rest = word.strip_prefix("C3D").and_then(|rest| rest.strip_prefix(count));
            if rest.is_some_and(|ending| ending_of("RHIMS", ending)) {
                return Ok(ElementType { shape, is_truss: false });
            }
        }
        let lines = [
            ("T2D2", Shape::Line2, true),
            ("T3D2", Shape::Line2, true),
            ("T2D3", Shape::Line3, true),
            ("T3D3", Shape::Line3, true),
            ("B21", Shape::Line2, false),
            ("B31", Shape::Line2, false),
            ("B23", Shape::Line2, false),
            ("B33", Shape::Line2, false),
            ("B22", Shape::Line3, false),
            ("B32", Shape::Line3, false),
        ];
        for (known, shape, is_truss) in lines {
            if word.strip_prefix(known).is_some_and(|ending| ending_of("RH", ending)) {
                return Ok(ElementType { shape, is_truss });
            }
        }
        let refused = |what: &str, help| {
            Err((format!("elements of type {} are {what} and not read", quoted(name).trim_matches('"')), help))
        };
        let known = "expected CPS or CPE with 3, 4, 6 or 8 nodes, C3D with 4, 8, 10 or 20, B21 or T2D2";
        if word.starts_with("CAX") || word.starts_with("SAX") || word.starts_with("MAX") {
            refused("axisymmetric", "a structure here is plane: plane strain or plane stress")
        } else if word.starts_with("C3D") || word.starts_with("SC") {
            refused("solids of another shape", "write tetrahedra (C3D4, C3D10) or hexahedra (C3D8, C3D20)")
        } else if word.starts_with("M3D") || word.starts_with('S') && !word.starts_with("SPRING") {
            refused("shells or membranes in space", known)
        } else {
            refused("unknown here", known)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_do_not_matter_and_what_is_not_known_is_refused() {
        for (name, shape) in [
            ("CPS3", Shape::Triangle3),
            ("cpe3h", Shape::Triangle3),
            ("CPS4R", Shape::Quad4),
            ("CPE4IH", Shape::Quad4),
            ("CPS6M", Shape::Triangle6),
            ("CPE8RH", Shape::Quad8),
            ("B21H", Shape::Line2),
            ("T2D2", Shape::Line2),
            ("B22", Shape::Line3),
            ("C3D4", Shape::Tetrahedron4),
            ("C3D10M", Shape::Tetrahedron10),
            ("c3d8i", Shape::Hexahedron8),
            ("C3D20R", Shape::Hexahedron20),
        ] {
            assert_eq!(ElementType::named(name).map(|kind| kind.shape), Ok(shape), "{name}");
        }
        for (name, word) in [
            ("CAX4R", "axisymmetric"),
            ("C3D6", "solids of another shape"),
            ("C3D27", "solids of another shape"),
            ("S4R", "shells"),
            ("CPS", "unknown"),
            ("CPS5", "unknown"),
            ("CPE4P", "unknown"),
            ("CPEG4", "unknown"),
            ("CPSä", "unknown"),
            ("", "unknown"),
            ("SPRINGA", "unknown"),
        ] {
            let (message, _) = ElementType::named(name).expect_err(name);
            assert!(message.contains(word), "{name}: {message}");
        }
    }
}
