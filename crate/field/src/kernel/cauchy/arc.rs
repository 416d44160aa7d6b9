//! The Cauchy kernel along a circular arc (thesis 2.22, whose printed form fails on half of all
//! inputs; multiplied by the radius, so that the density is per unit length).
//!
//! The circle of radius r lies in the plane z = 0. The origin is a point M of it on the arc's line
//! of symmetry: the arc's middle if the arc is at most a half circle (σ = 1), else the middle of
//! the gap (σ = −1). The x axis points outward. The half angle of the arc is α. With
//! `X = r + x` (so that (X, y, z) is measured from the centre), `ρ² = X²+y²`, `A = 1+r²+ρ²+z²`,
//! `Δ = A²−4r²ρ² = (1+z²+(ρ−r)²)(1+z²+(ρ+r)²)`, and D₁, D₂ = 1 + squared distances from the ends:
//!
//! `f = r·[2A(δ − sin δ cos δ)/Δ^{3/2} + sin 2α/(D₁D₂)]`,
//! `√(D₁D₂)·(sin δ, cos δ) = (√Δ sin α, A cos α − 2σrX)`.
//!
//! δ runs from 0 to π continuously: there is no branch to continue, and the azimuth, which is
//! undefined on the axis ρ = 0, does not occur. `A cos α − 2σrX = σ(1+x²+y²+z² − A(1 − σ cos α))`
//! keeps the digits of arcs that are long compared to the kernel's width.
//!
//! Gradient, with S = sin δ and K = ∫₀^δ sin⁴:
//! `∇f/r = 2(δ−sin δ cos δ)∇A/Δ^{3/2} − 8AK∇Δ/Δ^{5/2}`
//! `− 4AS³∇c/(Δ^{3/2}√(D₁D₂)) − sin 2α·∇(D₁D₂)/(D₁D₂)²`.
use crate::angle::angle;
use crate::bone::Arc;
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(arc: &Arc<R::Scalar>, [x, y, z]: [R; 3]) -> Jet<R> {
    let one = R::splat(1.0);
    let two = R::splat(2.0);
    let four = R::splat(4.0);
    let radius = R::lift(arc.radius);
    let side = R::lift(arc.side);
    let sine_half = R::lift(arc.sine);
    let double_sine = R::lift(arc.double_sine);
    let versine = R::lift(arc.versine);

    let (x2, y2, z2) = (x * x, y * y, z * z);
    let centred = radius + x;
    let zone = one + z2;
    // ρ² − r², without subtracting large squares.
    let excess = two * radius * x + x2 + y2;
    let rho = (centred * centred + y2).sqrt();
    let outer = rho + radius;
    let gap = excess / outer.max(R::splat(1e-30));
    let near = zone + gap * gap;
    let far = zone + outer * outer;
    let total = R::splat(0.5) * (near + far);
    let i_delta = one / (near * far);
    let root = i_delta.sqrt();

    // Squared distances from the ends.
    let end_x = x + radius * versine;
    let chord = radius * sine_half;
    let (y_1, y_2) = (y + chord, y - chord);
    let common = zone + end_x * end_x;
    let (i1, i2) = (one / (common + y_1 * y_1), one / (common + y_2 * y_2));
    let ends = i1 * i2;
    let ends_root = ends.sqrt();

    let sine = sine_half * (near * far).sqrt() * ends_root;
    let cosine = side * (zone + x2 + y2 - total * versine) * ends_root;
    let turn = angle(sine, cosine);

    let weight = four * root * i_delta;
    let value = radius * (weight * total * turn.sin2 + double_sine * ends);

    // Coefficients of the gradients of A, Δ, c and of the ends' distances.
    let of_total = weight * turn.sin2;
    let of_delta = R::splat(-8.0) * total * i_delta * root * turn.sin4;
    let of_cosine = -weight * total * sine * sine * sine * ends_root;
    let of_ends = -two * double_sine * ends;
    let planar = four * (zone + excess) * i_delta;
    let axial = four * total * i_delta;
    let cx = side * two * (x - versine * centred);
    let cyz = side * two * (one - versine);
    let gradient = [
        two * of_total * centred
            + of_delta * planar * centred
            + of_cosine * cx
            + of_ends * end_x * (i1 + i2),
        (two * of_total + of_delta * planar + of_cosine * cyz) * y
            + of_ends * (y_1 * i1 + y_2 * i2),
        (two * of_total + of_delta * axial + of_cosine * cyz + of_ends * (i1 + i2)) * z,
    ];
    Jet {
        value,
        gradient: gradient.map(|g| radius * g),
    }
}
