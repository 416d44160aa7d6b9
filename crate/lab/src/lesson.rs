//! Lessons: their words, their figures and the links that lead to them.

use crate::bench::Bench;
use crate::command::Command;
use crate::lessons;
use egui::Ui;
use std::fmt;

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
    words: &'static Words,
    figure: fn() -> Box<dyn Figure>,
}

/// Makes the line of a lesson whose figure begins with its default numbers.
pub const fn entry<F: Figure + Default + 'static>(words: &'static Words) -> Entry {
    Entry {
        words,
        figure: || Box::new(F::default()),
    }
}

/// Lesson of the lab, by its place in the list.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Lesson(usize);

impl fmt::Debug for Lesson {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.words().link)
    }
}

/// Start of a fragment that leads to a lesson.
const PREFIX: &str = "#lab";

impl Lesson {
    /// Returns all lessons, in the order of the list.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..lessons::ALL.len()).map(Self)
    }

    /// Returns its place in the list, from 0 on.
    pub(crate) fn index(self) -> usize {
        self.0
    }

    /// Returns its words.
    #[must_use]
    pub fn words(self) -> &'static Words {
        lessons::ALL[self.0].words
    }

    /// Makes its figure, as it begins.
    pub(crate) fn figure(self) -> Box<dyn Figure> {
        (lessons::ALL[self.0].figure)()
    }

    /// Returns the fragment that leads here.
    #[must_use]
    pub fn hash(self) -> String {
        format!("{PREFIX}={}", self.words().link)
    }

    /// Finds the lesson a fragment leads to; the first one if it names an unknown lesson, `None` if
    /// it does not lead to the lab.
    #[must_use]
    pub fn of_hash(hash: &str) -> Option<Self> {
        let rest = hash.strip_prefix(PREFIX)?;
        if rest.is_empty() {
            return Some(Self::default());
        }
        let link = rest.strip_prefix('=')?;
        let known = Self::all().find(|lesson| lesson.words().link == link);
        Some(known.unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_to_lessons() {
        for lesson in Lesson::all() {
            assert_eq!(Lesson::of_hash(&lesson.hash()), Some(lesson));
        }
        let first = Some(Lesson::default());
        assert_eq!(Lesson::of_hash("#lab"), first);
        assert_eq!(Lesson::of_hash("#lab=kernels"), first);
        assert_eq!(Lesson::of_hash("#lab=nothing"), first);
        assert_eq!(Lesson::of_hash(""), None);
        assert_eq!(Lesson::of_hash("#"), None);
        assert_eq!(Lesson::of_hash("#laboratory"), None);
        assert_eq!(Lesson::of_hash("#AXicq1YqzVSyUkrLz1eyMjIw"), None);
    }

    #[test]
    fn each_lesson_says_three_sentences() {
        for lesson in Lesson::all() {
            let Words {
                title, sentences, ..
            } = lesson.words();
            assert_eq!(sentences.matches(". ").count(), 2, "{title}");
            assert!(sentences.ends_with('.'), "{title}");
            assert!(!sentences.contains("  "), "{title}");
        }
    }
}
