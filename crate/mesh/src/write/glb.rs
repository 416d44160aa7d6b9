//! GLB: a description in JSON, then one block of numbers.

use super::export::Export;
use super::prepared::{Prepared, materials, put_floats};
use crate::error::{Error, fail};
use serde_json::{Value, json};

/// Numbers of glTF: component types, and what a buffer view is for.
const F32: u32 = 5126;
const U32: u32 = 5125;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// The description's lists, and the numbers.
#[derive(Default)]
struct Builder {
    numbers: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Builder {
    /// Ends a view of the numbers from a start on.
    fn view(&mut self, start: usize, target: u32) -> usize {
        let length = self.numbers.len() - start;
        self.views.push(json!({
            "buffer": 0, "byteOffset": start, "byteLength": length, "target": target
        }));
        self.views.len() - 1
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// A list of vectors, and the accessor of it; with its box for positions, where it is demanded.
    fn vectors(&mut self, vectors: &[[f32; 3]], with_box: bool) -> usize {
        let start = self.numbers.len();
        put_floats(&mut self.numbers, vectors.as_flattened());
        let view = self.view(start, VERTICES);
        let mut accessor = json!({
            "bufferView": view, "componentType": F32, "count": vectors.len(), "type": "VEC3"
        });
        if with_box {
            let fold = |k: usize, pick: fn(f32, f32) -> f32| {
                vectors.iter().map(|v| v[k]).reduce(pick).unwrap_or(0.0)
            };
            accessor["min"] = json!([0, 1, 2].map(|k| fold(k, f32::min)));
            accessor["max"] = json!([0, 1, 2].map(|k| fold(k, f32::max)));
        }
        self.accessor(accessor)
    }

    /// The primitives of a part: one for each segment.
    fn part(&mut self, part: &Prepared<'_>, plain: &[usize], white: &[usize]) -> Value {
        let mut attributes = json!({ "POSITION": self.vectors(&part.positions, true) });
        if let Some(normals) = &part.normals {
            attributes["NORMAL"] = json!(self.vectors(normals, false));
        }
        if let Some(colors) = &part.mesh.colors {
            let cut: Vec<[f32; 3]> = colors
                .iter()
                .map(|c| c.map(|x| if x > 0.0 { x.min(1.0) } else { 0.0 }))
                .collect();
            attributes["COLOR_0"] = json!(self.vectors(&cut, false));
        }
        let start = self.numbers.len();
        for i in part.mesh.triangles.as_flattened() {
            self.numbers.extend(i.to_le_bytes());
        }
        let view = self.view(start, INDICES);
        let mut primitives = Vec::new();
        for segment in &part.segments {
            let indices = self.accessor(json!({
                "bufferView": view, "byteOffset": 12 * segment.triangles.start,
                "componentType": U32, "count": 3 * segment.triangles.len(), "type": "SCALAR"
            }));
            let mut primitive = json!({ "attributes": attributes, "indices": indices });
            if let Some(material) = segment.material {
                let list = if part.mesh.colors.is_some() {
                    white
                } else {
                    plain
                };
                primitive["material"] = json!(list[material]);
            }
            primitives.push(primitive);
        }
        json!({ "name": part.name, "primitives": primitives })
    }
}

pub(super) fn write(export: &Export, parts: &[Prepared<'_>]) -> Result<Vec<u8>, Error> {
    let materials = materials(export);
    // Each as it is, and white for meshes with vertex colours, which multiply it; only those in use.
    let mut described = Vec::new();
    let mut list = |is_white: bool| -> Vec<usize> {
        let is_used = parts.iter().any(|p| p.mesh.colors.is_some() == is_white);
        let mut places = Vec::new();
        for material in materials.iter().filter(|_| is_used) {
            let [r, g, b] = if is_white { [1.0; 3] } else { material.color };
            places.push(described.len());
            described.push(json!({ "name": material.name, "pbrMetallicRoughness": {
                "baseColorFactor": [r, g, b, 1.0],
                "metallicFactor": 0.0,
                "roughnessFactor": material.roughness.clamp(0.0, 1.0)
            } }));
        }
        places
    };
    let [plain, white] = [list(false), list(true)];
    let mut builder = Builder::default();
    let meshes: Vec<Value> = parts
        .iter()
        .map(|part| builder.part(part, &plain, &white))
        .collect();
    let nodes: Vec<Value> = parts
        .iter()
        .enumerate()
        .map(|(i, part)| json!({ "name": part.name, "mesh": i, "scale": [0.001, 0.001, 0.001] }))
        .collect();
    let mut file = json!({
        "asset": { "version": "2.0", "generator": "Sinew" },
        "scene": 0,
        "scenes": [{ "nodes": (0..parts.len()).collect::<Vec<_>>() }],
        "nodes": nodes,
        "meshes": meshes,
        "accessors": builder.accessors,
        "bufferViews": builder.views,
        "buffers": [{ "byteLength": builder.numbers.len() }]
    });
    if !described.is_empty() {
        file["materials"] = json!(described);
    }
    let mut text = file.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let numbers = builder.numbers;
    let length = 12 + 8 + text.len() + 8 + numbers.len();
    let Ok(length) = u32::try_from(length) else {
        return fail("this mesh is too large for a GLB file; choose a larger tolerance");
    };
    let mut bytes = Vec::with_capacity(length as usize);
    bytes.extend(b"glTF");
    for word in [2, length, text.len() as u32] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend(b"JSON");
    bytes.extend(text);
    bytes.extend((numbers.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(numbers);
    Ok(bytes)
}
