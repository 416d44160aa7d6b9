//! Commands, group by group.

use field::Skeleton;
use field::{BlobScale, Kernel, Wave};
use glam::DVec3;
use rats::{Act, Compiled, File, HotValue, Project, Severity, compile};
use scene::{Digger, Fragile, LightKind, Scene, Settings, Shape};

fn run(text: &str) -> Compiled {
    compile(&Project {
        files: vec![File {
            name: String::from("main.rat"),
            text: text.to_owned(),
        }],
    })
}

/// The scene of a text without mistakes.
#[track_caller]
fn scene(text: &str) -> Scene {
    let compiled = run(text);
    let complaint = compiled
        .diagnostics
        .iter()
        .find(|d| d.severity > Severity::Note && !d.message.contains("in the picture"));
    assert_eq!(complaint, None, "{text}");
    std::sync::Arc::unwrap_or_clone(compiled.scene)
}

/// The centre of a sphere whose place is written so.
#[track_caller]
fn place(operands: &str) -> DVec3 {
    let scene = scene(&format!("surface s diff Red\nsphere s 1 {operands}"));
    scene.elements[0].shape.middle()
}

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

#[track_caller]
fn near(a: DVec3, b: DVec3) {
    assert!(a.distance(b) < 1e-12, "{a} is not {b}");
}

#[test]
fn nothing() {
    assert_eq!(scene(""), Scene::default());
    assert_eq!(scene("\n# only a comment\n\n"), Scene::default());
}

// ---- words and numbers

#[test]
fn separators() {
    let wanted = v(-0.5, 1.0, -2.0);
    for operands in [
        "-0.5 1 -2",
        "<-0.5, 1, -2>",
        "< -.5 1. -2 >",
        "-0.5,1,-2",
        "{ -0.5\n1\n-2 }",
        "-5e-1\t+1\t-2",
        "−0.5 1 −2",
    ] {
        assert_eq!(place(operands), wanted, "{operands}");
    }
}

#[test]
fn arithmetic() {
    assert_eq!(place("1 + 2 3*2 2^3"), v(3.0, 6.0, 8.0));
    assert_eq!(place("1+2*3 (1+2)*3 -2^2"), v(7.0, 9.0, -4.0));
    assert_eq!(place("2^3^2 2^-1 10/4"), v(512.0, 0.5, 2.5));
    assert_eq!(place("1 -2 3"), v(1.0, -2.0, 3.0));
    assert_eq!(place("1 - 2 3 4"), v(-1.0, 3.0, 4.0));
    assert_eq!(place("1-2 3- 1 (4 -1)"), v(-1.0, 2.0, 3.0));
    assert_eq!(place("7 - 2 - 1 8/2/2 3"), v(4.0, 2.0, 3.0));
}

#[test]
fn functions() {
    near(
        place("sin(pi/2) cos(pi) atan2(1, 1)*4/pi"),
        v(1.0, -1.0, 1.0),
    );
    assert_eq!(place("max(1, 3, 2) min(1, -3) abs(-2)"), v(3.0, -3.0, 2.0));
    assert_eq!(place("floor(-1.5) ceil(1.2) round(2.5)"), v(-2.0, 2.0, 3.0));
    near(place("deg(pi) rad(180)/pi sqrt(16)"), v(180.0, 1.0, 4.0));
    near(
        place("exp(1)/exp(1) ln(exp(2)) mod(-1, 3)"),
        v(1.0, 2.0, 2.0),
    );
    near(place("tan(pi/4) asin(1)*2/pi acos(1)"), v(1.0, 1.0, 0.0));
    assert_eq!(place("SIN(0) sign(-4) sign(0)"), v(0.0, -1.0, 0.0));
}

#[test]
fn vectors() {
    assert_eq!(place("vec(1, 2, 3)*2 - vec(1, 1, 1)"), v(1.0, 3.0, 5.0));
    assert_eq!(place("cross(vec(1,0,0), vec(0,1,0))"), DVec3::Z);
    assert_eq!(
        place("dot(vec(1,2,3), vec(1,1,1)) length(vec(3,4,0)) 0"),
        v(6.0, 5.0, 0.0)
    );
    assert_eq!(place("unit(vec(0, 0, -7))"), DVec3::NEG_Z);
    assert_eq!(place("vec(2, 4, 6)/2"), v(1.0, 2.0, 3.0));
}

#[test]
fn random_numbers_are_frozen() {
    // Datasets in links depend on these numbers: they may never change.
    let [a, b] = [place("rand rand rand"), place("rand(7) rand(1, 2) rand()")];
    assert_eq!(
        a,
        v(
            0.8833108082136426,
            0.43152799704850997,
            0.026433771592597743
        )
    );
    assert_eq!(
        b,
        v(0.04783404902957766, 0.9537216673637242, 0.8833108082136426)
    );
    // Earlier random numbers do not matter after `seed`.
    let sphere = "seed 5\nsurface s diff Red\nsphere s 1 rand rand rand";
    let shape = |text: &str| scene(text).elements[0].shape.clone();
    assert_eq!(shape(sphere), shape(&format!("var x = rand\n{sphere}")));
    assert_ne!(shape(sphere), shape(&sphere.replace('5', "6")));
}

// ---- RUN

#[test]
fn variables() {
    let text = "var a = 2\nvar V = 1 2 3\nvar C = Red\nvar A = a + 1\nsurface s diff C\n";
    let scene_of = |sphere: &str| scene(&format!("{text}{sphere}"));
    let sphere = |text: &str| {
        let shape = &scene_of(text).elements[0].shape;
        (shape.middle(), shape.radius())
    };
    assert_eq!(sphere("sphere s a V"), (v(1.0, 2.0, 3.0), 2.0));
    assert_eq!(sphere("sphere s A V.z a V.x"), (v(3.0, 2.0, 1.0), 3.0));
    assert_eq!(
        scene_of("sphere s 1 C").finishes[0].diffuse,
        [1.0, 0.0, 0.0]
    );
}

