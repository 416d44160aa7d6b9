//! Skeletons of files: `skeleton sn, NAME file …`.

use field::THRESHOLD;
use glam::DVec3;
use rats::{Asset, Compiled, Project, Severity, compile_at};
use scene::curves::Clip;
use scene::{Curves, Element};
use std::sync::Arc;

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

/// The notes of a compilation about its file.
fn notes(compiled: &Compiled) -> Vec<String> {
    let told = messages(compiled).into_iter();
    let notes =
        told.filter(|(severity, message)| *severity == Severity::Note && message.starts_with("n."));
    notes.map(|(_, message)| message).collect()
}

/// Returns limbs of an OBJ file with radii: the ends of each, and its radius.
fn write_limbs(limbs: &[([DVec3; 2], f64)]) -> String {
    let mut text = String::from("# vt: radius\n");
    for ([a, b], radius) in limbs {
        for p in [a, b] {
            text += &format!("v {} {} {}\n", p.x, p.y, p.z);
        }
        text += &format!("vt {radius}\nl -2/-1 -1/-1\n");
    }
    text
}

/// Returns a text that draws limbs with a kernel of their material.
fn with_kernel(kernel: &str) -> String {
    format!("verbose on\nsurface u, diffuse Red {kernel}\nskeleton u, N n.obj")
}

/// Returns a limb, and a thicker one beside it at a distance.
fn write_beside(gap: f64) -> String {
    let shift = DVec3::Y * gap + DVec3::X;
    let limb = [DVec3::ZERO, DVec3::X * 20.0];
    write_limbs(&[(limb, 1.0), (limb.map(|p| p + shift), 3.0)])
}

#[test]
fn radii_that_cannot_be_kept_are_told() {
    let straight = write_limbs(&[([DVec3::ZERO, DVec3::X * 20.0], 1.0)]);
    for kernel in [
        "",
        "kernel gauss, blobbiness -1",
        "kernel cauchy, blobbiness -4",
    ] {
        assert!(
            notes(&compile(&with_kernel(kernel), "n.obj", &straight)).is_empty(),
            "{kernel}"
        );
    }
    // A limb of six radii is too short for a kernel that reaches far, which thins it.
    let short = write_limbs(&[([DVec3::ZERO, DVec3::X * 7.0], 1.0)]);
    let compiled = compile(
        &with_kernel("kernel cauchy, blobbiness -0.2"),
        "n.obj",
        &short,
    );
    let found = reach(&compiled, DVec3::X * 3.5, DVec3::Y, 4.0);
    let told = notes(&compiled);
    let wanted =
        format!("n.obj: at the middles of 1 of 1 long limbs the surface stands at {found:.2} of");
    assert!(told[0].starts_with(&wanted), "{told:?} {found}");
    assert!((found - 1.0).abs() > 0.05);
    // Another one beside it, whose flesh is thick there on one side only.
    assert!(notes(&compile(&with_kernel(""), "n.obj", &write_beside(4.5))).is_empty());
    // Within it.
    let told = notes(&compile(&with_kernel(""), "n.obj", &write_beside(0.5)));
    let wanted = "n.obj: 1 of 2 long limbs lie within others at their middles";
    assert!(told[0].starts_with(wanted), "{told:?}");
}

