//! Running other programs, and finding them.

use anyhow::{Context, Result, bail};
use std::ffi::OsStr;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

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
    /// What the compiler is told.
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
    /// What to set for cargo.
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

/// A command that runs in the root of the repository.
pub fn command(program: impl AsRef<OsStr>, arguments: &[&str]) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root()).args(arguments);
    command
}

/// The cargo that runs this program.
pub fn cargo(arguments: &[&str]) -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    command(cargo, arguments)
}

/// Says what is run.
fn say(command: &Command) {
    let words: Vec<_> = std::iter::once(command.get_program())
        .chain(command.get_args())
        .map(|word| {
            let word = Path::new(word);
            let short = word.strip_prefix(root()).unwrap_or(word);
            short.to_string_lossy().into_owned()
        })
        .collect();
    let program = Path::new(&words[0]).file_name().unwrap_or_default();
    eprintln!("$ {} {}", program.to_string_lossy(), words[1..].join(" "));
}

/// Runs a command and fails if it fails.
pub fn run(command: &mut Command) -> Result<()> {
    say(command);
    let program = command.get_program().to_string_lossy().into_owned();
    let status = command
        .status()
        .with_context(|| format!("{program} could not be run"))?;
    if !status.success() {
        bail!("{program} failed ({status})");
    }
    Ok(())
}

/// Runs a command, passes on what it writes, line by line as it comes, and gives it back.
pub fn run_and_read(command: &mut Command) -> Result<String> {
    say(command);
    let program = command.get_program().to_string_lossy().into_owned();
    let mut child = command
        .stdout(Stdio::piped())
        .spawn()
        .with_context(|| format!("{program} could not be run"))?;
    let mut output = String::new();
    if let Some(stdout) = child.stdout.take() {
        for line in BufReader::new(stdout).lines() {
            let line = line?;
            println!("{line}");
            output.push_str(&line);
            output.push('\n');
        }
    }
    let status = child.wait()?;
    if !status.success() {
        bail!("{program} failed ({status})");
    }
    Ok(output)
}

/// What a command writes, if it succeeds.
pub fn read(command: &mut Command) -> Option<String> {
    let output = command.stderr(Stdio::null()).output().ok()?;
    output
        .status
        .success()
        .then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// What a cargo command with `--message-format json-render-diagnostics` says that it made.
pub fn artifacts(command: &mut Command) -> Result<Vec<serde_json::Value>> {
    let output = command.stderr(Stdio::inherit()).output()?;
    if !output.status.success() {
        bail!("this does not compile");
    }
    Ok(String::from_utf8_lossy(&output.stdout)
        .lines()
        .filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok())
        .filter(|message| message["reason"] == "compiler-artifact")
        .collect())
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
