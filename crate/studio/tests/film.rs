//! Animated works: frames, playing, and saving a film.

mod driver;

use driver::Window;
use egui_kittest::kittest::Queryable;
use studio::platform;

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
    let save = window.place("save film").center();
    window.click(save);
    let mut file = None;
    for _ in 0..2000 {
        window.steps(1);
        file = platform::downloaded();
        if file.is_some() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let (name, bytes) = file.expect("a film");
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
    assert_eq!(frames[0], first);
    assert_ne!(frames[1], frames[2]);
    window.harness.get_by_label_contains("Saved Main-film.png");
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

    let save = window.place("save film").center();
    window.click(save);
    window.harness.get_by_label("Stop");
    window.edit();
    window.write("# edited\n");
    window
        .harness
        .get_by_label_contains("The film was not saved");
    assert_eq!(platform::downloaded(), None);
}
