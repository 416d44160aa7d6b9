//! State of the place: the open text, its mesh and view, and what it tells the page.

use crate::brush::{Brush, decimals, round};
use crate::document::Document;
use crate::drawn;
use crate::grip::Hand;
use egui::{ColorImage, Context, Pos2, Rect, TextureHandle, TextureId, TextureOptions, Vec2};
use glam::DVec3;
use mesh::TriangleMesh;
use pool::clock;
use sculpt::Loader;
use std::rc::Rc;
use viewport::{Found, Frame, Look, Surface, View};
use widgets::theme;

/// A wish of the place to the page.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// The strokes are another text now.
    Changed {
        /// The whole text.
        text: String,
        /// The mesh that it makes, if it is not too large for a model.
        mesh: Option<TriangleMesh>,
    },
    /// Show the mesh in the model as this.
    Grow {
        /// The surface that it becomes.
        flesh: Flesh,
        /// The mean length of its edges.
        edge: f64,
    },
    /// Bring the mesh onto measured points.
    Fit,
    /// Take back what was done before the first stroke.
    Undo,
    /// Do again what came after the last one.
    Redo,
    /// Go back to the text.
    Close,
    /// Begin another one.
    New,
    /// Take another palette.
    SetTheme(theme::Choice),
}

/// The surface that a sculpture becomes in a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flesh {
    /// The triangles themselves.
    Hard,
    /// The convolution surface of the triangles.
    Convolved,
    /// Metaballs around the triangles.
    Metaballs,
}

/// The page's state that the place needs.
#[derive(Clone, Copy, Debug)]
pub struct Outside {
    /// Seconds on the page's clock.
    pub now: f64,
    /// The chosen palette.
    pub theme: theme::Choice,
    /// Pressure of a pen, 0 … 1, while there is one.
    pub pressure: Option<f32>,
    /// The traced picture of the model, with its size in pixels, if it is of the present text.
    pub traced: Option<(TextureId, [u32; 2])>,
    /// Whether the model has errors, so that no picture comes.
    pub errors: usize,
    /// Whether the page has something to undo, and to redo.
    pub depth: [bool; 2],
}

/// The thing that the pointer turns beside the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turning {
    /// The eye goes around; the light stays with the mesh.
    View,
    /// The mesh turns in the light.
    Mesh,
    /// The tool.
    Tool,
    /// The light.
    Light,
}

/// Faces of the largest mesh that is handed to a model.
const MOST_FACES: usize = 200_000;
/// Pixels that are drawn at most, while something moves and at rest.
const MOST_PIXELS: [f64; 2] = [700_000.0, 2_600_000.0];
/// Seconds of rest before the picture is drawn finer.
const REST: f64 = 0.3;
/// Seconds that a frame may take before fewer pixels are drawn.
const SLOW: f64 = 0.03;

/// The place with an open text of strokes.
pub struct Sculpting {
    /// The text's name.
    pub name: String,
    pub(crate) document: Document,
    /// The text as the page has it.
    written: String,
    pub(crate) brush: Brush,
    pub(crate) view: View,
    /// The direction towards the light, in coordinates of the mesh.
    pub(crate) light: DVec3,
    pub(crate) turning: Turning,
    pub(crate) hand: Hand,
    pub(crate) wireframe: bool,
    pub(crate) planes: bool,
    pub(crate) sheet: bool,
    pub(crate) keys: bool,
    pub(crate) trouble: Option<String>,
    /// Decimals of lengths in the text, and the size of the mesh when it was opened.
    pub(crate) decimals: i32,
    pub(crate) size: f64,
    pub(crate) surface: Rc<Surface>,
    made: Option<(u64, u64)>,
    pub(crate) frame: Frame,
    pub(crate) texture: Option<TextureHandle>,
    drawn: Option<Drawn>,
    /// The time at which something moved last.
    moved: f64,
    /// The resolution while something moves, as a share of the full one.
    quality: f64,
    pub(crate) tool: Option<(Brush, Surface)>,
}

/// The things that a drawing depends on.
#[derive(Clone, PartialEq)]
struct Drawn {
    view: View,
    light: DVec3,
    made: (u64, u64),
    size: [usize; 2],
    tool: Option<(Brush, DVec3)>,
    wireframe: bool,
    planes: bool,
    dark: bool,
    symmetry: [bool; 3],
}

