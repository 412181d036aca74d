//! Alarms per cylinder-year without a leak, with Garwood's interval.
//!
//! Alarms of a detector that starts anew after each are nearly a Poisson process (a rare event of a process with short
//! memory). For `n` alarms in the time `T` the exact interval of the mean time is
//! `2T/chi2(1 - a/2; 2n + 2)` to `2T/chi2(a/2; 2n)`, endless above if there was none.
//!
//! Source: F. Garwood, Biometrika 28 (1936) 437.
use cylwatch_thermal::units::YEAR_S;
use serde::{Deserialize, Serialize};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::Run;

/// False alarms over the time without a leak and without an alarm before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AlarmRate {
    /// Number of false alarms.
    pub alarms: u64,
    /// Time at risk of all cylinders together, s.
    pub at_risk_s: f64,
}

impl AlarmRate {
    /// Of runs; from leaking cylinders the time before the leak counts.
    pub fn of(runs: &[Run]) -> Self {
        Self {
            alarms: runs.iter().filter(|run| run.is_false_alarm()).count() as u64,
            at_risk_s: runs.iter().map(Run::at_risk_s).sum(),
        }
    }

    /// Time at risk in cylinder-years.
    pub fn cylinder_years(&self) -> f64 {
        self.at_risk_s / YEAR_S
    }

    /// Alarms per cylinder-year; NaN without time at risk.
    pub fn per_year(&self) -> f64 {
        self.alarms as f64 / self.cylinder_years()
    }

    /// Interval of the alarms per cylinder-year at a level such as 0.95.
    pub fn per_year_interval(&self, level: f64) -> (f64, f64) {
        let tail = 0.5 * (1.0 - level.clamp(0.0, 1.0 - 1e-12));
        let mean_time = |freedom: u64, probability: f64| {
            let chi_square =
                ChiSquared::new(freedom as f64).expect("a positive number of degrees of freedom");
            2.0 * self.cylinder_years() / chi_square.inverse_cdf(probability)
        };
        let shortest = mean_time(2 * self.alarms + 2, 1.0 - tail);
        let longest = if self.alarms == 0 { f64::INFINITY } else { mean_time(2 * self.alarms, tail) };
        (1.0 / longest, 1.0 / shortest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn none_in_ten_years_may_still_be_one_in_less_than_three() {
        let none = AlarmRate { alarms: 0, at_risk_s: 10.0 * YEAR_S };
        // 3.689 events are the upper 97.5 % bound for none.
        assert_eq!(none.per_year(), 0.0);
        assert_eq!(none.per_year_interval(0.95).0, 0.0);
        assert_relative_eq!(none.per_year_interval(0.95).1, 0.36889, max_relative = 1e-4);
        let ten = AlarmRate { alarms: 10, at_risk_s: 10.0 * YEAR_S };
        let (low, high) = ten.per_year_interval(0.95);
        assert_relative_eq!(low, 0.47954, max_relative = 1e-4);
        assert_relative_eq!(high, 1.8390, max_relative = 1e-4);
    }

    #[test]
    fn alarms_after_the_onset_and_time_after_an_alarm_do_not_count() {
        let leak = Some(super::super::TrueLeak { rate_pa_s: 1.0, onset_s: 50.0 });
        let tight = Run { seed: 0, leak: None, from_s: 0.0, until_s: 100.0, alarm_s: None, found: None };
        let runs = [
            tight,
            Run { alarm_s: Some(30.0), ..tight },
            Run { leak, alarm_s: Some(70.0), ..tight },
            Run { leak, alarm_s: Some(20.0), ..tight },
        ];
        assert_eq!(AlarmRate::of(&runs), AlarmRate { alarms: 2, at_risk_s: 100.0 + 30.0 + 50.0 + 20.0 });
    }
}
