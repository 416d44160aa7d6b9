//! The film of an animated work: the strip below the picture, playback, and saving the frames.

mod timeline;
pub mod wish;

use crate::page::{Moment, Page, Shot};
use crate::panel::Panel;
use crate::render::Phase;
use crate::scripts::request::Request;
use crate::wish::ViewWish;
use crate::wish::{FilmWish, Quality, Wishes};
use browser::recording::{Kind, Recording, VideoFormat};
use document::player::Player;
use document::{asset, mesh_export, size, work};
use egui::{Context, Ui};

/// A film that is being saved.
struct Saving {
    recording: Recording,
    /// The revision of the text.
    revision: u64,
    /// The frame that was on show before.
    before: u32,
    /// The size of the picture that tests had asked for.
    forced: Option<[u32; 2]>,
}

/// The film of the open work.
#[derive(Default)]
pub struct FilmPanel {
    player: Player,
    saving: Option<Saving>,
    /// Quality of the frames of a file.
    quality: Quality,
    /// The browser's encoders of videos, once they were asked for.
    pub formats: Option<Vec<VideoFormat>>,
}

impl FilmPanel {
    /// Returns the number of frames and their rate.
    #[must_use]
    pub fn length(&self) -> mesh_export::Film {
        mesh_export::Film {
            count: self.player.count,
            rate: self.player.rate,
        }
    }

    /// Returns the formats of videos that the browser can write, as far as it has said so.
    #[must_use]
    pub fn formats(&self) -> &[VideoFormat] {
        self.formats.as_deref().unwrap_or_default()
    }

    /// Returns how the frames of a file are made.
    #[must_use]
    pub fn quality(&self, page: &Page) -> Quality {
        if page.screen.has_draft {
            self.quality
        } else {
            Quality::Traced
        }
    }

    /// Carries out a wish.
    pub fn act(&mut self, wish: FilmWish, page: &mut Page, at: &Moment<'_>) {
        let player = &mut self.player;
        match wish {
            FilmWish::Play => {
                let first = player.toggle(page.work.session.film_frame(), at.now);
                page.go_to_frame(first);
            }
            FilmWish::SetFrame(frame) => {
                player.pause();
                page.work.session.set_film_frame(frame);
            }
            FilmWish::SetLength(count) => {
                player.count = count;
                player.chosen = true;
            }
            FilmWish::SetRate(rate) => {
                player.rate = rate;
                player.chosen = true;
            }
            FilmWish::SetPlayback(playback) => player.playback = playback,
            FilmWish::SetQuality(quality) => self.quality = quality,
            FilmWish::Save(kind) => self.begin(kind, page, at),
            FilmWish::Stop => self.stop(page, "You stopped it."),
        }
        page.film = self.length();
    }

    /// Begins to save all frames.
    fn begin(&mut self, kind: Kind, page: &mut Page, at: &Moment<'_>) {
        if let Some(saving) = self.end(page) {
            page.go_to_frame(saving.before);
        }
        let quality = self.quality(page);
        let size = kind.size(match quality {
            Quality::Traced => page.size(at.ctx),
            Quality::Draft(lines) => {
                let most = at.ctx.input(|input| input.max_texture_side) as u32;
                size::of_lines(lines, page.work.session.frame(), most)
            }
        });
        let formats = self.formats();
        let result = Recording::begin(kind, &self.player, size, formats, at.now);
        if let Some(recording) = page.accept(result) {
            self.saving = Some(Saving {
                recording,
                revision: page.work.session.revision(),
                before: page.work.session.film_frame(),
                forced: page.screen.forced,
            });
            match quality {
                Quality::Traced => page.screen.forced = Some(size),
                Quality::Draft(_) => page.shot = Some(Shot { size, image: None }),
            }
            page.notice = None;
            page.go_to_frame(0);
        }
    }

    /// Ends saving the film, and returns it if one was being saved.
    fn end(&mut self, page: &mut Page) -> Option<Saving> {
        let saving = self.saving.take()?;
        page.screen.forced = saving.forced;
        page.shot = None;
        Some(saving)
    }

