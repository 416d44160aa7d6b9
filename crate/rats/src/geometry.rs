//! The geometry behind the primitives: an arc's axes, the circle through three points, transforms.

use field::skeleton::{Map, ring_vector};
use glam::{DAffine3, DMat3, DVec2, DVec3};
use scene::Shape;

/// Returns the local axes u, v of an arc with unit normal `n`: u is the world's x axis made
/// perpendicular to n (the y axis if n is parallel to x), v = n × u. Angles run from u towards v.
#[must_use]
pub fn arc_axes(n: DVec3) -> (DVec3, DVec3) {
    // Nearer than this the x axis has no direction left that is more than rounding.
    let parallel = n.cross(DVec3::X).length() < 1e-9;
    let along = if parallel { DVec3::Y } else { DVec3::X };
    let u = (along - n * n.dot(along)).normalize_or(DVec3::X);
    (u, n.cross(u))
}

/// Returns the arc's shape from the operands of `arc`: angles in degrees; a negative width turns
/// the other way; more than a full turn is a full turn.
#[must_use]
pub fn arc(center: DVec3, normal: DVec3, sweep: f64, radius: f64, start: f64, width: f64) -> Shape {
    let (x, y) = arc_axes(normal);
    let (sin, cos) = sin_cos_degrees(start);
    let u = x * cos + y * sin;
    let v = (y * cos - x * sin) * width.signum();
    Shape::arc(
        center,
        [u, v],
        sweep,
        width.abs().min(360.0).to_radians(),
        radius,
    )
}

/// Computes sine and cosine of an angle in degrees, exact at multiples of 90°.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turn = degrees - 360.0 * (degrees / 360.0).floor();
    if turn == 0.0 {
        (0.0, 1.0)
    } else if turn == 90.0 {
        (1.0, 0.0)
    } else if turn == 180.0 {
        (0.0, -1.0)
    } else if turn == 270.0 {
        (-1.0, 0.0)
    } else {
        let radians = turn.to_radians();
        (libm::sin(radians), libm::cos(radians))
    }
}

/// The curve through three points.
#[derive(Clone, Debug, PartialEq)]
pub enum ThreePoints {
    /// A piece of a circle from the first over the second to the third.
    Arc(Shape),
    /// A segment that holds all three, which lie on a line.
    Line(DVec3, DVec3),
    /// Nothing, as two of them or all are the same.
    Same,
}

/// Finds the arc from `a` over `b` to `c` with a tube of the given radius.
#[must_use]
pub fn through(a: DVec3, b: DVec3, c: DVec3, radius: f64) -> ThreePoints {
    let (ab, ac) = (b - a, c - a);
    let size = ab.length().max(ac.length());
    if ab.length().min(ac.length()).min((c - b).length()) <= 1e-12 * size.max(f64::MIN_POSITIVE) {
        return ThreePoints::Same;
    }
    let normal = ab.cross(ac);
    // The sine of the angle at a, below which the circle's centre is lost in rounding.
    if normal.length() <= 1e-7 * ab.length() * ac.length() {
        return straight(a, b, c);
    }
    // The circumcentre relative to a.
    let to_center = (normal.cross(ab) * ac.length_squared()
        + ac.cross(normal) * ab.length_squared())
        / (2.0 * normal.length_squared());
    let center = a + to_center;
    let sweep = to_center.length();
    let n = normal.normalize();
    let u = -to_center / sweep;
    let v = n.cross(u);
    // a → b → c turns counter-clockwise about n, so the angle of c is past that of b.
    let last = c - center;
    let mut angle = libm::atan2(last.dot(v), last.dot(u));
    if angle <= 0.0 {
        angle += std::f64::consts::TAU;
    }
    ThreePoints::Arc(Shape::arc(center, [u, v], sweep, angle, radius))
}

/// Returns the longest segment between three points on a line.
fn straight(a: DVec3, b: DVec3, c: DVec3) -> ThreePoints {
    let longest = [(a, c), (a, b), (b, c)]
        .into_iter()
        .max_by(|p, q| p.0.distance(p.1).total_cmp(&q.0.distance(q.1)));
    longest.map_or(ThreePoints::Same, |(base, apex)| {
        ThreePoints::Line(base, apex)
    })
}

