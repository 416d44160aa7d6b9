//! The calls of JavaScript. What is made apart from the page's thread is asked for again and again;
//! `wake` is called when there is news.

use crate::model;
use document::intake::Incoming;
use document::mesh_export::{Order, meshing};
use document::size::MAX_PIXELS;
use glam::DVec3;
use js_sys::{Array, Function, Uint8Array};
use mesh::TriangleMesh;
use pool::{Assembly, PictureJob, Pool, Ticket, Tools};
use preview::orbit;
use scene::{Camera, Scene};
use serde::Serialize;
use std::cell::RefCell;
use std::sync::Arc;
use tools::{MeshScene, Meshed};
use wasm_bindgen::prelude::*;
use worker::Kind;

thread_local! {
    /// Called when there is news of a picture or a job.
    static WAKE: RefCell<Option<Function>> = const { RefCell::new(None) };
}

/// Calls `wake`.
fn wake() {
    WAKE.with_borrow(|wake| {
        if let Some(wake) = wake {
            // It only notes that there is news.
            let _ = wake.call0(&JsValue::NULL);
        }
    });
}

/// The workers, and the picture that they trace.
#[wasm_bindgen]
pub struct Engine {
    pool: Pool,
    tools: Tools,
    assembly: Assembly,
    number: u64,
}

/// The progress of a picture.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Progress {
    /// Share of the work done, 0 … 1.
    fraction: f64,
    /// Seconds left, if they are known.
    remaining: Option<f64>,
    finished: bool,
    /// The reason why there is no picture.
    error: Option<String>,
}

#[wasm_bindgen]
impl Engine {
    /// Prepares workers, whose files are in a folder. `wake` is called when there is news.
    #[wasm_bindgen(constructor)]
    pub fn new(folder: &str, on_news: Function) -> Self {
        console_error_panic_hook::set_once();
        pool::set_folder(folder);
        WAKE.set(Some(on_news));
        Self {
            pool: Pool::new(wake),
            tools: Tools::new(wake),
            assembly: Assembly::default(),
            number: 0,
        }
    }

    /// Makes a model of files: names and `Uint8Array`s.
    ///
    /// # Errors
    /// If a file is none that Sinew takes, or there are too many.
    pub fn open(&self, names: Vec<String>, contents: &Array) -> Result<Model, JsError> {
        let contents = contents
            .iter()
            .map(|bytes| Uint8Array::new(&bytes).to_vec());
        let files = names.into_iter().zip(contents);
        let files = files.map(|(name, bytes)| Incoming {
            name,
            bytes: Ok(bytes),
        });
        let model = model::Model::new(files.collect(), self.tools.clone());
        model.map(Model).map_err(|reason| JsError::new(&reason))
    }

    /// Begins a picture, seen by a camera (JSON) or the text's own, and gives up the one before.
    ///
    /// # Errors
    /// If there is no scene, no pixel or too many, or the camera is not sound.
    pub fn trace(
        &mut self,
        model: &Model,
        width: u32,
        height: u32,
        camera: Option<String>,
    ) -> Result<(), JsError> {
        let scene = model.scene()?;
        if !(1.0..=MAX_PIXELS).contains(&(f64::from(width) * f64::from(height))) {
            let most = format!("a picture has from 1 to {MAX_PIXELS} pixels");
            return Err(JsError::new(&most));
        }
        let camera = camera.map(|json| read_camera(&json)).transpose()?;
        let size = [width, height];
        self.number += 1;
        self.assembly.begin(self.number, size);
        self.pool.start(PictureJob {
            scene,
            camera,
            size,
            generation: self.number,
            kind: Kind::Colours,
            small: false,
        });
        Ok(())
    }

    /// Takes in what has come of the picture. Returns its progress, as JSON.
    pub fn look(&mut self) -> String {
        for tile in self.pool.poll() {
            let (generation, pass) = (tile.generation, tile.pass);
            self.assembly.put(generation, tile.tile, pass, &tile.pixels);
        }
        let progress = self.pool.progress();
        let is_own = progress.generation == Some(self.number);
        to_json(&Progress {
            fraction: if is_own { progress.fraction } else { 0.0 },
            remaining: progress.remaining_seconds.filter(|_| is_own),
            finished: is_own && progress.finished,
            error: progress.error.map(|error| error.to_string()),
        })
    }

    /// Returns the picture's pixels, as far as they have come, four bytes each; nothing before each
    /// has a colour.
    pub fn pixels(&self) -> Option<Vec<u8>> {
        let (number, image) = self.assembly.shown()?;
        (number == self.number).then(|| image.rgba.clone())
    }

    /// Gives up the picture.
    pub fn cancel(&mut self) {
        self.pool.cancel();
    }

    /// Begins a mesh of a model, as an order (JSON) says; with `file` as a file.
    ///
    /// # Errors
    /// If there is no scene, or the order is not sound.
    pub fn mesh(&self, model: &Model, order: &str, file: bool) -> Result<Meshing, JsError> {
        let order: Order = serde_json::from_str(order)?;
        order.check().map_err(|reason| JsError::new(&reason))?;
        let job = meshing(model.scene()?.clone(), order, String::from("model"));
        let job = MeshScene {
            format: file.then_some(order.format),
            ..job
        };
        Ok(Meshing {
            ticket: self.tools.submit(job),
            made: Meshed::default(),
        })
    }
}

/// A model.
#[wasm_bindgen]
pub struct Model(model::Model);

#[wasm_bindgen]
impl Model {
    /// Compiles the text as soon as the files that it names are read. Returns whether it is done.
    pub fn tick(&mut self) -> bool {
        self.0.tick()
    }

