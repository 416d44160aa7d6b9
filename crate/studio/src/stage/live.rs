//! A mesh of the model's true surface for the draft, while the user turns the model or drags a part
//! of it.
//!
//! A tools worker makes it, apart from the page's thread: a coarse one while the text changes, and
//! a fine one once nothing changes and no picture is traced. Until it is there, and where it would
//! come too late to follow a drag, the draft shows the elements before they melt together. No mesh
//! is made, and no worker fetched, before the user turns or drags for the first time.

use document::session::Session;
use pool::{Ticket, Tools};
use preview::Mesh;
use scene::{Element, Scene};
use std::sync::Arc;
use tools::{Detail, ViewMesh, ViewScene};

/// Most seconds that a coarse mesh may take to follow a drag.
const QUICK: f64 = 0.15;
/// Seconds for which such a mesh stands in for the next one.
const LATE: f64 = 0.35;
/// Seconds without a change before a fine mesh is made.
const STILL: f64 = 0.5;
/// Seconds of work after which a mesh is given up.
const LIMIT: f64 = 8.0;
/// Most elements of a scene that is meshed.
const MOST: usize = 20_000;

/// A mesh that is being made.
struct Running {
    ticket: Ticket<ViewMesh>,
    shape: u64,
    detail: Detail,
    /// Time at which it was last seen to wait for its turn.
    start: f64,
}

/// A mesh that is there.
pub struct Made {
    /// A number that tells it from other meshes.
    pub number: u64,
    mesh: ViewMesh,
    /// [`Session::shape`] of its scene.
    shape: u64,
    detail: Detail,
    /// Time at which it last was, or may have been, the mesh of the present scene.
    current: f64,
}

impl Made {
    /// Returns the mesh as the draft takes it.
    #[must_use]
    pub fn mesh(&self) -> Mesh<'_> {
        Mesh {
            vertices: &self.mesh.vertices,
            triangles: &self.mesh.triangles,
            origin: self.mesh.origin,
            unit: self.mesh.unit,
        }
    }
}

/// The mesh of the present work.
pub struct LiveMesh {
    tools: Tools,
    is_wanted: bool,
    running: Option<Running>,
    made: Option<Made>,
    count: u64,
    /// Seconds that the last coarse mesh took.
    seconds: f64,
    /// [`Session::shape`] of a scene that cannot be meshed, or no finer.
    hopeless: Option<u64>,
    /// Number of elements of a scene that took too long: another try waits until it changes.
    slow: Option<usize>,
    /// [`Session::shape`] of the scene seen last, and the time at which it changed.
    seen: (u64, f64),
}

impl LiveMesh {
    /// Makes no mesh until one is wanted.
    #[must_use]
    pub fn new(tools: Tools) -> Self {
        Self {
            tools,
            is_wanted: false,
            running: None,
            made: None,
            count: 0,
            seconds: f64::INFINITY,
            hopeless: None,
            slow: None,
            seen: (0, 0.0),
        }
    }

    /// Makes meshes from now on, as the user turns or drags.
    pub fn want(&mut self) {
        self.is_wanted = true;
    }

    /// Forgets everything, when another work was opened.
    pub fn forget(&mut self) {
        self.running = None;
        self.is_wanted = false;
        self.made = None;
        self.seconds = f64::INFINITY;
        self.hopeless = None;
        self.slow = None;
    }

    /// Gives up a fine mesh, which is made later, so that the worker is free for other jobs.
    pub fn give_way(&mut self) {
        self.running
            .take_if(|running| running.detail == Detail::Fine);
    }

    /// Takes in a mesh from the worker, and begins the next one. `is_drawn`: a draft is on the
    /// screen; `rests`: no picture is being traced.
    pub fn tick(&mut self, session: &Session, now: f64, is_drawn: bool, rests: bool) {
        if let Some(running) = &mut self.running {
            if let Some(result) = running.ticket.result() {
                self.take(result, now);
            } else if running.ticket.fraction().is_none() {
                running.start = now;
            }
        }
        let shape = session.shape();
        if self.seen.0 != shape {
            self.seen = (shape, now);
        }
        if let Some(made) = self.made.as_mut().filter(|made| made.shape == shape) {
            made.current = now;
        }
        if let Some(running) = &self.running {
            let is_old = running.shape != shape && running.detail == Detail::Fine;
            let is_long = now - running.start > LIMIT;
            if is_long {
                self.hopeless = Some(running.shape);
                self.slow = Some(elements(session));
            }
            if is_old || is_long {
                self.running = None;
            }
        }
        let is_slow = self.slow == Some(elements(session));
        if !self.is_wanted || self.running.is_some() || is_slow || self.hopeless == Some(shape) {
            return;
        }
        let known = self.made.as_ref().filter(|made| made.shape == shape);
        let detail = match known.map(|made| made.detail) {
            None if is_drawn => Detail::Coarse,
            Some(Detail::Coarse) if rests && now - self.seen.1 >= STILL => Detail::Fine,
            _ => return,
        };
        let whole = session.scene();
        let Some((whole, soft)) = whole.and_then(|scene| Some((scene, soft_part(scene)?))) else {
            self.hopeless = Some(shape);
            return;
        };
        let job = ViewScene {
            scene: Arc::new(soft),
            looks: preview::looks(whole),
            detail,
        };
        self.running = Some(Running {
            ticket: self.tools.submit(job),
            shape,
            detail,
            start: now,
        });
    }

