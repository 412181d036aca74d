//! Table 1 of the paper rebuilt: the mean gas temperature from the shoulder's, and from the valve's.
//!
//! `cargo run --release -p cylwatch-estimator --example identify_transfer_function`
//!
//! The paper identifies `G(s) = b/(s + a)` with MATLAB's `tfest` from scenarios 1 and 2 (21 to -25 °C, then -25 to 40 °C).
//! Here both are simulated on the paper's cylinder, a sample a minute, 3 h and 3.45 h, joined to one record; thermometers
//! have the presets' mounting (15 % of the way to the air) and no noise. The model is then judged on scenarios 3 and 4.
//! Mounting and outside film are assumed, the measured curves are not published.
#![allow(clippy::print_stdout)]
use std::error::Error;

use cylwatch_estimator::identify::{
    Comparison, Data, Gain, Hold, Identified, IdentifyError, InitialState, Method, Model, Settings,
    Structure, identify, published,
};
use cylwatch_estimator::sensor::{SensorSuite, sample};
use cylwatch_estimator::thermal::simulate::{SimulationSettings, simulate};
use cylwatch_estimator::thermal::units::ZERO_CELSIUS_K;
use cylwatch_estimator::thermal::{scenario, vessel};

/// Largest lag of the residual analysis, samples.
const LAGS: usize = 25;
/// Share of the way to the air that the presets' thermometers read.
const COUPLING: f64 = 0.15;

/// A row of the paper's Table 1.
pub struct Published {
    /// Where the thermometer sits.
    pub place: Place,
    /// Fit, %.
    pub fit_percent: f64,
    /// Mean squared error, K².
    pub mse_k2: f64,
    /// Final prediction error, K².
    pub fpe_k2: f64,
}

/// Table 1.
pub const TABLE_1: [Published; 2] = [
    Published { place: Place::Shoulder, fit_percent: 97.1, mse_k2: 0.6294, fpe_k2: 0.6359 },
    Published { place: Place::Valve, fit_percent: 98.48, mse_k2: 0.173, fpe_k2: 0.1748 },
];

impl Published {
    /// Standard deviation of the output, K: what makes the fit of the mean squared error.
    pub fn output_sd_k(&self) -> f64 {
        self.mse_k2.sqrt() / (1.0 - self.fit_percent / 100.0)
    }

    /// Number of samples that final prediction error and mean squared error give with so many parameters.
    pub fn samples(&self, parameters: f64) -> f64 {
        let ratio = self.fpe_k2 / self.mse_k2;
        parameters * (ratio + 1.0) / (ratio - 1.0)
    }
}

/// Where a thermometer sits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// On the shoulder.
    Shoulder,
    /// On the valve.
    Valve,
}

/// Readings and mean gas temperature in the chamber, °C.
#[derive(Clone, Debug)]
pub struct Course {
    time_s: Vec<f64>,
    shoulder: Vec<f64>,
    valve: Vec<f64>,
    gas: Vec<f64>,
}

impl Course {
    /// A built-in scenario on the paper's cylinder, with the shoulder's and the valve's share of the way to the air.
    pub fn simulated(name: &str, couplings: [f64; 2]) -> Result<Self, Box<dyn Error>> {
        let mut text = scenario::presets::text(name).ok_or("no such scenario")?.to_owned();
        let preset = format!("air_coupling = {COUPLING}");
        for coupling in couplings {
            text = text.replacen(&preset, &format!("air_coupling = {coupling:.3}"), 1);
        }
        let vessel = vessel::presets::load("nitrogen-20l-paper")?;
        let scenario = scenario::read_scenario(&text, name, &scenario::presets::table)?;
        let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
        let (suite, _) = SensorSuite::from(&run.scenario).split_by_fit(&run.vessel);
        let log = sample(&run, &suite.ideal().nominal(), 0)?;
        let degc = |name: &str| -> Result<Vec<f64>, Box<dyn Error>> {
            let at = log.channels.iter().position(|channel| channel.name == name).ok_or("no such sensor")?;
            Ok(log.rows().map(|(_, row)| row[at] - ZERO_CELSIUS_K).collect())
        };
        Ok(Self {
            shoulder: degc("shoulder")?,
            valve: degc("valve")?,
            gas: run.gas_mean_k.iter().map(|kelvin| kelvin - ZERO_CELSIUS_K).collect(),
            time_s: log.time_s,
        })
    }

