//! Files that are odd but valid mean what plain ones do, and odd numbers are told.

use crate::common::{check, drawing, graph, message, remarks, with};
use archive::Member;
use limbs::limits::MAX_LISTED;
use limbs::{Graph, Reading};
use std::fmt::Write as _;

/// A limb from the origin to (20, 0, 0), whose radius falls from 1 to 0.5, in each format of text.
const FILES: [(&str, &str); 7] = [
    ("a.swc", "# µm\n1 3 0 0 0 1 -1\n2 3 20 0 0 .5 1\n"),
    (
        "a.obj",
        "# vt: radius\nv 0 0 0\nv 20 0 0\nvt 1\nvt 0.5\nl 1/1 2/2\n",
    ),
    (
        "a.csv",
        "start_x,start_y,start_z,end_x,end_y,end_z,radius\n0,0,0,20,0,0,1\n",
    ),
    ("a.xyz", "2\nmade up\nC 0 0 0\nC 20 0 0\n"),
    (
        "a.pdb",
        "HETATM    1  C   GLY A   1       0.000   0.000   0.000  1.00  0.00           C\n\
         HETATM    2  C   GLY A   1      20.000   0.000   0.000  1.00  0.00           C\n",
    ),
    (
        "a.vtp",
        "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"2\"><PointData><DataArray \
         type=\"Float32\" Name=\"radius\">1 .5</DataArray></PointData><Points><DataArray \
         type=\"Float32\" NumberOfComponents=\"3\">0 0 0 20 0 0</DataArray></Points><Lines>\
         <DataArray type=\"Int64\" Name=\"connectivity\">0 1</DataArray><DataArray type=\"Int64\" \
         Name=\"offsets\">2</DataArray></Lines></Piece></PolyData></VTKFile>",
    ),
    (
        "a.3mf",
        "<model unit=\"millimeter\"><resources><object id=\"1\"><mesh><vertices><vertex x=\"0\" \
         y=\"0\" z=\"0\"/><vertex x=\"20\" y=\"0\" z=\"0\"/></vertices><beamlattice radius=\"1\" \
         minlength=\"0\"><beams><beam v1=\"0\" v2=\"1\" r2=\".5\"/></beams></beamlattice></mesh>\
         </object></resources><build><item objectid=\"1\"/></build></model>",
    ),
];

/// Reads a file of these, a 3MF package around the text of one.
fn read(name: &str, bytes: &[u8]) -> Graph {
    match name {
        "a.3mf" => {
            let model = Member::new("3D/3dmodel.model", bytes);
            graph(name, archive::write(&[model]).unwrap())
        }
        _ => graph(name, bytes),
    }
}

/// Returns a text in UTF-16, the lowest byte first or last.
fn widen(text: &str, is_big: bool) -> Vec<u8> {
    let units = std::iter::once(0xFEFF).chain(text.encode_utf16());
    let pairs = units.map(|unit| match is_big {
        true => unit.to_be_bytes(),
        false => unit.to_le_bytes(),
    });
    pairs.flatten().collect()
}

#[test]
fn texts_mean_the_same_in_any_encoding_and_with_any_ends_of_lines() {
    for (name, text) in FILES {
        let plain = read(name, text.as_bytes());
        check(&plain);
        assert_eq!(plain.nodes.len(), 2, "{name}");
        assert_eq!(plain.nodes[1].position.x, 20.0, "{name}");
        for (way, bytes) in [
            ("a mark", format!("\u{feff}{text}").into_bytes()),
            ("UTF-16", widen(text, false)),
            ("UTF-16, highest byte first", widen(text, true)),
            ("two characters", text.replace('\n', "\r\n").into_bytes()),
            ("carriage returns", text.replace('\n', "\r").into_bytes()),
            ("zeros at the end", format!("{text}\0\0\0").into_bytes()),
            ("Latin-1", text.replace('µ', "\u{1}").into_bytes()),
        ] {
            let bytes: Vec<u8> = match way {
                "Latin-1" => bytes
                    .iter()
                    .map(|b| if *b == 1 { 0xB5 } else { *b })
                    .collect(),
                _ => bytes,
            };
            assert_eq!(read(name, &bytes), plain, "{name}: {way}");
        }
    }
}

#[test]
fn swc_may_have_a_heading_large_ids_and_roots_called_0() {
    let plain = graph("a.swc", "1 3 0 0 0 1 -1\n2 3 20 0 0 .5 1\n");
    for text in [
        "id,type,x,y,z,radius,parent\n1,3,0,0,0,1,-1\n2,3,20,0,0,.5,1\n",
        "n T x y z R P\n1 3 0 0 0 1 -1\n2 3 20 0 0 .5 1\n",
        "// made up\n1 3 0 0 0 1 -1\n2 3 20 0 0 .5 1\n",
    ] {
        let own = graph("a.swc", text);
        assert_eq!(drawing(&own), drawing(&plain), "{text}");
        let told = "line 1: this line has no numbers and is taken for a heading";
        assert_eq!(remarks(&own), [told], "{text}");
    }
    for text in [
        "1 3 0 0 0 1 0\n2 3 20 0 0 .5 1\n",
        "1 3 0 0 0 1 -2\n2 3 20 0 0 .5 1\n",
        "99999999999 3 0 0 0 1 -1\n100000000000 3 20 0 0 .5 99999999999\n",
        "1.0, 3, 0, 0, 0, 1, -1.0\n2e0, 3, 20, 0, 0, .5, 1, 7, 8\n",
    ] {
        assert_eq!(graph("a.swc", text), plain, "{text}");
    }
    let told = message("a.swc", "1 3 0 0 0 1,5 -1\n2 3 20,5 0 0 1 1\n");
    assert_eq!(
        told,
        "line 1: `radius` is `1,5`, which is no number: it needs a point"
    );
    assert!(message("a.swc", "1e30 3 0 0 0 1 -1\n").contains("no whole number up to 9e15"));
    assert!(message("a.swc", "a heading\nanother\n").contains("id type x y z radius parent"));
}

