//! Everything that looks at the same readings: the published scheme, a refitted one, and the monitor with its observer.
//!
//! | who | gas temperature | expected pressure | alarm |
//! |---|---|---|---|
//! | published | `0.003121/(s + 0.003021)` of the shoulder | 0.8457 bar/°C from the filling | error above a threshold for 10 min |
//! | refitted | gain 1, pole identified here | real gas, less the mean error of a first time at rest | the same |
//! | observer | shoulder, valve and pressure by a Kalman filter | gas mass, quoted at 15 °C | the monitor's own, one false alarm in ten years |
//!
//! What seems to be *missing* is the expected pressure less the one that was read; of the observer the pressure at 15 °C at the end of
//! the rest less the present one.
use super::ReproduceError;
use crate::detector::monitor::intake::IntakeSettings;
use crate::detector::monitor::{LeakFinding, Monitor, MonitorSettings};
use crate::estimator::log::Log;
use crate::estimator::observer::Commissioning;
use crate::estimator::sensor::Sensor;
use crate::evaluation::baseline::{
    Expectation, Filling, GasTemperature, Loss, PressureError, Reading, Threshold,
};
use crate::thermal::units::{BAR_PA, ZERO_CELSIUS_K};
use crate::thermal::vessel::Vessel;

/// A full cylinder, as every method assumes it.
pub(crate) const FULL: Filling = Filling { pressure_pa: 200e5, temperature_k: ZERO_CELSIUS_K + 15.0 };
/// Pressure at which the system is no longer operational, Pa.
pub(crate) const LIMIT_PA: f64 = 160e5;
/// The methods, in the order of all arrays.
pub(crate) const METHODS: [&str; 3] = ["published", "refitted", "observer"];

/// Who watches, and since when.
#[derive(Clone, Debug)]
pub(crate) struct Plan<'a> {
    /// The vessel that the monitor knows.
    pub nominal: &'a Vessel,
    /// Sensors of the monitor; shoulder, valve and pressure are among them.
    pub sensors: &'a [Sensor],
    /// Pole of the refitted transfer function, 1/s.
    pub pole_per_s: f64,
    /// End of the rest at the beginning, s: what is missing counts from there.
    pub rest_s: f64,
}

/// What all of them made of a log. Every vector has the length of `time_s`.
#[derive(Clone, Debug, Default)]
pub(crate) struct MethodRun {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Shoulder as read, °C.
    pub shoulder_degc: Vec<f64>,
    /// Pressure as read, bar.
    pub pressure_bar: Vec<f64>,
    /// Mean gas temperature by each of [`METHODS`], °C.
    pub gas_degc: [Vec<f64>; 3],
    /// Standard deviation that the observer states of it, K.
    pub gas_sd_k: Vec<f64>,
    /// Pressure that seems to be missing by each, bar.
    pub missing_bar: [Vec<f64>; 3],
    /// What the errors of the first two have lasted at, bar.
    pub lasting_bar: [Vec<f64>; 2],
    /// What the first two say of the loss at the end.
    pub losses: [Option<Loss>; 2],
    /// When the monitor finds a leak, s.
    pub found_s: Option<f64>,
    /// What it says of it at the end.
    pub finding: Option<LeakFinding>,
}

impl MethodRun {
    /// When an error of the first two has lasted at a threshold, bar, for the first time after a time, s.
    pub(crate) fn alarm_s(&self, method: usize, threshold_bar: f64, after_s: f64) -> Option<f64> {
        let mut rows = self.time_s.iter().zip(&self.lasting_bar[method]);
        rows.find(|(time_s, lasting)| **time_s >= after_s && **lasting >= threshold_bar)
            .map(|(time_s, _)| *time_s)
    }

    /// Largest error that has lasted, bar.
    pub(crate) fn largest_lasting_bar(&self, method: usize) -> f64 {
        self.lasting_bar[method].iter().copied().fold(0.0, f64::max)
    }
}

/// All methods on one stream of readings.
struct Methods {
    shoulder: usize,
    pressure: usize,
    gas: [GasTemperature; 2],
    errors: [PressureError; 2],
    thresholds: [Threshold; 2],
    monitor: Monitor,
    settled_bar: Vec<f64>,
}

