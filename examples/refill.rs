//! Does a refilled cylinder that cools look like a leak?
//!
//! `cargo run --release --example refill -- <folder>` (default `out`)
//!
//! A cylinder of 160 bar is filled up within minutes. The compressed gas is hot: the gauge shows well above 200 bar and falls by more than
//! 20 bar while the gas cools. The paper's expectation, zeroed before, has no place for new gas; the
//! monitor recognises the refill, says how much came in, waits until it has settled, and speaks of no leak.
#![allow(clippy::print_stdout)]

use cylwatch::detector::monitor::intake::IntakeSettings;
use cylwatch::detector::monitor::{EventKind, Monitor, MonitorSettings, Verdict};
use cylwatch::estimator::observer::Commissioning;
use cylwatch::estimator::sensor::{Sensor, SensorSuite, sample};
use cylwatch::report::figure::{Figure, Item, Mark, Panel, Picture, style};
use cylwatch::report::{Provenance, aligned};
use cylwatch::thermal::simulate::{SimulationSettings, simulate};
use cylwatch::thermal::units::ZERO_CELSIUS_K;
use cylwatch::thermal::{scenario, vessel};
use std::path::PathBuf;

const SCENARIO: &str = r#"
name = "a refill"
duration_h = 60
sample_time_s = 20

[initial]
fill_pressure_bar = 160
temperature_degc = 15

[ambient]
air_degc = 15
film_w_m2_k = 15

[[ambient.air_change]]
at_h = 8
over_h = 6
to_degc = 19

[[ambient.air_change]]
at_h = 20
over_h = 8
to_degc = 12

[[ambient.air_change]]
at_h = 30
over_h = 6
to_degc = 15

[[refill]]
flow_kg_s = 0.06
source_temperature_degc = 15
source_pressure_bar = 300
start_h = 40
closes_above_bar = 226
"#;

/// Start of the refill, s.
pub(crate) const REFILL_S: f64 = 40.0 * 3600.0;
const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];
const SEED: u64 = 5;

/// What happened and what was said.
pub(crate) struct Refill {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Shoulder as read, and gas, °C.
    pub temperatures_degc: [Vec<f64>; 2],
    /// Pressure as read, and the settled one that the monitor makes of it, bar.
    pub pressures_bar: [Vec<f64>; 2],
    /// Gas that really came in, kg.
    pub filled_kg: f64,
    /// What the monitor says came in, kg, and when it said so, s.
    pub recognised: Option<(f64, f64)>,
    /// Verdicts from the refill on, each with the time of its beginning, s.
    pub verdicts: Vec<(f64, Verdict)>,
}

/// Simulates, and lets the monitor watch.
pub(crate) fn run() -> anyhow::Result<Refill> {
    let vessel = vessel::presets::load("nitrogen-20l")?;
    let scenario = scenario::read_scenario(SCENARIO, "refill", &scenario::presets::table)?;
    let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
    let sensors = SENSORS.map(Sensor::typical).into_iter().collect::<Result<Vec<_>, _>>()?;
    let log = sample(&run, &SensorSuite::try_new(sensors.clone())?.draw(SEED), SEED)?;
    let filled = Commissioning::filled(160e5, ZERO_CELSIUS_K + 15.0);
    let each = IntakeSettings { step_s: 0.0, ..IntakeSettings::default() };
    let mut monitor = Monitor::new(
        &vessel,
        &sensors,
        &filled,
        &MonitorSettings { intake: each, ..MonitorSettings::default() },
    )?;
    let mut refill = Refill {
        time_s: Vec::new(),
        temperatures_degc: [Vec::new(), run.gas_mean_k.iter().map(|k| k - ZERO_CELSIUS_K).collect()],
        pressures_bar: Default::default(),
        filled_kg: run.mass_kg[run.mass_kg.len() - 1] - run.mass_kg[0],
        recognised: None,
        verdicts: Vec::new(),
    };
    let mut last = Verdict::Tight;
    for (time_s, row) in log.rows() {
        for output in monitor.step(time_s, row)? {
            refill.time_s.push(time_s);
            refill.temperatures_degc[0].push(row[0] - ZERO_CELSIUS_K);
            refill.pressures_bar[0].push(row[2] / 1e5);
            refill.pressures_bar[1].push(output.estimate.p15_pa / 1e5);
            let gained = output.events.iter().find_map(|event| match event.kind {
                EventKind::Refill(gained_kg) => Some((gained_kg, time_s)),
                _ => None,
            });
            refill.recognised = refill.recognised.or(gained);
            if time_s >= REFILL_S && last != output.decision.verdict {
                refill.verdicts.push((time_s, output.decision.verdict));
            }
            last = output.decision.verdict;
        }
    }
    Ok(refill)
}

