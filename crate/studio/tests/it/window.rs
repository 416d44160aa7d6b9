//! The window, driven as a user drives it, by keys and pointer.

use crate::driver::Window;
use browser::Backend;
use document::share;
use egui::{Event, Key, Modifiers, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use rats::{File, Project};
use std::cell::RefCell;
use std::rc::Rc;
use studio::app::App;
use studio::page::Parts;
use studio::places;
use studio::scripts::request::Request;
use studio::wish::{Dialog, Wish};

const TEXT: &str = "\
framesize 64 48
eyep 0 0 6
light White point, position 4 6 8
surface flesh, diffuse Coral, blobbiness -2
var size = 0.5 hot
sphere flesh size, 0 0 0
";

/// A frame that takes two seconds comes between press and release: still a click. Two frames are a
/// hand that stays.
#[test]
fn clicks_are_taken_when_frames_are_late() {
    let mut window = Window::with_text(TEXT);
    let at = window.place("download").center();
    for frames in [2, 1] {
        window.harness.event(Event::PointerMoved(at));
        window.steps(1);
        window.press(at, true);
        window.steps(frames);
        let now = window.harness.ctx.input(|input| input.time);
        window.harness.input_mut().time = Some(now + 2.0);
        window.press(at, false);
        window.steps(2);
        let is_open = places::all(&window.harness.ctx).contains_key("download mesh");
        assert_eq!(is_open, frames == 1);
    }
}

#[test]
fn typing_edits_and_an_error_is_listed_while_the_picture_stays() {
    let mut window = Window::with_text(TEXT);
    window.finish();
    let picture = window.image();
    assert!(!picture.is_empty());

    window.edit();
    let editor = window.place("editor");
    window.write("backgrund");
    assert_eq!(window.errors(), 1);
    assert!(
        window
            .harness
            .query_by_label_contains("Problem at")
            .is_none(),
        "it is being typed"
    );
    window.write(" 1 0 0\n");
    assert!(window.text().starts_with("backgrund 1 0 0\n"));
    assert_eq!(window.errors(), 1);
    window.steps(10);
    assert_eq!(window.image(), picture, "the old picture stays");
    window.place("old picture");
    assert_eq!(window.place("editor"), editor, "nothing moves");
    assert!(window.place("problems").height() > 20.0);

    // A click on the problem selects its place, which typing replaces.
    window
        .harness
        .get_by_label_contains("Problem at 1:1")
        .click();
    window.steps(3);
    window.write("background");
    assert!(
        window.text().starts_with("background 1 0 0\n"),
        "{}",
        window.text()
    );
    assert_eq!(window.errors(), 0);
    window.finish();
    assert_ne!(window.image(), picture);
}

#[test]
fn a_drag_on_a_slider_rewrites_its_number_and_is_one_undo_step() {
    let mut window = Window::with_text(TEXT);
    let slider = window.place("slider size");
    let at = |share: f32| pos2(slider.left() + slider.width() * share, slider.center().y);
    window.drag(at(0.25), at(0.75));
    let dragged = window.text();
    let value: f64 = dragged
        .split("size = ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next())
        .unwrap()
        .parse()
        .unwrap();
    assert!((1.3..1.7).contains(&value), "{dragged}");
    assert_eq!(window.errors(), 0);
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.text(), TEXT);
    window.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(window.text(), dragged);
}

#[test]
fn keys_stay_in_order_when_they_come_at_once() {
    let mut window = Window::with_text("\n");
    window.edit();
    for (line, text) in ["for i = 1 to 3 {", "# a", "# b"].into_iter().enumerate() {
        if line > 0 {
            window.harness.key_press(Key::Enter);
        }
        window.harness.event(Event::Text(text.to_owned()));
    }
    window.steps(6);
    assert_eq!(window.text(), "for i = 1 to 3 {\n  # a\n  # b\n");
}

#[test]
fn turning_the_picture_keeps_its_camera_while_the_text_changes() {
    let mut window = Window::with_text(TEXT);
    window.finish();
    let picture = window.place("picture");
    window.drag(picture.center(), picture.center() + vec2(60.0, 20.0));
    let chosen = window.parts.outbox.borrow().chosen.expect("turned");
    assert_ne!(chosen.eye.x, 0.0);
    window.edit();
    window.write("eyep 5 5 5\n");
    assert_eq!(window.parts.outbox.borrow().camera, chosen);
    window.finish();
    let reset = window.place("reset view").center();
    window.click(reset);
    window.steps(1);
    // The later eyep of the text counts.
    assert_eq!(window.parts.outbox.borrow().chosen, None);
    assert_eq!(window.parts.outbox.borrow().camera.eye.z, 6.0);
}

#[test]
fn a_click_counts_though_the_first_picture_comes_meanwhile() {
    let parts = Parts::new();
    let mut mine = Window::open_with(1000.0, 700.0, parts.clone());
    mine.load(TEXT);
    mine.edit();
    mine.write("# mine\n");
    mine.steps(20);
    drop(mine);

    // A picture that takes longer than the window takes to open.
    let spheres = "for i = 1 to 400 { sphere flesh 0.1, sin(i) cos(2 * i) sin(3 * i) }\n";
    let theirs = Project {
        files: vec![File {
            name: String::from("shell.rat"),
            text: TEXT.replace("64 48", "640 480") + spheres,
        }],
    };
    let link = share::link("https://sinew.example/", &theirs, None).unwrap();
    browser::set_hash(&link[link.find('#').unwrap()..]);
    let mut window = Window::open_with(1000.0, 700.0, parts);
    let button = window.harness.get_by_label("Back to my work");
    let at = button.rect().center();
    window.harness.event(Event::PointerMoved(at));
    window.steps(1);
    window.press(at, true);
    window.steps(1);
    assert!(window.image().is_empty(), "the picture is not there yet");
    window.arrive();
    window.press(at, false);
    window.steps(2);
    assert!(window.text().starts_with("# mine\n"), "{}", window.text());
    browser::set_hash("");
}

#[test]
fn a_shared_link_leaves_the_users_work_alone() {
    let parts = Parts::new();
    let mut mine = Window::open_with(1000.0, 700.0, parts.clone());
    mine.load(TEXT);
    mine.edit();
    mine.write("# mine\n");
    mine.steps(20);
    drop(mine);

    let theirs = Project {
        files: vec![File {
            name: String::from("shell.rat"),
            text: String::from("# theirs\n"),
        }],
    };
    let link = share::link("https://sinew.example/", &theirs, None).unwrap();
    browser::set_hash(&link[link.find('#').unwrap()..]);
    let mut window = Window::open_with(1000.0, 700.0, parts.clone());
    assert_eq!(window.text(), "# theirs\n");
    assert!(window.place("notice").width() > 100.0);
    window.harness.get_by_label("Back to my work").click();
    window.steps(3);
    let text = window.text();
    assert!(text.starts_with("# mine\n"), "{text}");
    assert_eq!(browser::hash(), "");

    // A damaged link says so and changes nothing.
    browser::set_hash("#rubbish");
    window.parts.requests.ask(Request::HashChanged);
    window.steps(3);
    assert!(window.text().starts_with("# mine\n"));
    assert!(window.place("notice").width() > 100.0);
    browser::set_hash("");
    drop(window);

    // A link that is edited becomes a work of its own.
    browser::set_hash(&link[link.find('#').unwrap()..]);
    let mut window = Window::open_with(1000.0, 700.0, parts.clone());
    window.edit();
    window.write("# ours\n");
    window.steps(20);
    let names: Vec<String> = parts
        .shelf
        .borrow()
        .entries()
        .into_iter()
        .map(|entry| entry.name)
        .collect();
    assert_eq!(names.len(), 2, "{names:?}");
    assert_eq!(
        browser::hash(),
        "",
        "the address does not carry another work"
    );
}

#[test]
fn share_copies_a_link_that_opens_the_same_text() {
    let mut window = Window::with_text(TEXT);
    let share = window.place("share").center();
    window.harness.event(Event::PointerMoved(share));
    window.steps(1);
    window.press(share, true);
    window.steps(1);
    window.press(share, false);
    window.steps(1);
    let copied = window
        .harness
        .output()
        .platform_output
        .commands
        .iter()
        .find_map(|command| match command {
            egui::OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        })
        .expect("copied");
    assert!(copied.ends_with(&browser::hash()));
    let shared = share::open(&browser::hash()).unwrap().unwrap();
    assert_eq!(shared.project.files[0].text, TEXT);
    browser::set_hash("");
}

#[test]
fn the_picture_can_be_saved() {
    let mut window = Window::with_text(TEXT);
    window.finish();
    window.key(Modifiers::COMMAND, Key::S);
    let (name, bytes) = browser::last_download().expect("a file");
    assert_eq!(name, "Main.png");
    assert!(bytes.starts_with(b"\x89PNG"));
}

#[test]
fn the_gallery_opens_examples() {
    let mut window = Window::with_text(TEXT);
    let examples = window.place("examples").center();
    window.click(examples);
    window.steps(3);
    window
        .harness
        .get_by_label("Open T-shape")
        .click_accesskit();
    window.steps(3);
    assert!(window.text().contains("object TEE"));
}

#[test]
fn the_gallery_shows_the_examples_that_are_searched_for() {
    let mut window = Window::with_text(TEXT);
    let examples = window.place("examples").center();
    window.click(examples);
    window.steps(3);
    let field = window.place("search examples").center();
    window.click(field);
    window.write("BARS melt");
    window.steps(3);
    assert!(window.harness.query_by_label("Open Cowrie").is_none());
    assert!(window.harness.query_by_label("Open T-shape").is_some());
}

#[test]
fn too_long_a_paste_is_refused_in_words() {
    let mut window = Window::with_text(TEXT);
    window.edit();
    window.harness.event(Event::Paste("# x\n".repeat(80_000)));
    window.steps(3);
    assert_eq!(window.text(), TEXT);
    assert!(window.place("notice").width() > 100.0);
    window.write("# y\n");
    assert_eq!(window.text(), format!("# y\n{TEXT}"));
}

#[test]
fn after_a_bad_start_nothing_is_drawn_until_the_user_says_so() {
    let parts = Parts::new();
    browser::set_stopped(true);
    let inner = parts.clone();
    let mut harness = Harness::builder()
        .with_size(vec2(1000.0, 700.0))
        .build_ui_state(
            move |ui, app: &mut Option<App>| {
                let app = app
                    .get_or_insert_with(|| App::new(ui.ctx(), None, Backend::None, inner.clone()));
                app.tick(ui.ctx());
                app.show(ui);
            },
            None,
        );
    harness.run_steps(5);
    assert_eq!(parts.outbox.borrow().report.phase, "idle");
    harness.get_by_label("Draw").click();
    harness.run_steps(5);
    assert_ne!(parts.outbox.borrow().report.phase, "idle");
    browser::set_stopped(false);
}

/// Returns all texts that are painted.
fn texts_of(window: &Window) -> String {
    let mut texts = String::new();
    for clipped in &window.harness.output().shapes {
        if let egui::Shape::Text(text) = &clipped.shape {
            texts += text.galley.text();
            texts.push('\n');
        }
    }
    texts
}

#[test]
fn windows_over_the_page_are_within_the_smallest_phone() {
    let mut window = Window::open(320.0, 568.0);
    window.load(TEXT);
    for dialog in [Dialog::Help, Dialog::Gallery, Dialog::Versions] {
        let wish = Wish::Open(dialog);
        window.parts.requests.ask(Request::Wish(wish));
        window.steps(6);
        let place = window.place("dialog");
        let screen = window.harness.ctx.content_rect();
        assert!(screen.contains_rect(place), "{dialog:?} {place:?}");
    }
}

#[test]
fn the_hint_on_the_picture_speaks_of_what_one_has() {
    for (width, height, words, other) in [
        (1000.0, 700.0, "shift-drag", "two fingers"),
        (390.0, 844.0, "two fingers", "shift-drag"),
        (320.0, 568.0, "two fingers", "scroll"),
    ] {
        let mut window = Window::open(width, height);
        window.load(TEXT);
        assert!(!texts_of(&window).contains(words));
        let picture = window.place("picture");
        window.harness.event(Event::PointerMoved(picture.center()));
        window.steps(2);
        let painted = texts_of(&window);
        assert!(painted.contains(words), "{painted}");
        assert!(!painted.contains(other), "{painted}");
    }
}

/// Checks that parts of the page are on the screen and do not overlap.
fn check_layout(window: &Window, names: &[&str]) {
    let screen = window.harness.ctx.content_rect();
    for (index, name) in names.iter().enumerate() {
        let place = window.place(name);
        assert!(
            screen.expand(0.5).contains_rect(place),
            "{name} {place:?} leaves {screen:?}"
        );
        assert!(
            place.width() > 0.0 && place.height() > 0.0,
            "{name} is empty"
        );
        for other in &names[index + 1..] {
            let common = place.shrink(0.5).intersect(window.place(other).shrink(0.5));
            assert!(
                !common.is_positive(),
                "{name} and {other} overlap: {common:?}"
            );
        }
    }
}

#[test]
fn nothing_overlaps_on_a_phone_or_a_desk() {
    let phones = [(390.0, 844.0), (360.0, 560.0), (390.0, 460.0)];
    let low = [
        (720.0, 450.0),
        (600.0, 400.0),
        (844.0, 390.0),
        (320.0, 568.0),
    ];
    for (width, height) in phones.into_iter().chain(low) {
        let mut window = Window::open(width, height);
        window.load(TEXT);
        for tab in ["text", "sliders", "problems"] {
            let at = window.place(&format!("tab {tab}")).center();
            window.click(at);
            let mut names = vec!["share", "examples", "undo", "more", "picture", "status"];
            if width >= 350.0 {
                names.push("lab");
            }
            names.extend(["tab text", "tab sliders", "tab problems"]);
            if tab == "text" {
                names.push("editor");
            }
            check_layout(&window, &names);
            for name in ["share", "examples", "undo", "tab text"] {
                // A low window that is wide is on a desk.
                assert!(
                    width >= 700.0 || window.place(name).height() >= 38.0,
                    "{name} is too small for a thumb"
                );
            }
        }
    }
    for (width, height) in [(1440.0, 900.0), (1024.0, 600.0), (720.0, 480.0)] {
        let mut window = Window::open(width, height);
        window.load(&format!("sphree\n{TEXT}"));
        let names = [
            "work", "share", "examples", "lab", "undo", "picture", "editor", "sliders", "problems",
            "status",
        ];
        check_layout(&window, &names);
    }
}

#[test]
fn every_widget_has_a_name() {
    for (width, height) in [(1200.0, 800.0), (390.0, 844.0)] {
        let mut window = Window::open(width, height);
        window.load(TEXT);
        window.finish();
        // Runs until nothing moves; then egui_kittest checks the names for screen readers.
        window.harness.run();
    }
}

#[test]
fn a_problem_leads_to_the_manual_and_its_example_opens() {
    let mut window = Window::with_text(&format!("{TEXT}sphere flesh\n"));
    assert_eq!(window.errors(), 1);
    window.harness.get_by_label("manual: sphere").click();
    window.steps(20);
    assert!(window.place("search commands").width() > 100.0);
    window.harness.get_by_label("Try it").click();
    window.steps(3);
    assert_eq!(
        window.text(),
        rats::commands::find("sphere").unwrap().example
    );
    assert_eq!(window.errors(), 0);
}

#[test]
fn a_related_place_can_be_clicked() {
    let mut window = Window::with_text(&format!("{TEXT}object a\nclose b\n"));
    let related = window
        .parts
        .outbox
        .borrow()
        .report
        .diagnostics
        .iter()
        .find_map(|diagnostic| diagnostic.related.first().cloned());
    let related = related.expect("where the object begins");
    let label = format!("{}:{} {}", related.line, related.column, related.message);
    window.harness.get_by_label(&label).click();
    window.steps(3);
    window.write("#");
    let at = related.span.start;
    assert_eq!(&window.text()[at..=at], "#");
}

/// Asks for the finished picture. Returns a cell that holds the answer once there is one.
fn ask_finished(parts: &Parts) -> Rc<RefCell<Option<Result<(), String>>>> {
    let answer = Rc::new(RefCell::new(None));
    let inner = answer.clone();
    parts
        .requests
        .ask(Request::Finished(Box::new(move |result| {
            inner.replace(Some(result));
        })));
    answer
}

#[test]
fn scripts_wait_for_the_picture_and_are_refused_while_the_lab_keeps_it_waiting() {
    let mut window = Window::with_text(TEXT);
    let early = ask_finished(&window.parts);
    window.finish();
    window.steps(1);
    assert_eq!(early.take(), Some(Ok(())));
    // A finished picture stays finished in the lab.
    let lab = window.place("lab").center();
    window.click(lab);
    window.steps(2);
    assert!(window.parts.outbox.borrow().lab.is_some());
    let done = ask_finished(&window.parts);
    window.steps(2);
    assert_eq!(done.take(), Some(Ok(())));
    // A picture that must be drawn anew waits, and the script is refused at once.
    let camera = scene::Camera {
        eye: [3.0, 0.0, 5.0].into(),
        ..window.parts.outbox.borrow().camera
    };
    window.parts.requests.ask(Request::SetCamera(Some(camera)));
    let refused = ask_finished(&window.parts);
    window.steps(3);
    let reason = refused.take().expect("an answer").unwrap_err();
    assert!(reason.contains("lab"), "{reason}");
    // Outside the lab it is answered again.
    let back = window.place("lab back").center();
    window.click(back);
    let again = ask_finished(&window.parts);
    window.finish();
    window.steps(1);
    assert_eq!(again.take(), Some(Ok(())));
}

#[test]
fn mesh_is_read_apart_while_the_picture_stays() {
    let mut window = Window::with_text(TEXT);
    window.finish();
    let picture = window.image();
    let mut mesh = String::from("v -1 -1 0\nv 1 -1 0\nv 0 1 0\n");
    // So large that it is not read within a frame.
    mesh += &"# a comment that makes the file large\n".repeat(100_000);
    mesh.push_str("f 1 2 3\n");
    let text = TEXT.replace("sphere flesh size, 0 0 0", "mesh flesh big.obj");
    let files = [("big.obj", mesh), ("main.rat", text)];
    let files = files.map(|(name, text)| document::intake::Incoming {
        name: name.to_owned(),
        bytes: Ok(text.into_bytes()),
    });
    window.parts.requests.ask(Request::Files(files.to_vec()));
    window.steps(1);
    {
        let outbox = window.parts.outbox.borrow();
        assert_eq!(outbox.report.reading.as_deref(), Some("big.obj"));
        assert_eq!(outbox.report.errors, 0);
    }
    let finished = ask_finished(&window.parts);
    for _ in 0..2000 {
        window.steps(1);
        if finished.borrow().is_some() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert_eq!(finished.take(), Some(Ok(())));
    assert_eq!(window.parts.outbox.borrow().report.reading, None);
    assert_eq!(window.errors(), 0);
    assert_ne!(window.image(), picture);
}
