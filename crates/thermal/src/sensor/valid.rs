//! Bounds of a sensor. A `[[sensor]]` table is held to them, and so is a sensor that comes from anywhere else.
use super::{GasPlace, MountedSensor, Parameter, PressureReference, Quantity, SensorKind, SurfacePlace};
use crate::ThermalError;
use crate::bounds;
use crate::units::ZERO_CELSIUS_K;
use alloc::string::String;

/// What to say of a place in the gas that is none.
pub(super) const CELL_REMEDY: &str =
    "say where it hangs: cell = 1 is the lowest cell of the gas, or height_mm = 400";

/// Real pressures of the air from -500 m to 11 km after ISO 2533, Pa.
const ATMOSPHERES_PA: (f64, f64) = (2.2e4, 1.08e5);

/// What a number of a table may be.
pub(super) struct Bound {
    pub(super) key: &'static str,
    pub(super) range: (f64, f64),
    /// The range in words.
    pub(super) bound: &'static str,
    pub(super) remedy: &'static str,
}

impl Bound {
    /// Any number.
    pub(super) const fn any(key: &'static str) -> Self {
        Self { key, range: (-f64::MAX, f64::MAX), bound: "finite", remedy: "write a number or leave it out" }
    }

    /// A standard deviation, tolerance or step.
    pub(super) const fn size(key: &'static str) -> Self {
        let remedy = "it is a size without a sign; leave it out for none";
        Self { key, range: (0.0, f64::MAX), bound: "at least 0", remedy }
    }

    /// A part of the whole.
    pub(super) const fn fraction(key: &'static str, remedy: &'static str) -> Self {
        Self { key, range: (0.0, 1.0), bound: "between 0 and 1", remedy }
    }

    pub(super) fn check(&self, path: &str, value: f64) -> Result<(), ThermalError> {
        bounds::within(&format!("{path}.{}", self.key), value, self.range, self.bound, self.remedy)?;
        Ok(())
    }
}

/// Bounds of an uncertain number: of its mean and of its standard deviation.
pub(super) type Bounds = [Bound; 2];

const OFFSET_K: Bounds = [Bound::any("offset_k"), Bound::size("offset_sd_k")];
const OFFSET_PA: Bounds = [Bound::any("offset_pa"), Bound::size("offset_sd_pa")];

/// Checks a name.
pub(super) fn name(path: &str, name: &str) -> Result<(), ThermalError> {
    let is_word = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if name.is_empty() || !name.chars().all(is_word) {
        let remedy = "it becomes part of a column's name, e.g. measured_shoulder_degc";
        let (path, text) = (format!("{path}.name"), format!("{name:?}"));
        return Err(bounds::broken(&path, text, "of the letters a-z, digits and _", remedy));
    }
    Ok(())
}

impl MountedSensor {
    /// Checks every value; `path` is that of its table, e.g. `sensor[0]`.
    ///
    /// # Errors
    /// [`ThermalError::Specification`] with the path of the first value that breaks a bound.
    pub fn validate(&self, path: &str) -> Result<(), ThermalError> {
        name(path, &self.name)?;
        self.kind.validate(path)?;
        let is_pressure = self.kind.quantity() == Quantity::Pressure;
        let unit = if is_pressure { "pa" } else { "k" };
        let lag = Bound {
            key: "lag_s",
            range: (0.0, 86_400.0),
            bound: "between 0 and 1 d",
            remedy: "give the time constant, e.g. lag_s = 20, or leave it out",
        };
        lag.check(path, self.lag_s)?;
        self.validate_parameters(path, if is_pressure { &OFFSET_PA } else { &OFFSET_K })?;
        let at = |field: &str| format!("{path}.{field}_{unit}");
        let remedy = Bound::size("").remedy;
        bounds::not_negative(&at("noise"), self.noise, remedy)?;
        bounds::not_negative(&at("resolution"), self.resolution, remedy)?;
        Bound::any(if is_pressure { "drift_pa_s" } else { "drift_k_s" }).check(path, self.drift_per_s)?;
        if let Some(noise) = self.correlated {
            bounds::not_negative(&at("correlated_noise"), noise.sd, remedy)?;
            let remedy = "correlated noise takes its size and its correlation time";
            bounds::positive(&format!("{path}.correlation_time_s"), noise.time_s, remedy)?;
        }
        Bound::fraction("dropout", "0.01 loses one reading of a hundred").check(path, self.dropout)?;
        self.validate_plausible(is_pressure, &at)
    }

