//! Saves the text and shows a message when the program stops unexpectedly.

use crate::page::Parts;
use browser;
use std::cell::{Cell, RefCell};
use wasm_bindgen::JsValue;

thread_local! {
    /// The work to save. The hook below must be `Send`, so it cannot hold this itself.
    static PARTS: RefCell<Option<Parts>> = const { RefCell::new(None) };
    static HAS_STOPPED: Cell<bool> = const { Cell::new(false) };
}

/// Whether the program has stopped unexpectedly.
#[must_use]
pub fn has_stopped() -> bool {
    HAS_STOPPED.get()
}

/// Installs the panic hook.
pub fn install(parts: Parts) {
    PARTS.set(Some(parts));
    std::panic::set_hook(Box::new(|info| {
        console_error_panic_hook::hook(info);
        HAS_STOPPED.set(true);
        browser::set_stopped(true);
        let saved = PARTS.with(|parts| {
            let parts = parts.try_borrow().ok()?;
            let mut shelf = parts.as_ref()?.shelf.try_borrow_mut().ok()?;
            shelf.flush(browser::unix_time()).ok()
        });
        let text = if saved.is_some() {
            "Sinew stopped unexpectedly. Your text is saved; reload the page to go on."
        } else {
            "Sinew stopped unexpectedly. Your text as of half a second ago is saved; \
                reload the page to go on."
        };
        if let Err(error) = show(text) {
            web_sys::console::error_1(&error);
        }
    }));
}

/// Shows a message over the page, in the place and style of the loading screen, with a link that
/// loads the page anew.
///
/// # Errors
/// If the page has no body.
pub fn show(text: &str) -> Result<(), JsValue> {
    let document = web_sys::window()
        .and_then(|window| window.document())
        .ok_or(JsValue::NULL)?;
    let body = document.body().ok_or(JsValue::NULL)?;
    if let Some(old) = document.get_element_by_id("loading") {
        old.remove();
    }
    let screen = document.create_element("main")?;
    screen.set_id("loading");
    screen.set_class_name("failed");
    screen.set_attribute("role", "alert")?;
    let words = document.create_element("p")?;
    words.set_text_content(Some(text));
    let line = document.create_element("p")?;
    let link = document.create_element("a")?;
    link.set_text_content(Some("Reload"));
    // Without the fragment: a link that stopped the program is not opened again.
    link.set_attribute(
        "href",
        &web_sys::window().map_or_else(String::new, |window| {
            window.location().pathname().unwrap_or_default()
        }),
    )?;
    line.append_child(&link)?;
    screen.append_child(&words)?;
    screen.append_child(&line)?;
    body.append_child(&screen)?;
    Ok(())
}
