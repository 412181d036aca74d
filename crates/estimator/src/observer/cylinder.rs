//! The cylinder as a [`StateSpace`]: transition from the thermal model's own equations, outputs from the sensors.
//!
//! One step is an exponential Rosenbrock-Euler step: with `f` and `A = df/dx` at its start,
//! `x(t + h) = x + h phi_1(hA) f`, `F = exp(hA)`, of order 2 and exact where `f` is linear, whatever the step
//! (`transition`, in this folder). Process noise is integrated over the step, `Q = int exp(As) diag(q) exp(As)^T ds`, with an error of order 4.
//! Intervals longer than the settings allow are divided. The noise goes to the filter as `Q = G diag(q) G^T`, one column for
//! each leading state, the last one first, so that the first non-zero element of a row of `G` is 1 on its antidiagonal.
mod engine;
mod lanes;
mod linearity;
mod noise;
mod output;
mod plant;
mod structure;
mod transition;
mod walks;

use alloc::boxed::Box;
use alloc::vec::Vec;
use nalgebra::DMatrix;

use super::settings::ObserverSettings;
use super::states::States;
use crate::EstimatorError;
use crate::filter::{Dimensions, Linearisation, Plant, StateSpace, StepMemory, StepTransition, Steps};
use crate::sensor::Sensor;
use crate::thermal::reduced::{ReducedModel, Unknowns, WarmStart};
use crate::thermal::vessel::Vessel;
use output::{Target, reads_pressure};
use structure::Structure;
use transition::{Transition, Walking};

/// What the gas temperature may be while gas is exchanged.
const FREE_GAS_SD_K: f64 = 20.0;

/// The cylinder with its sensors in the variables of [`States`].
#[derive(Clone, Debug)]
pub struct Cylinder {
    model: ReducedModel,
    sensors: Vec<Sensor>,
    targets: Vec<Target>,
    /// Whether each sensor's reading depends on the gas pressure.
    reads_pressure: Vec<bool>,
    states: States,
    settings: ObserverSettings,
    /// How each leading state walks.
    walking: Vec<Walking>,
    /// Error of the pressure per kelvin between wall and gas that the present member supposes, Pa/K.
    caution_pa_k: f64,
    /// Bounded states with their bounds.
    bounds: Vec<(usize, f64, f64)>,
    /// Offsets of transmitters.
    offsets: Vec<usize>,
    /// What each sensor's offset may have changed by since it was new, standard deviation.
    loosened: Vec<f64>,
    /// States in which the equations are not linear, with the inverse of the difference for which a linearisation serves.
    nonlinear: Vec<(usize, f64)>,
    /// Mass and gas temperature with the variances that they have when gas has flowed.
    freed: [(usize, f64); 2],
    /// Largest `nu^2/S` of a pressure where gas may flow.
    flow_gate: f64,
    /// Whether the noise of a sensor follows from the last step, as if it had been read before that.
    noise_by_step: bool,
    /// Interval since each sensor's last sample, s: how much of the model error it has seen before.
    interval_s: Vec<f64>,
    /// How often in a row each sensor has read the same before.
    repeats: Vec<u32>,
    work: Work,
}

/// Reused memory of a step.
#[derive(Clone, Debug)]
struct Work {
    rate: Vec<f64>,
    jacobian: DMatrix<f64>,
    transition: Transition,
    /// Noise covariance of a step, upper triangle: (leading, leading).
    noise: DMatrix<f64>,
    /// Gradient of a sensor behind a lag: (n).
    gradient: Vec<f64>,
    divided: Option<Box<Divided>>,
}

