//! Scripts of the page: their requests, and the state that is reported to them.

#[cfg(target_arch = "wasm32")]
pub mod handle;
pub mod report;
pub mod request;

use crate::page::{Page, repaint_once};
use crate::panels::Panels;
use crate::places;
use crate::render::pass_label;
use crate::stage::StandIn;
use crate::stage::pencil::tool::Tool;
use egui::Context;
use request::Answer;
use std::rc::Rc;

/// Frames without a move after which widgets are at rest: a menu that opens grows in the first.
const STILL: u32 = 3;

/// Scripts that wait for something, and what they were told.
#[derive(Default)]
pub struct Scripts {
    /// The text, and whether it was compiled, that the diagnostics in the outbox are about.
    reported: Option<(u64, bool)>,
    /// Scripts that wait for the picture to be finished.
    pub finished: Vec<Answer>,
    /// Tests that wait until no widget moves any more.
    still: Vec<Box<dyn FnOnce()>>,
    /// The number of frames since a widget moved.
    same: u32,
}

impl Scripts {
    /// Answers when no widget moves any more.
    pub fn wait_for_rest(&mut self, answer: Box<dyn FnOnce()>) {
        self.same = 0;
        self.still.push(answer);
    }

    /// Gives answers at the end of a tick, also to scripts that wait for the picture or for rest.
    pub fn answer(&mut self, page: &Page, ctx: &Context, mut answers: Vec<Box<dyn FnOnce()>>) {
        if self.same >= STILL {
            answers.append(&mut self.still);
        } else if !self.still.is_empty() {
            repaint_once(ctx);
        }
        for answer in answers {
            answer();
        }
        let result = if page.rests() {
            Ok(())
        } else if page.lends_workers() {
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

    /// Writes the state that scripts can read.
    pub fn report(&mut self, page: &Page, panels: &Panels, ctx: &Context) {
        let session = &page.work.session;
        let mut outbox = page.parts.outbox.borrow_mut();
        let state = &mut outbox.report;
        let progress = page.renderer.progress();
        state.phase = page.renderer.phase().id();
        state.progress = progress.fraction;
        state.pass = progress.pass.map(pass_label);
        state.remaining = progress.remaining_seconds;
        state.backend = page.screen.backend.id();
        state.workers = progress.workers;
        state.replaced = progress.restarted;
        state.failure.clone_from(&progress.error);
        state.fresh = session.is_compiled() && session.errors() == 0 && page.is_fresh();
        state.stand_in = panels.stage.stand_in.as_ref().map(StandIn::id);
        state.timings.coarse = page.renderer.timings().coarse;
        state.timings.done = page.renderer.timings().done;
        state.picture = page.renderer.image().map(|image| report::Size {
            width: image.size[0],
            height: image.size[1],
        });
        state.stats = report::Stats {
            primary_rays: progress.stats.primary_rays,
            shadow_rays: progress.stats.shadow_rays,
            field_evaluations: progress.stats.field_evaluations,
        };
        state.revision = session.revision();
        state.name.clone_from(&page.work.name);
        let shelf = page.parts.shelf.borrow();
        state.saved = !shelf.is_dirty() && !browser::is_storing();
        state.theirs = shelf.is_theirs();
        drop(shelf);
        state.reading = page.reading.current().map(|(name, _)| name.to_owned());
        state.fit = panels.fit.0.report();
        state.mesh = panels.mesh.report(page);
        state.drawing = panels.stage.pencil.tool().map(Tool::id);
        state.frame = session.has_frames().then(|| session.film_frame());
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
        outbox.lab = panels.lab.0.report();
        outbox.sculpture = panels.sculpt.report();
    }
}
