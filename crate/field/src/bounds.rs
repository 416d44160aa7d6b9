//! Upper bounds on a primitive's field by distance from its skeleton, and the depth of influence.
//!
//! All in units of the kernel's width and for a factor of 1.
use crate::bone::Bone;
use crate::form::Form;
use crate::{Cut, Kernel, Skeleton, plane, skeleton};
use core::f64::consts::PI;
use glam::DVec3;

/// An upper bound on the form's field at all points at distance `d ≥ 0` or more from the skeleton.
/// It does not grow with d.
pub(crate) fn bound_at(form: &Form<f64>, d: f64) -> f64 {
    let kernel = form.kernel;
    match &form.bone {
        Bone::Point => kernel.value(d),
        Bone::Segment(segment) => abreast(kernel, 2.0 * segment.half, d),
        Bone::Arc(arc) => arc_bound(kernel, 2.0 * arc.half_angle * arc.radius, arc.radius, d),
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
        Bone::Plane => plane::jet(kernel, [0.0, 0.0, d]).value,
        Bone::Curve(curve) => curve.bound_at(kernel, d),
    }
}

/// A segment's field at distance d beside its middle. That is its largest at distance d: beside
/// it, the field falls away from the middle; beyond an end, by Pythagoras' inequality each point of
/// the segment is at least as far as it would be from a point at distance d beside that end.
fn abreast(kernel: Kernel, length: f64, d: f64) -> f64 {
    let segment = crate::bone::Segment { half: length / 2.0 };
    let form = Form {
        kernel,
        bone: Bone::Segment(segment),
    };
    form.jet([0.0, d, 0.0]).value
}

/// The field of any flat piece of this area: at most that of a disc of the same area around the foot
/// of a perpendicular of length d. For of the piece, what is within a distance r of the point is
/// within a disc of radius √(r²−d²), or, if the foot lies outside, within a ring of that area.
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

/// A bound on the field of an arc. The Cauchy kernel has a sharp one; for others see [`Coil`].
fn arc_bound(kernel: Kernel, length: f64, radius: f64, d: f64) -> f64 {
    let most = length * kernel.value(d);
    if kernel == Kernel::Cauchy {
        return most.at_most(circle(radius, d));
    }
    let outward = |a: f64, b: f64| kernel.between(a, b);
    most.at_most(Coil::arc(length, radius).bound(d, |u| kernel.value(u), outward))
}

/// How much of a bone can be near one place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coil {
    /// Its length.
    length: f64,
    /// Larger balls than this may hold all of it; …
    radius: f64,
    /// … one of a radius δ up to that holds no more than this times δ.
    gathers: f64,
}

impl Coil {
    /// Of an arc or a curve with a length, in units of the kernel's width.
    pub fn of(skeleton: &Skeleton, measure: f64, width: f64) -> Option<Self> {
        let length = measure * width;
        let [radius, gathers] = match skeleton {
            Skeleton::Arc { radius, .. } => [radius * width, PI],
            Skeleton::Curve { control } => [length, gathers(*control)],
            _ => return None,
        };
        (length > 0.0).then_some(Self {
            length,
            radius,
            gathers,
        })
    }

    /// Of an arc.
    fn arc(length: f64, radius: f64) -> Self {
        Self {
            length,
            radius,
            gathers: PI,
        }
    }

    /// A bound on the integral over the bone of a falling function g of the distance, at distance d or more.
    ///
    /// A ball of radius δ holds no more than κδ of the bone up to some radius r: of a circle πδ up to its own radius; of a
    /// curve see [`gathers`]. So with l the bone's length the integral is at most
    /// `κd·g(d) + κ∫g + (l−κr)·g(r)`, the integral from d to the smaller of r and l/κ.
    /// `outward(a, b)` is the integral of g from a to b, or more.
    pub fn bound(&self, d: f64, g: impl Fn(f64) -> f64, outward: impl Fn(f64, f64) -> f64) -> f64 {
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

/// A ball of radius δ holds no more than so many times δ of a Bézier curve.
///
/// Of a piece whose direction is nowhere further than φ from a mean one, 2δ/cos φ: along the mean direction all in the ball
/// is within 2δ. The directions are within the cone of the control polygon's sides. Of any cubic 18δ: each of its three
/// coordinates goes up and down no more than three times, within 2δ, and no piece is longer than its coordinates' ways
/// together.
fn gathers(control: [DVec3; 4]) -> f64 {
    const ANY: f64 = 18.0;
    let of_piece = |[a, b, c, d]: [DVec3; 4]| {
        let mean = (d - a).normalize_or_zero();
        let along = [b - a, c - b, d - c].map(|side| match side.try_normalize() {
            Some(way) => way.dot(mean),
            // What has no direction leads nowhere.
            None => 1.0,
        });
        let least = along.into_iter().fold(1.0, f64::min);
        if least * ANY > 2.0 { 2.0 / least } else { ANY }
    };
    let mut best = ANY;
    for pieces in 1..=6u32 {
        let mut sum = 0.0;
        let mut rest = control;
        for i in 0..pieces {
            let (piece, next) = skeleton::halves(rest, 1.0 / f64::from(pieces - i));
            sum += of_piece(piece);
            rest = next;
        }
        best = best.min(sum);
        // Nothing that is cut in more pieces could have less.
        if best <= 2.0 * f64::from(pieces + 1) {
            break;
        }
    }
    best
}

/// A bound on the Cauchy field of any arc of a circle at distance d or more from the arc.
///
/// Let the point's distance from the arc be δ ≥ d and ρ its distance from the axis. Along the arc,
/// on either side of the antipode of the point, the squared distance to the point at angle v from
/// the nearer end of that side (or from the nearest point) is at least `δ² + 4rρ sin²(v/2)`. So
/// the field is at most that of the full circle at the same δ and ρ, which falls with both, and
/// ρ ≥ r−δ. In the plane of the circle inside it, with a = δ, b = 2r−δ and P = ab, that is
/// `πr(2+4r²−2P)/(1+4r²−2P+P²)^{3/2}`: it rises with P up to the P* below (the field of a circle
/// is largest slightly inside), then falls to the centre. Further out than r it is at most
/// `2πr·h(d)`, its value on the axis.
fn circle(r: f64, d: f64) -> f64 {
    if d >= r {
        return 2.0 * PI * r * Kernel::Cauchy.value(d);
    }
    let k = 4.0 * r * r;
    let peak = 2.0 * (4.0 + k) / ((8.0 + 3.0 * k) + (9.0 * k * k + 32.0 * k).sqrt());
    let p = (d * (2.0 * r - d)).at_least(peak).at_most(r * r);
    let product = 1.0 + k - 2.0 * p + p * p;
    PI * r * (2.0 + k - 2.0 * p) / (product * product.sqrt())
}

/// The distance beyond which `factor·bound_at` is below `level`, or 0 if it is everywhere; a compact
/// kernel's support at most.
pub(crate) fn depth(form: &Form<f64>, factor: f64, level: f64) -> f64 {
    let below = |d: f64| factor * bound_at(form, d) < level;
    if below(0.0) {
        return 0.0;
    }
    if form.kernel.is_compact() {
        // A tapered bone's unit is the support where that is smallest.
        return match &form.bone {
            Bone::Curve(curve) => curve.support(),
            _ => 1.0,
        };
    }
    if let (Kernel::Gauss, Bone::Point) = (form.kernel, &form.bone) {
        return libm::log(factor / level).max(0.0).sqrt() * (1.0 + 1e-9);
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
