//! The page handle: `window.sinew`, for scripts of a page that embeds Sinew and for tests.
//!
//! - `ready`: promise, resolved when the app runs; rejected with the reason when it cannot start
//! - `load(text)`, `load({name: text, …})`: opens texts (the first one is run) like an example: the
//!   user's own work is kept; promise, resolved when they are compiled, rejected when they are too
//!   long
//! - `take({name: text or Uint8Array, …})`: takes in texts, images, meshes and projects (.zip) as
//!   if they were dropped on the page
//! - `text()`: the text of the first file
//! - `files()`: all texts, as `{name: text, …}`
//! - `status()`: the state, see below
//! - `finished()`: promise of a `status()`, resolved when the picture of the present text, camera
//!   and size is finished or was stopped; rejected while the lab keeps that picture waiting
//! - `image()`: promise of a PNG `Blob` of the traced picture as it is now; rejected while there is
//!   none
//! - `mesh({format, tolerance, size, union, prove, rig})`: promise of a `Uint8Array`: the model as
//!   a file of a triangle mesh; `format` is `"stl"` (default), `"3mf"`, `"glb"`, `"obj"` or
//!   `"ply"`, `tolerance` the largest distance from the surface as a part of the longest side
//!   (0.0015), `size` the longest side in millimetres (100; 0 keeps the text's units), `union`
//!   whether bodies that overlap become one, `prove` whether what can be proved of the mesh is,
//!   which takes ten times as long (false), `rig` (GLB only) whether skeletons become joints and
//!   the film an animation
//! - `link()`: the full address that Share copies
//! - `camera()`: `{eye, target, up, fov}` in use
//! - `setCamera(camera)`: looks from there; `null` goes back to the camera of the text
//! - `cancel()`, `render()`: stops the picture; traces it again
//! - `lab()`: the open lesson of the lab, see below; null in the editor
//! - `sculpture()`: the sculpture that is worked on: `{name, counts: [vertices, faces], depth:
//!   [undo, redo]}`; null in the editor
//!
//! `status()` gives `phase` (`"idle"`, `"waiting"` for a pause in typing, `"tracing"`, `"done"`,
//! `"cancelled"`), `progress` (0 … 1), `pass` (`"coarse"`, `"full"`, `"smooth"` or null),
//! `remaining` (seconds or null), `fresh` (whether the picture on the screen is of the present text
//! and camera, which it never is while the text has errors), `picture` (`{width, height}` or null),
//! `errors` (how many),
//! `elements` (how many the text makes), `diagnostics` (each `{severity, message, file, span, line,
//! column, hint, related, command}`), `hot` (names of the sliders), `assets` (names of the images
//! and meshes), `reading` (name of the mesh that is being read, or null), `fit`
//! (`{running, iteration, residual, points, said}` of the panel that fits meshes, or null),
//! `mesh` (`{running, shown, triangles, bytes, said}` of the open dialog with the model as a mesh,
//! or null), `frame` (of an animated work, else null),
//! `drawing` (the tool for drawing that is in hand: `"draw"`, `"move"`, `"cut"`, or null),
//! `backend` (`"webgpu"`, `"webgl2"`, `"none"`), `workers`, `replaced` (workers that died),
//! `failure`, `timings` (seconds: `compile`, `coarse`, `done`), `stats`
//! (`{primaryRays, shadowRays, fieldEvaluations}`),
//! `revision` (rises with each change of the text), `name`, `saved` (whether all changes are in the
//! browser's storage), `theirs` (whether another tab writes the open work).
//!
//! `lab()` gives `lesson` (the word in its link, as in `#lab=kernels`), `title`,
//! `waiting` (small pictures still to be traced), `drawn` (small pictures there), `refused` (texts
//! that the language does not draw yet) and `readings` (`{name: number}`: what the lesson shows as
//! numbers). While the lab is open no picture of the text is begun: `finished()` is rejected unless
//! the picture is finished or being traced.
//!
//! `sinew.debug` is for tests of the page itself and may change at any time: `killWorker(i)`
//! (whether there was such a worker), `rects()` (`{name: {x, y, w,
//! h}}` of widgets in CSS pixels: `editor`, `picture`, `share`, `examples`, `undo`, `draw`, `tool
//! draw`, `node NAME`, `sliders`, `slider NAME`, `problems`, `status`, `notice`, `dialog`, …),
//! `still()` (promise, resolved when none of them moves any more), `pictureSize(w, h)`, which fixes
//! the size of the traced picture (without arguments: back to what the user chose), and `panic()`,
//! which stops the program as a mistake in it would.

