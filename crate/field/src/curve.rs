//! Fields of any kernel along a cubic curve, or along any bone whose width varies:
//! `∫ α G(ωg) |q′| dt` with `g(t) = |p − q(t)|²`, by Gauss–Legendre quadrature on the spans of
//! [`bone::curve`](crate::bone::curve).
//!
//! - Smooth kernels (Cauchy, Gauss): nodes are prepared with their weights, and the field is a sum
//!   over them.
//! - Other kernels: a span is first written around the place t* of the extremum of g (of ωg for
//!   compact kernels), in powers of s = t − t*: positions relative to p, and with them g and |q′|²,
//!   so that nothing cancels near the curve.
//! - Compact kernels: on either side of t* the function ωg is monotonic, so it passes 1 at most
//!   once: where, is found by Newton's method from the root of a parabola (exact on straight spans
//!   without taper). The rule is applied to what lies inside. Outside the support the field is
//!   exactly 0. Metaballs' inner piece, ωg < 1/9, is found in the same way and integrated by
//!   itself.
//! - Kernels with a pole (inverse, squared, cubed): the integrand has a peak of the width
//!   `b = √((g* + ε²/ω)/|q′|²)` around t*. With `s = b·sinh x` this becomes smooth: `ds/√(s²+b²)`
//!   is `dx`, and `ds/(s²+b²)` is `dx/(b·cosh x)`, which is as wide as 1 however long the interval
//!   of x (the cubed kernel's is `dx/(b·cosh x)²`). So `x = (π/2)·sinh y` on top: it takes the
//!   singularities of the secant from ±iπ/2 to where those of y are, and the interval from ±12 (for
//!   points on the curve itself) to ±2.8.
//!
//! The gradient `2∫ αωG′|q′|·(p−q) dt` comes from the same nodes: with `q − p = Σ eₖsᵏ` it is
//! `−2Σ eₖ ∫αωG′|q′|sᵏ`. Ends of the support do not move it, since kernels are continuous.
//!
//! Accuracy (tests/it/chart.rs and tests/it/taper.rs): double precision 10⁻⁹ of the value, single
//! 10⁻⁵. Within 10⁻³ widths of a bone whose kernel has a pole single precision is right to 3·10⁻⁴
//! (cubed: 10⁻³), since there it counts that the ends of spans are rounded: by 10⁻⁸, where the
//! squared kernel is 10¹⁰ high and the cubed one 10¹⁵.
use crate::bone::Curve;
use crate::bone::curve::{SINGLE_TERMS, Span, TERMS};
use crate::kernel::POLE2;
use crate::kernel::falloff::{Falloff, Tail};
use crate::{Jet, Real};

/// Factor in `x = STEEP·sinh y` (see the module).
const STEEP: f64 = core::f64::consts::FRAC_PI_2;

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<K: Falloff, R: Real>(bone: &Curve<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let pair = |q: R| {
        let (value, fall) = K::falling(q);
        (value, -fall)
    };
    match K::TAIL {
        Tail::Compact => compact(bone, p, K::KINKS, pair),
        Tail::Power { exponent, .. } if K::TAIL.has_pole() => {
            with_pole(bone, p, exponent > 1, pair)
        }
        Tail::Power { .. } | Tail::Fast => smooth(bone, p, pair),
    }
}

#[inline(always)]
fn smooth<R: Real>(bone: &Curve<R::Scalar>, p: [R; 3], pair: impl Fn(R) -> (R, R)) -> Jet<R> {
    let [value, x, y, z] = R::add_over([R::splat(0.0); 4], &bone.nodes, |node| {
        let d: [R; 3] = core::array::from_fn(|i| p[i] - R::lift(node.position[i]));
        let weight = R::lift(node.weight);
        let square = dot(d, d);
        let (value, slope) = if bone.tapered {
            let thinness = R::lift(node.thinness);
            let (value, rate) = pair(thinness * square);
            (weight * value, weight * thinness * rate)
        } else {
            let (value, rate) = pair(square);
            (weight * value, weight * rate)
        };
        [value, slope * d[0], slope * d[1], slope * d[2]]
    });
    Jet {
        value,
        gradient: [x + x, y + y, z + z],
    }
}

