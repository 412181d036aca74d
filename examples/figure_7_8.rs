//! Figures 7 and 8 of the paper: a leak after a tunnel. When is it found, how fast is gas lost, how long does it last?
//!
//! `cargo run --release --example figure_7_8 -- <folder>` (default `out`)
//!
//! Above, the paper's scheme: the expected pressure of its model, less noise of 10 mbar and a steady loss from t2 on, is the
//! actual one; a threshold of ten times the noise, exceeded for 10 min, finds the leak. Below, a simulated cylinder that
//! loses 60 g/h from t2 on. Without the leak, too, the errors are no longer noise: each detector by threshold gets the lowest one at
//! which it is silent in the same passage of a tight cylinder, and a tenth more. The monitor has its own for a false alarm in ten years.
#![allow(clippy::print_stdout)]

use anyhow::Context;
use cylwatch::detector::baseline::{
    Expectation, Filling, GasModel, GasTemperature, Law, Loss, PressureError, Reading, Threshold,
    ThresholdSettings,
};
use cylwatch::detector::calibrate::{ResidualSource, SimulatedNoise};
use cylwatch::detector::monitor::intake::IntakeSettings;
use cylwatch::detector::monitor::{LeakFinding, Monitor, MonitorSettings};
use cylwatch::detector::statistic::{Noise, Statistic};
use cylwatch::estimator::observer::Commissioning;
use cylwatch::estimator::sensor::SensorSuite;
use cylwatch::report::figure::{Figure, Horizontal, Item, Mark, Panel, style};
use cylwatch::report::{Provenance, Readings, aligned};
use cylwatch::thermal::simulate::{SimulationSettings, simulate};
use cylwatch::thermal::units::ZERO_CELSIUS_K;
use cylwatch::thermal::{scenario, vessel};
use std::path::PathBuf;

const BAR: f64 = 1e5;
const HOUR_S: f64 = 3600.0;
const FULL: Filling = Filling { pressure_pa: 200.0 * BAR, temperature_k: ZERO_CELSIUS_K + 15.0 };
/// Pressure at which the system is no longer operational, Pa.
const LIMIT_PA: f64 = 160.0 * BAR;
/// Entry into the tunnel (t1) and onset of the leak (t2), s.
const ENTRY_S: f64 = 600.0;
const ONSET_S: f64 = 3600.0;
/// Loss in the paper's scheme, bar/h; the paper does not state it.
pub const SCHEME_BAR_H: f64 = 3.0;
const SAMPLE_S: f64 = 10.0;
const SEEDS: [u64; 2] = [8, 7];
const COMMAND: &str = "cargo run --release --example figure_7_8";

/// What a detector said.
pub struct Said {
    /// Which detector, on what.
    pub detector: &'static str,
    /// Its threshold, bar; `None`: one of its own kind.
    pub threshold_bar: Option<f64>,
    /// From the onset to the alarm, min; `None`: no alarm.
    pub delay_min: Option<f64>,
    /// Loss rate at the end, bar/h.
    pub rate_bar_h: f64,
    /// Time to the limit from the end on, h.
    pub left_h: Option<f64>,
}

/// Curves of one run.
pub struct Course {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Shoulder and gas, °C.
    pub temperatures_degc: [Vec<f64>; 2],
    /// Expected (published) and actual pressure, bar.
    pub pressures_bar: [Vec<f64>; 2],
    /// Missing pressure, bar: published, and where there are more detectors refitted and monitor.
    pub missing_bar: Vec<Vec<f64>>,
}

