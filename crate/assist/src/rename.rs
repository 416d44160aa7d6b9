//! Gives a thing another name, wherever it is named.

use crate::grammar::is_triple;
use crate::index::{Index, Occurrence, SymbolKind};
use rats::lexer::{TokenKind, lex};
use rats::{Project, TextEdit, colours, commands, functions};

/// Computes the changes that rename the thing that a name at a byte stands for, through all files,
/// in the order of files and places. Files are renamed with [`rename_file`].
///
/// # Errors
/// A sentence that says why not: if there is no name at the byte, or the new one is not allowed, is
/// taken, or would be read as something else somewhere; or if a text has a mistake of form, such as
/// a block that is not closed, since names could be overlooked in it.
///
/// ```
/// let text = "var r = 1\nvar s = 2\nsurface Clay, diffuse SandyBrown\nsphere Clay r, s 0 0\n";
/// let project = rats::Project::single(text);
/// let edits = assist::rename(&project, 0, 4, "radius").unwrap();
/// assert_eq!(edits.len(), 2);
/// let renamed = project.apply(&edits);
/// assert!(renamed.files[0].text.ends_with("sphere Clay radius, s 0 0\n"));
/// assert!(assist::rename(&project, 0, 4, "s").is_err());
/// ```
pub fn rename(
    project: &Project,
    file: usize,
    byte: usize,
    new_name: &str,
) -> Result<Vec<TextEdit>, String> {
    let index = Index::of(project);
    let occurrence = index
        .occurrence(file, byte)
        .ok_or("there is no name here that the texts define")?;
    let kind = index.kind(occurrence);
    let name = index.name(occurrence);
    if kind == SymbolKind::File {
        // Changes of texts alone would leave the file with its old name.
        return Err(format!(
            "`{name}` is a file: rename the file itself, and what reads it follows"
        ));
    }
    if name == new_name {
        return Ok(Vec::new());
    }
    check_name(kind, name, new_name)?;
    if let Some((file, byte, message)) = &index.mistake {
        // A block that the parser leaves out could hold the name.
        return Err(format!(
            "first mend {}: {message}",
            line(project, *file, *byte)
        ));
    }
    if let Some(place) = index.clash(occurrence, new_name) {
        return Err(format!(
            "`{new_name}` is taken: {} makes a {} of that name",
            line(project, place.file, place.span.start),
            kind.word()
        ));
    }
    let edits = edits(&index, occurrence, new_name);
    // A word's meaning depends on its neighbours, so the renamed texts are checked.
    let after = project.apply(&edits);
    if Index::of(&after).shape() != index.shape() {
        return Err(format!(
            "`{new_name}` would be taken for something else in one of the places"
        ));
    }
    Ok(edits)
}

/// Computes the changes of all `read`s (and images) that go with a file's new name; the file itself
/// is renamed by whoever keeps it.
///
/// # Errors
/// A sentence, if there is no such file, or the new name is not allowed or taken.
///
/// ```
/// use rats::{File, Project};
///
/// let mut project = Project::single("read leg.rat\n");
/// project.files.push(File { name: "leg.rat".into(), text: String::new() });
/// let edits = assist::rename_file(&project, 1, "arm.rat").unwrap();
/// assert_eq!(project.apply(&edits).files[0].text, "read arm.rat\n");
/// ```
pub fn rename_file(
    project: &Project,
    file: usize,
    new_name: &str,
) -> Result<Vec<TextEdit>, String> {
    let renamed = project.files.get(file).ok_or("there is no such file")?;
    if new_name.is_empty() || new_name.starts_with("./") {
        return Err(String::from("a file needs a name of letters"));
    }
    let mut letters = new_name.chars();
    if let Some(odd) = letters.find(|c| c.is_whitespace() || ",<>{}#@%!()=".contains(*c)) {
        return Err(format!("a file's name cannot hold `{odd}`"));
    }
    let tokens = lex(new_name);
    let mut kinds = tokens.iter().map(|token| token.kind);
    if !kinds.all(|kind| matches!(kind, TokenKind::Word | TokenKind::Number | TokenKind::Sign)) {
        return Err(String::from(
            "a file's name can hold letters, digits, and . _ - / only",
        ));
    }
    let others = project.files.iter().enumerate();
    if others.clone().any(|(i, f)| i != file && f.name == new_name) {
        return Err(format!("there is a file `{new_name}` already"));
    }
    let index = Index::of(project);
    Ok(index
        .uses_of_file(&renamed.name)
        .map(|place| TextEdit {
            file: place.file,
            span: place.span.clone(),
            text: new_name.to_owned(),
        })
        .collect())
}

/// Checks whether a name can be given to a thing.
///
/// # Errors
/// A sentence that says why not.
fn check_name(kind: SymbolKind, name: &str, new_name: &str) -> Result<(), String> {
    let tokens = lex(new_name);
    let is_word = match tokens.as_slice() {
        [one] => one.kind == TokenKind::Word,
        // `a^b` can be a name, but of a variable it would be a power.
        [first, ..] => {
            !kind.is_variable()
                && kind != SymbolKind::Command
                && first.kind == TokenKind::Word
                && tokens.iter().all(|t| match t.kind {
                    TokenKind::Word | TokenKind::Number => true,
                    _ => &new_name[t.range()] == "^",
                })
        }
        [] => false,
    };
    if !is_word {
        return Err(format!(
            "`{new_name}` is no name: a name is a word of letters, digits and `_`"
        ));
    }
    if kind.is_variable() {
        let taken = ["hot", "to", "step", "and", "or", "not", "on", "off"];
        if taken.iter().any(|word| word.eq_ignore_ascii_case(new_name)) {
            return Err(format!("`{new_name}` is a word of the language"));
        }
        if functions::find(new_name).is_some() || functions::constant(new_name).is_some() {
            return Err(format!("`{new_name}` is a function or constant"));
        }
        if colours::find(new_name).is_some() {
            return Err(format!("`{new_name}` is a colour"));
        }
        if new_name.contains('.') {
            return Err(format!(
                "`{new_name}` would be read as a part of a vector, because of the dot"
            ));
        }
    }
    if kind == SymbolKind::Parameter && is_triple(name) != is_triple(new_name) {
        return Err(String::from(
            "a parameter in CAPITALS takes a triple, another one a number, so the new name must be \
             written like the old one",
        ));
    }
    if kind == SymbolKind::Command && commands::find(new_name).is_some() {
        return Err(format!("`{new_name}` is already a command of the language"));
    }
    Ok(())
}

/// Returns a place in words, as in "line 3 of main.rat".
fn line(project: &Project, file: usize, byte: usize) -> String {
    let file = &project.files[file];
    let line = file.text[..byte].matches('\n').count() + 1;
    format!("line {line} of {}", file.name)
}

/// Returns the changes of all places of a name.
fn edits(index: &Index<'_>, occurrence: &Occurrence, new_name: &str) -> Vec<TextEdit> {
    index
        .all_of(occurrence)
        .map(|o| TextEdit {
            file: o.place.file,
            span: o.place.span.clone(),
            text: new_name.to_owned(),
        })
        .collect()
}
