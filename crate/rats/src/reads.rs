//! Lists the files that a text asks for, so that they can be fetched before it is compiled.

use crate::parser::parse;
use crate::symbol::Symbols;
use crate::syntax::{Block, Command, Datum, Node, Syntax};
use crate::{is_strokes, start_file};
use std::ops::Range;
use std::path::Path;

/// Returns the file names after every `read` of a text, in order, wherever it stands, then the
/// texts of strokes after `mesh`. Nothing is run, so a `read` that a condition would skip is listed
/// too.
#[must_use]
pub fn reads(text: &str) -> Vec<String> {
    let mut symbols = Symbols::default();
    let syntax = parse(text, &mut symbols);
    let mut names = Vec::new();
    collect(&syntax.block, &["read"], &syntax, text, &mut names);
    let mut meshes = Vec::new();
    collect(&syntax.block, &["mesh"], &syntax, text, &mut meshes);
    names.extend(meshes.into_iter().filter(|name| is_strokes(name)));
    names
}

/// Returns the names that a file may have in the project which the text `reader` calls `wanted`:
/// beside the reader first, unless that leads out of the project's folder, then as it is.
#[must_use]
pub fn places(reader: &str, wanted: &str) -> Vec<String> {
    let bare = wanted.strip_prefix("./").unwrap_or(wanted);
    let mut places = Vec::new();
    if let Some((folder, _)) = reader.rsplit_once('/') {
        places.extend(join(folder, bare));
    }
    places.push(bare.to_owned());
    places
}

/// Joins a folder and a name, without `.` and `..`; `None` if the name leads out of the project's
/// folder.
fn join(folder: &str, name: &str) -> Option<String> {
    let mut parts: Vec<&str> = folder.split('/').collect();
    for part in name.split('/') {
        match part {
            "." => {}
            ".." => {
                parts.pop()?;
            }
            part => parts.push(part),
        }
    }
    Some(parts.join("/"))
}

/// Endings of files of limbs, beside those of meshes that may hold limbs, too.
pub const SKELETONS: [&str; 7] = ["swc", "vtp", "vtk", "csv", "xyz", "pdb", "ent"];

/// Returns whether a name has the ending of an image.
#[must_use]
pub fn is_image(name: &str) -> bool {
    picture::Format::of(Path::new(name)).is_ok()
}

/// Returns whether a name has the ending of a mesh.
#[must_use]
pub fn is_mesh(name: &str) -> bool {
    mesh::Format::of_name(name).is_some()
}

/// Returns whether a name has the ending of a file that holds nothing but limbs, or limbs or
/// points.
#[must_use]
pub fn is_skeleton(name: &str) -> bool {
    let (_, ending) = name.rsplit_once('.').unwrap_or_default();
    SKELETONS.iter().any(|own| ending.eq_ignore_ascii_case(own))
}

/// Returns the images, meshes and skeletons that a text asks for (`mesh`, `terra`, `texture`,
/// `background`, `skeleton`), in order, wherever they stand. A text of strokes asks for the
/// mesh that it starts from.
#[must_use]
pub fn asset_names(text: &str) -> Vec<String> {
    let mut lines = text.lines().map(str::trim_start);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with('#'));
    if first.is_some_and(|line| line.split_whitespace().next() == Some("strokes")) {
        return start_file(text).into_iter().collect();
    }
    let mut symbols = Symbols::default();
    let syntax = parse(text, &mut symbols);
    let mut names = Vec::new();
    let commands = ["mesh", "terra", "texture", "background", "skeleton"];
    collect(&syntax.block, &commands, &syntax, text, &mut names);
    names.retain(|name| is_image(name) || is_mesh(name) || is_skeleton(name));
    names
}

/// Adds the file names after some commands of a block.
fn collect(block: &Block, commands: &[&str], syntax: &Syntax, text: &str, names: &mut Vec<String>) {
    for node in block {
        match node {
            Node::Command(command) => add_names(command, commands, syntax, text, names),
            Node::For(each) => collect(&each.body, commands, syntax, text, names),
            Node::If(choice) => {
                collect(&choice.then, commands, syntax, text, names);
                collect(&choice.otherwise, commands, syntax, text, names);
            }
            Node::Define(define) => collect(&define.body, commands, syntax, text, names),
        }
    }
}

/// Adds the file names behind a command, if it is one of the given ones.
fn add_names(
    command: &Command,
    commands: &[&str],
    syntax: &Syntax,
    text: &str,
    names: &mut Vec<String>,
) {
    if command
        .spec
        .is_none_or(|spec| !commands.contains(&spec.name))
    {
        return;
    }
    // As `Reader::file_name`: a name goes on as long as nothing separates its parts.
    let mut open: Option<Range<usize>> = None;
    for item in &syntax.items[command.items.clone()] {
        let separator = matches!(item.datum, Datum::Sign(b',' | b'<' | b'>'));
        match &mut open {
            Some(range) if !item.spaced && !separator => {
                *range = Range {
                    start: range.start,
                    end: item.span().end,
                }
            }
            _ => {
                names.extend(open.take().map(|range| text[range].to_owned()));
                open = (!separator).then(|| item.span());
            }
        }
    }
    names.extend(open.map(|range| text[range].to_owned()));
}

#[cfg(test)]
mod tests {
    use super::{asset_names, places, reads};

    #[test]
    fn texts_of_strokes_are_read() {
        let text = "mesh Clay dog.strokes\nread a.rat\nmesh Clay gem.obj\n";
        assert_eq!(reads(text), ["a.rat", "dog.strokes"]);
    }

    #[test]
    fn names_are_found_wherever_read_stands() {
        let text = "read a.rat, sub/b-2.rat # not c.rat\nif 1 {\n  @READ d.rat\n}\n\
            for i = 1 to 2 {\n read e.rat\n}\nreadx f.rat\n";
        assert_eq!(reads(text), ["a.rat", "sub/b-2.rat", "d.rat", "e.rat"]);
    }

    #[test]
    fn files_are_looked_for_beside_their_reader_first() {
        assert_eq!(places("main.rat", "./b.rat"), ["b.rat"]);
        assert_eq!(places("sub/a.rat", "b.rat"), ["sub/b.rat", "b.rat"]);
        assert_eq!(places("x/y/a.rat", "../b.rat"), ["x/b.rat", "../b.rat"]);
        assert_eq!(places("x/a.rat", "../../b.rat"), ["../../b.rat"]);
        assert_eq!(places("x/a.rat", "../b.rat"), ["b.rat", "../b.rat"]);
    }

    #[test]
    fn images_and_meshes_are_found() {
        let text = "mesh Clay, parts/bunny.ply\nif 1 { terra Clay hills.png 0 0 0 1 1 1 }\n\
            mesh robust\ntexture Mona { diffuse mona.tif plain, scale 2 2 1 }\n\
            background Red\nbackground sky.png\nskeleton Clay, N n-1.swc scale 2\n\
            skeleton Clay, M { node A <0 0.5 .3> node B <1 0 0> curve A B }\n";
        assert_eq!(
            asset_names(text),
            [
                "parts/bunny.ply",
                "hills.png",
                "mona.tif",
                "sky.png",
                "n-1.swc"
            ]
        );
    }
}
