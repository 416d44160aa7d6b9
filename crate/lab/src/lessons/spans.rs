//! Lesson 8: how many Hermite spans a bone needs, on the thesis's cross, with maps of the error
//! (figures 4.3 to 4.5 there).
//!
//! Pictures and maps come from the workers: for a map each pixel's hit is held against the exact
//! crossing, found on the field itself in double precision.

use super::grid::note_refusal;
use super::slice::shade;
use crate::bench::Bench;
use crate::command::Command;
use crate::figure::{Figure, Words};
use crate::pictures::Shown;
use crate::tools::{Stage, choice, heading, reading, remark, slider};
use digger::errors::Pixel;
use egui::{
    Align2, Color32, ColorImage, FontId, Pos2, Rect, Sense, TextureHandle, TextureOptions, Ui,
    pos2, vec2,
};
use field::Kernel;
use std::rc::Rc;
use widgets::theme;

/// Pixels of a map, across and down.
const SIDE: usize = 96;
/// The bars' radius.
const RADIUS: f64 = 0.3;
/// The maps' colours begin at this error, in radii, and end at one radius.
const LEAST: f64 = 1e-4;

/// Columns: the title of each, the digger's words, the name of its reading.
const COLUMNS: [(&str, &str, &str); 3] = [
    ("2 spans a bone", "hermite2 2", "worst of 2"),
    ("4 spans a bone", "hermite2 4", "worst of 4"),
    ("certified", "hermite", "worst certified"),
];

/// Viewpoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum View {
    Side,
    Front,
}

/// Compared methods.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    view: View,
    kernel: Kernel,
    blobbiness: f64,
}

impl Key {
    /// Writes the cross, drawn by a digger, as a dataset.
    fn text(&self, digger: &str) -> String {
        let eye = match self.view {
            View::Side => "6 0.7 1.2",
            View::Front => "0 0 6.2",
        };
        format!(
            "# Two crossed bars, traced with a number of Hermite spans a bone. Take the digger\n\
             # `hermite` for spans that a proven bound on their error chooses.\n\
             # From the lab, lesson 8.\n\n\
             digger {digger}\n\n\
             var blobbiness = {blob:.3} hot    # near 0: reaches far; far from 0: crisp\n\n\
             eyep {eye}\nvrp 0 0 0\nvup 0 1 0\nfov 38\nframesize 480 480\nsample 3\n\n\
             light White point, position 4 6 8, intensity 0.9\n\
             light SlateBlue point, position 6 -2 -4, intensity 0.5, noshadow\n\n\
             surface flesh, diffuse Coral, specular 0.5 0.5 0.5, shine \
             40, blobbiness blobbiness, kernel {kernel}\n\n\
             cylinder flesh {RADIUS} <-1.6 0 0> <1.6 0 0>\n\
             cylinder flesh {RADIUS} <0 -1.6 0> <0 1.6 0>\n",
            blob = -self.blobbiness,
            kernel = self.kernel.name(),
        )
    }
}

/// Map of the errors of a column.
#[derive(Default)]
struct Map {
    /// The error of each pixel, along its ray.
    pixels: Rc<[Pixel]>,
    /// The state of the pixels: of the cross that is asked for, or of an older one.
    shown: Shown,
    texture: Option<TextureHandle>,
}

impl Map {
    /// Returns the errors of pixels where both the digger and the exact ray hit, in radii.
    fn distances(&self) -> impl Iterator<Item = f64> {
        self.pixels.iter().filter_map(|pixel| match pixel {
            Pixel::Off(distance) => Some(f64::from(*distance) / RADIUS),
            _ => None,
        })
    }

    /// Returns the largest error, in radii.
    fn worst(&self) -> f64 {
        self.distances().fold(0.0, f64::max)
    }

    /// Returns the mean error, in radii.
    fn mean(&self) -> f64 {
        self.distances().sum::<f64>() / self.distances().count().max(1) as f64
    }

    /// Counts the pixels where only one of the two hits.
    fn alone(&self) -> usize {
        self.pixels.iter().filter(|p| **p == Pixel::Alone).count()
    }

    fn image(&self, background: Color32, alone: Color32) -> ColorImage {
        let mut pixels = vec![background; SIDE * SIDE];
        for (colour, pixel) in pixels.iter_mut().zip(self.pixels.iter()) {
            *colour = match pixel {
                Pixel::Empty => background,
                Pixel::Off(distance) => shade(share(f64::from(*distance) / RADIUS), true),
                Pixel::Alone => alone,
            };
        }
        ColorImage::new([SIDE, SIDE], pixels)
    }
}

/// Returns the position of a distance on the logarithmic colour scale.
fn share(radii: f64) -> f32 {
    let decades = -libm::log10(LEAST);
    (1.0 + libm::log10(radii.max(1e-12)) / decades).clamp(0.0, 1.0) as f32
}

