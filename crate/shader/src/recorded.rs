//! A number that records: every operation on it appends an expression to the thread's list.
use crate::layout::Source;
use crate::tape::{Expression, Memory, One, Place, Tape, Two};
use core::ops::{Add, Div, Mul, Neg, Sub};
use field::Real;
use field::real::Scalar;
use std::cell::RefCell;

/// A recording in progress.
#[derive(Default)]
struct Recording {
    tape: Tape,
    /// The conditions on constants that the formula has asked for in this run, and the answers.
    asked: Vec<(Place, bool)>,
    /// The answers that it is given in this run, in the order in which it asks.
    answers: Vec<bool>,
}

thread_local! {
    static RECORDING: RefCell<Recording> = RefCell::default();
}

/// A number that records.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recorded(Place);

/// A condition that was recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition(Place);

fn push(expression: Expression) -> Place {
    RECORDING.with_borrow_mut(|recording| recording.tape.push(expression))
}

/// Records a formula: returns the list and the places of its results. The formula is run once for
/// each way in which conditions on constants may turn out.
pub fn record<const N: usize>(formula: impl Fn() -> [Recorded; N]) -> (Tape, Vec<Place>) {
    RECORDING.set(Recording::default());
    let results = branches(&formula, Vec::new());
    (RECORDING.take().tape, results)
}

/// Records the formula where the first conditions on constants turn out as given.
fn branches<const N: usize>(
    formula: &impl Fn() -> [Recorded; N],
    answers: Vec<bool>,
) -> Vec<Place> {
    let known = answers.len();
    RECORDING.with_borrow_mut(|recording| {
        recording.asked.clear();
        recording.answers.clone_from(&answers);
    });
    let results = formula();
    let next = RECORDING.with_borrow(|recording| recording.asked.get(known).copied());
    let Some((on, _)) = next else {
        return results.map(|number| number.0).to_vec();
    };
    let arms = [true, false].map(|answer| {
        let answers = [&answers[..], &[answer]].concat();
        branches(formula, answers).into()
    });
    let branch = push(Expression::Branch { on, arms });
    (0..N as u32)
        .map(|i| push(Expression::Part(branch, i)))
        .collect()
}

impl Recorded {
    /// A coordinate of the position.
    pub fn coordinate(axis: u8) -> Self {
        Self(push(Expression::Coordinate(axis)))
    }

    /// A constant of the element.
    pub fn constant(source: Source, place: u32) -> Self {
        Self(push(Expression::Constant(source, place)))
    }

    fn one(self, operation: One) -> Self {
        Self(push(Expression::One(operation, self.0)))
    }

    fn two(self, operation: Two, other: Self) -> Self {
        Self(push(Expression::Two(operation, [self.0, other.0])))
    }

    fn call(name: &'static str, operands: &[Self]) -> Self {
        let operands = operands.iter().map(|operand| operand.0).collect();
        Self(push(Expression::Call(name, operands)))
    }

    fn part(self, i: usize) -> Self {
        Self(push(Expression::Part(self.0, i as u32)))
    }
}

fn places<const N: usize>(numbers: [Recorded; N]) -> std::rc::Rc<[Place]> {
    numbers.iter().map(|number| number.0).collect()
}

impl Add for Recorded {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.two(Two::Add, other)
    }
}

impl Sub for Recorded {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.two(Two::Subtract, other)
    }
}

impl Mul for Recorded {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.two(Two::Multiply, other)
    }
}

impl Div for Recorded {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.two(Two::Divide, other)
    }
}

impl Neg for Recorded {
    type Output = Self;
    fn neg(self) -> Self {
        self.one(One::Negate)
    }
}

impl Scalar for Recorded {
    fn round(value: f64) -> Self {
        Self::splat(value)
    }

    fn decide(Condition(on): Condition) -> bool {
        RECORDING.with_borrow_mut(|recording| {
            if let Expression::Truth(known) = recording.tape.at(on) {
                return *known;
            }
            if let Some((_, answer)) = recording.asked.iter().find(|(place, _)| *place == on) {
                return *answer;
            }
            let index = recording.asked.len();
            let answer = recording.answers.get(index).copied().unwrap_or(false);
            recording.asked.push((on, answer));
            answer
        })
    }
}

