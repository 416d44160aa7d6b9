//! The controls: tool, decay, refinements, region, stages.

use crate::brush::{Doing, round};
use crate::state::{Command, Flesh, Sculpting, Turning};
use egui::{Button, Color32, Rect, Response, RichText, ScrollArea, Sense, Slider, Ui, pos2, vec2};
use glam::{DQuat, DVec3};
use sculpt::{
    Constraint, Decay, Deletion, Form, MaskChange, Refinement, Region, RegionChange, Stroke,
};
use widgets::{places, screen, slider, theme};

/// A button that shows whether it is chosen.
fn chip(ui: &mut Ui, name: &str, is_chosen: bool, tip: &str) -> Response {
    let palette = theme::palette(ui.visuals());
    let (color, fill) = if is_chosen {
        (palette.on_accent, palette.accent)
    } else {
        (palette.text, palette.button)
    };
    let button = Button::new(RichText::new(name).size(13.0).color(color)).fill(fill);
    let response = ui.add(button);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_chosen, name));
    note(ui, name, response.rect);
    response.on_hover_text(tip)
}

fn note(ui: &Ui, name: &str, rect: Rect) {
    places::note(ui.ctx(), format!("sculpt {}", name.to_lowercase()), rect);
}

fn heading(ui: &mut Ui, text: &str) {
    let palette = theme::palette(ui.visuals());
    ui.add_space(8.0);
    ui.label(RichText::new(text).size(12.5).color(palette.weak));
}

/// The tools side by side, for a narrow page.
pub fn strip(place: &mut Sculpting, ui: &mut Ui, commands: &mut Vec<Command>) {
    ScrollArea::horizontal()
        .id_salt("sculpt strip")
        .scroll_bar_visibility(egui::scroll_area::ScrollBarVisibility::AlwaysHidden)
        .auto_shrink(false)
        .show(ui, |ui| {
            ui.horizontal_centered(|ui| {
                ui.add_space(8.0);
                ui.spacing_mut().item_spacing.x = 5.0;
                if chip(ui, "More", place.sheet, "Size, decay, refinement …").clicked() {
                    place.sheet = !place.sheet;
                }
                tools(place, ui);
                if chip(ui, "Divide", false, "Divide the region").clicked() {
                    place.carry_out(Stroke::Refine(Refinement::Propagate), commands);
                }
                ui.add_space(8.0);
            });
        });
}

fn tools(place: &mut Sculpting, ui: &mut Ui) {
    for doing in Doing::ALL {
        let is_chosen = place.brush.doing == doing;
        if chip(ui, doing.name(), is_chosen, doing.meaning()).clicked() {
            place.brush.doing = doing;
        }
    }
}

/// Shows the controls.
pub fn controls(place: &mut Sculpting, ui: &mut Ui, commands: &mut Vec<Command>) {
    ui.spacing_mut().item_spacing = vec2(5.0, 5.0);
    // A narrow page has the tools in its strip.
    if !screen::is_narrow(ui.ctx()) {
        ui.horizontal_wrapped(|ui| tools(place, ui));
    }
    tool(place, ui);
    decay(place, ui);
    symmetry(place, ui, commands);
    refinement(place, ui, commands);
    region(place, ui, commands);
    view(place, ui);
    flesh(place, ui, commands);
    ui.add_space(10.0);
}

fn label(text: &str, colour: Color32) -> RichText {
    RichText::new(text).size(12.5).color(colour)
}

