//! Layout of the page. Wide: text on the left, picture on the right, with a split that can be
//! dragged. Narrow: the picture on top, and text, sliders and problems in turn below.

use crate::app::{App, Dialog, StandIn, Tab};
use crate::command::Command;
use crate::hands::Around;
use crate::icon::{self, Icon};
use crate::render::Phase;
use crate::settings::Show;
use crate::theme::{self, STRIP};
use crate::view::{self, Grasp, Scenery};
use crate::{
    bar, download, files, fit_panel, intake, lamp, notice, pencil, places, platform, problems,
    screen, size, sliders, status, timeline, tray,
};
use egui::{
    Align, Button, CentralPanel, Color32, Context, Frame, Layout, Margin, Panel, Popup, Rect,
    RichText, ScrollArea, Stroke, Ui, Vec2, pos2, vec2,
};

/// Draws everything.
pub fn show(app: &mut App, ui: &mut Ui, commands: &mut Vec<Command>) {
    places::clear(ui.ctx());
    if app.lab.is_open() {
        let busy = app.renderer.phase() == Phase::Tracing;
        let frame = lab::Frame {
            dataset: app.work.session.dataset(),
            tracing: busy.then(|| app.renderer.progress().fraction),
            theme: app.settings.theme,
            now: platform::now(ui.ctx()),
        };
        let mut wishes = Vec::new();
        lab::show(&mut app.lab, &frame, ui, &mut wishes);
        commands.extend(wishes.into_iter().filter_map(Command::of_lab));
        return;
    }
    if app.sculpts() {
        let all = ui.max_rect();
        app.sculpt(ui, commands);
        if let Some(notice) = &app.notice {
            notice::show(ui, all, notice, commands);
        }
        dialogs(app, ui.ctx(), commands);
        return;
    }
    let narrow = screen::is_narrow(ui.ctx());
    let palette = theme::palette(ui.visuals());
    let line = Stroke::new(1.0, palette.line);
    let flat = Frame::new().fill(palette.panel);
    let bar_height = if narrow { 52.0 } else { 46.0 };
    Panel::top("bar")
        .exact_size(bar_height)
        .frame(flat)
        .show(ui, |ui| {
            bar::show(app, ui, narrow, commands);
        });
    Panel::bottom("status")
        .exact_size(if narrow { 40.0 } else { 32.0 })
        .frame(flat)
        .show(ui, |ui| {
            let enabled = app.work.session.is_enabled();
            places::note(ui.ctx(), "status", ui.max_rect());
            let reading = app.reading.current();
            status::show(
                ui,
                &app.renderer,
                (app.backend, app.stand_in),
                enabled,
                reading,
                narrow,
                commands,
            );
        });
    if narrow {
        narrow_page(app, ui, commands);
    } else {
        let width = ui.available_width();
        let panel = Panel::left("text")
            .default_size((width * app.settings.split).clamp(300.0, 640.0))
            .size_range(260.0..=(width - 260.0).max(260.0))
            .show_separator_line(true)
            .frame(flat);
        let side = panel.show(ui, |ui| text_side(app, ui, commands));
        app.settings.split = (side.response.rect.width() / width.max(1.0)).clamp(0.15, 0.85);
        CentralPanel::no_frame().show(ui, |ui| {
            let all = ui.max_rect();
            let head = Rect::from_min_size(all.min, vec2(all.width(), STRIP));
            picture_head(app, ui, head, commands);
            ui.painter().hline(all.x_range(), head.bottom(), line);
            stage(
                app,
                ui,
                Rect::from_min_max(head.left_bottom(), all.max),
                commands,
            );
        });
    }
    dialogs(app, ui.ctx(), commands);
    drop_hint(ui.ctx());
}

