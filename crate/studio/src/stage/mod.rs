//! The picture's place: the traced picture and what stands in for it, the camera, and the hands and
//! the pencil that work on it.

pub mod draft;
mod handles;
pub mod hands;
pub mod lamp;
mod live;
pub mod pencil;
pub mod view;
pub mod wish;

use crate::page::{self, Moment, Page};
use crate::panel::Panel;
use crate::render::Phase;
use crate::settings::Show;
use crate::thumbnail::Thumbnail;
use crate::wish::{TextWish, ViewWish, Wishes, WorkWish};
use crate::{places, screen};
use document::{examples, picture, work};
use draft::Draft;
use egui::{Color32, Context, Painter, Rect, TextureId, Ui, Vec2};
use egui_wgpu::RenderState;
use glam::DVec3;
use hands::Hands;
use live::LiveCells;
use pencil::{Pencil, tool::Tool};
use pool::Tools;
use rats::TextEdit;
use sketch::Sight;
use std::rc::Rc;
use view::{Grasp, Scenery};

/// The stand-in for a traced picture that is not there yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StandIn {
    /// The surface as the card traces it.
    Draft {
        /// Frames a second, where something moved.
        fps: Option<u32>,
        /// The names of the bodies that it has meshes of instead.
        meshed: Rc<[String]>,
    },
    /// The picture as it was traced when the example was made.
    Kept,
}

/// The picture of an example, traced when it was made, as long as nobody changes the example or the
/// view.
struct Kept {
    /// Address of the file beside the page.
    path: &'static str,
    /// The session's revision that it shows.
    revision: u64,
    picture: Option<Thumbnail>,
}

impl Kept {
    /// Returns the picture; `None` if it has not come or does not fit.
    fn texture(&mut self, page: &Page, ui: &Ui) -> Option<TextureId> {
        let session = &page.work.session;
        let fits = self.revision == session.revision() && session.user_camera().is_none();
        let is_wanted = page.settings.show != Show::Draft;
        if !fits || !is_wanted {
            return None;
        }
        let path = self.path;
        let picture = self
            .picture
            .get_or_insert_with(|| Thumbnail::fetch(ui, path));
        picture.arrive(ui);
        match picture {
            Thumbnail::Here(texture) => Some(texture.id()),
            _ => None,
        }
    }
}

impl StandIn {
    /// The name, for the status line and for scripts.
    #[must_use]
    pub fn id(&self) -> &'static str {
        match self {
            Self::Draft { .. } => "draft",
            Self::Kept => "made before",
        }
    }
}

/// The picture and everything on it.
pub struct Stage {
    draft: Option<Draft>,
    /// [`document::session::Session::shape`] of the scene whose picture was traced last.
    traced: Option<u64>,
    /// The picture of an example that takes long.
    kept: Option<Kept>,
    /// The surface as the draft takes it.
    live: LiveCells,
    /// The stand-in for the traced picture on the screen.
    pub stand_in: Option<StandIn>,
    /// Handles of the chosen shape.
    pub hands: Hands,
    /// The tool for drawing.
    pub pencil: Pencil,
    /// The file and byte of the editor's caret. The layout keeps it up to date.
    pub caret: Option<(usize, usize)>,
    /// Measured points to draw over the picture, and whether a fit left them out. The layout keeps
    /// them up to date.
    pub points: Vec<(DVec3, bool)>,
    /// The picture's place in device pixels.
    pub place: [f32; 2],
}

impl Stage {
    /// Makes a place without a picture. `state` is there when the window's device can draw drafts.
    #[must_use]
    pub fn new(state: Option<RenderState>, tools: Tools) -> Self {
        Self {
            draft: state.map(Draft::new),
            kept: None,
            traced: None,
            live: LiveCells::new(tools),
            stand_in: None,
            hands: Hands::default(),
            pencil: Pencil::default(),
            caret: None,
            points: Vec::new(),
            place: [640.0, 480.0],
        }
    }

    /// Carries out a wish.
    pub fn act(&mut self, wish: ViewWish, page: &mut Page, at: &Moment<'_>) {
        let session = &mut page.work.session;
        match wish {
            ViewWish::SetCamera(camera) => {
                session.set_camera(camera);
                page.settings.turned = true;
                if camera.is_some() {
                    self.live.want();
                }
            }
            ViewWish::ShowKept(path) => {
                let revision = session.revision();
                self.kept = Some(Kept {
                    path,
                    revision,
                    picture: None,
                });
            }
            ViewWish::ShowAll => {
                if let Some(scene) = session.scene() {
                    let camera = preview::orbit::frame(scene, session.camera(), session.frame());
                    session.set_camera(Some(camera));
                }
            }
            ViewWish::Follow => self.live.want(),
            ViewWish::LetGo => self.hands.clear(),
            ViewWish::SetTool(tool) => self.take_tool(tool, page, at.ctx),
            ViewWish::Cancel => page.renderer.cancel(),
            ViewWish::Again => {
                if std::mem::take(&mut page.is_refused) {
                    page.notice = None;
                }
                page.renderer.again(at.now);
            }
            ViewWish::Save => save(page, at.now),
        }
    }

