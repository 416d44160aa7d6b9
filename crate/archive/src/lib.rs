//! Zip archives of files in memory.
//!
//! [`write()`] makes an archive, [`Archive`] reads one. Archives are untrusted: nothing is unpacked
//! before its size is compared with a limit, and no more is unpacked than that, whatever size the
//! archive states.
//!
//! ```
//! use archive::{Archive, Member};
//!
//! let bytes = archive::write(&[
//!     Member::new("leg.rat", b"sphere leg 1, 0 0 0\n"),
//!     Member::new("färg.txt", b"blue"),
//! ])?;
//! let archive = Archive::open(&bytes, 100)?;
//! let names: Vec<&str> = archive.entries().iter().map(|entry| entry.name.as_str()).collect();
//! assert_eq!(names, ["leg.rat", "färg.txt"]);
//! let colour = archive.entry("FÄRG.TXT").unwrap();
//! assert_eq!(archive.read(colour, 1000)?, b"blue");
//! assert!(archive.read(colour, 3).is_err(), "it is larger");
//! # Ok::<(), archive::Error>(())
//! ```

mod checksum;
mod error;
mod read;
mod write;

pub use error::Error;
pub use read::{Archive, Entry};
pub use write::{Member, write};
