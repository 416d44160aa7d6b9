//! Times of compiling: the examples of the page, and texts made to take long.
//!
//! `cargo run --release -p rats --example compile_speed`

use rats::{File, Project, compile};
use std::time::Instant;

fn main() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../www/examples");
    let mut texts: Vec<(String, String)> = std::fs::read_dir(folder)
        .expect("the examples")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|ext| ext == "rat"))
        .map(|path| {
            let text = std::fs::read_to_string(&path).expect("a text");
            (path.display().to_string(), text)
        })
        .collect();
    texts.sort();
    let hostile = [
        "for i = 1 to 1e12 { }",
        "for i = 1 to 1e12 { var x = sin(i)*2 + 1 }",
        "for i = 1 to 1e12 { if i > 1 { var x = rand } }",
        "for i = 1 to 1e12 { surface s diff Red, spec White, shine 10, rad .1, blob -1 }",
        "for i = 1 to 1e12 { var x = White }",
        "for i = 1 to 1e12 { wibble }",
        "for i = 1 to 1e12 { var x = nosuch }",
        "for i = 1 to 1e12 { var x = 1 hot }",
        "surface s diff Red\nfor i = 0 to 1e12 { sphere s 1 i 0 0 }",
        "surface s diff Red\nfor i = 0 to 1e12 { sphere s 0 i 0 0 }",
        "surface s diff Red\nobject A\nfor i = 1 to 1e4 { sphere s 1 0 0 0 }\nclose\n\
         for i = 1 to 1e9 { rotate 0 0 1 1 A }",
        "define f(x) { f x - 1\nif x > 0 { f x } }\nf 100",
    ];
    texts.extend(hostile.map(|text| (text.replace('\n', "; "), text.to_owned())));
    let many = [
        ("wibble\n", 140_000),
        ("x {\n", 250_000),
        ("focus 1\n", 125_000),
        ("{", 1_000_000),
    ];
    texts.extend(many.map(|(part, count)| (format!("{count} times {part:?}"), part.repeat(count))));
    for (name, text) in texts {
        let project = Project {
            files: vec![File {
                name: String::from("main.rat"),
                text,
            }],
        };
        let begin = Instant::now();
        let compiled = compile(&project);
        println!(
            "{:8.2} ms {:7} shapes {:4} messages  {name}",
            begin.elapsed().as_secs_f64() * 1e3,
            compiled.scene.elements.len(),
            compiled.diagnostics.len(),
        );
    }
}
