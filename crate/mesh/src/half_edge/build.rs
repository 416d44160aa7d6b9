//! Construction of the half-edge mesh from polygons, with detection and repair of non-manifold
//! parts.

use super::connectivity::HalfEdgeMesh;
use super::id::{HalfEdgeId, NONE};
use super::soup::PolygonSoup;
use crate::error::{Error, fail};
use crate::limits::MAX_HALF_EDGES;
use crate::triangle_mesh::TriangleMesh;
use core::fmt;

/// Changes by which polygons became a manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Repairs {
    /// Faces with fewer than three vertices or with one twice: left out.
    pub dropped_faces: usize,
    /// Faces turned over, so that neighbours agree on what is outside.
    pub flipped_faces: usize,
    /// Edges of more than two faces, or of two that disagree on what is outside: separated.
    pub split_edges: usize,
    /// Vertices where several fans of faces met: one vertex for each fan.
    pub split_vertices: usize,
    /// Edges that joined vertices already joined: given a vertex in the middle.
    pub halved_edges: usize,
}

impl Repairs {
    /// `true` if the polygons were a manifold as they came.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

impl fmt::Display for Repairs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = [
            (self.dropped_faces, "faces with a vertex twice"),
            (self.flipped_faces, "faces that are turned inside out"),
            (self.split_edges, "edges where more than two faces meet"),
            (self.split_vertices, "vertices where sheets only touch"),
            (self.halved_edges, "edges that join the same two vertices"),
        ];
        let mut words = counts.iter().filter(|(count, _)| *count > 0).peekable();
        if words.peek().is_none() {
            return f.write_str("a manifold");
        }
        while let Some((count, what)) = words.next() {
            write!(f, "{count} {what}")?;
            if words.peek().is_some() {
                f.write_str(", ")?;
            }
        }
        Ok(())
    }
}

/// Mesh made of polygons, with what was repaired.
#[derive(Clone, Debug)]
pub struct Built {
    /// The mesh.
    pub mesh: HalfEdgeMesh,
    /// The changes.
    pub repairs: Repairs,
    /// The polygons' vertex that each vertex of the mesh comes from: for colours and the like. A
    /// vertex in the middle of a halved edge comes from one of its ends.
    pub sources: Vec<u32>,
}

impl HalfEdgeMesh {
    /// Builds the mesh of polygons that are a manifold, with or without boundary. Vertices keep
    /// their order; vertices without a face are left out.
    ///
    /// # Errors
    /// If the polygons are no manifold: says in words why. If a vertex is missing or not finite, or
    /// the mesh is over the [`crate::limits`].
    pub fn from_polygons(soup: &PolygonSoup) -> Result<Self, Error> {
        let built = Self::repair(soup)?;
        if built.repairs.is_none() {
            Ok(built.mesh)
        } else {
            fail(format!("this is no manifold: {}", built.repairs))
        }
    }

    /// Like [`HalfEdgeMesh::from_polygons`], for triangles.
    ///
    /// # Errors
    /// The same.
    pub fn from_triangles(mesh: &TriangleMesh) -> Result<Self, Error> {
        Self::from_polygons(&PolygonSoup::from(mesh))
    }

