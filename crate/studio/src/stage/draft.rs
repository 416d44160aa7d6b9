//! The draft on its way to the screen: a texture of egui's that is drawn anew when the scene, the
//! camera or the size changes.
//!
//! While something moves it has as few pixels as it takes to keep up ([`Pace`]); once it rests,
//! all.

use crate::stage::live::Made;
use egui::{Context, TextureId};
use egui_wgpu::{RenderState, wgpu};
use preview::{Pace, Stage, Target, Tracer};
use scene::Camera;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Seconds without a change after which all pixels are drawn.
const REST: f64 = 0.15;
/// Seconds over which frames are counted.
const COUNTED: f64 = 0.5;
/// Seconds after which a frame counts as done, though the card does not say so.
const LONGEST: f64 = 3.0;

/// A frame that the card is drawing.
struct Running {
    is_done: Arc<AtomicBool>,
    start: f64,
    /// Length of its sides over those of the picture.
    scale: f64,
}

/// The draft and where it is drawn.
pub struct Draft {
    state: RenderState,
    tracer: Tracer,
    /// Number of the packed scene on the card, and whether there was room for it.
    scene: Option<(u64, bool)>,
    /// The scene, the camera and the place, and when they changed.
    subject: Option<(u64, Camera, [f32; 2])>,
    moved: f64,
    /// Whether the subject was drawn with all pixels.
    is_settled: bool,
    drawn: Option<(u64, Camera, [u32; 2])>,
    running: Option<Running>,
    pace: Pace,
    /// egui's name for the texture, and its size.
    texture: Option<(TextureId, [u32; 2])>,
    /// Frames since a moment.
    counted: (u32, f64),
    /// Frames a second, while something moved.
    pub fps: Option<u32>,
}

impl Draft {
    /// Makes a draft on the window's device.
    #[must_use]
    pub fn new(state: RenderState) -> Self {
        // Both WebGPU and WebGL2 have it.
        let tracer = Tracer::new(&state.device, Stage::Fragment, cells::formulas::none);
        Self {
            state,
            tracer,
            scene: None,
            subject: None,
            moved: 0.0,
            is_settled: false,
            drawn: None,
            running: None,
            pace: Pace::default(),
            texture: None,
            counted: (0, 0.0),
            fps: None,
        }
    }

    /// Returns the draft of a packed scene, for a place `size` pixels large; `None` if the card has
    /// no room for it.
    pub fn texture(
        &mut self,
        ctx: &Context,
        made: &Made,
        camera: Camera,
        size: [f32; 2],
    ) -> Option<TextureId> {
        let now = browser::now(ctx);
        self.note_end(now);
        let RenderState { device, queue, .. } = &self.state;
        if self.scene.is_none_or(|(number, _)| number != made.number) {
            let has = self
                .tracer
                .set_scene(device, queue, &made.scene, &made.packed)
                .is_some();
            self.scene = Some((made.number, has));
        }
        if !self.scene?.1 {
            return None;
        }
        let subject = (made.number, camera, size);
        if self.subject != Some(subject) {
            self.subject = Some(subject);
            self.moved = now;
            self.is_settled = false;
        }
        let rests = now - self.moved >= REST;
        let scale = if rests {
            self.pace.still()
        } else {
            self.pace.scale()
        };
        let largest = f64::from(device.limits().max_texture_dimension_2d);
        let longest = f64::from(size[0].max(size[1]).max(1.0));
        let scale = scale.min(largest / longest);
        let pixels = size.map(|side| (f64::from(side) * scale).round().clamp(1.0, largest) as u32);
        let wanted = (made.number, camera, pixels);
        if self.running.is_none() && !self.is_settled {
            self.is_settled = rests;
            if self.drawn != Some(wanted) {
                self.draw(wanted, scale, now);
            }
        }
        if self.running.is_some() {
            ctx.request_repaint();
        } else if !self.is_settled {
            ctx.request_repaint_after_secs(REST as f32);
        }
        self.texture.map(|(id, _)| id)
    }

    /// Takes note of a frame that is done.
    fn note_end(&mut self, now: f64) {
        // It fails when the device is lost, which then draws nothing more.
        let _ = self.state.device.poll(wgpu::PollType::Poll);
        let done = self.running.take_if(|running| {
            running.is_done.load(Ordering::Relaxed) || now - running.start > LONGEST
        });
        let Some(done) = done else {
            return;
        };
        let seconds = now - done.start;
        if seconds <= LONGEST {
            // Else nobody looked at it meanwhile.
            self.pace.note(seconds, done.scale);
        }
        self.counted.0 += 1;
        let seconds = now - self.counted.1;
        if seconds >= COUNTED {
            // Frames of a hand that rested in between are not counted.
            if seconds < 2.0 * COUNTED {
                self.fps = Some((f64::from(self.counted.0) / seconds).round() as u32);
            }
            self.counted = (0, now);
        }
    }

    /// Draws a frame, its sides some share of the picture's.
    fn draw(&mut self, wanted: (u64, Camera, [u32; 2]), scale: f64, now: f64) {
        let RenderState { device, queue, .. } = &self.state;
        let (_, camera, size) = wanted;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor {
            label: Some("draft"),
        });
        let target = self
            .tracer
            .render(device, queue, &mut encoder, &camera, size);
        let Some(Target::Picture(picture)) = target else {
            return;
        };
        let view = picture.create_view(&wgpu::TextureViewDescriptor::default());
        queue.submit([encoder.finish()]);
        let is_done = Arc::new(AtomicBool::new(false));
        let done = is_done.clone();
        queue.on_submitted_work_done(move || done.store(true, Ordering::Relaxed));
        self.running = Some(Running {
            is_done,
            start: now,
            scale,
        });
        self.drawn = Some(wanted);
        if self.texture.is_none_or(|(_, known)| known != size) {
            let mut renderer = self.state.renderer.write();
            let filter = wgpu::FilterMode::Linear;
            let id = match self.texture {
                Some((id, _)) => {
                    renderer.update_egui_texture_from_wgpu_texture(device, &view, filter, id);
                    id
                }
                None => renderer.register_native_texture(device, &view, filter),
            };
            self.texture = Some((id, size));
        }
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if let Some((id, _)) = self.texture {
            self.state.renderer.write().free_texture(&id);
        }
    }
}
