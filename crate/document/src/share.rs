//! Links: the whole project and the camera in the fragment of the page's address.

use rats::Project;
use rats::link::{self, Shared};
use scene::Camera;

/// Makes a link to a project seen from a camera. `page` is the page's address; its fragment is
/// replaced.
///
/// # Errors
/// If the project is too large for a link.
pub fn link(page: &str, project: &Project, camera: Option<Camera>) -> Result<String, String> {
    let shared = Shared {
        project: project.clone(),
        camera,
    };
    let fragment = link::encode(&shared).map_err(|error| error.to_string())?;
    let page = page.split('#').next().unwrap_or_default();
    Ok(format!("{page}#{fragment}"))
}

/// Reads the work in a fragment (with or without `#`); `None` if it is empty.
///
/// # Errors
/// If it is damaged, or the work is too large.
pub fn open(fragment: &str) -> Option<Result<Shared, String>> {
    let fragment = fragment.strip_prefix('#').unwrap_or(fragment);
    if fragment.is_empty() {
        return None;
    }
    let shared = link::decode(fragment).map_err(|error| error.to_string());
    Some(shared.and_then(|shared| {
        crate::session::check_size(&shared.project).map_err(|refused| refused.to_string())?;
        if shared.project.files.is_empty() {
            return Err(String::from("This link carries no text."));
        }
        Ok(shared)
    }))
}

/// Returns the size of a link in words.
#[must_use]
pub fn size(link: &str) -> String {
    let length = link.len();
    if length < 2000 {
        format!("{length} characters")
    } else {
        format!("{:.1} kB", length as f64 / 1000.0)
    }
}
