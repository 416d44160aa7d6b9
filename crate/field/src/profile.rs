//! Profiles: functions along a primitive that multiply its field (thesis, section 3.3.4). Along an
//! arc the wave gives way to its mean towards the circle's axis, where the angle has no meaning.
use serde::{Deserialize, Serialize};

/// A wave of one parameter, with values in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Wave {
    /// 1 everywhere.
    One,
    /// The parameter itself, clamped to [0, 1].
    X,
    /// `(1 + sin x)/2`, x in radians.
    Sin,
    /// `(1 + cos x)/2`.
    Cos,
    /// `sin² x`.
    Sin2,
    /// `cos² x`.
    Cos2,
    /// The fraction of x.
    Saw,
    /// `1 − |2·fract(x) − 1|`.
    Hat,
    /// 0 for fract(x) < ½, else 1.
    Step,
}

impl Wave {
    /// The waves in the order of the language.
    pub const ALL: [Self; 9] = [
        Self::One,
        Self::X,
        Self::Sin,
        Self::Cos,
        Self::Sin2,
        Self::Cos2,
        Self::Saw,
        Self::Hat,
        Self::Step,
    ];
}

/// `times · (low + (high−low)·fu(scale_u·u)·fv(scale_v·v))` with u, v in [0, 1] along the
/// primitive; on a triangle also times `1 − restriction·(1−b)`, where `b = 27·λ₀λ₁λ₂` of the
/// barycentric coordinates is 1 in the middle and 0 on and beyond the edges. So a restricted
/// triangle blends less with its neighbours, and a mesh of them shows creases, up to the full
/// wrinkle at 1 (thesis, figures 3.18 and 3.19; the shape of b is ours).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Profile {
    /// Waves of u and v.
    pub waves: [Wave; 2],
    /// Factors on u and v before the waves.
    pub scale: [f64; 2],
    /// The value where the waves' product is 0 and where it is 1.
    pub bounds: [f64; 2],
    /// Factor on the whole.
    pub times: f64,
    /// Part of a triangle's field that is taken away at its edges, 0 to 1.
    pub restriction: f64,
}

impl Default for Profile {
    /// The profile that changes nothing.
    fn default() -> Self {
        Self {
            waves: [Wave::One; 2],
            scale: [1.0; 2],
            bounds: [0.0, 1.0],
            times: 1.0,
            restriction: 0.0,
        }
    }
}

impl Profile {
    /// The largest magnitude of the factor: waves' products are in [0, 1].
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.times.abs() * self.bounds[0].abs().max(self.bounds[1].abs())
    }
}
