//! Soft shapes of a depth of their own, stretched, and of strengths that textures say.

use crate::softened::{read, scene, value};
use field::THRESHOLD;
use glam::DVec3;
use rats::Severity;
use scene::Shape;

/// An element's depth is read as its material's would be.
#[test]
fn a_shape_has_a_depth_of_its_own() {
    for (shape, own) in [
        ("sphere S 9 <0 0 0>", " depth 2"),
        ("dot S <0 0 0>", " depth 2"),
        ("cylinder S 9 <-1 0 0> <1 0 0>", ", depth 2"),
        ("line S <-1 0 0> <1 0 0>", " depth 2"),
        ("arc S 3 9 <0 0 0> <0 0 1> 0 90", " depth 2"),
        ("curve S 9 <0 0 0> <1 1 0> <2 -1 0> <3 0 0>", " depth 2"),
    ] {
        let material = "blobbiness -2 kernel quartic";
        let by_shape = read(&format!("surface S radius 1 {material}\n{shape}{own}\n")).scene;
        let by_material = read(&format!(
            "fragile all\nsurface S depth 2 {material}\n{shape}\n"
        ));
        let [a, b] = [&by_shape, &by_material.scene].map(|scene| {
            let element = &scene.elements[0];
            scene.radius(element)
        });
        assert!((a - b).abs() < 1e-12 && a > 0.5, "{shape}: {a} {b}");
    }
    // Lengths grow with the object.
    let text =
        "surface S blobbiness -2 kernel quartic\nobject A\nsphere S 1 <0 0 0> depth 2\nclose\n";
    let [one, three] = [text, &format!("{text}scale 3 3 3\n")].map(|text| {
        let scene = scene(text);
        scene.radius(&scene.elements[0])
    });
    assert!((three - 3.0 * one).abs() < 1e-12, "{one} {three}");
    let hard = read("surface S diffuse Red\nsphere S 1 <0 0 0> depth 2\n");
    assert_eq!(hard.diagnostics.len(), 1);
    assert_eq!(hard.diagnostics[0].severity, Severity::Warning);
}

/// Balls become ellipsoids, wherever they stand.
#[test]
fn balls_can_be_stretched() {
    let ways = [DVec3::X * 2.0, DVec3::Y, DVec3::Z * 3.0];
    for (material, kernel) in [
        ("radius 0.5 blobbiness -1", "cauchy"),
        ("radius 0.5 blobbiness -3", "gauss"),
        ("radius 0.5 blobbiness -2 strength 2", "quartic"),
    ] {
        let text = format!(
            "surface S {material} kernel {kernel}\nobject A\nsphere S 0.5 <1 0 0>\nclose\n\
             scale 2 1 3\nrotate 0 0 1 90\n"
        );
        let scene = scene(&text);
        let strong = material.contains("strength");
        for way in ways {
            let turned = DVec3::new(-way.y, way.x, way.z);
            let value = value(&scene, DVec3::Y * 2.0 + turned * 0.5);
            let wanted = if strong { 2.0 } else { 1.0 } * THRESHOLD;
            assert!((value - wanted).abs() < 1e-9, "{text}{way}: {value}");
        }
    }
    let hard = scene("surface S diffuse Red\nsphere S 0.5 <1 0 0>\nscale 2 1 3\n");
    let Shape::Quadric(quadric) = &hard.elements[0].shape else {
        panic!("{:?}", hard.elements[0].shape);
    };
    assert_eq!(quadric.center, DVec3::X * 2.0);
    assert_eq!(quadric.axes, [DVec3::X, DVec3::Y * 0.5, DVec3::Z * 1.5]);
    let even =
        scene("surface S diffuse Red\nsphere S 0.5 <1 0 0>\nscale 2 -2 2\nrotate 1 2 3 40\n");
    assert_eq!(even.elements[0].shape.radius(), 1.0);
    // It fades at its surface as its kernel does.
    let ball = scene("surface S radius 0.5 blobbiness -1\nsphere S 0.5 <0 0 0>\n");
    let flat =
        scene("surface S radius 0.5 blobbiness -1\nsphere S 0.5 <0 0 0>\nscale 1 1 0.999999\n");
    let [a, b] =
        [&ball, &flat].map(|scene| scene.surfaces()[0].function().jet(DVec3::X * 0.5).gradient[0]);
    assert!((a - b).abs() < 1e-4, "{a} {b}");
    let tube = read("surface S diffuse Red\ncylinder S 0.5 <0 0 0> <1 0 0>\nscale 2 1 3\n");
    assert_eq!(tube.diagnostics.len(), 1, "{:?}", tube.diagnostics);
}

