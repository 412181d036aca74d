//! From `[[sensor]]` tables to checked sensors.
mod foreign;
mod kind;
mod numbers;

use super::spec::{KindChoice, SensorSpec};
use super::{MountedSensor, Stated};
use crate::ThermalError;
use crate::document::check;

/// Checks the sensors of a document; `table` is their path in it, e.g. `sensor`.
///
/// # Errors
/// [`ThermalError::Specification`] with the path of the first value that breaks a bound, and for two sensors of one
/// name.
pub fn mounted(specs: &[SensorSpec], table: &str) -> Result<Vec<MountedSensor>, ThermalError> {
    let mut sensors: Vec<MountedSensor> = Vec::new();
    for (i, spec) in specs.iter().enumerate() {
        let sensor = spec.build(&format!("{table}[{i}]"))?;
        if sensors.iter().any(|other| other.name == sensor.name) {
            let text = format!("{:?}", spec.name);
            let (bound, remedy) =
                ("a name that no other sensor has", "columns tell sensors apart by their names");
            return Err(check::broken(&format!("{table}[{i}].name"), text, bound, remedy));
        }
        sensors.push(sensor);
    }
    Ok(sensors)
}

impl SensorSpec {
    /// Checks the specification and fills in its defaults; `path` is that of its table, e.g. `sensor[0]`.
    ///
    /// # Errors
    /// [`ThermalError::Specification`] with the path of the first value that breaks a bound or does not belong to this
    /// kind of sensor.
    pub fn build(&self, path: &str) -> Result<MountedSensor, ThermalError> {
        let table = Table { spec: self, path };
        table.name()?;
        let choice = self.kind_or_default();
        table.refuse_foreign(choice)?;
        let kind = table.kind(choice)?;
        let is_pressure = choice == KindChoice::Pressure;
        Ok(MountedSensor {
            name: self.name.clone(),
            kind,
            lag_s: table.lag_s()?,
            offset: if is_pressure { table.offset_pa()? } else { table.offset_k()? },
            air_coupling: table.air_coupling()?,
            temperature_coefficient_pa_k: Stated::normal(
                self.temperature_coefficient_pa_k.unwrap_or(0.0),
                table.size("temperature_coefficient_sd_pa_k", self.temperature_coefficient_sd_pa_k)?,
            ),
            span: table.span()?,
            walk_per_sqrt_s: table.walk(is_pressure)?,
            drift_per_s: self.drift_k_s.or(self.drift_pa_s).unwrap_or(0.0),
            noise: table.size("noise_k", self.noise_k)? + table.size("noise_pa", self.noise_pa)?,
            correlated: table.correlated(is_pressure)?,
            resolution: table.size("resolution_k", self.resolution_k)?
                + table.size("resolution_pa", self.resolution_pa)?,
            dropout: table.dropout()?,
            plausible: table.plausible(&kind)?,
        })
    }

    /// What the sensor reads: as stated, or as its name says.
    pub fn kind_or_default(&self) -> KindChoice {
        self.kind.unwrap_or(match self.name.as_str() {
            "pressure" => KindChoice::Pressure,
            "ambient" => KindChoice::Ambient,
            name if cell_of(name).is_some() => KindChoice::Gas,
            _ => KindChoice::Surface,
        })
    }
}

/// Number of the name `gas_<number>`.
fn cell_of(name: &str) -> Option<usize> {
    name.strip_prefix("gas_")?.parse().ok()
}

/// A table with its path.
struct Table<'a> {
    spec: &'a SensorSpec,
    path: &'a str,
}

impl Table<'_> {
    fn at(&self, field: &str) -> String {
        format!("{}.{field}", self.path)
    }

    fn name(&self) -> Result<(), ThermalError> {
        let name = &self.spec.name;
        let is_word = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        if name.is_empty() || !name.chars().all(is_word) {
            let remedy = "it becomes part of a column's name, e.g. measured_shoulder_degc";
            let text = format!("{name:?}");
            return Err(check::broken(&self.at("name"), text, "of the letters a-z, digits and _", remedy));
        }
        Ok(())
    }
}
