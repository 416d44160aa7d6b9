//! The textures that the draft is drawn into.

use crate::pipelines::{COLOUR, DEPTH, Pipelines};

/// The number of samples of each pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampling {
    /// Four where the picture has at most a million pixels and a graphics processor draws it,
    /// else one: small pictures show jagged edges, large ones cost time.
    #[default]
    Automatic,
    /// A single sample: fastest, for instance while the camera moves on a slow device.
    One,
    /// Four samples, where the device's largest texture allows.
    Four,
}

impl Sampling {
    /// Pixels up to which [`Sampling::Automatic`] takes four samples.
    const FEW_PIXELS: u64 = 1 << 20;

    /// Samples along each side of a pixel. `slow` means that a driver without a graphics processor
    /// does the work.
    fn factor(self, size: [u32; 2], largest: u32, slow: bool) -> u32 {
        let fits = size.iter().all(|&side| side <= largest / 2);
        let wanted = match self {
            Self::Automatic => !slow && u64::from(size[0]) * u64::from(size[1]) <= Self::FEW_PIXELS,
            Self::One => false,
            Self::Four => true,
        };
        if fits && wanted { 2 } else { 1 }
    }
}

/// Textures for one size of picture.
pub(crate) struct Targets {
    asked: ([u32; 2], Sampling),
    /// Size of the finished picture: what was asked for, or less where the device's largest
    /// texture is smaller.
    pub(crate) size: [u32; 2],
    /// Samples across and down.
    pub(crate) samples: [u32; 2],
    pub(crate) picture: wgpu::Texture,
    pub(crate) view: wgpu::TextureView,
    /// The texture into which the samples are drawn if there are several a pixel, and the bindings
    /// by which they are read back.
    pub(crate) oversized: Option<(wgpu::TextureView, wgpu::BindGroup)>,
    pub(crate) depth: wgpu::TextureView,
}

impl Targets {
    pub(crate) fn new(
        device: &wgpu::Device,
        pipelines: &Pipelines,
        asked: [u32; 2],
        sampling: Sampling,
    ) -> Self {
        let largest = device.limits().max_texture_dimension_2d;
        let size = fit(asked, largest);
        let slow = device.adapter_info().device_type == wgpu::DeviceType::Cpu;
        let factor = sampling.factor(size, largest, slow);
        let samples = size.map(|side| side * factor);
        let texture = |label, size: [u32; 2], format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d {
                    width: size[0],
                    height: size[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let readable = attachment | wgpu::TextureUsages::TEXTURE_BINDING;
        let all = wgpu::TextureViewDescriptor::default();
        let picture = texture(
            "draft",
            size,
            COLOUR,
            readable | wgpu::TextureUsages::COPY_SRC,
        );
        let oversized = (factor > 1).then(|| {
            let view = texture("draft's samples", samples, COLOUR, readable).create_view(&all);
            let group = pipelines.bind_samples(device, &view);
            (view, group)
        });
        Self {
            asked: (asked, sampling),
            size,
            samples,
            view: picture.create_view(&all),
            picture,
            oversized,
            depth: texture("draft's depth", samples, DEPTH, attachment).create_view(&all),
        }
    }

    /// Whether these textures serve for a picture of the given size.
    pub(crate) fn serve(&self, size: [u32; 2], sampling: Sampling) -> bool {
        self.asked == (size, sampling)
    }
}

/// The largest size of the same proportions that the device can do, at least one pixel.
fn fit(size: [u32; 2], largest: u32) -> [u32; 2] {
    let longest = size[0].max(size[1]).max(1);
    size.map(|side| {
        let side = if longest > largest {
            (u64::from(side) * u64::from(largest) / u64::from(longest)) as u32
        } else {
            side
        };
        side.max(1)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_large_pictures_shrink_in_proportion() {
        assert_eq!(fit([4000, 1000], 2048), [2048, 512]);
        assert_eq!(fit([u32::MAX, 1], 2048), [2048, 1]);
        assert_eq!(fit([0, 0], 2048), [1, 1]);
        assert_eq!(fit([2048, 2048], 2048), [2048, 2048]);
    }

    #[test]
    fn sampling_follows_size_and_device() {
        assert_eq!(Sampling::Automatic.factor([800, 600], 2048, false), 2);
        assert_eq!(Sampling::Automatic.factor([1600, 1200], 8192, false), 1);
        assert_eq!(Sampling::Four.factor([1600, 1200], 8192, false), 2);
        assert_eq!(Sampling::Four.factor([1600, 1200], 2048, false), 1);
        assert_eq!(Sampling::Automatic.factor([800, 600], 2048, true), 1);
        assert_eq!(Sampling::Four.factor([800, 600], 2048, true), 2);
        assert_eq!(Sampling::One.factor([10, 10], 2048, false), 1);
    }
}
