//! Cutting a picture into tiles.
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

/// How finely a tile is traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Pass {
    /// One ray for every block of 8×8 pixels.
    Coarse,
    /// One ray a pixel.
    Full,
    /// One ray a pixel, and up to n×n where neighbouring pixels differ by more than the contrast.
    Smooth,
}

/// The tiles of a picture, those nearest to its centre first. Their sides are at most `side`.
#[must_use]
pub fn tiles(width: u32, height: u32, side: u32) -> Vec<Tile> {
    let _ = (width, height, side);
    todo!()
}
