//! `mesh sn creature.strokes`: sculptures in datasets.

use rats::{Asset, Compiled, File, Project, Severity, compile_at};

const HORN: &str =
    "strokes 1\nstart sphere 4\npull sphere 0.4 0.4 0.4 cusp 0.8 : 0 0 0.9, 0 0 1.6\n";

fn project(main: &str, strokes: &str) -> Project {
    let file = |name: &str, text: &str| File {
        name: name.into(),
        text: text.into(),
    };
    Project {
        files: vec![file("main.rat", main), file("horn.strokes", strokes)],
    }
}

fn run(main: &str, strokes: &str) -> Compiled {
    let head = "surface Clay, diffuse SandyBrown\n";
    compile_at(&project(&format!("{head}{main}"), strokes), &[], 0.0)
}

#[test]
fn sculpture_is_a_mesh_like_any_other() {
    let hard = run("mesh Clay horn.strokes\n", HORN);
    assert_eq!(hard.diagnostics, []);
    assert_eq!(hard.scene.elements.len(), 128);
    let direct = sculpt::replay(
        &HORN.parse().unwrap(),
        &mut |_| Err(String::new()),
        u64::MAX,
        |_, _, _| (),
    );
    let direct = direct.unwrap().to_triangles().unwrap();
    let Some(field::Skeleton::Triangle { corners }) = hard.scene.elements[5].shape.skeleton()
    else {
        panic!("smooth triangles");
    };
    assert_eq!(*corners, direct.corners(5));
    let soft = run(
        "soft on\nsurface Flesh, diffuse Coral, blobbiness -2, radius 0.2\n\
         mesh Flesh horn.strokes\n",
        HORN,
    );
    assert!(
        soft.diagnostics
            .iter()
            .all(|d| d.severity != Severity::Error),
        "{:?}",
        soft.diagnostics
    );
    let balls = run("mesh Clay horn.strokes metaballs triangular 0.1 60\n", HORN);
    assert!(
        balls
            .diagnostics
            .iter()
            .all(|d| d.severity != Severity::Error),
        "{:?}",
        balls.diagnostics
    );
    assert_eq!(balls.scene.elements.len(), 1);
}

#[test]
fn paint_tints_the_material_where_it_is() {
    let painted = format!("{HORN}paint 1 0.04 0.04 sphere 0.5 0.5 0.5 flat 0 : 0 0 1.6\n");
    for soft in ["", ", blobbiness -2, radius 0.2"] {
        let main = format!("surface Flesh, diffuse <0.5 0.5 0.5>{soft}\nmesh Flesh horn.strokes\n");
        let compiled = run(&main, &painted);
        let is_error = |d: &rats::Diagnostic| d.severity == Severity::Error;
        assert!(
            !compiled.diagnostics.iter().any(is_error),
            "{:?}",
            compiled.diagnostics
        );
        let scene = &compiled.scene;
        let mut tops = 0;
        for element in &scene.elements {
            let Some(field::Skeleton::Triangle { corners }) = element.shape.skeleton() else {
                panic!("triangles");
            };
            let [red, green, blue] = scene.finishes[element.finish as usize].diffuse;
            assert_eq!(green, blue);
            // Paint leaves red as it is.
            assert_eq!(red, 0.5);
            let (lowest, highest) = corners
                .iter()
                .fold((9.0_f64, -9.0_f64), |(l, h), c| (l.min(c.z), h.max(c.z)));
            if lowest > 1.3 {
                tops += 1;
                assert!(green < 0.4, "{green} at {corners:?}");
            }
            if highest < 0.0 {
                assert_eq!(green, 0.5);
            }
            assert_eq!(element.flesh.is_some(), !soft.is_empty());
        }
        assert!(tops > 0);
        assert!(scene.finishes.len() < 12, "{}", scene.finishes.len());
    }
}

