//! Handles: what is dragged goes where it is dragged to, nothing else changes, and nothing panics.

use assist::handles::{self, Editable, Handle, Kind};
use glam::{DMat3, DVec3};
use rats::{Compiled, File, Project, Severity, compile};
use trials::arbitrary::{Result, Unstructured};
use trials::trials;

const MATERIAL: &str = "surface s, diffuse Coral, blobbiness -2\n";

fn project(text: &str) -> Project {
    let name = String::from("main.rat");
    let text = text.to_owned();
    Project {
        files: vec![File { name, text }],
    }
}

fn of(project: &Project, element: usize) -> Vec<Handle> {
    let compiled = compile(project);
    handles_of(project, &compiled, element)
}

fn handles_of(project: &Project, compiled: &Compiled, element: usize) -> Vec<Handle> {
    handles::handles(project, &[], 0, compiled, element, &DMat3::IDENTITY)
}

fn with_label<'h>(handles: &'h [Handle], label: &str) -> &'h Handle {
    handles
        .iter()
        .find(|handle| handle.label.starts_with(label))
        .unwrap_or_else(|| panic!("no {label} among {handles:#?}"))
}

fn why(handle: &Handle) -> &str {
    match &handle.edit {
        Editable::Fixed { why } => why,
        Editable::Literal { .. } => panic!("{handle:?} can be moved"),
    }
}

/// The text after a drag of one handle of the element of the last command.
fn drag_to(text: &str, label: &str, to: [f64; 3]) -> String {
    let mut project = project(&format!("{MATERIAL}{text}"));
    let handles = of(&project, 0);
    let edits = handles::drag(with_label(&handles, label), DVec3::from(to), 0.01);
    project = project.apply(&edits);
    project.files[0].text[MATERIAL.len()..].to_owned()
}

#[test]
fn only_the_numbers_that_change_are_written() {
    assert_eq!(
        drag_to(
            "sphere  s, 1.0 <1, .50 -2> # a ball\n",
            "the centre",
            [1.0, 0.75, -2.0]
        ),
        "sphere  s, 1.0 <1, 0.75 -2> # a ball\n"
    );
    assert_eq!(
        drag_to(
            "cylinder s .4 { 0 0 0 # here\n  −1 2 3 }",
            "the apex",
            [1.5, 2.0, -3.0]
        ),
        "cylinder s .4 { 0 0 0 # here\n  1.5 2 -3 }"
    );
    assert_eq!(
        drag_to("sphere s 1 2 3 4", "the radius", [2.5, 3.0, 4.0]),
        "sphere s 0.5 2 3 4"
    );
    // A radius never becomes 0: the shape would be lost.
    assert_eq!(
        drag_to("sphere s 1 2 3 4", "the radius", [-9.0, 3.0, 4.0]),
        "sphere s 0.01 2 3 4"
    );
    // Too far is nowhere.
    assert_eq!(
        drag_to("sphere s 1 2 3 4", "the centre", [1e300, 3.0, 4.0]),
        "sphere s 1 2 3 4"
    );
    assert_eq!(
        drag_to("sphere s 1 2 3 4", "the centre", [f64::NAN, 3.0, 4.0]),
        "sphere s 1 2 3 4"
    );
}

