//! Figure 6 of the paper: what pressure is expected when a train enters a warm tunnel, and what pressure is there?
//!
//! `cargo run --release --example figure_6 -- <folder>` (default `out`)
//!
//! Above, the paper's own scheme: the shoulder jumps from -10 to 35 °C, the published transfer function makes the gas of it,
//! the published slope the pressure. The cylinder is that same model, so expected and actual pressure are one curve.
//! Below, the same passage of a simulated tight cylinder with a real gas and a wall: now the published expectation is
//! off by bars, a refitted one by less, and the observer's settled pressure stays where it was.
#![allow(clippy::print_stdout)]

use anyhow::Context;
use cylwatch::detector::baseline::{
    Expectation, Filling, GasModel, GasTemperature, Law, PressureError, Reading,
};
use cylwatch::estimator::observer::{Commissioning, Observer, ObserverSettings};
use cylwatch::estimator::sensor::SensorSuite;
use cylwatch::report::figure::{Figure, Horizontal, Item, Mark, Panel, style};
use cylwatch::report::{Provenance, Readings, aligned};
use cylwatch::thermal::simulate::{SimulationSettings, simulate};
use cylwatch::thermal::units::ZERO_CELSIUS_K;
use cylwatch::thermal::{scenario, vessel};
use std::path::PathBuf;

const BAR: f64 = 1e5;
const FULL: Filling = Filling { pressure_pa: 200.0 * BAR, temperature_k: ZERO_CELSIUS_K + 15.0 };
/// Entry into the tunnel, s.
const ENTRY_S: f64 = 600.0;
const SEED: u64 = 6;
const COMMAND: &str = "cargo run --release --example figure_6";

/// The paper's scheme, a sample every 10 s.
pub struct Scheme {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Shoulder, °C.
    pub shoulder_degc: Vec<f64>,
    /// Gas by the published transfer function, °C.
    pub gas_degc: Vec<f64>,
    /// Expected pressure, bar, which is the actual one here.
    pub pressure_bar: Vec<f64>,
}

/// A simulated tight cylinder in the same passage.
pub struct Passage {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Air, shoulder as read, and gas, °C.
    pub temperatures_degc: [Vec<f64>; 3],
    /// Pressure as read, bar.
    pub pressure_bar: Vec<f64>,
    /// Expected pressures, bar: published, and refitted (gain 1, real gas).
    pub expected_bar: [Vec<f64>; 2],
    /// Pressure that seems to be missing, bar: published, refitted, and by the observer.
    pub missing_bar: [Vec<f64>; 3],
}

/// Who looks for missing pressure, in the order of [`Passage::missing_bar`].
pub const WHO: [&str; 3] = ["published", "refitted, real gas", "observer"];

/// The paper's scheme.
pub fn scheme() -> anyhow::Result<Scheme> {
    let time_s: Vec<f64> = (0..=1080).map(|n| 10.0 * f64::from(n)).collect();
    let shoulder_degc: Vec<f64> = time_s.iter().map(|&t| if t <= ENTRY_S { -10.0 } else { 35.0 }).collect();
    let mut gas = GasTemperature::try_new(GasModel::PUBLISHED)?;
    let gas_k = time_s.iter().zip(&shoulder_degc).map(|(&t, degc)| gas.step(t, degc + ZERO_CELSIUS_K));
    let gas_k = gas_k.collect::<Option<Vec<f64>>>().context("times increase")?;
    let pressure_bar = gas_k.iter().map(|&gas_k| FULL.published_pressure_pa(gas_k) / BAR).collect();
    let gas_degc = gas_k.iter().map(|gas_k| gas_k - ZERO_CELSIUS_K).collect();
    Ok(Scheme { time_s, shoulder_degc, gas_degc, pressure_bar })
}

/// Expectations of the published and of the refitted model.
fn errors() -> anyhow::Result<[PressureError; 2]> {
    let real_gas = Expectation::try_new(Law::RealGas { gas: "nitrogen".into() }, FULL)?;
    let refitted = GasModel::FirstOrder { gain: 1.0, pole_per_s: 0.002_988, initial_degc: None };
    Ok([PressureError::published(FULL)?, PressureError::try_new(real_gas, refitted)?])
}

