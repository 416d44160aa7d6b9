//! GLB: a scene of nodes that place meshes, described in JSON, followed by one block of numbers.
//!
//! All triangles of the scene are read, each where its node puts it, with vertex colours, and of
//! the materials name, base colour and roughness; textures, cameras, skins and animations are
//! passed over. Numbers may be quantised (KHR_mesh_quantization), sparse, or packed by meshopt's
//! codecs (EXT_meshopt_compression), nodes may show their mesh many times
//! (EXT_mesh_gpu_instancing). What else the file says must be understood to read it is refused by
//! name.

use super::cursor::Cursor;
use crate::error::{Error, fail};
use crate::limits::{MAX_JSON, MAX_MATERIALS, MAX_TRIANGLES, MAX_VERTICES};
use crate::triangle_mesh::{Group, Material, TriangleMesh};
use glam::{DAffine3, DMat4, DQuat, DVec3};
use meshoptimizer_rs::Workspace;
use meshoptimizer_rs::codec::{BufferView, Filter, Mode};
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
    extensions: NodeExtensions,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct NodeExtensions {
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    instancing: Option<Instancing>,
}

/// Places at which a node shows its mesh, instead of once.
#[derive(Deserialize, Default)]
#[serde(default)]
struct Instancing {
    attributes: InstanceAttributes,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "UPPERCASE", default)]
struct InstanceAttributes {
    translation: Option<usize>,
    rotation: Option<usize>,
    scale: Option<usize>,
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
    extensions: PrimitiveExtensions,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct PrimitiveExtensions {
    #[serde(rename = "KHR_draco_mesh_compression")]
    draco: Option<serde::de::IgnoredAny>,
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
    normalized: bool,
    sparse: Option<Sparse>,
}

/// Values that replace some of an accessor's.
#[derive(Deserialize, Default)]
#[serde(default)]
struct Sparse {
    count: usize,
    indices: SparseList,
    values: SparseList,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
struct SparseList {
    buffer_view: usize,
    byte_offset: usize,
    component_type: u32,
}

#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
struct View {
    buffer: usize,
    byte_offset: usize,
    byte_length: usize,
    byte_stride: Option<usize>,
    extensions: ViewExtensions,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct ViewExtensions {
    #[serde(rename = "EXT_meshopt_compression")]
    meshopt: Option<Packed>,
}

/// Packed bytes of a view.
#[derive(Deserialize, Default)]
#[serde(rename_all = "camelCase", default)]
struct Packed {
    buffer: usize,
    byte_offset: usize,
    byte_length: usize,
    byte_stride: usize,
    count: usize,
    mode: String,
    filter: Option<String>,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct Buffer {
    uri: Option<String>,
}

/// Numbers of the component types.
const I8: u32 = 5120;
const U8: u32 = 5121;
const I16: u32 = 5122;
const U16: u32 = 5123;
const U32: u32 = 5125;
const F32: u32 = 5126;

/// Bytes of all views of a file that are packed, when they are unpacked.
const MAX_UNPACKED: usize = 64 * 1024 * 1024;

/// Extensions that are read, and those that change nothing about where triangles are.
fn is_known(extension: &str) -> bool {
    extension.starts_with("KHR_materials_")
        || extension.starts_with("EXT_texture_")
        || matches!(
            extension,
            "EXT_mesh_gpu_instancing"
                | "EXT_meshopt_compression"
                | "KHR_mesh_quantization"
                | "KHR_texture_basisu"
                | "KHR_texture_transform"
        )
}

pub(crate) fn read(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    let (json, numbers) = chunks(bytes)?;
    let file: File = serde_json::from_slice(json)
        .map_err(|error| Error(format!("the description in this GLB is broken: {error}")))?;
    if let Some(name) = file.extensions_required.iter().find(|e| !is_known(e)) {
        let name: String = name.chars().take(60).collect();
        return fail(format!(
            "this GLB needs the extension {name}, which is not read; save it without compression"
        ));
    }
    let unpacked = unpack(&file, numbers)?;
    let reader = Reader {
        file,
        numbers,
        unpacked,
    };
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
            if primitive.extensions.draco.is_some() && reader.is_bare(primitive) {
                return fail(
                    "this GLB is packed by KHR_draco_mesh_compression, which is not read; save \
                     it without compression",
                );
            }
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
    /// Content of the views that are packed.
    unpacked: Vec<Option<Vec<u8>>>,
}

/// Unpacks the views that are packed by meshopt's codecs.
fn unpack(file: &File, numbers: &[u8]) -> Result<Vec<Option<Vec<u8>>>, Error> {
    let mut rest = MAX_UNPACKED;
    let mut unpacked = Vec::new();
    for (i, view) in file.buffer_views.iter().enumerate() {
        let Some(packed) = &view.extensions.meshopt else {
            unpacked.push(None);
            continue;
        };
        let size = packed.count.checked_mul(packed.byte_stride);
        let Some(left) = size.and_then(|size| rest.checked_sub(size)) else {
            return fail(format!(
                "the packed views of this GLB have more than {MAX_UNPACKED} bytes"
            ));
        };
        rest = left;
        let end = packed.byte_offset.checked_add(packed.byte_length);
        let bytes = end.and_then(|end| numbers.get(packed.byte_offset..end));
        let Some(bytes) = bytes.filter(|_| packed.buffer == 0) else {
            return fail(format!(
                "view {i} (from 0) of this GLB is packed and reads beyond its end"
            ));
        };
        let view = view_content(packed, bytes).map_err(|error| {
            Error(format!(
                "view {i} (from 0) of this GLB cannot be unpacked: {error}"
            ))
        })?;
        unpacked.push(Some(view));
    }
    Ok(unpacked)
}

/// Unpacks a view.
fn view_content(packed: &Packed, bytes: &[u8]) -> Result<Vec<u8>, meshoptimizer_rs::Error> {
    let mode = Mode::parse(&packed.mode)?;
    let filter = Filter::parse(packed.filter.as_deref().unwrap_or("NONE"))?;
    let view = BufferView::new(mode, filter, packed.count, packed.byte_stride)?;
    view.decode(bytes, &mut Workspace::default())
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
            match &node.extensions.instancing {
                Some(instancing) if node.mesh.is_some() => {
                    let instances = self.instances(&instancing.attributes)?;
                    placed.extend(instances.into_iter().map(|instance| (i, place * instance)));
                    if placed.len() > MAX_TRIANGLES {
                        return fail(format!("this GLB has more than {MAX_TRIANGLES} parts"));
                    }
                }
                _ => placed.push((i, place)),
            }
            to_do.extend(node.children.iter().rev().map(|child| (*child, place)));
        }
        Ok(placed)
    }

