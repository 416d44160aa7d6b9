//! `skeleton sn, name file …`: skeletons that people have in files.

use super::curves::{END_SHAPE, SCHEMES, ends_of, keep_apart, note_round, weigh};
use super::model::{Group, Part};
use super::skeleton_radii;
use super::state::{Evaluator, Flow};
use crate::assets;
use crate::commands::build::{options, plain};
use crate::commands::slot::{
    Named, Placed, SN, Slot, Word, existing, file, length, new, number, whole, word,
};
use crate::commands::{Names, Parameter};
use crate::compiled::Unread;
use crate::given::Options;
use crate::limits::MAX_SKELETON_FILES;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::suggest;
use crate::syntax::Command;
use field::{BlobScale, Kernel, Primitive, Shaping, THRESHOLD};
use glam::{DAffine3, DVec3};
use limbs::{Cap, Graph, Recipe, Side};
use scene::curves::Clip;
use scene::curves::MOST_FLAT;
use scene::{Curves, Element, Ends, Form, Function, Shape};
use skeleton::{Node, Scheme, Skeleton};
use std::rc::Rc;
use std::sync::Arc;

/// Kernel of limbs whose material names none. With [`BLOBBINESS`] their surface stands at their
/// radius, and where eight of them meet at 1.3 of it.
const KERNEL: Kernel = Kernel::Compact6;
/// Blobbiness of limbs whose material has none.
const BLOBBINESS: f64 = 8.0;
/// Remarks of a file that are quoted.
const MOST_REMARKS: usize = 8;
/// Triangles of meshes that clip limbs.
const MOST_CLIPPING: usize = 100_000;
/// Limbs that cost as much as a step.
const LIMBS_PER_STEP: usize = 4;

/// Name of a skeleton.
pub(super) const NAME: Slot<Named> = new("name", Names::Object, "the skeleton's name");
/// File of a skeleton.
pub(super) const FILE: Slot<Named> = file("fn", "the name of a file with limbs");

/// Operands of this form of the command.
pub(super) const PARAMETERS: &[Parameter] = plain![SN, NAME, FILE];

options! {
    /// Options of `skeleton` with a file.
    FILE_OPTIONS:
    SCALE: f64 = ("scale", "1", "of a file: factor on all its lengths",
        number("S", "the factor").from(1e-9, 1e9));
    THICKEN: f64 = ("thicken", "0", "of a file: length that is added to all radii",
        length("R", "the length that is added to all radii"));
    MERGE: f64 = ("merge", "", "of a file: joins lines that run within D of each other",
        length("D", "the distance within which lines are joined").at_least(0.0));
    SIMPLIFY: f64 = ("simplify", "",
        "of a file: fewer limbs, whose centrelines and radii move by at most E",
        length("E", "the most that lines and radii move").at_least(0.0));
    MATERIALS: Vec<Named> = ("materials", "",
        "of a file: materials of its types or elements, `soma A axon B`; the first is for all \
         others",
        existing("type SN", Names::Node, "a type of the file, and its material").many());
    BONDS: () = ("bonds", "", "of a molecule: joins atoms that are bound by limbs");
    RADII: Named = ("radius", "the usual ones", "name of the file's array or column of radii",
        existing("NAME", Names::Node, "the name of the array or column"));
    FILE_SUBDIVIDE: u32 = ("subdivide", "0", "how often limbs are refined, through their nodes",
        whole("n", 0, skeleton::MOST_LEVELS, "how often limbs are refined"));
    FILE_SCHEME: Word = ("scheme", "fourpoint", "how limbs are refined",
        word("name", SCHEMES, "the scheme's name"));
    FILE_LOCAL: Placed<f64> = ("local", "", "as of a skeleton with a block",
        length("D", "the length along the limbs within which flesh \
            blends").at_least(1e-6).with_place());
    FILE_ENDS: Word = ("ends", "round", "shape of free ends", END_SHAPE);
}

