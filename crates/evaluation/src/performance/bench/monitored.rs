//! The monitor of this crate as a candidate.
//!
//! Each statistic of its [`Evidence`](crate::detector::evidence::Evidence) has a law for what it reaches without a leak: a value stands for
//! the mean time between false alarms `T` whose threshold it is. The candidate's statistic is the largest `log10(T/1 year)` of all; the monitor by
//! itself alarms at that of its settings, and the threshold that training finds says how far its laws are right.
//! What is said about the leak comes from the masses of the freest member ([`onset`]), as in the monitor after an alarm.
use std::sync::Arc;

use super::Plan;
use super::candidate::{Candidate, Contender, Readings};
use crate::EvaluationError;
use crate::detector::evidence::{Scale, Statistics, Thresholds};
use crate::detector::monitor::gas::onset::{self, MassError};
use crate::detector::monitor::gas::trace::MassTrace;
use crate::detector::monitor::{Monitor, MonitorSettings};
use crate::estimator::observer::Commissioning;
use crate::estimator::sensor::Sensor;
use crate::performance::{Found, YEAR_S};
use crate::thermal::vessel::{Vessel, presets};

/// Mean times between false alarms of the ladder: its first one as `log10(years)`, how many to a decade, and how many in all.
const FIRST_RUNG: f64 = -2.0;
const RUNGS_PER_DECADE: f64 = 10.0;
const RUNGS: i32 = 80;
/// Mean time below which no threshold lies, as `log10(years)`: a decade below the ladder, for trainings of hours.
const SELDOM: f64 = FIRST_RUNG - 1.0;
/// The sensors of the readings, in the monitor's order.
const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];

/// The monitor with its usual settings on cylinders of a plan.
///
/// # Errors
/// The plan's vessel is not known, or its filling no state of the gas.
pub fn monitor(plan: &Plan) -> Result<Candidate, EvaluationError> {
    let vessel = presets::load(&plan.vessel)?;
    let sensors = SENSORS.map(Sensor::typical).into_iter().collect::<Result<Vec<_>, _>>()?;
    let settings =
        MonitorSettings { false_alarm_interval_s: plan.between_alarms_s, ..MonitorSettings::default() };
    let ladder = Arc::new(Ladder::try_new()?);
    let pa_per_kg = 1.0 / plan.mass_kg_pa()?;
    let start = move || Monitored::start(&vessel, &sensors, &settings, Arc::clone(&ladder), pa_per_kg);
    start()?;
    Ok(Candidate::new("cylwatch", "log10(years)", start))
}

/// Thresholds for mean times of a decade's tenth each.
struct Ladder(Vec<Statistics>);

impl Ladder {
    fn try_new() -> Result<Self, EvaluationError> {
        let rung = |rung: i32| {
            let years = 10_f64.powf(FIRST_RUNG + f64::from(rung) / RUNGS_PER_DECADE);
            Ok(Thresholds::for_mean_time_s(years * YEAR_S)?.levels)
        };
        (0..=RUNGS).map(rung).collect::<Result<_, EvaluationError>>().map(Self)
    }

    /// `log10(T/1 year)` of the rarest of the statistics; linear between the rungs, and beyond the first and the last one.
    fn log_years(&self, statistics: &Statistics) -> f64 {
        let of = |scale: Scale| {
            let value = statistics[scale as usize];
            let level = |rung: usize| self.0[rung][scale as usize];
            // Short times share one threshold: the ladder begins where it rises.
            let first = self.0.partition_point(|levels| levels[scale as usize] <= level(0)) - 1;
            let above = self.0.partition_point(|levels| levels[scale as usize] <= value);
            let below = above.saturating_sub(1).clamp(first, self.0.len() - 2);
            let share = (value - level(below)) / (level(below + 1) - level(below));
            FIRST_RUNG + (below as f64 + share) / RUNGS_PER_DECADE
        };
        Scale::ALL.into_iter().map(of).fold(f64::NEG_INFINITY, f64::max)
    }
}

struct Monitored {
    monitor: Monitor,
    ladder: Arc<Ladder>,
    trace: MassTrace,
    error: MassError,
    pa_per_kg: f64,
    settled_pa: Option<f64>,
    /// The statistic, and whether the trace has got a bin since what was found was found.
    log_years: f64,
    renewed: bool,
    found: Option<Found>,
}

impl Monitored {
    fn start(
        vessel: &Vessel,
        sensors: &[Sensor],
        settings: &MonitorSettings,
        ladder: Arc<Ladder>,
        pa_per_kg: f64,
    ) -> Result<Self, EvaluationError> {
        let filled = Commissioning::filled(Plan::FILLING.pressure_pa, Plan::FILLING.temperature_k);
        // A cylinder in service has gas and wall apart.
        let commissioning = Commissioning { settled: false, ..filled };
        Ok(Self {
            monitor: Monitor::new(vessel, sensors, &commissioning, settings)?,
            ladder,
            trace: MassTrace::default(),
            error: settings.mass_error,
            pa_per_kg,
            settled_pa: None,
            log_years: f64::NEG_INFINITY,
            renewed: false,
            found: None,
        })
    }
}

impl Contender for Monitored {
    fn step(&mut self, readings: &Readings) -> Result<f64, EvaluationError> {
        let row = [readings.shoulder_k, readings.valve_k, readings.pressure_pa];
        self.monitor.step(readings.time_s, &row)?;
        if let Some(freest) = self.monitor.observer().leaks().last() {
            self.renewed |= self.trace.push(readings.time_s, freest.mass_kg);
            self.settled_pa = Some(freest.mass_kg * self.pa_per_kg);
        }
        self.log_years = self.ladder.log_years(&self.monitor.evidence());
        Ok(self.log_years)
    }

    fn found(&mut self) -> Option<Found> {
        // Below any threshold nobody asks.
        if self.renewed && self.log_years > SELDOM {
            let finding = onset::fit(&self.trace, &self.error)?.finding(self.pa_per_kg);
            let (rate_pa_s, onset_s) = (finding.rate_pa_s.into(), finding.onset_s.into());
            self.found = Some(Found { rate_pa_s: Some(rate_pa_s), onset_s: Some(onset_s) });
            self.renewed = false;
        }
        self.found
    }

    fn settled_pa(&self) -> Option<f64> {
        self.settled_pa
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_value_at_a_threshold_stands_for_its_mean_time() {
        let ladder = Ladder::try_new().unwrap();
        for years in [1.0, 7.3, 250.0] {
            let levels = Thresholds::for_mean_time_s(years * YEAR_S).unwrap().levels;
            assert_relative_eq!(ladder.log_years(&levels), years.log10(), epsilon = 2e-3);
            // One of them is enough.
            for scale in Scale::ALL {
                let mut one = [0.0; Scale::ALL.len()];
                one[scale as usize] = levels[scale as usize];
                assert_relative_eq!(ladder.log_years(&one), years.log10(), epsilon = 2e-3);
            }
        }
        let at = |value: f64| ladder.log_years(&[value; Scale::ALL.len()]);
        assert!(at(-1.0) < at(0.0) && at(0.0) < -1.0 && at(100.0) > 6.0);
    }
}
