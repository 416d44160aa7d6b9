//! The model as a mesh, for printers and other programs: the jobs of the tools worker, and scripts
//! that ask for a file. The page's dialog shows it.
//!
//! The mesh is made apart from the page's thread; until it is there the dialog shows a coat of the
//! skeletons. Another format or size only writes the mesh again. The motion of a skeleton is
//! compiled frame by frame, some at each tick, so that the page stays responsive.

use crate::asset::Asset;
use crate::player::MAX_FRAMES;
use crate::session::Session;
use mesh::{Format, TriangleMesh};
use mesher::{Tolerance, Wishes};
use pool::{Ticket, Tools, clock};
use rats::Project;
use scene::Scene;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};
use std::sync::Arc;
use tools::{CoatScene, Coated, MeshFacts, MeshScene, Meshed, Poses, WriteMesh, Written};
use viewport::Surface;

/// Bound of the coat that is shown until the mesh is there.
const COAT: f64 = 0.05;
/// Most elements of a scene that gets such a coat.
const MOST_COATED: usize = 20_000;
/// Most triangles whose edges are shown: beyond there are more edges than pixels.
pub const MOST_EDGES: usize = 300_000;
/// Seconds of a tick that frames of a motion may take.
const SLICE: f64 = 0.008;

/// The mesh file that is asked for. Scripts write it as JSON with any of these fields, the format
/// as the file's ending.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(default)]
pub struct Order {
    /// Format of the file.
    #[serde(deserialize_with = "format")]
    pub format: Format,
    /// Largest distance between mesh and surface, as a part of the longest side.
    pub tolerance: f64,
    /// Length of the model's longest side, millimetres; 0: a unit of the scene is one.
    pub size: f64,
    /// Whether bodies that overlap become one.
    pub union: bool,
    /// Whether what can be proved of the mesh is; else its error is measured, in a tenth of the
    /// time.
    pub prove: bool,
    /// Whether skeletons become joints, and their motion an animation: in GLB files.
    pub rig: bool,
}

/// Reads a format from the ending of its files.
fn format<'de, D: Deserializer<'de>>(from: D) -> Result<Format, D::Error> {
    let ending = String::deserialize(from)?;
    let format = Format::of_name(&format!("model.{ending}"));
    let endings = Format::ENDINGS;
    format.ok_or_else(|| D::Error::custom(format_args!("format is one of the endings {endings}")))
}

impl Default for Order {
    fn default() -> Self {
        Self {
            format: Format::Stl,
            tolerance: 1.5e-3,
            size: 100.0,
            union: false,
            prove: false,
            rig: false,
        }
    }
}

impl Order {
    /// Checks numbers and format.
    ///
    /// # Errors
    /// A sentence, if a number is out of its range or the format has no joints.
    pub fn check(&self) -> Result<(), String> {
        let [finest, coarsest] = [1e-6, 0.5];
        if !(finest..=coarsest).contains(&self.tolerance) {
            return Err(format!(
                "The tolerance must be from {finest} to {coarsest} of the model's length."
            ));
        }
        if self.size != 0.0 && !(1e-3..=1e6).contains(&self.size) {
            return Err(String::from(
                "The size must be a length in millimetres from 0.001 to 1000000, or 0 for the \
                 scene's own units.",
            ));
        }
        if self.rig && self.format != Format::Glb {
            return Err(String::from("Only GLB files have joints."));
        }
        Ok(())
    }

    /// Whether joints are wanted, which only GLB has.
    fn is_rigged(&self) -> bool {
        self.rig && self.format == Format::Glb
    }
}

/// Frames of the film that a motion is taken from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Number of frames.
    pub count: u32,
    /// Frames in a second.
    pub rate: u16,
}

/// The settings that triangles depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shape {
    tolerance: f64,
    union: bool,
    prove: bool,
    /// [`Session::generation`] of the scene.
    generation: u64,
    /// Whether the film's first frame is meshed, while another one is on show.
    first_frame: bool,
}

/// The settings that a file depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wanted {
    shape: Shape,
    order: Order,
    film: Option<Film>,
}

/// Takes a file's bytes, or the reason why there are none.
pub type Taker = Box<dyn FnOnce(Result<Vec<u8>, String>)>;

