//! The look of the page: two calm palettes, slate and paper, with one warm accent for active parts.

use egui::{
    Color32, CornerRadius, FontFamily, FontId, Margin, Shadow, Stroke, Style, TextStyle, Theme,
    Visuals, vec2,
};
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, Ordering};

/// The user's choice of palette.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Choice {
    /// The system's.
    #[default]
    System,
    /// Slate.
    Dark,
    /// Paper.
    Light,
}

impl From<Choice> for egui::ThemePreference {
    fn from(choice: Choice) -> Self {
        match choice {
            Choice::System => Self::System,
            Choice::Dark => Self::Dark,
            Choice::Light => Self::Light,
        }
    }
}

/// The colours of one palette.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// Bars and panels.
    pub panel: Color32,
    /// The ground behind the text.
    pub paper: Color32,
    /// The ground behind the picture.
    pub stage: Color32,
    /// Menus and windows.
    pub raised: Color32,
    /// Buttons at rest.
    pub button: Color32,
    /// Buttons under the pointer.
    pub hover: Color32,
    /// Thin lines between parts.
    pub line: Color32,
    /// Text.
    pub text: Color32,
    /// Less important text.
    pub weak: Color32,
    /// Headings and chosen items.
    pub strong: Color32,
    /// Accents: the share button, progress, slider fill.
    pub accent: Color32,
    /// Text on the accent.
    pub on_accent: Color32,
    /// Errors.
    pub error: Color32,
    /// Warnings.
    pub warning: Color32,
    /// Notes.
    pub note: Color32,
    /// Selected text.
    pub selection: Color32,
    /// Command words.
    pub command: Color32,
    /// Option words.
    pub option: Color32,
    /// Numbers.
    pub number: Color32,
    /// Colour names.
    pub colour: Color32,
    /// Comments.
    pub comment: Color32,
    /// Operators and braces.
    pub sign: Color32,
}

const fn hex(rgb: u32) -> Color32 {
    Color32::from_rgb((rgb >> 16) as u8, (rgb >> 8) as u8, rgb as u8)
}

/// Slate.
pub const DARK: Palette = Palette {
    panel: hex(0x171B22),
    paper: hex(0x12161C),
    stage: hex(0x0D1015),
    raised: hex(0x1E242D),
    button: hex(0x242B35),
    hover: hex(0x2E3743),
    line: hex(0x272E38),
    text: hex(0xC9D1DB),
    weak: hex(0x96A1AE),
    strong: hex(0xF1F4F8),
    accent: hex(0xE8704A),
    on_accent: hex(0x1C0F0A),
    error: hex(0xFF6B6B),
    warning: hex(0xE9B44C),
    note: hex(0x7FB2E5),
    selection: hex(0x35485F),
    command: hex(0xF0916F),
    option: hex(0x8FB8DE),
    number: hex(0xD8C27A),
    colour: hex(0x8FCFA8),
    comment: hex(0x748190),
    sign: hex(0x93A0B0),
};

/// Paper.
pub const LIGHT: Palette = Palette {
    panel: hex(0xF5F3F0),
    paper: hex(0xFFFEFC),
    stage: hex(0xE6E3DE),
    raised: hex(0xFFFFFF),
    button: hex(0xE9E6E1),
    hover: hex(0xDEDAD3),
    line: hex(0xDDD9D2),
    text: hex(0x2B323A),
    weak: hex(0x596069),
    strong: hex(0x12171D),
    accent: hex(0xBA4C28),
    on_accent: hex(0xFFFFFF),
    error: hex(0xC62F2F),
    warning: hex(0x966500),
    note: hex(0x2F6DA8),
    selection: hex(0xF6D5C8),
    command: hex(0xB8431C),
    option: hex(0x2B64A0),
    number: hex(0x85640A),
    colour: hex(0x1F7A4A),
    comment: hex(0x6F767D),
    sign: hex(0x59636E),
};

/// The palettes of those who ask for more contrast.
const SHARP: [Palette; 2] = [sharpen(DARK), sharpen(LIGHT)];

/// Makes a palette of more contrast.
const fn sharpen(palette: Palette) -> Palette {
    Palette {
        line: palette.weak,
        text: palette.strong,
        weak: palette.text,
        comment: palette.text,
        sign: palette.strong,
        ..palette
    }
}

