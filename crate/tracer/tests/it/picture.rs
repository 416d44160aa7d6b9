//! Tests of pictures: independence of tiles, passes, shadows, limits.
use field::Skeleton;
use glam::DVec3;
use scene::Ends;
use scene::{Finish, Flesh, Scene, Shape};
use std::cell::Cell;
use tracer::{Pass, Picture, SampleCache, Stats, Tile, tiles};
use trials::scenes::{blend, clothe, element, empty, soft};

/// Traces a picture tile by tile.
fn whole(scene: &Scene, size: [u32; 2], side: u32, pass: Pass) -> (Vec<u8>, Stats) {
    let picture = Picture::new(scene, size);
    let mut pixels = vec![0; 4 * (size[0] * size[1]) as usize];
    let mut stats = Stats::default();
    for tile in tiles(size[0], size[1], side) {
        let part = picture.trace(tile, pass, &|| false, &mut stats).unwrap();
        let row = 4 * tile.width as usize;
        assert_eq!(part.len(), row * tile.height as usize);
        for (y, line) in (tile.y..).zip(part.chunks_exact(row)) {
            let at = 4 * (y * size[0] + tile.x) as usize;
            pixels[at..at + row].copy_from_slice(line);
        }
    }
    (pixels, stats)
}

/// Returns a mixed scene: soft elements of all kinds and hard ones.
fn mixture(seed: u64) -> Scene {
    let mut scene = blend(seed, 7);
    scene.finishes.push(Finish {
        diffuse: [0.2, 0.9, 0.3],
        ..Finish::default()
    });
    let mut n = trials::Random::new(seed + 77);
    for kind in 0..4 {
        let shape = n.shape(kind);
        scene.elements.push(element(shape, 3));
    }
    for kind in 0..10 {
        // Hard, and with a blobbiness.
        let material = if kind < 5 { 3 } else { 0 };
        let shape = n.solid(kind);
        scene.elements.push(element(shape, material));
    }
    scene.settings.samples = 3;
    scene
}

#[test]
fn a_picture_does_not_depend_on_its_tiles_or_threads() {
    let size = [83, 61];
    for seed in 0..trials::count(3) as u64 {
        let scene = mixture(seed);
        for pass in [Pass::Coarse, Pass::Full, Pass::Smooth] {
            let (once, _) = whole(&scene, size, 128, pass);
            for side in [16, 32, 64, 11] {
                assert!(once == whole(&scene, size, side, pass).0, "{pass:?} {side}");
            }
            assert!(once == tracer::render(&Picture::new(&scene, size), 3, pass, &|_| ()).0);
            assert!(once.chunks_exact(4).all(|p| p[3] == 255));
        }
    }
}

#[test]
fn pictures_agree_with_exact_hits() {
    // Ambient light only, and a white background: a pixel tells whether its ray hit.
    for seed in 0..trials::count(8) as u64 {
        let mut scene = blend(seed, 6);
        scene.lights.clear();
        scene.background = [1.0; 3].into();
        // Rays that leave through the far end of a plane are beyond what is compared.
        scene.elements.retain(|e| e.shape.bounds(0.0).is_some());
        let size = [48, 40];
        let (pixels, stats) = whole(&scene, size, 64, Pass::Full);
        assert_eq!(stats.primary_rays, 48 * 40);
        let picture = Picture::new(&scene, size);
        let projection = scene.camera.projection(size[0], size[1]);
        let mut differing = 0;
        for (i, p) in pixels.chunks_exact(4).enumerate() {
            let (x, y) = (i as u32 % size[0], i as u32 / size[0]);
            let direction = projection.direction(
                (f64::from(x) + 0.5) / f64::from(size[0]),
                (f64::from(y) + 0.5) / f64::from(size[1]),
            );
            let hit = !picture.hits(projection.eye, direction).is_empty();
            let seen = p[..3] != [255; 3];
            differing += usize::from(hit != seen);
        }
        // Depth of influence and precision may move an outline by a small part of a pixel.
        assert!(
            differing <= 4,
            "{differing} pixels of {}",
            size[0] * size[1]
        );
    }
}

#[test]
fn a_coarse_block_has_the_colour_of_its_middle() {
    let scene = mixture(2);
    let (coarse, stats) = whole(&scene, [64, 64], 64, Pass::Coarse);
    assert_eq!(stats.primary_rays, 64);
    for (i, p) in coarse.chunks_exact(4).enumerate() {
        let (x, y) = (i % 64 / 8 * 8, i / 64 / 8 * 8);
        let corner = 4 * (y * 64 + x);
        assert_eq!(p, &coarse[corner..corner + 4]);
    }
}

