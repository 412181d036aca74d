//! Raw content of a scenario file.
//!
//! Every field is SI here; the file may use any unit of the field's dimension (see [`crate::document`]).
use schemars::JsonSchema;
use serde::Deserialize;

pub use super::signal::*;
use crate::flow::SourceProcess;
use crate::sensor::SensorSpec;

/// Raw content of a scenario file.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
pub(crate) struct ScenarioSpec {
    /// Name for people.
    pub name: String,
    /// End time.
    pub duration_s: f64,
    /// Interval of the output samples; 1 min by default, or the duration if that is shorter.
    pub sample_time_s: Option<f64>,
    /// State at time 0.
    pub initial: InitialSpec,
    /// What surrounds the cylinder.
    pub ambient: AmbientSpec,
    /// Which part the sun lights; the irradiance stands in the ambient.
    pub sun: Option<SunSpec>,
    /// Leaks.
    #[serde(default)]
    pub leak: Vec<OutflowSpec>,
    /// Wanted flows out: release, relief device, blowdown.
    #[serde(default)]
    pub discharge: Vec<OutflowSpec>,
    /// Flows in.
    #[serde(default)]
    pub refill: Vec<RefillSpec>,
    /// Limits whose crossing is reported.
    #[serde(default)]
    pub limits: LimitsSpec,
    /// Sensors.
    #[serde(default)]
    pub sensor: Vec<SensorSpec>,
}

/// State at time 0: the fill by exactly one of settled fill, pressure or mass, and the temperatures.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub(crate) struct InitialSpec {
    /// Settled fill: absolute pressure at `fill_temperature`.
    pub fill_pressure_pa: Option<f64>,
    /// Settled fill: temperature of gas and wall, 15 °C by default.
    pub fill_temperature_k: Option<f64>,
    /// Absolute pressure at time 0.
    pub pressure_pa: Option<f64>,
    /// Gas mass.
    pub mass_kg: Option<f64>,
    /// Temperature of wall and gas at time 0; by default that of the air before its first change.
    pub temperature_k: Option<f64>,
    /// Temperature of wall and valve at time 0.
    pub wall_temperature_k: Option<f64>,
    /// Temperature of the gas at time 0.
    pub gas_temperature_k: Option<f64>,
}

/// What surrounds the cylinder. Each signal is a constant, a constant with changes, a table or a CSV column.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub(crate) struct AmbientSpec {
    /// Air temperature.
    pub air_k: Option<f64>,
    /// Steps and ramps of the air temperature, in order of time.
    #[serde(default)]
    pub air_change: Vec<TemperatureChange>,
    /// Air temperature as a table.
    pub air_table: Option<AirTable>,
    /// Air temperature from a file.
    pub air_csv: Option<CsvSpec>,
    /// Outside film coefficient, 0 for an insulated surface; without it and without wind the air is still.
    pub film_w_m2_k: Option<f64>,
    /// Steps and ramps of the film coefficient, in order of time.
    #[serde(default)]
    pub film_change: Vec<FilmChange>,
    /// Film coefficient as a table.
    pub film_table: Option<FilmTable>,
    /// Film coefficient from a file.
    pub film_csv: Option<CsvSpec>,
    /// Wind speed across the axis; the film follows from natural convection and wind.
    pub wind_m_s: Option<f64>,
    /// Steps and ramps of the wind speed, in order of time.
    #[serde(default)]
    pub wind_change: Vec<WindChange>,
    /// Wind speed as a table.
    pub wind_table: Option<WindTable>,
    /// Wind speed from a file.
    pub wind_csv: Option<CsvSpec>,
    /// Multiplier of the computed film, 1 by default.
    pub wind_multiplier: Option<f64>,
    /// Temperature that the surface radiates to; by default the air's where the film is computed from wind,
    /// and no separate radiation where it is a coefficient.
    pub radiation_k: Option<f64>,
    /// Steps and ramps of the radiation temperature, in order of time.
    #[serde(default)]
    pub radiation_change: Vec<TemperatureChange>,
    /// Radiation temperature as a table.
    pub radiation_table: Option<RadiationTable>,
    /// Radiation temperature from a file.
    pub radiation_csv: Option<CsvSpec>,
    /// Irradiance of the sun, normal to its rays; none by default.
    pub irradiance_w_m2: Option<f64>,
    /// Steps and ramps of the irradiance, in order of time.
    #[serde(default)]
    pub irradiance_change: Vec<IrradianceChange>,
    /// Irradiance as a table.
    pub irradiance_table: Option<IrradianceTable>,
    /// Irradiance from a file.
    pub irradiance_csv: Option<CsvSpec>,
}

