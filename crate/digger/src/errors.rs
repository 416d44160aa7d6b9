//! Errors of the scene's digger: for each pixel, along the ray through its middle, the
//! distance between the first hit that the digger finds and the first crossing of the field itself,
//! found in double precision.
//!
//! Four bytes stand for a pixel, as in a picture, so that such tiles travel as others do: a
//! single-precision number, the smallest byte first.

use scene::{Projection, Scene};
use tracer::{Picture, Tile};

/// Pixels of a row whose rays are followed together.
const TOGETHER: u32 = 8;

/// Result of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pixel {
    /// Neither hits.
    Empty,
    /// The digger and the field hit, at this distance along the ray from each other.
    Off(f32),
    /// Either the digger or the field hits.
    Alone,
}

impl Pixel {
    fn pack(self) -> [u8; 4] {
        let number = match self {
            Self::Empty => -1.0,
            Self::Off(distance) => distance,
            Self::Alone => f32::INFINITY,
        };
        number.to_le_bytes()
    }

    fn unpack(bytes: [u8; 4]) -> Self {
        match f32::from_le_bytes(bytes) {
            f32::INFINITY => Self::Alone,
            distance if distance >= 0.0 => Self::Off(distance),
            _ => Self::Empty,
        }
    }
}

/// The pixels of a tile, or of a whole picture.
#[must_use]
pub fn unpack(bytes: &[u8]) -> Vec<Pixel> {
    let (pixels, _) = bytes.as_chunks();
    pixels.iter().copied().map(Pixel::unpack).collect()
}

/// Scene made ready for comparing.
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

    /// Compares one tile, rows from the top. `stop` is asked now and then; when it says true the
    /// tile is given up.
    #[must_use]
    pub fn trace(&self, tile: Tile, stop: &dyn Fn() -> bool) -> Option<Vec<u8>> {
        let middle = |at: u32, of: u32| (f64::from(at) + 0.5) / f64::from(of);
        let ray = |x: u32, y: u32| {
            let way = self
                .projection
                .direction(middle(x, self.size[0]), middle(y, self.size[1]));
            (self.projection.eye, way)
        };
        let mut bytes = Vec::new();
        for y in tile.y..tile.y + tile.height {
            let end = tile.x + tile.width;
            // Which rays are followed together does not depend on the tiles, whose sides are
            // multiples of that.
            for left in (tile.x..end).step_by(TOGETHER as usize) {
                let rays: Vec<_> = (left..end.min(left + TOGETHER))
                    .map(|x| ray(x, y))
                    .collect();
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
