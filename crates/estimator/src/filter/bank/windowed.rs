//! Moving-horizon estimation on top of the extended filter.
//!
//! The extended filter predicts, judges each reading at its gate, and takes it; then the readings that passed go into the window
//! ([`MovingHorizon`]), whose newest state and covariance become the member's. An event that opens the estimate ends the window;
//! it begins anew from the filter's state after that sample.
use nalgebra::DVector;

use crate::filter::horizon::{Constraint, HorizonSettings, HorizonStatus, MovingHorizon};
use crate::filter::plant::Plant;
use crate::filter::ud::UdFactors;

/// A window over the last samples.
#[derive(Clone, Debug)]
pub(super) struct Windowed<P: Plant> {
    settings: HorizonSettings,
    constraints: Vec<Constraint>,
    window: Option<Box<MovingHorizon<P>>>,
    plant: P,
    dt_s: f64,
    /// Readings of the present sample that passed their gates.
    readings: Vec<f64>,
    /// Samples at which the window failed and the filter's own estimate stood.
    pub fallbacks: u64,
}

impl<P: Plant> Windowed<P> {
    pub(super) fn new(plant: &P, settings: &HorizonSettings, constraints: &[Constraint]) -> Self {
        Self {
            settings: settings.clone(),
            constraints: constraints.to_vec(),
            window: None,
            plant: plant.for_window(),
            dt_s: 0.0,
            readings: vec![f64::NAN; plant.outputs()],
            fallbacks: 0,
        }
    }

    /// A sample comes `dt_s`, s, after the last one.
    pub(super) fn begin(&mut self, dt_s: f64) {
        self.dt_s = dt_s;
    }

    /// A reading passed its gate.
    pub(super) fn take(&mut self, output: usize, reading: f64) {
        self.readings[output] = reading;
    }

    /// The past does not count any more.
    pub(super) fn clear(&mut self) {
        self.window = None;
    }

    /// A constant has come nearer to where it rests, by a factor.
    pub(super) fn relax(&mut self, state: usize, factor: f64, rest: f64) {
        if let Some(window) = &mut self.window {
            window.relax(state, factor, rest);
        }
    }

    /// Add `variance` to a constant.
    pub(super) fn inflate(&mut self, state: usize, variance: f64) {
        if let Some(window) = &mut self.window {
            window.inflate(state, variance);
        }
    }

    /// Put the sample into the window; mean and covariance become those of its newest state.
    pub(super) fn refine(&mut self, x: &mut [f64], p: &mut UdFactors) {
        let dt_s = std::mem::take(&mut self.dt_s);
        let estimate = self.window.as_mut().map(|window| window.step(dt_s, &self.readings));
        self.readings.fill(f64::NAN);
        match estimate {
            None => self.open_window(x, p),
            Some(Ok(estimate)) => {
                self.fallbacks += u64::from(matches!(estimate.status, HorizonStatus::Fallback(_)));
                x.copy_from_slice(estimate.x.as_slice());
                // A covariance that rounding has made indefinite: that of the filter is close.
                if let Ok(factors) = UdFactors::from_covariance(&estimate.covariance) {
                    p.copy_from(&factors);
                }
            }
            Some(Err(_)) => {
                self.fallbacks += 1;
                self.open_window(x, p);
            }
        }
    }

    fn open_window(&mut self, x: &[f64], p: &UdFactors) {
        let (mean, covariance) = (DVector::from_column_slice(x), p.covariance());
        let (plant, constraints) = (self.plant.clone(), self.constraints.clone());
        let window = MovingHorizon::try_new(plant, &mean, &covariance, constraints, self.settings.clone());
        self.window = window.ok().map(Box::new);
    }

    /// Samples in the window.
    #[cfg(test)]
    pub(super) fn samples(&self) -> usize {
        self.window.as_ref().map_or(0, |window| window.trajectory().len() - 1)
    }
}
