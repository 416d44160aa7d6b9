//! The app: ties the user's work, the tracer and the panels together.
//!
//! [`App::tick`] does the work of timers and messages and runs even while the tab is hidden;
//! [`App::show`] draws one frame. Panels only list wishes ([`crate::wish`]), which are carried out
//! afterwards.

use crate::clicks::Clicks;
use crate::export::MeshPanel;
use crate::film::FilmPanel;
use crate::fit::FitPanel;
use crate::help::Help;
use crate::lessons::Lessons;
use crate::page::{Moment, Page, Parts, Screen, Tab, repaint_once};
use crate::panels::Panels;
use crate::render::{Phase, Renderer};
use crate::scripts::Scripts;
use crate::scripts::request::{Answer, Request, Told};
use crate::sculpt::SculptPanel;
use crate::settings::Settings;
use crate::sliders::Sliders;
use crate::stage::Stage;
use crate::text::TextPanel;
use crate::text::keyboard::Keyboard;
use crate::tray::Tray;
use crate::wish::{Dialog, LabWish, Notice, ViewWish, Wish, Wishes, WorkWish};
use crate::works::gallery::Gallery;
use crate::{fonts, keys, layout, screen, theme};
use browser::Backend;
use browser::voice::Voice;
use document::examples;
use document::fitting::Fitting;
use document::heavy;
use document::reading::MeshReading;
use document::work::{self, Origin, Work};
use egui::{Context, Ui};
use lab::{Lab, Lesson};
use pool::{Pool, Tools};
use std::cell::RefCell;
use std::rc::Rc;

/// Seconds of running without trouble after which a start counts as a good one.
const HEALTHY: f64 = 4.0;
/// Fragment of the address that leads to the first shape.
const FIRST: &str = "#first";
/// Seconds after a letter was typed in which its word is no mistake.
const TYPING: f64 = 1.0;
/// Seconds that tiles wait to be shown where the processor that traces them draws the page, too:
/// each frame keeps the workers waiting.
const REST: f32 = 0.4;

/// The whole page.
pub struct App {
    page: Page,
    panels: Panels,
    scripts: Scripts,
    /// Time of the first tick, seconds.
    started: Option<f64>,
    /// Whether the start counts as a good one.
    is_healthy: bool,
    /// [`Work::number`] of the work that the panels are about.
    work: u64,
    saved_settings: Settings,
    /// The name in the title of the browser's tab.
    tab_title: String,
    /// Time of the last edit while the text had the focus, seconds, and the revision it led to.
    typed: (f64, u64),
    /// [`Session::shape`](document::session::Session::shape) of the scene that was weighed.
    weighed: u64,
    /// The own work that other tabs are asked to leave to this one.
    claimed: Option<String>,
}

