//! The datasets of the gallery, with thumbnails made by our own renderer.

use rats::{File, Project};

/// A dataset of the gallery.
pub struct Example {
    /// The heading under which the gallery shows it; neighbours in [`ALL`] share one.
    pub group: &'static str,
    /// The title.
    pub title: &'static str,
    /// The subject, in a few words.
    pub about: &'static str,
    /// The file name.
    pub name: &'static str,
    /// Address of the text, a file beside the page.
    pub path: &'static str,
    /// The text, if it is part of the program: the first visit's and those of sculptures. All
    /// others are fetched when they are opened, so that no visitor waits for them.
    pub text: Option<&'static str>,
    /// Address of the thumbnail, a PNG file beside the page: fetched when the gallery is opened, as
    /// few visits open it.
    pub thumbnail: &'static str,
    /// Names and texts of the strokes that the text uses.
    pub texts: &'static [(&'static str, &'static str)],
    /// Addresses of the images and meshes that the text uses, files beside the page: fetched when
    /// the example is opened.
    pub files: &'static [&'static str],
}

impl Example {
    /// Whether title, subject, group and file name contain all words of a search, in lower case.
    #[must_use]
    pub fn matches(&self, words: &[String]) -> bool {
        let text = [self.title, self.about, self.group, self.name].join(" ");
        let text = text.to_lowercase();
        words.iter().all(|word| text.contains(word))
    }

    /// Whether its picture takes more than 15 s on two cores, as `cargo xtask examples` measures.
    #[must_use]
    pub fn is_slow(&self) -> bool {
        let mut slow = include_str!("slow.txt").lines();
        slow.any(|name| self.name.strip_suffix(".rat") == Some(name))
    }

    /// Returns a project of the text and its strokes.
    #[must_use]
    pub fn project(&self, text: &str) -> Project {
        let own = (self.name, text);
        let all = core::iter::once(&own).chain(self.texts);
        let files = all.map(|(name, text)| File {
            name: (*name).to_owned(),
            text: (*text).to_owned(),
        });
        Project {
            files: files.collect(),
        }
    }
}

/// Returns the file name, without its extension, of the example that a fragment leads to, as in
/// `#example=cowrie`; `None` if it leads to none.
#[must_use]
pub fn of_hash(hash: &str) -> Option<&str> {
    hash.strip_prefix("#example=")
}

/// Returns the index in [`ALL`] of the example with this file name, without its extension.
#[must_use]
pub fn find(stem: &str) -> Option<usize> {
    ALL.iter()
        .position(|example| example.name.strip_suffix(".rat") == Some(stem))
}

macro_rules! example {
    ($group:ident, $title:literal, $about:literal, $name:literal $(, $file:literal)*) => {
        Example {
            group: $group,
            title: $title,
            about: $about,
            name: concat!($name, ".rat"),
            path: concat!("examples/", $name, ".rat"),
            text: None,
            thumbnail: concat!("examples/", $name, ".png"),
            texts: &[],
            files: &[$(concat!("examples/", $file)),*],
        }
    };
}

/// An example whose text is part of the program.
macro_rules! built_in {
    ($group:ident, $title:literal, $about:literal, $name:literal) => {
        Example {
            text: Some(include_str!(concat!(
                "../../../www/examples/",
                $name,
                ".rat"
            ))),
            ..example!($group, $title, $about, $name)
        }
    };
}

/// An example made by the strokes in a text of the same name.
macro_rules! sculpted {
    ($title:literal, $about:literal, $name:literal) => {
        Example {
            texts: &[(
                concat!($name, ".strokes"),
                include_str!(concat!("../../../www/examples/", $name, ".strokes")),
            )],
            ..built_in!(SCULPTED, $title, $about, $name)
        }
    };
}

const SEA: &str = "From the sea";
const GROWN: &str = "Grown by commands";
const CURVES: &str = "Curves with flesh";
const FIRST: &str = "First steps";
const MATTER: &str = "Light and matter";
/// The group of sculptures.
pub const SCULPTED: &str = "Sculpted";
const DATA: &str = "From data";
const STARFISH: &str = "One skeleton, six kinds of flesh";

