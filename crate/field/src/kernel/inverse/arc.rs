//! The inverse kernel along a circular arc: one elliptic integral.
//!
//! The frame and the distances ε, σ, α, ρ, A, Δ, D₁, D₂, C are those of the [squared kernel's
//! arc](crate::kernel::squared::arc); `n, m = z²+ε²+(ρ∓r)²` are the squares of the nearest and the
//! farthest distance from the circle, and `s = sin(α/2)`. The thesis has no formula. With t =
//! tan(θ/2) the integral over the arc is that of one over the root of two quadratics, which Carlson
//! (A table of elliptic integrals: two quadratic factors, 1992) gives between any two limits as one
//! R_F:
//!
//! `f = 4rs·R_F(M, M+s²n, M+s²m)`, `M = ½(√(D₁D₂) + C)`.
//!
//! Nothing is split at the azimuth and no term is subtracted. Where C is negative
//! `M = ½Δ sin²α/(√(D₁D₂) − C)`; a closed circle has M = 0, a complete integral.
//!
//! Gradient, by the chain rule. M moves all three arguments at once, and the sum of R_F's three
//! derivatives is elementary, so that two R_D are enough:
//! `∇f = −(2rs/3)·[3∇M/√(M(M+s²n)(M+s²m)) + R_n·s²∇n + R_m·s²∇m]`, `R_n = R_D(M, M+s²m, M+s²n)`,
//! `R_m = R_D(M, M+s²n, M+s²m)`. `∇M/√M` is computed as a whole, since M may be 0.
use crate::bone::Arc;
use crate::carlson::elliptic;
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
    let [_, y, z] = p;
    let Places { near, far, .. } = places;

    // sin²(α/2) and its root; versine is 1 − σ cos α.
    let turned = half * R::lift(arc.versine);
    let inner = zero.lt(R::lift(arc.side));
    let s2 = R::select(inner, turned, one - turned);
    let s = s2.sqrt();

    let product = (places.ends[0] * places.ends[1]).sqrt();
    // δ < π/2
    let acute = zero.lt(places.cosine);
    let sine = R::lift(arc.sine);
    let twice = R::select(acute, product + places.cosine, product - places.cosine);
    let i_twice = one / twice;
    let obtuse_m = near * far * (half * sine * sine * i_twice);
    let m = R::select(acute, half * twice, obtuse_m);
    let root = m.sqrt();
    let (y_arg, z_arg) = (m + s2 * near, m + s2 * far);
    let integral = elliptic(m, y_arg, z_arg);

    // ∇M/√M is ½∇(√(D₁D₂)+C)/√M, or √M·(∇Δ/Δ − ∇(√(D₁D₂)−C)/(√(D₁D₂)−C)).
    let by_root = R::select(acute, half / root.max(R::splat(1e-30)), -root * i_twice);
    let i_delta = R::splat(4.0) * root / (near * far);
    let of_delta = R::select(acute, zero, i_delta);
    let outer = R::splat(3.0) / (y_arg.sqrt() * z_arg.sqrt());
    let of_product = outer * by_root * half * product;
    let of_cosine = outer * R::select(acute, by_root, -by_root);
    let of_delta = outer * of_delta;
    let product_by = places.ends.map(|d| two * of_product / d);

    // n and m in the plane: ∇ρ times 2(ρ−r) and 2(ρ+r).
    let (of_near, of_far) = (two * s2 * integral.d_y, two * s2 * integral.d_z);
    let along_rho = of_near * places.gap + of_far * (places.rho + radius);
    let by_centred = along_rho / places.rho.max(R::splat(1e-30)) + of_delta * places.planar;
    let [[x_1, y_1], [x_2, y_2]] = places.to_ends;
    let [cx, cyz] = places.slopes;
    let across = of_near
        + of_far
        + of_delta * places.total
        + product_by[0]
        + product_by[1]
        + of_cosine * cyz;
    let scale = radius * s;
    let slope = R::splat(-2.0 / 3.0) * scale;
    Jet {
        value: R::splat(4.0) * scale * integral.f,
        gradient: [
            slope
                * (by_centred * places.centred
                    + product_by[0] * x_1
                    + product_by[1] * x_2
                    + of_cosine * cx),
            slope
                * (by_centred * y
                    + product_by[0] * y_1
                    + product_by[1] * y_2
                    + of_cosine * cyz * y),
            slope * across * z,
        ],
    }
}