    /// Builds a mesh of any polygons. Faces are turned over where that makes neighbours agree (as
    /// few as possible in each component); edges of more than two faces, and vertices of several
    /// fans, are separated. Closed bodies that touch in edges or vertices come apart and stay
    /// closed.
    ///
    /// ```
    /// use glam::DVec3;
    /// use mesh::{HalfEdgeMesh, PolygonSoup};
    ///
    /// // Two triangles that touch in a vertex.
    /// let points = [0, 1, 2, 3, 4].map(|i| DVec3::splat(f64::from(i)));
    /// let mut soup = PolygonSoup::new(points.to_vec());
    /// soup.add_face(&[0, 1, 2]);
    /// soup.add_face(&[2, 3, 4]);
    /// assert!(HalfEdgeMesh::from_polygons(&soup).is_err());
    /// let built = HalfEdgeMesh::repair(&soup)?;
    /// assert_eq!(built.repairs.split_vertices, 1);
    /// assert_eq!(built.sources, [0, 1, 2, 3, 4, 2]);
    /// # Ok::<(), mesh::Error>(())
    /// ```
    ///
    /// # Errors
    /// If a face has a vertex that does not exist, a position is not finite, or the mesh is over
    /// the [`crate::limits`].
    pub fn repair(soup: &PolygonSoup) -> Result<Built, Error> {
        let mut repairs = Repairs::default();
        let mut corners = Corners::new(soup, &mut repairs)?;
        let mut edges = corners.edges();
        repairs.flipped_faces = corners.orient(&edges);
        if repairs.flipped_faces > 0 {
            edges = corners.edges();
        }
        let partner = corners.pair(&edges, &mut repairs);
        let mut sources = corners.separate_vertices(&partner, soup.positions.len(), &mut repairs);
        let double = corners.double_edges(&partner);
        let mut mesh = corners.connect(&partner);
        mesh.positions = sources
            .iter()
            .map(|v| soup.positions[*v as usize])
            .collect();
        for h in double.iter().map(|c| HalfEdgeId(corners.half_edge[*c])) {
            let [a, b] = [mesh.origin(h), mesh.target(h)];
            let middle = 0.5 * mesh.position(a) + 0.5 * mesh.position(b);
            mesh.split_edge(h, middle)
                .map_err(|error| Error(error.to_string()))?;
            sources.push(sources[a.index()]);
            repairs.halved_edges += 1;
        }
        Ok(Built {
            mesh,
            repairs,
            sources,
        })
    }
}

/// The faces' corners one after another. Corner c also stands for the half-edge from its vertex to
/// the next corner's.
struct Corners {
    vertex: Vec<u32>,
    /// First corner of each face; after those of all faces, the number of corners.
    starts: Vec<u32>,
    face: Vec<u32>,
    /// The half-edge that each corner became.
    half_edge: Vec<u32>,
}

/// An edge at a corner: lower vertex, higher vertex, corner.
type Edge = (u32, u32, u32);

impl Corners {
    fn new(soup: &PolygonSoup, repairs: &mut Repairs) -> Result<Self, Error> {
        if let Some(i) = soup.positions.iter().position(|p| !p.is_finite()) {
            return fail(format!("vertex {i} (from 0) is not at a finite place"));
        }
        let mut corners = Self {
            vertex: Vec::new(),
            starts: vec![0],
            face: Vec::new(),
            half_edge: Vec::new(),
        };
        let mut sorted = Vec::new();
        for (i, face) in soup.faces().enumerate() {
            if let Some(v) = face.iter().find(|v| **v as usize >= soup.positions.len()) {
                return fail(format!(
                    "face {i} (from 0) has vertex {v} (from 0) of {}",
                    soup.positions.len()
                ));
            }
            sorted.clear();
            sorted.extend_from_slice(face);
            sorted.sort_unstable();
            if face.len() < 3 || sorted.windows(2).any(|pair| pair[0] == pair[1]) {
                repairs.dropped_faces += 1;
                continue;
            }
            // Twins on a boundary can double the number of half-edges.
            if 2 * (corners.vertex.len() + face.len()) > MAX_HALF_EDGES {
                return fail(format!(
                    "the mesh has more than {MAX_HALF_EDGES} half-edges; simplify it first"
                ));
            }
            let number = corners.starts.len() as u32 - 1;
            corners.vertex.extend_from_slice(face);
            corners.face.resize(corners.vertex.len(), number);
            corners.starts.push(corners.vertex.len() as u32);
        }
        Ok(corners)
    }

    fn range(&self, corner: u32) -> [u32; 2] {
        let face = self.face[corner as usize] as usize;
        [self.starts[face], self.starts[face + 1]]
    }

    fn next(&self, corner: u32) -> u32 {
        let [start, end] = self.range(corner);
        if corner + 1 == end { start } else { corner + 1 }
    }

