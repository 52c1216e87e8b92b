use nalgebra::{DVector, Matrix3, Vector3};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::super::super::bar_load::{PointForce, Span};
use super::super::super::frame::Frame;
use super::*;

const EPS: f64 = f64::EPSILON;
const JOINTS: [EndJoint; 3] = [EndJoint::Rigid, EndJoint::Hinge, EndJoint::Ball];

fn material() -> Material {
    Material { youngs_modulus: 3.0, poisson_ratio: 0.25, density: 0.0, expansion: 0.0 }
}

fn section(shear: bool) -> SpaceSection {
    let shear = |area| shear.then_some(area);
    SpaceSection {
        area: 7.0,
        inertia_y: 2.0,
        inertia_z: 5.0,
        torsion: 1.5,
        shear_area_y: shear(4.0),
        shear_area_z: shear(3.0),
    }
}

fn frame(ends: [[f64; 3]; 2], orientation: Option<[f64; 3]>, shear: bool, joints: [EndJoint; 2]) -> SpaceFrame {
    SpaceFrame::new(ends, orientation, &material(), &section(shear), joints).unwrap()
}

/// Along global x with local y along global z: local z is −y.
fn straight(length: f64, shear: bool, joints: [EndJoint; 2]) -> SpaceFrame {
    frame([[0.0; 3], [length, 0.0, 0.0]], None, shear, joints)
}

fn random_load(random: &mut ChaCha8Rng, length: f64) -> BarLoad {
    let mut number = || random.random_range(-2.0..2.0);
    let mut vector = || [number(), number(), number()];
    let spans = vec![
        Span { range: [0.1 * length, 0.7 * length], force: [vector(), vector()] },
        Span { range: [0.0, length], force: [vector(), vector()] },
    ];
    let points = [0.35, 0.8].map(|t| {
        let ([x, y, z], [mx, my, mz]) = (vector(), vector());
        PointForce { at: t * length, force: [x, y, z, mx, my, mz] }
    });
    let [strain, a, b] = vector();
    BarLoad { spans, points: points.to_vec(), strain, curvature: [a, b] }
}

/// A rotation about a random axis.
fn random_rotation(random: &mut ChaCha8Rng) -> Matrix3<f64> {
    let mut number = || random.random_range(-1.0..1.0);
    let axis = nalgebra::Unit::new_normalize(Vector3::new(number(), number(), number()));
    *nalgebra::Rotation3::from_axis_angle(&axis, 3.0 * number()).matrix()
}

fn blocks(q: &Matrix3<f64>) -> Matrix12 {
    let mut all = Matrix12::zeros();
    for o in [0, 3, 6, 9] {
        all.fixed_view_mut::<3, 3>(o, o).copy_from(q);
    }
    all
}

fn bend(frame: &SpaceFrame) -> Matrix12 {
    frame.global_stiffness(&frame.axes)
}

