//! Fields that end at planes.
use crate::implicit::{Part, Variation};
use crate::{Ball, Enclosure, Evaluate, Implicit, Jet, Real, Sum, THRESHOLD};
use glam::DVec3;
use wide::f32x8;

/// A field F that is cut at planes: `min(F, max(0, T·(1 + s·d)))`, where d is the least of the
/// distances from the planes, positive on the side that is kept, and s a steepness. Where F is
/// above T its surface is the plane itself; beyond it there is no field farther than 1/s.
///
/// It is one element.
///
/// ```
/// use field::sliced::{Plane, Sliced};
/// use field::{BlobScale, Implicit, Kernel, Primitive, Shaping, Skeleton, THRESHOLD};
/// use glam::DVec3;
///
/// let shaping = Shaping {
///     kernel: Kernel::Compact6,
///     radius: 0.5,
///     blobbiness: 8.0,
///     blob_scale: BlobScale::Relative,
///     strength: 1.0,
///     influence: 1e-3,
///     taper: None,
/// };
/// let (base, apex) = (DVec3::ZERO, DVec3::X * 9.0);
/// let limb = Primitive::new(Skeleton::Segment { base, apex }, &shaping, None);
/// let plane = Plane { at: DVec3::X * 7.0, inward: DVec3::NEG_X };
/// let sliced = Sliced::new(limb.into_iter().collect(), vec![plane], 30.0).expect("usable");
/// assert!((sliced.jet(DVec3::new(7.0, 0.2, 0.0)).value - THRESHOLD).abs() < 1e-12);
/// assert_eq!(sliced.jet(DVec3::new(7.1, 0.0, 0.0)).value, 0.0);
/// ```
#[derive(Clone, Debug)]
pub struct Sliced {
    field: Sum,
    planes: Vec<Plane>,
    /// Steepness, an inverse length > 0.
    steepness: f64,
}

/// A plane with a side that is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Point of the plane.
    pub at: DVec3,
    /// Unit vector across it, to the side that is kept.
    pub inward: DVec3,
}

impl Sliced {
    /// Cuts a field at planes. `None` if there is no plane, or a number is not usable.
    #[must_use]
    pub fn new(field: Sum, planes: Vec<Plane>, steepness: f64) -> Option<Self> {
        let are_usable = planes.iter().all(|plane| {
            plane.at.is_finite() && (plane.inward.length_squared() - 1.0).abs() < 1e-6
        });
        let is_usable = steepness.is_normal() && steepness > 0.0;
        (are_usable && is_usable && !planes.is_empty()).then_some(Self {
            field,
            planes,
            steepness,
        })
    }

    /// Cuts the field at a place.
    fn cut<R: Real>(&self, own: Jet<R>, point: [R; 3]) -> Jet<R> {
        let zero = R::splat(0.0);
        self.planes.iter().fold(own, |jet, plane| {
            let across = (plane.inward * (THRESHOLD * self.steepness)).to_array();
            let [x, y, z]: [R; 3] = core::array::from_fn(|i| {
                R::splat(across[i]) * (point[i] - R::splat(plane.at.to_array()[i]))
            });
            let cap = x + y + z + R::splat(THRESHOLD);
            let is_beyond = cap.lt(zero);
            let is_cut = cap.max(zero).lt(jet.value);
            Jet {
                value: jet.value.min(cap.max(zero)),
                gradient: core::array::from_fn(|i| {
                    let slope = R::select(is_beyond, zero, R::splat(across[i]));
                    R::select(is_cut, slope, jet.gradient[i])
                }),
            }
        })
    }

    fn whole<R: Evaluate>(&self, point: [R; 3]) -> Jet<R> {
        self.cut(self.field.sum(point), point)
    }

    /// Returns the least and the largest value in a ball of what planes leave of a field.
    fn cap(&self, ball: Ball) -> [f64; 2] {
        let mut cap = [f64::INFINITY; 2];
        for plane in &self.planes {
            let distance = plane.inward.dot(ball.center - plane.at);
            for (cap, offset) in cap.iter_mut().zip([-ball.radius, ball.radius]) {
                let own = THRESHOLD * (1.0 + self.steepness * (distance + offset));
                // Up to rounding.
                let slack = offset.signum() * 1e-12 * (1.0 + own.abs());
                *cap = cap.min((own + slack).max(0.0));
            }
        }
        cap
    }
}

impl Implicit for Sliced {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        self.whole(point.to_array())
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        self.whole(point)
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        self.whole(points)
    }

    fn enclose(&self, ball: Ball) -> Enclosure {
        let [least, most] = self.cap(ball);
        // Beyond a plane a field that is nowhere negative is 0.
        let own = self.field.enclose(ball);
        if own.value[1] <= least {
            return own;
        }
        let slope = match most > 0.0 {
            true => THRESHOLD * self.steepness * (1.0 + 1e-12),
            false => 0.0,
        };
        if most <= own.value[0] {
            let is_plane = least > 0.0 && self.planes.len() == 1;
            return Enclosure {
                value: [least, most],
                slope,
                curvature: if is_plane || most <= 0.0 {
                    0.0
                } else {
                    f64::INFINITY
                },
            };
        }
        Enclosure {
            value: [own.value[0].min(least), own.value[1].min(most)],
            slope: own.slope.max(slope),
            curvature: f64::INFINITY,
        }
    }

    fn variation(&self, _part: Option<&Part>, ball: Ball) -> Variation {
        let own = self.field.variation(None, ball);
        if own.range.value[1] <= self.cap(ball)[0] {
            return own;
        }
        let range = self.enclose(ball);
        if range.curvature.is_finite() {
            return Variation::rough(range);
        }
        // Planes have no curvature, and the gradient is nowhere longer than the slope.
        Variation {
            curvature: own.curvature,
            third: 0.0,
            rough: own.curvature,
            jump: 2.0 * range.slope,
            step: own.step,
            range,
        }
    }

    fn least_width(&self, _part: Option<&Part>, ball: Ball, enough: f64) -> Option<f64> {
        (self.most(ball) < enough).then_some(f64::INFINITY)
    }

    fn most(&self, ball: Ball) -> f64 {
        self.field.most(ball).min(self.cap(ball)[1])
    }

    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>) {
        out.push((0, self.jet(point).value));
    }

    fn support(&self) -> Option<Ball> {
        self.field.support()
    }

    fn support_at(&self, level: f64) -> Option<Ball> {
        self.field.support_at(level)
    }
}