use crate::page::Parts;
use crate::scripts::request::Request;
use crate::wish::ViewWish;
use browser;
use document::intake::Incoming;
use document::mesh_export::Order;
use document::{picture, share};
use js_sys::{Function, JSON, Object, Promise, Reflect};
use rats::{File, Project};
use wasm_bindgen::prelude::*;

/// Makes `window.sinew`. Returns the function that rejects `ready`.
///
/// # Errors
/// If the window takes no new property.
pub fn install(parts: &Parts) -> Result<Function, JsValue> {
    let sinew = Object::new();
    let mut reject = None;
    let ready = Promise::new(&mut |yes, no| {
        parts.requests.ask(Request::Ready(Box::new(move || {
            call(&yes, &JsValue::UNDEFINED);
        })));
        reject = Some(no);
    });
    Reflect::set(&sinew, &"ready".into(), &ready)?;
    texts(&sinew, parts)?;
    state(&sinew, parts)?;
    let debug = Object::new();
    self::debug(&debug, parts)?;
    Reflect::set(&sinew, &"debug".into(), &debug)?;
    let window = web_sys::window().ok_or(JsValue::NULL)?;
    Reflect::set(&window, &"sinew".into(), &sinew)?;
    reject.ok_or(JsValue::NULL)
}

fn texts(sinew: &Object, parts: &Parts) -> Result<(), JsValue> {
    let p = parts.clone();
    method(sinew, "load", move |texts, _| {
        let project = project(&texts)?;
        Ok(promise(|yes, no| {
            let answer = Box::new(move |result: Result<(), String>| match result {
                Ok(()) => call(&yes, &JsValue::UNDEFINED),
                Err(reason) => call(&no, &js_sys::Error::new(&reason)),
            });
            p.requests.ask(Request::Load(project.clone(), answer));
        }))
    })?;
    let p = parts.clone();
    method(sinew, "take", move |files, _| {
        p.requests.ask(Request::Files(self::files(&files)?));
        Ok(JsValue::UNDEFINED)
    })?;
    let p = parts.clone();
    method(sinew, "text", move |_, _| {
        let outbox = p.outbox.borrow();
        let text = outbox.project.files.first().map_or("", |file| &file.text);
        Ok(text.into())
    })?;
    let p = parts.clone();
    method(sinew, "files", move |_, _| {
        let files = Object::new();
        for file in &p.outbox.borrow().project.files {
            let (name, text) = (file.name.as_str(), file.text.as_str());
            Reflect::set(&files, &name.into(), &text.into())?;
        }
        Ok(files.into())
    })?;
    let p = parts.clone();
    method(sinew, "link", move |_, _| {
        let outbox = p.outbox.borrow();
        share::link(&browser::page(), &outbox.project, outbox.chosen)
            .map(Into::into)
            .map_err(|reason| js_sys::Error::new(&reason).into())
    })
}

