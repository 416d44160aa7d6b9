//! A balanced forest of octrees: a box cut into cells, of which neighbours across faces and edges
//! differ by one level at most.

use glam::DVec3;
use mesh::Aabb;

/// No node, no part.
pub const NONE: u32 = u32::MAX;

/// Bits of a coordinate: cells, corners and centres have whole coordinates below 2²⁰ along each
/// axis.
const BITS: u32 = 20;

/// Position of a cell against the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Not yet looked at.
    Unknown,
    /// The function is below the threshold in all of the cell.
    Outside,
    /// Above.
    Inside,
    /// The surface may cross the cell.
    Crossing,
}

/// Bounds on the function in a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Largest difference between the gradient and its linear interpolant in a tetrahedron of the
    /// cell.
    pub rest: f64,
    /// Largest difference between the function and its linear interpolant there.
    pub off: f64,
    /// Largest distance between the level set of that interpolant and the surface in the cell;
    /// infinite if unknown.
    pub error: f64,
    /// Whether smaller cells would prove no more: the gradient may jump by as much as its length.
    pub is_stuck: bool,
}

impl Bounds {
    /// No bounds.
    pub const NONE: Self = Self {
        rest: f64::INFINITY,
        off: f64::INFINITY,
        error: f64::INFINITY,
        is_stuck: false,
    };
}

/// A cell.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// The first of eight children, or [`NONE`] for a leaf.
    pub child: u32,
    /// Level; 0 for roots.
    pub level: u32,
    /// Whole coordinates, in cells of its level.
    pub at: [u32; 3],
    /// Index of the part of the function that serves here, or [`NONE`] for the whole.
    pub part: u32,
    /// Position.
    pub side: Side,
    /// Whether `bounds` were computed.
    pub has_bounds: bool,
    /// Whether a closer look has proved that there is no surface in the cell.
    pub is_empty: bool,
    /// Whether the surface's topology could not be proved in the cell.
    pub undecided: bool,
    /// Bounds.
    pub bounds: Bounds,
    /// Bound on the second derivative where nothing hides between samples any more, in this cell or
    /// one that it was a part of; infinite elsewhere.
    pub bend: f64,
    /// Bounds on the jumps of the gradient and of the value there.
    pub jumps: [f64; 2],
}

/// Cells of a box.
#[derive(Debug)]
pub struct Forest {
    low: DVec3,
    high: DVec3,
    /// Size of a root cell.
    root: DVec3,
    /// Root cells along each axis.
    pub counts: [u32; 3],
    /// The deepest level that cells are refined to where nothing else calls for more.
    pub usual: u32,
    /// The deepest level that is allowed.
    pub deepest: u32,
    /// All cells, parents before children.
    pub cells: Vec<Cell>,
}

impl Forest {
    /// Divides a box into root cells that are nearly cubes, not smaller than a twentieth of its
    /// longest side. The usual level is the first with cells of `finest` or less, and so many
    /// levels below it are allowed, both as far as coordinates reach.
    pub fn new(bounds: &Aabb, finest: f64, levels: u32) -> Self {
        let size = bounds.max - bounds.min;
        let longest = size.max_element();
        let step = size.min_element().max(0.05 * longest);
        let counts = size.to_array().map(|s| (s / step).round().max(1.0) as u32);
        let root = size / DVec3::from_array(counts.map(f64::from));
        let most = BITS
            - 1
            - counts
                .iter()
                .max()
                .map_or(0, |n| n.next_power_of_two().ilog2());
        let mut usual = 0;
        while usual < most && root.max_element() * scale(usual) > finest {
            usual += 1;
        }
        let mut forest = Self {
            low: bounds.min,
            high: bounds.max,
            root,
            counts,
            usual,
            deepest: (usual + levels).min(most),
            cells: Vec::new(),
        };
        for z in 0..counts[2] {
            for y in 0..counts[1] {
                for x in 0..counts[0] {
                    forest.cells.push(Cell {
                        child: NONE,
                        level: 0,
                        at: [x, y, z],
                        part: NONE,
                        side: Side::Unknown,
                        has_bounds: false,
                        is_empty: false,
                        undecided: false,
                        bounds: Bounds::NONE,
                        bend: f64::INFINITY,
                        jumps: [0.0; 2],
                    });
                }
            }
        }
        forest
    }

    /// Edge lengths of cells of a level.
    pub fn size(&self, level: u32) -> DVec3 {
        self.root * scale(level)
    }

    /// Centre of a cell.
    pub fn center(&self, cell: &Cell) -> DVec3 {
        self.position(self.center_key(cell))
    }

    /// Number of whole coordinates along an edge of a cell of a level: even.
    pub fn span(&self, level: u32) -> u32 {
        2 << (self.deepest - level)
    }

