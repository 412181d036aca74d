//! The rate of false alarms that thresholds have in cylinders that they were not fitted to: cross-validation over whole cylinders.
//!
//! Cylinders are dealt to two halves so that both have as many of each family. Thresholds fitted to one half are held against the other half, both
//! ways. They rest on half of the data, so the rate is rather that of somewhat worse thresholds than of those fitted to all.
//!
//! Source: M. Stone, J. R. Stat. Soc. B 36 (1974) 111.
use cylwatch_thermal::units::HOUR_S;
use std::collections::BTreeMap;

use cylwatch_detector::monitor::MonitorSettings;

use super::fit::fit;
use super::monitored::MonitoredCylinder;
use super::record::Record;
use crate::EvaluationError;
use crate::judge::table::{Clustered, Rate};
use crate::world::{Family, SimulationKey};

/// Number of halves.
pub(super) const FOLDS: usize = 2;

/// False alarms at thresholds for a mean time, s, each cylinder by those fitted to the other half; `stretch` as in `Record::stretch_h`.
///
/// # Errors
/// A half has too few stretches or nothing to fit to.
pub(super) fn false_alarm_rate(
    monitored: &[MonitoredCylinder],
    stretch: f64,
    mean_time_s: f64,
) -> Result<Rate, EvaluationError> {
    let over_after_s = MonitorSettings::default().leak_over_after_s;
    let folds = folds(monitored);
    let mut counted = Clustered::default();
    for fold in 0..FOLDS {
        let (held_out, fitted): (Vec<_>, Vec<_>) =
            monitored.iter().zip(&folds).partition(|(_, of_it)| **of_it == fold);
        let records: Vec<&Record> = fitted.iter().map(|(monitored, _)| &monitored.record).collect();
        let thresholds = fit(&records, stretch)?.thresholds(mean_time_s)?;
        for (monitored, _) in held_out {
            let alarms = monitored.record.alarms(&thresholds, over_after_s);
            let at_risk_s = HOUR_S * alarms.at_risk_h as f64;
            counted.add(SimulationKey::of(&monitored.request), alarms.count as f64, at_risk_s);
        }
    }
    counted.rate().ok_or(EvaluationError::TooFewStretches { found: 0, needed: super::fit::STRETCHES })
}

/// The half of each cylinder. The first of the families go to the halves in turn, and the next one of a family to the next half. What shares a
/// simulation stays together.
fn folds(monitored: &[MonitoredCylinder]) -> Vec<usize> {
    let mut families: BTreeMap<Family, (usize, usize)> = BTreeMap::new();
    let mut simulations: BTreeMap<SimulationKey, usize> = BTreeMap::new();
    let mut fold_of = |monitored: &MonitoredCylinder| {
        let request = &monitored.request;
        *simulations.entry(SimulationKey::of(request)).or_insert_with(|| {
            let next = families.len();
            let (family, rank) = families.entry(request.family).or_insert((next, 0));
            *rank += 1;
            (*family + *rank) % FOLDS
        })
    };
    monitored.iter().map(&mut fold_of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Climate, Request};
    use cylwatch_detector::evidence::Scale;
    use cylwatch_thermal::units::DAY_S;

    const MEAN_TIME_S: f64 = 3652.5 * DAY_S;

    /// Forty days of stretches whose peaks fall off exponentially, `loudness` times as high.
    fn monitored(seed: u64, climate: Climate, loudness: f64) -> MonitoredCylinder {
        let mut record = Record::default();
        for hour in 0..40 * 24_u32 {
            // Even over 0 to 1, and never alike.
            let even = (f64::from(hour).mul_add(0.618_034, seed as f64 * 0.414_213_6)).fract();
            let value = loudness * -(1.0 - even).ln();
            record.update(3600.0 * f64::from(hour), &[value; Scale::ALL.len()]);
        }
        let family = Family { climate, ..Family::usual() };
        MonitoredCylinder { request: Request::tight(family, seed, 40.0 * DAY_S), record }
    }

    fn cylinders(loudness: impl Fn(u64) -> f64) -> Vec<MonitoredCylinder> {
        (0..60).map(|seed| monitored(seed, Climate::Railway, loudness(seed))).collect()
    }

    #[test]
    fn a_cylinder_is_held_against_thresholds_of_the_other_half_alone() {
        // Cylinders alternate between the halves; one half is fifty times as loud.
        let all = cylinders(|seed| if seed % 2 == 0 { 1.0 } else { 50.0 });
        let folds = folds(&all);
        let half =
            |loud: bool| all.iter().zip(&folds).filter(move |(w, _)| (w.request.seed % 2 == 1) == loud);
        assert!(
            half(true).all(|(_, fold)| *fold != folds[0]) && half(false).all(|(_, fold)| *fold == folds[0])
        );
        let quiet: Vec<&Record> = half(false).map(|(monitored, _)| &monitored.record).collect();
        let thresholds = fit(&quiet, 0.01).unwrap().thresholds(MEAN_TIME_S).unwrap();
        let expected: u64 =
            half(true).map(|(monitored, _)| monitored.record.alarms(&thresholds, DAY_S).count).sum();
        let rate = false_alarm_rate(&all, 0.01, MEAN_TIME_S).unwrap();
        assert!(expected >= 30, "{expected}");
        // The quiet half never reaches thresholds of the loud one.
        assert_eq!((rate.count, rate.simulations_with), (expected, 30));
    }

    #[test]
    fn each_half_has_every_family_and_what_shares_a_simulation_stays_together() {
        let climates = [Climate::Railway, Climate::Parked, Climate::Workshop];
        let all: Vec<MonitoredCylinder> =
            (0..24).map(|seed| monitored(seed, climates[seed as usize % 3], 1.0)).collect();
        let folds = self::folds(&all);
        for climate in climates {
            let of = |half| {
                let is_one = |(w, fold): &(&MonitoredCylinder, &usize)| {
                    w.request.family.climate == climate && **fold == half
                };
                all.iter().zip(&folds).filter(is_one).count()
            };
            assert_eq!((of(0), of(1)), (4, 4), "{climate}");
        }
        let mut again = all[5].clone();
        again.request.set = 1;
        let both = self::folds(&[&all[..], &[again]].concat());
        assert_eq!(both[24], both[5]);
    }

    #[test]
    fn no_alarm_in_a_time_leaves_the_published_upper_bound() {
        let rate = false_alarm_rate(&cylinders(|_| 1.0), 0.01, 1e6 * MEAN_TIME_S).unwrap();
        assert_eq!((rate.count, rate.per_ten_years), (0, 0.0));
        // Garwood: 3.689 events for none.
        let tens = rate.cylinder_years / 10.0;
        assert!((tens / (60.0 * 40.0 / 3652.5) - 1.0).abs() < 1e-9);
        assert!((rate.by_simulation.1 * tens - 3.6889).abs() < 1e-3 && rate.by_simulation.0 == 0.0);
        assert_eq!(rate.by_simulation, rate.poisson);
    }
}
