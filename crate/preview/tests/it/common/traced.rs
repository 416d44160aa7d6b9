//! Tracing a scene on an adapter, reading it back, and holding it to the tracer's picture.

use cells::{Bounds, Chart, Cubics, Detail, Formulas, Packed};
use preview::{Code, Pixel, Stage, Target, Tracer};
use scene::{Camera, Scene};

/// A device that computes.
pub struct Card {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
}

/// Shares of pixels, 0 to 1, that differ from the tracer's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Differs {
    /// Share of all pixels that differ in being surface.
    pub coverage: f64,
    /// Share of the pixels that both call surface whose distances differ by more than 10⁻³ of the
    /// radius of the scene.
    pub distance: f64,
    /// Share of the same pixels whose normals differ by more than 5°.
    pub normal: f64,
}

/// Returns a device that computes, if this machine has one. On a CI machine none is an error.
pub fn open() -> Option<Card> {
    let card = device(wgpu::Backends::VULKAN, wgpu::Limits::default());
    if card.is_none() {
        assert!(
            std::env::var_os("CI").is_none(),
            "no graphics adapter: install mesa-vulkan-drivers"
        );
        eprintln!("skipped: no graphics adapter here; install mesa-vulkan-drivers");
    }
    card
}

/// Returns a device for each backend that this machine has, with no more than WebGL2's limits.
#[allow(dead_code, reason = "for tests")]
pub fn cards() -> Vec<Card> {
    let cards: Vec<Card> = [wgpu::Backends::VULKAN, wgpu::Backends::GL]
        .into_iter()
        .filter_map(|backend| device(backend, wgpu::Limits::downlevel_webgl2_defaults()))
        .collect();
    assert!(
        !cards.is_empty() || std::env::var_os("CI").is_none(),
        "no graphics adapter: install mesa-vulkan-drivers"
    );
    cards
}

fn device(backends: wgpu::Backends, required_limits: wgpu::Limits) -> Option<Card> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    let instance = wgpu::Instance::new(descriptor);
    let options = wgpu::RequestAdapterOptions::default();
    let adapter = pollster::block_on(instance.request_adapter(&options)).ok()?;
    let descriptor = wgpu::DeviceDescriptor {
        required_limits,
        ..wgpu::DeviceDescriptor::default()
    };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).ok()?;
    Some(Card { device, queue })
}

impl Card {
    /// Prepares a scene: with all formulas for compute shaders, with none for a fragment shader, as
    /// the page has it.
    pub fn prepare(&self, scene: &Scene, detail: Detail, stage: Stage) -> (Tracer, Packed) {
        self.prepare_with(scene, detail, stage, stage == Stage::Compute)
    }

    /// Prepares a scene with all formulas or none.
    pub fn prepare_with(
        &self,
        scene: &Scene,
        detail: Detail,
        stage: Stage,
        has_formulas: bool,
    ) -> (Tracer, Packed) {
        let (chart, code): (&dyn Chart, Code) = if has_formulas {
            (&Formulas, cells::formulas::code)
        } else {
            (&Cubics, cells::formulas::none)
        };
        let packed = Packed::new(scene, detail, chart, &mut |_| true).expect("wanted");
        let mut tracer = Tracer::new(&self.device, stage, code);
        let shown = tracer.set_scene(&self.device, &self.queue, scene, &packed);
        assert!(shown.is_some(), "no room");
        (tracer, packed)
    }

    /// Draws a scene from its own camera by a fragment shader.
    #[allow(dead_code, reason = "for tests")]
    pub fn draw(&self, scene: &Scene, size: [u32; 2]) -> Vec<[u8; 4]> {
        let (mut tracer, _) = self.prepare(scene, Detail::Fine, Stage::Fragment);
        self.colours(&mut tracer, &scene.camera, size)
    }

    /// Returns the adapter's name.
    #[allow(dead_code, reason = "for tests")]
    pub fn name(&self) -> String {
        let info = self.device.adapter_info();
        format!("{} ({})", info.name, info.backend)
    }

