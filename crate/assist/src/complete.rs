//! Completion: the words that can be written at the caret.

use crate::grammar::Param;
use crate::index::{Here, Index, SymbolKind};
use crate::mend::with_index;
use crate::place;
use crate::slots::{Type, Want, What};
use rats::commands::{self, Group, Kind, Names, OptionSpec, options};
use rats::{Project, colours, functions, library, suggest};
use std::collections::HashSet;
use std::ops::Range;

/// Most completions that are offered.
pub const MAX_COMPLETIONS: usize = 50;

/// The completions at a place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Completions {
    /// The bytes that a completion replaces: the word at the caret.
    pub replace: Range<usize>,
    /// The completions, the most likely first.
    pub items: Vec<Completion>,
}

/// Word that can be written.
#[derive(Clone, Debug, PartialEq)]
pub struct Completion {
    /// The text that is shown.
    pub text: String,
    /// The kind.
    pub kind: CompletionKind,
    /// More about it, in a line.
    pub detail: String,
    /// The text that is inserted.
    pub insert: String,
    /// The colour, if it is one: red, green, blue.
    pub swatch: Option<[f32; 3]>,
    /// The address of the picture beside the page, if there is one ([`swatches`](crate::swatches)).
    pub picture: Option<&'static str>,
}

/// Kinds of completions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum CompletionKind {
    /// A command of the language.
    Command,
    /// An option of the command.
    Option,
    /// A word that the parameter allows, or one of the language.
    Word,
    /// A name that the texts make.
    Name(SymbolKind),
    /// A function or constant.
    Function,
    /// A colour.
    Colour,
}

/// Finds the completions at a byte: commands where one begins, else values for the operand there.
///
/// ```
/// let text = "surface Clay, diffuse Sandy";
/// let found = assist::complete(&rats::Project::single(text), 0, text.len());
/// assert_eq!(&text[found.replace], "Sandy");
/// assert_eq!(found.items[0].text, "SandyBrown");
/// assert!(found.items[0].swatch.is_some());
/// ```
#[must_use]
pub fn complete(project: &Project, file: usize, byte: usize) -> Completions {
    let Some(text) = project.files.get(file).map(|file| file.text.as_str()) else {
        return Completions::default();
    };
    if !place::is_in(text, byte) {
        return Completions::default();
    }
    if place::in_comment(text, byte) {
        return Completions {
            replace: byte..byte,
            items: Vec::new(),
        };
    }
    let mut replace = place::word(text, byte);
    let typed = text[replace.start..byte].chars().next();
    if typed.is_some_and(|c| c.is_ascii_digit() || c == '.') {
        // A number.
        return Completions {
            replace,
            items: Vec::new(),
        };
    }
    with_index(project, file, byte, |index| {
        let mut offers = Offers::default();
        match &index.here {
            Some(here) if byte > here.word_span.end => {
                if let Some((span, slot)) = here.slot(byte)
                    && matches!(slot.what, What::File)
                {
                    replace = span.clone();
                    offers.files(project, file);
                } else {
                    offers.operand(index, here, project, file, replace.start);
                }
            }
            _ if place::begins_command(text, replace.start) => offers.commands(index),
            _ => {}
        }
        let items = rank(offers.items, &text[replace.start..byte]);
        Completions { replace, items }
    })
}

/// Collects completions, the most likely first.
#[derive(Debug, Default)]
struct Offers {
    items: Vec<Completion>,
}

impl Offers {
    fn add(&mut self, text: &str, kind: CompletionKind, detail: impl Into<String>) {
        self.items.push(Completion {
            text: text.to_owned(),
            kind,
            detail: detail.into(),
            insert: text.to_owned(),
            swatch: None,
            picture: None,
        });
    }

