//! Buttons with small drawn icons, which look the same with any fonts.

use crate::theme;
use egui::{Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, Vec2, vec2};

/// An icon of a button.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Icon {
    /// An arrow that bends back.
    Undo,
    /// An arrow that bends forth.
    Redo,
    /// A half-filled disc: the palette.
    Theme,
    /// A question mark.
    Help,
    /// An arrow into a tray.
    Save,
    /// A house: back to the text's camera.
    Home,
    /// The corners of a frame: see the whole model.
    Frame,
    /// A plus.
    Add,
    /// A row of three dots.
    More,
    /// A cross.
    Close,
    /// Lines with one moved in: lay the text out.
    Lines,
    /// A triangle to the right.
    Play,
    /// A pair of bars.
    Pause,
    /// A folder.
    Open,
    /// A framed landscape.
    Image,
    /// A triangle with its middle lines.
    Mesh,
    /// An angle that points up.
    Up,
    /// An angle that points down.
    Down,
    /// A pencil: draw.
    Pencil,
    /// Arrows to four sides: move.
    Move,
    /// Scissors: cut.
    Scissors,
    /// A pair of halves beside a line: mirror.
    Mirror,
    /// A drop: colour.
    Drop,
    /// A check mark.
    Done,
}

/// Adds a square button; `name` is its tooltip and its name for screen readers.
pub fn button(ui: &mut Ui, icon: Icon, name: &str, enabled: bool) -> Response {
    let side = ui.spacing().interact_size.y.max(28.0);
    let sense = if enabled {
        Sense::click()
    } else {
        Sense::hover()
    };
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(side), sense);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, enabled, name));
    if ui.is_rect_visible(rect) {
        let palette = theme::palette(ui.visuals());
        let colour = if !enabled {
            palette.weak.gamma_multiply(0.45)
        } else if response.hovered() || response.has_focus() {
            ui.painter()
                .rect_filled(rect, f32::from(theme::ROUND), palette.hover);
            palette.strong
        } else {
            palette.text
        };
        paint(ui.painter(), icon, rect.center(), Stroke::new(1.5, colour));
        theme::ring(ui, &response);
    }
    if enabled {
        response.on_hover_text(name)
    } else {
        response
    }
}

