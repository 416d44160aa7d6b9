//! Plain pictures, and the operations on them for the language's TOOLS group.
//!
//! ```
//! use picture::{Format, Picture, combine, file};
//!
//! let a = Picture::filled(4, 2, [200, 100, 50, 255])?;
//! let b = Picture::filled(4, 2, [190, 100, 60, 255])?;
//! let difference = combine::diff(&a, &b)?;
//! assert_eq!(difference.pixel(0, 0), Some([10, 0, 10, 255]));
//! let png = file::encode(&difference, Format::Png)?;
//! assert!(png.starts_with(b"\x89PNG"));
//! # Ok::<(), picture::Problem>(())
//! ```
//!
//! A [`Picture`] is a width, a height and four bytes a pixel. [`combine`] and [`resize()`] make new
//! ones of old ones, [`collage()`] puts several on a sheet, [`plot()`] and [`swatches()`] draw
//! simple ones, [`contour`] finds lines of equal value. [`file`] turns pictures into the bytes of
//! PNG, JPEG, TGA, TIFF, GIF and MTV files and back, [`animation`] does so with animations in PNG
//! and GIF.
//!
//! Without the feature `formats` only PNG and MTV are known. Bytes of files are never trusted: what
//! is larger than the limits of [`limits`], cut or wrong is a [`Problem`], which is a sentence for
//! a person.

pub mod animation;
mod collage;
pub mod combine;
pub mod contour;
pub mod file;
#[cfg(feature = "formats")]
mod formats;
#[cfg(feature = "formats")]
mod jpeg;
pub mod limits;
mod mtv;
mod picture;
mod plot;
mod png_file;
mod problem;
mod resize;
mod swatches;
mod timing;

pub use collage::{collage, collage_at_most};
pub use file::Format;
pub use picture::Picture;
pub use plot::plot;
pub use problem::Problem;
pub use resize::resize;
pub use swatches::swatches;
