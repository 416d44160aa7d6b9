//! The draft on a graphics card.

use crate::driver::Window;
use egui::mutex::RwLock;
use egui::vec2;
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
