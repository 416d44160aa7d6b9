//! The simplest profile along a segment: it rises or falls evenly from one end to the other.
//!
//! At x along the segment, in kernel widths from its middle, the factor on the field is
//! `low + rise·min(max(start + rate·x, 0), top)`: linear beside the segment and constant beyond its ends. Along a ray x is
//! linear in t, so the factor is linear with at most two kinks, which [`Course`](crate::Course) can follow.
use crate::waves::Waves;
use crate::{Real, Wave};

/// A factor that is linear along a segment and nowhere below 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ramp<S> {
    start: S,
    rate: S,
    top: S,
    low: S,
    rise: S,
}

impl Ramp<f64> {
    /// The profile of a segment of such a half length in kernel widths, if it is a ramp and above 0 somewhere.
    pub(crate) fn of(waves: &Waves<f64>, half: f64) -> Option<Self> {
        let ([Wave::X, Wave::One], [scale, _]) = (waves.waves, waves.scale) else {
            return None;
        };
        let own = Self {
            start: 0.5 * scale,
            rate: 0.5 * scale / half,
            top: scale.min(1.0),
            low: waves.low,
            rise: waves.rise,
        };
        let [first, last] = own.ends();
        (scale > 0.0 && first >= 0.0 && last >= 0.0 && own.largest() > 0.0).then_some(own)
    }

    /// The factors before its kinks and after.
    fn ends(&self) -> [f64; 2] {
        [self.low, self.low + self.rise * self.top]
    }

    /// By how much of its largest value it changes in a kernel's width, at most.
    pub(crate) fn steepness(&self) -> f64 {
        (self.rise * self.rate).abs() / self.largest()
    }

    /// The factor is nowhere more than this.
    pub(crate) fn largest(&self) -> f64 {
        let [first, last] = self.ends();
        first.max(last)
    }
}

impl<S> Ramp<S> {
    pub(crate) fn cast<Q>(self, f: impl Fn(S) -> Q) -> Ramp<Q> {
        Ramp {
            start: f(self.start),
            rate: f(self.rate),
            top: f(self.top),
            low: f(self.low),
            rise: f(self.rise),
        }
    }
}

impl<S: Copy> Ramp<S> {
    /// The factor at x, and its derivative by x.
    #[inline(always)]
    pub fn at<R: Real<Scalar = S>>(&self, x: R) -> (R, R) {
        let zero = R::splat(0.0);
        let (rate, top, rise) = (R::lift(self.rate), R::lift(self.top), R::lift(self.rise));
        let place = R::lift(self.start) + rate * x;
        let cut = place.max(zero).min(top);
        let inside = R::both(zero.lt(place), place.lt(top));
        (
            R::lift(self.low) + rise * cut,
            R::select(inside, rise * rate, zero),
        )
    }

    /// Between two places: the most that the factor is, the most that its derivative by x is, of either sign, and by how much
    /// that falls in a kink.
    #[inline(always)]
    pub fn most<R: Real<Scalar = S>>(&self, a: R, b: R) -> [R; 3] {
        let zero = R::splat(0.0);
        let (start, rate) = (R::lift(self.start), R::lift(self.rate));
        let (top, rise) = (R::lift(self.top), R::lift(self.rise));
        let (a, b) = (start + rate * a, start + rate * b);
        let (first, last) = (a.min(b), a.max(b));
        let climbs = zero.lt(rise);
        let highest = R::select(climbs, last, first).max(zero).min(top);
        let steep = (rise * rate).abs();
        let meets = R::both(zero.lt(last), first.lt(top));
        // Where the factor is largest its derivative falls to 0, or from 0.
        let kink = R::select(climbs, top, zero);
        let bends = R::both(first.lt(kink), kink.lt(last));
        [
            R::lift(self.low) + rise * highest,
            R::select(meets, steep, zero),
            R::select(bends, steep, zero),
        ]
    }
}