/// The words of the lesson.
pub static WORDS: Words = Words {
    link: "spans",
    title: "How many spans?",
    name: "How many spans?",
    short: "Spans",
    about: "cubics along a ray, and errors",
    sentences: "Along each ray a few cubics stand in for a bone's field, so a picture shows their \
                surface, not the field's. Two spans a bone, as first published, fail where a ray \
                runs along a bar, and four are better. The tracer here chooses the spans by a \
                proven bound on their error, so there is no number to set.",
};

/// The lesson's state.
pub struct Spans {
    key: Key,
    maps: [Map; 3],
    /// The textures are for these colours.
    colours: [Color32; 2],
}

impl Default for Spans {
    fn default() -> Self {
        Self {
            key: Key {
                view: View::Side,
                kernel: Kernel::Gauss,
                blobbiness: 1.0,
            },
            maps: Default::default(),
            colours: [Color32::TRANSPARENT; 2],
        }
    }
}

impl Figure for Spans {
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        self.measure(ui, bench);
        let mut stage = Stage::new(ui, bench.narrow, bench.height, 0.74);
        self.table(ui, &stage, bench);
        let controls = &mut stage.controls;
        heading(controls, "The cross is seen");
        choice(
            controls,
            &mut self.key.view,
            &[(View::Side, "along a bar"), (View::Front, "from the front")],
        );
        heading(controls, "Kernel");
        choice(
            controls,
            &mut self.key.kernel,
            &[(Kernel::Gauss, "gauss"), (Kernel::Cauchy, "cauchy")],
        );
        if self.key.kernel == Kernel::Cauchy {
            remark(
                controls,
                "This kernel reaches further, so its spans are longer.",
            );
        }
        let blobbiness = &mut self.key.blobbiness;
        slider(controls, "Blobbiness |B|", blobbiness, 0.3..=6.0, "");
        heading(controls, "Distance from the surface: mean, worst");
        let strong = theme::palette(controls.visuals()).strong;
        for ((title, _, name), map) in COLUMNS.iter().zip(&self.maps) {
            let value = format!("{}, {}", percent(map.mean()), percent(map.worst()));
            reading(controls, title, &value, strong);
            bench.readings.insert(name, map.worst());
        }
        let [two, four, certified] = self.maps.each_ref().map(Map::alone);
        let text = format!(
            "In per cent of the bars' radius, along the ray. Red: a hit where there should be \
             none, or none where there should be one: {two}, {four} and {certified} pixels."
        );
        remark(controls, text);
        bench.readings.insert("alone of 2", two as f64);
        bench.readings.insert("alone certified", certified as f64);
        let mut states = self.maps.iter().map(|map| &map.shown);
        let done = !states.any(|shown| matches!(shown, Shown::Older | Shown::Nothing));
        bench.readings.insert("finished", f64::from(u8::from(done)));
        controls.add_space(4.0);
        legend(controls);
        stage.finish(ui);
    }

    fn dataset(&self) -> Command {
        Command::open("Cross", self.text())
    }
}

impl Spans {
    /// Takes the maps that are there, and asks for those that are not.
    fn measure(&mut self, ui: &Ui, bench: &mut Bench<'_>) {
        let palette = theme::palette(ui.visuals());
        let colours = [palette.paper, palette.error];
        let repaint = self.colours != colours;
        self.colours = colours;
        for (index, (map, (_, digger, _))) in self.maps.iter_mut().zip(COLUMNS).enumerate() {
            let text = self.key.text(digger);
            let slot = ("errors", index);
            let (pixels, shown) = bench.pictures.errors(slot, &text, SIDE as u32);
            map.shown = shown;
            let Some(pixels) = pixels.filter(|pixels| repaint || !Rc::ptr_eq(pixels, &map.pixels))
            else {
                continue;
            };
            map.pixels = pixels;
            let image = map.image(colours[0], colours[1]);
            match &mut map.texture {
                Some(texture) => texture.set(image, TextureOptions::NEAREST),
                None => {
                    let options = TextureOptions::NEAREST;
                    map.texture = Some(ui.ctx().load_texture("spans", image, options));
                }
            }
        }
    }

