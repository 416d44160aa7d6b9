//! Makes a project of files on disk.
//!
//! A dataset may `read` others. The compiler only ever sees the texts of a project, so the ones it
//! asks for are fetched here, from the folder of the first file, until it asks for no more.

use crate::{Outcome, view};
use rats::{Asset, Compiled, File, Project};
use std::io::Read;
use std::path::{Path, PathBuf};

/// Largest text accepted from disk, bytes.
const MAX_TEXT: u64 = 4 * 1024 * 1024;
/// Largest image, mesh or skeleton accepted from disk, bytes.
pub const MAX_ASSET: u64 = limbs::limits::MAX_BYTES as u64;
/// Most files fetched for one project.
const MAX_FILES: usize = 256;

/// A dataset read from disk and compiled.
pub struct Loaded {
    /// The texts.
    pub project: Project,
    /// The images and meshes that they use.
    pub assets: Vec<Asset>,
    /// Scene, diagnostics and jobs that they compile to.
    pub compiled: Compiled,
    /// Time the compiler took for the last, complete run.
    pub compile_seconds: f64,
}

/// Runs an action on each of several files, also where it fails on one of them. Returns the worst
/// outcome: all sentences of failure, each in a line, else false if there was one.
pub fn each(files: &[PathBuf], mut run: impl FnMut(&Path) -> Outcome) -> Outcome {
    let mut clean = true;
    let mut failures: Vec<String> = Vec::new();
    for file in files {
        match run(file) {
            Ok(is_clean) => clean &= is_clean,
            Err(sentence) => failures.push(sentence),
        }
    }
    if failures.is_empty() {
        Ok(clean)
    } else {
        Err(failures.join("\nsinew: "))
    }
}

/// Path that stands for the standard input.
pub const INPUT: &str = "-";

/// Loads a dataset and all that it reads. Of the path `-` the text comes from the standard input,
/// and what it reads from the present folder. A file with a skeleton is loaded as by a dataset that
/// frames and lights it.
///
/// # Errors
/// If the first file cannot be read, or is a mesh or a skeleton that cannot be understood. A
/// missing file further down is a diagnostic of the compiler.
pub fn load(path: &Path) -> Result<Loaded, String> {
    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
    let is_input = path == Path::new(INPUT);
    let name = match path.file_name() {
        _ if is_input => String::from("input.rat"),
        Some(name) => name.to_string_lossy().into_owned(),
        None => path.display().to_string(),
    };
    if rats::is_skeleton(&name) || rats::is_mesh(&name) {
        let (project, asset) = view::make_project(path, read_bounded(path, MAX_ASSET)?)?;
        return Ok(compile(project, vec![asset]));
    }
    let mut project = Project {
        files: vec![File {
            name,
            text: if is_input { input()? } else { read(path)? },
        }],
    };
    // Every text is looked at once for the names it reads.
    let mut next = 0;
    while next < project.files.len() && project.files.len() < MAX_FILES {
        let reader = &project.files[next];
        let wanted = rats::reads(&reader.text).into_iter();
        let places: Vec<_> = wanted
            .map(|name| rats::places(&reader.name, &name))
            .collect();
        for places in places {
            // The first place where there is one, as the language looks for it.
            for place in places {
                if project.files.iter().any(|file| file.name == place) {
                    break;
                }
                if let Some(text) = inside(&folder, &place).and_then(|path| read(&path).ok()) {
                    project.files.push(File { name: place, text });
                    break;
                }
            }
        }
        next += 1;
    }
    let mut assets: Vec<Asset> = Vec::new();
    for places in project.files.iter().flat_map(|file| {
        let names = rats::asset_names(&file.text).into_iter();
        names.map(move |name| rats::places(&file.name, &name))
    }) {
        for name in places {
            if assets.iter().any(|asset| asset.name == name) {
                break;
            }
            if let Some(bytes) = inside(&folder, &name).and_then(|path| bytes(&path)) {
                assets.push(Asset::new(name, bytes));
                break;
            }
        }
    }
    Ok(compile(project, assets))
}

