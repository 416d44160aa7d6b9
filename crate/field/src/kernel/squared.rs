//! The squared kernel, `h(r) = 1/(r²+ε²)`.
//!
//! ε rounds the pole off as it does the [inverse](crate::kernel::inverse) kernel's.
use crate::bone::Bone;
use crate::kernel::{
    ALONG, AROUND, Cells, EDGE, Falloff, POLE2, Tail, WINDOW, WINDOWED, cell, numeric, powers,
};
use crate::{Jet, Real};
use core::f64::consts::PI;

pub mod arc;
pub mod polygon;
pub mod segment;

/// The squared kernel.
pub(crate) struct Squared;

impl Falloff for Squared {
    const NAME: &'static str = "squared";
    const MEANING: &'static str = "1/r²";
    const FORMULA: &'static str = "h(u) = 1/u²";
    const TAIL: Tail = Tail::pole(2);
    const CELLS: Cells = Cells {
        segment: cell("closed", "F = (atan(x₂/ρ) − atan(x₁/ρ)) / ρ", ALONG),
        arc: cell(
            "closed",
            "F = r₀ ∫ dφ/(A − B cos φ),   A = r₀²+ρ²+z²,   B = 2r₀ρ",
            AROUND,
        ),
        face: cell(
            "dilogarithm",
            "F = ½ · Σ ∫ ln(1 + (h²+t²)/z²) · h/(h²+t²) dt",
            EDGE,
        ),
        plane: cell("windowed", "F = π·ln(1 + w²/d²)", WINDOWED),
    };

    fn derivatives(q: f64) -> [f64; 5] {
        let i = 1.0 / (q + POLE2);
        powers(i, i, [1.0, -1.0, 2.0, -6.0, 24.0])
    }

    #[inline(always)]
    fn falling<R: Real>(q: R) -> (R, R) {
        let i = R::splat(1.0) / (q + R::splat(POLE2));
        (i, i * i)
    }

    fn between(a: f64, b: f64) -> f64 {
        let pole = POLE2.sqrt();
        let [inner, outer] = [a, b].map(|u| libm::atan(u / pole) / pole);
        outer - inner
    }

    fn over_ring(p: f64, q: f64) -> f64 {
        let near = (p + POLE2).sqrt();
        libm::log1p((q - p) / (near * near))
    }

    fn line(distance: f64) -> f64 {
        PI / (distance * distance + POLE2).sqrt()
    }

    /// `π·ln(1 + 100/(z²+ε²))`.
    #[inline(always)]
    fn plane<R: Real>(z: R) -> (R, R) {
        let q = z * z + R::splat(POLE2);
        let window = R::splat(WINDOW * WINDOW);
        let ratio = window / q;
        (R::splat(PI) * ratio.ln_1p(), ratio / (q + window))
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
