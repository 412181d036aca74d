//! The measured blowdown I1 beside the model, at the carrier's discharge coefficient and at the one that the
//! pressure record alone asks for. Temperatures are not fitted.
use super::ReproduceError;
use super::measured::{Curve, Measured, interpolated};

use crate::estimator::minimum::{evaluations, golden_section};
use crate::thermal::flow::FlowKind;
use crate::thermal::scenario::{self, Scenario};
use crate::thermal::simulate::{SimulationSettings, simulate};
use crate::thermal::trajectory::Trajectory;
use crate::thermal::vessel::{self, GasResolution, InsideFilm, Stratification, Vessel};

/// Discharge coefficient that HydDown's validation uses.
pub const CARRIER_COEFFICIENT: f64 = 0.8;
/// Where the fitted coefficient is looked for.
const COEFFICIENTS: (f64, f64) = (0.55, 0.95);
/// How finely it is found: a tenth of what 0.1 bar of pressure means.
const COEFFICIENT_WIDTH: f64 = 5e-4;
/// End of the run, s: the last digitised point lies at 100.11 s.
pub const DURATION_S: f64 = 100.5;
/// Sample time of the run, s: fine enough to interpolate the model, never the measurement.
pub const SAMPLE_S: f64 = 0.05;

/// Simulations that [`study`] runs.
pub(crate) fn runs() -> usize {
    3 + evaluations(COEFFICIENTS, COEFFICIENT_WIDTH)
}

/// Deviation of the model from a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// Mean of model minus measurement.
    pub bias: f64,
    /// Root of the mean square of model minus measurement.
    pub rms: f64,
}

impl Score {
    /// Of pairs (model, measurement).
    pub(crate) fn of(pairs: impl Iterator<Item = (f64, f64)>) -> Self {
        let (count, sum, squares) = pairs.fold((0.0, 0.0, 0.0), |(n, sum, squares), (model, measured)| {
            let e: f64 = model - measured;
            (n + 1.0, sum + e, squares + e * e)
        });
        Self { bias: sum / count, rms: f64::sqrt(squares / count) }
    }
}

/// The model at one discharge coefficient.
#[derive(Clone, Debug)]
pub struct Variant {
    /// Discharge coefficient.
    pub coefficient: f64,
    /// The run.
    pub run: Trajectory,
    /// Mean gas temperature against the middle of the measured band, K.
    pub gas: Score,
    /// Pressure, bar.
    pub pressure: Score,
    /// Warmest inner wall against the upper edge of the measured wall temperatures, K.
    pub wall_high: Score,
}

/// The stratified gas; its constants, film and discharge coefficient were fitted to this very run.
#[derive(Clone, Debug)]
pub struct Stacked {
    /// The run.
    pub run: Trajectory,
    /// Number of gas cells.
    pub cells: usize,
    /// Warmest cell against the warmest thermocouple, K.
    pub high: Score,
    /// Coldest cell against the coldest thermocouple, K.
    pub low: Score,
}

/// Gas cells of the stratified run: from here on the edges of the band move by less than 1 K with the count.
const STACKED_CELLS: usize = 40;
/// Discharge coefficient of the stratified run.
pub const STACKED_COEFFICIENT: f64 = 0.75;

/// Both variants and the stratified gas beside the measurement.
#[derive(Clone, Debug)]
pub struct Blowdown {
    /// What was measured.
    pub measured: Measured,
    /// At [`CARRIER_COEFFICIENT`].
    pub carrier: Variant,
    /// At the coefficient of least pressure deviation.
    pub fitted: Variant,
    /// The stratified gas.
    pub stacked: Stacked,
}

/// Times of the table of curves, s.
pub(crate) fn times_s() -> impl Iterator<Item = f64> {
    (0..=100).map(f64::from)
}

