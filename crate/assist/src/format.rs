//! Lays a text out: indentation, space around `=` and after commas, two spaces before remarks.
//!
//! Lines stay lines and columns stay columns, so the writer's own grouping is kept. In this
//! language a space can mean something (`1 -2` is two operands, `1 - 2` is one; `a ^b` is not the
//! name `a^b`), so where there was space there is as much, and where there was none there is none,
//! but for a few places where the parser does not look: after commas, at braces, around the `=` of
//! an assignment and around comparisons.

use crate::walk;
use rats::commands::Bracket;
use rats::lexer::{Token, TokenKind, lex};
use rats::limits::MAX_TEXT;
use rats::parser::parse;
use rats::symbol::Symbols;
use rats::syntax::{Command, Datum, Item};
use std::ops::Range;

/// Spaces of one level.
const INDENT: usize = 2;
/// Most levels; deeper ones are not indented further.
const MAX_LEVELS: usize = 40;

/// Lays a text out. Its meaning does not change, nor does the text when it is laid out again. A
/// text with braces that do not match, or one that would outgrow [`MAX_TEXT`], is returned as it
/// is.
///
/// ```
/// let text = "for i=1 to 3 {\nsphere Clay 1,i 0 0\n}";
/// assert_eq!(assist::format(text), "for i = 1 to 3 {\n  sphere Clay 1, i 0 0\n}\n");
/// ```
#[must_use]
pub fn format(text: &str) -> String {
    let tokens = lex(text);
    if !braces_match(text, &tokens) {
        return text.to_owned();
    }
    let marks = Marks::of(text, &tokens);
    let limit = text.len().max(MAX_TEXT);
    let mut page = Page::default();
    for (index, token) in tokens.iter().enumerate() {
        page.token(text, &tokens, &marks, index, *token);
        if page.out.len() > limit {
            return text.to_owned();
        }
    }
    if !page.fresh_line {
        page.out.push('\n');
    }
    page.out
}

/// Returns whether every brace has its partner.
fn braces_match(text: &str, tokens: &[Token]) -> bool {
    let mut depth = 0_usize;
    for token in tokens.iter().filter(|t| t.kind == TokenKind::Sign) {
        match &text[token.range()] {
            "{" => depth += 1,
            "}" if depth == 0 => return false,
            "}" => depth -= 1,
            _ => {}
        }
    }
    depth == 0
}

/// The parser's knowledge of a token.
#[derive(Clone, Copy, Debug, Default)]
struct Mark {
    /// Space goes before the token.
    before: bool,
    /// Space goes after the token.
    after: bool,
    /// The token begins an object or chain.
    opens: bool,
    /// The token is a `close`.
    closes: bool,
    /// The token stands in operands that count letter by letter, space included.
    verbatim: bool,
}

/// The marks of all tokens.
#[derive(Debug)]
struct Marks(Vec<Mark>);

impl Marks {
    fn of(text: &str, tokens: &[Token]) -> Self {
        let mut symbols = Symbols::default();
        let syntax = parse(text, &mut symbols);
        let mut marks = Self(vec![Mark::default(); tokens.len()]);
        walk::commands(&syntax.block, &mut |command| {
            marks.command(tokens, command, &syntax.items[command.items.clone()]);
        });
        marks
    }

    /// Returns the mark of the token that begins at a byte.
    fn at(&mut self, tokens: &[Token], byte: usize) -> &mut Mark {
        let index = tokens.partition_point(|token| token.start < byte);
        &mut self.0[index]
    }

    fn command(&mut self, tokens: &[Token], command: &Command, items: &[Item]) {
        let Some(spec) = command.spec else { return };
        match spec.bracket {
            Some(Bracket::Object | Bracket::Chain) => {
                self.at(tokens, command.word_span.start).opens = true;
            }
            Some(Bracket::Close) => self.at(tokens, command.word_span.start).closes = true,
            None => {}
        }
        match spec.name {
            "var" | "define" => self.assignments(tokens, items),
            "for" => {
                if let Some(sign) = items.iter().position(|item| item.datum == EQUAL) {
                    self.assignment(tokens, items, sign);
                }
            }
            _ if spec.copies() => {
                // Right after the name only: elsewhere `=` may stand in a file's name.
                let name = items
                    .iter()
                    .enumerate()
                    .take_while(|(i, item)| *i == 0 || (item.datum != EQUAL && !item.spaced))
                    .count();
                if items.get(name).is_some_and(|item| item.datum == EQUAL) {
                    self.assignment(tokens, items, name);
                }
            }
            "if" => self.comparisons(tokens, items),
            "pause" => self.verbatim(tokens, command.word_span.end..command.span.end),
            _ => {}
        }
    }

