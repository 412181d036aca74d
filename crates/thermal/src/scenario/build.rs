//! From the raw content of a scenario file to a checked [`Scenario`].
use super::flows;
use super::signal::{Files, Signal};
use super::spec::{AmbientSpec, InitialSpec, ScenarioSpec};
use super::{AxialVariation, Fill, Initial, OutsideFilm, Scenario, Series, Sun, Surroundings};
use crate::ThermalError;
use crate::document::check;
use crate::sensor;
use crate::units::{BAR_PA, Dimension, ZERO_CELSIUS_K};

/// Longest duration, s: ten years.
const DURATION_MAX_S: f64 = 3.2e8;

/// Most output samples of a scenario.
const SAMPLES_MAX: f64 = 2e7;

impl ScenarioSpec {
    /// Checks the specification, reads the files it names and fills in its defaults.
    ///
    /// # Errors
    /// [`ThermalError::Specification`] with the path of the first value that breaks a bound;
    /// [`ThermalError::Document`] for a line of a CSV file.
    pub(crate) fn build(&self, files: Files<'_>) -> Result<Scenario, ThermalError> {
        if self.name.trim().is_empty() {
            return Err(check::broken("name", "\"\"", "a name", "say what this scenario is called"));
        }
        let (duration_s, sample_time_s) = self.times()?;
        let air = air(&self.ambient);
        let air_k = air.series(files, duration_s)?.ok_or_else(|| {
            check::missing("ambient.air_k", "say the temperature of the air around the cylinder")
        })?;
        let before_k = air.first().unwrap_or_else(|| air_k.segment(-1.0, 0.0).value);
        Ok(Scenario {
            name: self.name.clone(),
            initial: initial(&self.initial, before_k)?,
            surroundings: self.surroundings(air_k, files, duration_s)?,
            flows: flows::build(self, files, duration_s)?,
            pressure_limits_pa: self
                .limits
                .pressure_pa
                .iter()
                .enumerate()
                .map(|(i, &pressure)| check::pressure_pa(&format!("limits.pressure_pa[{i}]"), pressure))
                .collect::<Result<_, _>>()?,
            sensors: sensor::mounted(&self.sensor, "sensor")?,
            duration_s,
            sample_time_s,
        })
    }

    fn times(&self) -> Result<(f64, f64), ThermalError> {
        let duration_s = check::positive("duration_s", self.duration_s, "say how long the scenario lasts")?;
        let range = (0.0, DURATION_MAX_S);
        check::within(
            "duration_s",
            duration_s,
            range,
            "at most ten years",
            "check the unit, _min, _h or _d",
        )?;
        let sample_s = self.sample_time_s.unwrap_or(60.0_f64.min(duration_s));
        let remedy = "give the interval of the output samples, e.g. sample_time_min = 1";
        check::positive("sample_time_s", sample_s, remedy)?;
        let range = (duration_s / SAMPLES_MAX, duration_s);
        let bound = format!("between {} s and the duration of {}", range.0, check::time_text(duration_s));
        Ok((duration_s, check::within("sample_time_s", sample_s, range, &bound, remedy)?))
    }

    fn surroundings(
        &self,
        air_k: Series,
        files: Files<'_>,
        duration_s: f64,
    ) -> Result<Surroundings, ThermalError> {
        let spec = &self.ambient;
        let series = |of: fn(&AmbientSpec) -> Signal<'_>| of(spec).series(files, duration_s);
        let (film, wind) = (series(film)?, series(wind)?);
        let (radiation, irradiance) = (series(radiation)?, series(irradiance)?);
        let is_coefficient = film.is_some();
        let film = match (film, wind) {
            (Some(_), Some(_)) => {
                let remedy = "give the film coefficient, or the wind that it is computed from";
                return Err(check::conflict("ambient.film_w_m2_k", "the wind", remedy));
            }
            (Some(film_w_m2_k), None) => {
                if spec.wind_multiplier.is_some() {
                    let remedy = "scale the coefficient itself";
                    return Err(check::conflict("ambient.wind_multiplier", "a film coefficient", remedy));
                }
                OutsideFilm::Coefficient { film_w_m2_k }
            }
            (None, wind) => {
                let multiplier = spec.wind_multiplier.unwrap_or(1.0);
                OutsideFilm::Convection {
                    wind_m_s: wind.unwrap_or_else(|| Series::constant(0.0)),
                    multiplier: check::positive(
                        "ambient.wind_multiplier",
                        multiplier,
                        "1 is the law as published",
                    )?,
                }
            }
        };
        let radiation_k = radiation.or_else(|| (!is_coefficient).then(|| air_k.clone()));
        Ok(Surroundings {
            air_k,
            film,
            radiation_k,
            sun: self.sun(irradiance)?,
            axial: AxialVariation::default(),
        })
    }

    fn sun(&self, irradiance: Option<Series>) -> Result<Option<Sun>, ThermalError> {
        let Some(irradiance_w_m2) = irradiance else {
            return match self.sun {
                Some(_) => {
                    Err(check::missing("ambient.irradiance_w_m2", "say how strong the sun of [sun] is"))
                }
                None => Ok(None),
            };
        };
        let spec = self.sun.clone().unwrap_or_default();
        let remedy = "fractions of the outer height count from 0 at the bottom to 1 at the top";
        let from_fraction = check::fraction("sun.from_fraction", spec.from_fraction.unwrap_or(0.0), remedy)?;
        let to_fraction = check::fraction("sun.to_fraction", spec.to_fraction.unwrap_or(1.0), remedy)?;
        if to_fraction <= from_fraction {
            let bound = format!("above from_fraction = {from_fraction}");
            return Err(check::broken("sun.to_fraction", to_fraction, &bound, remedy));
        }
        Ok(Some(Sun { irradiance_w_m2, from_fraction, to_fraction, valve: spec.valve.unwrap_or(true) }))
    }
}

