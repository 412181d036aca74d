//! The cylinder as a [`Plant`]: members of the bank differ in how they let gas leave.
use crate::filter::simd::{Arch, Simd, WithSimd};
use alloc::vec::Vec;
use cylwatch_thermal::real::powi;

use super::structure::Structure;
use super::walks::slow_process;
use super::{Cylinder, FREE_GAS_SD_K};
use crate::EstimatorError;
use crate::filter::ud_bank::Pattern;
use crate::filter::{Gate, Plant, SlowProcess, StateSpace, StepTransition};
use crate::observer::settings::LeakHypothesis;

/// Longest step of the transition in a moving horizon, s. The whole window passes again at each iteration, and over a minute the step
/// is still exact but for the change of its own coefficients.
const LONGEST_WINDOW_STEP_S: f64 = 60.0;

/// What follows the linearisation, compiled for the vector registers of the machine.
struct Transit<'a> {
    cylinder: &'a mut Cylinder,
    x: &'a mut [f64],
    h: f64,
    step: &'a mut StepTransition,
}

impl WithSimd for Transit<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { cylinder, x, h, step } = self;
        let (mass, leak, walking) = (cylinder.states.mass, cylinder.states.leak, &cylinder.walking);
        let transition = &mut cylinder.work.transition;
        transition.solve(x, walking, h);
        transition.advance(x);
        transition.write_phi(&mut step.phi);
        let common =
            |state: usize| if state == mass || state == leak { 0.0 } else { walking[state].intensity };
        transition.write_noise(common, h, &mut step.noise);
        for (source, by) in [mass, leak].into_iter().zip(&mut step.by_source) {
            transition.write_noise(|state| f64::from(state == source), h, by);
        }
    }
}

impl Plant for Cylinder {
    type Hypothesis = LeakHypothesis;

    /// With the usual sensors.
    const USUAL_SIZES: (usize, usize) = (19, 9);

    /// Mass and leak rate.
    const SOURCES: usize = 2;

    /// Let mass and leak rate walk, and trust the pressure, as one member of the bank does.
    fn suppose(&mut self, leak: &LeakHypothesis) {
        self.caution_pa_k = leak.caution_pa_k;
        let mut intensities = [0.0; 2];
        self.intensities(leak, &mut intensities);
        self.walking[self.states.mass].intensity = intensities[0];
        self.walking[self.states.leak].intensity = intensities[1];
        self.walking[self.states.leak].decay_per_s = leak.rate.decay_per_s();
    }

    /// A pressure beyond its gate tells a member whose gas may flow that gas has flowed.
    fn gate(&self, leak: &LeakHypothesis, sensor: usize) -> Gate {
        if leak.is_flowing() && self.reads_pressure(sensor) {
            return Gate { limit: self.flow_gate, rejections_in_a_row: 0 };
        }
        Gate {
            limit: self.settings.gate_sd * self.settings.gate_sd,
            rejections_in_a_row: self.settings.rejections_in_a_row,
        }
    }

    /// Gas, at temperatures and a density that the equation of state knows.
    fn is_possible(&self, x: &[f64]) -> bool {
        let domain = self.model.fluid().domain();
        let temperatures = domain.lowest_temperature_k..=domain.highest_temperature_k;
        let warm = |state: usize| temperatures.contains(&x[state]);
        let mass_kg = x[self.states.mass];
        (0..self.states.wall).chain(self.states.valve).chain([self.states.gas]).all(warm)
            && mass_kg > 0.0
            && mass_kg <= self.model.highest_mass_kg()
    }

    fn noise_variance_supposing(&self, leak: &LeakHypothesis, sensor: usize, x: &[f64]) -> f64 {
        self.noise_at_caution(sensor, x, leak.caution_pa_k)
    }

    fn noise_variance_at_interval(&mut self, sensor: usize, x: &[f64], interval_s: f64) -> f64 {
        let present_s = core::mem::replace(&mut self.interval_s[sensor], interval_s);
        let variance = self.noise_variance(sensor, x);
        self.interval_s[sensor] = present_s;
        variance
    }

    fn longest_step_s(&self) -> f64 {
        self.settings.longest_step_s
    }