#[test]
fn smoothing_touches_edges_only_and_tends_to_the_true_coverage() {
    let mut scene = empty();
    scene.lights.clear();
    scene.background = [0.0; 3].into();
    scene.finishes = vec![Finish {
        ambient: [1.0; 3],
        ..Finish::default()
    }];
    scene
        .elements
        .push(element(Shape::sphere(DVec3::ZERO, 1.0), 0));
    let size = [64, 64];
    let (full, _) = whole(&scene, size, 64, Pass::Full);
    // The ball's outline is a circle in the picture: a cone of half angle asin(1/4).
    let tangent = (0.25f64 / (1.0 - 0.0625f64).sqrt()) / libm::tan(25f64.to_radians());
    let exact = core::f64::consts::PI * (tangent * 32.0).powi(2);
    let mut previous = f64::INFINITY;
    for samples in [2, 4, 8] {
        scene.settings.samples = samples;
        let (smooth, stats) = whole(&scene, size, 64, Pass::Smooth);
        let mut changed = 0;
        for (a, b) in full.chunks_exact(4).zip(smooth.chunks_exact(4)) {
            changed += usize::from(a != b);
        }
        assert!(changed > 60 && changed < 300, "{changed}");
        let refined = (stats.primary_rays - 64 * 64) / u64::from(samples * samples);
        assert!(refined >= changed as u64 && refined < 500);
        let brightness = smooth.chunks_exact(4).map(|p| f64::from(p[0])).sum::<f64>() / 255.0;
        let error = (brightness - exact).abs();
        assert!(error < previous.max(0.5), "{samples}: {error}");
        previous = error;
    }
    scene.settings.samples = 1;
    assert!(full == whole(&scene, size, 64, Pass::Smooth).0);
}

#[test]
fn where_nothing_differs_each_pixel_has_one_ray() {
    let mut scene = empty();
    scene.settings.samples = 2;
    for size in [[5, 5], [13, 1], [2, 7]] {
        for pass in [Pass::Full, Pass::Smooth] {
            let (_, stats) = whole(&scene, size, 64, pass);
            assert_eq!(stats.primary_rays, u64::from(size[0] * size[1]), "{pass:?}");
        }
    }
}

#[test]
fn a_ball_casts_a_shadow_on_a_slab_and_not_on_itself() {
    for material in [0, 1] {
        let mut scene = empty();
        clothe(&mut scene, vec![soft(4.0, 1.0), Flesh::default()]);
        scene.finishes[0].specular = [0.0; 3];
        // Light straight along z, past the eye; eye from the side.
        scene.lights[0].kind = scene::LightKind::Distant { towards: DVec3::Z };
        scene.camera.eye = DVec3::new(0.0, -4.0, 4.0);
        scene.camera.fov = 20.0;
        let center = DVec3::new(0.0, 0.0, 1.0);
        scene
            .elements
            .push(element(Shape::sphere(center, 0.25), material));
        scene
            .elements
            .push(element(Shape::plane(DVec3::ZERO, DVec3::Z, 0.0), 1));
        let size = [96, 96];
        let projection = scene.camera.projection(size[0], size[1]);
        let picture = Picture::new(&scene, size);
        let (dark, shadows) = whole(&scene, size, 32, Pass::Full);
        assert!(shadows.shadow_rays > 1000);
        scene.lights[0].shadow = false;
        let (bright, none) = whole(&scene, size, 32, Pass::Full);
        assert_eq!(none.shadow_rays, 0);
        let mut shaded = 0;
        for i in 0..(size[0] * size[1]) as usize {
            let (x, y) = (i as u32 % size[0], i as u32 / size[0]);
            let direction =
                projection.direction((f64::from(x) + 0.5) / 96.0, (f64::from(y) + 0.5) / 96.0);
            let hit = picture.hits(projection.eye, direction)[0];
            let on_slab = hit.position.z.abs() < 1e-9;
            let away = hit.position.truncate().length() / 0.25;
            let is_dark = dark[4 * i] < bright[4 * i];
            shaded += usize::from(is_dark);
            if on_slab && away < 0.98 {
                assert!(is_dark, "{hit:?}");
            } else if !on_slab || away > 1.02 {
                // The ball's own lit side must be free of false shadow.
                assert!(!is_dark, "{material} {hit:?}");
            }
        }
        assert!(shaded > 100, "{shaded}");
    }
}

