//! Polynomial kernels along a circular arc.
//!
//! The circle of radius r lies in the plane z = 0; ρ is the point's distance from its axis,
//! `g = ρ−r` its gap to the circle's cylinder. At the azimuth w from the point's
//!
//! `v = v₀ − 4ρr sin²(w/2)`, `v₀ = 1 − z² − g²`,
//!
//! which is positive for |w| < W, `sin²(W/2) = v₀/(4ρr)`, or everywhere. That window meets the arc
//! in at most two pieces. Around a piece's middle m, with w = m + 2a and |a| ≤ h,
//!
//! `v = P − 2X sin²a − 2Y sin a cos a`, `P = v(m)`, `X = 2ρr cos m`, `Y = 2ρr sin m`,
//!
//! so that `∫g(v) dw` and `∫g′(v)·(1, 1−cos 2a, sin 2a) dw` are polynomials in P, X and Y whose
//! coefficients are the integrals `∫₀^h sin²ᵏ`, k ≤ 3, see [`Moments`]. All are taken in units of
//! h²ᵏ⁺¹, so that neither short arcs of huge circles nor tiny circles lose digits. The gradient in
//! the plane is `−2∫g′·(q − r·e(w))` over the circle's points r·e(w), and `q − r·e` is written as
//! its value at m plus what m lacks.
use crate::angle::direction;
use crate::bone::Arc;
use crate::real::{Scalar, polynomial};
use crate::{Jet, Real};
use core::f64::consts::TAU;

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(coefficients: [f64; 2], arc: &Arc<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let place = FromCircle::new(arc, p);
    let window = place.window(R::splat(1.0));
    let mut sum = [R::splat(0.0); 4];
    for piece in window.pieces(arc, &place).into_iter().flatten() {
        let part = integral(coefficients, arc, &place, &window, &piece);
        sum = core::array::from_fn(|i| sum[i] + part[i]);
    }
    place.jet(arc, sum, p)
}

/// Position of a point seen from the circle's centre, mirrored so that y ≥ 0.
pub(crate) struct FromCircle<R> {
    /// Distance from the axis.
    pub rho: R,
    /// Cosine and sine of the azimuth.
    pub turn: [R; 2],
    /// The azimuth, in [0, π].
    pub azimuth: R,
    /// Distance from the circle's cylinder, positive outside.
    pub gap: R,
    /// Squared distance from the circle.
    pub near: R,
    /// 4ρr.
    pub spread: R,
}

impl<R: Real> FromCircle<R> {
    #[inline(always)]
    pub fn new(arc: &Arc<R::Scalar>, [x, y, z]: [R; 3]) -> Self {
        let radius = R::lift(arc.radius);
        let tiny = R::splat(1e-30);
        let side = y.abs();
        let centred = radius + x;
        let rho = (centred * centred + side * side).sqrt();
        // ρ − r without subtracting large numbers.
        let two = R::splat(2.0);
        let gap = (two * radius * x + x * x + y * y) / (rho + radius).max(tiny);
        let scale = R::splat(1.0) / rho.max(tiny);
        let on_axis = rho.lt(tiny);
        Self {
            rho,
            turn: [
                R::select(on_axis, R::splat(1.0), centred * scale),
                R::select(on_axis, R::splat(0.0), side * scale),
            ],
            azimuth: direction(side, centred),
            gap,
            near: z * z + gap * gap,
            spread: R::splat(4.0) * rho * radius,
        }
    }

    /// The azimuths, from the point's, of the circle's points within a distance.
    #[inline(always)]
    pub fn window(&self, distance: R) -> Window<R> {
        let zero = R::splat(0.0);
        let top = distance * distance - self.near;
        let inside = top.max(zero);
        let rest = self.spread - inside;
        // The window is empty, not whole, on the axis of a circle out of reach.
        let open = zero.lt(R::select(zero.lt(inside), rest, R::splat(1.0)));
        let half = direction(inside.sqrt(), rest.max(zero).sqrt());
        Window {
            top: inside,
            half: half + half,
            open,
        }
    }

