//! Implicit functions: the definition of a surface that tracer, mesher, picker and slices share.
use crate::Jet;
use crate::far_field::Cell;
use glam::DVec3;
use std::sync::Arc;
use wide::f32x8;

/// A ball of space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Centre.
    pub center: DVec3,
    /// Radius, ≥ 0.
    pub radius: f64,
}

impl Ball {
    /// Returns a ball that holds both, the smallest up to rounding.
    #[must_use]
    pub fn around(&self, other: &Self) -> Self {
        let apart = self.center.distance(other.center);
        if apart + other.radius <= self.radius {
            return *self;
        }
        if apart + self.radius <= other.radius {
            return *other;
        }
        let radius = 0.5 * (apart + self.radius + other.radius);
        let towards = (other.center - self.center) / apart;
        Self {
            center: self.center + towards * (radius - self.radius),
            radius: radius * (1.0 + 1e-12),
        }
    }
}

/// Proven bounds on a function in a ball.
///
/// Where the function is not smooth in the ball the bounds that do not exist are infinite:
/// `curvature` where its gradient jumps, `slope`, too, where its value does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    /// The least and the largest value.
    pub value: [f64; 2],
    /// The largest length of the gradient.
    pub slope: f64,
    /// The largest size of the second derivative along any line.
    pub curvature: f64,
}

impl Enclosure {
    /// Enclosure of the function 0.
    pub const ZERO: Self = Self {
        value: [0.0; 2],
        slope: 0.0,
        curvature: 0.0,
    };

    /// Enclosure of the sum of two functions.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            value: [0, 1].map(|i| self.value[i] + other.value[i]),
            slope: self.slope + other.slope,
            curvature: self.curvature + other.curvature,
        }
    }

    /// Returns the enclosure with its range of values narrowed by Taylor's theorem about the centre
    /// of the ball, where the function has this value and gradient:
    /// `|f(c+x) − f(c)| ≤ min(S·r, |∇f(c)|·r + C·r²/2)` for `|x| ≤ r`.
    #[must_use]
    pub fn about(self, at_center: &Jet<f64>, radius: f64) -> Self {
        let steep = DVec3::from_array(at_center.gradient).length();
        let [first, second] = [
            self.slope * radius,
            steep * radius + 0.5 * self.curvature * radius * radius,
        ]
        .map(|change| {
            if change.is_nan() {
                f64::INFINITY
            } else {
                change
            }
        });
        // Rounding of the value itself, which sums of many terms have.
        let reach = first.min(second) + 1e-12 * (1.0 + at_center.value.abs());
        let [low, high] = self.value;
        Self {
            value: [
                low.max(at_center.value - reach),
                high.min(at_center.value + reach),
            ],
            ..self
        }
    }
}

/// The terms of a function that matter in a ball, and bounds on all others there; made by
/// [`Implicit::narrow`].
#[derive(Clone, Debug)]
pub struct Part {
    /// The ball.
    pub ball: Ball,
    /// Numbers of the terms, in the order in which the function adds them up.
    pub terms: Vec<u32>,
    /// Bounds on the sum of the others in the ball, but for those that the polynomial stands for.
    pub rest: Enclosure,
    /// A cell around the ball whose polynomial stands for further terms; `None` if there are none.
    pub far: Option<Arc<Cell>>,
}

impl Part {
    /// Bounds on the error of the polynomial, and on that of its gradient.
    #[must_use]
    pub fn error(&self) -> [f64; 2] {
        match &self.far {
            Some(cell) => [cell.error, cell.smooth.slope_error],
            None => [0.0; 2],
        }
    }
}

/// Errors that a caller of [`Implicit::narrow`] bears, in units of the function's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slack {
    /// Bound on what is left out.
    pub left_out: f64,
    /// Largest error of a polynomial that stands for terms which are far; 0 if there must be none.
    pub far: f64,
}

/// Proven bounds on a function in a ball, up to the third derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variation {
    /// Bounds up to the second derivative. Its values need not be narrowed by [`Enclosure::about`].
    pub range: Enclosure,
    /// The largest size of the second derivative along any line, between kinks.
    pub curvature: f64,
    /// The largest size of the third derivative along any line, of the terms whose second
    /// derivative is continuous in the ball.
    pub third: f64,
    /// The largest size of the second derivative along any line, of all other terms, between kinks.
    pub rough: f64,
    /// The sum of the jumps of the gradient at kinks in the ball, and of what else it changes there
    /// beside the curvature.
    pub jump: f64,
    /// The sum of the jumps of the value in the ball; the derivatives are then those on either
    /// side.
    pub step: f64,
}

impl Variation {
    /// Bounds on the sum of two functions.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            range: self.range.plus(other.range),
            curvature: self.curvature + other.curvature,
            third: self.third + other.third,
            rough: self.rough + other.rough,
            jump: self.jump + other.jump,
            step: self.step + other.step,
        }
    }

    /// Bounds with the range of values narrowed by Taylor's theorem about the centre of the ball,
    /// as [`Enclosure::about`] does; where there are kinks the slope may change by their jumps
    /// besides.
    #[must_use]
    pub fn about(mut self, at_center: &Jet<f64>, radius: f64) -> Self {
        if self.step > 0.0 {
            return self;
        }
        let slope = DVec3::from_array(at_center.gradient).length() + self.jump;
        let second = (slope + 0.5 * self.curvature * radius) * radius;
        // Slopes that are no numbers bound nothing.
        let reach = (self.range.slope * radius).min(second) + 1e-12 * (1.0 + at_center.value.abs());
        let [low, high] = self.range.value;
        if reach >= 0.0 {
            self.range.value = [
                low.max(at_center.value - reach),
                high.min(at_center.value + reach),
            ];
        }
        self
    }

    /// Bounds on a function of which no more is known than this: its second derivative may jump,
    /// and its gradient too if it has no curvature.
    #[must_use]
    pub fn rough(range: Enclosure) -> Self {
        let is_smooth = range.curvature.is_finite();
        let curvature = if is_smooth { range.curvature } else { 0.0 };
        Self {
            range,
            curvature,
            third: 0.0,
            rough: curvature,
            // The gradient is not longer than the slope anywhere.
            jump: if is_smooth { 0.0 } else { 2.0 * range.slope },
            step: 0.0,
        }
    }
}