/// Moves a polygon's corners onto one plane: through the middle of its outer ring, with the normal
/// of the ring's area. Returns the largest distance of a corner from it, as a share of the
/// polygon's size.
pub fn flatten(rings: &mut [Vec<DVec3>]) -> f64 {
    let Some(outer) = rings.first().filter(|ring| !ring.is_empty()) else {
        return 0.0;
    };
    let middle = outer.iter().sum::<DVec3>() / outer.len() as f64;
    let normal: DVec3 = (0..outer.len())
        .map(|i| (outer[i] - middle).cross(outer[(i + 1) % outer.len()] - middle))
        .sum();
    let Some(normal) = normal.try_normalize() else {
        return 0.0;
    };
    let (mut size, mut off) = (0.0f64, 0.0f64);
    for corner in rings.iter_mut().flatten() {
        let d = *corner - middle;
        let height = d.dot(normal);
        size = size.max(d.length());
        off = off.max(height.abs());
        // Corners that lie in the plane as well as rounding allows stay as they were written.
        if height.abs() > 1e-12 * d.length() {
            *corner -= normal * height;
        }
    }
    off / size.max(f64::MIN_POSITIVE)
}

/// Returns whether two edges of a flat polygon cross, or a hole is not inside it, or inside another
/// hole.
#[must_use]
pub fn crosses_itself(rings: &[Vec<DVec3>]) -> bool {
    let Some(outer) = rings.first().filter(|ring| ring.len() >= 3) else {
        return false;
    };
    let Some(z) = ring_vector(outer).try_normalize() else {
        return false;
    };
    let x = z.any_orthonormal_vector();
    let y = z.cross(x);
    let flat: Vec<Vec<DVec2>> = rings
        .iter()
        .map(|ring| {
            let from_corner = ring.iter().map(|p| *p - outer[0]);
            from_corner
                .map(|p| DVec2::new(p.dot(x), p.dot(y)))
                .collect()
        })
        .collect();
    let edges: Vec<(DVec2, DVec2)> = flat
        .iter()
        .flat_map(|ring| (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])))
        .collect();
    for (i, &e) in edges.iter().enumerate() {
        if edges[i + 1..].iter().any(|&f| splits(e, f) && splits(f, e)) {
            return true;
        }
    }
    // Rings that do not cross are inside each other or apart as one of their points is.
    flat.iter().enumerate().skip(1).any(|(i, hole)| {
        let p = (hole[0] + hole[1]) * 0.5;
        let mut others = flat.iter().enumerate().skip(1);
        !is_inside(&flat[0], p) || others.any(|(j, other)| j != i && is_inside(other, p))
    })
}

/// Whether the ends of an edge are on different sides of the line through another one.
fn splits(line: (DVec2, DVec2), (p, q): (DVec2, DVec2)) -> bool {
    side(line, p) * side(line, q) < 0.0
}

/// Tells by its sign on which side of a line a point is; 0 on it, as where corners touch edges.
fn side((a, b): (DVec2, DVec2), p: DVec2) -> f64 {
    (b - a).perp_dot(p - a)
}

/// Returns whether a point is inside a ring: a ray from it along x crosses an odd number of edges.
fn is_inside(ring: &[DVec2], p: DVec2) -> bool {
    let mut inside = false;
    for i in 0..ring.len() {
        let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) {
            inside = !inside;
        }
    }
    inside
}

/// An affine map: `x ↦ linear·x + shift`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// The linear part.
    pub linear: DMat3,
    /// The shift.
    pub shift: DVec3,
    /// The factor by which radii grow: the mean of the scale factors' magnitudes.
    pub growth: f64,
    /// Whether all lengths grow alike.
    pub uniform: bool,
}

impl Transform {
    /// Makes a shift.
    #[must_use]
    pub fn translation(shift: DVec3) -> Self {
        Self {
            linear: DMat3::IDENTITY,
            shift,
            growth: 1.0,
            uniform: true,
        }
    }

    /// Makes a right-handed turn about a unit axis through the origin (Rodrigues' formula).
    #[must_use]
    pub fn rotation(axis: DVec3, degrees: f64) -> Self {
        let (sin, cos) = sin_cos_degrees(degrees);
        let [x, y, z] =
            DVec3::AXES.map(|x| x * cos + axis.cross(x) * sin + axis * (axis.dot(x) * (1.0 - cos)));
        Self {
            linear: DMat3::from_cols(x, y, z),
            shift: DVec3::ZERO,
            growth: 1.0,
            uniform: true,
        }
    }