#[test]
fn samples_that_are_kept_change_nothing_and_are_taken_once() {
    // Not a multiple of packets, and with squares that are cut.
    let size = [135, 91];
    let scene = mixture(1);
    let picture = Picture::new(&scene, size);
    let all = u64::from(size[0] * size[1]);
    let trace = |side, pass, cache: &mut SampleCache| {
        let mut stats = Stats::default();
        let mut parts = Vec::new();
        for tile in tiles(size[0], size[1], side) {
            let part = picture.trace_with(tile, pass, cache, &|| false, &mut stats);
            parts.push(part.unwrap());
        }
        (parts, stats.primary_rays)
    };
    for side in [64, 11] {
        let (full, rays) = trace(side, Pass::Full, &mut SampleCache::default());
        assert_eq!(rays, all);
        let (smooth, alone) = trace(side, Pass::Smooth, &mut SampleCache::default());
        let (_, once) = whole(&scene, size, 256, Pass::Smooth);
        for room in [0, 4, 100] {
            let cache = &mut picture.cache(room);
            // Coarse samples must not enter the cache.
            let _ = trace(side, Pass::Coarse, cache);
            let (pixels, rays) = trace(side, Pass::Full, cache);
            assert!(pixels == full && rays <= all, "{side} {room}");
            let (pixels, refined) = trace(side, Pass::Smooth, cache);
            assert!(pixels == smooth, "{side} {room}");
            assert!(refined <= alone);
            let (pixels, again) = trace(side, Pass::Full, cache);
            assert!(pixels == full);
            // A picture of six squares.
            if room >= 6 && side % 4 == 0 {
                assert_eq!(rays + refined, once.primary_rays, "{side} {room}");
                assert_eq!(again, 0);
            }
            if room == 0 {
                assert_eq!((rays, refined), (all, alone));
            }
        }
    }
    // No samples are kept if no pass would ask for them.
    let mut plain = scene;
    plain.settings.samples = 1;
    let picture = Picture::new(&plain, size);
    let cache = &mut picture.cache(100);
    let tile = tiles(size[0], size[1], 64)[0];
    let mut stats = Stats::default();
    let _ = picture.trace_with(tile, Pass::Full, cache, &|| false, &mut stats);
    assert_eq!(cache.squares(), 0);
}

#[test]
fn samples_that_another_took_are_as_good_as_ones_own() {
    let size = [135, 91];
    let scene = mixture(1);
    let picture = Picture::new(&scene, size);
    let tiles = tiles(size[0], size[1], 64);
    let trace = |tile, pass, cache: &mut SampleCache| {
        let mut stats = Stats::default();
        let part = picture.trace_with(tile, pass, cache, &|| false, &mut stats);
        (part.unwrap(), stats.primary_rays)
    };
    let first = &mut picture.cache(100);
    for tile in &tiles {
        assert_eq!(first.tell(*tile), None, "nothing is known yet");
    }
    for tile in &tiles {
        let _ = trace(*tile, Pass::Full, first);
    }
    let known: Vec<_> = tiles.iter().filter_map(|tile| first.tell(*tile)).collect();
    assert_eq!(known.len(), tiles.len());
    for own in &known {
        let tile = own.tile();
        // Only the samples that this tile needs, in pieces.
        let wanted = tracer::around(tile, size);
        let second = &mut picture.cache(100);
        let parts = known.iter().filter_map(|other| other.part(wanted));
        parts.for_each(|part| second.learn(&part));
        assert_eq!(second.tell(tile).as_ref(), Some(own));
        let (pixels, rays) = trace(tile, Pass::Smooth, first);
        let (others, again) = trace(tile, Pass::Smooth, second);
        assert!(pixels == others, "{tile:?}");
        assert_eq!(rays, again, "{tile:?}");
        assert_eq!(own.part(tile).as_ref(), Some(own));
    }
    // Pieces of a picture that is larger.
    let cache = &mut Picture::new(&scene, [100, 60]).cache(100);
    known.iter().for_each(|known| cache.learn(known));
    assert_eq!(cache.squares(), 0);
    // Only whole packets are kept: 4×2 pixels.
    let odd = |x, y, width, height| Tile {
        x,
        y,
        width,
        height,
    };
    let learn = |tile| {
        let mut cache = picture.cache(100);
        let parts = known.iter().filter_map(|known| known.part(tile));
        parts.for_each(|part| cache.learn(&part));
        cache
    };
    assert_eq!(learn(odd(13, 9, 6, 2)).tell(odd(13, 9, 6, 2)), None);
    let cache = learn(odd(13, 9, 12, 5));
    assert!(cache.tell(odd(16, 10, 8, 4)).is_some());
    for one in [odd(13, 10, 4, 2), odd(16, 9, 4, 2), odd(16, 10, 9, 2)] {
        assert_eq!(cache.tell(one), None, "{one:?}");
    }
}

