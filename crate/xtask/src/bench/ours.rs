//! Our own tracer, timed: `sinew time`, one thread, nothing written.

use crate::shell::command;
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::path::Path;
use std::process::Stdio;

/// Cost of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Cost {
    /// Seconds of one processor.
    pub seconds: f64,
    /// Seconds of them until the first ray.
    pub prepare: f64,
    /// Rays from the eye.
    pub rays: f64,
    /// How many elements the scene has.
    pub elements: f64,
    /// The most memory that the program had, bytes; `None` if the system does not tell.
    pub memory: Option<f64>,
    /// All counts of work, by name.
    pub counts: Vec<(String, f64)>,
}

/// Runs it once. `arguments` are the dataset and options.
pub fn time(sinew: &Path, arguments: &[&str]) -> Result<Cost> {
    let output = command(sinew, &["time"])
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .context("sinew could not be run")?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let last = said.lines().last().unwrap_or("sinew failed").trim();
        bail!("{}", last.strip_prefix("sinew: ").unwrap_or(last));
    }
    read(&String::from_utf8_lossy(&output.stdout))
        .with_context(|| format!("sinew time {} gave no figures", arguments.join(" ")))
}

fn read(line: &str) -> Option<Cost> {
    let figures: Value = serde_json::from_str(line.trim()).ok()?;
    let counts: Vec<(String, f64)> = figures["stats"]
        .as_object()?
        .iter()
        .filter_map(|(name, count)| Some((name.replace('_', " "), count.as_f64()?)))
        .collect();
    Some(Cost {
        seconds: figures["seconds"]["busy"].as_f64()?,
        prepare: figures["seconds"]["prepare"].as_f64()?,
        rays: figures["stats"]["primary_rays"].as_f64()?,
        elements: figures["elements"].as_f64()?,
        memory: figures["memory"].as_f64(),
        counts,
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_line_of_figures_is_read() {
        let line = r#"{"elements":3,"contrast":0.25,"seconds":{"wall":2,"busy":1.5,"prepare":0.5},"memory":4096,"stats":{"primary_rays":9,"shadow_rays":0}}"#;
        let cost = super::read(line).unwrap();
        assert_eq!((cost.seconds, cost.prepare, cost.rays), (1.5, 0.5, 9.0));
        assert_eq!((cost.elements, cost.memory), (3.0, Some(4096.0)));
        assert_eq!(cost.counts.len(), 2);
        assert!(super::read("{}").is_none() && super::read("no").is_none());
    }
}
