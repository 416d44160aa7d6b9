//! The app: ties the user's work, the tracer and the draft to the widgets.
//!
//! [`App::tick`] does the work of timers and messages and runs even while the tab is hidden;
//! [`App::show`] (in `draw`) draws one frame. Widgets only list [`Command`]s, which are carried out
//! afterwards.

use crate::apart::Apart;
use crate::asset_view::AssetView;
use crate::command::Command;
use crate::draft::Draft;
use crate::editor::Editor;
use crate::film::Player;
use crate::fitting::Fitting;
use crate::gallery::Gallery;
use crate::hands::Hands;
use crate::help::Help;
use crate::keyboard::Keyboard;
use crate::live::LiveMesh;
use crate::mesh_export::MeshExport;
use crate::notice::Notice;
use crate::pencil::Pencil;
use crate::reading::MeshReading;
use crate::recording::{Saving, VideoFormat};
use crate::render::{Phase, Renderer};
use crate::report::Shared;
use crate::request::{Answer, Request, Requests};
use crate::settings::Settings;
use crate::sliders::Sliders;
use crate::storage::Shelf;
use crate::tray::Tray;
use crate::work::{Origin, Work};
use crate::{Backend, fonts, platform, size};
use egui::Context;
use lab::{Lab, Lesson};
use modeling::Sculpting;
use pool::{Pool, Tools};
use std::cell::RefCell;
use std::rc::{Rc, Weak};

/// Seconds of running without trouble after which a start counts as a good one.
const HEALTHY: f64 = 4.0;

/// A window over the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialog {
    /// Examples and own works.
    Gallery,
    /// The help.
    Help,
    /// A result of the text's jobs on pictures.
    Result,
    /// Choices of how to begin a sculpture.
    Sculpt,
    /// The model as a mesh.
    Mesh,
}

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

/// The stand-in for a traced picture that is not there yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StandIn {
    /// The elements before they melt together.
    Draft,
    /// A mesh of their surface.
    Mesh,
}

impl StandIn {
    /// The name, for the status line and for scripts.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Draft => "draft",
            Self::Mesh => "mesh",
        }
    }
}

/// Parts of an app that outlive it when the window must be started anew.
#[derive(Clone)]
pub struct Parts {
    /// Storage.
    pub shelf: Rc<RefCell<Shelf>>,
    /// Wishes of scripts.
    pub requests: Requests,
    /// State that scripts can read.
    pub outbox: Shared,
    /// The workers of the app that runs, for tests that end one.
    pub pool: Rc<RefCell<Weak<RefCell<Pool>>>>,
}

