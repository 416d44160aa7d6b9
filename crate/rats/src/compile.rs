//! Compiles a text to a scene.

use crate::compiled::Compiled;
use crate::evaluator;
use crate::limits::{MAX_FILES, MAX_TEXT};
use crate::provenance::Provenance;
use crate::scope::Scope;
use crate::sources::Sources;
use crate::symbol::Symbols;
use crate::{Asset, Diagnostic, Project, Severity};
use scene::Origin;

/// Runs the first file of a project. It never fails, never panics and always ends: the limits are
/// in [`crate::limits`].
///
/// ```
/// use rats::{HotValue, Project, compile};
///
/// let text = "var r = 0.5 hot 0 2 0.1\nsurface Clay, diffuse SandyBrown\nsphere Clay r, 0 0 0\n";
/// let compiled = compile(&Project::single(text));
/// assert!(compiled.diagnostics.is_empty());
/// assert_eq!(compiled.scene.radius(&compiled.scene.elements[0]), 0.5);
/// // A slider of the page.
/// let slider = &compiled.hot[0];
/// assert_eq!((slider.name.as_str(), &slider.value), ("r", &HotValue::Scalar(0.5)));
/// assert_eq!(slider.range, Some([0.0, 2.0]));
/// ```
#[must_use]
pub fn compile(project: &Project) -> Compiled {
    compile_at(project, &[], 0.0)
}

/// Compiles as [`compile`] does, with images and meshes that the texts may use, at a moment of the
/// animation in frames, which lies between two frames for an exposure that lasts. A variable `+=
/// step` has changed by `step·moment`, one `*= factor` by `factor^moment`. A moment that is
/// negative or not finite is taken for 0.
///
/// ```
/// let text = "var x = 0 += 2\nsurface Clay, diffuse SandyBrown\nsphere Clay 1, x 0 0\n";
/// let compiled = rats::compile_at(&rats::Project::single(text), &[], 3.0);
/// assert!(compiled.animated);
/// let ball = scene::Shape::sphere([6.0, 0.0, 0.0].into(), 1.0);
/// assert_eq!(compiled.scene.elements[0].shape, ball);
/// ```
#[must_use]
pub fn compile_at(project: &Project, assets: &[Asset], moment: f64) -> Compiled {
    if let Some(diagnostic) = refuse_large(project) {
        return Compiled {
            diagnostics: vec![diagnostic],
            ..Compiled::default()
        };
    }
    let mut symbols = Symbols::default();
    let sources = Sources::of(project, &mut symbols);
    let moment = if moment.is_finite() { moment } else { 0.0 }.max(0.0);
    evaluator::run(project, &sources, assets, moment, Scope::new(symbols))
}

/// Finds from where in the texts the numbers of a shape's command come: runs the project up to the
/// command with this origin (see [`scene::Element::origin`]), at a cost of at most that of
/// compiling. `None` if the run does not come there.
///
/// ```
/// use rats::provenance::Source;
/// use rats::{Project, compile, provenance};
///
/// let text = "var r = 0.5\nsurface Clay, diffuse SandyBrown\nsphere Clay r, 0 0 0\n";
/// let project = Project::single(text);
/// let origin = compile(&project).scene.elements[0].origin;
/// let found = provenance(&project, &[], 0.0, origin).unwrap();
/// assert_eq!((found.spec.name, found.operands[0].parameter.name), ("sphere", "r"));
/// // The radius is the literal of the variable, in the first line.
/// let Source::Literal { span, .. } = &found.operands[0].numbers[0].source else { panic!() };
/// assert_eq!(&text[span.clone()], "0.5");
/// ```
#[must_use]
pub fn provenance(
    project: &Project,
    assets: &[Asset],
    moment: f64,
    origin: Origin,
) -> Option<Provenance> {
    let mut symbols = Symbols::default();
    let sources = Sources::of(project, &mut symbols);
    evaluator::trace(&sources, assets, moment, Scope::new(symbols), origin)
}

/// Returns an error if a project has too many files or too much text.
fn refuse_large(project: &Project) -> Option<Diagnostic> {
    let length: usize = project.files.iter().map(|file| file.text.len()).sum();
    let files = project.files.len();
    let (message, hint) = if files > MAX_FILES {
        (
            format!("the project has {files} files; {MAX_FILES} is the limit"),
            "put the texts of several files into one",
        )
    } else if length > MAX_TEXT {
        (
            format!("the text has {length} bytes; {MAX_TEXT} is the limit"),
            "use loops instead of long lists of shapes",
        )
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
        hint: Some(String::from(hint)),
        fix: None,
        related: Vec::new(),
        command: None,
    })
}
