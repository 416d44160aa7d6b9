//! The look of sliders, and the numbers they stop at.

use crate::theme;
use egui::Ui;

/// Sets the colours of sliders: the accent for the filled part, and a knob that stands out from the
/// rail.
pub fn colours(ui: &mut Ui) {
    let palette = theme::palette(ui.visuals());
    let visuals = ui.visuals_mut();
    visuals.selection.bg_fill = palette.accent;
    let widgets = &mut visuals.widgets;
    for widget in [
        &mut widgets.inactive,
        &mut widgets.hovered,
        &mut widgets.active,
    ] {
        widget.bg_fill = palette.hover;
        widget.fg_stroke = egui::Stroke::new(2.0, palette.accent);
    }
    widgets.hovered.bg_fill = palette.accent;
    widgets.active.bg_fill = palette.accent;
}

/// Returns a range to play in: up to four times the value, or a unit around zero.
#[must_use]
pub fn fitting_range(value: f64) -> (f64, f64) {
    if value > 0.0 {
        (0.0, 4.0 * value)
    } else if value < 0.0 {
        (4.0 * value, 0.0)
    } else {
        (-1.0, 1.0)
    }
}

/// Returns the number of decimals with which a slider of this range moves in steps of a thousandth
/// or less.
#[must_use]
pub fn decimals(range: f64) -> usize {
    if !range.is_finite() || range <= 0.0 {
        return 3;
    }
    let digits = libm::ceil(3.0 - libm::log10(range));
    digits.clamp(0.0, 12.0) as usize
}

/// Whether a number is likely to count something (spikes, turns), so that it should stay whole.
#[must_use]
pub fn counts(value: f64) -> bool {
    value.abs() >= 20.0 && value.fract() == 0.0
}

/// Returns the number nearest to `value` that lies a whole number of steps above `low`, without
/// digits that no hand could set.
#[must_use]
pub fn snap(value: f64, low: f64, step: Option<f64>, decimals: usize) -> f64 {
    match step {
        Some(step) if step > 0.0 => shorten(low + ((value - low) / step).round() * step, 9),
        _ => shorten(value, decimals),
    }
}

/// Shortens a number to the digits that a hand can set.
fn shorten(value: f64, decimals: usize) -> f64 {
    format!("{value:.decimals$}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_no_digits_that_no_hand_could_set() {
        assert_eq!(shorten(0.1 + 0.2, 4), 0.3);
        assert_eq!(shorten(1234.56, 0), 1235.0);
        assert!(counts(100.0) && counts(-20.0));
        assert!(!counts(-2.0) && !counts(254.8) && !counts(f64::NAN));
    }

    #[test]
    fn a_thousand_steps_fit_every_range() {
        assert_eq!(fitting_range(0.05), (0.0, 0.2));
        assert_eq!(fitting_range(-2.0), (-8.0, 0.0));
        assert_eq!(fitting_range(0.0), (-1.0, 1.0));
        assert_eq!(decimals(0.2), 4);
        assert_eq!(decimals(4000.0), 0);
        assert_eq!(decimals(f64::NAN), 3);
        assert_eq!(decimals(1e-300), 12);
    }
}
