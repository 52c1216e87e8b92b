//! Arrows of loads in characters.

use super::canvas::{Canvas, Stroke};
use super::loads::Arrow;
use crate::view::style::Role;

/// Lengths of arrows in dots, of a tiny one and of the largest of a kind.
const LENGTHS: [f64; 2] = [3.0, 15.0];

/// An arrow in dots: tail, tip.
pub struct Drawn {
    tail: (f64, f64),
    tip: (f64, f64),
    /// `None` where it leads out of the picture or into it.
    direction: Option<(f64, f64)>,
    /// Whether it leads towards the viewer.
    comes: bool,
}

impl Drawn {
    /// The arrow of a load at `at` (dots): from outside to its place, or away from it where it pulls at the very end of
    /// the structure, whose middle and size these are.
    pub fn new(arrow: &Arrow, at: (f64, f64), middle: (f64, f64), extent: f64) -> Drawn {
        let Some((c, s)) = arrow.direction() else {
            return Drawn { tail: at, tip: at, direction: None, comes: arrow.comes };
        };
        // the sign of a node or a pair keeps its character
        let apart = 2.0 * c.abs() + 4.0 * s.abs();
        let outward = (at.0 - middle.0) * c + (at.1 - middle.1) * s;
        let [tail, tip] = arrow.span(outward, extent, LENGTHS, apart);
        let on_line = |distance: f64| (at.0 + distance * c, at.1 + distance * s);
        Drawn { tail: on_line(tail), tip: on_line(tip), direction: Some((c, s)), comes: arrow.comes }
    }

    /// Both ends, tail first, in the picture.
    pub fn ends(&self) -> [(f64, f64); 2] {
        [self.tail, self.tip]
    }

    /// The same cut to what is in view: the end that stands beside its place stays, the other comes nearer. `None` where
    /// that end is out of view.
    pub fn cut(self, is_seen: impl Fn((f64, f64)) -> bool) -> Option<Drawn> {
        let nearer = |fixed: (f64, f64), far: (f64, f64)| {
            let on_line = |share: f64| (fixed.0 + share * (far.0 - fixed.0), fixed.1 + share * (far.1 - fixed.1));
            [1.0, 0.75, 0.5, 0.25, 0.0].into_iter().map(on_line).find(|end| is_seen(*end))
        };
        if is_seen(self.tip) {
            return Some(Drawn { tail: nearer(self.tip, self.tail)?, ..self });
        }
        let tip = nearer(self.tail, self.tip)?;
        Some(Drawn { tip, ..self })
    }

    /// The sign at the tip.
    pub fn sign(&self, ascii: bool) -> char {
        let Some((c, s)) = self.direction else {
            return match (self.comes, ascii) {
                (true, false) => '⊙',
                (false, false) => '⊗',
                (true, true) => '@',
                (false, true) => 'X',
            };
        };
        if ascii {
            return match (c.abs() > s.abs(), c > 0.0, s > 0.0) {
                (true, true, _) => '}',
                (true, false, _) => '{',
                (false, _, true) => 'U',
                (false, _, false) => 'V',
            };
        }
        // eighths of a turn from → on, counter-clockwise
        const SIGNS: [char; 8] = ['→', '↗', '↑', '↖', '←', '↙', '↓', '↘'];
        let eighth = (s.atan2(c) / std::f64::consts::FRAC_PI_4).round().rem_euclid(8.0);
        SIGNS[eighth as usize % 8]
    }

    /// Draws it.
    pub fn draw(&self, canvas: &mut Canvas, ascii: bool) {
        if self.direction.is_some() {
            canvas.draw_under(Role::Accent, vec![Stroke::Line(vec![self.tail, self.tip])]);
        }
        canvas.put(self.tip.0, self.tip.1, self.sign(ascii), Role::Accent);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::structure::Dimension;
    use crate::model::vector::flat;
    use crate::view::plot::loads::LoadKind;
    use crate::view::projection::{Projection, Viewpoint};

    /// A force along the view has no direction in the picture, but a sign and its size.
    #[test]
    fn a_force_along_the_view_is_seen_from_its_end() {
        let from_above = Projection::new(Dimension::Space, Viewpoint::named("XY").unwrap());
        for (force, sign, ascii) in [([0.0, 0.0, -5.0], '⊗', 'X'), ([0.0, 0.0, 5.0], '⊙', '@')] {
            let arrow = Arrow::new(LoadKind::Force, (0.0, 0.0), force, 1, &from_above);
            assert_eq!(arrow.direction(), None);
            let drawn = Drawn::new(&arrow, (0.0, 0.0), (0.0, 0.0), 10.0);
            assert_eq!((drawn.sign(false), drawn.sign(true)), (sign, ascii));
        }
    }

    #[test]
    fn an_arrow_points_along_its_force() {
        for (force, sign, ascii) in
            [([0.0, -1.0], '↓', 'V'), ([1.0, 0.0], '→', '}'), ([-1.0, 1.0], '↖', 'U'), ([-1.0, 0.0], '←', '{')]
        {
            let arrow = Arrow::new(LoadKind::Force, (0.0, 0.0), flat(force), 1, &Projection::PLANE);
            let drawn = Drawn::new(&arrow, (0.0, 0.0), (0.0, 0.0), 10.0);
            assert_eq!((drawn.sign(false), drawn.sign(true)), (sign, ascii));
            let [tail, tip] = drawn.ends();
            assert!((tip.0 - tail.0) * force[0] + (tip.1 - tail.1) * force[1] > 0.0);
        }
    }
}
