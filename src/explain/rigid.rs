//! Rigid motions: fitted to the displacements of nodes, and in words, in the plane and in space.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use crate::model::structure::{Dimension, Structure};
use crate::model::vector::{cross, dot, length, unit, way};
use crate::text::number::short as number;
use crate::text::words::short;

/// Shares of the largest displacement below which motions are alike.
const ALIKE: f64 = 1e-6;
/// A rotation by which no place of the structure moves otherwise than another by more than this share of the largest
/// displacement is a translation: its axis would lie some 1e4 times the structure away, and where is rounding.
const FAR: f64 = 1e-4;

/// A small rigid motion: displacement of the origin, and rotation vector (right-handed, its length the angle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitted {
    shift: [f64; 3],
    turn: [f64; 3],
}

impl Fitted {
    /// The motion of these nodes; `None` where it is not rigid within `tolerance`, a displacement.
    pub fn of(structure: &Structure, nodes: &[usize], u: &[[f64; 6]], tolerance: f64) -> Option<Fitted> {
        let count = nodes.len() as f64;
        let mean = |read: &dyn Fn(usize) -> [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|c| nodes.iter().map(|&n| read(n)[c]).sum::<f64>() / count)
        };
        let displacement = |n: usize| [u[n][0], u[n][1], u[n][2]];
        let centre = mean(&|n| structure.nodes[n].position);
        let shift = mean(&displacement);
        let arm = |n: usize| way(centre, structure.nodes[n].position);
        let (mut moment, mut inertia) = (Vector3::zeros(), Matrix3::zeros());
        for &n in nodes {
            let a = Vector3::from(arm(n));
            moment += a.cross(&Vector3::from(way(shift, displacement(n))));
            inertia += Matrix3::identity() * a.norm_squared() - a * a.transpose();
        }
        // nodes on a line do not show how they turn about it: their own rotations do
        let own = Vector3::from(mean(&|n| [u[n][3], u[n][4], u[n][5]]));
        let axes = SymmetricEigen::new(inertia);
        let largest = axes.eigenvalues.amax();
        let mut turn = Vector3::zeros();
        for (value, axis) in axes.eigenvalues.iter().zip(axes.eigenvectors.column_iter()) {
            let about = if *value > 1e-12 * largest { axis.dot(&moment) / value } else { axis.dot(&own) };
            turn += axis * about;
        }
        let turn: [f64; 3] = turn.into();
        let is_rigid = |&n: &usize| {
            let turned = cross(turn, arm(n));
            let error: [f64; 3] = std::array::from_fn(|c| displacement(n)[c] - shift[c] - turned[c]);
            length(error) <= tolerance
        };
        let at_origin = cross(turn, centre);
        nodes.iter().all(is_rigid).then(|| Fitted { shift: std::array::from_fn(|c| shift[c] - at_origin[c]), turn })
    }

    /// Whether another motion is the same one, where the largest displacement is `largest` and the structure this wide.
    pub fn is_like(&self, other: &Fitted, extent: f64, largest: f64) -> bool {
        let near = |a: [f64; 3], b: [f64; 3], size: f64| way(a, b).iter().all(|d| d.abs() * size <= ALIKE * largest);
        near(self.shift, other.shift, 1.0) && near(self.turn, other.turn, extent)
    }

    /// What it is; an axis in space is given by its point nearest to `centre`.
    pub fn describe(&self, centre: [f64; 3], extent: f64, largest: f64) -> RigidMotion {
        let angle = length(self.turn);
        if angle * extent <= FAR * largest {
            let at_centre = cross(self.turn, centre);
            return RigidMotion::Translation(std::array::from_fn(|c| self.shift[c] + at_centre[c]));
        }
        let axis = self.turn.map(|entry| entry / angle);
        // u = shift + turn × x is parallel to the axis on it
        let moved = cross(self.turn, centre);
        let at_centre: [f64; 3] = std::array::from_fn(|c| self.shift[c] + moved[c]);
        let away = cross(self.turn, at_centre).map(|entry| entry / (angle * angle));
        let tidy = |value: f64| if value.abs() <= ALIKE * extent { 0.0 } else { value };
        let point = std::array::from_fn(|c| tidy(centre[c] + away[c]));
        let along = dot(at_centre, axis);
        let advance = if along.abs() <= ALIKE * largest { 0.0 } else { along / angle };
        RigidMotion::Rotation { point, turn: self.turn, advance }
    }
}