fn state(sinew: &Object, parts: &Parts) -> Result<(), JsValue> {
    let p = parts.clone();
    method(sinew, "status", move |_, _| status(&p))?;
    let p = parts.clone();
    method(sinew, "finished", move |_, _| {
        Ok(promise(|yes, no| {
            let shared = p.clone();
            p.requests
                .ask(Request::Finished(Box::new(move |result| match result {
                    Ok(()) => call(&yes, &status(&shared).unwrap_or_default()),
                    Err(reason) => call(&no, &js_sys::Error::new(&reason)),
                })));
        }))
    })?;
    let p = parts.clone();
    method(sinew, "image", move |_, _| {
        Ok(promise(|yes, no| {
            p.requests.ask(Request::Picture(Box::new(move |image| {
                let blob = image
                    .ok_or_else(|| js_sys::Error::new("There is no picture yet.").into())
                    .and_then(|image| {
                        picture::png(image)
                            .map_err(|error| js_sys::Error::new(&error.to_string()).into())
                    })
                    .and_then(|bytes| browser::blob("image/png", &bytes));
                match blob {
                    Ok(blob) => call(&yes, &blob),
                    Err(reason) => call(&no, &reason),
                }
            })));
        }))
    })?;
    let p = parts.clone();
    method(sinew, "mesh", move |order, _| {
        let order = order_of(&order)?;
        Ok(promise(|yes, no| {
            let answer = Box::new(move |result: Result<Vec<u8>, String>| match result {
                Ok(bytes) => call(&yes, &js_sys::Uint8Array::from(&bytes[..])),
                Err(reason) => call(&no, &js_sys::Error::new(&reason)),
            });
            p.requests.ask(Request::Mesh(order, answer));
        }))
    })?;
    let p = parts.clone();
    method(sinew, "camera", move |_, _| {
        to_js(&p.outbox.borrow().camera)
    })?;
    let p = parts.clone();
    method(sinew, "setCamera", move |camera, _| {
        let camera = if camera.is_null() || camera.is_undefined() {
            None
        } else {
            let json = String::from(JSON::stringify(&camera)?);
            let camera = serde_json::from_str(&json)
                .map_err(|error| js_sys::TypeError::new(&error.to_string()))?;
            Some(camera)
        };
        p.requests.ask(Request::SetCamera(camera));
        Ok(JsValue::UNDEFINED)
    })?;
    let p = parts.clone();
    method(sinew, "lab", move |_, _| to_js(&p.outbox.borrow().lab))?;
    let p = parts.clone();
    method(sinew, "sculpture", move |_, _| {
        to_js(&p.outbox.borrow().sculpture)
    })?;
    let p = parts.clone();
    method(sinew, "cancel", move |_, _| {
        p.requests.ask(Request::Wish(ViewWish::Cancel.into()));
        Ok(JsValue::UNDEFINED)
    })?;
    let p = parts.clone();
    method(sinew, "render", move |_, _| {
        p.requests.ask(Request::Wish(ViewWish::Again.into()));
        Ok(JsValue::UNDEFINED)
    })
}

fn debug(debug: &Object, parts: &Parts) -> Result<(), JsValue> {
    let p = parts.clone();
    method(debug, "killWorker", move |index, _| {
        let index = index.as_f64().unwrap_or(0.0) as usize;
        // At once: on a slow machine the picture may be finished before the next frame.
        let pool = p.pool.borrow().upgrade();
        let killed = pool.is_some_and(|pool| {
            pool.try_borrow_mut()
                .is_ok_and(|mut pool| pool.kill_worker(index))
        });
        Ok(killed.into())
    })?;
    let p = parts.clone();
    method(debug, "panic", move |_, _| {
        p.requests.ask(Request::Panic);
        Ok(JsValue::UNDEFINED)
    })?;
    let p = parts.clone();
    method(debug, "pictureSize", move |width, height| {
        let size = width
            .as_f64()
            .zip(height.as_f64())
            .map(|(width, height)| [width as u32, height as u32]);
        p.requests.ask(Request::PictureSize(size));
        Ok(JsValue::UNDEFINED)
    })?;
    let p = parts.clone();
    method(debug, "still", move |_, _| {
        Ok(promise(|yes, _| {
            p.requests.ask(Request::Still(Box::new(move || {
                call(&yes, &JsValue::UNDEFINED);
            })));
        }))
    })?;
    let p = parts.clone();
    method(debug, "rects", move |_, _| {
        let rects = Object::new();
        for (name, rect) in &p.outbox.borrow().places {
            let place = Object::new();
            for (key, value) in [
                ("x", rect.left()),
                ("y", rect.top()),
                ("w", rect.width()),
                ("h", rect.height()),
            ] {
                Reflect::set(&place, &key.into(), &value.into())?;
            }
            Reflect::set(&rects, &name.as_str().into(), &place)?;
        }
        Ok(rects.into())
    })
}

