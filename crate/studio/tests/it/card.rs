//! The draft on a graphics card.

use crate::driver::Window;
use egui::mutex::RwLock;
use egui::vec2;
use egui_kittest::kittest::Queryable;
use egui_wgpu::{RenderState, Renderer, RendererOptions, wgpu};
use std::sync::Arc;

const BALLS: &str = "eyep 0 0 9\nvrp 0 0 0\nframesize 320 240\nlight 1 1 1 point, position 4 6 8\n\
    surface a, diffuse Red, blobbiness -0.6\nsphere a 0.9, -1.2 0 0\nsphere a 0.9, 1.2 0 0\n";

/// Returns what eframe makes for a window, if this machine has an adapter.
fn card() -> Option<RenderState> {
    let descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    let instance = wgpu::Instance::new(descriptor);
    let options = wgpu::RequestAdapterOptions::default();
    let adapter = pollster::block_on(instance.request_adapter(&options)).ok()?;
    let descriptor = wgpu::DeviceDescriptor {
        required_limits: wgpu::Limits::downlevel_webgl2_defaults(),
        ..wgpu::DeviceDescriptor::default()
    };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).ok()?;
    let target_format = wgpu::TextureFormat::Rgba8Unorm;
    let renderer = Renderer::new(&device, target_format, RendererOptions::default());
    Some(RenderState {
        adapter,
        available_adapters: Vec::new(),
        instance,
        device,
        queue,
        target_format,
        renderer: Arc::new(RwLock::new(renderer)),
    })
}

fn stand_in(window: &Window) -> Option<&'static str> {
    window.parts.outbox.borrow().report.stand_in
}

/// Runs until the card's draft is on the screen.
fn wait(window: &mut Window) {
    for _ in 0..2000 {
        window.steps(1);
        if stand_in(window) == Some("draft") {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("no draft");
}

#[test]
fn the_card_draws_while_a_hand_turns_the_model() {
    let Some(state) = card() else {
        assert!(std::env::var_os("CI").is_none(), "no graphics adapter");
        eprintln!("skipped: no graphics adapter here; install mesa-vulkan-drivers");
        return;
    };
    let mut window = Window::open_on_card(1000.0, 700.0, state);
    window.load(BALLS);
    window.finish();
    // The traced picture is enough.
    assert_eq!(stand_in(&window), None);
    let button = window.place("show draft").center();
    window.click(button);
    wait(&mut window);
    let picture = window.place("picture");
    let camera = window.parts.outbox.borrow().camera;
    let from = picture.center() - vec2(0.3 * picture.width(), 0.3 * picture.height());
    window.drag(from, picture.center());
    assert_eq!(stand_in(&window), Some("draft"));
    assert_ne!(window.parts.outbox.borrow().camera, camera);
    // What the text says now is drawn next; until then, what it said before.
    window.edit();
    window.write("sphere a 0.5, 0 2 0\n");
    assert_eq!(stand_in(&window), Some("draft"));
    wait(&mut window);
}

const FILM: &str = "framesize 32 24\neyep 0 0 6\nlight White point, position 4 6 8\n\
    surface flesh, diffuse Coral, blobbiness -2\nvar x = 0\nvar x += 0.5\n\
    sphere flesh 0.5, x 0 0\n";

#[test]
fn a_film_is_saved_as_the_card_draws_it() {
    let Some(state) = card() else {
        assert!(std::env::var_os("CI").is_none(), "no graphics adapter");
        eprintln!("skipped: no graphics adapter here; install mesa-vulkan-drivers");
        return;
    };
    let mut window = Window::open_on_card(1000.0, 700.0, state);
    window.load(FILM);
    window.finish();
    let first = window.image();
    window.harness.get_by_label("Number of frames").click();
    window.steps(2);
    for _ in 0..2 {
        window.key(egui::Modifiers::NONE, egui::Key::Backspace);
    }
    window.write("3");
    window.key(egui::Modifiers::NONE, egui::Key::Enter);
    for place in ["save film", "film draft 240", "download png"] {
        let at = window.place(place).center();
        window.click(at);
    }
    let bytes = (0..2000).find_map(|_| {
        window.steps(1);
        std::thread::sleep(std::time::Duration::from_millis(5));
        browser::last_download()
    });
    let (name, bytes) = bytes.expect("a film");
    assert_eq!(name, "Main-film.png");
    let decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    let mut reader = decoder.read_info().unwrap();
    assert_eq!(reader.info().size(), (320, 240));
    let mut frames = Vec::new();
    for _ in 0..3 {
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let bytes = reader.info().bytes_per_pixel();
        let red = pixels
            .chunks(bytes)
            .filter(|p| p[0] > p[2].saturating_add(40));
        frames.push((red.count(), pixels));
    }
    // The ball is there, and moves.
    assert!(frames.iter().all(|(red, _)| *red > 500), "{}", frames[0].0);
    assert!(frames[0].1 != frames[1].1 && frames[1].1 != frames[2].1);
    // The picture that was there is traced again.
    window.finish();
    assert!(window.image() == first);
}

#[test]
fn a_lost_card_ends_nothing() {
    let Some(state) = card() else {
        assert!(std::env::var_os("CI").is_none(), "no graphics adapter");
        eprintln!("skipped: no graphics adapter here; install mesa-vulkan-drivers");
        return;
    };
    let device = state.device.clone();
    let mut window = Window::open_on_card(1000.0, 700.0, state);
    window.load(BALLS);
    window.finish();
    let button = window.place("show draft").center();
    window.click(button);
    wait(&mut window);
    device.destroy();
    let picture = window.place("picture");
    let from = picture.center() - vec2(0.3 * picture.width(), 0.3 * picture.height());
    window.drag(from, picture.center());
    // The traced picture needs no card.
    window.finish();
    assert!(!window.image().is_empty());
}