/// Cantilever of any direction under a force and a moment at its tip, with and without shear: along the axes
/// FL/EA, FL³/3EI + FL/GA_s + ML²/2EI, TL/GJ, FL²/2EI + ML/EI.
#[test]
fn cantilever_in_any_direction() {
    let random = &mut ChaCha8Rng::seed_from_u64(1);
    for shear in [false, true] {
        for _ in 0..10 {
            let length = 2.5;
            let q = random_rotation(random);
            let end: [f64; 3] = (q * Vector3::new(length, 0.0, 0.0)).into();
            let guide: [f64; 3] = (q * Vector3::new(0.3, 0.9, 0.0)).into();
            let k = bend(&frame([[0.0; 3], end], Some(guide), shear, [EndJoint::Rigid; 2]));
            let mut number = || random.random_range(-2.0..2.0);
            let f: [f64; 6] = std::array::from_fn(|_| number());
            let (e, g, s) = (3.0, 1.2, section(shear));
            let (l2, l3) = (length * length, length * length * length);
            let (iy, iz) = (e * s.inertia_y, e * s.inertia_z);
            let [gy, gz] = [s.shear_area_y, s.shear_area_z].map(|area| area.map_or(0.0, |area| length / (g * area)));
            let shift = Vector3::new(
                f[0] * length / (e * s.area),
                f[1] * (l3 / (3.0 * iz) + gy) + f[5] * l2 / (2.0 * iz),
                f[2] * (l3 / (3.0 * iy) + gz) - f[4] * l2 / (2.0 * iy),
            );
            let turn = Vector3::new(
                f[3] * length / (g * s.torsion),
                f[4] * length / iy - f[2] * l2 / (2.0 * iy),
                f[5] * length / iz + f[1] * l2 / (2.0 * iz),
            );
            let mut u = Vector12::zeros();
            u.fixed_rows_mut::<3>(6).copy_from(&(q * shift));
            u.fixed_rows_mut::<3>(9).copy_from(&(q * turn));
            let (mut right, found) = (Vector12::zeros(), k * u);
            right.fixed_rows_mut::<3>(6).copy_from(&(q * Vector3::new(f[0], f[1], f[2])));
            right.fixed_rows_mut::<3>(9).copy_from(&(q * Vector3::new(f[3], f[4], f[5])));
            // Twelve products a row, each of numbers that a dozen roundings made.
            let rounding = k.abs() * u.abs() * (64.0 * EPS);
            for row in 6..12 {
                assert!((found[row] - right[row]).abs() < rounding[row], "{row}: {found} {right}");
            }
        }
    }
}

/// Six rigid motions cost nothing, and nothing else does: six of twelve eigenvalues are zero, with one hinge eight,
/// with a hinge at both ends ten; the rows of a ball joint and the torque that it gives up are zero too.
#[test]
fn rigid_motions_and_rank() {
    let ends = [[0.3, -0.7, 0.2], [1.4, 0.9, -1.1]];
    let arm = Vector3::from(ends[1]) - Vector3::from(ends[0]);
    let rank = |joints: [EndJoint; 2]| {
        let held = joints.iter().filter(|joint| **joint == EndJoint::Rigid).count();
        let torque = usize::from(!joints.contains(&EndJoint::Ball));
        1 + 2 * held + torque
    };
    for shear in [false, true] {
        for joints in JOINTS.into_iter().flat_map(|a| JOINTS.map(|b| [a, b])) {
            let k = bend(&frame(ends, None, shear, joints));
            for c in 0..3 {
                let axis = Vector3::from_fn(|i, _| f64::from(i == c));
                let (mut shift, mut turn) = (Vector12::zeros(), Vector12::zeros());
                shift.fixed_rows_mut::<3>(0).copy_from(&axis);
                shift.fixed_rows_mut::<3>(6).copy_from(&axis);
                turn.fixed_rows_mut::<3>(3).copy_from(&axis);
                turn.fixed_rows_mut::<3>(9).copy_from(&axis);
                turn.fixed_rows_mut::<3>(6).copy_from(&axis.cross(&arm));
                assert!((k * shift).amax() < 32.0 * EPS * k.amax());
                assert!((k * turn).amax() < 64.0 * EPS * k.amax(), "{joints:?}");
            }
            let mut values: Vec<f64> = k.symmetric_eigenvalues().iter().copied().collect();
            values.sort_by(f64::total_cmp);
            let zeros = values.iter().filter(|value| value.abs() < 1e-12 * k.amax()).count();
            assert_eq!(zeros, 12 - rank(joints), "{joints:?}: {values:?}");
            assert!(values[zeros] > 1e-3, "{joints:?}: {values:?}");
        }
    }
}

