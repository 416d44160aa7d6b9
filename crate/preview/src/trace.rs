//! Traces the true surface on the card.
//!
//! A scene comes as [`cells::Packed`], and `shaders/scene.wgsl` sends a ray from the eye through
//! each pixel, and one from what it meets to each light.

use crate::bindings::{COLOUR, layout, shader, texture, uniform, uniform_buffer};
use crate::materials;
use crate::verdict::Verdict;
use crate::view::{self, Air, Lights, View};
use bytemuck::{Pod, Zeroable};
use cells::{Bounds, Packed};
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

/// The uniform `frame` of `shaders/scene.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
struct Frame {
    middle: [f32; 4],
    counts: [u32; 4],
    places: [u32; 4],
}

/// Returns the text of the functions that choose among some formulas: [`cells::formulas::code`], or
/// [`cells::formulas::none`] in a program that only draws cubics, and then has none of the others.
pub type Code = fn(&BTreeSet<u32>) -> String;

/// The stage of the card that traces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Compute shaders, with data in a buffer.
    Compute,
    /// A fragment shader, with data in a texture: all that WebGL2 has.
    Fragment,
}

/// Width of the texture of data, as in `shaders/fragment.wgsl`.
const ROW: usize = 2048;

/// Draws the true surface of a scene.
pub struct Tracer {
    stage: Stage,
    code: Code,
    /// The formulas that it has, the program, and the verdict on it.
    program: Option<(BTreeSet<u32>, Program, Verdict)>,
    bindings: wgpu::BindGroupLayout,
    view: wgpu::Buffer,
    frame: wgpu::Buffer,
    scene: Option<Prepared>,
    /// Verdict on the scene's data.
    verdict: Option<Verdict>,
    target: Option<([u32; 2], Target)>,
}

/// Program of either stage.
enum Program {
    Compute(wgpu::ComputePipeline),
    Fragment(wgpu::RenderPipeline),
}

/// Buffer or texture that a frame is written to.
#[derive(Debug)]
pub enum Target {
    /// The [`Pixel`]s row by row from the top, of [`Stage::Compute`].
    Pixels(wgpu::Buffer),
    /// A picture (`Rgba8Unorm`), of [`Stage::Fragment`].
    Picture(wgpu::Texture),
}

/// The data of a scene.
enum Data {
    Buffer(wgpu::Buffer),
    Texture(wgpu::TextureView),
}

/// A scene on the card.
struct Prepared {
    data: Data,
    materials: wgpu::TextureView,
    frame: Frame,
    bounds: Bounds,
    lights: Lights,
    gamma: f32,
    air: Air,
}

impl Stage {
    /// Returns the stage that a device has.
    #[must_use]
    pub fn of(device: &wgpu::Device) -> Self {
        if device.limits().max_storage_buffers_per_shader_stage >= 2 {
            Self::Compute
        } else {
            Self::Fragment
        }
    }

    /// Returns the number of vectors of four that data may take.
    fn room(self, device: &wgpu::Device) -> usize {
        let limits = device.limits();
        match self {
            Self::Compute => {
                let most = limits.max_storage_buffer_binding_size;
                most.min(limits.max_buffer_size) as usize / 16
            }
            Self::Fragment => limits.max_texture_dimension_2d as usize * ROW,
        }
    }