    /// Returns the maps of a node's instances, to the node.
    fn instances(&self, attributes: &InstanceAttributes) -> Result<Vec<DAffine3>, Error> {
        let [translations, rotations, scales] = [
            (attributes.translation, "VEC3"),
            (attributes.rotation, "VEC4"),
            (attributes.scale, "VEC3"),
        ]
        .map(|(accessor, shape)| match accessor {
            Some(accessor) => self.floats(accessor, &[shape]),
            None => Ok(Vec::new()),
        });
        let (translations, rotations, scales) = (translations?, rotations?, scales?);
        let lists = [(&translations, 3), (&rotations, 4), (&scales, 3)];
        let counts = lists.map(|(list, width)| list.len() / width);
        let count = counts.into_iter().max().unwrap_or(0);
        if counts.iter().any(|own| *own > 0 && *own != count) {
            return fail("a node of this GLB has not as many places as turns or scales");
        }
        let places = (0..count).map(|i| {
            let [shift, scale] = [&translations, &scales]
                .map(|list| list.get(3 * i..3 * i + 3).map(DVec3::from_slice));
            let turn = rotations.get(4 * i..4 * i + 4).map(DQuat::from_slice);
            DAffine3::from_scale_rotation_translation(
                scale.unwrap_or(DVec3::ONE),
                turn.filter(|turn| turn.length() > 0.0)
                    .map_or(DQuat::IDENTITY, DQuat::normalize),
                shift.unwrap_or(DVec3::ZERO),
            )
        });
        Ok(places.collect())
    }

