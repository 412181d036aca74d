//! A simulation whose next input is known only when the step before it is done, as in a co-simulation.
//!
//! A step is a [`Scenario`] of its own that begins with the state in which the one before has ended; its initial state does not count. The
//! solver starts anew at the beginning of each, as [`simulate`](super::simulate) does where an input jumps, so that the state vector is all
//! there is to save: from the same one on, the same bits come.
use super::events::FlowStates;
use super::samples::Samples;
use super::{Course, SimulationSettings, Start, absolute_tolerances};
use crate::ThermalError;
use crate::model::Model;
use crate::model::inputs::{InputPieces, edges_s};
use crate::scenario::Scenario;
use crate::trajectory::{Event, Trajectory};
use crate::vessel::Vessel;

/// A vessel between two steps.
#[derive(Clone, Debug)]
pub struct Stepped {
    vessel: Vessel,
    settings: SimulationSettings,
    /// Tolerances of the states: those of the first one, as of a run in one piece.
    absolute: Vec<f64>,
    x: Vec<f64>,
}

impl Stepped {
    /// At the initial state of a scenario. Source vessels and jets of its flows are states: a step has as many.
    ///
    /// # Errors
    /// Settings out of range, or an initial state outside the fluid's domain.
    pub fn new(
        vessel: &Vessel,
        scenario: &Scenario,
        settings: SimulationSettings,
    ) -> Result<Self, ThermalError> {
        settings.validate()?;
        let model = Model::new(vessel, scenario)?;
        let x = model.initial_state(vessel, &scenario.initial)?;
        let absolute = absolute_tolerances(&model, vessel, &x, &settings);
        Ok(Self { vessel: vessel.clone(), settings, absolute, x })
    }

    /// The state: all that a step goes on from.
    pub fn state(&self) -> &[f64] {
        &self.x
    }

    /// Go back to a state.
    ///
    /// # Errors
    /// [`ThermalError::StateLength`], for a state of something else.
    pub fn restore(&mut self, state: &[f64]) -> Result<(), ThermalError> {
        self.check_length(state.len())?;
        self.x.copy_from_slice(state);
        Ok(())
    }

    /// Go through a scenario: what has happened, by its clock. After an error all is as before.
    ///
    /// # Errors
    /// As [`simulate`](super::simulate), with times by the scenario's clock; [`ThermalError::StateLength`].
    pub fn advance(&mut self, step: &Scenario) -> Result<Vec<Event>, ThermalError> {
        self.settings.admit(&self.vessel, step)?;
        let model = self.model(step)?;
        let course = Course { vessel: &self.vessel, scenario: step, model: &model, settings: &self.settings };
        let start = Start { x: self.x.clone(), absolute: self.absolute.clone() };
        let ((run, _), end) = course.run(start, &[], &mut |_| true)?;
        self.x = end;
        Ok(run.events)
    }

    /// What is now, with the inputs that a scenario begins with: a trajectory of one sample.
    ///
    /// # Errors
    /// The gas has no state; [`ThermalError::StateLength`].
    pub fn sample(&self, step: &Scenario) -> Result<Trajectory, ThermalError> {
        let model = self.model(step)?;
        let inputs = InputPieces::new(step, 0.0, edges_s(step)[0]).at(0.0);
        let mut flows = FlowStates::new(&step.flows);
        flows.at_time(0.0, model.gas_state(&self.x)?.1);
        let mut samples = Samples::new(step);
        samples.push(0.0, inputs.air_k, model.output(&self.x, &inputs, &flows.open())?);
        Ok(samples.into_trajectory(&self.vessel, step, &model))
    }

    fn model(&self, step: &Scenario) -> Result<Model, ThermalError> {
        let model = Model::new(&self.vessel, step)?;
        self.check_length(model.layout().states)?;
        Ok(model)
    }

    fn check_length(&self, found: usize) -> Result<(), ThermalError> {
        let expected = self.x.len();
        if found == expected { Ok(()) } else { Err(ThermalError::StateLength { expected, found }) }
    }
}
