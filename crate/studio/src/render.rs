//! The traced picture: the time at which it begins, and its way to the screen.
//!
//! A change is traced at once if the workers soon have a coarse picture of it; else after a short
//! pause, so that a large scene is not prepared anew at every key. The running picture is given up
//! at the change itself, which frees the workers for the next one.

use document::picture;
use egui::{ColorImage, TextureHandle, TextureOptions};
use pool::{Assembly, Change, Image, PictureJob, Pool, Progress};
use scene::{Camera, Scene};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use tracer::Pass;
use worker::Kind;

/// Seconds without a change before a scene is traced whose coarse picture takes longer than
/// [`QUICK`].
pub const DEBOUNCE: f64 = 0.15;
/// Seconds up to which a coarse picture is quick enough for changes to be traced at once.
pub const QUICK: f64 = 0.25;
/// Seconds without a change before a new size of the view is traced, as the split may be dragged.
pub const RESIZE_DEBOUNCE: f64 = 0.35;
/// Seconds in which the window finds its size before the first picture begins.
pub const START: f64 = 0.05;
/// Seconds in which a new picture fades in over the draft.
pub const FADE: f64 = 0.22;

/// State of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Nothing is to be drawn yet.
    Idle,
    /// Waiting for the text or the camera to come to rest.
    Waiting,
    /// Tiles are coming.
    Tracing,
    /// The picture is finished.
    Done,
    /// The user stopped it.
    Cancelled,
}

impl Phase {
    /// Returns the name in the page handle's status.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Idle => "idle",
            Self::Waiting => "waiting",
            Self::Tracing => "tracing",
            Self::Done => "done",
            Self::Cancelled => "cancelled",
        }
    }
}

/// Seconds from the start of the picture to its milestones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timings {
    /// The coarse picture is complete.
    pub coarse: Option<f64>,
    /// The picture is finished.
    pub done: Option<f64>,
}

/// Traces the present scene and keeps the picture.
pub struct Renderer {
    pool: Rc<RefCell<Pool>>,
    assembly: Assembly,
    texture: Option<TextureHandle>,
    phase: Phase,
    /// The picture wanted last: the session's generation and the size.
    wanted: Option<(u64, [u32; 2])>,
    /// Time at which it begins.
    due: f64,
    /// Number of the running picture. Sizes change too, so it is not the session's generation.
    number: u64,
    /// The session's generation of the running picture, and the time at which it began.
    running: (u64, f64),
    /// The session's generation of the picture on the screen.
    shown: Option<u64>,
    appeared: f64,
    progress: Progress,
    timings: Timings,
    /// Seconds that the workers took for the last coarse picture.
    coarse: f64,
}

impl Renderer {
    /// Makes a renderer without a picture.
    #[must_use]
    pub fn new(pool: Rc<RefCell<Pool>>) -> Self {
        Self {
            pool,
            assembly: Assembly::default(),
            texture: None,
            phase: Phase::Idle,
            wanted: None,
            due: 0.0,
            number: 0,
            running: (0, 0.0),
            shown: None,
            appeared: f64::NEG_INFINITY,
            progress: Progress::default(),
            timings: Timings::default(),
            coarse: 0.0,
        }
    }

    /// Sets generation and size of the picture that is wanted. If they differ from those of the
    /// running one, that is given up and a new one begins, after a pause unless scenes are quick.
    pub fn want(&mut self, generation: u64, size: [u32; 2], now: f64) {
        let Some((old_generation, old_size)) = self.wanted else {
            self.wanted = Some((generation, size));
            self.due = now + START;
            self.phase = Phase::Waiting;
            return;
        };
        if (old_generation, old_size) == (generation, size) {
            return;
        }
        self.wanted = Some((generation, size));
        if generation != old_generation {
            // A cancelled picture took at least this time.
            if self.phase == Phase::Tracing && self.timings.coarse.is_none() {
                self.coarse = self.coarse.max(now - self.running.1);
            }
            self.halt();
            self.phase = Phase::Waiting;
            self.due = now + if self.coarse <= QUICK { 0.0 } else { DEBOUNCE };
        } else if self.phase != Phase::Cancelled {
            self.phase = Phase::Waiting;
            // Nothing is on the screen yet: the window is only finding its size.
            let first = self.number == 0;
            self.due = now + if first { START } else { RESIZE_DEBOUNCE };
        }
    }

    /// Returns the seconds until [`Renderer::tick`] begins a picture; `None` if none waits.
    #[must_use]
    pub fn wait(&self, now: f64) -> Option<f64> {
        (self.phase == Phase::Waiting).then_some((self.due - now).max(0.0))
    }

