//! The cubed kernel along a line segment whose radius varies evenly along it.
//!
//! The segment lies on the x axis, |x| ≤ c; the radius at its point t is `r(t) = r₁ + kt`, in units
//! of the smaller of those at its ends. The factor on the kernel is that of a uniform line of that
//! radius, and the pole is rounded off by the same part ε of it everywhere, so that a cone's
//! magnified copy has the same field:
//!
//! `f = r(−c)·∫ r(t)²/D^{3/2} dt`, `D = (x−t)² + y²+z² + ε²r(t)²`.
//!
//! D is the square of a distance from a line in four dimensions. With `α = 1+ε²k²`, `a = r(x)/α`,
//! the foot of the perpendicular at `x − s`, `s = ε²ka`, and u measured from there, `D = α(u²+m²)`,
//! `m² = (y²+z²)/α + ε²a²`, and `r = a+ku`. So
//!
//! `f = r(−c)·α^{−3/2}·(a²J₀ + 2akJ₁ + k²J₂)`, `Jₙ = ∫ uⁿ/(u²+m²)^{3/2} du` over `[u₀, u₁]`.
//!
//! With the distances A and B of the ends, `N = u₁A − u₀B` and P the sum of squared inverse
//! distances,
//! - `J₀ = N/(m²AB)`, `J₁ = 1/A − 1/B = l(u₀+u₁)/(AB(A+B))`, `J₂ = arsinh(N/m²) − m²J₀`;
//! - gradient: `∇f ∝ (Q − sP, −yP, −zP)/α` with `P = 3(a²K₀ + 2akK₁ + k²K₂)`,
//!   `Q = 3(a²K₁ + 2akK₂ + k²K₃)`, `Kₙ = ∫ uⁿ/(u²+m²)^{5/2} du`, which J₀ and J₁ divide: of K₀ see
//!   the [segment](super::segment), `3K₁ = J₁(1/A² + 1/(AB) + 1/B²)`,
//!   `3K₂ = J₀(u₀²/A² + u₀u₁/(AB) + u₁²/B²)`, `K₃ = J₁ − m²K₁`.
//!
//! Far away these terms cancel, as a is the radius that the cone would have at the foot. There the
//! integrand is smooth, and a Gauss–Legendre rule takes their place: from 3c off, at least, its n
//! nodes are right to 5.8^{−2n}.
use super::Ends;
use crate::kernel::POLE2;
use crate::legendre;
use crate::{Jet, Real};

/// A cone for the cubed kernel, its middle at the origin and its axis on the x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone<S> {
    /// Half the length c.
    pub(crate) half: S,
    /// r₁, the radius at the middle.
    pub(crate) middle: S,
    /// k.
    pub(crate) slope: S,
    /// 1/α; of compact kernels `1/(1−k²)`.
    pub(crate) upright: S,
    /// `r(−c)` and `r(−c)·α^{−3/2}`; of compact kernels both are the former.
    pub(crate) scales: [S; 2],
}

/// Largest change of the radius over the length. Steeper ones are short compared with their radii.
const STEEPEST: f64 = 30.0;

/// The rules far away.
const SINGLE: &[(f64, f64)] = &legendre::pairs::<3>();
const DOUBLE: &[(f64, f64)] = &legendre::pairs::<5>();

impl Cone<f64> {
    /// Prepares a cone from half its length and the radii at its start and its end, in units of the
    /// smaller one. Returns `None` if the cone is too steep.
    pub fn new(half: f64, [start, end]: [f64; 2]) -> Option<Self> {
        let slope = (end - start) / (2.0 * half);
        let alpha = 1.0 + POLE2 * slope * slope;
        (slope.abs() <= STEEPEST).then(|| Self {
            half,
            middle: 0.5 * (start + end),
            slope,
            upright: 1.0 / alpha,
            scales: [start, start / (alpha * alpha.sqrt())],
        })
    }
}

impl Cone<f64> {
    /// Prepares a cone for a compact kernel, from half its length and the radii of its support at
    /// its start and its end, in units of the smaller one.
    pub fn of_support(half: f64, [start, end]: [f64; 2]) -> Self {
        let slope = (end - start) / (2.0 * half);
        Self {
            half,
            middle: 0.5 * (start + end),
            slope,
            upright: 1.0 / (1.0 - slope * slope),
            scales: [start, start],
        }
    }
}

