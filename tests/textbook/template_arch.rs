//! The arch of `new`: its limit load by virtual work over all sets of four hinges.

use std::f64::consts::PI;

use super::templates::{Begun, ROUNDING};

/// The least acceleration (towards +x) at which an arch of rigid blocks turns about four hinges, by virtual work over
/// all of them: joints i < j < k < l from the right, at the inner or the outer edge by turns.
fn four_hinges(blocks: usize, r: f64, t: f64, alpha: f64) -> f64 {
    let step = 2.0 * alpha / blocks as f64;
    let point = |joint: usize, radius: f64| {
        let angle = PI / 2.0 - alpha + joint as f64 * step;
        [radius * angle.cos(), radius * angle.sin()]
    };
    let (inside, outside) = (r - t / 2.0, r + t / 2.0);
    // centroid of a block of four corners, all blocks weigh the same: that of its two triangles
    let centroid = |block: usize| {
        let [a, b, c, d] =
            [point(block, inside), point(block, outside), point(block + 1, outside), point(block + 1, inside)];
        let area = |p: [f64; 2], q: [f64; 2], s: [f64; 2]| {
            ((q[0] - p[0]) * (s[1] - p[1]) - (q[1] - p[1]) * (s[0] - p[0])) / 2.0
        };
        let (first, second) = (area(a, b, c), area(a, c, d));
        [0, 1].map(|i| (first * (a[i] + b[i] + c[i]) + second * (a[i] + c[i] + d[i])) / 3.0 / (first + second))
    };
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let minus = |a: [f64; 2], b: [f64; 2]| [a[0] - b[0], a[1] - b[1]];
    let mut least = f64::INFINITY;
    for i in 0..=blocks {
        for j in i + 1..=blocks {
            for k in j + 1..=blocks {
                for l in k + 1..=blocks {
                    for first in [inside, outside] {
                        let second = inside + outside - first;
                        let [a, b, c, d] = [point(i, first), point(j, second), point(k, first), point(l, second)];
                        let (u, v) = (minus(b, a), minus(d, c));
                        if cross(u, v).abs() < 1e-12 {
                            continue;
                        }
                        // the middle body turns where the lines ab and cd meet
                        let along = cross(minus(c, a), v) / cross(u, v);
                        let centre = [a[0] + along * u[0], a[1] + along * u[1]];
                        // turns of the three bodies: the velocities agree at b and at c
                        let of = |p: [f64; 2], from: [f64; 2], to: [f64; 2], turn: f64| {
                            let (x, y) = (minus(p, from), minus(p, to));
                            let at = if y[0].abs() > y[1].abs() { 0 } else { 1 };
                            turn * x[at] / y[at]
                        };
                        let right = 1.0;
                        let middle = of(b, a, centre, right);
                        let left = of(c, centre, d, middle);
                        let (mut up, mut sideways) = (0.0, 0.0);
                        for (from, to, pole, turn) in [(i, j, a, right), (j, k, centre, middle), (k, l, d, left)] {
                            for block in from..to {
                                let arm = minus(centroid(block), pole);
                                sideways += -turn * arm[1];
                                up += turn * arm[0];
                            }
                        }
                        // joints open on the side away from the hinge, in the one sense of the motion or the other
                        let opens = |turn: f64, hinge: f64| if hinge == inside { turn } else { -turn };
                        let openings = [
                            opens(right, first),
                            opens(middle - right, second),
                            opens(left - middle, first),
                            opens(-left, second),
                        ];
                        for sense in [1.0, -1.0] {
                            if openings.iter().all(|opening| sense * opening > 0.0) && sense * sideways > 0.0 {
                                least = least.min(up / sideways);
                            }
                        }
                    }
                }
            }
        }
    }
    least
}

#[test]
fn arch() {
    for (blocks, r, t, alpha) in [(15, 2.0, 0.3, 90.0), (7, 1.0, 0.25, 90.0), (9, 5.0, 0.6, 60.0), (4, 3.0, 0.9, 75.0)]
    {
        let mut arch = Begun::of("arch", &format!("blocks={blocks} R={r} t={t} alpha={alpha} f=20 g=0"));
        let alpha = f64::to_radians(alpha);
        let weight = f64::from(blocks) * 24.0 * r * t * (2.0 * alpha / f64::from(blocks)).sin();
        let (n, s) = (arch.get("springing"), arch.get("springing_shear"));
        // upwards: n along (-sin, cos) of the springing, s along the normal turned clockwise, (cos, sin)
        let angle = PI / 2.0 - alpha;
        let upwards = n * angle.cos() + s * angle.sin();
        assert!((upwards - weight / 2.0).abs() <= ROUNDING * weight, "{upwards} of {weight}");
        let limit = four_hinges(blocks as usize, r, t, alpha);
        arch.expect("limit quake", limit, 0.0, 1e-6);
    }
}