#[inline(always)]
fn with_pole<R: Real>(
    bone: &Curve<R::Scalar>,
    p: [R; 3],
    twice: bool,
    pair: impl Fn(R) -> (R, R),
) -> Jet<R> {
    let one = R::splat(1.0);
    let half = R::splat(0.5);
    let twice = twice || R::DOUBLE;
    let total = R::add_over([R::splat(0.0); 4], &bone.spans, |span| {
        let mut t = Slope::new(span, p).extremum(|slope, t| slope.at(t));
        // Converge to the last digit, since the peak may be that narrow.
        for _ in 0..if R::DOUBLE { 4 } else { 3 } {
            let [e0, e1, e2, _] = relative(span, t, p);
            let square = dot(e1, e1);
            let rate = (square + R::splat(2.0) * dot(e0, e2)).max(half * half * square);
            t = (t - dot(e0, e1) / nonzero(rate)).max(-one).min(one);
        }
        let around = Around::new(span, bone.tapered, t, p);
        let square = around.square[0];
        let pole = if bone.tapered {
            R::splat(POLE2) / around.thinness(R::splat(0.0)).0
        } else {
            R::splat(POLE2)
        };
        // A few spans away there is no peak, and sinh of small numbers loses digits.
        let b = ((square + pole) / nonzero(around.speed[0]))
            .sqrt()
            .min(R::splat(8.0));
        let inverse = one / b;
        let steep = R::splat(STEEP);
        let [low, high] = [-one, one].map(|end| {
            let x = ((end - t) * inverse).asinh();
            if twice { (x / steep).asinh() } else { x }
        });
        let (middle, reach) = (half * (high + low), half * (high - low));
        let (half_b, half_steep) = (half * b, half * steep);
        let sums = R::add_over([R::splat(0.0); 5], &bone.rule, |[node, weight]| {
            let mut x = middle + reach * R::lift(*node);
            let mut rate = R::lift(*weight) * reach;
            if twice {
                let grown = x.exp();
                let shrunk = one / grown;
                x = half_steep * (grown - shrunk);
                rate = rate * half_steep * (grown + shrunk);
            }
            let grown = x.exp();
            let shrunk = one / grown;
            let s = half_b * (grown - shrunk);
            around.terms(s, rate * half_b * (grown + shrunk), &pair)
        });
        around.jet(sums)
    });
    jet_of(total)
}

#[inline(always)]
fn compact<R: Real>(
    bone: &Curve<R::Scalar>,
    p: [R; 3],
    kinks: &[f64],
    pair: impl Fn(R) -> (R, R),
) -> Jet<R> {
    let total = R::add_over([R::splat(0.0); 4], &bone.spans, |span| {
        let away: [R; 3] = core::array::from_fn(|i| p[i] - R::lift(span.position[0][i]));
        // Out of every lane's reach the span adds 0.
        let near = dot(away, away).lt(R::lift(span.reach2));
        R::where_any(near, || over_span(bone, span, p, kinks, &pair))
    });
    jet_of(total)
}

/// Computes value and gradient of a span for a compact kernel.
#[inline(always)]
fn over_span<R: Real>(
    bone: &Curve<R::Scalar>,
    span: &Span<R::Scalar>,
    p: [R; 3],
    kinks: &[f64],
    pair: impl Fn(R) -> (R, R),
) -> [R; 4] {
    let one = R::splat(1.0);
    let slope = Slope::new(span, p);
    let t = if bone.tapered {
        slope.extremum(|slope, t| {
            let (thinness, rate) = polynomial(&span.thinness, t);
            // Half the derivative of ωg.
            thinness * slope.at(t) + R::splat(0.5) * rate * slope.square(t)
        })
    } else {
        slope.extremum(|slope, t| slope.at(t))
    };
    let around = Around::new(span, bone.tapered, t, p);
    let mut sums = [R::splat(0.0); 5];
    for end in [-one - t, one - t] {
        let length = end.abs();
        let mut integrate = |[low, high]: [R; 2]| {
            let half = R::splat(0.5);
            let (middle, reach) = (half * (high + low), half * (high - low));
            sums = R::add_over(sums, &bone.rule, |[node, weight]| {
                let s = end * (middle + reach * R::lift(*node));
                let weight = R::lift(*weight) * reach * length;
                around.terms(s, weight, &pair)
            });
        };
        let side = Side::new(&around, end);
        let outer = side.inside(&around, one);
        if let [kink, _] = kinks {
            let inner = side.inside(&around, R::splat(kink * kink));
            integrate(inner);
            // The outer piece continues on the far side of the inner one.
            let rising = side.start.lt(side.stop);
            integrate([
                R::select(rising, inner[1], outer[0]),
                R::select(rising, outer[1], inner[0]),
            ]);
        } else {
            integrate(outer);
        }
    }
    around.jet(sums)
}

/// Makes a jet of a value and three derivatives.
#[inline(always)]
fn jet_of<R>([value, x, y, z]: [R; 4]) -> Jet<R> {
    Jet {
        value,
        gradient: [x, y, z],
    }
}

/// Half the derivative of g on a span, a polynomial in t.
struct Slope<R> {
    coefficients: [R; 6],
    /// g at t = 0.
    middle: R,
}