#[test]
fn hot_variables() {
    let text = "var r = -0.5 hot\nvar V = 1, 2 -3 hot\nvar C = Gold hot\n\
        var D = rgb(0.1, 0.2, 0.3) hot\n\
                var e = r*2 hot\nvar f = 1\nvar C = 0 1 0 hot\n";
    let compiled = run(text);
    assert!(compiled.diagnostics.is_empty());
    let found: Vec<_> = compiled
        .hot
        .iter()
        .map(|hot| {
            let literal = hot.literal.clone().map(|range| &text[range]);
            (hot.name.as_str(), hot.value.clone(), literal)
        })
        .collect();
    assert_eq!(
        found,
        [
            ("r", HotValue::Scalar(-0.5), Some("-0.5")),
            ("V", HotValue::Vector([1.0, 2.0, -3.0]), Some("1, 2 -3")),
            ("C", HotValue::Colour([0.0, 1.0, 0.0]), Some("0 1 0")),
            (
                "D",
                HotValue::Colour([0.1, 0.2, 0.3]),
                Some("rgb(0.1, 0.2, 0.3)")
            ),
            ("e", HotValue::Scalar(-1.0), None),
        ]
    );
}

#[test]
fn presets_are_sets_of_values_by_name() {
    let text = "surface s diff Red\nvar r = 1 hot\nvar P = 0 0 0 hot\nvar C = Gold hot\n\
        preset one, set r 2, set P 1 -2 -3, set C 1 0 0\npreset two, set r 2*r\n\
        preset one set r -r\nsphere s r P\n";
    let presets = run(text).presets;
    let all = [
        ("one", HotValue::Scalar(-1.0)),
        ("two", HotValue::Scalar(2.0)),
    ];
    for (preset, (name, r)) in presets.iter().zip(all) {
        assert_eq!(
            (&*preset.name, &*preset.values),
            (name, &[(String::from("r"), r)][..])
        );
    }
    assert_eq!(presets.len(), 2);
    let first = text.replace("preset one set", "preset three set");
    let values = run(&first).presets.swap_remove(0).values;
    let values: Vec<HotValue> = values.into_iter().map(|(_, value)| value).collect();
    let place = HotValue::Vector([1.0, -2.0, -3.0]);
    let colour = HotValue::Colour([1.0, 0.0, 0.0]);
    assert_eq!(values, [HotValue::Scalar(2.0), place, colour]);
    assert_eq!(run(&format!("{text}reset var\n")).presets, []);
}

#[test]
fn hot_variables_of_other_files() {
    let file = |name: &str, text: &str| File {
        name: name.to_owned(),
        text: text.to_owned(),
    };
    let compiled = compile(&Project {
        files: vec![
            file("main.rat", "read b.dat"),
            file("a.dat", ""),
            file("b.dat", "var x = 5 hot"),
        ],
    });
    assert_eq!(compiled.hot[0].file, 2);
    assert_eq!(compiled.hot[0].literal, Some(8..9));
}

#[test]
fn files_share_everything() {
    let compiled = compile(&Project {
        files: vec![
            File {
                name: String::from("main.rat"),
                text: String::from(
                    "surface s diff Red\nfor i = 1 to 3 { read ball.dat }\nsphere s 1 x 0 0\n\
                     eyep 0 0 99",
                ),
            },
            File {
                name: String::from("ball.dat"),
                text: String::from("var x = i*7\nsphere s 1 i 0 0\nreturn\nsphere s 1 99 0 0"),
            },
        ],
    });
    assert_eq!(compiled.diagnostics, []);
    assert_eq!(compiled.scene.elements.len(), 4);
    assert_eq!(compiled.scene.elements[0].origin.file, 1);
    assert_eq!(compiled.scene.elements[3].origin.file, 0);
}

// ---- CAMERA

#[test]
fn camera() {
    let camera = scene("eyep 1 2 3\nvrp <4 5 6>\nvup 0 0 2\nfov 30 30").camera;
    assert_eq!(camera.eye, v(1.0, 2.0, 3.0));
    assert_eq!(camera.target, v(4.0, 5.0, 6.0));
    assert_eq!(camera.up, DVec3::Z);
    assert_eq!(camera.fov, 30.0);
}

/// A window of other proportions than the frame's, or a vertical angle, makes pixels that are not
/// square; what nearly fits does not.
#[test]
fn pixels_that_are_not_square() {
    for (text, pixel) in [
        ("framesize 200 100\ncp 0 0 8\nwindow -3 3 -3 3", 2.0),
        ("framesize 200 100\ncp 0 0 8\nwindow -3 3 -1.5 1.5", 1.0),
        ("framesize 640 480\nfov 50 38.5", 1.0),
        ("framesize 640 480\nfov 50 50", 1.0),
        ("fov 90 45", 0.41421356),
        ("fov 90 45\nfov 90", 1.0),
    ] {
        let found = scene(text).camera.pixel;
        assert!((found - pixel).abs() < 1e-6, "{text}: {found}");
    }
}