/// Adds the skeleton of a file as one object.
pub(super) fn add<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    [sn, name, file]: &[Name<'a>; 3],
) -> Outcome<Flow> {
    let material = run.material(sn)?;
    let others = options.last(&MATERIALS).unwrap_or_default();
    let asset = run.asset(file)?;
    run.scope.step(assets::cost(asset), &command.word_span)?;
    let scale = options.last(&SCALE).unwrap_or(1.0);
    let recipe = Recipe {
        radii: options.last(&RADII).map(|name| name.text.to_owned()),
        bonds: options.has(&BONDS),
        merge: options.last(&MERGE).map(|within| within / scale),
        simplify: options.last(&SIMPLIFY).map(|within| within / scale),
    };
    let own = Unread {
        name: asset.name.clone(),
        recipe,
    };
    let is_new = !run.skeletons.contains(&own);
    if is_new && run.skeletons.len() >= MAX_SKELETON_FILES {
        let message = format!("there are more than {MAX_SKELETON_FILES} skeletons of files");
        let hint = "read one once, and copy it by `instance`";
        return Err(Problem::new(&file.span, message).hint(hint));
    }
    let read = asset.skeleton(&own.recipe);
    if is_new {
        run.skeletons.push(own.clone());
    }
    let Some(read) = read else {
        let message = format!("`{}` is still being read", file.text);
        if is_new {
            run.unread.push(own);
        }
        return Err(Problem::new(&file.span, message));
    };
    let read = read.map_err(|error| Problem::new(&file.span, format!("{}: {error}", file.text)))?;
    run.scope.step(
        (read.limbs.len() / LIMBS_PER_STEP) as u64,
        &command.word_span,
    )?;
    let mut graph = Graph {
        nodes: read.nodes.clone(),
        limbs: read.limbs.clone(),
        groups: read.groups.clone(),
        clips: read.clips.clone(),
        ..Graph::default()
    };
    graph.scale(scale);
    if graph.nodes.iter().any(|node| node.is_guessed) {
        let radius = run.palette.surfaces[material].flesh.radius;
        if radius <= 0.0 {
            let message = format!("`{}` gives no radii above 0", file.text);
            return Err(Problem::new(&file.span, message).hint(format!(
                "give the material `{}` a radius, or name the array of radii: `radius NAME`",
                sn.text
            )));
        }
        graph.give_radius(radius);
    }
    if let Some(by) = options.last(&THICKEN) {
        graph.thicken(by);
    }
    let mut remarks: Vec<String> = read.remarks.iter().map(ToString::to_string).collect();
    remarks.extend(graph.remarks.iter().map(ToString::to_string));
    let clip = find_clip(&graph).unwrap_or_else(|why| {
        remarks.push(format!(
            "meshes that are made of them are not clipped either: {why}"
        ));
        None
    });
    tell_remarks(run, file, &remarks);
    if graph.limbs.is_empty() && graph.nodes.is_empty() {
        return Err(Problem::new(&file.span, "nothing is left of this skeleton"));
    }
    let own = find_materials(run, &graph, material, &others)?;
    let flat = graph.choose_caps(ends_of(options) != Ends::Round);
    if run.settings.soft {
        let cuts = flat <= MOST_FLAT && !options.has(&FILE_LOCAL);
        lengthen(run, &mut graph, material, cuts);
        if flat > 0 && !cuts {
            note_round(run, file, flat);
            for limb in &mut graph.limbs {
                limb.caps = [Cap::Round; 2];
            }
        }
        // Where limbs are rounded or do not blend, others than these are drawn.
        if options.last(&FILE_SUBDIVIDE).unwrap_or(0) == 0 && !options.has(&FILE_LOCAL) {
            let shapings: Vec<Shaping> = own.iter().map(|own| shaping(run, *own)).collect();
            skeleton_radii::tell(run, &graph, &shapings, file);
        }
    }
    run.model.open(run.file, name, Group::Object)?;
    run.repeating += 1;
    let mut used: Vec<usize> = own.clone();
    used.sort_unstable();
    used.dedup();
    if clip.is_some() {
        // Meshes look for what clips a ball among the limbs before it.
        used.sort_by_key(|material| {
            let mut groups = graph.limbs.iter().map(|limb| limb.group as usize);
            !groups.any(|group| own.get(group) == Some(material))
        });
    }
    let mut result = Ok(());
    for material in used {
        result = add_material(run, command, options, sn, (&graph, &clip), (material, &own));
        if result.is_err() {
            break;
        }
    }
    run.repeating -= 1;
    run.model.close();
    result.map(|()| Flow::Next)
}

