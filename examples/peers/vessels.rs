//! Whole runs: the measured blowdown I1 and the closed bottle, to compare with HydDown.
use super::stopwatch::{Stopwatch, Timing};
use cylwatch::reproduce::blowdown::{self, CARRIER_COEFFICIENT, DURATION_S, SAMPLE_S, Variant};
use cylwatch::reproduce::cylinder::time_63_s;
use cylwatch::reproduce::measured::{Curve, Measured};
use cylwatch::thermal::scenario::{self, Scenario};
use cylwatch::thermal::simulate::{SimulationSettings, simulate};
use cylwatch::thermal::trajectory::Trajectory;
use cylwatch::thermal::vessel::{self, Vessel};
use serde::{Deserialize, Serialize};

/// Relative tolerances of the closed bottle.
const TOLERANCES: [f64; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];
/// Tolerance of the run that counts as converged.
const CONVERGED: f64 = 1e-11;
/// Samples of the closed bottle, s: straight lines between them are exact to 0.1 s of the time constant.
const BOTTLE_SAMPLE_S: f64 = 60.0;
/// Samples of the blowdown as the preset has them, s.
const COARSE_SAMPLE_S: f64 = 0.5;
/// Air around the bottle after the step, K.
const BOTTLE_AIR_K: f64 = 308.15;

/// A measured curve: times, s, and values.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Points {
    time_s: Vec<f64>,
    value: Vec<f64>,
}

/// The measured points that both sides are scored at, and when the runs end.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Inputs {
    gas_middle_k: Points,
    wall_high_k: Points,
    pressure_bar: Points,
    blowdown_duration_s: f64,
    discharge_coefficient: f64,
    bottle_air_k: f64,
}

impl Inputs {
    /// The record of run I1.
    pub(crate) fn new() -> Self {
        let points = |curve: &Curve| Points { time_s: curve.time_s.clone(), value: curve.value.clone() };
        let measured = Measured::embedded();
        Self {
            gas_middle_k: points(&measured.gas_middle_k()),
            wall_high_k: points(&measured.wall_high_k),
            pressure_bar: points(&measured.pressure_bar),
            blowdown_duration_s: DURATION_S,
            discharge_coefficient: CARRIER_COEFFICIENT,
            bottle_air_k: BOTTLE_AIR_K,
        }
    }
}

/// One way to compute run I1.
#[derive(Debug, Serialize)]
pub(crate) struct Blowdown {
    name: &'static str,
    discharge_coefficient: f64,
    wall_cells: usize,
    gas_cells: usize,
    /// With a sample every 0.05 s, as often as the other side steps.
    time: Timing,
    /// With a sample every 0.5 s.
    coarse_time: Timing,
    gas_rms_k: f64,
    gas_bias_k: f64,
    wall_rms_k: f64,
    pressure_rms_bar: f64,
}

/// The closed bottle at one tolerance.
#[derive(Debug, Serialize)]
pub(crate) struct Bottle {
    tolerance: f64,
    time: Timing,
    steps: usize,
    pressure_bar: f64,
    gas_k: f64,
    time_63_s: f64,
    /// Differences from the converged run.
    pressure_error_bar: f64,
    time_63_error_s: f64,
}

/// Everything of this case.
#[derive(Debug, Serialize)]
pub(crate) struct Results {
    blowdown: Vec<Blowdown>,
    stratified_high_rms_k: f64,
    stratified_low_rms_k: f64,
    stratified_time: Timing,
    bottle: Vec<Bottle>,
}

