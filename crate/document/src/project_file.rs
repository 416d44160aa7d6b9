//! A whole work as one file: a zip archive of its texts, images and meshes, which other programs
//! unpack as well.
//!
//! The archive also has a description, `sinew.json`, with the work's name, its camera and the names
//! of its texts, the one that is run first. The files of an archive without a description are taken
//! in as if they were dropped on the page one by one.

use crate::asset::{Asset, MAX_ALL, MAX_ASSET};
use crate::intake::{self, Incoming, MAX_ARCHIVE, Sorted};
use crate::session::MAX_TEXT;
use ::archive::{Archive, Entry, Error, Member};
use rats::File;
use scene::Camera;
use serde::{Deserialize, Serialize};

/// Most members of an archive, including those that are ignored.
pub const MAX_MEMBERS: usize = 1000;
/// Name of the description.
const DESCRIPTION: &str = "sinew.json";
/// Largest description, bytes.
const MAX_DESCRIPTION: usize = 64 * 1024;

/// A work.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Project {
    /// The name; empty if the file does not have it.
    pub name: String,
    /// The texts; the first one is run.
    pub texts: Vec<File>,
    /// The images and meshes.
    pub assets: Vec<Asset>,
    /// The camera chosen by the user.
    pub camera: Option<Camera>,
}

#[derive(Serialize, Deserialize)]
struct Description {
    name: String,
    /// Names of the members that are texts.
    texts: Vec<String>,
    #[serde(default)]
    camera: Option<Camera>,
}

/// Writes the archive of a work.
///
/// # Errors
/// A sentence, if it cannot be written.
pub fn pack(project: &Project) -> Result<Vec<u8>, String> {
    let description = Description {
        name: project.name.clone(),
        texts: project.texts.iter().map(|file| file.name.clone()).collect(),
        camera: project.camera,
    };
    let description = serde_json::to_vec_pretty(&description).map_err(|e| e.to_string())?;
    let texts = project
        .texts
        .iter()
        .map(|file| (&file.name, file.text.as_bytes()));
    let assets = project
        .assets
        .iter()
        .map(|asset| (&asset.name, &*asset.bytes));
    let mut members: Vec<Member<'_>> = texts
        .chain(assets)
        .map(|(name, bytes)| Member {
            packed: is_compressed(name),
            ..Member::new(name, bytes)
        })
        .collect();
    members.push(Member::new(DESCRIPTION, &description));
    ::archive::write(&members).map_err(|error| format!("The project {error}."))
}

/// Whether a file of this name is compressed already, so that packing makes it no smaller.
fn is_compressed(name: &str) -> bool {
    matches!(crate::asset::extension(name).as_str(), "png" | "gif")
}

/// Reads the work in an archive. Returns it with a sentence for each file that was refused.
///
/// # Errors
/// If the archive cannot be read or has nothing for a work: the end of a sentence that begins with
/// "it".
pub fn unpack(bytes: &[u8]) -> Result<(Project, Vec<String>), String> {
    if bytes.len() > MAX_ARCHIVE {
        let most = crate::asset::size(MAX_ARCHIVE);
        return Err(format!("is larger than {most}"));
    }
    let archive = Archive::open(bytes, MAX_MEMBERS).map_err(|error: Error| error.to_string())?;
    let description = archive
        .entries()
        .iter()
        .find(|entry| entry.name == DESCRIPTION)
        .map(|entry| archive.read(entry, MAX_DESCRIPTION))
        .transpose()
        .map_err(|error| error.to_string())?
        .and_then(|bytes| serde_json::from_slice::<Description>(&bytes).ok());
    let (project, refused) = match description {
        Some(description) => native(&archive, description)?,
        None => foreign(&archive),
    };
    if project.texts.is_empty() && project.assets.is_empty() {
        return Err(match refused.first() {
            Some(reason) => format!("has nothing for a work: {reason}"),
            None => String::from("has no texts, images or meshes"),
        });
    }
    Ok((project, refused))
}

/// Reads a work that [`pack`] has written.
fn native(
    archive: &Archive<'_>,
    description: Description,
) -> Result<(Project, Vec<String>), String> {
    let mut project = Project {
        name: description.name.chars().take(60).collect(),
        camera: description.camera,
        ..Project::default()
    };
    let mut refused = Vec::new();
    let mut texts = description.texts.iter().peekable();
    let mut all = 0;
    for entry in archive.entries() {
        if entry.name == DESCRIPTION || entry.is_folder() {
            continue;
        }
        // Texts stand first, in the order of the description.
        let is_text = texts.next_if(|name| **name == entry.name).is_some();
        let read = content(archive, entry, is_text, &mut all);
        let outcome = read.and_then(|bytes| {
            intake::check_name(&entry.name)?;
            if is_text {
                let text = String::from_utf8(bytes).map_err(|_| "there is no text in it")?;
                let name = entry.name.clone();
                project.texts.push(File { name, text });
            } else {
                project.assets.push(intake::asset(&entry.name, bytes)?);
            }
            Ok(())
        });
        if let Err(reason) = outcome {
            refused.push(format!("{}: {reason}.", entry.name));
        }
    }
    if let Some(name) = texts.next() {
        return Err(format!("lacks its text {name}"));
    }
    Ok((project, refused))
}

/// Reads an archive that another program has written.
fn foreign(archive: &Archive<'_>) -> (Project, Vec<String>) {
    let names: Vec<&str> = archive
        .entries()
        .iter()
        .filter(|entry| is_meant(entry))
        .map(|entry| entry.name.as_str())
        .collect();
    let common = common_folder(&names);
    let mut all = 0;
    let mut files = Vec::new();
    for entry in archive.entries().iter().filter(|entry| is_meant(entry)) {
        let is_text = crate::asset::kind(&entry.name).is_none();
        files.push(Incoming {
            name: entry.name[common..].to_owned(),
            bytes: content(archive, entry, is_text, &mut all),
        });
    }
    let Sorted {
        texts,
        assets,
        refused,
        ..
    } = intake::sort_archive(files);
    let project = Project {
        texts,
        assets,
        ..Project::default()
    };
    (project, refused)
}

