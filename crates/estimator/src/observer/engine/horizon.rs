//! Moving-horizon estimation on top of the extended filter.
//!
//! The extended filter predicts, judges each reading at its gate, and takes it; then the readings that passed go into the window
//! ([`MovingHorizon`]), whose newest state and covariance become the member's. An event that opens the estimate ends the window;
//! it begins anew from the filter's state after that sample.
//!
//! Constraints: leak rate not negative, mass not rising from sample to sample, wall, valve and gas within the temperatures
//! of the fluid's equation of state, mass between nothing and its highest density.
//!
//! The noise of a sensor depends on the time since its last reading. The window asks for it again at every iteration, so here it
//! follows from the interval before the sample: too large for the first reading after others were missing.
use nalgebra::{DVector, Dyn};

use super::super::cylinder::Cylinder;
use super::MovingHorizonSettings;
use crate::EstimatorError;
use crate::filter::horizon::{Constraint, HorizonSettings, HorizonStatus, MovingHorizon};
use crate::filter::{Linearisation, StateSpace, UdFactors};

/// Longest step of the transition in the window, s. The whole window passes again at each iteration, and over a minute the step
/// is still exact but for the change of its own coefficients.
const LONGEST_STEP_S: f64 = 60.0;
/// Least mass in the window, as a share of the highest.
const LEAST: f64 = 1e-6;

/// A window over the last samples.
#[derive(Clone, Debug)]
pub(in crate::observer) struct Horizon {
    settings: HorizonSettings,
    constraints: Vec<Constraint>,
    window: Option<Box<MovingHorizon<Process>>>,
    process: Process,
    dt_s: f64,
    /// Readings of the present sample that passed their gates.
    readings: Vec<f64>,
    /// Samples at which the window failed and the filter's own estimate stood.
    pub fallbacks: u64,
}

impl Horizon {
    pub fn new(cylinder: &mut Cylinder, settings: &MovingHorizonSettings) -> Self {
        Self {
            settings: settings.horizon(),
            constraints: constraints(cylinder, settings),
            window: None,
            process: Process::new(cylinder),
            dt_s: 0.0,
            readings: vec![f64::NAN; cylinder.outputs()],
            fallbacks: 0,
        }
    }

    /// A sample comes `dt_s`, s, after the last one.
    pub fn begin(&mut self, dt_s: f64) {
        self.dt_s = dt_s;
    }

    /// A reading passed its gate.
    pub fn take(&mut self, sensor: usize, reading: f64) {
        self.readings[sensor] = reading;
    }

    /// The past does not count any more.
    pub fn clear(&mut self) {
        self.window = None;
    }

    /// A constant has come nearer to where it rests, by a factor.
    pub fn relax(&mut self, state: usize, factor: f64, rest: f64) {
        if let Some(window) = &mut self.window {
            window.relax(state, factor, rest);
        }
    }

    /// Add `variance` to a constant.
    pub fn inflate(&mut self, state: usize, variance: f64) {
        if let Some(window) = &mut self.window {
            window.inflate(state, variance);
        }
    }

    /// Put the sample into the window; mean and covariance become those of its newest state.
    pub fn refine(&mut self, x: &mut [f64], p: &mut UdFactors<Dyn>) {
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

    fn open_window(&mut self, x: &[f64], p: &UdFactors<Dyn>) {
        let (mean, covariance) = (DVector::from_column_slice(x), p.covariance());
        let (process, constraints) = (self.process.clone(), self.constraints.clone());
        let window = MovingHorizon::try_new(process, &mean, &covariance, constraints, self.settings.clone());
        self.window = window.ok().map(Box::new);
    }
}

fn constraints(cylinder: &mut Cylinder, settings: &MovingHorizonSettings) -> Vec<Constraint> {
    let highest_kg = cylinder.model().highest_mass_kg();
    let domain = cylinder.model().fluid().domain();
    let states = cylinder.state_map();
    let mut rows = vec![
        Constraint::at_least(states.mass, LEAST * highest_kg),
        Constraint::at_most(states.mass, highest_kg),
    ];
    for state in (0..states.wall).chain(states.valve).chain([states.gas]) {
        rows.push(Constraint::at_least(state, domain.lowest_temperature_k));
        rows.push(Constraint::at_most(state, domain.highest_temperature_k));
    }
    if settings.leak_not_negative {
        rows.push(Constraint::at_least(states.leak, 0.0));
    }
    if settings.mass_not_rising {
        rows.push(Constraint::step(&[(states.mass, 1.0)], 0.0));
    }
    rows
}

/// The cylinder with the noise of a sample by the interval before it.
#[derive(Clone, Debug)]
struct Process {
    cylinder: Cylinder,
}

impl Process {
    fn new(cylinder: &Cylinder) -> Self {
        let mut cylinder = cylinder.clone();
        cylinder.set_longest_step_s(cylinder.settings().longest_step_s.max(LONGEST_STEP_S));
        Self { cylinder }
    }
}

impl StateSpace for Process {
    type Error = EstimatorError;

    fn states(&self) -> usize {
        self.cylinder.states()
    }

    fn leading(&self) -> usize {
        self.cylinder.leading()
    }

    fn noises(&self) -> usize {
        self.cylinder.noises()
    }

    fn outputs(&self) -> usize {
        self.cylinder.outputs()
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), EstimatorError> {
        for sensor in 0..self.cylinder.outputs() {
            self.cylinder.set_interval_s(sensor, dt_s);
        }
        self.cylinder.propagate(x, dt_s, linear)
    }

    fn output(&mut self, j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, EstimatorError> {
        self.cylinder.output(j, x, h)
    }

    fn noise_variance(&self, j: usize, x: &[f64]) -> f64 {
        self.cylinder.noise_variance(j, x)
    }
}

#[cfg(test)]
mod tests;