    /// Scenarios 1 and 2, the second from the next minute on.
    pub fn of_table_1(couplings: [f64; 2]) -> Result<Self, Box<dyn Error>> {
        Self::joined(couplings, 60.0)
    }

    /// Scenarios 1 and 2, the second after a gap, s. Over it the input is taken as straight, though it jumps with the air.
    fn joined(couplings: [f64; 2], gap_s: f64) -> Result<Self, Box<dyn Error>> {
        let mut record = Self::simulated("shock-cold", couplings)?;
        let other = Self::simulated("tunnel-winter", couplings)?;
        let start_s = record.time_s.last().map_or(0.0, |end_s| end_s + gap_s);
        record.time_s.extend(other.time_s.iter().map(|time_s| start_s + time_s));
        record.shoulder.extend(&other.shoulder);
        record.valve.extend(&other.valve);
        record.gas.extend(&other.gas);
        Ok(record)
    }

    /// The same with readings that are off by a constant, K.
    pub fn with_offset(mut self, offset_k: f64) -> Self {
        self.shoulder.iter_mut().chain(&mut self.valve).for_each(|reading| *reading += offset_k);
        self
    }

    /// The same with readings that are drawn to a constant temperature, °C, by a share of the difference.
    pub fn drawn_to(mut self, degc: f64, share: f64) -> Self {
        let readings = self.shoulder.iter_mut().chain(&mut self.valve);
        readings.for_each(|reading| *reading += share * (degc - *reading));
        self
    }

    /// Input and output of a model.
    pub fn data(&self, place: Place, hold: Hold) -> Result<Data, IdentifyError> {
        let input = match place {
            Place::Shoulder => &self.shoulder,
            Place::Valve => &self.valve,
        };
        Data::try_new(self.time_s.clone(), input.clone(), self.gas.clone(), hold)
    }

    /// Standard deviation of the gas temperature, K.
    pub fn gas_sd_k(&self) -> f64 {
        let n = self.gas.len() as f64;
        let mean = self.gas.iter().sum::<f64>() / n;
        (self.gas.iter().map(|gas| (gas - mean).powi(2)).sum::<f64>() / n).sqrt()
    }
}

/// First-order model by output error, as the paper has it.
pub fn first_order(
    course: &Course,
    place: Place,
    hold: Hold,
    initial: InitialState,
    gain: Gain,
) -> Result<Identified, IdentifyError> {
    let structure = Structure::new(1, 0).with_initial(initial).with_gain(gain);
    identify(&course.data(place, hold)?, &structure, &Method::OutputError, &Settings::default())
}

/// The row of Table 1: straight between samples, start and gain estimated.
pub fn row(course: &Course, place: Place) -> Result<Identified, IdentifyError> {
    first_order(course, place, Hold::First, InitialState::Estimated, Gain::Free)
}

/// The largest gain that a thermometer with a constant offset gives, with that offset, K, and the model.
pub fn largest_gain_of_an_offset(course: &Course) -> Option<(f64, Identified)> {
    // Beyond some kelvins the model fits so badly that it is refused.
    let offsets_k = (-40..=40).map(|tenths| 0.1 * f64::from(tenths));
    let with =
        |offset_k: f64| Some((offset_k, row(&course.clone().with_offset(offset_k), Place::Shoulder).ok()?));
    offsets_k.filter_map(with).max_by(|a, b| a.1.model.gain().total_cmp(&b.1.model.gain()))
}

