//! Reads a command's operands one after the other: names and options here, values in
//! `operands`.
//!
//! Commas, `<` and `>` only separate, so they are skipped wherever an operand may begin.

use crate::commands::{CommandSpec, OptionSpec};
use crate::problem::{Outcome, Problem};
use crate::reads::is_image;
use crate::scope::Scope;
use crate::suggest;
use crate::symbol::Symbol;
use crate::syntax::{Command, Datum, Item};
use crate::value::Value;
use std::ops::Range;

/// Most bytes of a text that a message quotes.
const LONGEST_QUOTE: usize = 60;

/// Cuts a text to what a message quotes: a word can be as long as the text.
fn quote(text: &str) -> &str {
    &text[..text.floor_char_boundary(LONGEST_QUOTE)]
}

/// Returns whether a name is that of an image of a kind that is not read.
fn is_unread_image(name: &str) -> bool {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    ["jpg", "jpeg", "webp", "bmp", "avif", "heic", "svg"]
        .iter()
        .any(|kind| ending.eq_ignore_ascii_case(kind))
}

/// A user's name: of a material, an object, a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name<'a> {
    /// The name.
    pub text: &'a str,
    /// The place.
    pub span: Range<usize>,
}

/// Reads the operands of one command.
#[derive(Debug)]
pub struct Reader<'e, 'a> {
    /// The operands.
    pub(crate) items: &'e [Item],
    /// The next operand.
    pub(crate) at: usize,
    /// The text of the file.
    pub(crate) text: &'a str,
    /// The variables.
    pub(crate) scope: &'e mut Scope<'a>,
    /// Whether `a -b` is two operands (in a list) or one (in a head or in parentheses).
    pub(crate) listed: bool,
    /// Whether `<` and `>` compare (in a condition).
    pub(crate) comparing: bool,
    /// The depth of the expression that is being read.
    pub(crate) depth: usize,
    spec: Option<&'static CommandSpec>,
    /// The place of the command, where something is missing if the operands end too soon.
    end: Range<usize>,
}

impl<'e, 'a> Reader<'e, 'a> {
    /// Reads the operands of `command`, which are among `items`, all those of its file.
    pub fn new(
        command: &Command,
        items: &'e [Item],
        text: &'a str,
        scope: &'e mut Scope<'a>,
    ) -> Self {
        let items = &items[command.items.clone()];
        Self {
            items,
            at: 0,
            text,
            scope,
            listed: true,
            comparing: false,
            depth: 0,
            spec: command.spec,
            end: command.span.clone(),
        }
    }

    /// Lets `a -b` be a difference, as suits the head of a loop or choice.
    #[must_use]
    pub fn joining(mut self) -> Self {
        self.listed = false;
        self
    }

    /// Skips separators; returns whether operands are left.
    pub fn more(&mut self) -> bool {
        while let Some(Datum::Sign(b',' | b'<' | b'>')) = self.datum() {
            self.at += 1;
        }
        self.at < self.items.len()
    }

    /// Returns the next item as it is.
    pub(crate) fn datum(&self) -> Option<Datum> {
        self.items.get(self.at).map(|item| item.datum)
    }

    /// Returns the place of the next operand, or of the whole command if there is none.
    #[must_use]
    pub fn here(&self) -> Range<usize> {
        self.items
            .get(self.at)
            .map_or_else(|| self.end.clone(), Item::span)
    }

    /// Returns the range from an earlier place to the last operand read.
    #[must_use]
    pub fn since(&self, start: usize) -> Range<usize> {
        let end = self
            .at
            .checked_sub(1)
            .and_then(|last| self.items.get(last))
            .map_or(start, |item| item.end as usize);
        start..end.max(start)
    }

    /// Returns the first byte of the next operand.
    pub fn start(&mut self) -> usize {
        self.more();
        self.here().start
    }

    /// Returns the place of the command.
    pub(crate) fn command_span(&self) -> Range<usize> {
        self.end.clone()
    }

    /// Returns a hint on how the command is written.
    pub(crate) fn usage(&self) -> Option<String> {
        self.spec.map(CommandSpec::usage)
    }

