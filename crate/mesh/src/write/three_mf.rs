//! 3MF: core specification with base materials, and colour groups of the materials extension.

use super::export::Export;
use super::prepared::{Prepared, materials};
use crate::color::srgb_from_linear;
use crate::error::Error;
use archive::Member;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fmt::Write;

const TYPES: &str = concat!(
    r#"<?xml version="1.0" encoding="UTF-8"?>"#,
    "\n",
    r#"<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">"#,
    r#"<Default Extension="rels" "#,
    r#"ContentType="application/vnd.openxmlformats-package.relationships+xml"/>"#,
    r#"<Default Extension="model" "#,
    r#"ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>"#,
    "\n",
);
const RELATIONS: &str = concat!(
    r#"<?xml version="1.0" encoding="UTF-8"?>"#,
    "\n",
    r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">"#,
    r#"<Relationship Target="/3D/3dmodel.model" Id="rel0" "#,
    r#"Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>"#,
    r#"</Relationships>"#,
    "\n",
);
const MODEL: &str = concat!(
    r#"<?xml version="1.0" encoding="UTF-8"?>"#,
    "\n",
    r#"<model unit="millimeter" xml:lang="en-US" "#,
    r#"xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" "#,
    r#"xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02">"#,
    "\n",
    r#"<resources>"#,
    "\n",
);
/// Numbers of the resources: base materials, colours, then the objects.
const MATERIALS: usize = 1;
const COLORS: usize = 2;
const FIRST_OBJECT: usize = 3;

pub(super) fn write(export: &Export, parts: &[Prepared<'_>]) -> Result<Vec<u8>, Error> {
    let mut text = String::from(MODEL);
    let materials = materials(export);
    if !materials.is_empty() {
        put(
            &mut text,
            format_args!("<basematerials id=\"{MATERIALS}\">\n"),
        );
        for material in &materials {
            let color = hex(material.color.map(srgb_from_linear));
            let name = escape(&material.name);
            put(
                &mut text,
                format_args!("<base name=\"{name}\" displaycolor=\"{color}\"/>\n"),
            );
        }
        text += "</basematerials>\n";
    }
    // Each colour once, in the order of its first use.
    let mut colors: BTreeMap<[u8; 3], usize> = BTreeMap::new();
    let mut listed = String::new();
    for color in parts
        .iter()
        .filter_map(|part| part.mesh.colors.as_ref())
        .flatten()
    {
        let color = color.map(srgb_from_linear);
        let next = colors.len();
        if let Entry::Vacant(place) = colors.entry(color) {
            place.insert(next);
            put(
                &mut listed,
                format_args!("<m:color color=\"{}\"/>\n", hex(color)),
            );
        }
    }
    if !colors.is_empty() {
        put(
            &mut text,
            format_args!("<m:colorgroup id=\"{COLORS}\">\n{listed}</m:colorgroup>\n"),
        );
    }
    for (number, part) in parts.iter().enumerate() {
        object(&mut text, FIRST_OBJECT + number, part, &colors);
    }
    text += "</resources>\n<build>\n";
    for number in 0..parts.len() {
        put(
            &mut text,
            format_args!("<item objectid=\"{}\"/>\n", FIRST_OBJECT + number),
        );
    }
    text += "</build>\n</model>\n";
    archive::write(&[
        Member::new("[Content_Types].xml", TYPES.as_bytes()),
        Member::new("_rels/.rels", RELATIONS.as_bytes()),
        Member::new("3D/3dmodel.model", text.as_bytes()),
    ])
    .map_err(|_| Error("this mesh is too large for a 3MF file; choose a larger tolerance".into()))
}

fn object(text: &mut String, id: usize, part: &Prepared<'_>, colors: &BTreeMap<[u8; 3], usize>) {
    let name = escape(part.name);
    put(
        text,
        format_args!("<object id=\"{id}\" type=\"model\" name=\"{name}\">\n<mesh>\n<vertices>\n"),
    );
    for [x, y, z] in &part.positions {
        put(
            text,
            format_args!("<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>\n"),
        );
    }
    text.push_str("</vertices>\n<triangles>\n");
    for segment in &part.segments {
        for triangle in &part.mesh.triangles[segment.triangles.clone()] {
            let [a, b, c] = triangle;
            put(
                text,
                format_args!("<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\""),
            );
            if let Some(own) = &part.mesh.colors {
                let [a, b, c] = triangle.map(|i| colors[&own[i as usize].map(srgb_from_linear)]);
                put(
                    text,
                    format_args!(" pid=\"{COLORS}\" p1=\"{a}\" p2=\"{b}\" p3=\"{c}\""),
                );
            } else if let Some(material) = segment.material {
                put(text, format_args!(" pid=\"{MATERIALS}\" p1=\"{material}\""));
            }
            text.push_str("/>\n");
        }
    }
    text.push_str("</triangles>\n</mesh>\n</object>\n");
}

fn put(text: &mut String, part: std::fmt::Arguments<'_>) {
    // Writing to a string does not fail.
    let _ = text.write_fmt(part);
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// Text for an attribute's value, without characters that XML forbids.
fn escape(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars().take(200) {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\u{fffe}' | '\u{ffff}' => {}
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}
