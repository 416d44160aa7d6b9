//! The meshes of a scene.

use crate::cages::Cage;
use crate::caps::Caps;
use crate::clipping::{Clipping, HardClips};
use crate::coating::{Coat, Coating};
use crate::file::approximate;
use crate::level::QuadricFunction;
use crate::measure::Measured;
use crate::options::{MeshError, Options, Phase, Progress};
use crate::paint::{Paint, Parts};
use crate::refine::EXCESS;
use crate::solids::{Solid, tessellate};
use crate::surface::{MOST_CROSSINGS, SurfaceMesh as Mesh, box_of, extent, polygonize};
use crate::unite;
use field::Skeleton;
use glam::{DMat3, DVec3};
use mesh::{Aabb, Topology, TriangleMesh, self_intersections};
use scene::{Element, Form, Scene, Shape, Surface};
use serde::{Deserialize, Serialize};

/// How far the mesh may be from the surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Tolerance {
    /// In units of the scene.
    Absolute(f64),
    /// As a share of the diagonal of the model's box.
    Relative(f64),
    /// As a share of the longest side of the model's box.
    OfSide(f64),
}

impl Default for Tolerance {
    fn default() -> Self {
        Self::Relative(1e-3)
    }
}

/// Lower bound of a model's size, as a part of the size of the box found for it, which is a little
/// too large.
const SMALLEST: f64 = 1.0 - 2.0 * EXCESS;

/// Wishes for the mesh of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wishes {
    /// How far the mesh may be from the surface.
    pub tolerance: Tolerance,
    /// Infinite elements are cut off by the box of all finite elements, times this.
    pub box_scale: f64,
    /// Name of the only body that is wanted; `None` for all.
    pub body: Option<String>,
    /// Whether all closed parts become one by a boolean union.
    pub union: bool,
    /// Whether cavities are left out.
    pub outer: bool,
    /// Whether what can be proved of the mesh is, which takes about ten times as long; else its
    /// error is measured.
    pub prove: bool,
    /// Most triangles of each part.
    pub max_triangles: usize,
    /// Threads; the result does not depend on them.
    pub threads: usize,
}

impl Default for Wishes {
    fn default() -> Self {
        Self {
            tolerance: Tolerance::default(),
            box_scale: 2.0,
            body: None,
            union: false,
            outer: false,
            prove: true,
            max_triangles: Options::MOST_TRIANGLES,
            threads: 1,
        }
    }
}

/// The meshes of a scene, with what was proved of them.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// The meshes.
    pub parts: Vec<ModelPart>,
    /// The tolerance, in units of the scene.
    pub tolerance: f64,
    /// Evaluations of functions and of their bounds.
    pub evaluations: u64,
    /// Sentences for the user: what was cut off, what is not sure.
    pub notes: Vec<String>,
}

/// A mesh of a [`Model`].
#[derive(Clone, Debug, Default)]
pub struct ModelPart {
    /// The body's name, and what of it this is.
    pub name: String,
    /// The mesh, with normals, colours or materials.
    pub mesh: TriangleMesh,
    /// Whether it is closed.
    pub is_closed: bool,
    /// Whether its closed shells may overlap, as those of hard elements do.
    pub overlaps: bool,
    /// Whether the error was only measured; else it is proved, but for `unproved` triangles.
    pub is_measured: bool,
    /// The largest distance between mesh and surface, either way.
    pub error: f64,
    /// Centres of the cells in which the topology is not proved.
    pub undecided: Vec<DVec3>,
    /// Triangles that are not proved to be within the tolerance.
    pub unproved: usize,
    /// Triangles before they were made fewer.
    pub raw_triangles: usize,
    /// Distances that samples found, of soft surfaces.
    pub measured: Measured,
    /// Pairs of triangles that cut or touch each other, a hundred at most: none but where vertices
    /// are nearer to each other than numbers can tell.
    pub crossings: usize,
}

impl Model {
    /// The box of all parts.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        let boxes = self.parts.iter().map(|part| part.mesh.bounds());
        boxes.fold(Aabb::EMPTY, |all, own| all.union(&own))
    }
}

