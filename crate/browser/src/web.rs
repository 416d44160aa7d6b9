//! Services of the browser.

use document::intake::{self, Incoming};
use document::storage::Store;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue, closure::Closure};
use wasm_bindgen_futures::JsFuture;

fn window() -> web_sys::Window {
    web_sys::window().expect("the app runs in a page, not in a worker")
}

/// Returns the seconds on a clock that never goes back. egui's own stands still while the tab is
/// hidden.
#[must_use]
pub fn now(_ctx: &egui::Context) -> f64 {
    pool::clock::stopwatch()
}

thread_local! {
    static PEN: std::cell::Cell<Option<f32>> = const { std::cell::Cell::new(None) };
}

/// Returns the pressure, 0 … 1, of the pen that touches the page or touched it last; `None` for a
/// mouse or a finger.
#[must_use]
pub fn pen_pressure() -> Option<f32> {
    PEN.get()
}

/// Listens to pens from now on, as the window's own events have no pressure.
pub fn watch_pens() {
    let listen = Closure::<dyn Fn(web_sys::PointerEvent)>::new(|event: web_sys::PointerEvent| {
        let pressure = event.pressure();
        if event.pointer_type() != "pen" {
            PEN.set(None);
        } else if pressure > 0.0 {
            // A lifted pen keeps its last pressure, for the end of its stroke.
            PEN.set(Some(pressure));
        }
    });
    for name in ["pointerdown", "pointermove"] {
        // Before the canvas gets the event. Where the browser refuses, strokes are equally thick.
        let _ = window().add_event_listener_with_callback_and_bool(
            name,
            listen.as_ref().unchecked_ref(),
            true,
        );
    }
    listen.forget();
}

/// Sets whether each frame keeps the tracer waiting.
pub fn set_frames_slow(is_slow: bool) {
    crate::frames::set_slow(is_slow);
}

/// Returns the milliseconds since 1970.
#[must_use]
pub fn unix_time() -> f64 {
    js_sys::Date::now()
}

/// Returns a word that differs between tabs.
#[must_use]
pub fn random_word() -> String {
    let random = js_sys::Math::random() * 2.0_f64.powi(48);
    format!("{:x}{:x}", unix_time() as u64, random as u64)
}

/// Returns the page's address without its fragment.
#[must_use]
pub fn page() -> String {
    let href = window().location().href().unwrap_or_default();
    href.split('#').next().unwrap_or_default().to_owned()
}

/// Returns the fragment of the address, with `#`, or empty.
#[must_use]
pub fn hash() -> String {
    window().location().hash().unwrap_or_default()
}

/// Changes the fragment without loading anything and without a new entry in the history.
pub fn set_hash(hash: &str) {
    if self::hash() == hash {
        return;
    }
    let address = format!("{}{hash}", page());
    // Refused in some sandboxes; then the address bar stays as it is and the link can be copied.
    if let Ok(history) = window().history() {
        let _ = history.replace_state_with_url(&JsValue::NULL, "", Some(&address));
    }
}

/// Changes the fragment and makes a new entry in the history, so that the browser's Back leads to
/// the present one.
pub fn push_hash(hash: &str) {
    if self::hash() == hash {
        return;
    }
    let address = format!("{}{hash}", page());
    if let Ok(history) = window().history() {
        // Refused in some sandboxes; then only Back does not lead here.
        let _ = history.push_state_with_url(&JsValue::NULL, "", Some(&address));
    }
}

#[wasm_bindgen(raw_module = "./keep.js")]
extern "C" {
    fn get(key: &str) -> Option<String>;
    #[wasm_bindgen(catch)]
    fn set(key: &str, value: &str) -> Result<(), JsValue>;
    fn remove(key: &str);
    fn keys() -> Vec<String>;
    fn lasts() -> bool;
    #[wasm_bindgen(js_name = isWriting)]
    fn is_writing() -> bool;
    #[wasm_bindgen(catch, js_name = fetchWork)]
    async fn fetch_kept(id: &str) -> Result<JsValue, JsValue>;
    fn claim(id: Option<&str>);
    #[wasm_bindgen(js_name = takeOver)]
    fn take_over(id: &str);
    fn listen(listener: &Closure<dyn Fn(String, String)>);
}

