//! `cargo xtask figures`: the page `www/figures.html`, which shows every figure and table of the
//! four papers that this program follows, each beside ours with its dataset or command.

use crate::pictures::{draw, program, read_picture, size_within};
use crate::shell::{command, files, read, root, run, target};
use anyhow::{Context, Result, bail};
use std::fs;
use std::path::{Path, PathBuf};

/// The figures and tables of the four papers, separated by empty lines. A paper begins with a line
/// `paper NUMBER TITLE` and one about it; a figure or table with its kind, number and title, and a
/// line about what the paper shows. Then follow lines of ours, one for each thing shown:
/// * `EXAMPLE: LABEL`: a dataset's picture with a link that opens it, either one of the gallery or
///   one of the folder `crate/xtask/figures`. If its name ends with [`OFFSET`], its offset surface
///   is drawn in place of the convolution surface.
/// * `gallery EXAMPLE: LABEL`: the same with the gallery's small picture, which is there already.
/// * `plot NAME ARGUMENTS: LABEL`: a drawing that `sinew plot` makes of these arguments.
/// * `| … | …`: a row of a table; the first names the columns.
/// * `note …`: what is different or missing, and why.
const FIGURES: &str = include_str!("../figures.txt");
const OFFSET: &str = "-offset";
/// The head of the page.
const HEAD: &str = include_str!("../figures.html");

/// The pixels that a picture of the page fits into.
const BOX: [f64; 2] = [400.0, 300.0];

/// A paper, or a figure or table of one, with a sentence about it and the lines of ours.
struct Entry<'a> {
    paper: &'a str,
    kind: &'a str,
    number: &'a str,
    title: &'a str,
    about: &'a str,
    ours: Vec<&'a str>,
}

impl Entry<'_> {
    /// Returns the entry's name in links: those of the first paper have been linked to without it.
    fn anchor(&self) -> String {
        let (paper, kind, number) = (self.paper, self.kind, self.number);
        match (kind, paper) {
            ("paper", _) => format!("paper-{number}"),
            (_, "000") => format!("{kind}-{number}"),
            _ => format!("{paper}-{kind}-{number}"),
        }
    }
}

fn entries_of(text: &str) -> Result<Vec<Entry<'_>>> {
    let mut paper = "";
    let mut entries = Vec::new();
    for entry in text.trim_end().split("\n\n") {
        let mut lines = entry.lines();
        let words = lines.next().unwrap_or_default().splitn(3, ' ');
        let words = <[&str; 3]>::try_from(words.collect::<Vec<_>>());
        let [kind, number, title] = words.ok().with_context(|| format!("no title: {entry}"))?;
        if kind == "paper" {
            paper = number;
        }
        let about = lines.next().with_context(|| format!("no text: {entry}"))?;
        let ours = lines.collect();
        entries.push(Entry {
            paper,
            kind,
            number,
            title,
            about,
            ours,
        });
    }
    Ok(entries)
}

/// Draws the pictures that are older than their datasets, and writes the page.
pub fn figures() -> Result<()> {
    let sinew = program()?;
    fs::create_dir_all(root().join("www/figures"))?;
    let entries = entries_of(FIGURES)?;
    let mut page = format!("{HEAD}{}", contents(&entries));
    for entry in &entries {
        let (kind, number, title, about) = (entry.kind, entry.number, entry.title, entry.about);
        let anchor = entry.anchor();
        if kind == "paper" {
            page += &format!("<h2 id=\"{anchor}\">{title}</h2>\n<p>{about}</p>\n");
            continue;
        }
        let what = if kind == "table" { "Table " } else { "" };
        page += &format!(
            "<section id=\"{anchor}\">\n<h3>{what}{number} {title}</h3>\n<p>{about}</p>\n"
        );
        page += &ours(&sinew, &entry.ours).with_context(|| anchor.clone())?;
        page += "</section>\n";
    }
    page += "</main>\n</html>\n";
    for picture in list_pictures()? {
        let name = picture.file_name().unwrap_or_default().to_string_lossy();
        if !page.contains(&format!("figures/{name}\"")) {
            fs::remove_file(&picture)?;
        }
    }
    Ok(fs::write(root().join("www/figures.html"), page)?)
}

