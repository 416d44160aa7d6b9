//! Requests from outside the window: from scripts of the page (`handle`) and from the browser
//! itself.

use crate::asset::Asset;
use crate::intake::Incoming;
use crate::mesh_export::{Order, Taker};
use crate::picture::Image;
use crate::recording::VideoFormat;
use egui::Context;
use rats::Project;
use scene::Camera;
use std::cell::RefCell;
use std::rc::Rc;

/// Looks at the traced picture, if there is one.
pub type Viewer = Box<dyn FnOnce(Option<&Image>)>;

/// Takes the outcome of a request, with the reason if it was refused.
pub type Answer = Box<dyn FnOnce(Result<(), String>)>;

/// One wish from outside. The app carries it out at its next tick.
pub enum Request {
    /// Answer when the app runs.
    Ready(Box<dyn FnOnce()>),
    /// The fragment of the page's address changed.
    HashChanged,
    /// Open these texts; the answer is given when they are compiled.
    Load(Project, Answer),
    /// Take in files that the user dropped or chose.
    Files(Vec<Incoming>),
    /// Open an example of the gallery with its text, `None` if that did not come, and its images
    /// and meshes, which were fetched.
    Example(usize, Option<String>, Vec<Asset>),
    /// Sculpt the mesh of the model, as a PLY file, or say why there is none.
    SculptModel(Result<Vec<u8>, String>),
    /// The browser has these encoders of videos.
    Videos(Vec<VideoFormat>),
    /// Look at the scene with this camera; `None`: with the text's.
    SetCamera(Option<Camera>),
    /// Give the traced picture.
    Picture(Viewer),
    /// Give the file of a mesh of the model.
    Mesh(Order, Taker),
    /// Answer when the picture of the present text and camera is finished, or was stopped. It is
    /// refused, with the reason, while the lab keeps the picture waiting.
    Finished(Answer),
    /// Answer when nothing in the window changes its place any more. For tests.
    Still(Box<dyn FnOnce()>),
    /// Stop tracing.
    Cancel,
    /// Trace again.
    Again,
    /// Trace at this size; `None`: at the size the user chose. For tests.
    PictureSize(Option<[u32; 2]>),
    /// Stop the program unexpectedly. For tests.
    Panic,
}

/// Requests that wait for the next tick.
#[derive(Clone, Default)]
pub struct Requests {
    waiting: Rc<RefCell<Vec<Request>>>,
    ctx: Rc<RefCell<Option<Context>>>,
}

impl Requests {
    /// Sets the context that is woken by requests.
    pub fn attach(&self, ctx: &Context) {
        self.ctx.replace(Some(ctx.clone()));
    }

    /// Asks for something.
    pub fn ask(&self, request: Request) {
        self.waiting.borrow_mut().push(request);
        if let Some(ctx) = &*self.ctx.borrow() {
            ctx.request_repaint();
        }
    }

    /// All that was asked since the last call.
    #[must_use]
    pub fn take(&self) -> Vec<Request> {
        std::mem::take(&mut *self.waiting.borrow_mut())
    }
}
