//! Combines two pictures of the same size, byte by byte.
//!
//! Red, green and blue are combined; the result is opaque, since the bits of an opacity say nothing
//! about how two pictures differ. What shows through in a picture is combined as it is stored.

use crate::{Picture, Problem};

/// The absolute difference: black where the pictures are equal.
///
/// # Errors
/// If the sizes differ.
pub fn diff(a: &Picture, b: &Picture) -> Result<Picture, Problem> {
    combine(a, b, u8::abs_diff)
}

/// The bits that both have.
///
/// # Errors
/// If the sizes differ.
pub fn and(a: &Picture, b: &Picture) -> Result<Picture, Problem> {
    combine(a, b, |a, b| a & b)
}

/// The bits that one of the two has.
///
/// # Errors
/// If the sizes differ.
pub fn xor(a: &Picture, b: &Picture) -> Result<Picture, Problem> {
    combine(a, b, |a, b| a ^ b)
}

/// The part of a combined picture that is not black.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Remains {
    /// Pixels that are not black.
    pub pixels: u64,
    /// The largest red, green or blue.
    pub largest: u8,
}

/// Counts what remains, e.g. after [`diff`].
#[must_use]
pub fn remains(picture: &Picture) -> Remains {
    let mut remains = Remains {
        pixels: 0,
        largest: 0,
    };
    for pixel in picture.pixels().chunks_exact(4) {
        let largest = pixel[0].max(pixel[1]).max(pixel[2]);
        remains.pixels += u64::from(largest > 0);
        remains.largest = remains.largest.max(largest);
    }
    remains
}

fn combine(a: &Picture, b: &Picture, join: fn(u8, u8) -> u8) -> Result<Picture, Problem> {
    if a.size() != b.size() {
        return Err(Problem::DifferentSizes(a.size(), b.size()));
    }
    let pixels = a
        .pixels()
        .chunks_exact(4)
        .zip(b.pixels().chunks_exact(4))
        .flat_map(|(a, b)| [join(a[0], b[0]), join(a[1], b[1]), join(a[2], b[2]), 255])
        .collect();
    Picture::new(a.width(), a.height(), pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(colour: [u8; 4]) -> Picture {
        Picture::filled(1, 1, colour).expect("a picture")
    }

    #[test]
    fn byte_by_byte() {
        let a = one([200, 12, 0b1100, 255]);
        let b = one([250, 10, 0b1010, 0]);
        assert_eq!(diff(&a, &b), Ok(one([50, 2, 2, 255])));
        assert_eq!(and(&a, &b), Ok(one([200, 8, 0b1000, 255])));
        assert_eq!(xor(&a, &b), Ok(one([50, 6, 0b0110, 255])));
        assert_eq!(
            remains(&one([0, 7, 3, 255])),
            Remains {
                pixels: 1,
                largest: 7
            }
        );
        assert_eq!(remains(&diff(&a, &a).expect("equal sizes")).pixels, 0);
    }

    #[test]
    fn sizes_must_agree() {
        let a = Picture::filled(2, 3, [0; 4]).expect("a picture");
        let b = Picture::filled(3, 2, [0; 4]).expect("a picture");
        for combine in [diff, and, xor] {
            let problem = combine(&a, &b).expect_err("different sizes");
            let said = problem.to_string();
            assert!(said.contains("2×3") && said.contains("3×2"), "{said}");
        }
    }
}