#[test]
fn variables_are_moved_where_they_are_set() {
    assert_eq!(
        drag_to(
            "var r = 0.3 hot # the size\nvar P = 1 2 3\nsphere s r P",
            "the centre (the variable `P`)",
            [1.0, 2.5, 3.0]
        ),
        "var r = 0.3 hot # the size\nvar P = 1 2.5 3\nsphere s r P"
    );
    assert_eq!(
        drag_to(
            "var r = 0.3 hot # the size\nvar P = 1 2 3\nsphere s r P",
            "the radius (the variable `r`)",
            [1.5, 2.0, 3.0]
        ),
        "var r = 0.5 hot # the size\nvar P = 1 2 3\nsphere s r P"
    );
    assert_eq!(
        drag_to(
            "var x = 2\nvar x = 1\nsphere s 1 <-x 0 0>",
            "the centre",
            [-1.5, 1.0, 0.0]
        ),
        "var x = 2\nvar x = 1.5\nsphere s 1 <-x 1 0>"
    );
    assert_eq!(
        drag_to(
            "var P = 1 2 3\nsphere s 1 <0 P.z 0>",
            "the centre",
            [0.0, 4.0, 0.0]
        ),
        "var P = 1 2 4\nsphere s 1 <0 P.z 0>"
    );
    // Computed coordinates stay; the rest of the point moves.
    assert_eq!(
        drag_to(
            "sphere s 1 <sqrt(4) 0 0>",
            "the centre; its x is computed: `sqrt(4)`",
            [7.0, 4.0, 0.0]
        ),
        "sphere s 1 <sqrt(4) 4 0>"
    );
}

#[test]
fn numbers_that_are_fixed_have_a_reason() {
    fn reason(text: &str, label: &str) -> String {
        let handles = of(&project(&format!("{MATERIAL}{text}")), 0);
        why(with_label(&handles, label)).to_owned()
    }
    assert_eq!(
        reason("sphere s 2*0.5 0 0 0", "the radius"),
        "is computed: `2*0.5`"
    );
    assert_eq!(
        reason("var r = 2*0.5\nsphere s r 0 0 0", "the radius"),
        "comes from `r`, which is computed"
    );
    assert_eq!(
        reason("var r = 1 += 0.1\nsphere s r 0 0 0", "the radius"),
        "comes from `r`, which changes with every frame"
    );
    assert_eq!(
        reason("var a = 1\nsphere s 1 <a a 0>", "the centre"),
        "uses one number twice"
    );
    assert_eq!(
        reason("for i = 1 to 3 {\n sphere s 1 i 0 0\n}", "the centre"),
        "is made in a loop"
    );
    assert_eq!(
        reason(
            "define ball(r) {\n sphere s r 0 0 0\n}\nball 1",
            "the centre"
        ),
        "is made by the defined command `ball`"
    );
    assert!(reason("shell s", "the centre").starts_with("is made by the library's `shell`"));
}

#[test]
fn copies_follow_and_loops_share_a_radius() {
    fn drag_radius(text: &str, to: f64) -> Option<String> {
        let project = project(&format!("{MATERIAL}{text}"));
        let handles = of(&project, 2);
        let handle = handles.iter().find(|h| h.kind == Kind::Length)?;
        let edits = handles::drag(handle, handle.place + DVec3::X * to, 0.01);
        Some(project.apply(&edits).files[0].text[MATERIAL.len()..].to_owned())
    }
    // The copy is dragged; it lies 2 to the right of the first.
    let mut project = project(&format!(
        "{MATERIAL}object o\nsphere s 1 0 0 0\nclose\ninstance o p\ntranslate 2 0 0 p\n"
    ));
    let handles = of(&project, 1);
    let handle = with_label(&handles, "the centre");
    assert_eq!(handle.place, DVec3::X * 2.0);
    let edits = handles::drag(handle, DVec3::new(2.0, 0.5, 0.0), 0.1);
    project = project.apply(&edits);
    assert!(project.files[0].text.contains("sphere s 1 0 0.5 0"));
    assert_eq!(
        drag_radius("var r = 0.3\nfor i = 1 to 3 {\n sphere s r i 0 0\n}\n", 0.2).as_deref(),
        Some("var r = 0.5\nfor i = 1 to 3 {\n sphere s r i 0 0\n}\n")
    );
    assert_eq!(
        drag_radius("for i = 1 to 3 {\n sphere s 0.3 i 0 0\n}\n", 0.2).as_deref(),
        Some("for i = 1 to 3 {\n sphere s 0.5 i 0 0\n}\n")
    );
    assert_eq!(
        drag_radius("var i = 3\nfor i = 1 to 3 {\n sphere s i i 0 0\n}\n", 0.2),
        None
    );
    assert_eq!(
        drag_radius(
            "var r = 3\ndefine b(r) {\n sphere s r 0 0 0\n}\nb 1\nb 2\nb 3\n",
            0.2
        ),
        None
    );
}

