//! The friction polygon: the directions in which a pair can slip, and between which friction is interpolated
//! (method §7).
//!
//! ```text
//!   x^k = f x_n + c + d_k·x_τ ≥ 0  ⟂  ζ_k ≥ 0,      z_τ = Σ ζ_k d_k,      k = 0 … K − 1
//! ```
//! K is even and facet k + K/2 is the mirror of facet k, d_(k+K/2) = −d_k. A pair in the plane has K = 2 facets, ±t:
//! x^0 is x⁺, x^1 is x⁻. In space d_0 lies along t1, turned by an angle where the polygon is, and the others follow
//! towards t2.

use std::f64::consts::TAU;

/// The facets of all pairs of a problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polygon {
    /// K.
    facets: u16,
    /// Angle of d_0 from t1 towards t2, radians.
    turn: f64,
}

impl Polygon {
    /// ±t.
    pub const PLANE: Polygon = Polygon { facets: 2, turn: 0.0 };

    /// A regular polygon in space, `facets` even and at least 4; `turn` is the angle of d_0 from t1 towards t2, in
    /// radians.
    pub fn regular(facets: u16, turn: f64) -> Polygon {
        debug_assert!(facets >= 4 && facets.is_multiple_of(2), "a polygon of {facets} facets");
        Polygon { facets, turn }
    }

    /// Angle of d_0 from t1 towards t2, radians.
    pub fn turn(self) -> f64 {
        self.turn
    }

    /// K.
    pub fn facets(self) -> usize {
        usize::from(self.facets)
    }

    /// K/2: the facets that are not mirrors of others.
    pub fn half(self) -> usize {
        self.facets() / 2
    }

    /// Half of a side of the polygon around a circle of radius 1.
    pub fn half_side(self) -> f64 {
        (0.5 * TAU / self.facets() as f64).tan()
    }

    /// d_k: components along t1 and t2. Mirrors are opposite to the last digit.
    pub fn direction(self, facet: usize) -> [f64; 2] {
        if facet >= self.half() {
            return self.direction(facet - self.half()).map(|component| -component);
        }
        // A quarter of the circle is exact, so that facets along t1 and t2 are.
        let quarters = 4 * facet;
        if self.turn == 0.0 && quarters.is_multiple_of(self.facets()) {
            return if quarters == 0 { [1.0, 0.0] } else { [0.0, 1.0] };
        }
        let angle = self.turn + TAU * facet as f64 / self.facets() as f64;
        [angle.cos(), angle.sin()]
    }

    /// ζ_k ≥ 0 of every facet, with Σ ζ_k d_k the slip: > 0 only for the facets next to it.
    pub fn slips(self, slip: [f64; 2]) -> Vec<f64> {
        let mut slips = vec![0.0; self.facets()];
        if self.facets == 2 {
            (slips[0], slips[1]) = (slip[0].max(0.0), (-slip[0]).max(0.0));
            return slips;
        }
        let size = slip[0].hypot(slip[1]);
        if size == 0.0 {
            return slips;
        }
        let dot = |facet: usize| {
            let [a, b] = self.direction(facet);
            a * slip[0] + b * slip[1]
        };
        let nearest = (0..self.facets()).max_by(|&a, &b| dot(a).total_cmp(&dot(b))).unwrap_or_default();
        let [a, b] = self.direction(nearest);
        let across = a * slip[1] - b * slip[0];
        let other = if across > 0.0 { nearest + 1 } else { nearest + self.facets() - 1 } % self.facets();
        // slip = ζ d + ζ' d': ζ' from the part across d, where d × d' = ± sin(2π/K).
        let step = (TAU / self.facets() as f64).sin();
        slips[other] = across.abs() / step;
        let [c, d] = self.direction(other);
        slips[nearest] = (dot(nearest) - slips[other] * (a * c + b * d)).max(0.0);
        slips
    }
}

/// Angle of a tangential vector from t1 towards t2 in degrees, −180 < angle ≤ 180.
pub fn angle([along, across]: [f64; 2]) -> f64 {
    // 0.0 + takes the sign of a zero away: −0 across is no turn to −180°.
    (0.0 + across).atan2(0.0 + along).to_degrees()
}

/// `37°`, `22.5°`: an angle in words.
pub fn degrees(angle: f64) -> String {
    let text = format!("{angle:.1}");
    // an angle that is zero to what is written has no sign
    let text = if text == "-0.0" { "0.0".to_owned() } else { text };
    format!("{}°", text.strip_suffix(".0").unwrap_or(&text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angle_of_zero_has_no_sign() {
        assert_eq!([-1e-9, -0.0, 0.04, -0.06, 180.0].map(degrees), ["0°", "0°", "0°", "-0.1°", "180°"]);
    }

    #[test]
    fn slips_along_facets_sum_up_to_the_slip() {
        for facets in [4, 6, 8, 12, 16] {
            for turn in [0.0, 0.1, 0.4] {
                let polygon = Polygon::regular(facets, turn);
                for degree in 0..360 {
                    let angle = f64::from(degree).to_radians();
                    let slip = [2.5 * angle.cos(), 2.5 * angle.sin()];
                    let slips = polygon.slips(slip);
                    let sum = (0..polygon.facets()).fold([0.0; 2], |sum, facet| {
                        let [a, b] = polygon.direction(facet);
                        [sum[0] + slips[facet] * a, sum[1] + slips[facet] * b]
                    });
                    assert!((sum[0] - slip[0]).hypot(sum[1] - slip[1]) < 1e-14, "{facets} {turn} {degree}: {sum:?}");
                    assert!(slips.iter().all(|slip| *slip >= 0.0));
                    assert!(slips.iter().filter(|slip| **slip > 1e-14).count() <= 2);
                }
            }
        }
    }

    #[test]
    fn a_half_turn_of_the_facets_is_a_mirror() {
        let polygon = Polygon::regular(6, 0.2);
        for facet in 0..3 {
            let ([a, b], [c, d]) = (polygon.direction(facet), polygon.direction(facet + 3));
            assert_eq!([a, b], [-c, -d]);
        }
        assert_eq!(Polygon::regular(8, 0.0).direction(2), [0.0, 1.0]);
        assert_eq!(angle([-1.0, -0.0]), 180.0);
        assert_eq!(angle([0.0, -1.0]), -90.0);
    }
}
