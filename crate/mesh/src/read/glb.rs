//! GLB: a scene of nodes that place meshes, described in JSON, followed by one block of numbers.
//!
//! All triangles of the scene are read, each where its node puts it, with vertex colours, and of
//! the materials name, base colour and roughness; textures, cameras, skins and animations are
//! passed over. What the file says must be understood to read it (compression above all) is refused
//! by name.

use super::cursor::Cursor;
use crate::error::{Error, fail};
use crate::limits::{MAX_JSON, MAX_MATERIALS, MAX_TRIANGLES, MAX_VERTICES};
use crate::triangle_mesh::{Group, Material, TriangleMesh};
use glam::{DAffine3, DMat4, DQuat, DVec3};
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
#[derive(Default)]
struct File {
    extensions_required: Vec<String>,
    scene: usize,
    scenes: Vec<Scene>,
    nodes: Vec<Node>,
    meshes: Vec<Model>,
    materials: Vec<Surface>,
    accessors: Vec<Accessor>,
    buffer_views: Vec<View>,
    buffers: Vec<Buffer>,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct Scene {
    nodes: Vec<usize>,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct Node {
    name: String,
    children: Vec<usize>,
    mesh: Option<usize>,
    matrix: Option<Box<[f64; 16]>>,
    translation: Option<[f32; 3]>,
    rotation: Option<[f32; 4]>,
    scale: Option<[f32; 3]>,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct Model {
    name: String,
    primitives: Vec<Primitive>,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct Primitive {
    attributes: Attributes,
    indices: Option<usize>,
    mode: Option<u32>,
    material: Option<usize>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "UPPERCASE", default)]
struct Attributes {
    position: Option<usize>,
    normal: Option<usize>,
    #[serde(rename = "COLOR_0")]
    color: Option<usize>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
struct Surface {
    name: String,
    pbr_metallic_roughness: Reflection,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Reflection {
    base_color_factor: [f32; 4],
    roughness_factor: f32,
}

impl Default for Reflection {
    fn default() -> Self {
        Self {
            base_color_factor: [1.0; 4],
            roughness_factor: 1.0,
        }
    }
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
struct Accessor {
    buffer_view: Option<usize>,
    byte_offset: usize,
    component_type: u32,
    count: usize,
    #[serde(rename = "type")]
    shape: String,
    sparse: Option<serde::de::IgnoredAny>,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
struct View {
    buffer: usize,
    byte_offset: usize,
    byte_length: usize,
    byte_stride: Option<usize>,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct Buffer {
    uri: Option<String>,
}

/// Numbers of the component types.
const U8: u32 = 5121;
const U16: u32 = 5123;
const U32: u32 = 5125;
const F32: u32 = 5126;

/// Extensions that change nothing about where triangles are.
fn is_harmless(extension: &str) -> bool {
    extension.starts_with("KHR_materials_")
        || extension.starts_with("EXT_texture_")
        || matches!(extension, "KHR_texture_transform" | "KHR_texture_basisu")
}

pub(crate) fn read(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    let (json, numbers) = chunks(bytes)?;
    let file: File = serde_json::from_slice(json)
        .map_err(|error| Error(format!("the description in this GLB is broken: {error}")))?;
    if let Some(name) = file.extensions_required.iter().find(|e| !is_harmless(e)) {
        let name: String = name.chars().take(60).collect();
        return fail(format!(
            "this GLB needs the extension {name}, which is not read; save it without compression"
        ));
    }
    let reader = Reader { file, numbers };
    let mut mesh = TriangleMesh {
        normals: Some(Vec::new()),
        ..TriangleMesh::default()
    };
    let mut tally = 0;
    for (node, place) in reader.places()? {
        let Some(model) = reader.file.nodes[node].mesh else {
            continue;
        };
        let model = get(&reader.file.meshes, model, "mesh")?;
        for primitive in &model.primitives {
            // Many nodes may show a mesh of many parts.
            tally += 1;
            if tally > MAX_TRIANGLES {
                return fail(format!("this GLB has more than {MAX_TRIANGLES} parts"));
            }
            let start = mesh.triangles.len() as u32;
            reader.primitive(primitive, &place, &mut mesh)?;
            let node = &reader.file.nodes[node].name;
            let name = if node.is_empty() { &model.name } else { node };
            let material = match primitive.material {
                Some(i) => Some(material(get(&reader.file.materials, i, "material")?)),
                None => None,
            };
            let group = Group {
                name: name.clone(),
                material,
                triangles: start..mesh.triangles.len() as u32,
            };
            // Without a name and a material there is nothing to tell.
            let is_told = !group.name.is_empty() || group.material.is_some();
            if is_told && !group.triangles.is_empty() {
                if mesh.groups.len() == MAX_MATERIALS {
                    return fail(format!("this GLB has more than {MAX_MATERIALS} groups"));
                }
                mesh.groups.push(group);
            }
        }
    }
    Ok(mesh)
}

fn material(surface: &Surface) -> Material {
    let [r, g, b, _] = surface.pbr_metallic_roughness.base_color_factor;
    Material {
        name: surface.name.clone(),
        color: [r, g, b].map(|x| x.clamp(0.0, 1.0)),
        roughness: surface
            .pbr_metallic_roughness
            .roughness_factor
            .clamp(0.0, 1.0),
    }
}

/// Splits a file into its description and its numbers.
fn chunks(bytes: &[u8]) -> Result<(&[u8], &[u8]), Error> {
    let mut at = Cursor::new(bytes.get(4..).unwrap_or_default(), false);
    let mut next = || at.take().map(u32::from_le_bytes).ok_or_else(cut_off);
    let version = next()?;
    if version != 2 {
        return fail(format!(
            "this GLB is of version {version}; version 2 is read"
        ));
    }
    let _whole = next()?;
    let length = next()? as usize;
    if next()? != u32::from_le_bytes(*b"JSON") {
        return fail("this GLB does not begin with its description");
    }
    if length > MAX_JSON {
        return fail(format!(
            "the description in this GLB has {length} bytes, more than the {MAX_JSON} that are \
             taken"
        ));
    }
    // Twelve bytes of heading, eight before each chunk.
    let rest = &bytes[20..];
    let (json, rest) = rest.split_at_checked(length).ok_or_else(cut_off)?;
    if rest.len() < 8 {
        return Ok((json, &[]));
    }
    let (heading, numbers) = rest.split_at(8);
    let mut at = Cursor::new(heading, false);
    let length = at.take().map(u32::from_le_bytes).ok_or_else(cut_off)? as usize;
    let numbers = numbers.get(..length).ok_or_else(cut_off)?;
    let is_binary = heading[4..] == *b"BIN\0";
    Ok((json, if is_binary { numbers } else { &[] }))
}

fn cut_off() -> Error {
    Error("this GLB file is cut off".into())
}

fn get<'a, T>(list: &'a [T], i: usize, what: &str) -> Result<&'a T, Error> {
    list.get(i)
        .ok_or_else(|| Error(format!("this GLB has no {what} {i} (from 0)")))
}

impl Node {
    fn place(&self) -> DAffine3 {
        if let Some(matrix) = &self.matrix {
            return DAffine3::from_mat4(DMat4::from_cols_array(matrix));
        }
        let rotation = self.rotation.map_or(DQuat::IDENTITY, |q| {
            let q = DQuat::from_array(q.map(f64::from));
            if q.length() > 0.0 { q.normalize() } else { q }
        });
        DAffine3::from_scale_rotation_translation(
            self.scale.map_or(DVec3::ONE, double),
            rotation,
            self.translation.map_or(DVec3::ZERO, double),
        )
    }
}

/// Converts a vector to double precision.
fn double(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

struct Reader<'a> {
    file: File,
    numbers: &'a [u8],
}

impl Reader<'_> {
    /// The nodes of the scene, with the map from each to the world.
    fn places(&self) -> Result<Vec<(usize, DAffine3)>, Error> {
        let nodes = &self.file.nodes;
        let mut to_do: Vec<(usize, DAffine3)> = if self.file.scenes.is_empty() {
            // Without a scene, all nodes that are no other's child.
            let mut is_child = vec![false; nodes.len()];
            for child in nodes.iter().flat_map(|node| &node.children) {
                if let Some(flag) = is_child.get_mut(*child) {
                    *flag = true;
                }
            }
            let roots = (0..nodes.len()).filter(|i| !is_child[*i]);
            roots.map(|i| (i, DAffine3::IDENTITY)).collect()
        } else {
            let scene = get(&self.file.scenes, self.file.scene, "scene")?;
            let roots = scene.nodes.iter();
            roots.map(|i| (*i, DAffine3::IDENTITY)).collect()
        };
        to_do.reverse();
        let mut seen = vec![false; nodes.len()];
        let mut placed = Vec::new();
        while let Some((i, parent)) = to_do.pop() {
            let node = get(nodes, i, "node")?;
            // Nodes make a tree; where they do not, the file would have no end.
            if core::mem::replace(&mut seen[i], true) {
                return fail(format!("node {i} (from 0) of this GLB is in two places"));
            }
            let place = parent * node.place();
            placed.push((i, place));
            to_do.extend(node.children.iter().rev().map(|child| (*child, place)));
        }
        Ok(placed)
    }

    /// Adds the triangles of a part of a mesh.
    fn primitive(
        &self,
        primitive: &Primitive,
        place: &DAffine3,
        mesh: &mut TriangleMesh,
    ) -> Result<(), Error> {
        let mode = primitive.mode.unwrap_or(4);
        let Some(position) = primitive.attributes.position else {
            return Ok(());
        };
        // Points and lines have no faces.
        if !(4..=6).contains(&mode) {
            return Ok(());
        }
        let start = mesh.positions.len() as u32;
        let positions = self.vectors(position)?;
        let count = positions.len() as u32;
        for position in positions {
            mesh.add_vertex(place.transform_point3(position))?;
        }
        let normals = primitive.attributes.normal;
        match (&mut mesh.normals, normals) {
            (Some(all), Some(normals)) => {
                let turn = place.matrix3.inverse().transpose();
                let normals = self.vectors(normals)?;
                if normals.len() != count as usize {
                    return fail("a part of this GLB has not as many normals as corners");
                }
                all.extend(normals.into_iter().map(|n| (turn * n).normalize_or_zero()));
            }
            (all, _) => *all = None,
        }
        match (&mut mesh.colors, primitive.attributes.color) {
            (None, None) => {}
            (colors, color) => {
                // Parts without colours beside others with are white.
                let colors = colors.get_or_insert_default();
                colors.resize(start as usize, [1.0; 3]);
                if let Some(color) = color {
                    colors.extend(self.colors(color)?);
                }
                if colors.len() > mesh.positions.len() {
                    return fail("a part of this GLB has more colours than corners");
                }
                colors.resize(mesh.positions.len(), [1.0; 3]);
            }
        }
        let corners: Vec<u32> = match primitive.indices {
            Some(indices) => self.indices(indices)?,
            None => (0..count).collect(),
        };
        if let Some(beyond) = corners.iter().find(|i| **i >= count) {
            return fail(format!(
                "a triangle of this GLB has corner {beyond} (from 0) of {count}"
            ));
        }
        // A mirrored part is turned inside out.
        let is_mirrored = place.matrix3.determinant() < 0.0;
        let mut add = |[a, b, c]: [u32; 3]| {
            let [b, c] = if is_mirrored { [c, b] } else { [b, c] };
            mesh.add_triangle([a, b, c].map(|i| start + i))
        };
        if mode == 4 {
            for triangle in corners.chunks_exact(3) {
                add([triangle[0], triangle[1], triangle[2]])?;
            }
        }
        for (i, w) in corners.windows(3).enumerate() {
            match mode {
                // In a strip every second triangle runs the other way.
                5 if i % 2 == 0 => add([w[0], w[1], w[2]])?,
                5 => add([w[1], w[0], w[2]])?,
                6 => add([corners[0], w[1], w[2]])?,
                _ => break,
            }
        }
        Ok(())
    }

    /// The bytes that an accessor reads from, its count, and how far apart its values are; all of
    /// them are there.
    fn values(&self, i: usize, size: usize) -> Result<(&[u8], usize, usize), Error> {
        let accessor = get(&self.file.accessors, i, "accessor")?;
        let Some(view) = accessor.buffer_view.filter(|_| accessor.sparse.is_none()) else {
            return fail(format!(
                "accessor {i} (from 0) of this GLB is sparse, which is not read"
            ));
        };
        let view = get(&self.file.buffer_views, view, "buffer view")?;
        let is_elsewhere = get(&self.file.buffers, view.buffer, "buffer")?
            .uri
            .is_some();
        if view.buffer != 0 || is_elsewhere {
            return fail("this GLB keeps its numbers in another file; save it with them inside");
        }
        let stride = view.byte_stride.unwrap_or(size);
        let short = || {
            Error(format!(
                "accessor {i} (from 0) of this GLB reads beyond its end"
            ))
        };
        let end = view.byte_offset.checked_add(view.byte_length);
        let bytes = end
            .and_then(|end| self.numbers.get(view.byte_offset..end))
            .and_then(|bytes| bytes.get(accessor.byte_offset..))
            .ok_or_else(short)?;
        if accessor.count > MAX_VERTICES {
            return fail(format!(
                "accessor {i} (from 0) of this GLB has {} values, more than the {MAX_VERTICES} \
                 that are taken",
                accessor.count
            ));
        }
        let needed = match accessor.count {
            0 => Some(0),
            n => stride
                .checked_mul(n - 1)
                .and_then(|all| all.checked_add(size)),
        };
        if stride < size || needed.is_none_or(|needed| needed > bytes.len()) {
            return Err(short());
        }
        Ok((bytes, accessor.count, stride))
    }

    fn vectors(&self, i: usize) -> Result<Vec<DVec3>, Error> {
        let accessor = get(&self.file.accessors, i, "accessor")?;
        if accessor.component_type != F32 || accessor.shape != "VEC3" {
            return fail(format!(
                "accessor {i} (from 0) of this GLB is no list of three-dimensional floats"
            ));
        }
        let (bytes, count, stride) = self.values(i, 12)?;
        Ok((0..count)
            .map(|k| {
                let mut at = Cursor::new(&bytes[k * stride..], false);
                let mut next = || at.f32().unwrap_or(f64::NAN);
                DVec3::new(next(), next(), next())
            })
            .collect())
    }

    /// Linear colours, as floats or as shares of the largest whole number.
    fn colors(&self, i: usize) -> Result<Vec<[f32; 3]>, Error> {
        let accessor = get(&self.file.accessors, i, "accessor")?;
        let channels = match accessor.shape.as_str() {
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 0,
        };
        let size = match accessor.component_type {
            U8 => 1,
            U16 => 2,
            F32 => 4,
            _ => 0,
        };
        if channels * size == 0 {
            return fail(format!(
                "accessor {i} (from 0) of this GLB is no list of colours"
            ));
        }
        let (bytes, count, stride) = self.values(i, channels * size)?;
        let channel = |at: usize| match size {
            1 => f32::from(bytes[at]) / 255.0,
            2 => f32::from(u16::from_le_bytes([bytes[at], bytes[at + 1]])) / 65_535.0,
            _ => f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]),
        };
        Ok((0..count)
            .map(|k| [0, 1, 2].map(|c| channel(k * stride + c * size)))
            .collect())
    }

    fn indices(&self, i: usize) -> Result<Vec<u32>, Error> {
        let accessor = get(&self.file.accessors, i, "accessor")?;
        let size = match (accessor.component_type, accessor.shape.as_str()) {
            (U8, "SCALAR") => 1,
            (U16, "SCALAR") => 2,
            (U32, "SCALAR") => 4,
            _ => {
                return fail(format!(
                    "accessor {i} (from 0) of this GLB is no list of indices"
                ));
            }
        };
        let (bytes, count, stride) = self.values(i, size)?;
        Ok((0..count)
            .map(|k| {
                let mut word = [0; 4];
                word[..size].copy_from_slice(&bytes[k * stride..k * stride + size]);
                u32::from_le_bytes(word)
            })
            .collect())
    }
}