/// The paper's scheme and what its detector says.
pub fn scheme() -> anyhow::Result<(Course, Said)> {
    let mut noise = SimulatedNoise::try_new(Noise::white(0.01 * BAR), SAMPLE_S, SEEDS[0])?;
    let mut gas = GasTemperature::try_new(GasModel::PUBLISHED)?;
    let mut detector = Threshold::published(FULL)?;
    let mut error = PressureError::published(FULL)?;
    let threshold_bar = 0.1;
    let (mut course, mut alarm_s) = (Course::empty(1), None);
    for n in 0..=1440 {
        let time_s = SAMPLE_S * f64::from(n);
        let shoulder_k = ZERO_CELSIUS_K + if time_s <= ENTRY_S { -10.0 } else { 35.0 };
        let gas_k = gas.step(time_s, shoulder_k).context("times increase")?;
        let lost_pa = SCHEME_BAR_H * BAR * (time_s - ONSET_S).max(0.0) / HOUR_S;
        let expected_pa = FULL.published_pressure_pa(gas_k);
        let pressure_pa = expected_pa + noise.next_residual().value - lost_pa;
        let reading = Reading { time_s, shoulder_k, pressure_pa };
        if detector.update(reading) >= threshold_bar * BAR {
            alarm_s = alarm_s.or(Some(time_s));
        }
        course.time_s.push(time_s);
        course.temperatures_degc[0].push(shoulder_k - ZERO_CELSIUS_K);
        course.temperatures_degc[1].push(gas_k - ZERO_CELSIUS_K);
        course.pressures_bar[0].push(expected_pa / BAR);
        course.pressures_bar[1].push(pressure_pa / BAR);
        course.missing_bar[0].push(error.step(reading).context("all readings are there")? / BAR);
    }
    let loss = detector.loss(LIMIT_PA).context("there are errors")?;
    Ok((course, Said::new("published, its own scheme", Some(threshold_bar), alarm_s, loss)))
}

impl Course {
    fn empty(detectors: usize) -> Self {
        Self {
            time_s: Vec::new(),
            temperatures_degc: Default::default(),
            pressures_bar: Default::default(),
            missing_bar: vec![Vec::new(); detectors],
        }
    }
}

impl Said {
    fn new(detector: &'static str, threshold_bar: Option<f64>, alarm_s: Option<f64>, loss: Loss) -> Self {
        Self {
            detector,
            threshold_bar,
            delay_min: alarm_s.map(|alarm_s| (alarm_s - ONSET_S) / 60.0),
            rate_bar_h: loss.rate_pa_s * HOUR_S / BAR,
            left_h: loss.time_to_limit_s.map(|left_s| left_s / HOUR_S),
        }
    }
}

/// Everything that runs on the simulated cylinder's readings.
struct Bench {
    shoulder: usize,
    pressure: usize,
    thresholds: [Threshold; 2],
    errors: [PressureError; 2],
    monitor: Monitor,
    settled_pa: Vec<f64>,
}

/// One run of all detectors.
struct Run {
    course: Course,
    /// Missing pressure that has lasted, bar, of the detectors without an observer, by sample.
    lasting_bar: [Vec<f64>; 2],
    losses: [Loss; 2],
    /// When the monitor finds a leak, s, what it says of it at the end, and the pressure then, Pa.
    found_s: Option<f64>,
    finding: Option<LeakFinding>,
    last_pa: f64,
}

impl Bench {
    fn new(names: &[&str], suite: &SensorSuite) -> anyhow::Result<Self> {
        let of = |name: &str| names.iter().position(|found| *found == name).context("a sensor is missing");
        let refitted = || -> anyhow::Result<PressureError> {
            let real_gas = Expectation::try_new(Law::RealGas { gas: "nitrogen".into() }, FULL)?;
            let gas = GasModel::FirstOrder { gain: 1.0, pole_per_s: 0.002_988, initial_degc: None };
            Ok(PressureError::try_new(real_gas, gas)?)
        };
        let vessel = vessel::presets::load("nitrogen-20l")?;
        let each = IntakeSettings { step_s: 0.0, ..IntakeSettings::default() };
        let settings = MonitorSettings { intake: each, ..MonitorSettings::default() };
        let filled = Commissioning::filled(FULL.pressure_pa, FULL.temperature_k);
        Ok(Self {
            shoulder: of("shoulder")?,
            pressure: of("pressure")?,
            thresholds: [
                Threshold::published(FULL)?,
                Threshold::try_new(refitted()?, ThresholdSettings::default())?,
            ],
            errors: [PressureError::published(FULL)?, refitted()?],
            monitor: Monitor::new(&vessel, suite.sensors(), &filled, &settings)?,
            settled_pa: Vec::new(),
        })
    }

