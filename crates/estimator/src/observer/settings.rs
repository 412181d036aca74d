//! What the observer assumes: resolution, priors, random walks, model error.
//!
//! The defaults are tuned on drawn cylinders under a train; worlds of `cylwatch-evaluation` judge them. They are tuned for the
//! estimate, not for the statistics of the innovations: model error is coloured, and a filter that treats it as
//! white noise of its actual size trusts its parameters too much. So the noise of the outputs is stated too large, grows with
//! the temperature differences that the reduced model resolves worst, and what is learnt fades.
use alloc::vec::Vec;
use core::ops::RangeInclusive;
use cylwatch_thermal::units::{DAY_S, HOUR_S};
use serde::{Deserialize, Serialize};

use super::band_settings::BandSettings;
use super::engine::Engine;
use crate::EstimatorError;
use crate::log::Quantity;
use crate::sensor::{Parameter, ParameterKind};

const PER_HOUR: f64 = 1.0 / 3600.0;
/// Most wall nodes, and most members of a bank: what a step can bear.
const WALL_NODES_MAX: usize = 64;
const MEMBERS_MAX: usize = 32;
/// Nominal outside films, W/(m² K).
const FILMS_W_M2_K: RangeInclusive<f64> = 0.1..=1e4;

/// Random walk or, with a `memory_s`, Ornstein-Uhlenbeck process `dx/dt = -x/memory + w`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Walk {
    /// Standard deviation of the prior.
    pub prior_sd: f64,
    /// Standard deviation that the walk gains in one second; sd after `t` seconds is this times `sqrt(t)`.
    pub per_sqrt_s: f64,
    /// Memory, s; `None`: a random walk.
    pub memory_s: Option<f64>,
}

impl Walk {
    /// A constant with a prior standard deviation; 0: known.
    pub fn constant(prior_sd: f64) -> Self {
        Self { prior_sd, per_sqrt_s: 0.0, memory_s: None }
    }

    /// A walk stated by the standard deviation it gains in an hour.
    pub fn per_sqrt_hour(prior_sd: f64, walk: f64) -> Self {
        Self { prior_sd, per_sqrt_s: walk * libm::sqrt(PER_HOUR), memory_s: None }
    }

    /// A quantity that is as uncertain for ever as its prior says, but stays about as it is for a memory, s.
    pub fn forgetting(prior_sd: f64, memory_s: f64) -> Self {
        Self { prior_sd, per_sqrt_s: prior_sd * libm::sqrt(2.0 / memory_s), memory_s: Some(memory_s) }
    }

    /// Whether the quantity is known and constant, so that it needs no state.
    pub(crate) fn is_known(&self) -> bool {
        self.prior_sd == 0.0 && self.per_sqrt_s == 0.0
    }

    /// Whether it never becomes more uncertain than its prior: a constant, or a walk whose memory holds it back.
    pub(super) fn stays_within_prior(&self) -> bool {
        const ROUNDING: f64 = 1e-9;
        let lasting = |memory_s: f64| self.per_sqrt_s * libm::sqrt(0.5 * memory_s);
        self.per_sqrt_s == 0.0
            || self.memory_s.is_some_and(|m| lasting(m) <= self.prior_sd * (1.0 + ROUNDING))
    }

    fn check(&self, setting: &'static str) -> Result<(), EstimatorError> {
        for value in [self.prior_sd, self.per_sqrt_s] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(EstimatorError::ObserverSetting {
                    setting,
                    value,
                    bound: "finite and at least 0",
                });
            }
        }
        match self.memory_s {
            Some(value) if !(value > 0.0 && value.is_finite()) => {
                Err(EstimatorError::ObserverSetting { setting, value, bound: "a positive memory, s" })
            }
            _ => Ok(()),
        }
    }

    /// Inverse memory, 1/s; 0 for a random walk.
    pub(super) fn decay_per_s(&self) -> f64 {
        self.memory_s.map_or(0.0, f64::recip)
    }
}

