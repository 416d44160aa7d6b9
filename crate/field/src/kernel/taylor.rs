//! Taylor numbers: a function's value and derivatives, by arithmetic.
use crate::Real;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// The first N coefficients of the power series, around a place, of a function of one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Taylor<R, const N: usize>(pub [R; N]);

impl<R: Real, const N: usize> Taylor<R, N> {
    /// The variable, at a place.
    #[inline(always)]
    pub fn variable(place: R) -> Self {
        Self(core::array::from_fn(|i| match i {
            0 => place,
            1 => R::splat(1.0),
            _ => R::splat(0.0),
        }))
    }

    /// A constant.
    #[inline(always)]
    pub fn constant(value: f64) -> Self {
        Self(core::array::from_fn(|i| {
            R::splat(if i == 0 { value } else { 0.0 })
        }))
    }

    /// √x.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let Self(x) = self;
        let root = x[0].sqrt();
        let mut s = [root; N];
        for n in 1..N {
            let known = sum((1..n).map(|k| s[k] * s[n - k]));
            s[n] = (x[n] - known) / (root + root);
        }
        Self(s)
    }

    /// e^x.
    #[inline(always)]
    pub fn exp(self) -> Self {
        let Self(x) = self;
        let mut e = [x[0].exp(); N];
        for n in 1..N {
            e[n] = sum((1..=n).map(|k| R::splat(k as f64 / n as f64) * x[k] * e[n - k]));
        }
        Self(e)
    }

    /// Selects `inner` where the value is at most `bound`, else `outer`.
    #[inline(always)]
    pub fn split(self, bound: f64, inner: Self, outer: Self) -> Self {
        let is_beyond = R::splat(bound).lt(self.0[0]);
        Self(core::array::from_fn(|i| {
            R::select(is_beyond, outer.0[i], inner.0[i])
        }))
    }
}

#[inline(always)]
fn sum<R: Real>(terms: impl Iterator<Item = R>) -> R {
    terms.fold(R::splat(0.0), |sum, term| sum + term)
}

impl<R: Real, const N: usize> Add for Taylor<R, N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl<R: Real, const N: usize> Sub for Taylor<R, N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl<R: Real, const N: usize> Neg for Taylor<R, N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl<R: Real, const N: usize> Mul for Taylor<R, N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self(core::array::from_fn(|n| {
            sum((0..=n).map(|k| a[k] * b[n - k]))
        }))
    }
}

impl<R: Real, const N: usize> Div for Taylor<R, N> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        let mut quotient = a;
        for n in 0..N {
            let known = sum((1..=n).map(|k| b[k] * quotient[n - k]));
            quotient[n] = (a[n] - known) / b[0];
        }
        Self(quotient)
    }
}

impl<R: Real, const N: usize> Mul<Taylor<R, N>> for f64 {
    type Output = Taylor<R, N>;

    #[inline(always)]
    fn mul(self, other: Taylor<R, N>) -> Taylor<R, N> {
        Taylor(other.0.map(|x| R::splat(self) * x))
    }
}
