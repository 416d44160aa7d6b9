//! Files that are dropped or opened, and the tabs they become.

use crate::driver::Window;
use document::intake::Incoming;
use document::share;
use document::storage::{Shelf, Store};
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use rats::File;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use studio::page::Parts;
use studio::scripts::request::Request;

const TEXT: &str = "\
framesize 64 48
eyep 0 0 6
surface flesh, diffuse Coral, blobbiness -2
sphere flesh 0.5, 0 0 0
";

const OBJ: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fn take_in(window: &mut Window, files: &[(&str, &[u8])]) {
    let files = files.iter().map(|(name, bytes)| Incoming {
        name: (*name).to_owned(),
        bytes: Ok(bytes.to_vec()),
    });
    window.parts.requests.ask(Request::Files(files.collect()));
    window.steps(4);
}

fn files(window: &Window) -> Vec<File> {
    window.parts.outbox.borrow().project.files.clone()
}

fn names(window: &Window) -> Vec<String> {
    files(window).into_iter().map(|file| file.name).collect()
}

/// A file that is dropped on the window.
#[derive(Debug)]
struct Dropped(PathBuf, Vec<u8>);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }
    fn bytes(&self) -> Result<Vec<u8>, String> {
        Ok(self.1.clone())
    }
}

#[test]
fn a_text_dropped_on_an_example_is_a_new_work_and_on_own_work_a_tab() {
    let mut window = Window::open(1000.0, 700.0);
    assert_eq!(names(&window), ["tide.rat"]);
    let file = Dropped(PathBuf::from("/home/me/bone.rat"), TEXT.as_bytes().to_vec());
    window
        .harness
        .input_mut()
        .dropped_files
        .push(Arc::new(file));
    window.steps(5);
    assert_eq!(names(&window), ["bone.rat"]);
    assert_eq!(window.text(), TEXT);
    window.harness.get_by_label_contains("as a new work");

    window.edit();
    window.write("# mine\n");
    take_in(
        &mut window,
        &[("leg.rat", b"# leg\n"), ("foot.txt", b"# foot\n")],
    );
    assert_eq!(names(&window), ["bone.rat", "leg.rat", "foot.txt"]);
    window
        .harness
        .get_by_label_contains("Added leg.rat and foot.txt");

    // One of the same name takes its place, and undo brings it back.
    take_in(&mut window, &[("bone.rat", b"# other\n")]);
    assert_eq!(window.text(), "# other\n");
    window
        .harness
        .get_by_label_contains("Undo brings back bone.rat");
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.text(), format!("# mine\n{TEXT}"));
}

#[test]
fn images_and_meshes_are_tabs_that_show_them_and_are_kept_but_not_shared() {
    let parts = Parts::new();
    let mut window = Window::open_with(1000.0, 700.0, parts.clone());
    window.load(TEXT);
    window.edit();
    window.write("# mine\n");
    let png: &[u8] = include_bytes!("../../../../www/examples/cowrie.png");
    take_in(&mut window, &[("wood.png", png), ("tri.obj", OBJ)]);
    window.harness.get_by_label_contains("3 corners, 1 face");
    let tab = window.place("tab wood.png").center();
    window.click(tab);
    window.harness.get_by_label_contains("pixels, ");
    assert!(window.place("asset image").width() > 100.0);
    window.steps(20);

    let share = window.place("share").center();
    window.click(share);
    window
        .harness
        .get_by_label_contains("not the images and meshes");
    let shared = share::open(&browser::hash()).unwrap().unwrap();
    assert_eq!(shared.project.files.len(), 1);
    browser::set_hash("");

    window.harness.get_by_label("Back to the text").click();
    window.steps(3);
    assert!(window.place("editor").height() > 100.0);
    drop(window);

    // They are there again after the page was closed.
    let mut window = Window::open_with(1000.0, 700.0, parts);
    let tab = window.place("tab tri.obj").center();
    window.click(tab);
    window.harness.get_by_label("Remove").click();
    window.steps(3);
    assert!(!studio::places::all(&window.harness.ctx).contains_key("tab tri.obj"));
    window.finish();
    window.harness.get_by_label("Put it back").click();
    window.steps(3);
    window.place("tab tri.obj");
}