impl Sculpting {
    /// Opens a text of strokes.
    ///
    /// # Errors
    /// If it is wrong; the message names the line.
    pub fn open(name: &str, text: &str, load: Loader<'_>) -> Result<Self, String> {
        let document = Document::open(text, load)?;
        let [low, high] = drawn::bounds(document.clay());
        let size = (high - low).length();
        let decimals = decimals(size);
        Ok(Self {
            name: name.to_owned(),
            written: document.text(),
            document,
            brush: Brush::new(round(0.11 * size, decimals)),
            view: View::around([low, high]),
            light: DVec3::new(0.35, -0.65, 0.75),
            turning: Turning::View,
            hand: Hand::default(),
            wireframe: false,
            planes: true,
            sheet: false,
            keys: false,
            trouble: None,
            decimals,
            size,
            surface: Rc::default(),
            made: None,
            frame: Frame::new([1, 1]),
            texture: None,
            drawn: None,
            moved: 0.0,
            quality: 1.0,
            tool: None,
        })
    }

    /// Takes over a text that was changed outside. The view stays.
    pub fn sync(&mut self, text: &str, load: Loader<'_>) {
        if text == self.written {
            return;
        }
        text.clone_into(&mut self.written);
        match Document::open(text, load) {
            Ok(document) => {
                self.document = document;
                self.made = None;
                self.hand = Hand::default();
                self.trouble = None;
            }
            Err(trouble) => self.trouble = Some(trouble),
        }
    }

    /// Whether the page has another text than the place.
    #[must_use]
    pub fn is_behind(&self, text: &str) -> bool {
        text != self.written
    }

    /// Returns the numbers of vertices and faces of the mesh.
    #[must_use]
    pub fn counts(&self) -> [usize; 2] {
        let mesh = self.document.clay().mesh();
        [mesh.vertex_count(), mesh.face_count()]
    }

    /// Returns the numbers of strokes that can be undone and redone.
    #[must_use]
    pub fn depth(&self) -> [usize; 2] {
        self.document.depth()
    }

    /// The mean length of the edges.
    pub(crate) fn mean_edge(&self) -> f64 {
        let mesh = self.document.clay().mesh();
        let (mut sum, mut count) = (0.0, 0.0);
        for h in mesh.edges() {
            let ends = [mesh.origin(h), mesh.target(h)].map(|v| mesh.position(v));
            sum += ends[0].distance(ends[1]);
            count += 1.0;
        }
        sum / f64::max(count, 1.0)
    }

    /// Carries out a stroke, and tells the page.
    pub(crate) fn carry_out(&mut self, stroke: sculpt::Stroke, commands: &mut Vec<Command>) {
        let result = self.document.carry_out(stroke);
        self.report(result, commands);
    }

    /// Undoes the last stroke; what was done before the first one is the page's to take back.
    pub(crate) fn undo(&mut self, commands: &mut Vec<Command>) {
        if self.depth()[0] == 0 {
            commands.push(Command::Undo);
            return;
        }
        let result = self.document.undo().map(drop);
        self.report(result, commands);
    }

    /// Carries out the stroke again that was undone last; what came after the last one is the
    /// page's.
    pub(crate) fn redo(&mut self, commands: &mut Vec<Command>) {
        if self.depth()[1] == 0 {
            commands.push(Command::Redo);
            return;
        }
        let result = self.document.redo().map(drop);
        self.report(result, commands);
    }

    pub(crate) fn go_to(&mut self, strokes: usize, commands: &mut Vec<Command>) {
        let result = self.document.go_to(strokes);
        self.report(result, commands);
    }

    /// Tells the page that the text has changed, or the user why it has not.
    pub(crate) fn report(&mut self, result: Result<(), String>, commands: &mut Vec<Command>) {
        self.trouble = result.err();
        let text = self.document.text();
        if text != self.written {
            self.written.clone_from(&text);
            let is_small = self.counts()[1] <= MOST_FACES;
            let mesh = is_small.then(|| self.document.clay().to_triangles().ok());
            let mesh = mesh.flatten();
            commands.push(Command::Changed { text, mesh });
        }
    }

    /// Looks from a direction; the centre stays.
    pub fn look_from(&mut self, toward: DVec3, up: DVec3) {
        self.view.look_from(toward, up);
    }

    /// Sees all of the mesh, from where it is looked at.
    pub(crate) fn see_all(&mut self) {
        let all = View::around(drawn::bounds(self.document.clay()));
        self.view.center = all.center;
        self.view.distance = all.distance;
    }

    /// The surface at a place of the page, as it was drawn last.
    pub(crate) fn pick(&self, rect: Rect, at: Pos2) -> Option<Found> {
        let pixel = self.pixel(rect, at);
        self.frame.pick(&self.view, &self.surface, pixel)
    }

    /// The pixel of the drawing at a place of the page.
    pub(crate) fn pixel(&self, rect: Rect, at: Pos2) -> [f64; 2] {
        let [w, h] = self.frame.size().map(|side| side as f64);
        let share = (at - rect.min) / rect.size().max(Vec2::splat(1.0));
        [f64::from(share.x) * w, f64::from(share.y) * h]
    }

