//! The materials' colours, as a texture that the shaders look them up in. A texture, because a
//! scene may have thousands of materials and WebGL2 has no storage buffers.

use cells::{draft_colours, finite, with};
use scene::{Finish, Scene};

/// Materials in a row of the texture; as in `shaders/view.wgsl`. Three texels each: 1536 wide,
/// less than the 2048 that every device can do.
const MATERIALS_A_ROW: usize = 512;
const TEXELS: usize = 3;

/// Makes the texture. Materials beyond the last row that the device can do are left out; elements
/// made of them are black.
pub(crate) fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    scene: &Scene,
) -> wgpu::TextureView {
    let rows_limit = device.limits().max_texture_dimension_2d as usize;
    let kept = scene.finishes.len().min(rows_limit * MATERIALS_A_ROW - 1);
    let fallback = Finish::default();
    let rows = (kept + 1).div_ceil(MATERIALS_A_ROW);
    let mut texels = vec![[0.0f32; 4]; rows * MATERIALS_A_ROW * TEXELS];
    let all = scene.finishes[..kept].iter().chain([&fallback]);
    for (texel, material) in texels.chunks_exact_mut(TEXELS).zip(all) {
        let [ambient, diffuse] = draft_colours(material, scene.background.mean());
        texel[0] = with(ambient, finite(material.shine).max(0.0));
        texel[1] = with(diffuse, 0.0);
        texel[2] = with(material.specular, 0.0);
    }
    let size = wgpu::Extent3d {
        width: (MATERIALS_A_ROW * TEXELS) as u32,
        height: rows as u32,
        depth_or_array_layers: 1,
    };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("materials"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    queue.write_texture(
        texture.as_image_copy(),
        bytemuck::cast_slice(&texels),
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(size.width * 16),
            rows_per_image: None,
        },
        size,
    );
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