/// Shows the left side of a wide page: files, text, sliders, problems.
fn text_side(app: &mut App, ui: &mut Ui, commands: &mut Vec<Command>) {
    let palette = theme::palette(ui.visuals());
    let inset = Frame::new()
        .fill(palette.panel)
        .inner_margin(Margin::symmetric(12, 8));
    Panel::top("files")
        .exact_size(STRIP)
        .frame(Frame::new().fill(palette.panel))
        .show(ui, |ui| {
            files::show(ui, &app.work.session, &mut app.editor, true, commands)
        });
    if !app.work.session.diagnostics().is_empty() {
        Panel::bottom("problems")
            .resizable(true)
            .default_size(130.0)
            .size_range(64.0..=420.0)
            .frame(inset)
            .show(ui, |ui| problem_list(app, ui, commands));
    }
    if app.fitting.open {
        Panel::bottom("fit")
            .exact_size(fit_panel::HEIGHT)
            .frame(inset)
            .show(ui, |ui| fit_panel::show(app, ui, commands));
    }
    if !app.work.session.compilation().hot.is_empty() {
        let rows = sliders::height(ui, &app.work.session.compilation().hot);
        let most = (0.4 * ui.available_height()).clamp(60.0, 260.0);
        Panel::bottom("sliders")
            .exact_size(rows.min(most) + 42.0)
            .frame(inset)
            .show(ui, |ui| slider_list(app, ui, commands));
    }
    CentralPanel::no_frame().show(ui, |ui| text_or_asset(app, ui, commands));
}

/// Shows the editor, or the image or mesh whose tab is open.
fn text_or_asset(app: &mut App, ui: &mut Ui, commands: &mut Vec<Command>) {
    let assets = app.work.session.assets();
    let shown = app.editor.asset.as_ref();
    match shown.and_then(|name| assets.iter().find(|asset| asset.name == *name)) {
        Some(asset) => {
            if app.asset_view.show(ui, asset, commands) {
                app.editor.asset = None;
            }
        }
        None => {
            app.editor.asset = None;
            places::note(ui.ctx(), "editor", ui.available_rect_before_wrap());
            let hints = app.settings.hints;
            app.editor.lit = app.hands.lit(&app.work.session);
            if app.is_short_of_time() {
                ui.visuals_mut().text_cursor.blink = false;
            }
            app.editor.show(ui, &app.work.session, hints, commands);
        }
    }
}

/// Shows the accepted kinds of files while files are dragged over the page.
fn drop_hint(ctx: &Context) {
    if ctx.input(|input| input.raw.hovered_files.is_empty()) {
        return;
    }
    let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("drop hint"));
    let painter = ctx.layer_painter(layer);
    let palette = theme::palette(&ctx.global_style().visuals);
    let place = ctx.content_rect();
    painter.rect_filled(place, 0.0, palette.stage.gamma_multiply(0.85));
    let edge = Stroke::new(2.0, palette.accent);
    painter.rect_stroke(place.shrink(14.0), 10.0, edge, egui::StrokeKind::Inside);
    let text = format!("Drop {} here", intake::KINDS);
    let font = egui::FontId::proportional(17.0);
    let width = place.width() - 60.0;
    let galley = painter.layout(text, font, palette.strong, width);
    painter.galley(place.center() - galley.size() / 2.0, galley, palette.strong);
}

fn problem_list(app: &App, ui: &mut Ui, commands: &mut Vec<Command>) {
    places::note(ui.ctx(), "problems", ui.max_rect());
    ScrollArea::vertical()
        .id_salt("problems")
        .min_scrolled_height(0.0)
        .auto_shrink(false)
        .show(ui, |ui| {
            let session = &app.work.session;
            problems::show(ui, session.project(), session.diagnostics(), commands);
        });
}

fn slider_list(app: &mut App, ui: &mut Ui, commands: &mut Vec<Command>) {
    let palette = theme::palette(ui.visuals());
    places::note(ui.ctx(), "sliders", ui.max_rect());
    if !screen::is_narrow(ui.ctx()) {
        ui.label(RichText::new("Sliders").size(12.5).color(palette.weak))
            .on_hover_text("Variables marked hot in the text");
    }
    ScrollArea::vertical()
        .id_salt("sliders")
        .min_scrolled_height(0.0)
        .auto_shrink(false)
        .show(ui, |ui| {
            let hot = &app.work.session.compilation().hot;
            app.sliders.show(ui, hot, commands);
        });
}

