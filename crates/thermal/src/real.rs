//! Real numbers and dual numbers, with one arithmetic on every machine.
//!
//! Elementary functions come from libm and not from the platform, so that a server and a microcontroller give the same bits; what IEEE 754
//! fixes (sums, products, quotients, roots) needs no care. A [`Dual`] is a value with its derivatives along `N` directions,
//! `f(x + e v) = f(x) + e f'(x) v` with `e e = 0`: every function that is generic over [`Real`] comes with exact derivatives.
use core::fmt::Debug;
use core::iter::Sum;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// `f64` or a dual number.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + PartialOrd<f64>
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Add<f64, Output = Self>
    + Sub<Output = Self>
    + Sub<f64, Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Div<Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + AddAssign<f64>
    + SubAssign
    + MulAssign
    + MulAssign<f64>
    + DivAssign<f64>
    + Sum
{
    /// The value.
    fn re(&self) -> f64;
    /// Absolute value.
    fn abs(self) -> Self;
    /// `1 / x`.
    fn recip(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Cube root.
    fn cbrt(self) -> Self;
    /// `x^n`.
    fn powi(self, n: i32) -> Self;
    /// `x^n` for a positive `x`.
    fn powf(self, n: f64) -> Self;
    /// `e^x`.
    fn exp(self) -> Self;
    /// `e^x - 1`.
    fn exp_m1(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Cosine.
    fn cos(self) -> Self;
    /// Arc tangent.
    fn atan(self) -> Self;
}

/// `x^n` by squaring.
pub fn powi(x: f64, n: i32) -> f64 {
    let (mut square, mut rest, mut power) = (x, n.unsigned_abs(), 1.0);
    loop {
        if rest & 1 == 1 {
            power *= square;
        }
        rest >>= 1;
        if rest == 0 {
            return if n < 0 { 1.0 / power } else { power };
        }
        square *= square;
    }
}

/// `x^n` of an `x` that is not negative, right to `|n ln x|` roundings: libm's `pow` is right to one and takes three times as long.
fn powf(x: f64, n: f64) -> f64 {
    if n == 0.0 { 1.0 } else { libm::exp(n * libm::log(x)) }
}

impl Real for f64 {
    #[inline]
    fn re(&self) -> f64 {
        *self
    }
    #[inline]
    fn abs(self) -> Self {
        libm::fabs(self)
    }
    #[inline]
    fn recip(self) -> Self {
        1.0 / self
    }
    #[inline]
    fn sqrt(self) -> Self {
        libm::sqrt(self)
    }
    #[inline]
    fn cbrt(self) -> Self {
        libm::cbrt(self)
    }
    #[inline]
    fn powi(self, n: i32) -> Self {
        powi(self, n)
    }
    #[inline]
    fn powf(self, n: f64) -> Self {
        powf(self, n)
    }
    #[inline]
    fn exp(self) -> Self {
        libm::exp(self)
    }
    #[inline]
    fn exp_m1(self) -> Self {
        libm::expm1(self)
    }
    #[inline]
    fn ln(self) -> Self {
        libm::log(self)
    }
    #[inline]
    fn cos(self) -> Self {
        libm::cos(self)
    }
    #[inline]
    fn atan(self) -> Self {
        libm::atan(self)
    }
}

/// A value with its derivatives along `N` directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize> {
    /// The value.
    pub re: f64,
    /// Derivatives.
    pub eps: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// The value of variable `index`: its derivative along that direction is 1.
    #[must_use]
    pub fn variable(value: f64, index: usize) -> Self {
        let mut dual = Self::from(value);
        dual.eps[index] = 1.0;
        dual
    }

    /// A function of this number, by its value and its slope here.
    #[inline]
    fn chain(self, value: f64, slope: f64) -> Self {
        Self { re: value, eps: self.eps.map(|eps| eps * slope) }
    }

    /// A combination of two numbers, by its value and its slopes along them.
    #[inline]
    fn joined(self, other: Self, value: f64, by_self: f64, by_other: f64) -> Self {
        let eps = core::array::from_fn(|k| self.eps[k] * by_self + other.eps[k] * by_other);
        Self { re: value, eps }
    }
}

impl<const N: usize> From<f64> for Dual<N> {
    #[inline]
    fn from(re: f64) -> Self {
        Self { re, eps: [0.0; N] }
    }
}

impl<const N: usize> PartialEq<f64> for Dual<N> {
    fn eq(&self, other: &f64) -> bool {
        self.re == *other
    }
}

impl<const N: usize> PartialOrd for Dual<N> {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        self.re.partial_cmp(&other.re)
    }
}