/// Meshes a scene: for each body its soft surface, its closed hard elements, and what is open by
/// nature.
///
/// ```
/// use mesher::{Progress, Wishes};
/// use scene::{Element, Flesh, Scene, Shape};
///
/// let mut scene = Scene::default();
/// scene.flesh.push(Flesh { blobbiness: Some(2.0), ..Flesh::default() });
/// scene.elements.push(Element {
///     flesh: Some(0),
///     ..Element::new(Shape::sphere(glam::DVec3::ZERO, 1.0))
/// });
/// let mut report = |_| core::ops::ControlFlow::Continue(());
/// let model = mesher::mesh_scene(&scene, &Wishes::default(), &mut Progress::new(&mut report))?;
/// let part = &model.parts[0];
/// assert!(part.is_closed && part.undecided.is_empty() && part.error <= model.tolerance);
/// # Ok::<(), mesher::MeshError>(())
/// ```
///
/// # Errors
/// See [`MeshError`].
pub fn mesh_scene(
    scene: &Scene,
    wishes: &Wishes,
    progress: &mut Progress<'_>,
) -> Result<Model, MeshError> {
    let plan = Plan::new(scene, wishes, &mut progress.part(0.0, 0.05))?;
    let mut model = Model {
        tolerance: plan.tolerance,
        ..Model::default()
    };
    let count = plan.soft.len().max(1) as f32;
    for (i, (surface, domain)) in plan.soft.iter().enumerate() {
        let mut progress = progress.part(
            0.05 + 0.8 * i as f32 / count,
            0.05 + 0.8 * (i + 1) as f32 / count,
        );
        soft_part(
            scene,
            wishes,
            &plan,
            surface,
            domain,
            &mut model,
            &mut progress,
        )?;
    }
    let progress = &mut progress.part(0.85, 1.0).in_phase(Phase::Solids);
    progress.at(0.0)?;
    let mut clips = HardClips::new(scene);
    for body in 0..scene.bodies.len() as u32 {
        let elements = plan
            .hard
            .iter()
            .copied()
            .filter(|element| element.body == body);
        hard_parts(
            scene, wishes, &plan, elements, &mut clips, &mut model, progress,
        )?;
    }
    let drop_cavities = |model: &mut Model| {
        for part in model.parts.iter_mut().filter(|part| part.is_closed) {
            part.mesh = without_cavities(&part.mesh);
        }
    };
    if wishes.outer {
        drop_cavities(&mut model);
    }
    if wishes.union {
        unite(&mut model, progress)?;
        if wishes.outer {
            // Those between bodies.
            drop_cavities(&mut model);
        }
    }
    model.parts.retain(|part| !part.mesh.triangles.is_empty());
    if model.parts.is_empty() {
        return Err(MeshError::Nothing);
    }
    progress.at(1.0)?;
    Ok(model)
}

/// The coating of a body's soft surface, see [`Coating`].
#[derive(Clone, Debug, Default)]
pub struct CoatedBody {
    /// The body's name.
    pub name: String,
    /// The mesh, with normals and colours.
    pub coat: Coat,
    /// Sentences for the user: whether ends are open.
    pub notes: Vec<String>,
}

/// Coats the skeletons of all bodies of a scene. `coatings` has one for each body, with what was
/// found for the last scene: it is made as long as it must be.
///
/// # Errors
/// If the caller cancels.
pub fn coat_scene(
    scene: &Scene,
    bound: f64,
    coatings: &mut Vec<Coating>,
    progress: &mut Progress<'_>,
) -> Result<Vec<CoatedBody>, MeshError> {
    let surfaces = scene.surfaces();
    coatings.resize_with(surfaces.len(), Coating::default);
    let count = surfaces.len() as f32;
    let mut bodies = Vec::new();
    for (i, (surface, coating)) in surfaces.iter().zip(coatings).enumerate() {
        let mut progress = progress.part(i as f32 / count, (i + 1) as f32 / count);
        progress.at(0.0)?;
        let cages = Cage::of_surface(scene, surface);
        let mut coat = coating.update_told(
            surface.function(),
            &cages,
            &|_| bound,
            &mut progress.part(0.0, 0.9),
        )?;
        if coat.mesh.triangles.is_empty() {
            continue;
        }
        let paint = Paint::new(scene, surface);
        let Caps { holes, .. } = paint.apply(&mut coat.mesh, 1, &mut progress.part(0.9, 1.0))?;
        let name = name_of(scene, surface.body(), "");
        let notes = describe_holes(&name, holes).into_iter().collect();
        bodies.push(CoatedBody { name, coat, notes });
    }
    Ok(bodies)
}

