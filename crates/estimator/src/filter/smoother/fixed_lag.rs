//! Smoothing a fixed number of steps behind the filter, in bounded memory.
use std::collections::VecDeque;

use super::{Backward, PassStep, Smoothed};
use crate::EstimatorError;
use crate::filter::form::CovarianceForm;
use crate::filter::kalman::ExtendedKalman;
use crate::filter::state_space::StateSpace;

/// The last `lag + 1` steps of a filter and the smoothed state at the oldest of them.
///
/// The result equals that of smoothing the whole past: later samples reach a state through the steps in between alone.
#[derive(Clone, Debug)]
pub struct FixedLag {
    lag: usize,
    steps: VecDeque<PassStep>,
    backward: Backward,
    smoothed: Smoothed,
}

impl FixedLag {
    /// Smoother `lag` steps behind; the present state of `filter` is the first step.
    ///
    /// # Errors
    /// The filter has consider states.
    pub fn try_new<M: StateSpace, F: CovarianceForm>(
        lag: usize,
        filter: &ExtendedKalman<M, F>,
    ) -> Result<Self, EstimatorError> {
        let start = filter.record()?;
        let smoothed = Smoothed { x: start.x.clone(), p: start.p.clone() };
        let backward = Backward::new(start.x.len());
        let mut steps = VecDeque::with_capacity(lag + 1);
        steps.push_back(start);
        Ok(Self { lag, steps, backward, smoothed })
    }

    /// Take in the last step of `filter`. Returns the smoothed state `lag` steps ago, once there are so many.
    ///
    /// # Errors
    /// The filter has consider states.
    pub fn push<M: StateSpace, F: CovarianceForm>(
        &mut self,
        filter: &ExtendedKalman<M, F>,
    ) -> Result<Option<&Smoothed>, EstimatorError> {
        if self.steps.len() <= self.lag {
            self.steps.push_back(filter.record()?);
        } else if let Some(mut oldest) = self.steps.pop_front() {
            filter.record_into(&mut oldest)?;
            self.steps.push_back(oldest);
        }
        Ok(if self.steps.len() > self.lag { Some(self.smooth_oldest()) } else { None })
    }

    /// The steps held, oldest first; [`smooth_fixed_interval`](super::smooth_fixed_interval) smooths all of them.
    pub fn steps(&self) -> &VecDeque<PassStep> {
        &self.steps
    }

    fn smooth_oldest(&mut self) -> &Smoothed {
        self.backward.clear();
        for step in self.steps.iter().skip(1).rev() {
            self.backward.pass(step);
        }
        if let Some(oldest) = self.steps.front() {
            self.backward.estimate(oldest, &mut self.smoothed);
        }
        &self.smoothed
    }
}
