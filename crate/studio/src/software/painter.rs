//! Paints egui's output, redrawing only what changed.
//!
//! The window is divided into square tiles. Everything that can change a tile's pixels goes into a
//! number for each tile: the triangles and rectangles that touch it, in order, with colours, clip
//! and the time at which the part of the texture they show last changed. Tiles with the same
//! number as in the last frame are left alone.

use std::{
    hash::{DefaultHasher, Hash, Hasher},
    ops::Range,
};

use egui::{
    ClippedPrimitive, Color32, Mesh, Rect, TextureId, TexturesDelta,
    epaint::{Primitive, Vertex},
};

use super::{
    raster::{self, Corner, Quad, Sheet},
    texture::{Texture, Textures},
};

pub use super::raster::Area;

/// The side of a tile in pixels.
const TILE: i32 = 64;

/// Draws frames of egui on a sheet of pixels.
#[derive(Debug, Default)]
pub struct Painter {
    textures: Textures,
    sheet: Sheet,
    /// What the tiles show; zero means unknown.
    shown: Vec<u64>,
    /// What the tiles shall show.
    wanted: Vec<u64>,
    /// Kept to save allocations.
    pieces: Vec<Piece>,
}

/// Something to fill.
#[derive(Debug)]
struct Piece {
    shape: Shape,
    texture: TextureId,
    /// Where it may touch the window.
    area: Area,
}

#[derive(Debug)]
enum Shape {
    Triangle([Corner; 3]),
    Quad(Quad),
}

impl Painter {
    /// Takes over the changes of the textures before a frame.
    pub fn set_textures(&mut self, delta: &mut TexturesDelta) {
        self.textures.set(delta);
    }

    /// Forgets the textures that are not used after a frame.
    pub fn free_textures(&mut self, delta: &mut TexturesDelta) {
        self.textures.free(delta);
    }

    /// Makes the next frame draw everything.
    pub fn forget(&mut self) {
        self.shown.fill(0);
    }

    /// The pixels of the window: red, green, blue, alpha in rows from the top.
    #[must_use]
    pub fn pixels(&self) -> &[u8] {
        self.sheet.bytes()
    }

    /// Paints a frame on a window of `size` pixels over the colour `ground`, and returns the areas
    /// that were redrawn. Callbacks for the GPU are left out.
    pub fn paint(
        &mut self,
        size: [usize; 2],
        pixels_per_point: f32,
        primitives: &[ClippedPrimitive],
        ground: Color32,
    ) -> Vec<Area> {
        if self.sheet.size() != size {
            self.sheet = Sheet::new(size[0], size[1]);
            self.shown.clear();
        }
        let [columns, rows] = self.grid();
        self.shown.resize(columns * rows, 0);
        self.wanted.clear();
        self.wanted.resize(columns * rows, number_of(&ground));

        self.collect(primitives, pixels_per_point);
        self.number();
        let dirty = self.dirty();
        for &area in dirty.iter().flatten() {
            self.sheet.clear(area, ground);
        }
        for piece in &self.pieces {
            let Some(texture) = self.textures.get(piece.texture) else {
                continue;
            };
            for &area in dirty[tiles(piece.area.y0, piece.area.y1)].iter().flatten() {
                let area = piece.area.intersect(area);
                if area.is_empty() {
                    continue;
                }
                match &piece.shape {
                    Shape::Triangle(corners) => self.sheet.triangle(corners, texture, area),
                    Shape::Quad(quad) => self.sheet.quad(quad, texture, area),
                }
            }
        }
        std::mem::swap(&mut self.shown, &mut self.wanted);
        dirty.concat()
    }

    /// Tiles in a row and in a column.
    fn grid(&self) -> [usize; 2] {
        self.sheet.size().map(|side| side.div_ceil(TILE as usize))
    }

    /// Takes apart what egui wants painted, leaving out what cannot be seen.
    fn collect(&mut self, primitives: &[ClippedPrimitive], pixels_per_point: f32) {
        self.pieces.clear();
        for ClippedPrimitive {
            clip_rect,
            primitive,
        } in primitives
        {
            let clip = clip_area(*clip_rect, pixels_per_point).intersect(self.sheet.area());
            let Primitive::Mesh(mesh) = primitive else {
                continue;
            };
            let Some(texture) = self.textures.get(mesh.texture_id) else {
                continue;
            };
            if clip.is_empty() {
                continue;
            }
            for shape in shapes(mesh, texture.size(), pixels_per_point) {
                let area = shape.area().intersect(clip);
                if !area.is_empty() {
                    self.pieces.push(Piece {
                        shape,
                        texture: mesh.texture_id,
                        area,
                    });
                }
            }
        }
    }