    /// Makes the surface anew if the mesh has changed.
    fn refresh(&mut self) {
        let now = (self.document.topology(), self.document.revision());
        if self.made == Some(now) {
            return;
        }
        let same = self.made.is_some_and(|(topology, _)| topology == now.0);
        drawn::update(Rc::make_mut(&mut self.surface), self.document.clay(), same);
        self.made = Some(now);
    }

    /// Draws into the texture if anything has changed.
    pub(crate) fn draw(&mut self, ctx: &Context, rect: Rect, dark: bool, now: f64) {
        self.refresh();
        let size = rect.size() * ctx.pixels_per_point();
        let pixels = f64::from(size.x * size.y).max(1.0);
        let longest = f64::from(size.max_elem()).max(1.0);
        let most = ctx.input(|input| input.max_texture_side).min(4096) as f64 / longest;
        // At rest twice as many on each side, which the screen averages.
        let [fine, coarse] = [
            (MOST_PIXELS[1] / pixels).min(4.0),
            self.quality * (MOST_PIXELS[0] / pixels).min(1.0),
        ]
        .map(|scale| {
            let scale = scale.min(most * most);
            [size.x, size.y].map(|side| (f64::from(side) * scale.sqrt()).round().max(1.0) as usize)
        });
        let mut rests = now - self.moved > REST;
        let symmetry = self.document.clay().symmetry();
        let mut wanted = Drawn {
            view: self.view,
            light: self.light,
            made: self.made.unwrap_or_default(),
            size: if rests { fine } else { coarse },
            tool: self.hand.shown.map(|at| (self.brush.clone(), at)),
            wireframe: self.wireframe,
            planes: self.planes,
            dark,
            symmetry,
        };
        let is_same = self.drawn.as_ref().is_some_and(|drawn| {
            let size = drawn.size;
            *drawn
                == Drawn {
                    size,
                    ..wanted.clone()
                }
        });
        let had = self.drawn.as_ref().map(|drawn| drawn.size);
        if is_same && self.texture.is_some() && (had == Some(wanted.size) || had == Some(fine)) {
            return;
        }
        if !is_same {
            // Something moves: soon is better than fine.
            self.moved = now;
            rests = false;
            wanted.size = coarse;
            ctx.request_repaint_after_secs(REST as f32 + 0.02);
        }
        let start = clock::stopwatch();
        if self.frame.size() != wanted.size {
            self.frame = Frame::new(wanted.size);
        }
        if let Some((brush, _)) = &wanted.tool
            && self.tool.as_ref().is_none_or(|(made, _)| made != brush)
        {
            let surface = drawn::tool(brush, self.decimals);
            self.tool = Some((brush.clone(), surface));
        }
        let mut spots = Vec::new();
        if let Some((_, at)) = wanted.tool {
            spots.push(at.as_vec3());
            for axis in (0..3).filter(|axis| symmetry[*axis]) {
                let mirrored = spots.clone().into_iter().map(|mut p| {
                    p[axis] = -p[axis];
                    p
                });
                let mirrored: Vec<_> = mirrored.collect();
                spots.extend(mirrored);
            }
        }
        let half = 0.56 * self.size as f32;
        let planes: Vec<(usize, f32)> = (0..3)
            .filter(|axis| symmetry[*axis] && self.planes)
            .map(|axis| (axis, half))
            .collect();
        let tool = self.tool.as_ref().filter(|_| !spots.is_empty());
        let look = Look {
            light: self.light.as_vec3(),
            wireframe: self.wireframe,
            background: if dark {
                [0.10, 0.112, 0.135]
            } else {
                [0.80, 0.815, 0.83]
            },
            edge: if dark {
                [0.05, 0.06, 0.09]
            } else {
                [0.1, 0.1, 0.14]
            },
            accent: if dark {
                [0.33, 0.68, 0.98]
            } else {
                [0.12, 0.42, 0.78]
            },
            tool: tool.map(|(_, surface)| (surface, &spots[..])),
            planes: &planes,
        };
        self.frame.draw(&self.view, &self.surface, &look);
        let image = ColorImage::from_rgba_unmultiplied(self.frame.size(), self.frame.rgba());
        match &mut self.texture {
            Some(texture) => texture.set(image, TextureOptions::LINEAR),
            None => {
                self.texture = Some(ctx.load_texture("sculpture", image, TextureOptions::LINEAR));
            }
        }
        let took = clock::stopwatch() - start;
        if !rests {
            // Fewer pixels where the machine is slow, and back.
            let factor = if took > SLOW { 0.7 } else { 1.15 };
            self.quality = (self.quality * factor).clamp(0.15, 1.0);
        }
        self.drawn = Some(wanted);
    }
}
