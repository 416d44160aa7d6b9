//! The shaders and how they are bound. Shader code is fixed when the program is built: nothing
//! that a person types ever becomes part of it.

use crate::instance::Instance;
use crate::mesh::Uploaded;
use crate::solid::Kind;
use crate::view::View;

/// Format of the draft's picture: not sRGB, because the gamma of the dataset is applied already.
pub(crate) const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Format of its depth: a float, because nearer is larger and farther is near zero.
pub(crate) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The text of a file in `shaders/`.
macro_rules! shader {
    ($name:literal) => {
        include_str!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../shaders/",
            $name,
            ".wgsl"
        ))
    };
}
pub(crate) use shader;

impl Kind {
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::Sphere => "spheres",
            Self::Cylinder => "cylinders",
            Self::Arc => "arcs",
            Self::Triangle => "triangles",
            Self::Plane => "planes",
            Self::Patch => "patches",
        }
    }

    fn code(self) -> &'static str {
        macro_rules! element {
            ($name:literal $(, $more:literal)*) => {
                concat!(
                    shader!("view"),
                    shader!("shadeless"),
                    shader!("solid"),
                    shader!("element"),
                    shader!($name),
                    $(shader!($more),)*
                    "fn meet(ray: Ray, solid: Solid) -> Hit { return meet_",
                    $name,
                    "(ray, solid); }\n"
                )
            };
        }
        match self {
            Self::Sphere => element!("sphere"),
            Self::Cylinder => element!("cylinder"),
            Self::Arc => element!("arc"),
            Self::Triangle => element!("triangle"),
            Self::Plane => element!("plane"),
            Self::Patch => element!("patch", "corners"),
        }
    }

    /// The vertex shader, and how many vertices it makes of one instance.
    pub(crate) fn cover(self) -> (&'static str, u32) {
        match self {
            Self::Plane => ("cover_picture", 3),
            Self::Patch => ("cover_corners", 3),
            _ => ("cover_box", 36),
        }
    }
}

/// Pipelines and buffers that live as long as the device.
pub(crate) struct Pipelines {
    pub(crate) elements: [wgpu::RenderPipeline; Kind::COUNT],
    /// Draws a mesh of the soft elements.
    pub(crate) mesh: wgpu::RenderPipeline,
    /// Draws what is behind the elements.
    pub(crate) backdrop: wgpu::RenderPipeline,
    pub(crate) resolve: wgpu::RenderPipeline,
    /// Holds one [`View`].
    pub(crate) view: wgpu::Buffer,
    /// Holds the gamma for the resolve pass.
    pub(crate) tone: wgpu::Buffer,
    element_layout: wgpu::BindGroupLayout,
    resolve_layout: wgpu::BindGroupLayout,
}

impl Pipelines {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let element_layout = layout(
            device,
            "element",
            &[uniform(0, stages), texture(1, fragment)],
        );
        let resolve_layout = layout(
            device,
            "resolve",
            &[texture(0, fragment), uniform(1, fragment)],
        );
        Self {
            elements: Kind::ALL.map(|kind| element_pipeline(device, kind, &element_layout)),
            mesh: mesh_pipeline(device, &element_layout),
            backdrop: backdrop_pipeline(device, &element_layout),
            resolve: resolve_pipeline(device, &resolve_layout),
            view: uniform_buffer(device, "view", size_of::<View>()),
            tone: uniform_buffer(device, "tone", 16),
            element_layout,
            resolve_layout,
        }
    }

    /// Binds the view and a table of materials for the element pipelines.
    pub(crate) fn bind_materials(
        &self,
        device: &wgpu::Device,
        materials: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        let resources = [
            self.view.as_entire_binding(),
            wgpu::BindingResource::TextureView(materials),
        ];
        bind(device, "element", &self.element_layout, resources)
    }

    /// Binds the samples to be averaged for the resolve pipeline.
    pub(crate) fn bind_samples(
        &self,
        device: &wgpu::Device,
        samples: &wgpu::TextureView,
    ) -> wgpu::BindGroup {
        let resources = [
            wgpu::BindingResource::TextureView(samples),
            self.tone.as_entire_binding(),
        ];
        bind(device, "resolve", &self.resolve_layout, resources)
    }
}

