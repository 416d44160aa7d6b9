//! `cargo xtask pins`: renews `tests/pins.txt`, the hashes that pictures are held to, and shows what has changed since the
//! commit that renewed them last.
//!
//! The repository keeps no pictures: the old ones are drawn by that commit, checked out in a folder of its own.
//! New and old ones come from the same test, `crate/worker/tests/pins.rs`.

use crate::examples::write_picture;
use crate::shell::{artifacts, cargo, command, executable, read, root, run, run_and_read, target};
use anyhow::{Context, Result, bail};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

const FILE: &str = "tests/pins.txt";
const HEAD: &str = "\
# Hashes of traced pictures of 256x256 pixels, at most 2x2 rays a pixel: NAME PASS SIDE HASH. Where SIDE is less than 256, only
# a square of SIDExSIDE pixels in the middle of the picture is traced, as the rest would take minutes.
# crate/worker/tests/pins.rs compares them, natively and as wasm. Written by: cargo xtask pins
";

/// Hashes (`SIDE HASH`) by picture (`NAME PASS`).
type Pins = BTreeMap<String, String>;

/// Draws all pictures, writes their hashes, and old and new pictures side by side where they differ.
pub fn renew() -> Result<()> {
    let folder = target().join("pins");
    if folder.exists() {
        fs::remove_dir_all(&folder)?;
    }
    let lines = draw(&root(), &folder.join("new"))?;
    let new = pins(&lines);
    fs::write(root().join(FILE), HEAD.to_owned() + &lines)?;
    let commit = read(&mut command(
        "git",
        &["log", "-1", "--format=%H", "--", FILE],
    ));
    let Some(commit) = commit.filter(|commit| !commit.is_empty()) else {
        println!("\n{} pictures; no commit has pins of them yet.", new.len());
        return Ok(());
    };
    let old = read(&mut command("git", &["show", &format!("{commit}:{FILE}")]))
        .with_context(|| format!("git does not show {FILE} of {commit}"))?;
    let old = pins(&old);
    let names: BTreeSet<&String> = old.keys().chain(new.keys()).collect();
    let changed: Vec<&str> = names
        .into_iter()
        .filter(|name| old.get(*name) != new.get(*name))
        .map(String::as_str)
        .collect();
    if changed.is_empty() {
        println!("\nNo picture has changed since {commit}.");
        return Ok(());
    }
    let drawn = pins(&draw_old(&commit, &folder.join("old"))?);
    println!("\nChanged since {commit}:");
    for name in &changed {
        let said = match (old.get(*name), new.get(*name)) {
            (None, _) => String::from("new"),
            (_, None) => String::from("gone"),
            (Some(pin), _) if drawn.get(*name) != Some(pin) => {
                String::from("that commit draws something else than it pins")
            }
            _ => show(&folder, name)?,
        };
        println!("  {name}: {said}");
    }
    println!(
        "{FILE} is renewed. Old, new and difference side by side: {}",
        folder.display()
    );
    Ok(())
}

/// The pins of a text; lines that begin with `#` are comments.
fn pins(text: &str) -> Pins {
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .filter_map(|line| {
            let (at, _) = line.match_indices(' ').nth(1)?;
            let (picture, pin) = line.split_at(at);
            Some((picture.to_owned(), pin.trim().to_owned()))
        })
        .collect()
}

/// Draws all pictures of a checkout into a folder and gives their pins, a line each.
fn draw(checkout: &Path, folder: &Path) -> Result<String> {
    fs::create_dir_all(folder)?;
    let build = [
        "test",
        "--no-run",
        "--package",
        "worker",
        "--test",
        "pins",
        "--message-format",
        "json-render-diagnostics",
    ];
    // Other packages are found built in the same target folder.
    let mut cargo = cargo(&build);
    cargo
        .current_dir(checkout)
        .env("CARGO_TARGET_DIR", target());
    let test = executable(&artifacts(&mut cargo)?, "pins")?;
    let output = run_and_read(
        command(&test, &["--nocapture", "pictures_are_as_pinned"])
            .current_dir(checkout.join("crate/worker"))
            .env("SINEW_PICTURES", folder),
    )?;
    let lines: String = output
        .lines()
        .filter_map(|line| line.strip_prefix("pin "))
        .flat_map(|line| [line, "\n"])
        .collect();
    if lines.is_empty() {
        bail!("the test of the pins has drawn nothing");
    }
    Ok(lines)
}

