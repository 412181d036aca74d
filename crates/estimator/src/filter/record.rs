//! Record of a filter's last step, as a smoother and sensitivities of its error need it.
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

use super::step::compose;

/// One step of a filter: plain data.
#[derive(Clone, Debug, PartialEq)]
pub struct StepRecord {
    /// Interval since the step before, s.
    pub interval_s: f64,
    /// Leading rows of the transition from the step before: (leading, n).
    pub phi: DMatrix<f64>,
    /// Gradients of the outputs, in the order of their updates: (n, outputs).
    pub h: DMatrix<f64>,
    /// Gains of the outputs: (n, outputs).
    pub gain: DMatrix<f64>,
    /// Innovations: (outputs).
    pub innovation: DVector<f64>,
    /// Their variances: (outputs).
    pub variance: DVector<f64>,
    /// Which outputs were used.
    pub used: Vec<bool>,
    /// State after the update: (n); none while the step is being taken.
    pub x: DVector<f64>,
    /// Covariance after the update: (n, n); none while the step is being taken.
    pub p: DMatrix<f64>,
    /// States that were freed of everything known about them, before all readings.
    pub(crate) freed: Vec<usize>,
    /// The same before the reading of one output: output and state.
    pub(crate) freed_by: Vec<(usize, usize)>,
    /// Whether the estimate became that of another member after the readings: nothing links it with what it was.
    pub(crate) replaced: bool,
    /// Factor by which each state came closer to its rest before the readings: (n).
    pub(crate) relaxed: Vec<f64>,
    /// States that were held at a bound after the readings, with what each lacked over its variance; and the shares of that which all
    /// states took on: (n), one after the other.
    pub(crate) bounded: Vec<(usize, f64)>,
    pub(crate) shares: Vec<f64>,
    /// Memory of a product.
    product: DMatrix<f64>,
}

impl StepRecord {
    /// No step yet, of `n` states, of which `leading` move, and so many outputs.
    pub(crate) fn new(n: usize, leading: usize, outputs: usize) -> Self {
        Self {
            interval_s: 0.0,
            phi: DMatrix::zeros(leading, n),
            h: DMatrix::zeros(n, outputs),
            gain: DMatrix::zeros(n, outputs),
            innovation: DVector::zeros(outputs),
            variance: DVector::zeros(outputs),
            used: vec![false; outputs],
            x: DVector::zeros(0),
            p: DMatrix::zeros(0, 0),
            freed: Vec::with_capacity(n),
            freed_by: Vec::with_capacity(n * outputs),
            replaced: false,
            relaxed: vec![1.0; n],
            bounded: Vec::with_capacity(n),
            shares: Vec::with_capacity(n * n),
            product: DMatrix::zeros(leading, n),
        }
    }

    /// Become as another record of the same filter, without allocating.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.interval_s = other.interval_s;
        self.phi.copy_from(&other.phi);
        self.h.copy_from(&other.h);
        self.gain.copy_from(&other.gain);
        self.innovation.copy_from(&other.innovation);
        self.variance.copy_from(&other.variance);
        self.used.clone_from(&other.used);
        self.x.clone_from(&other.x);
        self.p.clone_from(&other.p);
        self.freed.clone_from(&other.freed);
        self.freed_by.clone_from(&other.freed_by);
        self.replaced = other.replaced;
        self.relaxed.clone_from(&other.relaxed);
        self.bounded.clone_from(&other.bounded);
        self.shares.clone_from(&other.shares);
    }

    /// A sample comes `dt_s`, s, after the last one.
    pub(crate) fn begin(&mut self, dt_s: f64) {
        self.interval_s = dt_s;
        self.phi.fill_with_identity();
        self.used.fill(false);
        self.freed.clear();
        self.freed_by.clear();
        self.replaced = false;
        self.relaxed.fill(1.0);
        self.bounded.clear();
        self.shares.clear();
    }

    /// Part of the interval with the transition `phi`: (leading, n).
    pub(crate) fn append(&mut self, phi: &DMatrix<f64>) {
        compose(phi, &self.phi, &mut self.product);
        core::mem::swap(&mut self.product, &mut self.phi);
    }

    /// A reading was used: gradient and gain (n), innovation and its variance.
    pub(crate) fn update(&mut self, output: usize, h: &[f64], gain: &[f64], (nu, s): (f64, f64)) {
        self.h.column_mut(output).as_mut_slice().copy_from_slice(h);
        self.gain.column_mut(output).as_mut_slice().copy_from_slice(gain);
        self.innovation[output] = nu;
        self.variance[output] = s;
        self.used[output] = true;
    }

    /// A constant came closer to its rest.
    pub(crate) fn relax(&mut self, state: usize, factor: f64) {
        self.relaxed[state] *= factor;
    }

    /// A state was held at its bound, lacking so much over its variance; all took on such shares of what it lacked: (n), 1 of itself.
    pub(crate) fn bound(&mut self, state: usize, force: f64, shares: &[f64]) {
        self.bounded.push((state, force));
        self.shares.extend_from_slice(shares);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_is_the_step_and_not_the_one_before() {
        let mut step = StepRecord::new(3, 2, 2);
        step.begin(60.0);
        step.append(&DMatrix::from_fn(2, 3, |row, column| 0.1 + row as f64 + 0.3 * column as f64));
        step.update(1, &[1.0, 2.0, 3.0], &[0.1, 0.2, 0.3], (0.5, 2.0));
        step.relax(2, 0.5);
        step.freed.push(0);
        step.freed_by.push((1, 0));
        step.bound(1, 0.2, &[0.4, 1.0, -0.1]);
        step.replaced = true;
        let mut copy = StepRecord::new(3, 2, 2);
        copy.copy_from(&step);
        // Its own memory of a product is as good.
        for of in [&mut step, &mut copy] {
            of.append(&DMatrix::from_element(2, 3, 0.7));
            of.product.fill(0.0);
        }
        assert_eq!(copy, step);
    }
}
