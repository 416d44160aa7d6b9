//! The trait of kernels: all that the program knows of one.
use crate::bone::Bone;
use crate::envelope::Roughness;
use crate::influence::Crowding;
use crate::kernel::POLE2;
use crate::kernel::cells::{self, Cells};
use crate::kernel::numeric;
use crate::{Jet, Real};

/// Number of Newton's steps to a value of a kernel.
const NEWTON: usize = 64;

/// The way in which a kernel goes to 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tail {
    /// The kernel is 0 from u = 1 on.
    Compact,
    /// The kernel is `(ε² + u²)^(−e/2)` everywhere: an infinite kernel, whose far field has an
    /// expansion.
    Power {
        /// e, from 1 to 4.
        exponent: i32,
        /// ε²: 1, or [`POLE2`] where a pole is rounded off.
        softening: f64,
    },
    /// The kernel is infinite, and falls faster than u⁻⁴.
    Fast,
}

impl Tail {
    /// The tail of `1/u^exponent`, whose pole is rounded off.
    pub(crate) const fn pole(exponent: i32) -> Self {
        Self::Power {
            exponent,
            softening: POLE2,
        }
    }

    /// Whether there is a pole, rounded off, at u = 0.
    pub(crate) fn has_pole(self) -> bool {
        matches!(self, Self::Power { softening, .. } if softening < 1.0)
    }
}

/// A kernel. In units of its width it is h(u) = G(q), q = u² ≥ 0; G falls
/// and is convex.
///
/// Lengths are in kernel widths, and fields for a factor of 1.
pub(crate) trait Falloff: Sized {
    /// Name in the dataset language.
    const NAME: &'static str;
    /// The meaning in a few words, for the manual.
    const MEANING: &'static str;
    /// h, for people.
    const FORMULA: &'static str;
    /// The way in which it goes to 0.
    const TAIL: Tail;
    /// The formulas of its fields, and the methods of computing them, for people.
    const CELLS: Cells = cells::NUMERIC;
    /// The places u at which a derivative jumps, in increasing order: the last is 1, and there are
    /// at most two.
    const KINKS: &'static [f64] = &[];
    /// Number of derivatives of h along a line that are continuous everywhere; `usize::MAX` for
    /// smooth kernels.
    const SMOOTHNESS: usize = usize::MAX;
    /// Bounds on the third and the fourth derivative along any line inside a compact kernel's
    /// support, if all of the line is inside; infinite where there are none.
    const INSIDE: [f64; 2] = [f64::INFINITY; 2];
    /// Whether G has no singularity at any complex q. Of other smooth kernels none is nearer to
    /// q ≥ 0 than −1.
    const ENTIRE: bool = false;
    /// Whether tapered segments are evaluated at once, as a
    /// [`Cone`](crate::kernel::cubed::cone::Cone).
    const HAS_CONES: bool = false;

    /// Computes G and its first four derivatives; at a kink those of the inner piece.
    fn derivatives(q: f64) -> [f64; 5];

    /// Computes G and −G′.
    #[inline(always)]
    fn falling<R: Real>(q: R) -> (R, R) {
        let [value, slope] =
            [0, 1].map(|i| R::from_lanes(|lane| Self::derivatives(q.lane(lane))[i]));
        (value, -slope)
    }

    /// Computes upper bounds on G and −G′, if possible more cheaply than the values.
    #[inline(always)]
    fn falling_at_most<R: Real>(q: R) -> (R, R) {
        Self::falling(q)
    }

    /// Computes an upper bound on h(u), if possible more cheaply than the value.
    #[inline(always)]
    fn at_most(u: f64) -> f64 {
        Self::derivatives(u * u)[0]
    }

    /// Returns the q at which G is `1/ratio`, negative if G is nowhere so large. Newton's steps
    /// from 0 never leave the inside, as G falls and is convex.
    fn square_of(ratio: f64) -> f64 {
        let Tail::Power {
            exponent,
            softening,
        } = Self::TAIL
        else {
            return (0..NEWTON).fold(0.0, |q, _| {
                let [value, slope, ..] = Self::derivatives(q);
                q + (1.0 / ratio - value) / slope
            });
        };
        let square = match exponent {
            1 => ratio * ratio,
            2 => ratio,
            3 => libm::cbrt(ratio * ratio),
            4 => ratio.sqrt(),
            _ => libm::pow(ratio, 2.0 / f64::from(exponent)),
        };
        square - softening
    }

    /// Computes `∫₀ᵘ h`, along a line through the point.
    fn along(u: f64) -> f64 {
        Self::between(0.0, u)
    }

    /// Computes `∫ₐᵇ h` along a line through the point, 0 ≤ a ≤ b.
    fn between(a: f64, b: f64) -> f64 {
        numeric::between::<Self>(a, b)
    }

    /// Computes `∫ G` from p to q, 0 ≤ p ≤ q: over a ring around the point, of area π(q−p), the
    /// kernel's integral is π times this.
    fn over_ring(p: f64, q: f64) -> f64 {
        numeric::ring::<Self>(p, q - p)[0]
    }

    /// Computes the field of an infinite line at a distance; where that is infinite, of one of
    /// half-length [`WINDOW`](crate::kernel::WINDOW).
    fn line(distance: f64) -> f64 {
        numeric::line::<Self>(distance)
    }

    /// Computes a bound on the field of an infinite line, given [`Falloff::at_most`] at the same
    /// distance. It may be infinite.
    #[inline(always)]
    fn line_at_most(distance: f64, _point: f64) -> f64 {
        Self::line(distance)
    }

    /// Computes the field of an infinite plane at a height z above or below it; where that is
    /// infinite, of a disc of radius [`WINDOW`](crate::kernel::WINDOW). Then its derivative by z,
    /// over −2πz.
    fn plane<R: Real>(z: R) -> (R, R) {
        numeric::plane::<Self, R>(z)
    }

    /// Computes the width parameter, times the radius, for a blobbiness
    /// ([`Shaping::width`](crate::Shaping::width)): where the logarithmic slope is Blinn's.
    fn width(blobbiness: f64) -> f64 {
        numeric::width::<Self>(blobbiness)
    }

    /// Computes a bone's field: by closed forms, a line for each bone that has one.
    #[inline(always)]
    fn jet<R: Real>(bone: &Bone<R::Scalar>, p: [R; 3]) -> Jet<R> {
        numeric::jet::<Self, R>(bone, p)
    }

    /// Computes a bound on the field of an arc at distance d or more from it.
    fn arc_at_most(length: f64, radius: f64, d: f64) -> f64 {
        let crowding = Crowding::arc(length, radius);
        crowding.integral_bound(d, |u| Self::derivatives(u * u)[0], Self::between)
    }

    /// Computes bounds on the highest derivative that exists everywhere, at distance u or more;
    /// `None` if they are tabulated.
    #[inline(always)]
    fn roughness(_u: f64) -> Option<Roughness> {
        None
    }

    /// Computes h(u), and [`Roughness::point`]; `None` if that is tabulated.
    #[inline(always)]
    fn value_and_roughness(_u: f64) -> Option<(f64, f64)> {
        None
    }
}
