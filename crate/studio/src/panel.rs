//! A panel of the page. Each has its state, its widgets, its wishes and what they do in a file or a
//! folder of its own; [`crate::panels`] lists them.

use crate::page::{Moment, Page};
use crate::wish::Wishes;
use egui::{Context, Ui};

/// A part of the page with a state of its own.
pub trait Panel {
    /// Shows the panel in all of `ui`. It reads the page and adds wishes.
    fn show(&mut self, page: &Page, ui: &mut Ui, wishes: &mut Wishes);

    /// Does the work of timers and messages, also while the panel is not shown.
    fn tick(&mut self, _page: &mut Page, _at: &Moment<'_>) {}

    /// Returns the seconds until [`Panel::tick`] must be called again; `None` if it need not.
    fn wait(&self, _page: &Page, _now: f64) -> Option<f64> {
        None
    }

    /// Forgets what belonged to the work before, when another one was opened.
    fn forget(&mut self, _page: &mut Page, _ctx: &Context) {}
}
