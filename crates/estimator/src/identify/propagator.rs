//! A linear system `x' = F x + g u` over one interval, exact for an input that is constant or straight:
//!
//! `x(h) = e^(F h) x(0) + h phi_1(F h) g u(0) + h phi_2(F h) g (u(h) - u(0))`
//!
//! with `phi_1(z) = (e^z - 1)/z` and `phi_2(z) = (e^z - 1 - z)/z^2`. All three are summed as series over `h / 2^s`, where
//! `F` is small, and doubled `s` times: `phi_2(2z) = (e^z phi_2 + phi_1 + phi_2)/4`, `phi_1(2z) = (e^z + 1) phi_1/2`.
//!
//! Source: Higham 2008 (section 10.7.4) for the functions.
use nalgebra::{SMatrix, SVector};

/// Largest 1-norm of `F h` where the series are summed.
const BASE_NORM: f64 = 0.5;
/// The first term left out is below this.
const TRUNCATION_ERROR: f64 = 2e-17;
/// As many terms are enough for the largest norm: 0.5^15/15! = 2e-17.
const TERMS: i32 = 14;

/// Intervals within this share of each other count as one.
const INTERVAL_TOLERANCE: f64 = 1e-13;

/// Propagators held for intervals that come back.
const CACHED_INTERVALS: usize = 8;

/// The system over one interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Propagator<const D: usize> {
    /// Length `h` of the interval.
    pub interval: f64,
    /// `e^(F h)`.
    pub phi: SMatrix<f64, D, D>,
    /// `h phi_1(F h) g`: effect of an input of one.
    pub constant: SVector<f64, D>,
    /// `h phi_2(F h) g`: effect of an input that rises from zero to one.
    pub rise: SVector<f64, D>,
}

impl<const D: usize> Propagator<D> {
    fn new(f: &SMatrix<f64, D, D>, g: &SVector<f64, D>, interval: f64) -> Self {
        let norm = interval * f.column_iter().map(|c| c.lp_norm(1)).fold(0.0, f64::max);
        let doublings = if norm > BASE_NORM { (norm / BASE_NORM).log2().ceil() as i32 } else { 0 };
        let z = f * (interval * 0.5_f64.powi(doublings));
        let identity = SMatrix::<f64, D, D>::identity();
        // Horner: e^z = 1 + z (1 + z/2 (1 + z/3 (...))), and likewise for the others, applied to g.
        let (mut phi, mut one, mut two) = (identity, *g, g * 0.5);
        for k in (1..=terms(norm)).rev() {
            phi = identity + z * phi / f64::from(k);
            one = g + z * one / f64::from(k + 1);
            two = g * 0.5 + z * two / f64::from(k + 2);
        }
        for _ in 0..doublings {
            two = (phi * two + one + two) * 0.25;
            one = (phi * one + one) * 0.5;
            phi *= phi;
        }
        Self { interval, phi, constant: one * interval, rise: two * interval }
    }
}

/// Terms of the series for a norm.
fn terms(norm: f64) -> i32 {
    let (mut left_out, mut terms) = (norm, 0);
    while left_out > TRUNCATION_ERROR && terms < TERMS {
        terms += 1;
        left_out *= norm / f64::from(terms + 1);
    }
    terms
}

/// Propagators of one system, each interval computed once as long as few different ones come.
#[derive(Debug)]
pub(super) struct Propagators<const D: usize> {
    f: SMatrix<f64, D, D>,
    g: SVector<f64, D>,
    held: Vec<Propagator<D>>,
    latest: usize,
    next: usize,
}

impl<const D: usize> Propagators<D> {
    pub(super) fn new(f: SMatrix<f64, D, D>, g: SVector<f64, D>) -> Self {
        Self { f, g, held: Vec::with_capacity(CACHED_INTERVALS), latest: 0, next: 0 }
    }

    /// The system over an interval.
    pub(super) fn over(&mut self, interval: f64) -> &Propagator<D> {
        let same = |held: &Propagator<D>| (held.interval - interval).abs() <= INTERVAL_TOLERANCE * interval;
        if !self.held.get(self.latest).is_some_and(same) {
            self.latest = match self.held.iter().position(same) {
                Some(index) => index,
                None => self.hold(Propagator::new(&self.f, &self.g, interval)),
            };
        }
        &self.held[self.latest]
    }

    fn hold(&mut self, propagator: Propagator<D>) -> usize {
        let index = self.next;
        self.next = (index + 1) % CACHED_INTERVALS;
        match self.held.get_mut(index) {
            Some(old) => *old = propagator,
            None => self.held.push(propagator),
        }
        index
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::{Matrix1, Matrix3, Vector1, Vector3};

    use super::*;

    #[test]
    fn a_first_order_lag_has_its_closed_form_whatever_the_interval() {
        let pole = 0.003021;
        for interval in [1e-6, 0.1, 10.0, 331.0, 5e3, 1e6] {
            let p = Propagator::new(&Matrix1::new(-pole), &Vector1::new(2.0), interval);
            let z = -pole * interval;
            let phi1 = z.exp_m1() / z;
            assert_relative_eq!(p.phi[0], z.exp(), max_relative = 1e-13 * (1.0 + z.abs()));
            assert_relative_eq!(p.constant[0], 2.0 * interval * phi1, max_relative = 1e-14);
            if z.abs() > 1e-2 {
                assert_relative_eq!(p.rise[0], 2.0 * interval * (phi1 - 1.0) / z, max_relative = 1e-12);
            }
        }
    }

    #[test]
    fn a_chain_equals_the_exponential_of_the_augmented_matrix() {
        let f = Matrix3::new(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, -0.4, -1.7, -2.3);
        let g = Vector3::new(0.0, 0.3, 1.0);
        for interval in [0.01, 0.7, 9.0] {
            let p = Propagator::new(&f, &g, interval);
            // [F g 0; 0 0 1; 0 0 0] h: its exponential holds all three.
            let mut augmented = nalgebra::SMatrix::<f64, 5, 5>::zeros();
            augmented.fixed_view_mut::<3, 3>(0, 0).copy_from(&(f * interval));
            augmented.fixed_view_mut::<3, 1>(0, 3).copy_from(&(g * interval));
            augmented[(3, 4)] = 1.0;
            let dense = augmented.exp();
            assert_relative_eq!(p.phi, dense.fixed_view::<3, 3>(0, 0).into_owned(), epsilon = 1e-13);
            assert_relative_eq!(p.constant, dense.fixed_view::<3, 1>(0, 3).into_owned(), epsilon = 1e-13);
            assert_relative_eq!(p.rise, dense.fixed_view::<3, 1>(0, 4).into_owned(), epsilon = 1e-13);
        }
    }
}