#[test]
fn the_edges_of_a_full_pass_foretell_what_the_smooth_one_takes() {
    let (mut scene, size) = (mixture(1), [135, 91]);
    let all = u64::from(size[0] * size[1]);
    let mut edges = |samples: u32, pass| {
        scene.settings.samples = samples;
        let (_, stats) = whole(&scene, size, 48, pass);
        (stats.edges, stats.primary_rays)
    };
    assert_eq!(edges(1, Pass::Full), (0, all));
    let (foretold, _) = edges(3, Pass::Full);
    assert_eq!(edges(3, Pass::Coarse).0, 0);
    let (none, rays) = edges(3, Pass::Smooth);
    assert_eq!(none, 0);
    // With 6×6 rays a pixel that gets more has 27 more than with 3×3.
    let refined = (edges(6, Pass::Smooth).1 - rays) / 27;
    let ratio = refined as f64 / foretold as f64;
    assert!((1.5..3.0).contains(&ratio), "{refined} for {foretold}");
}

#[test]
fn a_cache_keeps_no_squares_for_strips_and_serves_no_other_size() {
    let scene = mixture(1);
    let size = [135, 91];
    let picture = Picture::new(&scene, size);
    let mut stats = Stats::default();
    let mut trace = |picture: &Picture, tile, cache: &mut SampleCache| {
        let with = picture.trace_with(tile, Pass::Full, cache, &|| false, &mut stats);
        assert_eq!(
            with,
            picture.trace(tile, Pass::Full, &|| false, &mut Stats::default())
        );
    };
    let middle = tiles(size[0], size[1], 64)
        .into_iter()
        .find(|tile| (tile.x, tile.y) == (64, 0))
        .unwrap();
    let cache = &mut picture.cache(100);
    let _ = picture.trace_with(
        middle,
        Pass::Smooth,
        cache,
        &|| false,
        &mut Stats::default(),
    );
    assert_eq!(cache.squares(), 1);
    trace(&picture, middle, cache);
    // Beyond the edge, and with what is known there.
    let over = Tile { x: 100, ..middle };
    trace(&picture, over, cache);
    trace(&picture, over, cache);
    let other = Picture::new(&scene, [140, 91]);
    trace(&other, middle, cache);
    assert_eq!(cache.squares(), 1);
}

/// Pictures have two sheets of 2048 pixels, of which the second is narrow.
#[test]
fn a_picture_of_several_sheets_is_that_of_its_tiles() {
    let scene = mixture(1);
    for size in [[2101, 40], [40, 2101]] {
        let picture = Picture::new(&scene, size);
        let (rgba, _) = tracer::render(&Picture::new(&scene, size), 2, Pass::Smooth, &|_| {});
        for tile in tiles(size[0], size[1], 256) {
            let part = picture.trace(tile, Pass::Smooth, &|| false, &mut Stats::default());
            for (y, line) in part.unwrap().chunks(4 * tile.width as usize).enumerate() {
                let at = 4 * ((tile.y as usize + y) * size[0] as usize + tile.x as usize);
                assert!(&rgba[at..at + line.len()] == line, "{tile:?} {y}");
            }
        }
    }
}

#[test]
fn no_sample_is_taken_twice_whatever_the_number_of_threads() {
    let scene = mixture(2);
    let size = [150, 140];
    let (_, once) = whole(&scene, size, 256, Pass::Smooth);
    for threads in [1, 2, 5] {
        let shares = std::sync::Mutex::new(Vec::new());
        let picture = Picture::new(&scene, size);
        let (_, stats) = tracer::render(&picture, threads, Pass::Smooth, &|share| {
            shares.lock().unwrap().push(share);
        });
        assert_eq!(stats.primary_rays, once.primary_rays);
        let shares = shares.into_inner().unwrap();
        assert_eq!(shares.len(), 2 * 9);
        assert!(shares.contains(&1.0) && shares.iter().all(|share| (0.0..=1.0).contains(share)));
    }
}

#[test]
fn a_tile_is_given_up_when_asked_to_stop() {
    let scene = mixture(1);
    let picture = Picture::new(&scene, [256, 256]);
    let tile = Tile {
        x: 0,
        y: 0,
        width: 256,
        height: 256,
    };
    for pass in [Pass::Coarse, Pass::Full, Pass::Smooth] {
        let asked = Cell::new(0);
        let mut stats = Stats::default();
        let pixels = picture.trace(
            tile,
            pass,
            &|| {
                asked.set(asked.get() + 1);
                asked.get() > 3
            },
            &mut stats,
        );
        assert!(pixels.is_none());
        assert_eq!(asked.get(), 4);
        assert!(stats.primary_rays < 1000);
    }
}

