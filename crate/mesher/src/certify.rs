//! Whether triangles are near the surface: by samples, which may be of
//! [polynomials](crate::patches), and by proofs, which are not.
//!
//! Let a triangle have the unit normal n, and let all points of it be outside the surface when they
//! are moved by d·n, and inside when moved by −d·n. Then on each of these ways is a point of the
//! surface: no point of the triangle is farther from it than d. That is proved for parts of the
//! triangle in balls of radius ρ, by bounds C and D on the function's second and third derivative
//! in them. F is within ½·C·ρ² of the linear function with its values at the corners (Waldron
//! 1998). And it is within D·ρ³/6 of Taylor's polynomial of the second degree at the centre, and
//! their gradients within D·ρ²/2. That polynomial is no larger or smaller than its Bézier
//! coefficients: its values at corners, and values plus half the slope along edges, which F's own
//! are as near to as that. (Terms whose second derivative jumps add their curvature times ρ²/2 and
//! ρ.)

use crate::options::{MeshError, Progress};
use crate::parallel::map_told;
use crate::space::{SLACK, Space};
use field::{Ball, Jet, THRESHOLD, Variation};
use glam::DVec3;

/// A vertex of the mesh: position, and the function there.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// Position.
    pub position: DVec3,
    /// Value less the threshold.
    pub value: f64,
    /// Gradient.
    pub gradient: DVec3,
}

impl Vertex {
    /// The function at a position.
    pub fn new(position: DVec3, jet: &Jet<f64>) -> Self {
        Self {
            position,
            value: jet.value - THRESHOLD,
            gradient: DVec3::from_array(jet.gradient),
        }
    }

    /// Outward unit normal of the level set; 0 where the gradient is.
    pub fn normal(&self) -> DVec3 {
        -self.gradient.normalize_or_zero()
    }

    /// Returns a first-order estimate of the distance from the surface: (T − F)/|∇F| outside, and
    /// inside that of the logarithm, F·ln(F/T)/|∇F|, which is the larger one there: fields that
    /// fall off as steeply as Gaussians are far above the threshold a little way in.
    pub fn distance(&self) -> f64 {
        let way = if self.value > 0.0 {
            (THRESHOLD + self.value) * libm::log1p(self.value / THRESHOLD)
        } else {
            -self.value
        };
        way / self.gradient.length()
    }
}

/// Centre and radius of the smallest ball around a triangle.
fn ball([a, b, c]: &[DVec3; 3]) -> Ball {
    let sides = [(*b, *c), (*c, *a), (*a, *b)];
    let longest = (0..3).max_by(|i, j| {
        let length = |k: usize| sides[k].0.distance_squared(sides[k].1);
        length(*i).total_cmp(&length(*j))
    });
    let i = longest.unwrap_or(0);
    let (p, q) = sides[i];
    let opposite = [*a, *b, *c][i];
    let (u, v) = (p - opposite, q - opposite);
    if u.dot(v) <= 0.0 {
        return Ball {
            center: 0.5 * (p + q),
            radius: 0.5 * p.distance(q),
        };
    }
    let n = u.cross(v);
    let to = (u.length_squared() * v.cross(n) + v.length_squared() * n.cross(u))
        / (2.0 * n.length_squared());
    Ball {
        center: opposite + to,
        radius: to.length() * (1.0 + 1e-9),
    }
}

/// Twice the area of a triangle over the square of its longest side, below which it counts as flat.
const FLAT: f64 = 1e-7;

