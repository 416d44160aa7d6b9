//! The metaballs kernel: `1−3u²` up to u = ⅓, then `1.5(1−u)²` up to u = 1, and 0 beyond.
//!
//! A bone is clipped to both balls. The inner piece is a polynomial like those of
//! [`polynomial`](crate::kernel::polynomial). On the outer pieces the distance u is a square root:
//! along a segment that gives elementary functions, and these are used; over a polygon and along an
//! arc it gives so many terms, and at the axis so many that cancel (on an arc elliptic integrals),
//! that the Gauss–Legendre rule serves better. The outer pieces stay ⅓ away from the root's branch
//! points, so that it converges like a geometric series; each file states its error.

use crate::bone::Bone;
use crate::kernel::polynomial::{GAUSS4, face};
use crate::kernel::{Cells, Falloff, Tail, cell, numeric};
use crate::{Jet, Real};
use core::f64::consts::PI;

pub mod arc;
pub mod polygon;
pub mod segment;

/// Distance u at which the inner piece ends.
pub const INNER: f64 = 1.0 / 3.0;
/// Square of [`INNER`].
pub const INNER2: f64 = 1.0 / 9.0;

/// The metaballs kernel.
pub(crate) struct Metaballs;

impl Falloff for Metaballs {
    const NAME: &'static str = "metaballs";
    const MEANING: &'static str = "piecewise quadratic, nothing beyond r = 1";
    const FORMULA: &'static str = "h(u) = 1−3u² up to u = ⅓, then 3/2·(1−u)² up to 1";
    const TAIL: Tail = Tail::Compact;
    const CELLS: Cells = Cells {
        segment: cell(
            "closed",
            "F = ∫ 3/2·(1−√(ρ²+x²))² dx, inside u < ⅓ replaced by ∫ (1−3(ρ²+x²)) dx",
            "both integrals are elementary; \
             the line is cut where it enters and leaves the two spheres",
        ),
        arc: cell(
            "Gauss–Legendre",
            "F = r₀ ∫ 3/2·(1−√(A − B cos φ))² dφ, an elliptic integral of the second kind",
            "by Gauss–Legendre; the arc is cut where it enters and leaves the two spheres",
        ),
        face: face("Gauss–Legendre"),
        plane: cell(
            "closed",
            "F = 2π ∫ h(u) u du from u = d to 1",
            "elementary; d is the distance from the plane",
        ),
    };
    const KINKS: &'static [f64] = &[INNER, 1.0];
    const SMOOTHNESS: usize = 1;

    fn derivatives(q: f64) -> [f64; 5] {
        if q <= INNER2 {
            [1.0 - 3.0 * q, -3.0, 0.0, 0.0, 0.0]
        } else if q <= 1.0 {
            let u = q.sqrt();
            let i = 1.0 / q;
            [
                1.5 * (1.0 - u) * (1.0 - u),
                1.5 * (1.0 - 1.0 / u),
                0.75 * i / u,
                -1.125 * i * i / u,
                2.8125 * i * i * i / u,
            ]
        } else {
            [0.0; 5]
        }
    }

    #[inline(always)]
    fn falling<R: Real>(q: R) -> (R, R) {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let u = q.sqrt().max(R::splat(INNER * 0.5));
        let rest = (one - u).max(zero);
        let inner = q.lt(R::splat(INNER2));
        (
            R::select(inner, one - R::splat(3.0) * q, R::splat(1.5) * rest * rest),
            R::select(inner, R::splat(3.0), R::splat(1.5) * rest / u),
        )
    }

    fn between(a: f64, b: f64) -> f64 {
        let [inner, outer] = [a, b].map(|u| {
            let [large, small] = [u, 3.0 * u].map(|u| (1.0 - (1.0 - u.min(1.0)).powi(3)) / 3.0);
            1.5 * large - small / 6.0
        });
        outer - inner
    }

    fn over_ring(p: f64, q: f64) -> f64 {
        let [inner, outer] = [p, q].map(|q| {
            let u = q.sqrt();
            1.5 * cone_on_disc(u) - cone_on_disc(3.0 * u) / 18.0
        });
        outer - inner
    }

    fn line(distance: f64) -> f64 {
        1.5 * cone_on_line(distance) - cone_on_line(3.0 * distance) / 6.0
    }

