//! The formulas compiled for each number type.
use crate::Jet;
use crate::term::{Evaluate, Prepared, Term};
use wide::f32x8;

impl Evaluate for f64 {
    #[inline(always)]
    fn term_of(term: &Prepared) -> &Term<f64> {
        &term.double
    }

    #[inline(never)]
    fn evaluate(term: &Term<f64>, profiled: bool, local: [Self; 3]) -> Jet<Self> {
        term.local_jet_inline(profiled, local)
    }

    #[inline(never)]
    fn evaluate_point(term: &Term<f64>, position: [Self; 3]) -> Jet<Self> {
        term.point_jet_inline(position)
    }
}

impl Evaluate for f32 {
    #[inline(always)]
    fn term_of(term: &Prepared) -> &Term<f32> {
        &term.single
    }

    #[inline(never)]
    #[cfg(not(target_arch = "wasm32"))]
    fn evaluate(term: &Term<f32>, profiled: bool, local: [Self; 3]) -> Jet<Self> {
        term.local_jet_inline(profiled, local)
    }

    #[inline(never)]
    #[cfg(not(target_arch = "wasm32"))]
    fn evaluate_point(term: &Term<f32>, position: [Self; 3]) -> Jet<Self> {
        term.point_jet_inline(position)
    }

    // A visitor waits for each formula that is compiled, and in the page nothing is traced by one
    // lane of single precision: it is the first of eight, which has the same bits.
    #[cfg(target_arch = "wasm32")]
    fn evaluate(term: &Term<f32>, profiled: bool, local: [Self; 3]) -> Jet<Self> {
        first(f32x8::evaluate(term, profiled, local.map(f32x8::splat)))
    }

    #[cfg(target_arch = "wasm32")]
    fn evaluate_point(term: &Term<f32>, position: [Self; 3]) -> Jet<Self> {
        first(f32x8::evaluate_point(term, position.map(f32x8::splat)))
    }
}

#[cfg(target_arch = "wasm32")]
fn first(jet: Jet<f32x8>) -> Jet<f32> {
    let of = |lanes: f32x8| lanes.to_array()[0];
    Jet {
        value: of(jet.value),
        gradient: jet.gradient.map(of),
    }
}

impl Evaluate for f32x8 {
    #[inline(always)]
    fn term_of(term: &Prepared) -> &Term<f32> {
        &term.single
    }

    #[inline(never)]
    fn evaluate(term: &Term<f32>, profiled: bool, local: [Self; 3]) -> Jet<Self> {
        term.local_jet_inline(profiled, local)
    }

    #[inline(never)]
    fn evaluate_point(term: &Term<f32>, position: [Self; 3]) -> Jet<Self> {
        term.point_jet_inline(position)
    }
}
