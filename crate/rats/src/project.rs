//! The texts that make one model, and the other files that they use.

use serde::{Deserialize, Serialize};
use std::sync::Arc;

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

/// A file that is no text: an image or a mesh. Links do not carry it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Asset {
    /// What commands call it.
    pub name: String,
    /// Its content.
    pub bytes: Arc<[u8]>,
}
