//! Animated works: frames, playing, and saving a film.

use crate::driver::Window;
use egui_kittest::kittest::Queryable;

const TEXT: &str = "\
framesize 32 24
eyep 0 0 6
light White point, position 4 6 8
surface flesh, diffuse Coral, blobbiness -2
var x = 0
var x += 0.5
sphere flesh 0.5, x 0 0
";

#[test]
fn a_frame_can_be_chosen_and_the_film_saved() {
    let mut window = Window::with_text(TEXT);
    assert_eq!(window.errors(), 0);
    window.finish();
    let first = window.image();
    let slider = window.place("slider frame");
    window.click(slider.center());
    window.finish();
    assert_ne!(window.image(), first, "another frame is another picture");
    assert_eq!(window.text(), TEXT, "frames do not change the text");

    window.click(slider.left_center());
    window.finish();
    assert_eq!(window.image(), first);

    // A film of the fewest frames: the field takes a number.
    window.harness.get_by_label("Number of frames").click();
    window.steps(2);
    for _ in 0..2 {
        window.key(egui::Modifiers::NONE, egui::Key::Backspace);
    }
    window.write("3");
    window.key(egui::Modifiers::NONE, egui::Key::Enter);
    let (name, bytes) = save(&mut window, "png");
    assert_eq!(name, "Main-film.png");
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    assert_eq!(reader.info().animation_control().unwrap().num_frames, 3);
    let mut frames = Vec::new();
    for _ in 0..3 {
        let mut rgba = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut rgba).unwrap();
        frames.push(rgba);
    }
    let opaque: Vec<u8> = first.chunks(4).flat_map(|p| p[..3].to_vec()).collect();
    assert!(frames[0] == opaque && frames[1] != frames[2]);
    window.harness.get_by_label_contains("Saved Main-film.png");

    // There and back, as a video.
    let playback = window.place("playback").center();
    window.click(playback);
    window.harness.get_by_label("There and back").click();
    window.steps(2);
    let (name, bytes) = save(&mut window, "webm");
    assert_eq!(name, "Main-film.webm");
    let frames = bytes.windows(4).filter(|four| four == b"\x89PNG").count();
    assert_eq!(frames, 4, "0 1 2 1");
    window.harness.get_by_label_contains("Saved Main-film.webm");
    window.finish();
    assert!(
        window.image() == first,
        "the frame from before is on show again"
    );
}

/// Saves the film in a format. Returns the file's name and content.
fn save(window: &mut Window, format: &str) -> (String, Vec<u8>) {
    let menu = window.place("save film").center();
    window.click(menu);
    let choice = window.place(&format!("download {format}")).center();
    window.click(choice);
    for _ in 0..2000 {
        window.steps(1);
        if let Some(file) = browser::last_download() {
            return file;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("no film");
}

#[test]
fn playing_goes_through_the_frames_and_editing_stops_a_film() {
    let mut window = Window::with_text(TEXT);
    window.finish();
    let play = window.place("play").center();
    window.click(play);
    let mut seen = std::collections::BTreeSet::new();
    for _ in 0..400 {
        window.steps(1);
        for frame in 0..24 {
            if window
                .harness
                .query_by_label(&format!("frame {frame} of"))
                .is_some()
            {
                seen.insert(frame);
            }
        }
        if seen.len() >= 3 {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(seen.len() >= 3, "{seen:?}");
    window.click(play);

    let menu = window.place("save film").center();
    window.click(menu);
    let choice = window.place("download gif").center();
    window.click(choice);
    let words = window.harness.get_by_label_contains("Frame 1 of 24");
    assert!(words.rect().is_positive());
    window.harness.get_by_label("Stop");
    window.edit();
    window.write("# edited\n");
    window
        .harness
        .get_by_label_contains("The film was not saved");
    assert_eq!(browser::last_download(), None);
}

#[test]
fn a_film_can_be_stopped_on_a_phone() {
    let mut window = Window::open(390.0, 844.0);
    window.load(TEXT);
    window.finish();
    let settings = window.place("film settings").center();
    window.click(settings);
    let once = window.place("playback Once").center();
    window.click(once);
    window.key(egui::Modifiers::NONE, egui::Key::Escape);
    let menu = window.place("save film").center();
    window.click(menu);
    let choice = window.place("download gif").center();
    window.click(choice);
    let stop = window.place("stop film").center();
    window.click(stop);
    window
        .harness
        .get_by_label_contains("You stopped it. The film was not saved");
    assert_eq!(browser::last_download(), None);
    window.place("slider frame");
}

#[test]
fn a_film_ends_with_its_work() {
    let mut window = Window::with_text(TEXT);
    window.finish();
    let slider = window.place("slider frame");
    window.click(slider.center());
    let menu = window.place("save film").center();
    window.click(menu);
    let choice = window.place("download gif").center();
    window.click(choice);
    window.harness.get_by_label_contains("of 24");
    let other = TEXT.replace("Coral", "SkyBlue");
    window.load(&other);
    window.finish();
    window.steps(20);
    assert_eq!(browser::last_download(), None);
    assert_eq!(window.text(), other);
    // Nothing of the old film is left: neither its frame nor that it is being saved.
    assert_eq!(window.parts.outbox.borrow().report.frame, Some(0));
    window.place("save film");
}
