//! Every limit is met, with a message, in good time.

use rats::limits::*;
use rats::{Compiled, File, Project, Severity, compile};
use std::fmt::Write;
use std::time::Duration;
use trials::WorkClock;

fn run(text: impl Into<String>) -> Compiled {
    compile(&Project {
        files: vec![File {
            name: String::from("main.rat"),
            text: text.into(),
        }],
    })
}

/// Compiles on a stack as small as a browser's worker has, and gives the messages of errors.
fn errors(text: impl Into<String>) -> String {
    let text = text.into();
    let worker = std::thread::Builder::new().stack_size(1024 * 1024);
    let (compiled, taken) = worker
        .spawn(move || {
            let begin = WorkClock::start();
            (run(text), begin.elapsed())
        })
        .expect("a thread")
        .join()
        .expect("no panic");
    // A few tenths of a second optimised; tests run unoptimised.
    assert!(taken < Duration::from_secs(10), "{taken:?}");
    assert!(compiled.diagnostics.len() <= MAX_DIAGNOSTICS);
    compiled
        .diagnostics
        .iter()
        .filter(|d| d.severity == Severity::Error)
        .map(|d| format!("{}:{} {}\n", d.line, d.column, d.message))
        .collect()
}

#[track_caller]
fn fails(text: impl Into<String>, message: &str) {
    let errors = errors(text);
    assert!(
        errors.contains(message),
        "expected `{message}`, got `{errors}`"
    );
}

#[test]
fn text() {
    fails("#".repeat(MAX_TEXT + 1), "is the limit");
    assert_eq!(errors("#".repeat(MAX_TEXT)), "");
}

#[test]
fn files() {
    let file = |i: usize| File {
        name: i.to_string(),
        text: String::new(),
    };
    let files = |n| Project {
        files: (0..n).map(file).collect(),
    };
    assert!(compile(&files(MAX_FILES)).diagnostics.is_empty());
    assert_eq!(compile(&files(MAX_FILES + 1)).diagnostics.len(), 1);
    assert!(compile(&Project::default()).diagnostics.is_empty());
}

/// Pictures are copies of the scene: their number and what they hold together are bounded.
#[test]
fn pictures() {
    let balls = "surface s diff Red\nsphere s 1 0 0 0\n";
    let many = run(format!("{balls}for i = 1 to {MAX_SHOTS} {{ shoot }}"));
    assert_eq!(many.earlier.len(), MAX_SHOTS - 1);
    fails(
        format!("{balls}for i = 0 to {MAX_SHOTS} {{ shoot }}"),
        "more than 128 pictures",
    );
    // The first one may hold as much as there can be.
    let count = MAX_SHOT_WEIGHT / 8;
    fails(
        format!(
            "surface s diff Red\nfor i = 1 to {count} {{ sphere s 1 0 0 0 }}\n\
             for i = 1 to 9 {{ shoot }}"
        ),
        "together",
    );
    fails(
        format!("for i = 0 to {MAX_INTERLUDES} {{ pause }}"),
        "pauses, logs and times",
    );
}

#[test]
fn steps() {
    fails("for i = 1 to 1e12 { }", "steps");
    fails("for i = 1 to 1e12 { var x = i*2 }", "steps");
    fails(
        "for i = 1 to 1e5 { for j = 1 to 1e5 { if i > j { var x = rand } } }",
        "steps",
    );
    // A loop of errors costs more than a loop of commands.
    fails("for i = 1 to 1e12 { wibble }", "steps");
    fails("for i = 1 to 1e12 { sphere nosuch 1 0 0 0 }", "steps");
    fails("for i = 1 to 1e12 { var y = nosuch }", "steps");
    fails("for i = 1 to 1e12 { surface s diff nosuch }", "steps");
    // Turning many shapes again and again.
    fails(
        "surface s diff Red\nobject A\nfor i = 1 to 10000 { sphere s 1 0 0 0 }\nclose\n\
         for i = 1 to 1e9 { rotate 0 0 1 1 A }",
        "steps",
    );
    fails(
        "define f(x) { f2 x\nf2 x }\ndefine f2(x) { f3 x\nf3 x }\n\
         define f3(x) { for i = 1 to 1e4 { f4 x } }\n\
         define f4(x) { for i = 1 to 1e4 { var y = x } }\nf 1",
        "steps",
    );
}

#[test]
fn a_large_scene_is_made_in_time() {
    let compiled = run("surface s diff Red\nfor i = 1 to 100000 { sphere s 1 i/1e5 0 0 }");
    assert!(compiled.diagnostics.is_empty());
    assert_eq!(compiled.scene.elements.len(), 100_000);
}

#[test]
fn elements() {
    let thousand = "surface s diff Red\nobject A\nfor i = 1 to 1000 { sphere s 1 0 0 0 }\nclose\n";
    let copies = MAX_ELEMENTS / 1000 - 1;
    let full = run(format!(
        "{thousand}for i = 1 to {copies} {{ instance A B }}"
    ));
    assert_eq!(full.scene.elements.len(), MAX_ELEMENTS);
    fails(
        format!("{thousand}for i = 0 to {copies} {{ instance A B }}"),
        "shapes",
    );
}

