//! Layout of the page. Large: text on the left, picture on the right, with a split that can be
//! dragged. Small: the picture above or, where the page is low, beside text, sliders and problems
//! in turn.

use crate::icon::{self, Icon};
use crate::page::{Page, Tab};
use crate::panel::Panel as _;
use crate::panels::Panels;
use crate::settings::Show;
use crate::stage::pencil;
use crate::text::files;
use crate::theme::{self, STRIP};
use crate::wish::{Dialog, Setting, ViewWish, Wish, Wishes};
use crate::works::versions;
use crate::{bar, download, first, fit, notice, places, problems, screen, sculpt, status, tray};
use document::{intake, size};
use egui::{
    Align, Button, CentralPanel, Color32, Context, Frame, Layout, Margin, Panel, Popup, Rect,
    RichText, ScrollArea, Stroke, Ui, pos2, vec2,
};

/// Draws everything.
pub fn show(page: &mut Page, panels: &mut Panels, ui: &mut Ui, wishes: &mut Wishes) {
    places::clear(ui.ctx());
    if page.is_lab_open {
        panels.lab.show(page, ui, wishes);
        return;
    }
    if panels.sculpt.is_open() {
        let all = ui.max_rect();
        panels.sculpt.show(page, ui, wishes);
        if let Some(notice) = &page.notice {
            notice::show(ui, all, notice, wishes);
        }
        dialogs(page, panels, ui.ctx(), wishes);
        return;
    }
    let small = screen::is_small(ui.ctx());
    let palette = theme::palette(ui.visuals());
    let line = Stroke::new(1.0, palette.line);
    let flat = Frame::new().fill(palette.panel);
    let bar_height = if small { 52.0 } else { 46.0 };
    Panel::top("bar")
        .exact_size(bar_height)
        .frame(flat)
        .show(ui, |ui| bar::show(page, &panels.film, ui, small, wishes));
    Panel::bottom("status")
        .exact_size(if small { 40.0 } else { 32.0 })
        .frame(flat)
        .show(ui, |ui| {
            status::show(page, panels.stage.stand_in.as_ref(), ui, small, wishes);
        });
    if small {
        small_page(page, panels, ui, wishes);
    } else {
        let width = ui.available_width();
        // The picture has at least half of a page that is not very wide.
        let most = (width - 500.0).max(0.5 * width);
        let wanted = (width * page.settings.split).clamp(260.0, most);
        let panel = Panel::left("text")
            .default_size(wanted)
            .size_range(260.0..=most)
            .show_separator_line(true)
            .frame(flat);
        // In a window of another width the split keeps its share.
        let is_resized = page.screen.width != width;
        page.screen.width = width;
        let panel = if is_resized {
            panel.exact_size(wanted)
        } else {
            panel
        };
        let side = panel.show(ui, |ui| text_side(page, panels, ui, wishes));
        if !is_resized {
            page.settings.split = (side.response.rect.width() / width.max(1.0)).clamp(0.15, 0.85);
        }
        CentralPanel::no_frame().show(ui, |ui| {
            let all = ui.max_rect();
            let head = Rect::from_min_size(all.min, vec2(all.width(), STRIP));
            picture_head(page, panels, ui, head, wishes);
            ui.painter().hline(all.x_range(), head.bottom(), line);
            let below = Rect::from_min_max(head.left_bottom(), all.max);
            stage(page, panels, ui, below, wishes);
        });
    }
    dialogs(page, panels, ui.ctx(), wishes);
    drop_hint(ui.ctx());
}

