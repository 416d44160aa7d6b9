//! Plots of curves on two logarithmic axes, as SVG.

use std::fmt::Write;

/// A row of points, x and y both above 0.
pub struct Curve {
    /// Its name.
    pub title: String,
    /// The points, in order of x.
    pub points: Vec<[f64; 2]>,
}

/// One plot beside others.
pub struct Panel {
    /// The measured quantity.
    pub title: String,
    /// The quantity that it grows with.
    pub across: String,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// Size of a panel and the room around its axes, in pixels.
const SIZE: [f64; 2] = [360.0, 280.0];
const ROOM: [f64; 4] = [56.0, 24.0, 20.0, 44.0];
const COLOURS: [&str; 4] = ["#1f6f8b", "#c2571a", "#5b8a2d", "#7a4b94"];

/// The picture of some panels, side by side.
pub fn svg(panels: &[Panel]) -> String {
    let [width, height] = [SIZE[0] * panels.len() as f64, SIZE[1]];
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
    );
    for (number, panel) in panels.iter().enumerate() {
        out += &drawn(panel, SIZE[0] * number as f64);
    }
    out + "</svg>\n"
}

/// Whole powers of ten below and above all coordinates of one axis.
fn decades(panel: &Panel, axis: usize) -> [i32; 2] {
    let all = panel.curves.iter().flat_map(|curve| &curve.points);
    let logs = all.map(|point| libm::log10(point[axis]));
    let (low, high) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), log| {
        (low.min(log), high.max(log))
    });
    if low > high {
        return [0, 1];
    }
    let low = (low + 1e-9).floor() as i32;
    [low, (high.ceil() as i32).max(low + 1)]
}

fn drawn(panel: &Panel, left: f64) -> String {
    let [x0, x1, y1, y0] = [
        left + ROOM[0],
        left + SIZE[0] - ROOM[1],
        ROOM[2],
        SIZE[1] - ROOM[3],
    ];
    let [across, up] = [0, 1].map(|axis| decades(panel, axis));
    let share = |[low, high]: [i32; 2], log: f64| (log - f64::from(low)) / f64::from(high - low);
    let x = |log: f64| x0 + (x1 - x0) * share(across, log);
    let y = |log: f64| y0 + (y1 - y0) * share(up, log);
    let mut out = String::new();
    let mut add = |line: String| {
        out += &line;
        out.push('\n');
    };
    let text = |x: f64, y: f64, anchor: &str, colour: &str, what: &str| {
        format!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{colour}\">{what}</text>"
        )
    };
    let line = |a: [f64; 2], b: [f64; 2]| {
        format!(
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"#d8d8d8\"/>",
            a[0], a[1], b[0], b[1]
        )
    };
    for decade in across[0]..=across[1] {
        let at = x(f64::from(decade));
        add(line([at, y0], [at, y1]));
        add(text(at, y0 + 16.0, "middle", "#333333", &power(decade)));
    }
    for decade in up[0]..=up[1] {
        let at = y(f64::from(decade));
        add(line([x0, at], [x1, at]));
        add(text(x0 - 6.0, at + 4.0, "end", "#333333", &power(decade)));
    }
    add(text(
        0.5 * (x0 + x1),
        y0 + 34.0,
        "middle",
        "#333333",
        &panel.across,
    ));
    add(text(x0, y1 - 6.0, "start", "#333333", &panel.title));
    for (i, curve) in panel.curves.iter().enumerate() {
        let colour = COLOURS[i % COLOURS.len()];
        let mut points = String::new();
        for [a, b] in &curve.points {
            let (a, b) = (x(libm::log10(*a)), y(libm::log10(*b)));
            // A String takes any text.
            let _ = write!(points, "{a:.1},{b:.1} ");
        }
        let points = points.trim_end();
        add(format!(
            "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>"
        ));
        let row = y1 + 16.0 * (i as f64 + 1.0);
        add(text(x0 + 8.0, row, "start", colour, &curve.title));
    }
    out
}

/// A power of ten as people write it, if it is short.
fn power(decade: i32) -> String {
    match decade {
        0..=5 => 10u32.pow(decade.unsigned_abs()).to_string(),
        -3..=-1 => format!("{:.*}", decade.unsigned_abs() as usize, 10f64.powi(decade)),
        _ => format!("1e{decade}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_stand_between_whole_powers_of_ten() {
        let panel = |points: Vec<[f64; 2]>| Panel {
            title: "seconds".into(),
            across: "balls".into(),
            curves: vec![Curve {
                title: "Cauchy".into(),
                points,
            }],
        };
        let drawn = svg(&[
            panel(vec![[100.0, 0.02], [10_000.0, 1.0]]),
            panel(Vec::new()),
        ]);
        // From the lower left, a third of the way to 1 from 0.01 … to the upper right.
        assert!(
            drawn.contains("points=\"56.0,203.5 336.0,20.0\""),
            "{drawn}"
        );
        for label in [">100<", ">10000<", ">0.01<", ">1<", ">seconds<", ">Cauchy<"] {
            assert!(drawn.contains(label), "{label} in {drawn}");
        }
        assert!(!drawn.contains("NaN") && drawn.ends_with("</svg>\n"));
    }
}