#[test]
fn a_mesh_has_no_numbers() {
    let project = project("surface s, diffuse Red\nmesh s corner.obj\n");
    let obj = *b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let assets = [rats::Asset::new("corner.obj", obj)];
    let compiled = rats::compile_at(&project, &assets, 0.0);
    let handles = handles::handles(&project, &assets, 0, &compiled, 0, &DMat3::IDENTITY);
    assert_eq!(
        why(with_label(&handles, "a corner")),
        "is made by `mesh` from a file"
    );
}

#[test]
fn a_file_that_is_read_twice_makes_fixed_shapes() {
    let mut project = project(&format!("{MATERIAL}read b.rat\nread b.rat\n"));
    project.files.push(File {
        name: String::from("b.rat"),
        text: String::from("sphere s 1 0 0 0\n"),
    });
    let handles = of(&project, 1);
    assert_eq!(
        why(with_label(&handles, "the centre")),
        "is in a file that is read more than once"
    );
    // Once is fine, and the change is made in that file.
    project.files[0].text = format!("{MATERIAL}read b.rat\n");
    let handles = of(&project, 0);
    let edits = handles::drag(with_label(&handles, "the centre"), DVec3::Y, 0.1);
    project = project.apply(&edits);
    assert_eq!(project.files[1].text, "sphere s 1 0 1 0\n");
}

#[test]
fn the_radius_that_counts_is_the_one_with_a_knob() {
    let text = "surface m, blobbiness -2, radius 0.5\nsphere m 1 0 0 0\n";
    let project = project(text);
    let handles = of(&project, 0);
    let compiled = compile(&project);
    let shown = compiled.scene.radius(&compiled.scene.elements[0]);
    let knob = handles
        .iter()
        .find(|handle| handle.kind == Kind::Length)
        .expect("a knob");
    assert_eq!(knob.place, DVec3::X * shown);
    let Editable::Literal { spans } = &knob.edit else {
        panic!("{knob:?}")
    };
    let expected = if shown == 0.5 { "0.5" } else { "1" };
    assert_eq!(&text[spans[0].1.clone()], expected);
    // A shape without a radius of its own has its material's.
    let line =
        self::project("surface m, blobbiness -2, radius 0.5\nsurface n = m\nline n 0 0 0 1 0 0\n");
    let handles = of(&line, 0);
    let knob = with_label(&handles, "the radius of the material `n`");
    let edits = handles::drag(knob, knob.place * 1.0 + DVec3::Y * 0.25, 0.01);
    assert_eq!((edits.len(), edits[0].text.as_str()), (1, "0.75"));
}

fn number(u: &mut Unstructured<'_>) -> Result<f64> {
    Ok(f64::from(u.int_in_range(-400..=400)?) / 100.0)
}

fn size(u: &mut Unstructured<'_>) -> Result<f64> {
    Ok(f64::from(u.int_in_range(10..=300)?) / 100.0)
}

fn point(u: &mut Unstructured<'_>) -> Result<String> {
    let forms = ["<X Y Z>", "X Y Z", "<X, Y, Z>", "{ X # c\n Y Z }"];
    let form = *u.choose(&forms)?;
    Ok(form
        .replace('X', &number(u)?.to_string())
        .replace('Y', &number(u)?.to_string())
        .replace('Z', &number(u)?.to_string()))
}

fn direction(u: &mut Unstructured<'_>) -> Result<String> {
    Ok(format!("<{} {} {}>", number(u)?, size(u)?, number(u)?))
}

