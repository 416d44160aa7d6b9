//! Random texts and links: nothing panics, nothing hangs, no result is broken.

use rats::link::{self, Shared};
use rats::{File, Project, commands, compile};
use std::time::Duration;
use trials::arbitrary::{Result, Unstructured};
use trials::{WorkClock, trials};

/// Far above what any text may take on the slowest machine that runs the tests, unoptimised.
const PATIENCE: Duration = Duration::from_secs(20);

fn check(project: &Project) {
    let begin = WorkClock::start();
    let compiled = compile(project);
    assert!(begin.elapsed() < PATIENCE, "{:?}", begin.elapsed());
    assert!(compiled.diagnostics.len() <= rats::limits::MAX_DIAGNOSTICS);
    for d in &compiled.diagnostics {
        let file = project.files.iter().find(|f| f.name == d.file);
        let text = &file.expect("the file that is named").text;
        assert!(text.get(d.span.clone()).is_some(), "{d:?}");
        assert!(d.line >= 1 && d.column >= 1, "{d:?}");
        assert!(!d.message.is_empty(), "{d:?}");
    }
    for hot in &compiled.hot {
        if let Some(range) = &hot.literal {
            assert!(project.files[hot.file].text.get(range.clone()).is_some());
        }
    }
    let scene = &compiled.scene;
    assert!(!scene.finishes.is_empty());
    for element in &scene.elements {
        assert!((element.finish as usize) < scene.finishes.len());
        assert!(
            element
                .flesh
                .is_none_or(|flesh| (flesh as usize) < scene.flesh.len())
        );
        let paint = element.paint.as_ref();
        assert!(paint.is_none_or(|paint| (paint.finish as usize) < scene.finishes.len()));
        assert!((element.body as usize) < scene.bodies.len());
        assert!((element.frame as usize) < scene.frames.len());
        let origin = element.origin;
        let text = &project.files[origin.file as usize].text;
        assert!(
            text.get(origin.start as usize..origin.end as usize)
                .is_some()
        );
    }
    // JSON knows no infinity and no NaN, so this finds them anywhere in the scene.
    let json = serde_json::to_string(scene).expect("a scene");
    assert_eq!(json.matches("null").count(), absent(scene));
}

/// Returns the number of optional things that a scene leaves out.
fn absent(scene: &scene::Scene) -> usize {
    let flesh = scene.flesh.iter().flat_map(|flesh| {
        [
            flesh.blobbiness.is_none(),
            flesh.profile.is_none(),
            flesh.kernel.is_none(),
            flesh.end_radius.is_none(),
            flesh.end_blobbiness.is_none(),
        ]
    });
    let elements = scene.elements.iter();
    let hard = elements.flat_map(|element| {
        let bone = element.shape.bone();
        [
            element.flesh.is_none(),
            element.paint.is_none(),
            bone.is_some_and(|bone| bone.end_radius.is_none()),
            bone.is_some_and(|bone| bone.normals.is_none()),
        ]
    });
    let curves = scene
        .elements
        .iter()
        .filter_map(|element| element.shape.curves());
    let whole = curves.flat_map(|own| [own.local.is_none(), own.clip.is_none()]);
    let around = [
        scene.settings.map.is_none(),
        scene.sky.is_none(),
        scene.ground.is_none_or(|ground| ground.height.is_none()),
        scene.fog.is_none_or(|fog| fog.height.is_none()),
        scene.lens.focus.is_none(),
    ];
    let moments: usize = scene.moments.iter().map(absent).sum();
    moments
        + flesh
            .chain(hard)
            .chain(whole)
            .chain(around)
            .filter(|&is| is)
            .count()
}

fn one_file(text: String) -> Project {
    Project {
        files: vec![File {
            name: String::from("main.rat"),
            text,
        }],
    }
}

#[test]
fn any_bytes() {
    trials(|u| {
        let bytes: Vec<u8> = u.arbitrary()?;
        let text = String::from_utf8_lossy(&bytes).into_owned();
        check(&one_file(text));
        Ok(())
    })
    .cases(600);
}

