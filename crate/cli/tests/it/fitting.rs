//! `sinew scan` and `sinew fit`, end to end.

use crate::common::{Folder, sinew, stdout};
use serde_json::Value;

const HEAD: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../www/examples/head.obj");
const CAMERA: &str =
    "eyep 0 -9 0.2\nvrp 0 0 -0.1\nvup 0 0 1\nfov 34\nframesize 200 200\nsurface s diffuse White\n";
/// Moves of a few control points around the head.
const BENT: &str =
    "deform { control <0 0 1.9> move <0.3 0 0.1> control <0 -1.2 0.3> move <0 -0.2 0>
    control <1.6 0 -1.5> move <0.1 0.1 0> control <-1.6 0 -1.5> move <0 0 -0.1> }\n";

/// A coarse cage: the box of the head, a vertex in the middle of each side.
fn cage() -> String {
    let (corners, mut text) = ([[-1.5, 1.5], [-1.2, 0.9], [-1.9, 1.8]], String::new());
    for i in 0..8 {
        let [x, y, z] = [0, 1, 2].map(|axis| corners[axis][i >> axis & 1]);
        text += &format!("v {x} {y} {z}\n");
    }
    for axis in 0..3 {
        for side in 0..2 {
            let mut middle = corners.map(|[low, high]| 0.5 * (low + high));
            middle[axis] = corners[axis][side];
            let [x, y, z] = middle;
            text += &format!("v {x} {y} {z}\n");
        }
    }
    for axis in 0..3 {
        for side in 0..2_usize {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let middle = 9 + 2 * axis + side;
            let ring = [[0, 0], [1, 0], [1, 1], [0, 1]]
                .map(|[a, b]| 1 + (side << axis) + (a << u) + (b << v));
            for k in 0..4 {
                text += &format!("f {middle} {} {}\n", ring[k], ring[(k + 1) % 4]);
            }
        }
    }
    text
}

/// A folder with the head, its cage, and a scan of the bent head.
fn prepare(name: &str) -> Folder {
    let folder = Folder::new(name);
    std::fs::copy(HEAD, folder.path("head.obj")).expect("copied");
    folder.write("cage.obj", &cage());
    let scene = folder.write("bent.rat", &format!("{CAMERA}mesh s head.obj\n{BENT}"));
    let output = sinew(
        &[
            "scan",
            &scene,
            "-o",
            &folder.path("cloud.ply"),
            "--points",
            "700",
            "--noise",
            "0.005",
            "--outliers",
            "0.05",
            "--seed",
            "4",
            "--outlines",
            &folder.path("outlines.json"),
            "--views",
            "2",
        ],
        "",
    );
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    folder
}

/// The mesh beside a dataset is never the one that is fitted.
#[test]
fn a_fit_does_not_write_over_its_mesh() {
    let folder = prepare("over");
    let mesh = folder.path("out-fitted.obj");
    std::fs::copy(folder.path("head.obj"), &mesh).expect("written");
    let before = std::fs::read(&mesh).expect("there");
    let arguments = [
        "fit",
        &mesh,
        "--lattice",
        "2,2,2",
        "--points",
        &folder.path("cloud.ply"),
        "-o",
        &folder.path("out.rat"),
    ];
    let output = sinew(&arguments, "");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("would be written over"), "{said}");
    assert_ne!(output.status.code(), Some(0));
    assert!(std::fs::read(&mesh).expect("there") == before);
}

#[test]
fn a_bent_head_is_found_again_and_written_as_text_and_mesh() {
    let folder = prepare("fit");
    let [mesh, cage] = ["head.obj", "cage.obj"].map(|name| folder.path(name));
    let output = sinew(
        &[
            "fit",
            &mesh,
            "--control",
            &cage,
            "--points",
            &folder.path("cloud.ply"),
            "--silhouettes",
            &folder.path("outlines.json"),
            "--kind",
            "explicit",
            "-o",
            &folder.path("fitted.rat"),
            "-o",
            &folder.path("fitted.ply"),
            "--json",
        ],
        "",
    );
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let told: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let residual = told["residual"].as_f64().expect("a number");
    assert!(residual < 0.02, "{told}");
    assert_eq!(told["controls"], 14);
    assert_eq!(told["moves"].as_array().map(Vec::len), Some(14));
    assert!(told["sights"].as_u64() > Some(60), "{told}");
    // A twentieth of the points are outliers.
    let left_out = told["left_out"].as_array().map_or(0, Vec::len);
    assert!((20..80).contains(&left_out), "{told}");
    assert!(told["failure"].is_null());
    // The text makes the mesh that was written beside it.
    let text = std::fs::read_to_string(folder.path("fitted.rat")).expect("written");
    assert!(
        text.contains("\nmesh Skin head.obj\ndeform {\n  control <"),
        "{text}"
    );
    let output = sinew(&["scene", &folder.path("fitted.rat")], "");
    assert_eq!(output.status.code(), Some(0));
    let scene: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let bytes = std::fs::read(folder.path("fitted.ply")).expect("written");
    let written = mesh::read("fitted.ply", &bytes).expect("a mesh");
    let elements = scene["elements"].as_array().expect("elements");
    assert_eq!(elements.len(), written.triangles.len());
    let mut furthest = 0_f64;
    for (element, i) in elements.iter().zip(0..) {
        let shape = &element["shape"];
        let corners = shape["Bone"]["skeleton"]["Triangle"]["corners"]
            .as_array()
            .expect("corners");
        for (corner, own) in corners.iter().zip(written.corners(i)) {
            for axis in 0..3 {
                let value = corner[axis].as_f64().expect("a number");
                furthest = furthest.max((value - own[axis]).abs());
            }
        }
    }
    assert!(furthest < 1e-5, "{furthest}");
}

