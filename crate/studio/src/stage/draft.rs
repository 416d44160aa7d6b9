//! The draft on its way to the screen: a texture of egui's that is drawn anew when the scene, the
//! camera or the size changes.

use crate::stage::live::Made;
use document::session::Session;
use egui::TextureId;
use egui_wgpu::{RenderState, wgpu};
use scene::Camera;

/// The draft and where it is drawn.
pub struct Draft {
    state: RenderState,
    draft: preview::Draft,
    /// The uploaded scene and mesh: the session's count of shapes, and the number of a mesh.
    scene: Option<u64>,
    mesh: Option<u64>,
    drawn: Option<(u64, Option<u64>, Camera, [u32; 2])>,
    /// egui's name for the texture, and the draft's count of textures.
    texture: Option<(TextureId, u64)>,
}

impl Draft {
    /// Makes a draft on the window's device.
    #[must_use]
    pub fn new(state: RenderState) -> Self {
        let draft = preview::Draft::new(&state.device, &state.queue);
        Self {
            state,
            draft,
            scene: None,
            mesh: None,
            drawn: None,
            texture: None,
        }
    }

    /// Returns the draft of the session's scene, `size` pixels large, with a mesh in place of its
    /// soft elements if there is one; `None` before there is a scene.
    pub fn texture(
        &mut self,
        session: &Session,
        size: [f32; 2],
        mesh: Option<&Made>,
    ) -> Option<TextureId> {
        let RenderState { device, queue, .. } = &self.state;
        let size = size.map(|side| side.clamp(1.0, 8192.0) as u32);
        if self.scene != Some(session.shape()) {
            let scene = session.scene()?;
            self.draft.set_scene(device, queue, scene);
            self.scene = Some(session.shape());
        }
        let number = mesh.map(|made| made.number);
        if self.mesh != number {
            self.mesh = number;
            let mesh = mesh.map(Made::mesh);
            self.draft.set_mesh(device, queue, mesh.as_ref());
        }
        let wanted = (session.shape(), number, session.camera(), size);
        if self.drawn != Some(wanted) {
            self.drawn = Some(wanted);
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor {
                label: Some("draft"),
            });
            let view = self
                .draft
                .render(device, queue, &mut encoder, &wanted.2, size)
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
