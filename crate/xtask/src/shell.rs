//! Running other programs, and finding them.

use anyhow::{Context, Result, bail};
use std::cell::Cell;
use std::ffi::OsStr;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::Mutex;
use std::time::Instant;

/// The root of the repository.
pub fn root() -> PathBuf {
    // This program is built in the repository it works on.
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .unwrap_or(Path::new("."))
        .to_owned()
}

/// Where cargo puts what it builds.
pub fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR")
        .map_or_else(|| root().join("target"), |dir| root().join(dir))
}

/// A way of building for this machine that is not `.cargo/config.toml`'s.
#[derive(Clone, Copy, Debug)]
pub struct Build {
    /// The folder in [`target`] of what is built so.
    pub folder: &'static str,
    /// Options of the compiler.
    pub flags: &'static str,
}

/// For any processor of this one's kind, where `.cargo/config.toml` asks for all that this one can do: the same bits, later.
pub const PORTABLE: Build = Build {
    folder: "portable",
    flags: "-C target-cpu=x86-64",
};

/// For this processor, which may round a product and a sum once instead of twice: other bits, sooner.
pub const FUSED: Build = Build {
    folder: "fused",
    flags: "-C target-cpu=native -C llvm-args=-fp-contract=fast",
};

impl Build {
    /// Environment variables for cargo.
    pub fn settings(self) -> [(&'static str, std::ffi::OsString); 2] {
        [
            ("RUSTFLAGS", self.flags.into()),
            ("CARGO_TARGET_DIR", self.target().into()),
        ]
    }

    /// Where cargo puts what it builds so.
    pub fn target(self) -> PathBuf {
        target().join(self.folder)
    }
}

/// A command that runs in the root of the repository, and gives way to others where its lane does.
pub fn command(program: impl AsRef<OsStr>, arguments: &[&str]) -> Command {
    let mut command = if LANE.get().first {
        Command::new(program)
    } else {
        let mut nice = Command::new("nice");
        nice.args(["-n", "10"]).arg(program);
        nice
    };
    command.current_dir(root()).args(arguments);
    command
}

/// The cargo that runs this program.
pub fn cargo(arguments: &[&str]) -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    command(cargo, arguments)
}

/// A thread's prefix for output lines, and how its programs run.
#[derive(Clone, Copy, Debug)]
struct Lane {
    /// Stands before each line that the thread and its programs write; empty where nothing else runs at the same time.
    name: &'static str,
    /// Whether its programs go before those of others.
    first: bool,
}

thread_local! {
    static LANE: Cell<Lane> = const { Cell::new(Lane { name: "", first: true }) };
}

/// Does something while other threads do something else: each line is marked with a name, and programs give way to others if they
/// are not `first`.
pub fn in_lane<T>(name: &'static str, first: bool, work: impl FnOnce() -> T) -> T {
    // Only there programs are told to give way with `nice`.
    let first = first || !cfg!(unix);
    let before = LANE.replace(Lane { name, first });
    let done = work();
    LANE.set(before);
    done
}

/// A function that does something in another thread as in this one's lane.
pub fn in_this_lane<T>(work: impl FnOnce() -> T) -> impl FnOnce() -> T {
    let Lane { name, first } = LANE.get();
    move || in_lane(name, first, work)
}

/// Writes a line.
pub fn tell(line: &str) {
    tell_as(LANE.get().name, line);
}

fn tell_as(mark: &str, line: &str) {
    if mark.is_empty() {
        println!("{line}");
    } else {
        println!("{mark} | {line}");
    }
}

/// Says what is run.
pub fn say(command: &Command) {
    let words: Vec<_> = std::iter::once(command.get_program())
        .chain(command.get_args())
        .map(|word| {
            let word = Path::new(word);
            let short = word.strip_prefix(root()).unwrap_or(word);
            short.to_string_lossy().into_owned()
        })
        .collect();
    let program = Path::new(&words[0]).file_name().unwrap_or_default();
    tell(&format!(
        "$ {} {}",
        program.to_string_lossy(),
        words[1..].join(" ")
    ));
}

/// Runs a command and fails if it fails.
pub fn run(command: &mut Command) -> Result<()> {
    say(command);
    if !LANE.get().name.is_empty() {
        return pass_on(command, true).map(|_| ());
    }
    let status = command.status();
    succeeded(command, status)
}