/// A text with one shape, somewhere under transforms, and how exactly its numbers are kept.
fn scene(u: &mut Unstructured<'_>) -> Result<String> {
    let radius = *u.choose(&["", ", radius 0.3"])?;
    let mut text = format!("surface s, diffuse Red, blobbiness -2{radius}\n");
    let chain = u.ratio(1, 4)?;
    text += if chain { "chain s c\n" } else { "object c\n" };
    let s = if chain { "" } else { "s" };
    let (r, a) = (size(u)?, size(u)?);
    let p: Vec<String> = (0..4).map(|_| point(u)).collect::<Result<_>>()?;
    let n = direction(u)?;
    text += &match u.int_in_range(0..=15)? {
        0 => format!("sphere {s} {r} {}", p[0]),
        1 => format!("cylinder {s} {r}, {} {}", p[0], p[1]),
        2 => format!("pipe {s} {r} {} {}", p[0], p[1]),
        3 => {
            let start = u.int_in_range(-180..=180)?;
            let width = u.int_in_range(20..=340)? * if u.arbitrary()? { 1 } else { -1 };
            format!("arc {s} {a} {r} {} {n} {start} {width}", p[0])
        }
        4 => format!("torus {s} {a}, {r}, {}, {n}", p[0]),
        5 => format!("triangle {s} {} {} {}", p[0], p[1], p[2]),
        6 => format!("dot {s} {}", p[0]),
        7 => format!("line {s} {} {}", p[0], p[1]),
        8 => format!("curve {s} {r} {} {} {} {}", p[0], p[1], p[2], p[3]),
        9 => format!("plane {s} {} {n}", p[0]),
        11 => format!("box {s} {} {}", p[0], p[1]),
        12 => format!("brick {s} {a} {r} {a}"),
        13 => format!("cone {s} {a} {} {r} {}", p[0], p[1]),
        14 => format!("patch {s} {} {n} {} {n} {} {n}", p[0], p[1], p[2]),
        10 => format!("arch {s} {r} {} {} {}", p[0], p[1], p[2]),
        _ => format!("gauss {s} {}", p[0]),
    };
    text += "\nclose\n";
    for _ in 0..u.int_in_range(0..=3)? {
        text += &match u.int_in_range(0..=2)? {
            0 => format!("translate {} {} {}\n", number(u)?, number(u)?, number(u)?),
            1 => format!("rotate {} {}\n", direction(u)?, number(u)? * 60.0),
            _ => {
                let factor = size(u)?;
                format!("scale {factor} {factor} {factor}\n")
            }
        };
    }
    text += "# the end\n";
    Ok(text)
}

/// The text with its numbers taken out.
fn without_numbers(text: &str) -> String {
    let tokens = rats::lexer::lex(text);
    let mut rest = String::new();
    for token in tokens {
        let word = &text[token.range()];
        if token.kind != rats::lexer::TokenKind::Number && !matches!(word, "-" | "−") {
            rest += word;
        }
    }
    rest
}

#[test]
fn a_handle_goes_where_it_is_dragged() {
    const GRAIN: f64 = 1e-7;
    let moved = std::cell::Cell::new(0);
    trials(|u| {
        let mut project = project(&scene(u)?);
        let before = compile(&project);
        if before.scene.elements.len() != 1 {
            return Ok(());
        }
        let handles = handles_of(&project, &before, 0);
        let index = u.choose_index(handles.len())?;
        let handle = &handles[index];
        let step = DVec3::new(0.31, -0.27, 0.11);
        let to = handle.place + step * f64::from(u.int_in_range(-4..=4)?);
        let edits = handles::drag(handle, to, GRAIN);
        let old = project.files[0].text.clone();
        project = project.apply(&edits);
        let text = &project.files[0].text;
        assert_eq!(without_numbers(&old), without_numbers(text));
        let after = compile(&project);
        let errors = after.diagnostics.iter();
        assert_eq!(
            errors.filter(|d| d.severity == Severity::Error).count(),
            0,
            "{text}"
        );
        if after.scene.elements.len() != 1 || matches!(handle.edit, Editable::Fixed { .. }) {
            return Ok(());
        }
        let again = handles_of(&project, &after, 0);
        let Some(now) = again.iter().find(|h| h.label == handle.label) else {
            return Ok(());
        };
        let scale = 1.0 + to.length();
        match handle.kind {
            Kind::Point => assert!(
                now.place.distance(to) < 1e-4 * scale,
                "{old}{text}{handle:?} to {to} came to {}",
                now.place
            ),
            // The other kinds have a way of their own: on it, what is nearest was chosen, so that
            // dragging the knob to where it is now changes nothing.
            _ => {
                let rest = handles::drag(now, now.place, 1e-4);
                assert!(rest.is_empty(), "{text}{now:?} {rest:?}");
            }
        }
        moved.set(moved.get() + 1);
        Ok(())
    })
    .cases(1_000);
    assert!(moved.get() > 100, "{}", moved.get());
}

