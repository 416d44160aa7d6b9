//! A mesh of the true surface of a scene's soft elements, which the draft draws in place of their
//! offset surfaces.

use crate::instance::Units;
use crate::materials::{draft_colours, finite};
use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use scene::{Finish, Rgb, Scene};

/// Bytes of a vertex: its position (three `f32`), its normal (four signed 16-bit parts of 32767,
/// the last one unused), and three colours of four bytes each, parts of 255: ambient with the shine
/// of [`shine`], diffuse and specular.
pub const VERTEX: usize = 32;

/// Powers of two that the exponents of highlights span; as in `shaders/mesh.wgsl`.
const SHINE_OCTAVES: f32 = 12.0;

/// Triangles to be drawn: plain bytes, as the GPU takes them.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    /// Vertices of [`VERTEX`] bytes each.
    pub vertices: &'a [u8],
    /// The numbers of each triangle's three vertices, 32 bits each.
    pub triangles: &'a [u8],
    /// World position of the vertices' origin.
    pub origin: DVec3,
    /// World length of a unit of their positions, > 0.
    pub unit: f64,
}

/// The look of each finish of a scene as the draft shows it: ambient, diffuse and specular colours,
/// and the shine by [`shine`]; all from 0 to 1.
#[must_use]
pub fn looks(scene: &Scene) -> Vec<[f32; 10]> {
    let around = scene.background.mean();
    let looks = scene.finishes.iter().map(|finish| look(finish, around));
    looks.collect()
}

fn look(finish: &Finish, around: Rgb) -> [f32; 10] {
    let [ambient, diffuse] = draft_colours(finish, around);
    let colours = [ambient, diffuse, finish.specular].concat();
    core::array::from_fn(|i| match colours.get(i) {
        Some(channel) => finite(*channel).clamp(0.0, 1.0),
        None => shine(finish.shine),
    })
}

/// An exponent n of a highlight as log₂(n + 1)/12, 0 … 1.
fn shine(exponent: f32) -> f32 {
    (libm::log2f(finite(exponent).max(0.0) + 1.0) / SHINE_OCTAVES).min(1.0)
}

/// The place and scale of a mesh, a uniform of the vertex shader: the origin in two
/// single-precision parts, and the length of a unit of the vertices.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Placed {
    origin_high: [f32; 3],
    unit: f32,
    origin_low: [f32; 4],
}

/// A mesh on the GPU.
#[derive(Debug)]
pub(crate) struct Uploaded {
    vertices: wgpu::Buffer,
    triangles: wgpu::Buffer,
    placed: wgpu::Buffer,
    count: u32,
    origin: DVec3,
    unit: f64,
}

impl Uploaded {
    const CORNER: [wgpu::VertexAttribute; 5] = wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Snorm16x4, 2 => Unorm8x4, 3 => Unorm8x4, 4 => Unorm8x4,
    ];
    const PLACED: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![
        5 => Float32x4, 6 => Float32x4,
    ];
    /// The buffers that the shader reads.
    pub(crate) const LAYOUTS: [Option<wgpu::VertexBufferLayout<'static>>; 2] = [
        Some(wgpu::VertexBufferLayout {
            array_stride: VERTEX as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &Self::CORNER,
        }),
        Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<Placed>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &Self::PLACED,
        }),
    ];

    /// Uploads a mesh; `None` if there is nothing to draw, a triangle has a corner that is not
    /// there, or the device has no room.
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue, mesh: &Mesh<'_>) -> Option<Self> {
        let corners = mesh.vertices.len() / VERTEX;
        let numbers = mesh.triangles.chunks_exact(4);
        let most = numbers.filter_map(|n| n.try_into().ok().map(u32::from_le_bytes));
        let is_sound = mesh.vertices.len().is_multiple_of(VERTEX)
            && mesh.triangles.len().is_multiple_of(12)
            && most.max().is_some_and(|most| (most as usize) < corners)
            && mesh.origin.is_finite()
            && mesh.unit.is_finite()
            && mesh.unit > 0.0;
        let bytes = mesh.vertices.len().max(mesh.triangles.len());
        if !is_sound || bytes as u64 > device.limits().max_buffer_size {
            return None;
        }
        let buffer = |size: usize, usage: wgpu::BufferUsages| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("mesh"),
                size: size as u64,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let uploaded = Self {
            vertices: buffer(mesh.vertices.len(), wgpu::BufferUsages::VERTEX),
            triangles: buffer(mesh.triangles.len(), wgpu::BufferUsages::INDEX),
            placed: buffer(size_of::<Placed>(), wgpu::BufferUsages::VERTEX),
            count: u32::try_from(mesh.triangles.len() / 4).ok()?,
            origin: mesh.origin,
            unit: mesh.unit,
        };
        queue.write_buffer(&uploaded.vertices, 0, mesh.vertices);
        queue.write_buffer(&uploaded.triangles, 0, mesh.triangles);
        Some(uploaded)
    }

    /// Tells the shader where the mesh is in draft units.
    pub(crate) fn place(&self, queue: &wgpu::Queue, units: Units) {
        let (origin_high, [x, y, z]) = units.place(self.origin);
        let placed = Placed {
            origin_high,
            unit: (self.unit / units.radius) as f32,
            origin_low: [x, y, z, 0.0],
        };
        queue.write_buffer(&self.placed, 0, bytemuck::bytes_of(&placed));
    }

    /// Draws it with the pipeline and the bind groups already set.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, self.placed.slice(..));
        pass.set_index_buffer(self.triangles.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, 0..1);
    }
}
