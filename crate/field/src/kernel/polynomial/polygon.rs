//! Polynomial kernels over a planar polygon, or a triangle, clipped exactly to the kernel's ball.
//! (The thesis calls polynomial kernels on triangles unsuitable for an analytical solution.)
//!
//! The polygon lies in the plane z = 0. The ball meets that in a disc of radius √M, `M = 1−z²`,
//! around the point's foot; at the distance s from the foot `v = M − s²`. Green's theorem makes the
//! area's integral a sum over edges. With the radial primitive `Φ(s) = ∫₀ˢ g s ds`, h the foot's
//! signed distance from the edge's line and t the place on that line, it is `Σ h·∫ Φ/s² dt`,
//! `s² = h²+t²`.
//!
//! On the part of an edge inside the disc Φ/s² is the polynomial
//!
//! `Q(v) = c₂(M²+Mv+v²)/6 + c₃(M³+M²v+Mv²+v³)/8`;
//!
//! outside it Φ is constant, `Φ = M·Q(0)`, and the integral the angle at which the foot sees that
//! part. The gradient in the plane is `Σ n·∫g dt` over inward normals n and the parts inside.
//! Across it `∂f/∂z = −2z·∂f/∂M`, where ∂f/∂M is the same sum for the kernel `g′ = 2c₂v + 3c₃v²`.
//! Polynomials along edges are of degree at most 6, for which the Gauss–Legendre rule with four
//! nodes is exact.
//!
//! Small polygons must not lose their digits in a sum of edges that are far from the foot. So
//! - where the whole polygon is inside the disc, Q and g are counted from their values at the
//!   polygon's middle, which add `2·area·Q(v₀)` and nothing;
//! - where it is not, but all parts inside are far from the foot for their length, Φ is counted
//!   from its value outside: the sum is `2πW·M·Q(0) − Σ h·∫ Ψ/s² dt`, where W is how often the
//!   polygon winds around the foot and `Ψ = c₂v³/6 + c₃v⁴/8` vanishes towards the rim. With a
//!   part's half length at most 1/k of its distance from the foot, where 1/s² has its pole, the
//!   error of n nodes is below `(2k)⁻²ⁿ`, and so that of the same four 2·10⁻⁷ of Ψ for k = 4
//!   (single precision) and 10⁻¹⁷ for 64;
//! - where no edge meets the disc, the angles, which add up to 2πW, are rounded to that: outside
//!   the kernel's reach the field is 0 to the last bit.
use super::GAUSS4;
use crate::angle::direction;
use crate::bone::Edge;
use crate::{Jet, Real};
use core::f64::consts::TAU;

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>([c2, c3]: [f64; 2], edges: &[Edge<R::Scalar>], [x, y, z]: [R; 3]) -> Jet<R> {
    let zero = R::splat(0.0);
    let one = R::splat(1.0);
    let disc2 = ((one - z) * (one + z)).max(zero);

    // First look: whether the disc holds the whole polygon, or meets no edge.
    let (mut inside, mut met, mut double_area) = (one, zero, zero);
    for edge in edges {
        let part = Clipped::new(edge, disc2, x, y);
        inside = inside.min(part.whole);
        met = met.max(part.half);
        double_area = double_area - R::lift(edge.offset) * R::lift(edge.length);
    }
    let inside = zero.lt(inside);
    // v at the polygon's middle, if that is inside.
    let middle = R::select(inside, disc2 - (x * x + y * y), zero).max(zero);

    let [c2, c3] = [c2, c3].map(R::splat);
    let two = R::splat(2.0);
    let tiny = R::splat(1e-30);
    let [d2, d3] = [c2 + c2, R::splat(3.0) * c3];
    let [sixth, eighth, quarter] = [1.0 / 6.0, 0.125, 0.25].map(R::splat);
    let far_enough = if R::DOUBLE { 64.0 } else { 4.0 };
    // Sums over edges of Q − Q₀ and the like.
    let (mut value, mut slope, mut linear, mut angle) = (zero, zero, zero, zero);
    let mut in_plane = [zero; 2];
    // Sums of Ψ and the like, the angle at which the parts inside are seen, and whether all are
    // far.
    let (mut rim, mut rim1, mut seen, mut far) = (zero, zero, zero, one);
    for edge in edges {
        let part = Clipped::new(edge, disc2, x, y);
        let length = part.half + part.half;
        let (mut q, mut q1, mut g) = (zero, zero, zero);
        let centre = R::lift(edge.start) + R::splat(0.5) * R::lift(edge.length);
        let (mut psi, mut psi1, mut sight) = (zero, zero, zero);
        for [node, weight] in GAUSS4 {
            for sign in [1.0, -1.0] {
                let t = part.middle + R::splat(sign * node) * part.half;
                let v = (part.reach2 - t * t).max(zero);
                // v less its value at the middle, from the way between them.
                let e = centre + R::splat(sign * node) * part.half;
                let offset = R::lift(edge.offset);
                let step = -(e * (e - part.along - part.along)
                    + offset * (offset - part.inward - part.inward));
                let step = R::select(inside, step, v);
                let sum = v + middle;
                let squares = v * sum + middle * middle;
                let m_sum = disc2 + sum;
                let weighted = R::splat(weight) * step;
                q = q + weighted * (c2 * sixth * m_sum + c3 * eighth * (disc2 * m_sum + squares));
                q1 = q1 + weighted * (c2 * (R::splat(0.5)) + c3 * R::splat(0.5) * m_sum);
                g = g + weighted * (c2 * sum + c3 * squares);
                let near = R::splat(weight) / (part.h * part.h + t * t).max(tiny);
                let square = v * v * near;
                psi = psi + square * v * (c2 * sixth + c3 * eighth * v);
                psi1 = psi1 + square * (d2 * quarter + d3 * sixth * v);
                sight = sight + near;
            }
        }
        let scale = part.h * part.half;
        rim = rim + scale * psi;
        rim1 = rim1 + scale * psi1;
        seen = seen + scale * sight;
        let away = part.h * part.h + part.middle * part.middle;
        let short = (R::splat(far_enough * far_enough) * part.half * part.half).lt(away);
        far = far.min(R::select(short, one, zero));
        value = value + scale * q;
        slope = slope + scale * q1;
        linear = linear + part.h * length;
        angle = angle + part.outside(edge);
        let [ax, ay] = edge.along.map(R::lift);
        let g = part.half * g;
        in_plane = [in_plane[0] - ay * g, in_plane[1] + ax * g];
    }
    let angle = R::select(zero.lt(met), angle, whole_turns(angle));
    // Q₀ of the kernel and of its derivative, at the middle or at the rim.
    let squares = disc2 * (disc2 + middle) + middle * middle;
    let cubes = (disc2 * disc2 + middle * middle) * (disc2 + middle);
    let q = c2 * sixth * squares + c3 * eighth * cubes;
    let q1 = d2 * quarter * (disc2 + middle) + d3 * sixth * squares;
    let weight = R::select(inside, double_area, disc2 * angle + linear);
    // The same, counted from outside.
    let around = disc2 * whole_turns(angle + seen);
    let outer = R::both(zero.lt(far), middle.lt(tiny));
    let value = R::select(outer, around * q - rim, value + weight * q);
    let slope = R::select(outer, around * q1 - rim1, slope + weight * q1);
    Jet {
        value,
        gradient: [in_plane[0], in_plane[1], -two * z * slope],
    }
}

