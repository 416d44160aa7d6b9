//! Reading: the directory at the archive's end, then members one by one.

use crate::Error;
use crate::checksum::checksum;
use miniz_oxide::inflate::TINFLStatus;
use miniz_oxide::inflate::decompress_to_vec_with_limit;

/// A member, by its entry in the directory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The name, with folders. Letters outside of UTF-8 are replaced.
    pub name: String,
    /// The size after unpacking, bytes, as the archive says.
    pub size: usize,
    encrypted: bool,
    method: u16,
    checksum: u32,
    /// Packed size.
    packed: usize,
    /// The place in the archive at which the member's own heading starts.
    start: usize,
}

impl Entry {
    /// Whether it is a folder.
    #[must_use]
    pub fn is_folder(&self) -> bool {
        self.name.ends_with('/')
    }
}

/// An archive whose directory was read.
#[derive(Clone, Debug)]
pub struct Archive<'a> {
    bytes: &'a [u8],
    entries: Vec<Entry>,
}

impl<'a> Archive<'a> {
    /// Reads the directory of an archive.
    ///
    /// # Errors
    /// If there is none, or it lists more than `most` members.
    pub fn open(bytes: &'a [u8], most: usize) -> Result<Self, Error> {
        let mut at = directory(bytes)?;
        let mut entries = Vec::new();
        // The directory ends where no entry begins.
        while let Some((entry, end)) = entry(bytes, at)? {
            if entries.len() == most {
                return Err(Error::Members(most));
            }
            entries.push(entry);
            at = end;
        }
        Ok(Self { bytes, entries })
    }

    /// The members, in the directory's order.
    #[must_use]
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The first member of a name, whatever the case of its letters; `None` without any.
    #[must_use]
    pub fn entry(&self, name: &str) -> Option<&Entry> {
        let name = name.to_lowercase();
        self.entries
            .iter()
            .find(|entry| entry.name.to_lowercase() == name)
    }

    /// The content of a member.
    ///
    /// # Errors
    /// If it has more than `most` bytes, is encrypted, packed by a method other than deflating, or
    /// damaged.
    pub fn read(&self, entry: &Entry, most: usize) -> Result<Vec<u8>, Error> {
        if entry.encrypted {
            return Err(Error::Encrypted);
        }
        if entry.size > most {
            return Err(Error::Large(most));
        }
        let heading = self.bytes.get(entry.start..).ok_or(Error::Broken)?;
        if !heading.starts_with(b"PK\x03\x04") {
            return Err(Error::Broken);
        }
        let start = 30 + usize::from(short(heading, 26)?) + usize::from(short(heading, 28)?);
        let packed = heading
            .get(start..)
            .and_then(|rest| rest.get(..entry.packed))
            .ok_or(Error::Broken)?;
        let content = match entry.method {
            0 if packed.len() > most => return Err(Error::Large(most)),
            0 => packed.to_vec(),
            8 => {
                decompress_to_vec_with_limit(packed, most).map_err(|error| match error.status {
                    TINFLStatus::HasMoreOutput => Error::Large(most),
                    _ => Error::Damaged,
                })?
            }
            other => return Err(Error::Method(other)),
        };
        if checksum(&content) != entry.checksum {
            return Err(Error::Damaged);
        }
        Ok(content)
    }
}

fn short(bytes: &[u8], at: usize) -> Result<u16, Error> {
    let word = bytes.get(at..at + 2).ok_or(Error::Broken)?;
    Ok(u16::from_le_bytes([word[0], word[1]]))
}

fn long(bytes: &[u8], at: usize) -> Result<u32, Error> {
    let [low, high] = [short(bytes, at)?, short(bytes, at + 2)?];
    Ok(u32::from(low) | u32::from(high) << 16)
}

/// Reads a number of bytes or a place. [`u32::MAX`] marks one that does not fit into 32 bits.
fn size(bytes: &[u8], at: usize) -> Result<usize, Error> {
    match long(bytes, at)? {
        u32::MAX => Err(Error::Huge),
        size => Ok(size as usize),
    }
}

/// Returns the place at which the directory starts, from the record at the end, before a comment
/// of at most 65,535 bytes.
fn directory(bytes: &[u8]) -> Result<usize, Error> {
    let last = bytes.len().checked_sub(22).ok_or(Error::Broken)?;
    let earliest = last.saturating_sub(65_535);
    let record = (earliest..=last)
        .rev()
        .map(|at| &bytes[at..])
        .find(|rest| rest.starts_with(b"PK\x05\x06"))
        .ok_or(Error::Broken)?;
    size(record, 16)
}

/// The entry at a place of the directory, and where the next one begins; `None` at the directory's
/// end.
fn entry(bytes: &[u8], at: usize) -> Result<Option<(Entry, usize)>, Error> {
    let Some(head) = bytes
        .get(at..)
        .filter(|rest| rest.starts_with(b"PK\x01\x02"))
    else {
        return Ok(None);
    };
    let length = usize::from(short(head, 28)?);
    let name = head.get(46..46 + length).ok_or(Error::Broken)?;
    let end = at + 46 + length + usize::from(short(head, 30)?) + usize::from(short(head, 32)?);
    let entry = Entry {
        name: String::from_utf8_lossy(name).into_owned(),
        size: size(head, 24)?,
        encrypted: short(head, 8)? & 1 != 0,
        method: short(head, 10)?,
        checksum: long(head, 16)?,
        packed: size(head, 20)?,
        start: size(head, 42)?,
    };
    Ok(Some((entry, end)))
}