/// Says what was left out of a file, changed or guessed.
fn tell_remarks(run: &mut Evaluator<'_>, file: &Name<'_>, remarks: &[String]) {
    if remarks.is_empty() {
        return;
    }
    let mut text = remarks[..remarks.len().min(MOST_REMARKS)].join("; ");
    if remarks.len() > MOST_REMARKS {
        text += &format!("; and {} more", remarks.len() - MOST_REMARKS);
    }
    run.warn(&file.span, format_args!("{}: {text}", file.text), "");
}

/// Returns the material of each group of a graph.
fn find_materials<'a>(
    run: &mut Evaluator<'a>,
    graph: &Graph,
    otherwise: usize,
    given: &[Name<'a>],
) -> Outcome<Vec<usize>> {
    let mut own = vec![otherwise; graph.groups.len()];
    for pair in given.chunks(2) {
        let [kind, sn] = pair else {
            let message = format!("a material is missing behind `{}`", pair[0].text);
            return Err(Problem::new(&pair[0].span, message)
                .hint("write a type of the file and its material: `materials soma A axon B`"));
        };
        let material = run.material(sn)?;
        let mut is_there = false;
        for (group, own) in graph.groups.iter().zip(&mut own) {
            if group.name.eq_ignore_ascii_case(kind.text) {
                *own = material;
                is_there = true;
            }
        }
        if !is_there {
            let names = graph.groups.iter().map(|group| group.name.as_str());
            let hint = suggest::hint(kind.text, names.clone()).unwrap_or_else(|| {
                let names: Vec<&str> = names.take(20).collect();
                format!("its types are {}", names.join(", "))
            });
            let message = format!("the file has no type `{}`", kind.text);
            run.warn(&kind.span, message, hint);
        }
    }
    Ok(own)
}

/// Returns the shaping of limbs of a material that have the radius 1.
fn shaping(run: &Evaluator<'_>, material: usize) -> Shaping {
    let flesh = &run.palette.surfaces[material].flesh;
    Shaping {
        kernel: flesh.kernel.unwrap_or(KERNEL),
        radius: 1.0,
        blobbiness: flesh.blobbiness.unwrap_or(BLOBBINESS),
        blob_scale: run.settings.blob_scale,
        strength: flesh.strength,
        influence: run.settings.influence,
        taper: None,
    }
}

/// Returns the mesh that all limbs are clipped by, if any.
///
/// # Errors
/// If only some limbs are clipped, or in unlike ways, or by too many triangles.
fn find_clip(graph: &Graph) -> Result<Option<Arc<Clip>>, &'static str> {
    let mut used: Vec<Option<u32>> = graph.limbs.iter().map(|limb| limb.clip).collect();
    used.sort_unstable();
    used.dedup();
    let used = used.iter().map(|i| graph.clips.get((*i)? as usize));
    let Some(clips) = used.clone().collect::<Option<Vec<_>>>() else {
        return match used.flatten().next() {
            Some(_) => Err("only some of its limbs are"),
            None => Ok(None),
        };
    };
    let Some(first) = clips.first() else {
        return Ok(None);
    };
    if clips.iter().any(|clip| clip.side != first.side) {
        return Err("some limbs are kept inside of a mesh, others outside");
    }
    if clips.iter().any(|clip| clip.mesh != first.mesh) {
        return Err(
            "limbs are clipped by different meshes; write each lattice into a file of its own",
        );
    }
    if first.mesh.triangles.len() > MOST_CLIPPING {
        return Err("the mesh that clips has too many triangles");
    }
    Ok(Some(Arc::new(Clip {
        is_inside: first.side == Side::Inside,
        meshes: vec![(first.mesh.positions.clone(), first.mesh.triangles.clone())],
    })))
}

/// Moves free ends such that the surface ends a radius beyond them, or where they are flat, at them
/// unless a plane cuts it there.
fn lengthen(run: &Evaluator<'_>, graph: &mut Graph, material: usize, cuts: bool) {
    if run.settings.blob_scale != BlobScale::Relative {
        return;
    }
    let Some(reach) = measure_reach(&shaping(run, material)) else {
        return;
    };
    graph.lengthen_free_ends(|cap| match cap {
        Cap::Round => 1.0 - reach,
        Cap::Flat if cuts => 0.0,
        Cap::Flat => -reach,
    });
}

