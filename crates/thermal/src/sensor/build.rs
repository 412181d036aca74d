//! From `[[sensor]]` tables to checked sensors: what they have in common. What a kind has of its own is in its file.
use super::kind::{Kind, StatedKind};
use super::parameter::{Parameter, ParameterKind};
use super::spec::{KeyOf, SensorSpec};
use super::{CorrelatedNoise, MountedSensor, Pt100Class, Quantity};
use crate::ThermalError;
use crate::document::check;
use crate::units::ZERO_CELSIUS_K;

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
        table.name()?;
        table.refuse_foreign(stated)?;
        let kind = (stated.build)(&table)?;
        let lag_s = table.lag_s()?;
        let offset = if table.is_pressure { table.offset_pa()? } else { table.offset_k()? };
        let mut parameters = vec![offset];
        parameters.extend((stated.parameters)(&table)?);
        parameters[0].walk_per_sqrt_s = table.walk()?;
        Ok(MountedSensor {
            name: self.name.clone(),
            kind,
            lag_s,
            parameters,
            drift_per_s: self.drift_k_s.or(self.drift_pa_s).unwrap_or(0.0),
            noise: table.size("noise_k", self.noise_k)? + table.size("noise_pa", self.noise_pa)?,
            correlated: table.correlated()?,
            resolution: table.size("resolution_k", self.resolution_k)?
                + table.size("resolution_pa", self.resolution_pa)?,
            dropout: table.fraction("dropout", self.dropout, "0.01 loses one reading of a hundred")?,
            plausible: table.plausible((stated.plausible)(&kind))?,
        })
    }
}

/// A table with its path.
pub(super) struct Table<'a> {
    pub(super) spec: &'a SensorSpec,
    path: &'a str,
    is_pressure: bool,
}

impl Table<'_> {
    pub(super) fn at(&self, field: &str) -> String {
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

    /// Height above the outer bottom, m.
    pub(super) fn height_m(&self) -> Result<Option<f64>, ThermalError> {
        let Some(height_m) = self.spec.height_m else { return Ok(None) };
        let remedy = "it counts from the outer bottom";
        check::within(&self.at("height_m"), height_m, (0.0, 50.0), "between 0 and 50 m", remedy).map(Some)
    }

    /// A part of the whole: 0 where it is not stated.
    pub(super) fn fraction(
        &self,
        field: &str,
        value: Option<f64>,
        remedy: &str,
    ) -> Result<f64, ThermalError> {
        check::fraction(&self.at(field), value.unwrap_or(0.0), remedy)
    }

    /// A standard deviation, tolerance or step: 0 where it is not stated.
    pub(super) fn size(&self, field: &str, value: Option<f64>) -> Result<f64, ThermalError> {
        let remedy = "it is a size without a sign; leave it out for none";
        check::not_negative(&self.at(field), value.unwrap_or(0.0), remedy)
    }

    fn lag_s(&self) -> Result<f64, ThermalError> {
        let remedy = "give the time constant, e.g. lag_s = 20, or leave it out";
        let lag_s = self.spec.lag_s.unwrap_or(0.0);
        check::within(&self.at("lag_s"), lag_s, (0.0, 86_400.0), "between 0 and 1 d", remedy)
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
        tolerance: (&str, Option<f64>),
        sd: (&str, Option<f64>),
    ) -> Result<Parameter, ThermalError> {
        let kind = ParameterKind::Offset;
        match (tolerance.1, sd.1) {
            (Some(_), Some(_)) => Err(self.two_tolerances(sd.0, "offset_tolerance")),
            (Some(limit), None) => Ok(Parameter::within(kind, value, self.size(tolerance.0, Some(limit))?)),
            (None, given) => Ok(Parameter::normal(kind, value, self.size(sd.0, given)?)),
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
            (Some(_), Some(time_s)) => Ok(Some(CorrelatedNoise {
                sd: self.size(field, sd)?,
                time_s: check::positive(&self.at("correlation_time_s"), time_s, remedy)?,
            })),
        }
    }

    fn plausible(&self, (low, high): (f64, f64)) -> Result<(f64, f64), ThermalError> {
        if self.is_pressure {
            return Ok((low, high));
        }
        let low = check::temperature_k(&self.at("lowest_k"), self.spec.lowest_k.unwrap_or(low))?;
        let high = check::temperature_k(&self.at("highest_k"), self.spec.highest_k.unwrap_or(high))?;
        if high <= low {
            let bound = format!("above the lowest reading of {:.2} degC", low - ZERO_CELSIUS_K);
            let remedy = "a reading outside of these is taken for a fault";
            return Err(check::broken(&self.at("highest_k"), high, &bound, remedy));
        }
        Ok((low, high))
    }
}