    /// Hands over the data of a scene.
    fn upload(self, device: &wgpu::Device, queue: &wgpu::Queue, data: &[u8]) -> Data {
        match self {
            Self::Compute => {
                let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("tracer's data"),
                    size: data.len() as u64,
                    usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                });
                queue.write_buffer(&buffer, 0, data);
                Data::Buffer(buffer)
            }
            Self::Fragment => {
                let row = 16 * ROW;
                let whole = data.len() / row;
                let size = wgpu::Extent3d {
                    width: ROW as u32,
                    height: data.len().div_ceil(row) as u32,
                    depth_or_array_layers: 1,
                };
                let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
                let texture = device.create_texture(&wgpu::TextureDescriptor {
                    label: Some("tracer's data"),
                    size,
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    format: wgpu::TextureFormat::Rgba32Uint,
                    usage,
                    view_formats: &[],
                });
                let (rows, rest) = data.split_at(whole * row);
                for (bytes, at) in [(rows, 0), (rest, whole as u32)] {
                    if bytes.is_empty() {
                        continue;
                    }
                    let mut place = texture.as_image_copy();
                    place.origin.y = at;
                    queue.write_texture(
                        place,
                        bytes,
                        wgpu::TexelCopyBufferLayout {
                            offset: 0,
                            bytes_per_row: Some(row as u32),
                            rows_per_image: None,
                        },
                        wgpu::Extent3d {
                            width: (bytes.len().min(row) / 16) as u32,
                            height: bytes.len().div_ceil(row) as u32,
                            depth_or_array_layers: 1,
                        },
                    );
                }
                Data::Texture(texture.create_view(&wgpu::TextureViewDescriptor::default()))
            }
        }
    }

    /// Makes what a frame of a size is written to.
    fn target(self, device: &wgpu::Device, [width, height]: [u32; 2]) -> Target {
        let label = Some("traced picture");
        match self {
            Self::Compute => Target::Pixels(device.create_buffer(&wgpu::BufferDescriptor {
                label,
                size: u64::from(width) * u64::from(height) * size_of::<Pixel>() as u64,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            })),
            Self::Fragment => Target::Picture(device.create_texture(&wgpu::TextureDescriptor {
                label,
                size: wgpu::Extent3d {
                    width,
                    height,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: COLOUR,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            })),
        }
    }

    fn layout(self, device: &wgpu::Device) -> wgpu::BindGroupLayout {
        let stage = match self {
            Self::Compute => wgpu::ShaderStages::COMPUTE,
            Self::Fragment => wgpu::ShaderStages::FRAGMENT,
        };
        let data = match self {
            Self::Compute => vec![
                wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Storage { read_only: true },
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Storage { read_only: false },
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
            ],
            Self::Fragment => vec![wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Uint,
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            }],
        };
        let mut entries = vec![uniform(0, stage), texture(1, stage), uniform(2, stage)];
        entries.extend(
            (3..)
                .zip(data)
                .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
                    binding,
                    visibility: stage,
                    ty,
                    count: None,
                }),
        );
        layout(device, "tracer", &entries)
    }

    /// Returns the text of the program with some formulas.
    fn code(self, formulas: &str) -> String {
        let entry = match self {
            Self::Compute => shader!("compute"),
            Self::Fragment => shader!("fragment"),
        };
        [COMMON, formulas, entry].concat()
    }

    /// Compiles the program with some formulas.
    fn compile(
        self,
        device: &wgpu::Device,
        bindings: &wgpu::BindGroupLayout,
        formulas: &str,
    ) -> Program {
        let label = Some("tracer");
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label,
            source: wgpu::ShaderSource::Wgsl(self.code(formulas).into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &[Some(bindings)],
            immediate_size: 0,
        });
        match self {
            Self::Compute => {
                let descriptor = wgpu::ComputePipelineDescriptor {
                    label,
                    layout: Some(&layout),
                    module: &module,
                    entry_point: Some("trace"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    cache: None,
                };
                Program::Compute(device.create_compute_pipeline(&descriptor))
            }
            Self::Fragment => {
                let descriptor = wgpu::RenderPipelineDescriptor {
                    label,
                    layout: Some(&layout),
                    vertex: wgpu::VertexState {
                        module: &module,
                        entry_point: Some("cover"),
                        compilation_options: wgpu::PipelineCompilationOptions::default(),
                        buffers: &[],
                    },
                    primitive: wgpu::PrimitiveState::default(),
                    depth_stencil: None,
                    multisample: wgpu::MultisampleState::default(),
                    fragment: Some(wgpu::FragmentState {
                        module: &module,
                        entry_point: Some("draw"),
                        compilation_options: wgpu::PipelineCompilationOptions::default(),
                        targets: &[Some(COLOUR.into())],
                    }),
                    multiview_mask: None,
                    cache: None,
                };
                Program::Fragment(device.create_render_pipeline(&descriptor))
            }
        }
    }
}

impl Tracer {
    /// Prepares a device for a stage, which it must have: [`Stage::of`] tells one.
    #[must_use]
    pub fn new(device: &wgpu::Device, stage: Stage, code: Code) -> Self {
        Self {
            stage,
            code,
            program: None,
            bindings: stage.layout(device),
            view: uniform_buffer(device, "tracer's view", size_of::<View>()),
            frame: uniform_buffer(device, "tracer's frame", size_of::<Frame>()),
            scene: None,
            verdict: None,
            target: None,
        }
    }

    /// Whether the device draws: `false` as long as it does not say that its compiler has taken the
    /// program, and before the first scene. A scene's data are taken for good until it says that
    /// they are not, else nothing new would be drawn while they change with each frame.
    ///
    /// # Errors
    /// In the device's words, if it has no room for the scene after all, or its compiler refuses
    /// the program. Then nothing is drawn before the next scene.
    pub fn is_ready(&mut self) -> Result<bool, &str> {
        if let Some(verdict) = &mut self.verdict {
            verdict.is_good()?;
        }
        match &mut self.program {
            Some((.., verdict)) => verdict.is_good(),
            None => Ok(false),
        }
    }

