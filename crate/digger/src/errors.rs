//! Errors of the scene's digger: for each pixel, along the ray through its middle, the distance
//! between the first hit that the digger finds and the first crossing of the field itself, found in
//! double precision.
//!
//! Four bytes stand for a pixel, as in a picture, so that such tiles travel as others do: a
//! single-precision number, the smallest byte first.

use scene::{Projection, Scene};
use tracer::{Picture, Tile};

/// Number of pixels of a row whose rays are followed together.
const TOGETHER: u32 = 8;

/// Result of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pixel {
    /// Misses of both.
    Empty,
    /// Hits of both, at this distance along the ray from each other.
    Off(f32),
    /// A hit of the digger or the field alone.
    Alone,
}

impl Pixel {
    /// Encodes the pixel: −1 for no hit, the distance, or infinity for a single hit.
    fn pack(self) -> [u8; 4] {
        let number = match self {
            Self::Empty => -1.0,
            Self::Off(distance) => distance,
            Self::Alone => f32::INFINITY,
        };
        number.to_le_bytes()
    }

    /// Decodes a pixel.
    fn unpack(bytes: [u8; 4]) -> Self {
        match f32::from_le_bytes(bytes) {
            f32::INFINITY => Self::Alone,
            distance if distance >= 0.0 => Self::Off(distance),
            _ => Self::Empty,
        }
    }
}

/// Decodes the pixels of a tile, or of a whole picture.
#[must_use]
pub fn unpack(bytes: &[u8]) -> Vec<Pixel> {
    let (pixels, _) = bytes.as_chunks();
    pixels.iter().copied().map(Pixel::unpack).collect()
}

/// Scene prepared for the comparison.
pub struct Errors {
    /// Picture by the digger.
    found: Picture,
    /// Picture by the tracer's own way.
    exact: Picture,
    projection: Projection,
    size: [u32; 2],
}

impl Errors {
    /// Prepares a scene. `size` is the picture's width and height in pixels, each > 0.
    #[must_use]
    pub fn new(scene: &Scene, size: [u32; 2]) -> Self {
        Self {
            found: crate::picture(scene, size),
            exact: Picture::new(scene, size),
            projection: scene.camera.projection(size[0], size[1]),
            size,
        }
    }

    /// Compares one tile; returns the encoded pixels, rows from the top. `None` soon after `stop`,
    /// which is called now and then, has returned true.
    #[must_use]
    pub fn trace(&self, tile: Tile, stop: &dyn Fn() -> bool) -> Option<Vec<u8>> {
        let mut bytes = Vec::new();
        for y in tile.y..tile.y + tile.height {
            let end = tile.x + tile.width;
            // The sides of tiles are multiples of the rays that are followed together, so that a
            // pixel does not depend on its tile.
            for left in (tile.x..end).step_by(TOGETHER as usize) {
                let mut rays = Vec::new();
                for x in left..end.min(left + TOGETHER) {
                    let [x, y] = [[x, self.size[0]], [y, self.size[1]]]
                        .map(|[at, of]| (f64::from(at) + 0.5) / f64::from(of));
                    rays.push((self.projection.eye, self.projection.direction(x, y)));
                }
                for (hit, &(eye, way)) in self.found.cast(&rays).iter().zip(&rays) {
                    let pixel = match (hit, self.exact.hits(eye, way).first()) {
                        (None, None) => Pixel::Empty,
                        (Some(hit), Some(exact)) => Pixel::Off((hit.t - exact.t).abs() as f32),
                        _ => Pixel::Alone,
                    };
                    bytes.extend(pixel.pack());
                }
            }
            if stop() {
                return None;
            }
        }
        Some(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_survive_packing() {
        let pixels = [
            Pixel::Empty,
            Pixel::Off(0.0),
            Pixel::Off(0.25),
            Pixel::Alone,
        ];
        assert_eq!(unpack(&pixels.map(Pixel::pack).concat()), pixels);
    }

    #[test]
    fn a_tile_has_a_pixel_for_each_of_its_own_and_can_be_given_up() {
        let errors = Errors::new(&Scene::default(), [20, 12]);
        let tile = Tile {
            x: 3,
            y: 5,
            width: 13,
            height: 4,
        };
        let bytes = errors.trace(tile, &|| false).unwrap();
        assert_eq!(unpack(&bytes), [Pixel::Empty; 13 * 4]);
        assert_eq!(errors.trace(tile, &|| true), None);
    }
}
