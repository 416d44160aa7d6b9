//! Memory and times of skeletons of many limbs from files.

use crate::report::{Report, Short, or_dash};
use crate::sinew::Sinew;
use anyhow::Result;
use std::fmt::Write;
use std::fs;

/// Numbers of limbs.
const COUNTS: [usize; 3] = [1_000, 10_000, 100_000];
/// Sides of the picture, pixels.
const SIDE: &str = "512";
/// Distance of the nodes, in which radii are from 0.05 to 0.11.
const APART: f64 = 1.0;

/// Measures.
pub fn measure() -> Result<Report> {
    let sinew = Sinew::new()?;
    let mut report = Report::default();
    for count in COUNTS {
        let name = format!("limbs-{count}");
        let (file, side) = write(count);
        fs::write(sinew.path(&format!("{name}.obj")), &file)?;
        let far = 2.2 * side;
        let text = format!(
            "light White, position {far} {} {far}\neyep {far} {} {}\nvrp {m} {m} {m}\nfov 34\n\
             surface Steel, diffuse Gray70\nskeleton Steel, LATTICE {name}.obj\n",
            2.0 * far,
            0.8 * far,
            1.4 * far,
            m = 0.5 * side
        );
        let dataset = sinew.path(&format!("{name}.rat"));
        fs::write(&dataset, text)?;
        let cost = sinew.time(&[&dataset, "--size", SIDE, SIDE])?;
        let [size, each] = [f64::from(1 << 20), count as f64]
            .map(|unit| or_dash(cost.memory.map(|bytes| Short(bytes / unit))));
        let (seconds, prepare) = (Short(cost.seconds), Short(cost.prepare));
        let bytes = Short(file.len() as f64 / f64::from(1 << 20));
        report.row(
            "scenes",
            format!("{count} | {bytes} | {size} | {each} | {seconds} | {prepare}"),
        );
    }
    Ok(report)
}

/// Numbers from 0 to 1 that look random: fractional parts of squares of multiples of the golden
/// ratio.
struct Numbers(f64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 += 0.618_033_988_749_895;
        libm::fmod(self.0 * self.0, 1.0)
    }
}

/// Writes limbs between neighbours of a cubic grid whose nodes are shifted, each with a radius of
/// its own at either end, as an OBJ file; returns it with the grid's side.
fn write(count: usize) -> (String, f64) {
    let side = (2..)
        .find(|n| 3 * n * n * (n - 1) >= count)
        .unwrap_or_default();
    let mut text = String::from("# vt: radius\n");
    let mut numbers = Numbers(0.0);
    for i in 0..side * side * side {
        let cell = [i % side, i / side % side, i / side / side];
        let place = cell.map(|x| APART * (x as f64 + 0.5 * (numbers.next() - 0.5)));
        // Writing to a string does not fail.
        let _ = writeln!(text, "v {:.4} {:.4} {:.4}", place[0], place[1], place[2]);
    }
    let mut limbs = 0;
    for axis in [1, side, side * side] {
        for i in 0..side * side * side {
            if i / axis % side + 1 < side && limbs < count {
                limbs += 1;
                let radii = [0.05 + 0.06 * numbers.next(), 0.05 + 0.06 * numbers.next()];
                let _ = writeln!(
                    text,
                    "vt {:.4}\nvt {:.4}\nl {}/-2 {}/-1",
                    radii[0],
                    radii[1],
                    i + 1,
                    i + axis + 1
                );
            }
        }
    }
    (text, APART * (side - 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_as_many_limbs_as_wanted() {
        for count in [1, 54, 1000, 10_000] {
            let (text, _) = write(count);
            assert_eq!(
                text.lines().filter(|line| line.starts_with("l ")).count(),
                count
            );
        }
    }
}