/// Rounds an angle to a multiple of 2π.
#[inline(always)]
pub(crate) fn whole_turns<R: Real>(angle: R) -> R {
    R::splat(TAU) * (angle * R::splat(1.0 / TAU) + R::splat(0.5)).floor()
}

/// An edge and its part inside the disc around the foot.
pub(crate) struct Clipped<R> {
    /// The foot's place along the edge's direction, and across it.
    pub along: R,
    pub inward: R,
    /// The edge's start, from the foot of the perpendicular.
    pub start: R,
    /// The foot's signed distance from the edge's line.
    pub h: R,
    /// Half the disc's chord on that line, and its square.
    pub reach: R,
    pub reach2: R,
    /// The part's middle, from the foot of the perpendicular, and half its length.
    pub middle: R,
    pub half: R,
    /// 1 if the part is the whole edge, else 0.
    pub whole: R,
}

impl<R: Real> Clipped<R> {
    #[inline(always)]
    pub(crate) fn new(edge: &Edge<R::Scalar>, disc2: R, x: R, y: R) -> Self {
        let zero = R::splat(0.0);
        let one = R::splat(1.0);
        let half = R::splat(0.5);
        let [ax, ay] = edge.along.map(R::lift);
        let length = R::lift(edge.length);
        let (along, inward) = (ax * x + ay * y, ax * y - ay * x);
        let start = R::lift(edge.start) - along;
        let end = start + length;
        let h = inward - R::lift(edge.offset);
        let reach2 = (disc2 - h * h).max(zero);
        let reach = reach2.sqrt();
        let (low, high) = (start.max(-reach), end.min(reach));
        let whole = R::both((-reach).lt(start), end.lt(reach));
        let cut = (half * (high - low)).max(zero);
        Self {
            along,
            inward,
            start,
            h,
            reach,
            reach2,
            middle: R::select(whole, start + half * length, half * (low + high)),
            half: R::select(whole, half * length, cut),
            whole: R::select(whole, one, zero),
        }
    }

    /// The angle at which the foot sees the parts outside.
    #[inline(always)]
    pub(crate) fn outside(&self, edge: &Edge<R::Scalar>) -> R {
        let zero = R::splat(0.0);
        let one = R::splat(1.0);
        let end = self.start + R::lift(edge.length);
        let (before, after) = (end.min(-self.reach), self.start.max(self.reach));
        let (left, right) = ((before - self.start).max(zero), (end - after).max(zero));
        let h2 = self.h * self.h;
        let x0 = R::select(zero.lt(left), h2 + self.start * before, one);
        let x1 = R::select(zero.lt(right), h2 + after * end, one);
        let (y0, y1) = (self.h * left, self.h * right);
        direction(y0 * x1 + y1 * x0, x0 * x1 - y0 * y1)
    }
}