    fn previous(&self, corner: u32) -> u32 {
        let [start, end] = self.range(corner);
        if corner == start { end - 1 } else { corner - 1 }
    }

    /// Returns all edges, sorted, so that edges between the same vertices are neighbours.
    fn edges(&self) -> Vec<Edge> {
        let mut edges: Vec<Edge> = (0..self.vertex.len() as u32)
            .map(|c| {
                let [a, b] = [c, self.next(c)].map(|c| self.vertex[c as usize]);
                (a.min(b), a.max(b), c)
            })
            .collect();
        edges.sort_unstable();
        edges
    }

    fn is_forward(&self, edge: &Edge) -> bool {
        self.vertex[edge.2 as usize] == edge.0
    }

    /// Turns faces over so that neighbours agree where they can, and returns how many.
    fn orient(&mut self, edges: &[Edge]) -> usize {
        const BOUNDARY: (u32, bool) = (NONE, false);
        // Across each corner's edge: the other face, and whether it has the same direction.
        let mut across = vec![BOUNDARY; self.vertex.len()];
        let mut is_consistent = true;
        for group in same_vertices(edges) {
            if let [a, b] = group {
                let disagree = self.is_forward(a) == self.is_forward(b);
                is_consistent &= !disagree;
                across[a.2 as usize] = (self.face[b.2 as usize], disagree);
                across[b.2 as usize] = (self.face[a.2 as usize], disagree);
            }
        }
        if is_consistent {
            return 0;
        }
        let count = self.starts.len() - 1;
        let mut flip = vec![None; count];
        let mut component = Vec::new();
        for seed in 0..count {
            if flip[seed].is_some() {
                continue;
            }
            flip[seed] = Some(false);
            component.clear();
            component.push(seed as u32);
            let mut done = 0;
            while done < component.len() {
                let face = component[done] as usize;
                done += 1;
                let own = flip[face] == Some(true);
                for corner in self.starts[face]..self.starts[face + 1] {
                    let (other, disagree) = across[corner as usize];
                    if other != NONE && flip[other as usize].is_none() {
                        flip[other as usize] = Some(own != disagree);
                        component.push(other);
                    }
                }
            }
            let turned = component
                .iter()
                .filter(|f| flip[**f as usize] == Some(true));
            if 2 * turned.count() > component.len() {
                for face in &component {
                    flip[*face as usize] = flip[*face as usize].map(|turned| !turned);
                }
            }
        }
        let turned: Vec<usize> = (0..count).filter(|f| flip[*f] == Some(true)).collect();
        for face in &turned {
            let [start, end] = [self.starts[*face], self.starts[face + 1]].map(|i| i as usize);
            self.vertex[start..end].reverse();
        }
        turned.len()
    }

    /// The corner in the opposite direction across each corner's edge, or `NONE`.
    fn pair(&self, edges: &[Edge], repairs: &mut Repairs) -> Vec<u32> {
        let mut partner = vec![NONE; self.vertex.len()];
        for group in same_vertices(edges) {
            // In the order of faces, so that bodies which touch along an edge stay whole.
            let forward = group.iter().filter(|edge| self.is_forward(edge));
            let backward = group.iter().filter(|edge| !self.is_forward(edge));
            let mut pairs = 0;
            for (a, b) in forward.zip(backward) {
                partner[a.2 as usize] = b.2;
                partner[b.2 as usize] = a.2;
                pairs += 1;
            }
            if group.len() > 2 || (group.len() == 2 && pairs == 0) {
                repairs.split_edges += 1;
            }
        }
        partner
    }

