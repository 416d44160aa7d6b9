//! The editor's services for the language: completions, cards, the line at the caret, definitions,
//! renaming, layout. All of it with the keyboard, and each change one undo step.

use crate::driver::Window;
use egui::{Event, Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use studio::places;

const TEXT: &str = "\
framesize 64 48
eyep 0 0 6
surface flesh, diffuse Coral, blobbiness -2
var size = 0.5
sphere flesh size, 0 0 0
sphere flesh size, 1 0 0
";

/// Opens a window in which no line of the text is wrapped.
fn window() -> Window {
    let mut window = Window::open(1600.0, 800.0);
    window.load(TEXT);
    window
}

fn has(window: &Window, name: &str) -> bool {
    places::all(&window.harness.ctx).contains_key(name)
}

/// Puts the caret at the end of the text.
fn at_end(window: &mut Window) {
    window.edit();
    window.key(Modifiers::CTRL, Key::End);
}

/// Types letter by letter, as a keyboard does.
fn type_in(window: &mut Window, text: &str) {
    for letter in text.chars() {
        window.harness.event(Event::Text(letter.to_string()));
        window.steps(1);
    }
    window.steps(8);
}

#[test]
fn completions_open_while_typing_and_are_one_undo_step() {
    let mut window = window();
    at_end(&mut window);
    type_in(&mut window, "sph");
    assert!(has(&window, "completions"));
    window.harness.get_by_label("sphere");
    window.steps(20);
    window.key(Modifiers::NONE, Key::Enter);
    assert!(
        window.text().starts_with(&format!("{TEXT}sphere")),
        "{}",
        window.text()
    );
    assert!(!has(&window, "completions"));
    let written = window.text();
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.text(), format!("{TEXT}sph"));
    window.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(window.text(), written);
}

#[test]
fn keys_choose_close_and_do_not_get_in_the_way() {
    let mut window = window();
    at_end(&mut window);
    window.key(Modifiers::CTRL, Key::Space);
    window.steps(6);
    assert!(has(&window, "completions"));
    window.key(Modifiers::NONE, Key::ArrowDown);
    assert_eq!(window.text(), TEXT, "arrows choose");
    window.key(Modifiers::NONE, Key::Escape);
    assert!(!has(&window, "completions"));
    // The text still has the focus.
    window.write("sphere");
    assert!(window.text().ends_with("sphere"));
    // The word is whole: Enter makes a new line.
    window.steps(8);
    window.key(Modifiers::NONE, Key::Enter);
    assert!(window.text().ends_with("sphere\n"), "{:?}", window.text());
    // A colour shows itself and can be clicked.
    type_in(&mut window, "surface s, diffuse Cor");
    window.harness.get_by_label("Coral").click();
    window.steps(3);
    assert!(
        window
            .text()
            .trim_end()
            .ends_with("surface s, diffuse Coral"),
        "{}",
        window.text()
    );
    window.write(" ");
    assert!(window.text().ends_with(' '), "the text has the focus again");
}

#[test]
fn a_line_at_the_caret_says_which_operand_is_next() {
    let mut window = window();
    at_end(&mut window);
    type_in(&mut window, "sphere flesh ");
    assert!(has(&window, "signature"));
    window.key(Modifiers::NONE, Key::Escape);
    window.steps(6);
    assert!(!has(&window, "signature"));
    window.key(Modifiers::NONE, Key::Enter);
    type_in(&mut window, "cylinder flesh ");
    assert!(has(&window, "signature"));
    // It can be switched off, in the help.
    window.harness.get_by_label("How it works").click();
    window.steps(4);
    window
        .harness
        .get_by_label_contains("how the command at the caret is written")
        .click_accesskit();
    window.steps(3);
    window.harness.get_by_label("Close").click();
    window.steps(3);
    window.edit();
    window.steps(8);
    assert!(!has(&window, "signature"));
}

