//! Drives the window as a user does.

// Each test file uses a part of it.

use browser::Backend;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, vec2};
use egui_kittest::Harness;
use egui_wgpu::RenderState;
use rats::{File, Project};
use studio::app::App;
use studio::page::Parts;
use studio::places;
use studio::scripts::request::Request;

/// A window and the parts of its app.
pub struct Window {
    pub harness: Harness<'static, Option<App>>,
    pub parts: Parts,
}

impl Window {
    pub fn open(width: f32, height: f32) -> Self {
        Self::open_with(width, height, Parts::new())
    }

    pub fn open_with(width: f32, height: f32, parts: Parts) -> Self {
        Self::start(width, height, parts, None, Backend::None)
    }

    /// Opens a window on a graphics card.
    pub fn open_on_card(width: f32, height: f32, card: RenderState) -> Self {
        Self::start(width, height, Parts::new(), Some(card), Backend::WebGl2)
    }

    fn start(
        width: f32,
        height: f32,
        parts: Parts,
        card: Option<RenderState>,
        backend: Backend,
    ) -> Self {
        browser::set_stopped(false);
        let inner = parts.clone();
        let harness = Harness::builder()
            .with_size(vec2(width, height))
            .with_step_dt(0.05)
            .build_ui_state(
                move |ui, app: &mut Option<App>| {
                    let app = app.get_or_insert_with(|| {
                        App::new(ui.ctx(), card.clone(), backend, inner.clone())
                    });
                    app.tick(ui.ctx());
                    app.show(ui);
                },
                None,
            );
        let mut window = Self { harness, parts };
        window.steps(4);
        window
    }

    pub fn with_text(text: &str) -> Self {
        let mut window = Self::open(1000.0, 700.0);
        window.load(text);
        window
    }

    pub fn load(&mut self, text: &str) {
        let file = File {
            name: String::from("main.rat"),
            text: text.to_owned(),
        };
        let project = Project { files: vec![file] };
        let request = Request::Load(project, Box::new(|result| result.unwrap()));
        self.parts.requests.ask(request);
        self.steps(3);
    }

    pub fn steps(&mut self, steps: usize) {
        self.harness.run_steps(steps);
    }

    /// Runs until the picture is finished.
    pub fn finish(&mut self) {
        for _ in 0..2000 {
            self.steps(1);
            let outbox = self.parts.outbox.borrow();
            if outbox.report.phase == "done" && outbox.report.fresh {
                return;
            }
            drop(outbox);
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        panic!("no picture: {:?}", self.parts.outbox.borrow().report);
    }

    /// Waits until the first picture is shown, for as few frames as possible.
    pub fn arrive(&mut self) {
        for _ in 0..8 {
            std::thread::sleep(std::time::Duration::from_millis(400));
            self.steps(1);
            if !self.image().is_empty() {
                return;
            }
        }
        panic!("no picture: {:?}", self.parts.outbox.borrow().report);
    }

    pub fn place(&self, name: &str) -> Rect {
        let places = places::all(&self.harness.ctx);
        *places
            .get(name)
            .unwrap_or_else(|| panic!("no {name} among {:?}", places.keys()))
    }

    pub fn press(&self, at: Pos2, pressed: bool) {
        self.harness.event(Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
    }

    pub fn click(&mut self, at: Pos2) {
        self.harness.event(Event::PointerMoved(at));
        self.steps(1);
        self.press(at, true);
        self.steps(1);
        self.press(at, false);
        self.steps(2);
    }

    pub fn drag(&mut self, from: Pos2, to: Pos2) {
        self.harness.event(Event::PointerMoved(from));
        self.steps(1);
        self.press(from, true);
        self.steps(1);
        for step in 1..=8 {
            let at = from + (to - from) * (step as f32 / 8.0);
            self.harness.event(Event::PointerMoved(at));
            self.steps(1);
        }
        self.press(to, false);
        self.steps(2);
    }

    pub fn key(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.steps(2);
    }

    /// Puts the cursor at the start of the text.
    pub fn edit(&mut self) {
        let editor = self.place("editor");
        self.click(editor.center_top() + vec2(0.0, 20.0));
        self.key(Modifiers::COMMAND, Key::Home);
    }

    pub fn write(&mut self, text: &str) {
        self.harness.event(Event::Text(text.to_owned()));
        self.steps(2);
    }

    pub fn text(&self) -> String {
        self.parts.outbox.borrow().project.files[0].text.clone()
    }

    pub fn errors(&self) -> usize {
        self.parts.outbox.borrow().report.errors
    }

    pub fn image(&mut self) -> Vec<u8> {
        let image = std::rc::Rc::new(std::cell::RefCell::new(Vec::new()));
        let inner = image.clone();
        self.parts
            .requests
            .ask(Request::Picture(Box::new(move |picture| {
                *inner.borrow_mut() = picture.map_or_else(Vec::new, |picture| picture.rgba.clone());
            })));
        self.steps(1);
        image.take()
    }
}
