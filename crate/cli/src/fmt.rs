//! `sinew fmt`: lays datasets out.

use crate::{Outcome, files, whole};
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};

/// `sinew fmt FILE… [--check]`.
#[derive(Args)]
pub struct Fmt {
    /// The datasets
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Write nothing, but tell which files would change; the exit status is 1 then
    #[arg(long)]
    check: bool,
}

impl Fmt {
    /// Writes the files that change; with `--check` only tells them, and the result is false then.
    pub fn run(&self) -> Outcome {
        files::each(&self.files, |file| {
            let text = files::read(file)?;
            let tidy = assist::format(&text);
            if tidy == text {
                return Ok(true);
            }
            if self.check {
                eprintln!("{} would be laid out anew", file.display());
            } else {
                replace(file, &tidy)?;
                eprintln!("laid out {}", file.display());
            }
            Ok(!self.check)
        })
    }
}

/// Writes a text in the place of another, which stays as it is if that fails.
fn replace(path: &Path, text: &str) -> Result<(), String> {
    let fail = |error: std::io::Error| format!("cannot write {}: {error}", path.display());
    // The file that a link leads to is replaced, not the link.
    let path = path.canonicalize().map_err(fail)?;
    let permissions = path.metadata().map_err(fail)?.permissions();
    if permissions.readonly() {
        return Err(format!("cannot write {}: it is read-only", path.display()));
    }
    whole::write(&path, |file| {
        file.write_all(text.as_bytes())
            .and_then(|()| file.set_permissions(permissions))
            .map_err(|error| error.to_string())
    })
}
