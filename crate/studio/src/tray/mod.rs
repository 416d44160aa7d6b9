//! The tray below the picture: the results of commands of the TOOLS group, which work on pictures.
//!
//! The jobs of a text run when it has no errors and they, the images that they read or the traced
//! picture have changed. They run in small steps, a few milliseconds in each frame, and wait for
//! the traced picture only if they read it. The tray's contents stay until a new run is complete.

pub mod item;
pub mod large;
pub mod strip;
pub mod wish;

use crate::page::{Moment, Page};
use crate::panel::Panel;
use crate::screen;
use crate::wish::{Dialog, TextWish, TrayWish, Wishes, WorkWish};
use darkroom::{Bench, Done, Step};
use document::asset::Asset;
use document::desk::Desk;
use document::intake::Incoming;
use document::picture::Image;
use document::session::Session;
use egui::{Context, Ui};
use item::{Content, Film, Item};
use large::Large;
use rats::Tool;
use std::ops::Range;
use std::sync::Arc;

/// Seconds without an edit before the jobs begin, so that no half-typed name is looked for.
const QUIET: f64 = 0.3;
/// Seconds of work in a frame of the page after which no further step begins.
const SLICE: f64 = 0.008;

/// Inputs of the jobs besides the traced picture.
#[derive(Clone, Default, PartialEq)]
struct Order {
    tools: Vec<Tool>,
    /// The images that the jobs read.
    assets: Vec<Asset>,
    /// The name of the traced picture, and whether it is to be saved.
    picture: (String, bool),
    /// Whether the jobs read the traced picture.
    reads_picture: bool,
}

impl Order {
    fn of(session: &Session) -> Self {
        let compiled = session.compilation();
        let picture = (compiled.output.file(), compiled.output.saved);
        let mut read: Vec<&str> = compiled.tools.iter().flat_map(Tool::reads).collect();
        field::heap_sort(&mut read, |a, b| a < b);
        read.dedup();
        let assets = session.assets().iter();
        Self {
            assets: assets
                .filter(|asset| read.binary_search(&&*asset.name).is_ok())
                .cloned()
                .collect(),
            reads_picture: picture.1 && read.binary_search(&&*picture.0).is_ok(),
            picture,
            tools: compiled.tools.clone(),
        }
    }
}

/// Key of a traced picture: the session's generation and the size.
type PictureKey = (u64, [u32; 2]);

/// The jobs of the open text and their results.
#[derive(Default)]
pub struct Tray {
    /// The state of the work at the last tick: the text's revision and the frame of the film.
    seen: Option<(u64, u32)>,
    /// Time at which its jobs may begin, seconds.
    due: Option<f64>,
    order: Order,
    /// The traced picture that the jobs have read.
    drawn: Option<PictureKey>,
    run: Option<Run>,
    items: Vec<Item>,
    /// Whether only the tray's head is shown.
    pub folded: bool,
    large: Large,
}

/// Jobs that are running, with the results so far.
struct Run {
    bench: Bench<Desk>,
    items: Vec<Item>,
    waits: bool,
}

impl Tray {
    /// Carries out a wish.
    pub fn act(&mut self, wish: TrayWish, page: &mut Page, at: &Moment<'_>) {
        match wish {
            TrayWish::Show(index) => {
                self.large.open = index;
                page.dialog = Some(Dialog::Result);
            }
            TrayWish::Save(index) => {
                if let Some(film) = self.items().get(index).and_then(Item::film) {
                    // The browser makes a file of the last part of the name.
                    let name = film.name.rsplit(['/', '\\']).next().unwrap_or_default();
                    browser::download(name, film.mime(), &film.bytes);
                    page.tell(format!("Saved {name}, {}.", film.facts()), at.now);
                }
            }
            TrayWish::Find(index) => {
                if let Some((file, range)) = self.place_of(index, &page.work.session) {
                    page.dialog = None;
                    page.wish(TextWish::Jump { file, range });
                }
            }
            TrayWish::Keep(index) => {
                if let Some(film) = self.items().get(index).and_then(Item::film) {
                    // A free name: an image of the work is not replaced. The text stays in view.
                    let file = Incoming {
                        name: page.work.session.free_name(&film.name),
                        bytes: Ok(film.bytes.to_vec()),
                    };
                    page.wish(WorkWish::Take {
                        files: vec![file],
                        show: false,
                    });
                }
            }
            TrayWish::Fold(folded) => self.folded = folded,
        }
    }

    /// Whether there is anything to show.
    #[must_use]
    pub fn is_used(&self) -> bool {
        !self.order.tools.is_empty()
    }

    /// Returns the results. Those of the first run appear one by one.
    #[must_use]
    pub fn items(&self) -> &[Item] {
        match &self.run {
            Some(run) if self.items.is_empty() => &run.items,
            _ => &self.items,
        }
    }

    /// Shows the result that was opened, in all of `ui`. `kept` are the images of the work.
    pub fn show_large(&mut self, ui: &mut Ui, kept: &[Asset], wishes: &mut Wishes) {
        // As `items`, which would borrow all of the tray.
        let items = match &self.run {
            Some(run) if self.items.is_empty() => &run.items,
            _ => &self.items,
        };
        let (size, now) = (ui.available_size(), browser::now(ui.ctx()));
        self.large.show(ui, size, items, kept, now, wishes);
    }

