//! Running jobs.

use crate::fitting;
use crate::message::{Job, Output};

/// Progress of a running job.
pub struct Progress<'a> {
    report: Option<&'a mut dyn FnMut(f32)>,
    pass: Option<&'a mut dyn FnMut(Output)>,
}

impl<'a> Progress<'a> {
    /// Progress that is passed on to `report`, as a fraction from 0 to 1.
    pub fn new(report: &'a mut dyn FnMut(f32)) -> Self {
        Self {
            report: Some(report),
            pass: None,
        }
    }

    /// Results before the end are passed on to `pass`, too.
    #[must_use]
    pub fn passing(self, pass: &'a mut dyn FnMut(Output)) -> Self {
        Self {
            pass: Some(pass),
            ..self
        }
    }

    /// Passes on what there is so far.
    pub fn pass(&mut self, output: Output) {
        if let Some(pass) = &mut self.pass {
            pass(output);
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
        Self {
            report: None,
            pass: None,
        }
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
        Job::ReadMeasured { name, bytes } => {
            let is_outline = bytes.trim_ascii_start().first() == Some(&b'[');
            let read = if is_outline {
                fit::outlines(&bytes).map(|outlines| fit::Observations {
                    points: Vec::new(),
                    sights: fit::sights(&outlines),
                })
            } else {
                fit::cloud(&name, &bytes).map(|points| fit::Observations {
                    points,
                    sights: Vec::new(),
                })
            };
            read.map(Output::Measured)
                .map_err(|error| error.to_string())
        }
        Job::Fit(wanted) => fitting::run(*wanted, progress).map_err(|error| error.to_string()),
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
    fn measured_files_are_read_by_their_content() {
        let read = |name: &str, text: &str| {
            let job = Job::ReadMeasured {
                name: name.into(),
                bytes: text.into(),
            };
            match run(job, &mut Progress::silent()) {
                Ok(Output::Measured(found)) => Ok([found.points.len(), found.sights.len()]),
                Ok(other) => panic!("{other:?}"),
                Err(message) => Err(message),
            }
        };
        assert_eq!(read("a.xyz", "0 0 1\n1 1 1\n"), Ok([2, 0]));
        let outline = r#"[{"eye":[0,-5,0],"target":[0,0,0],"up":[0,0,1],"fov":40,"size":[9,9],"lines":[[[2,5]]]}]"#;
        assert_eq!(read("a.json", outline), Ok([0, 1]));
        let message = read("a.xyz", "0 0\n").unwrap_err();
        assert!(message.contains("line 1"), "{message}");
    }

    #[test]
    fn broken_file_gives_the_message_of_its_reader() {
        let message = run(read("a.ply", "no"), &mut Progress::silent()).unwrap_err();
        assert_eq!(message, mesh::read("a.ply", b"no").unwrap_err().to_string());
    }
}