    /// Adds commands: those of the text, then the groups that models are made of.
    fn commands(&mut self, index: &Index<'_>) {
        for name in index.names(SymbolKind::Command) {
            self.add(
                name,
                CompletionKind::Name(SymbolKind::Command),
                "defined in the text",
            );
        }
        let order = [
            Group::Primitives,
            Group::Materials,
            Group::Objects,
            Group::Extensions,
            Group::Scene,
            Group::Camera,
            Group::Options,
            Group::Run,
            Group::Tools,
        ];
        let groups = order.map(|wanted| {
            let mut groups = commands::GROUPS.iter();
            groups.find(|(group, _)| *group == wanted)
        });
        for idle in [false, true] {
            for spec in groups.iter().flatten().flat_map(|(_, list)| *list) {
                if spec.idle().is_some() == idle {
                    self.add(spec.name, CompletionKind::Command, spec.meaning);
                }
            }
        }
    }

    fn files(&mut self, project: &Project, present: usize) {
        for (number, file) in project.files.iter().enumerate() {
            if number != present {
                let kind = CompletionKind::Name(SymbolKind::File);
                self.add(&file.name, kind, "a file of the project");
            }
        }
        for (name, _) in library::FILES {
            if !project.files.iter().any(|file| file.name == *name) {
                let kind = CompletionKind::Name(SymbolKind::File);
                self.add(name, kind, "a file of the library");
            }
        }
    }

    /// Adds the images of the library.
    fn images(&mut self) {
        for asset in library::assets() {
            if rats::is_image(&asset.name) {
                let kind = CompletionKind::Name(SymbolKind::File);
                self.add(&asset.name, kind, "an image of the library");
            }
        }
    }

    fn operand(
        &mut self,
        index: &Index<'_>,
        here: &Here<'_>,
        project: &Project,
        file: usize,
        before: usize,
    ) {
        for want in &here.wants {
            match want {
                Want::Parameter {
                    parameter, part, ..
                } => self.parameter(index, here, project, file, parameter, *part),
                Want::Value => self.values(here, None, ""),
                Want::Options(list) => self.options(here, list, before),
                Want::Lead(word) => self.add(word, CompletionKind::Word, ""),
            }
        }
        let at_operand = matches!(here.wants.first(), Some(Want::Parameter { part: 0, .. }));
        if here.grammar.named && at_operand {
            self.parameter_names(here, before);
        }
    }

    /// Adds the parameters of a defined command that can be given by name.
    fn parameter_names(&mut self, here: &Here<'_>, before: usize) {
        for parameter in &here.grammar.parameters {
            let is_given = here.operands.iter().any(|(span, slot)| {
                span.end < before && slot.parameter.is_some_and(|p| p.name == parameter.name)
            });
            if is_given {
                continue;
            }
            self.items.push(Completion {
                text: format!("{}=", parameter.name),
                kind: CompletionKind::Name(SymbolKind::Parameter),
                detail: describe(parameter),
                insert: format!("{}=", parameter.name),
                swatch: None,
                picture: None,
            });
        }
    }

    /// Adds the option words, those first that are not given yet.
    fn options(&mut self, here: &Here<'_>, list: &'static [OptionSpec], before: usize) {
        let (given, missing): (Vec<_>, Vec<_>) = list.iter().partition(|option| {
            here.operands.iter().any(|(span, slot)| {
                span.end <= before
                    && matches!(slot.what, What::Option)
                    && slot.option.is_some_and(|given| given.name == option.name)
            })
        });
        for option in missing.into_iter().chain(given) {
            let synopsis = option.synopsis();
            let after = synopsis.strip_prefix(option.name).unwrap_or("").trim();
            let detail = if after.is_empty() {
                option.meaning.to_owned()
            } else {
                format!("{after}: {}", option.meaning)
            };
            self.add(option.name, CompletionKind::Option, detail);
            self.picture(here, option);
        }
    }

    fn words(&mut self, here: &Here<'_>, list: &'static [OptionSpec]) {
        for word in list {
            self.add(word.name, CompletionKind::Word, word.meaning);
            self.picture(here, word);
        }
    }