/// Runs a command, passes on what it writes, line by line as it comes, and gives its standard output.
pub fn run_and_read(command: &mut Command) -> Result<String> {
    say(command);
    pass_on(command, true)
}

/// Runs a command, writes what it has written when it has ended, in one piece, as others run at the same time, and gives its
/// standard output.
pub fn run_apart(command: &mut Command) -> Result<String> {
    let begun = Instant::now();
    let program = command.get_program().to_string_lossy().into_owned();
    let done = command
        .stdin(Stdio::null())
        .output()
        .with_context(|| format!("{program} could not be run"))?;
    let [output, errors] = [&done.stdout, &done.stderr].map(|text| String::from_utf8_lossy(text));
    say(command);
    tell(&format!(
        "{output}{errors}({} s)",
        begun.elapsed().as_secs()
    ));
    succeeded(command, Ok(done.status))?;
    Ok(output.into_owned())
}

/// Does several things, as many at a time as there are cores, in their order, and gives what comes of them in that order.
pub fn at_once<T: Send>(work: Vec<impl FnOnce() -> T + Send>) -> Vec<T> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let results: Mutex<Vec<Option<T>>> = Mutex::new(work.iter().map(|_| None).collect());
    let next = Mutex::new(work.into_iter().enumerate());
    let take = || next.lock().ok()?.next();
    let some = || {
        while let Some((i, work)) = take() {
            let result = work();
            if let Ok(mut results) = results.lock() {
                results[i] = Some(result);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..cores {
            scope.spawn(in_this_lane(some));
        }
    });
    let results = results.into_inner().unwrap_or_else(|e| e.into_inner());
    results.into_iter().flatten().collect()
}

fn succeeded(command: &Command, status: std::io::Result<ExitStatus>) -> Result<()> {
    let program = command.get_program().to_string_lossy();
    let status = status.with_context(|| format!("{program} could not be run"))?;
    if !status.success() {
        bail!("{program} failed ({status})");
    }
    Ok(())
}

/// Runs a command, passes on what it writes to standard error, and to standard output if that is `shown`, and gives the latter.
fn pass_on(command: &mut Command, shown: bool) -> Result<String> {
    let mark = LANE.get().name;
    command.stdout(Stdio::piped());
    if !mark.is_empty() {
        command.stderr(Stdio::piped());
    }
    let program = command.get_program().to_string_lossy().into_owned();
    let mut child = command
        .spawn()
        .with_context(|| format!("{program} could not be run"))?;
    let errors = child.stderr.take().map(|errors| {
        std::thread::spawn(move || {
            for line in BufReader::new(errors).split(b'\n').map_while(Result::ok) {
                tell_as(mark, &String::from_utf8_lossy(&line));
            }
        })
    });
    let mut output = String::new();
    if let Some(stdout) = child.stdout.take() {
        for line in BufReader::new(stdout).split(b'\n') {
            let line = line?;
            let line = String::from_utf8_lossy(&line);
            if shown {
                tell(&line);
            }
            output.push_str(&line);
            output.push('\n');
        }
    }
    if let Some(errors) = errors {
        // It ends with the program.
        let _ = errors.join();
    }
    succeeded(command, child.wait())?;
    Ok(output)
}

/// Returns the output of a command, trimmed; `None` if it fails.
pub fn read(command: &mut Command) -> Option<String> {
    let output = command.stderr(Stdio::null()).output().ok()?;
    output
        .status
        .success()
        .then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// Returns the artifacts that a cargo command with `--message-format json-render-diagnostics` reports.
pub fn artifacts(command: &mut Command) -> Result<Vec<serde_json::Value>> {
    say(command);
    Ok(pass_on(command, false)?
        .lines()
        .filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok())
        .filter(|message| message["reason"] == "compiler-artifact")
        .collect())
}

/// The program or test of this name among what cargo has made.
pub fn executable(made: &[serde_json::Value], name: &str) -> Result<PathBuf> {
    made.iter()
        .filter(|made| made["target"]["name"] == name)
        .find_map(|made| Some(PathBuf::from(made["executable"].as_str()?)))
        .with_context(|| format!("cargo made no {name}"))
}

/// The path of a program that can be called by this name.
pub fn find(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path)
        .map(|folder| {
            folder
                .join(name)
                .with_extension(std::env::consts::EXE_EXTENSION)
        })
        .find(|file| file.is_file())
}
