//! The tray: results of the commands on pictures, below the picture.

use crate::driver::Window;
use document::intake::Incoming;
use document::picture;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use pool::Image;
use studio::page::Parts;
use studio::places;
use studio::scripts::request::Request;

const SCENE: &str = "\
framesize 64 48
eyep 0 0 6
light White point, position 4 6 8
surface flesh, diffuse Coral, blobbiness -2
sphere flesh 0.5, 0 0 0
";

fn png(size: [u32; 2], level: u8) -> Vec<u8> {
    let rgba = [level, 0, level / 2, 255].repeat((size[0] * size[1]) as usize);
    picture::png(&Image { size, rgba }).unwrap()
}

/// Drops two pictures on the page.
fn drop_two(window: &mut Window) {
    let files = [("one.png", 200), ("two.png", 90)].map(|(name, level)| Incoming {
        name: name.to_owned(),
        bytes: Ok(png([40, 30], level)),
    });
    window.parts.requests.ask(Request::Files(files.to_vec()));
    window.steps(4);
    // The last of them is shown in the place of the text.
    window.harness.get_by_label("Back to the text").click();
    window.steps(2);
}

fn has(window: &Window, place: &str) -> bool {
    places::all(&window.harness.ctx).contains_key(place)
}

/// Runs until a result lies on the tray.
fn wait_for(window: &mut Window, name: &str) {
    let name = format!("result {name}");
    for _ in 0..1000 {
        if has(window, &name) {
            window.steps(2);
            return;
        }
        window.steps(1);
        std::thread::sleep(std::time::Duration::from_millis(3));
    }
    panic!("no {name} among {:?}", places::all(&window.harness.ctx));
}

fn open(window: &mut Window, name: &str) {
    let card = window.place(&format!("result {name}")).center();
    window.click(card);
    // A window needs a frame to find its size.
    window.steps(2);
}

#[test]
fn tools_on_two_dropped_pictures_give_results_that_are_shown_saved_and_kept() {
    let mut window = Window::with_text(SCENE);
    assert!(!has(&window, "tray"), "there is nothing to show");
    drop_two(&mut window);
    let jobs = "collage one.png two.png\nresize one.png 20 10\ndiff one.png two.png\ntable 1 4 9\n";
    window.edit();
    window.write(jobs);
    assert_eq!(window.errors(), 0);
    for name in ["collage.png", "one-20x10.png", "diff.png", "table.png"] {
        wait_for(&mut window, name);
    }
    window.harness.get_by_label("Results 4");
    let (tray, picture) = (window.place("tray"), window.place("picture"));
    assert!(tray.top() >= picture.bottom() && tray.height() > 100.0);

    open(&mut window, "collage.png");
    window.harness.get_by_label_contains("80 × 30 pixels, PNG");
    window.harness.get_by_label("wrote collage.png, 80×30");
    window.harness.get_by_label("Save").click();
    window.steps(2);
    let (name, bytes) = browser::last_download().expect("a file");
    assert_eq!((name.as_str(), &bytes[1..4]), ("collage.png", &b"PNG"[..]));
    window.key(Modifiers::NONE, Key::ArrowRight);
    window.key(Modifiers::NONE, Key::ArrowRight);
    window
        .harness
        .get_by_label_contains("1200 of 1200 pixels are not black, the largest value is 110");
    window.harness.get_by_label("Keep as a file").click();
    window.steps(3);
    window.harness.get_by_label("Kept as a file");
    window.key(Modifiers::NONE, Key::Escape);
    assert!(window.text().starts_with("collage one.png"));
    window.place("tab diff.png");
    window.place("editor");

    // Folded it leaves its room to the picture; without tools it disappears.
    let fold = window.place("fold tray").center();
    window.click(fold);
    assert!(window.place("tray").height() < 40.0);
    window.load(SCENE);
    assert!(!has(&window, "tray"));
}

#[test]
fn errors_have_the_words_of_the_program() {
    let mut window = Window::with_text(&format!(
        "resize no.png 20 10\nconvert ../a.png b.png\nshow color Gold\n{SCENE}"
    ));
    wait_for(&mut window, "colour.png");
    window
        .harness
        .get_by_label_contains("resize could not be done: there is no no.png here");
    window
        .harness
        .get_by_label_contains("convert could not be done: ../a.png leads out of");
    window.harness.get_by_label("2 could not be made");
    open(&mut window, "resize");
    window.harness.get_by_label("Picture of the model");
    let dialog = window.place("dialog");
    assert!(dialog.height() > 40.0);
    window.harness.get_by_label("Show in the text").click();
    window.steps(3);
    assert!(!has(&window, "dialog"));
    // The typed text replaces the command.
    window.write("table 1 2 3");
    assert!(window.text().starts_with("table 1 2 3\nconvert"));
    wait_for(&mut window, "table.png");
    open(&mut window, "convert");
    // The window of a result that is gone closes.
    window.load(SCENE);
    assert!(!has(&window, "dialog"));
}