/// Barycentric coordinates of the points where each triangle is sampled.
const FEW_SAMPLES: [[f64; 3]; 4] = [
    [1.0 / 3.0; 3],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.5],
    [0.5, 0.0, 0.5],
];
/// Barycentric coordinates of further points, for triangles far from the surface or turned from it.
const MORE_SAMPLES: [[f64; 3]; 9] = [
    [0.6, 0.2, 0.2],
    [0.2, 0.6, 0.2],
    [0.2, 0.2, 0.6],
    [0.75, 0.25, 0.0],
    [0.25, 0.75, 0.0],
    [0.0, 0.75, 0.25],
    [0.0, 0.25, 0.75],
    [0.75, 0.0, 0.25],
    [0.25, 0.0, 0.75],
];
/// Largest [`sag`] of an edge, in tolerances, at which one sample is enough for a triangle whose
/// corners' normals are near its own.
pub const EASY: f64 = 0.05;
/// Least cosine of the angle between a corner's normal and the triangle's at which one sample is
/// enough.
const EVEN: f64 = 0.95;
/// The least cosine of the angle between a triangle's normal and the surface's anywhere.
const FACING: f64 = 0.3;
/// Largest distance from the surface by a first-order estimate, in tolerances, of a point that may
/// be within the tolerance.
const FARTHEST: f64 = 2.0;
/// Least cosine of the angle between a triangle's normal and the surface's at which the first
/// samples are enough.
const FLUSH: f64 = 0.9;
/// Largest distance from the surface, in tolerances, at which the first samples are enough.
const NEAR: f64 = 0.3;

/// The distance of a triangle from the surface as samples tell it; `None` if it is more than the
/// tolerance, or if the triangle is turned away from the surface somewhere.
pub fn estimate(space: &Space<'_>, corners: [&Vertex; 3], tolerance: f64) -> Option<f64> {
    let normal = normal(corners.map(|v| v.position))?;
    let (mut most, mut facing) = (0.0_f64, 1.0_f64);
    let mut look = |vertex: &Vertex| {
        let steep = -vertex.gradient.dot(normal);
        let cosine = steep / vertex.gradient.length();
        let distance = vertex.value.abs() / steep;
        // Not so for NaN.
        let is_likely = cosine >= FACING && distance <= FARTHEST * tolerance;
        if !is_likely {
            return None;
        }
        if distance > NEAR * tolerance {
            // To first order alone this is not known: the surface has to be passed on the way.
            let way = normal
                * if vertex.value > 0.0 {
                    tolerance
                } else {
                    -tolerance
                };
            let beyond = space.near_jet_at(vertex.position + way).value - THRESHOLD;
            if (beyond > 0.0) == (vertex.value > 0.0) {
                return None;
            }
        }
        most = most.max(distance.min(tolerance));
        facing = facing.min(cosine);
        Some((most, facing))
    };
    for corner in corners {
        look(corner)?;
    }
    let at = |[u, v, w]: [f64; 3]| {
        let [a, b, c] = corners.map(|corner| corner.position);
        let point = a * u + b * v + c * w;
        Vertex::new(point, &space.near_jet_at(point))
    };
    let [a, b, c] = corners;
    let is_easy = is_even(corners, normal)
        && [(a, b), (b, c), (c, a)]
            .iter()
            .all(|(one, other)| sag(one, other) <= EASY * tolerance);
    let mut found = (0.0, 1.0);
    for shares in &FEW_SAMPLES[..if is_easy { 1 } else { FEW_SAMPLES.len() }] {
        found = look(&at(*shares))?;
    }
    let (distance, facing) = found;
    if distance > NEAR * tolerance || facing < FLUSH {
        for shares in MORE_SAMPLES {
            found = look(&at(shares))?;
        }
    }
    Some(found.0)
}

/// Whether a triangle's corners all look nearly the way that it does.
fn is_even(corners: [&Vertex; 3], normal: DVec3) -> bool {
    corners
        .iter()
        .all(|corner| corner.normal().dot(normal) >= EVEN)
}

/// The height of a circular arc between two vertices with their normals.
pub fn sag(one: &Vertex, other: &Vertex) -> f64 {
    let turn = (one.normal() - other.normal()).dot(one.position - other.position);
    turn.abs() / 8.0
}

/// The unit normal of a triangle; `None` if it is so flat that it would be noise.
fn normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let cross = (b - a).cross(c - a);
    let longest = a
        .distance_squared(b)
        .max(b.distance_squared(c))
        .max(c.distance_squared(a));
    if cross.length() <= FLAT * longest {
        return None;
    }
    cross.try_normalize()
}

/// Most times that a triangle is divided into four for its proof.
const DEPTH: u32 = 3;
/// Ways along the normal on which the surface is looked for, in tolerances: short ones for parts
/// that are thinner.
const WAYS: [f64; 2] = [1.0, 0.25];

