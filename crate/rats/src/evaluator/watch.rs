//! Watching a run for one command: from where in the texts each of its numbers comes, so that a
//! hand that moves the shape knows what to rewrite.
//!
//! The meaning of a word depends on the variables at that time, so the text is run up to the
//! command, as for a picture, and the run notes where variables and the radii of materials were
//! written.

use super::state::Evaluator;
use crate::commands::slot::Named;
use crate::given::{self, Filled, Given};
use crate::lexer::{TokenKind, lex};
use crate::provenance::{Number, Operand, Provenance, Source};
use crate::reader::{Name, Reader};
use crate::symbol::Symbol;
use crate::syntax::Command;
use crate::value::Value;
use std::ops::Range;

impl<'a> Evaluator<'a> {
    /// Notes that a loop sets a variable.
    pub(super) fn watch_loop(&mut self, name: Symbol) {
        if let Some(watch) = &mut self.watch {
            watch.variables.remove(&name);
        }
    }

    /// Notes where a variable was set.
    pub(super) fn watch_variable(
        &mut self,
        name: Symbol,
        literal: Option<Range<usize>>,
        animated: bool,
    ) {
        if self.watch.is_none() {
            return;
        }
        let word = self.scope.symbols.word(name);
        let text = self.sources.all[self.file].text;
        let setting = if self.repeating > 0 || !self.is_own() {
            Err(format!(
                "comes from `{word}`, which is set in a loop or a defined command"
            ))
        } else if animated {
            Err(format!(
                "comes from `{word}`, which changes with every frame"
            ))
        } else {
            literal
                .and_then(|span| literals(text, span))
                .map(|spans| (self.file, spans))
                .ok_or_else(|| format!("comes from `{word}`, which is computed"))
        };
        if let Some(watch) = &mut self.watch {
            watch.variables.insert(name, setting);
        }
    }

    /// Notes where the radius of a material was given, with its place; a copy takes over that of
    /// the old one. A radius follows from a depth if there is one.
    pub(super) fn watch_material(
        &mut self,
        name: &Name<'a>,
        old: Option<&Name<'_>>,
        radius: Option<(f64, Range<usize>)>,
        has_depth: bool,
    ) {
        if self.watch.is_none() {
            return;
        }
        let own = radius.map(|(value, span)| Number {
            value,
            source: self.source(span, 0),
        });
        let Some(watch) = &mut self.watch else { return };
        let copied = old.and_then(|old| watch.radii.get(old.text).cloned());
        let mut radius = own.or(copied).unwrap_or(Number {
            value: 0.0,
            source: Source::Computed(String::from("is not given")),
        });
        if has_depth {
            let why = format!("follows from the `depth` of `{}`", name.text);
            radius.source = Source::Computed(why);
        }
        watch.radii.insert(name.text, radius);
    }

    /// Looks at a shape's command that has just been read; its first operand is the material.
    pub(super) fn watch_shape(&mut self, command: &'a Command, given: &Given<'a>) {
        let Some(watch) = &self.watch else { return };
        if watch.seen.is_some() || !self.is_own() || self.origin(command) != watch.target {
            return;
        }
        let (Some(spec), Some(material)) = (command.spec, given.operands().next::<Named>()) else {
            return;
        };
        let radius = watch.radii.get(material.text).cloned();
        let mut operands = Vec::new();
        let chosen = given.options.iter().flat_map(|chosen| &chosen.operands);
        for filled in given.filled.iter().chain(chosen) {
            operands.extend(self.operand(command, filled));
        }
        let seen = Provenance {
            spec,
            operands,
            material: material.text.to_owned(),
            radius: radius.unwrap_or(Number {
                value: 0.0,
                source: Source::Computed(String::from("is not given")),
            }),
        };
        if let Some(watch) = &mut self.watch {
            watch.seen = Some(seen);
        }
    }

    /// Returns an operand of the command with the sources of its numbers; `None` if it is no
    /// number.
    fn operand(&mut self, command: &Command, filled: &Filled<'a>) -> Option<Operand> {
        let values = match filled.operand {
            given::Operand::Number(number) => vec![number],
            // A direction was made a unit vector; here it is wanted as it is written.
            given::Operand::Triple(_) => Vec::new(),
            _ => return None,
        };
        let (values, sources) = if values.is_empty() {
            self.triple(command, filled.span.clone())?
        } else {
            (values, vec![self.source(filled.span.clone(), 0)])
        };
        let numbers = values.into_iter().zip(sources);
        Some(Operand {
            parameter: filled.parameter,
            numbers: numbers
                .map(|(value, source)| Number { value, source })
                .collect(),
        })
    }