/// Whether a place is within a capsule whose radius varies evenly along it.
fn is_within([(a, r), (b, s)]: [(DVec3, f64); 2], place: DVec3) -> bool {
    let share = ((place - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    place.distance(a + (b - a) * share) <= r + (s - r) * share
}

#[test]
fn lattices_stand_at_their_radii_and_where_limbs_overlap_at_those_of_their_capsules() {
    let mut random = trials::Random::new(44);
    for _ in 0..trials::count(3) {
        // A jittered grid with diagonals that cross, as lattices for printing have.
        let mut nodes = Vec::new();
        for i in 0..27 {
            let cell = DVec3::new(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9));
            nodes.push(cell * 10.0 + random.vector(1.5));
        }
        let mut limbs = Vec::new();
        for _ in 0..60 {
            let [a, b] = [0, 1].map(|_| nodes[random.below(27)]);
            if a != b {
                limbs.push(([a, b], random.range(0.4, 1.1)));
            }
        }
        let compiled = compile("skeleton s, N n.obj", "n.obj", &write_limbs(&limbs));
        let surfaces = compiled.scene.surfaces();
        let function = surfaces[0].function();
        let drawn = self::limbs(&compiled);
        let (mut count, mut close) = (0, 0);
        for [(a, r), (b, s)] in &drawn {
            let radius = 0.5 * (r + s);
            if a.distance(*b) < 6.0 * r.max(*s) {
                continue;
            }
            let middle = 0.5 * (*a + *b);
            let (u, v) = (*b - *a).normalize().any_orthonormal_pair();
            // The surface over that of the capsules, both from the middle out.
            let mut ratios: Vec<f64> = (0..8)
                .map(|i| {
                    let (sine, cosine) = libm::sincos(f64::from(i) * std::f64::consts::FRAC_PI_4);
                    let way = u * cosine + v * sine;
                    let exact = (1..200)
                        .map(|i| f64::from(i) * 0.02)
                        .find(|t| {
                            let place = middle + way * (radius * t);
                            !drawn.iter().any(|limb| is_within(*limb, place))
                        })
                        .unwrap_or(4.0);
                    let soft = (1..200)
                        .map(|i| f64::from(i) * 0.02)
                        .find(|t| function.jet(middle + way * (radius * t)).value < THRESHOLD);
                    soft.unwrap_or(4.0) / exact
                })
                .collect();
            ratios.sort_by(f64::total_cmp);
            count += 1;
            close += i32::from((ratios[4] - 1.0).abs() < 0.05);
        }
        assert!(count > 20, "{count}");
        assert!(
            f64::from(close) >= 0.95 * f64::from(count),
            "{close} of {count}"
        );
    }
}

#[test]
fn every_format_is_drawn_at_its_radius() {
    let vtp = "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"2\"><PointData>\
        <DataArray type=\"Float32\" Name=\"Radius\">1 1</DataArray></PointData><Points>\
        <DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 20 0 0</DataArray></Points>\
        <Lines><DataArray type=\"Int64\" Name=\"connectivity\">0 1</DataArray>\
        <DataArray type=\"Int64\" Name=\"offsets\">2</DataArray></Lines></Piece></PolyData>\
        </VTKFile>";
    let vtk = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n\
        0 0 0 20 0 0\nLINES 1 3\n2 0 1\nPOINT_DATA 2\nSCALARS radius float 1\n\
        LOOKUP_TABLE default\n1 1\n";
    let csv = "start_x,start_y,start_z,end_x,end_y,end_z,radius\n0,0,0,20,0,0,1\n";
    let ply = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
        property float z\nproperty float radius\nelement edge 1\nproperty int vertex1\n\
        property int vertex2\nend_header\n0 0 0 1\n20 0 0 1\n0 1\n";
    for (name, content) in [
        ("n.swc", LIMB),
        ("n.vtp", vtp),
        ("n.vtk", vtk),
        ("n.csv", csv),
        (
            "n.obj",
            "# vt: radius\nv 0 0 0\nv 20 0 0\nvt 1\nl 1/1 2/1\n",
        ),
        ("n.ply", ply),
    ] {
        let compiled = compile(&format!("skeleton s, N {name}"), name, content);
        assert_eq!(messages(&compiled), [], "{name}");
        for (from, way, wanted) in [
            (DVec3::X * 10.0, DVec3::Y, 1.0),
            (DVec3::X * 10.0, DVec3::X, 11.0),
            (DVec3::X * 10.0, -DVec3::X, 11.0),
        ] {
            let found = reach(&compiled, from, way, 30.0);
            assert!((found - wanted).abs() < 0.02, "{name}: {found}");
        }
    }
    // Molecules: balls of the van der Waals radii, and bonds between them.
    let water = "3\n\nO 0 0 0.1173\nH 0 0.7572 -0.4692\nH 0 -0.7572 -0.4692\n";
    let atom = "HETATM    1  O   HOH A   1       0.000   0.000   0.000  1.00  0.00           O\n";
    for (name, content, balls, sticks) in [("n.xyz", water, 3, 2), ("n.pdb", atom, 1, 0)] {
        let compiled = compile(&format!("skeleton s, N {name} bonds"), name, content);
        let elements = compiled.scene.elements.iter();
        let radii = elements.filter(|own| own.shape.curves().is_none());
        let radii: Vec<f64> = radii.map(|own| compiled.scene.radius(own)).collect();
        assert_eq!((radii.len(), radii[0]), (balls, 1.52), "{name}");
        assert_eq!(limbs(&compiled).len(), sticks, "{name}");
    }
}

#[test]
fn odd_limbs_are_no_matter() {
    for content in [
        "1 3 0 0 0 1e-300 -1\n2 3 1e-299 0 0 1e-300 1\n",
        "1 3 0 0 0 1e12 -1\n2 3 1e12 0 0 1e12 1\n",
        "1 3 0 0 0 1e-9 -1\n2 3 1e9 0 0 1e-9 1\n",
        "1 3 0 0 0 1 -1\n2 3 1e-12 0 0 1 1\n3 3 1e-12 1e-13 0 5 2\n",
        "1 3 0 0 0 1 -1\n2 3 9 0 0 0 1\n3 3 9 9 0 -4 2\n",
        "1 3 0 0 0 1 -1\n2 3 9 0 0 1 3\n3 3 9 9 0 1 2\n",
    ] {
        for text in [
            "",
            "subdivide 3",
            "ends flat",
            "local 3",
            "thicken -0.5",
            "scale 1e9",
        ] {
            let compiled = compile(&format!("skeleton s, N n.swc {text}"), "n.swc", content);
            // It is drawn, or it is said why not.
            let elements = compiled.scene.elements.len();
            assert!(
                elements > 0 || !messages(&compiled).is_empty(),
                "{text}: {content}"
            );
            let surfaces = compiled.scene.surfaces();
            for surface in &surfaces {
                assert!(!surface.function().jet(DVec3::ONE).value.is_infinite());
            }
        }
    }
}

#[test]
fn what_a_mesh_leaves_out_is_told() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    assert_eq!(messages(&compile("mesh s n.obj", "n.obj", square)), []);
    let text = format!("{square}f 1 1 2\nf 3 1 2\n");
    let compiled = compile("mesh s n.obj", "n.obj", &text);
    assert_eq!(compiled.scene.elements.len(), 2);
    let (severity, message) = &messages(&compiled)[0];
    assert_eq!(*severity, Severity::Warning);
    assert!(message.contains("without an area"), "{message}");
    assert!(message.contains("that are there twice"), "{message}");
}