fn tool(place: &mut Sculpting, ui: &mut Ui) {
    heading(ui, "Tool");
    ui.horizontal_wrapped(|ui| {
        for form in [Form::Sphere, Form::Box, Form::Cylinder] {
            let (name, tip) = match form {
                Form::Sphere => ("Ball", "An ellipsoid"),
                Form::Box => ("Block", "A box with rounded edges"),
                Form::Cylinder => ("Roll", "A cylinder"),
            };
            if chip(ui, name, place.brush.form == form, tip).clicked() {
                place.brush.set_form(form);
            }
        }
        if place.brush.doing == Doing::Paint {
            let color = ui.color_edit_button_rgb(&mut place.brush.color);
            note(ui, "color", color.rect);
        }
    });
    let palette = theme::palette(ui.visuals());
    let size = place.size;
    ui.scope(|ui| {
        slider::colours(ui);
        ui.spacing_mut().slider_width = 118.0;
        let own = Slider::new(&mut place.brush.size, 0.005 * size..=0.5 * size)
            .logarithmic(true)
            .max_decimals(4)
            .text(label("size", palette.text));
        let own = ui.add(own).on_hover_text("F, or [ and ]");
        note(ui, "size", own.rect);
        for (axis, name) in ["× x", "× y", "× z"].into_iter().enumerate() {
            let stretch = Slider::new(&mut place.brush.stretch[axis], 0.1..=5.0)
                .logarithmic(true)
                .max_decimals(2)
                .text(label(name, palette.text));
            ui.add(stretch)
                .on_hover_text("Scale along an axis of the tool (S, then X, Y or Z)");
        }
        for (i, name) in ["round, up", "round, about"].into_iter().enumerate() {
            let exponent = Slider::new(&mut place.brush.exponents[i], 0.05..=2.0)
                .max_decimals(2)
                .text(label(name, palette.text));
            ui.add(exponent).on_hover_text(
                "Exponent of the superquadric: small is square, 1 round, 2 an octahedron",
            );
        }
    });
    if place.brush.turn != DQuat::IDENTITY || place.brush.stretch != DVec3::ONE {
        let upright = chip(
            ui,
            "Upright",
            false,
            "The tool neither turned nor stretched",
        );
        if upright.clicked() {
            place.brush.turn = DQuat::IDENTITY;
            place.brush.stretch = DVec3::ONE;
        }
    }
    place.brush.size = round(place.brush.size, place.decimals).max(1e-6);
}

fn decay(place: &mut Sculpting, ui: &mut Ui) {
    heading(ui, "Decay over neighbours");
    ui.horizontal_wrapped(|ui| {
        for decay in Decay::ALL {
            curve(place, ui, decay);
        }
    });
    ui.scope(|ui| {
        slider::colours(ui);
        ui.spacing_mut().slider_width = 118.0;
        let range = Slider::new(&mut place.brush.range, 0.0..=6.0)
            .max_decimals(2)
            .text(RichText::new("range").size(12.5));
        let range = ui
            .add(range)
            .on_hover_text("How far a motion reaches along edges, in sizes of the tool (Shift+F)");
        note(ui, "range", range.rect);
    });
    ui.horizontal_wrapped(|ui| {
        for (constraint, name, tip) in [
            (
                Constraint::Normal,
                "Normal",
                "Only along the surface's normal",
            ),
            (Constraint::Tangent, "Tangent", "Only across it"),
        ] {
            let is_chosen = place.brush.constraint == Some(constraint);
            if chip(ui, name, is_chosen, tip).clicked() {
                place.brush.constraint = (!is_chosen).then_some(constraint);
            }
        }
        let only = place.brush.only_region;
        if chip(
            ui,
            "Only region",
            only,
            "The tool touches chosen faces only",
        )
        .clicked()
        {
            place.brush.only_region = !only;
        }
    });
}

/// A button with the curve of a decay function.
fn curve(place: &mut Sculpting, ui: &mut Ui, decay: Decay) {
    let palette = theme::palette(ui.visuals());
    let (rect, response) = ui.allocate_exact_size(vec2(44.0, 38.0), Sense::click());
    let is_chosen = place.brush.decay == decay;
    response.widget_info(|| {
        egui::WidgetInfo::selected(egui::Role::Button, true, is_chosen, decay.name())
    });
    let fill = match (is_chosen, response.hovered()) {
        (true, _) => palette.accent,
        (false, true) => palette.hover,
        (false, false) => palette.button,
    };
    let color = if is_chosen {
        palette.on_accent
    } else {
        palette.text
    };
    ui.painter()
        .rect_filled(rect, f32::from(theme::ROUND), fill);
    let points = (-20..=20).map(|i| {
        let t = f64::from(i) / 20.0;
        let high = decay.at(t.abs() * 1.001) as f32;
        pos2(
            rect.center().x + 17.0 * t as f32,
            rect.bottom() - 17.0 - 15.0 * high,
        )
    });
    let line = egui::Shape::line(points.collect(), egui::Stroke::new(1.4, color));
    ui.painter().add(line);
    ui.painter().text(
        rect.center_bottom() - vec2(0.0, 2.0),
        egui::Align2::CENTER_BOTTOM,
        decay.name(),
        egui::FontId::proportional(10.5),
        color,
    );
    note(ui, decay.name(), rect);
    if response.clicked() {
        place.brush.decay = decay;
    }
}

