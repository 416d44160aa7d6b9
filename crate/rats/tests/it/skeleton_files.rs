//! Skeletons of files: `skeleton sn, NAME file …`.

use field::THRESHOLD;
use glam::DVec3;
use rats::{Asset, Compiled, Project, Severity, compile_at};
use scene::{Curves, Element};

/// A soma, two trunks, one of which branches; ids out of order, a blank line, tabs.
const TINY: &str = "# tiny\n1 1 0 0 0 5 -1\n3 3 0 20 0 1.0 2\n2 3 0 8 0 1.5 1\n\n\
    4\t3 6 30 0 0.8 3 \n5 3 -6 30 0 0.6 3\n6 2 0 -8 0 1.0 1\n7 2 0 -30 0 0.5 6\n";
/// A straight limb of radius 1.
const LIMB: &str = "1 3 0 0 0 1 -1\n2 3 20 0 0 1 1\n";

/// Compiles a text behind a material `s` with a file of its.
fn compile(text: &str, name: &str, content: &str) -> Compiled {
    let asset = Asset::new(name, content.as_bytes());
    let text = format!(
        "verbose off\neyep 0 0 900\nsurface s, diffuse Red\nsurface t, diffuse Blue\n{text}"
    );
    compile_at(&Project::single(text), &[asset], 0.0)
}

/// The messages of a compilation, with their severities.
fn messages(compiled: &Compiled) -> Vec<(Severity, String)> {
    let told = compiled.diagnostics.iter();
    told.map(|told| (told.severity, told.message.clone()))
        .collect()
}

/// The limbs of a compiled text: places and radii.
fn limbs(compiled: &Compiled) -> Vec<[(DVec3, f64); 2]> {
    let elements = compiled.scene.elements.iter();
    let curves = elements.filter_map(|own| own.shape.curves());
    curves.flat_map(Curves::pieces).collect()
}

/// The distance from a place at which a ray leaves the surface, by bisection up to `most`.
fn reach(compiled: &Compiled, from: DVec3, way: DVec3, most: f64) -> f64 {
    let surfaces = compiled.scene.surfaces();
    let function = surfaces[0].function();
    let is_inside = |t: f64| function.jet(from + way * t).value >= THRESHOLD;
    assert!(is_inside(0.0) && !is_inside(most));
    let (mut low, mut high) = (0.0, most);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        match is_inside(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    low
}

#[test]
fn neuron_stands_at_its_radii() {
    let compiled = compile("skeleton s, N n.swc", "n.swc", TINY);
    assert_eq!(messages(&compiled), []);
    assert_eq!(limbs(&compiled).len(), 6);
    let balls: Vec<&Element> = (compiled.scene.elements.iter())
        .filter(|own| own.shape.curves().is_none())
        .collect();
    assert_eq!(balls.len(), 1, "the soma");
    assert_eq!(compiled.scene.radius(balls[0]), 5.0);
    // At the middles of long limbs.
    for (place, radius) in [
        (DVec3::new(0.0, 14.0, 0.0), 1.25),
        (DVec3::new(0.0, -19.0, 0.0), 0.75),
    ] {
        let found = reach(&compiled, place, DVec3::Z, 4.0);
        assert!((found / radius - 1.0).abs() < 0.05, "{found} for {radius}");
    }
}

#[test]
fn free_ends_reach_their_radius_beyond_or_end_at_their_node() {
    for (ends, beyond) in [("", 1.0), ("ends round", 1.0), ("ends flat", 0.0)] {
        for kernel in [
            "",
            "kernel cauchy, blobbiness -2",
            "kernel gauss, blobbiness -4",
        ] {
            let text = format!("surface u, diffuse Red {kernel}\nskeleton u, N n.swc {ends}");
            let compiled = compile(&text, "n.swc", LIMB);
            let found = reach(&compiled, DVec3::X * 10.0, DVec3::X, 30.0) - 10.0;
            assert!((found - beyond).abs() < 0.01, "{ends}, {kernel}: {found}");
        }
    }
}

#[test]
fn eight_struts_at_a_node_stay_slender() {
    let mut struts = String::from("v 0 0 0\n");
    for i in 0..8 {
        let [x, y, z] = [0, 1, 2].map(|k| if i >> k & 1 == 0 { -2 } else { 2 });
        struts += &format!("v {x} {y} {z}\nl 1 {}\n", i + 2);
    }
    let text = "surface u, diffuse Red, radius 0.1\nskeleton u, N n.obj";
    let compiled = compile(text, "n.obj", &struts);
    assert_eq!(limbs(&compiled).len(), 8);
    for way in DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
        let found = reach(&compiled, DVec3::ZERO, way, 1.0) / 0.1;
        assert!(found < 1.3, "{found}");
    }
}

