//! Can a leak hide behind a warming day?
//!
//! `cargo run --release --example leak_masked_by_warming -- <folder>` (default `out`)
//!
//! A cylinder loses gas while the air warms from 2 to 27 °C in 15 h, just so fast that the pressure stands still. No gauge and
//! no switch can see it; the monitor, which knows the gas temperature, finds the leak and says how fast and since when.
#![allow(clippy::print_stdout)]

use cylwatch::detector::monitor::{EventKind, LeakFinding, Monitor, MonitorSettings, Verdict};
use cylwatch::estimator::observer::Commissioning;
use cylwatch::estimator::sensor::{Sensor, SensorSuite, sample};
use cylwatch::report::figure::{Figure, Item, Mark, Panel, Picture, style};
use cylwatch::report::{Provenance, aligned};
use cylwatch::thermal::simulate::{SimulationSettings, simulate};
use cylwatch::thermal::units::ZERO_CELSIUS_K;
use cylwatch::thermal::{scenario, vessel};
use std::path::PathBuf;

/// Two mild days to learn from, then the warming and the leak.
const SCENARIO: &str = r#"
name = "a leak masked by warming"
duration_h = 63
sample_time_min = 1

[initial]
fill_pressure_bar = 200
temperature_degc = 8

[ambient]
air_degc = 8
film_w_m2_k = 15

[[ambient.air_change]]
at_h = 5
over_h = 8
to_degc = 14

[[ambient.air_change]]
at_h = 16
over_h = 10
to_degc = 1

[[ambient.air_change]]
at_h = 29
over_h = 8
to_degc = 13

[[ambient.air_change]]
at_h = 38
over_h = 7
to_degc = 2

[[ambient.air_change]]
at_h = 48
over_h = 15
to_degc = 27

[[leak]]
flow_g_h = 31.6
start_h = 48.3
"#;

/// The warming begins, and a little later, when the gas follows it, the leak, s.
const WARMING_S: f64 = 48.0 * 3600.0;
const LEAK_S: f64 = 48.3 * 3600.0;
/// True leak, g/h.
pub(crate) const LEAK_G_H: f64 = 31.6;
const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];
const SEED: u64 = 3;
const GRAM_PER_HOUR: f64 = 3.6e6;

/// What happened and what was said.
pub(crate) struct Masked {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Air and gas, °C.
    pub temperatures_degc: [Vec<f64>; 2],
    /// Pressure as read, and the settled one that the monitor makes of it, bar.
    pub pressures_bar: [Vec<f64>; 2],
    /// Gas that is gone, g.
    pub lost_g: Vec<f64>,
    /// When the leak was found, s.
    pub found_s: Option<f64>,
    /// What the monitor says of it at the end.
    pub finding: Option<LeakFinding>,
    /// Whether it ever spoke of a leak before there was one.
    pub false_alarm: bool,
}

/// Simulates, and lets the monitor watch.
pub(crate) fn run() -> anyhow::Result<Masked> {
    let vessel = vessel::presets::load("nitrogen-20l")?;
    let scenario = scenario::read_scenario(SCENARIO, "masked leak", &scenario::presets::table)?;
    let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
    let sensors = SENSORS.map(Sensor::typical).into_iter().collect::<Result<Vec<_>, _>>()?;
    let log = sample(&run, &SensorSuite::try_new(sensors.clone())?.draw(SEED), SEED)?;
    let filled = Commissioning::filled(200e5, ZERO_CELSIUS_K + 15.0);
    let mut monitor = Monitor::new(&vessel, &sensors, &filled, &MonitorSettings::default())?;
    let celsius = |k: &[f64]| k.iter().map(|k| k - ZERO_CELSIUS_K).collect::<Vec<f64>>();
    let mut masked = Masked {
        temperatures_degc: [celsius(&run.ambient_k), celsius(&run.gas_mean_k)],
        lost_g: run.mass_kg.iter().map(|kg| 1e3 * (run.mass_kg[0] - kg)).collect(),
        time_s: Vec::new(),
        pressures_bar: Default::default(),
        found_s: None,
        finding: None,
        false_alarm: false,
    };
    for (time_s, row) in log.rows() {
        for output in monitor.step(time_s, row)? {
            masked.time_s.push(time_s);
            masked.pressures_bar[0].push(row[2] / 1e5);
            masked.pressures_bar[1].push(output.estimate.p15_pa / 1e5);
            masked.false_alarm |= output.decision.verdict == Verdict::Leak && time_s < LEAK_S;
            let found = output.events.iter().any(|event| matches!(event.kind, EventKind::LeakFound(_)));
            masked.found_s = masked.found_s.or(found.then_some(time_s));
            masked.finding = output.leak;
        }
    }
    Ok(masked)
}