fn symmetry(place: &mut Sculpting, ui: &mut Ui, commands: &mut Vec<Command>) {
    heading(ui, "Mirrored in");
    let planes = place.document.clay().symmetry();
    ui.horizontal_wrapped(|ui| {
        for (axis, name) in ["x = 0", "y = 0", "z = 0"].into_iter().enumerate() {
            if chip(
                ui,
                name,
                planes[axis],
                "Repeats each stroke on the other side",
            )
            .clicked()
            {
                let mut planes = planes;
                planes[axis] = !planes[axis];
                place.carry_out(Stroke::Symmetry(planes), commands);
            }
        }
        if chip(ui, "Plane", place.planes, "Show the planes").clicked() {
            place.planes = !place.planes;
        }
    });
}

/// A button that carries out a stroke.
fn act(
    place: &mut Sculpting,
    ui: &mut Ui,
    name: &str,
    tip: &str,
    stroke: Stroke,
    commands: &mut Vec<Command>,
) {
    if chip(ui, name, false, tip).clicked() {
        place.carry_out(stroke, commands);
    }
}

fn refinement(place: &mut Sculpting, ui: &mut Ui, commands: &mut Vec<Command>) {
    let is_all = *place.document.clay().region() == Region::All;
    heading(
        ui,
        if is_all {
            "Refine all"
        } else {
            "Refine the region"
        },
    );
    ui.horizontal_wrapped(|ui| {
        for (name, tip, stroke) in [
            (
                "Divide",
                "Triangles become four; neighbours are divided so that all stay triangles (D)",
                Stroke::Refine(Refinement::Propagate),
            ),
            (
                "Divide here",
                "Neighbours stay one face and gain vertices",
                Stroke::Refine(Refinement::Local),
            ),
            (
                "Loop",
                "Smooths by Loop's subdivision (Shift+D)",
                Stroke::Loop(1),
            ),
            (
                "Average",
                "Smooths without new vertices",
                Stroke::Average(1, 0.5),
            ),
            (
                "Triangles",
                "Faces with more than three sides get a centre",
                Stroke::Refine(Refinement::Polygons),
            ),
            (
                "Centres",
                "Every face gets a centre",
                Stroke::Refine(Refinement::Centers),
            ),
            (
                "Simplify",
                "Removes half of the faces, first those that change the shape least",
                Stroke::Simplify(0.5),
            ),
            ("Fill holes", "Closes holes by a centre", Stroke::Fill),
            (
                "To a face",
                "The region becomes one face",
                Stroke::Delete(Deletion::Face),
            ),
            (
                "To a hole",
                "The region becomes a hole",
                Stroke::Delete(Deletion::Hole),
            ),
        ] {
            act(place, ui, name, tip, stroke, commands);
        }
    });
}

fn region(place: &mut Sculpting, ui: &mut Ui, commands: &mut Vec<Command>) {
    heading(ui, "Region and mask");
    ui.horizontal_wrapped(|ui| {
        for (name, tip, stroke) in [
            ("All", "All faces (A)", Stroke::Region(RegionChange::All)),
            (
                "None",
                "No face (Alt+A); then choose with Region",
                Stroke::Region(RegionChange::None),
            ),
            (
                "Others",
                "The others (I)",
                Stroke::Region(RegionChange::Invert),
            ),
            (
                "Grow",
                "The faces around, too",
                Stroke::Region(RegionChange::Grow(1)),
            ),
            (
                "Shrink",
                "Without those at the border",
                Stroke::Region(RegionChange::Shrink(1)),
            ),
            (
                "Unmask",
                "All vertices are free",
                Stroke::Masks(MaskChange::Clear),
            ),
            (
                "Swap mask",
                "Swaps the vertices that are held with the free ones",
                Stroke::Masks(MaskChange::Invert),
            ),
        ] {
            act(place, ui, name, tip, stroke, commands);
        }
    });
}

