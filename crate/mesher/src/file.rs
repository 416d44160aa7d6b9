//! The mesh of one function for files: in seconds, with its error measured on both sides.
//!
//! [Cells](crate::grow) of the size that curvature asks for give a fine mesh which is closed and
//! does not cut itself. It is [decimated](crate::decimate), then measured: points of all its
//! triangles are looked for on the surface, and points of the surface on it. Where it is too far
//! from the surface it is [mended](crate::mend). Where it cuts itself, or that does not help, it is
//! decimated once more with more care, at last with finer cells.

use crate::cages::Cage;
use crate::certify::{Vertex, at, descend};
use crate::decimate::{Decimated, Decimation};
use crate::dual::dual;
use crate::forest::{Forest, NONE, Side};
use crate::grow::{Corners, FINEST, FLAT, HIDING, LEVELS, Sizes, grow_tetrahedra};
use crate::lattice::Lattice;
use crate::march::{Raw, march};
use crate::measure::{Measured, along_ray, root_of, spread};
use crate::mend::{match_triangles, mend};
use crate::options::{MeshError, Options, Phase, Progress};
use crate::parallel::{LARGE, map_by, map_told};
use crate::refine::crossing;
use crate::space::Space;
use crate::surface::{LARGEST, LEAST_CELLS, MOST_CROSSINGS, SurfaceMesh, check};
use crate::tubes::{are_limbs, estimate_cells, unite_tubes};
use field::{Implicit, THRESHOLD};
use glam::DVec3;
use mesh::{Aabb, Bvh, TriangleMesh, closest_point, self_intersections};

/// Attempts to decimate a fine mesh.
const ATTEMPTS: usize = 4;
/// Shares of the progress at which the work on each of the fine meshes begins.
const FINE_MESHES: [f32; 5] = [0.3, 0.6, 0.75, 0.85, 0.93];
/// Most times that cells are divided where a fine mesh cuts itself.
const SEPARATIONS: usize = 8;
/// Most times that a coarse mesh is mended.
const MENDINGS: usize = 6;
/// Most times that vertices are moved where a fine mesh cuts itself.
const UNTANGLINGS: usize = 6;
/// Most pairs of triangles that cut each other that are looked for in a fine mesh.
const MOST_TANGLED: usize = 20_000;
/// A mesh is mended if it is too far from the surface at no more places than one for so many
/// triangles.
const MENDED: usize = 20;
/// Share of the tolerance that is left to a place in the next attempt.
const LESS: f64 = 0.4;
/// Shares below which a vertex is kept.
const KEPT: f64 = 0.1;
/// Most places of the surface that are looked for on the mesh, besides the fine mesh's vertices.
const PLACES: usize = 8000;
/// Largest distance by a first-order estimate, in tolerances, that is taken for true.
const SURE: f64 = 0.4;

/// Newton's steps that look for a place of the surface.
const STEPS: usize = 4;
/// Largest distance by a first-order estimate, in tolerances, of a place that Newton's steps found.
const FOOT: f64 = 0.01;
/// Largest distance by a first-order estimate, in tolerances, of places of the surface from it.
const ON: f64 = 0.1;

/// Places where points of triangles are looked for on the surface.
const SAMPLES: [[f64; 3]; 7] = [
    [1.0 / 3.0; 3],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.5],
    [0.5, 0.0, 0.5],
    [2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0],
    [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0],
    [1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0],
];

