//! The commands that the parser makes part of the tree, and those of the library.

use crate::commands::build::{LIBRARY, clay, plain, row, structure};
use crate::commands::slot::{Slot, Unread, new, number, unread};
use crate::commands::{CommandSpec, Kind, Names};

const BLOCK: Slot<Unread> = unread("block", Kind::Block, "commands in `{ … }`");

pub static SHELL: CommandSpec = row("shell", "a spiral shell of spheres")
    .with(LIBRARY)
    .example(clay!(
        "eyep 1 3 1.5\nvrp -0.1 0 0\nvup 0 0 1\nshell Clay, 5, rise=0.4"
    ));

pub static HORN: CommandSpec = row("horn", "a curled horn that tapers")
    .with(LIBRARY)
    .example(clay!(
        "eyep 0.5 4 1.2\nvrp 0.5 0 0.7\nvup 0 0 1\nhorn Clay, length=2.5, curl=200"
    ));

pub static FOR: CommandSpec = row("for", "repeat commands")
    .with(structure(plain![
        new("i =", Names::Variable, "the name of the loop's variable"),
        number("a", "the first value"),
        number("to b", "the last value"),
        number("step c", "the step").optional("1"),
        BLOCK
    ]))
    .example(clay!(
        "for i = 0 to 11 { sphere Clay 0.4, 3*cos(rad(30*i)), 3*sin(rad(30*i)), 0 }"
    ));

pub static IF: CommandSpec = row("if", "run commands if a condition holds")
    .with(structure(plain![
        unread("condition", Kind::Condition, "a condition, such as `i < 3`"),
        BLOCK,
        unread("else { … }", Kind::Block, "what is run if it does not hold").optional("")
    ]))
    .example(clay!(
        "for i = -3 to 3 { if i < 0 or i > 1 { sphere Clay 0.4, i 0 0 } else { sphere Clay 0.4, i \
         1 0 } }"
    ));

pub static ELSE: CommandSpec = row("else", "the other branch of if")
    .with(structure(plain![BLOCK]))
    .example(clay!(
        "if 1 > 2 { sphere Clay 1, 0 0 0 } else { sphere Clay 2, 0 0 0 }"
    ));

pub static DEFINE: CommandSpec = row("define", "make a new command")
    .with(structure(plain![
        new(
            "name(a, B, c = 1)",
            Names::Command,
            "the new command's name and its parameters"
        ),
        BLOCK
    ]))
    .details(
        "A parameter in CAPITALS takes a triple, one written `surface s` the name of a material, \
         any other a number. A parameter with a value, `c = 1`, may be left out in a call; calls \
         may name parameters: `leg length=2`. `return` leaves the command.",
    )
    .example(clay!(
        "define leg(surface s, BASE, length = 2) {\n  \
         cylinder s 0.3, BASE, BASE - vec(0, length, 0)\n}\nleg Clay, -1 1 0\n\
         leg Clay, 1 1 0, length=3"
    ));

pub static TREE: CommandSpec = row("tree", "a branching tree").with(LIBRARY).example(
    "surface Bark, diffuse SaddleBrown, radius 0.3, blobbiness -3\n\
         light White, position 4 -8 10\neyep 0 -6 2\nvrp 0.3 0 1.2\nvup 0 0 1\ntree Bark",
);

pub static SPIKES: CommandSpec = row("spikes", "spikes scattered over a sphere")
    .with(LIBRARY)
    .example(clay!("eyep 0 0 3\nsphere Clay 0.5, 0 0 0\nspikes Clay"));

pub static SPHEREFLAKE: CommandSpec = row(
    "sphereflake",
    "the standard procedural database's flake of spheres",
)
.with(LIBRARY)
.example(clay!("eyep 2.1 1.3 1.7\nvup 0 0 1\nsphereflake Clay, 2"));

pub static SPIRAL: CommandSpec = row("spiral", "a spiral of spheres")
    .with(LIBRARY)
    .example(clay!(
        "eyep 1 4 2.5\nvrp 0 0 0.8\nvup 0 0 1\nspiral Clay, turns=4"
    ));
