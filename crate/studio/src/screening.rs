//! Playback of an animated work, and saving its frames as a film.

use crate::app::App;
use crate::notice::Notice;
use crate::recording::{Kind, Recording, Saving};
use crate::render::Phase;
use crate::request::Request;
use crate::settings::Show;
use crate::{platform, work};
use egui::Context;

impl App {
    /// Whether the picture of the present scene and camera is finished.
    pub(crate) fn is_finished(&self) -> bool {
        let generation = self.work.session.generation();
        self.renderer.phase() == Phase::Done
            && self
                .renderer
                .texture()
                .is_some_and(|(_, shown)| shown == generation)
    }

    /// Shows a frame of the film.
    pub(crate) fn go_to_frame(&mut self, frame: u32) {
        self.work.session.set_film_frame(frame);
        self.work.session.compile();
    }

    /// Plays from the frame on show, or pauses.
    pub(crate) fn play(&mut self, now: f64) {
        let frame = self.work.session.film_frame();
        let first = self.player.toggle(frame, now);
        self.go_to_frame(first);
    }

    /// Shows the next frame of the film if its time has come, or saves the one that is finished.
    pub(crate) fn screen(&mut self, ctx: &Context, now: f64) {
        if self.work.session.is_animated() && self.videos.is_none() {
            self.videos = Some(Vec::new());
            let requests = self.parts.requests.clone();
            platform::video_formats(move |formats| requests.ask(Request::Videos(formats)));
        }
        if self.saving.is_some() {
            self.player.pause();
            self.save_frame(ctx, now);
            return;
        }
        if !self.work.session.is_animated() || self.lab.is_open() {
            self.player.pause();
        }
        self.player.follow(self.work.session.film_rate());
        let has_draft = self.draft.is_some() && self.settings.show != Show::Traced;
        let ready = has_draft || self.is_finished();
        let frame = self.work.session.film_frame();
        if let Some(next) = self.player.next(frame, ready, now) {
            self.go_to_frame(next);
        }
    }

    /// Begins to save all frames.
    pub(crate) fn begin_film(&mut self, ctx: &Context, kind: Kind, now: f64) {
        let size = kind.size(self.size(ctx));
        let formats = self.videos.as_deref().unwrap_or_default();
        match Recording::begin(kind, &self.player, size, formats, now) {
            Ok(recording) => {
                self.saving = Some(Saving {
                    recording,
                    revision: self.work.session.revision(),
                    before: self.work.session.film_frame(),
                    forced: self.forced_size.replace(size),
                });
                self.notice = None;
                self.go_to_frame(0);
            }
            Err(trouble) => self.notice = Some(Notice::trouble(trouble)),
        }
    }

    /// Gives up saving the film, for a reason that is shown.
    pub(crate) fn stop_film(&mut self, why: &str) {
        if let Some(saving) = self.saving.take() {
            self.forced_size = saving.forced;
            self.go_to_frame(saving.before);
            self.notice = Some(Notice::trouble(format!("{why} The film was not saved.")));
        }
    }

    /// Adds a frame that is finished to the film, or ends the film after the last one.
    fn save_frame(&mut self, ctx: &Context, now: f64) {
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
        if saving.recording.next_frame().is_some() {
            let Some(image) = self.renderer.image().filter(|_| finished) else {
                return;
            };
            match saving.recording.add(image) {
                Ok(()) => {
                    if let Some(next) = saving.recording.next_frame() {
                        self.go_to_frame(next);
                        return;
                    }
                }
                Err(trouble) => {
                    self.stop_film(&trouble);
                    return;
                }
            }
        }
        match saving.recording.finish() {
            // A video's encoder works beside the page.
            Ok(None) => ctx.request_repaint_after_secs(0.01),
            Ok(Some(bytes)) => self.save_film(&bytes, now),
            Err(trouble) => self.stop_film(&trouble),
        }
    }

    /// Saves the file of a film that is complete.
    fn save_film(&mut self, bytes: &[u8], now: f64) {
        let Some(saving) = self.saving.take() else {
            return;
        };
        let kind = saving.recording.kind;
        let stem = work::file_stem(&self.work.name);
        let name = format!("{stem}-film.{}", kind.extension());
        platform::download(&name, kind.mime(), bytes);
        let size = crate::asset::size(bytes.len());
        let text = format!("Saved {name}, {} frames, {size}.", self.player.count);
        self.forced_size = saving.forced;
        self.go_to_frame(saving.before);
        self.notice = Some(Notice::success(text, now));
    }
}
