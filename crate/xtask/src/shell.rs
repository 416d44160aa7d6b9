//! Running other programs, and finding them.

use anyhow::{Context, Result, bail};
use std::cell::Cell;
use std::ffi::{OsStr, OsString};
use std::io::{BufRead, BufReader, Read};
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::Mutex;

/// Returns the root of the repository.
pub fn root() -> PathBuf {
    // This program is built in the repository it works on.
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.ancestors().nth(2).unwrap_or(package).to_owned()
}

/// Returns the folder that cargo builds in.
pub fn target() -> PathBuf {
    root().join(std::env::var_os("CARGO_TARGET_DIR").unwrap_or("target".into()))
}

/// A way of building for this machine that is not `.cargo/config.toml`'s.
#[derive(Clone, Copy, Debug)]
pub struct Build {
    /// The folder in [`target`] that it builds in.
    pub folder: &'static str,
    /// Options of the compiler.
    pub flags: &'static str,
}

/// A build for any processor of this one's kind, where `.cargo/config.toml` asks for all features
/// of this one: slower, with the same bits.
pub const PORTABLE: Build = Build {
    folder: "portable",
    flags: "-C target-cpu=x86-64",
};

/// A build for this processor that may round a product and a sum once instead of twice: faster,
/// with other bits.
pub const FUSED: Build = Build {
    folder: "fused",
    flags: "-C target-cpu=native -C llvm-args=-fp-contract=fast",
};

impl Build {
    /// Returns environment variables for cargo.
    pub fn settings(self) -> [(&'static str, OsString); 2] {
        let target = self.target().into();
        [
            ("RUSTFLAGS", self.flags.into()),
            ("CARGO_TARGET_DIR", target),
        ]
    }

    /// Returns the folder that cargo builds in.
    pub fn target(self) -> PathBuf {
        target().join(self.folder)
    }
}

/// Returns a command that runs in the root of the repository.
pub fn command(program: impl AsRef<OsStr>, arguments: &[&str]) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root()).args(arguments);
    command
}

/// Returns a command of the cargo that runs this program.
pub fn cargo(arguments: &[&str]) -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
    command(cargo, arguments)
}

/// Returns the words of a line, as arguments of a command.
pub fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

thread_local! {
    /// A thread's lane: the name before each line that it and its programs write; empty where
    /// nothing else runs at the same time.
    static LANE: Cell<&'static str> = const { Cell::new("") };
}

/// Does something while other threads do something else: each line is marked with a name.
pub fn in_lane<T>(name: &'static str, work: impl FnOnce() -> T) -> T {
    let before = LANE.replace(name);
    let result = work();
    LANE.set(before);
    result
}

/// Writes a line.
pub fn tell(line: &str) {
    match LANE.get() {
        "" => println!("{line}"),
        lane => println!("{lane} | {line}"),
    }
}

/// Prints a command that is about to run.
pub fn say(command: &Command) {
    let program = Path::new(command.get_program()).file_name();
    let words = program.into_iter().chain(command.get_args());
    let words: Vec<_> = words.map(OsStr::to_string_lossy).collect();
    let root = format!("{}/", root().display());
    tell(&format!("$ {}", words.join(" ").replace(&root, "")));
}

/// Runs a command.
///
/// # Errors
/// If the command fails.
pub fn run(command: &mut Command) -> Result<()> {
    if LANE.get().is_empty() {
        say(command);
        let status = command.status();
        return check(command, status);
    }
    run_and_read(command).map(|_| ())
}

/// Runs a command, prints its output line by line as it comes, and returns its standard output.
pub fn run_and_read(command: &mut Command) -> Result<String> {
    pass_on(command, true)
}

/// Does several things in their order, as many at a time as there are cores, and returns their
/// results in that order.
pub fn at_once<T: Send>(work: Vec<impl FnOnce() -> T + Send>) -> Vec<T> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let (next, lane) = (Mutex::new(work.into_iter().enumerate()), LANE.get());
    let work_off = || {
        let tasks = std::iter::from_fn(|| next.lock().ok()?.next());
        in_lane(lane, || {
            tasks.map(|(i, work)| (i, work())).collect::<Vec<_>>()
        })
    };
    let mut results: Vec<(usize, T)> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..cores).map(|_| scope.spawn(work_off)).collect();
        let results = threads.into_iter().map(|thread| thread.join());
        results
            .flat_map(|results| results.unwrap_or_else(|panic| resume_unwind(panic)))
            .collect()
    });
    results.sort_by_key(|(i, _)| *i);
    results.into_iter().map(|(_, result)| result).collect()
}

