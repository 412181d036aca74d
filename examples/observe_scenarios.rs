//! How well do sensors outside tell temperature and mass of the gas, beside the paper's transfer function?
//!
//! `cargo run --release --example observe_scenarios -- <folder>`
//!
//! Each of the paper's four scenarios, on cylinders that differ from the one that the observer knows: drawn dimensions, film
//! coefficients, mounting, sensor errors, a stratified gas. The observer and the published transfer function see the
//! same readings: shoulder, valve and pressure the one, shoulder (and pressure, for the mass) the other. Writes a
//! figure of one cylinder for each scenario, and prints the errors over several.
#![allow(clippy::print_stdout)]

use anyhow::Context;
use cylwatch::estimator::identify::published::TransferFunction;
use cylwatch::estimator::observer::{Commissioning, Observer, ObserverSettings};
use cylwatch::estimator::sensor::Sensor;
use cylwatch::estimator::truth::{Course, Truth, generate};
use cylwatch::report::figure::{Figure, Horizontal, Item, Mark, Panel, style};
use cylwatch::report::{Provenance, aligned};
use cylwatch::thermal::units::ZERO_CELSIUS_K;
use cylwatch::thermal::vessel::{Vessel, presets};
use std::path::PathBuf;

const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];
/// The scenarios with their titles.
pub const COURSES: [(Course, &str); 4] = [
    (Course::Scenario1, "scenario 1: from 21 to \u{2212}25 °C at once"),
    (Course::Scenario2, "scenario 2: from \u{2212}25 to 40 °C at once"),
    (Course::Scenario3, "scenario 3: from 10 to 60 °C in 5 h"),
    (Course::Scenario4, "scenario 4: from 60 to 28 °C in 14 h"),
];
/// Samples, s.
const SAMPLE_S: f64 = 30.0;
/// Cylinders for the table; the first is drawn.
const SEEDS: std::ops::Range<u64> = 1..9;

/// Estimates beside the truth, sample by sample.
pub struct Comparison {
    truth: Truth,
    /// Observer: gas mean in °C with its standard deviation, mass in kg with its standard deviation.
    observer: Vec<[f64; 4]>,
    /// Transfer function: gas mean in °C, mass in kg.
    transfer: Vec<[f64; 2]>,
}

/// Root mean squares from the change of the air on.
pub struct Errors {
    /// Mean gas temperature by the observer, K, and by the transfer function.
    pub gas_k: [f64; 2],
    /// Mass, g, likewise.
    pub mass_g: [f64; 2],
    /// Share of the samples with the true temperature within two standard deviations.
    pub covered: f64,
}

impl Comparison {
    /// Runs both over a cylinder drawn by a seed.
    pub fn new(course: &Course, nominal: &Vessel, seed: u64) -> anyhow::Result<Self> {
        let truth = generate(course, seed, SAMPLE_S)?;
        let sensors = SENSORS.map(Sensor::typical).into_iter().collect::<Result<Vec<_>, _>>()?;
        let filled = Commissioning::filled(200e5, ZERO_CELSIUS_K + 15.0);
        let mut observer = Observer::new(nominal, &sensors, &filled, &ObserverSettings::default())?;
        let mut transfer = TransferFunction::PUBLISHED;
        let of = |name: &str| truth.log.channels.iter().position(|channel| channel.name == name);
        let columns = SENSORS.map(of).map(|column| column.context("a sensor is missing"));
        let [shoulder, valve, pressure] = columns;
        let columns = [shoulder?, valve?, pressure?];
        let (mut by_observer, mut by_transfer) = (Vec::new(), Vec::new());
        for (time_s, row) in truth.log.rows() {
            let readings = columns.map(|column| row[column]);
            let e = observer.step(time_s, &readings)?;
            by_observer.push([e.gas_mean_k - ZERO_CELSIUS_K, e.gas_mean_sd_k, e.mass_kg, e.mass_sd_kg]);
            let gas_degc = transfer.step(time_s, readings[0] - ZERO_CELSIUS_K);
            let (gas_k, pressure_pa) = (gas_degc + ZERO_CELSIUS_K, readings[2]);
            let density = nominal.fluid.density_from_pressure_temperature(pressure_pa, gas_k)?;
            by_transfer.push([gas_degc, density * nominal.volume.volume_m3(gas_k, pressure_pa)]);
        }
        Ok(Self { truth, observer: by_observer, transfer: by_transfer })
    }

    /// Errors of mean gas temperature, K: observer and transfer function.
    fn gas_errors(&self) -> [Vec<f64>; 2] {
        let truth = || self.truth.gas_mean_k.iter().map(|gas_k| gas_k - ZERO_CELSIUS_K);
        let observer = truth().zip(&self.observer).map(|(gas, e)| e[0] - gas).collect();
        [observer, truth().zip(&self.transfer).map(|(gas, e)| e[0] - gas).collect()]
    }

    /// Errors of the mass, g: observer and transfer function.
    fn mass_errors(&self) -> [Vec<f64>; 2] {
        let truth = || self.truth.mass_kg.iter();
        let observer = truth().zip(&self.observer).map(|(mass, e)| 1e3 * (e[2] - mass)).collect();
        [observer, truth().zip(&self.transfer).map(|(mass, e)| 1e3 * (e[1] - mass)).collect()]
    }

