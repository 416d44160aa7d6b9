//! `sinew mesh`, end to end.

use crate::common::{Folder, sinew, stdout};
use serde_json::Value;

const PAIR: &str = "light White point pos 3 4 5\n\
    surface warm diffuse OrangeRed shine 30 blob -2 kernel gauss\n\
    surface cool diffuse SteelBlue blob -2 kernel gauss\n\
    sphere warm 1 0 0 0\nsphere cool 1 1.5 0 0\n";

fn mesh(arguments: &[&str]) -> Value {
    let output = sinew(arguments, "");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {said}");
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

#[test]
fn every_format_holds_the_same_closed_mesh() {
    let folder = Folder::new("mesh-formats");
    let file = folder.write("pair.rat", PAIR);
    let mut volumes = Vec::new();
    for ending in ["glb", "3mf", "stl", "obj", "ply"] {
        let out = folder.path(&format!("pair.{ending}"));
        let known = mesh(&[
            "mesh",
            &file,
            "-o",
            &out,
            "--relative",
            "5e-3",
            "--size",
            "40",
            "--json",
        ]);
        let part = &known["parts"][0];
        assert_eq!(part["level"], "file");
        assert_eq!(part["closed"], true);
        assert_eq!(part["genus"], serde_json::json!([0]));
        assert_eq!(
            (&part["undecided"], &part["unproved"]),
            (&0.into(), &0.into())
        );
        let tolerance = known["tolerance"].as_f64().unwrap();
        assert!(part["error"].as_f64().unwrap() <= tolerance);
        let measured = &part["measured"];
        for way in ["mesh_to_surface", "surface_to_mesh"] {
            let distance = measured[way].as_f64().unwrap();
            assert!(distance > 0.0 && distance <= tolerance, "{way} {distance}");
        }
        assert!(measured["samples"][0].as_u64().unwrap() > 500);
        assert!(part["area"].as_f64().unwrap() > 4.0 * core::f64::consts::PI);
        assert!(part["smallest_angle"].as_f64().unwrap() > 1.0);
        assert!(known["seconds"]["phases"]["triangles"].as_f64().is_some());
        assert!(known["evaluations"].as_u64().unwrap() > 1000);
        let bytes = std::fs::read(&out).unwrap();
        let mesh = mesh::read(&out, &bytes).unwrap();
        assert_eq!(
            mesh.triangles.len() as u64,
            part["triangles"].as_u64().unwrap()
        );
        // GLB is in metres.
        let unit = if ending == "glb" { 1000.0 } else { 1.0 };
        let longest = mesh.bounds().size().max_element() * unit;
        assert!((longest - 40.0).abs() < 1e-3, "{ending}: {longest}");
        volumes.push(mesh.signed_volume() * unit * unit * unit);
        assert_eq!(mesh.colors.is_some(), ending != "stl", "{ending}");
    }
    let first = volumes[0];
    assert!(
        volumes.iter().all(|v| (v / first - 1.0).abs() < 1e-4),
        "{volumes:?}"
    );
    assert!(std::fs::exists(folder.path("pair.mtl")).unwrap());
}

#[test]
fn levels_of_detail_and_coatings_are_written() {
    let folder = Folder::new("mesh-levels");
    let file = folder.write("pair.rat", PAIR);
    let out = folder.path("pair.glb");
    let known = mesh(&["mesh", &file, "-o", &out, "--lod", "2", "--json"]);
    let levels = known["levels"].as_array().unwrap();
    assert_eq!(levels.len(), 2);
    let [fine, coarse] =
        [0, 1].map(|i| ["triangles", "error"].map(|key| levels[i][key].as_f64().unwrap()));
    assert!(fine[0] > 2.0 * coarse[0]);
    assert!(0.0 < fine[1] && fine[1] < coarse[1]);
    for name in ["pair.glb", "pair-1.glb", "pair-2.glb"] {
        let bytes = std::fs::read(folder.path(name)).unwrap();
        assert!(
            mesh::read(name, &bytes).unwrap().triangles.len() > 20,
            "{name}"
        );
    }
    let out = folder.path("coat.ply");
    let known = mesh(&["mesh", &file, "-o", &out, "--coat", "0.1", "--json"]);
    let part = &known["parts"][0];
    assert!(part["triangles"].as_f64().unwrap() >= 40.0);
    assert!(part["excess"].as_f64().unwrap() <= 0.1);
}

#[test]
fn words_say_what_a_user_wants_to_know() {
    let folder = Folder::new("mesh-said");
    let file = folder.write("pair.rat", PAIR);
    let out = folder.path("pair.stl");
    let output = sinew(&["mesh", &file, "-o", &out, "--relative", "5e-3"], "");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains(": Watertight. 1 part. 0."), "{said}");
    assert!(
        said.contains(" mm. ") && said.contains(" triangles"),
        "{said}"
    );
    let arguments = ["--relative", "5e-3", "--json", "--prove"];
    let known = mesh(&[&["mesh", &file, "-o", &out][..], &arguments].concat());
    assert_eq!(known["parts"][0]["level"], "proof");
}

