//! The cubed kernel along a circular arc: elliptic integrals of the first and the second kind,
//! incomplete but for a closed circle.
//!
//! The frame and the distances ε, σ, α, ρ, A, D₁, D₂, C are those of the [squared kernel's
//! arc](crate::kernel::squared::arc); n, m, s and M those of the [inverse
//! kernel's](crate::kernel::inverse::arc). Every squared distance contains `ζ = z²+ε²`, so that the
//! cubed kernel is −2 times the inverse kernel's derivative by ζ: `f = −2∂f₁/∂ζ`, `f₁ = 4rs·R_F(M,
//! y, z)`, `y = M+s²n`, `z = M+s²m`. M moves all three arguments at once, and the sum of R_F's
//! three derivatives is elementary:
//!
//! `f = 4rs·[2g′/√(yz) + s²(R_y + R_z)/3]`, `R_y = R_D(M, z, y)`, `R_z = R_D(M, y, z)`, `g = √M`,
//! `g′ = ∂g/∂ζ`.
//!
//! Both terms are positive. With `P = √(D₁D₂)` and
//! `e = (D₁+D₂)/(2P) − 1 = (D₁−D₂)²/(2P(D₁+D₂+2P))`,
//! - where C > 0: `g² = (P+C)/2` and `2gg′ = e/2 + cos²(α/2)`;
//! - else `g² = nm·sin²α/(2(P−C))` and `2g′/g = 1/n + 1/m − (e+2s²)/(P−C)`. A closed circle has g
//!   = 0.
//!
//! Gradient:
//! `∇f = 4rs·[2∇g′/√(yz) − g′/√(yz)·(∇y/y + ∇z/z) − s²∇g/√(yz)·(1/y+1/z) − 2s⁴(S_y∇n + S_z∇m)]`,
//! where S are [sums of second derivatives](crate::carlson) of R_F.
use crate::bone::Arc;
use crate::carlson::elliptic_second;
use crate::kernel::squared::arc::Places;
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(arc: &Arc<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let zero = R::splat(0.0);
    let one = R::splat(1.0);
    let two = R::splat(2.0);
    let half = R::splat(0.5);
    let radius = R::lift(arc.radius);
    let places = Places::of(arc, p);
    let [_, _, z] = p;
    let Places { near, far, .. } = places;

    // sin²(α/2), its root, and cos²(α/2); versine is 1 − σ cos α.
    let turned = half * R::lift(arc.versine);
    let inner = zero.lt(R::lift(arc.side));
    let s2 = R::select(inner, turned, one - turned);
    let cos2 = R::select(inner, one - turned, turned);
    let s = s2.sqrt();

    let radial = one / places.rho.max(R::splat(1e-30));
    let [ux, uy] = [places.centred * radial, p[1] * radial];
    let [by_near, by_far] = [places.gap, places.rho + radius]
        .map(|off| Vector([two * off * ux, two * off * uy, two * z]));
    let root = Root::of(arc, p, &places, [s2, cos2], [by_near, by_far]);

    let m = root.g * root.g;
    let (y_arg, z_arg) = (m + s2 * near, m + s2 * far);
    let integral = elliptic_second(m, y_arg, z_arg);
    let (i_y, i_z) = (one / y_arg, one / z_arg);
    let i_root = (i_y * i_z).sqrt();
    let elementary = root.rate * i_root;

    let by_m = root.by_place.times(two * root.g);
    let by_y = by_m.plus(by_near.times(s2));
    let by_z = by_m.plus(by_far.times(s2));
    let [sum_y, sum_z] = integral.sums.map(|sum| two * s2 * s2 * sum);
    let less = by_y
        .times(elementary * i_y)
        .plus(by_z.times(elementary * i_z))
        .plus(root.by_place.times(s2 * i_root * (i_y + i_z)))
        .plus(by_near.times(sum_y))
        .plus(by_far.times(sum_z));
    let scale = R::splat(4.0) * radius * s;
    let second = s2 * (integral.first.d_y + integral.first.d_z);
    Jet {
        value: scale * (two * elementary + R::splat(1.0 / 3.0) * second),
        gradient: root
            .rate_by_place
            .times(two * i_root)
            .plus(less.times(-one))
            .times(scale)
            .0,
    }
}

