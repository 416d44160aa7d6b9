//! Playback of an animated work, and saving of its frames: the app's part, frame by frame.

use crate::app::App;
use crate::command::Command;
use crate::film::{Recording, Saving};
use crate::notice::Notice;
use crate::render::Phase;
use crate::settings::Show;
use crate::{platform, work};
use egui::Context;

impl App {
    /// Whether the picture of what is to be drawn is finished.
    pub(crate) fn is_finished(&self) -> bool {
        let generation = self.work.session.generation();
        self.renderer.phase() == Phase::Done
            && self
                .renderer
                .texture()
                .is_some_and(|(_, shown)| shown == generation)
    }

    fn go_to_frame(&mut self, frame: u32) {
        self.work.session.set_film_frame(frame);
        self.work.session.compile();
    }

    /// Shows the next frame if its time has come; saves the one that is finished.
    pub(crate) fn screen(&mut self, now: f64) {
        if self.saving.is_some() {
            self.player.pause();
            self.save_frame(now);
            return;
        }
        if !self.work.session.is_animated() || self.lab.is_open() {
            self.player.pause();
        }
        let has_draft = self.draft.is_some() && self.settings.show != Show::Traced;
        let ready = has_draft || self.is_finished();
        let frame = self.work.session.film_frame();
        if let Some(next) = self.player.next(frame, ready, now) {
            self.go_to_frame(next);
        }
    }

    /// Begins to save all frames.
    pub(crate) fn begin_film(&mut self, ctx: &Context) {
        let size = self.size(ctx);
        let before = self.work.session.film_frame();
        match Recording::begin(self.player.count, size, before) {
            Ok(recording) => {
                self.saving = Some(Saving {
                    recording,
                    revision: self.work.session.revision(),
                    forced: self.forced_size.replace(size),
                });
                self.go_to_frame(0);
                self.tell_progress();
            }
            Err(trouble) => self.notice = Some(Notice::trouble(trouble)),
        }
    }

    /// Gives up saving; what was made so far is thrown away.
    pub(crate) fn stop_film(&mut self, why: &str) {
        if let Some(saving) = self.saving.take() {
            self.forced_size = saving.forced;
            self.go_to_frame(saving.recording.before);
            self.notice = Some(Notice::trouble(format!("{why} The film was not saved.")));
        }
    }

    fn save_frame(&mut self, now: f64) {
        let finished = self.is_finished();
        let Some(saving) = &mut self.saving else {
            return;
        };
        if saving.revision != self.work.session.revision() {
            self.stop_film("The text changed.");
            return;
        }
        if self.renderer.phase() == Phase::Cancelled {
            self.stop_film("The picture was stopped.");
            return;
        }
        let Some(image) = self.renderer.image().filter(|_| finished) else {
            return;
        };
        match saving.recording.add(image) {
            Ok(None) => {
                let next = saving.recording.next();
                self.go_to_frame(next);
                self.tell_progress();
            }
            Ok(Some(bytes)) => {
                let name = format!("{}-film.png", work::file_stem(&self.work.name));
                platform::download(&name, "image/apng", &bytes);
                let size = crate::asset::size(bytes.len());
                let text = format!("Saved {name}, {} frames, {size}.", saving.recording.next());
                let before = saving.recording.before;
                self.forced_size = saving.forced;
                self.saving = None;
                self.go_to_frame(before);
                self.notice = Some(Notice::done(text, now));
            }
            Err(trouble) => self.stop_film(&trouble),
        }
    }

    fn tell_progress(&mut self) {
        if let Some(saving) = &self.saving {
            let notice = Notice {
                text: saving.recording.words(),
                bad: false,
                action: None,
                until: None,
            };
            self.notice = Some(notice.offering("Stop", Command::StopFilm));
        }
    }
}
