//! What a sensor reads, and where; which readings can be.
use super::{Table, cell_of};
use crate::ThermalError;
use crate::document::check;
use crate::sensor::spec::KindChoice;
use crate::sensor::{GasPlace, PLACES, PressureReference, SensorKind, SurfacePlace};
use crate::units::{ATMOSPHERE_PA, ZERO_CELSIUS_K};

/// Lowest and highest temperature outside that can be a reading, K: colder than the coldest weather, hotter than
/// any cylinder may become.
const OUTSIDE_K: (f64, f64) = (183.15, 423.15);

/// The same in the gas, K: blowdown and fast filling.
const INSIDE_K: (f64, f64) = (93.15, 603.15);

/// Range of a transmitter's signal as parts of its full scale: 3.8 to 20.5 mA of 4 to 20 mA (NAMUR NE 43).
const SIGNAL_RANGE: (f64, f64) = (-0.0125, 1.03125);

/// Highest absolute pressure that can be a reading where a transmitter has no full scale, Pa.
const PRESSURE_MAX_PA: f64 = check::PRESSURE_RANGE_PA.1;

impl Table<'_> {
    pub(super) fn kind(&self, choice: KindChoice) -> Result<SensorKind, ThermalError> {
        Ok(match choice {
            KindChoice::Surface => SensorKind::Surface { place: self.surface_place()? },
            KindChoice::Pressure => self.transmitter()?,
            KindChoice::Gas => SensorKind::Gas { place: self.gas_place()? },
            KindChoice::Ambient => SensorKind::Ambient,
        })
    }

    fn height_m(&self) -> Result<Option<f64>, ThermalError> {
        let Some(height_m) = self.spec.height_m else { return Ok(None) };
        let remedy = "it counts from the outer bottom";
        check::within(&self.at("height_m"), height_m, (0.0, 50.0), "between 0 and 50 m", remedy).map(Some)
    }

    fn surface_place(&self) -> Result<SurfacePlace, ThermalError> {
        let spec = self.spec;
        if let Some(height_m) = self.height_m()? {
            if spec.place.is_some() {
                return Err(check::conflict(&self.at("height_m"), "place", "say in one way where it sits"));
            }
            return Ok(SurfacePlace::Height { height_m });
        }
        let (field, name) = match &spec.place {
            Some(place) => ("place", place.as_str()),
            None => ("name", spec.name.strip_prefix("wall_").unwrap_or(&spec.name)),
        };
        SurfacePlace::named(name).ok_or_else(|| check::unknown(&self.at(field), name, PLACES))
    }

    fn gas_place(&self) -> Result<GasPlace, ThermalError> {
        let spec = self.spec;
        if let Some(height_m) = self.height_m()? {
            if spec.cell.is_some() {
                return Err(check::conflict(&self.at("height_m"), "cell", "say in one way where it hangs"));
            }
            return Ok(GasPlace::Height { height_m });
        }
        let remedy = "say where it hangs: cell = 1 is the lowest cell of the gas, or height_mm = 400";
        match (spec.cell, cell_of(&spec.name)) {
            (Some(0), _) => Err(check::broken(&self.at("cell"), 0, "at least 1", remedy)),
            (None, Some(0)) => {
                let remedy = "gas_1 is the lowest cell of the gas";
                Err(check::broken(&self.at("name"), &spec.name, "numbered from 1", remedy))
            }
            (Some(number), _) | (None, Some(number)) => Ok(GasPlace::Cell { number }),
            (None, None) => Err(check::missing(&self.at("cell"), remedy)),
        }
    }

    fn transmitter(&self) -> Result<SensorKind, ThermalError> {
        let spec = self.spec;
        let full_scale_pa = match spec.full_scale_pa {
            Some(full_scale_pa) => {
                let (bound, remedy) =
                    ("between 1 Pa and 2000 bar", "it is the upper end of the range, e.g. 250 bar");
                let range = check::PRESSURE_RANGE_PA;
                Some(check::within(&self.at("full_scale_pa"), full_scale_pa, range, bound, remedy)?)
            }
            None => None,
        };
        let reference = if spec.gauge == Some(true) {
            let range = (-500.0, 11_000.0);
            let (bound, remedy) = ("between -500 m and 11 km", "it gives the air's pressure after ISO 2533");
            let altitude_m = spec.altitude_m.unwrap_or(0.0);
            let altitude_m = check::within(&self.at("altitude_m"), altitude_m, range, bound, remedy)?;
            PressureReference::Gauge { atmosphere_pa: atmosphere_pa(altitude_m) }
        } else if spec.altitude_m.is_some() {
            let remedy =
                "an absolute transmitter reads the same at every altitude; for another one say gauge = true";
            return Err(check::conflict(&self.at("altitude_m"), "an absolute transmitter", remedy));
        } else {
            PressureReference::Absolute
        };
        Ok(SensorKind::Pressure { reference, full_scale_pa })
    }

    pub(super) fn plausible(&self, kind: &SensorKind) -> Result<(f64, f64), ThermalError> {
        let (low, high) = match *kind {
            SensorKind::Pressure { reference, full_scale_pa } => {
                let zero_pa = reference.zero_pa();
                let of_scale =
                    |scale: f64| (zero_pa + SIGNAL_RANGE.0 * scale, zero_pa + SIGNAL_RANGE.1 * scale);
                return Ok(full_scale_pa.map_or((-ATMOSPHERE_PA, PRESSURE_MAX_PA), of_scale));
            }
            SensorKind::Gas { .. } => INSIDE_K,
            SensorKind::Surface { .. } | SensorKind::Ambient => OUTSIDE_K,
        };
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

/// Pressure of the standard atmosphere at an altitude up to 11 km, Pa: `p_0 (1 - L h / T_0)^(g / (R L))`.
///
/// # References
/// ISO 2533:1975, Standard atmosphere.
fn atmosphere_pa(altitude_m: f64) -> f64 {
    let (lapse_k_m, zero_k, gravity_m_s2, gas_constant_j_kg_k) = (0.0065, 288.15, 9.806_65, 287.052_87);
    ATMOSPHERE_PA
        * (1.0 - lapse_k_m * altitude_m / zero_k).powf(gravity_m_s2 / (gas_constant_j_kg_k * lapse_k_m))
}

#[cfg(test)]
mod tests {
    use super::atmosphere_pa;

    /// As ISO 2533 tabulates it against geopotential altitude.
    #[test]
    fn the_air_pressure_is_that_of_the_standard_atmosphere() {
        for (altitude_m, printed_pa) in
            [(0.0, 101_325.0), (1e3, 89_874.6), (2e3, 79_495.2), (5e3, 54_019.9), (11e3, 22_632.0)]
        {
            let found = atmosphere_pa(altitude_m);
            assert!((found - printed_pa).abs() < 0.1, "{altitude_m} m: {found}");
        }
    }
}
