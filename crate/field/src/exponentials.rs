//! Metaballs that fall exponentially with the distance from their surface.
use crate::{Ball, Enclosure, Implicit, Jet, Real};
use glam::DVec3;
use wide::f32x8;

/// The function `F(p) = Σ exp(−k(|p − cᵢ| − ρᵢ))` of some balls with centres cᵢ and radii ρᵢ, one
/// element.
///
/// Alone, a ball is its own surface. The gradient jumps at the centres.
///
/// ```
/// use field::{Exponentials, Implicit, THRESHOLD};
/// use glam::DVec3;
///
/// let ball = Exponentials::new(8.0, vec![(DVec3::ZERO, 0.5)]).expect("the numbers are usable");
/// assert!((ball.jet(DVec3::new(0.3, 0.0, 0.4)).value - THRESHOLD).abs() < 1e-12);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Exponentials {
    /// Rate k > 0 at which the function falls with the distance; an inverse length.
    hardness: f64,
    balls: Vec<(DVec3, f64)>,
}

/// The largest product of hardness and radius, so that values fit single precision.
const LARGEST: f64 = 60.0;

impl Exponentials {
    /// The function of balls given by centres and radii ≥ 0. `None` if there is none, if a number
    /// is not finite, the hardness not positive, or a radius times the hardness above 60.
    #[must_use]
    pub fn new(hardness: f64, balls: Vec<(DVec3, f64)>) -> Option<Self> {
        let usable = hardness.is_normal()
            && hardness > 0.0
            && balls.iter().all(|&(center, radius)| {
                center.is_finite() && radius >= 0.0 && hardness * radius <= LARGEST
            });
        (usable && !balls.is_empty()).then_some(Self { hardness, balls })
    }

    /// Value and gradient in any precision.
    fn sum<R: Real>(&self, point: [R; 3]) -> Jet<R> {
        let k = R::splat(self.hardness);
        self.balls
            .iter()
            .fold(Jet::zero(), |sum, (center, radius)| {
                let offset: [R; 3] = core::array::from_fn(|i| point[i] - R::splat(center[i]));
                let [x, y, z] = offset;
                let distance = (x * x + y * y + z * z).sqrt();
                let value = (k * (distance - R::splat(*radius))).decay();
                // 0 at the centre.
                let slope = -(k * value) / distance.max(R::splat(1e-30));
                sum.plus(Jet {
                    value,
                    gradient: offset.map(|x| slope * x),
                })
            })
    }
}

impl Implicit for Exponentials {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        self.sum(point.to_array())
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        self.sum(point)
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        self.sum(points)
    }

    fn enclose(&self, ball: Ball) -> Enclosure {
        let k = self.hardness;
        let mut all = Enclosure::ZERO;
        for (center, radius) in &self.balls {
            let distance = center.distance(ball.center);
            let nearest = (distance - ball.radius).max(0.0);
            let value = |distance: f64| libm::exp(-k * (distance - radius));
            let most = value(nearest) * (1.0 + 1e-12);
            all = all.plus(Enclosure {
                value: [value(distance + ball.radius) * (1.0 - 1e-12), most],
                slope: k * most,
                // Along the ray from the centre k², across it −k/d.
                curvature: k * most * k.max(1.0 / nearest),
            });
        }
        all.about(&self.jet(ball.center), ball.radius)
    }

    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>) {
        out.push((0, self.jet(point).value));
    }

    fn support(&self) -> Option<Ball> {
        self.support_at(crate::THRESHOLD)
    }

    fn support_at(&self, level: f64) -> Option<Ball> {
        // The distance from a ball at which it has its share of the level.
        let count = self.balls.len() as f64;
        let beyond = libm::log(count / level).max(0.0) / self.hardness;
        let balls = self.balls.iter().map(|&(center, radius)| Ball {
            center,
            radius: radius + beyond,
        });
        balls.reduce(|all, ball| all.around(&ball))
    }
}