/// A job that is not over.
struct Running<K, T> {
    /// The settings or the receiver of the result.
    of: K,
    ticket: Ticket<T>,
}

impl<K, T> Running<K, T> {
    /// Takes the result of a job that is over, and forgets the job.
    fn take_result(job: &mut Option<Self>) -> Option<(K, Result<T, String>)> {
        let result = job.as_mut()?.ticket.result()?;
        job.take().map(|job| (job.of, result))
    }

    fn fraction(&self) -> f32 {
        self.ticket.fraction().unwrap_or(0.0)
    }
}

/// Frames of a motion that are being compiled.
struct Filming {
    project: Project,
    assets: Vec<Asset>,
    film: Film,
    scenes: Vec<Scene>,
    next: Next,
}

/// The use of the frames.
enum Next {
    /// The dialog's file.
    File(Wanted),
    /// A script's mesh.
    Script(Box<(Order, String, Taker)>),
}

/// A mesh that is there.
pub struct Made {
    /// A number that tells it from other meshes.
    pub number: u64,
    shape: Shape,
    parts: Vec<(String, TriangleMesh)>,
    facts: MeshFacts,
    /// The mesh as one surface to be drawn.
    pub surface: Surface,
}

impl Made {
    /// Returns [`Session::generation`] of its scene.
    pub fn generation(&self) -> u64 {
        self.shape.generation
    }
}

/// The model as a mesh.
pub struct MeshExport {
    tools: Tools,
    /// The file that the dialog asks for.
    pub order: Order,
    /// A coat of the skeletons, which the dialog shows until the mesh is there.
    coating: Option<Running<Shape, Coated>>,
    /// The dialog's triangles.
    meshing: Option<Running<Shape, Meshed>>,
    /// The dialog's file.
    writing: Option<Running<Wanted, Written>>,
    /// Meshes whose files scripts wait for.
    scripts: Vec<Running<Taker, Meshed>>,
    filming: Vec<Filming>,
    /// The mesh that is there.
    pub made: Option<Made>,
    written: Option<(Wanted, Written)>,
    /// Settings that give no file, and the reason.
    trouble: Option<(Wanted, String)>,
    /// Number of meshes that were made.
    count: u64,
    /// Name of the files without extension.
    name: String,
}

/// The progress of the dialog's mesh.
pub enum State<'a> {
    /// The mesh is being made; the fraction done.
    Making(f32),
    /// The mesh cannot be made, for this reason.
    Trouble(&'a str),
    /// The mesh and its file are there.
    Done(&'a MeshFacts, &'a Written),
    /// Nothing was asked for yet.
    Idle,
}

/// The state for scripts.
#[derive(Clone, Debug, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Report {
    /// Whether the mesh that was asked for is being made.
    pub running: bool,
    /// Triangles on show.
    pub shown: usize,
    /// Triangles of the mesh that was asked for.
    pub triangles: Option<usize>,
    /// Length of the files together.
    pub bytes: Option<usize>,
    /// The reason why there is none.
    pub said: Option<String>,
}

impl MeshExport {
    /// Makes no mesh until one is asked for.
    #[must_use]
    pub fn new(tools: Tools) -> Self {
        Self {
            tools,
            order: Order::default(),
            coating: None,
            meshing: None,
            writing: None,
            scripts: Vec::new(),
            filming: Vec::new(),
            made: None,
            written: None,
            trouble: None,
            count: 0,
            name: String::new(),
        }
    }

