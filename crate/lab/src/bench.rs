//! The services that a lesson draws with.

use crate::pictures::Pictures;
use crate::{Command, Dataset};
use std::collections::BTreeMap;

/// Everything a lesson works with beside its own numbers.
pub struct Bench<'a> {
    /// The dataset that is open in the editor.
    pub dataset: Dataset<'a>,
    /// Small traced pictures.
    pub pictures: &'a mut Pictures,
    /// Commands of the user, carried out after the frame.
    pub commands: &'a mut Vec<Command>,
    /// Numbers that the lesson shows.
    pub readings: &'a mut BTreeMap<&'static str, f64>,
    /// Whether the page is narrow.
    pub narrow: bool,
    /// The height that a figure may have without scrolling.
    pub height: f32,
}
