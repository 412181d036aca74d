//! The paper rebuilt: every figure and table from the model, beside the paper's own numbers, and what the observer adds.
//!
//! | part | what |
//! |---|---|
//! | `section_2` | gas mass and heat capacities |
//! | [`cylinder`] | scenarios 1 to 4 (figure 1), the pressure line of a tight cylinder |
//! | [`table_1`], `identification` | table 1, figures 2 and 3 |
//! | `scheme` | figures 4, 5, 7 as graphs that run; figures 6 and 8 by them |
//! | `methods`, `passage` | figures 6 and 8 on a simulated cylinder |
//! | `drawn_cylinders` | published, refitted, observer and bound on drawn cylinders |
//! | [`blowdown`], [`measured`] | the model beside a measured blowdown |
//! | `checks`, `comparison` | numbers and their references; paper, here, why they differ |
//!
//! `run` computes, `Reproduction::report` is the report, `Reproduction::files` gives the files to write.
pub mod blowdown;
pub(crate) mod checks;
mod comparison;
pub mod cylinder;
mod drawn_cylinders;
mod figures;
mod files;
mod identification;
pub mod measured;
mod methods;
mod paragraphs;
mod passage;
mod report;
mod scheme;
mod section_2;
pub mod table_1;
mod tables;

use crate::detector::DetectorError;
use crate::estimator::EstimatorError;
use crate::estimator::identify::IdentifyError;
use crate::evaluation::world::chamber::Chamber;
use crate::report::{Input, ReportError};
use crate::thermal::ThermalError;
use crate::thermal::simulate::SimulationSettings;
use crate::thermal::{scenario, vessel};
use blowdown::Blowdown;
use cylinder::{SCENARIOS, ScenarioRun, TightCylinder, VESSEL};
use drawn_cylinders::{LEAKS_G_H, LeakScore, ScenarioScore};
use identification::Identification;
use passage::{Case, Passage, passage};
use scheme::SchemeRun;
use section_2::Section2;

/// Why a reproduction stops.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReproduceError {
    /// A vessel, a scenario or a simulation.
    #[error(transparent)]
    Thermal(#[from] ThermalError),
    /// The sensors' readings, the observer or its bound.
    #[error(transparent)]
    Estimator(#[from] EstimatorError),
    /// An identification.
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    /// A detector.
    #[error(transparent)]
    Detector(#[from] DetectorError),
    /// A figure.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// A sensor that must be there.
    #[error("there is no sensor {name}: the readings need shoulder, valve and pressure")]
    Sensor {
        /// Its name.
        name: &'static str,
    },
    /// No cylinders to draw.
    #[error("0 cylinders are drawn: at least 1 is needed")]
    NoCylinders,
}

/// How the paper is rebuilt.
#[derive(Clone, Debug)]
pub(crate) struct Settings {
    /// Of the simulations of built-in scenarios.
    pub simulation: SimulationSettings,
    /// Seed of everything random.
    pub seed: u64,
    /// Drawn cylinders of each case.
    pub cylinders: u64,
}

impl Default for Settings {
    /// Seed 1, eight cylinders.
    fn default() -> Self {
        Self { simulation: SimulationSettings::default(), seed: 1, cylinders: 8 }
    }
}

/// Everything that was computed.
#[derive(Clone, Debug)]
pub(crate) struct Reproduction {
    /// Gas mass and heat capacities.
    pub(crate) section_2: Section2,
    /// Scenarios 1 to 4 of the paper.
    pub(crate) scenarios: Vec<ScenarioRun>,
    /// A closed bottle after a step of the air temperature.
    pub(crate) closed: ScenarioRun,
    /// What the equation of state says about a tight cylinder.
    pub(crate) tight: TightCylinder,
    /// The measured blowdown I1.
    pub(crate) blowdown: Blowdown,
    /// Table 1, figures 2 and 3.
    pub(crate) identification: Identification,
    /// Figures 6 and 8 by the paper's scheme.
    pub(crate) scheme: SchemeRun,
    /// Figure 6 on a simulated cylinder.
    pub(crate) tunnel: Passage,
    /// Figure 8 on a simulated cylinder without its leak, for thresholds, and with it.
    pub(crate) leak: [Passage; 2],
    /// Scenarios 1 to 4 on drawn cylinders.
    pub(crate) drawn_cylinders: Vec<ScenarioScore>,
    /// Leaks after a tunnel on drawn cylinders.
    pub(crate) leaks: Vec<LeakScore>,
    /// Cylinders of each case.
    pub(crate) cylinders: u64,
    /// Seed.
    pub(crate) seed: u64,
}

/// Tells what is being done and which share of the work is done; steps count what they take, in parts of a second or so.
struct Work<'a> {
    done: f64,
    all: f64,
    progress: &'a mut dyn FnMut(&str, f64),
}

impl Work<'_> {
    /// Does a step.
    fn step<T>(
        &mut self,
        what: &str,
        weight: f64,
        compute: impl FnOnce(&mut dyn FnMut(f64)) -> Result<T, ReproduceError>,
    ) -> Result<T, ReproduceError> {
        let (before, all) = (self.done, self.all);
        let progress = &mut *self.progress;
        progress(what, before / all);
        let result = compute(&mut |share| progress(what, (before + share * weight) / all))?;
        self.done += weight;
        Ok(result)
    }
}