impl<R: Real> Slope<R> {
    #[inline(always)]
    fn new(span: &Span<R::Scalar>, p: [R; 3]) -> Self {
        let [c0, c1, c2, c3] = span.position.map(|c| c.map(R::lift));
        let [c11, c12, c22, c23, c33] = span.products.map(R::lift);
        let d = core::array::from_fn(|i| p[i] - c0[i]);
        Self {
            coefficients: [
                -dot(d, c1),
                c11 - R::splat(2.0) * dot(d, c2),
                c12 - R::splat(3.0) * dot(d, c3),
                c22,
                c23,
                c33,
            ],
            middle: dot(d, d),
        }
    }

    #[inline(always)]
    fn at(&self, t: R) -> R {
        horner(&self.coefficients, t)
    }

    /// g.
    #[inline(always)]
    fn square(&self, t: R) -> R {
        let c: [R; 6] =
            core::array::from_fn(|i| self.coefficients[i] * R::splat(2.0 / (i + 1) as f64));
        self.middle + t * horner(&c, t)
    }

    /// Returns the zero in [−1, 1] of a function that is nearly linear in t, by the Illinois
    /// method; without a zero, the end at which its integral is smaller.
    #[inline(always)]
    fn extremum(&self, f: impl Fn(&Self, R) -> R) -> R {
        let (zero, one, half) = (R::splat(0.0), R::splat(1.0), R::splat(0.5));
        let (mut low, mut high) = (-one, one);
        let (first, last) = (f(self, low), f(self, high));
        let sign = R::select(last.lt(first), -one, one);
        let (mut below, mut above) = (sign * first, sign * last);
        let crosses = R::both(below.lt(zero), zero.lt(above));
        let mut t = zero;
        // The end that was moved in the step before: 1 the upper, −1 the lower one.
        let mut before = zero;
        for _ in 0..if R::DOUBLE { 10 } else { 5 } {
            t = (low * above - high * below) / nonzero(above - below);
            t = t.max(-one).min(one);
            let here = sign * f(self, t);
            let up = zero.lt(here);
            let again = half.lt(R::select(up, before, -before));
            let weight = R::select(again, half, one);
            (low, below) = (R::select(up, low, t), R::select(up, below * weight, here));
            (high, above) = (R::select(up, t, high), R::select(up, here, above * weight));
            before = R::select(up, one, -one);
        }
        // The function may be 0 at an end.
        R::select(crosses, t, R::select(zero.lt(first + last), -one, one))
    }
}

/// A span written around a place t* on it, in powers of s = t − t*.
struct Around<'a, R: Real> {
    span: &'a Span<R::Scalar>,
    tapered: bool,
    t: R,
    /// q − p.
    position: [[R; 3]; 4],
    /// g.
    square: [R; 7],
    /// |q′|².
    speed: [R; 5],
}

impl<'a, R: Real> Around<'a, R> {
    #[inline(always)]
    fn new(span: &'a Span<R::Scalar>, tapered: bool, t: R, p: [R; 3]) -> Self {
        let position = relative(span, t, p);
        let [e0, e1, e2, e3] = position;
        let two = R::splat(2.0);
        let four = R::splat(4.0);
        let (d11, d12, d13) = (dot(e1, e1), dot(e1, e2), dot(e1, e3));
        let (d22, d23, d33) = (dot(e2, e2), dot(e2, e3), dot(e3, e3));
        Self {
            span,
            tapered,
            t,
            position,
            square: [
                dot(e0, e0),
                two * dot(e0, e1),
                two * dot(e0, e2) + d11,
                two * (dot(e0, e3) + d12),
                two * d13 + d22,
                two * d23,
                d33,
            ],
            speed: [
                d11,
                four * d12,
                four * d22 + R::splat(6.0) * d13,
                R::splat(12.0) * d23,
                R::splat(9.0) * d33,
            ],
        }
    }

    /// ω and its derivative.
    #[inline(always)]
    fn thinness(&self, s: R) -> (R, R) {
        polynomial(&self.span.thinness, self.t + s)
    }

    /// ωg and its derivative.
    #[inline(always)]
    fn level(&self, s: R) -> (R, R) {
        let mut value = self.square[6];
        let mut slope = R::splat(0.0);
        for i in (0..6).rev() {
            slope = slope * s + value;
            value = value * s + self.square[i];
        }
        if self.tapered {
            let (thinness, rate) = self.thinness(s);
            (thinness * value, thinness * slope + rate * value)
        } else {
            (value, slope)
        }
    }

    /// Computes a node's contributions to the field and to `∫αωG′|q′|sᵏ`, k from 0 to 3.
    #[inline(always)]
    fn terms(&self, s: R, weight: R, pair: impl Fn(R) -> (R, R)) -> [R; 5] {
        let zero = R::splat(0.0);
        let square = horner(&self.square, s).max(zero);
        let mut weight = weight * horner(&self.speed, s).max(zero).sqrt();
        let (value, moment) = if self.tapered {
            let (thinness, _) = self.thinness(s);
            weight = weight * polynomial(&self.span.density, self.t + s).0;
            let (value, rate) = pair(thinness * square);
            (weight * value, weight * thinness * rate)
        } else {
            let (value, rate) = pair(square);
            (weight * value, weight * rate)
        };
        let second = moment * s;
        let third = second * s;
        [value, moment, second, third, third * s]
    }

