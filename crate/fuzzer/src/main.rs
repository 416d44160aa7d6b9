//! Runs random texts and links through the compiler for a given time, and reports findings.
//!
//! `cargo run --profile fuzz -p fuzzer -- [SECONDS [SEED] | FILE.rat]`
//!
//! SECONDS are of processor time; a FILE is a finding to be run again. What is checked stands in
//! [`check`]; besides, no compile may take more than [`SLOW`] three times in a row or need more
//! than [`MEMORY`], and none may panic or overflow the stack of a browser's worker. A finding is
//! made smaller and written to a file. The text that is being run always stands in
//! `sinew-fuzz-case.rat` in the folder for temporary files, for the case that the program is
//! killed.
//!
//! The folder `fuzz/` at the top holds the same checks for cargo-fuzz, which is guided by what the
//! code does but needs a nightly compiler.

use fuzzer::{check, generate};
use rats::{Project, compile};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::time::{Duration, Instant};
use trials::Random;
use trials::arbitrary::Unstructured;

/// Longest time for one compile, of the processor, on the machine we develop on.
const SLOW: Duration = Duration::from_millis(100);
/// Name of findings whose compile took longer than [`SLOW`].
const SLOWNESS: &str = "slow";
/// The most slow texts that are made smaller.
const MAX_SLOW: usize = 5;
/// The longest time in which a finding is made smaller.
const PATIENCE: Duration = Duration::from_secs(15);
/// Most memory for one compile, kilobytes, over what the program needs anyway.
const MEMORY: u64 = 256 * 1024;
/// The stack that a browser gives to a worker.
const STACK: usize = 1024 * 1024;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let worker = std::thread::Builder::new().stack_size(STACK);
    let found = worker
        .spawn(move || match arguments.first() {
            Some(path) if path.ends_with(".rat") => again(path),
            _ => {
                let number = |index: usize, otherwise| {
                    let word = arguments.get(index);
                    word.map_or(otherwise, |word| word.parse().expect("a whole number"))
                };
                Fuzzer::new(number(1, 0)).run(Duration::from_secs(number(0, 60)))
            }
        })
        .expect("a thread")
        .join()
        .expect("the fuzzer itself holds");
    std::process::exit(i32::from(found));
}

/// Runs one text, e.g. a finding, five times. True if something is wrong with it.
fn again(path: &str) -> bool {
    let text = std::fs::read_to_string(path).expect("a text");
    let mut found = false;
    for _ in 0..5 {
        let before = forget_peak();
        let (outcome, took) = try_text(&text, true);
        println!(
            "{took:?}, {} kB: {outcome:?}",
            peak().saturating_sub(before)
        );
        found |= outcome.is_err();
    }
    found
}

/// Returns random bytes.
fn bytes(random: &mut Random, length: usize) -> Vec<u8> {
    let words = (0..length.div_ceil(8)).flat_map(|_| random.bits().to_le_bytes());
    words.take(length).collect()
}

struct Fuzzer {
    random: Random,
    /// The texts of the page, to be spoilt.
    examples: Vec<String>,
    case: PathBuf,
    /// Findings by what was found, without its numbers.
    found: BTreeMap<String, String>,
    slow: usize,
    longest: (Duration, String),
    largest: (u64, String),
    counts: BTreeMap<&'static str, u64>,
}

