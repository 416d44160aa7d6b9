//! The soft, quartic and compact6 kernels: `g(v) = c₂v² + c₃v³` of v = 1−r² ≥ 0, and 0 beyond.
//!
//! Along a line and an arc v is a polynomial of the place and of the azimuth's sine and cosine;
//! over a polygon Green's theorem leaves polynomials along the edges. So every cell is exact once
//! the bone is clipped to the ball v ≥ 0. Nothing is subtracted: outside, the field is 0 to the
//! last bit, and short pieces keep their digits.
use crate::bone::Bone;
use crate::kernel::{ALONG, AROUND, Cell, Cells, Falloff, HEIGHT, Tail, cell, numeric};
use crate::{Jet, Real};
use core::f64::consts::PI;

pub mod arc;
pub mod cone;
pub mod polygon;
pub mod segment;

/// Positive nodes and weights of the Gauss–Legendre rule with four nodes on [−1, 1], exact for
/// polynomials of degree 7.
pub(crate) const GAUSS4: [[f64; 2]; 2] = [
    [0.339_981_043_584_856_26, 0.652_145_154_862_546_1],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_86],
];

/// Makes the chart's entry of faces.
pub(crate) const fn face(way: &'static str) -> Cell {
    cell(
        way,
        "F = Σ h·[P(t)] along the part of each edge inside the disc, and G·(angle) along the rest",
        "the disc is where the kernel's sphere meets the plane; \
         P is a polynomial, G the field of the whole disc",
    )
}

/// A kernel of this kind.
pub(crate) trait Polynomial {
    /// Name in the dataset language.
    const NAME: &'static str;
    /// The meaning, for the manual.
    const MEANING: &'static str;
    /// h, for people.
    const FORMULA: &'static str;
    /// The field of a plane, for people.
    const PLANE: &'static str;
    /// c₂ and c₃.
    const COEFFICIENTS: [f64; 2];
    /// Number of continuous derivatives.
    const SMOOTHNESS: usize = 1;

    /// Computes the width parameter times the radius ([`Falloff::width`]).
    fn width(blobbiness: f64) -> f64;
}

impl<P: Polynomial> Falloff for P {
    const NAME: &'static str = <P as Polynomial>::NAME;
    const MEANING: &'static str = <P as Polynomial>::MEANING;
    const FORMULA: &'static str = <P as Polynomial>::FORMULA;
    const TAIL: Tail = Tail::Compact;
    const CELLS: Cells = Cells {
        segment: cell(
            "closed",
            "F = ∫ (polynomial in 1−ρ²−x²) dx between the ends, cut to x² ≤ 1−ρ²",
            ALONG,
        ),
        arc: cell(
            "closed",
            "F = r₀ ∫ (polynomial in 1 − A + B cos φ) dφ, cut to where it is positive",
            AROUND,
        ),
        face: face("closed"),
        plane: cell("closed", P::PLANE, HEIGHT),
    };
    const KINKS: &'static [f64] = &[1.0];
    const SMOOTHNESS: usize = <P as Polynomial>::SMOOTHNESS;
    const HAS_CONES: bool = true;
    /// √y(12G″ + 8yG‴) and 12G″ + 48yG‴ at y ≤ q ≤ 1, G″ = 2c₂ + 6c₃v, G‴ = −6c₃.
    const INSIDE: [f64; 2] = {
        let [c2, c3] = P::COEFFICIENTS;
        [24.0 * c2 + 72.0 * c3, 24.0 * c2 + 288.0 * c3]
    };

    fn derivatives(q: f64) -> [f64; 5] {
        let [c2, c3] = P::COEFFICIENTS;
        if q <= 1.0 {
            let v = 1.0 - q;
            [
                v * v * (c2 + c3 * v),
                -v * (2.0 * c2 + 3.0 * c3 * v),
                2.0 * c2 + 6.0 * c3 * v,
                -6.0 * c3,
                0.0,
            ]
        } else {
            [0.0; 5]
        }
    }

    #[inline(always)]
    fn falling<R: Real>(q: R) -> (R, R) {
        let [c2, c3] = P::COEFFICIENTS;
        let v = (R::splat(1.0) - q).max(R::splat(0.0));
        let (a, b) = (R::splat(c2), R::splat(c3) * v);
        (v * v * (a + b), v * (a + a + R::splat(3.0) * b))
    }

    fn between(a: f64, b: f64) -> f64 {
        let [c2, c3] = P::COEFFICIENTS;
        let [inner, outer] = [a, b].map(|u| {
            let u = u.min(1.0);
            let q = u * u;
            let fourth = 1.0 - q * (2.0 / 3.0 - q / 5.0);
            let sixth = 1.0 - q * (1.0 - q * (3.0 / 5.0 - q / 7.0));
            u * (c2 * fourth + c3 * sixth)
        });
        outer - inner
    }

    fn over_ring(p: f64, q: f64) -> f64 {
        let [c2, c3] = P::COEFFICIENTS;
        let [inner, outer] = [p, q].map(|q| {
            let v = (1.0 - q).max(0.0);
            let v3 = v * v * v;
            c2 * (1.0 - v3) / 3.0 + c3 * (1.0 - v3 * v) / 4.0
        });
        outer - inner
    }

    fn line(distance: f64) -> f64 {
        let [c2, c3] = P::COEFFICIENTS;
        let v = (1.0 - distance * distance).max(0.0);
        v * v * v.sqrt() * (c2 * 16.0 / 15.0 + c3 * 32.0 / 35.0 * v)
    }

    /// `π(c₂v³/3 + c₃v⁴/4)` with v = 1−z².
    #[inline(always)]
    fn plane<R: Real>(z: R) -> (R, R) {
        let [c2, c3] = P::COEFFICIENTS;
        let v = (R::splat(1.0) - z * z).max(R::splat(0.0));
        let value = v * v * v * (R::splat(PI * c2 / 3.0) + R::splat(PI * c3 / 4.0) * v);
        (value, <P as Falloff>::falling(z * z).0)
    }

    fn width(blobbiness: f64) -> f64 {
        <P as Polynomial>::width(blobbiness)
    }

    #[inline(always)]
    fn jet<R: Real>(bone: &Bone<R::Scalar>, p: [R; 3]) -> Jet<R> {
        match bone {
            Bone::Segment(bone) => segment::jet(P::COEFFICIENTS, bone, p),
            Bone::Arc(bone) => arc::jet(P::COEFFICIENTS, bone, p),
            Bone::Triangle(bone) => polygon::jet(P::COEFFICIENTS, &bone.edges, p),
            Bone::Polygon(bone) => polygon::jet(P::COEFFICIENTS, &bone.edges, p),
            Bone::Curve(bone) if let Some(cone) = &bone.cone => cone::jet(P::COEFFICIENTS, cone, p),
            _ => numeric::jet::<Self, R>(bone, p),
        }
    }
}