/// What is to be meshed.
struct Plan<'a> {
    soft: Vec<(Surface, Aabb)>,
    hard: Vec<&'a Element>,
    /// Where infinite elements end.
    limits: Aabb,
    tolerance: f64,
}

impl<'a> Plan<'a> {
    fn new(
        scene: &'a Scene,
        wishes: &Wishes,
        progress: &mut Progress<'_>,
    ) -> Result<Self, MeshError> {
        let is_wanted = |body: u32| {
            let name = scene.bodies.get(body as usize).map(|body| &body.name);
            wishes.body.is_none() || wishes.body.as_ref() == name
        };
        if !scene
            .bodies
            .iter()
            .enumerate()
            .any(|(i, _)| is_wanted(i as u32))
        {
            let name = wishes.body.clone().unwrap_or_default();
            return Err(MeshError::Failed(format!("there is no body {name}")));
        }
        let soft = scene.surfaces().into_iter().filter(|s| is_wanted(s.body()));
        let soft: Vec<Surface> = soft.collect();
        let is_hard = |e: &&Element| {
            !scene.is_soft(e) && is_wanted(e.body) && (e.finish as usize) < scene.finishes.len()
        };
        let hard: Vec<&Element> = scene.elements.iter().filter(is_hard).collect();

        let mut finite = Aabb::EMPTY;
        let mut domains = Vec::new();
        for surface in &soft {
            let domain = match surface.function().support() {
                Some(ball) => {
                    let all = box_of(ball);
                    let hull = if ball.radius > 0.0 {
                        extent(surface.function(), &all, wishes.threads, progress)?
                    } else {
                        None
                    };
                    finite = finite.union(&hull.unwrap_or(Aabb::EMPTY));
                    hull.map(|hull| grown(&hull, &all))
                }
                None => {
                    finite = finite.union(&skeletons(scene, surface));
                    Some(Aabb::EMPTY)
                }
            };
            domains.push(domain);
        }
        for element in &hard {
            finite = finite.union(&extent_of(&element.shape, scene.radius(element)));
        }
        let any_infinite = hard.iter().any(|e| e.shape.bounds(0.0).is_none())
            || domains.iter().flatten().any(Aabb::is_empty);
        if finite.is_empty() {
            let reason = if any_infinite {
                MeshError::Unbounded
            } else {
                MeshError::Nothing
            };
            return Err(reason);
        }
        // Not so for NaN.
        let is_sound = wishes.box_scale > 0.0 && wishes.box_scale.is_finite();
        if !is_sound {
            return Err(MeshError::NotFinite("the scale of the box".into()));
        }
        let half = (0.5 * finite.size()).max(DVec3::splat(0.05 * finite.size().max_element()));
        let limits = Aabb {
            min: finite.center() - wishes.box_scale * half,
            max: finite.center() + wishes.box_scale * half,
        };
        let size = if any_infinite {
            limits.size()
        } else {
            finite.size()
        };
        let tolerance = match wishes.tolerance {
            Tolerance::Absolute(tolerance) => tolerance,
            Tolerance::Relative(share) => SMALLEST * share * size.length(),
            Tolerance::OfSide(share) => SMALLEST * share * size.max_element(),
        };
        let is_sound = tolerance > 0.0 && tolerance.is_finite();
        if !is_sound {
            return Err(MeshError::NotFinite("the tolerance".into()));
        }
        let is_endless = domains.iter().flatten().any(Aabb::is_empty);
        let finite = finite.size().max_element();
        if is_endless && tolerance > finite {
            return Err(MeshError::Failed(format!(
                "the box is so large that the tolerance of {tolerance:.2e} is more than the size \
                 of all that is finite, {finite:.2e}, and nothing thinner would be seen; choose a \
                 smaller box or tolerance"
            )));
        }
        let with_domain = |(surface, domain): (Surface, Option<Aabb>)| {
            let domain = domain?;
            Some((surface, if domain.is_empty() { limits } else { domain }))
        };
        Ok(Self {
            soft: soft
                .into_iter()
                .zip(domains)
                .filter_map(with_domain)
                .collect(),
            hard,
            limits,
            tolerance,
        })
    }
}