    /// Makes the turns about the x axis, then y, then z, by angles in degrees.
    #[must_use]
    pub fn rotations(degrees: DVec3) -> Self {
        let [x, y, z] = [
            (DVec3::X, degrees.x),
            (DVec3::Y, degrees.y),
            (DVec3::Z, degrees.z),
        ]
        .map(|(axis, degrees)| Self::rotation(axis, degrees).linear);
        Self {
            linear: z * y * x,
            ..Self::translation(DVec3::ZERO)
        }
    }

    /// Makes a scale along the axes by factors that are not 0; negative ones mirror.
    #[must_use]
    pub fn scaling(factors: DVec3) -> Self {
        let size = factors.abs();
        let uniform = size.x == size.y && size.y == size.z;
        let mean = (size.x + size.y + size.z) / 3.0;
        Self {
            linear: DMat3::from_diagonal(factors),
            shift: DVec3::ZERO,
            growth: if uniform { size.x } else { mean },
            uniform,
        }
    }
}

/// Round shapes stay round, with radii that grow by the mean factor.
impl Map for Transform {
    fn point(&self, point: DVec3) -> DVec3 {
        self.linear * point + self.shift
    }

    fn vector(&self, vector: DVec3) -> DVec3 {
        self.linear * vector
    }

    fn normal(&self, normal: DVec3) -> DVec3 {
        (self.linear.inverse().transpose() * normal).normalize_or(normal)
    }

    fn axes(&self, [u, v]: [DVec3; 2]) -> [DVec3; 2] {
        let along = (self.linear * u).normalize_or(u);
        let turned = self.linear * v;
        // Perpendicular again, which rounding or uneven scaling may have spoiled.
        let across = turned - along * along.dot(turned);
        [along, across.normalize_or(v)]
    }

    fn length(&self, length: f64) -> f64 {
        length * self.growth
    }

    fn affine(&self) -> DAffine3 {
        DAffine3::from_mat3_translation(self.linear, self.shift)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use field::Skeleton;
    use scene::{Cuboid, Quadric};

    fn point_at(shape: &Shape, share: f64) -> DVec3 {
        shape.skeleton().expect("a bone").at(share)
    }

    fn near(a: DVec3, b: DVec3) -> bool {
        a.distance(b) < 1e-12
    }

    #[test]
    fn axes() {
        assert_eq!(arc_axes(DVec3::Z), (DVec3::X, DVec3::Y));
        assert_eq!(arc_axes(DVec3::NEG_Z), (DVec3::X, DVec3::NEG_Y));
        let (u, v) = arc_axes(DVec3::X);
        assert_eq!((u, v), (DVec3::Y, DVec3::Z));
    }

    #[test]
    fn arcs_turn_as_the_language_says() {
        // The seahorse's tail: each arc begins where the last one ends.
        let first = arc(
            DVec3::new(0.2, -2.0, 0.0),
            DVec3::NEG_Z,
            1.0,
            0.25,
            90.0,
            90.0,
        );
        let next = arc(
            DVec3::new(-0.3, -2.0, 0.0),
            DVec3::NEG_Z,
            0.5,
            0.25,
            180.0,
            90.0,
        );
        assert!(near(point_at(&first, 1.0), point_at(&next, 0.0)));
        let back = arc(DVec3::ZERO, DVec3::Z, 1.0, 0.1, 90.0, -90.0);
        assert!(near(point_at(&back, 0.0), DVec3::Y));
        assert!(near(point_at(&back, 1.0), DVec3::X));
        let full = arc(DVec3::ZERO, DVec3::Z, 1.0, 0.1, 0.0, 1000.0);
        assert!(near(point_at(&full, 0.5), DVec3::NEG_X));
    }

    #[test]
    fn arcs_pass_their_points() {
        let cases = [
            [DVec3::X, DVec3::Y, DVec3::NEG_X],
            [DVec3::X, DVec3::NEG_Y, DVec3::Y],
            [
                DVec3::new(1.0, 2.0, 3.0),
                DVec3::new(-1.0, 0.5, 2.0),
                DVec3::new(0.0, 7.0, -2.0),
            ],
        ];
        for [a, b, c] in cases {
            let ThreePoints::Arc(shape) = through(a, b, c, 0.1) else {
                panic!("no arc");
            };
            assert!(point_at(&shape, 0.0).distance(a) < 1e-12);
            assert!(point_at(&shape, 1.0).distance(c) < 1e-12);
            let nearest = (0..=1000)
                .map(|i| point_at(&shape, f64::from(i) / 1000.0).distance(b))
                .fold(f64::MAX, f64::min);
            assert!(nearest < 0.02, "{nearest}");
        }
    }

    #[test]
    fn degenerate_points() {
        let (a, b) = (DVec3::ZERO, DVec3::ONE);
        assert_eq!(through(a, a, b, 0.1), ThreePoints::Same);
        assert_eq!(through(a, b, a, 0.1), ThreePoints::Same);
        assert_eq!(through(a, a, a, 0.1), ThreePoints::Same);
        assert_eq!(through(a, b, b * 3.0, 0.1), ThreePoints::Line(a, b * 3.0));
        assert_eq!(through(a, b * 3.0, b, 0.1), ThreePoints::Line(a, b * 3.0));
    }

    #[test]
    fn transforms() {
        let shape = arc(DVec3::X, DVec3::Z, 2.0, 0.5, 10.0, 80.0);
        let turn = Transform::rotation(DVec3::Z, 90.0);
        let turned = shape.transform(&turn);
        for i in 0..=4 {
            let share = f64::from(i) / 4.0;
            assert!(near(
                point_at(&turned, share),
                turn.linear * point_at(&shape, share)
            ));
        }
        let mirror = Transform::scaling(DVec3::new(-2.0, 2.0, 2.0));
        assert!(mirror.uniform);
        let mirrored = shape.transform(&mirror);
        assert!(near(
            point_at(&mirrored, 0.7),
            mirror.linear * point_at(&shape, 0.7)
        ));
        assert_eq!(mirrored.radius(), 1.0);
        let plane = Shape::plane(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0).normalize(), 0.0);
        let uneven = Transform::scaling(DVec3::new(2.0, 1.0, 1.0));
        let plane = plane.transform(&uneven);
        let normal = plane
            .skeleton()
            .and_then(Skeleton::normal)
            .expect("a plane");
        // (1, −1, 0) in the plane becomes (2, −1, 0).
        assert!(normal.dot(DVec3::new(2.0, -1.0, 0.0)).abs() < 1e-12);
    }

