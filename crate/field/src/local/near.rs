//! Values and bounds of pieces at a point or in a ball. Each piece is evaluated once, for however
//! many places it counts.
use super::Piece;
use crate::bound::Nearness;
use crate::{Ball, Jet};

/// Values and gradients of pieces at a point.
pub(super) struct Jets<'a> {
    pieces: &'a [Piece],
    point: [f64; 3],
    slots: Slots<Jet<f64>>,
}

impl<'a> Jets<'a> {
    pub fn new(pieces: &'a [Piece], point: [f64; 3]) -> Self {
        Self {
            slots: Slots::new(pieces.len()),
            pieces,
            point,
        }
    }

    pub fn get(&mut self, piece: u32) -> Jet<f64> {
        let (pieces, point) = (self.pieces, self.point);
        *self
            .slots
            .get(piece, || pieces[piece as usize].primitive.jet(point))
    }
}

/// Bounds on pieces in a ball.
pub(super) struct Nearby<'a> {
    pieces: &'a [Piece],
    ball: Ball,
    far: Slots<Far>,
    close: Slots<Close>,
}

/// Nearness of a piece, and an upper bound on its field.
#[derive(Clone, Copy, Debug)]
struct Far {
    near: Nearness,
    most: f64,
}

/// Field of a piece at the ball's centre, and bounds on it in the ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct Close {
    pub jet: Jet<f64>,
    pub most: f64,
    pub slope: f64,
    pub curvature: f64,
}

impl<'a> Nearby<'a> {
    pub fn new(pieces: &'a [Piece], ball: Ball) -> Self {
        Self {
            far: Slots::new(pieces.len()),
            close: Slots::new(pieces.len()),
            pieces,
            ball,
        }
    }

    fn far(&mut self, piece: u32) -> Far {
        let (bound, ball) = (&self.pieces[piece as usize].bound, &self.ball);
        *self.far.get(piece, || {
            let near = bound.nearness(ball.center, ball.radius);
            Far {
                near,
                most: bound.magnitude(near),
            }
        })
    }

    /// Returns an upper bound on a piece's field.
    pub fn most(&mut self, piece: u32) -> f64 {
        self.far(piece).most
    }

    /// Returns a lower bound on a piece's field.
    pub fn least(&self, piece: u32) -> f64 {
        let bound = &self.pieces[piece as usize].bound;
        bound.least(self.ball.center, self.ball.radius)
    }

    pub fn close(&mut self, piece: u32) -> Close {
        let Far { near, most } = self.far(piece);
        let (own, ball) = (&self.pieces[piece as usize], &self.ball);
        *self.close.get(piece, || Close {
            jet: own.primitive.jet(ball.center.to_array()),
            most,
            slope: own.bound.slope(near),
            curvature: own.bound.curvature(near),
        })
    }
}

/// Values by number, made at first use.
struct Slots<T> {
    /// 0 for a number without a value, else one more than the value's place.
    places: Vec<u32>,
    values: Vec<T>,
}

impl<T> Slots<T> {
    fn new(count: usize) -> Self {
        Self {
            places: vec![0; count],
            values: Vec::new(),
        }
    }

    fn get(&mut self, number: u32, make: impl FnOnce() -> T) -> &T {
        let place = &mut self.places[number as usize];
        if *place == 0 {
            self.values.push(make());
            *place = self.values.len() as u32;
        }
        &self.values[*place as usize - 1]
    }
}
