//! The texts that make one model.
use serde::{Deserialize, Serialize};

/// One named text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct File {
    /// What `read` calls it.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// A model: named texts, the first of which is run.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Project {
    /// The texts. The first is run; the others can be `read` from it. Names are unique.
    pub files: Vec<File>,
}
