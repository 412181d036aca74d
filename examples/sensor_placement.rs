//! Where should the thermometers of a cylinder sit: at its middle, or at shoulder and valve as the paper has them, standing and lying?
//!
//! `cargo run --release --example sensor_placement -- <folder>` (default `out`)
//!
//! Beside a pressure, one and then two of three thermometers are searched for by the certainty of the leak rate at rest. Then each is
//! judged while a train leaves a warm hall for cold air and comes back, with films, couplings and gas that are not as the observer
//! supposes. The attitude matters since the gas is stratified, which the observer does not know,
//! but it matters little: the middle is the better place standing and lying. `cylwatch place` takes every place.
#![allow(clippy::print_stdout)]

use cylwatch::estimator::placement::search::SearchControl;
use cylwatch::estimator::placement::study::{Placement, Position, Study, StudySettings};
use cylwatch::estimator::placement::{Candidates, Group};
use cylwatch::estimator::sensor::Sensor;
use cylwatch::evaluation::placement::ClosedLoopSettings;
use cylwatch::report::place::PlacementReport;
use cylwatch::report::{Provenance, aligned};
use cylwatch::thermal::scenario;
use cylwatch::thermal::vessel::{GasResolution, Stratification, Vessel, presets};
use cylwatch::thermal::wall::geometry::Orientation;
use std::path::PathBuf;

const SCENARIO: &str = r#"
name = "out of a warm hall and back"
duration_h = 2
sample_time_min = 4

[initial]
fill_pressure_bar = 200
temperature_degc = 20

[ambient]
air_degc = 20
film_w_m2_k = 20

[[ambient.air_change]]
at_min = 0
to_degc = -15

[[ambient.air_change]]
at_h = 1
to_degc = 20
"#;

/// What may sit on the cylinder; the pressure is always there.
const THERMOMETERS: [&str; 3] = ["middle", "shoulder", "valve"];
const ATTITUDES: [(&str, Orientation); 2] =
    [("standing", Orientation::Vertical), ("lying", Orientation::Horizontal)];
/// The gas as it is; the observer takes it to be well mixed.
const GAS: Stratification = Stratification { cells: 8, exchange_length_diameters: 1.0, core_mixing: 0.05 };
/// Nodes of the observer's wall, enough to tell these places apart.
const WALL_NODES: usize = 3;
/// Longest step of the observer, s: coarser than usual, for a third of the time.
const LONGEST_STEP_S: f64 = 60.0;

/// The study of a cylinder in one attitude.
pub(crate) struct Attitude {
    /// Its name.
    pub name: &'static str,
    /// The vessel.
    pub vessel: Vessel,
    /// What may sit on it.
    pub candidates: Candidates,
    /// What was found.
    pub study: Study,
}

impl Attitude {
    /// The study as it is shown.
    pub(crate) fn report(&self) -> PlacementReport<'_> {
        PlacementReport {
            study: &self.study,
            candidates: &self.candidates,
            vessel: &self.vessel,
            runs: ClosedLoopSettings::default(),
            closed_loop: None,
        }
    }

    /// One thermometer at a place, beside the pressure.
    pub(crate) fn position(&self, place: &str) -> Option<&Position> {
        let sensor = self.candidates.index(place)?;
        self.study.positions.iter().find(|position| position.sensor == sensor)
    }

    /// The thermometers of the best layouts.
    pub(crate) fn best(&self) -> Vec<String> {
        let names = |layout: &[usize]| {
            let names = self.candidates.names(layout).into_iter().filter(|name| *name != "pressure");
            names.collect::<Vec<_>>().join(" + ")
        };
        // Of the pressure alone there is no choice.
        self.study
            .numbers
            .iter()
            .filter(|number| number.sensors > 1)
            .map(|number| names(&number.layouts[0].sensors))
            .collect()
    }
}

/// Searches for both attitudes.
pub(crate) fn run() -> anyhow::Result<[Attitude; 2]> {
    let [standing, lying] = ATTITUDES;
    Ok([study(standing)?, study(lying)?])
}

fn study((name, orientation): (&'static str, Orientation)) -> anyhow::Result<Attitude> {
    let mut vessel = presets::load("nitrogen-20l")?;
    vessel.geometry.orientation = orientation;
    vessel.gas = GasResolution::Stratified(GAS);
    let scenario = scenario::read_scenario(SCENARIO, "the hall", &scenario::presets::table)?;
    let names = THERMOMETERS.into_iter().chain(["pressure"]);
    let sensors = names.map(Sensor::typical).collect::<Result<Vec<_>, _>>()?;
    let mut candidates = Candidates::of_sensors(&vessel, sensors)?;
    let thermometers: Vec<usize> = THERMOMETERS.iter().filter_map(|name| candidates.index(name)).collect();
    // The pressure alone knows nothing of the mass.
    candidates.groups.push(Group { fewest: 1, most: thermometers.len(), members: thermometers });
    let mut settings = StudySettings { sensors: 3, ..StudySettings::default() };
    settings.steady.observer.wall_nodes = WALL_NODES;
    settings.steady.observer.longest_step_s = LONGEST_STEP_S;
    let placement = Placement::new(&vessel, &candidates, &[scenario], &settings)?;
    let study = placement.run(&SearchControl::default())?;
    Ok(Attitude { name, vessel, candidates, study })
}

fn main() -> anyhow::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "out".into()));
    std::fs::create_dir_all(&folder)?;
    let attitudes = run()?;
    let command = "cargo run --release --example sensor_placement".to_owned();
    let provenance = Provenance { command, inputs: Vec::new(), seed: None };
    let mut rows = Vec::new();
    for attitude in &attitudes {
        let picture = attitude.report().figure();
        let file = format!("sensor-placement-{}", attitude.name);
        std::fs::write(folder.join(format!("{file}.svg")), picture.to_svg(&provenance)?)?;
        std::fs::write(folder.join(format!("{file}.png")), picture.to_png(&provenance)?)?;
        println!("{}: best beside the pressure: {}", attitude.name, attitude.best().join(", then "));
        for place in THERMOMETERS {
            let position = attitude.position(place);
            let steady = position.and_then(|position| position.steady);
            let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.3}"));
            rows.push(vec![
                attitude.name.to_owned(),
                place.to_owned(),
                number(steady.map(|of| of.gas_sd_k)),
                number(position.and_then(|of| of.robust_k.first().copied())),
                number(steady.map(|of| 3.6e6 * of.smallest_leak_kg_s)),
            ]);
        }
    }
    let header = ["attitude", "one at", "sd at rest / K", "with model error / K", "smallest leak / g/h"];
    print!("\n{}", aligned(&header, &rows));
    println!("\nFigures: sensor-placement-standing.svg and -lying.svg in {}", folder.display());
    Ok(())
}