/// Whether no point of a triangle is farther from the surface than the tolerance, as proved: all
/// points that are so far in front of it are outside, and all that are so far behind it inside.
pub fn is_within(space: &Space<'_>, corners: [DVec3; 3], tolerance: f64) -> bool {
    let Some(normal) = normal(corners) else {
        return false;
    };
    WAYS.iter().any(|way| {
        let way = normal * (way * tolerance);
        let beside = |way: DVec3| corners.map(|corner| at(space, corner + way));
        is_between(space, [beside(way), beside(-way)], 0)
    })
}

/// The function anywhere, as it is.
pub fn at(space: &Space<'_>, point: DVec3) -> Vertex {
    Vertex::new(point, &space.jet_at(point))
}

/// Whether the first of two triangles is outside the surface and the second one inside, after
/// `depth` divisions.
fn is_between(space: &Space<'_>, pair: [[Vertex; 3]; 2], depth: u32) -> bool {
    let [front, back] = pair;
    let sides = [(&front, -1.0), (&back, 1.0)].map(|(corners, sign)| height(space, corners, sign));
    let [Some(front_height), Some(back_height)] = sides else {
        return false;
    };
    if front_height.min(back_height) > 0.0 {
        return true;
    }
    if depth == DEPTH {
        return false;
    }
    let divided = pair.map(|corners| {
        let [a, b, c] = corners;
        let middle = |a: &Vertex, b: &Vertex| at(space, a.position.midpoint(b.position));
        let [ab, bc, ca] = [middle(&a, &b), middle(&b, &c), middle(&c, &a)];
        // Where triangles fail to be proved it is mostly in the middle.
        [[ab, bc, ca], [a, ab, ca], [ab, b, bc], [ca, bc, c]]
    });
    let [front, back] = divided;
    front
        .into_iter()
        .zip(back)
        .all(|(front, back)| is_between(space, [front, back], depth + 1))
}

/// A lower bound on the function less the threshold, times a sign, in a triangle; `None` if it is
/// not positive at a corner.
fn height(space: &Space<'_>, corners: &[Vertex; 3], sign: f64) -> Option<f64> {
    let [error, steep_error] = space.worst_error();
    let lowest = corners.iter().map(|v| sign * v.value);
    let lowest = lowest.fold(f64::INFINITY, f64::min) - SLACK - error;
    // Not so for NaN.
    let is_on_side = lowest > 0.0;
    if !is_on_side {
        return None;
    }
    let control = |one: &Vertex, other: &Vertex| {
        sign * (one.value + 0.5 * one.gradient.dot(other.position - one.position))
    };
    let [a, b, c] = corners;
    let edges = [(a, b), (b, c), (c, a)];
    let bezier = edges.into_iter().fold(lowest, |least, (one, other)| {
        least.min(control(one, other)).min(control(other, one))
    });
    let longest = edges
        .into_iter()
        .map(|(one, other)| one.position.distance(other.position));
    let longest = longest.fold(0.0, f64::max);
    let ball = ball(&corners.map(|v| v.position));
    let radius = ball.radius;
    let Variation {
        curvature,
        third,
        rough,
        jump,
        step,
        ..
    } = space.variation(space.part_for(ball), ball);
    // How far the function and its gradient are from Taylor's polynomial of the second degree at
    // the centre.
    let off = ((third * radius / 3.0 + rough).min(curvature) * 0.5 * radius + jump) * radius;
    let steep_off =
        (0.5 * third * radius + rough).min(curvature) * radius + jump + SLACK + steep_error;
    // Its values at corners are that far from the function's, and its coefficients at edges further
    // by half of them times the slopes' error.
    let quadratic = bezier - 2.0 * off - 0.5 * steep_off * longest;
    let linear = lowest - (0.5 * curvature * radius + 2.0 * jump) * radius;
    Some(quadratic.max(linear) - step - SLACK - error)
}

