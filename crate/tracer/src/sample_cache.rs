//! Cache of the first samples of a picture's pixels, so that none is traced twice.
//!
//! Whether a pixel gets more rays depends on the samples around it ([`refine`](crate::refine)), so
//! the smooth pass of a tile needs those at its neighbours' edges; and the pass with one ray a
//! pixel comes first. Without a cache all of these would be traced again. Cached samples have the
//! bits of traced ones, as packets are always traced whole.
use crate::Tile;
use crate::area::{Area, Samples};
use crate::known::Known;
use crate::layout::{PACKET_SIZE, SQUARE};
use crate::sample::Sample;
use std::ops::Range;

/// Number of packets across a square.
const COLUMNS: u32 = SQUARE / PACKET_SIZE[0];
/// Number of packets down a square.
const ROWS: u32 = SQUARE / PACKET_SIZE[1];

/// First samples of packets traced so far.
#[derive(Debug, Default)]
pub struct SampleCache {
    /// Size of the picture in pixels.
    size: [u32; 2],
    /// Squares from the picture's corner, row by row; `None` without samples.
    squares: Vec<Option<Box<Kept>>>,
    /// Number of squares that may still be added.
    room: usize,
}

/// Samples of a square.
#[derive(Debug)]
pub(crate) struct Kept {
    /// Samples row by row.
    samples: Vec<Sample>,
    /// Bits of the packets that are present, a number for each row of packets.
    known: [u16; ROWS as usize],
}

const _: () = assert!(COLUMNS == u16::BITS);

impl SampleCache {
    /// Returns an empty cache for a picture of `size` pixels that keeps at most `room` squares;
    /// samples of further squares are not kept.
    #[must_use]
    pub(crate) fn new(size: [u32; 2], room: usize) -> Self {
        let [across, down] = size.map(|n| n.div_ceil(SQUARE) as usize);
        Self {
            size,
            squares: std::iter::repeat_with(|| None)
                .take(across * down)
                .collect(),
            room,
        }
    }

    /// Returns the number of squares with samples.
    #[must_use]
    pub fn squares(&self) -> usize {
        self.squares.iter().flatten().count()
    }

    /// Returns the index of a square, given by its pixels.
    fn index(&self, square: Area) -> usize {
        let across = self.size[0].div_ceil(SQUARE) as usize;
        (square.top / SQUARE) as usize * across + (square.left / SQUARE) as usize
    }

    /// Returns the samples of a square, given by its pixels; `None` if there are none.
    pub(crate) fn square(&self, square: Area) -> Option<&Kept> {
        self.squares.get(self.index(square))?.as_deref()
    }

    /// Returns the size of the picture in pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the samples of a tile of at most 64×64 pixels; `None` unless all are present.
    #[must_use]
    pub fn tell(&self, tile: Tile) -> Option<Known> {
        let area = Area::from(tile);
        let [right, bottom] = self.size;
        if area.is_empty() || area.right > right || area.bottom > bottom {
            return None;
        }
        let mut samples = Samples::new(area);
        for square in area.blocks([SQUARE; 2]) {
            self.square(square)
                .filter(|known| known.tell_all(square, &mut samples))?;
        }
        Some(Known::new(tile, &samples))
    }

    /// Adds samples from another cache of this picture, as far as they are whole packets; each
    /// square that they touch takes up room. Samples outside the picture are ignored.
    pub fn learn(&mut self, known: &Known) {
        if let Some(samples) = known.samples(self.size) {
            self.keep(&samples, known.tile().into());
        }
    }

    /// Adds the samples of whole packets in their area. Squares outside `tile` get samples only if
    /// they have some already: strips along its edges are not worth a square's room.
    pub(crate) fn keep(&mut self, samples: &Samples, tile: Area) {
        let [right, bottom] = self.size;
        let picture = Area {
            left: 0,
            top: 0,
            right,
            bottom,
        };
        for square in samples.area().meet(picture).blocks([SQUARE; 2]) {
            let index = self.index(square);
            let Some(place) = self.squares.get_mut(index) else {
                continue;
            };
            if place.is_none() {
                if square.meet(tile).is_empty() {
                    continue;
                }
                let Some(left) = self.room.checked_sub(1) else {
                    continue;
                };
                self.room = left;
            }
            let kept = place.get_or_insert_with(Box::default);
            kept.keep(square, picture, samples);
        }
    }
}

