//! MTL: materials beside an OBJ file. Their names, colours and gloss are read.

use crate::color::{decode, roughness_from_phong};
use crate::error::{Error, fail};
use crate::formats::text;
use crate::limits::{MAX_BYTES, MAX_MATERIALS};
use crate::triangle_mesh::{Material, TriangleMesh};

/// Reads the materials of an MTL file: `newmtl`, `Kd` (taken for sRGB), `Pr` or else `Ns`. Give
/// them to a mesh with [`TriangleMesh::set_materials`].
///
/// # Errors
/// If the file is over one of the [`crate::limits`], or numbers are missing.
pub fn read_mtl(bytes: &[u8]) -> Result<Vec<Material>, Error> {
    if bytes.len() > MAX_BYTES {
        return fail(format!("this MTL file has more than {MAX_BYTES} bytes"));
    }
    let text = text::decode(bytes);
    let mut materials: Vec<Material> = Vec::new();
    let mut has_roughness = false;
    for (line, number) in text.lines().zip(1_u64..) {
        let (word, rest) = line.trim().split_once([' ', '\t']).unwrap_or((line, ""));
        if word == "newmtl" {
            if materials.len() == MAX_MATERIALS {
                return fail(format!("more than {MAX_MATERIALS} materials"));
            }
            materials.push(Material {
                name: rest.trim().into(),
                ..Material::default()
            });
            has_roughness = false;
            continue;
        }
        let Some(material) = materials.last_mut() else {
            continue;
        };
        let mut numbers = rest.split_ascii_whitespace().map_while(|w| w.parse().ok());
        let mut next = || -> Result<f64, Error> {
            let value = numbers.next().filter(|x: &f64| x.is_finite());
            value.ok_or_else(|| Error(format!("line {number}: a number is missing")))
        };
        match word {
            "Kd" => material.color = [next()?, next()?, next()?].map(|x| decode(x.clamp(0.0, 1.0))),
            "Pr" => {
                material.roughness = next()?.clamp(0.0, 1.0) as f32;
                has_roughness = true;
            }
            "Ns" if !has_roughness => material.roughness = roughness_from_phong(next()?),
            _ => {}
        }
    }
    Ok(materials)
}

impl TriangleMesh {
    /// Replaces the materials of groups by those of the same name.
    pub fn set_materials(&mut self, materials: &[Material]) {
        for own in self.groups.iter_mut().filter_map(|g| g.material.as_mut()) {
            if let Some(material) = materials.iter().find(|m| m.name == own.name) {
                *own = material.clone();
            }
        }
    }
}