    /// Takes a drawing tool in hand, or lays it down. Drawing begins on an empty page if the open
    /// work is an example or a link without a skeleton.
    fn take_tool(&mut self, tool: Option<Tool>, page: &mut Page, ctx: &Context) {
        let begins = tool.is_some() && self.pencil.tool().is_none();
        if tool.is_some() {
            self.live.want();
        }
        self.pencil.take(tool);
        self.hands.let_go();
        let session = &mut page.work.session;
        if !begins || !session.is_compiled() {
            return;
        }
        let is_one = session.project().files.len() == 1 && session.assets().is_empty();
        if is_one && is_blank(session.text(0)) {
            session.set_camera(None);
            let text = sketch::page::fresh(page::ratio(ctx));
            page.wish(TextWish::step(TextEdit::whole(0, text)));
        } else if matches!(page.work.origin, work::Origin::Example | work::Origin::Link)
            && !Pencil::has_skeleton(session)
        {
            page.wish(WorkWish::DrawNew);
        }
    }

    /// Draws the frame that a film waits for.
    fn shoot(&mut self, page: &mut Page) {
        let Some(shot) = page.shot.as_mut().filter(|shot| shot.image.is_none()) else {
            return;
        };
        let (session, is_finer) = (&page.work.session, page.screen.rest == 0.0);
        if !session.is_compiled() {
            return;
        }
        let made = self.live.latest(session.shape(), false);
        shot.image = match (&mut self.draft, made) {
            _ if session.errors() > 0 => Some(Err("The text of a frame has mistakes.".into())),
            (Some(draft), Some(made)) => draft.shoot(made, session.camera(), shot.size, is_finer),
            (Some(_), None) if !self.live.is_hopeless(session) => None,
            _ => Some(Err("The draft of a frame takes too long.".into())),
        };
    }

    /// Whether scenes are packed for the card.
    fn packs(&self, page: &Page) -> bool {
        let shows = page.settings.show != Show::Traced;
        self.draft.is_some() && shows && !page.is_refused && !page.is_reading()
    }

    /// Returns the texture of the stand-in for the traced picture, if one is needed.
    fn stand_in(&mut self, page: &Page, ui: &Ui, now: f64) -> Option<TextureId> {
        let ctx = ui.ctx();
        let (session, slow) = (&page.work.session, page.screen.rest > 0.0);
        if slow && page.renderer.is_near(view::SOON, now) {
            // If it does not come by then, the draft is drawn.
            ctx.request_repaint_after_secs(view::SOON as f32);
        }
        let mut stand_in = StandIn::Kept;
        // From then on there is a true picture as fine, or it is not wanted.
        if page.renderer.is_whole() || page.renderer.phase() == Phase::Cancelled {
            self.kept = None;
        }
        if page.is_fresh() {
            self.traced = Some(session.shape());
        }
        let shows = needs(page, now, slow, ui.style().animation_time > 0.0);
        let kept = self.kept.as_mut().and_then(|kept| kept.texture(page, ui));
        let texture = if kept.is_some() {
            kept
        } else if page.is_refused && slow {
            None
        } else if shows {
            self.draft.as_mut().and_then(|draft| {
                let shape = session.shape();
                let made = self.live.latest(shape, self.traced != Some(shape))?;
                let texture = draft.texture(ctx, made, session.camera(), self.place);
                stand_in = StandIn::Draft {
                    fps: draft.fps,
                    meshed: made.meshed.clone(),
                };
                texture
            })
        } else {
            None
        };
        let stand_in = texture.map(|_| stand_in);
        if self.stand_in != stand_in {
            self.stand_in = stand_in;
            // The status line, which names it, was drawn before.
            ctx.request_repaint();
        }
        texture
    }
}

/// Whether the draft is to be seen.
fn needs(page: &Page, now: f64, slow: bool, fades: bool) -> bool {
    let session = &page.work.session;
    view::needs_draft(
        page.settings.show,
        session,
        &page.renderer,
        slow,
        fades,
        now,
    )
}

