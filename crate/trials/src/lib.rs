//! Random inputs for tests, and their number.
//!
//! Every test that draws its inputs takes their number from [`count`], and the inputs from
//! [`Random`] or, if they are to be any bytes, from [`trials`]. They are the same on every machine
//! and in every run, so that a test that has passed passes again (a library that spends a budget of
//! time, as `arbtest` does, cannot promise that). `SINEW_TRIALS` is a factor on their number:
//! `cargo xtask test quick` sets 0.1, `cargo xtask test all` sets 10. `SINEW_SEED`, a whole number,
//! asks for other inputs.
//!
//! ```
//! use trials::{Random, count};
//!
//! let mut random = Random::new(7);
//! for _ in 0..count(200) {
//!     let x = random.range(-3.0, 3.0);
//!     assert!((x * x).sqrt() == x.abs());
//! }
//! ```
//!
//! Outputs whose bits must not change are hashed and compared with kept hashes: [`bits`].
//!
//! With the feature `field` there are random skeletons, with `scene` random scenes; the crate
//! `oracle` has rays through them and their judge.
//!
//! [`boxes`] are the meshes of tests that need one with known topology and volume.
//!
//! [`WorkClock`] is for tests of the time that something takes.

pub mod bits;
pub mod boxes;
mod random;
#[cfg(feature = "scene")]
pub mod scenes;
#[cfg(feature = "field")]
pub mod skeletons;

pub use arbitrary;
pub use random::Random;

use arbitrary::{Result, Unstructured};
use std::time::Duration;

/// Default number of inputs of a property.
const CASES: u32 = 200;
/// Bytes of the shortest input.
const SHORTEST: usize = 32;
/// Number of steps that each make inputs a quarter longer, up to about 60,000 bytes.
const STEPS: u64 = 35;

/// A property to be tested, when this is dropped.
pub struct Trials<P: FnMut(&mut Unstructured<'_>) -> Result<()>> {
    property: P,
    cases: u32,
}

/// Tests a property on many inputs of bytes, short ones first: it panics if it does not hold, and
/// returns an error if an input is too short for it. A failure prints its input, and `SINEW_CASE`
/// runs that input alone.
///
/// ```
/// use trials::trials;
///
/// trials(|u| {
///     let number: u32 = u.arbitrary()?;
///     assert_eq!(number.to_string().parse(), Ok(number));
///     Ok(())
/// })
/// .cases(100);
/// ```
///
/// # Panics
/// When the returned value is dropped, if the property panics, or if all inputs are too short.
pub fn trials<P: FnMut(&mut Unstructured<'_>) -> Result<()>>(property: P) -> Trials<P> {
    let cases = CASES;
    Trials { property, cases }
}

impl<P: FnMut(&mut Unstructured<'_>) -> Result<()>> Trials<P> {
    /// Sets the number of inputs, > 0.
    pub fn cases(mut self, cases: u32) {
        self.cases = cases;
    }

    /// Runs the property on one input.
    fn case(&mut self, case: Case) -> Result<()> {
        let _report = Report(case);
        let bytes = case.bytes();
        (self.property)(&mut Unstructured::new(&bytes))
    }
}

impl<P: FnMut(&mut Unstructured<'_>) -> Result<()>> Drop for Trials<P> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            return;
        }
        if let Some(case) = std::env::var("SINEW_CASE")
            .ok()
            .and_then(|text| Case::read(&text))
        {
            if let Err(error) = self.case(case) {
                panic!("the input is too short: {error}");
            }
            return;
        }
        let seed = seed();
        let cases = count(self.cases as usize) as u64;
        let mut held = 0;
        for index in 0..cases {
            held += u64::from(self.case(Case::of(seed, index, cases)).is_ok());
        }
        assert!(held > 0, "all inputs are too short for the property");
    }
}

/// A clock of the work of one thread: the work of other threads and programs does not count, so
/// that limits on it hold on a busy machine.
#[derive(Clone, Copy, Debug)]
pub struct WorkClock(Option<Duration>);

impl WorkClock {
    /// Starts a clock of this thread.
    pub fn start() -> Self {
        Self(processor_time())
    }

    /// Returns the processor time that this thread has taken since the start; zero on systems other
    /// than Linux, which do not tell it.
    pub fn elapsed(self) -> Duration {
        let now = processor_time().zip(self.0);
        now.map_or(Duration::ZERO, |(now, start)| now - start)
    }
}

/// Returns the processor time of this thread.
fn processor_time() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds = text.split_whitespace().next()?.parse().ok()?;
    Some(Duration::from_nanos(nanoseconds))
}

