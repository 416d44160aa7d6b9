//! Deformed meshes and their implicit surfaces.

use field::THRESHOLD;
use glam::DVec3;
use rats::{Compiled, File, Project, Severity, compile};
use scene::{Form, Shape};

fn run(text: &str) -> Compiled {
    let compiled = compile(&Project {
        files: vec![File {
            name: String::from("main.rat"),
            text: format!("surface s, diffuse Red\n{text}"),
        }],
    });
    let said = compiled.diagnostics.iter();
    let complaint = said
        .filter(|d| d.severity > Severity::Note)
        .find(|d| !d.message.contains("picture"));
    assert_eq!(complaint, None, "{text}");
    compiled
}

fn corners(compiled: &Compiled) -> Vec<DVec3> {
    let shapes = compiled.scene.elements.iter().map(|element| &element.shape);
    shapes
        .flat_map(|shape| match shape {
            Shape::Bone(bone) => bone
                .skeleton
                .landmarks()
                .iter()
                .map(|l| l.0)
                .collect::<Vec<_>>(),
            Shape::Function(function) => match &function.form {
                Form::Mesh(mesh) => mesh
                    .positions
                    .iter()
                    .map(|p| function.to_world.transform_point3(*p))
                    .collect(),
                other => panic!("{other:?}"),
            },
            other => panic!("{other:?}"),
        })
        .collect()
}

const TIP: DVec3 = DVec3::new(0.0, 0.0, -1.2);

#[test]
fn vertex_on_a_control_moves_with_it() {
    let plain = corners(&run("mesh s gem.obj"));
    let text = "mesh s gem.obj\ndeform { control <0 0 -1.2> move <0.5 0 0>\n  control 0 0 0.65 }";
    let bent = corners(&run(text));
    assert_eq!(plain.len(), bent.len());
    for (before, after) in plain.iter().zip(&bent) {
        let way = *after - *before;
        assert!(way.x >= 0.0 && way.x <= 0.5 && way.y == 0.0 && way.z == 0.0);
        if before.distance(TIP) < 1e-12 {
            assert_eq!(*after, TIP + DVec3::X * 0.5);
        }
        if before.distance(DVec3::Z * 0.65) < 1e-12 {
            assert_eq!(after, before);
        }
    }
}

#[test]
fn coordinates_are_the_worlds_at_the_command() {
    let text = "mesh s gem.obj\nscale 2 2 2\ntranslate 5 0 0\n\
        deform { control <5 0 -2.4> move <0 1 0> }\ntranslate 0 0 1";
    let tip = DVec3::new(5.0, 1.0, -1.4);
    assert!(corners(&run(text)).iter().any(|p| p.distance(tip) < 1e-12));
    // The same of the implicit surface.
    let soft = text.replacen("gem.obj", "gem.obj metaballs triangular 0.05 30", 1);
    assert!(corners(&run(&soft)).iter().any(|p| p.distance(tip) < 1e-12));
}

#[test]
fn object_with_a_name_is_deformed_alone() {
    let text = "object A\n mesh s gem.obj\nclose\nobject B\n mesh s gem.obj\nclose\n";
    let plain = corners(&run(text));
    let bent = corners(&run(&format!(
        "{text}deform A {{ control 0 0 0 move 1 0 0 }}"
    )));
    let half = plain.len() / 2;
    assert_eq!(plain[half..], bent[half..]);
    assert_ne!(plain[..half], bent[..half]);
}

