//! Changes of texts, as a hand, a tool or a person asks for them.

use crate::Project;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Change of one file.
///
/// ```
/// use rats::{Project, TextEdit};
///
/// let project = Project::single("sphere Clay 1, 0 0 0\n");
/// let edit = TextEdit::new(0, 12..13, "2.5");
/// assert_eq!(project.apply(&[edit]).files[0].text, "sphere Clay 2.5, 0 0 0\n");
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TextEdit {
    /// Index of the file in [`Project::files`].
    pub file: usize,
    /// The byte range that is replaced; `usize::MAX` stands for the end of the text.
    pub span: Range<usize>,
    /// The text that replaces it.
    pub text: String,
}

impl TextEdit {
    /// Replaces a byte range of a file.
    pub fn new(file: usize, span: Range<usize>, text: impl Into<String>) -> Self {
        let text = text.into();
        Self { file, span, text }
    }

    /// Replaces the whole text of a file.
    pub fn whole(file: usize, text: impl Into<String>) -> Self {
        Self::new(file, 0..usize::MAX, text)
    }

    /// Returns the text with changes made, which must be in its order and must not overlap. One
    /// whose range does not lie on characters is left out.
    pub fn apply<'e>(text: &str, edits: impl IntoIterator<Item = &'e Self>) -> String {
        let mut new = String::with_capacity(text.len());
        let mut at = 0;
        for edit in edits {
            let Range { start, mut end } = edit.span;
            if end == usize::MAX {
                end = text.len();
            }
            if let Some(before) = text.get(at..start)
                && text.get(start..end).is_some()
            {
                new += before;
                new += &edit.text;
                at = end;
            }
        }
        new + &text[at..]
    }
}

impl Project {
    /// Returns the project with changes made; those of a file must be in the order of its text and
    /// must not overlap.
    #[must_use]
    pub fn apply(&self, edits: &[TextEdit]) -> Self {
        let mut project = self.clone();
        for (index, file) in project.files.iter_mut().enumerate() {
            let mut own = edits.iter().filter(|edit| edit.file == index).peekable();
            if own.peek().is_some() {
                file.text = TextEdit::apply(&file.text, own);
            }
        }
        project
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_are_made_in_the_order_of_the_text() {
        let edits = [
            TextEdit::new(0, 0..0, "# "),
            TextEdit::new(0, 2..4, ""),
            TextEdit::new(0, 4..4, "!"),
        ];
        assert_eq!(TextEdit::apply("abcd", &edits), "# ab!");
        assert_eq!(TextEdit::apply("abcd", &[TextEdit::whole(0, "é")]), "é");
    }

    #[test]
    fn an_edit_within_a_character_is_left_out() {
        for span in [1..2, 0..1, 5..6, 3..9] {
            assert_eq!(TextEdit::apply("é1", &[TextEdit::new(0, span, "x")]), "é1");
        }
    }
}
