//! Finds the places where a name is made and used.

use crate::index::{Index, Place};
use rats::Project;
/// Finds the place where the name at a byte is made: of several places the one that counts
/// there. A file's name leads to the beginning of the file.
/// file's name leads to the beginning of the file.
///
/// ```
/// let text = "var r = 1\nsurface Clay, diffuse SandyBrown\nsphere Clay r, 0 0 0\n";
/// let used = text.find("r, 0").unwrap();
/// let made = assist::definition(&rats::Project::single(text), 0, used).unwrap();
/// assert_eq!((made.file, made.span), (0, 4..5));
/// ```
#[must_use]
pub fn definition(project: &Project, file: usize, byte: usize) -> Option<Place> {
    Index::of(project).definition_at(file, byte)
}

/// Finds all places of the name at a byte, those that make it too, in the order of files and
/// places.
///
/// ```
/// let text = "var r = 1\nsurface Clay, diffuse SandyBrown\nsphere Clay r, r 0 0\n";
/// assert_eq!(assist::references(&rats::Project::single(text), 0, 4).len(), 3);
/// ```
#[must_use]
pub fn references(project: &Project, file: usize, byte: usize) -> Vec<Place> {
    Index::of(project).references_at(file, byte)
}

impl Index<'_> {
    /// Finds the definition of a name, as [`definition`] does.
    #[must_use]
    pub fn definition_at(&self, file: usize, byte: usize) -> Option<Place> {
        let definition = self.definition(self.occurrence(file, byte)?)?;
        Some(definition.place.clone())
    }

    /// Finds the places of a name, as [`references`] does.
    #[must_use]
    pub fn references_at(&self, file: usize, byte: usize) -> Vec<Place> {
        let Some(occurrence) = self.occurrence(file, byte) else {
            return Vec::new();
        };
        self.all_of(occurrence)
            .map(|o| o.place.clone())
            .filter(|place| !place.span.is_empty())
            .collect()
    }
}
