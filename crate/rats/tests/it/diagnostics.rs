//! Texts with mistakes and what is said about them.
//!
//! Each file of `tests/diagnostics` holds sections. A section begins with `### name`; `#file name`
//! begins another file of the same project. What is expected stands under the line that it is
//! about, as comments: `#! severity first..end: message → hint ⤷ line:column what is
//! there`, where `first` and `end` are columns from 1 and `end` is `…` if the place goes on in
//! another line. A section without such lines must compile without any message.
//!
//! `UPDATE_EXPECT=1 cargo test -p rats --test it diagnostics::` writes what is said now into the
//! files; read the difference before you commit it.

use rats::{Diagnostic, File, Project, Severity, compile};
use std::fmt::Write;
use std::path::Path;

#[test]
fn corpus() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/diagnostics");
    let update = std::env::var_os("UPDATE_EXPECT").is_some();
    let mut sections = 0;
    let mut failures = String::new();
    let mut paths: Vec<_> = std::fs::read_dir(&folder)
        .expect("the folder")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    for path in paths {
        let expected = std::fs::read_to_string(&path).expect("a text");
        let mut actual = String::new();
        for section in sections_of(&expected) {
            sections += 1;
            let section_actual = with_messages(section);
            if section_actual != section && !update {
                let _ = writeln!(
                    failures,
                    "{}\nexpected:\n{section}\nactual:\n{section_actual}",
                    path.display()
                );
            }
            actual += &section_actual;
        }
        if update && actual != expected {
            std::fs::write(&path, actual).expect("writing");
        }
    }
    assert!(failures.is_empty(), "{failures}");
    assert!(sections >= 180, "only {sections} sections were found");
}

fn sections_of(text: &str) -> Vec<&str> {
    let starts: Vec<usize> = text
        .match_indices("### ")
        .map(|(index, _)| index)
        .filter(|index| *index == 0 || text.as_bytes()[index - 1] == b'\n')
        .collect();
    let ends = starts.iter().copied().skip(1).chain([text.len()]);
    starts
        .iter()
        .zip(ends)
        .map(|(start, end)| &text[*start..end])
        .collect()
}

/// Returns the section with the expectations replaced by the messages of its texts.
fn with_messages(section: &str) -> String {
    let (head, body) = section.split_once('\n').expect("a name and a text");
    let mut files = vec![File {
        name: String::from("main.rat"),
        text: String::new(),
    }];
    for line in body.lines().filter(|line| !line.starts_with("#! ")) {
        if let Some(name) = line.strip_prefix("#file ") {
            files.push(File {
                name: name.to_owned(),
                text: String::new(),
            });
        } else {
            let text = &mut files.last_mut().expect("a file").text;
            text.push_str(line);
            text.push('\n');
        }
    }
    let project = Project { files };
    let mut diagnostics = compile(&project).diagnostics;
    let mut out = format!("{head}\n");
    for (index, file) in project.files.iter().enumerate() {
        if index > 0 {
            let _ = writeln!(out, "#file {}", file.name);
        }
        for (number, line) in file.text.lines().enumerate() {
            out += line;
            out.push('\n');
            diagnostics.retain(|d| {
                let is_here = d.file == file.name && d.line == number + 1;
                if is_here {
                    write_expectation(&mut out, d, &file.text);
                }
                !is_here
            });
        }
    }
    assert!(
        diagnostics.is_empty(),
        "outside of the text: {diagnostics:?}"
    );
    out
}

fn write_expectation(out: &mut String, d: &Diagnostic, text: &str) {
    let severity = match d.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    };
    let covered = &text[d.span.clone()];
    let end = if covered.contains('\n') {
        String::from("…")
    } else {
        (d.column + covered.chars().count()).to_string()
    };
    let _ = write!(
        out,
        "#! {severity} {}..{end}: {}",
        d.column,
        d.message.replace('\n', " ⏎ ")
    );
    if let Some(hint) = &d.hint {
        let _ = write!(out, " → {hint}");
    }
    for related in &d.related {
        let message = &related.message;
        let _ = write!(out, " ⤷ {}:{} {message}", related.line, related.column);
    }
    out.push('\n');
}
