//! Running jobs.

use crate::message::{Job, Output};

/// Progress of a running job.
pub struct Progress<'a> {
    report: Option<&'a mut dyn FnMut(f32)>,
}

impl<'a> Progress<'a> {
    /// Progress that is passed on to `report`, as a fraction from 0 to 1.
    pub fn new(report: &'a mut dyn FnMut(f32)) -> Self {
        Self {
            report: Some(report),
        }
    }

    /// Reports the fraction done, 0 … 1. A job that takes more than a few seconds must call this
    /// every few seconds, or its worker is taken for one that hangs.
    pub fn report(&mut self, fraction: f32) {
        if let Some(report) = &mut self.report {
            report(fraction.clamp(0.0, 1.0));
        }
    }

    /// Progress that is not passed on.
    #[must_use]
    pub fn silent() -> Self {
        Self { report: None }
    }
}

/// Runs a job to its end.
///
/// # Errors
/// An error message for the user, such as what is wrong with a file.
pub fn run(job: Job, progress: &mut Progress<'_>) -> Result<Output, String> {
    progress.report(0.0);
    match job {
        Job::ReadMesh { name, bytes } => {
            let mesh = mesh::read(&name, &bytes).map_err(|error| error.to_string())?;
            progress.report(0.9);
            Ok(Output::Mesh(mesh))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

    fn read(name: &str, text: &str) -> Job {
        Job::ReadMesh {
            name: name.into(),
            bytes: text.into(),
        }
    }

    #[test]
    fn mesh_equals_that_of_a_direct_read() {
        let mut fractions = Vec::new();
        let mut report = |fraction| fractions.push(fraction);
        let output = run(read("a.obj", SQUARE), &mut Progress::new(&mut report));
        let Ok(Output::Mesh(data)) = output else {
            panic!("{output:?}");
        };
        let direct = mesh::read("a.obj", SQUARE.as_bytes()).unwrap();
        assert_eq!(data, direct);
        assert!(fractions.is_sorted() && fractions[0] == 0.0);
    }

    #[test]
    fn broken_file_gives_the_message_of_its_reader() {
        let message = run(read("a.ply", "no"), &mut Progress::silent()).unwrap_err();
        assert_eq!(message, mesh::read("a.ply", b"no").unwrap_err().to_string());
    }
}
