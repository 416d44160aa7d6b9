//! `cargo xtask figures`: the page `www/figures.html`, which shows the figures of Sherstyuk's
//! thesis as this renderer draws them, each with a link that opens its dataset.

use crate::pictures::{draw, program, read_picture, size_within};
use crate::shell::{command, files, read, root, target};
use anyhow::{Context, Result};
use std::fs;
use std::path::Path;

/// The figures, separated by empty lines: number and title, the thesis's description in short, and
/// lines `EXAMPLE: LABEL`. If an example's name ends with [`OFFSET`], its offset surface is drawn
/// in place of the convolution surface.
const FIGURES: &str = include_str!("../figures.txt");
const OFFSET: &str = "-offset";
/// The head of the page.
const HEAD: &str = include_str!("../figures.html");

/// The pixels that a picture of the page fits into.
const BOX: [f64; 2] = [400.0, 300.0];

/// A figure: its number, its title, its description, and its pictures' names and labels.
type Figure<'a> = (&'a str, &'a str, &'a str, Vec<(&'a str, &'a str)>);

fn figures_of(text: &str) -> Option<Vec<Figure<'_>>> {
    let figures = text.trim_end().split("\n\n").map(|figure| {
        let (title, text) = figure.split_once('\n')?;
        let (thesis, parts) = text.split_once('\n')?;
        let (number, title) = title.split_once(' ')?;
        let parts = parts.lines().map(|line| line.split_once(": "));
        Some((number, title, thesis, parts.collect::<Option<_>>()?))
    });
    figures.collect()
}

/// Draws the pictures that are older than their datasets, and writes the page.
pub fn figures() -> Result<()> {
    let sinew = program()?;
    let folder = root().join("www/figures");
    fs::create_dir_all(&folder)?;
    let figures = figures_of(FIGURES).context("figures.txt cannot be read")?;
    let numbers = figures
        .iter()
        .map(|(number, ..)| format!("<a class=\"c\" href=\"#figure-{number}\">{number}</a> "));
    let numbers: String = numbers.collect();
    let mut page = format!("{HEAD}<nav><p>{numbers}</p></nav>\n");
    for (number, title, thesis, parts) in figures {
        page += &format!(
            "<section id=\"figure-{number}\">\n<h3>{number} {title}</h3>\n<p>{thesis}</p>\n\
             <div class=\"figures\">\n"
        );
        for (name, label) in parts {
            page +=
                &part(&sinew, name, label).with_context(|| format!("figure {number}, {name}"))?;
        }
        page += "</div>\n</section>\n";
    }
    page += "</main>\n</html>\n";
    for picture in files(&folder, "png")? {
        let name = picture.file_name().unwrap_or_default().to_string_lossy();
        if !page.contains(&format!("figures/{name}\"")) {
            fs::remove_file(&picture)?;
        }
    }
    Ok(fs::write(root().join("www/figures.html"), page)?)
}

/// Draws a picture if it is not newer than its dataset, and returns its place on the page.
fn part(sinew: &Path, name: &str, label: &str) -> Result<String> {
    let example = name.strip_suffix(OFFSET).unwrap_or(name);
    let dataset = root().join(format!("www/examples/{example}.rat"));
    let mut text = dataset.clone();
    let mut link = format!("#example={name}");
    if name != example {
        text = target().join(format!("{name}.rat"));
        fs::write(&text, use_offsets(&fs::read_to_string(&dataset)?))?;
        let share = ["share", &text.to_string_lossy()];
        link = read(&mut command(sinew, &share)).context("the dataset has errors")?;
    }
    let picture = root().join(format!("www/figures/{name}.png"));
    if !picture.exists() || picture.metadata()?.modified()? <= dataset.metadata()?.modified()? {
        draw(sinew, &text, &picture, size_within(sinew, &text, BOX)?, "4")?;
    }
    let (info, _) = read_picture(&picture)?;
    let (width, height) = (info.width, info.height);
    Ok(format!(
        "<figure><a href=\"./{link}\"><img src=\"figures/{name}.png\" \
         width=\"{width}\" height=\"{height}\" loading=\"lazy\" alt=\"{name}\"></a>\n\
         <figcaption>{label} <a href=\"./{link}\">Open</a></figcaption></figure>\n"
    ))
}

/// Changes a text so that its surfaces are drawn as offset surfaces.
fn use_offsets(text: &str) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let shoot = lines.iter().rposition(|line| line.trim() == "shoot");
    lines.insert(shoot.unwrap_or(lines.len()), "soft off");
    lines.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offset_surfaces_are_asked_for_before_the_picture_is_taken() {
        assert_eq!(use_offsets("a\nshoot\nb\n"), "a\nsoft off\nshoot\nb\n");
        assert_eq!(use_offsets("a\n"), "a\nsoft off\n");
    }

    #[test]
    fn the_page_shows_every_figure_and_its_pictures_are_there() {
        let page = fs::read_to_string(root().join("www/figures.html")).unwrap();
        let pictures = root().join("www/figures");
        let mut names = std::collections::BTreeSet::new();
        for (number, _, _, parts) in figures_of(FIGURES).unwrap() {
            assert!(
                page.contains(&format!("id=\"figure-{number}\"")),
                "{number}"
            );
            for (name, _) in parts {
                assert!(page.contains(&format!("figures/{name}.png")), "{name}");
                let example = name.trim_end_matches(OFFSET);
                let dataset = root().join(format!("www/examples/{example}.rat"));
                assert!(dataset.is_file(), "{name}");
                names.insert(pictures.join(format!("{name}.png")));
            }
        }
        let kept = files(&pictures, "png").unwrap();
        assert_eq!(
            kept,
            Vec::from_iter(names),
            "files that nothing uses, or some are missing"
        );
    }
}