impl Fuzzer {
    fn new(seed: u64) -> Self {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../www/examples");
        let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)
            .expect("the examples")
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| path.extension().is_some_and(|ending| ending == "rat"))
            .collect();
        paths.sort();
        let examples = paths
            .iter()
            .map(|path| std::fs::read_to_string(path).expect("a text"));
        Self {
            random: Random::fixed(seed),
            examples: examples.collect(),
            case: std::env::temp_dir().join("sinew-fuzz-case.rat"),
            found: BTreeMap::new(),
            slow: 0,
            longest: (Duration::ZERO, String::new()),
            largest: (0, String::new()),
            counts: BTreeMap::new(),
        }
    }

    /// Runs cases until the time is over. True if something was found.
    fn run(mut self, time: Duration) -> bool {
        let begun = processor_time();
        // Each panic is told once, below, with its text.
        std::panic::set_hook(Box::new(|_| ()));
        while processor_time() - begun < time {
            let kinds = ["bytes", "language", "language", "language", "slips", "link"];
            let kind = self.random.pick(&kinds);
            *self.counts.entry(kind).or_default() += 1;
            match kind {
                "link" => self.link(),
                "bytes" => {
                    let length = self.random.below(600);
                    let bytes = bytes(&mut self.random, length);
                    self.text(&String::from_utf8_lossy(&bytes));
                }
                "slips" => {
                    let text = self.slips();
                    self.text(&text);
                }
                _ => {
                    let length = 20 << self.random.below(9);
                    let bytes = bytes(&mut self.random, length);
                    // A generator that runs out of bytes leaves its text unfinished, which is fine
                    // too.
                    if let Ok(text) = generate::dataset(&mut Unstructured::new(&bytes)) {
                        self.text(&text);
                    }
                }
            }
        }
        let _ = std::panic::take_hook();
        println!("cases: {:?}", self.counts);
        println!(
            "longest compile: {:?}, of\n{}",
            self.longest.0,
            head(&self.longest.1)
        );
        println!(
            "most memory: {} kB, of\n{}",
            self.largest.0,
            head(&self.largest.1)
        );
        for (what, text) in &self.found {
            println!("---- {what}\n{text}");
        }
        println!("{} findings", self.found.len());
        !self.found.is_empty()
    }

    /// A text of the page with a few slips of the hand.
    fn slips(&mut self) -> String {
        let mut text = self.random.pick(&self.examples);
        for _ in 0..self.random.below(6) {
            let at = text.floor_char_boundary(self.random.below(text.len()));
            match self.random.below(4) {
                0 => text.truncate(at),
                1 => {
                    let parts = [
                        "{",
                        "}",
                        "9",
                        "-",
                        "x",
                        "\n",
                        "(",
                        " ",
                        "e9",
                        "^",
                        "for i = 1 to 1e9 {",
                    ];
                    text.insert_str(at, self.random.pick(&parts));
                }
                2 => {
                    let end = text.floor_char_boundary(at + self.random.below(40));
                    text.replace_range(at..end.max(at), "");
                }
                _ => {
                    let end = text
                        .floor_char_boundary(at + self.random.below(200))
                        .max(at);
                    let piece = text[at..end].to_owned();
                    let to = text.floor_char_boundary(self.random.below(text.len()));
                    text.insert_str(to, &piece);
                }
            }
        }
        text
    }

    fn link(&mut self) {
        let length = self.random.below(300);
        let bytes = bytes(&mut self.random, length);
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            check::link(&String::from_utf8_lossy(&bytes))?;
            check::link_content(&bytes)?;
            let json = format!(
                r#"{{"project":{{"files":[{{"name":"m","text":{:?}}}]}},"camera":null}}"#,
                String::from_utf8_lossy(&bytes)
            );
            check::link_content(json.as_bytes())
        }));
        if let Some(what) = failure(outcome) {
            self.found
                .entry(what)
                .or_insert_with(|| format!("{bytes:?}"));
        }
    }

    fn text(&mut self, text: &str) {
        // Written first, since a stack that overflows leaves no time.
        let _ = std::fs::write(&self.case, text);
        let before = forget_peak();
        let (outcome, took) = try_text(text, self.random.below(4) == 0);
        let memory = peak().saturating_sub(before);
        if took > self.longest.0 {
            self.longest = (took, text.to_owned());
        }
        if memory > self.largest.0 {
            self.largest = (memory, text.to_owned());
        }
        let mut what = outcome.err();
        if what.is_none() && memory > MEMORY {
            what = Some(format!("needs {memory} kB"));
        }
        let Some(what) = what else {
            return;
        };
        let key = kind_of(&what);
        // There are many ways to be slow, so each is looked at until there are some.
        let is_slow = key == SLOWNESS;
        if is_slow && self.slow >= MAX_SLOW || !is_slow && self.found.contains_key(&key) {
            return;
        }
        self.slow += usize::from(is_slow);
        let small = smaller(text, &key);
        let name = format!("sinew-fuzz-{}.rat", self.found.len());
        let key = if is_slow { kind_of(&small) } else { key };
        if self.found.contains_key(&key) {
            return;
        }
        let _ = std::fs::write(self.case.with_file_name(name), &small);
        println!("found: {what}\n{}", head(&small));
        self.found.insert(key, small);
    }
}

