//! The function of the other body's field by which a body is deformed.
use field::{Real, THRESHOLD};
use serde::{Deserialize, Serialize};

/// The swelling beside a contact, as a function b of the other body's field f from c, where it
/// begins, to T, the other's surface: `b(c) = b′(c) = 0`, `b(T) = 0`, `b′(T) = −1`. All values are
/// in units of T.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Bulge {
    /// `b = (1−c)·x²(1−x)`, `x = (f−c)/(1−c)`.
    Fast {
        /// Field at which the bulge begins, in (0, 1).
        c: f64,
    },
    /// Bulge of a given height at a given place: on [c, m] `b = (3−2x)x²h`, `x = (f−c)/(m−c)`; on
    /// [m, 1], with w = 1−m, `b = h + ((w−3h) + (2h−w)x)x²`, `x = (f−m)/w`.
    Height {
        /// Field at which the bulge begins, in (0, 1).
        c: f64,
        /// Field at which the bulge is highest, in (c, 1).
        m: f64,
        /// Height of the bulge, in [0, 1).
        h: f64,
    },
    /// Bulge with ripples: [`Bulge::Height`] with `m = c+(1−c)(1−1/(4n+3))`, and the piece on [c,
    /// m] times `(cos(((2n+1)x+1)π)+1)/2`.
    Ripple {
        /// Field at which the bulge begins, in (0, 1).
        c: f64,
        /// The height of the highest ripple, in [0, 1).
        h: f64,
        /// Ripples besides that one, up to [`Bulge::MOST_RIPPLES`].
        n: u32,
    },
}

impl Default for Bulge {
    fn default() -> Self {
        Self::Fast { c: 0.2 }
    }
}

/// Bounds on `g` and its derivatives over an interval of f.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The least and the largest value.
    pub value: [f64; 2],
    /// The largest |g′|.
    pub slope: f64,
    /// The largest |g″|, on either side where it jumps.
    pub curvature: f64,
    /// The largest |g‴|; infinite where g″ jumps, or if it is not known.
    pub third: f64,
}

impl Spread {
    /// Returns bounds over both of two intervals.
    fn or(self, other: Self) -> Self {
        Self {
            value: [
                self.value[0].min(other.value[0]),
                self.value[1].max(other.value[1]),
            ],
            slope: self.slope.max(other.slope),
            curvature: self.curvature.max(other.curvature),
            third: self.third.max(other.third),
        }
    }
}

/// The number of half waves of ripples, 2n+1.
fn half_waves(n: u32) -> f64 {
    f64::from(2 * n + 1)
}

impl Bulge {
    /// The most ripples.
    pub const MOST_RIPPLES: u32 = 20;

    /// Whether the parameters are in their ranges.
    #[must_use]
    pub fn is_usable(&self) -> bool {
        let c = self.start();
        let has_start = c > 0.0 && c < THRESHOLD;
        has_start
            && match *self {
                Self::Fast { .. } => true,
                Self::Height { m, h, .. } => {
                    m > c && m < THRESHOLD && (0.0..THRESHOLD).contains(&h)
                }
                Self::Ripple { h, n, .. } => {
                    (0.0..THRESHOLD).contains(&h) && n <= Self::MOST_RIPPLES
                }
            }
    }

    /// Field at which the bulge begins.
    #[must_use]
    pub fn start(&self) -> f64 {
        match *self {
            Self::Fast { c } | Self::Height { c, .. } | Self::Ripple { c, .. } => c,
        }
    }

    /// Returns the width of the bulge's details as a share of the kernel's: one that rises and
    /// falls once is as smooth as the field.
    #[must_use]
    pub fn fineness(&self) -> f64 {
        match *self {
            Self::Fast { .. } | Self::Height { .. } => 1.0,
            Self::Ripple { n, .. } => 1.0 / (2.0 * f64::from(n) + 1.0),
        }
    }

