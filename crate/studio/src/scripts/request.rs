//! Requests from outside the window: from scripts of the page (`handle`) and from the browser
//! itself.

use crate::wish::{Wish, WorkWish};
use browser::recording::VideoFormat;
use document::intake::Incoming;
use document::mesh_export::{Order, Taker};
use document::picture::Image;
use egui::Context;
use rats::Project;
use scene::Camera;
use std::cell::RefCell;
use std::rc::Rc;

/// A function that looks at the traced picture, if there is one.
pub type Viewer = Box<dyn FnOnce(Option<&Image>)>;

/// A function that takes the outcome of a request, with the reason if it was refused.
pub type Answer = Box<dyn FnOnce(Result<(), String>)>;

/// A message of the browser's storage.
pub enum Told {
    /// The work of this id is written by this tab alone.
    Mine(String),
    /// The work of this id is written by another tab.
    Theirs(String),
    /// Something could not be written, for this reason.
    Refused(String),
}

/// A wish from outside. The app carries it out at its next tick.
pub enum Request {
    /// Answer when the app runs.
    Ready(Box<dyn FnOnce()>),
    /// Follow the fragment of the page's address, which changed.
    HashChanged,
    /// Open these texts, and answer when they are compiled.
    Load(Project, Answer),
    /// Take in files of a script.
    Files(Vec<Incoming>),
    /// Carry out a wish.
    Wish(Wish),
    /// Carry out the wish that something leads to which was begun a while ago, unless another work
    /// was opened meanwhile.
    Late {
        /// [`document::work::Work::number`] of the work that it was begun for.
        of: u64,
        /// The subject of a sentence about it: “The mesh of the model”.
        what: String,
        /// The wish.
        wish: Wish,
    },
    /// Heed a message of the browser's storage.
    Storage(Told),
    /// Take note of the browser's encoders of videos.
    Videos(Vec<VideoFormat>),
    /// Look at the scene with this camera, or with that of the text if it is `None`.
    SetCamera(Option<Camera>),
    /// Give the traced picture.
    Picture(Viewer),
    /// Give the file of a mesh of the model.
    Mesh(Order, Taker),
    /// Answer when the picture of the present text and camera is finished, or was stopped. It is
    /// refused, with the reason, while the lab keeps the picture waiting.
    Finished(Answer),
    /// Answer when no widget moves any more. For tests.
    Still(Box<dyn FnOnce()>),
    /// Trace at this size, or at the size that the user chose if it is `None`. For tests.
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
    /// Sets the context that requests wake.
    pub fn attach(&self, ctx: &Context) {
        self.ctx.replace(Some(ctx.clone()));
    }

    /// Adds a request and wakes the app.
    pub fn ask(&self, request: Request) {
        self.waiting.borrow_mut().push(request);
        self.wake();
    }

    /// Wakes the app.
    pub fn wake(&self) {
        if let Some(ctx) = &*self.ctx.borrow() {
            ctx.request_repaint();
        }
    }

    /// Takes the requests since the last call.
    #[must_use]
    pub fn take(&self) -> Vec<Request> {
        std::mem::take(&mut *self.waiting.borrow_mut())
    }

    /// Returns a function that asks for files to be taken into the work of this number.
    pub fn taker(&self, of: u64) -> impl FnOnce(Vec<Incoming>) + 'static {
        let requests = self.clone();
        move |files| {
            let what = match &files[..] {
                [file] => format!("The file {}", file.name),
                _ => format!("The {} files", files.len()),
            };
            let wish = WorkWish::Take { files, show: true }.into();
            requests.ask(Request::Late { of, what, wish });
        }
    }
}
