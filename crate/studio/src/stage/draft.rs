//! The draft on its way to the screen: a texture of egui's that is drawn anew when the scene, the
//! camera or the size changes.
//!
//! While something moves it has as few pixels as it takes to keep up ([`Pace`]); once it rests,
//! all. For a film it draws pictures of any size, which come back from the card.

use crate::stage::live::Made;
use document::picture::Image;
use egui::{Context, TextureId};
use egui_wgpu::{RenderState, wgpu};
use preview::{Copy, Pace, Stage, Target, Tracer};
use scene::Camera;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Seconds without a change after which all pixels are drawn.
const REST: f64 = 0.15;
/// Seconds over which frames are counted.
const COUNTED: f64 = 0.5;
/// Seconds after which a frame counts as done, though the card does not say so.
const LONGEST: f64 = 3.0;

/// Sides of a picture for a film, on the card, over those in the film.
const FINER: u32 = 2;

/// A frame that the card is drawing.
struct Running {
    is_done: Arc<AtomicBool>,
    start: f64,
    /// Length of its sides over those of the picture.
    scale: f64,
}

/// A scene's number, its camera, and a size in pixels.
type Drawn = (u64, Camera, [u32; 2]);

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
    drawn: Option<Drawn>,
    running: Option<Running>,
    /// A picture for a film, on its way back: of which scene, how large, and the factor on its
    /// sides.
    copy: Option<(Drawn, u32, Copy)>,
    pace: Pace,
    /// egui's name for the texture, and its size.
    texture: Option<(TextureId, [u32; 2])>,
    /// Frames since a moment.
    counted: (u32, f64),
    /// Frames a second, while something moved.
    pub fps: Option<u32>,
    /// Why the card does not draw the last scene, in its own words.
    pub refusal: Option<String>,
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
            copy: None,
            pace: Pace::default(),
            texture: None,
            counted: (0, 0.0),
            fps: None,
            refusal: None,
        }
    }

    /// Returns the draft of a packed scene, for a place `size` pixels large; `None` if the card has
    /// no room for it, or refuses it.
    pub fn texture(
        &mut self,
        ctx: &Context,
        made: &Made,
        camera: Camera,
        size: [f32; 2],
    ) -> Option<TextureId> {
        let now = browser::now(ctx);
        self.note_end(now);
        if !self.takes(made)? {
            ctx.request_repaint();
            return self.texture_of_work();
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
        let largest = f64::from(self.state.device.limits().max_texture_dimension_2d);
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
        self.texture_of_work()
    }

    /// Returns the texture, if something of this work was drawn.
    fn texture_of_work(&self) -> Option<TextureId> {
        self.drawn.and(self.texture).map(|(id, _)| id)
    }

    /// Forgets what was drawn, when another work was opened.
    pub fn forget(&mut self) {
        self.drawn = None;
        self.running = None;
        self.copy = None;
        self.refusal = None;
    }

    /// Hands a packed scene to the card. Returns whether it may be drawn already; `None` if the
    /// card refuses it.
    fn takes(&mut self, made: &Made) -> Option<bool> {
        let RenderState { device, queue, .. } = &self.state;
        if self.scene.is_none_or(|(number, _)| number != made.number) {
            let has = self
                .tracer
                .set_scene(device, queue, &made.scene, &made.packed)
                .is_some();
            self.scene = Some((made.number, has));
            self.refusal = (!has).then(|| "it has no room for this model".to_owned());
        }
        if !self.scene?.1 {
            return None;
        }
        match self.tracer.is_ready() {
            Ok(is_ready) => Some(is_ready),
            Err(words) => {
                // The last line has the reason of those before it.
                let mut lines = words.lines().map(str::trim).filter(|line| !line.is_empty());
                self.refusal = Some(lines.next_back().unwrap_or_default().to_owned());
                self.scene = Some((made.number, false));
                None
            }
        }
    }

    /// Draws a packed scene for a film, `is_finer` with four rays a pixel. `None` as long as the
    /// picture is on its way: until then it must be called again.
    ///
    /// # Errors
    /// In words, if the card does not draw it.
    pub fn shoot(
        &mut self,
        made: &Made,
        camera: Camera,
        size: [u32; 2],
        is_finer: bool,
    ) -> Option<Result<Image, String>> {
        // It fails when the device is lost.
        let _ = self.state.device.poll(wgpu::PollType::Poll);
        let wanted = (made.number, camera, size);
        let copy = self.copy.take().filter(|(own, ..)| *own == wanted);
        if let Some((_, factor, copy)) = copy {
            let Some(pixels) = copy.pixels() else {
                self.copy = Some((wanted, factor, copy));
                return None;
            };
            let image = pixels.map(|pixels| Image {
                size,
                rgba: shrink(&pixels, size, factor),
            });
            return Some(image);
        }
        match self.takes(made) {
            Some(true) => {}
            Some(false) => return None,
            None => {
                let why = self.refusal.as_deref().unwrap_or_default();
                return Some(Err(format!("The card does not draw a frame: {why}.")));
            }
        }
        let RenderState { device, queue, .. } = &self.state;
        let most = device.limits().max_texture_dimension_2d;
        let is_finer = is_finer && FINER * size[0].max(size[1]) <= most;
        let factor = if is_finer { FINER } else { 1 };
        let label = Some("frame of a film");
        let mut commands = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
        let pixels = size.map(|side| factor * side);
        let target = self
            .tracer
            .render(device, queue, &mut commands, &camera, pixels);
        let Some(Target::Picture(picture)) = target else {
            return Some(Err(String::from("The card does not draw a frame.")));
        };
        let copy = Copy::begin(device, queue, commands, picture);
        self.copy = Some((wanted, factor, copy));
        // The next picture on the screen is drawn into another texture.
        if let Some((_, size)) = &mut self.texture {
            *size = [0; 2];
        }
        None
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

/// Returns a picture of some size from one whose sides are some times as long: the mean of its
/// pixels.
fn shrink(pixels: &[u8], size: [u32; 2], factor: u32) -> Vec<u8> {
    if factor == 1 {
        return pixels.to_vec();
    }
    let [width, height] = size.map(|side| side as usize);
    let factor = factor as usize;
    let (row, count) = (4 * factor * width, factor * factor);
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let all = places.flat_map(|(x, y)| {
        core::array::from_fn::<u8, 4, _>(|channel| {
            let own = (0..count).map(|i| {
                let (x, y) = (factor * x + i % factor, factor * y + i / factor);
                usize::from(pixels[y * row + 4 * x + channel])
            });
            ((own.sum::<usize>() + count / 2) / count) as u8
        })
    });
    all.collect()
}

impl Drop for Draft {
    fn drop(&mut self) {
        if let Some((id, _)) = self.texture {
            self.state.renderer.write().free_texture(&id);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_shrink_to_the_mean_of_their_pixels() {
        // Two rows of four, of which each four become one.
        let pixels = (0..8).flat_map(|i: u8| [i, 10 * i, 255, 0]);
        let pixels: Vec<u8> = pixels.collect();
        let small = [[3, 25, 255, 0], [5, 45, 255, 0]];
        assert_eq!(shrink(&pixels, [2, 1], 2), small.as_flattened());
        assert_eq!(shrink(&pixels, [4, 2], 1), pixels);
    }
}
