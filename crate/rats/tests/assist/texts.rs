//! Texts to try things on: the examples, the corpus of mistakes, and random ones.

use arbtest::arbitrary::{Result, Unstructured};
use rats::{File, Project, commands};
use std::path::Path;

/// A project of one text.
pub fn one_file(text: &str) -> Project {
    Project {
        files: vec![file("main.rat", text)],
    }
}

/// A file.
pub fn file(name: &str, text: &str) -> File {
    File {
        name: name.to_owned(),
        text: text.to_owned(),
    }
}

/// The examples of the page.
pub fn examples() -> Vec<Project> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../www/examples");
    let texts = texts_in(&folder, "rat");
    assert!(texts.len() >= 6, "only {} examples", texts.len());
    texts.iter().map(|text| one_file(text)).collect()
}

/// The projects of the corpus of mistakes.
pub fn corpus() -> Vec<Project> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/diagnostics");
    let mut projects = Vec::new();
    for text in texts_in(&folder, "txt") {
        for section in text.split("\n### ") {
            let mut files = vec![file("main.rat", "")];
            for line in section.lines().skip(1) {
                if let Some(name) = line.strip_prefix("#file ") {
                    files.push(file(name, ""));
                } else {
                    let text = &mut files.last_mut().expect("a file").text;
                    *text += line;
                    text.push('\n');
                }
            }
            projects.push(Project { files });
        }
    }
    assert!(projects.len() >= 60, "only {} sections", projects.len());
    projects
}

fn texts_in(folder: &Path, extension: &str) -> Vec<String> {
    let mut paths: Vec<_> = std::fs::read_dir(folder)
        .expect("the folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == extension))
        .collect();
    paths.sort();
    let read = |path| std::fs::read_to_string(path).expect("a text");
    paths.into_iter().map(read).collect()
}

/// A text of words of the language in any order, laid out anyhow.
pub fn soup(u: &mut Unstructured<'_>) -> Result<String> {
    const WORDS: &[&str] = &[
        "1",
        "-2",
        "- 2",
        "-",
        "+",
        "+3",
        "+=",
        "*=",
        "+ =",
        "=",
        "==",
        "<=",
        ">=",
        "!=",
        "*",
        "/",
        "^",
        "a^b",
        "sin^2",
        "(",
        ")",
        "{",
        "}",
        "{}",
        "<",
        ">",
        ",",
        "%",
        "50%",
        "@",
        "# x ",
        "!",
        "a",
        "b",
        "P",
        "P.x",
        "s1",
        "hot",
        "to",
        "step",
        "and",
        "not",
        "Red",
        "rand",
        "sin(1)",
        "sin (1)",
        "pi",
        "diff",
        "blob -1",
        "rad .1",
        "text",
        "strength sin one",
        "all",
        "on",
        "vec(1,2,3)",
        "1e-3",
        "1e",
        "🐚",
        "−",
        "\"x y\"",
        "../a-b.rat",
        "\t",
        "\r\n",
        "\u{feff}",
        "pause",
        "pause a,b {",
        "pause x  -  y\n",
        "var a = 1\n",
        "var a=1",
        "var a",
        "a += 1",
        "surface s1 diff Red\n",
        "surface s1=s1",
        "texture t=t",
        "sphere s1 1 0 0 0\n",
        "for i=1 to 3 {",
        "for i = 1 to 3 {\n",
        "if a<2 {",
        "if a == b {",
        "else {",
        "} else {",
        "define b(P r) {",
        "b 1 2 3 4\n",
        "read other.rat\n",
        "object A\n",
        "chain s1, A\n",
        "close\n",
        "close",
        "}\n",
        "}\n\n\n",
        "{\n",
        "\n",
        "\n",
        "\n",
        "\n\n\n",
    ];
    let mut text = String::new();
    for _ in 0..u.int_in_range(0..=100)? {
        match u.int_in_range(0..=5)? {
            0 => text += commands::COMMANDS[u.choose_index(commands::COMMANDS.len())?].name,
            1 => {
                let spec = &commands::COMMANDS[u.choose_index(commands::COMMANDS.len())?];
                if !spec.options.is_empty() {
                    text += spec.options[u.choose_index(spec.options.len())?].name;
                }
            }
            _ => text += u.choose(WORDS)?,
        }
        match u.int_in_range(0..=9)? {
            0 | 1 => {}
            2 => text += "   ",
            _ => text.push(' '),
        }
    }
    // Most texts would have an open brace.
    if u.ratio(2, 3)? {
        let open = text
            .matches('{')
            .count()
            .saturating_sub(text.matches('}').count());
        text += &"\n}".repeat(open);
    }
    Ok(text)
}
