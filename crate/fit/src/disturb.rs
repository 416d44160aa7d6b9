//! Seeded disturbances of measured points: what scanners do to them.

use glam::DVec3;
use mesh::Aabb;

/// Random numbers that are the same on every machine (SplitMix64).
#[derive(Clone, Debug)]
pub struct Numbers(u64);

impl Numbers {
    /// Starts from a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Returns a number from 0 to 1, without 1.
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns a normally distributed number of mean 0 and variance 1 (Box and Muller).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.uniform())).sqrt();
        radius * libm::cos(core::f64::consts::TAU * self.uniform())
    }

    /// Returns a unit vector, all directions alike.
    pub fn direction(&mut self) -> DVec3 {
        let vector = DVec3::new(self.normal(), self.normal(), self.normal());
        vector.try_normalize().unwrap_or(DVec3::Z)
    }

    /// Returns a point of a box.
    pub fn within(&mut self, bounds: &Aabb) -> DVec3 {
        let share = DVec3::new(self.uniform(), self.uniform(), self.uniform());
        bounds.min + bounds.size() * share
    }
}

/// Disturbance of measurements.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Disturbance {
    /// Standard deviation of each coordinate.
    pub noise: f64,
    /// Unevenness of the noise, 0 … 1: it grows along x from
    /// `(1 − uneven)·noise` to `(1 + uneven)·noise`.
    pub uneven: f64,
    /// Share of the points, 0 … 1, that become outliers: anywhere in a box of twice the size.
    pub outliers: f64,
    /// Share of the points, 0 … 1, that is missing: those furthest in one direction.
    pub gap: f64,
    /// The seed of all that is random.
    pub seed: u64,
}

impl Disturbance {
    /// The direction in which points are missing.
    #[must_use]
    pub fn toward(&self) -> DVec3 {
        Numbers::new(self.seed ^ 0x6170).direction()
    }

    /// Returns points with a gap, noise and outliers, in this order.
    #[must_use]
    pub fn apply(&self, points: &[DVec3]) -> Vec<DVec3> {
        let toward = self.toward();
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_by(|a, b| {
            let [a, b] = [a, b].map(|i| points[*i].dot(toward));
            a.total_cmp(&b)
        });
        let kept = points.len() as f64 * (1.0 - self.gap.clamp(0.0, 1.0));
        order.truncate(kept.round() as usize);
        order.sort_unstable();
        let tight = Aabb::of_points(points.iter().copied());
        let wide = Aabb {
            min: tight.min - 0.5 * tight.size(),
            max: tight.max + 0.5 * tight.size(),
        };
        let mut numbers = Numbers::new(self.seed);
        let disturbed = order.into_iter().map(|i| {
            let is_outlier = numbers.uniform() < self.outliers;
            let shift = DVec3::new(numbers.normal(), numbers.normal(), numbers.normal());
            if is_outlier {
                numbers.within(&wide)
            } else {
                let along = (points[i].x - tight.min.x) / tight.size().x.max(f64::MIN_POSITIVE);
                points[i] + shift * self.noise * (1.0 + self.uneven * (2.0 * along - 1.0))
            }
        });
        disturbed.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn disturbances_are_as_asked() {
        let mut numbers = Numbers::new(3);
        let points: Vec<DVec3> = (0..4000).map(|_| numbers.direction()).collect();
        let disturbance = Disturbance {
            noise: 0.01,
            outliers: 0.1,
            gap: 0.25,
            seed: 5,
            ..Disturbance::default()
        };
        let disturbed = disturbance.apply(&points);
        assert_eq!(disturbed.len(), 3000);
        assert_eq!(disturbed, disturbance.apply(&points));
        let (outliers, inliers): (Vec<DVec3>, Vec<DVec3>) = disturbed
            .iter()
            .partition(|p| (p.length() - 1.0).abs() > 0.05);
        assert!((240..330).contains(&outliers.len()), "{}", outliers.len());
        let radial: Vec<f64> = inliers.iter().map(|p| p.length() - 1.0).collect();
        let variance = radial.iter().map(|r| r * r).sum::<f64>() / radial.len() as f64;
        assert!((variance.sqrt() - 0.01).abs() < 0.001);
        let toward = disturbance.toward();
        let in_gap = inliers.iter().filter(|p| p.dot(toward) > 0.55);
        assert!(in_gap.count() < 5);
        let uneven = Disturbance {
            noise: 0.01,
            uneven: 0.8,
            ..Disturbance::default()
        };
        let mut squares = [0.0; 2];
        for (moved, point) in uneven.apply(&points).iter().zip(&points) {
            squares[usize::from(point.x > 0.0)] += moved.distance_squared(*point);
        }
        assert!(squares[1] > 4.0 * squares[0], "{squares:?}");
        let same = Disturbance {
            seed: 5,
            ..Disturbance::default()
        };
        assert_eq!(same.apply(&points), points);
    }
}
