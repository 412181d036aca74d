//! Worlds that are the observer's own model.
//!
//! The truth is a [`Cylinder`] with all candidates. It starts where the conditions say, its mass and its constants drawn from what the
//! observer takes them for, and moves by its own nonlinear equations; its process noise is that of the linearisation there. Readings have the
//! noise that the observer supposes, model error included.
//!
//! What nothing tells in the steady state, and what [`InstrumentedCylinder`] therefore leaves out, is known here to truth and observer: constants that
//! never change, above all a transmitter's offset. All draws are normal, also where a sensor's own law is another one.
//!
//! # Validity
//! The truth has to stay where it was linearised, see [`calm`].
use cylwatch_thermal::units::{DAY_S, HOUR_S};
use std::sync::atomic::Ordering;

use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

use super::draws::matched_draws;
use super::trial::{Trial, TrialResult, TrialStart, TrueState, confirmation};
use super::{Claim, ConfirmSettings, Confirmation, InnovationSink, Rows, RunId};
use crate::EvaluationError;
use crate::estimator::filter::{Linearisation, Plant, StateSpace};
use crate::estimator::observer::cylinder::Cylinder;
use crate::estimator::observer::{BandSettings, Commissioning, ObserverSettings, Walk};
use crate::estimator::placement::cylinder::{Conditions, InstrumentedCylinder, state_at};
use crate::estimator::placement::search::SearchControl;
use crate::estimator::sensor::Sensor;

/// Stream of the constants, which are drawn for all seeds together.
const CONSTANTS: u64 = 1;

/// The settings of a cylinder in a quiet room.
///
/// The usual ones stand for a vehicle: air that walks 40 K in an hour carries a truth that really does so out of the gas's equation within a
/// day, and films that vary by a factor of two between air and wall that differ by kelvins leave little of any linearisation. Here the
/// air walks slowly, and comes back in weeks only, for a known mean would be a thermometer by itself; unknown heat and films are those of calm
/// air. A row is one step, of truth, observer and prediction alike.
pub fn calm(settings: &ObserverSettings, conditions: &Conditions) -> ObserverSettings {
    let walk_k_per_sqrt_s = 0.3 / HOUR_S.sqrt();
    ObserverSettings {
        temperature_walk_k_per_sqrt_s: walk_k_per_sqrt_s,
        gas_walk_k_per_sqrt_s: walk_k_per_sqrt_s,
        air: Walk { memory_s: Some(20.0 * DAY_S), ..Walk::per_sqrt_hour(1.0, 0.15) },
        air_rest_k: conditions.air_k,
        longest_step_s: conditions.interval_s,
        ln_outside_film: Walk::forgetting(0.15, 2.0 * HOUR_S),
        sun: Walk::forgetting(1.0, 0.5 * HOUR_S),
        ..settings.clone()
    }
}

/// The candidates and the settings with everything known that never changes.
pub(super) fn constants_known(
    candidates: &[Sensor],
    settings: &ObserverSettings,
) -> (Vec<Sensor>, ObserverSettings) {
    let stands = |walk: &Walk| walk.per_sqrt_s == 0.0 && walk.memory_s.is_none();
    let with_known = |sensor: &Sensor| {
        let mut sensor_known = sensor.clone();
        for parameter in sensor.parameters() {
            if stands(&settings.walk_of(parameter, sensor.quantity()))
                && let Some(known) = sensor_known.parameter_mut(parameter.kind)
            {
                known.sd = 0.0;
            }
        }
        sensor_known
    };
    let known = |walk: Walk| if stands(&walk) { Walk::constant(0.0) } else { walk };
    let settings_known = ObserverSettings {
        ln_outside_film: known(settings.ln_outside_film),
        ln_inside_film: known(settings.ln_inside_film),
        ln_capacity: known(settings.ln_capacity),
        film_slope: known(settings.film_slope),
        valve_sun: known(settings.valve_sun),
        sun: known(settings.sun),
        ..settings.clone()
    };
    (candidates.iter().map(with_known).collect(), settings_known)
}

