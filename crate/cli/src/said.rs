//! Messages of the program to a person, and the logs that keep them.

use darkroom::Target;
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// The destination of everything said to a person.
pub struct Said {
    log: Option<(PathBuf, File)>,
    /// The log that the dataset itself keeps: its name and the file.
    own_log: Option<(String, Box<dyn Target>)>,
}

impl Said {
    /// Begins, with a log that the command line names.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn new(log: Option<&Path>) -> Result<Self, String> {
        let log = log
            .map(|path| match File::create(path) {
                Ok(file) => Ok((path.to_path_buf(), file)),
                Err(error) => Err(format!("cannot write {}: {error}", path.display())),
            })
            .transpose()?;
        Ok(Self { log, own_log: None })
    }

    /// Begins a log of the dataset's own.
    pub fn open_log(&mut self, name: String, target: Box<dyn Target>) {
        self.own_log = Some((name, target));
    }

    /// Ends the dataset's own log, if there is one.
    ///
    /// # Errors
    /// If it cannot be kept.
    pub fn close_log(&mut self) -> Result<(), String> {
        self.own_log
            .take()
            .map_or(Ok(()), |(_, target)| target.keep())
    }

    /// Writes a text into the dataset's own log alone.
    pub fn note(&mut self, text: &str) {
        if let Some((name, target)) = &mut self.own_log
            && !text.is_empty()
            && let Err(error) = writeln!(target, "{text}")
        {
            eprintln!("the log ends here, cannot write {name}: {error}");
            self.own_log = None;
        }
    }

    /// Says a text on the standard error, and in the logs.
    pub fn say(&mut self, text: &str) {
        if text.is_empty() {
            return;
        }
        eprintln!("{text}");
        self.note(text);
        if let Some((path, file)) = &mut self.log
            && let Err(error) = writeln!(file, "{text}")
        {
            eprintln!(
                "the log ends here, cannot write {}: {error}",
                path.display()
            );
            self.log = None;
        }
    }
}