#[test]
fn a_word_is_found_and_replaced_and_escape_closes_the_strip() {
    let mut window = window();
    window.edit();
    window.key(Modifiers::CTRL, Key::Home);
    window.key(Modifiers::COMMAND, Key::F);
    window.steps(3);
    assert!(has(&window, "find"));
    type_in(&mut window, "flesh");
    window.key(Modifiers::NONE, Key::Enter);
    window.steps(3);
    window.key(Modifiers::NONE, Key::Escape);
    window.steps(3);
    assert!(!has(&window, "find"));
    // The place on show is selected, and is written over.
    type_in(&mut window, "meat");
    let second = TEXT.replacen("sphere flesh size, 0", "sphere meat size, 0", 1);
    assert_eq!(window.text(), second);
    window.key(Modifiers::COMMAND, Key::H);
    window.steps(3);
    let place = window.place("replace with");
    window.click(place.center());
    type_in(&mut window, "bone");
    window.key(Modifiers::NONE, Key::Escape);
    window.steps(3);
    assert!(!has(&window, "find"), "from the other field, too");
    assert_eq!(window.text(), second);
    window.key(Modifiers::COMMAND, Key::G);
    window.steps(3);
    type_in(&mut window, "3");
    window.key(Modifiers::NONE, Key::Enter);
    window.steps(3);
    type_in(&mut window, "# ");
    assert!(
        window.text().contains("# surface flesh"),
        "{}",
        window.text()
    );
}

#[test]
fn names_lead_to_their_definitions_and_can_be_renamed() {
    let mut window = window();
    window.edit();
    for _ in 0..4 {
        window.key(Modifiers::NONE, Key::ArrowDown);
    }
    for _ in 0.."sphere flesh si".len() {
        window.key(Modifiers::NONE, Key::ArrowRight);
    }
    window.key(Modifiers::NONE, Key::F2);
    window.steps(4);
    window.write("girth");
    window.key(Modifiers::NONE, Key::Enter);
    window.steps(3);
    assert_eq!(
        window.text(),
        TEXT.replace("size", "girth")
            .replace("framegirth", "framesize")
    );
    assert_eq!(window.errors(), 0);
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.text(), TEXT);

    window.key(Modifiers::NONE, Key::F12);
    window.steps(3);
    window.write("# ");
    let line = window.text().lines().nth(3).unwrap().to_owned();
    assert!(line.starts_with("var # "), "{line}");
}

#[test]
fn a_click_with_control_goes_to_the_definition_of_a_name() {
    let mut window = window();
    let editor = window.place("editor");
    // On `size` in the fifth line.
    let at = editor.left_top() + vec2(46.0 + 14.5 * 8.1, 10.0 + 4.5 * 19.6);
    window.harness.event(Event::PointerMoved(at));
    let control = Modifiers::CTRL | Modifiers::COMMAND;
    window.harness.event(Event::ModifiersChanged(control));
    window.steps(1);
    for pressed in [true, false] {
        window.harness.event(Event::PointerButton {
            pos: at,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: control,
        });
        window.steps(1);
    }
    window
        .harness
        .event(Event::ModifiersChanged(Modifiers::NONE));
    window.steps(3);
    window.write("# ");
    let line = window.text().lines().nth(3).unwrap().to_owned();
    assert!(line.starts_with("var # "), "{line}");
}

/// Returns the event of a key that goes down.
fn key(key: Key) -> Event {
    with(Modifiers::NONE, key)
}

fn with(modifiers: Modifiers, key: Key) -> Event {
    Event::Key {
        key,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers,
    }
}

fn letters(text: &str) -> Event {
    Event::Text(text.to_owned())
}

/// Moves the pointer to a line of the text, from 0. Returns the events of a click there.
fn click(window: &mut Window, line: u8) -> [Event; 2] {
    let pos = window.place("editor").center_top() + vec2(0.0, 20.0 + 19.6 * f32::from(line));
    window.harness.event(Event::PointerMoved(pos));
    window.steps(1);
    [true, false].map(|pressed| Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    })
}

/// Sends events that come in one frame, as in a slow browser.
fn at_once(window: &mut Window, events: impl IntoIterator<Item = Event>) {
    window.harness.input_mut().events.extend(events);
    // As many frames as a browser would be asked for.
    window.steps(40);
}

