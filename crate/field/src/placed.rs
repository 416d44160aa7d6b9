//! Functions moved, turned and stretched.
use crate::{Ball, Clearance, Enclosure, Implicit, Jet, Part, Real, Slack, Variation};
use glam::{DAffine3, DMat3, DVec3};
use std::sync::Arc;
use wide::f32x8;

/// A function in coordinates of its own: at p its value is the inner function's at M⁻¹p.
#[derive(Clone, Debug)]
pub struct Placed {
    function: Arc<dyn Implicit>,
    to_world: DAffine3,
    to_own: DAffine3,
    /// Bounds on how far the two maps stretch lengths.
    growth: f64,
    shrinkage: f64,
}

impl Placed {
    /// The function placed by a map from its own coordinates to the world's. `None` if the map has
    /// no finite inverse.
    #[must_use]
    pub fn new(function: Arc<dyn Implicit>, to_world: DAffine3) -> Option<Self> {
        let to_own = to_world.inverse();
        let (growth, shrinkage) = (stretch(&to_world.matrix3), stretch(&to_own.matrix3));
        let usable = to_world.is_finite()
            && to_own.is_finite()
            && growth.is_normal()
            && shrinkage.is_normal();
        usable.then_some(Self {
            function,
            to_world,
            to_own,
            growth,
            shrinkage,
        })
    }

    fn own<R: Real>(&self, point: [R; 3]) -> [R; 3] {
        let DAffine3 {
            matrix3,
            translation,
        } = self.to_own;
        let [x, y, z] = matrix3.to_cols_array_2d();
        core::array::from_fn(|i| {
            R::splat(x[i]) * point[0]
                + R::splat(y[i]) * point[1]
                + R::splat(z[i]) * point[2]
                + R::splat(translation[i])
        })
    }

    fn world<R: Real>(&self, jet: Jet<R>) -> Jet<R> {
        let columns = self.to_own.matrix3.to_cols_array_2d();
        let [x, y, z] = jet.gradient;
        Jet {
            value: jet.value,
            gradient: columns.map(|c| R::splat(c[0]) * x + R::splat(c[1]) * y + R::splat(c[2]) * z),
        }
    }
}

impl Placed {
    /// Returns a ball, in the function's own coordinates, that holds a ball of the world.
    fn own_ball(&self, ball: Ball) -> Ball {
        Ball {
            center: self.to_own.transform_point3(ball.center),
            radius: ball.radius * self.shrinkage,
        }
    }

    /// Bounds in the world of those in the function's own coordinates.
    fn shrink(&self, own: Variation) -> Variation {
        let k = self.shrinkage;
        Variation {
            range: shrink(own.range, k),
            curvature: own.curvature * k * k,
            third: own.third * k * k * k,
            rough: own.rough * k * k,
            jump: own.jump * k,
            step: own.step,
        }
    }

    /// Clearance in the world of that in the function's own coordinates.
    fn grow(&self, own: Clearance) -> Clearance {
        Clearance {
            radius: own.radius / self.shrinkage,
            scale: own.scale / self.shrinkage,
        }
    }
}

/// Returns an upper bound on how much a map stretches lengths, which is exact for a similarity: by
/// Gershgorin's theorem, the root of the greatest sum of a row of |MᵀM|.
fn stretch(map: &DMat3) -> f64 {
    let square = map.transpose() * *map;
    let [a, b, c] = [0, 1, 2].map(|i| square.row(i).abs().element_sum());
    libm::sqrt(a.max(b).max(c)) * (1.0 + 1e-12)
}

/// Returns the bounds on a function after its space has been shrunk by a factor of 1/k.
fn shrink(own: Enclosure, k: f64) -> Enclosure {
    Enclosure {
        value: own.value,
        slope: own.slope * k,
        curvature: own.curvature * k * k,
    }
}

impl Implicit for Placed {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        let own = self.own(point.to_array());
        self.world(self.function.jet(DVec3::from_array(own)))
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        self.world(self.function.jet32(self.own(point)))
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        self.world(self.function.jet8(self.own(points)))
    }

    fn enclose(&self, ball: Ball) -> Enclosure {
        let own = self.function.enclose(self.own_ball(ball));
        shrink(own, self.shrinkage)
    }

    /// The part is one of the inner function, but for its ball.
    fn narrow(&self, ball: Ball, among: Option<&Part>, slack: Slack) -> Option<Part> {
        let own = self.function.narrow(self.own_ball(ball), among, slack)?;
        Some(Part { ball, ..own })
    }

    fn jet_of(&self, part: &Part, point: DVec3) -> Jet<f64> {
        let own = self.own(point.to_array());
        self.world(self.function.jet_of(part, DVec3::from_array(own)))
    }

    fn jet8_of(&self, part: &Part, points: [f32x8; 3]) -> Jet<f32x8> {
        self.world(self.function.jet8_of(part, self.own(points)))
    }

    fn variation(&self, part: Option<&Part>, ball: Ball) -> Variation {
        self.shrink(self.function.variation(part, self.own_ball(ball)))
    }

    fn variation_with_jet(&self, part: Option<&Part>, ball: Ball) -> (Variation, Option<Jet<f64>>) {
        let (own, jet) = self.function.variation_with_jet(part, self.own_ball(ball));
        (self.shrink(own), jet.map(|jet| self.world(jet)))
    }

    fn clearance(&self, point: DVec3) -> Option<Clearance> {
        let own = self.to_own.transform_point3(point);
        Some(self.grow(self.function.clearance(own)?))
    }

    fn clearance_of(&self, part: &Part, point: DVec3) -> Option<Clearance> {
        let own = self.to_own.transform_point3(point);
        Some(self.grow(self.function.clearance_of(part, own)?))
    }

    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>) {
        self.function
            .shares(self.to_own.transform_point3(point), out);
    }

    fn support(&self) -> Option<Ball> {
        self.support_at(crate::THRESHOLD)
    }

    fn support_at(&self, level: f64) -> Option<Ball> {
        let Ball { center, radius } = self.function.support_at(level)?;
        Some(Ball {
            center: self.to_world.transform_point3(center),
            radius: radius * self.growth,
        })
    }
}
