//! Detectors without an observer: a statistic in parts of the stated filling, whose threshold the judge finds.
//!
//! Their expectations are those of [`crate::detector::baseline`], through the filling that was stated. In parts of the filling one
//! threshold fits a tank of 5 bar and a cylinder of 300.
use std::sync::Arc;

use super::{Candidate, Contender, Kind, Row};
use crate::detector::baseline::{
    ErrorCusum, Expectation, Filling, GasModel, Law, PressureError, Reading, Threshold, ThresholdSettings,
};
use crate::detector::statistic::Statistic;
use crate::judge::JudgeError;
use crate::judge::said::Said;
use crate::thermal::scenario::Fill;
use crate::world::Told;

/// Temperature at which a filling is quoted, K.
const QUOTED_K: f64 = 288.15;
/// Pole of the transfer function refitted to simulated cylinders, 1/s.
const REFITTED_POLE_PER_S: f64 = 0.002_988;
/// How long the refitted detectors learn their error, s.
const LEARNT_S: f64 = 4.0 * 86_400.0;
/// Debouncing of the refitted detector, s.
const HOLD_S: f64 = 3600.0;
/// Reference value of the cumulative sum, standard deviations.
const REFERENCE: f64 = 0.5;
/// Limit of the switch as a part of the filling.
const SWITCH: f64 = 0.8;

/// The kinds of this file.
pub(super) const KINDS: [(&str, Kind); 5] = [
    ("paper", |_| Ok(Arc::new(Statistics(Which::Paper)))),
    ("paper-refitted", |_| Ok(Arc::new(Statistics(Which::Refitted)))),
    ("textbook-cusum", |_| Ok(Arc::new(Statistics(Which::Textbook)))),
    ("ideal-gas", |_| Ok(Arc::new(Statistics(Which::IdealGas)))),
    ("pressure-switch", |_| Ok(Arc::new(Statistics(Which::Switch)))),
];

#[derive(Clone, Copy)]
enum Which {
    Paper,
    Refitted,
    Textbook,
    IdealGas,
    Switch,
}

struct Statistics(Which);

impl Candidate for Statistics {
    fn start(&self, told: &Told) -> Result<Box<dyn Contender>, JudgeError> {
        let filling = stated_filling(told)?;
        let scale = 1.0 / filling.pressure_pa;
        let of = |statistic: Threshold| Detector::Threshold(Box::new(statistic));
        let (detector, scale) = match self.0 {
            Which::Paper => (of(Threshold::published(filling)?), scale),
            Which::IdealGas => (of(Threshold::ideal_gas(filling)?), scale),
            Which::Switch => (of(Threshold::raw_switch(SWITCH * filling.pressure_pa)?), scale),
            Which::Refitted => {
                let settings =
                    ThresholdSettings { hold_s: HOLD_S, zero_s: LEARNT_S, ..ThresholdSettings::default() };
                (of(Threshold::try_new(refitted(told, filling)?, settings)?), scale)
            }
            // A cumulative sum counts standard deviations.
            Which::Textbook => (Detector::Textbook(Box::new(Textbook::new(refitted(told, filling)?))), 1.0),
        };
        let column = |name: &str| told.sensors.iter().position(|sensor| sensor.name == name);
        let columns = [column("shoulder"), column("pressure")];
        Ok(Box::new(Watching { detector, scale, columns }))
    }

    fn needs_threshold(&self) -> bool {
        true
    }
}

/// The paper's error with a gain of 1, a refitted pole and the equation of state.
fn refitted(told: &Told, filling: Filling) -> Result<PressureError, JudgeError> {
    let law = Law::RealGas { gas: told.vessel.fluid.name().to_owned() };
    let model = GasModel::FirstOrder { gain: 1.0, pole_per_s: REFITTED_POLE_PER_S, initial_degc: None };
    Ok(PressureError::try_new(Expectation::try_new(law, filling)?, model)?)
}

/// The filling as stated: pressure and temperature.
pub(super) fn stated_filling(told: &Told) -> Result<Filling, JudgeError> {
    Ok(match told.commissioning.fill {
        Fill::Settled { pressure_pa, temperature_k } => Filling { pressure_pa, temperature_k },
        Fill::Pressure { pressure_pa } => Filling { pressure_pa, temperature_k: QUOTED_K },
        Fill::Mass { mass_kg } => {
            let density_kg_m3 = mass_kg / told.vessel.volume.volume_m3(QUOTED_K, 0.0);
            let pressure_pa = told.vessel.fluid.pressure_pa(density_kg_m3, QUOTED_K);
            Filling { pressure_pa, temperature_k: QUOTED_K }
        }
    })
}

enum Detector {
    Threshold(Box<Threshold>),
    Textbook(Box<Textbook>),
}

struct Watching {
    detector: Detector,
    scale: f64,
    /// Shoulder and pressure.
    columns: [Option<usize>; 2],
}

impl Contender for Watching {
    fn step(&mut self, row: &Row<'_>, said: &mut Vec<Said>) -> Result<(), JudgeError> {
        let [shoulder_k, pressure_pa] =
            self.columns.map(|column| column.map_or(f64::NAN, |column| row.readings[column]));
        let reading = Reading { time_s: row.stamp_s, shoulder_k, pressure_pa };
        let value = match &mut self.detector {
            Detector::Threshold(statistic) => statistic.update(reading),
            Detector::Textbook(textbook) => textbook.step(reading)?,
        };
        said.push(Said { stamp_s: row.stamp_s, statistic: Some(self.scale * value), ..Said::default() });
        Ok(())
    }
}

/// A cumulative sum of an error whose mean and standard deviation it takes from the first days.
struct Textbook {
    error: PressureError,
    start_s: Option<f64>,
    /// Number, mean, and sum of squares about it.
    sums: (f64, f64, f64),
    cusum: Option<ErrorCusum>,
}

impl Textbook {
    fn new(error: PressureError) -> Self {
        Self { error, start_s: None, sums: (0.0, 0.0, 0.0), cusum: None }
    }

    fn step(&mut self, reading: Reading) -> Result<f64, JudgeError> {
        if let Some(cusum) = &mut self.cusum {
            return Ok(cusum.update(reading));
        }
        let Some(error_pa) = self.error.step(reading) else { return Ok(f64::NEG_INFINITY) };
        let start_s = *self.start_s.get_or_insert(reading.time_s);
        let (n, mean, squares) = (self.sums.0 + 1.0, self.sums.1, self.sums.2);
        let off = error_pa - mean;
        let mean = mean + off / n;
        self.sums = (n, mean, squares + off * (error_pa - mean));
        if reading.time_s - start_s >= LEARNT_S && n > 1.5 {
            let sd = (self.sums.2 / (n - 1.0)).sqrt();
            self.cusum = Some(ErrorCusum::try_new(self.error.clone(), (mean, sd), REFERENCE)?);
        }
        Ok(f64::NEG_INFINITY)
    }
}
