//! The panel *Fit*: measured files, the mesh to fit, settings, and progress.

pub mod wish;

use crate::icon::{self, Icon};
use crate::page::{Moment, Page, Tab};
use crate::panel::Panel;
use crate::wish::{FitWish, TextWish, Wishes, WorkWish};
use crate::{places, screen, slider, theme};
use document::fitting::{Fitting, Surface, Target};
use egui::{Button, Context, Painter, Rect, RichText, Sense, Slider, Stroke, Ui, pos2, vec2};

/// Height of the panel beside the text.
pub const HEIGHT: f32 = 326.0;
/// Height of the plot on a wide page and on a narrow one.
const PLOT: [f32; 2] = [74.0, 56.0];

/// The panel.
pub struct FitPanel(pub Fitting);

impl FitPanel {
    /// Carries out a wish.
    pub fn act(&mut self, wish: FitWish, page: &mut Page, at: &Moment<'_>) {
        let (fitting, session) = (&mut self.0, &mut page.work.session);
        match wish {
            FitWish::Show(open) => {
                fitting.open = open;
                page.tab = if open { Tab::Fit } else { Tab::Text };
            }
            FitWish::Take { name, bytes } => {
                fitting.add(name, bytes);
                page.tab = Tab::Fit;
            }
            FitWish::Choose(file) => {
                if session.is_compiled() {
                    fitting.choose(session, &file);
                }
            }
            FitWish::Start => fitting.start(session, at.now),
            FitWish::Stop => {
                fitting.stop(session, at.now);
                session.compile();
            }
        }
    }

    /// Shows the button that shows and hides the panel.
    pub fn button(&self, ui: &mut Ui, wishes: &mut Wishes) {
        let palette = theme::palette(ui.visuals());
        let colour = if self.0.open {
            palette.accent
        } else {
            palette.text
        };
        let button = ui.add(Button::new(RichText::new("Fit").size(12.5).color(colour)));
        places::note(ui.ctx(), "fit", button.rect);
        let button = button.on_hover_text("Bring a mesh onto measured points and outlines");
        if button.clicked() {
            wishes.push(FitWish::Show(!self.0.open));
        }
    }
}

impl Panel for FitPanel {
    fn show(&mut self, page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
        let palette = theme::palette(ui.visuals());
        places::note(ui.ctx(), "fit panel", ui.max_rect());
        let targets = self.0.targets.clone();
        ui.horizontal(|ui| {
            ui.label(
                RichText::new("Fit to measurements")
                    .size(12.5)
                    .color(palette.weak),
            );
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if icon::button(ui, Icon::Close, "Close", true).clicked() {
                    wishes.push(FitWish::Show(false));
                }
            });
        });
        files(&mut self.0, ui, wishes);
        target(&mut self.0, ui, &targets);
        kind(&mut self.0, ui);
        weights(&mut self.0, ui, &targets);
        buttons(
            &mut self.0,
            page.work.session.can_undo(),
            ui,
            &targets,
            wishes,
        );
        progress(&self.0, ui);
    }

    fn tick(&mut self, page: &mut Page, at: &Moment<'_>) {
        if self.0.tick(&mut page.work.session, at.now) {
            page.work.session.compile();
        }
        page.is_measuring = self.0.is_reading();
    }

    fn wait(&self, _page: &Page, now: f64) -> Option<f64> {
        self.0.wait(now)
    }

    fn forget(&mut self, _page: &mut Page, _ctx: &Context) {
        self.0.forget();
    }
}

fn files(fitting: &mut Fitting, ui: &mut Ui, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    let mut removed = None;
    ui.horizontal_wrapped(|ui| {
        for (index, file) in fitting.files.iter().enumerate() {
            let text = format!("{} · {}  ×", file.name, file.words());
            let chip = ui
                .add(Button::new(RichText::new(text).size(12.5)))
                .on_hover_text("Remove it");
            places::note(ui.ctx(), format!("measured {}", file.name), chip.rect);
            if chip.clicked() {
                removed = Some(index);
            }
        }
        if fitting.files.is_empty() {
            let hint = "Drop points (.ply .xyz) or outlines (.json) on the page, or";
            ui.label(RichText::new(hint).size(12.5).color(palette.weak));
        }
        let open = ui.add(Button::new(RichText::new("Open…").size(12.5)));
        places::note(ui.ctx(), "fit open", open.rect);
        if open.clicked() {
            wishes.push(WorkWish::PickFiles);
        }
    });
    if let Some(index) = removed {
        fitting.remove(index);
    }
}