/// Shows the left side of a wide page: files, text, sliders, problems.
fn text_side(page: &Page, panels: &mut Panels, ui: &mut Ui, wishes: &mut Wishes) {
    let session = &page.work.session;
    let palette = theme::palette(ui.visuals());
    let inset = Frame::new()
        .fill(palette.panel)
        .inner_margin(Margin::symmetric(12, 8));
    Panel::top("files")
        .exact_size(STRIP)
        .frame(Frame::new().fill(palette.panel))
        .show(ui, |ui| {
            files::show(ui, session, &mut panels.text.editor, true, wishes);
        });
    // It is always there, so that the editor stays where it is while problems come and go.
    let room = if ui.available_height() < 480.0 {
        46.0
    } else {
        130.0
    };
    Panel::bottom("problems")
        .resizable(true)
        .default_size(room)
        .size_range(46.0..=(0.5 * ui.available_height()).max(46.0))
        .frame(inset)
        .show(ui, |ui| problems::show(page, ui, wishes));
    if panels.fit.0.open {
        Panel::bottom("fit")
            .exact_size(fit::HEIGHT)
            .frame(inset)
            .show(ui, |ui| panels.fit.show(page, ui, wishes));
    }
    let rows = panels.sliders.height(ui, session);
    if rows > 0.0 {
        let most = (0.4 * ui.available_height()).clamp(60.0, 260.0);
        Panel::bottom("sliders")
            .exact_size(rows.min(most) + 50.0)
            .frame(inset)
            .show(ui, |ui| panels.sliders.show(page, ui, wishes));
    }
    first::show(page, ui, wishes);
    CentralPanel::no_frame().show(ui, |ui| text(page, panels, ui, wishes));
}

/// Shows the editor, in which the command of the chosen shape is lit.
fn text(page: &Page, panels: &mut Panels, ui: &mut Ui, wishes: &mut Wishes) {
    panels.text.editor.lit = panels.stage.hands.lit(&page.work.session);
    panels.text.show(page, ui, wishes);
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
    let text = format!("Drop {} here", intake::kinds());
    let font = egui::FontId::proportional(17.0);
    let width = place.width() - 60.0;
    let galley = painter.layout(text, font, palette.strong, width);
    painter.galley(place.center() - galley.size() / 2.0, galley, palette.strong);
}

/// Shows the strip above the picture: draft or picture, size, download.
fn picture_head(page: &Page, panels: &Panels, ui: &mut Ui, place: Rect, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    ui.painter().rect_filled(place, 0.0, palette.panel);
    let part = places::part("picture head", place);
    let mut ui = ui.new_child(part.layout(Layout::left_to_right(Align::Center)));
    ui.add_space(10.0);
    if page.screen.has_draft {
        show_choice(page, &mut ui, wishes);
    }
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        ui.add_space(10.0);
        let tip = "Download: picture (Ctrl+S), project";
        let save = icon::button(ui, Icon::Save, tip, true);
        places::note(ui.ctx(), "download", save.rect);
        Popup::menu(&save)
            .close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside)
            .show(|ui| download::menu(page, &panels.film, ui, wishes));
        if icon::button(ui, Icon::Frame, "See the whole model", true).clicked() {
            wishes.push(ViewWish::ShowAll);
        }
        size_menu(page, ui, wishes);
        if panels.fit.0.is_offered() {
            panels.fit.button(ui, wishes);
        }
        reset_view(page, ui, wishes);
    });
}

fn show_choice(page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
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
                "Only the draft: the surface itself, drawn by the graphics card",
            ),
            (Show::Traced, "Traced", "Only the ray-traced picture"),
        ] {
            let chosen = page.settings.show == show;
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
                wishes.push(Setting::Show(show));
            }
        }
    });
    let place = choices.response.rect.expand(2.0);
    let shape = egui::Shape::rect_filled(place, f32::from(theme::ROUND), palette.button);
    ui.painter().set(background, shape);
}

fn size_menu(page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
    let label = RichText::new(page.settings.size.label()).size(12.5);
    let menu = ui.menu_button(label, |ui| {
        ui.set_min_width(170.0);
        let [width, height] = page.work.session.frame();
        for choice in size::Choice::ALL {
            let text = match choice {
                size::Choice::Fit => choice.label().to_owned(),
                size::Choice::Frame => format!("{} ({width} × {height})", choice.label()),
                size::Choice::Double => {
                    format!("{} ({} × {})", choice.label(), 2 * width, 2 * height)
                }
            };
            if ui
                .selectable_label(page.settings.size == choice, text)
                .clicked()
            {
                wishes.push(Setting::Size(choice));
            }
        }
    });
    menu.response.on_hover_text("Size of the traced picture");
}

fn reset_view(page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
    if page.work.session.user_camera().is_some() {
        let reset = ui.button(RichText::new("Reset view").size(12.5));
        places::note(ui.ctx(), "reset view", reset.rect);
        if reset
            .on_hover_text("Go back to the camera of the text")
            .clicked()
        {
            wishes.push(ViewWish::SetCamera(None));
        }
    }
}