/// Rays of a picture with the weight 0 are as good as parallel: what is near is drawn as large as
/// what is far away, straight or aslant.
#[test]
fn a_weight_of_0_makes_rays_parallel() {
    fn project(text: &str, place: DVec3) -> [f64; 2] {
        let scene = scene(text);
        let projection = scene.camera.projection(200, 100);
        let view = projection.world_from_view.transpose() * (place - projection.eye);
        let [x, y] = [view.x, view.y].map(|across| across / -view.z);
        let [left, up] = projection.shift;
        [
            (x - left) / projection.half_width,
            (y - up) / projection.half_height,
        ]
    }
    let straight = "framesize 200 100\nvrp 1 2 3\nvpn 0 0 1\ncp 0 0 1 0\nwindow -4 4 -2 2";
    let slanted = "framesize 200 100\nvrp 1 2 3\nvpn 0 0 1\ncp 0.5 -0.25 1 0\nwindow -4 4 -2 2";
    let moved = "framesize 200 100\nvrp 1 2 3\nvpn 0 0 1\ncp 0 0 3 0\nwindow 0 8 -1 3";
    for depth in [-8.0, 0.0, 8.0] {
        for [x, y] in [[0.0, 0.0], [2.0, 1.0], [-3.0, -2.0]] {
            let place = v(1.0 + x, 2.0 + y, 3.0 + depth);
            let [a, b] = project(straight, place);
            assert!(
                (a - x / 4.0).abs() < 1e-3 && (b - y / 2.0).abs() < 1e-3,
                "{a} {b}"
            );
            let [a, b] = project(moved, place);
            let wanted = [(x - 4.0) / 4.0, (y - 1.0) / 2.0];
            assert!(
                (a - wanted[0]).abs() < 2e-3 && (b - wanted[1]).abs() < 2e-3,
                "{a} {b}"
            );
            let [a, b] = project(slanted, place);
            let wanted = [(x - 0.5 * depth) / 4.0, (y + 0.25 * depth) / 2.0];
            assert!(
                (a - wanted[0]).abs() < 4e-3 && (b - wanted[1]).abs() < 4e-3,
                "{a} {b}"
            );
        }
    }
    // Without a window it is as wide as the angle of view makes it at the reference point.
    let angle = "eyep 0 0 10\nfov 90\nframesize 200 100\ncp 0 0 1 0";
    assert!((project(angle, v(10.0, 0.0, -3.0))[0] - 1.0).abs() < 1e-3);
    let leaning = run("cp 3 0 1 0");
    assert!(leaning.diagnostics[0].message.contains("lean"));
}

/// `sample` below 1 sends one ray for a block of pixels.
#[test]
fn fewer_rays_than_pixels() {
    for (text, samples, block) in [
        ("sample 0.5", 1, 2),
        ("sample 1/4", 1, 4),
        ("sample 0.3", 1, 4),
        ("sample 0.0625", 1, 16),
        ("sample 1", 1, 1),
        ("sample adaptive", 4, 1),
        ("sample adaptive 3", 3, 1),
        ("sample 3 adaptive", 3, 1),
        ("sample 0.5\nsample 2", 2, 1),
    ] {
        let settings = scene(text).settings;
        assert_eq!(
            (settings.samples, settings.block),
            (samples, block),
            "{text}"
        );
    }
    assert_eq!(run("sample 3 adaptive").diagnostics, []);
    for wrong in [
        "sample 0",
        "sample 0.05",
        "sample 17",
        "sample 1.5",
        "sample",
        "sample -1",
    ] {
        assert_eq!(
            run(wrong).diagnostics[0].severity,
            Severity::Error,
            "{wrong}"
        );
    }
}

/// `report` with a word tells values.
#[test]
fn report_tells_values() {
    fn report(what: &str) -> String {
        let text = format!(
            "var r = 0.5\nvar C = Red\nsurface s diff Red, radius r, blob -2, kernel gauss\n\
             surface t diff Blue, shine 7\nlight White, position 1 2 3\neyep 0 0 7\n\
             sphere s 1 0 0 0\nbox t 0 0 0 1 1 1\nreport {what}"
        );
        let compiled = run(&text);
        let notes = compiled.diagnostics.into_iter().find(|d| d.line == 9);
        notes.map(|d| d.message).unwrap_or_default()
    }
    for (word, wanted) in [
        (
            "surfaces",
            "s: diffuse 1 0 0, ambient 0.15 0 0, radius 0.5, blobbiness 2, kernel gauss",
        ),
        ("surfaces", "t: diffuse 0 0 1, ambient 0 0 0.15, shine 7"),
        ("lights", "1 1 1 point, position 1 2 3"),
        ("cameras", "eyep 0 0 7, vrp 0 0 0, vup 0 1 0, fov 45"),
        ("options", "framesize 128 128, sample 1"),
        ("var", "C = rgb(1, 0, 0)\nr = 0.5"),
        ("data", "2 shapes, 1 of them soft"),
        ("fog", "no fog"),
        ("all", "r = 0.5"),
        ("", "there are here: 2 shapes, 2 materials"),
    ] {
        assert!(report(word).contains(wanted), "{word}: {}", report(word));
    }
}

/// Acts of the program between pictures stand where the text has them.
#[test]
fn pauses_logs_and_stopwatches_are_handed_on() {
    let compiled = run(
        "surface s diff Red\nlog a.txt\nstopwatch start\nsphere s 1 0 0 0\n\
         shoot\nstopwatch stop\npause now look\nfilename b\nshoot\nlog",
    );
    let acts: Vec<_> = compiled
        .interludes
        .iter()
        .map(|i| (i.after, i.act.clone()))
        .collect();
    let wanted = [
        (0, Act::Log(Some(String::from("a.txt")))),
        (0, Act::Stopwatch { starts: true }),
        (1, Act::Stopwatch { starts: false }),
        (1, Act::Pause(String::from("now look"))),
        (2, Act::Log(None)),
    ];
    assert_eq!(acts, wanted);
    assert_eq!(
        run("log model.rat").diagnostics[0].severity,
        Severity::Error
    );
}

/// Results are saved under the command's own name where the text gives none.
#[test]
fn results_have_names_of_their_own() {
    fn save(text: &str) -> Option<String> {
        run(text).tools[0].writes().map(str::to_owned)
    }
    assert_eq!(save("diff a.png b.png save").as_deref(), Some("diff.png"));
    assert_eq!(save("and a.png b.png save").as_deref(), Some("and.png"));
    assert_eq!(save("xor a.png b.png save c.tga").as_deref(), Some("c.tga"));
    assert_eq!(save("diff a.png b.png"), None);
}

// ---- MATERIALS

