//! The browser's encoders of videos (WebCodecs), where it has them.

use crate::recording::{EncodedVideo, Kind, VideoFormat};
use ::picture::Picture;
use js_sys::{Object, Promise, Reflect, Uint8Array};
use std::cell::RefCell;
use std::rc::Rc;
use video::{Codec, Colours, Packet};
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::{JsFuture, spawn_local};

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_name = VideoEncoder)]
    type Encoder;
    #[wasm_bindgen(constructor, catch, js_class = "VideoEncoder")]
    fn new(handlers: &JsValue) -> Result<Encoder, JsValue>;
    #[wasm_bindgen(
        static_method_of = Encoder,
        js_class = "VideoEncoder",
        js_name = isConfigSupported,
        catch
    )]
    fn is_config_supported(settings: &JsValue) -> Result<Promise, JsValue>;
    #[wasm_bindgen(method, catch)]
    fn configure(this: &Encoder, settings: &JsValue) -> Result<(), JsValue>;
    #[wasm_bindgen(method, catch)]
    fn encode(this: &Encoder, frame: &Frame, options: &JsValue) -> Result<(), JsValue>;
    #[wasm_bindgen(method, catch)]
    fn flush(this: &Encoder) -> Result<Promise, JsValue>;
    #[wasm_bindgen(method, catch)]
    fn close(this: &Encoder) -> Result<(), JsValue>;
    #[wasm_bindgen(method, getter, js_name = encodeQueueSize)]
    fn encode_queue_size(this: &Encoder) -> u32;

    #[wasm_bindgen(js_name = VideoFrame)]
    type Frame;
    #[wasm_bindgen(constructor, catch, js_class = "VideoFrame")]
    fn new(pixels: &Uint8Array, settings: &JsValue) -> Result<Frame, JsValue>;
    #[wasm_bindgen(method)]
    fn close(this: &Frame);

    #[wasm_bindgen(js_name = EncodedVideoChunk)]
    type Chunk;
    #[wasm_bindgen(method, getter, js_name = byteLength)]
    fn byte_length(this: &Chunk) -> u32;
    #[wasm_bindgen(method, getter)]
    fn timestamp(this: &Chunk) -> f64;
    #[wasm_bindgen(method, getter, js_name = type)]
    fn kind(this: &Chunk) -> String;
    #[wasm_bindgen(method, catch, js_name = copyTo)]
    fn copy_to(this: &Chunk, bytes: &Uint8Array) -> Result<(), JsValue>;
}

/// Codecs to ask for, the better ones of a kind first: H.264's profiles and VP9 at a level for 4096
/// × 2304 pixels.
const CODECS: [(Kind, &str); 5] = [
    (Kind::Mp4, "avc1.640033"),
    (Kind::Mp4, "avc1.4d0033"),
    (Kind::Mp4, "avc1.420033"),
    (Kind::WebM, "vp09.00.51.08"),
    (Kind::WebM, "vp8"),
];

/// Bits for a pixel of a frame: enough that smooth shading shows no blocks.
const BITS: f64 = 0.25;

/// Asks for the browser's encoders; none if it has no WebCodecs.
pub fn video_formats(done: impl FnOnce(Vec<VideoFormat>) + 'static) {
    spawn_local(async move {
        let mut formats: Vec<VideoFormat> = Vec::new();
        for (kind, codec) in CODECS {
            let known = formats.iter().any(|format| format.kind == kind);
            if !known && is_supported(codec).await.unwrap_or(false) {
                let codec = codec.to_owned();
                formats.push(VideoFormat { kind, codec });
            }
        }
        done(formats);
    });
}

async fn is_supported(codec: &str) -> Result<bool, JsValue> {
    let answer = Encoder::is_config_supported(&settings(codec, [1280, 720], 25))?;
    let answer = JsFuture::from(answer).await?;
    Ok(Reflect::get(&answer, &"supported".into())?.is_truthy())
}

fn settings(codec: &str, size: [u32; 2], rate: u16) -> JsValue {
    let [width, height] = size.map(f64::from);
    let rate = f64::from(rate.max(1));
    let bits = (BITS * width * height * rate).clamp(500_000.0, 40_000_000.0);
    object(&[
        ("codec", codec.into()),
        ("width", width.into()),
        ("height", height.into()),
        ("framerate", rate.into()),
        ("bitrate", bits.into()),
        ("latencyMode", "quality".into()),
        // Lengths before units, as MP4 has them. Other codecs ignore it.
        ("avc", object(&[("format", "avc".into())])),
    ])
}

fn object(members: &[(&str, JsValue)]) -> JsValue {
    let object = Object::new();
    for (name, value) in members {
        // A plain object takes every property.
        let _ = Reflect::set(&object, &(*name).into(), value);
    }
    object.into()
}

#[derive(Default)]
struct State {
    packets: Vec<Packet>,
    configuration: Vec<u8>,
    colours: Option<Colours>,
    error: Option<String>,
    is_flushed: bool,
}

/// An encoder at work.
pub struct VideoEncoder {
    encoder: Encoder,
    codec: String,
    state: Rc<RefCell<State>>,
    is_ending: bool,
    _on_output: Closure<dyn FnMut(Chunk, JsValue)>,
    _on_error: Closure<dyn FnMut(JsValue)>,
}