/// Shows the strip above the picture: draft or picture, size, download.
fn picture_head(app: &App, ui: &mut Ui, place: Rect, commands: &mut Vec<Command>) {
    let palette = theme::palette(ui.visuals());
    ui.painter().rect_filled(place, 0.0, palette.panel);
    let part = places::part("picture head", place);
    let mut ui = ui.new_child(part.layout(Layout::left_to_right(Align::Center)));
    ui.add_space(10.0);
    if app.draft.is_some() {
        show_choice(app, &mut ui, commands);
    }
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        ui.add_space(10.0);
        let tip = "Download: picture (Ctrl+S), project";
        let save = icon::button(ui, Icon::Save, tip, true);
        places::note(ui.ctx(), "download", save.rect);
        Popup::menu(&save).show(|ui| download::menu(app, ui, commands));
        if icon::button(ui, Icon::Frame, "See the whole model", true).clicked() {
            commands.push(Command::ShowAll);
        }
        size_menu(app, ui, commands);
        if fit_panel::is_offered(app) {
            fit_panel::button(app, ui, commands);
        }
        reset_view(app, ui, commands);
    });
}

fn show_choice(app: &App, ui: &mut Ui, commands: &mut Vec<Command>) {
    let palette = theme::palette(ui.visuals());
    let layout = Layout::left_to_right(Align::Center);
    let background = ui.painter().add(egui::Shape::Noop);
    let choices = ui.allocate_ui_with_layout(vec2(10.0, 22.0), layout, |ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.spacing_mut().interact_size.y = 22.0;
        ui.spacing_mut().button_padding.y = 1.0;
        for (show, text, tip) in [
            (
                Show::Auto,
                "Auto",
                "The draft while you edit and turn, then the traced picture",
            ),
            (
                Show::Draft,
                "Draft",
                "Only the instant draft: shapes before they melt together; \
                    once you turn or drag, a mesh of the surface if it comes soon enough",
            ),
            (Show::Traced, "Traced", "Only the ray-traced picture"),
        ] {
            let chosen = app.settings.show == show;
            let colour = if chosen { palette.strong } else { palette.weak };
            let button = Button::new(RichText::new(text).size(12.5).color(colour))
                .corner_radius(theme::ROUND - 1)
                .fill(if chosen {
                    palette.raised
                } else {
                    Color32::TRANSPARENT
                });
            let button = ui.add(button).on_hover_text(tip);
            places::note(ui.ctx(), format!("show {text}").to_lowercase(), button.rect);
            if button.clicked() {
                commands.push(Command::SetShow(show));
            }
        }
    });
    let place = choices.response.rect.expand(2.0);
    let shape = egui::Shape::rect_filled(place, f32::from(theme::ROUND), palette.button);
    ui.painter().set(background, shape);
}

fn size_menu(app: &App, ui: &mut Ui, commands: &mut Vec<Command>) {
    let label = RichText::new(app.settings.size.label()).size(12.5);
    let menu = ui.menu_button(label, |ui| {
        ui.set_min_width(170.0);
        let [width, height] = app.work.session.frame();
        for choice in size::Choice::ALL {
            let text = match choice {
                size::Choice::Fit => choice.label().to_owned(),
                size::Choice::Frame => format!("{} ({width} × {height})", choice.label()),
                size::Choice::Double => {
                    format!("{} ({} × {})", choice.label(), 2 * width, 2 * height)
                }
            };
            if ui
                .selectable_label(app.settings.size == choice, text)
                .clicked()
            {
                commands.push(Command::SetSize(choice));
            }
        }
    });
    menu.response.on_hover_text("Size of the traced picture");
}

fn reset_view(app: &App, ui: &mut Ui, commands: &mut Vec<Command>) {
    if app.work.session.user_camera().is_some() {
        let reset = ui.button(RichText::new("Reset view").size(12.5));
        places::note(ui.ctx(), "reset view", reset.rect);
        if reset
            .on_hover_text("Go back to the camera of the text")
            .clicked()
        {
            commands.push(Command::SetCamera(None));
        }
    }
}

/// Whether there is room for the tray below the picture, as there is not where the keyboard takes
/// half of a phone.
fn has_tray(place: Rect, narrow: bool) -> bool {
    let height = tray::strip::height(narrow, false);
    place.height() > height + if narrow { 60.0 } else { 160.0 }
}