    /// Field at which the bulge is highest, about.
    #[must_use]
    pub fn crest(&self) -> f64 {
        match *self {
            Self::Fast { c } => c + (THRESHOLD - c) * (2.0 / 3.0),
            Self::Height { m, .. } => m,
            Self::Ripple { c, n, .. } => c + (THRESHOLD - c) * (1.0 - 1.0 / f64::from(4 * n + 3)),
        }
    }

    /// Greatest height of the bulge.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.spread([self.start(), THRESHOLD]).value[1]
    }

    /// The deformation `g(f)` and `g′(f)`: `1 − f` from 1 on, the bulge between c and 1, 0 below.
    #[must_use]
    pub fn jet<R: Real>(&self, f: R) -> (R, R) {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let start = self.start();
        let (bulge, slope) = match *self {
            Self::Fast { c } => {
                let x = (f - R::splat(c)) / R::splat(1.0 - c);
                (
                    R::splat(1.0 - c) * x * x * (one - x),
                    x * (R::splat(2.0) - R::splat(3.0) * x),
                )
            }
            Self::Height { c, m, h } => {
                let rise = rise(f, c, m, h);
                let fall = fall(f, m, h);
                let rising = f.lt(R::splat(m));
                (
                    R::select(rising, rise.0, fall.0),
                    R::select(rising, rise.1, fall.1),
                )
            }
            Self::Ripple { c, h, n } => {
                let m = self.crest();
                let (value, slope) = rise(f, c, m, h);
                // Clamped, as sines are computed for small angles only.
                let x = ((f - R::splat(c)) / R::splat(m - c)).max(zero).min(one);
                let turns = half_waves(n) * core::f64::consts::PI;
                let (sine, cosine) = (R::splat(turns) * x).sin_cos();
                // cos(a+π) = −cos a.
                let (half, wave) = (R::splat(0.5), R::splat(0.5 * turns / (m - c)));
                let (wave, rate) = (half * (one - cosine), wave * sine);
                let rise = (value * wave, slope * wave + value * rate);
                let fall = fall(f, m, h);
                let rising = f.lt(R::splat(m));
                (
                    R::select(rising, rise.0, fall.0),
                    R::select(rising, rise.1, fall.1),
                )
            }
        };
        let (inside, outside) = (R::splat(THRESHOLD).lt(f), f.lt(R::splat(start)));
        (
            R::select(inside, one - f, R::select(outside, zero, bulge)),
            R::select(inside, -one, R::select(outside, zero, slope)),
        )
    }

    /// Bounds on the deformation over an interval of f.
    #[must_use]
    pub fn spread(&self, [low, high]: [f64; 2]) -> Spread {
        let c = self.start();
        let zero = Spread {
            value: [0.0; 2],
            slope: 0.0,
            curvature: 0.0,
            third: 0.0,
        };
        let mut pieces = 0;
        let mut all: Option<Spread> = None;
        let mut add = |part: Spread| {
            pieces += 1;
            all = Some(all.map_or(part, |all| all.or(part)));
        };
        if low <= c {
            add(zero);
        }
        if high >= THRESHOLD {
            add(Spread {
                value: [THRESHOLD - high, THRESHOLD - low.max(THRESHOLD)],
                slope: 1.0,
                curvature: 0.0,
                third: 0.0,
            });
        }
        let mut within = |from: f64, to: f64, part: &dyn Fn([f64; 2]) -> Spread| {
            let (from_x, to_x) = (low.max(from), high.min(to));
            if from_x <= to_x {
                add(part([from_x, to_x].map(|f| (f - from) / (to - from))));
            }
        };
        match *self {
            Self::Fast { c } => {
                let width = THRESHOLD - c;
                within(c, THRESHOLD, &|x| {
                    cubic(x, [0.0, 0.0, width, -width], width)
                });
            }
            Self::Height { c, m, h } => {
                let rise = [0.0, 0.0, 3.0 * h, -2.0 * h];
                within(c, m, &|x| cubic(x, rise, m - c));
                within(m, THRESHOLD, &|x| cubic(x, falling(m, h), THRESHOLD - m));
            }
            Self::Ripple { c, h, n } => {
                let m = self.crest();
                within(c, m, &|x| ripples(x, h, n, m - c));
                within(m, THRESHOLD, &|x| cubic(x, falling(m, h), THRESHOLD - m));
            }
        }
        let all = all.unwrap_or(zero);
        Spread {
            third: if pieces > 1 { f64::INFINITY } else { all.third },
            ..all
        }
    }
}

