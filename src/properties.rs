//! Properties of a gas at a state that any two of temperature, pressure and density fix.
use crate::report::{Digits, Report, Table, number};
use crate::thermal::ThermalError;
use crate::thermal::fluid::{Fluid, State};

/// The two quantities that fix a state, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum FixedQuantities {
    /// Temperature, K, and absolute pressure, Pa.
    TemperaturePressure(f64, f64),
    /// Temperature, K, and density, kg/m³.
    TemperatureDensity(f64, f64),
    /// Absolute pressure, Pa, and density, kg/m³.
    PressureDensity(f64, f64),
}

/// Why a state has no properties.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum PropertyError {
    /// The gas refuses the state.
    #[error(transparent)]
    Fluid(#[from] ThermalError),
    /// No temperature belongs to pressure and density.
    #[error(
        "no temperature between {LOWEST_K} K and {HIGHEST_K} K has pressure {} Pa at density {} kg/m³ \
         in the range of the equation of state: check both numbers and their units",
        number(*.pressure_pa, 10), number(*.density_kg_m3, 10)
    )]
    NoTemperature {
        /// Pressure, Pa.
        pressure_pa: f64,
        /// Density, kg/m³.
        density_kg_m3: f64,
    },
}

/// Lowest temperature that is tried, K.
const LOWEST_K: f64 = 50.0;
/// Highest temperature that is tried, K.
const HIGHEST_K: f64 = 2000.0;

/// Properties at one state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Properties {
    /// Thermodynamic state.
    pub state: State,
    /// Dynamic viscosity, Pa s.
    pub viscosity_pa_s: f64,
    /// Thermal conductivity, W/(m K).
    pub conductivity_w_m_k: f64,
}

/// A property: column name, name for people, unit for people, value.
type Property = (&'static str, &'static str, &'static str, fn(&Properties) -> f64);

/// What is printed, in the order of the columns.
const PROPERTIES: [Property; 14] = [
    ("temperature_k", "temperature", "K", |p| p.state.temperature_k),
    ("pressure_pa", "pressure (absolute)", "Pa", |p| p.state.pressure_pa),
    ("density_kg_m3", "density", "kg/m³", |p| p.state.density_kg_m3),
    ("compressibility", "compressibility factor", "", |p| p.state.compressibility),
    ("internal_energy_j_kg", "internal energy", "J/kg", |p| p.state.internal_energy_j_kg),
    ("enthalpy_j_kg", "enthalpy", "J/kg", |p| p.state.enthalpy_j_kg),
    ("entropy_j_kg_k", "entropy", "J/(kg K)", |p| p.state.entropy_j_kg_k),
    ("cv_j_kg_k", "heat capacity at constant volume", "J/(kg K)", |p| p.state.cv_j_kg_k),
    ("cp_j_kg_k", "heat capacity at constant pressure", "J/(kg K)", |p| p.state.cp_j_kg_k),
    ("sound_speed_m_s", "speed of sound", "m/s", |p| p.state.sound_speed_m_s),
    ("dp_dt_at_density_pa_k", "dp/dT at constant density", "Pa/K", |p| p.state.dp_dt_pa_k),
    ("dp_drho_at_temperature_pa_m3_kg", "dp/dρ at constant temperature", "Pa m³/kg", |p| {
        p.state.dp_drho_pa_m3_kg
    }),
    ("viscosity_pa_s", "viscosity", "Pa s", |p| p.viscosity_pa_s),
    ("conductivity_w_m_k", "thermal conductivity", "W/(m K)", |p| p.conductivity_w_m_k),
];

/// Printed for people beside [`PROPERTIES`]; the files keep to their fixed columns.
const EXPANSION: Property =
    ("expansion_per_k", "expansion coefficient at constant pressure", "1/K", |p| p.state.expansion_per_k);

/// Properties at the given state.
///
/// # Errors
/// The state is outside the equation of state, or two-phase, or does not exist.
pub(crate) fn evaluate(fluid: &Fluid, given: FixedQuantities) -> Result<Properties, PropertyError> {
    let (density, temperature) = match given {
        FixedQuantities::TemperaturePressure(t, p) => (fluid.density_from_pressure_temperature(p, t)?, t),
        FixedQuantities::TemperatureDensity(t, rho) => (rho, t),
        FixedQuantities::PressureDensity(p, rho) => (rho, temperature_k(fluid, p, rho)?),
    };
    Ok(Properties {
        state: fluid.checked_state(density, temperature)?,
        viscosity_pa_s: fluid.viscosity_pa_s(density, temperature),
        conductivity_w_m_k: fluid.conductivity_w_m_k(density, temperature),
    })
}

/// Temperature from pressure and density, K.
///
/// At constant density the pressure of a single phase rises with temperature, nearly along a straight line: Newton's
/// method from the nearest of a few hundred temperatures that the equation of state admits. They are tried from the
/// hottest down and end with the first that is refused or breaks the rise, below which is no gas.
fn temperature_k(fluid: &Fluid, pressure_pa: f64, density_kg_m3: f64) -> Result<f64, PropertyError> {
    const STEPS: i32 = 300;
    let missing = || PropertyError::NoTemperature { pressure_pa, density_kg_m3 };
    let mut last = f64::INFINITY;
    let gas = (0..=STEPS)
        .map(|k| HIGHEST_K * (LOWEST_K / HIGHEST_K).powf(f64::from(k) / f64::from(STEPS)))
        .map(|t| (t, fluid.checked_state(density_kg_m3, t).ok()))
        .skip_while(|(_, state)| state.is_none())
        .map_while(|(t, state)| Some((t, state?.pressure_pa)))
        .take_while(|(_, p)| *p < std::mem::replace(&mut last, *p));
    let nearest = gas.min_by(|a, b| (a.1 - pressure_pa).abs().total_cmp(&(b.1 - pressure_pa).abs()));
    let (mut t, _) = nearest.ok_or_else(missing)?;
    for _ in 0..50 {
        let state = fluid.checked_state(density_kg_m3, t).map_err(|_| missing())?;
        let step = (pressure_pa - state.pressure_pa) / state.dp_dt_pa_k;
        t += step;
        if !(LOWEST_K..=HIGHEST_K).contains(&t) {
            return Err(missing());
        }
        if step.abs() <= 1e-12 * t {
            return Ok(t);
        }
    }
    Err(missing())
}

/// A row of a table of states.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Row {
    /// A state.
    Known(Properties),
    /// What was given for one that the gas does not have.
    Refused(FixedQuantities),
}

