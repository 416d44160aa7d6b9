//! The squared kernel, `h(r) = 1/(r²+ε²)`.
//!
//! ε rounds the pole off as it does the [inverse](crate::kernel::inverse) kernel's.
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
pub(crate) struct Squared;

impl Falloff for Squared {
    const NAME: &'static str = "squared";
    const MEANING: &'static str = "1/r²";
    const FORMULA: &'static str = "h(u) = 1/u²";
    const TAIL: Tail = Tail::pole(2);
    const CELLS: Cells = Cells {
        segment: cells::segment("F = (atan(x₂/ρ) − atan(x₁/ρ)) / ρ"),
        arc: cells::arc("F = r₀ ∫ dφ/(A − B cos φ),   A = r₀²+ρ²+z²,   B = 2r₀ρ"),
        face: cells::face("F = ½ · Σ ∫ ln(1 + (h²+t²)/z²) · h/(h²+t²) dt").by("dilogarithm"),
        plane: cells::windowed("F = π·ln(1 + w²/d²)"),
    };

    #[inline(always)]
    fn density<R: Real, const N: usize>(q: Taylor<R, N>) -> Taylor<R, N> {
        Taylor::constant(1.0) / (q + Taylor::constant(POLE2))
    }

    fn derivatives(q: f64) -> [f64; 5] {
        let i = 1.0 / (q + POLE2);
        [
            i,
            -i * i,
            2.0 * i * i * i,
            -6.0 * i * i * i * i,
            24.0 * i * i * i * i * i,
        ]
    }

    #[inline(always)]
    fn falling<R: Real>(q: R) -> (R, R) {
        let i = R::splat(1.0) / (q + R::splat(POLE2));
        (i, i * i)
    }

    fn square_of(ratio: f64) -> f64 {
        ratio - POLE2
    }

    fn along(u: f64) -> f64 {
        let pole = POLE2.sqrt();
        libm::atan(u / pole) / pole
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