/// Whether there is room for the tray below the picture, as there is not where the keyboard takes
/// half of a phone.
fn has_tray(place: Rect, narrow: bool) -> bool {
    let height = tray::strip::height(narrow, false);
    place.height() > height + if narrow { 60.0 } else { 160.0 }
}

/// Cuts a strip off the lower end of a place, and returns the strip as a space for widgets.
fn strip(ui: &mut Ui, place: &mut Rect, height: f32, name: &str) -> Ui {
    let strip = Rect::from_min_max(pos2(place.left(), place.bottom() - height), place.max);
    place.max.y = strip.top();
    let palette = theme::palette(ui.visuals());
    ui.painter().rect_filled(strip, 0.0, palette.panel);
    ui.new_child(places::part(name, strip))
}

/// Shows the picture in a place, with the strips below it and everything that is drawn on it.
fn stage(page: &mut Page, panels: &mut Panels, ui: &mut Ui, mut place: Rect, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    let narrow = screen::is_small(ui.ctx());
    let line = Stroke::new(1.0, palette.line);
    ui.painter().rect_filled(place, 0.0, palette.stage);
    if page.work.session.has_frames() {
        let height = if narrow { 48.0 } else { STRIP };
        let mut strip = strip(ui, &mut place, height, "timeline");
        panels.film.show(page, &mut strip, wishes);
    }
    if panels.stage.pencil.tool().is_some() {
        let mut strip = strip(ui, &mut place, pencil::bar::HEIGHT, "pencil");
        ui.painter().hline(place.x_range(), place.bottom(), line);
        pencil::bar::show(&mut panels.stage.pencil, &mut strip, wishes);
    } else if panels.tray.is_used() && has_tray(place, narrow) {
        let height = tray::strip::height(narrow, panels.tray.folded);
        let mut strip = strip(ui, &mut place, height, "tray");
        ui.painter().hline(place.x_range(), place.bottom(), line);
        panels.tray.show(page, &mut strip, wishes);
    }
    panels.stage.caret = panels.text.editor.caret();
    panels.stage.points = if panels.fit.0.open {
        panels.fit.0.points()
    } else {
        Vec::new()
    };
    let mut inner = ui.new_child(places::part("stage", place));
    panels.stage.show(page, &mut inner, wishes);
    page.screen.place = panels.stage.place;
    if let Some(notice) = &page.notice {
        notice::show(ui, place, notice, wishes);
    }
    let rects = places::all(ui.ctx());
    let covers = ["notice", "draw other"]
        .iter()
        .filter_map(|name| rects.get(*name));
    let covers = covers.copied().collect();
    panels.stage.pencil.keep_off(covers);
}

