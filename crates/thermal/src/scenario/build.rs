//! From the raw content of a scenario file to a checked [`Scenario`].
use super::signal::{Files, Signal};
use super::spec::{AmbientSpec, InitialSpec, OutflowSpec, RefillSpec, ScenarioSpec, SensorSpec};
use super::{Fill, Initial, OutsideFilm, Scenario, Series, Sun, SurfaceSensor, Surroundings};
use crate::ThermalError;
use crate::document::check;
use crate::flow::{Flow, FlowKind};
use crate::units::{ATMOSPHERE_PA, Dimension, ZERO_CELSIUS_K};

/// Places that a surface sensor can sit at.
pub const PLACES: [&str; 5] = ["bottom", "middle", "shoulder", "neck", "valve"];

/// Longest duration, s: ten years.
const DURATION_MAX_S: f64 = 3.2e8;

/// Most output samples of a scenario.
const SAMPLES_MAX: f64 = 2e7;

/// Largest mass flow, kg/s.
const MASS_FLOW_MAX_KG_S: f64 = 100.0;

impl ScenarioSpec {
    /// Checks the specification, reads the files it names and fills in its defaults.
    ///
    /// # Errors
    /// [`ThermalError::Specification`] with the path of the first value that breaks a bound;
    /// [`ThermalError::Document`] for a line of a CSV file.
    pub fn build(&self, files: Files<'_>) -> Result<Scenario, ThermalError> {
        if self.name.trim().is_empty() {
            return Err(check::broken("name", "\"\"", "a name", "say what this scenario is called"));
        }
        let (duration_s, sample_time_s) = self.times()?;
        let air = air(&self.ambient);
        let air_k = air
            .series(files)?
            .ok_or_else(|| check::missing("ambient.air_k", "say the temperature of the air around the cylinder"))?;
        let before_k = air.first().unwrap_or_else(|| air_k.segment(-1.0, 0.0).value);
        Ok(Scenario {
            name: self.name.clone(),
            initial: initial(&self.initial, before_k)?,
            surroundings: self.surroundings(air_k, files)?,
            flows: self.flows()?,
            pressure_limits_pa: self
                .limits
                .pressure_pa
                .iter()
                .enumerate()
                .map(|(i, &pressure)| check::pressure_pa(&format!("limits.pressure_pa[{i}]"), pressure))
                .collect::<Result<_, _>>()?,
            sensors: sensors(&self.sensor)?,
            duration_s,
            sample_time_s,
        })
    }

    fn times(&self) -> Result<(f64, f64), ThermalError> {
        let duration_s = check::positive("duration_s", self.duration_s, "say how long the scenario lasts")?;
        let range = (0.0, DURATION_MAX_S);
        check::within("duration_s", duration_s, range, "at most ten years", "check the unit, _min, _h or _d")?;
        let sample_s = self.sample_time_s.unwrap_or(60.0_f64.min(duration_s));
        let remedy = "give the interval of the output samples, e.g. sample_time_min = 1";
        check::positive("sample_time_s", sample_s, remedy)?;
        let range = (duration_s / SAMPLES_MAX, duration_s);
        let bound = format!("between {} s and the duration of {duration_s} s", range.0);
        Ok((duration_s, check::within("sample_time_s", sample_s, range, &bound, remedy)?))
    }

