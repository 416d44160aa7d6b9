//! Hover: help on the word under the pointer.

use crate::complete::{describe, hex};
use crate::grammar::{Grammar, comment_before};
use crate::index::{Here, Index, Place, SymbolKind};
use crate::mend::with_index;
use crate::place;
use crate::slots::{Slot, What};
use crate::swatches;
use rats::commands::{CommandSpec, Group, OptionSpec};
use rats::lexer::TokenKind;
use rats::{Project, colours, functions};
use std::ops::Range;

/// Help on a word.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Card {
    /// The word's bytes.
    pub span: Range<usize>,
    /// The word's meaning, in a few words.
    pub title: String,
    /// More, line by line.
    pub lines: Vec<String>,
    /// The colour, if it is one.
    pub swatch: Option<[f32; 3]>,
    /// The address of the picture beside the page, if there is one ([`swatches`](crate::swatches)).
    pub picture: Option<&'static str>,
    /// The command whose manual explains more.
    pub command: Option<&'static str>,
}

/// Longest line that is quoted from a text, in characters.
const MAX_QUOTE: usize = 100;

/// Finds help on the word or number at a byte; `None` where there is nothing to say.
///
/// ```
/// let text = "sphere Clay 2, 0 0 0";
/// let card = assist::hover(&rats::Project::single(text), 0, 3).unwrap();
/// assert_eq!(&text[card.span], "sphere");
/// assert_eq!(card.command, Some("sphere"));
/// ```
#[must_use]
pub fn hover(project: &Project, file: usize, byte: usize) -> Option<Card> {
    let text = project.files.get(file)?.text.as_str();
    if !place::is_in(text, byte) || place::in_comment(text, byte) {
        return None;
    }
    with_index(project, file, byte, |index| {
        let here = index.here.as_ref()?;
        if here.word_span.start <= byte && byte <= here.word_span.end {
            return command(project, here);
        }
        let Some((span, slot)) = here.slot(byte) else {
            return name_card(index, file, byte);
        };
        let card = match slot.what {
            What::Option => Some(option(span, slot.option?, here)),
            What::Word(word) => Some(Card {
                span: span.clone(),
                title: word.name.to_owned(),
                lines: vec![word.meaning.to_owned()],
                command: here.spec.map(|spec| spec.name),
                ..Card::default()
            }),
            _ => None,
        };
        card.or_else(|| name_card(index, file, byte).map(|card| with_role(card, slot)))
            .or_else(|| value(text, span, slot, byte))
            .map(|card| Card {
                command: card.command.or(here.spec.map(|spec| spec.name)),
                picture: match (here.spec, &slot.what) {
                    (Some(spec), What::Option) => slot
                        .option
                        .and_then(|option| swatches::picture(spec.name, option.name)),
                    (Some(spec), What::Word(word)) => swatches::picture(spec.name, word.name),
                    _ => None,
                },
                ..card
            })
    })
}

/// Makes the card of the command's word.
fn command(project: &Project, here: &Here<'_>) -> Option<Card> {
    if let Some(place) = &here.own {
        let text = &project.files[place.file].text;
        let comment = comment_before(text, place.span.start);
        let mut lines: Vec<String> = comment
            .lines()
            .map(|line| line.trim_start().trim_start_matches('#').trim().to_owned())
            .filter(|line| !line.is_empty())
            .take(12)
            .collect();
        lines.push(where_made(project, place));
        return Some(Card {
            span: here.word_span.clone(),
            title: synopsis(here.word, &here.grammar),
            lines,
            ..Card::default()
        });
    }
    let spec = here.spec?;
    let mut lines = vec![spec.meaning.to_owned()];
    for parameter in &Grammar::of(spec).parameters {
        lines.push(format!("{}: {}", parameter.synopsis(), describe(parameter)));
    }
    if !spec.options.is_empty() {
        let names: Vec<_> = spec.options.iter().map(|option| option.name).collect();
        lines.push(format!("options: {}", names.join(", ")));
    }
    if !spec.details.is_empty() {
        lines.push(spec.details.to_owned());
    }
    if !spec.default.is_empty() {
        lines.push(format!("by default {}", spec.default));
    }
    if let Some(reason) = spec.idle() {
        lines.push(format!("changes nothing here: {reason}"));
    }
    lines.push(origin(spec));
    Some(Card {
        span: here.word_span.clone(),
        title: spec.synopsis(),
        lines,
        command: Some(spec.name),
        ..Card::default()
    })
}

/// Returns the language that a command comes from.
fn origin(spec: &CommandSpec) -> String {
    String::from(match spec.group() {
        Group::Extensions => "ours: RATS did not have it",
        _ => "from RATS",
    })
}

/// Writes a command with its parameters.
fn synopsis(word: &str, grammar: &Grammar<'_>) -> String {
    let mut text = word.to_owned();
    for parameter in &grammar.parameters {
        text += " ";
        text += &parameter.synopsis();
    }
    text
}

