//! Tests of all crossings of rays, against marching along them in small steps.
use glam::DVec3;
use scene::{Scene, Shape};
use tracer::Picture;
use trials::scenes::{blend, clothe, element, empty};
use trials::{Random, count};

/// Marches a ray through the exact field. Crossings closer together than a step may go unseen, so
/// within each step the number of hits must only be odd where the sign changes.
fn march(scene: &Scene, picture: &Picture, origin: DVec3, direction: DVec3) -> usize {
    let field = scene.soft_surfaces().swap_remove(0).sum;
    let hits = picture.hits(origin, direction);
    for pair in hits.windows(2) {
        assert!(pair[0].t <= pair[1].t);
    }
    for hit in &hits {
        let jet = field.jet(hit.position);
        let gradient = DVec3::from_array(jet.gradient);
        assert!(hit.t > 0.0);
        assert!(hit.position.distance(origin + direction * hit.t) < 1e-9 * (1.0 + hit.t));
        assert!((jet.value - 1.0).abs() < 1e-9, "{} at {hit:?}", jet.value);
        assert!(hit.normal.distance(-gradient.normalize()) < 1e-6);
    }
    let step = 2e-3;
    let mut before = field.jet(origin).value > 1.0;
    let mut start = 0.0;
    let mut next = hits.iter().peekable();
    while start < 9.0 {
        let end = start + step;
        let after = field.jet(origin + direction * end).value > 1.0;
        let mut between = 0;
        while next.next_if(|h| h.t <= end).is_some() {
            between += 1;
        }
        assert_eq!(between % 2 == 1, before != after, "at {start}: {hits:?}");
        before = after;
        start = end;
    }
    hits.len()
}

#[test]
fn rays_through_random_blends_cross_where_marching_says() {
    let mut n = Random::new(5);
    let mut seen = 0;
    for seed in 0..count(30) as u64 {
        let scene = blend(seed, 2 + seed as usize % 7);
        let picture = Picture::new(&scene, [64, 64]);
        for case in 0..6 {
            // From outside, and from somewhere in the middle, inside or not.
            let origin = n.vector(1.0) * if case % 2 == 0 { 4.0 } else { 0.8 };
            let direction = (n.vector(0.8) - origin).normalize();
            seen += march(&scene, &picture, origin, direction);
        }
    }
    assert!(seen > count(120), "{seen} hits");
}

#[test]
fn a_ray_grazing_a_ball_finds_both_crossings_or_none() {
    let mut scene = empty();
    clothe(&mut scene, vec![trials::scenes::soft(4.0, 1.0)]);
    scene
        .elements
        .push(element(Shape::sphere(DVec3::ZERO, 0.25), 0));
    let picture = Picture::new(&scene, [8, 8]);
    for exponent in 1..10 {
        let off = 10f64.powi(-exponent);
        let hits = |y: f64| picture.hits(DVec3::new(-3.0, y, 0.0), DVec3::X);
        let inside = hits(0.25 * (1.0 - off));
        assert_eq!(hits(0.25 * (1.0 + off)).len(), 0);
        let half = 0.25 * (1.0 - (1.0 - off) * (1.0 - off)).sqrt();
        // Down to a chord of about 1/3000 of the radius.
        if exponent <= 7 {
            assert_eq!(inside.len(), 2, "off by {off}");
            assert!((inside[0].t - 3.0 + half).abs() < 1e-7);
            assert!((inside[1].t - 3.0 - half).abs() < 1e-7);
        }
    }
}

#[test]
fn scenes_far_away_and_of_any_size_are_hit_alike() {
    for (scale, shift) in [
        (1.0, 0.0),
        (1e-6, 0.0),
        (1e6, 0.0),
        (1.0, 1e6),
        (1e-3, 50.0),
    ] {
        let mut scene = empty();
        clothe(&mut scene, vec![trials::scenes::soft(1.0, 1.0)]);
        let center = DVec3::splat(shift);
        let radius = 0.25 * scale;
        scene.flesh[0].radius = radius;
        scene
            .elements
            .push(element(Shape::sphere(center, radius), 0));
        let hits =
            Picture::new(&scene, [8, 8]).hits(center - DVec3::Z * (3.0 * scale), DVec3::Z * 7.0);
        assert_eq!(hits.len(), 2, "{scale} {shift}");
        let error = (hits[0].t - 2.75 * scale).abs();
        assert!(error < 1e-9 * (scale + shift), "{scale} {shift}: {error}");
        assert!(hits[0].normal.distance(DVec3::NEG_Z) < 1e-6);
    }
}

#[test]
fn hard_and_soft_crossings_come_in_one_order() {
    let mut scene = empty();
    clothe(
        &mut scene,
        vec![trials::scenes::soft(1.0, 1.0), scene::Flesh::default()],
    );
    for (x, material) in [(-1.0, 0), (0.0, 1), (1.0, 0)] {
        let center = DVec3::X * x;
        let radius = 0.2;
        scene
            .elements
            .push(element(Shape::sphere(center, radius), material));
    }
    let picture = Picture::new(&scene, [8, 8]);
    let hits = picture.hits(DVec3::X * -4.0, DVec3::X);
    assert_eq!(hits.len(), 6);
    assert!(hits.windows(2).all(|w| w[0].t < w[1].t));
    assert!((hits[2].t - 3.8).abs() < 1e-9 && (hits[3].t - 4.2).abs() < 1e-9);
    for (i, hit) in hits.iter().enumerate() {
        assert_eq!(hit.normal.x < 0.0, i % 2 == 0);
    }
}

#[test]
fn senseless_rays_hit_nothing() {
    let picture = Picture::new(&blend(3, 5), [8, 8]);
    assert!(picture.hits(DVec3::ZERO, DVec3::ZERO).is_empty());
    assert!(picture.hits(DVec3::NAN, DVec3::X).is_empty());
    assert!(picture.hits(DVec3::INFINITY, DVec3::X).is_empty());
    assert!(picture.hits(DVec3::ZERO, DVec3::NAN).is_empty());
}

/// The setting `double off` hides faces that are seen from behind.
#[test]
fn faces_seen_from_behind_may_be_hidden() {
    let mut scene = empty();
    let corners = [DVec3::NEG_X - DVec3::Y, DVec3::X - DVec3::Y, DVec3::Y];
    let radius = 0.0;
    scene.elements = vec![element(Shape::triangle(corners, radius), 0)];
    for double_sided in [true, false] {
        scene.settings.double_sided = double_sided;
        let picture = Picture::new(&scene, [8, 8]);
        let seen = |side: f64| picture.cast(&[(DVec3::Z * (4.0 * side), DVec3::Z * -side)])[0];
        let front = seen(1.0).expect("it is seen from the front");
        assert!(front.normal.dot(DVec3::Z) > 0.99 && front.enters(DVec3::NEG_Z));
        assert_eq!(front.element, Some(0));
        assert_eq!(seen(-1.0).is_some(), double_sided);
    }
}
