//! Internal forces along a whole bar, exact between its nodes, with their extremes where they are.

use super::record::MemberForces;
use crate::fem::Piece;
pub use crate::model::quantity::Internal;

/// A value and the distance from the start of the bar at which it stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Distance from the start of the bar.
    pub distance: f64,
    /// The force there.
    pub value: f64,
}

/// N, Q and M along a bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    pieces: Vec<Piece>,
}

impl Diagram {
    /// Of the bar with this id; `None` if it has no forces.
    pub fn of(members: &[MemberForces], bar: &str) -> Option<Diagram> {
        let mine = members.iter().filter(|member| member.bar == bar);
        Diagram::along(mine.flat_map(|member| member.pieces.iter().copied()).collect())
    }

    /// Of one element of a bar; distances are those from the start of the bar.
    pub fn of_element(member: &MemberForces) -> Option<Diagram> {
        Diagram::along(member.pieces.clone())
    }

    fn along(pieces: Vec<Piece>) -> Option<Diagram> {
        (!pieces.is_empty()).then_some(Diagram { pieces })
    }

    /// Length of the bar.
    pub fn length(&self) -> f64 {
        self.pieces[self.pieces.len() - 1].range[1]
    }

    /// From its start to its end without a gap; a force on the bar makes a jump between two of them.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The force (of M, M_y and T the moment) at a distance from the start, with the signs of [`EndForces`]; beyond a jump
    /// that stands there, except at the end of the bar.
    ///
    /// [`EndForces`]: super::record::EndForces
    pub fn at(&self, which: Internal, distance: f64) -> Option<f64> {
        let piece = self.pieces.iter().rev().find(|piece| piece.range[0] <= distance)?;
        (distance <= piece.range[1]).then(|| piece.at(distance)[which.index()])
    }

    /// The least and the largest value; the first place of each.
    pub fn extremes(&self, which: Internal) -> [Place; 2] {
        let place = |piece: &Piece, distance: f64| Place { distance, value: piece.at(distance)[which.index()] };
        let first = place(&self.pieces[0], self.pieces[0].range[0]);
        let mut extremes = [first; 2];
        for piece in &self.pieces {
            for distance in piece.candidates(which.index()) {
                let next = place(piece, distance);
                if next.value < extremes[0].value {
                    extremes[0] = next;
                }
                if next.value > extremes[1].value {
                    extremes[1] = next;
                }
            }
        }
        extremes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answer::record::EndForces;

    /// Simple beam of 4 in two elements, q = −3 on all of it and −8 in the middle: R = 10, M(x) = 10 x − 1.5 x²,
    /// 14 at the jump of Q from 4 to −4.
    #[test]
    fn extremes_and_jumps() {
        let member = |element: usize, [n, q, m]: [f64; 3]| MemberForces {
            bar: "b".into(),
            element,
            start: EndForces::default(),
            end: EndForces::default(),
            pieces: vec![Piece {
                range: [2.0 * element as f64, 2.0 * element as f64 + 2.0],
                start: [n, q, m, 0.0, 0.0, 0.0],
                q: [[0.0, -3.0, 0.0]; 2],
            }],
        };
        let members = [member(0, [1.0, 10.0, 0.0]), member(1, [1.0, -4.0, 14.0])];
        let diagram = Diagram::of(&members, "b").unwrap();
        assert_eq!(diagram.length(), 4.0);
        assert_eq!(diagram.extremes(Internal::Moment)[1], Place { distance: 2.0, value: 14.0 });
        assert_eq!(
            diagram.extremes(Internal::Shear),
            [Place { distance: 4.0, value: -10.0 }, Place { distance: 0.0, value: 10.0 }]
        );
        assert_eq!(diagram.extremes(Internal::Axial), [Place { distance: 0.0, value: 1.0 }; 2]);
        assert_eq!(diagram.at(Internal::Moment, 1.0), Some(8.5));
        assert_eq!(diagram.at(Internal::Shear, 2.0), Some(-4.0));
        assert_eq!(diagram.at(Internal::Moment, 4.0), Some(0.0));
        assert_eq!(diagram.at(Internal::Moment, 4.5), None);
        assert_eq!(Diagram::of(&members, "c"), None);
    }
}
