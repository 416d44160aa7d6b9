//! The clay: a mesh with masks, colours and a region.

use crate::error::{Error, fail};
use crate::grid::Grid;
use crate::limits::{FARTHEST, MAX_FACES};
use crate::spread::Scratch;
use crate::start::Start;
use glam::DVec3;
use mesh::{Built, FaceId, HalfEdgeMesh, PolygonSoup, Repairs, TriangleMesh, VertexId};

/// Mesh that is sculpted. For each vertex it has a mask, from 0 (free) to 1 (neither moved nor
/// removed), and a colour.
///
/// ```
/// use sculpt::{Clay, Refinement, Shape, Start};
///
/// let mut clay = Clay::of_shape(&Start::new(Shape::Tetrahedron, 1))?;
/// clay.refine(Refinement::Propagate)?;
/// assert_eq!(clay.mesh().face_count(), 16);
/// # Ok::<(), sculpt::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Clay {
    pub(crate) mesh: HalfEdgeMesh,
    /// Linear RGB of each vertex slot.
    pub(crate) colors: Vec<[f32; 3]>,
    /// The mask of each vertex slot.
    pub(crate) masks: Vec<f32>,
    pub(crate) is_painted: bool,
    pub(crate) region: Region,
    /// Whether tools are mirrored in the planes x = 0, y = 0, z = 0.
    pub(crate) symmetry: [bool; 3],
    pub(crate) grid: Grid,
    pub(crate) scratch: Scratch,
    /// Vertices visited by strokes.
    pub(crate) work: u64,
}

/// The colour of unpainted vertices.
const WHITE: [f32; 3] = [1.0; 3];

/// The faces that refinements, deletions and the like work on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Region {
    /// The region is all faces.
    #[default]
    All,
    /// The given faces, in ascending order.
    Faces(Vec<FaceId>),
}

impl Clay {
    /// Makes clay from a start shape.
    ///
    /// # Errors
    /// If it would have too many faces.
    pub fn of_shape(start: &Start) -> Result<Self, Error> {
        start.check()?;
        let (clay, _) = Self::of_polygons(&start.polygons())?;
        Ok(clay)
    }

    /// Makes clay from any polygons; what is no manifold is repaired, and the repairs are returned.
    ///
    /// # Errors
    /// If there are no faces or too many, or a position is not usable.
    pub fn of_polygons(soup: &PolygonSoup) -> Result<(Self, Repairs), Error> {
        check(soup)?;
        Self::of_built(HalfEdgeMesh::repair(soup)?)
    }

    fn of_built(built: Built) -> Result<(Self, Repairs), Error> {
        if built.mesh.face_count() == 0 {
            return fail("this mesh has no faces");
        }
        let slots = built.mesh.vertex_slots();
        let mut clay = Self {
            mesh: built.mesh,
            colors: vec![WHITE; slots],
            masks: vec![0.0; slots],
            is_painted: false,
            region: Region::All,
            symmetry: [false; 3],
            grid: Grid::default(),
            scratch: Scratch::default(),
            work: 0,
        };
        clay.index_vertices();
        Ok((clay, built.repairs))
    }

    /// Makes clay from a triangle mesh with its colours; what is no manifold is repaired, and the
    /// repairs are returned. Vertices at the same place become one, as files of single triangles
    /// need it.
    ///
    /// # Errors
    /// Fails as [`Clay::of_polygons`] does.
    pub fn of_triangles(mesh: &TriangleMesh) -> Result<(Self, Repairs), Error> {
        let (joined, first) = join_vertices(mesh);
        check(&joined)?;
        let built = HalfEdgeMesh::repair(&joined)?;
        let sources = built.sources.clone();
        let (mut clay, repairs) = Self::of_built(built)?;
        if let Some(colors) = &mesh.colors {
            clay.is_painted = true;
            for (color, source) in clay.colors.iter_mut().zip(sources) {
                *color = colors[first[source as usize] as usize];
            }
        }
        Ok((clay, repairs))
    }

