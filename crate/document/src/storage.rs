//! The user's work in the browser's local storage.
//!
//! Every work is a record under its own key, so that a shared link or an example never overwrites a
//! work of the user's: it becomes a record of its own, and only once it is edited. Two tabs that
//! edit the same record do not overwrite each other either: a tab whose record was changed by
//! another goes on under a new key. A record that cannot be read, because it is damaged or from a
//! newer version, is left alone.
//!
//! Images and meshes of a work are a record beside it, written only when they change. Local storage
//! is small, so only the names are kept of those beyond [`MAX_KEPT`].

use crate::asset::{self, Asset};
use crate::session::Kept;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Serialize};

/// Version of the records; newer ones are not touched.
pub const VERSION: u32 = 1;
/// Seconds after an edit until it is written.
pub const DELAY: f64 = 0.5;
/// Most bytes of undo steps that are written with a record.
const HISTORY_BYTES: usize = 512 * 1024;

/// Most bytes of images and meshes that are kept with a work. Browsers give a page about 5 MB, and
/// writing bytes as text takes a third more.
pub const MAX_KEPT: usize = 1_500_000;

const ASSETS: &str = "sinew/assets/";
const DOCUMENT: &str = "sinew/document/";
const CURRENT: &str = "sinew/current";
const SETTINGS: &str = "sinew/settings";

/// A place that keeps texts under keys.
pub trait Store {
    /// Returns the text under a key.
    fn get(&self, key: &str) -> Option<String>;
    /// Keeps a text.
    ///
    /// # Errors
    /// If there is no space or storing is not allowed.
    fn set(&mut self, key: &str, value: &str) -> Result<(), String>;
    /// Forgets a key.
    fn remove(&mut self, key: &str);
    /// Returns the keys.
    fn keys(&self) -> Vec<String>;
}

/// A store in memory, for tests and for browsers that allow none: work lasts until the page closes.
impl Store for std::collections::BTreeMap<String, String> {
    fn get(&self, key: &str) -> Option<String> {
        Self::get(self, key).cloned()
    }
    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        self.insert(key.to_owned(), value.to_owned());
        Ok(())
    }
    fn remove(&mut self, key: &str) {
        Self::remove(self, key);
    }
    fn keys(&self) -> Vec<String> {
        Self::keys(self).cloned().collect()
    }
}

/// An entry in the list of saved works.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Key of the record.
    pub id: String,
    /// Name given by the user.
    pub name: String,
    /// Time at which it was written, milliseconds since 1970.
    pub saved: f64,
}

#[derive(Serialize, Deserialize)]
struct Record {
    version: u32,
    name: String,
    saved: f64,
    kept: Kept,
}

/// An image or a mesh as it is stored; without bytes if it was too large.
#[derive(Serialize, Deserialize)]
struct KeptAsset {
    name: String,
    bytes: Option<String>,
}

/// The saved works, and the one that is open.
pub struct Shelf {
    store: Box<dyn Store>,
    /// A word that tells this tab's writes from those of other tabs.
    tab: String,
    writes: u64,
    /// Key of the open record, and its stamp when this tab last read or wrote it.
    open: Option<(String, String)>,
    pending: Option<(String, Kept)>,
    /// The images and meshes that were written last, and the record they belong to.
    assets: Option<(String, Vec<Asset>)>,
    /// Warning about images and meshes that were not kept.
    warning: Option<String>,
}

impl Shelf {
    /// Opens a store. `tab` must differ between tabs (a random word).
    #[must_use]
    pub fn new(store: Box<dyn Store>, tab: String) -> Self {
        Self {
            store,
            tab,
            writes: 0,
            open: None,
            pending: None,
            assets: None,
            warning: None,
        }
    }

    /// Returns the id of the work that was open last.
    #[must_use]
    pub fn last(&self) -> Option<String> {
        self.store.get(CURRENT)
    }

    /// Returns the saved works, the newest first.
    #[must_use]
    pub fn entries(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = self
            .store
            .keys()
            .into_iter()
            .filter_map(|key| {
                let id = key.strip_prefix(DOCUMENT)?.to_owned();
                let (_, record) = self.read(&id)?;
                Some(Entry {
                    id,
                    name: record.name,
                    saved: record.saved,
                })
            })
            .collect();
        field::heap_sort(&mut entries, |a, b| {
            b.saved.total_cmp(&a.saved).then(a.id.cmp(&b.id)).is_lt()
        });
        entries
    }

    /// Opens a saved work, to which later edits are written. Returns its name and content.
    pub fn open(&mut self, id: &str) -> Option<(String, Kept)> {
        let (stamp, mut record) = self.read(id)?;
        self.open = Some((id.to_owned(), stamp));
        self.pending = None;
        record.kept.assets = self.read_assets(id);
        // If this is refused, the next start opens another record; nothing is lost.
        let _ = self.store.set(CURRENT, id);
        Some((record.name, record.kept))
    }