#[test]
fn surfaces() {
    let scene = scene(
        "surface { s, diffuse 0.5 0.25 1, specular White, shine 40, \
         radius .3, blobbiness -8, strength 2 }\n\
         material t body 1 0.5 0, ambient 10%, diffuse 80%, specular 50%, kernel CAUCHY\n\
         surface u ambient Red\n\
         sphere s 1 0 0 0\nsphere t 1 0 0 0\nsphere u 1 0 0 0",
    );
    let [s, t, u] = &scene.finishes[..] else {
        panic!("three materials");
    };
    let [soft, hard, _] = &scene.flesh[..] else {
        panic!("three materials");
    };
    assert_eq!(s.name, "s");
    assert_eq!(s.diffuse, [0.5, 0.25, 1.0]);
    assert_eq!(
        s.ambient,
        [0.5, 0.25, 1.0].map(|c| c * scene::Finish::AMBIENT_SHARE)
    );
    assert_eq!((s.specular, s.shine), ([1.0; 3], 40.0));
    assert_eq!(
        (soft.radius, soft.blobbiness, soft.strength),
        (0.3, Some(8.0), 2.0)
    );
    assert_eq!(soft.kernel, None);
    assert_eq!(scene.elements[0].kernel, Kernel::Cauchy);
    assert!(soft.is_soft());
    assert_eq!(
        scene.elements.iter().map(|e| e.flesh).collect::<Vec<_>>(),
        [Some(0), None, None]
    );
    assert_eq!(t.diffuse, [0.8, 0.4, 0.0]);
    assert_eq!(t.ambient, [0.1, 0.05, 0.0]);
    assert_eq!(t.specular, [0.5; 3]);
    assert!(!hard.is_soft());
    assert_eq!(u.ambient, [1.0, 0.0, 0.0]);
}

/// `surface new = s` copies what the parameter `s` stands for.
#[test]
fn a_material_that_was_passed_on_is_copied() {
    let text = "surface Clay diff Red\ndefine ball(surface s) {\n\
                surface own = s, rad 2\nsphere own 1, 0 0 0\n}\nball Clay\n";
    let scene = scene(text);
    let index = scene.elements[0].finish as usize;
    assert_eq!(scene.finishes[index].diffuse, [1.0, 0.0, 0.0]);
    assert_eq!(scene.flesh[index].radius, 2.0);
}

#[test]
fn a_material_made_anew_leaves_older_shapes_alone() {
    let scene = scene(
        "surface s diff Red\nsphere s 1 0 0 0\nsurface s diff Blue\nsphere s 1 0 0 0\n\
         surface s = s, shine 5\nsphere s 1 0 0 0",
    );
    let material = |i: usize| &scene.finishes[scene.elements[i].finish as usize];
    assert_eq!(material(0).diffuse, [1.0, 0.0, 0.0]);
    assert_eq!(material(1).diffuse, [0.0, 0.0, 1.0]);
    assert_eq!(
        (material(2).diffuse, material(2).shine),
        ([0.0, 0.0, 1.0], 5.0)
    );
}

#[test]
fn profiles() {
    let scene = scene(
        "var Lo = 0.5 0.5 0.5\nvar Hi = 0.7 0.7 0.7\n\
         texture TT strength sin^2 one bounds Lo Hi scale 22 11 1 times 1.15 1 1\n\
         texture UU = TT\ntexture VV texture UU\n\
         surface s diff Red, blob -1, rad 1, text VV\nsphere s 1 0 0 0",
    );
    let profile = scene.flesh[0].profile.expect("a profile");
    assert_eq!(profile.waves, [Wave::Sin2, Wave::One]);
    assert_eq!(profile.scale, [22.0, 11.0]);
    assert_eq!(profile.bounds, [0.5, 0.7]);
    assert_eq!(profile.times, 1.15);
}

// ---- PRIMITIVES

fn shape(text: &str) -> Shape {
    scene(&format!("surface s diff Red\n{text}")).elements[0]
        .shape
        .clone()
}

#[test]
fn primitives() {
    assert_eq!(
        shape("cylinder s .5 <0 0 0> <1 2 3>"),
        Shape::cylinder(DVec3::ZERO, v(1.0, 2.0, 3.0), 0.5)
    );
    assert_eq!(
        shape("triangle s <0 0 0> <1 0 0> <0 1 0>"),
        Shape::triangle([DVec3::ZERO, DVec3::X, DVec3::Y], 0.0)
    );
    assert_eq!(
        shape("plane s <0 0 1> <0 0 5>"),
        Shape::plane(DVec3::Z, DVec3::Z, 0.0)
    );
    let full = Shape::arc(
        DVec3::X,
        [DVec3::X, DVec3::Y],
        2.0,
        std::f64::consts::TAU,
        0.5,
    );
    assert_eq!(shape("torus s 2 .5 <1 0 0> <0 0 1>"), full);
    assert_eq!(shape("arc s 2 .5 <1 0 0> <0 0 3> 0 360"), full);
    let arch = shape("arch s .1 <1 0 0> <0 1 0> <-1 0 0>");
    let Some(&Skeleton::Arc {
        center,
        radius: sweep,
        angle,
        ..
    }) = arch.skeleton()
    else {
        panic!("an arc");
    };
    near(center, DVec3::ZERO);
    assert!((sweep - 1.0).abs() < 1e-12 && (angle - std::f64::consts::PI).abs() < 1e-12);
}

#[test]
fn soft_shapes_without_a_radius_of_their_own_take_the_material_s() {
    let scene = scene(
        "surface s diff Red, blob -1, rad .25, kernel cauchy\nline s <0 0 0> <1 0 0>\n\
         dot s <0 0 0>\n\
         triangle s <0 0 0> <1 0 0> <0 1 0>",
    );
    for element in &scene.elements {
        assert_eq!(scene.radius(element), 0.25);
    }
    assert_eq!(scene.soft_surfaces()[0].sum.primitives.len(), 3);
}

#[test]
fn fragile_pipes() {
    let pipe = "surface s diff Red, blob -1, rad .25\npipe s .5 <0 0 0> <1 0 0>\n";
    for (fragile, radius) in [
        ("none", 0.5),
        ("pipe", 0.25),
        ("all", 0.25),
        ("arc sphere", 0.5),
    ] {
        let scene = scene(&format!("{pipe}fragile {fragile}"));
        assert_eq!(scene.radius(&scene.elements[0]), radius, "{fragile}");
    }
}

