//! The surroundings of the handles.

use document::session::Session;

/// Surroundings of the handles.
pub struct Around<'a> {
    /// The user's work.
    pub session: &'a Session,
    /// The file and byte of the editor's caret, once it had one.
    pub caret: Option<(usize, usize)>,
    /// Whether something lies over the page.
    pub covered: bool,
    /// Whether fingers are likely.
    pub touch: bool,
}
