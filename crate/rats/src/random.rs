//! Random numbers that are the same on every machine.
//!
//! Both kinds use the finaliser of SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom
//! number generators", 2014): a counter stepped by the golden ratio and stirred by two
//! multiplications.

/// 2⁶⁴ divided by the golden ratio, made odd.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// Stream behind `rand`, started by `seed N`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Random {
    state: u64,
}

impl Random {
    /// Begins the stream of a seed.
    #[must_use]
    pub fn new(seed: f64) -> Self {
        Self {
            state: stir(bits(seed)),
        }
    }

    /// Returns the next number, evenly spread in [0, 1).
    pub fn draw(&mut self) -> f64 {
        self.state = self.state.wrapping_add(STEP);
        unit(stir(self.state))
    }
}

/// Computes `rand(a, b, …)`: a number in [0, 1) that depends on its arguments alone.
#[must_use]
pub fn hash(arguments: &[f64]) -> f64 {
    let state = arguments.iter().fold(STEP, |state, &argument| {
        stir(state.wrapping_add(STEP) ^ stir(bits(argument)))
    });
    unit(state)
}

/// Computes `noise(x, y, z)`: smooth noise in [−1, 1], 0 at whole numbers, the same on every
/// machine.
///
/// Gradient noise (Perlin, "Improving noise", 2002): at each corner of the unit cube around the
/// point stands a random gradient of three numbers in [−1, 1]; the linear functions that they give
/// are blended with the curve 6t⁵ − 15t⁴ + 10t³.
#[must_use]
pub fn noise(point: [f64; 3]) -> f64 {
    let cell = point.map(f64::floor);
    let inner = [0, 1, 2].map(|i| point[i] - cell[i]);
    let fade = inner.map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
    let mut sum = 0.0;
    for corner in 0..8_u32 {
        let bit = [0, 1, 2].map(|i| f64::from((corner >> i) & 1));
        let mut weight = 1.0;
        let mut slope = 0.0;
        for i in 0..3 {
            weight *= if bit[i] > 0.5 { fade[i] } else { 1.0 - fade[i] };
            let place = [
                cell[0] + bit[0],
                cell[1] + bit[1],
                cell[2] + bit[2],
                i as f64,
            ];
            slope += (2.0 * hash(&place) - 1.0) * (inner[i] - bit[i]);
        }
        sum += weight * slope;
    }
    sum.clamp(-1.0, 1.0)
}

fn stir(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Returns the bits of a number; 0 and −0 count as equal.
fn bits(value: f64) -> u64 {
    (value + 0.0).to_bits()
}

/// Returns the upper 53 bits as a number in [0, 1).
fn unit(z: u64) -> f64 {
    (z >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Datasets in links depend on these numbers: they may never change.
    #[test]
    fn frozen() {
        let mut stream = Random::new(7.0);
        let first = [stream.draw(), stream.draw(), stream.draw()];
        let mut again = Random::new(7.0);
        assert_eq!(first, [again.draw(), again.draw(), again.draw()]);
        assert_eq!(hash(&[0.0]).to_bits(), hash(&[-0.0]).to_bits());
        assert_ne!(hash(&[1.0, 2.0]).to_bits(), hash(&[2.0, 1.0]).to_bits());
    }

    #[test]
    fn noise_is_smooth_and_small() {
        let mut largest: f64 = 0.0;
        for i in 0..20_000 {
            let t = f64::from(i) * 0.0137 - 100.0;
            largest = largest.max(noise_at(t).abs());
            assert!((noise_at(t + 1e-6) - noise_at(t)).abs() < 1e-5, "{t}");
        }
        assert!((0.5..=1.0).contains(&largest), "{largest}");
        assert_eq!(noise([3.0, -4.0, 5.0]), 0.0);
        // Frozen, as datasets depend on it.
        assert_eq!(noise([0.5, 0.25, 0.125]).to_bits(), FROZEN_NOISE);
    }

    /// Computes the noise of a place on a line.
    fn noise_at(x: f64) -> f64 {
        noise([x, 0.7 * x, 0.3 - x])
    }

    const FROZEN_NOISE: u64 = 4_600_422_258_245_349_749;

    #[test]
    fn evenly_spread() {
        let mut stream = Random::new(1.0);
        let mut boxes = [0; 10];
        for _ in 0..10_000 {
            boxes[(stream.draw() * 10.0) as usize] += 1;
        }
        assert!(boxes.iter().all(|n| (850..1150).contains(n)), "{boxes:?}");
        let mean = (0..10_000).map(|i| hash(&[f64::from(i)])).sum::<f64>() / 10_000.0;
        assert!((mean - 0.5).abs() < 0.02, "{mean}");
    }
}
