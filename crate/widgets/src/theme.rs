//! The look of the page: two calm palettes, slate and paper, with one warm accent for active parts.

use egui::{
    Color32, CornerRadius, FontFamily, FontId, Margin, Shadow, Stroke, Style, TextStyle, Theme,
    Visuals, vec2,
};
use serde::{Deserialize, Serialize};

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
    weak: hex(0x8491A1),
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
    comment: hex(0x667485),
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
    weak: hex(0x6A737D),
    strong: hex(0x12171D),
    accent: hex(0xD4572E),
    on_accent: hex(0xFFFFFF),
    error: hex(0xC62F2F),
    warning: hex(0x9A6700),
    note: hex(0x2F6DA8),
    selection: hex(0xF6D5C8),
    command: hex(0xB8431C),
    option: hex(0x2B64A0),
    number: hex(0x85640A),
    colour: hex(0x1F7A4A),
    comment: hex(0x8A929B),
    sign: hex(0x59636E),
};

/// Returns the palette in use.
#[must_use]
pub fn palette(visuals: &Visuals) -> &'static Palette {
    if visuals.dark_mode { &DARK } else { &LIGHT }
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
    ctx.set_style_of(Theme::Dark, style(&DARK, Visuals::dark(), touch));
    ctx.set_style_of(Theme::Light, style(&LIGHT, Visuals::light(), touch));
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
