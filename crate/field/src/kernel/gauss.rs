//! The Gaussian kernel, `h(r) = exp(−s²r²)`.
use crate::bone::Bone;
use crate::kernel::{ALONG, Cells, Falloff, HEIGHT, Tail, cell, numeric};
use crate::{Jet, Real};
use core::f64::consts::PI;

pub mod arc;
pub mod polygon;
pub mod segment;

/// The Gaussian kernel.
pub(crate) struct Gauss;

impl Falloff for Gauss {
    const NAME: &'static str = "gauss";
    const MEANING: &'static str = "exp(−a²r²): falls fast";
    const FORMULA: &'static str = "h(u) = exp(−u²)";
    const TAIL: Tail = Tail::Fast;
    const CELLS: Cells = Cells {
        segment: cell(
            "error function",
            "F = √π/2 · exp(−ρ²) · (erf x₂ − erf x₁)",
            ALONG,
        ),
        arc: cell(
            "Gauss–Legendre",
            "F = r₀ · exp(−(r₀−ρ)²−z²) · ∫ exp(−2r₀ρ(1−cos φ)) dφ",
            "the last integral by Gauss–Legendre where the arc is within reach",
        ),
        face: cell(
            "Owen's T",
            "F = exp(−z²)/2 · Σ ∫ (1 − exp(−h²−t²)) · h/(h²+t²) dt",
            "a sum over the edges, h and t as seen from the point's foot in the plane, \
             z its height; each integral is an angle less Owen's T function",
        ),
        plane: cell("closed", "F = π · exp(−d²)", HEIGHT),
    };
    const ENTIRE: bool = true;

    fn derivatives(q: f64) -> [f64; 5] {
        let g = libm::exp(-q);
        [g, -g, g, -g, g]
    }

    #[inline(always)]
    fn falling<R: Real>(q: R) -> (R, R) {
        let g = q.decay();
        (g, g)
    }

    #[inline(always)]
    fn falling_at_most<R: Real>(q: R) -> (R, R) {
        let g = q.decay_at_most();
        (g, g)
    }

    /// Single precision's exponential is right to 10⁻⁶, and not yet 0 at e⁻⁸¹.
    #[inline(always)]
    fn at_most(u: f64) -> f64 {
        if u < 9.0 {
            f64::from(Real::decay((u * u) as f32)) * (1.0 + 1e-5)
        } else {
            7e-36
        }
    }

    fn square_of(ratio: f64) -> f64 {
        libm::log(ratio)
    }

    fn between(a: f64, b: f64) -> f64 {
        let [inner, outer] = [a, b].map(|u| PI.sqrt() / 2.0 * libm::erf(u));
        outer - inner
    }

    fn over_ring(p: f64, q: f64) -> f64 {
        libm::expm1(-p) - libm::expm1(-q)
    }

    fn line(distance: f64) -> f64 {
        PI.sqrt() * libm::exp(-(distance * distance))
    }

    #[inline(always)]
    fn line_at_most(_distance: f64, point: f64) -> f64 {
        PI.sqrt() * point
    }

    /// `π·exp(−z²)`.
    #[inline(always)]
    fn plane<R: Real>(z: R) -> (R, R) {
        let (g, _) = Self::falling(z * z);
        (R::splat(PI) * g, g)
    }

    fn width(blobbiness: f64) -> f64 {
        blobbiness.sqrt()
    }

    #[inline(always)]
    fn jet<R: Real>(bone: &Bone<R::Scalar>, p: [R; 3]) -> Jet<R> {
        match bone {
            Bone::Segment(bone) => segment::jet(bone, p),
            Bone::Arc(bone) => arc::jet(bone, p),
            Bone::Triangle(bone) => polygon::jet(&bone.edges, p),
            Bone::Polygon(bone) => polygon::jet(&bone.edges, p),
            _ => numeric::jet::<Self, R>(bone, p),
        }
    }
}
