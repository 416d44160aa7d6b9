//! Instance data of elements, and their buffers.

use crate::solid::{Kind, Solid};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec2Swizzles as _, Vec3};

/// An element as its vertex shader reads it; the fields are explained in `shaders/element.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct Instance {
    origin_high: [f32; 3],
    material: u32,
    origin_low: [f32; 3],
    unit: f32,
    rotation: [f32; 4],
    a: [f32; 4],
    b: [f32; 4],
    low: [f32; 3],
    high: [f32; 3],
}

impl Instance {
    pub(crate) const ATTRIBUTES: [wgpu::VertexAttribute; 9] = wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Uint32, 2 => Float32x3, 3 => Float32, 4 => Float32x4,
        5 => Float32x4, 6 => Float32x4, 7 => Float32x3, 8 => Float32x3,
    ];

    /// Packs a solid, `units` telling how draft units come from world coordinates.
    pub(crate) fn new(solid: &Solid, material: u32, units: Units) -> Self {
        let (origin_high, origin_low) = units.place(solid.origin);
        let [low, high] = solid.corners().map(|corner| corner.to_array());
        Self {
            origin_high,
            material,
            origin_low,
            // Tinier than f32 can hold is invisible anyway, but must not divide by zero.
            unit: ((solid.unit / units.radius) as f32).clamp(1e-30, 1e15),
            rotation: solid.rotation.as_quat().normalize().to_array(),
            a: solid.a.map(|x| x as f32),
            b: solid.b.map(|x| x as f32),
            low,
            high,
        }
    }
}

impl Solid {
    /// Returns the numbers `low` and `high` of the shaders: the corners of the box. A patch is
    /// covered by itself and needs no box, but has normals.
    pub(crate) fn corners(&self) -> [Vec3; 2] {
        if self.kind == Kind::Patch {
            let [[a, b], [c, d], [e, f]] = self.normals.map(fold);
            [Vec3::new(a, b, c), Vec3::new(d, e, f)]
        } else {
            [self.low, self.high].map(|corner| corner.as_vec3())
        }
    }
}

/// A unit vector as a point of the square onto which the octahedron |x| + |y| + |z| = 1 unfolds;
/// the lower half is folded outwards.
fn fold(v: DVec3) -> [f32; 2] {
    let flat = v.truncate() / v.abs().element_sum();
    let folded = (1.0 - flat.abs().yx()) * flat.map(|x| if x < 0.0 { -1.0 } else { 1.0 });
    let place = if v.z < 0.0 { folded } else { flat };
    place.as_vec2().to_array()
}

/// The map from world coordinates to draft units: the scene's middle is the origin, its radius 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Units {
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
}

impl Units {
    /// The farthest that anything can be from the scene's middle, in its radii: squares of such
    /// distances are still `f32`s.
    const FARTHEST: f64 = 1e15;

    /// A world position in draft units, as an `f32` and the rest that it leaves out.
    pub(crate) fn place(self, world: DVec3) -> ([f32; 3], [f32; 3]) {
        let place = ((world - self.center) / self.radius)
            .clamp(DVec3::splat(-Self::FARTHEST), DVec3::splat(Self::FARTHEST));
        let high: Vec3 = place.as_vec3();
        let low = (place - high.as_dvec3()).as_vec3();
        (high.to_array(), low.to_array())
    }
}

/// The instances of one kind, on the GPU. The buffer is kept while it is large enough: while a
/// slider is dragged, a new scene comes with every frame.
#[derive(Debug, Default)]
pub(crate) struct Instances {
    buffer: Option<wgpu::Buffer>,
    count: u32,
}

impl Instances {
    /// Returns the number of instances of one kind that a device can take.
    pub(crate) fn limit(device: &wgpu::Device) -> usize {
        let most = device.limits().max_buffer_size / size_of::<Instance>() as u64;
        usize::try_from(most).unwrap_or(usize::MAX)
    }

    /// Replaces the instances. There must be at most [`Self::limit`].
    pub(crate) fn write(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        kind: Kind,
        instances: &[Instance],
    ) {
        let bytes: &[u8] = bytemuck::cast_slice(instances);
        self.count = u32::try_from(instances.len()).expect("limited by MAX_ELEMENTS");
        if bytes.is_empty() {
            self.buffer = None;
            return;
        }
        let needed = bytes.len() as u64;
        // A buffer that is far too large is not kept: memory of an earlier scene is returned.
        let kept = self
            .buffer
            .take()
            .filter(|buffer| buffer.size() >= needed && buffer.size() / 4 <= needed.max(1 << 16));
        let buffer = kept.unwrap_or_else(|| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(kind.label()),
                size: needed
                    .next_power_of_two()
                    .min(device.limits().max_buffer_size & !3)
                    .max(needed),
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        });
        queue.write_buffer(&buffer, 0, bytes);
        self.buffer = Some(buffer);
    }

    /// Draws the instances with the pipeline and bind groups already set.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, vertices: u32) {
        if let Some(buffer) = &self.buffer {
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..vertices, 0..self.count);
        }
    }
}