/// How a truth moves and begins.
#[derive(Clone, Debug)]
struct Motion {
    point: Vec<f64>,
    /// What is drawn at the start: state and its standard deviation.
    drawn: Vec<(usize, f64)>,
    /// Input of the leading states' noise, its columns one standard deviation: (leading, k).
    noise: DMatrix<f64>,
    /// Constants: state, rest, factor on the departure from it, standard deviation gained, over an interval.
    slow: Vec<(usize, f64, f64, f64)>,
}

impl Motion {
    fn new(
        cylinder: &mut Cylinder,
        claim: &Claim<'_>,
        settings: &ConfirmSettings,
    ) -> Result<Self, EvaluationError> {
        let (n, leading) = (cylinder.states(), cylinder.leading());
        let Conditions { filling: (pressure_pa, temperature_k), interval_s, .. } = *claim.conditions;
        let point = state_at(cylinder, claim.vessel, claim.conditions)?;
        let mut linear = Linearisation::zeros(n, leading, cylinder.noises());
        cylinder.propagate(&mut point.clone(), interval_s, Some(&mut linear))?;
        let sd = linear.q.map(f64::sqrt) * settings.noise_factor;
        let filled = Commissioning::filled(pressure_pa, temperature_k);
        let mass_sd_kg = filled.mass_sd * filled.mass_kg(claim.vessel, temperature_k)?;
        let mut drawn = vec![(cylinder.state_map().mass, mass_sd_kg)];
        let mut slow = Vec::new();
        for state in leading..n {
            let process = cylinder.slow_process(state);
            let (factor, variance) = process.over(interval_s);
            if process.decay_per_s > 0.0 {
                drawn.push((state, (0.5 * process.intensity / process.decay_per_s).sqrt()));
            }
            slow.push((state, process.rest, factor, variance.sqrt() * settings.noise_factor));
        }
        Ok(Self { point, drawn, noise: linear.g * DMatrix::from_diagonal(&sd), slow })
    }

    /// The state at the start of one of the seeds, of which `draws` holds a row each.
    fn start(&self, draws: &DMatrix<f64>, seed: usize) -> Vec<f64> {
        let mut x = self.point.clone();
        for (number, &(state, sd)) in self.drawn.iter().enumerate() {
            x[state] += sd * draws[(seed, number)];
        }
        x
    }

    /// Noise of an interval on a state that has moved.
    fn disturb(&self, x: &mut [f64], rng: &mut ChaCha12Rng) {
        let w = DVector::from_fn(self.noise.ncols(), |_, _| StandardNormal.sample(rng));
        let by = &self.noise * w;
        x.iter_mut().zip(by.iter()).for_each(|(x, by)| *x += by);
        for &(state, rest, factor, sd) in &self.slow {
            let noise: f64 = StandardNormal.sample(rng);
            x[state] = rest + factor * (x[state] - rest) + sd * noise;
        }
    }
}

/// A cylinder with all candidates, as the member sees it.
fn cylinder_of(
    claim: &Claim<'_>,
    candidates: &[Sensor],
    settings: &ObserverSettings,
) -> Result<Cylinder, EvaluationError> {
    let mut cylinder = Cylinder::new(claim.vessel, candidates, settings)?;
    cylinder.suppose(claim.member);
    (0..candidates.len()).for_each(|sensor| cylinder.set_interval_s(sensor, claim.conditions.interval_s));
    Ok(cylinder)
}

