//! XML of files that are untrusted: document types are refused, and so are entities other than
//! XML's own.

use crate::error::{Error, fail};
use quick_xml::XmlVersion;
use quick_xml::events::BytesStart;
use std::borrow::Cow;

/// Tag that begins an element.
pub struct Tag<'a> {
    start: BytesStart<'a>,
    line: usize,
}

impl Tag<'_> {
    /// Name of the element, without the namespace's prefix.
    #[must_use]
    pub fn name(&self) -> &str {
        local(self.start.name().into_inner())
    }

    /// Returns the value of an attribute, by its name without a prefix.
    ///
    /// # Errors
    /// If attributes are broken, or the value has an entity that XML does not know.
    pub fn get(&self, name: &str) -> Result<Option<Cow<'_, str>>, Error> {
        let mut attributes = self.start.attributes();
        // Comparing each with each takes long where there are many.
        for attribute in attributes.with_checks(false) {
            let attribute = attribute.map_err(|error| fault(self.line, error))?;
            if local(attribute.key.into_inner()) == name {
                let value = attribute.normalized_value(XmlVersion::Implicit1_0);
                return value.map(Some).map_err(|error| fault(self.line, error));
            }
        }
        Ok(None)
    }

    /// Line of the tag, from 1.
    #[must_use]
    pub fn line(&self) -> usize {
        self.line
    }
}

/// Step through a document.
pub enum Event<'a> {
    /// Begin of an element.
    Start(Tag<'a>),
    /// End of an element of this name, without the namespace's prefix.
    End(String),
}

/// The elements of a document, in order.
pub struct Reader<'a> {
    text: &'a str,
    inner: quick_xml::Reader<&'a [u8]>,
    depth: usize,
    /// A place, and its line from 1.
    place: (usize, usize),
}

impl<'a> Reader<'a> {
    /// Returns a reader of a text.
    #[must_use]
    pub fn new(text: &'a str) -> Self {
        // The reader below passes over a mark, but does not count it.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut inner = quick_xml::Reader::from_str(text);
        inner.config_mut().expand_empty_elements = true;
        Self {
            text,
            inner,
            depth: 0,
            place: (0, 1),
        }
    }

    /// Returns the next step; `None` at the end of the text.
    ///
    /// # Errors
    /// If the text is no XML, or has a document type.
    // No iterator's, as it may fail and go on after that.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> Result<Option<Event<'a>>, Error> {
        use quick_xml::events::Event as Any;
        loop {
            match self.inner.read_event() {
                Ok(Any::Start(start)) => {
                    self.depth += 1;
                    let line = self.line();
                    return Ok(Some(Event::Start(Tag { start, line })));
                }
                Ok(Any::End(end)) => {
                    self.depth = self.depth.saturating_sub(1);
                    let name = local(end.name().into_inner()).to_owned();
                    return Ok(Some(Event::End(name)));
                }
                // It could define entities that grow without end.
                Ok(Any::DocType(_)) => {
                    let line = self.line();
                    return fail(format!("line {line}: a document type is not read"));
                }
                Ok(Any::Eof) => return Ok(None),
                Ok(_) => {}
                Err(error) => return Err(fault(self.line(), error)),
            }
        }
    }

    /// Whether all elements so far have ended.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.depth == 0
    }

    /// Returns the text up to the next tag, as it stands there.
    ///
    /// # Errors
    /// If there is no tag.
    pub fn text(&mut self) -> Result<&'a str, Error> {
        let rest = self.text.get(self.position()..).unwrap_or_default();
        match rest.find('<') {
            Some(end) => Ok(&rest[..end]),
            None => fail(format!("line {}: this file is cut off", self.line())),
        }
    }

    /// Returns the line of the place behind the last step, from 1.
    pub fn line(&mut self) -> usize {
        let (from, line) = self.place;
        let to = self.position().clamp(from, self.text.len());
        let passed = &self.text.as_bytes()[from..to];
        self.place = (to, line + passed.iter().filter(|b| **b == b'\n').count());
        self.place.1
    }

    fn position(&self) -> usize {
        usize::try_from(self.inner.buffer_position()).unwrap_or(usize::MAX)
    }
}

fn fault(line: usize, error: impl core::fmt::Display) -> Error {
    Error(format!("line {line}: this XML is broken: {error}"))
}

/// Returns a name without the namespace's prefix.
fn local(name: &str) -> &str {
    name.rsplit_once(':').map_or(name, |(_, local)| local)
}