/// A box that is a little larger, as far as another one reaches.
fn grown(hull: &Aabb, within: &Aabb) -> Aabb {
    let room = 0.05 * hull.size().max_element();
    Aabb {
        min: (hull.min - room).max(within.min),
        max: (hull.max + room).min(within.max),
    }
}

/// A box around the finite skeletons of a body with their radii.
fn skeletons(scene: &Scene, surface: &Surface) -> Aabb {
    let mut all = Aabb::EMPTY;
    let mut elements = surface.element().to_vec();
    elements.dedup();
    for element in elements {
        let element = &scene.elements[element as usize];
        all = all.union(&bounds_of(&element.shape, scene.radius(element)));
    }
    all
}

/// A tight box of a hard shape; empty for planes.
fn extent_of(shape: &Shape, radius: f64) -> Aabb {
    let bounds = bounds_of(shape, radius);
    let coarse = 0.25 * EXCESS * bounds.size().max_element();
    if bounds.is_empty() || coarse <= 0.0 {
        return bounds;
    }
    let solid = tessellate(shape, radius, coarse, &bounds);
    let meshes = solid.shells.iter().chain(&solid.sheets);
    let all = Aabb::of_points(meshes.flat_map(|mesh| mesh.positions.iter().copied()));
    if all.is_empty() {
        return bounds;
    }
    // Triangles of a tessellation may lie inside the true shape by the tolerance.
    Aabb {
        min: (all.min - coarse).max(bounds.min),
        max: (all.max + coarse).min(bounds.max),
    }
}

/// A box around a shape; empty for planes.
fn bounds_of(shape: &Shape, radius: f64) -> Aabb {
    // Patches stay flat.
    let is_patch = shape.bone().is_some_and(|bone| bone.normals.is_some());
    let bounds = shape.bounds(if is_patch { 0.0 } else { radius });
    bounds.map_or(Aabb::EMPTY, |(low, high)| Aabb::of_points([low, high]))
}

fn name_of(scene: &Scene, body: u32, what: &str) -> String {
    let name = scene
        .bodies
        .get(body as usize)
        .map_or("", |body| &body.name);
    match (name, what) {
        ("", "") => "model".into(),
        ("", _) => what.into(),
        (_, "") => name.into(),
        _ => format!("{name}, {what}"),
    }
}

/// Returns a sentence about the open ends of a body, if there are any.
fn describe_holes(name: &str, holes: usize) -> Option<String> {
    match holes {
        0 => None,
        1 => Some(format!("{name}: one end is open")),
        _ => Some(format!("{name}: {holes} ends are open")),
    }
}

/// Whether all elements of a surface are bones and skeletons that add their fields to its function:
/// none carves, has a profile, or is pressed by another body.
fn only_adds(scene: &Scene, surface: &Surface) -> bool {
    let mut elements = surface.element().iter();
    scene.contacts.is_empty()
        && elements.all(|element| {
            let element = &scene.elements[*element as usize];
            let flesh = element.flesh.and_then(|i| scene.flesh.get(i as usize));
            let is_plain = flesh.is_some_and(|flesh| {
                flesh.strength >= 0.0 && flesh.profile.is_none() && flesh.restriction == 0.0
            });
            is_plain
                && match &element.shape {
                    Shape::Bone(_) => true,
                    Shape::Function(function) => match &function.form {
                        Form::Skeleton(curves) => curves.local.is_none() && curves.flat.is_empty(),
                        _ => false,
                    },
                    _ => false,
                }
        })
}