#[test]
fn a_turned_cloud_is_met_by_an_alignment() {
    let folder = prepare("align");
    let scene = folder.write(
        "turned.rat",
        &format!("{CAMERA}mesh s head.obj\nrotate 0 0 1 40\ntranslate 0.5 -0.3 0.2\n"),
    );
    let cloud = folder.path("turned.xyz");
    assert_eq!(
        sinew(&["scan", &scene, "-o", &cloud, "--points", "500"], "")
            .status
            .code(),
        Some(0)
    );
    let [mesh, cage, out] = ["head.obj", "cage.obj", "out.rat"].map(|name| folder.path(name));
    let output = sinew(
        &[
            "fit",
            &mesh,
            "--control",
            &cage,
            "--points",
            &cloud,
            "--align",
            "--kind",
            "explicit",
            "-o",
            &out,
            "--json",
        ],
        "",
    );
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let told: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let angle = told["turn"]["angle"].as_f64().expect("a number");
    assert!((angle - 40.0).abs() < 1.0, "{told}");
    let text = std::fs::read_to_string(&out).expect("written");
    assert!(
        text.contains("\nrotate ") && text.contains("\ntranslate "),
        "{text}"
    );
    // The text's mesh is where the cloud is: a scan of it, fitted again, needs no turn.
    let again = folder.path("again.xyz");
    assert_eq!(
        sinew(&["scan", &out, "-o", &again, "--points", "300"], "")
            .status
            .code(),
        Some(0)
    );
}

#[test]
fn lattices_and_single_vertices_write_a_mesh_beside_the_dataset() {
    let folder = prepare("ways");
    let [mesh, cloud, out] = ["head.obj", "cloud.ply", "out.rat"].map(|name| folder.path(name));
    for (way, count) in [(&["--lattice", "3,3,4"][..], 36), (&["--vertices"], 212)] {
        let mut arguments = vec!["fit", &mesh, "--points", &cloud, "--kind", "explicit"];
        arguments.extend(["-o", &out, "--json"].iter().chain(way));
        let output = sinew(&arguments, "");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
        let told: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
        assert_eq!(told["controls"], count);
        let residual = told["residual"].as_f64().expect("a number");
        assert!(residual < 0.02, "{told}");
        let text = std::fs::read_to_string(&out).expect("written");
        assert!(text.contains("\nmesh Skin out-fitted.obj\n"), "{text}");
        assert_eq!(sinew(&["scene", &out], "").status.code(), Some(0));
    }
    let both = ["fit", &mesh, "--points", &cloud, "-o", &out, "--vertices"];
    let said = refusal(&[&both[..], &["--lattice", "3,3,4"]].concat());
    assert_says(&said, "cannot be used with");
    assert_says(&refusal(&both[..6]), "--control <CAGE>");
    let said = refusal(&[&both[..6], &["--lattice", "3,4"]].concat());
    assert_says(&said, "three whole numbers");
    let said = refusal(&[&both[..6], &["--lattice", "1,3,4"]].concat());
    assert_says(&said, "at least two nodes");
}

#[test]
fn fit_that_fails_is_told_and_its_best_is_written() {
    let folder = prepare("failed");
    // Points anywhere around the head.
    let mut cloud = String::new();
    let mut random = trials::Random::new(3);
    for _ in 0..600 {
        let [x, y, z] = [3.0, 2.0, 4.0].map(|half| random.range(-half, half));
        cloud += &format!("{x} {y} {z}\n");
    }
    let cloud = folder.write("anywhere.xyz", &cloud);
    let [mesh, cage, out] = ["head.obj", "cage.obj", "out.ply"].map(|name| folder.path(name));
    let arguments = [
        "fit",
        &mesh,
        "--control",
        &cage,
        "--points",
        &cloud,
        "-o",
        &out,
        "--json",
    ];
    let output = sinew(&arguments, "");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert_says(&said, "the fit failed: ");
    let told: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert!(told["failure"].is_string() && told["left_out"].is_array());
    let bytes = std::fs::read(&out).expect("written");
    assert!(mesh::read("out.ply", &bytes).is_ok());
}

