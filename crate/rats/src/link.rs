//! A project and a camera as a short text for the fragment of an address.
use crate::Project;
use scene::Camera;
use serde::{Deserialize, Serialize};

/// What a link carries.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shared {
    /// The texts.
    pub project: Project,
    /// The camera the sender chose by hand, if any.
    pub camera: Option<Camera>,
}

/// Longest fragment accepted, characters.
pub const MAX_FRAGMENT: usize = 256 * 1024;
/// Longest text accepted after inflating, bytes.
pub const MAX_INFLATED: usize = 1024 * 1024;

/// Why a link could not be opened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LinkError {}

/// The fragment (without `#`).
///
/// # Errors
/// If the project is larger than the limits.
pub fn encode(shared: &Shared) -> Result<String, LinkError> {
    let _ = shared;
    todo!()
}

/// Reads what [`encode`] wrote, trusting nothing.
///
/// # Errors
/// Says in a sentence what is wrong with the link.
pub fn decode(fragment: &str) -> Result<Shared, LinkError> {
    let _ = fragment;
    todo!()
}