#[test]
fn knobs_follow_along_their_own_way() {
    let text = format!(
        "{MATERIAL}object c\narc s 2 0.5 <1 0 0> <0 0 1> 30 90\nclose\nrotate 1 2 3 40\n\
         scale 2 2 2\n"
    );
    let mut project = project(&text);
    for label in [
        "the start angle",
        "the width",
        "the sweep radius",
        "the tube radius",
        "the normal",
    ] {
        let handles = of(&project, 0);
        let handle = with_label(&handles, label);
        let anchor = compile(&project).scene.elements[0].clone();
        let Some(&field::Skeleton::Arc { center, u, v, .. }) = anchor.shape.skeleton() else {
            panic!("{anchor:?}")
        };
        let to = match handle.kind {
            Kind::Angle => {
                let from = handle.place - center;
                let size = from.length();
                let turned = from.dot(u) * (u * 0.8 + v * 0.6) + from.dot(v) * (v * 0.8 - u * 0.6);
                center + turned.normalize() * size
            }
            Kind::Length if label == "the sweep radius" => center + (handle.place - center) * 1.25,
            Kind::Direction => {
                let from = handle.place - center;
                center + (from + u * 0.3 * from.length()).normalize() * from.length()
            }
            _ => handle.place,
        };
        let edits = handles::drag(handle, to, 1e-6);
        project = project.apply(&edits);
        let handles = of(&project, 0);
        let now = with_label(&handles, label).place;
        let tolerance = if handle.kind == Kind::Direction {
            1e-2
        } else {
            1e-4
        };
        assert!(now.distance(to) < tolerance, "{label}: {now} is not {to}");
    }
}

#[test]
fn any_text_has_handles_without_a_panic() {
    trials(|u| {
        let mut text = scene(u)?;
        // Damage it somewhere.
        for _ in 0..u.int_in_range(0..=4)? {
            let at = text.floor_char_boundary(u.int_in_range(0..=text.len())?);
            let piece = *u.choose(&[
                "{",
                "}",
                "-",
                "x",
                "<",
                "for i = 1 to 2 {",
                "\n",
                "1e99",
                "−",
                "sphere s 1 0 0 0\n",
                "var x = 1\n",
                "#",
                "define d(x) {",
                ".",
                "rand",
                "instance c\n",
                "surface s = s\n",
            ])?;
            text.insert_str(at, piece);
        }
        let mut project = project(&text);
        let compiled = compile(&project);
        for element in 0..compiled.scene.elements.len() + 1 {
            for handle in handles_of(&project, &compiled, element) {
                assert!(handle.place.is_finite());
                let far = f64::from(u.int_in_range(-9..=9)?);
                for to in [DVec3::splat(far), handle.place, DVec3::splat(f64::INFINITY)] {
                    for edit in handles::drag(&handle, to, 0.01) {
                        let text = &project.files[edit.file].text;
                        let old = text.get(edit.span.clone()).expect("a number's place");
                        let old = old.trim_start_matches(['-', '−', '+', ' ']);
                        assert!(
                            old.parse::<f64>().is_ok() || old.contains(['#', '\n']),
                            "{old}"
                        );
                        assert!(edit.text.parse::<f64>().is_ok(), "{edit:?}");
                    }
                }
                let edits = handles::drag(&handle, DVec3::splat(far), 1e-3);
                let mut changed = project.clone();
                changed = changed.apply(&edits);
                drop(compile(&changed));
            }
        }
        project = project.apply(&[]);
        Ok(())
    })
    .cases(1_000);
}
