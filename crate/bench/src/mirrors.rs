//! Mirrors and glass: soft scenes against POV-Ray's blobs with the same depth; and what a lens and
//! a light with a size cost before the first complete picture.

use crate::povray;
use crate::report::{Report, or_dash};
use crate::series::in_turn;
use crate::sinew::Sinew;
use anyhow::{Context, Result};
use xtask::shell::find;

/// Most reflections and refractions of a ray.
const DEPTH: u32 = 5;

/// A look, in both languages. `material` stands behind the options of `Flesh`, `finish` in the
/// place of POV-Ray's finish.
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
        finish: "pigment { rgb <0.3,0.25,0.2> } \
            finish { ambient 0 diffuse 1 reflection { rgb <0.6,0.55,0.5> } }",
    },
    Case {
        scene: "coral",
        title: "coral of glass",
        material: "ambient 0 0 0, diffuse 0 0 0, transparent 90%, reflective 10%, index 1.5",
        finish: "pigment { rgbf <0.9,0.9,0.9,1> } \
            finish { ambient 0 diffuse 0 reflection { rgb 0.1 } } interior { ior 1.5 }",
    },
];

/// Gives the flesh in a scene's text another look.
fn dress(text: &str, material: &str) -> String {
    let lines = text.lines().map(|line| {
        if line.starts_with("surface Flesh") {
            let blob = line.find("blob").map_or("", |at| &line[at..]);
            format!("surface Flesh {{ {material}, {blob}\nmaxdepth {DEPTH}\n")
        } else {
            format!("{line}\n")
        }
    });
    lines.collect()
}

/// Measures.
pub fn measure() -> Result<Report> {
    let sinew = Sinew::new()?;
    let mut report = Report::default();
    report.set("depth", DEPTH);
    for case in CASES {
        let (scene, title) = (case.scene, case.title);
        let variant = format!("{scene}-mirrors");
        let dataset = sinew.variant(scene, &variant, |text| dress(text, case.material))?;
        // The blob of the plain scene, with another finish and depth.
        let blob = povray::blob(&sinew.scene(scene)?, 1)?
            .replace("max_trace_level 1", &format!("max_trace_level {DEPTH}"));
        let at = blob.rfind("pigment {").context("a blob has a pigment")?;
        let pov = sinew.path(&format!("{variant}.pov"));
        std::fs::write(&pov, format!("{}{} }}\n", &blob[..at], case.finish))?;
        let installed = find("povray").is_some();
        let [us, them] = in_turn(3, |i| match i {
            0 => Ok(sinew.time(&[&dataset])?.seconds),
            _ if installed => Ok(povray::time(&pov, false)?.seconds),
            _ => Ok(f64::NAN),
        })?;
        let (ratio, them) = (installed.then(|| them.over(&us)), installed.then_some(them));
        let theirs = format!("{} | {}", or_dash(them), or_dash(ratio));
        report.row("scenes", format!("{title} | {us} | {theirs}"));
        let measured = ratio.context("POV-Ray is not installed");
        report.goal(
            &format!("{title}, depth {DEPTH} | POV-Ray | ≥ 4×"),
            measured,
        )?;
    }
    // The same scene with and without: one complete picture of one ray a pixel.
    let [plain, soft] = [
        ("penumbra off", "seahorse-plain"),
        ("penumbra on\naperture 0.2", "seahorse-lens"),
    ]
    .map(|(lens, name)| {
        // A light with a size and a shadow; without penumbra the size does nothing.
        sinew.variant("seahorse", name, |text| {
            format!("{lens}\n{}", text.replace("noshadow", "size 1"))
        })
    });
    let [without, with] = sinew.compare(3, [&[&plain?], &[&soft?]])?;
    let ratio = with.over(&without);
    report.set("without", without);
    report.set("with", with);
    report.set("ratio", ratio);
    let goal = "first complete picture with lens and area light | the same without | ≤ 1.5×";
    report.goal(goal, Ok(ratio))?;
    Ok(report)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_look_of_the_flesh_is_changed() {
        let text = "eyep 1 2 3\nsurface Flesh { ambient 0.1 0.1 0.1, diffuse 1 1 1, blob -4, \
            kernel gauss }\nsphere Flesh 1 0 0 0\n";
        let want = "eyep 1 2 3\nsurface Flesh { reflective 50%, blob -4, kernel gauss }\n\
            maxdepth 5\nsphere Flesh 1 0 0 0\n";
        assert_eq!(dress(text, "reflective 50%"), want);
    }
}