    /// Computes value and gradient from the sums of [`integral`].
    #[inline(always)]
    pub fn jet(&self, arc: &Arc<R::Scalar>, sum: [R; 4], [_, y, z]: [R; 3]) -> Jet<R> {
        let radius = R::lift(arc.radius);
        let two = R::splat(2.0);
        let [value, outward, sideways, slope] = sum;
        let factor = -two * radius;
        Jet {
            value: radius * value,
            gradient: [
                factor * outward,
                y.sign_to(factor * sideways),
                factor * slope * z,
            ],
        }
    }
}

/// The azimuths |w| ≤ `half`, or all.
pub(crate) struct Window<R: Real> {
    /// v at w = 0.
    pub top: R,
    /// Half the window's angle, at most π.
    pub half: R,
    /// Mask that holds where the window leaves out some of the circle.
    pub open: R::Mask,
}

/// A piece of an arc: azimuths around `middle`, seen from the point's.
pub(crate) struct Azimuths<R> {
    pub middle: R,
    /// Half the angle.
    pub half: R,
}

/// An arc as seen from a point: the azimuths `base + τ`, τ from `low` to `high`.
#[derive(Clone, Copy)]
pub(crate) struct AzimuthRange<R> {
    pub base: R,
    pub low: R,
    pub high: R,
}

impl<R: Real> AzimuthRange<R> {
    /// Returns the arc's azimuths, and the azimuths one turn further on where both can be within
    /// the distance 1 of a point.
    ///
    /// From a point outside a circle of radius r ≥ 1, or inside, its part within the distance 1 has
    /// an angle of at most `2 arcsin(1/r)`. So the second is in need only if the arc's gap is less
    /// than that.
    ///
    /// Ends are measured from whichever is near, the arc's middle or the gap's: so τ keeps its
    /// digits.
    #[inline(always)]
    pub fn of(arc: &Arc<R::Scalar>, place: &FromCircle<R>) -> [Option<Self>; 2] {
        let constant = <R::Scalar as Real>::splat;
        let zero = R::splat(0.0);
        let turn = R::splat(TAU);
        let end = R::lift(arc.end_angle);
        let longer = R::Scalar::decide(arc.side.lt(constant(0.0)));
        if longer && !R::Scalar::decide(constant(0.0).lt(arc.end_angle)) {
            let half = R::splat(0.5) * turn;
            let whole = Self {
                base: zero,
                low: -half,
                high: half,
            };
            return [Some(whole), None];
        }
        let (first, second, gap) = if longer {
            let (near, far) = (end - place.azimuth, -end - place.azimuth);
            let span = |low, high| Self {
                base: zero,
                low,
                high,
            };
            (
                span(near, far + turn),
                span(near - turn, far),
                arc.radius * arc.sine,
            )
        } else {
            let span = |base| Self {
                base,
                low: -end,
                high: end,
            };
            (span(-place.azimuth), span(turn - place.azimuth), arc.radius)
        };
        let beyond = R::Scalar::decide(constant(1.0).lt(gap));
        [Some(first), (!beyond).then_some(second)]
    }

    /// The piece between two azimuths.
    #[inline(always)]
    pub fn between(&self, from: R, to: R) -> Azimuths<R> {
        let zero = R::splat(0.0);
        let half = R::splat(0.5);
        let (low, high) = (
            self.low.max(from - self.base),
            self.high.min(to - self.base),
        );
        let part = (half * (high - low)).max(zero);
        let middle = self.base + half * (low + high);
        Azimuths {
            middle: R::select(zero.lt(part), middle, zero),
            half: part,
        }
    }
}

impl<R: Real> Window<R> {
    /// The arc's pieces in the window.
    #[inline(always)]
    pub fn pieces(&self, arc: &Arc<R::Scalar>, place: &FromCircle<R>) -> [Option<Azimuths<R>>; 2] {
        let [first, second] = AzimuthRange::of(arc, place);
        // A window of all azimuths has no ends to cut at, and no need of the second.
        let wide = R::select(self.open, self.half, R::splat(2.0 * TAU));
        let none = R::select(self.open, self.half, R::splat(0.0));
        [
            first.map(|span| span.between(-wide, wide)),
            second.map(|span| span.between(-none, none)),
        ]
    }
}

