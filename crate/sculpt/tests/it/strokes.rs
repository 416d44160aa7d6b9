//! Random strokes.

use sculpt::{
    Action, Choice, Constraint, Decay, Deletion, Form, MaskChange, PathPoint, Refinement,
    RegionChange, Stroke, Sweep, Tool,
};
use trials::Random;

pub fn tool(random: &mut Random) -> Tool {
    let mut tool = Tool::new(random.pick(&Form::ALL), random.vector(0.2).abs() + 0.1);
    if random.below(3) == 0 {
        tool.exponents = [(); 2].map(|()| random.range(0.05, 2.0));
    }
    if random.below(3) == 0 {
        tool.turn = random.vector(180.0);
    }
    tool
}

pub fn sweep(random: &mut Random, action: Action) -> Sweep {
    let mut sweep = Sweep::new(action, tool(random));
    if random.below(3) > 0 {
        sweep.decay = random.pick(&Decay::ALL);
        sweep.range = random.range(0.05, 0.8);
    }
    sweep.constraint = random.pick(&[
        None,
        None,
        Some(Constraint::Normal),
        Some(Constraint::Tangent),
    ]);
    sweep.only_region = random.below(4) == 0;
    let mut p = random.vector(1.0);
    for _ in 0..=random.below(4) {
        sweep.path.push(PathPoint {
            position: p,
            pressure: if random.below(2) == 0 {
                1.0
            } else {
                random.unit()
            },
        });
        p += random.vector(0.3);
    }
    sweep
}

/// Returns a stroke for a mesh of so many faces; it keeps meshes small.
pub fn stroke(random: &mut Random, faces: usize) -> Stroke {
    if faces > 500 {
        return match random.below(8) {
            0 => Stroke::Delete(random.pick(&Deletion::ALL)),
            1 | 2 => Stroke::Region(RegionChange::All),
            _ => Stroke::Simplify(random.range(0.1, 0.6)),
        };
    }
    match random.below(32) {
        0..6 => Stroke::Sweep(sweep(random, Action::Push)),
        6..11 => Stroke::Sweep(sweep(random, Action::Pull)),
        11 => Stroke::Sweep(sweep(random, Action::Smooth)),
        12 => {
            let value = random.pick(&[0.0, 0.5, 1.0, 1.0]);
            Stroke::Sweep(sweep(random, Action::Mask(value)))
        }
        13 => {
            let color = [(); 3].map(|()| random.unit());
            Stroke::Sweep(sweep(random, Action::Paint(color)))
        }
        14..19 => {
            let choice = random.pick(&Choice::ALL);
            Stroke::Sweep(sweep(random, Action::Region(choice)))
        }
        19 => Stroke::Region(random.pick(&[
            RegionChange::All,
            RegionChange::All,
            RegionChange::None,
            RegionChange::Invert,
            RegionChange::Grow(1),
            RegionChange::Shrink(1),
        ])),
        20 => Stroke::Masks(random.pick(&[
            MaskChange::Clear,
            MaskChange::Clear,
            MaskChange::Clear,
            MaskChange::Invert,
        ])),
        21 | 22 => Stroke::Refine(random.pick(&Refinement::ALL)),
        23 => Stroke::Loop(1),
        24 => Stroke::Average(1 + random.below(3) as u32, random.unit()),
        25..27 => Stroke::Fill,
        27..29 => Stroke::Delete(random.pick(&Deletion::ALL)),
        29 => Stroke::Simplify(random.range(0.3, 1.0)),
        30 => Stroke::Symmetry([(); 3].map(|()| random.below(3) == 0)),
        _ => Stroke::Stage(String::from("here")),
    }
}
