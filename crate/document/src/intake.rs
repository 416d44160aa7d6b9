//! Files that the user drops on the page or opens, sorted into texts of the work, images and meshes
//! beside it, measured points, and refused files with the reason.

use crate::asset::{self, Asset, MAX_ALL, MAX_ASSET, MAX_ASSETS};
use crate::session::{MAX_FILES, MAX_TEXT};
use rats::File;
use rats::link::MAX_NAME;

/// Extensions of texts.
const TEXTS: [&str; 6] = ["rat", "art", "ice", "dat", "txt", "strokes"];
/// Extensions of measured points and outlines, beside PLY files without faces.
const MEASURED: [&str; 2] = ["xyz", "json"];
/// Most files that are read at once.
pub const MOST: usize = 32;
/// Most files that are taken from an archive.
const MOST_ARCHIVED: usize = MAX_FILES + MAX_ASSETS;
/// Largest archive that is read, bytes.
pub const MAX_ARCHIVE: usize = MAX_ALL + MAX_TEXT + (1 << 20);

/// Returns the kinds of files that are accepted, in words.
#[must_use]
pub fn kinds() -> String {
    format!(
        "texts (.{}), images ({}), meshes ({}), skeletons (.swc, .3mf, .vtp, .vtk, .csv, .obj, \
            .ply, .xyz, .pdb), points to fit to (.ply, .xyz), outlines (.json) and projects (.zip)",
        TEXTS.join(", ."),
        ::picture::Format::ENDINGS,
        mesh::Format::ENDINGS
    )
}

/// Whether a file of this name is a [work in an archive](crate::project_file).
#[must_use]
pub fn is_project(name: &str) -> bool {
    asset::extension(name) == "zip"
}

/// A file from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Incoming {
    /// The name, perhaps with folders before it.
    pub name: String,
    /// The content, or why it could not be read.
    pub bytes: Result<Vec<u8>, String>,
}

/// Files from outside, sorted by kind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sorted {
    /// Texts.
    pub texts: Vec<File>,
    /// Images and meshes.
    pub assets: Vec<Asset>,
    /// Measured points and outlines: names and contents.
    pub measured: Vec<(String, Vec<u8>)>,
    /// A sentence for each file that was refused: its name and the reason.
    pub refused: Vec<String>,
}

/// Checks the size of a file by the limit for its kind.
///
/// # Errors
/// If it is larger; the message says the limit.
pub fn check_length(name: &str, bytes: f64) -> Result<(), String> {
    let (most, what) = if is_project(name) {
        (MAX_ARCHIVE, "a project")
    } else if asset::kind(name).is_some() || MEASURED.contains(&asset::extension(name).as_str()) {
        (
            MAX_ASSET,
            "an image, a mesh, a skeleton or a cloud of points",
        )
    } else {
        (MAX_TEXT, "a text")
    };
    if bytes > most as f64 {
        let size = asset::size(bytes as usize);
        return Err(format!(
            "it has {size}, and {what} may have {}",
            asset::size(most)
        ));
    }
    Ok(())
}

/// Sorts files from outside. Their folders are dropped.
#[must_use]
pub fn sort(files: Vec<Incoming>) -> Sorted {
    let plain = files.into_iter().map(|file| {
        let last = file.name.rsplit(['/', '\\']).next();
        Incoming {
            name: plain_name(last.unwrap_or_default()),
            ..file
        }
    });
    sort_named(plain.collect(), MOST)
}

/// Sorts files of an archive. They keep their folders.
#[must_use]
pub fn sort_archive(files: Vec<Incoming>) -> Sorted {
    let plain = files.into_iter().map(|file| {
        let parts = file.name.split(['/', '\\']).map(plain_name);
        let parts = parts.filter(|part| !part.chars().all(|c| c == '.'));
        Incoming {
            name: parts.collect::<Vec<_>>().join("/"),
            ..file
        }
    });
    sort_named(plain.collect(), MOST_ARCHIVED)
}