    /// The offset and the parameters of its kind, in their order, each within its bounds.
    fn validate_parameters(&self, path: &str, offset: &Bounds) -> Result<(), ThermalError> {
        let expected = self.kind.parameters();
        let kinds = self.parameters.iter().map(|parameter| parameter.kind);
        if !kinds.eq(expected.clone().map(|(kind, _)| kind)) {
            let names: String = expected.map(|(kind, _)| format!(" {kind:?}")).collect();
            let (path, found) = (format!("{path}.parameters"), self.parameters.len());
            return Err(bounds::broken(&path, found, &format!("these:{names}"), "make the sensor anew"));
        }
        for (parameter, (_, bounds)) in self.parameters.iter().zip(expected) {
            let Parameter { mean, sd, walk_per_sqrt_s, .. } = *parameter;
            let [of_mean, of_sd] = bounds.unwrap_or(offset);
            of_mean.check(path, mean)?;
            of_sd.check(path, sd)?;
            Bound::size("walk_sd").check(path, walk_per_sqrt_s)?;
        }
        Ok(())
    }

    fn validate_plausible(
        &self,
        is_pressure: bool,
        at: &impl Fn(&str) -> String,
    ) -> Result<(), ThermalError> {
        let (low, high) = self.plausible;
        let end = |field: &str, value: f64| {
            let path = at(field);
            if is_pressure {
                let remedy = "leave it to the full scale";
                return bounds::within(&path, value, (-f64::MAX, f64::MAX), "finite", remedy);
            }
            bounds::temperature_k(&path, value)
        };
        end("lowest", low)?;
        end("highest", high)?;
        if high <= low {
            let bound = if is_pressure {
                format!("above the lowest reading of {low} Pa")
            } else {
                format!("above the lowest reading of {:.2} degC", low - ZERO_CELSIUS_K)
            };
            let remedy = "a reading outside of these is taken for a fault";
            return Err(bounds::broken(&at("highest"), high, &bound, remedy));
        }
        Ok(())
    }
}

impl SensorKind {
    fn validate(&self, path: &str) -> Result<(), ThermalError> {
        match *self {
            Self::Surface { place: SurfacePlace::Height { height_m } }
            | Self::Gas { place: GasPlace::Height { height_m } }
            | Self::Immersion { place: GasPlace::Height { height_m } } => {
                let (range, bound) = ((0.0, 50.0), "between 0 and 50 m");
                Bound { key: "height_m", range, bound, remedy: "it counts from the outer bottom" }
                    .check(path, height_m)
            }
            Self::Gas { place: GasPlace::Cell { number: 0 } }
            | Self::Immersion { place: GasPlace::Cell { number: 0 } } => {
                Err(bounds::broken(&format!("{path}.cell"), 0, "at least 1", CELL_REMEDY))
            }
            Self::Pressure { reference, full_scale_pa } => {
                if let Some(scale_pa) = full_scale_pa {
                    let (range, bound) = (bounds::PRESSURE_RANGE_PA, "between 1 Pa and 2000 bar");
                    let remedy = "it is the upper end of the range, e.g. 250 bar";
                    Bound { key: "full_scale_pa", range, bound, remedy }.check(path, scale_pa)?;
                }
                let PressureReference::Gauge { atmosphere_pa } = reference else { return Ok(()) };
                let (range, bound) = (ATMOSPHERES_PA, "between 220 and 1080 mbar");
                Bound { key: "atmosphere_pa", range, bound, remedy: "it is the pressure of the real air" }
                    .check(path, atmosphere_pa)
            }
            Self::Surface { .. } | Self::Gas { .. } | Self::Immersion { .. } | Self::Ambient => Ok(()),
        }
    }
}