/// Returns the value of a surface's function at a place.
fn value(surface: &scene::Surface, place: DVec3) -> f64 {
    surface.function().jet(place).value
}

#[test]
fn flat_ends_are_planes() {
    // A bent line with a branch: three free ends.
    let bent = "1 3 0 0 0 1 -1\n2 3 10 0 0 1 1\n3 3 18 6 0 .8 2\n4 3 10 -9 0 .6 2\n";
    for kernel in [
        "",
        "kernel gauss, blobbiness -4",
        "kernel cauchy, blobbiness -2",
    ] {
        let text = format!("surface u, diffuse Red {kernel}\nskeleton u, N n.swc ends");
        let flat = compile(&format!("{text} flat"), "n.swc", bent);
        let round = compile(&format!("{text} round"), "n.swc", bent);
        assert_eq!(messages(&flat), [], "{kernel}");
        let [flat, round] = [&flat, &round].map(|own| own.scene.surfaces().swap_remove(0));
        let ends = [
            (DVec3::ZERO, DVec3::NEG_X, 1.0),
            (DVec3::new(18.0, 6.0, 0.0), DVec3::new(0.8, 0.6, 0.0), 0.8),
            (DVec3::new(10.0, -9.0, 0.0), DVec3::NEG_Y, 0.6),
        ];
        for (at, outward, radius) in ends {
            let (u, v) = outward.any_orthonormal_pair();
            for i in 0..24 {
                let (sine, cosine) = libm::sincos(f64::from(i) * 1.7);
                let across = (u * cosine + v * sine) * (radius * f64::from(i) / 24.0);
                let place = at + across;
                // Inside up to the plane over the whole disk, and nothing behind it.
                if across.length() < 0.93 * radius {
                    assert!(
                        value(&flat, place - outward * (0.02 * radius)) > THRESHOLD,
                        "{i}"
                    );
                }
                for step in [0.02, 0.5, 1.2, 3.0] {
                    let behind = value(&flat, place + outward * (step * radius));
                    assert!(behind < THRESHOLD, "{kernel} {i} {step}: {behind}");
                }
            }
        }
        // Elsewhere both are the same.
        for place in [
            DVec3::new(5.0, 0.9, 0.1),
            DVec3::new(10.0, 0.2, 0.9),
            DVec3::new(13.0, 2.0, 0.8),
        ] {
            let [a, b] = [&flat, &round].map(|surface| value(surface, place));
            assert!(
                (a - b).abs() < 2e-3 * b.max(1.0),
                "{kernel} {place}: {a} {b}"
            );
        }
    }
    // A single limb is cut at both ends, and each of its pieces counts once.
    let compiled = compile("skeleton s, N n.swc ends flat", "n.swc", LIMB);
    let surface = compiled.scene.surfaces().swap_remove(0);
    assert!(matches!(surface, scene::Surface::Composed(_)));
    for (x, is_inside) in [
        (-0.02, false),
        (0.02, true),
        (10.0, true),
        (19.98, true),
        (20.02, false),
    ] {
        let inside = surface.function().jet(DVec3::X * x).value > THRESHOLD;
        assert_eq!(inside, is_inside, "{x}");
    }
    let side = reach(&compiled, DVec3::X * 10.0, DVec3::Y, 4.0);
    assert!((side - 1.0).abs() < 1e-3, "{side}");
    // Too many are round, in words.
    let many: String = (0..300)
        .map(|i| {
            format!(
                "{} 3 {i} 0 0 .2 -1\n{} 3 {i} 3 0 .2 {}\n",
                2 * i + 1,
                2 * i + 2,
                2 * i + 1
            )
        })
        .collect();
    let compiled = compile("verbose on\nskeleton s, N n.swc ends flat", "n.swc", &many);
    assert!(
        notes(&compiled)[0].contains("600 flat ends are round"),
        "{:?}",
        notes(&compiled)
    );
}

