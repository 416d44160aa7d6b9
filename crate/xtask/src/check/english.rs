//! The words of the code, which is to read as plain English. Some things that are not can be
//! counted, and their counts may only fall. `tests/english.txt` holds those of each crate; a run
//! that finds fewer lowers them there.

use crate::shell::{root, tell, words};
use anyhow::{Context, Result, bail};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Words that a doc comment does not open with. It opens with the noun that it describes, or with
/// what a function does: "Returns", "Computes".
const ODD: &str = "also all and another any are as at before behind beside besides between beyond \
    both but by each else for from further has have here how if in is it its likewise much nearly \
    no not of on one only or other others same see so some such that their them there these they \
    this those three to two until up what when where which while who whose with within";
/// Articles, after which the first word counts.
const ARTICLES: &str = "a an the";
/// Participles beside those that end with "ed". A function is named by a verb: `turn`, not
/// `turned`.
const PARTICIPLES: &str = "begun bent born bought bound broken brought built chosen done drawn \
    driven fallen felt forgotten found given gone grown heard held hidden kept known laid left \
    lent lost made meant met paid risen said seen sent shaken shown shrunk spent stolen stood \
    struck sunk swollen swung taken taught thrown told torn understood woken won worn wound \
    written";
/// Words that end with "ed" and are no participles.
const VERBS: &str = "bleed breed embed exceed feed heed need proceed seed shed speed succeed";
/// Words for which the literature has another: blob.
const FOREIGN: &str = "lump lumps lumpy";
/// Most columns of a line.
const COLUMNS: usize = 100;

/// Things that are counted, in the order of the file's columns.
const COUNTED: [&str; 5] = [
    "doc comments that open oddly",
    "functions named by a participle",
    "closures with a name",
    "foreign words",
    "lines over 100 columns",
];

/// Counts of [`COUNTED`], each with the place that was found last.
#[derive(Debug, Default)]
struct Counts([(usize, String); COUNTED.len()]);

/// Compares the counts of all crates with those kept.
///
/// # Errors
/// If one has risen; the message names a place of each.
pub fn check() -> Result<()> {
    let path = root().join("tests/english.txt");
    let kept = fs::read_to_string(&path)?;
    let (head, rows) = kept
        .split_once("\n\n")
        .context("tests/english.txt has a head")?;
    let kept_rows: BTreeMap<&str, Vec<usize>> = rows
        .lines()
        .filter_map(|row| row.split_once(' '))
        .map(|(name, row)| {
            (
                name,
                words(row).iter().filter_map(|n| n.parse().ok()).collect(),
            )
        })
        .collect();
    let mut found = BTreeMap::new();
    for package in fs::read_dir(root().join("crate"))? {
        let folder = package?.path();
        let mut counts = Counts::default();
        read(&folder, &mut counts)?;
        let name = folder.file_name().unwrap_or_default();
        found.insert(name.to_string_lossy().into_owned(), counts);
    }
    let (mut text, mut risen) = (format!("{head}\n\n"), String::new());
    for (name, Counts(counts)) in &found {
        let before = kept_rows.get(name.as_str());
        let row: Vec<String> = counts.iter().map(|(n, _)| n.to_string()).collect();
        writeln!(text, "{name} {}", row.join(" "))?;
        for (i, (n, place)) in counts.iter().enumerate() {
            let most = before.and_then(|row| row.get(i)).copied().unwrap_or(0);
            if *n > most {
                let what = COUNTED[i];
                writeln!(risen, "{name}: {n} {what}, at most {most}; one is {place}")?;
            }
        }
    }
    if !risen.is_empty() {
        bail!(
            "CONTRIBUTING.md says how the code is to read.\n{}",
            risen.trim_end()
        );
    }
    if text != kept {
        fs::write(path, text)?;
        tell("tests/english.txt holds the lower counts now.");
    }
    Ok(())
}

/// Counts in all files of Rust in a folder.
fn read(folder: &Path, counts: &mut Counts) -> Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            read(&path, counts)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let place = path.strip_prefix(root()).unwrap_or(&path).display();
            counts.add(&fs::read_to_string(&path)?, &place.to_string());
        }
    }
    Ok(())
}

impl Counts {
    /// Adds the counts of a text.
    fn add(&mut self, text: &str, file: &str) {
        let mut was_doc = false;
        for (line, number) in text.lines().zip(1..) {
            let code = line.trim_start();
            let doc = code
                .strip_prefix("///")
                .or_else(|| code.strip_prefix("//!"));
            let is_comment = code.starts_with("//");
            let opens_oddly = doc.is_some_and(|doc| !was_doc && opens_oddly(doc));
            was_doc = doc.is_some();
            let found = [
                usize::from(opens_oddly),
                usize::from(!is_comment && function(code).is_some_and(is_participle)),
                usize::from(!is_comment && names_a_closure(code)),
                foreign(line),
                usize::from(line.chars().count() > COLUMNS),
            ];
            for ((count, place), n) in self.0.iter_mut().zip(found) {
                if n > 0 {
                    *count += n;
                    *place = format!("{file}:{number}");
                }
            }
        }
    }
}

/// Whether a word is in a list.
fn is_in(list: &str, word: &str) -> bool {
    list.split_whitespace().any(|other| other == word)
}

/// Whether a doc comment opens with neither a noun nor a verb.
fn opens_oddly(doc: &str) -> bool {
    let first = doc
        .split_whitespace()
        .map(|word| word.to_lowercase())
        .find(|word| !is_in(ARTICLES, word));
    first.is_some_and(|word| {
        word.starts_with('…') || is_in(ODD, word.trim_end_matches([',', '.', ';', ':']))
    })
}

/// Returns the name of the function that a line declares.
fn function(code: &str) -> Option<&str> {
    let (before, after) = code.split_once("fn ")?;
    let is_word = before.is_empty() || before.ends_with(' ');
    let end = after.find(|c: char| c != '_' && !c.is_alphanumeric())?;
    Some(&after[..end]).filter(|name| is_word && !name.is_empty())
}

/// Whether a name begins with a participle.
fn is_participle(name: &str) -> bool {
    let first = name.split('_').next().unwrap_or(name);
    is_in(PARTICIPLES, first) || first.len() > 3 && first.ends_with("ed") && !is_in(VERBS, first)
}

/// Whether a line binds a closure to a name.
fn names_a_closure(code: &str) -> bool {
    let Some((name, value)) = code
        .strip_prefix("let ")
        .and_then(|rest| rest.split_once(" = "))
    else {
        return false;
    };
    let name = name.trim_start_matches("mut ");
    let is_name = name.chars().all(|c| c == '_' || c.is_alphanumeric());
    is_name && value.trim_start_matches("move ").starts_with('|')
}

/// Counts the foreign words of a line.
fn foreign(line: &str) -> usize {
    line.split(|c: char| !c.is_alphabetic())
        .filter(|word| is_in(FOREIGN, &word.to_lowercase()))
        .count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_thing_is_counted() {
        let text = "/// Those whose field is low.\n/// So it is.\npub fn turned(x: f64) -> f64 {\n\
            \x20   let twice = |x| 2.0 * x;\n    let sum = 1.0 + x;\n}\n\n\
            /// The field of a blob.\nfn need_lump() {}\n/// The same of an arc.\n// fn said(\n";
        let long = format!("{text}// {}\n", "x".repeat(COLUMNS));
        let mut counts = Counts::default();
        counts.add(&long, "a.rs");
        assert_eq!(counts.0.clone().map(|(n, _)| n), [2, 1, 1, 1, 1]);
        assert_eq!(counts.0[1].1, "a.rs:3");
    }
}
