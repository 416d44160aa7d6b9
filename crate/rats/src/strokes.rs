//! Meshes made by strokes: texts of a project with the ending `.strokes`, which `mesh` uses like
//! files of meshes.
//!
//! The meshes are kept while compilations ask for them, and a text that has only grown goes on from
//! where the last one ended, as a text is compiled after every stroke.

use crate::asset::Asset;
use crate::limits;
use crate::limits::{MAX_STROKES_FACES, MAX_STROKES_WORK};
use mesh::{Topology, TriangleMesh};
use sculpt::{Beginning, Clay, Diagnostic, Script};
use std::cell::{OnceCell, RefCell};
use std::rc::Rc;
use std::sync::{Arc, Weak};

/// Number of meshes that are kept.
const KEPT: usize = 12;
/// Number of sculptures that are kept to go on with.
const KEPT_CLAYS: usize = 3;

/// A mesh made by strokes.
#[derive(Debug)]
pub struct Sculpted {
    /// The triangles.
    pub mesh: Rc<TriangleMesh>,
    topology: OnceCell<Option<Topology>>,
}

impl Sculpted {
    fn new(mesh: TriangleMesh) -> Self {
        Self {
            mesh: Rc::new(mesh),
            topology: OnceCell::new(),
        }
    }

    /// Returns the topology; `None` if it cannot be found.
    pub fn topology(&self) -> Option<&Topology> {
        let topology = self.topology.get_or_init(|| Topology::of(&self.mesh).ok());
        topology.as_ref()
    }
}

type Made = Result<Rc<Sculpted>, Rc<Vec<Diagnostic>>>;

/// A text, the file that it starts from, and what was made of them.
struct Kept {
    text: String,
    start: Start,
    made: Made,
}

/// Clay, and the strokes that were carried out on it.
struct KeptClay {
    script: Script,
    start: Start,
    clay: Clay,
}

/// The bytes of the file that a sculpture starts from, if there is one.
#[derive(Clone)]
struct Start(Option<Weak<[u8]>>);

impl Start {
    fn of(asset: Option<&Asset>) -> Self {
        Self(asset.map(|asset| Arc::downgrade(&asset.bytes)))
    }

    fn is(&self, asset: Option<&Asset>) -> bool {
        match (&self.0, asset) {
            (None, None) => true,
            (Some(bytes), Some(asset)) => bytes
                .upgrade()
                .is_some_and(|bytes| Arc::ptr_eq(&bytes, &asset.bytes)),
            _ => false,
        }
    }
}

thread_local! {
    static MESHES: RefCell<Vec<Kept>> = const { RefCell::new(Vec::new()) };
    static CLAYS: RefCell<Vec<KeptClay>> = const { RefCell::new(Vec::new()) };
}

/// Returns whether a file of a project is a text of strokes, by its name.
///
/// ```
/// assert!(rats::is_strokes("parts/dog.strokes") && !rats::is_strokes("strokes.rat"));
/// ```
#[must_use]
pub fn is_strokes(name: &str) -> bool {
    name.rsplit_once('.')
        .is_some_and(|(_, ending)| ending.eq_ignore_ascii_case("strokes"))
}

/// Returns the name of the mesh file that a text of strokes starts from, if it does.
///
/// ```
/// assert_eq!(rats::start_file("strokes 1\nstart file head.obj\n").as_deref(), Some("head.obj"));
/// assert_eq!(rats::start_file("strokes 1\nstart box 4\n"), None);
/// ```
#[must_use]
pub fn start_file(text: &str) -> Option<String> {
    // A text with mistakes names its file, too.
    let lines = text.lines().filter_map(|line| line.split('#').next());
    let lines = lines.map(str::trim).filter(|line| !line.is_empty());
    let name = lines
        .skip(1)
        .find_map(|line| line.strip_prefix("start"))?
        .trim_start();
    let name = name.strip_prefix("file")?.trim();
    (!name.is_empty()).then(|| name.to_owned())
}