#[wasm_bindgen(raw_module = "./voice.js")]
extern "C" {
    #[wasm_bindgen(js_name = showElements)]
    fn show_in_page(text: &str);
    #[wasm_bindgen(js_name = listenToElements)]
    fn listen_in_page(listener: &Closure<dyn Fn(String, String, String)>);
}

/// Shows the elements of a description ([`crate::voice`]) to assistive technology.
pub fn show_elements(text: &str) {
    show_in_page(text);
}

/// Calls a function with what is done with elements: their number, the deed and a value.
pub fn listen_to_elements(listener: impl Fn(u64, &str, &str) + 'static) {
    let listener = Closure::<dyn Fn(String, String, String)>::new(
        move |element: String, deed: String, value: String| {
            if let Ok(element) = element.parse() {
                listener(element, &deed, &value);
            }
        },
    );
    listen_in_page(&listener);
    listener.forget();
}

/// Returns the browser's storage, or memory where it allows none.
#[must_use]
pub fn store() -> Box<dyn Store> {
    Box::new(Keeper)
}

/// The storage that the script `keep.js` keeps.
struct Keeper;

impl Store for Keeper {
    fn get(&self, key: &str) -> Option<String> {
        get(key)
    }

    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        set(key, value).map_err(|_| {
            String::from(
                "The browser's storage is full, so your latest changes live in this tab only. \
                    Delete old works, or save the project as a file.",
            )
        })
    }

    fn remove(&mut self, key: &str) {
        remove(key);
    }

    fn keys(&self) -> Vec<String> {
        keys()
    }
}

/// Fetches what is large of a saved work, and calls back when it can be opened.
pub fn fetch_work(id: &str, done: impl FnOnce() + 'static) {
    let id = id.to_owned();
    wasm_bindgen_futures::spawn_local(async move {
        // The listener has been told if it cannot be fetched.
        let _ = fetch_kept(&id).await;
        done();
    });
}

/// Asks to be the only tab that writes a work, and lets go of the one before.
pub fn claim_work(id: Option<&str>) {
    claim(id);
}

/// Takes a work over from the tab that writes it.
pub fn take_work_over(id: &str) {
    take_over(id);
}

/// Whether something waits to be written.
#[must_use]
pub fn is_storing() -> bool {
    is_writing()
}

/// Calls a function with what the storage tells: its kind, and the work or the sentence.
pub fn listen_to_storage(listener: impl Fn(String, String) + 'static) {
    let listener = Closure::<dyn Fn(String, String)>::new(listener);
    listen(&listener);
    listener.forget();
}

/// Saves a file for the user.
pub fn download(name: &str, mime: &str, bytes: &[u8]) {
    let save = || -> Result<(), JsValue> {
        let url = web_sys::Url::create_object_url_with_blob(&blob(mime, bytes)?)?;
        let document = window().document().ok_or(JsValue::NULL)?;
        let anchor: web_sys::HtmlAnchorElement = document.create_element("a")?.dyn_into()?;
        anchor.set_href(&url);
        anchor.set_download(name);
        anchor.click();
        web_sys::Url::revoke_object_url(&url)
    };
    if let Err(error) = save() {
        web_sys::console::error_1(&error);
    }
}

/// Reads files that were dropped on the window, and gives them to a function.
pub fn read_dropped(
    files: Vec<egui::DroppedFileHandle>,
    take: impl FnOnce(Vec<Incoming>) + 'static,
) {
    let files = files
        .iter()
        .filter_map(|file| file.web_file().cloned())
        .collect();
    read_files(files, take);
}

/// Lets the user choose files, and gives them to a function.
pub fn pick_files(take: impl FnOnce(Vec<Incoming>) + 'static) {
    let pick = move || -> Result<(), JsValue> {
        let document = window().document().ok_or(JsValue::NULL)?;
        let input: web_sys::HtmlInputElement = document.create_element("input")?.dyn_into()?;
        // Without a list of kinds: phones would hide files whose kind they do not know.
        input.set_type("file");
        input.set_multiple(true);
        let source = input.clone();
        let on_choice = Closure::once_into_js(move || {
            let list = source.files();
            let files = list.iter().flat_map(|list| {
                let all = 0..list.length();
                all.filter_map(|index| list.get(index))
            });
            read_files(files.collect(), take);
        });
        input.set_onchange(Some(on_choice.unchecked_ref()));
        input.click();
        Ok(())
    };
    if let Err(error) = pick() {
        web_sys::console::error_1(&error);
    }
}

