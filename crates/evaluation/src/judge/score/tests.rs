//! Scores of statements that are known, in toy worlds.
use cylwatch_thermal::units::HOUR_S;
use rand::RngExt;
use rand_distr::StandardNormal;

use super::agreement::{Rule, is_broken};
use super::innovation::{Innovations, Whiteness};
use super::*;
use crate::detector::prognosis::Reaction;
use crate::judge::fixture::{WHOLE_KG, decided, toy, world};
use crate::judge::measures::Class;
use crate::judge::statement::{Decision, Innovation};
use crate::judge::watch::watch;
use crate::world::{Family, FaultRow, Leak, Regime, Request, RowPattern};

fn request(overlay: Overlay, length_h: f64) -> Request {
    let family = Family { rows: RowPattern::Minute, ..Family::usual() };
    Request::tight(family, 1, length_h * HOUR_S).with(overlay)
}

/// Says a class once so much of the gas is lost, tight before.
macro_rules! from_loss {
    ($part:expr, $class:expr) => {
        toy(|_, row| {
            let lost = row.readings[2] <= WHOLE_KG * (1.0 - $part);
            Statement {
                decision: Some(decided(if lost { $class } else { Class::Tight })),
                ..Statement::default()
            }
        })
    };
}

fn fast_loss(part: f64, candidate: &dyn crate::judge::candidate::Candidate) -> FastLoss {
    let overlay = Overlay::FastLoss { part, within_s: HOUR_S, onset_s: HOUR_S, goes_on: false };
    watch(&world(&request(overlay, 4.0)), candidate).score.unwrap().fast_loss.unwrap()
}

#[test]
fn a_fast_loss_is_told_in_time_within_5_min_of_3_percent_and_not_later() {
    // 12 % an hour: 3 % after 15 min, 4 % after 20 min, 4.2 % after 21 min.
    let of = fast_loss(0.12, from_loss!(0.04, Class::Discharge).as_ref());
    assert!((of.matters_s.unwrap() - 900.0).abs() < 1e-6);
    assert_eq!((of.in_time, of.told_as), (true, Some(Class::Discharge)));
    assert!((of.told_s.unwrap() - 1200.0).abs() < 1e-6);
    assert!(!fast_loss(0.12, from_loss!(0.0415, Class::Leak).as_ref()).in_time);
    assert_eq!(fast_loss(0.02, from_loss!(0.01, Class::Leak).as_ref()).matters_s, None);
    let never = fast_loss(0.12, from_loss!(0.5, Class::Leak).as_ref());
    assert_eq!((never.in_time, never.told_s), (false, None));
}

#[test]
fn with_rows_farther_apart_the_first_statement_after_the_loss_is_in_time() {
    let overlay = Overlay::FastLoss { part: 0.6, within_s: 120.0, onset_s: 310.0, goes_on: false };
    let family = Family { rows: RowPattern::FiveMinutes, ..Family::usual() };
    let request = Request::tight(family, 1, 2.0 * HOUR_S).with(overlay);
    let told = watch(&world(&request), from_loss!(0.03, Class::Leak).as_ref()).score.unwrap();
    assert!(told.fast_loss.unwrap().in_time);
}

#[test]
fn an_exchange_is_recognised_by_its_own_name_alone() {
    let overlay = Overlay::Discharge { part: 0.3, within_s: 60.0, onset_s: HOUR_S, announced: true };
    let world = world(&request(overlay, 3.0));
    let recognised = |candidate: &dyn crate::judge::candidate::Candidate| {
        watch(&world, candidate).score.unwrap().exchanged.unwrap().recognised
    };
    assert!(recognised(from_loss!(0.1, Class::Discharge).as_ref()));
    assert!(!recognised(from_loss!(0.1, Class::Leak).as_ref()));
    assert!(!recognised(from_loss!(0.1, Class::Refill).as_ref()));
}

fn says_always(class: Class) -> std::sync::Arc<dyn crate::judge::candidate::Candidate> {
    match class {
        Class::Discharge => {
            toy(|_, _| Statement { decision: Some(decided(Class::Discharge)), ..Statement::default() })
        }
        _ => toy(|_, _| Statement { decision: Some(decided(Class::Refill)), ..Statement::default() }),
    }
}