impl Cylinder {
    /// A vessel seen by sensors.
    ///
    /// # Errors
    /// A setting is out of its bounds, no sensor is given, two have one name, or one sits where the vessel has no place.
    pub fn new(
        vessel: &Vessel,
        sensors: &[Sensor],
        settings: &ObserverSettings,
    ) -> Result<Self, EstimatorError> {
        settings.validate()?;
        let model = ReducedModel::new(vessel, settings.wall_nodes, settings.film_w_m2_k);
        let states = States::new(&model, sensors, settings);
        let targets =
            sensors.iter().map(|sensor| Target::of(sensor, &model, vessel)).collect::<Result<_, _>>()?;
        if let Some(twice) =
            sensors.iter().enumerate().find(|(i, s)| sensors[..*i].iter().any(|o| o.name == s.name))
        {
            return Err(EstimatorError::SensorTwice { name: twice.1.name.clone() });
        }
        let structure = Structure::of(&states);
        let work = Work {
            rate: vec![0.0; model.states()],
            jacobian: DMatrix::zeros(model.states(), model.states() + Unknowns::COUNT),
            transition: Transition::new(&structure, states.count()),
            noise: DMatrix::zeros(states.leading, states.leading),
            gradient: vec![0.0; states.count()],
            divided: None,
        };
        let mut cylinder = Self {
            interval_s: vec![f64::INFINITY; sensors.len()],
            repeats: vec![0; sensors.len()],
            freed: [(0, 0.0); 2],
            flow_gate: settings.gate_sd * settings.gate_sd,
            noise_by_step: false,
            caution_pa_k: 0.0,
            walking: vec![Walking::default(); states.leading],
            bounds: Vec::new(),
            offsets: Vec::new(),
            loosened: vec![0.0; sensors.len()],
            nonlinear: Vec::new(),
            reads_pressure: sensors.iter().map(reads_pressure).collect(),
            sensors: sensors.to_vec(),
            targets,
            states,
            settings: settings.clone(),
            work,
            model,
        };
        cylinder.freed = cylinder.freed_gas_of();
        cylinder.set_walks();
        cylinder.set_bounds();
        let transmitters = (0..sensors.len()).filter(|&sensor| cylinder.reads_pressure(sensor));
        let offset = |sensor| cylinder.states.offset_of(sensor, sensors);
        cylinder.offsets = transmitters.filter_map(offset).collect();
        let limit = |(state, kind)| cylinder.linear_range(kind).map(|limit| (state, limit));
        cylinder.nonlinear = cylinder.states.kinds.iter().enumerate().filter_map(limit).collect();
        cylinder.suppose(&settings.bank[0]);
        Ok(cylinder)
    }

    /// What each state is.
    pub fn state_map(&self) -> &States {
        &self.states
    }

    /// The sensors.
    pub fn sensors(&self) -> &[Sensor] {
        &self.sensors
    }

    /// The settings.
    pub fn settings(&self) -> &ObserverSettings {
        &self.settings
    }

    /// The thermal model.
    pub fn model(&mut self) -> &mut ReducedModel {
        &mut self.model
    }

    /// Where the model's iterations start next.
    pub(super) fn warm_start(&self) -> WarmStart {
        self.model.warm_start()
    }

    /// The same where it is.
    pub(super) fn warm_start_parts(&self) -> ([f64; 2], &[f64]) {
        self.model.warm_start_parts()
    }

    /// The same, in the memory of another one.
    pub(super) fn write_warm_start(&self, start: &mut WarmStart) {
        self.model.write_warm_start(start);
    }

    /// Whether a sensor reads the gas pressure.
    pub(crate) fn reads_pressure(&self, sensor: usize) -> bool {
        self.reads_pressure[sensor]
    }

    /// Hold no member whose gas may flow.
    pub(super) fn suppose_no_flow(&mut self) {
        self.settings.suppose_no_flow();
    }

    /// How often in a row a sensor has read the same before its next reading.
    pub(super) fn set_repeats(&mut self, sensor: usize, repeats: u32) {
        self.repeats[sensor] = repeats;
    }

    /// Interval since the last sample of a sensor, s.
    pub fn set_interval_s(&mut self, sensor: usize, interval_s: f64) {
        self.interval_s[sensor] = interval_s;
    }

    /// Pressure at a state, Pa.
    ///
    /// # Errors
    /// The state has no gas.
    pub(crate) fn pressure_pa(&mut self, x: &[f64]) -> Result<f64, EstimatorError> {
        let n = self.model.states();
        Ok(self.model.pressure_pa(&x[..n])?)
    }

    fn unknowns(&self, x: &[f64]) -> Unknowns {
        let value = |state: Option<usize>| state.map_or(0.0, |i| x[i]);
        Unknowns {
            air_k: x[self.states.air],
            ln_outside_film: value(self.states.outside),
            ln_inside_film: value(self.states.inside),
            ln_capacity: value(self.states.capacity),
            sun_w: value(self.states.sun),
            valve_sun: ReducedModel::VALVE_SUN + value(self.states.valve_sun),
            film_slope: value(self.states.slope),
            outflow_kg_s: x[self.states.leak],
        }
    }

    /// The linearised equations at `x`.
    fn linearise(&mut self, x: &[f64]) -> Result<(), EstimatorError> {
        let physical = self.model.states();
        let unknowns = self.unknowns(x);
        let Work { rate, jacobian, transition, .. } = &mut self.work;
        self.model.rates(&x[..physical], &unknowns, rate, Some(jacobian))?;
        let states = &self.states;
        let of_unknowns = [
            Some(states.air),
            states.outside,
            states.inside,
            states.capacity,
            states.sun,
            states.valve_sun,
            states.slope,
            Some(states.leak),
        ];
        // The mass moves by itself: the temperatures are the states before it.
        let temperatures = states.mass;
        let of_states = (0..physical).map(Some);
        for (column, state) in jacobian.column_iter().zip(of_states.chain(of_unknowns)) {
            if let Some(to) = state.and_then(|state| transition.per_state_mut(state)) {
                to[..temperatures].copy_from_slice(&column.as_slice()[..temperatures]);
            }
        }
        transition.rate_mut()[..temperatures].copy_from_slice(&rate[..temperatures]);
        self.linearise_lags(x)
    }

