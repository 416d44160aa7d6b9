//! The jobs of a dataset on the pictures in its folder.
//!
//! A dataset may come from a stranger, so a job reads and writes nothing outside the folder of the
//! dataset, not even through a link that lies in it, and never writes over a dataset. It does write
//! over pictures of the name that the text gives, or that a result without a name gets, as a second
//! run of the same text must.

use crate::files;
use crate::whole::Whole;
use darkroom::{Bench, Shelf, Step, Target, name};
use picture::Picture;
use rats::Tool;
use std::path::{Path, PathBuf};

/// Largest file of a picture that is read, bytes.
const MAX_FILE: u64 = 512 << 20;

/// Carries out the jobs of a text in order, in the dataset's folder. Each gives a sentence that
/// says what was done, or why it could not be; one that fails does not keep the others from being
/// tried.
pub fn carry_out(tools: &[Tool], folder: &Path) -> Vec<Result<String, String>> {
    let mut bench = Bench::new(Folder(folder.to_path_buf()), tools.to_vec());
    let mut said = Vec::new();
    while let Some(step) = bench.step() {
        if let Step::Finished(finished) = step {
            said.push(finished.map(|done| done.said));
        }
    }
    said
}

/// Writes a picture under a name that a text gives, in the dataset's folder, and says so.
///
/// # Errors
/// If the name leads out of the folder, is that of a dataset or of no known format, or if writing
/// fails.
pub fn save(folder: &Path, name: &str, picture: &Picture) -> Result<String, String> {
    darkroom::write(&Folder(folder.to_path_buf()), name, picture)
}

/// Begins a file that a text names, such as a log, in the dataset's folder.
///
/// # Errors
/// If the name leads out of the folder or is that of a dataset, or if writing fails.
pub fn begin(folder: &Path, name: &str) -> Result<Box<dyn Target>, String> {
    if name::is_dataset(name) {
        return Err(format!("{name} is a dataset and is not written over"));
    }
    Folder(folder.to_path_buf()).create(name)
}

/// The folder of a dataset.
struct Folder(PathBuf);

impl Folder {
    fn canonical(&self) -> Result<PathBuf, String> {
        here(&self.0)
            .canonicalize()
            .map_err(|error| format!("cannot open {}: {error}", here(&self.0).display()))
    }
}

impl Shelf for Folder {
    fn read(&self, name: &str) -> Result<Vec<u8>, String> {
        let path = files::inside(&self.0, name).ok_or_else(|| name::outside(name))?;
        let fail = |error| format!("cannot read {name}: {error}");
        let real = path.canonicalize().map_err(fail)?;
        if !real.starts_with(self.canonical()?) {
            return Err(name::outside(name));
        }
        let size = real.metadata().map_err(fail)?.len();
        if size > MAX_FILE {
            return Err(format!(
                "{name} has {size} bytes; the limit for a picture is {MAX_FILE}"
            ));
        }
        std::fs::read(real).map_err(fail)
    }

    fn create(&self, name: &str) -> Result<Box<dyn Target>, String> {
        let path = files::inside(&self.0, name).ok_or_else(|| name::outside(name))?;
        let real = here(path.parent().unwrap_or(&self.0))
            .canonicalize()
            .map_err(|error| format!("cannot write {name}: {error}"))?;
        let is_link = path
            .symlink_metadata()
            .is_ok_and(|data| data.file_type().is_symlink());
        if is_link || !real.starts_with(self.canonical()?) {
            return Err(name::outside(name));
        }
        Ok(Box::new(Whole::create(&path)?))
    }
}

/// A folder with a name: the empty path is the one we are in.
fn here(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    }
}

#[cfg(test)]
mod tests;
