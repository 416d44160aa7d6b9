//! The program with fused multiply-adds, an option that no picture of ours is drawn with: how much sooner it is done, by how
//! much its pictures differ, and whether they are as near to the true surface.

use super::certify::certify;
use super::goal::short;
use super::ours;
use super::scenes::Scenes;
use super::series::alternate;
use crate::examples;
use crate::shell::{FUSED, command, run};
use anyhow::{Context, Result, bail};
use std::fmt::Write;
use std::path::Path;

/// The scenes that are drawn both ways.
const SCENES: [&str; 7] = [
    "flake-10",
    "flake-820",
    "flake-7381",
    "flake-820-cauchy",
    "coral",
    "seahorse",
    "tee",
];
/// Rounds of both in turn.
const ROUNDS: usize = 5;
/// How many rays are held against the reference.
const RAYS: &str = "100000";

/// Measures all of it.
pub fn measure() -> Result<String> {
    let scenes = Scenes::new()?;
    let fused = examples::sinew_built(FUSED)?;
    let mut page = format!(
        "The program built with `RUSTFLAGS=\"{}\"`: where a product is added to something both are rounded together. That is an \
         option for who wants pictures sooner; it does not draw the same bits as the page and other processors, so nothing here is \
         built so. Seconds of one processor, 512×512, one ray a pixel, the quickest of {ROUNDS} in turn; and how the smooth \
         pictures of both differ.\n\n\
         | scene | ours | fused | ours ÷ fused | pixels that differ | by at most, of 255 |\n|---|--:|--:|--:|--:|--:|\n",
        FUSED.flags
    );
    for scene in SCENES {
        let dataset = scenes.dataset(scene);
        let time = |program: &Path| Ok(ours::time(program, &[&dataset])?.seconds);
        let [ours, theirs] =
            alternate(ROUNDS, [&mut || time(&scenes.sinew), &mut || time(&fused)])?;
        let pictures = [("ours", &*scenes.sinew), ("fused", &*fused)].map(|(name, program)| {
            let picture = scenes.path(&format!("{scene}-{name}.png"));
            draw(program, &dataset, &picture)?;
            let (_, bytes) =
                examples::read_picture(&picture).with_context(|| picture.display().to_string())?;
            anyhow::Ok(bytes)
        });
        let [a, b] = pictures;
        let (pixels, most) = difference(&a?, &b?)?;
        writeln!(
            page,
            "| {scene} | {} | {} | {} | {pixels} | {most} |",
            ours.text(),
            theirs.text(),
            short(ours.best() / theirs.best())
        )?;
    }
    let rays = certified()?;
    writeln!(
        page,
        "\nIts pictures are held against the same reference as those of the part *Certified*, with {RAYS} rays:\n\n{rays}\n"
    )?;
    Ok(page)
}

/// Traces a picture to a file.
fn draw(program: &Path, dataset: &str, picture: &Path) -> Result<()> {
    let picture = picture.to_string_lossy();
    run(&mut command(
        program,
        &["render", dataset, "-o", &picture, "-r", "512", "512"],
    ))
}

/// How many pixels of four bytes differ, and by how much at most.
fn difference(a: &[u8], b: &[u8]) -> Result<(usize, u8)> {
    if a.len() != b.len() {
        bail!("the pictures are not of one size");
    }
    let (mut pixels, mut most) = (0, 0);
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        let apart = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max();
        let apart = apart.unwrap_or(0);
        pixels += usize::from(apart > 0);
        most = most.max(apart);
    }
    Ok((pixels, most))
}

/// Heading and totals of the table of the certifier, built with fused operations.
fn certified() -> Result<String> {
    let (_, output) = certify(RAYS, Some(FUSED))?;
    let table: Vec<&str> = output.lines().filter(|l| l.starts_with('|')).collect();
    let [heading, rule, .., all] = &table[..] else {
        bail!("the certifier wrote no table");
    };
    Ok([heading, rule, all].map(|line| &**line).join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_that_differ_are_counted() {
        let a = [0, 1, 2, 255, 9, 9, 9, 255, 0, 0, 0, 255];
        let mut b = a;
        assert_eq!(difference(&a, &b).unwrap(), (0, 0));
        b[1] = 4;
        b[2] = 1;
        b[8] = 1;
        assert_eq!(difference(&a, &b).unwrap(), (2, 3));
        assert!(difference(&a, &b[..8]).is_err());
    }
}