fn is_drawn_by_processor(backend: Backend, state: Option<&egui_wgpu::RenderState>) -> bool {
    backend == Backend::None
        || state.is_some_and(|state| {
            let info = state.adapter.get_info();
            info.device_type == egui_wgpu::wgpu::DeviceType::Cpu
                || browser::is_processor(&info.name)
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
        let is_calm = !browser::has_stopped_before();
        // Until the start has gone well, a stop counts as a bad start.
        browser::set_stopped(true);
        let hash = browser::hash();
        let lesson = Lesson::of_hash(&hash);
        // A link to a lesson, to an example or to the first shape carries no work.
        let to_example = examples::of_hash(&hash).is_some() || hash == FIRST;
        let carried = if lesson.is_some() || to_example {
            ""
        } else {
            &hash
        };
        let (work, trouble) =
            Work::start(parts.shelf.clone(), browser::unix_time, carried, is_calm);
        parts.requests.attach(ctx);
        if to_example {
            parts.requests.ask(Request::HashChanged);
        }
        ctx.set_fonts(fonts::definitions());
        ctx.add_plugin(Voice::new(parts.acts.clone()));
        ctx.add_plugin(Keyboard::default());
        ctx.add_plugin(Clicks::default());
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
        let render_state = render_state.filter(|_| backend != Backend::None);
        let lab = Lab::new(pool.clone(), lesson);
        let mut app = Self {
            scripts: Scripts::default(),
            started: None,
            is_healthy: false,
            work: work.number(),
            saved_settings: settings.clone(),
            tab_title: String::new(),
            typed: (f64::NEG_INFINITY, work.session.revision()),
            weighed: 0,
            claimed: None,
            page: Page {
                work,
                reading: MeshReading::new(tools.clone()),
                to_frame: None,
                renderer: Renderer::new(pool),
                drafted: None,
                shot: None,
                settings,
                parts,
                screen: Screen {
                    backend,
                    has_draft: render_state.is_some(),
                    refusal: None,
                    rest,
                    touch: None,
                    asked: [false; 2],
                    place: [640.0, 480.0],
                    width: 0.0,
                    forced: None,
                },
                is_lab_open: lab.is_open(),
                is_measuring: false,
                film: FilmPanel::default().length(),
                dialog: None,
                tab: Tab::Text,
                first: None,
                is_refused: false,
                notice: None,
                wishes: Wishes::default(),
            },
            panels: Panels {
                text: TextPanel::default(),
                stage: Stage::new(render_state, tools.clone()),
                sliders: Sliders::default(),
                fit: FitPanel(Fitting::new(tools.clone())),
                film: FilmPanel::default(),
                tray: Tray::default(),
                mesh: MeshPanel::new(tools),
                gallery: Gallery::default(),
                help: Help::default(),
                sculpt: SculptPanel::default(),
                lab: Lessons(lab),
            },
        };
        app.greet(trouble);
        app
    }

    /// Says at the start what the user should know.
    fn greet(&mut self, trouble: Option<String>) {
        let page = &mut self.page;
        if !page.work.session.is_enabled() {
            let text = "Sinew stopped unexpectedly last time. Your text is here and safe; \
                nothing is drawn until you say so.";
            page.notice = Some(Notice::trouble(text).with_button("Draw", WorkWish::Enable));
        } else if let Some(trouble) = trouble {
            page.warn(format!("{trouble} You see your own work instead."));
        } else if page.work.origin == Origin::Link {
            self.welcome_link();
        } else if !browser::has_storage() {
            page.warn(
                "This browser stores nothing for this page, so your work lasts until you \
                    close it. Share makes a link that keeps it.",
            );
        }
    }

    /// Says that the graphics card was lost, and what draws now.
    pub fn tell_loss(&mut self) {
        let next = match self.page.screen.backend {
            Backend::None => "the processor draws now",
            Backend::WebGpu | Backend::WebGl2 => "it draws again",
        };
        let text = format!("The graphics card was lost; {next}. Nothing of your work is lost.");
        self.page.warn(text);
    }

    fn welcome_link(&mut self) {
        let is_replaced = self.page.work.before().is_some();
        let notice = Notice {
            text: String::from(if is_replaced {
                "You are looking at a shared link. Your own work is safe."
            } else {
                "You are looking at a shared link. Change it as you like: it becomes yours."
            }),
            bad: false,
            actions: Vec::new(),
            until: None,
        };
        self.page.notice = Some(if is_replaced {
            notice.with_button("Back to my work", WorkWish::GoBack)
        } else {
            notice
        });
    }

    /// Does the work of timers and messages. Call it before each frame, and also while the tab is
    /// hidden.
    pub fn tick(&mut self, ctx: &Context) {
        let now = browser::now(ctx);
        let at = Moment { ctx, now };
        let started = *self.started.get_or_insert(now);
        let dropped = ctx.input_mut(|input| std::mem::take(&mut input.raw.dropped_files));
        if !dropped.is_empty() {
            let of = self.page.work.number();
            browser::read_dropped(dropped, self.page.parts.requests.taker(of));
        }
        let mut answers = Vec::new();
        for request in self.page.parts.requests.take() {
            self.serve(request, &at, &mut answers);
        }
        self.note_typing(now);
        let page = &mut self.page;
        page.settle(now);
        if let Some(trouble) = page.work.tick(now) {
            page.warn(trouble);
        }
        if page.to_frame.is_some() && page.work.session.is_compiled() {
            let is_open = page.to_frame.take() == Some(page.work.number());
            page.wishes
                .extend(is_open.then_some(Wish::from(ViewWish::ShowAll)));
        }
        if page.settings != self.saved_settings {
            self.saved_settings = page.settings.clone();
            page.parts.shelf.borrow_mut().set_settings(&page.settings);
        }
        let own = page.work.own_id();
        if self.claimed != own {
            browser::claim_work(own.as_deref());
            self.claimed = own;
        }
        let title = self.panels.lab.0.title().unwrap_or(&page.work.name);
        if self.tab_title != title {
            self.tab_title = title.to_owned();
            browser::set_title(&self.tab_title);
        }
        // Panels look at a picture that has just been finished, and may want another one.
        self.trace(&at);
        self.panels.tick(&mut self.page, &at);
        self.trace(&at);
        let page = &mut self.page;
        if page.work.session.is_enabled() && !self.is_healthy && now - started > HEALTHY {
            self.is_healthy = true;
            browser::set_stopped(false);
        }
        if let Some(notice) = &page.notice
            && notice.until.is_some_and(|until| now > until)
        {
            page.notice = None;
        }
        self.scripts.report(page, &self.panels, ctx);
        self.scripts.answer(page, ctx, answers);
        if let Some(wait) = self.wait(started, now) {
            ctx.request_repaint_after_secs(wait.max(0.0) as f32 + 0.002);
        }
    }

    /// Returns the seconds until the next tick; `None` if nothing waits for one.
    fn wait(&self, started: f64, now: f64) -> Option<f64> {
        let page = &self.page;
        let mut waits = vec![self.panels.wait(page, now)];
        // While frames are expensive, writing waits for the next one, which comes soon.
        waits.push(page.work.wait(now).filter(|_| !page.is_short_of_time()));
        if !page.is_lab_open {
            waits.push(page.renderer.wait(now));
        }
        let until = page.notice.as_ref().and_then(|notice| notice.until);
        waits.push(until.map(|until| until - now));
        let typed = self.typed.0 + TYPING - now;
        waits.push((typed > 0.0).then_some(typed));
        if !self.is_healthy && page.work.session.is_enabled() {
            waits.push(Some(started + HEALTHY - now));
        }
        // The progress bar and the remaining time move even while no tile comes.
        if page.renderer.phase() == Phase::Tracing {
            waits.push(Some(f64::from(page.screen.rest).max(0.25)));
        }
        let waits = waits.into_iter().flatten().filter(|wait| wait.is_finite());
        waits.min_by(f64::total_cmp)
    }

    /// Tells the session of the word that is being typed.
    fn note_typing(&mut self, now: f64) {
        let session = &mut self.page.work.session;
        let editor = &mut self.panels.text.editor;
        if self.typed.1 != session.revision() {
            let typed = if editor.take_written() {
                now
            } else {
                f64::NEG_INFINITY
            };
            self.typed = (typed, session.revision());
        }
        let is_typing = now - self.typed.0 < TYPING;
        session.set_typing(editor.caret().filter(|_| is_typing));
    }

    /// Begins the picture that is wanted, if its time has come, and takes in the tiles that workers
    /// have traced.
    fn trace(&mut self, at: &Moment<'_>) {
        let page = &mut self.page;
        if !page.work.session.is_enabled() {
            return;
        }
        let size = page.size(at.ctx);
        let session = &page.work.session;
        page.renderer.want(session.generation(), size, at.now);
        if self.weighed != session.shape() {
            self.weighed = session.shape();
            let is_part = session.errors() > 0;
            let scene = session.scene();
            let scene = scene.filter(|scene| heavy::is_heavy(scene, is_part));
            page.is_refused = scene.is_some();
            if let Some(scene) = scene {
                let text = format!(
                    "This text makes {} shapes, more than can be traced here in good time. \
                        The picture was not begun; your text is safe.",
                    scene.elements.len()
                );
                let notice = Notice::trouble(text);
                page.notice = Some(notice.with_button("Trace all the same", ViewWish::Again));
            }
        }
        if page.is_refused {
            page.renderer.cancel();
        }
        let pictures = &mut self.panels.lab.0.pictures;
        if page.shot.is_some() {
            return;
        }
        if page.lends_workers() {
            pictures.tick(at.ctx);
        } else {
            pictures.pause();
            let session = &page.work.session;
            let (scene, camera) = (session.scene(), session.user_camera());
            page.renderer.tick(at.ctx, at.now, scene, camera);
        }
    }

    /// Draws one frame into all of `ui`.
    pub fn show(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        let screen = &mut self.page.screen;
        let touch = ctx.input(egui::InputState::has_touch_screen) || screen::is_narrow(&ctx);
        let sharp = "(prefers-contrast: more), (forced-colors: active)";
        let calm = "(prefers-reduced-motion: reduce)";
        let asked = [sharp, calm].map(browser::is_wanted);
        if (screen.touch, screen.asked) != (Some(touch), asked) {
            let [is_sharp, is_calm] = asked;
            (screen.touch, screen.asked) = (Some(touch), asked);
            theme::set_sharp(is_sharp);
            theme::apply(&ctx, touch);
            if screen.rest > 0.0 || is_calm {
                // Fading draws many frames, each at the cost of the picture.
                ctx.all_styles_mut(|style| {
                    style.animation_time = 0.0;
                    style.scroll_animation = egui::style::ScrollAnimation::none();
                });
            }
        }
        let mut wishes = Wishes::default();
        keys::listen(&self.page, &self.panels, &ctx, &mut wishes);
        layout::show(&mut self.page, &mut self.panels, ui, &mut wishes);
        let now = browser::now(&ctx);
        let at = Moment { ctx: &ctx, now };
        let acts = !wishes.is_empty();
        for wish in wishes {
            self.carry_out(wish, &at);
        }
        self.note_typing(now);
        self.page.settle(now);
        // Workers need not wait for this frame to be drawn.
        self.trace(&at);
        let is_short = self.page.is_short_of_time();
        browser::set_frames_slow(is_short);
        match (acts, is_short) {
            (true, true) => ctx.request_repaint(),
            (true, false) => repaint_once(&ctx),
            (false, _) => {}
        }
    }

    /// Carries out a wish, and those that follow from it.
    fn carry_out(&mut self, wish: Wish, at: &Moment<'_>) {
        let (page, panels) = (&mut self.page, &mut self.panels);
        panels.sculpt.on_show = panels.text.file_on_show();
        if let Some(wish) = panels.act(wish, page, at) {
            self.carry_out_own(wish, at);
        }
        self.follow(at.ctx);
        for wish in std::mem::take(&mut self.page.wishes) {
            self.carry_out(wish, at);
        }
    }

    /// Carries out a wish that belongs to no panel.
    fn carry_out_own(&mut self, wish: Wish, at: &Moment<'_>) {
        let (page, panels) = (&mut self.page, &mut self.panels);
        match wish {
            Wish::Set(setting) => page.set(setting, at.ctx),
            Wish::Open(dialog) => {
                match dialog {
                    Dialog::Gallery => panels.gallery.open(page),
                    Dialog::Help => panels.help.turn_to_words(),
                    Dialog::Versions | Dialog::Result | Dialog::Sculpt | Dialog::Mesh => {}
                }
                page.dialog = Some(dialog);
            }
            Wish::Manual(name) => {
                panels.help.turn_to(&name);
                page.dialog = Some(Dialog::Help);
            }
            Wish::Close => {
                let closed = page.dialog.take();
                if closed.is_none() {
                    page.notice = None;
                }
            }
            Wish::Tell(text) => page.tell(text, at.now),
            Wish::Notice(notice) => page.notice = Some(*notice),
            // A panel carries out the others.
            _ => {}
        }
    }

    /// Brings the panels up to date with the open work and the lab.
    fn follow(&mut self, ctx: &Context) {
        let page = &mut self.page;
        if self.work != page.work.number() {
            self.work = page.work.number();
            self.panels.forget(page, ctx);
            page.renderer.clear();
            page.notice = None;
            page.dialog = None;
            ctx.request_repaint();
        }
        page.is_lab_open = self.panels.lab.0.is_open();
    }

    /// Carries out a request from outside. Answers that wait for the end of the tick go to
    /// `answers`.
    fn serve(&mut self, request: Request, at: &Moment<'_>, answers: &mut Vec<Box<dyn FnOnce()>>) {
        let page = &mut self.page;
        match request {
            Request::Ready(answer) => answers.push(answer),
            Request::Finished(answer) => self.scripts.finished.push(answer),
            Request::Still(answer) => self.scripts.wait_for_rest(answer),
            Request::HashChanged => self.follow_address(at),
            Request::Load(project, answer) => self.load(project, answer, at.ctx, answers),
            Request::Files(files) => {
                let wish = WorkWish::Take { files, show: true };
                self.carry_out(wish.into(), at);
            }
            Request::Wish(wish) => self.carry_out(wish, at),
            Request::Late { of, wish, .. } if of == page.work.number() => self.carry_out(wish, at),
            Request::Late { what, .. } => page.warn(format!(
                "{what} came after another work was opened, and was left out. \
                    Open the work that it was for, and ask for it again."
            )),
            Request::Storage(told) => self.heed(told, at),
            Request::Videos(formats) => self.panels.film.formats = Some(formats),
            Request::SetCamera(camera) => page.work.session.set_camera(camera),
            Request::Picture(answer) => answer(page.renderer.image()),
            Request::Mesh(order, taker) => {
                let name = work::file_stem(&page.work.name);
                let export = &mut self.panels.mesh.export;
                export.make_for(&page.work.session, page.film, &name, order, taker);
            }
            Request::PictureSize(size) => {
                let longest = at.ctx.input(|input| input.max_texture_side) as u32;
                page.screen.forced = size.map(|size| size.map(|side| side.clamp(1, longest)));
            }
            Request::Panic => panic!("asked for by sinew.debug.panic()"),
        }
    }

    /// Heeds what the browser's storage tells.
    fn heed(&mut self, told: Told, at: &Moment<'_>) {
        let page = &mut self.page;
        let open = self.claimed.as_ref();
        match told {
            Told::Refused(reason) => page.warn(reason),
            Told::Mine(id) if open == Some(&id) => {
                let mut shelf = page.parts.shelf.borrow_mut();
                let was_theirs = shelf.is_theirs();
                let is_behind = shelf.is_behind();
                // Until it is read anew, changes still become a copy.
                shelf.set_theirs(is_behind);
                drop(shelf);
                if is_behind {
                    self.carry_out(WorkWish::OpenSaved(id).into(), at);
                }
                if was_theirs {
                    let name = &self.page.work.name;
                    let text = format!("“{name}” is this tab's to change now.");
                    self.page.tell(text, at.now);
                }
            }
            Told::Theirs(id) if open == Some(&id) => {
                page.parts.shelf.borrow_mut().set_theirs(true);
                let name = &page.work.name;
                let text = format!(
                    "Another tab writes “{name}”. Changes that you make here become a copy."
                );
                let notice = Notice::trouble(text)
                    .with_button("Take over", WorkWish::TakeOver)
                    .with_button("Make a copy", WorkWish::Copy);
                page.notice = Some(notice);
            }
            Told::Mine(_) | Told::Theirs(_) => {}
        }
    }

    /// Opens texts of a script.
    fn load(
        &mut self,
        project: rats::Project,
        answer: Answer,
        ctx: &Context,
        answers: &mut Vec<Box<dyn FnOnce()>>,
    ) {
        let result = self.page.work.load(project);
        if result.is_ok() {
            self.page.leave_lesson();
            self.follow(ctx);
        }
        answers.push(Box::new(move || answer(result)));
    }

    /// Follows the fragment of the address to a lesson, an example, a shared work, or back to the
    /// editor.
    fn follow_address(&mut self, at: &Moment<'_>) {
        let hash = browser::hash();
        let lesson = Lesson::of_hash(&hash);
        self.carry_out(LabWish::Follow(lesson).into(), at);
        at.ctx.request_repaint();
        if lesson.is_some() {
            return;
        }
        if hash == FIRST {
            self.carry_out(WorkWish::First.into(), at);
            return;
        }
        if let Some(name) = examples::of_hash(&hash) {
            match examples::find(name) {
                Some(index) => self.carry_out(WorkWish::OpenExample(index).into(), at),
                None => {
                    let text = format!("There is no example “{name}”. Your work stays open.");
                    self.page.warn(text);
                }
            }
            return;
        }
        match self.page.work.open_link(&hash) {
            Ok(true) => {
                self.follow(at.ctx);
                self.welcome_link();
            }
            Ok(false) => {}
            Err(trouble) => self.page.warn(format!("{trouble} Your work stays open.")),
        }
    }
}

impl Drop for App {
    /// Writes what waits to be stored: the window may be started anew on another backend.
    fn drop(&mut self) {
        // A refused write stays on the shelf and is tried again by the next app.
        let _ = self.page.work.flush();
    }
}
