//! The library: commands that are written in the language itself, in `crate/rats/library/`.
//!
//! Each file defines one command of the file's name. It is read when the command is used for the
//! first time, or by `read NAME.rat`. Its first comment is its manual: `# NAME: what it makes`,
//! then a line `#   parameter  meaning` for each parameter; the defaults stand in the `define`
//! only.

use crate::asset::Asset;
use mesh::TriangleMesh;
use std::fmt::Write;
use std::sync::LazyLock;

/// The files: names and texts.
pub const FILES: &[(&str, &str)] = &[
    ("shell.rat", include_str!("../library/shell.rat")),
    ("horn.rat", include_str!("../library/horn.rat")),
    ("tree.rat", include_str!("../library/tree.rat")),
    ("spikes.rat", include_str!("../library/spikes.rat")),
    (
        "sphereflake.rat",
        include_str!("../library/sphereflake.rat"),
    ),
    ("spiral.rat", include_str!("../library/spiral.rat")),
];

/// An image and a mesh, for the examples of `terra` and `mesh`.
static ASSETS: LazyLock<[Asset; 2]> = LazyLock::new(|| {
    let text = include_str!("../library/gem.obj");
    let gem = Asset::await_mesh("gem.obj", text.as_bytes());
    gem.keep_mesh(Ok((read_plain(text), Vec::new())));
    let hills: &[u8] = include_bytes!("../library/hills.png");
    [Asset::await_mesh("hills.png", hills), gem]
});

/// Reads an OBJ file that has nothing but vertices, in the order of their use, and triangles: the
/// page needs no other reader for the library.
fn read_plain(text: &str) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for line in text.lines() {
        let mut words = line.split(' ');
        let kind = words.next();
        let numbers: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
        match (kind, &numbers[..]) {
            (Some("v"), &[x, y, z]) => mesh.positions.push([x, y, z].into()),
            (Some("f"), &[a, b, c]) => mesh.triangles.push([a, b, c].map(|n| n as u32 - 1)),
            _ => {}
        }
    }
    mesh
}

/// Returns the images and meshes of the library.
#[must_use]
pub fn assets() -> &'static [Asset] {
    &*ASSETS
}

/// A parameter of a library's command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// The name.
    pub name: &'static str,
    /// Whether it takes a material's name.
    pub is_surface: bool,
    /// The expression that stands for it if it is left out; empty if it must be given.
    pub default: &'static str,
    /// The meaning.
    pub meaning: String,
}

/// Finds the text of a file of the library.
#[must_use]
pub fn find(file: &str) -> Option<&'static str> {
    FILES
        .iter()
        .find(|(name, _)| *name == file)
        .map(|(_, text)| *text)
}

/// Finds the text that defines a command.
#[must_use]
pub fn text_of(command: &str) -> Option<&'static str> {
    FILES
        .iter()
        .find(|(name, _)| name.strip_suffix(".rat") == Some(command))
        .map(|(_, text)| *text)
}

/// Returns the parameters of a command, from its `define` and the comment at the head of its file.
#[must_use]
pub fn parameters(command: &str) -> Vec<Parameter> {
    let Some(text) = text_of(command) else {
        return Vec::new();
    };
    let head = format!("define {command}(");
    let Some(start) = text.find(&head).map(|at| at + head.len()) else {
        return Vec::new();
    };
    let signature = &text[start..];
    let signature = &signature[..signature.find('{').unwrap_or(signature.len())];
    let signature = signature.trim_end().trim_end_matches(')');
    split(signature)
        .into_iter()
        .map(|one| {
            let (name, default) = one.split_once('=').unwrap_or((one, ""));
            let name = name.trim();
            let (is_surface, name) = match name.strip_prefix("surface ") {
                Some(name) => (true, name.trim()),
                None => (false, name),
            };
            Parameter {
                name,
                is_surface,
                default: default.trim(),
                meaning: meaning(text, name),
            }
        })
        .collect()
}

/// Cuts a list at the commas that stand outside of parentheses.
fn split(list: &'static str) -> Vec<&'static str> {
    let (mut parts, mut depth, mut start) = (Vec::new(), 0_i32, 0);
    for (at, sign) in list.char_indices() {
        match sign {
            '(' | '<' => depth += 1,
            ')' | '>' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(list[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(list[start..].trim());
    parts.retain(|part| !part.is_empty());
    parts
}

/// Finds a parameter's meaning in the comment at the head of the text; empty if it is not there.
fn meaning(text: &str, name: &str) -> String {
    let mut meaning = String::new();
    let mut found = false;
    for line in text.lines().take_while(|line| line.starts_with('#')) {
        let Some(rest) = line.strip_prefix("#   ") else {
            if found {
                break;
            }
            continue;
        };
        if !rest.starts_with(' ') {
            found = rest.split_whitespace().next() == Some(name);
            if found {
                meaning = rest[name.len()..].trim().to_owned();
            }
        } else if found {
            meaning.push(' ');
            meaning += rest.trim();
        }
    }
    meaning
}

/// Returns a command with its parameters, as the manual shows it.
#[must_use]
pub fn synopsis(command: &str) -> String {
    let mut text = command.to_owned();
    for parameter in parameters(command) {
        let _ = if parameter.default.is_empty() {
            write!(text, " {}", parameter.name)
        } else {
            write!(text, " [{}={}]", parameter.name, parameter.default)
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands;

    #[test]
    fn mesh_of_the_library_is_that_of_its_file() {
        let [_, gem] = assets() else {
            unreachable!("two of them")
        };
        assert_eq!(
            gem.mesh().as_deref(),
            Ok(&mesh::read(&gem.name, &gem.bytes).unwrap())
        );
    }

    #[test]
    fn every_file_is_a_command_with_a_manual() {
        let in_table = commands::all().filter(|spec| spec.is_library());
        assert_eq!(in_table.count(), FILES.len());
        for (file, text) in FILES {
            let command = file.strip_suffix(".rat").expect("a dataset");
            assert!(commands::find(command).is_some_and(commands::CommandSpec::is_library));
            assert!(text.starts_with(&format!("# {command}: ")), "{file}");
            let parameters = parameters(command);
            assert!(!parameters.is_empty(), "{file}");
            for parameter in parameters {
                assert!(!parameter.meaning.is_empty(), "{file}: {}", parameter.name);
            }
        }
    }
}