    /// The mesh.
    #[must_use]
    pub fn mesh(&self) -> &HalfEdgeMesh {
        &self.mesh
    }

    /// The faces that refinements and the like work on.
    #[must_use]
    pub fn region(&self) -> &Region {
        &self.region
    }

    /// The mask of a vertex, from 0 (free) to 1 (neither moved nor removed).
    #[must_use]
    pub fn mask(&self, v: VertexId) -> f32 {
        self.masks[v.index()]
    }

    /// The colour of a vertex, linear RGB.
    #[must_use]
    pub fn color(&self, v: VertexId) -> [f32; 3] {
        self.colors[v.index()]
    }

    /// Whether tools are mirrored in the planes x = 0, y = 0, z = 0.
    #[must_use]
    pub fn symmetry(&self) -> [bool; 3] {
        self.symmetry
    }

    /// Vertices that strokes have visited so far: a measure of their cost.
    #[must_use]
    pub fn work(&self) -> u64 {
        self.work
    }

    /// The sum of the normals of the faces at a vertex by area, of length 1; zero where they cancel
    /// out.
    #[must_use]
    pub fn normal(&self, v: VertexId) -> DVec3 {
        let faces = self.mesh.vertex_faces(v);
        let sum: DVec3 = faces.map(|f| self.mesh.face_normal(f)).sum();
        sum.normalize_or_zero()
    }

    /// The triangles, with smooth normals, and colours if anything is painted. Polygons are cut.
    ///
    /// # Errors
    /// If cutting them makes the mesh too large.
    pub fn to_triangles(&self) -> Result<TriangleMesh, Error> {
        let compact = self.mesh.compact();
        let mut cut = compact.clone();
        cut.triangulate()?;
        let mut mesh = cut.to_triangles()?;
        if self.is_painted {
            let own = self.mesh.vertices().map(|v| self.color(v));
            let mut colors: Vec<[f32; 3]> = own.collect();
            // Centres of large polygons come last.
            for v in (colors.len()..cut.vertex_slots()).map(|v| VertexId(v as u32)) {
                let around = cut.neighbors(v).map(|n| colors.get(n.index()).copied());
                let around: Vec<[f32; 3]> = around.flatten().collect();
                colors.push(mean_color(&around));
            }
            mesh.colors = Some(colors);
        }
        let mut normals = vec![DVec3::ZERO; mesh.positions.len()];
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
            for i in triangle {
                normals[*i as usize] += (b - a).cross(c - a);
            }
        }
        mesh.normals = Some(normals.iter().map(|n| n.normalize_or_zero()).collect());
        Ok(mesh)
    }

    /// Returns a hash of all bits: of positions, connections, masks, colours, region and symmetry.
    #[must_use]
    pub fn digest(&self) -> u64 {
        let mut hash = Fnv::default();
        for p in (0..self.mesh.vertex_slots()).map(|v| self.mesh.position(VertexId(v as u32))) {
            p.to_array().iter().for_each(|x| hash.add(x.to_bits()));
        }
        for h in self.mesh.half_edges() {
            hash.add(u64::from(h.0));
            hash.add(u64::from(self.mesh.origin(h).0));
            hash.add(u64::from(self.mesh.next(h).0));
            hash.add(self.mesh.face(h).map_or(u64::MAX, |f| u64::from(f.0)));
        }
        for v in self.mesh.vertices() {
            hash.add(u64::from(v.0));
            hash.add(u64::from(self.mesh.outgoing(v).0));
            hash.add(u64::from(self.mask(v).to_bits()));
            let color = self.color(v).map(f32::to_bits);
            color.iter().for_each(|c| hash.add(u64::from(*c)));
        }
        if let Region::Faces(faces) = &self.region {
            faces.iter().for_each(|f| hash.add(u64::from(f.0)));
        }
        self.symmetry.iter().for_each(|on| hash.add(u64::from(*on)));
        hash.0
    }

    /// Enters all vertices into the grid.
    pub(crate) fn index_vertices(&mut self) {
        let (mut sum, mut count) = (0.0, 0.0);
        for h in self.mesh.edges() {
            let [a, b] = [self.mesh.origin(h), self.mesh.target(h)];
            sum += self.mesh.position(a).distance(self.mesh.position(b));
            count += 1.0;
        }
        self.grid = Grid::new(self.mesh.vertex_slots(), sum / count);
        for v in self.mesh.vertices() {
            self.grid.set(v.0, self.mesh.position(v));
        }
    }

    /// Moves a vertex, and returns where it was. A position beyond the limits is left out.
    pub(crate) fn replace_position(&mut self, v: u32, position: DVec3) -> DVec3 {
        let old = self.mesh.position(VertexId(v));
        if is_near(position) && self.mesh.set_position(VertexId(v), position).is_ok() {
            self.grid.set(v, position);
        }
        old
    }

    /// The faces of the region.
    pub(crate) fn region_faces(&self) -> Vec<FaceId> {
        match &self.region {
            Region::All => self.mesh.faces().collect(),
            Region::Faces(faces) => faces.clone(),
        }
    }

    /// `true` if a face belongs to the region.
    pub(crate) fn is_in_region(&self, f: FaceId) -> bool {
        match &self.region {
            Region::All => true,
            Region::Faces(faces) => faces.binary_search(&f).is_ok(),
        }
    }
}