/// The rows and loads of a hinge are those of the clamped bar with the released rotations condensed out; of a ball
/// joint with the torque as well.
#[test]
fn hinges_are_condensed_rotations() {
    let random = &mut ChaCha8Rng::seed_from_u64(2);
    let length = 1.7;
    for shear in [false, true] {
        let full = straight(length, shear, [EndJoint::Rigid; 2]);
        let load = random_load(random, length);
        for joints in JOINTS.into_iter().flat_map(|a| JOINTS.map(|b| [a, b])) {
            if joints == [EndJoint::Ball; 2] {
                continue;
            }
            let (mut k, mut f) = (full.local_stiffness(length), full.local_forces(&load));
            for (end, joint) in joints.into_iter().enumerate() {
                let released: &[usize] = match joint {
                    EndJoint::Rigid => &[],
                    EndJoint::Hinge => &[4, 5],
                    EndJoint::Ball => &[3, 4, 5],
                };
                for r in released.iter().map(|row| row + 6 * end) {
                    let column: Vector12 = k.column(r).into();
                    f -= column * (f[r] / column[r]);
                    k -= column * column.transpose() / column[r];
                }
            }
            let hinged = straight(length, shear, joints);
            assert!((hinged.local_stiffness(length) - k).amax() < 64.0 * EPS * full.local_stiffness(length).amax());
            assert!((hinged.local_forces(&load) - f).amax() < 1e-13, "{joints:?}");
        }
    }
}

/// Internal forces of a cantilever under `load` at the place `s`, by statics: the integrals over what lies beyond.
fn beyond(load: &BarLoad, s: f64, length: f64) -> [f64; 6] {
    let mut all = [0.0; 6];
    for span in &load.spans {
        let (a, b) = (span.range[0].max(s), span.range[1].min(length));
        if b <= a {
            continue;
        }
        // Simpson's rule: q times an arm is quadratic.
        for (x, w) in [(a, 1.0), (0.5 * (a + b), 4.0), (b, 1.0)] {
            let (q, w) = (span.at(x), w * (b - a) / 6.0);
            let arm = x - s;
            let more = [w * q[0], -w * q[1], w * q[1] * arm, -w * q[2], w * q[2] * arm, 0.0];
            all.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        }
    }
    for point in load.points.iter().filter(|point| point.at > s) {
        let ([x, y, z, mx, my, mz], arm) = (point.force, point.at - s);
        let more = [x, -y, y * arm + mz, -z, z * arm - my, mx];
        all.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
    }
    all
}

/// Fixed-end forces of every load by the force method: the displacements of the tip of a cantilever under the load and
/// under unit forces there are integrals of the internal forces (unit load theorem), taken by Gauss's rule between the
/// places where a load begins or ends; the forces that bring the tip back are those at the end of the clamped bar.
#[test]
fn fixed_end_forces_by_the_force_method() {
    let random = &mut ChaCha8Rng::seed_from_u64(3);
    let length = 1.7;
    for shear in [false, true] {
        for _ in 0..5 {
            let load = random_load(random, length);
            let section = section(shear);
            let (e, g) = (3.0, 1.2);
            let over = |stiffness: Option<f64>| stiffness.map_or(0.0, |stiffness| 1.0 / (g * stiffness));
            // N, V_y, M_z, V_z, M_y, T per deformation.
            let yields = [
                1.0 / (e * section.area),
                over(section.shear_area_y),
                1.0 / (e * section.inertia_z),
                over(section.shear_area_z),
                1.0 / (e * section.inertia_y),
                over(Some(section.torsion)),
            ];
            let free = [load.strain, 0.0, load.curvature[0], 0.0, load.curvature[1], 0.0];
            // Internal forces at s for unit values of N, V_y, M_z, V_z, M_y, T at the tip.
            let unit = |which: usize, s: f64| {
                let (mut all, arm) = ([0.0; 6], length - s);
                all[which] = 1.0;
                if which == 1 || which == 3 {
                    all[which + 1] = -arm;
                }
                all
            };
            let mut cuts = vec![0.0, length];
            cuts.extend(load.spans.iter().flat_map(|span| span.range));
            cuts.extend(load.points.iter().map(|point| point.at));
            cuts.sort_by(f64::total_cmp);
            let (mut flexibility, mut gap) = (SMatrix::<f64, 6, 6>::zeros(), SVector::<f64, 6>::zeros());
            let g3 = 0.6_f64.sqrt();
            for ends in cuts.windows(2) {
                let half = 0.5 * (ends[1] - ends[0]);
                for (x, w) in [(-g3, 5.0 / 9.0), (0.0, 8.0 / 9.0), (g3, 5.0 / 9.0)] {
                    let (s, w) = (0.5 * (ends[0] + ends[1]) + half * x, w * half);
                    let forces = beyond(&load, s, length);
                    for i in 0..6 {
                        let of_i = unit(i, s);
                        gap[i] += w * (0..6).map(|c| of_i[c] * (forces[c] * yields[c] + free[c])).sum::<f64>();
                        for j in 0..6 {
                            let of_j = unit(j, s);
                            flexibility[(i, j)] += w * (0..6).map(|c| of_i[c] * of_j[c] * yields[c]).sum::<f64>();
                        }
                    }
                }
            }
            let at_end = flexibility.lu().solve(&-gap).unwrap();
            let at_start: [f64; 6] = std::array::from_fn(|c| {
                beyond(&load, 0.0, length)[c] + (0..6).map(|i| unit(i, 0.0)[c] * at_end[i]).sum::<f64>()
            });
            let frame = straight(length, shear, [EndJoint::Rigid; 2]);
            let [start, end] = frame.end_forces(&Vector12::zeros(), &load);
            for c in 0..6 {
                assert!((start[c] - at_start[c]).abs() < 1e-12, "{c}: {start:?} {at_start:?}");
                assert!((end[c] - at_end[c]).abs() < 1e-12, "{c}: {end:?} {at_end}");
            }
            // And along the bar what is at its end.
            let along = load.forces_along([start, end], length);
            let last = along.pieces[along.pieces.len() - 1].at(length);
            assert!((0..6).all(|c| (last[c] - end[c]).abs() < 1e-12), "{last:?} {end:?}");
        }
    }
}

