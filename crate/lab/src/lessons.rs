//! The lessons, each in a file of its own, and their list.

mod centreline;
mod chart;
mod contact;
mod convolution;
mod fitting;
mod grid;
mod kernels;
mod profiles;
mod sculpting;
mod slice;
mod spans;
mod superposition;
mod textures;

use crate::figure::{Entry, Figure, Words, entry};
use crate::lesson::Lesson;
use std::fmt;

/// The lessons, in the order of the page.
pub static ALL: &[Entry] = &[
    entry::<kernels::Kernels>(&kernels::WORDS),
    entry::<convolution::Convolution>(&convolution::WORDS),
    entry::<slice::Slice>(&slice::WORDS),
    entry::<grid::Grid>(&grid::WORDS),
    entry::<profiles::Profiles>(&profiles::WORDS),
    entry::<chart::Chart>(&chart::WORDS),
    entry::<superposition::Superposition>(&superposition::WORDS),
    entry::<spans::Spans>(&spans::WORDS),
    entry::<contact::Contact>(&contact::WORDS),
    entry::<sculpting::Sculpting>(&sculpting::WORDS),
    entry::<fitting::Fitting>(&fitting::WORDS),
    entry::<textures::Textures>(&textures::WORDS),
    entry::<centreline::Centreline>(&centreline::WORDS),
];

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
        (0..ALL.len()).map(Self)
    }

    /// Returns its place in the list, from 0 on.
    pub(crate) fn index(self) -> usize {
        self.0
    }

    /// Returns its words.
    #[must_use]
    pub fn words(self) -> &'static Words {
        ALL[self.0].words
    }

    /// Makes its figure, as it begins.
    pub(crate) fn figure(self) -> Box<dyn Figure> {
        (ALL[self.0].figure)()
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