/// Meshes the surface of a function within a domain, which it must not leave but where it is to be
/// cut off. Nothing is proved: the error is measured. The cages are those of its limbs and balls if
/// it is the sum of such; else there are none.
///
/// # Errors
/// See [`MeshError`]; [`MeshError::Failed`] also where the error stays larger than the tolerance.
pub fn approximate(
    function: &dyn Implicit,
    cages: &[Cage],
    domain: &Aabb,
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<SurfaceMesh, MeshError> {
    let Options {
        tolerance,
        max_triangles,
        threads,
        only_adds,
    } = *options;
    check(domain)?;
    // Not so for NaN.
    let is_sound = tolerance > 0.0 && tolerance.is_finite();
    if !is_sound {
        return Err(MeshError::NotFinite("the tolerance".into()));
    }
    let size = domain.size().max_element();
    let tolerance = tolerance.min(LARGEST * size);
    let most = max_triangles.saturating_mul(2).max(LEAST_CELLS);
    let mut begun = 0.0;
    if are_limbs(cages) && estimate_cells(cages) > most as f64 {
        let forest = Forest::new(domain, FINEST * tolerance, LEVELS);
        let mut space = Space::new(function, forest, tolerance / size);
        let sizes = Sizes {
            tolerance,
            hiding: f64::INFINITY,
            most,
            threads,
        };
        begun = 0.5;
        let progress = &mut progress.part(0.0, begun);
        if let Some(surface) = mesh_limbs(&mut space, cages, domain, &sizes, progress)? {
            let count = surface.mesh.triangles.len();
            return match count <= max_triangles {
                true => Ok(surface),
                false => Err(too_many(tolerance, count, max_triangles)),
            };
        }
    }
    let progress = &mut progress.part(begun, 1.0);
    let mut grown = None;
    for (start, hiding) in [0.0, 0.1, 0.2].into_iter().zip(HIDING) {
        let forest = Forest::new(domain, FINEST * tolerance, LEVELS);
        let mut space = Space::new(function, forest, tolerance / size);
        space.only_adds = only_adds;
        let mut corners = Corners::default();
        let sizes = Sizes {
            tolerance,
            hiding,
            most,
            threads,
        };
        let mut progress = progress.part(start, start + 0.1).in_phase(Phase::Cells);
        match dual(&mut space, &mut corners, &sizes, &mut progress) {
            Err(MeshError::TooMany { .. }) => {}
            result => {
                grown = Some((space, corners, sizes, result?));
                break;
            }
        }
    }
    let (mut space, mut corners, sizes, mut first) = grown.ok_or_else(too_rough)?;
    if crossing(&space.forest).is_empty() {
        let mut cells = space.forest.cells.iter();
        let is_inside = cells.any(|cell| cell.child == NONE && cell.side == Side::Inside);
        return Err(if is_inside {
            MeshError::AllInside
        } else {
            MeshError::Nothing
        });
    }
    for (i, start) in FINE_MESHES.into_iter().enumerate() {
        let end = FINE_MESHES.get(i + 1).copied().unwrap_or(1.0);
        let mut progress = progress.part(start, end);
        let cells = &mut progress.part(0.0, 0.5).in_phase(Phase::Cells);
        let raw = match first.take() {
            Some(raw) => Ok(Some(raw)),
            None if i == 0 => Ok(None),
            None => separate(&mut space, &mut corners, &sizes, cells),
        };
        let raw = match raw {
            Ok(Some(raw)) => Ok(raw),
            Ok(None) => march_all(&mut space, &mut corners, &sizes, cells),
            Err(error) => Err(error),
        };
        let raw = match raw {
            Err(MeshError::TooMany { .. }) => break,
            raw => raw?,
        };
        let mut progress = progress.part(0.5, 1.0).in_phase(Phase::Triangles);
        progress.at(0.0)?;
        if raw.triangles.is_empty() {
            return Err(MeshError::Nothing);
        }
        if is_flat(&raw, tolerance) {
            break;
        }
        let mut fine = Fine {
            space: &space,
            raw: &raw,
            seen: &raw,
            domain,
            tolerance,
            threads,
        };
        let mut made = fine.coarsen(&mut progress.part(0.0, 0.5))?;
        let mut moved;
        if let Err(far) = made {
            moved = raw.clone();
            made = match untangle(&space, &mut moved, &sizes, &mut progress.part(0.5, 0.5))? {
                Untangled::Always => Err(far),
                Untangled::Now => {
                    fine.raw = &moved;
                    fine.coarsen(&mut progress.part(0.5, 1.0))?
                }
                Untangled::Not(places) => Err(Left { places, mesh: None }),
            };
        }
        match made {
            Ok((mesh, measured)) => {
                if mesh.triangles.len() > max_triangles {
                    return Err(too_many(tolerance, mesh.triangles.len(), max_triangles));
                }
                let forest = &space.forest;
                return Ok(SurfaceMesh {
                    error: measured.largest[0].max(measured.largest[1]),
                    mesh,
                    unproved: 0,
                    measured,
                    crossings: 0,
                    undecided: Vec::new(),
                    finest: forest.size(forest.deepest).max_element(),
                    cells: crossing(forest).len(),
                    raw_triangles: raw.triangles.len(),
                    is_cut: raw.is_lid.contains(&true),
                    evaluations: space.evaluations(),
                });
            }
            Err(left) => refine(&mut space, &left.places),
        }
    }
    Err(too_rough())
}

/// Meshes limbs that are so thin that they need too many cells. Where the mesh is not within the
/// tolerance, as where limbs touch, the places are told. `None` if that fails.
fn mesh_limbs(
    space: &mut Space<'_>,
    cages: &[Cage],
    domain: &Aabb,
    sizes: &Sizes,
    progress: &mut Progress<'_>,
) -> Result<Option<SurfaceMesh>, MeshError> {
    let cells = &mut progress.part(0.0, 0.5).in_phase(Phase::Cells);
    let raw = match unite_tubes(space, cages, sizes, cells) {
        Err(MeshError::Failed(_)) => return Ok(None),
        raw => raw?,
    };
    if raw.triangles.is_empty() || !find_crossings(&raw)?.is_empty() {
        return Ok(None);
    }
    let mut progress = progress.part(0.5, 1.0).in_phase(Phase::Triangles);
    let fine = Fine {
        space,
        raw: &raw,
        seen: &raw,
        domain,
        tolerance: sizes.tolerance,
        threads: sizes.threads,
    };
    let (mesh, measured, undecided) = match fine.coarsen(&mut progress.part(0.0, 0.8))? {
        Ok((mesh, measured)) => (mesh, measured, Vec::new()),
        Err(Left { mesh: None, .. }) => return Ok(None),
        Err(Left {
            mesh: Some(mesh), ..
        }) => fine.measure_farther(mesh, &mut progress.part(0.8, 1.0))?,
    };
    let error = measured.largest[0].max(measured.largest[1]);
    if MENDED * undecided.len() > mesh.triangles.len() || !error.is_finite() {
        return Ok(None);
    }
    let forest = &fine.space.forest;
    Ok(Some(SurfaceMesh {
        error,
        mesh,
        unproved: 0,
        measured,
        crossings: 0,
        undecided,
        finest: forest.size(forest.deepest).max_element(),
        cells: forest.cells.len(),
        raw_triangles: raw.triangles.len(),
        is_cut: false,
        evaluations: fine.space.evaluations(),
    }))
}

/// Makes the mesh that is dual to cells, of smaller cells where it cuts itself.
fn separate(
    space: &mut Space<'_>,
    corners: &mut Corners,
    sizes: &Sizes,
    progress: &mut Progress<'_>,
) -> Result<Option<Raw>, MeshError> {
    for _ in 0..SEPARATIONS {
        let Some(mut raw) = dual(space, corners, sizes, progress)? else {
            return Ok(None);
        };
        match untangle(space, &mut raw, sizes, progress)? {
            Untangled::Not(places) => refine(space, &places),
            _ => return Ok(Some(raw)),
        }
    }
    Ok(None)
}

/// State of a fine mesh after its vertices were moved.
enum Untangled {
    /// A mesh that did not cut itself before.
    Always,
    /// A mesh that cuts itself no longer.
    Now,
    /// Places where the mesh still cuts itself.
    Not(Vec<DVec3>),
}

/// Moves the vertices of triangles that cut others to places in their cells, then those beside
/// them, until the mesh does not cut itself or that does not help.
fn untangle(
    space: &Space<'_>,
    raw: &mut Raw,
    sizes: &Sizes,
    progress: &mut Progress<'_>,
) -> Result<Untangled, MeshError> {
    let mut is_moved = vec![false; raw.vertices.len()];
    for round in 0..=UNTANGLINGS {
        let faces = find_crossings(raw)?;
        if faces.is_empty() {
            return Ok(match round {
                0 => Untangled::Always,
                _ => Untangled::Now,
            });
        }
        let corners = faces.iter().flat_map(|i| raw.triangles[*i as usize]);
        let mut own: Vec<u32> = corners.collect();
        own.sort_unstable();
        if round > 0 {
            let all = raw.triangles.iter();
            let beside = all.filter(|t| t.iter().any(|v| own.binary_search(v).is_ok()));
            own = beside.flatten().copied().collect();
            own.sort_unstable();
        }
        own.dedup();
        own.retain(|v| !raw.anchors.is_empty() && !is_moved[*v as usize]);
        if own.is_empty() || round == UNTANGLINGS {
            let places = faces.iter().map(|i| {
                let corners = raw.triangles[*i as usize].map(|v| &raw.vertices[v as usize]);
                Aabb::of_points(corners.map(|v| v.position)).center()
            });
            return Ok(Untangled::Not(places.collect()));
        }
        let goals: Vec<(DVec3, f64)> = own
            .iter()
            .map(|v| (raw.anchors[*v as usize], 0.0))
            .collect();
        let found = descend(space, &goals, 0, sizes.tolerance, sizes.threads, progress)?;
        for (v, vertex) in own.iter().zip(found) {
            raw.vertices[*v as usize] = vertex;
            is_moved[*v as usize] = true;
        }
    }
    Ok(Untangled::Not(Vec::new()))
}

/// Returns the triangles that cut others, or are flat.
fn find_crossings(raw: &Raw) -> Result<Vec<u32>, MeshError> {
    let positions = raw.vertices.iter().map(|v| v.position).collect();
    let mesh = TriangleMesh::new(positions, raw.triangles.clone());
    let crossings = self_intersections(&mesh, MOST_TANGLED)
        .map_err(|error| MeshError::Failed(error.to_string()))?;
    let faces = crossings.pairs.as_flattened().iter().chain(&crossings.flat);
    Ok(faces.copied().collect())
}

/// The mesh of the level set of tetrahedra, which may be cut off by the box.
fn march_all(
    space: &mut Space<'_>,
    corners: &mut Corners,
    sizes: &Sizes,
    progress: &mut Progress<'_>,
) -> Result<Raw, MeshError> {
    let mut lattice = Lattice::default();
    grow_tetrahedra(space, corners, &mut lattice, sizes, progress)?;
    march(
        space,
        &lattice,
        Some(sizes.tolerance),
        sizes.threads,
        progress,
    )
}

/// Why a mesh has more triangles than the limit, with the tolerance at which it would not.
fn too_many(tolerance: f64, count: usize, limit: usize) -> MeshError {
    MeshError::TooMany {
        limit,
        fitting: Some(tolerance * 1.2 * count as f64 / limit as f64),
    }
}

/// Why no mesh of a measured error was made.
fn too_rough() -> MeshError {
    MeshError::Failed("the surface is too rough for a mesh whose error is only measured".into())
}

/// Whether the function is flat at many places where it is the threshold, as where bodies lie on
/// each other: then its signs are those of roundings.
fn is_flat(raw: &Raw, tolerance: f64) -> bool {
    let steep = raw.vertices.iter();
    // Not so for NaN.
    let steep = steep.filter(|v| v.gradient.length() * tolerance >= FLAT * THRESHOLD);
    20 * steep.count() < 19 * raw.vertices.len()
}

/// Splits the leaves at some places.
fn refine(space: &mut Space<'_>, places: &[DVec3]) {
    let mut leaves: Vec<u32> = places.iter().map(|p| space.forest.leaf_at(*p)).collect();
    leaves.sort_unstable();
    leaves.dedup();
    for node in leaves {
        let cell = space.forest.cells[node as usize];
        if cell.child == NONE && cell.level < space.forest.deepest {
            if let Some(part) = space.narrow(&cell) {
                space.forest.cells[node as usize].part = space.add(part, cell.part);
            }
            space.forest.split(node);
        }
    }
}

/// A cube by its centre and half its side.
fn cube(center: DVec3, half: f64) -> Aabb {
    Aabb {
        min: center - half,
        max: center + half,
    }
}

/// A fine mesh that is to become a coarser one.
struct Fine<'a> {
    space: &'a Space<'a>,
    raw: &'a Raw,
    /// The mesh before vertices were moved off the surface.
    seen: &'a Raw,
    domain: &'a Aabb,
    tolerance: f64,
    threads: usize,
}