/// Whether all elements of a surface are points and lines of their own thickness, which [`Cage`]s
/// surround.
fn are_lines(scene: &Scene, surface: &Surface) -> bool {
    surface.element().iter().all(|element| {
        let element = &scene.elements[*element as usize];
        let flesh = element.flesh.and_then(|i| scene.flesh.get(i as usize));
        match &element.shape {
            Shape::Bone(bone) => {
                let is_even = flesh.is_some_and(|flesh| flesh.end_radius.is_none());
                let is_line = match &bone.skeleton {
                    Skeleton::Segment { base, apex } => base != apex,
                    Skeleton::Triangle { .. }
                    | Skeleton::Polygon { .. }
                    | Skeleton::Plane { .. } => false,
                    _ => true,
                };
                is_even && is_line && bone.normals.is_none() && scene.radius(element) > 0.0
            }
            Shape::Function(function) => match &function.form {
                Form::Skeleton(curves) => {
                    let mut pieces = curves.pieces();
                    pieces.all(|[(a, from), (b, to)]| a != b && from > 0.0 && to > 0.0)
                }
                _ => false,
            },
            _ => false,
        }
    })
}

fn soft_part(
    scene: &Scene,
    wishes: &Wishes,
    plan: &Plan<'_>,
    surface: &Surface,
    domain: &Aabb,
    model: &mut Model,
    progress: &mut Progress<'_>,
) -> Result<(), MeshError> {
    let options = Options {
        tolerance: plan.tolerance,
        max_triangles: wishes.max_triangles,
        threads: wishes.threads,
        only_adds: only_adds(scene, surface),
    };
    let name = name_of(scene, surface.body(), "");
    let mut is_measured = !wishes.prove;
    let function = surface.function();
    let mut made = if is_measured {
        let limbs = match options.only_adds && are_lines(scene, surface) {
            true => Cage::of_surface(scene, surface),
            false => Vec::new(),
        };
        approximate(
            function,
            &limbs,
            domain,
            &options,
            &mut progress.part(0.0, 0.5),
        )
    } else {
        polygonize(function, domain, &options, progress)
    };
    if let (true, Err(MeshError::Failed(why))) = (is_measured, &made) {
        let note = format!("{name}: {why}: it was made with proofs");
        model.notes.push(note);
        is_measured = false;
        made = polygonize(function, domain, &options, &mut progress.part(0.5, 1.0));
    }
    let Mesh {
        mut mesh,
        error,
        undecided,
        unproved,
        measured,
        mut crossings,
        raw_triangles,
        evaluations,
        is_cut,
        ..
    } = match made {
        Ok(surface) => surface,
        Err(MeshError::Nothing) => return Ok(()),
        Err(other) => return Err(other),
    };
    if crossings > 0 {
        model.notes.push(format!(
            "{name}: {crossings} pairs of triangles or more touch each other: the tolerance is too \
             small for the numbers' precision",
        ));
    }
    if let Some(clipping) = Clipping::of_body(scene, surface, &name, &mut model.notes)
        && clipping.apply(&mut mesh, &name, &mut model.notes, progress)?
    {
        mesh.colors = None;
    }
    let Caps { holes, are_moved } =
        Paint::new(scene, surface).apply(&mut mesh, wishes.threads, progress)?;
    let mut is_closed = holes == 0;
    if are_moved {
        let found = self_intersections(&mesh, MOST_CROSSINGS)
            .map_err(|error| MeshError::Failed(error.to_string()))?;
        let now = found.pairs.len() + found.flat.len();
        let is_torn = is_closed && !Topology::of(&mesh).is_ok_and(|t| t.is_closed_manifold());
        if now > crossings || is_torn {
            model.notes.push(format!(
                "{name}: where flat ends are near each other or the tolerance is large, triangles \
                 touch each other; set the ends apart, or choose a smaller tolerance"
            ));
        }
        (is_closed, crossings) = (is_closed && !is_torn, now.min(MOST_CROSSINGS));
    }
    model.notes.extend(describe_holes(&name, holes));
    model.evaluations += evaluations;
    if is_cut {
        model.notes.push(format!(
            "{name}: cut off by the box and closed by flat faces"
        ));
    }
    if let (true, Some(first)) = (is_measured, undecided.first()) {
        let places = match undecided.len() {
            1 => "one place is".into(),
            count => format!("{count} places are"),
        };
        model.notes.push(format!(
            "{name}: {places} farther from the surface than the tolerance, up to {error:.2e}, the \
             first near {:.4} {:.4} {:.4}: limbs may touch there; a smaller tolerance may help",
            first.x, first.y, first.z,
        ));
    } else if let Some(first) = undecided.first() {
        model.notes.push(format!(
            "{name}: the topology is not proved in {} cells, the first near {:.4} {:.4} {:.4}: the \
             surface may touch itself or have a kink there",
            undecided.len(),
            first.x,
            first.y,
            first.z,
        ));
    }
    if unproved > 0 {
        model.notes.push(format!(
            "{name}: of {unproved} of {} triangles the distance from the surface is not proved; \
             samples found {:.2e} from mesh to surface and {:.2e} back",
            mesh.triangles.len(),
            measured.largest[0],
            measured.largest[1],
        ));
    }
    model.parts.push(ModelPart {
        name,
        mesh,
        is_closed,
        overlaps: false,
        is_measured,
        error,
        undecided,
        unproved,
        measured,
        raw_triangles,
        crossings,
    });
    Ok(())
}

