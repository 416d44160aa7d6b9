//! The lab, driven as a user drives it: its links, its lessons, and the work that it leaves alone.

use crate::driver::Window;
use egui::{Event, Key, Modifiers, Theme, pos2, vec2};
use egui_kittest::kittest::Queryable;
use lab::{Lesson, Report};
use rats::{File, Project};
use studio::page::Parts;
use studio::scripts::request::Request;

const TEXT: &str = "\
framesize 64 48
eyep 0 0 6
light White point, position 4 6 8
surface flesh, diffuse Coral, blobbiness -2
sphere flesh 0.5, 0 0 0
";

const DESK: [f32; 2] = [1440.0, 900.0];
const PHONE: [f32; 2] = [390.0, 844.0];

impl Window {
    /// Opens a window with a small text of the user's own, whose picture is soon finished.
    fn with_work([width, height]: [f32; 2]) -> Self {
        browser::set_hash("");
        let mut window = Self::open(width, height);
        window.load(TEXT);
        window
    }

    fn lab(&self) -> Option<Report> {
        self.parts.outbox.borrow().lab.clone()
    }

    fn reading(&self, name: &str) -> f64 {
        let lab = self.lab().expect("the lab is open");
        *lab.readings
            .get(name)
            .unwrap_or_else(|| panic!("no {name} in {:?}", lab.readings))
    }

    fn click_on(&mut self, name: &str) {
        self.click(self.place(name).center());
        self.steps(1);
    }

    /// Follows a link in the open page, or goes back to it.
    fn follow(&mut self, hash: &str) {
        browser::set_hash(hash);
        self.parts.requests.ask(Request::HashChanged);
        self.steps(4);
    }

    /// Waits until a condition holds.
    fn until(&mut self, what: &str, is: impl Fn(&Self) -> bool) {
        for _ in 0..6000 {
            if is(self) {
                return;
            }
            self.steps(1);
            std::thread::sleep(std::time::Duration::from_millis(3));
        }
        panic!("{what} never came: {:?}", self.lab());
    }
}

#[test]
fn the_lab_is_one_click_away_and_leaves_the_work_alone() {
    for size in [DESK, PHONE] {
        let mut window = Window::with_work(size);
        assert!(window.lab().is_none());
        window.click_on("lab");
        assert_eq!(window.lab().unwrap().lesson, "kernels");
        assert_eq!(browser::hash(), "#lab=kernels");
        assert_eq!(window.text(), TEXT);
        // Keys of the editor do nothing here.
        window
            .harness
            .key_press_modifiers(Modifiers::COMMAND, Key::Z);
        window.harness.event(Event::Text(String::from("x")));
        window.steps(3);
        window.click_on("lab lesson convolution");
        assert_eq!(browser::hash(), "#lab=convolution");
        window.click_on("lab back");
        assert!(window.lab().is_none());
        assert_eq!(browser::hash(), "");
        assert_eq!(window.text(), TEXT);
        // The lab remembers the lesson.
        window.click_on("lab");
        assert_eq!(window.lab().unwrap().lesson, "convolution");
        window.harness.key_press(Key::Escape);
        window.steps(3);
        assert!(window.lab().is_none());
    }
    browser::set_hash("");
}

#[test]
fn links_open_lessons_and_the_way_back_leads_to_the_work() {
    let parts = Parts::new();
    browser::set_hash("#lab=superposition");
    let mut window = Window::open_with(DESK[0], DESK[1], parts.clone());
    assert_eq!(window.lab().unwrap().lesson, "superposition");
    assert!(window.parts.shelf.borrow().entries().is_empty());
    // As the browser's buttons do.
    window.follow("");
    assert!(window.lab().is_none());
    let example = window.text();
    window.follow("#lab=slice");
    assert_eq!(window.lab().unwrap().lesson, "slice");
    assert_eq!(window.text(), example);
    assert!(
        parts.shelf.borrow().entries().is_empty(),
        "nothing was saved"
    );
    // A shared link opens from within the lab.
    let theirs = Project {
        files: vec![File {
            name: String::from("shell.rat"),
            text: String::from("# theirs\n"),
        }],
    };
    let link = document::share::link("https://sinew.example/", &theirs, None).unwrap();
    let fragment = &link[link.find('#').unwrap()..];
    window.follow(fragment);
    assert!(window.lab().is_none());
    assert_eq!(window.text(), "# theirs\n");
    // From there to the lab and back: the same work, the same address.
    window.click_on("lab");
    assert_eq!(browser::hash(), "#lab=slice");
    window.click_on("lab back");
    assert_eq!(browser::hash(), fragment);
    assert_eq!(window.text(), "# theirs\n");
    browser::set_hash("");
}