/// Sine and cosine of |x| ≤ π/4.
///
/// In single precision Taylor's polynomials, whose error is below 2·10⁻⁹ there: there is no turn to
/// take off.
#[inline(always)]
pub(crate) fn eighth_turn<R: Real>(x: R) -> (R, R) {
    if R::DOUBLE {
        return x.sin_cos();
    }
    let square = x * x;
    let sine = [1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5040.0, 1.0 / 362_880.0];
    let cosine = [
        -0.5,
        1.0 / 24.0,
        -1.0 / 720.0,
        1.0 / 40_320.0,
        -1.0 / 3_628_800.0,
    ];
    (
        x * polynomial(square, sine),
        R::splat(1.0) + square * polynomial(square, cosine),
    )
}

/// Sine and cosine of |x| ≤ π/2.
#[inline(always)]
pub(crate) fn quarter_turn<R: Real>(x: R) -> (R, R) {
    if R::DOUBLE {
        return x.sin_cos();
    }
    let (s, c) = eighth_turn(R::splat(0.5) * x);
    let twice = s + s;
    (twice * c, R::splat(1.0) - twice * s)
}

/// `∫₀^h sin²ᵏ / h²ᵏ⁺¹` for k = 1, 2, 3.
pub(crate) struct Moments<R> {
    pub second: R,
    pub fourth: R,
    pub sixth: R,
}

impl<R: Real> Moments<R> {
    /// Computes the moments for 0 ≤ h ≤ π/2.
    ///
    /// `∫sin⁶/h⁷` is a polynomial in h² (Chebyshev fit, error below 2·10⁻¹⁰ in single precision,
    /// 4·10⁻²² in double), the others follow by `∫sin²ᵏ⁻² = (2k∫sin²ᵏ + sin²ᵏ⁻¹cos)/(2k−1)`, a sum
    /// of positive terms.
    #[inline(always)]
    pub fn new(h: R) -> Self {
        let h2 = h * h;
        let (sine, cosine) = quarter_turn(h);
        let ratio = sine / h.max(R::splat(1e-30));
        let sixth = if R::DOUBLE {
            polynomial(
                h2,
                [
                    0.142_857_142_857_142_86,
                    -0.111_111_111_111_111_1,
                    0.042_424_242_424_242_42,
                    -0.010_419_210_419_210_388,
                    0.001_834_215_167_548_274_7,
                    -0.000_245_593_186_768_677_4,
                    2.598_430_891_106_724e-5,
                    -2.232_270_304_388_970_6e-6,
                    1.589_771_333_720_228_2e-7,
                    -9.542_873_675_377_634e-9,
                    4.894_695_442_432_1e-10,
                    -2.169_950_834_236_693e-11,
                    8.388_174_083_709_373e-13,
                    -2.826_275_291_750_264e-14,
                    7.928_083_493_641_164e-16,
                    -1.447_901_332_175_67e-17,
                ],
            )
        } else {
            polynomial(
                h2,
                [
                    0.142_857_142_717_286_63,
                    -0.111_111_101_920_936_96,
                    0.042_424_142_674_832_36,
                    -0.010_418_791_962_539_843,
                    0.001_833_331_330_613_226_6,
                    -0.000_244_536_666_389_019_5,
                    2.523_307_812_016_463e-5,
                    -1.913_309_496_340_388_7e-6,
                    8.160_072_787_142_015e-8,
                ],
            )
        };
        let cube = ratio * ratio * ratio;
        let fourth = (R::splat(1.2) * h2) * sixth + R::splat(0.2) * cube * ratio * ratio * cosine;
        let second = (R::splat(4.0 / 3.0) * h2) * fourth + R::splat(1.0 / 3.0) * cube * cosine;
        Self {
            second,
            fourth,
            sixth,
        }
    }
}

