//! State of the lab: the open lesson and the numbers of all lessons.

use crate::figure::{Figure, Words};
use crate::lesson::Lesson;
use crate::pictures::Pictures;
use pool::Pool;
use serde::Serialize;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

/// State of the lab for scripts.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Report {
    /// The word of the open lesson.
    pub lesson: &'static str,
    /// The title of the open lesson.
    pub title: &'static str,
    /// The words of all lessons, in the order of the list.
    pub lessons: Vec<&'static str>,
    /// Small pictures still to be traced.
    pub waiting: usize,
    /// Small pictures that are there.
    pub drawn: usize,
    /// Texts that the language does not draw (yet).
    pub refused: usize,
    /// Numbers that the lesson shows.
    pub readings: BTreeMap<&'static str, f64>,
}

/// The lab.
pub struct Lab {
    open: bool,
    pub(crate) lesson: Lesson,
    /// The fragment of the address before the lab was entered.
    came_from: String,
    /// A message about the last action, and until when it is shown.
    pub(crate) message: Option<(&'static str, f64)>,
    /// Small traced pictures.
    pub pictures: Pictures,
    pub(crate) readings: BTreeMap<&'static str, f64>,
    /// The figures of all lessons, in the order of the list.
    pub(crate) figures: Vec<Box<dyn Figure>>,
}

impl Lab {
    /// Makes the lab, open at a lesson or closed.
    #[must_use]
    pub fn new(pool: Rc<RefCell<Pool>>, lesson: Option<Lesson>) -> Self {
        Self {
            open: lesson.is_some(),
            lesson: lesson.unwrap_or_default(),
            came_from: String::new(),
            message: None,
            pictures: Pictures::new(pool),
            readings: BTreeMap::new(),
            figures: Lesson::all().map(Lesson::figure).collect(),
        }
    }

    /// Returns whether the lab stands in place of the editor.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Returns the lesson that is open, or was last.
    #[must_use]
    pub fn lesson(&self) -> Lesson {
        self.lesson
    }

    /// Returns the title for the browser's tab, while the lab is open.
    #[must_use]
    pub fn title(&self) -> Option<&'static str> {
        self.open.then(|| self.lesson.words().title)
    }

    /// Goes to a lesson. `address` is the fragment before, to which leaving the lab leads back.
    pub fn open(&mut self, lesson: Lesson, address: &str) {
        if !self.open {
            address.clone_into(&mut self.came_from);
        }
        self.open = true;
        self.lesson = lesson;
        self.readings.clear();
        self.message = None;
    }

    /// Returns the fragment that leads back.
    #[must_use]
    pub fn came_from(&self) -> &str {
        &self.came_from
    }

    /// Leaves the lab. The lessons keep their numbers.
    pub fn close(&mut self) {
        self.open = false;
        self.came_from.clear();
    }

    /// Shows a message about an action for a while.
    pub fn say(&mut self, text: &'static str, now: f64) {
        self.message = Some((text, now + 4.0));
    }

    /// Returns the state for scripts, while the lab is open.
    #[must_use]
    pub fn report(&self) -> Option<Report> {
        let Words { link, title, .. } = self.lesson.words();
        self.open.then(|| Report {
            lesson: link,
            title,
            lessons: Lesson::all().map(|lesson| lesson.words().link).collect(),
            waiting: self.pictures.waiting(),
            drawn: self.pictures.count_drawn(),
            refused: self.pictures.count_refused(),
            readings: self.readings.clone(),
        })
    }
}