#[test]
fn every_lesson_is_drawn_at_both_sizes_and_in_both_palettes() {
    for size in [DESK, PHONE, [360.0, 560.0], [720.0, 420.0]] {
        for theme in [Theme::Dark, Theme::Light] {
            let mut window = Window::with_work(size);
            window.harness.ctx.set_theme(theme);
            for lesson in Lesson::all() {
                window.follow(&lesson.hash());
                window.steps(4);
                let lab = window.lab().unwrap();
                assert_eq!(lab.lesson, lesson.words().link);
                assert!(!lab.readings.is_empty(), "{lesson:?}");
                let screen = window.harness.ctx.content_rect();
                for name in ["lab back", "lab share", "lab dataset", "lab figure"] {
                    let place = window.place(name);
                    assert!(
                        place.left() >= -0.5 && place.right() <= screen.right() + 0.5,
                        "{name} {place:?} leaves {screen:?} in {lesson:?}"
                    );
                }
                let figure = window.place("lab figure");
                assert!(figure.width() > 200.0 && figure.height() > 150.0);
                // The pointer wanders over everything.
                for step in 0..12 {
                    let share = step as f32 / 11.0;
                    let at = figure.min + vec2(share, (7.0 * share).fract()) * figure.size();
                    window.harness.event(Event::PointerMoved(at));
                    window.steps(1);
                }
            }
        }
    }
    browser::set_hash("");
}

#[test]
fn every_control_of_the_lab_has_a_name() {
    for size in [DESK, PHONE] {
        let mut window = Window::with_work(size);
        for lesson in Lesson::all() {
            window.follow(&lesson.hash());
            window.steps(6);
            window.until("rest", |window| {
                let lab = window.lab().unwrap();
                let mut last = [("finished", 1.0), ("timed", 63.0)].into_iter();
                lab.waiting == 0
                    && last.all(|(name, last)| lab.readings.get(name).is_none_or(|n| *n == last))
            });
            // Buttons fade while the pointer leaves them. Where nothing moves, egui_kittest checks
            // the names for screen readers.
            window.steps(40);
            window.harness.run();
        }
    }
    browser::set_hash("");
}

#[test]
fn grips_change_their_readings() {
    let mut window = Window::with_work(DESK);
    window.follow("#lab=convolution");
    let before = window.reading("iso");
    let grip = window.place("lab grip iso-value").center();
    window.drag(grip, grip - vec2(0.0, 60.0));
    assert!(window.reading("iso") > before + 0.1);
    let before = window.reading("probe");
    let grip = window.place("lab grip probe").center();
    window.drag(grip, grip + vec2(120.0, 0.0));
    assert!(window.reading("probe") > before + 0.5);
    window.click_on("lab add");
    assert_eq!(window.reading("bars"), 3.0);
    let end = window.place("lab right end of bar 1").center();
    let bar = window.place("lab bar 1");
    window.drag(end, end + vec2(40.0, 0.0));
    let longer = window.place("lab bar 1");
    assert!((longer.width() - bar.width() - 40.0).abs() < 2.0);

    window.follow("#lab=superposition");
    let before = window.reading("cut");
    let grip = window.place("lab grip cut").center();
    window.drag(grip, grip + vec2(100.0, 0.0));
    assert!(window.reading("cut") > before + 0.05);
    // The rounding of single precision, and no more.
    assert!(window.reading("convolution") < 1e-4);
    assert!(window.reading("distance") > 0.9);

    window.follow("#lab=kernels");
    let slider = window.place("lab slider Radius R");
    let at = |share: f32| pos2(slider.left() + slider.width() * share, slider.center().y);
    window.drag(at(0.4), at(0.8));
    assert!(window.reading("radius") > 1.5);
    window.click_on("lab kernel gauss");
    assert_eq!(window.reading("chosen"), 2.0);
    browser::set_hash("");
}

#[test]
fn a_slice_is_refined_and_shows_the_field_under_the_pointer() {
    let mut window = Window::with_work(DESK);
    window.follow("#lab=slice");
    window.until("the finest slice", |window| {
        window.reading("finished") == 1.0
    });
    let figure = window.place("lab figure");
    window.harness.event(Event::PointerMoved(figure.center()));
    window.steps(2);
    // In the middle of a lone ball: the height of its kernel, (1 + |B|)² = 9.
    assert!((window.reading("value") - 9.0).abs() < 0.2);
    let slider = window.place("lab slider Where it stands");
    let at = |share: f32| pos2(slider.left() + slider.width() * share, slider.center().y);
    window.drag(at(0.5), at(0.95));
    window.harness.event(Event::PointerMoved(figure.center()));
    window.steps(2);
    assert!(window.reading("value") < 1.0, "outside");
    browser::set_hash("");
}

