//! The state of one pair in a working scheme, and what it asks for as zeros and signs.

use crate::contact::law::PairLaw;
use crate::contact::polygon::Polygon;
use crate::contact::rows::RowId;

/// Tangential joint of a pair: on, or released with the slip along one facet of the friction polygon or between two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Tangential {
    /// z_τ = 0.
    Stick,
    /// x^k = 0, the slip along d_k. In the plane facet 0 is slip +, facet 1 slip −.
    Slip(u16),
    /// In space: x^k = x^(k+1) = 0 at a corner of the polygon, the slip between d_k and d_(k+1).
    Between(u16),
}

/// What the tangential joint of a pair has to fulfil in one of its states.
#[derive(Clone, Debug, PartialEq)]
pub struct Conditions {
    /// Facets whose reserve is zero.
    pub reserves: Vec<usize>,
    /// Forms of the slip ([`slip_forms`]) that are zero.
    pub zero: Vec<usize>,
    /// Forms of the slip with a sign: whether it is ≥ 0, else ≤ 0.
    pub signs: Vec<(usize, bool)>,
}

/// The forms of the slip whose signs tell its direction, as components along the tangents: in the plane z_τ itself, in
/// space d_k × z_τ of the facets that are not mirrors, k < K/2.
pub fn slip_forms(polygon: Polygon) -> Vec<[f64; 2]> {
    if polygon == Polygon::PLANE {
        return vec![polygon.direction(0)];
    }
    let across = |facet| {
        let [along, across] = polygon.direction(facet);
        [0.0 - across, along]
    };
    (0..polygon.half()).map(across).collect()
}

impl Tangential {
    /// Slip along +t in the plane.
    pub const PLUS: Tangential = Tangential::Slip(0);
    /// Slip along −t in the plane.
    pub const MINUS: Tangential = Tangential::Slip(1);

    /// All states on a polygon, stick first.
    pub fn all(polygon: Polygon) -> Vec<Tangential> {
        let facets = 0..polygon.facets() as u16;
        let corners = if polygon == Polygon::PLANE { 0..0 } else { facets.clone() };
        let slips = facets.map(Tangential::Slip).chain(corners.map(Tangential::Between));
        std::iter::once(Tangential::Stick).chain(slips).collect()
    }

    /// The state in which a pair slips along these facets, released in any order: two are neighbours or nothing holds
    /// the pair.
    fn along(facets: &[usize], polygon: Polygon) -> Tangential {
        let count = polygon.facets();
        match *facets {
            [] => Tangential::Stick,
            [facet] => Tangential::Slip(facet as u16),
            [first, second, ..] if (second + 1) % count == first => Tangential::Between(second as u16),
            [first, ..] => Tangential::Between(first as u16),
        }
    }

    /// The facets along which it slips.
    pub fn facets(self, polygon: Polygon) -> Vec<usize> {
        match self {
            Tangential::Stick => Vec::new(),
            Tangential::Slip(facet) => vec![usize::from(facet)],
            Tangential::Between(facet) => vec![usize::from(facet), (usize::from(facet) + 1) % polygon.facets()],
        }
    }

    /// What a slip has to fulfil; of a pair that sticks z_τ = 0 says it all.
    pub fn conditions(self, polygon: Polygon) -> Conditions {
        let reserves = self.facets(polygon);
        let half = polygon.half();
        // d_k × z_τ ≥ 0, as the form of the facet or of its mirror shows.
        let turned = |facet: usize, up: bool| {
            let facet = facet % polygon.facets();
            if facet < half { (facet, up) } else { (facet - half, !up) }
        };
        let (zero, signs) = match (self, polygon == Polygon::PLANE) {
            (Tangential::Stick, _) => (Vec::new(), Vec::new()),
            (Tangential::Slip(facet) | Tangential::Between(facet), true) => (Vec::new(), vec![(0, facet == 0)]),
            (Tangential::Slip(facet), false) => {
                let before = usize::from(facet) + polygon.facets() - 1;
                (vec![turned(usize::from(facet), true).0], vec![turned(before, true)])
            }
            (Tangential::Between(facet), false) => {
                let facet = usize::from(facet);
                (Vec::new(), vec![turned(facet, true), turned(facet + 1, false)])
            }
        };
        Conditions { reserves, zero, signs }
    }