fn target(fitting: &mut Fitting, ui: &mut Ui, targets: &[(Target, String)]) {
    let palette = theme::palette(ui.visuals());
    let Some((first, first_label)) = targets.first() else {
        let hint = "Open a mesh and write a mesh command; then it can be fitted.";
        ui.label(RichText::new(hint).size(12.5).color(palette.weak));
        return;
    };
    let chosen = targets
        .iter()
        .find(|(target, _)| Some(target) == fitting.target.as_ref());
    let label = chosen.map_or(first_label, |(_, label)| label);
    if targets.len() == 1 {
        fitting.target = Some(first.clone());
        ui.label(RichText::new(label).size(12.5));
        return;
    }
    let label = RichText::new(format!("{label}  ▾")).size(12.5);
    ui.menu_button(label, |ui| {
        for (target, label) in targets {
            let is_chosen = fitting.target.as_ref() == Some(target);
            if ui.selectable_label(is_chosen, label).clicked() {
                fitting.target = Some(target.clone());
            }
        }
    });
}

fn kind(fitting: &mut Fitting, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        for (surface, text, tip) in [
            (
                Surface::Explicit,
                "Facets",
                "Distances are measured to the nearest facet",
            ),
            (
                Surface::Triangular,
                "Thin shells",
                "The mesh stands for the implicit surface of thin shells around its facets",
            ),
            (
                Surface::Spherical,
                "Balls",
                "The mesh stands for the implicit surface of balls around its facets: \
                    thick where facets are large",
            ),
        ] {
            let button = ui
                .selectable_label(
                    fitting.settings.surface == surface,
                    RichText::new(text).size(12.5),
                )
                .on_hover_text(tip);
            places::note(ui.ctx(), format!("fit {text}").to_lowercase(), button.rect);
            if button.clicked() {
                fitting.settings.surface = surface;
            }
        }
    });
}

fn weights(fitting: &mut Fitting, ui: &mut Ui, targets: &[(Target, String)]) {
    let is_new = match &fitting.target {
        Some(target) => matches!(target, Target::Mesh(_)),
        None => matches!(targets.first(), Some((Target::Mesh(_), _))),
    };
    let has_outlines = fitting.has_outlines();
    let settings = &mut fitting.settings;
    if is_new {
        let mut count = f64::from(settings.count);
        row(ui, "Control points", &mut count, 8.0..=240.0, |v| {
            format!("{v:.0}")
        });
        settings.count = count.round() as u32;
    }
    row(ui, "Smoothness", &mut settings.smooth, -4.0..=1.0, |v| {
        let weight = libm::exp(v * std::f64::consts::LN_10);
        format!("{weight:.2e}")
    });
    if has_outlines {
        row(ui, "Outlines", &mut settings.outlines, 0.0..=4.0, |v| {
            format!("{v:.2}")
        });
    }
}

/// Shows a name, a slider and its value.
fn row(
    ui: &mut Ui,
    name: &str,
    value: &mut f64,
    range: std::ops::RangeInclusive<f64>,
    words: impl Fn(f64) -> String,
) {
    ui.horizontal(|ui| {
        let height = ui.spacing().interact_size.y;
        let label = egui::Label::new(RichText::new(name).size(12.5));
        let left = egui::Layout::left_to_right(egui::Align::Center);
        ui.allocate_ui_with_layout(vec2(96.0, height), left, |ui| {
            ui.set_min_width(96.0);
            ui.add(label);
        });
        ui.scope(|ui| {
            slider::colours(ui);
            ui.spacing_mut().slider_width = (ui.available_width() - 74.0).clamp(60.0, 300.0);
            let slider = ui
                .add(Slider::new(value, range).show_value(false).smart_aim(false))
                .accessible_name(name);
            places::note(ui.ctx(), format!("fit {name}").to_lowercase(), slider.rect);
        });
        ui.label(RichText::new(words(*value)).size(12.5));
    });
}