    /// Takes the warning about images and meshes that are not kept.
    pub fn take_warning(&mut self) -> Option<String> {
        self.warning.take()
    }

    /// Reads the images and meshes of a work. Leaves a warning about those that were too large.
    fn read_assets(&mut self, id: &str) -> Vec<Asset> {
        let kept = self.store.get(&format!("{ASSETS}{id}"));
        let kept: Vec<KeptAsset> = kept
            .and_then(|json| serde_json::from_str(&json).ok())
            .unwrap_or_default();
        let (mut assets, mut lost) = (Vec::new(), Vec::new());
        for KeptAsset { name, bytes } in kept {
            match bytes.and_then(|text| STANDARD.decode(text).ok()) {
                Some(bytes) => assets.push(Asset::await_mesh(name, bytes)),
                None => lost.push(name),
            }
        }
        if lost.is_empty() {
            self.assets = Some((id.to_owned(), assets.clone()));
        } else {
            self.warning = Some(format!(
                "{} could not be kept in this browser. \
                    Add the file again to see the whole picture.",
                lost.join(", ")
            ));
        }
        assets
    }

    /// Writes the images and meshes of a work if they changed. Leaves a warning about those that
    /// are too large.
    fn write_assets(&mut self, id: &str, assets: &[Asset]) {
        let known = self.assets.as_ref();
        if known.is_some_and(|(of, known)| of == id && known == assets)
            || known.is_none_or(|(of, _)| of != id) && assets.is_empty()
        {
            return;
        }
        self.assets = Some((id.to_owned(), assets.to_vec()));
        let key = format!("{ASSETS}{id}");
        if assets.is_empty() {
            self.store.remove(&key);
            return;
        }
        let mut left = MAX_KEPT;
        let mut lost = Vec::new();
        let mut kept: Vec<KeptAsset> = Vec::new();
        for Asset { name, bytes, .. } in assets {
            let fits = bytes.len() <= left;
            if fits {
                left -= bytes.len();
            } else {
                lost.push(name.clone());
            }
            kept.push(KeptAsset {
                name: name.clone(),
                bytes: fits.then(|| STANDARD.encode(bytes)),
            });
        }
        let write = |store: &mut dyn Store, kept: &[KeptAsset]| {
            serde_json::to_string(kept)
                .map_err(|error| error.to_string())
                .and_then(|json| store.set(&key, &json))
        };
        if write(&mut *self.store, &kept).is_err() {
            lost = assets.iter().map(|asset| asset.name.clone()).collect();
            for asset in &mut kept {
                asset.bytes = None;
            }
            // Only their names are kept. If that fails, too, the texts are still safe.
            let _ = write(&mut *self.store, &kept);
        }
        if !lost.is_empty() {
            self.warning = Some(format!(
                "{} cannot be kept: this browser keeps {} of images and meshes with a work. \
                    It stays until you close the page; the text is kept.",
                lost.join(", "),
                asset::size(MAX_KEPT)
            ));
        }
    }

    /// Returns the id of the open work, once it has been written.
    #[must_use]
    pub fn open_id(&self) -> Option<&str> {
        self.open.as_ref().map(|(id, _)| id.as_str())
    }

    /// Closes the record, so that the next edit begins a new one.
    pub fn begin(&mut self) {
        self.open = None;
        self.pending = None;
    }

    /// Takes a work, which the next [`Shelf::flush`] writes.
    pub fn put(&mut self, name: &str, kept: Kept) {
        self.pending = Some((name.to_owned(), kept));
    }

    /// Whether a work waits to be written.
    #[must_use]
    pub fn is_dirty(&self) -> bool {
        self.pending.is_some()
    }

    /// Writes the work that waits, at `now` in milliseconds since 1970.
    ///
    /// # Errors
    /// If the browser refuses; the text is then in the open page only.
    pub fn flush(&mut self, now: f64) -> Result<(), String> {
        let Some((name, kept)) = self.pending.clone() else {
            return Ok(());
        };
        self.writes += 1;
        let stamp = format!("{}.{}", self.tab, self.writes);
        let id = match &self.open {
            Some((id, known)) if self.stamp(id).is_none_or(|stamp| stamp == *known) => id.clone(),
            _ => stamp.clone(),
        };
        let record = |history: usize| {
            let record = Record {
                version: VERSION,
                name: name.clone(),
                saved: now,
                kept: Kept {
                    history: kept.history.within(history),
                    ..kept.clone()
                },
            };
            serde_json::to_string(&record)
                .map(|json| format!("{stamp}\n{json}"))
                .map_err(|error| error.to_string())
        };
        let key = format!("{DOCUMENT}{id}");
        // If space is short, the text matters more than its undo steps.
        self.store
            .set(&key, &record(HISTORY_BYTES)?)
            .or_else(|_| self.store.set(&key, &record(0)?))?;
        self.store.set(CURRENT, &id)?;
        self.write_assets(&id, &kept.assets);
        self.open = Some((id, stamp));
        self.pending = None;
        Ok(())
    }

