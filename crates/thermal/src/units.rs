//! Units of files and of the command line: the suffix of a key is its unit.
//!
//! One table serves every reader: `fill_pressure_bar` is the quantity `fill_pressure` in the unit `bar`, and
//! any unit of the same [`Dimension`] may stand there. The longest suffix wins, so that `film_w_m2_k` is a film
//! coefficient and not a number of kelvins. A compound unit is numerator, then denominator (`density_kg_m3`).
//! The conversion is `SI = factor * value + offset`; gauge pressure counts from 101325 Pa.
use alloc::string::String;
use alloc::vec::Vec;

/// Standard atmosphere, Pa: zero of the gauge units.
pub const ATMOSPHERE_PA: f64 = 101_325.0;

/// Zero of the Celsius scale, K.
pub const ZERO_CELSIUS_K: f64 = 273.15;
/// Temperature that fill pressures are quoted at, K: 15 °C.
pub const QUOTED_K: f64 = 288.15;

/// One bar, Pa.
pub const BAR_PA: f64 = 1e5;

/// One minute, s.
pub const MINUTE_S: f64 = 60.0;
/// One hour, s.
pub const HOUR_S: f64 = 60.0 * MINUTE_S;
/// One day, s.
pub const DAY_S: f64 = 24.0 * HOUR_S;
/// One year, s.
pub const YEAR_S: f64 = 365.25 * DAY_S;

const PSI_PA: f64 = 6_894.757_293_168_361;
/// Conventional, at 0 °C.
const INCH_OF_MERCURY_PA: f64 = 3_386.389;
const KELVIN_PER_FAHRENHEIT: f64 = 5.0 / 9.0;

/// What a unit measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Dimension {
    /// Absolute pressure, Pa.
    Pressure,
    /// Difference, deviation or error of a pressure, Pa.
    PressureDifference,
    /// Temperature on a scale with a zero, K.
    Temperature,
    /// Difference, deviation or rate-free change of temperature, K.
    TemperatureDifference,
    /// Change of temperature per time, K/s.
    TemperatureRate,
    /// Time, s.
    Time,
    /// Volume, m³.
    Volume,
    /// Length, m.
    Length,
    /// Area, m².
    Area,
    /// Mass, kg.
    Mass,
    /// Mass flow, kg/s.
    MassFlow,
    /// Flow coefficient Kv of a valve, m³/h: the unit belongs to its definition.
    FlowCoefficient,
    /// Density, kg/m³.
    Density,
    /// Film coefficient, W/(m² K).
    Film,
    /// Thermal conductance, W/K.
    Conductance,
    /// Heat flux or irradiance, W/m².
    HeatFlux,
    /// Speed, m/s.
    Speed,
    /// Specific heat capacity, J/(kg K).
    HeatCapacity,
    /// Thermal conductivity, W/(m K).
    Conductivity,
    /// Relative change per temperature, 1/K.
    PerTemperature,
    /// Relative change per pressure, 1/Pa.
    PerPressure,
    /// Power, W.
    Power,
    /// Energy, J.
    Energy,
    /// Energy per mass, J/kg.
    SpecificEnergy,
    /// Dynamic viscosity, Pa s.
    Viscosity,
    /// Change of pressure per time, Pa/s.
    PressureRate,
    /// Change of pressure per temperature, Pa/K.
    PressurePerTemperature,
    /// Change of temperature per pressure, K/Pa.
    TemperaturePerPressure,
    /// Change of pressure per density, Pa m³/kg.
    PressurePerDensity,
    /// Volume per mass, m³/kg.
    SpecificVolume,
    /// Diffusivity, m²/s.
    Diffusivity,
    /// Relative error, 1.
    Ratio,
}

/// A unit: a suffix and its way to SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Suffix without its leading underscore, e.g. `barg`.
    pub suffix: &'static str,
    /// What it measures.
    pub dimension: Dimension,
    /// SI units per unit.
    pub factor: f64,
    /// SI value at zero.
    pub offset: f64,
}

impl Unit {
    /// A value in this unit, as SI.
    pub fn to_si(&self, value: f64) -> f64 {
        self.factor * value + self.offset
    }

    /// An SI value, in this unit.
    pub fn from_si(&self, si: f64) -> f64 {
        (si - self.offset) / self.factor
    }
}

