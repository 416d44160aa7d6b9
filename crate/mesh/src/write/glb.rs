//! GLB: a description in JSON, then one block of numbers.

use super::export::Export;
use super::prepared::{Prepared, materials, put_floats};
use super::rig::{Rig, Share};
use super::shading::Shading;
use crate::error::{Error, fail};
use serde_json::{Value, json};

/// Numbers of glTF: component types, and what a buffer view is for.
const F32: u32 = 5126;
const U32: u32 = 5125;
const U16: u32 = 5123;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// Lists of the description, and the numbers that they point to.
#[derive(Default)]
struct Builder {
    numbers: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Builder {
    /// Adds a buffer view of the numbers from a start to the present end, and returns its index.
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

    /// Adds a list of vectors, and returns the index of its accessor; with a box for positions,
    /// where it is demanded.
    fn vectors(&mut self, vectors: &[[f32; 3]], with_box: bool) -> usize {
        let start = self.numbers.len();
        put_floats(&mut self.numbers, vectors.as_flattened());
        let view = self.view(start, VERTICES);
        let mut accessor = json!({
            "bufferView": view, "componentType": F32, "count": vectors.len(), "type": "VEC3"
        });
        if with_box {
            let ends = [f32::min, f32::max].map(|pick: fn(f32, f32) -> f32| {
                [0, 1, 2].map(|k| vectors.iter().map(|v| v[k]).reduce(pick).unwrap_or(0.0))
            });
            accessor["min"] = json!(ends[0]);
            accessor["max"] = json!(ends[1]);
        }
        self.accessor(accessor)
    }

    /// The primitives of a part: one for each segment.
    fn part(
        &mut self,
        part: &Prepared<'_>,
        shares: Option<&[[Share; 4]]>,
        plain: &[usize],
        white: &[usize],
    ) -> Value {
        let shading = Shading::new(part.mesh);
        let of_origin = |list: &[[f32; 3]]| -> Vec<[f32; 3]> {
            let origins = shading.origins.iter();
            origins.map(|i| list[*i as usize]).collect()
        };
        let mut attributes = json!({
            "POSITION": self.vectors(&of_origin(&part.positions), true),
            "NORMAL": self.vectors(&shading.normals, false)
        });
        if let Some(colors) = &part.mesh.colors {
            let cut: Vec<[f32; 3]> = of_origin(colors)
                .iter()
                .map(|c| c.map(|x| if x > 0.0 { x.min(1.0) } else { 0.0 }))
                .collect();
            attributes["COLOR_0"] = json!(self.vectors(&cut, false));
        }
        if let Some(shares) = shares {
            let own = shading.origins.iter().flat_map(|i| shares[*i as usize]);
            let start = self.numbers.len();
            for (joint, _) in own.clone() {
                self.numbers.extend(joint.to_le_bytes());
            }
            let count = shading.origins.len();
            let view = self.view(start, VERTICES);
            attributes["JOINTS_0"] = json!(self.accessor(json!({
                "bufferView": view, "componentType": U16, "count": count, "type": "VEC4"
            })));
            let start = self.numbers.len();
            for (_, weight) in own {
                self.numbers.extend(weight.to_le_bytes());
            }
            let view = self.view(start, VERTICES);
            attributes["WEIGHTS_0"] = json!(self.accessor(json!({
                "bufferView": view, "componentType": F32, "count": count, "type": "VEC4"
            })));
        }
        let start = self.numbers.len();
        for i in shading.triangles.as_flattened() {
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

impl Builder {
    /// Adds numbers that are no vertices, and returns the index of their accessor.
    fn numbers(&mut self, numbers: &[f32], count: usize, kind: &str) -> usize {
        let start = self.numbers.len();
        put_floats(&mut self.numbers, numbers);
        let length = self.numbers.len() - start;
        self.views
            .push(json!({ "buffer": 0, "byteOffset": start, "byteLength": length }));
        let mut accessor = json!({
            "bufferView": self.views.len() - 1, "componentType": F32, "count": count, "type": kind
        });
        if kind == "SCALAR" {
            accessor["min"] = json!([numbers.iter().copied().reduce(f32::min)]);
            accessor["max"] = json!([numbers.iter().copied().reduce(f32::max)]);
        }
        self.accessor(accessor)
    }

    /// The nodes of the joints, the first of which has the number `first`; the skin, and the
    /// animation if there are two frames or more.
    fn rig(
        &mut self,
        rig: &Rig,
        millimetres: f64,
        first: usize,
    ) -> (Vec<Value>, Value, Option<Value>) {
        let rest = rig.rest();
        let local = rig.local(&rest, millimetres);
        let nodes = rig.joints.iter().enumerate().map(|(i, joint)| {
            let mut node = json!({ "name": joint.name, "translation": local[i].0 });
            let children: Vec<usize> = (0..rig.joints.len())
                .filter(|&other| rig.joints[other].parent == Some(i))
                .map(|other| first + other)
                .collect();
            if !children.is_empty() {
                node["children"] = json!(children);
            }
            node
        });
        let nodes = nodes.collect();
        let inverse: Vec<f32> = rig
            .joints
            .iter()
            .flat_map(|joint| {
                let [x, y, z] = (joint.place * -millimetres).to_array().map(|x| x as f32);
                [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., x, y, z, 1.]
            })
            .collect();
        let inverse = self.numbers(&inverse, rig.joints.len(), "MAT4");
        let joints: Vec<usize> = (0..rig.joints.len()).map(|i| first + i).collect();
        let skin = json!({
            "inverseBindMatrices": inverse, "joints": joints, "skeleton": first - 1
        });
        if rig.frames.len() < 2 {
            return (nodes, skin, None);
        }
        let times: Vec<f32> = (0..rig.frames.len())
            .map(|i| (i as f64 / rig.rate) as f32)
            .collect();
        let times = self.numbers(&times, rig.frames.len(), "SCALAR");
        let frames: Vec<_> = rig
            .frames
            .iter()
            .map(|frame| rig.local(frame, millimetres))
            .collect();
        let (mut samplers, mut channels) = (Vec::new(), Vec::new());
        for i in 0..rig.joints.len() {
            let places: Vec<f32> = frames.iter().flat_map(|frame| frame[i].0).collect();
            let turns: Vec<f32> = frames.iter().flat_map(|frame| frame[i].1).collect();
            let outputs = [
                ("translation", self.numbers(&places, frames.len(), "VEC3")),
                ("rotation", self.numbers(&turns, frames.len(), "VEC4")),
            ];
            for (path, output) in outputs {
                channels.push(json!({
                    "sampler": samplers.len(), "target": { "node": first + i, "path": path }
                }));
                samplers
                    .push(json!({ "input": times, "output": output, "interpolation": "LINEAR" }));
            }
        }
        let animation = json!({ "name": "motion", "samplers": samplers, "channels": channels });
        (nodes, skin, Some(animation))
    }
}

pub(super) fn write(
    export: &Export,
    parts: &[Prepared<'_>],
    rig: Option<&Rig>,
) -> Result<Vec<u8>, Error> {
    let materials = materials(export);
    // Each as it is, and white for meshes with vertex colours, which multiply it; only those in
    // use.
    let mut described = Vec::new();
    let [plain, white] = [false, true].map(|is_white| -> Vec<usize> {
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
    });
    let mut builder = Builder::default();
    let meshes: Vec<Value> = parts
        .iter()
        .enumerate()
        .map(|(i, part)| {
            let shares = rig.map(|rig| &rig.shares[i][..]);
            builder.part(part, shares, &plain, &white)
        })
        .collect();
    let scale = [0.001, 0.001, 0.001];
    let shift = (export.shift() * scale[0]).to_array();
    let mut nodes: Vec<Value> = parts
        .iter()
        .enumerate()
        .map(|(i, part)| match rig {
            // Joints alone place it.
            Some(_) => json!({ "name": part.name, "mesh": i, "skin": 0 }),
            None if shift == [0.0; 3] => {
                json!({ "name": part.name, "mesh": i, "scale": scale })
            }
            None => json!({
                "name": part.name, "mesh": i, "scale": scale, "translation": shift
            }),
        })
        .collect();
    let mut roots: Vec<usize> = (0..parts.len()).collect();
    let mut skeleton = None;
    if let Some(rig) = rig {
        let first = nodes.len() + 1;
        let (joints, skin, animation) = builder.rig(rig, export.millimetres, first);
        let top: Vec<usize> = (0..rig.joints.len())
            .filter(|&i| rig.joints[i].parent.is_none())
            .map(|i| first + i)
            .collect();
        roots.push(nodes.len());
        nodes.push(json!({ "name": "skeleton", "scale": scale, "children": top }));
        nodes.extend(joints);
        skeleton = Some((skin, animation));
    }
    let mut file = json!({
        "asset": { "version": "2.0", "generator": "Sinew" },
        "scene": 0,
        "scenes": [{ "nodes": roots }],
        "nodes": nodes,
        "meshes": meshes,
        "accessors": builder.accessors,
        "bufferViews": builder.views,
        "buffers": [{ "byteLength": builder.numbers.len() }]
    });
    if let Some((skin, animation)) = skeleton {
        file["skins"] = json!([skin]);
        if let Some(animation) = animation {
            file["animations"] = json!([animation]);
        }
    }
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