    /// Deletes a saved work, unless it is open.
    pub fn delete(&mut self, id: &str) {
        if self.open_id() != Some(id) {
            self.store.remove(&format!("{DOCUMENT}{id}"));
            self.store.remove(&format!("{ASSETS}{id}"));
        }
    }

    /// Reads the page's settings; the defaults if there are none or they cannot be read.
    #[must_use]
    pub fn settings<T: Default + for<'a> Deserialize<'a>>(&self) -> T {
        self.store
            .get(SETTINGS)
            .and_then(|json| serde_json::from_str(&json).ok())
            .unwrap_or_default()
    }

    /// Writes the page's settings.
    pub fn set_settings<T: Serialize>(&mut self, settings: &T) {
        if let Ok(json) = serde_json::to_string(settings) {
            // Settings that cannot be stored last until the page closes, which is harmless.
            let _ = self.store.set(SETTINGS, &json);
        }
    }

    /// Returns the stamp of a record.
    fn stamp(&self, id: &str) -> Option<String> {
        let text = self.store.get(&format!("{DOCUMENT}{id}"))?;
        text.split_once('\n').map(|(stamp, _)| stamp.to_owned())
    }

    /// Returns the stamp and the content of a record.
    fn read(&self, id: &str) -> Option<(String, Record)> {
        let text = self.store.get(&format!("{DOCUMENT}{id}"))?;
        let (stamp, json) = text.split_once('\n')?;
        let record: Record = serde_json::from_str(json).ok()?;
        (record.version == VERSION).then(|| (stamp.to_owned(), record))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rats::{File, Project};
    use std::cell::RefCell;
    use std::collections::BTreeMap;
    use std::rc::Rc;

    /// A store that several shelves share, as several tabs share local storage, and perhaps the
    /// most bytes of a value.
    #[derive(Clone, Default)]
    struct Common(Rc<RefCell<BTreeMap<String, String>>>, Option<usize>);

    impl Store for Common {
        fn get(&self, key: &str) -> Option<String> {
            self.0.borrow().get(key).cloned()
        }
        fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
            if self.1.is_some_and(|limit| value.len() > limit) {
                return Err(String::from("no room"));
            }
            self.0.borrow_mut().insert(key.to_owned(), value.to_owned());
            Ok(())
        }
        fn remove(&mut self, key: &str) {
            self.0.borrow_mut().remove(key);
        }
        fn keys(&self) -> Vec<String> {
            self.0.borrow().keys().cloned().collect()
        }
    }

    fn work(text: &str) -> Kept {
        Kept {
            project: Project {
                files: vec![File {
                    name: String::from("main.rat"),
                    text: text.to_owned(),
                }],
            },
            ..Kept::default()
        }
    }

    fn text(kept: &Kept) -> &str {
        &kept.project.files[0].text
    }

    #[test]
    fn work_undo_and_camera_survive_closing() {
        let store = Common::default();
        let mut shelf = Shelf::new(Box::new(store.clone()), String::from("a"));
        let mut mine = work("new");
        mine.history.record(&work("old").project, 0.0);
        mine.camera = Some(scene::Camera::default());
        shelf.put("shell", mine.clone());
        shelf.flush(1.0).unwrap();

        let mut shelf = Shelf::new(Box::new(store), String::from("b"));
        let last = shelf.last().unwrap();
        let (name, mut again) = shelf.open(&last).unwrap();
        assert_eq!((name.as_str(), again.camera), ("shell", mine.camera));
        let undone = again.history.undo(&again.project).unwrap();
        assert_eq!(undone.files[0].text, "old");
    }

    #[test]
    fn beginning_something_else_keeps_the_own_work() {
        let mut shelf = Shelf::new(Box::<BTreeMap<_, _>>::default(), String::from("a"));
        shelf.put("mine", work("mine"));
        shelf.flush(1.0).unwrap();
        shelf.begin();
        shelf.put("linked", work("linked"));
        shelf.flush(2.0).unwrap();
        let names: Vec<_> = shelf.entries().into_iter().map(|e| e.name).collect();
        assert_eq!(names, ["linked", "mine"]);
        let open = shelf.open_id().unwrap().to_owned();
        shelf.delete(&open);
        assert_eq!(shelf.entries().len(), 2, "the open work is not deleted");
    }

