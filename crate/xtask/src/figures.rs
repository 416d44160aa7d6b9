//! `cargo xtask figures`: the page `www/figures.html`, which shows the figures of Sherstyuk's thesis as this renderer draws them, each
//! with a link that opens its dataset.

use crate::examples::{draw_into, program};
use crate::shell::{command, read, root, target};
use anyhow::{Context, Result};
use std::fmt::Write;
use std::path::Path;

/// The pixels that a picture of the page fits into.
const BOX: [f64; 2] = [400.0, 300.0];

/// A picture of a figure.
struct Part {
    /// The example's file name, without its extension.
    example: &'static str,
    /// Its line below the picture.
    label: &'static str,
    /// Whether the offset surface is drawn in place of the convolution surface.
    hard: bool,
}

/// A figure of the thesis.
struct Figure {
    number: &'static str,
    title: &'static str,
    /// Its description in the thesis, in short.
    thesis: &'static str,
    parts: &'static [Part],
}

const fn soft(example: &'static str, label: &'static str) -> Part {
    Part {
        example,
        label,
        hard: false,
    }
}

const fn hard(example: &'static str, label: &'static str) -> Part {
    Part {
        example,
        label,
        hard: true,
    }
}

const OFFSET: &str = "offset surface";
const SURFACE: &str = "convolution surface";

#[rustfmt::skip]
const FIGURES: &[Figure] = &[
    Figure { number: "2.16", title: "Family of convolved starfish",
        thesis: "One skeleton of seven arcs; A is the skeleton itself, B to F are convolved with kernels of different widths and heights. The colours of the arms blend along the surface.",
        parts: &[soft("starfish-a", "A"), soft("starfish-b", "B"), soft("starfish-c", "C"), soft("starfish-d", "D"), soft("starfish-e", "E"), soft("starfish-f", "F")] },
    Figure { number: "2.17", title: "What they cost",
        thesis: "The same six as maps of the time that each pixel took, white for the longest.",
        parts: &[soft("time-map", "A to F")] },
    Figure { number: "2.18", title: "Modified sphereflakes",
        thesis: "Gaussian points blend with stems, which are Cauchy arcs.",
        parts: &[soft("stem-flakes", SURFACE)] },
    Figure { number: "2.19", title: "Blends of different shapes",
        thesis: "Arcs and lines; two triangles; arcs, lines and a plane.",
        parts: &[soft("blends", SURFACE)] },
    Figure { number: "2.20", title: "Coral tree",
        thesis: "The explicit and the implicit version of 31 branches and 512 spikes.",
        parts: &[hard("coral-tree", OFFSET), soft("coral-tree", SURFACE)] },
    Figure { number: "3.9", title: "Shell I",
        thesis: "361 points on a spiral; both versions are very similar.",
        parts: &[hard("shell-1", OFFSET), soft("shell-1", SURFACE)] },
    Figure { number: "3.10", title: "Shell II",
        thesis: "42 cylinders that share one end.",
        parts: &[hard("shell-2", OFFSET), soft("shell-2", SURFACE)] },
    Figure { number: "3.11", title: "Shell III",
        thesis: "An orange base of 55 segments blends with a spiral row of 15 red horns.",
        parts: &[hard("shell-3", OFFSET), soft("shell-3", SURFACE)] },
    Figure { number: "3.12", title: "Spindle cowrie",
        thesis: "A croissant of three arcs and a hundred cylinders.",
        parts: &[hard("cowrie", OFFSET), soft("cowrie", SURFACE)] },
    Figure { number: "3.13", title: "Seaweed",
        thesis: "A tree whose branches are shaped by linear profiles.",
        parts: &[hard("seaweed", OFFSET), soft("seaweed", SURFACE)] },
    Figure { number: "3.14", title: "Coral trees",
        thesis: "The seaweed's skeleton with 512 spikes, scattered at random.",
        parts: &[hard("coral-tree", OFFSET), soft("coral-tree", SURFACE)] },
    Figure { number: "3.15", title: "Seahorse",
        thesis: "43 arcs and two spheres, drawn by hand; note the wrinkles in the back and the tail.",
        parts: &[hard("seahorse", OFFSET), soft("seahorse", SURFACE)] },
    Figure { number: "3.16", title: "Coral crab",
        thesis: "Seven polygons, 26 arcs, 28 cylinders and two spheres; the convolved version has 608 spikes more.",
        parts: &[hard("coral-crab", OFFSET), soft("coral-crab", SURFACE)] },
    Figure { number: "3.17", title: "How to make volumetric wrinkles",
        thesis: "A place is chosen, its arc pulled out, split into halves of which one is modulated by a sine wave, and put back.",
        parts: &[soft("wrinkles", "A to D, from the left")] },
    Figure { number: "3.18", title: "Nefertiti",
        thesis: "1,242 triangles before and after convolution; blending that is restricted near the edges makes the wrinkles. (The thesis's mesh is lost; this one is ours.)",
        parts: &[soft("queen", "mesh, convolution, restricted")] },
    Figure { number: "3.19", title: "Aging Yoda",
        thesis: "3,422 triangles, as a mesh and as convolution surfaces. (The mesh is ours.)",
        parts: &[soft("elder", "mesh, convolution, restricted")] },
    Figure { number: "4.7", title: "Sphereflakes",
        thesis: "10, 91, 820 and 7,381 Gaussian points; smaller ones have lighter colours.",
        parts: &[soft("flakes", "A to D")] },
    Figure { number: "4.9", title: "Two sea urchins",
        thesis: "Left: spikes thinner than a pixel are not missed. Right: a map of u and v that cross-dissolves over the blend.",
        parts: &[soft("sea-urchin", "thin spikes"), soft("urchin-patterns", "cross-dissolved map")] },
    Figure { number: "4.10", title: "Coral tree",
        thesis: "Offset surface and smooth implicit surface, with a Gaussian kernel.",
        parts: &[hard("coral-tree", OFFSET), soft("coral-tree", SURFACE)] },
    Figure { number: "4.11", title: "Large Hermite crab",
        thesis: "988 elements; segments of the legs do not blend with each other, most other parts do.",
        parts: &[hard("hermite-crab", OFFSET), soft("hermite-crab", SURFACE)] },
    Figure { number: "4.12", title: "Spinal Starecase",
        thesis: "333 cylinders and 145 spheres, and the convolution surface of 333 lines and 38 Gaussian points with 107 spheres.",
        parts: &[hard("spinal-starecase", OFFSET), soft("spinal-starecase", SURFACE)] },
];

