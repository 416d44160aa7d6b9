//! Files that are there completely or not at all.

use darkroom::Target;
use std::fs::{File, Permissions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A file that is being written beside its place; what is there stays until the new one is done.
pub struct Whole {
    path: PathBuf,
    part: PathBuf,
    /// `None` when it is in its place.
    file: Option<BufWriter<File>>,
}

impl Whole {
    /// Begins a file.
    ///
    /// # Errors
    /// If it cannot be written there.
    pub fn create(path: &Path) -> Result<Self, String> {
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(".part");
        let part = path.with_file_name(name);
        // Remains of an interrupted run, or anything else there, are removed: a link would lead
        // the bytes elsewhere.
        let _ = std::fs::remove_file(&part);
        let file = File::create_new(&part)
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
        Ok(Self {
            path: path.to_path_buf(),
            part,
            file: Some(BufWriter::new(file)),
        })
    }

    /// Gives the file the permissions of another.
    ///
    /// # Errors
    /// If the system refuses.
    pub fn set_permissions(&self, permissions: Permissions) -> io::Result<()> {
        match &self.file {
            Some(file) => file.get_ref().set_permissions(permissions),
            None => Ok(()),
        }
    }

    fn finish(&mut self) -> io::Result<()> {
        if let Some(file) = &mut self.file {
            file.flush()?;
            std::fs::rename(&self.part, &self.path)?;
            self.file = None;
        }
        Ok(())
    }
}

impl Write for Whole {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.file {
            Some(file) => file.write(bytes),
            None => Err(io::ErrorKind::BrokenPipe.into()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), Write::flush)
    }
}

impl Target for Whole {
    fn keep(mut self: Box<Self>) -> Result<(), String> {
        self.finish()
            .map_err(|error| format!("cannot write {}: {error}", self.path.display()))
    }
}

impl Drop for Whole {
    fn drop(&mut self) {
        if self.file.take().is_some() {
            // The mistake that is told matters more than a leftover.
            let _ = std::fs::remove_file(&self.part);
        }
    }
}

/// Writes a whole file at once.
///
/// # Errors
/// If the file cannot be written, or what `fill` says.
pub fn write(
    path: &Path,
    fill: impl FnOnce(&mut Whole) -> Result<(), String>,
) -> Result<(), String> {
    let mut file = Box::new(Whole::create(path)?);
    fill(&mut file).map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    file.keep()
}