/// Share of the way to the 21 °C outside of the chamber that a thermometer must read to give the published gain, by
/// the secant method.
pub fn share_of_the_published_gain(course: &Course) -> Result<(f64, Identified), IdentifyError> {
    let wanted = published::model().gain();
    let at = |share: f64| row(&course.clone().drawn_to(21.0, share), Place::Shoulder);
    let (mut before, mut share) = ((0.0, at(0.0)?.model.gain() - wanted), 0.03);
    let mut found = at(share)?;
    for _ in 0..12 {
        let excess = found.model.gain() - wanted;
        if excess.abs() < 1e-9 {
            break;
        }
        let slope = (excess - before.1) / (share - before.0);
        before = (share, excess);
        share -= excess / slope;
        found = at(share)?;
    }
    Ok((share, found))
}

/// A model on a scenario that it was not identified from, with the start fitted, at the first gas temperature, and at zero.
pub fn validation(model: &Model, course: &Course) -> Result<[Comparison; 3], IdentifyError> {
    let data = course.data(Place::Shoulder, Hold::First)?;
    let from = |initial: InitialState| model.compare_from(&data, &initial, LAGS);
    Ok([
        from(InitialState::Estimated)?,
        from(InitialState::Given(vec![course.gas[0]]))?,
        from(InitialState::Zero)?,
    ])
}

fn table_1(course: &Course) -> Result<(), Box<dyn Error>> {
    println!("Table 1: scenarios 1 and 2, mean gas temperature from one thermometer");
    println!("                       pole/(1/s)    gain   fit/%  FPE/K2  MSE/K2  samples  sd(y)/K");
    for paper in &TABLE_1 {
        let model = match paper.place {
            Place::Shoulder => format!("{:10.6} {:7.4}", -published::POLE_PER_S, published::model().gain()),
            Place::Valve => format!("{:>10} {:>7}", "-", "-"),
        };
        println!(
            "{:9} published    {model}   {:5.2}  {:6.4}  {:6.4}  {:7.0}  {:7.1}",
            format!("{:?}", paper.place).to_lowercase(),
            paper.fit_percent,
            paper.fpe_k2,
            paper.mse_k2,
            paper.samples(2.0),
            paper.output_sd_k()
        );
        let found = row(course, paper.place)?;
        let (pole, s) = (found.derived.poles[0].real_per_s, &found.statistics);
        println!(
            "          simulated    {:10.6} {:7.4}   {:5.2}  {:6.4}  {:6.4}  {:7}  {:7.1}   pole in {:.6} to {:.6}",
            pole.value,
            found.model.gain(),
            s.fit_percent,
            s.fpe,
            s.mse,
            s.samples,
            course.gas_sd_k(),
            pole.low,
            pole.high
        );
    }
    println!(
        "The published FPE/MSE give these samples with 2 parameters; with 3, a start counted, half as many again.\n"
    );
    Ok(())
}

