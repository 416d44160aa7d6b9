//! The draft on its way to the screen: drawn when the scene, the camera or the size changed, and
//! given to egui as a texture.

use crate::session::Session;
use egui::TextureId;
use egui_wgpu::{RenderState, wgpu};
use scene::Camera;

/// The draft and where it is drawn.
pub struct Draft {
    state: RenderState,
    draft: preview::Draft,
    /// The session's generation that was uploaded.
    scene: Option<u64>,
    drawn: Option<(u64, Camera, [u32; 2])>,
    /// egui's name for the texture, and the draft's count of textures.
    texture: Option<(TextureId, u64)>,
}

impl Draft {
    /// A draft on the window's device.
    #[must_use]
    pub fn new(state: RenderState) -> Self {
        let draft = preview::Draft::new(&state.device, &state.queue);
        Self {
            state,
            draft,
            scene: None,
            drawn: None,
            texture: None,
        }
    }

    /// The draft of the session's scene, `size` pixels large; `None` before there is a scene.
    pub fn texture(&mut self, session: &Session, size: [f32; 2]) -> Option<TextureId> {
        let RenderState { device, queue, .. } = &self.state;
        let size = size.map(|side| side.clamp(1.0, 8192.0) as u32);
        if self.scene != Some(session.generation()) {
            let scene = session.scene()?;
            self.draft.set_scene(device, queue, &scene);
            self.scene = Some(session.generation());
        }
        let wanted = (session.generation(), session.camera(), size);
        if self.drawn != Some(wanted) {
            self.drawn = Some(wanted);
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor {
                label: Some("draft"),
            });
            let view = self
                .draft
                .render(device, queue, &mut encoder, &wanted.1, size)
                .clone();
            queue.submit([encoder.finish()]);
            let made = self.draft.generation();
            if self.texture.is_none_or(|(_, known)| known != made) {
                let mut renderer = self.state.renderer.write();
                let filter = wgpu::FilterMode::Linear;
                let id = match self.texture {
                    Some((id, _)) => {
                        renderer.update_egui_texture_from_wgpu_texture(device, &view, filter, id);
                        id
                    }
                    None => renderer.register_native_texture(device, &view, filter),
                };
                self.texture = Some((id, made));
            }
        }
        self.texture.map(|(id, _)| id)
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        if let Some((id, _)) = self.texture {
            self.state.renderer.write().free_texture(&id);
        }
    }
}