    /// Takes in results of the worker. Returns whether it must be called again soon.
    pub fn tick(&mut self) -> bool {
        // Widgets that move are known, also to scripts, a frame later.
        let mut again = false;
        if let Some((shape, result)) = Running::take_result(&mut self.coating) {
            again = true;
            if let Ok(Coated { parts, .. }) = result
                && !parts.is_empty()
            {
                self.take(shape, parts, MeshFacts::default());
            }
        }
        if let Some((shape, result)) = Running::take_result(&mut self.meshing) {
            again = true;
            match result {
                Ok(meshed) => self.take(shape, meshed.parts, meshed.facts),
                Err(reason) => self.fail(shape, reason),
            }
        }
        if let Some((wanted, result)) = Running::take_result(&mut self.writing) {
            again = true;
            match result {
                Ok(written) => {
                    self.trouble = None;
                    self.written = Some((wanted, written));
                }
                Err(reason) => self.trouble = Some((wanted, reason)),
            }
        }
        for mut script in std::mem::take(&mut self.scripts) {
            match script.ticket.result() {
                None => self.scripts.push(script),
                Some(result) => {
                    again = true;
                    // The materials of OBJ are in a second file, which is not needed.
                    (script.of)(result.map(|meshed| {
                        let first = meshed.written.files.into_iter().next();
                        first.map_or_else(Vec::new, |file| file.bytes)
                    }));
                }
            }
        }
        self.film();
        again || !self.filming.is_empty()
    }

    /// Compiles frames for [`SLICE`] seconds, and begins the jobs of those that are complete.
    fn film(&mut self) {
        let start = clock::stopwatch();
        while let Some(filming) = self.filming.first_mut() {
            if filming.scenes.len() < filming.film.count as usize {
                let frame = filming.scenes.len() as f64;
                let scene = rats::compile_at(&filming.project, &filming.assets, frame).scene;
                // The first one is meshed; the others only give the motion.
                filming.scenes.push(if filming.scenes.is_empty() {
                    Arc::unwrap_or_clone(scene)
                } else {
                    rig::skeletons_of(&scene)
                });
                if clock::stopwatch() - start > SLICE {
                    return;
                }
                continue;
            }
            let Filming {
                film, scenes, next, ..
            } = self.filming.remove(0);
            let rate = f64::from(film.rate);
            match next {
                Next::File(wanted) => self.write(wanted, Some(Poses { scenes, rate })),
                Next::Script(script) => {
                    let (order, name, taker) = *script;
                    let first = Arc::new(scenes[0].clone());
                    self.make(order, name, first, Some(Poses { scenes, rate }), taker);
                }
            }
        }
    }

    /// Takes in a mesh.
    fn take(&mut self, shape: Shape, parts: Vec<(String, TriangleMesh)>, facts: MeshFacts) {
        self.count += 1;
        self.made = Some(Made {
            number: self.count,
            shape,
            surface: surface(&parts, facts.is_closed),
            parts,
            facts,
        });
    }

    /// Notes why the mesh of a shape cannot be made.
    fn fail(&mut self, shape: Shape, reason: String) {
        let wanted = Wanted {
            shape,
            order: self.order,
            film: None,
        };
        self.trouble = Some((wanted, reason));
    }

    /// Makes a mesh of the session's scene for a script.
    pub fn make_for(
        &mut self,
        session: &Session,
        film: Film,
        name: &str,
        order: Order,
        taker: Taker,
    ) {
        if let Err(reason) = order.check() {
            taker(Err(reason));
            return;
        }
        let Some(scene) = session.scene() else {
            taker(Err(String::from("There is no model yet.")));
            return;
        };
        if order.rig {
            if !rig::has_skeleton(scene) {
                taker(Err(String::from(
                    "There is no skeleton: joints come from the command skeleton.",
                )));
                return;
            }
            let script = Box::new((order, name.to_owned(), taker));
            self.filming
                .push(filming(session, Some(film), Next::Script(script)));
        } else {
            self.make(order, name.to_owned(), scene.clone(), None, taker);
        }
    }

    /// Begins a job that meshes and writes a scene for a script.
    fn make(
        &mut self,
        order: Order,
        name: String,
        scene: Arc<Scene>,
        rig: Option<Poses>,
        taker: Taker,
    ) {
        let job = MeshScene {
            format: Some(order.format),
            rig,
            ..meshing(scene, order, name)
        };
        self.scripts.push(Running {
            ticket: self.tools.submit(job),
            of: taker,
        });
    }

    /// Begins a job that writes the dialog's mesh.
    fn write(&mut self, wanted: Wanted, rig: Option<Poses>) {
        let Some(made) = self.made.as_ref().filter(|made| made.shape == wanted.shape) else {
            return;
        };
        let job = WriteMesh {
            parts: made.parts.clone(),
            format: wanted.order.format,
            name: self.name.clone(),
            size: wanted.order.size,
            rig,
        };
        self.writing = Some(Running {
            ticket: self.tools.submit(job),
            of: wanted,
        });
    }

