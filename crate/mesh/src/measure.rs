//! Sizes and angles of triangle meshes.

use crate::aabb::Aabb;
use crate::half_edge::{HalfEdgeId, HalfEdgeMesh};
use crate::triangle_mesh::TriangleMesh;
use glam::DVec3;

impl TriangleMesh {
    /// The box of all vertices; empty without any.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        Aabb::of_points(self.positions.iter().copied())
    }

    /// The box of each triangle, for [`crate::Bvh::new`].
    #[must_use]
    pub fn triangle_boxes(&self) -> Vec<Aabb> {
        let boxes = (0..self.triangles.len()).map(|i| Aabb::of_points(self.corners(i)));
        boxes.collect()
    }

    /// Sum of the areas of all triangles.
    #[must_use]
    pub fn area(&self) -> f64 {
        (0..self.triangles.len())
            .map(|i| {
                let [a, b, c] = self.corners(i);
                0.5 * (b - a).cross(c - a).length()
            })
            .sum()
    }

    /// Volume that a closed mesh encloses: Σ (a − o) · (b − o) × (c − o) / 6 over its triangles,
    /// with o the middle of its box. Negative if the triangles are turned inside out; without a
    /// meaning if the mesh is open.
    ///
    /// ```
    /// use glam::DVec3;
    /// use mesh::TriangleMesh;
    ///
    /// let mesh = TriangleMesh::new(
    ///     vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
    ///     vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
    /// );
    /// assert!((mesh.signed_volume() - 1.0 / 6.0).abs() < 1e-15);
    /// assert!((mesh.smallest_angle().unwrap().to_degrees() - 45.0).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn signed_volume(&self) -> f64 {
        let origin = self.bounds().center();
        (0..self.triangles.len())
            .map(|i| {
                let [a, b, c] = self.corners(i).map(|p| p - origin);
                a.dot(b.cross(c)) / 6.0
            })
            .sum()
    }

    /// The smallest angle of all triangles, radians: 0 if one has no area. `None` without
    /// triangles.
    #[must_use]
    pub fn smallest_angle(&self) -> Option<f64> {
        (0..self.triangles.len())
            .map(|i| smallest_angle(&self.corners(i)))
            .reduce(f64::min)
    }
}

/// The smallest angle of a triangle, radians.
#[must_use]
pub fn smallest_angle([a, b, c]: &[DVec3; 3]) -> f64 {
    let [at_a, at_b, at_c] = [[a, b, c], [b, c, a], [c, a, b]].map(|[p, q, r]| {
        let (one, other) = (*q - *p, *r - *p);
        // 0 for sides of length 0.
        libm::atan2(one.cross(other).length(), one.dot(other))
    });
    at_a.min(at_b).min(at_c)
}

/// The point of a triangle (its inside, sides and corners) that is nearest to a point. Also of a
/// triangle without area.
///
/// ```
/// use glam::DVec3;
///
/// let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let nearest = mesh::closest_point(&triangle, DVec3::new(0.2, 0.3, 5.0));
/// assert!(nearest.distance(DVec3::new(0.2, 0.3, 0.0)) < 1e-15);
/// ```
#[must_use]
pub fn closest_point(triangle: &[DVec3; 3], point: DVec3) -> DVec3 {
    let [a, b, c] = *triangle;
    let normal = (b - a).cross(c - a);
    let area = normal.length_squared();
    if area > 0.0 {
        let inside = [(a, b), (b, c), (c, a)]
            .iter()
            .all(|(from, to)| (*to - *from).cross(point - *from).dot(normal) >= 0.0);
        if inside {
            return point - normal * ((point - a).dot(normal) / area);
        }
    }
    [(a, b), (b, c), (c, a)]
        .map(|(from, to)| closest_on_segment(from, to, point))
        .into_iter()
        .min_by(|p, q| {
            let [p, q] = [p, q].map(|x| x.distance_squared(point));
            p.total_cmp(&q)
        })
        .unwrap_or(a)
}

fn closest_on_segment(from: DVec3, to: DVec3, point: DVec3) -> DVec3 {
    let along = to - from;
    let length = along.length_squared();
    if length == 0.0 {
        return from;
    }
    let t = ((point - from).dot(along) / length).clamp(0.0, 1.0);
    // From the nearer end, so that the ends are exact.
    if t < 0.5 {
        from + t * along
    } else {
        to - (1.0 - t) * along
    }
}

impl HalfEdgeMesh {
    /// The angle between the normals of the two faces at an edge, radians: 0 where the mesh is
    /// flat, positive where it is convex, negative where it is concave, −π … π. `None` on the
    /// boundary.
    #[must_use]
    pub fn dihedral_angle(&self, h: HalfEdgeId) -> Option<f64> {
        let [one, other] = [self.face(h)?, self.face(self.twin(h))?].map(|f| self.face_normal(f));
        let along = self.position(self.target(h)) - self.position(self.origin(h));
        let cross = one.cross(other);
        let angle = libm::atan2(cross.length(), one.dot(other));
        Some(if cross.dot(along) < 0.0 {
            -angle
        } else {
            angle
        })
    }
}