impl<const N: usize> PartialOrd<f64> for Dual<N> {
    fn partial_cmp(&self, other: &f64) -> Option<core::cmp::Ordering> {
        self.re.partial_cmp(other)
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.chain(-self.re, -1.0)
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, eps: core::array::from_fn(|k| self.eps[k] + other.eps[k]) }
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { re: self.re - other.re, eps: core::array::from_fn(|k| self.eps[k] - other.eps[k]) }
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        self.joined(other, self.re * other.re, other.re, self.re)
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let quotient = self.re / other.re;
        self.joined(other, quotient, 1.0 / other.re, -quotient / other.re)
    }
}

impl<const N: usize> Add<f64> for Dual<N> {
    type Output = Self;
    #[inline]
    fn add(self, other: f64) -> Self {
        Self { re: self.re + other, ..self }
    }
}

impl<const N: usize> Sub<f64> for Dual<N> {
    type Output = Self;
    #[inline]
    fn sub(self, other: f64) -> Self {
        Self { re: self.re - other, ..self }
    }
}

impl<const N: usize> Mul<f64> for Dual<N> {
    type Output = Self;
    #[inline]
    fn mul(self, other: f64) -> Self {
        self.chain(self.re * other, other)
    }
}

impl<const N: usize> Div<f64> for Dual<N> {
    type Output = Self;
    #[inline]
    fn div(self, other: f64) -> Self {
        self.chain(self.re / other, 1.0 / other)
    }
}

impl<const N: usize, T> AddAssign<T> for Dual<N>
where
    Self: Add<T, Output = Self>,
{
    #[inline]
    fn add_assign(&mut self, other: T) {
        *self = *self + other;
    }
}

impl<const N: usize, T> SubAssign<T> for Dual<N>
where
    Self: Sub<T, Output = Self>,
{
    #[inline]
    fn sub_assign(&mut self, other: T) {
        *self = *self - other;
    }
}

impl<const N: usize, T> MulAssign<T> for Dual<N>
where
    Self: Mul<T, Output = Self>,
{
    #[inline]
    fn mul_assign(&mut self, other: T) {
        *self = *self * other;
    }
}

impl<const N: usize, T> DivAssign<T> for Dual<N>
where
    Self: Div<T, Output = Self>,
{
    #[inline]
    fn div_assign(&mut self, other: T) {
        *self = *self / other;
    }
}

impl<const N: usize> Sum for Dual<N> {
    fn sum<I: Iterator<Item = Self>>(numbers: I) -> Self {
        numbers.fold(Self::from(0.0), Add::add)
    }
}

