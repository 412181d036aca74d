//! How well a position does by the paper's own measure: the fit of a first-order lag from its reading to the mean gas temperature.
//!
//! The paper identifies `G(s) = b/(s + a)` on scenarios 1 and 2 of its climatic chamber, each position by itself, and takes the fit
//! `100 (1 - norm(e)/norm(T_gas - mean))` and the mean of the errors' squares for its quality (shoulder 97.1 %, valve 98.48 %); scenarios 3 and 4
//! validate. Here the four are simulated once, and read by many drawn sets of the sensors: each set is one pair of a model and its errors.
//!
//! Assumed as in the reproduction of Table 1: samples a minute apart, scenario 2 from the next minute on, temperatures in °C, no
//! offset in the model, gain free, state at the start fitted, in validation too. The gas temperature is the simulated mean, without error.
//!
//! Over the minute between scenarios 1 and 2 a reading that feels the air is taken as straight, though it jumps. That costs the places that follow
//! the gas closely more than the valve, and can turn the order on the joined record; the scenarios by themselves do not have it.
//!
//! An interval holds what the sensors themselves bring: their offset, mounting, noise, steps and losses, as their priors have them. It does
//! not hold what the vessel's model does not know, such as films and contacts, nor another chamber or another filling.
//!
//! Source: Bücking, Pfaff, Dirksmeier (section 4, Table 1).
mod first_order;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use self::first_order::{FirstOrder, Record};
use crate::EstimatorError;
use crate::identify::fit_percent;
use crate::sensor::{Sensor, SensorSuite, Site, SuiteTruth, sample};
use crate::thermal::scenario::presets;
use crate::thermal::simulate::{SimulationSettings, simulate};
use crate::thermal::trajectory::Trajectory;
use crate::thermal::units::ZERO_CELSIUS_K;
use crate::thermal::vessel::Vessel;

/// The paper's scenarios 1 to 4.
const SCENARIOS: [&str; 4] = ["shock-cold", "tunnel-winter", "ramp-warm", "cool-down"];
/// Time from the end of scenario 1 to the start of scenario 2 in the record that is identified from, s.
const GAP_S: f64 = 60.0;
/// Ends of a 95 % interval.
const LOW: f64 = 0.025;
const HIGH: f64 = 0.975;

/// What a model is judged on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PublishedRecord {
    /// Scenarios 1 and 2 as one record, which the model is identified from (Table 1).
    Identification,
    /// Scenarios 3 and 4 together, each with a start of its own.
    Validation,
    /// Scenario 1: from 21 into -25 °C.
    ShockCold,
    /// Scenario 2: from -25 into 40 °C.
    TunnelWinter,
    /// Scenario 3: from 10 to 60 °C in 5 h.
    RampWarm,
    /// Scenario 4: from 60 to 28 °C in 14 h.
    CoolDown,
}

impl PublishedRecord {
    /// All of them, in the order of [`PublishedScore::merits`].
    pub const ALL: [Self; 6] = [
        Self::Identification,
        Self::Validation,
        Self::ShockCold,
        Self::TunnelWinter,
        Self::RampWarm,
        Self::CoolDown,
    ];

    /// Description for reports.
    pub fn description(self) -> &'static str {
        match self {
            Self::Identification => "scenarios 1 + 2",
            Self::Validation => "scenarios 3 + 4",
            Self::ShockCold => "scenario 1",
            Self::TunnelWinter => "scenario 2",
            Self::RampWarm => "scenario 3",
            Self::CoolDown => "scenario 4",
        }
    }
}

/// Which specimens of the sensors are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Specimens {
    /// Drawn from their priors, with noise, one set for each seed.
    #[default]
    Drawn,
    /// One set at the means of the priors, without noise: the physics alone.
    Ideal,
}

/// Settings of [`published_scores`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PublishedSettings {
    /// Which specimens are read.
    pub specimens: Specimens,
    /// Number of sets that are drawn; [`Specimens::Ideal`] is one.
    pub seeds: usize,
    /// Seed of the first set; each further one has the next.
    pub first_seed: u64,
}

impl Default for PublishedSettings {
    fn default() -> Self {
        Self { specimens: Specimens::default(), seeds: 200, first_seed: 1 }
    }
}