fn status(parts: &Parts) -> Result<JsValue, JsValue> {
    to_js(&parts.outbox.borrow().report)
}

fn to_js(value: &impl serde::Serialize) -> Result<JsValue, JsValue> {
    let json =
        serde_json::to_string(value).map_err(|error| js_sys::Error::new(&error.to_string()))?;
    JSON::parse(&json)
}

/// Returns the mesh that a script asks for.
fn order_of(options: &JsValue) -> Result<Order, JsValue> {
    if options.is_undefined() || options.is_null() {
        return Ok(Order::default());
    }
    let json = String::from(JSON::stringify(options)?);
    serde_json::from_str(&json).map_err(|error| js_sys::TypeError::new(&error.to_string()).into())
}

/// Returns the project of texts that a script gives.
fn project(texts: &JsValue) -> Result<Project, JsValue> {
    if let Some(text) = texts.as_string() {
        let name = String::from("main.rat");
        let files = vec![File { name, text }];
        return Ok(Project { files });
    }
    let wrong = || js_sys::TypeError::new("load() takes a text or an object {name: text, …}");
    let object = texts.dyn_ref::<Object>().ok_or_else(wrong)?;
    let mut files = Vec::new();
    for name in Object::keys(object) {
        let text = Reflect::get(object, &name)?;
        let (Some(name), Some(text)) = (name.as_string(), text.as_string()) else {
            return Err(wrong().into());
        };
        files.push(File { name, text });
    }
    if files.is_empty() {
        return Err(wrong().into());
    }
    Ok(Project { files })
}

/// Returns the files that a script gives.
fn files(files: &JsValue) -> Result<Vec<Incoming>, JsValue> {
    let wrong = || js_sys::TypeError::new("take() takes an object {name: text or Uint8Array, …}");
    let object = files.dyn_ref::<Object>().ok_or_else(wrong)?;
    let mut taken = Vec::new();
    for name in Object::keys(object) {
        let content = Reflect::get(object, &name)?;
        let bytes = match (content.as_string(), content.dyn_ref::<js_sys::Uint8Array>()) {
            (Some(text), _) => text.into_bytes(),
            (None, Some(bytes)) => bytes.to_vec(),
            (None, None) => return Err(wrong().into()),
        };
        let name = name.as_string().ok_or_else(wrong)?;
        taken.push(Incoming {
            name,
            bytes: Ok(bytes),
        });
    }
    Ok(taken)
}

fn promise(begin: impl FnOnce(Function, Function)) -> JsValue {
    let mut begin = Some(begin);
    Promise::new(&mut |yes, no| {
        if let Some(begin) = begin.take() {
            begin(yes, no);
        }
    })
    .into()
}

fn call(function: &Function, value: &JsValue) {
    // The functions of a promise never throw.
    let _ = function.call1(&JsValue::UNDEFINED, value);
}

/// Adds a method of up to two arguments. It lives as long as the page.
fn method(
    object: &Object,
    name: &str,
    body: impl Fn(JsValue, JsValue) -> Result<JsValue, JsValue> + 'static,
) -> Result<(), JsValue> {
    let body: Box<dyn Fn(JsValue, JsValue) -> Result<JsValue, JsValue>> = Box::new(body);
    let closure = Closure::wrap(body);
    Reflect::set(object, &name.into(), closure.as_ref())?;
    closure.forget();
    Ok(())
}