fn sort_named(files: Vec<Incoming>, most: usize) -> Sorted {
    let mut sorted = Sorted::default();
    for (index, file) in files.into_iter().enumerate() {
        let name = file.name;
        let outcome = if index >= most {
            Err(format!("only {most} files are taken at once"))
        } else {
            check_name(&name)
                .and(file.bytes)
                .and_then(|bytes| take(&mut sorted, &name, bytes))
        };
        if let Err(reason) = outcome {
            sorted.refused.push(format!("{name}: {reason}."));
        }
    }
    // The text that is run comes first: the one that no other reads.
    let read: Vec<String> = sorted
        .texts
        .iter()
        .flat_map(|file| rats::reads(&file.text))
        .collect();
    let first = sorted.texts.iter().position(|file| {
        let is_read = read.iter().any(|wanted| {
            let folders = file.name.strip_suffix(wanted.trim_start_matches("./"));
            folders.is_some_and(|folders| folders.is_empty() || folders.ends_with('/'))
        });
        !is_read && !rats::is_strokes(&file.name)
    });
    if let Some(first) = first {
        sorted.texts[..=first].rotate_right(1);
    }
    sorted
}

/// Whether a file of a work may have this name.
///
/// # Errors
/// If it is empty or too long.
pub fn check_name(name: &str) -> Result<(), String> {
    if name.is_empty() || name.len() > MAX_NAME {
        return Err(String::from("its name is empty or too long"));
    }
    Ok(())
}

/// Makes an image or a mesh of a work.
///
/// # Errors
/// If it is too large, or not of the format that its name says.
pub fn asset(name: &str, bytes: Vec<u8>) -> Result<Asset, String> {
    check_length(name, bytes.len() as f64)?;
    let asset = Asset::await_mesh(name, bytes);
    asset::facts(&asset)?;
    Ok(asset)
}

/// Adds a file to those of its kind, or says why it is refused.
fn take(sorted: &mut Sorted, name: &str, bytes: Vec<u8>) -> Result<(), String> {
    check_length(name, bytes.len() as f64)?;
    let extension = asset::extension(name);
    let is_skeleton = asset::is_skeleton(name, &bytes);
    let is_measured =
        MEASURED.contains(&extension.as_str()) || (extension == "ply" && !has_faces(&bytes));
    if is_measured && !is_skeleton {
        sorted.measured.push((name.to_owned(), bytes));
    } else if asset::kind(name).is_some() {
        let asset = asset(name, bytes)?;
        sorted.assets.retain(|other| other.name != name);
        sorted.assets.push(asset);
    } else if TEXTS.contains(&extension.as_str()) {
        let text = text(bytes).ok_or("there is no text in it")?;
        sorted.texts.retain(|other| other.name != name);
        sorted.texts.push(File {
            name: name.to_owned(),
            text,
        });
    } else {
        return Err(format!("Sinew takes {}", kinds()));
    }
    Ok(())
}

/// Writes a text that draws skeletons among files which came without a text; `None` if there are
/// none. It lights them from afar, as their size is not known before they are read.
#[must_use]
pub fn write_text(assets: &[Asset]) -> Option<File> {
    let skeletons = assets
        .iter()
        .filter(|own| asset::is_skeleton(&own.name, &own.bytes));
    let mut text = String::from(
        "light White, distant, direction 1 -2 -2\nlight Gray40, distant, direction -2 0 -1\n\
         surface Flesh, diffuse SandyBrown, specular Gray40, shine 40, radius 0.5, \
         kernel compact6, blobbiness -8\n",
    );
    let mut count = 0;
    for skeleton in skeletons {
        count += 1;
        text += &format!("skeleton Flesh, SKELETON{count} {}\n", skeleton.name);
    }
    let name = String::from("main.rat");
    (count > 0).then_some(File { name, text })
}

/// Whether a PLY file is no cloud of points: its heading lists faces, or is damaged.
fn has_faces(bytes: &[u8]) -> bool {
    let Ok(elements) = mesh::formats::ply::elements(bytes) else {
        return true;
    };
    elements.iter().all(|element| element.name != "vertex")
        || elements
            .iter()
            .any(|element| element.count > 0 && matches!(element.name, "face" | "tristrips"))
}

/// Returns a name, or a part of one between folders, with a hyphen for each character that a name
/// in a text cannot have.
fn plain_name(name: &str) -> String {
    let letters = name.trim().chars();
    letters
        .map(|c| match c {
            '.' | '_' | '-' => c,
            c if c.is_alphanumeric() => c,
            _ => '-',
        })
        .collect()
}

