//! The list of a release's files, which its service worker keeps in the browser.

use anyhow::{Context, Result};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The service worker, and the line of it that the list takes the place of.
const WORKER: &str = "offline.js";
const EMPTY: &str = "const FILES = {};\n";

/// Writes the paths and checksums of all files of a folder into its service worker.
///
/// # Errors
/// If a file cannot be read, or the worker has no place for the list.
pub fn list(folder: &Path) -> Result<()> {
    let mut files = BTreeMap::new();
    gather(folder, "", &mut files)?;
    files.remove(WORKER);
    let worker = folder.join(WORKER);
    let text = fs::read_to_string(&worker).with_context(|| format!("{WORKER} is missing"))?;
    let (before, after) = text
        .split_once(EMPTY)
        .with_context(|| format!("{WORKER} has no line `{}`", EMPTY.trim_end()))?;
    let files = serde_json::to_string_pretty(&files)?;
    fs::write(&worker, format!("{before}const FILES = {files};\n{after}"))?;
    Ok(())
}

/// Adds the files of a folder, with `path` before their names, and their checksums.
fn gather(folder: &Path, path: &str, files: &mut BTreeMap<String, String>) -> Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{path}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            gather(&entry.path(), &format!("{name}/"), files)?;
        } else {
            let sum = crc32fast::hash(&fs::read(entry.path())?);
            files.insert(name, format!("{sum:08x}"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_names_all_files_but_the_worker() -> Result<()> {
        let folder = std::env::temp_dir().join(format!("sinew-offline-{}", std::process::id()));
        fs::create_dir_all(folder.join("in"))?;
        fs::write(folder.join("a.txt"), "123456789")?;
        fs::write(folder.join("in/b.txt"), "")?;
        fs::write(folder.join(WORKER), format!("// before\n{EMPTY}// after\n"))?;
        list(&folder)?;
        let text = fs::read_to_string(folder.join(WORKER))?;
        let again = list(&folder);
        fs::remove_dir_all(&folder)?;
        // The published check value of CRC-32.
        let files = "{\n  \"a.txt\": \"cbf43926\",\n  \"in/b.txt\": \"00000000\"\n}";
        assert_eq!(
            text,
            format!("// before\nconst FILES = {files};\n// after\n")
        );
        assert!(again.is_err(), "a list is not written twice");
        Ok(())
    }
}