    /// Shows another frame of a film, from the next `tick` on.
    pub fn set_frame(&mut self, frame: u32) {
        self.0.set_frame(frame);
    }

    /// Returns what is said of the text, as JSON.
    pub fn diagnostics(&self) -> String {
        to_json(&self.0.diagnostics())
    }

    /// Returns the number of errors in the text.
    pub fn errors(&self) -> usize {
        self.0.errors()
    }

    /// Whether the text changes from frame to frame.
    pub fn is_animated(&self) -> bool {
        self.0.is_animated()
    }

    /// Returns the number of elements that the text makes.
    pub fn elements(&self) -> usize {
        self.0.scene().map_or(0, |scene| scene.elements.len())
    }

    /// Returns the width and the height of the text's picture, in pixels.
    pub fn size(&self) -> Vec<u32> {
        let scene = self.0.scene();
        scene.map_or(vec![1, 1], |scene| scene.settings.frame.to_vec())
    }

    /// Returns the text's camera, as JSON.
    pub fn camera(&self) -> String {
        to_json(&self.0.scene().map(|scene| scene.camera).unwrap_or_default())
    }

    /// Computes the field at points, given as x, y, z, x …
    pub fn values(&mut self, points: &[f64]) -> Vec<f64> {
        self.0.values(points)
    }

    fn scene(&self) -> Result<&Arc<Scene>, JsError> {
        let scene = self.0.scene();
        scene.ok_or_else(|| JsError::new("there is no model yet"))
    }
}

/// A mesh that is being made, or is there.
#[wasm_bindgen]
pub struct Meshing {
    ticket: Ticket<Meshed>,
    made: Meshed,
}

#[wasm_bindgen]
impl Meshing {
    /// Takes in the mesh. Returns whether it is there.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn look(&mut self) -> Result<bool, JsError> {
        let Some(result) = self.ticket.result() else {
            return Ok(false);
        };
        self.made = result.map_err(|reason| JsError::new(&reason))?;
        Ok(true)
    }

    /// Returns the fraction done, 0 … 1.
    pub fn fraction(&self) -> f32 {
        self.ticket.fraction().unwrap_or(0.0)
    }

    /// Returns facts of all parts together, as JSON.
    pub fn facts(&self) -> String {
        to_json(&self.made.facts)
    }

    /// Returns the bytes of the file, if one was asked for.
    pub fn file(&self) -> Option<Vec<u8>> {
        Some(self.made.written.files.first()?.bytes.clone())
    }

    /// Returns the names of the parts.
    pub fn names(&self) -> Vec<String> {
        self.made
            .parts
            .iter()
            .map(|(name, _)| name.clone())
            .collect()
    }

    /// Returns the vertices of a part, three numbers each.
    pub fn positions(&self, part: usize) -> Vec<f32> {
        self.part(part)
            .map_or_else(Vec::new, |mesh| floats(&mesh.positions))
    }

    /// Returns the normals at the vertices, three numbers each; none if the triangles are flat.
    pub fn normals(&self, part: usize) -> Option<Vec<f32>> {
        Some(floats(self.part(part)?.normals.as_ref()?))
    }

    /// Returns the colours at the vertices, linear RGB: where materials do not blend, that of a
    /// triangle there; none if the part has none.
    pub fn colors(&self, part: usize) -> Option<Vec<f32>> {
        let mesh = self.part(part)?;
        if let Some(colors) = &mesh.colors {
            return Some(colors.as_flattened().to_vec());
        }
        let mut colors = vec![mesh::Material::default().color; mesh.positions.len()];
        let mut any = false;
        for group in &mesh.groups {
            let Some(material) = &group.material else {
                continue;
            };
            any = true;
            let triangles = group.triangles.start as usize..group.triangles.end as usize;
            for vertex in mesh.triangles.get(triangles)?.as_flattened() {
                colors[*vertex as usize] = material.color;
            }
        }
        any.then(|| colors.as_flattened().to_vec())
    }

    /// Returns the vertices of the triangles, three each, counter-clockwise seen from outside.
    pub fn indices(&self, part: usize) -> Vec<u32> {
        let mesh = self.part(part);
        mesh.map_or_else(Vec::new, |mesh| mesh.triangles.as_flattened().to_vec())
    }

    fn part(&self, index: usize) -> Option<&TriangleMesh> {
        self.made.parts.get(index).map(|(_, mesh)| mesh)
    }
}

/// Returns the field's value at the surface.
#[wasm_bindgen]
pub fn iso_value() -> f64 {
    field::THRESHOLD
}

/// Turns a camera (JSON) about its target by shares of the picture's width and height.
///
/// # Errors
/// If the camera is not sound.
#[wasm_bindgen]
pub fn turn(camera: &str, across: f64, down: f64) -> Result<String, JsError> {
    Ok(to_json(&orbit::orbit(read_camera(camera)?, across, down)))
}

/// Brings a camera (JSON) to a multiple of its distance from the target.
///
/// # Errors
/// If the camera is not sound.
#[wasm_bindgen]
pub fn zoom(camera: &str, factor: f64) -> Result<String, JsError> {
    Ok(to_json(&orbit::zoom(read_camera(camera)?, factor)))
}

/// Reads a camera from JSON.
fn read_camera(json: &str) -> Result<Camera, JsError> {
    serde_json::from_str(json).map_err(|error| JsError::new(&format!("camera: {error}")))
}

/// Writes a value as JSON; what cannot be written, which plain data can, is `null`.
fn to_json(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_else(|_| String::from("null"))
}

fn floats(places: &[DVec3]) -> Vec<f32> {
    places
        .iter()
        .flat_map(|place| place.as_vec3().to_array())
        .collect()
}