    /// Numbers vertices anew, one for each fan of corners, and returns which one each was.
    fn separate_vertices(
        &mut self,
        partner: &[u32],
        count: usize,
        repairs: &mut Repairs,
    ) -> Vec<u32> {
        let mut fan: Vec<u32> = (0..self.vertex.len() as u32).collect();
        for (c, d) in (0..).zip(partner).filter(|(c, d)| **d != NONE && *c < **d) {
            for (a, b) in [(c, self.next(*d)), (self.next(c), *d)] {
                let (a, b) = (root(&mut fan, a), root(&mut fan, b));
                fan[a.max(b) as usize] = a.min(b);
            }
        }
        // The first fan of each vertex keeps its place, so that a manifold keeps its order.
        let mut first_fan = vec![NONE; count];
        for c in 0..fan.len() as u32 {
            let first = &mut first_fan[self.vertex[c as usize] as usize];
            if *first == NONE {
                *first = root(&mut fan, c);
            }
        }
        let mut number = vec![NONE; fan.len()];
        let mut sources = Vec::new();
        for (v, first) in (0..).zip(&first_fan).filter(|(_, first)| **first != NONE) {
            number[*first as usize] = sources.len() as u32;
            sources.push(v);
        }
        for c in 0..fan.len() as u32 {
            let fan = root(&mut fan, c) as usize;
            if number[fan] == NONE {
                number[fan] = sources.len() as u32;
                sources.push(self.vertex[c as usize]);
                repairs.split_vertices += 1;
            }
        }
        for c in 0..fan.len() as u32 {
            self.vertex[c as usize] = number[root(&mut fan, c) as usize];
        }
        sources
    }

    /// Returns a corner of every edge between vertices that an earlier edge joins.
    fn double_edges(&self, partner: &[u32]) -> Vec<usize> {
        let mut edges = self.edges();
        edges.retain(|(_, _, c)| partner[*c as usize] == NONE || *c < partner[*c as usize]);
        same_vertices(&edges)
            .flat_map(|group| &group[1..])
            .map(|edge| edge.2 as usize)
            .collect()
    }

    /// Makes pairs of half-edges and links them.
    fn connect(&mut self, partner: &[u32]) -> HalfEdgeMesh {
        let mut mesh = HalfEdgeMesh {
            face_first: vec![NONE; self.starts.len() - 1],
            ..HalfEdgeMesh::default()
        };
        let count = self.vertex.iter().max().map_or(0, |v| *v as usize + 1);
        mesh.outgoing = vec![NONE; count];
        self.half_edge = vec![NONE; self.vertex.len()];
        for c in 0..self.vertex.len() as u32 {
            if self.half_edge[c as usize] == NONE {
                let [from, to] = [c, self.next(c)].map(|c| self.vertex[c as usize]);
                let h = mesh.new_edge(from, to);
                self.half_edge[c as usize] = h;
                if let Some(other) = self.half_edge.get_mut(partner[c as usize] as usize) {
                    *other = h ^ 1;
                }
            }
        }
        for c in 0..self.vertex.len() as u32 {
            let [h, next] = [c, self.next(c)].map(|c| self.half_edge[c as usize]);
            mesh.link(h, next);
            let face = self.face[c as usize];
            mesh.face[h as usize] = face;
            if mesh.face_first[face as usize] == NONE {
                mesh.face_first[face as usize] = h;
            }
            mesh.outgoing[self.vertex[c as usize] as usize] = h;
        }
        // Beyond the twin of a boundary half-edge, turn about its target until the boundary comes.
        for c in 0..self.vertex.len() as u32 {
            if partner[c as usize] != NONE {
                continue;
            }
            let bare = self.half_edge[c as usize] ^ 1;
            let mut arriving = self.previous(c);
            while partner[arriving as usize] != NONE {
                arriving = self.previous(partner[arriving as usize]);
            }
            let after = self.half_edge[arriving as usize] ^ 1;
            mesh.link(bare, after);
            mesh.outgoing[self.vertex[c as usize] as usize] = after;
        }
        mesh
    }
}

/// The runs of edges of the same vertices.
fn same_vertices(edges: &[Edge]) -> impl Iterator<Item = &[Edge]> {
    edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
}

/// The representative of a set, and a shorter way to it.
fn root(parents: &mut [u32], mut i: u32) -> u32 {
    while parents[i as usize] != i {
        parents[i as usize] = parents[parents[i as usize] as usize];
        i = parents[i as usize];
    }
    i
}