/// Which part the sun lights.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub(crate) struct SunSpec {
    /// Lower end of the lit stretch as a fraction of the outer height, 0 by default.
    pub from_fraction: Option<f64>,
    /// Upper end of the lit stretch as a fraction of the outer height, 1 by default.
    pub to_fraction: Option<f64>,
    /// Whether the valve is lit too; true by default.
    pub valve: Option<bool>,
}

/// A flow out: a mass flow, an orifice, or a valve.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub(crate) struct OutflowSpec {
    /// Name for people and events; `leak` or `discharge` (with a number from the second on) by default.
    pub name: Option<String>,
    /// Constant mass flow.
    pub flow_kg_s: Option<f64>,
    /// Mass flow as a table.
    pub flow_table: Option<FlowTable>,
    /// Mass flow from a file.
    pub flow_csv: Option<CsvSpec>,
    /// Bore of an orifice, instead of a mass flow.
    pub diameter_m: Option<f64>,
    /// Discharge coefficient of the orifice, 0.8 by default. It belongs to the throat of the real gas: one that was found with the formula
    /// of an ideal gas is 2 to 6 % too large for nitrogen of 65 to 150 bar and goes into `discharge_coefficient_ideal_gas`.
    pub discharge_coefficient: Option<f64>,
    /// Discharge coefficient that was found with the formula of an ideal gas, instead of `discharge_coefficient`: it is converted at the
    /// state of the gas at time 0.
    pub discharge_coefficient_ideal_gas: Option<f64>,
    /// Flow coefficient Kv of a control valve, instead of a bore.
    pub kv_m3_h: Option<f64>,
    /// Pressure differential ratio factor of the valve, measured with air; 0.72 by default, as globe valves have it.
    pub x_t: Option<f64>,
    /// Absolute pressure behind the orifice or the valve, 1 atm by default.
    pub back_pressure_pa: Option<f64>,
    /// It can run from this time on, 0 by default.
    pub start_s: Option<f64>,
    /// It cannot run from this time on; by default it runs to the end.
    pub stop_s: Option<f64>,
    /// It opens when the pressure rises to this value; by default it is open from its start.
    pub opens_above_pa: Option<f64>,
    /// It closes for good when the pressure falls to this value.
    pub closes_below_pa: Option<f64>,
}

/// A flow in: a mass flow, or what passes an orifice or a valve while the source has the higher pressure.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub(crate) struct RefillSpec {
    /// Name for people and events; `refill` (with a number from the second on) by default.
    pub name: Option<String>,
    /// Constant mass flow.
    pub flow_kg_s: Option<f64>,
    /// Mass flow as a table.
    pub flow_table: Option<FlowTable>,
    /// Mass flow from a file.
    pub flow_csv: Option<CsvSpec>,
    /// Bore of an orifice, instead of a mass flow.
    pub diameter_m: Option<f64>,
    /// Discharge coefficient of the orifice, 0.8 by default; for the throat of the real gas, as that of a leak.
    pub discharge_coefficient: Option<f64>,
    /// Discharge coefficient that was found with the formula of an ideal gas, instead of `discharge_coefficient`: it is converted at the
    /// state of the source at time 0.
    pub discharge_coefficient_ideal_gas: Option<f64>,
    /// Flow coefficient Kv of a control valve, instead of a bore.
    pub kv_m3_h: Option<f64>,
    /// Pressure differential ratio factor of the valve, measured with air; 0.72 by default, as globe valves have it.
    pub x_t: Option<f64>,
    /// Temperature of the source; of a source vessel at time 0.
    pub source_temperature_k: Option<f64>,
    /// Temperature of the source as a table.
    pub source_temperature_table: Option<TemperatureTable>,
    /// Temperature of the source from a file.
    pub source_temperature_csv: Option<CsvSpec>,
    /// Absolute pressure of the source; of a source vessel at time 0.
    pub source_pressure_pa: Option<f64>,
    /// Absolute pressure of the source as a table.
    pub source_pressure_table: Option<PressureTable>,
    /// Absolute pressure of the source from a file.
    pub source_pressure_csv: Option<CsvSpec>,
    /// Volume of a vessel that the gas is taken from; by default the source does not run down.
    pub source_volume_m3: Option<f64>,
    /// What the gas of a source vessel does while it expands, adiabatic by default.
    pub source_process: Option<SourceProcess>,
    /// Bore through which the gas enters the cylinder, whose jet stirs it, be it that of the orifice or of a pipe behind it; no jet by default.
    pub inlet_diameter_m: Option<f64>,
    /// It can run from this time on, 0 by default.
    pub start_s: Option<f64>,
    /// It cannot run from this time on; by default it runs to the end.
    pub stop_s: Option<f64>,
    /// It closes for good when the pressure has risen to this value.
    pub closes_above_pa: Option<f64>,
}

/// Limits whose crossing is reported.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
pub(crate) struct LimitsSpec {
    /// Absolute pressures.
    #[serde(default)]
    pub pressure_pa: Vec<f64>,
}