pub(crate) fn uniform_buffer(device: &wgpu::Device, label: &str, size: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

pub(crate) fn uniform(binding: u32, visibility: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

pub(crate) fn texture(binding: u32, visibility: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }
}

pub(crate) fn layout(
    device: &wgpu::Device,
    label: &str,
    entries: &[wgpu::BindGroupLayoutEntry],
) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries,
    })
}

fn element_pipeline(
    device: &wgpu::Device,
    kind: Kind,
    bindings: &wgpu::BindGroupLayout,
) -> wgpu::RenderPipeline {
    let (cover, _) = kind.cover();
    pipeline(
        device,
        Stages {
            label: kind.label(),
            code: kind.code(),
            vertex: cover,
            fragment: "draw",
        },
        bindings,
        &[Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<Instance>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &Instance::ATTRIBUTES,
        })],
        // The back faces of a box are drawn; of a single triangle, whichever is seen.
        (cover == "cover_box").then_some(wgpu::Face::Front),
        Some(depth(wgpu::CompareFunction::Greater)),
    )
}

fn mesh_pipeline(device: &wgpu::Device, bindings: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
    pipeline(
        device,
        Stages {
            label: "mesh",
            code: concat!(shader!("view"), shader!("shadeless"), shader!("mesh")),
            vertex: "cover",
            fragment: "draw",
        },
        bindings,
        &Uploaded::LAYOUTS,
        None,
        Some(depth(wgpu::CompareFunction::Greater)),
    )
}

/// Depths that pass a comparison are written.
fn depth(compare: wgpu::CompareFunction) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(true),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

fn backdrop_pipeline(
    device: &wgpu::Device,
    bindings: &wgpu::BindGroupLayout,
) -> wgpu::RenderPipeline {
    pipeline(
        device,
        Stages {
            label: "backdrop",
            code: concat!(
                shader!("view"),
                shader!("shadeless"),
                shader!("sky"),
                shader!("backdrop")
            ),
            vertex: "cover",
            fragment: "draw",
        },
        bindings,
        &[],
        None,
        // It is drawn first, over nothing.
        Some(depth(wgpu::CompareFunction::Always)),
    )
}

fn resolve_pipeline(
    device: &wgpu::Device,
    bindings: &wgpu::BindGroupLayout,
) -> wgpu::RenderPipeline {
    pipeline(
        device,
        Stages {
            label: "resolve",
            code: shader!("resolve"),
            vertex: "cover",
            fragment: "resolve",
        },
        bindings,
        &[],
        None,
        None,
    )
}

/// The code of a pipeline and the names of its two functions.
struct Stages {
    label: &'static str,
    code: &'static str,
    vertex: &'static str,
    fragment: &'static str,
}

fn pipeline(
    device: &wgpu::Device,
    stages: Stages,
    bindings: &wgpu::BindGroupLayout,
    buffers: &[Option<wgpu::VertexBufferLayout<'_>>],
    cull_mode: Option<wgpu::Face>,
    depth_stencil: Option<wgpu::DepthStencilState>,
) -> wgpu::RenderPipeline {
    let label = Some(stages.label);
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label,
        source: wgpu::ShaderSource::Wgsl(stages.code.into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label,
        bind_group_layouts: &[Some(bindings)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(stages.vertex),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers,
        },
        primitive: wgpu::PrimitiveState {
            cull_mode,
            ..wgpu::PrimitiveState::default()
        },
        depth_stencil,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(stages.fragment),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(COLOUR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn bind(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    [first, second]: [wgpu::BindingResource<'_>; 2],
) -> wgpu::BindGroup {
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &[(0, first), (1, second)]
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }),
    })
}