    /// Rows of the sensors' lags: `dz/dt = (y - z) / tau`.
    fn linearise_lags(&mut self, x: &[f64]) -> Result<(), EstimatorError> {
        let mut row = self.states.mass;
        for sensor in 0..self.sensors.len() {
            let Some(lagged) = self.states.lag[sensor] else { continue };
            let rate = self.sensors[sensor].lag_s().recip();
            let mut gradient = core::mem::take(&mut self.work.gradient);
            let reading = self.static_reading(sensor, x, Some(&mut gradient));
            gradient[lagged] -= 1.0;
            let transition = &mut self.work.transition;
            for (state, by) in gradient.iter().enumerate() {
                if let Some(to) = transition.per_state_mut(state) {
                    to[row] = rate * by;
                }
            }
            let outcome = reading.map(|reading| transition.rate_mut()[row] = rate * (reading - x[lagged]));
            self.work.gradient = gradient;
            outcome?;
            row += 1;
        }
        Ok(())
    }

    /// One undivided step; its transition is in the work, and with `noise` its noise.
    fn step(&mut self, x: &mut [f64], h: f64, noise: bool) -> Result<(), EstimatorError> {
        self.linearise(x)?;
        let Work { transition, noise: q, .. } = &mut self.work;
        transition.solve(x, &self.walking, h);
        transition.advance(x);
        if noise {
            let walking = &self.walking;
            transition.write_noise(|state| walking[state].intensity, h, q);
        }
        Ok(())
    }

    /// Several [steps](Steps) as one transition, with the noise of all.
    fn divided(
        &mut self,
        x: &mut [f64],
        steps: Steps,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), EstimatorError> {
        let (n, leading) = (self.states.count(), self.states.leading);
        let mut memory = self.work.divided.take().unwrap_or_else(|| Box::new(Divided::new(n, leading)));
        memory.whole.clear();
        let part_s = steps.part_s;
        let outcome = steps.into_iter().try_for_each(|doublings| {
            let Divided { before, step, whole, memory } = &mut *memory;
            before.copy_from_slice(x);
            self.step(x, part_s, true)?;
            self.work.transition.write_phi(&mut step.phi);
            step.noise.copy_from(&self.work.noise);
            (0..doublings).for_each(|_| step.double(before, x, memory));
            whole.append(step, memory);
            Ok(())
        });
        if let Some(linear) = linear {
            linear.phi.copy_from(&memory.whole.phi);
            self.work.noise.copy_from(&memory.whole.noise);
        }
        self.work.divided = Some(memory);
        outcome
    }
}

/// Memory of an interval that is divided.
#[derive(Clone, Debug)]
struct Divided {
    before: Vec<f64>,
    step: StepTransition,
    /// All steps so far.
    whole: StepTransition,
    memory: StepMemory,
}

impl Divided {
    fn new(n: usize, leading: usize) -> Self {
        Self {
            before: vec![0.0; n],
            step: StepTransition::zeros(n, leading, 0),
            whole: StepTransition::zeros(n, leading, 0),
            memory: StepMemory::new(n, leading),
        }
    }
}

impl StateSpace for Cylinder {
    type Error = EstimatorError;

    fn dimensions(&self) -> Dimensions {
        Dimensions {
            states: self.states.count(),
            leading: self.states.leading,
            noises: self.states.leading,
            outputs: self.sensors.len(),
        }
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), EstimatorError> {
        if self.noise_by_step {
            self.interval_s.fill(dt_s);
        }
        let steps = Steps::of(dt_s, self.settings.longest_step_s);
        let Some(linear) = linear else {
            return if steps.is_one() { self.step(x, dt_s, false) } else { self.divided(x, steps, None) };
        };
        if steps.is_one() {
            self.step(x, dt_s, true)?;
            self.work.transition.write_phi(&mut linear.phi);
        } else {
            self.divided(x, steps, Some(linear))?;
        }
        noise::factor(&mut self.work.noise, linear);
        Ok(())
    }

    fn output(&mut self, j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, EstimatorError> {
        let Some(state) = self.states.lag[j] else { return self.static_reading(j, x, h) };
        if let Some(h) = h {
            h.fill(0.0);
            h[state] = 1.0;
        }
        Ok(x[state])
    }

    fn noise_variance(&self, j: usize, x: &[f64]) -> f64 {
        self.noise_at_caution(j, x, self.caution_pa_k)
    }
}
