//! Lets the page rest while nothing is to be drawn.
//!
//! eframe asks the browser for an animation frame after every one, drawn or not, which costs a
//! processor 8 % of its time in Chromium (60 Hz, nothing ever drawn), at the expense of the workers
//! or of a battery. So the page's `requestAnimationFrame` is replaced: a request gets its frame
//! when there may be something to draw, that is when egui has asked for it or one of the events
//! came that eframe listens to, else a few times a second ([`QUIET`]), for changes without an
//! event, such as another colour scheme of the system.
//!
//! egui draws twice more after each event, to let things settle. Where each frame keeps the tracer
//! waiting, these come [`PACE`] apart, unless a pointer is at work ([`LIVELY`]).

use js_sys::{Function, Reflect};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::time::Duration;
use wasm_bindgen::prelude::*;

/// Milliseconds between frames while nothing happens.
const QUIET: f64 = 250.0;

/// Milliseconds between the frames that egui requests without delay, while frames are slow.
const PACE: f64 = 100.0;

/// Milliseconds after an event of a pointer in which no frame counts as slow: scrolling and
/// dragging must stay smooth.
const LIVELY: f64 = 500.0;

/// Frames that are given without delay once something happens: egui and eframe often want another
/// after the first.
const TOGETHER: u32 = 3;

/// Most frames in the browser's hands that can still be cancelled, more than anyone waits for.
const GIVEN: usize = 8;

/// Events of the keyboard and the browser that call for a frame.
const EVENTS: &str = "beforeinput blur compositionend compositionstart compositionupdate copy cut \
    dragend dragenter dragleave dragover drop focus hashchange input keydown load pagehide \
    pageshow paste popstate resize scroll visibilitychange";
/// Events of pointers that call for a frame.
const POINTER: &str = "gesturechange gestureend gesturestart mousedown mouseleave mousemove \
    mouseup pointercancel pointerdown pointerleave pointermove pointerup touchcancel touchend \
    touchmove touchstart wheel";
/// Events that can wait for the next frame.
const LATER: &str = "keyup";

thread_local! {
    static FRAMES: RefCell<Option<Frames>> = const { RefCell::new(None) };
}

struct Frames {
    window: web_sys::Window,
    /// The browser's own functions.
    request: Function,
    cancel: Function,
    /// The last number given to a request.
    number: i32,
    /// Callbacks that wait for a frame, by number.
    held: VecDeque<(i32, Function)>,
    /// The numbers by which the browser knows requests.
    given: VecDeque<(i32, JsValue)>,
    /// Frames still to be given without delay.
    left: u32,
    /// Time of the frame that egui requests next, in milliseconds of the page's clock; infinite
    /// without a request.
    due: f64,
    /// Time at which waiting requests get their frame in any case.
    latest: f64,
    /// Whether frames are slow, so that each keeps the tracer waiting.
    slow: bool,
    /// Time until which frames do not count as slow.
    lively: f64,
    /// Time of the last frame that was given.
    last: f64,
    /// Whether a frame was given that has not come yet.
    coming: bool,
    /// The timer that wakes the page, and its time.
    timer: Option<(i32, f64)>,
    on_timer: Closure<dyn FnMut()>,
}

/// Takes over the page's animation frames, once. Does nothing without a window or a clock.
pub fn take_over() {
    if FRAMES.with_borrow(Option::is_some) {
        return;
    }
    let Some(window) = web_sys::window().filter(|window| window.performance().is_some()) else {
        return;
    };
    let own = |name: &str| Reflect::get(&window, &name.into()).ok()?.dyn_into().ok();
    let (Some(request), Some(cancel)) = (own("requestAnimationFrame"), own("cancelAnimationFrame"))
    else {
        return;
    };
    let ask =
        Closure::<dyn FnMut(Function) -> i32>::new(|callback| with(|frames| frames.ask(callback)));
    let withdraw = Closure::<dyn FnMut(i32)>::new(|number| with(|frames| frames.withdraw(number)));
    let new = [
        ("requestAnimationFrame", ask.into_js_value()),
        ("cancelAnimationFrame", withdraw.into_js_value()),
    ];
    for (name, function) in new {
        // If the window's function cannot be replaced, nothing changes.
        let _ = Reflect::set(&window, &name.into(), &function);
    }
    let listen = |events: &str, act: fn(&mut Frames)| {
        let listener = Closure::<dyn FnMut()>::new(move || with(act)).into_js_value();
        for event in events.split_whitespace() {
            // In the capturing phase, before anyone can stop the event. One that is missed is drawn
            // a little later.
            let listener = listener.unchecked_ref();
            let _ = window.add_event_listener_with_callback_and_bool(event, listener, true);
        }
    };
    listen(EVENTS, Frames::hurry);
    listen(POINTER, |frames| {
        frames.lively = frames.now() + LIVELY;
        frames.hurry();
    });
    listen(LATER, |frames| frames.want(Duration::ZERO));
    let on_timer = Closure::new(|| {
        with(|frames| {
            frames.timer = None;
            frames.schedule();
        });
    });
    FRAMES.set(Some(Frames {
        window,
        request,
        cancel,
        number: 0,
        held: VecDeque::new(),
        given: VecDeque::new(),
        left: TOGETHER,
        due: f64::INFINITY,
        latest: f64::INFINITY,
        slow: false,
        lively: f64::NEG_INFINITY,
        last: f64::NEG_INFINITY,
        coming: false,
        timer: None,
        on_timer,
    }));
}