/// How freely gas may leave in the eyes of one member of the bank.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeakHypothesis {
    /// Random walk of the mass itself, kg/sqrt(s): fast losses, and everything else that looks like one.
    pub mass_walk_kg_per_sqrt_s: f64,
    /// Leak rate, kg/s: prior and random walk.
    pub rate: Walk,
    /// Error of the pressure per kelvin between mean wall and gas, beside that of [`ModelError`], Pa/K: a member that has it sees
    /// the mass mostly in calm hours, and is no thermometer.
    #[serde(default)]
    pub caution_pa_k: f64,
    /// Whether the offset of a transmitter is considered, not estimated, but by readings that say much of it: thousands that say next to nothing move it along what nobody sees, a
    /// lighter cylinder with a transmitter that reads too much. With [`Engine::Extended`].
    #[serde(default)]
    pub considers_offset: bool,
}

impl LeakHypothesis {
    /// A leak rate, and no mass that walks by itself.
    pub fn leaking(rate: Walk) -> Self {
        Self { mass_walk_kg_per_sqrt_s: 0.0, rate, caution_pa_k: 0.0, considers_offset: false }
    }

    /// The mass walks by so many grams in the square root of an hour; no leak rate.
    pub fn walking_mass(grams_per_sqrt_h: f64) -> Self {
        Self {
            mass_walk_kg_per_sqrt_s: grams_per_sqrt_h * 1e-3 * libm::sqrt(PER_HOUR),
            ..Self::leaking(Walk::constant(0.0))
        }
    }

    /// A leak rate that changes by so many g/h in the square root of an hour.
    pub fn walking_rate(grams_per_h_per_sqrt_h: f64) -> Self {
        Self::leaking(Walk::per_sqrt_hour(0.0, grams_per_h_per_sqrt_h * 1e-3 * PER_HOUR))
    }

    /// A leak rate of so many g/h, either way, that is another one after a memory, s: gas that flows.
    pub(crate) fn flowing(grams_per_h: f64, memory_s: f64) -> Self {
        Self::leaking(Walk::forgetting(grams_per_h * 1e-3 * PER_HOUR, memory_s))
    }

    /// Whether it has a leak rate that lasts.
    pub(crate) fn is_slow(&self) -> bool {
        !self.rate.is_known() && !self.is_flowing()
    }

    /// Whether gas may flow: a rate that is soon another one.
    pub fn is_flowing(&self) -> bool {
        self.rate.memory_s.is_some()
    }

    /// The same with so much error of the pressure per kelvin between wall and gas, Pa/K.
    pub fn cautious(self, caution_pa_k: f64) -> Self {
        Self { caution_pa_k, ..self }
    }

    /// The same with the offset of a transmitter considered.
    pub fn considering_offset(self) -> Self {
        Self { considers_offset: true, ..self }
    }
}

/// Noise that stands for what the reduced model cannot say, beside the sensor's own.
///
/// The variances hold for one sample in `correlation_s`; samples that come faster see the same error again, so their
/// variance is larger by the ratio of the intervals. The information per unit of time does not depend on the sampling.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModelError {
    /// Of a surface temperature, K.
    pub surface_k: f64,
    /// The same per kelvin between air and surface.
    pub surface_per_air_k: f64,
    /// Of the pressure, Pa.
    pub pressure_pa: f64,
    /// The same per kelvin between mean wall and gas, Pa/K.
    pub pressure_per_wall_k: f64,
    /// Of an in-gas temperature, K.
    pub gas_k: f64,
    /// Of an air temperature: the air at the sensor is not that at the cylinder, K.
    pub air_k: f64,
    /// Interval over which these errors are the same, s.
    pub correlation_s: f64,
}

impl ModelError {
    /// No model error: for a truth that is the observer's own model.
    pub const NONE: Self = Self {
        surface_k: 0.0,
        surface_per_air_k: 0.0,
        pressure_pa: 0.0,
        pressure_per_wall_k: 0.0,
        gas_k: 0.0,
        air_k: 0.0,
        correlation_s: 0.0,
    };
}

