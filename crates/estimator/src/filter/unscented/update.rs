//! Prediction and update of an unscented Kalman filter.
use std::ops::Range;

use super::{Unscented, Work};
use crate::filter::dense::{add_product_transposed, symmetrise};
use crate::filter::failure::{StepError, check_linearisation, check_output, check_state};
use crate::filter::gate::Outcome;
use crate::filter::kernel::{axpy, column, column_mut};
use crate::filter::state_space::StateSpace;

impl<M: StateSpace> Unscented<M> {
    /// Move the points, add the process noise at the mean, factor what came out.
    pub(super) fn predict(&mut self, dt_s: f64) -> Result<(), StepError<M::Error>> {
        self.draw();
        let n = self.work.next.x.len();
        for (i, point) in self.work.points.chunks_exact_mut(n.max(1)).enumerate() {
            let linear = if i == 0 { Some(&mut self.work.linear) } else { None };
            self.model.propagate(point, dt_s, linear).map_err(StepError::Model)?;
            check_state(point)?;
        }
        check_linearisation(&self.work.linear)?;
        let rule = self.rule;
        let Work { next, points, linear, pivots, .. } = &mut self.work;
        mean_of(points, rule.weight, &mut next.x);
        for point in points.chunks_exact_mut(n.max(1)) {
            axpy(-1.0, &next.x, point);
        }
        next.p.fill(0.0);
        add_product_transposed(&mut next.p, points, |i| rule.covariance_weight(i), points, n, n);
        for (l, g) in linear.g.as_slice().chunks_exact(linear.g.nrows().max(1)).enumerate() {
            for (j, c) in g.iter().enumerate() {
                axpy(linear.q[l] * c, g, &mut column_mut(&mut next.p, n, j)[..g.len()]);
            }
        }
        Ok(next.refresh_root(pivots)?)
    }

    /// Condition the joint Gaussian of the state and the outputs `range` on their readings, one after the other.
    pub(super) fn update(&mut self, z: &[f64], range: Range<usize>) -> Result<(), StepError<M::Error>> {
        self.draw();
        self.read_outputs(z, &range)?;
        self.join(&range);
        for j in range.clone() {
            if z[j].is_finite() {
                self.condition(z[j], j, &range);
            }
        }
        let n = self.work.next.x.len();
        let high = n + range.len();
        let Work { next, mean, joint, pivots, .. } = &mut self.work;
        next.x.copy_from_slice(&mean[..n]);
        for (p, joint) in next.p.chunks_exact_mut(n.max(1)).zip(joint.chunks_exact(high.max(1))) {
            p.copy_from_slice(&joint[..n]);
        }
        Ok(next.refresh_root(pivots)?)
    }

    /// Outputs at the points; those without a reading count as zero, which is related to nothing.
    fn read_outputs(&mut self, z: &[f64], range: &Range<usize>) -> Result<(), StepError<M::Error>> {
        let n = self.work.next.x.len();
        let count = 2 * n + 1;
        for j in range.clone() {
            let values = column_mut(&mut self.work.outputs, count, j);
            values.fill(0.0);
            self.work.noise[j] = 1.0;
            if !z[j].is_finite() {
                continue;
            }
            self.work.noise[j] = self.model.noise_variance(j, &self.work.next.x);
            for (value, point) in values.iter_mut().zip(self.work.points.chunks_exact(n.max(1))) {
                *value = self.model.output(j, point, None).map_err(StepError::Model)?;
                check_output(j, *value, &[], self.work.noise[j])?;
            }
        }
        Ok(())
    }

    /// Mean and joint covariance of the state and the outputs `range`.
    fn join(&mut self, range: &Range<usize>) {
        let rule = self.rule;
        let Work { next, points, outputs, mean, joint, noise, .. } = &mut self.work;
        let n = next.x.len();
        let (count, high) = (2 * n + 1, n + range.len());
        mean[..n].copy_from_slice(&next.x);
        for point in points.chunks_exact_mut(n.max(1)) {
            axpy(-1.0, &next.x, point);
        }
        joint[..high * high].fill(0.0);
        for (to, from) in joint.chunks_exact_mut(high).zip(next.p.chunks_exact(n.max(1))) {
            to[..n].copy_from_slice(from);
        }
        for (row, j) in range.clone().enumerate() {
            let values = column_mut(outputs, count, j);
            let middle = values[0];
            let shift: f64 = values[1..].iter().map(|value| rule.weight * (value - middle)).sum();
            mean[n + row] = middle + shift;
            values.iter_mut().for_each(|value| *value -= middle + shift);
        }
        for (row, j) in range.clone().enumerate() {
            let target = column_mut(joint, high, n + row);
            for (i, point) in points.chunks_exact(n.max(1)).enumerate() {
                let weighted = rule.covariance_weight(i) * outputs[j * count + i];
                axpy(weighted, point, &mut target[..n]);
                for (to, l) in target[n..].iter_mut().zip(range.clone()) {
                    *to += weighted * outputs[l * count + i];
                }
            }
            target[n + row] += noise[j];
            for i in 0..n {
                joint[i * high + n + row] = joint[(n + row) * high + i];
            }
        }
    }

    /// Condition on the reading `z` of output `j`, if its gate lets it pass.
    fn condition(&mut self, z: f64, j: usize, range: &Range<usize>) {
        let Work { next, mean, joint, column: gain, noise, .. } = &mut self.work;
        let n = next.x.len();
        let (high, row) = (n + range.len(), n + j - range.start);
        let (nu, s) = (z - mean[row], joint[row * high + row]);
        let outcome = self.gate.judge(nu * nu / s, &mut next.gate_counts[j]);
        self.report.enter(j, nu, s, outcome);
        let gain = &mut gain[..high];
        if outcome == Outcome::Reacquired {
            gain.copy_from_slice(column(joint, high, row));
            gain[row] -= noise[j];
            let inflation = self.gate.inflation(nu, s, noise[j]);
            add_product_transposed(joint, gain, |_| inflation, gain, high, high);
        }
        if outcome.is_used() {
            gain.copy_from_slice(column(joint, high, row));
            let s = gain[row];
            axpy(nu / s, gain, mean);
            add_product_transposed(joint, gain, |_| -1.0 / s, gain, high, high);
            symmetrise(&mut joint[..high * high], high);
        }
    }
}

/// Mean of the points, as a shift of the first: the weights add to one.
fn mean_of(points: &[f64], weight: f64, mean: &mut [f64]) {
    let n = mean.len();
    let (first, others) = points.split_at(n);
    mean.copy_from_slice(first);
    for point in others.chunks_exact(n.max(1)) {
        for ((mean, value), first) in mean.iter_mut().zip(point).zip(first) {
            *mean += weight * (value - first);
        }
    }
}
