//! Work on pictures that the commands of the TOOLS group ask for.
//!
//! The compiler touches no files. It turns `resize`, `collage`, `diff` … into the jobs below, in
//! the order of the text, and leaves them to whoever keeps files: the program carries them out in
//! the folder of the dataset, the page on the files of the open work.
//!
//! All names of files are as the text gives them: not checked, possibly leading anywhere.

/// A job on pictures.
#[derive(Clone, Debug, PartialEq)]
pub enum Tool {
    /// `animate fn1 … [loop|mirror|dither]`: pictures to an animation.
    Animate {
        /// The frames, in order.
        files: Vec<String>,
        /// The way in which playing goes on after the last frame.
        playback: Playback,
        /// Whether colours that a format of 256 colours cannot show are mixed from dots.
        dither: bool,
    },
    /// `play fn`: show an animation.
    Play {
        /// The animation.
        file: String,
    },
    /// `split fn [frame.fmt]`: an animation to pictures.
    Split {
        /// The animation.
        file: String,
        /// Name and format of the pictures: `frame.png` gives `frame000.png`, `frame001.png` …
        pattern: Option<String>,
    },
    /// `collage [columns n] fn1 fn2 …`: several pictures on one sheet.
    Collage {
        /// The number of pictures side by side; `None`: about as many as below each other.
        columns: Option<u32>,
        /// The pictures, row by row.
        files: Vec<String>,
    },
    /// `fli fn1 … [speed n] [size w h]`: pictures to an animation of 256 colours.
    Fli {
        /// The frames, in order.
        files: Vec<String>,
        /// Frames in a second.
        speed: Option<f64>,
        /// Width and height in pixels; `None`: those of the first frame.
        size: Option<[u32; 2]>,
    },
    /// `convert fn1 fn2`: a picture in another format.
    Convert {
        /// The picture.
        from: String,
        /// The new file; its ending tells the format.
        to: String,
    },
    /// `resize fn x y`: a picture in another size.
    Resize {
        /// The picture.
        file: String,
        /// New width, pixels.
        width: u32,
        /// New height, pixels.
        height: u32,
    },
    /// `diff fn1 fn2 [save]`: how far two pictures differ.
    Diff {
        /// The first picture.
        a: String,
        /// The second picture.
        b: String,
        /// The file to which the result is written, if it is.
        save: Option<String>,
    },
    /// `and fn1 fn2 [save]`: the bits that two pictures share.
    And {
        /// The first picture.
        a: String,
        /// The second picture.
        b: String,
        /// The file to which the result is written, if it is.
        save: Option<String>,
    },
    /// `xor fn1 fn2 [save]`: the bits in which two pictures differ.
    Xor {
        /// The first picture.
        a: String,
        /// The second picture.
        b: String,
        /// The file to which the result is written, if it is.
        save: Option<String>,
    },
    /// `show …`: a file, a colour or a palette.
    Show {
        /// The thing that is shown.
        what: Shown,
    },
    /// `table v1 v2 …`: a line through numbers.
    Table {
        /// The heights, at equal distances from left to right; 2 … 256.
        values: Vec<f64>,
    },
}

impl Tool {
    /// Returns the command that asks for it.
    #[must_use]
    pub fn command(&self) -> &'static str {
        match self {
            Self::Animate { .. } => "animate",
            Self::Play { .. } => "play",
            Self::Split { .. } => "split",
            Self::Collage { .. } => "collage",
            Self::Fli { .. } => "fli",
            Self::Convert { .. } => "convert",
            Self::Resize { .. } => "resize",
            Self::Diff { .. } => "diff",
            Self::And { .. } => "and",
            Self::Xor { .. } => "xor",
            Self::Show { .. } => "show",
            Self::Table { .. } => "table",
        }
    }

    /// Returns the names of the pictures that the job looks at.
    #[must_use]
    pub fn reads(&self) -> Vec<&str> {
        match self {
            Self::Animate { files, .. } | Self::Collage { files, .. } | Self::Fli { files, .. } => {
                files.iter().map(String::as_str).collect()
            }
            Self::Play { file }
            | Self::Split { file, .. }
            | Self::Resize { file, .. }
            | Self::Convert { from: file, .. }
            | Self::Show {
                what: Shown::File(file),
            } => vec![file],
            Self::Diff { a, b, .. } | Self::And { a, b, .. } | Self::Xor { a, b, .. } => {
                vec![a, b]
            }
            Self::Show { .. } | Self::Table { .. } => Vec::new(),
        }
    }

    /// Returns the name that the text gives to the result, if it does.
    #[must_use]
    pub fn writes(&self) -> Option<&str> {
        match self {
            Self::Convert { to, .. } => Some(to),
            Self::Diff { save, .. } | Self::And { save, .. } | Self::Xor { save, .. } => {
                save.as_deref()
            }
            _ => None,
        }
    }
}

/// Way in which an animation goes on after its last frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Playback {
    /// Stop.
    #[default]
    Once,
    /// Begin again.
    Loop,
    /// Run back to the first frame, and so on.
    Mirror,
}

/// The things that `show` can show.
#[derive(Clone, Debug, PartialEq)]
pub enum Shown {
    /// A picture or an animation.
    File(String),
    /// A colour.
    Colour {
        /// The name, or the words by which it was written.
        name: String,
        /// Red, green, blue, each 0 … 1.
        rgb: [f32; 3],
    },
    /// Colours side by side, each red, green, blue in 0 … 1; `show palette` gives all that have a
    /// name.
    Palette(Vec<[f32; 3]>),
}