/// Shows the picture in a place, with the strips below it and everything that is drawn on it.
fn stage(app: &mut App, ui: &mut Ui, place: Rect, commands: &mut Vec<Command>) {
    let palette = theme::palette(ui.visuals());
    let narrow = screen::is_narrow(ui.ctx());
    ui.painter().rect_filled(place, 0.0, palette.stage);
    let mut place = place;
    if app.work.session.is_animated() {
        let height = if narrow { 48.0 } else { STRIP };
        let strip = Rect::from_min_max(pos2(place.left(), place.bottom() - height), place.max);
        place.max.y = strip.top();
        ui.painter().rect_filled(strip, 0.0, palette.panel);
        let mut strip = ui.new_child(places::part("timeline", strip));
        timeline::show(app, &mut strip, commands);
    }
    let draws = app.pencil.tool().is_some();
    if draws {
        let strip = Rect::from_min_max(
            pos2(place.left(), place.bottom() - pencil::bar::HEIGHT),
            place.max,
        );
        place.max.y = strip.top();
        ui.painter().rect_filled(strip, 0.0, palette.panel);
        let line = Stroke::new(1.0, palette.line);
        ui.painter().hline(strip.x_range(), strip.top(), line);
        let mut strip = ui.new_child(places::part("pencil", strip));
        pencil::bar::show(app, &mut strip, commands);
    } else if app.tray.is_used() && has_tray(place, narrow) {
        let height = tray::strip::height(narrow, app.tray.folded);
        let strip = Rect::from_min_max(pos2(place.left(), place.bottom() - height), place.max);
        place.max.y = strip.top();
        ui.painter().rect_filled(strip, 0.0, palette.panel);
        let line = Stroke::new(1.0, palette.line);
        ui.painter().hline(strip.x_range(), strip.top(), line);
        let mut strip = ui.new_child(places::part("tray", strip));
        tray::strip::show(&mut strip, &app.tray, narrow, commands);
    }
    let margin = if narrow { 0.0 } else { 18.0 };
    let scale = ui.ctx().pixels_per_point();
    let rect = view::fit(place.shrink(margin), app.work.session.frame(), scale);
    // Sizes are taken in whole pixels, so that a picture is not traced anew for a rounding error.
    app.place = [
        (rect.width() * scale).round(),
        (rect.height() * scale).round(),
    ];
    places::note(ui.ctx(), "picture", rect);
    let now = platform::now(ui.ctx());
    let slow = app.rest > 0.0;
    if slow && app.renderer.is_near(view::SOON, now) {
        // If it does not come by then, the draft is drawn.
        ui.ctx().request_repaint_after_secs(view::SOON as f32);
    }
    let session = &app.work.session;
    let mut stand_in = StandIn::Draft;
    let draft = if view::needs_draft(app.settings.show, session, &app.renderer, slow, now) {
        match &mut app.draft {
            Some(draft) => {
                let mesh = app.live.mesh(session, now);
                stand_in = mesh.map_or(StandIn::Draft, |_| StandIn::Mesh);
                draft.texture(session, app.place, mesh)
            }
            None => app.apart.texture(ui.ctx(), session, app.place),
        }
    } else {
        None
    };
    let stand_in = draft.map(|_| stand_in);
    if app.stand_in != stand_in {
        app.stand_in = stand_in;
        // The status line, which names it, was drawn before.
        ui.ctx().request_repaint();
    }
    let scenery = Scenery {
        session,
        renderer: &app.renderer,
        draft,
        show: app.settings.show,
        now,
        hint: !app.settings.turned,
        round: if narrow { 0.0 } else { 5.0 },
        grasp: Grasp {
            draws,
            wheel: app.pencil.takes_wheel(),
            pinch: app.pencil.takes_pinch(),
        },
    };
    let picture = view::show(ui, rect, &scenery, commands);
    let around = Around {
        session,
        caret: app.editor.caret(),
        covered: app.dialog.is_some(),
        draft: draft.is_some(),
        touch: app.touch == Some(true),
    };
    if app.fitting.open {
        let sight = crate::hands::Sight::new(&session.camera(), rect);
        let painter = ui.painter().with_clip_rect(rect);
        fit_panel::points(&app.fitting, &painter, &sight, rect);
    }
    if draws {
        let fresh = app.renderer.texture();
        let fresh = fresh.is_some_and(|(_, generation)| generation == session.generation());
        let around = pencil::Around {
            session,
            covered: app.dialog.is_some(),
            late: draft.is_none() && !fresh,
            touch: app.touch == Some(true),
        };
        app.pencil.show(ui, rect, &picture, &around, commands);
        if let Some(pair) = app.pencil.alternative(session)
            && session.is_enabled()
            && pencil::bar::turn(ui, rect, pair)
        {
            app.pencil.turn(session, commands);
        }
    } else {
        app.hands.show(ui, rect, &picture, &around, commands);
        let is_well = session.is_enabled() && session.is_compiled() && session.errors() == 0;
        if is_well && app.dialog.is_none() && lamp::is_dark(&session.compilation().scene) {
            lamp::show(ui, rect, session, commands);
        }
        if session.is_enabled() && app.dialog.is_none() {
            pencil::bar::start(ui, rect, commands);
        }
    }
    if let Some(notice) = &app.notice {
        notice::show(ui, place, notice, commands);
    }
    let rects = places::all(ui.ctx());
    let covers = ["notice", "draw other"]
        .iter()
        .filter_map(|name| rects.get(*name));
    app.pencil.keep_off(covers.copied().collect());
}

