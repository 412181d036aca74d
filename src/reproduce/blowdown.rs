//! The measured blowdown I1 beside the model, at the carrier's discharge coefficient and at the one that the
//! pressure record alone asks for. Temperatures are not fitted.
use super::ReproduceError;
use super::measured::{Measured, interpolated};
use super::minimum::{evaluations, golden_section};
use crate::thermal::flow::FlowKind;
use crate::thermal::scenario::{self, Scenario};
use crate::thermal::simulate::{SimulationSettings, simulate};
use crate::thermal::trajectory::Trajectory;
use crate::thermal::vessel::{self, Vessel};

/// Discharge coefficient that HydDown's validation uses.
pub const CARRIER_COEFFICIENT: f64 = 0.8;
/// Where the fitted coefficient is looked for.
const COEFFICIENTS: (f64, f64) = (0.55, 0.95);
/// How finely it is found: a tenth of what 0.1 bar of pressure means.
const COEFFICIENT_WIDTH: f64 = 5e-4;
/// Last of the times at which model and measurement are compared, s; the first is 1 s, the step 1 s.
const LAST_TIME_S: i32 = 99;

/// Simulations that [`study`] runs.
pub fn runs() -> usize {
    2 + evaluations(COEFFICIENTS, COEFFICIENT_WIDTH)
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
    pub fn of(pairs: impl Iterator<Item = (f64, f64)>) -> Self {
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
    /// Inner wall at mid height against the upper edge of the measured wall temperatures, K.
    pub wall_high: Score,
}

/// Both variants beside the measurement.
#[derive(Clone, Debug)]
pub struct Blowdown {
    /// What was measured.
    pub measured: Measured,
    /// At [`CARRIER_COEFFICIENT`].
    pub carrier: Variant,
    /// At the coefficient of least pressure deviation.
    pub fitted: Variant,
}

/// Times of comparison, s.
pub fn times_s() -> impl Iterator<Item = f64> {
    (1..=LAST_TIME_S).map(f64::from)
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
    let scenario = scenario::presets::load("haque-i1")?;
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
    Ok(Blowdown { measured, carrier, fitted })
}

fn simulated(
    vessel: &Vessel,
    scenario: &Scenario,
    settings: &SimulationSettings,
) -> Result<Trajectory, ReproduceError> {
    Ok(simulate(vessel, scenario, settings, &mut |_| ())?)
}

fn with_coefficient(scenario: &Scenario, coefficient: f64) -> Scenario {
    let mut changed = scenario.clone();
    for flow in &mut changed.flows {
        if let FlowKind::Orifice { discharge_coefficient, .. } = &mut flow.kind {
            *discharge_coefficient = coefficient;
        }
    }
    changed
}

/// Inner wall temperature at mid height against time, K.
pub fn wall_middle_k(run: &Trajectory) -> Vec<f64> {
    let cell = run.places.iter().find(|place| place.name == "middle").map_or(0, |place| place.axial_cell);
    run.wall_inner_k.iter().map(|sample| sample[cell]).collect()
}

fn scored(coefficient: f64, run: Trajectory, measured: &Measured) -> Variant {
    let score = |model: &[f64], truth: &dyn Fn(f64) -> f64| {
        Score::of(times_s().map(|t| (interpolated(&run.time_s, model, t), truth(t))))
    };
    let pressure_bar: Vec<f64> = run.pressure_pa.iter().map(|p| p / 1e5).collect();
    let gas = score(&run.gas_mean_k, &|t| 0.5 * (measured.gas_high_k.at(t) + measured.gas_low_k.at(t)));
    let pressure = score(&pressure_bar, &|t| measured.pressure_bar.at(t));
    let wall_high = score(&wall_middle_k(&run), &|t| measured.wall_high_k.at(t));
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
