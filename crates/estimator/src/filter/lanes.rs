//! Four numbers that go through the same arithmetic side by side.
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use serde::{Deserialize, Serialize};

/// Number of lanes.
pub(super) const LANES: usize = 4;

/// A number for each of four lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[repr(C, align(32))]
pub(crate) struct Lanes(pub [f64; LANES]);

impl Lanes {
    /// Zeros.
    pub(crate) const ZERO: Self = Self([0.0; LANES]);

    /// The same in all lanes.
    #[inline(always)]
    pub(crate) const fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    /// Whether all lanes are zero.
    #[cfg(test)]
    #[inline(always)]
    pub(crate) fn is_zero(self) -> bool {
        self.0 == [0.0; LANES]
    }

    /// Let some lanes be as in `from`.
    #[inline(always)]
    pub(crate) fn put(&mut self, lanes: [bool; LANES], from: Self) {
        if lanes == [true; LANES] {
            *self = from;
        } else {
            (0..LANES).filter(|&lane| lanes[lane]).for_each(|lane| self.0[lane] = from.0[lane]);
        }
    }

    /// Zero in the lanes that are at most as in `least`.
    #[inline(always)]
    pub(crate) fn above(mut self, least: Self) -> Self {
        for (own, least) in self.0.iter_mut().zip(least.0) {
            *own = if *own <= least { 0.0 } else { *own };
        }
        self
    }

    /// `normal` in the lanes where this is a normal positive number, else `otherwise`.
    #[inline(always)]
    pub(crate) fn choose(self, mut normal: Self, otherwise: Self) -> Self {
        for ((normal, own), otherwise) in normal.0.iter_mut().zip(self.0).zip(otherwise.0) {
            *normal = if own >= f64::MIN_POSITIVE { *normal } else { otherwise };
        }
        normal
    }

    /// `1 / self` in the lanes where this is a normal positive number, else 0.
    #[inline(always)]
    pub(crate) fn inverse(self) -> Self {
        self.choose(Self::splat(1.0) / self, Self::ZERO)
    }
}

macro_rules! by_lane {
    ($($trait:ident $method:ident $op:tt),*) => {$(
        impl $trait for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for (lane, other) in self.0.iter_mut().zip(other.0) {
                    *lane $op other;
                }
                self
            }
        }
    )*};
}

by_lane!(Add add +=, Sub sub -=, Mul mul *=, Div div /=);

impl Mul<f64> for Lanes {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self * Self::splat(factor)
    }
}

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::ZERO - self
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lanes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