/// A bar turned by a rotation gives turned forces, and the same internal ones.
#[test]
fn a_turned_bar() {
    let random = &mut ChaCha8Rng::seed_from_u64(4);
    let ends = [[0.3, -0.7, 0.2], [1.4, 0.9, -1.1]];
    let guide = [0.2, 0.1, 0.9];
    for joints in JOINTS.into_iter().flat_map(|a| JOINTS.map(|b| [a, b])) {
        let q = random_rotation(random);
        let turned = |v: [f64; 3]| -> [f64; 3] { (q * Vector3::from(v)).into() };
        let first = frame(ends, Some(guide), true, joints);
        let second = frame(ends.map(turned), Some(turned(guide)), true, joints);
        let (all, size) = (blocks(&q), bend(&first).amax());
        // The ends are rounded, and with them the length: a power of it up to the third.
        assert!((bend(&second) - all * bend(&first) * all.transpose()).amax() < 64.0 * EPS * size);
        let load = random_load(random, first.axes.length);
        let u = Vector12::from_fn(|_, _| random.random_range(-1.0..1.0));
        let (one, two) = (first.end_forces(&u, &load), second.end_forces(&(all * u), &load));
        for (a, b) in one.iter().flatten().zip(two.iter().flatten()) {
            assert!((a - b).abs() < 1e-12, "{one:?} {two:?}");
        }
    }
}