/// Decodes a text in UTF-8, or in Latin-1 as old datasets are; `None` if the file is binary.
fn text(bytes: Vec<u8>) -> Option<String> {
    if bytes.contains(&0) {
        return None;
    }
    let text = match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => error.into_bytes().into_iter().map(char::from).collect(),
    };
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    Some(text.replace("\r\n", "\n").replace('\r', "\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(name: &str, bytes: &[u8]) -> Incoming {
        Incoming {
            name: name.to_owned(),
            bytes: Ok(bytes.to_vec()),
        }
    }

    #[test]
    fn the_text_that_no_other_reads_is_run() {
        let sorted = sort(vec![
            file("a/leg.rat", b"sphere a 1, 0 0 0\r\n"),
            file("body.rat", b"read leg.rat\n"),
            file("mö (bel).txt", b"# \xe4"),
        ]);
        let names: Vec<&str> = sorted.texts.iter().map(|file| file.name.as_str()).collect();
        assert_eq!(names, ["body.rat", "leg.rat", "mö--bel-.txt"]);
        assert_eq!(sorted.texts[2].text, "# ä");
        assert_eq!(sorted.texts[1].text, "sphere a 1, 0 0 0\n");
        assert_eq!(sorted.refused, Vec::<String>::new());
    }

    #[test]
    fn skeletons_get_a_text_that_draws_them() {
        let sorted = sort(vec![
            file("a b.swc", b"1 3 0 0 0 1 -1\n2 3 20 0 0 1 1\n"),
            file("m.xyz", b"2\n\nO 0 0 0\nH 1 0 0\n"),
        ]);
        assert_eq!(sorted.refused, Vec::<String>::new());
        assert!(sorted.measured.is_empty());
        let file = write_text(&sorted.assets).unwrap();
        assert_eq!(rats::asset_names(&file.text), ["a-b.swc", "m.xyz"]);
        for asset in &sorted.assets {
            let recipe = rats::Recipe::default();
            let graph = recipe.make(&asset.name, &asset.bytes);
            asset.keep_skeleton(recipe, graph.map_err(|error| error.to_string()));
        }
        let project = rats::Project { files: vec![file] };
        let compiled = rats::compile_at(&project, &sorted.assets, 0.0);
        let bad = compiled
            .diagnostics
            .iter()
            .filter(|told| told.severity == rats::Severity::Error);
        assert_eq!(bad.count(), 0, "{:?}", compiled.diagnostics);
        assert_eq!(compiled.scene.elements.len(), 3, "limbs and two atoms");
        assert_eq!(write_text(&[]), None);
    }

    #[test]
    fn points_are_measured_and_meshes_are_assets() {
        let start = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n\
            property float y\nproperty float z\n";
        let points = "end_header\n0 0 0\n1 0 0\n0 1 0\n";
        let faces = "element face 1\nproperty list uchar int vertex_indices\n";
        let cloud = format!("{start}{points}");
        let mesh = format!("{start}{faces}{points}3 0 1 2\n");
        let sorted = sort(vec![
            file("cloud.ply", cloud.as_bytes()),
            file("mesh.ply", mesh.as_bytes()),
            file("a/b.xyz", b"0 0 0\n"),
            file("o.json", b"[]"),
        ]);
        let names: Vec<&str> = sorted.measured.iter().map(|m| m.0.as_str()).collect();
        assert_eq!(names, ["cloud.ply", "b.xyz", "o.json"]);
        assert_eq!(sorted.assets.len(), 1);
        assert_eq!(sorted.refused, Vec::<String>::new());
    }

    #[test]
    fn reasons_of_refusal_are_given() {
        let unread = Incoming {
            name: String::from("b.rat"),
            bytes: Err(String::from("it could not be read")),
        };
        let long = vec![b' '; MAX_TEXT + 1];
        let sorted = sort(vec![
            file("a.gif", b"GIF"),
            file("a.rat", b"\0"),
            file("a.png", b"GIF"),
            file("long.rat", &long),
            file("/", b""),
            unread,
        ]);
        assert_eq!((sorted.texts.len(), sorted.assets.len()), (0, 0));
        assert_eq!(sorted.refused.len(), 6, "{:?}", sorted.refused);
        let many = (0..MOST + 3).map(|i| file(&format!("{i}.rat"), b"# x"));
        let sorted = sort(many.collect());
        assert_eq!((sorted.texts.len(), sorted.refused.len()), (MOST, 3));
    }
}