/// The place of the surface on a segment between two points where the function, less the threshold,
/// has other signs: as a share of the way, between `margin` and 1 − `margin`. By false position
/// with the slopes that were met on the way.
pub fn root(space: &Space<'_>, [a, b]: [DVec3; 2], [at_a, at_b]: [f64; 2], margin: f64) -> Vertex {
    let part = space.part_for(Ball {
        center: 0.5 * (a + b),
        radius: 0.5 * a.distance(b),
    });
    // Exact where the segment is across an axis.
    let at = |share: f64| a + (b - a) * share;
    let evaluate = |share: f64| Vertex::new(at(share), &space.jet(part, at(share)));
    let (mut low, mut high) = ((0.0, at_a), (1.0, at_b));
    let mut share = at_a / (at_a - at_b);
    let mut vertex = evaluate(share);
    for _ in 0..4 {
        let slope = vertex.gradient.dot(b - a);
        if (vertex.value > 0.0) == (at_a > 0.0) {
            low = (share, vertex.value);
        } else {
            high = (share, vertex.value);
        }
        let newton = share - vertex.value / slope;
        let next = if newton > low.0 && newton < high.0 {
            newton
        } else {
            low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1)
        };
        let next = next.clamp(margin, 1.0 - margin);
        let is_done = (next - share).abs() < 1e-5;
        share = next;
        if is_done {
            break;
        }
        vertex = evaluate(share);
    }
    vertex
}

/// The point of the surface that is reached from a position along gradients, by a few steps of
/// Newton's; not farther than `reach`. Polynomials may stand for the function.
pub fn project(space: &Space<'_>, position: DVec3, reach: f64, tolerance: f64) -> Option<Vertex> {
    let near = |point| Vertex::new(point, &space.near_jet_at(point));
    steps(near, position, reach, tolerance)
}

/// [`project`] with values of the function itself, never of polynomials: for measurements.
pub fn project_exactly(
    space: &Space<'_>,
    position: DVec3,
    reach: f64,
    tolerance: f64,
) -> Option<Vertex> {
    steps(|point| at(space, point), position, reach, tolerance)
}

/// Newton's steps along gradients from a position to the surface;
/// `None` if they lead farther away than `reach`.
fn steps(
    vertex_at: impl Fn(DVec3) -> Vertex,
    position: DVec3,
    reach: f64,
    tolerance: f64,
) -> Option<Vertex> {
    let mut vertex = vertex_at(position);
    for _ in 0..4 {
        let step = vertex.gradient * (-vertex.value / vertex.gradient.length_squared());
        let length = step.length();
        if length <= 1e-3 * tolerance {
            return Some(vertex);
        }
        let next = vertex.position + step;
        // Not so for NaN.
        let is_near = next.distance(position) <= reach;
        if !is_near {
            return None;
        }
        vertex = vertex_at(next);
    }
    None
}

/// Returns the part of the space for a point, with the point.
fn place(space: &Space<'_>, point: DVec3) -> (u32, DVec3) {
    let ball = Ball {
        center: point,
        radius: 0.0,
    };
    (space.part_for(ball), point)
}

