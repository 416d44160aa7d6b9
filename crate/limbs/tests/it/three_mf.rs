//! Beam lattices in 3MF packages.

use crate::common::{check, drawing, graph, message, remarks};
use archive::Member;
use glam::DVec3;
use limbs::{Cap, Reading, Side};
use std::f64::consts::PI;
use std::fmt::Write as _;

const HEAD: &str = "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" \
                    xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\" \
                    xmlns:b2=\"http://x/balls/2020/07\" \
                    xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" \
                    requiredextensions=\"b p\"";

fn model(unit: &str, content: &str) -> String {
    format!("<?xml version=\"1.0\"?>\n<model unit=\"{unit}\" {HEAD}>\n{content}\n</model>")
}

/// Returns a package of parts: the first is the main one.
fn package(parts: &[(&str, &str)]) -> Vec<u8> {
    let relations = format!(
        "<Relationships><Relationship Target=\"/{}\" Id=\"a\" \
         Type=\"http://x/3dmodel\"/></Relationships>",
        parts[0].0
    );
    let mut members = vec![Member::new("_rels/.rels", relations.as_bytes())];
    members.extend(
        parts
            .iter()
            .map(|(name, text)| Member::new(name, text.as_bytes())),
    );
    archive::write(&members).unwrap()
}

fn single(unit: &str, content: &str) -> Vec<u8> {
    package(&[("3D/x.model", &model(unit, content))])
}

