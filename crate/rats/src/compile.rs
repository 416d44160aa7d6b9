//! Text to scene.

use crate::compiled::Compiled;
use crate::evaluator;
use crate::limits::{MAX_FILES, MAX_TEXT};
use crate::provenance::Provenance;
use crate::scope::Scope;
use crate::sources::Sources;
use crate::symbol::Symbols;
use crate::{Asset, Diagnostic, Project, Severity};
use scene::Origin;

/// Runs the first file of a project. Never fails, never panics, always ends: the limits are in
/// [`crate::limits`].
#[must_use]
pub fn compile(project: &Project) -> Compiled {
    compile_at(project, &[], 0)
}

/// As [`compile`], with images and meshes that the texts may use, at a frame of the animation.
/// Variables that change with every frame have changed `frame` times.
#[must_use]
pub fn compile_at(project: &Project, assets: &[Asset], frame: u32) -> Compiled {
    if let Some(diagnostic) = too_large(project) {
        return Compiled {
            diagnostics: vec![diagnostic],
            ..Compiled::default()
        };
    }
    let mut symbols = Symbols::default();
    let sources = Sources::of(project, &mut symbols);
    evaluator::run(project, &sources, assets, frame, Scope::new(symbols))
}

/// Finds from where in the texts the numbers of a shape's command come: runs the project up to the command
/// with this origin (see [`scene::Element::origin`]), at a cost of at most that of compiling. `None` if the
/// run does not come there.
#[must_use]
pub fn provenance(
    project: &Project,
    assets: &[Asset],
    frame: u32,
    origin: Origin,
) -> Option<Provenance> {
    let mut symbols = Symbols::default();
    let sources = Sources::of(project, &mut symbols);
    evaluator::trace(&sources, assets, frame, Scope::new(symbols), origin)
}

fn too_large(project: &Project) -> Option<Diagnostic> {
    let length: usize = project.files.iter().map(|file| file.text.len()).sum();
    let message = if project.files.len() > MAX_FILES {
        format!(
            "the project has {} files; {MAX_FILES} is the limit",
            project.files.len()
        )
    } else if length > MAX_TEXT {
        format!("the text has {length} bytes; {MAX_TEXT} is the limit")
    } else {
        return None;
    };
    Some(Diagnostic {
        severity: Severity::Error,
        message,
        file: project.files[0].name.clone(),
        span: 0..0,
        line: 1,
        column: 1,
        hint: Some(String::from("use loops instead of long lists of shapes")),
        related: Vec::new(),
        command: None,
    })
}