    /// Computes `1.5·P(z) − P(3z)/18`, `P(z) = (π/6)(1−z)³(1+3z)`.
    #[inline(always)]
    fn plane<R: Real>(z: R) -> (R, R) {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let height = z.abs();
        let [outer, inner] = [1.0, 3.0].map(|scale| {
            let u = height * R::splat(scale);
            let rest = (one - u).max(zero);
            rest * rest * rest * (one + R::splat(3.0) * u)
        });
        let value = R::splat(PI / 6.0) * (R::splat(1.5) * outer - R::splat(1.0 / 18.0) * inner);
        (value, Self::falling(z * z).0)
    }

    fn width(blobbiness: f64) -> f64 {
        let outer = blobbiness / (1.0 + blobbiness);
        if outer > INNER {
            outer
        } else {
            (outer / 3.0).sqrt()
        }
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

/// Computes `2∫(1−u)²u du` from 0 to u or 1.
fn cone_on_disc(u: f64) -> f64 {
    let rest = 1.0 - u.min(1.0);
    (1.0 - rest * rest * rest * (1.0 + 3.0 * u.min(1.0))) / 6.0
}

/// Computes the integral of `(1−u)²` within u ≤ 1, over a line at a distance.
fn cone_on_line(x: f64) -> f64 {
    if x >= 1.0 {
        return 0.0;
    }
    let c = (1.0 - x * x).sqrt();
    let slant = if x > 0.0 {
        x * x * libm::asinh(c / x)
    } else {
        0.0
    };
    2.0 * ((1.0 + x * x) * c + c * c * c / 3.0 - c - slant)
}

/// Positive nodes and weights on [−1, 1] for the outer pieces.
#[inline(always)]
fn rule<R: Real>() -> &'static [[f64; 2]] {
    if R::DOUBLE { &GAUSS20 } else { &GAUSS6 }
}

/// Nodes and weights for inner pieces of a polygon's edges: integrands are polynomials, or such
/// over the squared distance from a far pole.
#[inline(always)]
fn rule_inside<R: Real>() -> &'static [[f64; 2]] {
    if R::DOUBLE { &GAUSS20 } else { &GAUSS4 }
}

/// Nodes and weights along an arc, where the branch points can be nearer.
#[inline(always)]
fn rule_arc<R: Real>() -> &'static [[f64; 2]] {
    if R::DOUBLE { &GAUSS24 } else { &GAUSS8 }
}

/// Six nodes.
#[rustfmt::skip]
const GAUSS6: [[f64; 2]; 3] = [
    [0.2386191860831969, 0.46791393457269104],
    [0.6612093864662645, 0.3607615730481386],
    [0.932469514203152, 0.17132449237917036],
];

/// Twenty nodes.
#[rustfmt::skip]
const GAUSS20: [[f64; 2]; 10] = [
    [0.07652652113349734, 0.15275338713072584],
    [0.22778585114164507, 0.14917298647260374],
    [0.37370608871541955, 0.14209610931838204],
    [0.5108670019508271, 0.13168863844917664],
    [0.636053680726515, 0.11819453196151841],
    [0.7463319064601508, 0.10193011981724044],
    [0.8391169718222188, 0.08327674157670475],
    [0.912234428251326, 0.06267204833410907],
    [0.9639719272779138, 0.04060142980038694],
    [0.9931285991850949, 0.017614007139152118],
];

/// Eight nodes.
#[rustfmt::skip]
const GAUSS8: [[f64; 2]; 4] = [
    [0.1834346424956498, 0.362683783378362],
    [0.525532409916329, 0.31370664587788727],
    [0.7966664774136267, 0.22238103445337448],
    [0.9602898564975363, 0.10122853629037626],
];

/// Twenty-four nodes.
#[rustfmt::skip]
const GAUSS24: [[f64; 2]; 12] = [
    [0.06405689286260563, 0.12793819534675216],
    [0.1911188674736163, 0.1258374563468283],
    [0.3150426796961634, 0.12167047292780339],
    [0.4337935076260451, 0.1155056680537256],
    [0.5454214713888396, 0.10744427011596563],
    [0.6480936519369755, 0.09761865210411388],
    [0.7401241915785544, 0.08619016153195327],
    [0.820001985973903, 0.0733464814110803],
    [0.8864155270044011, 0.05929858491543678],
    [0.9382745520027328, 0.04427743881741981],
    [0.9747285559713095, 0.028531388628933663],
    [0.9951872199970213, 0.0123412297999872],
];
