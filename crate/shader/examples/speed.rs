//! Measures how many evaluations of each cell of the chart the machine's adapter makes in a second:
//! every pixel of a picture evaluates the same elements.
//!
//! `cargo run -p shader --example speed [WIDTH HEIGHT [CELL …]]`; `EXPONENTIAL=own` takes WGSL's own
//! exponential.
use field::{BlobScale, Kernel, Primitive, Shaping, Taper};
use shader::Cell;
use std::time::Instant;
use trials::Random;
use trials::skeletons::Kind;
use wgpu::util::DeviceExt;

/// Elements that a pixel evaluates.
const ELEMENTS: usize = 32;

fn element(random: &mut Random, cell: &Cell) -> Option<Primitive> {
    let (kernel, bone) = cell.name.split_once('_')?;
    let kernel = Kernel::named(kernel)?;
    let kind = match bone {
        "point" => Kind::Point,
        "segment" | "cone" | "taper" => Kind::Segment,
        "arc" => Kind::Arc,
        "triangle" => Kind::Triangle,
        "plane" => Kind::Plane,
        _ => Kind::Curve,
    };
    let kind = if cell.name == "cubed_taper" { Kind::Arc } else { kind };
    let taper = matches!(bone, "cone" | "taper").then_some(Taper {
        radius: 0.2,
        blobbiness: -1.0,
    });
    let shaping = Shaping {
        kernel,
        radius: 0.3,
        blobbiness: -1.0,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper,
    };
    (0..1000)
        .filter_map(|_| Primitive::new(random.skeleton(kind, 1.0), &shaping, None))
        .find(|primitive| primitive.term().cell() == [kernel.name(), bone])
}