#[test]
fn a_fault_is_recognised_by_what_its_row_requires() {
    let outcome = |row: FaultRow, candidate: &dyn crate::judge::candidate::Candidate| {
        let overlay = Overlay::Fault { row, onset_s: 30.0 * HOUR_S, leak: None };
        watch(&world(&request(overlay, 60.0)), candidate).score.unwrap().fault.unwrap()
    };
    let names = toy(|_, row| {
        let class = if row.stamp_s > 31.0 * HOUR_S { Class::SensorFault } else { Class::Tight };
        Statement { decision: Some(decided(class)), ..Statement::default() }
    });
    let leaks = toy(|_, row| {
        let class = if row.stamp_s > 31.0 * HOUR_S { Class::Leak } else { Class::Tight };
        Statement { decision: Some(decided(class)), ..Statement::default() }
    });
    let tight = toy(|_, _| Statement { decision: Some(decided(Class::Tight)), ..Statement::default() });
    // P1 must be named, P5 survived; P3 may be taken for a leak, and nothing else may. A discharge is a loss, a refill is none.
    let recognised = |row| [&names, &leaks, &tight].map(|who| outcome(row, who.as_ref()).recognised);
    assert_eq!(recognised(FaultRow::P1), [true, false, false]);
    assert_eq!(recognised(FaultRow::P5), [true, false, true]);
    assert_eq!(recognised(FaultRow::P3), [true, true, true]);
    let exchanges = [Class::Discharge, Class::Refill].map(|class| {
        let from = outcome(FaultRow::P5, says_always(class).as_ref());
        (from.recognised, from.false_loss, from.false_exchange)
    });
    assert_eq!(exchanges, [(false, true, true), (true, false, true)]);
    assert!(outcome(FaultRow::P1, leaks.as_ref()).false_loss && outcome(FaultRow::P1, names.as_ref()).named);
}

#[test]
fn a_leak_beside_a_leak_is_found_whenever_it_is_told() {
    let leak = Some(Leak { part_per_h: 5e-4, onset_s: 36.0 * HOUR_S });
    let overlay = Overlay::Fault { row: FaultRow::G4, onset_s: 30.0 * HOUR_S, leak };
    let world = world(&request(overlay, 60.0));
    let recognised = |says: &dyn crate::judge::candidate::Candidate| {
        watch(&world, says).score.unwrap().fault.unwrap().recognised
    };
    let told = [leak_from_hour::<31>(), leak_from_hour::<40>(), leak_from_hour::<70>()];
    assert_eq!(told.map(|says| recognised(says.as_ref())), [true, true, false]);
}

/// Says tight, and from an hour on a leak.
fn leak_from_hour<const HOUR: u32>() -> std::sync::Arc<dyn crate::judge::candidate::Candidate> {
    toy(|_, row| {
        let class = if row.stamp_s > f64::from(HOUR) * HOUR_S { Class::Leak } else { Class::Tight };
        Statement { decision: Some(decided(class)), ..Statement::default() }
    })
}

#[test]
fn each_contradiction_breaks_its_own_rule_and_sound_decisions_break_none() {
    let broken = |decision: Decision, said_before: bool| -> Vec<Rule> {
        let loss_said = said_before || decision.loss;
        Rule::ALL.into_iter().filter(|rule| is_broken(*rule, &decision, 0.5, false, loss_said)).collect()
    };
    for class in Class::ALL {
        assert_eq!(broken(decided(class), false), [], "{class}");
    }
    let [tight, leak, fault] = [Class::Tight, Class::Leak, Class::SensorFault].map(decided);
    let (unknown, out) = (decided(Class::Unknown), decided(Class::Discharge));
    let p = |leak_probability| leak_probability;
    let cases = [
        (Decision { leak_probability: p(Some(f64::NAN)), ..tight }, Rule::NoProbability),
        (Decision { leak_probability: p(Some(0.5)), ..tight }, Rule::TightButProbable),
        (Decision { leak_probability: p(Some(0.9)), ..fault }, Rule::SensorFaultButProbable),
        (Decision { leak_probability: p(Some(0.4)), ..leak }, Rule::LossButImprobable),
        (Decision { leak: false, ..leak }, Rule::LeakNotStated),
        (Decision { alarm: Some(false), ..leak }, Rule::LossWithoutAlarm),
        (Decision { reaction: Some(Reaction::None), ..out }, Rule::LossWithoutReaction),
        (Decision { exit_code: 0, ..out }, Rule::LossButExitCode),
        (Decision { loss: false, exit_code: 0, leak_probability: None, ..out }, Rule::DischargeButNoLoss),
        (Decision { exit_code: 1, ..tight }, Rule::ExitCodeWithoutLoss),
        (Decision { exit_code: 0, ..unknown }, Rule::UnknownButExitCode),
        (Decision { exit_code: 3, ..tight }, Rule::TightButInconclusive),
    ];
    for (decision, rule) in cases {
        assert_eq!(broken(decision, false), [rule]);
    }
    let stated = Decision { leak: true, ..tight };
    assert!(broken(stated, true).contains(&Rule::TightButLeak));
    // Gas was lost before, and is not any more.
    assert_eq!(broken(Decision { exit_code: 1, ..tight }, true), []);
}

