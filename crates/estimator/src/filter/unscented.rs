//! The unscented filter as a statistical linearisation, so that it shares the factorised covariance.
//!
//! With `P = U diag(d) U^T` the sigma points are `x` and `x +- s sqrt(d_j) u_j`, `s^2 = 3`: the fourth moment of a
//! Gaussian along each direction. Half the difference of a pair is linear in the point, half the sum is not: with
//! `o_j = (y_j+ - y_j-) / (2 s)`, `e_j = (y_j+ + y_j-) / 2 - y_0` and `m = sum e_j / s^2`, the unscented mean is `y_0 + m`, the
//! covariance with the state `U diag(sqrt d) o`, and the variance `sum o_j^2 + sum e_j^2 / s^2 + (beta - alpha^2) m^2`. So
//! the gradient `h` with `U^T h = o / sqrt(d)` and the noise `R + sum e_j^2 / s^2 + (beta - alpha^2) m^2` put into the update of a
//! linear measurement give the unscented update; likewise the transition, whose `e_j` and `m` become noise sources. Nothing is
//! subtracted: with `alpha^2 = 3 / n`, `beta = 2`, `kappa = 0` all weights of noise are positive.
//!
//! Process noise is that of the middle point and is added after the transition; points are drawn anew for each
//! reading. A direction along which a point leaves the domain of the equations is linearised at the middle point.
//!
//! Source: Julier and Uhlmann 2004; statistical linear regression: Lefebvre, Bruyninckx and De Schutter 2002.
use alloc::vec::Vec;
use nalgebra::DMatrix;

use super::state_space::{Linearisation, StateSpace};
use super::ud::UdFactors;

/// Square of the distance of the points, in variances.
pub(crate) const SPREAD_SQUARED: f64 = 3.0;

/// Memory of the points. Nothing in it outlives a step.
#[derive(Clone, Debug)]
pub(crate) struct SigmaPoints {
    /// Transition with the curvature as noise: `k + n + 1` sources.
    pub linear: Linearisation,
    /// Transition of the middle point: `k` sources.
    tangent: Linearisation,
    middle: Vec<f64>,
    plus: Vec<f64>,
    minus: Vec<f64>,
    /// `Phi U`: (leading, n).
    moved: DMatrix<f64>,
    /// Weight `beta - alpha^2` of the mean's shift.
    shift_weight: f64,
}

impl SigmaPoints {
    pub(crate) fn noises<M: StateSpace>(model: &M) -> usize {
        model.noises() + model.states() + 1
    }

    pub(crate) fn new<M: StateSpace>(model: &M) -> Self {
        let (n, leading) = (model.states(), model.leading());
        Self {
            linear: Linearisation::zeros(n, leading, Self::noises(model)),
            tangent: Linearisation::zeros(n, leading, model.noises()),
            middle: vec![0.0; n],
            plus: vec![0.0; n],
            minus: vec![0.0; n],
            moved: DMatrix::zeros(leading, n),
            shift_weight: 2.0 - SPREAD_SQUARED / n as f64,
        }
    }

    /// Time update of mean `x` (n) and covariance over `dt_s`, s.
    ///
    /// # Errors
    /// The middle point cannot be advanced.
    pub(crate) fn predict<M: StateSpace>(
        &mut self,
        model: &mut M,
        x: &mut [f64],
        p: &mut UdFactors,
        dt_s: f64,
    ) -> Result<(), M::Error> {
        let (leading, k) = (model.leading(), model.noises());
        self.middle.copy_from_slice(x);
        model.propagate(&mut self.middle, dt_s, Some(&mut self.tangent))?;
        self.linear.g.fill(0.0);
        self.linear.g.columns_mut(0, k).copy_from(&self.tangent.g);
        self.linear.q.rows_mut(0, k).copy_from(&self.tangent.q);
        self.linear.q.rows_mut(k, x.len()).fill(1.0 / SPREAD_SQUARED);
        self.linear.q[k + x.len()] = self.shift_weight;
        for j in 0..x.len() {
            self.move_pair(model, x, p, j, dt_s);
        }
        x.copy_from_slice(&self.middle);
        let shift = k + x.len();
        for (i, x) in x.iter_mut().enumerate().take(leading) {
            let sum: f64 = (k..shift).map(|column| self.linear.g[(i, column)]).sum();
            self.linear.g[(i, shift)] = sum / SPREAD_SQUARED;
            *x += sum / SPREAD_SQUARED;
        }
        self.divide_by_factor(p);
        p.predict(&self.linear);
        Ok(())
    }