fn program(cell: &Cell, mathematics: &str, value_only: bool) -> String {
    let name = &cell.name;
    let part = if value_only { ".x" } else { "" };
    let zero = if value_only { "0.0" } else { "vec4<f32>()" };
    let all = if value_only { "vec4<f32>(sum)" } else { "sum" };
    format!(
        "{mathematics}{}
@group(0) @binding(0) var<storage, read> constants: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read> elements: array<vec2<u32>>;
@group(0) @binding(2) var<uniform> size: vec4<u32>;
@group(0) @binding(3) var<storage, read_write> sums: array<vec4<f32>>;
fn constant(i: u32) -> vec4<f32> {{
    return constants[i];
}}
fn total(place: vec2<f32>) -> vec4<f32> {{
    let p = vec3<f32>(place / vec2<f32>(size.xy) * 2.0 - 1.0, 0.1);
    var sum = {zero};
    for (var i = 0u; i < size.z; i++) {{
        sum += {name}(elements[i].x, elements[i].y, p){part};
    }}
    return {all};
}}
@compute @workgroup_size(8, 8)
fn compute(@builtin(global_invocation_id) id: vec3<u32>) {{
    if (id.x < size.x && id.y < size.y) {{
        sums[id.x + id.y * size.x] = total(vec2<f32>(id.xy) + 0.5);
    }}
}}
@vertex
fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {{
    return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}}
@fragment
fn fragment(@builtin(position) place: vec4<f32>) -> @location(0) vec4<f32> {{
    return total(place.xy);
}}
",
        cell.code
    )
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, usual: u32| {
        let given = arguments.get(i).and_then(|text| text.parse().ok());
        given.unwrap_or(usual)
    };
    let [width, height] = [number(0, 1920), number(1, 1080)];
    let wanted = arguments.get(2..).unwrap_or_default();
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shaders/field/math.wgsl");
    let mathematics = std::fs::read_to_string("math.wgsl")
        .or_else(|_| std::fs::read_to_string(folder))
        .expect("math.wgsl");
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::VULKAN;
    let instance = wgpu::Instance::new(descriptor);
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        ..Default::default()
    }))
    .expect("an adapter");
    println!("{}", adapter.get_info().name);
    let (device, queue) =
        pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))
            .expect("a device");
    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let view = target.create_view(&wgpu::TextureViewDescriptor::default());
    let sums = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(width) * u64::from(height) * 16,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    println!("million evaluations a second: compute jet, value; fragment jet, value; compile ms");
    for cell in shader::cells::all() {
        if !wanted.is_empty() && !wanted.contains(&cell.name) {
            continue;
        }
        let mut random = Random::new(45);
        let (mut constants, mut elements) = (Vec::new(), Vec::new());
        while elements.len() < ELEMENTS {
            let Some(primitive) = element(&mut random, &cell) else {
                break;
            };
            let (own, records) = cell.layout.pack(primitive.term());
            elements.push([constants.len() as u32, records]);
            constants.extend(own);
        }
        if elements.is_empty() {
            continue;
        }
        let buffer = |contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents,
                usage,
            })
        };
        let constants = buffer(bytemuck::cast_slice(&constants), wgpu::BufferUsages::STORAGE);
        let list = buffer(bytemuck::cast_slice(&elements), wgpu::BufferUsages::STORAGE);
        let size = [width, height, elements.len() as u32, 0];
        let size = buffer(bytemuck::cast_slice(&size), wgpu::BufferUsages::UNIFORM);
        let mut line = format!("{:18}", cell.name);
        let mut compiling = 0.0;
        for fragment in [false, true] {
            for value_only in [false, true] {
                let start = Instant::now();
                let code = program(&cell, &mathematics, value_only);
                let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                    label: None,
                    source: wgpu::ShaderSource::Wgsl(code.into()),
                });
                let compute = (!fragment).then(|| {
                    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                        label: None,
                        layout: None,
                        module: &module,
                        entry_point: Some("compute"),
                        compilation_options: Default::default(),
                        cache: None,
                    })
                });
                let render = fragment.then(|| {
                    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                        label: None,
                        layout: None,
                        vertex: wgpu::VertexState {
                            module: &module,
                            entry_point: Some("corner"),
                            compilation_options: Default::default(),
                            buffers: &[],
                        },
                        primitive: wgpu::PrimitiveState::default(),
                        depth_stencil: None,
                        multisample: wgpu::MultisampleState::default(),
                        fragment: Some(wgpu::FragmentState {
                            module: &module,
                            entry_point: Some("fragment"),
                            compilation_options: Default::default(),
                            targets: &[Some(target.format().into())],
                        }),
                        multiview_mask: None,
                        cache: None,
                    })
                });
                let layout = match (&compute, &render) {
                    (Some(pipeline), _) => pipeline.get_bind_group_layout(0),
                    (_, Some(pipeline)) => pipeline.get_bind_group_layout(0),
                    _ => continue,
                };
                let mut entries = vec![
                    wgpu::BindGroupEntry {
                        binding: 0,
                        resource: constants.as_entire_binding(),
                    },
                    wgpu::BindGroupEntry {
                        binding: 1,
                        resource: list.as_entire_binding(),
                    },
                    wgpu::BindGroupEntry {
                        binding: 2,
                        resource: size.as_entire_binding(),
                    },
                ];
                if !fragment {
                    entries.push(wgpu::BindGroupEntry {
                        binding: 3,
                        resource: sums.as_entire_binding(),
                    });
                }
                let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: None,
                    layout: &layout,
                    entries: &entries,
                });
                let mut run = |times: usize| {
                    let start = Instant::now();
                    let mut encoder =
                        device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
                    for _ in 0..times {
                        if let Some(pipeline) = &compute {
                            let mut pass = encoder.begin_compute_pass(&Default::default());
                            pass.set_pipeline(pipeline);
                            pass.set_bind_group(0, &group, &[]);
                            pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1);
                        }
                        if let Some(pipeline) = &render {
                            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                                    view: &view,
                                    depth_slice: None,
                                    resolve_target: None,
                                    ops: wgpu::Operations::default(),
                                })],
                                ..Default::default()
                            });
                            pass.set_pipeline(pipeline);
                            pass.set_bind_group(0, &group, &[]);
                            pass.draw(0..3, 0..1);
                        }
                    }
                    queue.submit([encoder.finish()]);
                    device
                        .poll(wgpu::PollType::wait_indefinitely())
                        .expect("the device answers");
                    start.elapsed().as_secs_f64()
                };
                run(1);
                compiling += start.elapsed().as_secs_f64();
                let first = run(1);
                let times = ((0.02 / first) as usize).clamp(1, 20);
                let best = (0..4).map(|_| run(times) / times as f64).fold(first, f64::min);
                let pixels = f64::from(width) * f64::from(height);
                let rate = pixels * elements.len() as f64 / best / 1e6;
                line += &format!(" {rate:10.0}");
            }
        }
        println!("{line}  {:6.0}", compiling * 1e3);
    }
}
