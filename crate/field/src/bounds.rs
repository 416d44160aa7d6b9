//! Upper bounds on a primitive's field by distance from its skeleton, and the depth of influence.
//!
//! All in units of the kernel's width and for a factor of 1.
use crate::term::Form;
use core::f64::consts::PI;

/// `1/(1+d²)²`, the kernel.
fn kernel(d: f64) -> f64 {
    let i = 1.0 / (1.0 + d * d);
    i * i
}

/// An upper bound on the form's field at all points at distance `d ≥ 0` or more from the skeleton.
/// It does not grow with d.
pub(crate) fn bound_at(form: &Form<f64>, d: f64) -> f64 {
    match form {
        Form::Point(_) => kernel(d),
        Form::Segment(segment) => abreast(2.0 * segment.half, d),
        Form::Arc(arc) => {
            let length = 2.0 * arc.half_angle * arc.radius;
            (length * kernel(d)).min(circle(arc.radius, d))
        }
        Form::Triangle(triangle) => {
            let area = triangle.double_area.abs() / 2.0;
            let longest = triangle.edges.iter().fold(0.0, |l, e| e.length.max(l));
            // Cut into lines along the longest side: each is a segment no longer than it, at
            // distance d or more, and they fill the altitude.
            let altitude = if longest > 0.0 {
                2.0 * area / longest
            } else {
                0.0
            };
            (area * kernel(d))
                .min(PI / (1.0 + d * d))
                .min(altitude * abreast(longest, d))
        }
        Form::Plane(_) => PI / (1.0 + d * d),
    }
}

/// A segment's field at distance d beside its middle. That is its largest at distance d: beside
/// it, the field falls away from the middle; beyond an end, by Pythagoras' inequality each point of
/// the segment is at least as far as it would be from a point at distance d beside that end.
fn abreast(length: f64, d: f64) -> f64 {
    use crate::cauchy::Segment;
    Segment { half: length / 2.0 }.jet([0.0, d, 0.0]).value
}

/// A bound on the field of any arc of a circle at distance d or more from the arc.
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
        return 2.0 * PI * r * kernel(d);
    }
    let k = 4.0 * r * r;
    let peak = 2.0 * (4.0 + k) / ((8.0 + 3.0 * k) + (9.0 * k * k + 32.0 * k).sqrt());
    let p = (d * (2.0 * r - d)).max(peak).min(r * r);
    let product = 1.0 + k - 2.0 * p + p * p;
    PI * r * (2.0 + k - 2.0 * p) / (product * product.sqrt())
}

/// The distance beyond which `factor·bound_at` is below `level`, or 0 if it is everywhere.
pub(crate) fn depth(form: &Form<f64>, factor: f64, level: f64) -> f64 {
    let below = |d: f64| factor * bound_at(form, d) < level;
    if below(0.0) {
        return 0.0;
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
