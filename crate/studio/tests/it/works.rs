//! Results that come late, for a work that is not open any more, are left out.

use crate::driver::Window;
use browser::{choose_files, hold_back, let_come};
use document::examples::{self, Example};
use document::intake::Incoming;
use egui::vec2;
use egui_kittest::kittest::Queryable;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use studio::places;
use studio::scripts::request::{Request, Told};
use studio::wish::{Dialog, FitWish, SculptWish, Wish, WorkWish};

const TEXT: &str = "\
framesize 32 24
eyep 0 0 6
surface flesh, diffuse Coral, blobbiness -2
sphere flesh 0.5, 0 0 0
";
const OTHER: &str = "\
framesize 32 24
eyep 0 0 6
surface flesh, diffuse SkyBlue, blobbiness -2
sphere flesh 0.3, 0 0 0
sphere flesh 0.3, 1 0 0
";
const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

fn ask(window: &mut Window, wish: impl Into<Wish>) {
    window.parts.requests.ask(Request::Wish(wish.into()));
    window.steps(2);
}

/// Runs until something is so.
fn until(window: &mut Window, what: &str, is_so: impl Fn(&Window) -> bool) {
    for _ in 0..4000 {
        if is_so(window) {
            return;
        }
        window.steps(1);
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("{what}: {:?}", window.parts.outbox.borrow().report);
}

fn is_told(window: &Window, words: &str) -> bool {
    window.harness.query_by_label_contains(words).is_some()
}

/// Checks that the other work is open, as it was, and that the user is told what was left out.
fn check_other(window: &Window, what: &str) {
    assert!(is_told(
        window,
        &format!("{what} came after another work was opened")
    ));
    let outbox = window.parts.outbox.borrow();
    let files = &outbox.project.files;
    assert_eq!((files.len(), files[0].text.as_str()), (1, OTHER));
    assert_eq!(outbox.report.assets, Vec::<String>::new());
}

/// Returns the examples whose texts are fetched.
fn examples_to_fetch() -> Vec<(usize, &'static Example)> {
    let all = examples::ALL.iter().enumerate();
    all.filter(|(_, example)| example.text.is_none()).collect()
}

#[test]
fn example_that_comes_late_is_left_out() {
    let mut window = Window::with_text(TEXT);
    let [(first, one), (second, two), ..] = examples_to_fetch()[..] else {
        panic!("there are examples to fetch");
    };
    hold_back();
    ask(&mut window, WorkWish::OpenExample(first));
    assert_eq!(window.text(), TEXT, "it is not here yet");
    window.load(OTHER);
    let_come();
    window.steps(3);
    check_other(&window, &format!("The example {}", one.title));

    // Of two that were asked for one after the other the last one is opened.
    hold_back();
    ask(&mut window, WorkWish::OpenExample(first));
    ask(&mut window, WorkWish::OpenExample(second));
    let_come();
    window.steps(3);
    assert_eq!(window.parts.outbox.borrow().report.name, two.title);
    assert!(!is_told(&window, "came after"));
}

/// A file that is dropped on the window.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }
    fn bytes(&self) -> Result<Vec<u8>, String> {
        Ok(OBJ.into())
    }
}

#[test]
fn files_that_are_read_late_are_left_out() {
    let mut window = Window::with_text(TEXT);
    hold_back();
    let input = window.harness.input_mut();
    let file = Dropped(PathBuf::from("late.obj"));
    input.dropped_files.push(Arc::new(file));
    window.steps(2);
    window.load(OTHER);
    let_come();
    window.steps(3);
    check_other(&window, "The file late.obj");

    choose_files(vec![Incoming {
        name: String::from("chosen.obj"),
        bytes: Ok(OBJ.into()),
    }]);
    hold_back();
    ask(&mut window, WorkWish::PickFiles);
    window.load(OTHER);
    let_come();
    window.steps(3);
    check_other(&window, "The file chosen.obj");
    assert!(browser::was_asked_for_files());
}

#[test]
fn mesh_to_be_sculpted_opens_in_its_work_only() {
    let mut window = Window::with_text(TEXT);
    window.steps(3);
    ask(&mut window, SculptWish::Model(10_000));
    window.load(OTHER);
    until(&mut window, "the mesh", |window| {
        is_told(window, "came after another work")
    });
    check_other(&window, "The mesh to be sculpted");
    assert!(window.parts.outbox.borrow().sculpture.is_none());

    // In its own work it replaces the texts, and is opened as soon as its file is read.
    ask(&mut window, SculptWish::Model(10_000));
    until(&mut window, "the sculpture", |window| {
        window.parts.outbox.borrow().sculpture.is_some()
    });
    let outbox = window.parts.outbox.borrow();
    assert_eq!(outbox.report.assets, ["model.ply"]);
    assert_eq!(outbox.project.files[1].name, "sculpture.strokes");
    assert_eq!(outbox.report.errors, 0, "{:?}", outbox.report.diagnostics);
}

