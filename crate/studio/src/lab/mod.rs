//! The lab: eight small lessons, each one figure to take hold of, that show how a convolution
//! surface comes about. Each has its own link (`#lab=kernels`), and opening one leaves the open
//! work alone.
//!
//! A lesson keeps its own numbers, draws its figure with [`plot`] and can write a dataset that shows
//! the same thing in the editor. Small traced pictures come from [`pictures`], which lends the
//! workers from the main picture while that rests.

pub mod chart;
pub mod contour;
pub mod convolution;
pub mod formulas;
pub mod grid;
pub mod kernels;
mod page;
pub mod pictures;
pub mod plot;
pub mod profiles;
pub mod sample;
pub mod slice;
pub mod spans;
pub mod superposition;
mod text;
mod tools;

pub use page::show;

use crate::command::Command;
use crate::pool::Pool;
use crate::session::Session;
use pictures::Pictures;
use serde::Serialize;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

/// One lesson.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Lesson {
    /// The nine kernels.
    #[default]
    Kernels,
    /// Geometry times kernel, in one dimension.
    Convolution,
    /// The field of the open dataset on a plane.
    Slice,
    /// Blobbiness against radius.
    Grid,
    /// Strength that varies along a bone.
    Profiles,
    /// Kernels against primitives.
    Chart,
    /// Why a cut bone shows no seam.
    Superposition,
    /// What the number of Hermite spans does.
    Spans,
}

/// How a fragment begins that leads to a lesson.
const PREFIX: &str = "#lab";

impl Lesson {
    /// All lessons, in the order of the list.
    pub const ALL: [Self; 8] = [
        Self::Kernels,
        Self::Convolution,
        Self::Slice,
        Self::Grid,
        Self::Profiles,
        Self::Chart,
        Self::Superposition,
        Self::Spans,
    ];

    /// The word in its link.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Kernels => "kernels",
            Self::Convolution => "convolution",
            Self::Slice => "slice",
            Self::Grid => "grid",
            Self::Profiles => "profiles",
            Self::Chart => "chart",
            Self::Superposition => "superposition",
            Self::Spans => "spans",
        }
    }

    /// The fragment that leads here.
    #[must_use]
    pub fn hash(self) -> String {
        format!("{PREFIX}={}", self.word())
    }

    /// Where a fragment leads, if it leads to the lab; a lesson that is not known is the first one.
    #[must_use]
    pub fn of_hash(hash: &str) -> Option<Self> {
        let rest = hash.strip_prefix(PREFIX)?;
        if rest.is_empty() {
            return Some(Self::default());
        }
        let word = rest.strip_prefix('=')?;
        let known = Self::ALL.into_iter().find(|lesson| lesson.word() == word);
        Some(known.unwrap_or_default())
    }

    /// Its title.
    #[must_use]
    pub fn title(self) -> &'static str {
        text::of(self).title
    }
}

/// What scripts can read of the lab.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Report {
    /// The word of the open lesson.
    pub lesson: &'static str,
    /// Its title.
    pub title: &'static str,
    /// Small pictures still to be traced.
    pub waiting: usize,
    /// Small pictures that are there.
    pub drawn: usize,
    /// Texts that the language does not draw (yet).
    pub refused: usize,
    /// What the lesson shows as numbers.
    pub readings: BTreeMap<&'static str, f64>,
}

/// What a lesson works with, beside its own numbers.
pub struct Bench<'a> {
    /// The open work.
    pub session: &'a Session,
    /// Small traced pictures.
    pub pictures: &'a mut Pictures,
    /// What the user asked for.
    pub commands: &'a mut Vec<Command>,
    /// Numbers that the lesson shows.
    pub readings: &'a mut BTreeMap<&'static str, f64>,
    /// Whether the page is narrow.
    pub narrow: bool,
    /// The height that a figure may have without scrolling.
    pub height: f32,
}

/// The lab.
pub struct Lab {
    open: bool,
    lesson: Lesson,
    /// The fragment of the address before the lab was entered.
    came_from: String,
    /// What was just done, and until when to say so.
    said: Option<(&'static str, f64)>,
    /// Small traced pictures.
    pub pictures: Pictures,
    readings: BTreeMap<&'static str, f64>,
    kernels: kernels::Kernels,
    convolution: convolution::Convolution,
    slice: slice::Slice,
    grid: grid::Grid,
    profiles: profiles::Profiles,
    chart: chart::Chart,
    superposition: superposition::Superposition,
    spans: spans::Spans,
}

impl Lab {
    /// The lab, open at a lesson or closed.
    #[must_use]
    pub fn new(pool: Rc<RefCell<Pool>>, lesson: Option<Lesson>) -> Self {
        Self {
            open: lesson.is_some(),
            lesson: lesson.unwrap_or_default(),
            came_from: String::new(),
            said: None,
            pictures: Pictures::new(pool),
            readings: BTreeMap::new(),
            kernels: kernels::Kernels::default(),
            convolution: convolution::Convolution::default(),
            slice: slice::Slice::default(),
            grid: grid::Grid::default(),
            profiles: profiles::Profiles::default(),
            chart: chart::Chart::default(),
            superposition: superposition::Superposition::default(),
            spans: spans::Spans::default(),
        }
    }

    /// Whether the lab stands in place of the editor.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// The lesson that is open, or was last.
    #[must_use]
    pub fn lesson(&self) -> Lesson {
        self.lesson
    }

    /// The title for the browser's tab, while the lab is open.
    #[must_use]
    pub fn title(&self) -> Option<&'static str> {
        self.open.then(|| self.lesson.title())
    }

    /// Goes to a lesson. `address` is the fragment before, to which leaving the lab leads back.
    pub fn open(&mut self, lesson: Lesson, address: &str) {
        if !self.open {
            address.clone_into(&mut self.came_from);
        }
        self.open = true;
        self.lesson = lesson;
        self.readings.clear();
        self.said = None;
    }

    /// The fragment that leads back.
    #[must_use]
    pub fn came_from(&self) -> &str {
        &self.came_from
    }

    /// Leaves the lab. The lessons keep their numbers.
    pub fn close(&mut self) {
        self.open = false;
        self.came_from.clear();
    }

    /// Says for a while what was done.
    pub fn say(&mut self, text: &'static str, now: f64) {
        self.said = Some((text, now + 4.0));
    }

    /// What scripts can read, while the lab is open.
    #[must_use]
    pub fn report(&self) -> Option<Report> {
        self.open.then(|| Report {
            lesson: self.lesson.word(),
            title: self.lesson.title(),
            waiting: self.pictures.waiting(),
            drawn: self.pictures.drawn(),
            refused: self.pictures.refused(),
            readings: self.readings.clone(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_to_lessons() {
        for lesson in Lesson::ALL {
            assert_eq!(Lesson::of_hash(&lesson.hash()), Some(lesson));
        }
        assert_eq!(Lesson::of_hash("#lab"), Some(Lesson::Kernels));
        assert_eq!(Lesson::of_hash("#lab=nothing"), Some(Lesson::Kernels));
        assert_eq!(Lesson::of_hash(""), None);
        assert_eq!(Lesson::of_hash("#"), None);
        assert_eq!(Lesson::of_hash("#laboratory"), None);
        assert_eq!(Lesson::of_hash("#AXicq1YqzVSyUkrLz1eyMjIw"), None);
    }
}
