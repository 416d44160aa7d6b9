//! Small traced pictures for the lessons.
//!
//! They are traced one after the other by the same workers as the main picture, while that rests.
//! Each has a *slot*, the place on the page that shows it, and is kept by its text and size, so
//! that what was drawn once is there at once the next time. While a slider moves, a slot goes on
//! showing its last picture; the one being traced is finished even if the slider has gone on, as
//! otherwise nothing would ever be seen while it moves.

use digger::errors::{Pixel, unpack};
use egui::{
    Color32, ColorImage, Context, FontId, Pos2, Rect, TextureHandle, TextureOptions, Ui, vec2,
};
use pool::Assembly;
use pool::{PictureJob, Pool};
use rats::{File, Project, Severity};
use std::cell::RefCell;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::rc::Rc;
use std::sync::Arc;
use widgets::theme;
use worker::Kind;

/// First number of small pictures; the main picture has those below.
pub const FIRST: u64 = 1 << 40;
/// Most pictures kept.
const MOST: usize = 260;
/// Longest side of a picture, pixels.
const LARGEST: f32 = 420.0;

/// Outcome of compiling a text.
enum Kept {
    /// A picture that was traced.
    Drawn(TextureHandle),
    /// The measured errors of its digger.
    Measured(Rc<[Pixel]>),
    /// The reason why it was not drawn or could not be traced.
    Refused(String),
}

struct Entry {
    kept: Kept,
    /// The frame in which it was last shown.
    used: u64,
}

#[derive(Clone)]
struct Wish {
    slot: u64,
    key: u64,
    text: Rc<str>,
    size: [u32; 2],
    kind: Kind,
    background: [f32; 3],
}

struct Running {
    wish: Wish,
    number: u64,
    assembly: Assembly,
}

/// Content of a slot.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Shown {
    /// The picture of this text.
    Picture,
    /// The picture of an earlier text, while this one's is on its way.
    Older,
    /// Nothing yet.
    #[default]
    Nothing,
    /// The reason why there will be no picture.
    Refused(String),
}

/// The small pictures.
pub struct Pictures {
    pool: Rc<RefCell<Pool>>,
    wishes: Vec<Wish>,
    entries: HashMap<u64, Entry>,
    /// The text that each slot showed last, and the frame in which it was last given a new picture.
    slots: HashMap<u64, (u64, u64)>,
    running: Option<Running>,
    number: u64,
    frame: u64,
    /// The fraction done of the main picture, while it has the workers.
    pub blocked: Option<f64>,
}

fn hash(value: impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}

impl Pictures {
    /// Makes it without pictures.
    #[must_use]
    pub fn new(pool: Rc<RefCell<Pool>>) -> Self {
        Self {
            pool,
            wishes: Vec::new(),
            entries: HashMap::new(),
            slots: HashMap::new(),
            running: None,
            number: FIRST,
            frame: 0,
            blocked: None,
        }
    }

    /// Clears the requests at the start of a frame.
    pub fn begin_frame(&mut self) {
        self.frame += 1;
        self.wishes.clear();
    }

