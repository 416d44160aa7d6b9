//! Ranges of values in a ball, and the functions that deform bodies in contact.
use std::sync::Arc;

/// The least and the largest value of a function in a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub low: f64,
    pub high: f64,
}

impl Range {
    /// Returns the range of the larger of two functions.
    pub fn or(self, other: Self) -> Self {
        Self {
            low: self.low.max(other.low),
            high: self.high.max(other.high),
        }
    }
}

/// A function g of another body's field by which a body is deformed: 0 where the field is below a
/// start, 1 − f where it is above 1, and a bulge between.
#[derive(Clone)]
pub struct Deformation {
    /// Value of the field from which on g is not 0.
    pub start: f64,
    formula: Arc<dyn Fn(f64) -> f64 + Send + Sync>,
    /// The largest slope in the bulge.
    steepest: f64,
}

impl core::fmt::Debug for Deformation {
    fn fmt(&self, f: &mut core::fmt::Formatter) -> core::fmt::Result {
        write!(f, "Deformation from {}", self.start)
    }
}

/// Number of samples of a bulge from which its slope is taken.
const SAMPLES: u32 = 4096;
/// Factor on the largest slope between samples.
const ENLARGED: f64 = 1.05;
/// Number of parts of an interval of f; the values at their ends bound those between.
const PARTS: u32 = 16;

impl Deformation {
    /// Returns a deformation by a formula that holds between its start and 1.
    #[must_use]
    pub fn new(start: f64, formula: Arc<dyn Fn(f64) -> f64 + Send + Sync>) -> Self {
        let changes = (0..SAMPLES).map(|i| {
            let [before, after] = [i, i + 1]
                .map(|i| formula(start + (1.0 - start) * f64::from(i) / f64::from(SAMPLES)));
            (after - before).abs()
        });
        let step = (1.0 - start) / f64::from(SAMPLES);
        Self {
            start,
            steepest: ENLARGED * changes.fold(0.0, f64::max) / step,
            formula,
        }
    }

    /// Returns g.
    pub(super) fn value(&self, f: f64) -> f64 {
        match f {
            f if f < self.start => 0.0,
            f if f > 1.0 => 1.0 - f,
            f => (self.formula)(f),
        }
    }

    /// Returns the slope of g, by a difference.
    pub(super) fn slope(&self, f: f64) -> f64 {
        const STEP: f64 = 1e-6;
        (self.value(f + STEP) - self.value(f - STEP)) / (2.0 * STEP)
    }

    /// Returns the range of g over an interval of f.
    pub(super) fn range(&self, of: Range) -> Range {
        let mut all = Range {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
        };
        let mut add = |low: f64, high: f64| {
            all.low = all.low.min(low);
            all.high = all.high.max(high);
        };
        if of.low < self.start {
            add(0.0, 0.0);
        }
        if of.high > 1.0 {
            add(1.0 - of.high, 1.0 - of.low.max(1.0));
        }
        let (from, to) = (of.low.max(self.start), of.high.min(1.0));
        if from <= to {
            let slack = self.steepest * 0.5 * (to - from) / f64::from(PARTS) + 1e-13;
            for i in 0..=PARTS {
                let value = self.value(from + (to - from) * f64::from(i) / f64::from(PARTS));
                add(value - slack, value + slack);
            }
        }
        all
    }
}
