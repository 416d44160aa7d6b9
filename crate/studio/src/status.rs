//! The strip at the bottom: progress and facts of the picture.

use crate::page::Page;
use crate::render::{Phase, Renderer, pass_label};
use crate::stage::StandIn;
use crate::wish::{ViewWish, Wishes};
use crate::{places, theme};
use browser::Backend;
use document::numerals::{count, duration};
use egui::{Align, Button, Color32, Layout, Rect, RichText, Sense, Ui, vec2};

/// Returns the state of the work in a few words. `reading` is the mesh file that is being read,
/// with the fraction done.
#[must_use]
pub fn summary(renderer: &Renderer, enabled: bool, reading: Option<(&str, f32)>) -> String {
    let progress = renderer.progress();
    if let Some(failure) = &progress.error {
        return failure.clone();
    }
    if let Some((name, fraction)) = reading {
        return match (fraction * 100.0).round() {
            percent if percent > 0.0 => format!("Reading {name} {percent:.0}%"),
            _ => format!("Reading {name}"),
        };
    }
    match renderer.phase() {
        Phase::Idle if !enabled => String::from("Not rendering"),
        Phase::Idle => String::from("Ready"),
        Phase::Waiting => String::from("Waiting for you to pause"),
        Phase::Tracing => {
            let mut text = format!("Tracing {:.0}%", progress.fraction * 100.0);
            if let Some(left) = progress.remaining_seconds {
                text.push_str(&format!(" · {} left", duration(left)));
            }
            text
        }
        Phase::Done => match renderer.timings().done {
            Some(seconds) => format!("Done in {}", duration(seconds)),
            None => String::from("Done"),
        },
        Phase::Cancelled => String::from("Stopped"),
    }
}

/// Shows the strip, with the stand-in for the traced picture.
pub fn show(
    page: &Page,
    stand_in: Option<&StandIn>,
    ui: &mut Ui,
    narrow: bool,
    wishes: &mut Wishes,
) {
    places::note(ui.ctx(), "status", ui.max_rect());
    let (renderer, reading) = (&page.renderer, page.reading.current());
    let enabled = page.work.session.is_enabled();
    let palette = theme::palette(ui.visuals());
    let progress = renderer.progress();
    let tracing = renderer.phase() == Phase::Tracing;
    let strip = ui.max_rect();
    if tracing {
        let width = strip.width() * progress.fraction.clamp(0.0, 1.0) as f32;
        let bar = Rect::from_min_size(strip.min, vec2(width, 2.0));
        ui.painter().rect_filled(bar, 0.0, palette.accent);
    }
    // Places are kept for optional widgets: egui draws twice more if a button is at a new place.
    ui.horizontal_centered(|ui| {
        ui.add_space(12.0);
        let state = ui.label(
            RichText::new(summary(renderer, enabled, reading))
                .color(palette.text)
                .size(13.0),
        );
        // Screen readers say when a picture begins and ends, not each part of it.
        ui.ctx().accesskit_node_builder(state.id, |node| {
            node.set_live(egui::accesskit::Live::Polite);
            if tracing {
                node.set_value("Tracing");
            }
        });
        if let (true, Some(pass), false) = (tracing, progress.pass, narrow) {
            ui.label(
                RichText::new(pass_label(pass))
                    .color(palette.weak)
                    .size(13.0),
            );
        } else {
            ui.skip_ahead_auto_ids(1);
        }
        let quiet = |text: &str| {
            Button::new(RichText::new(text).size(13.0).color(palette.accent))
                .fill(Color32::TRANSPARENT)
        };
        if matches!(renderer.phase(), Phase::Tracing | Phase::Waiting) {
            let stop = ui
                .add(quiet("Cancel"))
                .on_hover_text("Stop tracing this picture");
            if stop.clicked() {
                wishes.push(ViewWish::Cancel);
            }
        } else if matches!(renderer.phase(), Phase::Done | Phase::Cancelled) {
            let again = ui
                .add(quiet("Render again"))
                .on_hover_text("Trace the picture anew");
            if again.clicked() {
                wishes.push(ViewWish::Again);
            }
        } else {
            ui.skip_ahead_auto_ids(1);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(12.0);
            let on_screen = stand_in.map(|stand_in| {
                let (text, tip) = match stand_in {
                    StandIn::Draft { fps, meshed } => describe_draft(*fps, meshed, narrow),
                    StandIn::Kept => (
                        stand_in.id().to_owned(),
                        "This picture was traced when the example was made; yours is on its way"
                            .to_owned(),
                    ),
                };
                (text, tip)
            });
            for (text, tip) in facts(page, narrow).into_iter().chain(on_screen) {
                let text = RichText::new(text).color(palette.weak).size(12.5);
                let text = egui::WidgetText::from(text);
                let galley = text.into_galley(
                    ui,
                    Some(egui::TextWrapMode::Extend),
                    f32::INFINITY,
                    egui::TextStyle::Body,
                );
                // Facts without room beside the state are left out.
                if galley.size().x > ui.available_width() {
                    break;
                }
                let fact = ui.add(egui::Label::new(galley).sense(Sense::hover()));
                fact.on_hover_text(tip);
                ui.add_space(4.0);
            }
        });
    });
}