/// Makes the mesh of a text of strokes, or finds it if it was kept; `start` is the file of which
/// [`start_file`] has the name.
///
/// # Errors
/// The mistakes of the text.
pub fn sculpt(text: &str, start: Option<&Asset>) -> Made {
    if let Some(made) = find(text, start) {
        return made;
    }
    let made = replay(text, start).map_err(Rc::new);
    keep(text, start, made.clone());
    made
}

/// Finds the mesh of a text among those that are kept.
fn find(text: &str, start: Option<&Asset>) -> Option<Made> {
    MESHES.with_borrow_mut(|kept| {
        let mut all = kept.iter();
        let at = all.position(|kept| kept.text == text && kept.start.is(start))?;
        kept[at..].rotate_left(1);
        kept.last().map(|kept| kept.made.clone())
    })
}

fn keep(text: &str, start: Option<&Asset>, made: Made) {
    MESHES.with_borrow_mut(|kept| {
        kept.retain(|kept| kept.text != text || !kept.start.is(start));
        if kept.len() >= KEPT {
            kept.remove(0);
        }
        kept.push(Kept {
            text: text.to_owned(),
            start: Start::of(start),
            made,
        });
    });
}

/// Keeps a mesh made elsewhere by the strokes of a text, so that compiling does not carry them out
/// again. It must be what they make.
pub fn keep_sculpted(text: &str, start: Option<&Asset>, mesh: TriangleMesh) {
    if mesh.triangles.len() <= limits::MAX_ELEMENTS {
        keep(text, start, Ok(Rc::new(Sculpted::new(mesh))));
    }
}

/// Carries out the strokes of a text and keeps the clay.
fn replay(text: &str, start: Option<&Asset>) -> Result<Rc<Sculpted>, Vec<Diagnostic>> {
    let script = Script::parse(text)?;
    let (mut clay, from) = match take_clay(&script, start) {
        Some(found) => found,
        None => (begin(&script, start).map_err(|mistake| vec![mistake])?, 0),
    };
    script
        .resume(&mut clay, from, MAX_STROKES_WORK)
        .map_err(|mistake| vec![mistake])?;
    let mesh = clay
        .to_triangles()
        .map_err(|error| vec![script.problem_at_start(&error.0)])?;
    CLAYS.with_borrow_mut(|kept| {
        if kept.len() >= KEPT_CLAYS {
            kept.remove(0);
        }
        let start = Start::of(start);
        kept.push(KeptClay {
            script,
            start,
            clay,
        });
    });
    Ok(Rc::new(Sculpted::new(mesh)))
}

/// Takes the kept clay on which most of the strokes were carried out; returns it and their number.
fn take_clay(script: &Script, start: Option<&Asset>) -> Option<(Clay, usize)> {
    CLAYS.with_borrow_mut(|kept| {
        let begun = kept.iter().enumerate().filter(|(_, kept)| {
            kept.start.is(start)
                && kept.script.start == script.start
                && script.strokes.starts_with(&kept.script.strokes)
        });
        let (at, _) = begun.max_by_key(|(_, kept)| kept.script.strokes.len())?;
        let found = kept.remove(at);
        Some((found.clay, found.script.strokes.len()))
    })
}

/// Makes the clay that the strokes begin with.
///
/// # Errors
/// If there is no such file, or it has too many faces for a model.
fn begin(script: &Script, start: Option<&Asset>) -> Result<Clay, Diagnostic> {
    let faces = match &script.start {
        Beginning::Shape(start) => start.face_count(),
        Beginning::File(name) => {
            let asset = start.ok_or_else(|| {
                script.problem_at_start(&format!("there is no mesh `{name}` in the project"))
            })?;
            let mesh = asset.mesh();
            mesh.map_err(|error| script.problem_at_start(&error.0))?
                .triangles
                .len()
        }
    };
    if faces > MAX_STROKES_FACES {
        let most = format_args!("in a model it may have {MAX_STROKES_FACES}");
        let message = format!("this start has {faces} faces; {most}, `sinew sculpt` takes more");
        return Err(script.problem_at_start(&message));
    }
    script.begin(&mut |_: &str| match start.map(Asset::mesh) {
        Some(Ok(mesh)) => Ok((*mesh).clone()),
        Some(Err(error)) => Err(error.0),
        None => Err(String::from("there is no such file")),
    })
}
