//! Depth of influence, and the upper bounds on a field by distance from which it follows.
//!
//! All lengths are in kernel widths, all fields for a factor of 1.
use crate::bone::Bone;
use crate::form::Form;
use crate::kernel::Tail;
use crate::{Cut, Kernel, Skeleton, skeleton};
use core::f64::consts::PI;
use glam::DVec3;

/// Returns an upper bound on the form's field at all points at distance `d ≥ 0` or more from the
/// skeleton. It does not grow with d.
pub(crate) fn most_beyond(form: &Form<f64>, d: f64) -> f64 {
    let kernel = form.kernel;
    match &form.bone {
        Bone::Point => kernel.value(d),
        Bone::Segment(segment) => abreast(kernel, 2.0 * segment.half, d),
        Bone::Arc(arc) => {
            let length = 2.0 * arc.half_angle * arc.radius;
            let bound = kernel.arc_at_most(length, arc.radius, d);
            (length * kernel.value(d)).at_most(bound)
        }
        Bone::Triangle(triangle) => {
            let area = triangle.double_area.abs() / 2.0;
            let longest = triangle.edges.iter().fold(0.0, |l, e| e.length.max(l));
            // Cut into lines along the longest side: each is a segment no longer than it, at
            // distance d or more, and they fill the altitude.
            let altitude = if longest > 0.0 {
                2.0 * area / longest
            } else {
                0.0
            };
            disc(kernel, area, d).at_most(altitude * abreast(kernel, longest, d))
        }
        Bone::Polygon(polygon) => disc(kernel, polygon.area.abs(), d),
        Bone::Plane => kernel.plane(d).0,
        Bone::Curve(curve) => curve.most_beyond(kernel, d),
    }
}

/// Computes a segment's field at distance d beside its middle. That is its largest at distance d:
/// beside it, the field falls away from the middle; beyond an end, by Pythagoras' inequality each
/// point of the segment is at least as far as it would be from a point at distance d beside that
/// end.
fn abreast(kernel: Kernel, length: f64, d: f64) -> f64 {
    let segment = crate::bone::Segment { half: length / 2.0 };
    let form = Form {
        kernel,
        bone: Bone::Segment(segment),
    };
    form.jet([0.0, d, 0.0]).value
}

/// Bound on the field of any planar region of this area at distance d: the field of a disc of the
/// same area around the foot of a perpendicular of length d. The part of the region within a
/// distance r of the point lies within a disc of radius √(r²−d²), or, if the foot lies outside,
/// within a ring of that area.
fn disc(kernel: Kernel, area: f64, d: f64) -> f64 {
    let q = d * d;
    // The difference of two integrals, unless it would have lost its digits.
    let whole = PI * kernel.over_ring(q, q + area / PI);
    let most = area * kernel.value(d);
    if whole.is_finite() && whole > 1e-9 * most {
        most.at_most(whole * (1.0 + 1e-6))
    } else {
        most
    }
}

/// Bound on the length of a bone within a ball: `gathers·δ` for a radius δ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crowding {
    /// Length of the bone.
    length: f64,
    /// Largest radius δ for which the bound holds; larger balls may hold the whole bone.
    radius: f64,
    /// Largest length within a ball, over the ball's radius.
    gathers: f64,
}

impl Crowding {
    /// The bound for an arc or a curve of length `measure`, in kernel widths; `None` for other
    /// skeletons and without a length.
    pub fn of(skeleton: &Skeleton, measure: f64, width: f64) -> Option<Self> {
        let length = measure * width;
        let [radius, gathers] = match skeleton {
            Skeleton::Arc { radius, .. } => [radius * width, PI],
            line if line.is_numeric() => [length, line.cubics(0.0).into_iter().map(gathers).sum()],
            _ => return None,
        };
        (length > 0.0).then_some(Self {
            length,
            radius,
            gathers,
        })
    }

    /// The bound for an arc.
    pub fn arc(length: f64, radius: f64) -> Self {
        Self {
            length,
            radius,
            gathers: PI,
        }
    }

    /// Returns a bound on the integral over the bone of a decreasing function g of the distance, at
    /// distance d or more.
    ///
    /// A ball of radius δ ≤ r holds at most the length κδ of the bone: for a circle κ = π and r is
    /// its radius; for a curve see [`gathers`]. So with l the bone's length the integral is at most
    /// `κd·g(d) + κ∫g + (l−κr)·g(r)`, the integral from d to the smaller of r and l/κ.
    /// `outward(a, b)` is the integral of g from a to b, or more.
    pub fn integral_bound(
        &self,
        d: f64,
        g: impl Fn(f64) -> f64,
        outward: impl Fn(f64, f64) -> f64,
    ) -> f64 {
        let Self {
            length,
            radius,
            gathers,
        } = *self;
        let end = radius.at_most(length / gathers);
        if d >= end {
            return length * g(d);
        }
        let rest = (length - gathers * radius).at_least(0.0);
        gathers * (d * g(d) + outward(d, end)) + rest * g(radius)
    }
}

/// Returns κ such that a ball of any radius δ holds at most the length κδ of a Bézier curve.
///
/// A piece whose directions are within φ of a mean direction has at most 2δ/cos φ in the ball,
/// since along the mean direction the ball is 2δ wide; its directions are within the cone of the
/// control polygon's sides. Any cubic has at most 18δ: each of its three coordinates has at most
/// three monotonic pieces, each within 2δ, and a curve is no longer than the sum of its
/// coordinates' variations.
fn gathers(control: [DVec3; 4]) -> f64 {
    const ANY: f64 = 18.0;
    let mut best = ANY;
    for pieces in 1..=6u32 {
        let mut sum = 0.0;
        let mut rest = control;
        for i in 0..pieces {
            let (piece, next) = skeleton::halves(rest, 1.0 / f64::from(pieces - i));
            let [a, b, c, d] = piece;
            let mean = (d - a).normalize_or_zero();
            let along = [b - a, c - b, d - c].map(|side| match side.try_normalize() {
                Some(way) => way.dot(mean),
                // A control polygon without a direction has no length.
                None => 1.0,
            });
            let least = along.into_iter().fold(1.0, f64::min);
            sum += if least * ANY > 2.0 { 2.0 / least } else { ANY };
            rest = next;
        }
        best = best.min(sum);
        // More pieces cannot give less.
        if best <= 2.0 * f64::from(pieces + 1) {
            break;
        }
    }
    best
}

/// The distance beyond which `factor·most_beyond` is below `level`, or 0 if it is everywhere; a
/// compact kernel's support at most.
pub(crate) fn depth(form: &Form<f64>, factor: f64, level: f64) -> f64 {
    let below = |d: f64| factor * most_beyond(form, d) < level;
    if below(0.0) {
        return 0.0;
    }
    if form.kernel.is_compact() {
        // A tapered bone's unit of length is its smallest support.
        return match &form.bone {
            Bone::Curve(curve) => curve.support(),
            _ => 1.0,
        };
    }
    if let (Tail::Fast, Bone::Point) = (form.kernel.tail(), &form.bone) {
        return form.kernel.square_of(factor / level).max(0.0).sqrt() * (1.0 + 1e-9);
    }
    let mut outside = 1.0;
    while !below(outside) {
        outside *= 2.0;
        if !f64::is_finite(outside) {
            return f64::INFINITY;
        }
    }
    let mut inside = 0.0;
    // Rounding outward, to 10⁻⁹ of itself.
    while outside - inside > 1e-9 * outside {
        let middle = 0.5 * (inside + outside);
        if below(middle) {
            outside = middle;
        } else {
            inside = middle;
        }
    }
    outside
}