/// Shapes that take long to prepare, or much room, count as many.
#[test]
fn heavy_elements() {
    let curves = MAX_ELEMENTS / CURVE_WEIGHT + 1;
    fails(
        format!(
            "surface s diff Red, blob -1, rad 1\nfor i = 1 to {curves} \
             {{ curve s 1 0 0 0 1 0 0 1 1 0 0 1 i }}"
        ),
        "shapes",
    );
    fails(
        format!(
            "surface s diff Red, blob -1, rad 1 2\nfor i = 1 to {curves} {{ line s 0 0 0 1 0 i }}"
        ),
        "shapes",
    );
    let corners: String = (0..MAX_CORNERS / 2)
        .map(|i| {
            let (s, c) = libm::sincos(f64::from(i as u32) * 0.01);
            format!(" {c:.4} {s:.4} 0")
        })
        .collect();
    fails(
        format!(
            "surface s diff Red\nobject A\npolygon s{corners}\nclose\n\
             for i = 1 to 1000 {{ instance A B }}"
        ),
        "shapes",
    );
    let many: String = (0..=MAX_CORNERS).map(|i| format!(" {i} 0 0")).collect();
    fails(
        format!("surface s diff Red\npolygon s{many}"),
        "corners at most",
    );
}

#[test]
fn instances() {
    fails(
        "surface s diff Red\nobject A\nsphere s 1 0 0 0\nclose\n\
         for i = 1 to 1e3 { instance A B\nobject A\ninstance B\ninstance B\nclose A }",
        "shapes",
    );
}

#[test]
fn objects() {
    let mut text = String::new();
    for _ in 0..=MAX_NESTED_OBJECTS {
        text += "object A\n";
    }
    fails(text, "deep at most");
    let ten = "object A\nclose\n".repeat(10);
    fails(format!("for i = 1 to 1e9 {{ {ten} }}"), "objects");
}

#[test]
fn materials() {
    let text = "for i = 1 to 20000 { surface s diff Red\nsphere s 1 0 0 0 }";
    fails(text, "materials");
    // Making one again that nothing uses costs nothing.
    assert_eq!(errors("for i = 1 to 20000 { surface s diff Red }"), "");
}

#[test]
fn lights() {
    fails("for i = 1 to 1000 { light White pos 1 1 1 }", "lights");
}

#[test]
fn layers() {
    let text = "texture T pigment sin one\ntexture T texture T + T\n".to_owned()
        + &"texture T texture T + T\n".repeat(4);
    fails(text, "layers");
}

#[test]
fn operands() {
    fails(
        format!("contrast {}", "1 ".repeat(MAX_OPERANDS + 1)),
        "operands",
    );
}

#[test]
fn expressions_in_expressions() {
    for (open, close) in [("(", ")"), ("-", ""), ("sin(", ")"), ("2^", ""), ("+", "")] {
        let deep = open.repeat(1000) + "1" + &close.repeat(1000);
        fails(format!("var x = {deep}"), "nested");
    }
    fails(format!("if {} 1 {{ }}", "not ".repeat(1000)), "nested");
    let fine = "(".repeat(30) + "1" + &")".repeat(30);
    assert_eq!(errors(format!("var x = {fine}")), "");
    // Long is not deep.
    assert_eq!(errors(format!("var x = {}1", "1 + ".repeat(1000))), "");
}

#[test]
fn blocks_in_blocks() {
    for open in ["for i = 1 to 1 {", "if 1 {", "define f() {"] {
        let deep = open.repeat(10_000) + &"}".repeat(10_000);
        fails(deep, "inside each other");
        errors(open.repeat(10_000));
    }
    fails("if 0 { } else ".repeat(10_000) + "{ }", "inside each other");
    errors("if 0 { } else ".repeat(10_000));
    errors("else ".repeat(10_000));
    errors("{".repeat(100_000));
    errors("}".repeat(100_000));
    errors("x {\n".repeat(100_000));
}

#[test]
fn calls_in_calls() {
    fails("define f() { f }\nf", "deep");
    // The deepest nest of blocks in the deepest nest of calls.
    let body = "if 1 {".repeat(40) + "f" + &"}".repeat(40);
    fails(format!("define f() {{ {body} }}\nf"), "deep");
    let body = "for i = 1 to 1 {".repeat(2) + "f" + &"}".repeat(2);
    fails(format!("define f() {{ {body} }}\nf"), "deep");
}

#[test]
fn files_in_files() {
    // Each file reads the next one; there are fewer files than the limit of nesting, so a call in
    // between is what can go deeper.
    let files = (0..MAX_FILES)
        .map(|i| File {
            name: format!("{i}.rat"),
            text: format!("read {}.rat", i + 1),
        })
        .collect();
    let compiled = compile(&Project { files });
    assert_eq!(compiled.diagnostics.len(), 1);
    assert!(compiled.diagnostics[0].message.contains("no file"));
}

