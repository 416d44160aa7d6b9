//! First samples in a form that workers exchange, so that none is traced twice.
//!
//! Whether a pixel gets more rays depends on the samples around it: the smooth pass of a tile needs
//! those at its neighbours' edges, and all of its own if another worker traced it before. Samples
//! are the same wherever they are traced.
use crate::Tile;
use crate::area::{Area, Samples};
use crate::sample::Sample;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Size of a sample in bytes.
const BYTES: usize = 24;
/// Largest width and height in pixels: a tile or a part of one.
const LARGEST_SIDE: u32 = 64;

/// The first samples of all pixels of a rectangle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Known {
    tile: Tile,
    /// Samples row by row, or a single one if all are equal, as in empty tiles; each as colour,
    /// key, depth and cost, little-endian.
    #[serde(with = "serde_bytes")]
    bytes: Vec<u8>,
}

impl Known {
    pub(crate) fn new(tile: Tile, samples: &Samples) -> Self {
        let area = Area::from(tile);
        let rows = || (area.top..area.bottom).map(|y| samples.part(y, area.left..area.right));
        let first = samples.get(area.left, area.top);
        let bytes = if rows().flatten().all(|sample| sample == first) {
            encode(first).to_vec()
        } else {
            let mut bytes = Vec::with_capacity(BYTES * tile.width as usize * tile.height as usize);
            rows().for_each(|row| bytes.extend(row.iter().flat_map(encode)));
            bytes
        };
        Self { tile, bytes }
    }

    /// Returns the rectangle of pixels.
    #[must_use]
    pub fn tile(&self) -> Tile {
        self.tile
    }

    /// Returns the samples of the pixels that lie in another rectangle, too; `None` if none does.
    #[must_use]
    pub fn part(&self, tile: Tile) -> Option<Self> {
        let own = Area::from(self.tile);
        let part = own.meet(tile.into());
        if part.is_empty() || !self.is_whole() {
            return None;
        }
        if self.bytes.len() == BYTES {
            return Some(Self {
                tile: part.into(),
                bytes: self.bytes.clone(),
            });
        }
        let width = BYTES * self.tile.width as usize;
        let columns = [part.left, part.right].map(|x| BYTES * (x - own.left) as usize);
        let rows = (part.top - own.top) as usize..(part.bottom - own.top) as usize;
        let rows = self
            .bytes
            .chunks_exact(width)
            .take(rows.end)
            .skip(rows.start);
        let mut bytes = Vec::with_capacity((columns[1] - columns[0]) * rows.len());
        rows.for_each(|row| bytes.extend_from_slice(&row[columns[0]..columns[1]]));
        Some(Self {
            tile: part.into(),
            bytes,
        })
    }

    /// Whether these are well-formed samples of at most a tile of a picture of this size: the bytes
    /// come from a message.
    #[must_use]
    pub fn is_of(&self, size: [u32; 2]) -> bool {
        let area = Area::from(self.tile);
        let small = self.tile.width <= LARGEST_SIDE && self.tile.height <= LARGEST_SIDE;
        let inside = area.right <= size[0] && area.bottom <= size[1];
        small && inside && !area.is_empty() && self.is_whole()
    }

    /// Whether there is one sample, or one for each pixel.
    fn is_whole(&self) -> bool {
        let pixels = u64::from(self.tile.width) * u64::from(self.tile.height);
        let (one, all) = (BYTES as u64, pixels.checked_mul(BYTES as u64));
        [Some(one), all].contains(&Some(self.bytes.len() as u64))
    }

    /// Decodes the samples; `None` unless [`Known::is_of`] a picture of this size.
    pub(crate) fn samples(&self, size: [u32; 2]) -> Option<Samples> {
        if !self.is_of(size) {
            return None;
        }
        let area = Area::from(self.tile);
        let (read, _) = self.bytes.as_chunks::<BYTES>();
        let mut read = read.iter().map(decode).cycle();
        let mut samples = Samples::new(area);
        for y in area.top..area.bottom {
            let row = samples.part_mut(y, area.left..area.right);
            row.iter_mut()
                .zip(&mut read)
                .for_each(|(to, from)| *to = from);
        }
        Some(samples)
    }
}

/// Encodes a sample as colour, key, depth and cost, little-endian.
fn encode(sample: &Sample) -> [u8; BYTES] {
    let Vec3 { x, y, z } = sample.colour;
    let [x, y, z, depth, cost] = [x, y, z, sample.depth, sample.cost].map(f32::to_le_bytes);
    let words = [x, y, z, sample.key.to_le_bytes(), depth, cost];
    core::array::from_fn(|i| words[i / 4][i % 4])
}

/// Decodes a sample.
fn decode(bytes: &[u8; BYTES]) -> Sample {
    let (words, _) = bytes.as_chunks::<4>();
    let number = |i: usize| f32::from_le_bytes(words[i]);
    Sample {
        colour: Vec3::new(number(0), number(1), number(2)),
        key: u32::from_le_bytes(words[3]),
        depth: number(4),
        cost: number(5),
    }
}

/// Returns the pixels whose first samples the smooth pass of a tile needs, in a picture of `size`
/// pixels: its own and some around it.
#[must_use]
pub fn around(tile: Tile, size: [u32; 2]) -> Tile {
    Area::from(tile).around(size).into()
}
