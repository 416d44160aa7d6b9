//! The inverse kernel, the Newtonian potential: `h(r) = 1/√(r²+ε²)`.
//!
//! ε rounds the pole off. It acts like a distance in a fourth dimension: in every formula z²
//! becomes z²+ε². All work in the primitive's own frame, in units of its radius.
use crate::bone::{Arc, Polygon, Segment, Triangle};
use crate::kernel::POLE2;
use crate::kernel::cells::{self, Cells};
use crate::kernel::falloff::{Falloff, Tail, closed_forms};
use crate::kernel::taylor::Taylor;
use crate::plane::WINDOW;
use crate::{Jet, Real};
use core::f64::consts::PI;

pub mod arc;
pub mod polygon;
pub mod segment;

/// See the [module](self).
pub(crate) struct Inverse;

impl Falloff for Inverse {
    const NAME: &'static str = "inverse";
    const MEANING: &'static str = "1/r: the Newtonian potential, very wide";
    const FORMULA: &'static str = "h(u) = 1/u";
    const TAIL: Tail = Tail::pole(1);
    const CELLS: Cells = Cells {
        segment: cells::segment("F = asinh(x₂/ρ) − asinh(x₁/ρ)"),
        arc: cells::arc("F = r₀ ∫ dφ/√(A − B cos φ), an elliptic integral of the first kind")
            .by("Carlson")
            .with("computed as Carlson's R_F"),
        face: cells::face(
            "F = Σ [ h·asinh(t/k) − |z|·atan2(ht, k²+|z|r) ] along each edge,   k² = h²+z²",
        ),
        plane: cells::windowed("F = 2π·(√(d²+w²) − d)"),
    };

    #[inline(always)]
    fn density<R: Real, const N: usize>(q: Taylor<R, N>) -> Taylor<R, N> {
        (Taylor::constant(1.0) / (q + Taylor::constant(POLE2))).sqrt()
    }

    fn derivatives(q: f64) -> [f64; 5] {
        let i = 1.0 / (q + POLE2);
        let g = i.sqrt();
        [
            g,
            -0.5 * g * i,
            0.75 * g * i * i,
            -1.875 * g * i * i * i,
            6.5625 * g * i * i * i * i,
        ]
    }

    #[inline(always)]
    fn falling<R: Real>(q: R) -> (R, R) {
        let i = R::splat(1.0) / (q + R::splat(POLE2));
        let g = i.sqrt();
        (g, R::splat(0.5) * g * i)
    }

    fn square_of(ratio: f64) -> f64 {
        ratio * ratio - POLE2
    }

    fn along(u: f64) -> f64 {
        libm::asinh(u / POLE2.sqrt())
    }

    /// Differences of large numbers would lose the digits of a small ring far away.
    fn over_ring(p: f64, q: f64) -> f64 {
        let [near, far] = [p, q].map(|q| (q + POLE2).sqrt());
        2.0 * (q - p) / (near + far)
    }

    fn line(distance: f64) -> f64 {
        2.0 * libm::asinh(WINDOW / (distance * distance + POLE2).sqrt())
    }

    #[inline(always)]
    fn line_at_most(_distance: f64, _point: f64) -> f64 {
        f64::INFINITY
    }

    /// `2π(√(z²+ε²+100) − √(z²+ε²))`.
    #[inline(always)]
    fn plane<R: Real>(z: R) -> (R, R) {
        let pi = R::splat(PI);
        let q = z * z + R::splat(POLE2);
        let window = R::splat(WINDOW * WINDOW);
        let (near, far) = (q.sqrt(), (q + window).sqrt());
        let value = (pi + pi) * window / (near + far);
        // G(z²) − G(z²+100)
        (value, window / ((near + far) * near * far))
    }

    /// There is no width: the unit of length is the radius.
    fn width(_blobbiness: f64) -> f64 {
        1.0
    }

    closed_forms! { bone, p;
        segment(Segment): segment::jet(bone, p);
        arc(Arc): arc::jet(bone, p);
        triangle(Triangle): polygon::triangle(bone, p);
        polygon(Polygon): polygon::jet(bone, p);
    }
}

/// `A−a` of `A = √(ρ²+a²)`: by how much a hypotenuse is longer than its leg, to the last digits.
#[inline(always)]
fn surplus<R: Real>(rho2: R, hypotenuse: R, leg: R) -> R {
    let sum = hypotenuse + leg.abs();
    R::select(leg.lt(R::splat(0.0)), sum, rho2 / sum)
}