/// In each coordinate plane it is the frame of the plane: stiffness, nodal forces and internal forces, with the section
/// across or along the plane.
#[test]
fn the_plane_frame_in_each_coordinate_plane() {
    let random = &mut ChaCha8Rng::seed_from_u64(5);
    // The axes of each plane, and the sign of the rotation from the first to the second.
    for (plane, about, sign) in [([0, 1], 2, 1.0), ([1, 2], 0, 1.0), ([2, 0], 1, 1.0), ([0, 2], 1, -1.0)] {
        for (across, hinges) in [(false, [false; 2]), (true, [true, false]), (false, [false, true]), (true, [true; 2])]
        {
            let ends = [[0.2, -0.4], [1.3, 1.9]];
            let lift = |v: [f64; 2]| {
                let mut all = [0.0; 3];
                (all[plane[0]], all[plane[1]]) = (v[0], v[1]);
                all
            };
            let s = section(true);
            let (inertia, shear) = if across { (s.inertia_y, s.shear_area_z) } else { (s.inertia_z, s.shear_area_y) };
            let flat = Frame::new(ends, &material(), [s.area, inertia], shear, hinges).unwrap();
            let axes = BarAxes::<f64>::in_plane(ends).unwrap();
            let guide = if across {
                // Local z is the y of the plane: y = z × x points along minus its normal.
                let mut normal = [0.0; 3];
                normal[about] = -sign;
                normal
            } else {
                lift([axes.y[0], axes.y[1]])
            };
            let joints = hinges.map(|hinge| if hinge { EndJoint::Hinge } else { EndJoint::Rigid });
            let space = frame(ends.map(lift), Some(guide), true, joints);
            assert!(
                (Vector3::from(if across { space.axes.z } else { space.axes.y })
                    - Vector3::from(lift([axes.y[0], axes.y[1]])))
                .amax()
                    < 4.0 * EPS
            );
            let rows: Vec<(usize, f64)> = [0, 1]
                .iter()
                .flat_map(|end| [(plane[0] + 6 * end, 1.0), (plane[1] + 6 * end, 1.0), (3 + about + 6 * end, sign)])
                .collect();
            let kept: Vec<usize> = (0..6).filter(|row| row % 3 != 2 || !hinges[row / 3]).collect();
            let (k, right) = (bend(&space), flat.stiffness().unwrap());
            for (i, &a) in kept.iter().enumerate() {
                for (j, &b) in kept.iter().enumerate() {
                    let found = rows[a].1 * rows[b].1 * k[(rows[a].0, rows[b].0)];
                    assert!((found - right[(i, j)]).abs() < 32.0 * EPS * k.amax(), "{plane:?} {across} {hinges:?}");
                }
            }
            // A load in the plane, the same for both: along x and across it in the plane, and a couple.
            let mut number = || random.random_range(-1.0..1.0);
            let (mut one, mut two) = (BarLoad::default(), BarLoad::default());
            let length = axes.length;
            let (qs, point) = ([0, 1].map(|_| [number(), number()]), [number(), number(), number()]);
            let bending = if across { Bending::Xz } else { Bending::Xy };
            one.spans.push(Span { range: [0.2, length], force: qs.map(|[x, y]| [x, y, 0.0]) });
            two.spans.push(Span {
                range: [0.2, length],
                force: qs.map(|[x, y]| if across { [x, 0.0, y] } else { [x, y, 0.0] }),
            });
            one.points.push(PointForce { at: 0.4, force: Bending::Xy.motion(point) });
            two.points.push(PointForce { at: 0.4, force: bending.motion(point) });
            let curvature = number();
            one.curvature[0] = curvature;
            two.curvature[usize::from(across)] = curvature;
            let u: Vec<f64> = (0..6).map(|row| if kept.contains(&row) { number() } else { 0.0 }).collect();
            let mut in_space = Vector12::zeros();
            rows.iter().zip(&u).for_each(|((row, sign), u)| in_space[*row] = sign * u);
            let a = flat.end_forces(&std::array::from_fn(|row| u[row]), &one);
            let b = space.end_forces(&in_space, &two);
            let [shear, moment] = if across { [3, 4] } else { [1, 2] };
            for (a, b) in a.iter().zip(b) {
                for (i, j) in [(0, 0), (1, shear), (2, moment)] {
                    assert!((a[i] - b[j]).abs() < 1e-13, "{plane:?} {across} {hinges:?}: {a:?} {b:?}");
                }
                let rest: f64 = b.iter().map(|value| value.abs()).sum::<f64>()
                    - [0, shear, moment].map(|i| b[i].abs()).iter().sum::<f64>();
                assert!(rest < 1e-13);
            }
        }
    }
}

/// Free strain, curvatures: u = ε₀x, v = κ_z x²/2, w = κ_y x²/2 leaves no internal force; held, N = −EA ε₀ and
/// M = −EI κ₀ in both planes.
#[test]
fn free_deformation_makes_no_force() {
    let load = BarLoad { strain: 0.01, curvature: [0.03, -0.02], ..BarLoad::default() };
    let (l, mut u) = (2.0, Vector12::zeros());
    let frame = frame([[0.0; 3], [l, 0.0, 0.0]], Some([0.0, 1.0, 0.0]), true, [EndJoint::Rigid; 2]);
    (u[6], u[7], u[11], u[8], u[10]) = (0.01 * l, 0.015 * l * l, 0.03 * l, -0.01 * l * l, 0.02 * l);
    let ends = frame.end_forces(&u, &load);
    assert!(ends.iter().flatten().all(|value| value.abs() < 1e-15), "{ends:?}");
    let held = frame.end_forces(&Vector12::zeros(), &load);
    let right = [-21.0 * 0.01, 0.0, -15.0 * 0.03, 0.0, 6.0 * 0.02, 0.0];
    assert!(held.iter().all(|end| (0..6).all(|c| (end[c] - right[c]).abs() < 1e-15)), "{held:?}");
}

