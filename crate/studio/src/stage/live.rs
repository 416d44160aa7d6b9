//! The numbers by which the card draws the model's true surface ([`cells::Packed`]), while the user
//! turns the model or drags a part of it.
//!
//! A tools worker makes them, apart from the page's thread: quickly while the text changes, and
//! with care once nothing changes and no picture is traced. Until those of the present scene are
//! there, the last ones stay. No worker is fetched before the pointer comes to the picture for the
//! first time, or something moves.

use cells::{Detail, Packed};
use document::session::Session;
use pool::{Ticket, Tools};
use scene::Scene;
use std::rc::Rc;
use std::sync::Arc;
use tools::PackScene;

/// Seconds without a change before they are made with care.
const STILL: f64 = 0.5;
/// Seconds of work after which they are given up.
const LIMIT: f64 = 30.0;
/// Most elements of a scene.
const MOST: usize = 200_000;

/// Numbers that are being made.
struct Running {
    ticket: Ticket<Packed>,
    scene: Arc<Scene>,
    shape: u64,
    detail: Detail,
    /// Time at which it was last seen to wait for its turn.
    start: f64,
}

/// Numbers that are there.
pub struct Made {
    /// A number that tells them from others.
    pub number: u64,
    /// The packed scene.
    pub packed: Packed,
    /// The scene.
    pub scene: Arc<Scene>,
    /// The names of the bodies that it has meshes of.
    pub meshed: Rc<[String]>,
    /// [`Session::shape`] of the scene.
    shape: u64,
    detail: Detail,
}

/// The packed scene of the present work.
pub struct LiveCells {
    tools: Tools,
    is_wanted: bool,
    running: Option<Running>,
    made: Option<Made>,
    count: u64,
    /// [`Session::shape`] of a scene that cannot be packed, or not with care.
    hopeless: Option<u64>,
    /// Number of elements of a scene that took too long: another try waits until it changes.
    slow: Option<usize>,
    /// [`Session::shape`] of the scene seen last, and the time at which it changed.
    seen: (u64, f64),
}

impl LiveCells {
    /// Makes nothing until it is wanted.
    #[must_use]
    pub fn new(tools: Tools) -> Self {
        Self {
            tools,
            is_wanted: false,
            running: None,
            made: None,
            count: 0,
            hopeless: None,
            slow: None,
            seen: (0, 0.0),
        }
    }

    /// Packs scenes from now on, as the user turns or drags, or may do so.
    pub fn want(&mut self) {
        self.is_wanted = true;
    }

    /// Forgets everything, when another work was opened.
    pub fn forget(&mut self) {
        self.running = None;
        self.is_wanted = false;
        self.made = None;
        self.hopeless = None;
        self.slow = None;
    }

    /// Gives up what is being made, and is made later, so that the worker is free for other jobs.
    pub fn give_way(&mut self) {
        self.running = None;
    }

    /// Takes in what the worker made, and begins the next. `is_drawn`: a draft is needed on the
    /// screen; `rests`: no picture is being traced.
    pub fn tick(&mut self, session: &Session, now: f64, is_drawn: bool, rests: bool) {
        if let Some(running) = &mut self.running {
            if let Some(result) = running.ticket.result() {
                self.take(result);
            } else if running.ticket.fraction().is_none() {
                running.start = now;
            }
        }
        let shape = session.shape();
        if self.seen.0 != shape {
            self.seen = (shape, now);
        }
        if let Some(running) = &self.running {
            let is_old = running.shape != shape && running.detail == Detail::Fine;
            let is_long = now - running.start > LIMIT;
            if is_long {
                self.hopeless = Some(running.shape);
                let is_quick = running.detail == Detail::Quick;
                self.slow = is_quick.then_some(running.scene.elements.len());
            }
            if is_old || is_long {
                self.running = None;
            }
        }
        if !self.is_wanted || self.running.is_some() || self.is_hopeless(session) {
            return;
        }
        let known = self.made.as_ref().filter(|made| made.shape == shape);
        let is_still = rests && now - self.seen.1 >= STILL;
        let detail = match known.map(|made| made.detail) {
            None if is_drawn || is_still => Detail::Quick,
            Some(Detail::Quick) if is_still => Detail::Fine,
            _ => return,
        };
        let Some(scene) = session.scene().filter(|scene| scene.elements.len() <= MOST) else {
            self.hopeless = Some(shape);
            return;
        };
        let job = PackScene {
            scene: scene.clone(),
            detail,
        };
        self.running = Some(Running {
            scene: job.scene.clone(),
            ticket: self.tools.submit(job),
            shape,
            detail,
            start: now,
        });
    }

