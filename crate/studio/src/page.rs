//! State that all panels share: the open work, the traced picture, settings, and what lies over
//! the page.

use crate::render::{Phase, Renderer};
use crate::screen;
use crate::scripts::report::Shared;
use crate::scripts::request::Requests;
use crate::settings::Settings;
use crate::wish::{Dialog, Notice, Setting, Wish, Wishes};
use browser::Backend;
use browser::voice::Acts;
use document::mesh_export::Film;
use document::picture::Image;
use document::reading::MeshReading;
use document::size;
use document::storage::Shelf;
use document::work::Work;
use egui::Context;
use lab::Lesson;
use pool::Pool;
use std::cell::RefCell;
use std::rc::{Rc, Weak};

/// The part that a narrow page shows below the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    /// The editor.
    #[default]
    Text,
    /// The sliders.
    Sliders,
    /// The problems.
    Problems,
    /// Fitting a mesh.
    Fit,
}

/// Parts of an app that outlive it when the window must be started anew.
#[derive(Clone)]
pub struct Parts {
    /// Storage.
    pub shelf: Rc<RefCell<Shelf>>,
    /// Wishes of scripts.
    pub requests: Requests,
    /// Events of the elements for assistive technology.
    pub acts: Acts,
    /// State that scripts can read.
    pub outbox: Shared,
    /// The workers of the app that runs, for tests that end one.
    pub pool: Rc<RefCell<Weak<RefCell<Pool>>>>,
}

impl Parts {
    /// Parts on the browser's storage (natively: in memory).
    #[must_use]
    pub fn new() -> Self {
        let shelf = Shelf::new(browser::store(), browser::random_word());
        Self {
            shelf: Rc::new(RefCell::new(shelf)),
            requests: Requests::default(),
            acts: Acts::default(),
            outbox: Shared::default(),
            pool: Rc::default(),
        }
    }
}

impl Default for Parts {
    fn default() -> Self {
        Self::new()
    }
}

/// The window that the page is drawn in.
pub struct Screen {
    /// Backend that draws it.
    pub backend: Backend,
    /// Whether there is a draft on the window's device.
    pub has_draft: bool,
    /// Why the device does not draw it. The stage keeps it up to date.
    pub refusal: Option<String>,
    /// Seconds that new tiles wait to be shown; above 0 where the processor that traces them draws
    /// the page, too.
    pub rest: f32,
    /// Whether fingers are likely; `None` before the first frame.
    pub touch: Option<bool>,
    /// Whether the user's system asks for more contrast, and for less motion.
    pub asked: [bool; 2],
    /// The picture's place in device pixels at the last frame.
    pub place: [f32; 2],
    /// Width that text and picture shared at the last frame, points.
    pub width: f32,
    /// The size of the picture that a film or a test asks for.
    pub forced: Option<[u32; 2]>,
}

/// Asks egui for one more frame. The delay matters: a repaint without one is drawn twice.
pub(crate) fn repaint_once(ctx: &Context) {
    ctx.request_repaint_after_secs(1e-3);
}

/// A picture that the card is to draw for a film.
pub struct Shot {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// The picture, or why there is none, once it is there.
    pub image: Option<Result<Image, String>>,
}

/// A moment on the app's clock.
pub struct Moment<'a> {
    /// The window.
    pub ctx: &'a Context,
    /// Seconds.
    pub now: f64,
}

/// The state that all panels share.
pub struct Page {
    /// The open work.
    pub work: Work,
    /// Meshes on their way into the work.
    pub reading: MeshReading,
    /// Number of the work whose whole model is to be brought into view once it is compiled.
    pub to_frame: Option<u64>,
    /// The traced picture.
    pub renderer: Renderer,
    /// [`document::session::Session::shape`] of the scene whose draft is on the screen.
    pub drafted: Option<u64>,
    /// A frame of a film that the card draws; meanwhile nothing is traced.
    pub shot: Option<Shot>,
    /// The user's choices.
    pub settings: Settings,
    /// Storage, requests and reports.
    pub parts: Parts,
    /// The window.
    pub screen: Screen,
    /// Whether the lab is open, which hides the work. The app keeps it up to date.
    pub is_lab_open: bool,
    /// Whether measured files are being read. The panel of fits keeps it up to date.
    pub is_measuring: bool,
    /// The length of the film. Its panel keeps it up to date.
    pub film: Film,
    /// The window over the page.
    pub dialog: Option<Dialog>,
    /// The part that a narrow page shows.
    pub tab: Tab,
    /// Whether the picture is not begun, as it may take hours.
    pub is_refused: bool,
    /// The step of the first shape, and the number of its work.
    pub first: Option<(u64, usize)>,
    /// The message across the top of the picture.
    pub notice: Option<Notice>,
    /// Wishes of panels to other panels, which are carried out next.
    pub wishes: Wishes,
}

