//! The 20 L cylinder: the paper's scenarios, and what the equation of state alone says about its gauge.
use super::ReproduceError;
use crate::report::Readings;
use crate::thermal::ThermalError;
use crate::thermal::fluid::{Equation, Fluid};
use crate::thermal::scenario;
use crate::thermal::simulate::{SimulationSettings, simulate};
use crate::thermal::trajectory::Trajectory;
use crate::thermal::vessel;
use std::time::Instant;

/// Scenarios 1 to 4 of the paper, by their built-in names.
pub(crate) const SCENARIOS: [&str; 4] = ["shock-cold", "tunnel-winter", "ramp-warm", "cool-down"];
/// Built-in vessel of the scenarios.
pub(crate) const VESSEL: &str = "nitrogen-20l";

/// Pressure of a full cylinder at 15 °C, Pa.
pub(crate) const FILL_PRESSURE_PA: f64 = 200e5;
/// Temperature at which the fill is stated, K.
pub(crate) const FILL_TEMPERATURE_K: f64 = 288.15;
/// Volume of the cylinder, m³.
pub(crate) const VOLUME_M3: f64 = 0.02;

/// A simulated scenario.
#[derive(Clone, Debug)]
pub(crate) struct ScenarioRun {
    /// Built-in name.
    pub name: &'static str,
    /// The run.
    pub run: Trajectory,
    /// What its sensors are expected to read; nothing of a reproduction is random.
    pub readings: Readings,
    /// Time that it took, s.
    pub wall_time_s: f64,
}

/// Simulates a built-in scenario on a built-in vessel.
///
/// # Errors
/// The simulation's.
pub(crate) fn simulated(
    vessel: &str,
    name: &'static str,
    settings: &SimulationSettings,
    progress: &mut dyn FnMut(f64),
) -> Result<ScenarioRun, ReproduceError> {
    let vessel = vessel::presets::load(vessel)?;
    let scenario = scenario::presets::load(name)?;
    let start = Instant::now();
    let run = simulate(&vessel, &scenario, settings, progress)?;
    let wall_time_s = start.elapsed().as_secs_f64();
    Ok(ScenarioRun { name, readings: Readings::expected(&run)?, run, wall_time_s })
}

/// What the equation of state says about a tight, rigid, full cylinder.
#[derive(Clone, Debug)]
pub(crate) struct TightCylinder {
    /// Gas mass, kg.
    pub mass_kg: f64,
    /// Gas mass that the ideal gas gives, kg.
    pub mass_ideal_kg: f64,
    /// Pressure at -25 °C, bar.
    pub pressure_cold_bar: f64,
    /// Slope of the pressure at the fill, bar/K.
    pub slope_bar_k: f64,
    /// The same for the ideal gas, bar/K.
    pub slope_ideal_bar_k: f64,
    /// Fill pressure at 15 °C whose slope is the paper's 0.8457 bar/°C, bar.
    pub fill_of_paper_bar: f64,
    /// Temperatures of the curves, °C.
    pub temperature_degc: Vec<f64>,
    /// Pressure of the real gas, bar.
    pub real_bar: Vec<f64>,
    /// Pressure of the ideal gas with the same fill, bar.
    pub ideal_bar: Vec<f64>,
}

/// Slope of pressure against temperature that the paper uses, bar/K.
pub(crate) const SLOPE_OF_PAPER_BAR_K: f64 = 0.8457;

/// Evaluates the tight cylinder.
///
/// # Errors
/// The gas's; none for nitrogen in this range.
pub(crate) fn tight() -> Result<TightCylinder, ReproduceError> {
    let real = Fluid::named("nitrogen")?;
    let ideal = real.clone().with_equation(Equation::IdealGas);
    let density =
        |fluid: &Fluid| fluid.density_from_pressure_temperature(FILL_PRESSURE_PA, FILL_TEMPERATURE_K);
    let (rho, rho_ideal) = (density(&real)?, density(&ideal)?);
    let temperature_degc: Vec<f64> = (-40..=65).map(f64::from).collect();
    let curve = |fluid: &Fluid, rho: f64| -> Result<Vec<f64>, ThermalError> {
        temperature_degc.iter().map(|t| Ok(fluid.checked_state(rho, t + 273.15)?.pressure_pa / 1e5)).collect()
    };
    let slope = |fluid: &Fluid, rho: f64| -> Result<f64, ThermalError> {
        Ok(fluid.checked_state(rho, FILL_TEMPERATURE_K)?.dp_dt_pa_k / 1e5)
    };
    Ok(TightCylinder {
        mass_kg: rho * VOLUME_M3,
        mass_ideal_kg: rho_ideal * VOLUME_M3,
        pressure_cold_bar: real.checked_state(rho, 248.15)?.pressure_pa / 1e5,
        slope_bar_k: slope(&real, rho)?,
        slope_ideal_bar_k: slope(&ideal, rho_ideal)?,
        fill_of_paper_bar: fill_of_slope(&real, SLOPE_OF_PAPER_BAR_K)?,
        real_bar: curve(&real, rho)?,
        ideal_bar: curve(&ideal, rho_ideal)?,
        temperature_degc,
    })
}

/// Pressure at 15 °C at which the slope has a value, bar; the slope rises with the density, so halving finds it.
fn fill_of_slope(fluid: &Fluid, slope_bar_k: f64) -> Result<f64, ThermalError> {
    let (mut low, mut high) = (1.0, 400.0);
    while high - low > 1e-9 {
        let middle = 0.5 * (low + high);
        let state = fluid.checked_state(middle, FILL_TEMPERATURE_K)?;
        if state.dp_dt_pa_k / 1e5 < slope_bar_k { low = middle } else { high = middle }
    }
    Ok(fluid.checked_state(low, FILL_TEMPERATURE_K)?.pressure_pa / 1e5)
}

/// Time at which the mean gas temperature has gone 63.2 % of the way to `final_k`, s.
pub fn time_63_s(run: &Trajectory, final_k: f64) -> Option<f64> {
    let start = *run.gas_mean_k.first()?;
    let level = start + (1.0 - (-1f64).exp()) * (final_k - start);
    let passed = |t: f64| (t - level) * (final_k - start).signum() >= 0.0;
    let k = run.gas_mean_k.iter().position(|&t| passed(t)).filter(|&k| k > 0)?;
    let (a, b) = (run.gas_mean_k[k - 1], run.gas_mean_k[k]);
    Some(run.time_s[k - 1] + (level - a) / (b - a) * (run.time_s[k] - run.time_s[k - 1]))
}