/// The vertices of a cube with the side 10.
fn vertices() -> String {
    let mut text = String::from("<vertices>");
    for i in 0..8 {
        let [x, y, z] = [i & 1, i >> 1 & 1, i >> 2].map(|bit| 10 * bit);
        let _ = write!(text, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>");
    }
    text + "</vertices>"
}

/// A lattice of a cube's edges as the object of a number.
fn lattice(id: u32, attributes: &str, beam: &str) -> String {
    let mut text = format!(
        "<object id=\"{id}\" name=\"cage\"><mesh>{}<triangles/>\
         <b:beamlattice {attributes}><b:beams>",
        vertices()
    );
    for a in 0..8_u32 {
        for bit in [1, 2, 4].into_iter().filter(|bit| a & bit == 0) {
            let _ = write!(text, "<b:beam v1=\"{a}\" v2=\"{}\"{beam}/>", a | bit);
        }
    }
    text + "</b:beams></b:beamlattice></mesh></object>"
}

const PLAIN: &str = "radius=\"1\" minlength=\"0.001\" cap=\"sphere\"";

fn with_item(object: &str, item: &str) -> String {
    format!("<resources>{object}</resources><build>{item}</build>")
}

#[test]
fn a_cage_of_beams_is_a_graph() {
    let content = with_item(&lattice(4, PLAIN, ""), "<item objectid=\"4\"/>");
    let graph = graph("a.3mf", single("millimeter", &content));
    check(&graph);
    let facts = graph.facts();
    assert_eq!((graph.nodes.len(), graph.limbs.len()), (8, 12));
    assert_eq!((facts.components, facts.cycles, facts.valence), (1, 5, 3));
    assert!(graph.limbs.iter().all(|limb| limb.radii == [1.0; 2]));
    assert_eq!(graph.groups[graph.limbs[0].group as usize].name, "cage");
    assert!(graph.remarks.is_empty());
    // Cylinders alone, without what they share at the corners.
    let volume: f64 = (0..12).map(|i| PI * graph.length(i)).sum();
    assert!((volume - 120.0 * PI).abs() < 1e-9);
}

/// Returns the first limb of a lattice with some attributes.
fn read(attributes: &str, beam: &str) -> limbs::Limb {
    let content = with_item(&lattice(4, attributes, beam), "<item objectid=\"4\"/>");
    graph("a.3mf", single("millimeter", &content)).limbs[0]
}

#[test]
fn radii_and_caps_are_the_beams_own_or_the_lattices() {
    assert_eq!(read(PLAIN, " r1=\"2\" r2=\"0.5\"").radii, [2.0, 0.5]);
    assert_eq!(read(PLAIN, " r1=\"2\"").radii, [2.0, 2.0]);
    assert_eq!(read(PLAIN, "").caps, [Cap::Round; 2]);
    assert_eq!(read("radius=\"1\" cap=\"butt\"", "").caps, [Cap::Flat; 2]);
    assert_eq!(
        read("radius=\"1\" cap=\"hemisphere\"", " cap2=\"butt\"").caps,
        [Cap::Round, Cap::Flat]
    );
}

#[test]
fn units_transforms_and_components_place_lattices() {
    // Half an inch to a side; mirrored once.
    let objects = lattice(4, PLAIN, "")
        + "<object id=\"5\"><components>\
           <component objectid=\"4\" transform=\"0 0.05 0 -0.05 0 0 0 0 0.05 1 0 0\"/>\
           <component objectid=\"4\" transform=\"-0.05 0 0 0 0.05 0 0 0 0.05 9 0 0\"/>\
           </components></object>";
    let item = "<item objectid=\"5\" transform=\"1 0 0 0 1 0 0 0 1 0 0 2\"/>";
    let graph = graph("a.3mf", single("inch", &with_item(&objects, item)));
    check(&graph);
    assert_eq!(graph.limbs.len(), 24);
    assert_eq!(graph.facts().components, 2);
    for i in 0..24 {
        assert!((graph.length(i) - 12.7).abs() < 1e-9);
        assert!(
            graph.limbs[i]
                .radii
                .iter()
                .all(|radius| (radius - 1.27).abs() < 1e-9)
        );
    }
    // (x, y) goes to (1 - y/20, x/20), and to (9 - x/20, y/20).
    for p in [
        [1.0, 0.5, 2.0],
        [0.5, 0.0, 2.0],
        [8.5, 0.0, 2.5],
        [9.0, 0.5, 2.0],
    ] {
        let place = DVec3::from(p) * 25.4;
        let mut nodes = graph.nodes.iter();
        assert!(
            nodes.any(|node| node.position.distance(place) < 1e-9),
            "{p:?}"
        );
    }
    let uneven = "<item objectid=\"4\" transform=\"1 0 0 0 1 0 0 0 8 0 0 0\"/>";
    let graph = crate::common::graph(
        "a.3mf",
        single("micron", &with_item(&lattice(4, PLAIN, ""), uneven)),
    );
    assert!(
        (graph.limbs[0].radii[0] - 0.002).abs() < 1e-12,
        "the cube root of 8, micrometres"
    );
    assert!(remarks(&graph)[0].starts_with("1 lattices are scaled unevenly"));
}

#[test]
fn parts_of_the_production_extension_are_followed() {
    let main = model(
        "millimeter",
        &with_item(
            "<object id=\"1\"><components>\
             <component p:path=\"/3D/Objects/Cage.model\" objectid=\"4\"/>\
             <component p:path=\"/3D/Objects/Cage.model\" objectid=\"4\" \
             transform=\"1 0 0 0 1 0 0 0 1 10 0 0\"/></components></object>",
            "<item objectid=\"1\"/><item p:path=\"/3D/inches.model\" objectid=\"7\"/>",
        ),
    );
    let cage = model("millimeter", &with_item(&lattice(4, PLAIN, ""), ""));
    let inches = model(
        "inch",
        &with_item(&lattice(7, PLAIN, ""), "<item objectid=\"7\"/>"),
    );
    let parts = [
        ("3D/main.model", &main[..]),
        ("3D/Objects/cage.model", &cage),
        ("3D/inches.model", &inches),
    ];
    let graph = graph("a.3mf", package(&parts));
    check(&graph);
    // The two cages share a face, whose limbs count once; the third touches a corner of them.
    assert_eq!(graph.limbs.len(), 12 + 8 + 12);
    assert!(remarks(&graph)[0].starts_with("4 limbs are listed more than once"));
    let longest = (0..graph.limbs.len())
        .map(|i| graph.length(i))
        .fold(0.0, f64::max);
    assert_eq!(longest, 254.0);
    assert!(message("a.3mf", package(&parts[..2])).contains("no part `3d/inches.model`"));
}

#[test]
fn clipping_meshes_come_along() {
    let cutter = format!(
        "<object id=\"2\"><mesh>{}<triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"/>\
         <triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles></mesh></object>",
        vertices()
    );
    for (mode, side) in [
        ("clippingmode=\"inside\"", Some(Side::Inside)),
        ("clipping=\"outside\"", Some(Side::Outside)),
        ("clippingmode=\"none\"", None),
    ] {
        let attributes = format!("{PLAIN} {mode} clippingmesh=\"2\"");
        let content = with_item(
            &(cutter.clone() + &lattice(4, &attributes, "")),
            "<item objectid=\"4\" transform=\"1 0 0 0 1 0 0 0 1 0 0 5\"/>",
        );
        let graph = graph("a.3mf", single("centimeter", &content));
        check(&graph);
        assert_eq!(graph.clips.first().map(|clip| clip.side), side);
        let index = side.map(|_| 0);
        assert!(graph.limbs.iter().all(|limb| limb.clip == index));
        if let Some(clip) = graph.clips.first() {
            assert_eq!(clip.mesh.triangles.len(), 2);
            assert_eq!(clip.mesh.positions[3], DVec3::new(100.0, 100.0, 50.0));
            assert!(remarks(&graph)[0].starts_with("1 lattices have a mesh that clips them"));
        }
    }
}

#[test]
fn clipping_meshes_are_bounded_together() {
    let cutter = format!(
        "<object id=\"2\"><mesh>{}<triangles>{}</triangles></mesh></object>",
        vertices(),
        "<triangle v1=\"0\" v2=\"2\" v3=\"1\"/>".repeat(2_000)
    );
    let attributes = format!("{PLAIN} clippingmode=\"inside\" clippingmesh=\"2\"");
    let objects = cutter + &lattice(4, &attributes, "");
    let [few, many] = [10, 1_100].map(|count| "<item objectid=\"4\"/>".repeat(count));
    let few = graph("a.3mf", single("centimeter", &with_item(&objects, &few)));
    assert_eq!(few.clips.len(), 10);
    let many = single("centimeter", &with_item(&objects, &many));
    assert!(message("a.3mf", many).contains("the meshes that clip lattices have more than"));
}

#[test]
fn materials_and_balls_are_read() {
    let objects = "<basematerials id=\"1\"><base name=\"steel\" displaycolor=\"#8090A0\"/>\
                   <base name=\"a &lt; b\" displaycolor=\"#FF0000FF\"/></basematerials>"
        .to_owned()
        + &lattice(
            4,
            "radius=\"1\" pid=\"1\" pindex=\"0\" ballmode=\"mixed\" ballradius=\"3\"",
            "",
        )
        .replacen("v2=\"1\"", "v2=\"1\" pid=\"1\" p1=\"1\"", 1)
        .replace(
            "</b:beams>",
            "</b:beams><b2:balls><b2:ball vindex=\"7\"/><b2:ball vindex=\"0\" r=\"2\"/></b2:balls>",
        );
    let graph = graph(
        "a.3mf",
        single("millimeter", &with_item(&objects, "<item objectid=\"4\"/>")),
    );
    check(&graph);
    let names = [0, 1].map(|limb| &graph.groups[graph.limbs[limb].group as usize].name[..]);
    assert_eq!(names, ["a < b", "steel"]);
    assert_eq!(
        graph.groups[graph.limbs[0].group as usize].color,
        Some([1.0, 0.0, 0.0])
    );
    let balls: Vec<f64> = graph
        .nodes
        .iter()
        .filter(|node| node.is_ball)
        .map(|node| node.radius)
        .collect();
    assert_eq!(balls, [2.0, 3.0]);
}

/// Returns what is said of a description in which something is replaced.
fn message_of(good: &str, from: &str, to: &str) -> String {
    let text = good.replacen(from, to, 1);
    assert_ne!(text, good, "{from}");
    message("a.3mf", package(&[("x.model", &text)]))
}

#[test]
fn faults_are_told() {
    let good = model(
        "millimeter",
        &with_item(&lattice(4, PLAIN, ""), "<item objectid=\"4\"/>"),
    );
    assert!(message_of(&good, "v1=\"0\"", "v1=\"99\"").contains("vertex 99 (from 0) of 8"));
    assert!(
        message_of(&good, "v1=\"0\"", "v1=\"x\"")
            .starts_with("line 3: a `beam` of this 3MF file has no number `v1`")
    );
    assert!(message_of(&good, "radius=\"1\"", "radius=\"-1\"").contains("no number `radius`"));
    assert!(message_of(&good, "radius=\"1\"", "radius=\"NaN\"").contains("no number `radius`"));
    assert!(message_of(&good, "x=\"10\"", "x=\"inf\"").contains("coordinates must be"));
    assert!(message_of(&good, "</b:beams>", "").contains("broken"));
    assert!(message_of(&good, "objectid=\"4\"", "objectid=\"5\"").contains("no object 5"));
    assert!(
        message_of(&good, "<model ", "<!DOCTYPE m [<!ENTITY a \"b\">]><model ")
            .contains("document type")
    );
    assert!(
        message_of(&good, "name=\"cage\"", "name=\"&boom;\"")
            .contains("line 3: this XML is broken")
    );
    let cut = &good[..good.len() / 2];
    assert!(message("a.3mf", package(&[("x.model", cut)])).contains("broken"));
    let cut = good.strip_suffix("</model>").unwrap();
    assert!(message("a.3mf", package(&[("x.model", cut)])).contains("cut off"));
    let zip = package(&[("x.model", &good)]);
    assert!(message("a.3mf", &zip[..zip.len() / 2]).contains("cut off or no zip"));
    // Objects in each other, across parts.
    let one = "<object id=\"1\"><components><component p:path=\"/b.model\" \
     objectid=\"1\"/></components></object>";
    let two = one.replace("/b.model", "/a.model");
    let circle = [
        (
            "a.model",
            &model("millimeter", &with_item(one, "<item objectid=\"1\"/>"))[..],
        ),
        ("b.model", &model("millimeter", &with_item(&two, ""))),
    ];
    assert!(message("a.3mf", package(&circle)).contains("contains itself"));
    // Objects that double what they hold, over and over.
    let mut doubling = lattice(1, PLAIN, "");
    for i in 2..40 {
        let inner = format!("<component objectid=\"{}\"/>", i - 1);
        let _ = write!(
            doubling,
            "<object id=\"{i}\"><components>{inner}{inner}</components></object>"
        );
    }
    let content = with_item(&doubling, "<item objectid=\"39\"/>");
    let told = message("a.3mf", single("millimeter", &content));
    assert!(told.contains("more than"), "{told}");
    // Many zeros, packed to little.
    let bomb = format!("<model>{}</model>", " ".repeat(mesh::limits::MAX_XML));
    assert!(message("a.3mf", package(&[("x.model", &bomb)])).contains("when it is unpacked"));
}

#[test]
fn a_package_without_beams_is_none() {
    let content = with_item(
        &format!(
            "<object id=\"1\"><mesh>{}<triangles><triangle v1=\"0\" v2=\"1\" \
             v3=\"2\"/></triangles></mesh></object>",
            vertices()
        ),
        "<item objectid=\"1\"/>",
    );
    let none = limbs::read(
        "a.3mf",
        &single("millimeter", &content),
        &Reading::default(),
    );
    assert_eq!(none, Ok(None));
}

#[test]
fn lattices_that_touch_are_joined_there() {
    let items =
        "<item objectid=\"4\"/><item objectid=\"4\" transform=\"1 0 0 0 1 0 0 0 1 10 10 10\"/>";
    let graph = graph(
        "a.3mf",
        single("millimeter", &with_item(&lattice(4, PLAIN, ""), items)),
    );
    assert_eq!((graph.nodes.len(), graph.limbs.len()), (15, 24));
    assert_eq!(graph.facts().components, 1);
    assert_eq!(drawing(&graph).len(), 24);
}
