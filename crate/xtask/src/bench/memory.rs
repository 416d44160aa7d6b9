//! How much memory very many elements take: the most that `sinew time --balls` ever had.

use super::goal::{Goal, Wanted, short};
use super::scenes::Scenes;
use super::{Piece, ours};
use anyhow::Result;
use std::fmt::Write;

/// Scenes of balls: how many, of which kernel, how many radii apart, the picture's sides. Cauchy's have fields without
/// end, so that a ray meets many more of them: they are further apart, and the pictures smaller.
const SCENES: [(&str, &str, &str, &str); 4] = [
    ("10000", "gauss", "3", "512"),
    ("100000", "gauss", "3", "512"),
    ("1000000", "gauss", "3", "512"),
    ("10000", "cauchy", "4", "64"),
];
/// The one of them that has a goal, and how much it may take, GiB.
const MANY: &str = "1000000";
const MOST: f64 = 1.5;

/// Measures.
pub fn measure() -> Result<Piece> {
    let scenes = Scenes::new()?;
    let mut page = String::from(
        "Balls spread evenly through a cube (`sinew time --balls`), one thread, one ray a pixel: the most memory that the \
         program had while it made the scene and its picture.\n\n\
         | balls | kernel | pixels | MiB | bytes a ball | s | of these preparing |\n|--:|---|--:|--:|--:|--:|--:|\n",
    );
    let mut goals = Vec::new();
    for (count, kernel, apart, side) in SCENES {
        let arguments = ["--balls", count, "--kernel", kernel, "--apart", apart];
        let cost = ours::time(
            &scenes.sinew,
            &[&arguments[..], &["--size", side, side]].concat(),
        )?;
        let bytes = cost
            .memory
            .ok_or_else(|| String::from("this system does not tell"));
        let told = |unit: f64| {
            bytes
                .as_ref()
                .map_or("–".into(), |bytes| short(bytes / unit))
        };
        writeln!(
            page,
            "| {count} | {kernel} | {side}² | {} | {} | {} | {} |",
            told(f64::from(1 << 20)),
            told(cost.elements),
            short(cost.seconds),
            short(cost.prepare)
        )?;
        if count == MANY {
            goals.push(Goal {
                what: format!("memory of {count} elements"),
                against: "natively, one thread".into(),
                wanted: Wanted::AtMost(MOST),
                unit: " GiB",
                measured: bytes.map(|bytes| bytes / f64::from(1 << 30)),
            });
        }
    }
    page.push('\n');
    Ok((goals, page))
}