/// Weights of the steps: parts of the whole time, about.
const QUICK: f64 = 1.0;
const DRAWN: f64 = 12.0;

/// Computes everything; `progress` gets the current step and the share that is done.
///
/// # Errors
/// A simulation, an identification or a detector fails.
pub(crate) fn run(
    settings: &Settings,
    progress: &mut dyn FnMut(&str, f64),
) -> Result<Reproduction, ReproduceError> {
    let all = 12.0 * QUICK + DRAWN * (Chamber::SCENARIOS.len() + 1 + LEAKS_G_H.len()) as f64;
    let mut work = Work { done: 0.0, all, progress };
    let simulation = &settings.simulation;
    let tight = cylinder::tight()?;
    let scenarios = SCENARIOS
        .into_iter()
        .map(|name| work.step(name, QUICK, |share| cylinder::simulated(VESSEL, name, simulation, share)))
        .collect::<Result<Vec<_>, _>>()?;
    let closed = work.step("closed bottle", QUICK, |share| {
        cylinder::simulated("closed-bottle", "bottle-step", simulation, share)
    })?;
    let blowdown = work.step("blowdown I1", 2.0 * QUICK, |share| {
        blowdown::study(simulation, &mut |k| share(k as f64 / blowdown::runs() as f64))
    })?;
    let identification = work.step("table 1, figures 2 and 3", QUICK, |_| Identification::study())?;
    let pole_per_s = identification.refitted_pole_per_s();
    let seed = settings.seed;
    let mut passed = |what, case, seed| work.step(what, QUICK, |_| passage(case, pole_per_s, seed));
    let tunnel = passed("figure 6", Case::Tight, seed)?;
    // The tight passage that thresholds come from has other noise than the one that is judged.
    let leak = [
        passed("figure 8", Case::TightLong, seed.wrapping_add(1))?,
        passed("figure 8", Case::Leaking, seed.wrapping_add(2))?,
    ];
    let drawn = drawn_cylinders::Settings { cylinders: settings.cylinders, seed, pole_per_s };
    let drawn_cylinders = (0..Chamber::SCENARIOS.len())
        .map(|k| {
            let what = format!("scenario {} on drawn cylinders", k + 1);
            work.step(&what, DRAWN, |_| drawn.scenario(k, tight.slope_bar_k))
        })
        .collect::<Result<Vec<_>, _>>()?;
    let silent = work.step("tunnel on drawn tight cylinders", DRAWN, |_| drawn.tight())?;
    let leaks = (0..LEAKS_G_H.len())
        .map(|k| work.step("leaks on drawn cylinders", DRAWN, |_| drawn.leak(k, &silent)))
        .collect::<Result<Vec<_>, _>>()?;
    Ok(Reproduction {
        section_2: Section2::evaluated()?,
        scheme: scheme::run(seed),
        cylinders: settings.cylinders,
        scenarios,
        closed,
        tight,
        blowdown,
        identification,
        tunnel,
        leak,
        drawn_cylinders,
        leaks,
        seed,
    })
}

/// Records of everything that is embedded and read by [`run`].
pub(crate) fn inputs() -> Vec<Input> {
    let vessels = [VESSEL, "nitrogen-20l-paper", "closed-bottle", "haque-i1"]
        .map(|name| ("vessel", name, vessel::presets::FILES.text(name)));
    let mut names = SCENARIOS.to_vec();
    names.extend(["tunnel-step", "leak-after-tunnel", "bottle-step", "haque-i1"]);
    let scenarios = names.into_iter().map(|name| ("scenario", name, scenario::presets::FILES.text(name)));
    let presets = vessels.into_iter().chain(scenarios).filter_map(|(kind, name, text)| {
        Some(Input::of(format!("preset {kind} {name}"), text.ok()?.as_bytes()))
    });
    presets.chain(measured::FILES.iter().map(|(name, text)| Input::of(*name, text.as_bytes()))).collect()
}

#[cfg(test)]
mod tests;
