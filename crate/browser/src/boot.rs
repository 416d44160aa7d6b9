//! Starts the window on the best that the browser can draw with: WebGPU, else WebGL2, else the
//! processor ([`crate::software`]).
//!
//! A browser may claim more than it can do: `navigator.gpu` may be there without an adapter, a
//! context may be refused, and a device may be lost while the page runs. So each [`Backend`] is
//! probed, then tried, and when it fails the next one is tried on a fresh canvas (a canvas that
//! once had a context of one kind never gives another).
//!
//! If the browser emulates WebGL2 on the processor, the processor draws the window itself: it does
//! so many times more quickly, as it draws only what changed, and leaves the time to the workers.
//!
//! `?backend=webgpu|webgl|none` in the page's address says where to begin, for tests and support.

use std::{cell::Cell, rc::Rc, sync::Arc};

use eframe::{App, CreationContext, WebRunner};
use egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use js_sys::Promise;
use wasm_bindgen::{JsCast, JsValue, closure::Closure};
use wasm_bindgen_futures::{JsFuture, future_to_promise, spawn_local};
use web_sys::{Document, HtmlCanvasElement, WebGl2RenderingContext, Window};

use crate::backend::{self, Backend};
use crate::frames;
use crate::software;

/// Backends in the order in which they are tried.
const ORDER: [Backend; 3] = [Backend::WebGpu, Backend::WebGl2, Backend::None];

/// Milliseconds of running after which a backend that is lost is tried once more, because drivers
/// reset and laptops sleep. One that is lost earlier is given up for the next one.
const STEADY: f64 = 10_000.0;

/// Milliseconds that a browser may take to say whether it has WebGPU. It may never answer.
const PATIENCE: i32 = 5_000;

/// Constant UNMASKED_RENDERER_WEBGL of the extension WEBGL_debug_renderer_info.
const UNMASKED_RENDERER: u32 = 0x9246;

/// The event that a lost WebGPU device sends to the canvas; WebGL has its own.
const DEVICE_LOST: &str = "sinew-device-lost";

/// The parameter of the page's address that says where to begin.
const PARAMETER: &str = "backend";

/// Starts the app on the canvas with the identifier `canvas_id`. Returns the backend that draws it.
///
/// `create` makes the app. It is called again, with another backend, when the one in use fails for
/// good; the app it made before is dropped then, so state that must not be lost belongs in the
/// captures of `create` or in the storage.
///
/// # Errors
/// A sentence for the user when the page has no such canvas or nothing could start, not even
/// drawing on the processor.
pub async fn start<A: App + 'static>(
    canvas_id: &str,
    create: impl Fn(&CreationContext<'_>, Backend) -> A + 'static,
) -> Result<Backend, String> {
    let boot = Rc::new(Boot {
        canvas_id: canvas_id.to_owned(),
        create: Box::new(move |context, backend| Box::new(create(context, backend))),
        retried: Cell::new(None),
    });
    let first = backend_of_address().unwrap_or(Backend::WebGpu);
    boot.start_from(first).await
}

