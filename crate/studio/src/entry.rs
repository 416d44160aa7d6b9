//! Entry point of the page's program.

use crate::app::App;
use crate::crash;
use crate::fonts;
use crate::page::Parts;
use crate::scripts::handle;
use crate::scripts::request::{Request, Told};
use browser::boot;
use browser::emulation;
use std::cell::Cell;
use wasm_bindgen::prelude::*;

/// The id of the page's canvas.
const CANVAS: &str = "canvas";

/// Starts the program. The page's script calls it once.
///
/// # Errors
/// If the page has no window or refuses listeners.
#[wasm_bindgen(start)]
pub fn start() -> Result<(), JsValue> {
    let parts = Parts::new();
    crash::install(parts.clone());
    let not_ready = handle::install(&parts)?;
    listen(&parts)?;
    wasm_bindgen_futures::spawn_local(async move {
        emulation::mend(CANVAS).await;
        let again = Cell::new(false);
        let create = move |context: &eframe::CreationContext<'_>, backend| {
            let is_lost = again.replace(true);
            if is_lost {
                // The GPU was lost, not because of the text: go on drawing it.
                browser::set_stopped(false);
            }
            let state = context.wgpu_render_state.clone();
            let mut app = App::new(&context.egui_ctx, state, backend, parts.clone());
            if is_lost {
                app.tell_loss();
            }
            app
        };
        let files = browser::fetch_all(fonts::FILES).await;
        let started = match files.and_then(fonts::set) {
            Ok(()) => boot::start(CANVAS, create).await.map(|_| ()),
            Err(reason) => Err(reason),
        };
        if let Err(reason) = started {
            let error = js_sys::Error::new(&reason);
            // The function of a promise never throws.
            let _ = not_ready.call1(&JsValue::UNDEFINED, &error);
            if let Err(error) = crash::show(&reason) {
                web_sys::console::error_1(&error);
            }
        }
    });
    Ok(())
}

/// Listens to what the browser says about the page.
fn listen(parts: &Parts) -> Result<(), JsValue> {
    let window = web_sys::window().ok_or(JsValue::NULL)?;
    let requests = parts.requests.clone();
    on(&window, "hashchange", move || {
        requests.ask(Request::HashChanged);
    })?;
    let (requests, shelf) = (parts.requests.clone(), parts.shelf.clone());
    browser::listen_to_storage(move |kind, about| {
        let told = match kind.as_str() {
            "mine" => Told::Mine(about),
            "refused" => Told::Refused(about),
            lost => {
                // A work is written before another tab takes it over and reads it.
                if lost == "lost"
                    && let Ok(mut shelf) = shelf.try_borrow_mut()
                {
                    let _ = shelf.flush(browser::unix_time());
                }
                Told::Theirs(about)
            }
        };
        requests.ask(Request::Storage(told));
    });
    let (requests, acts) = (parts.requests.clone(), parts.acts.clone());
    browser::listen_to_elements(move |element, deed, value| {
        acts.add(element, deed, value);
        requests.wake();
    });
    // Keys of the editor that the browser would take: help, find, developer tools.
    let keys = Closure::<dyn Fn(web_sys::KeyboardEvent)>::new(|event: web_sys::KeyboardEvent| {
        let with_control = event.ctrl_key() || event.meta_key();
        let of_editor = with_control && matches!(event.code().as_str(), "KeyF" | "KeyG" | "KeyH");
        if of_editor || !with_control && matches!(event.key().as_str(), "F1" | "F12") {
            event.prevent_default();
        }
    });
    window.add_event_listener_with_callback("keydown", keys.as_ref().unchecked_ref())?;
    keys.forget();
    browser::watch_pens();
    // A page that goes out of sight may never come back; phones end it without a further event.
    for event in ["pagehide", "visibilitychange"] {
        let shelf = parts.shelf.clone();
        let target: web_sys::EventTarget = if event == "pagehide" {
            window.clone().into()
        } else {
            window.document().ok_or(JsValue::NULL)?.into()
        };
        on(&target, event, move || {
            // A page that the user leaves early has not stopped unexpectedly.
            if event == "pagehide" && !crash::has_stopped() {
                browser::set_stopped(false);
            }
            if let Ok(mut shelf) = shelf.try_borrow_mut() {
                // A refused write was already reported, or will be at the next edit.
                let _ = shelf.flush(browser::unix_time());
            }
        })?;
    }
    Ok(())
}

fn on(
    target: &web_sys::EventTarget,
    event: &str,
    action: impl Fn() + 'static,
) -> Result<(), JsValue> {
    let action = Closure::<dyn Fn()>::new(action);
    target.add_event_listener_with_callback(event, action.as_ref().unchecked_ref())?;
    action.forget();
    Ok(())
}

impl eframe::App for App {
    fn raw_input_hook(&mut self, _ctx: &egui::Context, _input: &mut egui::RawInput) {
        browser::frames::begin();
    }

    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.tick(ctx);
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }
}
