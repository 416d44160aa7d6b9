//! Stand-ins for tests: an address and a storage in memory, one for each thread.

use crate::recording::{EncodedVideo, Kind, VideoFormat};
use ::picture::{Format, Picture, file};
use document::intake::Incoming;
use document::storage::Store;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use video::{Codec, Colours, Packet};

thread_local! {
    static HASH: RefCell<String> = const { RefCell::new(String::new()) };
    static PICKED: Cell<bool> = const { Cell::new(false) };
    static CHOSEN: RefCell<Vec<Incoming>> = const { RefCell::new(Vec::new()) };
    static DOWNLOAD: RefCell<Option<(String, Vec<u8>)>> = const { RefCell::new(None) };
}

/// Returns the seconds on a clock that never goes back.
#[must_use]
pub fn now(ctx: &egui::Context) -> f64 {
    ctx.input(|input| input.time)
}

/// The pressure of a pen: there is none in tests.
#[must_use]
pub fn pen_pressure() -> Option<f32> {
    None
}

/// Sets whether each frame keeps the tracer waiting.
pub fn set_frames_slow(_is_slow: bool) {}

/// Returns the milliseconds since 1970.
#[must_use]
pub fn unix_time() -> f64 {
    std::time::SystemTime::now()
        .duration_since(std::time::UNIX_EPOCH)
        .map_or(0.0, |time| time.as_millis() as f64)
}

/// Returns a word that differs between tabs.
#[must_use]
pub fn random_word() -> String {
    String::from("native")
}

/// Returns the page's address without its fragment.
#[must_use]
pub fn page() -> String {
    String::from("https://sinew.example/")
}

/// Returns the fragment of the address, with `#`, or empty.
#[must_use]
pub fn hash() -> String {
    HASH.with_borrow(Clone::clone)
}

/// Changes the fragment without loading anything and without a new entry in the history.
pub fn set_hash(hash: &str) {
    HASH.set(hash.to_owned());
}

/// Changes the fragment and makes a new entry in the history.
pub fn push_hash(hash: &str) {
    set_hash(hash);
}

/// Returns a storage in memory.
#[must_use]
pub fn store() -> Box<dyn Store> {
    Box::<BTreeMap<String, String>>::default()
}

/// Shows the elements of a description to assistive technology, of which tests have none.
pub fn show_elements(_text: &str) {}

/// Fetches what is large of a saved work.
pub fn fetch_work(_id: &str, done: impl FnOnce() + 'static) {
    come(done);
}

