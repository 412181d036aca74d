//! Worlds that are the observer's own model: its state space in the paper's chamber, with truths drawn from its prior and its noise.
//!
//! Here, other than in a [world](crate::world), the filter is right: what it misses is the price of linearising, and
//! [`least_errors`] is what no estimator with the same prior goes below (the mean over true paths of each path's own posterior Cramér-Rao
//! bound, see [`crate::estimator::bound`]). The change of the air is known, the rest of the air's walk is not.
use cylwatch_thermal::units::HOUR_S;
use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

use crate::estimator::EstimatorError;
use crate::estimator::bound::path_bound;
use crate::estimator::filter::{Dimensions, Linearisation, StateSpace, StepError, UdFactors};
use crate::estimator::observer::cylinder::Cylinder;
use crate::estimator::observer::states::{StateKind, States};
use crate::estimator::observer::{LeakHypothesis, ModelError, ObserverSettings, Walk};
use crate::estimator::sensor::Sensor;
use crate::thermal::vessel::presets;
use crate::world::chamber::Chamber;

/// A cylinder in a chamber: the known change of the air comes on top of the cylinder's own transition, half of it before and
/// half of it after.
#[derive(Debug)]
pub struct OwnWorld {
    /// The observer's cylinder.
    pub cylinder: Cylinder,
    /// What happens to it.
    pub chamber: Chamber,
    /// Interval of the samples, s.
    pub sample_s: f64,
    /// Part of the cold spreads that the prior has.
    pub spread: f64,
    /// Time at the beginning of the next transition, s.
    pub time_s: f64,
}

impl OwnWorld {
    /// A cylinder with the typical sensors of the shoulder, the valve and the pressure.
    ///
    /// # Errors
    /// The settings are refused.
    pub fn new(chamber: Chamber, settings: &ObserverSettings, spread: f64) -> Result<Self, EstimatorError> {
        let sensors = ["shoulder", "valve", "pressure"]
            .into_iter()
            .map(Sensor::typical)
            .collect::<Result<Vec<_>, _>>()?;
        let cylinder = Cylinder::new(&presets::load("nitrogen-20l")?, &sensors, settings)?;
        let sample_s = if chamber.after_s > 10.0 * HOUR_S { 120.0 } else { 60.0 };
        Ok(Self { cylinder, chamber, sample_s, spread, time_s: 0.0 })
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        (self.chamber.duration_s() / self.sample_s) as usize + 1
    }

    /// What each state is.
    pub fn map(&self) -> &States {
        self.cylinder.state_map()
    }

    /// Mean and standard deviations of the state at the first sample.
    pub fn prior(&self) -> (Vec<f64>, Vec<f64>) {
        let (states, settings) = (self.cylinder.state_map(), self.cylinder.settings());
        let (start_k, spread) = (self.chamber.air_k(0.0), self.spread);
        let of = |kind: &StateKind| match *kind {
            StateKind::Wall(_) | StateKind::Valve | StateKind::Gas | StateKind::Lag { .. } => {
                (start_k, spread * BODY_SD_K)
            }
            StateKind::Mass => (MASS_KG, spread * MASS_SD_KG),
            StateKind::Leak => (0.0, settings.bank[0].rate.prior_sd),
            StateKind::Air => (start_k, settings.air.prior_sd),
            StateKind::OutsideFilm => (0.0, settings.ln_outside_film.prior_sd),
            StateKind::Sun => (0.0, settings.sun.prior_sd),
            StateKind::InsideFilm => (0.0, settings.ln_inside_film.prior_sd),
            StateKind::Capacity => (0.0, settings.ln_capacity.prior_sd),
            StateKind::FilmSlope => (0.0, settings.film_slope.prior_sd),
            StateKind::ValveSun => (0.0, settings.valve_sun.prior_sd),
            StateKind::Parameter { sensor, parameter } => {
                let parameter = &self.cylinder.sensors()[sensor].parameters()[parameter];
                (parameter.mean, spread * parameter.sd)
            }
        };
        states.kinds.iter().map(of).unzip()
    }

    /// Prior covariance: (n, n).
    pub fn prior_covariance(&self) -> DMatrix<f64> {
        DMatrix::from_diagonal(&DVector::from_vec(self.prior().1).map(|sd| sd * sd))
    }
}

/// What a filter knows at first of a cylinder that nobody has seen: its temperatures, K, and the mass of a fill, kg.
const BODY_SD_K: f64 = 1.0;
const MASS_KG: f64 = 4.46;
const MASS_SD_KG: f64 = 0.045;

/// Part of those spreads, and of the sensors' own priors, that is left after commissioning: offsets of 0.05 K and 0.11 bar,
/// couplings of 0.012, a temperature coefficient of 0.0075 bar/K, a mass of 13 g.
pub const COMMISSIONED: f64 = 0.3;
/// All of them.
pub const COLD: f64 = 1.0;

/// The observer's settings with films of 15 % and a capacity of 10 %, without model error and without the slow walks of the
/// constants, which the observer adds hourly, outside its state space.
///
/// Wall, valve and gas walk by 0.3 K in the square root of an hour instead of 1 K: an hour of rest then keeps clear of the
/// corner of the inside film, whose conductance falls to nothing with the difference of wall and gas.
pub fn settings(member: LeakHypothesis) -> ObserverSettings {
    ObserverSettings {
        longest_step_s: 120.0,
        temperature_walk_k_per_sqrt_s: 0.3 / HOUR_S.sqrt(),
        gas_walk_k_per_sqrt_s: 0.3 / HOUR_S.sqrt(),
        air: Walk::per_sqrt_hour(0.3, 1.0),
        ln_outside_film: Walk { memory_s: Some(2.0 * HOUR_S), ..Walk::per_sqrt_hour(0.15, 0.1) },
        ln_inside_film: Walk::constant(0.15),
        ln_capacity: Walk::constant(0.1),
        sun: Walk { memory_s: Some(0.5 * HOUR_S), ..Walk::per_sqrt_hour(0.6, 2.0) },
        film_slope: Walk::constant(0.0),
        valve_sun: Walk::constant(0.0),
        coupling_memory_s: None,
        constants_memory_s: None,
        model_error: ModelError::NONE,
        bank: vec![member],
        ..ObserverSettings::default()
    }
}

