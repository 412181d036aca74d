//! Detectors without an observer: a statistic in parts of the stated filling, whose threshold the judge finds.
//!
//! Their expectations are those of [`crate::baseline`], through the filling that was stated. In parts of the filling one
//! threshold fits a tank of 5 bar and a cylinder of 300.
use cylwatch_thermal::units::QUOTED_K;
use std::sync::Arc;

use super::{Candidate, CandidateRun, Kind, Row};
use crate::baseline::{ErrorCusum, Filling, PressureError, Reading, Threshold};
use crate::detector::DetectorError;
use crate::judge::JudgeError;
use crate::judge::statement::Statement;
use crate::thermal::vessel::Fill;
use crate::world::OperatorData;

/// How long the refitted detectors learn their error, s.
const LEARNING_S: f64 = 4.0 * 86_400.0;
/// Debouncing of the refitted detector, s.
const HOLD_S: f64 = 3600.0;
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
    fn start(&self, data: &OperatorData) -> Result<Box<dyn CandidateRun>, JudgeError> {
        let filling = stated_filling(data);
        let scale = 1.0 / filling.pressure_pa;
        let gas = data.vessel.fluid.name();
        let refitted = || PressureError::refitted(gas, filling).map_err(DetectorError::from);
        let (detector, scale) = match self.0 {
            Which::Paper => (of(Threshold::published(filling)), scale),
            Which::IdealGas => (of(Threshold::ideal_gas(filling)), scale),
            Which::Switch => (of(Threshold::raw_switch(SWITCH * filling.pressure_pa)), scale),
            Which::Refitted => {
                (of(Threshold::new(refitted()?).held_for(HOLD_S).zeroed_over(LEARNING_S)), scale)
            }
            // A cumulative sum counts standard deviations.
            Which::Textbook => {
                let mut cusum = ErrorCusum::learning(refitted()?, LEARNING_S);
                (Box::new(move |reading| cusum.update(reading)) as Detector, 1.0)
            }
        };
        let column = |name: &str| data.sensors.iter().position(|sensor| sensor.name == name);
        let columns = [column("shoulder"), column("pressure")];
        Ok(Box::new(Watching { detector, scale, columns }))
    }

    fn needs_threshold(&self) -> bool {
        true
    }
}

/// The filling as stated: pressure and temperature.
pub(super) fn stated_filling(data: &OperatorData) -> Filling {
    match data.commissioning.fill {
        Fill::Settled { pressure_pa, temperature_k } => Filling { pressure_pa, temperature_k },
        Fill::Pressure { pressure_pa } => Filling { pressure_pa, temperature_k: QUOTED_K },
        Fill::Mass { mass_kg } => {
            let density_kg_m3 = mass_kg / data.vessel.volume.volume_m3(QUOTED_K, 0.0);
            let pressure_pa = data.vessel.fluid.pressure_pa(density_kg_m3, QUOTED_K);
            Filling { pressure_pa, temperature_k: QUOTED_K }
        }
    }
}

/// A reading in, a statistic out.
type Detector = Box<dyn FnMut(Reading) -> f64>;

fn of(mut threshold: Threshold) -> Detector {
    Box::new(move |reading| threshold.update(reading))
}

struct Watching {
    detector: Detector,
    scale: f64,
    /// Shoulder and pressure.
    columns: [Option<usize>; 2],
}

impl CandidateRun for Watching {
    fn step(&mut self, row: &Row<'_>, statements: &mut Vec<Statement>) -> Result<(), JudgeError> {
        let [shoulder_k, pressure_pa] =
            self.columns.map(|column| column.map_or(f64::NAN, |column| row.readings[column]));
        let reading = Reading { time_s: row.stamp_s, shoulder_k, pressure_pa };
        let value = (self.detector)(reading);
        statements.push(Statement {
            stamp_s: row.stamp_s,
            statistic: Some(self.scale * value),
            ..Statement::default()
        });
        Ok(())
    }
}
