//! Materials, textures, lights, air and the shutter: what a text says arrives in the scene.

use glam::DVec3;
use rats::{Asset, Compiled, Project, Severity, compile_at};
use scene::{Background, Finish, LightKind, Scene, Skip, Tone};
use texture::{Mapping, Method, Solid, Target, Wave};

fn run(text: &str, assets: &[Asset], moment: f64) -> Compiled {
    compile_at(&Project::single(text), assets, moment)
}

/// The scene of a text about which there is nothing to say.
#[track_caller]
fn scene(text: &str) -> Scene {
    let compiled = run(text, &[], 0.0);
    let is_unused = |d: &&rats::Diagnostic| d.message.starts_with("nothing is made of");
    let complaint = compiled.diagnostics.iter().find(|d| !is_unused(d));
    assert_eq!(complaint, None, "{text}");
    std::sync::Arc::unwrap_or_clone(compiled.scene)
}

#[track_caller]
fn finish(text: &str) -> Finish {
    scene(&format!("surface s {text}\nsphere s 1 0 0 0")).finishes[0].clone()
}

#[track_caller]
fn layers(texture: &str) -> Vec<texture::Texture> {
    let text = format!("{texture}\nsurface s diff Red, texture T\nsphere s 1 0 0 0");
    scene(&text).finishes[0].layers.clone()
}

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

#[test]
fn mirrors_and_glass() {
    let glass = finish(
        "diff Black, reflective 10%, transparent 0.8 0.9 1, index 1.5, \
         dispersion 0.02, skip shadow reflected",
    );
    assert_eq!(glass.reflective, [0.1; 3]);
    assert_eq!(glass.transparent, [0.8, 0.9, 1.0]);
    assert_eq!((glass.index, glass.dispersion), (1.5, 0.02));
    let wanted = Skip {
        shadow: true,
        reflected: true,
        ..Skip::default()
    };
    assert_eq!(glass.skip, wanted);
    // A copy goes on from what it copies.
    let copy = scene(
        "surface a diff Red, index 1.3, transparent 50%, specular 20%\nsurface b = a, index 2\n\
         sphere b 1 0 0 0",
    );
    let copy = &copy.finishes[1];
    assert_eq!((copy.index, copy.transparent), (2.0, [0.5; 3]));
    assert_eq!(copy.specular, [0.2; 3]);
    let plain = finish("diff Red");
    assert_eq!((plain.index, plain.skip), (1.0, Skip::default()));
    assert_eq!(plain.layers, []);
}

#[test]
fn every_target_and_method() {
    let targets = [
        ("diffuse", Target::Diffuse),
        ("ambient", Target::Ambient),
        ("specular", Target::Specular),
        ("reflective", Target::Reflective),
        ("transparent", Target::Transparent),
        ("index", Target::Index),
        ("shine", Target::Shine),
        ("pigment", Target::Pigment),
        ("normal", Target::Normal),
    ];
    for (word, target) in targets {
        assert_eq!(layers(&format!("texture T {word} wood"))[0].target, target);
    }
    for (solid, word) in Solid::ALL.into_iter().zip([
        "marble", "agate", "granite", "moon", "onion", "wood", "ripples", "sandal", "checker",
        "paint",
    ]) {
        let layer = &layers(&format!("texture T pigment {word}"))[0];
        assert_eq!(layer.method, Method::Solid(solid), "{word}");
    }
    for (wave, word) in Wave::ALL.into_iter().zip([
        "one", "x", "saw", "hat", "step", "sin", "cos", "sin^2", "cos^2",
    ]) {
        let layer = &layers(&format!("texture T normal {word} one"))[0];
        assert_eq!(layer.method, Method::Waves([wave, Wave::One]), "{word}");
    }
    let layer = &layers("texture T pigment Red")[0];
    assert_eq!(layer.method, Method::Colour(v(1.0, 0.0, 0.0)));
}

