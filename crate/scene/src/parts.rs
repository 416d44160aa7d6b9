//! Parts of a shape's offset surface, for renderers that draw balls, cylinders, arcs, triangles and
//! the like only: a polygon is cut into triangles, a curve into short cylinders with balls between,
//! a function into balls with radii of their own.

use crate::Shape;
use field::Skeleton;
use field::skeleton::ring_vector;
use glam::DVec3;

/// Straight pieces that stand for a curve.
const PIECES: usize = 32;

impl Shape {
    /// The simple shapes whose union is this shape's offset surface at the given radius; the shape
    /// itself if it is simple.
    #[must_use]
    pub fn parts(&self, radius: f64) -> Vec<Self> {
        let bone = match self {
            Self::Bone(bone) => bone,
            Self::Function(function) => return function.draft(),
            simple => return vec![simple.clone()],
        };
        match &bone.skeleton {
            Skeleton::Polygon { rings } => triangles(rings)
                .into_iter()
                .map(|corners| Self::triangle(corners, radius))
                .collect(),
            line if line.is_numeric() => {
                let mut base = line.at(0.0);
                let mut parts = vec![Self::sphere(base, radius)];
                for i in 1..=PIECES {
                    let apex = line.at(i as f64 / PIECES as f64);
                    parts.push(Self::cylinder(base, apex, radius));
                    parts.push(Self::sphere(apex, radius));
                    base = apex;
                }
                parts
            }
            // With flesh around it, a patch is a triangle like others.
            Skeleton::Triangle { corners } if radius > 0.0 => {
                vec![Self::triangle(*corners, radius)]
            }
            _ => vec![self.clone()],
        }
    }
}

/// Cuts a polygon into triangles, ear by ear.
fn triangles(rings: &[Vec<DVec3>]) -> Vec<[DVec3; 3]> {
    let Some(outer) = rings.first().filter(|ring| ring.len() >= 3) else {
        return Vec::new();
    };
    let Some(z) = ring_vector(outer).try_normalize() else {
        return Vec::new();
    };
    let x = z.any_orthonormal_vector();
    let y = z.cross(x);
    let corners: Vec<DVec3> = rings.iter().flatten().copied().collect();
    let flat: Vec<[f64; 2]> = corners
        .iter()
        .map(|p| [(*p - outer[0]).dot(x), (*p - outer[0]).dot(y)])
        .collect();
    let mut start = 0;
    let holes: Vec<usize> = rings
        .iter()
        .take(rings.len() - 1)
        .map(|ring| {
            start += ring.len();
            start
        })
        .collect();
    let mut indices: Vec<usize> = Vec::new();
    earcut::Earcut::new().earcut(flat, &holes, &mut indices);
    indices
        .chunks_exact(3)
        .map(|i| [corners[i[0]], corners[i[1]], corners[i[2]]])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(parts: &[Shape]) -> f64 {
        parts
            .iter()
            .map(|part| part.skeleton().expect("a triangle").measure())
            .sum()
    }

    #[test]
    fn polygons_keep_their_area() {
        let slant = 1.25f64.sqrt();
        let whole = Shape::polygon(vec![square(2.0)], 0.1);
        assert!((area(&whole.parts(0.1)) - 16.0 * slant).abs() < 1e-12);
        // Holes may run either way round.
        for turned in [false, true] {
            let mut hole = square(1.0);
            if turned {
                hole.reverse();
            }
            let holed = Shape::polygon(vec![square(2.0), hole], 0.1);
            assert!((area(&holed.parts(0.1)) - 12.0 * slant).abs() < 1e-12);
        }
    }

    fn square(half: f64) -> Vec<DVec3> {
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| DVec3::new(x * half, y * half, 0.5 * x * half))
            .to_vec()
    }

    #[test]
    fn a_degenerate_polygon_has_no_parts() {
        let line = vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
        for rings in [vec![], vec![vec![]], vec![line]] {
            let shape = Shape::polygon(rings, 0.0);
            assert!(shape.parts(0.0).is_empty(), "{shape:?}");
        }
    }

    #[test]
    fn a_curve_is_a_chain() {
        let control = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y];
        let shape = Shape::curve(control, 0.1);
        let parts = shape.parts(0.2);
        assert!(parts.iter().all(|part| part.radius() == 0.2));
        let ball = Shape::sphere(control[3], 0.2);
        assert_eq!(parts[parts.len() - 1], ball, "a ball at the end");
    }
}