const fn unit(suffix: &'static str, dimension: Dimension, factor: f64, offset: f64) -> Unit {
    Unit { suffix, dimension, factor, offset }
}

/// Every unit. Within a dimension the unit that people use first comes first; messages take it as the example.
pub const UNITS: &[Unit] = {
    use Dimension::*;
    &[
        unit("bar", Pressure, 1e5, 0.0),
        unit("pa", Pressure, 1.0, 0.0),
        unit("kpa", Pressure, 1e3, 0.0),
        unit("mpa", Pressure, 1e6, 0.0),
        unit("mbar", Pressure, 1e2, 0.0),
        unit("barg", Pressure, 1e5, ATMOSPHERE_PA),
        unit("psi", Pressure, PSI_PA, 0.0),
        unit("psig", Pressure, PSI_PA, ATMOSPHERE_PA),
        unit("kpag", Pressure, 1e3, ATMOSPHERE_PA),
        unit("mpag", Pressure, 1e6, ATMOSPHERE_PA),
        unit("mbarg", Pressure, 1e2, ATMOSPHERE_PA),
        unit("inhg", Pressure, INCH_OF_MERCURY_PA, 0.0),
        unit("bar", PressureDifference, 1e5, 0.0),
        unit("pa", PressureDifference, 1.0, 0.0),
        unit("kpa", PressureDifference, 1e3, 0.0),
        unit("mpa", PressureDifference, 1e6, 0.0),
        unit("mbar", PressureDifference, 1e2, 0.0),
        unit("psi", PressureDifference, PSI_PA, 0.0),
        unit("degc", Temperature, 1.0, ZERO_CELSIUS_K),
        unit("k", Temperature, 1.0, 0.0),
        unit("degf", Temperature, KELVIN_PER_FAHRENHEIT, ZERO_CELSIUS_K - 32.0 * KELVIN_PER_FAHRENHEIT),
        unit("k", TemperatureDifference, 1.0, 0.0),
        unit("k_h", TemperatureRate, 1.0 / 3_600.0, 0.0),
        unit("k_s", TemperatureRate, 1.0, 0.0),
        unit("k_d", TemperatureRate, 1.0 / 86_400.0, 0.0),
        unit("min", Time, 60.0, 0.0),
        unit("s", Time, 1.0, 0.0),
        unit("h", Time, 3_600.0, 0.0),
        unit("d", Time, 86_400.0, 0.0),
        unit("l", Volume, 1e-3, 0.0),
        unit("m3", Volume, 1.0, 0.0),
        unit("ml", Volume, 1e-6, 0.0),
        unit("mm", Length, 1e-3, 0.0),
        unit("m", Length, 1.0, 0.0),
        unit("cm", Length, 1e-2, 0.0),
        unit("cm2", Area, 1e-4, 0.0),
        unit("m2", Area, 1.0, 0.0),
        unit("mm2", Area, 1e-6, 0.0),
        unit("kg", Mass, 1.0, 0.0),
        unit("g", Mass, 1e-3, 0.0),
        unit("g_h", MassFlow, 1e-3 / 3_600.0, 0.0),
        unit("kg_s", MassFlow, 1.0, 0.0),
        unit("g_s", MassFlow, 1e-3, 0.0),
        unit("kg_h", MassFlow, 1.0 / 3_600.0, 0.0),
        unit("m3_h", FlowCoefficient, 1.0, 0.0),
        unit("kg_m3", Density, 1.0, 0.0),
        unit("w_m2_k", Film, 1.0, 0.0),
        unit("w_k", Conductance, 1.0, 0.0),
        unit("w_m2", HeatFlux, 1.0, 0.0),
        unit("m_s", Speed, 1.0, 0.0),
        unit("km_h", Speed, 1.0 / 3.6, 0.0),
        unit("j_kg_k", HeatCapacity, 1.0, 0.0),
        unit("kj_kg_k", HeatCapacity, 1e3, 0.0),
        unit("w_m_k", Conductivity, 1.0, 0.0),
        unit("per_k", PerTemperature, 1.0, 0.0),
        unit("per_bar", PerPressure, 1e-5, 0.0),
        unit("per_pa", PerPressure, 1.0, 0.0),
        unit("per_mpa", PerPressure, 1e-6, 0.0),
        unit("w", Power, 1.0, 0.0),
        unit("kw", Power, 1e3, 0.0),
        unit("j", Energy, 1.0, 0.0),
        unit("kj", Energy, 1e3, 0.0),
        unit("j_kg", SpecificEnergy, 1.0, 0.0),
        unit("kj_kg", SpecificEnergy, 1e3, 0.0),
        unit("pa_s", Viscosity, 1.0, 0.0),
        unit("bar_h", PressureRate, 1e5 / 3_600.0, 0.0),
        unit("mbar_h", PressureRate, 1e2 / 3_600.0, 0.0),
        unit("bar_d", PressureRate, 1e5 / 86_400.0, 0.0),
        unit("mbar_d", PressureRate, 1e2 / 86_400.0, 0.0),
        unit("pa_s", PressureRate, 1.0, 0.0),
        unit("bar_k", PressurePerTemperature, 1e5, 0.0),
        unit("pa_k", PressurePerTemperature, 1.0, 0.0),
        unit("mbar_k", PressurePerTemperature, 1e2, 0.0),
        unit("k_bar", TemperaturePerPressure, 1e-5, 0.0),
        unit("k_pa", TemperaturePerPressure, 1.0, 0.0),
        unit("pa_m3_kg", PressurePerDensity, 1.0, 0.0),
        unit("m3_kg", SpecificVolume, 1.0, 0.0),
        unit("m2_s", Diffusivity, 1.0, 0.0),
        unit("percent", Ratio, 1e-2, 0.0),
        unit("ratio", Ratio, 1.0, 0.0),
        unit("ppm", Ratio, 1e-6, 0.0),
    ]
};

