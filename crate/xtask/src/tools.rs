//! Installing what is missing.

use crate::shell::{command, find, read, root, run, tell, words};
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

/// The target of everything that runs in the page.
pub const WASM: &str = "wasm32-unknown-unknown";

/// Makes sure that Rust can compile for a target.
pub fn target(name: &str) -> Result<()> {
    let library = ["--print", "target-libdir", "--target", name];
    let library = read(&mut command("rustc", &library));
    if library.is_some_and(|folder| Path::new(&folder).is_dir()) {
        return Ok(());
    }
    run(&mut command("rustup", &["target", "add", name])).with_context(|| {
        format!(
            "The {name} target of Rust is missing. Install rustup (https://rustup.rs), then run: \
             rustup target add {name}"
        )
    })
}

/// The target of tests as wasm: like [`WASM`], with a way to write lines.
pub const WASI: &str = "wasm32-wasip1";

/// Returns a command that runs a program for [`WASI`] in node.
pub fn in_node(wasm: &Path) -> Command {
    let host = root().join("tests/wasi.mjs");
    command(
        "node",
        &[
            "--no-warnings",
            &host.to_string_lossy(),
            &wasm.to_string_lossy(),
        ],
    )
}

/// Makes sure that there is node, installed with apt-get on Debian.
pub fn node() -> Result<()> {
    const MISSING: &str =
        "Node.js is missing. Install Node.js 20 or newer with npm (https://nodejs.org)";
    let has_node = || find("node").is_some() && find("npm").is_some();
    if !has_node() && find("apt-get").is_some() {
        apt_install(&["nodejs", "npm"]).context(MISSING)?;
    }
    has_node().then_some(()).context(MISSING)
}

/// Installs the node packages of tests/package.json (browser driver, wasm optimiser) and returns
/// their folder.
pub fn node_packages() -> Result<PathBuf> {
    node()?;
    let tests = root().join("tests");
    let modules = tests.join("node_modules");
    // npm keeps a copy of the lock file of what it has installed.
    let wanted = std::fs::metadata(tests.join("package-lock.json"))?.modified()?;
    let installed = std::fs::metadata(modules.join(".package-lock.json"))
        .and_then(|file| file.modified())
        .ok();
    if installed.is_none_or(|installed| installed < wanted) {
        run(command("npm", &["ci", "--no-audit", "--no-fund"]).current_dir(&tests))
            .context("The node packages could not be installed; npm needs the network for it")?;
    }
    Ok(modules)
}

/// Returns the optimiser of wasm, if node is there.
pub fn wasm_opt() -> Option<PathBuf> {
    match node_packages() {
        Ok(modules) => Some(modules.join("binaryen/bin/wasm-opt")),
        Err(error) => {
            tell(&format!(
                "The wasm is not made smaller with wasm-opt: {error:#}"
            ));
            None
        }
    }
}

/// Installs packages of Debian.
///
/// # Errors
/// If `apt-get` fails, or this user may not install packages; the message says what to install.
fn apt_install(packages: &[&str]) -> Result<()> {
    // The lanes of a test wait for each other here: apt keeps a lock on its lists.
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _turn = ONE_AT_A_TIME.lock();
    let root_user = read(&mut command("id", &["-u"])).is_some_and(|id| id == "0");
    let sudo = if root_user { "" } else { "sudo -n" };
    let packages = packages.join(" ");
    for task in [
        "update",
        &format!("install -y --no-install-recommends {packages}"),
    ] {
        let line = format!("{sudo} apt-get -o DPkg::Lock::Timeout=500 {task}");
        let words = words(&line);
        run(command(words[0], &words[1..]).env("DEBIAN_FRONTEND", "noninteractive"))
            .with_context(|| format!("Install it: apt-get install {packages}"))?;
    }
    Ok(())
}

/// Returns a Firefox that tests can drive, installed with apt-get on Debian.
///
/// # Errors
/// If there is none and none can be installed.
pub fn firefox() -> Result<PathBuf> {
    if let Some(chosen) = std::env::var_os("FIREFOX") {
        return Ok(chosen.into());
    }
    if let Some(path) = find("firefox-esr").or_else(|| find("firefox")) {
        return Ok(path);
    }
    apt_install(&["firefox-esr"])
        .context("Firefox is missing. Install it, or set FIREFOX to its path")?;
    find("firefox-esr").context("apt-get installed no Firefox")
}

/// Returns the name of this system as `/etc/os-release` has it, or nothing.
fn system() -> String {
    let release = std::fs::read_to_string("/etc/os-release").unwrap_or_default();
    let name = release.lines().find_map(|line| line.strip_prefix("ID="));
    String::from(name.unwrap_or_default())
}

/// Returns whether there is a Vulkan driver, which on Debian and Ubuntu is installed if it is
/// missing: one that draws without a graphics card.
///
/// # Errors
/// If it could not be installed.
pub fn graphics_driver() -> Result<bool> {
    let folders = ["/usr/share", "/usr/local/share", "/etc"];
    let mut drivers = folders
        .map(|folder| format!("{folder}/vulkan/icd.d"))
        .into_iter();
    let is_there =
        drivers.any(|path| std::fs::read_dir(path).is_ok_and(|mut files| files.next().is_some()));
    if is_there {
        return Ok(true);
    }
    let installs = ["debian", "ubuntu"].contains(&system().as_str());
    if installs {
        apt_install(&["mesa-vulkan-drivers"]).context("The graphics driver is missing")?;
    }
    Ok(installs)
}

/// Returns the Chromium that is installed, if it runs.
fn find_chromium() -> Option<PathBuf> {
    let names = words("chromium chromium-browser google-chrome-stable google-chrome");
    // Ubuntu's /usr/bin/chromium-browser only says that there is a snap.
    let path = names.into_iter().find_map(find)?;
    read(&mut command(&path, &["--version"])).map(|_| path)
}

/// Returns a Chromium that tests can drive, installed with apt-get on Debian, by playwright
/// elsewhere.
pub fn chromium() -> Result<PathBuf> {
    const MISSING: &str =
        "The browser is missing. Install Chromium or Google Chrome, or set CHROMIUM to its path";
    if let Some(chosen) = std::env::var_os("CHROMIUM") {
        return Ok(chosen.into());
    }
    if let Some(path) = find_chromium() {
        return Ok(path);
    }
    let system = system();
    if system == "debian" {
        apt_install(&["chromium"]).context("The browser is missing")?;
        return find_chromium().context("apt-get installed no chromium that runs");
    }
    if system == "ubuntu" {
        // Ubuntu's own package is a snap, which does not run everywhere.
        let cli = node_packages()?.join("playwright-core/cli.js");
        let install = |options: &str| {
            let line = format!("install {options} chromium");
            run(command("node", &[&cli.to_string_lossy()]).args(words(&line)))
        };
        install("--with-deps")
            .or_else(|_| install(""))
            .context(MISSING)?;
        let script = "console.log(require('playwright-core').chromium.executablePath())";
        return read(command("node", &["-e", script]).current_dir(root().join("tests")))
            .map(PathBuf::from)
            .context("playwright does not say where it installed the browser");
    }
    bail!("{MISSING}.")
}
