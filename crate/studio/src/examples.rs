//! The datasets of the gallery, with thumbnails made by our own renderer.

use rats::{File, Project};

/// One dataset of the gallery.
pub struct Example {
    /// Its title.
    pub title: &'static str,
    /// Its subject, in a few words.
    pub about: &'static str,
    /// Its file name.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
    /// Address of its thumbnail, a PNG file beside the page: fetched when the gallery is opened, as few
    /// visits open it.
    pub thumbnail: &'static str,
}

impl Example {
    /// As a project.
    #[must_use]
    pub fn project(&self) -> Project {
        Project {
            files: vec![File {
                name: self.name.to_owned(),
                text: self.text.to_owned(),
            }],
        }
    }
}

macro_rules! example {
    ($title:literal, $about:literal, $name:literal) => {
        Example {
            title: $title,
            about: $about,
            name: concat!($name, ".rat"),
            text: include_str!(concat!("../../../www/examples/", $name, ".rat")),
            thumbnail: concat!("examples/", $name, ".png"),
        }
    };
}

/// All of them. The first one is what a first visit shows.
pub const ALL: [Example; 22] = [
    example!("Cowrie", "a shell with random spikes", "cowrie"),
    example!("Seahorse", "the classic, all of arcs", "seahorse"),
    example!("Hermite crab", "988 elements of five kinds", "hermite-crab"),
    example!("Coral crab", "a few bones and 608 spikes", "coral-crab"),
    example!("Starfish", "arms made by a loop", "starfish"),
    example!("Sea urchin", "a ball and 180 needles", "sea-urchin"),
    example!("Shell I", "361 points on a spiral", "shell-1"),
    example!("Shell II", "42 lines to one point", "shell-2"),
    example!("Shell III", "a spiral with horns", "shell-3"),
    example!("Seaweed", "a tree whose branches fade", "seaweed"),
    example!("Coral tree", "the same tree, with spikes", "coral-tree"),
    example!(
        "Spinal Starecase",
        "36 legs, wound like a stair",
        "spinal-starecase"
    ),
    example!("Sphereflake", "balls on balls, by recursion", "sphereflake"),
    example!("Generators", "six commands, a line each", "generators"),
    example!("T-shape", "two bars that melt together", "tshape"),
    example!("Icicle", "a first little dataset", "icicle"),
    example!("Starfish A", "seven arcs, the bare skeleton", "starfish-a"),
    example!("Starfish B", "soft flesh on the skeleton", "starfish-b"),
    example!("Starfish C", "very fat: a wide kernel", "starfish-c"),
    example!("Starfish D", "fleshy arms, firm joints", "starfish-d"),
    example!("Starfish E", "skinny, webs between the arms", "starfish-e"),
    example!("Starfish F", "skinny and crisp", "starfish-f"),
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

/// The size and the pixels, RGBA, of a PNG file.
#[must_use]
pub fn decode(png: &[u8]) -> Option<crate::picture::Image> {
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
    Some(crate::picture::Image {
        size: [info.width, info.height],
        rgba,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_example_compiles_cleanly_and_has_a_thumbnail() {
        for example in &ALL {
            let compiled = rats::compile(&example.project());
            assert_eq!(compiled.diagnostics, [], "{}", example.title);
            assert!(!compiled.scene.elements.is_empty(), "{}", example.title);
            let bytes = crate::platform::read(example.thumbnail).expect(example.title);
            let thumbnail = decode(&bytes).expect(example.title);
            let largest = thumbnail.size[0].max(thumbnail.size[1]);
            assert!(largest >= 200, "{}", example.title);
        }
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