    fn bounds(&self) -> &[(usize, f64, f64)] {
        &self.bounds
    }

    fn slow_process(&self, state: usize) -> SlowProcess {
        slow_process(self, state)
    }

    /// A pressure frees mass and gas temperature; what has been learnt of the constants stays.
    fn freed_by(&self, sensor: usize) -> &[(usize, f64)] {
        if self.reads_pressure(sensor) { self.freed_gas() } else { &[] }
    }

    /// Offsets of transmitters.
    fn considered(&self) -> &[usize] {
        &self.offsets
    }

    fn considers(&self, leak: &LeakHypothesis) -> bool {
        leak.considers_offset
    }

    /// The noise of a sensor depends on the time since its last reading. The window asks for it again at every iteration, so there it
    /// follows from the interval before the sample: too large for the first reading after others were missing.
    fn for_window(&self) -> Self {
        let mut cylinder = self.clone();
        cylinder.settings.longest_step_s = self.settings.longest_step_s.max(LONGEST_WINDOW_STEP_S);
        cylinder.noise_by_step = true;
        cylinder
    }

    fn transition(&mut self, x: &mut [f64], h: f64, step: &mut StepTransition) -> Result<(), EstimatorError> {
        self.linearise(x)?;
        Arch::new().dispatch(Transit { cylinder: self, x, h, step });
        Ok(())
    }

    fn pattern(&self) -> Pattern {
        let Structure { block, outer, constants, mass, leak, .. } = Structure::of(&self.states);
        let coupled = [block.as_slice(), &outer, &constants].concat();
        let row = |state: usize| match state {
            _ if block.contains(&state) => coupled.clone(),
            _ if state == mass => vec![mass, leak],
            _ => vec![state],
        };
        // Noise spreads within the block, from outside of it into the block, and from the leak rate to the mass.
        let correlated =
            |i: usize, j: usize| block.contains(&i) || block.contains(&j) || (i, j) == (mass, leak);
        Pattern::new(&(0..self.states.leading).map(row).collect::<Vec<_>>()).with_noise(correlated)
    }

    fn intensities(&self, leak: &LeakHypothesis, intensities: &mut [f64]) {
        intensities.copy_from_slice(&[powi(leak.mass_walk_kg_per_sqrt_s, 2), powi(leak.rate.per_sqrt_s, 2)]);
    }

    fn is_reference(&self, leak: &LeakHypothesis) -> bool {
        !leak.rate.is_known()
    }

    /// Up to half of it curvature is left out: at the very most `0.15 x 5 K` of what drives the wall, which follows with 20 minutes, 6 mK
    /// in 10 s; over railway weeks it moves no estimate by more than 0.004 of its standard deviation.
    fn distance(
        &self,
        (reference, a): (&LeakHypothesis, &[f64]),
        (other, b): (&LeakHypothesis, &[f64]),
    ) -> f64 {
        // Without a leak rate the estimate takes no notice of its decay, but the signature of a leak does.
        if other.rate.decay_per_s() != reference.rate.decay_per_s() {
            return f64::INFINITY;
        }
        self.difference(a, b)
    }

    fn add_curvature(
        &mut self,
        reference: &[f64],
        x: &[f64],
        h: f64,
        step: &StepTransition,
        by: &mut [f64],
    ) -> Result<(), EstimatorError> {
        self.add_rate_difference(reference, x, h, step, by)
    }
}

impl Cylinder {
    /// States that gas that flowed or was exchanged frees of everything known about them, with their variances: mass and gas temperature.
    pub(in crate::observer) fn freed_gas(&self) -> &[(usize, f64)] {
        &self.freed
    }

    pub(super) fn freed_gas_of(&self) -> [(usize, f64); 2] {
        let mass_sd_kg = self.settings.free_mass_sd_kg;
        [(self.states.mass, mass_sd_kg * mass_sd_kg), (self.states.gas, FREE_GAS_SD_K * FREE_GAS_SD_K)]
    }

    /// Largest `nu^2/S` of a pressure where gas may flow: beyond it gas has.
    pub(in crate::observer) fn set_flow_gate(&mut self, flow_gate: f64) {
        self.flow_gate = flow_gate;
    }
}
