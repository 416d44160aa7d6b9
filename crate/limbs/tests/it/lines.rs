//! OBJ with lines, PLY with edges.

use crate::common::{check, drawing, graph, message, remarks, with};
use limbs::Reading;

/// A triangle with a tail, as PLY, with radii.
fn ply(format: &str, radius: &str) -> Vec<u8> {
    let head = format!(
        "ply\nformat {format} 1.0\ncomment odd order\nelement vertex 4\nproperty float y\n\
         property uchar red\nproperty double x\nproperty float {radius}\nproperty float z\n\
         element misc 1\nproperty list uchar short junk\n\
         element edge 5\nproperty int vertex1\nproperty int vertex2\nproperty uchar crease\n\
         end_header\n"
    );
    let mut file = head.into_bytes();
    let vertices = [
        [0.0, 0.0, 0.5, 0.0],
        [0.0, 2.0, 0.25, 0.0],
        [1.5, 1.0, 0.25, 0.0],
        [4.0, 1.0, 0.125, 1.0],
    ];
    let edges = [[0, 1], [1, 2], [2, 0], [2, 3], [1, 0]];
    if format == "ascii" {
        for [y, x, r, z] in vertices {
            file.extend(format!("{y} 7 {x} {r} {z}\n").bytes());
        }
        file.extend(b"3 -1 -2 -3\n");
        for [a, b] in edges {
            file.extend(format!("{a} {b} 0\n").bytes());
        }
        return file;
    }
    let mut values: Vec<Vec<u8>> = Vec::new();
    for [y, x, r, z] in vertices {
        values.push((y as f32).to_le_bytes().to_vec());
        values.push(vec![7]);
        values.push(f64::from(x as f32).to_le_bytes().to_vec());
        values.push((r as f32).to_le_bytes().to_vec());
        values.push((z as f32).to_le_bytes().to_vec());
    }
    values.push(vec![3]);
    values.extend([-1_i16, -2, -3].map(|junk| junk.to_le_bytes().to_vec()));
    for [a, b] in edges {
        values.push(i32::to_le_bytes(a).to_vec());
        values.push(i32::to_le_bytes(b).to_vec());
        values.push(vec![0]);
    }
    for mut value in values {
        if format == "binary_big_endian" {
            value.reverse();
        }
        file.extend(value);
    }
    file
}

#[test]
fn edges_of_ply_are_limbs_in_all_its_forms() {
    let first = graph("a.ply", ply("ascii", "radius"));
    check(&first);
    assert_eq!((first.nodes.len(), first.limbs.len()), (4, 4));
    assert_eq!((first.facts().cycles, first.facts().free_ends), (1, 1));
    assert!(remarks(&first)[0].starts_with("1 limbs are listed more than once"));
    assert!(drawing(&first).contains(&[[1.0, 1.5, 0.0, 0.25], [1.0, 4.0, 1.0, 0.125]]));
    for format in ["binary_little_endian", "binary_big_endian"] {
        assert_eq!(graph("a.ply", ply(format, "radius")), first, "{format}");
    }
    let wide = graph("a.ply", ply("ascii", "Diameter"));
    assert_eq!(wide.limbs[3].radii, [0.125, 0.0625]);
    let reading = Reading {
        radii: Some("size"),
        ..Reading::default()
    };
    assert_eq!(
        drawing(&with("a.ply", ply("ascii", "size"), reading)),
        drawing(&first)
    );
    let error = limbs::read("a.ply", &ply("ascii", "radius"), &reading).unwrap_err();
    assert!(error.to_string().contains("no property `size`"), "{error}");
    assert!(error.to_string().contains("`radius`"), "{error}");
    assert!(message("a.ply", ply("ascii", "size")).contains("no radii above 0"));
    let reading = Reading {
        radius: Some(0.75),
        ..Reading::default()
    };
    let given = with("a.ply", ply("ascii", "size"), reading);
    assert!(given.limbs.iter().all(|limb| limb.radii == [0.75; 2]));
    assert!(given.nodes.iter().all(|node| node.is_guessed));
}

#[test]
fn a_ply_without_edges_is_none() {
    let cloud = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n\
                  property float z\nend_header\n0 0 0\n";
    assert_eq!(limbs::read("a.ply", cloud, &Reading::default()), Ok(None));
    let text = String::from_utf8(ply("ascii", "radius")).unwrap();
    assert!(message("a.ply", text.replace("2 3 0", "2 9 0")).contains("vertex 9 (from 0) of 4"));
    assert!(message("a.ply", text.replace("2 3 0", "2 -3 0")).contains("`edge` 3 (from 0)"));
    assert!(message("a.ply", text.replace("edge 5", "edge 6")).contains("`edge` 5 (from 0)"));
    assert!(message("a.ply", text.replace("edge 5", "edge 5000000")).contains("5000000"));
    assert!(message("a.ply", text.replace("property int vertex2\n", "")).contains("vertex2"));
}

#[test]
fn lines_of_obj_are_limbs() {
    let text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 1 1 0\nv 5 5 5\nusemtl bark\n\
                l 1 2 \\\n 3 # a corner\nusemtl leaf\nl -2/1 -1/2\np 1\nf 1 2 3\n";
    let reading = Reading {
        radius: Some(0.5),
        ..Reading::default()
    };
    let graph = with("a.obj", text, reading);
    check(&graph);
    assert_eq!((graph.nodes.len(), graph.limbs.len()), (4, 3));
    assert_eq!(
        graph.facts().components,
        1,
        "points at one place are one node"
    );
    let names: Vec<&str> = graph.groups.iter().map(|group| &group.name[..]).collect();
    assert_eq!(names, ["bark", "leaf"]);
    assert_eq!(graph.limbs[2].group, 1);
    assert!(remarks(&graph)[0].starts_with("1 faces are left out"));
    assert!(message("a.obj", text).contains("give the material"));
    assert_eq!(
        limbs::read("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", &reading),
        Ok(None)
    );
    for (line, told) in [
        ("l 1 9", "line 2: `9` is none of the 1 `v` so far"),
        ("l 1 0", "line 2: `0` is none"),
        ("v 1 nan 0", "line 2: coordinates must be"),
        ("v 1 0", "line 2: three numbers are needed"),
        ("v 1e13 0 0", "line 2: coordinates must be"),
    ] {
        let told_now = message("a.obj", format!("v 0 0 0\n{line}\n"));
        assert!(told_now.starts_with(told), "{told_now}");
    }
}
