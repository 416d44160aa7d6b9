//! How fast a field can change: bounds on its slope and on its fourth derivative along any line.
//!
//! The fourth derivative bounds the error of the cubic Hermite interpolant on a span of length h:
//! `|error| ≤ max|f⁗|·h⁴/384`.
//!
//! For the kernel of unit width and height, with D = 1+r² and the direction at the cosine κ to the
//! radius, `h⁗ = 24(80y²−48y+3)/D⁴`, y = κ²r²/D. So |h⁗| ≤ 72 everywhere (at the centre), and ≤ 840/D⁴. For
//! a skeleton the bound is the integral of the kernel's: the largest such integral over a line is
//! below 80, and over a plane below 100 (these are sums of the decreasing envelope of the above;
//! the exact values for directions across are 45π/2 and 24π).
use crate::term::Form;
use core::f64::consts::{FRAC_PI_3, PI};

/// Bound on |h⁗|.
const POINT: f64 = 72.0;
/// Bound on its integral along a straight line.
const LINE: f64 = 80.0;
/// Bound on its integral over a plane.
const PLANE: f64 = 100.0;
/// `|h⁗| ≤ FAR/(1+r²)⁴`.
const FAR: f64 = 840.0;

/// A bound on |f⁗| along any line, at distance d or more from the form (kernel widths).
pub(crate) fn fourth_derivative(form: &Form<f64>, d: f64) -> f64 {
    let q = 1.0 + d * d;
    let root = q.sqrt();
    let point = POINT.min(FAR / (q * q * q * q));
    // ∫ du/(q+u²)⁴ = 5π/16·q^(−7/2), ∬ = π/3·q⁻³.
    let line = LINE.min(FAR * 5.0 * PI / 16.0 / (q * q * q * root));
    let plane = PLANE.min(FAR * PI / 3.0 / (q * q * q));
    let far = |r: f64| {
        let q = 1.0 + r * r;
        FAR / (q * q * q * q)
    };
    let line = match form {
        // A circle may keep at distance d for long: all that a ball of radius d can hold of it is
        // counted there, and the rest as if on a line.
        Form::Arc(_) => LINE.min(2.0 * d * far(d) + 2.0 * FAR / 7.0 / (d * d * d * d * d * d * d)),
        _ => line,
    };
    over(form, point, line, plane, far)
}

/// A bound on |∇f|.
pub(crate) fn slope(form: &Form<f64>) -> f64 {
    // |h′| is largest at r = 1/√5.
    const KERNEL: f64 = 1.035_22;
    // Across a line at most that of the infinite one (at r = ½), along it the difference of the
    // kernel at two points.
    const ACROSS_LINE: f64 = 1.348_8;
    // Across a plane at most that of the infinite one (at r = 1/√3); along it the difference of the
    // kernel's integrals over two curves, each at most that over a line.
    const ACROSS_PLANE: f64 = 2.040_6;
    match form {
        Form::Point(_) => KERNEL,
        Form::Plane(_) => ACROSS_PLANE,
        Form::Segment(segment) => {
            (KERNEL * 2.0 * segment.half).min((ACROSS_LINE * ACROSS_LINE + 1.0).sqrt())
        }
        Form::Triangle(_) => {
            let flat = (ACROSS_PLANE * ACROSS_PLANE + PI * PI / 4.0).sqrt();
            // 2.315 is the integral over a line of the envelope of |h′|.
            over(form, KERNEL, 2.315, flat, |_| KERNEL)
        }
        Form::Arc(_) => over(form, KERNEL, 2.315, 0.0, |r| {
            let q = 1.0 + r * r;
            4.0 * r / (q * q * q)
        }),
    }
}

/// A bound on |f|: the integral of the kernel.
pub(crate) fn size(form: &Form<f64>) -> f64 {
    crate::bounds::bound_at(form, 0.0)
}

/// A bound on the integral over a form of a function of the distance from any point, given its
/// largest value, its largest integrals over a line and a plane, and (for arcs) a bound on it at
/// distance r or more, for r ≥ 1.
fn over(form: &Form<f64>, point: f64, line: f64, plane: f64, far: impl Fn(f64) -> f64) -> f64 {
    match form {
        Form::Point(_) => point,
        Form::Segment(segment) => (2.0 * segment.half * point).min(line),
        Form::Arc(arc) => {
            // Within a ball of radius b ≤ r/2 lies at most 2r·arcsin(b/r) ≤ (π/3)·2b of a circle,
            // so the nearer part is bounded by π/3 times a line; the rest is at r/2 or more.
            let length = 2.0 * arc.half_angle * arc.radius;
            let half = arc.radius / 2.0;
            let rest = if half >= 1.0 {
                far(half).min(point)
            } else {
                point
            };
            (length * point).min(FRAC_PI_3 * line + length * rest)
        }
        Form::Triangle(triangle) => {
            let area = triangle.double_area.abs() / 2.0;
            let longest = triangle.edges.iter().fold(0.0, |l, e| e.length.max(l));
            let altitude = if longest > 0.0 {
                2.0 * area / longest
            } else {
                0.0
            };
            (area * point).min(altitude * line).min(plane)
        }
        Form::Plane(_) => plane,
    }
}
