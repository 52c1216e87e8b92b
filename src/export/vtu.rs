//! A structure with its results for ParaView and other programs: VTK XML, `UnstructuredGrid`, in plain text, numbers in
//! full precision; `.pvd` collects several states into a series.
//!
//! Points are the nodes, then one for each contact pair, at its node. Cells are the elements, then a vertex for each
//! pair. What does not belong to a point or a cell is 0 there, `contact_state` and `contact_pair` −1.

use std::io::{self, Write};

use crate::answer::record::{PairState, State};
use crate::model::quantity::Internal;
use crate::model::shape::Shape;
use crate::model::structure::{Dimension, Element};
use crate::path::quantity::Field;
use crate::text::printable::xml;

/// Number of a state in the array `contact_state`.
pub fn state_number(state: State) -> i32 {
    match state {
        State::Open => 0,
        State::Stick => 1,
        State::SlipPlus => 2,
        State::SlipMinus => 3,
        State::Closed => 4,
        State::Slip => 5,
    }
}

/// VTK's number of the shape of an element.
fn cell_type(element: &Element) -> u8 {
    match element.shape() {
        Shape::Line2 => 3,
        Shape::Line3 => 21,
        Shape::Triangle3 => 5,
        Shape::Triangle6 => 22,
        Shape::Quad4 => 9,
        Shape::Quad8 => 23,
        Shape::Tetrahedron4 => 10,
        Shape::Tetrahedron10 => 24,
        Shape::Hexahedron8 => 12,
        Shape::Hexahedron20 => 25,
    }
}

/// VTK's number of a single point.
const VERTEX: u8 = 1;

/// −0 is written as 0.
fn put(out: &mut dyn Write, numbers: &[f64]) -> io::Result<()> {
    for (place, number) in numbers.iter().enumerate() {
        write!(out, "{}{:?}", if place > 0 { " " } else { "" }, number + 0.0)?;
    }
    writeln!(out)
}

fn array<const N: usize>(out: &mut dyn Write, name: &str, parts: &[&str], rows: &[[f64; N]]) -> io::Result<()> {
    write!(out, "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"{N}\"")?;
    for (place, part) in parts.iter().enumerate() {
        write!(out, " ComponentName{place}=\"{part}\"")?;
    }
    writeln!(out, " format=\"ascii\">")?;
    rows.iter().try_for_each(|row| put(out, row))?;
    writeln!(out, "</DataArray>")
}

fn integers(out: &mut dyn Write, kind: &str, name: &str, values: impl Iterator<Item = i64>) -> io::Result<()> {
    writeln!(out, "<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">")?;
    for value in values {
        writeln!(out, "{value}")?;
    }
    writeln!(out, "</DataArray>")
}

/// Components of N, Q, M.
const ENDS: [&str; 2] = ["start", "end"];

/// A state as a file.
pub struct Mesh<'a>(pub Field<'a>);