#[test]
fn options_of_textures() {
    let text = "texture T { pigment wood, translate 1 2 3, scale 2 3 4, times 0.5 0.6 0.7
        bounds <DarkWood 1 1 1>, turbulence 0.4, octaves 2.5, mask 1 0 1 0 1 1, replace }";
    let layer = &layers(text)[0];
    assert_eq!(layer.translate, v(1.0, 2.0, 3.0));
    assert_eq!(layer.scale, v(2.0, 3.0, 4.0));
    assert_eq!(layer.times, v(0.5, 0.6, 0.7));
    let dark = rats::colours::find("DarkWood")
        .expect("a colour")
        .map(f64::from);
    assert_eq!(layer.bounds, [DVec3::from_array(dark), DVec3::ONE]);
    assert_eq!((layer.grain.turbulence, layer.grain.octaves), (0.4, 2.5));
    assert_eq!(layer.mask, [true, false, true, false, true, true]);
    assert!(layer.replace);
    let plain = texture::Texture::new(Target::Pigment, Method::Solid(Solid::Wood));
    assert_eq!(layers("texture T pigment wood"), [plain]);
}

#[test]
fn layers_lie_upon_each_other() {
    let targets = |text: &str| -> Vec<Target> { layers(text).iter().map(|l| l.target).collect() };
    let both = "texture A normal ripples\ntexture B pigment wood\n";
    let wanted = [Target::Normal, Target::Pigment];
    assert_eq!(targets(&format!("{both}texture T texture A + B")), wanted);
    let own_first = [Target::Shine, Target::Normal, Target::Pigment];
    assert_eq!(
        targets(&format!("{both}texture T shine agate, texture A + B")),
        own_first
    );
    // Options behind layers and copies change each of them, but not the originals.
    let text = format!("{both}texture T texture A + B, scale 2 2 2");
    assert!(layers(&text).iter().all(|l| l.scale == DVec3::splat(2.0)));
    let text = format!("{both}texture C = A, scale 3 3 3\ntexture T texture A + C");
    let scales: Vec<f64> = layers(&text).iter().map(|l| l.scale.x).collect();
    assert_eq!(scales, [1.0, 3.0]);
    // A material's own list, and one of a profile with other layers.
    let scene = scene(&format!(
        "{both}texture P strength sin one\n\
         surface s diff Red, rad 1, blob -1, texture A + P, texture B\nsphere s 1 0 0 0"
    ));
    assert_eq!(scene.finishes[0].layers.len(), 2);
    assert!(scene.flesh[0].profile.is_some());
}

/// A PNG file of one colour.
fn png(name: &str, colour: [u8; 4]) -> Asset {
    let picture = picture::Picture::filled(4, 2, colour).expect("a small picture");
    let bytes = picture::file::encode(&picture, picture::Format::Png).expect("a PNG");
    Asset::new(name, bytes)
}

#[test]
fn images_of_the_project() {
    let assets = [
        png("a.png", [255, 0, 0, 255]),
        png("maps/b.png", [0, 255, 0, 255]),
    ];
    let text = "texture A pigment a.png plain\n\
        texture B diffuse maps/b.png region <-1 -1 -1> <1 1 1> <-1 -1 2> \
        <1 -1 2> <1 1 2> <-1 1 2>\n\
        texture C specular a.png plain, scale 2 2 1\nbackground a.png\n\
        surface s diff White, texture A + B + C\nsphere s 1 0 0 0\n";
    let compiled = run(text, &assets, 0.0);
    assert_eq!(compiled.diagnostics, []);
    let scene = compiled.scene;
    // Each file once.
    assert_eq!(scene.images.len(), 2);
    assert_eq!(scene.images[0].size, [4, 2]);
    assert_eq!(scene.images[1].bytes[..3], [0, 255, 0]);
    assert_eq!(scene.background, Background::Image(0));
    let methods: Vec<Method> = scene.finishes[0].layers.iter().map(|l| l.method).collect();
    let corner = v(1.0, 1.0, 2.0);
    assert_eq!(methods[0], Method::Image(0, Mapping::Plain));
    assert!(matches!(methods[1], Method::Image(1, Mapping::Region(r)) if r.corners[2] == corner));
    assert_eq!(methods[2], Method::Image(0, Mapping::Plain));
    // A second compilation shares the pixels.
    let again = run(text, &assets, 0.0).scene;
    assert!(std::sync::Arc::ptr_eq(&again.images[0], &scene.images[0]));
}

