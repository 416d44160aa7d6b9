//! Kernels h(r): the contribution of a point of the skeleton to the field at a distance.
//!
//! In units of the kernel's width (lengths times [`Shaping::width`](crate::Shaping::width)) every
//! kernel is a fixed function of u, the distance, and best written as a function G of the *square*
//! q = u²: its derivatives by q are all that values, gradients and bounds need.
use crate::{Real, inverse, metaballs};
use core::f64::consts::PI;
use serde::{Deserialize, Serialize};

/// A kernel: a decreasing function of distance (thesis, section 2.3; `compact6` and `cubed` are
/// ours).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Kernel {
    /// `1/(1+u²)²`: infinite, falls as u⁻⁴.
    #[default]
    Cauchy,
    /// `exp(−u²)`: infinite.
    Gauss,
    /// `1/u` (the Newtonian potential): infinite. Its pole is rounded off: u² stands for u² + ε²,
    /// ε = 10⁻⁵.
    Inverse,
    /// `1/u²`: infinite, its pole rounded off in the same way.
    Squared,
    /// `1−3u²` for u ≤ ⅓, then `1.5(1−u)²` up to u = 1, then 0.
    Metaballs,
    /// `1 − (4/9)u⁶ + (17/9)u⁴ − (22/9)u²` up to u = 1, then 0.
    Soft,
    /// `(1−u²)²` up to u = 1, then 0.
    Quartic,
    /// `(1−u²)³` up to u = 1, then 0.
    Compact6,
    /// `1/u³`: infinite, its pole rounded off as those of `inverse` and `squared`.
    Cubed,
}

/// G(q) and its derivatives by q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivatives(pub [f64; 5]);

impl Kernel {
    /// The kernels in the order of the chart.
    pub const ALL: [Self; 9] = [
        Self::Cauchy,
        Self::Gauss,
        Self::Inverse,
        Self::Squared,
        Self::Metaballs,
        Self::Soft,
        Self::Quartic,
        Self::Compact6,
        Self::Cubed,
    ];

