//! Mirrors and glass: soft scenes against POV-Ray's blobs with the same depth; and what a lens and a light with a size cost before the
//! first complete picture.

use super::goal::{Goal, Wanted, short};
use super::scenes::Scenes;
use super::series::alternate;
use super::{Piece, ours, povray};
use anyhow::{Context, Result};
use std::fmt::Write;

/// Most reflections and refractions of a ray.
const DEPTH: u32 = 5;

/// A look, in both languages. `material` stands behind the options of `Flesh`, `finish` in the place of POV-Ray's finish.
struct Case {
    scene: &'static str,
    title: &'static str,
    material: &'static str,
    finish: &'static str,
}

const CASES: [Case; 2] = [
    Case {
        scene: "flake-820",
        title: "sphereflake 820, mirrored",
        material: "ambient 0 0 0, diffuse 0.3 0.25 0.2, reflective 0.6 0.55 0.5",
        finish: "pigment { rgb <0.3,0.25,0.2> } finish { ambient 0 diffuse 1 reflection { rgb <0.6,0.55,0.5> } }",
    },
    Case {
        scene: "coral",
        title: "coral of glass",
        material: "ambient 0 0 0, diffuse 0 0 0, transparent 90%, reflective 10%, index 1.5",
        finish: "pigment { rgbf <0.9,0.9,0.9,1> } finish { ambient 0 diffuse 0 reflection { rgb 0.1 } } interior { ior 1.5 }",
    },
];

/// A scene's text with another look of its flesh.
fn dressed(text: &str, material: &str) -> String {
    let lines = text.lines().map(|line| {
        if line.starts_with("surface Flesh") {
            let blob = line.find("blob").map_or("", |at| &line[at..]);
            format!("surface Flesh {{ {material}, {blob}\nmaxdepth {DEPTH}")
        } else {
            line.to_owned()
        }
    });
    lines.collect::<Vec<_>>().join("\n") + "\n"
}

/// Measures.
pub fn measure() -> Result<Piece> {
    let scenes = Scenes::new()?;
    let installed = povray::version().is_some();
    let mut goals = Vec::new();
    let mut page = format!(
        "512×512 pixels, one ray a pixel from the eye, one thread, depth {DEPTH}; seconds, the quickest of 3 in turn. Ours with what it \
         takes to prepare the scene, POV-Ray's without.\n\n| scene | ours | POV-Ray | times quicker |\n|---|--:|--:|--:|\n"
    );
    for case in CASES {
        let file = scenes.path(&format!("{}-mirrors.rat", case.scene));
        let text = std::fs::read_to_string(scenes.path(&format!("{}.rat", case.scene)))?;
        std::fs::write(&file, dressed(&text, case.material))?;
        let dataset = file.to_string_lossy().into_owned();
        // The blob of the plain scene, with another finish and depth.
        let blob = povray::blob(&scenes.compiled(case.scene)?, 1)?
            .replace("max_trace_level 1", &format!("max_trace_level {DEPTH}"));
        let at = blob.rfind("pigment {").context("a blob has a pigment")?;
        let pov = scenes.path(&format!("{}-mirrors.pov", case.scene));
        std::fs::write(&pov, format!("{}{} }}\n", &blob[..at], case.finish))?;
        let mut our = || Ok(ours::time(&scenes.sinew, &[&dataset])?.seconds);
        let measured = if installed {
            let mut their = || Ok(povray::time(&pov, false)?.seconds);
            let [us, them] = alternate(3, [&mut our, &mut their])?;
            let ratio = them.best() / us.best();
            writeln!(
                page,
                "| {} | {} | {} | {} |",
                case.title,
                us.text(),
                them.text(),
                short(ratio)
            )?;
            Ok(ratio)
        } else {
            let [us] = alternate(3, [&mut our])?;
            writeln!(page, "| {} | {} | – | – |", case.title, us.text())?;
            Err(String::from("POV-Ray is not installed"))
        };
        goals.push(Goal {
            what: format!("{}, depth {DEPTH}", case.title),
            against: "POV-Ray".into(),
            wanted: Wanted::AtLeast(4.0),
            unit: "×",
            measured,
        });
    }
    // The same scene with and without: one complete picture of one ray a pixel.
    let plain = scenes.variant("seahorse", "penumbra off", "seahorse-plain")?;
    let soft = scenes.variant("seahorse", "penumbra on\naperture 0.2", "seahorse-lens")?;
    for dataset in [&plain, &soft] {
        let text = std::fs::read_to_string(dataset)?;
        // A light with a size and a shadow; without penumbra the size does nothing.
        let lit = text.replace("noshadow", "size 1");
        std::fs::write(dataset, lit)?;
    }
    let mut without = || Ok(ours::time(&scenes.sinew, &[&plain])?.seconds);
    let mut with = || Ok(ours::time(&scenes.sinew, &[&soft])?.seconds);
    let [without, with] = alternate(3, [&mut without, &mut with])?;
    let ratio = with.best() / without.best();
    writeln!(
        page,
        "\nFirst complete picture (one ray a pixel) of the seahorse with shadows: {} s; with a lens and lights of a size {} s, {} times as \
         long.\n",
        without.text(),
        with.text(),
        short(ratio)
    )?;
    goals.push(Goal {
        what: "first complete picture with lens and area light".into(),
        against: "the same without".into(),
        wanted: Wanted::AtMost(1.5),
        unit: "×",
        measured: Ok(ratio),
    });
    Ok((goals, page))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_look_of_the_flesh_is_changed() {
        let text = "eyep 1 2 3\nsurface Flesh { ambient 0.1 0.1 0.1, diffuse 1 1 1, blob -4, kernel gauss }\nsphere Flesh 1 0 0 0\n";
        let want = "eyep 1 2 3\nsurface Flesh { reflective 50%, blob -4, kernel gauss }\nmaxdepth 5\nsphere Flesh 1 0 0 0\n";
        assert_eq!(dressed(text, "reflective 50%"), want);
    }
}
