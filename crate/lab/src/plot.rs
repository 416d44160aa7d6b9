//! Figures by the painter alone: axes with round ticks, curves, filled areas, and grips to drag.

use egui::{
    Align2, Color32, CursorIcon, FontId, Mesh, Painter, Pos2, Rect, Response, Sense, Shape, Stroke,
    Ui, Vec2, pos2, vec2,
};
use widgets::{places, theme};

/// Nine hues that stay apart for the colour-blind (after Okabe and Ito), as bright as each palette
/// needs. They come in the order of `field::Kernel::ALL`.
const HUES_DARK: [u32; 9] = [
    0xF0A030, 0x63BDF0, 0x2FC79A, 0xF2E65A, 0x8C96FF, 0xFF7A45, 0xE08FC0, 0xE4E8EE, 0xA87A56,
];
const HUES_LIGHT: [u32; 9] = [
    0xC97A00, 0x2288C4, 0x007F5C, 0x8F8200, 0x3B47B8, 0xC2410C, 0xA33E7A, 0x3A424C, 0x6B4423,
];

/// Returns one of nine colours.
#[must_use]
pub fn hue(ui: &Ui, index: usize) -> Color32 {
    let hues = if ui.visuals().dark_mode {
        HUES_DARK
    } else {
        HUES_LIGHT
    };
    let rgb = hues[index % hues.len()];
    Color32::from_rgb((rgb >> 16) as u8, (rgb >> 8) as u8, rgb as u8)
}

/// Place with axes.
pub struct Plot {
    /// Place of the curves.
    pub rect: Rect,
    /// Shown range of x.
    pub x: [f64; 2],
    /// Shown range of y, from the bottom.
    pub y: [f64; 2],
    /// Paints inside `rect` only.
    pub painter: Painter,
}

/// Labels of an axis.
#[derive(Clone, Copy, Debug)]
pub struct Axis<'a> {
    /// The first and the last value.
    pub range: [f64; 2],
    /// The quantity.
    pub label: &'a str,
    /// Whether there are numbers.
    pub numbers: bool,
}

impl<'a> Axis<'a> {
    /// Makes an axis with numbers.
    #[must_use]
    pub fn new(range: [f64; 2], label: &'a str) -> Self {
        Self {
            range,
            label,
            numbers: true,
        }
    }

    /// Leaves the numbers out.
    #[must_use]
    pub fn bare(self) -> Self {
        Self {
            numbers: false,
            ..self
        }
    }
}

/// Draws the panel of a figure.
pub fn panel(ui: &Ui, place: Rect) {
    let palette = theme::palette(ui.visuals());
    ui.painter().rect(
        place,
        10.0,
        palette.paper,
        Stroke::new(1.0, palette.line),
        egui::StrokeKind::Inside,
    );
}

