//! A clock for measuring times.

/// Returns the seconds on a clock that never goes back.
#[cfg(target_arch = "wasm32")]
#[must_use]
pub fn stopwatch() -> f64 {
    web_sys::window()
        .and_then(|window| window.performance())
        .map_or_else(js_sys::Date::now, |performance| performance.now())
        / 1000.0
}

/// Returns the seconds on a clock that never goes back.
#[cfg(not(target_arch = "wasm32"))]
#[must_use]
pub fn stopwatch() -> f64 {
    static START: std::sync::LazyLock<std::time::Instant> =
        std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed().as_secs_f64()
}