/// A solid says the strength of pieces: a checker's light fields stay, its dark ones vanish.
#[test]
fn solids_and_images_say_strengths() {
    let text = "texture T strength checker scale 0.5 0.5 0.5\n\
        surface S radius 0.3 blobbiness -8 texture T\ncylinder S 0.3 <-8 0.1 0.1> <8 0.1 0.1>\n";
    let checked = scene(text);
    assert_eq!(checked.elements.len(), 64);
    let fields = [1.0, 3.0, 5.0, 7.0].map(|x| value(&checked, DVec3::new(x, 0.1, 0.1)));
    let first = fields[0];
    let fields = fields.map(|field| field > THRESHOLD);
    assert_eq!(
        fields,
        [fields[0], !fields[0], fields[0], !fields[0]],
        "{fields:?}"
    );
    // Turned with its object.
    let turned = scene(&format!("{text}rotate 0 0 1 90\n"));
    let place = DVec3::new(-0.1, 1.0, 0.1);
    assert!((value(&turned, place) - first).abs() < 1e-9);
    // The image `hills.png`, along and around; and a point and a triangle.
    for (method, shape, count) in [
        ("hills.png plain", "cylinder S 0.3 <-8 0 0> <8 0 0>", 64),
        ("marble", "triangle S <-2 -2 0> <2 -2 0> <0 2 0>", 64),
        ("marble", "sphere S 0.3 <0 0 0>", 1),
        ("granite", "arc S 2 0.3 <0 0 0> <0 0 1> 0 90", 64),
    ] {
        let text = format!(
            "texture T strength {method} bounds <0.5 0.5 0.5> <1 1 1>\n\
             surface S radius 0.3 blobbiness -2 texture T\n{shape}\n"
        );
        let scene = std::sync::Arc::unwrap_or_clone(read(&text).scene);
        assert_eq!(scene.elements.len(), count, "{text}");
        let strengths = scene.elements.iter().filter_map(|element| element.flesh);
        let strengths = strengths.map(|index| scene.flesh[index as usize].strength);
        let strengths: Vec<f64> = strengths.collect();
        assert!(
            strengths.iter().all(|s| (0.5..=1.0).contains(s)),
            "{strengths:?}"
        );
        let differ = strengths.iter().any(|s| *s != strengths[0]);
        assert_eq!(differ, count > 1, "{text}");
    }
    // A dark place of an image is no mistake.
    scene(
        "texture T strength hills.png plain\nsurface S radius 0.3 blobbiness -4 texture T\n\
         triangle S <-2 -2 0> <2 -2 0> <0 2 0>\n",
    );
    let curve = read(
        "texture T strength marble\nsurface S radius 0.3 blobbiness -2 texture T\n\
         curve S 0.3 <0 0 0> <1 1 0> <2 -1 0> <3 0 0>\n",
    );
    assert_eq!(curve.diagnostics.len(), 1, "{:?}", curve.diagnostics);
}

/// Bones whose pieces would not be like the whole stay whole.
#[test]
fn tapers_and_flat_ends_have_no_patterns() {
    for shape in [
        "cone S 0.5 <-4 0 0> 0.2 <4 0 0>",
        "cylinder S 0.3 <-4 0 0> <4 0 0> ends flat",
    ] {
        let told = read(&format!(
            "texture T strength marble\nsurface S radius 0.3 blobbiness -2 texture T\n{shape}\n"
        ));
        assert_eq!(told.scene.elements.len(), 1, "{shape}");
        let [note] = &told.diagnostics[..] else {
            panic!("{shape}: {:?}", told.diagnostics);
        };
        assert!(note.message.contains("stays as it is"), "{}", note.message);
    }
}

/// Pieces of patterns count where pictures hold too much together.
#[test]
fn many_pictures_of_patterns_are_refused() {
    let text = "texture T strength granite\nsurface S radius 0.3 blobbiness -2 texture T\n\
        for i = 1 to 320 { cylinder S 0.3 <i 0 0> <i 1 0> }\n"
        .to_owned()
        + &"shoot\n".repeat(25);
    let many = read(&text);
    let said = many
        .diagnostics
        .iter()
        .any(|told| told.message.starts_with("the pictures hold"));
    assert!(said, "{:?}", many.diagnostics);
}

/// A soft mesh with `soft off` is two sheets at its radius, closed along the rim, in place of a
/// prism for each facet.
#[test]
fn offset_surfaces_of_meshes_are_sheets() {
    let text = "surface S radius 0.1 blobbiness -8\nterra S hills.png <-3 -3 0> <3 3 1.5>\n";
    let soft = scene(text);
    let hard = scene(&format!("soft off\n{text}"));
    let facets = soft.elements.len();
    assert!(hard.elements.len() > 2 * facets && hard.elements.len() < 3 * facets);
    // No corner is farther from the facets than the radius, and none of the sheets is nearer than
    // what steep slopes make of it.
    let [facets, sheets] = [&soft, &hard].map(|scene| -> Vec<DVec3> {
        let bones = scene.elements.iter();
        let bones = bones.filter_map(|element| element.shape.skeleton());
        bones.flat_map(field::Skeleton::samples).collect()
    });
    for sheet in sheets.iter().step_by(97) {
        let distances = facets.iter().map(|corner| corner.distance(*sheet));
        let nearest = distances.fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.1001, "{sheet}: {nearest}");
    }
    for element in &hard.elements {
        assert_eq!(hard.radius(element), 0.0);
    }
    // Each edge belongs to two triangles: nothing is open.
    let mut edges = std::collections::HashMap::new();
    for element in &hard.elements {
        let Some(field::Skeleton::Triangle { corners }) = element.shape.skeleton() else {
            panic!("{:?}", element.shape);
        };
        for i in 0..3 {
            let ends = [corners[i], corners[(i + 1) % 3]];
            let mut ends = ends.map(|end| end.to_array().map(f64::to_bits));
            ends.sort_unstable();
            *edges.entry(ends).or_insert(0) += 1;
        }
    }
    assert!(edges.values().all(|count| *count == 2));
    // Triangles by themselves are prisms, as before.
    let prism =
        scene("soft off\nsurface S radius 0.1 blobbiness -8\ntriangle S <0 0 0> <1 0 0> <0 1 0>\n");
    assert_eq!(prism.radius(&prism.elements[0]), 0.1);
}