/// A store that takes texts of at most 20 kB.
#[derive(Default)]
struct Small(BTreeMap<String, String>);

impl Store for Small {
    fn get(&self, key: &str) -> Option<String> {
        self.0.get(key).cloned()
    }
    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        if value.len() > 20_000 {
            return Err(String::from("no room"));
        }
        self.0.insert(key.to_owned(), value.to_owned());
        Ok(())
    }
    fn remove(&mut self, key: &str) {
        self.0.remove(key);
    }
    fn keys(&self) -> Vec<String> {
        self.0.keys().cloned().collect()
    }
}

#[test]
fn files_that_cannot_be_kept_or_taken_are_reported() {
    let mut parts = Parts::new();
    let shelf = Shelf::new(Box::<Small>::default(), String::from("a"));
    parts.shelf = Rc::new(RefCell::new(shelf));
    let mut window = Window::open_with(1000.0, 700.0, parts);
    window.load(TEXT);
    window.edit();
    window.write("# mine\n");
    let mut large = OBJ.to_vec();
    large.resize(100_000, b' ');
    take_in(&mut window, &[("large.obj", &large)]);
    window.steps(20);
    window
        .harness
        .get_by_label_contains("no room for large.obj");

    let before = window.text();
    take_in(
        &mut window,
        &[("a.gif", b"GIF89a"), ("b.png", b"no"), ("c.rat", b"\0")],
    );
    window.harness.get_by_label_contains("Not taken: a.gif");
    assert_eq!((names(&window).len(), window.text()), (1, before));
}

#[test]
fn files_can_be_chosen_with_a_button_on_a_desk_and_on_a_phone() {
    let mut window = Window::with_text(TEXT);
    let button = window.place("open files").center();
    window.click(button);
    assert!(browser::was_asked_for_files());
    drop(window);
    let mut window = Window::open(390.0, 844.0);
    let more = window.place("more").center();
    window.click(more);
    window.harness.get_by_label("Open files…").click();
    window.steps(2);
    assert!(browser::was_asked_for_files());
    // The tabs have room there too.
    take_in(&mut window, &[("tri.obj", OBJ)]);
    window.place("tab tri.obj");
}

#[test]
fn a_project_is_one_file_and_can_be_opened_again() {
    let mut window = Window::with_text(TEXT);
    window.edit();
    window.write("# a bone\n");
    take_in(&mut window, &[("leg.rat", b"# leg\n"), ("bone.obj", OBJ)]);
    let saved = files(&window);
    let menu = window.place("download").center();
    window.click(menu);
    let choice = window.place("download project").center();
    window.click(choice);
    let (name, bytes) = browser::last_download().expect("a file");
    assert_eq!(name, "Main.zip");
    window.harness.get_by_label_contains("Saved Main.zip");

    // Opened elsewhere, where another work of the user's is open, which is kept.
    let mut window = Window::open(1000.0, 700.0);
    window.edit();
    window.write("# mine\n");
    take_in(&mut window, &[("downloads/Main (1).zip", &bytes)]);
    window
        .harness
        .get_by_label_contains("Opened Main as a new work");
    assert_eq!(files(&window), saved);
    let outbox = window.parts.outbox.borrow();
    assert_eq!(outbox.report.assets, ["bone.obj"]);
    assert_eq!(outbox.report.name, "Main");
    drop(outbox);
    take_in(&mut window, &[("bad.zip", &bytes[..bytes.len() / 2])]);
    window
        .harness
        .get_by_label_contains("bad.zip: it is cut off or no zip archive");
    assert_eq!(files(&window), saved, "the work stays");
}