/// Checks that a command has run and succeeded.
fn check(command: &Command, status: std::io::Result<ExitStatus>) -> Result<()> {
    let program = command.get_program().to_string_lossy();
    let status = status.with_context(|| format!("{program} could not be run"))?;
    if !status.success() {
        bail!("{program} failed ({status})");
    }
    Ok(())
}

/// Runs a command, prints its standard error, and its standard output if that is to be `shown`, and
/// returns the latter.
fn pass_on(command: &mut Command, shown: bool) -> Result<String> {
    say(command);
    let lane = LANE.get();
    command.stdout(Stdio::piped());
    if !lane.is_empty() {
        command.stderr(Stdio::piped());
    }
    let mut child = match command.spawn() {
        Ok(child) => child,
        Err(error) => return check(command, Err(error)).map(|()| String::new()),
    };
    let errors = child.stderr.take();
    let errors = std::thread::spawn(move || in_lane(lane, || lines(errors, true)));
    let output = lines(child.stdout.take(), shown);
    // The thread ends with the program.
    let _ = errors.join();
    check(command, child.wait())?;
    Ok(output)
}

/// Reads the output of a program to its end, and prints each line as it comes if it is to be
/// `shown`.
fn lines(from: Option<impl Read>, shown: bool) -> String {
    let mut all = String::new();
    let from = from.into_iter().map(BufReader::new);
    for line in from.flat_map(|from| from.split(b'\n')) {
        let line = line.unwrap_or_default();
        let line = String::from_utf8_lossy(&line);
        if shown {
            tell(&line);
        }
        all += &line;
        all.push('\n');
    }
    all
}

/// Returns the output of a command, trimmed; `None` if it fails.
pub fn read(command: &mut Command) -> Option<String> {
    let output = command.stderr(Stdio::null()).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout);
    output.status.success().then(|| text.trim().to_owned())
}

/// Returns the messages that a cargo command with `--message-format json-render-diagnostics`
/// writes.
pub fn messages(command: &mut Command) -> Result<Vec<serde_json::Value>> {
    let output = pass_on(command, false)?;
    let messages = output.lines();
    Ok(messages
        .filter_map(|line| serde_json::from_str(line).ok())
        .collect())
}

/// Returns the artifacts among the [`messages`] of a cargo command.
pub fn artifacts(command: &mut Command) -> Result<Vec<serde_json::Value>> {
    let mut artifacts = messages(command)?;
    artifacts.retain(|message| message["reason"] == "compiler-artifact");
    Ok(artifacts)
}

/// Returns the program or test of a name among cargo's artifacts.
pub fn executable(artifacts: &[serde_json::Value], name: &str) -> Result<PathBuf> {
    let mut own = artifacts
        .iter()
        .filter(|artifact| artifact["target"]["name"] == name);
    own.find_map(|artifact| Some(PathBuf::from(artifact["executable"].as_str()?)))
        .with_context(|| format!("cargo made no {name}"))
}

/// Returns the path of a program that can be called by this name.
pub fn find(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let file = Path::new(name).with_extension(std::env::consts::EXE_EXTENSION);
    std::env::split_paths(&path)
        .map(|folder| folder.join(&file))
        .find(|file| file.is_file())
}

/// Lists the files in a folder whose names end with this extension, in the order of their names.
pub fn files(folder: &Path, extension: &str) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder)?.filter_map(|entry| Some(entry.ok()?.path()));
    let mut files: Vec<_> = entries
        .filter(|path| path.extension() == Some(OsStr::new(extension)))
        .collect();
    files.sort();
    if files.is_empty() {
        bail!("{} holds no {extension} files", folder.display());
    }
    Ok(files)
}