    /// Whether the positions of a part of a mesh are nowhere but in an extension.
    fn is_bare(&self, primitive: &Primitive) -> bool {
        let position = primitive.attributes.position;
        let accessor = position.and_then(|i| self.file.accessors.get(i));
        accessor.is_none_or(|accessor| accessor.buffer_view.is_none() && accessor.sparse.is_none())
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
        for (i, w) in corners.windows(3).enumerate() {
            let [a, b, c] = match mode {
                4 if i % 3 == 0 => [w[0], w[1], w[2]],
                4 => continue,
                // In a strip every second triangle runs the other way.
                5 if i % 2 == 0 => [w[0], w[1], w[2]],
                5 => [w[1], w[0], w[2]],
                6 => [corners[0], w[1], w[2]],
                _ => break,
            };
            let [b, c] = if is_mirrored { [c, b] } else { [b, c] };
            mesh.add_triangle([a, b, c].map(|i| start + i))?;
        }
        Ok(())
    }

    /// Returns the bytes of a view.
    fn view(&self, i: usize) -> Result<&[u8], Error> {
        let view = get(&self.file.buffer_views, i, "buffer view")?;
        if let Some(content) = &self.unpacked[i] {
            return Ok(content);
        }
        let is_elsewhere = get(&self.file.buffers, view.buffer, "buffer")?
            .uri
            .is_some();
        if view.buffer != 0 || is_elsewhere {
            return fail("this GLB keeps its numbers in another file; save it with them inside");
        }
        let end = view.byte_offset.checked_add(view.byte_length);
        let bytes = end.and_then(|end| self.numbers.get(view.byte_offset..end));
        bytes.ok_or_else(|| {
            Error(format!(
                "buffer view {i} (from 0) of this GLB reads beyond its end"
            ))
        })
    }

    /// Reads numbers of a type from a view: `count` times `width` of them.
    fn list(
        &self,
        accessor: usize,
        list: &SparseList,
        [count, width]: [usize; 2],
    ) -> Result<Vec<f64>, Error> {
        let kind = list.component_type;
        let size = size_of(kind).ok_or_else(|| {
            Error(format!(
                "accessor {accessor} (from 0) of this GLB has the unknown type {kind}"
            ))
        })?;
        let bytes = self.view(list.buffer_view)?.get(list.byte_offset..);
        let packed = self.file.buffer_views[list.buffer_view]
            .extensions
            .meshopt
            .as_ref();
        let stride = match packed {
            Some(packed) => packed.byte_stride,
            None => self.file.buffer_views[list.buffer_view]
                .byte_stride
                .unwrap_or(size * width),
        };
        let needed = match count {
            0 => Some(0),
            n => stride
                .checked_mul(n - 1)
                .and_then(|all| all.checked_add(size * width)),
        };
        let Some(bytes) = bytes.filter(|bytes| {
            stride >= size * width && needed.is_some_and(|needed| needed <= bytes.len())
        }) else {
            return fail(format!(
                "accessor {accessor} (from 0) of this GLB reads beyond its end"
            ));
        };
        let mut numbers = Vec::with_capacity(count * width);
        for row in 0..count {
            let row = &bytes[row * stride..row * stride + size * width];
            numbers.extend(row.chunks_exact(size).map(|chunk| number(kind, chunk)));
        }
        Ok(numbers)
    }

