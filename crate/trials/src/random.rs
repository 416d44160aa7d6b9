//! Random numbers and vectors.

use crate::{STEP, mix, scramble, seed};
use core::f64::consts::PI;
use glam::{DQuat, DVec3};

/// A generator of numbers that are the same on every platform, mostly SplitMix64.
#[derive(Clone, Debug)]
pub struct Random(u64, Step);

/// The step from one state of a generator to the next.
#[derive(Clone, Copy, Debug)]
enum Step {
    SplitMix,
    Linear,
}

impl Random {
    /// Returns a generator for a seed; `SINEW_SEED` asks for another one of the same seed.
    pub fn new(start: u64) -> Self {
        match seed() {
            0 => Self(start, Step::SplitMix),
            other => Self(mix(start ^ mix(other)), Step::SplitMix),
        }
    }

    /// Returns a generator for a seed whose numbers never change, for outputs that are compared
    /// with kept ones.
    pub fn fixed(seed: u64) -> Self {
        Self(seed, Step::SplitMix)
    }

    /// Returns a linear congruential generator: scenes of earlier faults were found with its
    /// numbers.
    pub fn linear(start: u64) -> Self {
        Self(start, Step::Linear)
    }

    /// Returns 64 random bits.
    pub fn bits(&mut self) -> u64 {
        match self.1 {
            Step::SplitMix => {
                self.0 = self.0.wrapping_add(STEP);
                scramble(self.0)
            }
            Step::Linear => {
                let times = self.0.wrapping_mul(6_364_136_223_846_793_005);
                self.0 = times.wrapping_add(1_442_695_040_888_963_407);
                self.0
            }
        }
    }

    /// Returns a number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns a number in [low, high).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Returns 10 to a power in [low, high).
    pub fn decades(&mut self, low: f64, high: f64) -> f64 {
        libm::exp10(self.range(low, high))
    }

    /// Returns a whole number below `end`, which is > 0.
    pub fn below(&mut self, end: usize) -> usize {
        (self.unit() * end as f64) as usize
    }

    /// Returns `true` with a probability in [0, 1].
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// Returns one of some values.
    ///
    /// # Panics
    /// If there are none.
    pub fn pick<T: Clone>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())].clone()
    }

    /// Returns a vector with each coordinate in [-size, size).
    pub fn vector(&mut self, size: f64) -> DVec3 {
        DVec3::from_array(core::array::from_fn(|_| self.range(-size, size)))
    }

    /// Returns a vector of length 1, each direction as likely as any other.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.vector(1.0);
            if (0.1..1.0).contains(&v.length()) {
                return v.normalize();
            }
        }
    }

    /// Returns three orthonormal vectors, right-handed.
    pub fn axes(&mut self) -> [DVec3; 3] {
        let x = self.direction();
        let y = loop {
            if let Some(y) = x.cross(self.direction()).try_normalize() {
                break y;
            }
        };
        [x, y, x.cross(y)]
    }

    /// Returns a rotation by up to half a turn about any axis.
    pub fn rotation(&mut self) -> DQuat {
        let (sine, cosine) = libm::sincos(0.5 * self.range(-PI, PI));
        let axis = self.direction() * sine;
        DQuat::from_xyzw(axis.x, axis.y, axis.z, cosine)
    }

    /// Returns a point of a triangle, each as likely as any other.
    pub fn in_triangle(&mut self, [a, b, c]: [DVec3; 3]) -> DVec3 {
        let (mut u, mut v) = (self.unit(), self.unit());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        a + (b - a) * u + (c - a) * v
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_splitmix64s() {
        // Published values for the seed 1234567.
        let mut random = Random(1_234_567, Step::SplitMix);
        let first: [u64; 3] = core::array::from_fn(|_| random.bits());
        let known = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
        ];
        assert_eq!(first, known);
    }

    #[test]
    fn numbers_and_vectors_are_where_they_should_be() {
        let mut random = Random::new(3);
        for _ in 0..crate::count(1000) {
            assert!((0.0..1.0).contains(&random.unit()));
            assert!((2.0..5.0).contains(&random.range(2.0, 5.0)));
            assert!((0.01..100.0).contains(&random.decades(-2.0, 2.0)));
            assert!(random.below(7) < 7);
            assert!(random.vector(2.0).abs().max_element() <= 2.0);
            assert!((random.direction().length() - 1.0).abs() < 1e-12);
            let [x, y, z] = random.axes();
            assert!((x.cross(y) - z).length() < 1e-12 && x.dot(y).abs() < 1e-12);
            let turned = random.rotation() * DVec3::X;
            assert!((turned.length() - 1.0).abs() < 1e-12);
            let inside = random.in_triangle([DVec3::ZERO, DVec3::X, DVec3::Y]);
            assert!(inside.min_element() >= 0.0 && inside.element_sum() <= 1.0);
        }
        assert!([1, 2].contains(&random.pick(&[1, 2])) && !random.chance(0.0));
    }
}
