//! Several pairs at one node in space: the tip of a cantilever between planes of any direction. Every answer is judged in
//! plain arithmetic, from the stiffness of the tip and the laws.
//!
//! ```text
//!     K u = F + Σ (x_n n + x_τ),   K = diag(EA/L, 3EI/L³, 3EI/L³)       z_n = g + n·u ≥ 0 ⟂ x_n ≥ 0
//!     z_τ = u − (n·u) n,   |x_τ| ≤ f x_n,   x_τ = −f x_n z_τ/|z_τ| where z_τ ≠ 0
//! ```

use nalgebra::{Matrix2, Rotation3, Vector2, Vector3};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use stickslip::answer::record::{Answer, State};

use super::guides::{EA, EI, L};
use super::repeated_in_space::{SIDES, guided};
use crate::common::*;

/// EA/L, 3EI/L³, 3EI/L³.
const TIP: [f64; 3] = [EA / L, 3.0 * EI / (L * L * L), 3.0 * EI / (L * L * L)];

/// A plane that the tip may touch.
#[derive(Clone, Debug)]
struct Plane {
    normal: Vector3<f64>,
    /// `None` of a frictionless pair.
    friction: Option<f64>,
    gap: f64,
}

fn tip(planes: &[Plane], force: Vector3<f64>) -> Value {
    let contact = |(i, plane): (usize, &Plane)| {
        let mut contact = json!({ "id": format!("c{i}"), "node": "B", "against": "ground", "gap": plane.gap,
                                  "normal": plane.normal.as_slice() });
        match plane.friction {
            Some(f) => contact["friction"] = f.into(),
            None => contact["law"] = "frictionless".into(),
        }
        contact
    };
    json!({
        "dimension": 3,
        "materials": { "m": { "E": 1, "nu": 0 } },
        "sections": { "s": { "area": EA, "inertia_y": EI, "inertia_z": EI, "torsion": EI } },
        "nodes": { "A": [0, 0, 0], "B": [L, 0, 0] },
        "bars": [{ "id": "AB", "nodes": ["A", "B"], "material": "m", "section": "s", "orientation": [0, 1, 0] }],
        "supports": [{ "at": "A", "fixed": ["x", "y", "z", "rx", "ry", "rz"] }],
        "contacts": planes.iter().enumerate().map(contact).collect::<Vec<_>>(),
        "loads": { "F": { "items": [{ "point": { "at": "B", "force": force.as_slice() } }] } }
    })
}

/// The most by which an answer violates equilibrium or a law, as a share of the forces or of the displacements.
fn violation(answer: &Answer, planes: &[Plane], force: Vector3<f64>) -> f64 {
    let moved = answer.displacements.as_ref().expect("displacements").iter().find(|found| found.node == "B");
    let moved = moved.expect("the tip");
    let u = Vector3::new(moved.ux, moved.uy, moved.space.expect("in space")[0]);
    let size = answer.pairs.iter().map(|pair| pair.x_n).fold(force.norm(), f64::max);
    let length = planes.iter().map(|plane| plane.gap).fold(size / TIP[1], f64::max);
    let mut left = Vector3::from_fn(|c, _| force[c] - TIP[c] * u[c]);
    let mut worst = 0.0_f64;
    for (plane, pair) in planes.iter().zip(&answer.pairs) {
        let n = plane.normal.normalize();
        let [frame_n, t1] = pair.space.expect("in space").frame.expect("a frame").map(Vector3::from);
        let friction = t1 * pair.friction()[0] + frame_n.cross(&t1) * pair.friction()[1];
        left += n * pair.x_n + friction;
        let (opening, bound) = (plane.gap + n.dot(&u), plane.friction.unwrap_or(0.0) * pair.x_n);
        let slip = u - n * n.dot(&u);
        worst = worst.max(-pair.x_n / size).max(-opening / length).max((pair.x_n / size).min(opening / length));
        worst = worst.max((opening - pair.z_n).abs() / length).max((friction.norm() - bound) / size);
        if slip.norm() > 0.0 && plane.friction.is_some() {
            // Against the slip, or no slip at all.
            let against = (friction + slip.normalize() * bound).norm() / size;
            worst = worst.max(against.min(slip.norm() / length));
        }
    }
    worst.max(left.amax() / size)
}

#[track_caller]
fn obeys(planes: &[Plane], force: Vector3<f64>) -> Answer {
    let answer = Case::json(tip(planes, force)).solve(&[]);
    assert!(answer.is_answer(), "{:?} {:?} of {planes:?} under {force}", answer.outcome, answer.failure);
    let violation = violation(&answer, planes, force);
    assert!(violation < 1e-10, "{violation:e} of {planes:?} under {force}");
    answer
}

fn direction(random: &mut ChaCha8Rng) -> Vector3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
        if v.norm() > 0.1 && v.norm() < 1.0 {
            return v.normalize();
        }
    }
}

