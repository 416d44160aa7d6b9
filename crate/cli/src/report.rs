//! Showing diagnostics to a person.

use crate::files::Loaded;
use codespan_reporting::diagnostic::{Diagnostic, Label};
use codespan_reporting::files::SimpleFiles;
use codespan_reporting::term;
use rats::Severity;
use std::io::IsTerminal;

/// Characters of a source line that are shown.
const EXCERPT_WIDTH: usize = 200;

/// Writes all diagnostics to the standard error, with the lines they are about.
///
/// Returns whether the dataset is free of errors.
pub fn to_stderr(loaded: &Loaded) -> bool {
    let text = text(loaded, Severity::Note);
    if std::io::stderr().is_terminal() && !text.is_empty() {
        eprintln!();
    }
    eprint!("{text}");
    is_clean(loaded)
}

/// The diagnostics that are at least so bad, with the lines they are about.
pub fn text(loaded: &Loaded, least: Severity) -> String {
    let mut files = SimpleFiles::new();
    let ids: Vec<_> = loaded
        .project
        .files
        .iter()
        .map(|file| {
            (
                file.name.as_str(),
                files.add(file.name.as_str(), file.text.as_str()),
            )
        })
        .collect();
    let mut text = String::new();
    let diagnostics = loaded.compiled.diagnostics.iter();
    for diagnostic in diagnostics.filter(|diagnostic| diagnostic.severity >= least) {
        let shown = match diagnostic.severity {
            Severity::Error => Diagnostic::error(),
            Severity::Warning => Diagnostic::warning(),
            Severity::Note => Diagnostic::note(),
        };
        let label = ids
            .iter()
            .find(|(name, _)| *name == diagnostic.file)
            .map(|&(_, id)| Label::primary(id, diagnostic.span.clone()));
        let shown = shown
            .with_message(&diagnostic.message)
            .with_labels(label.into_iter().collect())
            .with_notes(
                diagnostic
                    .hint
                    .iter()
                    .map(|hint| format!("help: {hint}"))
                    .collect(),
            );
        let config = term::Config::default();
        if term::emit_to_string(&mut text, &config, &files, &shown).is_err() {
            // The excerpt could not be drawn; the message itself must not be lost.
            text.push_str(&format!(
                "{}:{}:{}: {}\n",
                diagnostic.file, diagnostic.line, diagnostic.column, diagnostic.message
            ));
        }
    }
    shorten(&text)
}

/// Cuts excerpts of long source lines; the line and column of a place stand before them.
fn shorten(text: &str) -> String {
    let lines = text.lines();
    let lines = lines.map(|line| match line.char_indices().nth(EXCERPT_WIDTH) {
        Some((end, _)) if line.contains('│') => format!("{}…\n", line[..end].trim_end()),
        _ => format!("{line}\n"),
    });
    lines.collect()
}

/// Whether a dataset has no errors (warnings are fine).
pub fn is_clean(loaded: &Loaded) -> bool {
    loaded
        .compiled
        .diagnostics
        .iter()
        .all(|diagnostic| diagnostic.severity != Severity::Error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn excerpts_of_long_lines_are_cut() {
        let long = "x".repeat(300);
        let text = format!("error: {long}\n1 │ é{long}\n  │ ^\n\n");
        let lines = shorten(&text);
        let lines: Vec<&str> = lines.split('\n').collect();
        assert_eq!(lines[0], format!("error: {long}"));
        assert_eq!(lines[1].chars().count(), EXCERPT_WIDTH + 1);
        assert!(lines[1].ends_with("x…"));
        assert_eq!(lines[2..], ["  │ ^", "", ""]);
    }
}