    /// Ends the jobs of the dialog, when it is closed or their results are not wanted any more.
    pub fn stop(&mut self) {
        // The last ones first, so that ending one does not begin the next.
        self.writing = None;
        self.meshing = None;
        self.coating = None;
        self.filming
            .retain(|filming| matches!(filming.next, Next::Script(_)));
    }

    /// Ends the jobs of the dialog and forgets its mesh, when another work was opened.
    pub fn forget(&mut self) {
        self.stop();
        (self.made, self.written, self.trouble) = (None, None, None);
    }

    /// Ends the jobs of the dialog at the user's wish, until the settings change.
    pub fn give_up(&mut self, session: &Session, film: Film) {
        self.stop();
        let text = String::from("Stopped. Choose less detail, or go on.");
        self.trouble = Some((self.target(session, film), text));
    }

    /// Whether the mesh on show is only a coat of the skeletons.
    pub fn shows_coat(&self) -> bool {
        let made = self.made.as_ref();
        made.is_some_and(|made| made.shape.tolerance.is_infinite())
    }

    /// Whether the last try gave nothing.
    pub fn has_failed(&self) -> bool {
        self.trouble.is_some()
    }

    /// Forgets what went wrong, so that it is tried again.
    pub fn again(&mut self) {
        self.trouble = None;
    }

    /// Returns the file that the dialog's settings ask for.
    fn target(&self, session: &Session, film: Film) -> Wanted {
        let order = Order {
            rig: self.order.is_rigged(),
            ..self.order
        };
        let has_motion = order.rig && session.is_animated();
        Wanted {
            shape: Shape {
                tolerance: order.tolerance,
                union: order.union,
                prove: order.prove,
                generation: session.generation(),
                first_frame: has_motion && session.film_frame() > 0,
            },
            order,
            film: has_motion.then_some(film),
        }
    }

    /// Begins the next job for the dialog's settings, unless their file is there or on its way.
    pub fn follow(&mut self, session: &Session, film: Film, name: &str) {
        let wanted = self.target(session, film);
        let Wanted { shape, order, .. } = wanted;
        if let Some((of, _)) = &self.trouble
            && of.shape == shape
            && of.order == order
        {
            return;
        }
        name.clone_into(&mut self.name);
        let is_made = self.made.as_ref().is_some_and(|made| made.shape == shape);
        if !is_made {
            if self.meshing.as_ref().is_some_and(|job| job.of == shape) {
                return;
            }
            self.stop();
            let scene = if shape.first_frame {
                let (project, assets) = (session.project(), session.assets());
                Some(rats::compile_at(project, assets, 0.0).scene)
            } else {
                session.scene().cloned()
            };
            let Some(scene) = scene else {
                return;
            };
            let is_other = self.made.as_ref().is_none_or(|made| {
                made.shape.generation != shape.generation
                    || made.shape.first_frame != shape.first_frame
            });
            if is_other && scene.elements.len() <= MOST_COATED {
                let job = CoatScene {
                    scene: scene.clone(),
                    bound: COAT,
                    coatings: Vec::new(),
                };
                // A tolerance that no mesh has.
                let tolerance = f64::INFINITY;
                self.coating = Some(Running {
                    ticket: self.tools.submit(job),
                    of: Shape { tolerance, ..shape },
                });
            }
            // The dialog's files are written by another job.
            let job = meshing(scene, order, name.to_owned());
            self.meshing = Some(Running {
                ticket: self.tools.submit(job),
                of: shape,
            });
            return;
        }
        let is_written = matches!(&self.written, Some((of, _)) if *of == wanted);
        let is_coming = self.writing.as_ref().is_some_and(|job| job.of == wanted)
            || self
                .filming
                .iter()
                .any(|filming| matches!(&filming.next, Next::File(of) if *of == wanted));
        if is_written || is_coming {
            return;
        }
        self.stop();
        if order.rig {
            self.filming
                .push(filming(session, wanted.film, Next::File(wanted)));
        } else {
            self.write(wanted, None);
        }
    }