    /// Gives up saving the film, for a reason that is shown.
    fn stop(&mut self, page: &mut Page, why: &str) {
        if let Some(saving) = self.end(page) {
            page.go_to_frame(saving.before);
            page.warn(format!("{why} The film was not saved."));
        }
    }

    /// Adds a frame that is finished to the film, or ends the film after the last one.
    fn save_frame(&mut self, page: &mut Page, at: &Moment<'_>) {
        let Some(saving) = &mut self.saving else {
            return;
        };
        if saving.revision != page.work.session.revision() {
            self.stop(page, "The text changed.");
            return;
        }
        if page.shot.is_none() && page.renderer.phase() == Phase::Cancelled {
            self.stop(page, "The picture was stopped.");
            return;
        }
        if saving.recording.next_frame().is_some() {
            let result = match &mut page.shot {
                Some(shot) => match shot.image.take() {
                    Some(image) => image.and_then(|image| saving.recording.add(&image)),
                    None => return,
                },
                None => match page.renderer.image().filter(|_| page.is_finished()) {
                    Some(image) => saving.recording.add(image),
                    None => return,
                },
            };
            match result {
                Ok(()) => {
                    if let Some(next) = saving.recording.next_frame() {
                        page.go_to_frame(next);
                        return;
                    }
                }
                Err(trouble) => {
                    self.stop(page, &trouble);
                    return;
                }
            }
        }
        match saving.recording.finish() {
            // A video's encoder works beside the page.
            Ok(None) => at.ctx.request_repaint_after_secs(0.01),
            Ok(Some(bytes)) => self.save(&bytes, page, at.now),
            Err(trouble) => self.stop(page, &trouble),
        }
    }

    /// Saves the file of a film that is complete.
    fn save(&mut self, bytes: &[u8], page: &mut Page, now: f64) {
        let Some(saving) = self.end(page) else {
            return;
        };
        let kind = saving.recording.kind;
        let stem = work::file_stem(&page.work.name);
        let name = format!("{stem}-film.{}", kind.extension());
        browser::download(&name, kind.mime(), bytes);
        let size = asset::size(bytes.len());
        page.go_to_frame(saving.before);
        let count = self.player.count;
        page.tell(format!("Saved {name}, {count} frames, {size}."), now);
    }
}

impl Panel for FilmPanel {
    fn show(&mut self, page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
        timeline::show(self, page, ui, wishes);
    }

    /// Shows the next frame of the film if its time has come, or saves the one that is finished.
    fn tick(&mut self, page: &mut Page, at: &Moment<'_>) {
        let has_frames = page.work.session.has_frames();
        if has_frames && self.formats.is_none() {
            self.formats = Some(Vec::new());
            let requests = page.parts.requests.clone();
            browser::video_formats(move |formats| requests.ask(Request::Videos(formats)));
        }
        if self.saving.is_some() {
            self.player.pause();
            self.save_frame(page, at);
            return;
        }
        if !has_frames || page.is_lab_open {
            self.player.pause();
        }
        match page.work.session.pictures() {
            1 => self.player.follow(page.work.session.film_rate()),
            count => self.player.count = count as u32,
        }
        page.film = self.length();
        if self.player.is_playing() {
            page.wish(ViewWish::Follow);
        }
        let is_drafted = page.drafted == Some(page.work.session.shape());
        let ready = is_drafted || page.is_finished();
        let frame = page.work.session.film_frame();
        if let Some(next) = self.player.next(frame, ready, at.now) {
            page.go_to_frame(next);
        }
    }

    fn wait(&self, page: &Page, now: f64) -> Option<f64> {
        // A frame that was finished just now is taken into the film at the next tick.
        if self.saving.is_some() && page.shot.is_none() && page.is_finished() {
            return Some(0.0);
        }
        self.player.wait(now)
    }

    fn forget(&mut self, page: &mut Page, _ctx: &Context) {
        self.player = Player::default();
        page.film = self.length();
        self.end(page);
    }
}
