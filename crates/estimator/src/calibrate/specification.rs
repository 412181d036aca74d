//! A calibrated vessel as a file: the factors in the fields that they belong to.
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::sensor::{KindChoice, SensorSpec};
use cylwatch_thermal::vessel::VesselSpec;
use cylwatch_thermal::vessel::spec::{FittedSpec, LawChoice, PriorSpec};

use super::{Calibrated, Estimate, ParameterKind, Prior, Scope};
use crate::sensor::SensorsSpec;

impl Calibrated {
    /// The content of a vessel file with the factors that were fitted to the vessel of an experiment. Whatever the file says
    /// otherwise stays, and what it left to its defaults is written out where a factor acts on it.
    ///
    /// # Errors
    /// [`ThermalError::Specification`] for a file that is wrong, or that a factor carries beyond a bound.
    pub fn applied_to_specification(
        &self,
        experiment: usize,
        specification: &VesselSpec,
    ) -> Result<VesselSpec, ThermalError> {
        let mut changed = specification.clone();
        for estimate in self.estimates.iter().filter(|estimate| estimate.scope.contains(experiment)) {
            apply(&mut changed, &estimate.parameter, estimate.value)?;
        }
        changed.build()?;
        Ok(changed)
    }

    /// The content of a file of sensors with the numbers that were fitted to the sensors of an experiment, as means with standard
    /// deviations: what is known of them from now on. What belongs together (two offsets whose difference is known better
    /// than either) is written as if it did not.
    pub fn applied_to_sensors(&self, experiment: usize, sensors: &SensorsSpec) -> SensorsSpec {
        let mut changed = sensors.clone();
        for estimate in self.estimates.iter().filter(|estimate| estimate.scope.contains(experiment)) {
            for sensor in changed.sensor.iter_mut().filter(|sensor| is_of(sensor, &estimate.parameter)) {
                know(sensor, estimate, self.is_of_pressure(estimate));
            }
        }
        changed
    }

    /// The estimates as lines of a vessel file's record, in SI; `sources` are the names of the logs.
    pub fn fitted_specification(&self, sources: &[String]) -> Vec<FittedSpec> {
        let prior_of = |index: usize| self.fit.specs[index].prior;
        let line =
            |(index, estimate)| fitted(estimate, prior_of(index), self.is_of_pressure(estimate), sources);
        self.estimates.iter().enumerate().map(line).collect()
    }

    /// Whether an estimate is a number of a pressure sensor.
    pub fn is_of_pressure(&self, estimate: &Estimate) -> bool {
        self.fit.cases.iter().any(|case| case.base.is_of_pressure(&estimate.parameter))
    }
}

fn fitted(estimate: &Estimate, prior: Option<Prior>, is_pressure: bool, sources: &[String]) -> FittedSpec {
    let of_log = match &estimate.scope {
        Scope::Only(these) if these.len() < sources.len() => {
            let names: Vec<&str> = these.iter().filter_map(|&i| sources.get(i)).map(String::as_str).collect();
            Some(names.join(", "))
        }
        _ => None,
    };
    FittedSpec {
        parameter: estimate.parameter.name(),
        of_log,
        unit: estimate.parameter.si_unit(is_pressure).to_owned(),
        value: estimate.value,
        sd: estimate.sd,
        low: estimate.interval.0,
        high: estimate.interval.1,
        prior: prior.map(|Prior { mean, sd }| PriorSpec { mean, sd }),
    }
}

fn is_of(sensor: &SensorSpec, kind: &ParameterKind) -> bool {
    match kind {
        ParameterKind::AirOffset => sensor.kind_or_default() == KindChoice::Ambient,
        kind => kind.sensor() == Some(sensor.name.as_str()),
    }
}

/// Writes a sensor's number into its fields.
fn know(sensor: &mut SensorSpec, estimate: &Estimate, is_pressure: bool) {
    let (value, sd) = (Some(estimate.value), Some(estimate.sd));
    match estimate.parameter {
        ParameterKind::SensorOffset { .. } if is_pressure => {
            (sensor.offset_pa, sensor.offset_sd_pa, sensor.offset_tolerance_pa) = (value, sd, None);
        }
        ParameterKind::SensorOffset { .. } | ParameterKind::AirOffset => {
            (sensor.offset_k, sensor.offset_sd_k, sensor.offset_tolerance_k) = (value, sd, None);
            sensor.class = None;
        }
        ParameterKind::SensorCoupling { .. } => {
            if let Some([of_value, of_sd]) = sensor.coupling_mut() {
                (*of_value, *of_sd) = (value, sd);
            }
        }
        ParameterKind::SensorSpan { .. } => (sensor.span_ratio, sensor.span_sd_ratio) = (value, sd),
        ParameterKind::SensorTemperatureCoefficient { .. } => {
            (sensor.temperature_coefficient_pa_k, sensor.temperature_coefficient_sd_pa_k) = (value, sd);
        }
        ParameterKind::SensorLag { .. } => sensor.lag_s = value,
        _ => {}
    }
}

