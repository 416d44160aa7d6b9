//! A worker's desk: takes requests at any time, does one step of work when asked.

use crate::{Answer, Order, Request};
use scene::Scene;
use std::collections::VecDeque;
use tracer::{Picture, Stats};

/// The picture a worker is busy with, and the tiles it still has to trace.
#[derive(Default)]
pub struct Engine {
    generation: u64,
    /// Set until the scene has been prepared.
    wanted: Option<(Box<Scene>, [u32; 2])>,
    picture: Option<Picture>,
    queue: VecDeque<Order>,
}

/// What a step came to.
#[derive(Debug, PartialEq)]
pub enum Step {
    /// There was nothing to do.
    Idle,
    /// Work was done and given up, or was for an older picture: nothing to tell.
    Dropped,
    /// Something to send.
    Answer(Answer),
}

impl Engine {
    /// Takes a request. This is quick: the work is done by [`Engine::step`].
    pub fn accept(&mut self, request: Request) {
        match request {
            Request::Begin {
                generation,
                scene,
                size,
            } => {
                self.forget();
                self.generation = generation;
                self.wanted = Some((scene, size));
            }
            Request::Trace(order) => {
                if order.generation == self.generation {
                    self.queue.push_back(order);
                }
            }
            Request::Stop => self.forget(),
        }
    }

    /// Whether [`Engine::step`] would find nothing to do.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        self.wanted.is_none() && self.queue.is_empty()
    }

    /// Prepares the picture if that was not done yet, else traces the next tile.
    ///
    /// `stop` is asked while tracing; when it says true the tile is given up. `clock` tells seconds
    /// since some fixed moment.
    pub fn step(&mut self, stop: &dyn Fn() -> bool, clock: &dyn Fn() -> f64) -> Step {
        if let Some((scene, size)) = self.wanted.take() {
            self.picture = Some(Picture::new(&scene, size));
            return Step::Answer(Answer::Prepared {
                generation: self.generation,
            });
        }
        let (Some(picture), Some(order)) = (&self.picture, self.queue.pop_front()) else {
            // Tiles without a picture cannot come in (`accept` compares generations).
            return Step::Idle;
        };
        let begun = clock();
        let mut stats = Stats::default();
        match picture.trace(order.tile, order.pass, stop, &mut stats) {
            Some(pixels) => Step::Answer(Answer::Traced {
                order,
                pixels,
                stats,
                seconds: clock() - begun,
            }),
            None => Step::Dropped,
        }
    }

    fn forget(&mut self) {
        self.wanted = None;
        self.picture = None;
        self.queue.clear();
    }
}
