//! The paper's cases on cylinders that are unknown to all methods: as published, refitted, by the observer, and the bound.
//!
//! **Cylinders** are drawn from seeds around the built-in one ([`crate::evaluation::world::chamber`]): films, capacities, mounting, sensor errors and gusts
//! differ, the gas is stratified. Each rests for an hour before its air changes.
//!
//! **Bound** of the gas temperature: the posterior Cramér-Rao bound along paths of the observer's own model with its prior
//! ([`matched`](crate::evaluation::matched)); of the pressure that is missing: the same times `dp/dT` at the filling. Of a leak: what the innovations of the
//! steady observer at rest tell of it ([`SteadyAnalysis`]), which knows no tunnel. No truth here comes from those models, so a bound is what
//! could be hoped for, not what must hold.
//!
//! **Thresholds** of the two detectors without an observer: the lowest at which they are silent in the same passage on as many tight
//! cylinders of other seeds, and a tenth more. The monitor has its own, for one false alarm in ten years.
use super::ReproduceError;
use super::cylinder::VESSEL;
use super::methods::{MethodRun, Plan, run_methods};
use crate::estimator::observer::ObserverSettings;
use crate::estimator::placement::{Disturbance, SteadyAnalysis, SteadySettings};
use crate::estimator::sensor::Sensor;
use crate::evaluation::matched::{least_errors, mass_member, settings};
use crate::evaluation::world::SteadyLeak;
use crate::evaluation::world::chamber::{Chamber, ChamberRequest, ChamberRun};
use crate::thermal::units::HOUR_S;
use crate::thermal::units::{BAR_PA, ZERO_CELSIUS_K};
use crate::thermal::vessel::{Vessel, presets};
use rayon::prelude::*;
use std::ops::Range;

const GRAM_PER_HOUR: f64 = 1e-3 / HOUR_S;
/// Sensors of the observer.
const SENSORS: [&str; 3] = ["shoulder", "valve", "pressure"];
/// Interval of the readings, s.
const SAMPLE_S: f64 = 30.0;
/// True paths behind a bound.
const PATHS: u64 = 20;
/// From the entry into the tunnel to the onset of the leak, s, as in the paper's figure 8.
const ONSET_AFTER_S: f64 = 3000.0;
/// Leaks, g/h: that of figure 8, and a tenth of it.
pub(crate) const LEAKS_G_H: [f64; 2] = [60.0, 6.0];
/// Seeds of the tight cylinders that thresholds come from lie so far above those of the others.
const TRAINING: u64 = 100_000;

/// Titles of [`Chamber::SCENARIOS`].
const TITLES: [&str; 4] = [
    "21 to \u{2212}25 °C at once",
    "\u{2212}25 to 40 °C at once",
    "10 to 60 °C in 5 h",
    "60 to 28 °C in 14 h",
];

/// A number over several cylinders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spread {
    /// Root of the mean square, or the mean.
    pub value: f64,
    /// The least of a cylinder.
    pub low: f64,
    /// The largest.
    pub high: f64,
}

impl Spread {
    /// Root mean square of values that are themselves root mean squares of as many samples.
    fn pooled(values: &[f64]) -> Self {
        let mean = values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64;
        Self { value: mean.sqrt(), ..Self::mean(values) }
    }

