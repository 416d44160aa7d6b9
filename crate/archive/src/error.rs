//! Errors as ends of sentences.

use std::fmt;

/// The reason why an archive cannot be read or written. It is displayed as the end of a sentence
/// such as "the file …".
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// The directory is missing, or a member leads out of the archive.
    Broken,
    /// A member needs a password.
    Encrypted,
    /// A member is packed by a method that is not read.
    Method(u16),
    /// A member cannot be unpacked, or its content does not have the directory's checksum.
    Damaged,
    /// The archive has more members than this.
    Members(usize),
    /// A member is larger than this, bytes.
    Large(usize),
    /// Sizes of 4 GiB and more are neither read nor written.
    Huge,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Broken => write!(f, "is cut off or no zip archive"),
            Self::Encrypted => write!(f, "is encrypted"),
            Self::Method(method) => write!(f, "is packed by method {method}, which is not read"),
            Self::Damaged => write!(f, "is damaged and cannot be unpacked"),
            Self::Members(most) => write!(f, "has more than {most} members"),
            Self::Large(most) => write!(f, "has more than {most} bytes when it is unpacked"),
            Self::Huge => write!(f, "is larger than a plain zip archive can be"),
        }
    }
}

impl std::error::Error for Error {}