/// A model in a map's coordinates: STL keeps its shape about another origin, which is said.
#[test]
fn far_models_are_moved_and_what_is_left_out_is_named() {
    let folder = Folder::new("mesh-far");
    let far = "surface warm diffuse OrangeRed blob -2\nsurface bare diffuse White blob -2 rad 0\n\
        sphere warm 1 500000 4649776 0\nsphere warm 1 500001.5 4649776 0\n\
        line bare <500000 4649776 0> <500001 4649776 0>\n";
    let file = folder.write("far.rat", far);
    let out = folder.path("far.obj");
    let arguments = ["mesh", &file, "-o", &out, "--relative", "5e-3"];
    let known = mesh(&[&arguments[..], &["--json"]].concat());
    let said = known["diagnostics"].to_string();
    assert!(said.contains("left out"), "{said}");
    assert!(known["notes"][0].as_str().unwrap().contains("origin"));
    assert!(known["shift"][1].as_f64().unwrap() > 1e8);
    let written = mesh::read(&out, &std::fs::read(&out).unwrap()).unwrap();
    let topology = mesh::Topology::of(&written).unwrap();
    assert_eq!(
        (topology.genera, topology.repairs.is_none()),
        (vec![0], true)
    );
    let mut heights: Vec<u64> = written.positions.iter().map(|p| p.y.to_bits()).collect();
    heights.sort_unstable();
    heights.dedup();
    assert!(
        4 * heights.len() > written.positions.len(),
        "{}",
        heights.len()
    );
    let crossings = mesh::self_intersections(&written, 10).unwrap();
    assert!(crossings.is_free());
}

#[test]
fn what_cannot_be_meshed_is_told() {
    let folder = Folder::new("mesh-words");
    let file = folder.write("pair.rat", PAIR);
    let empty = folder.write("empty.rat", "light White point pos 3 4 5\n");
    let far = folder.write(
        "plane.rat",
        "surface s diffuse White blob -2 rad 0.1\nplane s <0 0 0> <0 1 0>\n",
    );
    let out = folder.path("out.stl");
    for (arguments, word) in [
        (&[&*empty, "-o", &out][..], "no surface"),
        (&[&far, "-o", &out], "box"),
        (&[&file, "-o", "out.xyz"], ".3mf"),
        (&[&file, "-o", &out, "--size", "0"], "millimetres"),
        (&[&file, "-o", &out, "--tolerance=-1"], "tolerance"),
        (&[&file, "-o", &out, "--body", "NOBODY"], "NOBODY"),
        (&[&file, "-o", &out, "--threads", "0"], "--threads"),
    ] {
        let output = sinew(&[&["mesh"], arguments].concat(), "");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(word), "{arguments:?}: {said}");
    }
    assert!(!std::fs::exists(&out).unwrap(), "nothing is written");
}

/// Models that would take hours end with a mesh or a sentence, by bounds on the counts of cells and
/// evaluations.
#[test]
fn degenerate_models_end_with_a_mesh_or_words() {
    let folder = Folder::new("mesh-ends");
    let said = |name: &str, text: &str, options: &[&str]| {
        let file = folder.write(&format!("{name}.rat"), text);
        let out = folder.path("out.ply");
        let output = sinew(&[&["mesh", &file, "-o", &out], options].concat(), "");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), said)
    };
    let ball = "sphere s 1 0 0 0\n";
    let soft = "surface s diffuse White blob -2\n";
    let twice = format!("{soft}body A\n{ball}close\nbody B\n{ball}close\ncontact A B\n");
    let (code, words) = said("same", &twice, &["--relative", "1e-2"]);
    assert_eq!(code, Some(2), "{words}");
    // As the one takes away what the other has, nothing is left of either.
    assert!(
        words.contains("no surface") || words.contains("lie on each other"),
        "{words}"
    );

    let hard = "surface s diffuse White\n";
    let plane = format!("{hard}plane s <0 0 0> <0 1 0>\n{ball}");
    let (code, words) = said("plane", &plane, &["--box", "1e9"]);
    assert_eq!(code, Some(0), "{words}");

    let shell = format!("{hard}shell s, angle = 20, rise = 0.5\n");
    let (code, words) = said("shell", &shell, &["--union", "--relative", "5e-3"]);
    assert_eq!(code, Some(0), "{words}");

    // All end in one place: no primitive can be left out of a sum.
    let star = (0..2000).map(|i| {
        let (a, b) = (i % 50, i / 50);
        let tip = [
            a as f64 / 25.0 - 1.0,
            b as f64 / 20.0 - 1.0,
            0.3 + (a * b % 7) as f64 * 0.1,
        ];
        let [x, y, z] = tip;
        format!("cylinder s 0.03 <0 0 0> <{x} {y} {z}>\n")
    });
    let star = format!("{soft}{}", star.collect::<String>());
    let (code, words) = said("star", &star, &["--coat", "0.1"]);
    assert_eq!(code, Some(0), "{words}");
    assert!(words.contains("would take too long"), "{words}");

    let open = format!("{soft}cylinder s 0.3 <0 0 0> <4 0 0> ends open\n");
    for wish in ["--coat=0.1", "--relative=0.01"] {
        let (code, words) = said("open", &open, &[wish]);
        assert_eq!(code, Some(0), "{words}");
        assert!(words.contains("2 ends are open"), "{wish}: {words}");
    }
}