/// Checks the number of faces and the places of vertices.
fn check(soup: &PolygonSoup) -> Result<(), Error> {
    let count = soup.face_count();
    if count > MAX_FACES {
        return fail(format!(
            "this mesh has {count} faces, more than the {MAX_FACES} that can be sculpted"
        ));
    }
    match soup.positions.iter().position(|p| !is_near(*p)) {
        Some(i) => fail(format!("vertex {i} (from 0) is not within 1e9")),
        None => Ok(()),
    }
}

fn is_near(p: DVec3) -> bool {
    p.is_finite() && p.abs().max_element() <= FARTHEST
}

/// Makes one vertex of those at the same place. Returns the triangles, and for each vertex the
/// first of the mesh's at its place.
fn join_vertices(mesh: &TriangleMesh) -> (PolygonSoup, Vec<u32>) {
    let key = |i: &u32| {
        (mesh.positions[*i as usize] + DVec3::ZERO)
            .to_array()
            .map(f64::to_bits)
    };
    let mut order: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    order.sort_by_key(|i| (key(i), *i));
    let mut same = vec![0; order.len()];
    for group in order.chunk_by(|a, b| key(a) == key(b)) {
        for i in group {
            same[*i as usize] = group[0];
        }
    }
    // Those that stay, in their order.
    let mut number = vec![0; order.len()];
    let mut first = Vec::new();
    for i in 0..order.len() {
        if same[i] as usize == i {
            number[i] = first.len() as u32;
            first.push(i as u32);
        }
    }
    let positions = first.iter().map(|i| mesh.positions[*i as usize]).collect();
    let mut soup = PolygonSoup::new(positions);
    for triangle in &mesh.triangles {
        soup.add_face(&triangle.map(|i| number[same[i as usize] as usize]));
    }
    (soup, first)
}

/// The mean of some colours; white if there are none.
pub(crate) fn mean_color(colors: &[[f32; 3]]) -> [f32; 3] {
    if colors.is_empty() {
        return WHITE;
    }
    let count = colors.len() as f64;
    [0, 1, 2].map(|k| {
        let sum: f64 = colors.iter().map(|c| f64::from(c[k])).sum();
        (sum / count) as f32
    })
}

/// The hash of Fowler, Noll and Vo (FNV-1a), by words of 64 bits.
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    fn add(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0x100_0000_01b3);
    }
}