#[test]
fn surface_is_at_the_thickness_and_scales_with_the_mesh() {
    for growth in [1.0, 2.5] {
        let text = format!(
            "mesh s gem.obj metaballs triangular 0.05 60\nscale {growth} {growth} {growth}"
        );
        let compiled = run(&text);
        let surfaces = compiled.scene.surfaces();
        assert_eq!(surfaces.len(), 1);
        // The gem's table is flat at z = 0.65 around the axis, but the vertex in its middle has
        // eight facets.
        let above = |x: f64, rise: f64| {
            let point = DVec3::new(x, 0.0, 0.65 + rise) * growth;
            surfaces[0].function().jet(point).value > THRESHOLD
        };
        assert!(above(0.3, 0.049) && !above(0.3, 0.052));
    }
    // A mesh adds to the body that it stands in.
    let text = "surface f = s, radius 0.5, blobbiness -3\nmesh s gem.obj metaballs spherical 12\n\
        sphere f 0.5 3 0 0";
    let surfaces = run(text).scene.surfaces();
    assert_eq!(surfaces.len(), 1);
    assert!(surfaces[0].function().jet(DVec3::X * 3.0).value > THRESHOLD);
}

#[test]
fn as_many_controls_as_are_taken() {
    let controls = |count: usize| -> String {
        let place = |i: usize| {
            let [x, y, z] = [i % 16, i / 16 % 16, i / 256].map(|n| n as f64 / 8.0 - 1.0);
            format!("control <{x} {y} {z}> move <0 0 0.01> ")
        };
        (0..count).map(place).collect()
    };
    let bent = run(&format!("mesh s gem.obj\ndeform {{ {} }}", controls(4096)));
    assert!(!bent.scene.elements.is_empty());
    let text = format!(
        "surface s, diffuse Red\nmesh s gem.obj\ndeform {{ {} }}",
        controls(4097)
    );
    let compiled = compile(&Project {
        files: vec![File {
            name: String::from("main.rat"),
            text,
        }],
    });
    let told = &compiled.diagnostics[0].message;
    assert_eq!(
        told,
        "there are 4097 control points, more than the 4096 that are taken"
    );
}

#[test]
fn controls_are_told_with_their_places_in_the_text() {
    let text = "var up = 0.5\nmesh s gem.obj\ntranslate 1 0 0\n\
        deform { control <1 0 -1.2> move <0 0 up>\n  control 1 0 0.65\n  \
        control <1, 1, 0> move 0 -.25 1e-1 }";
    let compiled = run(text);
    let whole = format!("surface s, diffuse Red\n{text}");
    let [deform] = &compiled.deforms[..] else {
        panic!("{:?}", compiled.deforms);
    };
    assert!(!deform.repeated);
    let origin = deform.origin.start as usize..deform.origin.end as usize;
    assert!(whole[origin].starts_with("deform {"));
    let places: Vec<_> = deform
        .controls
        .iter()
        .map(|c| &whole[c.span.clone()])
        .collect();
    assert_eq!(places, ["<1 0 -1.2>", "1 0 0.65", "<1, 1, 0>"]);
    let ways: Vec<_> = deform
        .controls
        .iter()
        .map(|c| {
            (
                c.way,
                c.way_span.clone().map(|span| &whole[span]),
                c.is_literal,
            )
        })
        .collect();
    assert_eq!(
        ways,
        [
            (DVec3::Z * 0.5, Some("<0 0 up>"), false),
            (DVec3::ZERO, None, true),
            (DVec3::new(0.0, -0.25, 0.1), Some("0 -.25 1e-1"), true),
        ]
    );
    // The mesh before, each vertex once.
    let plain = corners(&run("mesh s gem.obj\ntranslate 1 0 0"));
    let own = deform.triangles.iter().flatten();
    let own: Vec<_> = own.map(|i| deform.positions[*i as usize]).collect();
    assert_eq!(own, plain);
    assert!(deform.positions.len() < plain.len() / 2);
    let soft = text.replacen("gem.obj", "gem.obj metaballs triangular 0.05 30", 1);
    assert_eq!(
        run(&soft).deforms[0].triangles.len(),
        deform.triangles.len()
    );
    let looped =
        "mesh s gem.obj\nfor i = 1 to 2 {\n deform { control <0 0 -1.2> move <0 0 0.1> }\n}";
    assert!(run(looped).deforms.iter().all(|d| d.repeated));
}
