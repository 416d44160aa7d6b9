//! The program `sinew`, timed on one thread with nothing written, and the scenes of the
//! comparisons, `tests/bench/*.rat`.

use crate::series::{Runs, in_turn};
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use xtask::pictures;
use xtask::shell::{command, read, root, target};

/// The scenes that are looked into closely, with kernel and kind of most of their primitives.
pub const SCENES: [(&str, &str, &str); 7] = [
    ("flake-10", "gauss", "point"),
    ("flake-820", "gauss", "point"),
    ("flake-7381", "gauss", "point"),
    ("flake-820-cauchy", "cauchy", "point"),
    ("coral", "gauss", "segment"),
    ("seahorse", "cauchy", "arc"),
    ("tee", "cauchy", "segment"),
];

/// Cost of a picture.
#[derive(Clone, Debug)]
pub struct Cost {
    /// Seconds of one processor.
    pub seconds: f64,
    /// Seconds of them until the first ray.
    pub prepare: f64,
    /// Rays from the eye.
    pub rays: f64,
    /// The number of elements of the scene.
    pub elements: f64,
    /// The most memory that the program had, bytes; `None` if the system does not tell.
    pub memory: Option<f64>,
    /// The counts of work, by name.
    pub counts: Vec<(String, f64)>,
}

/// Traces once with a program. `arguments` are the dataset and options.
pub fn time(program: &Path, arguments: &[&str]) -> Result<Cost> {
    let output = command(program, &["time"]).args(arguments).output()?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        bail!("{}", said.lines().last().unwrap_or("sinew failed"));
    }
    cost(&serde_json::from_slice(&output.stdout)?).context("sinew time gave too few figures")
}

fn cost(figures: &Value) -> Option<Cost> {
    let counts = figures["stats"].as_object()?.iter();
    let counts = counts.filter_map(|(name, count)| Some((name.replace('_', " "), count.as_f64()?)));
    Some(Cost {
        seconds: figures["seconds"]["busy"].as_f64()?,
        prepare: figures["seconds"]["prepare"].as_f64()?,
        rays: figures["stats"]["primary_rays"].as_f64()?,
        elements: figures["elements"].as_f64()?,
        memory: figures["memory"].as_f64(),
        counts: counts.collect(),
    })
}

/// The program, and copies of the scenes in a folder where variants of them may be put.
pub struct Sinew {
    folder: PathBuf,
    /// The program, built for speed.
    pub program: PathBuf,
}

impl Sinew {
    /// Builds the program and copies the scenes.
    pub fn new() -> Result<Self> {
        let folder = target().join("bench");
        fs::create_dir_all(&folder)?;
        for file in fs::read_dir(root().join("tests/bench"))? {
            let file = file?;
            if file.file_type()?.is_file() {
                fs::copy(file.path(), folder.join(file.file_name()))?;
            }
        }
        let program = pictures::sinew(None)?;
        Ok(Self { folder, program })
    }

    /// The path of a file in the folder.
    pub fn path(&self, file: &str) -> String {
        self.folder.join(file).to_string_lossy().into_owned()
    }

    /// The dataset of a scene.
    pub fn dataset(&self, name: &str) -> String {
        self.path(&format!("{name}.rat"))
    }

    /// Writes a scene with another text under another name, and returns its dataset.
    pub fn variant(
        &self,
        name: &str,
        variant: &str,
        change: impl Fn(&str) -> String,
    ) -> Result<String> {
        let text = fs::read_to_string(self.dataset(name))?;
        let dataset = self.dataset(variant);
        fs::write(&dataset, change(&text))?;
        Ok(dataset)
    }

    /// Traces once. `arguments` are the dataset and options.
    pub fn time(&self, arguments: &[&str]) -> Result<Cost> {
        time(&self.program, arguments)
    }

    /// Traces with several arguments in turn.
    pub fn compare<const N: usize>(
        &self,
        rounds: usize,
        arguments: [&[&str]; N],
    ) -> Result<[Runs; N]> {
        in_turn(rounds, |i| Ok(self.time(arguments[i])?.seconds))
    }

    /// Compiles a dataset; returns its scene as `sinew scene` prints it.
    pub fn scene(&self, name: &str) -> Result<Value> {
        let path = self.dataset(name);
        let text = read(&mut command(&self.program, &["scene", &path]));
        let text = text.with_context(|| format!("{path} has errors; see: sinew check {path}"))?;
        Ok(serde_json::from_str(&text)?)
    }
}