    /// Returns the number of pictures that are asked for and not there yet.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.wishes.len()
    }

    /// Returns the number of pictures that the last frame showed.
    #[must_use]
    pub fn count_drawn(&self) -> usize {
        self.count(|kept| matches!(kept, Kept::Drawn(_)))
    }

    /// Returns the number of texts of the last frame that have no picture.
    #[must_use]
    pub fn count_refused(&self) -> usize {
        self.count(|kept| matches!(kept, Kept::Refused(_)))
    }

    /// Counts the texts of the last frame of a kind.
    fn count(&self, which: impl Fn(&Kept) -> bool) -> usize {
        let shown = self
            .entries
            .values()
            .filter(|entry| entry.used == self.frame);
        shown.filter(|entry| which(&entry.kept)).count()
    }

    /// Gives the workers back.
    pub fn pause(&mut self) {
        if self.running.take().is_some() {
            self.pool.borrow_mut().cancel();
        }
    }

    /// Takes the tiles that were traced and begins the next picture.
    pub fn tick(&mut self, ctx: &Context) {
        loop {
            if let Some(running) = &mut self.running {
                if !self
                    .wishes
                    .iter()
                    .any(|wish| wish.slot == running.wish.slot)
                {
                    self.pause();
                    continue;
                }
                let tiles = self.pool.borrow_mut().poll();
                for tile in tiles {
                    let generation = tile.generation;
                    let _ = running
                        .assembly
                        .put(generation, tile.tile, tile.pass, &tile.pixels);
                }
                let progress = self.pool.borrow().progress();
                let mine = progress.generation == Some(running.number);
                if !mine {
                    // Someone else took the workers: once more from the start.
                    self.running = None;
                    continue;
                }
                if !progress.finished && progress.error.is_none() {
                    return;
                }
                let Some(running) = self.running.take() else {
                    return;
                };
                let kept = match (progress.error, running.assembly.shown()) {
                    (None, Some((_, image))) if running.wish.kind == Kind::Errors => {
                        Kept::Measured(unpack(&image.rgba).into())
                    }
                    (None, Some((_, image))) => {
                        let size = image.size.map(|side| side as usize);
                        let pixels = ColorImage::from_rgba_unmultiplied(size, &image.rgba);
                        Kept::Drawn(ctx.load_texture("small", pixels, TextureOptions::LINEAR))
                    }
                    (error, _) => Kept::Refused(error.unwrap_or_default()),
                };
                self.keep(&running.wish, kept);
                ctx.request_repaint();
            }
            let Some(wish) = self.next() else { return };
            let compiled = rats::compile(&Project {
                files: vec![File {
                    name: String::from("main.rat"),
                    text: wish.text.to_string(),
                }],
            });
            // An error says more than a warning that follows from it.
            let worst = compiled.diagnostics.iter().find(|diagnostic| {
                matches!(diagnostic.severity, Severity::Error | Severity::Warning)
            });
            if let Some(problem) = worst {
                let reason = problem.message.clone();
                self.keep(&wish, Kept::Refused(reason));
                continue;
            }
            let mut shared = compiled.scene;
            let scene = Arc::make_mut(&mut shared);
            scene.background = wish.background.into();
            // Enough for something so small.
            scene.settings.samples = scene.settings.samples.min(2);
            self.number += 1;
            let mut assembly = Assembly::default();
            assembly.begin(self.number, wish.size);
            self.pool.borrow_mut().start(PictureJob {
                scene: &shared,
                camera: None,
                size: wish.size,
                generation: self.number,
                kind: wish.kind,
                small: true,
            });
            self.running = Some(Running {
                wish,
                number: self.number,
                assembly,
            });
            // Tiles come later.
            return;
        }
    }

    /// Returns the wish of the slot that has waited longest.
    fn next(&mut self) -> Option<Wish> {
        let open = self
            .wishes
            .iter()
            .filter(|wish| !self.entries.contains_key(&wish.key));
        open.min_by_key(|wish| self.slots.get(&wish.slot).map_or(0, |(_, given)| *given))
            .cloned()
    }

    /// Keeps the outcome of a wish; the oldest pictures give way.
    fn keep(&mut self, wish: &Wish, kept: Kept) {
        if self.entries.len() >= MOST {
            let oldest = self.entries.values().map(|entry| entry.used).min();
            // Never what is on the screen.
            if let Some(oldest) = oldest.filter(|used| *used < self.frame) {
                self.entries.retain(|_, entry| entry.used > oldest);
            }
        }
        if !matches!(kept, Kept::Refused(_)) {
            // Counting frames is enough: within one, the order of wishes decides.
            self.slots.insert(wish.slot, (wish.key, self.frame));
        }
        let used = self.frame;
        self.entries.insert(wish.key, Entry { kept, used });
        self.wishes.retain(|other| other.key != wish.key);
    }

    /// Shows the picture of a text in an area; requests it if it is missing.
    pub fn show(&mut self, ui: &Ui, slot: impl Hash, text: &str, place: Rect) -> Shown {
        let palette = theme::palette(ui.visuals());
        let slot = hash(slot);
        let scale = ui.ctx().pixels_per_point();
        let most = (LARGEST / (place.width().max(place.height()) * scale).max(1.0)).min(1.0);
        let size = [place.width(), place.height()]
            .map(|side| (side * scale * most).round().max(8.0) as u32);
        let [r, g, b, _] = palette.paper.to_array();
        let key = hash((text, size, [r, g, b]));
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        let round = 6.0;
        let painter = ui.painter();
        painter.rect_filled(place, round, palette.paper);
        let paint = |texture: &TextureHandle, tint: Color32| {
            let shape = egui::epaint::RectShape::filled(place, round, tint);
            painter.add(shape.with_texture(texture.id(), whole));
        };
        let frame = self.frame;
        if let Some(entry) = self.entries.get_mut(&key) {
            entry.used = frame;
            match &entry.kept {
                Kept::Drawn(texture) => {
                    paint(texture, Color32::WHITE);
                    let given = self.slots.get(&slot).map_or(0, |(_, given)| *given);
                    self.slots.insert(slot, (key, given));
                    return Shown::Picture;
                }
                Kept::Refused(reason) => return Shown::Refused(reason.clone()),
                Kept::Measured(_) => {}
            }
        }
        self.wishes.push(Wish {
            slot,
            key,
            text: text.into(),
            size,
            kind: Kind::Colours,
            background: [r, g, b].map(|c| f32::from(c) / 255.0),
        });
        let last = self.slots.get(&slot).map(|(key, _)| *key);
        if let Some(entry) = last.and_then(|key| self.entries.get_mut(&key)) {
            entry.used = frame;
            if let Kept::Drawn(texture) = &entry.kept {
                paint(texture, Color32::WHITE);
                return Shown::Older;
            }
        }
        let dot = Rect::from_center_size(place.center(), vec2(14.0, 14.0));
        if let Some(done) = self.blocked {
            let font = FontId::proportional(11.0);
            let text = format!("after the picture\nin the editor: {:.0} %", 100.0 * done);
            let galley = painter.layout(text, font, palette.weak, place.width());
            let at = place.center() - galley.size() / 2.0;
            painter.galley(at, galley, palette.weak);
        } else {
            painter.circle_stroke(dot.center(), 5.0, egui::Stroke::new(1.5, palette.line));
        }
        Shown::Nothing
    }

    /// Returns the errors of a text's digger, in a square of `side` pixels; requests them if they
    /// are missing, and returns those of the text before it meanwhile.
    pub fn errors(
        &mut self,
        slot: impl Hash,
        text: &str,
        side: u32,
    ) -> (Option<Rc<[Pixel]>>, Shown) {
        let slot = hash(slot);
        let key = hash((text, side));
        let last = self.slots.get(&slot).copied();
        let mut kept = |key: u64| {
            let entry = self.entries.get_mut(&key)?;
            entry.used = self.frame;
            match &entry.kept {
                Kept::Measured(pixels) => Some(Ok(pixels.clone())),
                Kept::Refused(reason) => Some(Err(reason.clone())),
                Kept::Drawn(_) => None,
            }
        };
        match kept(key) {
            Some(Ok(pixels)) => {
                self.slots
                    .insert(slot, (key, last.map_or(0, |(_, given)| given)));
                return (Some(pixels), Shown::Picture);
            }
            Some(Err(reason)) => return (None, Shown::Refused(reason)),
            None => {}
        }
        let older = last.and_then(|(last, _)| kept(last)?.ok());
        self.wishes.push(Wish {
            slot,
            key,
            text: text.into(),
            size: [side; 2],
            kind: Kind::Errors,
            background: [0.0; 3],
        });
        let shown = if older.is_some() {
            Shown::Older
        } else {
            Shown::Nothing
        };
        (older, shown)
    }
}
