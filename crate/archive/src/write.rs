//! Writing, without a date.

use crate::Error;
use crate::checksum::checksum;
use miniz_oxide::deflate::compress_to_vec;

/// Effort of packing, 0 … 10.
const LEVEL: u8 = 6;

/// A file to be put into an archive.
#[derive(Clone, Copy, Debug)]
pub struct Member<'a> {
    /// The name, with folders.
    pub name: &'a str,
    /// The content.
    pub bytes: &'a [u8],
    /// Whether packing is not worth the time, as for a picture that is packed already.
    pub packed: bool,
}

impl<'a> Member<'a> {
    /// A file that is packed.
    #[must_use]
    pub fn new(name: &'a str, bytes: &'a [u8]) -> Self {
        Self {
            name,
            bytes,
            packed: false,
        }
    }
}

/// An archive of files: a function of them alone, as it has no dates.
///
/// # Errors
/// If it would have more than 65,534 members, a name of more than 65,535 bytes, or 4 GiB.
pub fn write(members: &[Member<'_>]) -> Result<Vec<u8>, Error> {
    let mut bytes: Vec<u8> = Vec::new();
    let mut directory: Vec<u8> = Vec::new();
    // The largest numbers are marks of larger archives.
    let count = u16::try_from(members.len()).ok().filter(|n| *n < u16::MAX);
    let count = count.ok_or(Error::Members(usize::from(u16::MAX) - 1))?;
    for member in members {
        let start = long(bytes.len())?;
        let common = heading(member)?;
        bytes.extend(b"PK\x03\x04");
        bytes.extend(&common.heading);
        bytes.extend(member.name.as_bytes());
        bytes.extend(common.content.as_deref().unwrap_or(member.bytes));
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&common.heading);
        // No comment, first disk, no attributes.
        directory.extend([0; 10]);
        directory.extend(start.to_le_bytes());
        directory.extend(member.name.as_bytes());
    }
    let (start, length) = (long(bytes.len())?, long(directory.len())?);
    bytes.extend(&directory);
    bytes.extend(b"PK\x05\x06\x00\x00\x00\x00");
    for word in [count; 2] {
        bytes.extend(word.to_le_bytes());
    }
    for word in [length, start] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend([0; 2]);
    Ok(bytes)
}

struct Common {
    /// The bytes that a member's heading and the directory have in common.
    heading: Vec<u8>,
    /// The packed content; `None` where it is stored as it is.
    content: Option<Vec<u8>>,
}

fn heading(member: &Member<'_>) -> Result<Common, Error> {
    let name = u16::try_from(member.name.len()).map_err(|_| Error::Huge)?;
    let content = (!member.packed)
        .then(|| compress_to_vec(member.bytes, LEVEL))
        .filter(|content| content.len() < member.bytes.len());
    let method = if content.is_some() { 8 } else { 0 };
    // Says that the name is UTF-8, which is not needed for ASCII.
    let flags = if member.name.is_ascii() { 0 } else { 1 << 11 };
    let mut heading: Vec<u8> = Vec::new();
    // Version 2.0, midnight on 1 January 1980.
    for word in [20_u16, flags, method, 0, 0x21] {
        heading.extend(word.to_le_bytes());
    }
    let size = long(member.bytes.len())?;
    let packed = match &content {
        Some(content) => long(content.len())?,
        None => size,
    };
    for word in [checksum(member.bytes), packed, size] {
        heading.extend(word.to_le_bytes());
    }
    for word in [name, 0] {
        heading.extend(word.to_le_bytes());
    }
    Ok(Common { heading, content })
}

fn long(number: usize) -> Result<u32, Error> {
    u32::try_from(number)
        .ok()
        .filter(|number| *number < u32::MAX)
        .ok_or(Error::Huge)
}
