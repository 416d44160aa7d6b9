//! Wishes of the user, grouped by the panel that carries them out. Widgets only read the state and
//! list wishes; [`crate::app::App`] has them carried out after the frame.

pub use crate::export::wish::MeshWish;
pub use crate::film::wish::{FilmWish, Quality};
pub use crate::fit::wish::FitWish;
pub use crate::lessons::wish::LabWish;
pub use crate::sculpt::wish::SculptWish;
pub use crate::settings::Setting;
pub use crate::stage::wish::ViewWish;
pub use crate::text::wish::TextWish;
pub use crate::tray::wish::TrayWish;
pub use crate::works::wish::WorkWish;

/// A wish of the user.
#[derive(Clone, Debug, PartialEq)]
pub enum Wish {
    /// About the texts, images and meshes of the work.
    Text(TextWish),
    /// About the picture and the camera.
    View(ViewWish),
    /// About the film of an animated work.
    Film(FilmWish),
    /// About the results of the text's jobs on pictures.
    Tray(TrayWish),
    /// About the model as a mesh.
    Mesh(MeshWish),
    /// About the fit of a mesh.
    Fit(FitWish),
    /// About whole works.
    Work(WorkWish),
    /// About the lab.
    Lab(LabWish),
    /// About sculptures.
    Sculpt(SculptWish),
    /// About the page itself.
    Set(Setting),
    /// Open a window over the page.
    Open(Dialog),
    /// Show a command in the reference; with an empty name all of them.
    Manual(String),
    /// Close the window over the page, or else the notice.
    Close,
    /// Say that something was done.
    Tell(String),
    /// Show a notice.
    Notice(Box<Notice>),
}

macro_rules! groups {
    ($($group:ident($wish:ident),)*) => {
        $(impl From<$wish> for Wish {
            fn from(wish: $wish) -> Self {
                Self::$group(wish)
            }
        })*
    };
}

groups! {
    Text(TextWish),
    View(ViewWish),
    Film(FilmWish),
    Tray(TrayWish),
    Mesh(MeshWish),
    Fit(FitWish),
    Work(WorkWish),
    Lab(LabWish),
    Sculpt(SculptWish),
    Set(Setting),
}

impl From<Notice> for Wish {
    fn from(notice: Notice) -> Self {
        Self::Notice(Box::new(notice))
    }
}

/// A window over the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialog {
    /// Examples and own works.
    Gallery,
    /// Earlier versions of the open work.
    Versions,
    /// The help.
    Help,
    /// A result of the text's jobs on pictures.
    Result,
    /// Choices of how to begin a sculpture.
    Sculpt,
    /// The model as a mesh.
    Mesh,
}

/// A message across the top of the picture: something that went wrong or was done, perhaps with
/// buttons.
#[derive(Clone, Debug, PartialEq)]
pub struct Notice {
    /// The text.
    pub text: String,
    /// Whether something went wrong.
    pub bad: bool,
    /// Buttons: texts and wishes.
    pub actions: Vec<(String, Wish)>,
    /// Time at which the message disappears by itself, seconds on the app's clock.
    pub until: Option<f64>,
}

impl Notice {
    /// Makes a message about something that was done. It disappears after six seconds.
    #[must_use]
    pub fn success(text: impl Into<String>, now: f64) -> Self {
        Self {
            text: text.into(),
            bad: false,
            actions: Vec::new(),
            until: Some(now + 6.0),
        }
    }

    /// Makes a message about something that went wrong. It stays until it is closed.
    #[must_use]
    pub fn trouble(text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            bad: true,
            actions: Vec::new(),
            until: None,
        }
    }

    /// Adds a button.
    #[must_use]
    pub fn with_button(mut self, text: &str, wish: impl Into<Wish>) -> Self {
        self.actions.push((text.to_owned(), wish.into()));
        self
    }
}

/// Wishes in their order.
#[derive(Default)]
pub struct Wishes(Vec<Wish>);

impl Wishes {
    /// Adds a wish.
    pub fn push(&mut self, wish: impl Into<Wish>) {
        self.0.push(wish.into());
    }

    /// Adds a wish before all others.
    pub fn push_first(&mut self, wish: impl Into<Wish>) {
        self.0.insert(0, wish.into());
    }

    /// Makes one step of undo of a drag: it begins before the drag's first change, and ends after
    /// the last. `dragged` is whether the drag went on before.
    pub fn hold_while(&mut self, drags: bool, dragged: &mut bool) {
        if drags && !*dragged {
            self.push_first(TextWish::Hold);
        } else if !drags && *dragged {
            self.push(TextWish::Release);
        }
        *dragged = drags;
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl<W: Into<Wish>> Extend<W> for Wishes {
    fn extend<I: IntoIterator<Item = W>>(&mut self, wishes: I) {
        self.0.extend(wishes.into_iter().map(Into::into));
    }
}

impl IntoIterator for Wishes {
    type Item = Wish;
    type IntoIter = std::vec::IntoIter<Wish>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}
