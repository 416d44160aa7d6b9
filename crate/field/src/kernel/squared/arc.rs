//! The squared kernel along a circular arc.
//!
//! The frame is that of the [Cauchy arc](crate::kernel::cauchy::arc): the origin is the middle of
//! the arc (σ = 1) or of its gap (σ = −1) on the circle of radius r, whose centre is at (−r, 0, 0);
//! α is half the arc's angle. With `X = r+x`, `ρ² = X²+y²`, `A = r²+ρ²+z²+ε²`, `Δ = A²−4r²ρ² =
//! (z²+ε²+(ρ−r)²)(z²+ε²+(ρ+r)²)` and D₁, D₂ = ε² + squared distances from the ends:
//!
//! `f = 2rδ/√Δ`, `√(D₁D₂)·(sin δ, cos δ) = (√Δ sin α, C)`, `C = A cos α − 2σrX`.
//!
//! δ runs from 0 to π continuously: no azimuth, no branch to continue.
//! `C = σ(x²+y²+z²+ε² − A(1 − σ cos α))` keeps the digits of arcs of huge circles.
//!
//! Gradient: `∇f = −2r·[(δ − sin δ cos δ)/2·∇Δ/Δ^{3/2} + sin α·∇C/(D₁D₂)]`.
use crate::angle::angle;
use crate::bone::Arc;
use crate::kernel::POLE2;
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(arc: &Arc<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let one = R::splat(1.0);
    let two = R::splat(2.0);
    let places = Places::of(arc, p);
    let [_, y, z] = p;
    let i_delta = one / (places.near * places.far);
    let root = i_delta.sqrt();
    let ends = one / (places.ends[0] * places.ends[1]);
    let ends_root = ends.sqrt();
    let sine_half = R::lift(arc.sine);
    let sine = sine_half * (places.near * places.far).sqrt() * ends_root;
    let turn = angle(sine, places.cosine * ends_root);

    let twice = two * R::lift(arc.radius);
    let of_delta = -twice * turn.sin2 * root * R::splat(4.0) * i_delta;
    let planar = of_delta * places.planar;
    let axial = of_delta * places.total;
    let of_cosine = -twice * sine_half * ends;
    let [cx, cyz] = places.slopes;
    Jet {
        value: twice * turn.theta * root,
        gradient: [
            planar * places.centred + of_cosine * cx,
            (planar + of_cosine * cyz) * y,
            (axial + of_cosine * cyz) * z,
        ],
    }
}

/// Distances that the formulas for arcs of both kernels are made of, see the module.
pub struct Places<R> {
    /// X.
    pub centred: R,
    /// ρ.
    pub rho: R,
    /// ρ−r.
    pub gap: R,
    /// `z²+ε²+(ρ−r)²`.
    pub near: R,
    /// `z²+ε²+(ρ+r)²`.
    pub far: R,
    /// The sum A.
    pub total: R,
    /// D₁ and D₂.
    pub ends: [R; 2],
    /// Halves of their gradients in x and y; the z axis's half is z.
    pub to_ends: [[R; 2]; 2],
    /// C.
    pub cosine: R,
    /// ∂C/∂x, and the common factor of ∂C/∂y and ∂C/∂z on y and z.
    pub slopes: [R; 2],
    /// `z²+ε²+ρ²−r²`: ∇Δ is `4·planar·(X, y)` in the plane and `4Az` across.
    pub planar: R,
}

impl<R: Real> Places<R> {
    /// Computes them at a local position.
    #[inline(always)]
    pub fn of(arc: &Arc<R::Scalar>, [x, y, z]: [R; 3]) -> Self {
        let two = R::splat(2.0);
        let radius = R::lift(arc.radius);
        let side = R::lift(arc.side);
        let versine = R::lift(arc.versine);
        let (x2, y2) = (x * x, y * y);
        let zone = z * z + R::splat(POLE2);
        let centred = radius + x;
        // ρ² − r², without subtracting large squares.
        let excess = two * radius * x + x2 + y2;
        let rho = (centred * centred + y2).sqrt();
        let outer = rho + radius;
        let gap = excess / outer.max(R::splat(1e-30));
        let near = zone + gap * gap;
        let far = zone + outer * outer;
        let total = R::splat(0.5) * (near + far);
        let end_x = x + radius * versine;
        let chord = radius * R::lift(arc.sine);
        let (y_1, y_2) = (y + chord, y - chord);
        let common = zone + end_x * end_x;
        let two_side = side + side;
        Self {
            centred,
            rho,
            gap,
            near,
            far,
            total,
            ends: [common + y_1 * y_1, common + y_2 * y_2],
            to_ends: [[end_x, y_1], [end_x, y_2]],
            cosine: side * (zone + x2 + y2 - total * versine),
            slopes: [
                two_side * (x - versine * centred),
                two_side * (R::splat(1.0) - versine),
            ],
            planar: zone + excess,
        }
    }
}