/// The text with its surfaces drawn as offset surfaces.
fn hardened(text: &str) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let shoot = lines.iter().rposition(|line| line.trim() == "shoot");
    lines.insert(shoot.unwrap_or(lines.len()), "soft off");
    lines.join("\n") + "\n"
}

/// Draws the pictures that are older than their datasets, and writes the page.
pub fn figures() -> Result<()> {
    let sinew = program()?;
    let folder = root().join("www/figures");
    std::fs::create_dir_all(&folder)?;
    let scratch = target().join("figures");
    std::fs::create_dir_all(&scratch)?;
    let mut page = String::from(HEAD);
    page += "<nav><p>";
    for figure in FIGURES {
        let _ = write!(
            page,
            "<a class=\"c\" href=\"#figure-{0}\">{0}</a> ",
            figure.number
        );
    }
    page += "</p></nav>\n";
    for figure in FIGURES {
        let _ = write!(
            page,
            "<section id=\"figure-{0}\">\n<h3>{0} {1}</h3>\n<p>{2}</p>\n<div class=\"figures\">\n",
            figure.number, figure.title, figure.thesis
        );
        for part in figure.parts {
            show(&mut page, &sinew, &folder, &scratch, part)
                .with_context(|| format!("figure {}, {}", figure.number, part.example))?;
        }
        page += "</div>\n</section>\n";
    }
    page += "</main>\n</html>\n";
    for entry in std::fs::read_dir(&folder)? {
        let path = entry?.path();
        let name = path
            .file_name()
            .map(|name| name.to_string_lossy().into_owned());
        if name.is_some_and(|name| !page.contains(&format!("figures/{name}\""))) {
            std::fs::remove_file(path)?;
        }
    }
    std::fs::write(root().join("www/figures.html"), page)?;
    Ok(())
}

