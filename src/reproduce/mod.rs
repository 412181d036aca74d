//! The paper's scenarios from the model, and the model beside a measured blowdown.
//!
//! [`run`] computes, [`Reproduction::files`] gives the files to write, [`rows`] the table of what was reached.
pub mod blowdown;
pub mod cylinder;
mod figures;
pub mod measured;
pub mod rows;

use crate::estimator::EstimatorError;
use crate::report::figure::Figure;
use crate::report::{Input, Provenance, ReportError, Table, simulation};
use crate::thermal::ThermalError;
use crate::thermal::simulate::SimulationSettings;
use crate::thermal::{scenario, vessel};
use blowdown::Blowdown;
use cylinder::{SCENARIOS, ScenarioRun, TightCylinder, VESSEL};
use measured::interpolated;
use serde_json::json;

/// Why a reproduction stops.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReproduceError {
    /// A vessel, a scenario or a simulation.
    #[error(transparent)]
    Thermal(#[from] ThermalError),
    /// The sensors' readings.
    #[error(transparent)]
    Estimator(#[from] EstimatorError),
    /// A figure.
    #[error(transparent)]
    Report(#[from] ReportError),
}

/// Everything that was computed.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// Scenarios 1 to 4 of the paper.
    pub scenarios: Vec<ScenarioRun>,
    /// A closed bottle after a step of the air temperature.
    pub closed: ScenarioRun,
    /// What the equation of state says about a tight cylinder.
    pub tight: TightCylinder,
    /// The measured blowdown I1.
    pub blowdown: Blowdown,
}

/// A file to write: name and content.
pub type File = (String, Vec<u8>);

/// Computes everything; `progress` is told what is being done and which share is done.
///
/// # Errors
/// A simulation fails.
pub fn run(
    settings: &SimulationSettings,
    progress: &mut dyn FnMut(&str, f64),
) -> Result<Reproduction, ReproduceError> {
    let total = (SCENARIOS.len() + 1 + blowdown::runs()) as f64;
    let tight = cylinder::tight()?;
    let mut scenarios = Vec::new();
    for (k, name) in SCENARIOS.into_iter().enumerate() {
        let mut show = |done: f64| progress(name, (k as f64 + done) / total);
        scenarios.push(cylinder::simulated(VESSEL, name, settings, &mut show)?);
    }
    let before = SCENARIOS.len() as f64;
    let mut show = |done: f64| progress("closed bottle", (before + done) / total);
    let closed = cylinder::simulated("closed-bottle", "bottle-step", settings, &mut show)?;
    let mut show = |k: usize| progress("blowdown I1", (before + 1.0 + k as f64) / total);
    let blowdown = blowdown::study(settings, &mut show)?;
    Ok(Reproduction { scenarios, closed, tight, blowdown })
}

/// Records of everything that is embedded and read by [`run`].
pub fn inputs() -> Vec<Input> {
    let vessels =
        [VESSEL, "closed-bottle", "haque-i1"].map(|name| ("vessel", name, vessel::presets::text(name)));
    let mut names = SCENARIOS.to_vec();
    names.extend(["bottle-step", "haque-i1"]);
    let scenarios = names.into_iter().map(|name| ("scenario", name, scenario::presets::text(name)));
    let presets = vessels
        .into_iter()
        .chain(scenarios)
        .filter_map(|(kind, name, text)| Some(Input::of(format!("preset {kind} {name}"), text?.as_bytes())));
    presets.chain(measured::FILES.iter().map(|(name, text)| Input::of(*name, text.as_bytes()))).collect()
}

impl Reproduction {
    /// All files: every figure as SVG and PNG, every run as CSV, the results as JSON.
    ///
    /// # Errors
    /// A figure cannot be drawn.
    pub fn files(&self, provenance: &Provenance) -> Result<Vec<File>, ReportError> {
        let mut files = Vec::new();
        for scenario in self.scenarios.iter().chain([&self.closed]) {
            let ScenarioRun { name, run, readings, .. } = scenario;
            files.extend(drawn(name, &simulation::figure(run, readings), provenance)?);
            let csv = simulation::table(run, readings).to_csv(provenance, &simulation::remarks(run));
            files.push((format!("{name}.csv"), csv.into_bytes()));
        }
        files.extend(drawn("tight-cylinder", &figures::tight(&self.tight), provenance)?);
        files.extend(drawn("blowdown-i1", &figures::blowdown(&self.blowdown), provenance)?);
        let csv = self.comparison().to_csv(provenance, &[]);
        files.push(("blowdown-i1.csv".into(), csv.into_bytes()));
        files.push(("results.json".into(), self.document(provenance).into_bytes()));
        Ok(files)
    }

    /// The blowdown's measured and computed values at common times.
    fn comparison(&self) -> Table {
        let Blowdown { measured, carrier, fitted, .. } = &self.blowdown;
        let times: Vec<f64> = blowdown::times_s().collect();
        let mut table = Table::new(7);
        table.push("time_s", times.iter().copied());
        let mut push =
            |name: &str, value: &dyn Fn(f64) -> f64| table.push(name, times.iter().map(|&t| value(t)));
        push("measured_pressure_bar", &|t| measured.pressure_bar.at(t));
        push("measured_gas_low_degc", &|t| measured.gas_low_k.at(t) - 273.15);
        push("measured_gas_high_degc", &|t| measured.gas_high_k.at(t) - 273.15);
        push("measured_wall_low_degc", &|t| measured.wall_low_k.at(t) - 273.15);
        push("measured_wall_high_degc", &|t| measured.wall_high_k.at(t) - 273.15);
        for (variant, name) in [(carrier, "carrier"), (fitted, "fitted")] {
            let run = &variant.run;
            let wall_k = blowdown::wall_middle_k(run);
            push(&format!("{name}_pressure_bar"), &|t| interpolated(&run.time_s, &run.pressure_pa, t) / 1e5);
            push(&format!("{name}_gas_mean_degc"), &|t| {
                interpolated(&run.time_s, &run.gas_mean_k, t) - 273.15
            });
            push(&format!("{name}_wall_inner_degc"), &|t| interpolated(&run.time_s, &wall_k, t) - 273.15);
        }
        table
    }

    fn document(&self, provenance: &Provenance) -> String {
        let scenario = |scenario: &ScenarioRun| {
            json!({
                "scenario": scenario.name,
                "wall_time_s": scenario.wall_time_s,
                "solver": simulation::statistics(&scenario.run),
                "ledger": simulation::ledger(&scenario.run),
            })
        };
        let document = json!({
            "provenance": provenance.to_json(),
            "results": rows::rows(self).iter().map(rows::Row::to_json).collect::<Vec<_>>(),
            "scenarios": self.scenarios.iter().chain([&self.closed]).map(scenario).collect::<Vec<_>>(),
        });
        format!("{document:#}\n")
    }
}

fn drawn(name: &str, figure: &Figure, provenance: &Provenance) -> Result<[File; 2], ReportError> {
    Ok([
        (format!("{name}.svg"), figure.to_svg(provenance)?.into_bytes()),
        (format!("{name}.png"), figure.to_png(provenance)?),
    ])
}
