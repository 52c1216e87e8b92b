use super::*;
use crate::model::shape::Shape;
use crate::model::shape_functions::SolidShape;
use crate::model::vector::cross;

const SHAPES: [Shape; 4] = [Shape::Tetrahedron4, Shape::Tetrahedron10, Shape::Hexahedron8, Shape::Hexahedron20];

fn nodes(places: &[[f64; 3]]) -> Vec<Node> {
    places.iter().map(|&position| Node { id: "n".into(), position }).collect()
}

/// The whole surface of one element.
fn surface(shape: Shape) -> Face {
    Face::of(shape.faces().into_iter().map(|nodes| FaceSide { element: 0, nodes: nodes.to_vec() }).collect())
}

/// The parent element, its nodes moved without a pattern: warped and bulging faces.
fn warped(shape: Shape) -> Vec<[f64; 3]> {
    let parent = SolidShape::of(shape.nodes()).nodes();
    let moved = |(i, at): (usize, &[f64; 3])| {
        std::array::from_fn(|c| at[c] + 0.08 * ((7 * i + 3 * c) as f64).sin() + if c == 2 { 0.2 } else { 0.0 })
    };
    parent.iter().enumerate().map(moved).collect()
}

fn resultant(forces: &[(usize, [f64; 3])], places: &[[f64; 3]]) -> ([f64; 3], [f64; 3]) {
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    for (node, f) in forces {
        let m = cross(places[*node], *f);
        (0..3).for_each(|c| {
            force[c] += f[c];
            moment[c] += m[c];
        });
    }
    (force, moment)
}

/// Areas that stand for the nodes of plane sides: 1/3 each, 1/4 each, 0 and 1/3, −1/12 and 1/3.
#[test]
fn nodal_areas() {
    let triangle = [[0.0, 0.0, 1.0], [3.0, 0.0, 1.0], [0.0, 4.0, 1.0]];
    let square = [[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 2.0, 3.0], [0.0, 0.0, 3.0]];
    let with_middles = |corners: &[[f64; 3]]| -> Vec<[f64; 3]> {
        let n = corners.len();
        let middle = |k: usize| std::array::from_fn(|c| 0.5 * (corners[k][c] + corners[(k + 1) % n][c]));
        corners.iter().copied().chain((0..n).map(middle)).collect()
    };
    for (places, [corner, middle], normal) in [
        (triangle.to_vec(), [1.0 / 3.0, 0.0], [0.0, 0.0, 1.0]),
        (square.to_vec(), [0.25, 0.0], [1.0, 0.0, 0.0]),
        (with_middles(&triangle), [0.0, 1.0 / 3.0], [0.0, 0.0, 1.0]),
        (with_middles(&square), [-1.0 / 12.0, 1.0 / 3.0], [1.0, 0.0, 0.0]),
    ] {
        let count = places.len();
        let face = Face::of(vec![FaceSide { element: 0, nodes: (0..count).collect() }]);
        let corners = if count % 3 == 0 { 3 } else { 4 };
        let nodes = nodes(&places);
        for (k, area) in face.nodal_areas(&nodes).into_iter().enumerate() {
            let share = if k < corners { corner } else { middle };
            assert!((area - 6.0 * share).abs() < 1e-14, "{count} {k}: {area}");
        }
        assert!((face.area(&nodes) - 6.0).abs() < 1e-14);
        for found in face.outward_normals(&nodes) {
            assert!(found.is_some_and(|found| (0..3).all(|c| (found[c] - normal[c]).abs() < 1e-15)));
        }
    }
}

/// A pressure on all of a closed surface has no resultant and no moment, however warped it is.
#[test]
fn a_closed_surface_is_in_balance() {
    for shape in SHAPES {
        let places = warped(shape);
        let face = surface(shape);
        assert_eq!(face.nodes.len(), shape.nodes());
        let forces = face.consistent_forces(&nodes(&places), None, &|spot| spot.outward.map(|n| -2.0 * n));
        let (force, moment) = resultant(&forces, &places);
        assert!(force.iter().chain(&moment).all(|value| value.abs() < 1e-14), "{shape:?}: {force:?} {moment:?}");
        // Its normals look away from the middle.
        let centre = places.iter().fold([0.0; 3], |sum, at| [0, 1, 2].map(|c| sum[c] + at[c] / places.len() as f64));
        for (node, normal) in face.nodes.iter().zip(face.outward_normals(&nodes(&places))) {
            assert!(normal.is_some_and(|normal| dot(normal, way(centre, places[*node])) > 0.0), "{shape:?} {node}");
        }
    }
}

fn water(level: f64) -> impl Fn(&FaceSpot) -> [f64; 3] {
    move |spot| {
        assert!((spot.depth - (level - spot.position[2])).abs() < 1e-14);
        let pressure = spot.depth.max(0.0);
        spot.outward.map(|n| -pressure * n)
    }
}

/// Water up to a level that cuts the faces: nothing sideways and no moment about the vertical, for the wet surface and
/// the water line close a body. To rounding, also where the cut is a hyperbola or a conic in the parent of the side.
#[test]
fn a_floating_body_is_not_pushed_sideways() {
    for shape in SHAPES {
        let places = warped(shape);
        for level in [-0.83, -0.21, 0.1, 0.4, 0.77] {
            let forces = surface(shape).consistent_forces(&nodes(&places), Some(level), &water(level));
            let (force, moment) = resultant(&forces, &places);
            let size: f64 = forces.iter().flat_map(|(_, force)| force).map(|f| f.abs()).sum();
            assert!(force[2] >= 0.0);
            for value in [force[0], force[1], moment[2]] {
                assert!(value.abs() <= 64.0 * f64::EPSILON * size, "{shape:?} {level}: {force:?} {moment:?}");
            }
        }
    }
}