    /// Gives the last completion its picture.
    fn picture(&mut self, here: &Here<'_>, word: &OptionSpec) {
        if let (Some(spec), Some(last)) = (here.spec, self.items.last_mut()) {
            last.picture = crate::swatches::picture(spec.name, word.name);
        }
    }

    fn parameter(
        &mut self,
        index: &Index<'_>,
        here: &Here<'_>,
        project: &Project,
        file: usize,
        parameter: &Param<'_>,
        part: u8,
    ) {
        let detail = describe(parameter);
        match parameter.kind {
            Kind::Known(names) => self.names(index, here, names),
            Kind::Copy(names) if part > 0 => self.names(index, here, names),
            Kind::Copy(_) => self.add("=", CompletionKind::Word, detail),
            Kind::New(Names::Variable) => {
                // To set it anew.
                for (name, _, kind) in &here.variables {
                    self.add(name, CompletionKind::Name(*kind), kind.word());
                }
            }
            Kind::File => self.files(project, file),
            Kind::Switch => {
                self.add("on", CompletionKind::Word, "");
                self.add("off", CompletionKind::Word, "");
            }
            Kind::Word(list) => self.words(here, list),
            Kind::Method if part == 1 || is_strength(here) => self.words(here, options::WAVES),
            Kind::Method if part == 2 => self.words(here, options::MAPPINGS),
            Kind::Method => {
                self.words(here, options::SOLIDS);
                self.words(here, options::WAVES);
                self.images();
                self.colours();
            }
            Kind::Number { .. } | Kind::Whole { .. } | Kind::Condition => {
                self.values(here, Some(Type::Number), &detail);
            }
            Kind::Vector | Kind::Direction if part == 0 => self.values(here, None, &detail),
            Kind::Vector | Kind::Direction => self.values(here, Some(Type::Number), &detail),
            Kind::Colour | Kind::Backdrop | Kind::Share if part == 0 => {
                self.variables(here, None, &detail);
                self.functions(|name| name == "rgb");
                self.colours();
                self.functions(|name| name != "rgb");
            }
            Kind::Value if part == 0 => {
                self.values(here, None, &detail);
                self.colours();
            }
            Kind::Colour | Kind::Backdrop | Kind::Share | Kind::Value => {
                self.values(here, Some(Type::Number), &detail);
            }
            Kind::New(_) | Kind::NewFile | Kind::Text | Kind::Block => {}
        }
    }

    fn names(&mut self, index: &Index<'_>, here: &Here<'_>, names: Names) {
        let kind = match names {
            Names::Material => SymbolKind::Material,
            Names::Texture => SymbolKind::Texture,
            Names::Object => SymbolKind::Object,
            Names::Variable => SymbolKind::Variable,
            Names::Command => SymbolKind::Command,
            Names::Node => SymbolKind::Node,
            Names::Preset => SymbolKind::Preset,
        };
        for (name, value, kind) in &here.variables {
            if *value == Type::Name {
                self.add(
                    name,
                    CompletionKind::Name(*kind),
                    "a name that is passed on",
                );
            }
        }
        for name in index.names(kind) {
            self.add(name, CompletionKind::Name(kind), kind.word());
        }
        if names == Names::Command {
            for spec in commands::all() {
                self.add(spec.name, CompletionKind::Command, spec.meaning);
            }
        }
    }

    /// Adds variables of a type (or all), functions and constants.
    fn values(&mut self, here: &Here<'_>, wanted: Option<Type>, detail: &str) {
        self.variables(here, wanted, detail);
        self.functions(|_| true);
        self.add("pi", CompletionKind::Function, "3.14159…");
    }

