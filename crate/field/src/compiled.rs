//! The formulas compiled for each number type.
use crate::Jet;
use crate::term::{Evaluate, EvaluateScalar, Prepared, Term};
use wide::f32x8;

impl EvaluateScalar for f64 {
    #[inline(always)]
    fn prepared(term: &Prepared) -> &Term<Self> {
        &term.double
    }
}

impl EvaluateScalar for f32 {
    #[inline(always)]
    fn prepared(term: &Prepared) -> &Term<Self> {
        &term.single
    }
}

impl Evaluate for f64 {
    #[inline(never)]
    fn evaluate(term: &Term<f64>, local: [Self; 3]) -> Jet<Self> {
        term.local_jet_inline(local)
    }

    #[inline(never)]
    fn evaluate_point(term: &Term<f64>, position: [Self; 3]) -> Jet<Self> {
        term.point_jet_inline(position)
    }
}

impl Evaluate for f32 {
    #[inline(never)]
    fn evaluate(term: &Term<f32>, local: [Self; 3]) -> Jet<Self> {
        term.local_jet_inline(local)
    }

    #[inline(never)]
    fn evaluate_point(term: &Term<f32>, position: [Self; 3]) -> Jet<Self> {
        term.point_jet_inline(position)
    }
}

impl Evaluate for f32x8 {
    #[inline(never)]
    fn evaluate(term: &Term<f32>, local: [Self; 3]) -> Jet<Self> {
        term.local_jet_inline(local)
    }

    #[inline(never)]
    fn evaluate_point(term: &Term<f32>, position: [Self; 3]) -> Jet<Self> {
        term.point_jet_inline(position)
    }
}