impl Masked {
    /// By how much the pressure as read rises or falls from the onset on, bar, and what is gone by then, g.
    pub(crate) fn spread_and_loss(&self) -> (f64, f64) {
        let onset = self.time_s.partition_point(|&t| t < LEAK_S);
        let read = &self.pressures_bar[0][onset..];
        let ends = read.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(*p), high.max(*p)));
        (ends.1 - ends.0, self.lost_g[self.lost_g.len() - 1])
    }
}

/// Temperatures, pressures, lost gas.
pub(crate) fn figure(masked: &Masked) -> Figure {
    let t = &masked.time_s;
    let curve = |name: &str, values: &[f64], stroke| Item::line(name, t, values.iter().copied(), stroke);
    let panels = vec![
        Panel::new(
            "temperature in °C",
            0.8,
            vec![
                curve("air", &masked.temperatures_degc[0], style::AIR),
                curve("gas", &masked.temperatures_degc[1], style::GAS_MEAN),
            ],
        ),
        Panel::new(
            "pressure in bar",
            1.0,
            vec![
                curve("as read", &masked.pressures_bar[0], style::PRESSURE),
                curve("monitor, at 15 °C", &masked.pressures_bar[1], style::FIRST),
            ],
        ),
        Panel::new("lost in g", 0.6, vec![curve("lost", &masked.lost_g, style::GAS_MEAN)]),
    ];
    let mut marks = vec![Mark { at: LEAK_S, name: "leak begins".into() }];
    marks.extend(masked.found_s.map(|at| Mark { at, name: "monitor: leak".into() }));
    let title = "A leak that the warming day hides from the gauge";
    Figure::over_time(title, panels).with_marks(marks)
}

fn main() -> anyhow::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "out".into()));
    std::fs::create_dir_all(&folder)?;
    let masked = run()?;
    let command = "cargo run --release --example leak_masked_by_warming".to_owned();
    let provenance = Provenance { command, inputs: Vec::new(), seed: Some(SEED) };
    let picture = Picture::from(figure(&masked));
    std::fs::write(folder.join("leak-masked-by-warming.svg"), picture.to_svg(&provenance)?)?;
    std::fs::write(folder.join("leak-masked-by-warming.png"), picture.to_png(&provenance)?)?;
    let (spread_bar, lost_g) = masked.spread_and_loss();
    let hours = |s: f64| format!("{:.1} h after the onset", (s - LEAK_S) / 3600.0);
    let mut rows = vec![
        vec!["pressure as read stays within".to_owned(), format!("{spread_bar:.1} bar")],
        vec!["lost meanwhile".to_owned(), format!("{lost_g:.0} g")],
        vec!["found".to_owned(), masked.found_s.map_or("never".into(), hours)],
    ];
    if let Some(finding) = masked.finding {
        let rate = finding.rate_kg_s.scaled(GRAM_PER_HOUR);
        let words =
            format!("{:.1} ({:.1} to {:.1}) g/h, truth {LEAK_G_H} g/h", rate.value, rate.low, rate.high);
        rows.push(vec!["its rate".into(), words]);
        let onset_h = finding.onset_s.scaled(1.0 / 3600.0);
        let words = format!(
            "{:.1} ({:.1} to {:.1}) h, truth {:.1} h",
            onset_h.value,
            onset_h.low,
            onset_h.high,
            LEAK_S / 3600.0
        );
        rows.push(vec!["its onset".into(), words]);
    }
    print!("{}", aligned(&[], &rows));
    println!(
        "\nThe warming began at {:.0} h. Figure: leak-masked-by-warming.svg in {}",
        WARMING_S / 3600.0,
        folder.display()
    );
    Ok(())
}