/// Reads files one after another; those that are too large are not read at all.
fn read_files(files: Vec<web_sys::File>, take: impl FnOnce(Vec<Incoming>) + 'static) {
    wasm_bindgen_futures::spawn_local(async move {
        let mut taken = Vec::new();
        for file in files {
            let name = file.name();
            let bytes = match intake::check_length(&name, file.size()) {
                Ok(()) if taken.len() < intake::MOST => {
                    match wasm_bindgen_futures::JsFuture::from(file.array_buffer()).await {
                        Ok(buffer) => Ok(js_sys::Uint8Array::new(&buffer).to_vec()),
                        Err(_) => Err(String::from("the browser could not read it")),
                    }
                }
                Ok(()) => Ok(Vec::new()),
                Err(reason) => Err(reason),
            };
            taken.push(Incoming { name, bytes });
        }
        if !taken.is_empty() {
            take(taken);
        }
    });
}

/// Returns bytes as the browser's file object.
///
/// # Errors
/// If the browser has no memory for it.
pub fn blob(mime: &str, bytes: &[u8]) -> Result<web_sys::Blob, JsValue> {
    let parts = js_sys::Array::of1(&js_sys::Uint8Array::from(bytes));
    let options = web_sys::BlobPropertyBag::new();
    options.set_type(mime);
    web_sys::Blob::new_with_u8_array_sequence_and_options(&parts, &options)
}

/// Key of the mark that the program may have stopped unexpectedly.
const STOPPED: &str = "sinew/troubled";

/// Whether the program stopped unexpectedly last time in this tab. Other tabs do not count, as one
/// that is just starting is marked, too.
#[must_use]
pub fn has_stopped_before() -> bool {
    let storage = window().session_storage().ok().flatten();
    storage.is_some_and(|storage| matches!(storage.get_item(STOPPED), Ok(Some(_))))
}

/// Notes that the program may stop unexpectedly, or with `false` that it works.
pub fn set_stopped(has_stopped: bool) {
    if let Ok(Some(storage)) = window().session_storage() {
        // Without storage, a bad start is simply tried again.
        let _ = if has_stopped {
            storage.set_item(STOPPED, "1")
        } else {
            storage.remove_item(STOPPED)
        };
    }
}

/// Whether the storage outlives the page.
#[must_use]
pub fn has_storage() -> bool {
    lasts()
}

/// Whether the user's system asks for something, in the words of a media query.
#[must_use]
pub fn is_wanted(query: &str) -> bool {
    let asked = window().match_media(query).ok().flatten();
    asked.is_some_and(|asked| asked.matches())
}

/// Sets the title of the browser's tab.
pub fn set_title(name: &str) {
    if let Some(document) = window().document() {
        document.set_title(&format!("{name} – Sinew"));
    }
}

/// Fetches a file of the page, and calls back when it is there or cannot be had.
pub fn fetch(path: &'static str, done: impl FnOnce(Option<Vec<u8>>) + 'static) {
    wasm_bindgen_futures::spawn_local(async move {
        done(bytes_of(path).await.ok());
    });
}

/// Fetches files of the page.
///
/// # Errors
/// A sentence, if one cannot be had.
pub async fn fetch_all<const N: usize>(paths: [&str; N]) -> Result<[Vec<u8>; N], String> {
    let mut files = [const { Vec::new() }; N];
    for (path, file) in paths.into_iter().zip(&mut files) {
        let bytes = bytes_of(path).await;
        *file = bytes.map_err(|_| format!("{path} could not be loaded. Reload the page."))?;
    }
    Ok(files)
}

async fn bytes_of(path: &str) -> Result<Vec<u8>, JsValue> {
    let response = JsFuture::from(window().fetch_with_str(path)).await?;
    let response: web_sys::Response = response.unchecked_into();
    if !response.ok() {
        return Err(JsValue::from(response.status()));
    }
    let buffer = JsFuture::from(response.array_buffer()?).await?;
    Ok(js_sys::Uint8Array::new(&buffer).to_vec())
}
