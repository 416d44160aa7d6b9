//! The app and scripts of the page: serves their requests, and reports the state to them.

use crate::app::{App, Dialog};
use crate::command::Command;
use crate::notice::Notice;
use crate::render::pass_label;
use crate::report;
use crate::request::Request;
use crate::{examples, places, platform, work};
use egui::Context;
use lab::Lesson;
use std::rc::Rc;

impl App {
    /// Carries out a request. Answers that wait for the end of the tick go to `answers`.
    pub(crate) fn serve(
        &mut self,
        ctx: &Context,
        request: Request,
        now: f64,
        answers: &mut Vec<Box<dyn FnOnce()>>,
    ) {
        match request {
            Request::Ready(answer) => answers.push(answer),
            Request::Finished(answer) => self.finished.push(answer),
            Request::HashChanged => self.follow(ctx, now),
            Request::Load(project, answer) => {
                let result = self.work.load(project);
                if result.is_ok() {
                    if self.lab.is_open() {
                        platform::push_hash("");
                    }
                    self.reset_panels(ctx);
                }
                answers.push(Box::new(move || answer(result)));
            }
            Request::Files(taken) => self.take_in(ctx, taken, now),
            Request::Example(index, Some(text), assets) => {
                let result = self.work.open_example(index, &text, assets);
                self.show_opened(ctx, result);
            }
            Request::Example(..) => {
                let text = "This example could not be loaded. Check the connection and try \
                    again; your work stays open.";
                self.dialog = None;
                self.notice = Some(Notice::trouble(text));
            }
            Request::SculptModel(result) => self.sculpt_mesh(result, now),
            Request::Videos(formats) => self.videos = Some(formats),
            Request::SetCamera(camera) => self.work.session.set_camera(camera),
            Request::Picture(answer) => answer(self.renderer.image()),
            Request::Mesh(order, taker) => {
                let name = work::file_stem(&self.work.name);
                self.mesh_export
                    .make_for(&self.work.session, self.film(), &name, order, taker);
            }
            Request::Still(answer) => {
                self.same = 0;
                self.still.push(answer);
            }
            Request::Cancel => self.renderer.cancel(),
            Request::Again => self.renderer.again(now),
            Request::PictureSize(size) => {
                let longest = ctx.input(|input| input.max_texture_side) as u32;
                self.forced_size = size.map(|size| size.map(|side| side.clamp(1, longest)));
            }
            Request::Panic => panic!("asked for by sinew.debug.panic()"),
        }
    }

    /// Follows the fragment of the address to a lesson, an example, a shared work, or back to the
    /// editor.
    fn follow(&mut self, ctx: &Context, now: f64) {
        let hash = platform::hash();
        if let Some(lesson) = Lesson::of_hash(&hash) {
            self.lab.open(lesson, "");
            ctx.request_repaint();
            return;
        }
        self.lab.close();
        if let Some(name) = examples::of_hash(&hash) {
            match examples::find(name) {
                Some(index) => self.carry_out(ctx, Command::OpenExample(index), now),
                None => {
                    let text = format!("There is no example “{name}”. Your work stays open.");
                    self.notice = Some(Notice::trouble(text));
                }
            }
            return;
        }
        match self.work.open_link(&hash) {
            Ok(true) => {
                self.reset_panels(ctx);
                self.welcome_link();
            }
            Ok(false) => {}
            Err(trouble) => {
                let text = format!("{trouble} Your work stays open.");
                self.notice = Some(Notice::trouble(text));
            }
        }
        ctx.request_repaint();
    }

    /// Writes the state that scripts can read.
    pub(crate) fn report(&mut self, ctx: &Context) {
        let (session, film) = (&self.work.session, self.film());
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
        let texture = self.renderer.texture();
        state.fresh = session.is_compiled()
            && texture.is_some_and(|(_, generation)| generation == session.generation());
        state.stand_in = self.stand_in.map(crate::app::StandIn::id);
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
        state.reading = self.reading.current().map(|(name, _)| name.to_owned());
        state.fit = self.fitting.report();
        state.mesh = (self.dialog == Some(Dialog::Mesh))
            .then(|| self.mesh_export.report(session, film))
            .flatten();
        state.drawing = self.pencil.tool().map(crate::pencil::tool::Tool::id);
        state.frame = session.is_animated().then(|| session.film_frame());
        let text = (session.revision(), session.is_compiled());
        if self.reported != Some(text) {
            self.reported = Some(text);
            state.diagnostics = session.diagnostics().into();
            state.errors = session.errors();
            state.elements = session.compilation().scene.elements.len();
            state.timings.compile = session.compile_seconds();
            let hot = &session.compilation().hot;
            state.hot = hot.iter().map(|variable| variable.name.clone()).collect();
            let assets = session.assets().iter();
            state.assets = assets.map(|asset| asset.name.clone()).collect();
            outbox.project = Rc::new(session.project().clone());
        }
        outbox.chosen = session.user_camera();
        outbox.camera = session.camera();
        let places = places::all(ctx);
        self.same = if places == outbox.places {
            self.same + 1
        } else {
            0
        };
        outbox.places = places;
        outbox.lab = self.lab.report();
        outbox.sculpture = self.sculpting.as_ref().map(|place| report::Sculpture {
            name: place.name.clone(),
            counts: place.counts(),
            depth: place.depth(),
        });
    }
}
