//! Comparison of hard shapes with mirrors and glass to POV-Ray's pictures. The tests do nothing if
//! POV-Ray (Debian's package `povray`) is not installed.
//!
//! Both sides use one model of light: reflection does not depend on the angle, the shares of
//! mirrors and glass are as given, light of a point is not attenuated, colours are linear. Edges
//! that fall between two pixels differ, so the share of differing pixels is bounded, not each
//! difference.

use crate::looks::*;
use field::Skeleton;
use glam::DVec3;
use scene::{Background, Finish, Light, LightKind, Scene, Shape};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};

const SIZE: [u32; 2] = [160, 120];
/// Largest mean difference, of 255, and largest share of pixels that differ visibly: edges that
/// fall between two pixels.
const BOUND: (f64, f64) = (0.05, 0.002);

/// Returns a vector in POV-Ray's language.
fn vector(v: DVec3) -> String {
    format!("<{:e},{:e},{:e}>", v.x, v.y, v.z)
}

/// Returns a colour in POV-Ray's language.
fn colour(c: [f32; 3]) -> String {
    format!("<{},{},{}>", c[0], c[1], c[2])
}

/// Returns a finish in POV-Ray's language. A transparent one must have no diffuse colour: its
/// pigment is the filter.
fn look(finish: &Finish) -> String {
    let pigment = if finish.transparent == [0.0; 3] {
        format!("pigment {{ rgb {} }}", colour(finish.diffuse))
    } else {
        assert_eq!(finish.diffuse, [0.0; 3]);
        let [r, g, b] = finish.transparent;
        format!("pigment {{ rgbf <{r},{g},{b},1> }}")
    };
    // A highlight of the light's colour, as both have it unless it is metallic.
    format!(
        "{pigment} finish {{ ambient 0 diffuse {} phong {} phong_size {} \
         reflection {{ rgb {} }} }} interior {{ ior {} }}",
        f32::from(finish.transparent == [0.0; 3]),
        finish.specular[0],
        finish.shine,
        colour(finish.reflective),
        finish.index
    )
}

/// Translates a scene to POV-Ray's language. Arcs must be whole rings.
fn translate(scene: &Scene) -> String {
    let camera = &scene.camera;
    let Background::Colour(behind) = scene.background else {
        panic!("a background of one colour");
    };
    let mut text = format!(
        "#version 3.7;\nglobal_settings {{ assumed_gamma 1 max_trace_level 12 \
         adc_bailout 0.001 ambient_light 1 }}\nbackground {{ rgb {} }}\n\
         camera {{ perspective location {} sky {} up y right -x*{} angle {} look_at {} }}\n",
        colour(behind),
        vector(camera.eye),
        vector(camera.up),
        f64::from(SIZE[0]) / f64::from(SIZE[1]),
        camera.fov,
        vector(camera.target),
    );
    for light in &scene.lights {
        let LightKind::Point { position } = light.kind else {
            panic!("a light in a point");
        };
        let _ = writeln!(
            text,
            "light_source {{ {} rgb {} }}",
            vector(position),
            colour(light.colour)
        );
    }
    for element in &scene.elements {
        let look = look(&scene.finishes[element.finish as usize]);
        if let Shape::Box(cuboid) = &element.shape {
            let half = cuboid.axes[0] + cuboid.axes[1] + cuboid.axes[2];
            let corners = [cuboid.center - half, cuboid.center + half].map(vector);
            let _ = writeln!(text, "box {{ {}, {} {look} }}", corners[0], corners[1]);
            continue;
        }
        let bone = element.shape.bone().expect("a translation");
        let radius = bone.radius;
        let shape = match bone.skeleton {
            Skeleton::Point { center } => format!("sphere {{ {}, {radius}", vector(center)),
            Skeleton::Segment { base, apex } => {
                let (base, apex) = (vector(base), vector(apex));
                match bone.end_radius {
                    None => format!("cylinder {{ {base}, {apex}, {radius}"),
                    Some(end) => format!("cone {{ {base}, {radius}, {apex}, {end}"),
                }
            }
            Skeleton::Arc {
                center,
                u,
                v,
                radius: sweep,
                angle,
            } => {
                assert_eq!(angle, TAU);
                let axis = u.cross(v);
                format!(
                    "torus {{ {sweep}, {radius} matrix <{},{},{}, {},{},{}, {},{},{}, {},{},{}>",
                    u.x,
                    u.y,
                    u.z,
                    axis.x,
                    axis.y,
                    axis.z,
                    v.x,
                    v.y,
                    v.z,
                    center.x,
                    center.y,
                    center.z
                )
            }
            Skeleton::Triangle { corners } => format!(
                "triangle {{ {}, {}, {}",
                vector(corners[0]),
                vector(corners[1]),
                vector(corners[2])
            ),
            Skeleton::Plane { point, normal } => {
                format!("plane {{ {}, {}", vector(normal), normal.dot(point))
            }
            ref other => panic!("{other:?} has no translation"),
        };
        let _ = writeln!(text, "{shape} {look} }}");
    }
    text
}