    /// The next row into all detectors and curves.
    fn step(&mut self, time_s: f64, row: &[f64], run: &mut Run) -> anyhow::Result<()> {
        let (shoulder_k, pressure_pa) = (row[self.shoulder], row[self.pressure]);
        let reading = Reading { time_s, shoulder_k, pressure_pa };
        for k in 0..2 {
            run.lasting_bar[k].push(self.thresholds[k].update(reading) / BAR);
            let error_pa = self.errors[k].step(reading).context("all readings are there")?;
            run.course.missing_bar[k].push(error_pa / BAR);
        }
        let published_bar = run.course.missing_bar[0].last().context("just added")?;
        run.course.pressures_bar[0].push(published_bar + pressure_pa / BAR);
        run.course.pressures_bar[1].push(pressure_pa / BAR);
        for output in self.monitor.step(time_s, row)? {
            self.settled_pa.push(output.estimate.p15_pa);
            run.finding = output.leak;
            run.found_s = run.found_s.or(output.leak.map(|_| time_s));
        }
        // The settled pressure before the passage is what nothing is missing from.
        let before = run.course.time_s.partition_point(|&t| t < ENTRY_S - SAMPLE_S);
        let settled_pa = self.settled_pa.last().context("a row of an orderly log comes out at once")?;
        let missing_pa = self.settled_pa[before.min(self.settled_pa.len() - 1)] - settled_pa;
        run.course.missing_bar[2].push(missing_pa / BAR);
        run.course.time_s.push(time_s);
        run.course.temperatures_degc[0].push(shoulder_k - ZERO_CELSIUS_K);
        run.last_pa = pressure_pa;
        Ok(())
    }
}

/// The scenario with or without its leak through all detectors.
fn run(leaking: bool, seed: u64) -> anyhow::Result<Run> {
    let vessel = vessel::presets::load("nitrogen-20l")?;
    let mut scenario = scenario::presets::load("leak-after-tunnel")?;
    if !leaking {
        scenario.flows.clear();
    }
    let simulated = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
    let log = Readings::sampled(&simulated, seed)?.log;
    let names: Vec<&str> = log.channels.iter().map(|channel| channel.name.as_str()).collect();
    let mut bench = Bench::new(&names, &SensorSuite::from(&scenario))?;
    let none = Loss { error_pa: 0.0, rate_pa_s: 0.0, time_to_limit_s: None };
    let mut run = Run {
        course: Course::empty(3),
        lasting_bar: Default::default(),
        losses: [none; 2],
        found_s: None,
        finding: None,
        last_pa: f64::NAN,
    };
    for (time_s, row) in log.rows() {
        bench.step(time_s, row, &mut run)?;
    }
    for (loss, threshold) in run.losses.iter_mut().zip(&bench.thresholds) {
        *loss = threshold.loss(LIMIT_PA).context("there are errors")?;
    }
    run.course.temperatures_degc[1] = simulated.gas_mean_k.iter().map(|k| k - ZERO_CELSIUS_K).collect();
    Ok(run)
}

/// The simulated cylinder, and what each detector says: published, refitted, monitor.
pub fn cylinder() -> anyhow::Result<(Course, [Said; 3])> {
    let (tight, leaking) = (run(false, SEEDS[1])?, run(true, SEEDS[0])?);
    anyhow::ensure!(tight.found_s.is_none(), "the monitor found a leak in a tight cylinder");
    let said = |k: usize, name| {
        let threshold_bar = 1.1 * tight.lasting_bar[k].iter().copied().fold(0.0, f64::max);
        let times = leaking.course.time_s.iter().zip(&leaking.lasting_bar[k]);
        let mut alarms = times.filter(|(_, lasting)| **lasting >= threshold_bar);
        Said::new(name, Some(threshold_bar), alarms.next().map(|(t, _)| *t), leaking.losses[k])
    };
    let rate_pa_s = leaking.finding.map_or(0.0, |finding| finding.rate_pa_s.value);
    let time_to_limit_s = (rate_pa_s > 0.0).then(|| (leaking.last_pa - LIMIT_PA) / rate_pa_s);
    let loss = Loss { error_pa: 0.0, rate_pa_s, time_to_limit_s };
    let monitor = Said::new("monitor, cylinder", None, leaking.found_s, loss);
    let said = [said(0, "published, cylinder"), said(1, "refitted, cylinder"), monitor];
    Ok((leaking.course, said))
}

