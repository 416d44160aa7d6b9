//! The draft where the processor draws the window. A graphics card that the browser emulates draws
//! it small, and it is read back into a texture of egui's.
//!
//! A traced picture that comes soon needs the processor more, so the card is asked for only after
//! the draft was wanted for [`PATIENCE`].

use browser;
use document::session::Session;
use egui::{ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use egui_wgpu::wgpu;
use preview::Sampling;
use scene::Camera;
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// Seconds that a draft is wanted in vain before the card is asked for.
const PATIENCE: f64 = 0.5;
/// Seconds between two checks for a picture on its way back: a card that is lost never sends it.
const CHECK: f32 = 0.02;
/// Longest side of the draft, pixels.
const LARGEST: f32 = 360.0;

/// The draft, and whether there can be one.
#[derive(Default)]
pub struct Apart {
    card: Rc<RefCell<Card>>,
    /// Seconds on the app's clock when the draft began to be wanted, and when it last was.
    wanted: Option<[f64; 2]>,
}

/// The emulated graphics card.
#[derive(Default)]
enum Card {
    /// The card was not asked for.
    #[default]
    Unknown,
    /// The card was asked for, or refused.
    Away,
    /// The card is there.
    Here(Box<Drawer>),
}

impl Apart {
    /// Returns the draft of the session's scene at a size in pixels; `None` until there is one.
    pub fn texture(
        &mut self,
        ctx: &Context,
        session: &Session,
        size: [f32; 2],
    ) -> Option<TextureId> {
        let now = browser::now(ctx);
        let known = self.wanted.filter(|[_, last]| now - last < PATIENCE);
        let begun = known.map_or(now, |[begun, _]| begun);
        self.wanted = Some([begun, now]);
        let card = &mut *self.card.borrow_mut();
        match card {
            // The last drawing is of another camera or scene.
            Card::Here(drawer) => drawer.texture(ctx, session, size, known.is_some()),
            Card::Away => None,
            Card::Unknown if now - begun < PATIENCE => {
                ctx.request_repaint_after_secs((PATIENCE / 4.0) as f32);
                None
            }
            Card::Unknown => {
                *card = Card::Away;
                let (place, ctx) = (Rc::downgrade(&self.card), ctx.clone());
                browser::ask_emulated_card(move |device, queue| {
                    if let Some(place) = place.upgrade() {
                        *place.borrow_mut() = Card::Here(Box::new(Drawer::new(device, queue)));
                        ctx.request_repaint();
                    }
                });
                None
            }
        }
    }
}

/// Key of a drawing: the session's generation, the camera, the size.
type Subject = (u64, Camera, [u32; 2]);

/// A picture on its way back from the card.
struct Coming {
    buffer: wgpu::Buffer,
    /// Bytes from one row to the next.
    stride: usize,
    size: [usize; 2],
    /// 0 until it has come, then [`DONE`] or [`LOST`].
    state: Arc<AtomicU8>,
}

const DONE: u8 = 1;
const LOST: u8 = 2;

struct Drawer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    draft: preview::Draft,
    scene: Option<u64>,
    drawn: Option<Subject>,
    coming: Option<Coming>,
    texture: Option<TextureHandle>,
}

impl Drawer {
    fn new(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let mut draft = preview::Draft::new(&device, &queue);
        draft.set_sampling(Sampling::One);
        Self {
            device,
            queue,
            draft,
            scene: None,
            drawn: None,
            coming: None,
            texture: None,
        }
    }

    /// Returns the last draft that came back, even one of an older camera or scene if others were
    /// shown just before (`follows`).
    fn texture(
        &mut self,
        ctx: &Context,
        session: &Session,
        size: [f32; 2],
        follows: bool,
    ) -> Option<TextureId> {
        self.take(ctx);
        if !follows {
            self.texture = None;
            self.drawn = None;
            self.coming = None;
        }
        let scale = (LARGEST / size[0].max(size[1]).max(1.0)).min(1.0);
        let size = size.map(|side| (side * scale).round().max(1.0) as u32);
        let wanted = (session.generation(), session.camera(), size);
        if self.coming.is_none() && self.drawn != Some(wanted) {
            self.draw(session, wanted);
        }
        if self.coming.is_some() {
            ctx.request_repaint_after_secs(CHECK);
        }
        self.texture.as_ref().map(TextureHandle::id)
    }

    /// Draws the subject, and asks the card for the pixels. Does nothing without a scene.
    fn draw(&mut self, session: &Session, subject: Subject) -> Option<()> {
        let Self { device, queue, .. } = self;
        let (generation, camera, size) = subject;
        if self.scene != Some(generation) {
            self.draft.set_scene(device, queue, session.scene()?);
            self.scene = Some(generation);
        }
        self.drawn = Some(subject);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor {
            label: Some("draft"),
        });
        self.draft
            .render(device, queue, &mut encoder, &camera, size);
        let texture = self.draft.texture()?;
        let stride = (4 * texture.width()).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("draft"),
            size: u64::from(stride) * u64::from(texture.height()),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(stride),
                    rows_per_image: None,
                },
            },
            texture.size(),
        );
        let size = [texture.width(), texture.height()].map(|side| side as usize);
        queue.submit([encoder.finish()]);
        let state = Arc::new(AtomicU8::new(0));
        let outcome = state.clone();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            outcome.store(if result.is_ok() { DONE } else { LOST }, Ordering::Relaxed);
        });
        self.coming = Some(Coming {
            buffer,
            stride: stride as usize,
            size,
            state,
        });
        Some(())
    }

    /// Takes in the pixels, if they have come.
    fn take(&mut self, ctx: &Context) {
        // It fails when the device is lost, which then shows no more drafts.
        let _ = self.device.poll(wgpu::PollType::Poll);
        let Some(coming) = self
            .coming
            .take_if(|coming| coming.state.load(Ordering::Relaxed) != 0)
        else {
            return;
        };
        let Ok(bytes) = coming.buffer.get_mapped_range(..) else {
            // Next time the subject is drawn again.
            self.drawn = None;
            return;
        };
        let [width, _] = coming.size;
        let rows = bytes.chunks_exact(coming.stride);
        let rgba: Vec<u8> = rows.flat_map(|row| &row[..4 * width]).copied().collect();
        let image = ColorImage::from_rgba_unmultiplied(coming.size, &rgba);
        match &mut self.texture {
            Some(texture) => texture.set(image, TextureOptions::LINEAR),
            None => self.texture = Some(ctx.load_texture("draft", image, TextureOptions::LINEAR)),
        }
    }
}