    /// Takes in the mesh that was being made.
    fn take(&mut self, result: Result<ViewMesh, String>, now: f64) {
        let Some(running) = self.running.take() else {
            return;
        };
        let Ok(mesh) = result else {
            self.hopeless = Some(running.shape);
            return;
        };
        if running.detail == Detail::Coarse {
            self.seconds = now - running.start;
        }
        self.count += 1;
        self.made = Some(Made {
            number: self.count,
            mesh,
            shape: running.shape,
            detail: running.detail,
            current: running.start,
        });
    }

    /// Returns the mesh to draw: that of the present scene or, while the user drags and meshes are
    /// quick, the one before.
    #[must_use]
    pub fn mesh(&self, session: &Session, now: f64) -> Option<&Made> {
        let follows = self.seconds <= QUICK && self.hopeless != Some(session.shape());
        self.made
            .as_ref()
            .filter(|made| made.shape == session.shape() || (follows && now - made.current <= LATE))
    }

    /// Returns the seconds until [`LiveMesh::tick`] begins a fine mesh; `None` if it will not.
    #[must_use]
    pub fn wait(&self, session: &Session, now: f64) -> Option<f64> {
        let made = self.made.as_ref().filter(|_| self.is_wanted)?;
        let is_next = made.shape == session.shape() && made.detail == Detail::Coarse;
        let is_possible = self.running.is_none() && self.hopeless != Some(made.shape);
        (is_next && is_possible).then(|| (self.seen.1 + STILL - now).max(0.05))
    }
}

fn elements(session: &Session) -> usize {
    session.compilation().scene.elements.len()
}

/// Returns a scene of the soft elements and everything that their surfaces depend on; `None` if
/// there are none, too many, or one that has no end.
fn soft_part(scene: &Scene) -> Option<Scene> {
    let soft: Vec<&Element> = scene.elements.iter().filter(|e| scene.is_soft(e)).collect();
    let mut shapes = soft.iter().map(|element| &element.shape);
    if !(1..=MOST).contains(&soft.len()) || shapes.any(|s| s.bounds(0.0).is_none()) {
        return None;
    }
    Some(Scene {
        elements: soft.into_iter().cloned().collect(),
        bodies: scene.bodies.clone(),
        contacts: scene.contacts.clone(),
        flesh: scene.flesh.clone(),
        finishes: scene.finishes.clone(),
        frames: scene.frames.clone(),
        settings: scene.settings,
        ..Scene::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, Instant};

    const BALLS: &str =
        "surface a, diffuse Red, blobbiness -2\nsphere a 1, 0 0 0\nsphere a 1, 1.5 0 0\n";

    /// Ticks at a moment of the app's clock until nothing is being made.
    fn settle(live: &mut LiveMesh, session: &Session, now: f64, rests: bool) {
        let deadline = Instant::now() + Duration::from_secs(120);
        loop {
            live.tick(session, now, true, rests);
            if live.running.is_none() {
                return;
            }
            assert!(Instant::now() < deadline);
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn mesh_is_made_once_the_user_drags_and_becomes_finer_afterwards() {
        let session = Session::of_text(BALLS);
        let mut live = LiveMesh::new(Tools::new(|| {}));
        settle(&mut live, &session, 0.0, true);
        assert!(live.mesh(&session, 0.0).is_none());
        live.want();
        settle(&mut live, &session, 1.0, false);
        let coarse = live.mesh(&session, 1.0).unwrap();
        assert_eq!((coarse.number, coarse.detail), (1, Detail::Coarse));
        assert!(coarse.mesh().triangles.len() > 100);
        // Not while a picture is traced, nor at once.
        settle(&mut live, &session, 9.0, false);
        assert_eq!(live.count, 1);
        assert!(live.wait(&session, 1.2).is_some());
        settle(&mut live, &session, 9.0, true);
        let fine = live.mesh(&session, 9.0).unwrap();
        assert_eq!((fine.number, fine.detail), (2, Detail::Fine));
        settle(&mut live, &session, 99.0, true);
        assert_eq!((live.count, live.wait(&session, 99.0)), (2, None));
        live.forget();
        assert!(live.mesh(&session, 99.0).is_none());
    }

    #[test]
    fn quick_mesh_stands_in_for_the_next_one_but_not_for_long() {
        let mut session = Session::of_text(BALLS);
        let mut live = LiveMesh::new(Tools::new(|| {}));
        live.want();
        settle(&mut live, &session, 1.0, false);
        let moved = BALLS.replace("1.5", "1.6");
        session
            .edit(&[rats::TextEdit::whole(0, moved)], 1.0)
            .unwrap();
        session.compile();
        assert!(live.seconds <= QUICK && live.mesh(&session, 1.1).is_some());
        assert!(live.mesh(&session, 1.1 + LATE).is_none());
        // One that takes long never does.
        live.seconds = 2.0 * QUICK;
        assert!(live.mesh(&session, 1.1).is_none());
        settle(&mut live, &session, 1.2, false);
        let followed = live.mesh(&session, 1.2).unwrap();
        assert_eq!((followed.number, followed.shape), (2, session.shape()));
    }

    #[test]
    fn scenes_without_a_finite_surface_are_left_to_the_draft() {
        for text in [
            "surface a, diffuse Red\nsphere a 1, 0 0 0\n",
            "surface a, diffuse Red, blobbiness -2, radius 0.3\nsphere a 1, 0 0 0\n\
                plane a, <0 -2 0>, <0 1 0>\n",
        ] {
            let session = Session::of_text(text);
            assert_eq!(session.errors(), 0);
            let mut live = LiveMesh::new(Tools::new(|| {}));
            live.want();
            settle(&mut live, &session, 1.0, true);
            assert!(live.mesh(&session, 1.0).is_none() && live.hopeless.is_some());
        }
    }
}
