//! `sinew check` and `sinew scene`: what a dataset says, without a picture.

use crate::{Outcome, files, report};
use clap::Args;
use std::path::PathBuf;

/// `sinew check FILE [--json]`.
#[derive(Args)]
pub struct Check {
    /// The dataset
    file: PathBuf,
    /// Print the diagnostics as a JSON array on the standard output
    #[arg(long)]
    json: bool,
}

impl Check {
    /// Prints all diagnostics; false if any is an error.
    pub fn run(&self) -> Outcome {
        let loaded = files::load(&self.file)?;
        if self.json {
            let text = serde_json::to_string_pretty(&loaded.compiled.diagnostics)
                .map_err(|error| error.to_string())?;
            println!("{text}");
            return Ok(report::is_clean(&loaded));
        }
        let clean = report::to_stderr(&loaded);
        let soft = loaded
            .compiled
            .scene
            .elements
            .iter()
            .filter(|element| loaded.compiled.scene.is_soft(element))
            .count();
        eprintln!(
            "{}: {} elements ({soft} soft), {} materials, {} lights, {} diagnostics",
            self.file.display(),
            loaded.compiled.scene.elements.len(),
            loaded.compiled.scene.finishes.len(),
            loaded.compiled.scene.lights.len(),
            loaded.compiled.diagnostics.len(),
        );
        Ok(clean)
    }
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
