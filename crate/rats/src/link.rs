//! Packs a project and a camera into a short text for the fragment of an address.
//!
//! The form is: one byte for the version, then the deflated JSON of a [`Shared`], all in base64url
//! without padding. Version 1 is frozen: every link that was ever made must open. Links come from
//! strangers, so [`decode`] bounds and checks everything.
//!
//! ```
//! use rats::Project;
//! use rats::link::{Shared, decode, encode};
//!
//! let project = Project::single("surface Clay, diffuse SandyBrown\nsphere Clay 1, 0 0 0\n");
//! let shared = Shared { project, camera: None };
//! let fragment = encode(&shared).unwrap();
//! assert_eq!(decode(&fragment), Ok(shared));
//! assert!(decode("no link at all").is_err());
//! ```

use crate::limits::{MAX_FILES, MAX_MAGNITUDE};
use crate::{File, Project};
use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use scene::Camera;
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::fmt;

/// The content of a link.
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
/// Longest file name accepted, bytes.
pub const MAX_NAME: usize = 255;

/// The version that [`encode`] writes.
const VERSION: u8 = 1;

/// Reason why a link could not be made or opened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LinkError {
    /// The fragment is longer than [`MAX_FRAGMENT`].
    TooLong,
    /// The content is larger than [`MAX_INFLATED`].
    TooLarge,
    /// The fragment has not the form of our links.
    NotALink,
    /// The link has a version that this build does not know.
    NewerVersion(u8),
    /// The link has the right form, but its content is broken.
    Damaged,
    /// The content is not a project; the sentence says why.
    NotAProject(String),
}

impl fmt::Display for LinkError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLong => write!(
                f,
                "The link is too long: {MAX_FRAGMENT} characters is the limit. Save the project \
                 to a file instead."
            ),
            Self::TooLarge => write!(
                f,
                "The project is too large for a link: {MAX_INFLATED} bytes is the limit. Save it \
                 to a file instead."
            ),
            Self::NotALink => write!(f, "This is not a link to a Sinew project."),
            Self::NewerVersion(version) => write!(
                f,
                "This link was made by a newer Sinew (form {version}). Reload the page to get the \
                 newest one."
            ),
            Self::Damaged => write!(
                f,
                "The link is damaged: a part of it is missing or changed. Ask for it to be sent \
                 again."
            ),
            Self::NotAProject(why) => write!(f, "The link does not hold a project: {why}."),
        }
    }
}

impl std::error::Error for LinkError {}

/// Returns the fragment, without `#`.
///
/// # Errors
/// If the project is larger than the limits, or one that [`decode`] would refuse.
pub fn encode(shared: &Shared) -> Result<String, LinkError> {
    check(shared)?;
    let json =
        serde_json::to_vec(shared).map_err(|error| LinkError::NotAProject(error.to_string()))?;
    if json.len() > MAX_INFLATED {
        return Err(LinkError::TooLarge);
    }
    let mut bytes = vec![VERSION];
    bytes.extend(miniz_oxide::deflate::compress_to_vec(&json, 9));
    let fragment = URL_SAFE_NO_PAD.encode(bytes);
    if fragment.len() > MAX_FRAGMENT {
        return Err(LinkError::TooLong);
    }
    Ok(fragment)
}

/// Reads what [`encode`] wrote, trusting nothing.
///
/// # Errors
/// Says in a sentence what is wrong with the link.
pub fn decode(fragment: &str) -> Result<Shared, LinkError> {
    if fragment.len() > MAX_FRAGMENT {
        return Err(LinkError::TooLong);
    }
    let bytes = URL_SAFE_NO_PAD.decode(fragment).map_err(|_| {
        // A text with the prefix of our links is a link that was cut or changed.
        let start = fragment.get(..4).map(|start| URL_SAFE_NO_PAD.decode(start));
        match start {
            Some(Ok(bytes)) if bytes[0] == VERSION => LinkError::Damaged,
            _ => LinkError::NotALink,
        }
    })?;
    let deflated = match bytes.split_first() {
        None | Some((0, _)) => return Err(LinkError::NotALink),
        Some((&VERSION, rest)) => rest,
        Some((&newer, _)) => return Err(LinkError::NewerVersion(newer)),
    };
    let json = miniz_oxide::inflate::decompress_to_vec_with_limit(deflated, MAX_INFLATED).map_err(
        |error| match error.status {
            miniz_oxide::inflate::TINFLStatus::HasMoreOutput => LinkError::TooLarge,
            _ => LinkError::Damaged,
        },
    )?;
    let shared: Shared = serde_json::from_slice(&json).map_err(|_| LinkError::Damaged)?;
    check(&shared)?;
    Ok(shared)
}

/// Checks the limits of every project that a link carries.
fn check(shared: &Shared) -> Result<(), LinkError> {
    let files = &shared.project.files;
    if files.is_empty() {
        return refuse("it has no file");
    }
    if files.len() > MAX_FILES {
        return refuse(&format!("it has more than {MAX_FILES} files"));
    }
    let mut names = HashSet::new();
    for File { name, .. } in files {
        if name.is_empty() || name.len() > MAX_NAME || name.chars().any(char::is_control) {
            return refuse("a file has no proper name");
        }
        if !names.insert(name) {
            return refuse("two files have the same name");
        }
    }
    if let Some(camera) = shared.camera {
        let points = [camera.eye, camera.target, camera.up];
        let finite = points
            .iter()
            .all(|p| p.is_finite() && p.abs().max_element() <= MAX_MAGNITUDE);
        let shifted = camera.shift.iter().all(|s| s.abs() <= Camera::MAX_SHIFT);
        let [least, most] = Camera::PIXELS;
        let proportioned = (least..=most).contains(&camera.pixel);
        if !finite || !shifted || !proportioned || !(0.01..=179.0).contains(&camera.fov) {
            return refuse("its camera is out of bounds");
        }
    }
    Ok(())
}

fn refuse(why: &str) -> Result<(), LinkError> {
    Err(LinkError::NotAProject(why.to_owned()))
}