fn view(place: &mut Sculpting, ui: &mut Ui) {
    heading(ui, "Dragging beside the mesh turns");
    ui.horizontal_wrapped(|ui| {
        for (turning, name, tip) in [
            (Turning::View, "the view", "You go around the mesh"),
            (Turning::Mesh, "the mesh", "The mesh turns in the light"),
            (Turning::Tool, "the tool", "The tool turns (R)"),
            (
                Turning::Light,
                "the light",
                "Turns the light around the mesh, and with it the tool's shadow",
            ),
        ] {
            if chip(ui, name, place.turning == turning, tip).clicked() {
                place.turning = turning;
            }
        }
        if chip(ui, "Wireframe", place.wireframe, "Show the edges (W)").clicked() {
            place.wireframe = !place.wireframe;
        }
    });
}

fn flesh(place: &Sculpting, ui: &mut Ui, commands: &mut Vec<Command>) {
    heading(ui, "In the model it is");
    ui.horizontal_wrapped(|ui| {
        for (flesh, name, tip) in [
            (Flesh::Hard, "a hard mesh", "The triangles themselves"),
            (
                Flesh::Convolved,
                "flesh",
                "Each triangle is a skeleton that flesh grows on; \
                 meshes of many faces take long to trace",
            ),
            (
                Flesh::Metaballs,
                "metaballs",
                "A soft shell around the triangles",
            ),
        ] {
            if chip(ui, name, false, tip).clicked() {
                let edge = place.mean_edge();
                commands.push(Command::Grow { flesh, edge });
            }
        }
        let tip = "Bring the mesh onto measured points or outlines, by control points around it";
        if chip(ui, "Fit this to points", false, tip).clicked() {
            commands.push(Command::Fit);
        }
    });
}

/// The strip of stages to go back to.
pub fn stages(place: &mut Sculpting, ui: &mut Ui, commands: &mut Vec<Command>) {
    let palette = theme::palette(ui.visuals());
    let stages = place.document.stages();
    let [done, undone] = place.depth();
    ScrollArea::horizontal()
        .id_salt("sculpt stages")
        .scroll_bar_visibility(egui::scroll_area::ScrollBarVisibility::AlwaysHidden)
        .auto_shrink(false)
        .show(ui, |ui| {
            ui.horizontal_centered(|ui| {
                ui.add_space(10.0);
                ui.spacing_mut().item_spacing.x = 5.0;
                ui.label(RichText::new("Stages").size(12.5).color(palette.weak));
                let mut wanted = None;
                if chip(ui, "Start", done == 0, "The mesh before the first stroke").clicked() {
                    wanted = Some(0);
                }
                for (number, (name, count)) in (1..).zip(&stages) {
                    let shown: String = name.chars().take(26).collect();
                    let response = chip(ui, &shown, *count == done, name);
                    places::note(ui.ctx(), format!("sculpt stage {number}"), response.rect);
                    if response.clicked() {
                        wanted = Some(*count);
                    }
                }
                if undone > 0 {
                    let name = format!("+{undone} undone");
                    let button = Button::new(RichText::new(name).size(12.5).color(palette.weak))
                        .fill(Color32::TRANSPARENT);
                    let response = ui.add(button).on_hover_text("Redo all of it");
                    places::note(ui.ctx(), "sculpt last", response.rect);
                    if response.clicked() {
                        wanted = Some(done + undone);
                    }
                }
                let add = chip(
                    ui,
                    "+ Stage",
                    false,
                    "Keep what there is as a stage to go back to",
                );
                places::note(ui.ctx(), "sculpt add stage", add.rect);
                if add.clicked() {
                    let name = format!("stage {}", stages.len() + 1);
                    place.carry_out(Stroke::Stage(name), commands);
                }
                if let Some(wanted) = wanted {
                    place.go_to(wanted, commands);
                }
                ui.add_space(8.0);
            });
        });
}
