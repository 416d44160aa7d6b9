//! Wishes of the user, grouped by the panel that carries them out. Widgets only read the state and
//! list wishes; [`crate::app::App`] has them carried out after the frame.

use crate::notice::Notice;
use crate::page::Dialog;

pub use crate::export::MeshWish;
pub use crate::film::FilmWish;
pub use crate::fit::FitWish;
pub use crate::lessons::LabWish;
pub use crate::sculpt::SculptWish;
pub use crate::settings::Setting;
pub use crate::stage::ViewWish;
pub use crate::text::TextWish;
pub use crate::tray::TrayWish;
pub use crate::works::WorkWish;

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