/// The function where Newton's steps along gradients lead from each of some positions, none longer
/// than the length beside it: eight at a time, as well as places within the tolerance need it.
///
/// # Errors
/// If the caller cancels.
pub fn descend(
    space: &Space<'_>,
    goals: &[(DVec3, f64)],
    steps: usize,
    tolerance: f64,
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<Vec<Vertex>, MeshError> {
    let mut places = map_told(threads, goals, progress, |(point, _)| place(space, *point))?;
    let mut left = steps;
    loop {
        let jets = space.jets_in_parts(&places, tolerance, threads, progress)?;
        let found = places.iter().zip(&jets);
        let found: Vec<Vertex> = found.map(|((_, p), jet)| Vertex::new(*p, jet)).collect();
        if left == 0 {
            return Ok(found);
        }
        left -= 1;
        for ((own, vertex), (_, longest)) in places.iter_mut().zip(&found).zip(goals) {
            let way = vertex.gradient * (-vertex.value / vertex.gradient.length_squared());
            let next = vertex.position + way.clamp_length_max(*longest);
            if next.is_finite() {
                *own = place(space, next);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forest::Forest;
    use crate::surface::box_of;
    use field::{BlobScale, Implicit, Kernel, Primitive, Shaping, Skeleton, Sum};
    use trials::{Random, count};

    fn sum(kernel: Kernel, n: &mut Random) -> Sum {
        let shaping = Shaping {
            kernel,
            radius: n.range(0.2, 0.5),
            blobbiness: 2.0,
            blob_scale: BlobScale::Relative,
            strength: 1.0,
            influence: 1e-3,
            taper: None,
        };
        let limb = |base: DVec3| Skeleton::Segment {
            base,
            apex: base + n.vector(1.0),
        };
        let limbs = [DVec3::ZERO, DVec3::X].map(limb);
        let limbs = limbs.into_iter();
        limbs
            .filter_map(|limb| Primitive::new(limb, &shaping, None))
            .collect()
    }

    #[test]
    fn what_is_proved_of_triangles_is_true_at_all_their_points() {
        let mut n = Random::new(5);
        let (mut proved, mut refuted) = (0, 0);
        for trial in 0..count(240) {
            let kernel = [Kernel::Gauss, Kernel::Cauchy, Kernel::Quartic][trial % 3];
            let sum = sum(kernel, &mut n);
            let domain = box_of(sum.support().unwrap());
            let size = (domain.max - domain.min).max_element();
            let space = Space::new(&sum, Forest::new(&domain, 0.01 * size, 0), 0.01);
            for _ in 0..40 {
                let Some(start) = project(&space, n.vector(0.7), 1.0, 1e-3) else {
                    continue;
                };
                let reach = n.range(0.02, 0.32);
                let corner = |n: &mut Random| {
                    let near = start.position + n.vector(1.0) * reach;
                    project(&space, near, 1.0, 1e-3).map(|vertex| vertex.position)
                };
                let corners = [corner(&mut n), corner(&mut n), corner(&mut n)];
                let [Some(a), Some(b), Some(c)] = corners else {
                    continue;
                };
                let tolerance = reach * reach * n.unit();
                let Some(normal) = normal([a, b, c]) else {
                    continue;
                };
                let value = |p: DVec3| sum.jet(p).value - THRESHOLD;
                let is_true = (0..300).all(|_| {
                    let p = n.in_triangle([a, b, c]);
                    WAYS.iter().any(|way| {
                        let way = normal * (way * tolerance);
                        value(p + way) < 0.0 && value(p - way) > 0.0
                    })
                });
                if is_within(&space, [a, b, c], tolerance) {
                    assert!(is_true, "{kernel:?} {a} {b} {c} {tolerance}");
                    proved += 1;
                } else if !is_true {
                    refuted += 1;
                }
            }
        }
        assert!(
            proved > count(100) && refuted > count(100),
            "{proved} {refuted}"
        );
    }

    #[test]
    fn function_is_nowhere_lower_in_a_triangle_than_told() {
        let mut n = Random::new(8);
        let (mut told, mut sharp) = (0, 0);
        for trial in 0..count(150) {
            let kernel = [Kernel::Gauss, Kernel::Cauchy, Kernel::Quartic][trial % 3];
            let sum = sum(kernel, &mut n);
            let domain = box_of(sum.support().unwrap());
            let size = (domain.max - domain.min).max_element();
            let space = Space::new(&sum, Forest::new(&domain, 0.01 * size, 0), 0.01);
            for _ in 0..200 {
                let start = n.vector(0.8);
                let reach = n.range(0.02, 0.22);
                let corners = [(); 3].map(|()| at(&space, start + n.vector(1.0) * reach));
                let sign = if corners[0].value > 0.0 { 1.0 } else { -1.0 };
                let Some(height) = height(&space, &corners, sign) else {
                    continue;
                };
                let [a, b, c] = corners.map(|corner| corner.position);
                let lowest = (0..100).map(|_| sign * at(&space, n.in_triangle([a, b, c])).value);
                let lowest = lowest.fold(f64::INFINITY, f64::min);
                assert!(
                    lowest >= height,
                    "{kernel:?} {a} {b} {c}: {lowest} {height}"
                );
                told += 1;
                sharp += usize::from(height > 0.5 * lowest);
            }
        }
        assert!(told > count(1000) && sharp > count(300), "{told} {sharp}");
    }
}