/// Rest of a failed attempt.
#[derive(Default)]
struct Left {
    /// Places where the mesh cuts itself, or is too far from the surface.
    places: Vec<DVec3>,
    /// The last mesh, if it does not cut itself.
    mesh: Option<TriangleMesh>,
}

/// A mesh with distances between it and the surface.
struct Survey {
    mesh: TriangleMesh,
    /// The sample of each triangle that is farthest from the surface; `None` for lids.
    there: Vec<Option<(DVec3, f64)>>,
    /// The triangle nearest to each place of the surface.
    back: Vec<(u32, f64)>,
}

/// A place where a mesh is too far from the surface.
struct Far {
    place: DVec3,
    triangle: u32,
    /// Distance around the place in which the mesh is to blame.
    reach: f64,
}

impl Survey {
    /// Returns the places that are too far: samples of triangles, then places of the surface.
    fn far(&self, places: &[DVec3], tolerance: f64) -> Vec<Far> {
        let mut far = Vec::new();
        for (triangle, worst) in (0..).zip(&self.there) {
            let Some((place, distance)) = *worst else {
                continue;
            };
            // Not so for NaN.
            let is_within = distance <= tolerance;
            if !is_within {
                let corners = self.mesh.corners(triangle as usize);
                let reach = corners.map(|corner| corner.distance(place));
                far.push(Far {
                    place,
                    triangle,
                    reach: reach.into_iter().fold(0.0, f64::max),
                });
            }
        }
        let back = places.iter().zip(&self.back);
        let missed = back.filter(|(_, (_, distance))| *distance > tolerance);
        far.extend(missed.map(|(place, (triangle, distance))| Far {
            place: *place,
            triangle: *triangle,
            reach: 2.0 * distance,
        }));
        far
    }

