//! Works around a mistake of browsers that emulate a phone.
//!
//! The developer tools' phone view changes `devicePixelRatio`, but `devicePixelContentBoxSize`, by
//! which eframe sizes the canvas, stays that of the real screen, and the page would come out half
//! as large as it should be. Where the two contradict each other, the second one is removed, so
//! that eframe computes the size from the ratio.

use js_sys::{Array, Promise, Reflect};
use wasm_bindgen::prelude::*;
use web_sys::{
    ResizeObserver, ResizeObserverBoxOptions, ResizeObserverEntry, ResizeObserverOptions,
    ResizeObserverSize,
};

/// Milliseconds to wait for the browser's answer. A hidden tab never answers.
const PATIENCE: i32 = 250;

const SIZE: &str = "devicePixelContentBoxSize";

/// Checks the canvas with this id once, and removes the property if it is wrong. Call it before
/// eframe reads it.
pub async fn mend(canvas: &str) {
    // A browser that cannot tell sizes in pixels has nothing to mend.
    let _ = watch(canvas).await;
}

async fn watch(canvas: &str) -> Result<(), JsValue> {
    let window = web_sys::window().ok_or(JsValue::NULL)?;
    let document = window.document().ok_or(JsValue::NULL)?;
    let canvas = document.get_element_by_id(canvas).ok_or(JsValue::NULL)?;
    let ratio = window.device_pixel_ratio();
    let mut observer = None;
    let mut refused = None;
    let answer = Promise::new(&mut |done, _| {
        let resolve = done.clone();
        let check = Closure::once_into_js(move |entries: Array| {
            if contradicts(&entries, ratio) == Some(true)
                && let Ok(class) = Reflect::get(&js_sys::global(), &"ResizeObserverEntry".into())
                && let Ok(prototype) = Reflect::get(&class, &"prototype".into())
                && let Ok(prototype) = prototype.dyn_into::<js_sys::Object>()
            {
                // If the browser refuses, the page is only too small.
                let _ = Reflect::delete_property(&prototype, &SIZE.into());
            }
            // The function of a promise never throws.
            let _ = resolve.call0(&JsValue::UNDEFINED);
        });
        let begin = || {
            let new = ResizeObserver::new(check.unchecked_ref())?;
            let options = ResizeObserverOptions::new();
            options.set_box(ResizeObserverBoxOptions::DevicePixelContentBox);
            new.observe_with_options(&canvas, &options);
            window.set_timeout_with_callback_and_timeout_and_arguments_0(&done, PATIENCE)?;
            Ok(new)
        };
        match begin() {
            Ok(new) => observer = Some(new),
            Err(error) => refused = Some(error),
        }
    });
    if let Some(error) = refused {
        return Err(error);
    }
    wasm_bindgen_futures::JsFuture::from(answer).await?;
    if let Some(observer) = observer {
        observer.disconnect();
    }
    Ok(())
}

/// Whether the size in pixels is not the size times the ratio.
fn contradicts(entries: &Array, ratio: f64) -> Option<bool> {
    let entry: ResizeObserverEntry = entries.at(0).dyn_into().ok()?;
    let pixels: ResizeObserverSize = entry
        .device_pixel_content_box_size()
        .at(0)
        .dyn_into()
        .ok()?;
    let size: ResizeObserverSize = entry.content_box_size().at(0).dyn_into().ok()?;
    Some((pixels.inline_size() - ratio * size.inline_size()).abs() > 2.0)
}