    /// Computes value and gradient from the sums of all nodes' [`Around::terms`].
    #[inline(always)]
    fn jet(&self, [value, m0, m1, m2, m3]: [R; 5]) -> [R; 4] {
        let [e0, e1, e2, e3] = self.position;
        let [x, y, z] = core::array::from_fn(|i| {
            R::splat(-2.0) * (e0[i] * m0 + e1[i] * m1 + e2[i] * m2 + e3[i] * m3)
        });
        [value, x, y, z]
    }
}

/// ωg from t* to an end of the span, as a function of σ, 0 ≤ σ ≤ 1, s = end·σ. It is monotonic.
struct Side<R> {
    end: R,
    start: R,
    slope: R,
    /// Half the second derivative at the start, but for that of ω.
    bend: R,
    stop: R,
}

impl<R: Real> Side<R> {
    #[inline(always)]
    fn new(around: &Around<'_, R>, end: R) -> Self {
        let zero = R::splat(0.0);
        let (start, slope) = around.level(zero);
        let mut bend = around.square[2];
        if around.tapered {
            let (thinness, rate) = around.thinness(zero);
            bend = thinness * bend + rate * around.square[1];
        }
        Self {
            end,
            start,
            slope: end * slope,
            bend: end * end * bend,
            stop: around.level(end).0,
        }
    }

    /// The interval of σ on which ωg is below a level; where there is none, an empty one at the end
    /// where ωg is smallest.
    #[inline(always)]
    fn inside(&self, around: &Around<'_, R>, level: R) -> [R; 2] {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let (first, last) = (self.start - level, self.stop - level);
        // The parabola tangent to it at the start, with the sign that makes it rise.
        let rising = self.start.lt(self.stop);
        let sign = R::select(rising, one, -one);
        let bend = self.bend;
        let root = (self.slope * self.slope - R::splat(4.0) * first * bend)
            .max(zero)
            .sqrt();
        let two = R::splat(2.0);
        let mut place = -(two * first) / nonzero(self.slope + sign * root);
        place = place.max(zero).min(one);
        let least = R::splat(1e-3) * (last - first).abs();
        for _ in 0..if R::DOUBLE { 6 } else { 3 } {
            let (value, rate) = around.level(self.end * place);
            let rate = (sign * self.end * rate).max(least);
            place = place - sign * (value - level) / nonzero(rate);
            place = place.max(zero).min(one);
        }
        let (starts, stops) = (first.lt(zero), last.lt(zero));
        let deep = R::select(rising, zero, one);
        [
            R::select(starts, zero, R::select(stops, place, deep)),
            R::select(stops, one, R::select(starts, place, deep)),
        ]
    }
}

/// Coefficients of q − p in powers of s = t − t*.
#[inline(always)]
fn relative<R: Real>(span: &Span<R::Scalar>, t: R, p: [R; 3]) -> [[R; 3]; 4] {
    let [c0, c1, c2, c3] = span.position.map(|c| c.map(R::lift));
    let (two, three) = (R::splat(2.0), R::splat(3.0));
    [
        core::array::from_fn(|i| (c0[i] - p[i]) + t * (c1[i] + t * (c2[i] + t * c3[i]))),
        core::array::from_fn(|i| c1[i] + t * (two * c2[i] + three * t * c3[i])),
        core::array::from_fn(|i| c2[i] + three * t * c3[i]),
        c3,
    ]
}

/// Computes a span's polynomial and its derivative, with as many terms as spans of this type have.
#[inline(always)]
fn polynomial<R: Real>(coefficients: &[R::Scalar; TERMS], t: R) -> (R, R) {
    let count = if R::DOUBLE { TERMS } else { SINGLE_TERMS };
    let mut value = R::lift(coefficients[count - 1]);
    let mut slope = R::splat(0.0);
    for i in (0..count - 1).rev() {
        slope = slope * t + value;
        value = value * t + R::lift(coefficients[i]);
    }
    (value, slope)
}

#[inline(always)]
fn horner<R: Real, const N: usize>(coefficients: &[R; N], x: R) -> R {
    let mut sum = coefficients[N - 1];
    for i in (0..N - 1).rev() {
        sum = sum * x + coefficients[i];
    }
    sum
}

#[inline(always)]
fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// x, or a tiny number in place of 0, for use as a divisor.
#[inline(always)]
fn nonzero<R: Real>(x: R) -> R {
    let least = R::splat(1e-30);
    R::select(x.abs().lt(least), least, x)
}