impl Panel for Stage {
    fn show(&mut self, page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
        let session = &page.work.session;
        let narrow = screen::is_small(ui.ctx());
        // A small window needs its room for the picture.
        let margin = if narrow {
            0.0
        } else {
            (0.03 * ui.max_rect().height()).min(18.0)
        };
        let scale = ui.ctx().pixels_per_point();
        let rect = view::fit(ui.max_rect().shrink(margin), session.frame(), scale);
        // Sizes are taken in whole pixels, so that a picture is not traced anew for a rounding
        // error.
        self.place = [
            (rect.width() * scale).round(),
            (rect.height() * scale).round(),
        ];
        places::note(ui.ctx(), "picture", rect);
        let now = browser::now(ui.ctx());
        let draft = self.stand_in(page, ui, now);
        let is_kept = self.stand_in == Some(StandIn::Kept);
        let draws = self.pencil.tool().is_some();
        let scenery = Scenery {
            session,
            renderer: &page.renderer,
            draft,
            show: page.settings.show,
            now,
            is_kept,
            hint: !page.settings.turned,
            touch: page.screen.touch == Some(true),
            old: session.has_old_scene() && session.shows_errors(),
            round: if narrow { 0.0 } else { 5.0 },
            grasp: Grasp {
                draws,
                wheel: self.pencil.takes_wheel(),
                pinch: self.pencil.takes_pinch(),
            },
        };
        let picture = view::show(ui, rect, &scenery, wishes);
        if picture.contains_pointer() {
            // So that the draft is there when it is taken hold of.
            self.live.want();
        }
        let sight = Sight::new(&session.camera(), rect);
        points(
            &self.points,
            &ui.painter().with_clip_rect(rect),
            &sight,
            rect,
        );
        let (covered, touch) = (page.dialog.is_some(), page.screen.touch == Some(true));
        if draws {
            let around = pencil::Around {
                session,
                covered,
                late: draft.is_none() && !page.is_fresh(),
                touch,
            };
            self.pencil.show(ui, rect, &picture, &around, wishes);
            if let Some(pair) = self.pencil.alternative(session)
                && session.is_enabled()
                && pencil::bar::turn(ui, rect, pair)
            {
                self.pencil.turn(session, wishes);
            }
            return;
        }
        let around = hands::Around {
            session,
            caret: self.caret,
            covered,
            touch,
        };
        self.hands.show(ui, rect, &picture, &around, wishes);
        if !session.is_enabled() || covered {
            return;
        }
        let is_well = session.is_compiled() && session.errors() == 0;
        if is_well && lamp::is_dark(&session.compilation().scene) {
            lamp::show(ui, rect, session, wishes);
        }
        pencil::bar::start(ui, rect, wishes);
    }

    fn tick(&mut self, page: &mut Page, at: &Moment<'_>) {
        if page.is_reading() {
            self.live.give_way();
        }
        let is_drawn = needs(page, at.now, false, true);
        if page.settings.show == Show::Draft {
            self.live.want();
        }
        let is_shot = page.shot.is_some() && self.draft.is_some();
        if is_shot {
            self.live.want();
        }
        let session = &page.work.session;
        if self.packs(page) || (is_shot && !page.is_reading()) {
            self.live
                .tick(session, at.now, is_drawn || is_shot, rests(page));
        }
        self.shoot(page);
        let session = &page.work.session;
        let is_draft = matches!(self.stand_in, Some(StandIn::Draft { .. }));
        let is_present = self.live.latest(session.shape(), false).is_some();
        page.drafted = (is_draft && is_present).then(|| session.shape());
        page.screen.refusal = self.draft.as_ref().and_then(|draft| draft.refusal.clone());
    }

    fn wait(&self, page: &Page, now: f64) -> Option<f64> {
        if page.shot.is_some() {
            return Some(0.01);
        }
        let wait = self.live.wait(&page.work.session, now);
        wait.filter(|_| self.packs(page) && rests(page))
    }

    fn forget(&mut self, _page: &mut Page, _ctx: &Context) {
        self.kept = None;
        self.traced = None;
        self.live.forget();
        if let Some(draft) = &mut self.draft {
            draft.forget();
        }
        self.hands.clear();
        self.pencil.clear();
    }
}

/// Whether a text is empty, or that of a new work.
fn is_blank(text: &str) -> bool {
    text.trim().is_empty() || text.trim() == examples::BLANK.trim()
}

/// Whether neither a picture nor a file keeps workers busy.
fn rests(page: &Page) -> bool {
    let is_tracing = matches!(page.renderer.phase(), Phase::Waiting | Phase::Tracing);
    !is_tracing && !page.is_reading()
}

/// Draws measured points over the picture.
fn points(points: &[(DVec3, bool)], painter: &Painter, sight: &Sight, rect: Rect) {
    for (point, left_out) in points {
        if let Some(at) = sight.screen(*point).filter(|at| rect.contains(*at)) {
            let square = Rect::from_center_size(at, Vec2::splat(2.2));
            let colour = if *left_out {
                Color32::from_rgb(255, 150, 60)
            } else {
                Color32::from_rgb(90, 200, 255)
            };
            painter.rect_filled(square, 0.0, colour);
        }
    }
}

/// Writes the picture to a file.
fn save(page: &mut Page, now: f64) {
    let Some(image) = page.renderer.image() else {
        page.warn("There is no picture to save yet.");
        return;
    };
    let [width, height] = image.size;
    let png = picture::png(image).map_err(|error| error.to_string());
    if let Some(bytes) = page.accept(png) {
        let name = format!("{}.png", work::file_stem(&page.work.name));
        browser::download(&name, "image/png", &bytes);
        page.tell(format!("Saved {name}, {width} × {height} pixels."), now);
    }
}