/// A number over the sets of sensors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// 2.5 % of the sets are below.
    pub low: f64,
    /// 2.5 % of the sets are above.
    pub high: f64,
}

impl Spread {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.collect();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1);
        let quantile = |probability: f64| {
            let position = probability * last as f64;
            let below = position as usize;
            let (low, high) = (sorted[below], sorted[(below + 1).min(last)]);
            low + (position - below as f64) * (high - low)
        };
        Self {
            mean: sorted.iter().sum::<f64>() / sorted.len() as f64,
            low: quantile(LOW),
            high: quantile(HIGH),
        }
    }
}

/// How a position does on a record.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PublishedMerit {
    /// The record.
    pub record: PublishedRecord,
    /// Fit, %: 100 without errors.
    pub fit_percent: Spread,
    /// Mean of the squared errors, K².
    pub mse_k2: Spread,
}

/// How a position does by the paper's own measure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PublishedScore {
    /// Name of the sensor.
    pub name: String,
    /// On each of [`PublishedRecord::ALL`].
    pub merits: Vec<PublishedMerit>,
    /// Time constant, s; 0 for a reading that does not lead the gas.
    pub time_constant_s: Spread,
    /// Steady-state gain.
    pub gain: Spread,
}

impl PublishedScore {
    /// How it does on a record.
    pub fn on(&self, record: PublishedRecord) -> &PublishedMerit {
        &self.merits[record as usize]
    }
}

/// One position against another, set by set.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PublishedDuel {
    /// Share of the sets in which it has the smaller errors, 0 to 1; equal ones count half.
    pub share: f64,
    /// By how much its fit is above the other's, %.
    pub ahead_percent: Spread,
}

/// Scores of all thermometers.
#[derive(Clone, Debug)]
pub struct PublishedScores {
    /// One for each thermometer, in the order of the sensors.
    pub scores: Vec<PublishedScore>,
    /// Set by set, one for each thermometer.
    trials: Vec<Vec<Trial>>,
}

impl PublishedScores {
    /// The score of a name.
    pub fn find(&self, name: &str) -> Option<&PublishedScore> {
        self.scores.iter().find(|score| score.name == name)
    }

    /// How one position does against another on a record; `None` for a name that has no score.
    pub fn duel(&self, one: &str, other: &str, record: PublishedRecord) -> Option<PublishedDuel> {
        let position = |name: &str| self.scores.iter().position(|score| score.name == name);
        let (one, other) = (position(one)?, position(other)?);
        let pairs = || self.trials.iter().map(|set| (set[one].on(record), set[other].on(record)));
        let won = |(one, other): (Merit, Merit)| match one.mse_k2.total_cmp(&other.mse_k2) {
            std::cmp::Ordering::Less => 1.0,
            std::cmp::Ordering::Equal => 0.5,
            std::cmp::Ordering::Greater => 0.0,
        };
        Some(PublishedDuel {
            share: pairs().map(won).sum::<f64>() / self.trials.len() as f64,
            ahead_percent: Spread::of(pairs().map(|(one, other)| one.fit_percent - other.fit_percent)),
        })
    }

    /// Names by their mean squared error on a record, the smallest first.
    pub fn ranking(&self, record: PublishedRecord) -> Vec<&str> {
        let mut ranked: Vec<&PublishedScore> = self.scores.iter().collect();
        ranked.sort_by(|a, b| a.on(record).mse_k2.mean.total_cmp(&b.on(record).mse_k2.mean));
        ranked.iter().map(|score| score.name.as_str()).collect()
    }
}

/// Errors on a record.
#[derive(Clone, Copy, Debug)]
struct Merit {
    fit_percent: f64,
    mse_k2: f64,
}

impl Merit {
    fn of(gas_degc: &[f64], errors_k: &[f64]) -> Self {
        let mse_k2 = errors_k.iter().map(|error| error * error).sum::<f64>() / errors_k.len() as f64;
        Self { fit_percent: fit_percent(gas_degc, errors_k), mse_k2 }
    }
}

/// One specimen of a thermometer.
#[derive(Clone, Debug)]
struct Trial {
    lag: FirstOrder,
    merits: [Merit; 6],
}

