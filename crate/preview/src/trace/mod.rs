//! The true surface, traced on the card.
//!
//! The functions of all bodies ([`scene::Scene::surfaces`]) are divided into cells ([`octree`]),
//! those that the surface passes with a cubic each ([`cubic`]) and, where that is not enough, with
//! the chart's formulas ([`formulas`]); hard shapes have a hierarchy of boxes ([`hierarchy`]). [`pack`] lays them out, and `shaders/scene.wgsl` sends a ray from the eye
//! through each pixel, and one from what it meets to each light. Nothing of it depends on the
//! camera: while one turns, only the view changes.

mod cubic;
mod formulas;
mod hierarchy;
mod octree;
mod pack;

use crate::bounds::Bounds;
use crate::materials;
use crate::pipelines::{layout, shader, texture, uniform, uniform_buffer};
use crate::view::{Air, Lights, Tone, View};
use bytemuck::{Pod, Zeroable};
use field::skeleton::Map;
use glam::DVec3;
use pack::{Frame, Packed};
use scene::{Camera, Scene, Unit};
use std::collections::BTreeSet;

/// The text that both entries share.
const COMMON: &str = concat!(
    shader!("view"),
    shader!("sky"),
    shader!("solid"),
    shader!("sphere"),
    shader!("cylinder"),
    shader!("arc"),
    shader!("triangle"),
    shader!("plane"),
    shader!("patch"),
    shader!("march"),
    shader!("scene")
);

/// A pixel as the compute entry writes it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Pixel {
    /// Red, green, blue, gamma applied, and 1.
    pub colour: [f32; 4],
    /// The unit normal, turned to the eye.
    pub normal: [f32; 3],
    /// Distance from the eye, in radii of the scene's [`Bounds`]; below 0 where no surface is.
    pub distance: f32,
    /// Number of evaluations of the field for this pixel, and three numbers that are 0.
    pub evaluations: [u32; 4],
}

/// How closely the space around a scene is looked at before it is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Detail {
    /// In an instant, for scenes that change with every frame: large cells, in which rays add up
    /// the terms near them. Functions that are no sums are drawn roughly.
    Quick,
    /// So closely that rays need hardly add up anything.
    #[default]
    Fine,
}

impl Detail {
    /// Most leaves of all bodies together.
    fn most_leaves(self) -> usize {
        match self {
            Self::Quick => 3000,
            Self::Fine => 600_000,
        }
    }
}

/// What a scene is made of for the card.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shown {
    /// Elements that are drawn.
    pub elements: usize,
    /// Cells that a surface passes.
    pub leaves: usize,
    /// Those of them in which the cubic is not close to the function.
    pub rough: usize,
    /// Lights left out: at most [`crate::MAX_LIGHTS`] count.
    pub lights_left_out: usize,
}

/// Draws the true surface of a scene with compute shaders.
pub struct Tracer {
    /// The formulas that it has, and the program.
    pipeline: Option<(BTreeSet<u32>, wgpu::ComputePipeline)>,
    bindings: wgpu::BindGroupLayout,
    view: wgpu::Buffer,
    frame: wgpu::Buffer,
    scene: Option<Prepared>,
    pixels: Option<([u32; 2], wgpu::Buffer)>,
}

/// A scene on the card.
struct Prepared {
    data: wgpu::Buffer,
    materials: wgpu::TextureView,
    frame: Frame,
    bounds: Bounds,
    lights: Lights,
    tone: Tone,
    air: Air,
}