// ---- OBJECTS

/// The centres of all spheres of a text.
fn centers(text: &str) -> Vec<DVec3> {
    scene(&format!("surface s diff Red\n{text}"))
        .elements
        .iter()
        .map(|element| element.shape.middle())
        .collect()
}

#[test]
fn transforms_of_the_last_object() {
    let found = centers("sphere s 1 1 0 0\nsphere s 1 1 0 0\ntranslate 0 2 0");
    assert_eq!(found, [v(1.0, 0.0, 0.0), v(1.0, 2.0, 0.0)]);
    let found = centers("object A\nsphere s 1 1 0 0\nclose\nrotate 0 0 1 90");
    assert_eq!(found, [v(0.0, 1.0, 0.0)]);
    let found = centers(
        "sphere s 1 0 0 0\nobject A\nsphere s 1 1 0 0\nclose\nsphere s 1 0 0 0\nscale 2 2 2 A",
    );
    assert_eq!(found, [DVec3::ZERO, v(2.0, 0.0, 0.0), DVec3::ZERO]);
}

#[test]
fn objects_inside_objects() {
    let found = centers(
        "object OUT\n  object IN\n    sphere s 1 1 0 0\n  close\n  rotate 0 0 1 90 IN\n  \
         sphere s 1 1 0 0\nclose\n\
         translate 10 0 0 OUT",
    );
    near(found[0], v(10.0, 1.0, 0.0));
    near(found[1], v(11.0, 0.0, 0.0));
}

#[test]
fn instances_and_removal() {
    let found = centers(
        "object A\nsphere s 1 1 0 0\nclose\ninstance A B\ntranslate 0 0 1\ninstance B\nremove A",
    );
    assert_eq!(found, [v(1.0, 0.0, 1.0), v(1.0, 0.0, 1.0)]);
}

/// Angles about x, then y, then z are three numbers alone.
#[test]
fn rotate_takes_three_angles() {
    fn turn(how: &str) -> DVec3 {
        centers(&format!("object A\nsphere s 1 1 2 3\nclose\n{how}"))[0]
    }
    for [x, y, z] in [[0.0, 0.0, 45.0], [30.0, 0.0, 0.0], [10.0, -70.0, 200.0]] {
        let steps = format!("rotate 1 0 0 {x}\nrotate 0 1 0 {y} A\nrotate 0 0 1 {z}");
        near(turn(&format!("rotate {x} {y} {z} A")), turn(&steps));
        near(turn(&format!("rotate {x}, {y}, {z}")), turn(&steps));
    }
    near(turn("rotate 0 0 90 A"), v(-2.0, 1.0, 3.0));
    near(turn("var A = 90\nrotate 0 0 1 A"), v(-2.0, 1.0, 3.0));
    near(turn("rotate 0 0 0"), v(1.0, 2.0, 3.0));
}

/// The transforms of `instance` are those of the commands, for the copy alone.
#[test]
fn instances_are_moved_as_they_are_made() {
    let model = "object A\nsphere s 1 1 2 3\nclose\n";
    for (at_once, steps) in [
        ("translate 1 0 0", "translate 1 0 0 B"),
        (
            "translate 1 0 0 rotate 0 0 1 90",
            "translate 1 0 0 B\nrotate 0 0 1 90 B",
        ),
        (
            "rotate 0 0 90 tr 1 0 0",
            "rotate 0 0 90 B\ntranslate 1 0 0 B",
        ),
        (
            "scale 2 2 2, scale 0.5 0.5 0.5, tr 0 1 0",
            "translate 0 1 0 B",
        ),
    ] {
        let wanted = scene(&format!("surface s diff Red\n{model}instance A B\n{steps}"));
        for copy in ["B", ""] {
            let text = format!("surface s diff Red\n{model}instance A {copy} {at_once}");
            let found = scene(&text);
            assert_eq!(found.elements.len(), 2, "{text}");
            near(found.elements[0].shape.middle(), v(1.0, 2.0, 3.0));
            let middles = [&found, &wanted].map(|scene| scene.elements[1].shape.middle());
            near(middles[0], middles[1]);
        }
    }
    // Short names are names, not the beginnings of options.
    let short = scene(&format!(
        "surface s diff Red\n{model}instance A T\ntranslate 1 0 0 T"
    ));
    assert_eq!(short.elements.len(), 2);
    let failed = run(&format!(
        "surface s diff Red\n{model}instance A rotate 0 0 0 30"
    ));
    assert_eq!(failed.diagnostics.len(), 1);
    assert_eq!(failed.scene.elements.len(), 1);
}

#[test]
fn chains() {
    let found = centers(
        "chain s, BEADS\nfor i = 1 to 2 { sphere 1 i 0 0 }\nclose\ntranslate 0 1 0 BEADS\n\
         sphere s 1 0 0 0",
    );
    assert_eq!(found, [v(1.0, 1.0, 0.0), v(2.0, 1.0, 0.0), DVec3::ZERO]);
}

#[test]
fn flesh_scales_with_its_bones() {
    for mode in ["relative", "absolute"] {
        let text = format!(
            "blobscale {mode}\nfragile all\nsurface s diff Red, blob -8, rad .25\nobject A\n\
             cylinder s 1 <0 0 0> <1 0 0>\narc s 1 1 <1 2 3> <0 0 1> 0 90\nclose\n"
        );
        let small = scene(&text).soft_surfaces();
        let large = scene(&format!("{text}scale 3 3 3 A")).soft_surfaces();
        for point in [v(0.5, 0.2, 0.1), v(0.0, 0.0, 0.0), v(1.7, 2.8, 3.1)] {
            let (a, b) = (
                small[0].sum.jet(point).value,
                large[0].sum.jet(point * 3.0).value,
            );
            assert!((a - b).abs() < 1e-9 * a, "{mode}: {a} and {b}");
        }
    }
}

