//! The materials' colours, as a texture that the shaders look them up in. A texture, because a
//! scene may have thousands of materials and WebGL2 has no storage buffers.

use glam::DVec3;
use scene::{Finish, Rgb, Scene};
use texture::{Method, Target};

/// Materials in a row of the texture; as in `shaders/view.wgsl`. Three texels each: 1536 wide,
/// less than the 2048 that every device can do.
const MATERIALS_A_ROW: usize = 512;
const TEXELS: usize = 3;

/// Makes the texture. Materials beyond the last row that the device can do are left out; elements
/// made of them get the last of [`Table::count`].
pub(crate) fn upload(device: &wgpu::Device, queue: &wgpu::Queue, scene: &Scene) -> Table {
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
    Table {
        view: texture.create_view(&wgpu::TextureViewDescriptor::default()),
        count: kept,
    }
}

/// The share of the background's mean colour that mirrors and glass show.
const AROUND: f32 = 0.6;

/// The ambient and diffuse colours of a material under its textures: each pattern counts as if it
/// were half its lowest and half its highest value everywhere, which is what the draft shows of it.
/// A mirror or glass without colours of its own would be black: its reflective and transparent
/// share gives it a grey, and a part of the background's colour `around`.
pub(crate) fn draft_colours(material: &Finish, around: Rgb) -> [Rgb; 2] {
    let mut colours = [material.ambient, material.diffuse];
    for layer in &material.layers {
        let targets: &[usize] = match layer.target {
            Target::Ambient => &[0],
            Target::Diffuse => &[1],
            Target::Pigment => &[0, 1],
            _ => continue,
        };
        let middle = match layer.method {
            Method::Colour(colour) => colour,
            _ => DVec3::splat(0.5),
        };
        let [low, high] = layer.bounds;
        let value = (layer.times * (low + (high - low) * middle)).as_vec3();
        for &target in targets {
            let old = colours[target];
            // An ambient light that is replaced keeps its share of the colour.
            let scale = if layer.replace && target == 1 {
                [1.0; 3]
            } else {
                old
            };
            colours[target] = [0, 1, 2].map(|i| scale[i] * value[i]);
        }
    }
    let [ambient, diffuse] = colours;
    let through = [0, 1, 2].map(|i| material.reflective[i] + material.transparent[i]);
    [
        [0, 1, 2].map(|i| ambient[i] + AROUND * (through[i] * around[i]).clamp(0.0, 1.0)),
        [0, 1, 2].map(|i| diffuse[i].max(0.35 * through[i].min(1.0))),
    ]
}

/// The uploaded materials.
pub(crate) struct Table {
    pub(crate) view: wgpu::TextureView,
    count: usize,
}

impl Table {
    /// Returns a material's place in the table, or that of the default material for an index that
    /// has none.
    pub(crate) fn slot(&self, material: usize) -> u32 {
        material.min(self.count) as u32
    }
}

/// Returns a colour as finite numbers, with a fourth one.
pub(crate) fn with([red, green, blue]: Rgb, fourth: f32) -> [f32; 4] {
    [finite(red), finite(green), finite(blue), fourth]
}

/// Returns the number if it is finite, else 0: a GPU may do anything with others.
pub(crate) fn finite(x: f32) -> f32 {
    if x.is_finite() { x } else { 0.0 }
}
