//! The app: ties the user's work, the tracer and the draft to the widgets.
//!
//! [`App::tick`] does what time and messages demand and runs even while the tab is hidden;
//! [`App::show`] draws one frame. Widgets only list [`Command`]s, which are carried out afterwards.

use crate::command::Command;
use crate::draft::Draft;
use crate::editor::Editor;
use crate::gallery::Gallery;
use crate::keyboard::Keyboard;
use crate::notice::Notice;
use crate::pool::Pool;
use crate::render::{Phase, Renderer, pass_label};
use crate::report::{self, Shared};
use crate::request::{Request, Requests};
use crate::settings::Settings;
use crate::sliders::Sliders;
use crate::storage::Shelf;
use crate::work::{Origin, Work};
use crate::{Backend, picture, places, platform, share, size, theme};
use egui::{Context, Key, KeyboardShortcut, Modifiers, Ui};
use std::cell::RefCell;
use std::rc::Rc;

/// Seconds of running without trouble after which a start counts as a good one.
const HEALTHY: f64 = 4.0;

/// What lies over the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialog {
    /// Examples and own works.
    Gallery,
    /// The help.
    Help,
}

/// Which part a narrow page shows below the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tab {
    /// The editor.
    #[default]
    Text,
    /// The sliders.
    Sliders,
    /// The problems.
    Problems,
}

