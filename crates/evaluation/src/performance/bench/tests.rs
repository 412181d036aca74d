//! A bench of a few cylinders over a day.
use cylwatch_thermal::units::DAY_S;
use cylwatch_thermal::units::YEAR_S;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

use super::*;
use crate::EvaluationError;
use crate::baseline::{Expectation, GasTemperature, PressureError, Threshold};
use crate::performance::{Estimated, Found, Horizon};

const BAR_H: f64 = 1e5 / 3600.0;

fn plan() -> Plan {
    Plan {
        rates_pa_s: vec![20.0 * BAR_H],
        training: 5,
        tests: 2,
        learning_s: 0.2 * DAY_S,
        watched_s: 1.2 * DAY_S,
        between_alarms_s: 0.1 * YEAR_S,
        ..Plan::default()
    }
}

/// An error with a zero over hours; it states a rate and its error as what the settled pressure does.
struct Zeroed {
    threshold: Threshold,
    error: PressureError,
    missing_pa: Option<f64>,
}

impl Zeroed {
    fn start() -> Result<Self, EvaluationError> {
        let expectation = Expectation::real_gas("nitrogen", Plan::FILLING)?;
        let error = PressureError::new(expectation, GasTemperature::with_pole(0.003));
        let threshold = Threshold::new(error.clone()).zeroed_over(0.15 * DAY_S);
        Ok(Self { threshold, error, missing_pa: None })
    }
}

impl Contender for Zeroed {
    fn step(&mut self, readings: &Readings) -> Result<f64, EvaluationError> {
        self.missing_pa = self.error.step(readings.seen());
        Ok(self.threshold.update(readings.seen()))
    }

    fn found(&mut self) -> Option<Found> {
        let rate = self.threshold.loss(160e5)?.rate_pa_s;
        Some(Found { rate_pa_s: Some(Estimated { value: rate, interval: None }), onset_s: None })
    }

    fn settled_pa(&self) -> Option<f64> {
        self.missing_pa.map(|missing| 200e5 - missing)
    }
}

fn candidates() -> Vec<Candidate> {
    vec![
        Candidate::new("paper", "Pa", || Ok(Threshold::published(Plan::FILLING))),
        Candidate::new("zeroed", "Pa", Zeroed::start),
    ]
}

/// The outcome and how many cylinders were reported at the end.
fn outcome() -> &'static (Outcome, u64) {
    static OUTCOME: OnceLock<(Outcome, u64)> = OnceLock::new();
    OUTCOME.get_or_init(|| {
        let most = AtomicU64::new(0);
        let report = |progress: Progress| {
            assert_eq!(progress.all, plan().cylinders());
            most.fetch_max(progress.done, Ordering::Relaxed);
        };
        let outcome = bench(&plan(), &candidates(), &report).unwrap();
        (outcome, most.into_inner())
    })
}

#[test]
fn every_candidate_is_judged_on_the_same_cylinders_and_a_large_leak_is_found() {
    let (outcome, reported) = outcome();
    assert_eq!(*reported, 9);
    let onsets = |judged: &Judged| judged.runs.iter().map(|run| run.leak).collect::<Vec<_>>();
    assert_eq!(onsets(&outcome.judged[0]), onsets(&outcome.judged[1]));
    let zeroed = &outcome.judged[1].performance;
    assert_eq!(zeroed.detector, "zeroed");
    let at = &zeroed.sensitivity[0];
    assert_eq!((at.delay.leaks, at.delay.found), (2, 2));
    assert!(at.delay.median_s.is_some_and(|delay_s| delay_s > 600.0 && delay_s < 0.25 * DAY_S));
    // 20 bar/h, and not yet all of the slope's memory in the leak.
    let rate = at.accuracy.rate.unwrap();
    assert!(rate.runs == 2 && rate.bias < 0.1 && rate.bias > -0.9, "{rate:?}");
}

