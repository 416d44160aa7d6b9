//! Figures of lessons, and their words.

use crate::bench::Bench;
use crate::command::Command;
use egui::Ui;

/// The words of a lesson.
#[derive(Debug)]
pub struct Words {
    /// The word in its link.
    pub link: &'static str,
    /// The title.
    pub title: &'static str,
    /// The name in the list of a wide page.
    pub name: &'static str,
    /// The name in the list of a narrow page.
    pub short: &'static str,
    /// Few words for the list.
    pub about: &'static str,
    /// The text, three sentences.
    pub sentences: &'static str,
}

/// The figure of a lesson, with its numbers.
pub trait Figure {
    /// Draws it with its controls.
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>);

    /// Opens a text in the editor that shows the same thing.
    fn dataset(&self) -> Command;
}

/// Line of the list of lessons.
pub struct Entry {
    pub words: &'static Words,
    pub figure: fn() -> Box<dyn Figure>,
}

/// Makes the line of a lesson whose figure begins with its default numbers.
pub const fn entry<F: Figure + Default + 'static>(words: &'static Words) -> Entry {
    Entry {
        words,
        figure: || Box::new(F::default()),
    }
}
