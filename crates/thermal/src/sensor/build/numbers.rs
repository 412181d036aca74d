//! How far a sensor may be off.
use super::Table;
use crate::ThermalError;
use crate::document::check;
use crate::sensor::{CorrelatedNoise, Pt100Class, Stated};

impl Table<'_> {
    pub(super) fn lag_s(&self) -> Result<f64, ThermalError> {
        let remedy = "give the time constant, e.g. lag_s = 20, or leave it out";
        let lag_s = self.spec.lag_s.unwrap_or(0.0);
        check::within(&self.at("lag_s"), lag_s, (0.0, 86_400.0), "between 0 and 1 d", remedy)
    }

    /// A standard deviation, tolerance or step: 0 where it is not stated.
    pub(super) fn size(&self, field: &str, value: Option<f64>) -> Result<f64, ThermalError> {
        check::not_negative(
            &self.at(field),
            value.unwrap_or(0.0),
            "it is a size without a sign; leave it out for none",
        )
    }

    pub(super) fn offset_k(&self) -> Result<Stated, ThermalError> {
        let spec = self.spec;
        let value = spec.offset_k.unwrap_or(0.0);
        match (spec.class, spec.offset_tolerance_k, spec.offset_sd_k) {
            (Some(_), Some(_), _) => Err(self.two_tolerances("offset_tolerance_k", "class")),
            (Some(_), _, Some(_)) => Err(self.two_tolerances("offset_sd_k", "class")),
            (Some(class), None, None) => Ok(Stated::within(value, class.tolerance_k(Pt100Class::MIDDLE_K))),
            (None, tolerance, sd) => {
                self.offset(value, ("offset_tolerance_k", tolerance), ("offset_sd_k", sd))
            }
        }
    }

    pub(super) fn offset_pa(&self) -> Result<Stated, ThermalError> {
        let spec = self.spec;
        let tolerance = ("offset_tolerance_pa", spec.offset_tolerance_pa);
        self.offset(spec.offset_pa.unwrap_or(0.0), tolerance, ("offset_sd_pa", spec.offset_sd_pa))
    }

    fn offset(
        &self,
        value: f64,
        tolerance: (&str, Option<f64>),
        sd: (&str, Option<f64>),
    ) -> Result<Stated, ThermalError> {
        match (tolerance.1, sd.1) {
            (Some(_), Some(_)) => Err(self.two_tolerances(sd.0, "offset_tolerance")),
            (Some(limit), None) => Ok(Stated::within(value, self.size(tolerance.0, Some(limit))?)),
            (None, given) => Ok(Stated::normal(value, self.size(sd.0, given)?)),
        }
    }

    fn two_tolerances(&self, field: &str, other: &str) -> ThermalError {
        check::conflict(&self.at(field), other, "say in one way how far the offset may be off")
    }

    pub(super) fn air_coupling(&self) -> Result<Stated, ThermalError> {
        let remedy = "0 is a sensor in ideal contact, 0.15 to 0.2 a strapped one";
        let coupling = self.spec.air_coupling.unwrap_or(0.0);
        let coupling = check::fraction(&self.at("air_coupling"), coupling, remedy)?;
        let sd = self.spec.air_coupling_sd.unwrap_or(0.0);
        let sd = check::fraction(&self.at("air_coupling_sd"), sd, "0.04 is usual for strapped sensors")?;
        Ok(Stated::normal(coupling, sd))
    }

    pub(super) fn span(&self) -> Result<Stated, ThermalError> {
        let span = self.spec.span_ratio.unwrap_or(0.0);
        let (bound, remedy) = ("between -50 and 50 %", "a reading of 0.1 % too much is span_percent = 0.1");
        let span = check::within(&self.at("span_ratio"), span, (-0.5, 0.5), bound, remedy)?;
        Ok(Stated::normal(span, self.size("span_sd_ratio", self.spec.span_sd_ratio)?))
    }

    pub(super) fn walk(&self, is_pressure: bool) -> Result<f64, ThermalError> {
        let spec = self.spec;
        let (field, sd) =
            if is_pressure { ("walk_sd_pa", spec.walk_sd_pa) } else { ("walk_sd_k", spec.walk_sd_k) };
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

    pub(super) fn correlated(&self, is_pressure: bool) -> Result<Option<CorrelatedNoise>, ThermalError> {
        let spec = self.spec;
        let (field, sd) = match is_pressure {
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

    pub(super) fn dropout(&self) -> Result<f64, ThermalError> {
        let remedy = "0.01 loses one reading of a hundred";
        check::fraction(&self.at("dropout"), self.spec.dropout.unwrap_or(0.0), remedy)
    }
}
