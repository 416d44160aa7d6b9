//! The cubed kernel along a line segment.
//!
//! The segment lies on the x axis, |x| ≤ c. With `ρ² = y²+z²+ε²`, `a = x+c`, `b = c−x` (signed
//! distances of the foot of the perpendicular from the ends) and the distances `A = √(ρ²+a²)`,
//! `B = √(ρ²+b²)`,
//!
//! `f = (a/A + b/B)/ρ²`.
//!
//! Beyond the ends, where one of a and b is negative, `a/A + b/B = 4cxρ²/(AB(aB−bA))`: nothing
//! cancels, and ρ² divides out.
//!
//! Gradient: `∂f/∂x = 1/A³ − 1/B³ = −4cx(A²+AB+B²)/((A+B)A³B³)`, and
//! `∂f/∂y = −3y·∫du/(ρ²+u²)^{5/2}`. The sines p = a/A and q = b/B make that integral
//! `((p+q) − (p³+q³)/3)/ρ⁴`, of which the field divides out:
//! `∂f/∂y = −y·f·(1/A² + 1/B² + (1+pq)/ρ²)`, and beyond the ends
//! `(1+pq)/ρ² = (1/A² + 1/B² − ρ²/(A²B²))/(1−pq)`.
use super::Ends;
use crate::bone::Segment;
use crate::kernel::POLE2;
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(segment: &Segment<R::Scalar>, [x, y, z]: [R; 3]) -> Jet<R> {
    let zero = R::splat(0.0);
    let half = R::lift(segment.half);
    let length = half + half;
    let rho2 = y * y + z * z + R::splat(POLE2);
    let (start, end) = (-(x + half), half - x);
    let ends = Ends::of(rho2, start, end, length);
    let [i2_a, i2_b] = ends.inverse;
    let i_ab = R::splat(1.0) / ends.product;
    let squares = i2_a + i2_b;
    // pq = −t₀t₁/(AB), of whose two signs the first is beside the segment.
    let beyond = (squares - rho2 * i2_a * i2_b) * (ends.product / ends.cosines[0]);
    let beside = ends.cosines[1] / (ends.product * rho2);
    let radial = -ends.field * (squares + R::select(ends.both.lt(zero), beside, beyond));
    let along = R::splat(-2.0) * length * x / ends.sum * i_ab * (squares + i_ab);
    Jet {
        value: ends.field,
        gradient: [along, radial * y, radial * z],
    }
}
