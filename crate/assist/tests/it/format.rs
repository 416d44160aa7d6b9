//! Laying texts out.

use crate::texts::{corpus, examples, file, one_file, soup};
use assist::format;
use rats::{Compiled, HotVariable, Project, compile};
use trials::trials;

fn check(before: &str, after: &str) {
    assert_eq!(format(before), after, "{before:?}");
    assert_eq!(format(after), after, "{before:?}");
}

#[test]
fn levels() {
    check(
        "for i=1 to 3 {\nobject A\n# in\nsphere s 1 {0 0 0,\n1\n}\n  close A\n}\n",
        "for i = 1 to 3 {\n  object A\n    # in\n    sphere s 1 { 0 0 0,\n      1\n    }\n  \
         close A\n}\n",
    );
    check(
        "if a<2 {\nquit } else {\nif b{\n return\n}}\nquit",
        "if a < 2 {\n  quit } else {\n  if b {\n    return\n}}\nquit\n"
            .replace("}}", "} }")
            .as_str(),
    );
    // Unclosed brackets inside braces end with the braces.
    check(
        "for i = 1 to 2 {\nobject A\n}\nquit\n",
        "for i = 1 to 2 {\n  object A\n}\nquit\n",
    );
    // A `close` too many closes nothing.
    check("close\n  quit\n", "close\nquit\n");
    check(
        "  chain s,A\nsphere 1 0 0 0\nclose",
        "chain s, A\n  sphere 1 0 0 0\nclose\n",
    );
    // `object` as an operand begins nothing.
    check("help object\nquit\n", "help object\nquit\n");
}

#[test]
fn spaces() {
    check(
        "var  a=1 ,-2,3   hot   # x  ",
        "var  a = 1, -2, 3   hot   # x\n",
    );
    check("var a=1 *=2", "var a = 1 *= 2\n");
    check("var a += 1", "var a += 1\n");
    check("var a = -b+2 * c", "var a = -b+2 * c\n");
    check("sphere s 1   1 -2 - 3  4", "sphere s 1   1 -2 - 3  4\n");
    check("sphere s 1\t1 0 0 # x", "sphere s 1 1 0 0  # x\n");
    check("surface s=t,diff Red", "surface s = t, diff Red\n");
    check(
        "texture t pigment a=b.png plain",
        "texture t pigment a=b.png plain\n",
    );
    check("if a<=b and c!=d{quit}", "if a <= b and c != d { quit }\n");
    check(
        "define f(a ,b=-1) {\n}\nf 1,b=2",
        "define f(a, b = -1) {\n}\nf 1, b=2\n",
    );
    check("read a=b.rat ,c.rat", "read a=b.rat, c.rat\n");
    check(
        "pause  two  words,, {\n  a }  # x",
        "pause  two  words,, {\n  a }  # x\n",
    );
    check("surface {s diff 50%}", "surface { s diff 50% }\n");
    check("\u{feff}quit\r\n\r\n\r\n\r\n# a\t \r\n", "quit\n\n# a\n");
    check("\n\n\n", "");
    check("", "");
}

/// Formatting is idempotent, also with signs next to each other: a space after one must not change
/// the tokens behind it.
#[test]
fn signs_that_run_into_each_other() {
    check("var a+=*=b", "var a+=*=b\n");
    check("var a = 1 ,=b", "var a = 1, = b\n");
    check("if a<<=b{}", "if a<<=b {}\n");
    for start in ["var a", "if a", "surface a", "for a", "define f(a"] {
        // All words of up to four letters.
        for number in 0..8_usize.pow(4) {
            let signs: String = (0..4)
                .map(|place| char::from(b"=<>!+*),"[number / 8_usize.pow(place) % 8]))
                .collect();
            let once = format(&format!("{start}{signs}b"));
            assert_eq!(format(&once), once, "{start}{signs}b");
        }
    }
}