/// Two or three planes at right angles, at any angle, opposite to one another or nearly parallel; loads that press them and
/// pull along the first near the limit of slip.
#[test]
fn a_tip_between_planes() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for case in 0..200 {
        let first = direction(&mut random);
        let mut normals = vec![first];
        for _ in 0..random.random_range(1..3) {
            let other = direction(&mut random);
            normals.push(match case % 4 {
                0 => (other - first * first.dot(&other)).normalize(),
                1 => -first,
                2 => (first + other * 10f64.powf(random.random_range(-6.0..-1.0))).normalize(),
                _ => other,
            });
        }
        let smooth = random.random_bool(0.3);
        let friction =
            |random: &mut ChaCha8Rng| if smooth { 0.0 } else { [0.0, 0.2, 0.4, 0.8][random.random_range(0..4)] };
        let planes: Vec<Plane> = (normals.iter())
            .map(|&normal| Plane {
                normal,
                friction: Some(friction(&mut random)),
                gap: [0.0, 0.0, 0.01, 0.02][random.random_range(0..4)],
            })
            .collect();
        let pressed: Vector3<f64> = normals.iter().map(|n| -n * random.random_range(0.2..2.0)).sum();
        let along = first.cross(&direction(&mut random)).normalize();
        let pull =
            along * random.random_range(0.8..1.2) * planes[0].friction.unwrap_or(0.0) * first.dot(&pressed).abs();
        obeys(&planes, pressed + pull);
    }
}

/// The shoe under N beside a guide that P presses, pulled by T just below what both hold. While the tip slips aside only,
/// the guide holds T and a part δ of N, x_shoe = N − δ, and x_guide = P − k g1 − s (N − δ):
/// T² + δ² ≤ f² (P − k g1 − s N + s δ)², for some δ up to T² = f² b²/(1 − f² s²), b = P − k g1 − s N.
#[test]
fn a_guide_beside_a_shoe_just_before_slip() {
    let (k, f, s, n, p, g1) = (TIP[1], 0.2, 0.4, 1.5, 2.0, 0.01);
    let b = p - k * g1 - s * n;
    let limit = f * b / f64::sqrt(1.0 - f * f * s * s);
    let case = |t: f64| {
        let [low, up] = SIDES;
        let case = guided(&Rotation3::identity(), &[("shoe", [0.0, 0.0, 1.0], "s", "zero"), low, up]);
        case.solve(&[("f", f), ("s", s), ("N", n), ("P", p), ("T", t)])
    };
    for share in [0.9, 0.98, 0.99, 0.995, 0.999, 0.9999, 0.999_999] {
        let answer = case(share * limit);
        is_answer(&answer);
        let [shoe, low, up] = &answer.pairs[..] else { panic!() };
        assert_eq!((shoe.state, low.state, up.state), (State::Slip, State::Stick, State::Open), "{share}");
        let [along, down] = low.friction()[..] else { panic!() };
        near("held", along, -share * limit, 1e-10, limit);
        near("carried", shoe.x_n + down.abs(), n, 1e-10, n);
        near("pressed", low.x_n, p - k * g1 - s * shoe.x_n, 1e-10, p);
        assert!(along.hypot(down) <= f * low.x_n * (1.0 + 1e-12), "{share}: {along} {down} of {}", f * low.x_n);
    }
    for share in [1.000_001, 1.001, 1.01] {
        let answer = case(share * limit);
        is_answer(&answer);
        assert_eq!(answer.pairs[1].state, State::Slip, "{share}");
    }
}

/// A groove whose sides (0, ±sin d, cos d) hardly differ, under N and a side load P that moves a good part of N from one
/// side to the other: x = (N/cos d ± P/sin d)/2, without friction and as far as no side opens.
#[test]
fn a_shallow_groove_splits_its_load() {
    let n = 1.5;
    for exponent in 1..=8 {
        for (share, friction) in [(0.25, Some(0.0)), (0.25, None), (-0.4, Some(0.0))] {
            let d = 3.0 * 10f64.powi(-exponent);
            let (p, sides) = (share * n * d, [1.0, -1.0]);
            let side = |sign: f64| Plane { normal: Vector3::new(0.0, sign * d.sin(), d.cos()), friction, gap: 0.0 };
            let force = Vector3::new(0.0, -p, -n);
            let answer = obeys(&sides.map(side), force);
            // The 2 × 2 system of both forces from the normals as they stand in the file.
            let [a, b] = sides.map(side).map(|plane| plane.normal);
            let right = Matrix2::new(a.y, b.y, a.z, b.z).lu().solve(&Vector2::new(p, n)).expect("two directions");
            // Rounding of a normal's component turns it by ε, which moves a share ε/d of the load.
            let room = 1e-12 + 16.0 * f64::EPSILON / d;
            near_all(&format!("{d:e} {friction:?}"), &of_pairs(&answer, |pair| pair.x_n), right.as_slice(), room);
            assert!(answer.notes.iter().all(|note| !note.contains("repeat")), "{:?}", answer.notes);
        }
    }
}