/// A sudden change of the surroundings, as at the mouth of a tunnel: air and wind are others within a row or two, which no walk allows
/// that is right in between. Where all thermometers on the surface read to one side of what the walks expect, the interval before the row is
/// taken again from other surroundings at its beginning: air that has gone to that side, by one half of a normal distribution, and a film that is the same, stronger
/// or weaker. What is likeliest stays, the walks alone included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AirStep {
    /// Innovation of a thermometer from which steps are tried, in its standard deviations.
    pub surprise_sd: f64,
    /// Mean number of steps in a second, before the readings are seen, 1/s.
    pub per_s: f64,
    /// Standard deviation of the change of the air's temperature, K.
    pub air_k: f64,
    /// By how much the logarithm of the outside film is larger or smaller; known to half of it.
    pub ln_outside_film: f64,
}

/// What is considered, but not estimated, where gas may flow; see [`super::Flow`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FlowDoubt {
    /// Error of the gas temperature as a part of what thermometers differ from it by, and have lately moved by.
    pub part: f64,
    /// Memory of how far thermometers have moved from one row to the next, s.
    pub memory_s: f64,
}

/// Settings of the cylinder's observer. SI. Masses, leak rates and pressures are stated for the full 20 L nitrogen cylinder; an
/// observer takes them as parts of its own fill.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ObserverSettings {
    /// Filter that every member of the bank runs.
    #[serde(default)]
    pub engine: Engine,
    /// Wall nodes, from 1 to the number of columns of the vessel's mesh.
    pub wall_nodes: usize,
    /// Outside film for convection and radiation together, W/(m² K): nominal, the observer learns its multiplier.
    pub film_w_m2_k: f64,
    /// Longest step of the transition, s; longer intervals are divided.
    pub longest_step_s: f64,
    /// Random walk of wall and valve temperatures, K/sqrt(s): heat that the model does not know.
    pub temperature_walk_k_per_sqrt_s: f64,
    /// Random walk of the gas temperature, K/sqrt(s).
    pub gas_walk_k_per_sqrt_s: f64,
    /// Temperature of the surroundings, K.
    pub air: Walk,
    /// Temperature that the surroundings return to where `air` has a memory, K.
    pub air_rest_k: f64,
    /// Logarithm of the outside film's multiplier.
    pub ln_outside_film: Walk,
    /// Logarithm of the inside film's multiplier.
    pub ln_inside_film: Walk,
    /// Logarithm of the multiplier on the heat capacity of wall and valve.
    pub ln_capacity: Walk,
    /// Sun on the upper quarter of the wall, W.
    pub sun: Walk,
    /// Change of the outside film from bottom to top, relative to that in the middle.
    pub film_slope: Walk,
    /// Part of the sun on the wall that the valve absorbs beside, less the usual part: shade, paint, and the sun's angle.
    pub valve_sun: Walk,
    /// Memory of a mounting coupling, s: with the wind and the place of the air it returns to its prior, and what is
    /// learnt of it lasts so long. `None`: it is constant.
    pub coupling_memory_s: Option<f64>,
    /// The same for temperature offsets and a transmitter's temperature coefficient: coloured model error would else make
    /// them certain of wrong values, and let combinations that the data do not tell apart drift away.
    pub constants_memory_s: Option<f64>,
    /// Noise beside the sensors' own.
    pub model_error: ModelError,
    /// Stated uncertainty of the gas temperature.
    #[serde(default)]
    pub band: BandSettings,
    /// The bank: the first member gives the mass, the middle one of those with a leak rate the gas temperature, as long as the
    /// freest member agrees. The last one may be flowing: with [`Engine::Extended`] it takes over in fast losses.
    pub bank: Vec<LeakHypothesis>,
    /// Steps of the surroundings, with [`Engine::Extended`]; `None`: they only walk.
    #[serde(default)]
    pub air_step: Option<AirStep>,
    /// What the flowing member is doubted for.
    pub flow_doubt: FlowDoubt,
    /// Standard deviation of the mass while gas is being exchanged, kg.
    pub free_mass_sd_kg: f64,
    /// Standard deviation of the leak rate of a member that has lost more mass than it allows, kg/s.
    pub any_leak_sd_kg_s: f64,
    /// Innovation beyond which a reading is rejected, in its standard deviations: wide, because a step of the air is no
    /// fault of a sensor.
    pub gate_sd: f64,
    /// Rejections of one sensor in a row after which its next reading is taken whatever it says.
    pub rejections_in_a_row: u32,
}