    /// Returns the progress of the mesh of the dialog's settings.
    pub fn state(&self, session: &Session, film: Film) -> State<'_> {
        let wanted = self.target(session, film);
        let Wanted { shape, order, .. } = wanted;
        if let Some((of, reason)) = &self.trouble
            && of.shape == shape
            && of.order == order
        {
            return State::Trouble(reason);
        }
        if let (Some(made), Some((of, written))) = (&self.made, &self.written)
            && made.shape == shape
            && *of == wanted
        {
            return State::Done(&made.facts, written);
        }
        let meshing = self.meshing.as_ref().map(Running::fraction);
        if let Some(fraction) = meshing.or(self.writing.as_ref().map(Running::fraction)) {
            return State::Making(fraction);
        }
        let mut filming = self.filming.iter();
        if let Some(filming) = filming.find(|filming| matches!(filming.next, Next::File(_))) {
            return State::Making(filming.scenes.len() as f32 / filming.film.count.max(1) as f32);
        }
        State::Idle
    }

    /// Returns the factor from lengths in the facts of a mesh to those in the present settings.
    pub fn growth(&self, facts: &MeshFacts) -> f64 {
        let longest = facts.sides.into_iter().fold(0.0, f64::max);
        self.order.size / longest
    }

    /// Returns the files of the mesh on show.
    #[must_use]
    pub fn files(&self) -> &[mesh::ExportedFile] {
        self.written
            .as_ref()
            .map_or(&[], |(_, written)| &written.files)
    }

    /// Returns the state for scripts; `None` before a mesh was asked for.
    #[must_use]
    pub fn report(&self, session: &Session, film: Film) -> Option<Report> {
        let shown = self.made.as_ref();
        let state = self.state(session, film);
        if shown.is_none() && matches!(state, State::Idle) {
            return None;
        }
        Some(Report {
            running: matches!(state, State::Making(_)),
            shown: shown.map_or(0, |made| made.surface.triangles.len()),
            triangles: match state {
                State::Done(facts, _) => Some(facts.triangles),
                _ => None,
            },
            bytes: match state {
                State::Done(_, written) => {
                    Some(written.files.iter().map(|file| file.bytes.len()).sum())
                }
                _ => None,
            },
            said: match state {
                State::Trouble(reason) => Some(reason.to_owned()),
                _ => None,
            },
        })
    }
}

/// Returns the job that meshes a scene as an order says, without its file.
#[must_use]
pub fn meshing(scene: Arc<Scene>, order: Order, name: String) -> MeshScene {
    MeshScene {
        scene,
        wishes: Wishes {
            tolerance: Tolerance::OfSide(order.tolerance),
            union: order.union,
            prove: order.prove,
            ..Wishes::default()
        },
        format: None,
        name,
        size: order.size,
        rig: None,
    }
}

/// Begins to compile the frames of a session's work.
fn filming(session: &Session, film: Option<Film>, next: Next) -> Filming {
    let still = Film { count: 1, rate: 1 };
    let film = film.filter(|_| session.is_animated()).unwrap_or(still);
    Filming {
        project: session.project().clone(),
        assets: session.assets().to_vec(),
        film: Film {
            count: film.count.clamp(1, MAX_FRAMES),
            rate: film.rate.max(1),
        },
        scenes: Vec::new(),
        next,
    }
}

/// Returns the parts of a mesh as one surface to be drawn.
fn surface(parts: &[(String, TriangleMesh)], is_closed: bool) -> Surface {
    let mut all = Surface {
        is_closed,
        ..Surface::default()
    };
    let clay = [0.8, 0.62, 0.5];
    for (_, mesh) in parts {
        let first = all.positions.len() as u32;
        all.positions
            .extend(mesh.positions.iter().map(|p| p.as_vec3()));
        match &mesh.colors {
            Some(colors) => all.colors.extend(colors.iter().map(|c| c.map(to_srgb))),
            None => all.colors.extend(of_materials(mesh, clay)),
        }
        let triangles = mesh.triangles.iter().map(|t| t.map(|i| first + i));
        all.triangles.extend(triangles);
    }
    all.smooth();
    if all.triangles.len() <= MOST_EDGES {
        // Each edge of a closed mesh has two triangles, in opposite directions.
        for [a, b, c] in &all.triangles {
            let edges = [[*a, *b], [*b, *c], [*c, *a]].into_iter();
            all.edges.extend(edges.filter(|[a, b]| a < b || !is_closed));
        }
    }
    all
}