/// Uplift is the weight of the water in the volume below the level: of a tetrahedron on its tip (h/H)³ V, of the box
/// turned any way by its formula, Σ ± (level − corner)³₊ / 6 n_x n_y n_z, n the vertical along its sides.
#[test]
fn uplift_of_cut_bodies() {
    let tip = [[0.0, 0.0, 0.0], [1.0, 0.2, 2.0], [-0.3, 1.1, 2.0], [-0.4, -0.9, 2.0]];
    let volume = Shape::Tetrahedron4.volume(&tip);
    let forces = surface(Shape::Tetrahedron4).consistent_forces(&nodes(&tip), Some(0.7), &water(0.7));
    let right = volume * (0.7_f64 / 2.0).powi(3);
    assert!((resultant(&forces, &tip).0[2] - right).abs() < 1e-15, "{forces:?} {right}");

    let rotation = nalgebra::Rotation3::from_euler_angles(0.4, -0.7, 0.3);
    let sides = [1.0, 1.6, 0.7];
    let place = |at: &[f64; 3]| -> [f64; 3] {
        let at = nalgebra::Vector3::from_fn(|c, _| 0.5 * sides[c] * (at[c] + 1.0));
        (rotation * at).into()
    };
    for shape in [Shape::Hexahedron8, Shape::Hexahedron20] {
        let places: Vec<[f64; 3]> = SolidShape::of(shape.nodes()).nodes().iter().map(place).collect();
        for level in [-0.4, 0.1, 0.6, 1.1] {
            let forces = surface(shape).consistent_forces(&nodes(&places), Some(level), &water(level));
            let up: [f64; 3] = std::array::from_fn(|c| rotation.matrix()[(2, c)]);
            let mut sum = 0.0;
            for corner in 0..8_usize {
                let on = [0, 1, 2].map(|c| corner >> c & 1);
                let height: f64 = (0..3).map(|c| on[c] as f64 * sides[c] * up[c]).sum();
                let sign = if on.iter().sum::<usize>() % 2 == 0 { 1.0 } else { -1.0 };
                sum += sign * (level - height).max(0.0).powi(3);
            }
            let right = sum / (6.0 * up[0] * up[1] * up[2]);
            let (force, _) = resultant(&forces, &places);
            assert!((force[2] - right).abs() < 1e-14, "{shape:?} {level}: {force:?} {right}");
        }
    }
}

/// An upright rectangle with water to a height between: at its lower and upper nodes γ b h²/2 (1 − h/3H)/2 each and
/// γ b h³/12H, exactly; under the square of the same depth the force of a column.
#[test]
fn water_on_a_wall() {
    let (b, height, level) = (2.0, 3.0, 1.3);
    let places = [[0.0, 0.0, 0.0], [0.0, b, 0.0], [0.0, b, height], [0.0, 0.0, height]];
    for order in [[0, 1, 2, 3], [1, 2, 3, 0]] {
        let face = Face::of(vec![FaceSide { element: 3, nodes: order.to_vec() }]);
        let forces = face.consistent_forces(&nodes(&places), Some(level), &|spot| {
            assert_eq!(spot.element, 3);
            water(level)(spot)
        });
        for (node, force) in forces {
            let upper = b * level * level * level / (12.0 * height);
            let right = if node < 2 { 0.25 * b * level * level - upper } else { upper };
            assert!(
                (force[0] + right).abs() < 1e-15 && force[1] == 0.0 && force[2] == 0.0,
                "{node}: {force:?} {right}"
            );
        }
    }
}

/// Far from the origin, and where the level hardly wets a side: as exact as the heights are known, and found quickly.
#[test]
fn levels_far_away_and_low() {
    for (z, level) in [(1e6, 0.7), (-3e4, 1e-7), (0.0, 1e-9), (0.0, 2.0 - 1e-9)] {
        let tip = [[0.0, 0.0, z], [1.0, 0.2, z + 2.0], [-0.3, 1.1, z + 2.0], [-0.4, -0.9, z + 2.0]];
        let volume = Shape::Tetrahedron4.volume(&tip);
        let forces = surface(Shape::Tetrahedron4)
            .consistent_forces(&nodes(&tip), Some(z + level), &|spot| spot.outward.map(|n| -spot.depth.max(0.0) * n));
        // The level above the tip as it is in the numbers.
        let wet = z + level - z;
        let right = volume * (wet / 2.0).powi(3);
        let found = resultant(&forces, &tip).0[2];
        // Depths are sums of numbers as large as the side is high.
        let rounding = 64.0 * f64::EPSILON * (2.0 / wet);
        assert!((found - right).abs() < rounding * right, "{z} {level}: {found} {right}");
    }
}

/// A face of several sides adds up at their common nodes, and a total spread evenly over it comes out as the total.
#[test]
fn sides_add_up() {
    let places = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 2.0, 0.0], [1.0, 2.0, 0.0], [3.0, 2.0, 0.0]];
    let sides = [[0, 1, 4, 3], [1, 2, 5, 4]].map(|nodes| FaceSide { element: 0, nodes: nodes.to_vec() });
    let face = Face::of(sides.to_vec());
    assert_eq!(face.nodes, [0, 1, 4, 3, 2, 5]);
    let nodes = nodes(&places);
    let area = face.area(&nodes);
    let forces = face.consistent_forces(&nodes, None, &|_| [6.0 / area, 0.0, -12.0 / area]);
    for (node, force) in forces {
        let right = [0.5, 1.5, 1.0][node % 3];
        assert!((force[0] - right).abs() < 1e-14 && (force[2] + 2.0 * right).abs() < 1e-14, "{node} {force:?}");
    }
}
