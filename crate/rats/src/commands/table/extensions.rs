//! Ours: what the original language did not have.

use crate::commands::build::{clay, flesh, library, row, run, structure};
use crate::commands::options as o;
use crate::commands::parameter::{
    Arity, Kind, Names, Parameter, colour, length, number, parameter, vector, word,
};
use crate::commands::spec::{CommandSpec, Routine};

const BLOCK: Parameter = parameter("block", Kind::Block, "commands in `{ … }`");

/// The commands.
#[rustfmt::skip]
pub static EXTENSIONS: &[CommandSpec] = &[
    row("material", "the same as surface", run(Routine::Surface))
        .takes(&[
            parameter("alias", Kind::New(Names::Material), "the material's name"),
            parameter("= old", Kind::Copy(Names::Material), "the name of the old material").optional(""),
        ])
        .options(o::SURFACE)
        .example("light White, position 4 8 10\nmaterial Gold { diffuse Gold, specular White, shine 80 }\nsphere Gold 2, 0 0 0"),
    row("blobscale", "how blobbiness is read", run(Routine::Blobscale))
        .takes(&[word("what", o::BLOBSCALE, "`relative` or `absolute`")])
        .default("relative")
        .details("relative: a² = |B|/R²; absolute: a² = |B|, as the published datasets read.")
        .example(flesh!("blobscale absolute\nsphere Flesh 0.6, 0 0 0")),
    row("influence", "share of the threshold below which the draft ignores a soft shape", run(Routine::Influence))
        .takes(&[number("e", "the share of the threshold").from(1e-9, 0.5)])
        .default("0.001")
        .details("Counts for the draft and for every digger but hermite: traced pictures ignore nothing that could be seen.")
        .example(flesh!("influence 1e-4\nsphere Flesh 0.6, 0 0 0")),
    row("sky", "light from everywhere", run(Routine::Sky))
        .takes(&[colour("Color", "the light's colour from straight above")])
        .options(o::SKY)
        .default("none")
        .details("Every place gets the light of the part of the sky that it sees: hollows and what touches the ground get darker, as on a cloudy day. Materials whose `ambient` is not given have none under a sky. The sky is seen behind everything unless there is a `background`.")
        .example(flesh!("sky White to SteelBlue, intensity 0.8\nground Gray80\neyep 0 3 9\nsphere Flesh 0.6, -0.6 0 0\nsphere Flesh 0.6, 0.6 0 0")),
    row("ground", "a plane to stand on", run(Routine::Ground))
        .takes(&[colour("Color", "the ground's colour")])
        .options(o::GROUND)
        .default("none")
        .details("An endless plane across the direction up (`vup`) that receives light and shadows. Without a height it touches the lowest shape.")
        .example(clay!("ground Wheat\nlight White, distant, direction -1 -2 -1\neyep 0 3 9\nsphere Clay 2, 0 0 0")),
    row("tone", "how bright light becomes colours of the screen", run(Routine::Tone))
        .takes(&[word("what", o::TONES, "`none` or `filmic`")])
        .default("none")
        .details("Filmic: light up to 0.6 stays as it is; above that 0.6 + 0.4·t/(1 + t), where t = (x − 0.6)/0.4, so that what glares keeps its form.")
        .example(clay!("tone filmic\nlight White, position -4 8 10, intensity 1.5\nsphere Clay 2, 0 0 0")),
    row("body", "begin a body, whose shapes blend with no others", run(Routine::Body))
        .takes(&[parameter("name", Kind::New(Names::Object), "the body's name")])
        .details("Soft shapes of a body flow together; those of two bodies do not, however near they are: legs that touch stay legs. \
            Shapes that stand in no body make one together. A body is an object: it is moved, turned and copied by its name, and a copy is \
            a new body. Objects can stand in bodies and bodies in objects, but no body in a body.")
        .example(flesh!("body LEFT\n  sphere Flesh 1, -0.9 0 0\nclose\nbody RIGHT\n  sphere Flesh 1, 0.9 0 0\nclose")),
    row("curve", "cubic Bézier curve", run(Routine::Curve))
        .takes(&[
            parameter("sn", Kind::Known(Names::Material), "the material's name"),
            length("b", "the tube radius"),
            vector("P1", "the first control point"),
            vector("P2", "the second control point"),
            vector("P3", "the third control point"),
            vector("P4", "the end point"),
            Parameter { arity: Arity::Any, ..vector("P", "a further control point") },
        ])
        .details("More points, three at a time, join more curves: each begins where the last one ends.")
        .example(flesh!("curve Flesh 0.6, <-3 -1 0> <-1 3 0> <1 -3 0> <3 1 0>")),
    row("contact", "let two bodies touch instead of overlap", run(Routine::Contact))
        .newer()
        .takes(&[
            parameter("A", Kind::Known(Names::Object), "a body's name"),
            parameter("B", Kind::Known(Names::Object), "the other body's name, or `self`"),
        ])
        .options(o::CONTACT)
        .default("fast 0.2")
        .details("Where the bodies would overlap, each is pressed flat against the other, and beside it both swell a little. Fields are in units \
            of the threshold: the other body's surface is where its field is 1, and the bulge begins where it is c. The smaller c, the \
            wider the bulge; where the fields fall slowly a wide and high one would coat the other body, which a warning tells. A body can \
            touch many others. With `self` the folds of a body's skeletons touch, which needs `local` there.")
        .example(flesh!("body LEFT\n  sphere Flesh 1.2, -0.9 0 0\nclose\nbody RIGHT\n  sphere Flesh 1.2, 0.9 0 0\nclose\ncontact LEFT RIGHT")),
    row("skeleton", "curves that branch, with flesh around them", run(Routine::Skeleton))
        .newer()
        .takes(&[
            parameter("sn", Kind::Known(Names::Material), "the material's name"),
            parameter("name", Kind::New(Names::Object), "the skeleton's name"),
        ])
        .options(o::SKELETON)
        .details("Nodes and curves stand in `{ … }`. A curve begins and ends at its end nodes, passes through nodes that it shares \
            with other curves, which branch there, and is drawn towards all others. A curve that ends where it begins is closed. The radius \
            varies smoothly from node to node. The flesh is soft whatever the material's blobbiness; its kernel is `cubed` unless the \
            material names another. With `local D` only the stretch within D along the curves counts at a point, so that a fold does \
            not blend with what lies beside it; about four radii suit. A skeleton is an object: it is moved, turned and copied by its name.")
        .example("light White, position 4 8 10\nsurface Flesh, kernel cauchy, diffuse SandyBrown, specular Gray50, shine 40, radius 0.6, blobbiness -2\nskeleton Flesh, HAND {\n  node WRIST <-3 -1 0> radius 0.5\n  node PALM <-0.5 0 0> radius 0.9\n  node TIP <3 1.2 0> radius 0.3\n  node THUMB <0.5 2.4 0> radius 0.3\n  curve WRIST PALM TIP\n  curve PALM THUMB\n}"),
    row("motion", "let skeletons fall, swing and touch", run(Routine::Motion))
        .newer()
        .takes(&[Parameter { arity: Arity::Any, ..parameter("object", Kind::Known(Names::Object), "an object's name") }])
        .options(o::MOTION)
        .details("Stands behind skeletons, and moves the last one or those of the objects it names, together. Nodes are masses and curves are springs; frame 0 has them \
            where the text has them, and each further frame follows from the one before. Floors, the objects of `against` and the flesh of all that moves \
            together, own folds too, push back. A chain of n nodes that hangs is stretched by a share of n·gravity/stiffness at its upper end. Flesh moves at most half its thickness in a step, so \
            that it passes through nothing: fast things need more `steps`. A node that is pinned follows variables that change with the frames. \
            At most 200 nodes move together, 3000 frames long.")
        .example("light White, position 4 8 10\nsurface Flesh, kernel cauchy, diffuse SandyBrown, specular Gray50, shine 40, radius 0.4, blobbiness -2\nskeleton Flesh, TAIL {\n  node ROOT <-3 2 0> radius 0.6\n  node A <-1.5 2.2 0> node B <0 2 0> node C <1.5 2.2 0>\n  node TIP <3 2 0> radius 0.2\n  curve ROOT A B C TIP\n}\nmotion TAIL { gravity 0 -10 0, stiffness 400, steps 20, pin ROOT, floor <0 -2 0> <0 1 0> }"),
    row("deform", "bend a mesh by control points", run(Routine::Deform))
            .newer()
        .takes(&[parameter("object", Kind::Known(Names::Object), "an object's name").optional("the last one")])
        .options(o::DEFORM)
        .details("Control points may lie anywhere, at most 4096; each takes along what is near when it moves, and one without `move` holds it. \
            All that is between follows smoothly (by natural neighbours), and far away nothing moves. Triangles, patches and meshes can be deformed, soft surfaces around meshes too.")
        .example(clay!("eyep 3 4 3\nfov 30\nvup 0 0 1\nmesh Clay gem.obj\ndeform { control <0 0 1> move <0.4 0 0.6>\n  control <0 0 0>\n  control <0 0 -1> move <-0.4 0 0> }")),
    row("seed", "start the random numbers of `rand`", run(Routine::Seed))
        .takes(&[number("n", "the seed")])
        .default("0")
        .example(clay!("seed 7\nfor i = 1 to 20 { sphere Clay 0.3, rand*6-3, rand*6-3, 0 }")),
    structure("for", "repeat commands")
        .takes(&[
            parameter("i =", Kind::New(Names::Variable), "the name of the loop's variable"),
            number("a", "the first value"),
            number("to b", "the last value"),
            number("step c", "the step").optional("1"),
            BLOCK,
        ])
        .example(clay!("for i = 0 to 11 { sphere Clay 0.4, 3*cos(rad(30*i)), 3*sin(rad(30*i)), 0 }")),
    structure("if", "run commands if a condition holds")
        .takes(&[
            parameter("condition", Kind::Condition, "a condition, such as `i < 3`"),
            BLOCK,
            parameter("else { … }", Kind::Block, "what is run if it does not hold").optional(""),
        ])
        .example(clay!("for i = -3 to 3 { if i < 0 or i > 1 { sphere Clay 0.4, i 0 0 } else { sphere Clay 0.4, i 1 0 } }")),
    structure("else", "the other branch of if")
        .takes(&[BLOCK])
        .example(clay!("if 1 > 2 { sphere Clay 1, 0 0 0 } else { sphere Clay 2, 0 0 0 }")),
    structure("define", "make a new command")
        .takes(&[
            parameter("name(a, B, c = 1)", Kind::New(Names::Command), "the new command's name and its parameters"),
            BLOCK,
        ])
        .details("A parameter in CAPITALS takes a triple, one written `surface s` the name of a material, any other a number. `c = 1` may be left out by who calls; calls may name parameters: `leg length=2`. `return` leaves the command.")
        .example(clay!("define leg(surface s, BASE, length = 2) {\n  cylinder s 0.3, BASE, BASE - vec(0, length, 0)\n}\nleg Clay, -1 1 0\nleg Clay, 1 1 0, length=3")),
    library("tree", "a branching tree")
        .example("surface Bark, diffuse SaddleBrown, radius 0.3, blobbiness -3\nlight White, position 4 -8 10\neyep 0 -6 2\nvrp 0.3 0 1.2\nvup 0 0 1\ntree Bark"),
    library("spikes", "spikes scattered over a sphere")
        .example(clay!("eyep 0 0 3\nsphere Clay 0.5, 0 0 0\nspikes Clay")),
    library("sphereflake", "the standard procedural database's flake of spheres")
        .example(clay!("eyep 2.1 1.3 1.7\nvup 0 0 1\nsphereflake Clay, 2")),
    library("spiral", "a spiral of spheres")
        .example(clay!("eyep 1 4 2.5\nvrp 0 0 0.8\nvup 0 0 1\nspiral Clay, turns=4")),
];
