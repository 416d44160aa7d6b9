//! Hover cards of the word under the pointer.

use crate::texts::{at_mark, corpus, file, one_file, soup};
use assist::{Card, hover};
use trials::trials;

fn card(text: &str) -> Card {
    let (project, file, byte) = at_mark(text);
    let card = hover(&project, file, byte).unwrap_or_else(|| panic!("nothing: {text}"));
    assert!(project.files[file].text.get(card.span.clone()).is_some());
    card
}

/// The card's title, and among its lines these.
fn says(text: &str, title: &str, lines: &[&str]) {
    let card = card(text);
    assert_eq!(card.title, title, "{text}: {card:?}");
    for line in lines {
        assert!(
            card.lines.iter().any(|l| l == line),
            "{text}: {line} not in {card:?}"
        );
    }
}

#[test]
fn commands_and_options() {
    says(
        "sph|ere s 1 0 0 0",
        "sphere sn r POS [depth d]",
        &[
            "sphere; a point when soft",
            "r: the radius, model units",
            "from RATS",
        ],
    );
    says("surf|ace s", "surface alias [= old] [option …]", &[]);
    says(
        "surface s ra|d 1",
        "radius r [end]",
        &[
            "r: the radius, model units, at least 0",
            "an option of `surface`",
        ],
    );
    says("surface s kernel ga|uss", "gauss", &[]);
    says("timer| on", "timer on | off", &["by default on"]);
    says(
        "# A leg.\n#   length  how long it is\ndefine leg(surface s, length = 2) {\n}\nle|g s",
        "leg s [length]",
        &["A leg.", "line 3 of main.rat"],
    );
    says(
        "cur|ve",
        "curve sn b P1 P2 P3 P4 [P …] [ends round | flat | open] [depth d]",
        &["ours: RATS did not have it"],
    );
}

#[test]
fn names() {
    says(
        "surface Skin diff Red\nsphere Sk|in 1 0 0 0\nsphere Skin 2 0 0 0",
        "material `Skin`",
        &[
            "surface Skin diff Red",
            "line 1 of main.rat",
            "used 2 times",
        ],
    );
    says(
        "var a = 2*3\nsphere s a| 0 0 0",
        "variable `a`",
        &[
            "var a = 2*3",
            "line 1 of main.rat",
            "used once",
            "here: the radius, model units",
        ],
    );
    let card = card("var Body = Gold hot\nsurface s diff Bo|dy");
    assert_eq!(card.swatch, Some([1.0, 215.0 / 255.0, 0.0]));
    says(
        "for i = 1 to 3 {\nsphere s |i 0 0 0\n}",
        "loop variable `i`",
        &["for i = 1 to 3"],
    );
    says(
        "read b.r|at\n#file b.rat\n",
        "file `b.rat`",
        &["a file of the project"],
    );
    says("define f(a) {\n}\nf a|=2", "parameter `a`", &[]);
}

#[test]
fn values() {
    says("sphere s 1|.5 0 0 0", "the radius, model units", &[]);
    says("sphere s 1 0 2| 0", "y of the centre, model units", &[]);
    says("surface s diff 0 0 1|", "blue of the diffuse colour", &[]);
    says(
        "surface s rad 1 blob -2 -|3",
        "the blobbiness at the other end",
        &[],
    );
    says(
        "arc s 1 .1 <0 0 0> <0 0 1> 3|0 90",
        "the start angle, degrees",
        &[],
    );
    says(
        "sphere s sq|rt(2) 0 0 0",
        "function `sqrt`",
        &["sqrt(x): square root", "here: the radius, model units"],
    );
    says("sphere s 2*p|i 0 0 0", "pi = 3.141593", &[]);
    says(
        "background Orange|Red",
        "colour `OrangeRed`",
        &["1 0.271 0, #ff4500"],
    );
    for text in ["# sph|ere", "|", "nosuch 1|", "sphere s 1 0 0 0    |  "] {
        let (project, file, byte) = at_mark(text);
        assert_eq!(hover(&project, file, byte), None, "{text}");
    }
}

#[test]
fn any_place() {
    for project in corpus() {
        let length = project.files[0].text.len();
        for byte in (0..length + 2).step_by(1 + length / 60) {
            if let Some(card) = hover(&project, 0, byte) {
                assert!(card.span.start <= byte && byte <= card.span.end);
                assert!(!card.title.is_empty());
            }
        }
    }
    trials(|u| {
        let text = soup(u)?;
        let mut project = one_file(&text);
        project.files.push(file("other.rat", "var a = 1\n"));
        let byte = u.int_in_range(0..=text.len() + 1)?;
        if let Some(card) = hover(&project, 0, byte) {
            assert!(text.get(card.span).is_some());
        }
        Ok(())
    })
    .cases(600);
}