    /// Returns the text of the next item.
    pub(crate) fn next_text(&self) -> Option<&'a str> {
        let text = &self.text[self.items.get(self.at)?.span()];
        Some(quote(text))
    }

    /// Makes the problem that `what` is missing or something else stands there.
    pub(crate) fn missing(&self, what: &str) -> Box<Problem> {
        let message = match self.next_text() {
            Some(found) => format!("expected {what}, found `{found}`"),
            None => format!("expected {what}, but the command ends here"),
        };
        Problem::new(&self.here(), message).maybe_hint(self.usage())
    }

    /// Returns the next word without taking it.
    pub fn peek_word(&mut self) -> Option<(Symbol, &'a str)> {
        if !self.more() {
            return None;
        }
        match self.datum() {
            Some(Datum::Word(symbol)) => Some((symbol, self.scope.symbols.word(symbol))),
            _ => None,
        }
    }

    /// Returns the name of a parameter if `name =` comes next (and not `==`); takes nothing.
    pub fn peek_parameter(&mut self) -> Option<(Symbol, &'a str)> {
        let found = self.peek_word()?;
        let [first, second] = [self.at + 1, self.at + 2]
            .map(|at| self.items.get(at).map(|item| item.datum) == Some(Datum::Sign(b'=')));
        (first && !second).then_some(found)
    }

    /// Takes the next word if it is `keyword`, in any case.
    pub fn keyword(&mut self, keyword: &str) -> bool {
        let found = self
            .peek_word()
            .is_some_and(|(_, word)| word.eq_ignore_ascii_case(keyword));
        self.at += usize::from(found);
        found
    }

    /// Takes the next item if it is `sign`. Commas before it are skipped.
    pub fn sign(&mut self, sign: u8) -> bool {
        let found = self.more() && self.datum() == Some(Datum::Sign(sign));
        self.at += usize::from(found);
        found
    }

    /// Reads a user's name. A sign `^` that is not separated from it belongs to it (`sin^2`).
    ///
    /// # Errors
    /// If there is none.
    pub fn name(&mut self, what: &str) -> Outcome<Name<'a>> {
        self.glue(what, |datum| datum == Datum::Sign(b'^'))
    }

    /// Reads a name that is made here.
    ///
    /// # Errors
    /// If there is none, or one with a hyphen, which would be a minus where the name is used.
    pub fn new_name(&mut self, what: &str) -> Outcome<Name<'a>> {
        let name = self.name(what)?;
        if !matches!(self.next_glued(), Some(Datum::Sign(b'-'))) {
            return Ok(name);
        }
        while let Some(Datum::Word(_) | Datum::Number(_) | Datum::Sign(b'-')) = self.next_glued() {
            self.at += 1;
        }
        let span = self.since(name.span.start);
        let whole = &self.text[span.clone()];
        let better = whole.replace(['-', '−'], "_");
        Err(Problem::new(
            &span,
            format!("`{}` cannot hold a hyphen: it is a minus", quote(whole)),
        )
        .hint(format!("write `{}`", quote(&better))))
    }

    /// Reads a name that was made before. A parameter of the running call that stands for a name
    /// gives that name.
    ///
    /// # Errors
    /// If there is none.
    pub fn old_name(&mut self, what: &str) -> Outcome<Name<'a>> {
        let symbol = self.peek_word().map(|(symbol, _)| symbol);
        let mut name = self.name(what)?;
        if let Some(symbol) = symbol
            && self.scope.symbols.word(symbol) == name.text
            && let Some(Value::Name(meant)) = self.scope.get(symbol)
        {
            name.text = self.scope.symbols.word(meant);
        }
        Ok(name)
    }

    /// Reads a file's name: all up to the next separator.
    ///
    /// # Errors
    /// If there is none, or one in quotes, which would belong to it.
    pub fn file_name(&mut self, what: &str) -> Outcome<Name<'a>> {
        const QUOTES: [char; 4] = ['"', '\'', '“', '”'];
        let name = self.glue(what, |datum| {
            !matches!(datum, Datum::Sign(b',' | b'<' | b'>'))
        })?;
        let bare = name.text.trim_matches(QUOTES);
        if name.text.starts_with(QUOTES) && !bare.is_empty() {
            return Err(
                Problem::new(&name.span, "a file's name is written without quotes")
                    .hint(format!("write `{}`, and no space in it", quote(bare))),
            );
        }
        Ok(name)
    }

    /// Reads the name of an image, even of a kind that is not read, if its ending says so; else
    /// takes nothing.
    pub fn image_name(&mut self) -> Option<Name<'a>> {
        let back = self.at;
        let name = self.peek_word().and_then(|_| self.file_name("").ok());
        let name = name.filter(|name| is_image(name.text) || is_unread_image(name.text));
        if name.is_none() {
            self.at = back;
        }
        name
    }

    /// Returns the next item if no space comes before it.
    fn next_glued(&self) -> Option<Datum> {
        let item = self.items.get(self.at)?;
        (!item.spaced).then_some(item.datum)
    }

    /// Reads words, numbers and some signs that nothing separates as one name.
    fn glue(&mut self, what: &str, sign: fn(Datum) -> bool) -> Outcome<Name<'a>> {
        let part = |datum| matches!(datum, Datum::Word(_) | Datum::Number(_)) || sign(datum);
        if !self.more() || !self.datum().is_some_and(part) {
            return Err(self.missing(what));
        }
        let start = self.here().start;
        self.at += 1;
        while self.next_glued().is_some_and(part) {
            self.at += 1;
        }
        let span = self.since(start);
        Ok(Name {
            text: &self.text[span.clone()],
            span,
        })
    }

    /// Reads `on` or `off`.
    ///
    /// # Errors
    /// If there is neither.
    pub fn on_off(&mut self) -> Outcome<bool> {
        if self.keyword("on") {
            Ok(true)
        } else if self.keyword("off") {
            Ok(false)
        } else {
            Err(self.missing("`on` or `off`"))
        }
    }

    /// Reads the next option, one of `options`, which may be shortened to any beginning that fits
    /// one only. `None` at the end of the command.
    ///
    /// # Errors
    /// If there is something else, or a beginning of several options.
    pub fn option(
        &mut self,
        options: &'static [OptionSpec],
    ) -> Outcome<Option<(&'static OptionSpec, Range<usize>)>> {
        if !self.more() {
            return Ok(None);
        }
        self.scope.step(2, &self.here())?;
        let back = self.at;
        let Ok(name) = self.name("an option") else {
            return Err(self.missing("an option"));
        };
        let mut fitting = options.iter().filter(|option| option.begins(name.text));
        let exact = options
            .iter()
            .find(|option| option.name.eq_ignore_ascii_case(name.text));
        match (exact, fitting.next(), fitting.next()) {
            (Some(option), _, _) | (None, Some(option), None) => Ok(Some((option, name.span))),
            (None, Some(first), Some(second)) => {
                let mut names = format!("`{}`, `{}`", first.name, second.name);
                for option in fitting {
                    names += &format!(", `{}`", option.name);
                }
                Err(Problem::new(
                    &name.span,
                    format!("`{}` is short for several options", name.text),
                )
                .hint(format!("write more of one of {names}")))
            }
            (None, None, _) => {
                self.at = back;
                let names: Vec<_> = options.iter().map(|option| option.name).collect();
                let hint = suggest::hint(name.text, names.iter().copied())
                    .unwrap_or_else(|| format!("the options are {}", names.join(", ")));
                let command = self.spec.map_or("this command", |spec| spec.name);
                Err(Problem::new(
                    &name.span,
                    format!("`{command}` has no option `{}`", name.text),
                )
                .hint(hint))
            }
        }
    }

    /// Whether the next word is one of these or the beginning of one.
    pub(crate) fn is_option_next(&mut self, options: &[OptionSpec]) -> bool {
        let Some((symbol, word)) = self.peek_word() else {
            return false;
        };
        // A variable is meant where its name is short for an option, but not where it is the
        // option.
        let is_variable = self.scope.get(symbol).is_some();
        options
            .iter()
            .any(|option| option.begins(word) && !(is_variable && word.len() < option.name.len()))
    }

    /// Whether the next word is one of these, in full.
    pub(crate) fn is_whole_option_next(&mut self, options: &[OptionSpec]) -> bool {
        self.peek_word().is_some_and(|(_, word)| {
            options
                .iter()
                .any(|option| option.name.eq_ignore_ascii_case(word))
        })
    }

    /// Expects the end of the command.
    ///
    /// # Errors
    /// If something is left.
    pub fn end(&mut self) -> Outcome<()> {
        if !self.more() {
            return Ok(());
        }
        let found = &self.text[self.here()];
        Err(Problem::new(
            &self.here(),
            format!("the command is complete before `{found}`"),
        )
        .maybe_hint(self.usage()))
    }
}