/// `(3−2x)x²h` of x = (f−c)/(m−c), and its derivative by f.
fn rise<R: Real>(f: R, c: f64, m: f64, h: f64) -> (R, R) {
    let (two, three) = (R::splat(2.0), R::splat(3.0));
    let x = (f - R::splat(c)) / R::splat(m - c);
    (
        R::splat(h) * x * x * (three - two * x),
        R::splat(6.0 * h / (m - c)) * x * (R::splat(1.0) - x),
    )
}

/// `h + ((w−3h) + (2h−w)x)x²` of x = (f−m)/w with w = 1−m, and its derivative by f.
fn fall<R: Real>(f: R, m: f64, h: f64) -> (R, R) {
    let [_, _, square, cube] = falling(m, h);
    let w = THRESHOLD - m;
    let x = (f - R::splat(m)) / R::splat(w);
    (
        R::splat(h) + x * x * (R::splat(square) + R::splat(cube) * x),
        x * (R::splat(2.0 * square / w) + R::splat(3.0 * cube / w) * x),
    )
}

/// The coefficients of [`fall`] in powers of x.
fn falling(m: f64, h: f64) -> [f64; 4] {
    let w = THRESHOLD - m;
    [h, 0.0, w - 3.0 * h, 2.0 * h - w]
}

/// Bounds on a cubic in x over an interval of x; derivatives are by f = width·x.
fn cubic([low, high]: [f64; 2], [a, b, c, d]: [f64; 4], width: f64) -> Spread {
    let mut spread = Spread {
        value: [f64::INFINITY, f64::NEG_INFINITY],
        slope: 0.0,
        curvature: 0.0,
        third: 6.0 * d.abs() / (width * width * width),
    };
    let root = (c * c - 3.0 * b * d).max(0.0).sqrt();
    // The ends; where the slope is greatest; where it is 0.
    for x in [
        low,
        high,
        -c / (3.0 * d),
        (-c + root) / (3.0 * d),
        (-c - root) / (3.0 * d),
    ] {
        if (low..=high).contains(&x) {
            let value = a + x * (b + x * (c + x * d));
            let slope = b + x * (2.0 * c + 3.0 * x * d);
            let bend = 2.0 * c + 6.0 * d * x;
            spread = spread.or(Spread {
                value: [value; 2],
                slope: slope.abs() / width,
                curvature: bend.abs() / (width * width),
                third: 0.0,
            });
        }
    }
    pad(spread)
}

/// Bounds on the piece with ripples over an interval of x: products of those of its two factors.
fn ripples(x: [f64; 2], h: f64, n: u32, width: f64) -> Spread {
    let rise = cubic(x, [0.0, 0.0, 3.0 * h, -2.0 * h], width);
    let rate = half_waves(n) * core::f64::consts::PI / width;
    // The wave is in [0, 1], its derivatives at most rate/2, rate²/2 and rate³/2.
    let most = rise.value[1].max(0.0);
    pad(Spread {
        value: [0.0, most],
        slope: rise.slope + 0.5 * rate * most,
        curvature: rise.curvature + rate * rise.slope + 0.5 * rate * rate * most,
        third: rise.third
            + 1.5 * rate * (rise.curvature + rate * rise.slope)
            + 0.5 * rate * rate * rate * most,
    })
}

/// Widens bounds by room for rounding.
fn pad(spread: Spread) -> Spread {
    const ROUNDING: f64 = 1e-14;
    let [low, high] = spread.value;
    Spread {
        value: [low - ROUNDING, high + ROUNDING],
        slope: spread.slope * (1.0 + ROUNDING),
        curvature: spread.curvature * (1.0 + ROUNDING),
        third: spread.third * (1.0 + ROUNDING),
    }
}