impl<const N: usize> Real for Dual<N> {
    #[inline]
    fn re(&self) -> f64 {
        self.re
    }
    #[inline]
    fn abs(self) -> Self {
        if self.re < 0.0 { -self } else { self }
    }
    #[inline]
    fn recip(self) -> Self {
        let value = 1.0 / self.re;
        self.chain(value, -value * value)
    }
    #[inline]
    fn sqrt(self) -> Self {
        let value = libm::sqrt(self.re);
        self.chain(value, 0.5 / value)
    }
    #[inline]
    fn cbrt(self) -> Self {
        let value = libm::cbrt(self.re);
        self.chain(value, value / (3.0 * self.re))
    }
    #[inline]
    fn powi(self, n: i32) -> Self {
        if n == 0 {
            return Self::from(1.0);
        }
        let lower = powi(self.re, n - 1);
        self.chain(lower * self.re, f64::from(n) * lower)
    }
    #[inline]
    fn powf(self, n: f64) -> Self {
        if n == 0.0 {
            return Self::from(1.0);
        }
        let lower = powf(self.re, n - 1.0);
        self.chain(lower * self.re, n * lower)
    }
    #[inline]
    fn exp(self) -> Self {
        let value = libm::exp(self.re);
        self.chain(value, value)
    }
    #[inline]
    fn exp_m1(self) -> Self {
        self.chain(libm::expm1(self.re), libm::exp(self.re))
    }
    #[inline]
    fn ln(self) -> Self {
        self.chain(libm::log(self.re), 1.0 / self.re)
    }
    #[inline]
    fn cos(self) -> Self {
        self.chain(libm::cos(self.re), -libm::sin(self.re))
    }
    #[inline]
    fn atan(self) -> Self {
        self.chain(libm::atan(self.re), 1.0 / (1.0 + self.re * self.re))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Derivative of a function of one variable, by dual numbers and by differences.
    fn slopes(of: fn(Dual<2>) -> Dual<2>, x: f64) -> (f64, f64) {
        let value = |x: f64| of(Dual::from(x)).re;
        let dual = of(Dual::variable(x, 1));
        assert_eq!((dual.re, dual.eps[0]), (value(x), 0.0));
        let h = 1e-5 * x.abs().max(1e-3);
        (
            dual.eps[1],
            (8.0 * (value(x + h) - value(x - h)) - (value(x + 2.0 * h) - value(x - 2.0 * h))) / (12.0 * h),
        )
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let functions: [fn(Dual<2>) -> Dual<2>; 14] = [
            |x| x.abs(),
            |x| x.recip(),
            |x| x.sqrt(),
            |x| x.cbrt(),
            |x| x.powi(-3) + x.powi(5),
            |x| x.powf(0.37),
            |x| x.powf(-1.6),
            |x| (x * 0.3).exp(),
            |x| (x * 0.3).exp_m1(),
            |x| x.ln(),
            |x| x.cos(),
            |x| x.atan(),
            |x| -x * x / (x + 2.0) - x / 3.0,
            |mut x| {
                x += x * x;
                x -= Dual::from(1.5);
                x *= x.sqrt() + 2.0;
                x /= 7.0;
                x
            },
        ];
        for (k, of) in functions.into_iter().enumerate() {
            for x in [1.1, 2.3, 17.0] {
                let (dual, difference) = slopes(of, x);
                assert!(
                    (dual / difference - 1.0).abs() < 1e-9,
                    "function {k} at {x}: {dual} and {difference}"
                );
            }
        }
    }

    #[test]
    fn derivatives_along_two_directions_are_the_gradient() {
        let (x, y): (Dual<2>, Dual<2>) = (Dual::variable(3.0, 0), Dual::variable(5.0, 1));
        let product: Dual<2> = [x * y, x / y].into_iter().sum();
        assert_eq!((product.re, product.eps), (15.6, [5.2, 3.0 - 0.12]));
    }

    #[test]
    fn powers_are_right_to_a_few_roundings() {
        for x in [1e-300, 1e-9, 0.3, 0.999, 1.0, 7.0, 1e12] {
            for n in [-1.6, -0.165, 1.0 / 6.0, 0.8, 2.5] {
                let (ours, exact) = (powf(x, n), libm::pow(x, n));
                let roundings = 2.0 + 2.0 * (n * libm::log(x)).abs();
                let same = ours == exact || (ours / exact - 1.0).abs() <= roundings * f64::EPSILON;
                assert!(same, "{x}^{n}: {ours} and {exact}");
            }
            for n in -7..=7 {
                let (ours, exact) = (powi(x, n), libm::pow(x, f64::from(n)));
                // Beside the largest and the smallest numbers a square on the way may leave the range.
                let same = ours == exact || (ours / exact - 1.0).abs() < 8.0 * f64::EPSILON;
                assert!(same || !(1e-250..1e250).contains(&exact), "{x}^{n}: {ours} and {exact}");
            }
        }
    }

    #[test]
    fn a_power_of_zero_has_its_limit_and_its_slope() {
        let zero: Dual<1> = Dual::variable(0.0, 0);
        assert_eq!(zero.powf(1.5), Dual { re: 0.0, eps: [0.0] });
        assert_eq!(zero.powf(0.0), Dual { re: 1.0, eps: [0.0] });
        assert_eq!((zero.powi(0), zero.powi(1)), (Dual::from(1.0), zero));
    }

    /// The bits of every machine.
    #[test]
    fn elementary_functions_have_these_bits() {
        let bits = [libm::exp(0.7), libm::log(0.7), libm::pow(0.7, 0.3), libm::cos(0.7), libm::cbrt(0.7)];
        let found = bits.map(f64::to_bits);
        let these = [
            0x4000_1c2a_6126_8987,
            0xbfd6_d3c3_24e1_3f50,
            0x3fec_c0b4_3ba5_c3da,
            0x3fe8_7996_529f_9d93,
            0x3fec_69b5_a72f_1a99,
        ];
        assert_eq!(found, these, "{found:#x?}");
    }
}
