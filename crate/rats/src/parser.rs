//! Makes a tree of commands from tokens. Whatever is wrong, the rest of the text is still read: a
//! mistake costs one command or one block, with a message.

use crate::commands;
use crate::lexer::{Token, TokenKind, lex};
use crate::limits;
use crate::problem::{Outcome, Problem};
use crate::symbol::{Symbol, Symbols};
use crate::syntax::{Block, Command, Datum, Define, For, Formal, If, Item, Node, Syntax, Takes};
use std::ops::Range;

/// Reads a file.
pub fn parse<'a>(text: &'a str, symbols: &mut Symbols<'a>) -> Syntax {
    let tokens = lex(text);
    let braces = match_braces(text, &tokens);
    let mut parser = Parser {
        text,
        tokens: &tokens,
        braces,
        at: 0,
        items: Vec::with_capacity(tokens.len() / 2),
        problems: Vec::new(),
        symbols,
    };
    let block = parser.block(0);
    Syntax {
        block,
        items: parser.items,
        problems: parser.problems,
    }
}

/// Finds for every `{` token the index of its `}`; 0 if it has none and for all other tokens, as a
/// `}` is never first.
fn match_braces(text: &str, tokens: &[Token]) -> Vec<usize> {
    let mut partner = vec![0; tokens.len()];
    let mut open = Vec::new();
    for (index, token) in tokens.iter().enumerate() {
        if token.kind != TokenKind::Sign {
            continue;
        }
        match &text[token.range()] {
            "{" => open.push(index),
            "}" => {
                if let Some(start) = open.pop() {
                    partner[start] = index;
                }
            }
            _ => {}
        }
    }
    partner
}

struct Parser<'a, 't, 's> {
    text: &'a str,
    tokens: &'t [Token],
    braces: Vec<usize>,
    at: usize,
    items: Vec<Item>,
    problems: Vec<Problem>,
    symbols: &'s mut Symbols<'a>,
}

/// End of a command's operands.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ends {
    /// The end of the line.
    Line,
    /// The `{` of a block.
    Brace,
}