    /// Reads a triple once more, number by number. What `rand` draws on the way does not matter:
    /// the run ends here.
    fn triple(&mut self, command: &Command, span: Range<usize>) -> Option<(Vec<f64>, Vec<Source>)> {
        let source = &self.sources.all[self.file];
        let items = &source.syntax.items;
        let at = items[command.items.clone()]
            .iter()
            .position(|item| item.start as usize == span.start)?;
        let mut read = Reader::new(command, items, source.text, &mut self.scope);
        read.at = at;
        let mut values = Vec::new();
        let mut spans = Vec::new();
        while values.len() < 3 {
            let start = read.start();
            match read.value("").ok()? {
                Value::Scalar(x) => {
                    values.push(x);
                    spans.push(read.since(start));
                }
                Value::Vector(v) | Value::Colour(v) if values.is_empty() => {
                    let span = read.since(start);
                    let sources = (0..3).map(|k| self.source(span.clone(), k)).collect();
                    return Some((v.to_array().to_vec(), sources));
                }
                _ => return None,
            }
        }
        let sources = spans.into_iter().map(|span| self.source(span, 0)).collect();
        Some((values, sources))
    }

    /// Returns the source of a number of the present file that an expression gives; of a triple it
    /// is the number with this index.
    fn source(&self, span: Range<usize>, index: usize) -> Source {
        let text = self.sources.all[self.file].text;
        let slice = &text[span.clone()];
        if let Some([span]) = literals(text, span.clone()).as_deref() {
            return Source::Literal {
                file: self.file,
                span: span.clone(),
                negated: false,
                variable: None,
            };
        }
        let (word, negated) = match slice.strip_prefix(['-', '−']) {
            Some(rest) => (rest.trim_start(), true),
            None => (slice, false),
        };
        self.variable(word, index, negated)
            .unwrap_or_else(|| Source::Computed(reason(slice)))
    }

    /// Returns the source of a number that `word` stands for: a variable, or a part of one.
    fn variable(&self, word: &str, index: usize, negated: bool) -> Option<Source> {
        let watch = self.watch.as_ref()?;
        // In a call, parameters may hide them.
        if self.scope.calls() > 0 {
            return None;
        }
        let known = |word: &str| {
            let symbol = self.scope.symbols.find(word)?;
            self.scope.get(symbol)?;
            watch.variables.get(&symbol)
        };
        let (name, index, setting) = match known(word) {
            Some(setting) => (word, index, setting),
            None => {
                let (name, component) = word.rsplit_once('.')?;
                let index = ["xr", "yg", "zb"]
                    .iter()
                    .position(|names| component.len() == 1 && names.contains(component))?;
                (name, index, known(name)?)
            }
        };
        Some(match setting {
            Ok((file, spans)) => Source::Literal {
                file: *file,
                span: spans.get(index)?.clone(),
                negated,
                variable: Some(name.to_owned()),
            },
            Err(why) => Source::Computed(why.clone()),
        })
    }
}

/// Finds the places of the numbers in a range of a text, each with its sign, if there is nothing
/// else there but separators.
pub(super) fn literals(text: &str, range: Range<usize>) -> Option<Vec<Range<usize>>> {
    let mut spans = Vec::new();
    let mut sign: Option<usize> = None;
    for token in lex(text.get(range.clone())?) {
        let place = range.start + token.start..range.start + token.end;
        match (token.kind, &text[place.clone()]) {
            (TokenKind::Number, _) => spans.push(sign.take().unwrap_or(place.start)..place.end),
            (TokenKind::Space | TokenKind::Newline | TokenKind::Comment, _) => {}
            (TokenKind::Sign, "," | "<" | ">") if sign.is_none() => {}
            (TokenKind::Sign, "-" | "−" | "+") if sign.is_none() => sign = Some(place.start),
            _ => return None,
        }
    }
    sign.is_none().then_some(spans)
}

/// Returns the reason why a number that an expression gives cannot be rewritten.
fn reason(expression: &str) -> String {
    const LONGEST: usize = 40;
    let short = expression.split_whitespace().collect::<Vec<_>>().join(" ");
    match short.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("is computed: `{} …`", &short[..end]),
        None => format!("is computed: `{short}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_are_written_out() {
        assert_eq!(spans("1 2"), Some(vec![0..1, 2..3]));
        assert_eq!(spans("<1, -2 3>"), Some(vec![1..2, 4..6, 7..8]));
        assert_eq!(spans("−.5 # half\n 2"), Some(vec![0..5, 14..15]));
        assert_eq!(spans("a"), None);
        assert_eq!(spans("2*3"), None);
        assert_eq!(spans("--3"), None);
        assert_eq!(spans("3 -"), None);
    }

    fn spans(text: &str) -> Option<Vec<Range<usize>>> {
        literals(text, 0..text.len())
    }
}
