//! Drawing a draft natively and reading it back.

use preview::{Draft, Sampling};
use scene::{Camera, Scene};
use std::sync::{Mutex, OnceLock, PoisonError};

/// A device of one backend, and a draft on it: compiling the shaders takes longer than drawing.
pub struct Gpu {
    pub name: String,
    pub backend: wgpu::Backend,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    draft: Mutex<Draft>,
}

/// A picture read back, rows from the top.
pub struct Picture {
    pub size: [u32; 2],
    pub pixels: Vec<[u8; 4]>,
}

impl Picture {
    pub fn at(&self, x: u32, y: u32) -> [f64; 3] {
        let [r, g, b, a] = self.pixels[(y * self.size[0] + x) as usize];
        assert_eq!(a, 255, "the draft is opaque");
        [r, g, b].map(|channel| f64::from(channel) / 255.0)
    }
}

/// A device for each backend that this machine has, each with no more than WebGL2's limits.
///
/// Without any the tests have nothing to test and say so; on a CI machine that is an error,
/// because there a software driver is installed for them.
pub fn gpus() -> &'static [Gpu] {
    static GPUS: OnceLock<Vec<Gpu>> = OnceLock::new();
    let gpus = GPUS.get_or_init(|| {
        [wgpu::Backends::VULKAN, wgpu::Backends::GL]
            .into_iter()
            .filter_map(|backend| open(backend, wgpu::Limits::downlevel_webgl2_defaults()))
            .collect()
    });
    if gpus.is_empty() {
        assert!(
            std::env::var_os("CI").is_none(),
            "no graphics adapter: install mesa-vulkan-drivers"
        );
        eprintln!("skipped: no graphics adapter here; install mesa-vulkan-drivers");
    }
    gpus
}

/// A device of a backend with the given limits, if there is one.
pub fn open(backends: wgpu::Backends, required_limits: wgpu::Limits) -> Option<Gpu> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    let instance = wgpu::Instance::new(descriptor);
    let adapter =
        pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
            .ok()?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_limits,
        ..wgpu::DeviceDescriptor::default()
    }))
    .ok()?;
    let info = adapter.get_info();
    let draft = Mutex::new(Draft::new(&device, &queue));
    Some(Gpu {
        draft,
        name: format!("{} ({})", info.name, info.backend),
        backend: info.backend,
        device,
        queue,
    })
}

impl Gpu {
    /// Draws a scene from its own camera, with one sample a pixel, so that every pixel is one ray.
    pub fn draw(&self, scene: &Scene, size: [u32; 2]) -> Picture {
        let mut draft = self.draft.lock().unwrap_or_else(PoisonError::into_inner);
        draft.set_sampling(Sampling::One);
        let drawn = draft.set_scene(&self.device, &self.queue, scene);
        assert_eq!(drawn.elements, scene.elements.len(), "{drawn:?}");
        self.render(&mut draft, &scene.camera, size)
    }

    /// Draws a draft and reads the picture back.
    pub fn render(&self, draft: &mut Draft, camera: &Camera, size: [u32; 2]) -> Picture {
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        draft.render(&self.device, &self.queue, &mut encoder, camera, size);
        let texture = draft.texture().expect("just drawn");
        let size = [texture.width(), texture.height()];
        assert_eq!(draft.size(), Some(size));
        let row = (size[0] * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row) * u64::from(size[1]),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row),
                    rows_per_image: None,
                },
            },
            texture.size(),
        );
        self.queue.submit([encoder.finish()]);
        let slice = buffer.slice(..);
        slice.map_async(wgpu::MapMode::Read, |mapped| mapped.expect("readable"));
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the device answers");
        let bytes = slice.get_mapped_range().expect("mapped").to_vec();
        let pixels = bytes
            .chunks_exact(row as usize)
            .flat_map(|row| row[..(size[0] * 4) as usize].as_chunks::<4>().0)
            .copied()
            .collect();
        Picture { size, pixels }
    }
}
