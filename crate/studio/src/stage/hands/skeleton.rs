//! The skeleton of the chosen element, drawn over the picture as lines.

use glam::DVec3;
use scene::Shape;

/// Number of lines that draw an arc.
const ARC_LINES: usize = 64;
/// Number of lines that draw a curve.
const CURVE_LINES: usize = 48;

/// Returns the lines of a shape's bone, each through some places of the world. `size` is the length
/// of lines for bones without a size: crosses at points, a piece of a plane.
#[must_use]
pub fn lines(shape: &Shape, size: f64) -> Vec<Vec<DVec3>> {
    match shape {
        Shape::Sphere { center, .. } => cross(*center, 0.15 * size),
        Shape::Cylinder { base, apex, .. }
        | Shape::Cone { base, apex, .. }
        | Shape::Pipe { base, apex, .. } => vec![vec![*base, *apex]],
        Shape::Arc {
            center,
            u,
            v,
            sweep,
            angle,
            ..
        } => {
            let line = (0..=ARC_LINES).map(|i| {
                let (sine, cosine) = libm::sincos(angle * i as f64 / ARC_LINES as f64);
                *center + (*u * cosine + *v * sine) * *sweep
            });
            vec![line.collect()]
        }
        Shape::Triangle { corners, .. } | Shape::Patch { corners, .. } => vec![ring(corners)],
        Shape::Polygon { rings, .. } => rings.iter().map(|corners| ring(corners)).collect(),
        Shape::Curve { control, .. } => {
            let [a, b, c, d] = *control;
            let line = (0..=CURVE_LINES).map(|i| {
                let t = i as f64 / CURVE_LINES as f64;
                let s = 1.0 - t;
                a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
            });
            vec![line.collect(), vec![a, b], vec![c, d]]
        }
        Shape::Plane { point, normal, .. } => {
            let (u, v) = normal.any_orthonormal_pair();
            let corner = |a: f64, b: f64| *point + (u * a + v * b) * size;
            let corners = [
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
            ];
            vec![ring(&corners), vec![*point, *point + *normal * size]]
        }
        Shape::Box { center, axes } => edges(*center, *axes),
        Shape::Quadric(quadric) => cross(quadric.center, 0.15 * size),
        Shape::Function(function) => match function.curves() {
            None => cross(function.middle(), 0.15 * size),
            Some(curves) => {
                let lines = curves.pieces().map(|ends| {
                    ends.map(|(p, _)| function.to_world.transform_point3(p))
                        .to_vec()
                });
                lines.collect()
            }
        },
    }
}

fn cross(center: DVec3, size: f64) -> Vec<Vec<DVec3>> {
    [DVec3::X, DVec3::Y, DVec3::Z]
        .map(|axis| vec![center - axis * size, center + axis * size])
        .to_vec()
}

fn ring(corners: &[DVec3]) -> Vec<DVec3> {
    corners.iter().chain(corners.first()).copied().collect()
}

fn edges(center: DVec3, axes: [DVec3; 3]) -> Vec<Vec<DVec3>> {
    let mut edges = Vec::with_capacity(12);
    for k in 0..3 {
        let (u, v, w) = (axes[k], axes[(k + 1) % 3], axes[(k + 2) % 3]);
        for (a, b) in [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)] {
            let middle = center + v * a + w * b;
            edges.push(vec![middle - u, middle + u]);
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bones_end_where_their_shapes_end() {
        let arc = Shape::Arc {
            center: DVec3::ZERO,
            u: DVec3::X,
            v: DVec3::Y,
            sweep: 2.0,
            angle: core::f64::consts::PI,
            radius: 0.1,
        };
        let line = &lines(&arc, 1.0)[0];
        assert_eq!(line[0], DVec3::X * 2.0);
        assert!(line[ARC_LINES].distance(DVec3::X * -2.0) < 1e-12);
        let cuboid = Shape::Box {
            center: DVec3::ONE,
            axes: [DVec3::X, DVec3::Y, DVec3::Z],
        };
        let edges = lines(&cuboid, 1.0);
        assert_eq!(edges.len(), 12);
        assert!(edges.iter().all(|edge| edge[0].distance(edge[1]) == 2.0));
    }
}
