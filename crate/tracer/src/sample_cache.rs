//! The first samples of a picture's pixels, kept so that none is taken twice.
//!
//! Which pixels get more rays depends on the samples around them ([`refine`](crate::refine)), so that a tile that is made
//! smooth needs those of its neighbours' edges; and a picture is shown with one ray a pixel before it is made smooth. Without
//! a cache all of these are traced again. What comes out of a cache is what would be traced, bit for bit, as packets are
//! always traced whole.
use crate::area::{Area, Samples};
use crate::picture::{PACKET_SIZE, SQUARE};
use crate::sample::Sample;

/// Packets across and down a square.
const COLUMNS: u32 = SQUARE / PACKET_SIZE[0];
const ROWS: u32 = SQUARE / PACKET_SIZE[1];

/// First samples, packet by packet, as far as they are known.
#[derive(Debug, Default)]
pub struct SampleCache {
    /// Pixels of the picture.
    size: [u32; 2],
    /// Squares from the picture's corner, row by row; none yet where nothing is known.
    squares: Vec<Option<Box<Kept>>>,
    /// So many more squares may be kept.
    room: usize,
}

/// What is known of a square.
#[derive(Debug)]
pub(crate) struct Kept {
    /// Row by row.
    samples: Vec<Sample>,
    /// For each row of packets a bit for each that is known.
    known: [u16; ROWS as usize],
}

const _: () = assert!(COLUMNS == u16::BITS);

impl SampleCache {
    /// An empty cache for a picture of `size` pixels that keeps at most `room` squares; what comes after those is not
    /// kept.
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

    /// How many squares it keeps anything of.
    #[must_use]
    pub fn squares(&self) -> usize {
        self.squares.iter().flatten().count()
    }

    fn index(&self, square: Area) -> usize {
        let across = self.size[0].div_ceil(SQUARE) as usize;
        (square.top / SQUARE) as usize * across + (square.left / SQUARE) as usize
    }

    /// What is known of a square, given by its pixels.
    pub(crate) fn square(&self, square: Area) -> Option<&Kept> {
        self.squares.get(self.index(square))?.as_deref()
    }

    /// The pixels of the picture that it is for.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Keeps the samples of the packets that lie in their area, as far as packets lie in the picture. Of squares that are
    /// outside `tile` only if something of them is kept already: strips along its edges are not worth a square's room.
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
            for packet in square
                .meet(picture)
                .meet(samples.area())
                .blocks(PACKET_SIZE)
            {
                kept.keep(square, packet, packet.meet(picture), samples);
            }
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
    /// Keeps the pixels of a packet that lie in the picture, if all of these have samples.
    fn keep(&mut self, square: Area, packet: Area, pixels: Area, samples: &Samples) {
        let column = (packet.left - square.left) / PACKET_SIZE[0];
        let row = (packet.top - square.top) / PACKET_SIZE[1];
        let (known, bit) = (&mut self.known[row as usize], 1 << column);
        if *known & bit != 0 || !samples.area().contains(pixels) {
            return;
        }
        *known |= bit;
        for (x, y) in pixels.pixels() {
            self.samples[index(square, x, y)] = *samples.get(x, y);
        }
    }

    /// Writes the samples of a square's packet, given by its column and row, as far as they are wanted. Says whether they
    /// are known.
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

fn index(square: Area, x: u32, y: u32) -> usize {
    ((y - square.top) * SQUARE + (x - square.left)) as usize
}