    /// Move the points of direction `j`: column `j` of `Phi U`, and its curvature as a noise source.
    fn move_pair<M: StateSpace>(&mut self, model: &mut M, x: &[f64], p: &UdFactors, j: usize, dt_s: f64) {
        let (leading, k) = (self.moved.nrows(), self.tangent.q.len());
        let step = self.draw(x, p, j);
        let inside = step > 0.0
            && model.propagate(&mut self.plus, dt_s, None).is_ok()
            && model.propagate(&mut self.minus, dt_s, None).is_ok();
        if !(inside && is_finite(&self.plus) && is_finite(&self.minus)) {
            let u = p.unit_upper().column(j);
            self.moved.column_mut(j).gemv(1.0, &self.tangent.phi.columns(0, j + 1), &u.rows(0, j + 1), 0.0);
            return;
        }
        for i in 0..leading {
            self.moved[(i, j)] = (self.plus[i] - self.minus[i]) / (2.0 * step);
            self.linear.g[(i, k + j)] = 0.5 * (self.plus[i] + self.minus[i]) - self.middle[i];
        }
    }

    /// Points of direction `j` about `x`; returns their distance in units of `u_j`, zero where nothing is in doubt.
    fn draw(&mut self, x: &[f64], p: &UdFactors, j: usize) -> f64 {
        let step = libm::sqrt(SPREAD_SQUARED * p.diagonal()[j]);
        self.plus.copy_from_slice(x);
        self.minus.copy_from_slice(x);
        if step > 0.0 {
            for (i, u) in p.unit_upper().column(j).iter().enumerate().take(j + 1) {
                self.plus[i] += step * u;
                self.minus[i] -= step * u;
            }
        }
        step
    }

    /// `Phi = (Phi U) U^-1`.
    fn divide_by_factor(&mut self, p: &UdFactors) {
        let u = p.unit_upper();
        for j in 0..u.ncols() {
            for l in 0..j {
                let factor = u[(l, j)];
                if factor != 0.0 {
                    let (done, mut rest) = self.moved.columns_range_pair_mut(l, j);
                    rest.axpy(-factor, &done, 1.0);
                }
            }
        }
        self.linear.phi.copy_from(&self.moved);
    }

    /// Mean of a reading from the points, and variance of what the gradient does not say; `h` (n) becomes its statistical gradient.
    ///
    /// # Errors
    /// The middle point has no such reading.
    pub(crate) fn output<M: StateSpace>(
        &mut self,
        model: &mut M,
        output: usize,
        x: &[f64],
        p: &UdFactors,
        h: &mut [f64],
    ) -> Result<(f64, f64), M::Error> {
        let middle = model.output(output, x, Some(h))?;
        let (mut shift, mut curvature) = (0.0, 0.0);
        for j in 0..x.len() {
            let u = p.unit_upper().column(j);
            let step = self.draw(x, p, j);
            let pair = (step > 0.0)
                .then(|| {
                    let plus = model.output(output, &self.plus, None).ok()?;
                    Some((plus, model.output(output, &self.minus, None).ok()?))
                })
                .flatten()
                .filter(|(plus, minus)| plus.is_finite() && minus.is_finite());
            // `middle[..j]` is the solution so far of `U^T h = o / sqrt(d)`; `h` still is the tangent.
            let slope = match pair {
                Some((plus, minus)) => {
                    let even = 0.5 * (plus + minus) - middle;
                    shift += even / SPREAD_SQUARED;
                    curvature += even * even / SPREAD_SQUARED;
                    (plus - minus) / (2.0 * step)
                }
                None => u.iter().zip(h.iter()).take(j + 1).map(|(u, h)| u * h).sum(),
            };
            let solved: f64 = u.iter().zip(&self.middle).take(j).map(|(u, h)| u * h).sum();
            self.middle[j] = slope - solved;
        }
        h.copy_from_slice(&self.middle);
        let noise = model.noise_variance(output, x);
        Ok((middle + shift, noise + curvature + self.shift_weight * shift * shift))
    }
}

fn is_finite(x: &[f64]) -> bool {
    x.iter().all(|x| x.is_finite())
}