thread_local! {
    static CLAIMED: RefCell<Option<String>> = const { RefCell::new(None) };
    static TAKEN: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Asks to be the only tab that writes a work.
pub fn claim_work(id: Option<&str>) {
    CLAIMED.set(id.map(str::to_owned));
}

/// Returns the work that was claimed last, for tests.
#[must_use]
pub fn last_claim() -> Option<String> {
    CLAIMED.with_borrow(Clone::clone)
}

/// Takes a work over from the tab that writes it.
pub fn take_work_over(id: &str) {
    TAKEN.set(Some(id.to_owned()));
}

/// Takes the work that was taken over last, for tests.
#[must_use]
pub fn last_takeover() -> Option<String> {
    TAKEN.take()
}

/// Whether something waits to be written.
#[must_use]
pub fn is_storing() -> bool {
    false
}

/// Saves a file for the user.
pub fn download(name: &str, _mime: &str, bytes: &[u8]) {
    DOWNLOAD.set(Some((name.to_owned(), bytes.to_vec())));
}

/// Calls of functions that wait for [`let_come`].
type Held = Vec<Box<dyn FnOnce()>>;

thread_local! {
    static HELD: RefCell<Option<Held>> = const { RefCell::new(None) };
}

/// Holds back all that is read and fetched from now on, until [`let_come`], for tests.
pub fn hold_back() {
    HELD.set(Some(Held::new()));
}

/// Lets all come that was held back, in the order in which it was asked for, for tests.
pub fn let_come() {
    for come in HELD.take().into_iter().flatten() {
        come();
    }
}

/// Calls a function, at once or when what is held back may come.
fn come(call: impl FnOnce() + 'static) {
    let held = HELD.with_borrow(Option::is_some);
    if held {
        HELD.with_borrow_mut(|held| held.get_or_insert_default().push(Box::new(call)));
    } else {
        call();
    }
}

/// Reads files that were dropped on the window, and gives them to a function.
pub fn read_dropped(
    files: Vec<egui::DroppedFileHandle>,
    take: impl FnOnce(Vec<Incoming>) + 'static,
) {
    let files = files.iter().map(|file| Incoming {
        name: file.path().display().to_string(),
        bytes: file.bytes(),
    });
    let files = files.collect();
    come(move || take(files));
}

/// Lets the user choose files: the last ones of [`choose_files`].
pub fn pick_files(take: impl FnOnce(Vec<Incoming>) + 'static) {
    PICKED.set(true);
    let chosen = CHOSEN.take();
    if !chosen.is_empty() {
        come(move || take(chosen));
    }
}

/// Sets the files that the user chooses when asked the next time, for tests.
pub fn choose_files(files: Vec<Incoming>) {
    CHOSEN.set(files);
}

/// Whether the user was asked to choose files since the last call, for tests.
#[must_use]
pub fn was_asked_for_files() -> bool {
    PICKED.take()
}

/// Takes the file that was saved last, for tests.
#[must_use]
pub fn last_download() -> Option<(String, Vec<u8>)> {
    DOWNLOAD.take()
}

thread_local! {
    static STOPPED: Cell<bool> = const { Cell::new(false) };
}

/// Whether the program stopped unexpectedly last time in this tab.
#[must_use]
pub fn has_stopped_before() -> bool {
    STOPPED.get()
}

/// Notes that the program may stop unexpectedly, or with `false` that it works.
pub fn set_stopped(has_stopped: bool) {
    STOPPED.set(has_stopped);
}

/// Whether the storage outlives the page.
#[must_use]
pub fn has_storage() -> bool {
    true
}

/// Whether the user's system asks for something: nothing in tests.
#[must_use]
pub fn is_wanted(_query: &str) -> bool {
    false
}

/// Sets the title of the browser's tab.
pub fn set_title(_name: &str) {}

/// Reads a file of the page.
#[must_use]
pub fn read(path: &str) -> Option<Vec<u8>> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../www");
    std::fs::read(folder.join(path)).ok()
}

/// Fetches a file of the page.
pub fn fetch(path: &'static str, done: impl FnOnce(Option<Vec<u8>>) + 'static) {
    come(move || done(read(path)));
}

/// Returns the formats of [`VideoEncoder`].
#[must_use]
pub fn native_formats() -> Vec<VideoFormat> {
    [(Kind::Mp4, "avc1"), (Kind::WebM, "vp09")]
        .map(|(kind, codec)| VideoFormat {
            kind,
            codec: codec.to_owned(),
        })
        .to_vec()
}

/// Asks for encoders.
pub fn video_formats(done: impl FnOnce(Vec<VideoFormat>) + 'static) {
    done(native_formats());
}

/// A stand-in for an encoder of videos: its packets are PNG files.
pub struct VideoEncoder {
    codec: Codec,
    packets: Vec<Packet>,
    is_ending: bool,
}

impl VideoEncoder {
    /// Makes an encoder of one of [`native_formats`].
    ///
    /// # Errors
    /// If the codec is another one.
    pub fn new(codec: &str, _size: [u32; 2], _rate: u16) -> Result<Self, String> {
        Ok(Self {
            codec: match codec {
                "avc1" => Codec::H264 {
                    configuration: vec![1, 66, 0, 31],
                },
                "vp09" => Codec::Vp9,
                other => return Err(format!("There is no codec {other}.")),
            },
            packets: Vec::new(),
            is_ending: false,
        })
    }

    /// Returns the number of frames that wait to be encoded.
    #[must_use]
    pub fn waiting(&self) -> usize {
        0
    }

    /// Encodes a frame that is shown at a time, microseconds.
    ///
    /// # Errors
    /// If it cannot be encoded.
    pub fn encode(&mut self, picture: &Picture, time: u64, is_key: bool) -> Result<(), String> {
        let bytes = file::encode(picture, Format::Png).map_err(|problem| problem.to_string())?;
        self.packets.push(Packet {
            time,
            is_key,
            bytes,
        });
        Ok(())
    }

    /// Returns the video at the second call, as a browser needs time.
    ///
    /// # Errors
    /// Never.
    pub fn finish(&mut self) -> Result<Option<EncodedVideo>, String> {
        let is_over = std::mem::replace(&mut self.is_ending, true);
        Ok(is_over.then(|| EncodedVideo {
            codec: self.codec.clone(),
            colours: Colours::BT709,
            packets: std::mem::take(&mut self.packets),
        }))
    }
}