/// Adds the hard elements of a body: one part for closed shells, one for what is open.
fn hard_parts<'a>(
    scene: &Scene,
    wishes: &Wishes,
    plan: &Plan<'_>,
    elements: impl Iterator<Item = &'a Element>,
    clips: &mut HardClips<'_>,
    model: &mut Model,
    progress: &mut Progress<'_>,
) -> Result<(), MeshError> {
    let mut closed = Parts::new(scene);
    let mut open = Parts::new(scene);
    let mut body = 0;
    let mut error = 0.0_f64;
    for element in elements {
        body = element.body;
        progress.again()?;
        let solid = match &element.shape {
            Shape::Quadric(quadric) => Solid {
                shells: Vec::new(),
                sheets: quadric_sheet(quadric, wishes, plan.tolerance, progress)?
                    .into_iter()
                    .collect(),
            },
            shape => {
                let radius = scene.radius(element);
                tessellate(shape, radius, plan.tolerance, &plan.limits)
            }
        };
        error = plan.tolerance;
        let is_sound = |mesh: &TriangleMesh| {
            !mesh.triangles.is_empty() && mesh.positions.iter().all(|p| p.is_finite())
        };
        let shells = solid
            .shells
            .into_iter()
            .filter(|m| is_sound(m) && m.signed_volume() > 0.0);
        let shells: Vec<TriangleMesh> = shells.collect();
        let mut whole = match &shells[..] {
            [] => TriangleMesh::default(),
            [shell] => shell.clone(),
            shells => unite::union(shells, progress)?,
        };
        if !whole.triangles.is_empty()
            && let Some(clipping) = clips.find(element)
        {
            let name = name_of(scene, body, "");
            clipping.apply(&mut whole, &name, &mut model.notes, progress)?;
        }
        if !whole.triangles.is_empty() {
            closed.add(&whole, element);
        }
        for sheet in solid.sheets.iter().filter(|m| is_sound(m)) {
            open.add(sheet, element);
        }
    }
    let (closed, open) = (closed.mesh(false), open.mesh(true));
    for (mesh, overlaps, what) in [(closed, true, "hard"), (open, false, "open")] {
        if mesh.triangles.len() > wishes.max_triangles {
            return Err(MeshError::TooMany {
                limit: wishes.max_triangles,
                fitting: Some(
                    plan.tolerance * 1.2 * mesh.triangles.len() as f64
                        / wishes.max_triangles as f64,
                ),
            });
        }
        if mesh.triangles.is_empty() {
            continue;
        }
        // Many sheets may be a closed mesh that was read from a file.
        let closes = || {
            let topology = Topology::of(&mesh);
            topology.is_ok_and(|t| t.is_closed_manifold()) && mesh.signed_volume() > 0.0
        };
        let is_closed = overlaps || closes();
        model.parts.push(ModelPart {
            name: name_of(scene, body, if is_closed { "hard" } else { what }),
            mesh,
            is_closed,
            overlaps,
            is_measured: false,
            error,
            undecided: Vec::new(),
            unproved: 0,
            measured: Measured::default(),
            raw_triangles: 0,
            crossings: 0,
        });
    }
    Ok(())
}