/// The published texts are formatted.
#[test]
fn examples_and_library() {
    let texts = examples()
        .into_iter()
        .map(|project| project.files[0].text.clone());
    let library = rats::library::FILES
        .iter()
        .map(|(_, text)| (*text).to_owned());
    for text in texts.chain(library) {
        assert_eq!(format(&text), text);
    }
}

#[test]
fn brackets_without_partner_are_left_alone() {
    for text in ["for i=1 to 3 {\n  quit", "  }", "a {{ }", "} {"] {
        assert_eq!(format(text), text);
    }
}

#[test]
fn texts_that_would_exceed_the_limit_are_left_alone() {
    let text = "a{\n".repeat(40_000) + &"}\n".repeat(40_000);
    assert_eq!(format(&text), text);
}

#[test]
fn meaning_stays_in_examples_and_mistakes() {
    for project in examples().iter().chain(&corpus()) {
        same_meaning(project);
    }
}

#[test]
fn meaning_stays_in_any_words() {
    trials(|u| {
        let mut project = one_file(&soup(u)?);
        project.files.push(file("other.rat", &soup(u)?));
        same_meaning(&project);
        Ok(())
    })
    .cases(1_000);
}

#[test]
fn any_bytes() {
    trials(|u| {
        let bytes: Vec<u8> = u.arbitrary()?;
        same_meaning(&one_file(&String::from_utf8_lossy(&bytes)));
        Ok(())
    })
    .cases(600);
}

fn same_meaning(project: &Project) {
    let mut laid_out = project.clone();
    for file in &mut laid_out.files {
        file.text = format(&file.text);
        assert_eq!(format(&file.text), file.text, "not settled");
    }
    let (before, after) = (compile(project), compile(&laid_out));
    let [before, after] = [(project, before), (&laid_out, after)].map(|(project, compiled)| {
        (
            without_places(&compiled),
            messages_of(project, &compiled),
            hot(project, &compiled.hot),
        )
    });
    assert_eq!(before, after, "{:?}\n{:?}", project.files, laid_out.files);
}

fn without_places(compiled: &Compiled) -> scene::Scene {
    let mut scene = scene::Scene::clone(&compiled.scene);
    for element in &mut scene.elements {
        element.origin.start = 0;
        element.origin.end = 0;
    }
    scene
}

/// The messages, with their places as the number of letters before them, since only space may
/// change.
fn messages_of(project: &Project, compiled: &Compiled) -> Vec<String> {
    let mut said = Vec::new();
    for d in &compiled.diagnostics {
        let text = &project
            .files
            .iter()
            .find(|f| f.name == d.file)
            .expect("a file")
            .text;
        let hint = d.hint.as_deref().unwrap_or_default();
        // Another number of a line is another place.
        let hint = hint.split(", in line ").next();
        let related: Vec<_> = d
            .related
            .iter()
            .map(|r| {
                let text = &project
                    .files
                    .iter()
                    .find(|f| f.name == r.file)
                    .expect("a file")
                    .text;
                (
                    &r.file,
                    letters(&text[..r.span.start]),
                    letters(&text[..r.span.end]),
                    &r.message,
                )
            })
            .collect();
        said.push(format!(
            "{} {}..{} {:?} {} {hint:?} {related:?}",
            d.file,
            letters(&text[..d.span.start]),
            letters(&text[..d.span.end]),
            d.severity,
            d.message
        ));
    }
    said
}

fn letters(text: &str) -> usize {
    text.chars()
        .filter(|c| !c.is_whitespace() && *c != '\u{feff}')
        .count()
}

fn hot(project: &Project, hot: &[HotVariable]) -> Vec<String> {
    hot.iter()
        .map(|h| {
            let text = &project.files[h.file].text;
            let literal = h.literal.clone().map(|range| {
                text[range]
                    .split([' ', ',', '\n', '\r', '\t', '\u{feff}'])
                    .collect::<String>()
            });
            format!("{} {:?} {} {literal:?}", h.name, h.value, h.file)
        })
        .collect()
}