#[test]
fn scans_are_seeded() {
    let folder = prepare("seeds");
    let scene = folder.path("bent.rat");
    let scan = |name: &str, seed: &str| {
        let path = folder.path(name);
        let arguments = [
            "scan",
            &scene,
            "-o",
            &path,
            "--points",
            "100",
            "--noise",
            "0.01",
            "--gap",
            "0.25",
            "--outliers",
            "0.1",
            "--seed",
            seed,
        ];
        assert_eq!(sinew(&arguments, "").status.code(), Some(0));
        std::fs::read(&path).expect("written")
    };
    let first = scan("a.xyz", "7");
    assert_eq!(first, scan("b.xyz", "7"));
    assert_ne!(first, scan("c.xyz", "8"));
    assert_eq!(first.iter().filter(|b| **b == b'\n').count(), 75);
}

/// Message of the program for an input that it refuses.
fn assert_says(said: &str, words: &str) {
    assert!(said.contains(words), "{said}");
}

fn refusal(arguments: &[&str]) -> String {
    let output = sinew(arguments, "");
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn bad_input_is_told_in_words() {
    let folder = Folder::new("fit-bad");
    std::fs::copy(HEAD, folder.path("head.obj")).expect("copied");
    let cage = folder.write("cage.obj", &cage());
    let head = folder.path("head.obj");
    let out = folder.path("out.rat");
    let four = folder.write("four.xyz", "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n");
    let fit = |mesh: &str, extra: &[&str]| {
        let mut arguments = vec!["fit", mesh, "--control", &cage, "-o", &out];
        arguments.extend(extra);
        refusal(&arguments)
    };
    let neither = fit(&head, &[]);
    assert_says(&neither, "--points <CLOUD>");
    assert_says(&neither, "--silhouettes <FILE>");
    let one = folder.write("one.xyz", "0 0 1\n");
    assert_says(
        &fit(&head, &["--points", &one]),
        "a cloud of 1 point says too little; four are the least",
    );
    let same = folder.write("same.xyz", "0 0 1\n0 0 1\n0 0 1\n0 0 1\n");
    assert_says(
        &fit(&head, &["--points", &same]),
        "all points of the cloud are in one place",
    );
    let words = folder.write("words.xyz", "0 0 1\n1 2 three\n");
    assert_says(
        &fit(&head, &["--points", &words]),
        "words.xyz: line 2: three numbers are expected",
    );
    let nothing = folder.write("nothing.obj", "v 0 0 0\nv 1 0 0\n");
    assert_says(&fit(&nothing, &["--points", &four]), "no triangles");
    let aside = folder.write(
        "aside.json",
        r#"[{"eye":[0,-5,0],"target":[0,0,0],"up":[0,0,1],"fov":40,"size":[100,100],
            "lines":[[[20,50],[50,120]]]}]"#,
    );
    assert_says(
        &fit(&head, &["--silhouettes", &aside]),
        "the place 50 120 is outside its picture of 100 × 100 pixels",
    );
    let said = fit(&head, &["--points", &four, "--thickness=-1"]);
    assert!(
        said.contains("--thickness") || said.contains("thickness"),
        "{said}"
    );
    let said = refusal(&[
        "fit",
        &head,
        "--control",
        &cage,
        "--points",
        &four,
        "-o",
        "out.txt",
    ]);
    assert_says(&said, "out.txt: the result is a dataset (.rat) or a mesh");
    // An open mesh that cuts itself is fitted, and told of.
    let open = folder.write(
        "open.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.2 0.2 1\nv 1 1 0.1\nf 1 2 3\nf 4 5 6\n",
    );
    let output = sinew(
        &[
            "fit",
            &open,
            "--control",
            &cage,
            "--points",
            &four,
            "-o",
            &folder.path("open.ply"),
        ],
        "",
    );
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert_says(&said, "the mesh is open: 6 edges in 2 loops");
    assert_says(
        &said,
        "the mesh cuts itself: 1 pairs of facets, the first 1 and 2",
    );
    // Scans that see nothing.
    let empty = folder.write("empty.rat", "surface s diffuse White\n");
    let said = refusal(&["scan", &empty, "-o", &folder.path("e.ply")]);
    assert_says(&said, "nothing to measure");
    let away = folder.write(
        "away.rat",
        &format!("{CAMERA}vrp 0 -20 0\nsphere s 1, 0 0 0\n"),
    );
    let said = refusal(&["scan", &away, "--outlines", &folder.path("o.json")]);
    assert_says(&said, "view 1 has no outline");
}