    fn surroundings(&self, air_k: Series, files: Files<'_>) -> Result<Surroundings, ThermalError> {
        let spec = &self.ambient;
        let film = film(spec).series(files)?;
        let wind = wind(spec).series(files)?;
        let radiation = radiation(spec).series(files)?;
        let irradiance = irradiance(spec).series(files)?;
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
                    multiplier: check::positive("ambient.wind_multiplier", multiplier, "1 is the law as published")?,
                }
            }
        };
        let radiation_k = radiation.or_else(|| (!is_coefficient).then(|| air_k.clone()));
        Ok(Surroundings { air_k, film, radiation_k, sun: self.sun(irradiance)? })
    }

    fn sun(&self, irradiance: Option<Series>) -> Result<Option<Sun>, ThermalError> {
        let Some(irradiance_w_m2) = irradiance else {
            return match self.sun {
                Some(_) => Err(check::missing("ambient.irradiance_w_m2", "say how strong the sun of [sun] is")),
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

    fn flows(&self) -> Result<Vec<Flow>, ThermalError> {
        let mut flows: Vec<Flow> = Vec::new();
        let outflows = [("leak", &self.leak), ("discharge", &self.discharge)];
        for (kind, specs) in outflows {
            for (i, spec) in specs.iter().enumerate() {
                push(&mut flows, outflow(kind, i, spec)?, &format!("{kind}[{i}]"))?;
            }
        }
        for (i, spec) in self.refill.iter().enumerate() {
            push(&mut flows, refill(i, spec)?, &format!("refill[{i}]"))?;
        }
        Ok(flows)
    }
}

fn air(spec: &AmbientSpec) -> Signal<'_> {
    Signal {
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
        name: "irradiance",
        dimension: Dimension::HeatFlux,
        constant: spec.irradiance_w_m2,
        changes: spec.irradiance_change.iter().map(Into::into).collect(),
        table: spec.irradiance_table.as_ref().map(|table| table.columns()),
        csv: spec.irradiance_csv.as_ref(),
    }
}

fn initial(spec: &InitialSpec, air_k: f64) -> Result<Initial, ThermalError> {
    let fills = [
        ("initial.fill_pressure_pa", spec.fill_pressure_pa),
        ("initial.pressure_pa", spec.pressure_pa),
        ("initial.mass_kg", spec.mass_kg),
    ];
    let given: Vec<(&str, f64)> =
        fills.iter().filter_map(|&(path, value)| Some((path, value?))).collect();
    if let [(first, _), (second, _), ..] = given[..] {
        let other = first.trim_start_matches("initial.");
        return Err(check::conflict(second, other, "say the fill in one way"));
    }
    if spec.fill_temperature_k.is_some() && spec.fill_pressure_pa.is_none() {
        let remedy = "it belongs to fill_pressure; for other fills give temperature";
        return Err(check::conflict("initial.fill_temperature_k", "a fill without fill_pressure", remedy));
    }
    let fill = match given[..] {
        [(path @ "initial.mass_kg", mass_kg), ..] => {
            let remedy = "give the mass of the gas inside";
            check::positive(path, mass_kg, remedy)?;
            Fill::Mass { mass_kg: check::within(path, mass_kg, (0.0, 1e5), "at most 100 t", remedy)? }
        }
        [(path @ "initial.pressure_pa", pressure_pa), ..] => {
            Fill::Pressure { pressure_pa: check::pressure_pa(path, pressure_pa)? }
        }
        [(path, pressure_pa), ..] => {
            let temperature_k = spec.fill_temperature_k.unwrap_or(ZERO_CELSIUS_K + 15.0);
            Fill::Settled {
                pressure_pa: check::pressure_pa(path, pressure_pa)?,
                temperature_k: check::temperature_k("initial.fill_temperature_k", temperature_k)?,
            }
        }
        [] => {
            let remedy = "say how full the cylinder is: fill_pressure_bar at fill_temperature_degc, pressure_bar or mass_kg";
            return Err(check::missing("initial.fill_pressure_pa", remedy));
        }
    };
    if let (Some(_), Some(_), Some(_)) = (spec.temperature_k, spec.wall_temperature_k, spec.gas_temperature_k) {
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

fn outflow(kind: &str, i: usize, spec: &OutflowSpec) -> Result<Flow, ThermalError> {
    let path = |field: &str| format!("{kind}[{i}].{field}");
    let kind_of_flow = match (spec.flow_kg_s, spec.diameter_m) {
        (Some(_), Some(_)) => {
            return Err(check::conflict(&path("diameter_m"), "flow", "give the mass flow or the bore of a hole"));
        }
        (None, None) => {
            let remedy = "give a mass flow, e.g. flow_g_h = 20, or the bore of a hole, e.g. diameter_mm = 0.1";
            return Err(check::missing(&path("flow_kg_s"), remedy));
        }
        (Some(flow_kg_s), None) => {
            let orifice_only = [
                ("discharge_coefficient", spec.discharge_coefficient),
                ("back_pressure_pa", spec.back_pressure_pa),
            ];
            if let Some((field, _)) = orifice_only.iter().find(|(_, value)| value.is_some()) {
                return Err(check::conflict(&path(field), "flow", "it belongs to an orifice of some diameter"));
            }
            FlowKind::Leak { mass_flow_kg_s: mass_flow(&path("flow_kg_s"), flow_kg_s)? }
        }
        (None, Some(diameter_m)) => FlowKind::Orifice {
            diameter_m: bore(&path("diameter_m"), diameter_m)?,
            discharge_coefficient: {
                let coefficient = spec.discharge_coefficient.unwrap_or(0.8);
                let remedy = "0.6 to 0.9 are usual";
                check::positive(&path("discharge_coefficient"), coefficient, remedy)?;
                check::fraction(&path("discharge_coefficient"), coefficient, remedy)?
            },
            back_pressure_pa: {
                let pressure_pa = spec.back_pressure_pa.unwrap_or(ATMOSPHERE_PA);
                check::pressure_pa(&path("back_pressure_pa"), pressure_pa)?
            },
        },
    };
    let (start_s, stop_s) = window(&path, spec.start_s, spec.stop_s)?;
    let pressure = |field: &str, value: Option<f64>| {
        value.map(|value| check::pressure_pa(&path(field), value)).transpose()
    };
    let opens_above_pa = pressure("opens_above_pa", spec.opens_above_pa)?;
    let closes_below_pa = pressure("closes_below_pa", spec.closes_below_pa)?;
    if let (Some(opens), Some(closes)) = (opens_above_pa, closes_below_pa)
        && closes >= opens
    {
        let bound = format!("below opens_above = {opens} Pa");
        return Err(check::broken(&path("closes_below_pa"), closes, &bound, "it would close as it opens"));
    }
    let name = flow_name(kind, i, spec.name.as_ref())?;
    Ok(Flow { name, kind: kind_of_flow, start_s, stop_s, opens_above_pa, closes_below_pa, closes_above_pa: None })
}

fn refill(i: usize, spec: &RefillSpec) -> Result<Flow, ThermalError> {
    let path = |field: &str| format!("refill[{i}].{field}");
    let (start_s, stop_s) = window(&path, spec.start_s, spec.stop_s)?;
    let inlet = spec.inlet_diameter_m.map(|value| bore(&path("inlet_diameter_m"), value)).transpose()?;
    let closes = spec.closes_above_pa.map(|value| check::pressure_pa(&path("closes_above_pa"), value)).transpose()?;
    Ok(Flow {
        name: flow_name("refill", i, spec.name.as_ref())?,
        kind: FlowKind::Refill {
            mass_flow_kg_s: mass_flow(&path("flow_kg_s"), spec.flow_kg_s)?,
            source_temperature_k: check::temperature_k(&path("source_temperature_k"), spec.source_temperature_k)?,
            source_pressure_pa: check::pressure_pa(&path("source_pressure_pa"), spec.source_pressure_pa)?,
            inlet_diameter_m: inlet,
        },
        start_s,
        stop_s,
        opens_above_pa: None,
        closes_below_pa: None,
        closes_above_pa: closes,
    })
}

fn mass_flow(path: &str, value: f64) -> Result<f64, ThermalError> {
    let remedy = "the direction is clear from [[leak]], [[discharge]] or [[refill]]";
    check::positive(path, value, remedy)?;
    check::within(path, value, (0.0, MASS_FLOW_MAX_KG_S), "at most 100 kg/s", "check the unit, _g_h or _kg_s")
}

fn bore(path: &str, value: f64) -> Result<f64, ThermalError> {
    let remedy = "give the diameter of the hole, check the unit";
    check::within(path, check::positive(path, value, remedy)?, (0.0, 1.0), "at most 1 m", remedy)
}

fn window(
    path: &dyn Fn(&str) -> String,
    start_s: Option<f64>,
    stop_s: Option<f64>,
) -> Result<(f64, f64), ThermalError> {
    let start = start_s.unwrap_or(0.0);
    check::not_negative(&path("start_s"), start, "time counts from the start of the scenario")?;
    let Some(stop) = stop_s else { return Ok((start, f64::INFINITY)) };
    if stop.is_finite() && stop > start {
        return Ok((start, stop));
    }
    let bound = format!("later than the start at {start} s");
    Err(check::broken(&path("stop_s"), stop, &bound, "leave it out for a flow to the end"))
}

fn flow_name(kind: &str, i: usize, name: Option<&String>) -> Result<String, ThermalError> {
    match name {
        Some(name) if name.trim().is_empty() => {
            let remedy = "leave it out for the default name";
            Err(check::broken(&format!("{kind}[{i}].name"), "\"\"", "a name", remedy))
        }
        Some(name) => Ok(name.clone()),
        None if i == 0 => Ok(kind.to_owned()),
        None => Ok(format!("{kind}{}", i + 1)),
    }
}

fn push(flows: &mut Vec<Flow>, flow: Flow, path: &str) -> Result<(), ThermalError> {
    if flows.iter().any(|other| other.name == flow.name) {
        let text = format!("{:?}", flow.name);
        let remedy = "events tell flows apart by their names";
        return Err(check::broken(&format!("{path}.name"), text, "a name that no other flow has", remedy));
    }
    flows.push(flow);
    Ok(())
}

fn sensors(specs: &[SensorSpec]) -> Result<Vec<SurfaceSensor>, ThermalError> {
    let mut sensors: Vec<SurfaceSensor> = Vec::new();
    for (i, spec) in specs.iter().enumerate() {
        let path = |field: &str| format!("sensor[{i}].{field}");
        let is_word = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        if spec.name.is_empty() || !spec.name.chars().all(is_word) {
            let remedy = "it becomes part of a column's name, e.g. measured_shoulder_degc";
            let text = format!("{:?}", spec.name);
            return Err(check::broken(&path("name"), text, "of the letters a-z, digits and _", remedy));
        }
        if sensors.iter().any(|other| other.name == spec.name) {
            let text = format!("{:?}", spec.name);
            let remedy = "columns tell sensors apart by their names";
            return Err(check::broken(&path("name"), text, "a name that no other sensor has", remedy));
        }
        let place = spec.place.clone().unwrap_or_else(|| spec.name.clone());
        if !PLACES.contains(&place.as_str()) {
            let field = if spec.place.is_some() { "place" } else { "name" };
            return Err(check::unknown(&path(field), &place, PLACES));
        }
        let coupling = spec.air_coupling.unwrap_or(0.0);
        let remedy = "0 is a sensor in ideal contact, 0.15 to 0.2 a strapped one";
        let air_coupling = check::fraction(&path("air_coupling"), coupling, remedy)?;
        sensors.push(SurfaceSensor { name: spec.name.clone(), place, air_coupling });
    }
    Ok(sensors)
}