    fn mean(values: &[f64]) -> Self {
        Self {
            value: values.iter().sum::<f64>() / values.len() as f64,
            low: values.iter().copied().fold(f64::INFINITY, f64::min),
            high: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

/// A drawn cylinder in a scenario with the results of all methods.
#[derive(Clone, Debug)]
pub(crate) struct Drawn {
    /// What really happened, and what was read.
    pub run: ChamberRun,
    /// Results of the methods.
    pub method_run: MethodRun,
}

impl Drawn {
    /// Error of the mean gas temperature, K, of one of [`METHODS`](super::methods::METHODS).
    pub(crate) fn gas_error_k(&self, method: usize) -> Vec<f64> {
        let truth = self.run.trajectory.gas_mean_k.iter().map(|k| k - ZERO_CELSIUS_K);
        self.method_run.gas_degc[method].iter().zip(truth).map(|(said, truth)| said - truth).collect()
    }

    /// First sample after the air begins to change.
    fn change(&self) -> usize {
        let change_s = self.run.request.chamber.change_s();
        self.run.trajectory.time_s.partition_point(|&time_s| time_s < change_s)
    }

    /// Root mean square from the change on.
    fn rms(&self, values: &[f64]) -> f64 {
        let judged = &values[self.change()..];
        (judged.iter().map(|value| value * value).sum::<f64>() / judged.len() as f64).sqrt()
    }
}

/// A scenario on all drawn cylinders.
#[derive(Clone, Debug)]
pub(crate) struct ScenarioScore {
    /// Its number and title.
    pub title: String,
    /// Root mean square error of the gas temperature from the change of the air on, K, of each of [`METHODS`](super::methods::METHODS).
    pub gas_k: [Spread; 3],
    /// The same of the pressure that seems to be missing, bar.
    pub missing_bar: [Spread; 3],
    /// Share of the samples with the true temperature within two of the observer's standard deviations.
    pub covered: f64,
    /// Bound of the gas temperature, K.
    pub bound_k: f64,
    /// Bound of the pressure, bar.
    pub bound_bar: f64,
    /// The first cylinder, for the figure.
    pub shown: Drawn,
}

/// A leak after a tunnel on all drawn cylinders.
#[derive(Clone, Debug)]
pub(crate) struct LeakScore {
    /// The leak, g/h.
    pub leak_g_h: f64,
    /// The same at 15 °C, bar/h.
    pub leak_bar_h: f64,
    /// Cylinders.
    pub cylinders: usize,
    /// Threshold of the first two, bar.
    pub threshold_bar: [f64; 2],
    /// Cylinders on which each of [`METHODS`](super::methods::METHODS) alarmed before the leak.
    pub false_alarms: [usize; 3],
    /// Delays of the alarms after the onset, min.
    pub delay_min: [Vec<f64>; 3],
    /// Loss rates at the end, bar/h, of those that say one.
    pub rate_bar_h: [Vec<f64>; 3],
    /// Bound of the delay, min.
    pub bound_min: Option<f64>,
    /// Bound of the standard deviation of the rate at the end, bar/h.
    pub bound_bar_h: f64,
    /// Tight cylinders on which each of [`METHODS`](super::methods::METHODS) alarms at these thresholds; the first two by construction on none.
    pub tight_alarms: [usize; 3],
}

/// How it is done.
#[derive(Clone, Debug)]
pub(super) struct Settings {
    /// Cylinders of each case.
    pub cylinders: u64,
    /// Seed of the first.
    pub seed: u64,
    /// Pole of the refitted transfer function, 1/s.
    pub pole_per_s: f64,
}

impl Settings {
    fn seeds(&self) -> Range<u64> {
        self.seed..self.seed + self.cylinders
    }

    fn drawn(
        &self,
        chamber: Chamber,
        leak: Option<SteadyLeak>,
        nominal: &Vessel,
        seed: u64,
    ) -> Result<Drawn, ReproduceError> {
        let run = ChamberRequest { leak, ..ChamberRequest::new(chamber, seed, SAMPLE_S) }.run()?;
        let sensors = SENSORS.into_iter().map(Sensor::typical).collect::<Result<Vec<_>, _>>()?;
        let plan =
            Plan { nominal, sensors: &sensors, pole_per_s: self.pole_per_s, rest_s: chamber.change_s() };
        let method_run = run_methods(&plan, &run.log)?;
        Ok(Drawn { run, method_run })
    }

    fn all(
        &self,
        chamber: Chamber,
        leak: Option<SteadyLeak>,
        seeds: Range<u64>,
    ) -> Result<Vec<Drawn>, ReproduceError> {
        let nominal = presets::load(VESSEL)?;
        seeds.into_par_iter().map(|seed| self.drawn(chamber, leak, &nominal, seed)).collect()
    }

    /// A scenario, by its number from 0; `slope_bar_k` turns the bound of the temperature into one of the pressure.
    ///
    /// # Errors
    /// A simulation's or a method's.
    pub(super) fn scenario(&self, number: usize, slope_bar_k: f64) -> Result<ScenarioScore, ReproduceError> {
        let (chamber, title) = (Chamber::SCENARIOS[number], TITLES[number]);
        let all = self.all(chamber, None, self.seeds())?;
        let over = |value: &dyn Fn(&Drawn) -> f64| Spread::pooled(&all.iter().map(value).collect::<Vec<_>>());
        let gas_k = [0, 1, 2].map(|method| over(&|drawn| drawn.rms(&drawn.gas_error_k(method))));
        let missing_bar =
            [0, 1, 2].map(|method| over(&|drawn| drawn.rms(&drawn.method_run.missing_bar[method])));
        let bound = least_errors(chamber, &settings(mass_member()), PATHS, self.seed)?;
        Ok(ScenarioScore {
            title: format!("scenario {}: {title}", number + 1),
            gas_k,
            missing_bar,
            covered: all.iter().map(covered).sum::<f64>() / all.len() as f64,
            bound_k: bound.gas_k,
            bound_bar: slope_bar_k * bound.gas_k,
            shown: all.into_iter().next().ok_or(ReproduceError::NoCylinders)?,
        })
    }

    /// Tight cylinders in the tunnel, that thresholds come from.
    ///
    /// # Errors
    /// A simulation's or a method's.
    pub(super) fn tight(&self) -> Result<Vec<Drawn>, ReproduceError> {
        let seeds = self.seeds();
        self.all(Chamber::TUNNEL, None, seeds.start + TRAINING..seeds.end + TRAINING)
    }

    /// A leak in the tunnel, by its number: 60 or 6 g/h.
    ///
    /// # Errors
    /// A simulation's or a method's.
    pub(super) fn leak(&self, number: usize, tight: &[Drawn]) -> Result<LeakScore, ReproduceError> {
        let leak_g_h = LEAKS_G_H[number];
        let onset_s = Chamber::TUNNEL.change_s() + ONSET_AFTER_S;
        let leak = SteadyLeak { rate_kg_s: leak_g_h * GRAM_PER_HOUR, onset_s };
        let all = self.all(Chamber::TUNNEL, Some(leak), self.seeds())?;
        let threshold_bar = [0, 1].map(|method| {
            1.1 * tight.iter().map(|drawn| drawn.method_run.largest_lasting_bar(method)).fold(0.0, f64::max)
        });
        let alarm_s = |drawn: &Drawn, method: usize| match method {
            2 => drawn.method_run.found_s,
            _ => drawn.method_run.alarm_s(method, threshold_bar[method], 0.0),
        };
        let delays = |method: usize| {
            let alarms = all.iter().filter_map(|drawn| alarm_s(drawn, method));
            alarms.filter(|&alarm_s| alarm_s >= onset_s).map(|alarm_s| (alarm_s - onset_s) / 60.0).collect()
        };
        let rate = |drawn: &Drawn, method: usize| match method {
            2 => drawn.method_run.finding.map(|finding| finding.rate_pa_s.value),
            _ => drawn.method_run.losses[method].map(|loss| loss.rate_pa_s),
        };
        let rates = |method: usize| {
            let rates = all.iter().filter_map(|drawn| rate(drawn, method));
            rates.map(|rate_pa_s| rate_pa_s * HOUR_S / BAR_PA).collect()
        };
        let early =
            |drawn: &&Drawn, method: usize| alarm_s(drawn, method).is_some_and(|alarm_s| alarm_s < onset_s);
        let nominal = presets::load(VESSEL)?;
        let bar_per_kg = bar_per_kg(&nominal)?;
        let watched_s = Chamber::TUNNEL.duration_s() - onset_s;
        let (bound_min, sd_kg_s) = leak_bounds(&nominal, leak.rate_kg_s, watched_s)?;
        Ok(LeakScore {
            leak_g_h,
            leak_bar_h: leak_g_h * 1e-3 * bar_per_kg,
            cylinders: all.len(),
            threshold_bar,
            false_alarms: [0, 1, 2].map(|method| all.iter().filter(|drawn| early(drawn, method)).count()),
            delay_min: [0, 1, 2].map(delays),
            rate_bar_h: [0, 1, 2].map(rates),
            bound_min,
            bound_bar_h: sd_kg_s * HOUR_S * bar_per_kg,
            tight_alarms: [0, 1, 2]
                .map(|method| tight.iter().filter(|drawn| alarm_s(drawn, method).is_some()).count()),
        })
    }
}

/// Share of the samples with the true temperature within two standard deviations.
fn covered(drawn: &Drawn) -> f64 {
    let errors = drawn.gas_error_k(2);
    let judged = errors.iter().zip(&drawn.method_run.gas_sd_k).skip(drawn.change());
    let inside: Vec<f64> = judged.map(|(error, sd)| f64::from(u8::from(error.abs() <= 2.0 * sd))).collect();
    inside.iter().sum::<f64>() / inside.len() as f64
}

/// Pressure at 15 °C that a kg more makes, bar.
fn bar_per_kg(nominal: &Vessel) -> Result<f64, ReproduceError> {
    let (pressure_pa, step_pa) = (super::methods::FULL.pressure_pa, 1e4);
    let t = super::methods::FULL.temperature_k;
    let volume = nominal.volume.volume_m3(t, pressure_pa);
    let density = |p| nominal.fluid.density_from_pressure_temperature(p, t);
    let kg = volume * (density(pressure_pa + step_pa)? - density(pressure_pa - step_pa)?);
    Ok(2.0 * step_pa / BAR_PA / kg)
}

/// Time, min, after which the observer at rest can know of a leak at the monitor's rate of false alarms, and the standard deviation of its
/// rate, kg/s, after a time, s.
fn leak_bounds(nominal: &Vessel, rate_kg_s: f64, after_s: f64) -> Result<(Option<f64>, f64), ReproduceError> {
    let sensors = SENSORS.into_iter().map(Sensor::typical).collect::<Result<Vec<_>, _>>()?;
    let mut settings = SteadySettings { observer: ObserverSettings::default(), ..SteadySettings::default() };
    settings.conditions.interval_s = SAMPLE_S;
    // Half of the leaks are found by then.
    settings.detection.power_sd = 0.0;
    let steady = SteadyAnalysis::new(nominal, &sensors, &settings)?;
    let layout = [0, 1, 2];
    let delay_s = steady.delay_s(&layout, rate_kg_s)?;
    let samples = (after_s / SAMPLE_S) as u64;
    let information = steady.response(&layout, &[Disturbance::Leak])?.information(samples)[(0, 0)];
    Ok((delay_s.map(|delay_s| delay_s / 60.0), 1.0 / information.sqrt()))
}
