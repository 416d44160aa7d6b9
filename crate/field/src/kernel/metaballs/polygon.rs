//! The metaballs kernel over a planar polygon, or a triangle.
//!
//! Green's theorem, as for [polynomials](crate::kernel::polynomial::polygon), makes the field a sum
//! over the edges' parts inside the disc `s² + z² ≤ 1` around the point's foot, `Σ h·∫ Φ/s² dt`,
//! and an angle of those outside. With q = u² = s²+z², and H(q) the kernel, the radial primitive is
//! `Φ = ½∫H dq` from q = z². An edge's part inside has up to three pieces: the middle one, u < ⅓,
//! where Φ/s² is a polynomial of degree 2, and those on either side of it. The gradient in the
//! plane is `Σ n·∫H dt`, across it `−2z` times the same sum for the kernel −H′.
//!
//! Φ and H are differences from a reference q*, made of `q − q*`, so that they are exact to their
//! last digits. Where all parts inside are *far*, their half length at most a quarter of their
//! distance from the foot (small polygons are), q* is
//! - the polygon's middle where all of it is inside the disc: with `C = Φ(q*)/s*²` the
//!   sum is `2·area·C + Σ h·∫ (ΔΦ − C·Δq)/s² dt`;
//! - else the rim: `2πW·Φ(1) + Σ h·∫ ΔΦ/s² dt`, where the polygon winds W times around the foot.
//!
//! Elsewhere q* = z², at the foot.
//!
//! The pieces are integrated by a Gauss–Legendre rule of n nodes: in single precision 6 (the middle
//! one, a polynomial or over a far pole, 4), in double 20. An integrand's singularities are at u =
//! 0 and, where parts are far, s = 0, so its error is O(ϱ⁻²ⁿ) with the sum ϱ of half axes of the
//! largest ellipse around the piece that is clear of these. The worst piece, from u = ⅓ straight
//! out to u = 1, has ϱ = 2.4, and an amplitude (of what is left of √q when its first terms, which
//! the rule integrates exactly, are gone) that makes the error 10⁻⁷ of the largest field, and 10⁻¹⁵
//! in double.
use super::{INNER, INNER2, rule, rule_inside};
use crate::bone::Edge;
use crate::kernel::polynomial::polygon::{Clipped, whole_turns};
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(edges: &[Edge<R::Scalar>], [x, y, z]: [R; 3]) -> Jet<R> {
    let zero = R::splat(0.0);
    let one = R::splat(1.0);
    let half = R::splat(0.5);
    let tiny = R::splat(1e-30);
    let z2 = z * z;
    let disc2 = ((one - z) * (one + z)).max(zero);

    // First look: whether the disc holds the whole polygon, or meets no edge, and whether all is
    // far.
    let (mut inside, mut far, mut met, mut double_area) = (one, one, zero, zero);
    for edge in edges {
        let part = Clipped::new(edge, disc2, x, y);
        inside = inside.min(part.whole);
        met = met.max(part.half);
        let away = part.h * part.h + part.middle * part.middle;
        let short = (R::splat(16.0) * part.half * part.half).lt(away);
        far = far.min(R::select(short, one, zero));
        double_area = double_area - R::lift(edge.offset) * R::lift(edge.length);
    }
    let far = zero.lt(far);
    let at_middle = R::both(far, zero.lt(inside));

    let from_foot = x * x + y * y;
    let foot = Level::new(z2);
    let chosen = R::select(at_middle, z2 + from_foot, R::select(far, one, z2));
    let level = Level::new(chosen.min(one));
    // C of Φ and of the primitive of −H′.
    let (lift, drop) = foot.rise(&level, from_foot);
    let scale = one / from_foot.max(tiny);
    let mean = R::select(at_middle, lift * scale, zero);
    let mean1 = R::select(at_middle, -half * drop * scale, zero);
    // H at the reference. Around a whole polygon a constant adds nothing to the gradient.
    let whole = zero.lt(inside);
    let base = R::select(far, zero, R::select(whole, zero, foot.height()));

    let (mut value, mut slope, mut angle, mut seen) = (zero, zero, zero, zero);
    let mut in_plane = [zero; 2];
    for edge in edges {
        let part = Clipped::new(edge, disc2, x, y);
        let h2 = part.h * part.h;
        let core = (R::splat(INNER2) - z2 - h2).max(zero).sqrt();
        let centre = R::lift(edge.start) + half * R::lift(edge.length);
        let offset = R::lift(edge.offset);
        // Places are measured from the part's middle.
        let (low, high) = (-core - part.middle, core - part.middle);
        let (mut phi, mut phi1, mut g, mut sight) = (zero, zero, zero, zero);
        for (from, to, rule) in [
            (-part.half, part.half.min(low), rule::<R>()),
            (low.max(-part.half), high.min(part.half), rule_inside::<R>()),
            (high.max(-part.half), part.half, rule::<R>()),
        ] {
            let (middle, reach) = (half * (from + to), (half * (to - from)).max(zero));
            for [node, weight] in rule {
                for sign in [1.0, -1.0] {
                    let tau = middle + R::splat(sign * node) * reach;
                    let t = part.middle + tau;
                    let s2 = h2 + t * t;
                    let e = centre + tau;
                    let step = R::select(
                        at_middle,
                        e * (e - part.along - part.along)
                            + offset * (offset - part.inward - part.inward),
                        R::select(far, -(part.reach2 - t * t).max(zero), s2),
                    );
                    let (lift, drop) = level.rise(&Level::new((z2 + s2).min(one)), step);
                    let weight = R::splat(*weight) * reach;
                    let near = weight / s2.max(tiny);
                    phi = phi + near * (lift - mean * step);
                    phi1 = phi1 - near * (half * drop + mean1 * step);
                    g = g + weight * (base + drop);
                    sight = sight + near;
                }
            }
        }
        value = value + part.h * phi;
        slope = slope + part.h * phi1;
        seen = seen + part.h * sight;
        angle = angle + part.outside(edge);
        let [ax, ay] = edge.along.map(R::lift);
        in_plane = [in_plane[0] - ay * g, in_plane[1] + ax * g];
    }
    let angle = R::select(zero.lt(met), angle, whole_turns(angle));
    let angle = R::select(far, whole_turns(angle + seen), angle);
    let angle = R::select(at_middle, zero, angle);
    let rim = Level::new(one);
    let (lift, drop) = foot.rise(&rim, disc2);
    let value = value + angle * lift + double_area * mean;
    let slope = slope - angle * half * drop + double_area * mean1;
    Jet {
        value,
        gradient: [in_plane[0], in_plane[1], R::splat(-2.0) * z * slope],
    }
}