/// Returns facts about the picture with explanations, from right to left.
fn facts(page: &Page, narrow: bool) -> Vec<(String, String)> {
    let (renderer, backend) = (&page.renderer, page.screen.backend);
    let progress = renderer.progress();
    let mut facts = vec![(
        backend.label().to_owned(),
        String::from(match backend {
            Backend::WebGpu => "The window and the draft are drawn with WebGPU",
            Backend::WebGl2 => "The window and the draft are drawn with WebGL2",
            Backend::None => {
                "No graphics card here: the processor draws the window, without drafts"
            }
        }),
    )];
    if let Some(refusal) = &page.screen.refusal {
        let tip = format!(
            "The graphics card does not draw this model while it is turned ({refusal}); the \
             traced picture follows by itself"
        );
        facts.push((String::from("no draft"), tip));
    }
    if narrow {
        return facts;
    }
    let plural = if progress.workers == 1 { "" } else { "s" };
    let mut tip = String::from("Processors that trace the picture");
    if progress.restarted > 0 {
        tip.push_str(&format!("; {} had to be replaced", progress.restarted));
    }
    facts.push((format!("{} worker{plural}", progress.workers), tip));
    if let Some(image) = renderer.image() {
        let [width, height] = image.size;
        facts.push((
            format!("{width} × {height}"),
            String::from("Size of the picture in pixels"),
        ));
    }
    let stats = progress.stats;
    if stats.primary_rays > 0 {
        facts.push((
            format!("{} rays", count(stats.primary_rays + stats.shadow_rays)),
            format!(
                "{} rays from the eye, {} towards lights, {} field evaluations",
                count(stats.primary_rays),
                count(stats.shadow_rays),
                count(stats.field_evaluations)
            ),
        ));
    }
    facts
}

/// Names of bodies that the strip has room for.
const FEW: usize = 3;

/// Returns words on what the card draws, and how often a second.
fn describe_draft(fps: Option<u32>, meshed: &[String], narrow: bool) -> (String, String) {
    let mut text = match fps {
        Some(fps) => format!("draft, {fps} fps"),
        None => "draft".to_owned(),
    };
    let mut tip = String::from(
        "The graphics card draws the surface itself, until the traced picture is there",
    );
    if !meshed.is_empty() {
        if !narrow {
            text += &format!(" · {}", name_meshed(meshed, FEW));
        }
        tip += &format!("; {}", name_meshed(meshed, 10 * FEW));
    }
    (text, tip)
}

/// Word for a body without a name.
const UNNAMED: &str = "an unnamed body";

/// Says which bodies are drawn as meshes; of many only some.
fn name_meshed(meshed: &[String], most: usize) -> String {
    let names = meshed.iter().map(|name| match name.as_str() {
        "" => UNNAMED,
        name => name,
    });
    let mut names: Vec<&str> = names.collect();
    match names.as_slice() {
        [UNNAMED] => return "as a mesh".to_owned(),
        [name] => return format!("{name} as a mesh"),
        _ => {}
    }
    if names.len() > most {
        names.truncate(most);
        names.push("…");
    }
    format!("{} bodies as meshes: {}", meshed.len(), names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_drawn_as_meshes_have_names() {
        let names = ["A", "", "C", "D"].map(String::from);
        assert_eq!(name_meshed(&names[1..2], 3), "as a mesh");
        assert_eq!(name_meshed(&names[..1], 3), "A as a mesh");
        let some = "4 bodies as meshes: A, an unnamed body, C, …";
        assert_eq!(name_meshed(&names, 3), some);
        let (text, tip) = describe_draft(Some(60), &names, true);
        assert_eq!(text, "draft, 60 fps");
        assert!(tip.ends_with("C, D"), "{tip}");
    }
}
