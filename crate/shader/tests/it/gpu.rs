//! Evaluation on an adapter: a software one, as a rule.

use crate::files::mathematics;
use field::Term;
use shader::Cell;
use std::sync::OnceLock;
use wgpu::util::DeviceExt;

pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
}

/// Returns a device that computes, if this machine has one.
///
/// Without one the tests have nothing to test and say so; on a CI machine that is an error, because
/// there a software driver is installed for them.
pub fn gpu() -> Option<&'static Gpu> {
    static GPU: OnceLock<Option<Gpu>> = OnceLock::new();
    let gpu = GPU.get_or_init(|| {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = wgpu::Backends::VULKAN;
        let instance = wgpu::Instance::new(descriptor);
        let adapter =
            pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
                .ok()?;
        let (device, queue) =
            pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default())).ok()?;
        Some(Gpu { device, queue })
    });
    if gpu.is_none() {
        assert!(
            std::env::var_os("CI").is_none(),
            "no graphics adapter: install mesa-vulkan-drivers"
        );
        eprintln!("skipped: no graphics adapter here; install mesa-vulkan-drivers");
    }
    gpu.as_ref()
}

impl Gpu {
    fn input(&self, contents: &[u8]) -> wgpu::Buffer {
        let descriptor = wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage: wgpu::BufferUsages::STORAGE,
        };
        self.device.create_buffer_init(&descriptor)
    }

    /// Evaluates a cell: value and gradient of each term at its points, as many for each.
    pub fn evaluate(
        &self,
        cell: &Cell,
        terms: &[&Term<f32>],
        points: &[[f32; 3]],
    ) -> Vec<[f32; 4]> {
        let each = points.len() / terms.len();
        let name = &cell.name;
        let code = format!(
            "{}{}
@group(0) @binding(0) var<storage, read> constants: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read> elements: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> jets: array<vec4<f32>>;
fn constant(i: u32) -> vec4<f32> {{
    return constants[i];
}}
@compute @workgroup_size(64)
fn evaluate(@builtin(global_invocation_id) id: vec3<u32>) {{
    if (id.x < arrayLength(&points)) {{
        let element = elements[id.x / {each}u];
        jets[id.x] = {name}(element.x, element.y, points[id.x].xyz);
    }}
}}
",
            mathematics(),
            cell.code
        );
        let (mut constants, mut elements) = (Vec::new(), Vec::new());
        for term in terms {
            let (own, records) = cell.layout.pack(term);
            elements.push([constants.len() as u32, records]);
            constants.extend(own);
        }
        let points: Vec<[f32; 4]> = points.iter().map(|[x, y, z]| [*x, *y, *z, 0.0]).collect();
        let device = &self.device;
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(name),
            source: wgpu::ShaderSource::Wgsl(code.into()),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(name),
            layout: None,
            module: &shader,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let size = size_of_val(&points[..]) as u64;
        let [output, copy] = [
            wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        ]
        .map(|usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size,
                usage,
                mapped_at_creation: false,
            })
        });
        let buffers = [
            self.input(bytemuck::cast_slice(&constants)),
            self.input(bytemuck::cast_slice(&elements)),
            self.input(bytemuck::cast_slice(&points)),
            output,
        ];
        let entries: Vec<wgpu::BindGroupEntry<'_>> = (0..)
            .zip(&buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups((points.len() as u32).div_ceil(64), 1, 1);
        }
        encoder.copy_buffer_to_buffer(&buffers[3], 0, &copy, 0, size);
        self.queue.submit([encoder.finish()]);
        let slice = copy.slice(..);
        slice.map_async(wgpu::MapMode::Read, |mapped| mapped.expect("readable"));
        device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the device answers");
        let mapped = slice.get_mapped_range().expect("mapped");
        bytemuck::cast_slice(&mapped).to_vec()
    }
}
