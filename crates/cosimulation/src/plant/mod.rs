//! The plant: a simulated cylinder whose surroundings and flows a master sets.
//!
//! Inputs hold for a step. Readings are those that the sensors are expected to give: their parameters at their stated values, without noise,
//! steps and losses, but behind their lag.
mod inputs;
mod outputs;

use cylwatch_estimator::sensor::lag::FirstOrderLag;
use cylwatch_estimator::sensor::{Sensor, SensorSuite, SuiteTruth, sample};
use cylwatch_thermal::scenario::Scenario;
use cylwatch_thermal::simulate::{SimulationSettings, Stepped};
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::vessel::{Fill, Vessel};
use serde::{Deserialize, Serialize};

use crate::CosimulationError;
use crate::variable::Variable;
use inputs::InputOf;
use outputs::OutputOf;
pub(crate) use outputs::reading;

/// What fixes the film outside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum FilmInputs {
    /// Wind and the temperature of the air; the surface radiates.
    #[default]
    Wind,
    /// The coefficient, radiation included.
    Coefficient,
}

/// All that a simulated cylinder begins with.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CompiledPlant {
    /// The vessel.
    pub vessel: Vessel,
    /// Its sensors.
    pub sensors: Vec<Sensor>,
    /// What it is filled with, unless a master sets something else.
    pub fill: Fill,
    /// What fixes the film outside.
    pub film: FilmInputs,
}

/// A simulated cylinder.
#[derive(Debug)]
pub(crate) struct Plant {
    compiled: CompiledPlant,
    inputs: Vec<InputOf>,
    outputs: Vec<OutputOf>,
    /// The sensors without their lag.
    suite: SuiteTruth,
    course: Option<Course>,
}

/// A simulation that has begun.
#[derive(Clone, Debug)]
struct Course {
    stepped: Stepped,
    /// Readings behind their lag.
    lagged: Vec<f64>,
}

/// What is saved of a course.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SavedCourse {
    state: Vec<f64>,
    lagged: Vec<f64>,
}

impl Plant {
    /// # Errors
    /// A value of vessel or sensors is out of its bounds, a sensor has no place on the vessel, or the fill is no state of the gas.
    pub(crate) fn new(compiled: CompiledPlant) -> Result<Self, CosimulationError> {
        compiled.vessel.validate()?;
        for (i, sensor) in compiled.sensors.iter().enumerate() {
            sensor.validate(&format!("sensor {}", i + 1))?;
        }
        let at_once = |sensor: &Sensor| {
            let mut ideal = sensor.ideal();
            ideal.lag_s = 0.0;
            ideal
        };
        let suite = SensorSuite::try_new(compiled.sensors.iter().map(at_once).collect())?.nominal();
        let inputs = inputs::inputs(&compiled);
        let mut plant = Self { compiled, inputs, outputs: Vec::new(), suite, course: None };
        let starts = plant.starts();
        let now = plant.begun(&starts)?.stepped.sample(&plant.step_of(&starts, 1.0))?;
        plant.readings(&now)?;
        plant.outputs = outputs::outputs(&now, &plant.compiled.sensors);
        Ok(plant)
    }

    /// Variables but for the time: parameters and inputs, then outputs.
    pub(crate) fn variables(&self) -> Vec<Variable> {
        let inputs = self.inputs.iter().map(|input| input.variable(&self.compiled));
        inputs.chain(self.outputs.iter().map(|output| output.variable.clone())).collect()
    }

    fn starts(&self) -> Vec<f64> {
        let start = |input: &InputOf| input.variable(&self.compiled).start.unwrap_or_default();
        self.inputs.iter().map(start).collect()
    }

    fn step_of(&self, values: &[f64], duration_s: f64) -> Scenario {
        inputs::step(&self.inputs, values, duration_s)
    }

    /// The beginning of a course with parameters and inputs as set.
    fn begun(&self, values: &[f64]) -> Result<Course, CosimulationError> {
        let step = self.step_of(values, 1.0);
        let relative_tolerance = InputOf::RelativeTolerance.value(&self.inputs, values);
        let settings = SimulationSettings { relative_tolerance, ..SimulationSettings::default() };
        let stepped = Stepped::new(&self.compiled.vessel, &step, settings)?;
        let lagged = self.readings(&stepped.sample(&step)?)?;
        Ok(Course { stepped, lagged })
    }

    /// The parameters are set: the simulation begins.
    pub(crate) fn begin(&mut self, values: &[f64]) -> Result<(), CosimulationError> {
        self.course = Some(self.begun(values)?);
        Ok(())
    }

    /// Nothing has begun.
    pub(crate) fn reset(&mut self) {
        self.course = None;
    }

    /// Outputs with parameters and inputs as they are set now.
    pub(crate) fn outputs(&self, values: &[f64]) -> Result<Vec<f64>, CosimulationError> {
        let begun = if self.course.is_none() { Some(self.begun(values)?) } else { None };
        let Some(course) = self.course.as_ref().or(begun.as_ref()) else { return Ok(Vec::new()) };
        let now = course.stepped.sample(&self.step_of(values, 1.0))?;
        let mut readings = self.readings(&now)?;
        for ((reading, lagged), sensor) in readings.iter_mut().zip(&course.lagged).zip(&self.compiled.sensors)
        {
            if sensor.lag_s > 0.0 {
                *reading = *lagged;
            }
        }
        Ok(self.outputs.iter().map(|output| output.place.value(&now, &readings)).collect())
    }

    /// What the sensors would read without their lag.
    fn readings(&self, now: &Trajectory) -> Result<Vec<f64>, CosimulationError> {
        // Nothing is random: any seed will do.
        Ok(sample(now, &self.suite, 0)?.values)
    }

    /// A step with inputs that hold for it. After an error all is as before.
    pub(crate) fn step(&mut self, values: &[f64], step_s: f64) -> Result<(), CosimulationError> {
        let Some(mut course) = self.course.clone() else { return Ok(()) };
        let step = self.step_of(values, step_s);
        let is_lagged = self.compiled.sensors.iter().any(|sensor| sensor.lag_s > 0.0);
        let before = if is_lagged { self.readings(&course.stepped.sample(&step)?)? } else { Vec::new() };
        course.stepped.advance(&step)?;
        if is_lagged {
            let after = self.readings(&course.stepped.sample(&step)?)?;
            let readings = before.iter().zip(&after).zip(&self.compiled.sensors);
            for (lagged, ((before, after), sensor)) in course.lagged.iter_mut().zip(readings) {
                *lagged = FirstOrderLag { tau_s: sensor.lag_s }.advance(*lagged, *before, *after, step_s);
            }
        }
        self.course = Some(course);
        Ok(())
    }

    /// All that a step goes on from.
    pub(crate) fn save(&self) -> Option<SavedCourse> {
        let course = self.course.as_ref()?;
        Some(SavedCourse { state: course.stepped.state().to_vec(), lagged: course.lagged.clone() })
    }

    /// Go back to what was saved.
    pub(crate) fn restore(
        &mut self,
        saved: Option<&SavedCourse>,
        values: &[f64],
    ) -> Result<(), CosimulationError> {
        let Some(saved) = saved else {
            self.course = None;
            return Ok(());
        };
        let mut course = self.begun(values)?;
        course.stepped.restore(&saved.state)?;
        course.lagged.clone_from(&saved.lagged);
        self.course = Some(course);
        Ok(())
    }
}