/// Runs both vessels.
pub(crate) fn run(stopwatch: &Stopwatch) -> anyhow::Result<Results> {
    let settings = SimulationSettings::default();
    let study = blowdown::study(&settings, &mut |_| ())?;
    let (vessel, scenario) = i1()?;
    let lumped = lumped(&vessel);
    let at = |coefficient: f64| blowdown::with_coefficient(&scenario, coefficient);
    let carrier = at(CARRIER_COEFFICIENT);
    let lumped_run = simulate(&lumped, &carrier, &settings, &mut |_| ())?;
    let lumped_scored = blowdown::scored(CARRIER_COEFFICIENT, lumped_run, &study.measured);
    let timed = |vessel: &Vessel, scenario: &Scenario| {
        stopwatch.time(1, || simulate(vessel, scenario, &settings, &mut |_| ()))
    };
    let described = |name, variant: &Variant, vessel: &Vessel| {
        let scenario = at(variant.coefficient);
        let coarse = Scenario { sample_time_s: COARSE_SAMPLE_S, ..scenario.clone() };
        blowdown_of(name, variant, [timed(vessel, &scenario), timed(vessel, &coarse)])
    };
    let stacked = blowdown::stacked_vessel(&vessel);
    Ok(Results {
        blowdown: vec![
            described("one wall node, as HydDown has", &lumped_scored, &lumped),
            described("60 wall cells", &study.carrier, &vessel),
            described("60 wall cells, discharge coefficient fitted to the pressure", &study.fitted, &vessel),
        ],
        stratified_high_rms_k: study.stacked.high.rms,
        stratified_low_rms_k: study.stacked.low.rms,
        stratified_time: timed(&stacked, &at(blowdown::STACKED_COEFFICIENT)),
        bottle: bottle(stopwatch)?,
    })
}

fn i1() -> anyhow::Result<(Vessel, Scenario)> {
    let mut scenario = scenario::presets::load("haque-i1")?;
    (scenario.duration_s, scenario.sample_time_s) = (DURATION_S, SAMPLE_S);
    Ok((vessel::presets::load("haque-i1")?, scenario))
}

fn lumped(vessel: &Vessel) -> Vessel {
    let mut lumped = vessel.clone();
    lumped.geometry.lumped = true;
    lumped
}

fn blowdown_of(name: &'static str, variant: &Variant, [time, coarse_time]: [Timing; 2]) -> Blowdown {
    let cells = |of: &[Vec<f64>]| of.first().map_or(0, Vec::len);
    let radial: usize = variant.run.vessel.geometry.layers.iter().map(|layer| layer.cells).sum();
    let columns = cells(&variant.run.wall_inner_k);
    Blowdown {
        name,
        discharge_coefficient: variant.coefficient,
        wall_cells: if variant.run.vessel.geometry.lumped { 1 } else { columns * radial },
        gas_cells: cells(&variant.run.gas_cells_k),
        time,
        coarse_time,
        gas_rms_k: variant.gas.rms,
        gas_bias_k: variant.gas.bias,
        wall_rms_k: variant.wall_high.rms,
        pressure_rms_bar: variant.pressure.rms,
    }
}

fn bottle(stopwatch: &Stopwatch) -> anyhow::Result<Vec<Bottle>> {
    let vessel = vessel::presets::load("closed-bottle")?;
    let mut scenario = scenario::presets::load("bottle-step")?;
    scenario.sample_time_s = BOTTLE_SAMPLE_S;
    let run_at = |relative_tolerance: f64| {
        let settings = SimulationSettings { relative_tolerance, ..SimulationSettings::default() };
        simulate(&vessel, &scenario, &settings, &mut |_| ())
    };
    let (_, exact_bar, exact_s) = ends(&run_at(CONVERGED)?);
    let one = |tolerance: f64| {
        let run = run_at(tolerance)?;
        let (gas_k, pressure_bar, time_63_s) = ends(&run);
        let time = stopwatch.time(1, || run_at(tolerance));
        anyhow::Ok(Bottle {
            tolerance,
            time,
            steps: run.statistics.steps,
            pressure_bar,
            gas_k,
            time_63_s,
            pressure_error_bar: pressure_bar - exact_bar,
            time_63_error_s: time_63_s - exact_s,
        })
    };
    TOLERANCES.into_iter().map(one).collect()
}

/// Gas temperature, K, and pressure, bar, at the end, and time to 63 % of the step, s.
fn ends(run: &Trajectory) -> (f64, f64, f64) {
    let last = |values: &[f64]| values.last().copied().unwrap_or(f64::NAN);
    let time_s = time_63_s(run, BOTTLE_AIR_K).unwrap_or(f64::NAN);
    (last(&run.gas_mean_k), last(&run.pressure_pa) / 1e5, time_s)
}