/// Returns the files of the page's pictures and drawings.
fn list_pictures() -> Result<Vec<PathBuf>> {
    let folder = root().join("www/figures");
    let mut all = files(&folder, "png")?;
    all.extend(files(&folder, "svg")?);
    all.sort();
    Ok(all)
}

/// Returns links to all entries, a paragraph for each paper.
fn contents(entries: &[Entry]) -> String {
    let mut nav = String::from("<nav>");
    for entry in entries {
        let (anchor, number) = (entry.anchor(), entry.number);
        nav += &match entry.kind {
            "paper" => format!("\n<p><a href=\"#{anchor}\">{}</a><br>\n", entry.title),
            "table" => format!("<a class=\"c\" href=\"#{anchor}\">T{number}</a> "),
            _ => format!("<a class=\"c\" href=\"#{anchor}\">{number}</a> "),
        };
    }
    nav.replace("\n<p>", "</p>\n<p>").replacen("</p>", "", 1) + "</p>\n</nav>\n"
}

/// Returns what stands below an entry: pictures, then tables, then notes.
fn ours(sinew: &Path, lines: &[&str]) -> Result<String> {
    let (mut pictures, mut rows, mut notes) = (String::new(), String::new(), String::new());
    for line in lines {
        if let Some(row) = line.strip_prefix("| ") {
            let cell = if rows.is_empty() { "th" } else { "td" };
            let cells = row
                .split(" | ")
                .map(|text| format!("<{cell}>{text}</{cell}>"));
            rows += &format!("<tr>{}</tr>\n", cells.collect::<String>());
        } else if let Some(note) = line.strip_prefix("note ") {
            notes += &format!("<p>{note}</p>\n");
        } else {
            let (what, label) = line.split_once(": ").with_context(|| line.to_string())?;
            let picture = match what.split_once(' ') {
                Some(("plot", plot)) => drawing(sinew, plot, label),
                Some((_, example)) => picture_at(
                    &format!("examples/{example}"),
                    &format!("#example={example}"),
                    label,
                ),
                None => part(sinew, what, label),
            };
            pictures += &picture.with_context(|| what.to_string())?;
        }
    }
    if !pictures.is_empty() {
        pictures = format!("<div class=\"figures\">\n{pictures}</div>\n");
    }
    if !rows.is_empty() {
        rows = format!("<table>\n{rows}</table>\n");
    }
    Ok(pictures + &rows + &notes)
}

/// Returns a dataset's file: one of the page's own, or an example.
fn dataset_of(name: &str) -> PathBuf {
    let own = root().join(format!("crate/xtask/figures/{name}.rat"));
    let example = root().join(format!("www/examples/{name}.rat"));
    if own.exists() { own } else { example }
}

/// Draws a plot, and returns its place on the page with the command that makes it.
fn drawing(sinew: &Path, plot: &str, label: &str) -> Result<String> {
    let (name, arguments) = plot.split_once(' ').context("a plot without arguments")?;
    let file = root().join(format!("www/figures/{name}.svg"));
    let words = arguments.split(' ').map(|word| {
        let dataset = word.strip_suffix(".rat").map(dataset_of);
        dataset.map_or_else(|| word.into(), |path| path.to_string_lossy().into_owned())
    });
    let mut plot = command(sinew, &["plot"]);
    run(plot.args(words).arg("-o").arg(&file))?;
    if fs::metadata(&file)?.len() > 120_000 {
        bail!("the drawing is too large for the page");
    }
    Ok(format!(
        "<figure><img src=\"figures/{name}.svg\" width=\"320\" height=\"220\" \
         loading=\"lazy\" alt=\"{label}\">\n\
         <figcaption>{label} <code>sinew plot {arguments}</code></figcaption></figure>\n"
    ))
}