    /// Reads the numbers of an accessor as they stand in the file, in one of some shapes.
    fn numbers(&self, i: usize, shapes: &[&str]) -> Result<Vec<f64>, Error> {
        let accessor = get(&self.file.accessors, i, "accessor")?;
        let shape = accessor.shape.as_str();
        if !shapes.contains(&shape) {
            return fail(format!(
                "accessor {i} (from 0) of this GLB is `{}` where {} is needed",
                shape.chars().take(20).collect::<String>(),
                shapes.join(" or ")
            ));
        }
        let width = match shape {
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 1,
        };
        let count = accessor.count;
        let sparse = accessor.sparse.as_ref();
        if count > MAX_VERTICES || sparse.is_some_and(|sparse| sparse.count > count) {
            return fail(format!(
                "accessor {i} (from 0) of this GLB has {count} values, more than the \
                 {MAX_VERTICES} that are taken, or fewer than it replaces"
            ));
        }
        let mut numbers = match accessor.buffer_view {
            Some(buffer_view) => {
                let list = SparseList {
                    buffer_view,
                    byte_offset: accessor.byte_offset,
                    component_type: accessor.component_type,
                };
                self.list(i, &list, [count, width])?
            }
            None => vec![0.0; count * width],
        };
        if let Some(sparse) = sparse {
            let places = self.list(i, &sparse.indices, [sparse.count, 1])?;
            let list = SparseList {
                component_type: accessor.component_type,
                ..sparse.values
            };
            let values = self.list(i, &list, [sparse.count, width])?;
            for (place, value) in places.into_iter().zip(values.chunks_exact(width)) {
                let start = place as usize * width;
                let Some(own) = numbers.get_mut(start..start + width) else {
                    return fail(format!(
                        "accessor {i} (from 0) of this GLB replaces value {place} of {count}"
                    ));
                };
                own.copy_from_slice(value);
            }
        }
        Ok(numbers)
    }

    /// Reads the numbers of an accessor; normalised ones are shares of the largest of their type.
    fn floats(&self, i: usize, shapes: &[&str]) -> Result<Vec<f64>, Error> {
        let mut numbers = self.numbers(i, shapes)?;
        let accessor = &self.file.accessors[i];
        let largest = match accessor.component_type {
            I8 => 127.0,
            U8 => 255.0,
            I16 => 32_767.0,
            U16 => 65_535.0,
            _ => 1.0,
        };
        if accessor.normalized && largest > 1.0 {
            for number in &mut numbers {
                *number = (*number / largest).max(-1.0);
            }
        }
        Ok(numbers)
    }

    fn vectors(&self, i: usize) -> Result<Vec<DVec3>, Error> {
        let numbers = self.floats(i, &["VEC3"])?;
        Ok(numbers.chunks_exact(3).map(DVec3::from_slice).collect())
    }

    /// Reads linear colours, as floats or as shares of the largest whole number.
    fn colors(&self, i: usize) -> Result<Vec<[f32; 3]>, Error> {
        let numbers = self.numbers(i, &["VEC3", "VEC4"])?;
        let accessor = &self.file.accessors[i];
        let width = if accessor.shape == "VEC3" { 3 } else { 4 };
        let largest = match accessor.component_type {
            U8 => 255.0,
            U16 => 65_535.0,
            F32 => 1.0,
            _ => {
                return fail(format!(
                    "accessor {i} (from 0) of this GLB is no list of colours"
                ));
            }
        };
        let colors = numbers.chunks_exact(width);
        Ok(colors
            .map(|color| [0, 1, 2].map(|channel| (color[channel] / largest) as f32))
            .collect())
    }

    fn indices(&self, i: usize) -> Result<Vec<u32>, Error> {
        let accessor = get(&self.file.accessors, i, "accessor")?;
        if !matches!(accessor.component_type, U8 | U16 | U32) {
            return fail(format!(
                "accessor {i} (from 0) of this GLB is no list of indices"
            ));
        }
        let numbers = self.numbers(i, &["SCALAR"])?;
        Ok(numbers.into_iter().map(|number| number as u32).collect())
    }
}

/// Returns the number of bytes of a component type; `None` if there is no such type.
fn size_of(kind: u32) -> Option<usize> {
    Some(match kind {
        I8 | U8 => 1,
        I16 | U16 => 2,
        U32 | F32 => 4,
        _ => return None,
    })
}

/// Reads a number of a component type from as many bytes as it has.
fn number(kind: u32, bytes: &[u8]) -> f64 {
    let mut word = [0; 4];
    word[..bytes.len()].copy_from_slice(bytes);
    let word = u32::from_le_bytes(word);
    match kind {
        I8 => f64::from(word as i8),
        I16 => f64::from(word as i16),
        F32 => f64::from(f32::from_bits(word)),
        _ => f64::from(word),
    }
}
