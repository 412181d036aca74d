//! The monitor: readings in, what it says of them out.
//!
//! A step hands over one row, with the readings at its beginning. The monitor may hold a row back until later ones have come: `row_time_s` says
//! of which row the outputs are.
mod said;
mod words;

use cylwatch_detector::compiled::CompiledCylinder;
use cylwatch_detector::monitor::{Monitor, Output};

use crate::CosimulationError;
use crate::plant::reading;
use crate::variable::Variable;
use said::{SAID, Said};

/// A cylinder that is watched.
#[derive(Debug)]
pub(crate) struct Watch {
    cylinder: CompiledCylinder,
    monitor: Monitor,
}

impl Watch {
    /// # Errors
    /// As [`CompiledCylinder::monitor`].
    pub(crate) fn new(cylinder: CompiledCylinder) -> Result<Self, CosimulationError> {
        Ok(Self { monitor: cylinder.monitor()?, cylinder })
    }

    /// Variables but for the time: readings, then outputs.
    pub(crate) fn variables(&self) -> Vec<Variable> {
        let readings = self.cylinder.sensors.iter().map(|sensor| {
            let (name, unit) = reading(sensor);
            Variable::reading(
                name,
                format!("Reading of the sensor {}, NaN where it is missing", sensor.name),
                unit,
            )
        });
        readings
            .chain(SAID.iter().map(|said| Variable::output(said.name, said.description, said.kind)))
            .collect()
    }

    /// Outputs before there is a row.
    pub(crate) fn nothing_said() -> Vec<f64> {
        SAID.iter().map(|said| said.before).collect()
    }

    /// Begin again.
    ///
    /// # Errors
    /// As [`Watch::new`].
    pub(crate) fn reset(&mut self) -> Result<(), CosimulationError> {
        self.monitor = self.cylinder.monitor()?;
        Ok(())
    }

    /// A row with its stamp, s; `said` are the outputs, which change where a row has been judged.
    pub(crate) fn row(
        &mut self,
        stamp_s: f64,
        readings: &[f64],
        said: &mut [f64],
    ) -> Result<(), CosimulationError> {
        let outputs = self.monitor.step(stamp_s, readings)?;
        outputs.iter().for_each(|output| say(output, said));
        Ok(())
    }

    /// There are no more rows: those that were held back.
    pub(crate) fn finish(&mut self, said: &mut [f64]) -> Result<(), CosimulationError> {
        let outputs = self.monitor.finish()?;
        outputs.iter().for_each(|output| say(output, said));
        Ok(())
    }

    /// All that the next row goes on from.
    pub(crate) fn save(&self) -> Result<Vec<u8>, CosimulationError> {
        Ok(self.monitor.save()?)
    }

    /// Go back to what was saved.
    pub(crate) fn restore(&mut self, saved: &[u8]) -> Result<(), CosimulationError> {
        self.monitor = self.cylinder.restored(saved)?;
        Ok(())
    }
}

fn say(output: &Output, said: &mut [f64]) {
    for (value, Said { of, .. }) in said.iter_mut().zip(&SAID) {
        *value = of(output, *value);
    }
}