impl Parts {
    /// Parts on the browser's storage (natively: in memory).
    #[must_use]
    pub fn new() -> Self {
        let shelf = Shelf::new(platform::store(), platform::random_word());
        Self {
            shelf: Rc::new(RefCell::new(shelf)),
            requests: Requests::default(),
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

/// The whole page.
pub struct App {
    pub(crate) work: Work,
    pub(crate) renderer: Renderer,
    pub(crate) draft: Option<Draft>,
    /// The true surface for the draft.
    pub(crate) live: LiveMesh,
    /// The stand-in for the traced picture on the screen.
    pub(crate) stand_in: Option<StandIn>,
    /// The draft where there is none on the window's device.
    pub(crate) apart: Apart,
    pub(crate) backend: Backend,
    pub(crate) settings: Settings,
    pub(crate) editor: Editor,
    pub(crate) asset_view: AssetView,
    pub(crate) sliders: Sliders,
    pub(crate) hands: Hands,
    pub(crate) pencil: Pencil,
    pub(crate) gallery: Gallery,
    pub(crate) help: Help,
    pub(crate) player: Player,
    pub(crate) saving: Option<Saving>,
    /// The browser's encoders of videos, once they were asked for.
    pub(crate) videos: Option<Vec<VideoFormat>>,
    pub(crate) tray: Tray,
    pub(crate) lab: Lab,
    /// The sculpture that is worked on, in place of the editor.
    pub(crate) sculpting: Option<Box<Sculpting>>,
    /// Large meshes on their way into the work.
    pub(crate) reading: MeshReading,
    /// Fitting a mesh to measured points.
    pub(crate) fitting: Fitting,
    pub(crate) mesh_export: MeshExport,
    pub(crate) dialog: Option<Dialog>,
    pub(crate) notice: Option<Notice>,
    pub(crate) tab: Tab,
    /// The picture's place in device pixels at the last frame.
    pub(crate) place: [f32; 2],
    pub(crate) forced_size: Option<[u32; 2]>,
    pub(crate) parts: Parts,
    saved_settings: Settings,
    /// Seconds that new tiles wait to be shown, see [`REST`].
    pub(crate) rest: f32,
    /// The text, and whether it was compiled, that the diagnostics in the outbox are about.
    pub(crate) reported: Option<(u64, bool)>,
    started: Option<f64>,
    healthy: bool,
    /// The name in the title of the browser's tab.
    tab_title: String,
    /// Scripts that wait for the picture to be finished.
    pub(crate) finished: Vec<Answer>,
    /// Tests that wait until no widget moves any more.
    pub(crate) still: Vec<Box<dyn FnOnce()>>,
    /// The number of frames since a widget moved.
    pub(crate) same: u32,
    pub(crate) touch: Option<bool>,
}

/// Seconds that tiles wait to be shown where the processor that traces them draws the page, too:
/// each frame keeps the workers waiting.
const REST: f32 = 0.4;

/// Frames without a move after which widgets are at rest: a menu that opens grows in the first.
const STILL: u32 = 3;

/// Asks egui for one more frame. The delay matters: a repaint without one is drawn twice.
pub(crate) fn repaint_once(ctx: &Context) {
    ctx.request_repaint_after_secs(1e-3);
}

fn is_drawn_by_processor(backend: Backend, state: Option<&egui_wgpu::RenderState>) -> bool {
    backend == Backend::None
        || state.is_some_and(|state| {
            let info = state.adapter.get_info();
            info.device_type == egui_wgpu::wgpu::DeviceType::Cpu
                || crate::backend::is_processor(&info.name)
        })
}

impl App {
    /// Starts the app. `render_state` is there when there is a GPU.
    #[must_use]
    pub fn new(
        ctx: &Context,
        render_state: Option<egui_wgpu::RenderState>,
        backend: Backend,
        parts: Parts,
    ) -> Self {
        let is_calm = !platform::has_stopped_before();
        // Until the start has gone well, a stop counts as a bad start.
        platform::set_stopped(true);
        let hash = platform::hash();
        let lesson = Lesson::of_hash(&hash);
        // A link to a lesson or to an example carries no work.
        let to_example = crate::examples::of_hash(&hash).is_some();
        let carried = if lesson.is_some() || to_example {
            ""
        } else {
            &hash
        };
        let (work, trouble) = Work::start(parts.shelf.clone(), carried, is_calm);
        parts.requests.attach(ctx);
        if to_example {
            parts.requests.ask(Request::HashChanged);
        }
        ctx.set_fonts(fonts::definitions());
        ctx.add_plugin(Keyboard::default());
        let settings: Settings = parts.shelf.borrow().settings();
        ctx.set_theme(settings.theme);
        let rest = if is_drawn_by_processor(backend, render_state.as_ref()) {
            REST
        } else {
            0.0
        };
        let repaint = ctx.clone();
        let pool = Pool::new(move || repaint_once(&repaint));
        let pool = Rc::new(RefCell::new(pool));
        parts.pool.replace(Rc::downgrade(&pool));
        let repaint = ctx.clone();
        let tools = Tools::new(move || repaint_once(&repaint));
        let mut app = Self {
            reading: MeshReading::new(tools.clone()),
            fitting: Fitting::new(tools.clone()),
            mesh_export: MeshExport::new(tools.clone()),
            live: LiveMesh::new(tools),
            stand_in: None,
            lab: Lab::new(pool.clone(), lesson),
            renderer: Renderer::new(pool),
            draft: render_state
                .filter(|_| backend != Backend::None)
                .map(Draft::new),
            apart: Apart::default(),
            backend,
            rest,
            editor: Editor::default(),
            asset_view: AssetView::default(),
            sliders: Sliders::default(),
            hands: Hands::default(),
            pencil: Pencil::default(),
            gallery: Gallery::default(),
            help: Help::default(),
            player: Player::default(),
            saving: None,
            videos: None,
            tray: Tray::default(),
            sculpting: None,
            dialog: None,
            notice: None,
            tab: Tab::Text,
            place: [640.0, 480.0],
            forced_size: None,
            saved_settings: settings.clone(),
            settings,
            reported: None,
            started: None,
            healthy: false,
            tab_title: String::new(),
            finished: Vec::new(),
            still: Vec::new(),
            same: 0,
            touch: None,
            work,
            parts,
        };
        app.greet(trouble, platform::now(ctx));
        app
    }

    /// Says at the start what the user should know.
    fn greet(&mut self, trouble: Option<String>, now: f64) {
        if !self.work.session.is_enabled() {
            let text = "Sinew stopped unexpectedly last time. Your text is here and safe; \
                nothing is drawn until you say so.";
            self.notice = Some(Notice::trouble(text).with_button("Draw", Command::Enable));
        } else if let Some(trouble) = trouble {
            let text = format!("{trouble} You see your own work instead.");
            self.notice = Some(Notice::trouble(text));
        } else if self.work.origin == Origin::Link {
            self.welcome_link();
        } else if !platform::has_storage() {
            let text = "This browser stores nothing for this page, so your work lasts until you \
                close it. Share makes a link that keeps it.";
            self.notice = Some(Notice::trouble(text));
        } else if self.backend == Backend::None {
            let text = "No graphics card here: few drafts or none, but everything else works.";
            self.notice = Some(Notice::success(text, now));
        }
    }

    pub(crate) fn welcome_link(&mut self) {
        let notice = Notice {
            text: String::from("You are looking at a shared link. Your own work is safe."),
            bad: false,
            action: None,
            until: None,
        };
        self.notice = Some(match self.work.before() {
            Some(_) => notice.with_button("Back to my work", Command::GoBack),
            None => Notice {
                text: String::from(
                    "You are looking at a shared link. Change it as you like: it becomes yours.",
                ),
                ..notice
            },
        });
    }

    /// Does the work of timers and messages. Call it before each frame, and also while the tab is
    /// hidden.
    pub fn tick(&mut self, ctx: &Context) {
        let now = platform::now(ctx);
        let started = *self.started.get_or_insert(now);
        self.catch_drops(ctx);
        let mut answers = Vec::new();
        for request in self.parts.requests.take() {
            self.serve(ctx, request, now, &mut answers);
        }
        if let Some(trouble) = self.work.tick(now) {
            self.notice = Some(Notice::trouble(trouble));
        }
        if self.mesh_export.tick() {
            ctx.request_repaint();
        }
        if self.dialog != Some(Dialog::Mesh) {
            self.mesh_export.stop();
        }
        if self.reading.tick(&self.work.session) {
            self.work.session.compile();
        }
        if self.fitting.tick(&mut self.work.session, now) {
            self.work.session.compile();
        }
        let reads = self.reading.current().is_some() || self.fitting.is_reading();
        if reads {
            self.live.give_way();
        }
        let is_tracing = matches!(self.renderer.phase(), Phase::Waiting | Phase::Tracing);
        let rests = !is_tracing && !reads;
        let is_drawn = self.draft.is_some() && self.stand_in.is_some();
        self.live.tick(&self.work.session, now, is_drawn, rests);
        if self.settings != self.saved_settings {
            self.saved_settings = self.settings.clone();
            self.parts.shelf.borrow_mut().set_settings(&self.settings);
        }
        let title = self.lab.title().unwrap_or(&self.work.name);
        if self.tab_title != title {
            self.tab_title = title.to_owned();
            platform::set_title(&self.tab_title);
        }
        self.screen(ctx, now);
        self.trace(ctx, now);
        if self.work.session.is_enabled() && !self.healthy && now - started > HEALTHY {
            self.healthy = true;
            platform::set_stopped(false);
        }
        if !self.lab.is_open() {
            let finished = self.is_finished().then(|| self.renderer.image()).flatten();
            let session = &self.work.session;
            let picture = finished.map(|image| (session.generation(), image));
            self.tray.tick(ctx, session, picture, now);
        }
        if let Some(notice) = &self.notice
            && notice.until.is_some_and(|until| now > until)
        {
            self.notice = None;
        }
        self.report(ctx);
        if self.same >= STILL {
            answers.append(&mut self.still);
        } else if !self.still.is_empty() {
            repaint_once(ctx);
        }
        for answer in answers {
            answer();
        }
        self.answer_finished();
        // While frames are expensive, writing waits for the next one, which comes soon.
        let mut waits = vec![self.work.wait(now).filter(|_| !self.is_short_of_time())];
        if !self.lab.is_open() {
            waits.push(self.renderer.wait(now));
        }
        waits.push(self.player.wait(now));
        waits.push(self.live.wait(&self.work.session, now).filter(|_| rests));
        waits.push(self.fitting.wait(now));
        // A frame that was finished just now is taken into the film at the next tick.
        waits.push((self.saving.is_some() && self.is_finished()).then_some(0.0));
        waits.push(self.tray.wait(now).filter(|_| !self.lab.is_open()));
        waits.push(match &self.notice {
            Some(notice) => notice.until.map(|until| until - now),
            None => None,
        });
        if !self.healthy && self.work.session.is_enabled() {
            waits.push(Some(started + HEALTHY - now));
        }
        // The progress bar and the remaining time move even while no tile comes.
        waits.push(
            (self.renderer.phase() == Phase::Tracing).then_some(f64::from(self.rest).max(0.25)),
        );
        if let Some(wait) = waits
            .into_iter()
            .flatten()
            .filter(|wait| wait.is_finite())
            .min_by(f64::total_cmp)
        {
            ctx.request_repaint_after_secs(wait.max(0.0) as f32 + 0.002);
        }
    }

    /// Begins the picture that is wanted, if its time has come, and takes in the tiles that workers
    /// have traced.
    pub(crate) fn trace(&mut self, ctx: &Context, now: f64) {
        let size = self.size(ctx);
        let session = &self.work.session;
        if !session.is_enabled() {
            return;
        }
        self.renderer.want(session.generation(), size, now);
        // No new picture begins while the lab is open, but one that runs is finished first.
        if self.lab.is_open() && self.renderer.phase() != Phase::Tracing {
            self.lab.pictures.tick(ctx);
        } else {
            self.lab.pictures.pause();
            let scene = session.scene();
            self.renderer.tick(ctx, now, scene, session.user_camera());
        }
    }

    /// Whether the processor that draws the window is tracing a picture, too, so that frames cost
    /// the picture time.
    pub(crate) fn is_short_of_time(&self) -> bool {
        self.rest > 0.0 && self.renderer.phase() == Phase::Tracing
    }

    /// Answers scripts that wait for the picture if it is finished, and refuses if the lab keeps it
    /// waiting.
    fn answer_finished(&mut self) {
        let result = if self.rests() {
            Ok(())
        } else if self.lab.is_open() && self.renderer.phase() != Phase::Tracing {
            Err(String::from(
                "The lab is open, and the picture waits until it is closed.",
            ))
        } else {
            return;
        };
        for answer in std::mem::take(&mut self.finished) {
            answer(result.clone());
        }
    }

    /// Whether the picture will not change by itself.
    fn rests(&self) -> bool {
        let session = &self.work.session;
        if session.is_enabled() && !session.is_compiled() {
            return false;
        }
        match self.renderer.phase() {
            Phase::Done | Phase::Cancelled => true,
            Phase::Idle => !self.work.session.is_enabled(),
            Phase::Waiting | Phase::Tracing => false,
        }
    }

    /// Length and rate of the film in the strip below the picture.
    pub(crate) fn film(&self) -> crate::mesh_export::Film {
        crate::mesh_export::Film {
            count: self.player.count,
            rate: self.player.rate,
        }
    }

    /// The size of the traced picture, pixels.
    pub(crate) fn size(&self, ctx: &Context) -> [u32; 2] {
        if let Some(size) = self.forced_size {
            return size;
        }
        let longest = ctx.input(|input| input.max_texture_side) as u32;
        let frame = self.work.session.frame();
        size::pixels(self.settings.size, frame, self.place, longest)
    }

    /// Forgets what belonged to the work before, when another one was opened.
    pub(crate) fn reset_panels(&mut self, ctx: &Context) {
        self.lab.close();
        self.sculpting = None;
        self.player = Player::default();
        if let Some(saving) = self.saving.take() {
            self.forced_size = saving.forced;
        }
        self.editor.reset(ctx);
        self.sliders.clear();
        self.tray.clear();
        self.live.forget();
        self.fitting.forget();
        self.hands.clear();
        self.pencil.clear();
        self.renderer.clear();
        self.notice = None;
        self.dialog = None;
        ctx.request_repaint();
    }
}

impl Drop for App {
    /// Writes what waits to be stored: the window may be started anew on another backend.
    fn drop(&mut self) {
        // A refused write stays on the shelf and is tried again by the next app.
        let _ = self.work.flush();
    }
}