impl Tracer {
    /// Prepares a device that has storage buffers.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let storage = |binding, read_only| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: compute,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let bindings = layout(
            device,
            "tracer",
            &[
                uniform(0, compute),
                texture(1, compute),
                uniform(2, compute),
                storage(3, true),
                storage(4, false),
            ],
        );
        Self {
            pipeline: None,
            bindings,
            view: uniform_buffer(device, "tracer's view", size_of::<View>()),
            frame: uniform_buffer(device, "tracer's frame", size_of::<Frame>()),
            scene: None,
            pixels: None,
        }
    }

    /// Replaces the scene. Its own camera is not used. Returns the numbers of what is drawn.
    pub fn set_scene(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        detail: Detail,
    ) -> Shown {
        let bounds = Bounds::of(scene);
        let units = bounds.units();
        let table = materials::upload(device, queue, scene);
        let unit = Unit::of_ball(bounds.center, bounds.radius);
        let packed = Packed::new(&unit.map_scene(scene), &table, detail.most_leaves());
        let known = (self.pipeline.take()).filter(|(formulas, _)| *formulas == packed.formulas);
        self.pipeline = Some(known.unwrap_or_else(|| {
            let pipeline = self.compile(device, &packed.formulas);
            (packed.formulas, pipeline)
        }));
        let bytes: &[u8] = bytemuck::cast_slice(&packed.data);
        let data = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("tracer's data"),
            size: bytes.len() as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&data, 0, bytes);
        let (lights, lights_left_out) = Lights::new(&scene.lights, units);
        let mut frame = packed.frame;
        frame.counts[3] = lights.shadows;
        self.scene = Some(Prepared {
            data,
            materials: table.view,
            frame,
            bounds,
            lights,
            tone: Tone::of(scene),
            air: Air::of(scene, units),
        });
        Shown {
            elements: packed.elements,
            leaves: packed.leaves,
            rough: packed.rough,
            lights_left_out,
        }
    }

    /// Compiles the program with some formulas.
    fn compile(&self, device: &wgpu::Device, formulas: &BTreeSet<u32>) -> wgpu::ComputePipeline {
        let label = Some("tracer");
        let formulas = formulas::code(formulas.iter().copied());
        let code = [COMMON, &formulas, shader!("compute")].concat();
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label,
            source: wgpu::ShaderSource::Wgsl(code.into()),
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &[Some(&self.bindings)],
            immediate_size: 0,
        });
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label,
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some("trace"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        })
    }

    /// Traces the scene from a camera into a picture of `size` pixels, row by row from the top, and
    /// gives the buffer of its [`Pixel`]s; `None` before the first scene.
    pub fn render(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        camera: &Camera,
        size: [u32; 2],
    ) -> Option<&wgpu::Buffer> {
        let scene = self.scene.as_ref()?;
        let (_, pipeline) = self.pipeline.as_ref()?;
        let units = scene.bounds.units();
        let view = View::new(
            camera,
            size,
            size,
            units,
            scene.tone,
            &scene.lights,
            scene.air,
        );
        queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&view));
        let projection = camera.projection(size[0], size[1]);
        let forward = -projection.world_from_view.z_axis;
        let eye = Unit::of_ball(units.center, units.radius).point(projection.eye);
        let ahead = (-eye.dot(forward)).max(0.0);
        let [x, y, z] = (eye + ahead * forward).as_vec3().to_array();
        let frame = Frame {
            middle: [x, y, z, ahead as f32],
            ..scene.frame
        };
        queue.write_buffer(&self.frame, 0, bytemuck::bytes_of(&frame));
        let pixels = self.pixels.take().filter(|(old, _)| *old == size);
        let (_, pixels) = self.pixels.insert(pixels.unwrap_or_else(|| {
            let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("traced pixels"),
                size: u64::from(size[0]) * u64::from(size[1]) * size_of::<Pixel>() as u64,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            });
            (size, buffer)
        }));
        let buffers = [
            (0, self.view.as_entire_binding()),
            (1, wgpu::BindingResource::TextureView(&scene.materials)),
            (2, self.frame.as_entire_binding()),
            (3, scene.data.as_entire_binding()),
            (4, pixels.as_entire_binding()),
        ];
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("tracer"),
            layout: &self.bindings,
            entries: &buffers.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }),
        });
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(size[0].div_ceil(8), size[1].div_ceil(8), 1);
        drop(pass);
        Some(pixels)
    }
}