#[test]
fn sculpture_that_grows_equals_one_made_at_once() {
    let more = "symmetry x\npull sphere 0.3 0.3 0.3 bell 0.5 : 0.9 0 0, 1.3 0 0\nrefine\n";
    let _ = run("mesh Clay horn.strokes\n", HORN);
    let grown = run("mesh Clay horn.strokes\n", &format!("{HORN}{more}"));
    // By another thread, which keeps nothing of this one.
    let text = format!("{HORN}{more}# again\n");
    let at_once = std::thread::spawn(move || run("mesh Clay horn.strokes\n", &text).scene);
    let at_once = at_once.join().unwrap();
    assert_eq!(grown.scene.elements.len(), 512);
    assert!(
        grown
            .scene
            .elements
            .iter()
            .zip(&at_once.elements)
            .all(|(a, b)| a.shape == b.shape)
    );
    // And back.
    let back = run("mesh Clay horn.strokes\n", &format!("{HORN}# undone\n"));
    assert_eq!(back.scene.elements.len(), 128);
}

#[test]
fn mistakes_are_told_where_they_stand() {
    let told = run(
        "mesh Clay horn.strokes\n",
        "strokes 1\nstart sphere 4\npull globe 1 1 1 : 0 0 0\nloop x\n",
    );
    let places: Vec<(&str, usize, usize)> = told
        .diagnostics
        .iter()
        .map(|d| (d.file.as_str(), d.line, d.column))
        .collect();
    assert_eq!(places, [("horn.strokes", 3, 6), ("horn.strokes", 4, 6)]);
    assert_eq!(
        told.diagnostics[0].message,
        "a tool is expected: box, cylinder or sphere"
    );
    assert_eq!(
        (
            told.diagnostics[0].related[0].file.as_str(),
            told.diagnostics[0].related[0].line
        ),
        ("main.rat", 2)
    );
    let none = run("mesh Clay dog.strokes\n", HORN);
    assert_eq!(
        none.diagnostics[0].message,
        "there is no text of strokes `dog.strokes` in the project"
    );
    assert_eq!(
        none.diagnostics[0].hint.as_deref(),
        Some("did you mean `horn.strokes`?")
    );
}

#[test]
fn sculpture_may_start_from_a_file() {
    let strokes = "strokes 1\nstart file cube.obj\nrefine\n";
    let project = project(
        "surface Clay, diffuse SandyBrown\nmesh Clay horn.strokes\n",
        strokes,
    );
    let missing = compile_at(&project, &[], 0.0);
    assert_eq!(
        missing.diagnostics[0].message,
        "there is no mesh `cube.obj` in the project"
    );
    assert_eq!(
        (missing.diagnostics[0].line, missing.diagnostics[0].column),
        (2, 1)
    );
    let tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let asset = Asset::new("cube.obj", tetrahedron.as_bytes());
    let made = compile_at(&project, &[asset], 0.0);
    assert_eq!(made.diagnostics, []);
    assert_eq!(made.scene.elements.len(), 16);
    assert_eq!(rats::asset_names(strokes), ["cube.obj"]);
}

#[test]
fn no_text_of_strokes_takes_long() {
    let endless = format!(
        "strokes 1\nstart sphere 60\n{}",
        "average 100\n".repeat(2000)
    );
    let told = run("mesh Clay horn.strokes\n", &endless);
    assert_eq!(
        told.diagnostics[0].message,
        "all strokes together take too long"
    );
    let large = run("mesh Clay horn.strokes\n", "strokes 1\nstart sphere 400\n");
    assert!(
        large.diagnostics[0]
            .message
            .starts_with("this start has 1280000 faces")
    );
    let growing = format!("strokes 1\nstart sphere 20\n{}", "refine\n".repeat(9));
    let told = run("mesh Clay horn.strokes\n", &growing);
    assert_eq!(told.errors(), 1);
}

trait Errors {
    fn errors(&self) -> usize;
}

impl Errors for Compiled {
    fn errors(&self) -> usize {
        let severe = |d: &&rats::Diagnostic| d.severity == Severity::Error;
        self.diagnostics.iter().filter(severe).count()
    }
}