impl Mesh<'_> {
    /// Writes the state.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let (nodes, elements, pairs) = (&self.0.structure.nodes, &self.0.structure.elements, &self.0.structure.pairs);
        writeln!(out, "<?xml version=\"1.0\"?>")?;
        writeln!(out, "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">")?;
        let (points, cells) = (nodes.len() + pairs.len(), elements.len() + pairs.len());
        writeln!(out, "<UnstructuredGrid>\n<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">")?;
        writeln!(out, "<Points>")?;
        array(out, "Points", &[], &self.over_points(|node| nodes[node].position))?;
        writeln!(out, "</Points>\n<Cells>")?;
        let of_pairs = (nodes.len()..points).map(|point| point as i64);
        let corners = elements.iter().flat_map(|element| element.nodes.iter().map(|&node| node as i64));
        integers(out, "Int64", "connectivity", corners.chain(of_pairs))?;
        let counts = elements.iter().map(|element| element.nodes.len()).chain(pairs.iter().map(|_| 1));
        let ends = counts.scan(0, |end, count| {
            *end += count;
            Some(*end as i64)
        });
        integers(out, "Int64", "offsets", ends)?;
        let types = elements.iter().map(cell_type).chain(pairs.iter().map(|_| VERTEX));
        integers(out, "UInt8", "types", types.map(i64::from))?;
        writeln!(out, "</Cells>\n<PointData Vectors=\"displacement\">")?;
        self.write_point_data(out)?;
        writeln!(out, "</PointData>\n<CellData>")?;
        self.write_cell_data(out)?;
        writeln!(out, "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")
    }

    /// A value of every node, and at the place of every pair.
    fn over_points<const N: usize>(&self, value: impl Fn(usize) -> [f64; N]) -> Vec<[f64; N]> {
        let of_pairs = self.0.structure.pairs.iter().map(|pair| pair.at_place(&value));
        (0..self.0.structure.nodes.len()).map(&value).chain(of_pairs).collect()
    }

    /// A value of every pair, `none` at the nodes.
    fn over_pairs<T: Clone>(&self, none: T, value: impl Fn(usize, &PairState) -> T) -> Vec<T> {
        let mut all = vec![none; self.0.structure.nodes.len()];
        all.extend(self.0.pairs.iter().enumerate().map(|(index, state)| value(index, state)));
        all
    }

    fn write_point_data(&self, out: &mut dyn Write) -> io::Result<()> {
        let u = |node: usize| self.0.displacements.get(node).copied().unwrap_or_default();
        array(out, "displacement", &[], &self.over_points(|node| [u(node)[0], u(node)[1], u(node)[2]]))?;
        match self.0.structure.dimension {
            Dimension::Plane => array(out, "rotation", &[], &self.over_points(|node| [u(node)[5]]))?,
            Dimension::Space => {
                array(out, "rotation", &[], &self.over_points(|node| [u(node)[3], u(node)[4], u(node)[5]]))?;
            }
        }
        if !self.0.node_stresses.is_empty() {
            let mut stresses = vec![[0.0; 6]; self.0.structure.nodes.len()];
            for at in &self.0.node_stresses {
                stresses[at.node] = at.stress;
            }
            self.write_stresses(out, &self.over_points(|node| stresses[node]))?;
        }
        let pairs = &self.0.structure.pairs;
        let pair = self.over_pairs(-1, |index, _| index as i64);
        integers(out, "Int32", "contact_pair", pair.into_iter())?;
        let state = self.over_pairs(-1, |_, state| i64::from(state_number(state.state)));
        integers(out, "Int32", "contact_state", state.into_iter())?;
        let along = |index: usize, n: f64, t: Vec<f64>| {
            let (normal, tangential) = (pairs[index].normal, pairs[index].along_tangents(&t));
            std::array::from_fn(|c| n * normal[c] + tangential[c])
        };
        // both act on the node of the pair, the opposite ones on what stands against it
        let force = self.over_pairs([0.0; 3], |index, state| along(index, state.x_n, state.friction()));
        array(out, "contact_force", &[], &force)?;
        let friction = self.over_pairs([0.0; 3], |index, state| along(index, 0.0, state.friction()));
        array(out, "friction_force", &[], &friction)?;
        let slip = self.over_pairs([0.0; 3], |index, state| along(index, 0.0, state.slip()));
        array(out, "slip", &[], &slip)?;
        array(out, "opening", &[], &self.over_pairs([0.0], |_, state| [state.z_n]))
    }

    /// σ_xx, σ_yy, σ_xy, σ_zz in the plane; in space the six in the order of VTK's symmetric tensors.
    fn write_stresses(&self, out: &mut dyn Write, stresses: &[[f64; 6]]) -> io::Result<()> {
        match self.0.structure.dimension {
            Dimension::Plane => {
                let rows: Vec<[f64; 4]> = stresses.iter().map(|s| [s[0], s[1], s[2], s[3]]).collect();
                array(out, "stress", &["xx", "yy", "xy", "zz"], &rows)
            }
            Dimension::Space => {
                let rows: Vec<[f64; 6]> = stresses.iter().map(|s| [s[0], s[1], s[3], s[2], s[4], s[5]]).collect();
                array(out, "stress", &["xx", "yy", "zz", "xy", "yz", "xz"], &rows)
            }
        }
    }

    fn write_cell_data(&self, out: &mut dyn Write) -> io::Result<()> {
        let cells = self.0.structure.elements.len() + self.0.structure.pairs.len();
        if !self.0.element_stresses.is_empty() {
            let mut stresses = vec![[0.0; 6]; cells];
            for of in &self.0.element_stresses {
                stresses[of.element] = of.stress;
            }
            self.write_stresses(out, &stresses)?;
        }
        if self.0.members.is_empty() {
            return Ok(());
        }
        let all = Internal::of(self.0.members.iter().any(|member| member.start.space.is_some()));
        let mut forces = vec![vec![[0.0; 2]; cells]; all.len()];
        let elements = self.0.structure.bars.iter().flat_map(|bar| bar.elements.clone());
        for (element, member) in elements.zip(self.0.members) {
            let ends = member.start.named().into_iter().zip(member.end.named());
            for (of, ((_, start), (_, end))) in forces.iter_mut().zip(ends) {
                of[element] = [start, end];
            }
        }
        for (which, of) in all.iter().zip(&forces) {
            array(out, which.symbol(), &ENDS, of)?;
        }
        Ok(())
    }
}

/// Writes a series: (time, name of its file) of every state.
///
/// # Errors
/// Those of `out`.
pub fn collection(out: &mut dyn Write, states: &[(f64, String)]) -> io::Result<()> {
    writeln!(out, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>")?;
    for (time, file) in states {
        writeln!(out, "<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{}\"/>", xml(file))?;
    }
    writeln!(out, "</Collection>\n</VTKFile>")
}