/// The member whose mass walks, by 5 g in the square root of an hour.
pub fn mass_member() -> LeakHypothesis {
    LeakHypothesis::walking_mass(5.0)
}

/// A member whose leak rate walks, by 0.02 g/h in the square root of an hour from 0 +- 0.2 g/h.
pub fn leak_member() -> LeakHypothesis {
    let g_h = 1e-3 / HOUR_S;
    LeakHypothesis::leaking(Walk::per_sqrt_hour(0.2 * g_h, 0.02 * g_h))
}

/// Random numbers of a truth.
pub struct Draws(pub ChaCha12Rng);

impl Draws {
    /// One of the standard normal distribution.
    pub fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// A state of the prior.
    pub fn state(&mut self, world: &OwnWorld) -> Vec<f64> {
        let (mean, sd) = world.prior();
        mean.iter().zip(&sd).map(|(mean, sd)| mean + sd * self.normal()).collect()
    }

    /// The state some time later.
    ///
    /// # Errors
    /// The model's.
    pub fn advance(&mut self, world: &mut OwnWorld, x: &mut [f64], dt_s: f64) -> Result<(), EstimatorError> {
        let mut linear = Linearisation::zeros(world.states(), world.leading(), world.noises());
        world.propagate(x, dt_s, Some(&mut linear))?;
        let w = DVector::from_fn(linear.q.len(), |i, _| linear.q[i].sqrt() * self.normal());
        let spread = &linear.g * w;
        x.iter_mut().zip(spread.iter()).for_each(|(x, by)| *x += by);
        Ok(())
    }

    /// Readings of a state.
    ///
    /// # Errors
    /// The model's.
    pub fn readings(&mut self, world: &mut OwnWorld, x: &[f64]) -> Result<Vec<f64>, EstimatorError> {
        (0..world.outputs())
            .map(|j| Ok(world.output(j, x, None)? + world.noise_variance(j, x).sqrt() * self.normal()))
            .collect()
    }
}

impl StateSpace for OwnWorld {
    type Error = EstimatorError;

    fn dimensions(&self) -> Dimensions {
        self.cylinder.dimensions()
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), EstimatorError> {
        let air = self.cylinder.state_map().air;
        let half_k = 0.5 * (self.chamber.air_k(self.time_s + dt_s) - self.chamber.air_k(self.time_s));
        x[air] += half_k;
        self.cylinder.propagate(x, dt_s, linear)?;
        x[air] += half_k;
        Ok(())
    }

    fn output(&mut self, j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, EstimatorError> {
        self.cylinder.output(j, x, h)
    }

    fn noise_variance(&self, j: usize, x: &[f64]) -> f64 {
        self.cylinder.noise_variance(j, x)
    }
}

/// Least root mean square errors in a chamber, from the change of the air on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastErrors {
    /// Of the mean gas temperature, K.
    pub gas_k: f64,
    /// Of the mass, kg.
    pub mass_kg: f64,
}

/// What no estimator goes below in a chamber with the observer's prior: over so many true paths, drawn from a seed.
///
/// # Errors
/// The settings are refused, or a path leaves the model's range.
pub fn least_errors(
    chamber: Chamber,
    settings: &ObserverSettings,
    paths: u64,
    seed: u64,
) -> Result<LeastErrors, EstimatorError> {
    let of_path = |path: u64| {
        let world = OwnWorld::new(chamber, settings, COLD)?;
        path_variances(world, Draws(ChaCha12Rng::seed_from_u64(seed.wrapping_add(path))))
    };
    let variances = (0..paths).into_par_iter().map(of_path).collect::<Result<Vec<_>, EstimatorError>>()?;
    let [gas_k, mass_kg] =
        [0, 1].map(|w| (variances.iter().map(|of| of[w]).sum::<f64>() / paths as f64).sqrt());
    Ok(LeastErrors { gas_k, mass_kg })
}

/// Mean variances of gas temperature and mass along one true path, from the change of the air on.
fn path_variances(mut world: OwnWorld, mut draws: Draws) -> Result<[f64; 2], EstimatorError> {
    let (samples, sample_s) = (world.samples(), world.sample_s);
    let functionals = [world.map().gas, world.map().mass];
    let heard = vec![true; world.outputs()];
    let mut linear = Linearisation::zeros(world.states(), world.leading(), world.noises());
    let mut bound = UdFactors::from_covariance(&world.prior_covariance())?;
    let (mut x, mut sums, mut judged) = (draws.state(&world), [0.0; 2], 0.0);
    for k in 0..samples {
        let (dt_s, before) = (if k > 0 { sample_s } else { 0.0 }, x.clone());
        world.time_s = k.saturating_sub(1) as f64 * sample_s;
        if k > 0 {
            draws.advance(&mut world, &mut x, sample_s)?;
        }
        path_bound(&mut world, &mut bound, (&before, dt_s, &x), &heard, &mut linear).map_err(|error| {
            match error {
                StepError::Model(error) | StepError::Filter(error) => error,
            }
        })?;
        if k as f64 * sample_s >= HOUR_S {
            judged += 1.0;
            sums.iter_mut().zip(functionals).for_each(|(sum, state)| *sum += bound.variance(state));
        }
    }
    Ok(sums.map(|sum| sum / judged))
}