#[test]
fn images_that_are_broken_or_huge_are_refused() {
    let mut broken = png("a.png", [0; 4]);
    broken.bytes = broken.bytes[..20].into();
    let compiled = run("background a.png", &[broken], 0.0);
    assert_eq!(compiled.diagnostics[0].severity, Severity::Error);
    // Two of them are together above the limit.
    let side = 2100_u32;
    let large = picture::Picture::filled(side, side, [9; 4]).expect("a picture");
    let bytes: std::sync::Arc<[u8]> = picture::file::encode(&large, picture::Format::Png)
        .expect("a PNG")
        .into();
    let assets = ["a.png", "b.png"].map(|name| Asset::new(name, bytes.clone()));
    assert!(2 * u64::from(side * side) > rats::limits::MAX_IMAGE_PIXELS);
    let text = "texture A pigment a.png plain\ntexture B pigment b.png plain";
    let found = run(text, &assets, 0.0).diagnostics;
    assert_eq!((found.len(), found[0].line), (1, 2));
    assert!(found[0].message.contains("pixels together"), "{found:?}");
}

#[test]
fn spots_and_sizes() {
    let lights = scene(
        "penumbra on\nlight White spot pos 0 5 0 angle 40\n\
         light 1 0.5 0 spot pos 1 2 3, dir 0 0 -2, ang 20, edge 0, inten 2, size 0.3, noshadow",
    )
    .lights;
    let wanted = LightKind::Spot {
        position: v(0.0, 5.0, 0.0),
        direction: -DVec3::Y,
        angle: 40.0,
        edge: 10.0,
    };
    assert_eq!(lights[0].kind, wanted);
    let wanted = LightKind::Spot {
        position: v(1.0, 2.0, 3.0),
        direction: -DVec3::Z,
        angle: 20.0,
        edge: 0.0,
    };
    assert_eq!(lights[1].kind, wanted);
    assert_eq!((lights[1].colour, lights[1].size), ([2.0, 1.0, 0.0], 0.3));
    assert!(!lights[1].shadow && lights[0].shadow && lights[0].size == 0.0);
}

#[test]
fn air() {
    let found = scene(
        "vup 0 0 2\neyep 10 0 0\nfog Gray\ncloud Gold\ncloud White, pos 1 2 3, rad 2, dens 0.5\n\
         sky White to SkyBlue, intensity 0.5, samples 8\nground Tan, height -1\ntone filmic",
    );
    assert_eq!(found.up, DVec3::Z);
    let fog = found.fog.expect("fog");
    assert_eq!((fog.distance, fog.height), (20.0, None));
    let clouds: Vec<_> = found
        .clouds
        .iter()
        .map(|c| (c.position, c.radius, c.density))
        .collect();
    assert_eq!(
        clouds,
        [(DVec3::ZERO, 1.0, 1.0), (v(1.0, 2.0, 3.0), 2.0, 0.5)]
    );
    let sky = found.sky.expect("a sky");
    let blue = rats::colours::find("SkyBlue").expect("a colour");
    assert_eq!((sky.colour, sky.samples), ([0.5; 3], 8));
    assert_eq!(sky.horizon, blue.map(|c| 0.5 * c));
    // Without a background the sky is seen, as bright as its colours are.
    assert_eq!(found.background, Background::Gradient(vec![[1.0; 3], blue]));
    assert_eq!(found.ground.expect("a ground").height, Some(-1.0));
    assert_eq!(found.settings.tone, Tone::Filmic);
    let fog = scene("fog Gray, distance 3, height 2").fog.expect("fog");
    assert_eq!((fog.distance, fog.height), (3.0, Some(2.0)));
    let halo = scene(
        "surface s diff Red\nobject O\nsphere s 1 0 0 0\nsphere s 1 4 0 0\nclose\n\
         cloud Red, object O",
    );
    assert_eq!(halo.clouds[0].position, v(2.0, 0.0, 0.0));
    assert_eq!(halo.clouds[0].radius, 2.0 * v(3.0, 1.0, 1.0).length());
}

#[test]
fn backgrounds() {
    assert_eq!(scene("background 1 0 0").background, [1.0, 0.0, 0.0].into());
    let wanted = Background::Gradient(vec![[1.0, 0.0, 0.0], [0.0; 3], [1.0; 3]]);
    assert_eq!(scene("background Red to Black to White").background, wanted);
    let own = scene("background Red\nsky White").background;
    assert_eq!(own, [1.0, 0.0, 0.0].into());
    let text =
        "background Red to Blue\nsky White\nground Tan\nfog Gray\ncloud Red\naperture 1\nfocus 2\n";
    let reset = scene(&format!("{text}reset background fog clouds cameras"));
    assert_eq!(reset, Scene::default());
    let some = scene(&format!("{text}reset background"));
    assert!(some.sky.is_none() && some.ground.is_none() && some.fog.is_some());
    assert_eq!(some.clouds.len(), 1);
}