/// Torque between the ends: split by the distances; all of it to the one end that takes it.
#[test]
fn torques() {
    let length = 2.0;
    let load =
        BarLoad { points: vec![PointForce { at: 0.5, force: [0.0, 0.0, 0.0, 8.0, 0.0, 0.0] }], ..BarLoad::default() };
    for (joints, [a, b]) in [
        ([EndJoint::Rigid; 2], [6.0, 2.0]),
        ([EndJoint::Hinge, EndJoint::Hinge], [6.0, 2.0]),
        ([EndJoint::Ball, EndJoint::Rigid], [0.0, 8.0]),
        ([EndJoint::Hinge, EndJoint::Ball], [8.0, 0.0]),
    ] {
        let f = straight(length, false, joints).local_forces(&load);
        assert!((f[3] - a).abs() < 1e-15 && (f[9] - b).abs() < 1e-15, "{joints:?}");
    }
}

/// k in doubled precision is that in f64 to rounding, and ball joints leave their rotations out.
#[test]
fn rows_and_doubled_precision() {
    let ends = [[0.3, -0.7, 0.2], [1.4, 0.9, -1.1]];
    for joints in JOINTS.into_iter().flat_map(|a| JOINTS.map(|b| [a, b])) {
        let frame = frame(ends, None, true, joints);
        let (k, exact) = (frame.stiffness().unwrap(), frame.doubled_stiffness().unwrap());
        let balls = joints.iter().filter(|joint| **joint == EndJoint::Ball).count();
        assert_eq!(k.nrows(), 12 - 3 * balls);
        let exact = exact.map(|value| value.to_f64());
        assert!((&exact - &k).amax() < 32.0 * EPS * k.amax());
        let u = DVector::from_fn(k.nrows(), |i, _| 0.1 * i as f64);
        assert!(frame.bar_forces(u.as_slice(), &[]).is_some());
    }
}

/// Without a load between the nodes and without shear: linear along the bar, cubic across it, with slopes θ × e at the
/// ends.
#[test]
fn the_elastic_curve_of_an_unloaded_bar_is_cubic() {
    let mut random = ChaCha8Rng::seed_from_u64(19);
    let ends = [[0.3, -0.2, 0.5], [1.7, 0.9, -0.4]];
    let bar = frame(ends, Some([0.2, 1.0, 0.3]), false, [EndJoint::Rigid; 2]);
    let (length, e) = (bar.axes.length, Vector3::from(bar.axes.x));
    let u: Vec<f64> = (0..12).map(|_| random.random_range(-1.0..1.0)).collect();
    let vector = |row: usize| Vector3::new(u[row], u[row + 1], u[row + 2]);
    let (ua, ub, slope_a, slope_b) = (vector(0), vector(6), vector(3).cross(&e), vector(9).cross(&e));
    let across = |v: Vector3<f64>| v - e * e.dot(&v);
    let shares = [0.0, 0.2, 0.55, 1.0];
    let curve = bar.elastic_curve(&u, &[], &shares).unwrap();
    for (t, found) in shares.into_iter().zip(curve) {
        let along = e * (e.dot(&ua) * (1.0 - t) + e.dot(&ub) * t);
        let cubic = across(ua) * (1.0 - 3.0 * t * t + 2.0 * t * t * t)
            + across(ub) * (3.0 * t * t - 2.0 * t * t * t)
            + slope_a * (length * (t - 2.0 * t * t + t * t * t))
            + slope_b * (length * (t * t * t - t * t));
        assert!((Vector3::from(found) - along - cubic).amax() < 1e-13, "{found:?} at {t}");
    }
}