impl Trial {
    /// Of what it read in the four scenarios.
    fn new(records: &[Record; 4]) -> Result<Self, EstimatorError> {
        let [first, second, third, fourth] = records;
        let joined = first.then(second, GAP_S);
        let lag = joined.first_order()?;
        let on = |record: &Record| Merit::of(record.gas_degc(), &record.errors_k(lag));
        let validated = Merit::of(
            &[third.gas_degc(), fourth.gas_degc()].concat(),
            &[third.errors_k(lag), fourth.errors_k(lag)].concat(),
        );
        Ok(Self { lag, merits: [on(&joined), validated, on(first), on(second), on(third), on(fourth)] })
    }

    fn on(&self, record: PublishedRecord) -> Merit {
        self.merits[record as usize]
    }
}

/// Scores of the thermometers on surfaces and in the gas among `sensors` by the paper's own measure; pressures and air are left out.
///
/// All numbers depend on the settings, the sensors and the vessel alone.
///
/// # Errors
/// [`EstimatorError::PlacementSetting`] without a seed, two sensors have one name, a sensor is on a place that the vessel does not have or
/// loses nearly all of its readings, or a scenario cannot be simulated on the vessel.
pub fn published_scores(
    vessel: &Vessel,
    sensors: &[Sensor],
    settings: &PublishedSettings,
) -> Result<PublishedScores, EstimatorError> {
    if settings.seeds == 0 {
        return Err(EstimatorError::PlacementSetting { setting: "seeds", value: 0.0, bound: "at least 1" });
    }
    let is_thermometer = |sensor: &&Sensor| sensor.is_on_surface() || matches!(sensor.site(), Site::Gas(_));
    let suite = SensorSuite::try_new(sensors.iter().filter(is_thermometer).cloned().collect())?;
    let run = |name: &&str| {
        let scenario = presets::load(name)?;
        simulate(vessel, &scenario, &SimulationSettings::default(), &mut |_| ())
    };
    let runs: Vec<Trajectory> = SCENARIOS.par_iter().map(run).collect::<Result<_, _>>()?;
    let trials: Vec<Vec<Trial>> = match settings.specimens {
        Specimens::Ideal => vec![trials(&runs, &suite.ideal().nominal(), settings.first_seed)?],
        Specimens::Drawn => (0..settings.seeds as u64)
            .into_par_iter()
            .map(|number| {
                let seed = settings.first_seed.wrapping_add(number);
                trials(&runs, &suite.draw(seed), seed)
            })
            .collect::<Result<_, _>>()?,
    };
    let names = suite.sensors().iter().map(|sensor| sensor.name.clone());
    let scores = names.enumerate().map(|(index, name)| score(name, &trials, index)).collect();
    Ok(PublishedScores { scores, trials })
}

/// What a set of specimens reads in all scenarios, one trial for each.
fn trials(runs: &[Trajectory], truth: &SuiteTruth, seed: u64) -> Result<Vec<Trial>, EstimatorError> {
    // The same specimens throughout, but noise of its own for each scenario.
    let noise = (0..).map(|number| seed.wrapping_mul(SCENARIOS.len() as u64).wrapping_add(number));
    let logs =
        runs.iter().zip(noise).map(|(run, seed)| sample(run, truth, seed)).collect::<Result<Vec<_>, _>>()?;
    let record = |scenario: usize, sensor: usize| {
        let readings_k = logs[scenario].rows().map(move |(_, row)| row[sensor]);
        Record::new(&logs[scenario].time_s, readings_k, &runs[scenario].gas_mean_k, ZERO_CELSIUS_K)
    };
    let trial = |sensor: usize| Trial::new(&std::array::from_fn(|scenario| record(scenario, sensor)));
    (0..truth.specimens.len()).map(trial).collect()
}

/// A thermometer over all sets.
fn score(name: String, trials: &[Vec<Trial>], index: usize) -> PublishedScore {
    let spread = |value: &dyn Fn(&Trial) -> f64| Spread::of(trials.iter().map(|set| value(&set[index])));
    let merit = |record: PublishedRecord| PublishedMerit {
        record,
        fit_percent: spread(&|trial| trial.on(record).fit_percent),
        mse_k2: spread(&|trial| trial.on(record).mse_k2),
    };
    PublishedScore {
        name,
        merits: PublishedRecord::ALL.map(merit).to_vec(),
        time_constant_s: spread(&|trial| trial.lag.time_constant_s),
        gain: spread(&|trial| trial.lag.gain),
    }
}