impl<'a> Parser<'a, '_, '_> {
    fn word(&self, token: Token) -> &'a str {
        &self.text[token.range()]
    }

    fn problem(&mut self, span: Range<usize>, message: impl Into<String>, hint: &str) {
        self.problems.push(*Problem::new(&span, message).hint(hint));
    }

    /// Skips space, comments and, if asked, line ends; returns the token that follows.
    fn peek(&mut self, over_lines: bool) -> Option<Token> {
        while let Some(&token) = self.tokens.get(self.at) {
            match token.kind {
                TokenKind::Space | TokenKind::Comment => self.at += 1,
                TokenKind::Newline if over_lines => self.at += 1,
                _ => return Some(token),
            }
        }
        None
    }

    fn is_sign(&self, token: Token, sign: &str) -> bool {
        token.kind == TokenKind::Sign && self.word(token) == sign
    }

    /// Skips to the end of the line, or of the block if that comes first.
    fn skip_line(&mut self) {
        while let Some(&token) = self.tokens.get(self.at) {
            if token.kind == TokenKind::Newline || self.is_sign(token, "}") {
                break;
            }
            self.at += 1;
        }
    }

    /// Reads commands up to the closing brace (`depth` > 0), which is left to the caller, or to the
    /// end.
    fn block(&mut self, depth: usize) -> Block {
        let mut block = Block::new();
        while let Some(token) = self.peek(true) {
            match token.kind {
                TokenKind::Sign => match self.word(token) {
                    "}" if depth > 0 => break,
                    "}" => {
                        self.at += 1;
                        self.problem(
                            token.range(),
                            "there is no `{` for this `}`",
                            "remove it, or open the block or list that it should close",
                        );
                    }
                    "@" => self.skip_echo_sign(token),
                    // Stray separators mean nothing.
                    "," | "<" | ">" => self.at += 1,
                    _ => self.refuse_token(token),
                },
                TokenKind::Word => {
                    let node = self.node(token, depth);
                    match node {
                        Ok(node) => block.extend(node),
                        Err(problem) => self.problems.push(*problem),
                    }
                }
                _ => self.refuse_token(token),
            }
        }
        block
    }

    /// Skips `@` before a command, whose echo it silences, and stray separators. Without a command
    /// in the same line it is a mistake.
    fn skip_echo_sign(&mut self, at: Token) {
        self.at += 1;
        while let Some(next) = self.peek(false)
            && ["@", ",", "<", ">"]
                .iter()
                .any(|sign| self.is_sign(next, sign))
        {
            self.at += 1;
        }
        let next = self.peek(false);
        if next.is_none_or(|next| next.kind == TokenKind::Newline || self.is_sign(next, "}")) {
            self.problem(
                at.range(),
                "a command was expected after this `@`",
                "`@` silences the echo of the command behind it: \
                 remove it, or write the command in \
                 this line",
            );
        }
    }

    /// Reports that a command was expected, and skips the line, or a block that begins here.
    fn refuse_token(&mut self, token: Token) {
        if self.is_sign(token, "{") && self.braces[self.at] > 0 {
            self.at = self.braces[self.at] + 1;
        }
        self.problem(
            token.range(),
            "a command was expected here",
            "every line begins with a command; operands go on in the next line only inside \
             `{ … }`",
        );
        self.skip_line();
    }

    fn node(&mut self, token: Token, depth: usize) -> Outcome<Option<Node>> {
        let word = self.word(token);
        if word.eq_ignore_ascii_case("for") {
            let head = self.command(token, Ends::Brace)?;
            let body = self.block_of(&head, depth)?;
            Ok(body.map(|body| Node::For(Box::new(For { head, body }))))
        } else if word.eq_ignore_ascii_case("if") {
            self.choice(token, depth)
        } else if word.eq_ignore_ascii_case("define") {
            self.define(token, depth)
        } else if word.eq_ignore_ascii_case("else") {
            self.at += 1;
            let problem = Problem::new(&token.range(), "this `else` has no `if`")
                .hint("write `if … { … } else { … }`");
            let head = self.empty_head(token);
            self.block_of(&head, depth)?;
            Err(problem)
        } else {
            let command = self.command(token, Ends::Line)?;
            Ok(Some(Node::Command(command)))
        }
    }

    fn choice(&mut self, token: Token, depth: usize) -> Outcome<Option<Node>> {
        let head = self.command(token, Ends::Brace)?;
        let then = self.block_of(&head, depth)?;
        let back = self.at;
        let mut otherwise = Some(Block::new());
        match self.peek(true) {
            Some(next)
                if next.kind == TokenKind::Word && self.word(next).eq_ignore_ascii_case("else") =>
            {
                self.at += 1;
                match self.peek(true) {
                    Some(nested)
                        if nested.kind == TokenKind::Word
                            && self.word(nested).eq_ignore_ascii_case("if") =>
                    {
                        self.refuse_depth(nested, depth)?;
                        otherwise = self.choice(nested, depth + 1)?.map(|node| vec![node]);
                    }
                    _ => {
                        let head = self.empty_head(next);
                        otherwise = self.block_of(&head, depth)?;
                    }
                }
            }
            _ => self.at = back,
        }
        Ok(then.zip(otherwise).map(|(then, otherwise)| {
            Node::If(Box::new(If {
                head,
                then,
                otherwise,
            }))
        }))
    }

    fn define(&mut self, token: Token, depth: usize) -> Outcome<Option<Node>> {
        let head = self.command(token, Ends::Brace)?;
        let signature = self.signature(&head);
        let body = self.block_of(&head, depth)?;
        let (name, parameters) = signature?;
        Ok(body.map(|body| {
            Node::Define(Box::new(Define {
                head,
                name,
                parameters,
                body,
            }))
        }))
    }

    /// Reads `name(a, B, surface s, c = 1, …)`.
    fn signature(&self, head: &Command) -> Outcome<(Symbol, Vec<Formal>)> {
        const HINT: &str = "write `define name(a, b) { … }`; \
            a parameter in CAPITALS takes a triple, \
            `surface s` a material, `c = 1` may be left out";
        let items = &self.items[head.items.clone()];
        let Some(Item {
            datum: Datum::Word(name),
            ..
        }) = items.first()
        else {
            return Err(Problem::new(&head.span, "`define` needs a name").hint(HINT));
        };
        let word = self.symbols.word(*name);
        // A text's own command hides one of the library and a newer one, so that texts from before
        // them still run.
        if commands::find(word).is_some_and(|spec| !spec.yields()) {
            return Err(Problem::new(
                &items[0].span(),
                format!("`{word}` is already a command of the language"),
            )
            .hint("choose another name"));
        }
        if let [_, hyphen, last, ..] = items
            && hyphen.datum == Datum::Sign(b'-')
            && !hyphen.spaced
            && !last.spaced
        {
            return Err(Problem::new(
                &(items[0].span().start..last.span().end),
                "a command's name cannot hold a hyphen: it is a minus",
            )
            .hint(format!("begin it with `{word}_`")));
        }
        let mut parameters: Vec<Formal> = Vec::new();
        let mut at = 1;
        while let Some(item) = items.get(at) {
            at += 1;
            match item.datum {
                Datum::Word(parameter) => {
                    let formal = self.formal(head, &mut at, parameter, item.span());
                    if let Some(first) = parameters.iter().find(|p| p.name == formal.name) {
                        let word = self.symbols.word(formal.name);
                        return Err(Problem::new(
                            &formal.span,
                            format!("there are two parameters `{word}`"),
                        )
                        .hint("give one of them another name")
                        .with_place(
                            None,
                            first.span.clone(),
                            "the first one",
                        ));
                    }
                    if formal.default.is_empty()
                        && parameters.last().is_some_and(|p| !p.default.is_empty())
                    {
                        let word = self.symbols.word(formal.name);
                        return Err(Problem::new(
                            &formal.span,
                            format!("`{word}` needs a default, as the parameter before it has one"),
                        )
                        .hint(format!("write `{word} = …`, or put it first")));
                    }
                    parameters.push(formal);
                }
                Datum::Sign(b'(' | b')' | b',') => {}
                _ => {
                    return Err(Problem::new(
                        &item.span(),
                        "only names of parameters can stand here",
                    )
                    .hint(HINT));
                }
            }
        }
        Ok((*name, parameters))
    }

    /// Reads the rest of a parameter whose first word was read; `at` is the index of what follows
    /// among the head's items.
    fn formal(&self, head: &Command, at: &mut usize, word: Symbol, span: Range<usize>) -> Formal {
        let items = &self.items[head.items.clone()];
        let text = self.symbols.word(word);
        let mut formal = Formal {
            name: word,
            shown: String::new(),
            takes: Takes::Number,
            default: 0..0,
            span,
        };
        if text.chars().any(char::is_alphabetic) && !text.chars().any(char::is_lowercase) {
            formal.takes = Takes::Triple;
        }
        let words = ["surface", "material"];
        if words.iter().any(|word| word.eq_ignore_ascii_case(text))
            && let Some(Item {
                datum: Datum::Word(name),
                start,
                end,
                ..
            }) = items.get(*at)
        {
            formal.name = *name;
            formal.takes = Takes::Surface;
            formal.span = *start as usize..*end as usize;
            *at += 1;
        }
        if items.get(*at).map(|item| item.datum) == Some(Datum::Sign(b'=')) {
            let first = *at + 1;
            let mut depth = 0;
            let mut end = first;
            while let Some(item) = items.get(end) {
                match item.datum {
                    Datum::Sign(b'(' | b'<') => depth += 1,
                    Datum::Sign(b')' | b'>') if depth == 0 => break,
                    Datum::Sign(b')' | b'>') => depth -= 1,
                    Datum::Sign(b',') if depth == 0 => break,
                    _ => {}
                }
                end += 1;
            }
            formal.default = head.items.start + first..head.items.start + end;
            *at = end;
        }
        let word = self.symbols.word(formal.name);
        formal.shown = match formal.takes {
            Takes::Surface => format!("the material's name (`{word}`)"),
            _ => format!("`{word}`"),
        };
        formal
    }

    /// Makes an empty head, for `else`.
    fn empty_head(&mut self, token: Token) -> Command {
        Command {
            word: self.symbols.intern(self.word(token)),
            word_span: token.range(),
            spec: commands::find(self.word(token)),
            items: 0..0,
            span: token.range(),
        }
    }

    /// Skips the line if blocks are too deep here.
    ///
    /// # Errors
    /// If they are.
    fn refuse_depth(&mut self, token: Token, depth: usize) -> Outcome<()> {
        if depth < limits::MAX_NESTED_BLOCKS {
            return Ok(());
        }
        self.skip_line();
        Err(Problem::new(
            &token.range(),
            format!(
                "blocks can stand inside each other {} deep at most",
                limits::MAX_NESTED_BLOCKS
            ),
        )
        .hint("move the inner commands into a `define`"))
    }

    /// Reads `{ … }` after a head; `None` if it is never closed, which has been said.
    fn block_of(&mut self, head: &Command, depth: usize) -> Outcome<Option<Block>> {
        let back = self.at;
        let word = self.symbols.word(head.word);
        let Some(open) = self.peek(true).filter(|t| self.is_sign(*t, "{")) else {
            self.at = back;
            return Err(Problem::new(&head.span, format!("`{word}` needs a block"))
                .hint("put the commands in `{ … }`"));
        };
        let close = self.braces[self.at];
        if depth >= limits::MAX_NESTED_BLOCKS {
            // Over the whole block, so that what is inside is not read as if it stood outside.
            self.at = match close {
                0 => self.tokens.len(),
                _ => close + 1,
            };
            return self.refuse_depth(open, depth).map(|()| None);
        }
        self.at += 1;
        let block = self.block(depth + 1);
        if self.at < self.tokens.len() {
            self.at += 1;
        }
        if close == 0 {
            self.problem(
                open.range(),
                format!("this `{{` of `{word}` is never closed"),
                "add a `}` where the block ends",
            );
            return Ok(None);
        }
        Ok(Some(block))
    }

    /// Reads a command's word and operands.
    fn command(&mut self, token: Token, ends: Ends) -> Outcome<Command> {
        self.at += 1;
        let word = self.word(token);
        let first = self.items.len();
        let end = self.operands(ends).unwrap_or(token.end);
        let items = first..self.items.len();
        let spec = commands::find(word);
        let most = spec.map_or(limits::MAX_OPERANDS, |spec| spec.most_operands);
        if items.len() > most {
            self.items.truncate(first);
            return Err(Problem::new(
                &token.range(),
                format!("`{word}` has {} operands; {most} is the limit", items.len()),
            )
            .hint("split it into several commands"));
        }
        Ok(Command {
            word: self.symbols.intern(word),
            word_span: token.range(),
            spec,
            items,
            span: token.start..end,
        })
    }

    /// Takes the operands of a command up to where they end. Returns one past the last byte of the
    /// last operand or closing brace; `None` if there is neither.
    fn operands(&mut self, ends: Ends) -> Option<usize> {
        let mut end = None;
        let mut depth = 0_usize;
        let mut spaced = false;
        while let Some(&token) = self.tokens.get(self.at) {
            let text = self.word(token);
            let datum = match token.kind {
                TokenKind::Space | TokenKind::Comment => {
                    spaced = true;
                    self.at += 1;
                    continue;
                }
                TokenKind::Newline => {
                    if depth == 0 {
                        break;
                    }
                    spaced = true;
                    self.at += 1;
                    continue;
                }
                TokenKind::Word => Datum::Word(self.symbols.intern(text)),
                TokenKind::Number => Datum::Number(text.parse().unwrap_or(f64::NAN)),
                TokenKind::Unknown => Datum::Unknown,
                TokenKind::Sign => match text.as_bytes()[0] {
                    b'{' if ends == Ends::Brace => break,
                    b'{' => {
                        if self.braces[self.at] == 0 {
                            self.problem(
                                token.range(),
                                "this `{` is never closed",
                                "add a `}` where the list ends",
                            );
                        } else {
                            depth += 1;
                        }
                        spaced = true;
                        self.at += 1;
                        continue;
                    }
                    b'}' => {
                        if depth == 0 {
                            break;
                        }
                        depth -= 1;
                        spaced = true;
                        end = Some(token.end);
                        self.at += 1;
                        continue;
                    }
                    // The typeset minus.
                    b if !b.is_ascii() => Datum::Sign(b'-'),
                    b => Datum::Sign(b),
                },
            };
            self.items.push(Item {
                datum,
                start: u32::try_from(token.start).unwrap_or(u32::MAX),
                end: u32::try_from(token.end).unwrap_or(u32::MAX),
                spaced,
            });
            spaced = false;
            end = Some(token.end);
            self.at += 1;
        }
        end
    }
}
