//! Numbers in [0, 1)² for each pixel, sample and purpose: the first two dimensions of Sobol's
//! sequence, scrambled by hashes (Owen's scrambling: each digit is flipped or not by the digits
//! before it, so that the sequence stays as evenly spread; done on whole words as Laine and Karras
//! do). Only integer operations: the same on every machine.
//!
//! The first 2ᵏ samples of any pixel and purpose have one point in each of the 2ᵏ equal boxes of
//! every shape 2⁻ᵃ × 2⁻ᵇ with a + b = k. So a picture is complete after one sample, and each
//! further one fills the widest gap.

use crate::noise::scramble;

/// Purpose of a sample. Samples of different purposes are independent of each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The place in the pixel.
    Pixel,
    /// The place on the lens.
    Lens,
    /// The moment of the shutter (the first of the two numbers).
    Time,
    /// The place on the light of this number.
    Light(u16),
    /// Direction to the sky.
    Sky,
}

impl Purpose {
    fn seed(self) -> u32 {
        match self {
            Self::Pixel => 1,
            Self::Lens => 2,
            Self::Time => 3,
            Self::Sky => 4,
            Self::Light(number) => 16 + u32::from(number),
        }
    }
}

/// The sample of a number for a pixel: two numbers in [0, 1).
///
/// ```
/// use texture::sequence::{Purpose, sample};
/// let halves: Vec<_> = (0..2).map(|i| sample([3, 4], i, Purpose::Lens)[0] < 0.5).collect();
/// assert_ne!(halves[0], halves[1]); // one of the first two in each half
/// ```
#[must_use]
pub fn sample(pixel: [u32; 2], number: u32, purpose: Purpose) -> [f64; 2] {
    let seed = scramble(pixel[0] ^ scramble(pixel[1] ^ scramble(purpose.seed())));
    // The order of the samples is scrambled as well, else those of two purposes would keep step.
    // Numbers that begin with the same bits stay neighbours, so the first 2ᵏ samples become another
    // such run, which is as evenly spread.
    let index = owen(number, scramble(seed ^ 0x3c6e_f372));
    [
        owen(index.reverse_bits(), scramble(seed ^ 0x1f83_d9ab)),
        owen(second(index), scramble(seed ^ 0x5be0_cd19)),
    ]
    .map(|bits| f64::from(bits) / 4_294_967_296.0)
}

/// Sobol's second dimension: directions by the polynomial x + 1, which makes Pascal's triangle
/// modulo 2.
fn second(mut index: u32) -> u32 {
    let (mut direction, mut sum) = (1_u32 << 31, 0);
    while index != 0 {
        if index & 1 == 1 {
            sum ^= direction;
        }
        index >>= 1;
        direction ^= direction >> 1;
    }
    sum
}

/// Flips each bit by a hash of the bits above it.
fn owen(bits: u32, seed: u32) -> u32 {
    // Reversed, the bits above are those below, and a bit of x times an even number depends on
    // lower bits of x only.
    let mut x = bits.reverse_bits();
    x = x.wrapping_add(seed);
    x ^= x.wrapping_mul(0x6c50_b47c);
    x ^= x.wrapping_mul(0xb82f_1e52);
    x ^= x.wrapping_mul(0xc7af_e638);
    x ^= x.wrapping_mul(0x8d22_f6e6);
    x.reverse_bits()
}