    /// Draws the pictures, and below each its map.
    fn table(&self, ui: &Ui, stage: &Stage, bench: &mut Bench<'_>) {
        let palette = theme::palette(ui.visuals());
        let all = stage.figure;
        let (gap, top) = if bench.narrow {
            (4.0, 22.0)
        } else {
            (10.0, 28.0)
        };
        let columns = COLUMNS.len() as f32;
        let width = (all.width() - gap * (columns - 1.0)) / columns;
        let height = (all.height() - top - gap) / 2.0;
        let side = width.min(height).floor();
        let painter = ui.painter();
        let font = FontId::proportional(if bench.narrow { 12.0 } else { 14.0 });
        for (index, (title, digger, _)) in COLUMNS.iter().enumerate() {
            let left = all.left() + (side + gap) * index as f32;
            let at = pos2(left + side / 2.0, all.top() + top - 7.0);
            let strong = palette.strong;
            painter.text(at, Align2::CENTER_BOTTOM, title, font.clone(), strong);
            let place = Rect::from_min_size(pos2(left, all.top() + top), vec2(side, side));
            let text = self.key.text(digger);
            let shown = bench.pictures.show(ui, ("spans", index), &text, place);
            note_refusal(ui, place, &shown);
            name(ui, place, &format!("The cross, {title}"));
            let below = place.translate(vec2(0.0, side + gap));
            painter.rect_filled(below, 6.0, palette.paper);
            if let Some(texture) = &self.maps[index].texture {
                let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
                let shape = egui::epaint::RectShape::filled(below, 6.0, Color32::WHITE);
                painter.add(shape.with_texture(texture.id(), whole));
            }
            note_refusal(ui, below, &self.maps[index].shown);
            name(ui, below, &format!("Map of the error, {title}"));
        }
    }

    /// Writes the cross with two spans, as a dataset.
    fn text(&self) -> String {
        self.key.text(COLUMNS[0].1)
    }
}

/// Names a picture for screen readers.
fn name(ui: &Ui, place: Rect, name: &str) {
    let response = ui.interact(place, ui.scope_id().with(name), Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, name));
}

/// Writes a number of radii in per cent.
fn percent(radii: f64) -> String {
    if radii < LEAST {
        return String::from("< 0.01 %");
    }
    let value = 100.0 * radii;
    match value {
        10.0.. => format!("{value:.0} %"),
        1.0.. => format!("{value:.1} %"),
        _ => format!("{value:.2} %"),
    }
}

/// Draws the colours and their values.
fn legend(ui: &mut Ui) {
    let palette = theme::palette(ui.visuals());
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 36.0), Sense::hover());
    let bar = Rect::from_min_size(rect.min, vec2(rect.width(), 14.0));
    let painter = ui.painter();
    let steps = 48;
    for step in 0..steps {
        let from = bar.left() + bar.width() * step as f32 / steps as f32;
        let size = vec2(bar.width() / steps as f32 + 0.6, bar.height());
        let piece = Rect::from_min_size(pos2(from, bar.top()), size);
        let colour = shade((step as f32 + 0.5) / steps as f32, true);
        painter.rect_filled(piece, 0.0, colour);
    }
    let marks = [
        (LEAST, "0.01 %", Align2::LEFT_TOP),
        (1e-2, "1 %", Align2::CENTER_TOP),
        (1.0, "a radius", Align2::RIGHT_TOP),
    ];
    for (radii, text, side) in marks {
        let at = pos2(bar.left() + bar.width() * share(radii), bar.bottom() + 4.0);
        let font = FontId::proportional(11.5);
        painter.text(at, side, text, font, palette.weak);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use digger::errors::{Errors, unpack};
    use rats::{File, Project};
    use tracer::Tile;

    #[test]
    fn more_spans_are_nearer_and_certified_ones_are_there() {
        for view in [View::Side, View::Front] {
            let key = Key {
                view,
                ..Spans::default().key
            };
            let maps = COLUMNS.map(|(_, digger, _)| {
                let file = File {
                    name: String::from("main.rat"),
                    text: key.text(digger),
                };
                let scene = rats::compile(&Project { files: vec![file] }).scene;
                let side = SIDE as u32;
                let tile = Tile {
                    x: 0,
                    y: 0,
                    width: side,
                    height: side,
                };
                let bytes = Errors::new(&scene, [side; 2]).trace(tile, &|| false);
                Map {
                    pixels: unpack(&bytes.unwrap()).into(),
                    ..Map::default()
                }
            });
            let [two, four, certified] = maps.each_ref().map(Map::worst);
            let alone = maps.each_ref().map(Map::alone);
            assert!(two > 0.1 && four < two, "{two} {four}");
            assert!(certified < 0.01, "{certified}");
            assert!(alone[2] < 20 && alone[2] <= alone[0], "{alone:?}");
            // The cross is in the picture.
            let pixels = maps[2].pixels.iter();
            let hits = pixels.filter(|pixel| **pixel != Pixel::Empty).count();
            let part = hits as f64 / (SIDE * SIDE) as f64;
            assert!((0.1..0.6).contains(&part), "{part}");
        }
    }

    #[test]
    fn the_scale_has_a_radius_at_its_end() {
        assert_eq!(share(1.0), 1.0);
        assert_eq!(share(0.0), 0.0);
        assert!((share(1e-2) - 0.5).abs() < 1e-6);
    }
}