/// What an app is made of that outlives it when the window must be started anew.
#[derive(Clone)]
pub struct Parts {
    /// Storage.
    pub shelf: Rc<RefCell<Shelf>>,
    /// Wishes of scripts.
    pub requests: Requests,
    /// What scripts can read.
    pub outbox: Shared,
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
    pub(crate) backend: Backend,
    pub(crate) settings: Settings,
    pub(crate) editor: Editor,
    pub(crate) sliders: Sliders,
    pub(crate) gallery: Gallery,
    pub(crate) dialog: Option<Dialog>,
    pub(crate) notice: Option<Notice>,
    pub(crate) tab: Tab,
    /// The picture's place in device pixels at the last frame.
    pub(crate) place: [f32; 2],
    forced_size: Option<[u32; 2]>,
    keyboard: Keyboard,
    parts: Parts,
    saved_settings: Settings,
    reported: Option<u64>,
    started: Option<f64>,
    healthy: bool,
    /// Who waits for the picture to be finished.
    finished: Vec<Box<dyn FnOnce()>>,
    touch: Option<bool>,
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
        let calm = !platform::troubled();
        // Until the start has gone well, a stop counts as a bad start.
        platform::set_troubled(true);
        let (work, trouble) = Work::start(parts.shelf.clone(), &platform::hash(), calm);
        parts.requests.attach(ctx);
        let settings: Settings = parts.shelf.borrow().settings();
        ctx.set_theme(settings.theme);
        let repaint = ctx.clone();
        let pool = Pool::new(move || repaint.request_repaint());
        let mut app = Self {
            renderer: Renderer::new(pool),
            draft: render_state
                .filter(|_| backend != Backend::None)
                .map(Draft::new),
            backend,
            editor: Editor::default(),
            sliders: Sliders::default(),
            gallery: Gallery::default(),
            dialog: None,
            notice: None,
            tab: Tab::Text,
            place: [640.0, 480.0],
            forced_size: None,
            keyboard: Keyboard::default(),
            saved_settings: settings.clone(),
            settings,
            reported: None,
            started: None,
            healthy: false,
            finished: Vec::new(),
            touch: None,
            work,
            parts,
        };
        app.greet(trouble);
        app
    }

    /// Says at the start what the user should know.
    fn greet(&mut self, trouble: Option<String>) {
        if !self.work.session.enabled() {
            let text = "Sinew stopped unexpectedly the last time. Your text is here and safe; nothing is drawn until you say so.";
            self.notice = Some(Notice::trouble(text).offering("Draw", Command::Enable));
        } else if let Some(trouble) = trouble {
            let text = format!("{trouble} You see your own work instead.");
            self.notice = Some(Notice::trouble(text));
        } else if self.work.origin == Origin::Link {
            self.welcome_link();
        } else if self.backend == Backend::None {
            let text = "No WebGPU or WebGL2 here: no draft, everything else works.";
            self.notice = Some(Notice::done(text, f64::INFINITY));
        }
    }

    fn welcome_link(&mut self) {
        let notice = Notice {
            text: String::from("You are looking at a shared link. Your own work is safe."),
            bad: false,
            action: None,
            until: None,
        };
        self.notice = Some(match self.work.before() {
            Some(_) => notice.offering("Back to my work", Command::GoBack),
            None => Notice {
                text: String::from(
                    "You are looking at a shared link. Change it as you like: it becomes yours.",
                ),
                ..notice
            },
        });
    }

    /// Does what time and messages demand. Call it before each frame, and also while the tab is
    /// hidden.
    pub fn tick(&mut self, ctx: &Context) {
        let now = platform::now(ctx);
        let started = *self.started.get_or_insert(now);
        let mut answers = Vec::new();
        for request in self.parts.requests.take() {
            self.serve(ctx, request, now, &mut answers);
        }
        if let Some(trouble) = self.work.tick(now) {
            self.notice = Some(Notice::trouble(trouble));
        }
        if self.settings != self.saved_settings {
            self.saved_settings = self.settings.clone();
            self.parts.shelf.borrow_mut().set_settings(&self.settings);
        }
        let session = &self.work.session;
        if session.enabled() {
            self.renderer
                .want(session.generation(), self.size(ctx), now);
            self.renderer.tick(ctx, now, || session.scene());
            if !self.healthy && now - started > HEALTHY {
                self.healthy = true;
                platform::set_troubled(false);
            }
        }
        if let Some(notice) = &self.notice
            && notice.until.is_some_and(|until| now > until)
        {
            self.notice = None;
        }
        self.report(ctx);
        if self.rests() {
            answers.append(&mut self.finished);
        }
        for answer in answers {
            answer();
        }
        let mut waits = vec![self.work.wait(now), self.renderer.wait(now)];
        waits.push(match &self.notice {
            Some(notice) => notice.until.map(|until| until - now),
            None => None,
        });
        if !self.healthy && self.work.session.enabled() {
            waits.push(Some(started + HEALTHY - now));
        }
        // The progress bar and the remaining time move even while no tile comes.
        waits.push((self.renderer.phase() == Phase::Tracing).then_some(0.25));
        if let Some(wait) = waits
            .into_iter()
            .flatten()
            .filter(|wait| wait.is_finite())
            .min_by(f64::total_cmp)
        {
            ctx.request_repaint_after_secs(wait.max(0.0) as f32 + 0.002);
        }
    }

    /// Whether nothing more will happen to the picture by itself.
    fn rests(&self) -> bool {
        match self.renderer.phase() {
            Phase::Done | Phase::Cancelled => true,
            Phase::Idle => !self.work.session.enabled(),
            Phase::Waiting | Phase::Tracing => false,
        }
    }

    /// The size to trace at.
    fn size(&self, ctx: &Context) -> [u32; 2] {
        if let Some(size) = self.forced_size {
            return size;
        }
        let longest = ctx.input(|input| input.max_texture_side) as u32;
        let frame = self.work.session.frame();
        size::pixels(self.settings.size, frame, self.place, longest)
    }

    fn serve(
        &mut self,
        ctx: &Context,
        request: Request,
        now: f64,
        answers: &mut Vec<Box<dyn FnOnce()>>,
    ) {
        match request {
            Request::Ready(answer) => answers.push(answer),
            Request::Finished(answer) => self.finished.push(answer),
            Request::HashChanged => match self.work.open_link(&platform::hash()) {
                Ok(()) if self.work.origin == Origin::Link => {
                    self.opened(ctx);
                    self.welcome_link();
                }
                Ok(()) => {}
                Err(trouble) => {
                    let text = format!("{trouble} Your work stays open.");
                    self.notice = Some(Notice::trouble(text));
                }
            },
            Request::Load(project, answer) => {
                let result = self.work.load(project);
                if result.is_ok() {
                    self.opened(ctx);
                }
                answers.push(Box::new(move || answer(result)));
            }
            Request::SetCamera(camera) => self.work.session.set_camera(camera),
            Request::Picture(answer) => answer(self.renderer.image()),
            Request::Cancel => self.renderer.cancel(),
            Request::Again => self.renderer.again(now),
            Request::PictureSize(size) => {
                let longest = ctx.input(|input| input.max_texture_side) as u32;
                self.forced_size = size.map(|size| size.map(|side| side.clamp(1, longest)));
            }
            Request::KillWorker(index) => {
                self.renderer.kill_worker(index);
            }
        }
    }

    /// Another work is open: forget what belonged to the one before.
    fn opened(&mut self, ctx: &Context) {
        self.editor.reset(ctx);
        self.sliders.clear();
        self.renderer.clear();
        self.notice = None;
        self.dialog = None;
        ctx.request_repaint();
    }

    /// Draws one frame into all of `ui`.
    pub fn show(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        let touch = ctx.input(egui::InputState::has_touch_screen) || crate::layout::is_narrow(&ctx);
        if self.touch != Some(touch) {
            self.touch = Some(touch);
            theme::apply(&ctx, touch);
        }
        self.keyboard.order(&ctx);
        let mut commands = Vec::new();
        self.keys(&ctx, &mut commands);
        crate::layout::show(self, ui, &mut commands);
        let now = platform::now(&ctx);
        for command in commands {
            self.carry_out(&ctx, command, now);
        }
    }

    fn keys(&self, ctx: &Context, commands: &mut Vec<Command>) {
        let pressed = |modifiers: Modifiers, key: Key| {
            ctx.input_mut(|input| input.consume_shortcut(&KeyboardShortcut::new(modifiers, key)))
        };
        // The longer combination first: the shorter one matches it too.
        if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)
            || pressed(Modifiers::COMMAND, Key::Y)
        {
            commands.push(Command::Redo);
        } else if pressed(Modifiers::COMMAND, Key::Z) {
            commands.push(Command::Undo);
        }
        if pressed(Modifiers::COMMAND, Key::S) {
            commands.push(Command::SavePng);
        }
        if self.dialog.is_some() && pressed(Modifiers::NONE, Key::Escape) {
            commands.push(Command::Close);
        }
    }

    fn carry_out(&mut self, ctx: &Context, command: Command, now: f64) {
        let session = &mut self.work.session;
        match command {
            Command::SetText { file, text } => {
                if let Err(refused) = session.set_text(file, text, now) {
                    self.editor.resync(ctx);
                    self.notice = Some(Notice::trouble(refused.to_string()));
                }
            }
            Command::Replace { file, range, with } => {
                if let Err(refused) = session.replace(file, range, &with, now) {
                    self.notice = Some(Notice::trouble(refused.to_string()));
                }
            }
            Command::AddFile => match session.add_file(now) {
                Ok(file) => self.editor.jump(file, 0..0),
                Err(refused) => self.notice = Some(Notice::trouble(refused.to_string())),
            },
            Command::RenameFile(file, name) => session.rename_file(file, &name, now),
            Command::RemoveFile(file) => session.remove_file(file, now),
            Command::Hold => session.hold(),
            Command::Release => session.release(),
            Command::Undo => {
                if let Some((file, byte)) = session.undo() {
                    self.editor.show_place(file, byte);
                }
            }
            Command::Redo => {
                if let Some((file, byte)) = session.redo() {
                    self.editor.show_place(file, byte);
                }
            }
            Command::Jump { file, range } => {
                self.tab = Tab::Text;
                self.editor.jump(file, range);
            }
            Command::SetCamera(camera) => {
                session.set_camera(camera);
                self.settings.turned = true;
            }
            Command::ShowAll => {
                if let Some(scene) = session.scene() {
                    let camera = preview::orbit::frame(&scene, session.frame());
                    session.set_camera(Some(camera));
                }
            }
            Command::Cancel => self.renderer.cancel(),
            Command::Again => self.renderer.again(now),
            Command::SetShow(show) => self.settings.show = show,
            Command::SetSize(size) => {
                self.settings.size = size;
                self.forced_size = None;
            }
            Command::SetTheme(theme) => {
                self.settings.theme = theme;
                ctx.set_theme(theme);
            }
            Command::SavePng => self.save_png(now),
            Command::Share => self.share(ctx, now),
            Command::OpenExample(index) => {
                let result = self.work.open_example(index);
                self.opened_or(ctx, result);
            }
            Command::OpenSaved(id) => {
                let result = self.work.open_saved(&id);
                self.opened_or(ctx, result);
            }
            Command::New => {
                let result = self.work.open_new();
                self.opened_or(ctx, result);
            }
            Command::GoBack => {
                if let Some(id) = self.work.before().map(str::to_owned) {
                    platform::set_hash("");
                    let result = self.work.open_saved(&id);
                    self.opened_or(ctx, result);
                }
            }
            Command::Rename(name) => self.work.rename(name, now),
            Command::Delete(id) => {
                self.parts.shelf.borrow_mut().delete(&id);
                self.gallery.refresh(self.parts.shelf.borrow().entries());
            }
            Command::Enable => {
                self.notice = None;
                self.work.session.enable();
            }
            Command::ShowGallery => {
                if let Err(trouble) = self.work.flush() {
                    self.notice = Some(Notice::trouble(trouble));
                }
                self.gallery.refresh(self.parts.shelf.borrow().entries());
                self.dialog = Some(Dialog::Gallery);
            }
            Command::ShowHelp => self.dialog = Some(Dialog::Help),
            Command::Close => {
                if self.dialog.take().is_none() {
                    self.notice = None;
                }
            }
        }
        ctx.request_repaint();
    }

    fn opened_or(&mut self, ctx: &Context, result: Result<(), String>) {
        match result {
            Ok(()) => {
                platform::set_hash("");
                self.opened(ctx);
            }
            Err(trouble) => {
                self.dialog = None;
                self.notice = Some(Notice::trouble(trouble));
            }
        }
    }

    fn save_png(&mut self, now: f64) {
        let Some(image) = self.renderer.image() else {
            self.notice = Some(Notice::trouble("There is no picture to save yet."));
            return;
        };
        match picture::png(image) {
            Ok(bytes) => {
                let stem: String = self
                    .work
                    .name
                    .chars()
                    .map(|c| if c.is_alphanumeric() { c } else { '-' })
                    .collect();
                let name = format!("{}.png", if stem.is_empty() { "sinew" } else { &stem });
                platform::download(&name, "image/png", &bytes);
                let [width, height] = image.size;
                let text = format!("Saved {name}, {width} × {height} pixels.");
                self.notice = Some(Notice::done(text, now));
            }
            Err(error) => self.notice = Some(Notice::trouble(error.to_string())),
        }
    }

    fn share(&mut self, ctx: &Context, now: f64) {
        let session = &self.work.session;
        match share::link(
            &platform::page(),
            session.project(),
            session.chosen_camera(),
        ) {
            Ok(link) => {
                if let Some((_, fragment)) = link.split_once('#') {
                    platform::set_hash(&format!("#{fragment}"));
                }
                let size = share::size(&link);
                let text = format!("Link copied ({size}). It carries the text and the view.");
                ctx.copy_text(link);
                self.notice = Some(Notice::done(text, now));
            }
            Err(trouble) => self.notice = Some(Notice::trouble(trouble)),
        }
    }

    fn report(&mut self, ctx: &Context) {
        let session = &self.work.session;
        let mut outbox = self.parts.outbox.borrow_mut();
        let state = &mut outbox.report;
        let progress = self.renderer.progress();
        state.phase = self.renderer.phase().id();
        state.progress = progress.fraction;
        state.pass = progress.pass.map(pass_label);
        state.remaining = progress.remaining_seconds;
        state.backend = self.backend.id();
        state.workers = progress.workers;
        state.replaced = progress.restarted;
        state.failure.clone_from(&progress.error);
        state.fresh = self
            .renderer
            .texture()
            .is_some_and(|(_, generation)| generation == session.generation());
        state.timings.coarse = self.renderer.timings().coarse;
        state.timings.done = self.renderer.timings().done;
        state.picture = self.renderer.image().map(|image| report::Size {
            width: image.size[0],
            height: image.size[1],
        });
        state.stats = report::Stats {
            primary_rays: progress.stats.primary_rays,
            shadow_rays: progress.stats.shadow_rays,
            field_evaluations: progress.stats.field_evaluations,
        };
        state.revision = session.revision();
        state.name.clone_from(&self.work.name);
        state.saved = !self.parts.shelf.borrow().is_dirty();
        if self.reported != Some(session.revision()) {
            self.reported = Some(session.revision());
            state.diagnostics = session.diagnostics().into();
            state.errors = session.errors();
            state.timings.compile = session.compile_seconds();
            let hot = &session.compiled().hot;
            state.hot = hot.iter().map(|variable| variable.name.clone()).collect();
            outbox.project = Rc::new(session.project().clone());
        }
        outbox.chosen = session.chosen_camera();
        outbox.camera = session.camera();
        outbox.places = places::all(ctx);
    }
}

impl Drop for App {
    /// The window may be started anew on another backend; nothing that waits is lost.
    fn drop(&mut self) {
        // What is refused here stays on the shelf and is tried again by the next app.
        let _ = self.work.flush();
    }
}