    fn verbatim(&mut self, tokens: &[Token], bytes: Range<usize>) {
        let first = tokens.partition_point(|token| token.start < bytes.start);
        for (mark, token) in self.0[first..].iter_mut().zip(&tokens[first..]) {
            if token.start >= bytes.end {
                break;
            }
            mark.verbatim = true;
        }
    }

    fn assignments(&mut self, tokens: &[Token], items: &[Item]) {
        for (index, item) in items.iter().enumerate() {
            if item.datum == EQUAL {
                self.assignment(tokens, items, index);
            }
        }
    }

    /// Puts spaces around `=`, or around `+=` and `*=`.
    fn assignment(&mut self, tokens: &[Token], items: &[Item], index: usize) {
        let first = match sign_before(items, index) {
            None => index,
            Some(b'+' | b'*') if sign_before(items, index - 1).is_none() => index - 1,
            Some(_) => return,
        };
        self.breathe(tokens, items, first, index);
    }

    /// Puts spaces around `<`, `<=`, `==` and so on.
    fn comparisons(&mut self, tokens: &[Token], items: &[Item]) {
        let mut index = 0;
        while let Some(item) = items.get(index) {
            let is_pair = is_equal_next(items, index);
            match item.datum {
                Datum::Sign(b'<' | b'>' | b'=' | b'!') if is_pair => {
                    if stands_alone(items, index, index + 1) {
                        self.breathe(tokens, items, index, index + 1);
                    }
                    index += 1;
                }
                Datum::Sign(b'<' | b'>') if stands_alone(items, index, index) => {
                    self.breathe(tokens, items, index, index);
                }
                _ => {}
            }
            index += 1;
        }
    }

    /// A space before item `first` and one after item `last`.
    fn breathe(&mut self, tokens: &[Token], items: &[Item], first: usize, last: usize) {
        // Between `=` and `=` a space would part what belongs together, and before `*=` it would
        // turn it into a sign with spaces around it.
        let next_begins_pair = is_equal_next(items, last + 1)
            && matches!(items[last + 1].datum, Datum::Sign(b'+' | b'*' | b'!'))
            && sign_before(items, last + 1).is_some();
        if is_equal_next(items, last) || next_begins_pair {
            return;
        }
        self.at(tokens, items[first].start as usize).before = true;
        self.at(tokens, items[last].start as usize).after = true;
    }
}

const EQUAL: Datum = Datum::Sign(b'=');

/// The sign right before an item, if no space lies between.
fn sign_before(items: &[Item], index: usize) -> Option<u8> {
    let (before, item) = (items.get(index.checked_sub(1)?)?, items.get(index)?);
    match before.datum {
        // After these a space stands anyway, or means nothing.
        Datum::Sign(b')' | b',' | b'{' | b'}') => None,
        Datum::Sign(sign) if before.end == item.start => Some(sign),
        _ => None,
    }
}

/// Returns whether no sign stands right before a comparison, nor another comparison right after it.
fn stands_alone(items: &[Item], first: usize, last: usize) -> bool {
    let next = sign_before(items, last + 1).map(|_| items[last + 1].datum);
    sign_before(items, first).is_none() && !matches!(next, Some(Datum::Sign(b'<' | b'>')))
}

/// Returns whether `=` follows an item without space.
fn is_equal_next(items: &[Item], index: usize) -> bool {
    let Some(end) = items.get(index).map(|item| item.end) else {
        return false;
    };
    items
        .get(index + 1)
        .is_some_and(|next| next.datum == EQUAL && next.start == end)
}

/// Reasons to indent lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    Brace,
    Object,
}