#[test]
fn leaks_begin_after_learning_and_who_misses_one_until_the_gas_is_gone_has_missed_it() {
    let (outcome, _) = outcome();
    for run in outcome.judged[0].runs.iter().filter(|run| run.leak.is_some()) {
        let onset_s = run.leak.unwrap().onset_s;
        assert!((0.2 * DAY_S..1.2 * DAY_S).contains(&onset_s));
        // 40 % of 200 bar at 20 bar/h are gone after 4 h: known for each horizon.
        assert!(Horizon::ALL.iter().all(|horizon| run.found_within(horizon.seconds()).is_some()));
    }
    let tight = &outcome.judged[0].performance.reliability;
    assert!(tight.at_risk_s <= 2.0 * 1.2 * DAY_S && tight.at_risk_s > 0.0);
}

#[test]
fn thresholds_say_how_far_they_are_extrapolated_and_the_noise_gives_a_bound() {
    let (outcome, _) = outcome();
    let level = outcome.judged[0].level;
    approx::assert_relative_eq!(level.factor, 0.1 * YEAR_S / (5.0 * 1.2 * DAY_S), max_relative = 1e-12);
    let noise = outcome.noise.unwrap();
    assert!((0.01e5..5e5).contains(&noise.sd), "{noise:?}");
    let at = &outcome.judged[1].performance.sensitivity[0];
    assert!(at.bound_s.unwrap() > 0.0 && at.bound_s.unwrap() < at.delay.mean_found_s.unwrap());
}

#[test]
fn the_same_plan_gives_the_same_numbers_on_one_thread() {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let tight = Plan { rates_pa_s: Vec::new(), tests: 1, ..plan() };
    let alone = one.install(|| bench(&tight, &candidates(), &|_| ()).unwrap());
    for (alone, judged) in alone.judged.iter().zip(&outcome().0.judged) {
        assert_eq!((alone.level, alone.runs[0]), (judged.level, judged.runs[0]));
    }
}

#[test]
fn plans_that_cannot_be_are_refused() {
    let refused = |plan: Plan| bench(&plan, &[], &|_| ()).is_err();
    assert!(refused(Plan { training: 4, ..plan() }));
    assert!(refused(Plan { tests: 0, ..plan() }));
    assert!(refused(Plan { watched_s: DAY_S, ..plan() }));
    assert!(refused(Plan { rates_pa_s: vec![1.0, -1.0], ..plan() }));
    assert!(refused(Plan { vessel: "no-such-vessel".into(), ..plan() }));
}

#[test]
fn the_mass_of_a_bar_is_that_of_the_gas_tables() {
    // 20 L of nitrogen at 200 bar and 15 °C: 0.9592 g/bar per litre, and 0.3 % of 4.46 kg more by the steel's stretching over 200 bar.
    let kg_bar = plan().mass_kg_pa().unwrap() * 1e5;
    assert!((kg_bar - 19.2e-3).abs() < 0.15e-3, "{kg_bar}");
}

#[test]
fn a_candidate_that_says_nothing_is_named() {
    struct Mute;
    impl Contender for Mute {
        fn step(&mut self, _: &Readings) -> Result<f64, EvaluationError> {
            Ok(f64::NEG_INFINITY)
        }
    }
    let tight = Plan { rates_pa_s: Vec::new(), tests: 1, ..plan() };
    let error = bench(&tight, &[Candidate::new("mute", "1", || Ok(Mute))], &|_| ()).unwrap_err();
    assert!(matches!(error, EvaluationError::Silent { ref detector, found: 0, .. } if detector == "mute"));
}

#[test]
fn the_monitor_and_the_baselines_find_a_large_leak_and_the_monitor_says_how_large() {
    let plan = Plan { tests: 1, ..plan() };
    let mut all = vec![monitor(&plan).unwrap()];
    all.extend(baselines(&plan).unwrap());
    let outcome = bench(&plan, &all, &|_| ()).unwrap();
    let names: Vec<&str> = outcome.judged.iter().map(|one| one.performance.detector.as_str()).collect();
    assert_eq!(
        names,
        ["cylwatch", "paper", "paper refitted", "textbook CUSUM", "ideal gas", "pressure switch"]
    );
    let ours = &outcome.judged[0].performance.sensitivity[0];
    assert_eq!((ours.delay.leaks, ours.delay.found), (1, 1));
    let rate = ours.accuracy.rate.unwrap();
    assert!(rate.rms < 0.5, "{rate:?}");
    assert!(outcome.judged.iter().all(|one| one.level.threshold.is_finite()));
}