impl Default for Kept {
    fn default() -> Self {
        Self {
            samples: vec![Sample::BLANK; (SQUARE * SQUARE) as usize],
            known: [0; ROWS as usize],
        }
    }
}

impl Kept {
    /// Adds the packets of a square that lie in the samples' area, apart from pixels outside the
    /// picture.
    fn keep(&mut self, square: Area, picture: Area, samples: &Samples) {
        let area = samples.area();
        let columns = whole(
            area.left..area.right,
            square.left,
            picture.right,
            PACKET_SIZE[0],
        );
        let rows = whole(
            area.top..area.bottom,
            square.top,
            picture.bottom,
            PACKET_SIZE[1],
        );
        let left = square.left + columns.start * PACKET_SIZE[0];
        let right = (square.left + columns.end * PACKET_SIZE[0]).min(picture.right);
        if left >= right {
            return;
        }
        for row in rows {
            self.known[row as usize] |= bits(&columns);
            let top = square.top + row * PACKET_SIZE[1];
            for y in top..(top + PACKET_SIZE[1]).min(picture.bottom) {
                let from = index(square, left, y);
                let kept = &mut self.samples[from..from + (right - left) as usize];
                kept.copy_from_slice(samples.part(y, left..right));
            }
        }
    }

    /// Copies the samples of a square into `samples`, if all are present; returns whether they are.
    pub fn tell_all(&self, square: Area, samples: &mut Samples) -> bool {
        let area = square.meet(samples.area());
        let columns = (area.left - square.left) / PACKET_SIZE[0]
            ..(area.right - square.left).div_ceil(PACKET_SIZE[0]);
        let rows = (area.top - square.top) / PACKET_SIZE[1]
            ..(area.bottom - square.top).div_ceil(PACKET_SIZE[1]);
        let wanted = bits(&columns);
        let known = &self.known[rows.start as usize..rows.end as usize];
        let all = known.iter().all(|known| known & wanted == wanted);
        if all {
            for y in area.top..area.bottom {
                let from = index(square, area.left, y);
                let kept = &self.samples[from..from + (area.right - area.left) as usize];
                samples
                    .part_mut(y, area.left..area.right)
                    .copy_from_slice(kept);
            }
        }
        all
    }

    /// Copies the samples of a square's packet, given by its column and row, into `samples`;
    /// returns whether they are present.
    pub fn tell(&self, [column, row]: [u32; 2], square: Area, samples: &mut Samples) -> bool {
        let known = self.known[row as usize] >> column & 1 == 1;
        if known {
            for (x, y) in square.cell([column, row], [COLUMNS, ROWS]).pixels() {
                samples.set(x, y, self.samples[index(square, x, y)]);
            }
        }
        known
    }
}

/// Returns the index of a pixel among those of a square.
fn index(square: Area, x: u32, y: u32) -> usize {
    ((y - square.top) * SQUARE + (x - square.left)) as usize
}

/// Returns the packets of a square, each of `size` pixels along an axis, whose pixels before `end`
/// all lie within `pixels`. The square begins at `start`.
fn whole(pixels: Range<u32>, start: u32, end: u32, size: u32) -> Range<u32> {
    let first = (pixels.start.max(start) - start).div_ceil(size);
    let to = pixels.end.min(start + SQUARE);
    let last = if to >= end {
        (to - start).div_ceil(size)
    } else {
        (to - start) / size
    };
    first..last.max(first)
}

/// Returns the bits of some columns.
fn bits(columns: &Range<u32>) -> u16 {
    ((1_u32 << columns.end) - (1 << columns.start)) as u16
}