    /// The word of the state of a closed pair in proofs: `stick`, `slip+`, `slip-`, in space `slip^3` along facet 3 and
    /// `slip^3^4` between two.
    pub fn word(self, polygon: Polygon) -> String {
        match (self, polygon == Polygon::PLANE) {
            (Tangential::Stick, _) => "stick".to_owned(),
            (Tangential::Slip(0), true) => "slip+".to_owned(),
            (_, true) => "slip-".to_owned(),
            (_, false) => self.facets(polygon).iter().fold("slip".to_owned(), |word, facet| format!("{word}^{facet}")),
        }
    }
}

/// Joints of a pair. A frictionless pair has no tangential joint: `tangential` is not read. A bound pair is
/// never open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PairScheme {
    /// Normal joint off: x_n = 0, z_n free.
    pub open: bool,
    /// Tangential joint.
    pub tangential: Tangential,
}

impl PairScheme {
    /// Both joints on.
    pub const STICK: PairScheme = PairScheme { open: false, tangential: Tangential::Stick };
    /// Closed, slips along +t.
    pub const SLIP_PLUS: PairScheme = PairScheme { open: false, tangential: Tangential::PLUS };
    /// Closed, slips along −t.
    pub const SLIP_MINUS: PairScheme = PairScheme { open: false, tangential: Tangential::MINUS };
    /// Open, the tangential joint released too: nothing holds the pair.
    pub const OPEN: PairScheme = PairScheme { open: true, tangential: Tangential::PLUS };
    /// Open, held by cohesion.
    pub const OPEN_STICK: PairScheme = PairScheme { open: true, tangential: Tangential::Stick };
}

/// The scheme of every pair where z of these rows is released, in any order.
pub fn schemes_of(rows: impl IntoIterator<Item = RowId>, laws: &[PairLaw], polygon: Polygon) -> Vec<PairScheme> {
    let mut open = vec![false; laws.len()];
    let mut facets: Vec<Vec<usize>> = vec![Vec::new(); laws.len()];
    for row in rows {
        match row.couple.facet() {
            None => open[row.pair] = true,
            Some(facet) => facets[row.pair].push(facet),
        }
    }
    let scheme = |(pair, law): (usize, &PairLaw)| match open[pair] && law.fixed_bound() == 0.0 {
        true => PairScheme::OPEN,
        false => PairScheme { open: open[pair], tangential: Tangential::along(&facets[pair], polygon) },
    };
    laws.iter().enumerate().map(scheme).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The conditions of a state hold for the slips of its facets and fail for all others.
    #[test]
    fn conditions_tell_directions_apart() {
        for (facets, turn) in [(4, 0.0), (6, 0.0), (8, 0.1), (16, 0.3)] {
            let polygon = Polygon::regular(facets, turn);
            let forms = slip_forms(polygon);
            for state in Tangential::all(polygon).into_iter().skip(1) {
                let conditions = state.conditions(polygon);
                let holds = |slip: [f64; 2]| {
                    let value = |form: usize| forms[form][0] * slip[0] + forms[form][1] * slip[1];
                    conditions.zero.iter().all(|form| value(*form).abs() < 1e-12)
                        && conditions
                            .signs
                            .iter()
                            .all(|(form, up)| if *up { value(*form) > 1e-6 } else { value(*form) < -1e-6 })
                };
                for facet in 0..polygon.facets() {
                    let [a, b] = polygon.direction(facet);
                    assert_eq!(holds([a, b]), state == Tangential::Slip(facet as u16), "{state:?} {facet}");
                    let [c, d] = polygon.direction((facet + 1) % polygon.facets());
                    let between = [a + 0.3 * c, b + 0.3 * d];
                    assert_eq!(holds(between), state == Tangential::Between(facet as u16), "{state:?} {facet}");
                }
            }
        }
        assert_eq!(Tangential::along(&[0, 7], Polygon::regular(8, 0.0)), Tangential::Between(7));
        assert_eq!(Tangential::along(&[4, 3], Polygon::regular(8, 0.0)), Tangential::Between(3));
        assert_eq!(Tangential::all(Polygon::PLANE).len(), 3);
    }
}