fn air(spec: &AmbientSpec) -> Signal<'_> {
    Signal {
        of: "ambient",
        name: "air",
        dimension: Dimension::Temperature,
        constant: spec.air_k,
        changes: spec.air_change.iter().map(Into::into).collect(),
        table: spec.air_table.as_ref().map(|table| table.columns()),
        csv: spec.air_csv.as_ref(),
    }
}

fn film(spec: &AmbientSpec) -> Signal<'_> {
    Signal {
        of: "ambient",
        name: "film",
        dimension: Dimension::Film,
        constant: spec.film_w_m2_k,
        changes: spec.film_change.iter().map(Into::into).collect(),
        table: spec.film_table.as_ref().map(|table| table.columns()),
        csv: spec.film_csv.as_ref(),
    }
}

fn wind(spec: &AmbientSpec) -> Signal<'_> {
    Signal {
        of: "ambient",
        name: "wind",
        dimension: Dimension::Speed,
        constant: spec.wind_m_s,
        changes: spec.wind_change.iter().map(Into::into).collect(),
        table: spec.wind_table.as_ref().map(|table| table.columns()),
        csv: spec.wind_csv.as_ref(),
    }
}

fn radiation(spec: &AmbientSpec) -> Signal<'_> {
    Signal {
        of: "ambient",
        name: "radiation",
        dimension: Dimension::Temperature,
        constant: spec.radiation_k,
        changes: spec.radiation_change.iter().map(Into::into).collect(),
        table: spec.radiation_table.as_ref().map(|table| table.columns()),
        csv: spec.radiation_csv.as_ref(),
    }
}

fn irradiance(spec: &AmbientSpec) -> Signal<'_> {
    Signal {
        of: "ambient",
        name: "irradiance",
        dimension: Dimension::HeatFlux,
        constant: spec.irradiance_w_m2,
        changes: spec.irradiance_change.iter().map(Into::into).collect(),
        table: spec.irradiance_table.as_ref().map(|table| table.columns()),
        csv: spec.irradiance_csv.as_ref(),
    }
}

/// What fixes the gas mass: exactly one of settled fill, pressure and mass.
fn fill(spec: &InitialSpec) -> Result<Fill, ThermalError> {
    let fills = [
        ("initial.fill_pressure_pa", spec.fill_pressure_pa),
        ("initial.pressure_pa", spec.pressure_pa),
        ("initial.mass_kg", spec.mass_kg),
    ];
    let given: Vec<(&str, f64)> = fills.iter().filter_map(|&(path, value)| Some((path, value?))).collect();
    if let [(first, _), (second, _), ..] = given[..] {
        let other = first.trim_start_matches("initial.");
        return Err(check::conflict(second, other, "say the fill in one way"));
    }
    if spec.fill_temperature_k.is_some() && spec.fill_pressure_pa.is_none() {
        let remedy = "it belongs to fill_pressure; for other fills give temperature";
        return Err(check::conflict("initial.fill_temperature_k", "a fill without fill_pressure", remedy));
    }
    match given[..] {
        [(path @ "initial.mass_kg", mass_kg), ..] => {
            let remedy = "give the mass of the gas inside";
            check::positive(path, mass_kg, remedy)?;
            Ok(Fill::Mass { mass_kg: check::within(path, mass_kg, (0.0, 1e5), "at most 100 t", remedy)? })
        }
        [(path @ "initial.pressure_pa", pressure_pa), ..] => {
            Ok(Fill::Pressure { pressure_pa: check::pressure_pa(path, pressure_pa)? })
        }
        [(path, pressure_pa), ..] => {
            let temperature_k = spec.fill_temperature_k.unwrap_or(ZERO_CELSIUS_K + 15.0);
            let (bound, remedy) = ("at least 0.1 bar", "check the unit, _bar, _pa or _mpa");
            let range = (0.1 * BAR_PA, f64::MAX);
            Ok(Fill::Settled {
                pressure_pa: check::pressure_pa(
                    path,
                    check::within(path, pressure_pa, range, bound, remedy)?,
                )?,
                temperature_k: check::temperature_k("initial.fill_temperature_k", temperature_k)?,
            })
        }
        [] => {
            let remedy = "say how full the cylinder is: fill_pressure_bar at fill_temperature_degc, pressure_bar or mass_kg";
            Err(check::missing("initial.fill_pressure_pa", remedy))
        }
    }
}

fn initial(spec: &InitialSpec, air_k: f64) -> Result<Initial, ThermalError> {
    let fill = fill(spec)?;
    if let (Some(_), Some(_), Some(_)) = (spec.temperature_k, spec.wall_temperature_k, spec.gas_temperature_k)
    {
        let remedy = "leave it out, wall and gas are stated";
        return Err(check::conflict("initial.temperature_k", "wall_temperature and gas_temperature", remedy));
    }
    let both_k = check::temperature_k("initial.temperature_k", spec.temperature_k.unwrap_or(air_k))?;
    let wall_k = spec.wall_temperature_k.unwrap_or(both_k);
    let gas_k = spec.gas_temperature_k.unwrap_or(both_k);
    Ok(Initial {
        fill,
        wall_temperature_k: check::temperature_k("initial.wall_temperature_k", wall_k)?,
        gas_temperature_k: check::temperature_k("initial.gas_temperature_k", gas_k)?,
    })
}