    /// Returns the largest distances.
    fn sum_up(&self) -> Measured {
        let mut measured = Measured::default();
        for (_, distance) in self.there.iter().flatten() {
            measured.add(0, &[*distance]);
            measured.samples[0] += SAMPLES.len() - 1;
        }
        for (_, distance) in &self.back {
            measured.add(1, &[*distance]);
        }
        measured
    }
}

impl Fine<'_> {
    /// A coarser mesh with its measured error, which is within the tolerance; or the places where
    /// the fine mesh itself is too far from the surface.
    fn coarsen(
        &self,
        progress: &mut Progress<'_>,
    ) -> Result<Result<(TriangleMesh, Measured), Left>, MeshError> {
        let count = self.raw.vertices.len();
        let mut shares = vec![1.0; count];
        let mut is_guarded = vec![false; count];
        let points = self
            .raw
            .vertices
            .iter()
            .map(|v| Aabb::of_points([v.position]));
        let points = Bvh::new(&points.collect::<Vec<Aabb>>());
        let places = self.places(progress)?;
        let mut left = Left::default();
        for attempt in 0..ATTEMPTS {
            let [start, end] = [0, 1].map(|i| (attempt + i) as f32 / ATTEMPTS as f32);
            let progress = &mut progress.part(start, end);
            let decimation = Decimation::new(
                self.space,
                self.raw,
                self.threads,
                self.tolerance,
                &shares,
                &is_guarded,
            )?;
            let Decimated { mesh, sources } = decimation.run(&mut progress.part(0.0, 0.7))?;
            progress.at(0.7)?;
            let crossings = self_intersections(&mesh, MOST_CROSSINGS)
                .map_err(|error| MeshError::Failed(error.to_string()))?;
            if !crossings.is_free() {
                left.places.clear();
                if attempt == 0 && !find_crossings(self.raw)?.is_empty() {
                    return Ok(Err(Left::default()));
                }
                let faces = crossings.pairs.as_flattened().iter().chain(&crossings.flat);
                for i in faces {
                    let corners = mesh.corners(*i as usize);
                    let bounds = Aabb::of_points(corners);
                    let reach = 0.5 * bounds.size().max_element();
                    left.places.push(bounds.center());
                    for i in points.overlapping(&cube(bounds.center(), reach)) {
                        is_guarded[i as usize] = true;
                    }
                    for corner in mesh.triangles[*i as usize] {
                        is_guarded[sources[corner as usize] as usize] = true;
                    }
                }
                if attempt >= 1 {
                    is_guarded.fill(true);
                }
                continue;
            }
            let mut survey = self.survey(mesh, &places, progress)?;
            let mut far = survey.far(&places, self.tolerance);
            for _ in 0..MENDINGS {
                if far.is_empty() {
                    break;
                }
                let Some(mended) = self.mend(&survey, &places, progress)? else {
                    break;
                };
                survey = mended;
                far = survey.far(&places, self.tolerance);
            }
            if far.is_empty() {
                let measured = survey.sum_up();
                return Ok(Ok((survey.mesh, measured)));
            }
            for Far { place, reach, .. } in &far {
                for i in points.overlapping(&cube(*place, *reach)) {
                    let share = &mut shares[i as usize];
                    *share = if *share * LESS < KEPT {
                        0.0
                    } else {
                        *share * LESS
                    };
                }
            }
            left = Left {
                places: far.into_iter().map(|far| far.place).collect(),
                mesh: Some(survey.mesh),
            };
        }
        Ok(Err(left))
    }

    /// Measures a mesh some places of which may not be within the tolerance, and returns those that
    /// are not: a place is no farther from the surface than from the nearest vertex on it.
    fn measure_farther(
        &self,
        mesh: TriangleMesh,
        progress: &mut Progress<'_>,
    ) -> Result<(TriangleMesh, Measured, Vec<DVec3>), MeshError> {
        let places = self.places(progress)?;
        let mut survey = self.survey(mesh, &places, progress)?;
        let near = FOOT * self.tolerance;
        let on = self.seen.vertices.iter().filter(|v| v.distance() <= near);
        let on: Vec<DVec3> = on.map(|v| v.position).collect();
        let points: Vec<Aabb> = on.iter().map(|p| Aabb::of_points([*p])).collect();
        let points = Bvh::new(&points);
        for (place, distance) in survey.there.iter_mut().flatten() {
            if *distance > self.tolerance {
                let nearest = points.nearest(*place, f64::INFINITY, |i| {
                    on[i as usize].distance_squared(*place)
                });
                *distance = distance.min(root_of(nearest) + near);
            }
        }
        let far = survey.far(&places, self.tolerance).into_iter();
        let far = far.map(|far| far.place).collect();
        let measured = survey.sum_up();
        Ok((survey.mesh, measured, far))
    }

    /// The places of the surface that are looked for on meshes.
    fn places(&self, progress: &mut Progress<'_>) -> Result<Vec<DVec3>, MeshError> {
        let raw = self.seen;
        let on = raw.vertices.iter().filter(|v| self.is_on(v));
        let mut places: Vec<DVec3> = on.map(|v| v.position).collect();
        let fine = (0..raw.triangles.len()).filter(|i| !raw.is_lid[*i]);
        let fine = spread(fine.collect(), PLACES);
        let goals = fine.into_iter().map(|i| {
            let corners = raw.triangles[i].map(|v| raw.vertices[v as usize].position);
            let [a, b, c] = corners;
            let reach = a.distance(b).max(b.distance(c)).max(c.distance(a));
            ((a + b + c) / 3.0, reach)
        });
        let goals: Vec<(DVec3, f64)> = goals.collect();
        let (space, tolerance) = (self.space, self.tolerance);
        let found = descend(space, &goals, STEPS, tolerance, self.threads, progress)?;
        let on = found.into_iter().filter(|v| self.is_on(v));
        places.extend(on.map(|v| v.position).filter(|p| space.forest.contains(*p)));
        Ok(places)
    }

    /// Whether a vertex is so near the surface that it counts as a place of it.
    fn is_on(&self, vertex: &Vertex) -> bool {
        vertex.distance() <= ON * self.tolerance
    }

    /// Measures both distances.
    fn survey(
        &self,
        mesh: TriangleMesh,
        places: &[DVec3],
        progress: &mut Progress<'_>,
    ) -> Result<Survey, MeshError> {
        let all: Vec<usize> = (0..mesh.triangles.len()).collect();
        Ok(Survey {
            there: self.measure_triangles(&mesh, &all, progress)?,
            back: self.measure_places(&mesh, places, progress)?,
            mesh,
        })
    }

    /// Mends the mesh where it is too far from the surface, and measures what has changed; `None`
    /// if there is too much to mend, or if that fails.
    fn mend(
        &self,
        survey: &Survey,
        places: &[DVec3],
        progress: &mut Progress<'_>,
    ) -> Result<Option<Survey>, MeshError> {
        let (tolerance, old) = (self.tolerance, &survey.mesh);
        let far = survey.far(places, tolerance);
        if MENDED * far.len() > old.triangles.len() || self.raw.is_lid.contains(&true) {
            return Ok(None);
        }
        let goals: Vec<(DVec3, f64)> = far.iter().map(|far| (far.place, tolerance)).collect();
        let (space, threads) = (self.space, self.threads);
        let found = descend(space, &goals, STEPS, tolerance, threads, progress)?;
        // A step that leads far away tells of another part of the surface.
        let gaps = far.iter().zip(found).filter(|(far, vertex)| {
            self.is_on(vertex)
                && space.forest.contains(vertex.position)
                && vertex.position.distance(far.place) <= far.reach.max(tolerance)
        });
        let gaps: Vec<(u32, Vertex)> = gaps.map(|(far, v)| (far.triangle, v)).collect();
        let Some(mesh) = mend(old, &gaps, tolerance) else {
            return Ok(None);
        };
        let crossings =
            self_intersections(&mesh, 1).map_err(|error| MeshError::Failed(error.to_string()))?;
        if !crossings.is_free() {
            return Ok(None);
        }
        let matches = match_triangles(&old.triangles, &mesh.triangles);
        let fresh = (0..matches.len()).filter(|i| matches[*i].is_none());
        let fresh: Vec<usize> = fresh.collect();
        let there = matches.iter().map(|i| survey.there[(*i)? as usize]);
        let mut there: Vec<Option<(DVec3, f64)>> = there.collect();
        let found = self.measure_triangles(&mesh, &fresh, progress)?;
        for (i, worst) in fresh.into_iter().zip(found) {
            there[i] = worst;
        }
        // A place is no farther from the mesh than it was from a triangle that is still there. If
        // that is too far, another may be nearer now.
        let mut numbers = vec![None; old.triangles.len()];
        for (i, old) in (0..).zip(&matches) {
            if let Some(old) = old {
                numbers[*old as usize] = Some(i);
            }
        }
        let mut back = survey.back.clone();
        let lost = (0..back.len()).filter(|i| {
            let (triangle, distance) = back[*i];
            numbers[triangle as usize].is_none() || distance > tolerance
        });
        let lost: Vec<usize> = lost.collect();
        for (triangle, _) in &mut back {
            *triangle = numbers[*triangle as usize].unwrap_or(0);
        }
        let moved: Vec<DVec3> = lost.iter().map(|i| places[*i]).collect();
        let found = self.measure_places(&mesh, &moved, progress)?;
        for (i, nearest) in lost.into_iter().zip(found) {
            back[i] = nearest;
        }
        Ok(Some(Survey { mesh, there, back }))
    }

    /// The nearest triangle of a mesh to each of some places of the surface, and its distance.
    fn measure_places(
        &self,
        mesh: &TriangleMesh,
        places: &[DVec3],
        progress: &mut Progress<'_>,
    ) -> Result<Vec<(u32, f64)>, MeshError> {
        let bvh = Bvh::new(&mesh.triangle_boxes());
        map_told(self.threads, places, progress, |p| {
            let nearest = bvh.nearest(*p, f64::INFINITY, |i| {
                closest_point(&mesh.corners(i as usize), *p).distance_squared(*p)
            });
            (nearest.map_or(0, |(i, _)| i), root_of(nearest))
        })
    }

    /// Measures some triangles: the sample of each that is farthest from the surface, and its
    /// distance: infinite if no surface was found within the tolerance. `None` for lids.
    fn measure_triangles(
        &self,
        mesh: &TriangleMesh,
        some: &[usize],
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Option<(DVec3, f64)>>, MeshError> {
        let goals = some.iter().flat_map(|i| {
            let [a, b, c] = mesh.corners(*i);
            SAMPLES.map(|[u, v, w]| (a * u + b * v + c * w, 0.0))
        });
        let goals: Vec<(DVec3, f64)> = goals.collect();
        let (space, tolerance) = (self.space, self.tolerance);
        let samples = descend(space, &goals, 0, tolerance, self.threads, progress)?;
        let mut distances: Vec<f64> = samples.iter().map(Vertex::distance).collect();
        // Newton's steps from those that are not near for certain. Not so for NaN.
        let mut open: Vec<usize> = (0..samples.len()).collect();
        open.retain(|i| {
            let is_sure = distances[*i] <= SURE * tolerance;
            !is_sure
        });
        let goals = open.iter().map(|i| (samples[*i].position, tolerance));
        let goals: Vec<(DVec3, f64)> = goals.collect();
        let feet = descend(space, &goals, STEPS, tolerance, self.threads, progress)?;
        let mut unsure = Vec::new();
        for (i, foot) in open.into_iter().zip(&feet) {
            let off = foot.distance();
            let distance = samples[i].position.distance(foot.position) + off;
            if off <= FOOT * tolerance && distance <= tolerance {
                distances[i] = distance;
            } else if !self.is_lid(mesh.corners(some[i / SAMPLES.len()])) {
                unsure.push(i);
            }
        }
        let found = map_by(LARGE, self.threads, &unsure, progress, |i| {
            let [a, b, c] = mesh.corners(some[*i / SAMPLES.len()]);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            self.distance(samples[*i].position, normal)
        })?;
        for (i, distance) in unsure.into_iter().zip(found) {
            distances[i] = distance;
        }
        let samples = samples.chunks_exact(SAMPLES.len());
        let samples = samples.zip(distances.chunks_exact(SAMPLES.len()));
        let worst = some.iter().zip(samples).map(|(i, (samples, distances))| {
            if self.is_lid(mesh.corners(*i)) {
                return None;
            }
            let places = samples.iter().map(|sample| sample.position);
            let all = places.zip(distances.iter().copied());
            all.reduce(|one, other| if other.1 <= one.1 { one } else { other })
        });
        Ok(worst.collect())
    }

    /// Whether a triangle lies on a side of the box.
    fn is_lid(&self, corners: [DVec3; 3]) -> bool {
        (0..3).any(|k| {
            [self.domain.min[k], self.domain.max[k]]
                .iter()
                .any(|side| corners.iter().all(|p| p[k] == *side))
        })
    }

    /// The distance of a point from the surface; infinite if it is more than the tolerance.
    fn distance(&self, place: DVec3, normal: DVec3) -> f64 {
        let vertex = at(self.space, place);
        let first = vertex.distance();
        let uphill = vertex.gradient.normalize_or_zero();
        let toward = if vertex.value > 0.0 { -uphill } else { uphill };
        let reach = (1.05 * first).clamp(1e-3 * self.tolerance, self.tolerance);
        let mut least = f64::INFINITY;
        for direction in [toward, normal, -normal] {
            // A little more than the first estimate, then the whole tolerance by halves.
            let [near, far] = [reach, 0.5 * self.tolerance].map(|first| {
                let most = self.tolerance - first;
                along_ray(self.space, place, direction, first, most.max(0.0))
            });
            let found = near.into_iter().chain(far).fold(f64::INFINITY, f64::min);
            least = least.min(found);
            if least <= self.tolerance {
                return least;
            }
        }
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::Step;
    use crate::surface::box_of;
    use core::ops::ControlFlow;
    use field::{BlobScale, Kernel, Primitive, Shaping, Skeleton, Sum};

    /// Checks the mesh that is dual to cells of a limb and a ball.
    fn with_dual(check: impl FnOnce(&Space<'_>, Raw, &Aabb, &Sizes, &mut Progress<'_>)) {
        let shaping = Shaping {
            kernel: Kernel::Gauss,
            radius: 0.3,
            blobbiness: 2.0,
            blob_scale: BlobScale::Relative,
            strength: 1.0,
            influence: 1e-3,
            taper: None,
        };
        let (base, apex) = (DVec3::ZERO, DVec3::new(1.0, 0.3, 0.2));
        let ball = Skeleton::Point {
            center: DVec3::new(0.2, 0.5, 0.0),
        };
        let parts = [Skeleton::Segment { base, apex }, ball];
        let parts = parts.map(|skeleton| Primitive::new(skeleton, &shaping, None));
        let sum: Sum = parts.into_iter().flatten().collect();
        let domain = box_of(sum.support().unwrap());
        let sizes = Sizes {
            tolerance: 0.005,
            hiding: HIDING[0],
            most: LEAST_CELLS,
            threads: 1,
        };
        let forest = Forest::new(&domain, FINEST * sizes.tolerance, LEVELS);
        let mut space = Space::new(&sum, forest, sizes.tolerance);
        fn go_on(_: Step) -> ControlFlow<()> {
            ControlFlow::Continue(())
        }
        let mut report = go_on;
        let progress = &mut Progress::new(&mut report);
        let raw = dual(&mut space, &mut Corners::default(), &sizes, progress);
        check(&space, raw.unwrap().unwrap(), &domain, &sizes, progress);
    }

    /// Vertices that make triangles cut others go back to their cells.
    #[test]
    fn vertices_that_tangle_go_back() {
        with_dual(|space, mut raw, _, sizes, progress| {
            let sound = untangle(space, &mut raw, sizes, progress).unwrap();
            assert!(matches!(sound, Untangled::Always));
            let far = raw.vertices[raw.vertices.len() / 2].position;
            for (i, vertex) in raw.vertices.iter_mut().enumerate() {
                if i % 200 == 0 {
                    vertex.position = vertex.position.lerp(far, 0.6);
                }
            }
            assert!(!find_crossings(&raw).unwrap().is_empty());
            let mended = untangle(space, &mut raw, sizes, progress).unwrap();
            assert!(matches!(mended, Untangled::Now));
            assert!(find_crossings(&raw).unwrap().is_empty());
        });
    }

    /// A mesh that was decimated for a larger tolerance is mended for this one, and what was
    /// measured of it then is no less than a new measurement tells.
    #[test]
    fn repairs_bring_meshes_near_the_surface() {
        with_dual(check_repairs);
    }

    fn check_repairs(
        space: &Space<'_>,
        raw: Raw,
        domain: &Aabb,
        sizes: &Sizes,
        progress: &mut Progress<'_>,
    ) {
        let fine = Fine {
            space,
            raw: &raw,
            seen: &raw,
            domain,
            tolerance: sizes.tolerance,
            threads: 1,
        };
        let (shares, free) = (
            vec![1.0; raw.vertices.len()],
            vec![false; raw.vertices.len()],
        );
        let coarse = 1.4 * sizes.tolerance;
        let decimation = Decimation::new(space, &raw, 1, coarse, &shares, &free).unwrap();
        let mesh = decimation.run(progress).unwrap().mesh;
        let places = fine.places(progress).unwrap();
        let mut survey = fine.survey(mesh, &places, progress).unwrap();
        let before = survey.far(&places, sizes.tolerance).len();
        assert!(before > 0);
        for _ in 0..MENDINGS {
            if let Some(mended) = fine.mend(&survey, &places, progress).unwrap() {
                survey = mended;
            }
        }
        println!("{before} of {}", survey.mesh.triangles.len());
        assert!(survey.far(&places, sizes.tolerance).is_empty());
        let again = fine.survey(survey.mesh.clone(), &places, progress).unwrap();
        for (own, new) in survey.there.iter().zip(&again.there) {
            let [own, new] = [own, new].map(|worst| worst.unwrap().1);
            assert!((own - new).abs() < 1e-3 * sizes.tolerance);
        }
        for ((triangle, own), place) in survey.back.iter().zip(&places) {
            let nearest = closest_point(&survey.mesh.corners(*triangle as usize), *place);
            assert!((nearest.distance(*place) - own).abs() < 1e-9);
        }
        for (own, new) in survey.back.iter().zip(&again.back) {
            assert!(own.1 >= new.1 - 1e-9);
        }
    }
}