impl<S: Copy> Cone<S> {
    /// Converts the cone to another number type.
    pub fn cast<Q>(&self, f: impl Fn(S) -> Q) -> Cone<Q> {
        Cone {
            half: f(self.half),
            middle: f(self.middle),
            slope: f(self.slope),
            upright: f(self.upright),
            scales: [f(self.scales[0]), f(self.scales[1])],
        }
    }
}

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(cone: &Cone<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let [x, y, z] = p;
    let reach = R::splat(3.0) * R::lift(cone.half);
    let (limit, square) = (reach * reach, x * x + y * y + z * z);
    let (far, near) = (limit.lt(square), square.lt(limit * R::splat(1.0 + 1e-6)));
    let zero = Jet::zero();
    // A lane takes one of the two, and leaves the other.
    let closed = if R::any(near) { beside(cone, p) } else { zero };
    let rule = if R::any(far) { afar(cone, p) } else { zero };
    Jet {
        value: R::select(far, rule.value, closed.value),
        gradient: core::array::from_fn(|i| R::select(far, rule.gradient[i], closed.gradient[i])),
    }
}

/// The closed form.
#[inline(always)]
fn beside<R: Real>(cone: &Cone<R::Scalar>, [x, y, z]: [R; 3]) -> Jet<R> {
    let half = R::lift(cone.half);
    let length = half + half;
    let (k, upright) = (R::lift(cone.slope), R::lift(cone.upright));
    let pole = R::splat(POLE2);
    let a = (R::lift(cone.middle) + k * x) * upright;
    let shift = pole * k * a;
    let m2 = ((y * y + z * z) * upright + pole * a * a).max(R::splat(1e-25));
    let (start, end) = (shift - (x + half), (half - x) + shift);
    let ends = Ends::of(m2, start, end, length);
    let [i2_a, i2_b] = ends.inverse;
    let i_ab = R::splat(1.0) / ends.product;
    let squares = i2_a + i2_b;
    let j0 = ends.field;
    let j1 = length * (start + end) / ends.sum * i_ab;
    let j2 = (j0 * ends.product).asinh() - m2 * j0;

    let beyond = (squares - m2 * i2_a * i2_b) * (ends.product / ends.cosines[0]);
    let within = ends.cosines[1] / (ends.product * m2);
    let is_within = ends.both.lt(R::splat(0.0));
    let k0 = j0 * (squares + R::select(is_within, within, beyond));
    let mixed = squares + i_ab;
    let k1 = j1 * mixed;
    let k2 = j0 * (start * start * i2_a + ends.both * i_ab + end * end * i2_b);
    let k3 = R::splat(3.0) * j1 - m2 * k1;

    let weights = [a * a, R::splat(2.0) * a * k, k * k];
    let sum = |terms: [R; 3]| weights[0] * terms[0] + weights[1] * terms[1] + weights[2] * terms[2];
    let scale = R::lift(cone.scales[1]);
    let across = sum([k0, k1, k2]);
    let along = sum([k1, k2, k3]) - shift * across;
    let slope = scale * upright;
    Jet {
        value: scale * sum([j0, j1, j2]),
        gradient: [slope * along, -slope * across * y, -slope * across * z],
    }
}

/// The rule.
#[inline(always)]
fn afar<R: Real>(cone: &Cone<R::Scalar>, [x, y, z]: [R; 3]) -> Jet<R> {
    let half = R::lift(cone.half);
    let (middle, slope) = (R::lift(cone.middle), R::lift(cone.slope));
    let square = y * y + z * z;
    let zero = R::splat(0.0);
    let (mut value, mut along, mut across) = (zero, zero, zero);
    for &(node, weight) in legendre::choose::<R>(SINGLE, DOUBLE) {
        for node in [-node, node] {
            let t = half * R::splat(node);
            let radius = middle + slope * t;
            let d = t - x;
            let rounded = R::splat(POLE2) * radius * radius;
            let inverse = R::splat(1.0) / (d * d + square + rounded);
            let cube = R::splat(weight) * (radius * radius) * inverse * inverse.sqrt();
            value = value + cube;
            let fifth = R::splat(3.0) * cube * inverse;
            along = along + fifth * d;
            across = across + fifth;
        }
    }
    let scale = R::lift(cone.scales[0]) * half;
    Jet {
        value: scale * value,
        gradient: [scale * along, -scale * across * y, -scale * across * z],
    }
}
