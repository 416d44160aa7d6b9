//! The scenes of the comparisons, `tests/bench/*.rat`.

use crate::examples;
use crate::shell::{command, read, root, target};
use anyhow::{Context, Result};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// The sphereflakes with Gaussian fields, by their number of balls.
pub const FLAKES: [u32; 5] = [1, 10, 91, 820, 7381];

/// Copies of the scenes in a folder where variants of them may be put, and the program that traces
/// them.
pub struct Scenes {
    folder: PathBuf,
    /// The program `sinew`, built for speed.
    pub sinew: PathBuf,
}

impl Scenes {
    /// Builds the program and copies the scenes.
    pub fn new() -> Result<Self> {
        let folder = target().join("bench");
        fs::create_dir_all(&folder)?;
        for entry in fs::read_dir(root().join("tests/bench"))? {
            let file = entry?;
            if !file.file_type()?.is_file() {
                continue;
            }
            fs::copy(file.path(), folder.join(file.file_name()))?;
        }
        Ok(Self {
            folder,
            sinew: examples::sinew()?,
        })
    }

    /// The file of a scene, or of anything else in the folder.
    pub fn path(&self, file: &str) -> PathBuf {
        self.folder.join(file)
    }

    /// The dataset of a scene, as an argument of `sinew`.
    pub fn dataset(&self, name: &str) -> String {
        let path = self.path(&format!("{name}.rat"));
        path.to_string_lossy().into_owned()
    }

    /// Writes a scene with a line in front of it, under another name, and gives its dataset.
    pub fn variant(&self, name: &str, line: &str, variant: &str) -> Result<String> {
        let text = fs::read_to_string(self.path(&format!("{name}.rat")))?;
        let path = self.path(&format!("{variant}.rat"));
        fs::write(&path, format!("{line}\n{text}"))?;
        Ok(path.to_string_lossy().into_owned())
    }

    /// The compiled scene.
    pub fn compiled(&self, name: &str) -> Result<Value> {
        let dataset = self.dataset(name);
        compiled(&self.sinew, Path::new(&dataset))
    }

    /// Returns the first message of `sinew check` about a dataset that contains a word.
    pub fn complaint(&self, dataset: &str, word: &str) -> Option<String> {
        let output = command(&self.sinew, &["check", "--json", dataset])
            .output()
            .ok()?;
        let diagnostics: Value = serde_json::from_slice(&output.stdout).ok()?;
        diagnostics
            .as_array()?
            .iter()
            .filter_map(|diagnostic| diagnostic["message"].as_str())
            .find(|message| message.contains(word))
            .map(str::to_owned)
    }
}

/// The scene that a dataset describes, as `sinew scene` prints it.
fn compiled(sinew: &Path, dataset: &Path) -> Result<Value> {
    let path = dataset.to_string_lossy();
    let text = read(&mut command(sinew, &["scene", &path]))
        .with_context(|| format!("{path} has errors; see: sinew check {path}"))?;
    Ok(serde_json::from_str(&text)?)
}
