//! Painting over the picture while drawing: the flesh of a stroke, bones and knobs, the hint.

use super::tool::Tool;
use crate::places;
use egui::epaint::{Mesh, PathShape};
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Ui, Vec2, pos2, vec2};
use glam::DVec3;
use scene::Rgb;
use sketch::Drawn;
use sketch::Sample;
use sketch::Sight;

/// The colour of bones and knobs.
const LIT: Color32 = Color32::from_rgb(255, 222, 122);
/// Most samples of a tube that are drawn.
const MOST: usize = 240;

/// The emphasis of a knob.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    /// None.
    Plain,
    /// The emphasis of the knob under the pointer.
    Over,
    /// The emphasis of the knob that was touched last.
    Chosen,
}

/// Returns a colour at a brightness and an opacity.
fn shade(colour: Rgb, light: f32, alpha: f32) -> Color32 {
    let [r, g, b] = colour.map(|c| ((c * light).clamp(0.0, 1.0) * 255.0) as u8);
    Color32::from_rgb(r, g, b).gamma_multiply(alpha)
}

/// Paints a tube through samples, shaded from the middle to the rim.
pub fn tube(painter: &Painter, sight: &Sight, samples: &[Sample], colour: Rgb, alpha: f32) {
    let step = samples.len().div_ceil(MOST).max(1);
    let last = samples.len().saturating_sub(1);
    let few = samples.iter().enumerate();
    let few = few.filter(|(i, _)| i % step == 0 || *i == last);
    let discs: Vec<(Pos2, f32)> = few
        .filter_map(|(_, sample)| {
            let at = sight.screen(sample.position)?;
            let radius = (sample.radius / sight.point(sample.position)) as f32;
            Some((at, radius.clamp(0.5, 4000.0)))
        })
        .collect();
    // From the rim to the lit line along the middle.
    for (share, off, light) in [
        (1.0, 0.0, 0.55),
        (0.8, 0.08, 0.85),
        (0.5, 0.2, 1.1),
        (0.2, 0.3, 1.35),
    ] {
        ribbon(painter, &discs, share, off, shade(colour, light, alpha));
    }
}

/// Paints a band through discs, which are shrunk to a share of their radii and moved towards the
/// light by `off` radii.
fn ribbon(painter: &Painter, discs: &[(Pos2, f32)], share: f32, off: f32, colour: Color32) {
    let discs: Vec<(Pos2, f32)> = discs
        .iter()
        .map(|&(at, radius)| (at + vec2(-0.5, -0.85) * off * radius, radius * share))
        .collect();
    for &(at, radius) in discs.first().into_iter().chain(discs.last()) {
        painter.circle_filled(at, radius, colour);
    }
    let mut mesh = Mesh::default();
    for pair in discs.windows(2) {
        let [(a, r), (b, s)] = [pair[0], pair[1]];
        let along = b - a;
        if along.length() < 0.2 {
            continue;
        }
        let across = along.normalized().rot90();
        let first = mesh.vertices.len() as u32;
        for corner in [
            a + across * r,
            a - across * r,
            b + across * s,
            b - across * s,
        ] {
            mesh.colored_vertex(corner, colour);
        }
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first + 1, first + 2, first + 3);
        // The joint to the piece before.
        if first >= 4 {
            mesh.add_triangle(first - 2, first, first + 1);
            mesh.add_triangle(first - 1, first, first + 1);
        }
    }
    painter.add(Shape::mesh(mesh));
}

/// Paints the flesh of a skeleton roughly, while there is no picture of it.
pub fn flesh(painter: &Painter, sight: &Sight, drawn: &Drawn) {
    for [(a, r), (b, s)] in drawn.limbs() {
        let ends = [(a, r), (b, s)].map(|(position, radius)| Sample { position, radius });
        let seen = ends.map(|end| {
            let radius = (end.radius / sight.point(end.position)) as f32;
            Some((sight.screen(end.position)?, radius.clamp(0.5, 4000.0)))
        });
        if let [Some(p), Some(q)] = seen {
            let colour = shade(drawn.colour, 0.9, 1.0);
            painter.circle_filled(p.0, p.1, colour);
            painter.circle_filled(q.0, q.1, colour);
            ribbon(painter, &[p, q], 1.0, 0.0, colour);
        }
    }
}

