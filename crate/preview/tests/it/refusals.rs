//! Devices that refuse: a program that they do not compile, and one that is lost.

use crate::common::traced::{Card, cards};
use cells::{Cubics, Detail, Packed};
use preview::{Stage, Target, Tracer};
use scene::Scene;
use std::collections::BTreeSet;
use std::sync::Arc;

const TEXT: &str = "eyep 0 0 9\nvrp 0 0 0\nsurface a, diffuse Red, blobbiness -0.6\n\
    sphere a 0.9, -1.2 0 0\nsphere a 0.9, 1.2 0 0\n";

fn scene() -> Arc<Scene> {
    let project = rats::Project {
        files: vec![rats::File {
            name: "main.rat".into(),
            text: TEXT.into(),
        }],
    };
    rats::compile(&project).scene
}

fn pack(scene: &Scene) -> Packed {
    Packed::new(scene, Detail::Quick, &Cubics, &mut |_| true).expect("wanted")
}

/// Whether a tracer draws a scene.
fn draws(card: &Card, tracer: &mut Tracer, scene: &Scene) -> bool {
    let Card { device, queue } = card;
    let mut commands = device.create_command_encoder(&<_>::default());
    let target = tracer.render(device, queue, &mut commands, &scene.camera, [64, 48]);
    let is_drawn = matches!(target, Some(Target::Picture(_)));
    queue.submit([commands.finish()]);
    is_drawn
}

/// Text that is no program.
fn no_program(_: &BTreeSet<u32>) -> String {
    String::from("fn plain_term( {")
}

#[test]
fn a_program_that_does_not_compile_is_told_and_draws_nothing() {
    let scene = scene();
    let packed = pack(&scene);
    for card in cards() {
        let mut tracer = Tracer::new(&card.device, Stage::Fragment, no_program);
        assert_eq!(tracer.is_ready(), Ok(false));
        for _ in 0..2 {
            let taken = tracer.set_scene(&card.device, &card.queue, &scene, &packed);
            assert!(taken.is_some());
            let words = tracer.is_ready().expect_err("it is refused");
            assert!(!words.is_empty());
            assert!(!draws(&card, &mut tracer, &scene));
        }
        // Others are drawn by the same device.
        let mut tracer = Tracer::new(&card.device, Stage::Fragment, cells::formulas::none);
        let taken = tracer.set_scene(&card.device, &card.queue, &scene, &packed);
        assert!(taken.is_some() && draws(&card, &mut tracer, &scene));
    }
}

#[test]
fn a_lost_device_ends_nothing() {
    let scene = scene();
    let packed = pack(&scene);
    for card in cards() {
        let mut tracer = Tracer::new(&card.device, Stage::Fragment, cells::formulas::none);
        let taken = tracer.set_scene(&card.device, &card.queue, &scene, &packed);
        assert!(taken.is_some() && draws(&card, &mut tracer, &scene));
        // A browser writes errors of a lost device to its console; natively they would end the
        // test.
        card.device.on_uncaptured_error(Arc::new(|_| {}));
        card.device.destroy();
        // Draws the old scene, another one, and one by another tracer.
        draws(&card, &mut tracer, &scene);
        tracer.set_scene(&card.device, &card.queue, &scene, &packed);
        draws(&card, &mut tracer, &scene);
        let mut other = Tracer::new(&card.device, Stage::Fragment, cells::formulas::none);
        other.set_scene(&card.device, &card.queue, &scene, &packed);
        draws(&card, &mut other, &scene);
        let _ = card.device.poll(wgpu::PollType::Poll);
    }
}