fn part(title: &str, course: &Course, said: &[&Said], below: Option<Box<Figure>>) -> Figure {
    let t = &course.time_s;
    let [shoulder, gas] = course.temperatures_degc.clone();
    let [expected, actual] = course.pressures_bar.clone();
    let strokes = [style::FIRST, style::THIRD, style::GAS_MEAN];
    let names = ["published", "refitted, real gas", "monitor"];
    let curves = course.missing_bar.iter().zip(names).zip(strokes);
    let mut missing: Vec<Item> =
        curves.map(|((values, name), stroke)| Item::line(name, t, values.iter().copied(), stroke)).collect();
    for ((said, values), stroke) in said.iter().zip(&course.missing_bar).zip(strokes) {
        let alarm_s = said.delay_min.map(|delay_min| ONSET_S + 60.0 * delay_min);
        if let Some(row) = t.iter().position(|t| Some(*t) == alarm_s) {
            let name = if stroke == style::GAS_MEAN { "alarms" } else { "" };
            let (x, y) = (vec![t[row]], vec![values[row]]);
            missing.push(Item::Points { name: name.into(), x, y, stroke });
        }
    }
    let panel = |quantity: &str, height, items| Panel { quantity: quantity.into(), items, height };
    let panels = vec![
        panel(
            "temperature in °C",
            0.6,
            vec![
                Item::line("shoulder as read", t, shoulder, style::SHOULDER),
                Item::line("gas", t, gas, style::GAS_MEAN),
            ],
        ),
        panel(
            "pressure in bar",
            0.8,
            vec![
                Item::line("actual", t, actual, style::PRESSURE),
                Item::line("expected,\npublished", t, expected, style::FIRST),
            ],
        ),
        panel("missing in bar", 0.8, missing),
    ];
    let mark = |at, name: &str| Mark { at, name: name.into() };
    let marks = vec![mark(ENTRY_S, "t1: tunnel"), mark(ONSET_S, "t2: leak")];
    Figure { title: title.into(), horizontal: Horizontal::Time, panels, marks, below }
}

/// Both parts.
pub fn figure(scheme: &(Course, Said), cylinder: &(Course, [Said; 3])) -> Figure {
    let said: Vec<&Said> = cylinder.1.iter().collect();
    let below = part("a simulated cylinder that loses 60 g/h", &cylinder.0, &said, None);
    let title = "figure 8: the paper's scheme (figure 7) with a loss of 3 bar/h";
    part(title, &scheme.0, &[&scheme.1], Some(Box::new(below)))
}

fn main() -> anyhow::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "out".into()));
    std::fs::create_dir_all(&folder)?;
    let (scheme, cylinder) = (scheme()?, cylinder()?);
    let provenance = Provenance { command: COMMAND.into(), inputs: Vec::new(), seed: Some(SEEDS[0]) };
    let figure = figure(&scheme, &cylinder);
    std::fs::write(folder.join("figure-8.svg"), figure.to_svg(&provenance)?)?;
    std::fs::write(folder.join("figure-8.png"), figure.to_png(&provenance)?)?;
    let rows = std::iter::once(&scheme.1).chain(&cylinder.1).map(|said| {
        let or_never = |value: Option<f64>| value.map_or("never".into(), |value| format!("{value:.0}"));
        vec![
            said.detector.to_owned(),
            said.threshold_bar.map_or_else(String::new, |bar| format!("{bar:.2}")),
            or_never(said.delay_min),
            format!("{:.2}", said.rate_bar_h),
            or_never(said.left_h),
        ]
    });
    let header = ["detector", "threshold / bar", "delay / min", "loss / bar/h", "to 160 bar / h"];
    print!("{}", aligned(&header, &rows.collect::<Vec<_>>()));
    println!(
        "\nThe thermal error sets the threshold, not the noise. Figure: figure-8.svg in {}",
        folder.display()
    );
    Ok(())
}
