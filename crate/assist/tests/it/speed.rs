//! Times of the answers for the longest project that there may be. Run with
//! `cargo test --release -p assist --test it speed:: -- --ignored --nocapture`.

use crate::texts::{file, one_file};
use rats::limits::MAX_TEXT;
use std::time::Duration;
use trials::WorkClock;

/// Measures the time that something takes.
fn time_of(run: impl FnOnce()) -> Duration {
    let clock = WorkClock::start();
    run();
    clock.elapsed()
}

/// A text of about `length` bytes, of all kinds of commands.
fn long(length: usize) -> String {
    let mut text = String::from("surface Skin diff Red\nvar a = 1\nvar P = 1 2 3\n");
    let mut i = 0;
    while text.len() < length {
        i += 1;
        text += &format!(
            "# Part {i}\nsurface S{i} {{ diff Red, spec 50%\n  rad a, blob -2 }}\nobject O{i}\n\
             for i = 1 to 3 {{ sphere S{i} a*2, i {i} 0 }}\ncylinder Skin 0.1 <0 0 {i}>, P*{i}\n\
             close\nvar b{i} = a + {i}\ndefine d{i}(x, Y) {{ sphere S{i} x, Y }}\nd{i} b{i}, P\n"
        );
    }
    text
}

/// Texts that are awkward in one way or another.
fn awkward() -> Vec<(&'static str, String)> {
    fn fill(piece: &str) -> String {
        piece.repeat((MAX_TEXT - 100) / piece.len())
    }
    vec![
        ("a long text", long(MAX_TEXT - 1000)),
        ("one name", fill("var a = a\n")),
        ("words", fill("a ")),
        ("one command", fill("sphere ")),
        ("open braces", fill("{\n")),
        ("blocks", fill("for i = 1 to 2 {")),
        (
            "locals",
            "define f(a) {\n".to_owned() + &fill("if a { var b = a }\n") + "}",
        ),
        (
            "many locals",
            "define f(a) {\n".to_owned()
                + &(0..30_000)
                    .map(|i| format!("var a{i} = 1\n"))
                    .collect::<String>()
                + &"if a {}\n".repeat(60_000)
                + "}",
        ),
        ("reads", fill("read other.rat\n")),
        ("comments", fill("# a\n")),
        ("empty", fill("\n")),
        ("objects", fill("object A\n")),
        ("sums", "var a = ".to_owned() + &fill("(1+")),
    ]
}

#[test]
#[ignore = "measures; meant for release builds"]
fn speed() {
    let mut slowest = Duration::ZERO;
    for (what, text) in awkward() {
        let byte = text.len() / 2;
        let byte = text[..byte].rfind('\n').map_or(byte, |at| at + 1);
        let byte = text[byte..].find(' ').map_or(byte, |at| byte + at + 1);
        let mut project = one_file(&text);
        project.files.push(file("other.rat", &long(20_000)));
        let runs: [(&str, &dyn Fn()); 9] = [
            ("format", &|| drop(assist::format(&text))),
            ("folds", &|| drop(assist::folds(&text))),
            ("index", &|| drop(assist::Index::of(&project))),
            ("definition", &|| {
                drop(assist::definition(&project, 0, byte))
            }),
            ("references", &|| {
                drop(assist::references(&project, 0, byte))
            }),
            ("rename", &|| drop(assist::rename(&project, 0, byte, "zqx"))),
            ("complete", &|| drop(assist::complete(&project, 0, byte))),
            ("hover", &|| drop(assist::hover(&project, 0, byte))),
            ("signature", &|| drop(assist::signature(&project, 0, byte))),
        ];
        for (name, run) in runs {
            let took = time_of(run);
            println!("{what:12} {name:12} {:7.1} ms", took.as_secs_f64() * 1e3);
            slowest = slowest.max(took);
        }
    }
    let text = long(10_000);
    let project = one_file(&text);
    let took = time_of(|| {
        for byte in 0..100 {
            drop(assist::complete(&project, 0, byte * 90));
        }
    });
    println!("complete in 10 kB: {:.3} ms", took.as_secs_f64() * 10.0);
    println!("slowest: {:.1} ms", slowest.as_secs_f64() * 1e3);
    assert!(slowest < Duration::from_secs(1), "{slowest:?}");
}