/// A text of words of the language in any order.
fn soup(u: &mut Unstructured<'_>) -> Result<String> {
    const WORDS: &[&str] = &[
        "1",
        "-2",
        "0.5",
        "1e9",
        "1e-300",
        "1e308",
        "0",
        "a",
        "b",
        "P",
        "s1",
        "hot",
        "=",
        "+",
        "-",
        "*",
        "/",
        "^",
        "(",
        ")",
        "{",
        "}",
        "{",
        "}",
        "<",
        ">",
        ",",
        "%",
        "@",
        "#",
        "!",
        "to",
        "step",
        "Red",
        "Gold",
        "rand",
        "sin(1)",
        "sin",
        "pi",
        "diff",
        "blob -1",
        "rad .1",
        "text",
        "strength sin one",
        "pigment wood",
        "texture T normal moon, scale 2 2 1\n",
        "texture",
        "hills.png plain",
        "region",
        "mask 1 0",
        "shutter 1\n",
        "+= 1",
        "transform\n",
        "cloud Red object A\n",
        "all",
        "\n",
        "\n",
        "\n",
        "\n",
        "var a = 1\n",
        "surface s1 diff Red\n",
        "sphere s1 1 0 0 0\n",
        "for i = 1 to 3 {",
        "if a < 2 {",
        "else {",
        "define b(P r) {",
        "b 1 2 3 4\n",
        "read other.rat\n",
        "object A\n",
        "close\n",
        "vec(1,2,3)",
        "1e400",
        "🐚",
        "−",
        "\t",
    ];
    let specs: Vec<_> = commands::all().collect();
    let mut text = String::new();
    for _ in 0..u.int_in_range(0..=120)? {
        match u.int_in_range(0..=3)? {
            0 => text += specs[u.choose_index(specs.len())?].name,
            1 => {
                let spec = specs[u.choose_index(specs.len())?];
                text += spec.options.first().map_or("1", |option| option.name);
            }
            _ => text += u.choose(WORDS)?,
        }
        if u.ratio(9, 10)? {
            text.push(' ');
        }
    }
    Ok(text)
}

#[test]
fn any_words() {
    trials(|u| {
        let text = soup(u)?;
        let mut project = one_file(text);
        project.files.push(File {
            name: String::from("other.rat"),
            text: soup(u)?,
        });
        check(&project);
        Ok(())
    })
    .cases(1_000);
}

#[test]
fn any_slip_in_an_example() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../www/examples");
    let texts: Vec<String> = std::fs::read_dir(folder)
        .expect("the examples")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|ext| ext == "rat"))
        .map(|path| std::fs::read_to_string(path).expect("a text"))
        .collect();
    trials(|u| {
        let mut text = u.choose(&texts)?.clone();
        for _ in 0..u.int_in_range(1..=4)? {
            let mut boundaries = text.char_indices().map(|(i, _)| i).chain([text.len()]);
            let count = boundaries.clone().count();
            let at = boundaries.nth(u.choose_index(count)?).unwrap_or(0);
            match u.int_in_range(0..=2)? {
                0 => text.truncate(at),
                1 => text.insert_str(at, u.choose(&["{", "}", "9", "-", "x", "\n", "(", " "])?),
                _ => {
                    if let Some(c) = text[at..].chars().next() {
                        text.replace_range(at..at + c.len_utf8(), "");
                    }
                }
            }
        }
        check(&one_file(text));
        Ok(())
    })
    .cases(1_000);
}

#[test]
fn any_link() {
    trials(|u| {
        let text: String = u.arbitrary()?;
        let _ = link::decode(&text);
        let bytes: Vec<u8> = u.arbitrary()?;
        use base64::Engine;
        let coder = base64::engine::general_purpose::URL_SAFE_NO_PAD;
        let _ = link::decode(&coder.encode(&bytes));
        let mut framed = vec![1];
        framed.extend(miniz_oxide::deflate::compress_to_vec(&bytes, 1));
        let _ = link::decode(&coder.encode(framed));
        Ok(())
    })
    .cases(600);
}

#[test]
fn any_project_comes_back() {
    trials(|u| {
        let mut files = Vec::new();
        for index in 0..u.int_in_range(1..=4)? {
            files.push(File {
                name: format!("{index}{}", u.choose(&["", ".rat", " ü/x"])?),
                text: u.arbitrary()?,
            });
        }
        let mut number = || -> Result<f64> { Ok(f64::from(u.arbitrary::<i32>()?) / 1000.0) };
        let mut point = || Ok(glam::DVec3::new(number()?, number()?, number()?));
        let (eye, target, up) = (point()?, point()?, point()?);
        let shared = Shared {
            project: Project { files },
            camera: u.ratio(1, 2)?.then_some(scene::Camera {
                eye,
                target,
                up,
                fov: 45.5,
                ..scene::Camera::default()
            }),
        };
        let fragment = link::encode(&shared).expect("a small project");
        assert!(
            fragment
                .bytes()
                .all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_')
        );
        assert_eq!(link::decode(&fragment), Ok(shared));
        Ok(())
    })
    .cases(600);
}