impl Plot {
    /// Draws axes into a place and returns the plot between them.
    #[must_use]
    pub fn new(ui: &Ui, place: Rect, x: Axis<'_>, y: Axis<'_>) -> Self {
        let palette = theme::palette(ui.visuals());
        let left = if y.numbers { 44.0 } else { 16.0 };
        let bottom = if x.numbers { 40.0 } else { 14.0 };
        let top = if y.label.is_empty() { 14.0 } else { 32.0 };
        let rect = Rect::from_min_max(place.min + vec2(left, top), place.max - vec2(16.0, bottom));
        let plot = Self {
            rect,
            x: x.range,
            y: y.range,
            painter: ui.painter_at(rect.expand(0.5)),
        };
        let painter = ui.painter();
        let font = FontId::proportional(11.5);
        let line = Stroke::new(1.0, palette.line);
        for value in ticks(x.range, f64::from(rect.width()) / 72.0) {
            let at = plot.at(value, y.range[0]).x;
            painter.vline(at, rect.y_range(), line);
            if x.numbers {
                let at = pos2(at, rect.bottom() + 5.0);
                let text = number(value);
                painter.text(at, Align2::CENTER_TOP, text, font.clone(), palette.weak);
            }
        }
        for value in ticks(y.range, f64::from(rect.height()) / 44.0) {
            let at = plot.at(x.range[0], value).y;
            painter.hline(rect.x_range(), at, line);
            if y.numbers {
                let at = pos2(rect.left() - 7.0, at);
                let text = number(value);
                painter.text(at, Align2::RIGHT_CENTER, text, font.clone(), palette.weak);
            }
        }
        let axis = Stroke::new(1.0, palette.weak);
        if (y.range[0]..=y.range[1]).contains(&0.0) {
            painter.hline(rect.x_range(), plot.at(0.0, 0.0).y, axis);
        }
        painter.vline(rect.left(), rect.y_range(), axis);
        let font = FontId::proportional(12.5);
        painter.text(
            pos2(place.left() + 14.0, place.top() + 9.0),
            Align2::LEFT_TOP,
            y.label,
            font.clone(),
            palette.text,
        );
        if x.numbers {
            let at = pos2(rect.right(), place.bottom() - 5.0);
            painter.text(at, Align2::RIGHT_BOTTOM, x.label, font, palette.text);
        }
        plot
    }

    /// Returns the position of a value on the screen. Values far outside are clamped, for the
    /// painter's sake.
    #[must_use]
    pub fn at(&self, x: f64, y: f64) -> Pos2 {
        let [x, y] = [(x, self.x), (y, self.y)]
            .map(|(value, [low, high])| ((value - low) / (high - low)).clamp(-4.0, 5.0) as f32);
        let (width, height) = (self.rect.width(), self.rect.height());
        pos2(
            self.rect.left() + width * x,
            self.rect.bottom() - height * y,
        )
    }

    /// Returns the value at a place.
    #[must_use]
    pub fn value(&self, at: Pos2) -> [f64; 2] {
        let x = f64::from((at.x - self.rect.left()) / self.rect.width().max(1.0));
        let y = f64::from((self.rect.bottom() - at.y) / self.rect.height().max(1.0));
        [
            self.x[0] + x * (self.x[1] - self.x[0]),
            self.y[0] + y * (self.y[1] - self.y[0]),
        ]
    }

    /// Iterates over the range of x in `count` equal steps, both ends included.
    pub fn samples(&self, count: usize) -> impl Iterator<Item = f64> + use<> {
        let [low, high] = self.x;
        (0..=count).map(move |i| low + (high - low) * i as f64 / count as f64)
    }

    /// Returns the number of points that a smooth curve needs.
    #[must_use]
    pub fn enough(&self) -> usize {
        (self.rect.width() / 1.5).clamp(60.0, 700.0) as usize
    }

    /// Returns the points of a function.
    pub fn points(&self, f: impl Fn(f64) -> f64) -> Vec<Pos2> {
        self.samples(self.enough())
            .map(|x| self.at(x, f(x)))
            .collect()
    }

    /// Draws a function.
    pub fn curve(&self, stroke: Stroke, f: impl Fn(f64) -> f64) {
        self.painter.line(self.points(f), stroke);
    }

    /// Draws a function in dashes.
    pub fn dashes(&self, stroke: Stroke, f: impl Fn(f64) -> f64) {
        self.painter
            .extend(Shape::dashed_line(&self.points(f), stroke, 7.0, 4.0));
    }

    /// Fills between a function and 0 where x is in a range.
    pub fn fill(&self, colour: Color32, [from, to]: [f64; 2], f: impl Fn(f64) -> f64) {
        let (from, to) = (from.max(self.x[0]), to.min(self.x[1]));
        if from >= to {
            return;
        }
        let share = ((to - from) / (self.x[1] - self.x[0])).clamp(0.0, 1.0);
        let steps = (self.enough() as f64 * share).ceil().max(2.0) as usize;
        let mut mesh = Mesh::default();
        for step in 0..=steps {
            let x = from + (to - from) * step as f64 / steps as f64;
            mesh.colored_vertex(self.at(x, 0.0), colour);
            mesh.colored_vertex(self.at(x, f(x)), colour);
            if step > 0 {
                let last = 2 * step as u32;
                mesh.add_triangle(last - 2, last - 1, last);
                mesh.add_triangle(last - 1, last, last + 1);
            }
        }
        self.painter.add(Shape::mesh(mesh));
    }

