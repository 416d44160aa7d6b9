//! A circular arc in the plane z = 0, through the origin or with its gap around it.
//!
//! The origin is the arc's middle if the arc is at most a half circle (side 1), else the middle of
//! its gap (side −1), and the x axis points outward: the circle's centre is at (−radius, 0, 0). So
//! short arcs of huge circles keep their digits.

/// An arc through, or with its gap around, the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc<S> {
    /// Radius of the circle.
    pub radius: S,
    /// 1 if the origin is the arc's middle, −1 if it is the gap's.
    pub side: S,
    /// Sine of half the angle.
    pub sine: S,
    /// Sine of the angle.
    pub double_sine: S,
    /// `1 − σ cos α`, in [0, 1].
    pub versine: S,
    /// Half the angle.
    pub half_angle: S,
    /// The ends' angle from the x axis, in [0, π/2]: half the arc's angle, or half the gap's.
    pub end_angle: S,
}

impl Arc<f64> {
    /// Prepares an arc from its radius and its angle in [0, 2π].
    pub(crate) fn new(radius: f64, angle: f64) -> Self {
        let half_angle = angle / 2.0;
        let (sine, cosine) = libm::sincos(half_angle);
        let (quarter_sine, quarter_cosine) = libm::sincos(half_angle / 2.0);
        let inner = cosine >= 0.0;
        let root = if inner { quarter_sine } else { quarter_cosine };
        Self {
            radius,
            side: if inner { 1.0 } else { -1.0 },
            sine: sine.max(0.0),
            double_sine: 2.0 * sine * cosine,
            versine: 2.0 * root * root,
            half_angle,
            end_angle: if angle < core::f64::consts::TAU {
                2.0 * libm::asin(root.min(1.0))
            } else {
                0.0
            },
        }
    }
}

impl<S: Copy> Arc<S> {
    pub(crate) fn cast<Q>(&self, f: impl Fn(S) -> Q) -> Arc<Q> {
        Arc {
            radius: f(self.radius),
            side: f(self.side),
            sine: f(self.sine),
            double_sine: f(self.double_sine),
            versine: f(self.versine),
            half_angle: f(self.half_angle),
            end_angle: f(self.end_angle),
        }
    }
}
