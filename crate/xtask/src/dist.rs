//! The folder for static hosts, and the sizes of its modules.

use crate::packages::{MODULES, Module};
use crate::page::{self, Build};
use crate::shell::{command, find, read, root, tell};
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};

/// Writes dist/ and returns its path.
pub fn dist() -> Result<PathBuf> {
    let folder = root().join("dist");
    page::build(Build::Release, &folder)?;
    let path = folder.display();
    tell(&format!(
        "Wrote {path}; any static host can serve it from any path."
    ));
    weigh(&folder, &MODULES)?;
    Ok(folder)
}

/// Prints the sizes of modules in a folder, and fails if one is above its budget.
pub fn weigh(folder: &Path, modules: &[Module]) -> Result<()> {
    if find("node").is_none() {
        tell("Node.js is missing, so the sizes of the files after brotli are unknown.");
        return Ok(());
    }
    let mut heavy = Vec::new();
    for module in modules {
        let file = format!("{}_bg.wasm", module.name);
        let path = folder.join(&file);
        let bytes = std::fs::metadata(&path)?.len() / 1000;
        let small = brotli_size(&path).with_context(|| format!("{file} is not compressed"))?;
        // They are compared as they are told, in kilobytes to the nearest.
        let [kilobytes, most] = [small, module.budget].map(|bytes| (bytes + 500) / 1000);
        let sizes = format!("{file}: {bytes} kB, {kilobytes} kB with brotli (at most {most} kB)");
        tell(&sizes);
        heavy.extend(Some(sizes).filter(|_| kilobytes > most));
    }
    if !heavy.is_empty() {
        bail!("Too large: {}", heavy.join("; "));
    }
    Ok(())
}

/// Returns the number of a file's bytes after brotli, as static hosts compress it. Node.js has an
/// implementation, so that none is compiled here.
fn brotli_size(file: &Path) -> Option<usize> {
    const SCRIPT: &str = "\
        const { brotliCompressSync, constants } = require('zlib'); \
        const bytes = require('fs').readFileSync(process.argv[1]); \
        const params = { [constants.BROTLI_PARAM_QUALITY]: 11, \
            [constants.BROTLI_PARAM_LGWIN]: 22 }; \
        console.log(brotliCompressSync(bytes, { params }).length);";
    let file = file.to_string_lossy();
    read(&mut command("node", &["-e", SCRIPT, &file]))?
        .parse()
        .ok()
}
