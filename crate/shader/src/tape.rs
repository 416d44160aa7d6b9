//! The list of expressions that a recording makes.
//!
//! An expression is a place in the list; those it is made of stand before it. Equal expressions are
//! the same place, so common subexpressions are found as they are recorded.
use crate::layout::Source;
use std::collections::HashMap;
use std::rc::Rc;

/// A place in the list.
pub type Place = u32;

/// A loop, by a number of its own.
pub type Loop = u32;

/// An operation on one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum One {
    Negate,
    Root,
    Size,
    Floor,
}

/// An operation on two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Two {
    Add,
    Subtract,
    Multiply,
    Divide,
    Min,
    Max,
    /// Whether the first is less than the second.
    Less,
    /// Whether both conditions hold.
    Both,
}

/// An expression.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Expression {
    /// A number, by its bits.
    Number(u32),
    /// A condition that is known.
    Truth(bool),
    /// A coordinate of the position.
    Coordinate(u8),
    /// A constant of the element.
    Constant(Source, u32),
    /// A constant of the element in a loop over records: at `first`, `first + stride`, …
    Record {
        of: Loop,
        first: u32,
        stride: u32,
        count: u32,
    },
    /// A number that differs from step to step of a loop.
    Table {
        of: Loop,
        numbers: Rc<[u32]>,
    },
    One(One, Place),
    Two(Two, [Place; 2]),
    /// The condition, and the numbers where it holds and where it does not.
    Select([Place; 3]),
    /// A function of `math.wgsl`.
    Call(&'static str, Rc<[Place]>),
    /// A number of those that an expression yields.
    Part(Place, u32),
    /// Sums over a loop.
    Sum {
        of: Loop,
        count: u32,
        terms: Rc<[Place]>,
    },
    /// Numbers that are computed only where a condition holds, and others where it does not.
    Branch {
        on: Place,
        arms: [Rc<[Place]>; 2],
    },
    /// Numbers computed in one of several ways, chosen by a constant.
    Switch {
        on: Place,
        arms: Rc<[Rc<[Place]>]>,
    },
}

use Expression as E;

impl Expression {
    /// Returns the expressions that this one is made of.
    pub fn operands(&self) -> Vec<Place> {
        match self {
            E::Number(_)
            | E::Truth(_)
            | E::Coordinate(_)
            | E::Constant(..)
            | E::Record { .. }
            | E::Table { .. } => Vec::new(),
            E::One(_, a) | E::Part(a, _) => vec![*a],
            E::Two(_, all) => all.to_vec(),
            E::Select(all) => all.to_vec(),
            E::Call(_, all) | E::Sum { terms: all, .. } => all.to_vec(),
            E::Branch { on, arms } => {
                let arms = arms.iter().flat_map(|arm| arm.iter());
                [on].into_iter().chain(arms).copied().collect()
            }
            E::Switch { on, arms } => {
                let arms = arms.iter().flat_map(|arm| arm.iter());
                [on].into_iter().chain(arms).copied().collect()
            }
        }
    }

    /// Returns the same expression of other operands.
    fn with(&self, operands: &[Place]) -> Self {
        match (self.clone(), operands) {
            (E::One(operation, _), [a]) => E::One(operation, *a),
            (E::Part(_, i), [a]) => E::Part(*a, i),
            (E::Two(operation, _), [a, b]) => E::Two(operation, [*a, *b]),
            (E::Select(_), [on, yes, no]) => E::Select([*on, *yes, *no]),
            (E::Call(name, _), all) => E::Call(name, all.into()),
            (E::Sum { of, count, .. }, all) => E::Sum {
                of,
                count,
                terms: all.into(),
            },
            (E::Branch { arms: [yes, _], .. }, [on, all @ ..]) => {
                let (yes, no) = all.split_at(yes.len());
                E::Branch {
                    on: *on,
                    arms: [yes.into(), no.into()],
                }
            }
            (E::Switch { arms, .. }, [on, all @ ..]) => E::Switch {
                on: *on,
                // All arms yield as many numbers.
                arms: all.chunks(all.len() / arms.len()).map(Rc::from).collect(),
            },
            (leaf, _) => leaf,
        }
    }

