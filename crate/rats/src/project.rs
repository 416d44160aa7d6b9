//! The texts that make one model.

use serde::{Deserialize, Serialize};

/// A named text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct File {
    /// The name, by which `read` finds it.
    pub name: String,
    /// The text.
    pub text: String,
}

/// A model: named texts, the first of which is run.
///
/// ```
/// use rats::{File, Project, compile};
///
/// let file = |name: &str, text: &str| File { name: name.into(), text: text.into() };
/// let project = Project {
///     files: vec![
///         file("main.rat", "read clay.rat\nsphere Clay 1, 0 0 0\n"),
///         file("clay.rat", "surface Clay, diffuse SandyBrown\n"),
///     ],
/// };
/// assert_eq!(compile(&project).scene.elements.len(), 1);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Project {
    /// The texts. The first is run; the others can be `read` from it. Names are unique.
    pub files: Vec<File>,
}

impl Project {
    /// Makes a project of one text, `main.rat`.
    #[must_use]
    pub fn single(text: impl Into<String>) -> Self {
        let name = String::from("main.rat");
        let text = text.into();
        Self {
            files: vec![File { name, text }],
        }
    }
}
