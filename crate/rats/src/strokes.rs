//! Meshes made by strokes: texts of a project with the ending `.strokes`, which `mesh` uses like
//! files of meshes.
//!
//! What was made is kept while compilations ask for it, and a text that has only grown is carried
//! on from where the last one ended, as a text is compiled after every stroke.

use crate::limits::{MAX_STROKES_FACES, MAX_STROKES_WORK};
use crate::project::Asset;
use crate::{assets, limits};
use mesh::{Topology, TriangleMesh};
use sculpt::{Beginning, Clay, Diagnostic, Script};
use std::cell::{OnceCell, RefCell};
use std::rc::Rc;
use std::sync::{Arc, Weak};

/// How many meshes are kept.
const KEPT: usize = 12;
/// How many sculptures are kept to go on with.
const KEPT_CLAYS: usize = 3;

/// A mesh made by strokes.
#[derive(Debug)]
pub struct Sculpted {
    /// Its triangles.
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

    /// Its topology; `None` if it cannot be told.
    pub fn topology(&self) -> Option<&Topology> {
        let tell = || Topology::of(&self.mesh).ok();
        self.topology.get_or_init(tell).as_ref()
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

/// Whether a file of a project is a text of strokes, by its name.
///
/// ```
/// assert!(rats::is_strokes("parts/dog.strokes") && !rats::is_strokes("strokes.rat"));
/// ```
#[must_use]
pub fn is_strokes(name: &str) -> bool {
    name.rsplit_once('.')
        .is_some_and(|(_, ending)| ending.eq_ignore_ascii_case("strokes"))
}

/// The name of the mesh file that a text of strokes starts from, if it does.
///
/// ```
/// assert_eq!(rats::start_file("strokes 1\nstart file head.obj\n").as_deref(), Some("head.obj"));
/// assert_eq!(rats::start_file("strokes 1\nstart box 4\n"), None);
/// ```
#[must_use]
pub fn start_file(text: &str) -> Option<String> {
    // A text with mistakes names its file, too.
    let plain = |line: &str| line.split('#').next().unwrap_or_default().trim().to_owned();
    let lines = text.lines().map(plain).filter(|line| !line.is_empty());
    let start = lines.skip(1).find(|line| line.starts_with("start"))?;
    let name = start.strip_prefix("start")?.trim_start();
    let name = name.strip_prefix("file")?.trim();
    (!name.is_empty()).then(|| name.to_owned())
}

/// The mesh that a text of strokes makes; `start` is the file of which [`start_file`] has the name.
///
/// # Errors
/// What is wrong with the text.
pub fn sculpted(text: &str, start: Option<&Asset>) -> Made {
    if let Some(made) = kept(text, start) {
        return made;
    }
    let made = replayed(text, start).map_err(Rc::new);
    keep(text, start, made.clone());
    made
}

fn kept(text: &str, start: Option<&Asset>) -> Option<Made> {
    MESHES.with_borrow_mut(|kept| {
        let is_it = |kept: &Kept| kept.text == text && kept.start.is(start);
        let at = kept.iter().position(is_it)?;
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

fn replayed(text: &str, start: Option<&Asset>) -> Result<Rc<Sculpted>, Vec<Diagnostic>> {
    let script = Script::parse(text)?;
    let (clay, from) = match resumed(&script, start) {
        Some(found) => found,
        None => (begun(&script, start).map_err(|told| vec![told])?, 0),
    };
    let mut clay = clay;
    script
        .resume(&mut clay, from, MAX_STROKES_WORK)
        .map_err(|told| vec![told])?;
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

/// The kept clay on which most of the strokes were carried out, and how many.
fn resumed(script: &Script, start: Option<&Asset>) -> Option<(Clay, usize)> {
    CLAYS.with_borrow_mut(|kept| {
        let is_begun = |kept: &KeptClay| {
            kept.start.is(start)
                && kept.script.start == script.start
                && script.strokes.starts_with(&kept.script.strokes)
        };
        let begun = kept.iter().enumerate().filter(|(_, kept)| is_begun(kept));
        let (at, _) = begun.max_by_key(|(_, kept)| kept.script.strokes.len())?;
        let found = kept.remove(at);
        Some((found.clay, found.script.strokes.len()))
    })
}

/// The clay that the strokes begin with, if it is small enough for a picture.
fn begun(script: &Script, start: Option<&Asset>) -> Result<Clay, Diagnostic> {
    let faces = match &script.start {
        Beginning::Shape(start) => start.face_count(),
        Beginning::File(name) => {
            let asset = start.ok_or_else(|| {
                script.problem_at_start(&format!("there is no mesh `{name}` in the project"))
            })?;
            let mesh = assets::mesh(asset);
            mesh.map_err(|error| script.problem_at_start(&error.0))?
                .triangles
                .len()
        }
    };
    if faces > MAX_STROKES_FACES {
        return Err(script.problem_at_start(&format!(
            "this start has {faces} faces; in a model it may have {MAX_STROKES_FACES}, `sinew sculpt` takes more"
        )));
    }
    let mut load = |_: &str| match start.map(assets::mesh) {
        Some(Ok(mesh)) => Ok((*mesh).clone()),
        Some(Err(error)) => Err(error.0),
        None => Err(String::from("there is no such file")),
    };
    script.begin(&mut load)
}