fn buttons(
    fitting: &mut Fitting,
    can_undo: bool,
    ui: &mut Ui,
    targets: &[(Target, String)],
    wishes: &mut Wishes,
) {
    let palette = theme::palette(ui.visuals());
    ui.horizontal(|ui| {
        let running = fitting.is_running();
        let (text, command) = if running {
            ("Stop", FitWish::Stop)
        } else {
            ("Start", FitWish::Start)
        };
        let ready = running || (fitting.has_data() && !targets.is_empty());
        let label = RichText::new(text).color(palette.on_accent);
        let button = Button::new(label).fill(palette.accent);
        let button = ui.add_enabled(ready, button);
        places::note(ui.ctx(), "fit start", button.rect);
        if button.clicked() {
            wishes.push(command);
        }
        let back = ui.add_enabled(
            !running && fitting.last.is_some() && can_undo,
            Button::new("Take back"),
        );
        places::note(ui.ctx(), "fit back", back.rect);
        if back.clicked() {
            fitting.last = None;
            fitting.residuals.clear();
            wishes.push(TextWish::Undo);
        }
        let align = ui
            .checkbox(
                &mut fitting.settings.align,
                RichText::new("Turn and move first").size(12.5),
            )
            .on_hover_text("Brings the whole mesh close to the points before it is deformed");
        places::note(ui.ctx(), "fit align", align.rect);
    });
}

fn progress(fitting: &Fitting, ui: &mut Ui) {
    let palette = theme::palette(ui.visuals());
    let mut words = Vec::new();
    if let Some(last) = &fitting.last {
        words.push(format!(
            "iteration {} · residual {:.3e} · {:.0} % outliers",
            last.iteration,
            last.residual,
            100.0 * last.outliers
        ));
        let count = last.left_out.len();
        if count > 0 {
            words.push(format!("{count} points left out, drawn in orange"));
        }
    } else if fitting.is_running() {
        words.push(String::from("Preparing"));
    }
    let bad = match &fitting.message {
        Some((text, bad)) => {
            words.push(text.clone());
            *bad
        }
        None => false,
    };
    if !words.is_empty() {
        let colour = if bad { palette.error } else { palette.text };
        let label = ui.label(RichText::new(words.join(" · ")).size(12.5).color(colour));
        places::note(ui.ctx(), "fit words", label.rect);
    }
    if fitting.residuals.len() > 1 {
        let height = PLOT[usize::from(screen::is_narrow(ui.ctx()))];
        let size = vec2(ui.available_width(), height);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        places::note(ui.ctx(), "fit plot", rect);
        plot(ui.painter(), rect, &fitting.residuals, palette);
    }
}

/// Plots the residuals of all iterations on a logarithmic scale.
fn plot(painter: &Painter, rect: Rect, residuals: &[f64], palette: &theme::Palette) {
    painter.rect_filled(rect, 6.0, palette.paper);
    let logs = residuals.iter().map(|r| libm::log10(r.max(1e-300)));
    let low = logs.clone().fold(f64::INFINITY, f64::min);
    // At least a factor of two, so that a small change looks small.
    let high = logs.clone().fold(low + 0.3, f64::max);
    let inner = rect.shrink2(vec2(10.0, 10.0));
    let last = (residuals.len() - 1) as f32;
    let mut line = Vec::new();
    for (i, log) in logs.enumerate() {
        let share = ((log - low) / (high - low)) as f32;
        line.push(pos2(
            inner.left() + inner.width() * i as f32 / last,
            inner.bottom() - inner.height() * share,
        ));
    }
    let end = line[line.len() - 1];
    painter.line(line, Stroke::new(2.0, palette.accent));
    painter.circle_filled(end, 3.5, palette.accent);
    let font = egui::FontId::proportional(11.0);
    let [from, to] = [high, low].map(|log| libm::exp(log * std::f64::consts::LN_10));
    let corner = inner.right_top() - vec2(0.0, 4.0);
    painter.text(
        corner,
        egui::Align2::RIGHT_TOP,
        format!("residual {from:.1e} to {to:.1e}"),
        font,
        palette.weak,
    );
}