impl VideoEncoder {
    /// Makes an encoder for frames of a size, `rate` in a second.
    ///
    /// # Errors
    /// If the browser refuses.
    pub fn new(codec: &str, size: [u32; 2], rate: u16) -> Result<Self, String> {
        let state = Rc::<RefCell<State>>::default();
        let inner = state.clone();
        let on_output = Closure::<dyn FnMut(Chunk, JsValue)>::new(move |chunk, about: JsValue| {
            let mut state = inner.borrow_mut();
            if let Err(error) = take(&mut state, &chunk, &about) {
                state.error.get_or_insert(words(&error));
            }
        });
        let inner = state.clone();
        let on_error = Closure::<dyn FnMut(JsValue)>::new(move |error: JsValue| {
            inner.borrow_mut().error.get_or_insert(words(&error));
        });
        let handlers = object(&[
            ("output", on_output.as_ref().clone()),
            ("error", on_error.as_ref().clone()),
        ]);
        let encoder = Encoder::new(&handlers).map_err(|error| words(&error))?;
        let configured = encoder.configure(&settings(codec, size, rate));
        configured.map_err(|error| words(&error))?;
        Ok(Self {
            encoder,
            codec: codec.to_owned(),
            state,
            is_ending: false,
            _on_output: on_output,
            _on_error: on_error,
        })
    }

    /// Returns the number of frames that wait to be encoded.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.encoder.encode_queue_size() as usize
    }

    /// Encodes a frame that is shown at a time, microseconds. With `is_key` it can be decoded by
    /// itself.
    ///
    /// # Errors
    /// If the encoder has failed.
    pub fn encode(&mut self, picture: &Picture, time: u64, is_key: bool) -> Result<(), String> {
        if let Some(error) = &self.state.borrow().error {
            return Err(error.clone());
        }
        let settings = object(&[
            ("format", "RGBX".into()),
            ("codedWidth", picture.width().into()),
            ("codedHeight", picture.height().into()),
            ("timestamp", (time as f64).into()),
        ]);
        let pixels = Uint8Array::from(picture.pixels());
        let frame = Frame::new(&pixels, &settings).map_err(|error| words(&error))?;
        let options = object(&[("keyFrame", is_key.into())]);
        let encoded = self.encoder.encode(&frame, &options);
        frame.close();
        encoded.map_err(|error| words(&error))
    }

    /// Waits for the last frames. Returns the video once they are encoded, until then `None`.
    ///
    /// # Errors
    /// If the encoder has failed.
    pub fn finish(&mut self) -> Result<Option<EncodedVideo>, String> {
        if !self.is_ending {
            self.is_ending = true;
            let flushed = self.encoder.flush().map_err(|error| words(&error))?;
            let state = self.state.clone();
            spawn_local(async move {
                let result = JsFuture::from(flushed).await;
                let mut state = state.borrow_mut();
                state.is_flushed = true;
                if let Err(error) = result {
                    state.error.get_or_insert(words(&error));
                }
            });
        }
        let mut state = self.state.borrow_mut();
        if let Some(error) = &state.error {
            return Err(error.clone());
        }
        if !state.is_flushed {
            return Ok(None);
        }
        Ok(Some(EncodedVideo {
            codec: if self.codec.starts_with("avc1") {
                Codec::H264 {
                    configuration: std::mem::take(&mut state.configuration),
                }
            } else if self.codec == "vp8" {
                Codec::Vp8
            } else {
                Codec::Vp9
            },
            colours: state.colours.unwrap_or(Colours::BT709),
            packets: std::mem::take(&mut state.packets),
        }))
    }
}

impl Drop for VideoEncoder {
    fn drop(&mut self) {
        // Refused if an error has closed it.
        let _ = self.encoder.close();
    }
}

fn take(state: &mut State, chunk: &Chunk, about: &JsValue) -> Result<(), JsValue> {
    let bytes = Uint8Array::new_with_length(chunk.byte_length());
    chunk.copy_to(&bytes)?;
    state.packets.push(Packet {
        time: chunk.timestamp() as u64,
        is_key: chunk.kind() == "key",
        bytes: bytes.to_vec(),
    });
    if !about.is_object() {
        return Ok(());
    }
    let config = Reflect::get(about, &"decoderConfig".into())?;
    if config.is_object() {
        let record = Reflect::get(&config, &"description".into())?;
        if record.is_object() {
            // A buffer, or a view of one.
            let view = match record.dyn_ref::<Uint8Array>() {
                Some(view) => view.clone(),
                None => Uint8Array::new(&record),
            };
            state.configuration = view.to_vec();
        }
        state.colours = colours(&Reflect::get(&config, &"colorSpace".into())?).or(state.colours);
    }
    Ok(())
}

/// Returns the meaning of colours by WebCodecs' words; `None` if one is not known.
fn colours(space: &JsValue) -> Option<Colours> {
    let code = |name: &str| {
        let word = Reflect::get(space, &name.into()).ok()?.as_string()?;
        Some(match word.as_str() {
            "rgb" => 0,
            "bt709" => 1,
            "bt470bg" => 5,
            "smpte170m" => 6,
            "iec61966-2-1" => 13,
            _ => return None,
        })
    };
    if !space.is_object() {
        return None;
    }
    let full = Reflect::get(space, &"fullRange".into()).ok()?;
    Some(Colours {
        primaries: code("primaries")?,
        transfer: code("transfer")?,
        matrix: code("matrix")?,
        full_range: full.is_truthy(),
    })
}

fn words(error: &JsValue) -> String {
    let message = Reflect::get(error, &"message".into()).ok();
    let message = message.and_then(|message| message.as_string());
    format!(
        "The browser cannot encode this video: {}.",
        message.unwrap_or_else(|| String::from("it does not say why"))
    )
}