/// Whether more contrast is asked for.
static IS_SHARP: AtomicBool = AtomicBool::new(false);

/// Sets whether more contrast is asked for; [`apply`] follows.
pub fn set_sharp(is_sharp: bool) {
    IS_SHARP.store(is_sharp, Ordering::Relaxed);
}

/// Returns the palette in use.
#[must_use]
pub fn palette(visuals: &Visuals) -> &'static Palette {
    palette_of(visuals.dark_mode)
}

fn palette_of(is_dark: bool) -> &'static Palette {
    match (IS_SHARP.load(Ordering::Relaxed), is_dark) {
        (false, true) => &DARK,
        (false, false) => &LIGHT,
        (true, is_dark) => &SHARP[usize::from(!is_dark)],
    }
}

/// Size of the editor's letters.
pub const CODE_SIZE: f32 = 13.5;
/// Height of the strips with buttons.
pub const STRIP: f32 = 38.0;
/// Corner radius of buttons.
pub const ROUND: u8 = 6;

/// Sets up both palettes; egui picks the one for the theme in use. `touch` makes targets as large
/// as a thumb needs.
pub fn apply(ctx: &egui::Context, touch: bool) {
    ctx.set_style_of(Theme::Dark, style(palette_of(true), Visuals::dark(), touch));
    ctx.set_style_of(
        Theme::Light,
        style(palette_of(false), Visuals::light(), touch),
    );
}

fn style(palette: &Palette, mut visuals: Visuals, touch: bool) -> Style {
    let mut style = Style {
        text_styles: [
            (
                TextStyle::Small,
                FontId::new(11.5, FontFamily::Proportional),
            ),
            (TextStyle::Body, FontId::new(14.0, FontFamily::Proportional)),
            (
                TextStyle::Button,
                FontId::new(14.0, FontFamily::Proportional),
            ),
            (
                TextStyle::Heading,
                FontId::new(19.0, FontFamily::Proportional),
            ),
            (
                TextStyle::Monospace,
                FontId::new(CODE_SIZE, FontFamily::Monospace),
            ),
        ]
        .into(),
        animation_time: 0.12,
        ..Style::default()
    };

    let spacing = &mut style.spacing;
    spacing.item_spacing = vec2(8.0, 6.0);
    spacing.button_padding = if touch {
        vec2(12.0, 8.0)
    } else {
        vec2(10.0, 4.0)
    };
    spacing.interact_size = if touch {
        vec2(44.0, 40.0)
    } else {
        vec2(36.0, 26.0)
    };
    spacing.menu_margin = Margin::same(8);
    spacing.window_margin = Margin::same(18);
    spacing.slider_width = 150.0;
    spacing.slider_rail_height = 4.0;
    spacing.tooltip_width = 340.0;
    spacing.icon_width = if touch { 20.0 } else { 15.0 };
    style.interaction.tooltip_delay = 0.35;
    style.interaction.resize_grab_radius_side = 6.0;
    style.interaction.selectable_labels = false;

    visuals.panel_fill = palette.panel;
    visuals.window_fill = palette.raised;
    visuals.extreme_bg_color = palette.paper;
    visuals.text_edit_bg_color = Some(palette.paper);
    visuals.faint_bg_color = palette.button;
    visuals.code_bg_color = palette.button;
    visuals.window_stroke = Stroke::new(1.0, palette.line);
    visuals.window_corner_radius = CornerRadius::same(12);
    visuals.menu_corner_radius = CornerRadius::same(10);
    let shadow = Shadow {
        offset: [0, 8],
        blur: 28,
        spread: 0,
        color: Color32::from_black_alpha(if visuals.dark_mode { 120 } else { 40 }),
    };
    visuals.window_shadow = shadow;
    visuals.popup_shadow = shadow;
    visuals.hyperlink_color = palette.accent;
    visuals.error_fg_color = palette.error;
    visuals.warn_fg_color = palette.warning;
    visuals.weak_text_color = Some(palette.weak);
    visuals.selection.bg_fill = palette.selection;
    visuals.selection.stroke = Stroke::new(1.0, palette.strong);
    visuals.text_cursor.stroke = Stroke::new(2.0, palette.accent);
    visuals.slider_trailing_fill = true;
    visuals.handle_shape = egui::style::HandleShape::Circle;
    visuals.interact_cursor = Some(egui::CursorIcon::PointingHand);

    let widgets = &mut visuals.widgets;
    for widget in [
        &mut widgets.noninteractive,
        &mut widgets.inactive,
        &mut widgets.hovered,
        &mut widgets.active,
        &mut widgets.open,
    ] {
        widget.corner_radius = CornerRadius::same(ROUND);
        widget.expansion = 0.0;
        widget.bg_stroke = Stroke::NONE;
        widget.fg_stroke = Stroke::new(1.0, palette.text);
        widget.bg_fill = palette.button;
        widget.weak_bg_fill = palette.button;
    }
    widgets.noninteractive.bg_fill = palette.panel;
    widgets.noninteractive.weak_bg_fill = palette.panel;
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, palette.line);
    widgets.hovered.bg_fill = palette.hover;
    widgets.hovered.weak_bg_fill = palette.hover;
    widgets.hovered.fg_stroke = Stroke::new(1.0, palette.strong);
    widgets.active.bg_fill = palette.hover;
    widgets.active.weak_bg_fill = palette.hover;
    widgets.active.fg_stroke = Stroke::new(1.0, palette.strong);
    // A widget with the focus is painted as an active one.
    widgets.active.bg_stroke = Stroke::new(1.5, palette.accent);
    widgets.open.weak_bg_fill = palette.hover;
    widgets.open.fg_stroke = Stroke::new(1.0, palette.strong);
    // A slider's knob is drawn with these strokes; a line makes it readable on both palettes.
    widgets.inactive.fg_stroke = Stroke::new(1.0, palette.text);

    style.visuals = visuals;
    style
}