    /// Draws a vertical line with a word at its top.
    pub fn upright(&self, x: f64, stroke: Stroke, word: &str) {
        let at = self.at(x, self.y[0]).x;
        self.painter.extend(Shape::dashed_line(
            &[pos2(at, self.rect.top()), pos2(at, self.rect.bottom())],
            stroke,
            4.0,
            4.0,
        ));
        let (place, side) = if at > self.rect.right() - 120.0 {
            (pos2(at - 6.0, self.rect.top() + 5.0), Align2::RIGHT_TOP)
        } else {
            (pos2(at + 6.0, self.rect.top() + 5.0), Align2::LEFT_TOP)
        };
        let font = FontId::proportional(12.5);
        self.painter.text(place, side, word, font, stroke.color);
    }
}

/// Draws a grip to drag, as large as a thumb needs.
pub fn grip(ui: &Ui, name: &str, at: Pos2, colour: Color32, cursor: CursorIcon) -> Response {
    let size = ui.spacing().interact_size.y.max(30.0);
    let rect = Rect::from_center_size(at, Vec2::splat(size));
    let response = ui.interact(rect, ui.scope_id().with(("grip", name)), Sense::drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, name));
    places::note(ui.ctx(), format!("lab grip {name}"), rect);
    let palette = theme::palette(ui.visuals());
    let hot = response.hovered() || response.dragged() || response.has_focus();
    let radius = if hot { 9.0 } else { 7.0 };
    ui.painter()
        .circle(at, radius, colour, Stroke::new(2.0, palette.strong));
    response.on_hover_and_drag_cursor(cursor)
}

/// Returns round values in a range, about as many as asked for.
#[must_use]
pub fn ticks([low, high]: [f64; 2], about: f64) -> Vec<f64> {
    let span = high - low;
    if !(span.is_finite() && span > 0.0) {
        return Vec::new();
    }
    let rough = span / about.max(1.0);
    let power = libm::pow(10.0, libm::floor(libm::log10(rough)));
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|step| *step >= rough * 0.999)
        .unwrap_or(rough);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|i| i as f64 * step).collect()
}

/// Writes a number in few letters.
#[must_use]
pub fn number(value: f64) -> String {
    let size = value.abs();
    let text = if size < 1e-9 {
        return String::from("0");
    } else if !(0.01..1e5).contains(&size) {
        return scientific(value);
    } else if size < 1.0 {
        format!("{value:.3}")
    } else if size < 100.0 {
        format!("{value:.2}")
    } else {
        return format!("{value:.0}").replace('-', "−");
    };
    let text = text.trim_end_matches('0').trim_end_matches('.');
    text.replace('-', "−")
}

/// Writes a number as 2.4·10^−7: the fonts have no raised minus.
#[must_use]
pub fn scientific(value: f64) -> String {
    if value == 0.0 {
        return String::from("0");
    }
    let text = format!("{value:.1e}");
    let (factor, power) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{factor}·10^{power}").replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(ticks([0.0, 3.0], 6.0), [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0]);
        assert_eq!(ticks([-1.0, 1.0], 2.0), [-1.0, 0.0, 1.0]);
        assert!(ticks([1.0, 1.0], 5.0).is_empty());
        assert!(ticks([0.0, f64::NAN], 5.0).is_empty());
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(number(0.5), "0.5");
        assert_eq!(number(-1.25), "−1.25");
        assert_eq!(number(0.0), "0");
        assert_eq!(number(1234.0), "1234");
        assert_eq!(number(2.4e-7), "2.4·10^−7");
    }
}
