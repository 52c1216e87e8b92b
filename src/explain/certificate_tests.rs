//! Blocks in space against their closed forms: limits of sliding, twisting and overturning, and blocks that walls confine.

use nalgebra::{DMatrix, Vector3};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::contact::law::PairLaw;

/// Points of a rigid body that touch the ground or walls: position, normal, law.
type Touch = ([f64; 3], [f64; 3], PairLaw);

/// ζ over the joints per unit of the six rigid motions of a body about the origin: normals first, then two tangents a pair.
fn rigid(touches: &[Touch]) -> DMatrix<f64> {
    let m = touches.len();
    let mut rows = DMatrix::zeros(3 * m, 6);
    for (i, (at, normal, _)) in touches.iter().enumerate() {
        let (at, n) = (Vector3::from(*at), Vector3::from(*normal));
        let x = if n.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
        let t1 = (x - n * n.dot(&x)).normalize();
        for (row, direction) in [(i, n), (m + 2 * i, t1), (m + 2 * i + 1, n.cross(&t1))] {
            for k in 0..3 {
                rows[(row, k)] = direction[k];
                rows[(row, 3 + k)] = Vector3::ith(k, 1.0).cross(&at).dot(&direction);
            }
        }
    }
    rows
}

/// What is found for a force on the body and its moment about the origin.
fn search(touches: &[Touch], force: [f64; 3], moment: [f64; 3]) -> CertificateSearch {
    let motions = rigid(touches);
    let m = touches.len();
    let pairs: Vec<ConePair> = (touches.iter().enumerate())
        .map(|(i, (_, _, law))| ConePair { law: *law, tangents: m + 2 * i..m + 2 * i + 2 })
        .collect();
    // Any RF whose resultant is that of the loads: −RF·ζ is their work. Its least norm needs (GᵀG)⁻¹.
    let resultant = DVector::from_iterator(6, force.into_iter().chain(moment));
    let gram = motions.tr_mul(&motions);
    let load = -(&motions * gram.lu().solve(&resultant).expect("six motions"));
    let work = -(motions.tr_mul(&load));
    assert!((&work - &resultant).amax() <= 1e-14 * resultant.amax(), "{work}");
    let load = Load { forces: &load, terms: &load.abs() };
    certify_pairs(
        &pairs,
        &FreeMotions::of_kernel(&motions, &DVector::repeat(motions.nrows(), 1.0)),
        load,
        Instant::now() + BUDGET,
    )
}

fn certified(touches: &[Touch], force: [f64; 3], moment: [f64; 3]) -> bool {
    search(touches, force, moment).certificate.is_some()
}

fn square(f: f64) -> Vec<Touch> {
    let corner = |x: f64, y: f64| ([x, y, 0.0], [0.0, 0.0, 1.0], PairLaw::rubbing(f, 0.0, 0.0));
    vec![corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)]
}

const EXCESSES: [f64; 4] = [1e-2, 1e-4, 1e-6, 1e-8];

/// A block of weight W on a rough plane slides at f W, whichever way it is pushed.
#[test]
fn a_block_slides_at_the_same_force_in_every_direction() {
    let (f, weight) = (0.3, 4.0);
    for degrees in [0.0, 17.0, 45.0, 101.0, 200.0_f64] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let pushed = |share: f64| {
            let push = share * f * weight;
            certified(&square(f), [push * cos, push * sin, -weight], [0.0; 3])
        };
        for excess in EXCESSES {
            assert!(pushed(1.0 + excess), "{degrees} degrees, 1 + {excess:e}");
            assert!(!pushed(1.0 - excess), "{degrees} degrees, 1 - {excess:e}");
        }
    }
}

/// A limit is told at (1 ± 1e-8) of it at every angle, for whatever friction, not only where the push suits the program.
#[test]
fn a_limit_is_as_sharp_at_every_angle() {
    let mut random = ChaCha8Rng::seed_from_u64(31);
    let check = |name: &str, f: f64, at: &dyn Fn(f64) -> bool| {
        assert!(!at(1.0 - 1e-8), "{name}, f = {f}: certified below its limit");
        assert!(at(1.0 + 1e-8), "{name}, f = {f}: not certified beyond it");
    };
    for _ in 0..100 {
        let f = random.random_range(0.1..2.0);
        let weight = random.random_range(0.5..20.0);
        let angle = random.random_range(0.0..std::f64::consts::TAU);
        let (sin, cos) = f64::sin_cos(angle);
        // Pushed at the ground: f W.
        let slides = |share: f64| {
            let push = share * f * weight;
            certified(&square(f), [push * cos, push * sin, -weight], [0.0; 3])
        };
        check(&format!("pushed at {angle}"), f, &slides);
        // Pushed at the height 1 over the edge that the angle looks at: P max(|cos|, |sin|) = W/2.
        let overturns = |share: f64| {
            let push = share * weight * 0.5 / cos.abs().max(sin.abs());
            certified(&square(4.0), [push * cos, push * sin, -weight], [-push * sin, push * cos, 0.0])
        };
        check(&format!("over an edge at {angle}"), 4.0, &overturns);
        // Turned about the middle of three supports at 120°, a third of the weight on each: f W r.
        let radius = random.random_range(0.1..3.0);
        let support = |i: u8| {
            let (sin, cos) = (angle + f64::from(i) * std::f64::consts::TAU / 3.0).sin_cos();
            ([radius * cos, radius * sin, 0.0], [0.0, 0.0, 1.0], PairLaw::rubbing(f, 0.0, 0.0))
        };
        let supports: Vec<Touch> = (0..3).map(support).collect();
        let twists = |share: f64| certified(&supports, [0.0, 0.0, -weight], [0.0, 0.0, share * f * weight * radius]);
        check(&format!("twisted from {angle} at {radius}"), f, &twists);
    }
}