// ---- OPTIONS

#[test]
fn options() {
    let settings = scene(
        "soft off\ndouble off\nfragile arc cyl\nframesize 320 200\nsample 3\ngamma 2.2\n\
         contrast .1 .2 .3\nblobscale absolute\n\
         influence .01\ndigger HERMITE2 4\nmap on 2",
    )
    .settings;
    let wanted = Settings {
        frame: [320, 200],
        samples: 3,
        contrast: [0.1, 0.2, 0.3],
        gamma: 2.2,
        soft: false,
        double_sided: false,
        blob_scale: BlobScale::Absolute,
        fragile: Fragile {
            arc: true,
            cylinder: true,
            ..Fragile::default()
        },
        influence: 0.01,
        digger: Digger::Spans(4),
        map: Some(2.0),
        ..Settings::default()
    };
    assert_eq!(settings, wanted);
    for (text, digger) in [
        ("digger hermite2", Digger::Spans(2)),
        ("digger hermite2\ndigger hermite", Digger::Hermite),
        ("digger lagrange", Digger::Lagrange),
        ("digger Brent", Digger::Brent),
        ("digger ridder", Digger::Ridder),
        ("digger rf", Digger::RegulaFalsi),
        ("digger lg", Digger::Lg),
        ("digger sphere", Digger::Sphere),
    ] {
        assert_eq!(scene(text).settings.digger, digger, "{text}");
    }
    assert_eq!(scene("map on").settings.map, Some(1.0));
    assert_eq!(scene("map on 3\nmap off").settings.map, None);
}

// ---- SCENE

#[test]
fn lights() {
    let lights = scene(
        "light 1 0.5 0, pos 1 2 3, inten 2 noshadow\nlight White distant dir 0 0 -2\n\
         light White distant pos 0 5 0",
    )
    .lights;
    assert_eq!(lights[0].colour, [2.0, 1.0, 0.0]);
    assert!(!lights[0].shadow && lights[1].shadow);
    assert_eq!(
        lights[0].kind,
        LightKind::Point {
            position: v(1.0, 2.0, 3.0)
        }
    );
    assert_eq!(lights[1].kind, LightKind::Distant { towards: DVec3::Z });
    assert_eq!(lights[2].kind, LightKind::Distant { towards: DVec3::Y });
}

#[test]
fn background_and_reset() {
    assert_eq!(
        scene("background 0.1 0.2 0.3").background,
        [0.1, 0.2, 0.3].into()
    );
    let all = "background Red\neyep 1 2 3\nsample 4\nlight White pos 1 1 1\nsurface s diff Red\n\
        sphere s 1 0 0 0\n\
               var x = 1 hot\n";
    let compiled = run(&format!("{all}reset all"));
    assert_eq!(compiled.scene.elements, []);
    assert_eq!(compiled.scene.lights, []);
    assert_eq!(compiled.scene.background, scene::Background::default());
    assert_eq!(compiled.scene.camera, scene::Camera::default());
    assert_eq!(compiled.scene.settings, Settings::default());
    assert_eq!(compiled.hot, []);
    let some = run(&format!("{all}reset lights")).scene;
    assert_eq!((some.lights.len(), some.elements.len()), (0, 1));
}

#[test]
fn what_follows_the_last_shoot_is_in_its_picture() {
    let compiled = run("surface s diff Red\nsphere s 1 0 0 0\nshoot\nsphere s 1 1 0 0\neyep 1 1 1");
    assert_eq!(compiled.scene.elements.len(), 2);
    assert_eq!(compiled.scene.camera.eye, v(1.0, 1.0, 1.0));
    assert_eq!((compiled.diagnostics.len(), compiled.earlier.len()), (1, 0));
    assert_eq!(compiled.diagnostics[0].severity, Severity::Note);
    // Not behind a `reset`, which clears up after the picture.
    let cleared = run("surface s diff Red\nsphere s 1 0 0 0\nshoot\nreset all");
    assert_eq!(
        (cleared.scene.elements.len(), cleared.diagnostics.len()),
        (1, 0)
    );
    let lost = run("surface s diff Red\nsphere s 1 0 0 0\nshoot\nreset data\nsphere s 1 0 0 0");
    assert_eq!(lost.scene.elements.len(), 1);
    assert!(lost.diagnostics[0].message.contains("in no picture"));
}

/// Pictures of several `shoot`s show what stands before each, under the name that stands then.
#[test]
fn several_shoots_take_several_pictures() {
    let compiled = run(
        "surface s diff Red, rad 1, blob -1\nsphere s 1 0 0 0\nfilename one.tga\n\
         eyep 0 0 9\nshoot\nsphere s 1 2 0 0\nsurface s diff Blue, rad 2, blob -1\n\
         sphere s 1 4 0 0\nfilename two\nformat png\neyep 0 0 12\nshoot\n\
         surface s diff Green, rad 1, blob -1\nreset data\nsphere s 1 0 1 0\nnosave on\nshoot",
    );
    let worst = compiled.diagnostics.iter().map(|d| d.severity).max();
    assert_eq!(worst, Some(Severity::Note), "{:?}", compiled.diagnostics);
    let [first, second] = &compiled.earlier[..] else {
        panic!("{} pictures", compiled.earlier.len())
    };
    let names = [&first.output, &second.output, &compiled.output].map(|output| output.file());
    assert_eq!(names, ["one.tga", "two.png", "two.png"]);
    assert!(first.output.saved && second.output.saved && !compiled.output.saved);
    let counts = [&first.scene, &second.scene, &compiled.scene].map(|s| s.elements.len());
    assert_eq!(counts, [1, 3, 1]);
    let eyes = [&first.scene, &second.scene].map(|scene| scene.camera.eye.z);
    assert_eq!(eyes, [9.0, 12.0]);
    let colour =
        |scene: &Scene, index: usize| scene.finishes[scene.elements[index].finish as usize].diffuse;
    let [red, blue] = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    assert_eq!(colour(&first.scene, 0), red);
    // Made after the first picture of the red material, so they keep it.
    let second = &second.scene;
    assert_eq!(
        [0, 1, 2].map(|index| colour(second, index)),
        [red, red, blue]
    );
    let green = colour(&compiled.scene, 0);
    assert!(
        green[0] == 0.0 && green[1] > 0.3 && green[2] == 0.0,
        "{green:?}"
    );
}

