//! The inverse kernel, the Newtonian potential: `h(r) = 1/√(r²+ε²)`.
//!
//! ε rounds the pole off. It acts like a distance in a fourth dimension: in every formula z²
//! becomes z²+ε². All work in the primitive's own frame, in units of its radius.
use crate::bone::Bone;
use crate::kernel::{
    ALONG, Cells, EDGE, Falloff, POLE2, Tail, WINDOW, WINDOWED, cell, numeric, powers,
};
use crate::{Jet, Real};
use core::f64::consts::PI;

pub mod arc;
pub mod polygon;
pub mod segment;

/// The inverse kernel.
pub(crate) struct Inverse;

impl Falloff for Inverse {
    const NAME: &'static str = "inverse";
    const MEANING: &'static str = "1/r: the Newtonian potential, very wide";
    const FORMULA: &'static str = "h(u) = 1/u";
    const TAIL: Tail = Tail::pole(1);
    const CELLS: Cells = Cells {
        segment: cell("closed", "F = asinh(x₂/ρ) − asinh(x₁/ρ)", ALONG),
        arc: cell(
            "Carlson",
            "F = r₀ ∫ dφ/√(A − B cos φ), an elliptic integral of the first kind",
            "computed as Carlson's R_F",
        ),
        face: cell(
            "closed",
            "F = Σ [ h·asinh(t/k) − |z|·atan2(ht, k²+|z|r) ] along each edge,   k² = h²+z²",
            EDGE,
        ),
        plane: cell("windowed", "F = 2π·(√(d²+w²) − d)", WINDOWED),
    };

    fn derivatives(q: f64) -> [f64; 5] {
        let i = 1.0 / (q + POLE2);
        powers(i.sqrt(), i, [1.0, -0.5, 0.75, -1.875, 6.5625])
    }

    #[inline(always)]
    fn falling<R: Real>(q: R) -> (R, R) {
        let i = R::splat(1.0) / (q + R::splat(POLE2));
        let g = i.sqrt();
        (g, R::splat(0.5) * g * i)
    }

    fn between(a: f64, b: f64) -> f64 {
        let [inner, outer] = [a, b].map(|u| libm::asinh(u / POLE2.sqrt()));
        outer - inner
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

    #[inline(always)]
    fn jet<R: Real>(bone: &Bone<R::Scalar>, p: [R; 3]) -> Jet<R> {
        match bone {
            Bone::Segment(bone) => segment::jet(bone, p),
            Bone::Arc(bone) => arc::jet(bone, p),
            Bone::Triangle(bone) => polygon::triangle(bone, p),
            Bone::Polygon(bone) => polygon::jet(bone, p),
            _ => numeric::jet::<Self, R>(bone, p),
        }
    }
}

/// `A−a` of `A = √(ρ²+a²)`: by how much a hypotenuse is longer than its leg, to the last digits.
#[inline(always)]
fn surplus<R: Real>(rho2: R, hypotenuse: R, leg: R) -> R {
    let sum = hypotenuse + leg.abs();
    R::select(leg.lt(R::splat(0.0)), sum, rho2 / sum)
}