/// Whether POV-Ray is installed.
fn is_installed() -> bool {
    let mut asked = Command::new("povray");
    let asked = asked
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    asked.status().is_ok_and(|status| status.success())
}

/// Lets POV-Ray draw a scene.
fn draw_by_povray(scene: &Scene, name: &str) -> Vec<[u8; 3]> {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let [text, picture] = ["pov", "ppm"].map(|end| folder.join(format!("povray-{name}.{end}")));
    std::fs::write(&text, translate(scene)).expect("the folder takes files");
    let output = Command::new("povray")
        .arg(format!("+I{}", text.display()))
        .arg(format!("+O{}", picture.display()))
        .args([format!("+W{}", SIZE[0]), format!("+H{}", SIZE[1])])
        .args(["-D", "-A", "+FP", "File_Gamma=1.0", "-V", "+WT1"])
        .stdin(Stdio::null())
        .output()
        .expect("povray runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let file = std::fs::read(&picture).expect("the picture");
    let wanted = 3 * (SIZE[0] * SIZE[1]) as usize;
    let pixels = &file[file.len() - wanted..];
    pixels.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()
}

/// The difference of two pictures.
struct Difference {
    /// Mean difference of the channels, of 255.
    mean: f64,
    /// Share of pixels that differ by more than 12 of 255 in a channel.
    share: f64,
}

fn difference(ours: &[[u8; 3]], theirs: &[[u8; 3]]) -> Difference {
    assert_eq!(ours.len(), theirs.len());
    let pairs = || ours.iter().zip(theirs);
    let channels = pairs().flat_map(|(a, b)| (0..3).map(|i| f64::from(a[i].abs_diff(b[i]))));
    let far = pairs().filter(|(a, b)| apart(**a, **b) > 12).count();
    Difference {
        mean: channels.sum::<f64>() / (3 * ours.len()) as f64,
        share: far as f64 / ours.len() as f64,
    }
}

/// Returns a floor of stripes, on which reflection and refraction show, and two lights.
fn room() -> Scene {
    let mut scene = dark();
    scene.background = Background::Colour([0.2, 0.35, 0.55]);
    scene.camera.eye = DVec3::new(0.4, 2.6, 8.0);
    scene.camera.fov = 44.0;
    scene.settings.max_depth = 12;
    scene.settings.vanish = 1e-3;
    for k in -6..6 {
        let x = f64::from(k);
        let diffuse = if k % 2 == 0 {
            [0.8, 0.75, 0.6]
        } else {
            [0.35, 0.15, 0.1]
        };
        let stripe = Shape::cuboid(
            DVec3::new(x + 0.5, -1.6, -2.0),
            [DVec3::X * 0.5, DVec3::Y * 0.1, DVec3::Z * 6.0],
        );
        add(&mut scene, stripe, Finish { diffuse, ..black() });
    }
    for (position, colour) in [
        (DVec3::new(-5.0, 8.0, 6.0), [0.7, 0.65, 0.6]),
        (DVec3::new(6.0, 5.0, 3.0), [0.2, 0.25, 0.3]),
    ] {
        scene
            .lights
            .push(Light::new(LightKind::Point { position }, colour));
    }
    scene
}

fn mirror(share: [f32; 3]) -> Finish {
    Finish {
        diffuse: [0.1, 0.1, 0.12],
        specular: [0.4; 3],
        shine: 60.0,
        reflective: share,
        ..black()
    }
}

fn ring(center: DVec3, radius: f64) -> Shape {
    Shape::arc(
        center,
        [DVec3::X, DVec3::new(0.0, 0.8, 0.6)],
        0.8,
        TAU,
        radius,
    )
}

/// Adds every shape, in a row and of one finish.
fn shapes(scene: &mut Scene, finish: &Finish) {
    let list = [
        ball(DVec3::new(-2.4, -0.6, 0.0), 0.9),
        Shape::cuboid(
            DVec3::new(2.5, -0.7, -0.5),
            [DVec3::X * 0.7, DVec3::Y * 0.7, DVec3::Z * 0.5],
        ),
        Shape::cylinder(DVec3::new(-0.9, -1.4, 1.6), DVec3::new(0.6, -0.4, 2.1), 0.4),
        Shape::cone(
            DVec3::new(0.2, -1.49, -1.6),
            0.9,
            DVec3::new(0.3, 1.1, -1.9),
            0.25,
        ),
        ring(DVec3::new(1.6, 0.9, -2.6), 0.3),
    ];
    for shape in list {
        add(scene, shape, finish.clone());
    }
}

fn check(name: &str, scene: &Scene, (mean, share): (f64, f64)) {
    if !is_installed() {
        eprintln!("skipped: povray is not installed ({name})");
        return;
    }
    let ours = draw(scene, SIZE);
    // Beside POV-Ray's, for whoever wants to see what differs.
    let mut file = format!("P6 {} {} 255\n", SIZE[0], SIZE[1]).into_bytes();
    file.extend(ours.iter().flatten());
    let picture =
        PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("povray-{name}-ours.ppm"));
    std::fs::write(picture, file).expect("the folder takes files");
    let found = difference(&ours, &draw_by_povray(scene, name));
    eprintln!("{name}: mean {:.3}, share {:.4}", found.mean, found.share);
    assert!(found.mean < mean, "{name}: mean {}", found.mean);
    assert!(found.share < share, "{name}: share {}", found.share);
}