impl Refill {
    /// Highest pressure as read, and what it falls by until the end, bar.
    pub(crate) fn peak_and_fall(&self) -> (f64, f64) {
        let read = &self.pressures_bar[0];
        let peak = read.iter().copied().fold(f64::MIN, f64::max);
        (peak, peak - read[read.len() - 1])
    }
}

/// Temperatures and pressures from an hour before the refill on.
pub(crate) fn figure(refill: &Refill) -> Figure {
    let from = refill.time_s.partition_point(|&t| t < REFILL_S - 3600.0);
    let until = refill.time_s.partition_point(|&t| t < REFILL_S + 5.0 * 3600.0);
    let t: Vec<f64> = refill.time_s[from..until].iter().map(|t| t - refill.time_s[from]).collect();
    let curve = |name: &str, values: &[f64], stroke| {
        Item::line(name, &t, values[from..until].iter().copied(), stroke)
    };
    let panels = vec![
        Panel::new(
            "temperature in °C",
            0.8,
            vec![
                curve("shoulder as read", &refill.temperatures_degc[0], style::SHOULDER),
                curve("gas", &refill.temperatures_degc[1], style::GAS_MEAN),
            ],
        ),
        Panel::new(
            "pressure in bar",
            1.2,
            vec![
                curve("as read", &refill.pressures_bar[0], style::PRESSURE),
                curve("monitor, at 15 °C", &refill.pressures_bar[1], style::FIRST),
            ],
        ),
    ];
    let shifted = |&(at, verdict): &(f64, Verdict)| Mark {
        at: at - refill.time_s[from],
        name: verdict.as_str().into(),
    };
    let marks =
        refill.verdicts.iter().filter(|(at, _)| *at < refill.time_s[until - 1]).map(shifted).collect();
    let title = "A refill: hot at first, and no leak when it cools";
    Figure::over_time(title, panels).with_marks(marks)
}

fn main() -> anyhow::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "out".into()));
    std::fs::create_dir_all(&folder)?;
    let refill = run()?;
    let command = "cargo run --release --example refill".to_owned();
    let provenance = Provenance { command, inputs: Vec::new(), seed: Some(SEED) };
    let picture = Picture::from(figure(&refill));
    std::fs::write(folder.join("refill.svg"), picture.to_svg(&provenance)?)?;
    std::fs::write(folder.join("refill.png"), picture.to_png(&provenance)?)?;
    let (peak_bar, fall_bar) = refill.peak_and_fall();
    let minutes = |s: f64| format!("{:.0} min", (s - REFILL_S) / 60.0);
    let mut rows = vec![
        vec!["gauge, highest".to_owned(), format!("{peak_bar:.1} bar")],
        vec!["falls while it cools by".to_owned(), format!("{fall_bar:.1} bar")],
        vec!["filled in".to_owned(), format!("{:.3} kg", refill.filled_kg)],
    ];
    rows.extend(
        refill
            .recognised
            .map(|(kg, s)| vec!["monitor says".into(), format!("{kg:.3} kg after {}", minutes(s))]),
    );
    rows.extend(
        refill
            .verdicts
            .iter()
            .map(|(s, verdict)| vec![format!("after {}", minutes(*s)), verdict.to_string()]),
    );
    print!("{}", aligned(&[], &rows));
    println!("\nFigure: refill.svg in {}", folder.display());
    Ok(())
}