#[test]
fn a_name_is_renamed_in_one_frame() {
    let mut window = window();
    let mut events = click(&mut window, 0).to_vec();
    events.extend([
        with(Modifiers::CTRL, Key::End),
        key(Key::ArrowUp),
        key(Key::Home),
    ]);
    events.extend(vec![key(Key::ArrowRight); "sphere flesh si".len()]);
    events.extend([key(Key::F2), letters("girth"), key(Key::Enter)]);
    // The text has the focus again, and the caret where it was.
    events.extend([key(Key::ArrowUp), key(Key::Home), letters("# ")]);
    at_once(&mut window, events);
    let renamed = TEXT
        .replace("size", "girth")
        .replace("framegirth", "framesize")
        .replace("sphere flesh girth, 0", "# sphere flesh girth, 0");
    assert_eq!(window.text(), renamed);
}

#[test]
fn keys_that_come_with_a_click_go_to_the_clicked_widget() {
    // Also if the button goes up a frame after it went down.
    for together in [true, false] {
        for (arrow, line) in [(Key::ArrowUp, 0), (Key::ArrowDown, 2)] {
            let mut window = window();
            let [down, up] = click(&mut window, 1);
            let mut events = vec![down];
            if !together {
                at_once(&mut window, std::mem::take(&mut events));
            }
            events.extend([up, key(arrow), key(Key::Home), letters("# ")]);
            at_once(&mut window, events);
            let text = window.text();
            let written = text.lines().position(|line| line.starts_with("# "));
            assert_eq!(written, Some(line), "{text}");
        }
    }
}

#[test]
fn keys_after_a_completion_stay_in_the_text() {
    let mut window = window();
    at_end(&mut window);
    type_in(&mut window, "sph");
    let keys = [
        key(Key::Tab),
        key(Key::ArrowUp),
        key(Key::Home),
        letters("# "),
    ];
    at_once(&mut window, keys);
    let text = window.text();
    assert!(
        text.contains("\n# sphere flesh size, 1 0 0\nsphere"),
        "{text}"
    );
}

#[test]
fn keys_after_a_jump_stay_in_the_text() {
    let mut window = window();
    window.edit();
    let mut keys = vec![key(Key::ArrowDown); 4];
    keys.extend(vec![key(Key::ArrowRight); "sphere flesh si".len()]);
    keys.extend([
        key(Key::F12),
        key(Key::ArrowUp),
        key(Key::Home),
        letters("# "),
    ]);
    at_once(&mut window, keys);
    let text = window.text();
    assert!(text.contains("\n# surface flesh"), "{text}");
}

#[test]
fn a_name_that_is_taken_is_refused_in_the_field() {
    let mut window = window();
    window.edit();
    for _ in 0..3 {
        window.key(Modifiers::NONE, Key::ArrowDown);
    }
    for _ in 0.."var s".len() {
        window.key(Modifiers::NONE, Key::ArrowRight);
    }
    window.key(Modifiers::NONE, Key::F2);
    window.steps(4);
    window.write("2 x");
    window.key(Modifiers::NONE, Key::Enter);
    window.steps(3);
    assert_eq!(window.text(), TEXT);
    assert!(has(&window, "rename"), "the field says what is wrong");
    window.key(Modifiers::NONE, Key::Escape);
    window.steps(3);
    assert!(!has(&window, "rename"));
    // On a number there is nothing to rename.
    window.key(Modifiers::NONE, Key::End);
    window.key(Modifiers::NONE, Key::F2);
    window.harness.get_by_label_contains("F2 renames");
}

#[test]
fn the_text_is_laid_out_in_one_step() {
    let untidy = "for i=1 to 3 {\nsphere flesh 1,i 0 0\n}\n";
    let mut window = Window::with_text(&format!("{TEXT}{untidy}"));
    window.edit();
    window.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::F);
    window.steps(2);
    assert!(
        window.text().contains("\n  sphere flesh 1,"),
        "{}",
        window.text()
    );
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.text(), format!("{TEXT}{untidy}"));
    let button = window.place("lay out").center();
    window.click(button);
    assert!(window.text().contains("\n  sphere flesh 1,"));
}