/// Errors in worlds that are the observer's own model. Set `stop` of the control to end with the seeds that are done.
///
/// # Errors
/// A setting is out of its bounds, a layout names no candidate, or the truth leaves what the gas's equation knows.
pub fn matched<L: InnovationSink>(
    claim: &Claim<'_>,
    settings: &ConfirmSettings,
    control: &SearchControl,
    sink: &(impl Fn(RunId) -> L + Sync),
) -> Result<Confirmation<L>, EvaluationError> {
    let rows = Rows::new(claim, settings)?;
    let (candidates, known) = constants_known(claim.candidates, claim.settings);
    let cylinder =
        InstrumentedCylinder::new(claim.vessel, &candidates, &known, claim.member, claim.conditions)?;
    let observed = ObserverSettings { bank: vec![*claim.member], band: BandSettings::NONE, ..known };
    let motion = Motion::new(&mut cylinder_of(claim, &candidates, &observed)?, claim, settings)?;
    let seeds = settings.seeds as usize;
    let mut rng = ChaCha12Rng::seed_from_u64(settings.first_seed);
    rng.set_stream(CONSTANTS);
    let draws = matched_draws(seeds, motion.drawn.len(), &mut rng);
    let of_seed = |index: usize| -> Result<Option<TrialResult<L>>, EvaluationError> {
        if control.stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let seed = settings.first_seed + index as u64;
        let mut world = World {
            cylinder: cylinder_of(claim, &candidates, &observed)?,
            x: motion.start(&draws, index),
            motion: &motion,
            rng: ChaCha12Rng::seed_from_u64(seed),
        };
        let start = TrialStart { seed, settled: true };
        let mut trial = Trial::new(claim, &candidates, &observed, start, sink)?;
        let mut readings = vec![f64::NAN; candidates.len()];
        for row in 0..rows.count {
            let time_s = row as f64 * rows.interval_s;
            if row > 0 {
                world.advance(rows.interval_s)?;
            }
            let leak_kg_s = world.apply_leak(settings, time_s, if row > 0 { rows.interval_s } else { 0.0 });
            world.read(&mut readings)?;
            trial.step(time_s, &readings, &world.true_state(leak_kg_s), rows.is_judged(row))?;
        }
        Ok(Some(trial.finish()))
    };
    let trials: Vec<Option<TrialResult<L>>> =
        (0..seeds).into_par_iter().map(of_seed).collect::<Result<_, _>>()?;
    let partial = trials.iter().any(Option::is_none);
    Ok(confirmation(claim, &cylinder, trials.into_iter().flatten().collect(), partial))
}

/// One truth.
struct World<'a> {
    cylinder: Cylinder,
    x: Vec<f64>,
    motion: &'a Motion,
    rng: ChaCha12Rng,
}

impl World<'_> {
    fn advance(&mut self, interval_s: f64) -> Result<(), EvaluationError> {
        self.cylinder.propagate(&mut self.x, interval_s, None)?;
        self.motion.disturb(&mut self.x, &mut self.rng);
        Ok(())
    }

    /// Take away the gas that leaks in the interval before a time; its rate then, kg/s.
    fn apply_leak(&mut self, settings: &ConfirmSettings, time_s: f64, interval_s: f64) -> f64 {
        let Some(leak) = settings.leak else { return 0.0 };
        let open_s = (time_s - leak.onset_s).clamp(0.0, interval_s);
        self.x[self.cylinder.state_map().mass] -= leak.rate_kg_s * open_s;
        if time_s >= leak.onset_s { leak.rate_kg_s } else { 0.0 }
    }

    fn read(&mut self, readings: &mut [f64]) -> Result<(), EvaluationError> {
        for (sensor, reading) in readings.iter_mut().enumerate() {
            let noise: f64 = StandardNormal.sample(&mut self.rng);
            let sd = self.cylinder.noise_variance(sensor, &self.x).sqrt();
            *reading = self.cylinder.output(sensor, &self.x, None)? + sd * noise;
        }
        Ok(())
    }

    fn true_state(&self, leak_kg_s: f64) -> TrueState {
        let states = self.cylinder.state_map();
        let [gas_k, mass_kg, own_kg_s] = [states.gas, states.mass, states.leak].map(|state| self.x[state]);
        TrueState { gas_k, mass_kg, leak_kg_s: own_kg_s + leak_kg_s }
    }
}
