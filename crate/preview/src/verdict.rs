//! The device's verdict on some calls.

use core::future::Future;
use core::pin::Pin;
use core::task::{Context, Poll, Waker};

/// A part of the verdict that may still be to come.
type Part = Pin<Box<dyn Future<Output = Option<wgpu::Error>>>>;

/// The device's verdict on some calls: natively and with WebGL2 it is there at once, with WebGPU
/// some frames later. Errors in it reach nobody else; else they would end a native program.
#[derive(Default)]
pub(crate) struct Verdict {
    parts: Vec<Part>,
    error: Option<String>,
}

impl Verdict {
    /// Makes some calls, and returns what they return with the verdict on them.
    pub(crate) fn on<T>(device: &wgpu::Device, calls: impl FnOnce() -> T) -> (T, Self) {
        let filters = [
            wgpu::ErrorFilter::Validation,
            wgpu::ErrorFilter::OutOfMemory,
            wgpu::ErrorFilter::Internal,
        ];
        let scopes = filters.map(|filter| device.push_error_scope(filter));
        let result = calls();
        let mut verdict = Self::default();
        // wgpu has no word for internal errors of a browser, and would end the page: what was not
        // compiled is then told by the draft that stays away.
        let is_browser = device.adapter_info().backend == wgpu::Backend::BrowserWebGpu;
        for (scope, filter) in scopes.into_iter().zip(filters).rev() {
            let part = Box::pin(scope.pop());
            if !(is_browser && filter == wgpu::ErrorFilter::Internal) {
                verdict.parts.push(part);
            }
        }
        (result, verdict)
    }

    /// Whether the calls are known to be bad.
    pub(crate) fn is_refusal(&self) -> bool {
        self.error.is_some()
    }

    /// Whether the calls are known to be good; `false` as long as it is not known.
    ///
    /// # Errors
    /// In the device's words.
    pub(crate) fn is_good(&mut self) -> Result<bool, &str> {
        let mut context = Context::from_waker(Waker::noop());
        let error = &mut self.error;
        self.parts
            .retain_mut(|part| match part.as_mut().poll(&mut context) {
                Poll::Pending => true,
                Poll::Ready(found) => {
                    if let Some(found) = found {
                        error.get_or_insert(found.to_string());
                    }
                    false
                }
            });
        match &self.error {
            Some(error) => Err(error),
            None => Ok(self.parts.is_empty()),
        }
    }
}