#[test]
fn innovations_that_hang_together_are_found_with_their_correlation_by_regime() {
    // An autoregression of rows a minute apart: 0.9 at a minute, 0.9^10 at ten; twice as large as stated while calm.
    let mut random: rand_chacha::ChaCha8Rng = rand::SeedableRng::seed_from_u64(3);
    let (mut sums, mut whiteness) = (Innovations::default(), Whiteness::default());
    let mut z: f64 = random.sample(StandardNormal);
    for row in 0..400_000_u32 {
        let fresh: f64 = random.sample(StandardNormal);
        z = 0.9 * z + (1.0 - 0.81_f64).sqrt() * fresh;
        let calm = row / 1000 % 2 == 0;
        let (regime, nu) = if calm { (Regime::Calm, 2.0 * z) } else { (Regime::Mouth, z) };
        let innovation = Innovation { nu: 5.0 * nu, s: 25.0 };
        whiteness.take(&mut sums, 60.0 * f64::from(row), regime, Some(innovation));
    }
    for (regime, nis) in [(Regime::Calm, 4.0), (Regime::Mouth, 1.0)] {
        let of = &sums[regime as usize];
        assert!((of.mean_nis().unwrap() / nis - 1.0).abs() < 0.05, "{regime:?}: {:?}", of.mean_nis());
        let [minute, ten] = [0, 1].map(|lag| of.lags[lag].correlation().unwrap());
        assert!((minute - 0.9).abs() < 0.01 && (ten - 0.9_f64.powi(10)).abs() < 0.03, "{minute} {ten}");
    }
    assert_eq!(sums[Regime::Sun as usize], innovation::RegimeSums::default());
}

#[test]
fn a_statement_that_flickers_is_one_episode_and_one_an_hour_later_another() {
    // A leak is said in every second row of the second and of the fourth hour.
    let flickers = toy(|_, row| {
        let (hour, minute) = ((row.stamp_s / HOUR_S) as u64, (row.stamp_s / 60.0) as u64);
        let leaks = (hour == 1 || hour == 3) && minute.is_multiple_of(2);
        let class = if leaks { Class::Leak } else { Class::Tight };
        Statement { decision: Some(decided(class)), ..Statement::default() }
    });
    let score = watch(&world(&request(Overlay::Nothing, 6.0)), flickers.as_ref()).score.unwrap();
    let leak = score.episodes.unwrap().leak;
    assert_eq!(leak.count, [2, 0]);
    // Two hours of six, every second row: five hours without it.
    assert!((leak.at_risk_s[0] - 5.0 * HOUR_S).abs() < 1.0, "{leak:?}");
    assert!((score.shares.unwrap().tight_s[0][Class::Leak as usize] - HOUR_S).abs() < 1.0);
}

#[test]
fn an_exchange_that_is_told_by_an_event_alone_counts() {
    let puffs = toy(|_, row| {
        let exchange = row.stamp_s == 2.0 * HOUR_S;
        Statement { decision: Some(Decision { exchange, ..decided(Class::Tight) }), ..Statement::default() }
    });
    let score = watch(&world(&request(Overlay::Nothing, 6.0)), puffs.as_ref()).score.unwrap();
    assert_eq!(score.episodes.unwrap().exchange.count, [1, 0]);
}

#[test]
fn a_candidate_that_fails_or_panics_has_no_score_and_a_reason() {
    let panics = toy(|_, row| {
        assert!(row.stamp_s < 600.0, "no more");
        Statement::default()
    });
    let reason = watch(&world(&request(Overlay::Nothing, 1.0)), panics.as_ref()).score.unwrap_err();
    assert!(reason.contains("panicked: no more"), "{reason}");
}