/// The examples, group by group. A first visit shows the first one.
#[rustfmt::skip]
pub static ALL: [Example; 62] = [
    built_in!(SEA, "Tide line", "a cowrie, two starfish and pebbles", "tide"),
    example!(SEA, "Cowrie", "a shell with random spikes", "cowrie"),
    example!(SEA, "Seahorse", "the classic, made of arcs", "seahorse"),
    example!(SEA, "Hermite crab", "988 elements of five kinds", "hermite-crab"),
    example!(SEA, "Coral crab", "a few bones and 608 spikes", "coral-crab"),
    example!(SEA, "Starfish", "arms made by a loop", "starfish"),
    example!(SEA, "Sea urchin", "a ball and 180 needles", "sea-urchin"),
    example!(SEA, "Shell I", "361 points on a spiral", "shell-1"),
    example!(SEA, "Shell II", "42 lines to one point", "shell-2"),
    example!(SEA, "Shell III", "a spiral with horns", "shell-3"),
    example!(SEA, "Seaweed", "a tree whose branches fade", "seaweed"),
    example!(SEA, "Coral tree", "the same tree, with spikes", "coral-tree"),
    example!(GROWN, "Spinal Starecase", "36 legs, wound like a stair", "spinal-starecase"),
    example!(GROWN, "Sphereflake", "balls on balls, by recursion", "sphereflake"),
    example!(GROWN, "Generators", "six commands, a line each", "generators"),
    example!(GROWN, "Flakes on stems", "Gaussian balls on Cauchy bows", "stem-flakes"),
    example!(GROWN, "Four flakes", "10, 91, 820 and 7,381 balls", "flakes"),
    example!(
        GROWN, "A queen grows old", "1,242 triangles, smooth and wrinkled", "queen", "queen.obj"
    ),
    example!(GROWN, "Elder", "3,422 triangles and what age does to them", "elder", "elder.obj"),
    example!(GROWN, "Three heads", "a coarse mesh, as balls and as shells", "heads", "head.obj"),
    example!(MATTER, "Glass drops", "water, a mirror ball and a board", "glass-drops"),
    example!(MATTER, "Diamond", "a gem that splits light", "diamond"),
    example!(MATTER, "Still life", "wood, marble and an onion under a sky", "still-life"),
    example!(MATTER, "Patterned urchins", "stripes that dissolve into rings", "urchin-patterns"),
    example!(MATTER, "Agate ammonite", "carved from stone, lit by a spotlight", "agate-shell"),
    example!(MATTER, "Standing stones", "low fog in the morning", "fog-stones"),
    example!(MATTER, "Fireflies", "clouds of light between leaves", "fireflies"),
    example!(MATTER, "Three worlds", "craters, bands and squares", "planets"),
    example!(MATTER, "Pebbles", "bumps that are not there", "pebbles"),
    example!(CURVES, "Fawn", "drawn by hand, in nine strokes", "fawn"),
    example!(CURVES, "Octopus", "one skeleton with eight arms", "octopus"),
    example!(CURVES, "Snail", "two skeletons of curves", "snail"),
    example!(CURVES, "Finger and thumb", "they squeeze a ball, which gives way", "squeeze"),
    example!(CURVES, "Coiled snake", "its coils lie on each other and do not melt", "coils"),
    example!(CURVES, "Two worms", "folds that melt, and folds that do not", "folds"),
    example!(CURVES, "Hand and ball", "through each other, and in contact", "grasp"),
    example!(CURVES, "Coated", "a bulge that reaches too far", "coating"),
    example!(CURVES, "Two drops", "they touch and do not melt", "drops"),
    example!(CURVES, "Three bulges", "limbs that press each other flat", "touching"),
    example!(CURVES, "Falling body", "it slides down a wall and folds: play it", "falling"),
    example!(CURVES, "Jelly frog", "it drops on steps: play it", "jelly"),
    example!(CURVES, "Floppy ears", "a shaken head and what hangs from it: play it", "floppy-ears"),
    example!(DATA, "Neuron", "188 limbs of an SWC file", "neuron", "neuron.swc"),
    example!(DATA, "Vessel tree", "centrelines of a VTP file", "vessels", "vessels.vtp"),
    example!(DATA, "Lattice", "436 beams of a 3MF file", "lattice", "lattice.3mf"),
    example!(DATA, "Winter tree", "a scan's cylinders, a CSV table", "winter-tree", "tree.csv"),
    example!(DATA, "Molecule", "forty atoms of an XYZ file", "molecule", "dodecahedrane.xyz"),
    sculpted!("Dog", "six stages from a box", "dog"),
    sculpted!("Fish", "a ball with fins", "fish"),
    sculpted!("Slug", "five minutes of work", "slug"),
    sculpted!("Triceratops", "it was a cylinder", "triceratops"),
    example!(FIRST, "T-shape", "two bars that melt together", "tshape"),
    example!(FIRST, "Icicle", "a first little dataset", "icicle"),
    example!(FIRST, "Blends", "an anchor, a star and a serpent", "blends"),
    example!(FIRST, "Wrinkles", "how the seahorse got them, step by step", "wrinkles"),
    example!(STARFISH, "Starfish A", "seven arcs, the bare skeleton", "starfish-a"),
    example!(STARFISH, "Starfish B", "soft flesh on the skeleton", "starfish-b"),
    example!(STARFISH, "Starfish C", "very fat: a wide kernel", "starfish-c"),
    example!(STARFISH, "Starfish D", "fleshy arms, firm joints", "starfish-d"),
    example!(STARFISH, "Starfish E", "skinny, webs between the arms", "starfish-e"),
    example!(STARFISH, "Starfish F", "skinny and crisp", "starfish-f"),
    example!(STARFISH, "What it costs", "the same six, white where most work is done", "time-map"),
];

