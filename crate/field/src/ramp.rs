//! Ramps: profiles that are linear along a segment.
//!
//! At x along the segment, in kernel widths from its middle, the factor on the field is
//! `low + rise·min(max(start + rate·x, 0), top)`: linear beside the segment and constant beyond its
//! ends. Along a ray x is linear in t, so the factor is piecewise linear with at most two kinks,
//! for which [`BlobOnRay`](crate::BlobOnRay) has bounds.
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
    /// Returns the profile of a segment of this half length in kernel widths; `None` if it is no
    /// ramp, negative somewhere or 0.
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

    /// Factors at the segment's two ends.
    fn ends(&self) -> [f64; 2] {
        [self.low, self.low + self.rise * self.top]
    }

    /// Largest change in a kernel width, over the largest value.
    pub(crate) fn steepness(&self) -> f64 {
        (self.rise * self.rate).abs() / self.largest()
    }

    /// Largest factor.
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
    /// Returns the factor at x and its derivative by x.
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

    /// Returns upper bounds between two positions: on the factor, on the size of its derivative by
    /// x, and on that derivative's drop in a kink.
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
        // The derivative falls at one kink, that of the largest factor.
        let kink = R::select(climbs, top, zero);
        let bends = R::both(first.lt(kink), kink.lt(last));
        [
            R::lift(self.low) + rise * highest,
            R::select(meets, steep, zero),
            R::select(bends, steep, zero),
        ]
    }
}
