//! The traced picture as it comes in, tile by tile and pass by pass.
//!
//! The last picture stays until every tile of the new one has come at least coarsely, so the user
//! never sees a half-empty frame; from then on finer tiles replace coarser ones in place.

use std::collections::HashMap;
use tracer::{Pass, Tile};

/// A picture in memory: RGBA, 8 bits each, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// The pixels.
    pub rgba: Vec<u8>,
}

/// A change on the screen because of a new tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// Nothing: the tile is for an older picture, is already there, or the new picture is not
    /// complete yet.
    Nothing,
    /// The whole picture.
    Whole,
    /// The pixels of one tile.
    Tile(Tile),
}

struct Coming {
    image: Image,
    /// The finest pass that has come for each tile.
    passes: HashMap<Tile, u8>,
    covered: u64,
    /// Whether this picture has taken the place of the last one.
    shown: bool,
}

/// The picture on the screen and the one that is coming.
#[derive(Default)]
pub struct Assembly {
    generation: u64,
    last: Option<(u64, Image)>,
    coming: Option<Coming>,
}

fn rank(pass: Pass) -> u8 {
    match pass {
        Pass::Coarse => 1,
        Pass::Full => 2,
        Pass::Smooth => 3,
    }
}

impl Assembly {
    /// Begins a new picture; tiles of older generations are ignored from now on.
    pub fn begin(&mut self, generation: u64, size: [u32; 2]) {
        self.settle();
        self.generation = generation;
        self.coming = Some(Coming {
            image: Image {
                size,
                rgba: vec![0; size[0] as usize * size[1] as usize * 4],
            },
            passes: HashMap::new(),
            covered: 0,
            shown: false,
        });
    }

    /// Takes a tile. Tiles outside the picture and pixel lists of the wrong length are ignored.
    pub fn put(&mut self, generation: u64, tile: Tile, pass: Pass, rgba: &[u8]) -> Change {
        if generation != self.generation {
            return Change::Nothing;
        }
        let Some(coming) = &mut self.coming else {
            return Change::Nothing;
        };
        let [width, height] = coming.image.size;
        let inside = tile.x.checked_add(tile.width).is_some_and(|x| x <= width)
            && tile.y.checked_add(tile.height).is_some_and(|y| y <= height);
        let area = u64::from(tile.width) * u64::from(tile.height);
        if !inside || area == 0 || rgba.len() as u64 != 4 * area {
            return Change::Nothing;
        }
        let finest = coming.passes.entry(tile).or_insert(0);
        if *finest >= rank(pass) {
            return Change::Nothing;
        }
        if *finest == 0 {
            coming.covered += area;
        }
        *finest = rank(pass);
        let row = tile.width as usize * 4;
        for (y, line) in rgba.chunks_exact(row).enumerate() {
            let start = ((tile.y as usize + y) * width as usize + tile.x as usize) * 4;
            coming.image.rgba[start..start + row].copy_from_slice(line);
        }
        if coming.shown {
            Change::Tile(tile)
        } else if coming.covered >= u64::from(width) * u64::from(height) {
            coming.shown = true;
            self.last = None;
            Change::Whole
        } else {
            Change::Nothing
        }
    }

    /// Returns the picture to show and the generation it belongs to.
    #[must_use]
    pub fn shown(&self) -> Option<(u64, &Image)> {
        match &self.coming {
            Some(coming) if coming.shown => Some((self.generation, &coming.image)),
            _ => self
                .last
                .as_ref()
                .map(|(generation, image)| (*generation, image)),
        }
    }

    /// Returns the share of the new picture that has come at least coarsely, 0 … 1.
    #[must_use]
    pub fn coverage(&self) -> f32 {
        self.coming.as_ref().map_or(0.0, |coming| {
            let [width, height] = coming.image.size;
            coming.covered as f32 / (width as f32 * height as f32).max(1.0)
        })
    }

    /// Forgets the picture that was coming, if it is not shown yet.
    pub fn settle(&mut self) {
        if let Some(coming) = self.coming.take()
            && coming.shown
        {
            self.last = Some((self.generation, coming.image));
        }
    }

    /// Forgets all pictures.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tile(x: u32) -> Tile {
        Tile {
            x,
            y: 0,
            width: 2,
            height: 2,
        }
    }

    fn colour(value: u8) -> Vec<u8> {
        vec![value; 16]
    }

    #[test]
    fn the_last_picture_stays_until_the_new_one_covers_the_frame() {
        let mut assembly = Assembly::default();
        assembly.begin(1, [4, 2]);
        assert_eq!(
            assembly.put(1, tile(0), Pass::Coarse, &colour(1)),
            Change::Nothing
        );
        assert!(assembly.shown().is_none());
        assert_eq!(
            assembly.put(1, tile(2), Pass::Coarse, &colour(2)),
            Change::Whole
        );
        assert_eq!(
            assembly.put(1, tile(2), Pass::Full, &colour(3)),
            Change::Tile(tile(2))
        );

        assembly.begin(2, [4, 2]);
        assert_eq!(
            assembly.put(2, tile(0), Pass::Coarse, &colour(9)),
            Change::Nothing
        );
        let (generation, image) = assembly.shown().unwrap();
        assert_eq!((generation, image.rgba[0], image.rgba[8]), (1, 1, 3));
        assert_eq!(
            assembly.put(2, tile(2), Pass::Full, &colour(8)),
            Change::Whole
        );
        assert_eq!(assembly.shown().unwrap().0, 2);
    }

    #[test]
    fn a_cancelled_picture_that_never_showed_leaves_the_last_one() {
        let mut assembly = Assembly::default();
        assembly.begin(1, [2, 2]);
        assembly.put(1, tile(0), Pass::Coarse, &colour(7));
        assembly.begin(2, [4, 2]);
        assembly.begin(3, [4, 2]);
        assert_eq!(assembly.shown().map(|(g, i)| (g, i.rgba[0])), Some((1, 7)));
    }

    #[test]
    fn late_coarser_foreign_and_malformed_tiles_are_ignored() {
        let mut assembly = Assembly::default();
        assembly.begin(5, [2, 2]);
        for (generation, column, pass, pixels, change) in [
            (4, 0, Pass::Full, &colour(1)[..], Change::Nothing),
            (5, 1, Pass::Full, &colour(1), Change::Nothing),
            (5, 0, Pass::Full, &[0; 3], Change::Nothing),
            (5, 0, Pass::Full, &colour(2), Change::Whole),
            (5, 0, Pass::Coarse, &colour(1), Change::Nothing),
            (5, 0, Pass::Full, &colour(1), Change::Nothing),
        ] {
            let put = assembly.put(generation, tile(column), pass, pixels);
            assert_eq!(put, change);
        }
        assert_eq!(assembly.shown().unwrap().1.rgba[0], 2);
    }
}
