//! Keeps clicks when frames are late.
//!
//! A button that is down for 0.8 s by the clock of frames counts as dragged. Where a frame takes
//! longer than that, as while a shader is compiled, a quick click would be lost.

use egui::{Context, Event, RawInput};

/// Takes a release in the frame after its press for the end of a click, however late that frame is.
#[derive(Default)]
pub struct Clicks {
    /// Seconds that a click may take otherwise.
    usual: Option<f64>,
    /// Whether a button went down in the last frame.
    is_pressed: bool,
}

impl egui::Plugin for Clicks {
    fn debug_name(&self) -> &'static str {
        "clicks"
    }

    fn input_hook(&mut self, ctx: &Context, input: &mut RawInput) {
        let [mut goes_down, mut goes_up] = [false; 2];
        for event in &input.events {
            if let Event::PointerButton { pressed, .. } = event {
                goes_down |= *pressed;
                goes_up |= !*pressed;
            }
        }
        let is_late = self.is_pressed && goes_up;
        self.is_pressed = goes_down;
        ctx.options_mut(|options| {
            let longest = &mut options.input_options.max_click_duration;
            let usual = *self.usual.get_or_insert(*longest);
            *longest = if is_late { f64::INFINITY } else { usual };
        });
    }
}
