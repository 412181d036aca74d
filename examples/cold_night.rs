//! What do a pressure switch and the monitor say on a cold night about a tight cylinder that is not quite full?
//!
//! `cargo run --release --example cold_night -- <folder>` (default `out`)
//!
//! 180 bar at 15 °C are 160 bar at -8 °C. In the night the air falls to -12 °C: the switch at 160 bar alarms although nothing is
//! lost. The monitor says that the cylinder is tight, and has warned long before that the gauge will be below the limit on such a night.
#![allow(clippy::print_stdout)]

use cylwatch::detector::monitor::{EventKind, Limits, Monitor, MonitorSettings, Verdict};
use cylwatch::estimator::observer::Commissioning;
use cylwatch::estimator::sensor::{Sensor, SensorSuite, sample};
use cylwatch::report::figure::{Figure, Item, Mark, Panel, Picture, style};
use cylwatch::report::{Provenance, aligned};
use cylwatch::thermal::simulate::{SimulationSettings, simulate};
use cylwatch::thermal::units::ZERO_CELSIUS_K;
use cylwatch::thermal::{scenario, vessel};
use std::path::PathBuf;

const SCENARIO: &str = r#"
name = "a cold night"
duration_h = 60
sample_time_min = 1

[initial]
fill_pressure_bar = 180
temperature_degc = 6

[ambient]
air_degc = 6
film_w_m2_k = 15

[[ambient.air_change]]
at_h = 8
over_h = 6
to_degc = 10

[[ambient.air_change]]
at_h = 18
over_h = 12
to_degc = 1

[[ambient.air_change]]
at_h = 32
over_h = 6
to_degc = 8

[[ambient.air_change]]
at_h = 40
over_h = 14
to_degc = -12

[limits]
pressure_bar = [160]
"#;

/// Where the switch stands, and the coldest night that the monitor is told to expect.
pub(crate) const SWITCH_BAR: f64 = 160.0;
const COLDEST_DEGC: f64 = -12.0;
const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];
const SEED: u64 = 12;

/// What happened and what was said.
pub(crate) struct Night {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Air and gas, °C.
    pub temperatures_degc: [Vec<f64>; 2],
    /// Pressure as read; at 15 °C and on the coldest night by the monitor, bar.
    pub pressures_bar: [Vec<f64>; 3],
    /// When the switch alarms, s, and the gas temperature then, °C.
    pub switch: Option<(f64, f64)>,
    /// When the monitor warns of a cold night, s, and of what pressure, bar.
    pub warning: Option<(f64, f64)>,
    /// What the monitor says at the end.
    pub verdict: Verdict,
    /// Whether it ever spoke of a leak.
    pub leak: bool,
}

/// Simulates, and lets switch and monitor watch.
pub(crate) fn run() -> anyhow::Result<Night> {
    let vessel = vessel::presets::load("nitrogen-20l")?;
    let scenario = scenario::read_scenario(SCENARIO, "cold night", &scenario::presets::table)?;
    let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
    let sensors = SENSORS.map(Sensor::typical).into_iter().collect::<Result<Vec<_>, _>>()?;
    let log = sample(&run, &SensorSuite::try_new(sensors.clone())?.draw(SEED), SEED)?;
    let limits = Limits { coldest_k: ZERO_CELSIUS_K + COLDEST_DEGC, ..Limits::default() };
    let settings = MonitorSettings { limits, ..MonitorSettings::default() };
    let filled = Commissioning::filled(180e5, ZERO_CELSIUS_K + 15.0);
    let mut monitor = Monitor::new(&vessel, &sensors, &filled, &settings)?;
    let celsius = |k: &[f64]| k.iter().map(|k| k - ZERO_CELSIUS_K).collect::<Vec<f64>>();
    let mut night = Night {
        time_s: Vec::new(),
        temperatures_degc: [celsius(&run.ambient_k), celsius(&run.gas_mean_k)],
        pressures_bar: Default::default(),
        switch: None,
        warning: None,
        verdict: Verdict::Tight,
        leak: false,
    };
    for ((time_s, row), gas_degc) in log.rows().zip(celsius(&run.gas_mean_k)) {
        let read_bar = row[2] / 1e5;
        night.switch = night.switch.or((read_bar < SWITCH_BAR).then_some((time_s, gas_degc)));
        for output in monitor.step(time_s, row)? {
            night.time_s.push(time_s);
            let settled_bar = output.estimate.p15_pa / 1e5;
            let values = [read_bar, settled_bar, output.cold_pressure_pa / 1e5];
            night.pressures_bar.iter_mut().zip(values).for_each(|(curve, value)| curve.push(value));
            let warned = output.events.iter().find_map(|event| match event.kind {
                EventKind::ColdNight(pressure_pa) => Some((time_s, pressure_pa / 1e5)),
                _ => None,
            });
            night.warning = night.warning.or(warned);
            night.verdict = output.decision.verdict;
            night.leak |= output.decision.verdict == Verdict::Leak;
        }
    }
    Ok(night)
}

/// Temperatures and pressures.
pub(crate) fn figure(night: &Night) -> Figure {
    let t = &night.time_s;
    let curve = |name: &str, values: &[f64], stroke| Item::line(name, t, values.iter().copied(), stroke);
    let [read, settled, cold] = &night.pressures_bar;
    let panels = vec![
        Panel::new(
            "temperature in °C",
            0.8,
            vec![
                curve("air", &night.temperatures_degc[0], style::AIR),
                curve("gas", &night.temperatures_degc[1], style::GAS_MEAN),
            ],
        ),
        Panel::new(
            "pressure in bar",
            1.2,
            vec![
                curve("as read", read, style::PRESSURE),
                curve("monitor, at 15 °C", settled, style::FIRST),
                curve("monitor, on the\ncoldest night", cold, style::THIRD),
                Item::Limit { name: "switch".into(), value: SWITCH_BAR },
            ],
        ),
    ];
    let mut marks = Vec::new();
    marks.extend(night.warning.map(|(at, _)| Mark { at, name: "monitor: cold night".into() }));
    marks.extend(night.switch.map(|(at, _)| Mark { at, name: "switch alarms".into() }));
    let title = "A cold night and a tight cylinder";
    Figure::over_time(title, panels).with_marks(marks)
}

fn main() -> anyhow::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "out".into()));
    std::fs::create_dir_all(&folder)?;
    let night = run()?;
    let command = "cargo run --release --example cold_night".to_owned();
    let provenance = Provenance { command, inputs: Vec::new(), seed: Some(SEED) };
    let picture = Picture::from(figure(&night));
    std::fs::write(folder.join("cold-night.svg"), picture.to_svg(&provenance)?)?;
    std::fs::write(folder.join("cold-night.png"), picture.to_png(&provenance)?)?;
    let hours = |s: f64| format!("{:.1} h", s / 3600.0);
    let rows = [
        [
            "switch at 160 bar alarms".to_owned(),
            night.switch.map_or("never".into(), |(s, degc)| format!("{}, gas {degc:.1} degC", hours(s))),
        ],
        [
            "monitor warns".to_owned(),
            night.warning.map_or("never".into(), |(s, bar)| {
                format!("{}: {bar:.1} bar at {COLDEST_DEGC} degC", hours(s))
            }),
        ],
        ["monitor at the end".to_owned(), night.verdict.to_string()],
    ];
    print!("{}", aligned(&[], &rows.map(Vec::from)));
    println!("\nFigure: cold-night.svg in {}", folder.display());
    Ok(())
}
