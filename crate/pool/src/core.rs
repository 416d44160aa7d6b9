//! The manager of the tracing workers: scheduler, packed scene, finished tiles.

use crate::job::{PictureJob, TILE, TileDone};
use crate::progress::Progress;
use crate::run::Plan;
use crate::scheduler::{Command, Scheduler};
use crate::shared_samples::SharedSamples;
use crate::workers::{Manager, Message, Workers};
use tools::message::DIFFERENT_VERSIONS;
use tracer::{Known, Pass};
use worker::engine::KEPT;
use worker::{Answer, Kind, Request};

/// A pool without its workers.
pub struct Core<W> {
    pub scheduler: Scheduler,
    pub workers: W,
    count: usize,
    /// The packed request that begins the present picture.
    begin: Vec<u8>,
    done: Vec<TileDone>,
    pub(super) shared_samples: SharedSamples,
}

impl<W: Workers> Core<W> {
    pub fn new(count: usize, workers: W) -> Self {
        Self {
            scheduler: Scheduler::new(count),
            workers,
            count,
            begin: Vec::new(),
            done: Vec::new(),
            shared_samples: SharedSamples::default(),
        }
    }

    pub fn start(&mut self, job: PictureJob<'_>, now: f64) {
        self.done.clear();
        let tiles: usize = job
            .size
            .map(|side| side.div_ceil(TILE) as usize)
            .iter()
            .product();
        // The page keeps shared samples in memory, so larger pictures do not share them.
        let kept = tiles <= KEPT && job.kind == Kind::Colours;
        let shared = kept && !job.small && job.scene.settings.samples > 1 && self.count > 1;
        self.shared_samples.begin(job.size, shared);
        let plan = Plan {
            generation: job.generation,
            size: job.size,
            samples: job.scene.settings.samples,
            small: job.small,
            shared,
        };
        self.scheduler.start(plan, now);
        let request = Request::Begin {
            generation: self.scheduler.number(),
            scene: job.scene.clone(),
            camera: job.camera,
            size: job.size,
            kind: job.kind,
            shared,
        };
        match postcard::to_allocvec(&request) {
            Ok(bytes) => self.begin = bytes,
            Err(error) => self.scheduler.unavailable(&error.to_string(), now),
        }
        self.carry_out(now);
    }

    pub fn cancel(&mut self, now: f64) {
        self.scheduler.cancel(now);
        self.carry_out(now);
    }

    /// Takes a worker's answers. Returns whether the app should draw: a pass was completed or a
    /// worker failed.
    pub fn answers(&mut self, index: usize, answers: Vec<Answer>, now: f64) -> bool {
        let mut news = false;
        for answer in answers {
            news |= self.answer(index, answer, now);
        }
        self.carry_out(now);
        news
    }

    fn answer(&mut self, index: usize, answer: Answer, now: f64) -> bool {
        match answer {
            Answer::Started => self.scheduler.note_start(index, now),
            Answer::Noted { generation } => self.scheduler.note_picture(index, generation, now),
            Answer::Prepared { generation } => {
                self.scheduler.note_preparation(index, generation, now)
            }
            Answer::Traced {
                order,
                pixels,
                stats,
                seconds,
                known,
            } => {
                let complete = self.scheduler.complete_passes();
                let wanted = self.scheduler.take_tile(index, order, &stats, seconds, now);
                if order.pass == Pass::Smooth {
                    self.shared_samples.finish(index, order.tile);
                }
                if let (true, Some(known)) = (wanted, known) {
                    for (other, known) in self.shared_samples.receive(index, &order, known) {
                        self.send_samples(other, vec![known]);
                    }
                }
                if let (true, Some(generation)) = (wanted, self.scheduler.generation()) {
                    self.done.push(TileDone {
                        generation,
                        pass: order.pass,
                        tile: order.tile,
                        pixels,
                    });
                }
                return self.scheduler.complete_passes() > complete;
            }
            Answer::Failed(reason) => {
                self.scheduler.note_death(index, &reason, now);
                return true;
            }
        }
        false
    }

    /// Returns the tiles finished since the last call.
    pub fn take(&mut self) -> Vec<TileDone> {
        std::mem::take(&mut self.done)
    }

    pub fn progress(&self, now: f64) -> Progress {
        self.scheduler.progress(now)
    }

    /// Carries out the scheduler's commands. A worker that cannot be started leads to new commands,
    /// so this repeats until there are none; the scheduler gives up after some attempts.
    fn carry_out(&mut self, now: f64) {
        loop {
            let commands = self.scheduler.commands();
            if commands.is_empty() {
                break;
            }
            for command in commands {
                match command {
                    Command::Restart(index) => {
                        self.shared_samples.forget_worker(index);
                        if let Err(reason) = self.workers.restart(index) {
                            self.scheduler.note_death(index, &reason, now);
                        }
                    }
                    Command::End(index) => {
                        self.shared_samples.forget_worker(index);
                        self.workers.end(index);
                    }
                    Command::Begin(index) => self.workers.send(index, &self.begin),
                    Command::Trace(index, orders) => {
                        let smooth = orders.iter().filter(|order| order.pass == Pass::Smooth);
                        let known = smooth
                            .flat_map(|order| self.shared_samples.assign(index, order.tile))
                            .collect();
                        self.send_samples(index, known);
                        self.send(index, &Request::Trace(orders));
                    }
                    Command::Stop(index) => {
                        let generation = self.scheduler.number();
                        self.send(index, &Request::Stop { generation });
                    }
                }
            }
        }
        if self.scheduler.is_over() {
            self.shared_samples = SharedSamples::default();
        }
    }

    /// Sends a worker first samples that others have taken.
    fn send_samples(&mut self, index: usize, known: Vec<Known>) {
        if !known.is_empty() {
            let generation = self.scheduler.number();
            self.send(index, &Request::Learn { generation, known });
        }
    }

    fn send(&mut self, index: usize, request: &Request) {
        // Packing fails only when memory runs out; the worker then misses a message, hangs as far
        // as the scheduler can see, and is replaced, but for [`Request::Learn`]: then it takes
        // samples again.
        if let Ok(bytes) = postcard::to_allocvec(request) {
            self.workers.send(index, &bytes);
        }
    }
}

impl<W: Workers + 'static> Manager for Core<W> {
    type Workers = W;

    fn workers(&mut self) -> &mut W {
        &mut self.workers
    }

    fn note_program(&mut self, outcome: Result<(), String>, now: f64) {
        match outcome {
            Ok(()) => self.scheduler.launch(now),
            Err(reason) => {
                let reason = format!("{reason}. Check the connection and render again.");
                self.scheduler.unavailable(&reason, now);
            }
        }
        self.carry_out(now);
    }

    fn receive(&mut self, index: usize, message: Message, now: f64) -> bool {
        let answers = match message {
            Message::Bytes(bytes) => postcard::from_bytes(&bytes)
                .unwrap_or_else(|_| vec![Answer::Failed(DIFFERENT_VERSIONS.to_owned())]),
            Message::Failed(reason) => vec![Answer::Failed(reason)],
        };
        self.answers(index, answers, now)
    }

    fn tick(&mut self, now: f64) -> bool {
        self.scheduler.tick(now);
        self.carry_out(now);
        false
    }

    fn is_busy(&self) -> bool {
        self.scheduler.is_busy()
    }
}