/// The text as far as it is written.
#[derive(Debug)]
struct Page {
    out: String,
    levels: Vec<Level>,
    /// Whether nothing stands in this line yet.
    fresh_line: bool,
    /// Whether an empty line comes before the next one.
    blank: bool,
    /// The width of the space before the next token.
    gap: usize,
    /// The last token written.
    last: Option<usize>,
}

impl Default for Page {
    fn default() -> Self {
        Self {
            out: String::new(),
            levels: Vec::new(),
            fresh_line: true,
            blank: false,
            gap: 0,
            last: None,
        }
    }
}

impl Page {
    fn token(&mut self, text: &str, tokens: &[Token], marks: &Marks, index: usize, token: Token) {
        let mark = marks.0[index];
        if mark.verbatim {
            self.out += &text[token.range()];
            self.last = Some(index);
            return;
        }
        match token.kind {
            TokenKind::Space => {
                let space = &text[token.range()];
                // Only spaces make columns that look alike everywhere.
                let is_column = space.bytes().all(|byte| byte == b' ');
                self.gap = if is_column { space.len() } else { 1 };
            }
            TokenKind::Newline => {
                if self.fresh_line {
                    self.blank = !self.out.is_empty();
                } else {
                    self.out.push('\n');
                }
                self.fresh_line = true;
                self.gap = 0;
            }
            _ => {
                if self.fresh_line {
                    self.begin_line(text, tokens, marks, index);
                } else {
                    let gap = self.space_before(text, tokens, marks, index);
                    self.out.extend(std::iter::repeat_n(' ', gap));
                }
                self.gap = 0;
                self.out += text[token.range()].trim_end();
                self.last = Some(index);
                self.change_level(text, token, mark);
            }
        }
    }

    fn begin_line(&mut self, text: &str, tokens: &[Token], marks: &Marks, index: usize) {
        if std::mem::take(&mut self.blank) {
            self.out.push('\n');
        }
        self.fresh_line = false;
        // A closing brace at the start of a line is indented like the line that opens it.
        let mut level = self.levels.len();
        for (token, mark) in tokens[index..].iter().zip(&marks.0[index..]) {
            if token.kind == TokenKind::Space {
                continue;
            }
            if &text[token.range()] == "}" {
                level = outside(&self.levels[..level]);
                continue;
            }
            if mark.closes && level > 0 && self.levels[level - 1] == Level::Object {
                level -= 1;
            }
            break;
        }
        let spaces = INDENT * level.min(MAX_LEVELS);
        self.out.extend(std::iter::repeat_n(' ', spaces));
    }

    /// Returns the number of spaces before a token that does not begin a line.
    fn space_before(&self, text: &str, tokens: &[Token], marks: &Marks, index: usize) -> usize {
        let token = tokens[index];
        let here = &text[token.range()];
        let last = self.last.unwrap_or(index);
        let before = tokens[last];
        let there = &text[before.range()];
        if token.kind == TokenKind::Comment {
            return self.gap.max(2);
        }
        if marks.0[last].verbatim {
            return usize::from(self.gap > 0 || here == "}");
        }
        let wanted = match (there, here) {
            ("{", "}") => false,
            ("{" | "}" | ",", _) | (_, "{" | "}") => true,
            (")" | ">", ",") => false,
            (_, ",") if matches!(before.kind, TokenKind::Word | TokenKind::Number) => false,
            _ => self.gap > 0 || marks.0[last].after || marks.0[index].before,
        };
        if wanted { self.gap.max(1) } else { 0 }
    }

    fn change_level(&mut self, text: &str, token: Token, mark: Mark) {
        match &text[token.range()] {
            "{" => self.levels.push(Level::Brace),
            "}" => self.levels.truncate(outside(&self.levels)),
            _ if mark.opens => self.levels.push(Level::Object),
            _ if mark.closes && self.levels.last() == Some(&Level::Object) => {
                self.levels.pop();
            }
            _ => {}
        }
    }
}

/// Returns the number of levels outside of the innermost brace.
fn outside(levels: &[Level]) -> usize {
    levels
        .iter()
        .rposition(|level| *level == Level::Brace)
        .unwrap_or(0)
}