impl Real for Recorded {
    type Scalar = Self;
    type Mask = Condition;
    const LANES: usize = 1;
    const HORIZON: f64 = <f32 as Real>::HORIZON;
    const DUPLICATIONS: usize = <f32 as Real>::DUPLICATIONS;
    const DOUBLE: bool = false;

    fn splat(value: f64) -> Self {
        Self(push(Expression::Number((value as f32).to_bits())))
    }

    fn lift(value: Self) -> Self {
        value
    }

    fn from_lanes(_lane: impl FnMut(usize) -> f64) -> Self {
        panic!("a formula that computes with plain numbers cannot be recorded")
    }

    fn lane(self, _index: usize) -> f64 {
        panic!("a recorded number has no value")
    }

    fn sqrt(self) -> Self {
        self.one(One::Root)
    }

    fn abs(self) -> Self {
        self.one(One::Size)
    }

    fn floor(self) -> Self {
        self.one(One::Floor)
    }

    fn min(self, other: Self) -> Self {
        self.two(Two::Min, other)
    }

    fn max(self, other: Self) -> Self {
        self.two(Two::Max, other)
    }

    fn lt(self, other: Self) -> Condition {
        Condition(self.two(Two::Less, other).0)
    }

    fn select(mask: Condition, yes: Self, no: Self) -> Self {
        Self(push(Expression::Select([mask.0, yes.0, no.0])))
    }

    fn both(a: Condition, b: Condition) -> Condition {
        Condition(push(Expression::Two(Two::Both, [a.0, b.0])))
    }

    fn any(_mask: Condition) -> bool {
        true
    }

    fn where_any<const N: usize>(
        Condition(on): Condition,
        work: impl FnOnce() -> [Self; N],
    ) -> [Self; N] {
        let arms = [places(work()), places([Self::splat(0.0); N])];
        let branch = Self(push(Expression::Branch { on, arms }));
        core::array::from_fn(|i| branch.part(i))
    }

    fn add_over<T, const N: usize>(
        sums: [Self; N],
        items: &[T],
        term: impl FnMut(&T) -> [Self; N],
    ) -> [Self; N] {
        let steps: Vec<[Self; N]> = items.iter().map(term).collect();
        if steps.len() < 2 {
            return (steps.iter()).fold(sums, |sums, step| {
                core::array::from_fn(|i| sums[i] + step[i])
            });
        }
        let sum = RECORDING.with_borrow_mut(|recording| {
            let tape = &mut recording.tape;
            let of = tape.new_loop();
            let mut memory = Memory::default();
            let terms = (0..N).map(|i| {
                let steps: Vec<Place> = steps.iter().map(|step| step[i].0).collect();
                tape.step(of, &steps, &mut memory)
            });
            let terms = terms.collect();
            Self(tape.push(Expression::Sum {
                of,
                count: steps.len() as u32,
                terms,
            }))
        });
        core::array::from_fn(|i| sums[i] + sum.part(i))
    }

    fn one_of<const N: usize>(
        Self(on): Self,
        _choice: usize,
        count: usize,
        function: impl Fn(usize) -> [Self; N],
    ) -> [Self; N] {
        let arms = (0..count).map(|i| places(function(i))).collect();
        let switch = Self(push(Expression::Switch { on, arms }));
        core::array::from_fn(|i| switch.part(i))
    }

    fn sin_cos(self) -> (Self, Self) {
        let both = Self::call("sine_cosine", &[self]);
        (both.part(0), both.part(1))
    }

    fn decay(self) -> Self {
        Self::call("decay", &[self])
    }

    fn ln(self) -> Self {
        Self::call("logarithm", &[self])
    }

    fn ln_1p(self) -> Self {
        Self::call("logarithm_of_1_plus", &[self])
    }

    fn asinh(self) -> Self {
        Self::call("inverse_hyperbolic_sine", &[self])
    }
}