/// Cohesion adds its own: the limit is f W + Σ c.
#[test]
fn cohesion_takes_its_share_in_every_direction() {
    let touches: Vec<Touch> =
        square(0.3).into_iter().map(|(at, n, _)| (at, n, PairLaw::rubbing(0.3, 0.25, 0.0))).collect();
    let limit = 0.3 * 4.0 + 4.0 * 0.25;
    for degrees in [17.0, 80.0_f64] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        for (share, expected) in [(1.0 + 1e-6, true), (1.0 - 1e-6, false)] {
            let push = share * limit;
            let found = search(&touches, [push * cos, push * sin, -4.0], [0.0; 3]).certificate;
            assert_eq!(found.is_some(), expected, "{degrees} degrees, {share}");
            // power − dissipation > 0, and the dissipation is Σ c |ζ_τ|.
            if let Some(found) = found {
                let slip = |i: usize| found.direction[4 + 2 * i].hypot(found.direction[5 + 2 * i]);
                let taken: f64 = (0..4).map(|i| 0.25 * slip(i)).sum();
                assert!((found.dissipation - taken).abs() < 1e-12 && found.power > taken, "{found:?}");
            }
        }
    }
}

/// A ring of N supports, each pressed by W/N at the radius r, turns at the torque f W r.
#[test]
fn a_ring_of_supports_turns_at_its_friction_torque() {
    let (f, weight, radius) = (0.4, 6.0, 0.5);
    for count in [3_u32, 7, 12] {
        let support = |i: u32| {
            let angle = f64::from(i) / f64::from(count) * std::f64::consts::TAU;
            ([radius * angle.cos(), radius * angle.sin(), 0.0], [0.0, 0.0, 1.0], PairLaw::rubbing(f, 0.0, 0.0))
        };
        let ring: Vec<Touch> = (0..count).map(support).collect();
        for excess in EXCESSES {
            let turned = |share: f64| certified(&ring, [0.0, 0.0, -weight], [0.0, 0.0, share * f * weight * radius]);
            assert!(turned(1.0 + excess), "{count} supports, 1 + {excess:e}");
            assert!(!turned(1.0 - excess), "{count} supports, 1 - {excess:e}");
        }
    }
}

/// Pushed at the height h a block of side 1 overturns over an edge at P h = W/2, over a corner (along the diagonal) at
/// P h = W/√2.
#[test]
fn a_tall_block_overturns_over_an_edge_and_over_a_corner() {
    let (weight, height) = (4.0, 1.0);
    for (degrees, limit) in [(0.0_f64, 0.5), (45.0, 0.5_f64.sqrt())] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let pushed = |share: f64| {
            let push = share * limit * weight / height;
            certified(&square(2.0), [push * cos, push * sin, -weight], [-push * sin * height, push * cos * height, 0.0])
        };
        for excess in [1e-2, 1e-4, 1e-6] {
            assert!(pushed(1.0 + excess) && !pushed(1.0 - excess), "{degrees} degrees, {excess:e}");
        }
    }
}

/// Between two walls no motion has room everywhere: without friction there they only guide the block, with friction they
/// can hold it against anything.
#[test]
fn walls_on_both_sides_guide_a_block_or_hold_it() {
    let walls = |law: PairLaw| {
        let mut touches = square(0.3);
        touches.push(([0.0, 0.5, 0.25], [0.0, -1.0, 0.0], law));
        touches.push(([0.0, -0.5, 0.25], [0.0, 1.0, 0.0], law));
        touches
    };
    let force = |share: f64| [share * 0.3 * 4.0, 0.0, -4.0];
    let guided = walls(PairLaw::rubbing(0.0, 0.0, 0.0));
    let found = search(&guided, force(1.01), [0.0; 3]).certificate.expect("it slides");
    assert!(found.exact && found.direction[4] == 0.0 && found.direction[5] == 0.0, "{found:?}");
    assert!(!certified(&guided, force(0.99), [0.0; 3]));
    assert!(!certified(&walls(PairLaw::rubbing(0.5, 0.0, 0.0)), force(10.0), [0.0; 3]));
    // Bilateral guides that known bounds c hold along x, and down as well: max Σ (a + f b), |(a, b)| ≤ c, is Σ c √(1 + f²).
    let mut rails = square(0.3);
    rails.push(([0.0, 0.5, 0.0], [0.0, -1.0, 0.0], PairLaw::bilateral(0.4)));
    rails.push(([0.0, -0.5, 0.0], [0.0, 1.0, 0.0], PairLaw::bilateral(0.4)));
    let pushed = |share: f64| certified(&rails, [share * (0.3 * 4.0 + 0.8 * 0.3_f64.hypot(1.0)), 0.0, -4.0], [0.0; 3]);
    assert!(pushed(1.01) && pushed(1.0 + 1e-6) && !pushed(1.0 - 1e-6) && !pushed(0.99));
}