#[test]
fn plain_shapes_and_their_shadows() {
    let mut scene = room();
    let finish = Finish {
        diffuse: [0.7, 0.3, 0.2],
        specular: [0.5; 3],
        shine: 40.0,
        ..black()
    };
    shapes(&mut scene, &finish);
    check("plain", &scene, BOUND);
}

#[test]
fn mirrors_that_mirror_each_other() {
    let mut scene = room();
    shapes(&mut scene, &mirror([0.7, 0.65, 0.5]));
    check("mirrors", &scene, BOUND);
}

#[test]
fn clear_glass_of_all_shapes() {
    for index in [1.5, 1.1] {
        let mut scene = room();
        let finish = Finish {
            specular: [0.5; 3],
            shine: 80.0,
            ..glass(index)
        };
        shapes(&mut scene, &finish);
        check(&format!("glass-{index}"), &scene, BOUND);
    }
}

/// POV-Ray colours light that is reflected totally as if it had passed, and leaves the mirror's
/// share out; here total reflection is total. A ball that is looked into from outside has none.
#[test]
fn a_ball_of_coloured_glass_that_mirrors_and_its_shadow() {
    let mut scene = room();
    let finish = Finish {
        transparent: [0.9, 0.95, 0.8],
        specular: [0.5; 3],
        shine: 80.0,
        reflective: [0.08; 3],
        ..glass(1.5)
    };
    add(&mut scene, ball(DVec3::new(-1.0, -0.3, 0.0), 1.1), finish);
    check("coloured-glass", &scene, BOUND);
}

#[test]
fn the_comparison_sees_what_differs() {
    let mut scene = room();
    shapes(&mut scene, &glass(1.5));
    let mut other = room();
    shapes(&mut other, &glass(1.52));
    let found = difference(&draw(&scene, SIZE), &draw(&other, SIZE));
    assert!(found.share > 2.0 * BOUND.1, "{}", found.share);
}
