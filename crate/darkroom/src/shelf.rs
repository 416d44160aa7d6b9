//! The shelf on which pictures lie.

use picture::limits::MAX_PIXELS;
use std::io::Write;

/// Keeps files by name. A [`crate::Bench`] checks all names ([`crate::name`]) before it asks.
pub trait Shelf {
    /// The bytes of a file.
    ///
    /// # Errors
    /// A sentence that names the file, if it is not there or may not be read.
    fn read(&self, name: &str) -> Result<Vec<u8>, String>;

    /// Begins a file. What has this name stays as it is until [`Target::keep`].
    ///
    /// # Errors
    /// A sentence that names the file, if it may not be written.
    fn create(&self, name: &str) -> Result<Box<dyn Target>, String>;

    /// Pixels of the largest picture that there is room for.
    fn most_pixels(&self) -> u64 {
        MAX_PIXELS
    }

    /// Whether results that the text does not save are written too, because here people can look at
    /// them.
    fn is_seen(&self) -> bool {
        false
    }
}

/// A file that is being written. Dropped before [`Target::keep`], it leaves nothing behind.
pub trait Target: Write {
    /// Ends the file and puts it in its place.
    ///
    /// # Errors
    /// A sentence that names the file, if it cannot be kept.
    fn keep(self: Box<Self>) -> Result<(), String>;
}