/// Runs the study; `progress` is called before every simulation with its number from 0.
///
/// # Errors
/// The first error of a simulation.
pub fn study(
    settings: &SimulationSettings,
    progress: &mut dyn FnMut(usize),
) -> Result<Blowdown, ReproduceError> {
    let vessel = vessel::presets::load("haque-i1")?;
    let mut scenario = scenario::presets::load("haque-i1")?;
    (scenario.duration_s, scenario.sample_time_s) = (DURATION_S, SAMPLE_S);
    let measured = Measured::embedded();
    let mut count = 0;
    let mut variant = |coefficient: f64| {
        progress(count);
        count += 1;
        let scenario = with_coefficient(&scenario, coefficient);
        let run = simulated(&vessel, &scenario, settings)?;
        Ok::<_, ReproduceError>(scored(coefficient, run, &measured))
    };
    let carrier = variant(CARRIER_COEFFICIENT)?;
    let best = golden_section(COEFFICIENTS, COEFFICIENT_WIDTH, |c| variant(c).map(|v| v.pressure.rms))?;
    let fitted = variant(best)?;
    progress(count);
    let stacked = stacked(&vessel, &scenario, settings, &measured)?;
    Ok(Blowdown { measured, carrier, fitted, stacked })
}

/// The vessel with the stratified gas.
pub fn stacked_vessel(vessel: &Vessel) -> Vessel {
    let constants =
        Stratification { cells: STACKED_CELLS, exchange_length_diameters: 1.0, core_mixing: 0.05 };
    Vessel {
        gas: GasResolution::Stratified(constants),
        inside_film: InsideFilm::Rayleigh { factor: 0.104, exponent: 0.352, multiplier: 1.0 },
        ..vessel.clone()
    }
}

fn stacked(
    vessel: &Vessel,
    scenario: &Scenario,
    settings: &SimulationSettings,
    measured: &Measured,
) -> Result<Stacked, ReproduceError> {
    let run = simulated(&stacked_vessel(vessel), &with_coefficient(scenario, STACKED_COEFFICIENT), settings)?;
    let edge = |pick: fn(f64, f64) -> f64, truth: &Curve| {
        score(&run.time_s, &extreme(&run.gas_cells_k, pick), truth)
    };
    let (high, low) = (edge(f64::max, &measured.gas_high_k), edge(f64::min, &measured.gas_low_k));
    Ok(Stacked { high, low, cells: STACKED_CELLS, run })
}

/// Largest or smallest of the cells at each time, K.
pub(crate) fn extreme(cells_k: &[Vec<f64>], pick: fn(f64, f64) -> f64) -> Vec<f64> {
    cells_k.iter().map(|sample| sample.iter().copied().reduce(pick).unwrap_or(f64::NAN)).collect()
}

/// Score at the measured points themselves, so that nothing is interpolated but the model.
fn score(times_s: &[f64], model: &[f64], truth: &Curve) -> Score {
    let points = truth.time_s.iter().zip(&truth.value);
    Score::of(points.map(|(&t, &value)| (interpolated(times_s, model, t), value)))
}

fn simulated(
    vessel: &Vessel,
    scenario: &Scenario,
    settings: &SimulationSettings,
) -> Result<Trajectory, ReproduceError> {
    Ok(simulate(vessel, scenario, settings, &mut |_| ())?)
}

/// The scenario with another discharge coefficient.
pub fn with_coefficient(scenario: &Scenario, coefficient: f64) -> Scenario {
    let mut changed = scenario.clone();
    for flow in &mut changed.flows {
        if let FlowKind::Orifice { discharge_coefficient, .. } = &mut flow.kind {
            *discharge_coefficient = coefficient;
        }
    }
    changed
}

/// Inner wall temperature at mid height against time, K.
pub(crate) fn wall_middle_k(run: &Trajectory) -> Vec<f64> {
    let cell = run.places.iter().find(|place| place.name == "middle").map_or(0, |place| place.axial_cell);
    run.wall_inner_k.iter().map(|sample| sample[cell]).collect()
}

/// A run at a discharge coefficient beside the measurement.
pub fn scored(coefficient: f64, run: Trajectory, measured: &Measured) -> Variant {
    let pressure_bar: Vec<f64> = run.pressure_pa.iter().map(|p| p / 1e5).collect();
    let gas = score(&run.time_s, &run.gas_mean_k, &measured.gas_middle_k());
    let pressure = score(&run.time_s, &pressure_bar, &measured.pressure_bar);
    let wall_k = extreme(&run.wall_inner_k, f64::max);
    let wall_high = score(&run.time_s, &wall_k, &measured.wall_high_k);
    Variant { coefficient, gas, pressure, wall_high, run }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_shift_is_all_bias() {
        let score = Score::of([(3.0, 1.0), (7.0, 5.0)].into_iter());
        assert_eq!(score, Score { bias: 2.0, rms: 2.0 });
    }
}