type Create = dyn Fn(&CreationContext<'_>, Backend) -> Box<dyn App>;

struct Boot {
    canvas_id: String,
    create: Box<Create>,
    /// The backend that was tried once more after it had been lost.
    retried: Cell<Option<Backend>>,
}

impl Boot {
    /// Starts the first backend that works, beginning with `first`.
    async fn start_from(self: Rc<Self>, first: Backend) -> Result<Backend, String> {
        let mut reasons = Vec::new();
        for backend in ORDER.into_iter().skip_while(|&backend| backend != first) {
            if !is_there(backend, backend_of_address() == Some(backend)).await {
                continue;
            }
            match self.clone().run(backend).await {
                Ok(()) => return Ok(backend),
                Err(reason) => {
                    warn(&format!("{} did not start: {reason}", backend.label()));
                    reasons.push(format!("{}: {reason}", backend.label()));
                }
            }
        }
        Err(format!(
            "The window could not start in this browser ({}). \
                Reload the page or use another browser.",
            reasons.join("; ")
        ))
    }

    async fn run(self: Rc<Self>, backend: Backend) -> Result<(), String> {
        let canvas = self.fresh_canvas()?;
        frames::take_over();
        let runner = WebRunner::new();
        let options = eframe::WebOptions {
            wgpu_options: options(backend).await?,
            ..Default::default()
        };
        let boot = self.clone();
        let app = canvas.clone();
        let started = runner
            .start(
                canvas.clone(),
                options,
                Box::new(move |context| {
                    frames::watch(&context.egui_ctx);
                    if backend == Backend::None {
                        software::install(&context.egui_ctx, &app)?;
                    } else {
                        watch_device(context, backend, app);
                    }
                    Ok((boot.create)(context, backend))
                }),
            )
            .await;
        match started {
            Ok(()) => {
                self.restart_when_lost(&canvas, runner, backend)
                    .map_err(|error| text_of(&error))?;
                Ok(())
            }
            Err(error) => {
                runner.destroy();
                Err(text_of(&error))
            }
        }
    }

    /// Puts a canvas that never had a context in the place of the page's canvas.
    fn fresh_canvas(&self) -> Result<HtmlCanvasElement, String> {
        let missing = || format!("The page has no canvas with the id {:?}.", self.canvas_id);
        let old = document()
            .get_element_by_id(&self.canvas_id)
            .ok_or_else(missing)?;
        let new: HtmlCanvasElement = old
            .clone_node()
            .map_err(|error| text_of(&error))?
            .dyn_into()
            .map_err(|_| missing())?;
        old.replace_with_with_node_1(&new)
            .map_err(|error| text_of(&error))?;
        Ok(new)
    }

    /// Starts anew when the canvas loses its device or context.
    fn restart_when_lost(
        self: Rc<Self>,
        canvas: &HtmlCanvasElement,
        runner: WebRunner,
        backend: Backend,
    ) -> Result<(), JsValue> {
        let started = js_sys::Date::now();
        let done = Cell::new(false);
        let on_loss = Closure::<dyn Fn()>::new(move || {
            // A lost device may be reported more than once.
            if done.replace(true) {
                return;
            }
            let steady = js_sys::Date::now() - started >= STEADY;
            let next = if steady && self.retried.replace(Some(backend)) != Some(backend) {
                backend
            } else {
                fallback(backend)
            };
            warn(&format!(
                "{} was lost; going on with {}",
                backend.label(),
                next.label()
            ));
            let (boot, runner) = (self.clone(), runner.clone());
            spawn_local(async move {
                runner.destroy();
                if let Err(reason) = boot.start_from(next).await {
                    web_sys::console::error_1(&reason.into());
                }
            });
        });
        for event in [DEVICE_LOST, "webglcontextlost"] {
            canvas.add_event_listener_with_callback(event, on_loss.as_ref().unchecked_ref())?;
        }
        // Lives as long as the page: the canvas may lose its device at any time.
        on_loss.forget();
        Ok(())
    }
}

/// Returns the backend to fall back to.
fn fallback(backend: Backend) -> Backend {
    match backend {
        Backend::WebGpu => Backend::WebGl2,
        Backend::WebGl2 | Backend::None => Backend::None,
    }
}

/// Returns the backend that the page's address asks for.
fn backend_of_address() -> Option<Backend> {
    let query = window().location().search().ok()?;
    let parameters = web_sys::UrlSearchParams::new_with_str(&query).ok()?;
    match parameters.get(PARAMETER)?.as_str() {
        "webgpu" => Some(Backend::WebGpu),
        "webgl" | "webgl2" => Some(Backend::WebGl2),
        "none" => Some(Backend::None),
        _ => None,
    }
}

/// Whether the browser really offers the backend. One that was asked for may be slow.
async fn is_there(backend: Backend, was_asked_for: bool) -> bool {
    match backend {
        Backend::WebGpu => has_webgpu().await,
        Backend::WebGl2 => webgl2().is_some_and(|context| was_asked_for || !is_emulated(&context)),
        Backend::None => true,
    }
}

async fn has_webgpu() -> bool {
    let answer =
        future_to_promise(async { Ok(wgpu::util::is_browser_webgpu_supported().await.into()) });
    let late = Promise::new(&mut |resolve, _| {
        // Without a timer there is nothing to do but to wait for the answer.
        let _ = window().set_timeout_with_callback_and_timeout_and_arguments_0(&resolve, PATIENCE);
    });
    let first = Promise::race(&js_sys::Array::of2(&answer, &late));
    JsFuture::from(first)
        .await
        .is_ok_and(|answer| answer.is_truthy())
}

fn webgl2() -> Option<WebGl2RenderingContext> {
    let canvas: HtmlCanvasElement = document().create_element("canvas").ok()?.dyn_into().ok()?;
    canvas.get_context("webgl2").ok()??.dyn_into().ok()
}

/// Whether the processor computes what a context draws.
fn is_emulated(context: &WebGl2RenderingContext) -> bool {
    let is_processor = |name: u32| {
        let name = context.get_parameter(name).ok();
        name.and_then(|name| name.as_string())
            .is_some_and(|name| backend::is_processor(&name))
    };
    // Some browsers report it under the plain name, others only with the extension.
    is_processor(WebGl2RenderingContext::RENDERER)
        || matches!(
            context.get_extension("WEBGL_debug_renderer_info"),
            Ok(Some(_))
        ) && is_processor(UNMASKED_RENDERER)
}

/// Returns the settings of wgpu for a backend.
async fn options(backend: Backend) -> Result<WgpuConfiguration, String> {
    let wgpu_setup = match backend {
        Backend::WebGpu => on_gpu(wgpu::Backends::BROWSER_WEBGPU),
        Backend::WebGl2 => on_gpu(wgpu::Backends::GL),
        Backend::None => software::setup().await?,
    };
    Ok(WgpuConfiguration {
        wgpu_setup,
        ..Default::default()
    })
}

fn on_gpu(backends: wgpu::Backends) -> WgpuSetup {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = backends;
    setup.device_descriptor = Arc::new(|adapter| {
        let base = if adapter.get_info().backend == wgpu::Backend::Gl {
            wgpu::Limits::downlevel_webgl2_defaults()
        } else {
            wgpu::Limits::default()
        };
        wgpu::DeviceDescriptor {
            label: Some("window"),
            // As large a window as the adapter can do, but no other limit raised, so that what
            // runs on one machine runs on the others.
            required_limits: base.using_resolution(adapter.limits()),
            ..Default::default()
        }
    });
    setup.into()
}

/// Tells the canvas when its WebGPU device is lost, and logs errors of the device instead of
/// ending the app: a frame that is not drawn is no reason to take the editor away.
fn watch_device(context: &CreationContext<'_>, backend: Backend, canvas: HtmlCanvasElement) {
    let Some(state) = &context.wgpu_render_state else {
        return;
    };
    state.device.on_uncaptured_error(Arc::new(|error| {
        web_sys::console::error_1(&error.to_string().into());
    }));
    if backend == Backend::WebGpu {
        state.device.set_device_lost_callback(move |_, _| {
            if let Ok(event) = web_sys::Event::new(DEVICE_LOST) {
                // The result only says whether a listener cancelled the event.
                let _ = canvas.dispatch_event(&event);
            }
        });
    }
}

fn window() -> Window {
    web_sys::window().expect("the app runs in a page, not in a worker")
}

fn document() -> Document {
    window().document().expect("a page has a document")
}

fn warn(message: &str) {
    web_sys::console::warn_1(&message.into());
}

/// Returns the first line of an error's message, without the stack trace that some have below it.
fn text_of(error: &JsValue) -> String {
    let text = error
        .as_string()
        .or_else(|| {
            error
                .dyn_ref::<js_sys::Error>()
                .map(|error| error.message().into())
        })
        .unwrap_or_else(|| format!("{error:?}"));
    text.lines().next().unwrap_or_default().to_owned()
}