/// A quadric's surface without the lids on its box; `None` if there is none in the box.
fn quadric_sheet(
    quadric: &scene::Quadric,
    wishes: &Wishes,
    tolerance: f64,
    progress: &mut Progress<'_>,
) -> Result<Option<TriangleMesh>, MeshError> {
    let Some(to_local) = quadric.local_from_world().filter(|_| quadric.is_surface()) else {
        return Ok(None);
    };
    let longest = quadric
        .axes
        .map(DVec3::length)
        .into_iter()
        .fold(0.0, f64::max);
    let domain = Aabb {
        min: DVec3::NEG_ONE,
        max: DVec3::ONE,
    };
    let options = Options {
        tolerance: tolerance / longest,
        max_triangles: wishes.max_triangles,
        threads: wishes.threads,
        only_adds: false,
    };
    let function = QuadricFunction::new(quadric);
    let surface = match polygonize(&function, &domain, &options, &mut progress.part(0.0, 0.0)) {
        Ok(surface) => surface,
        Err(MeshError::Nothing | MeshError::AllInside) => return Ok(None),
        Err(other) => return Err(other),
    };
    let mesh = surface.mesh;
    let is_lid = |t: &[u32; 3]| {
        let corners = t.map(|i| mesh.positions[i as usize].to_array());
        (0..3).any(|k| {
            let side = corners[0][k];
            side.abs() == 1.0 && corners.iter().all(|p| p[k] == side)
        })
    };
    let sheet: Vec<[u32; 3]> = mesh
        .triangles
        .iter()
        .copied()
        .filter(|t| !is_lid(t))
        .collect();
    let turned: DMat3 = to_local.transpose();
    let normals = mesh.normals.as_ref().map(|normals| {
        let turned = normals.iter().map(|n| (turned * *n).normalize_or_zero());
        turned.collect()
    });
    Ok(Some(TriangleMesh {
        positions: mesh.positions.iter().map(|q| quadric.place(*q)).collect(),
        normals,
        triangles: sheet,
        ..TriangleMesh::default()
    }))
}

/// A mesh without shells whose volume is negative.
fn without_cavities(mesh: &TriangleMesh) -> TriangleMesh {
    let roots = crate::paint::roots(mesh);
    let center = mesh.bounds().center();
    let mut volume = vec![0.0; mesh.positions.len()];
    for (i, t) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = mesh.corners(i).map(|p| p - center);
        volume[roots[t[0] as usize] as usize] += a.dot(b.cross(c));
    }
    let mut kept = mesh.clone();
    let mut before = vec![0];
    kept.triangles.clear();
    for t in &mesh.triangles {
        if volume[roots[t[0] as usize] as usize] > 0.0 {
            kept.triangles.push(*t);
        }
        before.push(kept.triangles.len() as u32);
    }
    for group in &mut kept.groups {
        let range = &mut group.triangles;
        *range = before[range.start as usize]..before[range.end as usize];
    }
    kept.groups.retain(|group| !group.triangles.is_empty());
    kept
}

/// Joins all closed parts.
fn unite(model: &mut Model, progress: &mut Progress<'_>) -> Result<(), MeshError> {
    let (closed, open): (Vec<_>, Vec<_>) = core::mem::take(&mut model.parts)
        .into_iter()
        .partition(|part| part.is_closed);
    if !closed.is_empty() {
        // A cavity is a shell that must stay with the one around it.
        let meshes = closed.iter().flat_map(|part| {
            let mesh = crate::paint::colored(&part.mesh);
            if part.overlaps {
                crate::paint::shells(&mesh)
            } else {
                vec![mesh]
            }
        });
        let meshes: Vec<TriangleMesh> = meshes.collect();
        model.parts.push(ModelPart {
            name: "union".into(),
            mesh: unite::union(&meshes, progress)?,
            is_closed: true,
            overlaps: false,
            is_measured: closed.iter().any(|part| part.is_measured),
            error: closed.iter().map(|part| part.error).fold(0.0, f64::max),
            undecided: closed
                .iter()
                .flat_map(|part| part.undecided.clone())
                .collect(),
            unproved: closed.iter().map(|part| part.unproved).sum(),
            measured: closed
                .iter()
                .fold(Measured::default(), |all, part| all.with(&part.measured)),
            raw_triangles: closed.iter().map(|part| part.raw_triangles).sum(),
            crossings: 0,
        });
    }
    model.parts.extend(open);
    Ok(())
}