/// Name of a finding, so that it is reported once: its first words without numbers.
fn kind_of(what: &str) -> String {
    if what.starts_with(SLOWNESS) {
        return SLOWNESS.to_owned();
    }
    what.chars()
        .filter(|c| !c.is_ascii_digit())
        .take(90)
        .collect()
}

/// Runs all checks on a text; gives what does not hold, and how long the compile took.
fn try_text(text: &str, thorough: bool) -> (Result<(), String>, Duration) {
    let project: Project = check::project(text, "sphere m0 1 0 0 0\nvar v0 = 2\n");
    let mut took = Duration::ZERO;
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        let begun = processor_time();
        let compiled = compile(&project);
        took = processor_time() - begun;
        check::result(&project, &compiled)?;
        check::unrun(text)?;
        if thorough {
            check::layout(&project, &compiled)?;
            // Places all over the text, the same ones when the text is run again.
            for part in 0..8 {
                check::help(&project, &compiled, text.len() * part / 7 + 2 * (part / 7))?;
            }
            check::repeats(&project, &compiled)?;
            check::sharing(&project)?;
        }
        Ok(())
    }));
    // On a machine that does other work as well a slow compile may only have been unlucky.
    for _ in 0..2 {
        if took > SLOW {
            let begun = processor_time();
            let _ = catch_unwind(AssertUnwindSafe(|| compile(&project)));
            took = took.min(processor_time() - begun);
        }
    }
    match failure(outcome) {
        Some(what) => (Err(what), took),
        None if took > SLOW => (Err(format!("{SLOWNESS}: {took:?}")), took),
        None => (Ok(()), took),
    }
}

type Caught = Result<Result<(), String>, Box<dyn std::any::Any + Send>>;

fn failure(outcome: Caught) -> Option<String> {
    match outcome {
        Ok(held) => held.err(),
        Err(panic) => {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
            Some(format!("panic: {}", text.unwrap_or("without a word")))
        }
    }
}

/// Leaves out lines, then words, as long as the same is found.
fn smaller(text: &str, key: &str) -> String {
    let begun = Instant::now();
    let mut text = text.to_owned();
    for by in [|c: char| c == '\n', |c: char| c == ' ' || c == '\n'] {
        let mut size = text.split_inclusive(by).count() / 2;
        while size > 0 && begun.elapsed() < PATIENCE {
            let mut at = 0;
            loop {
                let parts: Vec<&str> = text.split_inclusive(by).collect();
                if at >= parts.len() || begun.elapsed() > PATIENCE {
                    break;
                }
                let end = (at + size).min(parts.len());
                let without = [&parts[..at], &parts[end..]].concat().concat();
                let what = try_text(&without, true).0.err();
                if what.is_some_and(|what| kind_of(&what) == key) {
                    text = without;
                } else {
                    at += size;
                }
            }
            size /= 2;
        }
    }
    text
}

fn head(text: &str) -> String {
    let short: String = text.chars().take(600).collect();
    if short.len() < text.len() {
        format!("{short} …\n({} bytes)", text.len())
    } else {
        short
    }
}

/// Processor time of this thread; where the system does not tell it, time on the clock.
fn processor_time() -> Duration {
    static BEGUN: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    let begun = *BEGUN.get_or_init(Instant::now);
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|text| text.split(' ').next()?.parse().ok())
        .map_or_else(|| begun.elapsed(), Duration::from_nanos)
}

/// The most memory this process has had so far, kilobytes; 0 where the system does not tell it.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))
        .and_then(|rest| rest.trim().strip_suffix(" kB")?.parse().ok())
        .unwrap_or(0)
}

/// Lets the system measure the peak anew, and gives what is in use now.
fn forget_peak() -> u64 {
    // Without it the peak of the whole run is told, which still bounds that of each case.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
    peak()
}