/// Returns a colour for each vertex of a mesh: its material's, else another.
fn of_materials(mesh: &TriangleMesh, other: [f32; 3]) -> Vec<[f32; 3]> {
    let mut colors = vec![other; mesh.positions.len()];
    for group in &mesh.groups {
        let Some(material) = &group.material else {
            continue;
        };
        let color = material.color.map(to_srgb);
        let range = group.triangles.start as usize..group.triangles.end as usize;
        for triangle in mesh.triangles.get(range).unwrap_or_default() {
            for vertex in triangle {
                colors[*vertex as usize] = color;
            }
        }
    }
    colors
}

/// Encodes a channel of linear light as sRGB, exactly enough for a view.
fn to_srgb(channel: f32) -> f32 {
    libm::powf(channel.clamp(0.0, 1.0), 1.0 / 2.2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;
    use std::rc::Rc;
    use std::time::{Duration, Instant};

    fn make_for_script(text: &str, order: Order) -> Result<Vec<u8>, String> {
        let mut export = MeshExport::new(Tools::new(|| {}));
        let given = Rc::new(RefCell::new(None));
        let place = given.clone();
        let taker = Box::new(move |result| *place.borrow_mut() = Some(result));
        let film = Film { count: 5, rate: 12 };
        export.make_for(&Session::of_text(text), film, "ball", order, taker);
        let deadline = Instant::now() + Duration::from_secs(60);
        while given.borrow().is_none() {
            assert!(Instant::now() < deadline);
            std::thread::sleep(Duration::from_millis(1));
            export.tick();
        }
        given.take().unwrap()
    }

    const BALL: &str = "surface s diffuse Gold, blob -2\nsphere s 1 0 0 0\n";

    #[test]
    fn script_gets_the_file_in_millimetres() {
        let order = Order {
            tolerance: 1e-2,
            size: 30.0,
            ..Order::default()
        };
        let bytes = make_for_script(BALL, order).unwrap();
        let mesh = mesh::read("ball.stl", &bytes).unwrap();
        let far = mesh.positions.iter().map(|p| p.x.abs()).fold(0.0, f64::max);
        assert!((far - 15.0).abs() < 0.5, "{far}");
    }

    #[test]
    fn scripts_learn_why_there_is_no_mesh() {
        let order = Order::default();
        let nothing = make_for_script("surface s diffuse Gold\n", order).unwrap_err();
        assert!(nothing.contains("no surface"), "{nothing}");
        for (tolerance, size) in [
            (0.0, 1.0),
            (f64::NAN, 1.0),
            (1e-3, -1.0),
            (1e-3, f64::INFINITY),
        ] {
            let order = Order {
                tolerance,
                size,
                ..order
            };
            assert!(make_for_script(BALL, order).is_err());
        }
    }

    const ARM: &str = "var y = 0 += 0.2\nsurface s, diffuse Red, radius 0.3\n\
        skeleton s, ARM { node A <0 0 0> node B <2 0 0> node C <4 y 0> curve A B C }\n";

    #[test]
    fn script_gets_joints_and_motion() {
        let order = Order {
            format: Format::Glb,
            tolerance: 1e-2,
            rig: true,
            ..Order::default()
        };
        let bytes = make_for_script(ARM, order).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        for word in ["\"skins\"", "\"animations\"", "JOINTS_0", "WEIGHTS_0"] {
            assert!(text.contains(word), "{word}");
        }
        let nothing = make_for_script(BALL, order).unwrap_err();
        assert!(nothing.contains("no skeleton"), "{nothing}");
        let other = Order {
            format: Format::Stl,
            ..order
        };
        assert!(make_for_script(ARM, other).unwrap_err().contains("GLB"));
    }

    /// Follows the settings until their file is there or has failed. Returns the number of jobs
    /// that were begun.
    fn follow(export: &mut MeshExport, session: &Session) -> usize {
        let film = Film { count: 5, rate: 12 };
        let deadline = Instant::now() + Duration::from_secs(120);
        let mut begun = std::collections::BTreeSet::new();
        loop {
            assert!(Instant::now() < deadline);
            export.follow(session, film, "model");
            begun.extend(export.coating.iter().map(|job| format!("{:?}", job.of)));
            begun.extend(export.meshing.iter().map(|job| format!("{:?}", job.of)));
            begun.extend(export.writing.iter().map(|job| format!("{:?}", job.of)));
            if matches!(
                export.state(session, film),
                State::Done(..) | State::Trouble(_)
            ) {
                return begun.len();
            }
            std::thread::sleep(Duration::from_millis(1));
            export.tick();
        }
    }

    #[test]
    fn another_format_or_size_makes_no_new_triangles() {
        let (ball, arm) = (Session::of_text(BALL), Session::of_text(ARM));
        let mut export = MeshExport::new(Tools::new(|| {}));
        // Coat, mesh, file.
        assert_eq!(follow(&mut export, &ball), 3);
        assert_eq!(export.files()[0].name, "model.stl");
        export.order.format = Format::ThreeMf;
        assert_eq!(follow(&mut export, &ball), 1);
        assert_eq!(export.files()[0].name, "model.3mf");
        export.order.size = 30.0;
        export.order.format = Format::Stl;
        assert_eq!(follow(&mut export, &ball), 1);
        let mesh = mesh::read("a.stl", &export.files()[0].bytes).unwrap();
        let side = mesh.bounds().size().max_element();
        assert!((side - 30.0).abs() < 0.1, "{side}");
        // A coarser one has something to show already.
        export.order.tolerance = 4e-3;
        assert_eq!(follow(&mut export, &ball), 2);
        let State::Done(facts, _) = export.state(&ball, Film { count: 5, rate: 12 }) else {
            panic!("no mesh");
        };
        let off = facts.error * export.growth(facts) / export.order.size;
        assert!(facts.is_measured && off <= 4e-3, "{off}");
        // Proofs are of other triangles.
        export.order.prove = true;
        assert_eq!(follow(&mut export, &ball), 2);
        let State::Done(facts, _) = export.state(&ball, Film { count: 5, rate: 12 }) else {
            panic!("no mesh");
        };
        let proved = facts.error * export.growth(facts) / export.order.size;
        assert!(
            !facts.is_measured && (3.6e-3..=4e-3).contains(&proved),
            "{proved}"
        );
        // Another model; joints need no new triangles either.
        export.order.format = Format::Glb;
        let mut arm = arm;
        assert_eq!(arm.generation(), ball.generation());
        arm.set_film_frame(0);
        export = MeshExport::new(Tools::new(|| {}));
        export.order = Order {
            format: Format::Glb,
            tolerance: 1e-2,
            ..Order::default()
        };
        assert_eq!(follow(&mut export, &arm), 3);
        let plain = glb(&export);
        export.order.rig = true;
        assert_eq!(follow(&mut export, &arm), 1);
        assert!(glb(&export).len() > plain.len() + 16 * 4);
        // In another frame the film's first one is meshed.
        arm.set_film_frame(3);
        arm.compile();
        let rigged = glb(&export);
        follow(&mut export, &arm);
        assert_eq!(glb(&export), rigged);
    }

    fn glb(export: &MeshExport) -> Vec<u8> {
        export.files()[0].bytes.clone()
    }

    #[test]
    fn a_stopped_mesh_is_not_made_until_the_user_asks() {
        let ball = Session::of_text(BALL);
        let film = Film { count: 5, rate: 12 };
        let mut export = MeshExport::new(Tools::new(|| {}));
        export.order.tolerance = 3e-4;
        export.follow(&ball, film, "ball");
        export.give_up(&ball, film);
        export.follow(&ball, film, "ball");
        assert!(export.meshing.is_none() && export.coating.is_none());
        assert!(matches!(export.state(&ball, film), State::Trouble(_)));
        export.again();
        export.order.tolerance = 1e-2;
        follow(&mut export, &ball);
        assert!(matches!(export.state(&ball, film), State::Done(..)));
    }
}