/// Last words of a quantity's name that make its kelvins or its pascals a difference, which has no Celsius zero and
/// no gauge zero.
const DIFFERENCES: [&str; 9] =
    ["sd", "difference", "rise", "offset", "drift", "noise", "tolerance", "resolution", "scale"];

/// Units of a dimension, the customary one first.
pub fn units_of(dimension: Dimension) -> impl Iterator<Item = &'static Unit> {
    UNITS.iter().filter(move |unit| unit.dimension == dimension)
}

/// The unit with this suffix and dimension.
pub fn find(suffix: &str, dimension: Dimension) -> Option<&'static Unit> {
    units_of(dimension).find(|unit| unit.suffix == suffix)
}

/// Suffix of the SI unit of a dimension.
pub fn si_suffix(dimension: Dimension) -> &'static str {
    units_of(dimension).find(|unit| unit.factor == 1.0 && unit.offset == 0.0).map_or("", |unit| unit.suffix)
}

/// Suffixes of a dimension as a list for people: `_mm, _m, _cm`.
pub fn listed(dimension: Dimension) -> String {
    let suffixes: Vec<String> = units_of(dimension).map(|unit| format!("_{}", unit.suffix)).collect();
    suffixes.join(", ")
}

/// Splits a key into the quantity and the unit of its longest suffix; `None` if it ends in no unit.
///
/// `shoulder_k` is a temperature, `shoulder_sd_k` a difference, `drift_pa_s` a rate and no viscosity: the quantity's
/// last word decides.
pub fn split(key: &str) -> Option<(&str, &'static Unit)> {
    let strip = |suffix: &str| key.strip_suffix(suffix)?.strip_suffix('_').filter(|base| !base.is_empty());
    let (base, longest) = UNITS
        .iter()
        .filter_map(|unit| Some((strip(unit.suffix)?, unit)))
        .min_by_key(|(base, _)| base.len())?;
    let last_word = base.rsplit('_').next().unwrap_or(base);
    let is_difference = DIFFERENCES.contains(&last_word);
    let dimension = match longest.dimension {
        Dimension::Temperature if is_difference => Dimension::TemperatureDifference,
        Dimension::Pressure if is_difference => Dimension::PressureDifference,
        Dimension::Viscosity if last_word == "drift" => Dimension::PressureRate,
        other => other,
    };
    Some((base, find(longest.suffix, dimension).unwrap_or(longest)))
}

/// Reads `value` of the key `key` as SI if the key ends in a unit of `dimension`.
pub fn to_si(key: &str, value: f64, dimension: Dimension) -> Option<f64> {
    let (_, unit) = split(key)?;
    Some(find(unit.suffix, dimension)?.to_si(value))
}