/// Returns the distance in radii that the surface reaches beyond the end of a long limb, by
/// bisection; `None` if it is none from 0 to 4.
fn measure_reach(shaping: &Shaping) -> Option<f64> {
    const LONG: f64 = 100.0;
    let skeleton = field::Skeleton::Segment {
        base: DVec3::X * -LONG,
        apex: DVec3::ZERO,
    };
    let limb = Primitive::new(skeleton, shaping, None)?;
    let [at_end, beyond] = [0.0, 4.0].map(|x| limb.value::<f64>([x, 0.0, 0.0]));
    if at_end < THRESHOLD || beyond >= THRESHOLD {
        return None;
    }
    let (mut low, mut high) = (0.0, 4.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        match limb.value::<f64>([middle, 0.0, 0.0]) >= THRESHOLD {
            true => low = middle,
            false => high = middle,
        }
    }
    Some(low)
}

/// Adds the limbs and balls of one material; `own` are the materials of the graph's groups.
fn add_material<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    sn: &Name<'a>,
    (graph, clip): (&Graph, &Option<Arc<Clip>>),
    (material, own): (usize, &[usize]),
) -> Outcome<()> {
    let flesh = &run.palette.surfaces[material].flesh;
    let soft = match flesh.blobbiness {
        Some(_) => material,
        None => run.palette.add_soft(sn, material, BLOBBINESS)?,
    };
    let part = graph.part(|limb| own.get(limb.group as usize) == Some(&material));
    if !part.limbs.is_empty() {
        let curves = make_curves(&part, options)
            .map_err(|error| Problem::new(&command.word_span, error.to_string()))?;
        let mut curves = match options.last(&FILE_LOCAL) {
            Some(reach) => keep_apart(run, curves, reach)?,
            None => curves.with_flat(flat_nodes(&part), ends_of(options) == Ends::Open),
        };
        curves.clip.clone_from(clip);
        let shape = Shape::Function(Box::new(Function {
            form: Form::Skeleton(Arc::new(curves)),
            to_world: DAffine3::IDENTITY,
        }));
        let element = Element {
            flesh: Some(soft as u32),
            finish: soft as u32,
            body: run.model.body(),
            kernel: KERNEL,
            origin: run.origin(command),
            ..Element::new(shape)
        };
        let part = Part {
            tapers: false,
            limbs: weigh(run, &element),
            element,
            depth: None,
            growth: 1.0,
            moved: None,
            repeated: true,
            removed: false,
            nodes: Some(Rc::new(Vec::new())),
            moves: false,
        };
        run.model.push(part, &command.span)?;
        run.palette.surfaces[soft].used = true;
    }
    let balls = graph.nodes.iter().filter(|node| node.is_ball);
    for ball in balls.filter(|ball| own.get(ball.group as usize) == Some(&material)) {
        run.add_of(
            command,
            soft,
            Shape::sphere(ball.position, ball.radius),
            KERNEL,
        )?;
    }
    Ok(())
}

/// Lists the nodes of a graph at which limbs end flat.
fn flat_nodes(graph: &Graph) -> Vec<u32> {
    let ends = graph
        .limbs
        .iter()
        .flat_map(|limb| limb.ends.into_iter().zip(limb.caps));
    ends.filter(|(_, cap)| *cap == Cap::Flat)
        .map(|(node, _)| node)
        .collect()
}

/// Returns the lines of a graph as curves through their nodes.
fn make_curves(graph: &Graph, options: &Options<'_>) -> Result<Curves, skeleton::Error> {
    let nodes = graph.nodes.iter().map(|node| Node {
        position: node.position,
        radius: node.radius,
    });
    let curves = graph.chains().into_iter().map(|chain| {
        let nodes = chain.nodes.into_iter().map(|node| node as usize);
        nodes.collect()
    });
    let skeleton = Skeleton {
        nodes: nodes.collect(),
        curves: curves.collect(),
    };
    let scheme = match options.last(&FILE_SCHEME) {
        Some("chaikin") => Scheme::Chaikin,
        Some("cubic") => Scheme::Cubic,
        _ => Scheme::FourPoint,
    };
    Curves::new(skeleton, scheme, options.last(&FILE_SUBDIVIDE).unwrap_or(0))
}