#[test]
fn the_traced_picture_is_one_of_the_files_unless_it_is_not_saved() {
    let text = format!("filename shell\nformat tga\nconvert shell.tga small.png\n{SCENE}");
    let mut window = Window::with_text(&text);
    wait_for(&mut window, "small.png");
    window.finish();
    let traced = window.image();
    open(&mut window, "small.png");
    window.harness.get_by_label("Save").click();
    window.steps(2);
    let (_, bytes) = browser::last_download().expect("a file");
    let read = document::examples::decode(&bytes).unwrap();
    assert_eq!(read.rgba, traced);
    window.key(Modifiers::NONE, Key::Escape);

    // Another picture is another result.
    let other = text.replace("Coral", "SkyBlue");
    window.edit();
    window.key(Modifiers::COMMAND, Key::A);
    window.write(&other);
    let mut fresh = false;
    for _ in 0..1000 {
        window.finish();
        window.steps(5);
        open(&mut window, "small.png");
        window.harness.get_by_label("Save").click();
        window.steps(2);
        window.key(Modifiers::NONE, Key::Escape);
        let (_, bytes) = browser::last_download().expect("a file");
        fresh = document::examples::decode(&bytes).unwrap().rgba != traced;
        if fresh {
            break;
        }
    }
    assert!(fresh && window.image() != traced);

    window.load(&format!("nosave on\n{text}"));
    wait_for(&mut window, "convert");
    window.harness.get_by_label_contains("nosave is on");
}

#[test]
fn animations_are_played_in_the_large_view() {
    let mut window = Window::with_text(SCENE);
    drop_two(&mut window);
    window.edit();
    window.write("fli one.png two.png speed 50\nsplit fli.gif f.png\nplay fli.gif\n");
    wait_for(&mut window, "f001.png");
    // The played file is on the tray already.
    window.harness.get_by_label("Results 3");
    open(&mut window, "fli.gif");
    window.harness.get_by_label_contains("GIF, an animation");
    window.harness.get_by_label_contains("2 frames of 40×30");
    // It repeats for ever.
    window.steps(40);
    window.place("result");
    // It can be kept, and has a tab as a picture that was dropped.
    window.harness.get_by_label("Keep as a file").click();
    window.steps(3);
    window.key(Modifiers::NONE, Key::Escape);
    let tab = window.place("tab fli.gif").center();
    window.click(tab);
    window.harness.get_by_label_contains("40 × 30 pixels, ");
    assert!(window.place("asset image").width() > 30.0);
}

#[test]
fn a_mistake_in_the_text_leaves_the_results() {
    let mut window = Window::with_text(&format!("table 1 2 3\n{SCENE}"));
    wait_for(&mut window, "table.png");
    window.edit();
    window.write("sphree\n");
    assert_eq!(window.errors(), 1);
    window.steps(10);
    window.place("result table.png");
    window.load(&format!("sphree\ntable 1 2 3\n{SCENE}"));
    wait_for(&mut window, "table.png");
}

#[test]
fn on_a_phone_the_results_lie_between_the_picture_and_the_tabs() {
    let mut window = Window::open_with(390.0, 844.0, Parts::new());
    window.load(&format!(
        "table 1 4 9\nshow palette\nshow color Gold\nresize no.png 8 8\n{SCENE}"
    ));
    wait_for(&mut window, "colour.png");
    let (tray, picture) = (window.place("tray"), window.place("picture"));
    assert!(tray.top() >= picture.bottom() && tray.bottom() <= window.place("tab text").top());
    assert!(picture.height() > 150.0);
    assert!(window.place("editor").height() > 200.0);
    open(&mut window, "table.png");
    let dialog = window.place("dialog");
    assert!(dialog.width() <= 390.0 && dialog.contains_rect(window.place("result")));
    assert!(dialog.contains_rect(window.place("keep result")));
    window.harness.get_by_label("Next").click();
    window.steps(2);
    window.harness.get_by_label_contains("wrote palette.png");
}

#[test]
fn many_jobs_are_done_in_many_frames_and_not_all_results_are_held() {
    let jobs = "for i = 1 to 300 { show color Gold }";
    let mut window = Window::with_text(&format!("{jobs}\n{SCENE}"));
    assert_eq!(window.errors(), 0);
    let shows = |window: &Window, text: &str| window.harness.query_by_label(text).is_some();
    let in_between = (1..300).filter(|n| shows(&window, &format!("{n} of 300")));
    assert_eq!(in_between.count(), 1);
    for _ in 0..5000 {
        window.steps(1);
        if shows(&window, "44 could not be made") && shows(&window, "Results 256") {
            return;
        }
    }
    panic!("the jobs do not end");
}

#[test]
fn jobs_end_with_their_work() {
    let jobs = "for i = 1 to 300 { show color Gold }";
    let mut window = Window::with_text(&format!("{jobs}\n{SCENE}"));
    // Frames go by before they are done.
    wait_for(&mut window, "colour.png");
    window.load(&format!("table 1 2 3\n{SCENE}"));
    assert!(!has(&window, "result colour.png"), "at once");
    wait_for(&mut window, "table.png");
    window.steps(30);
    window.harness.get_by_label("Results 1");
    assert!(!has(&window, "result colour.png"));
    // Without jobs nothing is left of them.
    window.load(SCENE);
    window.steps(30);
    assert!(!has(&window, "tray"));
}