    /// Name in the dataset language.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Cauchy => "cauchy",
            Self::Gauss => "gauss",
            Self::Inverse => "inverse",
            Self::Squared => "squared",
            Self::Metaballs => "metaballs",
            Self::Soft => "soft",
            Self::Quartic => "quartic",
            Self::Compact6 => "compact6",
            Self::Cubed => "cubed",
        }
    }

    /// Returns the kernel of that name, `None` if there is none.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kernel| kernel.name() == name)
    }

    /// Whether the kernel is 0 from u = 1 on.
    #[must_use]
    pub fn is_compact(self) -> bool {
        matches!(
            self,
            Self::Metaballs | Self::Soft | Self::Quartic | Self::Compact6
        )
    }

    /// Whether the kernel has a pole, rounded off, at u = 0. Such kernels have no width: their unit
    /// of length is the radius.
    #[must_use]
    pub fn has_pole(self) -> bool {
        matches!(self, Self::Inverse | Self::Squared | Self::Cubed)
    }

    /// Whether the kernel's integral over an infinite plane is finite.
    #[must_use]
    pub fn falls_fast(self) -> bool {
        !matches!(self, Self::Inverse | Self::Squared)
    }

    /// The places u at which a derivative of the kernel jumps, in increasing order.
    #[must_use]
    pub fn kinks(self) -> &'static [f64] {
        match self {
            Self::Cauchy | Self::Gauss | Self::Inverse | Self::Squared | Self::Cubed => &[],
            Self::Metaballs => &[1.0 / 3.0, 1.0],
            Self::Soft | Self::Quartic | Self::Compact6 => &[1.0],
        }
    }

    /// Number of derivatives of `h` along a line that are continuous everywhere; `usize::MAX` for
    /// smooth kernels.
    #[must_use]
    pub fn smoothness(self) -> usize {
        match self {
            Self::Cauchy | Self::Gauss | Self::Inverse | Self::Squared | Self::Cubed => usize::MAX,
            Self::Metaballs | Self::Soft | Self::Quartic => 1,
            Self::Compact6 => 2,
        }
    }

    /// Coefficients c₂, c₃ of a kernel that is `c₂v² + c₃v³` with v = 1−u².
    pub(crate) fn polynomial(self) -> Option<[f64; 2]> {
        match self {
            Self::Quartic => Some([1.0, 0.0]),
            Self::Compact6 => Some([0.0, 1.0]),
            Self::Soft => Some([5.0 / 9.0, 4.0 / 9.0]),
            _ => None,
        }
    }

    /// The value at a distance u ≥ 0.
    #[must_use]
    pub fn value(self, u: f64) -> f64 {
        self.derivatives(u * u).0[0]
    }

    /// G and its first four derivatives at q ≥ 0; at a kink those of the inner piece.
    #[must_use]
    pub fn derivatives(self, q: f64) -> Derivatives {
        Derivatives(match self {
            Self::Cauchy => {
                let i = 1.0 / (1.0 + q);
                let g = i * i;
                [
                    g,
                    -2.0 * g * i,
                    6.0 * g * g,
                    -24.0 * g * g * i,
                    120.0 * g * g * g,
                ]
            }
            Self::Gauss => {
                let g = libm::exp(-q);
                [g, -g, g, -g, g]
            }
            Self::Inverse => {
                let i = 1.0 / (q + inverse::POLE2);
                let g = i.sqrt();
                [
                    g,
                    -0.5 * g * i,
                    0.75 * g * i * i,
                    -1.875 * g * i * i * i,
                    6.5625 * g * i * i * i * i,
                ]
            }
            Self::Squared => {
                let i = 1.0 / (q + inverse::POLE2);
                [
                    i,
                    -i * i,
                    2.0 * i * i * i,
                    -6.0 * i * i * i * i,
                    24.0 * i * i * i * i * i,
                ]
            }
            Self::Cubed => {
                let i = 1.0 / (q + inverse::POLE2);
                let g = i * i.sqrt();
                [
                    g,
                    -1.5 * g * i,
                    3.75 * g * i * i,
                    -13.125 * g * i * i * i,
                    59.0625 * g * i * i * i * i,
                ]
            }
            Self::Metaballs => {
                if q <= metaballs::INNER2 {
                    [1.0 - 3.0 * q, -3.0, 0.0, 0.0, 0.0]
                } else if q <= 1.0 {
                    let u = q.sqrt();
                    let i = 1.0 / q;
                    [
                        1.5 * (1.0 - u) * (1.0 - u),
                        1.5 * (1.0 - 1.0 / u),
                        0.75 * i / u,
                        -1.125 * i * i / u,
                        2.8125 * i * i * i / u,
                    ]
                } else {
                    [0.0; 5]
                }
            }
            Self::Soft | Self::Quartic | Self::Compact6 => {
                let [c2, c3] = self.polynomial().unwrap_or_default();
                if q <= 1.0 {
                    let v = 1.0 - q;
                    [
                        v * v * (c2 + c3 * v),
                        -v * (2.0 * c2 + 3.0 * c3 * v),
                        2.0 * c2 + 6.0 * c3 * v,
                        -6.0 * c3,
                        0.0,
                    ]
                } else {
                    [0.0; 5]
                }
            }
        })
    }

    /// G(q) and G′(q), lane by lane.
    #[inline(always)]
    pub(crate) fn pair<R: Real>(self, q: R) -> (R, R) {
        let (value, fall) = self.falling(q);
        (value, -fall)
    }

    /// Returns upper bounds on G(q) and −G′(q), cheaper than the values.
    #[inline(always)]
    pub(crate) fn falling_at_most<R: Real>(self, q: R) -> (R, R) {
        if self == Self::Gauss {
            let g = q.decay_at_most();
            (g, g)
        } else {
            self.falling(q)
        }
    }

    /// G(q) and −G′(q), lane by lane.
    #[inline(always)]
    pub(crate) fn falling<R: Real>(self, q: R) -> (R, R) {
        let zero = R::splat(0.0);
        let one = R::splat(1.0);
        match self {
            Self::Cauchy => {
                let i = one / (one + q);
                let g = i * i;
                (g, R::splat(2.0) * g * i)
            }
            Self::Gauss => {
                let g = q.decay();
                (g, g)
            }
            Self::Inverse => {
                let i = one / (q + R::splat(inverse::POLE2));
                let g = i.sqrt();
                (g, R::splat(0.5) * g * i)
            }
            Self::Squared => {
                let i = one / (q + R::splat(inverse::POLE2));
                (i, i * i)
            }
            Self::Cubed => {
                let i = one / (q + R::splat(inverse::POLE2));
                let g = i * i.sqrt();
                (g, R::splat(1.5) * g * i)
            }
            Self::Metaballs => {
                let u = q.sqrt().max(R::splat(metaballs::INNER * 0.5));
                let rest = (one - u).max(zero);
                let inner = q.lt(R::splat(metaballs::INNER2));
                (
                    R::select(inner, one - R::splat(3.0) * q, R::splat(1.5) * rest * rest),
                    R::select(inner, R::splat(3.0), R::splat(1.5) * rest / u),
                )
            }
            Self::Soft | Self::Quartic | Self::Compact6 => {
                let [c2, c3] = self.polynomial().unwrap_or_default();
                let v = (one - q).max(zero);
                let (a, b) = (R::splat(c2), R::splat(c3) * v);
                (v * v * (a + b), v * (a + a + R::splat(3.0) * b))
            }
        }
    }

    /// `∫₀ᵘ h`, along a line through the point.
    #[must_use]
    pub fn along(self, u: f64) -> f64 {
        let pole = inverse::POLE2.sqrt();
        match self {
            Self::Cauchy => 0.5 * (u / (1.0 + u * u) + libm::atan(u)),
            Self::Gauss => PI.sqrt() / 2.0 * libm::erf(u),
            Self::Inverse => libm::asinh(u / pole),
            Self::Squared => libm::atan(u / pole) / pole,
            Self::Cubed => u / (inverse::POLE2 * (u * u + inverse::POLE2).sqrt()),
            Self::Metaballs => {
                let cone = |u: f64| (1.0 - (1.0 - u.min(1.0)).powi(3)) / 3.0;
                1.5 * cone(u) - cone(3.0 * u) / 6.0
            }
            Self::Soft | Self::Quartic | Self::Compact6 => {
                let [c2, c3] = self.polynomial().unwrap_or_default();
                let u = u.min(1.0);
                let q = u * u;
                let fourth = 1.0 - q * (2.0 / 3.0 - q / 5.0);
                let sixth = 1.0 - q * (1.0 - q * (3.0 / 5.0 - q / 7.0));
                u * (c2 * fourth + c3 * sixth)
            }
        }
    }

    /// `∫ₐᵇ h` along a line through the point, 0 ≤ a ≤ b.
    #[must_use]
    pub fn between(self, a: f64, b: f64) -> f64 {
        if self == Self::Cubed {
            // Integrals from a and from b on: the difference of two integrals from 0 would be lost
            // beside the pole's part.
            let [from_a, from_b] = [a, b].map(|u| {
                let root = (u * u + inverse::POLE2).sqrt();
                1.0 / (root * (root + u))
            });
            return from_a - from_b;
        }
        self.along(b) - self.along(a)
    }

    /// `∫ G` from p to q, 0 ≤ p ≤ q: over a ring around the point, of area π(q−p), the kernel's
    /// integral is π times this.
    #[must_use]
    pub fn over_ring(self, p: f64, q: f64) -> f64 {
        // Differences of large numbers would lose the digits of a small ring far away.
        let [near, far] = [p, q].map(|q| (q + inverse::POLE2).sqrt());
        match self {
            Self::Inverse => 2.0 * (q - p) / (near + far),
            Self::Squared => libm::log1p((q - p) / (near * near)),
            Self::Cubed => 2.0 * (q - p) / (near * far * (near + far)),
            _ => self.over_disc(q) - self.over_disc(p),
        }
    }

    /// `∫₀^q G`: over a disc around the point, of area πq, the kernel's integral is π times this.
    #[must_use]
    pub fn over_disc(self, q: f64) -> f64 {
        match self {
            Self::Cauchy => q / (1.0 + q),
            Self::Gauss => -libm::expm1(-q),
            Self::Inverse | Self::Squared | Self::Cubed => self.over_ring(0.0, q),
            Self::Metaballs => {
                // 2∫(1−u)²u du from 0.
                let cone = |u: f64| {
                    let rest = 1.0 - u.min(1.0);
                    (1.0 - rest * rest * rest * (1.0 + 3.0 * u.min(1.0))) / 6.0
                };
                let u = q.sqrt();
                1.5 * cone(u) - cone(3.0 * u) / 18.0
            }
            Self::Soft | Self::Quartic | Self::Compact6 => {
                let [c2, c3] = self.polynomial().unwrap_or_default();
                let v = (1.0 - q).max(0.0);
                let v3 = v * v * v;
                c2 * (1.0 - v3) / 3.0 + c3 * (1.0 - v3 * v) / 4.0
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integral::integral;

    #[test]
    fn values_as_defined() {
        for u in [0.0, 0.1, 0.3, 0.5, 0.9, 1.0, 1.5] {
            let inside = |x: f64| if u <= 1.0 { x } else { 0.0 };
            let q: f64 = u * u;
            for (kernel, want) in [
                (Kernel::Cauchy, 1.0 / (1.0 + q).powi(2)),
                (Kernel::Gauss, libm::exp(-q)),
                (Kernel::Inverse, 1.0 / (q + 1e-10).sqrt()),
                (Kernel::Squared, 1.0 / (q + 1e-10)),
                (Kernel::Cubed, 1.0 / ((q + 1e-10) * (q + 1e-10).sqrt())),
                (
                    Kernel::Metaballs,
                    if u <= 1.0 / 3.0 {
                        1.0 - 3.0 * q
                    } else {
                        inside(1.5 * (1.0 - u) * (1.0 - u))
                    },
                ),
                (
                    Kernel::Soft,
                    inside(1.0 - 4.0 / 9.0 * q.powi(3) + 17.0 / 9.0 * q * q - 22.0 / 9.0 * q),
                ),
                (Kernel::Quartic, inside((1.0 - q).powi(2))),
                (Kernel::Compact6, inside((1.0 - q).powi(3))),
            ] {
                let value = kernel.value(u);
                assert!(
                    (value - want).abs() <= 1e-15 * want.max(1.0),
                    "{kernel:?} {u}"
                );
                let (pair, slope) = kernel.pair(q);
                assert!(
                    (pair - want).abs() <= 1e-15 * want.max(1.0),
                    "{kernel:?} {u}"
                );
                let slope_want = kernel.derivatives(q).0[1];
                assert!(
                    (slope - slope_want).abs() <= 1e-14 * slope_want.abs().max(1.0),
                    "{kernel:?} {u}"
                );
            }
        }
    }

    #[test]
    fn derivatives_and_integrals() {
        for kernel in Kernel::ALL {
            for q in [0.04, 0.2, 0.5, 0.8, 2.0] {
                let h = 1e-5;
                let (low, high) = (kernel.derivatives(q - h).0, kernel.derivatives(q + h).0);
                let here = kernel.derivatives(q).0;
                for order in 1..5 {
                    let slope = (high[order - 1] - low[order - 1]) / (2.0 * h);
                    let tolerance = 1e-6 * here[order].abs().max(1.0);
                    assert!(
                        (slope - here[order]).abs() <= tolerance,
                        "{kernel:?} {q} {order}"
                    );
                }
                // From 0.1 on, clear of the poles.
                let u: f64 = q.sqrt();
                let breaks = [0.1, 1.0 / 3.0, 1.0, 2.0].map(|b: f64| b.min(u.max(0.1)));
                let along = integral(&mut |u| kernel.value(u), &breaks, 1e-13);
                let want = kernel.between(0.1, u.max(0.1));
                assert!(
                    (along - want).abs() < 1e-9,
                    "{kernel:?} {u}: {along} {want}"
                );
                // To the accuracy of doubles beside the pole's part.
                let digits = 1e-15 * kernel.along(u);
                let want = kernel.along(u) - kernel.along(0.1);
                assert!(
                    (along - want).abs() < 1e-9 + digits,
                    "{kernel:?} {u}: {along} {want}"
                );
                let squares = breaks.map(|b| b * b);
                let disc = integral(&mut |q| kernel.derivatives(q).0[0], &squares, 1e-13);
                let want = kernel.over_ring(0.01, q);
                assert!((disc - want).abs() < 1e-9, "{kernel:?} {q}: {disc} {want}");
                let want = kernel.over_disc(q) - kernel.over_disc(0.01);
                assert!((disc - want).abs() < 1e-9, "{kernel:?} {q}: {disc} {want}");
            }
        }
    }
}
