//! Tests of pictures against themselves at a far higher precision, with nothing cut off.
use crate::picture::Picture;
use crate::slabs::Precision;
use crate::stats::Stats;
use crate::tile::{Pass, Tile};
use field::{Profile, Wave};
use glam::DVec3;
use scene::{Background, Cloud, Fog, Ground, Light, LightKind, Scene, Shape, Tone};
use trials::scenes;

const SIZE: u32 = 72;

fn trace(picture: &Picture, pass: Pass) -> (Vec<u8>, Stats) {
    let whole = Tile {
        x: 0,
        y: 0,
        width: SIZE,
        height: SIZE,
    };
    let mut stats = Stats::default();
    let pixels = picture.trace(whole, pass, &|| false, &mut stats);
    (pixels.expect("nobody asked to stop"), stats)
}

/// Returns the shares of channels that differ by more than 1/255 and by more than 8/255.
fn difference(scene: &Scene) -> [f64; 2] {
    let mut picture = Picture::new(scene, [SIZE, SIZE]);
    let (quick, _) = trace(&picture, Pass::Full);
    picture.sampler.world.soft.precision = Precision {
        first: 1e-4,
        last: 2e-6,
        shared: 1e-6,
        ..Precision::PICTURE
    };
    let (exact, _) = trace(&picture, Pass::Full);
    [1, 8].map(|bar| {
        let off = quick
            .iter()
            .zip(&exact)
            .filter(|(a, b)| a.abs_diff(**b) > bar);
        off.count() as f64 / quick.len() as f64
    })
}

#[test]
fn pictures_show_the_exact_surface() {
    let mut worst = [0.0f64; 2];
    for seed in 0..trials::count(8) as u64 {
        let mut scene = scenes::blend(seed, 3 + seed as usize % 6);
        scene.settings.influence = 1e-3;
        let [slightly, visibly] = difference(&scene);
        worst = [worst[0].max(slightly), worst[1].max(visibly)];
    }
    // Silhouettes and the edges of shadows may move by a small part of a pixel.
    assert!(worst[0] < 0.02 && worst[1] < 0.005, "{worst:?}");
}

#[test]
fn pictures_with_profiles_show_the_exact_surface() {
    let mut worst = [0.0f64; 2];
    for (seed, wave) in [Wave::Sin, Wave::Hat, Wave::Sin2, Wave::Saw, Wave::Step]
        .into_iter()
        .enumerate()
    {
        let mut scene = scenes::blend(seed as u64, 5);
        for flesh in &mut scene.flesh[..2] {
            flesh.profile = Some(Profile {
                waves: [wave, Wave::One],
                scale: [8.0, 1.0],
                bounds: [0.6, 1.0],
                times: 1.2,
                restriction: 0.0,
            });
        }
        let [slightly, visibly] = difference(&scene);
        worst = [worst[0].max(slightly), worst[1].max(visibly)];
    }
    // A profile with jumps has no certified spans, so this bar is lower.
    assert!(worst[0] < 0.03 && worst[1] < 0.02, "{worst:?}");
}

/// Root isolation uses the interpolants of far primitives for rays that rounding leaves in doubt
/// among very many: the picture is the same, with far fewer evaluations than with all primitives
/// for each ray.
#[test]
fn doubts_in_a_cloud_are_resolved_with_near_primitives() {
    let mut numbers = trials::Random::new(9);
    let mut scene = scenes::empty();
    scene.camera.eye = DVec3::Z * 4.0;
    scene.camera.target = DVec3::ZERO;
    scene.camera.fov = 1.0;
    scenes::clothe(&mut scene, vec![scenes::soft(4.0, 1.0); 2]);
    // Bodies of points alone take the way of `far_march`.
    let line = Shape::cylinder(DVec3::Z * -3.0, DVec3::Z * -3.1, 0.003);
    scene.elements.push(scenes::element(line, 0));
    for _ in 0..1000 {
        let place = numbers.vector(1.0);
        let ball = Shape::sphere(place * DVec3::new(0.3, 0.3, 1.0), 0.003);
        scene.elements.push(scenes::element(ball, 0));
    }
    // Far from all rays, but a third of T together.
    for i in 0..60 {
        let (y, x) = libm::sincos(f64::from(i));
        let ball = Shape::sphere(DVec3::new(2.0 * x, 2.0 * y, 0.0), 0.5);
        scene.elements.push(scenes::element(ball, 1));
    }
    let mut picture = Picture::new(&scene, [SIZE; 2]);
    let (shown, plain) = trace(&picture, Pass::Full);
    // Some rays see balls.
    assert!((100..4000).contains(&plain.shadow_rays), "{plain:?}");
    // A larger bound on rounding leaves more rays in doubt.
    picture.sampler.world.soft.precision.rounding *= 4.0;
    let (isolated, doubted) = trace(&picture, Pass::Full);
    let mut pairs = shown.iter().zip(&isolated);
    assert!(pairs.all(|(a, b)| a.abs_diff(*b) <= 1));
    // With all primitives at once it would be 7 times as many.
    let [plain, doubted] = [plain, doubted].map(|stats| stats.field_evaluations);
    assert!(
        plain < doubted && 2 * doubted < 3 * plain,
        "{plain} {doubted}"
    );
}

/// Scenes without secondary rays are shaded without paths, and look as they do with them, whatever
/// else is in the air.
#[test]
fn light_without_paths_is_the_same_as_with_them() {
    let mut lit = 0;
    let scenes = trials::count(4) as u64;
    for seed in 0..scenes {
        let mut scene = scenes::blend(seed, 4);
        scene.settings.samples = 3;
        scene.settings.tone = Tone::Filmic;
        scene.background = Background::Gradient(vec![[0.2, 0.4, 0.9], [0.9, 0.8, 0.6]]);
        scene.ground = (seed % 4 != 3).then_some(Ground {
            colour: [0.7, 0.6, 0.5],
            height: None,
        });
        scene.fog = (seed % 3 == 1).then_some(Fog {
            colour: [0.6; 3],
            distance: 9.0,
            height: None,
        });
        if seed % 2 == 0 {
            scene.clouds.push(Cloud {
                colour: [0.5, 0.4, 0.1],
                position: DVec3::new(0.5, 0.3, 0.2),
                radius: 0.8,
                density: 0.5,
            });
        }
        scene.lights.push(Light {
            shadow: seed % 2 == 1,
            ..Light::new(
                LightKind::Distant {
                    towards: DVec3::new(-0.3, 0.8, 0.4),
                },
                [0.3, 0.3, 0.4],
            )
        });
        // The camera looks from above.
        scene.camera.eye = DVec3::new(0.0, 2.0, 4.0);
        let mut picture = Picture::new(&scene, [SIZE; 2]);
        let passes = [Pass::Coarse, Pass::Full, Pass::Smooth];
        let direct = passes.map(|pass| trace(&picture, pass));
        let rich = picture.sampler.world.rich.as_mut().expect("it has a tone");
        assert!(rich.is_direct);
        rich.is_direct = false;
        for ((direct, stats), pass) in direct.iter().zip(passes) {
            let (paths, other) = trace(&picture, pass);
            let off = direct.iter().zip(&paths).filter(|(a, b)| a != b);
            // Rays at the very edge of a shadow are grouped otherwise.
            let off = off.count();
            assert!(off <= 12, "{seed} {pass:?}: {off} channels differ");
            assert_eq!(stats.primary_rays, other.primary_rays);
            lit += stats.shadow_rays;
        }
    }
    assert!(lit > 6000 * scenes, "{lit}");
}