/// Whether a member is a file that a person put there, and not a hidden one.
fn is_meant(entry: &Entry) -> bool {
    let mut parts = entry.name.split('/');
    !entry.is_folder()
        && !parts.any(|part| part == "__MACOSX" || part.starts_with('.') && part != "..")
}

/// Returns the length in bytes of the path that all files have in common.
fn common_folder(names: &[&str]) -> usize {
    let Some(first) = names.first() else {
        return 0;
    };
    first
        .match_indices('/')
        .map(|(at, _)| at + 1)
        .take_while(|end| names.iter().all(|name| name.starts_with(&first[..*end])))
        .last()
        .unwrap_or(0)
}

/// Reads a member within the limits of its kind and of all together. Adds its bytes to `all`.
fn content(
    archive: &Archive<'_>,
    entry: &Entry,
    is_text: bool,
    all: &mut usize,
) -> Result<Vec<u8>, String> {
    let most = if is_text { MAX_TEXT } else { MAX_ASSET };
    let left = (MAX_ALL + MAX_TEXT).saturating_sub(*all);
    let bytes = archive
        .read(entry, most.min(left))
        .map_err(|error| format!("it {error}"))?;
    *all += bytes.len();
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(name: &str, text: &str) -> File {
        File {
            name: name.to_owned(),
            text: text.to_owned(),
        }
    }

    const OBJ: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

    fn mesh(name: &str) -> Asset {
        Asset::await_mesh(name, OBJ)
    }

    fn zip(members: &[(&str, &[u8])]) -> Vec<u8> {
        let members = members.iter().map(|(name, bytes)| Member::new(name, bytes));
        ::archive::write(&members.collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn a_work_comes_back() {
        let image = pool::Image {
            size: [1, 2],
            rgba: vec![9; 8],
        };
        let project = Project {
            name: String::from("Drôle d’os"),
            // The first text is run though the second reads it; names may have folders.
            texts: vec![file("a b.rat", "# ä\n"), file("x/y.rat", "read a b.rat\n")],
            assets: vec![
                mesh("x/bone.obj"),
                Asset::await_mesh("a.png", crate::picture::png(&image).unwrap()),
            ],
            camera: Some(Camera {
                fov: 33.0,
                ..Camera::default()
            }),
        };
        let bytes = pack(&project).unwrap();
        assert_eq!(unpack(&bytes), Ok((project.clone(), Vec::new())));
        // A text may have a name like that of an image.
        let odd = Project {
            texts: vec![file("a.png", ""), file("sinew.txt", "x")],
            assets: Vec::new(),
            ..project
        };
        assert_eq!(unpack(&pack(&odd).unwrap()), Ok((odd, Vec::new())));
    }

    #[test]
    fn archives_of_others_are_files_that_were_dropped() {
        let bytes = zip(&[
            ("snail/", b""),
            ("snail/shell/spiral.rat", b"# spiral\r\n"),
            (
                "snail/main.rat",
                b"read shell/spiral.rat\nmesh a bone.obj\n",
            ),
            ("snail/bone.obj", OBJ),
            ("snail/.DS_Store", b"x"),
            ("__MACOSX/snail/main.rat", b"x"),
            ("snail/notes.pdf", b"x"),
        ]);
        let (project, refused) = unpack(&bytes).unwrap();
        let names: Vec<_> = project.texts.iter().map(|file| &file.name).collect();
        assert_eq!(names, ["main.rat", "shell/spiral.rat"]);
        assert_eq!(project.texts[1].text, "# spiral\n");
        assert_eq!(project.assets, [mesh("bone.obj")]);
        assert_eq!(refused.len(), 1, "{refused:?}");
        assert!(refused[0].starts_with("notes.pdf: "), "{refused:?}");
        assert_eq!((project.name.as_str(), project.camera), ("", None));
        let (image, _) = unpack(&zip(&[("../bone.obj", OBJ)])).unwrap();
        assert_eq!(image.assets, [mesh("bone.obj")]);
    }

    #[test]
    fn bombs_and_broken_archives_are_refused() {
        assert!(reason(b"PK").contains("no zip archive"));
        assert!(reason(&vec![0; MAX_ARCHIVE + 1]).contains("larger than"));
        assert!(reason(&zip(&[("a.txt/", b"")])).contains("no texts"));
        let zeros = vec![b' '; MAX_TEXT + 1];
        assert!(reason(&zip(&[("a.rat", &zeros)])).contains("bytes when it is unpacked"));
        let many: Vec<(&str, &[u8])> = vec![("a.rat", b""); MAX_MEMBERS + 1];
        assert!(reason(&zip(&many)).contains("members"));
        // Many files that are small by themselves.
        let image = vec![0; MAX_ASSET];
        let names: Vec<String> = (0..5).map(|i| format!("{i}.stl")).collect();
        let members: Vec<(&str, &[u8])> = names
            .iter()
            .map(|name| (name.as_str(), &image[..]))
            .collect();
        assert!(reason(&zip(&members)).starts_with("has nothing for a work"));
        let description = br#"{"name": "a", "texts": ["main.rat"]}"#;
        let lacking = zip(&[("sinew.json", description)]);
        assert_eq!(reason(&lacking), "lacks its text main.rat");
    }

    fn reason(bytes: &[u8]) -> String {
        unpack(bytes).unwrap_err()
    }
}