/// Makes the card of an option.
fn option(span: &Range<usize>, option: &'static OptionSpec, here: &Here<'_>) -> Card {
    let mut lines = vec![option.meaning.to_owned()];
    for parameter in option.parameters {
        lines.push(format!(
            "{}: {}",
            parameter.synopsis(),
            describe(&parameter.into())
        ));
    }
    if !option.default.is_empty() {
        lines.push(format!("by default {}", option.default));
    }
    lines.push(format!("an option of `{}`", here.word));
    Card {
        span: span.clone(),
        title: option.synopsis(),
        lines,
        command: here.spec.map(|spec| spec.name),
        ..Card::default()
    }
}

/// Makes the card of a name: its kind and where it is made.
fn name_card(index: &Index<'_>, file: usize, byte: usize) -> Option<Card> {
    let occurrence = index.occurrence(file, byte)?;
    let definition = index.definition(occurrence)?;
    let kind = index.kind(occurrence);
    let mut lines = Vec::new();
    let place = &definition.place;
    let text = &index.project.files[place.file].text;
    if kind == SymbolKind::File {
        lines.push(String::from("a file of the project"));
    } else {
        lines.push(quote(&text[definition.command.clone()]));
        lines.push(where_made(index.project, place));
    }
    let places = index.all_of(occurrence);
    let uses = places.filter(|o| !o.is_definition).count();
    lines.push(match uses {
        0 => String::from("not used"),
        1 => String::from("used once"),
        _ => format!("used {uses} times"),
    });
    // A variable that is set to a colour's name shows it.
    let value = text[definition.command.clone()].split_once('=');
    let first = value.and_then(|(_, value)| value.split_whitespace().next());
    let swatch = first
        .filter(|_| kind == SymbolKind::Variable)
        .and_then(colours::find);
    Some(Card {
        span: occurrence.place.span.clone(),
        title: format!("{} `{}`", kind.word(), index.name(occurrence)),
        lines,
        swatch,
        ..Card::default()
    })
}

/// Writes the line and file of a place.
fn where_made(project: &Project, place: &Place) -> String {
    let file = &project.files[place.file];
    let line = file.text[..place.span.start].matches('\n').count() + 1;
    format!("line {line} of {}", file.name)
}

/// Returns the first line of a command, not too long.
fn quote(command: &str) -> String {
    let line = command.lines().next().unwrap_or("");
    let short: String = line.chars().take(MAX_QUOTE).collect();
    if short.len() < command.trim_end().len() {
        format!("{short} …")
    } else {
        short
    }
}

/// Returns the use of an operand: `y of the centre`.
fn role(slot: &Slot<'_>) -> Option<String> {
    let parameter = slot.parameter?;
    let part = match slot.what {
        What::Number(part) if slot_is_triple(slot) => {
            let parts = if parameter.unit.word().is_empty() && is_colour(slot) {
                ["red", "green", "blue"]
            } else {
                ["x", "y", "z"]
            };
            format!("{} of ", parts[usize::from(part.min(2))])
        }
        _ => String::new(),
    };
    Some(format!("{part}{}", describe(&parameter)))
}

fn is_colour(slot: &Slot<'_>) -> bool {
    use rats::commands::Kind;
    let kind = slot.parameter.map(|parameter| parameter.kind);
    matches!(kind, Some(Kind::Colour | Kind::Backdrop | Kind::Share))
}

fn slot_is_triple(slot: &Slot<'_>) -> bool {
    use rats::commands::Kind;
    let kind = slot.parameter.map(|parameter| parameter.kind);
    matches!(
        kind,
        Some(Kind::Colour | Kind::Backdrop | Kind::Share | Kind::Vector | Kind::Direction)
    )
}

/// Adds the use of the operand to the card of a name.
fn with_role(mut card: Card, slot: &Slot<'_>) -> Card {
    if !matches!(slot.what, What::Name { .. } | What::File | What::Named)
        && let Some(role) = role(slot)
    {
        card.lines.push(format!("here: {role}"));
    }
    card
}

/// Makes the card of a number, a colour or a function.
fn value(text: &str, span: &Range<usize>, slot: &Slot<'_>, byte: usize) -> Option<Card> {
    let role = role(slot);
    let token = place::token(text, span.clone(), byte);
    let word = token.filter(|token| token.kind == TokenKind::Word);
    let mut card = Card {
        span: token.map_or_else(|| span.clone(), |token| token.range()),
        ..Card::default()
    };
    let name = word.map_or("", |token| &text[token.range()]);
    if let Some(function) = functions::find(name) {
        card.title = format!("function `{}`", function.name);
        card.lines.push(function.meaning.to_owned());
    } else if let Some(constant) = functions::constant(name) {
        card.title = format!("{name} = {constant:.6}");
    } else if let Some(colour) = colours::find(name)
        && matches!(slot.what, What::Triple | What::Extra)
    {
        let [r, g, b] = colour.map(|c| (f64::from(c) * 1000.0).round() / 1000.0);
        card.title = format!("colour `{name}`");
        card.lines.push(format!("{r} {g} {b}, {}", hex(colour)));
        card.swatch = Some(colour);
    } else {
        card.title = role?;
        return Some(card);
    }
    card.lines.extend(role.map(|role| format!("here: {role}")));
    Some(card)
}
