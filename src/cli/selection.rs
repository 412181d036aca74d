//! Which columns of a log are used, and as which sensors.
use super::input::Inputs;
use super::message::Messages;
use crate::estimator::log::{Channel, Quantity};
use crate::estimator::sensor::{Sensor, SensorsSpec, read_sensors};
use crate::log::{LogReader, Row};
use crate::thermal::vessel::Vessel;
use anyhow::{Context, bail};
use std::path::Path;

/// Sensors with their channels in the log.
pub(super) struct Selection {
    /// Sensors in the order in which they are used.
    pub sensors: Vec<Sensor>,
    /// Channel of each.
    channels: Vec<usize>,
    /// Whether nobody said what they are.
    typical: bool,
}

/// Pressure up to which the fill is looked for, Pa.
const ANY_PA: (f64, f64) = (-1e5, 1.5e8);
/// Fill of the usual cylinder at 15 °C, Pa.
pub(super) const USUAL_FILL_PA: f64 = 200e5;

impl Selection {
    /// The sensors of a file, or typical ones on all columns outside of the gas; narrows what the log takes as a reading
    /// to what the sensors can read. Columns that are `known` serve another purpose: no sensor, no caution.
    pub(super) fn new(
        reader: &mut LogReader,
        sensors: Option<Vec<Sensor>>,
        vessel: &Vessel,
        known: &[&str],
        messages: &Messages,
    ) -> anyhow::Result<Self> {
        let channels = reader.channels();
        let selection = match sensors {
            Some(sensors) => {
                let selection = Self::of(sensors, channels)?;
                selection.say_unused(channels, vessel, known, messages);
                selection
            }
            None => Self::typical(channels, vessel, known, messages)?,
        };
        for (sensor, &channel) in selection.sensors.iter().zip(&selection.channels) {
            let awaits_fill = selection.typical && sensor.quantity() == Quantity::Pressure;
            let (low, high) = if awaits_fill { ANY_PA } else { sensor.plausible() };
            reader.set_range(channel, low, high);
        }
        Ok(selection)
    }

    /// The fill has such a pressure at 15 °C, Pa: typical transmitters get the range for that. Where the fill was not stated but read, gas may be missing, and the range is no smaller than that of the usual cylinder.
    pub(super) fn know_the_fill(
        &mut self,
        full_pa: f64,
        stated: bool,
        reader: &mut LogReader,
    ) -> anyhow::Result<()> {
        let full_pa = if stated { full_pa } else { full_pa.max(USUAL_FILL_PA) };
        let pressures = self.sensors.iter_mut().zip(&self.channels);
        let pressures =
            pressures.filter(|(sensor, _)| self.typical && sensor.quantity() == Quantity::Pressure);
        for (sensor, &channel) in pressures {
            *sensor = Sensor::typical_transmitter(&sensor.name, full_pa)?;
            let (low, high) = sensor.plausible();
            reader.set_range(channel, low, high);
        }
        Ok(())
    }

    /// A file of sensors replaces all typical ones, which is easily forgotten.
    fn say_unused(&self, channels: &[Channel], vessel: &Vessel, known: &[&str], messages: &Messages) {
        let is_unused = |(index, channel): &(usize, &Channel)| {
            let name = channel.name.as_str();
            !self.channels.contains(index) && !known.contains(&name) && typical(channel, vessel, true).is_ok()
        };
        let unused: Vec<&str> =
            channels.iter().enumerate().filter(is_unused).map(|(_, channel)| channel.name.as_str()).collect();
        if !unused.is_empty() {
            let names = unused.join(", ");
            messages.caution(&format!(
                "not used: {names}; a file of sensors replaces all typical ones, name there whatever is to be used"
            ));
        }
    }

    fn of(sensors: Vec<Sensor>, channels: &[Channel]) -> anyhow::Result<Self> {
        let channel = |sensor: &Sensor| {
            let found = channels.iter().position(|channel| channel.name.eq_ignore_ascii_case(&sensor.name));
            let found = found.with_context(|| {
                let names: Vec<&str> = channels.iter().map(|channel| channel.name.as_str()).collect();
                let (name, names) = (&sensor.name, names.join(", "));
                format!(
                    "sensor {name} has no column in the log, which has {names}: give --map, or leave it out"
                )
            })?;
            if channels[found].quantity != sensor.quantity() {
                bail!("sensor {}: its column is of another quantity: look at the units", sensor.name);
            }
            Ok(found)
        };
        let channels = sensors.iter().map(channel).collect::<anyhow::Result<_>>()?;
        Ok(Self { sensors, channels, typical: false })
    }

