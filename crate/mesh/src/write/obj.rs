//! OBJ, and MTL beside it.

use super::export::Export;
use super::prepared::{Prepared, line_name, materials};
use super::shading::Shading;
use crate::color::{encode, phong_from_roughness};
use crate::triangle_mesh::Material;
use std::fmt::Write;

/// The text of the OBJ file, and that of the MTL file if there are materials.
pub(super) fn write(export: &Export, parts: &[Prepared<'_>]) -> (Vec<u8>, Option<Vec<u8>>) {
    let materials = materials(export);
    let names = unique_names(&materials);
    // Some readers want a colour for every vertex or for none.
    let has_colors = parts.iter().any(|part| part.mesh.colors.is_some());
    let mut text = String::from("# millimetres\n");
    if !materials.is_empty() {
        line(
            &mut text,
            format_args!("mtllib {}.mtl", line_name(&export.name, "mesh")),
        );
    }
    // Positions and normals are counted from 1.
    let (mut first, mut first_normal) = (1, 1);
    for (number, part) in parts.iter().enumerate() {
        let other = format!("part{}", number + 1);
        line(
            &mut text,
            format_args!("o {}", line_name(part.name, &other)),
        );
        let colors = if has_colors {
            part.colors(&materials)
        } else {
            Vec::new()
        };
        for (i, [x, y, z]) in part.positions.iter().enumerate() {
            match colors.get(i) {
                Some(color) => {
                    let [r, g, b] = color.map(encode);
                    line(
                        &mut text,
                        format_args!("v {x} {y} {z} {r:.4} {g:.4} {b:.4}"),
                    );
                }
                None => line(&mut text, format_args!("v {x} {y} {z}")),
            }
        }
        let shading = Shading::new(part.mesh);
        for [x, y, z] in &shading.normals {
            line(&mut text, format_args!("vn {x} {y} {z}"));
        }
        for segment in &part.segments {
            if !segment.name.is_empty() && segment.name != part.name {
                line(
                    &mut text,
                    format_args!("g {}", line_name(segment.name, &other)),
                );
            }
            match segment.material {
                Some(material) => line(&mut text, format_args!("usemtl {}", names[material])),
                // A material lasts until the next.
                None if !materials.is_empty() => line(&mut text, format_args!("usemtl default")),
                None => {}
            }
            let places = &part.mesh.triangles[segment.triangles.clone()];
            let normals = &shading.triangles[segment.triangles.clone()];
            for (triangle, normals) in places.iter().zip(normals) {
                let [a, b, c] = triangle.map(|i| i + first);
                let [n, o, p] = normals.map(|i| i + first_normal);
                line(&mut text, format_args!("f {a}//{n} {b}//{o} {c}//{p}"));
            }
        }
        first += part.positions.len() as u32;
        first_normal += shading.normals.len() as u32;
    }
    let library = (!materials.is_empty()).then(|| library(&materials, &names));
    (text.into_bytes(), library)
}

fn library(materials: &[&Material], names: &[String]) -> Vec<u8> {
    let mut text = String::new();
    let fallback = Material::default();
    let named = materials
        .iter()
        .copied()
        .zip(names.iter().map(String::as_str));
    for (material, name) in named.chain([(&fallback, "default")]) {
        let [r, g, b] = material.color.map(encode);
        let (shine, roughness) = (phong_from_roughness(material.roughness), material.roughness);
        line(&mut text, format_args!("newmtl {name}"));
        line(&mut text, format_args!("Kd {r:.4} {g:.4} {b:.4}"));
        line(&mut text, format_args!("Ns {shine:.3}"));
        line(&mut text, format_args!("Pr {roughness}"));
    }
    text.into_bytes()
}

/// Names of materials: no two alike, none `default`.
fn unique_names(materials: &[&Material]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (i, material) in materials.iter().enumerate() {
        let plain = line_name(&material.name, "material");

        let numbered = (0..=materials.len()).map(|n| match n {
            0 => plain.clone(),
            n => format!("{plain}.{n}"),
        });
        let free = numbered
            .into_iter()
            .find(|name| name != "default" && !names.contains(name));
        names.push(free.unwrap_or_else(|| format!("{plain}..{i}")));
    }
    names
}

fn line(text: &mut String, line: std::fmt::Arguments<'_>) {
    // Writing to a string does not fail.
    let _ = text.write_fmt(line);
    text.push('\n');
}