fn choices(course: &Course) -> Result<(), Box<dyn Error>> {
    println!("Shoulder: what the choices do to the pole (published 0.003021 1/s)");
    let line = |name: &str, course: &Course, hold, initial, gain| {
        let found = first_order(course, Place::Shoulder, hold, initial, gain)?;
        let (pole, s) = (found.model.den[1], &found.statistics);
        println!(
            "{name:48} {pole:.6} ({:+5.1} %)  gain {:.4}  fit {:5.2} %  MSE {:.4} K2",
            100.0 * (pole / published::POLE_PER_S - 1.0),
            found.model.gain(),
            s.fit_percent,
            s.mse
        );
        Ok::<(), IdentifyError>(())
    };
    let (first, zero) = (Hold::First, Hold::Zero);
    line("input straight, start estimated", course, first, InitialState::Estimated, Gain::Free)?;
    line("input straight, start zero", course, first, InitialState::Zero, Gain::Free)?;
    line("input straight, settled at the start", course, first, InitialState::Settled, Gain::Free)?;
    line("input held, start estimated", course, zero, InitialState::Estimated, Gain::Free)?;
    let gain = Gain::Fixed(published::model().gain());
    line("gain held at the published one", course, first, InitialState::Estimated, gain)?;
    for (name, scenario) in [("scenario 1 alone", "shock-cold"), ("scenario 2 alone", "tunnel-winter")] {
        let alone = Course::simulated(scenario, [COUPLING; 2])?;
        line(name, &alone, first, InitialState::Estimated, Gain::Free)?;
    }
    let jumping = Course::joined([COUPLING; 2], 0.01)?;
    line("joined without a minute between them", &jumping, first, InitialState::Estimated, Gain::Free)?;
    for coupling in [0.1, 0.2] {
        let mounted = Course::of_table_1([coupling; 2])?;
        let name = format!("reading {:.0} % of the way to the air", 100.0 * coupling);
        line(&name, &mounted, first, InitialState::Estimated, Gain::Free)?;
    }
    println!();
    causes_of_the_gain(course)
}

/// What could make the published gain, which cannot be physical: at rest every temperature is equal.
fn causes_of_the_gain(course: &Course) -> Result<(), Box<dyn Error>> {
    println!("Shoulder: what could make the published gain of {:.4}", published::model().gain());
    let line = |name: &str, found: &Identified| {
        let (pole, s) = (found.model.den[1], &found.statistics);
        let gain = found.model.gain();
        println!("{name:48} {pole:.6}  gain {gain:.4}  fit {:5.2} %  MSE {:.4} K2", s.fit_percent, s.mse);
    };
    if let Some((offset_k, found)) = largest_gain_of_an_offset(course) {
        line(&format!("largest of any offset: {offset_k:+.1} K"), &found);
    }
    let (share, found) = share_of_the_published_gain(course)?;
    line(&format!("reading {:.1} % of the way to 21 degC", 100.0 * share), &found);
    println!();
    Ok(())
}

fn mountings() -> Result<(), Box<dyn Error>> {
    println!("Fit in % by the share of the way to the air that the thermometer reads");
    let shares = [0.0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4];
    let mut lines = [String::from("shoulder"), String::from("valve   ")];
    for share in shares {
        let course = Course::of_table_1([share; 2])?;
        for (line, place) in lines.iter_mut().zip([Place::Shoulder, Place::Valve]) {
            line.push_str(&format!("  {:6.2}", row(&course, place)?.statistics.fit_percent));
        }
    }
    println!("share     {}", shares.map(|share| format!("{share:6.2}")).join("  "));
    println!("{}\n{}\n", lines[0], lines[1]);
    Ok(())
}

fn figure_3(identified: &Model) -> Result<(), Box<dyn Error>> {
    println!(
        "Figure 3: rms error in K (fit in %) on scenarios that the model was not identified from, by its start"
    );
    println!("{:38} {:>16} {:>16} {:>16}", "", "fitted", "first gas", "zero");
    for (name, scenario) in [("scenario 3", "ramp-warm"), ("scenario 4", "cool-down")] {
        let course = Course::simulated(scenario, [COUPLING; 2])?;
        for (which, model) in [("identified", identified), ("published", &published::model())] {
            let cells = validation(model, &course)?.map(|c| {
                let s = c.statistics;
                format!("{:7.3} ({:6.2})", s.mse.sqrt(), s.fit_percent)
            });
            println!("{:38} {:>16} {:>16} {:>16}", format!("{name}, {which}"), cells[0], cells[1], cells[2]);
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let course = Course::of_table_1([COUPLING; 2])?;
    table_1(&course)?;
    choices(&course)?;
    mountings()?;
    figure_3(&row(&course, Place::Shoulder)?.model)
}
