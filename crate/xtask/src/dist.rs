//! The folder for static hosts, and how large its first load is.

use crate::page::{self, Build};
use crate::shell::root;
use anyhow::{Result, bail};
use std::path::{Path, PathBuf};

/// Largest wasm of the app and of one worker, bytes after brotli.
const BUDGETS: [(&str, usize); 2] = [("studio_bg.wasm", 2_200_000), ("tracer_bg.wasm", 400_000)];

/// Writes dist/ and gives its path.
pub fn dist() -> Result<PathBuf> {
    let folder = root().join("dist");
    page::build(Build::Release, &folder)?;
    println!(
        "\nWrote {}; any static host can serve it from any path.",
        folder.display()
    );
    weigh(&folder)?;
    Ok(folder)
}

/// Prints the sizes and fails if one is above its budget.
fn weigh(folder: &Path) -> Result<()> {
    let mut heavy = Vec::new();
    for (file, budget) in BUDGETS {
        let bytes = std::fs::read(folder.join(file))?;
        let small = compress(&bytes, 11)?.len();
        let sizes = format!(
            "{file}: {} kB, {} kB with brotli (at most {} kB)",
            bytes.len() / 1000,
            small / 1000,
            budget / 1000
        );
        println!("{sizes}");
        if small > budget {
            heavy.push(sizes);
        }
    }
    if !heavy.is_empty() {
        bail!("The first load is too large: {}", heavy.join("; "));
    }
    Ok(())
}

/// Brotli, quality 0 … 11.
pub fn compress(bytes: &[u8], quality: i32) -> Result<Vec<u8>> {
    let mut small = Vec::new();
    let parameters = brotli::enc::BrotliEncoderParams {
        quality,
        lgwin: 22,
        ..Default::default()
    };
    brotli::BrotliCompress(&mut &bytes[..], &mut small, &parameters)?;
    Ok(small)
}