/// Draws a part if its picture is not newer than its dataset, and writes its place on the page.
fn show(page: &mut String, sinew: &Path, folder: &Path, scratch: &Path, part: &Part) -> Result<()> {
    let dataset = root()
        .join("www/examples")
        .join(format!("{}.rat", part.example));
    let original = dataset.clone();
    let (name, text, link);
    if part.hard {
        name = format!("{}-offset", part.example);
        text = scratch.join(format!("{name}.rat"));
        std::fs::write(&text, hardened(&std::fs::read_to_string(&dataset)?))?;
        let path = text.to_string_lossy();
        let shared = read(&mut command(sinew, &["share", &path]));
        link = shared.with_context(|| format!("{path} has errors"))?;
    } else {
        name = part.example.to_owned();
        text = dataset;
        link = format!("#example={name}");
    }
    let picture = folder.join(format!("{name}.png"));
    if !is_newer(&picture, &original) {
        draw_into(sinew, &text, &picture, BOX)?;
    }
    let (info, _) = crate::examples::read_picture(&picture)?;
    let _ = write!(
        page,
        "<figure><a href=\"./{link}\"><img src=\"figures/{name}.png\" width=\"{}\" height=\"{}\" loading=\"lazy\" alt=\"{name}\"></a>\n\
         <figcaption>{} <a href=\"./{link}\">Open</a></figcaption></figure>\n",
        info.width,
        info.height,
        part.label,
        link = link.trim(),
    );
    Ok(())
}

/// Whether a file is there and newer than another.
fn is_newer(file: &Path, than: &Path) -> bool {
    let time = |path: &Path| path.metadata().and_then(|data| data.modified()).ok();
    matches!((time(file), time(than)), (Some(file), Some(than)) if file > than)
}

const HEAD: &str = r#"<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Sinew: figures of the thesis</title>
<link rel="stylesheet" href="reference.css">
<header>
<a href="./">Sinew</a>
<a class="aside" href="reference.html">The language</a>
</header>
<main>
<h1>Figures of the thesis</h1>
<p>Andrei Sherstyuk's thesis <cite>Convolution Surfaces in Computer Graphics</cite> (Monash University, 1998) pictures what its system RATS could draw.
Here are its figures anew: each dataset is written in the same language and drawn by Sinew. Open one, and take hold of it.</p>
"#;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offset_surfaces_are_asked_for_before_the_picture_is_taken() {
        assert_eq!(hardened("a\nshoot\nb\n"), "a\nsoft off\nshoot\nb\n");
        assert_eq!(hardened("a\n"), "a\nsoft off\n");
    }

    #[test]
    fn the_page_shows_every_figure_and_its_pictures_are_there() {
        let page = std::fs::read_to_string(root().join("www/figures.html")).expect("the page");
        let mut files = std::collections::BTreeSet::new();
        for figure in FIGURES {
            assert!(
                page.contains(&format!("id=\"figure-{}\"", figure.number)),
                "{}",
                figure.number
            );
            for part in figure.parts {
                let dataset = format!("www/examples/{}.rat", part.example);
                assert!(root().join(&dataset).is_file(), "{dataset}");
                let end = if part.hard { "-offset" } else { "" };
                let file = format!("{}{end}.png", part.example);
                assert!(page.contains(&format!("figures/{file}")), "{file}");
                assert!(root().join("www/figures").join(&file).is_file(), "{file}");
                files.insert(file);
            }
        }
        let kept = std::fs::read_dir(root().join("www/figures")).expect("the folder");
        assert_eq!(kept.count(), files.len(), "files that nothing uses");
    }
}