    /// First sample after the air begins to change.
    fn change(&self) -> usize {
        self.truth.time_s.partition_point(|&time_s| time_s < self.truth.course.change_s())
    }

    /// Errors from the change of the air on.
    pub fn errors(&self) -> Errors {
        let rms = |errors: &[f64]| {
            let judged = &errors[self.change()..];
            (judged.iter().map(|error| error * error).sum::<f64>() / judged.len() as f64).sqrt()
        };
        let gas = self.gas_errors();
        let judged = gas[0].iter().zip(&self.observer).skip(self.change());
        let inside = judged.filter(|(error, e)| error.abs() <= 2.0 * e[1]).count();
        Errors {
            covered: inside as f64 / (self.observer.len() - self.change()) as f64,
            mass_g: self.mass_errors().map(|errors| rms(&errors)),
            gas_k: gas.map(|errors| rms(&errors)),
        }
    }

    /// Temperatures, errors of the mean gas temperature, errors of the mass.
    pub fn figure(&self, title: &str) -> Figure {
        let time = &self.truth.time_s;
        let celsius = |k: &[f64]| k.iter().map(|k| k - ZERO_CELSIUS_K).collect::<Vec<f64>>();
        let [gas, transfer] = self.gas_errors();
        let [mass, transfer_mass] = self.mass_errors();
        let band = |sd: usize, factor: f64| {
            let high: Vec<f64> = self.observer.iter().map(|e| 2.0 * factor * e[sd]).collect();
            let low = high.iter().map(|high| -high).collect();
            Item::Band { name: "stated, ± 2 sd".into(), x: time.clone(), low, high }
        };
        let shoulder = self.truth.log.rows().map(|(_, row)| row[0] - ZERO_CELSIUS_K);
        let temperatures = vec![
            Item::line("air", time, celsius(&self.truth.ambient_k), style::AIR),
            Item::line("shoulder as read", time, shoulder, style::sensor("shoulder", 0)),
            Item::line("transfer function", time, self.transfer.iter().map(|e| e[0]), style::SECOND),
            Item::line("observer", time, self.observer.iter().map(|e| e[0]), style::GAS_MEAN),
            Item::line("gas, truth", time, celsius(&self.truth.gas_mean_k), style::FIRST),
        ];
        let errors = |band: Item, transfer: Vec<f64>, observer: Vec<f64>| {
            vec![
                band,
                Item::line("transfer function", time, transfer, style::SECOND),
                Item::line("observer", time, observer, style::GAS_MEAN),
            ]
        };
        let panels = vec![
            Panel { quantity: "temperature in °C".into(), items: temperatures, height: 1.1 },
            Panel {
                quantity: "gas error in K".into(),
                items: errors(band(1, 1.0), transfer, gas),
                height: 0.8,
            },
            Panel {
                quantity: "mass error in g".into(),
                items: errors(band(3, 1e3), transfer_mass, mass),
                height: 0.8,
            },
        ];
        let marks = vec![Mark { at: self.truth.course.change_s(), name: "the air changes".into() }];
        Figure { title: title.into(), horizontal: Horizontal::Time, panels, marks, below: None }
    }
}

fn main() -> anyhow::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).context("usage: observe_scenarios <folder>")?);
    std::fs::create_dir_all(&folder)?;
    let nominal = presets::load("nitrogen-20l")?;
    let mut rows = Vec::new();
    for (number, (course, title)) in (1..).zip(COURSES) {
        let mut all = Vec::new();
        for seed in SEEDS {
            let comparison = Comparison::new(&course, &nominal, seed)?;
            if seed == SEEDS.start {
                let command = "cargo run --release --example observe_scenarios".to_owned();
                let provenance = Provenance { command, inputs: Vec::new(), seed: Some(seed) };
                let figure = comparison.figure(title);
                std::fs::write(folder.join(format!("scenario-{number}.svg")), figure.to_svg(&provenance)?)?;
                std::fs::write(folder.join(format!("scenario-{number}.png")), figure.to_png(&provenance)?)?;
            }
            all.push(comparison.errors());
        }
        let pooled = |value: &dyn Fn(&Errors) -> f64| {
            (all.iter().map(|errors| value(errors).powi(2)).sum::<f64>() / all.len() as f64).sqrt()
        };
        let [gas, gas_transfer] = [0, 1].map(|which| format!("{:.2}", pooled(&|e| e.gas_k[which])));
        let [mass, mass_transfer] = [0, 1].map(|which| format!("{:.1}", pooled(&|e| e.mass_g[which])));
        let covered = all.iter().map(|errors| errors.covered).sum::<f64>() / all.len() as f64;
        let covered = format!("{:.0}", 100.0 * covered);
        rows.push(vec![number.to_string(), gas, gas_transfer, mass, mass_transfer, covered]);
    }
    let header = [
        "scenario",
        "gas, observer / K",
        "transfer function / K",
        "mass, observer / g",
        "transfer function / g",
        "within 2 sd / %",
    ];
    print!("{}", aligned(&header, &rows));
    println!(
        "\nRoot mean squares from the change of the air on, over {} cylinders.",
        SEEDS.end - SEEDS.start
    );
    Ok(())
}
