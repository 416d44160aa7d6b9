//! Bounds on how a function bends in a ball, and the first terms of its Taylor series there.
use field::{Part, Variation};
use glam::{DMat3, DVec3};
use std::sync::Arc;

/// Largest change of the gradient in a flat cell, as a share of that at its middle.
const FLAT: f64 = 1.0;

/// Bounds on how a function bends in a ball.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bend {
    /// Radius of the ball.
    pub radius: f64,
    /// The largest length of the gradient.
    pub slope: f64,
    /// The largest second derivative along any line, between kinks.
    pub curvature: f64,
    /// The sum of the jumps of the gradient.
    pub jump: f64,
    /// The sum of the jumps of the value.
    pub step: f64,
}

impl Bend {
    /// The bounds of a function in a ball of this radius.
    pub fn of(bounds: &Variation, radius: f64) -> Self {
        Self {
            radius,
            slope: bounds.range.slope,
            curvature: bounds.curvature,
            jump: bounds.jump,
            step: bounds.step,
        }
    }

    /// Returns how much the slope may change over a distance.
    pub fn turn(&self, distance: f64) -> f64 {
        self.curvature * distance + self.jump
    }

    /// Returns the curvature; infinite where the gradient may jump.
    pub fn smooth(&self) -> f64 {
        if self.jump > 0.0 {
            f64::INFINITY
        } else {
            self.curvature
        }
    }

    /// Returns how much the value may differ from its tangent at a distance.
    pub fn error(&self, distance: f64) -> f64 {
        (0.5 * self.curvature * distance + self.jump) * distance + self.step
    }

    /// Returns how much the value may change over a distance along a line, where the slope is this.
    pub fn change(&self, slope: f64, distance: f64) -> f64 {
        let change = (slope.abs() + 0.5 * self.curvature * distance + self.jump) * distance;
        change.min(self.slope * distance) + self.step
    }
}

/// The first terms of a function's Taylor series in a cell, and bounds on the rest.
#[derive(Debug)]
pub(crate) struct Flat {
    pub center: DVec3,
    /// The value less T.
    pub value: f64,
    pub gradient: DVec3,
    /// The second derivative, or 0.
    pub hessian: DMat3,
    /// Bound on the difference of second derivatives along any line from that, beside `third`
    /// times the distance from the middle.
    pub second: f64,
    pub third: f64,
    /// Bounds without the Taylor series.
    pub bend: Bend,
    pub part: Option<Arc<Part>>,
}

impl Flat {
    /// Returns a bound on the error of the value at a distance from the middle.
    pub fn error(&self, distance: f64) -> f64 {
        let second = 0.5 * self.second + self.third / 6.0 * distance;
        (second * distance + self.bend.jump) * distance
    }

    /// Returns a bound on the error of the gradient at a distance from the middle.
    pub fn turn(&self, distance: f64) -> f64 {
        (self.second + 0.5 * self.third * distance) * distance + self.bend.jump
    }

    /// Whether the gradient hardly changes in the cell, beside what the series tells. Not so for
    /// bounds that are infinite or no numbers.
    pub fn is_flat(&self) -> bool {
        let enough = FLAT * self.gradient.length();
        self.turn(self.bend.radius) <= enough && self.bend.step == 0.0
    }
}