/// Returns the number of random inputs of a test: a basic number times `SINEW_TRIALS`, at least
/// one.
///
/// A test that also counts how often something happened scales that count alike.
pub fn count(basic: usize) -> usize {
    scale(basic, setting("SINEW_TRIALS", 1.0))
}

/// Returns a basic number times a factor, at least one.
fn scale(basic: usize, times: f64) -> usize {
    // Rounded down, as a test of few slow inputs gets no quicker otherwise.
    ((basic as f64 * times) as usize).max(1)
}

/// Returns the number that all random inputs depend on.
fn seed() -> u64 {
    setting("SINEW_SEED", 0)
}

/// Returns a number from the environment, or a default.
fn setting<T: std::str::FromStr>(name: &str, otherwise: T) -> T {
    let set = std::env::var(name).ok();
    set.and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

/// An input of bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Case {
    seed: u64,
    /// Length in bytes.
    size: usize,
}

impl Case {
    /// Returns one of `cases` inputs. Each size has as many of them.
    fn of(seed: u64, index: u64, cases: u64) -> Self {
        let steps = index * STEPS / cases;
        let size = (0..steps).fold(SHORTEST, |size, _| size * 5 / 4);
        let seed = mix(mix(seed) ^ index);
        Self { seed, size }
    }

    /// Parses the output of [`Report`].
    fn read(text: &str) -> Option<Self> {
        let (seed, size) = text.split_once(':')?;
        Some(Self {
            seed: seed.parse().ok()?,
            size: size.parse().ok()?,
        })
    }

    /// Returns the bytes of the input.
    fn bytes(self) -> Vec<u8> {
        (0..self.size.div_ceil(8) as u64)
            .flat_map(|word| mix(self.seed.wrapping_add(word)).to_le_bytes())
            .take(self.size)
            .collect()
    }
}

/// The step of SplitMix64's state.
const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// Returns an unrelated number for each number.
fn mix(number: u64) -> u64 {
    scramble(number.wrapping_add(1).wrapping_mul(STEP))
}

/// Returns SplitMix64's output of a state.
fn scramble(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// A report of the input that a property panicked with, printed when this is dropped.
struct Report(Case);

impl Drop for Report {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let Case { seed, size } = self.0;
            eprintln!("The input was random. To run it alone: SINEW_CASE={seed}:{size}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{AssertUnwindSafe, catch_unwind};

    #[test]
    fn inputs_are_the_same_each_time_and_grow() {
        let [seen, again] = [(), ()].map(|()| {
            let mut seen = Vec::new();
            trials(|u| {
                seen.push((u.len(), u.arbitrary::<u64>()?));
                Ok(())
            })
            .cases(50);
            seen
        });
        assert_eq!(seen, again);
        assert_eq!(seen.len(), 50);
        assert_eq!(seen[0].0, 32);
        assert!(seen[49].0 > 40_000 && seen.is_sorted_by_key(|(size, _)| *size));
        let mut numbers: Vec<u64> = seen.iter().map(|(_, number)| *number).collect();
        numbers.sort_unstable();
        numbers.dedup();
        assert_eq!(numbers.len(), 50);
        assert_ne!(Case::of(1, 0, 50).seed, Case::of(0, 0, 50).seed);
    }

    #[test]
    fn counts_are_scaled_and_never_nothing() {
        assert_eq!(
            [0.1, 1.0, 10.0].map(|times| scale(250, times)),
            [25, 250, 2500]
        );
        assert_eq!([0.1, 1.0, 0.0].map(|times| scale(4, times)), [1, 4, 1]);
    }

    #[test]
    fn work_is_told_from_waiting() {
        let clock = WorkClock::start();
        std::thread::sleep(Duration::from_millis(300));
        let waited = clock.elapsed();
        let mut sum = 0_u64;
        for i in 0..30_000_000 {
            sum = std::hint::black_box(sum ^ mix(i));
        }
        let worked = clock.elapsed();
        assert!(waited < Duration::from_millis(200), "{waited:?}");
        if cfg!(target_os = "linux") {
            assert!(worked > waited + Duration::from_millis(5), "{worked:?}");
        }
    }

    #[test]
    fn a_property_that_does_not_hold_is_found() {
        let found = catch_unwind(AssertUnwindSafe(|| {
            drop(trials(|u| {
                assert!(u.arbitrary::<u8>()? < 250);
                Ok(())
            }));
        }));
        assert!(found.is_err());
        let short = catch_unwind(AssertUnwindSafe(|| {
            drop(trials(|u| u.bytes(1 << 20).map(|_| ())));
        }));
        assert!(short.is_err());
        assert_eq!(Case::read("7:64"), Some(Case { seed: 7, size: 64 }));
        assert_eq!(Case::read("7"), None);
    }
}