/// Multiplies what a parameter stands for.
fn apply(spec: &mut VesselSpec, kind: &ParameterKind, factor: f64) -> Result<(), ThermalError> {
    let scaled = |field: &mut Option<f64>, default: f64| *field = Some(factor * field.unwrap_or(default));
    match kind {
        ParameterKind::OutsideFilm => scaled(&mut spec.surface.film_factor, 1.0),
        ParameterKind::InsideFilm if spec.inside_film.law == LawChoice::Coefficient => {
            spec.inside_film.film_w_m2_k = spec.inside_film.film_w_m2_k.map(|film| factor * film);
        }
        ParameterKind::InsideFilm => scaled(&mut spec.inside_film.multiplier, 1.0),
        ParameterKind::JetFilm => scaled(&mut spec.inside_film.jet_multiplier, 1.0),
        ParameterKind::WallCapacity => {
            for layer in &mut spec.layer {
                scaled(&mut layer.heat_capacity_factor, 1.0);
            }
        }
        ParameterKind::ValveCapacity => {
            if let Some(valve) = &mut spec.valve {
                scaled(&mut valve.heat_capacity_factor, 1.0);
            }
        }
        ParameterKind::ValveContact => {
            let contact_w_k = spec.build()?.valve.map(|valve| valve.contact_w_k);
            if let (Some(valve), Some(contact_w_k)) = (&mut spec.valve, contact_w_k) {
                valve.contact_w_k = Some(factor * contact_w_k);
            }
        }
        ParameterKind::Volume => {
            let volume_m3 = spec.build()?.volume.volume_m3;
            spec.volume.volume_m3 = Some(factor * volume_m3);
        }
        _ => {}
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::apply::apply_to_vessel;
    use approx::assert_relative_eq;
    use cylwatch_thermal::vessel::{InsideFilm, Vessel, presets, read_specification};

    const KINDS: [ParameterKind; 7] = [
        ParameterKind::OutsideFilm,
        ParameterKind::InsideFilm,
        ParameterKind::JetFilm,
        ParameterKind::WallCapacity,
        ParameterKind::ValveCapacity,
        ParameterKind::ValveContact,
        ParameterKind::Volume,
    ];

    /// Every number that a factor may act on.
    fn numbers(vessel: &Vessel) -> Vec<f64> {
        let inside = match vessel.inside_film {
            InsideFilm::Rayleigh { multiplier, .. } => multiplier,
            InsideFilm::Coefficient { film_w_m2_k } => film_w_m2_k,
        };
        let valve = vessel.valve.as_ref().map(|valve| [valve.capacity_j_k(), valve.contact_w_k]);
        let walls = vessel.geometry.layers.iter().map(|layer| layer.material.heat_capacity_j_kg_k);
        let single = [inside, vessel.jet_film_factor, vessel.surface.film_factor, vessel.volume.volume_m3];
        single.into_iter().chain(valve.into_iter().flatten()).chain(walls).collect()
    }

    #[test]
    fn a_written_and_read_vessel_has_the_factors_of_the_calibrated_one() {
        for name in presets::FILES.names() {
            let (spec, vessel) = read_specification(presets::FILES.text(name).unwrap(), name).unwrap();
            for (k, kind) in KINDS.iter().enumerate() {
                let factor = 1.03 + 0.01 * k as f64;
                let (mut changed, mut expected) = (spec.clone(), vessel.clone());
                // Twice: a calibrated file can be calibrated again.
                for _ in 0..2 {
                    apply(&mut changed, kind, factor).unwrap();
                    apply_to_vessel(&mut expected, kind, factor);
                }
                let (_, read) = read_specification(&changed.to_toml().unwrap(), name).unwrap();
                for (found, expected) in numbers(&read).into_iter().zip(numbers(&expected)) {
                    assert_relative_eq!(found, expected, max_relative = 1e-12);
                }
                let moved =
                    numbers(&read).iter().zip(numbers(&vessel)).any(|(a, b)| (a / b - 1.0).abs() > 0.05);
                let has = vessel.valve.is_some()
                    || !matches!(kind, ParameterKind::ValveCapacity | ParameterKind::ValveContact);
                assert_eq!(moved, has, "{name}: {kind}");
            }
        }
    }
}