/// Returns the choice in words.
#[must_use]
pub fn label(choice: Choice) -> &'static str {
    match choice {
        Choice::System => "system",
        Choice::Dark => "dark",
        Choice::Light => "light",
    }
}

/// Returns the palette that is not on the screen.
#[must_use]
pub fn other(ui: &egui::Ui) -> Choice {
    if ui.visuals().dark_mode {
        Choice::Light
    } else {
        Choice::Dark
    }
}

/// Draws the ring around a widget that has the focus and is painted by hand.
pub fn ring(ui: &egui::Ui, response: &egui::Response) {
    if response.has_focus() {
        let palette = palette(ui.visuals());
        let stroke = Stroke::new(1.5, palette.accent);
        let inside = egui::StrokeKind::Inside;
        ui.painter()
            .rect_stroke(response.rect, f32::from(ROUND), stroke, inside);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the relative luminance of a colour (WCAG 2.2).
    fn luminance(colour: Color32) -> f64 {
        let [r, g, b, _] = colour.to_array().map(|byte| {
            let share = f64::from(byte) / 255.0;
            if share <= 0.04045 {
                share / 12.92
            } else {
                libm::pow((share + 0.055) / 1.055, 2.4)
            }
        });
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    /// Returns the contrast of two colours, 1 … 21 (WCAG 2.2).
    fn contrast(a: Color32, b: Color32) -> f64 {
        let [a, b] = [a, b].map(luminance);
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn what_is_written_can_be_read_on_each_ground() {
        assert!((contrast(Color32::WHITE, Color32::BLACK) - 21.0).abs() < 1e-9);
        for palette in [DARK, LIGHT, SHARP[0], SHARP[1]] {
            let (panel, paper, raised) = (palette.panel, palette.paper, palette.raised);
            let grounds = [panel, paper, raised, palette.button, palette.hover];
            let words = [palette.text, palette.weak, palette.strong];
            let mut pairs = vec![(palette.on_accent, palette.accent), (palette.accent, panel)];
            pairs.extend(
                words
                    .iter()
                    .flat_map(|word| grounds.map(|ground| (*word, ground))),
            );
            for told in [palette.error, palette.warning, palette.note] {
                pairs.extend([panel, raised].map(|ground| (told, ground)));
            }
            let code = [
                palette.command,
                palette.option,
                palette.number,
                palette.colour,
            ];
            let code = code
                .into_iter()
                .chain([palette.comment, palette.sign, palette.error]);
            pairs.extend(code.map(|word| (word, paper)));
            for (word, ground) in pairs {
                let contrast = contrast(word, ground);
                assert!(contrast >= 4.5, "{word:?} on {ground:?}: {contrast}");
            }
        }
    }
}
