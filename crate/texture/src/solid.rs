//! Ten solid methods: patterns that fill space, as if the object were carved from a block.
//!
//! Every pattern takes a point of texture space and gives a value in [0, 1] per channel; all but
//! [`Solid::Paint`] are grey, to be coloured by what they scale or by a texture's bounds. At scale
//! 1 they suit objects about two units across.

mod cut;
mod spots;
mod stone;
mod timber;

use crate::noise::{MAX_OCTAVES, sane};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Pattern that fills space.
///
/// ```
/// use glam::DVec3;
/// use texture::{Grain, Solid};
/// let white = Solid::Checker.pattern(DVec3::new(0.5, 0.5, 0.5), Grain::default());
/// let black = Solid::Checker.pattern(DVec3::new(1.5, 0.5, 0.5), Grain::default());
/// assert_eq!((white, black), ([1.0; 3], [0.0; 3]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Solid {
    /// Light stone with dark veins, one of them a unit along x.
    Marble,
    /// Nested bands of many widths around eyes, as in cut agate.
    Agate,
    /// Crystals a tenth across: light, grey and dark ones.
    Granite,
    /// Craters of all sizes up to a third of a unit, and dark plains.
    Moon,
    /// Shells around the origin, four a unit, with thin dark skins and fine lines from pole to pole
    /// of the y axis.
    Onion,
    /// Growth rings around the z axis, four a unit, and fibres along it.
    Wood,
    /// Rings of waves as around drops in water, five a unit.
    Ripples,
    /// Fine straight wood without rings: wavering streaks and dark pores along the z axis.
    Sandal,
    /// Cubes of one unit, white and black by turns; the one from 0 to 1 is white.
    Checker,
    /// Splashes of paint in bright colours on white.
    Paint,
}

/// Amount and fineness of a pattern's noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Grain {
    /// Amount of noise: 0 none, 1 full. What is not finite counts as 0.
    pub turbulence: f64,
    /// Octaves of noise, 0 to 32; a fraction fades the last one.
    pub octaves: f64,
}

impl Default for Grain {
    fn default() -> Self {
        Self {
            turbulence: 1.0,
            octaves: 5.0,
        }
    }
}

impl Solid {
    /// The solids, in the order of the manual.
    pub const ALL: [Self; 10] = [
        Self::Marble,
        Self::Agate,
        Self::Granite,
        Self::Moon,
        Self::Onion,
        Self::Wood,
        Self::Ripples,
        Self::Sandal,
        Self::Checker,
        Self::Paint,
    ];

    /// Red, green and blue of the pattern at a point of texture space, each in [0, 1]. Coordinates
    /// that are not finite count as 0 or as the largest number.
    #[must_use]
    pub fn pattern(self, q: DVec3, grain: Grain) -> [f64; 3] {
        let (q, grain) = (sane(q), grain.sane());
        let grey = match self {
            Self::Marble => stone::marble(q, grain),
            Self::Agate => stone::agate(q, grain),
            Self::Granite => stone::granite(q, grain),
            Self::Moon => spots::moon(q, grain),
            Self::Onion => cut::onion(q, grain),
            Self::Wood => timber::wood(q, grain),
            Self::Ripples => 0.5 + 0.5 * spots::ripples(q, grain),
            Self::Sandal => timber::sandal(q, grain),
            Self::Checker => cut::checker(q),
            Self::Paint => return spots::paint(q, grain).0.map(|x| x.clamp(0.0, 1.0)),
        };
        [grey.clamp(0.0, 1.0); 3]
    }

    /// Height of the pattern as a bump, in units of texture space, with slopes of about 1 at most:
    /// what is bright stands out, but craters are as deep as craters are, paint lies on, and
    /// checkers have bevelled edges (a face that lies on a border of cubes is flat).
    #[must_use]
    pub fn relief(self, q: DVec3, grain: Grain) -> f64 {
        let (q, grain) = (sane(q), grain.sane());
        let depth = match self {
            Self::Moon => return spots::craters(q, grain),
            Self::Ripples => {
                return spots::ripples(q, grain)
                    * (0.6 / (spots::RIPPLES * core::f64::consts::TAU));
            }
            Self::Paint => return 0.04 * spots::paint(q, grain).1,
            Self::Granite | Self::Sandal => 0.015,
            Self::Agate => 0.02,
            Self::Wood => 0.04,
            Self::Checker => return 0.05 * cut::checker_height(q),
            Self::Marble | Self::Onion => 0.05,
        };
        depth * self.pattern(q, grain)[0]
    }
}

impl Grain {
    fn sane(self) -> Self {
        let limits = [(self.turbulence, 1e6), (self.octaves, MAX_OCTAVES)];
        let [turbulence, octaves] = limits.map(|(x, most)| {
            if x.is_finite() {
                x.clamp(-most, most)
            } else {
                0.0
            }
        });
        Self {
            turbulence,
            octaves,
        }
    }
}

/// 3t² − 2t³ of x's place between two numbers, cut to [0, 1]. `from` < `to`.
fn smooth(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Interpolates linearly: `from` at t = 0, `to` at t = 1.
pub(crate) fn mix(from: f64, to: f64, t: f64) -> f64 {
    from + (to - from) * t
}
