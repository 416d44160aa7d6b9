//! Search among vertices: a hashed grid that is kept up to date vertex by vertex.

use glam::DVec3;
use mesh::Aabb;

const NONE: u32 = u32::MAX;
/// Edge lengths that a cell is wide.
const WIDTH: f64 = 4.0;

/// Vertices by the cells of a grid of cubes. Cells share buckets, so that any extent takes the same
/// space; what is found is tested anyway.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    width: f64,
    /// The first vertex in each bucket; their number is a power of two.
    heads: Vec<u32>,
    /// The next and the previous vertex in the bucket of each vertex.
    next: Vec<u32>,
    previous: Vec<u32>,
    /// The bucket of each vertex, or `NONE`.
    bucket: Vec<u32>,
    /// Number of vertices.
    count: usize,
}

impl Grid {
    /// Returns a grid for vertices of some slots and edges of a mean length.
    pub fn new(slots: usize, mean_edge: f64) -> Self {
        let width = WIDTH * mean_edge;
        let buckets = (slots / 4).next_power_of_two().max(16);
        Self {
            width: if width.is_normal() { width } else { 1.0 },
            heads: vec![NONE; buckets],
            next: vec![NONE; slots],
            previous: vec![NONE; slots],
            bucket: vec![NONE; slots],
            count: 0,
        }
    }

    fn cell(&self, x: f64) -> i64 {
        // Saturates where a coordinate is very far in widths.
        (x / self.width).floor() as i64
    }

    fn bucket_of(&self, cell: [i64; 3]) -> u32 {
        const FACTORS: [u64; 3] = [
            0x9E37_79B9_7F4A_7C15,
            0xC2B2_AE3D_27D4_EB4F,
            0x1656_67B1_9E37_79F9,
        ];
        let parts = cell.iter().zip(FACTORS);
        let mixed = parts.fold(0_u64, |sum, (c, f)| {
            (sum ^ (*c as u64)).wrapping_mul(f).rotate_left(29)
        });
        (mixed ^ (mixed >> 32)) as u32 & (self.heads.len() as u32 - 1)
    }

    fn bucket_at(&self, p: DVec3) -> u32 {
        self.bucket_of(p.to_array().map(|x| self.cell(x)))
    }

    /// Enters a vertex, or moves it.
    pub fn set(&mut self, v: u32, position: DVec3) {
        let bucket = self.bucket_at(position);
        let at = v as usize;
        if self.bucket[at] == bucket {
            return;
        }
        if self.bucket[at] == NONE {
            self.count += 1;
        } else {
            self.unlink(v);
        }
        let head = self.heads[bucket as usize];
        self.next[at] = head;
        self.previous[at] = NONE;
        if head != NONE {
            self.previous[head as usize] = v;
        }
        self.heads[bucket as usize] = v;
        self.bucket[at] = bucket;
    }

    fn unlink(&mut self, v: u32) {
        let at = v as usize;
        let (next, previous) = (self.next[at], self.previous[at]);
        if previous == NONE {
            self.heads[self.bucket[at] as usize] = next;
        } else {
            self.next[previous as usize] = next;
        }
        if next != NONE {
            self.previous[next as usize] = previous;
        }
    }

    /// Vertices that may be in a box, in ascending order, and more: all of the cells that the box
    /// touches.
    pub fn near(&self, bounds: &Aabb, out: &mut Vec<u32>) {
        out.clear();
        let low = bounds.min.to_array().map(|x| self.cell(x));
        let high = bounds.max.to_array().map(|x| self.cell(x));
        let sides = [0, 1, 2].map(|i| (high[i].saturating_sub(low[i])) as f64 + 1.0);
        if sides[0] * sides[1] * sides[2] > self.heads.len() as f64 {
            let entered = self.bucket.iter().zip(0..).filter(|(b, _)| **b != NONE);
            out.extend(entered.map(|(_, v)| v));
            return;
        }
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let mut v = self.heads[self.bucket_of([x, y, z]) as usize];
                    while v != NONE {
                        out.push(v);
                        v = self.next[v as usize];
                    }
                }
            }
        }
        out.sort_unstable();
        out.dedup();
    }
}