    /// Computes the numbers of all tiles.
    fn number(&mut self) {
        let columns = self.grid()[0];
        for piece in &self.pieces {
            let Some(texture) = self.textures.get(piece.texture) else {
                continue;
            };
            let number = number_of(&(&piece.shape, piece.texture, piece.area));
            for y in tiles(piece.area.y0, piece.area.y1) {
                for x in tiles(piece.area.x0, piece.area.x1) {
                    let seen = piece.area.intersect(tile(x, y));
                    let changed = piece.shape.changed(texture, seen);
                    let wanted = &mut self.wanted[y * columns + x];
                    *wanted = mixed(mixed(*wanted, number), changed);
                }
            }
        }
    }

    /// The areas to redraw, for each row of tiles from the left.
    fn dirty(&self) -> Vec<Vec<Area>> {
        let [columns, rows] = self.grid();
        let row = |y: usize| {
            let mut runs: Vec<Area> = Vec::new();
            for x in 0..columns {
                let index = y * columns + x;
                if self.shown[index] == self.wanted[index] {
                    continue;
                }
                let tile = tile(x, y).intersect(self.sheet.area());
                match runs.last_mut().filter(|run| run.x1 == tile.x0) {
                    Some(run) => run.x1 = tile.x1,
                    None => runs.push(tile),
                }
            }
            runs
        };
        (0..rows).map(row).collect()
    }
}

impl Shape {
    fn area(&self) -> Area {
        match self {
            Self::Triangle(corners) => raster::bounds(corners),
            Self::Quad(quad) => quad.area(),
        }
    }

    /// When the texels it shows in an area last changed.
    fn changed(&self, texture: &Texture, area: Area) -> u64 {
        let [from, to] = match self {
            Self::Quad(quad) => quad.texels(area),
            Self::Triangle(corners) => {
                let [a, b, c] = corners.map(|corner| corner.texel);
                [
                    [0, 1].map(|axis| a[axis].min(b[axis]).min(c[axis])),
                    [0, 1].map(|axis| a[axis].max(b[axis]).max(c[axis])),
                ]
            }
        };
        texture.changed(from, to)
    }
}

impl Hash for Shape {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match self {
            Self::Triangle(corners) => corners.hash(state),
            Self::Quad(quad) => quad.corners().hash(state),
        }
    }
}

/// The triangles of a mesh, with those that make a box joined to one.
fn shapes(
    mesh: &Mesh,
    texture_size: [usize; 2],
    pixels_per_point: f32,
) -> impl Iterator<Item = Shape> {
    let corner = move |index: u32| {
        let &Vertex { pos, uv, color } = mesh.vertices.get(index as usize)?;
        let [width, height] = texture_size.map(|side| side as f32);
        Corner::new(
            [pos.x * pixels_per_point, pos.y * pixels_per_point],
            [uv.x * width, uv.y * height],
            color,
        )
    };
    let mut rest = &mesh.indices[..];
    std::iter::from_fn(move || {
        while let &[a, b, c, ..] = rest {
            // The order in which epaint writes boxes.
            if let &[_, _, _, c2, b2, d, ..] = rest
                && (b, c) == (b2, c2)
                && let [Some(a), Some(b), Some(c), Some(d)] = [a, b, c, d].map(corner)
                && let Some(quad) = Quad::new([a, b, c, d])
            {
                rest = &rest[6..];
                return Some(Shape::Quad(quad));
            }
            rest = &rest[3..];
            if let [Some(a), Some(b), Some(c)] = [a, b, c].map(corner) {
                return Some(Shape::Triangle([a, b, c]));
            }
        }
        None
    })
}

/// The pixels that a clip rectangle lets through: edges are rounded, as egui's GPU painters do.
fn clip_area(clip: Rect, pixels_per_point: f32) -> Area {
    // The casts saturate.
    let pixel = |points: f32| (points * pixels_per_point).round() as i32;
    Area {
        x0: pixel(clip.min.x),
        y0: pixel(clip.min.y),
        x1: pixel(clip.max.x),
        y1: pixel(clip.max.y),
    }
}

/// The tiles in a range of columns or rows of pixels, which must not be empty.
fn tiles(from: i32, to: i32) -> Range<usize> {
    (from / TILE) as usize..((to - 1) / TILE + 1) as usize
}

fn tile(x: usize, y: usize) -> Area {
    let (x0, y0) = (x as i32 * TILE, y as i32 * TILE);
    Area {
        x0,
        y0,
        x1: x0 + TILE,
        y1: y0 + TILE,
    }
}

fn number_of(value: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}

/// A number for two numbers in order. The first is already well spread.
fn mixed(a: u64, b: u64) -> u64 {
    // An odd multiplier (2⁶⁴ over the golden ratio) loses nothing and carries low bits up.
    (a.rotate_left(5) ^ b).wrapping_mul(0x9e37_79b9_7f4a_7c15)
}
