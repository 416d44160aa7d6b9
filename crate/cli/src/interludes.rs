//! Requests of a dataset to the program besides its pictures: to wait for a key, to keep a log,
//! to tell the time.

use crate::said::Said;
use crate::tools;
use rats::compiled::{Act, Interlude};
use std::io::IsTerminal;
use std::path::Path;
use std::time::Instant;

/// The interludes of a dataset that are still to come.
pub struct Interludes<'a> {
    left: std::vec::IntoIter<Interlude>,
    /// The dataset's folder.
    folder: &'a Path,
    /// The messages about the text, which a log begins with.
    messages: &'a str,
    /// The time since the stopwatch was started.
    start: Option<Instant>,
}

impl<'a> Interludes<'a> {
    /// Begins a list of which nothing is carried out.
    pub fn new(all: Vec<Interlude>, folder: &'a Path, messages: &'a str) -> Self {
        Self {
            left: all.into_iter(),
            folder,
            messages,
            start: None,
        }
    }

    /// Carries out those that come before the picture after the first `pictures`.
    ///
    /// # Errors
    /// If a log cannot be written.
    pub fn play(&mut self, pictures: usize, said: &mut Said) -> Result<(), String> {
        while let Some(next) = self.left.as_slice().first() {
            if next.after > pictures {
                break;
            }
            match self.left.next().map(|next| next.act) {
                Some(Act::Pause(message)) => pause(&message),
                Some(Act::Log(name)) => {
                    said.close_log()?;
                    if let Some(name) = name {
                        let target = tools::begin(self.folder, &name)?;
                        said.open_log(name, target);
                        said.note(self.messages);
                    }
                }
                Some(Act::Stopwatch { starts: true }) => self.start = Some(Instant::now()),
                Some(Act::Stopwatch { starts: false }) => said.say(&match self.start.take() {
                    Some(start) => format!("stopwatch: {:.2} s", start.elapsed().as_secs_f64()),
                    None => String::from("stopwatch: it was not started"),
                }),
                None => {}
            }
        }
        Ok(())
    }
}

/// Waits for the Enter key, if somebody sits before the program.
fn pause(message: &str) {
    let input = std::io::stdin();
    if input.is_terminal() && std::io::stderr().is_terminal() {
        eprintln!("{message} (Enter goes on)");
        // An input that ends goes on, too.
        let _ = input.read_line(&mut String::new());
    }
}
