//! Completion at the caret.

use crate::texts::{at_mark, corpus, examples, file, names_soup, one_file, soup};
use assist::complete::MAX_COMPLETIONS;
use assist::{Completion, complete};
use trials::trials;

fn offers(text: &str) -> Vec<Completion> {
    let (project, file, byte) = at_mark(text);
    complete(&project, file, byte).items
}

fn texts(text: &str) -> Vec<String> {
    offers(text).into_iter().map(|item| item.text).collect()
}

/// The first things that are offered at `|` are these.
fn begins(text: &str, wanted: &[&str]) {
    let found = texts(text);
    assert_eq!(
        &found[..wanted.len().min(found.len())],
        wanted,
        "{text}: {found:?}"
    );
}

/// Checks that these and no others are offered at `|`.
fn exactly(text: &str, wanted: &[&str]) {
    assert_eq!(texts(text), wanted, "{text}");
}

/// Checks that these are among what is offered at `|`, and that those that begin with `!` are not.
fn among(text: &str, wanted: &[&str]) {
    let found = texts(text);
    for word in wanted {
        match word.strip_prefix('!') {
            Some(word) => assert!(
                !found.iter().any(|f| f == word),
                "{text}: {word} in {found:?}"
            ),
            None => assert!(
                found.iter().any(|f| f == word),
                "{text}: no {word} in {found:?}"
            ),
        }
    }
}

const HEAD: &str = "surface Skin diff Red\nsurface Bone diff White\n\
    texture Rings strength sin one\n\
    object SHELL\nclose\nvar r = 1\nvar P = 1 2 3\ndefine leg(surface s, B, length = 2) {\n}\n";

fn with_head(text: &str) -> String {
    format!("{HEAD}{text}")
}

#[test]
fn commands() {
    begins("sph|", &["sphere", "sphereflake"]);
    begins("SPH|", &["sphere"]);
    begins("if a { sph|", &["sphere"]);
    begins("  @sph|", &["sphere"]);
    begins("quit\nsph|ere s 1", &["sphere"]);
    // In the middle, then with slips.
    begins("here|", &["sphere", "sphereflake"]);
    among("spehre|", &["sphere"]);
    begins(&with_head("le|"), &["leg"]);
    among("|", &["sphere", "surface"]);
    exactly("1 2 |", &[]);
    exactly("# sph|", &[]);
    exactly("quit # sph|", &[]);
    exactly("nosuch |", &[]);
}

#[test]
fn names() {
    exactly(&with_head("sphere |"), &["Bone", "Skin"]);
    exactly(&with_head("sphere S|"), &["Skin"]);
    exactly(&with_head("sphere s|"), &["Skin"]);
    exactly(&with_head("sphere Ski|n 1 0 0 0"), &["Skin"]);
    exactly(&with_head("rotate 0 0 1 30, |"), &["SHELL"]);
    exactly(&with_head("instance |"), &["SHELL"]);
    exactly(&with_head("surface New = |"), &["Bone", "Skin"]);
    exactly(&with_head("surface New rad 1 texture |"), &["Rings"]);
    exactly(
        &with_head("surface New rad 1 texture Rings + |"),
        &["Rings"],
    );
    begins(&with_head("leg |"), &["Bone", "Skin"]);
    // Inside of a command its own parameters count.
    begins(
        &with_head("define arm(surface q, a) {\n sphere |"),
        &["q", "Bone", "Skin"],
    );
    begins(
        &with_head("define arm(surface q, a) {\n sphere |\n}"),
        &["q", "Bone", "Skin"],
    );
    // Shapes of a chain leave the material out.
    among(&with_head("chain Skin, C\nsphere |"), &["r", "!Skin"]);
    exactly(
        "read |\n#file b.rat\n#file c.rat\n",
        &[
            "b.rat",
            "c.rat",
            "shell.rat",
            "horn.rat",
            "tree.rat",
            "spikes.rat",
            "sphereflake.rat",
            "spiral.rat",
        ],
    );
    exactly("read sub/|\n#file sub/c-2.rat\n", &["sub/c-2.rat"]);
    begins("help sph|", &["sphere"]);
}

#[test]
fn a_file_is_replaced_as_a_whole() {
    let (project, file, byte) = at_mark("read sub/c-|\n#file sub/c-2.rat\n");
    let found = complete(&project, file, byte);
    assert_eq!(found.replace, 5..11);
    assert_eq!(found.items[0].insert, "sub/c-2.rat");
}

