//! Waves of one parameter, in pairs over u and v.

use serde::{Deserialize, Serialize};

/// Wave with values in [0, 1]. The same shapes as the profiles of a field's strength, so that a
/// colour and a profile with the same words keep step.
///
/// ```
/// use texture::Wave;
/// assert_eq!(Wave::Hat.jet(0.25), (0.5, 2.0)); // value, slope
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Wave {
    /// 1 everywhere.
    One,
    /// The parameter itself, cut to [0, 1].
    X,
    /// The fraction of x.
    Saw,
    /// `1 − |2·fract(x) − 1|`.
    Hat,
    /// 0 for fract(x) < ½, else 1.
    Step,
    /// `(1 + sin x)/2`, x in radians.
    Sin,
    /// `(1 + cos x)/2`.
    Cos,
    /// `sin² x`.
    Sin2,
    /// `cos² x`.
    Cos2,
}

impl Wave {
    /// The waves, in the order of the manual.
    pub const ALL: [Self; 9] = [
        Self::One,
        Self::X,
        Self::Saw,
        Self::Hat,
        Self::Step,
        Self::Sin,
        Self::Cos,
        Self::Sin2,
        Self::Cos2,
    ];

    /// Value and slope. Jumps have the slope beside them; a parameter that is not finite counts as
    /// 0.
    #[must_use]
    pub fn jet(self, x: f64) -> (f64, f64) {
        let x = if x.is_finite() { x } else { 0.0 };
        let fraction = x - x.floor();
        match self {
            Self::One => (1.0, 0.0),
            Self::X => (
                x.clamp(0.0, 1.0),
                if x > 0.0 && x < 1.0 { 1.0 } else { 0.0 },
            ),
            Self::Saw => (fraction, 1.0),
            Self::Hat => (
                1.0 - (2.0 * fraction - 1.0).abs(),
                if fraction < 0.5 { 2.0 } else { -2.0 },
            ),
            Self::Step => (if fraction < 0.5 { 0.0 } else { 1.0 }, 0.0),
            Self::Sin => (0.5 + 0.5 * libm::sin(x), 0.5 * libm::cos(x)),
            Self::Cos => (0.5 + 0.5 * libm::cos(x), -0.5 * libm::sin(x)),
            Self::Sin2 => {
                let (s, c) = libm::sincos(x);
                (s * s, 2.0 * s * c)
            }
            Self::Cos2 => {
                let (s, c) = libm::sincos(x);
                (c * c, -2.0 * s * c)
            }
        }
    }
}
