//! The Cauchy kernel over a planar polygon: the signed sum of the triangles from its first corner
//! over its edges.
//!
//! The plain edge sum (1) of [`triangle`](super::triangle) would do, but loses its digits outside
//! the polygon; the triangles' does not. Of a convex polygon all terms are positive, and else the
//! sum of their magnitudes is what a few polygons of that size would give.
use super::triangle;
use crate::bone::Polygon;
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(polygon: &Polygon<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let mut sum = Jet::zero();
    for (sign, part) in &polygon.fan {
        sum = sum.plus(triangle::jet(part, p).times(R::lift(*sign)));
    }
    sum
}