#[test]
fn a_card_comes_when_the_pointer_rests_and_the_manual_with_f1() {
    let mut window = window();
    let editor = window.place("editor");
    // On the first word of the first line.
    window
        .harness
        .event(Event::PointerMoved(editor.left_top() + vec2(70.0, 18.0)));
    window.steps(2);
    assert!(
        window
            .harness
            .query_by_label_contains("F1: manual")
            .is_none()
    );
    window.steps(14);
    window.harness.get_by_label_contains("F1: manual");
    window.edit();
    // While typing there is no card, wherever the pointer is.
    window.write("# ");
    window.steps(14);
    assert!(
        window
            .harness
            .query_by_label_contains("F1: manual")
            .is_none()
    );
    window.key(Modifiers::COMMAND, Key::Z);
    window.key(Modifiers::COMMAND, Key::Home);
    window.key(Modifiers::NONE, Key::F1);
    window.steps(4);
    assert!(window.place("search commands").width() > 100.0);
}

/// Returns the seconds that frames take, in each of which a letter is typed.
fn frames(window: &mut Window, letters: &str) -> Vec<f64> {
    letters
        .chars()
        .map(|letter| {
            window.harness.event(Event::Text(letter.to_string()));
            let start = std::time::Instant::now();
            window.steps(1);
            start.elapsed().as_secs_f64()
        })
        .collect()
}

#[test]
fn typing_in_a_long_text_does_not_wait_for_answers() {
    let line = "sphere flesh size, 0.25 1 0.5 # one of very many\n";
    let text = format!("{TEXT}{}", line.repeat(100_000 / line.len()));
    let mut window = Window::with_text(&text);
    at_end(&mut window);
    window.steps(10);
    // A comment has neither completions nor a line at the caret.
    let without = frames(&mut window, "# sphere");
    window.key(Modifiers::NONE, Key::Enter);
    let with = frames(&mut window, "sphere fl");
    window.steps(2);
    assert!(window.text() == format!("{text}# sphere\nsphere fl"));
    // The quickest frame, which other programs have disturbed least.
    let [without, with] = [without, with].map(|t| t.into_iter().fold(f64::INFINITY, f64::min));
    let compile = window.parts.outbox.borrow().report.timings.compile;
    println!(
        "a frame: {without:.3} s in a comment, {with:.3} s in a command, \
            {compile:.3} s of it for compiling"
    );
    // Processors are shared while tests run.
    assert!(
        with < 2.0 * without + 0.02,
        "{with} s, {without} s in a comment"
    );
}

#[test]
fn blocks_fold_with_f8_and_with_their_triangles() {
    let text = "surface flesh diffuse Red\nobject A\n  sphere flesh 1 0 0 0\n  \
        sphere flesh 1 1 0 0\nclose\ninfo\n";
    let mut window = Window::with_text(text);
    at_end(&mut window);
    window.key(Modifiers::CTRL, Key::Home);
    window.key(Modifiers::NONE, Key::ArrowDown);
    window.key(Modifiers::NONE, Key::F8);
    window.steps(2);
    window.harness.get_by_label("Unfold line 2");
    // Typed text goes to the visible line, and nothing is lost.
    window.key(Modifiers::NONE, Key::ArrowDown);
    window.key(Modifiers::NONE, Key::Home);
    window.write("# ");
    assert_eq!(window.text(), text.replace("info", "# info"));
    window.key(Modifiers::NONE, Key::ArrowUp);
    window.key(Modifiers::NONE, Key::End);
    window.write("B");
    assert_eq!(
        window.text(),
        text.replace("info", "# info")
            .replace("object A", "object AB")
    );
    window.harness.get_by_label("Unfold line 2").click();
    window.steps(2);
    window.harness.get_by_label("Fold line 2");
}

/// Returns the widget that has the focus.
fn find_focus(window: &Window) -> Option<egui::Id> {
    window.harness.ctx.memory(|memory| memory.focused())
}

#[test]
fn tab_goes_on_from_the_text_that_escape_has_left() {
    let mut window = window();
    at_end(&mut window);
    window.key(Modifiers::NONE, Key::Escape);
    window.key(Modifiers::NONE, Key::Escape);
    assert_eq!(find_focus(&window), None);
    let before = window.text();
    window.key(Modifiers::NONE, Key::Tab);
    assert!(find_focus(&window).is_some_and(|own| own != egui::Id::unique("editor")));
    let node = window.harness.get_by(|node| node.is_focused());
    // The first widget of the page, from which Tab would begin again.
    assert_ne!(node.accesskit_node().label().as_deref(), Some("Work"));
    assert_eq!(window.text(), before);
}