impl Page {
    /// Adds a wish that is carried out next.
    pub fn wish(&mut self, wish: impl Into<Wish>) {
        self.wishes.push(wish);
    }

    /// Says that something was done.
    pub fn tell(&mut self, text: impl Into<String>, now: f64) {
        self.notice = Some(Notice::success(text, now));
    }

    /// Says that something went wrong.
    pub fn warn(&mut self, text: impl Into<String>) {
        self.notice = Some(Notice::trouble(text));
    }

    /// Shows a notice if something was refused. Returns the result if it was not.
    pub fn accept<T>(&mut self, result: Result<T, impl ToString>) -> Option<T> {
        match result {
            Ok(done) => Some(done),
            Err(refused) => {
                self.warn(refused.to_string());
                None
            }
        }
    }

    /// Makes a new entry in the browser's history if the lab is left, so that the way back leads to
    /// the lesson.
    pub fn leave_lesson(&self) {
        if self.is_lab_open {
            browser::push_hash("");
        }
    }

    /// Puts a changed work on the shelf, has the meshes that it names read, and compiles it.
    pub fn settle(&mut self, now: f64) {
        // The work in a link is not the one on the screen any more.
        if self.work.settle(now) && Lesson::of_hash(&browser::hash()).is_none() {
            browser::set_hash("");
        }
        if self.reading.tick(&self.work.session) {
            self.work.session.compile();
        }
    }

    /// Whether a file is being read, which other jobs make way for.
    #[must_use]
    pub fn is_reading(&self) -> bool {
        self.is_measuring || self.reading.current().is_some()
    }

    /// Changes a setting.
    pub fn set(&mut self, setting: Setting, ctx: &Context) {
        match setting {
            Setting::Theme(theme) => {
                self.settings.theme = theme;
                ctx.set_theme(theme);
            }
            Setting::Show(show) => self.settings.show = show,
            Setting::Size(size) => {
                self.settings.size = size;
                self.screen.forced = None;
            }
            Setting::Hints(hints) => self.settings.hints = hints,
        }
    }

    /// Whether the picture of the present scene and camera is finished.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.renderer.phase() == Phase::Done && self.is_fresh()
    }

    /// Whether the picture on the screen is of the present scene and camera.
    #[must_use]
    pub fn is_fresh(&self) -> bool {
        let shown = self.renderer.texture();
        shown.is_some_and(|(_, generation)| generation == self.work.session.generation())
    }

    /// Whether the picture will not change by itself.
    #[must_use]
    pub fn rests(&self) -> bool {
        let session = &self.work.session;
        if session.is_enabled() && !session.is_compiled() {
            return false;
        }
        match self.renderer.phase() {
            Phase::Done | Phase::Cancelled => true,
            Phase::Idle => !session.is_enabled(),
            Phase::Waiting | Phase::Tracing => false,
        }
    }

    /// Whether the lab has the workers: a picture that runs when it is opened is finished first.
    #[must_use]
    pub fn lends_workers(&self) -> bool {
        self.is_lab_open && self.renderer.phase() != Phase::Tracing
    }

    /// Whether the processor that draws the window is tracing a picture, too, so that frames cost
    /// the picture time.
    #[must_use]
    pub fn is_short_of_time(&self) -> bool {
        self.screen.rest > 0.0 && self.renderer.phase() == Phase::Tracing
    }

    /// Shows a frame of the film.
    pub fn go_to_frame(&mut self, frame: u32) {
        self.work.session.set_film_frame(frame);
        self.work.session.compile();
    }

    /// Returns the size of the traced picture, pixels.
    #[must_use]
    pub fn size(&self, ctx: &Context) -> [u32; 2] {
        if let Some(size) = self.screen.forced {
            return size;
        }
        let longest = ctx.input(|input| input.max_texture_side) as u32;
        let frame = self.work.session.frame();
        size::pixels(self.settings.size, frame, self.screen.place, longest)
    }
}

/// Returns height by width of a picture to draw on: on an upright page it fills the space between
/// the bars.
#[must_use]
pub fn ratio(ctx: &Context) -> f64 {
    let size = ctx.content_rect().size();
    if size.y <= size.x {
        return 0.75;
    }
    let bars = if screen::is_small(ctx) { 150.0 } else { 300.0 };
    f64::from((size.y - bars).max(1.0) / size.x.max(1.0))
}