/// A ball around a point in which a function does not cross the threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// The ball's radius, ≥ 0.
    pub radius: f64,
    /// Length over which the function changes by a factor or so: where the radius is much less, the
    /// surface is near.
    pub scale: f64,
}

/// A function of space. Its surface is where it equals [`THRESHOLD`](crate::THRESHOLD), inside is
/// where it is larger, and the outward normal is `−∇f/|∇f|`.
///
/// [`Sum`](crate::Sum) is the convolution surface. Other implementations may compose functions;
/// code that traces or meshes surfaces needs nothing but this trait.
pub trait Implicit: Send + Sync {
    /// Value and gradient in double precision.
    fn jet(&self, point: DVec3) -> Jet<f64>;

    /// Value and gradient in single precision.
    fn jet32(&self, point: [f32; 3]) -> Jet<f32>;

    /// Value and gradient at eight points in single precision.
    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8>;

    /// Proven bounds on the function in a ball.
    fn enclose(&self, ball: Ball) -> Enclosure;

    /// Returns a bound on the largest value in a ball that costs less than [`Implicit::enclose`],
    /// or infinity.
    fn most(&self, _ball: Ball) -> f64 {
        f64::INFINITY
    }

    /// Returns a ball around a point in which the function does not cross the threshold; `None` if
    /// the function knows none. It costs as much as a value does, and lets a ray go on by large
    /// steps where [`Implicit::enclose`] would need many small balls.
    fn clearance(&self, _point: DVec3) -> Option<Clearance> {
        None
    }

    /// Appends each element's share of the value at a point, as pairs of an element's number and
    /// its positive part of the value, in the order of the elements: the weights by which their
    /// colours are mixed. An element whose part is 0 or negative may be left out.
    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>);

    /// Returns a ball outside of which the function is below the threshold; `None` if there is none
    /// or none is known.
    fn support(&self) -> Option<Ball>;

    /// Returns a ball outside of which the function is at most `level` > 0; `None` if there is none
    /// or none is known. Sums of functions ask for levels below the threshold.
    fn support_at(&self, level: f64) -> Option<Ball> {
        if level < crate::THRESHOLD {
            return None;
        }
        self.support()
    }

    /// Returns the terms that matter in a ball, chosen among those of a part whose ball contains
    /// it, or of all. The sum of the terms that are left out is bounded by the slack, and so are
    /// its slope times the ball's radius and its curvature times the radius squared. A polynomial
    /// may stand for other terms, with an error of its own ([`Part::error`]). `None` if the
    /// function has no such terms, or hardly any can be left out.
    fn narrow(&self, _ball: Ball, _among: Option<&Part>, _slack: Slack) -> Option<Part> {
        None
    }

    /// Value and gradient of the terms of a part, at a point of its ball.
    fn jet_of(&self, _part: &Part, point: DVec3) -> Jet<f64> {
        self.jet(point)
    }

    /// Value and gradient of the terms of a part at eight points of its ball, in single precision.
    fn jet8_of(&self, _part: &Part, points: [f32x8; 3]) -> Jet<f32x8> {
        self.jet8(points)
    }

    /// Returns [`Implicit::clearance`] around a point of a part's ball, looking at the terms of the
    /// part alone. It holds within that ball.
    fn clearance_of(&self, _part: &Part, point: DVec3) -> Option<Clearance> {
        self.clearance(point)
    }

    /// Bounds on the whole function in a ball, which must be within that of the part, if there is
    /// one: then only the terms of the part are looked at.
    fn variation(&self, _part: Option<&Part>, ball: Ball) -> Variation {
        Variation::rough(self.enclose(ball))
    }

    /// Returns the least width of a kernel among the terms that matter in a ball, within that of
    /// the part if there is one: on shorter ways none of them changes much. Terms do not matter
    /// that are together smaller than `enough`; if none matters, the width is infinite. `None` if
    /// the terms that matter have no kernels, or finer details.
    fn least_width(&self, _part: Option<&Part>, _ball: Ball, _enough: f64) -> Option<f64> {
        None
    }

    /// The function's logarithm, where bounds on it are much sharper than those on the function
    /// itself; `None` if they are not, or not known.
    fn logarithm(&self) -> Option<crate::Logarithm<'_>> {
        None
    }

    /// Bounds on the function in a ball as [`Implicit::variation`] gives them, and value and
    /// gradient at its centre, where finding the bounds finds these, too.
    fn variation_with_jet(&self, part: Option<&Part>, ball: Ball) -> (Variation, Option<Jet<f64>>) {
        (self.variation(part, ball), None)
    }

    /// Returns the change of the gradient over a step along each axis from a ball's centre, of
    /// those terms whose third derivative [`Implicit::variation_with_jet`] bounds there; `None` if
    /// the function cannot tell them from others.
    fn turn_smoothly(&self, _part: Option<&Part>, _ball: Ball, _step: f64) -> Option<[DVec3; 3]> {
        None
    }
}

/// A function is told by no more than its kind: the numbers of each would take all programs that
/// draw one 80 kB, which print none.
impl core::fmt::Debug for dyn Implicit + '_ {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Implicit")
    }
}