#[test]
fn options() {
    begins(
        &with_head("surface New |"),
        &["=", "body", "ambient", "diffuse"],
    );
    exactly(
        &with_head("surface New di|"),
        &["diffuse", "dispersion", "radius"],
    );
    // Those that are given come last.
    let found = texts(&with_head("surface { New diff Red\n  spec 50%\n  | }"));
    assert_eq!(found[..3], ["body", "ambient", "reflective"]);
    assert_eq!(found[found.len() - 2..], ["diffuse", "specular"]);
    among(
        &with_head("light White |"),
        &["point", "position", "!diffuse"],
    );
    exactly("soft |", &["on", "off"]);
    begins("fragile all |", &["all", "arc"]);
    begins("surface s kernel |", &["cauchy", "gauss"]);
    begins("surface s skip pixel sh|", &["shadow", "shine"]);
    begins("texture t |", &["=", "diffuse"]);
    begins("texture t strength |", &["one", "x"]);
    begins("texture t strength sin |", &["one", "x"]);
    exactly("texture t strength sin one bou|", &["bounds"]);
    begins("for i = 1 |", &["to"]);
    begins("for i |", &["="]);
    begins("for i = 1 to 3 st|", &["step"]);
    begins("var a = 1 h|", &["hot"]);
}

#[test]
fn values() {
    begins(
        &with_head("sphere Skin |"),
        &["r", "P.x", "P.y", "P.z", "sin"],
    );
    begins(&with_head("sphere Skin 1 |"), &["P", "r", "sin"]);
    begins(
        &with_head("sphere Skin 1 r |"),
        &["r", "P.x", "P.y", "P.z", "sin"],
    );
    exactly(&with_head("sphere Skin 2*sq|"), &["sqrt"]);
    among(
        &with_head("sphere Skin 2*|"),
        &["r", "P", "sin", "pi", "!Skin"],
    );
    among(&with_head("sphere Skin max(1, |"), &["r", "sin"]);
    among(&with_head("if r < |"), &["r"]);
    // No colours where a number stands, nor after a number of a colour.
    among(&with_head("sphere Skin Or|"), &["!OrangeRed"]);
    begins(&with_head("surface s diff Oran|"), &["Orange", "Orange1"]);
    among(&with_head("surface s diff 1 Or|"), &["!OrangeRed"]);
    begins(&with_head("background |"), &["P", "r", "rgb", "AliceBlue"]);
    begins(&with_head("background si|"), &["Sienna", "Sienna1"]);
    exactly(&with_head("sphere Skin 1|"), &[]);
    begins(&with_head("var r|"), &["r"]);
    begins(&with_head("for k = 1 to 3 { sphere Skin k|"), &["k"]);
    begins(
        &with_head("define f(k) {\n for j = k to 2 {\n  sphere Skin j|\n"),
        &["j"],
    );
    begins(&with_head("for k = 1 to 3 { sphere Skin k| }"), &["k"]);
    begins(&with_head("leg Skin, P, |"), &["r", "P.x", "P.y", "P.z"]);
    among(&with_head("leg Skin, P, |"), &["length="]);
    begins(&with_head("leg Skin, P, le|"), &["length", "length="]);
    among("shell s, |", &["turns="]);
}

#[test]
fn a_colour_shows() {
    let found = offers("background OrangeRe|");
    assert_eq!(found[0].text, "OrangeRed");
    assert_eq!(found[0].swatch, Some([1.0, 69.0 / 255.0, 0.0]));
    assert_eq!(found[0].detail, "#ff4500");
}

fn check(project: &rats::Project, number: usize, byte: usize) {
    let found = complete(project, number, byte);
    assert!(found.items.len() <= MAX_COMPLETIONS);
    if let Some(file) = project.files.get(number) {
        assert!(file.text.get(found.replace.clone()).is_some(), "{found:?}");
    }
    for item in &found.items {
        assert!(!item.text.is_empty() && !item.insert.is_empty());
    }
}

#[test]
fn any_place() {
    for project in examples().iter().take(2).chain(&corpus()) {
        let length = project.files[0].text.len();
        for byte in (0..length + 2).step_by(1 + length / 60) {
            check(project, 0, byte);
        }
    }
    trials(|u| {
        let text = if u.ratio(1, 2)? {
            soup(u)?
        } else {
            names_soup(u)?
        };
        let mut project = one_file(&text);
        project.files.push(file("other.rat", "var a = 1\n"));
        let byte = u.int_in_range(0..=text.len() + 1)?;
        check(&project, 0, byte);
        check(&project, 9, byte);
        Ok(())
    })
    .cases(600);
}