impl Row {
    /// A property; NaN, an empty cell, for what a refused state does not have.
    fn value(&self, name: &str, value: fn(&Properties) -> f64) -> f64 {
        match self {
            Self::Known(properties) => value(properties),
            Self::Refused(given) => given.named(name).unwrap_or(f64::NAN),
        }
    }
}

impl FixedQuantities {
    /// What was given of a column.
    fn named(self, name: &str) -> Option<f64> {
        match (self, name) {
            (Self::TemperaturePressure(t, _) | Self::TemperatureDensity(t, _), "temperature_k") => Some(t),
            (Self::TemperaturePressure(_, p) | Self::PressureDensity(p, _), "pressure_pa") => Some(p),
            (Self::TemperatureDensity(_, rho) | Self::PressureDensity(_, rho), "density_kg_m3") => Some(rho),
            _ => None,
        }
    }
}

/// The states as columns.
pub(crate) fn table(rows: &[Row]) -> Table {
    // All digits of a double: such tables are compared with references.
    let mut table = Table::new();
    for (name, _, _, value) in PROPERTIES {
        table.push(name, Digits::Significant(16), rows.iter().map(|row| row.value(name, value)));
    }
    table
}

/// One state for people.
pub(crate) fn summary(fluid: &str, properties: &Properties) -> Report {
    let degc = properties.state.temperature_k - 273.15;
    let bar = properties.state.pressure_pa / 1e5;
    let rows: Vec<Vec<String>> = PROPERTIES
        .iter()
        .chain([&EXPANSION])
        .map(|(column, name, unit, value)| {
            let also = match *column {
                "temperature_k" => format!("({} °C)", number(degc, 8)),
                "pressure_pa" => format!("({} bar)", number(bar, 8)),
                _ => String::new(),
            };
            vec![(*name).to_owned(), number(value(properties), 8), (*unit).to_owned(), also]
        })
        .collect();
    Report::new(format!("Properties of {fluid}")).rows::<&str>("", &[], rows)
}

/// Many states for people.
pub(crate) fn summary_of_many(fluid: &str, rows: &[Row]) -> Report {
    let mut table = Table::new();
    for (column, name, unit, value) in PROPERTIES {
        let values = rows.iter().map(|row| row.value(column, value));
        table.push_quantity(name, unit, Digits::Significant(6), values);
    }
    Report::new(format!("Properties of {fluid}")).table("", table)
}