/// A material made again behind a `shoot` changes the shapes that stand there, once: in a row of
/// shapes each has its own.
#[test]
fn a_material_made_again_behind_a_picture_changes_its_shapes() {
    let compiled = run(
        "surface s diff Red\nsphere s 1 0 0 0\nfilename a\nshoot\nfilename b\n\
         surface s diff Blue\nsphere s 1 2 0 0\nsurface s diff White\nsphere s 1 4 0 0",
    );
    fn finishes(scene: &Scene) -> Vec<[f32; 3]> {
        let elements = scene.elements.iter();
        elements
            .map(|e| scene.finishes[e.finish as usize].diffuse)
            .collect()
    }
    assert_eq!(finishes(&compiled.scene).len(), 3);
    let [red, blue, white] = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]];
    assert_eq!(finishes(&compiled.scene), [blue, blue, white]);
    assert_ne!(finishes(&compiled.scene)[0], red);
    let soft = run("surface s diff Red\nsphere s 1 0 0 0\nshoot\nfilename b\n\
         surface s diff Blue, radius 1, blob -1\nsphere s 1 2 0 0\nshoot");
    let said: Vec<_> = soft
        .diagnostics
        .iter()
        .map(|d| (d.severity, d.line))
        .collect();
    assert!(said.contains(&(Severity::Warning, 5)), "{said:?}");
    assert_eq!(finishes(&soft.scene), [red, blue]);
}

/// Shapes keep the variables that they were made with, which is said.
#[test]
fn a_variable_set_again_behind_a_picture_is_noted() {
    let text = "var r = 1\nvar q = 1\nsurface s diff Red\nsphere s r 0 0 0\nshoot\nfilename b\n";
    let notes = |more: &str| {
        let compiled = run(&format!("{text}{more}shoot"));
        let said = compiled.diagnostics.iter();
        said.filter(|d| d.message.contains("keep the old")).count()
    };
    assert_eq!(notes("var r = 2\nsphere s r 3 0 0\n"), 1);
    assert_eq!(notes("var r = 1\nvar q = 2\nsphere s q 3 0 0\n"), 0);
    assert_eq!(notes("reset data\nvar r = 2\nsphere s r 3 0 0\n"), 0);
}

/// Pictures with an open shutter have moments of their own.
#[test]
fn each_picture_has_its_moments() {
    let compiled = run(
        "var x = 0 += 1\nsurface s diff Red\nshutter 1\nsphere s 1 x 0 0\nshoot\n\
         filename b\nshutter 0\nsphere s 1 x 1 0\nshoot\nfilename c\nshutter 0.5\n\
         sphere s 1 x 2 0\nshoot",
    );
    let scenes = [
        &compiled.earlier[0].scene,
        &compiled.earlier[1].scene,
        &compiled.scene,
    ];
    let moments = scenes.map(|scene| scene.moments.len());
    assert!(
        moments[0] > 1 && moments[1] == 0 && moments[2] > 1,
        "{moments:?}"
    );
    for (scene, count) in scenes.into_iter().zip([1, 2, 3]) {
        assert!(
            scene
                .moments
                .iter()
                .all(|moment| moment.elements.len() == count)
        );
    }
    fn last(scene: &Scene) -> Option<f64> {
        scene.moments.last().map(|m| m.elements[0].shape.middle().x)
    }
    assert!(last(scenes[0]) > Some(0.8) && last(scenes[2]) < Some(0.5));
}

// ---- extensions

#[test]
fn loops_choices_and_calls() {
    let found = centers(
        "for i = 0 to 1 step 0.25 {\n  if i > 0.4 and i < 0.9 { sphere s 1 i 0 0 } \
         else if i == 0 { sphere s 1 0 9 0 }\n}",
    );
    assert_eq!(
        found,
        [v(0.0, 9.0, 0.0), v(0.5, 0.0, 0.0), v(0.75, 0.0, 0.0)]
    );
    let found = centers(
        "define tower(P n) {\n  sphere s 1 P\n  if n <= 1 { return }\n  \
         tower P + vec(0, 0, 1), n - 1\n}\ntower <1 0 0> 3",
    );
    assert_eq!(
        found,
        [v(1.0, 0.0, 0.0), v(1.0, 0.0, 1.0), v(1.0, 0.0, 2.0)]
    );
    // A tenth is not exact, and still there are eleven turns.
    assert_eq!(
        centers("for i = 0 to 1 step 0.1 { sphere s 1 i 0 0 }").len(),
        11
    );
    // The loop's variable is as before when the loop is done.
    let found = centers("var i = 7\nfor i = 1 to 2 { }\nsphere s 1 i 0 0");
    assert_eq!(found, [v(7.0, 0.0, 0.0)]);
}

#[test]
fn a_failed_command_changes_nothing() {
    let compiled = run(
        "eyep 1 2 3\neyep 4 5\nsurface s diff Red\nsurface s diff Blue, wibble\nsphere s 1 0 0 0\n\
         fragile all\nfragile sphere wibble\nbackground Red\nbackground 1 2",
    );
    assert_eq!(compiled.scene.camera.eye, v(1.0, 2.0, 3.0));
    assert_eq!(compiled.scene.finishes[0].diffuse, [1.0, 0.0, 0.0]);
    assert_eq!(compiled.scene.settings.fragile, Fragile::ALL);
    assert_eq!(compiled.scene.background, [1.0, 0.0, 0.0].into());
    assert_eq!(compiled.diagnostics.len(), 4);
}

// ---- the table