    /// Begins the wanted picture of a scene when its time has come, seen by `camera` if it is not
    /// the scene's own, and takes in tiles. Returns whether something changed.
    pub fn tick(
        &mut self,
        ctx: &egui::Context,
        now: f64,
        scene: Option<&Arc<Scene>>,
        camera: Option<Camera>,
    ) -> bool {
        let mut changed = false;
        if self.phase == Phase::Waiting
            && now >= self.due
            && let Some((generation, size)) = self.wanted
            && let Some(scene) = scene
        {
            self.number += 1;
            self.running = (generation, now);
            self.timings = Timings::default();
            self.assembly.begin(self.number, size);
            self.pool.borrow_mut().start(PictureJob {
                scene,
                camera,
                size,
                generation: self.number,
                kind: Kind::Colours,
                small: false,
            });
            self.phase = Phase::Tracing;
            changed = true;
        }
        let tiles = self.pool.borrow_mut().poll();
        for tile in tiles {
            changed = true;
            let change = self
                .assembly
                .put(tile.generation, tile.tile, tile.pass, &tile.pixels);
            match change {
                Change::Nothing => {}
                Change::Whole => {
                    self.timings.coarse = Some(now - self.running.1);
                    self.shown = Some(self.running.0);
                    self.appeared = now;
                    self.upload(ctx);
                }
                Change::Tile(tile) => self.upload_tile(tile),
            }
        }
        let mut progress = self.pool.borrow().progress();
        if progress
            .generation
            .is_some_and(|number| number != self.number)
        {
            // The last picture of the workers was one of the lab.
            progress = Progress {
                workers: progress.workers,
                restarted: progress.restarted,
                ..self.progress.clone()
            };
        }
        if let Some(seconds) = progress.pass_seconds[0] {
            self.coarse = seconds;
        }
        changed |= progress != self.progress;
        self.progress = progress;
        if self.phase == Phase::Tracing
            && self.progress.finished
            && self.progress.generation == Some(self.number)
        {
            self.phase = if self.progress.error.is_some() {
                Phase::Cancelled
            } else {
                self.timings.done = Some(now - self.running.1);
                Phase::Done
            };
        }
        changed
    }

    /// Stops the running picture; its tiles stay.
    pub fn cancel(&mut self) {
        if matches!(self.phase, Phase::Tracing | Phase::Waiting) {
            self.halt();
            self.phase = Phase::Cancelled;
        }
    }

    /// Traces the wanted picture (again) now.
    pub fn again(&mut self, now: f64) {
        if self.wanted.is_some() {
            self.halt();
            self.phase = Phase::Waiting;
            self.due = now;
        }
    }

    /// Forgets the picture, when another work was opened.
    pub fn clear(&mut self) {
        self.halt();
        self.assembly.clear();
        self.texture = None;
        self.wanted = None;
        self.shown = None;
        self.phase = Phase::Idle;
    }

    /// Frees the workers, if this picture has them: the lab uses them too.
    fn halt(&self) {
        if self.phase == Phase::Tracing {
            self.pool.borrow_mut().cancel();
        }
    }

    /// Returns the state of the picture.
    #[must_use]
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Whether the picture on the screen may stand in for the wanted one: it has the same size, and
    /// the coarse picture is expected within `seconds` of work, which are not over yet.
    #[must_use]
    pub fn is_near(&self, seconds: f64, now: f64) -> bool {
        let coming = match self.phase {
            Phase::Waiting => true,
            Phase::Tracing => now - self.running.1 <= seconds,
            Phase::Idle | Phase::Done | Phase::Cancelled => false,
        };
        let size = self.image().map(|image| image.size);
        coming
            && self.coarse <= seconds
            && self.texture.is_some()
            && size == self.wanted.map(|(_, size)| size)
    }

    /// Returns the progress of the running picture.
    #[must_use]
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Returns the times of its milestones.
    #[must_use]
    pub fn timings(&self) -> Timings {
        self.timings
    }

    /// Returns the picture on the screen.
    #[must_use]
    pub fn image(&self) -> Option<&Image> {
        self.assembly.shown().map(|(_, image)| image)
    }

    /// Returns the texture of the picture on the screen, and the session's generation of it.
    #[must_use]
    pub fn texture(&self) -> Option<(&TextureHandle, u64)> {
        Some((self.texture.as_ref()?, self.shown?))
    }

    /// Whether the picture on the screen has a ray for every pixel.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        let progress = &self.progress;
        let is_shown = self.texture.is_some() && self.shown == Some(self.running.0);
        is_shown && progress.generation == Some(self.number) && progress.pass_seconds[1].is_some()
    }

    /// Returns the opacity of the picture over the draft, 0 … 1.
    #[must_use]
    pub fn opacity(&self, now: f64) -> f32 {
        ((now - self.appeared) / FADE).clamp(0.0, 1.0) as f32
    }

    fn upload(&mut self, ctx: &egui::Context) {
        let Some((_, image)) = self.assembly.shown() else {
            return;
        };
        let size = image.size.map(|side| side as usize);
        // Every pixel is opaque.
        let pixels = ColorImage::from_rgba_premultiplied(size, &image.rgba);
        match &mut self.texture {
            Some(texture) => texture.set(pixels, TextureOptions::LINEAR),
            None => {
                self.texture = Some(ctx.load_texture("picture", pixels, TextureOptions::LINEAR));
            }
        }
    }

    fn upload_tile(&mut self, tile: tracer::Tile) {
        let (Some(texture), Some((_, image))) = (&mut self.texture, self.assembly.shown()) else {
            return;
        };
        let size = [tile.width as usize, tile.height as usize];
        let pixels = ColorImage::from_rgba_premultiplied(size, &picture::cut(image, tile));
        texture.set_partial(
            [tile.x as usize, tile.y as usize],
            pixels,
            TextureOptions::LINEAR,
        );
    }
}

/// Returns the name of a pass, for display.
#[must_use]
pub fn pass_label(pass: Pass) -> &'static str {
    match pass {
        Pass::Coarse => "coarse",
        Pass::Full => "full",
        Pass::Smooth => "smooth",
    }
}
