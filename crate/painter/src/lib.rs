//! A software renderer for egui that redraws only what changed, for pages without a GPU.
//!
//! ```
//! use egui::Color32;
//! use painter::Painter;
//!
//! let mut painter = Painter::default();
//! let changed = painter.paint([64, 32], 1.0, &[], Color32::WHITE);
//! assert_eq!(changed.len(), 1);
//! assert_eq!(painter.pixels().len(), 4 * 64 * 32);
//! // The same frame again changes nothing.
//! assert!(painter.paint([64, 32], 1.0, &[], Color32::WHITE).is_empty());
//! ```
//!
//! The window is divided into square tiles. Everything that can change a tile's pixels goes into a
//! hash: the triangles and rectangles that touch it, in order, with colours, clip and the time at
//! which the part of the texture they show last changed. Tiles with the same hash as in the last
//! frame are left alone.
//!
//! `shape` says which pixels triangles and rectangles cover, `raster` fills them, and `texture`
//! keeps the pictures. The last two follow egui's own shader: colours are sRGB values multiplied by
//! their alpha, and are blended as such.
//!
//! It is a crate of its own because it is compiled for speed, and the rest of the page for size.

mod raster;
mod shape;
mod texture;

use std::ops::Range;

use egui::{
    ClippedPrimitive, Color32, Mesh, Rect, TextureId, TexturesDelta,
    epaint::{Primitive, Vertex},
    util::hash,
};

use raster::Sheet;
use shape::{Corner, Quad, Showing, mix};
use texture::Textures;

pub use shape::Area;

/// The side of a tile in pixels.
const TILE: i32 = 64;
/// The most tiles that a small shape touches; nearly all are small, and count as changed in all
/// their tiles or in none.
const SMALL: usize = 4;

/// Draws frames of egui on a sheet of pixels.
#[derive(Debug, Default)]
pub struct Painter {
    textures: Textures,
    sheet: Sheet,
    /// Hash of each tile's content; zero means unknown.
    shown: Vec<u64>,
    /// Hash of each tile's new content.
    wanted: Vec<u64>,
    /// Kept to save allocations.
    pieces: Vec<Piece>,
}

/// A shape to fill.
#[derive(Debug)]
struct Piece {
    shape: Shape,
    texture: TextureId,
    /// The pixels that it may cover.
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
        self.wanted.resize(columns * rows, hash(ground));

        self.collect(primitives, pixels_per_point);
        self.hash_tiles();
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

    /// The numbers of tiles in a row and in a column.
    fn grid(&self) -> [usize; 2] {
        self.sheet.size().map(|side| side.div_ceil(TILE as usize))
    }

    /// Collects the pieces of egui's meshes that can be seen.
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

    /// Computes the hashes of all tiles.
    fn hash_tiles(&mut self) {
        let across = self.grid()[0];
        for piece in &self.pieces {
            let Some(texture) = self.textures.get(piece.texture) else {
                continue;
            };
            let hash = piece.hash();
            let columns = tiles(piece.area.x0, piece.area.x1);
            let rows = tiles(piece.area.y0, piece.area.y1);
            // Which part of a small shape is seen in a tile is not worth finding out.
            let parts = (columns.len() * rows.len() > SMALL).then(|| piece.shape.showing());
            let [from, to] = shape::texels(piece.shape.corners());
            let whole = mix(hash, texture.last_change(from, to));
            for y in rows {
                for x in columns.clone() {
                    let wanted = &mut self.wanted[y * across + x];
                    let seen = parts.as_ref().map_or(whole, |parts| {
                        let [from, to] = parts.within(piece.area.intersect(tile(x, y)));
                        mix(hash, texture.last_change(from, to))
                    });
                    *wanted = mix(*wanted, seen);
                }
            }
        }
    }

    /// The areas to redraw, for each row of tiles from the left.
    fn dirty(&self) -> Vec<Vec<Area>> {
        let [columns, rows] = self.grid();
        let mut areas = vec![Vec::<Area>::new(); rows];
        for (y, runs) in areas.iter_mut().enumerate() {
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
        }
        areas
    }
}

impl Piece {
    /// Returns a hash of the shape, its texture and its area.
    fn hash(&self) -> u64 {
        let texture = match self.texture {
            TextureId::Managed(id) => id,
            TextureId::User(id) => !id,
        };
        let corners = self.shape.corners().iter();
        self.area
            .hash(corners.fold(texture, |before, corner| corner.hash(before)))
    }
}

impl Shape {
    fn area(&self) -> Area {
        match self {
            Self::Triangle(corners) => shape::bounds(corners),
            Self::Quad(quad) => quad.area(),
        }
    }

    fn corners(&self) -> &[Corner] {
        match self {
            Self::Triangle(corners) => corners,
            Self::Quad(quad) => quad.corners(),
        }
    }

