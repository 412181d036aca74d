//! The monitor of this crate as a candidate.
//!
//! Its statistic is the largest of the statistics of its [`Evidence`](crate::evidence::Evidence), each over its own threshold for the wished mean
//! time between false alarms: it alarms by itself at 1, and the threshold that training finds says how far that is right.
//! What is said about the leak comes from the masses of the freest member ([`onset`]), as in the monitor after an alarm.
use super::Plan;
use super::candidate::{Candidate, Contender, Readings};
use crate::DetectorError;
use crate::estimator::observer::Commissioning;
use crate::estimator::sensor::Sensor;
use crate::estimator::thermal::vessel::{Vessel, presets};
use crate::evidence::{Scale, Thresholds};
use crate::monitor::onset::{self, MassError};
use crate::monitor::trace::MassTrace;
use crate::monitor::{Monitor, MonitorSettings};
use crate::performance::Found;

/// The sensors of the readings, in the monitor's order.
const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];

/// The monitor with its usual settings on cylinders of a plan.
///
/// # Errors
/// The plan's vessel is not known, or its filling no state of the gas.
pub fn monitor(plan: &Plan) -> Result<Candidate, DetectorError> {
    let vessel = presets::load(&plan.vessel)?;
    let sensors = SENSORS.map(Sensor::typical).into_iter().collect::<Result<Vec<_>, _>>()?;
    let settings =
        MonitorSettings { false_alarm_interval_s: plan.between_alarms_s, ..MonitorSettings::default() };
    let thresholds = Thresholds::for_mean_time_s(plan.between_alarms_s)?;
    let pa_per_kg = 1.0 / plan.mass_kg_pa()?;
    let start = move || Monitored::start(&vessel, &sensors, &settings, thresholds, pa_per_kg);
    start()?;
    Ok(Candidate::new("cylwatch", start))
}

struct Monitored {
    monitor: Monitor,
    thresholds: Thresholds,
    trace: MassTrace,
    error: MassError,
    pa_per_kg: f64,
    settled_pa: Option<f64>,
}

impl Monitored {
    fn start(
        vessel: &Vessel,
        sensors: &[Sensor],
        settings: &MonitorSettings,
        thresholds: Thresholds,
        pa_per_kg: f64,
    ) -> Result<Self, DetectorError> {
        let filled = Commissioning::filled(Plan::FILLING.pressure_pa, Plan::FILLING.temperature_k);
        // A cylinder in service has gas and wall apart.
        let commissioning = Commissioning { settled: false, ..filled };
        Ok(Self {
            monitor: Monitor::new(vessel, sensors, &commissioning, settings)?,
            thresholds,
            trace: MassTrace::default(),
            error: settings.mass_error,
            pa_per_kg,
            settled_pa: None,
        })
    }
}

impl Contender for Monitored {
    fn step(&mut self, readings: &Readings) -> Result<f64, DetectorError> {
        let row = [readings.shoulder_k, readings.valve_k, readings.pressure_pa];
        for output in self.monitor.step(readings.time_s, &row)? {
            self.settled_pa = Some(output.estimate.p15_pa);
        }
        if let Some(freest) = self.monitor.observer().leaks().last() {
            self.trace.push(readings.time_s, freest.mass_kg);
        }
        let statistics = self.monitor.evidence();
        let part = |scale: Scale| statistics[scale as usize] / self.thresholds.of(scale);
        Ok(Scale::ALL.into_iter().map(part).fold(f64::NEG_INFINITY, f64::max))
    }

    fn found(&mut self) -> Option<Found> {
        let finding = onset::fit(&self.trace, &self.error)?.finding(self.pa_per_kg);
        Some(Found { rate_pa_s: Some(finding.rate_pa_s.into()), onset_s: Some(finding.onset_s.into()) })
    }

    fn settled_pa(&self) -> Option<f64> {
        self.settled_pa
    }
}