    /// Returns file and bytes of the command that made a result, if the text is still the same.
    #[must_use]
    pub fn place_of(&self, index: usize, session: &Session) -> Option<(usize, Range<usize>)> {
        let compiled = session.compilation();
        let item = self.items().get(index)?;
        let origin = compiled.tool_origins.get(item.job)?;
        // Results shown while new ones are made may be of an older text.
        let present = self.run.is_none() || self.items.is_empty();
        let same = session.is_compiled() && compiled.tools == self.order.tools;
        (present && same).then_some((
            origin.file as usize,
            origin.start as usize..origin.end as usize,
        ))
    }

    /// Returns the progress in a few words; empty when all jobs are done.
    #[must_use]
    pub fn state(&self) -> String {
        match &self.run {
            Some(run) if run.waits => String::from("waiting for the picture"),
            Some(run) => format!("{} of {}", run.bench.finished(), run.bench.count()),
            None => String::new(),
        }
    }

    /// Goes on with the jobs. `picture` is the traced picture if it is finished, with the session's
    /// generation.
    fn go_on(
        &mut self,
        ctx: &Context,
        session: &Session,
        picture: Option<(u64, &Image)>,
        now: f64,
    ) {
        if !session.is_compiled() {
            return;
        }
        let seen = (session.revision(), session.film_frame());
        if self.seen != Some(seen) {
            // Nobody is typing yet in a work that was just opened.
            let quiet = if self.seen.is_some() { QUIET } else { 0.0 };
            self.seen = Some(seen);
            self.due = (Order::of(session) != self.order).then_some(now + quiet);
        }
        if self.due.is_some_and(|due| now >= due) {
            self.due = None;
            let first = self.run.is_none() && self.items.is_empty();
            // While the text has a mistake the results stay, as the picture does.
            if session.errors() == 0 || first {
                let order = Order::of(session);
                if order != self.order {
                    self.order = order;
                    self.drawn = None;
                    self.begin();
                }
            }
        }
        if self.order.reads_picture
            && let Some((generation, image)) = picture
        {
            let drawn = (generation, image.size);
            if self.drawn != Some(drawn) {
                if self.drawn.is_some() || self.run.is_none() {
                    self.begin();
                }
                self.drawn = Some(drawn);
                if let Some(run) = &mut self.run {
                    run.bench.shelf_mut().put_picture(image);
                }
            }
        }
        let Some(run) = &mut self.run else {
            return;
        };
        if !run.go_on(ctx) {
            self.items = std::mem::take(&mut run.items);
            self.run = None;
            ctx.request_repaint();
        } else if !run.waits {
            ctx.request_repaint();
        }
    }

    /// Begins the jobs anew.
    fn begin(&mut self) {
        if self.order.tools.is_empty() {
            self.run = None;
            self.items.clear();
            return;
        }
        let order = self.order.clone();
        let picture = order.picture.0.clone();
        let mut bench = Bench::new(Desk::new(order.assets, order.picture), order.tools);
        bench.reserve(&picture);
        self.run = Some(Run {
            bench,
            items: Vec::new(),
            waits: false,
        });
    }
}

impl Panel for Tray {
    /// Shows the strip below the picture.
    fn show(&mut self, _page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
        let narrow = screen::is_narrow(ui.ctx());
        strip::show(ui, self, narrow, wishes);
    }

    fn tick(&mut self, page: &mut Page, at: &Moment<'_>) {
        if page.is_lab_open {
            return;
        }
        let session = &page.work.session;
        let finished = page.renderer.image().filter(|_| page.is_finished());
        let picture = finished.map(|image| (session.generation(), image));
        self.go_on(at.ctx, session, picture, at.now);
    }

    fn wait(&self, page: &Page, now: f64) -> Option<f64> {
        let due = self.due.filter(|_| !page.is_lab_open)?;
        Some((due - now).max(0.0))
    }

    fn forget(&mut self, _page: &mut Page, _ctx: &Context) {
        *self = Self {
            folded: self.folded,
            ..Self::default()
        };
    }
}

impl Run {
    /// Works for [`SLICE`] seconds. Returns whether there is more to do.
    fn go_on(&mut self, ctx: &Context) -> bool {
        let start = pool::clock::stopwatch();
        self.waits = false;
        loop {
            let has_decoded = self.items.iter_mut().any(|item| match &mut item.content {
                Content::File(film) => film.decode(ctx),
                _ => false,
            });
            if !has_decoded {
                let Some(tool) = self.bench.tool() else {
                    return false;
                };
                if self.bench.shelf().waits_for(&tool.reads()) {
                    self.waits = true;
                    return true;
                }
                let (job, command) = (self.bench.finished(), tool.command());
                if let Some(Step::Finished(finished)) = self.bench.step() {
                    self.take(job, command, finished);
                }
            }
            if pool::clock::stopwatch() - start > SLICE {
                return true;
            }
        }
    }

    /// Puts the results of a job, or the reason why it failed, on the tray.
    fn take(&mut self, job: usize, command: &'static str, finished: Result<Done, String>) {
        let item = |message: String, content| Item {
            job,
            command,
            message,
            content,
        };
        match finished {
            Err(sentence) => self.items.push(item(sentence, Content::Refused)),
            Ok(done) if done.files.is_empty() => {
                self.items.push(item(done.said, Content::Sentence));
            }
            Ok(done) => {
                for name in done.files {
                    let Some(bytes) = self.bench.shelf().find(&name) else {
                        continue;
                    };
                    // A picture that is written and shown after that is listed once.
                    let mut films = self.items.iter().filter_map(Item::film);
                    if films.any(|old| old.name == name && Arc::ptr_eq(&old.bytes, &bytes)) {
                        continue;
                    }
                    let look = None;
                    let film = Film { name, bytes, look };
                    self.items
                        .push(item(done.said.clone(), Content::File(film)));
                }
            }
        }
    }
}
