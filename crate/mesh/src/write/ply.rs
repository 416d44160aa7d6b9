//! Binary PLY: all parts as one list.

use super::export::Export;
use super::prepared::{Prepared, materials, mean_normals, put_floats};
use crate::color::srgb_from_linear;

pub(super) fn write(export: &Export, parts: &[Prepared<'_>]) -> Vec<u8> {
    // All or none: parts without get the means of their triangles'.
    let has_normals = parts.iter().any(|part| part.normals.is_some());
    let has_colors = parts.iter().any(Prepared::is_colored);
    let vertices: usize = parts.iter().map(|part| part.positions.len()).sum();
    let faces: usize = parts.iter().map(|part| part.mesh.triangles.len()).sum();
    let mut heading = format!(
        "ply\nformat binary_little_endian 1.0\ncomment millimetres\nelement vertex {vertices}\n"
    );
    let mut properties = vec!["float x", "float y", "float z"];
    if has_normals {
        properties.extend(["float nx", "float ny", "float nz"]);
    }
    if has_colors {
        properties.extend(["uchar red", "uchar green", "uchar blue"]);
    }
    for property in properties {
        heading += &format!("property {property}\n");
    }
    heading +=
        &format!("element face {faces}\nproperty list uchar int vertex_indices\nend_header\n");
    let mut bytes = heading.into_bytes();
    let materials = materials(export);
    for part in parts {
        let colors = part.colors(&materials);
        let normals = match &part.normals {
            None if has_normals => Some(mean_normals(part.mesh)),
            own => own.clone(),
        };
        for (i, position) in part.positions.iter().enumerate() {
            put_floats(&mut bytes, position);
            if let Some(normals) = &normals {
                put_floats(&mut bytes, &normals[i]);
            }
            if has_colors {
                bytes.extend(colors[i].map(srgb_from_linear));
            }
        }
    }
    let mut first = 0;
    for part in parts {
        for triangle in &part.mesh.triangles {
            bytes.push(3);
            for i in triangle {
                bytes.extend((first + i).to_le_bytes());
            }
        }
        first += part.positions.len() as u32;
    }
    bytes
}
