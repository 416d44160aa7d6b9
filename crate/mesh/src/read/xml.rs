//! XML as far as 3MF needs it: elements and their attributes, no text.

use crate::error::{Error, fail};
use std::borrow::Cow;

/// Tag.
pub(super) struct Tag<'a> {
    /// Name without the namespace's prefix.
    pub(super) name: &'a str,
    attributes: &'a str,
    pub(super) is_start: bool,
    /// `true` for an end tag, and for a start tag that ends itself.
    pub(super) is_end: bool,
}

impl<'a> Tag<'a> {
    /// The value of an attribute; prefixes count.
    pub(super) fn get(&self, name: &str) -> Option<Cow<'a, str>> {
        let mut rest = self.attributes;
        loop {
            let (before, after) = rest.split_once('=')?;
            let after = after.trim_ascii_start();
            let quote = after.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            let (value, after) = after[1..].split_once(quote)?;
            if before.trim_ascii() == name {
                return Some(unescape(value));
            }
            rest = after;
        }
    }
}

/// The tags of a document in order.
pub(super) struct Tags<'a> {
    rest: &'a str,
}

impl<'a> Tags<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { rest: text }
    }

    /// The next tag; `None` at the end.
    ///
    /// # Errors
    /// If a tag or a comment does not end.
    pub(super) fn next(&mut self) -> Result<Option<Tag<'a>>, Error> {
        loop {
            let Some((_, rest)) = self.rest.split_once('<') else {
                return Ok(None);
            };
            let skipped = [("!--", "-->"), ("![CDATA[", "]]>"), ("?", "?>")]
                .iter()
                .find_map(|(start, end)| Some((rest.strip_prefix(start)?, *end)));
            if let Some((inside, end)) = skipped {
                let (_, after) = inside.split_once(end).ok_or_else(no_end)?;
                self.rest = after;
                continue;
            }
            // A document type could define entities that grow without end.
            if rest.starts_with('!') {
                return fail("this 3MF file has a document type, which is not read");
            }
            let end = tag_end(rest).ok_or_else(no_end)?;
            let inside = &rest[..end];
            self.rest = &rest[end + 1..];
            let (inside, is_close) = match inside.strip_prefix('/') {
                Some(inside) => (inside, true),
                None => (inside, false),
            };
            let (inside, is_empty) = match inside.strip_suffix('/') {
                Some(inside) => (inside, true),
                None => (inside, false),
            };
            let split = inside.find(|c: char| c.is_ascii_whitespace());
            let (name, attributes) = inside.split_at(split.unwrap_or(inside.len()));
            return Ok(Some(Tag {
                name: name.rsplit_once(':').map_or(name, |(_, local)| local),
                attributes,
                is_start: !is_close,
                is_end: is_close || is_empty,
            }));
        }
    }
}

fn no_end() -> Error {
    Error("a tag in this 3MF file does not end".into())
}

/// Returns the index of the end of a tag: the first `>` outside quotes.
fn tag_end(text: &str) -> Option<usize> {
    let mut quote = None;
    for (i, byte) in text.bytes().enumerate() {
        match (quote, byte) {
            (None, b'>') => return Some(i),
            (None, b'"' | b'\'') => quote = Some(byte),
            (Some(open), _) if open == byte => quote = None,
            _ => {}
        }
    }
    None
}

/// Replaces the five entities that XML knows, and numbered characters.
fn unescape(text: &str) -> Cow<'_, str> {
    if !text.contains('&') {
        return Cow::Borrowed(text);
    }
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('&') {
        out.push_str(before);
        let known = after.split_once(';').and_then(|(name, after)| {
            let character = match name {
                "amp" => '&',
                "lt" => '<',
                "gt" => '>',
                "quot" => '"',
                "apos" => '\'',
                _ => {
                    let number = name.strip_prefix('#')?;
                    let code = match number.strip_prefix('x') {
                        Some(hex) => u32::from_str_radix(hex, 16),
                        None => number.parse(),
                    };
                    char::from_u32(code.ok()?)?
                }
            };
            Some((character, after))
        });
        match known {
            Some((character, after)) => {
                out.push(character);
                rest = after;
            }
            None => {
                out.push('&');
                rest = after;
            }
        }
    }
    out.push_str(rest);
    Cow::Owned(out)
}
