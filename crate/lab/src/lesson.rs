//! The lesson that is open, or that a link leads to. [`crate::lessons`] says what it is.

/// Lesson of the lab, by its place in the list.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Lesson(pub(crate) usize);
