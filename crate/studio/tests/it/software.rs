//! The processor draws the window as egui's own painter does on a GPU.

use egui::{
    ClippedPrimitive, Color32, ColorImage, Context, Mesh, Pos2, RawInput, Rect, TextureOptions,
    TexturesDelta, Ui, ViewportId, pos2, vec2,
};
use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor, wgpu};
use painter::Painter;

const SIZE: [u32; 2] = [640, 448];
const GROUND: Color32 = Color32::from_rgb(30, 40, 50);

/// Shows a bit of everything that egui draws.
fn show(ui: &mut Ui, picture: &egui::TextureHandle) {
    egui::Panel::left("left").show(ui, |ui| {
        ui.heading("Heading: fi ff, äöü");
        ui.monospace("point c 1.5 -2.25 0\nline c 0 0 0  1 1 1");
        let _ = ui.button("A button");
        ui.checkbox(&mut true, "A box");
        let _ = ui.radio(true, "A choice");
        ui.add(egui::Slider::new(&mut 0.4, 0.0..=1.0));
        ui.add(egui::ProgressBar::new(0.7));
        ui.hyperlink("https://example.org");
        ui.separator();
        ui.add(egui::TextEdit::multiline(&mut "some text\nto edit").desired_rows(3));
        egui::Frame::window(ui.style()).show(ui, |ui| ui.label("shadowed"));
        ui.add_enabled(false, egui::Button::new("faded"));
    });
    egui::CentralPanel::default().show(ui, |ui| {
        let place = ui.max_rect();
        let painter = ui.painter();
        painter.circle(
            place.center(),
            61.3,
            Color32::from_rgba_unmultiplied(200, 90, 20, 140),
            (3.7, Color32::GREEN),
        );
        painter.line_segment(
            [place.left_top(), place.right_bottom()],
            (0.6, Color32::RED),
        );
        painter.line_segment(
            [place.left_bottom(), place.right_top()],
            (9.0, Color32::BLUE),
        );
        let mut mesh = Mesh::default();
        mesh.colored_vertex(place.min + vec2(8.0, 8.0), Color32::RED);
        mesh.colored_vertex(place.min + vec2(150.0, 30.0), Color32::TRANSPARENT);
        mesh.colored_vertex(place.min + vec2(40.0, 120.0), Color32::YELLOW);
        mesh.add_triangle(0, 1, 2);
        painter.add(mesh);
        let at = |x, y, w, h| Rect::from_min_size(place.min + vec2(x, y), vec2(w, h));
        let image = |size: egui::Vec2| egui::Image::new(picture).fit_to_exact_size(size);
        // As large as its texels, larger, smaller, turned, and with round corners.
        image(vec2(32.0, 24.0)).paint_at(ui, at(200.0, 10.0, 32.0, 24.0));
        image(vec2(90.0, 70.0)).paint_at(ui, at(190.3, 40.6, 90.0, 70.0));
        image(vec2(20.0, 15.0)).paint_at(ui, at(10.5, 130.0, 20.0, 15.0));
        image(vec2(60.0, 60.0))
            .rotate(0.6, vec2(0.5, 0.5))
            .paint_at(ui, at(30.0, 200.0, 60.0, 60.0));
        image(vec2(80.0, 60.0))
            .corner_radius(17.0)
            .paint_at(ui, at(200.0, 200.0, 80.0, 60.0));
    });
}

/// Returns the shapes of a frame and the changes of its textures.
fn frame(scale: f32) -> (Vec<ClippedPrimitive>, TexturesDelta) {
    let context = Context::default();
    context.set_fonts(studio::fonts::definitions());
    let texels = (0..32 * 24)
        .map(|i| {
            Color32::from_rgb(
                (i * 8 % 256) as u8,
                (i / 32 * 10) as u8,
                (i * 37 % 256) as u8,
            )
        })
        .collect();
    let picture = context.load_texture(
        "picture",
        ColorImage::new([32, 24], texels),
        TextureOptions::LINEAR,
    );
    let mut input = RawInput {
        screen_rect: Some(Rect::from_min_size(
            Pos2::ZERO,
            vec2(SIZE[0] as f32, SIZE[1] as f32) / scale,
        )),
        events: vec![egui::Event::PointerMoved(pos2(40.0, 60.0))],
        ..RawInput::default()
    };
    let viewport = input.viewports.entry(ViewportId::ROOT).or_default();
    viewport.native_pixels_per_point = Some(scale);
    let output = context.run_ui(input, |ui| show(ui, &picture));
    let primitives = context.tessellate(output.shapes, output.pixels_per_point);
    // The picture is freed only when the context is dropped.
    (primitives, output.textures_delta)
}