/// A vector, such as a gradient.
#[derive(Clone, Copy)]
struct Vector<R>([R; 3]);

impl<R: Real> Vector<R> {
    #[inline(always)]
    fn times(self, factor: R) -> Self {
        Self(self.0.map(|x| x * factor))
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i] + other.0[i]))
    }

    #[inline(always)]
    fn select(mask: R::Mask, yes: Self, no: Self) -> Self {
        Self(core::array::from_fn(|i| R::select(mask, yes.0[i], no.0[i])))
    }
}

/// `g = √M` and its derivatives.
struct Root<R> {
    /// g.
    g: R,
    /// g′ = ∂g/∂ζ.
    rate: R,
    /// ∇g.
    by_place: Vector<R>,
    /// ∇g′.
    rate_by_place: Vector<R>,
}

impl<R: Real> Root<R> {
    #[inline(always)]
    fn of(
        arc: &Arc<R::Scalar>,
        [_, y, z]: [R; 3],
        places: &Places<R>,
        [s2, cos2]: [R; 2],
        [by_near, by_far]: [Vector<R>; 2],
    ) -> Self {
        let one = R::splat(1.0);
        let two = R::splat(2.0);
        let half = R::splat(0.5);
        let [d1, d2] = places.ends;
        let product = (d1 * d2).sqrt();
        let i_product = one / product;
        let sine = R::lift(arc.sine);
        // (D₁−D₂)/P, of a chord's two ends.
        let uneven = R::splat(4.0) * R::lift(arc.radius) * sine * y * i_product;
        let excess = half * uneven * uneven * (product / (d1 + d2 + two * product));
        let [log_1, log_2] = core::array::from_fn(|i| {
            let [x, y] = places.to_ends[i];
            Vector([x, y, z]).times(two / places.ends[i])
        });
        let by_excess = log_1.plus(log_2.times(-one)).times(R::splat(0.25) * uneven);
        let by_product = log_1.plus(log_2).times(half * product);
        let [cx, cyz] = places.slopes;
        let by_cosine = Vector([cx, cyz * y, cyz * z]);

        // C > 0.
        let g = (half * (product + places.cosine)).sqrt();
        let i_twice = half / g;
        let rate = (half * excess + cos2) * i_twice;
        let by_place = by_product.plus(by_cosine).times(half * i_twice);
        let acute = Self {
            g,
            rate,
            by_place,
            rate_by_place: by_excess
                .times(half * i_twice)
                .plus(by_place.times(-two * i_twice * rate)),
        };

        // C ≤ 0.
        let i_minus = one / (product - places.cosine);
        let (i_near, i_far) = (one / places.near, one / places.far);
        let g = sine * (half * places.near * places.far * i_minus).sqrt();
        let ends = (excess + two * s2) * i_minus;
        let rate_of_log = half * (i_near + i_far - ends);
        let by_minus = by_product.plus(by_cosine.times(-one)).times(i_minus);
        let (log_near, log_far) = (by_near.times(i_near), by_far.times(i_far));
        let by_log = log_near
            .plus(log_far)
            .plus(by_minus.times(-one))
            .times(half);
        let by_rate_of_log = by_minus
            .times(ends)
            .plus(by_excess.times(-i_minus))
            .plus(log_near.times(-i_near))
            .plus(log_far.times(-i_far))
            .times(half);
        let obtuse = Self {
            g,
            rate: g * rate_of_log,
            by_place: by_log.times(g),
            rate_by_place: by_log.times(rate_of_log).plus(by_rate_of_log).times(g),
        };

        let mask = R::splat(0.0).lt(places.cosine);
        Self {
            g: R::select(mask, acute.g, obtuse.g),
            rate: R::select(mask, acute.rate, obtuse.rate),
            by_place: Vector::select(mask, acute.by_place, obtuse.by_place),
            rate_by_place: Vector::select(mask, acute.rate_by_place, obtuse.rate_by_place),
        }
    }
}
