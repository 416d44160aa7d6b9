//! Random numbers that are the same on every machine.
//!
//! Both kinds use the finaliser of SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom
//! number generators", 2014): a counter stepped by the golden ratio and stirred by two multiplications.

/// 2⁶⁴ divided by the golden ratio, made odd.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// The stream behind `rand`, started by `seed N`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Random {
    state: u64,
}

impl Random {
    /// The stream of a seed.
    #[must_use]
    pub fn new(seed: f64) -> Self {
        Self {
            state: stir(bits(seed)),
        }
    }

    /// The next number, evenly spread in [0, 1).
    pub fn draw(&mut self) -> f64 {
        self.state = self.state.wrapping_add(STEP);
        unit(stir(self.state))
    }
}

/// `rand(a, b, …)`: a number in [0, 1) that depends on its arguments alone.
#[must_use]
pub fn hash(arguments: &[f64]) -> f64 {
    let state = arguments.iter().fold(STEP, |state, &argument| {
        stir(state.wrapping_add(STEP) ^ stir(bits(argument)))
    });
    unit(state)
}

fn stir(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The bits of a number; 0 and −0 count as equal.
fn bits(value: f64) -> u64 {
    (value + 0.0).to_bits()
}

/// The upper 53 bits as a number in [0, 1).
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
