//! Texts to try things on: the examples, the corpus of mistakes, and random ones.

use rats::{File, Project, commands};
use std::path::Path;
use trials::arbitrary::{Result, Unstructured};

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
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../rats/tests/diagnostics");
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
    paths
        .into_iter()
        .map(|path| std::fs::read_to_string(path).expect("a text"))
        .collect()
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
        "define c(surface s, r=1) {",
        "c s1, r=2",
        "shell s1",
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
    let all: Vec<_> = commands::all().collect();
    let mut text = String::new();
    for _ in 0..u.int_in_range(0..=100)? {
        match u.int_in_range(0..=5)? {
            0 => text += u.choose(&all)?.name,
            1 => {
                let spec = u.choose(&all)?;
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

/// The place in a project that `|` marks; the mark is taken out. `#file name` begins another file.
pub fn at_mark(text: &str) -> (Project, usize, usize) {
    let mut files = vec![file("main.rat", "")];
    for line in text.split_inclusive('\n') {
        match line.strip_prefix("#file ") {
            Some(name) => files.push(file(name.trim(), "")),
            None => files.last_mut().expect("a file").text += line,
        }
    }
    let index = files
        .iter()
        .position(|f| f.text.contains('|'))
        .expect("a mark");
    let byte = files[index].text.find('|').expect("a mark");
    files[index].text.remove(byte);
    (Project { files }, index, byte)
}

/// A text of definitions and uses of a few names in any order.
pub fn names_soup(u: &mut Unstructured<'_>) -> Result<String> {
    const LINES: &[&str] = &[
        "var a = 1",
        "var a = b + 1",
        "var b = a",
        "var P = a b 0",
        "var P = P*2",
        "var a = P.x",
        "var a += 1",
        "surface s diff Red",
        "surface s = t, rad a*a",
        "surface t diff Red, rad 1",
        "surface t = s",
        "texture m strength sin one, scale P",
        "surface s text m",
        "object O\nsphere s a P\nclose O",
        "chain s, O\nsphere a P\nclose",
        "sphere s a P",
        "sphere t b 0 0 a",
        "for a = 0 to 2 {",
        "for b = a to 3 step 2 {",
        "for i = 1 to 2 {",
        "if a < b {",
        "if a {",
        "if i < b {",
        "} else {",
        "define f(a, P) {",
        "define f(a) {",
        "define g(surface s, r = 2) {",
        "define g(surface s, b = 1) {",
        "define g(surface t, r = a*a) {",
        "define f(b, i = b) {",
        "f a, P",
        "f b",
        "f a",
        "g s",
        "g s, b",
        "g s, b=a",
        "g s, r=a",
        "}",
        "}",
        "}",
        "}",
        "read other.rat",
        "sphere s i 0 0 0",
        "sphere s r P",
        "surface s shine i*i",
        "var i = i + 1",
        "var r = a",
    ];
    let mut text = String::new();
    if u.ratio(3, 4)? {
        text += "var a = 1\nvar b = 2\nvar i = 3\nvar r = 4\nvar P = 1 2 3\nsurface s rad 1\n\
            surface t rad 2\n";
        text += "texture m strength sin one\ndefine f(a, P = 1 2 3) { sphere s a P }\n\
            define g(surface s, b = 2, r = 1) { sphere s b P }\n";
    }
    let mut open = 0;
    for _ in 0..u.int_in_range(0..=30)? {
        let line = *u.choose(LINES)?;
        if line.starts_with('}') && open == 0 {
            continue;
        }
        // Deeply nested loops would take long.
        if line.ends_with('{') && open > 3 {
            continue;
        }
        open -= usize::from(line.starts_with('}'));
        open += usize::from(line.ends_with('{'));
        text += line;
        text.push('\n');
    }
    text += &"}\n".repeat(open);
    Ok(text)
}
