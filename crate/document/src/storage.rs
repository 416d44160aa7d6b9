//! The user's work in the browser's storage.
//!
//! Every work is a record under its own key, so that a shared link or an example never overwrites a
//! work of the user's: it becomes a record of its own, and only once it is edited. Two tabs that
//! edit the same record do not overwrite each other either: a tab whose record another one writes,
//! or has changed, goes on with a copy under a new key. A record that cannot be read, because it is
//! damaged or from a newer version, is left alone.
//!
//! Undo steps, earlier versions, images and meshes of a work are texts beside its record, which the
//! [`Store`] may keep elsewhere; if they are refused, the record is safe.

use crate::asset::Asset;
use crate::session::Kept;
use crate::versions::Versions;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use rats::Project;
use serde::{Deserialize, Serialize};

/// Version of the records; newer ones are not touched.
pub const VERSION: u32 = 1;
/// Seconds after an edit until it is written.
pub const DELAY: f64 = 0.5;
/// Most bytes of undo steps that are written, and of those where there is little room.
const HISTORY_BYTES: [usize; 2] = [1 << 20, 128 << 10];

const ASSETS: &str = "sinew/assets/";
const HISTORY: &str = "sinew/history/";
const VERSIONS: &str = "sinew/versions/";
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
    /// Whether another tab writes the open record.
    is_theirs: bool,
    /// The name of the copy that the open work has become.
    copy: Option<String>,
    /// The images and meshes that were written last, and the record they belong to.
    assets: Option<(String, Vec<Asset>)>,
    /// Earlier versions of the open work, and its texts when they were last read or written.
    versions: Versions,
    present: Option<Project>,
    /// Warning about what was not kept.
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
            is_theirs: false,
            copy: None,
            assets: None,
            versions: Versions::default(),
            present: None,
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
        self.begin();
        self.open = Some((id.to_owned(), stamp));
        record.kept.assets = self.read_assets(id);
        // Records had their undo steps inside.
        if let Some(history) = self.read_beside(HISTORY, id) {
            record.kept.history = history;
        }
        self.versions = self.read_beside(VERSIONS, id).unwrap_or_default();
        self.present = Some(record.kept.project.clone());
        // If this is refused, the next start opens another record; nothing is lost.
        let _ = self.store.set(CURRENT, id);
        Some((record.name, record.kept))
    }

    /// Reads what is kept beside a record.
    fn read_beside<T: for<'a> Deserialize<'a>>(&self, kind: &str, id: &str) -> Option<T> {
        let json = self.store.get(&format!("{kind}{id}"))?;
        serde_json::from_str(&json).ok()
    }

    /// Writes what is kept beside a record.
    fn write_beside<T: Serialize>(&mut self, kind: &str, id: &str, value: &T) -> bool {
        let json = serde_json::to_string(value);
        json.is_ok_and(|json| self.store.set(&format!("{kind}{id}"), &json).is_ok())
    }

    /// Takes the warning about what is not kept.
    pub fn take_warning(&mut self) -> Option<String> {
        self.warning.take()
    }

    /// Reads the images and meshes of a work. Leaves a warning about those that were too large.
    fn read_assets(&mut self, id: &str) -> Vec<Asset> {
        let kept: Vec<KeptAsset> = self.read_beside(ASSETS, id).unwrap_or_default();
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
        let mut kept: Vec<KeptAsset> = assets
            .iter()
            .map(|asset| KeptAsset {
                name: asset.name.clone(),
                bytes: Some(STANDARD.encode(&asset.bytes[..])),
            })
            .collect();
        let mut lost = Vec::new();
        while !self.write_beside(ASSETS, id, &kept) {
            // The largest is left out, so that only its name is kept.
            let largest = kept
                .iter_mut()
                .filter(|asset| asset.bytes.is_some())
                .max_by_key(|asset| asset.bytes.as_ref().map_or(0, String::len));
            let Some(largest) = largest else {
                break;
            };
            largest.bytes = None;
            lost.push(largest.name.clone());
        }
        if !lost.is_empty() {
            self.warning = Some(format!(
                "This browser has no room for {}. It stays until you close the page; \
                    the text is kept. Save the project as a file to keep all.",
                lost.join(", ")
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
        self.is_theirs = false;
        self.versions = Versions::default();
        self.present = None;
    }

    /// Closes the record, so that the next edit of these texts begins a new one, of which they are
    /// the first version.
    pub fn begin_from(&mut self, project: Project) {
        self.begin();
        self.present = Some(project);
    }

    /// Sets whether another tab writes the open record, so that what is edited here is a copy.
    pub fn set_theirs(&mut self, is_theirs: bool) {
        self.is_theirs = is_theirs;
    }

    /// Whether another tab writes the open record.
    #[must_use]
    pub fn is_theirs(&self) -> bool {
        self.is_theirs
    }

    /// Whether another tab has written the open record since this one read or wrote it.
    #[must_use]
    pub fn is_behind(&self) -> bool {
        let open = self.open.as_ref();
        open.is_some_and(|(id, known)| self.stamp(id).is_some_and(|stamp| stamp != *known))
    }

    /// Takes the name of the copy that the open work has become, as another tab writes the record.
    pub fn take_copy(&mut self) -> Option<String> {
        self.copy.take()
    }

    /// Returns the earlier versions of the open work.
    #[must_use]
    pub fn versions(&self) -> &Versions {
        &self.versions
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
        let Some((mut name, kept)) = self.pending.clone() else {
            return Ok(());
        };
        self.writes += 1;
        let stamp = format!("{}.{}", self.tab, self.writes);
        let known = match &self.open {
            Some((id, known)) => {
                let is_ours = self.stamp(id).is_none_or(|stamp| stamp == *known);
                if !is_ours || self.is_theirs {
                    name.push_str(" copy");
                    self.copy = Some(name.clone());
                    None
                } else {
                    Some(id.clone())
                }
            }
            None => None,
        };
        let id = known.unwrap_or_else(|| stamp.clone());
        // Or another tab has deleted all of it.
        let is_new = self.stamp(&id).is_none();
        if is_new {
            self.assets = None;
        }
        let Kept {
            project,
            camera,
            history,
            assets,
        } = kept;
        let record = Record {
            version: VERSION,
            name,
            saved: now,
            kept: Kept {
                project,
                camera,
                ..Kept::default()
            },
        };
        let json = serde_json::to_string(&record).map_err(|error| error.to_string())?;
        let text = format!("{stamp}\n{json}");
        self.store.set(&format!("{DOCUMENT}{id}"), &text)?;
        self.store.set(CURRENT, &id)?;
        self.open = Some((id.clone(), stamp));
        self.is_theirs = false;
        self.pending = None;
        let mut sizes = HISTORY_BYTES.iter();
        if !sizes.any(|bytes| self.write_beside(HISTORY, &id, &history.within(*bytes))) {
            self.store.remove(&format!("{HISTORY}{id}"));
        }
        self.write_assets(&id, &assets);
        let before = self.present.replace(record.kept.project);
        let is_noted =
            before.is_some_and(|before| self.versions.note(before, self.present.as_ref(), now));
        if is_noted || is_new && !self.versions.all().is_empty() {
            let versions = std::mem::take(&mut self.versions);
            // Where there is no room, the last ones that were written stay.
            self.write_beside(VERSIONS, &id, &versions);
            self.versions = versions;
        }
        Ok(())
    }

    /// Deletes a saved work, unless it is open.
    pub fn delete(&mut self, id: &str) {
        if self.open_id() != Some(id) {
            for kind in [DOCUMENT, ASSETS, HISTORY, VERSIONS] {
                self.store.remove(&format!("{kind}{id}"));
            }
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
    fn undo_steps_inside_an_old_record_are_found_and_move_out_of_it() {
        let mut store = Common::default();
        let mut mine = work("new");
        mine.history.record(&work("old").project, 0.0);
        let record = Record {
            version: VERSION,
            name: String::from("shell"),
            saved: 1.0,
            kept: mine,
        };
        let json = serde_json::to_string(&record).unwrap();
        store
            .set("sinew/document/x", &format!("stamp\n{json}"))
            .unwrap();
        let mut shelf = Shelf::new(Box::new(store.clone()), String::from("a"));
        let (_, kept) = shelf.open("x").unwrap();
        assert!(kept.history.can_undo());
        shelf.put("shell", kept);
        shelf.flush(2.0).unwrap();
        let text = store.get("sinew/document/x").unwrap();
        assert!(text.contains("new") && !text.contains("old"), "{text}");
        let (_, mut again) = shelf.open("x").unwrap();
        assert_eq!(
            again.history.undo(&again.project).unwrap().files[0].text,
            "old"
        );
    }

    /// Returns the texts of the versions of the open work.
    fn versions(shelf: &Shelf) -> Vec<&str> {
        let all = shelf.versions().all().iter();
        all.map(|version| version.project.files[0].text.as_str())
            .collect()
    }

    #[test]
    fn texts_before_a_change_are_versions_of_the_work_and_of_its_copies() {
        let store = Common::default();
        let mut shelf = Shelf::new(Box::new(store.clone()), String::from("a"));
        shelf.begin_from(work("an example").project);
        shelf.put("shell", work("mine"));
        shelf.flush(1e6).unwrap();
        shelf.put("shell", work("mine and more"));
        shelf.flush(2e6).unwrap();
        let id = shelf.open_id().unwrap().to_owned();
        let mut again = Shelf::new(Box::new(store.clone()), String::from("b"));
        again.open(&id).unwrap();
        assert_eq!(versions(&again), ["an example", "mine"]);
        again.set_theirs(true);
        again.put("shell", work("x"));
        again.flush(3e6).unwrap();
        let copy = again.open_id().unwrap().to_owned();
        assert_ne!(copy, id);
        again.open(&copy).unwrap();
        assert_eq!(versions(&again), ["an example", "mine", "mine and more"]);
        again.begin();
        assert!(versions(&again).is_empty());
        again.delete(&id);
        again.delete(&copy);
        let left: Vec<_> = store
            .keys()
            .into_iter()
            .filter(|key| key != CURRENT)
            .collect();
        assert!(left.is_empty(), "{left:?}");
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
        assert!(first.is_behind() && !second.is_behind());
        first.put("shell", work("three"));
        first.flush(3.0).unwrap();
        assert_eq!(first.take_copy().as_deref(), Some("shell copy"));
        assert_eq!((first.take_copy(), second.take_copy()), (None, None));
        assert!(!first.is_behind());
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
            (2000, [3, 9000], "1.png"),
            (2000, [8000, 9000], "1.png, 0.png"),
        ] {
            let store = Common(Rc::default(), Some(limit));
            let mut shelf = Shelf::new(Box::new(store.clone()), String::from("a"));
            shelf.put("a", with_assets(&sizes));
            shelf.flush(1.0).unwrap();
            let warning = shelf.take_warning().unwrap();
            assert!(warning.contains(&format!(" {lost}. ")), "{warning}");
            shelf.put("b", with_assets(&sizes));
            shelf.flush(2.0).unwrap();
            assert_eq!(shelf.take_warning(), None, "said once");
            let id = shelf.open_id().unwrap().to_owned();
            let mut again = Shelf::new(Box::new(store), String::from("b"));
            let (name, kept) = again.open(&id).unwrap();
            assert_eq!((name.as_str(), text(&kept)), ("b", "text"));
            assert_eq!(kept.assets.len(), 2 - lost.split(", ").count());
            let warning = again.take_warning().unwrap();
            assert!(
                lost.split(", ").all(|name| warning.contains(name)),
                "{warning}"
            );
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
