//! The update of an extended Kalman filter: linearise, judge, correct, and repeat if so wanted.
use super::ExtendedKalman;
use crate::filter::failure::{StepError, check_output};
use crate::filter::form::CovarianceForm;
use crate::filter::gate::Outcome;
use crate::filter::kernel::{axpy, dot};
use crate::filter::state_space::StateSpace;

impl<M: StateSpace, F: CovarianceForm> ExtendedKalman<M, F> {
    /// Outputs and gradients at the point of linearisation, for the readings that are there (`first`) or were used.
    ///
    /// Noise variances stay those at the prediction: the iteration minimises one function.
    pub(super) fn linearise(&mut self, z: &[f64], first: bool) -> Result<(), StepError<M::Error>> {
        let (n, work) = (self.x.len(), &mut self.work);
        for (j, h) in work.h.chunks_exact_mut(n).enumerate() {
            if !(z[j].is_finite() && (first || self.report.outputs[j].outcome != Outcome::Rejected)) {
                continue;
            }
            work.y[j] = self.model.output(j, &work.point, Some(h)).map_err(StepError::Model)?;
            if first {
                work.r[j] = self.model.noise_variance(j, &work.point);
            }
            check_output(j, work.y[j], h, work.r[j])?;
        }
        Ok(())
    }

    /// The update, iterated if so wanted.
    pub(super) fn assimilate(&mut self, z: &[f64]) -> Result<(), StepError<M::Error>> {
        if self.iterations == 0 {
            self.pass(z, true);
            return Ok(());
        }
        self.work.form.copy_from(&self.form);
        self.pass(z, true);
        if self.report.outputs.iter().any(|output| output.outcome.is_used()) {
            self.iterate(z)?;
        }
        Ok(())
    }

    /// Relinearise at the updated state and update the prediction again, until the state stays.
    fn iterate(&mut self, z: &[f64]) -> Result<(), StepError<M::Error>> {
        while self.report.iterations < self.iterations {
            self.work.point.copy_from_slice(&self.x);
            // Where an output has no value, the iteration has left its domain: it has not converged.
            if self.linearise(z, false).is_err() {
                break;
            }
            self.restart_update(z);
            self.report.iterations += 1;
            if self.has_settled() {
                return Ok(());
            }
        }
        self.report.converged = false;
        self.work.point.copy_from_slice(&self.work.predicted);
        self.linearise(z, false)?;
        self.restart_update(z);
        Ok(())
    }

    /// Update the prediction with the present gradients and the outcomes already known.
    fn restart_update(&mut self, z: &[f64]) {
        self.form.copy_from(&self.work.form);
        self.x.copy_from_slice(&self.work.predicted);
        self.pass(z, false);
    }

    /// No state is further from the point of linearisation than the tolerance.
    fn has_settled(&self) -> bool {
        let moved = self.x.iter().zip(&self.work.point).map(|(x, point)| (x - point).abs());
        moved
            .enumerate()
            .all(|(i, moved)| moved == 0.0 || moved <= self.tolerance * self.form.variance(i).sqrt())
    }

    /// One scalar update after the other. The `first` pass judges the readings, later ones keep its judgement.
    fn pass(&mut self, z: &[f64], first: bool) {
        let n = self.x.len();
        for (j, z) in z.iter().enumerate() {
            if !z.is_finite() {
                continue;
            }
            let work = &mut self.work;
            let h = &work.h[j * n..(j + 1) * n];
            for (d, (x, point)) in work.scratch.iter_mut().zip(self.x.iter().zip(&work.point)) {
                *d = x - point;
            }
            let nu = z - work.y[j] - dot(h, &work.scratch);
            let s = self.form.innovation_variance(h, work.r[j], &mut work.scratch);
            if first {
                let outcome = self.gate.judge(nu * nu / s, &mut self.counts[j]);
                self.report.enter(j, nu, s, outcome);
            }
            match self.report.outputs[j].outcome {
                Outcome::Missing | Outcome::Rejected => continue,
                Outcome::Accepted => {}
                Outcome::Reacquired => self.inflate_along(j, nu, s),
            }
            self.correct(j, nu);
        }
        if !self.consider.is_empty() {
            self.hold_consider_states();
        }
    }

    /// Let the covariance grow along `P h` until the reading passes the gate.
    fn inflate_along(&mut self, j: usize, nu: f64, s: f64) {
        let (n, work) = (self.x.len(), &mut self.work);
        self.form.covariance_with(&work.h[j * n..(j + 1) * n], &mut work.scratch);
        self.form.add_rank_one(self.gate.inflation(nu, s, work.r[j]), &work.scratch);
    }

    /// Scalar update by the innovation `nu` of output `j`.
    fn correct(&mut self, j: usize, nu: f64) {
        let (n, work) = (self.x.len(), &mut self.work);
        let range = j * n..(j + 1) * n;
        let gain = &mut work.gain[range.clone()];
        let s = self.form.update(&work.h[range], work.r[j], gain);
        (work.innovation[j], work.variance[j]) = (nu, s);
        axpy(nu, gain, &mut self.x);
    }

    /// Take back what the pass did to the consider states.
    ///
    /// The innovations `nu_j` of one pass are uncorrelated: dropping the part `c_j` of each gain leaves the error
    /// `sum c_j nu_j` more, of covariance `sum S_j c_j c_j^T`. This is the vector form, whatever the order of outputs.
    fn hold_consider_states(&mut self) {
        let (n, work) = (self.x.len(), &mut self.work);
        for (j, output) in self.report.outputs.iter().enumerate() {
            if !output.outcome.is_used() {
                continue;
            }
            let gain = &mut work.gain[j * n..(j + 1) * n];
            work.scratch.fill(0.0);
            for &i in &self.consider {
                work.scratch[i] = std::mem::take(&mut gain[i]);
            }
            self.form.add_rank_one(work.variance[j], &work.scratch);
        }
        for &i in &self.consider {
            self.x[i] = work.predicted[i];
        }
    }
}