/// Rigid motion of one part.
#[derive(Clone, Debug, PartialEq)]
pub enum RigidMotion {
    /// All nodes move alike, by this vector.
    Translation([f64; 3]),
    /// Turns about an axis.
    Rotation {
        /// A point of the axis; in the plane the one that stays.
        point: [f64; 3],
        /// Rotation vector, right-handed; in the plane (0, 0, angle), counter-clockwise > 0.
        turn: [f64; 3],
        /// By how much it moves along the axis, per radian.
        advance: f64,
    },
}

impl RigidMotion {
    /// About what it turns: `(2, 0)`; in space `the axis through (2, 0, 1) along +y`.
    pub fn about(dimension: Dimension, point: [f64; 3], turn: [f64; 3], written: fn(f64) -> String) -> String {
        let point = dimension.shown(point.map(written)).join(", ");
        match dimension {
            Dimension::Plane => format!("({point})"),
            Dimension::Space => format!("the axis through ({point}) along {}", direction_word(turn, dimension)),
        }
    }

    /// "rigid translation of `upper` along +x".
    pub fn words(&self, name: &str, dimension: Dimension) -> String {
        match *self {
            RigidMotion::Translation(u) => {
                format!("rigid translation of {name} along {}", direction_word(u, dimension))
            }
            RigidMotion::Rotation { point, turn, advance } => {
                let about = RigidMotion::about(dimension, point, turn, coordinate);
                match dimension {
                    Dimension::Plane => {
                        let sense = if turn[2] > 0.0 { "counter-clockwise" } else { "clockwise" };
                        format!("rotation of {name} about {about}, {sense}")
                    }
                    Dimension::Space if advance == 0.0 => format!("rotation of {name} about {about}"),
                    Dimension::Space => {
                        format!("screw of {name} about {about}, {} along it per radian", short(advance))
                    }
                }
            }
        }
    }
}

/// `+x`, `-y`, `(0.995, 0.0998)`; in space a horizontal one in degrees, `37° from x to y`.
pub fn direction_word(u: [f64; 3], dimension: Dimension) -> String {
    let Some(u) = unit(u) else { return "nothing".to_owned() };
    let u = u.map(|entry| if entry.abs() <= ALIKE { 0.0 } else { entry });
    let along: Vec<usize> = (0..3).filter(|&c| u[c] != 0.0).collect();
    match (&along[..], dimension) {
        (&[c], _) => format!("{}{}", if u[c] > 0.0 { '+' } else { '-' }, ["x", "y", "z"][c]),
        ([0, 1], Dimension::Space) => format!("{}° from x to y", number(u[1].atan2(u[0]).to_degrees())),
        _ => format!("({})", dimension.shown(u.map(short)).join(", ")),
    }
}

