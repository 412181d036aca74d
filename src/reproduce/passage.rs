//! Figures 6 and 8 of the paper on a simulated cylinder: a tunnel passage, tight and with a leak.
//!
//! The cylinder is the built-in one with a real gas, a wall and sensors; the methods get its readings alone. Figure 6 is
//! the passage from -10 to 35 °C alone, figure 8 the same with 60 g/h from an hour on. The paper does not state its leak.
use super::ReproduceError;
use super::cylinder::VESSEL;
use super::methods::{MethodRun, Plan, run_methods};
use crate::estimator::sensor::SensorSuite;
use crate::report::Readings;
use crate::thermal::simulate::{SimulationSettings, simulate};
use crate::thermal::units::ZERO_CELSIUS_K;
use crate::thermal::{scenario, vessel};

/// Entry into the tunnel (t1), s.
pub(crate) const ENTRY_S: f64 = 600.0;
/// Onset of the leak (t2), s.
pub(crate) const ONSET_S: f64 = 3600.0;
/// The leak, g/h.
pub(crate) const LEAK_G_H: f64 = 60.0;

/// What happens to the cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Case {
    /// Figure 6: 3 h, tight.
    Tight,
    /// Figure 8 without its leak: 4 h.
    TightLong,
    /// Figure 8.
    Leaking,
}

/// A passage.
#[derive(Clone, Debug)]
pub(crate) struct Passage {
    /// Air and mean gas temperature, °C, at the samples.
    pub air_degc: Vec<f64>,
    /// True mean gas temperature, °C.
    pub gas_degc: Vec<f64>,
    /// Results of the methods.
    pub method_run: MethodRun,
}

/// Simulates a passage and lets all watch; `pole_per_s` is that of the refitted transfer function.
///
/// # Errors
/// The simulation's or a method's.
pub(crate) fn passage(case: Case, pole_per_s: f64, seed: u64) -> Result<Passage, ReproduceError> {
    let vessel = vessel::presets::load(VESSEL)?;
    let name = if case == Case::Tight { "tunnel-step" } else { "leak-after-tunnel" };
    let mut scenario = scenario::presets::load(name)?;
    if case == Case::TightLong {
        scenario.flows.clear();
    }
    let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
    let log = Readings::sampled(&run, seed)?.log;
    let suite = SensorSuite::from(&scenario);
    let plan = Plan { nominal: &vessel, sensors: suite.sensors(), pole_per_s, rest_s: ENTRY_S };
    let method_run = run_methods(&plan, &log)?;
    let celsius = |values_k: &[f64]| values_k.iter().map(|k| k - ZERO_CELSIUS_K).collect();
    Ok(Passage { air_degc: celsius(&run.ambient_k), gas_degc: celsius(&run.gas_mean_k), method_run })
}