/// Compiles a project, and tells the time that it took.
fn compile(project: Project, assets: Vec<Asset>) -> Loaded {
    let start = std::time::Instant::now();
    let compiled = rats::compile_at(&project, &assets, 0.0);
    Loaded {
        project,
        assets,
        compiled,
        compile_seconds: start.elapsed().as_secs_f64(),
    }
}

/// An image or mesh; none if it cannot be read or is too large, which the compiler then says.
fn bytes(path: &Path) -> Option<Vec<u8>> {
    let size = std::fs::metadata(path).ok()?.len();
    if size > MAX_ASSET {
        return None;
    }
    std::fs::read(path).ok()
}

/// The path of a file named in a dataset; names that lead out of the dataset's folder are refused,
/// because a dataset may come from a stranger.
pub fn inside(folder: &Path, name: &str) -> Option<PathBuf> {
    darkroom::name::stays_inside(name).then(|| folder.join(name))
}

/// The bytes of a file that is no larger than a limit.
///
/// # Errors
/// If it cannot be read or is too large.
pub fn read_bounded(path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let size = std::fs::metadata(path)
        .map_err(|error| format!("cannot open {}: {error}", path.display()))?
        .len();
    if size > most {
        return Err(format!(
            "{} has {size} bytes; the limit is {most}",
            path.display()
        ));
    }
    std::fs::read(path).map_err(|error| format!("cannot read {}: {error}", path.display()))
}

/// The text of the standard input, up to its end.
///
/// # Errors
/// If it cannot be read, is too large or no UTF-8.
fn input() -> Result<String, String> {
    let mut bytes = Vec::new();
    std::io::stdin()
        .lock()
        .take(MAX_TEXT + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| format!("cannot read the standard input: {error}"))?;
    if bytes.len() as u64 > MAX_TEXT {
        return Err(format!(
            "the standard input has more than {MAX_TEXT} bytes, the limit for one text"
        ));
    }
    text_of(bytes, "the standard input")
}

/// A text from disk.
///
/// # Errors
/// If it cannot be read, is too large or no UTF-8.
pub fn read(path: &Path) -> Result<String, String> {
    let size = std::fs::metadata(path)
        .map_err(|error| format!("cannot open {}: {error}", path.display()))?
        .len();
    if size > MAX_TEXT {
        return Err(format!(
            "{} has {size} bytes; the limit for one text is {MAX_TEXT}",
            path.display()
        ));
    }
    let bytes =
        std::fs::read(path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    text_of(bytes, &path.display().to_string())
}

/// The text of the bytes of a file.
///
/// # Errors
/// If they are no UTF-8.
fn text_of(bytes: Vec<u8>, name: &str) -> Result<String, String> {
    String::from_utf8(bytes).map_err(|error| {
        let sound = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + sound.iter().filter(|byte| **byte == b'\n').count();
        format!("{name}:{line}: this line is not UTF-8 text; save the file as UTF-8")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_leave_the_folder_are_refused() {
        let folder = Path::new("models");
        assert!(inside(folder, "parts/leg.rat").is_some());
        assert!(inside(folder, "../secret.rat").is_none());
        assert!(inside(folder, "/etc/passwd").is_none());
    }

    #[test]
    fn files_are_fetched_as_far_as_they_read_each_other() {
        let folder = std::env::temp_dir().join(format!("sinew-files-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("temporary folder");
        std::fs::write(folder.join("main.rat"), "read leg.rat\n").expect("written");
        std::fs::write(folder.join("leg.rat"), "read toe.rat main.rat\n").expect("written");
        std::fs::write(
            folder.join("toe.rat"),
            "surface s diffuse White\nsphere s 1 0 0 0\n",
        )
        .expect("written");
        let loaded = load(&folder.join("main.rat")).expect("loads");
        assert_eq!(loaded.project.files.len(), 3);
        assert_eq!(loaded.compiled.scene.elements.len(), 1);
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
