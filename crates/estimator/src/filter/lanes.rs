//! Four numbers that go through the same arithmetic side by side.
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Number of lanes.
pub const LANES: usize = 4;

/// A number for each of four lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    /// Zeros.
    pub const ZERO: Self = Self([0.0; LANES]);

    /// The same in all lanes.
    #[inline(always)]
    pub const fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    /// Whether all lanes are zero.
    #[inline(always)]
    pub fn is_zero(self) -> bool {
        self.0 == [0.0; LANES]
    }

    /// `self / by` in the lanes where `by` is at least `least`, else `otherwise`.
    #[inline(always)]
    pub fn divided_where(self, by: Self, least: f64, otherwise: Self) -> Self {
        let quotient = self / by;
        Self(std::array::from_fn(
            |lane| {
                if by.0[lane] >= least { quotient.0[lane] } else { otherwise.0[lane] }
            },
        ))
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
