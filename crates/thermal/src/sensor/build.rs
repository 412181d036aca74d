//! From `[[sensor]]` tables to checked sensors: what they have in common. What a kind has of its own is in its file.
use super::kind::{Kind, StatedKind};
use super::parameter::{Parameter, ParameterKind};
use super::spec::{KeyOf, SensorSpec};
use super::table::Table;
use super::valid::{self, Bound};
use super::{CorrelatedNoise, MountedSensor, Pt100Class, Quantity};
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
        let Kind { quantity, stated, .. } = self.kind_or_default().kind();
        let table = Table { spec: self, path, is_pressure: *quantity == Quantity::Pressure };
        valid::name(path, &self.name)?;
        table.refuse_foreign(stated)?;
        let kind = (stated.build)(&table)?;
        let mut offset = if table.is_pressure { table.offset_pa()? } else { table.offset_k()? };
        offset.walk_per_sqrt_s = table.walk()?;
        let more =
            kind.parameters().skip(1).zip((stated.parameters)(self)).map(|((kind, _), [mean, sd])| {
                Parameter::normal(kind, mean.unwrap_or(0.0), sd.unwrap_or(0.0))
            });
        let (low, high) = (stated.plausible)(&kind);
        let sensor = MountedSensor {
            name: self.name.clone(),
            kind,
            lag_s: self.lag_s.unwrap_or(0.0),
            parameters: core::iter::once(offset).chain(more).collect(),
            drift_per_s: self.drift_k_s.or(self.drift_pa_s).unwrap_or(0.0),
            noise: self.noise_k.or(self.noise_pa).unwrap_or(0.0),
            correlated: table.correlated()?,
            resolution: self.resolution_k.or(self.resolution_pa).unwrap_or(0.0),
            dropout: self.dropout.unwrap_or(0.0),
            plausible: (self.lowest_k.unwrap_or(low), self.highest_k.unwrap_or(high)),
        };
        sensor.validate(path)?;
        Ok(sensor)
    }
}

impl Table<'_> {
    /// Keys of other kinds mean nothing here; a silent one would look as if it did.
    fn refuse_foreign(&self, kind: &StatedKind) -> Result<(), ThermalError> {
        for (key, of) in self.spec.stated_keys() {
            let (is_own, remedy) = match of {
                KeyOf::Temperature => (
                    !self.is_pressure,
                    "a pressure takes bar or another unit of pressure, and no class or range of temperature",
                ),
                KeyOf::Pressure => {
                    (self.is_pressure, "it belongs to pressure transmitters; a temperature takes _k")
                }
                KeyOf::Kind(remedy) => (kind.keys.contains(&key), remedy),
            };
            if !is_own {
                let stated = format!("kind = {}", kind.name);
                return Err(check::conflict(&self.at(key), &stated, remedy));
            }
        }
        Ok(())
    }

    /// A standard deviation, tolerance or step: 0 where it is not stated.
    fn size(&self, field: &'static str, value: Option<f64>) -> Result<f64, ThermalError> {
        let value = value.unwrap_or(0.0);
        Bound::size(field).check(self.path, value)?;
        Ok(value)
    }

    fn offset_k(&self) -> Result<Parameter, ThermalError> {
        let spec = self.spec;
        let value = spec.offset_k.unwrap_or(0.0);
        match (spec.class, spec.offset_tolerance_k, spec.offset_sd_k) {
            (Some(_), Some(_), _) => Err(self.two_tolerances("offset_tolerance_k", "class")),
            (Some(_), _, Some(_)) => Err(self.two_tolerances("offset_sd_k", "class")),
            (Some(class), None, None) => {
                Ok(Parameter::within(ParameterKind::Offset, value, class.tolerance_k(Pt100Class::MIDDLE_K)))
            }
            (None, tolerance, sd) => {
                self.offset(value, ("offset_tolerance_k", tolerance), ("offset_sd_k", sd))
            }
        }
    }

    fn offset_pa(&self) -> Result<Parameter, ThermalError> {
        let spec = self.spec;
        let tolerance = ("offset_tolerance_pa", spec.offset_tolerance_pa);
        self.offset(spec.offset_pa.unwrap_or(0.0), tolerance, ("offset_sd_pa", spec.offset_sd_pa))
    }

    fn offset(
        &self,
        value: f64,
        tolerance: (&'static str, Option<f64>),
        sd: (&str, Option<f64>),
    ) -> Result<Parameter, ThermalError> {
        let kind = ParameterKind::Offset;
        match (tolerance.1, sd.1) {
            (Some(_), Some(_)) => Err(self.two_tolerances(sd.0, "offset_tolerance")),
            (Some(limit), None) => Ok(Parameter::within(kind, value, self.size(tolerance.0, Some(limit))?)),
            (None, given) => Ok(Parameter::normal(kind, value, given.unwrap_or(0.0))),
        }
    }

    fn two_tolerances(&self, field: &str, other: &str) -> ThermalError {
        check::conflict(&self.at(field), other, "say in one way how far the offset may be off")
    }

    fn walk(&self) -> Result<f64, ThermalError> {
        let spec = self.spec;
        let (field, sd) =
            if self.is_pressure { ("walk_sd_pa", spec.walk_sd_pa) } else { ("walk_sd_k", spec.walk_sd_k) };
        let example = "say both, e.g. walk_sd_k = 0.05 in walk_time_d = 365";
        match (sd, spec.walk_time_s) {
            (None, None) => Ok(0.0),
            (None, Some(_)) => Err(check::missing(&self.at(field), example)),
            (Some(_), None) => Err(check::missing(&self.at("walk_time_s"), example)),
            (Some(_), Some(time_s)) => {
                let sd = self.size(field, sd)?;
                Ok(sd / check::positive(&self.at("walk_time_s"), time_s, example)?.sqrt())
            }
        }
    }

    fn correlated(&self) -> Result<Option<CorrelatedNoise>, ThermalError> {
        let spec = self.spec;
        let (field, sd) = match self.is_pressure {
            true => ("correlated_noise_pa", spec.correlated_noise_pa),
            false => ("correlated_noise_k", spec.correlated_noise_k),
        };
        let remedy = "correlated noise takes its size and its correlation time";
        match (sd, spec.correlation_time_s) {
            (None, None) => Ok(None),
            (None, Some(_)) => Err(check::missing(&self.at(field), remedy)),
            (Some(_), None) => Err(check::missing(&self.at("correlation_time_s"), remedy)),
            (Some(sd), Some(time_s)) => Ok(Some(CorrelatedNoise { sd, time_s })),
        }
    }
}
