//! Drawing one frame of the app.

use crate::app::{App, repaint_once};
use crate::{layout, platform, screen, theme};
use egui::Ui;

impl App {
    /// Draws one frame into all of `ui`.
    pub fn show(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        let touch = ctx.input(egui::InputState::has_touch_screen) || screen::is_narrow(&ctx);
        if self.touch != Some(touch) {
            self.touch = Some(touch);
            theme::apply(&ctx, touch);
            if self.rest > 0.0 {
                // Fading draws many frames, each at the cost of the picture.
                ctx.all_styles_mut(|style| style.animation_time = 0.0);
            }
        }
        let mut commands = Vec::new();
        self.keys(&ctx, &mut commands);
        layout::show(self, ui, &mut commands);
        let now = platform::now(&ctx);
        let acts = !commands.is_empty();
        for command in commands {
            self.carry_out(&ctx, command, now);
        }
        self.work.settle(now);
        // Workers need not wait for this frame to be drawn.
        self.trace(&ctx, now);
        let is_short = self.is_short_of_time();
        platform::set_frames_slow(is_short);
        match (acts, is_short) {
            (true, true) => ctx.request_repaint(),
            (true, false) => repaint_once(&ctx),
            (false, _) => {}
        }
    }
}