/// Draws an icon around a point.
pub fn paint(painter: &Painter, icon: Icon, at: Pos2, stroke: Stroke) {
    let line = |points: &[(f32, f32)]| {
        let points = points.iter().map(|(x, y)| at + vec2(*x, *y)).collect();
        painter.add(Shape::line(points, stroke));
    };
    match icon {
        Icon::Undo | Icon::Redo => {
            let side = if icon == Icon::Undo { 1.0 } else { -1.0 };
            let bend: Vec<(f32, f32)> = (0..=12)
                .map(|step| {
                    let angle = (-90.0 + 180.0 * step as f64 / 12.0).to_radians();
                    let (y, x) = (libm::sin(angle) as f32, libm::cos(angle) as f32);
                    (side * (1.5 + 4.0 * x), 1.0 + 4.0 * y)
                })
                .collect();
            let mut path = vec![(side * -5.5, -3.0)];
            path.extend(bend);
            path.push((side * -2.0, 5.0));
            line(&path);
            line(&[(side * -2.5, -6.0), (side * -5.5, -3.0), (side * -2.5, 0.0)]);
        }
        Icon::Theme => {
            painter.circle_stroke(at, 6.0, stroke);
            let mut half: Vec<Pos2> = (0..=16)
                .map(|step| {
                    let angle = (-90.0 + 180.0 * step as f64 / 16.0).to_radians();
                    at + 6.0 * vec2(libm::cos(angle) as f32, libm::sin(angle) as f32)
                })
                .collect();
            half.push(half[0]);
            painter.add(Shape::convex_polygon(half, stroke.color, Stroke::NONE));
        }
        Icon::Help => {
            painter.circle_stroke(at, 7.0, stroke);
            let font = egui::FontId::proportional(12.0);
            painter.text(
                at + vec2(0.0, 0.5),
                egui::Align2::CENTER_CENTER,
                "?",
                font,
                stroke.color,
            );
        }
        Icon::Save => {
            line(&[(0.0, -6.5), (0.0, 2.0)]);
            line(&[(-3.5, -1.5), (0.0, 2.0), (3.5, -1.5)]);
            line(&[(-6.0, 2.5), (-6.0, 6.0), (6.0, 6.0), (6.0, 2.5)]);
        }
        Icon::Home => {
            line(&[(-6.5, 0.0), (0.0, -6.0), (6.5, 0.0)]);
            line(&[(-4.5, -1.5), (-4.5, 6.0), (4.5, 6.0), (4.5, -1.5)]);
        }
        Icon::Frame => {
            for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                line(&[(6.0 * x, 2.5 * y), (6.0 * x, 6.0 * y), (2.5 * x, 6.0 * y)]);
            }
        }
        Icon::Add => {
            line(&[(-4.5, 0.0), (4.5, 0.0)]);
            line(&[(0.0, -4.5), (0.0, 4.5)]);
        }
        Icon::More => {
            for x in [-5.0, 0.0, 5.0] {
                painter.circle_filled(at + vec2(x, 0.0), 1.6, stroke.color);
            }
        }
        Icon::Lines => {
            line(&[(-6.0, -5.0), (6.0, -5.0)]);
            line(&[(-2.0, -1.5), (6.0, -1.5)]);
            line(&[(-2.0, 2.0), (3.0, 2.0)]);
            line(&[(-6.0, 5.5), (1.0, 5.5)]);
        }
        Icon::Play => {
            let corners = [(-4.0, -6.0), (6.5, 0.0), (-4.0, 6.0)];
            let corners = corners.map(|(x, y)| at + vec2(x, y)).to_vec();
            painter.add(Shape::convex_polygon(corners, stroke.color, Stroke::NONE));
        }
        Icon::Pause => {
            for x in [-3.0, 3.0] {
                let bar = Rect::from_center_size(at + vec2(x, 0.0), vec2(3.0, 11.0));
                painter.rect_filled(bar, 1.0, stroke.color);
            }
        }
        Icon::Open => {
            line(&[
                (-6.5, 5.0),
                (-6.5, -5.0),
                (-2.5, -5.0),
                (-1.0, -3.0),
                (5.0, -3.0),
                (5.0, -0.5),
            ]);
            line(&[
                (-6.5, 5.0),
                (-4.0, -0.5),
                (7.5, -0.5),
                (5.0, 5.0),
                (-6.5, 5.0),
            ]);
        }
        Icon::Image => {
            line(&[
                (-5.0, -4.0),
                (5.0, -4.0),
                (5.0, 4.0),
                (-5.0, 4.0),
                (-5.0, -4.0),
            ]);
            line(&[
                (-5.0, 3.0),
                (-1.5, -0.5),
                (1.0, 2.0),
                (2.5, 0.5),
                (5.0, 3.0),
            ]);
        }
        Icon::Mesh => {
            line(&[(-5.0, 4.0), (0.0, -5.0), (5.0, 4.0), (-5.0, 4.0)]);
            line(&[(-2.5, -0.5), (2.5, -0.5), (0.0, 4.0), (-2.5, -0.5)]);
        }
        Icon::Pencil => {
            line(&[
                (-6.5, 6.5),
                (-5.0, 1.5),
                (3.5, -7.0),
                (7.0, -3.5),
                (-1.5, 5.0),
                (-6.5, 6.5),
            ]);
            line(&[(1.5, -5.0), (5.0, -1.5)]);
        }
        Icon::Move => {
            line(&[(-7.0, 0.0), (7.0, 0.0)]);
            line(&[(0.0, -7.0), (0.0, 7.0)]);
            for side in [-1.0, 1.0] {
                line(&[(side * 4.5, -2.5), (side * 7.0, 0.0), (side * 4.5, 2.5)]);
                line(&[(-2.5, side * 4.5), (0.0, side * 7.0), (2.5, side * 4.5)]);
            }
        }
        Icon::Scissors => {
            line(&[(-5.5, -7.0), (3.2, 3.0)]);
            line(&[(5.5, -7.0), (-3.2, 3.0)]);
            for x in [-4.4, 4.4] {
                painter.circle_stroke(at + vec2(x, 5.0), 2.4, stroke);
            }
        }
        Icon::Mirror => {
            for y in [-6.5, -2.2, 2.2, 6.5] {
                line(&[(0.0, y - 0.9), (0.0, y + 0.9)]);
            }
            for side in [-1.0, 1.0] {
                line(&[
                    (side * 3.0, -4.5),
                    (side * 7.5, 4.5),
                    (side * 3.0, 4.5),
                    (side * 3.0, -4.5),
                ]);
            }
        }
        Icon::Drop => {
            let round = (0..=16).map(|step| {
                let angle = (-30.0 + 240.0 * step as f64 / 16.0).to_radians();
                let (sine, cosine) = (libm::sin(angle) as f32, libm::cos(angle) as f32);
                (4.8 * cosine, 2.0 + 4.8 * sine)
            });
            let mut path = vec![(0.0, -7.5)];
            path.extend(round);
            path.push((0.0, -7.5));
            line(&path);
        }
        Icon::Done => line(&[(-6.0, 0.5), (-1.8, 5.0), (6.5, -5.0)]),
        Icon::Up => line(&[(-5.0, 2.5), (0.0, -2.5), (5.0, 2.5)]),
        Icon::Down => line(&[(-5.0, -2.5), (0.0, 2.5), (5.0, -2.5)]),
        Icon::Close => {
            line(&[(-4.0, -4.0), (4.0, 4.0)]);
            line(&[(-4.0, 4.0), (4.0, -4.0)]);
        }
    }
}

/// Draws the mark of the program: two balls that melt together.
pub fn mark(ui: &mut Ui) {
    let palette = theme::palette(ui.visuals());
    let (rect, _) = ui.allocate_exact_size(vec2(24.0, 24.0), Sense::hover());
    let painter = ui.painter();
    let (a, b) = (
        rect.center() + vec2(-4.0, 3.0),
        rect.center() + vec2(5.0, -4.0),
    );
    painter.circle_filled(a, 6.5, palette.accent);
    painter.circle_filled(b, 4.5, palette.accent);
    // The neck between them: the outer tangents, drawn in a little.
    let axis = (b - a).normalized();
    let side = vec2(-axis.y, axis.x);
    let neck = vec![
        a + side * 4.6,
        b + side * 3.0,
        b - side * 3.0,
        a - side * 4.6,
    ];
    painter.add(Shape::convex_polygon(neck, palette.accent, Stroke::NONE));
}
