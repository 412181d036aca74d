//! Table 1 and figures 2 and 3 of the paper: the mean gas temperature from one thermometer, identified and validated.
//!
//! The paper identifies `G(s) = b/(s + a)` with MATLAB's `tfest` from scenarios 1 and 2 (21 to -25 °C, then -25 to 40 °C) and runs it
//! on scenarios 3 and 4. Here all are simulated on the paper's cylinder, a sample a minute, 3 h and 3.45 h joined to one record;
//! thermometers have the presets' mounting (15 % of the way to the air) and no noise. Output error with the start
//! estimated is what `tfest` does.
//!
//! Mounting and outside film are assumed, the measured curves are not published.
use super::ReproduceError;
use crate::estimator::identify::{
    Comparison, Data, Gain, Hold, Identified, IdentifyError, InitialState, Method, Model, Settings,
    Structure, identify, published,
};
use crate::estimator::sensor::{SensorSuite, sample};
use crate::thermal::simulate::{SimulationSettings, simulate};
use crate::thermal::units::ZERO_CELSIUS_K;
use crate::thermal::{scenario, vessel};

/// Largest lag of the residual analysis, samples.
const LAGS: usize = 25;
/// Share of the way to the air that the presets' thermometers read.
pub const COUPLING: f64 = 0.15;

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
pub struct Record {
    time_s: Vec<f64>,
    shoulder: Vec<f64>,
    valve: Vec<f64>,
    gas: Vec<f64>,
}

impl Record {
    /// A built-in scenario on the paper's cylinder, with the shoulder's and the valve's share of the way to the air.
    pub fn simulated(name: &'static str, couplings: [f64; 2]) -> Result<Self, ReproduceError> {
        let mut text = scenario::presets::FILES.text(name)?.to_owned();
        let preset = format!("air_coupling = {COUPLING}");
        for coupling in couplings {
            text = text.replacen(&preset, &format!("air_coupling = {coupling:.3}"), 1);
        }
        let vessel = vessel::presets::load("nitrogen-20l-paper")?;
        let scenario = scenario::read_scenario(&text, name, &scenario::presets::table)?;
        let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| ())?;
        let (suite, _) = SensorSuite::from(&run.scenario).split_by_fit(&run.vessel);
        let log = sample(&run, &suite.ideal().nominal(), 0)?;
        let degc = |name: &'static str| -> Result<Vec<f64>, ReproduceError> {
            let at = log
                .channels
                .iter()
                .position(|channel| channel.name == name)
                .ok_or(ReproduceError::Sensor { name })?;
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
    pub fn of_table_1(couplings: [f64; 2]) -> Result<Self, ReproduceError> {
        Self::joined(couplings, 60.0)
    }

    /// Scenarios 1 and 2, the second after a gap, s. Over it the input is taken as straight, though it jumps with the air.
    pub fn joined(couplings: [f64; 2], gap_s: f64) -> Result<Self, ReproduceError> {
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
    pub(crate) fn with_offset(mut self, offset_k: f64) -> Self {
        self.shoulder.iter_mut().chain(&mut self.valve).for_each(|reading| *reading += offset_k);
        self
    }

    /// The same with readings that are drawn to a constant temperature, °C, by a share of the difference.
    pub(crate) fn drawn_to(mut self, degc: f64, share: f64) -> Self {
        let readings = self.shoulder.iter_mut().chain(&mut self.valve);
        readings.for_each(|reading| *reading += share * (degc - *reading));
        self
    }

    /// Times, s.
    pub(crate) fn time_s(&self) -> &[f64] {
        &self.time_s
    }

    /// The shoulder as read, °C.
    pub(crate) fn shoulder_degc(&self) -> &[f64] {
        &self.shoulder
    }

    /// Mean gas temperature, °C.
    pub(crate) fn gas_degc(&self) -> &[f64] {
        &self.gas
    }

    /// A model of the shoulder beside the gas, from a start.
    ///
    /// # Errors
    /// As [`Model::compare_from`].
    pub(crate) fn compared(
        &self,
        model: &Model,
        initial: &InitialState,
    ) -> Result<Comparison, IdentifyError> {
        model.compare_from(&self.data(Place::Shoulder, Hold::First)?, initial, LAGS)
    }

    /// Input and output of a model.
    ///
    /// # Errors
    /// There are too few samples.
    pub(crate) fn data(&self, place: Place, hold: Hold) -> Result<Data, IdentifyError> {
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
    record: &Record,
    place: Place,
    hold: Hold,
    initial: InitialState,
    gain: Gain,
) -> Result<Identified, IdentifyError> {
    let structure = Structure::new(1, 0).with_initial(initial).with_gain(gain);
    identify(&record.data(place, hold)?, &structure, &Method::OutputError, &Settings::default())
}

/// The row of Table 1: straight between samples, start and gain estimated.
pub fn row(record: &Record, place: Place) -> Result<Identified, IdentifyError> {
    first_order(record, place, Hold::First, InitialState::Estimated, Gain::Free)
}

/// The largest gain that a thermometer with a constant offset gives, with that offset, K, and the model.
pub fn largest_gain_of_an_offset(record: &Record) -> Option<(f64, Identified)> {
    // Beyond some kelvins the model fits so badly that it is refused.
    let offsets_k = (-40..=40).map(|tenths| 0.1 * f64::from(tenths));
    let with =
        |offset_k: f64| Some((offset_k, row(&record.clone().with_offset(offset_k), Place::Shoulder).ok()?));
    offsets_k.filter_map(with).max_by(|a, b| a.1.model.gain().total_cmp(&b.1.model.gain()))
}

/// Share of the way to the 21 °C outside of the chamber that a thermometer must read to give the published gain, by
/// the secant method.
pub fn share_of_the_published_gain(record: &Record) -> Result<(f64, Identified), IdentifyError> {
    let wanted = published::model().gain();
    let at = |share: f64| row(&record.clone().drawn_to(21.0, share), Place::Shoulder);
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
pub fn validation(model: &Model, record: &Record) -> Result<[Comparison; 3], IdentifyError> {
    let from = |initial: InitialState| record.compared(model, &initial);
    Ok([
        from(InitialState::Estimated)?,
        from(InitialState::Given(vec![record.gas[0]]))?,
        from(InitialState::Zero)?,
    ])
}