    /// Draws a frame of compute shaders and reads its pixels back.
    pub fn read(&self, tracer: &mut Tracer, camera: &Camera, size: [u32; 2]) -> Vec<Pixel> {
        let mut encoder = self.device.create_command_encoder(&<_>::default());
        let target = tracer.render(&self.device, &self.queue, &mut encoder, camera, size);
        let Some(Target::Pixels(pixels)) = target else {
            panic!("compute shaders write pixels");
        };
        let copy = self.copy(pixels.size());
        encoder.copy_buffer_to_buffer(pixels, 0, &copy, 0, pixels.size());
        self.queue.submit([encoder.finish()]);
        bytemuck::pod_collect_to_vec(&self.bytes(&copy))
    }

    /// Draws a frame of a fragment shader and reads its colours back; rows must be multiples of
    /// 64 pixels.
    #[allow(dead_code, reason = "for tests")]
    pub fn colours(&self, tracer: &mut Tracer, camera: &Camera, size: [u32; 2]) -> Vec<[u8; 4]> {
        let mut encoder = self.device.create_command_encoder(&<_>::default());
        let target = tracer.render(&self.device, &self.queue, &mut encoder, camera, size);
        let Some(Target::Picture(picture)) = target else {
            panic!("a fragment shader draws a picture");
        };
        let copy = self.copy(u64::from(size[0]) * u64::from(size[1]) * 4);
        encoder.copy_texture_to_buffer(
            picture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &copy,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(4 * size[0]),
                    rows_per_image: None,
                },
            },
            picture.size(),
        );
        self.queue.submit([encoder.finish()]);
        self.bytes(&copy).as_chunks::<4>().0.to_vec()
    }

    /// Makes a buffer that is read back.
    fn copy(&self, size: u64) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        })
    }

    /// Reads a buffer back.
    fn bytes(&self, copy: &wgpu::Buffer) -> Vec<u8> {
        let slice = copy.slice(..);
        slice.map_async(wgpu::MapMode::Read, |mapped| mapped.expect("readable"));
        let poll = wgpu::PollType::wait_indefinitely();
        self.device.poll(poll).expect("the device answers");
        slice.get_mapped_range().expect("mapped").to_vec()
    }
}

/// Compares pixels with what the tracer finds in the same directions.
pub fn compare(scene: &Scene, size: [u32; 2], pixels: &[Pixel]) -> Differs {
    let picture = tracer::Picture::new(scene, size);
    let projection = scene.camera.projection(size[0], size[1]);
    let radius = Bounds::of(scene).radius;
    let rays: Vec<_> = (0..size[0] * size[1])
        .map(|i| {
            let at = [i % size[0], i / size[0]];
            let [x, y] = [0, 1].map(|k| (f64::from(at[k]) + 0.5) / f64::from(size[k]));
            (projection.eye, projection.direction(x, y))
        })
        .collect();
    let hits = picture.cast(&rays);
    let (mut both, mut counts) = (0_u32, [0_usize; 3]);
    for ((pixel, hit), (_, gaze)) in pixels.iter().zip(&hits).zip(&rays) {
        let is_surface = pixel.distance >= 0.0;
        counts[0] += usize::from(is_surface != hit.is_some());
        let Some(hit) = hit.filter(|_| is_surface) else {
            continue;
        };
        both += 1;
        let away = (f64::from(pixel.distance) * radius - hit.t).abs();
        counts[1] += usize::from(away > 1e-3 * radius);
        let normal = glam::Vec3::from(pixel.normal).as_dvec3();
        let seen = if hit.normal.dot(*gaze) > 0.0 {
            -hit.normal
        } else {
            hit.normal
        };
        counts[2] += usize::from(normal.dot(seen) < libm::cos(5_f64.to_radians()));
    }
    let [coverage, distance, normal] = counts.map(|count| count as f64);
    let both = f64::from(both.max(1));
    Differs {
        coverage: coverage / pixels.len() as f64,
        distance: distance / both,
        normal: normal / both,
    }
}