fn on_processor(
    primitives: &[ClippedPrimitive],
    mut textures: TexturesDelta,
    scale: f32,
) -> Vec<u8> {
    let mut painter = Painter::default();
    painter.set_textures(&mut textures);
    painter.paint(SIZE.map(|side| side as usize), scale, primitives, GROUND);
    painter.free_textures(&mut textures);
    painter.pixels().to_vec()
}

fn on_gpu(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    primitives: &[ClippedPrimitive],
    mut textures: TexturesDelta,
    scale: f32,
) -> Vec<u8> {
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let options = RendererOptions {
        dithering: false,
        predictable_texture_filtering: true,
        ..RendererOptions::default()
    };
    let mut renderer = Renderer::new(device, format, options);
    for (id, deltas) in textures.set.drain() {
        for delta in deltas {
            renderer.update_texture(device, queue, id, &delta);
        }
    }
    textures.clear();
    let screen = ScreenDescriptor {
        size_in_pixels: SIZE,
        pixels_per_point: scale,
    };
    let size = wgpu::Extent3d {
        width: SIZE[0],
        height: SIZE[1],
        depth_or_array_layers: 1,
    };
    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let copy = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(4 * SIZE[0] * SIZE[1]),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    renderer.update_buffers(device, queue, &mut encoder, primitives, &screen);
    let [r, g, b, a] = GROUND.to_array().map(|channel| f64::from(channel) / 255.0);
    let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &target.create_view(&wgpu::TextureViewDescriptor::default()),
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..wgpu::RenderPassDescriptor::default()
    });
    renderer.render(&mut pass.forget_lifetime(), primitives, &screen);
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        // A multiple of 256, as copies need it.
        bytes_per_row: Some(4 * SIZE[0]),
        rows_per_image: None,
    };
    encoder.copy_texture_to_buffer(
        target.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &copy,
            layout,
        },
        size,
    );
    queue.submit([encoder.finish()]);
    copy.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    copy.get_mapped_range(..).unwrap().to_vec()
}

/// The difference that at most one in 2000 channels may exceed: egui's shader and ours round at
/// different places, and a pixel whose centre lies on an edge may fall to either side.
const STEPS: u8 = 3;

#[test]
fn the_processor_draws_like_a_gpu() {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let options = wgpu::RequestAdapterOptions::default();
    let Ok(adapter) = pollster::block_on(instance.request_adapter(&options)) else {
        assert!(
            std::env::var_os("CI").is_none(),
            "no graphics adapter: install mesa-vulkan-drivers"
        );
        eprintln!("skipped: no graphics adapter here; install mesa-vulkan-drivers");
        return;
    };
    let (device, queue) =
        pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default())).unwrap();
    for scale in [1.0, 1.5, 2.0] {
        let (primitives, textures) = frame(scale);
        let theirs = on_gpu(&device, &queue, &primitives, textures.clone(), scale);
        let ours = on_processor(&primitives, textures, scale);
        assert_eq!(ours.len(), theirs.len());
        let apart = ours
            .iter()
            .zip(&theirs)
            .filter(|(a, b)| a.abs_diff(**b) > STEPS)
            .count();
        let drawn = theirs
            .chunks(4)
            .filter(|pixel| *pixel != GROUND.to_array())
            .count();
        assert!(drawn > theirs.len() / 8, "the GPU drew nothing");
        assert!(
            apart * 2000 <= ours.len(),
            "at scale {scale}, {apart} of {} channels differ",
            ours.len()
        );
    }
}