    /// Returns the same expression as one of another loop.
    fn with_loop(&self, of: Loop) -> Self {
        let mut other = self.clone();
        match &mut other {
            E::Record { of: own, .. } | E::Table { of: own, .. } | E::Sum { of: own, .. } => {
                *own = of;
            }
            _ => {}
        }
        other
    }
}

/// Returns a number as an expression.
fn literal(number: f32) -> Expression {
    E::Number(number.to_bits())
}

/// The list.
#[derive(Debug, Default)]
pub struct Tape {
    expressions: Vec<Expression>,
    places: HashMap<Expression, Place>,
    /// The loops within whose steps an expression differs, in order.
    loops: Vec<Rc<[Loop]>>,
    /// Number of loops so far.
    made: Loop,
}

impl Tape {
    /// Returns an expression.
    pub fn at(&self, place: Place) -> &Expression {
        &self.expressions[place as usize]
    }

    /// Returns the number of expressions.
    pub fn len(&self) -> usize {
        self.expressions.len()
    }

    /// Returns the loops within whose steps an expression differs.
    pub fn loops(&self, place: Place) -> &[Loop] {
        &self.loops[place as usize]
    }

    /// Returns the number of a new loop.
    pub fn new_loop(&mut self) -> Loop {
        self.made += 1;
        self.made
    }

    fn number(&self, place: Place) -> Option<f32> {
        match self.at(place) {
            E::Number(bits) => Some(f32::from_bits(*bits)),
            _ => None,
        }
    }

    /// Appends an expression, or finds it, or one that is simpler.
    pub fn push(&mut self, expression: Expression) -> Place {
        let expression = match self.simplify(expression) {
            Ok(place) => return place,
            Err(expression) => expression,
        };
        if let Some(place) = self.places.get(&expression) {
            return *place;
        }
        let mut loops: Vec<Loop> = (expression.operands().iter())
            .flat_map(|place| self.loops(*place))
            .copied()
            .collect();
        match expression {
            E::Record { of, .. } | E::Table { of, .. } => loops.push(of),
            E::Sum { of, .. } => loops.retain(|other| *other != of),
            _ => {}
        }
        loops.sort_unstable();
        loops.dedup();
        let place = self.expressions.len() as Place;
        self.expressions.push(expression.clone());
        self.places.insert(expression, place);
        self.loops.push(loops.into());
        place
    }

    /// Returns the place of an equal expression that is simpler, or the expression in its usual
    /// order.
    fn simplify(&mut self, expression: Expression) -> Result<Place, Expression> {
        match expression {
            E::One(operation, a) => {
                if let (One::Negate, E::One(One::Negate, inner)) = (operation, self.at(a)) {
                    return Ok(*inner);
                }
                let Some(x) = self.number(a) else {
                    return Err(expression);
                };
                Err(literal(match operation {
                    One::Negate => -x,
                    One::Root => x.sqrt(),
                    One::Size => x.abs(),
                    One::Floor => x.floor(),
                }))
            }
            E::Two(Two::Both, [a, b]) => match (self.at(a), self.at(b)) {
                (E::Truth(true), _) => Ok(b),
                (_, E::Truth(true)) => Ok(a),
                (E::Truth(false), _) | (_, E::Truth(false)) => Err(E::Truth(false)),
                _ => Err(expression),
            },
            E::Two(operation, [a, b]) => {
                let (x, y) = (self.number(a), self.number(b));
                if let (Some(x), Some(y)) = (x, y) {
                    return Err(match operation {
                        Two::Add => literal(x + y),
                        Two::Subtract => literal(x - y),
                        Two::Multiply => literal(x * y),
                        Two::Divide => literal(x / y),
                        Two::Min => literal(x.min(y)),
                        Two::Max => literal(x.max(y)),
                        Two::Less => E::Truth(x < y),
                        Two::Both => E::Truth(false),
                    });
                }
                match (operation, x, y) {
                    (Two::Add, Some(0.0), _) | (Two::Multiply, Some(1.0), _) => Ok(b),
                    (Two::Add | Two::Subtract, _, Some(0.0))
                    | (Two::Multiply | Two::Divide, _, Some(1.0)) => Ok(a),
                    (Two::Add | Two::Multiply, ..) => {
                        match self.places.get(&E::Two(operation, [b, a])) {
                            Some(place) => Ok(*place),
                            None => Err(expression),
                        }
                    }
                    _ => Err(expression),
                }
            }
            E::Select([on, yes, no]) => match self.at(on) {
                E::Truth(true) => Ok(yes),
                E::Truth(false) => Ok(no),
                _ if yes == no => Ok(yes),
                _ => Err(expression),
            },
            _ => Err(expression),
        }
    }