impl Methods {
    fn new(plan: &Plan<'_>) -> Result<Self, ReproduceError> {
        let of = |name: &'static str| {
            let found = plan.sensors.iter().position(|sensor| sensor.name == name);
            found.ok_or(ReproduceError::Sensor { name })
        };
        let gas = GasTemperature::with_pole(plan.pole_per_s);
        let refitted = PressureError::new(Expectation::real_gas("nitrogen", FULL)?, gas);
        let zeroed = Threshold::new(refitted.clone()).zeroed_over(plan.rest_s);
        let each = IntakeSettings { step_s: 0.0, ..IntakeSettings::default() };
        let settings = MonitorSettings { intake: each, ..MonitorSettings::default() };
        let filled = Commissioning::filled(FULL.pressure_pa, FULL.temperature_k);
        Ok(Self {
            shoulder: of("shoulder")?,
            pressure: of("pressure")?,
            gas: [GasTemperature::PUBLISHED, gas],
            errors: [PressureError::published(FULL), refitted],
            thresholds: [Threshold::published(FULL), zeroed],
            monitor: Monitor::new(plan.nominal, plan.sensors, &filled, &settings)?,
            settled_bar: Vec::new(),
        })
    }

    fn step(&mut self, time_s: f64, row: &[f64], method_run: &mut MethodRun) -> Result<(), ReproduceError> {
        let (shoulder_k, pressure_pa) = (row[self.shoulder], row[self.pressure]);
        let reading = Reading { time_s, shoulder_k, pressure_pa };
        for k in 0..2 {
            let gas_k = self.gas[k].step(time_s, shoulder_k).unwrap_or(f64::NAN);
            method_run.gas_degc[k].push(gas_k - ZERO_CELSIUS_K);
            method_run.missing_bar[k].push(self.errors[k].step(reading).map_or(f64::NAN, |e| e / BAR_PA));
            method_run.lasting_bar[k].push(self.thresholds[k].update(reading) / BAR_PA);
        }
        for output in self.monitor.step(time_s, row)? {
            let estimate = &output.estimate;
            method_run.gas_degc[2].push(estimate.gas_mean_k - ZERO_CELSIUS_K);
            method_run.gas_sd_k.push(estimate.gas_mean_sd_k);
            self.settled_bar.push(estimate.p15_pa / BAR_PA);
            method_run.finding = output.leak;
            method_run.found_s = method_run.found_s.or(output.leak.map(|_| time_s));
        }
        method_run.time_s.push(time_s);
        method_run.shoulder_degc.push(shoulder_k - ZERO_CELSIUS_K);
        method_run.pressure_bar.push(pressure_pa / BAR_PA);
        Ok(())
    }
}

/// Lets all of them watch a log whose columns are the plan's sensors.
///
/// # Errors
/// A sensor is missing, or one of them cannot go on.
pub(crate) fn run_methods(plan: &Plan<'_>, log: &Log) -> Result<MethodRun, ReproduceError> {
    let columns: Vec<usize> = plan
        .sensors
        .iter()
        .filter_map(|sensor| log.channels.iter().position(|channel| channel.name == sensor.name))
        .collect();
    if columns.len() != plan.sensors.len() {
        return Err(ReproduceError::Sensor { name: "of the plan" });
    }
    let (mut watch, mut method_run) = (Methods::new(plan)?, MethodRun::default());
    for (time_s, row) in log.rows() {
        let readings: Vec<f64> = columns.iter().map(|&column| row[column]).collect();
        watch.step(time_s, &readings, &mut method_run)?;
    }
    let rest = method_run.time_s.partition_point(|&time_s| time_s < plan.rest_s).max(1);
    let zero_bar = method_run.missing_bar[1][..rest].iter().sum::<f64>() / rest as f64;
    method_run.missing_bar[1].iter_mut().for_each(|missing| *missing -= zero_bar);
    let full_bar = watch.settled_bar[rest - 1];
    method_run.missing_bar[2] = watch.settled_bar.iter().map(|settled| full_bar - settled).collect();
    for (loss, threshold) in method_run.losses.iter_mut().zip(&watch.thresholds) {
        *loss = threshold.loss(LIMIT_PA);
    }
    Ok(method_run)
}