/// Shows a narrow page below the bar.
fn narrow_page(app: &mut App, ui: &mut Ui, commands: &mut Vec<Command>) {
    let palette = theme::palette(ui.visuals());
    let all = ui.available_rect_before_wrap();
    let [w, h] = app.work.session.frame().map(|side| side as f32);
    // With the keyboard up there is little room; the text then matters more.
    let share = if all.height() < 420.0 { 0.34 } else { 0.46 };
    if app.pencil.tool().is_some() {
        stage(app, ui, all, commands);
        return;
    }
    let mut height = (all.width() * h / w).min(all.height() * share).max(80.0);
    if app.tray.is_used() && all.height() >= 420.0 {
        height += tray::strip::height(true, false);
    }
    let split = all.top() + height;
    stage(
        app,
        ui,
        Rect::from_min_max(all.min, pos2(all.right(), split)),
        commands,
    );
    let tabs = Rect::from_min_size(pos2(all.left(), split), vec2(all.width(), 48.0));
    ui.painter().rect_filled(tabs, 0.0, palette.panel);
    let part = places::part("tabs", tabs).layout(Layout::left_to_right(Align::Center));
    tab_row(app, &mut ui.new_child(part), commands);
    let below = Rect::from_min_max(tabs.left_bottom(), all.max);
    ui.painter().rect_filled(below, 0.0, palette.panel);
    let mut ui = ui.new_child(places::part("below", below));
    match app.tab {
        Tab::Text => {
            let session = &app.work.session;
            if session.project().files.len() > 1 || !session.assets().is_empty() {
                let strip = Rect::from_min_size(below.min, vec2(below.width(), 46.0));
                let mut strip = ui.new_child(places::part("files", strip));
                files::show(
                    &mut strip,
                    &app.work.session,
                    &mut app.editor,
                    false,
                    commands,
                );
                ui.add_space(46.0);
            }
            text_or_asset(app, &mut ui, commands);
        }
        Tab::Sliders => {
            Frame::new().inner_margin(14).show(&mut ui, |ui| {
                if app.work.session.compilation().hot.is_empty() {
                    ui.weak(
                        "Write “hot” after a variable, as in  var r = 0.3 hot,  \
                            and it gets a slider here.",
                    );
                } else {
                    slider_list(app, ui, commands);
                }
            });
        }
        Tab::Fit => {
            Frame::new().inner_margin(12).show(&mut ui, |ui| {
                ScrollArea::vertical()
                    .id_salt("fit")
                    .auto_shrink(false)
                    .show(ui, |ui| fit_panel::show(app, ui, commands));
            });
        }
        Tab::Problems => {
            Frame::new().inner_margin(10).show(&mut ui, |ui| {
                if app.work.session.diagnostics().is_empty() {
                    ui.weak("No problems.");
                } else {
                    problem_list(app, ui, commands);
                }
            });
        }
    }
}

