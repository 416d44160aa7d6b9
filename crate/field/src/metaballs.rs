//! The metaballs kernel: `1−3u²` up to u = ⅓, then `1.5(1−u)²` up to u = 1, and 0 beyond.
//!
//! A bone is clipped to both balls. The inner piece is a polynomial like those of
//! [`polynomial`](crate::polynomial). On the outer pieces the distance u is a square root: along a
//! segment that gives elementary functions, and these are used; over a polygon and along an arc it
//! gives so many terms, and at the axis so many that cancel (on an arc elliptic integrals), that
//! the Gauss–Legendre rule serves better. The outer pieces stay ⅓ away from the root's branch
//! points, so that it converges like a geometric series; each file states its error.

use crate::Real;
use crate::polynomial::GAUSS4;

pub mod arc;
pub mod polygon;
pub mod segment;

/// Distance u at which the inner piece ends.
pub const INNER: f64 = 1.0 / 3.0;
/// Square of [`INNER`].
pub const INNER2: f64 = 1.0 / 9.0;

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