#[test]
fn lines_of_other_programs_are_limbs() {
    let edges = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
        property float z\nproperty float radius\nelement edge 2\nproperty int vertex1\n\
        property int vertex2\nend_header\n0 0 0 .1\n1 0 0 .1\n1 1 0 .1\n0 1\n1 2\n";
    let compiled = compile("skeleton s, N n.ply", "n.ply", edges);
    assert_eq!(limbs(&compiled).len(), 2);
    let lines = "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\np 1\n";
    let compiled = compile("skeleton s, N n.obj", "n.obj", lines);
    let (severity, message) = &messages(&compiled)[0];
    assert_eq!(*severity, Severity::Error);
    assert!(message.contains("no radii"), "{message}");
    let hint = compiled.diagnostics[0].hint.as_deref();
    assert!(hint.is_some_and(|hint| hint.contains("radius NAME")));
    let text = "surface u, diffuse Red, radius 0.2\nskeleton u, N n.obj scale 10";
    let compiled = compile(text, "n.obj", lines);
    assert_eq!(limbs(&compiled).len(), 2);
    let ends = limbs(&compiled).into_iter().flatten();
    assert!(
        ends.into_iter().all(|(_, radius)| radius == 0.2),
        "not scaled"
    );
}

#[test]
fn options_change_lengths_materials_and_limbs() {
    let text = "skeleton s, N n.swc scale 2 thicken 0.5 materials dendrite t, axon s";
    let compiled = compile(text, "n.swc", TINY);
    assert_eq!(messages(&compiled), []);
    let finishes: Vec<u32> = (compiled.scene.elements.iter())
        .map(|own| own.finish)
        .collect();
    assert_eq!(finishes.len(), 3, "axon and soma of s, dendrites of t");
    let thickest = limbs(&compiled).into_iter().flatten();
    let thickest = thickest.map(|(_, radius)| radius).fold(0.0, f64::max);
    assert!((thickest - 3.5).abs() < 1e-12, "{thickest}");
    let compiled = compile("skeleton s, N n.swc materials dentrite t", "n.swc", TINY);
    let told = &compiled.diagnostics[0];
    assert_eq!(told.severity, Severity::Warning);
    assert_eq!(told.hint.as_deref(), Some("did you mean `dendrite`?"));
    let compiled = compile("skeleton s, N n.swc subdivide 2", "n.swc", TINY);
    assert_eq!(limbs(&compiled).len(), 24);
    let bent = "1 3 0 0 0 1 -1\n2 3 5 0.01 0 1 1\n3 3 10 0 0 1 2\n";
    let compiled = compile("skeleton s, N n.swc scale 10 simplify 0.2", "n.swc", bent);
    assert_eq!(limbs(&compiled).len(), 1);
}

#[test]
fn skeleton_of_a_file_is_an_object() {
    let text = "skeleton s, N n.swc\ntranslate 1 2 3, N\ninstance N, M\nbody B\n\
        skeleton s, O n.swc local 8\nclose";
    let compiled = compile(text, "n.swc", LIMB);
    assert_eq!(messages(&compiled), []);
    assert_eq!(compiled.scene.elements.len(), 3);
    assert_eq!(compiled.scene.surfaces().len(), 2);
    let thin = compile("skeleton s, N n.swc local 0.8", "n.swc", LIMB);
    let (severity, message) = &messages(&thin)[0];
    assert_eq!(*severity, Severity::Warning);
    assert!(message.ends_with("thinner than that"), "{message}");
}