/// Text of a new work.
pub const BLANK: &str = "\
eyep 0 0 8
vrp 0 0 0
vup 0 1 0
fov 40 40
framesize 640 480
sample 2

light White point, position 4 6 8

surface clay, diffuse Coral, specular White, shine 40, blobbiness -2

var r = 0.6 hot

cylinder clay r, -1.5 0 0, 1.5 0 0
cylinder clay r, 0 -1.5 0, 0 1.5 0
";

/// Returns the size and the RGBA pixels of a PNG file; `None` if it is damaged or has a palette.
#[must_use]
pub fn decode(png: &[u8]) -> Option<pool::Image> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(png));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().ok()?;
    let mut bytes = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut bytes).ok()?;
    bytes.truncate(info.buffer_size());
    let rgba = match info.color_type {
        png::ColorType::Rgba => bytes,
        png::ColorType::Rgb => bytes
            .chunks_exact(3)
            .flat_map(|rgb| [rgb[0], rgb[1], rgb[2], 255])
            .collect(),
        png::ColorType::Grayscale => bytes
            .iter()
            .flat_map(|&grey| [grey, grey, grey, 255])
            .collect(),
        png::ColorType::GrayscaleAlpha => bytes
            .chunks_exact(2)
            .flat_map(|pixel| [pixel[0], pixel[0], pixel[0], pixel[1]])
            .collect(),
        png::ColorType::Indexed => return None,
    };
    Some(pool::Image {
        size: [info.width, info.height],
        rgba,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads a file of the page.
    fn read(path: &str) -> Option<Vec<u8>> {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../www");
        std::fs::read(folder.join(path)).ok()
    }

    #[test]
    fn every_example_compiles_cleanly_and_has_a_thumbnail() {
        for example in &ALL {
            let assets: Vec<rats::Asset> = example
                .files
                .iter()
                .map(|path| {
                    let name = path.rsplit('/').next().unwrap_or(path);
                    rats::Asset::new(name, read(path).expect(path))
                })
                .collect();
            let text = read(example.path).expect(example.path);
            let text = String::from_utf8(text).expect(example.path);
            assert!(example.text.is_none_or(|own| own == text));
            let compiled = rats::compile_at(&example.project(&text), &assets, 0.0);
            let messages: Vec<&str> = compiled
                .diagnostics
                .iter()
                .map(|d| d.message.as_str())
                .collect();
            // This one shows what its warning is about.
            let expected: &[&str] = match example.title {
                "Coated" => &["the bulge of this contact coats `SMALL`"],
                _ => &[],
            };
            assert_eq!(messages, expected, "{}", example.title);
            assert!(!compiled.scene.elements.is_empty(), "{}", example.title);
            let bytes = read(example.thumbnail).expect(example.title);
            let thumbnail = decode(&bytes).expect(example.title);
            let largest = thumbnail.size[0].max(thumbnail.size[1]);
            assert!(largest >= 200, "{}", example.title);
        }
    }

    #[test]
    fn slow_examples_are_of_the_gallery() {
        let slow = ALL.iter().filter(|example| example.is_slow()).count();
        assert_eq!(slow, include_str!("slow.txt").lines().count());
        for (name, is_slow) in [("coils", true), ("still-life", true), ("tide", false)] {
            assert_eq!(ALL[find(name).unwrap()].is_slow(), is_slow, "{name}");
        }
    }

    #[test]
    fn links_lead_to_examples() {
        for (hash, index) in [
            ("#example=tide", Some(Some(0))),
            ("#example=cowrie", Some(Some(1))),
            ("#example=no-such", Some(None)),
            ("#example", None),
            ("#lab=kernels", None),
            ("#AXicq1YqzVSyUkrLz1eyMjIw", None),
        ] {
            assert_eq!(of_hash(hash).map(find), index, "{hash}");
        }
    }

    #[test]
    fn search_asks_for_all_words() {
        for (query, count) in [
            ("shell spiral", 2),
            ("starecase", 1),
            ("nothing of the kind", 0),
            ("", ALL.len()),
        ] {
            let words: Vec<String> = query.split(' ').map(str::to_owned).collect();
            let found = ALL.iter().filter(|e| e.matches(&words)).count();
            assert_eq!(found, count, "{query}");
        }
    }

    #[test]
    fn groups_stay_together() {
        let mut groups: Vec<&str> = ALL.iter().map(|e| e.group).collect();
        groups.dedup();
        let all = groups.len();
        groups.sort_unstable();
        groups.dedup();
        assert_eq!(groups.len(), all);
    }

    #[test]
    fn a_new_work_compiles_cleanly() {
        let file = File {
            name: String::from("untitled.rat"),
            text: String::from(BLANK),
        };
        let compiled = rats::compile(&Project { files: vec![file] });
        assert_eq!(compiled.diagnostics, []);
        assert_eq!(compiled.hot.len(), 1);
    }
}
