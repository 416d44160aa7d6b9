//! The order in which recorded expressions are computed: each outside the loops in whose steps it
//! is the same, and only in those branches that need it.
//!
//! Blocks form a tree; the whole function is block 0. An expression must be computed in a block
//! that holds all its uses. Among those it goes to one in the fewest loops, and among these to the
//! innermost (Click 1995, "Global code motion").
use crate::tape::{Expression, Loop, Place, Tape};
use std::collections::HashMap;

/// A block of code.
#[derive(Clone, Debug)]
struct Block {
    parent: usize,
    depth: usize,
    /// Number of loops around it.
    loops: usize,
}

/// The blocks, and what is computed in each.
#[derive(Debug)]
pub struct Order {
    blocks: Vec<Block>,
    /// The block of each loop's steps.
    of_loops: HashMap<Loop, usize>,
    /// The blocks of the arms of each branch, and of the steps of each sum.
    inner: HashMap<Place, Vec<usize>>,
    /// The expressions of each block, in order.
    pub places: Vec<Vec<Place>>,
    /// The block of each expression that is needed.
    pub block_of: HashMap<Place, usize>,
    /// Number of uses of each expression.
    pub uses: HashMap<Place, usize>,
}

impl Order {
    /// Orders what results need.
    pub fn new(tape: &Tape, results: &[Place]) -> Self {
        let mut order = Self {
            blocks: vec![Block {
                parent: 0,
                depth: 0,
                loops: 0,
            }],
            of_loops: HashMap::new(),
            inner: HashMap::new(),
            places: vec![Vec::new()],
            block_of: HashMap::new(),
            uses: HashMap::new(),
        };
        // The innermost block that holds the uses seen so far.
        let mut common = HashMap::new();
        for place in results {
            order.meet(&mut common, *place, 0);
        }
        // Uses stand after what they use.
        for place in (0..tape.len() as Place).rev() {
            let Some(uses_in) = common.get(&place).copied() else {
                continue;
            };
            let block = order.best(uses_in, tape.loops(place));
            order.block_of.insert(place, block);
            order.places[block].push(place);
            match tape.at(place) {
                Expression::Sum { of, terms, .. } => {
                    let steps = order.open(block, true);
                    order.of_loops.insert(*of, steps);
                    order.inner.insert(place, vec![steps]);
                    for term in terms.iter() {
                        order.meet(&mut common, *term, steps);
                    }
                }
                Expression::Branch { on, arms } => {
                    order.arms(&mut common, place, *on, arms);
                }
                Expression::Switch { on, arms } => {
                    order.arms(&mut common, place, *on, arms);
                }
                other => {
                    for operand in other.operands() {
                        order.meet(&mut common, operand, block);
                    }
                }
            }
        }
        for places in &mut order.places {
            places.reverse();
        }
        order
    }

    /// Returns the blocks of a branch's arms, or of a sum's steps.
    pub fn inner(&self, place: Place) -> &[usize] {
        &self.inner[&place]
    }

    fn arms(
        &mut self,
        common: &mut HashMap<Place, usize>,
        place: Place,
        on: Place,
        arms: &[std::rc::Rc<[Place]>],
    ) {
        let block = self.block_of[&place];
        self.meet(common, on, block);
        let blocks = arms.iter().map(|arm| {
            let inner = self.open(block, false);
            for result in arm.iter() {
                self.meet(common, *result, inner);
            }
            inner
        });
        let blocks = blocks.collect();
        self.inner.insert(place, blocks);
    }

    fn open(&mut self, parent: usize, is_loop: bool) -> usize {
        let Block { depth, loops, .. } = self.blocks[parent];
        self.blocks.push(Block {
            parent,
            depth: depth + 1,
            loops: loops + usize::from(is_loop),
        });
        self.places.push(Vec::new());
        self.blocks.len() - 1
    }

    /// Notes a use in a block.
    fn meet(&mut self, common: &mut HashMap<Place, usize>, place: Place, block: usize) {
        *self.uses.entry(place).or_insert(0) += 1;
        let met = common.get(&place).map_or(block, |other| {
            let (mut a, mut b) = (*other, block);
            while a != b {
                if self.blocks[a].depth >= self.blocks[b].depth {
                    a = self.blocks[a].parent;
                } else {
                    b = self.blocks[b].parent;
                }
            }
            a
        });
        common.insert(place, met);
    }

    /// Returns the best block for an expression that is used in a block and differs from step to
    /// step of some loops.
    fn best(&self, uses_in: usize, loops: &[Loop]) -> usize {
        let outermost = (loops.iter())
            .map(|of| self.of_loops[of])
            .max_by_key(|block| self.blocks[*block].depth)
            .unwrap_or(0);
        let (mut best, mut block) = (uses_in, uses_in);
        while block != outermost {
            block = self.blocks[block].parent;
            if self.blocks[block].loops < self.blocks[best].loops {
                best = block;
            }
        }
        best
    }
}
