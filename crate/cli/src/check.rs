//! `sinew check` and `sinew scene`: the diagnostics and the scene of a dataset, without a picture.

use crate::files::{self, Loaded};
use crate::{Outcome, report};
use clap::Args;
use rats::Diagnostic;
use std::path::{Path, PathBuf};

/// `sinew check FILE… [--json]`.
#[derive(Args)]
pub struct Check {
    /// The datasets
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Print the diagnostics as a JSON array on the standard output
    #[arg(long)]
    json: bool,
}

impl Check {
    /// Prints all diagnostics of all datasets; false if any is an error.
    pub fn run(&self) -> Outcome {
        let mut all = Vec::new();
        let outcome = files::each(&self.files, |path| {
            let loaded = files::load(path)?;
            if self.json {
                all.extend(with_paths(&loaded, path));
                return Ok(report::is_clean(&loaded));
            }
            let clean = report::to_stderr(&loaded);
            summarize(&loaded, path);
            Ok(clean)
        });
        if self.json {
            let text = serde_json::to_string_pretty(&all).map_err(|error| error.to_string())?;
            println!("{text}");
        }
        outcome
    }
}

/// The diagnostics of a dataset with the paths of their files, which tell the datasets apart.
fn with_paths(loaded: &Loaded, path: &Path) -> Vec<Diagnostic> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut diagnostics = loaded.compiled.diagnostics.clone();
    for diagnostic in &mut diagnostics {
        let related = diagnostic.related.iter_mut().map(|place| &mut place.file);
        for file in related.chain([&mut diagnostic.file]) {
            *file = folder.join(&*file).display().to_string();
        }
    }
    diagnostics
}

/// Prints one line on a dataset: its name and the counts of its elements, materials, lights and
/// diagnostics.
fn summarize(loaded: &Loaded, path: &Path) {
    let scene = &loaded.compiled.scene;
    let soft = scene.elements.iter().filter(|e| scene.is_soft(e));
    eprintln!(
        "{}: {} elements ({} soft), {} materials, {} lights, {} diagnostics",
        path.display(),
        scene.elements.len(),
        soft.count(),
        scene.finishes.len(),
        scene.lights.len(),
        loaded.compiled.diagnostics.len(),
    );
}

/// `sinew scene FILE`.
#[derive(Args)]
pub struct Scene {
    /// The dataset
    file: PathBuf,
}

impl Scene {
    /// Prints the evaluated scene as JSON.
    pub fn run(&self) -> Outcome {
        let loaded = files::load(&self.file)?;
        let clean = report::to_stderr(&loaded);
        let text = serde_json::to_string_pretty(&loaded.compiled.scene)
            .map_err(|error| error.to_string())?;
        println!("{text}");
        Ok(clean)
    }
}
