//! A wgpu device and surface that draw nothing.
//!
//! eframe's window needs a device, a surface and pipelines. wgpu's own stand-in backend ("noop")
//! has a device that takes everything and does nothing, but its surface supports no format, so
//! eframe would refuse it. [`Idle`] is an instance whose surface claims the usual format and never
//! has a texture to draw on. eframe takes this for a window that is covered, and skips the frame.

use egui_wgpu::{WgpuSetup, WgpuSetupExisting};
use wgpu::custom::{
    DispatchAdapter, DispatchDevice, DispatchSurface, DispatchSurfaceOutputDetail, DispatchTexture,
    EnumerateAdapterFuture, InstanceInterface, RequestAdapterFuture, SurfaceInterface,
    SurfaceOutputDetailInterface,
};

use std::pin::Pin;

/// The largest side of a texture: the font atlas and the traced picture must fit.
const MAX_TEXTURE_SIDE: u32 = 8192;

/// Makes a setup for eframe that draws nothing.
///
/// # Errors
/// If wgpu cannot make its stand-in device, with its message.
pub async fn setup() -> Result<WgpuSetup, String> {
    let noop = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::NOOP,
        backend_options: wgpu::BackendOptions {
            noop: wgpu::NoopBackendOptions::enabled(),
            ..Default::default()
        },
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapter = noop
        .request_adapter(&wgpu::RequestAdapterOptions::default())
        .await
        .map_err(|error| error.to_string())?;
    let (device, queue) = adapter
        .request_device(&wgpu::DeviceDescriptor {
            label: Some("no GPU"),
            required_limits: wgpu::Limits {
                max_texture_dimension_2d: MAX_TEXTURE_SIDE,
                ..Default::default()
            },
            ..Default::default()
        })
        .await
        .map_err(|error| error.to_string())?;
    Ok(WgpuSetup::Existing(WgpuSetupExisting {
        instance: wgpu::Instance::from_custom(Idle),
        adapter,
        device,
        queue,
    }))
}

/// An instance, and its surfaces.
#[derive(Debug)]
struct Idle;

impl InstanceInterface for Idle {
    fn new(_: wgpu::InstanceDescriptor) -> Self {
        Self
    }

    // The trait demands the keyword; nothing here touches the handle in the target.
    #[allow(unsafe_code)]
    unsafe fn create_surface(
        &self,
        _: wgpu::SurfaceTargetUnsafe,
    ) -> Result<DispatchSurface, wgpu::CreateSurfaceError> {
        Ok(DispatchSurface::custom(Self))
    }

    fn request_adapter(
        &self,
        _: &wgpu::RequestAdapterOptions<'_, '_>,
    ) -> Pin<Box<dyn RequestAdapterFuture>> {
        Box::pin(std::future::ready(Err(
            wgpu::RequestAdapterError::NotFound {
                active_backends: wgpu::Backends::empty(),
                requested_backends: wgpu::Backends::empty(),
                supported_backends: wgpu::Backends::empty(),
                no_fallback_backends: wgpu::Backends::empty(),
                no_adapter_backends: wgpu::Backends::empty(),
                incompatible_surface_backends: wgpu::Backends::empty(),
            },
        )))
    }

    fn poll_all_devices(&self, _: bool) -> bool {
        true
    }

    fn wgsl_language_features(&self) -> wgpu::WgslLanguageFeatures {
        wgpu::WgslLanguageFeatures::empty()
    }

    fn enumerate_adapters(&self, _: wgpu::Backends) -> Pin<Box<dyn EnumerateAdapterFuture>> {
        Box::pin(std::future::ready(Vec::new()))
    }
}

impl SurfaceInterface for Idle {
    fn get_capabilities(&self, _: &DispatchAdapter) -> wgpu::SurfaceCapabilities {
        wgpu::SurfaceCapabilities {
            formats: vec![wgpu::TextureFormat::Rgba8Unorm],
            format_capabilities: Vec::new(),
            present_modes: vec![wgpu::PresentMode::Fifo],
            alpha_modes: vec![wgpu::CompositeAlphaMode::Opaque],
            usages: wgpu::TextureUsages::RENDER_ATTACHMENT,
        }
    }

    fn configure(&self, _: &DispatchDevice, _: &wgpu::SurfaceConfiguration) {}

    fn get_current_texture(
        &self,
    ) -> (
        Option<DispatchTexture>,
        wgpu::SurfaceStatus,
        DispatchSurfaceOutputDetail,
    ) {
        (
            None,
            wgpu::SurfaceStatus::Occluded,
            DispatchSurfaceOutputDetail::custom(NoTexture),
        )
    }
}

#[derive(Debug)]
struct NoTexture;

impl SurfaceOutputDetailInterface for NoTexture {
    fn texture_discard(&self) {}
    fn texture_release(&self) {}
}