/// Shows a small page between the bars: the picture above the rest, or beside it where the page is
/// low.
fn small_page(page: &mut Page, panels: &mut Panels, ui: &mut Ui, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    let all = ui.available_rect_before_wrap();
    let [w, h] = page.work.session.frame().map(|side| side as f32);
    // The keyboard of a phone, or a card, leaves little room, which the text needs more.
    let low = if first::step_of(page).is_some() {
        520.0
    } else {
        420.0
    };
    let share = if all.height() < low { 0.34 } else { 0.5 };
    if panels.stage.pencil.tool().is_some() {
        stage(page, panels, ui, all, wishes);
        return;
    }
    let rest = if all.width() > 1.25 * all.height() {
        let (rest, picture) = all.split_left_right_at_fraction(0.45);
        stage(page, panels, ui, picture, wishes);
        rest
    } else {
        let mut height = (all.width() * h / w).min(all.height() * share).max(80.0);
        if panels.tray.is_used() && all.height() >= 420.0 {
            height += tray::strip::height(true, false);
        }
        let (picture, rest) = all.split_top_bottom_at_y(all.top() + height);
        stage(page, panels, ui, picture, wishes);
        rest
    };
    let tabs = Rect::from_min_size(rest.min, vec2(rest.width(), 48.0));
    ui.painter().rect_filled(tabs, 0.0, palette.panel);
    let part = places::part("tabs", tabs).layout(Layout::left_to_right(Align::Center));
    tab_row(page, panels, &mut ui.new_child(part), wishes);
    let below = Rect::from_min_max(tabs.left_bottom(), rest.max);
    ui.painter().rect_filled(below, 0.0, palette.panel);
    let mut ui = ui.new_child(places::part("below", below));
    match page.tab {
        Tab::Text => {
            let session = &page.work.session;
            if session.project().files.len() > 1 || !session.assets().is_empty() {
                let strip = Rect::from_min_size(below.min, vec2(below.width(), 46.0));
                let mut strip = ui.new_child(places::part("files", strip));
                let editor = &mut panels.text.editor;
                files::show(&mut strip, session, editor, false, wishes);
                ui.add_space(46.0);
            }
            first::show(page, &mut ui, wishes);
            CentralPanel::no_frame().show(&mut ui, |ui| text(page, panels, ui, wishes));
        }
        Tab::Sliders => {
            Frame::new().inner_margin(14).show(&mut ui, |ui| {
                if panels.sliders.height(ui, &page.work.session) == 0.0 {
                    ui.weak(
                        "Write “hot” after a variable, as in  var r = 0.3 hot,  \
                            and it gets a slider here.",
                    );
                } else {
                    panels.sliders.show(page, ui, wishes);
                }
            });
        }
        Tab::Fit => {
            Frame::new().inner_margin(12).show(&mut ui, |ui| {
                ScrollArea::vertical()
                    .id_salt("fit")
                    .auto_shrink(false)
                    .show(ui, |ui| panels.fit.show(page, ui, wishes));
            });
        }
        Tab::Problems => {
            Frame::new().inner_margin(10).show(&mut ui, |ui| {
                problems::show(page, ui, wishes);
            });
        }
    }
}

fn tab_row(page: &mut Page, panels: &mut Panels, ui: &mut Ui, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    // Where there is little room, the menu has the buttons for the view.
    let is_short = ui.available_width() < 350.0;
    ui.add_space(if is_short { 2.0 } else { 8.0 });
    ui.spacing_mut().item_spacing.x = if is_short { 0.0 } else { 4.0 };
    let problems = page.work.session.messages().len();
    let errors = page.work.session.shows_errors();
    let sliders = page.work.session.compilation().hot.len();
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
    if panels.fit.0.is_offered() {
        tabs.push((Tab::Fit, String::from("Fit")));
    } else if page.tab == Tab::Fit {
        page.tab = Tab::Text;
    }
    for (tab, text) in tabs {
        let open = page.tab == tab;
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
            page.tab = tab;
            panels.fit.0.open |= tab == Tab::Fit;
        }
    }
    if is_short {
        return;
    }
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        ui.add_space(6.0);
        let is_moved = page.work.session.user_camera().is_some();
        if icon::button(ui, Icon::Frame, "See the whole model", true).clicked() {
            wishes.push(ViewWish::ShowAll);
        }
        let tip = "Go back to the camera of the text";
        if is_moved && icon::button(ui, Icon::Home, tip, true).clicked() {
            wishes.push(ViewWish::SetCamera(None));
        }
    });
}

fn dialogs(page: &Page, panels: &mut Panels, ctx: &Context, wishes: &mut Wishes) {
    let Some(dialog) = page.dialog else {
        return;
    };
    let screen = ctx.content_rect();
    let width = match dialog {
        Dialog::Gallery | Dialog::Result | Dialog::Mesh => 860.0,
        Dialog::Help | Dialog::Sculpt | Dialog::Versions => 640.0,
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
                Dialog::Gallery => panels.gallery.show(page, ui, wishes),
                Dialog::Versions => versions::show(page, ui, wishes),
                Dialog::Result => {
                    let kept = page.work.session.assets();
                    panels.tray.show_large(ui, kept, wishes);
                }
                Dialog::Mesh => panels.mesh.show(page, ui, wishes),
                Dialog::Help => panels.help.show(page, ui, wishes),
                Dialog::Sculpt => sculpt::ask(page, ui, wishes),
            }
        });
    places::note(ctx, "dialog", modal.response.rect);
    if modal.backdrop_response.clicked() {
        wishes.push(Wish::Close);
    }
}