    /// Whole coordinates of the lowest corner of a cell.
    pub fn corner(&self, cell: &Cell) -> [u32; 3] {
        cell.at.map(|x| x * self.span(cell.level))
    }

    /// The centre's whole coordinates.
    pub fn center_key(&self, cell: &Cell) -> [u32; 3] {
        let half = self.span(cell.level) / 2;
        self.corner(cell).map(|x| x + half)
    }

    /// Position of whole coordinates.
    pub fn position(&self, key: [u32; 3]) -> DVec3 {
        let unit = self.root * (0.5 * scale(self.deepest));
        let position = self.low + DVec3::from_array(key.map(f64::from)) * unit;
        let last = [0, 1, 2].map(|i| key[i] == self.counts[i] * self.span(0));
        // Exact on the boundary.
        DVec3::select(glam::BVec3::from_array(last), self.high, position)
    }

    /// The cell at a level and place, or the leaf that contains it; `None` outside the box.
    pub fn find(&self, level: u32, at: [i64; 3]) -> Option<u32> {
        let mut root = [0; 3];
        for i in 0..3 {
            let own = at[i] >> level;
            if at[i] < 0 || own >= i64::from(self.counts[i]) {
                return None;
            }
            root[i] = own as u32;
        }
        let mut node = (root[2] * self.counts[1] + root[1]) * self.counts[0] + root[0];
        loop {
            let cell = &self.cells[node as usize];
            if cell.child == NONE || cell.level == level {
                return Some(node);
            }
            let bit = |i: usize| ((at[i] >> (level - cell.level - 1)) & 1) as u32;
            node = cell.child + bit(0) + 2 * bit(1) + 4 * bit(2);
        }
    }

    /// The neighbour of a cell of the same level in a direction, or the leaf that contains its
    /// place; `None` outside the box.
    pub fn neighbor(&self, cell: &Cell, direction: [i64; 3]) -> Option<u32> {
        let at = [0, 1, 2].map(|i| i64::from(cell.at[i]) + direction[i]);
        self.find(cell.level, at)
    }

    /// Whether a position is in the box.
    pub fn contains(&self, position: DVec3) -> bool {
        position.cmpge(self.low).all() && position.cmple(self.high).all()
    }

    /// The leaf at a position; the nearest one outside the box.
    pub fn leaf_at(&self, position: DVec3) -> u32 {
        let unit = (position - self.low) / self.size(self.deepest);
        let most = self.counts.map(|n| i64::from(n << self.deepest) - 1);
        let at = [unit.x, unit.y, unit.z].map(|x| x.floor() as i64);
        let at = [0, 1, 2].map(|i| at[i].clamp(0, most[i]));
        self.find(self.deepest, at).unwrap_or(0)
    }

    /// Splits a leaf, and first all neighbours that would differ by two levels.
    pub fn split(&mut self, node: u32) {
        let mut open = vec![node];
        while let Some(&node) = open.last() {
            let cell = self.cells[node as usize];
            if cell.child != NONE {
                open.pop();
                continue;
            }
            let before = open.len();
            for direction in AROUND {
                if let Some(i) = self.neighbor(&cell, direction)
                    && self.cells[i as usize].level < cell.level
                {
                    open.push(i);
                }
            }
            if open.len() == before {
                open.pop();
                self.divide(node);
            }
        }
    }

    /// Splits a leaf without a look at its neighbours, and returns the first child.
    pub fn divide(&mut self, node: u32) -> u32 {
        let first = self.cells.len() as u32;
        let cell = &mut self.cells[node as usize];
        cell.child = first;
        let parent = *cell;
        for i in 0..8 {
            let bits = [i & 1, (i >> 1) & 1, i >> 2];
            self.cells.push(Cell {
                child: NONE,
                level: parent.level + 1,
                at: [0, 1, 2].map(|k| 2 * parent.at[k] + bits[k]),
                has_bounds: false,
                is_empty: parent.is_empty,
                undecided: false,
                bounds: Bounds::NONE,
                // Children of a cell without the surface have none of it either.
                side: if parent.side == Side::Crossing {
                    Side::Unknown
                } else {
                    parent.side
                },
                part: parent.part,
                bend: parent.bend,
                jumps: parent.jumps,
            });
        }
        first
    }
}

/// 2^−level.
fn scale(level: u32) -> f64 {
    1.0 / f64::from(1_u32 << level)
}

/// Directions across the 6 faces and 12 edges of a cell.
const AROUND: [[i64; 3]; 18] = {
    let mut all = [[0; 3]; 18];
    let (mut i, mut n) = (0, 0);
    while i < 27 {
        let d = [i % 3 - 1, (i / 3) % 3 - 1, i / 9 - 1];
        let length = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        if length == 1 || length == 2 {
            all[n] = d;
            n += 1;
        }
        i += 1;
    }
    all
};