#[test]
fn a_surface_seen_from_inside_is_lit() {
    let mut scene = empty();
    clothe(&mut scene, vec![soft(0.5, 1.0)]);
    scene.background = [0.0, 0.0, 1.0].into();
    scene.camera.eye = DVec3::ZERO;
    scene.camera.target = DVec3::X;
    scene.lights[0].kind = scene::LightKind::Point {
        position: DVec3::ZERO,
    };
    let radius = 0.25;
    let center = DVec3::ZERO;
    scene
        .elements
        .push(element(Shape::sphere(center, radius), 0));
    let (pixels, _) = whole(&scene, [16, 16], 16, Pass::Full);
    for p in pixels.chunks_exact(4) {
        assert!(p[0] > 200 && p[0] == p[2], "{p:?}");
    }
}

// Native only: WebAssembly has no clock of its own.
#[test]
fn strange_scenes_end() {
    let mut scenes = vec![Scene::default()];
    for bad in [0.0, -1.0, 1e-300, 1e300, f64::NAN, f64::INFINITY] {
        let mut scene = mixture(4);
        scene.camera.eye.x = bad;
        scenes.push(scene);
        let mut scene = mixture(4);
        scene.camera.eye = DVec3::splat(bad);
        scene.camera.target = DVec3::splat(bad);
        scene.camera.up = DVec3::ZERO;
        scene.camera.fov = bad;
        scenes.push(scene);
        let mut scene = mixture(5);
        for flesh in &mut scene.flesh {
            flesh.radius = bad;
        }
        for finish in &mut scene.finishes {
            finish.shine = bad as f32;
            finish.diffuse = [bad as f32; 3];
        }
        scene.settings.fragile = scene::Fragile::ALL;
        scene.settings.gamma = bad as f32;
        scene.settings.contrast = [bad as f32; 3];
        scenes.push(scene);
        let mut scene = mixture(6);
        for flesh in &mut scene.flesh {
            flesh.blobbiness = Some(bad);
            flesh.strength = bad;
        }
        scenes.push(scene);
        let mut scene = mixture(7);
        for (i, e) in scene.elements.iter_mut().enumerate() {
            let bone = match &mut e.shape {
                Shape::Bone(bone) => bone,
                Shape::Box(cuboid) => {
                    cuboid.axes[1] *= bad;
                    continue;
                }
                Shape::Quadric(quadric) => {
                    quadric.constant = bad;
                    continue;
                }
                Shape::Function(function) => {
                    function.to_world.translation.x = bad;
                    continue;
                }
            };
            match &mut bone.skeleton {
                _ if bone.end_radius.is_some() => bone.end_radius = Some(bad),
                Skeleton::Point { center } if i % 2 == 0 => center.y = bad,
                Skeleton::Point { .. } => bone.radius = bad,
                Skeleton::Segment { apex, .. } if bone.ends == Ends::Open => apex.z = bad,
                Skeleton::Segment { base, apex } => {
                    bone.radius = bad;
                    if i % 3 == 0 {
                        *apex = *base;
                    }
                }
                Skeleton::Arc { radius, .. } if i % 2 == 0 => *radius = bad,
                Skeleton::Arc { angle, .. } => *angle = bad,
                Skeleton::Triangle { corners } => match &mut bone.normals {
                    None => corners[1] = corners[0] + bad,
                    Some(normals) => {
                        normals[2] *= bad;
                        if i % 2 == 0 {
                            corners[0].x = bad;
                        }
                    }
                },
                Skeleton::Polygon { rings } => rings[0][0].x = bad,
                Skeleton::Curve { control } => control[2].y = bad,
                Skeleton::Plane { normal, .. } => *normal *= bad,
            }
        }
        scene.lights[0].kind = scene::LightKind::Point {
            position: DVec3::splat(bad),
        };
        scenes.push(scene);
    }
    for (i, scene) in scenes.iter().enumerate() {
        let (pixels, stats) = whole(scene, [11, 5], 8, Pass::Smooth);
        assert_eq!(pixels.len(), 4 * 11 * 5);
        // By counts, as times are the machine's; the dearest makes 3.1·10⁷.
        let evaluations = stats.field_evaluations;
        assert!(evaluations < 1 << 26, "scene {i} took {evaluations}");
        let _ = Picture::new(scene, [4, 4]).hits(DVec3::new(0.1, 0.2, 5.0), DVec3::NEG_Z);
    }
}
