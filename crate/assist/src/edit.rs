//! A change of a text, as renaming and handles ask for it.

use rats::Project;
use std::ops::Range;

/// A change of one file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// Index of the file in [`Project::files`].
    pub file: usize,
    /// The byte range that is replaced.
    pub span: Range<usize>,
    /// The text that replaces it.
    pub text: String,
}

/// The project with changes made, which must be in the order of the text and must not overlap.
///
/// ```
/// use assist::{Edit, apply};
///
/// let project = rats::Project::single("sphere Clay 1, 0 0 0\n");
/// let edit = Edit { file: 0, span: 12..13, text: "2.5".into() };
/// assert_eq!(apply(&project, &[edit]).files[0].text, "sphere Clay 2.5, 0 0 0\n");
/// ```
#[must_use]
pub fn apply(project: &Project, edits: &[Edit]) -> Project {
    let mut project = project.clone();
    for (index, file) in project.files.iter_mut().enumerate() {
        let mut text = String::with_capacity(file.text.len());
        let mut at = 0;
        for edit in edits.iter().filter(|edit| edit.file == index) {
            let Some(before) = file.text.get(at..edit.span.start) else {
                continue;
            };
            text += before;
            text += &edit.text;
            at = edit.span.end;
        }
        text += file.text.get(at..).unwrap_or("");
        file.text = text;
    }
    project
}