#[test]
fn spans_are_held_against_the_exact_surface() {
    let mut window = Window::with_work(DESK);
    window.follow("#lab=spans");
    window.until("the maps and the pictures", |window| {
        let lab = window.lab().unwrap();
        let done = lab.readings.get("finished") == Some(&1.0);
        done && lab.waiting == 0 && lab.drawn == 3
    });
    assert_eq!(window.lab().unwrap().refused, 0);
    let worst = |window: &Window| {
        ["worst of 2", "worst of 4", "worst certified"].map(|name| window.reading(name))
    };
    let [two, four, certified] = worst(&window);
    assert!(
        two > 0.5 && four < two && certified < 0.01,
        "{two} {four} {certified}"
    );
    // Another view is another comparison, begun at once and not finished in one frame.
    window.click_on("lab choice from the front");
    window.until("the other maps", |window| {
        window.reading("finished") == 1.0 && window.lab().unwrap().waiting == 0
    });
    assert!(worst(&window)[0] != two);
    browser::set_hash("");
}

#[test]
fn small_pictures_do_not_disturb_the_picture_of_the_editor() {
    let mut window = Window::with_work(DESK);
    window.until("the picture", |window| {
        window.parts.outbox.borrow().report.phase == "done"
    });
    let before = window.parts.outbox.borrow().report.timings.done;
    window.follow("#lab=grid");
    window.until("small pictures", |window| {
        let lab = window.lab().unwrap();
        lab.waiting == 0 && lab.drawn == 16
    });
    assert_eq!(window.lab().unwrap().refused, 0);
    // Back, the picture is there as it was: nothing is traced again.
    window.click_on("lab back");
    window.steps(20);
    let outbox = window.parts.outbox.borrow();
    assert_eq!(outbox.report.phase, "done");
    assert_eq!(outbox.report.timings.done, before);
    assert!(outbox.report.fresh);
}

#[test]
fn a_picture_of_the_editor_that_runs_is_finished_first() {
    let mut window = Window::with_work(DESK);
    window.until("tracing", |window| {
        window.parts.outbox.borrow().report.phase == "tracing"
    });
    window.follow("#lab=profiles");
    window.until("small pictures", |window| {
        window.lab().unwrap().drawn == 4 && window.lab().unwrap().waiting == 0
    });
    assert_eq!(window.parts.outbox.borrow().report.phase, "done");
    browser::set_hash("");
}

#[test]
fn every_lesson_opens_as_a_dataset_that_compiles() {
    for lesson in Lesson::all() {
        let parts = Parts::new();
        browser::set_hash("");
        let mut window = Window::open_with(DESK[0], DESK[1], parts.clone());
        // A work of the user's own.
        let editor = window.place("editor");
        let at = editor.center_top() + vec2(0.0, 20.0);
        window.harness.event(Event::PointerMoved(at));
        window.steps(1);
        window.press(at, true);
        window.steps(1);
        window.press(at, false);
        window.steps(2);
        window.harness.event(Event::Text(String::from("# mine\n")));
        window.steps(20);
        let own = window.text();
        assert!(own.contains("# mine"));
        window.follow(&lesson.hash());
        window.click_on("lab dataset");
        window.steps(4);
        assert!(window.lab().is_none(), "{lesson:?}");
        let text = window.text();
        assert!(text.starts_with("# ") && text != own, "{lesson:?}");
        let report = window.parts.outbox.borrow().report.clone();
        assert_eq!(report.diagnostics, [], "{lesson:?}: {text}");
        assert_eq!(browser::hash(), "");
        // The user's work is on the shelf, and the way back leads to the lesson.
        let mut shelf = parts.shelf.borrow_mut();
        let [entry] = shelf.entries().try_into().expect("one work");
        let (_, kept) = shelf.open(&entry.id).expect("the work");
        assert_eq!(kept.project.files[0].text, own);
    }
}

#[test]
fn a_cell_opens_in_the_editor() {
    let mut window = Window::with_work(DESK);
    window.follow("#lab=grid");
    window.click_on("lab cell 1 2");
    assert!(window.lab().is_none());
    assert!(window.text().contains("make a T"));
    window.follow("#lab=chart");
    let name = "lab cell cauchy arc";
    window.click_on(name);
    window.click_on("lab open cell");
    assert!(window.text().contains("The kernel cauchy on an arc"));
    window.harness.get_by_label("Lab");
    browser::set_hash("");
}