impl Default for ObserverSettings {
    fn default() -> Self {
        Self {
            engine: Engine::default(),
            wall_nodes: 2,
            film_w_m2_k: 14.0,
            longest_step_s: 60.0,
            temperature_walk_k_per_sqrt_s: 2.0 * libm::sqrt(PER_HOUR),
            gas_walk_k_per_sqrt_s: 2.0 * libm::sqrt(PER_HOUR),
            air: Walk { prior_sd: 5.0, per_sqrt_s: 0.7, memory_s: None },
            air_rest_k: 283.15,
            ln_outside_film: Walk::forgetting(0.8, 2.0 * HOUR_S),
            ln_inside_film: Walk::forgetting(0.25, 120.0 * DAY_S),
            ln_capacity: Walk::forgetting(0.12, 120.0 * DAY_S),
            sun: Walk::forgetting(6.0, 0.5 * HOUR_S),
            film_slope: Walk::forgetting(0.2, 120.0 * DAY_S),
            valve_sun: Walk::forgetting(0.1, 120.0 * DAY_S),
            coupling_memory_s: Some(DAY_S),
            constants_memory_s: Some(120.0 * DAY_S),
            model_error: ModelError {
                surface_k: 0.12,
                surface_per_air_k: 0.04,
                pressure_pa: 0.1e5,
                pressure_per_wall_k: 0.07e5,
                gas_k: 0.5,
                air_k: 0.5,
                correlation_s: 60.0,
            },
            band: BandSettings::default(),
            bank: vec![
                LeakHypothesis::walking_mass(1.5),
                LeakHypothesis::walking_rate(0.02),
                LeakHypothesis::walking_rate(0.005),
                LeakHypothesis::walking_mass(30.0),
                LeakHypothesis::flowing(450.0, 900.0),
            ],
            air_step: Some(AirStep {
                surprise_sd: 2.0,
                per_s: 0.06 * PER_HOUR,
                air_k: 30.0,
                ln_outside_film: 1.5,
            }),
            flow_doubt: FlowDoubt { part: 0.2, memory_s: 1200.0 },
            free_mass_sd_kg: 4.5,
            any_leak_sd_kg_s: 20e-3 * PER_HOUR,
            gate_sd: 20.0,
            rejections_in_a_row: 5,
        }
    }
}

impl ObserverSettings {
    /// The default with the first member of the bank alone: temperature and mass, no slow leak rates.
    pub fn single() -> Self {
        let mut settings = Self::default();
        settings.bank.truncate(1);
        settings
    }

    /// Hold no member whose gas may flow.
    pub fn suppose_no_flow(&mut self) {
        self.bank.retain(|member| !member.is_flowing());
    }

    /// Slow motion of a sensor's parameter about its prior, in the unit of its kind.
    pub fn walk_of(&self, parameter: &Parameter, quantity: Quantity) -> Walk {
        let walk = |per_sqrt_s: f64, memory_s| Walk {
            prior_sd: parameter.sd,
            per_sqrt_s: per_sqrt_s.max(parameter.walk_per_sqrt_s),
            memory_s,
        };
        // What forgets is as uncertain in the end as its prior says.
        let forgetting = |memory_s: Option<f64>| {
            let stationary = memory_s.map_or(0.0, |memory_s| libm::sqrt(2.0 / memory_s));
            walk(stationary * parameter.sd, memory_s)
        };
        match (parameter.kind, quantity) {
            (ParameterKind::Coupling, _) => forgetting(self.coupling_memory_s),
            (ParameterKind::TemperatureCoefficient, _) | (ParameterKind::Offset, Quantity::Temperature) => {
                forgetting(self.constants_memory_s)
            }
            (ParameterKind::Offset, Quantity::Pressure) | (ParameterKind::Span, _) => walk(0.0, None),
        }
    }