/// Every example in the table is a text without mistakes, and does something if the command does.
#[test]
fn examples_of_the_table() {
    for spec in rats::commands::all() {
        assert!(!spec.example.is_empty(), "{}", spec.name);
        let compiled = run(spec.example);
        let complaint = compiled
            .diagnostics
            .iter()
            .find(|d| d.severity > Severity::Note && spec.idle().is_none());
        assert_eq!(complaint, None, "{}:\n{}", spec.name, spec.example);
        let worst = compiled.diagnostics.iter().map(|d| d.severity).max();
        assert_ne!(worst, Some(Severity::Error), "{}", spec.name);
    }
}

/// `test` runs them, `man` explains them.
#[test]
fn every_command_has_an_etude_and_a_manual() {
    for spec in rats::commands::all() {
        let etude = run(&format!("test {}", spec.name));
        let direct = run(spec.example);
        let worst = etude.diagnostics.iter().map(|d| d.severity).max();
        let allowed = match spec.idle() {
            None => Severity::Note,
            Some(_) => Severity::Warning,
        };
        assert!(
            worst <= Some(allowed),
            "{}: {:?}",
            spec.name,
            etude.diagnostics
        );
        let shapes = |compiled: &Compiled| {
            compiled
                .scene
                .elements
                .iter()
                .map(|e| e.shape.clone())
                .collect::<Vec<_>>()
        };
        // Those that would end or undo the run are only shown.
        if !matches!(spec.name, "quit" | "reset" | "shoot") {
            assert_eq!(shapes(&etude), shapes(&direct), "{}", spec.name);
        }
        for element in &etude.scene.elements {
            assert_eq!(
                (element.origin.file, element.origin.start),
                (0, 0),
                "{}",
                spec.name
            );
        }
        let said = run(&format!("man {}", spec.name)).diagnostics;
        assert!(
            said[0].message.starts_with(spec.name),
            "{}",
            said[0].message
        );
        assert!(said[0].message.contains(spec.meaning));
    }
}

/// A project may have files that are called like those of the library.
#[test]
fn a_file_called_like_one_of_the_library() {
    let text = "surface s diff Red\nsphereflake s, 1";
    let compiled = compile(&Project {
        files: vec![File {
            name: String::from("sphereflake.rat"),
            text: text.to_owned(),
        }],
    });
    assert_eq!(compiled.diagnostics, []);
    assert_eq!(compiled.scene.elements.len(), 10);
    // A command of the text's own hides the library's.
    let own =
        scene("surface s diff Red\ndefine sphereflake(n) { sphere s n 0 0 0 }\nsphereflake 2");
    assert_eq!(own.elements.len(), 1);
}

/// `+=` and `*=` change a variable with every frame.
#[test]
fn variables_change_with_every_frame() {
    let text = "surface s diff Red\nvar x = 1 += 0.5\nvar r = 2\nvar r *= 0.5\n\
        var P = 0 0 0 += 0 0 1\n\
        sphere s r x P.y P.z";
    let at = |frame| {
        let files = vec![File {
            name: String::from("main.rat"),
            text: text.to_owned(),
        }];
        let compiled = rats::compile_at(&Project { files }, &[], frame);
        assert!(compiled.animated);
        let shape = &compiled.scene.elements[0].shape;
        (shape.middle(), shape.radius())
    };
    assert_eq!(at(0.0), (v(1.0, 0.0, 0.0), 2.0));
    assert_eq!(at(4.0), (v(3.0, 0.0, 4.0), 0.125));
    // Between frames, too; before the first there is none.
    assert_eq!(at(0.5), (v(1.25, 0.0, 0.5), 2.0 * libm::sqrt(0.5)));
    assert_eq!(at(-1.0), at(0.0));
    assert_eq!(at(f64::NAN), at(0.0));
    assert!(!run("var x = 1").animated);
}

/// The body of each element, and the bodies' names.
fn bodies(text: &str) -> (Vec<u32>, Vec<String>) {
    let scene = scene(&format!("surface s diff Red, blob -1\n{text}"));
    let of_each = scene.elements.iter().map(|element| element.body);
    let names = scene.bodies.iter().map(|body| body.name.clone());
    (of_each.collect(), names.collect())
}

#[test]
fn bodies_hold_what_stands_in_them() {
    let (of_each, names) = bodies(
        "sphere s 1 0 0 0\nbody A\nsphere s 1 1 0 0\nobject ARM\nsphere s 1 2 0 0\nclose ARM\n\
         close A\n\
         sphere s 1 3 0 0\nobject O\nbody B\nsphere s 1 4 0 0\nclose\nsphere s 1 5 0 0\nclose O",
    );
    assert_eq!(of_each, [0, 1, 1, 0, 2, 0]);
    assert_eq!(names, ["", "A", "B"]);
    // Each turn of a loop makes one.
    let (of_each, names) =
        bodies("for i = 1 to 3 { body LEG\nsphere s 1 i 0 0\nclose }\nrotate 0 0 1 90 LEG");
    assert_eq!(of_each, [1, 2, 3]);
    assert_eq!(names, ["", "LEG", "LEG", "LEG"]);
}

#[test]
fn an_instance_of_a_body_is_a_new_body() {
    let (of_each, names) = bodies(
        "body A\nsphere s 1 1 0 0\nclose\ninstance A C\nobject O\ninstance A B\nsphere s 1 2 0 0\n\
         close\n\
         instance O P\nobject Q\nsphere s 1 3 0 0\nclose\nbody D\ninstance Q\nclose\ninstance Q R",
    );
    // The last `Q` means the copy in D.
    assert_eq!(of_each, [1, 2, 3, 0, 4, 0, 0, 5, 6]);
    assert_eq!(names, ["", "A", "C", "B", "B", "D", "R"]);
}

#[test]
fn files_of_meshes_are_asked_for_by_their_endings() {
    let names = ["a.obj", "b.PLY", "c.stl", "d.glb", "e.3mf"];
    let text = names.map(|name| format!("mesh s {name}\n")).concat();
    assert_eq!(rats::asset_names(&text), names);
}