    /// The texels it shows.
    fn showing(&self) -> Showing {
        match self {
            Self::Triangle(corners) => Showing::triangle(corners),
            Self::Quad(quad) => Showing::quad(quad),
        }
    }
}

/// The shapes of a mesh: two triangles that make a box become a rectangle.
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
    let [x0, y0, x1, y1] = [clip.min.x, clip.min.y, clip.max.x, clip.max.y]
        .map(|points| (points * pixels_per_point).round() as i32);
    Area { x0, y0, x1, y1 }
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

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{
        Context, Event, FontData, FontDefinitions, FontFamily, Modifiers, MouseWheelUnit, Pos2,
        RawInput, Rect, TextureOptions, TouchPhase, Ui, Vec2, epaint::RectShape, pos2, vec2,
    };
    use std::sync::Arc;

    const SIZE: [usize; 2] = [500, 300];

    fn fonts() -> FontDefinitions {
        let mut fonts = FontDefinitions::empty();
        let data = FontData::from_static(epaint_default_fonts::UBUNTU_LIGHT);
        fonts.font_data.insert("sans".to_owned(), Arc::new(data));
        for family in [FontFamily::Proportional, FontFamily::Monospace] {
            fonts.families.insert(family, vec!["sans".to_owned()]);
        }
        fonts
    }

    /// A window without a browser.
    struct Window {
        context: Context,
        painter: Painter,
    }

    impl Window {
        fn new() -> Self {
            let context = Context::default();
            context.set_fonts(fonts());
            Self {
                context,
                painter: Painter::default(),
            }
        }

        /// Runs a frame; gives what was redrawn, and the picture as a new painter would draw it.
        fn frame(&mut self, scale: f32, events: Vec<Event>, ui: impl FnMut(&mut Ui)) -> Vec<Area> {
            let mut input = RawInput {
                screen_rect: Some(Rect::from_min_size(
                    Pos2::ZERO,
                    vec2(SIZE[0] as f32, SIZE[1] as f32) / scale,
                )),
                events,
                ..Default::default()
            };
            let viewport = input.viewports.entry(egui::ViewportId::ROOT).or_default();
            viewport.native_pixels_per_point = Some(scale);
            let mut output = self.context.run_ui(input, ui);
            self.painter.set_textures(&mut output.textures_delta);
            let primitives = self
                .context
                .tessellate(output.shapes, output.pixels_per_point);
            let changed = self.painter.paint(
                SIZE,
                output.pixels_per_point,
                &primitives,
                Color32::from_gray(20),
            );
            let drawn = self.painter.pixels().to_vec();
            self.painter.forget();
            let all = self.painter.paint(
                SIZE,
                output.pixels_per_point,
                &primitives,
                Color32::from_gray(20),
            );
            assert_eq!(
                all.iter()
                    .map(|a| (a.x1 - a.x0) * (a.y1 - a.y0))
                    .sum::<i32>(),
                (SIZE[0] * SIZE[1]) as i32
            );
            let apart = drawn.iter().zip(self.painter.pixels());
            assert!(
                apart.into_iter().all(|(a, b)| a.abs_diff(*b) <= 1),
                "what was left alone had changed"
            );
            self.painter.free_textures(&mut output.textures_delta);
            changed
        }
    }

    fn label(ui: &mut Ui, text: &str) {
        let place = Rect::from_min_size(pos2(10.0, 10.0), vec2(100.0, 20.0));
        ui.put(place, egui::Label::new(text));
    }

    #[test]
    fn only_what_changed_is_redrawn() {
        let mut window = Window::new();
        assert!(
            !window
                .frame(1.0, Vec::new(), |ui| label(ui, "one"))
                .is_empty()
        );
        assert!(
            window
                .frame(1.0, Vec::new(), |ui| label(ui, "one"))
                .is_empty()
        );
        let changed = window.frame(1.0, Vec::new(), |ui| label(ui, "two"));
        assert!(!changed.is_empty());
        for area in changed {
            assert!(area.x1 <= 128 && area.y1 <= 64, "{area:?}");
        }
    }

    #[test]
    fn a_patch_of_a_picture_redraws_the_tiles_that_show_it() {
        patch(0);
        patch(9);
    }

    fn patch(corner_radius: u8) {
        let mut window = Window::new();
        let picture = egui::ColorImage::filled([400, 256], Color32::RED);
        let mut texture = window
            .context
            .load_texture("picture", picture, TextureOptions::LINEAR);
        let id = texture.id();
        let show = |ui: &mut Ui| {
            let place = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 256.0));
            let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            let shape = RectShape::filled(place, corner_radius, Color32::WHITE);
            ui.painter().add(shape.with_texture(id, all));
        };
        window.frame(1.0, Vec::new(), show);
        assert!(window.frame(1.0, Vec::new(), show).is_empty());
        texture.set_partial(
            [200, 70],
            egui::ColorImage::filled([20, 20], Color32::BLUE),
            TextureOptions::LINEAR,
        );
        let changed = window.frame(1.0, Vec::new(), show);
        // The texels 200 to 220 by 70 to 90, and neighbours for rounding.
        assert!(!changed.is_empty());
        for area in changed {
            assert!(
                area.x0 >= 128 && area.x1 <= 320 && area.y1 <= 192,
                "{area:?}"
            );
        }
        for (x, color) in [(205, Color32::BLUE), (199, Color32::RED)] {
            let start = 4 * (75 * SIZE[0] + x);
            let pixel = &window.painter.pixels()[start..start + 4];
            assert_eq!(pixel, color.to_array());
        }
    }

    #[test]
    fn a_patch_of_a_small_picture_is_seen() {
        let mut window = Window::new();
        let picture = egui::ColorImage::filled([60, 60], Color32::RED);
        let mut texture = window
            .context
            .load_texture("picture", picture, TextureOptions::LINEAR);
        let id = texture.id();
        let show = |ui: &mut Ui| {
            // In the corners of four tiles.
            let place = Rect::from_min_size(pos2(40.0, 40.0), vec2(60.0, 60.0));
            let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(id, place, all, Color32::WHITE);
        };
        window.frame(1.0, Vec::new(), show);
        assert!(window.frame(1.0, Vec::new(), show).is_empty());
        let blue = egui::ColorImage::filled([1, 1], Color32::BLUE);
        texture.set_partial([59, 59], blue, TextureOptions::LINEAR);
        // Compares with a window that is drawn anew.
        assert!(!window.frame(1.0, Vec::new(), show).is_empty());
    }

    #[test]
    fn shapes_are_cut_off_at_their_clip() {
        let mut window = Window::new();
        let clip = Rect::from_min_max(pos2(10.4, 20.0), pos2(30.6, 40.0));
        window.frame(1.0, Vec::new(), |ui| {
            let everywhere = ui.max_rect().expand(100.0);
            ui.painter_at(clip)
                .rect_filled(everywhere, 0.0, Color32::WHITE);
        });
        let pixels = window.painter.pixels().chunks(4).enumerate();
        let covered: Vec<_> = pixels
            .filter(|(_, pixel)| pixel[0] == 255)
            .map(|(i, _)| (i % SIZE[0], i / SIZE[0]))
            .collect();
        assert_eq!(covered.first(), Some(&(10, 20)));
        assert_eq!(covered.last(), Some(&(30, 39)));
        assert_eq!(covered.len(), 21 * 20);
    }

    /// After any changes in the window, redrawing the changed tiles gives the same picture as
    /// redrawing all ([`Window::frame`] checks it).
    #[test]
    fn redrawing_what_changed_is_redrawing_all() {
        for scale in [1.0, 1.25, 2.0] {
            let mut window = Window::new();
            let mut text: String = (0..60).map(|i| format!("line {i}: some words\n")).collect();
            let mut on = true;
            let mut amount = 0.3;
            let mut ui = |ui: &mut Ui| {
                egui::Panel::left("left").show(ui, |ui| {
                    ui.checkbox(&mut on, "a box");
                    ui.add(egui::Slider::new(&mut amount, 0.0..=1.0));
                    ui.spinner();
                    ui.collapsing("more", |ui| ui.label("inside"));
                });
                egui::CentralPanel::default().show(ui, |ui| {
                    egui::ScrollArea::vertical().show(ui, |ui| {
                        ui.add(egui::TextEdit::multiline(&mut text).desired_width(f32::INFINITY));
                    });
                });
            };
            let mut areas = 0;
            for step in 0..40 {
                let pointer = pos2(20.0 + 5.0 * step as f32, 10.0 + 2.0 * step as f32);
                let mut events = vec![Event::PointerMoved(pointer)];
                match step % 5 {
                    button @ (0 | 1) => events.push(Event::PointerButton {
                        pos: pointer,
                        button: egui::PointerButton::Primary,
                        pressed: button == 0,
                        modifiers: Modifiers::NONE,
                    }),
                    2 => events.push(Event::Text("ä€x".to_owned())),
                    3 => events.push(Event::MouseWheel {
                        source: egui::MouseWheelSource::Wheel,
                        unit: MouseWheelUnit::Point,
                        delta: Vec2::new(0.0, -30.0),
                        phase: TouchPhase::Move,
                        modifiers: Modifiers::NONE,
                    }),
                    _ => {}
                }
                areas += window.frame(scale, events, &mut ui).len();
            }
            assert!(areas > 40);
        }
    }
}
