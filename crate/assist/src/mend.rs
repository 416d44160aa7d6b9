//! Completes the blocks of a text that is being written, so that the parser keeps the commands in
//! them.

use crate::index::Index;
use rats::Project;
use rats::lexer::{TokenKind, lex};

/// Reads the index of a project whose command at a byte is looked at; of the mended project, if
/// there is none in the text as it stands.
pub fn with_index<T>(
    project: &Project,
    file: usize,
    byte: usize,
    read: impl FnOnce(&Index<'_>) -> T,
) -> T {
    let index = Index::at(project, Some((file, byte)));
    let mended = match index.here {
        Some(_) => None,
        None => mend(project, file, byte),
    };
    match &mended {
        Some(mended) => read(&Index::at(mended, Some((file, byte)))),
        None => read(&index),
    }
}

/// Closes the blocks of a file of a project: a loop or choice whose line ends at the caret
/// without `{` gets an empty block, and blocks that are open at the end of the text end there.
/// Bytes up to the caret stay where they are. `None` if there is nothing to mend.
fn mend(project: &Project, file: usize, byte: usize) -> Option<Project> {
    let text = &project.files.get(file)?.text;
    let mut mended = text.clone();
    let line = text[..byte].rfind(['\n', '{', '}']).map_or(0, |at| at + 1);
    let rest = &text[byte..];
    let end = byte + rest.find(['\n', '#', '{', '}']).unwrap_or(rest.len());
    let has_block = text[end..].trim_start().starts_with('{');
    if !has_block && is_structure(&text[line..end]) {
        mended.insert_str(end, " {}");
    }
    let open = open_blocks(&mended);
    // The last line may be a comment.
    mended += &"\n}".repeat(open);
    if mended.len() == text.len() {
        return None;
    }
    let mut project = project.clone();
    project.files[file].text = mended;
    Some(project)
}

/// Returns whether a line's command has a block.
fn is_structure(line: &str) -> bool {
    let line = line.trim_start_matches(|c: char| c.is_whitespace() || "@}".contains(c));
    let word = line.split(|c: char| !c.is_alphanumeric()).next();
    word.is_some_and(|word| {
        ["for", "if", "else", "define"]
            .iter()
            .any(|known| known.eq_ignore_ascii_case(word))
    })
}

/// Counts the `{` of blocks that have no `}`.
fn open_blocks(text: &str) -> usize {
    let mut open = Vec::new();
    for token in lex(text) {
        if token.kind != TokenKind::Sign {
            continue;
        }
        match &text[token.range()] {
            "{" => open.push(token.start),
            "}" => _ = open.pop(),
            _ => {}
        }
    }
    open.retain(|&at| {
        let line = text[..at].rfind(['\n', '{']).map_or(0, |start| start + 1);
        is_structure(&text[line..at])
    });
    open.len()
}
