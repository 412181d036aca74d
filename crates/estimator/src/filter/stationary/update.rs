//! The step of a stationary filter, in its steady state and out of it.
use super::Stationary;
use crate::filter::failure::{StepError, check_linearisation, check_output, check_state};
use crate::filter::gate::Outcome;
use crate::filter::kernel::{axpy, column, dot};
use crate::filter::state_space::StateSpace;

impl<M: StateSpace> Stationary<M> {
    /// Predicted state; over an irregular interval also the transition.
    pub(super) fn propagate(&mut self, dt_s: f64, regular: bool) -> Result<(), StepError<M::Error>> {
        let work = &mut self.work;
        work.predicted.copy_from_slice(&self.x);
        if dt_s > 0.0 {
            let linear = if regular { None } else { Some(&mut work.linear) };
            self.model.propagate(&mut work.predicted, dt_s, linear).map_err(StepError::Model)?;
            check_state(&work.predicted)?;
            if !regular {
                check_linearisation(&work.linear)?;
            }
        }
        Ok(())
    }

    pub(super) fn predict_outputs(&mut self, z: &[f64]) -> Result<(), StepError<M::Error>> {
        for (j, z) in z.iter().enumerate() {
            if z.is_finite() {
                let y = self.model.output(j, &self.work.predicted, None).map_err(StepError::Model)?;
                check_output(j, y, &[], self.fixed.r[j])?;
                self.work.y[j] = y;
            }
        }
        Ok(())
    }

    /// Whether every output has a reading that the gate of the steady state lets pass. Leaves the state as it is.
    pub(super) fn all_pass(&mut self, z: &[f64]) -> bool {
        let n = self.x.len();
        self.work.moved.fill(0.0);
        z.iter().enumerate().all(|(j, z)| {
            let nu = z - self.work.y[j] - dot(column(self.fixed.h.as_slice(), n, j), &self.work.moved);
            axpy(nu, column(self.fixed.gain.as_slice(), n, j), &mut self.work.moved);
            z.is_finite() && nu * nu / self.fixed.s[j] <= self.gate.limit
        })
    }

    /// Leave the steady state: the covariance moves as in the full filter.
    pub(super) fn move_covariance(&mut self, dt_s: f64, regular: bool) {
        if self.settled && regular {
            self.form.copy_from(&self.fixed.predicted);
        } else {
            if self.settled {
                self.form.copy_from(&self.fixed.updated);
            }
            if regular {
                self.form.predict(&self.fixed.linear);
            } else if dt_s > 0.0 {
                self.form.predict(&self.work.linear);
            }
        }
        self.settled = false;
    }

    /// Correct the prediction by one reading after the other, with the gains of the steady state or of the covariance.
    pub(super) fn correct(&mut self, z: &[f64]) {
        let n = self.x.len();
        self.report.clear();
        self.work.moved.fill(0.0);
        for (j, z) in z.iter().enumerate().filter(|(_, z)| z.is_finite()) {
            let (fixed, work) = (&self.fixed, &mut self.work);
            let (h, r) = (column(fixed.h.as_slice(), n, j), fixed.r[j]);
            let nu = z - work.y[j] - dot(h, &work.moved);
            let s = if self.settled { fixed.s[j] } else { self.form.quadratic(h) + r };
            let outcome = self.gate.judge(nu * nu / s, &mut self.counts[j]);
            self.report.enter(j, nu, s, outcome);
            if self.settled {
                axpy(nu, column(fixed.gain.as_slice(), n, j), &mut work.moved);
                continue;
            }
            if outcome == Outcome::Reacquired {
                self.form.covariance_with(h, &mut work.gain);
                self.form.add_rank_one(self.gate.inflation(nu, s, r), &work.gain);
            }
            if outcome.is_used() {
                self.form.update(h, r, &mut work.gain);
                axpy(nu, &work.gain, &mut work.moved);
            }
        }
        for (x, (predicted, moved)) in self.x.iter_mut().zip(self.work.predicted.iter().zip(&self.work.moved))
        {
            *x = predicted + moved;
        }
    }

    /// Return to the steady state if the covariance has.
    pub(super) fn settle(&mut self) {
        let n = self.x.len();
        self.form.write_covariance(&mut self.work.covariance);
        let steady = self.steady.updated.as_slice();
        self.settled = (0..n * n).all(|at| {
            let (i, j) = (at % n, at / n);
            let scale = (steady[i * n + i] * steady[j * n + j]).sqrt();
            (self.work.covariance[at] - steady[at]).abs() <= self.tolerance * scale
        });
    }
}
