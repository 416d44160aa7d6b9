//! Clouds of points: PLY and XYZ files.

use crate::error::{Error, fail};
use crate::problem::MAX_OBSERVATIONS;
use glam::DVec3;

/// Reads the points of a PLY file, or of a text with three numbers first in each line (`.xyz`):
/// what follows in a line is passed over, as are empty lines and those that begin with `#`.
///
/// # Errors
/// Says what cannot be read, and in which line.
///
/// ```
/// let points = fit::cloud("scan.xyz", b"# x y z\n0 1 2\n3.5 4 5 255 0 0\n")?;
/// assert_eq!(points[1].x, 3.5);
/// # Ok::<(), fit::Error>(())
/// ```
pub fn cloud(name: &str, bytes: &[u8]) -> Result<Vec<DVec3>, Error> {
    let points = if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
        mesh::read_points(bytes)?
    } else if name.to_ascii_lowercase().ends_with(".ply") {
        return fail("this is no PLY file: it does not begin with `ply`");
    } else {
        xyz(bytes)?
    };
    match points.len() {
        0 => fail("this cloud has no points"),
        count if count > MAX_OBSERVATIONS => fail(format!(
            "this cloud has {count} points, more than the {MAX_OBSERVATIONS} that a fit takes"
        )),
        _ => Ok(points),
    }
}

fn xyz(bytes: &[u8]) -> Result<Vec<DVec3>, Error> {
    let Ok(text) = core::str::from_utf8(bytes) else {
        return fail("clouds are read from .ply and .xyz files; this is neither");
    };
    let mut points = Vec::new();
    for (line, number) in text.lines().zip(1..) {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let words = line
            .split(|c: char| c.is_ascii_whitespace() || c == ',' || c == ';')
            .filter(|word| !word.is_empty());
        let mut values = words.take(3).map(|word| word.parse::<f64>().ok());
        let numbers = [0; 3].map(|_| values.next().flatten().filter(|v| v.is_finite()));
        let [Some(x), Some(y), Some(z)] = numbers else {
            return fail(format!("line {number}: three numbers are expected"));
        };
        points.push(DVec3::new(x, y, z));
        if points.len() > MAX_OBSERVATIONS {
            break;
        }
    }
    Ok(points)
}
