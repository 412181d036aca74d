//! The monitor of this crate as a candidate.
//!
//! Each statistic of its [`Evidence`](crate::detector::evidence::Evidence) has a law for what it reaches without a leak: a value stands for
//! the mean time between false alarms `T` whose threshold it is. The candidate's statistic is the largest `log10(T/1 year)` of all; the monitor by
//! itself alarms at that of its settings, and the threshold that training finds says how far its laws are right.
//! What is said about the leak is what the monitor says after an alarm ([`Monitor::fitted`]).

use super::Plan;
use super::candidate::{Candidate, Contender, Readings};
use crate::EvaluationError;
use crate::detector::evidence::Tails;
use crate::detector::monitor::{Monitor, MonitorSettings};
use crate::estimator::observer::Commissioning;
use crate::estimator::sensor::Sensor;
use crate::performance::Found;
use crate::thermal::vessel::{Vessel, presets};
use cylwatch_thermal::units::YEAR_S;

/// Mean time between false alarms below which no threshold lies, as `log10(years)`: eight hours.
const SELDOM: f64 = -3.0;
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
    let pa_per_kg = 1.0 / plan.mass_kg_pa()?;
    let start = move || Monitored::start(&vessel, &sensors, &settings, pa_per_kg);
    start()?;
    Ok(Candidate::new("cylwatch", "log10(years)", start))
}

struct Monitored {
    monitor: Monitor,
    tails: Tails,
    pa_per_kg: f64,
    settled_pa: Option<f64>,
    /// The statistic.
    log_years: f64,
}

impl Monitored {
    fn start(
        vessel: &Vessel,
        sensors: &[Sensor],
        settings: &MonitorSettings,
        pa_per_kg: f64,
    ) -> Result<Self, EvaluationError> {
        let filled = Commissioning::filled(Plan::FILLING.pressure_pa, Plan::FILLING.temperature_k);
        // A cylinder in service has gas and wall apart.
        let commissioning = Commissioning { settled: false, ..filled };
        let monitor = Monitor::new(vessel, sensors, &commissioning, settings)?;
        Ok(Self {
            tails: *monitor.tails(),
            monitor,
            pa_per_kg,
            settled_pa: None,
            log_years: f64::NEG_INFINITY,
        })
    }
}

impl Contender for Monitored {
    fn step(&mut self, readings: &Readings) -> Result<f64, EvaluationError> {
        let row = [readings.shoulder_k, readings.valve_k, readings.pressure_pa];
        self.monitor.step(readings.time_s, &row)?;
        if let Some(freest) = self.monitor.observer().leaks().last() {
            self.settled_pa = Some(freest.mass_kg * self.pa_per_kg);
        }
        self.log_years = (self.tails.mean_time_s(&self.monitor.evidence()) / YEAR_S).log10();
        Ok(self.log_years)
    }

    fn found(&mut self) -> Option<Found> {
        // Below any threshold nobody asks.
        let posterior = self.monitor.posterior().filter(|_| self.log_years > SELDOM)?;
        let finding = posterior.finding(self.pa_per_kg);
        let (rate_pa_s, onset_s) = (finding.rate_pa_s.into(), finding.onset_s.into());
        Some(Found { rate_pa_s: Some(rate_pa_s), onset_s: Some(onset_s) })
    }

    fn settled_pa(&self) -> Option<f64> {
        self.settled_pa
    }
}
