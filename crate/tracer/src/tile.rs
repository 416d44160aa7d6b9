//! Tiles of a picture, and passes over them.
use serde::{Deserialize, Serialize};

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Tile {
    /// Left edge.
    pub x: u32,
    /// Top edge.
    pub y: u32,
    /// Width, > 0.
    pub width: u32,
    /// Height, > 0.
    pub height: u32,
}

/// Fineness with which a tile is traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Pass {
    /// A single ray for every block of 8×8 pixels.
    Coarse,
    /// A single ray for every pixel.
    Full,
    /// A ray for every pixel, and n×n where neighbouring pixels differ by more than the contrast.
    Smooth,
}

/// Returns the tiles of a picture, those nearest to its centre first. Their sides are at most
/// `side` (a side of 0 is read as 1), and together they cover every pixel exactly once.
#[must_use]
pub fn tiles(width: u32, height: u32, side: u32) -> Vec<Tile> {
    let side = side.max(1);
    let mut tiles = Vec::new();
    for y in (0..height).step_by(side as usize) {
        for x in (0..width).step_by(side as usize) {
            tiles.push(Tile {
                x,
                y,
                width: side.min(width - x),
                height: side.min(height - y),
            });
        }
    }
    // Twice the offset of the tile's centre from the picture's, so that all numbers are whole;
    // equal distances keep their order (left to right, top to bottom).
    field::heap_sort(&mut tiles, |a, b| {
        let [a, b] = [a, b].map(|t| {
            let dx = i64::from(2 * t.x + t.width) - i64::from(width);
            let dy = i64::from(2 * t.y + t.height) - i64::from(height);
            (dx * dx + dy * dy, t.y, t.x)
        });
        a < b
    });
    tiles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_exactly_once_and_start_at_the_centre() {
        for (width, height, side) in [(640, 480, 64), (100, 37, 16), (1, 1, 64), (7, 90, 32)] {
            let tiles = tiles(width, height, side);
            let mut seen = vec![0u8; (width * height) as usize];
            for t in &tiles {
                assert!(t.width > 0 && t.height > 0 && t.width <= side && t.height <= side);
                for y in t.y..t.y + t.height {
                    for x in t.x..t.x + t.width {
                        seen[(y * width + x) as usize] += 1;
                    }
                }
            }
            assert!(seen.iter().all(|&n| n == 1));
            let first = tiles[0];
            for (a, n, whole) in [
                (first.x, first.width, width),
                (first.y, first.height, height),
            ] {
                let off = f64::from(a) + f64::from(n) / 2.0 - f64::from(whole) / 2.0;
                assert!(off.abs() <= f64::from(side));
            }
        }
        assert!(tiles(0, 10, 8).is_empty());
        assert_eq!(tiles(3, 1, 0).len(), 3);
    }
}