    fn typical(
        channels: &[Channel],
        vessel: &Vessel,
        known: &[&str],
        messages: &Messages,
    ) -> anyhow::Result<Self> {
        let mut found = Vec::new();
        let mut left_out = Vec::new();
        let others = |channel: &Channel| !known.contains(&channel.name.as_str());
        // A thermometer in the gas stands in where there is none outside; beside others it is what a simulation knows.
        let outside = channels.iter().any(|channel| {
            let name = channel.name.as_str();
            channel.quantity == Quantity::Temperature
                && !name.starts_with("gas_")
                && typical(channel, vessel, true).is_ok()
        });
        for (index, channel) in channels.iter().enumerate().filter(|(_, channel)| others(channel)) {
            match typical(channel, vessel, outside) {
                Ok(sensor) => found.push((sensor, index)),
                Err(reason) => left_out.push(format!("{} ({reason})", channel.name)),
            }
        }
        if found.is_empty() {
            let reasons = if left_out.is_empty() { known.join(", ") } else { left_out.join(", ") };
            bail!(
                "no column can be used as a reading of the cylinder: {reasons}; name sensors with --sensors"
            );
        }
        if !left_out.is_empty() {
            messages.caution(&format!("not used: {}", left_out.join(", ")));
        }
        // The order of the columns means nothing: a log that has another one goes on from the same state.
        found.sort_by_key(|(sensor, _)| (sensor.quantity() == Quantity::Pressure, sensor.name.clone()));
        let (sensors, channels) = found.into_iter().unzip();
        Ok(Self { sensors, channels, typical: true })
    }

    /// Names of the sensors.
    pub(super) fn names(&self) -> Vec<String> {
        self.sensors.iter().map(|sensor| sensor.name.clone()).collect()
    }

    /// Readings of a row in the order of the sensors.
    pub(super) fn readings<'a>(&'a self, row: &'a Row) -> impl Iterator<Item = f64> + 'a {
        self.channels.iter().map(|&channel| row.readings[channel])
    }

    /// Channel of the first sensor of a quantity.
    pub(super) fn first_of(&self, quantity: Quantity) -> Option<usize> {
        let index = self.sensors.iter().position(|sensor| sensor.quantity() == quantity)?;
        Some(self.channels[index])
    }

    /// Standard deviation of what the first transmitter is off by all the time, Pa; 0 without one.
    pub(super) fn pressure_offset_sd_pa(&self) -> f64 {
        let transmitter = self.sensors.iter().find(|sensor| sensor.quantity() == Quantity::Pressure);
        transmitter.map_or(0.0, Sensor::offset_sd)
    }

    /// Mean of a row's temperatures, K; 15 °C where it has none.
    pub(super) fn mean_temperature_k(&self, row: Option<&Row>) -> f64 {
        let Some(row) = row else { return 288.15 };
        let readings = self.sensors.iter().zip(self.readings(row));
        let known: Vec<f64> = readings
            .filter(|(sensor, reading)| sensor.quantity() == Quantity::Temperature && reading.is_finite())
            .map(|(_, reading)| reading)
            .collect();
        if known.is_empty() { 288.15 } else { known.iter().sum::<f64>() / known.len() as f64 }
    }
}

/// The typical sensor of a column, or why it is not used without a file of sensors; `outside`: there are thermometers on the outside.
fn typical(channel: &Channel, vessel: &Vessel, outside: bool) -> Result<Sensor, String> {
    let name = channel.name.as_str();
    if name == "ambient" {
        return Err("the air at a sensor is not the air at the cylinder; --sensors takes it".to_owned());
    }
    // `gas_mean` is no place where a thermometer could be.
    if name.starts_with("gas_") && (outside || name == "gas_mean") {
        return Err("inside the gas; --sensors takes it".to_owned());
    }
    let sensor = Sensor::typical(name).map_err(|_| "its place is unknown; --sensors says it".to_owned())?;
    if sensor.quantity() != channel.quantity {
        return Err("its unit is of another quantity".to_owned());
    }
    match sensor.misfit(vessel) {
        Some(needs) => Err(format!("the vessel does not have {needs}")),
        None => Ok(sensor),
    }
}

/// Reads a file of sensors.
pub(super) fn read(inputs: &Inputs, path: &Path) -> anyhow::Result<Vec<Sensor>> {
    Ok(read_specification(inputs, path)?.1)
}

/// Reads a file of sensors as it is written, too.
pub(super) fn read_specification(inputs: &Inputs, path: &Path) -> anyhow::Result<(SensorsSpec, Vec<Sensor>)> {
    let name = path.to_string_lossy();
    let (specification, suite) = read_sensors(&inputs.read(&name)?, &name)?;
    Ok((specification, suite.sensors().to_vec()))
}