#[test]
fn what_is_wrong_with_a_file_is_said_with_its_line() {
    let text = "skeleton s, N n.swc";
    let told = |content: &str| messages(&compile(text, "n.swc", content));
    let (severity, message) = &told("1 3 0 0 0 1 -1\n2 3 a 0 0 1 1\n")[0];
    assert_eq!(*severity, Severity::Error);
    assert!(
        message.starts_with("n.swc: line 2: `x` is `a`"),
        "{message}"
    );
    let (severity, message) = &told(&format!("{LIMB}2 3 20 0 0 1 1\n"))[0];
    assert_eq!(*severity, Severity::Warning);
    assert!(
        message.starts_with("n.swc: line 3: node 2 stands"),
        "{message}"
    );
    let many: String = (0..40).map(|_| "1 3 0 0 0 1 -1\n").collect();
    let (_, message) = &told(&format!("{many}2 3 1 0 0 1 1\n"))[0];
    assert!(message.ends_with("and 31 more"), "{message}");
    let message = &messages(&compile("skeleton s, N m.swc", "n.swc", LIMB))[0].1;
    assert!(message.contains("`m.swc`"), "{message}");
    let face = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let message = &messages(&compile("skeleton s, N n.obj", "n.obj", face))[0].1;
    assert!(message.contains("no limbs"), "{message}");
}

#[test]
fn skeleton_that_was_read_elsewhere_is_used() {
    let asset = Asset::await_mesh("n.swc", *b"broken");
    let project = Project::single("surface s, diffuse Red\nskeleton s, N n.swc simplify 0.1");
    let recipe = limbs::Recipe {
        simplify: Some(0.1),
        ..limbs::Recipe::default()
    };
    let assets = [asset];
    let compiled = compile_at(&project, &assets, 0.0);
    let wanted = compiled.unread.first().expect("it is not read yet");
    assert_eq!((wanted.name.as_str(), &wanted.recipe), ("n.swc", &recipe));
    let graph = recipe.make("n.swc", LIMB.as_bytes()).expect("a limb");
    assets[0].keep_skeleton(recipe.clone(), Ok(graph));
    let compiled = compile_at(&project, &assets, 0.0);
    assert!(compiled.unread.is_empty());
    assert_eq!(limbs(&compiled).len(), 1);
    assets[0].keep_skeleton(recipe, Err(String::from("on purpose")));
    let compiled = compile_at(&project, &assets, 0.0);
    assert!(compiled.diagnostics[0].message.ends_with("on purpose"));
}

#[test]
fn words_of_a_block_do_not_count_as_operands() {
    let mut block = String::from("skeleton s, N subdivide 0 {\n");
    for i in 0..=3000 {
        block += &format!("node n{i} <{i} 0 0> radius 0.5\n");
    }
    block += "curve";
    for i in 0..=3000 {
        block += &format!(" n{i}");
    }
    let compiled = compile(&(block + "\n}"), "n.swc", "");
    assert_eq!(messages(&compiled), []);
    assert_eq!(limbs(&compiled).len(), 3000);
}

#[test]
fn skeletons_of_files_are_counted() {
    let mut text = String::new();
    for i in 0..=20 {
        text += &format!("skeleton s, N{i} n.swc simplify {i}\n");
    }
    let told = messages(&compile(&text, "n.swc", LIMB));
    assert_eq!(told.len(), 1);
    assert!(told[0].1.contains("more than 20 skeletons"), "{told:?}");
    // The same one again and again is one.
    let text: String = (0..30)
        .map(|i| format!("skeleton s, N{i} n.swc\n"))
        .collect();
    let compiled = compile(&text, "n.swc", LIMB);
    assert_eq!(compiled.scene.elements.len(), 30);
}
