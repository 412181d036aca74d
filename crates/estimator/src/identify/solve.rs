//! The iterations: Levenberg-Marquardt for output error, a guarded fixed point for the instrumental and compensated methods.
//!
//! Source: Marquardt 1963; Ljung 1999 (section 10.2).
use nalgebra::DVector;
use std::sync::atomic::{AtomicBool, Ordering};

use super::checks::check_poles;
use super::equations::{Equations, Scheme};
use super::parametrisation::Parametrisation;
use super::problem::Problem;
use super::{DeadTime, IdentifyError, Parameter, Settings};
use crate::least_squares::{Damping, solve};

/// A relative step this small may be the last one where rounding keeps the errors from falling.
const ROUNDING: f64 = 1e-8;

/// Steps of instrumental variables before another method, and the relative step that needs none.
const FIRST_STEPS: usize = 4;
const CONVERGENCE_RANGE: f64 = 1e-3;

/// Halvings of a step that leaves the stable models.
const HALVINGS: usize = 30;

/// Parameters below this size, in the record's units, are compared with it rather than with themselves.
const SCALE_FLOOR: f64 = 0.1;

/// Where an iteration ended.
#[derive(Clone, Debug)]
pub(super) struct Solution {
    pub theta: Vec<f64>,
    pub iterations: usize,
    pub equations: Equations,
}

/// Relative size of a step.
pub(super) fn relative(step: &DVector<f64>, theta: &[f64]) -> f64 {
    step.iter().zip(theta).map(|(step, theta)| step.abs() / theta.abs().max(SCALE_FLOOR)).fold(0.0, f64::max)
}

/// A problem with the structure that is sought.
#[derive(Clone, Copy, Debug)]
pub(super) struct Search<'a> {
    pub problem: &'a Problem,
    pub parametrisation: &'a Parametrisation,
    pub settings: &'a Settings,
    /// Set it to end the search.
    pub stop: &'a AtomicBool,
}

impl Search<'_> {
    fn at(&self, theta: &[f64], scheme: Scheme) -> Equations {
        Equations::new(self.problem, self.parametrisation, theta, scheme)
    }

    /// Whether the search may go on.
    pub(super) fn check_going(&self) -> Result<(), IdentifyError> {
        if self.stop.load(Ordering::Relaxed) { Err(IdentifyError::Stopped) } else { Ok(()) }
    }

    fn stable(&self, theta: &[f64]) -> bool {
        theta.iter().all(|value| value.is_finite()) && self.parametrisation.expand(theta).is_stable()
    }

    /// Position of the dead time and its longest value.
    fn dead_time(&self) -> Option<(usize, f64)> {
        match self.parametrisation.structure.dead_time {
            DeadTime::Free(longest) => Some((self.parametrisation.position(Parameter::DeadTime)?, longest)),
            _ => None,
        }
    }

    /// Parameters after a step; the dead time stays in its range.
    pub(super) fn moved(&self, theta: &[f64], step: &DVector<f64>, share: f64) -> Vec<f64> {
        let mut moved: Vec<f64> =
            theta.iter().zip(step.iter()).map(|(theta, step)| theta + share * step).collect();
        if let Some((at, longest)) = self.dead_time() {
            moved[at] = moved[at].clamp(0.0, longest);
        }
        moved
    }

    /// A dead time at an end of its range that would leave it stays out of the equations.
    fn hold_at_bound(&self, theta: &[f64], equations: &mut Equations) {
        let Some((at, longest)) = self.dead_time() else { return };
        let outward = (theta[at] <= 0.0 && equations.rhs[at] < 0.0)
            || (theta[at] >= longest && equations.rhs[at] > 0.0);
        if outward {
            let diagonal = equations.matrix[(at, at)].max(f64::MIN_POSITIVE);
            equations.matrix.row_mut(at).fill(0.0);
            equations.matrix.column_mut(at).fill(0.0);
            equations.matrix[(at, at)] = diagonal;
            equations.rhs[at] = 0.0;
        }
    }

    /// Least output error from a start.
    pub(super) fn output_error(&self, start: Vec<f64>) -> Result<Solution, IdentifyError> {
        let scheme = Scheme::OutputError;
        let (mut theta, mut here) = (start.clone(), self.at(&start, scheme));
        let (mut damping, mut last_step) = (Damping::first(), f64::INFINITY);
        for iterations in 1..=self.settings.iterations {
            self.check_going()?;
            let mut bounded = here.clone();
            self.hold_at_bound(&theta, &mut bounded);
            let Some(step) = damping.step(&bounded.matrix, &bounded.rhs) else {
                damping.tighten();
                continue;
            };
            let moved = self.moved(&theta, &step, 1.0);
            last_step = relative(&step, &theta);
            let trial = self.stable(&moved).then(|| self.at(&moved, scheme)).filter(|t| t.sse.is_finite());
            match trial {
                Some(trial) if trial.sse <= here.sse || last_step <= self.settings.tolerance => {
                    (theta, here) = (moved, trial);
                    if last_step <= self.settings.tolerance && damping.share() <= 1.0 {
                        return Ok(Solution { theta, iterations, equations: here });
                    }
                    damping.relax();
                }
                _ if last_step < ROUNDING => return Ok(Solution { theta, iterations, equations: here }),
                _ => damping.tighten(),
            }
            if damping.is_hopeless() {
                break;
            }
        }
        check_poles(self.problem, &self.parametrisation.expand(&theta))?;
        Err(IdentifyError::NotConverged {
            method: "output error",
            iterations: self.settings.iterations,
            step: last_step,
        })
    }

    /// Fixed point of another system of equations.
    pub(super) fn fixed_point(
        &self,
        start: Vec<f64>,
        scheme: Scheme,
        method: &'static str,
    ) -> Result<Solution, IdentifyError> {
        let mut theta = start;
        let mut last = f64::INFINITY;
        for iterations in 1..=self.settings.iterations {
            self.check_going()?;
            let mut equations = self.at(&theta, scheme);
            self.hold_at_bound(&theta, &mut equations);
            let Some(step) = solve(&equations.matrix, &equations.rhs) else { break };
            let mut share = 1.0;
            for _ in 0..HALVINGS {
                if self.stable(&self.moved(&theta, &step, share)) {
                    break;
                }
                share *= 0.5;
            }
            let size = relative(&step, &theta);
            theta = self.moved(&theta, &step, share);
            let stalled = size < ROUNDING * 0.1 && size > 0.5 * last;
            last = size;
            if size <= self.settings.tolerance || stalled {
                let equations = self.at(&theta, scheme);
                return Ok(Solution { theta, iterations, equations });
            }
        }
        check_poles(self.problem, &self.parametrisation.expand(&theta))?;
        Err(IdentifyError::NotConverged { method, iterations: self.settings.iterations, step: last })
    }

    /// A few steps of refined instrumental variables as far as they lower the errors.
    pub(super) fn improve_by_instruments(&self, start: Vec<f64>) -> Vec<f64> {
        let scheme = Scheme::RefinedInstruments;
        let (mut theta, mut here) = (start.clone(), self.at(&start, scheme));
        for _ in 0..FIRST_STEPS {
            let Some(step) = solve(&here.matrix, &here.rhs) else { break };
            let moved = self.moved(&theta, &step, 1.0);
            if relative(&step, &theta) < CONVERGENCE_RANGE || !self.stable(&moved) {
                break;
            }
            let trial = self.at(&moved, scheme);
            if trial.sse.is_nan() || trial.sse >= here.sse {
                break;
            }
            (theta, here) = (moved, trial);
        }
        theta
    }
}
