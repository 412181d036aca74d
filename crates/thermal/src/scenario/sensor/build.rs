//! From `[[sensor]]` tables to checked sensors.
use super::spec::{KindChoice, SensorSpec};
use super::{
    CorrelatedNoise, GasPlace, MountedSensor, PLACES, PressureReference, Pt100Class, SensorKind, Stated,
    SurfacePlace,
};
use crate::ThermalError;
use crate::document::check;
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

    /// Keys of other kinds mean nothing here; a silent one would look as if it did.
    fn refuse_foreign(&self, choice: KindChoice) -> Result<(), ThermalError> {
        let (name, allowed) = match choice {
            KindChoice::Surface => ("kind = surface", [true, true, false, false, true]),
            KindChoice::Pressure => ("kind = pressure", [false, false, true, false, false]),
            KindChoice::Gas => ("kind = gas", [true, false, false, true, true]),
            KindChoice::Ambient => ("kind = ambient", [true, false, false, false, false]),
        };
        for (field, group) in self.stated_fields() {
            if !allowed[group as usize] {
                return Err(check::conflict(&self.at(field), name, group.remedy()));
            }
        }
        Ok(())
    }

    fn kind(&self, choice: KindChoice) -> Result<SensorKind, ThermalError> {
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
        match spec.cell.or(cell_of(&spec.name)) {
            Some(0) => Err(check::broken(&self.at("cell"), 0, "at least 1", remedy)),
            Some(number) => Ok(GasPlace::Cell { number }),
            None => Err(check::missing(&self.at("cell"), remedy)),
        }
    }

    fn transmitter(&self) -> Result<SensorKind, ThermalError> {
        let spec = self.spec;
        let full_scale_pa = match spec.full_scale_pa {
            Some(full_scale_pa) => Some(check::pressure_pa(&self.at("full_scale_pa"), full_scale_pa)?),
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

    fn lag_s(&self) -> Result<f64, ThermalError> {
        let remedy = "give the time constant, e.g. lag_s = 20, or leave it out";
        let lag_s = self.spec.lag_s.unwrap_or(0.0);
        check::within(&self.at("lag_s"), lag_s, (0.0, 86_400.0), "between 0 and 1 d", remedy)
    }

    /// A standard deviation, tolerance or step: 0 where it is not stated.
    fn size(&self, field: &str, value: Option<f64>) -> Result<f64, ThermalError> {
        check::not_negative(
            &self.at(field),
            value.unwrap_or(0.0),
            "it is a size without a sign; leave it out for none",
        )
    }

    fn offset_k(&self) -> Result<Stated, ThermalError> {
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

    fn offset_pa(&self) -> Result<Stated, ThermalError> {
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

    fn air_coupling(&self) -> Result<Stated, ThermalError> {
        let remedy = "0 is a sensor in ideal contact, 0.15 to 0.2 a strapped one";
        let coupling = self.spec.air_coupling.unwrap_or(0.0);
        let coupling = check::fraction(&self.at("air_coupling"), coupling, remedy)?;
        let sd = self.spec.air_coupling_sd.unwrap_or(0.0);
        let sd = check::fraction(&self.at("air_coupling_sd"), sd, "0.04 is usual for strapped sensors")?;
        Ok(Stated::normal(coupling, sd))
    }

    fn span(&self) -> Result<Stated, ThermalError> {
        let span = self.spec.span_ratio.unwrap_or(0.0);
        let (bound, remedy) = ("between -50 and 50 %", "a reading of 0.1 % too much is span_percent = 0.1");
        let span = check::within(&self.at("span_ratio"), span, (-0.5, 0.5), bound, remedy)?;
        Ok(Stated::normal(span, self.size("span_sd_ratio", self.spec.span_sd_ratio)?))
    }

    fn walk(&self, is_pressure: bool) -> Result<f64, ThermalError> {
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

    fn correlated(&self, is_pressure: bool) -> Result<Option<CorrelatedNoise>, ThermalError> {
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

    fn dropout(&self) -> Result<f64, ThermalError> {
        let remedy = "0.01 loses one reading of a hundred";
        check::fraction(&self.at("dropout"), self.spec.dropout.unwrap_or(0.0), remedy)
    }

    fn plausible(&self, kind: &SensorKind) -> Result<(f64, f64), ThermalError> {
        let (low, high) = match *kind {
            SensorKind::Pressure { reference, full_scale_pa } => {
                let zero_pa = match reference {
                    PressureReference::Absolute => 0.0,
                    PressureReference::Gauge { .. } => ATMOSPHERE_PA,
                };
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

/// Which kinds of sensor a key belongs to.
#[derive(Clone, Copy)]
enum Group {
    Temperature,
    Surface,
    Pressure,
    GasCell,
    Height,
}

impl Group {
    fn remedy(self) -> &'static str {
        match self {
            Self::Temperature => {
                "a pressure takes bar or another unit of pressure, and no class or range of temperature"
            }
            Self::Surface => "it belongs to surface sensors",
            Self::Pressure => "it belongs to pressure transmitters; a temperature takes _k",
            Self::GasCell => "it belongs to sensors in the gas",
            Self::Height => "it belongs to sensors on the surface and in the gas",
        }
    }
}

impl Table<'_> {
    /// The stated keys that do not belong to every kind.
    fn stated_fields(&self) -> impl Iterator<Item = (&'static str, Group)> {
        use Group::{GasCell, Height, Pressure, Surface, Temperature};
        let s = self.spec;
        [
            ("place", s.place.is_some(), Surface),
            ("height_m", s.height_m.is_some(), Height),
            ("cell", s.cell.is_some(), GasCell),
            ("air_coupling", s.air_coupling.is_some(), Surface),
            ("air_coupling_sd", s.air_coupling_sd.is_some(), Surface),
            ("offset_k", s.offset_k.is_some(), Temperature),
            ("offset_sd_k", s.offset_sd_k.is_some(), Temperature),
            ("offset_tolerance_k", s.offset_tolerance_k.is_some(), Temperature),
            ("class", s.class.is_some(), Temperature),
            ("noise_k", s.noise_k.is_some(), Temperature),
            ("correlated_noise_k", s.correlated_noise_k.is_some(), Temperature),
            ("resolution_k", s.resolution_k.is_some(), Temperature),
            ("drift_k_s", s.drift_k_s.is_some(), Temperature),
            ("walk_sd_k", s.walk_sd_k.is_some(), Temperature),
            ("lowest_k", s.lowest_k.is_some(), Temperature),
            ("highest_k", s.highest_k.is_some(), Temperature),
            ("offset_pa", s.offset_pa.is_some(), Pressure),
            ("offset_sd_pa", s.offset_sd_pa.is_some(), Pressure),
            ("offset_tolerance_pa", s.offset_tolerance_pa.is_some(), Pressure),
            ("span_ratio", s.span_ratio.is_some(), Pressure),
            ("span_sd_ratio", s.span_sd_ratio.is_some(), Pressure),
            ("temperature_coefficient_pa_k", s.temperature_coefficient_pa_k.is_some(), Pressure),
            ("temperature_coefficient_sd_pa_k", s.temperature_coefficient_sd_pa_k.is_some(), Pressure),
            ("noise_pa", s.noise_pa.is_some(), Pressure),
            ("correlated_noise_pa", s.correlated_noise_pa.is_some(), Pressure),
            ("resolution_pa", s.resolution_pa.is_some(), Pressure),
            ("drift_pa_s", s.drift_pa_s.is_some(), Pressure),
            ("walk_sd_pa", s.walk_sd_pa.is_some(), Pressure),
            ("full_scale_pa", s.full_scale_pa.is_some(), Pressure),
            ("gauge", s.gauge.is_some(), Pressure),
            ("altitude_m", s.altitude_m.is_some(), Pressure),
        ]
        .into_iter()
        .filter_map(|(field, stated, group)| stated.then_some((field, group)))
    }
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