/// Draws a picture if it is not newer than its dataset, and returns its place on the page.
fn part(sinew: &Path, name: &str, label: &str) -> Result<String> {
    let example = name.strip_suffix(OFFSET).unwrap_or(name);
    let dataset = dataset_of(example);
    let mut text = dataset.clone();
    let mut link = format!("#example={name}");
    if name != example {
        text = target().join(format!("{name}.rat"));
        fs::write(&text, use_offsets(&fs::read_to_string(&dataset)?))?;
    }
    if name != example || !dataset.starts_with(root().join("www")) {
        let share = ["share", &text.to_string_lossy()];
        link = read(&mut command(sinew, &share)).context("the dataset has errors")?;
    }
    let picture = root().join(format!("www/figures/{name}.png"));
    if !picture.exists() || picture.metadata()?.modified()? <= dataset.metadata()?.modified()? {
        draw(sinew, &text, &picture, size_within(sinew, &text, BOX)?, "4")?;
    }
    picture_at(&format!("figures/{name}"), &link, label)
}

/// Returns the place of a picture of the page's folder, whose name is given without its ending.
fn picture_at(name: &str, link: &str, label: &str) -> Result<String> {
    let (info, _) = read_picture(&root().join(format!("www/{name}.png")))?;
    let (width, height) = (info.width, info.height);
    let alt = name.rsplit('/').next().unwrap_or_default();
    Ok(format!(
        "<figure><a href=\"./{link}\"><img src=\"{name}.png\" \
         width=\"{width}\" height=\"{height}\" loading=\"lazy\" alt=\"{alt}\"></a>\n\
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

    /// The papers' figures and tables, counted in their texts: `000 figure 1.1 2.1 …`.
    const LIST: &str = include_str!("../figures/list.txt");

    #[test]
    fn the_page_shows_every_figure_and_table_and_its_pictures_are_there() {
        let page = fs::read_to_string(root().join("www/figures.html")).unwrap();
        let entries = entries_of(FIGURES).unwrap();
        let listed = LIST.lines().flat_map(|line| {
            let mut words = line.split(' ');
            let (paper, kind) = (words.next().unwrap(), words.next().unwrap());
            words.map(move |number| (paper, kind, number))
        });
        let listed: Vec<_> = listed.collect();
        assert_eq!(listed.len(), 110, "figures and tables of the papers");
        for wanted in listed {
            let entry = entries
                .iter()
                .find(|entry| (entry.paper, entry.kind, entry.number) == wanted);
            let entry = entry.unwrap_or_else(|| panic!("{wanted:?} is not in figures.txt"));
            let anchor = entry.anchor();
            let place = page.split(&format!("id=\"{anchor}\"")).nth(1);
            let place = place.unwrap_or_else(|| panic!("{anchor} is not on the page"));
            let place = place.split("</section>").next().unwrap();
            assert!(
                place.contains(entry.about),
                "{anchor}: run cargo xtask figures"
            );
            assert!(!entry.ours.is_empty(), "{anchor}: nothing of ours");
        }
        let mut names = std::collections::BTreeSet::new();
        for line in entries.iter().flat_map(|entry| &entry.ours) {
            if line.starts_with("| ") || line.starts_with("note ") {
                let words = line.trim_start_matches("note ").trim_start_matches("| ");
                let shown = words.split(" | ").all(|cell| page.contains(cell));
                assert!(shown, "{line}: run cargo xtask figures");
                continue;
            }
            let (what, _) = line.split_once(": ").unwrap();
            let file = match what.strip_prefix("plot ") {
                Some(plot) => format!("{}.svg", plot.split(' ').next().unwrap()),
                None => format!("{what}.png"),
            };
            if let Some(example) = what.strip_prefix("gallery ") {
                assert!(
                    page.contains(&format!("\"examples/{example}.png\"")),
                    "{what}"
                );
                continue;
            }
            assert!(page.contains(&format!("figures/{file}\"")), "{what}");
            if !what.starts_with("plot ") {
                assert!(
                    dataset_of(what.trim_end_matches(OFFSET)).is_file(),
                    "{what}"
                );
            }
            names.insert(root().join("www/figures").join(file));
        }
        assert_eq!(
            list_pictures().unwrap(),
            Vec::from_iter(names),
            "files that nothing uses, or some are missing"
        );
    }
}