/// Schedules frames at the times that this egui requests.
pub fn watch(context: &egui::Context) {
    context.set_repaint_observer(|info| with(|frames| frames.want(info.delay)));
}

/// Forgets requests that egui made before it begins to draw, as eframe does, too.
pub fn begin() {
    with(|frames| frames.due = f64::INFINITY);
}

/// Sets whether each frame keeps the tracer waiting from now on.
pub fn set_slow(slow: bool) {
    with(|frames| {
        if slow && !frames.slow && frames.left > 0 && frames.now() >= frames.lively {
            frames.left = 0;
            frames.due = frames.due.min(frames.last + PACE);
        }
        frames.slow = slow;
    });
}

fn with<T: Default>(act: impl FnOnce(&mut Frames) -> T) -> T {
    FRAMES.with_borrow_mut(|frames| frames.as_mut().map(act).unwrap_or_default())
}

impl Frames {
    fn now(&self) -> f64 {
        self.window
            .performance()
            .map_or(0.0, |performance| performance.now())
    }

    /// Takes egui's request for a frame after a delay.
    fn want(&mut self, delay: Duration) {
        let now = self.now();
        if !delay.is_zero() {
            // Not a moment before eframe finds that it is time.
            self.due = self.due.min(now + 1000.0 * delay.as_secs_f64() + 1.0);
        } else if self.slow && now >= self.lively {
            self.due = self.due.min(now.max(self.last + PACE));
        } else {
            self.left = TOGETHER;
        }
        self.schedule();
    }

    /// Gives a frame at once after an event that may change what is seen.
    fn hurry(&mut self) {
        let now = self.now();
        if !self.slow || now < self.lively {
            self.left = TOGETHER;
        } else if !self.coming {
            self.due = self.due.min(now);
        }
        self.schedule();
    }

    /// Registers a request for a frame. Returns its number.
    fn ask(&mut self, callback: Function) -> i32 {
        self.coming = false;
        self.number = self.number.wrapping_add(1);
        self.held.push_back((self.number, callback));
        self.latest = self.latest.min(self.now() + QUIET);
        self.schedule();
        self.number
    }

    /// Cancels a request by its number.
    fn withdraw(&mut self, number: i32) {
        self.held.retain(|(held, _)| *held != number);
        let given = self.given.iter().find(|(given, _)| *given == number);
        if let Some((_, number)) = given {
            // Refused only by a window that is closed.
            let _ = self.cancel.call1(&self.window, number);
        }
    }

    /// Gives waiting requests their frame, or schedules them for later.
    fn schedule(&mut self) {
        if self.held.is_empty() {
            return;
        }
        let (now, next) = (self.now(), self.due.min(self.latest));
        if self.left > 0 || next <= now {
            self.left = self.left.saturating_sub(1);
            self.latest = f64::INFINITY;
            self.last = now;
            self.coming = true;
            if self.due <= now {
                self.due = f64::INFINITY;
            }
            for (number, callback) in self.held.drain(..) {
                // Refused only by a window that is closed.
                if let Ok(known) = self.request.call1(&self.window, &callback) {
                    self.given.push_back((number, known));
                }
            }
            while self.given.len() > GIVEN {
                self.given.pop_front();
            }
            return;
        }
        if let Some((timer, at)) = self.timer {
            if at <= next {
                return;
            }
            self.window.clear_timeout_with_handle(timer);
        }
        let listener = self.on_timer.as_ref().unchecked_ref();
        let wait = (next - now).ceil() as i32;
        let timer = self
            .window
            .set_timeout_with_callback_and_timeout_and_arguments_0(listener, wait);
        self.timer = timer.ok().map(|timer| (timer, next));
    }
}