    /// Takes in what was being made.
    fn take(&mut self, result: Result<Packed, String>) {
        let Some(running) = self.running.take() else {
            return;
        };
        let Ok(packed) = result else {
            self.hopeless = Some(running.shape);
            return;
        };
        // More care would change nothing.
        let detail = if packed.is_cut {
            running.detail
        } else {
            Detail::Fine
        };
        self.count += 1;
        let meshed = packed.meshed.iter().map(|body| {
            let body = running.scene.bodies.get(*body as usize);
            body.map(|body| body.name.clone()).unwrap_or_default()
        });
        self.made = Some(Made {
            number: self.count,
            meshed: meshed.collect(),
            packed,
            scene: running.scene,
            shape: running.shape,
            detail,
        });
    }

    /// Returns the packed scene of a shape or, if `or_before`, while it is being packed the one
    /// before.
    #[must_use]
    pub fn latest(&self, shape: u64, or_before: bool) -> Option<&Made> {
        let made = self.made.as_ref()?;
        let is_coming = or_before && self.running.is_some();
        (made.shape == shape || is_coming).then_some(made)
    }

    /// Whether the present scene is not packed, as it took too long.
    #[must_use]
    pub fn is_hopeless(&self, session: &Session) -> bool {
        self.hopeless == Some(session.shape()) || self.slow == Some(elements(session))
    }

    /// Returns the seconds until [`LiveCells::tick`] begins with care; `None` if it will not.
    #[must_use]
    pub fn wait(&self, session: &Session, now: f64) -> Option<f64> {
        let shape = session.shape();
        let made = self.made.as_ref().filter(|made| made.shape == shape);
        let is_fine = made.is_some_and(|made| made.detail != Detail::Quick);
        let is_possible = self.running.is_none() && !self.is_hopeless(session);
        (self.is_wanted && !is_fine && is_possible).then(|| (self.seen.1 + STILL - now).max(0.05))
    }
}

fn elements(session: &Session) -> usize {
    session.compilation().scene.elements.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, Instant};

    const BALLS: &str =
        "surface a, diffuse Red, blobbiness -2\nsphere a 1, 0 0 0\nsphere a 1, 1.5 0 0\n";

    /// Ticks at a moment of the app's clock until nothing is being made.
    fn settle(live: &mut LiveCells, session: &Session, now: f64, rests: bool) {
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
    fn cells_are_made_once_the_user_drags() {
        let session = Session::of_text(BALLS);
        let mut live = LiveCells::new(Tools::new(|| {}));
        settle(&mut live, &session, 0.0, true);
        assert!(live.latest(session.shape(), true).is_none());
        live.want();
        settle(&mut live, &session, 1.0, false);
        let made = live.latest(session.shape(), true).unwrap();
        // It is so little that it was made with care at once.
        assert_eq!((made.number, made.detail), (1, Detail::Fine));
        assert!(made.packed.leaves > 50);
        settle(&mut live, &session, 99.0, true);
        assert_eq!((live.count, live.wait(&session, 99.0)), (1, None));
        live.forget();
        assert!(live.latest(session.shape(), true).is_none());
    }

    #[test]
    fn many_elements_are_meshed_and_once_more_with_care() {
        let mut text = String::from("surface a, diffuse Red, blobbiness -2\n");
        for i in 0..300 {
            text += &format!("sphere a 1, {} {} 0\n", 3 * (i % 20), 3 * (i / 20));
        }
        let session = Session::of_text(&text);
        let mut live = LiveCells::new(Tools::new(|| {}));
        live.want();
        settle(&mut live, &session, 1.0, false);
        let quick = live.latest(session.shape(), true).unwrap();
        assert_eq!((quick.number, quick.detail), (1, Detail::Quick));
        assert_eq!(quick.packed.meshed.len(), 1);
        let size = quick.packed.data.len();
        // Not while a picture is traced.
        settle(&mut live, &session, 9.0, false);
        assert_eq!(live.count, 1);
        settle(&mut live, &session, 9.0, true);
        let fine = live.latest(session.shape(), true).unwrap();
        assert_eq!((fine.number, fine.detail), (2, Detail::Fine));
        assert!(fine.packed.data.len() > 2 * size);
    }

    #[test]
    fn the_last_ones_stay_until_the_next_are_there() {
        let mut session = Session::of_text(BALLS);
        let mut live = LiveCells::new(Tools::new(|| {}));
        live.want();
        settle(&mut live, &session, 1.0, false);
        let moved = BALLS.replace("1.5", "1.6");
        session
            .edit(&[rats::TextEdit::whole(0, moved)], 1.0)
            .unwrap();
        session.compile();
        live.tick(&session, 1.1, true, false);
        assert_eq!(
            live.latest(session.shape(), true).map(|made| made.number),
            Some(1)
        );
        settle(&mut live, &session, 1.2, false);
        let followed = live.latest(session.shape(), true).unwrap();
        assert_eq!((followed.number, followed.shape), (2, session.shape()));
    }
}
