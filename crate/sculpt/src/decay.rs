//! Decay functions: how a vertex's motion fades over its neighbours.

use core::f64::consts::PI;

/// Function of the distance from a vertex that is moved, t from 0 to 1 at the end of the range. It
/// falls from 1, and is 0 beyond 1.
///
/// ```
/// use sculpt::Decay;
///
/// assert_eq!(Decay::Cone.at(0.25), 0.75);
/// assert!(Decay::Goo.at(0.5) > Decay::Bell.at(0.5) && Decay::Bell.at(0.5) > Decay::Cusp.at(0.5));
/// assert_eq!(Decay::of_name("bell"), Some(Decay::Bell));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Decay {
    /// (1 − t⁴)²: a broad top that falls late.
    Goo,
    /// (1 + cos πt)/2.
    Bell,
    /// (1 − t)²: a sharp peak.
    Cusp,
    /// 1 − t.
    Cone,
    /// 1.
    #[default]
    Flat,
}

impl Decay {
    /// The decay functions, in the order of the manual.
    pub const ALL: [Self; 5] = [Self::Goo, Self::Bell, Self::Cusp, Self::Cone, Self::Flat];

    /// The value at t ≥ 0, in 0 … 1.
    #[must_use]
    pub fn at(self, t: f64) -> f64 {
        if t.is_nan() || t > 1.0 {
            return 0.0;
        }
        let s = 1.0 - t;
        match self {
            Self::Goo => {
                let square = t * t;
                let root = 1.0 - square * square;
                root * root
            }
            Self::Bell => 0.5 * (1.0 + libm::cos(PI * t)),
            Self::Cusp => s * s,
            Self::Cone => s,
            Self::Flat => 1.0,
        }
    }

    /// Returns the word for it in texts of strokes.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Goo => "goo",
            Self::Bell => "bell",
            Self::Cusp => "cusp",
            Self::Cone => "cone",
            Self::Flat => "flat",
        }
    }

    /// Returns the decay function with a name, if there is one.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|decay| decay.name() == name)
    }
}