#[test]
fn materials_glow_less_under_a_sky() {
    let ambient = |text: &str| scene(&format!("{text}\nsphere s 1 0 0 0")).finishes[0].ambient;
    assert_eq!(ambient("surface s diff White"), [Finish::AMBIENT_SHARE; 3]);
    assert_eq!(ambient("surface s diff White\nsky White"), [0.0; 3]);
    assert_eq!(
        ambient("surface s diff White, ambient 30%\nsky White"),
        [0.3; 3]
    );
}

#[test]
fn lens_and_rays() {
    let found = scene("aperture 0.2\nfocus 7\nmaxdepth 8\nvanish 0.5\nepsilon 1e-6\npenumbra on");
    assert_eq!((found.lens.aperture, found.lens.focus), (0.2, Some(7.0)));
    assert_eq!((found.settings.max_depth, found.settings.vanish), (8, 0.5));
    assert!(found.settings.penumbra && found.settings.epsilon == 1e-6);
}

#[test]
fn means_are_of_many_samples() {
    // Some are told that their words alone do nothing.
    let samples = |text: &str| run(text, &[], 0.0).scene.settings.samples;
    for text in [
        "aperture 0.2",
        "penumbra on\nlight White position 0 9 0 size 1",
        "sky White",
        "var x = 0 += 1\nshutter 1",
    ] {
        assert_eq!(samples(text), 4, "{text}");
        assert_eq!(samples(&format!("sample 1\n{text}")), 1, "{text}");
    }
    for text in [
        "penumbra on",
        "shutter 1",
        "light White position 0 9 0 size 1",
    ] {
        assert_eq!(samples(text), 1, "{text}");
    }
}

fn places(scene: &Scene) -> Vec<f64> {
    scene.elements.iter().map(|e| e.shape.middle().x).collect()
}

#[test]
fn moments_of_an_open_shutter() {
    let text = "var x = 0 += 8\nshutter 0.5\nsample 2\nsurface s diff Red\nsphere s 1 x 0 0\n\
        sphere s 1 5 0 0\n";
    let compiled = run(text, &[], 3.0);
    assert_eq!(places(&compiled.scene), [24.0, 5.0]);
    // The middles of four equal shares of half a frame.
    let found: Vec<_> = compiled.scene.moments.iter().map(places).collect();
    let wanted = [24.5, 25.5, 26.5, 27.5].map(|x| vec![x, 5.0]);
    assert_eq!(found, wanted);
    assert!(compiled.scene.moments.iter().all(|m| m.moments.is_empty()));
    let count = |text: &str| run(text, &[], 0.0).scene.moments.len();
    assert_eq!(count(&text.replace("sample 2", "sample 3")), 9);
    assert_eq!(
        count(&text.replace("sample 2", "sample 16")),
        rats::limits::MAX_MOMENTS
    );
    // Nothing moves, the shutter is not open, or the text is wrong.
    assert_eq!(count(&text.replace("sphere s 1 x", "sphere s 1 2")), 0);
    assert_eq!(count(&text.replace("shutter 0.5", "shutter 0")), 0);
    assert_eq!(count(&format!("{text}spere s 1 0 0 0\n")), 0);
}

#[test]
fn transform_holds_still() {
    let text = "var x = 0 += 4\nshutter 1\nsample 2\nsurface s diff Red\n\
        object A\nsphere s 1 0 0 0\nclose\ntranslate x 0 0 A\ntransform A\ntranslate 0.5*x 0 0 A\n\
        object B\nsphere s 1 x 0 0\nclose\n";
    let scene = run(text, &[], 2.0).scene;
    assert_eq!(places(&scene), [12.0, 8.0]);
    let found: Vec<_> = scene.moments.iter().map(places).collect();
    // The first shift is that of the frame, the second goes on.
    let wanted: Vec<_> = [8.5, 9.5, 10.5, 11.5]
        .iter()
        .map(|x| vec![8.0 + 0.5 * x, *x])
        .collect();
    assert_eq!(found, wanted);
}