fn tab_row(app: &mut App, ui: &mut Ui, commands: &mut Vec<Command>) {
    let palette = theme::palette(ui.visuals());
    ui.add_space(8.0);
    ui.spacing_mut().item_spacing.x = 4.0;
    let problems = app.work.session.diagnostics().len();
    let errors = app.work.session.errors() > 0;
    let sliders = app.work.session.compilation().hot.len();
    let mut tabs = vec![(Tab::Text, String::from("Text"))];
    for (tab, title, count) in [
        (Tab::Sliders, "Sliders", sliders),
        (Tab::Problems, "Problems", problems),
    ] {
        let title = match count {
            0 => title.to_owned(),
            count => format!("{title} {count}"),
        };
        tabs.push((tab, title));
    }
    if fit_panel::is_offered(app) {
        tabs.push((Tab::Fit, String::from("Fit")));
    } else if app.tab == Tab::Fit {
        app.tab = Tab::Text;
    }
    for (tab, text) in tabs {
        let open = app.tab == tab;
        let colour = match (open, tab == Tab::Problems && errors) {
            (_, true) => palette.error,
            (true, _) => palette.strong,
            (false, _) => palette.weak,
        };
        let button = Button::new(RichText::new(&text).color(colour)).fill(if open {
            palette.button
        } else {
            Color32::TRANSPARENT
        });
        let button = ui.add(button);
        places::note(ui.ctx(), format!("tab {tab:?}").to_lowercase(), button.rect);
        if button.clicked() {
            app.tab = tab;
            app.fitting.open |= tab == Tab::Fit;
        }
    }
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        ui.add_space(6.0);
        let is_moved = app.work.session.user_camera().is_some();
        if icon::button(ui, Icon::Frame, "See the whole model", true).clicked() {
            commands.push(Command::ShowAll);
        }
        let tip = "Go back to the camera of the text";
        if is_moved && icon::button(ui, Icon::Home, tip, true).clicked() {
            commands.push(Command::SetCamera(None));
        }
    });
}

fn dialogs(app: &mut App, ctx: &Context, commands: &mut Vec<Command>) {
    let Some(dialog) = app.dialog else {
        return;
    };
    let screen = ctx.content_rect();
    let width = match dialog {
        Dialog::Gallery | Dialog::Result | Dialog::Mesh => 860.0,
        Dialog::Help | Dialog::Sculpt => 640.0,
    };
    let size = vec2(
        (screen.width() - 24.0).min(width),
        (screen.height() - 48.0).min(720.0),
    );
    let modal = egui::Modal::new(egui::Id::unique("dialog"))
        .backdrop_color(Color32::from_black_alpha(130))
        .frame(
            Frame::window(&ctx.global_style()).inner_margin(if screen::is_narrow(ctx) {
                14
            } else {
                20
            }),
        )
        .show(ctx, |ui| {
            let inner = if screen::is_narrow(ui.ctx()) {
                28.0
            } else {
                40.0
            };
            ui.set_width(size.x - inner);
            ui.set_max_height(size.y - inner);
            match dialog {
                Dialog::Gallery => {
                    let shelf = app.work.shelf().borrow();
                    app.gallery
                        .show(ui, shelf.open_id(), platform::unix_time(), commands);
                }
                Dialog::Result => {
                    let inner = size - Vec2::splat(inner);
                    let kept = app.work.session.assets();
                    let now = platform::now(ui.ctx());
                    app.tray.show_large(ui, inner, kept, now, commands);
                }
                Dialog::Mesh => {
                    let inner = size - Vec2::splat(inner);
                    let film = app.film();
                    let (session, name) =
                        (&app.work.session, crate::work::file_stem(&app.work.name));
                    app.mesh_export
                        .show(ui, inner, session, film, &name, commands);
                }
                Dialog::Help => app.help.show(ui, app.settings.hints, commands),
                Dialog::Sculpt => app.sculpt_dialog(ui, commands),
            }
        });
    places::note(ctx, "dialog", modal.response.rect);
    if modal.backdrop_response.clicked() {
        commands.push(Command::Close);
    }
}
