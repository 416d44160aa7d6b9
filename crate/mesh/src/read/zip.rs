//! Zip archives: one member, unpacked.

use super::cursor::Cursor;
use crate::error::{Error, fail};
use crate::limits::MAX_XML;
use miniz_oxide::inflate::decompress_to_vec_with_limit;

/// Members of an archive that are looked at.
const MAX_MEMBERS: usize = 10_000;

/// The bytes of a member, found through the directory at the archive's end; names differ in case only
/// are the same. `None` if there is none of this name.
///
/// # Errors
/// If the archive is broken or encrypted, or the member is larger than the limit.
pub(super) fn member(archive: &[u8], name: &str) -> Result<Option<Vec<u8>>, Error> {
    let broken = || Error("this 3MF file is cut off or no zip archive".into());
    let mut at = directory(archive).ok_or_else(broken)?;
    for _ in 0..MAX_MEMBERS {
        // The directory ends where no entry begins.
        let Some(entry) = archive.get(at..).and_then(Entry::read) else {
            return Ok(None);
        };
        let found = archive
            .get(at + 46..at + 46 + entry.name)
            .ok_or_else(broken)?;
        at += 46 + entry.name + entry.more;
        if !found.eq_ignore_ascii_case(name.as_bytes()) {
            continue;
        }
        if entry.flags & 1 != 0 {
            return fail("this 3MF file is encrypted");
        }
        let mut local = Cursor::new(archive.get(entry.start + 26..).unwrap_or_default(), false);
        let mut skip = || local.take().map(u16::from_le_bytes).map(usize::from);
        let (Some(name), Some(extra)) = (skip(), skip()) else {
            return Err(broken());
        };
        let start = entry.start + 30 + name + extra;
        let packed = archive
            .get(start..)
            .and_then(|rest| rest.get(..entry.size))
            .ok_or_else(broken)?;
        return match entry.method {
            0 if packed.len() <= MAX_XML => Ok(Some(packed.to_vec())),
            8 => decompress_to_vec_with_limit(packed, MAX_XML)
                .map(Some)
                .map_err(|error| Error(format!("this 3MF file cannot be unpacked: {error}"))),
            0 => fail(format!(
                "this 3MF file has more than {MAX_XML} bytes of text"
            )),
            other => fail(format!(
                "this 3MF file is packed by method {other}, which is not read"
            )),
        };
    }
    fail(format!("this 3MF file has more than {MAX_MEMBERS} members"))
}

/// Where the directory starts: told by the record at the end, before a comment of at most 65,535 bytes.
fn directory(archive: &[u8]) -> Option<usize> {
    let earliest = archive.len().saturating_sub(22 + 65_535);
    let last = archive.len().checked_sub(22)?;
    let at = (earliest..=last)
        .rev()
        .find(|at| archive[*at..].starts_with(b"PK\x05\x06"))?;
    let mut place = Cursor::new(&archive[at + 16..], false);
    Some(u32::from_le_bytes(place.take()?) as usize)
}

/// An entry of the directory.
struct Entry {
    flags: u16,
    method: u16,
    /// Packed size.
    size: usize,
    /// Length of the name, and of what follows it.
    name: usize,
    more: usize,
    /// Where the member's own heading starts.
    start: usize,
}

impl Entry {
    fn read(bytes: &[u8]) -> Option<Self> {
        if !bytes.starts_with(b"PK\x01\x02") {
            return None;
        }
        let short = |at: usize| {
            let word = bytes.get(at..at + 2)?;
            Some(u16::from_le_bytes([word[0], word[1]]))
        };
        let long = |at: usize| {
            let [low, high] = [short(at)?, short(at + 2)?];
            Some(usize::from(low) | usize::from(high) << 16)
        };
        Some(Self {
            flags: short(8)?,
            method: short(10)?,
            size: long(20)?,
            name: usize::from(short(28)?),
            more: usize::from(short(30)?) + usize::from(short(32)?),
            start: long(42)?,
        })
    }
}
