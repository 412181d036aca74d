//! Section 3.1 of the paper as a study: Table 1, figure 2, figure 3, and the refitted model that the rest of the report compares with.
use super::ReproduceError;
use super::table_1::{
    COUPLING, Place, Record, first_order, largest_gain_of_an_offset, row, share_of_the_published_gain,
    validation,
};
use crate::estimator::identify::{Gain, Hold, Identified, InitialState, published};

/// Scenarios that the model is validated on, by their built-in names.
const VALIDATION: [&str; 2] = ["ramp-warm", "cool-down"];

/// A model on a scenario that it was not identified from.
#[derive(Clone, Debug)]
pub(crate) struct Validation {
    /// Number of the scenario.
    pub scenario: usize,
    /// Readings and gas.
    pub record: Record,
    /// Model output, °C, of the published model with the first gas temperature as its start, and from zero.
    pub published_degc: [Vec<f64>; 2],
    /// The same of the model identified here.
    pub identified_degc: [Vec<f64>; 2],
    /// Root mean square errors of the published model, K: start fitted, at the first gas temperature, at zero.
    pub published_rms_k: [f64; 3],
    /// The same of the model identified here.
    pub identified_rms_k: [f64; 3],
}

/// The study.
#[derive(Clone, Debug)]
pub(crate) struct Identification {
    /// Scenarios 1 and 2 as one record.
    pub record: Record,
    /// The rows of Table 1, shoulder and valve.
    pub rows: [Identified; 2],
    /// Shoulder with a steady-state gain of 1: what the rest of the report calls refitted.
    pub refitted: Identified,
    /// Output of the shoulder's model, °C, on the record, and of the published one from zero.
    pub simulated_degc: [Vec<f64>; 2],
    /// Scenarios 3 and 4.
    pub validations: Vec<Validation>,
    /// Offset of a thermometer, K, that makes the largest gain, and that gain.
    pub largest_gain: Option<(f64, f64)>,
    /// Share of the way to the room's 21 °C that makes the published gain.
    pub share_of_gain: f64,
}

impl Identification {
    /// Simulates, identifies, validates.
    ///
    /// # Errors
    /// The simulation's or the identification's.
    pub(crate) fn study() -> Result<Self, ReproduceError> {
        let couplings = [COUPLING; 2];
        let record = Record::of_table_1(couplings)?;
        let rows = [row(&record, Place::Shoulder)?, row(&record, Place::Valve)?];
        let estimated = InitialState::Estimated;
        let refitted =
            first_order(&record, Place::Shoulder, Hold::First, estimated.clone(), Gain::Fixed(1.0))?;
        let output = |record: &Record, model, initial: &InitialState| -> Result<Vec<f64>, ReproduceError> {
            let comparison = Record::compared(record, model, initial)?;
            let errors = &comparison.residuals.values;
            Ok(record.gas_degc().iter().zip(errors).map(|(gas, error)| gas - error).collect())
        };
        let (identified, published) = (&rows[0].model, &published::model());
        let simulated_degc =
            [output(&record, identified, &estimated)?, output(&record, published, &InitialState::Zero)?];
        let validated = |(k, name): (usize, &'static str)| -> Result<Validation, ReproduceError> {
            let record = Record::simulated(name, couplings)?;
            let first = InitialState::Given(vec![record.gas_degc()[0]]);
            let both = |model| -> Result<[Vec<f64>; 2], ReproduceError> {
                Ok([output(&record, model, &first)?, output(&record, model, &InitialState::Zero)?])
            };
            let rms = |model| -> Result<[f64; 3], ReproduceError> {
                Ok(validation(model, &record)?.map(|comparison| comparison.statistics.mse.sqrt()))
            };
            Ok(Validation {
                scenario: k + 3,
                published_degc: both(published)?,
                identified_degc: both(identified)?,
                published_rms_k: rms(published)?,
                identified_rms_k: rms(identified)?,
                record,
            })
        };
        let validations = VALIDATION.into_iter().enumerate().map(validated).collect::<Result<_, _>>()?;
        let (share_of_gain, _) = share_of_the_published_gain(&record)?;
        let largest_gain = largest_gain_of_an_offset(&record).map(|(k, found)| (k, found.model.gain()));
        Ok(Self { record, rows, refitted, simulated_degc, validations, largest_gain, share_of_gain })
    }

    /// Pole of the refitted model, 1/s.
    pub(crate) fn refitted_pole_per_s(&self) -> f64 {
        self.refitted.model.den[1]
    }
}