    #[test]
    fn transforms_of_boxes_patches_and_quadrics() {
        let map = Transform {
            shift: DVec3::new(3.0, -1.0, 2.0),
            ..Transform::scaling(DVec3::new(2.0, 1.0, -0.5))
        };
        let axes = [DVec3::X, DVec3::new(0.2, 1.0, 0.0), DVec3::Z];
        let center = DVec3::ONE;
        let corner = |shape: &Shape| match shape {
            Shape::Box(Cuboid { center, axes }) => *center + axes[0] - axes[1] + axes[2],
            Shape::Quadric(q) => q.place(DVec3::new(1.0, -1.0, 1.0)),
            other => panic!("{other:?}"),
        };
        let quadric = Quadric {
            square: DMat3::IDENTITY,
            linear: DVec3::X,
            constant: -1.0,
            center,
            axes,
        };
        for shape in [
            Shape::cuboid(center, axes),
            Shape::Quadric(Box::new(quadric)),
        ] {
            assert!(near(
                corner(&shape.transform(&map)),
                map.point(corner(&shape))
            ));
        }
        // Normals stay across.
        let corners = [DVec3::ZERO, DVec3::new(1.0, 0.0, 1.0), DVec3::Y];
        let normals = [(corners[1]).cross(corners[2]); 3];
        let patch = Shape::patch(corners, normals).transform(&map);
        let bone = patch.bone().expect("a patch");
        let Skeleton::Triangle { corners } = bone.skeleton else {
            panic!("no patch");
        };
        let normals = bone.normals.as_ref().expect("a patch");
        for edge in [corners[1] - corners[0], corners[2] - corners[0]] {
            assert!(normals.iter().all(|n| n.dot(edge).abs() < 1e-12));
        }
        let cone = Shape::cone(DVec3::ZERO, 1.0, DVec3::X, 0.5);
        let twice = Transform::scaling(DVec3::splat(-2.0));
        let grown = Shape::cone(DVec3::ZERO, 2.0, DVec3::X * -2.0, 1.0);
        assert_eq!(cone.transform(&twice), grown);
    }
}