/// Paints the curves and knobs of a skeleton.
pub fn bones(
    painter: &Painter,
    sight: &Sight,
    drawn: &Drawn,
    tool: Tool,
    light: impl Fn(usize) -> Light,
) {
    let alpha = match (tool, drawn.block.is_some()) {
        (_, false) => 0.2,
        (Tool::Draw, true) => 0.35,
        _ => 0.8,
    };
    let lines: Vec<[DVec3; 2]> = drawn.limbs().map(|[(a, _), (b, _)]| [a, b]).collect();
    for (width, colour) in [(3.2, Color32::from_black_alpha(90)), (1.4, LIT)] {
        let stroke = Stroke::new(width, colour.gamma_multiply(alpha));
        for [a, b] in &lines {
            if let Some(line) = sight.line(*a, *b) {
                painter.line_segment(line, stroke);
            }
        }
    }
    if drawn.block.is_none() {
        return;
    }
    for (node, (knob, _)) in drawn.knobs.iter().enumerate() {
        let Some(at) = sight.screen(*knob) else {
            continue;
        };
        let light = light(node);
        let size = match (tool, light) {
            (Tool::Draw, _) if !drawn.is_end(node) => continue,
            (Tool::Draw, Light::Plain) => 3.5,
            (Tool::Draw, _) => 6.0,
            (_, Light::Plain) => 5.0,
            (_, Light::Over) => 7.0,
            (_, Light::Chosen) => 7.5,
        };
        let fill = if light == Light::Chosen {
            Color32::WHITE
        } else {
            LIT
        };
        painter.circle(
            at,
            size,
            fill,
            Stroke::new(1.8, Color32::from_black_alpha(170)),
        );
    }
}

/// Paints the circle of a node's radius, and the knob on it.
pub fn rim(painter: &Painter, center: Pos2, rim: Pos2) {
    let radius = center.distance(rim);
    for (width, colour) in [(3.0, Color32::from_black_alpha(100)), (1.4, Color32::WHITE)] {
        painter.circle_stroke(center, radius, Stroke::new(width, colour));
    }
    painter.circle(
        rim,
        5.0,
        Color32::WHITE,
        Stroke::new(1.8, Color32::from_black_alpha(170)),
    );
}

/// Paints the line of a cut.
pub fn knife(painter: &Painter, stroke: &sketch::Stroke) {
    let line: Vec<Pos2> = stroke
        .marks()
        .iter()
        .map(|m| pos2(m.at[0], m.at[1]))
        .collect();
    painter.add(PathShape::line(
        line.clone(),
        Stroke::new(4.0, Color32::from_black_alpha(120)),
    ));
    painter.add(PathShape::line(
        line,
        Stroke::new(1.8, Color32::from_rgb(255, 110, 90)),
    ));
}

/// Paints the brush at the pointer.
pub fn brush(painter: &Painter, at: Pos2, radius: f32) {
    painter.circle_stroke(at, radius, Stroke::new(2.6, Color32::from_black_alpha(80)));
    painter.circle_stroke(at, radius, Stroke::new(1.2, Color32::from_white_alpha(200)));
}

/// Paints a line of text at the top of the picture.
pub fn hint(ui: &Ui, rect: Rect, text: &str) {
    let painter = ui.painter().with_clip_rect(rect);
    let font = FontId::proportional(13.5);
    let width = (rect.width() - 36.0).max(60.0);
    let galley = painter.layout(text.to_owned(), font, Color32::from_gray(245), width);
    let at = rect.center_top() + vec2(0.0, 10.0);
    let place = Align2::CENTER_TOP.anchor_size(at, galley.size() + Vec2::new(22.0, 11.0));
    painter.rect_filled(place, 9.0, Color32::from_black_alpha(150));
    painter.galley(place.center() - galley.size() / 2.0, galley, Color32::WHITE);
    places::note(ui.ctx(), "draw hint", place);
}