/// Squared distance at which the kernel is taken.
struct Level<R: Real> {
    q: R,
    /// Root of q, at least ⅓.
    root: R,
    inner: R::Mask,
}

impl<R: Real> Level<R> {
    #[inline(always)]
    fn new(q: R) -> Self {
        Self {
            q,
            root: q.sqrt().max(R::splat(INNER)),
            inner: q.lt(R::splat(INNER2)),
        }
    }

    /// H.
    #[inline(always)]
    fn height(&self) -> R {
        let one = R::splat(1.0);
        let rest = (one - self.root).max(R::splat(0.0));
        R::select(
            self.inner,
            one - R::splat(3.0) * self.q,
            R::splat(1.5) * rest * rest,
        )
    }

    /// Returns the differences of `½∫H dq` and of H from this level to another, `step` higher.
    ///
    /// The step is divided between the two sides of u = ⅓. Rounding of that division does not
    /// matter, since H is continuous there.
    #[inline(always)]
    fn rise(&self, to: &Self, step: R) -> (R, R) {
        let zero = R::splat(0.0);
        let kink = R::splat(INNER2);
        let cut = to.q.max(kink) - self.q.max(kink);
        let outer = R::select(
            self.inner,
            R::select(to.inner, zero, cut),
            R::select(to.inner, cut, step),
        );
        let inner = step - outer;
        let (a, b) = (to.root, self.root);
        let sum = a + b;
        let by_sum = R::splat(1.0) / sum;
        let squares = a * a + b * b;
        let below = to.q.min(kink) + self.q.min(kink);
        let lift = inner * (R::splat(0.5) - R::splat(0.75) * below)
            + outer * (R::splat(0.75) - (squares + a * b) * by_sum + R::splat(0.375) * squares);
        let drop = R::splat(-3.0) * inner - R::splat(1.5) * outer * by_sum * (R::splat(2.0) - sum);
        (lift, drop)
    }
}
