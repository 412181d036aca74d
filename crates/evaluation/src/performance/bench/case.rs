//! One simulated cylinder and what all candidates make of it.
use crate::truth::{Course, Truth, TruthLeak, generate_with};
use cylwatch_thermal::units::DAY_S;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::candidate::{Candidate, Contender, Readings};
use super::{Plan, Trace};
use crate::EvaluationError;
use crate::noise::Residual;
use crate::performance::{Horizon, TrueLeak};

/// Interval of the settled pressures that are kept, s.
pub(super) const SETTLED_S: f64 = 1200.0;
/// Part of the gas after whose loss nobody needs to be told.
const NOTICED: f64 = 0.4;
/// Between the first seeds of training and of tests.
const APART: u64 = 1_000_000;

/// A cylinder of the plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Case {
    pub seed: u64,
    pub training: bool,
    /// Leak rate, Pa/s.
    pub rate_pa_s: Option<f64>,
}

/// What came of it.
pub(super) struct Watched {
    pub case: Case,
    pub leak: Option<TrueLeak>,
    pub from_s: f64,
    pub until_s: f64,
    /// One for each candidate.
    pub traces: Vec<Trace>,
    /// Settled pressures of the candidates that have one, every [`SETTLED_S`] from the learning on, Pa; of tight cylinders alone.
    pub settled_pa: Vec<Vec<Residual>>,
}

impl Plan {
    /// All cylinders: long ones first, so that no thread is left with one at the end.
    pub(super) fn cases(&self) -> Vec<Case> {
        let tight = |first: u64, count: u64, training| {
            (0..count).map(move |n| Case { seed: first + n, training, rate_pa_s: None })
        };
        let test_seed = self.seed + APART;
        let leaking = self.rates_pa_s.iter().flat_map(|rate| {
            let rate_pa_s = Some(*rate);
            (0..self.tests).map(move |n| Case { seed: test_seed + n, training: false, rate_pa_s })
        });
        tight(self.seed, self.training, true)
            .chain(tight(test_seed, self.tests, false))
            .chain(leaking)
            .collect()
    }

    /// The leak of a case: onset at a random time of the day after learning.
    fn leak(&self, case: Case) -> Option<TrueLeak> {
        let rate_pa_s = case.rate_pa_s?;
        let share: f64 = ChaCha8Rng::seed_from_u64(case.seed).random();
        Some(TrueLeak { rate_pa_s, onset_s: self.learning_s + share * DAY_S })
    }

    /// Simulate a case and let all candidates watch it.
    pub(super) fn watch(&self, case: Case, candidates: &[Candidate]) -> Result<Watched, EvaluationError> {
        let leak = self.leak(case);
        let mass_kg_pa = self.mass_kg_pa()?;
        let end_s = self.learning_s + self.watched_s;
        // Time after which a leak is noticed without a detector.
        let noticed_s = leak.map_or(f64::INFINITY, |leak| {
            leak.onset_s + NOTICED * Self::FILLING.pressure_pa / leak.rate_pa_s
        });
        let days = end_s.min(noticed_s) / DAY_S;
        let mut settings = self.truth();
        settings.leak =
            leak.map(|leak| TruthLeak { rate_kg_s: leak.rate_pa_s * mass_kg_pa, start_s: leak.onset_s });
        let truth = generate_with(&Course::RailwayWeeks { days }, case.seed, self.interval_s, &settings)?;
        let mut contenders = candidates.iter().map(Candidate::start).collect::<Result<Vec<_>, _>>()?;
        let watched = watch_all(&truth, &mut contenders, self.learning_s, leak.is_none())?;
        // Who has not noticed by then has missed it for good.
        let missed_s = noticed_s + Horizon::Month.seconds();
        let until_s = if noticed_s < end_s { missed_s } else { end_s };
        let (traces, settled_pa) = watched;
        Ok(Watched { case, leak, from_s: self.learning_s, until_s, traces, settled_pa })
    }
}

type Contenders = [Box<dyn Contender>];

/// The rows of a truth into all contenders: traces and settled pressures from `from_s` on.
fn watch_all(
    truth: &Truth,
    contenders: &mut Contenders,
    from_s: f64,
    keep_settled: bool,
) -> Result<(Vec<Trace>, Vec<Vec<Residual>>), EvaluationError> {
    let mut traces = vec![Trace::default(); contenders.len()];
    let mut settled_pa = vec![Vec::new(); contenders.len()];
    let mut next_s = from_s;
    for readings in rows(truth) {
        let time_s = readings.time_s;
        let counts = time_s >= from_s;
        for ((contender, trace), settled) in contenders.iter_mut().zip(&mut traces).zip(&mut settled_pa) {
            let value = contender.step(&readings)?;
            if counts {
                trace.push(time_s, value, || contender.found());
            }
            if keep_settled && time_s >= next_s {
                settled.extend(contender.settled_pa().map(|value| Residual { time_s, value }));
            }
        }
        if time_s >= next_s {
            next_s += SETTLED_S;
        }
    }
    Ok((traces, settled_pa))
}

/// What the sensors read, row by row.
fn rows(truth: &Truth) -> impl Iterator<Item = Readings> + '_ {
    let column = |name: &str| truth.log.channels.iter().position(|channel| channel.name == name);
    let columns = ["shoulder", "valve", "pressure"].map(column);
    truth.log.rows().map(move |(time_s, row)| {
        let [shoulder_k, valve_k, pressure_pa] =
            columns.map(|column| column.map_or(f64::NAN, |column| row[column]));
        Readings { time_s, shoulder_k, valve_k, pressure_pa }
    })
}