#[test]
fn tables_may_have_diameters_numbered_columns_and_commas_in_numbers() {
    let plain = graph("a.csv", FILES[2].1);
    for text in [
        "start_x;start_y;start_z;end_x;end_y;end_z;radius\n0,0;0;0;20,0;0;0;1,0\n",
        "start_x,start_y,start_z,end_x,end_y,end_z,Diameter (m)\n0,0,0,20,0,0,2\n",
        "start_1,\"start_2\",start_3,axis_1,axis_2,axis_3,length,radius\n0,0,0,3,0,0,20,1\n",
        "start_x,start_y,start_z,end_x,end_y,end_z,radius\n\"0,0\",0,0,20,0,0,1\n",
        "x1 y1 z1 x2 y2 z2 radius\n0 0 0 20 0 0 1\n",
    ] {
        assert_eq!(drawing(&graph("a.csv", text)), drawing(&plain), "{text}");
    }
    let reading = Reading {
        radii: Some("Trunk diameter"),
        ..Reading::default()
    };
    let text = FILES[2].1.replace("radius", "trunk_diameter");
    assert_eq!(with("a.csv", text, reading).limbs[0].radii, [0.5; 2]);
}

#[test]
fn labels_of_atoms_begin_with_their_symbols() {
    let labels = graph("a.xyz", "4\n\nC12 0 0 0\nH_a 1 0 0\nCl1- 9 0 0\n6 5 5 5\n");
    let names = labels.nodes.iter();
    let names = names.map(|node| &labels.groups[node.group as usize].name[..]);
    assert_eq!(names.collect::<Vec<_>>(), ["C", "H", "Cl", "C"]);
}

#[test]
fn a_line_of_obj_may_be_continued_to_the_end() {
    let reading = Reading {
        radius: Some(1.0),
        ..Reading::default()
    };
    let text = "v 0 0 0\nv 20 0 0\nl 1 \\\n2\\";
    assert_eq!(with("a.obj", text, reading).limbs.len(), 1);
}

#[test]
fn numbers_on_a_line_and_limbs_without_end_are_bounded() {
    let mut text = String::from("# vt: radius\nv 0 0 0\nv 1 0 0\nvt 1\nl");
    for _ in 0..=MAX_LISTED / 2 {
        text += " 1/1 2/1";
    }
    let told = message("a.obj", &text);
    assert!(told.contains("line 5: more than 2000000 limbs"), "{told}");
    // As many as are taken are one limb.
    let allowed = &text[..text.len() - 2 * " 1/1 2/1".len()];
    assert_eq!(graph("a.obj", allowed).limbs.len(), 1);
    // Words behind the columns, and columns that mean nothing.
    let more = format!("1 3 0 0 0 1 -1{}\n2 3 20 0 0 1 1\n", " 7".repeat(1_000_000));
    assert_eq!(graph("a.swc", more).limbs.len(), 1);
    let heading: String = (0..100_000).fold(String::new(), |mut text, i| {
        let _ = write!(text, "c{i},");
        text
    });
    let told = message("a.csv", format!("{heading}\n"));
    assert!(told.len() < 1000, "{} bytes", told.len());
    for (name, text) in [
        ("a.xyz", "99999999999999999\n\nC 0 0 0\n"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nl 1 99999999999999999999\n"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nl 1 -9223372036854775808\n"),
    ] {
        assert!(message(name, text).starts_with("line "), "{name}");
    }
}

#[test]
fn tags_and_objects_in_each_other_are_no_matter() {
    let deep = format!("{}{}", "<a>".repeat(300_000), "</a>".repeat(300_000));
    assert!(message("a.vtp", &deep).contains("no VTP file"));
    let nested = graph("a.3mf", nest(4000));
    assert_eq!(nested.nodes[0].position.z, 3999.0);
    assert!(message("a.3mf", nest(20_000)).contains("more than 10000"));
}

/// Returns a package of a limb in objects that stand in each other, each of which lifts it by 1.
fn nest(count: u32) -> Vec<u8> {
    let mut content = String::from("</object>");
    for i in 2..=count {
        let _ = write!(
            content,
            "<object id=\"{i}\"><components><component objectid=\"{}\" transform=\"1 0 0 0 1 0 0 0 \
             1 0 0 1\"/></components></object>",
            i - 1
        );
    }
    let _ = write!(content, "</resources><build><item objectid=\"{count}\"/>");
    let last = "</object></resources><build><item objectid=\"1\"/>";
    let text = FILES[6].1.replace(last, &content);
    archive::write(&[Member::new("3D/3dmodel.model", text.as_bytes())]).unwrap()
}