/// Frame of a piece, for the conversion of integrals around its middle to the local axes.
pub(crate) struct PieceFrame<R> {
    /// v at the middle.
    pub v: R,
    /// `2ρr·(cos m, sin m)`.
    pub bend: [R; 2],
    /// The middle's azimuth: cosine and sine.
    pub turn: [R; 2],
    /// The point's place as seen from the circle's there: outward, and along the circle.
    pub from: [R; 2],
}

impl<R: Real> PieceFrame<R> {
    #[inline(always)]
    pub fn new(place: &FromCircle<R>, top: R, middle: R) -> Self {
        let half = R::splat(0.5);
        let two = R::splat(2.0);
        let one = R::splat(1.0);
        let (s, c) = quarter_turn(half * middle);
        let versine = two * s * s;
        let (cosine, sine) = (one - versine, two * s * c);
        let [cos, sin] = place.turn;
        let bend = half * place.spread;
        Self {
            v: top - half * place.spread * versine,
            bend: [bend * cosine, bend * sine],
            turn: [cos * cosine - sin * sine, sin * cosine + cos * sine],
            from: [place.gap - place.rho * versine, -place.rho * sine],
        }
    }

    /// Converts `∫g, ∫g′, r∫g′(1−cos), r∫g′sin` to `∫g, ∫g′·(q − r·e), ∫g′`.
    #[inline(always)]
    pub fn gather(&self, [value, slope, lack, lean]: [R; 4]) -> [R; 4] {
        let [cos, sin] = self.turn;
        let outward = self.from[0] * slope + lack;
        let onward = self.from[1] * slope - lean;
        [
            value,
            cos * outward - sin * onward,
            sin * outward + cos * onward,
            slope,
        ]
    }
}

/// `∫g(v) dw`, `∫g′(v)·(q − r·e) dw` in local axes, and `∫g′(v) dw` over a piece.
#[inline(always)]
fn integral<R: Real>(
    [c2, c3]: [f64; 2],
    arc: &Arc<R::Scalar>,
    place: &FromCircle<R>,
    window: &Window<R>,
    piece: &Azimuths<R>,
) -> [R; 4] {
    let around = PieceFrame::new(place, window.top, piece.middle);
    let h = R::splat(0.5) * piece.half;
    let Moments {
        second,
        fourth,
        sixth,
    } = Moments::new(h);
    let h2 = h * h;
    let p = around.v.max(R::splat(0.0));
    // Coordinates in units in which sin a is sin a/h.
    let (x, y) = (
        R::splat(2.0) * h2 * around.bend[0],
        R::splat(2.0) * h * around.bend[1],
    );
    let mixed = second - h2 * fourth;
    let mixed4 = fourth - h2 * sixth;
    let y2 = y * y;
    // ∫v, ∫v², ∫v³ and the same times sin².
    let first = p - x * second;
    let square = p * p - x * (R::splat(2.0) * p * second - x * fourth) + y2 * mixed;
    let cross = p * mixed - x * mixed4;
    let cube = p * p * p - x * (R::splat(3.0) * p * (p * second - x * fourth) + x * x * sixth)
        + R::splat(3.0) * y2 * cross;
    let first_s = p * second - x * fourth;
    let square_s = p * p * second - x * (R::splat(2.0) * p * fourth - x * sixth) + y2 * mixed4;

    let four_h = R::splat(4.0) * h;
    let radius = R::lift(arc.radius);
    let [d2, d3] = [R::splat(2.0 * c2), R::splat(3.0 * c3)];
    let slope = four_h * (d2 * first + d3 * square);
    let lack = radius * h2 * (four_h + four_h) * (d2 * first_s + d3 * square_s);
    let lean = -radius * h * (four_h + four_h) * y * (d2 * mixed + R::splat(6.0 * c3) * cross);
    around.gather([
        four_h * (R::splat(c2) * square + R::splat(c3) * cube),
        slope,
        lack,
        lean,
    ])
}