#[test]
fn magnitudes() {
    fails("eyep 2e12 0 0", "too large");
    fails("var x = 1e13", "too large");
    fails("var x = 1e400", "finite");
    let text = "surface s diff Red\nobject A\nsphere s 1 1 0 0\nclose\n\
        for i = 1 to 400 { scale 10 10 10 }";
    let compiled = run(text);
    assert!(compiled.scene.elements.is_empty());
    assert_eq!(compiled.diagnostics.len(), 1);
    assert_eq!(compiled.diagnostics[0].severity, Severity::Warning);
    // A material may not grow beyond bounds with its shape, either.
    for factor in ["1e9", "1e-9"] {
        let compiled = run(format!(
            "fragile all\nblobscale absolute\nsurface s diff Red, blob -1, rad 1\nobject A\n\
             sphere s 1 0 0 0\nclose\nfor i = 1 to 30 {{ scale {factor} {factor} {factor} }}"
        ));
        assert!(compiled.scene.elements.is_empty());
        assert!(compiled.scene.flesh.iter().all(|m| m.radius == 1.0));
    }
}

#[test]
fn messages() {
    let mut text = String::new();
    for i in 0..500 {
        let _ = writeln!(text, "texture T pigment Red, octaves 2 # {i}");
    }
    for _ in 0..300 {
        text += "wibble\n";
    }
    let compiled = run(text);
    assert_eq!(compiled.diagnostics.len(), MAX_DIAGNOSTICS);
    let errors = compiled
        .diagnostics
        .iter()
        .filter(|d| d.severity == Severity::Error)
        .count();
    assert_eq!(errors, MAX_DIAGNOSTICS, "errors are kept before warnings");
    let last = compiled.diagnostics.last().map(|d| d.message.as_str());
    assert_eq!(last, Some("… and 601 more messages"));
    // One error among many warnings is not lost.
    let compiled = run("texture T pigment Red, octaves 2\n".repeat(1000) + "wibble");
    assert!(
        compiled
            .diagnostics
            .iter()
            .any(|d| d.severity == Severity::Error)
    );
    assert_eq!(compiled.diagnostics.len(), MAX_DIAGNOSTICS);
}

#[test]
fn long_lines_and_words() {
    errors("a".repeat(500_000));
    errors("1".repeat(500_000));
    errors(format!("sphere {} 1 0 0 0", "s".repeat(500_000)));
    errors(format!("var x = {}", "9".repeat(500_000)));
    errors("surface s diff Red ".repeat(20_000));
    errors("wibble ".repeat(100_000));
    errors("wibble\n".repeat(100_000));
    errors("🐚".repeat(100_000));
}

#[test]
fn a_tiny_weight_takes_no_eye_to_infinity() {
    fails("cp 1e12 0 5 1e-14", "further away than 1e12");
    fails("cp 1e12 0 5 1e-300", "lean");
    fails("cp 1 0 5 1e-12", "further away than 1e12");
    assert_eq!(errors("cp 1 0 5 1e-11"), "");
}

/// A PNG file of gray pixels, all black, that is cut off before its end.
fn cut_image(side: u32) -> Vec<u8> {
    let crc = |bytes: &[u8]| {
        !bytes.iter().fold(!0_u32, |crc, &byte| {
            (0..8).fold(crc ^ u32::from(byte), |crc, _| {
                (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg())
            })
        })
    };
    let mut png = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut chunk = |name: &[u8], data: &[u8]| {
        let body = [name, data].concat();
        png.extend((data.len() as u32).to_be_bytes());
        png.extend(&body);
        png.extend(crc(&body).to_be_bytes());
    };
    let size = [side.to_be_bytes(), side.to_be_bytes()].concat();
    chunk(b"IHDR", &[&size[..], &[8, 0, 0, 0, 0]].concat());
    let rows = vec![0; (side as usize + 1) * side as usize];
    let mut data = miniz_oxide::deflate::compress_to_vec_zlib(&rows, 6);
    data.truncate(data.len() - 40);
    chunk(b"IDAT", &data);
    png
}

/// Height fields of different sizes are different: none is kept, and a mistake is not either.
#[test]
fn a_large_image_in_a_loop() {
    let text = "surface s diff Red\nfor i = 1 to 1e6 { terra s big.png 0 0 0 i 1 1 }";
    let project = Project {
        files: vec![File {
            name: String::from("main.rat"),
            text: String::from(text),
        }],
    };
    let asset = rats::Asset::new("big.png", cut_image(4096));
    let compiled = rats::compile_at(&project, &[asset], 0.0);
    let said: Vec<_> = compiled.diagnostics.iter().map(|d| &d.message).collect();
    assert!(said.iter().any(|m| m.contains("steps")), "{said:?}");
}

#[test]
fn vertices_that_are_deformed() {
    let text = |turns: u32| {
        format!(
            "surface s, diffuse Red\nmesh s gem.obj\nfor i = 1 to {turns} {{\n  \
             deform {{ control <0 0 -1.2> move <0 0 0.001> }}\n}}\n"
        )
    };
    fails(
        text(5000),
        "the deformations move more than 60000 vertices together",
    );
    assert_eq!(errors(text(100)), "");
}