    /// Adds variables of a type (or all), then the parts of triples where a number is wanted.
    fn variables(&mut self, here: &Here<'_>, wanted: Option<Type>, detail: &str) {
        let fits = |value: Type| match value {
            Type::Name => false,
            Type::Any => true,
            known => wanted.is_none_or(|wanted| wanted == known),
        };
        for (name, value, kind) in here.variables.iter().filter(|(_, value, _)| fits(*value)) {
            let what = match value {
                Type::Triple => "three numbers",
                Type::Number => "a number",
                Type::Name | Type::Any => "a value",
            };
            let detail = if detail.is_empty() {
                format!("{}, {what}", kind.word())
            } else {
                format!("{}, {what}, for {detail}", kind.word())
            };
            self.add(name, CompletionKind::Name(*kind), detail);
        }
        for (name, value, kind) in &here.variables {
            if *value == Type::Triple && !fits(*value) {
                for part in ["x", "y", "z"] {
                    let text = format!("{name}.{part}");
                    self.add(&text, CompletionKind::Name(*kind), "a number of the three");
                }
            }
        }
    }

    fn functions(&mut self, wanted: impl Fn(&str) -> bool) {
        for function in functions::FUNCTIONS.iter().filter(|f| wanted(f.name)) {
            self.items.push(Completion {
                text: function.name.to_owned(),
                kind: CompletionKind::Function,
                detail: function.meaning.to_owned(),
                insert: format!("{}(", function.name),
                swatch: None,
                picture: None,
            });
        }
    }

    fn colours(&mut self) {
        for name in colours::names() {
            let swatch = colours::find(name);
            let detail = swatch.map(hex).unwrap_or_default();
            self.items.push(Completion {
                text: name.to_owned(),
                kind: CompletionKind::Colour,
                detail,
                insert: name.to_owned(),
                swatch,
                picture: None,
            });
        }
    }
}

/// Returns whether a texture's target is the strength, which takes waves only.
fn is_strength(here: &Here<'_>) -> bool {
    here.operands
        .iter()
        .any(|(_, slot)| matches!(slot.what, What::Word(word) if word.name == "strength"))
}

/// Writes a colour as `#rrggbb`.
pub(crate) fn hex(colour: [f32; 3]) -> String {
    let [r, g, b] = colour.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Returns a parameter's meaning, unit, range and default.
pub(crate) fn describe(parameter: &Param<'_>) -> String {
    let mut text = if parameter.meaning.is_empty() {
        parameter.name.to_owned()
    } else {
        parameter.meaning.to_owned()
    };
    for more in [parameter.unit.word(), &parameter.range()] {
        if !more.is_empty() {
            text += ", ";
            text += more;
        }
    }
    if !parameter.default.is_empty() {
        text += &format!(" (by default {})", parameter.default);
    }
    text
}

/// Returns the completions that fit the letters typed, the best first.
fn rank(items: Vec<Completion>, typed: &str) -> Vec<Completion> {
    let mut seen = HashSet::new();
    let mut fitting: Vec<(usize, usize, Completion)> = items
        .into_iter()
        .enumerate()
        .filter_map(|(place, item)| Some((fit(&item.text, typed)?, place, item)))
        .filter(|(_, _, item)| seen.insert((item.text.clone(), item.kind)))
        .collect();
    field::heap_sort(&mut fitting, |a, b| (a.0, a.1) < (b.0, b.1));
    fitting.truncate(MAX_COMPLETIONS);
    fitting.into_iter().map(|(_, _, item)| item).collect()
}

/// Returns how well a text fits the letters typed, in any case: 0 begins with them, 1 holds them, 2
/// nearly.
fn fit(text: &str, typed: &str) -> Option<usize> {
    let (lower, typed_lower) = (text.to_lowercase(), typed.to_lowercase());
    if lower.starts_with(&typed_lower) {
        return Some(0);
    }
    if lower.contains(&typed_lower) {
        return Some(1);
    }
    let letters = typed.chars().count();
    if letters < 3 {
        return None;
    }
    let beginning: String = text.chars().take(letters).collect();
    let near = suggest::nearest(typed, [text, beginning.as_str()]);
    near.map(|_| 2)
}