/// A 3MF package of lattices, given by their attributes, which all have one beam; object 1 is a
/// tetrahedron of the side 9, object 9 a copy of it at another place.
fn lattices(attributes: &[&str]) -> Vec<u8> {
    let mut objects = String::from(
        "<object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"9\" y=\"0\" \
         z=\"0\"/><vertex x=\"0\" y=\"9\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"9\"/></vertices>\
         <triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/>\
         <triangle v1=\"0\" v2=\"3\" v3=\"2\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles>\
         </mesh></object><object id=\"9\"><components><component objectid=\"1\" \
         transform=\"1 0 0 0 1 0 0 0 1 2 0 0\"/></components></object>",
    );
    let mut items = String::new();
    for (own, id) in attributes.iter().zip(2..) {
        objects += &format!(
            "<object id=\"{id}\"><mesh><vertices><vertex x=\"{id}\" y=\"1\" z=\"-20\"/><vertex \
             x=\"{id}\" y=\"1\" z=\"20\"/></vertices><b:beamlattice radius=\"0.5\" \
             minlength=\"0.01\" {own}><b:beams><b:beam v1=\"0\" v2=\"1\"/></b:beams>\
             </b:beamlattice></mesh></object>"
        );
        items += &format!("<item objectid=\"{id}\"/>");
    }
    let model = format!(
        "<model unit=\"millimeter\" \
         xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
         xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\">\
         <resources>{objects}</resources><build>{items}</build></model>"
    );
    let relations = "<Relationships><Relationship Target=\"/3D/x.model\" Id=\"a\" \
        Type=\"http://x/3dmodel\"/></Relationships>";
    let members = [("_rels/.rels", relations), ("3D/x.model", &model)];
    let members = members.map(|(name, text)| archive::Member::new(name, text.as_bytes()));
    archive::write(&members).unwrap()
}

#[test]
fn clips_of_lattices_are_kept_for_meshes() {
    fn read(attributes: &[&str], text: &str) -> Compiled {
        let asset = Asset::new("n.3mf", &lattices(attributes)[..]);
        let text = format!("verbose off\neyep 0 0 90\nsurface s, diffuse Red\n{text}");
        compile_at(&Project::single(text), &[asset], 0.0)
    }
    fn clip(compiled: &Compiled) -> Option<Arc<Clip>> {
        let elements = compiled.scene.elements.iter();
        let mut clips = elements.filter_map(|own| own.shape.curves()?.clip.clone());
        clips.next()
    }
    let inside = "clippingmode=\"inside\" clippingmesh=\"1\"";
    let outside = "clipping=\"outside\" clippingmesh=\"1\"";
    for (own, is_inside) in [(inside, true), (outside, false)] {
        let compiled = read(&[own, own], "skeleton s, N n.3mf scale 2");
        let clip = clip(&compiled).expect("a clip");
        assert_eq!((clip.is_inside, clip.meshes.len()), (is_inside, 1));
        let (positions, triangles) = &clip.meshes[0];
        assert_eq!((positions[1], triangles.len()), (DVec3::X * 18.0, 4));
        assert_eq!(messages(&compiled).len(), 1);
        assert!(
            messages(&compiled)[0]
                .1
                .ends_with("2 lattices have a mesh that clips them, which pictures leave out")
        );
    }
    for (own, why) in [
        ([inside, ""], "only some of its limbs are"),
        ([inside, outside], "some limbs are kept inside"),
        (
            [inside, "clippingmode=\"inside\" clippingmesh=\"9\""],
            "limbs are clipped by different meshes",
        ),
    ] {
        let compiled = read(&own, "skeleton s, N n.3mf");
        assert_eq!(clip(&compiled), None);
        let told = messages(&compiled);
        assert!(told.iter().any(|(_, text)| text.contains(why)), "{told:?}");
    }
    let compiled = read(&["", ""], "skeleton s, N n.3mf");
    assert_eq!((clip(&compiled), messages(&compiled)), (None, Vec::new()));
}
