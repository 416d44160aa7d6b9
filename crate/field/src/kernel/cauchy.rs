//! The Cauchy kernel `h(r) = 1/(1+s²r²)²` (thesis, sections 2.3.1 and 2.4).
//!
//! Closed forms work in the primitive's own frame, in units of the kernel's width: lengths are
//! multiplied by s, so that the kernel is `1/(1+r²)²`. Each file states its formula. They equal the
//! thesis's, rearranged so that nearly equal numbers are not subtracted: then single precision
//! suffices, and there are no special cases at axes, ends, edges or far away.
use crate::bone::Bone;
use crate::envelope::Roughness;
use crate::kernel::{ALONG, Cells, EDGE, Falloff, HEIGHT, Tail, cell, numeric};
use crate::{Cut, Jet, Real};
use core::f64::consts::PI;

pub mod arc;
pub mod polygon;
pub mod segment;
pub mod triangle;

/// The Cauchy kernel.
pub(crate) struct Cauchy;

impl Falloff for Cauchy {
    const NAME: &'static str = "cauchy";
    const MEANING: &'static str = "1/(1+s²r²)²: wide and smooth, closed forms for every primitive";
    const FORMULA: &'static str = "h(u) = 1/(1+u²)²";
    const TAIL: Tail = Tail::Power {
        exponent: 4,
        softening: 1.0,
    };
    const CELLS: Cells = Cells {
        segment: cell(
            "closed",
            "F = [ x/(2p²(p²+x²)) + atan(x/p)/(2p³) ] from x₁ to x₂,   p² = 1+ρ²",
            ALONG,
        ),
        arc: cell(
            "closed",
            "F = r₀ ∫ dφ/(A − B cos φ)²,   A = 1+r₀²+ρ²+z²,   B = 2r₀ρ",
            "the integral is elementary; its angle δ runs from 0 to π without a branch",
        ),
        face: cell(
            "closed",
            "F = 1/(2c²) · Σ (h/w) · [atan(t/w)] along each edge,   c² = 1+z²,   w² = c²+h²",
            EDGE,
        ),
        plane: cell("closed", "F = π/(1+d²)", HEIGHT),
    };

    fn derivatives(q: f64) -> [f64; 5] {
        let i = 1.0 / (1.0 + q);
        let g = i * i;
        [
            g,
            -2.0 * g * i,
            6.0 * g * g,
            -24.0 * g * g * i,
            120.0 * g * g * g,
        ]
    }

    #[inline(always)]
    fn falling<R: Real>(q: R) -> (R, R) {
        let one = R::splat(1.0);
        let i = one / (one + q);
        let g = i * i;
        (g, R::splat(2.0) * g * i)
    }

    fn between(a: f64, b: f64) -> f64 {
        let [inner, outer] = [a, b].map(|u| 0.5 * (u / (1.0 + u * u) + libm::atan(u)));
        outer - inner
    }

    fn over_ring(p: f64, q: f64) -> f64 {
        q / (1.0 + q) - p / (1.0 + p)
    }

    fn line(distance: f64) -> f64 {
        let q = distance * distance;
        PI / (2.0 * (1.0 + q) * (1.0 + q).sqrt())
    }

    /// `π/(1+z²)`.
    #[inline(always)]
    fn plane<R: Real>(z: R) -> (R, R) {
        let one = R::splat(1.0);
        let i = one / (one + z * z);
        (R::splat(PI) * i, Self::falling(z * z).0)
    }

    #[inline(always)]
    fn jet<R: Real>(bone: &Bone<R::Scalar>, p: [R; 3]) -> Jet<R> {
        match bone {
            Bone::Segment(bone) => segment::jet(bone, p),
            Bone::Arc(bone) => arc::jet(bone, p),
            Bone::Triangle(bone) => triangle::jet(bone, p),
            Bone::Polygon(bone) => polygon::jet(bone, p),
            _ => numeric::jet::<Self, R>(bone, p),
        }
    }

    fn arc_at_most(_length: f64, radius: f64, d: f64) -> f64 {
        circle(radius, d)
    }

    /// Computes the bounds by formulas. With x = 1+u², along any ray `k(t) = (P²+t²)⁻²` it has
    /// `|k⁗| = 24·|35w⁴−42w²+3|/(1+w²)²·X⁻⁴`, w = t/P, where X = P²(1+w²) is the value of x at t.
    /// The constants are upper envelopes of its integrals, checked numerically in this file's
    /// tests.
    #[inline(always)]
    fn roughness(u: f64) -> Option<Roughness> {
        let x = 1.0 + u * u;
        let y = 1.0 / x;
        let root = y.sqrt();
        let c = 1.0 - y;
        Some(Roughness {
            point: steepest(x, y),
            line: ((103.0 + 729.0 * c * c * c) * (y * y * y * root)).at_most(90.6),
            plane: ((121.0 + 775.0 * c * c * c) * (y * y * y)).at_most(112.0),
            // |k⁗| ≤ 840/(1+u²)⁴, and half the line's through the centre.
            outward: (120.0 * (y * y * y) / u).at_most(45.3),
        })
    }

    #[inline(always)]
    fn value_and_roughness(u: f64) -> Option<(f64, f64)> {
        let x = 1.0 + u * u;
        let y = 1.0 / x;
        Some((y * y, steepest(x, y)))
    }
}

/// Computes the bound on the fourth derivative, given x = 1+u² and 1/x.
#[inline(always)]
fn steepest(x: f64, y: f64) -> f64 {
    let w = x - 1.0;
    let share = (35.0 * w * w - 42.0 * w + 3.0) * y * y;
    (24.0 * (1.005 * share).at_least(4.3) * (y * y) * (y * y)).at_most(72.0)
}

/// Returns a bound on the Cauchy field of any arc of a circle at distance d or more from the arc.
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
        return 2.0 * PI * r * Cauchy::derivatives(d * d)[0];
    }
    let k = 4.0 * r * r;
    let peak = 2.0 * (4.0 + k) / ((8.0 + 3.0 * k) + (9.0 * k * k + 32.0 * k).sqrt());
    let p = (d * (2.0 * r - d)).at_least(peak).at_most(r * r);
    let product = 1.0 + k - 2.0 * p + p * p;
    PI * r * (2.0 + k - 2.0 * p) / (product * product.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Kernel;
    use crate::envelope::along_any_line;
    use core::f64::consts::TAU;

    #[test]
    fn formulas_are_envelopes() {
        for i in 0..400 {
            let x = 1.0 + 0.01 * f64::from(i * i) / 4.0;
            let bound = Cauchy::roughness((x - 1.0).sqrt()).expect("a formula");
            for j in 0..200 {
                let at = x + 0.008 * f64::from(j * j);
                let here = along_any_line(Kernel::Cauchy, 4, (at - 1.0).sqrt());
                assert!(
                    here <= bound.point * (1.0 + 1e-9),
                    "{x} {at}: {here} {bound:?}"
                );
            }
            let (mut line, mut plane) = (0.0, 0.0);
            let reach = 40.0 * x.sqrt();
            let n = 4000;
            for j in 0..n {
                let v = (f64::from(j) + 0.5) / f64::from(n) * reach;
                let dv = reach / f64::from(n);
                let here = steepest(x + v * v, 1.0 / (x + v * v));
                line += 2.0 * dv * here;
                plane += TAU * v * dv * here;
            }
            assert!(line <= bound.line * 1.001, "{x} {line} {bound:?}");
            assert!(plane <= bound.plane * 1.001, "{x} {plane} {bound:?}");
        }
    }
}
