//! `cargo xtask pins`: renews `tests/pins.txt`, the hashes that pictures must have, and shows the
//! changes since the commit that renewed them last.
//!
//! The repository keeps no pictures: the old ones are drawn by that commit, checked out in a folder
//! of its own. New and old ones come from the same test, `crate/worker/tests/it/pins.rs`.

use crate::pictures::{difference, write_picture};
use crate::shell::{cargo, command, read, root, run, run_and_read, target, words};
use anyhow::{Context, Result, bail};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

const FILE: &str = "tests/pins.txt";
const HEAD: &str = "\
# Hashes of traced pictures of 256x256 pixels, at most 2x2 rays a pixel: NAME PASS SIDE HASH. \
Where SIDE is less than 256, only
# a square of SIDExSIDE pixels in the middle of the picture is traced, \
as the rest would take minutes.
# crate/worker/tests/it/pins.rs compares them, natively and as wasm. Written by: cargo xtask pins
";

/// Hashes (`SIDE HASH`) by picture (`NAME PASS`).
type Pins = BTreeMap<String, String>;

/// Draws all pictures, writes their hashes, and old and new pictures side by side where they
/// differ.
pub fn renew() -> Result<()> {
    let folder = target().join("pins");
    if folder.exists() {
        fs::remove_dir_all(&folder)?;
    }
    let lines = draw(&root(), &folder.join("new"))?;
    fs::write(root().join(FILE), HEAD.to_owned() + &lines)?;
    let last = ["log", "-1", "--format=%H", "--", FILE];
    let commit = read(&mut command("git", &last)).unwrap_or_default();
    let old = read(&mut command("git", &["show", &format!("{commit}:{FILE}")]))
        .context("no commit has pins of the pictures yet")?;
    let (old, new) = (pins(&old), pins(&lines));
    let names: BTreeSet<&String> = old.keys().chain(new.keys()).collect();
    let changed = names
        .into_iter()
        .filter(|name| old.get(*name) != new.get(*name));
    let changed: Vec<&String> = changed.collect();
    if changed.is_empty() {
        println!("\nNo picture has changed since {commit}.");
        return Ok(());
    }
    let checkout = folder.join("checkout");
    let path = checkout.to_string_lossy();
    worktree(&["prune"])?;
    worktree(&["add", "--detach", &path, &commit])?;
    let result = draw(&checkout, &folder.join("old"));
    worktree(&["remove", "--force", &path])?;
    result?;
    println!("\nChanged since {commit}:");
    for name in changed {
        let change = match (old.contains_key(name), new.contains_key(name)) {
            (true, true) => show(&folder, name)?,
            (true, false) => String::from("gone"),
            _ => String::from("new"),
        };
        println!("  {name}: {change}");
    }
    let folder = folder.display();
    println!("{FILE} is renewed. Old, new and difference side by side: {folder}");
    Ok(())
}

/// Runs `git worktree`.
fn worktree(arguments: &[&str]) -> Result<()> {
    run(&mut command("git", &[&["worktree"], arguments].concat()))
}

/// Reads the pins of a text; lines that begin with `#` are comments.
fn pins(text: &str) -> Pins {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let pins = lines.filter_map(|line| match words(line)[..] {
        [name, pass, side, hash] => Some((format!("{name} {pass}"), format!("{side} {hash}"))),
        _ => None,
    });
    pins.collect()
}

/// Draws all pictures of a checkout into a folder and returns their pins, a line each.
fn draw(checkout: &Path, folder: &Path) -> Result<String> {
    fs::create_dir_all(folder)?;
    let test =
        "test --package worker --tests -- --nocapture --test-threads=1 pictures_are_as_pinned";
    // With the same target folder, other packages need not be built again.
    let output = run_and_read(
        cargo(&words(test))
            .current_dir(checkout)
            .env("CARGO_TARGET_DIR", target())
            .env("SINEW_PICTURES", folder),
    )?;
    // The first pin of a test follows the test's name in its line.
    let lines = output.lines().filter_map(|line| line.split_once("pin "));
    let lines: String = lines.flat_map(|(_, pin)| [pin, "\n"]).collect();
    if lines.is_empty() {
        bail!("the test of the pins has drawn nothing");
    }
    Ok(lines)
}

/// Reads width and RGB bytes of a square picture that the test has written.
fn read_pixels(path: &Path) -> Result<(u32, Vec<u8>)> {
    pixels(&fs::read(path)?).with_context(|| format!("{} is no picture", path.display()))
}

/// Writes the old picture, the new one and their difference side by side, and describes the
/// difference.
fn show(folder: &Path, name: &str) -> Result<String> {
    let file = name.replace(['/', ' '], "-");
    let (width, old) = read_pixels(&folder.join(format!("old/{file}.ppm")))?;
    let (other, new) = read_pixels(&folder.join(format!("new/{file}.ppm")))?;
    if width != other {
        return Ok(format!("{width} pixels wide before, {other} now"));
    }
    let (count, largest) = difference(&old, &new, 3);
    let row = 3 * width as usize;
    let mut beside = Vec::new();
    for (old, new) in old.chunks_exact(row).zip(new.chunks_exact(row)) {
        beside.extend([old, new].concat());
        // The largest difference is shown as white.
        let apart = old.iter().zip(new).map(|(a, b)| u32::from(a.abs_diff(*b)));
        beside.extend(apart.map(|apart| (255 * apart / u32::from(largest.max(1))) as u8));
    }
    let picture = folder.join(format!("{file}.png"));
    write_picture(&picture, 3 * width, &beside, None)?;
    let picture = picture.display();
    Ok(format!(
        "{count} pixels differ, by up to {largest} of 255 ({picture})"
    ))
}

/// Parses the file of a square picture as the test writes it. Returns width and RGB bytes.
fn pixels(file: &[u8]) -> Option<(u32, Vec<u8>)> {
    let end = file.iter().position(|&byte| byte == b'\n')?;
    let head = std::str::from_utf8(&file[..end]).ok()?;
    let side: u32 = head.split(' ').nth(1)?.parse().ok()?;
    let bytes = file[end + 1..].to_vec();
    (side > 0 && bytes.len() == 3 * (side as usize).pow(2)).then_some((side, bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pins_and_pictures_are_read() {
        let read = pins("# comment\nexample/a Full 256 0a\nbench/a Smooth 64 0b\n");
        assert_eq!(read["example/a Full"], "256 0a");
        assert_eq!(read["bench/a Smooth"], "64 0b");
        assert_eq!(read.len(), 2);
        assert_eq!(pixels(b"P6 1 1 255\nabc"), Some((1, b"abc".to_vec())));
        assert_eq!(pixels(b"P6 1 1 255\nab"), None);
    }
}
