//! Rectangles of pixels, and the samples taken in them.
use crate::layout::PACKET_SIZE;
use crate::sample::Sample;
use crate::tile::Tile;
use std::ops::Range;

/// A rectangle of cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Area {
    pub left: u32,
    pub top: u32,
    pub right: u32,
    pub bottom: u32,
}

impl From<Tile> for Area {
    fn from(tile: Tile) -> Self {
        Self {
            left: tile.x,
            top: tile.y,
            right: tile.x.saturating_add(tile.width),
            bottom: tile.y.saturating_add(tile.height),
        }
    }
}

impl From<Area> for Tile {
    fn from(area: Area) -> Self {
        Self {
            x: area.left,
            y: area.top,
            width: area.right - area.left,
            height: area.bottom - area.top,
        }
    }
}

impl Area {
    /// Returns the part in a column and a row, where the area is divided into equal ones. Their
    /// numbers must divide the area's sides.
    pub fn cell(self, [column, row]: [u32; 2], [columns, rows]: [u32; 2]) -> Self {
        let width = (self.right - self.left) / columns;
        let height = (self.bottom - self.top) / rows;
        let (left, top) = (self.left + column * width, self.top + row * height);
        Self {
            left,
            top,
            right: left + width,
            bottom: top + height,
        }
    }

    pub fn holds(&self, x: u32, y: u32) -> bool {
        (self.left..self.right).contains(&x) && (self.top..self.bottom).contains(&y)
    }

    /// Returns the left and the right half if `across`, else the upper and the lower.
    pub fn halves(self, across: bool) -> [Self; 2] {
        let (x, y) = (
            self.left.midpoint(self.right),
            self.top.midpoint(self.bottom),
        );
        if across {
            [Self { right: x, ..self }, Self { left: x, ..self }]
        } else {
            [Self { bottom: y, ..self }, Self { top: y, ..self }]
        }
    }

    /// The part within another area.
    pub fn meet(self, other: Self) -> Self {
        Self {
            left: self.left.max(other.left),
            top: self.top.max(other.top),
            right: self.right.min(other.right),
            bottom: self.bottom.min(other.bottom),
        }
    }

    /// Whether there is no cell in it.
    pub fn is_empty(self) -> bool {
        self.left >= self.right || self.top >= self.bottom
    }

    /// Returns the rectangle in cells that are smaller by a factor.
    pub fn times(self, factor: u32) -> Self {
        Self {
            left: self.left * factor,
            top: self.top * factor,
            right: self.right * factor,
            bottom: self.bottom * factor,
        }
    }

    /// Iterates over the blocks of a size that touch the area, whole; they are laid out from the
    /// picture's corner.
    pub fn blocks(self, [width, height]: [u32; 2]) -> impl Iterator<Item = Self> {
        (self.top / height..self.bottom.div_ceil(height)).flat_map(move |j| {
            (self.left / width..self.right.div_ceil(width)).map(move |i| Self {
                left: i * width,
                top: j * height,
                right: (i + 1) * width,
                bottom: (j + 1) * height,
            })
        })
    }

    /// The packets of an area in a picture of `size` pixels, which are refined together.
    pub fn packets(self, size: [u32; 2]) -> Self {
        let [across, down] = PACKET_SIZE;
        Self {
            left: self.left / across * across,
            top: self.top / down * down,
            right: self.right.min(size[0]).next_multiple_of(across),
            bottom: self.bottom.min(size[1]).next_multiple_of(down),
        }
    }

    /// The pixels whose first samples are needed to make an area smooth in a picture of `size`
    /// pixels: those of the packets in it and of all around them.
    pub fn around(self, size: [u32; 2]) -> Self {
        let packets = self.packets(size);
        let [across, down] = PACKET_SIZE;
        Self {
            left: packets.left.saturating_sub(across),
            top: packets.top.saturating_sub(down),
            right: (packets.right + across).min(size[0]).max(self.right),
            bottom: (packets.bottom + down).min(size[1]).max(self.bottom),
        }
    }

    /// Iterates over the pixels, row by row.
    pub fn pixels(self) -> impl Iterator<Item = (u32, u32)> {
        (self.top..self.bottom).flat_map(move |y| (self.left..self.right).map(move |x| (x, y)))
    }
}

/// The samples of an area.
pub(crate) struct Samples {
    area: Area,
    cells: Vec<Sample>,
}

impl Samples {
    pub fn new(area: Area) -> Self {
        let width = (area.right - area.left) as usize;
        let height = (area.bottom - area.top) as usize;
        Self {
            area,
            cells: vec![Sample::BLANK; width * height],
        }
    }

    pub fn area(&self) -> Area {
        self.area
    }

    fn index(&self, x: u32, y: u32) -> usize {
        let width = (self.area.right - self.area.left) as usize;
        (y - self.area.top) as usize * width + (x - self.area.left) as usize
    }

    pub fn get(&self, x: u32, y: u32) -> &Sample {
        &self.cells[self.index(x, y)]
    }

    /// Iterates over a row's samples in some columns.
    pub fn row(&self, y: u32, columns: impl Iterator<Item = u32>) -> impl Iterator<Item = &Sample> {
        let start = self.index(self.area.left, y);
        let end = self.index(self.area.right, y);
        let row = &self.cells[start..end];
        columns.map(move |x| &row[(x - self.area.left) as usize])
    }

    /// Returns a row's samples in a range of columns.
    pub fn part(&self, y: u32, columns: Range<u32>) -> &[Sample] {
        let from = self.index(columns.start, y);
        &self.cells[from..from + columns.len()]
    }

    /// Returns a row's samples in a range of columns, to be written.
    pub fn part_mut(&mut self, y: u32, columns: Range<u32>) -> &mut [Sample] {
        let from = self.index(columns.start, y);
        &mut self.cells[from..from + columns.len()]
    }

    /// Replaces a sample; nothing happens outside the area.
    pub fn set(&mut self, x: u32, y: u32, sample: Sample) {
        if self.area.holds(x, y) {
            let index = self.index(x, y);
            self.cells[index] = sample;
        }
    }
}