/// The simulated passage.
pub fn passage() -> anyhow::Result<Passage> {
    let vessel = vessel::presets::load("nitrogen-20l")?;
    let scenario = scenario::presets::load("tunnel-step")?;
    let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
    let log = Readings::sampled(&run, SEED)?.log;
    let names: Vec<&str> = log.channels.iter().map(|channel| channel.name.as_str()).collect();
    let of = |name: &str| names.iter().position(|found| *found == name).context("a sensor is missing");
    let (shoulder, pressure) = (of("shoulder")?, of("pressure")?);
    let suite = SensorSuite::from(&scenario);
    let filled = Commissioning::filled(FULL.pressure_pa, FULL.temperature_k);
    let mut observer = Observer::new(&vessel, suite.sensors(), &filled, &ObserverSettings::default())?;
    let mut errors = errors()?;
    let mut missing_bar: [Vec<f64>; 3] = Default::default();
    let mut settled_bar = Vec::new();
    for (time_s, row) in log.rows() {
        let reading = Reading { time_s, shoulder_k: row[shoulder], pressure_pa: row[pressure] };
        for (missing, error) in missing_bar.iter_mut().zip(&mut errors) {
            missing.push(error.step(reading).context("all readings are there")? / BAR);
        }
        settled_bar.push(observer.step(time_s, row)?.p15_pa / BAR);
    }
    let before = log.time_s.partition_point(|&t| t < ENTRY_S) - 1;
    missing_bar[2] = settled_bar.iter().map(|settled| settled_bar[before] - settled).collect();
    let celsius = |k: &[f64]| k.iter().map(|k| k - ZERO_CELSIUS_K).collect::<Vec<f64>>();
    let column = |of: usize| log.rows().map(|(_, row)| row[of]).collect::<Vec<f64>>();
    let pressure_bar: Vec<f64> = column(pressure).iter().map(|p| p / BAR).collect();
    let expected =
        |missing: &Vec<f64>| missing.iter().zip(&pressure_bar).map(|(e, p)| e + p).collect::<Vec<f64>>();
    Ok(Passage {
        temperatures_degc: [celsius(&run.ambient_k), celsius(&column(shoulder)), celsius(&run.gas_mean_k)],
        expected_bar: [expected(&missing_bar[0]), expected(&missing_bar[1])],
        time_s: log.time_s,
        pressure_bar,
        missing_bar,
    })
}

fn panel(quantity: &str, height: f64, items: Vec<Item>) -> Panel {
    Panel { quantity: quantity.into(), items, height }
}

/// Both parts.
pub fn figure(scheme: &Scheme, passage: &Passage) -> Figure {
    let marks = || vec![Mark { at: ENTRY_S, name: "t1: tunnel".into() }];
    let (t, x) = (&passage.time_s, &scheme.time_s);
    let curve = |values: &[f64]| values.to_vec();
    let [air, shoulder, gas] = &passage.temperatures_degc;
    let [published, refitted, observer] = &passage.missing_bar;
    let simulated = vec![
        panel(
            "temperature in °C",
            0.8,
            vec![
                Item::line("air", t, curve(air), style::AIR),
                Item::line("shoulder as read", t, curve(shoulder), style::SHOULDER),
                Item::line("gas", t, curve(gas), style::GAS_MEAN),
            ],
        ),
        panel(
            "pressure in bar",
            0.9,
            vec![
                Item::line("published", t, curve(&passage.expected_bar[0]), style::FIRST),
                Item::line("refitted, real gas", t, curve(&passage.expected_bar[1]), style::THIRD),
                Item::line("as read", t, curve(&passage.pressure_bar), style::PRESSURE),
            ],
        ),
        panel(
            "missing in bar",
            0.9,
            vec![
                Item::line("published", t, curve(published), style::FIRST),
                Item::line("refitted, real gas", t, curve(refitted), style::THIRD),
                Item::line("observer", t, curve(observer), style::GAS_MEAN),
            ],
        ),
    ];
    let own = vec![
        panel(
            "temperature in °C",
            0.7,
            vec![
                Item::line("shoulder", x, curve(&scheme.shoulder_degc), style::SHOULDER),
                Item::line("gas, published\ntransfer function", x, curve(&scheme.gas_degc), style::GAS_MEAN),
            ],
        ),
        panel(
            "pressure in bar",
            0.7,
            vec![
                Item::line("actual", x, curve(&scheme.pressure_bar), style::PRESSURE),
                Item::line("expected", x, curve(&scheme.pressure_bar), style::FIRST),
            ],
        ),
    ];
    let part = |title: &str, panels, below| Figure {
        title: title.into(),
        horizontal: Horizontal::Time,
        panels,
        marks: marks(),
        below,
    };
    let below = part("a simulated tight cylinder in the same passage", simulated, None);
    part("figure 6: the paper's scheme, cylinder and model are one", own, Some(Box::new(below)))
}

fn main() -> anyhow::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "out".into()));
    std::fs::create_dir_all(&folder)?;
    let (scheme, passage) = (scheme()?, passage()?);
    let provenance = Provenance { command: COMMAND.into(), inputs: Vec::new(), seed: Some(SEED) };
    let figure = figure(&scheme, &passage);
    std::fs::write(folder.join("figure-6.svg"), figure.to_svg(&provenance)?)?;
    std::fs::write(folder.join("figure-6.png"), figure.to_png(&provenance)?)?;
    let rows = WHO.iter().zip(&passage.missing_bar).map(|(who, missing)| {
        let largest = missing.iter().fold(0.0, |most: f64, e| if e.abs() > most.abs() { *e } else { most });
        let end = missing[missing.len() - 1];
        vec![(*who).to_owned(), format!("{largest:.2}"), format!("{end:.2}")]
    });
    let header = ["what is missing, by", "at most / bar", "after 3 h / bar"];
    print!("{}", aligned(&header, &rows.collect::<Vec<_>>()));
    println!("\nNothing is missing. Figure: {}", folder.join("figure-6.svg").display());
    Ok(())
}