/// The same with an older commit.
fn draw_old(commit: &str, folder: &Path) -> Result<String> {
    let checkout = target().join("pins/checkout");
    let path = checkout.to_string_lossy();
    run(&mut command("git", &["worktree", "prune"]))?;
    run(&mut command(
        "git",
        &["worktree", "add", "--detach", &path, commit],
    ))?;
    let drawn = draw(&checkout, folder);
    run(&mut command(
        "git",
        &["worktree", "remove", "--force", &path],
    ))?;
    drawn
}

/// Writes the old picture, the new one and their difference side by side, and says how much they differ.
fn show(folder: &Path, name: &str) -> Result<String> {
    let file = name.replace(['/', ' '], "-");
    let [old, new] = ["old", "new"].map(|which| {
        let path = folder.join(which).join(format!("{file}.ppm"));
        let bytes = fs::read(&path).with_context(|| path.display().to_string())?;
        pixels(&bytes).with_context(|| format!("{} is no picture", path.display()))
    });
    let ((width, old), (other, new)) = (old?, new?);
    if width != other {
        return Ok(format!("{width} pixels wide before, {other} now"));
    }
    let Difference { largest, count } = difference(&old, &new);
    let row = 3 * width as usize;
    let mut beside = Vec::new();
    for (old, new) in old.chunks_exact(row).zip(new.chunks_exact(row)) {
        beside.extend(old);
        beside.extend(new);
        // The largest difference is shown as white.
        let scaled = |(a, b): (&u8, &u8)| {
            (255 * u32::from(a.abs_diff(*b)) / u32::from(largest.max(1))) as u8
        };
        beside.extend(old.iter().zip(new).map(scaled));
    }
    let picture = folder.join(format!("{file}.png"));
    write_picture(&picture, 3 * width, &beside)?;
    Ok(format!(
        "{count} pixels differ, by up to {largest} of 255 ({})",
        picture.display()
    ))
}

/// Width and RGB bytes of a square picture as the test writes them.
fn pixels(file: &[u8]) -> Option<(u32, Vec<u8>)> {
    let end = file.iter().position(|&byte| byte == b'\n')?;
    let head = std::str::from_utf8(&file[..end]).ok()?;
    let side: u32 = head.split(' ').nth(1)?.parse().ok()?;
    let bytes = file[end + 1..].to_vec();
    (side > 0 && bytes.len() == 3 * (side as usize).pow(2)).then_some((side, bytes))
}

/// How much two pictures of the same size differ.
#[derive(Debug, PartialEq)]
struct Difference {
    /// The largest difference of a channel.
    largest: u8,
    /// Pixels that differ.
    count: usize,
}

fn difference(old: &[u8], new: &[u8]) -> Difference {
    let channels = old.iter().zip(new).map(|(a, b)| a.abs_diff(*b));
    let pixels = old.chunks_exact(3).zip(new.chunks_exact(3));
    Difference {
        largest: channels.max().unwrap_or(0),
        count: pixels.filter(|(a, b)| a != b).count(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pins_and_pictures_are_read_and_compared() {
        let read = pins("# comment\nexample/a Full 256 0a\nbench/a Smooth 64 0b\n");
        assert_eq!(read["example/a Full"], "256 0a");
        assert_eq!(read["bench/a Smooth"], "64 0b");
        assert_eq!(read.len(), 2);
        let picture = pixels(b"P6 1 1 255\nabc");
        assert_eq!(picture, Some((1, b"abc".to_vec())));
        assert_eq!(pixels(b"P6 1 1 255\nab"), None);
        let [old, new] = [[9, 9, 9, 5, 5, 5], [9, 9, 9, 5, 7, 1]];
        let (largest, count) = (4, 1);
        assert_eq!(difference(&old, &new), Difference { largest, count });
    }
}