fn coordinate(value: f64) -> String {
    if value == 0.0 { "0.0".to_owned() } else { short(value) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::structure::Node;

    fn structure(places: &[[f64; 3]]) -> Structure {
        let nodes = places.iter().map(|&position| Node { id: String::new(), position }).collect();
        Structure { nodes, dimension: Dimension::Space, ..Structure::default() }
    }

    /// u = shift + turn × (x − about) of every node, its rotations with it.
    fn moved(structure: &Structure, shift: [f64; 3], turn: [f64; 3], about: [f64; 3]) -> Vec<[f64; 6]> {
        let of = |node: &Node| {
            let turned = cross(turn, way(about, node.position));
            [shift[0] + turned[0], shift[1] + turned[1], shift[2] + turned[2], turn[0], turn[1], turn[2]]
        };
        structure.nodes.iter().map(of).collect()
    }

    const CUBE: [[f64; 3]; 8] = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 2.0, 0.0],
        [0.0, 2.0, 0.0],
        [0.0, 0.0, 2.0],
        [2.0, 0.0, 2.0],
        [2.0, 2.0, 2.0],
        [0.0, 2.0, 2.0],
    ];

    fn words(places: &[[f64; 3]], shift: [f64; 3], turn: [f64; 3], about: [f64; 3]) -> String {
        let structure = structure(places);
        let u = moved(&structure, shift, turn, about);
        let nodes: Vec<usize> = (0..places.len()).collect();
        let fitted = Fitted::of(&structure, &nodes, &u, 1e-9).unwrap();
        fitted.describe([1.0, 1.0, 1.0], 2.0, 1.0).words("`b`", Dimension::Space)
    }

    /// A cube that slides, turns over an edge, twists, and does both.
    #[test]
    fn motions_of_a_cube_in_words() {
        let o = [0.0; 3];
        assert_eq!(words(&CUBE, [0.0, 0.0, 0.3], o, o), "rigid translation of `b` along +z");
        let (s, c) = 37.0_f64.to_radians().sin_cos();
        assert_eq!(words(&CUBE, [c, s, 0.0], o, o), "rigid translation of `b` along 37° from x to y");
        // over its edge at x = 2: the lower edge stays, the top goes towards +x
        let over = words(&CUBE, o, [0.0, 0.5, 0.0], [2.0, 0.0, 0.0]);
        assert_eq!(over, "rotation of `b` about the axis through (2.0, 1.0, 0.0) along +y");
        let twist = words(&CUBE, o, [0.0, 0.0, -0.5], [1.0, 1.0, 0.0]);
        assert_eq!(twist, "rotation of `b` about the axis through (1.0, 1.0, 1.0) along -z");
        let screw = words(&CUBE, [0.0, 0.0, 0.25], [0.0, 0.0, 0.5], [1.0, 0.5, 0.0]);
        assert_eq!(screw, "screw of `b` about the axis through (1.0, 0.5, 1.0) along +z, 0.5 along it per radian");
    }

    /// Rounding turns a cube of size 2 that slides about an axis some 1e6 away: it slides. One about an axis 200 away turns.
    #[test]
    fn a_rotation_about_an_axis_far_away_is_a_translation() {
        let (s, c) = 30.0_f64.to_radians().sin_cos();
        let about = |away: f64| words(&CUBE, [0.0; 3], [0.0, 0.0, -1.0 / away], [1.0 + away * s, 1.0 - away * c, 0.0]);
        assert_eq!(about(1e6), "rigid translation of `b` along 30° from x to y");
        assert!(about(200.0).starts_with("rotation of `b` about the axis through (101"), "{}", about(200.0));
    }

    /// The nodes of a bar do not show how it turns about itself; its rotations do.
    #[test]
    fn a_bar_turns_about_its_own_axis() {
        let bar = [[0.0, 1.0, 1.0], [2.0, 1.0, 1.0]];
        let spun = words(&bar, [0.0; 3], [0.5, 0.0, 0.0], [0.0, 1.0, 1.0]);
        assert_eq!(spun, "rotation of `b` about the axis through (1.0, 1.0, 1.0) along +x");
    }

    #[test]
    fn what_strains_is_not_rigid() {
        let structure = structure(&CUBE);
        let mut u = moved(&structure, [0.1, 0.2, 0.3], [0.3, -0.2, 0.1], [0.0; 3]);
        let nodes: Vec<usize> = (0..8).collect();
        let fitted = Fitted::of(&structure, &nodes, &u, 1e-12).unwrap();
        assert!((0..3).all(|c| (fitted.turn[c] - [0.3, -0.2, 0.1][c]).abs() < 1e-14));
        assert!((0..3).all(|c| (fitted.shift[c] - [0.1, 0.2, 0.3][c]).abs() < 1e-14));
        u[6][2] += 1e-6;
        assert_eq!(Fitted::of(&structure, &nodes, &u, 1e-9), None);
    }
}