    /// Replaces the scene by one and what was packed of it. Its own camera is not used. Returns the
    /// number of lights left out: at most [`crate::MAX_LIGHTS`] count. `None` if the device has no
    /// room for it; then the last scene stays.
    pub fn set_scene(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        packed: &Packed,
    ) -> Option<usize> {
        let is_sound = !packed.data.is_empty() && packed.data.len().is_multiple_of(16);
        if !is_sound || packed.data.len() / 16 > self.stage.room(device) {
            return None;
        }
        let known = self
            .program
            .take()
            .filter(|(formulas, ..)| *formulas == packed.formulas);
        let known = known.filter(|(.., verdict)| !verdict.is_refusal());
        self.program = Some(known.unwrap_or_else(|| {
            let code = (self.code)(&packed.formulas);
            let (program, verdict) =
                Verdict::on(device, || self.stage.compile(device, &self.bindings, &code));
            (packed.formulas.clone(), program, verdict)
        }));
        let ((data, materials), verdict) = Verdict::on(device, || {
            let data = self.stage.upload(device, queue, &packed.data);
            (data, materials::upload(device, queue, scene))
        });
        self.verdict = Some(verdict);
        let bounds = Bounds::of(scene);
        let units = bounds.units();
        let (lights, lights_left_out) = Lights::new(&scene.lights, units);
        let mut frame = Frame {
            middle: [0.0; 4],
            counts: packed.frame.counts,
            places: packed.frame.places,
        };
        frame.counts[3] = lights.shadows;
        self.scene = Some(Prepared {
            data,
            materials,
            frame,
            bounds,
            lights,
            gamma: view::gamma(scene),
            air: Air::of(scene, units),
        });
        Some(lights_left_out)
    }

    /// Traces the scene from a camera into a picture of `size` pixels, and gives it; `None` where
    /// [`Tracer::is_ready`] does not say so.
    pub fn render(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        camera: &Camera,
        size: [u32; 2],
    ) -> Option<&Target> {
        if self.is_ready() != Ok(true) {
            return None;
        }
        let scene = self.scene.as_ref()?;
        let (_, program, _) = self.program.as_ref()?;
        scene.look(queue, [&self.view, &self.frame], camera, size);
        let target = (self.target.take()).filter(|(old, _)| *old == size);
        let target = target.unwrap_or_else(|| (size, self.stage.target(device, size)));
        let (_, target) = self.target.insert(target);
        let mut resources = vec![
            self.view.as_entire_binding(),
            wgpu::BindingResource::TextureView(&scene.materials),
            self.frame.as_entire_binding(),
            match &scene.data {
                Data::Buffer(buffer) => buffer.as_entire_binding(),
                Data::Texture(view) => wgpu::BindingResource::TextureView(view),
            },
        ];
        if let Target::Pixels(buffer) = target {
            resources.push(buffer.as_entire_binding());
        }
        let entries: Vec<_> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let label = Some("tracer");
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label,
            layout: &self.bindings,
            entries: &entries,
        });
        match (program, &*target) {
            (Program::Compute(pipeline), _) => {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, &group, &[]);
                pass.dispatch_workgroups(size[0].div_ceil(8), size[1].div_ceil(8), 1);
            }
            (Program::Fragment(pipeline), Target::Picture(picture)) => {
                let view = picture.create_view(&wgpu::TextureViewDescriptor::default());
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label,
                    color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                        view: &view,
                        depth_slice: None,
                        resolve_target: None,
                        ops: wgpu::Operations {
                            load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                            store: wgpu::StoreOp::Store,
                        },
                    })],
                    ..wgpu::RenderPassDescriptor::default()
                });
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, &group, &[]);
                pass.draw(0..3, 0..1);
            }
            (Program::Fragment(_), Target::Pixels(_)) => {}
        }
        Some(target)
    }
}

impl Prepared {
    /// Writes the uniforms of a camera.
    fn look(
        &self,
        queue: &wgpu::Queue,
        [view, frame]: [&wgpu::Buffer; 2],
        camera: &Camera,
        size: [u32; 2],
    ) {
        let units = self.bounds.units();
        let seen = View::new(camera, size, units, self.gamma, &self.lights, self.air);
        queue.write_buffer(view, 0, bytemuck::bytes_of(&seen));
        let projection = camera.projection(size[0], size[1]);
        let forward = -projection.world_from_view.z_axis;
        let eye = Unit::of_ball(units.center, units.radius).map(projection.eye);
        let ahead = (-eye.dot(forward)).max(0.0);
        let [x, y, z] = (eye + ahead * forward).as_vec3().to_array();
        let place = Frame {
            middle: [x, y, z, ahead as f32],
            ..self.frame
        };
        queue.write_buffer(frame, 0, bytemuck::bytes_of(&place));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use naga::back::glsl;
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    #[test]
    fn all_formulas_fit_both_stages() {
        let all = cells::formulas::code(&cells::formulas::all().collect());
        for stage in [Stage::Compute, Stage::Fragment] {
            let code = stage.code(&all);
            let module = naga::front::wgsl::parse_str(&code)
                .unwrap_or_else(|error| panic!("{stage:?}: {}", error.emit_to_string(&code)));
            let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
                .validate(&module)
                .unwrap_or_else(|error| panic!("{stage:?}: {}", error.emit_to_string(&code)));
            if stage == Stage::Compute {
                continue;
            }
            let options = glsl::Options {
                version: glsl::Version::Embedded {
                    version: 300,
                    is_webgl: true,
                },
                ..glsl::Options::default()
            };
            let pipeline = glsl::PipelineOptions {
                entry_point: "draw".into(),
                shader_stage: naga::ShaderStage::Fragment,
                multiview: None,
            };
            let mut text = String::new();
            let policies = naga::proc::BoundsCheckPolicies::default();
            let written =
                glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, policies)
                    .and_then(|mut writer| writer.write());
            assert!(written.is_ok(), "{written:?}");
        }
    }
}
