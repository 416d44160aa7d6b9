//! Wishes about whole works.

use document::asset::Asset;
use document::intake::Incoming;

/// Wishes about whole works.
#[derive(Clone, Debug, PartialEq)]
pub enum WorkWish {
    /// Open an example, whose files may have to be fetched first.
    OpenExample(usize),
    /// Open an example whose files were fetched; its text is `None` if that did not come.
    OpenFetched {
        /// The number of the example.
        index: usize,
        /// The text.
        text: Option<String>,
        /// The images and meshes.
        assets: Vec<Asset>,
    },
    /// Open a saved work, parts of which may have to be fetched first.
    OpenSaved(String),
    /// Open a saved work, all of which is there.
    OpenFetchedWork(String),
    /// Take the open work over from the tab that writes it.
    TakeOver,
    /// Go on with a copy of the open work.
    Copy,
    /// Bring back the texts of a version of the open work: the number of the version.
    BringBack(usize),
    /// Open a text as an example is opened.
    OpenText {
        /// The name of the work.
        name: String,
        /// The dataset.
        text: String,
    },
    /// Begin an empty work.
    New,
    /// Begin the first shape.
    First,
    /// Go to a step of the first shape: the number of its work, and the step; leave it if it is
    /// `None`.
    Step(Option<(u64, usize)>),
    /// Begin an empty work to draw on.
    DrawNew,
    /// Go back to the user's own work, which a link has replaced.
    GoBack,
    /// Give the work another name.
    Rename(String),
    /// Delete a saved work.
    Delete(String),
    /// Compile and trace again after a failed start.
    Enable,
    /// Write all texts, images and meshes to one file.
    Save,
    /// Make a link, copy it, and put it into the address bar.
    Share,
    /// Choose files to take in.
    PickFiles,
    /// Take in files.
    Take {
        /// The files.
        files: Vec<Incoming>,
        /// Whether what was taken in is shown.
        show: bool,
    },
}