    #[test]
    fn two_tabs_do_not_overwrite_each_other() {
        let store = Common::default();
        let mut first = Shelf::new(Box::new(store.clone()), String::from("a"));
        first.put("shell", work("one"));
        first.flush(1.0).unwrap();
        let mut second = Shelf::new(Box::new(store), String::from("b"));
        let id = second.last().unwrap();
        second.open(&id).unwrap();
        second.put("shell", work("two"));
        second.flush(2.0).unwrap();
        first.put("shell", work("three"));
        first.flush(3.0).unwrap();
        let mut texts: Vec<_> = first
            .entries()
            .iter()
            .map(|entry| text(&first.read(&entry.id).unwrap().1.kept).to_owned())
            .collect();
        texts.sort();
        assert_eq!(texts, ["three", "two"]);
    }

    #[test]
    fn unreadable_records_are_left_alone() {
        let mut store = Common::default();
        let key = format!("{DOCUMENT}x");
        for strange in [
            "",
            "no stamp",
            "s\n{",
            "s\n{\"version\":2,\"name\":\"\",\"saved\":0,\
                \"kept\":{\"project\":{\"files\":[]},\"camera\":null}}",
        ] {
            store.set(&key, strange).unwrap();
            store.set(CURRENT, "x").unwrap();
            let mut shelf = Shelf::new(Box::new(store.clone()), String::from("a"));
            assert!(shelf.open("x").is_none());
            shelf.put("mine", work("mine"));
            shelf.flush(1.0).unwrap();
            assert_eq!(store.get(&key).unwrap(), strange);
        }
    }

    fn with_assets(sizes: &[usize]) -> Kept {
        let assets = sizes
            .iter()
            .enumerate()
            .map(|(index, size)| Asset::await_mesh(format!("{index}.png"), vec![7; *size]));
        Kept {
            assets: assets.collect(),
            ..work("text")
        }
    }

    #[test]
    fn images_are_kept_beside_the_text_and_go_with_it() {
        let store = Common::default();
        let mut shelf = Shelf::new(Box::new(store.clone()), String::from("a"));
        shelf.put("a", with_assets(&[3, 5]));
        shelf.flush(1.0).unwrap();
        assert_eq!(shelf.take_warning(), None);
        let id = shelf.open_id().unwrap().to_owned();
        let key = format!("{ASSETS}{id}");
        // Unchanged assets are not written again.
        let mut watched = store.clone();
        watched.remove(&key);
        shelf.put("a", with_assets(&[3, 5]));
        shelf.flush(2.0).unwrap();
        assert_eq!(store.get(&key), None);
        shelf.put("a", with_assets(&[3]));
        shelf.flush(3.0).unwrap();
        let mut again = Shelf::new(Box::new(store.clone()), String::from("b"));
        assert_eq!(again.open(&id).unwrap().1, with_assets(&[3]));
        again.begin();
        again.delete(&id);
        assert_eq!((store.get(&key), again.entries().len()), (None, 0));
    }

    #[test]
    fn an_image_that_cannot_be_kept_is_named_and_the_text_is_safe() {
        for (limit, sizes, lost) in [
            (None, &[3, MAX_KEPT][..], "1.png"),
            (Some(2000), &[3, 9000], "0.png, 1.png"),
        ] {
            let store = Common(Rc::default(), limit);
            let mut shelf = Shelf::new(Box::new(store.clone()), String::from("a"));
            shelf.put("a", with_assets(sizes));
            shelf.flush(1.0).unwrap();
            let warning = shelf.take_warning().unwrap();
            assert!(warning.starts_with(lost), "{warning}");
            shelf.put("b", with_assets(sizes));
            shelf.flush(2.0).unwrap();
            assert_eq!(shelf.take_warning(), None, "said once");
            let id = shelf.open_id().unwrap().to_owned();
            let mut again = Shelf::new(Box::new(store), String::from("b"));
            let (name, kept) = again.open(&id).unwrap();
            assert_eq!((name.as_str(), text(&kept)), ("b", "text"));
            assert_eq!(kept.assets.len(), 2 - lost.split(", ").count());
            assert!(again.take_warning().unwrap().starts_with(lost));
        }
    }

    #[test]
    fn short_room_drops_undo_steps_before_the_text() {
        let store = Common(Rc::default(), Some(700));
        let mut shelf = Shelf::new(Box::new(store.clone()), String::from("a"));
        let mut long = work("text");
        long.history.record(&work(&"x".repeat(1000)).project, 0.0);
        shelf.put("a", long);
        shelf.flush(1.0).unwrap();
        shelf.put("a", work(&"x".repeat(1000)));
        assert!(shelf.flush(2.0).is_err());
        assert!(
            shelf.is_dirty(),
            "what could not be written is not forgotten"
        );
        assert_eq!(
            text(&shelf.read(shelf.open_id().unwrap()).unwrap().1.kept),
            "text"
        );
    }
}