    /// Returns the expression of a step of a loop, given those of all its steps: where they differ,
    /// it has records of constants, or tables of numbers.
    ///
    /// # Panics
    /// If the steps are not alike.
    pub fn step(&mut self, of: Loop, steps: &[Place], memory: &mut Memory) -> Place {
        let first = steps[0];
        if steps.iter().all(|step| *step == first) {
            return first;
        }
        if let Some(place) = memory.places.get(steps) {
            return *place;
        }
        let all: Vec<Expression> = steps.iter().map(|step| self.at(*step).clone()).collect();
        let unified = match &all[0] {
            E::Number(_) => {
                let numbers = all.iter().map(|e| match e {
                    E::Number(bits) => *bits,
                    other => panic!("steps of a loop differ: a number and {other:?}"),
                });
                E::Table {
                    of,
                    numbers: numbers.collect(),
                }
            }
            E::Constant(Source::Bone, start) => {
                let places: Vec<u32> = (all.iter())
                    .map(|e| match e {
                        E::Constant(Source::Bone, place) => *place,
                        other => panic!("steps of a loop differ: a constant and {other:?}"),
                    })
                    .collect();
                let stride = places[1] - start;
                let even = places.windows(2).all(|pair| pair[1] == pair[0] + stride);
                assert!(even, "records are not evenly spaced: {places:?}");
                E::Record {
                    of,
                    first: *start,
                    stride,
                    count: places.len() as u32,
                }
            }
            E::Record { .. } | E::Table { .. } => {
                let inner: Vec<Loop> = all.iter().map(inner_loop).collect();
                let inner = *memory.loops.get(&inner).expect("a loop within the loop");
                let unified = all[0].with_loop(inner);
                let alike = all.iter().all(|e| e.with_loop(inner) == unified);
                assert!(alike, "loops in the steps of a loop differ: {all:?}");
                unified
            }
            model => {
                let mut inner = 0;
                if let E::Sum { .. } = model {
                    inner = self.new_loop();
                    (memory.loops).insert(all.iter().map(inner_loop).collect(), inner);
                }
                let operands: Vec<Vec<Place>> = all.iter().map(Expression::operands).collect();
                let zeros = vec![0; operands[0].len()];
                let shape = model.with(&zeros).with_loop(0);
                let alike = (all.iter().zip(&operands)).all(|(e, own)| {
                    own.len() == zeros.len() && e.with(&zeros).with_loop(0) == shape
                });
                assert!(alike, "steps of a loop differ: {all:?}");
                let unified: Vec<Place> = (0..zeros.len())
                    .map(|i| {
                        let steps: Vec<Place> = operands.iter().map(|own| own[i]).collect();
                        self.step(of, &steps, memory)
                    })
                    .collect();
                model.with(&unified).with_loop(inner)
            }
        };
        let place = self.push(unified);
        memory.places.insert(steps.to_vec(), place);
        place
    }
}

/// Steps that have been made one.
#[derive(Debug, Default)]
pub struct Memory {
    places: HashMap<Vec<Place>, Place>,
    loops: HashMap<Vec<Loop>, Loop>,
}

fn inner_loop(expression: &Expression) -> Loop {
    match expression {
        E::Record { of, .. } | E::Table { of, .. } | E::Sum { of, .. } => *of,
        other => panic!("steps of a loop differ: a loop and {other:?}"),
    }
}
