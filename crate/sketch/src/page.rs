//! The page that drawing begins with, and the materials of strokes.

use rats::Project;
use scene::Rgb;

/// The colours to draw with, and their names.
pub const COLOURS: [(&str, Rgb); 8] = [
    ("Apricot", [0.86, 0.52, 0.3]),
    ("Brick", [0.66, 0.22, 0.16]),
    ("Sand", [0.85, 0.74, 0.54]),
    ("Leaf", [0.36, 0.55, 0.27]),
    ("Water", [0.22, 0.45, 0.62]),
    ("Plum", [0.46, 0.28, 0.5]),
    ("Snow", [0.9, 0.9, 0.88]),
    ("Night", [0.07, 0.07, 0.09]),
];

/// The command of the page's ground, up to its height.
const GROUND: &str = "ground <0.72 0.70 0.62>, height ";

/// Returns the text of an empty page to draw on: seen from the side and a little from the front, so
/// that both limbs of a pair are seen. `ratio`: height by width of its place.
#[must_use]
pub fn fresh(ratio: f64) -> String {
    let ratio = if ratio.is_finite() {
        ratio.clamp(0.75, 1.7)
    } else {
        0.75
    };
    let is_high = ratio > 1.0;
    let (width, eye, across) = if is_high {
        (480.0, "8.8 2.3 4.6", 39.2_f64)
    } else {
        (640.0, "7.7 2 4", 46.8)
    };
    let height = 10.0 * libm::round(0.1 * width * ratio);
    let up = libm::tan(0.5 * across.to_radians()) * height / width;
    let up = libm::round(20.0 * libm::atan(up).to_degrees()) / 10.0;
    let skin = surface(COLOURS[0].1, true);
    format!(
        "\
# Drawn by hand. The strokes are the curves of the skeleton at the end.
eyep {eye}
vrp 0 0.1 0
vup 0 1 0
fov {across} {up}
framesize {width} {height}
sample 2

background <0.78 0.86 0.92> to <0.93 0.93 0.90>
light <1 0.96 0.9>, position 7 9 3
light <0.3 0.34 0.4>, position 2 4 -9
{GROUND}-1.5

surface Skin, {skin}
"
    )
}

/// Returns the bytes of the height of the page's ground; `None` if a text has no such ground, or no
/// plain number there.
#[must_use]
pub fn ground(text: &str) -> Option<std::ops::Range<usize>> {
    let starts = text.match_indices(GROUND).map(|(at, _)| at);
    let start = starts
        .filter(|at| *at == 0 || text[..*at].ends_with('\n'))
        .map(|at| at + GROUND.len())
        .next()?;
    let line = text[start..].lines().next()?;
    line.parse::<f64>().ok()?;
    Some(start..start + line.len())
}

/// Returns the fields of a material: soft, or hard and shiny.
fn surface(colour: Rgb, soft: bool) -> String {
    let [r, g, b] = colour;
    if soft {
        format!(
            "kernel cauchy, diffuse <{r} {g} {b}>, specular Gray40, shine 30, radius 0.2, \
                blobbiness -2"
        )
    } else {
        format!("diffuse <{r} {g} {b}>, specular White, shine 90")
    }
}

/// Returns the texts of a project.
pub fn texts(project: &Project) -> impl Iterator<Item = &str> {
    project.files.iter().map(|file| file.text.as_str())
}

/// Returns the first text of a project with a material of a colour, and the material's name: one
/// with the same fields, or a new one at the end. `None` if the project is empty.
#[must_use]
pub fn with_surface(project: &Project, colour: Rgb, soft: bool) -> Option<(String, String)> {
    let text = &project.files.first()?.text;
    let fields = surface(colour, soft);
    let known = text.lines().find_map(|line| {
        let name = line.strip_prefix("surface ")?.strip_suffix(&fields)?;
        name.strip_suffix(", ")
    });
    if let Some(name) = known {
        return Some((text.clone(), name.to_owned()));
    }
    let known = COLOURS.iter().find(|(_, rgb)| *rgb == colour);
    let stem = known.map_or("Colour", |(name, _)| name);
    let stem = format!("{stem}{}", if soft { "Skin" } else { "Bead" });
    let name = crate::free_name(texts(project), &stem);
    let line = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let mut text = text.clone();
    if !text.is_empty() && !text.ends_with('\n') {
        text += line;
    }
    text += &format!("surface {name}, {fields}{line}");
    Some((text, name))
}