#[test]
fn mesh_of_the_dialog_is_that_of_the_open_work() {
    let mut window = Window::with_text(TEXT);
    window.steps(3);
    ask(&mut window, Wish::Open(Dialog::Mesh));
    fn triangles(window: &Window) -> Option<usize> {
        let outbox = window.parts.outbox.borrow();
        outbox.report.mesh.as_ref().and_then(|mesh| mesh.triangles)
    }
    until(&mut window, "a mesh", |window| triangles(window).is_some());
    window.load(OTHER);
    assert!(
        window.parts.outbox.borrow().report.mesh.is_none(),
        "the dialog is shut"
    );
    window
        .parts
        .requests
        .ask(Request::Wish(Wish::Open(Dialog::Mesh)));
    window.steps(1);
    let shown = window
        .parts
        .outbox
        .borrow()
        .report
        .mesh
        .as_ref()
        .map(|mesh| mesh.shown);
    assert_eq!(shown, None, "nothing of the work before");
    until(&mut window, "the other mesh", |window| {
        triangles(window).is_some()
    });
}

#[test]
fn fit_ends_with_its_work() {
    let mesh = "surface s, diffuse Red\nmesh s a.obj\n";
    let mut window = Window::with_text(mesh);
    // So many that the fit takes longer than a few frames.
    let count = 20_000;
    let points: String = (0..count)
        .map(|i| i as f64 * 0.37)
        .map(|t| {
            format!(
                "{} {} {}\n",
                0.4 * libm::cos(t),
                0.4 * libm::sin(t),
                0.01 * t
            )
        })
        .collect();
    let files = [("a.obj", OBJ), ("a.xyz", &points)].map(|(name, text)| Incoming {
        name: name.to_owned(),
        bytes: Ok(text.into()),
    });
    window.parts.requests.ask(Request::Files(files.to_vec()));
    until(&mut window, "points and mesh", |window| {
        let outbox = window.parts.outbox.borrow();
        let points = outbox.report.fit.as_ref().map(|fit| fit.points);
        points == Some(count) && outbox.report.elements == 4
    });
    ask(&mut window, FitWish::Start);
    fn is_running(window: &Window) -> bool {
        let outbox = window.parts.outbox.borrow();
        outbox.report.fit.as_ref().is_some_and(|fit| fit.running)
    }
    assert!(
        is_running(&window),
        "{:?}",
        window.parts.outbox.borrow().report.fit
    );
    window.load(mesh);
    assert!(!is_running(&window));
    for _ in 0..50 {
        window.steps(1);
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert_eq!(window.text(), mesh);
}

/// Lets the storage tell something.
fn tell(window: &mut Window, told: Told) {
    window.parts.requests.ask(Request::Storage(told));
    window.steps(3);
}

#[test]
fn work_of_another_tab_is_copied_or_taken_over() {
    let mut window = Window::with_text(TEXT);
    window.edit();
    window.write("# mine\n");
    window.steps(20);
    let id = browser::last_claim().expect("an own work is claimed");
    tell(&mut window, Told::Theirs(String::from("another")));
    assert!(!window.parts.outbox.borrow().report.theirs);
    tell(&mut window, Told::Theirs(id.clone()));
    assert!(window.parts.outbox.borrow().report.theirs);
    assert!(is_told(&window, "Another tab writes"));
    window.harness.get_by_label("Take over").click();
    window.steps(2);
    assert_eq!(browser::last_takeover(), Some(id.clone()));
    tell(&mut window, Told::Mine(id.clone()));
    assert!(!window.parts.outbox.borrow().report.theirs);

    tell(&mut window, Told::Theirs(id.clone()));
    window.edit();
    window.write("# yours\n");
    window.steps(20);
    assert!(window.parts.outbox.borrow().report.name.ends_with(" copy"));
    assert!(is_told(&window, "is a copy"));
    let copy = browser::last_claim().expect("the copy is claimed");
    assert_ne!(copy, id);
    tell(&mut window, Told::Theirs(copy.clone()));
    window.harness.get_by_label("Make a copy").click();
    window.steps(3);
    assert!(
        window
            .parts
            .outbox
            .borrow()
            .report
            .name
            .ends_with(" copy copy")
    );
    ask(&mut window, WorkWish::OpenSaved(id));
    window.steps(3);
    assert!(window.text().starts_with("# mine\n"), "{}", window.text());
    tell(&mut window, Told::Refused(String::from("It is full.")));
    assert!(is_told(&window, "It is full."));
}

#[test]
fn a_version_is_brought_back_as_a_step() {
    let mut window = Window::with_text(TEXT);
    window.edit();
    window.write("# mine\n");
    window.steps(20);
    ask(&mut window, Wish::Open(Dialog::Versions));
    window.harness.get_by_label("Bring back").click();
    window.steps(3);
    assert_eq!(window.text(), TEXT);
    window.harness.get_by_label("Undo").click();
    window.steps(3);
    assert!(window.text().starts_with("# mine\n"));
}

#[test]
fn very_many_shapes_are_not_traced_before_the_user_says_so() {
    let mut window = Window::with_text(TEXT);
    window.finish();
    let heavy = format!("{TEXT}for i = 1 to 20000 {{ sphere flesh 0.5, 0 0 0 }}\n");
    window.load(&heavy);
    window.steps(5);
    assert!(is_told(&window, "The picture was not begun"));
    assert_eq!(window.parts.outbox.borrow().report.phase, "cancelled");
    window.harness.get_by_label("Trace all the same").click();
    window.steps(3);
    assert_eq!(window.parts.outbox.borrow().report.phase, "tracing");
    assert!(!is_told(&window, "The picture was not begun"));
}

/// Five steps lead to a shape; each is written by a button, and by hand as well.
#[test]
fn the_first_shape_is_made_in_five_steps() {
    for size in [
        [1200.0, 760.0],
        [390.0, 844.0],
        [320.0, 568.0],
        [720.0, 450.0],
    ] {
        let mut window = Window::open(size[0], size[1]);
        window
            .parts
            .requests
            .ask(Request::Wish(WorkWish::First.into()));
        window.steps(3);
        for step in 0..4 {
            let card = window.place("first shape");
            let editor = window.place("editor");
            assert!(editor.height() > 60.0, "{size:?} {card:?}");
            assert!(
                card.bottom() <= editor.top() + 1.0,
                "{size:?} {card:?} {editor:?}"
            );
            window.harness.get_by_label("Write it").click();
            window.steps(3);
            assert!(
                window.harness.query_by_label("Write it").is_none(),
                "{step}"
            );
            window.harness.get_by_label("Next").click();
            window.steps(3);
        }
        let picture = window.place("picture");
        window.drag(picture.center(), picture.center() + vec2(40.0, 0.0));
        window.harness.get_by_label("Finish").click();
        window.steps(3);
        assert!(!places::all(&window.harness.ctx).contains_key("first shape"));
        assert_eq!(window.errors(), 0);
        assert!(window.text().contains("for i = 0 to 3"));
    }
}

#[test]
fn the_first_shape_is_offered_and_skipped() {
    let mut window = Window::open(1200.0, 760.0);
    let examples = window.place("examples").center();
    window.click(examples);
    window.steps(3);
    let offer = window.place("offer first shape").center();
    window.click(offer);
    window.steps(3);
    window.place("first shape");
    window.harness.get_by_label("Skip").click();
    window.steps(3);
    assert!(!places::all(&window.harness.ctx).contains_key("first shape"));
    // Another work has no card, though the step was not left.
    window
        .parts
        .requests
        .ask(Request::Wish(WorkWish::First.into()));
    window.steps(3);
    window.place("first shape");
    window
        .parts
        .requests
        .ask(Request::Wish(WorkWish::New.into()));
    window.steps(3);
    assert!(!places::all(&window.harness.ctx).contains_key("first shape"));
    // An address leads there, too.
    browser::set_hash("#first");
    window.parts.requests.ask(Request::HashChanged);
    window.steps(3);
    window.place("first shape");
    browser::set_hash("");
}

fn open_example(window: &mut Window, name: &str) {
    let index = examples::find(name).unwrap();
    ask(window, WorkWish::OpenExample(index));
    window.steps(2);
}

fn stand_in_of(window: &Window) -> Option<&'static str> {
    window.parts.outbox.borrow().report.stand_in
}

/// A slow example shows what was drawn when it was made, until its own picture comes or it is
/// changed.
#[test]
fn slow_examples_are_shown_as_made_before() {
    let mut window = Window::open(1000.0, 700.0);
    open_example(&mut window, "tshape");
    assert_ne!(stand_in_of(&window), Some("made before"));
    open_example(&mut window, "still-life");
    assert_eq!(stand_in_of(&window), Some("made before"));
    window.place("made before");
    window.edit();
    window.write("# mine\n");
    window.steps(1);
    assert_ne!(stand_in_of(&window), Some("made before"));
    open_example(&mut window, "still-life");
    assert_eq!(stand_in_of(&window), Some("made before"));
    window
        .parts
        .requests
        .ask(Request::PictureSize(Some([8, 6])));
    for _ in 0..400 {
        std::thread::sleep(std::time::Duration::from_millis(50));
        window.steps(1);
        if stand_in_of(&window).is_none() {
            assert!(!window.image().is_empty());
            return;
        }
    }
    panic!("the true picture never came");
}