    /// Check every value.
    ///
    /// # Errors
    /// Names the setting, its value and the bound.
    pub fn validate(&self) -> Result<(), EstimatorError> {
        let require = |ok: bool, setting: &'static str, value: f64, bound: &'static str| {
            if ok { Ok(()) } else { Err(EstimatorError::ObserverSetting { setting, value, bound }) }
        };
        let positive = |setting, value: f64| {
            require(value > 0.0 && value.is_finite(), setting, value, "positive and finite")
        };
        let not_negative = |setting, value: f64| {
            require(value >= 0.0 && value.is_finite(), setting, value, "finite and at least 0")
        };
        self.engine.validate()?;
        self.band.validate()?;
        let (nodes, members) = (self.wall_nodes, self.bank.len());
        require((1..=WALL_NODES_MAX).contains(&nodes), "wall_nodes", nodes as f64, "between 1 and 64")?;
        require((1..=MEMBERS_MAX).contains(&members), "bank", members as f64, "of 1 to 32 members")?;
        let film = FILMS_W_M2_K.contains(&self.film_w_m2_k);
        require(film, "film_w_m2_k", self.film_w_m2_k, "between 0.1 and 10000")?;
        positive("air_rest_k", self.air_rest_k)?;
        let step_s = self.longest_step_s;
        require(step_s >= 1.0 && step_s.is_finite(), "longest_step_s", step_s, "at least 1 s")?;
        positive("coupling_memory_s", self.coupling_memory_s.unwrap_or(1.0))?;
        positive("constants_memory_s", self.constants_memory_s.unwrap_or(1.0))?;
        positive("gate_sd", self.gate_sd)?;
        positive("flow_doubt.memory_s", self.flow_doubt.memory_s)?;
        if let Some(step) = self.air_step {
            positive("air_step.surprise_sd", step.surprise_sd)?;
            positive("air_step.per_s", step.per_s)?;
            not_negative("air_step.air_k", step.air_k)?;
            not_negative("air_step.ln_outside_film", step.ln_outside_film)?;
        }
        positive("free_mass_sd_kg", self.free_mass_sd_kg)?;
        positive("any_leak_sd_kg_s", self.any_leak_sd_kg_s)?;
        for (setting, value) in [
            ("flow_doubt.part", self.flow_doubt.part),
            ("temperature_walk_k_per_sqrt_s", self.temperature_walk_k_per_sqrt_s),
            ("gas_walk_k_per_sqrt_s", self.gas_walk_k_per_sqrt_s),
            ("model_error.surface_k", self.model_error.surface_k),
            ("model_error.surface_per_air_k", self.model_error.surface_per_air_k),
            ("model_error.pressure_pa", self.model_error.pressure_pa),
            ("model_error.pressure_per_wall_k", self.model_error.pressure_per_wall_k),
            ("model_error.gas_k", self.model_error.gas_k),
            ("model_error.air_k", self.model_error.air_k),
            ("model_error.correlation_s", self.model_error.correlation_s),
        ] {
            not_negative(setting, value)?;
        }
        for (setting, walk) in [
            ("air", &self.air),
            ("ln_outside_film", &self.ln_outside_film),
            ("ln_inside_film", &self.ln_inside_film),
            ("ln_capacity", &self.ln_capacity),
            ("sun", &self.sun),
            ("film_slope", &self.film_slope),
            ("valve_sun", &self.valve_sun),
        ] {
            walk.check(setting)?;
        }
        for member in &self.bank {
            not_negative("bank.mass_walk_kg_per_sqrt_s", member.mass_walk_kg_per_sqrt_s)?;
            not_negative("bank.caution_pa_k", member.caution_pa_k)?;
            member.rate.check("bank.rate")?;
        }
        Ok(())
    }
}
