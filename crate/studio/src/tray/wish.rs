//! Wishes about results of the jobs on pictures.

/// Wishes about results, by their numbers on the tray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrayWish {
    /// Show one large.
    Show(usize),
    /// Write one to a file.
    Save(usize),
    /// Go to the command that made one.
    Find(usize),
    /// Make one an image of the work.
    Keep(usize),
    /// Show only the head of the tray, or all of it.
    Fold(bool),
}
